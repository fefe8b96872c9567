//! Linear equations between degrees of freedom as a case has them, `[equation.NAME]`: closed forms, the same model without them, faults.

use crate::common::{lowest_frequencies, named_box};
use std::fmt::Write as _;
use stridor::bounds::{Origin::*, within};
use stridor::case::Case;
use stridor::job::{Prepared, Selection, analyse};
use stridor::mesh::generate::structured_box;
use stridor::mesh::{CellKind, Mesh, coincident, write};
use stridor::results::{ComplexResult, FrfResult, RunResults, TransientResult};

/// The lowest frequencies of a case with a mesh `a.msh` and a file of equations `a.csv`, where it names them.
fn frequencies(mesh: &Mesh, csv: &str, tables: &str, count: usize) -> Result<Vec<f64>, String> {
    let dir = tempfile::tempdir().unwrap();
    write(&dir.path().join("a.msh"), mesh, 1.0).unwrap();
    std::fs::write(dir.path().join("a.csv"), csv).unwrap();
    let case = Case::parse("a.toml", tables, dir.path().into()).map_err(|error| error.to_string())?;
    let prepared = Prepared::new(&case).map_err(|error| error.to_string())?;
    Ok(lowest_frequencies(&prepared.system.structure, count, 100.0))
}

/// Three masses on points; what holds them and what joins them is in `tables`.
fn points(tables: &str) -> String {
    format!(
        "[point]\na = [0, 0, 0]\nb = [0.3, 0, 0]\nc = [0, 0.2, 0]\n[mass.a]\non = \"a\"\nmass = 2\n[mass.b]\non = \"b\"\nmass = 0.5\n\
         [spring.s]\non = \"a\"\ndirection = [1, 0, 0]\nstiffness = 1e6\n\
         [support.a]\non = [\"a\", \"b\"]\nheld = [\"uy\", \"uz\"]\n[modes.all]\ncount = 1\n{tables}"
    )
}

/// Goal: of two masses that a lever couples, u_b = −2 u_a, ω² = k/(m_a + 4 m_b), whichever follows.
#[test]
fn a_lever_couples_two_masses() {
    let exact = (1e6_f64 / (2.0 + 4.0 * 0.5)).sqrt() / std::f64::consts::TAU;
    for (on, factor) in [("\"b\", \"a\"", "1, 2"), ("\"a\", \"b\"", "-3, -1.5")] {
        let equation =
            format!("[equation.lever]\non = [{on}]\ncomponent = [\"ux\", \"ux\"]\nfactor = [{factor}]\n");
        let found = frequencies(&Mesh::default(), "", &points(&equation), 1).unwrap();
        assert_eq!(found.len(), 1);
        assert!(within((found[0] / exact - 1.0).abs(), 1e-13, RoundOff), "{found:?} {exact}");
    }
    // The same in a file, over a point without mass: u_b = −2 u_c, u_c = u_a.
    let csv = "equation,node,component,factor\nlever,b,ux,1\nlever,c,ux,2\n2,c,ux,1\n2,a,ux,-1\n";
    let tables = points("[equation.e]\nfile = \"a.csv\"\n[support.c]\non = \"c\"\nheld = [\"uy\", \"uz\"]\n");
    let found = frequencies(&Mesh::default(), csv, &tables, 1).unwrap();
    assert!(within((found[0] / exact - 1.0).abs(), 1e-13, RoundOff), "{found:?} {exact}");
}

