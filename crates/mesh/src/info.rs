//! Summary of a mesh in a few lines.

use super::check::{Diagnosis, bounds, count_pieces, diagnose};
use super::jacobian::measure;
use super::quality::{face_shape, minus, norm};
use super::{Cell, CellKind, Mesh, made_of};
use std::fmt;

/// Summary of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Info {
    /// Number of nodes.
    pub n_nodes: usize,
    /// The kinds of cells that it has, with their numbers.
    pub cells: Vec<(CellKind, usize)>,
    /// Corners of the bounding box \[m\]; zero without nodes.
    pub bounds: [[f64; 3]; 2],
    /// Summary of each region.
    pub regions: Vec<RegionInfo>,
    /// Smallest corner angle of all faces \[degrees\]; `None` without faces.
    pub smallest_angle_deg: Option<f64>,
    /// Faults and warnings.
    pub diagnosis: Diagnosis,
}

/// Summary of a region.
#[derive(Debug, Clone, PartialEq)]
pub struct RegionInfo {
    /// Its name.
    pub name: String,
    /// 0 points, 1 lines, 2 faces, 3 solids.
    pub dimension: usize,
    /// Number of its elements.
    pub n_elements: usize,
    /// Number of the nodes they use.
    pub n_nodes: usize,
    /// Pieces that share no node.
    pub pieces: usize,
    /// Its length \[m\], area \[m²\] or volume \[m³\]; 0 for points.
    pub measure: f64,
    /// Shortest and longest edge \[m\]; zero for points.
    pub edges: [f64; 2],
}

impl Info {
    /// Sums up `mesh`. Indices out of range are left to the diagnosis: such a mesh shows its faults and no regions.
    pub fn of(mesh: &Mesh) -> Self {
        let count = |kind: CellKind| mesh.elements.iter().filter(|e| e.kind() == kind).count();
        let broken = mesh.elements.iter().any(|e| e.nodes().iter().any(|n| *n >= mesh.nodes.len()));
        let angles = mesh.elements.iter().filter(|_| !broken).filter_map(|e| face_shape(mesh, e));
        Info {
            n_nodes: mesh.nodes.len(),
            cells: CellKind::all().map(|kind| (kind, count(kind))).filter(|(_, n)| *n > 0).collect(),
            bounds: bounds(mesh).unwrap_or_default(),
            regions: if broken { vec![] } else { region_infos(mesh) },
            smallest_angle_deg: angles.map(|s| s.angles[0].to_degrees()).min_by(f64::total_cmp),
            diagnosis: diagnose(mesh),
        }
    }
}

fn region_infos(mesh: &Mesh) -> Vec<RegionInfo> {
    let info = |region: &super::Region| {
        let mut whole = 0.0;
        let mut edges = [f64::INFINITY, 0.0];
        for e in &region.elements {
            let element = &mesh.elements[*e];
            let shape = match element.corners() {
                [i, j] if element.dimension() == 1 => {
                    let length = norm(minus(mesh.nodes[*i], mesh.nodes[*j]));
                    Some((length, [length; 2]))
                }
                _ if element.kind().is_first_order() && element.dimension() == 2 => {
                    face_shape(mesh, element).map(|s| (s.area, s.edges))
                }
                _ if element.dimension() > 0 => Some((measure(mesh, element), edge_lengths(mesh, element))),
                _ => None,
            };
            if let Some((size, [short, long])) = shape {
                whole += size;
                edges = [edges[0].min(short), edges[1].max(long)];
            }
        }
        RegionInfo {
            name: region.name.clone(),
            dimension: region.dimension,
            n_elements: region.elements.len(),
            n_nodes: mesh.region_nodes(region).len(),
            pieces: count_pieces(mesh, region),
            measure: whole,
            edges: if edges[1] > 0.0 { edges } else { [0.0; 2] },
        }
    };
    mesh.regions.iter().map(info).collect()
}

