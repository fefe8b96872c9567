//! K φ = ω² M φ: the modes of a structure up to a frequency, or a number of them.

use super::{RealModes, SturmCertificate};
use crate::error::{Error, Fault, Result};
use crate::linalg::{
    Eigenpairs, SparseMatrix, SymmetricFactor, Wanted, eigenpairs_below, lowest_eigenpairs_by,
};
use crate::progress::Observer;
use crate::system::Structure;
use std::f64::consts::TAU;

/// Which modes are wanted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ModesWanted {
    /// All below this frequency \[Hz\].
    BelowHz(f64),
    /// This many of the lowest; of a double mode both.
    Count(usize),
}

/// K − σM, factorised in the middle of the modes that were computed: for static and residual responses near them.
#[derive(Debug)]
pub struct ShiftedStiffness {
    /// σ \[rad²/s²\].
    pub shift: f64,
    /// The factors.
    pub factor: Box<dyn SymmetricFactor>,
}

/// Real modes (ω², φ) of `structure`, undamped: K φ = ω² M φ, φᵀMφ = 1, complete by a Sturm count.
///
/// # Errors
/// As [`compute`].
pub fn real_modes(structure: &Structure, wanted: ModesWanted) -> Result<RealModes> {
    compute(structure, wanted, &()).map(|(modes, _)| modes)
}

/// Real modes of `structure`, undamped, with the factorisation that found them.
///
/// # Errors
/// [`Error::Input`] when the wanted frequency or number is not positive; [`Error::Analysis`] when a degree of freedom
/// has neither stiffness nor mass, or when the Sturm count finds modes that the iteration did not.
pub fn compute(
    structure: &Structure,
    wanted: ModesWanted,
    observer: &dyn Observer,
) -> Result<(RealModes, ShiftedStiffness)> {
    let (range, below) = match wanted {
        ModesWanted::BelowHz(hz) if !hz.is_finite() || hz <= 0.0 => {
            return Err(Error::input(Fault::new(
                "highest frequency of the modes",
                hz.to_string(),
                "a positive, finite number of hertz",
            )));
        }
        ModesWanted::Count(0) => {
            return Err(Error::input(Fault::new("number of modes", "0", "at least 1")));
        }
        ModesWanted::BelowHz(hz) => (format!("below {hz} Hz"), Wanted::Below((TAU * hz).powi(2))),
        ModesWanted::Count(count) => (format!("the lowest {count}"), Wanted::Count(count)),
    };
    let pairs =
        lowest_eigenpairs_by(&structure.engine, &structure.stiffness, &structure.mass, below, observer);
    pairs.map(|pairs| modes_and_factor(structure, pairs)).map_err(|e| failed(&range, e))
}

/// Real modes of `structure` below `hz`, or a shade above it, where K − σM is factorised already at a shift σ among them: as
/// exact as the basis of a complex analysis needs, backward errors of 1e-11.
///
/// # Errors
/// As [`compute`].
pub fn compute_from(
    structure: &Structure,
    hz: f64,
    start: ShiftedStiffness,
    observer: &dyn Observer,
) -> Result<(RealModes, ShiftedStiffness)> {
    let (start, bound) = ((start.shift, start.factor), (TAU * hz).powi(2));
    let pairs = eigenpairs_below(&structure.stiffness, &structure.mass, bound, start, observer);
    pairs.map(|pairs| modes_and_factor(structure, pairs)).map_err(|e| failed(&format!("below {hz} Hz"), e))
}

/// An error of the eigenvalues as one of the modes in a range.
fn failed(range: &str, error: Error) -> Error {
    match error {
        Error::Analysis { what, found, help } => {
            Error::analysis(format!("real modes, {range}, {what} θ = ω²"), found, help)
        }
        other => other,
    }
}

/// Modes with their Sturm certificate, and the factorised K − σM, of eigenpairs.
fn modes_and_factor(structure: &Structure, pairs: Eigenpairs) -> (RealModes, ShiftedStiffness) {
    let hz = |theta: f64| theta.max(0.0).sqrt() / TAU;
    let certificate = SturmCertificate {
        below_hz: hz(pairs.sturm.bound),
        shifts_hz: pairs.sturm.shifts.map(hz),
        counted: pairs.sturm.counted,
        found: pairs.values.len(),
    };
    // Those of the lowest modes, as far as they have none or a negative one.
    let mut energies: Vec<[f64; 2]> = Vec::new();
    for k in 0..pairs.values.len() {
        let [energy, size] = strain_energy(&structure.stiffness, pairs.vectors.col_as_slice(k));
        energies.push([energy, size]);
        if energy > STRAINLESS * size {
            break;
        }
    }
    let modes = RealModes {
        rigid_bodies: count_rigid_bodies(&pairs.values, &energies),
        negative: energies.iter().take_while(|[energy, size]| *energy < -STRAINLESS * size).count(),
        eigenvalues: pairs.values,
        shapes: pairs.vectors,
        backward_errors: pairs.backward_errors,
        certificate,
    };
    (modes, ShiftedStiffness { shift: pairs.shift, factor: pairs.factor })
}

/// A strain energy below this part of the sum of the magnitudes of its terms is none.
const STRAINLESS: f64 = 1e-12;

