//! What each part has of the energies and of the damping of modes, and which mode of the part alone it moves in.

use crate::dataset::{Column, Table, column};

/// The name of the share of what is in no part.
pub const POINTS: &str = "masses and springs";
/// The name of the share of damping ratios that the case gives by mode.
pub const MODAL: &str = "modal damping";

/// A mode is named by a mode of a part alone where the share of the kinetic energy times the MAC is this large.
const LEAST: f64 = 0.1;

/// The shares of all parts in some modes.
#[derive(Debug, Clone, Default)]
pub struct PartShares {
    /// The parts that have a share, [`POINTS`] and [`MODAL`] behind them.
    pub parts: Vec<String>,
    /// The shares of each mode, in the order of the parts.
    pub modes: Vec<Vec<PartShare>>,
}

/// The share of one part in one mode; those of all parts add up to 1.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PartShare {
    /// φᴴM_pφ/φᴴMφ.
    pub kinetic: Option<f64>,
    /// φᴴK_pφ/φᴴKφ of the structure, without the springs of contacts and the stiffness of a preload; none of a rigid-body mode.
    pub strain: Option<f64>,
    /// φᴴ(ωC_p + H_p)φ/φᴴ(ωC + H)φ: what the part dissipates of what the structure does in a period; none where nothing damps.
    pub damping: Option<f64>,
    /// The mode of the part alone that its motion is most like.
    pub alone: Option<PartMode>,
}

/// A mode, or a level of several, of a part alone.
#[derive(Debug, Clone, PartialEq)]
pub struct PartMode {
    /// `disc (2, 0)`, `pad 2345 Hz`.
    pub name: String,
    /// MAC of the translations at the nodes of the part, with the space that the level spans.
    pub mac: f64,
}

/// Number of the mode, part, and its share.
type ShareRow<'a> = (usize, &'a str, &'a PartShare);

fn columns<'a>() -> Vec<Column<ShareRow<'a>>> {
    vec![
        column("mode", "1", "number of the mode, from 1", |(mode, ..): &ShareRow| *mode as i64),
        column("part", "text", "the part", |(_, part, _): &ShareRow| (*part).to_string()),
        column("kinetic_energy_share", "1", "φᴴM_pφ/φᴴMφ", |(.., share): &ShareRow| share.kinetic),
        column(
            "strain_energy_share",
            "1",
            "φᴴK_pφ/φᴴKφ of the structure, without contacts and preload",
            |(.., share): &ShareRow| share.strain,
        ),
        column(
            "damping_share",
            "1",
            "φᴴ(ωC_p + H_p)φ/φᴴ(ωC + H)φ of the structure: of the energy dissipated in a period",
            |(.., share): &ShareRow| share.damping,
        ),
        column("part_mode", "text", "the most similar mode of the part alone", |(.., share): &ShareRow| {
            share.alone.as_ref().map(|alone| alone.name.clone())
        }),
        column("part_mode_mac", "1", "MAC with it at the nodes of the part", |(.., share): &ShareRow| {
            share.alone.as_ref().map(|alone| alone.mac)
        }),
    ]
}

impl PartShares {
    /// One row a mode and part.
    pub(super) fn table(&self, key: &str, file: String) -> Table<'static> {
        let rows: Vec<ShareRow> = self
            .modes
            .iter()
            .enumerate()
            .flat_map(|(k, shares)| self.parts.iter().zip(shares).map(move |(p, s)| (k + 1, p.as_str(), s)))
            .collect();
        Table::of(key.to_string(), "share", &columns(), &rows).file(file)
    }

    /// The mode of a part alone that mode `k` is named by: of the part with the largest product of kinetic energy and MAC, a tenth at
    /// least.
    pub fn part_mode(&self, k: usize) -> Option<&PartMode> {
        let shares = self.modes.get(k)?.iter().filter_map(|share| {
            let alone = share.alone.as_ref()?;
            Some((alone, share.kinetic? * alone.mac)).filter(|(_, weight)| *weight >= LEAST)
        });
        shares.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(alone, _)| alone)
    }

    /// The part with the largest share of the kinetic energy of mode `k`.
    pub fn moving_part(&self, k: usize) -> Option<&str> {
        let parts = self.parts.iter().zip(self.modes.get(k)?).filter(|(part, _)| *part != POINTS);
        let kinetic = parts.filter_map(|(part, share)| Some((part, share.kinetic?)));
        kinetic.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(part, _)| part.as_str())
    }

    /// The kinetic share of a part in mode `k`; zero of one that is none.
    pub fn kinetic(&self, k: usize, part: &str) -> f64 {
        let place = self.parts.iter().position(|own| own == part);
        place.and_then(|p| self.modes.get(k)?[p].kinetic).unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mode_is_named_by_the_part_that_moves_and_is_alike() {
        let share = |kinetic: f64, name: &str, mac: f64| PartShare {
            kinetic: Some(kinetic),
            alone: (!name.is_empty()).then(|| PartMode { name: name.into(), mac }),
            ..PartShare::default()
        };
        let shares = PartShares {
            parts: ["disc", "pad", "plate", POINTS].map(String::from).to_vec(),
            modes: vec![vec![
                share(0.5, "disc (2, 0)", 0.9),
                share(0.1, "pad 900 Hz", 0.99),
                share(0.15, "", 0.0),
                share(0.25, "", 0.0),
            ]],
        };
        assert_eq!(shares.part_mode(0).unwrap().name, "disc (2, 0)");
        assert_eq!((shares.moving_part(0), shares.kinetic(0, "pad")), (Some("disc"), 0.1));
        let still = PartShares { modes: vec![vec![share(0.1, "disc (2, 0)", 0.9)]], ..shares.clone() };
        assert!(still.part_mode(0).is_none());
        assert!(shares.part_mode(1).is_none() && shares.moving_part(1).is_none());
        let table = shares.table("part_shares", "complex_modes_parts".into());
        assert_eq!(table.rows.length, 4);
        assert!(table.to_csv().contains("1,pad,0.1,,,pad 900 Hz,0.99"), "{}", table.to_csv());
    }
}
