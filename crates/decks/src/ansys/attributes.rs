//! Types, real constants, sections and coordinate systems: ET, KEYOPT, TYPE, MAT, REAL, SECNUM, ESYS, R, RMODIF, SECTYPE, SECDATA, LOCAL, CS.

use super::model::{ElementType, System, turned};
use super::reader::{Command, Reader};
use crate::ledger::Weight;

impl Reader<'_> {
    /// Reads one of these commands; `short` is the name as far as four letters.
    pub fn attribute(&mut self, command: &Command<'_>, short: &str) {
        match short {
            "ET" => self.element_type(command),
            "KEYO" => self.option(command),
            "R" | "RMOR" | "RMOD" => self.real_constants(command, short),
            "SECT" => self.section_type(command),
            "SECD" => self.section_data(command),
            "LOCA" => self.local(command),
            "CS" => self.local_by_nodes(command),
            "CSYS" => match self.whole(command, 0) {
                Some(number) => self.model.system = number,
                None => self.model.system = i64::MIN,
            },
            _ => {
                // ESYS,0 is the global system.
                let id = match short {
                    "ESYS" => self.whole(command, 0).and_then(|id| u32::try_from(id).ok()),
                    _ if command.args.is_empty() => Some(1),
                    _ => self.id(command, 0),
                };
                let Some(id) = id else { return };
                let now = &mut self.model.current;
                match short {
                    "TYPE" => now.kind = id,
                    "MAT" => now.material = id,
                    "REAL" => now.real = id,
                    "SECN" => now.section = id,
                    _ => now.system = id,
                }
            }
        }
    }

    /// ET: type, element, key options 1 to 6.
    fn element_type(&mut self, command: &Command<'_>) {
        let Some(id) = self.id(command, 0) else { return };
        let name = command.arg(1);
        let digits = name.trim_start_matches(|c: char| !c.is_ascii_digit());
        let routine = match self.value(name) {
            Some(value) => Some(value as u32),
            None => digits.parse().ok(),
        };
        let Some(routine) = routine else {
            let found = format!("`{name}`, the element of type {id}");
            return self.fault(command.place, found, "an element, such as 186 or SOLID186");
        };
        let mut own = ElementType { routine, place: command.place, ..ElementType::default() };
        for n in 1..=6 {
            if let Some(value) = self.whole(command, n as usize + 1).filter(|value| *value != 0) {
                own.options.insert(n, value);
            }
        }
        self.model.types.insert(id, own);
    }

    /// KEYOPT: type, number, value.
    fn option(&mut self, command: &Command<'_>) {
        let (Some(id), Some(n)) = (self.id(command, 0), self.id(command, 1)) else { return };
        let Some(value) = self.whole(command, 2) else { return };
        match self.model.types.get_mut(&id) {
            Some(own) => _ = own.options.insert(n, value),
            None => self.fault(
                command.place,
                format!("an option of type {id}, which is not there"),
                "a type that ET defines above",
            ),
        }
    }

    /// R: set, values 1 to 6; RMORE: the six that follow; RMODIF: set, place, values.
    fn real_constants(&mut self, command: &Command<'_>, short: &str) {
        let (set, first, from) = match short {
            "RMOR" => {
                let set = self.model.current_reals;
                let next = self
                    .model
                    .reals
                    .get(&set)
                    .and_then(|own| own.keys().next_back())
                    .map_or(1, |last| last + 1);
                // RMORE goes on after a multiple of six.
                (Some(set), (next - 1).div_ceil(6).max(1) * 6 + 1, 0)
            }
            "RMOD" => match (self.id(command, 0), self.id(command, 1)) {
                (Some(set), Some(first)) => (Some(set), first, 2),
                _ => (None, 1, 2),
            },
            _ => (self.id(command, 0), 1, 1),
        };
        let Some(set) = set else { return };
        self.model.current_reals = set;
        for k in from..command.args.len().min(from + 6) {
            let Some(value) = self.real(command, k) else { return };
            if !command.arg(k).is_empty() {
                let place = first.saturating_add((k - from) as u32);
                self.model.reals.entry(set).or_default().insert(place, value);
            }
        }
        self.model.reals.entry(set).or_default();
    }

    /// SECTYPE: section, kind, form, name.
    fn section_type(&mut self, command: &Command<'_>) {
        let Some(id) = self.id(command, 0) else { return };
        self.model.section = id;
        let own = self.model.sections.entry(id).or_default();
        own.kind = command.word(1);
        own.form = command.word(2);
        own.data.clear();
        own.place = command.place;
    }

    /// SECDATA: a layer of a shell, or the numbers of another section.
    fn section_data(&mut self, command: &Command<'_>) {
        let values: Option<Vec<f64>> = (0..command.args.len()).map(|k| self.real(command, k)).collect();
        let (Some(values), id) = (values, self.model.section) else { return };
        match self.model.sections.get_mut(&id) {
            Some(own) => own.data.push(values),
            None => self.fault(command.place, "SECDATA before SECTYPE", "SECTYPE,number,kind above it"),
        }
    }

    /// LOCAL: number, kind, origin, θxy, θyz, θzx.
    fn local(&mut self, command: &Command<'_>) {
        // In archives LOCAL,R5.0,LOC,number,kind,x,y,z and LOCAL,R5.0,ANG,number,kind,θxy,θyz,θzx.
        let archived = command.word(0).starts_with("R5");
        let (at, part) = if archived { (2, command.word(1)) } else { (0, String::new()) };
        if archived && part != "LOC" && part != "ANG" {
            return;
        }
        let (Some(number), Some(kind)) = (self.whole(command, at), self.whole(command, at + 1)) else {
            return;
        };
        let values: Option<Vec<f64>> = (at + 2..at + 8).map(|k| self.real(command, k)).collect();
        let Some(values) = values else { return };
        let three = |k: usize| [values[k], values[k + 1], values[k + 2]];
        let global = System { kind, origin: [0.0; 3], axes: turned([0.0; 3]) };
        let own = self.model.systems.entry(number).or_insert(global);
        own.kind = kind;
        if part != "ANG" {
            own.origin = three(0);
        }
        if part != "LOC" {
            own.axes = turned(three(if archived { 0 } else { 3 }));
        }
        if !archived {
            self.model.system = number;
        }
    }

    /// CS: number, kind, nodes at the origin, on x, and in the xy plane.
    fn local_by_nodes(&mut self, command: &Command<'_>) {
        let (Some(number), Some(kind)) = (self.whole(command, 0), self.whole(command, 1)) else { return };
        let mut places = [[0.0; 3]; 3];
        for (k, place) in places.iter_mut().enumerate() {
            let node = self.whole(command, k + 2).and_then(|node| u64::try_from(node).ok());
            match node.and_then(|node| self.model.nodes.get(&node)) {
                Some(node) => *place = node.position,
                None => {
                    let found =
                        format!("node `{}` of a coordinate system, which is not there", command.arg(k + 2));
                    return self.fault(
                        command.place,
                        found,
                        "nodes at its origin, on its x axis and in its xy plane",
                    );
                }
            }
        }
        let [origin, x, y] = places;
        match super::frames::axes_of(origin, x, y) {
            Some(axes) => {
                self.model.systems.insert(number, System { kind, origin, axes });
                self.model.system = number;
            }
            None => self.fault(
                command.place,
                "three nodes of a coordinate system on a line",
                "nodes that span a plane",
            ),
        }
    }

    /// The place of coordinates in the active system: x y z, or r θ z with θ in degrees.
    pub fn placed(&self, own: [f64; 3]) -> Option<[f64; 3]> {
        let (kind, origin, axes) = match self.model.system {
            number @ (0 | 1) => (number, [0.0; 3], turned([0.0; 3])),
            number => {
                let own = self.model.systems.get(&number)?;
                (own.kind, own.origin, own.axes)
            }
        };
        let flat = match kind {
            0 => own,
            1 => {
                let (sin, cos) = own[1].to_radians().sin_cos();
                [own[0] * cos, own[0] * sin, own[2]]
            }
            _ => return None,
        };
        Some(std::array::from_fn(|k| origin[k] + (0..3).map(|i| flat[i] * axes[i][k]).sum::<f64>()))
    }

    /// Notes a system of elements that is not used.
    pub fn unused_system(&mut self, kind: i64, place: crate::deck::Place) {
        let why = format!("directions of a material in a system of kind {kind}: Cartesian ones are read");
        self.note(Weight::Matters, "ESYS", why, place);
    }
}
