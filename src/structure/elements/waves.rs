//! Bending waves of a plate, by Kirchhoff's theory and by Mindlin's.
//!
//! Kirchhoff's plate is rigid in shear. Mindlin's is not, and counts rotary inertia (J. Appl. Mech. 18 (1951) 31): a
//! straight-crested bending wave of wavenumber k and frequency ω obeys
//!
//! (k² − ρω²/κG) (D k² − ρh³ω²/12) = ρh ω²,  G = E/2(1+ν),
//!
//! while Kirchhoff has D k⁴ = ρh ω² (ρ(h + h³k²/12) ω² with rotary inertia). A mode keeps its k, which its shape and
//! the edges dictate, so Kirchhoff's frequency is too high by ω_Kirchhoff(k)/ω_Mindlin(k) − 1. For small kh that is
//! ½ (kh)² [1/12 + 1/(6κ(1−ν))]; the first term drops out when rotary inertia is counted. The shear coefficient
//! κ = 5/(6−ν) makes this series ½ (kh)² (17−7ν)/(60(1−ν)), that of the lowest antisymmetric Lamb wave in
//! three-dimensional elasticity: 0.177 (kh)² for ν = 0.3. Edges make it differ from mode to mode: it is an estimate,
//! not a correction.

use crate::structure::Material;

/// κ = 5/(6−ν) of Mindlin's plate, with which long bending waves are as slow as those of three-dimensional elasticity
/// to the order (kh)²; 5/6 is that of the static parabola of shear stress, π²/12 that of the first shear wave across.
pub fn shear_coefficient(poissons_ratio: f64) -> f64 {
    5.0 / (6.0 - poissons_ratio)
}

/// ω_Kirchhoff/ω_Mindlin − 1 for a mode that Kirchhoff's theory puts at `frequency_hz`.
pub fn thickness_error(material: &Material, thickness: f64, rotary_inertia: bool, frequency_hz: f64) -> f64 {
    let k = kirchhoff_wavenumber(material, thickness, rotary_inertia, frequency_hz);
    let omega = std::f64::consts::TAU * frequency_hz;
    if omega > 0.0 {
        omega / mindlin_frequency(material, thickness, shear_coefficient(material.poissons_ratio), k) - 1.0
    } else {
        0.0
    }
}

/// k \[rad/m\] of Kirchhoff's bending wave at `frequency_hz`.
pub(super) fn kirchhoff_wavenumber(
    material: &Material,
    h: f64,
    rotary_inertia: bool,
    frequency_hz: f64,
) -> f64 {
    let omega = std::f64::consts::TAU * frequency_hz;
    let (d, rho_h) = (rigidity(material, h), material.density * h);
    // D k⁴ − R ω² k² − ρh ω² = 0 with R = ρh³/12 or 0.
    let r = if rotary_inertia { rho_h * h * h / 12.0 * omega * omega } else { 0.0 };
    ((r + (r * r + 4.0 * d * rho_h * omega * omega).sqrt()) / (2.0 * d)).sqrt()
}

/// ω \[rad/s\] of Mindlin's bending wave of wavenumber k: the smaller root of
/// (ρ/κG)(ρh³/12) ω⁴ − [ρh + k² (ρh³/12 + ρD/κG)] ω² + D k⁴ = 0.
pub fn mindlin_frequency(material: &Material, h: f64, shear_coefficient: f64, k: f64) -> f64 {
    let rho = material.density;
    let shear = rho / (shear_coefficient * material.shear_modulus());
    let rotary = rho * h.powi(3) / 12.0;
    let d = rigidity(material, h);
    let a = shear * rotary;
    let b = rho * h + k * k * (rotary + shear * d);
    let c = d * k.powi(4);
    (2.0 * c / (b + (b * b - 4.0 * a * c).sqrt())).sqrt()
}

/// k \[rad/m\] of Mindlin's bending wave at `frequency_hz`, the larger root of
/// D k⁴ − ω² (ρh³/12 + ρD/κG) k² + (ρ/κG)(ρh³/12) ω⁴ − ρh ω² = 0.
pub(super) fn mindlin_wavenumber(
    material: &Material,
    h: f64,
    shear_coefficient: f64,
    frequency_hz: f64,
) -> f64 {
    let square = (std::f64::consts::TAU * frequency_hz).powi(2);
    let shear = material.density / (shear_coefficient * material.shear_modulus());
    let (rotary, d) = (material.density * h.powi(3) / 12.0, rigidity(material, h));
    let b = square * (rotary + shear * d);
    let c = square * (shear * rotary * square - material.density * h);
    ((b + (b * b - 4.0 * d * c).sqrt()) / (2.0 * d)).sqrt()
}