/// Goal: a rigid body written as equations, u = u₀ + θ × r with arms in m, is the rigid body.
#[test]
fn equations_of_a_rigid_body_are_the_rigid_body() {
    let tables = |link: &str| {
        format!(
            "[point]\na = [0, 0, 0]\nb = [0.3, -0.1, 0.2]\n[mass.a]\non = \"a\"\nmass = 2\ninertia = [0.01, 0.02, 0.03]\n\
             [mass.b]\non = \"b\"\nmass = 0.5\n[spring.x]\non = \"b\"\ndirection = [1, 0.3, 0.2]\nstiffness = 1e6\n\
             [spring.y]\non = \"b\"\ndirection = [-0.3, 1, 0.1]\nstiffness = 2e6\n[spring.z]\non = \"a\"\ndirection = [0, 0, 1]\nstiffness = 3e6\n\
             [modes.all]\ncount = 1\n{link}"
        )
    };
    let r = [0.3, -0.1, 0.2];
    let mut csv = "equation;node;component;factor\n".to_string();
    for k in 0..3 {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let axes = ["x", "y", "z"];
        writeln!(csv, "{k};b;u{};1\n{k};a;u{};-1", axes[k], axes[k]).unwrap();
        writeln!(csv, "{k};a;r{};{}\n{k};a;r{};{}", axes[i], -r[j], axes[j], r[i]).unwrap();
    }
    let own = frequencies(&Mesh::default(), &csv, &tables("[equation.e]\nfile = \"a.csv\"\n"), 6).unwrap();
    let rigid = tables("[rigid.r]\nmaster = \"a\"\nfollow = \"b\"\n");
    let rigid = frequencies(&Mesh::default(), "", &rigid, 6).unwrap();
    assert!(own[3] > 10.0 && own.len() == 6, "{own:?}");
    for (a, b) in own.iter().zip(&rigid).skip(3) {
        assert!(within((a / b - 1.0).abs(), 1e-11, RoundOff), "{own:?} {rigid:?}");
    }
}

const STEEL: &str = "[mesh]\nfile = \"a.msh\"\nunit = \"m\"\n[material.steel]\nyoungs_modulus = 2e11\npoissons_ratio = 0.3\ndensity = 8000\n";

/// Goal: two halves of a bar whose coincident nodes equations join, now one following and now the other, are the bar; its six rigid motions stay.
#[test]
fn halves_that_equations_join_are_the_whole() {
    let whole = structured_box(CellKind::Hexahedron20, [0.1, 0.02, 0.01], [4, 2, 1]).unwrap();
    let name = whole.regions[0].name.clone();
    let tables = format!("{STEEL}[solid.{name}]\nmaterial = \"steel\"\n[modes.all]\ncount = 1\n");
    let exact = frequencies(&whole, "", &tables, 10).unwrap();

    let mut halves = Mesh::default();
    for (name, x) in [("left", 0.0), ("right", 0.05)] {
        let half = (CellKind::Hexahedron20, [0.05, 0.02, 0.01], [2, 2, 1]);
        halves.append(named_box(name, " ", half, [x, 0.0, 0.0]));
    }
    let mut csv = "equation,node,component,factor\n".to_string();
    let mut count = 0;
    for [a, b] in coincident(&halves.nodes) {
        for component in ["ux", "uy", "uz"] {
            count += 1;
            let [first, other] = if count % 2 == 0 { [a, b] } else { [b, a] };
            writeln!(csv, "{count},{},{component},2\n{count},{},{component},-2", first + 1, other + 1)
                .unwrap();
        }
    }
    assert_eq!(count, 3 * 13);
    let tables = format!(
        "{STEEL}[solid.left]\nmaterial = \"steel\"\n[solid.right]\nmaterial = \"steel\"\n[modes.all]\ncount = 1\n\
         [equation.joint]\nfile = \"a.csv\"\n"
    );
    let found = frequencies(&halves, &csv, &tables, 10).unwrap();
    assert!(found[5] < 1.0 && exact[6] > 1000.0, "{found:?}");
    for (a, b) in found.iter().zip(&exact).skip(6) {
        assert!(within((a / b - 1.0).abs(), 1e-9, RoundOff), "{found:?} {exact:?}");
    }
}

