//! Ties, averaging links and supports about an axis as a case has them: frequencies, warnings, faults with key and line.

use crate::common::{lowest_frequencies, named_box};
use stridor::bounds::{Origin::*, least, within};
use stridor::case::Case;
use stridor::job::{Prepared, Selection, analyse, check_case};
use stridor::mesh::generate::{Faces, structured_annulus, structured_box, structured_plate};
use stridor::mesh::{CellKind, Mesh, write};
use stridor::results::{ComplexResult, SensitivityResult};

/// A bar of 100 × 20 × 10 mm along x of two boxes that share no nodes, `gap` apart; regions `left`, `left x_max` and so on.
fn bar(gap: f64) -> Mesh {
    let mut bar = Mesh::default();
    for (name, kind, cells, x) in [
        ("left", CellKind::Hexahedron20, [3, 2, 1], 0.0),
        ("right", CellKind::Tetrahedron10, [3, 3, 1], 0.05 + gap),
    ] {
        bar.append(named_box(name, " ", (kind, [0.05, 0.02, 0.01], cells), [x, 0.0, 0.0]));
    }
    bar
}

const PARTS: &str = "[material.steel]\nyoungs_modulus = 2e11\npoissons_ratio = 0.3\ndensity = 8000\n\
                     [solid.left]\nmaterial = \"steel\"\n[solid.right]\nmaterial = \"steel\"\n[modes.all]\ncount = 1\n";

/// What a case on a mesh has: the frequencies, the warnings.
fn answer(mesh: &Mesh, tables: &str, count: usize) -> Result<(Vec<f64>, String), String> {
    let dir = tempfile::tempdir().unwrap();
    write(&dir.path().join("a.msh"), mesh, 1.0).unwrap();
    let text = format!("[mesh]\nfile = \"a.msh\"\nunit = \"m\"\n{tables}");
    let case = Case::parse("a.toml", &text, dir.path().into()).map_err(|error| error.to_string())?;
    let prepared = Prepared::new(&case).map_err(|error| error.to_string())?;
    let said = check_case(&prepared).map_err(|error| error.to_string())?.sentences.join("\n");
    Ok((lowest_frequencies(&prepared.system.structure, count, 100.0), said))
}

#[test]
fn a_tie_joins_what_shares_no_nodes_and_says_what_it_did() {
    let tie = |more: &str| format!("{PARTS}[tie.middle]\non = \"right x_min\"\nto = \"left x_max\"\n{more}");
    let (joined, said) = answer(&bar(0.0), &tie(""), 8).unwrap();
    assert_eq!(said, "");
    // A free bar of 100 × 10 mm bends at 5.1 kHz by Euler and Bernoulli, a little lower with shear.
    let euler = 4.730_040_745_f64.powi(2) / std::f64::consts::TAU / 0.01
        * (2e11 * 0.01_f64.powi(2) / 12.0 / 8000.0).sqrt();
    assert!(joined[5] < 1.0 && within((joined[6] / euler - 0.98).abs(), 0.03, Theory), "{joined:?} {euler}");
    // Apart, twelve motions are free.
    let (apart, said) = answer(&bar(0.0), PARTS, 13).unwrap();
    assert!(apart[11] < 1.0 && apart[12] > 1000.0, "{apart:?}");
    assert!(said.contains("`[tie]`"), "{said}");
    let (gap, said) = answer(&bar(1e-4), &tie(""), 8).unwrap();
    assert!(said.contains("`tie.middle`: gaps up to 0.0001 m") && said.contains("kept"), "{said}");
    assert!(within((gap[6] / joined[6] - 1.0).abs(), 3e-3, Theory) && gap[5] < 1.0, "{gap:?}");
    // A plate that is longer than what it is tied to.
    let (_, said) = answer(
        &bar(0.0),
        &format!("{PARTS}[tie.a]\non = \"right z_min\"\nto = \"left x_max\"\nwithin = 1e-3\n"),
        7,
    )
    .unwrap();
    assert!(
        said.contains("`tie.a`: ")
            && said.contains("not joined to `left x_max`: farther than 0.001 m, at most 0.05"),
        "{said}"
    );
}

