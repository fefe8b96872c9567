//! How fast a mode of the band can grow at most, and the premises of that statement: M, C and H are symmetric and positive semidefinite.
//!
//! For Re s = σ ≥ R and |Im s| ≤ R the Hermitian part of s̄Q(s)/σ is
//!
//! K + K_σ + |s|²M + (|s|²/σ) (C + W c_s Wᵀ) + W [k_s + (ω/σ) i k_k] Wᵀ + (ω/σ) i K_k (+ (ω/σ) H),
//!
//! with k_s, c_s the symmetric and k_k the skew part of k and c, K_k the sparse skew part of K; that of C does no work. As |ω| ≤ σ and
//! |s|² ≥ R², it is positive definite, and s no eigenvalue, when C and H dissipate and
//! * ½ b M + W c_s Wᵀ is semidefinite, where friction falls, and
//! * K + K_σ + m R²M + W (k_s − |k_k| − 2b c₋) Wᵀ − |K_k| is positive definite, c₋ the negative part of c_s (σ ≤ b). Without falling
//!   friction m = 1 and b = 0; where R ≥ b the share m = ½ holds c₋ by itself, which is then left out. |K_k| is bounded by the
//!   diagonal of its row sums.
//!
//! Both are inertia counts. With the matrices of the structure any R beyond the largest growth rate will do that is large enough
//! by the norms of the rest in coordinates of unit mass; multiples of the band's top are tried.

use crate::dynamics::Operator;
use crate::error::Result;
use crate::linalg::SparseMatrix;
use crate::linalg::congruence::congruence;
use crate::linalg::dense::{product, symmetric_eigen};
use crate::linalg::factor::SymmetricFactor;
use crate::linalg::factor::inertia_like;
use crate::linalg::random::Random;
use crate::linalg::sparse::{add_scaled, diagonal, dot, entry, norm_1, times};
use faer::{Mat, MatRef};

/// R is sought among the band's top times 1, 4, …, 4 to this power.
const POWERS: i32 = 10;
/// Halvings of the logarithm of the last step, as a smaller R is easier to count.
const NARROWINGS: usize = 1;
/// Directions of friction up to which the mobility M⁻¹W is solved for.
const FEW: usize = 240;
/// Relative distance of a value from the least for which it is confirmed.
const MARGIN: f64 = 1e-6;
/// The part of K + τ²M that counts as rounding of the damping.
const SMALLEST_SHIFT: f64 = 1e-9;
/// Entries of scaled blocks below this are rounding.
const NOISE: f64 = 1e-14;

/// The matrices of an operator, and a factor with the pattern of M and K where one is at hand.
pub(in crate::stability) struct Definiteness<'a> {
    pub(in crate::stability) operator: &'a Operator<'a>,
    pub(in crate::stability) factor: Option<&'a dyn SymmetricFactor>,
}

