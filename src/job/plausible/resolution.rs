//! Bending waves beside the elements that are to carry them.
//!
//! A mode at f has half waves as long as half a bending wave, λ = 2π/k, k by the theory of the plate. Six elements a wave are
//! the usual least for linear elements (S. Marburg, J. Comput. Acoust. 10 (2002) 25, on where that rule comes from).

use super::frequency::highest_frequency;
use crate::error::Fault;
use crate::job::prepared::Prepared;
use crate::numbers::significant;
use crate::structure::{Part, element_size};
use std::f64::consts::TAU;

/// Elements a wave, at least.
const ELEMENTS: f64 = 6.0;

pub fn warnings(prepared: &Prepared) -> Vec<Fault> {
    let model = &prepared.model;
    model
        .parts
        .iter()
        .filter_map(|part| of_part(part, &model.nodes, highest_frequency(prepared, &part.name)))
        .collect()
}

fn of_part(part: &Part, nodes: &[[f64; 3]], hz: f64) -> Option<Fault> {
    let k = part
        .element(nodes)
        .filter(|_| hz > 0.0 && part.kind.material().density > 0.0)?
        .bending_wavenumber(hz)?;
    let (wave, size) = (TAU / k, element_size(part, nodes));
    if wave >= ELEMENTS * size || size == 0.0 {
        return None;
    }
    let found = format!(
        "elements of {} mm, {} to a bending wave of {} mm at {} Hz",
        significant(1e3 * size, 2),
        significant(wave / size, 2),
        significant(1e3 * wave, 2),
        significant(hz, 3)
    );
    let at_most = significant(1e3 * wave / ELEMENTS, 2);
    let expected = format!("{ELEMENTS} or more, elements of {at_most} mm");
    Some(Fault::new(part.place(), found, expected).with_help("Refine its mesh, or lower the band"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Cell;
    use crate::structure::Shell;
    use crate::structure::samples::STEEL;

    #[test]
    fn a_plate_of_one_element_carries_no_short_waves() {
        let nodes = [[0.0; 3], [0.1, 0.0, 0.0], [0.1, 0.1, 0.0], [0.0, 0.1, 0.0]];
        let part = Part::new("disc", vec![Cell::quadrilateral([0, 1, 2, 3])], Shell::new(STEEL, 1e-3));
        // λ = 2π (D/ρh)^¼/√ω = 314 mm at 100 Hz and 0.99 m at 10 Hz: D = 19.23 N m, ρh = 7.85 kg/m².
        assert_eq!(of_part(&part, &nodes, 10.0), None);
        let text = of_part(&part, &nodes, 100.0).unwrap().to_string();
        assert!(text.contains("elements of 100 mm, 3.1 to") && text.contains("314 mm at 100 Hz"), "{text}");
        assert!(text.contains("elements of 52 mm"), "{text}");
        assert_eq!(of_part(&part, &nodes, 0.0), None);
    }
}
