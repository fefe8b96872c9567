//! What the program is checked against.

pub mod kirchhoff;
