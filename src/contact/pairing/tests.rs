use super::super::projection::{dot, subtract, unit};
use super::*;
use crate::bounds::{Origin::*, within};
use crate::mesh::generate::structured_box;
use crate::mesh::{Cell, CellKind, outer_faces};
use crate::structure::{Integration, Material, PartKind, PlateTheory, RayleighDamping, Shell, Solid};

const DISC_RADIUS: f64 = 0.075;
const SLIDER: f64 = 0.010;

fn steel() -> Material {
    Material {
        youngs_modulus: 2e11,
        poissons_ratio: 0.3,
        density: 7850.0,
        loss_factor: 0.0,
        rayleigh: RayleighDamping::default(),
        orthotropic: None,
    }
}

fn part(name: &str, thickness: f64, faces: Vec<Cell>) -> Part {
    Part::new(name, faces, Shell { rotary_inertia: false, ..Shell::new(steel(), thickness) })
}

fn shell_of(part: &mut Part) -> &mut Shell {
    match &mut part.kind {
        PartKind::Shell(shell) => shell,
        _ => panic!("a shell"),
    }
}

/// A fan of triangles in the y–z plane (tilted by `lead` about y), its lowest rim node touching z = 0 at `x`, and a
/// slider of quadrilaterals whose upper face is z = 0.
struct Rig {
    nodes: Vec<[f64; 3]>,
    disc: Part,
    slider: Part,
    rim: Vec<[usize; 2]>,
}

fn rig(lead: f64, x: f64, lift: f64) -> Rig {
    let n = 180;
    let mut nodes = vec![[0.0; 3]];
    for k in 0..n {
        // Node 1 is the lowest.
        let angle = std::f64::consts::TAU * k as f64 / n as f64 - std::f64::consts::FRAC_PI_2;
        nodes.push([0.0, DISC_RADIUS * angle.cos(), DISC_RADIUS * angle.sin()]);
    }
    // θ > 0 moves the lowest point towards −x.
    for p in &mut nodes {
        *p = [p[2] * lead.sin() + x, p[1], p[2] * lead.cos() + DISC_RADIUS + lift];
    }
    let ring = |k: usize| 1 + k % n;
    let faces = (0..n).map(|k| Cell::triangle([0, ring(k), ring(k + 1)])).collect();
    let rim = (0..n).map(|k| [ring(k), ring(k + 1)]).collect();
    let first = nodes.len();
    let (nx, ny) = (10, 6);
    for i in 0..=nx {
        for j in 0..=ny {
            nodes.push([0.02 * i as f64 - 0.1, 0.02 * j as f64 - 0.06, -0.5 * SLIDER]);
        }
    }
    let at = |i: usize, j: usize| first + i * (ny + 1) + j;
    let quads = (0..nx)
        .flat_map(|i| (0..ny).map(move |j| (i, j)))
        .map(|(i, j)| Cell::quadrilateral([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]))
        .collect();
    Rig { nodes, disc: part("disc", 1e-3, faces), slider: part("slider", SLIDER, quads), rim }
}

fn surfaces<'a>(rig: &'a Rig, patch: ContactPatch) -> Surfaces<'a> {
    Surfaces {
        name: "rim",
        nodes: &rig.nodes,
        body: &rig.disc,
        side: ContactSide::Edge(&rig.rim),
        counter: &rig.slider,
        faces: &rig.slider.cells,
        sliding: Sliding::Along([1.0, 0.0, 0.0]),
        patch,
        stroke: 0.0,
    }
}

fn reduce(terms: &[(usize, usize, f64)]) -> SparseVector {
    SparseVector::from_entries(terms.iter().map(|(node, dof, c)| (6 * node + dof, *c)))
}

/// A rigid motion of some nodes: translation `t`, rotation `r` about the origin.
fn rigid(nodes: &[[f64; 3]], range: std::ops::Range<usize>, t: Vector, r: Vector) -> Vec<f64> {
    let mut u = vec![0.0; 6 * nodes.len()];
    for k in range {
        let moved = add(t, cross(r, nodes[k]));
        for c in 0..3 {
            u[6 * k + c] = moved[c];
            u[6 * k + 3 + c] = r[c];
        }
    }
    u
}

