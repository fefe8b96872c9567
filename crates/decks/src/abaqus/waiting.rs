//! What a file has begun, and what waits for lines below it: laws, pairs, orientations, steps, elements without a shape.

use crate::deck::{Analysis, Place};

/// A law of contact.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Interaction {
    pub friction: f64,
    pub stick: Option<f64>,
    pub stiffness: Option<f64>,
    pub tied: bool,
}

/// A pair whose law may stand below it.
#[derive(Debug)]
pub(super) struct PendingContact {
    /// The name that a comment gives it.
    pub title: String,
    pub slave: String,
    pub master: String,
    pub interaction: String,
    pub tied: bool,
    pub closed: bool,
    pub within: Option<f64>,
    pub place: Place,
}

/// A mass, a spring, a dashpot or a node of a distributing coupling.
#[derive(Debug)]
pub(super) struct PointElement {
    pub number: u64,
    pub type_name: &'static str,
    pub nodes: Vec<usize>,
}

/// *ORIENTATION: a frame of the model.
#[derive(Debug, Clone)]
pub(super) enum Orientation {
    /// Directions 1 and 2.
    Axes([[f64; 3]; 2]),
    /// About an axis, or defined in another way.
    Other,
}

/// A step that is being read.
#[derive(Debug, Default)]
pub(super) struct Step {
    pub analysis: Option<Analysis>,
    /// Whether it has loads.
    pub loaded: bool,
}
