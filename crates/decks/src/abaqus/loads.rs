//! *CLOAD, *DLOAD, *DSLOAD, *MOTION.

use super::blocks;
use super::reader::{Found, Reader, Row};
use super::space::Item;
use crate::deck::{Load, LoadOn, Motion, Place, ShellFace};
use crate::ledger::Weight;

const GLOBAL: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

impl Reader {
    /// *CLOAD: nodes, degree of freedom, force.
    pub fn concentrated(&mut self, space: usize, found: Found<'_>) {
        for row in found.rows() {
            let Some(nodes) = self.nodes_of(space, row.cell(0), row.place) else { continue };
            let Some(size) = self.number(&row, 2) else { continue };
            let Ok(dof) = row.cell(1).trim_end_matches('.').parse::<usize>() else {
                let words = format!("`{}`", blocks::short(row.cell(1)));
                self.files.fault(row.place, words, "a degree of freedom");
                continue;
            };
            if size == 0.0 {
                continue;
            }
            if !(1..=3).contains(&dof) {
                let what = format!("*CLOAD, degree of freedom {dof}");
                let why = "a moment, or a flux, is not read";
                self.deck.ledger.note(Weight::Perhaps, what, why, row.place);
                continue;
            }
            let name = self.set_words(space, row.cell(0));
            let (turned, plain): (Vec<usize>, Vec<usize>) =
                nodes.into_iter().partition(|node| self.frame_of.contains_key(node));
            if !plain.is_empty() {
                let force = std::array::from_fn(|k| if k + 1 == dof { size } else { 0.0 });
                self.force(name.clone(), plain, force, row.place);
            }
            for node in turned {
                let axes = self.directions_at(node).unwrap_or(GLOBAL);
                self.force(name.clone(), vec![node], axes[dof - 1].map(|x| size * x), row.place);
            }
        }
    }

    /// Counts the steps with loads.
    fn loaded(&mut self) {
        let Some(step) = &mut self.step else { return };
        self.steps_with_loads += usize::from(!std::mem::replace(&mut step.loaded, true));
    }

    /// Adds a force; on the same nodes as the last one of the step it is a component of the same.
    fn force(&mut self, name: String, nodes: Vec<usize>, force: [f64; 3], place: Place) {
        let of_step = self.step.is_none() || self.step.as_ref().is_some_and(|step| step.loaded);
        self.loaded();
        if let Some(Load { on: LoadOn::Nodes { nodes: last, force: total }, .. }) = self.deck.loads.last_mut()
            && of_step
            && *last == nodes
        {
            total.iter_mut().zip(force).for_each(|(total, more)| *total += more);
            return;
        }
        self.deck.loads.push(Load { name, on: LoadOn::Nodes { nodes, force }, place });
    }

