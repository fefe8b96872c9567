//! Complex eigenvalues of a system whose stiffness is changed a little, estimated on the modes near them.

use super::ComplexMode;
use super::projected::solve;
use crate::dynamics::{Block, Operator, Side};
use crate::equilibrium::SteadySliding;
use crate::error::Result;
use crate::linalg::c64;
use crate::linalg::orthogonal::thin_svd;
use crate::modal::RealModes;
use crate::system::System;
use faer::Mat;

/// Complex and real modes nearest in frequency that the estimate is made of.
const COMPLEX: usize = 8;
const REAL: usize = 24;
/// Directions of them that are weaker than this are dependent.
const DEPENDENT: f64 = 1e-9;
/// Steps in which the change is applied, so that eigenvalues are followed.
const STEPS: usize = 32;
/// An eigenvalue that the projection has not to this part of itself is not followed.
const THERE: f64 = 1e-6;
/// Eigenvalues up to so many times the least distance are as near.
const AS_NEAR: f64 = 2.0;

/// ΔK = Σ κ g gᵀ.
#[derive(Debug, Clone, Default)]
pub struct StiffnessChange {
    /// κ and g on the degrees of freedom, for φᵀMφ = 1 of the modes φ of a part with g = Mφ: κ the change of ω² \[rad²/s²\].
    pub terms: Vec<(f64, Vec<f64>)>,
}

/// Where the change takes the eigenvalues of the modes numbered `which`: λ of Vᵀ(Q(λ) + t ΔK)V from t = 0 to 1, with V the span of the real and
/// imaginary parts of the complex modes and of the real modes that are nearest in frequency. For t = 0 these are the modes' own, as V has them; for
/// t = 1 the error is of first order in what the change mixes in from beyond V. `None` where one is not followed.
///
/// # Errors
/// A geometric stiffness that cannot be worked out.
pub fn changed_eigenvalues(
    (system, steady): (&System, &SteadySliding),
    (modes, real): (&[ComplexMode], &RealModes),
    which: &[usize],
    change: &StiffnessChange,
) -> Result<Vec<Option<c64>>> {
    let operator = Operator::new(system, steady)?;
    let followed = |k: &usize| {
        let lambda = modes[*k].eigenvalue;
        let basis = nearest(lambda, modes, real)?;
        Projected::new(&operator, basis, lambda.norm(), change).followed(lambda)
    };
    Ok(which.iter().map(followed).collect())
}

/// An orthonormal basis of the modes nearest to an eigenvalue.
fn nearest(lambda: c64, modes: &[ComplexMode], real: &RealModes) -> Option<Mat<f64>> {
    let apart = |omega: f64| (omega - lambda.im).abs();
    let mut near: Vec<&ComplexMode> = modes.iter().filter(|mode| mode.accurate()).collect();
    near.sort_by(|a, b| apart(a.eigenvalue.im).total_cmp(&apart(b.eigenvalue.im)));
    near.truncate(COMPLEX);
    let omega = |k: usize| real.eigenvalues[k].max(0.0).sqrt();
    let mut of_structure: Vec<usize> = (0..real.len()).collect();
    of_structure.sort_by(|a, b| apart(omega(*a)).total_cmp(&apart(omega(*b))));
    of_structure.truncate(REAL);
    let n = real.shapes.nrows();
    let mut columns: Vec<Vec<f64>> = Vec::new();
    for mode in near {
        columns
            .extend([mode.right.iter().map(|z| z.re).collect(), mode.right.iter().map(|z| z.im).collect()]);
    }
    columns.extend(of_structure.iter().map(|k| real.shapes.col_as_slice(*k).to_vec()));
    let norm = |column: &[f64]| column.iter().map(|x| x * x).sum::<f64>().sqrt();
    columns.retain(|column| norm(column) > 0.0);
    let lengths: Vec<f64> = columns.iter().map(|column| norm(column)).collect();
    let scaled = Mat::from_fn(n, columns.len(), |i, j| columns[j][i] / lengths[j]);
    let svd = thin_svd(scaled.as_ref())?;
    let rank = svd.values.iter().take_while(|value| **value > DEPENDENT * svd.values[0]).count();
    Some(svd.left.subcols(0, rank).to_owned())
}

/// M, C, K, H and ΔK on a basis, all real.
struct Projected {
    mass: Mat<f64>,
    damping: Mat<f64>,
    stiffness: Mat<f64>,
    hysteretic: Mat<f64>,
    change: Mat<f64>,
    shift: f64,
}

