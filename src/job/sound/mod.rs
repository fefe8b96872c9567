//! Which plates of a case are heard, and from where; asked for before anything is computed.

mod acoustics;
#[cfg(test)]
mod tests;

pub use acoustics::acoustics;
