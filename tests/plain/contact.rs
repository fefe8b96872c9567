//! Contact between faces of solids whose meshes do not match: patch tests, Hertz, a shaft in a bore, friction of a pad.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use stridor::bounds::{Origin::*, within};
use stridor::case::Case;
use stridor::equilibrium::{SteadyOptions, SteadySliding, solve_steady};
use stridor::job::Prepared;
use stridor::mesh::generate::structured_box;
use stridor::mesh::{CellKind, Mesh, write};

const E: f64 = 2e11;
const NU: f64 = 0.3;

/// A box of `kind` whose nodes are moved to where `place` puts them; regions `NAME`, `NAME_x_min` and so on.
fn solid(name: &str, kind: CellKind, cells: [usize; 3], place: impl Fn([f64; 3]) -> [f64; 3]) -> Mesh {
    let mut mesh = structured_box(kind, [1.0; 3], cells).unwrap();
    mesh.nodes.iter_mut().for_each(|x| *x = place(*x));
    for region in &mut mesh.regions {
        region.name = if region.dimension == 3 { name.into() } else { format!("{name}_{}", region.name) };
    }
    mesh
}

/// The steady state of two solids `body` and `counter` of steel in contact, and what `see` finds in it.
fn steady<T>(meshes: [Mesh; 2], tables: &str, see: impl Fn(&Prepared, &SteadySliding) -> T) -> T {
    let [mut mesh, other] = meshes;
    mesh.append(other);
    let dir = tempfile::tempdir().unwrap();
    write(&dir.path().join("a.msh"), &mesh, 1.0).unwrap();
    let text = format!(
        "[mesh]\nfile = \"a.msh\"\nunit = \"m\"\n[material.steel]\nyoungs_modulus = {E}\npoissons_ratio = {NU}\n\
         density = 7850\n[solid.body]\nmaterial = \"steel\"\nallow_locking = true\n[solid.counter]\nmaterial = \"steel\"\nallow_locking = true\n{tables}\
         [modes.all]\ncount = 1\n"
    );
    let case = Case::parse("a.toml", &text, dir.path().into()).unwrap();
    let prepared = Prepared::new(&case).unwrap_or_else(|error| panic!("{error}"));
    let steady = solve_steady(&prepared.system, &SteadyOptions::default(), &()).unwrap();
    see(&prepared, &steady)
}

fn held(regions: &[(&str, &str)]) -> String {
    let support =
        |(k, (on, held)): (usize, &(&str, &str))| format!("[support.s{k}]\non = \"{on}\"\nheld = [{held}]\n");
    regions.iter().enumerate().map(support).collect()
}

/// `[contact.face]` of `body` on `counter`, each by a region of faces.
fn contact(body: &str, counter: &str, stiffness: f64, mu: f64, more: &str) -> String {
    format!(
        "[contact.face]\nbody = \"{body}\"\ncounter = \"{counter}\"\n{more}\nnormal = {{ per = \"area\", stiffness = {stiffness} }}\n\
         friction = {{ law = \"coulomb\", mu0 = {mu} }}\n"
    )
}

/// Positions, pressures and areas of the points.
fn pressures(prepared: &Prepared, steady: &SteadySliding) -> Vec<([f64; 3], f64, f64)> {
    let of =
        |((_, point), state): ((_, &stridor::system::ContactPoint), &stridor::equilibrium::PointState)| {
            (point.position, state.forces.normal / point.weight, point.weight)
        };
    prepared.system.points().zip(&steady.points).map(of).collect()
}

/// σ_zz in the middle of every cell, of an isotropic solid.
fn stresses(prepared: &Prepared, steady: &SteadySliding) -> Vec<f64> {
    let u = prepared.assembled.dofs.expand(&steady.displacement);
    let nodes = &prepared.model.nodes;
    let mut found = Vec::new();
    for cell in prepared.model.parts.iter().flat_map(|part| &part.cells) {
        let corners = cell.kind().corners();
        let middle: [f64; 3] =
            std::array::from_fn(|k| corners.iter().map(|c| c[k]).sum::<f64>() / corners.len() as f64);
        let tangents = nalgebra::Matrix3::from_fn(|i, j| cell.tangents(nodes, middle)[j][i]);
        let by_xi = nalgebra::Matrix3::from_fn(|i, j| {
            let slopes = cell.kind().shape_gradients(middle);
            cell.nodes().iter().zip(slopes).map(|(node, slope)| u[*node][i] * slope[j]).sum::<f64>()
        });
        let strain = by_xi * tangents.try_inverse().unwrap();
        let lame = E * NU / ((1.0 + NU) * (1.0 - 2.0 * NU));
        found.push(lame * strain.trace() + E / (1.0 + NU) * strain[(2, 2)]);
    }
    found
}

