//! Bending waves beside the elements that are to carry them.
//!
//! A mode at f has half waves as long as half a bending wave, λ = 2π/k, k by the theory of the plate. Six elements a wave are
//! the usual least for linear elements (S. Marburg, J. Comput. Acoust. 10 (2002) 25, on where that rule comes from). A solid
//! is judged as the plate that has its volume between two halves of its skin: where it is no plate, its waves are about as long as it is.

use super::frequency::highest_frequency;
use crate::error::Fault;
use crate::job::prepared::Prepared;
use crate::numbers::significant;
use crate::structure::{Part, as_plate, element_size};
use std::f64::consts::TAU;

/// Elements of first order a wave, at least; half as many of second order, which have as many nodes.
const ELEMENTS: f64 = 6.0;

pub fn warnings(prepared: &Prepared) -> Vec<Fault> {
    let model = &prepared.model;
    model
        .parts
        .iter()
        .filter_map(|part| {
            let hz = highest_frequency(prepared, &part.name);
            match part.kind.dimension() {
                3 => {
                    let plate = as_plate(part, *part.kind.material(), &model.nodes);
                    of_part(&plate, &part.place(), &model.nodes, hz)
                }
                _ => of_part(part, &part.place(), &model.nodes, hz),
            }
        })
        .collect()
}

fn of_part(part: &Part, place: &str, nodes: &[[f64; 3]], hz: f64) -> Option<Fault> {
    let first_order = part.cells.first()?.kind().is_first_order();
    let least = if first_order { ELEMENTS } else { 0.5 * ELEMENTS };
    let k = part
        .element(nodes)
        .filter(|_| hz > 0.0 && part.kind.material().density > 0.0)?
        .bending_wavenumber(hz)?;
    let (wave, size) = (TAU / k, element_size(part, nodes));
    if wave >= least * size || size == 0.0 {
        return None;
    }
    let found = format!(
        "elements of {} mm, {} to a bending wave of {} mm at {} Hz",
        significant(1e3 * size, 2),
        significant(wave / size, 2),
        significant(1e3 * wave, 2),
        significant(hz, 3)
    );
    let at_most = significant(1e3 * wave / least, 2);
    let expected = format!("{least} or more, elements of {at_most} mm");
    Some(Fault::new(place, found, expected).with_help("Refine its mesh, or lower the band"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::mesh::generate::structured_box;
    use crate::mesh::{Cell, CellKind};
    use crate::structure::samples::STEEL;
    use crate::structure::{Shell, Solid};

    #[test]
    fn a_plate_of_one_element_carries_no_short_waves() {
        let nodes = [[0.0; 3], [0.1, 0.0, 0.0], [0.1, 0.1, 0.0], [0.0, 0.1, 0.0]];
        let part = Part::new("disc", vec![Cell::quadrilateral([0, 1, 2, 3])], Shell::new(STEEL, 1e-3));
        // λ = 2π (D/ρh)^¼/√ω = 314 mm at 100 Hz and 0.99 m at 10 Hz: D = 19.23 N m, ρh = 7.85 kg/m².
        assert_eq!(of_part(&part, "`shell.disc`", &nodes, 10.0), None);
        let text = of_part(&part, "`shell.disc`", &nodes, 100.0).unwrap().to_string();
        assert!(text.contains("elements of 100 mm, 3.1 to") && text.contains("314 mm at 100 Hz"), "{text}");
        assert!(text.contains("elements of 52 mm"), "{text}");
        assert_eq!(of_part(&part, "`shell.disc`", &nodes, 0.0), None);
        // A brick of the same size has as many nodes along its sides as two elements of first order.
        let brick = structured_box(CellKind::Hexahedron20, [0.1, 0.1, 1e-3], [1, 1, 1]).unwrap();
        let cells = brick.elements.iter().filter(|cell| cell.dimension() == 3).cloned().collect();
        let plate = as_plate(&Part::new("pad", cells, Solid::new(STEEL)), STEEL, &brick.nodes);
        assert!(
            within((plate.thickness() - 1e-3).abs(), 5e-5, Discretisation)
                && of_part(&plate, "`solid.pad`", &brick.nodes, 50.0).is_none()
        );
        let text = of_part(&plate, "`solid.pad`", &brick.nodes, 200.0).unwrap().to_string();
        assert!(text.starts_with("`solid.pad`") && text.contains("expected 3 or more"), "{text}");
    }
}
