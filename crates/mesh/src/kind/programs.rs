//! Kinds of cells in the files of other programs: names, orders of nodes, numbers of faces.
//!
//! Sources: Abaqus Elements Guide, *Three-dimensional solid element library* and the libraries of shells, membranes, beams and trusses, with
//! the elements that CalculiX adds (CalculiX CrunchiX User's Manual, *Element types*); MSC/NX Nastran Quick Reference Guide, entries CHEXA,
//! CPENTA, CPYRAM, CTETRA, CTRIA6, CQUAD8, PLOAD4; ANSYS Mechanical APDL Element Reference, SOLID185, SOLID186, SOLID187, SOLID285, SHELL181,
//! SHELL281, BEAM189; *Universal File Datasets Summary* of SDRC, dataset 2412; the manuals of Gmsh and VTK.

use super::order::{NamedKind, Order};
use super::table::CellKind;

/// A program whose files name elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Program {
    /// Abaqus and CalculiX.
    Abaqus,
    /// NASTRAN.
    Nastran,
    /// ANSYS Mechanical APDL.
    Ansys,
}

impl CellKind {
    /// What the files of a program call it; empty where they have no such kind.
    pub fn named(self, program: Program) -> &'static [NamedKind] {
        match program {
            Program::Abaqus => self.table().abaqus,
            Program::Nastran => self.table().nastran,
            Program::Ansys => self.table().ansys,
        }
    }

    /// The kind of an element of a file by its name, in any case, and its nodes, and these in the order of the kind. A brick or a
    /// quadrilateral whose nodes fall together is the kind that has the fewest nodes.
    pub fn of_file<T: Copy + PartialEq>(
        program: Program,
        name: &str,
        nodes: &[T],
    ) -> Option<(CellKind, Vec<T>)> {
        let forms = |kind: CellKind| kind.named(program).iter().map(move |form| (kind, form));
        CellKind::all()
            .flat_map(forms)
            .filter(|(_, form)| form.names().any(|own| own.eq_ignore_ascii_case(name)))
            .filter_map(|(kind, form)| Some((kind, form.order.from_file(nodes)?)))
            .min_by_key(|(_, own)| own.len())
    }

    /// The kind of a cell of VTK files by the number of its type, and the order of its points there: pixels and voxels, whose points go by
    /// coordinates, are quadrilaterals and hexahedra.
    pub fn of_vtk(number: i64) -> Option<(CellKind, Order)> {
        match number {
            8 => Some((CellKind::Quadrilateral4, Order(&[0, 1, 3, 2]))),
            11 => Some((CellKind::Hexahedron8, Order(&[0, 1, 3, 2, 4, 5, 7, 6]))),
            _ => {
                let found = CellKind::all().find(|kind| i64::from(kind.table().vtk.number) == number);
                found.map(|kind| (kind, kind.table().vtk.order))
            }
        }
    }

    /// The side of a solid that a PLOAD4 entry of NASTRAN names by corners: `first` is the corner G1 of the face, `second` is
    /// * of tetrahedra the corner G4 that is not on it;
    /// * of quadrilateral faces the corner G3 across from G1;
    /// * of triangular faces of pyramids the corner G3 beside G1 on the base;
    /// * none of triangular faces of wedges.
    ///
    /// Corners and sides are numbered from 0, as in the table.
    pub fn side_of_corners(self, first: u8, second: Option<u8>) -> Option<usize> {
        let (sides, n_corners) = (self.table().sides, self.n_corners());
        let place = |side: usize, corner: u8| {
            let (kind, nodes) = sides[side];
            nodes[..kind.n_corners()].iter().position(|node| *node == corner)
        };
        let is_square = |side: usize| sides[side].0.n_corners() == 4;
        let across = |side: usize, other: u8| match (place(side, first), place(side, other)) {
            (Some(a), Some(b)) => is_square(side) && a.abs_diff(b) == 2,
            _ => false,
        };
        let named = |side: &usize| match second {
            _ if self.dimension() != 3 || place(*side, first).is_none() => false,
            None => n_corners == 6 && !is_square(*side),
            Some(other) if n_corners == 4 => place(*side, other).is_none(),
            Some(other) if n_corners == 5 && !is_square(*side) => {
                usize::from(first.max(other)) < 4 && first != other && place(*side, other).is_some()
            }
            Some(other) => across(*side, other),
        };
        (0..sides.len()).find(named)
    }
}

