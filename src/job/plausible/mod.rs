//! Numbers of a case that can be computed with but are hardly meant: a unit that was forgotten, a plate that is a block, a mesh
//! that is too coarse for the frequency. `stridor check` and every run warn of them.
//!
//! Each warning gives what was found, what is expected and what to do.

mod material;
mod resolution;
mod size;
mod theory;
mod thickness;

use super::prepared::Prepared;
use crate::error::Fault;

/// The warnings of a case, in the order of the lines of its file where they are of one of its keys.
pub fn warnings(prepared: &Prepared) -> Vec<Fault> {
    let mut all =
        [material::warnings(prepared.case), size::warnings(prepared), thickness::warnings(&prepared.model)]
            .concat();
    // Waves of a wrong material or size say nothing of the mesh.
    if all.is_empty() {
        all = [theory::warnings(prepared), resolution::warnings(prepared)].concat();
    }
    prepared.case.places.located(all)
}

/// The highest frequency \[Hz\] that the analyses of the case ask of a part; zero where none has a band.
fn highest_frequency(prepared: &Prepared, part: &str) -> f64 {
    let case = prepared.case;
    let of_part = |parts: &[String]| parts.is_empty() || parts.iter().any(|name| name == part);
    let modes = case.modes.values().filter(|modes| of_part(&modes.parts)).filter_map(|modes| modes.below);
    let complex = case.cea.iter().map(|cea| cea.band[1]).filter(|top| top.is_finite());
    let responses = case.frf.values().map(|frf| frf.band[1]);
    modes.chain(complex).chain(responses).fold(0.0, f64::max)
}
