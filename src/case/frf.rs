//! `[frf.NAME]`: frequency response functions.

pub use crate::measured::Quantity as FrfQuantity;
use crate::schema::units::{FREQUENCY, LENGTH};
use crate::schema::{Report, choices, declare, key};
use std::collections::BTreeMap;

declare! {
    /// Motion at some places for a harmonic force at another.
    pub struct FrfAnalysis {
        /// Where and along what the force acts.
        pub excitation: MotionAt = key::table()
            .required("where the force acts: { at = [0, 0, \"-70 mm\"], direction = [1, 0, 0] }"),
        /// Where and along what motion is looked at, by name; at the excitation where none is named.
        pub response: BTreeMap<String, MotionAt> = key::named(),
        /// Quantity of the response: displacement, velocity or acceleration per force.
        pub quantity: FrfQuantity = key::choice().or(FrfQuantity::Accelerance),
        /// The lowest and the highest frequency \[Hz\].
        pub band: [f64; 2] = key::quantities(FREQUENCY)
            .expecting("two frequencies such as [\"10 Hz\", \"3 kHz\"]")
            .check("two frequencies above zero, the lower one first", |b| b[0] > 0.0 && b[1] > b[0]),
        /// Whether the contacts slide as in steady sliding, or are open.
        pub contact: FrfContact = key::choice().or(FrfContact::Open),
        /// How it is computed.
        pub solution: FrfSolution = key::choice().or(FrfSolution::Modes),
        /// How the universal file has its numbers.
        pub uff: UniversalForm = key::choice().or(UniversalForm::Text),
        /// Resonances that were measured \[Hz\], to compare.
        pub measured: Vec<f64> = key::quantity_list(FREQUENCY).or(Vec::new()),
    }
}

declare! {
    /// A place and a direction.
    pub struct MotionAt, checked by check_place {
        /// A region, the mean of its nodes where it has several, or …
        pub on: Option<String> = key::name("a region").optional(),
        /// … a place \[m\], whose nearest node it is.
        pub at: Option<[f64; 3]> = key::quantities(LENGTH).optional(),
        /// The direction.
        pub direction: [f64; 3] = key::direction().expecting("a vector such as [1, 0, 0]"),
    }
}

fn check_place(place: &MotionAt, report: &mut Report) {
    if place.on.is_some() == place.at.is_some() {
        let found = if place.on.is_some() { "both `on` and `at`" } else { "nothing" };
        report.fault("at", found, "a place `at` as three lengths, or a region `on`", "");
    }
}

choices! {
    /// State of the contacts.
    pub enum FrfContact {
        /// Nothing touches.
        Open = "open",
        /// They slide steadily, and move about that a little.
        Sliding = "sliding",
    }
}

choices! {
    /// How a response is computed.
    pub enum FrfSolution {
        /// By superposition of modes and static residuals.
        Modes = "modes",
        /// By a solution of the full order at every frequency.
        Direct = "direct",
    }
}

choices! {
    /// How a universal file has its numbers.
    pub enum UniversalForm {
        /// As text, dataset 58.
        Text = "text",
        /// In binary form, dataset 58b.
        Binary = "binary",
    }
}
