//! *CLOAD, *DLOAD, *DSLOAD, *MOTION.

use super::space::Item;
use super::surfaces::side_of;
use super::{Found, Reader, Row};
use crate::deck::{Frame, Load, LoadOn, Motion, Place};
use crate::ledger::Weight;

impl Reader {
    /// *CLOAD: nodes, degree of freedom, force.
    pub fn concentrated(&mut self, space: usize, found: Found<'_>) {
        for row in found.rows() {
            let Some(nodes) = self.nodes_of(space, row.cell(0), row.place) else { continue };
            let Some(size) = self.number(&row, 2) else { continue };
            let dof = row.cell(1).trim_end_matches('.').parse::<usize>().unwrap_or(0);
            if size == 0.0 {
                continue;
            }
            if !(1..=3).contains(&dof) {
                let why = "a moment, or a flux, is not read";
                self.deck.ledger.note(
                    Weight::Perhaps,
                    format!("*CLOAD, degree of freedom {dof}"),
                    why,
                    row.place,
                );
                continue;
            }
            for node in &nodes {
                match self.frames.get(node) {
                    None | Some(Frame::Global) => {}
                    Some(_) => {
                        let why = "a force in the frame of a *TRANSFORM is read in that of the coordinates";
                        self.deck.ledger.note(Weight::Perhaps, "*CLOAD", why, row.place);
                        break;
                    }
                }
            }
            let mut force = [0.0; 3];
            force[dof - 1] = size;
            let name = self.set_words(space, row.cell(0));
            self.force(name, nodes, force, row.place);
        }
    }

    /// Adds a force; on the same nodes as the last one it is a component of the same.
    fn force(&mut self, name: String, nodes: Vec<usize>, force: [f64; 3], place: Place) {
        if let Some(Load { on: LoadOn::Nodes { nodes: last, force: total }, .. }) = self.deck.loads.last_mut()
            && *last == nodes
        {
            total.iter_mut().zip(force).for_each(|(total, more)| *total += more);
            return;
        }
        self.deck.loads.push(Load { name, on: LoadOn::Nodes { nodes, force }, place });
    }

    /// *DLOAD: elements, P1 … P6 and a pressure; CENTRIF and ω², a point, an axis; GRAV.
    pub fn distributed(&mut self, space: usize, found: Found<'_>) {
        for row in found.rows() {
            let label = row.cell(1).to_uppercase();
            match label.as_str() {
                "CENTRIF" => self.centrifugal(space, &row),
                _ if label.starts_with('P') && label[1..].parse::<u8>().is_ok() => {
                    let Some(items) = self.items_of(space, row.cell(0), row.place) else { continue };
                    let Some(pressure) = self.number(&row, 2) else { continue };
                    let side = |item: &Item| {
                        let Item::Shape(index) = item else { return None };
                        Some((*index, side_of(&self.deck.elements[*index], &label)?))
                    };
                    let faces: Vec<_> = items.iter().filter_map(side).collect();
                    self.pressure(row.cell(0), faces, pressure, row.place);
                }
                _ => {
                    let weight = if label == "GRAV" { Weight::Perhaps } else { Weight::Matters };
                    self.deck.ledger.note(
                        weight,
                        format!("*DLOAD, {label}"),
                        "a load of this kind is not read",
                        row.place,
                    );
                }
            }
        }
    }

    /// *DSLOAD: surface, P, pressure.
    pub fn surface_load(&mut self, space: usize, found: Found<'_>) {
        for row in found.rows() {
            let label = row.cell(1).to_uppercase();
            if label != "P" {
                let why = "a load of this kind is not read";
                self.deck.ledger.note(Weight::Matters, format!("*DSLOAD, {label}"), why, row.place);
                continue;
            }
            let Some(pressure) = self.number(&row, 2) else { continue };
            if self.surface_of(space, row.cell(0), row.place).is_none() {
                continue;
            }
            let faces = self.surface_called(space, row.cell(0)).map(|s| s.faces.clone()).unwrap_or_default();
            self.pressure(row.cell(0), faces, pressure, row.place);
        }
    }

    fn pressure(&mut self, name: &str, faces: Vec<(usize, usize)>, pressure: f64, place: Place) {
        if faces.is_empty() {
            let why = "a pressure on shells or beams is not read";
            self.deck.ledger.note(Weight::Matters, "*DLOAD", why, place);
        } else if pressure != 0.0 {
            let name = super::blocks::unquoted(name).to_string();
            self.deck.loads.push(Load { name, on: LoadOn::Faces { faces, pressure }, place });
        }
    }

    /// ω², a point on the axis, its direction: the speed at which a part turns.
    fn centrifugal(&mut self, space: usize, row: &Row<'_>) {
        let Some([square, px, py, pz, ax, ay, az]) = self.numbers::<7>(row, 2) else { return };
        if square < 0.0 || [ax, ay, az] == [0.0; 3] {
            self.files.fault(
                row.place,
                format!("CENTRIF with ω² = {square}"),
                "ω² of zero or more, a point and an axis",
            );
            return;
        }
        if self.items_of(space, row.cell(0), row.place).is_none() {
            return;
        }
        let set = super::blocks::unquoted(row.cell(0)).to_string();
        self.motion_of(Motion {
            set,
            point: [px, py, pz],
            axis: [ax, ay, az],
            speed: square.sqrt(),
            place: row.place,
        });
    }

    /// *MOTION, ROTATION: set, angular velocity, two points of the axis.
    pub fn motion(&mut self, space: usize, found: Found<'_>) {
        if !found.block.has("ROTATION") {
            let why = "a motion that is no rotation is not read";
            self.deck.ledger.note(Weight::Matters, "*MOTION", why, found.place());
            return;
        }
        for row in found.rows() {
            let Some([speed, ax, ay, az, bx, by, bz]) = self.numbers::<7>(&row, 1) else { continue };
            if self.nodes_of(space, row.cell(0), row.place).is_none() {
                continue;
            }
            let axis = [bx - ax, by - ay, bz - az];
            if axis == [0.0; 3] {
                self.files.fault(row.place, "two points of an axis that are one", "two points");
                continue;
            }
            let set = self.set_words(space, row.cell(0));
            self.motion_of(Motion { set, point: [ax, ay, az], axis, speed, place: row.place });
        }
    }

    /// The same rotation of another step is one.
    fn motion_of(&mut self, motion: Motion) {
        match self.deck.motions.iter_mut().find(|known| known.set.eq_ignore_ascii_case(&motion.set)) {
            Some(known) => *known = motion,
            None => self.deck.motions.push(motion),
        }
    }
}