#[cfg(test)]
mod tests {
    use super::super::NumberedKind;
    use super::*;
    use CellKind::*;
    use Program::*;

    /// What the manuals say of an element, its nodes 1, 2, … or I, J, …: the corners that each middle is between, and the corners of each
    /// face (of shells: edge) with its number.
    struct Manual {
        kind: CellKind,
        program: Program,
        name: &'static str,
        middles: &'static str,
        faces: &'static [(u8, &'static str)],
    }

    const fn manual(
        program: Program,
        kind: CellKind,
        name: &'static str,
        middles: &'static str,
        faces: &'static [(u8, &'static str)],
    ) -> Manual {
        Manual { kind, program, name, middles, faces }
    }

    const TETRAHEDRON: &[(u8, &str)] = &[(1, "123"), (2, "142"), (3, "243"), (4, "341")];
    const WEDGE: &[(u8, &str)] = &[(1, "123"), (2, "465"), (3, "1452"), (4, "2563"), (5, "3641")];
    const BRICK: &[(u8, &str)] =
        &[(1, "1234"), (2, "5876"), (3, "1562"), (4, "2673"), (5, "3784"), (6, "4851")];
    const PYRAMID: &[(u8, &str)] = &[(1, "1234"), (2, "152"), (3, "253"), (4, "354"), (5, "451")];
    const SOLID187: &[(u8, &str)] = &[(1, "JIK"), (2, "IJL"), (3, "JKL"), (4, "KIL")];
    const SOLID186: &[(u8, &str)] =
        &[(1, "JILK"), (2, "IJNM"), (3, "JKON"), (4, "KLPO"), (5, "LIMP"), (6, "MNOP")];
    const SHELL181: &[(u8, &str)] = &[(3, "JI"), (4, "KJ"), (5, "LK"), (6, "IL")];
    const MIDDLES_186: &str = "IJ JK KL LI MN NO OP PM IM JN KO LP";

    /// Figures *Node ordering and face numbering on elements* of the Abaqus Elements Guide; connection entries of the Quick Reference Guide
    /// of NASTRAN; geometry and input summaries of the Element Reference of ANSYS.
    const MANUALS: &[Manual] = &[
        manual(Abaqus, Tetrahedron4, "C3D4", "", TETRAHEDRON),
        manual(Abaqus, Tetrahedron10, "C3D10", "12 23 31 14 24 34", TETRAHEDRON),
        manual(Abaqus, Wedge6, "C3D6", "", WEDGE),
        manual(Abaqus, Wedge15, "C3D15", "12 23 31 45 56 64 14 25 36", WEDGE),
        manual(Abaqus, Wedge18, "C3D15V", "12 23 31 45 56 64 14 25 36 1452 2563 3641", WEDGE),
        manual(Abaqus, Hexahedron8, "C3D8I", "", BRICK),
        manual(Abaqus, Hexahedron20, "C3D20R", "12 23 34 41 56 67 78 85 15 26 37 48", BRICK),
        manual(
            Abaqus,
            Hexahedron27,
            "C3D27",
            "12 23 34 41 56 67 78 85 15 26 37 48 12345678 1234 5876 1562 2673 3784 4851",
            BRICK,
        ),
        manual(Abaqus, Pyramid5, "C3D5", "", PYRAMID),
        manual(Abaqus, Triangle6, "STRI65", "12 23 31", &[(1, "12"), (2, "23"), (3, "31")]),
        manual(Abaqus, Quadrilateral8, "S8R", "12 23 34 41", &[(1, "12"), (2, "23"), (3, "34"), (4, "41")]),
        manual(Nastran, Tetrahedron10, "CTETRA", "12 23 31 14 24 34", &[]),
        manual(Nastran, Wedge15, "CPENTA", "12 23 31 14 25 36 45 56 64", &[]),
        manual(Nastran, Hexahedron20, "CHEXA", "12 23 34 41 15 26 37 48 56 67 78 85", &[]),
        manual(Nastran, Pyramid13, "CPYRAM", "12 23 34 41 15 25 35 45", &[]),
        manual(Nastran, Triangle6, "CTRIA6", "12 23 31", &[]),
        manual(Nastran, Quadrilateral8, "CQUAD8", "12 23 34 41", &[]),
        manual(Ansys, Tetrahedron4, "SOLID285", "", SOLID187),
        manual(Ansys, Tetrahedron10, "SOLID187", "IJ JK KI IL JL KL", SOLID187),
        manual(Ansys, Hexahedron8, "SOLID185", "", SOLID186),
        manual(Ansys, Hexahedron20, "SOLID186", MIDDLES_186, SOLID186),
        manual(Ansys, Quadrilateral4, "SHELL181", "", SHELL181),
        manual(Ansys, Quadrilateral8, "SHELL281", "IJ JK KL LI", SHELL181),
    ];

    /// The number, from 0, of a node of a manual.
    fn number(node: char) -> u8 {
        let letter = |c: char| u8::try_from(u32::from(c) - u32::from('I')).unwrap();
        node.to_digit(10).map_or_else(|| letter(node), |digit| digit as u8 - 1)
    }

    fn numbers(nodes: &str) -> Vec<u8> {
        nodes.chars().map(number).collect()
    }

    fn sorted(mut nodes: Vec<u8>) -> Vec<u8> {
        nodes.sort_unstable();
        nodes
    }

    /// Every order holds each node once, but where bricks are collapsed or universal files leave middles out; names are of one kind for
    /// each number of nodes; sides have numbers of their own.
    #[test]
    fn orders_are_permutations() {
        let all = |order: Order, n: usize| {
            let mut nodes = sorted(order.0.to_vec());
            nodes.dedup();
            nodes.into_iter().eq(0..n as u8)
        };
        for kind in CellKind::all() {
            let (n, row) = (kind.n_nodes(), kind.table());
            for order in [row.gmsh.order, row.vtk.order] {
                assert!(order.0.len() == n && all(order, n), "{kind:?} {order:?}");
            }
            for program in [Abaqus, Nastran, Ansys] {
                for form in kind.named(program) {
                    assert!(all(form.order, n), "{kind:?} {form:?}");
                    assert!(form.order.0.len() == n || program == Ansys, "{kind:?} {form:?}");
                    let mut numbers = form.sides.to_vec();
                    numbers.sort_unstable();
                    numbers.dedup();
                    assert!([0, row.sides.len()].contains(&numbers.len()), "{kind:?} {form:?}");
                    assert_eq!(numbers.len(), form.sides.len(), "{kind:?} {form:?}");
                    let nodes: Vec<usize> = (100..100 + n).collect();
                    for name in form.names() {
                        let found = CellKind::of_file(program, name, &form.order.to_file(&nodes));
                        assert_eq!(found, Some((kind, nodes.clone())), "{program:?} {name}");
                    }
                }
            }
        }
        assert_eq!(CellKind::of_file(Abaqus, "c3d8", &[0; 7]), None);
        assert_eq!(CellKind::of_file(Abaqus, "CHEXA", &[0, 1, 2, 3, 4, 5, 6, 7]), None);
    }

    /// A cell whose corners are those of the reference cell, and whose middles are where the manual of the file says, has each node where the
    /// table has it, and a positive Jacobian; faces have the corners of the manual.
    #[test]
    fn nodes_and_faces_are_those_of_the_manuals() {
        for Manual { kind, program, name, middles, faces } in MANUALS {
            let form = kind.named(*program).iter().find(|form| form.names().any(|own| own == *name)).unwrap();
            let corners = kind.corners();
            let mean = |of: Vec<u8>| -> [f64; 3] {
                let at = |k: usize| of.iter().map(|c| corners[usize::from(*c)][k]).sum::<f64>();
                std::array::from_fn(|k| at(k) / of.len() as f64)
            };
            let mut file = corners.to_vec();
            file.extend(middles.split_whitespace().map(|of| mean(numbers(of))));
            let nodes = form.order.from_file(&file).unwrap();
            assert_eq!(nodes, kind.reference_coordinates(), "{name}");
            assert_eq!(form.order.to_file(&nodes), file, "{name}");
            if kind.dimension() == 3 {
                let centre: [f64; 3] = mean((0..corners.len() as u8).collect());
                let mut tangents = [[0.0; 3]; 3];
                for (node, gradient) in nodes.iter().zip(kind.shape_gradients(centre)) {
                    (0..9).for_each(|k| tangents[k / 3][k % 3] += gradient[k / 3] * node[k % 3]);
                }
                let [a, b, c] = tangents;
                assert!(crate::quality::dot(crate::quality::cross(a, b), c) > 0.0, "{name}");
            }
            assert_eq!(form.sides.len(), faces.len(), "{name}");
            for (number, face) in *faces {
                let side = form.sides.iter().position(|own| own == number).unwrap();
                let (side, nodes) = kind.table().sides[side];
                assert_eq!(
                    sorted(nodes[..side.n_corners()].to_vec()),
                    sorted(numbers(face)),
                    "{name} face {number}"
                );
            }
        }
    }

    /// Bricks and quadrilaterals of ANSYS whose nodes fall together as its manual says: the nodes that are one, and the faces that are left,
    /// whose corners then are those of the brick.
    #[test]
    fn degenerate_shapes_are_those_of_the_manual() {
        let collapsed = [
            // Prism, tetrahedral and pyramid options of SOLID185.
            (Wedge6, "SOLID185", SOLID186, "", "KL OP"),
            (Tetrahedron4, "SOLID185", SOLID186, "", "KL MNOP"),
            (Pyramid5, "SOLID185", SOLID186, "", "MNOP"),
            // Those of SOLID186 with their middles, which are at a corner where both ends are.
            (Wedge15, "SOLID186", SOLID186, MIDDLES_186, "KL OP"),
            (Tetrahedron10, "SOLID186", SOLID186, MIDDLES_186, "KL MNOP"),
            (Pyramid13, "SOLID186", SOLID186, MIDDLES_186, "MNOP"),
            (Triangle3, "SHELL181", SHELL181, "", "KL"),
            (Triangle6, "SHELL281", SHELL181, "IJ JK KL LI", "KL"),
        ];
        for (kind, name, faces, middles, same) in collapsed {
            let form = kind.named(Ansys).iter().find(|form| form.names().any(|own| own == name)).unwrap();
            let first = |corner: u8| {
                same.split_whitespace()
                    .map(numbers)
                    .find(|of| of.contains(&corner))
                    .map_or(corner, |of| of[0])
            };
            // Each place of the file by the corners it is the middle of.
            let n_corners: u8 = if kind.dimension() == 3 { 8 } else { 4 };
            let mut file: Vec<Vec<u8>> = (0..n_corners).map(|corner| vec![first(corner)]).collect();
            for of in middles.split_whitespace() {
                let mut ends: Vec<u8> = sorted(numbers(of).into_iter().map(first).collect());
                ends.dedup();
                file.push(ends);
            }
            let labels: Vec<usize> =
                file.iter().map(|of| file.iter().position(|other| other == of).unwrap()).collect();
            let (found, nodes) = CellKind::of_file(Ansys, name, &labels).unwrap();
            assert_eq!(found, kind);
            // Middles are between the same corners as in the table.
            for (node, of) in nodes.iter().zip(kind.table().middles) {
                let corners = sorted(of.iter().map(|c| file[nodes[usize::from(*c)]][0]).collect());
                assert_eq!(file[*node], corners, "{kind:?} {name}");
            }
            let mut left = 0;
            for (number, face) in faces {
                let mut corners = sorted(numbers(face).into_iter().map(first).collect());
                corners.dedup();
                let Some(side) = form.sides.iter().position(|own| own == number) else {
                    assert!(corners.len() < kind.dimension(), "{kind:?} {name} face {number}");
                    continue;
                };
                let (side, of) = kind.table().sides[side];
                let own = of[..side.n_corners()].iter().map(|c| file[nodes[usize::from(*c)]][0]).collect();
                assert_eq!(sorted(own), corners, "{kind:?} {name} face {number}");
                left += 1;
            }
            assert_eq!(left, kind.table().sides.len(), "{kind:?}");
        }
    }

    /// PLOAD4 of the Quick Reference Guide of NASTRAN on every face of a kind: corner G1, and G3 or G4.
    #[test]
    fn faces_of_nastran_are_known_by_their_corners() {
        let faces = [
            (Tetrahedron10, "14 24 34", "123"),
            (Tetrahedron10, "13 23 43", "124"),
            (Tetrahedron10, "21 31 41", "234"),
            (Tetrahedron10, "12 32 42", "134"),
            (Wedge15, "1 2 3", "123"),
            (Wedge15, "4 5 6", "456"),
            (Wedge15, "15 51 24 42", "1254"),
            (Wedge15, "26 62 35 53", "2365"),
            (Wedge15, "34 43 16 61", "1346"),
            (Hexahedron20, "13 31 24 42", "1234"),
            (Hexahedron20, "57 75 68 86", "5678"),
            (Hexahedron20, "16 61 25 52", "1265"),
            (Hexahedron20, "27 72 36 63", "2376"),
            (Hexahedron20, "38 83 47 74", "3487"),
            (Hexahedron20, "18 81 45 54", "1485"),
            (Pyramid13, "13 31 24 42", "1234"),
            (Pyramid13, "12 21", "125"),
            (Pyramid13, "23 32", "235"),
            (Pyramid13, "34 43", "345"),
            (Pyramid13, "41 14", "145"),
            // No faces: an edge, a diagonal of the brick, a corner without another one, the apex, a shell.
            (Hexahedron20, "12 17 1", ""),
            (Wedge15, "12 14", ""),
            (Pyramid13, "15 5", ""),
            (Quadrilateral8, "13", ""),
        ];
        for (kind, by, corners) in faces {
            for by in by.split_whitespace().map(numbers) {
                let side =
                    kind.side_of_corners(by[0], by.get(1).copied()).map(|side| kind.table().sides[side]);
                let found = side.map_or(Vec::new(), |(side, nodes)| nodes[..side.n_corners()].to_vec());
                assert_eq!(sorted(found), sorted(numbers(corners)), "{kind:?} {by:?}");
            }
        }
    }

    /// The order of universal files from the table of kinds: each layer of corners round with the middles of its edges, between two layers the
    /// middles of the edges that join them.
    #[test]
    fn layers_follow_each_other_with_the_middles_between() {
        for kind in CellKind::all() {
            let Some(NumberedKind { order: Order(order), .. }) = kind.table().universal else { continue };
            let middles = kind.table().middles;
            let between = |a: u8, b: u8| {
                let ends = |own: &&[u8]| own.len() == 2 && own.contains(&a) && own.contains(&b);
                middles.iter().position(ends).map(|place| place as u8)
            };
            let round = |corners: &[u8]| -> Vec<u8> {
                let next = |k: usize| corners[(k + 1) % corners.len()];
                (0..corners.len())
                    .flat_map(|k| std::iter::once(corners[k]).chain(between(corners[k], next(k))))
                    .collect()
            };
            let joined =
                |pairs: &[[u8; 2]]| pairs.iter().filter_map(|[a, b]| between(*a, *b)).collect::<Vec<u8>>();
            let expected = match (kind.dimension(), kind.n_corners()) {
                (1, _) => [vec![0], joined(&[[0, 1]]), vec![1]].concat(),
                (2, 3) => round(&[0, 1, 2]),
                (2, _) => round(&[0, 1, 2, 3]),
                (_, 4) => [round(&[0, 1, 2]), joined(&[[0, 3], [1, 3], [2, 3]]), vec![3]].concat(),
                (_, 6) => [round(&[0, 1, 2]), joined(&[[0, 3], [1, 4], [2, 5]]), round(&[3, 4, 5])].concat(),
                (_, 8) => {
                    let up = joined(&[[0, 4], [1, 5], [2, 6], [3, 7]]);
                    [round(&[0, 1, 2, 3]), up, round(&[4, 5, 6, 7])].concat()
                }
                // A pyramid is a brick whose upper corners are one.
                _ => vec![0, 1, 2, 3, 4, 4, 4, 4],
            };
            assert_eq!(order, expected, "{kind:?}");
        }
    }
}
