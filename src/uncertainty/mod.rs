//! Uncertain scalars: their distributions, samples of them, and the statistics of what is computed of each sample.
//!
//! ```text
//! bounds, expected value, deviation → Distribution → samples → (one analysis each) → proportion, quantile, spearman, first_order
//! ```

mod distribution;
mod sampling;
mod statistics;

pub use distribution::Distribution;
pub use sampling::{Sampling, samples};
pub use statistics::{Proportion, first_order, proportion, quantile, spearman};