/// The largest error of pressures and of stresses of two blocks of 20 × 20 × 10 mm that are pressed together by 1 µm, against
/// p = a/(1/k_n + 2 h/E).
fn patch(body: (CellKind, [usize; 3]), counter: (CellKind, [usize; 3]), stiffness: f64) -> [f64; 2] {
    let (side, height, approach) = (0.02, 0.01, 1e-4);
    let block = |name: &str, (kind, cells): (CellKind, [usize; 3]), z: f64| {
        solid(name, kind, cells, |x| [side * x[0], side * x[1], z + height * x[2]])
    };
    let tables = held(&[
        ("body_z_max", "\"uz\""),
        ("counter_z_min", "\"uz\""),
        ("body_x_min", "\"ux\""),
        ("counter_x_min", "\"ux\""),
        ("body_y_min", "\"uy\""),
        ("counter_y_min", "\"uy\""),
    ]) + &contact(
        "body_z_min",
        "counter_z_max",
        stiffness,
        0.0,
        &format!("approach = {approach}\nsliding_velocity = 1"),
    );
    let exact = approach / (1.0 / stiffness + 2.0 * height / E);
    steady([block("body", body, height), block("counter", counter, 0.0)], &tables, |prepared, steady| {
        // Towards the counter-body, on whose face the points lie.
        let [[press, _]] = prepared.arrows()[..] else { panic!("one pair") };
        assert!(within((press[2] + 1.0).abs(), 1e-12, RoundOff), "{press:?}");
        let off = |values: Vec<f64>| values.iter().map(|p| (p / exact - 1.0).abs()).fold(0.0, f64::max);
        [
            off(pressures(prepared, steady).iter().map(|(_, p, _)| *p).collect()),
            off(stresses(prepared, steady).iter().map(|s| -s).collect()),
        ]
    })
}

/// Goal: a constant pressure between blocks, whether their meshes match or not. What is left is rounding: of gaps of p/k_n, which are differences of
/// displacements of 0.1 mm, and of the solution, whose refinement stops at a residual of 1e-15.
#[test]
fn matching_and_unlike_faces_pass_the_contact_patch_test() {
    use CellKind::*;
    let kinds = [Hexahedron8, Hexahedron20, Hexahedron27, Tetrahedron4, Tetrahedron10, Wedge6, Wedge15];
    let matching = kinds.map(|kind| ((kind, [3, 2, 1]), (kind, [3, 2, 2])));
    let pairs = [
        (Hexahedron8, Hexahedron20),
        (Hexahedron20, Tetrahedron10),
        (Tetrahedron10, Hexahedron8),
        (Tetrahedron4, Wedge15),
        (Wedge15, Tetrahedron4),
    ];
    // Finer, coarser, and with faces of the counter-body inside of those of the body.
    let cells = [([4, 4, 2], [3, 3, 2]), ([3, 3, 2], [4, 4, 2]), ([2, 3, 1], [7, 5, 2])];
    let unlike = pairs.iter().flat_map(|(a, b)| cells.map(|(n, m)| ((*a, n), (*b, m))));
    for (body, counter) in matching.into_iter().chain(unlike) {
        for (stiffness, bound) in [(1e12, 1e-12), (1e14, 5e-12)] {
            let off = patch(body, counter, stiffness);
            assert!(
                off.iter().all(|off| within(*off, bound, RoundOff)),
                "{body:?} {counter:?} {stiffness:e} {off:?}"
            );
        }
    }
}