/// c_s/2h \[Hz\], c_s = √(G/ρ): the first resonance of shear across the thickness, half a wave of which is h (Mindlin, J. Appl.
/// Mech. 18 (1951) 31). Above it bending is no longer the only antisymmetric wave of a plate.
pub fn thickness_shear_frequency(material: &Material, thickness: f64) -> f64 {
    (material.shear_modulus() / material.density).sqrt() / (2.0 * thickness)
}

/// D = E h³ / 12(1−ν²) \[N m\].
fn rigidity(material: &Material, h: f64) -> f64 {
    material.youngs_modulus * h.powi(3) / (12.0 * (1.0 - material.poissons_ratio.powi(2)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::structure::samples::STEEL;

    /// ω of the lowest antisymmetric Lamb wave: three-dimensional elasticity, no plate theory.
    /// 4k²pq tanh(qh/2) = (q² + k²)² tanh(ph/2), p² = k² − ω²/c_l², q² = k² − ω²/c_t².
    fn lamb_frequency(material: &Material, h: f64, k: f64) -> f64 {
        let (e, nu, rho) = (material.youngs_modulus, material.poissons_ratio, material.density);
        let long = (e * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu) * rho)).sqrt();
        let shear = (e / (2.0 * (1.0 + nu) * rho)).sqrt();
        let f = |omega: f64| {
            let p = (k * k - (omega / long).powi(2)).sqrt();
            let q = (k * k - (omega / shear).powi(2)).sqrt();
            (q * q + k * k).powi(2) * (p * h / 2.0).tanh() - 4.0 * k * k * p * q * (q * h / 2.0).tanh()
        };
        // One change of sign between rest (a trivial root) and the shear wave, which outruns A0.
        let (mut low, mut high) = (1e-3 * shear * k, 0.9999 * shear * k);
        let sign = f(high) > 0.0;
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if (f(middle) > 0.0) == sign { high = middle } else { low = middle }
        }
        0.5 * (low + high)
    }

    #[test]
    fn mindlin_follows_exact_elasticity() {
        let h = 0.01;
        for kh in [0.1, 0.3, 0.5, 1.0] {
            let k = kh / h;
            let (mindlin, exact) =
                (mindlin_frequency(&STEEL, h, shear_coefficient(0.3), k), lamb_frequency(&STEEL, h, k));
            let d = rigidity(&STEEL, h);
            let kirchhoff = (d / (STEEL.density * h)).sqrt() * k * k;
            let (estimated, true_error) = (kirchhoff / mindlin - 1.0, kirchhoff / exact - 1.0);
            assert!(
                within((estimated / true_error - 1.0).abs(), 0.01, Theory),
                "kh {kh}: {estimated} {true_error}"
            );
        }
    }

    #[test]
    fn the_ten_millimetre_slider() {
        for (f, expected) in [(2600.0, 0.0185), (6000.0, 0.0413)] {
            let error = thickness_error(&STEEL, 0.01, false, f);
            assert!(within((error - expected).abs(), 5e-4, Reference), "{f}: {error}");
        }
        // The series for small kh, with and without rotary inertia.
        let error = thickness_error(&STEEL, 0.001, false, 100.0);
        let kh = kirchhoff_wavenumber(&STEEL, 0.001, false, 100.0) * 0.001;
        let series = 0.5 * kh * kh * (17.0 - 2.1) / (60.0 * 0.7);
        assert!(within((error / series - 1.0).abs(), 1e-3, Theory), "{error} {series}");
        let with_rotary = thickness_error(&STEEL, 0.001, true, 100.0);
        let series = 0.5 * kh * kh * 5.7 / (30.0 * 0.7);
        assert!(within((with_rotary / series - 1.0).abs(), 1e-3, Theory));
        assert_eq!(thickness_error(&STEEL, 0.01, false, 0.0), 0.0);
    }

    #[test]
    fn wavenumber_and_frequency_of_mindlins_wave_are_inverse() {
        for (kh, kappa) in [(0.01, 5.0 / 6.0), (0.5, 0.9), (2.0, 5.0 / 6.0), (6.0, 1.0)] {
            let hz = mindlin_frequency(&STEEL, 0.01, kappa, kh / 0.01) / std::f64::consts::TAU;
            let back = mindlin_wavenumber(&STEEL, 0.01, kappa, hz) * 0.01;
            assert!(within((back / kh - 1.0).abs(), 1e-10, RoundOff), "{kh}: {back}");
        }
    }
}