impl Definiteness<'_> {
    fn inertia_is(&self, a: &SparseMatrix, zeros_allowed: bool) -> bool {
        let inertia = match self.factor {
            Some(factor) => inertia_like(factor, a),
            None => self.operator.engine.analyse(a.symbolic()).and_then(|symbolic| symbolic.inertia(a)),
        };
        inertia.is_ok_and(|i| i.negative == 0 && (zeros_allowed || i.zero == 0))
    }

    /// What the count takes for granted and is false, in words: each is proven by a factorisation.
    pub(super) fn broken_premise(&self) -> Option<&'static str> {
        let Operator { mass, stiffness, damping, .. } = self.operator;
        let others = [&damping.viscous, &damping.hysteretic].into_iter().flatten().map(|a| &**a);
        if [*mass, &**stiffness].into_iter().chain(others).any(|a| !symmetric(a)) {
            return Some("a matrix of the structure is not symmetric");
        }
        let rounding = rounding(mass);
        let sum = add_scaled(&[(1.0, *mass), (1.0, &rounding), (0.0, &**stiffness)]);
        (!self.inertia_is(&sum, true)).then_some("the mass matrix is not positive semidefinite")
    }

    /// Whether C and H have no negative eigenvalue, but for 1e-9 of K + τ²M at τ = `top`.
    pub(super) fn dissipates(&self, top: f64) -> bool {
        let Operator { mass, stiffness, damping, .. } = self.operator;
        let modal = damping.modal.as_ref().is_none_or(|modal| modal.coefficients.iter().all(|c| *c >= 0.0));
        let semidefinite = |a: &SparseMatrix, unit: f64| {
            let share = SMALLEST_SHIFT * unit;
            self.inertia_is(&add_scaled(&[(1.0, a), (share, &**stiffness), (share * top * top, mass)]), true)
        };
        modal
            && damping.viscous.as_ref().is_none_or(|c| semidefinite(c, 1.0 / top))
            && damping.hysteretic.as_ref().is_none_or(|h| semidefinite(h, 1.0))
    }

    /// Whether no real eigenvalue is positive: sᵀQ(s)s of a real s > 0 has no negative value where the symmetric parts of K + K_c and
    /// C + C_c have none.
    pub(in crate::stability) fn no_divergence(&self) -> Result<bool> {
        let Operator { mass, stiffness, damping, .. } = self.operator;
        let InterfaceBounds { stiffness: contact, falling } =
            InterfaceBounds::new(self.operator, 1.0, false)?;
        let mut terms = vec![(0.0, *mass), (1.0, &**stiffness)];
        terms.extend(contact.iter().map(|contact| (1.0, contact)));
        let damped = damping.viscous.as_ref().is_none_or(|c| self.inertia_is(c, true));
        let modal = damping.modal.as_ref().is_none_or(|modal| modal.coefficients.iter().all(|c| *c >= 0.0));
        Ok(falling.is_none() && damped && modal && self.inertia_is(&add_scaled(&terms), true))
    }

    /// The least R of those tried, `top` or more, for which no eigenvalue with |ω| ≤ R has a growth rate of R or more; `None` where
    /// there is none. C and H must dissipate.
    pub(in crate::stability) fn fastest(&self, top: f64) -> Result<Option<f64>> {
        let InterfaceBounds { stiffness: contact, falling } = InterfaceBounds::new(self.operator, top, true)?;
        let (mass, stiffness) = (self.operator.mass, &*self.operator.stiffness);
        let skew = self.operator.skew.map(|skew| row_sums(&skew.stiffness));
        let slowest_falling = match &falling {
            Some(_) => self.inertia_against_friction(top),
            None => Some(0.0),
        };
        let Some(b) = slowest_falling else { return Ok(None) };
        Ok(least(top, |radius| {
            let share = if b > 0.0 && radius >= b { 0.5 } else { 1.0 };
            let mut terms = vec![(share * radius * radius, mass), (1.0, stiffness)];
            terms.extend(contact.iter().map(|contact| (1.0, contact)));
            terms.extend(skew.iter().map(|skew| (-1.0, skew)));
            terms.extend(falling.iter().filter(|_| radius < b).map(|falling| (-2.0 * b, falling)));
            self.inertia_is(&add_scaled(&terms), false)
        }))
    }

    /// The least b, `top` or more, for which ½ b M + W c_s Wᵀ is positive semidefinite: b = −2 λ_min(G^½ c_s G^½) with G = WᵀM⁻¹W
    /// where friction acts in few directions, which an inertia count confirms; else the least that is tried.
    fn inertia_against_friction(&self, top: f64) -> Option<f64> {
        let direct = self.direct_inertia_against_friction().map(|b| (b * (1.0 + MARGIN)).max(top));
        let confirmed = direct.filter(|b| b.is_finite() && self.holds_against_friction(*b, false));
        let holds = |b| self.holds_against_friction(b, true) || self.holds_against_friction(b, false);
        confirmed.or_else(|| least(top, holds))
    }

    fn direct_inertia_against_friction(&self) -> Option<f64> {
        let Operator { mass, stiffness, interface, engine, .. } = self.operator;
        let terms = || interface.terms.iter().filter(|term| term.damping != 0.0);
        let mut acting: Vec<usize> = terms().flat_map(|term| [term.row, term.column]).collect();
        acting.sort_unstable();
        acting.dedup();
        let r = acting.len();
        if r > FEW {
            return None;
        }
        let mut small = Mat::<f64>::zeros(r, r);
        for term in terms() {
            let [i, j] = [term.row, term.column].map(|d| acting.binary_search(&d).expect("it acts"));
            small[(i, j)] += 0.5 * term.damping;
            small[(j, i)] += 0.5 * term.damping;
        }
        let inertia = add_scaled(&[(1.0, *mass), (1.0, &rounding(mass)), (0.0, &**stiffness)]);
        let factor = engine.factorize(&inertia).ok()?;
        let mut forces = Mat::<f64>::zeros(self.operator.n(), r);
        for (j, d) in acting.iter().enumerate() {
            interface.directions[*d].add_to(1.0, forces.col_as_slice_mut(j));
        }
        factor.solve_in_place(forces.as_mut());
        let mobility = |i: usize, j: usize| interface.directions[acting[i]].dot(forces.col_as_slice(j));
        let mobility = Mat::from_fn(r, r, |i, j| 0.5 * (mobility(i, j) + mobility(j, i)));
        let root = function(mobility.as_ref(), |v| v.max(0.0).sqrt()).ok()?;
        let within = product(root.as_ref(), product(small.as_ref(), root.as_ref()).as_ref());
        let (values, _) = symmetric_eigen(within.as_ref()).ok()?;
        Some(-2.0 * values[0])
    }

    /// Whether ½ b M + W c_s Wᵀ is positive semidefinite, M taken with the rounding of its entries ([`rounding`]): by a diagonal
    /// below W c_s Wᵀ in its place, which is in the pattern whose analysis is at hand, or as it is.
    fn holds_against_friction(&self, b: f64, by_diagonal: bool) -> bool {
        let (mass, stiffness) = (self.operator.mass, &*self.operator.stiffness);
        let friction = symmetric_damping(self.operator);
        let friction = if by_diagonal { diagonal_below(&friction, mass) } else { friction };
        let rounding = rounding(mass);
        let terms = [(0.5 * b, mass), (0.5 * b, &rounding), (0.0, stiffness), (1.0, &friction)];
        self.inertia_is(&add_scaled(&terms), false)
    }
}

