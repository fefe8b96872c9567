//! Elements with a shape: solids, shells, beams and rods.

use super::axis::Axis;
use super::fields::Fields;
use super::model::Model;
use super::table::Table;
use crate::deck::{Element, Place};
use crate::ledger::Weight;
use crate::turn;
use std::collections::BTreeMap;
use stridor_mesh::{CellKind, Program};

/// An element as its card has it.
#[derive(Debug, Clone, PartialEq)]
struct Raw {
    /// Index in the names.
    name: u32,
    of: Of,
    /// Its nodes in the order of the card; 0 where one is left out.
    nodes: Box<[u64]>,
    axis: Option<Box<Axis>>,
}

/// What an element is made of.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Of {
    Property(u64),
    /// Material and area of CONROD.
    Rod(u64, f64),
}

#[derive(Debug, Default)]
pub(super) struct Elements {
    table: Table<Raw>,
    names: Vec<String>,
    /// The property and plane of bending of bars and beams that have none: BAROR, BEAMOR.
    standard: BTreeMap<&'static str, (u64, Option<Axis>)>,
    /// What each element of the deck is made of, and the direction of its plane of bending.
    pub made_of: Vec<(Of, Option<[f64; 3]>)>,
}

/// The number of corners and that of all nodes of the elements of this name.
fn numbers_of_nodes(name: &str) -> (usize, usize) {
    let has =
        |kind: &CellKind| kind.named(Program::Nastran).iter().any(|form| form.names().any(|own| own == name));
    CellKind::all().filter(has).fold((0, 0), |(_, most), kind| (kind.n_corners(), most.max(kind.n_nodes())))
}

/// The element of first order with the corners of one of second order.
fn first_order(name: &str) -> &str {
    match name {
        "CQUAD8" => "CQUAD4",
        "CTRIA6" => "CTRIA3",
        _ => name,
    }
}

impl Elements {
    pub fn card(&mut self, fields: &mut Fields) -> Option<()> {
        let name = fields.name();
        match name {
            "BAROR" | "BEAMOR" => {
                let property = fields.id_or(2, 0)?;
                let axis = Axis::read(fields)?;
                self.standard.insert(if name == "BAROR" { "CBAR" } else { "CBEAM" }, (property, axis));
                return Some(());
            }
            "CONROD" => {
                let number = fields.id(1)?;
                let nodes = [fields.id(2), fields.id(3)];
                let of = Of::Rod(fields.id(4)?, fields.real(5)?);
                self.rod_fields(fields, 6);
                return self.push(fields, number, of, vec![nodes[0]?, nodes[1]?], None);
            }
            _ => {}
        }
        let (corners, all) = numbers_of_nodes(name);
        let number = fields.id(1)?;
        let standard = self.standard.get(name);
        let property = fields.id_or(2, standard.map_or(0, |(property, _)| *property))?;
        let property = if property == 0 { number } else { property };
        let mut nodes = Vec::with_capacity(all);
        for k in 0..all {
            nodes.push(if k < corners { fields.id(3 + k)? } else { fields.id_or(3 + k, 0)? });
        }
        let mut plane = None;
        match name {
            "CBAR" | "CBEAM" => {
                let by_default = standard.and_then(|(_, axis)| axis.clone());
                plane = Axis::read(fields)?.or(by_default).map(Box::new);
                fields.unread(
                    8,
                    8,
                    Weight::Nothing,
                    "offsets and vectors are in the frame of the displacements",
                );
                fields.unread(9, 10, Weight::Matters, "hinges at its ends are not read");
                fields.unread(11, 16, Weight::Matters, "offsets of its ends are not read");
                fields.unread(17, 18, Weight::Nothing, "scalar points of warping are not read");
            }
            "CROD" | "CTUBE" => {}
            _ if name.starts_with("CQUAD") || name.starts_with("CTRIA") => shell_fields(fields, name, all),
            _ => {}
        }
        self.push(fields, number, Of::Property(property), nodes, plane)
    }

    fn rod_fields(&self, fields: &mut Fields, first: usize) {
        fields.unread(first, first, Weight::Perhaps, "torsion of rods is not read");
        fields.unread(first + 1, first + 1, Weight::Nothing, "places where stresses are wanted");
        fields.unread(first + 2, first + 2, Weight::Matters, "mass that stiffens nothing is not read");
    }

    fn push(
        &mut self,
        fields: &mut Fields,
        number: u64,
        of: Of,
        nodes: Vec<u64>,
        axis: Option<Box<Axis>>,
    ) -> Option<()> {
        let name = match self.names.iter().position(|own| own == fields.name()) {
            Some(at) => at as u32,
            None => {
                self.names.push(fields.name().to_string());
                self.names.len() as u32 - 1
            }
        };
        self.table.push(number, fields.place(), Raw { name, of, nodes: nodes.into_boxed_slice(), axis });
        Some(())
    }

