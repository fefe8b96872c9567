//! Functions of time of a case.

use crate::case::Course;
use crate::transient::TimeProfile;

/// How something runs in time.
pub fn profile(course: Option<&Course>) -> TimeProfile {
    match course {
        None | Some(Course::Constant {}) => TimeProfile::Constant,
        Some(Course::Ramp { from, duration }) => TimeProfile::Ramp { from: *from, duration: *duration },
        Some(Course::Reciprocating { frequency, phase }) => {
            TimeProfile::Reciprocating { frequency_hz: *frequency, phase: *phase }
        }
        Some(Course::Table { time, factor }) => {
            TimeProfile::Table { times: time.clone(), factors: factor.clone() }
        }
    }
}
