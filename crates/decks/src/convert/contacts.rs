//! Contacts of the case, with the motion of the bodies that turn.

use super::converter::Converter;
use super::text::{number, numbers, quantity, quoted, strings};
use crate::deck::{Contact, Motion};
use crate::ledger::Weight;
use std::collections::HashSet;
use stridor_mesh::CellKind;

/// k_n h/E of a contact that the file calls hard: stiff beside the elements below it.
const HARD: f64 = 10.0;

impl Converter<'_> {
    /// `[contact.NAME]`, and `[rotation.NAME]` of what else turns.
    pub fn contacts(&mut self) {
        let rotations: Vec<Option<Motion>> =
            self.deck.contacts.iter().map(|contact| self.rotation_of(contact)).collect();
        for (k, (contact, rotation)) in self.deck.contacts.iter().zip(&rotations).enumerate() {
            let body = self.regions.surface(&contact.slave, &mut self.ledger);
            let counter = self.regions.surface(&contact.master, &mut self.ledger);
            let (Some(body), Some(counter)) = (body, counter) else {
                let why = "a contact of surfaces that have no sides is not in the case";
                self.ledger.note(Weight::Matters, "contacts", why, contact.place);
                continue;
            };
            self.contact(k, contact, rotation.as_ref(), [&body, &counter]);
        }
        self.rotations(&rotations);
    }

    /// `[rotation.NAME]`: parts that turn where no contact slides on them.
    fn rotations(&mut self, of_contacts: &[Option<Motion>]) {
        for motion in self.deck.motions.iter().filter(|motion| motion.speed != 0.0) {
            if of_contacts.iter().flatten().any(|other| other.set == motion.set) {
                continue;
            }
            let nodes: HashSet<usize> = self
                .deck
                .node_set(&motion.set)
                .map(|set| set.members.iter().copied().collect())
                .unwrap_or_default();
            let members =
                self.deck.element_set(&motion.set).map(|set| set.members.as_slice()).unwrap_or_default();
            let turns = |element: &usize| {
                members.binary_search(element).is_ok()
                    || self.deck.elements[*element].nodes.iter().all(|node| nodes.contains(node))
            };
            let parts = self
                .parts
                .iter()
                .filter(|part| part.elements.iter().any(turns))
                .map(|part| part.name.as_str());
            let parts = strings(parts);
            let point = motion.point.map(|x| x * self.units.length);
            let name = self.names.free("rotation", &motion.set);
            let table = self.case.table("rotation", &name);
            table.key("parts", parts).key("axis", numbers(motion.axis)).key("point", numbers(point));
            table.key("speed", quantity(motion.speed / self.units.time, 1.0, "rad/s"));
        }
    }

    fn contact(
        &mut self,
        k: usize,
        contact: &Contact,
        rotation: Option<&Motion>,
        [body, counter]: [&str; 2],
    ) {
        let units = self.units;
        let name = match (contact.name.as_str(), contact.slave.as_str()) {
            ("", "") => format!("contact_{}", k + 1),
            ("", _) => body.to_string(),
            (own, _) => own.to_string(),
        };
        let per_area = units.stress() / units.length;
        let (stiffness, chosen) = match contact.stiffness {
            Some(stiffness) => (stiffness * per_area, false),
            None => {
                let soft = [&contact.slave, &contact.master]
                    .into_iter()
                    .filter_map(|name| self.side_stiffness(name));
                let soft = soft.fold(f64::INFINITY, f64::min);
                let stiffness = if soft.is_finite() { HARD * soft * per_area } else { 1e12 };
                (rounded(stiffness), true)
            }
        };
        let own = self.names.free("contact", &name);
        let table = self.case.table("contact", &own);
        if chosen {
            table.comment(format!(
                "The file has hard contact: a stiffness of {HARD} E/h of the softer side stands for it."
            ));
        }
        for (_, why) in self.deck.lost.iter().filter(|(what, _)| is_of(what, contact)) {
            table.comment(format!("Lost before it came here: {why}."));
        }
        if rotation.is_none() {
            table.comment("Nothing in the file turns: the bodies do not slide. Give a `rotation` or a `sliding_velocity` for squeal.");
        }
        table.key("body", quoted(body)).key("counter", quoted(counter)).key("approach", "0");
        if contact.closed {
            table.key("initial_gap", quoted("closed"));
        }
        match rotation {
            Some(Motion { point, axis, speed, .. }) => {
                let point = point.map(|x| x * units.length);
                let value = format!(
                    "{{ axis = {}, point = {}, speed = {} }}",
                    numbers(*axis),
                    numbers(point),
                    quantity(speed / units.time, 1.0, "rad/s")
                );
                table.key("rotation", value);
            }
            None => {
                table.key("sliding_velocity", "0");
            }
        }
        table.key(
            "normal",
            format!("{{ per = \"area\", stiffness = {} }}", quantity(stiffness, 1e9, "GN/m^3")),
        );
        table.key("friction", format!("{{ law = \"coulomb\", mu0 = {} }}", number(contact.friction)));
        if let Some(stick) = contact.stick {
            table.key("bristle", format!("{{ stiffness = {} }}", quantity(stick * per_area, 1e9, "GN/m^3")));
        }
        if chosen {
            let why = format!("hard contact is a stiffness of {HARD} E/h of the softer side");
            self.ledger.note(Weight::Perhaps, "contacts", why, contact.place);
        }
    }

    /// How the counter-body turns beside the body: as a motion of the file says of nodes of one of them.
    fn rotation_of(&self, contact: &Contact) -> Option<Motion> {
        let nodes_of = |name: &str| -> HashSet<usize> {
            let Some(surface) = self.deck.surface(name) else { return HashSet::new() };
            let sides = surface.faces.iter().flat_map(|(element, _)| &self.deck.elements[*element].nodes);
            let shells = surface.shells.iter().flat_map(|(element, _)| &self.deck.elements[*element].nodes);
            sides.chain(shells).chain(&surface.nodes).copied().collect()
        };
        let turns = |motion: &Motion, nodes: &HashSet<usize>| {
            let set = self
                .deck
                .node_set(&motion.set)
                .is_some_and(|set| set.members.iter().any(|node| nodes.contains(node)));
            set || self.deck.element_set(&motion.set).is_some_and(|set| {
                set.members
                    .iter()
                    .any(|element| self.deck.elements[*element].nodes.iter().any(|node| nodes.contains(node)))
            })
        };
        let (body, counter) = (nodes_of(&contact.slave), nodes_of(&contact.master));
        let moving = self.deck.motions.iter().filter(|motion| motion.speed != 0.0);
        moving.clone().find(|motion| turns(motion, &counter)).cloned().or_else(|| {
            let motion = moving.clone().find(|motion| turns(motion, &body))?.clone();
            Some(Motion { speed: -motion.speed, ..motion })
        })
    }

    /// E/h of the first element of a surface \[force/length³\].
    fn side_stiffness(&self, surface: &str) -> Option<f64> {
        let surface = self.deck.surface(surface)?;
        let owner = surface
            .faces
            .first()
            .map(|(element, _)| *element)
            .or_else(|| surface.shells.first().map(|(element, _)| *element));
        let element = owner.or_else(|| {
            let node = surface.nodes.first()?;
            self.deck
                .elements
                .iter()
                .position(|element| element.kind != CellKind::Point1 && element.nodes.contains(node))
        })?;
        let part = self.parts.iter().find(|part| part.elements.binary_search(&element).is_ok())?;
        let material = &self.deck.sections[part.section].material;
        let material = self.deck.material(material)?;
        let modulus = match material.elastic? {
            crate::deck::Elastic::Isotropic { youngs_modulus, .. } => youngs_modulus,
            crate::deck::Elastic::Orthotropic { youngs_moduli, .. } => youngs_moduli[0],
        };
        let corners = &self.deck.elements[element].nodes[..self.deck.elements[element].kind.n_corners()];
        let low: [f64; 3] = std::array::from_fn(|i| {
            corners.iter().map(|n| self.deck.nodes[*n].position[i]).fold(f64::INFINITY, f64::min)
        });
        let high: [f64; 3] = std::array::from_fn(|i| {
            corners.iter().map(|n| self.deck.nodes[*n].position[i]).fold(f64::NEG_INFINITY, f64::max)
        });
        let size = (0..3).map(|i| (high[i] - low[i]).powi(2)).sum::<f64>().sqrt();
        (size > 0.0).then(|| modulus / size)
    }
}

/// Whether what a file says that is lost is of this contact.
pub(super) fn is_of(what: &str, contact: &Contact) -> bool {
    !contact.name.is_empty() && what.strip_prefix("contact.") == Some(&contact.name)
}

/// Two digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}