    /// *DLOAD: elements, P1 … P6 and a pressure, of shells P (to CalculiX P1 and P2 are the same), which acts along their normals; CENTRIF and
    /// ω², a point, an axis; GRAV.
    pub fn distributed(&mut self, space: usize, found: Found<'_>) {
        for row in found.rows() {
            let label = row.cell(1).to_uppercase();
            match label.as_str() {
                "CENTRIF" => self.centrifugal(space, &row),
                _ if label == "P" || label.starts_with('P') && label[1..].parse::<u8>().is_ok() => {
                    let Some(items) = self.items_of(space, row.cell(0), row.place) else { continue };
                    let Some(pressure) = self.number(&row, 2) else { continue };
                    let shape = |item: &Item, dimension: usize| match item {
                        Item::Shape(k) => {
                            Some(*k).filter(|k| self.deck.elements[*k].kind.dimension() == dimension)
                        }
                        _ => None,
                    };
                    let shells: Vec<usize> = match label.as_str() {
                        "P" | "P1" | "P2" => items.iter().filter_map(|item| shape(item, 2)).collect(),
                        _ => Vec::new(),
                    };
                    let side = |item: &Item| {
                        let index = shape(item, 3)?;
                        Some((index, self.side_of(index, &label)?))
                    };
                    let faces: Vec<_> = items.iter().filter_map(side).collect();
                    if faces.len() + shells.len() < items.len() {
                        let why = "a pressure on elements that have no such face is not read";
                        self.deck.ledger.note(Weight::Matters, format!("*DLOAD, {label}"), why, row.place);
                    }
                    self.pressure(row.cell(0), LoadOn::Faces { faces, pressure }, row.place);
                    self.pressure(row.cell(0), LoadOn::Shells { shells, pressure }, row.place);
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
            let Some(surface) = self.surface_called(space, row.cell(0)) else { continue };
            let faces = surface.faces.clone();
            let of =
                |face| surface.shells.iter().filter(move |(_, own)| *own == face).map(|(index, _)| *index);
            // It presses upon the face: that which the normal points out of along its opposite.
            let shells = [(ShellFace::Positive, -pressure), (ShellFace::Negative, pressure)]
                .map(|(face, pressure)| (of(face).collect::<Vec<usize>>(), pressure));
            let all = faces.len() + shells.iter().map(|(shells, _)| shells.len()).sum::<usize>();
            if !self.may_name(all, row.place) {
                return;
            }
            if all == 0 {
                let why = "a pressure on a surface without sides of solids or shells is not read";
                self.deck.ledger.note(Weight::Matters, "*DSLOAD", why, row.place);
            }
            self.pressure(row.cell(0), LoadOn::Faces { faces, pressure }, row.place);
            for (shells, pressure) in shells {
                self.pressure(row.cell(0), LoadOn::Shells { shells, pressure }, row.place);
            }
        }
    }

    /// Adds a pressure, but none on nothing and none of zero. Single elements in ascending order that have the same pressure in a step are one
    /// load.
    fn pressure(&mut self, name: &str, on: LoadOn, place: Place) {
        let (count, pressure) = match &on {
            LoadOn::Faces { faces, pressure } => (faces.len(), *pressure),
            LoadOn::Shells { shells, pressure } => (shells.len(), *pressure),
            LoadOn::Nodes { .. } => return,
        };
        if count == 0 || pressure == 0.0 {
            return;
        }
        let of_step = self.step.is_none() || self.step.as_ref().is_some_and(|step| step.loaded);
        self.loaded();
        let single = |name: &str| name.parse::<u64>().is_ok();
        let last = self.deck.loads.last_mut().filter(|last| of_step && single(&last.name) && single(name));
        match (last.map(|last| &mut last.on), &on) {
            (Some(LoadOn::Faces { faces: known, pressure: p }), LoadOn::Faces { faces, .. })
                if *p == pressure && known.last() < faces.first() =>
            {
                known.extend(faces);
            }
            (Some(LoadOn::Shells { shells: known, pressure: p }), LoadOn::Shells { shells, .. })
                if *p == pressure && known.last() < shells.first() =>
            {
                known.extend(shells);
            }
            _ => self.deck.loads.push(Load { name: blocks::unquoted(name).to_string(), on, place }),
        }
    }

    /// ω², a point on the axis, its direction: the speed at which a part turns.
    fn centrifugal(&mut self, space: usize, row: &Row<'_>) {
        let Some([square, px, py, pz, ax, ay, az]) = self.numbers::<7>(row, 2) else { return };
        let length = ax.hypot(ay).hypot(az);
        if square < 0.0 || length == 0.0 || !length.is_finite() {
            self.files.fault(
                row.place,
                format!("CENTRIF with ω² = {square}"),
                "ω² of zero or more, a point and an axis",
            );
            return;
        }
        if row.cell(0).is_empty() {
            let why = "a rotation of the whole model is not read: name what turns";
            self.deck.ledger.note(Weight::Matters, "*DLOAD, CENTRIF", why, row.place);
            return;
        }
        if self.items_of(space, row.cell(0), row.place).is_none() {
            return;
        }
        let own = self.spaces[space].element_sets.get(row.cell(0)).map(|set| set.name.clone());
        let set = own.unwrap_or_else(|| blocks::unquoted(row.cell(0)).to_string());
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
        if found.option("TYPE").is_some_and(|of| of.eq_ignore_ascii_case("DISPLACEMENT")) {
            let why = "an angle of rotation is no speed";
            self.deck.ledger.note(Weight::Matters, "*MOTION, TYPE=DISPLACEMENT", why, found.place());
            return;
        }
        let by_nodes = found.option("DEFINITION").is_some_and(|of| of.eq_ignore_ascii_case("NODES"));
        for row in found.rows() {
            let Some(speed) = self.number(&row, 1) else { continue };
            let points = if by_nodes {
                let mut at = |k: usize| {
                    let node = self.node_of(space, row.cell(k), row.place)?;
                    Some(self.deck.nodes[node].position)
                };
                at(2).zip(at(3))
            } else {
                self.numbers::<3>(&row, 2).zip(self.numbers::<3>(&row, 5))
            };
            let Some(([ax, ay, az], [bx, by, bz])) = points else { continue };
            if self.nodes_of(space, row.cell(0), row.place).is_none() {
                continue;
            }
            let axis = [bx - ax, by - ay, bz - az];
            let length = axis[0].hypot(axis[1]).hypot(axis[2]);
            if length == 0.0 || !length.is_finite() {
                self.files.fault(row.place, "two points of an axis that are one", "two points");
                continue;
            }
            let set = self.set_words(space, row.cell(0));
            self.motion_of(Motion { set, point: [ax, ay, az], axis, speed, place: row.place });
        }
    }

    /// The same rotation of another step is one.
    fn motion_of(&mut self, motion: Motion) {
        let next = self.deck.motions.len();
        let at = *self.motions.entry(&motion.set, || next);
        match self.deck.motions.get_mut(at) {
            Some(known) => *known = motion,
            None => self.deck.motions.push(motion),
        }
    }
}
