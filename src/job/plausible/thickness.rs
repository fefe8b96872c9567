//! The thickness of plates beside their size.
//!
//! A plate's theory takes the displacement as linear across the thickness. That is so where waves across it are far from
//! standing: below the first thickness-shear resonance, f_s = c_s/2h (R. D. Mindlin, J. Appl. Mech. 18 (1951) 31). The bending
//! wave of a plate as long as half a wave, λ = 2L, reaches f_s where h is about L: there is no plate then. At h = L/5 a plate by
//! Mindlin's theory still meets three-dimensional elasticity, its edges left out; what happens within about one thickness of
//! them (Saint-Venant) is then a good part of the whole.

use crate::error::Fault;
use crate::numbers::significant;
use crate::schema::dotted;
use crate::structure::{Model, Part};

/// h/L above which a body is no plate.
const BLOCK: f64 = 0.3;

pub fn warnings(model: &Model) -> Vec<Fault> {
    model.shells().filter_map(|(part, _)| of_part(part, &model.nodes)).collect()
}

fn of_part(part: &Part, nodes: &[[f64; 3]]) -> Option<Fault> {
    let size = part.area(nodes).sqrt();
    if part.thickness() <= BLOCK * size {
        return None;
    }
    let found = format!(
        "{} m, {} times the size of the part (√area = {} m)",
        significant(part.thickness(), 4),
        significant(part.thickness() / size, 2),
        significant(size, 3)
    );
    let help = if part.thickness() > size {
        "Check its unit and that of the mesh"
    } else {
        "A body as thick as that is no plate: check the unit, or take its frequencies with care"
    };
    let place = format!("`shell.{}.thickness`", dotted(&part.name));
    let expected = format!("at most {} m, {BLOCK} of the size", significant(BLOCK * size, 3));
    Some(Fault::new(place, found, expected).with_help(help))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Cell;
    use crate::structure::Shell;
    use crate::structure::samples::STEEL;

    #[test]
    fn a_metre_on_a_hand_is_no_plate() {
        let nodes = [[0.0; 3], [0.15, 0.0, 0.0], [0.15, 0.15, 0.0], [0.0, 0.15, 0.0]];
        let part = |thickness| {
            Part::new("disc", vec![Cell::quadrilateral([0, 1, 2, 3])], Shell::new(STEEL, thickness))
        };
        assert_eq!(of_part(&part(0.04), &nodes), None);
        let text = of_part(&part(1.0), &nodes).unwrap().to_string();
        assert!(text.contains("6.7 times") && text.contains("0.0450 m") && text.contains("unit"), "{text}");
    }
}
