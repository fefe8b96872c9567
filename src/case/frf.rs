//! `[frf.NAME]`: frequency response functions.

use super::reader::Section;
use super::units::{FREQUENCY, LENGTH};
pub use crate::measured::Quantity as FrfQuantity;
use serde::Serialize;
use std::collections::BTreeMap;

/// Motion at some places for a harmonic force at another.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FrfAnalysis {
    /// Where and along what the force acts.
    pub excitation: MotionAt,
    /// Where and along what motion is looked at, by name; at the excitation where none is named.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub response: BTreeMap<String, MotionAt>,
    /// What of the motion.
    pub quantity: FrfQuantity,
    /// The lowest and the highest frequency \[Hz\].
    pub band: [f64; 2],
    /// Whether the contacts slide as in steady sliding, or are open.
    pub contact: FrfContact,
    /// How it is computed.
    pub solution: FrfSolution,
    /// Whether the universal file has its numbers in binary form (dataset 58b) rather than as text.
    #[serde(rename = "uff", serialize_with = "uff_name")]
    pub binary: bool,
    /// Resonances that were measured \[Hz\], to compare.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub measured: Vec<f64>,
}

/// A place and a direction.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MotionAt {
    /// A region, the mean of its nodes where it has several, or …
    #[serde(skip_serializing_if = "Option::is_none")]
    pub on: Option<String>,
    /// … a place \[m\], whose nearest node it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at: Option<[f64; 3]>,
    /// The direction.
    pub direction: [f64; 3],
}

/// What the contacts do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FrfContact {
    /// Nothing touches.
    Open,
    /// They slide steadily, and move about that a little.
    Sliding,
}

/// How a response is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FrfSolution {
    /// By superposition of modes and static residuals.
    Modes,
    /// By a solution of the full order at every frequency.
    Direct,
}

pub(super) fn read(s: &Section) -> FrfAnalysis {
    let excitation = s.section("excitation", read_motion);
    if excitation.is_none() {
        s.fault(
            "excitation",
            "nothing",
            "where the force acts: { at = [0, 0, \"-70 mm\"], direction = [1, 0, 0] }",
            "",
        );
    }
    let nowhere = MotionAt { on: None, at: None, direction: [1.0, 0.0, 0.0] };
    let ascending = |b: &[f64; 2]| b[0] > 0.0 && b[1] > b[0];
    FrfAnalysis {
        excitation: excitation.unwrap_or(nowhere),
        response: super::read::collect(s, "response", read_motion),
        quantity: match s.choice("quantity", &["receptance", "mobility", "accelerance"]).or("accelerance") {
            "receptance" => FrfQuantity::Receptance,
            "mobility" => FrfQuantity::Mobility,
            _ => FrfQuantity::Accelerance,
        },
        band: s
            .quantities("band", FREQUENCY)
            .check("two frequencies above zero, the lower one first", ascending)
            .required("two frequencies such as [\"10 Hz\", \"3 kHz\"]"),
        contact: match s.choice("contact", &["open", "sliding"]).or("open") {
            "sliding" => FrfContact::Sliding,
            _ => FrfContact::Open,
        },
        solution: match s.choice("solution", &["modes", "direct"]).or("modes") {
            "direct" => FrfSolution::Direct,
            _ => FrfSolution::Modes,
        },
        binary: s.choice("uff", &["text", "binary"]).or("text") == "binary",
        measured: s.quantity_list("measured", FREQUENCY).or(Vec::new()),
    }
}

fn uff_name<S: serde::Serializer>(binary: &bool, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(if *binary { "binary" } else { "text" })
}

fn read_motion(s: &Section) -> MotionAt {
    let (on, at) = (s.string("on").optional(), s.quantities("at", LENGTH).optional());
    if on.is_some() == at.is_some() {
        let found = if on.is_some() { "both `on` and `at`" } else { "nothing" };
        s.fault("at", found, "a place `at` as three lengths, or a region `on`", "");
    }
    let direction = s.direction("direction");
    MotionAt { on, at, direction: direction.required("a vector such as [1, 0, 0]") }
}
