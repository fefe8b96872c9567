//! Stiffness, density and speed of waves of the materials that there are.

use crate::case::Case;
use crate::error::Fault;
use crate::numbers::{given, significant};
use crate::schema::dotted;
use crate::solids::{DENSITY, MODULUS, SPEED};
use crate::structure::Material;
use std::ops::RangeInclusive;

/// η above which a material loses more than 2π times the energy that it stores in a cycle.
const LOSS: f64 = 1.0;

/// Units that a number without one may have been meant in, and what they are in SI, the likeliest first.
const MODULI: [(&str, f64); 3] = [("GPa", 1e9), ("MPa", 1e6), ("kPa", 1e3)];
const DENSITIES: [(&str, f64); 4] = [("g/cm^3", 1e3), ("g/mm^3", 1e6), ("kg/mm^3", 1e9), ("t/mm^3", 1e12)];

pub fn warnings(case: &Case) -> Vec<Fault> {
    case.material.iter().flat_map(|(name, material)| of_material(name, material)).collect()
}

fn of_material(name: &str, material: &Material) -> Vec<Fault> {
    let place = |key: &str| format!("`material.{}.{key}`", dotted(name));
    let (modulus, density) = (material.youngs_modulus, material.density);
    let mut all = Vec::new();
    if !MODULUS.contains(&modulus) {
        let expected = "0.1 MPa (foam) to 1300 GPa (diamond)";
        let fault = Fault::new(place("youngs_modulus"), format!("{} Pa", given(modulus)), expected);
        all.push(fault.with_help(meant(modulus, &MODULI, &MODULUS, "Pa")));
    }
    if !DENSITY.contains(&density) {
        let expected = "10 kg/m^3 (foam) to 23000 kg/m^3 (osmium)";
        let fault = Fault::new(place("density"), format!("{} kg/m^3", given(density)), expected);
        all.push(fault.with_help(meant(density, &DENSITIES, &DENSITY, "kg/m^3")));
    }
    let speed = (modulus / density).sqrt();
    if all.is_empty() && !SPEED.contains(&speed) {
        let found = format!("waves at √(E/ρ) = {} m/s", significant(speed, 3));
        let expected = "10 m/s (rubber) to 20000 m/s (diamond); 5200 m/s in steel";
        let fault = Fault::new(format!("`material.{}`", dotted(name)), found, expected);
        all.push(
            fault.with_help("Check both `youngs_modulus`, which is in Pa without a unit, and `density`"),
        );
    }
    if material.poissons_ratio < 0.0 {
        let found = given(material.poissons_ratio);
        let fault = Fault::new(place("poissons_ratio"), found, "0 (cork) to below 0.5 (rubber)");
        all.push(fault.with_help("Only auxetic foams get thicker when they are stretched"));
    }
    if material.loss_factor > LOSS {
        let found = given(material.loss_factor);
        let fault = Fault::new(place("loss_factor"), found, "1e-4 (steel) to 1 (rubber)");
        all.push(fault.with_help("It is a fraction: 2 % is 0.02"));
    }
    all
}

/// The first unit in which the number lies in the range, as advice.
fn meant(value: f64, units: &[(&str, f64)], range: &RangeInclusive<f64>, si: &str) -> String {
    let found = units.iter().find(|(_, factor)| range.contains(&(value * factor)));
    match found {
        Some((unit, _)) => {
            format!("A number without a unit is in {si}; is it \"{} {unit}\"?", given(value))
        }
        None => "Check its unit".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::samples::STEEL;

    #[test]
    fn forgotten_units_are_named_and_real_materials_pass() {
        let real = [
            (210e9, 0.3, 7850.0),
            (1.05e12, 0.2, 3515.0),  // diamond
            (5e6, 0.499, 930.0),     // rubber
            (287e9, 0.08, 1848.0),   // beryllium
            (547e9, 0.25, 22_590.0), // osmium
            (3e5, 0.0, 30.0),        // a soft foam
        ];
        for (youngs_modulus, poissons_ratio, density) in real {
            let material = Material { youngs_modulus, poissons_ratio, density, ..STEEL };
            assert_eq!(of_material("m", &material), [], "{material:?}");
        }
        for (youngs_modulus, density, word) in [
            (200.0, 7850.0, "\"200 GPa\""),
            (2.1e5, 7850.0, "5.17 m/s"),
            (210e9, 7.85, "\"7.85 g/cm^3\""),
            (210e9, 7.85e-9, "t/mm^3\""),
            (210e9, 7.85e5, "unit"),
            (210e9, 78.5, "51722 m/s"),
        ] {
            let found = of_material("m", &Material { youngs_modulus, density, ..STEEL });
            let text: Vec<String> = found.iter().map(ToString::to_string).collect();
            assert!(text.len() == 1 && text[0].contains(word), "{text:?}");
        }
        let odd = Material { poissons_ratio: -0.3, loss_factor: 2.0, ..STEEL };
        assert_eq!(of_material("m", &odd).len(), 2);
    }
}