/// The least of the values tried, `top` or more, from which on something holds.
fn least(top: f64, holds: impl Fn(f64) -> bool) -> Option<f64> {
    let mut tried = (0..=POWERS).map(|power| top * 4f64.powi(power));
    let mut least = tried.find(|value| holds(*value))?;
    if least == top {
        return Some(top);
    }
    let mut open = 0.25 * least;
    for _ in 0..NARROWINGS {
        let middle = (open * least).sqrt();
        if holds(middle) { least = middle } else { open = middle }
    }
    Some(least)
}

/// Whether xᵀAy = yᵀAx for two random vectors, but for rounding.
fn symmetric(a: &SparseMatrix) -> bool {
    let mut random = Random::new();
    let x = Mat::from_fn(a.ncols(), 2, |_, _| random.next());
    let image = times(a, x.as_ref());
    let form = |i: usize, j: usize| dot(x.col_as_slice(i), image.col_as_slice(j));
    (form(0, 1) - form(1, 0)).abs() <= 1e-10 * norm_1(a) * (a.ncols() as f64).sqrt()
}

/// The diagonal of the row sums of |aᵢⱼ|, and zeros elsewhere.
fn row_sums(a: &SparseMatrix) -> SparseMatrix {
    let sum = |j: usize| a.val_of_col(j).iter().map(|v| v.abs()).sum();
    let triplets: Vec<_> = (0..a.ncols()).map(|j| entry(j, j, sum(j))).collect();
    SparseMatrix::try_new_from_triplets(a.nrows(), a.ncols(), &triplets).expect("a diagonal")
}

/// The interface bounded by sparse symmetric matrices, none where there is nothing of the kind. k and c are block-diagonal: |k_k| and c₋
/// are those of every block.
struct InterfaceBounds {
    /// W (k_s − |k_k|) Wᵀ, or W k_s Wᵀ where nothing oscillates.
    stiffness: Option<SparseMatrix>,
    /// W c₋ Wᵀ, c₋ the negative part of c_s.
    falling: Option<SparseMatrix>,
}

impl InterfaceBounds {
    fn new(operator: &Operator<'_>, top: f64, oscillating: bool) -> Result<Self> {
        let interface = &operator.interface;
        let scale: Vec<f64> = interface.sizes(top).iter().map(|s| s.sqrt()).collect();
        let (mut stiffness, mut falling) = (Vec::new(), Vec::new());
        for block in interface.blocks() {
            let r = block.directions.len();
            let size = |i: usize, j: usize| scale[block.directions[i]] * scale[block.directions[j]];
            let scaled = |a: &Mat<f64>| {
                Mat::from_fn(r, r, |i, j| if size(i, j) > 0.0 { a[(i, j)] / size(i, j) } else { 0.0 })
            };
            let (k, c) = (scaled(&block.stiffness), scaled(&block.damping));
            let part =
                |a: &Mat<f64>, sign: f64| Mat::from_fn(r, r, |i, j| 0.5 * (a[(i, j)] + sign * a[(j, i)]));
            let (k_s, k_k, c_s) = (part(&k, 1.0), part(&k, -1.0), part(&c, 1.0));
            let skew = function(product(k_k.transpose(), k_k.as_ref()).as_ref(), |v| v.max(0.0).sqrt())?;
            let noise = NOISE * c_s.norm_max();
            let negative = function(c_s.as_ref(), |v| if v < -noise { -v } else { 0.0 })?;
            let worst = if oscillating { k_s - skew } else { k_s };
            let directions = interface.directions_of(&block);
            for (small, triplets) in [(&worst, &mut stiffness), (&negative, &mut falling)] {
                let noise = NOISE * small.norm_max();
                let large = Mat::from_fn(r, r, |i, j| match small[(i, j)] {
                    value if value.abs() > noise => value * size(i, j),
                    _ => 0.0,
                });
                triplets.extend(congruence(&directions, large.as_ref()));
            }
        }
        let n = operator.n();
        let matrix = |triplets: Vec<_>| {
            let sum = SparseMatrix::try_new_from_triplets(n, n, &triplets).expect("directions of the system");
            (!triplets.is_empty()).then_some(sum)
        };
        Ok(InterfaceBounds { stiffness: matrix(stiffness), falling: matrix(falling) })
    }
}

