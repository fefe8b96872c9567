//! The version of the program.

use std::sync::LazyLock;

/// Version and, where it is known, commit: `0.1.0 (0123456789ab)`.
pub static VERSION: LazyLock<String> = LazyLock::new(|| {
    let commit = crate::COMMIT.map_or(String::new(), |commit| format!(" ({commit})"));
    format!("{}{commit}", env!("CARGO_PKG_VERSION"))
});
