//! The plates and faces of a case that radiate, and its microphones, checked before anything is computed.

mod acoustics;
#[cfg(test)]
mod tests;

pub use acoustics::acoustics;
