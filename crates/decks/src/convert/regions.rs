//! The mesh of a deck with its regions: parts, sets and surfaces under the names that they have.

use crate::deck::{Deck, Element};
use crate::ledger::{Ledger, Weight};
use crate::skin::outer_faces;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use stridor_mesh::{Cell, Mesh, Region, turn_alike};

/// A mesh that is being made.
pub(super) struct Regions<'a> {
    deck: &'a Deck,
    pub mesh: Mesh,
    /// The cell of each element of the deck that is in the mesh.
    cells: Vec<Option<usize>>,
    /// Names that are taken.
    taken: HashSet<String>,
    /// Regions of points and of faces that were made, by what is in them.
    points: HashMap<Vec<usize>, String>,
    faces: HashMap<Vec<(usize, usize)>, String>,
    face_cells: HashMap<(usize, usize), usize>,
    point_cells: HashMap<usize, usize>,
}

impl<'a> Regions<'a> {
    /// The nodes of a deck, places in metres; no elements yet.
    pub fn new(deck: &'a Deck, length: f64) -> Self {
        let nodes = deck.nodes.iter().map(|node| node.position.map(|x| x * length)).collect();
        Regions {
            deck,
            mesh: Mesh { nodes, ..Mesh::default() },
            cells: vec![None; deck.elements.len()],
            taken: HashSet::new(),
            points: HashMap::new(),
            faces: HashMap::new(),
            face_cells: HashMap::new(),
            point_cells: HashMap::new(),
        }
    }

    /// A name like `name` that no region has.
    fn free_name(&mut self, name: &str, kind: &str) -> String {
        let clean: String = name.chars().map(|c| if c == '"' || c.is_control() { '_' } else { c }).collect();
        let clean = if clean.trim().is_empty() { kind.to_string() } else { clean };
        let mut found = clean.clone();
        let mut n = 1;
        while !self.taken.insert(found.clone()) {
            found = if n == 1 { format!("{clean}_{kind}") } else { format!("{clean}_{kind}_{n}") };
            n += 1;
        }
        found
    }

    fn region(&mut self, name: &str, kind: &str, dimension: usize, mut elements: Vec<usize>) -> String {
        elements.sort_unstable();
        elements.dedup();
        let name = self.free_name(name, kind);
        self.mesh.regions.push(Region { name: name.clone(), dimension, elements });
        name
    }

    /// The cell of an element, which is put into the mesh if it is not there.
    fn cell(&mut self, index: usize) -> Option<usize> {
        if self.cells[index].is_none() {
            let Element { kind, nodes, .. } = &self.deck.elements[index];
            self.mesh.elements.push(Cell::new(*kind, nodes)?);
            self.cells[index] = Some(self.mesh.elements.len() - 1);
        }
        self.cells[index]
    }

    /// Whether an element is in the mesh.
    pub fn has(&self, index: usize) -> bool {
        self.cells[index].is_some()
    }

    /// A part of elements of one dimension.
    pub fn part(&mut self, name: &str, elements: &[usize]) -> Option<String> {
        let dimension = self.deck.elements[*elements.first()?].kind.dimension();
        let cells: Vec<usize> = elements.iter().filter_map(|index| self.cell(*index)).collect();
        Some(self.region(name, "part", dimension, cells))
    }

    /// A set of elements that are in the mesh, a region for each dimension.
    pub fn elements(&mut self, name: &str, elements: &[usize]) {
        let mut by_dimension: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for index in elements {
            if let Some(cell) = self.cells[*index] {
                by_dimension.entry(self.deck.elements[*index].kind.dimension()).or_default().push(cell);
            }
        }
        for (dimension, cells) in by_dimension {
            self.region(name, "elements", dimension, cells);
        }
    }

    /// The region of some nodes, which is made under a name if there is none.
    pub fn points(&mut self, name: &str, nodes: &[usize]) -> Option<String> {
        let mut nodes = nodes.to_vec();
        nodes.sort_unstable();
        nodes.dedup();
        if nodes.is_empty() {
            return None;
        }
        if let Some(known) = self.points.get(&nodes) {
            return Some(known.clone());
        }
        let cells = nodes.iter().map(|node| self.point_cell(*node)).collect();
        let made = self.region(name, "nodes", 0, cells);
        self.points.insert(nodes, made.clone());
        Some(made)
    }

    fn point_cell(&mut self, node: usize) -> usize {
        let elements = &mut self.mesh.elements;
        *self.point_cells.entry(node).or_insert_with(|| {
            elements.push(Cell::point(node));
            elements.len() - 1
        })
    }

