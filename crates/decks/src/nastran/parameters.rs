//! Parameters: PARAM.

use super::fields::{Fields, real};
use crate::ledger::Weight;

#[derive(Debug, Default)]
pub(super) struct Parameters {
    mass_factor: Option<f64>,
    loss_factor: f64,
    rayleigh: [f64; 2],
}

/// Parameters of output and of how equations are solved.
const NOTHING: &[&str] = &[
    "POST", "AUTOSPC", "PRGPST", "GRDPNT", "PRTMAXIM", "BAILOUT", "MAXRATIO", "TINY", "OIBULK", "OMACHPR",
    "NOCOMPS", "PRTRESLT", "UNITSYS", "ECHO", "NEWSEQ", "POSTEXT", "DBEXT", "OUGCORD", "SNORM", "CHECKOUT",
    "EXTOUT", "PRTMGG", "PRTEQXIN", "USETPRT", "GEOMU", "PATVER", "OGEOM", "OMODES", "SEP1XOVR", "OSWPPT",
    "CURV", "RMXPANEL", "XYUNIT", "ALTRED", "EPZERO", "ERROR",
];

impl Parameters {
    pub fn card(&mut self, fields: &mut Fields) -> Option<()> {
        let name = fields.word(1);
        match name {
            "WTMASS" => self.mass_factor = Some(fields.real(2)?),
            "G" => {
                self.loss_factor = fields.real(2)?;
                fields.note(
                    Weight::Perhaps,
                    "the damping G of the whole model is a loss factor of its materials, not of its springs",
                );
            }
            "ALPHA1" | "ALPHA2" => self.rayleigh[usize::from(name == "ALPHA2")] = fields.real(2)?,
            "COUPMASS" => {
                fields.word(2);
                fields.note(Weight::Nothing, "masses of elements are consistent here, COUPMASS or not");
            }
            "" => {
                fields.fault(1, "PARAM without a name", "PARAM, name, value");
                return None;
            }
            _ => {
                let last = fields.last();
                let value = fields.words(2, last).first().map_or("", |(_, text)| text);
                let off = ["NO", "NONE"].contains(&value) || real(value) == Some(0.0);
                let weight = if NOTHING.contains(&name) || off { Weight::Nothing } else { Weight::Perhaps };
                let place = fields.place();
                fields.notes.ledger.note(weight, format!("PARAM {name}"), "not read", place);
            }
        }
        Some(())
    }

    /// What densities and masses are multiplied with: WTMASS.
    pub fn mass_factor(&self) -> f64 {
        self.mass_factor.unwrap_or(1.0)
    }

    /// G of K (1 + i G).
    pub fn loss_factor(&self) -> f64 {
        self.loss_factor
    }

    /// α and β of α M + β K: ALPHA1 and ALPHA2.
    pub fn rayleigh(&self) -> [f64; 2] {
        self.rayleigh
    }
}