#[test]
fn rim_gap_is_that_of_the_circle_and_weights_are_its_length() {
    let rig = rig(0.0, 0.013, 0.0);
    let points = pair_surfaces(&surfaces(&rig, ContactPatch::Reach(1e-3)), &reduce).unwrap();
    let step = std::f64::consts::TAU / 180.0;
    let chord = 2.0 * DISC_RADIUS * (0.5 * step).sin();
    for p in &points {
        let y = p.position[1];
        let exact = DISC_RADIUS - (DISC_RADIUS * DISC_RADIUS - y * y).sqrt();
        assert!(
            within((p.gap - exact).abs(), 1e-15, RoundOff)
                && within((p.weight - 0.5 * chord).abs(), 1e-15, RoundOff)
        );
        assert!(within(((p.position[0] - 0.013).abs() - 0.5e-3).abs(), 1e-15, RoundOff));
    }
    // a (1 − cos kα) ≤ 1 mm for k ≤ 4: nine nodes, two points each.
    assert_eq!(points.len(), 18);
}

/// Any rigid motion of either body closes and slides each point by what the displacement of that point says.
#[test]
fn directions_are_the_relative_displacement_of_the_points() {
    for (lead, theory) in
        [(0.0, PlateTheory::Kirchhoff), (0.08, PlateTheory::Kirchhoff), (0.08, PlateTheory::Mindlin)]
    {
        let mut rig = rig(lead, -0.031, 0.0);
        shell_of(&mut rig.slider).theory = theory;
        let points = pair_surfaces(&surfaces(&rig, ContactPatch::Reach(2e-3)), &reduce).unwrap();
        let disc_nodes = 0..181;
        let (t, r) = ([3e-4, -2e-4, 5e-4], [0.02, -0.03, 0.04]);
        for (body, range) in [(1.0, disc_nodes.clone()), (-1.0, 181..rig.nodes.len())] {
            let u = rigid(&rig.nodes, range, t, r);
            for p in &points {
                // The foot of the point on z = 0 for the counter-body.
                let x = if body > 0.0 { p.position } else { [p.position[0], p.position[1], 0.0] };
                let moved = add(t, cross(r, x));
                assert!(within((p.normal.dot(&u) + body * moved[2]).abs(), 1e-15, RoundOff));
                assert!(within((p.tangents[0].dot(&u) - body * moved[0]).abs(), 1e-15, RoundOff));
                assert!(within((p.tangents[1].dot(&u) - body * moved[1]).abs(), 1e-15, RoundOff));
            }
        }
    }
}

#[test]
fn lead_angle_leaves_the_load_to_the_lower_edge() {
    let lead = 0.05f64;
    let rig = rig(lead, 0.0, 0.0);
    let points = pair_surfaces(&surfaces(&rig, ContactPatch::Nearest(1e-3)), &reduce).unwrap();
    assert_eq!(points.len(), 2);
    assert!(points.iter().all(|p| p.weight == 0.5));
    let difference = (points[0].gap - points[1].gap).abs();
    assert!(within((difference - 1e-3 * lead.sin()).abs(), 1e-15, RoundOff));
}