#[test]
fn faults_of_ties_are_told_with_key_and_line() {
    let of = |gap: f64, tables: &str| answer(&bar(gap), &format!("{PARTS}{tables}"), 1).unwrap_err();
    let tie = |on: &str, to: &str| format!("[tie.a]\non = \"{on}\"\nto = \"{to}\"\n");
    let expect = |text: String, parts: &[&str]| {
        for part in parts {
            assert!(text.contains(part), "{part}: {text}");
        }
        assert_eq!(text.matches("found").count(), 1, "{text}");
    };
    expect(
        of(0.5, &tie("right x_min", "left x_max")),
        &["a.toml:15 `tie.a.on`", "the nearest is 0.5 m away", "a larger `within`"],
    );
    expect(
        of(0.0, &tie("right x_mim", "left x_max")),
        &["a.toml:15 `tie.a.on`", "Did you mean \"right x_min\""],
    );
    expect(of(0.0, &tie("right x_min", "left x_mox")), &["a.toml:16 `tie.a.to`", "\"left x_mox\""]);
    expect(of(0.0, &tie("right", "left x_max")), &["a.toml:15 `tie.a.on`", "of solids on `right`"]);
    expect(of(0.0, &tie("right x_min", "left")), &["a.toml:16 `tie.a.to`", "a region of solids"]);
    let both = tie("right x_min", "left x_max") + "[support.s]\non = \"right x_min\"\n";
    expect(of(0.0, &both), &["a.toml:18 `support.s.on`", "follow others by `tie.a`"]);
    let circle = tie("right x_min", "left x_max") + "[tie.b]\non = \"left x_max\"\nto = \"right x_min\"\n";
    expect(of(0.0, &circle), &["a.toml:17 `tie.b`", "a circle"]);
    let twice = tie("right x_min", "left x_max") + "[tie.b]\non = \"right x_min\"\nto = \"left x_max\"\n";
    expect(of(0.0, &twice), &["a.toml:17 `tie.b`", "already follow by `tie.a`"]);
    let own = "[point]\np = [0.1, 0, 0]\n[averaging.m]\npoint = \"p\"\nof = [\"p\", \"right x_max\"]\n";
    expect(of(0.0, own), &["`averaging.m.of`", "the point itself"]);
    let line = "[point]\np = [0, 0, 0]\nq = [1, 0, 0]\nr = [2, 0, 0]\n[averaging.m]\npoint = \"p\"\nof = [\"q\", \"r\"]\n";
    expect(of(0.0, line), &["`averaging.m.of`", "on one line"]);
}

/// What acts on rotations is refused on nodes of solids, and taken on a point that an averaging link or a rigid body joins to them.
#[test]
fn rotations_of_solids_are_refused_with_what_to_write() {
    let tie = "[tie.a]\non = \"right x_min\"\nto = \"left x_max\"\n";
    let acting = |on: &str| {
        [
            format!(
                "[spring.s]\non = \"{on}\"\ndirection = [1, 0, 0]\nrotational = true\nstiffness = 1000\n"
            ),
            format!("[mass.m]\non = \"{on}\"\nmass = 0.01\ninertia = [1e-6, 0, 0]\n"),
            format!("[support.h]\non = \"{on}\"\nheld = [\"ux\", \"rx\"]\n"),
        ]
    };
    for (tables, key) in
        acting("right x_max").iter().zip(["spring.s.rotational", "mass.m.inertia", "support.h.held"])
    {
        let text = answer(&bar(0.0), &format!("{PARTS}{tie}{tables}"), 1).unwrap_err();
        assert!(text.contains(&format!("`{key}`")) && text.contains("[averaging]"), "{text}");
    }
    let point = "[point]\np = [0.11, 0.01, 0.005]\n";
    for link in [
        "[averaging.m]\npoint = \"p\"\nof = \"right x_max\"\n",
        "[rigid.m]\nmaster = \"p\"\nfollow = \"right x_max\"\n",
    ] {
        for tables in &acting("p")[..2] {
            let (found, _) = answer(&bar(0.0), &format!("{PARTS}{tie}{point}{link}{tables}"), 8).unwrap();
            // A spring holds one of six motions.
            let free = if tables.contains("spring") { 5 } else { 6 };
            assert!(found[free - 1] < 1.0 && found[free] > 10.0, "{tables}: {found:?}");
        }
    }
    // A support of an averaged point would hold a sum.
    let text = answer(
        &bar(0.0),
        &format!(
            "{PARTS}{tie}{point}[averaging.m]\npoint = \"p\"\nof = \"right x_max\"\n[support.h]\non = \"p\"\n"
        ),
        1,
    )
    .unwrap_err();
    assert!(text.contains("`support.h.on`") && text.contains("`averaging.m`"), "{text}");
}

