//! The table that sets a reduced model beside the full one.

use super::format::{hertz, power};
use super::table::ReportTable;
use crate::results::{ComplexResult, Deviation, ReducedCheck};

/// The largest deviations, one a row.
pub(super) fn table(check: &ReducedCheck, complex: Option<&ComplexResult>) -> ReportTable {
    let mut table =
        ReportTable::new("Reduced model beside the full one", &["<largest deviation of", "relative", "<at"]);
    let mode = |of: &Deviation| {
        let modes = complex.and_then(|c| c.modes.modes.get(of.mode));
        modes.map_or(String::new(), |mode| {
            format!("mode {}, {} Hz", of.mode + 1, hertz(mode.frequency_hz(), 1))
        })
    };
    let mut row = |what: String, value: f64, place: String| table.row(vec![what, power(value), place], false);
    let [modes, found] = check.modes;
    if let Some(of) = &check.eigenvalue {
        row(format!("λ, of {found} complex modes"), of.relative, mode(of));
    }
    if let Some(of) = &check.growth {
        row("growth rate".into(), of.relative, mode(of));
    }
    if let Some(motion) = &check.motion {
        let place = format!("in {} steps, of its span", motion.steps);
        if let Some(value) = motion.displacement {
            row(format!("displacement at {}", motion.probe), value, place.clone());
        }
        if let Some(value) = motion.normal_force {
            row("normal force".into(), value, place);
        }
        if motion.displacement.is_none() && motion.normal_force.is_none() {
            table
                .notes
                .push(format!("Nothing moved in the first {} steps, which are compared.", motion.steps));
        }
    }
    if found < modes {
        table.notes.push(format!("{} of {modes} complex modes are not in the reduced model.", modes - found));
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::sample;
    use crate::results::TransientResult;

    #[test]
    fn deviations_stand_beside_their_modes_and_what_is_missing_is_said() {
        let results = sample::rig();
        let mut check = results.get::<TransientResult>().unwrap().reduced_check.clone().unwrap();
        let rows = table(&check, results.get::<ComplexResult>()).rows;
        assert_eq!(rows.len(), 4);
        assert!(rows[1].cells[2].starts_with("mode 7, ") && rows[2].cells[0] == "displacement at rim");
        check.modes = [14, 12];
        let motion = check.motion.as_mut().unwrap();
        (motion.displacement, motion.normal_force) = (None, None);
        let notes = table(&check, None).notes;
        assert!(notes[0].starts_with("Nothing moved") && notes[1].starts_with("2 of 14"), "{notes:?}");
    }
}