/// Shortest and longest straight line between two corners of an edge \[m\].
fn edge_lengths(mesh: &Mesh, cell: &Cell) -> [f64; 2] {
    let length = |edge: Cell| edge.ends().map_or(0.0, |[i, j]| norm(minus(mesh.nodes[i], mesh.nodes[j])));
    let edges: Vec<Cell> = match cell.dimension() {
        3 => cell.sides().flat_map(|side| side.sides().collect::<Vec<_>>()).collect(),
        2 => cell.sides().collect(),
        _ => vec![cell.clone()],
    };
    edges.into_iter().map(length).fold([f64::INFINITY, 0.0], |[low, high], l| [low.min(l), high.max(l)])
}

impl fmt::Display for Info {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let of = |(kind, n): &(CellKind, usize)| format!(", {n} {}", kind.plural());
        let cells: String = self.cells.iter().rev().map(of).collect();
        writeln!(f, "{} nodes{cells}", self.n_nodes)?;
        let [low, high] = self.bounds;
        let mm = |k: usize| format!("{} = {:.3} … {:.3}", ["x", "y", "z"][k], 1e3 * low[k], 1e3 * high[k]);
        writeln!(f, "bounding box (mm): {}, {}, {}", mm(0), mm(1), mm(2))?;
        if let Some(angle) = self.smallest_angle_deg {
            writeln!(f, "smallest angle: {angle:.1}°")?;
        }
        let width = self.regions.iter().map(|r| r.name.chars().count()).max().unwrap_or(0).max(6);
        writeln!(
            f,
            "{:width$}  kind     elements    nodes  pieces  length, area or volume     edges (mm)",
            "region"
        )?;
        for r in &self.regions {
            let kind = made_of(r.dimension);
            let measure = match r.dimension {
                1 => format!("{:.3} mm", 1e3 * r.measure),
                2 => format!("{:.2} mm²", 1e6 * r.measure),
                3 => format!("{:.2} mm³", 1e9 * r.measure),
                _ => String::new(),
            };
            let edges = if r.dimension > 0 {
                format!("{:.3} … {:.3}", 1e3 * r.edges[0], 1e3 * r.edges[1])
            } else {
                String::new()
            };
            let line = format!(
                "{:width$}  {kind:7} {:9} {:8} {:7}  {measure:>22}  {edges:>13}",
                r.name, r.n_elements, r.n_nodes, r.pieces
            );
            writeln!(f, "{}", line.trim_end())?;
        }
        for fault in &self.diagnosis.faults.0 {
            writeln!(f, "fault: {fault}")?;
        }
        for warning in &self.diagnosis.warnings {
            writeln!(f, "warning: {warning}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::{Faces, structured_box, structured_plate};
    use stridor_base::bounds::{Origin::*, within};

    #[test]
    fn the_sums_of_a_plate_are_its_area_and_perimeter() {
        let mesh = structured_plate(2.0, 1.0, 4, 2, Faces::Triangles).unwrap();
        let info = Info::of(&mesh);
        assert_eq!(
            (info.n_nodes, &info.cells),
            (15, &vec![(CellKind::Line2, 12), (CellKind::Triangle3, 16)])
        );
        assert!(within((info.regions[0].measure - 2.0).abs(), 1e-14, RoundOff));
        assert!(within(
            (info.regions[1..].iter().map(|r| r.measure).sum::<f64>() - 6.0).abs(),
            1e-14,
            RoundOff
        ));
        assert_eq!(info.regions[0].edges, [0.5, 0.5f64.hypot(0.5)]);
        assert!(within((info.smallest_angle_deg.unwrap() - 45.0).abs(), 1e-12, RoundOff));
        let solid = structured_box(CellKind::Tetrahedron10, [2.0, 1.0, 0.5], [4, 2, 1]).unwrap();
        let info_of_solid = Info::of(&solid);
        assert!(within((info_of_solid.regions[0].measure - 1.0).abs(), 1e-14, RoundOff));
        assert_eq!(info_of_solid.regions[0].edges, [0.5, 0.75_f64.sqrt()]);
        assert!(within(
            (info_of_solid.regions[1..].iter().map(|r| r.measure).sum::<f64>() - 7.0).abs(),
            1e-13,
            RoundOff
        ));
        let text = info.to_string();
        assert!(text.contains("15 nodes") && text.contains("plate_edge_x_min"), "{text}");
    }
}
