//! Where two bodies touch: points, their directions in the degrees of freedom, and how the pair is closed.

use super::{ContactLaw, ContactMotion};
use crate::linalg::SparseVector;
use std::sync::Arc;

/// Two bodies in sliding contact: the *body* (the disc) and the *counter-body* (the slider).
#[derive(Debug, Clone)]
pub struct ContactPair {
    /// The name the case gives it.
    pub name: String,
    /// Every point that may touch; systems that differ in laws, loads and velocities alone share them.
    pub points: Arc<[ContactPoint]>,
    /// Forces from motion.
    pub law: Arc<dyn ContactLaw>,
    /// Closing condition: normal load or approach.
    pub closing: Closing,
    /// V \[m/s\]: velocity of the counter-body relative to the body along t₁, without vibration; of one that turns, at the mean distance of
    /// the points from the axis.
    pub sliding_velocity: f64,
}

impl ContactPair {
    /// The velocity of the counter-body relative to the body at one of the pair's points, along its t₁ \[m/s\].
    pub fn velocity_at(&self, point: &ContactPoint) -> f64 {
        self.sliding_velocity * point.speed
    }

    /// The least gap of its points \[m\]: the approach at which the undeformed bodies touch.
    pub fn least_gap(&self) -> f64 {
        self.points.iter().map(|point| point.gap).fold(f64::INFINITY, f64::min)
    }

    /// Whether the bodies do not slide past each other: their points stick.
    pub fn sticks(&self) -> bool {
        self.sliding_velocity == 0.0
    }

    /// Whether its points also pull, so that they never open and touch without a load, too.
    pub fn is_bilateral(&self) -> bool {
        let motion = ContactMotion { penetration: -1.0, penetration_rate: 0.0, slip_velocity: [0.0; 2] };
        self.law.respond(&motion, 1.0).0.normal < 0.0
    }
}

/// One point that may touch.
#[derive(Debug, Clone)]
pub struct ContactPoint {
    /// Where it is \[m\]; for results and pictures.
    pub position: [f64; 3],
    /// Initial gap \[m\]: δ = approach − gap + gᵀu.
    pub gap: f64,
    /// Contact length \[m\] or area \[m²\] it stands for, or its share of one.
    pub weight: f64,
    /// How fast the counter-body slides here, in parts of the pair's V: 1, but for one that turns.
    pub speed: f64,
    /// g: closes the contact (grows the penetration) when u moves along it.
    pub normal: SparseVector,
    /// t₁ (along the sliding direction) and t₂ (across): displacement of the body relative to the counter-body.
    pub tangents: [SparseVector; 2],
}

/// Closing condition of a contact pair: normal load or approach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Closing {
    /// The bodies are moved towards each other until ΣN equals this load \[N\]; the approach is an unknown.
    Load(f64),
    /// A given approach \[m\]; external forces do the rest.
    Approach(f64),
}
