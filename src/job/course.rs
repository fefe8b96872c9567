//! Functions of time of a case.

use crate::case::Course;
use crate::transient::Profile;

/// How something runs in time.
pub fn profile(course: Option<&Course>) -> Profile {
    match course {
        None | Some(Course::Constant {}) => Profile::Constant,
        Some(Course::Ramp { from, duration }) => Profile::Ramp { from: *from, duration: *duration },
        Some(Course::Reciprocating { frequency, phase }) => {
            Profile::Reciprocating { frequency_hz: *frequency, phase: *phase }
        }
        Some(Course::Table { time, factor }) => {
            Profile::Table { times: time.clone(), factors: factor.clone() }
        }
    }
}
