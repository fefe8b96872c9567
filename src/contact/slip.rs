//! The speed of slip from the force that a point would need to stick.

use super::coefficient::{Coefficient, FrictionCoefficient};

/// The equation for the speed of slip v ≥ 0: κ Δt v + μ(w(v)) N = |**F***|.
pub(super) struct Slip<'a> {
    pub(super) friction: &'a dyn FrictionCoefficient,
    pub(super) pressure: f64,
    /// N.
    pub(super) load: f64,
    /// κ Δt \[N s/m\].
    pub(super) resistance: f64,
    /// By how much the speed at the end of the step is above its mean.
    pub(super) late: f64,
}

/// A speed with μ there.
pub(super) struct Slipping {
    pub(super) mu: Coefficient,
    /// ∂w/∂v.
    pub(super) by_speed: f64,
    /// ∂w/∂late.
    pub(super) by_late: f64,
}

impl Slip<'_> {
    fn at(&self, speed: f64) -> Slipping {
        let (w, by_speed, by_late) = if self.late >= speed {
            (2.0 * speed, 2.0, 0.0)
        } else if self.late <= -speed {
            (0.0, 0.0, 0.0)
        } else {
            (speed + self.late, 1.0, 1.0)
        };
        Slipping { mu: self.friction.mu(w, self.pressure), by_speed, by_late }
    }

    /// The solution that Newton's method, kept inside a bracket, comes to from a speed `first`: that with the highest speed
    /// from `size`/(κ Δt). There is one because the left-hand side is below `size` at v = 0 and not below it there.
    pub(super) fn solve(&self, size: f64, first: f64) -> Slipping {
        let (mut low, mut high) = (0.0, size / self.resistance);
        let mut speed = first.min(high);
        let mut at = self.at(speed);
        for _ in 0..100 {
            let over = self.resistance * speed + self.load * at.mu.value - size;
            if over.abs() <= 4.0 * f64::EPSILON * size || high - low <= f64::EPSILON * high {
                break;
            }
            if over > 0.0 {
                high = speed;
            } else {
                low = speed;
            }
            let slope = self.resistance + self.load * at.mu.by_speed * at.by_speed;
            let newton = speed - over / slope;
            speed = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            at = self.at(speed);
        }
        at
    }
}
