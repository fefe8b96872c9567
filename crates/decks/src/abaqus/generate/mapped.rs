//! *NMAP: coordinates that are those of a local frame.

use crate::abaqus::frames::turned;
use crate::abaqus::mesh::cartesian;
use crate::abaqus::reader::{Found, Reader};
use crate::ledger::Weight;
use stridor_mesh::quality::minus;

impl Reader {
    /// *NMAP: points a and b; point c; factors of the coordinates. RECTANGULAR: a is the origin, b on axis 1, c in the plane of axes 1 and 2;
    /// CYLINDRICAL, SPHERICAL: b on axis 3, c where θ = 0.
    pub fn mapped_nodes(&mut self, space: usize, found: Found<'_>) {
        let kind = found.option("TYPE").unwrap_or_default().to_uppercase();
        let known = ["RECTANGULAR", "CYLINDRICAL", "SPHERICAL"].contains(&kind.as_str());
        if !known || found.option("DEFINITION").is_some_and(|by| by.eq_ignore_ascii_case("NODES")) {
            let why = "nodes are not mapped by other frames, or frames on nodes: write their places";
            self.deck.ledger.note(Weight::Matters, "*NMAP", why, found.place());
            return;
        }
        let (Some(name), Some(first)) = (found.option("NSET"), found.rows().next()) else {
            self.files.fault(
                found.place(),
                "*NMAP without a set or data",
                "*NMAP, NSET=…, and two or three points",
            );
            return;
        };
        let (second, third) = (found.rows().nth(1), found.rows().nth(2));
        let points = (self.numbers::<3>(&first, 0), self.numbers::<3>(&first, 3));
        let (Some(a), Some(b)) = points else { return };
        let c = second.as_ref().map_or(Some(a), |row| self.numbers::<3>(row, 0));
        let mut factors = [1.0; 3];
        for (k, factor) in factors.iter_mut().enumerate() {
            if let Some(row) = third.as_ref().filter(|row| !row.cell(k).is_empty()) {
                let Some(given) = self.number(row, k) else { return };
                *factor = given;
            }
        }
        let Some(c) = c else { return };
        let shift = kind == "RECTANGULAR" && second.is_none() && (3..6).all(|k| first.cell(k).is_empty());
        let axes = if shift {
            Some([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
        } else {
            turned([minus(b, a), minus(c, a)])
        };
        let Some([one, two, three]) = axes else {
            self.files.fault(found.place(), "*NMAP with points in one line", "three points of a plane");
            return;
        };
        let axes = if kind == "RECTANGULAR" { [one, two, three] } else { [two, three, one] };
        let Some(nodes) = self.nodes_so_far(space, name, found.place()) else { return };
        let placement = self.spaces[space].placement;
        for node in nodes {
            let own = self.deck.nodes[node].position;
            // In the part, where it is placed.
            let own = placement.map_or(own, |placement| placement.back(own));
            let local = cartesian(std::array::from_fn(|k| factors[k] * own[k]), Some(&kind[..1]));
            let mapped = std::array::from_fn(|i| a[i] + (0..3).map(|k| local[k] * axes[k][i]).sum::<f64>());
            let mapped = placement.map_or(mapped, |placement| placement.place(mapped));
            if !mapped.iter().all(|x| x.is_finite()) {
                self.files.fault(found.place(), format!("*NMAP to {mapped:?}"), "a place that is finite");
                return;
            }
            self.deck.nodes[node].position = mapped;
        }
    }
}