impl Projected {
    /// Q(0) = K + iH and Q(iω) = K − ω²M + i (ωC + H) for an ω of the size of the eigenvalues.
    fn new(operator: &Operator<'_>, basis: Mat<f64>, omega: f64, change: &StiffnessChange) -> Self {
        let (n, m) = basis.shape();
        let x = Block::from_fn(n, m, |i, j| c64::new(basis[(i, j)], 0.0));
        let at = |lambda: c64| {
            let y = operator.value(Side::Right, &vec![lambda; m], &x);
            [0, 1].map(|part| {
                let y = Mat::from_fn(n, m, |i, j| {
                    let z = y.get(i, j);
                    [z.re, z.im][part]
                });
                basis.transpose() * y
            })
        };
        let [stiffness, hysteretic] = at(c64::new(0.0, 0.0));
        let [moved, damped] = at(c64::new(0.0, omega));
        let mut projected = Projected {
            mass: (&stiffness - moved) * faer::Scale(1.0 / (omega * omega)),
            damping: (damped - &hysteretic) * faer::Scale(1.0 / omega),
            change: Mat::zeros(m, m),
            stiffness,
            hysteretic,
            shift: omega,
        };
        for (kappa, direction) in &change.terms {
            let along: Vec<f64> = (0..m)
                .map(|j| basis.col_as_slice(j).iter().zip(direction).map(|(x, g)| x * g).sum())
                .collect();
            for (i, j) in (0..m).flat_map(|i| (0..m).map(move |j| (i, j))) {
                projected.change[(i, j)] += kappa * along[i] * along[j];
            }
        }
        projected
    }

    /// The eigenvalues about the shift with a part of the change.
    fn eigenvalues(&self, part: f64) -> Option<Vec<c64>> {
        let stiffness = &self.stiffness + &self.change * faer::Scale(part);
        let hysteretic = (self.hysteretic.norm_max() > 0.0).then_some(&self.hysteretic);
        let near = |z: c64| z.im > 0.0 && z.norm() < 4.0 * self.shift;
        let pairs = solve(&self.mass, &self.damping, &stiffness, hysteretic, self.shift, near).ok()?;
        Some(pairs.iter().map(|pair| pair.lambda).collect())
    }

