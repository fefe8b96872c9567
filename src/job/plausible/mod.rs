//! Numbers of a case that can be computed with but are implausible: a unit that was forgotten, a plate that is a block, a mesh
//! that is too coarse for the frequency. `stridor check` and every run warn of them.
//!
//! Each warning gives what was found, what is expected and what to do.

mod contact;
mod frequency;
mod integration;
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
    // A wrong material or size says nothing of contact and mesh.
    if all.is_empty() {
        all = [contact::warnings(prepared), theory::warnings(prepared), resolution::warnings(prepared)]
            .concat();
    }
    all.extend(integration::warnings(&prepared.model));
    prepared.case.places.located(all)
}
