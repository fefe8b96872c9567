//! The same model described in another way has the same complex eigenvalues: turned and moved in space, mirrored, with nodes
//! and elements in another order, in other units.

use std::fmt::Write;
use std::path::Path;
use stridor::bounds::{Origin::*, within};
use stridor::case::Case;
use stridor::job::{Prepared, Selection, analyse};
use stridor::linalg::c64;
use stridor::mesh::generate::{Faces, structured_plate};
use stridor::mesh::{Cell, Mesh, gmsh};
use stridor::results::ComplexResult;
use stridor::stability::ComplexMode;

/// A pad on the face of a disc. What has a direction is written as x, y and z of the model.
const CASE: &str = r#"
title = "A pad on a disc"
[mesh]
file = "mesh.msh"
unit = "m"
[material.steel]
youngs_modulus = "210 GPa"
poissons_ratio = 0.3
density = "7850 kg/m^3"
[material.lining]
youngs_modulus = "8 GPa"
poissons_ratio = 0.25
density = "2500 kg/m^3"
loss_factor = 0.02
[shell.disc]
material = "steel"
thickness = "1 mm"
[shell.pad]
material = "lining"
thickness = "5 mm"
[support.hub]
on = "hub"
[spring.along]
on = "pad"
direction = Y
stiffness = "20 MN/m"
[spring.radial]
on = "pad"
direction = Z
stiffness = "20 MN/m"
[force.piston]
on = "pad"
force = F
[contact.face]
body = "pad"
counter = "disc"
approach = 0
sliding_velocity = "2 m/s"
sliding_direction = Y
normal = { per = "area", stiffness = "100 GN/m^3" }
friction = { law = "coulomb", mu0 = 0.4 }
[cea]
band = [0, "2 kHz"]
"#;

type Vector = [f64; 3];

/// An orthogonal matrix by its columns: what x, y and z of the model become.
type Frame = [Vector; 3];

const ITSELF: Frame = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

fn turned(frame: &Frame, x: Vector) -> Vector {
    std::array::from_fn(|i| (0..3).map(|j| frame[j][i] * x[j]).sum())
}

/// The rotation by `angle` \[rad\] about the unit vector `axis` (Rodrigues).
fn rotation(axis: Vector, angle: f64) -> Frame {
    let (sine, cosine) = angle.sin_cos();
    ITSELF.map(|x| {
        let along: f64 = (0..3).map(|i| axis[i] * x[i]).sum();
        let across = [
            axis[1] * x[2] - axis[2] * x[1],
            axis[2] * x[0] - axis[0] * x[2],
            axis[0] * x[1] - axis[1] * x[0],
        ];
        std::array::from_fn(|i| cosine * x[i] + sine * across[i] + (1.0 - cosine) * along * axis[i])
    })
}

fn mesh() -> Mesh {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes/pad-on-disc.msh");
    gmsh::read(&path, 1e-3).expect("a sound mesh")
}

/// A pad of quadrilaterals on a square plate of quadrilaterals in place of the disc: most nodes of the pad are over
/// nodes, sides and diagonals of the plate.
fn quadrilaterals() -> Mesh {
    let plate = |length: f64, width: f64, nx, ny, name: &str, x: f64| {
        let made = structured_plate(length, width, nx, ny, Faces::Quadrilaterals);
        let mut mesh = made.expect("a sound mesh");
        mesh.nodes.iter_mut().for_each(|[y, z, at]| [*y, *z, *at] = [x, *y, *z]);
        mesh.regions.iter_mut().for_each(|region| region.name = region.name.replace("plate", name));
        mesh
    };
    let mut mesh = plate(0.12, 0.12, 8, 8, "disc", 0.0);
    mesh.regions.iter_mut().filter(|r| r.name == "disc_edge_x_min").for_each(|r| r.name = "hub".into());
    mesh.append(plate(0.03, 0.02, 6, 4, "pad", 3e-3));
    mesh
}