/// Springs per area act by the area, whatever the meshes are, and on rotations by the way they are spread: two blocks of 0.08 kg on springs of 1 GN/m³ over
/// 200 mm².
#[test]
fn springs_per_area_act_on_displacements_and_rotations_of_faces() {
    let of = |to: &str, free: usize, mass: f64| {
        let text = format!(
            "{PARTS}[spring.a]\non = \"right x_min\"\n{to}per = \"area\"\ndirection = [1, 0, 0]\nstiffness = \"1 GN/m^3\"\n"
        );
        let (found, _) = answer(&bar(1e-5), &text, 12).unwrap();
        assert!(found[free - 1] < 1.0 && found[free] > 50.0, "{to}: {found:?}");
        let right = (1e9_f64 * 2e-4 / mass).sqrt() / std::f64::consts::TAU;
        // The blocks are not rigid: 1e-3 by E A/l beside the springs.
        let off = least(found[free..].iter().map(|f| (f / right - 1.0).abs()));
        assert!(within(off, 1e-3, Theory), "{to}: {found:?} {right}");
    };
    of("to = \"left x_max\"\n", 9, 0.04);
    of("", 9, 0.08);
    let fault = |tables: &str| {
        answer(&bar(0.0), &format!("{PARTS}[spring.a]\n{tables}direction = [1, 0, 0]\nstiffness = 1\n"), 1)
            .unwrap_err()
    };
    let text = fault("on = \"right\"\nper = \"area\"\n");
    assert!(text.contains("`spring.a.on`") && text.contains("a region of faces"), "{text}");
    let text = fault("on = \"right x_min\"\nper = \"area\"\nrotational = true\n");
    assert!(text.contains("`spring.a.rotational`"), "{text}");
    let text = fault("on = \"right x_min\"\nto = \"right x_max\"\nper = \"area\"\n");
    assert!(text.contains("`spring.a.on`") && text.contains("no node within"), "{text}");
}

/// Derivatives of complex eigenvalues are those of whole analyses on both sides, also by scalars that move what the constraints are made of: the thickness of
/// a plate tied on edge, the stiffness of a layer, the mass on an averaged point and its place.
#[test]
fn sensitivities_go_through_constraints() {
    let mut mesh = structured_box(CellKind::Hexahedron8, [0.05, 0.02, 0.01], [3, 2, 1]).unwrap();
    mesh.regions[0].name = "block".into();
    let mut plate = structured_plate(0.04, 0.02, 3, 3, Faces::Triangles).unwrap();
    plate.nodes.iter_mut().for_each(|x| *x = [x[0] + 0.07, x[1] + 0.01, 0.005]);
    mesh.append(plate);
    let dir = tempfile::tempdir().unwrap();
    write(&dir.path().join("a.msh"), &mesh, 1.0).unwrap();
    let text = "[mesh]\nfile = \"a.msh\"\nunit = \"m\"\n[material.steel]\nyoungs_modulus = 2e11\npoissons_ratio = 0.3\ndensity = 8000\n\
                [solid.block]\nmaterial = \"steel\"\n[shell.plate]\nmaterial = \"steel\"\nthickness = 0.003\n\
                [tie.a]\non = \"plate_edge_x_min\"\nto = \"x_max\"\n[point]\np = [0.025, 0.01, 0.02]\n\
                [averaging.m]\npoint = \"p\"\nof = \"z_max\"\n[mass.m]\non = \"p\"\nmass = 0.05\ninertia = [1e-6, 2e-6, 1e-6]\n\
                [spring.s]\non = \"x_min\"\nper = \"area\"\ndirection = [1, 1, 0]\nstiffness = 1e12\n\
                [spring.t]\non = \"x_min\"\nper = \"area\"\ndirection = [1, -1, 0]\nstiffness = 1e12\n\
                [spring.u]\non = \"z_max\"\nper = \"area\"\ndirection = [0, 0, 1]\nstiffness = 1e12\n\
                [contact.floor]\nbody = \"z_min\"\ncounter = \"ground\"\ninto = [0, 0, -1]\napproach = 1e-6\nsliding_velocity = 1\n\
                normal = { per = \"area\", stiffness = 1e12 }\nfriction = { law = \"coulomb\", mu0 = 0.4 }\n\
                [damping]\nmodal_ratio = 0.005\n[cea]\nband = [10, 9e3]\n[sensitivity]\nmodes = MODES\nparameters = [\"shell.plate.thickness\", \
                \"spring.s.stiffness\", \"mass.m.mass\", \"point.p.2\"]\n";
    let case = Case::parse("a.toml", &text.replace("MODES", "[]"), dir.path().into()).unwrap();
    let of = |case: &Case, selection: Selection| {
        analyse(&Prepared::new(case).unwrap(), selection, &mut |_| Ok(()), &()).unwrap()
    };
    let plain = of(&case, Selection::Only("cea")).take::<ComplexResult>().unwrap().modes.modes;
    let mut hz: Vec<f64> = plain.iter().map(|mode| mode.eigenvalue.im / std::f64::consts::TAU).collect();
    hz.dedup_by(|a, b| (*a / *b - 1.0).abs() < 0.01);
    let case = Case::parse("a.toml", &text.replace("MODES", &format!("{hz:?}")), dir.path().into()).unwrap();
    let found = of(&case, Selection::Listed).take::<SensitivityResult>().unwrap();
    assert!(!found.modes.is_empty());
    let paths: Vec<&str> = found.modes[0].parameters.iter().map(|rate| rate.path.as_str()).collect();
    assert!(paths.len() >= 4, "{paths:?}");
    for path in paths {
        let value = found.modes[0].parameters.iter().find(|rate| rate.path == path).unwrap().value;
        let step = 1e-4 * value;
        let [up, down] = [step, -step].map(|step| {
            let case = case.with_parameter(path, value + step).unwrap();
            of(&case, Selection::Only("cea")).take::<ComplexResult>().unwrap().modes.modes
        });
        for mode in &found.modes {
            let rate = mode.parameters.iter().find(|rate| rate.path == path).unwrap();
            let [a, b] = [&up, &down].map(|all| {
                all.iter()
                    .map(|m| m.eigenvalue)
                    .min_by(|a, b| (a - mode.eigenvalue).norm().total_cmp(&(b - mode.eigenvalue).norm()))
                    .unwrap()
            });
            let expected = (a - b) / (2.0 * step);
            let size = mode.eigenvalue.norm() / value;
            println!("{path} {:.0}: {:.3e}", mode.eigenvalue.im, (rate.rate - expected).norm() / size);
            // The step's square and the error of the eigenvalues over the step, by the size of λ/p.
            let bound = 1e-5 * size + 1e-3 * expected.norm();
            assert!(
                within((rate.rate - expected).norm(), bound, Reference),
                "{path}: {} {expected}",
                rate.rate
            );
        }
    }
}

