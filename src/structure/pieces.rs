//! Everything of a model that gives matrices, one after the other in a fixed order.

use super::elements::{Beam, FlatShell, mass_diagonal, split_face, spring_direction};
use super::material::RayleighDamping;
use super::model::{BarPart, Model, PointMass, ShellPart, Spring};
use nalgebra::{SMatrix, SVector};

/// One contributor to the matrices.
#[derive(Debug, Clone, Copy)]
pub(super) enum Piece<'a> {
    Triangle { part: &'a ShellPart, nodes: [usize; 3], weight: f64 },
    Bar { part: &'a BarPart, nodes: [usize; 2] },
    Mass(&'a PointMass),
    Spring(&'a Spring),
}

/// The matrices of a piece on the six degrees of freedom of its nodes (at most three; the rest is zero).
#[derive(Debug, Clone)]
pub(super) struct PieceMatrices {
    pub mass: SMatrix<f64, 18, 18>,
    pub stiffness: SMatrix<f64, 18, 18>,
    /// Rayleigh damping and dashpots; `None` where there is none.
    pub viscous: Option<SMatrix<f64, 18, 18>>,
    /// η K.
    pub hysteretic: Option<SMatrix<f64, 18, 18>>,
}

/// The pieces of `model` in order: shells, bars, masses, springs.
pub(super) fn pieces(model: &Model) -> Vec<Piece<'_>> {
    let triangles = model.shells.iter().flat_map(|part| {
        part.faces.iter().flat_map(split_face).map(move |t| Piece::Triangle {
            part,
            nodes: t.nodes,
            weight: t.weight,
        })
    });
    let bars = model
        .bars
        .iter()
        .flat_map(|part| part.elements.iter().map(move |nodes| Piece::Bar { part, nodes: *nodes }));
    triangles
        .chain(bars)
        .chain(model.masses.iter().map(Piece::Mass))
        .chain(model.springs.iter().map(Piece::Spring))
        .collect()
}

impl Piece<'_> {
    /// The nodes of the piece.
    pub fn nodes(&self) -> impl Iterator<Item = usize> {
        let (nodes, count) = match *self {
            Piece::Triangle { nodes, .. } => (nodes, 3),
            Piece::Bar { nodes: [a, b], .. } => ([a, b, 0], 2),
            Piece::Mass(point) => ([point.node, 0, 0], 1),
            Piece::Spring(spring) => {
                ([spring.node, spring.other.unwrap_or(0), 0], 1 + usize::from(spring.other.is_some()))
            }
        };
        nodes.into_iter().take(count)
    }

    /// M, K, C of the piece; its geometry has been checked.
    pub fn matrices(&self, coordinates: &[[f64; 3]]) -> PieceMatrices {
        match *self {
            Piece::Triangle { part, nodes, weight } => {
                let shell = FlatShell::new(&nodes.map(|n| coordinates[n])).expect("checked: it has an area");
                let k = shell.stiffness(&part.material, part.thickness, part.bending_only) * weight;
                let m =
                    shell.mass(part.material.density, part.thickness, part.rotary_inertia, part.bending_only)
                        * weight;
                damped(m, k, part.material.rayleigh, part.material.loss_factor)
            }
            Piece::Bar { part, nodes } => {
                let beam = Beam::new(&nodes.map(|n| coordinates[n]), part.orientation)
                    .expect("checked: it has a length and an orientation");
                let k = beam.stiffness(&part.material, &part.section);
                let m = beam.mass(part.material.density, &part.section);
                damped(padded(&m), padded(&k), part.material.rayleigh, part.material.loss_factor)
            }
            Piece::Mass(point) => {
                let mut mass = SMatrix::zeros();
                for (k, m) in mass_diagonal(point).into_iter().enumerate() {
                    mass[(k, k)] = m;
                }
                PieceMatrices { mass, stiffness: SMatrix::zeros(), viscous: None, hysteretic: None }
            }
            Piece::Spring(spring) => {
                let a = spring_direction(spring).expect("checked: it has a direction");
                let mut b = SVector::<f64, 18>::zeros();
                b.fixed_rows_mut::<6>(0).copy_from_slice(&a);
                if spring.other.is_some() {
                    b.fixed_rows_mut::<6>(6).copy_from_slice(&a.map(|x| -x));
                }
                let dyad = b * b.transpose();
                PieceMatrices {
                    mass: SMatrix::zeros(),
                    stiffness: dyad * spring.stiffness,
                    viscous: (spring.damping != 0.0).then(|| dyad * spring.damping),
                    hysteretic: None,
                }
            }
        }
    }

    /// K_σ of the piece under the displacement of all nodes; `None` for one that carries no membrane or axial force.
    pub fn geometric_stiffness(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[[f64; 6]],
    ) -> Option<SMatrix<f64, 18, 18>> {
        match *self {
            Piece::Triangle { part, nodes, weight } if !part.bending_only => {
                let shell = FlatShell::new(&nodes.map(|n| coordinates[n])).expect("checked: it has an area");
                let u = nodes.map(|n| displacement[n]);
                let forces = shell.membrane_forces(&part.material, part.thickness, &u);
                Some(shell.geometric_stiffness(forces) * weight)
            }
            Piece::Bar { part, nodes } => {
                let beam = Beam::new(&nodes.map(|n| coordinates[n]), part.orientation)
                    .expect("checked: it has a length and an orientation");
                let force = beam.axial_force(&part.material, &part.section, &nodes.map(|n| displacement[n]));
                Some(padded(&beam.geometric_stiffness(force)))
            }
            _ => None,
        }
    }

    /// Mass \[kg\] and its centre \[m\].
    pub fn mass_and_center(&self, coordinates: &[[f64; 3]]) -> (f64, [f64; 3]) {
        let nodes: Vec<[f64; 3]> = self.nodes().map(|n| coordinates[n]).collect();
        let center = std::array::from_fn(|k| nodes.iter().map(|x| x[k]).sum::<f64>() / nodes.len() as f64);
        let mass = match *self {
            Piece::Triangle { part, nodes, weight } => {
                let area = FlatShell::new(&nodes.map(|n| coordinates[n])).map_or(0.0, |s| s.triangle().area);
                part.material.density * part.thickness * area * weight
            }
            Piece::Bar { part, nodes } => {
                let length =
                    Beam::new(&nodes.map(|n| coordinates[n]), part.orientation).map_or(0.0, |b| b.length());
                part.material.density * part.section.area * length
            }
            Piece::Mass(point) => point.mass,
            Piece::Spring(_) => 0.0,
        };
        (mass, center)
    }
}

fn damped(
    mass: SMatrix<f64, 18, 18>,
    stiffness: SMatrix<f64, 18, 18>,
    rayleigh: RayleighDamping,
    loss_factor: f64,
) -> PieceMatrices {
    let viscous =
        (rayleigh != RayleighDamping::default()).then(|| mass * rayleigh.alpha + stiffness * rayleigh.beta);
    let hysteretic = (loss_factor != 0.0).then(|| stiffness * loss_factor);
    PieceMatrices { mass, stiffness, viscous, hysteretic }
}

fn padded(small: &SMatrix<f64, 12, 12>) -> SMatrix<f64, 18, 18> {
    let mut whole = SMatrix::<f64, 18, 18>::zeros();
    whole.fixed_view_mut::<12, 12>(0, 0).copy_from(small);
    whole
}
