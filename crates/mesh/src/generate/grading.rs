//! How large the elements are, and where.

use super::{Faults, require_positive};
use stridor_base::error::Fault;

/// Element size as a function of the distance d from the contact:
/// h(d) = min(coarse, fine + growth · max(0, d − fine_radius)).
///
/// Neighbouring edges then differ by a factor of about 1 + growth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grading {
    /// Edge length at the contact \[m\].
    pub fine: f64,
    /// Distance from the contact up to which the edge stays `fine` \[m\].
    pub fine_radius: f64,
    /// Largest edge length \[m\].
    pub coarse: f64,
    /// Growth of the edge per distance; 0.15 to 0.35 gives good triangles.
    pub growth: f64,
}

impl Grading {
    /// One size everywhere.
    pub fn uniform(size: f64) -> Self {
        Grading { fine: size, fine_radius: 0.0, coarse: size, growth: 0.25 }
    }

    /// `fine` within `fine_radius` of the contact, growing by 0.25 per distance to `coarse`.
    pub fn graded(fine: f64, fine_radius: f64, coarse: f64) -> Self {
        Grading { fine, fine_radius, coarse, growth: 0.25 }
    }

    /// h at the distance `d` from the contact \[m\].
    ///
    /// ```
    /// let g = stridor_mesh::generate::Grading::graded(0.5e-3, 2e-3, 4e-3);
    /// assert_eq!((g.at(1e-3), g.at(6e-3), g.at(1.0)), (0.5e-3, 1.5e-3, 4e-3));
    /// ```
    pub fn at(&self, d: f64) -> f64 {
        (self.fine + self.growth * (d - self.fine_radius).max(0.0)).min(self.coarse)
    }

    /// Faults of the grading.
    pub(super) fn faults(&self, part: &str) -> Faults {
        let mut faults = require_positive(part, &[("fine", self.fine), ("coarse", self.coarse)]);
        if !(self.fine_radius.is_finite() && self.fine_radius >= 0.0) {
            let found = self.fine_radius.to_string();
            faults.push(Fault::new(
                format!("{part} `fine_radius`"),
                found,
                "a length of zero or more, in metres",
            ));
        }
        if self.fine > self.coarse {
            let found = format!("{} m, larger than `coarse`, {} m", self.fine, self.coarse);
            faults.push(Fault::new(format!("{part} `fine`"), found, "at most `coarse`"));
        }
        if !(0.05..=0.5).contains(&self.growth) {
            faults.push(Fault::new(
                format!("{part} `growth`"),
                self.growth.to_string(),
                "a growth in 0.05 … 0.5",
            ));
        }
        faults
    }
}
