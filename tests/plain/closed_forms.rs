//! Frequencies of rectangular plates, bars, and discs in their plane in closed form, with which other tests compare.

use puruspe::Jn;
use std::f64::consts::{PI, TAU};
use stridor::bounds::{Origin::*, within};
use stridor::validation::kirchhoff::{ThinPlate, sign_changes};

/// Every frequency \[Hz\] below `below_hz` of a rectangular plate a × b simply supported all round:
/// ω = π² ((m/a)² + (n/b)²) √(D/ρh), ascending, with (m, n).
pub fn simply_supported_rectangle(
    plate: &ThinPlate,
    a: f64,
    b: f64,
    below_hz: f64,
) -> Vec<(f64, usize, usize)> {
    let f = |m: usize, n: usize| {
        PI * PI * ((m as f64 / a).powi(2) + (n as f64 / b).powi(2)) * plate.wave_constant() / TAU
    };
    let mut modes = Vec::new();
    for m in (1..).take_while(|m| f(*m, 1) < below_hz) {
        modes.extend((1..).take_while(|n| f(m, *n) < below_hz).map(|n| (f(m, n), m, n)));
    }
    modes.sort_by(|p, q| p.0.total_cmp(&q.0));
    modes
}

/// The first `count` βl of a bar clamped at one end and free at the other: cos βl cosh βl = −1;
/// ω = (βl)² √(EI/ρA)/l².
pub fn cantilever_roots(count: usize) -> Vec<f64> {
    // Divided by cosh, so that it stays of order one; the roots are near (k + ½)π.
    sign_changes(|x| x.cos() + 1.0 / x.cosh(), 1.0, count as f64 * PI)
}

/// The lowest in-plane frequencies \[Hz\] of a free disc of radius `a` with n nodal diameters, those below `below_hz`.
///
/// Plane stress: u_r = [A α J_n′(αr) + B (n/r) J_n(βr)] cos nθ, u_θ = −[A (n/r) J_n(αr) + B β J_n′(βr)] sin nθ with
/// α² = ω²ρ(1−ν²)/E, β² = 2(1+ν) ω²ρ/E, and no tractions σ_r, τ at r = a. (Love, "Mathematical Theory of
/// Elasticity", §314.)
pub fn free_disc_in_plane(plate: &ThinPlate, a: f64, n: usize, below_hz: f64) -> Vec<f64> {
    let nu = plate.poissons_ratio;
    let slow = (plate.youngs_modulus / (2.0 * (1.0 + nu) * plate.density)).sqrt();
    let ratio = ((1.0 - nu) / 2.0).sqrt();
    let tractions = |lambda: f64| {
        // a = 1, β = λ. For a potential Z with Z″ = −Z′ + (n² − k²) Z at r = 1:
        let potential = |k: f64| {
            let z = Jn(n as u32, k);
            let slope = -k * Jn(n as u32 + 1, k) + n as f64 * z;
            let second = -slope + ((n * n) as f64 - k * k) * z;
            (z, slope, second)
        };
        let order = n as f64;
        let (p, dp, ddp) = potential(ratio * lambda);
        let (s, ds, dds) = potential(lambda);
        // σ_r ∝ u_r,r + ν (u_r + u_θ,θ); τ ∝ u_r,θ + u_θ,r − u_θ, at r = 1.
        let sigma = [ddp + nu * (dp - order * order * p), (1.0 - nu) * order * (ds - s)];
        let tau = [-2.0 * order * (dp - p), -(dds - ds + order * order * s)];
        sigma[0] * tau[1] - sigma[1] * tau[0]
    };
    sign_changes(tractions, 0.2, TAU * below_hz * a / slow).iter().map(|l| l * slow / (TAU * a)).collect()
}

fn unit(nu: f64) -> ThinPlate {
    ThinPlate { youngs_modulus: 12.0 * (1.0 - nu * nu), poissons_ratio: nu, density: 1.0, thickness: 1.0 }
}

#[test]
fn bar_and_rectangle() {
    let roots = cantilever_roots(4);
    for (found, expected) in roots.iter().zip([1.875104069, 4.694091133, 7.854757438, 10.99554073]) {
        assert!(within((found - expected).abs(), 1e-8, Reference));
    }
    let modes = simply_supported_rectangle(&unit(0.3), 1.0, 1.0, 60.0 / TAU);
    let expected = [(1, 1, 2.0), (1, 2, 5.0), (2, 1, 5.0)];
    assert_eq!(modes.len(), expected.len());
    for (mode, (m, n, squares)) in modes.iter().zip(expected) {
        assert_eq!((mode.1, mode.2), (m, n));
        assert!(within((mode.0 * TAU / (squares * PI * PI) - 1.0).abs(), 1e-14, RoundOff));
    }
}

#[test]
fn in_plane_modes_of_a_disc() {
    // Torsion about the axis (n = 0): J₂(βa) = 0; breathing: α a J₀(αa) = (1−ν) J₁(αa), α a = 2.0489 for ν = 0.3.
    let plate = unit(0.3);
    let slow = (plate.youngs_modulus / 2.6).sqrt();
    let found: Vec<f64> =
        free_disc_in_plane(&plate, 1.0, 0, 6.0 * slow / TAU).iter().map(|f| f * TAU / slow).collect();
    let breathing = 2.048_87 / 0.35_f64.sqrt();
    assert_eq!(found.len(), 2);
    assert!(within((found[0] - breathing).abs(), 1e-3, Reference), "{found:?} {breathing}");
    assert!(within((found[1] - 5.135_622_301_840_683).abs(), 1e-9, Tolerance), "{found:?}");
}
