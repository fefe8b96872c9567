//! Samples of several independent scalars.

use super::Distribution;
use crate::schema::choices;
use rand::seq::SliceRandom;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

choices! {
    /// How samples are drawn.
    pub enum Sampling {
        /// One sample in each of n intervals of equal probability of every scalar (McKay, Beckman and Conover, Technometrics 21
        /// (1979) 239): means of smooth results are as exact as with many more random samples.
        LatinHypercube = "latin_hypercube",
        /// Independent samples.
        Random = "random",
    }
}

/// `count` samples of independent scalars, a value for each of them in every sample; the same for the same seed. The values of a scalar
/// do not depend on those that follow it.
pub fn samples(of: &[Distribution], count: usize, sampling: Sampling, seed: u64) -> Vec<Vec<f64>> {
    let mut all = vec![vec![0.0; of.len()]; count];
    for (j, distribution) in of.iter().enumerate() {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(j as u64);
        let mut order: Vec<usize> = (0..count).collect();
        if sampling == Sampling::LatinHypercube {
            order.shuffle(&mut random);
        }
        for (sample, interval) in all.iter_mut().zip(order) {
            let within: f64 = random.gen_range(0.0..1.0);
            sample[j] = distribution.quantile(match sampling {
                Sampling::LatinHypercube => (interval as f64 + within) / count as f64,
                Sampling::Random => within,
            });
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};

    const OF: [Distribution; 2] = [
        Distribution { between: [0.0, 1.0], normal: None, log: false },
        Distribution { between: [-4.0, 8.0], normal: Some([2.0, 1.0]), log: false },
    ];

    #[test]
    fn a_latin_hypercube_has_one_sample_in_each_interval() {
        let all = samples(&OF, 200, Sampling::LatinHypercube, 7);
        let mut intervals: Vec<usize> = all.iter().map(|sample| (200.0 * sample[0]) as usize).collect();
        intervals.sort_unstable();
        assert!(intervals.iter().enumerate().all(|(k, own)| k == *own));
        // The mean of a stratified sample is much nearer to the expected value than 1/√n.
        let mean = all.iter().map(|sample| sample[1]).sum::<f64>() / 200.0;
        assert!(within((mean - 2.0).abs(), 0.01, RandomSample), "{mean}");
        assert_eq!(samples(&OF, 200, Sampling::LatinHypercube, 7), all);
        assert_ne!(samples(&OF, 200, Sampling::LatinHypercube, 8), all);
        // Without correlation, as far as so many samples show it.
        let products = all.iter().map(|sample| (sample[0] - 0.5) * (sample[1] - 2.0)).sum::<f64>();
        assert!(within(
            (products / 200.0 / (1.0 / 12.0_f64).sqrt()).abs(),
            3.0 / 200.0_f64.sqrt(),
            RandomSample
        ));
    }

    #[test]
    fn random_samples_have_their_moments_and_begin_with_those_of_fewer() {
        let all = samples(&OF, 4000, Sampling::Random, 1);
        assert_eq!(all[..50], samples(&OF, 50, Sampling::Random, 1));
        let first: Vec<f64> = all.iter().map(|sample| sample[0]).collect();
        let alone: Vec<f64> =
            samples(&OF[..1], 4000, Sampling::Random, 1).iter().map(|sample| sample[0]).collect();
        assert_eq!(first, alone);
        let mean = all.iter().map(|sample| sample[1]).sum::<f64>() / 4000.0;
        let variance = all.iter().map(|sample| (sample[1] - mean).powi(2)).sum::<f64>() / 4000.0;
        assert!(
            within((mean - 2.0).abs(), 0.05, RandomSample)
                && within((variance - 1.0).abs(), 0.07, RandomSample),
            "{mean}, {variance}"
        );
    }
}