/// f of a symmetric matrix.
fn function(a: MatRef<'_, f64>, f: impl Fn(f64) -> f64) -> Result<Mat<f64>> {
    let (values, vectors) = symmetric_eigen(a)?;
    let n = values.len();
    let scaled = Mat::from_fn(n, n, |i, j| vectors[(i, j)] * f(values[j]));
    Ok(product(scaled.as_ref(), vectors.transpose()))
}

/// A diagonal that bounds the rounding of M, d_i = 1e-14 |m_ii| + u max m: massless degrees of freedom have pivots of either
/// sign of that size, whatever the units, and M + D is a mass matrix equal to the given one within rounding.
fn rounding(mass: &SparseMatrix) -> SparseMatrix {
    let own = diagonal(mass);
    let largest = own.iter().fold(0.0f64, |l, m| l.max(*m));
    let entries: Vec<_> =
        own.iter().enumerate().map(|(i, m)| entry(i, i, 1e-14 * m.abs() + f64::EPSILON * largest)).collect();
    SparseMatrix::try_new_from_triplets(own.len(), own.len(), &entries).expect("a diagonal")
}

/// A diagonal D with A − D positive semidefinite: by Gershgorin's discs of A in coordinates of unit mass,
/// dᵢ = mᵢ (aᵢᵢ/mᵢ − Σ_{j≠i} |aᵢⱼ| / √(mᵢmⱼ)), mᵢ the diagonal of M, where it is no mass its rounding.
fn diagonal_below(a: &SparseMatrix, mass: &SparseMatrix) -> SparseMatrix {
    let own = diagonal(mass);
    let least = f64::EPSILON * own.iter().fold(0.0f64, |l, m| l.max(*m));
    let m = |i: usize| own[i].max(least);
    let bound = |j: usize| {
        let entries = a.row_idx_of_col(j).zip(a.val_of_col(j));
        entries.map(|(i, v)| if i == j { *v } else { -v.abs() * (m(j) / m(i)).sqrt() }).sum()
    };
    let rows = (0..a.ncols()).filter(|j| !a.row_idx_of_col_raw(*j).is_empty());
    let triplets: Vec<_> = rows.map(|j| entry(j, j, bound(j))).collect();
    SparseMatrix::try_new_from_triplets(a.nrows(), a.ncols(), &triplets).expect("indices of a matrix")
}

/// W c_s Wᵀ as a sparse matrix.
fn symmetric_damping(operator: &Operator<'_>) -> SparseMatrix {
    let (interface, n) = (&operator.interface, operator.n());
    let mut triplets = Vec::new();
    for term in interface.terms.iter().filter(|t| t.damping != 0.0) {
        let (row, column) = (interface.directions[term.row], interface.directions[term.column]);
        for (i, a) in row.iter() {
            for (j, b) in column.iter() {
                let value = 0.5 * term.damping * (a * b);
                triplets.extend([entry(i, j, value), entry(j, i, value)]);
            }
        }
    }
    SparseMatrix::try_new_from_triplets(n, n, &triplets).expect("directions of the system")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::samples;

    #[test]
    fn diagonal_lies_below() {
        let n = 40;
        let mass = Mat::from_fn(n, n, |i, j| if i == j { 10f64.powi(i as i32 % 7 - 3) } else { 0.0 });
        let coupled = |i: usize| i % 3 == 1;
        let a = Mat::from_fn(n, n, |i, j| match coupled(i) && coupled(j) {
            true => ((i + j) as f64).cos() * (mass[(i, i)] * mass[(j, j)]).sqrt(),
            false => 0.0,
        });
        let below = diagonal_below(&samples::from_dense(a.as_ref()), &samples::from_dense(mass.as_ref()));
        assert!(below.compute_nnz() == (0..n).filter(|i| coupled(*i)).count());
        // In coordinates of unit mass, so that no entry is lost beside others.
        let rest = Mat::from_fn(n, n, |i, j| {
            let d = if i == j { below.get(i, i).copied().unwrap_or(0.0) } else { 0.0 };
            (a[(i, j)] - d) / (mass[(i, i)] * mass[(j, j)]).sqrt()
        });
        let (values, _) = symmetric_eigen(rest.as_ref()).unwrap();
        assert!(values[0] > -1e-12, "{}", values[0]);
    }
}
