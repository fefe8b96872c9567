//! Masses, springs, rigid bodies, averages, ties, supports and forces.

use super::Maker;
use crate::case::ForceChoice;
use crate::decks::{
    Coupling, CouplingKind, Equation, Frame, Load, LoadOn, Place, PointMass, Spring, Support, Tie, Weight,
};
use crate::error::{Faults, Result};
use crate::job::couplings::largest_tied_gap;
use crate::mesh::quality::{dot, minus, norm};
use crate::structure::{self, Constraint};
use std::collections::BTreeMap;

/// Springs that differ in their ends alone: degree of freedom, k and c.
type Alike = (Option<u8>, u64, u64);

/// Sine of the least angle between two directions.
const PARALLEL: f64 = 1e-9;

impl Maker<'_> {
    pub(super) fn masses(&mut self) -> Result<()> {
        for (name, mass) in &self.case.mass {
            let nodes = self.prepared.regions.nodes(&mass.on, &format!("`mass.{name}.on`"))?;
            let (name, place) = (name.clone(), Place::default());
            self.deck.masses.push(PointMass { name, nodes, mass: mass.mass, inertia: mass.inertia, place });
        }
        Ok(())
    }

    /// Springs along an axis of the coordinates, or along the line between their ends; those that are alike together.
    pub(super) fn springs(&mut self) {
        let mut alike: BTreeMap<Alike, Vec<(usize, Option<usize>)>> = BTreeMap::new();
        for spring in &self.model.springs {
            let length = norm(spring.direction);
            let unit = spring.direction.map(|x| x / length);
            let axis = (0..3).find(|k| (unit[*k].abs() - 1.0).abs() < PARALLEL);
            let dof = match (axis, spring.other) {
                (Some(axis), _) => Some(axis as u8 + if spring.rotational { 3 } else { 0 }),
                (None, Some(other)) if !spring.rotational && self.is_along(unit, spring.node, other) => None,
                _ => {
                    let why =
                        "springs in a direction that is no axis, nor the line of their ends, are not written";
                    self.note(Weight::Matters, "springs", why);
                    continue;
                }
            };
            let key = (dof, spring.stiffness.to_bits(), spring.damping.to_bits());
            alike.entry(key).or_default().push((spring.node, spring.other));
        }
        for (k, ((dof, stiffness, damping), ends)) in alike.into_iter().enumerate() {
            let (stiffness, damping) = (f64::from_bits(stiffness), f64::from_bits(damping));
            let (name, place) = (format!("spring_{}", k + 1), Place::default());
            self.deck.springs.push(Spring { name, ends, dof, stiffness, damping, place });
        }
    }

    fn is_along(&self, unit: [f64; 3], a: usize, b: usize) -> bool {
        let line = minus(self.model.nodes[b], self.model.nodes[a]);
        let length = norm(line);
        length > 0.0 && dot(unit, line).abs() > (1.0 - PARALLEL) * length
    }

    /// Rigid bodies, averages and equations; constraints of springs between faces.
    pub(super) fn links(&mut self) -> Result<()> {
        let (case, regions, place) = (self.case, &self.prepared.regions, Place::default());
        for (name, rigid) in &case.rigid {
            let mut faults = Faults::new();
            let reference = regions.node(&rigid.master, &format!("`rigid.{name}.master`"))?;
            let mut nodes = regions.nodes_of(&rigid.follow, &format!("`rigid.{name}.follow`"), &mut faults);
            nodes.retain(|node| *node != reference);
            let (name, of, kind) = (name.clone(), None, CouplingKind::Rigid);
            self.deck.couplings.push(Coupling { name, reference, nodes, of, kind, place });
        }
        for (name, link) in &case.averaging {
            let mut faults = Faults::new();
            let reference = regions.node(&link.point, &format!("`averaging.{name}.point`"))?;
            let nodes = regions.nodes_of(&link.of, &format!("`averaging.{name}.of`"), &mut faults);
            let of = match &link.of[..] {
                [one] if regions.region(one, "")?.dimension == 2 => Some(self.surface_of(one)),
                _ => None,
            };
            let (name, kind) = (name.clone(), CouplingKind::Averaging);
            self.deck.couplings.push(Coupling { name, reference, nodes, of, kind, place });
        }
        // The far ends of springs between faces follow others, too.
        let written = |coupling: &&structure::Coupling| {
            ["`spring.", "`equation."].iter().any(|table| coupling.name.starts_with(table))
        };
        let equations = self.model.couplings.iter().filter(written);
        for Constraint { slave, terms } in equations.flat_map(|coupling| &coupling.constraints) {
            let others = terms.iter().map(|(node, dof, factor)| (*node, *dof as u8, -factor));
            let terms = std::iter::once((slave.0, slave.1 as u8, 1.0)).chain(others).collect();
            self.deck.equations.push(Equation { terms, place });
        }
        Ok(())
    }

    pub(super) fn ties(&mut self) -> Result<()> {
        for (name, tie) in &self.case.tie {
            let within = largest_tied_gap(name, tie, &self.prepared.regions, self.model)?;
            let (slave, master) = (self.surface_of(&tie.on), self.surface_of(&tie.to));
            let (name, within, place) = (name.clone(), Some(within), Place::default());
            self.deck.ties.push(Tie { name, slave, master, within, place });
        }
        Ok(())
    }

    /// Nodes of solids have no rotations to be held.
    pub(super) fn supports(&mut self) -> Result<()> {
        let (case, place) = (self.case, Place::default());
        let turning = self.turned();
        for (name, support) in &case.support {
            let mut faults = Faults::new();
            let at = format!("`support.{name}.on`");
            let nodes = self.prepared.regions.nodes_of(&support.on, &at, &mut faults);
            let title = name;
            let name = match &support.on[..] {
                [one] => self.set_of(one, &nodes),
                _ => self.set_of(name, &nodes),
            };
            let mut held = support.holds();
            if !nodes.iter().any(|node| turning.contains(node))
                && !self.deck.couplings.iter().any(|c| nodes.contains(&c.reference))
            {
                held[3..].fill(false);
            }
            let mut add = |held: [bool; 6], frame| {
                if held.contains(&true) {
                    let (title, name, nodes) = (title.clone(), name.clone(), nodes.clone());
                    self.deck.supports.push(Support { title, name, nodes, held, frame, place });
                }
            };
            add(held, Frame::Global);
            if let Some(axis) = &support.axis {
                let [r, t, a] = support.holds_about_axis();
                add([r, t, a, false, false, false], Frame::Cylindrical([axis.through, axis.along]));
            }
        }
        Ok(())
    }

    pub(super) fn forces(&mut self) -> Result<()> {
        for (name, force) in &self.case.force {
            let on = match force.load {
                ForceChoice::Total { force: total } => {
                    let nodes = self.prepared.regions.nodes(&force.on, &format!("`force.{name}.on`"))?;
                    let share = total.map(|f| f / nodes.len().max(1) as f64);
                    self.set_of(&force.on, &nodes);
                    LoadOn::Nodes { nodes, force: share }
                }
                ForceChoice::Pressure { pressure } => {
                    let surface = self.surface_of(&force.on);
                    let surface = self.deck.surface(&surface).cloned().unwrap_or_default();
                    if surface.shells.is_empty() {
                        LoadOn::Faces { faces: surface.faces, pressure }
                    } else {
                        // A case presses against the normal.
                        let shells = surface.shells.into_iter().map(|(shell, _)| shell).collect();
                        LoadOn::Shells { shells, pressure: -pressure }
                    }
                }
            };
            self.deck.loads.push(Load { name: force.on.clone(), on, place: Place::default() });
        }
        Ok(())
    }
}
