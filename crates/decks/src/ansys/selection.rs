//! Which nodes and elements are selected: NSEL, ESEL, CMSEL, NSLE, ESLN, ALLSEL.

use super::model::{Attributes, Component, Model, Selection};
use super::reader::{Command, Reader};
use crate::deck::Place;
use crate::ledger::Weight;
use std::collections::BTreeSet;

impl Component {
    /// Those of the numbers that are members.
    fn members<'a, T>(
        &'a self,
        all: &'a std::collections::BTreeMap<u64, T>,
    ) -> impl Iterator<Item = u64> + 'a {
        self.ranges.iter().flat_map(|(from, to)| all.range(*from..=*to)).map(|(number, _)| *number)
    }
}

impl Model {
    /// The members that there are of a component.
    pub fn members(&self, component: &Component) -> BTreeSet<u64> {
        if component.of_nodes {
            component.members(&self.nodes).collect()
        } else {
            component.members(&self.elements).collect()
        }
    }

    /// The last component of this name.
    pub fn component(&self, name: &str) -> Option<&Component> {
        self.names.get(&name.trim().to_ascii_uppercase()).and_then(|k| self.components.get(*k))
    }

    /// Adds a component; one of the same name is no longer known by it.
    pub fn add_component(&mut self, component: Component) {
        self.names.insert(component.name.to_ascii_uppercase(), self.components.len());
        self.components.push(component);
    }

    /// The numbers that are selected; none where that is not known.
    pub fn selected(&self, of_nodes: bool) -> Option<BTreeSet<u64>> {
        let selection = if of_nodes { &self.selected_nodes } else { &self.selected_elements };
        match (selection, of_nodes) {
            (Selection::All, true) => Some(self.nodes.keys().copied().collect()),
            (Selection::All, false) => Some(self.elements.keys().copied().collect()),
            (Selection::Some(members), _) => Some(members.clone()),
            (Selection::Unknown, _) => None,
        }
    }
}

