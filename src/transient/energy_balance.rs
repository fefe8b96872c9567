//! Where the energy goes, step by step.

use super::model::TransientModel;
use super::rows::sums;
use super::scheme::Weights;
use super::state::State;
use faer::Mat;
use std::ops::Range;

/// The work of one step or, summed, of many \[J\].
///
/// With X̄ the mean and ΔX the difference of n+1 and n, Newmark's formulas give exactly
///
/// Δ(½vᵀMv + ½uᵀKu) = Δuᵀ(f̄ − C v̄ − N ū − D r̄) + W_alg,
/// W_alg = (½−α_f) Δuᵀ(Δf − (C+G)Δv − KΔu − DΔr) + (γ−1+α_m) ΔuᵀMΔa − Δt²(β−½γ)\[ΔaᵀMā + (γ−½) ΔaᵀMΔa + ΔaᵀG v̄\],
///
/// where W_alg is what the scheme itself adds or (mostly) takes; it vanishes for β = ¼, γ = ½, α = 0. N and G are the skew parts of K
/// and C: N is circulatory, and G, gyroscopic, does no work, as v̄ᵀG v̄ = 0. What is left of the balance is the error of solving
/// the step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Work {
    /// Δuᵀf̄ of constant load and excitations.
    pub external: f64,
    /// −Δuᵀ C v̄: what structural damping takes.
    pub damping: f64,
    /// −Σ gᵀΔu N̄: what the normal forces of the contacts do to the structure.
    pub normal: f64,
    /// Σ ∫V dt F̄₁: what the drives of the counter-bodies spend against friction.
    pub drive: f64,
    /// Work of friction, which becomes heat or strain of bristles: Σ F̄₁(∫V dt − t₁ᵀΔu) − F̄₂ t₂ᵀΔu. The structure gains
    /// drive − heat.
    pub heat: f64,
    /// Work of imported unsymmetric terms on the structure: −Δuᵀ N ū of skew stiffness, and what friction of low rank does.
    pub coupling: f64,
    /// W_alg.
    pub algorithm: f64,
    /// ½vᵀMv gained.
    pub kinetic: f64,
    /// ½uᵀKu gained.
    pub strain: f64,
}