/// Hertz's pressure of a cylinder or a sphere of radius R on a rigid plane: the root of the mean square error over the points of the contact,
/// as a part of the largest pressure; the error at the point nearest to the middle; that of the half-width by the second moment, ∫ p x² dA = b² P/4 or
/// ∫ p r² dA = 2 a² P/5.
///
/// The body is a block of `depth` half-widths whose lower face is the paraboloid or the parabola (Hertz's assumption), its cells are smaller
/// towards the middle.
fn hertz(sphere: bool, n: usize, kind: CellKind) -> [f64; 3] {
    let (radius, half_width, depth) = (0.1, 1e-3, 16.0);
    let plane_strain = E / (1.0 - NU * NU);
    let wide = depth * half_width;
    let across = if sphere { wide } else { half_width };
    let cells = [n, if sphere { n } else { 1 }, n];
    let graded = |s: f64| if sphere { 0.1 * s + 0.9 * s.powi(4) } else { 0.25 * s + 0.75 * s * s * s } * wide;
    let place = |x: [f64; 3]| {
        let at = [graded(x[0]), if sphere { graded(x[1]) } else { across * x[1] }, graded(x[2])];
        let square = at[0] * at[0] + if sphere { at[1] * at[1] } else { 0.0 };
        // The parabola fades upwards.
        [at[0], at[1], at[2] + 0.5 * square / radius * (1.0 - at[2] / wide)]
    };
    let plane = |x: [f64; 3]| [2.0 * wide * x[0], 2.0 * across * x[1], 1e-3 * (x[2] - 1.0)];
    // P for the half-width: P' = π E* b²/4R of a length, P = 4 E* a³/3R; the part of it in the quarter that is meshed.
    let load = match sphere {
        true => 4.0 * plane_strain * half_width.powi(3) / (3.0 * radius) / 4.0,
        false => PI * plane_strain * half_width.powi(2) / (4.0 * radius) * across / 2.0,
    };
    let largest = match sphere {
        true => 1.5 * 4.0 * load / (PI * half_width.powi(2)),
        false => 2.0 * (2.0 * load / across) / (PI * half_width),
    };
    let mut supports = vec![
        ("counter", "\"all\""),
        ("body_z_max", "\"ux\", \"uy\", \"uz\""),
        ("body_x_min", "\"ux\""),
        ("body_y_min", "\"uy\""),
    ];
    if !sphere {
        supports.push(("body_y_max", "\"uy\""));
    }
    let tables = held(&supports)
        + &contact(
            "body_z_min",
            "counter_z_max",
            300.0 * E / half_width,
            0.0,
            &format!("load = {load}\nsliding_velocity = 1\nreach = {}", 2.0 * half_width.powi(2) / radius),
        );
    let meshes = [solid("body", kind, cells, place), solid("counter", CellKind::Hexahedron8, [1; 3], plane)];
    steady(meshes, &tables, |prepared, steady| {
        let points = pressures(prepared, steady);
        let from_middle = |x: [f64; 3]| if sphere { x[0].hypot(x[1]) } else { x[0] } / half_width;
        let exact = |x: [f64; 3]| largest * (1.0 - from_middle(x).powi(2)).max(0.0).sqrt();
        let square: f64 = points.iter().map(|(x, p, w)| w * (p - exact(*x)).powi(2)).sum();
        let area = if sphere { PI * half_width.powi(2) / 4.0 } else { half_width * across };
        let middle = points.iter().min_by(|a, b| from_middle(a.0).total_cmp(&from_middle(b.0))).unwrap();
        let moment: f64 = points.iter().map(|(x, p, w)| w * p * from_middle(*x).powi(2)).sum();
        let width = (moment / load * if sphere { 2.5 } else { 4.0 }).sqrt();
        [(square / area).sqrt() / largest, middle.1 / exact(middle.0) - 1.0, width - 1.0].map(f64::abs)
    })
}

/// Goal: Hertz's pressure on cells from a quarter of the half-width on. What is left of a fine mesh is that of the block, which is 16 half-widths deep,
/// and of the contact stiffness. Where the contact ends inside of a face, the pressure of single points is off.
#[test]
fn pressure_of_a_cylinder_and_of_a_sphere_is_that_of_hertz() {
    use CellKind::*;
    for kind in [Hexahedron20, Tetrahedron10] {
        let [coarse, fine] = [16, 64].map(|n| hertz(false, n, kind));
        let order = (coarse[0] / fine[0]).log2() / 2.0;
        assert!(order > 1.0, "{kind:?} {order}: {coarse:?} {fine:?}");
        for (off, bound) in fine.iter().zip([2e-2, 1e-3, 1e-3]) {
            assert!(within(*off, bound, Discretisation), "{kind:?} {fine:?}");
        }
        let sphere = hertz(true, 8, kind);
        assert!(
            within(sphere[1], 0.03, Discretisation) && within(sphere[2], 0.02, Discretisation),
            "{kind:?} {sphere:?}"
        );
    }
    let hexahedra = hertz(false, 64, Hexahedron8);
    assert!(hexahedra.iter().all(|off| within(*off, 5e-3, Discretisation)), "{hexahedra:?}");
}