impl Reader<'_> {
    /// NSEL, ESEL: Type, Item, Comp, VMIN, VMAX, VINC.
    pub fn select(&mut self, command: &Command<'_>, of_nodes: bool) {
        let item = command.word(1);
        let found = match (command.word(0).as_str(), item.as_str()) {
            ("" | "S" | "R" | "A" | "U", "") => self.all(of_nodes),
            ("NONE", _) => return self.set_selection(of_nodes, Selection::Some(BTreeSet::new())),
            ("ALL", _) => return self.set_selection(of_nodes, Selection::All),
            ("" | "S" | "R" | "A" | "U", _) => self.found(command, of_nodes, &item),
            _ => None,
        };
        self.combine(command, of_nodes, found, &command.word(0));
    }

    /// CMSEL: Type, Name.
    pub fn select_component(&mut self, command: &Command<'_>) {
        let how = command.word(0);
        match how.as_str() {
            "ALL" | "NONE" => {
                self.select(command, true);
                self.select(command, false);
            }
            _ => match self.model.component(command.arg(1)).cloned() {
                Some(component) => {
                    let members = self.spend(command, self.model.members(&component), 0);
                    self.combine(command, component.of_nodes, members, &how);
                }
                None => self.fault(
                    command.place,
                    format!("component `{}`, which is not there", command.arg(1)),
                    "the name of a component above this line",
                ),
            },
        }
    }

    /// NSLE and ESLN: nodes of the selected elements, and elements of the selected nodes.
    pub fn select_joined(&mut self, command: &Command<'_>, of_nodes: bool) {
        let known = self.model.selected(!of_nodes);
        let found = known.map(|known| {
            let elements = self.model.elements.iter();
            if of_nodes {
                let own = elements.filter(|(number, _)| known.contains(number));
                own.flat_map(|(_, element)| element.nodes.iter().copied().filter(|n| *n > 0)).collect()
            } else {
                let touches = |nodes: &[u64]| nodes.iter().any(|node| known.contains(node));
                elements.filter(|(_, own)| touches(&own.nodes)).map(|(number, _)| *number).collect()
            }
        });
        let work = self.model.elements.len();
        let found = found.and_then(|found| self.spend(command, found, work));
        self.combine(command, of_nodes, found, &command.word(0));
    }

    fn all(&self, of_nodes: bool) -> Option<BTreeSet<u64>> {
        let model = &self.model;
        Some(if of_nodes {
            model.nodes.keys().copied().collect()
        } else {
            model.elements.keys().copied().collect()
        })
    }

    /// Those that a rule finds.
    fn found(&mut self, command: &Command<'_>, of_nodes: bool, item: &str) -> Option<BTreeSet<u64>> {
        let named = self.model.component(command.arg(3)).filter(|own| own.of_nodes == of_nodes).cloned();
        if let (Some(component), "NODE" | "ELEM") = (named, item) {
            return self.spend(command, self.model.members(&component), 0);
        }
        let low = self.value(command.arg(3))?;
        let high = if command.arg(4).is_empty() { low } else { self.value(command.arg(4))? };
        let step = self.value(command.arg(5)).filter(|step| *step >= 1.0).unwrap_or(1.0);
        let within = |number: u64| {
            let value = number as f64;
            low <= value && value <= high && ((value - low) % step == 0.0)
        };
        let model = &self.model;
        let by = |of: fn(&Attributes) -> u32| {
            let elements = model.elements.iter();
            let own = elements.filter(|(_, element)| within(u64::from(of(&element.attributes))));
            own.map(|(number, _)| *number).collect()
        };
        let found = match (item, of_nodes) {
            ("NODE", true) => model.nodes.keys().copied().filter(|number| within(*number)).collect(),
            ("ELEM", false) => model.elements.keys().copied().filter(|number| within(*number)).collect(),
            ("TYPE", false) => by(|own| own.kind),
            ("MAT", false) => by(|own| own.material),
            ("REAL", false) => by(|own| own.real),
            ("SEC", false) => by(|own| own.section),
            ("LOC", true) if model.system == 0 => {
                let axis = ["X", "Y", "Z"].iter().position(|own| *own == command.word(2))?;
                // The tolerance of NSEL: half a percent of a single value, or of the range a millionth.
                let width = if high > low {
                    1e-6 * (high - low)
                } else if low == 0.0 {
                    1e-6
                } else {
                    0.005 * low.abs()
                };
                let inside = |x: f64| low - width <= x && x <= high + width;
                let nodes = model.nodes.iter();
                nodes.filter(|(_, own)| inside(own.position[axis])).map(|(number, _)| *number).collect()
            }
            _ => return None,
        };
        let work = self.model.nodes.len() + self.model.elements.len();
        self.spend(command, found, work)
    }

    /// Members, as long as the work of all such commands is in proportion to the file; `work` is that of finding them.
    pub fn spend(
        &mut self,
        command: &Command<'_>,
        members: BTreeSet<u64>,
        work: usize,
    ) -> Option<BTreeSet<u64>> {
        let work = work.max(members.len()) + 1;
        let left = self.budget.checked_sub(work);
        if left.is_none() {
            let found = "more selections of many nodes than can be followed";
            self.fault(command.place, found, "fewer of them");
            self.over = true;
        }
        self.budget = left.unwrap_or(0);
        left.map(|_| members)
    }

    /// Whether a list of members may be kept: all of them together are in proportion to the file.
    pub fn keep(&mut self, place: Place, count: usize) -> bool {
        let left = self.members_left.checked_sub(count);
        if left.is_none() {
            self.fault(
                place,
                "components and selections with more members in all than can be kept",
                "fewer of them",
            );
        }
        self.over |= left.is_none();
        self.members_left = left.unwrap_or(0);
        left.is_some()
    }

    fn set_selection(&mut self, of_nodes: bool, selection: Selection) {
        if of_nodes {
            self.model.selected_nodes = selection;
        } else {
            self.model.selected_elements = selection;
        }
    }

    fn combine(&mut self, command: &Command<'_>, of_nodes: bool, found: Option<BTreeSet<u64>>, how: &str) {
        let before = self.model.selected(of_nodes);
        let selection = match (how, before, found) {
            ("S" | "", _, Some(found)) => Selection::Some(found),
            ("A", Some(mut before), Some(found)) => {
                before.extend(found);
                Selection::Some(before)
            }
            ("R", Some(before), Some(found)) => Selection::Some(&before & &found),
            ("U", Some(before), Some(found)) => Selection::Some(&before - &found),
            _ => {
                let why = "a selection by a rule that is not read; what acts on it is not read either";
                self.note(Weight::Perhaps, &command.name, why, command.place);
                Selection::Unknown
            }
        };
        self.set_selection(of_nodes, selection);
    }
}