/// φᵀKφ of a shape, and the sum of the magnitudes of its terms.
fn strain_energy(stiffness: &SparseMatrix, shape: &[f64]) -> [f64; 2] {
    let (mut energy, mut size) = (0.0, 0.0);
    for j in 0..stiffness.ncols() {
        for (i, v) in stiffness.row_idx_of_col(j).zip(stiffness.val_of_col(j)) {
            let term = shape[i] * v * shape[j];
            energy += term;
            size += term.abs();
        }
    }
    [energy, size]
}

/// The number of leading modes with ω ≤ 1e-3 of the first elastic one and no strain energy: φᵀKφ vanishes against the
/// sum of the magnitudes of its terms.
fn count_rigid_bodies(eigenvalues: &[f64], energies: &[[f64; 2]]) -> usize {
    let strainless = energies.iter().take_while(|[energy, size]| energy.abs() <= STRAINLESS * size).count();
    (0..=strainless)
        .rev()
        .find(|n| {
            let last = n.checked_sub(1).map_or(0.0, |k| eigenvalues[k].abs());
            eigenvalues.get(*n).is_none_or(|elastic| last <= 1e-6 * elastic.abs())
        })
        .unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::linalg::samples;
    use crate::system::Damping;

    fn structure((stiffness, mass): (SparseMatrix, SparseMatrix)) -> Structure {
        Structure {
            mass: mass.into(),
            stiffness: stiffness.into(),
            damping: Damping::default(),
            engine: Default::default(),
        }
    }

    #[test]
    fn free_plate_has_three_rigid_bodies_and_a_certificate() {
        let structure = structure(samples::plate(20, false));
        let (modes, kept) = compute(&structure, ModesWanted::BelowHz(1000.0), &()).unwrap();
        assert_eq!(modes.rigid_bodies, 3);
        assert!(
            modes.certificate.holds() && within((modes.certificate.below_hz - 1000.0).abs(), 1e-9, RoundOff)
        );
        let [low, high] = modes.certificate.shifts_hz;
        assert!(low < 1000.0 && 1000.0 < high && high - low < 1.0);
        assert!((0..3).all(|k| within(modes.frequency_hz(k), 1e-3 * modes.frequency_hz(3), RoundOff)));
        // Leissa, NASA SP-160 (1969), table 4.65: ω a² √(ρh/D) = 13.489, 19.789, 24.432 for ν = 0.3 (Ritz, upper
        // bounds); the elements are non-conforming, hence from below.
        let factor = {
            let d = 210e9 * 1e-9 / (12.0 * 0.91);
            (d / (7850.0 * 1e-3f64)).sqrt() / (0.15 * 0.15) / TAU
        };
        for (k, parameter) in [(3, 13.489), (4, 19.789), (5, 24.432)] {
            assert!(
                within((modes.frequency_hz(k) / (parameter * factor) - 1.0).abs(), 0.01, Discretisation),
                "{}",
                modes.frequency_hz(k)
            );
        }
        assert_eq!(kept.factor.n(), structure.n_dofs());
        let inside = modes.eigenvalues.iter().filter(|v| **v < kept.shift).count();
        assert_eq!(kept.factor.inertia().negative, inside);
    }

    #[test]
    fn a_soft_spring_is_not_a_rigid_body() {
        let (mut stiffness, mass) = samples::free_chain(20);
        stiffness.val_of_col_mut(0)[0] += 1e-9;
        let held = structure((stiffness, mass.clone()));
        assert_eq!(compute(&held, ModesWanted::Count(4), &()).unwrap().0.rigid_bodies, 0);
        let free = structure(samples::free_chain(20));
        assert_eq!(compute(&free, ModesWanted::Count(4), &()).unwrap().0.rigid_bodies, 1);
        assert_eq!(compute(&free, ModesWanted::BelowHz(1e-3), &()).unwrap().0.rigid_bodies, 1);
    }

    #[test]
    fn single_mass_on_a_spring() {
        let one = |v: f64| samples::from_dense(faer::mat![[v]].as_ref());
        let oscillator = structure((one(400.0), one(4.0)));
        let (modes, _) = compute(&oscillator, ModesWanted::Count(1), &()).unwrap();
        assert!(within((modes.frequency_hz(0) * TAU - 10.0).abs(), 1e-12, RoundOff));
        assert!(within((modes.shapes[(0, 0)].abs() - 0.5).abs(), 1e-15, RoundOff));
    }

    #[test]
    fn faults_name_what_is_wrong() {
        let (stiffness, mass) = samples::free_chain(5);
        let chain = structure((stiffness, mass));
        for wanted in [ModesWanted::BelowHz(0.0), ModesWanted::BelowHz(f64::NAN), ModesWanted::Count(0)] {
            assert_eq!(compute(&chain, wanted, &()).unwrap_err().exit_code(), 2);
        }
        let hole = samples::from_dense(faer::mat![[1.0, 0.0], [0.0, 0.0]].as_ref());
        let error = compute(&structure((hole.clone(), hole)), ModesWanted::Count(1), &()).unwrap_err();
        assert!(error.to_string().contains("row 1") && error.exit_code() == 1, "{error}");
    }
}