/// The elements in another order, each beginning at another corner.
fn with_elements_shuffled(mesh: &Mesh) -> Mesh {
    let (order, mut next) = (shuffled(mesh.elements.len()), random(4));
    let mut other = mesh.clone();
    other.elements = order.iter().map(|k| mesh.elements[*k].clone()).collect();
    for element in &mut other.elements {
        let mut nodes = element.nodes().to_vec();
        let count = nodes.len();
        nodes.rotate_left(next() % count);
        *element = Cell::new(element.kind(), &nodes).unwrap();
    }
    for region in &mut other.regions {
        let of = |k: &usize| region.elements.binary_search(&order[*k]).is_ok();
        region.elements = (0..order.len()).filter(of).collect();
    }
    other
}

/// Pseudo-random numbers below `count`.
fn random(count: usize) -> impl FnMut() -> usize {
    let mut seed = 5_u64;
    move || {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 33) as usize % count
    }
}

/// 0 … `count` − 1 in a random order.
fn shuffled(count: usize) -> Vec<usize> {
    let (mut order, mut next): (Vec<usize>, _) = ((0..count).collect(), random(count));
    (0..count).for_each(|k| order.swap(k, next()));
    order
}

/// The mesh as MSH 2.2 in metres with every digit; node k is the `nodes`\[k\]-th of the file.
fn written(mesh: &Mesh, nodes: &[usize]) -> String {
    let mut text = String::from("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n");
    let mut line = |words: std::fmt::Arguments<'_>| writeln!(text, "{words}").expect("memory");
    line(format_args!("$PhysicalNames\n{}", mesh.regions.len()));
    for (k, region) in mesh.regions.iter().enumerate() {
        line(format_args!("{} {} \"{}\"", region.dimension, k + 1, region.name));
    }
    line(format_args!("$EndPhysicalNames\n$Nodes\n{}", mesh.nodes.len()));
    for (k, [x, y, z]) in mesh.nodes.iter().enumerate() {
        line(format_args!("{} {x:e} {y:e} {z:e}", nodes[k] + 1));
    }
    line(format_args!("$EndNodes\n$Elements\n{}", mesh.elements.len()));
    for (k, element) in mesh.elements.iter().enumerate() {
        let region = mesh.regions.iter().position(|r| r.elements.contains(&k)).expect("its region") + 1;
        let corners = element.nodes();
        let kind = [15, 1, 2, 3][corners.len() - 1];
        let around: Vec<String> = corners.iter().map(|node| (nodes[*node] + 1).to_string()).collect();
        line(format_args!("{} {kind} 2 {region} {region} {}", k + 1, around.join(" ")));
    }
    line(format_args!("$EndElements"));
    text
}

/// λ with what may be wrong with it as a part of |λ|: ten times the error that the program estimates, and round-off.
type Value = (c64, f64);

/// The complex eigenvalues of the `case` on a mesh.
fn eigenvalues(case: &str, mesh: &str) -> Vec<Value> {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("mesh.msh"), mesh).expect("a file");
    let case = Case::parse("the case", case, folder.path().to_path_buf()).expect("a sound case");
    let prepared = Prepared::new(&case).expect("a sound model");
    let mut results = analyse(&prepared, Selection::Listed, &mut |_| Ok(()), &()).expect("results");
    let modes = results.take::<ComplexResult>().expect("complex modes").modes.modes;
    let error = |mode: &ComplexMode| 10.0 * mode.eigenvalue_error + ROUND_OFF * mode.condition;
    modes.iter().map(|mode| (mode.eigenvalue, error(mode))).collect()
}

fn in_frame(frame: &Frame, case: &str) -> String {
    let list = |x: Vector| format!("{:?}", turned(frame, x));
    let force = turned(frame, [-50.0, 0.0, 0.0]);
    let case = case.replace("= F", &format!("= {force:?}"));
    case.replace("= Y", &format!("= {}", list(ITSELF[1]))).replace("= Z", &format!("= {}", list(ITSELF[2])))
}

fn as_it_is(mesh: &Mesh) -> String {
    written(mesh, &(0..mesh.nodes.len()).collect::<Vec<_>>())
}

fn of_the_model(mesh: &Mesh) -> Vec<Value> {
    eigenvalues(&in_frame(&ITSELF, CASE), &as_it_is(mesh))
}

/// Round-off of the coordinates, 10⁻¹⁶, through the conditioning of a thin plate's bending, 10⁷ at most here.
const ROUND_OFF: f64 = 1e-9;

