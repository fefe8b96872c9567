//! Faces that press each other and do not slide: held by their friction, as joined ones are the more, the stiffer the contact.

use crate::common::{lowest_frequencies, named_box};
use stridor::bounds::{Origin::*, within};
use stridor::case::Case;
use stridor::job::{Prepared, Selection, analyse};
use stridor::mesh::{CellKind, Mesh, write};
use stridor::results::{ComplexResult, TransientResult};

/// A bar of 100 × 20 × 10 mm along x, clamped at x = 0, of two boxes that share no nodes.
fn bar() -> Mesh {
    let mut bar = Mesh::default();
    for (name, x) in [("left", 0.0), ("right", 0.05)] {
        let half = (CellKind::Hexahedron20, [0.05, 0.02, 0.01], [3, 2, 1]);
        bar.append(named_box(name, " ", half, [x, 0.0, 0.0]));
    }
    bar
}

fn with<T>(tables: &str, see: impl Fn(&Case) -> T) -> T {
    let dir = tempfile::tempdir().unwrap();
    write(&dir.path().join("a.msh"), &bar(), 1.0).unwrap();
    let text = format!(
        "[mesh]\nfile = \"a.msh\"\nunit = \"m\"\n[material.steel]\nyoungs_modulus = 2e11\npoissons_ratio = 0.3\n\
         density = 8000\n[solid.left]\nmaterial = \"steel\"\n[solid.right]\nmaterial = \"steel\"\n[support.root]\n\
         on = \"left x_min\"\n{tables}"
    );
    see(&Case::parse("a.toml", &text, dir.path().into()).unwrap())
}

/// The frequencies below 20 kHz \[Hz\]; none grows or decays.
fn frequencies(tables: &str) -> Vec<f64> {
    with(&format!("{tables}[cea]\nband = [0, 20000]\n"), |case| {
        let mut found =
            analyse(&Prepared::new(case).unwrap(), Selection::Only("cea"), &mut |_| Ok(()), &()).unwrap();
        let modes = found.take::<ComplexResult>().unwrap().modes.modes;
        for mode in &modes {
            let growth = mode.eigenvalue.re.abs() / mode.eigenvalue.im;
            assert!(within(growth, 1e-9, RoundOff), "{growth:e}");
        }
        modes.iter().map(|mode| mode.eigenvalue.im / std::f64::consts::TAU).collect()
    })
}

/// The halves pressed together by 10 MPa of the far end, with a stiffness per area of the faces along and across.
fn pressed(stiffness: f64, mu: f64) -> String {
    format!(
        "[force.press]\non = \"right x_max\"\nforce = [-2000, 0, 0]\n\
         [contact.middle]\nbody = \"right x_min\"\ncounter = \"left x_max\"\napproach = 0\nsliding_velocity = 0\n\
         sliding_direction = [0, 1, 0]\nnormal = {{ per = \"area\", stiffness = {stiffness} }}\n\
         friction = {{ law = \"coulomb\", mu0 = {mu} }}\n"
    )
}

/// Goal: the frequencies of a tied bar, with an error that falls as 1/k.
#[test]
fn a_contact_that_sticks_tends_to_a_tie() {
    let tie = "[tie.middle]\non = \"right x_min\"\nto = \"left x_max\"\n[modes.all]\ncount = 1\n";
    let mut tied =
        with(tie, |case| lowest_frequencies(&Prepared::new(case).unwrap().system.structure, 20, 0.0));
    tied.retain(|hz| *hz < 20000.0);
    assert!((5..20).contains(&tied.len()), "{tied:?}");
    let off = |stiffness: f64| {
        let found = frequencies(&pressed(stiffness, 0.5));
        assert_eq!(found.len(), tied.len());
        let apart = found.iter().zip(&tied).map(|(found, tied)| 1.0 - found / tied);
        apart.fold([f64::INFINITY, 0.0], |[least, most], off| [least.min(off), most.max(off)])
    };
    let [soft, stiff] = [off(1e14), off(1e15)];
    // Softer than a tie, each of them.
    assert!(soft[0] > 0.0 && stiff[0] > 0.0, "{soft:?} {stiff:?}");
    assert!(within(stiff[1], 3e-3, Theory), "{stiff:?}");
    let order = (soft[1] / stiff[1]).log10();
    assert!(within((order - 1.0).abs(), 0.05, Theory), "{order}");
}

/// In time a bar that is pressed rests where it is, and its points stick.
#[test]
fn what_sticks_rests_in_time() {
    let transient = "[cea]\nband = [0, 6000]\n[transient]\nduration = 1e-4\ntime_step = 2e-6\n[transient.probe.tip]\n\
                     at = [0.1, 0.01, 0.005]\ndirection = [0, 1, 0]\n";
    with(
        &format!("{}[force.side]\non = \"right x_max\"\nforce = [0, 50, 0]\n{transient}", pressed(1e13, 0.5)),
        |case| {
            let mut found =
                analyse(&Prepared::new(case).unwrap(), Selection::Listed, &mut |_| Ok(()), &()).unwrap();
            let run = found.take::<TransientResult>().unwrap();
            assert_eq!(run.set_valued, Vec::<String>::new());
            // Of the 10 mJ that bend the bar.
            let moved = run.work.heat.abs() + run.work.normal.abs() + run.work.external.abs();
            assert!(within(moved, 1e-8, RoundOff), "{:?}", run.work);
            assert!(run.events.iter().all(|count| *count == 0), "{:?}", run.events);
        },
    );
}
