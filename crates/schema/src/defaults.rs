//! Defaults: every key that has one takes it.

use super::{Key, Presence, Slot, Table, TableSlot, Variants, Visitor};

struct Defaults;

/// `table` with every default filled in. Keys that must be there stay as they are.
pub fn with_defaults<T: Table>(mut table: T) -> T {
    table.visit(&mut Defaults);
    table
}

/// Fills the defaults of `table` in.
pub(super) fn set_defaults(table: &mut dyn Table) {
    table.visit(&mut Defaults);
}

impl Visitor for Defaults {
    fn value(&mut self, _: Key, slot: &mut dyn Slot) {
        slot.set_default();
    }

    fn table(&mut self, _: Key, slot: &mut dyn TableSlot) {
        if slot.presence() == Presence::Always {
            slot.each(&mut |_, table| set_defaults(table));
        }
    }

    fn variants(
        &mut self,
        variants: &Variants,
        current: usize,
        visit: &mut dyn FnMut(usize, &mut dyn Visitor),
    ) {
        visit(variants.default.unwrap_or(current), self);
    }

    fn flat(&mut self, table: &mut dyn Table) {
        table.visit(self);
    }
}
