//! Words that users of other programs look for: what is not modelled, and what stands in its place.

use crate::error::{Error, Fault};

/// Keys that a case does not have, with a sentence on each.
const ABSENT: [(&[&str], &str); 11] = [
    (&["volume", "brick", "tet", "hex"], "A solid is a [solid.NAME], named as its region of the mesh"),
    (
        &["mpc", "coupling", "constraint", "rbe2", "rbe3", "bond", "bonded", "glue"],
        "Surfaces are joined by [tie.NAME] with `on` and `to`, regions to a point by [rigid.NAME], or by [averaging.NAME] without making \
         them stiffer, degrees of freedom by [equation.NAME]",
    ),
    (
        &["rotation_speed", "rotational_speed", "angular_velocity", "omega", "rpm", "spin"],
        "Parts turn by [rotation.NAME] with `parts` and `speed`; the speed at a contact is its `sliding_velocity`, or the speed of its `rotation`",
    ),
    (
        &["pressure"],
        "Pressure is not modelled: give its resultant as [force.NAME] on the region, or as the `load` of a [contact]",
    ),
    (
        &["temperature", "thermal", "expansion"],
        "Heat is not modelled: give materials their values at the temperature of the brake",
    ),
    (
        &["gravity", "acceleration"],
        "Gravity is not modelled: give the weight of a part as [force.NAME] on its region",
    ),
    (
        &["moment", "torque", "couple"],
        "Moments are not modelled: give a pair of [force] on regions apart from each other",
    ),
    (&["damper", "dashpot"], "A dashpot is a [spring] with `damping` and a `stiffness` that may be small"),
    (&["boundary", "fixed", "clamp", "bc", "spc"], "Held regions are [support.NAME] with `on`"),
    (&["plate", "membrane", "disc", "disk"], "A plate is a [shell.NAME], named as its region of the mesh"),
    (&["beam", "rod", "truss"], "A beam is a [bar.NAME], named as its region of the mesh"),
];

/// The error with a sentence at each unknown key that is one of [`ABSENT`].
pub(super) fn explained(error: Error) -> Error {
    let Error::Input(mut faults) = error else { return error };
    for fault in faults.0.iter_mut().filter(|fault| fault.found == "an unknown key") {
        if let Some(sentence) = sentence(fault) {
            fault.help = sentence.to_string();
        }
    }
    Error::Input(faults)
}

fn sentence(fault: &Fault) -> Option<&'static str> {
    let path = fault.place.split('`').nth(1)?;
    let key = path.rsplit('.').next()?.to_lowercase();
    let near = |word: &&str| *word == key || key.strip_suffix('s') == Some(word);
    ABSENT.iter().find(|(words, _)| words.iter().any(near)).map(|(_, sentence)| *sentence)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Case;

    /// Every word, as a table of named tables, as a table and as a key, has its sentence.
    #[test]
    fn words_of_other_programs_are_told_what_stands_in_their_place() {
        for (words, sentence) in ABSENT {
            for word in words {
                for text in [
                    format!("[{word}.a]\nb = 1\n"),
                    format!("{word} = 3\n"),
                    format!("[contact.a]\n{word} = 1\n"),
                ] {
                    let error = Case::parse("a.toml", &text, "".into()).unwrap_err().to_string();
                    assert!(error.contains(sentence), "{text}: {error}");
                }
            }
        }
    }
}
