//! The table of the kinds of cells: what is known of a kind stands in its row, and in no other place.
//!
//! Nodes are in the order of VTK: corners; then the middles of edges, those of faces and of the cell. Sides are in the order of the faces
//! S1, S2, … of Abaqus.

use super::order::{NamedKind, NumberedKind, Order, named, numbered, own};
use super::products::{Product, Products};

/// A kind of cell, by shape and number of nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)]
pub enum CellKind {
    Point1,
    Line2,
    Line3,
    Triangle3,
    Triangle6,
    Quadrilateral4,
    Quadrilateral8,
    Quadrilateral9,
    Tetrahedron4,
    Tetrahedron10,
    Hexahedron8,
    Hexahedron20,
    Hexahedron27,
    Wedge6,
    Wedge15,
    Wedge18,
    Pyramid5,
    Pyramid13,
}

/// The shape of a kind, which its corners give.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum CellShape {
    Point,
    Line,
    Triangle,
    Quadrilateral,
    Tetrahedron,
    Hexahedron,
    Wedge,
    Pyramid,
}

/// A row of the table.
#[derive(Debug)]
pub struct CellTable {
    /// The kind.
    pub kind: CellKind,
    /// What it is called in messages.
    pub name: &'static str,
    /// Its shape.
    pub shape: CellShape,
    /// Its shape functions are combinations of these.
    pub(crate) products: Products,
    /// The corners that each node is the middle of, in the order of the nodes; a corner is its own.
    pub middles: &'static [&'static [u8]],
    /// Faces of a solid, or edges of a face: the kind and its nodes, seen from outside counter-clockwise.
    pub sides: &'static [(CellKind, &'static [u8])],
    /// Points, lines, triangles and quadrilaterals of first order that it can be drawn by: itself, or pieces between its nodes; none of a
    /// solid, whose sides are drawn.
    pub pieces: &'static [&'static [u8]],
    /// Its type in Gmsh files.
    pub gmsh: NumberedKind,
    /// Its type in VTK files.
    pub vtk: NumberedKind,
    /// Its FE descriptor in universal files, dataset 2412.
    pub universal: Option<NumberedKind>,
    /// Elements of Abaqus and CalculiX.
    pub abaqus: &'static [NamedKind],
    /// Elements of NASTRAN.
    pub nastran: &'static [NamedKind],
    /// Elements of ANSYS.
    pub ansys: &'static [NamedKind],
}

use CellKind::*;
use CellShape::*;
use Products::{Complete, Listed, Prism, Serendipity, Tensor};

impl CellShape {
    /// Reference coordinates (ξ, η, ζ) of the corners.
    pub fn corners(self) -> &'static [[f64; 3]] {
        match self {
            Point => &[[0.0; 3]],
            Line => &[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
            Triangle => &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            Quadrilateral => &[[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]],
            Tetrahedron => &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            Hexahedron => &CUBE,
            Wedge => &WEDGE,
            Pyramid => &PYRAMID,
        }
    }

    /// 0 points, 1 lines, 2 faces, 3 solids.
    pub fn dimension(self) -> usize {
        match self {
            Point => 0,
            Line => 1,
            Triangle | Quadrilateral => 2,
            Tetrahedron | Hexahedron | Wedge | Pyramid => 3,
        }
    }
}

const CUBE: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];
const WEDGE: [[f64; 3]; 6] =
    [[0.0, 0.0, -1.0], [1.0, 0.0, -1.0], [0.0, 1.0, -1.0], [0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]];