#[test]
fn a_pad_on_a_face_has_its_area_and_its_thickness() {
    // A 20 × 20 mm pad of four quadrilaterals, 4 mm thick, lying on the slider with its own side down.
    let mut rig = rig(0.0, 0.0, 0.0);
    let first = rig.nodes.len();
    for i in 0..3 {
        for j in 0..3 {
            rig.nodes.push([0.01 * i as f64 + 0.003, 0.01 * j as f64 - 0.005, 2e-3 + 1e-5]);
        }
    }
    let at = |i: usize, j: usize| first + 3 * i + j;
    let faces: Vec<Cell> = (0..2)
        .flat_map(|i| (0..2).map(move |j| (i, j)))
        .map(|(i, j)| Cell::quadrilateral([at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)]))
        .collect();
    let pad = part("pad", 4e-3, faces.clone());
    let mut s = surfaces(&rig, ContactPatch::Reach(1e-3));
    (s.body, s.side) = (&pad, ContactSide::Face(&faces));
    let points = pair_surfaces(&s, &reduce).unwrap();
    assert_eq!(points.len(), 9);
    let area: f64 = points.iter().map(|p| p.weight).sum();
    assert!(within((area - 4e-4).abs(), 1e-17, RoundOff));
    for p in &points {
        assert!(
            within((p.gap - 1e-5).abs(), 1e-15, RoundOff)
                && within((p.position[2] - 1e-5).abs(), 1e-15, RoundOff)
        );
    }
}

/// A pad of one quadrilateral, `x` \[m\] from the middle of the slider, 10 µm above it.
fn add_pad(rig: &mut Rig, x: f64) -> Vec<Cell> {
    let first = rig.nodes.len();
    for [i, j] in [[0.0, 0.0], [0.01, 0.0], [0.01, 0.01], [0.0, 0.01]] {
        rig.nodes.push([x + i, 0.003 + j, 2e-3 + 1e-5]);
    }
    vec![Cell::quadrilateral([first, first + 1, first + 2, first + 3])]
}

/// The least gap decides; of nodes that are equally near but for round-off, none is preferred.
#[test]
fn equally_near_nodes_share_the_weight() {
    let mut rig = rig(0.0, 0.0, 0.0);
    let faces = add_pad(&mut rig, 0.003);
    for k in 0..4 {
        let at = rig.nodes.len() - 1 - k;
        rig.nodes[at][2] += 1e-16 * k as f64;
    }
    let pad = part("pad", 4e-3, faces.clone());
    let mut s = surfaces(&rig, ContactPatch::Nearest(1e-3));
    (s.body, s.side) = (&pad, ContactSide::Face(&faces));
    let points = pair_surfaces(&s, &reduce).unwrap();
    assert_eq!(points.iter().map(|p| p.weight).collect::<Vec<f64>>(), [0.25; 4]);
}

/// A pad that overhangs the slider is taken, whichever of its nodes is the nearest by round-off.
#[test]
fn a_pad_may_overhang() {
    for lift in [1e-16, -1e-16] {
        let mut rig = rig(0.0, 0.0, 0.0);
        let faces = add_pad(&mut rig, 0.095);
        let last = rig.nodes.len() - 2;
        rig.nodes[last][2] += lift;
        let pad = part("pad", 4e-3, faces.clone());
        let mut s = surfaces(&rig, ContactPatch::Reach(1e-3));
        (s.body, s.side) = (&pad, ContactSide::Face(&faces));
        assert_eq!(pair_surfaces(&s, &reduce).unwrap().len(), 2);
    }
}