impl Work {
    /// The work between two states.
    pub(super) fn between(model: &TransientModel<'_>, weights: &Weights, from: &State, to: &State) -> Work {
        let n = model.n();
        let [u0, v0, a0] = [0, 1, 2].map(|k| from.motion.col_as_slice(k));
        let [u1, v1, a1] = [0, 1, 2].map(|k| to.motion.col_as_slice(k));
        let (ku0, ku1) = (from.elastic.col_as_slice(0), to.elastic.col_as_slice(0));
        let [mv0, ma0] = [0, 1].map(|k| from.inertia.col_as_slice(k));
        let [mv1, ma1] = [0, 1].map(|k| to.inertia.col_as_slice(k));
        let structure = |rows: Range<usize>| {
            let (mut external, mut kinetic, mut strain) = (0.0, 0.0, 0.0);
            let (mut stiff, mut heavy, mut mean, mut change) = (0.0, 0.0, 0.0, 0.0);
            for i in rows {
                let (du, da, dma) = (u1[i] - u0[i], a1[i] - a0[i], ma1[i] - ma0[i]);
                external += du * model.load[i];
                // ½(x₁ᵀA x₁ − x₀ᵀA x₀) as (x₁ − x₀)ᵀA x̄, which loses no digits where the motion is steady.
                kinetic += 0.5 * (v1[i] - v0[i]) * (mv1[i] + mv0[i]);
                strain += 0.5 * du * (ku1[i] + ku0[i]);
                stiff += du * (ku1[i] - ku0[i]);
                heavy += du * dma;
                mean += 0.5 * da * (ma1[i] + ma0[i]);
                change += da * dma;
            }
            [external, kinetic, strain, stiff, heavy, mean, change]
        };
        let [mut external, kinetic, strain, stiff, heavy, mean, change] = sums(n, structure);
        let (mut damping, mut damping_change) = (0.0, 0.0);
        if let (Some(c0), Some(c1)) = (&from.viscous, &to.viscous) {
            let (cv0, cv1) = (c0.col_as_slice(0), c1.col_as_slice(0));
            let lost = |rows: Range<usize>| {
                let (mut damping, mut change) = (0.0, 0.0);
                for i in rows {
                    damping -= 0.5 * (u1[i] - u0[i]) * (cv1[i] + cv0[i]);
                    change -= (u1[i] - u0[i]) * (cv1[i] - cv0[i]);
                }
                [damping, change]
            };
            [damping, damping_change] = sums(n, lost);
        }
        if let (Some(modal), Some(old), Some(new)) = (&model.damping.modal, &from.modal, &to.modal) {
            for (i, c) in modal.coefficients.iter().enumerate() {
                let moved = c * (new[(i, 0)] - old[(i, 0)]);
                damping -= 0.5 * moved * (new[(i, 1)] + old[(i, 1)]);
                damping_change -= moved * (new[(i, 1)] - old[(i, 1)]);
            }
        }
        let mut force_change = damping_change - stiff;
        for (k, push) in model.pushes.iter().enumerate() {
            let moved = push.direction.dot(u1) - push.direction.dot(u0);
            external += 0.5 * moved * (to.pushes[k] + from.pushes[k]);
            force_change += moved * (to.pushes[k] - from.pushes[k]);
        }
        let mut work = Work { external, damping, kinetic, strain, ..Work::default() };
        let mut gyroscopic = gyroscopic_of_low_rank(model, from, to);
        work.coupling -= gyroscopic;
        if let (Some(before), Some(after)) = (&from.skew, &to.skew) {
            let skew = before.work(after, [u0, u1]);
            work.coupling += skew.circulatory;
            gyroscopic += skew.gyroscopic;
            force_change += skew.change;
        }
        let after = model.travels().then(|| {
            let mut after = Mat::zeros(model.n_directions(), 1);
            from.interface.motions(model, to.motion.subcols(0, 1), after.as_mut());
            after
        });
        for (d, (old, new)) in from.reaction.iter().zip(&to.reaction).enumerate() {
            // Δu along the directions of both ends, which differ where a contact travels.
            let ahead = to.along[(d, 0)] - to.before[(d, 0)];
            let behind = after.as_ref().map_or(ahead, |after| after[(d, 0)] - from.along[(d, 0)]);
            let mean = 0.5 * (behind * old + ahead * new);
            force_change -= ahead * new - behind * old;
            match (model.points.get(d / 3), d % 3) {
                (Some(_), 0) => work.normal -= mean,
                (Some(point), 1) => {
                    let travel = [to, from].map(|state| state.interface.travel[point.pair]);
                    let slid = point.speed * (travel[0] - travel[1]);
                    work.drive -= 0.5 * slid * (old + new);
                    work.heat -= 0.5 * slid * (old + new) - mean;
                }
                (Some(_), _) => work.heat += mean,
                (None, _) => work.coupling -= mean,
            }
        }
        let scheme = weights.scheme;
        let lag = weights.step * weights.step * (scheme.beta - 0.5 * scheme.gamma);
        work.algorithm = (0.5 - scheme.alpha_f) * force_change
            + (scheme.gamma - 1.0 + scheme.alpha_m) * heavy
            - lag * (mean + (scheme.gamma - 0.5) * change)
            + gyroscopic;
        work
    }

    /// Residual of the balance: kinetic + strain − all work supplied.
    pub fn residual(&self) -> f64 {
        let fed = self.external + self.damping + self.normal + self.drive - self.heat + self.coupling;
        self.kinetic + self.strain - fed - self.algorithm
    }

    /// The sum of the sizes of all its terms, which the residual is measured by.
    pub fn turnover(&self) -> f64 {
        self.terms().iter().map(|t| t.abs()).sum()
    }

    /// Adds the work of another step.
    pub(super) fn add(&mut self, other: &Work) {
        self.terms_mut().into_iter().zip(other.terms()).for_each(|(sum, term)| *sum += term);
    }

    /// All its terms.
    pub(super) fn terms(&self) -> [f64; 9] {
        let mut copy = *self;
        copy.terms_mut().map(|term| *term)
    }

    /// All its terms, to be changed.
    pub(super) fn terms_mut(&mut self) -> [&mut f64; 9] {
        [
            &mut self.external,
            &mut self.damping,
            &mut self.normal,
            &mut self.drive,
            &mut self.heat,
            &mut self.coupling,
            &mut self.algorithm,
            &mut self.kinetic,
            &mut self.strain,
        ]
    }
}

/// −Δuᵀ G v̄ of G = W ½(c − cᵀ) Wᵀ, the gyroscopic part of an imported coupling of low rank.
fn gyroscopic_of_low_rank(model: &TransientModel<'_>, from: &State, to: &State) -> f64 {
    let Some([_, c]) = model.coupling else { return 0.0 };
    let first = model.n_directions() - c.nrows();
    let moved = |i: usize| to.along[(first + i, 0)] - from.along[(first + i, 0)];
    let rate = |i: usize| 0.5 * (to.along[(first + i, 1)] + from.along[(first + i, 1)]);
    let (r, mut sum) = (c.nrows(), 0.0);
    for j in 0..r {
        let own: f64 = (0..r).map(|i| moved(i) * 0.5 * (c[(i, j)] - c[(j, i)])).sum();
        sum -= own * rate(j);
    }
    sum
}
