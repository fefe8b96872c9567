//! Where the theory of a plate is off at the highest frequency asked.

use super::frequency::highest_frequency;
use crate::error::Fault;
use crate::job::prepared::Prepared;
use crate::numbers::significant;
use crate::schema::dotted;
use crate::structure::thickness_errors;

/// The error of a frequency that is worth a word: more than that of the elements of a good mesh.
const ERROR: f64 = 0.01;

pub fn warnings(prepared: &Prepared) -> Vec<Fault> {
    let of_part = |name: &str| highest_frequency(prepared, name);
    let errors = thickness_errors(&prepared.model, &of_part);
    let worth = errors.iter().filter(|e| e.relative_error > ERROR || e.frequency_hz > e.mindlin_below_hz);
    worth
        .map(|e| {
            let place = format!("`shell.{}.theory`", dotted(&e.part));
            let hz = significant(e.frequency_hz, 3);
            let too_high = format!(
                "frequencies near {hz} Hz about {:.1} % too high by Kirchhoff's theory (kh = {:.2})",
                100.0 * e.relative_error,
                e.wavenumber_times_thickness
            );
            if e.frequency_hz > e.mindlin_below_hz {
                let found = if e.relative_error > 0.0 { too_high } else { format!("a plate at {hz} Hz") };
                let limit = significant(e.mindlin_below_hz, 3);
                let expected = format!("frequencies below its thickness-shear resonance, {limit} Hz");
                let help = "No theory of plates holds there, only solid elements: lower the band";
                return Fault::new(place, found, expected).with_help(help);
            }
            let expected = format!("less than {:.0} %", 100.0 * ERROR);
            let help = "`theory = \"mindlin\"` takes the shear of thick plates into account";
            Fault::new(place, too_high, expected).with_help(help)
        })
        .collect()
}
