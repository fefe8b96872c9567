//! Tables as TOML, every default written out.

use super::{By, Key, Slot, Table, TableSlot, Variants, Visitor};
use toml::{Table as Toml, Value};

struct Writing(Toml);

/// `table` as TOML in SI units with every default written out.
pub fn to_toml<T: Table + Clone>(table: &T) -> Toml {
    written(&mut table.clone())
}

fn written(table: &mut dyn Table) -> Toml {
    let mut writing = Writing(Toml::new());
    table.visit(&mut writing);
    writing.0
}

impl Visitor for Writing {
    fn value(&mut self, key: Key, slot: &mut dyn Slot) {
        if let Some(value) = slot.to_toml() {
            self.0.insert(key.name.into(), value);
        }
    }

    fn table(&mut self, key: Key, slot: &mut dyn TableSlot) {
        slot.each(&mut |name, table| {
            let table = written(table);
            match name {
                None if table.is_empty() => {}
                None => drop(self.0.insert(key.name.into(), Value::Table(table))),
                Some(name) => {
                    let all = self.0.entry(key.name).or_insert_with(|| Value::Table(Toml::new()));
                    if let Value::Table(all) = all {
                        all.insert(name.into(), Value::Table(table));
                    }
                }
            }
        });
    }

    fn variants(
        &mut self,
        variants: &Variants,
        current: usize,
        visit: &mut dyn FnMut(usize, &mut dyn Visitor),
    ) {
        if let By::Tag(tag) = variants.by {
            self.0.insert(tag.into(), Value::String(variants.each[current].0.into()));
        }
        visit(current, self);
    }

    fn flat(&mut self, table: &mut dyn Table) {
        table.visit(self);
    }
}
