//! The analyses of a case. Each is a file here with an [`Analysis`]: what it is called, what it needs, which faults its input
//! can have; and with how it runs, [`Planned`]. [`ANALYSES`] lists them in the order in which they run; commands, selection, the check
//! of a case and the run itself follow from the list.

mod analysis;
mod calibrate;
mod cea;
mod frf;
mod modes;
mod selection;
mod sensitivity;
mod sweep;
mod transient;
mod uncertainty;

pub use analysis::{Analysis, Planned};
pub use selection::{ANALYSES, Selection};
pub(super) use transient::PHASE;