    /// The eigenvalue that `lambda` becomes, each step the nearest to where the last two lead; where two are about as near, as where they meet, the
    /// one that grows faster.
    fn followed(&self, lambda: c64) -> Option<c64> {
        let apart = |all: &[c64], to: c64| all.iter().map(|z| (z - to).norm()).fold(f64::INFINITY, f64::min);
        let nearest = |all: &[c64], to: c64| {
            let reach = AS_NEAR * apart(all, to);
            let near = all.iter().copied().filter(|z| (z - to).norm() <= reach);
            near.max_by(|a, b| a.re.total_cmp(&b.re))
        };
        let all = self.eigenvalues(0.0)?;
        if apart(&all, lambda) > THERE * lambda.norm() {
            return None;
        }
        let start = all.into_iter().min_by(|a, b| (a - lambda).norm().total_cmp(&(b - lambda).norm()))?;
        let mut last = [start, start];
        for step in 1..=STEPS {
            let all = self.eigenvalues(step as f64 / STEPS as f64)?;
            last = [last[1], nearest(&all, last[1] * 2.0 - last[0])?];
        }
        Some(last[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::equilibrium::samples::sparse;
    use crate::equilibrium::{SteadyOptions, solve_steady};
    use crate::linalg::SparseVector;
    use crate::linalg::random::Random;
    use crate::modal::samples::dense_modes;
    use crate::stability::complex_modes;
    use crate::system::{Coupling, Damping, Structure};

    /// A double mode of a disc, which a mesh has split, in contact: q̈ + 2δ q̇ + diag(ω₁², ω₂²) q + \[\[k, b\], \[−b, 0\]\] q = 0. With p = λ² + 2δλ,
    /// p² + (ω₁² + k + ω₂²) p + (ω₁² + k) ω₂² + b² = 0.
    fn exact([first, second]: [f64; 2], k: f64, b: f64, delta: f64) -> Vec<c64> {
        let (sum, product) = (first + k + second, (first + k) * second + b * b);
        let root = c64::new(0.25 * sum * sum - product, 0.0).sqrt();
        let p = [root - 0.5 * sum, -root - 0.5 * sum];
        p.iter()
            .map(|p| (p + delta * delta).sqrt() - delta)
            .map(|z| if z.im < 0.0 { -z - 2.0 * delta } else { z })
            .collect()
    }

    /// Both ways: contact stiffness that a split takes away, so that friction couples the two (unstable by the mesh alone), and a split that holds
    /// apart what friction would couple (stable by the mesh alone), beside other modes and turned into other freedoms.
    #[test]
    fn a_split_double_mode_has_its_growth_without_the_split() {
        let mut random = Random::seeded(12);
        let mut verdicts = [0; 4];
        for trial in 0..200 {
            let omega: f64 = 10f64.powf(random.between(2.0, 5.0));
            let w = omega * omega;
            let (split, k) = (random.between(-2e-3, 2e-3) * w, random.between(-1e-3, 2e-3) * w);
            let (b, delta) = (random.between(1e-5, 1e-3) * w, random.between(0.0, 1e-5) * omega);
            let own = [w + 0.5 * split, w - 0.5 * split, 1.7 * w, 0.3 * w];
            let (n, angle) = (4, random.between(0.0, 3.0));
            let (sin, cos) = angle.sin_cos();
            // Freedoms turned in the planes (0, 2) and (1, 3).
            let turn = Mat::from_fn(n, n, |i, j| match (i, j) {
                _ if i == j => cos,
                (0, 2) | (1, 3) => -sin,
                (2, 0) | (3, 1) => sin,
                _ => 0.0,
            });
            let column = |k: usize| -> Vec<f64> { (0..n).map(|i| turn[(i, k)]).collect() };
            let stiffness =
                &turn * Mat::from_fn(n, n, |i, j| if i == j { own[i] } else { 0.0 }) * turn.transpose();
            let of = |a: &dyn Fn(usize, usize) -> f64| std::sync::Arc::new(sparse(n, a));
            let damping = Damping {
                viscous: Some(of(&|i, j| if i == j { 2.0 * delta } else { 0.0 })),
                ..Damping::default()
            };
            let structure = Structure {
                mass: of(&|i, j| f64::from(i == j)),
                stiffness: of(&|i, j| 0.5 * (stiffness[(i, j)] + stiffness[(j, i)])),
                damping,
                engine: Default::default(),
            };
            let mut system = System::new(structure, Vec::new());
            let direction = |k: usize| SparseVector::from_entries(column(k).into_iter().enumerate());
            system.coupling = Some(Coupling {
                directions: vec![direction(0), direction(1)],
                stiffness: Mat::from_fn(2, 2, |i, j| [[k, b], [-b, 0.0]][i][j]),
                damping: Mat::zeros(2, 2),
                skew: None,
            });
            let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
            let real = dense_modes(&system, n);
            let band = [0.8 * omega / std::f64::consts::TAU, 1.2 * omega / std::f64::consts::TAU];
            let modes = complex_modes(&system, &steady, &real, band, &()).unwrap().modes;
            assert_eq!(modes.len(), 2);
            let change = StiffnessChange { terms: vec![(-0.5 * split, column(0)), (0.5 * split, column(1))] };
            let found = changed_eigenvalues((&system, &steady), (&modes, &real), &[0, 1], &change).unwrap();
            let largest = |all: &[c64]| all.iter().map(|z| z.re).fold(f64::NEG_INFINITY, f64::max);
            let [with, without] = [[own[0], own[1]], [w, w]].map(|own| exact(own, k, b, delta));
            // Where two eigenvalues all but meet, they are known to the root of rounding.
            let discriminant = (0.25 * k * k - b * b).abs() / (w * w);
            let bound = omega * (1e-11 / discriminant.sqrt()).max(1e-11);
            let found: Vec<c64> = found.into_iter().map(|z| z.unwrap()).collect();
            assert!(
                within(largest(&found) - largest(&without), bound, RoundOff),
                "{trial}: {found:?} {without:?}"
            );
            let unstable = [largest(&with), largest(&without)].map(|growth| growth > 1e-9 * omega);
            verdicts[usize::from(unstable[0]) + 2 * usize::from(unstable[1])] += 1;
        }
        assert!(verdicts.iter().all(|count| *count > 10), "{verdicts:?}");
    }
}
