//! Levels, and how the ear weighs frequencies.

/// The factor of the amplitude at `hz` under A-weighting, 1 at 1 kHz:
///
/// f₄² f⁴ / ((f² + f₁²) √(f² + f₂²) √(f² + f₃²) (f² + f₄²)) · 10^(2.000/20)
///
/// with f₁ = 20.60, f₂ = 107.7, f₃ = 737.9, f₄ = 12194 Hz (IEC 61672-1:2013, E.4).
pub fn a_weighting(hz: f64) -> f64 {
    const POLES: [f64; 4] = [20.598_997, 107.652_65, 737.862_23, 12_194.217];
    const AT_1_KHZ: f64 = 2.000;
    let [f1, f2, f3, f4] = POLES.map(|f| f * f);
    let f = hz * hz;
    let response = f4 * f * f / ((f + f1) * ((f + f2) * (f + f3)).sqrt() * (f + f4));
    response * 10f64.powf(AT_1_KHZ / 20.0)
}

/// The level of a mean-square pressure \[Pa²\] in dB re 20 µPa; −∞ for none.
pub fn pressure_level(mean_square: f64) -> f64 {
    10.0 * (mean_square / (20e-6 * 20e-6)).log10()
}

/// The level of a sound power \[W\] in dB re 1 pW; −∞ for none.
pub fn power_level(watt: f64) -> f64 {
    10.0 * (watt / 1e-12).log10()
}

#[cfg(test)]
mod tests {
    use super::*;
    use stridor_base::bounds::{Origin::*, within};

    #[test]
    fn weights_are_those_of_the_standard() {
        // IEC 61672-1:2013, table 3, exact base-ten frequencies.
        let table = [
            (10.0, -70.4),
            (31.623, -39.4),
            (100.0, -19.1),
            (251.19, -8.6),
            (501.19, -3.2),
            (1000.0, 0.0),
            (1995.3, 1.2),
            (2511.9, 1.3),
            (5011.9, 0.5),
            (10_000.0, -2.5),
            (15_849.0, -6.6),
        ];
        for (hz, db) in table {
            let found = 20.0 * a_weighting(hz).log10();
            assert!(within((found - db).abs(), 0.051, Reference), "{hz}: {found}");
        }
        assert!(within((20.0 * a_weighting(1000.0).log10()).abs(), 1e-3, Reference));
        assert_eq!(a_weighting(0.0), 0.0);
    }

    #[test]
    fn one_pascal_is_94_decibel() {
        assert!(
            within((pressure_level(1.0) - 93.979).abs(), 1e-3, Reference)
                && within((power_level(1e-3) - 90.0).abs(), 1e-12, RoundOff)
        );
        assert_eq!(pressure_level(0.0), f64::NEG_INFINITY);
    }
}
