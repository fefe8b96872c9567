//! Universal files for test-data programs: frequency responses and mode shapes.

use super::{FileNames, FrfResult, Geometry, NamedModes, PlaceAndDirection, RunResults, write_result};
use crate::error::Result;
use crate::measured::uff::{Element, Function, RealShape, functions_file, modes_text};
use crate::mesh::{Cell, NumberedKind};
use std::path::Path;

/// Writes `frf_<name>.uff` into the folder `dir`.
pub(super) fn write_functions(dir: &Path, frfs: &[&FrfResult]) -> Result<()> {
    let mut names = FileNames::default();
    frfs.iter()
        .try_for_each(|frf| write_result(dir, &format!("frf_{}.uff", names.next(&frf.name)), &functions(frf)))
}

/// All places of a response: the force acts at point 1, the places are points 2, 3 …
fn functions(frf: &FrfResult) -> Vec<u8> {
    let label = |k: usize| k as u64 + 2;
    let points = std::iter::once((1, frf.force.position))
        .chain(frf.responses.iter().enumerate().map(|(k, of)| (label(k), of.at.position)));
    let titles: Vec<String> = frf
        .responses
        .iter()
        .map(|of| format!("{} of {} for a force at {}", frf.quantity.word(), of.name, frf.name))
        .collect();
    let function = |k: usize| Function {
        title: [&titles[k], &frf.about],
        quantity: frf.quantity,
        excitation: (1, code(&frf.force)),
        response: (label(k), code(&frf.responses[k].at)),
        frequencies_hz: &frf.frequencies_hz,
        values: &frf.responses[k].values,
    };
    functions_file(points, (0..frf.responses.len()).map(function), frf.binary)
}

/// ±1, ±2, ±3 along an axis; 0, a scalar, along anything else.
fn code(place: &PlaceAndDirection) -> i64 {
    let axis = (0..3).find(|k| place.direction[*k].abs() > 1.0 - 1e-9);
    axis.map_or(0, |k| place.direction[k].signum() as i64 * (k as i64 + 1))
}

/// Writes `modes_<set>.uff` of the sets that ask for it.
pub(super) fn write_modes(dir: &Path, results: &RunResults) -> Result<()> {
    let mut names = FileNames::default();
    for set in results.all::<NamedModes>() {
        // A name for every set, so that the files of a set bear one name.
        let name = names.next(&set.name);
        if set.universal {
            let text = modes(&results.geometry, set);
            write_result(dir, &format!("modes_{name}.uff"), text.as_bytes())?;
        }
    }
    Ok(())
}