/// Goal: an end whose nodes all move along x as one point does, ux of the region − ux of the point = 0, stays plane and bends as the middle of
/// a bar of twice the length that is held at both ends.
#[test]
fn a_region_follows_a_point_node_by_node() {
    let bar = |length: f64, cells: usize, tables: &str| {
        let bar = structured_box(CellKind::Hexahedron20, [length, 0.01, 0.01], [cells, 1, 1]).unwrap();
        let name = bar.regions[0].name.clone();
        let solid = format!("[solid.{name}]\nmaterial = \"steel\"\n[modes.all]\ncount = 1\n");
        frequencies(&bar, "", &format!("{tables}{STEEL}{solid}"), 2).unwrap()
    };
    let plane = "[equation.plane]\non = [\"x_max\", \"p\"]\ncomponent = [\"ux\", \"ux\"]\nfactor = [1, -1]\n";
    let half = bar(0.2, 6, &format!("[support.wall]\non = \"x_min\"\n[point]\np = [0.2, 0, 0]\n{plane}"));
    let whole = bar(0.4, 12, "[support.wall]\non = [\"x_min\", \"x_max\"]\n");
    assert!(half[0] > 100.0);
    for (a, b) in half.iter().zip(&whole) {
        assert!(within((a / b - 1.0).abs(), 1e-9, RoundOff), "{a} {b}");
    }
}

fn run(text: &str) -> RunResults {
    let case = Case::parse("case.toml", text, ".".into()).unwrap_or_else(|error| panic!("{error}"));
    let prepared = Prepared::new(&case).unwrap_or_else(|error| panic!("{error}"));
    analyse(&prepared, Selection::Listed, &mut |_| Ok(()), &()).unwrap_or_else(|error| panic!("{error}"))
}

/// Goal: a block on a belt that follows another mass, u = ½ u_m, is one block of m + 4 m_m to complex modes, frequency responses and motion in
/// time: springs, the contact with its friction and the force are all on what follows.
#[test]
fn every_analysis_sees_the_same_constrained_model() {
    let text = include_str!("../../validation/two-dof/case.toml").to_string()
        + "[transient]\nduration = 60\ntime_step = 0.05\ndisturbance = { amplitude = 1e-6 }\n\
           [frf.tap]\nband = [0.05, 0.5]\nsolution = \"direct\"\nexcitation = { on = \"block\", direction = [1, 0.5, 0] }\n";
    let text = text.replace("mu0 = 0.4", "mu0 = 0.9");
    let coupled = text
        .replace("block = [0, 0, 0]", "block = [0, 0, 0]\ntail = [1, 0, 0]")
        .replace("mass = \"1 kg\"", "mass = \"0.5 kg\"")
        + "[mass.tail]\non = \"tail\"\nmass = 0.125\n[support.tail]\non = \"tail\"\nheld = [\"uz\", \"rx\", \"ry\", \"rz\"]\n\
           [equation.x]\non = [\"block\", \"tail\"]\ncomponent = [\"ux\", \"ux\"]\nfactor = [2, -1]\n\
           [equation.y]\non = [\"block\", \"tail\"]\ncomponent = [\"uy\", \"uy\"]\nfactor = [2, -1]\n";
    let [one, two] = [run(&text), run(&coupled)];
    let modes = |results: &RunResults| {
        let modes = &results.get::<ComplexResult>().unwrap().modes.modes;
        modes.iter().map(|mode| mode.eigenvalue).collect::<Vec<_>>()
    };
    assert!(modes(&one).iter().any(|value| value.re > 0.01) && modes(&one).len() == modes(&two).len());
    for (a, b) in modes(&one).iter().zip(&modes(&two)) {
        assert!(within((a - b).norm() / a.norm(), 1e-10, RoundOff), "{a} {b}");
    }
    let responses = |results: &RunResults| results.get::<FrfResult>().unwrap().responses[0].values.clone();
    let largest = responses(&one).iter().map(|h| h.norm()).fold(0.0, f64::max);
    assert!(responses(&one).len() > 10 && responses(&one).len() == responses(&two).len());
    for (a, b) in responses(&one).iter().zip(&responses(&two)) {
        assert!(within((a - b).norm() / largest, 1e-10, RoundOff), "{a} {b}");
    }
    let growth = |results: &RunResults| {
        let growth = results.get::<TransientResult>().unwrap().growth.clone().expect("a disturbance");
        growth.found.unwrap_or_else(|| panic!("{:?}", growth.refused)).rate
    };
    let [a, b] = [growth(&one), growth(&two)];
    assert!(a > 0.01 && within((a / b - 1.0).abs(), 1e-5, Tolerance), "{a} {b}");
}

