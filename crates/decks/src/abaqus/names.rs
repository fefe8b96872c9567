//! Names as Abaqus compares them: capitals, small letters and blanks around make no difference.

use std::collections::HashMap;

/// What has names.
#[derive(Debug)]
pub(super) struct Names<T> {
    places: HashMap<String, usize>,
    /// All of it, in the order in which it was named first.
    pub all: Vec<T>,
}

impl<T> Default for Names<T> {
    fn default() -> Self {
        Names { places: HashMap::new(), all: Vec::new() }
    }
}

/// A name as it is compared.
pub(super) fn key(name: &str) -> String {
    super::blocks::unquoted(name).to_uppercase()
}

impl<T> Names<T> {
    /// What has this name.
    pub fn get(&self, name: &str) -> Option<&T> {
        self.places.get(&key(name)).map(|place| &self.all[*place])
    }

    /// What has this name, made by `new` if nothing has it.
    pub fn entry(&mut self, name: &str, new: impl FnOnce() -> T) -> &mut T {
        let next = self.all.len();
        let place = *self.places.entry(key(name)).or_insert(next);
        if place == next {
            self.all.push(new());
        }
        &mut self.all[place]
    }
}
