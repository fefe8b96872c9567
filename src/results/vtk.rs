//! ParaView files: the mesh in its rest position with one vector array a mode (`.vtu`, binary XML).
//!
//! Real modes are `mode_01`, `mode_02` … \[1/√kg\], mass-normalised. Complex modes are `mode_01_re` and `mode_01_im`:
//! the motion is Re(φ e^{iωt}) = re cos ωt − im sin ωt, which ParaView's calculator animates. The cell array `part`
//! counts the parts from 0 in the order of the case.
//!
//! `contact.vtu` has the faces that carry contact points, with the cell arrays `pressure` \[Pa\] and `status`: 0 open, 1 sticking, 2 sliding; its `part`
//! counts the surfaces that are connected, such as those of two pads.

use super::folder::{FileNames, refusal};
use super::{
    ComplexResult, Geometry, ModeSensitivity, NamedModes, NodalField, RunResults, SensitivityResult,
    SteadyResult, write_result,
};
use crate::error::Result;
use crate::linalg::c64;
use crate::mesh::Cell;
use std::path::Path;
use vtkio::model::{
    Attribute, Attributes, ByteOrder, CellType, Cells, DataSet, IOBuffer, UnstructuredGridPiece, Version,
    VertexNumbers, Vtk,
};

/// A named vector at every node.
type PointVector = (String, Vec<[f64; 3]>);

/// A named number at every node.
type PointScalar = (String, Vec<f64>);

/// Writes `modes_<set>.vtu` for every set of real modes, `steady.vtu`, `complex_modes.vtu` and `advice.vtu`,
/// those of them that the run has, into the folder `dir`. Without a mesh (the two-degree-of-freedom model) nothing is written.
///
/// # Errors
/// [`crate::error::Error::Io`] when the folder cannot be made or a file not be written.
pub fn write_vtk(dir: &Path, results: &RunResults) -> Result<()> {
    let geometry = &results.geometry;
    if geometry.elements.is_empty() {
        return Ok(());
    }
    let mut names = FileNames::default();
    for set in results.all::<NamedModes>() {
        let vectors = numbered(set.modes.len(), |k, number| vec![(number, displacement(&set.shape(k)))]);
        write_grid(dir, &format!("modes_{}.vtu", names.next(&set.name)), geometry, vectors)?;
    }
    if let Some(steady) = results.get::<SteadyResult>() {
        let vectors = vec![("displacement".to_string(), displacement(&steady.displacement))];
        write_grid(dir, "steady.vtu", geometry, vectors)?;
        let (nodes, surfaces, values) = steady.pressed_faces(&geometry.nodes);
        if !surfaces.is_empty() {
            let (pressure, status) = values.into_iter().unzip::<f64, i32, Vec<f64>, Vec<i32>>();
            let cell = vec![scalar("pressure", pressure), scalar("status", status)];
            write_arrays(dir, "contact.vtu", &Geometry::new(nodes, surfaces), [Vec::new(), cell])?;
        }
    }
    if let Some(complex) = results.get::<ComplexResult>() {
        let vectors = numbered(complex.modes.modes.len(), |k, number| {
            let [re, im] = real_and_imaginary(&complex.shape(k));
            vec![(format!("{number}_re"), re), (format!("{number}_im"), im)]
        });
        write_grid(dir, "complex_modes.vtu", geometry, vectors)?;
    }
    if let Some(sensitivity) = results.get::<SensitivityResult>() {
        let fields: Vec<PointScalar> = sensitivity.modes.iter().flat_map(advice).collect();
        if !fields.is_empty() {
            let fields = fields.into_iter().map(|(name, values)| scalar(name, values)).collect();
            write_arrays(dir, "advice.vtu", geometry, [fields, Vec::new()])?;
        }
    }
    Ok(())
}

/// The vectors of `modes` modes, named `mode_01`, `mode_02` … (more digits when there are more than 99).
fn numbered(modes: usize, vectors: impl Fn(usize, String) -> Vec<PointVector>) -> Vec<PointVector> {
    let width = modes.to_string().len().max(2);
    (0..modes).flat_map(|k| vectors(k, format!("mode_{:0width$}", k + 1))).collect()
}

fn displacement(shape: &NodalField<f64>) -> Vec<[f64; 3]> {
    shape.iter().map(|u| [u[0], u[1], u[2]]).collect()
}

fn real_and_imaginary(shape: &NodalField<c64>) -> [Vec<[f64; 3]>; 2] {
    [
        shape.iter().map(|u| [u[0].re, u[1].re, u[2].re]).collect(),
        shape.iter().map(|u| [u[0].im, u[1].im, u[2].im]).collect(),
    ]
}

/// Change of σ \[1/s\] and of the frequency \[Hz\] for one gram of mass and for one N s/m of damping at each node.
fn advice(mode: &ModeSensitivity) -> Vec<PointScalar> {
    let Some(field) = &mode.advice else { return Vec::new() };
    let name = |what: &str| format!("mode_{:02}_{what}", mode.mode + 1);
    let hz = 1.0 / std::f64::consts::TAU;
    let damper = |axis: usize| field.damping.iter().map(|d| d[axis].re).collect::<Vec<f64>>();
    let mut fields = vec![
        (name("growth_per_gram"), field.mass.iter().map(|m| 1e-3 * m.re).collect()),
        (name("hz_per_gram"), field.mass.iter().map(|m| 1e-3 * hz * m.im).collect()),
    ];
    for (axis, direction) in ["x", "y", "z", "normal"].into_iter().enumerate() {
        fields.push((name(&format!("growth_per_damper_{direction}")), damper(axis)));
        let spring = field.stiffness.iter().map(|k| 1e3 * k[axis].re).collect();
        fields.push((name(&format!("growth_per_kN_per_m_{direction}")), spring));
    }
    fields
}

