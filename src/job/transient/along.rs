//! The complex mode that the motion starts along.

use super::in_time::InTime;
use crate::case::Disturbance;
use crate::error::{Error, Result};
use crate::linalg::c64;
use crate::reduction::Reduced;
use crate::stability::{ComplexMode, ModalFilter, modal_filter, near_mode};

/// Analysis named in the error when a mode is missing.
const PLACE: &str = "the disturbance of the motion in time";

/// A complex mode, and what measures its amplitude.
pub(super) struct Along {
    pub(super) mode: usize,
    pub(super) eigenvalue: c64,
    pub(super) shape: Vec<c64>,
    pub(super) filter: ModalFilter,
    /// The largest translation of its shape.
    pub(super) largest: f64,
}

impl Along {
    /// The same seen through the basis V of a reduced model: VᵀMφ, and Vᵀ of the filter.
    pub(super) fn reduced(self, reduced: &Reduced) -> Along {
        let parts = |x: &[c64], of: &dyn Fn(&[f64]) -> Vec<f64>| -> Vec<c64> {
            let re = of(&x.iter().map(|z| z.re).collect::<Vec<f64>>());
            let im = of(&x.iter().map(|z| z.im).collect::<Vec<f64>>());
            re.into_iter().zip(im).map(|(re, im)| c64::new(re, im)).collect()
        };
        let shape = parts(&self.shape, &|x| reduced.coordinates(x));
        let filter = ModalFilter {
            displacement: parts(&self.filter.displacement, &|x| reduced.dual(x)),
            velocity: parts(&self.filter.velocity, &|x| reduced.dual(x)),
        };
        Along { shape, filter, ..self }
    }
}

impl InTime<'_> {
    /// The mode that a disturbance is along.
    pub(super) fn along(&self, disturbance: &Disturbance) -> Result<Along> {
        let mode = self.mode(disturbance.mode_near)?;
        let own = &self.complex.modes.modes[mode];
        let moves = |node: &[c64; 6]| (0..3).map(|k| node[k].norm_sqr()).sum::<f64>().sqrt();
        let largest = self.complex.shape(mode).iter().map(moves).fold(f64::MIN_POSITIVE, f64::max);
        let filter = modal_filter(&self.point.system, &self.point.steady, own)?;
        Ok(Along { mode, eigenvalue: own.eigenvalue, shape: own.right.clone(), filter, largest })
    }

    /// The mode nearest to a frequency, one that grows if any near it does, or the one that grows fastest.
    fn mode(&self, near_hz: Option<f64>) -> Result<usize> {
        let modes = &self.complex.modes.modes;
        let by_growth = |a: &usize, b: &usize| modes[*a].growth_rate().total_cmp(&modes[*b].growth_rate());
        let Some(hz) = near_hz else {
            return (0..modes.len()).max_by(by_growth).ok_or_else(|| {
                let help = "Widen `cea.band`, or start without a [transient.disturbance]";
                Error::analysis(PLACE, "no complex mode in the band of [cea]", help)
            });
        };
        // Of a pair that coupled it is the one that grows that is meant.
        let found = near_mode(modes, hz, ComplexMode::unstable).or_else(|| near_mode(modes, hz, |_| true));
        found.ok_or_else(|| {
            let found = format!("no complex mode within 10 % of {hz} Hz, where `mode_near` looks for one");
            Error::analysis(
                PLACE,
                found,
                "Name a frequency near one of the modes, or none for the one that grows fastest",
            )
        })
    }
}
