//! Concentrated masses: CONM1, CONM2.

use super::fields::Fields;
use super::model::Model;
use super::parameters::Parameters;
use super::table::{Row, Table};
use crate::deck::{Coupling, CouplingKind, PointMass};
use crate::ledger::Weight;
use std::collections::BTreeSet;
use stridor_mesh::quality::minus;

/// A mass as its card has it.
#[derive(Debug, Clone, PartialEq)]
struct Raw {
    card: &'static str,
    point: u64,
    /// The system of its moments of inertia.
    system: u64,
    mass: f64,
    /// From the grid point to its centre, in that system; of system −1 the place of the centre.
    offset: [f64; 3],
    is_place: bool,
    /// The tensor of inertia, symmetric.
    inertia: [[f64; 3]; 3],
}

#[derive(Debug, Default)]
pub(super) struct Masses {
    table: Table<Raw>,
}

impl Masses {
    pub fn card(&mut self, fields: &mut Fields) -> Option<()> {
        let (number, point) = (fields.id(1)?, fields.id(2)?);
        let raw =
            if fields.name() == "CONM1" { by_matrix(fields, point)? } else { by_inertia(fields, point)? };
        self.table.push(number, fields.place(), raw);
        Some(())
    }

    /// The numbers of all masses.
    pub fn numbers(&self, numbers: &mut BTreeSet<u64>) {
        numbers.extend(self.table.rows().iter().map(|row| row.number));
    }

    pub fn resolve(mut self, parameters: &Parameters, model: &mut Model) {
        self.table.sort("mass", model.notes);
        let references: BTreeSet<usize> =
            model.deck.couplings.iter().map(|coupling| coupling.reference).collect();
        for row in self.table.rows() {
            let raw = &row.value;
            let Some(node) = model.node(raw.point, raw.card, row.place) else { continue };
            let Some(axes) = model.frames.get(raw.system, row.place, model.notes) else { continue };
            let unit = axes.directions(model.position(node));
            // J = Σ J_kl e_k e_l.
            let turned = |i: usize, j: usize| -> f64 {
                let row = |k: usize| (0..3).map(|l| raw.inertia[k][l] * unit[k][i] * unit[l][j]).sum::<f64>();
                (0..3).map(row).sum()
            };
            let inertia = [0, 1, 2].map(|k| turned(k, k));
            let size: f64 = inertia.iter().map(|x| x.abs()).sum();
            if [(0, 1), (0, 2), (1, 2)].iter().any(|(i, j)| turned(*i, *j).abs() > 1e-9 * size) {
                let why = "products of inertia about the directions of the coordinates are not read";
                model.notes.ledger.note(Weight::Matters, raw.card, why, row.place);
            }
            let at = model.position(node);
            let offset = if raw.is_place { minus(raw.offset, at) } else { axes.vector(raw.offset, at) };
            let node = centre(node, offset, row, &references, model);
            let factor = parameters.mass_factor();
            model.deck.masses.push(PointMass {
                name: format!("{}_{}", raw.card, row.number),
                nodes: vec![node],
                mass: factor * raw.mass,
                inertia: inertia.map(|x| factor * x),
                place: row.place,
            });
        }
    }
}

/// The node of the centre of a mass: a new one, which moves with the grid point as a rigid body, where it is beside one that turns.
fn centre(
    node: usize,
    offset: [f64; 3],
    row: &Row<Raw>,
    references: &BTreeSet<usize>,
    model: &mut Model,
) -> usize {
    if offset == [0.0; 3] {
        return node;
    }
    let turns = model.rotates.get(node).is_some_and(|turns| *turns) || references.contains(&node);
    if !turns {
        let why = "the offset of a mass from a grid point that nothing turns is not read";
        model.notes.ledger.note(Weight::Matters, row.value.card, why, row.place);
        return node;
    }
    let at = model.position(node);
    let centre = model.add_node(std::array::from_fn(|k| at[k] + offset[k]), row.place);
    model.deck.couplings.push(Coupling {
        name: format!("{}_{}_offset", row.value.card, row.number),
        reference: node,
        nodes: vec![centre],
        of: None,
        kind: CouplingKind::Rigid,
        place: row.place,
    });
    centre
}

/// CONM2: mass, offset of its centre, and I₁₁, I₂₁, I₂₂, I₃₁, I₃₂, I₃₃ of which those beside the diagonal are ∫xᵢxⱼ dm.
fn by_inertia(fields: &mut Fields, point: u64) -> Option<Raw> {
    let system = fields.integer_or(3, 0)?;
    let is_place = system == -1;
    let mass = fields.real_or(4, 0.0)?;
    let offset = fields.vector(5)?;
    let [i11, i21, i22, i31, i32, i33] = [9, 10, 11, 12, 13, 14].map(|k| fields.real_or(k, 0.0));
    let (i11, i21, i22, i31, i32, i33) = (i11?, i21?, i22?, i31?, i32?, i33?);
    let inertia = [[i11, -i21, -i31], [-i21, i22, -i32], [-i31, -i32, i33]];
    let system = u64::try_from(system).unwrap_or(0);
    Some(Raw { card: "CONM2", point, system, mass, offset, is_place, inertia })
}

/// CONM1: the lower triangle of a matrix of six by rows.
fn by_matrix(fields: &mut Fields, point: u64) -> Option<Raw> {
    let system = fields.id_or(3, 0)?;
    let m = fields.symmetric(4, false)?;
    let mass = m[0][0];
    let alike = (0..3).all(|k| m[k][k] == mass);
    let couples = (0..6).any(|i| (0..6).any(|j| i != j && (i < 3 || j < 3) && m[i][j] != 0.0));
    if !alike || couples {
        fields.note(
            Weight::Matters,
            "masses that differ by direction, or couple them, are not read: that along the first axis holds",
        );
    }
    let inertia = std::array::from_fn(|i| std::array::from_fn(|j| m[3 + i][3 + j]));
    Some(Raw { card: "CONM1", point, system, mass, offset: [0.0; 3], is_place: false, inertia })
}