    /// The region of some sides of solids, which is made under a name if there is none.
    pub fn sides(&mut self, name: &str, sides: &[(usize, usize)]) -> Option<String> {
        let mut sides: Vec<(usize, usize)> =
            sides.iter().copied().filter(|(index, _)| self.has(*index)).collect();
        sides.sort_unstable();
        sides.dedup();
        if sides.is_empty() {
            return None;
        }
        if let Some(known) = self.faces.get(&sides) {
            return Some(known.clone());
        }
        let cells = sides.iter().filter_map(|side| self.face_cell(*side)).collect();
        let made = self.region(name, "faces", 2, cells);
        self.faces.insert(sides, made.clone());
        Some(made)
    }

    fn face_cell(&mut self, (index, side): (usize, usize)) -> Option<usize> {
        if let Some(known) = self.face_cells.get(&(index, side)) {
            return Some(*known);
        }
        let Element { kind, nodes, .. } = &self.deck.elements[index];
        let face = Cell::new(*kind, nodes)?.sides().nth(side)?;
        self.mesh.elements.push(face);
        self.face_cells.insert((index, side), self.mesh.elements.len() - 1);
        Some(self.mesh.elements.len() - 1)
    }

    /// The region of a surface of the deck: sides of solids or shells, or the sides of which all nodes are in a surface of nodes.
    pub fn surface(&mut self, name: &str, ledger: &mut Ledger) -> Option<String> {
        let surface = self.deck.surface(name)?;
        let mut sides = surface.faces.clone();
        if !surface.nodes.is_empty() {
            sides.extend(self.sides_within(&surface.nodes));
            if sides.is_empty() && surface.shells.is_empty() {
                let why = "a surface of nodes that are no whole sides of solids has no area";
                ledger.note(Weight::Matters, format!("surface {name}"), why, Default::default());
                return None;
            }
        }
        if surface.shells.is_empty() {
            return self.sides(&surface.name, &sides);
        }
        if !sides.is_empty() {
            let why = "a surface of solids and shells is that of its shells";
            ledger.note(Weight::Matters, format!("surface {name}"), why, Default::default());
        }
        let cells = surface.shells.iter().filter_map(|(index, _)| self.cells[*index]).collect();
        self.shells(&surface.name, cells)
    }

    /// The region of some cells of shells, which is made under a name if there is none.
    fn shells(&mut self, name: &str, cells: BTreeSet<usize>) -> Option<String> {
        let own = cells.into_iter().collect::<Vec<_>>();
        let known = self.mesh.regions.iter().find(|region| region.dimension == 2 && region.elements == own);
        if let Some(known) = known {
            return Some(known.name.clone());
        }
        (!own.is_empty()).then(|| self.region(name, "faces", 2, own))
    }

    /// Turns the faces of neighbours alike, as they are when the mesh is read.
    pub fn turn_alike(&mut self) {
        turn_alike(&mut self.mesh);
    }

    /// Regions of shells of the deck, each of one part, whose normals the mesh has turned over ([`Regions::turn_alike`]), and of those that it
    /// has not.
    pub fn shells_by_side(&mut self, name: &str, shells: &[usize], part_of: &[usize]) -> Vec<(bool, String)> {
        let mut by_side: BTreeMap<(usize, bool), BTreeSet<usize>> = BTreeMap::new();
        for index in shells {
            let Element { kind, nodes, .. } = &self.deck.elements[*index];
            if let (Some(cell), Some(own)) = (self.cells[*index], Cell::new(*kind, nodes)) {
                let turned = self.mesh.elements[cell] != own;
                by_side.entry((part_of[*index], turned)).or_default().insert(cell);
            }
        }
        let region = |((_, turned), cells)| Some((turned, self.shells(name, cells)?));
        by_side.into_iter().filter_map(region).collect()
    }

    /// Outer sides of the solids of the mesh, all of whose nodes are among some.
    fn sides_within(&self, nodes: &[usize]) -> Vec<(usize, usize)> {
        let within: HashSet<usize> = nodes.iter().copied().collect();
        let elements = &self.deck.elements;
        let mut outer = outer_faces(elements, (0..elements.len()).filter(|index| self.has(*index)));
        outer.retain(|(index, side)| {
            let element = &elements[*index];
            let (_, of_side) = element.kind.table().sides[*side];
            of_side.iter().all(|node| within.contains(&element.nodes[usize::from(*node)]))
        });
        outer
    }

    /// The name of a region as a node set of the deck has it, if one has just these nodes.
    pub fn name_of_nodes(&self, nodes: &[usize]) -> Option<&'a str> {
        self.deck.node_sets.iter().find(|set| set.members == nodes).map(|set| set.name.as_str())
    }
}