const PYRAMID: [[f64; 3]; 5] =
    [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Second degree in x and y, times 1 and z; z² comes with linear functions of x and y.
#[rustfmt::skip]
const WEDGE15: &[Product] = &[[0, 0, 0, 0], [0, 0, 1, 0], [0, 0, 2, 0], [0, 1, 0, 0], [0, 1, 1, 0], [0, 1, 2, 0], [0, 2, 0, 0], [0, 2, 1,
    0], [1, 0, 0, 0], [1, 0, 1, 0], [1, 0, 2, 0], [1, 1, 0, 0], [1, 1, 1, 0], [2, 0, 0, 0], [2, 0, 1, 0]];
/// All of first degree, and r.
const PYRAMID5: &[Product] = &[[0, 0, 0, 0], [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]];
/// All of second degree but xy, and r times all of first degree.
#[rustfmt::skip]
const PYRAMID13: &[Product] = &[[0, 0, 0, 0], [0, 0, 1, 0], [0, 0, 2, 0], [0, 1, 0, 0], [0, 1, 1, 0], [0, 2, 0, 0], [1, 0, 0, 0], [1, 0, 1,
    0], [2, 0, 0, 0], [0, 0, 0, 1], [1, 0, 0, 1], [0, 1, 0, 1], [0, 0, 1, 1]];

/// The table; a kind's row is at its place in [`CellKind`].
#[rustfmt::skip]
pub(super) static TABLE: [CellTable; 18] = [
    CellTable {
        kind: Point1,
        name: "point",
        shape: Point,
        products: Complete(0),
        middles: &[&[0]],
        sides: &[],
        pieces: &[&[0]],
        gmsh: numbered(15, own(1)),
        vtk: numbered(1, own(1)),
        universal: None,
        abaqus: &[named("MASS ROTARYI", own(1), &[])],
        nastran: &[named("CONM1 CONM2", own(1), &[])],
        ansys: &[named("MASS21", own(1), &[])],
    },
    CellTable {
        kind: Line2,
        name: "2-node line",
        shape: Line,
        products: Complete(1),
        middles: &[&[0], &[1]],
        sides: &[(Point1, &[0]), (Point1, &[1])],
        pieces: &[&[0, 1]],
        gmsh: numbered(1, own(2)),
        vtk: numbered(3, own(2)),
        universal: Some(numbered(21, own(2))),
        abaqus: &[named("B31 B31H B31OS B31OSH B31R B33 B33H PIPE31 PIPE31H T3D2 T3D2H", own(2), &[])],
        nastran: &[named("CBAR CBEAM CROD CONROD CTUBE", own(2), &[])],
        ansys: &[named("BEAM188 BEAM4 LINK180 LINK8 PIPE288", own(2), &[])],
    },
    CellTable {
        kind: Line3,
        name: "3-node line",
        shape: Line,
        products: Complete(2),
        middles: &[&[0], &[1], &[0, 1]],
        sides: &[(Point1, &[0]), (Point1, &[1])],
        pieces: &[&[0, 2], &[2, 1]],
        gmsh: numbered(8, own(3)),
        vtk: numbered(21, own(3)),
        universal: Some(numbered(24, Order(&[0, 2, 1]))),
        abaqus: &[named("B32 B32H B32OS B32OSH B32R PIPE32 PIPE32H T3D3 T3D3H", Order(&[0, 2, 1]), &[])],
        nastran: &[named("CBEAM3", own(3), &[])],
        ansys: &[named("BEAM189 PIPE289", own(3), &[])],
    },
    CellTable {
        kind: Triangle3,
        name: "3-node triangle",
        shape: Triangle,
        products: Complete(1),
        middles: &[&[0], &[1], &[2]],
        sides: &[(Line2, &[0, 1]), (Line2, &[1, 2]), (Line2, &[2, 0])],
        pieces: &[&[0, 1, 2]],
        gmsh: numbered(2, own(3)),
        vtk: numbered(5, own(3)),
        universal: Some(numbered(91, own(3))),
        abaqus: &[named("S3 S3R S3RS STRI3 M3D3 SFM3D3 R3D3", own(3), &[1, 2, 3])],
        nastran: &[named("CTRIA3 CTRIAR", own(3), &[])],
        ansys: &[named("SHELL181 SHELL63", Order(&[0, 1, 2, 2]), &[3, 4, 6])],
    },
    CellTable {
        kind: Triangle6,
        name: "6-node triangle",
        shape: Triangle,
        products: Complete(2),
        middles: &[&[0], &[1], &[2], &[0, 1], &[1, 2], &[2, 0]],
        sides: &[(Line3, &[0, 1, 3]), (Line3, &[1, 2, 4]), (Line3, &[2, 0, 5])],
        pieces: &[&[0, 3, 5], &[3, 1, 4], &[5, 4, 2], &[3, 4, 5]],
        gmsh: numbered(9, own(6)),
        vtk: numbered(22, own(6)),
        universal: Some(numbered(92, Order(&[0, 3, 1, 4, 2, 5]))),
        abaqus: &[named("STRI65 S6 M3D6 SFM3D6", own(6), &[1, 2, 3])],
        nastran: &[named("CTRIA6", own(6), &[])],
        ansys: &[named("SHELL281 SHELL93", Order(&[0, 1, 2, 2, 3, 4, 2, 5]), &[3, 4, 6])],
    },
    CellTable {
        kind: Quadrilateral4,
        name: "4-node quadrilateral",
        shape: Quadrilateral,
        products: Tensor(1),
        middles: &[&[0], &[1], &[2], &[3]],
        sides: &[(Line2, &[0, 1]), (Line2, &[1, 2]), (Line2, &[2, 3]), (Line2, &[3, 0])],
        pieces: &[&[0, 1, 2, 3]],
        gmsh: numbered(3, own(4)),
        vtk: numbered(9, own(4)),
        universal: Some(numbered(94, own(4))),
        abaqus: &[named("S4 S4R S4RS S4RSW S4R5 M3D4 M3D4R SFM3D4 SFM3D4R R3D4", own(4), &[1, 2, 3, 4])],
        nastran: &[named("CQUAD4 CQUADR", own(4), &[])],
        ansys: &[named("SHELL181 SHELL63", own(4), &[3, 4, 5, 6])],
    },
    CellTable {
        kind: Quadrilateral8,
        name: "8-node quadrilateral",
        shape: Quadrilateral,
        products: Serendipity,
        middles: &[&[0], &[1], &[2], &[3], &[0, 1], &[1, 2], &[2, 3], &[3, 0]],
        sides: &[(Line3, &[0, 1, 4]), (Line3, &[1, 2, 5]), (Line3, &[2, 3, 6]), (Line3, &[3, 0, 7])],
        pieces: &[&[0, 4, 7], &[4, 1, 5], &[5, 2, 6], &[7, 6, 3], &[4, 5, 6, 7]],
        gmsh: numbered(16, own(8)),
        vtk: numbered(23, own(8)),
        universal: Some(numbered(95, Order(&[0, 4, 1, 5, 2, 6, 3, 7]))),
        abaqus: &[named("S8 S8R S8R5 M3D8 M3D8R SFM3D8 SFM3D8R", own(8), &[1, 2, 3, 4])],
        nastran: &[named("CQUAD8", own(8), &[])],
        ansys: &[named("SHELL281 SHELL93", own(8), &[3, 4, 5, 6])],
    },
    CellTable {
        kind: Quadrilateral9,
        name: "9-node quadrilateral",
        shape: Quadrilateral,
        products: Tensor(2),
        middles: &[&[0], &[1], &[2], &[3], &[0, 1], &[1, 2], &[2, 3], &[3, 0], &[0, 1, 2, 3]],
        sides: &[(Line3, &[0, 1, 4]), (Line3, &[1, 2, 5]), (Line3, &[2, 3, 6]), (Line3, &[3, 0, 7])],
        pieces: &[&[0, 4, 8, 7], &[4, 1, 5, 8], &[8, 5, 2, 6], &[7, 8, 6, 3]],
        gmsh: numbered(10, own(9)),
        vtk: numbered(28, own(9)),
        universal: Some(numbered(95, Order(&[0, 4, 1, 5, 2, 6, 3, 7]))),
        abaqus: &[named("S9R5 M3D9 M3D9R", own(9), &[1, 2, 3, 4])],
        nastran: &[named("CQUAD", own(9), &[])],
        ansys: &[],
    },
    CellTable {
        kind: Tetrahedron4,
        name: "4-node tetrahedron",
        shape: Tetrahedron,
        products: Complete(1),
        middles: &[&[0], &[1], &[2], &[3]],
        sides: &[(Triangle3, &[0, 2, 1]), (Triangle3, &[0, 1, 3]), (Triangle3, &[1, 2, 3]), (Triangle3, &[2, 0, 3])],
        pieces: &[],
        gmsh: numbered(4, own(4)),
        vtk: numbered(10, own(4)),
        universal: Some(numbered(111, own(4))),
        abaqus: &[named("C3D4 C3D4H", own(4), &[1, 2, 3, 4])],
        nastran: &[named("CTETRA", own(4), &[])],
        ansys: &[named("SOLID285", own(4), &[1, 2, 3, 4]), named("SOLID185 SOLID45", Order(&[0, 1, 2, 2, 3, 3, 3, 3]), &[1, 2, 3, 5])],
    },
    CellTable {
        kind: Tetrahedron10,
        name: "10-node tetrahedron",
        shape: Tetrahedron,
        products: Complete(2),
        middles: &[&[0], &[1], &[2], &[3], &[0, 1], &[1, 2], &[2, 0], &[0, 3], &[1, 3], &[2, 3]],
        sides: &[(Triangle6, &[0, 2, 1, 6, 5, 4]), (Triangle6, &[0, 1, 3, 4, 8, 7]), (Triangle6, &[1, 2, 3, 5, 9, 8]),
            (Triangle6, &[2, 0, 3, 6, 7, 9])],
        pieces: &[],
        gmsh: numbered(11, Order(&[0, 1, 2, 3, 4, 5, 6, 7, 9, 8])),
        vtk: numbered(24, own(10)),
        universal: Some(numbered(118, Order(&[0, 4, 1, 5, 2, 6, 7, 8, 9, 3]))),
        abaqus: &[named("C3D10 C3D10H C3D10HS C3D10I C3D10M C3D10MH C3D10R C3D10T", own(10), &[1, 2, 3, 4])],
        nastran: &[named("CTETRA", own(10), &[])],
        ansys: &[named("SOLID187 SOLID92", own(10), &[1, 2, 3, 4]), named("SOLID186 SOLID95", Order(&[0, 1, 2, 2, 3, 3, 3, 3, 4, 5, 2, 6,
            3, 3, 3, 3, 7, 8, 9, 9]), &[1, 2, 3, 5])],
    },
    CellTable {
        kind: Hexahedron8,
        name: "8-node hexahedron",
        shape: Hexahedron,
        products: Tensor(1),
        middles: &[&[0], &[1], &[2], &[3], &[4], &[5], &[6], &[7]],
        sides: &[(Quadrilateral4, &[0, 3, 2, 1]), (Quadrilateral4, &[4, 5, 6, 7]), (Quadrilateral4, &[0, 1, 5, 4]),
            (Quadrilateral4, &[1, 2, 6, 5]), (Quadrilateral4, &[2, 3, 7, 6]), (Quadrilateral4, &[3, 0, 4, 7])],
        pieces: &[],
        gmsh: numbered(5, own(8)),
        vtk: numbered(12, own(8)),
        universal: Some(numbered(115, own(8))),
        abaqus: &[named("C3D8 C3D8H C3D8I C3D8IH C3D8R C3D8RH C3D8S C3D8HS", own(8), &[1, 2, 3, 4, 5, 6])],
        nastran: &[named("CHEXA", own(8), &[])],
        ansys: &[named("SOLID185 SOLID45", own(8), &[1, 6, 2, 3, 4, 5])],
    },
    CellTable {
        kind: Hexahedron20,
        name: "20-node hexahedron",
        shape: Hexahedron,
        products: Serendipity,
        middles: &[&[0], &[1], &[2], &[3], &[4], &[5], &[6], &[7], &[0, 1], &[1, 2], &[2, 3], &[3, 0], &[4, 5], &[5, 6], &[6, 7],
            &[7, 4], &[0, 4], &[1, 5], &[2, 6], &[3, 7]],
        sides: &[(Quadrilateral8, &[0, 3, 2, 1, 11, 10, 9, 8]), (Quadrilateral8, &[4, 5, 6, 7, 12, 13, 14, 15]),
            (Quadrilateral8, &[0, 1, 5, 4, 8, 17, 12, 16]), (Quadrilateral8, &[1, 2, 6, 5, 9, 18, 13, 17]),
            (Quadrilateral8, &[2, 3, 7, 6, 10, 19, 14, 18]), (Quadrilateral8, &[3, 0, 4, 7, 11, 16, 15, 19])],
        pieces: &[],
        gmsh: numbered(17, Order(&[0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 16, 9, 17, 10, 18, 19, 12, 15, 13, 14])),
        vtk: numbered(25, own(20)),
        universal: Some(numbered(116, Order(&[0, 8, 1, 9, 2, 10, 3, 11, 16, 17, 18, 19, 4, 12, 5, 13, 6, 14, 7, 15]))),
        abaqus: &[named("C3D20 C3D20H C3D20R C3D20RH", own(20), &[1, 2, 3, 4, 5, 6])],
        nastran: &[named("CHEXA", Order(&[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 16, 17, 18, 19, 12, 13, 14, 15]), &[])],
        ansys: &[named("SOLID186 SOLID95", own(20), &[1, 6, 2, 3, 4, 5])],
    },
    CellTable {
        kind: Hexahedron27,
        name: "27-node hexahedron",
        shape: Hexahedron,
        products: Tensor(2),
        middles: &[&[0], &[1], &[2], &[3], &[4], &[5], &[6], &[7], &[0, 1], &[1, 2], &[2, 3], &[3, 0], &[4, 5], &[5, 6], &[6, 7],
            &[7, 4], &[0, 4], &[1, 5], &[2, 6], &[3, 7], &[0, 3, 4, 7], &[1, 2, 5, 6], &[0, 1, 4, 5], &[2, 3, 6, 7], &[0, 1, 2, 3],
            &[4, 5, 6, 7], &[0, 1, 2, 3, 4, 5, 6, 7]],
        sides: &[(Quadrilateral9, &[0, 3, 2, 1, 11, 10, 9, 8, 24]), (Quadrilateral9, &[4, 5, 6, 7, 12, 13, 14, 15, 25]),
            (Quadrilateral9, &[0, 1, 5, 4, 8, 17, 12, 16, 22]), (Quadrilateral9, &[1, 2, 6, 5, 9, 18, 13, 17, 21]),
            (Quadrilateral9, &[2, 3, 7, 6, 10, 19, 14, 18, 23]), (Quadrilateral9, &[3, 0, 4, 7, 11, 16, 15, 19, 20])],
        pieces: &[],
        gmsh: numbered(12, Order(&[0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 16, 9, 17, 10, 18, 19, 12, 15, 13, 14, 24, 22, 20, 21, 23, 25, 26])),
        vtk: numbered(29, own(27)),
        universal: Some(numbered(116, Order(&[0, 8, 1, 9, 2, 10, 3, 11, 16, 17, 18, 19, 4, 12, 5, 13, 6, 14, 7, 15]))),
        abaqus: &[named("C3D27 C3D27H C3D27R C3D27RH", Order(&[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 26,
            24, 25, 22, 21, 23, 20]), &[1, 2, 3, 4, 5, 6])],
        nastran: &[],
        ansys: &[],
    },
    CellTable {
        kind: Wedge6,
        name: "6-node wedge",
        shape: Wedge,
        products: Prism(1),
        middles: &[&[0], &[1], &[2], &[3], &[4], &[5]],
        sides: &[(Triangle3, &[0, 2, 1]), (Triangle3, &[3, 4, 5]), (Quadrilateral4, &[0, 1, 4, 3]), (Quadrilateral4, &[1, 2, 5, 4]),
            (Quadrilateral4, &[2, 0, 3, 5])],
        pieces: &[],
        gmsh: numbered(6, own(6)),
        vtk: numbered(13, Order(&[0, 2, 1, 3, 5, 4])),
        universal: Some(numbered(112, own(6))),
        abaqus: &[named("C3D6 C3D6H", own(6), &[1, 2, 3, 4, 5])],
        nastran: &[named("CPENTA", own(6), &[])],
        ansys: &[named("SOLID185 SOLID45", Order(&[0, 1, 2, 2, 3, 4, 5, 5]), &[1, 6, 2, 3, 5])],
    },
    CellTable {
        kind: Wedge15,
        name: "15-node wedge",
        shape: Wedge,
        products: Listed(WEDGE15),
        middles: &[&[0], &[1], &[2], &[3], &[4], &[5], &[0, 1], &[1, 2], &[2, 0], &[3, 4], &[4, 5], &[5, 3], &[0, 3], &[1, 4], &[2, 5]],
        sides: &[(Triangle6, &[0, 2, 1, 8, 7, 6]), (Triangle6, &[3, 4, 5, 9, 10, 11]), (Quadrilateral8, &[0, 1, 4, 3, 6, 13, 9, 12]),
            (Quadrilateral8, &[1, 2, 5, 4, 7, 14, 10, 13]), (Quadrilateral8, &[2, 0, 3, 5, 8, 12, 11, 14])],
        pieces: &[],
        gmsh: numbered(18, Order(&[0, 1, 2, 3, 4, 5, 6, 8, 12, 7, 13, 14, 9, 11, 10])),
        vtk: numbered(26, own(15)),
        universal: Some(numbered(113, Order(&[0, 6, 1, 7, 2, 8, 12, 13, 14, 3, 9, 4, 10, 5, 11]))),
        abaqus: &[named("C3D15 C3D15H C3D15V C3D15VH", own(15), &[1, 2, 3, 4, 5])],
        nastran: &[named("CPENTA", Order(&[0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11]), &[])],
        ansys: &[named("SOLID186 SOLID95", Order(&[0, 1, 2, 2, 3, 4, 5, 5, 6, 7, 2, 8, 9, 10, 5, 11, 12, 13, 14, 14]), &[1, 6, 2, 3, 5])],
    },
    CellTable {
        kind: Wedge18,
        name: "18-node wedge",
        shape: Wedge,
        products: Prism(2),
        middles: &[&[0], &[1], &[2], &[3], &[4], &[5], &[0, 1], &[1, 2], &[2, 0], &[3, 4], &[4, 5], &[5, 3], &[0, 3], &[1, 4], &[2, 5],
            &[0, 1, 3, 4], &[1, 2, 4, 5], &[0, 2, 3, 5]],
        sides: &[(Triangle6, &[0, 2, 1, 8, 7, 6]), (Triangle6, &[3, 4, 5, 9, 10, 11]),
            (Quadrilateral9, &[0, 1, 4, 3, 6, 13, 9, 12, 15]), (Quadrilateral9, &[1, 2, 5, 4, 7, 14, 10, 13, 16]),
            (Quadrilateral9, &[2, 0, 3, 5, 8, 12, 11, 14, 17])],
        pieces: &[],
        gmsh: numbered(13, Order(&[0, 1, 2, 3, 4, 5, 6, 8, 12, 7, 13, 14, 9, 11, 10, 15, 17, 16])),
        vtk: numbered(32, own(18)),
        universal: Some(numbered(113, Order(&[0, 6, 1, 7, 2, 8, 12, 13, 14, 3, 9, 4, 10, 5, 11]))),
        abaqus: &[named("C3D15V C3D15VH", own(18), &[1, 2, 3, 4, 5])],
        nastran: &[],
        ansys: &[],
    },
    CellTable {
        kind: Pyramid5,
        name: "5-node pyramid",
        shape: Pyramid,
        products: Listed(PYRAMID5),
        middles: &[&[0], &[1], &[2], &[3], &[4]],
        sides: &[(Quadrilateral4, &[0, 3, 2, 1]), (Triangle3, &[0, 1, 4]), (Triangle3, &[1, 2, 4]), (Triangle3, &[2, 3, 4]),
            (Triangle3, &[3, 0, 4])],
        pieces: &[],
        gmsh: numbered(7, own(5)),
        vtk: numbered(14, own(5)),
        universal: Some(numbered(115, Order(&[0, 1, 2, 3, 4, 4, 4, 4]))),
        abaqus: &[named("C3D5 C3D5H", own(5), &[1, 2, 3, 4, 5])],
        nastran: &[named("CPYRAM CPYRA", own(5), &[])],
        ansys: &[named("SOLID185 SOLID45", Order(&[0, 1, 2, 3, 4, 4, 4, 4]), &[1, 2, 3, 4, 5])],
    },
    CellTable {
        kind: Pyramid13,
        name: "13-node pyramid",
        shape: Pyramid,
        products: Listed(PYRAMID13),
        middles: &[&[0], &[1], &[2], &[3], &[4], &[0, 1], &[1, 2], &[2, 3], &[3, 0], &[0, 4], &[1, 4], &[2, 4], &[3, 4]],
        sides: &[(Quadrilateral8, &[0, 3, 2, 1, 8, 7, 6, 5]), (Triangle6, &[0, 1, 4, 5, 10, 9]), (Triangle6, &[1, 2, 4, 6, 11, 10]),
            (Triangle6, &[2, 3, 4, 7, 12, 11]), (Triangle6, &[3, 0, 4, 8, 9, 12])],
        pieces: &[],
        gmsh: numbered(19, Order(&[0, 1, 2, 3, 4, 5, 8, 9, 6, 10, 7, 11, 12])),
        vtk: numbered(27, own(13)),
        universal: Some(numbered(115, Order(&[0, 1, 2, 3, 4, 4, 4, 4]))),
        abaqus: &[],
        nastran: &[named("CPYRAM CPYRA", own(13), &[])],
        ansys: &[named("SOLID186 SOLID95", Order(&[0, 1, 2, 3, 4, 4, 4, 4, 5, 6, 7, 8, 4, 4, 4, 4, 9, 10, 11, 12]), &[1, 2, 3, 4, 5])],
    },
];
