//! What an earlier run has recorded of a run in time.

use super::entry::Entry;
use crate::transient::Checkpoint;

/// What an earlier run has recorded of a run in time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Earlier {
    /// The channels, each with its first value.
    pub channels: Vec<(String, f64)>,
    /// Rows.
    pub rows: usize,
    /// Events in them.
    pub events: usize,
    /// Motions of all nodes in them.
    pub fields: usize,
    /// State from which it resumes.
    pub march: Option<Checkpoint>,
    modes: usize,
}

impl Earlier {
    /// Adds an entry of the run in time; says what is wrong when it does not follow those before.
    pub(super) fn add(&mut self, entry: &Entry) -> std::result::Result<(), &'static str> {
        match entry {
            Entry::Transient { channels, modes } => {
                if self.rows > 0 {
                    return Err("two runs in time");
                }
                let channels = channels.iter().map(|name| (name.clone(), f64::NAN)).collect();
                *self = Earlier { channels, modes: *modes, ..Earlier::default() };
            }
            Entry::Rows { first, values, modal, events } => {
                if *first != self.rows || values.len() != self.channels.len() || modal.len() != self.modes {
                    return Err("rows that do not follow those before");
                }
                if self.rows == 0 {
                    self.channels.iter_mut().zip(values).for_each(|(channel, all)| channel.1 = all[0]);
                }
                self.rows += values.first().map_or(0, Vec::len);
                self.events += events.len();
            }
            Entry::Field { number, .. } => {
                if *number != self.fields {
                    return Err("motion that does not follow that before");
                }
                self.fields += 1;
            }
            Entry::Head(_) | Entry::Reference(_) | Entry::Answer { .. } | Entry::End => {}
        }
        Ok(())
    }
}
