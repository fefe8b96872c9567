//! What is noted while a deck is read.

use crate::deck::Place;
use crate::ledger::Ledger;
use crate::text::Files;

/// What is wrong, and what is not read.
pub(super) struct Notes<'n> {
    pub files: &'n mut Files,
    pub ledger: Ledger,
    /// How many members lists may still have: ranges that overlap make long lists of short lines.
    pub members_left: usize,
}

impl Notes<'_> {
    /// Whether a list may have so many members more.
    pub fn may_list(&mut self, members: usize, place: Place) -> bool {
        let may = members <= self.members_left;
        if may {
            self.members_left -= members;
        } else {
            let expected = "lists whose ranges do not overlap again and again";
            self.files.fault(place, "ranges of more members than four a byte of the files", expected);
        }
        may
    }
}
