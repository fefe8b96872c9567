//! Where the theory of a plate is off at the frequency asked: each element knows its own range.

use super::model::Model;

/// A plate of the model and by how much its frequencies are expected to be too high.
#[derive(Debug, Clone, PartialEq)]
pub struct ThicknessError {
    /// The part's name.
    pub part: String,
    /// The frequency asked \[Hz\].
    pub frequency_hz: f64,
    /// kh at that frequency.
    pub wavenumber_times_thickness: f64,
    /// Expected ω/ω_exact − 1 of a mode.
    pub relative_error: f64,
}

/// The expected error of the plates of `model` for modes that it gives at `frequency_hz`, in the order of the parts.
///
/// Parts without mass have no waves and are left out, as are those whose elements hold at any frequency.
pub fn thickness_errors(model: &Model, frequency_hz: f64) -> Vec<ThicknessError> {
    let parts = model.shells.iter().filter(|part| part.material.density > 0.0);
    parts
        .filter_map(|part| {
            let error = part.element(&model.nodes)?.theory_error(frequency_hz)?;
            Some(ThicknessError {
                part: part.name.clone(),
                frequency_hz,
                wavenumber_times_thickness: error.wavenumber_times_thickness,
                relative_error: error.relative_error,
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Element;
    use crate::structure::samples::STEEL;
    use crate::structure::{PlateTheory, ShellPart};

    #[test]
    fn a_thick_plate_is_named_by_kirchhoffs_element_and_not_by_mindlins() {
        let nodes = vec![[0.0; 3], [0.1, 0.0, 0.0], [0.1, 0.1, 0.0], [0.0, 0.1, 0.0]];
        for face in [Element::Triangle([0, 1, 2]), Element::Quadrilateral([0, 1, 2, 3])] {
            let plate = ShellPart::new("plate", vec![face], STEEL, 0.01);
            let mindlin = ShellPart { name: "thick".into(), theory: PlateTheory::Mindlin, ..plate.clone() };
            let massless =
                ShellPart { material: crate::structure::Material { density: 0.0, ..STEEL }, ..plate.clone() };
            let model =
                Model { nodes: nodes.clone(), shells: vec![mindlin, plate, massless], ..Model::default() };
            let errors = thickness_errors(&model, 6000.0);
            assert_eq!(errors.len(), 1);
            assert_eq!(errors[0].part, "plate");
            // With rotary inertia, of which ½ (kh)²/12 is the smaller part.
            assert!(errors[0].relative_error > 0.02 && errors[0].relative_error < 0.04, "{errors:?}");
        }
    }
}
