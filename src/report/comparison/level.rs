//! The name of a level: a mode, or modes of one frequency.

use crate::results::NamedModes;
use std::ops::Range;

/// The name of a level: `(2, 0) ×2`, `mode 7`.
pub(super) fn level_name(set: &NamedModes, level: &Range<usize>) -> String {
    let name = match set.names.get(level.start).copied().flatten() {
        Some(name) => format!("({}, {})", name.nodal_diameters, name.nodal_circles),
        None => format!("mode {}", level.start + 1),
    };
    if level.len() > 1 { format!("{name} ×{}", level.len()) } else { name }
}
