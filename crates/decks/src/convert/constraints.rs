//! Supports, rigid bodies, ties, masses, springs and loads of the case.

use super::converter::{Converter, NodeUse};
use super::text::{numbers, quantity, quoted, strings};
use crate::deck::{CouplingKind, Frame, LoadOn, Support};
use crate::ledger::Weight;

const DISPLACEMENTS: [&str; 3] = ["ux", "uy", "uz"];
const ROTATIONS: [&str; 3] = ["rx", "ry", "rz"];
const ABOUT_AXIS: [&str; 3] = ["radial", "tangential", "axial"];

impl Converter<'_> {
    /// `[support.NAME]`: lines of single nodes that hold the same are one.
    pub fn supports(&mut self) {
        let mut joined: Vec<Support> = Vec::new();
        for support in &self.deck.supports {
            let alike = |other: &&mut Support| {
                support.name.is_none()
                    && other.name.is_none()
                    && other.title == support.title
                    && other.held == support.held
                    && other.frame == support.frame
            };
            match joined.iter_mut().find(alike) {
                Some(other) => other.nodes.extend(&support.nodes),
                None => joined.push(support.clone()),
            }
        }
        for (k, support) in joined.into_iter().enumerate() {
            self.support(k, support);
        }
    }

    fn support(&mut self, k: usize, support: Support) {
        let Support { title, name, mut nodes, held, frame, place } = support;
        nodes.sort_unstable();
        nodes.dedup();
        let mut used = self.nodes_in_use(&nodes);
        if used.is_empty() {
            return;
        }
        let rotates = used.iter().any(|node| self.uses[*node].rotates);
        let [displacements, rotations] = [[held[0], held[1], held[2]], [held[3], held[4], held[5]]];
        let rotations = if rotates { rotations } else { [false; 3] };
        let names = |of: [&'static str; 3], held: [bool; 3]| {
            of.into_iter().zip(held).filter(|(_, held)| *held).map(|(name, _)| name)
        };
        let (mut list, mut axis) = (Vec::new(), None);
        let turned: Vec<usize> = used.iter().copied().filter(|node| self.uses[*node].rotates).collect();
        match frame {
            _ if displacements == [true; 3] || displacements == [false; 3] => {
                list.extend(names(DISPLACEMENTS, displacements))
            }
            Frame::Global => list.extend(names(DISPLACEMENTS, displacements)),
            Frame::Cylindrical([point, along]) => {
                let (leading, others) = used.iter().partition(|node| self.uses[**node].follows);
                used = others;
                self.hold_by_equations(leading, held_in(displacements, [false; 3]), frame, place);
                list.extend(names(ABOUT_AXIS, displacements));
                axis = Some((point, along));
            }
            Frame::Turned(vectors) => match axes_among(vectors) {
                Some(order) => {
                    list.extend((0..3).filter(|k| displacements[*k]).map(|k| DISPLACEMENTS[order[k]]))
                }
                None => {
                    self.hold_by_equations(used.clone(), held_in(displacements, [false; 3]), frame, place)
                }
            },
        }
        match frame {
            Frame::Global => list.extend(names(ROTATIONS, rotations)),
            _ if rotations == [true; 3] => list.extend(ROTATIONS),
            _ if rotations != [false; 3] => {
                self.hold_by_equations(turned, held_in([false; 3], rotations), frame, place)
            }
            _ => {}
        }
        if list.is_empty() || used.is_empty() {
            return;
        }
        list.sort_by_key(|name| {
            DISPLACEMENTS.iter().chain(&ROTATIONS).chain(&ABOUT_AXIS).position(|other| other == name)
        });
        let wanted = name.or_else(|| self.regions.name_of_nodes(&used).map(str::to_string));
        let wanted = wanted.unwrap_or_else(|| format!("support_{}", k + 1));
        let Some(region) = self.regions.points(&wanted, &used) else { return };
        let own = if title.is_empty() { &region } else { &title };
        let table = self.case.table("support", &self.names.free("support", own));
        table.key("on", quoted(&region));
        if list.len() < 6 {
            table.key("held", strings(list));
        }
        if let Some((point, along)) = axis {
            let through = point.map(|x| x * self.units.length);
            table.key("axis", format!("{{ through = {}, along = {} }}", numbers(through), numbers(along)));
        }
    }

    /// Those of some nodes that elements of the mesh or couplings use.
    fn nodes_in_use(&self, nodes: &[usize]) -> Vec<usize> {
        nodes.iter().copied().filter(|node| self.uses[*node].moves).collect()
    }

    /// Finds what each node is used for, once the parts are there.
    pub fn find_uses(&mut self) {
        self.uses = vec![NodeUse::default(); self.deck.nodes.len()];
        for (_, element) in
            self.deck.elements.iter().enumerate().filter(|(index, _)| self.regions.has(*index))
        {
            let rotates = (1..=2).contains(&element.kind.dimension());
            for node in &element.nodes {
                self.uses[*node].moves = true;
                self.uses[*node].rotates |= rotates;
            }
        }
        for coupling in &self.deck.couplings {
            let uses = &mut self.uses[coupling.reference];
            *uses = NodeUse { moves: true, rotates: true, ..*uses };
        }
        for spring in &self.deck.springs {
            let rotates = spring.dof.is_some_and(|dof| dof > 2);
            for (node, to) in spring.ends.iter().filter_map(|(node, to)| Some((*node, (*to)?))) {
                for end in [node, to] {
                    self.uses[end].moves = true;
                    self.uses[end].rotates |= rotates;
                }
            }
        }
        self.find_uses_of_equations();
    }

    /// `[rigid.NAME]`, `[averaging.NAME]`, `[tie.NAME]`.
    pub fn joints(&mut self) {
        for (k, coupling) in self.deck.couplings.iter().enumerate() {
            let followers = self.nodes_in_use(&coupling.nodes);
            if followers.is_empty() {
                continue;
            }
            let kind = if coupling.kind == CouplingKind::Rigid { "rigid" } else { "averaging" };
            let name =
                if coupling.name.is_empty() { format!("{kind}_{}", k + 1) } else { coupling.name.clone() };
            let reference = self.regions.points(&format!("{name}_point"), &[coupling.reference]);
            let sides = coupling
                .of
                .as_ref()
                .and_then(|of| self.deck.surface(of))
                .is_some_and(|surface| surface.nodes.is_empty());
            let region = match &coupling.of {
                Some(of) if sides && coupling.kind == CouplingKind::Averaging => {
                    self.regions.surface(of, &mut self.ledger)
                }
                _ => self.regions.points(&format!("{name}_nodes"), &followers),
            };
            let (Some(reference), Some(region)) = (reference, region) else { continue };
            let table = self.case.table(kind, &self.names.free(kind, &name));
            match coupling.kind {
                CouplingKind::Rigid => {
                    table.key("master", quoted(&reference)).key("follow", strings([region]))
                }
                CouplingKind::Averaging => {
                    table.key("point", quoted(&reference)).key("of", strings([region]))
                }
            };
        }
        for (k, tie) in self.deck.ties.iter().enumerate() {
            let on = self.regions.surface(&tie.slave, &mut self.ledger);
            let to = self.regions.surface(&tie.master, &mut self.ledger);
            let (Some(on), Some(to)) = (on, to) else {
                self.ledger.note(
                    Weight::Matters,
                    "ties",
                    "a tie between surfaces that have no sides is not in the case",
                    tie.place,
                );
                continue;
            };
            let name = if tie.name.is_empty() { format!("tie_{}", k + 1) } else { tie.name.clone() };
            let table = self.case.table("tie", &self.names.free("tie", &name));
            table.key("on", quoted(&on)).key("to", quoted(&to));
            if let Some(within) = tie.within.filter(|within| *within > 0.0) {
                table.key("within", quantity(within * self.units.length, 1e-3, "mm"));
            }
        }
    }

    /// `[mass.NAME]`.
    pub fn point_masses(&mut self) {
        let (mass_unit, length) = (self.units.mass, self.units.length);
        for (k, mass) in self.deck.masses.iter().enumerate() {
            let nodes = self.nodes_in_use(&mass.nodes);
            if nodes.len() < mass.nodes.len() {
                self.ledger.note(
                    Weight::Matters,
                    "masses",
                    "masses on nodes of no element are not in the case",
                    mass.place,
                );
            }
            let name = if mass.name.is_empty() { format!("mass_{}", k + 1) } else { mass.name.clone() };
            let Some(region) = self.regions.points(&format!("{name}_nodes"), &nodes) else { continue };
            let table = self.case.table("mass", &self.names.free("mass", &name));
            table.key("on", quoted(&region)).key("mass", quantity(mass.mass * mass_unit, 1.0, "kg"));
            if mass.inertia != [0.0; 3] {
                table.key("inertia", numbers(mass.inertia.map(|x| x * mass_unit * length * length)));
            }
        }
    }

    /// `[spring.NAME]`: those to the ground together, others one by one.
    pub fn springs(&mut self) {
        for (k, spring) in self.deck.springs.iter().enumerate() {
            let name = if spring.name.is_empty() { format!("spring_{}", k + 1) } else { spring.name.clone() };
            let grounded: Vec<usize> =
                spring.ends.iter().filter(|(_, to)| to.is_none()).map(|(node, _)| *node).collect();
            let grounded = self.nodes_in_use(&grounded);
            if let Some(dof) = spring.dof
                && let Some(region) = self.regions.points(&format!("{name}_nodes"), &grounded)
            {
                let count = grounded.len() as f64;
                let sums = [count * spring.stiffness, count * spring.damping];
                self.spring(&name, &region, None, direction_of(dof), dof >= 3, sums);
            }
            for (n, (node, to)) in spring.ends.iter().enumerate() {
                let Some(to) = to else { continue };
                let places = [*to, *node].map(|node| self.deck.nodes[node].position);
                let line: [f64; 3] = std::array::from_fn(|i| places[0][i] - places[1][i]);
                let direction = spring.dof.map_or(line, direction_of);
                if direction == [0.0; 3] {
                    self.ledger.note(
                        Weight::Matters,
                        "springs",
                        "a spring between two nodes at one place has no direction",
                        spring.place,
                    );
                    continue;
                }
                let own = if spring.ends.len() == 1 { name.clone() } else { format!("{name}_{}", n + 1) };
                let (Some(on), Some(to)) = (
                    self.regions.points(&format!("{own}_from"), &[*node]),
                    self.regions.points(&format!("{own}_to"), &[*to]),
                ) else {
                    continue;
                };
                let turns = spring.dof.is_some_and(|dof| dof >= 3);
                self.spring(&own, &on, Some(&to), direction, turns, [spring.stiffness, spring.damping]);
            }
        }
    }

    fn spring(
        &mut self,
        name: &str,
        on: &str,
        to: Option<&str>,
        direction: [f64; 3],
        rotational: bool,
        [k, c]: [f64; 2],
    ) {
        let units = self.units;
        // N/m = kg/s²; N m = kg m²/s².
        let stiffness = units.mass / (units.time * units.time)
            * if rotational { units.length * units.length } else { 1.0 };
        let (unit_k, unit_c) = if rotational { ("N*m", "N*m*s") } else { ("N/m", "N*s/m") };
        let table = self.case.table("spring", &self.names.free("spring", name));
        table.key("on", quoted(on));
        if let Some(to) = to {
            table.key("to", quoted(to));
        }
        table.key("direction", numbers(direction));
        if rotational {
            table.key("rotational", "true");
        }
        table.key("stiffness", quantity(k * stiffness, 1.0, unit_k));
        if c != 0.0 {
            table.key("damping", quantity(c * stiffness * units.time, 1.0, unit_c));
        }
    }

    /// `[force.NAME]`.
    pub fn loads(&mut self) {
        let mut part_of = vec![0; self.deck.elements.len()];
        for (k, part) in self.parts.iter().enumerate() {
            part.elements.iter().for_each(|element| part_of[*element] = k);
        }
        if self.deck.loads.iter().any(|load| matches!(load.on, LoadOn::Shells { .. })) {
            self.regions.turn_alike();
        }
        for (k, load) in self.deck.loads.iter().enumerate() {
            let named = if load.name.is_empty() || load.name.parse::<u64>().is_ok() {
                format!("load_{}", k + 1)
            } else {
                load.name.clone()
            };
            match &load.on {
                LoadOn::Nodes { nodes, force } => {
                    let used = self.nodes_in_use(nodes);
                    let Some(region) = self.regions.points(&named, &used) else { continue };
                    // The same at each node.
                    let total = force.map(|f| f * self.units.force() * used.len() as f64);
                    let name = self.names.free("force", &region);
                    self.case.table("force", &name).key("on", quoted(&region)).key("force", numbers(total));
                }
                LoadOn::Shells { shells, pressure } => {
                    for (turned, region) in self.regions.shells_by_side(&named, shells, &part_of) {
                        // A case presses against the normal of the mesh.
                        let pressure = if turned { *pressure } else { -pressure } * self.units.stress();
                        let name = self.names.free("force", &region);
                        let pressure = quantity(pressure, 1e6, "MPa");
                        self.case.table("force", &name).key("on", quoted(&region)).key("pressure", pressure);
                    }
                }
                LoadOn::Faces { faces, pressure } => {
                    let Some(region) = self.regions.sides(&named, faces) else { continue };
                    let pressure = quantity(pressure * self.units.stress(), 1e6, "MPa");
                    let name = self.names.free("force", &region);
                    self.case.table("force", &name).key("on", quoted(&region)).key("pressure", pressure);
                }
            }
        }
    }
}

fn held_in([x, y, z]: [bool; 3], [rx, ry, rz]: [bool; 3]) -> [bool; 6] {
    [x, y, z, rx, ry, rz]
}

fn direction_of(dof: u8) -> [f64; 3] {
    std::array::from_fn(|k| if k == usize::from(dof % 3) { 1.0 } else { 0.0 })
}

/// Which axes of the coordinates unit vectors lie along; none where one lies between.
fn axes_among(vectors: [[f64; 3]; 3]) -> Option<[usize; 3]> {
    let along = |vector: [f64; 3]| (0..3).find(|k| vector[*k].abs() > 1.0 - 1e-9);
    Some([along(vectors[0])?, along(vectors[1])?, along(vectors[2])?])
}