/// Every mode of a set; node k has label k + 1. Nodes at rest are left out of a shape.
fn modes(geometry: &Geometry, set: &NamedModes) -> String {
    let label = |k: usize| k as u64 + 1;
    let motion = |k: usize| {
        let motions = set.shape(k).into_iter().enumerate().map(|(node, u)| (label(node), [u[0], u[1], u[2]]));
        motions.filter(|(_, u)| u.iter().any(|v| *v != 0.0))
    };
    let modes = (0..set.modes.len()).map(|k| RealShape {
        number: k + 1,
        frequency_hz: set.modes.frequency_hz(k),
        modal_mass: 1.0,
        damping_ratio: set.damping_ratio.get(k).copied().unwrap_or(0.0),
        motion: Box::new(motion(k)),
    });
    let element = |cell: &Cell| {
        let NumberedKind { number, order } = cell.kind().table().universal?;
        let nodes = order.to_file(cell.nodes()).into_iter().map(label).collect();
        Some(Element { descriptor: u32::from(number), nodes })
    };
    let points = geometry.nodes.iter().enumerate().map(|(k, x)| (label(k), *x));
    modes_text(&set.name, points, geometry.cells.iter().filter_map(element), modes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::job::sample;
    use crate::measured::uff::{Unstated, read};

    #[test]
    fn responses_come_back_as_they_were_written() {
        let mut frf = sample::rig().take::<FrfResult>().unwrap();
        frf.responses.iter_mut().for_each(|response| response.at.direction = [0.8, 0.6, 0.0]);
        let frf = &frf;
        let text = String::from_utf8(functions(frf)).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        // Columns of the format: degrees of freedom and form of the data.
        let begin = lines.iter().position(|l| l.trim_end() == "    58").unwrap();
        assert_eq!(lines[begin + 6].len(), 5 + 10 + 5 + 10 + 1 + 10 + 10 + 4 + 1 + 10 + 10 + 4);
        assert_eq!(lines[begin + 7][10..20].trim().parse::<usize>().unwrap(), frf.frequencies_hz.len());
        let (set, warnings) =
            read("t", text.as_bytes(), Unstated { unit: 1e-3, quantity: None }).unwrap().into_set();
        assert!(warnings.is_empty() && set.frfs.len() == frf.responses.len(), "{warnings:?}");
        for (found, exact) in set.frfs.iter().zip(&frf.responses) {
            assert_eq!(found.quantity, frf.quantity);
            assert_eq!(found.excitation.direction, [1.0, 0.0, 0.0]);
            assert_eq!(found.response.direction, [0.0; 3], "along no axis");
            let place = set.points[found.response.point].position;
            // The format has six digits of a place.
            let alike = |(a, b): (&f64, &f64)| within((a - b).abs(), 5e-6 * b.abs(), Reference);
            assert!(place.iter().zip(&exact.at.position).all(alike), "{place:?}");
            let near = found
                .values
                .iter()
                .zip(&exact.values)
                .all(|(a, b)| within((a - b).norm(), 1e-12 * b.norm(), Reference));
            assert!(near);
        }
        let binary = functions(&FrfResult { binary: true, ..frf.clone() });
        let (set, warnings) = read("b", &binary, Unstated { unit: 1e-3, quantity: None }).unwrap().into_set();
        assert!(warnings.is_empty() && set.frfs.len() == frf.responses.len(), "{warnings:?}");
        for (found, exact) in set.frfs.iter().zip(&frf.responses) {
            assert!(found.values == exact.values && found.frequencies_hz == frf.frequencies_hz);
        }
    }

    /// Around a resonance the lines of a response are nearer than six digits resolve.
    #[test]
    fn lines_too_near_for_the_text_are_written_once() {
        let mut frf = sample::rig().take::<FrfResult>().unwrap();
        let count = frf.frequencies_hz.len();
        frf.frequencies_hz[1] = frf.frequencies_hz[0] * (1.0 + 1e-9);
        let (set, _) =
            read("t", &functions(&frf), Unstated { unit: 1e-3, quantity: None }).unwrap().into_set();
        assert_eq!(set.frfs[0].frequencies_hz.len(), count - 1);
        let first = frf.responses[0].values[0];
        assert!(within((set.frfs[0].values[0] - first).norm(), 1e-12 * first.norm(), Reference));
        let (set, _) = read(
            "b",
            &functions(&FrfResult { binary: true, ..frf }),
            Unstated { unit: 1e-3, quantity: None },
        )
        .unwrap()
        .into_set();
        assert_eq!(set.frfs[0].frequencies_hz.len(), count);
    }

    #[test]
    fn shapes_come_back_as_they_were_written() {
        let results = sample::rig();
        let set = results.all::<NamedModes>()[0];
        let text = modes(&results.geometry, set);
        let (back, warnings) =
            read("t", text.as_bytes(), Unstated { unit: 1.0, quantity: None }).unwrap().into_set();
        assert!(warnings.is_empty() && back.modes.len() == set.modes.len(), "{warnings:?}");
        assert_eq!(back.points.len(), results.geometry.nodes.len());
        for (k, mode) in back.modes.iter().enumerate() {
            assert!(within((mode.frequency_hz / set.modes.frequency_hz(k) - 1.0).abs(), 1e-5, Reference));
            let damping = mode.damping_ratio.unwrap();
            assert!(within((damping / set.damping_ratio[k] - 1.0).abs(), 1e-5, Reference), "{damping}");
            let shape = mode.shape.as_ref().unwrap();
            for (dof, value) in back.dofs.iter().zip(shape) {
                let node = back.points[dof.point].id as usize - 1;
                let exact: f64 = (0..3).map(|a| dof.direction[a] * set.shape(k)[node][a]).sum();
                assert!(value.im == 0.0 && within((value.re - exact).abs(), 1e-5 * exact.abs(), Reference));
            }
        }
    }
}