    /// Puts the elements into the deck.
    pub fn resolve(&mut self, model: &mut Model) {
        let mut table = std::mem::take(&mut self.table);
        table.sort("element", model.notes);
        let mut middles = Middles::default();
        model.rotates = vec![false; model.deck.nodes.len()];
        for row in table.rows() {
            let name = self.names[row.value.name as usize].as_str();
            let Some((kind, mut nodes)) =
                shape(name, row.number, row.place, &row.value.nodes, &mut middles, model)
            else {
                model.other_elements.insert(row.number);
                continue;
            };
            if turn::right_handed(kind, &mut nodes, |node| model.position(node)) {
                let why = "nodes of solids that are counted the other way round are turned";
                model.notes.ledger.note(Weight::Nothing, name, why, row.place);
            }
            if kind.dimension() < 3 && !matches!(name, "CROD" | "CONROD" | "CTUBE") {
                nodes.iter().for_each(|node| model.rotates[*node] = true);
            }
            let direction =
                row.value.axis.as_deref().and_then(|axis| axis.direction(nodes[0], name, row.place, model));
            self.made_of.push((row.value.of.clone(), direction));
            model.elements.push(row.number, row.place, ());
            let element =
                Element { number: row.number, kind, type_name: row.value.name, nodes, place: row.place };
            model.deck.elements.push(element);
        }
        middles.equations(model);
        model.deck.type_names = std::mem::take(&mut self.names);
    }
}

/// THETA or MCID, ZOFFS, and thicknesses at the corners.
fn shell_fields(fields: &mut Fields, name: &str, nodes: usize) {
    let theta = match name {
        "CQUAD8" => 15,
        _ => 3 + nodes,
    };
    let corners = if nodes.is_multiple_of(3) { 3 } else { 4 };
    fields.unread(
        theta,
        theta,
        Weight::Perhaps,
        "the direction of its material is not read: that of isotropic ones is none",
    );
    fields.unread(theta + 1, theta + 1, Weight::Matters, "the offset of its middle is not read");
    let flag = if name == "CQUAD8" {
        17
    } else if name == "CTRIA6" {
        14
    } else {
        10
    };
    fields.unread(flag, flag, Weight::Perhaps, "thicknesses relative to the property's are not read");
    fields.unread(
        11,
        10 + corners,
        Weight::Matters,
        "thicknesses at corners are not read: that of the property holds",
    );
}

/// The kind of an element, and its nodes in the order of that.
fn shape(
    name: &str,
    number: u64,
    place: Place,
    file: &[u64],
    middles: &mut Middles,
    model: &mut Model,
) -> Option<(CellKind, Vec<usize>)> {
    let (corners, _) = numbers_of_nodes(name);
    let complete = file[corners..].iter().all(|id| *id == 0);
    let (name, file) = if complete { (first_order(name), &file[..corners]) } else { (name, file) };
    let (kind, ids) = CellKind::of_file(Program::Nastran, name, file)?;
    let mut sorted: Vec<u64> = ids.iter().copied().filter(|id| *id > 0).collect();
    sorted.sort_unstable();
    if let Some(pair) = sorted.windows(2).find(|pair| pair[0] == pair[1]) {
        let found = format!("grid point {} twice in {name} {number}", pair[0]);
        model.notes.files.fault(place, found, "nodes of an element that differ");
        return None;
    }
    let found: Vec<Option<usize>> =
        ids.iter().map(|id| if *id == 0 { None } else { model.node(*id, name, place) }).collect();
    let mut nodes = Vec::with_capacity(ids.len());
    for (k, id) in ids.iter().enumerate() {
        nodes.push(match (found[k], id) {
            (Some(node), _) => node,
            (None, 0) => {
                let [a, b] = *kind.table().middles[k] else { return None };
                let (a, b) = (found[usize::from(a)]?, found[usize::from(b)]?);
                middles.node(a.min(b), a.max(b), place, model)
            }
            _ => return None,
        });
    }
    Some((kind, nodes))
}

/// Nodes in the middle of straight edges, whose elements leave them out: they move as the mean of the corners, u = (u₁ + u₂)/2.
#[derive(Default)]
struct Middles(BTreeMap<(usize, usize), (usize, Place)>);

impl Middles {
    fn node(&mut self, a: usize, b: usize, place: Place, model: &mut Model) -> usize {
        if let Some((node, _)) = self.0.get(&(a, b)) {
            return *node;
        }
        let (p, q) = (model.position(a), model.position(b));
        let why = "a middle node that is left out is one that moves as the mean of the corners beside it";
        model.notes.ledger.note(Weight::Nothing, "elements", why, place);
        let node = model.add_node(std::array::from_fn(|k| 0.5 * (p[k] + q[k])), place);
        self.0.insert((a, b), (node, place));
        node
    }

    fn equations(self, model: &mut Model) {
        for ((a, b), (node, place)) in self.0 {
            for dof in 0..if model.rotates[node] { 6 } else { 3 } {
                model.equation(vec![(node, dof, 1.0), (a, dof, -0.5), (b, dof, -0.5)], place);
            }
        }
    }
}
