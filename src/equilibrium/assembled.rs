//! Newton's method on the whole structure, for contacts of many points: nothing dense grows with their number.
//!
//! A state (u, a, δ) with the residuals r = f − K u − r_c and L − ΣN is corrected by
//!
//! \[ K + Σ (g N′ − t F′) gᵀ   Σ (g N′ − t F′) \] \[du\]   \[ r + Σ (g N′ − t F′) c \]
//! \[ Σ N′ gᵀ                  Σ N′            \] \[da\] = \[ L − ΣN + Σ N′ c       \],  dδ = da + gᵀdu − c,
//!
//! with c = δ − (a − gap + gᵀu), which is rounding but at a start. K has here the parts that are not symmetric, too, and the springs t k_t tᵀ of
//! points that stick, whose friction depends on t₁ᵀu and t₂ᵀu. GMRES solves it, preconditioned by the symmetric \[A b; bᵀ e\], A = K + Σ d g gᵀ, b = Σ d g, e = Σ d, which differs from it by friction, and by
//! the points that have opened or closed since A was factorised.

use super::PointState;
use super::SteadySliding;
use super::balance::states;
use super::condensed::closed_factor;
use super::linear::{add_reaction, directions, elastic_force, springs};
use super::load_steps::{Lost, Newton, Watch};
use super::point_laws::{
    Fraction, Law, PointLaws, State, are_finite, force_change, largest_force, norm, slid,
};
use crate::error::Result;
use crate::linalg::gmres::gmres;
use crate::linalg::lu::Lu;
use crate::linalg::sparse::{add_scaled, sum_of_squares};
use crate::linalg::{Engine, SparseMatrix, SymmetricFactor};
use crate::progress::Observer;
use crate::system::{ContactPair, Coupling, System};
use faer::Mat;
use std::cell::RefCell;
use std::sync::Arc;

/// Residual of a linear solution, relative to its right-hand side.
const TOLERANCE: f64 = 1e-9;
/// The most iterations of a linear solution.
const MOST_ITERATIONS: usize = 300;
/// A linear solution that leaves more than this part of its right-hand side has none.
const UNBALANCED: f64 = 0.5;
/// A solution of more iterations has A made anew with the springs of its state.
const SLOW: usize = 40;
/// d of a point without load, as a part of that of a closed one.
const OPEN: f64 = 1e-6;
/// A step below this part of the lengths that shrinks no more is rounding.
const ROUNDING: f64 = 1e-7;

/// A structure with its contact closed, factorised, for systems that differ from one in laws, loads and velocities.
pub(super) struct Assembled<'a> {
    coupling: Option<&'a Coupling>,
    engine: &'a Engine,
    /// d of every point where it is closed \[N/m\].
    springs: Vec<f64>,
    closed: Arc<Preconditioner>,
}

/// The factors of \[A b; bᵀ e\].
struct Preconditioner {
    factor: Box<dyn SymmetricFactor>,
    /// b of every loaded pair.
    force: Mat<f64>,
    /// A⁻¹b.
    answer: Mat<f64>,
    /// e − bᵀA⁻¹b.
    schur: Lu<f64>,
}

impl<'a> Assembled<'a> {
    /// Factorises A with every contact closed.
    ///
    /// # Errors
    /// A rigid motion that not even the closed contact resists.
    pub(super) fn new(system: &'a System, stiffness: &SparseMatrix) -> Result<Self> {
        let (factor, springs) = closed_factor(system, stiffness)?;
        let closed = Arc::new(Preconditioner::new(factor, &PointLaws::new(&system.pairs), &springs));
        let engine = &system.structure.engine;
        Ok(Assembled { coupling: system.coupling.as_ref(), engine, springs, closed })
    }