#[test]
fn faults_of_equations_have_their_place() {
    let said = |csv: &str, tables: &str| frequencies(&Mesh::default(), csv, &points(tables), 1).unwrap_err();
    let equation = |name: &str, on: &str, component: &str, factor: &str| {
        format!("[equation.{name}]\non = [{on}]\ncomponent = [{component}]\nfactor = [{factor}]\n")
    };
    let expect = |text: String, parts: &[&str]| {
        for part in parts {
            assert!(text.contains(part), "{part}: {text}");
        }
        assert_eq!(text.matches("found").count(), 1, "{text}");
    };
    let xx = "\"ux\", \"ux\"";
    expect(said("", &equation("e", "\"a\", \"d\"", xx, "1, 1")), &["a.toml:21 `equation.e.on`", "\"d\""]);
    expect(said("", &equation("e", "\"a\", \"b\"", "\"ux\"", "1, 1")), &["a.toml:22 `equation.e.component`"]);
    expect(
        said("", &equation("e", "\"a\", \"b\"", "\"ux\", \"u\"", "1, 1")),
        &["`equation.e.component`", "rz"],
    );
    expect(
        said("", &equation("e", "\"a\", \"b\"", xx, "0, 1")),
        &["a.toml:23 `equation.e.factor`", "not zero"],
    );
    expect(said("", &equation("e", "\"a\", \"a\"", xx, "1, -1")), &["`equation.e`", "add up to nothing"]);
    let two = equation("e", "\"a\", \"b\"", xx, "1, 1") + &equation("f", "\"a\", \"c\"", xx, "1, 1");
    expect(said("", &two), &["a.toml:24 `equation.f`", "node 1 (`a`)", "already follows", "`equation.e`"]);
    let circle = equation("e", "\"a\", \"b\"", xx, "1, 1") + &equation("f", "\"b\", \"a\"", xx, "1, 1");
    expect(said("", &circle), &["`equation.", "a circle"]);
    let held = equation("e", "\"a\", \"b\"", "\"uy\", \"ux\"", "1, 1");
    expect(said("", &held), &["`support.a.on`", "follows others by `equation.e`"]);
    let rigid = equation("e", "\"a\", \"b\"", xx, "1, 1") + "[rigid.r]\nmaster = \"c\"\nfollow = \"a\"\n";
    let rigid = points(&rigid).replace("[support.a]\non = [\"a\", \"b\"]", "[support.a]\non = [\"b\"]");
    let text = frequencies(&Mesh::default(), "", &rigid, 1).unwrap_err();
    expect(text, &["`equation.e`", "already follows", "`rigid.r`"]);

    let file = "[equation.e]\nfile = \"a.csv\"\n";
    let head = "equation,node,component,factor\n";
    expect(said(&format!("{head}1,7,ux,1\n1,a,ux,1\n"), file), &["a.csv:2 `node`", "node 7"]);
    expect(said(&format!("{head}1,a,u,1\n"), file), &["a.csv:2 `component`", "\"u\""]);
    expect(said(&format!("{head}1,a,ux,0\n1,b,ux,1\n"), file), &["a.csv:2 `factor`", "not zero"]);
    expect(said(&format!("{head}1,a,ux,x\n1,b,ux,1\n"), file), &["a.csv:2 `factor`", "\"x\""]);
    expect(said("equation,node,component,factor,constant\n1,a,ux,1,3\n", file), &["a.csv:1", "\"constant\""]);
    let apart = format!("{head}1,a,ux,1\n1,b,ux,1\n2,c,ux,1\n2,b,uy,1\n1,b,ux,1\n");
    expect(said(&apart, file), &["a.csv:6 `equation`", "again"]);
    let twice = format!("{head}1,a,ux,1\n1,b,ux,1\n2,a,ux,1\n2,c,ux,1\n");
    expect(
        said(&twice, file),
        &["a.toml:20 `equation.e` (", "a.csv:4, equation 2", "already follows", "a.csv:2, equation 1"],
    );
}
