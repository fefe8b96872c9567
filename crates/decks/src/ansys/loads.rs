//! Supports, forces, pressures, constraint equations and rotations: D, F, SFE, CE, CP, CERIG, RBE3, CMOMEGA, CMROTATE.

use super::model::{Held, Region, freedom};
use super::reader::{Command, Reader, shown};
use crate::deck::{Motion, Place};
use crate::ledger::Weight;

impl Reader<'_> {
    /// The nodes or elements of an argument: a number, ALL, or the name of a component.
    fn targets(&mut self, command: &Command<'_>, k: usize, of_nodes: bool) -> Option<Vec<u64>> {
        let word = command.word(k);
        let members = if word == "ALL" {
            self.model.selected(of_nodes)
        } else if let Some(own) = self.model.component(&word).filter(|own| own.of_nodes == of_nodes) {
            Some(self.model.members(own))
        } else {
            let number = self.whole(command, k).and_then(|number| u64::try_from(number).ok())?;
            return Some(vec![number]);
        };
        let members = members.and_then(|members| self.spend(command, members, 0));
        if members.is_none() {
            let why = "on a selection that is not known: not read";
            self.note(Weight::Matters, &command.name, why, command.place);
        }
        let members = members.filter(|members| self.keep(command.place, members.len()))?;
        Some(members.into_iter().collect())
    }

    /// The nodes of D and F: the first argument, and those up to argument `k` in steps of the one after it.
    fn node_range(&mut self, command: &Command<'_>, k: usize) -> Option<Vec<u64>> {
        let mut nodes = self.targets(command, 0, true)?;
        if let ([first], false) = (&nodes[..], command.arg(k).is_empty()) {
            let (first, last) = (*first, self.whole(command, k)?.unsigned_abs());
            let step = self.whole(command, k + 1)?.unsigned_abs().max(1);
            let own = self.model.nodes.range(first..=last.max(first)).map(|(number, _)| *number);
            nodes = own.filter(|number| (number - first) % step == 0).collect();
            if !self.keep(command.place, nodes.len()) {
                return None;
            }
        }
        Some(nodes)
    }

    /// D: node, label, value, imaginary value, last node, step, more labels.
    pub fn hold(&mut self, command: &Command<'_>) {
        let mut freedoms = [false; 6];
        for k in [1, 6, 7, 8, 9, 10] {
            let label = command.word(k);
            match (label.as_str(), freedom(&label)) {
                ("", _) => {}
                (_, Some(own)) => freedoms[usize::from(own)] = true,
                ("ALL", _) => freedoms = [true; 6],
                ("TEMP" | "VOLT" | "MAG" | "PRES" | "ENKE" | "ENDS", _) => {
                    self.note(
                        Weight::Nothing,
                        format!("D {label}"),
                        "heat, electricity or flow",
                        command.place,
                    );
                }
                _ => self.note(
                    Weight::Perhaps,
                    format!("D {label}"),
                    "a label that is not read",
                    command.place,
                ),
            }
        }
        if freedoms == [false; 6] {
            return;
        }
        if self.value(command.arg(2)).is_none_or(|value| value != 0.0) && !command.arg(2).is_empty() {
            let why = "a displacement that is given is held at zero";
            self.note(Weight::Perhaps, "D with a value", why, command.place);
        }
        let Some(nodes) = self.node_range(command, 4) else { return };
        for node in nodes {
            let own =
                self.model.held.entry(node).or_insert(Held { freedoms: [false; 6], place: command.place });
            freedoms.iter().zip(&mut own.freedoms).for_each(|(new, old)| *old |= new);
        }
    }

    /// F: node, label, value, imaginary value, last node, step.
    pub fn force(&mut self, command: &Command<'_>) {
        let label = command.word(1);
        let axis = match label.as_str() {
            "FX" => 0,
            "FY" => 1,
            "FZ" => 2,
            "MX" | "MY" | "MZ" => {
                return self.note(
                    Weight::Perhaps,
                    format!("F {label}"),
                    "moments are not read",
                    command.place,
                );
            }
            _ => {
                return self.note(
                    Weight::Nothing,
                    format!("F {label}"),
                    "heat or electricity",
                    command.place,
                );
            }
        };
        let Some(value) = self.real(command, 2) else { return };
        let Some(nodes) = self.node_range(command, 4) else { return };
        for node in nodes {
            self.model.forces.entry(node).or_insert(([0.0; 3], command.place)).0[axis] = value;
        }
    }

    /// SFE: element, face, label, real (0, 1) or imaginary (2), values; in archives these are in the line that follows.
    pub fn surface_load(&mut self, command: &Command<'_>) {
        let label = command.word(2);
        if command.args.contains(&"-1") && !matches!(label.as_str(), "PRES" | "CONV") {
            // The end of loads in an archive.
            return;
        }
        let archived = command.word(4).starts_with("R5");
        let mut values = Vec::new();
        if archived {
            let Some((line, place)) = self.line() else { return };
            for word in line.split_whitespace() {
                match super::fortran::real(word) {
                    Some(value) => values.push(value),
                    None => self.fault(place, format!("`{}`", shown(word)), "a number"),
                }
            }
        }
        if label != "PRES" {
            let why = "surface loads that are no pressure";
            return self.note(Weight::Nothing, format!("SFE {label}"), why, command.place);
        }
        let (Some(face), Some(part)) = (self.id(command, 1), self.whole(command, 3)) else { return };
        if !archived {
            for k in 4..command.args.len() {
                let Some(value) = self.real(command, k) else { return };
                values.push(value);
            }
        }
        for element in self.targets(command, 0, false).unwrap_or_default() {
            self.press(element, face, part, &values, command.place);
        }
    }

    /// A pressure on a face of an element.
    pub fn press(&mut self, element: u64, face: u32, part: i64, values: &[f64], place: Place) {
        let Some(first) = values.first().copied() else { return };
        if part > 1 {
            return self.note(Weight::Nothing, "SFE PRES", "the imaginary part", place);
        }
        // Blank means as at the first node.
        if values.iter().any(|value| *value != first && *value != 0.0) {
            let why = "a pressure that changes over a face: that at the first node is taken";
            self.note(Weight::Perhaps, "SFE PRES", why, place);
        }
        self.model.pressures.push((element, face, first, place));
    }

    /// CE: number, constant, then node, label, factor three times; in archives R5.0,DEFI and R5.0,NODE.
    pub fn equation(&mut self, command: &Command<'_>) {
        let last = self.model.equations.keys().next_back().copied().unwrap_or(0);
        let (number, constant, first) = match (command.word(0).as_str(), command.word(1).as_str()) {
            ("R5.0", "DEFI") => {
                let (Some(number), Some(constant)) = (self.whole(command, 3), self.real(command, 4)) else {
                    return;
                };
                self.model.defined = number;
                (number, constant, usize::MAX)
            }
            ("R5.0", "NODE") => (self.model.defined, 0.0, 2),
            ("HIGH" | "NEXT", _) => {
                (last.saturating_add(i64::from(command.word(0) == "NEXT")).max(1), 0.0, 2)
            }
            _ => {
                let (Some(number), Some(constant)) = (self.whole(command, 0), self.real(command, 1)) else {
                    return;
                };
                (number, constant, 2)
            }
        };
        if constant != 0.0 {
            let found = format!("CE with the constant {constant}");
            self.fault(
                command.place,
                found,
                "0: equations without a constant, which vibrations do not depend on",
            );
        }
        let mut terms = Vec::new();
        let mut k = first;
        while k < command.args.len() {
            let (Some(node), Some(factor)) = (self.whole(command, k), self.real(command, k + 2)) else {
                return;
            };
            let label = command.arg(k + 1);
            match (freedom(label), u64::try_from(node)) {
                (_, Ok(0)) => {}
                (Some(own), Ok(node)) => terms.push((node, own, factor)),
                _ => {
                    let why = format!("a term of `{label}` of node {node}: the equation is without it");
                    self.note(Weight::Matters, "CE", why, command.place);
                }
            }
            k += 3;
        }
        self.model.equations.entry(number).or_insert((Vec::new(), command.place)).0.extend(terms);
    }

    /// CP: set, label, nodes.
    pub fn coupled(&mut self, command: &Command<'_>) {
        let last = self.model.coupled.keys().next_back().map_or(0, |(set, _)| *set);
        let set = match command.word(0).as_str() {
            "HIGH" => Some(last),
            "NEXT" => Some(last.saturating_add(1)),
            _ => self.whole(command, 0),
        };
        let Some(set) = set else { return };
        let label = command.word(1);
        let freedoms: Vec<u8> = match (label.as_str(), freedom(&label)) {
            ("ALL", _) => (0..6).collect(),
            (_, Some(own)) => vec![own],
            _ => {
                let why = "a label that is no motion";
                return self.note(Weight::Perhaps, format!("CP {label}"), why, command.place);
            }
        };
        let mut nodes = Vec::new();
        for k in 2..command.args.len() {
            nodes.extend(self.targets(command, k, true).unwrap_or_default());
        }
        for own in freedoms {
            let all = self.model.coupled.entry((set, own)).or_insert((Vec::new(), command.place));
            all.0.extend(nodes.iter().filter(|node| **node > 0));
        }
    }

    /// CERIG: node, the nodes that follow it, freedoms; RBE3: node that follows, freedoms, the nodes that lead it, weights.
    pub fn region(&mut self, command: &Command<'_>, rigid: bool) {
        let (of, freedoms) = if rigid { (1, command.word(2)) } else { (2, command.word(1)) };
        let Some(reference) = self.whole(command, 0).and_then(|node| u64::try_from(node).ok()) else {
            return;
        };
        if !matches!(freedoms.as_str(), "" | "ALL" | "UXYZ") {
            let why = format!("freedoms `{freedoms}` only: all are taken");
            self.note(Weight::Matters, &command.name, why, command.place);
        }
        if !rigid && !command.arg(3).is_empty() {
            self.note(Weight::Perhaps, "RBE3", "weights of nodes: all are taken as one", command.place);
        }
        let Some(nodes) = self.targets(command, of, true) else { return };
        let nodes: Vec<u64> = nodes.into_iter().filter(|node| *node != reference).collect();
        let mut own = self.model.regions.iter_mut().rev().take(1);
        let same = own.find(|own| own.reference == reference && own.rigid == rigid);
        match same {
            Some(own) => own.nodes.extend(nodes),
            None => self.model.regions.push(Region { reference, nodes, rigid, place: command.place }),
        }
    }

    /// ACEL, OMEGA; CMOMEGA and CMROTATE: component, ωx ωy ωz, a point on the axis and, if ω is one number, another one.
    pub fn motion(&mut self, command: &Command<'_>, short: &str) {
        let first = if short.starts_with("CM") { 1 } else { 0 };
        let values: Option<Vec<f64>> = (first..first + 9).map(|k| self.real(command, k)).collect();
        let Some(values) = values else { return };
        if values[..3] == [0.0; 3] {
            return;
        }
        if first == 0 {
            let (weight, why) = match short {
                "ACEL" => (Weight::Perhaps, "gravity"),
                _ => (Weight::Matters, "a rotation of the whole model: say so in the case"),
            };
            return self.note(weight, &command.name, why, command.place);
        }
        let three = |k: usize| [values[k], values[k + 1], values[k + 2]];
        let (point, two) = (three(3), command.args.len() > 7);
        let along = if two { super::frames::minus(three(6), point) } else { three(0) };
        let Some(axis) = super::frames::unit(along) else {
            return self.fault(command.place, "a rotation whose axis has no direction", "two points apart");
        };
        let speed = if two { values[0] } else { three(0).iter().map(|x| x * x).sum::<f64>().sqrt() };
        let set = command.arg(0).to_string();
        self.model.motions.push(Motion { set, point, axis, speed, place: command.place });
    }
}
