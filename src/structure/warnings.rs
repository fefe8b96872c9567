//! Where the theory of a plate is off at the frequency asked: each element knows its own range.

use super::elements::waves::thickness_shear_frequency;
use super::elements::{FlatTriangle, split_face};
use super::model::Model;
use super::part::Part;

/// A plate of the model and by how much its frequencies are expected to be too high.
#[derive(Debug, Clone, PartialEq)]
pub struct ThicknessError {
    /// The part's name.
    pub part: String,
    /// The frequency asked \[Hz\].
    pub frequency_hz: f64,
    /// kh at that frequency.
    pub wavenumber_times_thickness: f64,
    /// Expected ω/ω_exact − 1 of a mode; zero by Mindlin's theory below its limit.
    pub relative_error: f64,
    /// The first thickness-shear resonance \[Hz\], above which Mindlin's theory does not hold either.
    pub mindlin_below_hz: f64,
}

/// The expected error of the plates of `model` for modes at the frequency \[Hz\] that is asked of each, in the order of the parts.
///
/// Parts without mass have no waves and are left out, as are those of which no frequency is asked.
pub fn thickness_errors(model: &Model, asked_hz: &dyn Fn(&str) -> f64) -> Vec<ThicknessError> {
    let parts = model.shells().filter(|(_, shell)| shell.material.density > 0.0);
    parts
        .filter_map(|(part, shell)| {
            let frequency_hz = Some(asked_hz(&part.name)).filter(|hz| *hz > 0.0)?;
            let element = part.element(&model.nodes)?;
            let error = element.theory_error(frequency_hz);
            let [kh, relative_error] = match error {
                Some(error) => [error.wavenumber_times_thickness, error.relative_error],
                None => [element.bending_wavenumber(frequency_hz)? * shell.thickness, 0.0],
            };
            Some(ThicknessError {
                part: part.name.clone(),
                frequency_hz,
                wavenumber_times_thickness: kh,
                relative_error,
                mindlin_below_hz: thickness_shear_frequency(&shell.material, shell.thickness),
            })
        })
        .collect()
}

/// The mean side of the elements of a part \[m\], by their share of its area: √A of a quadrilateral, √2A of a triangle.
pub fn element_size(part: &Part, nodes: &[[f64; 3]]) -> f64 {
    let area = |nodes: [[f64; 3]; 3]| FlatTriangle::new(&nodes).map_or(0.0, |triangle| triangle.area);
    let (mut sum, mut whole) = (0.0, 0.0);
    for face in &part.cells {
        let own: f64 = split_face(face).iter().map(|t| t.weight * area(t.nodes.map(|n| nodes[n]))).sum();
        let square = if face.corners().len() == 3 { 2.0 * own } else { own };
        sum += own * square.sqrt();
        whole += own;
    }
    if whole > 0.0 { sum / whole } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::mesh::Cell;
    use crate::structure::samples::STEEL;
    use crate::structure::{Material, PlateTheory, Shell};

    #[test]
    fn a_thick_plate_is_named_by_kirchhoffs_element_and_has_no_error_by_mindlins() {
        let nodes = vec![[0.0; 3], [0.1, 0.0, 0.0], [0.1, 0.1, 0.0], [0.0, 0.1, 0.0]];
        for face in [Cell::triangle([0, 1, 2]), Cell::quadrilateral([0, 1, 2, 3])] {
            let plate = Part::new("plate", vec![face], Shell::new(STEEL, 0.01));
            let shell = Shell { theory: PlateTheory::Mindlin, ..Shell::new(STEEL, 0.01) };
            let mindlin = Part::new("thick", plate.cells.clone(), shell);
            let without_mass = Material { density: 0.0, ..STEEL };
            let massless = Part::new("light", plate.cells.clone(), Shell::new(without_mass, 0.01));
            let model =
                Model { nodes: nodes.clone(), parts: vec![mindlin, plate, massless], ..Model::default() };
            let errors = thickness_errors(&model, &|_| 6000.0);
            assert_eq!(errors.len(), 2);
            assert_eq!((errors[0].part.as_str(), errors[0].relative_error), ("thick", 0.0));
            assert_eq!(errors[1].part, "plate");
            // With rotary inertia, of which ½ (kh)²/12 is the smaller part.
            assert!(errors[1].relative_error > 0.02 && errors[1].relative_error < 0.04, "{errors:?}");
            // c_s/2h with c_s = √(G/ρ) = 3207.6 m/s.
            assert!(
                errors.iter().all(|error| within(
                    (error.mindlin_below_hz - 160_382.0).abs(),
                    50.0,
                    Reference
                )),
                "{errors:?}"
            );
            let size = element_size(&model.parts[0], &model.nodes);
            assert!(within((size - 0.1).abs(), 1e-15, RoundOff), "{size}");
        }
    }
}