fn scalar<T>(name: impl Into<String>, values: Vec<T>) -> Attribute
where
    IOBuffer: From<Vec<T>>,
{
    Attribute::DataArray(vtkio::model::DataArray::scalars(name, 1).with_data(values))
}

fn write_grid(dir: &Path, name: &str, geometry: &Geometry, vectors: Vec<PointVector>) -> Result<()> {
    let vector = |(name, values): PointVector| {
        Attribute::DataArray(vtkio::model::DataArray::vectors(name).with_data(flatten(&values)))
    };
    write_arrays(dir, name, geometry, [vectors.into_iter().map(vector).collect(), Vec::new()])
}

/// Arrays of the points and of the cells.
fn write_arrays(
    dir: &Path,
    name: &str,
    geometry: &Geometry,
    [point, mut cell]: [Vec<Attribute>; 2],
) -> Result<()> {
    let part: Vec<i32> = geometry.part_of_cell.iter().map(|p| *p as i32).collect();
    cell.push(scalar("part", part));
    let data = Attributes { point, cell };
    let piece =
        UnstructuredGridPiece { points: flatten(&geometry.nodes).into(), cells: cells(geometry), data };
    let grid = Vtk {
        version: Version::new_xml(1, 0),
        title: String::new(),
        byte_order: ByteOrder::LittleEndian,
        file_path: None,
        data: DataSet::inline(piece),
    };
    let mut bytes = Vec::new();
    grid.write_xml(&mut bytes).map_err(|source| refusal(&dir.join(name), source))?;
    write_result(dir, name, &bytes)
}

fn flatten(values: &[[f64; 3]]) -> Vec<f64> {
    values.iter().flatten().copied().collect()
}

/// The type of a number in VTK files: all that have a number of nodes of their own.
fn cell_type(number: u8) -> CellType {
    use CellType::*;
    #[rustfmt::skip]
    const TYPES: [CellType; 25] = [
        Vertex, Line, Triangle, Pixel, Quad, Tetra, Voxel, Hexahedron, Wedge, Pyramid, QuadraticEdge, QuadraticTriangle,
        QuadraticQuad, QuadraticTetra, QuadraticHexahedron, QuadraticWedge, QuadraticPyramid, BiquadraticQuad,
        TriquadraticHexahedron, QuadraticLinearQuad, QuadraticLinearWedge, BiquadraticQuadraticWedge,
        BiquadraticQuadraticHexahedron, BiquadraticTriangle, CubicLine,
    ];
    TYPES.into_iter().find(|kind| *kind as u8 == number).expect("a type of VTK")
}

fn cells(geometry: &Geometry) -> Cells {
    let mut end = 0;
    let offsets = geometry.cells.iter().map(|cell| {
        end += cell.nodes().len() as u64;
        end
    });
    let offsets = offsets.collect();
    let connectivity = geometry.cells.iter().flat_map(Cell::to_vtk).map(|node| node as u64).collect();
    let types = geometry.cells.iter().map(|cell| cell_type(cell.kind().table().vtk.number));
    Cells { cell_verts: VertexNumbers::XML { connectivity, offsets }, types: types.collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::sample;
    use vtkio::model::Piece;

    #[test]
    fn every_kind_of_cell_has_its_type() {
        for kind in crate::mesh::CellKind::all() {
            assert_eq!(cell_type(kind.table().vtk.number) as u8, kind.table().vtk.number, "{kind:?}");
        }
    }

    fn read(path: &Path) -> UnstructuredGridPiece {
        match Vtk::import(path).unwrap().data {
            DataSet::UnstructuredGrid { mut pieces, .. } => match pieces.remove(0) {
                Piece::Inline(piece) => *piece,
                _ => panic!("not inline"),
            },
            _ => panic!("not an unstructured grid"),
        }
    }

    fn array<'a>(attributes: &'a [Attribute], name: &str) -> &'a IOBuffer {
        match attributes.iter().find(|a| a.name() == name) {
            Some(Attribute::DataArray(array)) => &array.data,
            _ => panic!("no {name}"),
        }
    }

    #[test]
    fn shapes_parts_and_cells_read_back() {
        let dir = tempfile::tempdir().unwrap();
        let results = sample::rig();
        write_vtk(dir.path(), &results).unwrap();
        let disc = read(&dir.path().join("modes_disc.vtu"));
        assert_eq!(disc.cells.types.len(), results.geometry.cells.len());
        let IOBuffer::I32(part) = array(&disc.data.cell, "part") else { panic!("part is i32") };
        assert!(part.iter().zip(&results.geometry.part_of_cell).all(|(a, b)| *a as usize == *b));
        let IOBuffer::F64(u) = array(&disc.data.point, "mode_03") else { panic!("modes are f64") };
        assert_eq!(u.len(), 3 * results.geometry.nodes.len());
        assert!(u.chunks(3).zip(&results.all::<NamedModes>()[0].shape(2)).all(|(a, b)| a == &b[..3]));
        let complex = read(&dir.path().join("complex_modes.vtu"));
        let IOBuffer::F64(im) = array(&complex.data.point, "mode_01_im") else { panic!("modes are f64") };
        let shape = results.get::<ComplexResult>().unwrap().shape(0);
        assert!(im.chunks(3).zip(&shape).all(|(a, b)| a[0] == b[0].im && a[2] == b[2].im));
        assert!(im.iter().any(|v| *v != 0.0));
    }

    #[test]
    fn a_model_without_a_mesh_writes_no_grid() {
        let dir = tempfile::tempdir().unwrap();
        write_vtk(dir.path(), &RunResults::default()).unwrap();
        assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 0);
    }
}