/// A quarter of a hollow shaft in a quarter of a ring, of radii 10, 20 and 35 mm, in plane strain, with an interference of 5 µm that comes from the
/// approach (faces that fit, whatever their meshes) or from the geometry: the largest error of the pressures against Lamé's,
///
/// p = Δ/(1/k_n + (R/E′)((c² + R²)/(c² − R²) + (R² + a²)/(R² − a²))), E′ = E/(1 − ν²): ν cancels between equal materials.
fn shaft(kinds: [CellKind; 2], [inner, outer]: [usize; 2], closed: bool) -> f64 {
    let (a, radius, c, length, interference) = (0.01, 0.02, 0.035, 0.004, 5e-6);
    let stiffness = 1e13;
    let ring = |name: &str, kind: CellKind, cells: [usize; 3], from: f64, to: f64| {
        solid(name, kind, cells, |x| {
            let (r, angle) = (from + (to - from) * x[0], FRAC_PI_2 * x[1]);
            [r * angle.cos(), r * angle.sin(), length * x[2]]
        })
    };
    let over = if closed { 0.0 } else { interference };
    let meshes = [
        ring("body", kinds[0], [4, inner, 1], a, radius + over),
        ring("counter", kinds[1], [6, outer, 2], radius, c),
    ];
    let mut supports = Vec::new();
    for part in ["body", "counter"] {
        // Angle 0 is the plane y = 0, the right angle x = 0.
        supports.push((format!("{part}_y_min"), "\"uy\""));
        supports.push((format!("{part}_y_max"), "\"ux\""));
        supports.push((format!("{part}_z_min"), "\"uz\""));
        supports.push((format!("{part}_z_max"), "\"uz\""));
    }
    let supports: Vec<(&str, &str)> = supports.iter().map(|(on, held)| (on.as_str(), *held)).collect();
    let pressing = if closed {
        format!("approach = {interference}\ninitial_gap = \"closed\"")
    } else {
        "approach = 0".into()
    };
    let tables = held(&supports)
        + &contact(
            "body_x_max",
            "counter_x_min",
            stiffness,
            0.0,
            &format!("{pressing}\nsliding_velocity = 1\nsliding_direction = [0, 0, 1]"),
        );
    let square = |x: f64| x * x;
    let part = |inner: f64, outer: f64| (square(outer) + square(inner)) / (square(outer) - square(inner));
    let compliance = radius * (1.0 - NU * NU) / E * (part(radius, c) + part(a, radius));
    let exact = interference / (1.0 / stiffness + compliance);
    steady(meshes, &tables, |prepared, steady| {
        pressures(prepared, steady).iter().map(|(_, p, _)| (p / exact - 1.0).abs()).fold(0.0, f64::max)
    })
}

/// Goal: a curved conforming pair, to 1e-4 whether the meshes match or not. Gaps between unlike meshes, which are those of parabolas in place of
/// circles, fall with the fourth power of the size of a face.
#[test]
fn a_shaft_in_a_bore_has_the_pressure_of_lame() {
    use CellKind::*;
    let kinds = [Hexahedron20, Hexahedron20];
    for cells in [[4, 4], [4, 7], [16, 28]] {
        let off = shaft(kinds, cells, true);
        assert!(within(off, 1e-4, Discretisation), "{cells:?} {off}");
    }
    let matching = shaft(kinds, [4, 4], false);
    assert!(within(matching, 3e-4, Discretisation), "{matching}");
    let [coarse, fine] = [[4, 7], [16, 28]].map(|cells| shaft(kinds, cells, false));
    let order = (coarse / fine).log2() / 2.0;
    assert!(within(fine, 1e-3, Discretisation) && order > 3.5, "{coarse} {fine}");
    for (kinds, bound) in [([Tetrahedron10, Hexahedron27], 2e-4), ([Hexahedron8, Hexahedron8], 5e-3)] {
        let unlike = shaft(kinds, [16, 28], true);
        assert!(within(unlike, bound, Discretisation), "{kinds:?} {unlike}");
    }
}

