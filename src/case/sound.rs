//! `[transient.sound]`: how loud a run in time is, and where one listens.

use super::read::collect;
use super::reader::Section;
use super::units::{DENSITY, LENGTH, VELOCITY};
use serde::Serialize;
use std::collections::BTreeMap;

/// Sound of the vibrating plates.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SoundAnalysis {
    /// How far the microphone `axis` stands from the disc's centre, or from the middle of the largest plate \[m\]; it is
    /// there when no other is named.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distance: Option<f64>,
    /// The direction in which it stands; along the plate's normal when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub direction: Option<[f64; 3]>,
    /// The plates that are heard; all when empty.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub plates: Vec<String>,
    /// What carries the sound.
    pub air: AirChoice,
    /// Other microphones, by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub microphone: BTreeMap<String, Microphone>,
}

/// Air, or another gas.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct AirChoice {
    /// ρ₀ \[kg/m³\].
    pub density: f64,
    /// c \[m/s\].
    pub speed: f64,
}

/// A place to listen at.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Microphone {
    /// Where \[m\], in the mesh's axes after the bodies were placed.
    pub at: [f64; 3],
}

/// How far a microphone may be \[m\].
const FARTHEST: f64 = 1e3;

/// The name of the microphone that `distance` places.
pub const ON_AXIS: &str = "axis";

pub(super) fn read(s: &Section) -> SoundAnalysis {
    let microphone: BTreeMap<String, Microphone> = collect(s, "microphone", |m| Microphone {
        at: m
            .quantities("at", LENGTH)
            .check("a place within 1 km of the origin", |at| at.iter().all(|x| x.abs() <= FARTHEST))
            .required("a place as three lengths"),
    });
    let plain = |name: &str| name.chars().all(|c| c.is_alphanumeric() || c == '-' || c == '_');
    for name in microphone.keys().filter(|name| !plain(name) || *name == ON_AXIS) {
        let expected = format!("letters, digits, `-` and `_`, and not `{ON_AXIS}`, which `distance` places");
        s.fault(&format!("microphone.{name}"), format!("the name \"{name}\""), expected, "");
    }
    let distance = s.quantity("distance", LENGTH).positive();
    let distance = distance.check("1 km at most", |d| *d <= FARTHEST).optional();
    SoundAnalysis {
        distance: distance.or_else(|| microphone.is_empty().then_some(1.0)),
        direction: s.direction("direction").optional(),
        plates: s.strings("plates").or(Vec::new()),
        air: s
            .section("air", |a| AirChoice {
                density: a.quantity("density", DENSITY).positive().or(AirChoice::default().density),
                speed: a
                    .quantity("speed", VELOCITY)
                    .check("a velocity between 10 m/s and 10 km/s", |c| (10.0..=1e4).contains(c))
                    .or(AirChoice::default().speed),
            })
            .unwrap_or_default(),
        microphone,
    }
}

impl Default for AirChoice {
    /// 20 °C at sea level.
    fn default() -> Self {
        AirChoice { density: 1.204, speed: 343.0 }
    }
}
