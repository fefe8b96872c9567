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

    /// Another beginning for every seed, and for every `STRIDOR_TEST_SEED=k`: the same tests on other samples.
    pub fn seeded(seed: u64) -> Self {
        let seed = seed.wrapping_add(variation("STRIDOR_TEST_SEED") * 1_000_003);
        Random(seed.wrapping_mul(2).wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15))
    }

    /// The next number in [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        let x = low + (high - low) * 0.5 * (self.next() + 1.0);
        self.perturbed(x)
    }

    /// x, with `STRIDOR_TEST_PERTURBATION=k` changed by ε|x| up, down or not: the k-th perturbation by round-off.
    pub fn perturbed(&self, x: f64) -> f64 {
        match variation("STRIDOR_TEST_PERTURBATION") {
            0 => x,
            k => x * (1.0 + f64::EPSILON * (((self.0 ^ (self.0 >> 32)).wrapping_add(k) % 3) as f64 - 1.0)),
        }
    }

    /// A whole number below `count`.
    pub fn below(&mut self, count: usize) -> usize {
        (0.5 * (self.next() + 1.0) * count as f64) as usize
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

/// Which of the variations of that name the tests are run with: 0, none, where the variable is not set.
fn variation(name: &str) -> u64 {
    std::env::var(name).map_or(0, |k| k.parse().expect("a number of the variation"))
}