/// Points over nodes, sides and diagonals of the faces move the same, whatever the order of faces and of their corners,
/// also on a plate that is not flat.
#[test]
fn points_do_not_depend_on_the_order_of_faces() {
    for (bend, theory) in
        [0.0, 1.0].into_iter().flat_map(|b| [(b, PlateTheory::Kirchhoff), (b, PlateTheory::Mindlin)])
    {
        let mut rig = rig(0.0, 0.0, 0.0);
        shell_of(&mut rig.slider).theory = theory;
        rig.nodes[181..].iter_mut().for_each(|x| x[2] += bend * x[0] * (0.1 * x[0] - 0.3 * x[1]));
        let faces = add_pad(&mut rig, 0.0);
        let pad = part("pad", 4e-3, faces.clone());
        let lines = [0, 2].map(|k| [faces[0].nodes()[k], faces[0].nodes()[k + 1]]);
        let mut s = surfaces(&rig, ContactPatch::Reach(5e-3));
        (s.body, s.side) = (&pad, ContactSide::Middle(&lines));
        let one = pair_surfaces(&s, &reduce).unwrap();
        let mut other = rig.slider.clone();
        other.cells.reverse();
        for (k, face) in other.cells.iter_mut().enumerate() {
            let mut corners = face.nodes().to_vec();
            corners.rotate_left(k % 4);
            *face = Cell::new(face.kind(), &corners).unwrap();
        }
        (s.counter, s.faces) = (&other, &other.cells);
        let other = pair_surfaces(&s, &reduce).unwrap();
        let n = 6 * rig.nodes.len();
        assert_eq!((one.len(), other.len()), (4, 4));
        for (a, b) in one.iter().zip(&other) {
            assert!(within((a.gap - b.gap).abs(), 1e-16, RoundOff));
            for (a, b) in
                [(&a.normal, &b.normal), (&a.tangents[0], &b.tangents[0]), (&a.tangents[1], &b.tangents[1])]
            {
                let difference = |k: usize| {
                    let unit: Vec<f64> = (0..n).map(|i| f64::from(u8::from(i == k))).collect();
                    (a.dot(&unit) - b.dot(&unit)).abs()
                };
                assert!((0..n).all(|k| within(difference(k), 1e-14, RoundOff)));
            }
        }
    }
}