/// A ring in any plane, held about its axis in each set of directions: as many motions stay free as geometry says.
#[test]
fn supports_about_an_axis_leave_the_motions_that_they_do_not_hold() {
    let ring = structured_annulus(0.05, 0.1, 3, 12).unwrap();
    let turn = nalgebra::Rotation3::from_euler_angles(0.4, -0.7, 0.3);
    for turned in [false, true] {
        let mut mesh = ring.clone();
        let middle = [0.2, -0.1, 0.3];
        for x in &mut mesh.nodes {
            let at = if turned { turn * nalgebra::Vector3::from(*x) } else { nalgebra::Vector3::from(*x) };
            *x = std::array::from_fn(|k| at[k] + middle[k]);
        }
        let along = if turned { turn * nalgebra::Vector3::x() } else { nalgebra::Vector3::x() };
        let shell = "[material.steel]\nyoungs_modulus = 2e11\npoissons_ratio = 0.3\ndensity = 8000\n[shell.disc]\nmaterial = \"steel\"\n\
                     thickness = 0.005\n[modes.all]\ncount = 1\n";
        let held = |names: &str| {
            format!(
                "{shell}[support.hub]\non = \"hub\"\nheld = [{names}]\naxis = {{ through = {middle:?}, along = [{}, {}, {}] }}\n",
                along.x, along.y, along.z
            )
        };
        for (names, free) in [
            ("\"radial\"", 4),
            ("\"tangential\"", 3),
            ("\"axial\"", 3),
            ("\"radial\", \"tangential\"", 3),
            ("\"radial\", \"axial\"", 1),
            ("\"tangential\", \"axial\"", 0),
            ("\"radial\", \"tangential\", \"axial\"", 0),
        ] {
            let (found, _) = answer(&mesh, &held(names), free + 1).unwrap();
            assert!(found[free] > 100.0 && (free == 0 || found[free - 1] < 1.0), "{names}: {found:?}");
        }
        // Rotations stay free at a held hub in both ways to say it.
        let plain = format!("{shell}[support.hub]\non = \"hub\"\nheld = [\"ux\", \"uy\", \"uz\"]\n");
        let [a, b] = [plain, held("\"radial\", \"tangential\", \"axial\"")]
            .map(|text| answer(&mesh, &text, 3).unwrap().0);
        assert_eq!(a, b);
    }
    let said = |held: &str| {
        let text = format!(
            "[point]\na = [0, 0, 1]\n[mass.m]\non = \"a\"\nmass = 1\n[support.s]\non = \"a\"\n{held}\n[modes.all]\ncount = 1\n"
        );
        let case = Case::parse("a.toml", &text, "".into()).map_err(|error| error.to_string());
        case.and_then(|case| Prepared::new(&case).map(drop).map_err(|error| error.to_string())).unwrap_err()
    };
    let text = said("held = [\"radial\"]\naxis = { along = [0, 0, 1] }");
    assert!(text.contains("`support.s.on`") && text.contains("on the `axis`"), "{text}");
    let text = said("held = [\"radial\"]");
    assert!(text.contains("`support.s.held`") && text.contains("without an `axis`"), "{text}");
    let text = said("held = [\"ux\"]\naxis = { along = [0, 0, 1] }");
    assert!(text.contains("with an `axis`"), "{text}");
}
