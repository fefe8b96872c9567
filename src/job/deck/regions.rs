//! Regions of the mesh as sets and surfaces.

use super::Maker;
use crate::decks::{Set, Weight};
use crate::mesh::{Cell, Region, cell_nodes};

impl Maker<'_> {
    /// Every region under its name: points and lines as sets of nodes, faces as surfaces, parts and solids as sets of elements.
    pub(super) fn regions(&mut self) {
        let mesh = self.prepared.regions.mesh.clone();
        for region in &mesh.regions {
            let cells = self.prepared.regions.cells(region);
            if self.deck.element_set(&region.name).is_some() && self.model.part(&region.name).is_some() {
                continue;
            }
            let elements: Option<Vec<usize>> = cells.iter().map(|cell| self.sides.element(cell)).collect();
            let name = region.name.clone();
            match (region.dimension, elements) {
                (0 | 1, _) => {
                    let members = cell_nodes(&cells);
                    self.deck.node_sets.push(Set { name, members, internal: false });
                }
                (2, _) => self.add_surface(region, &cells),
                (_, Some(mut members)) => {
                    members.sort_unstable();
                    self.deck.element_sets.push(Set { name, members, internal: false });
                }
                _ => self.note(
                    Weight::Nothing,
                    format!("region {name}"),
                    "solids that are no part are not written",
                ),
            }
        }
    }

    fn add_surface(&mut self, region: &Region, cells: &[Cell]) {
        let surface = self.sides.surface(&region.name, cells);
        if surface.nodes.is_empty() {
            self.deck.surfaces.push(surface);
        } else {
            let why = "faces that are no side of a part are not written";
            self.note(Weight::Nothing, format!("region {}", region.name), why);
        }
    }

    /// The name of the surface that a region, or a shell, is; made if it is not there. Points and lines are surfaces of nodes.
    pub(super) fn surface_of(&mut self, name: &str) -> String {
        if self.deck.surface(name).is_none() {
            let region = self.prepared.regions.mesh.region(name).cloned();
            let cells = match region {
                Some(region) => self.prepared.regions.cells(&region),
                None => self.model.part(name).map_or(Vec::new(), |part| part.cells.clone()),
            };
            let surface = self.sides.surface(name, &cells);
            self.deck.surfaces.push(surface);
        }
        name.to_string()
    }

    /// The name of the set of just these nodes, if a region has them.
    pub(super) fn set_of(&mut self, name: &str, nodes: &[usize]) -> Option<String> {
        if self.deck.node_set(name).is_none() {
            let (name, members) = (name.to_string(), nodes.to_vec());
            self.deck.node_sets.push(Set { name, members, internal: false });
        }
        self.deck.node_set(name).filter(|set| set.members == nodes).map(|set| set.name.clone())
    }
}
