//! The motion of all nodes over the last periods of a run in time, as plain data.

use super::explored::window;
use crate::dataset::{Dimension, Group, Values, Variable};
use crate::linalg::c64;

/// Displacement of every node about its mean over the last periods of a run, u(t) = Re Σ_h U_h e^{2πi h f₀ t}, h = 1, 2 …, t the
/// time of the run. U_h = 2 Σ_j w_j u(t_j) e^{−2πi h f₀ t_j} / Σ_j w_j over the steps of at most 16 periods, w a Hann window. Motion that
/// is not periodic with f₀ is left out.
#[derive(Debug, Clone, PartialEq)]
pub struct CycleFields {
    /// f₀ \[Hz\]: the fundamental of the record up to three quarters of the run; of a short one its strongest line.
    pub frequency_hz: f64,
    /// The first and last time of the steps \[s\].
    pub window: [f64; 2],
    /// U_h \[m\] of every node, h = 1, 2 …
    pub harmonics: Vec<Vec<[c64; 3]>>,
}

impl CycleFields {
    pub(super) fn group(&self) -> Group<'_> {
        let nodes = self.harmonics.first().map_or(0, Vec::len);
        let dimensions = vec![
            Dimension::numbered("harmonic", self.harmonics.len()),
            Dimension::indexed("node", nodes),
            Dimension::axes(),
        ];
        let values = Values::ComplexRows(Box::new(|h| self.harmonics[h].iter().flatten().copied().collect()));
        let about = "U_h of u(t) = Re Σ U_h exp(2πi h f₀ t), displacement about its mean";
        Group::new("cycle", "motion of all nodes over the last periods, as a Fourier series")
            .value("frequency_hz", "Hz", "f₀", self.frequency_hz)
            .with(window(self.window, "the first and the last time of the steps"))
            .with(Variable::new("displacement", "m", about, dimensions, values))
    }
}