    /// A with the springs of a state; none where it cannot be factorised.
    fn factorised_at(
        &self,
        k: &SparseMatrix,
        contact: &PointLaws<'_>,
        laws: &[Law],
    ) -> Option<Arc<Preconditioner>> {
        let own = laws.iter().zip(&self.springs);
        let closed: Vec<f64> = own.map(|((_, t), closed)| t.by_penetration[0].max(OPEN * closed)).collect();
        let normals = closed.iter().zip(&contact.points).map(|(d, (.., point))| (*d, &point.normal));
        let tangents = laws.iter().zip(&contact.points).flat_map(|((_, tangent), (.., point))| {
            let [_, along, across] = springs(point, tangent);
            [along, across]
        });
        let sum = sum_of_squares(k.nrows(), normals.chain(tangents.filter(|(d, _)| *d > 0.0)));
        let factor = self.engine.factorize(&add_scaled(&[(1.0, k), (1.0, &sum)])).ok()?;
        Some(Arc::new(Preconditioner::new(factor, contact, &closed)))
    }
}

impl Preconditioner {
    fn new(factor: Box<dyn SymmetricFactor>, contact: &PointLaws<'_>, springs: &[f64]) -> Self {
        let m = contact.loaded.len();
        let mut force = Mat::<f64>::zeros(factor.n(), m);
        let mut schur = Mat::<f64>::zeros(m, m);
        for ((k, _, point), d) in contact.points.iter().zip(springs) {
            if let Some(c) = contact.unknown(*k) {
                point.normal.add_to(*d, force.col_as_slice_mut(c));
                schur[(c, c)] += d;
            }
        }
        let mut answer = force.clone();
        factor.solve_in_place(answer.as_mut());
        schur -= force.transpose() * &answer;
        Preconditioner { factor, force, answer, schur: Lu::new(schur) }
    }

    /// \[A b; bᵀ e\]⁻¹ of forces and loads, one behind the other.
    fn solve(&self, x: &[f64]) -> Vec<f64> {
        let (n, m) = self.force.shape();
        let mut u = Mat::from_fn(n, 1, |i, _| x[i]);
        self.factor.solve_in_place(u.as_mut());
        let rest = self.force.transpose() * &u;
        let a = self.schur.solve(Mat::from_fn(m, 1, |c, _| x[n + c] - rest[(c, 0)]));
        u -= &self.answer * &a;
        u.col_as_slice(0).iter().chain(a.col_as_slice(0)).copied().collect()
    }
}

/// The equilibrium of pairs and a load on a structure.
pub(super) struct WholeProblem<'a> {
    pub(super) contact: PointLaws<'a>,
    load: &'a [f64],
    /// K, or K + K_σ: its symmetric part.
    stiffness: &'a SparseMatrix,
    structure: &'a Assembled<'a>,
    max_iterations: usize,
    observer: &'a dyn Observer,
    /// Where known, a state to begin with.
    known: Option<&'a State>,
    /// The factors at hand, those of the state that was met last.
    latest: RefCell<Arc<Preconditioner>>,
}