/// Asserts that the eigenvalues are the same but for what may be wrong with either.
fn assert_same(what: &str, a: &[Value], b: &[Value]) {
    assert!(a.len() > 6, "{} eigenvalues", a.len());
    assert_eq!(a.len(), b.len(), "{what}: the number of modes");
    for (a, error) in a {
        let nearest = b.iter().min_by(|(b, _), (c, _)| (a - b).norm().total_cmp(&(a - c).norm()));
        let (b, other) = nearest.expect("eigenvalues");
        let off = (a - b).norm() / a.norm();
        assert!(within(*error, 1e-6, Tolerance), "{what}: {a} with an error of {error:e}");
        assert!(
            within(off, error + other, Stated),
            "{what}: {a} and {b} differ by {off:e}; expected {:e}",
            error + other
        );
    }
}

/// The model in a frame and moved by (0.3, −0.1, 0.2) m has the same eigenvalues.
fn assert_same_in(frame: &Frame, mesh: &Mesh) {
    let mut other = mesh.clone();
    for x in &mut other.nodes {
        let at = turned(frame, *x);
        *x = [at[0] + 0.3, at[1] - 0.1, at[2] + 0.2];
    }
    let found = eigenvalues(&in_frame(frame, CASE), &as_it_is(&other));
    assert_same("the other", &of_the_model(mesh), &found);
}

#[test]
fn turned_and_moved_in_space() {
    let frame = rotation([2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0], 1.1);
    [mesh(), quadrilaterals()].iter().for_each(|mesh| assert_same_in(&frame, mesh));
}

#[test]
fn mirrored() {
    let frame = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]];
    assert_same_in(&frame, &mesh());
}

#[test]
fn with_nodes_in_another_order() {
    let mesh = mesh();
    let other = written(&mesh, &shuffled(mesh.nodes.len()));
    assert_same("the other", &of_the_model(&mesh), &eigenvalues(&in_frame(&ITSELF, CASE), &other));
}

#[test]
fn with_elements_in_another_order_and_from_another_corner() {
    for mesh in [mesh(), quadrilaterals()] {
        assert_same("the other", &of_the_model(&mesh), &of_the_model(&with_elements_shuffled(&mesh)));
    }
}

/// Plates by Mindlin's theory, triangles and true quadrilaterals.
#[test]
fn thick_plates_in_another_order_from_another_corner_turned_and_moved() {
    let thick = CASE.replace("thickness =", "theory = \"mindlin\"\nthickness =");
    let frame = rotation([2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0], 1.1);
    for mesh in [mesh(), quadrilaterals()] {
        let one = eigenvalues(&in_frame(&ITSELF, &thick), &as_it_is(&mesh));
        let mut other = with_elements_shuffled(&mesh);
        assert_same("shuffled", &one, &eigenvalues(&in_frame(&ITSELF, &thick), &as_it_is(&other)));
        for x in &mut other.nodes {
            let at = turned(&frame, *x);
            *x = [at[0] + 0.3, at[1] - 0.1, at[2] + 0.2];
        }
        assert_same("turned", &one, &eigenvalues(&in_frame(&frame, &thick), &as_it_is(&other)));
    }
}

#[test]
fn in_other_units() {
    let mut case = in_frame(&ITSELF, CASE);
    for (from, to) in [
        ("210 GPa", "210e3 MPa"),
        ("8 GPa", "8000 N/mm^2"),
        ("7850 kg/m^3", "7.85 g/cm^3"),
        ("2500 kg/m^3", "2.5 g/cm^3"),
        ("\"1 mm\"", "0.001"),
        ("5 mm", "0.5 cm"),
        ("20 MN/m", "20 kN/mm"),
        ("100 GN/m^3", "100 N/mm^3"),
        ("2 m/s", "2000 mm/s"),
        ("2 kHz", "2000 Hz"),
    ] {
        assert!(case.contains(from), "{from}");
        case = case.replace(from, to);
    }
    let mesh = mesh();
    let one = of_the_model(&mesh);
    assert_same("the other", &one, &eigenvalues(&case, &as_it_is(&mesh)));
    // In millimetres, the mesh is read with another unit.
    let mut in_millimetres = mesh;
    in_millimetres.nodes.iter_mut().flatten().for_each(|x| *x *= 1000.0);
    let case = case.replace("unit = \"m\"", "unit = \"mm\"");
    assert_same("the other", &one, &eigenvalues(&case, &as_it_is(&in_millimetres)));
}
