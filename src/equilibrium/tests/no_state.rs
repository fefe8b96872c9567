//! Systems that have a steady state for a part of load and friction alone: the part has a closed form, and the error names what happens there.

use super::super::samples::*;
use super::super::*;
use crate::bounds::{Origin::*, within};
use crate::contact::{Bristle, Coulomb, NormalLaw, SlidingLaw};
use crate::linalg::SparseVector;
use crate::system::{Closing, System};

/// The error of a system without a steady state, with the part of load and friction up to which it found one.
fn lost(n: usize, k: &[&[f64]], pairs: Vec<crate::system::ContactPair>, load: Vec<f64>) -> (f64, String) {
    let structure = structure(n, |i, j| f64::from(i == j), |i, j| k[i][j]);
    let system = System { structure, pairs, load, prestress: None, coupling: None };
    let said = solve_steady(&system, &SteadyOptions::default(), &()).unwrap_err().to_string();
    let part = said
        .split("up to ")
        .nth(1)
        .and_then(|rest| rest.split(" %").next())
        .unwrap_or_else(|| panic!("{said}"));
    (0.01 * part.parse::<f64>().unwrap(), said)
}

fn coulomb(stiffness: f64, mu0: f64) -> SlidingLaw {
    SlidingLaw::new(NormalLaw::linear(stiffness), Coulomb { mu0 }, 0.0)
}

/// A block between a belt that presses on it with L and the ground, on which it does not slide: the belt drags it by μ φ · φ L, the ground holds up to
/// μ_s φ L, so that φ = μ_s/μ.
#[test]
fn a_body_that_friction_does_not_hold_slides_away() {
    let at = |z: f64| point(0.0, 1.0, vector(&[(1, z)]), vector(&[(0, 1.0)]), SparseVector::default());
    let belt = pair(vec![at(1.0)], coulomb(100.0, 0.4), Closing::Load(3.0), 1.0);
    let held =
        SlidingLaw { bristle: Some(Bristle { stiffness: 50.0, damping: 0.0 }), ..coulomb(100.0, 0.15) };
    let mut seat = pair(vec![at(-1.0)], held, Closing::Approach(0.0), 0.0);
    seat.name = "seat".into();
    let (part, said) = lost(2, &[&[0.0, 0.0], &[0.0, 0.0]], vec![belt, seat], vec![0.0; 2]);
    assert!(within((part - 0.375).abs(), 2e-3, Stated), "{said}");
    assert!(
        said.contains("`seat`, which does not slide, has 1 of its 1 closed points at the limit"),
        "{said}"
    );
    assert!(said.contains("aise the friction of the contact that does not slide"), "{said}");
}

/// A mass on K = \[4 4; 4 5\], pressed by F on the ground, k_n = 10: N (1 + (K_zz − K_xz²/K_xx)/k_n − μ φ K_xz/K_xx) = φ F, without
/// bound at μ φ = 1.1.
#[test]
fn a_body_that_friction_drives_in_locks() {
    let ground = point(0.0, 1.0, vector(&[(1, -1.0)]), vector(&[(0, 1.0)]), SparseVector::default());
    let pads = pair(vec![ground], coulomb(10.0, 2.0), Closing::Approach(0.0), 1.0);
    let (part, said) = lost(2, &[&[4.0, 4.0], &[4.0, 5.0]], vec![pads], vec![0.0, -1.0]);
    assert!(within((part - 0.55).abs(), 2e-3, Stated), "{said}");
    assert!(said.contains("friction drives the body of `pair` in") && said.contains("it locks"), "{said}");
}

/// A rigid block on nine points from −1 to 1, whose middle is 1 above the ground and is pressed down: friction moves the centre of pressure by
/// μ φ, at most to the edge.
#[test]
fn a_body_that_stands_on_its_edge_tips() {
    let points = (0..9).map(|i| {
        let x = f64::from(i) / 4.0 - 1.0;
        point(0.0, 1.0, vector(&[(1, -1.0), (2, -x)]), vector(&[(0, 1.0), (2, 1.0)]), SparseVector::default())
    });
    let face = pair(points.collect(), coulomb(1e4, 2.0), Closing::Approach(0.0), 1.0);
    let k: [&[f64]; 3] = [&[5.0, 0.0, 0.0], &[0.0; 3], &[0.0; 3]];
    let (part, said) = lost(3, &k, vec![face], vec![0.0, -1.0, 0.0]);
    assert!(within((part - 0.5).abs(), 2e-3, Stated), "{said}");
    assert!(said.contains("`pair` carries on 22 % of its points: its body tips"), "{said}");
}
