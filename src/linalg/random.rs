//! Numbers that look random and are the same in every run.

/// Numbers in [-1, 1): Marsaglia's xorshift, J. Stat. Softw. 8 (2003) 14.
#[derive(Debug, Clone)]
pub struct Random(u64);

impl Random {
    /// The generator at its one beginning.
    #[expect(clippy::new_without_default)]
    pub fn new() -> Self {
        Random(0x2545_F491_4F6C_DD1D)
    }

    /// The next number.
    #[expect(clippy::should_implement_trait)]
    pub fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}