fn fault(rig: &Rig, change: impl FnOnce(&mut Surfaces<'_>)) -> String {
    let mut s = surfaces(rig, ContactPatch::Reach(1e-3));
    change(&mut s);
    let error = pair_surfaces(&s, &reduce).unwrap_err();
    assert_eq!(error.exit_code(), 2);
    error.to_string()
}

#[test]
fn misplaced_bodies_are_explained() {
    assert!(fault(&rig(0.0, 0.0, 0.02), |_| {}).contains("0.02 m away"));
    assert!(fault(&rig(0.0, 0.3, 0.0), |_| {}).contains("beside `slider`"));
    assert!(fault(&rig(0.0, 0.0, -0.02), |_| {}).contains("inside each other"));
    let centred = rig(0.0, 0.0, 0.0);
    assert!(fault(&centred, |s| s.stroke = 0.25).contains("leaves `slider`"));
    assert!(fault(&centred, |s| s.sliding = Sliding::Along([0.0, 0.0, 1.0])).contains("sliding_direction"));
    const OFF: &[[usize; 2]] = &[[190, 191]];
    assert!(fault(&centred, |s| s.side = ContactSide::Edge(OFF)).contains("off part `disc`"));
    assert!(fault(&centred, |s| s.side = ContactSide::Edge(&[])).contains("no line or face"));
    // The node stands over the slider, but not the points at half the thickness of a thick disc.
    let mut thick = rig(0.0, 0.0, 0.0);
    shell_of(&mut thick.disc).thickness = 3.0;
    let text = fault(&thick, |_| {});
    assert!(
        text.contains("stands over none of the") && text.contains("the thickness of `disc`, 3 m"),
        "{text}"
    );
    // The reach that is offered is enough.
    let away = rig(0.0, 0.0, 0.02);
    let text = fault(&away, |_| {});
    assert!(text.contains("`contact.") && text.contains("`reach = \"20.200 mm\"` would take"), "{text}");
    assert!(pair_surfaces(&surfaces(&away, ContactPatch::Reach(20.2e-3)), &reduce).is_ok());
    let mut s = surfaces(&centred, ContactPatch::Reach(1e-3));
    s.stroke = 0.15;
    assert!(pair_surfaces(&s, &reduce).is_ok());
}

/// A quarter of a shaft in a quarter of a bore, solids of unlike meshes and kinds. Kinds with nodes in the middle of edges have curved faces:
/// gaps are those of the cylinders but for their parabolas, normals are radial, areas add up to that of the shaft; any rigid motion of either body
/// closes and slides each point as its displacement says.
#[test]
fn a_shaft_in_a_bore_has_a_frame_at_every_point() {
    let (radius, clearance) = (0.02, 1e-5);
    for (inner, outer, flat) in [
        (CellKind::Hexahedron20, CellKind::Tetrahedron10, false),
        (CellKind::Tetrahedron10, CellKind::Hexahedron27, false),
        (CellKind::Hexahedron8, CellKind::Hexahedron8, true),
    ] {
        let mut nodes: Vec<Vector> = Vec::new();
        let mut solid = |name: &str, kind: CellKind, from: f64, cells: [usize; 3]| {
            let mesh = structured_box(kind, [0.01, 1.0, 0.03], cells).unwrap();
            let first = nodes.len();
            nodes.extend(mesh.nodes.iter().map(|[r, angle, z]| {
                let angle = angle * std::f64::consts::FRAC_PI_2;
                [(from + r) * angle.cos(), (from + r) * angle.sin(), *z]
            }));
            let moved = |cell: &Cell| cell.renumbered(|node| first + node);
            let own: Vec<Cell> =
                mesh.elements.iter().filter(|cell| cell.dimension() == 3).map(moved).collect();
            let at = |cell: &Cell, r: f64| {
                cell.nodes().iter().all(|node| (mesh.nodes[node - first][0] - r).abs() < 1e-9)
            };
            let faces = outer_faces(own.iter());
            let sides =
                [0.0, 0.01].map(|r| faces.iter().filter(|face| at(face, r)).cloned().collect::<Vec<_>>());
            let solid = Solid { material: steel(), integration: Integration::Full };
            (Part::new(name, own, solid), sides, first..nodes.len())
        };
        let (shaft, [_, rubbing], of_shaft) = solid("shaft", inner, radius - clearance - 0.01, [1, 5, 3]);
        let (bore, [under, _], of_bore) = solid("bore", outer, radius, [2, 7, 2]);
        let s = Surfaces {
            faces: &under,
            patch: ContactPatch::Reach(2e-3),
            ..Surfaces::new(
                "fit",
                &nodes,
                [&shaft, &bore],
                ContactSide::Face(&rubbing),
                Sliding::Along([0.0, 0.0, 1.0]),
            )
        };
        let points = pair_surfaces(&s, &reduce).unwrap();
        assert!(points.len() == rubbing.len() * if inner == CellKind::Tetrahedron10 { 3 } else { 4 });
        let area: f64 = points.iter().map(|p| p.weight).sum();
        let exact = std::f64::consts::FRAC_PI_2 * (radius - clearance) * 0.03;
        let (of_area, of_gap, of_normal, of_motion) =
            if flat { (5e-3, 3e-4, 0.2, 1e-4) } else { (2e-5, 3e-6, 1e-2, 2e-6) };
        assert!(within((area / exact - 1.0).abs(), of_area, Discretisation), "{area} {exact}");
        let (t, r) = ([3e-4, -2e-4, 5e-4], [0.02, -0.03, 0.04]);
        for p in &points {
            assert!(within((p.gap - clearance).abs(), of_gap, Discretisation), "{}", p.gap);
            let out = unit([p.position[0], p.position[1], 0.0]).unwrap();
            let moved = |t, r, of: &std::ops::Range<usize>| rigid(&nodes, of.clone(), t, r);
            // n as the motion of the shaft along each axis shows it: gᵀu = −n·u of the shaft.
            let normal: Vector = std::array::from_fn(|k| {
                let along = std::array::from_fn(|i| f64::from(u8::from(i == k)));
                -p.normal.dot(&moved(along, [0.0; 3], &of_shaft))
            });
            assert!(
                within(dot(add(normal, out), add(normal, out)).sqrt(), of_normal, Discretisation),
                "{normal:?}"
            );
            // Means over a part of a face, of which those of linear functions are their values at the point.
            let foot = subtract(p.position, scale(p.gap, normal));
            for (sign, of, x) in [(1.0, &of_shaft, p.position), (-1.0, &of_bore, foot)] {
                let u = moved(t, r, of);
                let there = scale(sign, add(t, cross(r, x)));
                let off = (p.normal.dot(&u) + dot(there, normal)).abs();
                assert!(within(off, of_motion, Discretisation), "{off}");
                assert!(within((p.tangents[0].dot(&u) - there[2]).abs(), of_motion, Discretisation));
            }
            // Forces on both bodies have no moment together.
            let both = p.normal.dot(&moved(t, r, &of_shaft)) + p.normal.dot(&moved(t, r, &of_bore));
            assert!(within(both.abs(), 1e-9, Discretisation), "{both}");
        }
    }
}

/// A box of 20-node hexahedra with a corner at `at`, turned by `angle` about z there: the part and its faces that look along z (1) or against it (−1).
fn brick(
    nodes: &mut Vec<Vector>,
    (lengths, cells): (Vector, [usize; 3]),
    (at, angle): (Vector, f64),
    looks: f64,
) -> (Part, Vec<Cell>, Vec<Cell>) {
    let mesh = structured_box(CellKind::Hexahedron20, lengths, cells).unwrap();
    let first = nodes.len();
    let (sin, cos) = f64::sin_cos(angle);
    nodes.extend(mesh.nodes.iter().map(|[x, y, z]| add([cos * x - sin * y, sin * x + cos * y, *z], at)));
    let own = mesh.elements.iter().filter(|cell| cell.dimension() == 3);
    let own: Vec<Cell> = own.map(|cell| cell.renumbered(|node| first + node)).collect();
    let skin = outer_faces(own.iter());
    let side = if looks > 0.0 { lengths[2] } else { 0.0 };
    let on_side =
        |face: &&Cell| face.nodes().iter().all(|node| (mesh.nodes[node - first][2] - side).abs() < 1e-12);
    let looking = skin.iter().filter(on_side).cloned().collect();
    (Part::new("brick", own, Solid { material: steel(), integration: Integration::Full }), looking, skin)
}

/// A pad that is wider than the face under it: what is beside it is left out, and so are faces of the pad that look elsewhere. The pad ends over a
/// line of its own faces, or 5 mm beyond it.
#[test]
fn parts_beside_the_face_and_faces_that_look_away_are_left_out() {
    for (from, count) in [(0.02, 4 * 4), (0.015, 4 * 4 + 2 * 3)] {
        let mut nodes = Vec::new();
        let (disc, upper, _) = brick(&mut nodes, ([0.04, 0.04, 0.01], [2, 2, 1]), ([0.0; 3], 0.0), 1.0);
        let (mut pad, away, skin) =
            brick(&mut nodes, ([0.04, 0.02, 1e-4], [4, 2, 1]), ([from, 0.01, 0.01], 0.0), 1.0);
        pad.name = "pad".into();
        // With every face of a pad thinner than the reach.
        let along = Sliding::Along([1.0, 0.0, 0.0]);
        let mut s = Surfaces::new("face", &nodes, [&pad, &disc], ContactSide::Face(&skin), along);
        s.faces = &upper;
        let points = pair_surfaces(&s, &reduce).unwrap();
        assert_eq!(points.len(), count);
        let [area, middle] =
            [0, 1].map(|power| points.iter().map(|p| p.weight * p.position[0].powi(power)).sum::<f64>());
        let right = (0.04 - from) * 0.02;
        assert!(within((area - right).abs(), 1e-16, RoundOff), "{area}");
        assert!(within((middle - right * 0.5 * (0.04 + from)).abs(), 1e-17, RoundOff), "{middle}");
        assert!(points.iter().all(|p| within(p.gap.abs(), 1e-16, RoundOff) && p.position[0] < 0.04));
        s.side = ContactSide::Face(&away);
        let text = pair_surfaces(&s, &reduce).unwrap_err().to_string();
        assert!(text.contains("faces of `pad` that look away from `brick`"), "{text}");
    }
}

/// One face of the body over a smaller counter-body of several: three points have its area and its moments up to the second, and rigid motions
/// of the counter-body are felt as they are.
#[test]
fn a_small_counter_body_under_one_face_is_held_by_three_points() {
    let mut nodes = Vec::new();
    let (lengths, place) = ([0.012, 0.006, 0.004], ([0.011, 0.008, 0.0], 0.4));
    let (pin, upper, _) = brick(&mut nodes, (lengths, [3, 2, 1]), place, 1.0);
    let of_pin = 0..nodes.len();
    let (pad, lower, _) = brick(&mut nodes, ([0.04, 0.04, 0.01], [1; 3]), ([0.0, 0.0, 0.004], 0.0), -1.0);
    let along = Sliding::Along([1.0, 0.0, 0.0]);
    let mut s = Surfaces::new("face", &nodes, [&pad, &pin], ContactSide::Face(&lower), along);
    s.faces = &upper;
    let points = pair_surfaces(&s, &reduce).unwrap();
    assert_eq!(points.len(), 3);
    let area = lengths[0] * lengths[1];
    let ((sin, cos), [a, b, _]) = (place.1.sin_cos(), lengths);
    let middle = add(place.0, [0.5 * (cos * a - sin * b), 0.5 * (sin * a + cos * b), 0.0]);
    let sum = |of: &dyn Fn(Vector) -> f64| {
        points.iter().map(|p| p.weight * of(subtract(p.position, middle))).sum::<f64>() / area
    };
    assert!(within((sum(&|_| 1.0) - 1.0).abs(), 1e-13, RoundOff));
    assert!(within((sum(&|x| x[0]).abs() + sum(&|x| x[1]).abs()) / a, 1e-13, RoundOff));
    // ∫ x² = a²/12 along the edges of the pin.
    let (long, wide) = ([cos, sin, 0.0], [-sin, cos, 0.0]);
    assert!(within((sum(&|x| dot(x, long).powi(2)) / (a * a / 12.0) - 1.0).abs(), 1e-12, RoundOff));
    assert!(within((sum(&|x| dot(x, wide).powi(2)) / (b * b / 12.0) - 1.0).abs(), 1e-12, RoundOff));
    assert!(within(sum(&|x| dot(x, long) * dot(x, wide)).abs() / (a * b), 1e-13, RoundOff));
    let (t, r) = ([3e-4, -2e-4, 5e-4], [0.02, -0.03, 0.04]);
    let u = rigid(&nodes, of_pin, t, r);
    for p in &points {
        let there = add(t, cross(r, p.position));
        assert!(within((p.normal.dot(&u) - there[2]).abs(), 1e-15, RoundOff));
        assert!(within((p.tangents[0].dot(&u) + there[0]).abs(), 1e-15, RoundOff));
        assert!(within((p.tangents[1].dot(&u) + there[1]).abs(), 1e-15, RoundOff));
    }
}

/// Of counter-faces that lie over each other within reach, the nearest is touched, once.
#[test]
fn of_counter_faces_over_each_other_the_nearest_is_touched() {
    let mut nodes = Vec::new();
    let box_of = ([0.04, 0.04, 1e-4], [2, 2, 1]);
    let (_, mut upper, _) = brick(&mut nodes, box_of, ([0.0, 0.0, -5e-4], 0.0), 1.0);
    let (disc, above, _) = brick(&mut nodes, box_of, ([0.0, 0.0, 0.0], 0.0), 1.0);
    upper.extend(above);
    let (pad, lower, _) =
        brick(&mut nodes, ([0.02, 0.02, 0.01], [3, 3, 1]), ([0.01, 0.01, 1e-4 + 1e-5], 0.0), -1.0);
    let along = Sliding::Along([1.0, 0.0, 0.0]);
    let mut s = Surfaces::new("face", &nodes, [&pad, &disc], ContactSide::Face(&lower), along);
    s.faces = &upper;
    let points = pair_surfaces(&s, &reduce).unwrap();
    assert_eq!(points.len(), 9 * 4);
    assert!(points.iter().all(|p| within((p.gap - 1e-5).abs(), 1e-15, RoundOff)));
}