/// A sector of 60° of a pad on a ring that turns: the pressure is constant, as the bodies are far stiffer than the contact, friction turns with the
/// point. The force on the pad is μ p ∫ e_θ dA, its moment about the axis μ p ∫ r dA, and at every point the slip is Ω r.
#[test]
fn friction_of_a_pad_turns_with_the_disc() {
    let (inner, outer, mu, stiffness, approach) = (0.06, 0.1, 0.4, 1e9, 1e-6);
    let sector = |name: &str, kind: CellKind, cells: [usize; 3], angle: f64, z: f64| {
        solid(name, kind, cells, |x| {
            // The pad is narrower than the disc.
            let margin = if name == "body" { 0.0 } else { 0.01 };
            let r = inner - margin + (outer - inner + 2.0 * margin) * x[0];
            let angle = angle * (x[1] - 0.5);
            [0.3 + r * angle.cos(), 0.1 + r * angle.sin(), z + 0.01 * x[2]]
        })
    };
    let meshes = [
        sector("body", CellKind::Tetrahedron10, [3, 5, 1], PI / 3.0, 0.01),
        sector("counter", CellKind::Hexahedron20, [3, 12, 1], 0.5 * PI, 0.0),
    ];
    let tables = held(&[("body_z_max", "\"all\""), ("counter_z_min", "\"all\"")])
        .replace("[\"all\"]", "\"all\"")
        + &contact(
            "body_z_min",
            "counter_z_max",
            stiffness,
            mu,
            &format!(
                "approach = {approach}\nrotation = {{ axis = [0, 0, -1], point = [0.3, 0.1, 7], speed = \"300 rpm\" }}"
            ),
        );
    steady(meshes, &tables, |prepared, steady| {
        let pair = &prepared.system.pairs[0];
        let (mut force, mut moment, mut normal) = ([0.0; 2], 0.0, 0.0);
        for (point, state) in pair.points.iter().zip(&steady.points) {
            let arm = [point.position[0] - 0.3, point.position[1] - 0.1];
            let radius = arm[0].hypot(arm[1]);
            // Clockwise, as the axis looks down.
            let along = [arm[1] / radius, -arm[0] / radius];
            let speed = TAU * 5.0 * radius;
            assert!(within((pair.velocity_at(point) / speed - 1.0).abs(), 1e-13, RoundOff));
            let [f1, f2] = state.forces.friction;
            assert!(within((f1 - mu * state.forces.normal).abs() + f2.abs(), 1e-12 * f1, RoundOff));
            (0..2).for_each(|k| force[k] += f1 * along[k]);
            moment += f1 * (arm[0] * along[1] - arm[1] * along[0]);
            normal += state.forces.normal;
        }
        let pressure = stiffness * approach;
        let area = PI / 6.0 * (outer * outer - inner * inner);
        // ∫ e_θ dA over ±30°, along −y; ∫ r dA.
        let along = 0.5 * (outer * outer - inner * inner) * 2.0 * (PI / 6.0).sin();
        let turning = PI / 3.0 * (outer.powi(3) - inner.powi(3)) / 3.0;
        let near = |found: f64, exact: f64| {
            assert!(within((found / exact - 1.0).abs(), 1e-3, Theory), "{found} {exact}")
        };
        near(normal, pressure * area);
        near(force[1], -mu * pressure * along);
        near(moment, -mu * pressure * turning);
        assert!(within((force[0] / force[1]).abs(), 1e-3, Theory), "{force:?}");
        // V at the mean radius.
        let mean = turning / area;
        assert!(within((pair.sliding_velocity / (TAU * 5.0 * mean) - 1.0).abs(), 1e-4, Discretisation));
    });
}

/// Two faces of one solid do not touch, however near they are; two pieces of one part do.
#[test]
fn a_body_that_would_touch_itself_is_refused() {
    let plate = |z: f64| move |x: [f64; 3]| [0.02 * x[0], 0.02 * x[1], z + 5e-4 * x[2]];
    let answer = |body: &str, counter: &str| {
        let mut mesh = solid("one", CellKind::Hexahedron20, [2, 2, 1], plate(0.0));
        mesh.append(solid("other", CellKind::Hexahedron20, [3, 3, 1], plate(5.1e-4)));
        let all: Vec<_> = mesh.elements.iter().filter(|cell| cell.dimension() == 3).cloned().collect();
        mesh.add_region("both", 3, all);
        let dir = tempfile::tempdir().unwrap();
        write(&dir.path().join("a.msh"), &mesh, 1.0).unwrap();
        let text = format!(
            "[mesh]\nfile = \"a.msh\"\nunit = \"m\"\n[material.steel]\nyoungs_modulus = {E}\npoissons_ratio = {NU}\n\
             density = 7850\n[solid.both]\nmaterial = \"steel\"\n{}[modes.all]\ncount = 1\n",
            contact(body, counter, 1e12, 0.3, "approach = 1e-6\nsliding_velocity = 1")
        );
        let case = Case::parse("a.toml", &text, dir.path().into()).unwrap();
        Prepared::new(&case)
            .map(|prepared| prepared.system.points().count())
            .map_err(|error| error.to_string())
    };
    assert_eq!(answer("other_z_min", "one_z_max"), Ok(9 * 4));
    let itself = answer("one_z_max", "one_z_min").unwrap_err();
    assert!(
        itself.contains("`contact.face.counter`") && itself.contains("none is in contact with itself"),
        "{itself}"
    );
    let edge = answer("one_z_max", "one_x_min").unwrap_err();
    assert!(edge.contains("of the 21 nodes of the body"), "{edge}");
}
