//! `[transient.sound]`: how loud a run in time is, and where one listens.

use crate::schema::units::{DENSITY, LENGTH, VELOCITY};
use crate::schema::{Report, declare, dotted, key};
use std::collections::BTreeMap;

declare! {
    /// Sound of the vibrating plates and flat faces.
    pub struct SoundAnalysis, checked by check {
        /// Microphones other than `axis`, by name.
        pub microphone: BTreeMap<String, Microphone> = key::named(),
        /// How far the microphone `axis` stands from the disc's centre, or from the middle of the largest plate \[m\].
        pub distance: Option<f64> = key::quantity(LENGTH)
            .positive()
            .check("1 km at most", |d| *d <= FARTHEST)
            .optional()
            .or_by("1 m where no other microphone is named", microphone.is_empty().then_some(1.0)),
        /// The direction in which it stands; along the plate's normal when absent.
        pub direction: Option<[f64; 3]> = key::direction().optional(),
        /// The plates that are heard, or solids by their two flat sides, or regions of flat faces; all plates, and all solids with flat sides,
        /// when empty.
        pub plates: Vec<String> = key::names("the names of plates, solids and regions of faces").or(Vec::new()),
        /// Medium of the sound; air of 20 °C at sea level by default.
        pub air: AirChoice = key::table(),
    }
}

declare! {
    /// Air, or another gas.
    pub struct AirChoice {
        /// ρ₀ \[kg/m³\].
        pub density: f64 = key::quantity(DENSITY).positive().or(1.204),
        /// c \[m/s\].
        pub speed: f64 = key::quantity(VELOCITY)
            .check("a velocity between 10 m/s and 10 km/s", |c| (10.0..=1e4).contains(c))
            .or(343.0),
    }
}

declare! {
    /// A place to listen at.
    pub struct Microphone {
        /// Where \[m\], in the mesh's axes after the bodies were placed.
        pub at: [f64; 3] = key::quantities(LENGTH)
            .expecting("a place as three lengths")
            .check("a place within 1 km of the origin", |at| at.iter().all(|x| x.abs() <= FARTHEST)),
    }
}

/// How far a microphone may be \[m\].
const FARTHEST: f64 = 1e3;

/// The name of the microphone that `distance` places.
pub const ON_AXIS: &str = "axis";

fn check(sound: &SoundAnalysis, report: &mut Report) {
    let refused = |name: &&String| !key::is_file_name(name) || *name == ON_AXIS;
    for name in sound.microphone.keys().filter(refused) {
        let expected = format!("letters, digits, `-` and `_`, and not `{ON_AXIS}`, which `distance` places");
        report.fault(&format!("microphone.{}", dotted(name)), format!("the name \"{name}\""), expected, "");
    }
}
