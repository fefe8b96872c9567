//! Complex modes: by projection, and at full order where that is not accurate for what has no low rank.
//!
//! Sparse skew parts, gyroscopic of C and circulatory of K, are projected as C and K are: the symmetric factor A of the structure
//! gives corrections −A⁻¹Q(λ)φ that meet λG only where the basis does not reach. Where a mode stays inaccurate, as with a G that is
//! not small beside K/ω, two-level Arnoldi at full order finds all of them.

use super::analysis::{analyse, check};
use super::band::Band;
use super::general::{General, general_modes};
use super::{ComplexModes, Structural};
use crate::dynamics::Operator;
use crate::equilibrium::SteadySliding;
use crate::error::Result;
use crate::modal::RealModes;
use crate::progress::Observer;
use crate::system::System;

/// The complex eigenvalues λ = σ + iω \[1/s\] with ω/2π in `band_hz` and their modes: see [`complex_modes`].
///
/// # Errors
/// As [`complex_modes`].
pub fn complex_eigenvalues(
    system: &System,
    steady: &SteadySliding,
    real: &RealModes,
    band_hz: [f64; 2],
) -> Result<ComplexModes> {
    complex_modes(system, steady, real, band_hz, &())
}

/// All complex modes with a frequency in `band`, or those of them that it asks for, of `system` sliding steadily.
///
/// * Basis: the real modes (of K + K_σ and M, M-orthonormal, best up to twice the band) and A⁻¹W, A = K + K_σ − s M at
///   a shift s inside the band, for every direction in which the contact has a force, with some more terms of their
///   series in ω². When there are more directions than real modes, a sketch of the responses to damping and interface
///   represents them, and contact springs are part of K (`closed`).
/// * Every pair is measured on the full order. Its corrections z = −A⁻¹Q(λ)φ and, for the left vector, −A⁻¹Q(λ)ᴴψ show
///   no contact motion where A⁻¹W is in the basis: so the same real symmetric factor serves every pair, whatever the
///   friction. They enrich the basis until η and the eigenvalue error are small, in six refinement steps at most; pairs that are
///   right are not measured again.
/// * ψᴴQ(λ)φ vanishes identically after a projection, so the error of λ is estimated with the *correction* of the left
///   vector: |z_ψᴴ Q(λ)φ| / |ψᴴ(2λM + C + C_c)φ|. As A is symmetric, z_ψᴴ Q(λ)φ = ψᴴQ(λ)z, so that only the right
///   corrections are solved for, and the left ones of the pairs that are not yet right; others need no left vector on the
///   full order.
///
/// Sparse skew parts of the system ([`System::skew`]) are projected likewise; where a mode is not accurate then, the modes come from
/// two-level Arnoldi at full order.
///
/// Modes with ω = 0 (overdamped, or divergence when σ > 0) are given when the band begins at zero. For them and near
/// λ = 0 the eigenvalue error is relative to 1e-6 of the band's top rather than to |λ|.
///
/// # Errors
/// A band that is none; real modes of another system; a projected problem that cannot be solved.
pub fn complex_modes<'a>(
    system: &System,
    steady: &SteadySliding,
    known: impl Into<Structural<'a>>,
    band: impl Into<Band>,
    observer: &dyn Observer,
) -> Result<ComplexModes> {
    let (known, band) = (known.into(), band.into());
    if system.skew().is_some() {
        return modes_with_skew_parts((system, steady), known, band, observer).map(|found| found.modes);
    }
    analyse(system, steady, known, band, observer, |_, _| ()).map(|(modes, ())| modes)
}

/// The modes of a system with sparse skew parts that `asked` names.
/// Fails as `complex_modes`.
pub(super) fn modes_with_skew_parts(
    (system, steady): (&System, &SteadySliding),
    known: Structural<'_>,
    asked: Band,
    observer: &dyn Observer,
) -> Result<General> {
    check(system, steady, known.real, asked.hz)?;
    if let Ok((modes, ())) = analyse(system, steady, known, asked, observer, |_, _| ())
        && modes.broken_premise.is_none()
        && modes.modes.iter().all(|mode| mode.accepted())
    {
        let seen = modes.modes.iter().map(|mode| mode.eigenvalue).collect();
        return Ok(General { modes, seen, symbolic: None });
    }
    let operator = Operator::new(system, steady)?;
    let mut general = general_modes(&operator, known.real, asked, observer)?;
    general.modes.warnings.insert(
        0,
        "The matrices have a part that is not symmetric and not of low rank, whose modes are not accurate on a reduced basis: they are \
         found by two-level Arnoldi with sparse unsymmetric factors, at several frequencies of the band"
            .to_string(),
    );
    Ok(general)
}

#[cfg(test)]
mod tests {
    use super::super::general::tests::rotating;
    use super::super::tests::{dense_eigenvalues, dense_modes, nearest, steady};
    use super::super::{Family, FamilyFrame, SlidingState, complex_modes};
    use crate::bounds::{Origin::*, within};
    use crate::linalg::c64;

    /// A third of the real modes, gyroscopic and circulatory forces from a hundredth to once those of the structure: modes of the dense
    /// problem, found on a reduced basis where that is enough; and a family at other friction and damping.
    #[test]
    fn skew_parts_are_projected_like_damping() {
        let mut projected = 0;
        for (seed, spin, friction) in
            [(1, 0.1, 0.0), (2, 1.0, 0.0), (4, 3.0, 0.0), (3, 0.1, 3.0), (5, 1.0, 100.0)]
        {
            let system = rotating(150, seed, spin, friction);
            let (state, real) = (steady(&system), dense_modes(&system, 50));
            let band = [0.3 * real.frequency_hz(20), 1.01 * real.frequency_hz(20)];
            let found = complex_modes(&system, &state, &real, band, &()).unwrap();
            let exact = dense_eigenvalues(&system, &state, band);
            assert_eq!(found.modes.len(), exact.len(), "seed {seed}");
            for mode in &found.modes {
                let z = mode.eigenvalue;
                let error = (nearest(z, &exact) - z).norm() / z.norm();
                assert!(within(error, 1e-9, Tolerance) && mode.accepted(), "seed {seed}: {z}");
                let growth = (mode.growth.total() - z.re).abs() / z.norm();
                assert!(within(growth, 1e-7, Tolerance), "seed {seed}: {growth:.1e}");
            }
            projected += usize::from(!found.warnings.iter().any(|w| w.contains("two-level Arnoldi")));
            let frame = FamilyFrame::new(&system, &[], &real, Vec::new(), band).unwrap();
            let member = SlidingState { points: state.points.clone(), damping_weights: vec![1.0] };
            let mut family = Family::new(&frame, std::slice::from_ref(&member)).unwrap();
            assert!(within(family.train(&member).unwrap().worst(), 1e-9, Tolerance), "seed {seed}");
            let of_family: Vec<c64> = family.modes(&member).unwrap().eigenvalues;
            assert_eq!(of_family.len(), exact.len());
            for z in of_family {
                let error = (nearest(z, &exact) - z).norm() / z.norm();
                assert!(within(error, 1e-9, Tolerance), "seed {seed}: {z} {error:.1e}");
            }
        }
        assert!(projected > 3, "{projected}");
    }
}
