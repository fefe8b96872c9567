//! How deep contacts are pressed in motion.

use crate::job::prepared::Prepared;
use crate::job::steady_warnings::SMALL_PENETRATION;
use crate::transient::{Checkpoint, Marched, TransientModel};

/// The deepest penetrations of a run.
pub(super) struct Depths {
    /// The name of every pair, the first of its points and their number, and max δ so far \[m\].
    pairs: Vec<(String, std::ops::Range<usize>, f64)>,
    /// The shortest side of any body \[m\].
    thinnest: f64,
}

impl Depths {
    pub(super) fn new(prepared: &Prepared<'_>) -> Self {
        let mut first = 0;
        let pairs = prepared.system.pairs.iter().map(|pair| {
            let points = first..first + pair.points.len();
            first = points.end;
            (pair.name.clone(), points, 0.0)
        });
        Depths { pairs: pairs.collect(), thinnest: prepared.thinnest() }
    }

    /// Looks at the end of a step.
    pub(super) fn take(&mut self, model: &TransientModel<'_>, marched: &Marched) {
        for (_, points, deepest) in &mut self.pairs {
            let depths = points.clone().map(|point| marched.state.penetration(model, point));
            *deepest = depths.fold(*deepest, f64::max);
        }
    }

    /// Adds what the warnings depend on.
    pub(super) fn put(&self, checkpoint: &mut Checkpoint) {
        let deepest: Vec<f64> = self.pairs.iter().map(|(.., deepest)| *deepest).collect();
        checkpoint.put("depths", &deepest);
    }

    /// Goes on from what was put away.
    pub(super) fn restore(&mut self, checkpoint: &Checkpoint) -> crate::error::Result<()> {
        let mut deepest = vec![0.0; self.pairs.len()];
        checkpoint.get("depths", &mut deepest)?;
        self.pairs.iter_mut().zip(deepest).for_each(|((.., own), deepest)| *own = deepest);
        Ok(())
    }

    /// Contacts that are pressed deeper than the model can mean.
    pub(super) fn warnings(&self) -> Vec<String> {
        let deep = self.pairs.iter().filter(|(.., deepest)| *deepest > SMALL_PENETRATION * self.thinnest);
        let words = |(name, _, deepest): &(String, _, f64)| {
            format!(
                "In motion the contact {name} is pressed {:.3} mm deep, {:.2} of the thinnest part, {:.3} mm: the faces are where they are \
                 without deformation, which holds up to about {SMALL_PENETRATION}. Amplitudes of this run have no meaning, only its beginning has; or \
                 the contact is too soft.",
                1e3 * deepest,
                deepest / self.thinnest,
                1e3 * self.thinnest
            )
        };
        deep.map(words).collect()
    }
}