impl<'a> WholeProblem<'a> {
    /// On `structure` with the stiffness `stiffness`, solved in up to `max_iterations` watched by `observer`, from a state that is known.
    pub(super) fn new(
        (pairs, load): (&'a [ContactPair], &'a [f64]),
        (structure, stiffness): (&'a Assembled<'a>, &'a SparseMatrix),
        (max_iterations, observer): (usize, &'a dyn Observer),
        known: Option<&'a State>,
    ) -> Self {
        let latest = RefCell::new(Arc::clone(&structure.closed));
        let contact = PointLaws::new(pairs);
        WholeProblem { contact, load, stiffness, structure, max_iterations, observer, known, latest }
    }

    /// φ f − K u − r_c.
    fn rest(&self, u: &[f64], laws: &[Law], fraction: Fraction) -> Vec<f64> {
        let mut force = elastic_force(self.stiffness, self.structure.coupling, u);
        for ((.., point), (forces, _)) in self.contact.points.iter().zip(laws) {
            add_reaction(point, forces, &mut force);
        }
        self.load.iter().zip(&force).map(|(load, force)| fraction * load - force).collect()
    }

    /// Σ (g N′ − t F′) e on the forces, and Σ N′ e on the loads, for motions e of the points.
    fn push(&self, laws: &[Law], motions: impl Iterator<Item = f64>, image: &mut [f64]) {
        let n = self.load.len();
        for (((k, _, point), (_, tangent)), e) in self.contact.points.iter().zip(laws).zip(motions) {
            let [by_normal, by_t1, by_t2] = tangent.by_penetration.map(|slope| slope * e);
            let [g, t1, t2] = directions(point);
            g.add_to(by_normal, &mut image[..n]);
            t1.add_to(-by_t1, &mut image[..n]);
            t2.add_to(-by_t2, &mut image[..n]);
            if let Some(c) = self.contact.unknown(*k) {
                image[n + c] += by_normal;
            }
        }
    }

    /// −t ∂F/∂Δ Δ with Δ = −tᵀu of the points that stick, on the forces.
    fn hold(&self, laws: &[Law], u: &[f64], image: &mut [f64]) {
        for ((_, pair, point), (_, tangent)) in self.contact.points.iter().zip(laws) {
            if pair.sticks() {
                let slid = slid(pair, point, u);
                for (i, t) in point.tangents.iter().enumerate() {
                    let [along, across] = tangent.by_slid[1 + i];
                    t.add_to(-(along * slid[0] + across * slid[1]), &mut image[..u.len()]);
                }
            }
        }
    }

    /// The length of a change \[m\]: of the motions of the points and of the approaches.
    fn length(&self, change: &State) -> f64 {
        let slides = self.contact.points.iter().filter(|(_, pair, _)| pair.sticks());
        let slid: Vec<f64> =
            slides.flat_map(|(_, pair, point)| slid(pair, point, &change.displacement)).collect();
        norm(&[self.contact.length(&change.penetration, &change.approach), norm(&slid)])
    }

    /// The motions a + gᵀu of the points.
    fn motions<'s>(&'s self, x: &'s [f64]) -> impl Iterator<Item = f64> + 's {
        let (u, a) = x.split_at(self.load.len());
        let approach = self.contact.approaches(a);
        self.contact.points.iter().map(move |(k, _, point)| approach[*k] + point.normal.dot(u))
    }

    /// The right-hand side of the correction of a state with the residual `r`.
    fn rhs(&self, state: &State, mut r: Vec<f64>, laws: &[Law], fraction: Fraction) -> Vec<f64> {
        r.extend(self.contact.closure(laws, fraction).iter().map(|gap| -gap));
        self.push(laws, self.contact.apart(state).into_iter(), &mut r);
        r
    }

    /// The change of a state by du and da.
    fn change(&self, state: &State, x: Vec<f64>) -> State {
        let apart = self.contact.apart(state);
        let penetration = self.motions(&x).zip(&apart).map(|(e, c)| e - c).collect();
        let approach = self.contact.approaches(&x[self.load.len()..]);
        let mut displacement = x;
        displacement.truncate(self.load.len());
        State { displacement, approach, penetration }
    }

    /// The Newton correction of a state for its residual r = f − K u − r_c; `None` where there is none.
    pub(super) fn correction(&self, state: &State, r: &[f64]) -> Option<State> {
        self.step(state, r.to_vec(), &self.contact.respond(&state.penetration, &state.displacement, 1.0), 1.0)
    }

    fn step(&self, state: &State, r: Vec<f64>, laws: &[Law], fraction: Fraction) -> Option<State> {
        let rhs = self.rhs(state, r, laws, fraction);
        let product = |x: &[f64]| {
            let (u, _) = x.split_at(self.load.len());
            let mut image = elastic_force(self.stiffness, self.structure.coupling, u);
            image.resize(x.len(), 0.0);
            self.push(laws, self.motions(x), &mut image);
            self.hold(laws, u, &mut image);
            image
        };
        let solved = |most: usize| {
            let latest = Arc::clone(&self.latest.borrow());
            gmres(product, |x| latest.solve(x), &rhs, TOLERANCE, most)
        };
        let mut found = solved(SLOW);
        if found.residual > TOLERANCE
            && let Some(own) = self.structure.factorised_at(self.stiffness, &self.contact, laws)
        {
            *self.latest.borrow_mut() = own;
            found = solved(MOST_ITERATIONS);
        }
        // What cannot be balanced by any motion, such as friction at its limit on a body that nothing else holds, stays in the residual.
        let balanced = found.residual <= UNBALANCED && found.x.iter().all(|v| v.is_finite());
        balanced.then(|| self.change(state, found.x))
    }

    /// The length of the step that the preconditioner alone gives for the residual of a state \[m\].
    fn distance(&self, state: &State, fraction: Fraction) -> f64 {
        let laws = self.contact.respond(&state.penetration, &state.displacement, fraction);
        if !are_finite(&laws) {
            return f64::INFINITY;
        }
        let rest = self.rest(&state.displacement, &laws, fraction);
        let step = self.latest.borrow().solve(&self.rhs(state, rest, &laws, fraction));
        let change = self.change(state, step);
        self.length(&change)
    }
}

impl Newton for WholeProblem<'_> {
    type Stage = State;

    fn contact(&self) -> &PointLaws<'_> {
        &self.contact
    }

