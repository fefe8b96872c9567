//! Where the points of a test are on the mesh, and what it would measure there.

use super::prepared::Prepared;
use crate::case::{MeasuredData, ModesAnalysis};
use crate::error::{Error, Fault, Faults, Result};
use crate::linalg::SparseVector;
use crate::measured::MeasuredSet;
use crate::measured::geometry::{Frame, dot, largest_and_mean, nearest};
use crate::results::Placed;
use crate::structure::DofMap;
use nalgebra::Vector3;

/// Most points off the mesh that are reported one by one.
const LISTED: usize = 10;

/// The degrees of freedom of a test's shapes, in the mesh.
#[derive(Debug, Clone)]
pub struct Sensors {
    /// Where each point is \[m\].
    points: Vec<[f64; 3]>,
    /// For each degree of freedom its point and its direction.
    dofs: Vec<(usize, [f64; 3])>,
    /// For each point the node that it moves with.
    nodes: Vec<usize>,
    /// How far the points are from their nodes.
    pub placed: Placed,
}

impl Sensors {
    /// The degrees of freedom of the shapes of `set`, which is `[measured.NAME]`, on the parts of an analysis.
    ///
    /// # Errors
    /// A mesh without coordinates, and every point that lies off it.
    pub fn new(
        prepared: &Prepared<'_>,
        name: &str,
        data: &MeasuredData,
        set: &MeasuredSet,
        of: &ModesAnalysis,
    ) -> Result<Sensors> {
        let place = format!("`measured.{name}`");
        let among = nodes_of(prepared, of);
        if among.is_empty() {
            let fault = Fault::new(place, "mode shapes", "a case whose nodes have coordinates");
            return Err(Error::input(fault.with_help("`matrices.dofs` may give them")));
        }
        let frame = frame(data);
        // The points that a shape moves, each once.
        let mut used: Vec<usize> = set.dofs.iter().map(|dof| dof.point).collect();
        used.dedup();
        let points: Vec<[f64; 3]> =
            used.iter().map(|point| frame.point(set.points[*point].position)).collect();
        let found = nearest(&points, &prepared.model.nodes, &among);
        let mut faults = Faults::new();
        let far = || used.iter().zip(&points).zip(&found).filter(|(_, (_, away))| *away > data.reach);
        for ((point, at), (_, away)) in far().take(LISTED) {
            let [x, y, z] = at.map(|c| 1e3 * c);
            let words = format!(
                "point {} at ({x:.1}, {y:.1}, {z:.1}) mm of the mesh, {:.1} mm from the nearest node",
                set.points[*point].id,
                1e3 * away
            );
            let expected = format!("a node within the `reach` of {:.1} mm", 1e3 * data.reach);
            let help = "Look at `transform`: origin, axes and the unit of the test";
            faults.push(Fault::new(&*place, words, expected).with_help(help));
        }
        let more = far().count().saturating_sub(LISTED);
        if more > 0 {
            faults.push(Fault::new(
                &*place,
                format!("{more} points more beyond `reach`"),
                "points on the mesh",
            ));
        }
        faults.into_result(())?;
        let point = |of: usize| used.binary_search(&of).unwrap_or_default();
        let dofs: Vec<(usize, [f64; 3])> =
            set.dofs.iter().map(|dof| (point(dof.point), frame.direction(dof.direction))).collect();
        let [largest, mean] = largest_and_mean(found.iter().map(|(_, away)| *away));
        let placed = Placed { points: points.len(), dofs: dofs.len(), largest, mean };
        Ok(Sensors { points, dofs, nodes: found.into_iter().map(|(node, _)| node).collect(), placed })
    }

    /// The same points on another mesh.
    pub fn on(&self, prepared: &Prepared<'_>, of: &ModesAnalysis) -> Sensors {
        let found = nearest(&self.points, &prepared.model.nodes, &nodes_of(prepared, of));
        Sensors { nodes: found.into_iter().map(|(node, _)| node).collect(), ..self.clone() }
    }

    /// For each degree of freedom its node, its direction, and the way from the node to the point.
    fn each<'a>(
        &'a self,
        nodes: &'a [[f64; 3]],
    ) -> impl Iterator<Item = (usize, Vector3<f64>, Vector3<f64>)> + 'a {
        self.dofs.iter().map(|(point, direction)| {
            let node = self.nodes[*point];
            let arm = Vector3::from(self.points[*point]) - Vector3::from(nodes[node]);
            (node, Vector3::from(*direction), arm)
        })
    }

    /// Displacement measured at each degree of freedom, d·(u + θ × a), of a nodal field (u, θ) on the `nodes`, with the vector
    /// a from the node to the point; exact to a² for a plate or a bar.
    pub fn motions(&self, nodes: &[[f64; 3]], field: &[[f64; 6]]) -> Vec<f64> {
        let motion = |(node, direction, arm): (usize, Vector3<f64>, Vector3<f64>)| {
            let [x, y, z, a, b, c] = field[node];
            let moved = Vector3::new(x, y, z) + Vector3::new(a, b, c).cross(&arm);
            dot(direction.into(), moved.into())
        };
        self.each(nodes).map(motion).collect()
    }

    /// The same as linear forms of the degrees of freedom of a structure: θ·(a × d) is θ × a along d.
    pub fn forms(&self, nodes: &[[f64; 3]], dofs: &DofMap) -> Vec<SparseVector> {
        let form = |(node, direction, arm): (usize, Vector3<f64>, Vector3<f64>)| {
            let turned = arm.cross(&direction);
            let entries: Vec<(usize, usize, f64)> = (0..3)
                .flat_map(|axis| [(node, axis, direction[axis]), (node, 3 + axis, turned[axis])])
                .collect();
            dofs.reduce(&entries)
        };
        self.each(nodes).map(form).collect()
    }
}

/// Where the frame of a test lies in the mesh.
pub fn frame(data: &MeasuredData) -> Frame {
    Frame::new(data.transform.origin, data.transform.x_axis, data.transform.y_axis)
}

/// The nodes of the parts that an analysis is of.
fn nodes_of(prepared: &Prepared<'_>, analysis: &ModesAnalysis) -> Vec<usize> {
    let geometry = prepared.geometry();
    if prepared.model.nodes.is_empty() {
        return Vec::new();
    }
    let own = |part: &usize| analysis.parts.is_empty() || analysis.parts.contains(&geometry.parts[*part]);
    let cells = geometry.cells.iter().zip(&geometry.part_of_cell).filter(|(_, part)| own(part));
    let mut nodes: Vec<usize> = cells.flat_map(|(cell, _)| cell.nodes().iter().copied()).collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}