    fn state(&self, stage: &State) -> (Vec<PointState>, Vec<f64>) {
        (states(self.contact.pairs, &stage.penetration, &stage.displacement), stage.approach.clone())
    }

    fn starts(&self, fraction: Fraction) -> Vec<State> {
        let known = self.known.filter(|_| fraction == 1.0).cloned();
        let u = self.structure.closed.solve(&[self.load, &vec![0.0; self.contact.loaded.len()]].concat());
        let (u, _) = u.split_at(self.load.len());
        let unloaded: Vec<f64> = self.contact.points.iter().map(|(.., point)| point.normal.dot(u)).collect();
        let at = |(penetration, approach)| State {
            displacement: vec![0.0; self.load.len()],
            approach,
            penetration,
        };
        let mut starts = self.contact.starts(&unloaded, fraction);
        // Where the undeformed bodies do not press each other, nothing may hold them.
        if self.contact.some_pair_is_open(&starts[0].0) {
            starts.reverse();
        }
        known.into_iter().chain(starts.map(at)).collect()
    }

    /// Damped Newton: a step is taken where the simplified step after it is shorter than the one before. It ends when neither
    /// the lengths nor the forces change any more, or what changes is rounding.
    fn solve(
        &self,
        mut state: State,
        fraction: Fraction,
    ) -> std::result::Result<(State, usize), Lost<State>> {
        let mut watch = Watch::new(self.observer);
        let contact = &self.contact;
        let (mut length, mut last) = (f64::INFINITY, f64::INFINITY);
        for iteration in 1..=self.max_iterations {
            let laws = contact.respond(&state.penetration, &state.displacement, fraction);
            let lost = |why: String| Err(Lost { why, at: state.clone() });
            if !are_finite(&laws) {
                return lost(format!("at iteration {iteration} a force of the contact is not finite"));
            }
            let rest = self.rest(&state.displacement, &laws, fraction);
            let Some(step) = self.step(&state, rest, &laws, fraction) else {
                return lost(format!("at iteration {iteration} the contact leaves a motion free"));
            };
            length = self.length(&step);
            if !length.is_finite() {
                return lost(format!("at iteration {iteration} the step is not finite"));
            }
            let scale = contact.scale(&state.penetration, &state.approach);
            let (change, largest) = (force_change(&laws, &step.penetration), largest_force(&laws));
            let settled = length <= 1e-11 * scale && change <= 1e-9 * largest;
            let rounding = length > 0.5 * last && length <= ROUNDING * scale && change <= ROUNDING * largest;
            if settled || rounding {
                state.add(1.0, &step);
                return Ok((state, iteration));
            }
            if let Err(why) = watch.step(iteration, length, &laws) {
                return lost(why);
            }
            last = length;
            let before = self.distance(&state, fraction);
            let mut damping = 1.0;
            loop {
                let mut next = state.clone();
                next.add(damping, &step);
                if self.distance(&next, fraction) <= (1.0 - 0.25 * damping) * before || damping < 1e-3 {
                    state = next;
                    break;
                }
                damping *= 0.5;
            }
        }
        let why = format!("after {} iterations the Newton step is still {length:.1e} m", self.max_iterations);
        Err(Lost { why, at: state })
    }
}

impl State {
    /// A steady state that was found.
    pub(super) fn of(steady: &SteadySliding) -> Self {
        State {
            displacement: steady.displacement.clone(),
            approach: steady.approach.clone(),
            penetration: steady.points.iter().map(|point| point.penetration).collect(),
        }
    }
}
