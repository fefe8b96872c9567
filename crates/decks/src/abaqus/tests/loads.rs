//! Loads, rotations, steps.

use super::*;
use crate::deck::{Analysis, LoadOn};

#[test]
fn forces_and_pressures_are_read() {
    let deck = bricks(
        "*SURFACE, NAME=Top\n2, S2\n*STEP\n*STATIC\n*CLOAD, OP=NEW\nALL, 1, 2.\nALL, 3, -1.\n1, 2, 0.\n1, 5, 3.\n*DLOAD\nEALL, P2, 7.\n2, GRAV, 9.81, 0, 0, -1\n*DSLOAD\nTop, P, 4.\nTop, TRVEC, 1.\n*END STEP\n",
    );
    let [force, faces, surface] = &deck.loads[..] else { panic!("{:?}", deck.loads) };
    assert_eq!(force.on, LoadOn::Nodes { nodes: (0..12).collect(), force: [2.0, 0.0, -1.0] });
    assert!(matches!(&faces.on, LoadOn::Faces { faces, pressure } if faces.len() == 2 && *pressure == 7.0));
    assert_eq!(
        surface.on,
        LoadOn::Faces { faces: deck.surface("TOP").unwrap().faces.clone(), pressure: 4.0 }
    );
    let expected = [
        (Weight::Matters, "*DSLOAD, TRVEC", 31),
        (Weight::Perhaps, "*CLOAD, degree of freedom 5", 25),
        (Weight::Perhaps, "*DLOAD, GRAV", 28),
        (Weight::Nothing, "*STATIC", 20),
    ];
    assert_eq!(notes(&deck), expected);
    fault(&format!("{BRICKS}*CLOAD\n1, y, 2.\n"), 18, "`y`");
    let steps = bricks("*STEP\n*CLOAD\n1, 1, 2.\n*END STEP\n*STEP\n*CLOAD\n1, 1, 5.\n*END STEP\n");
    assert_eq!(steps.loads.len(), 2);
    assert_eq!(notes(&steps)[0].1, "*STEP");
}

/// Along the normal with P, upon the face that a surface names; of single elements a load.
#[test]
fn pressures_on_shells_have_a_side() {
    let deck = deck(
        "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 0\n4, 0, 1, 0\n5, 2, 0, 0\n6, 2, 1, 0\n*ELEMENT, TYPE=S4, ELSET=EALL\n1, 1,2,3,4\n2, 2,5,6,3\n\
         *SURFACE, NAME=Both\n1, SPOS\n2, SNEG\n*STEP\n*DLOAD\n1, P, 7.\n2, P, 7.\n1, P, 7.\nEALL, P2, 8.\n1, P3, 9.\n*DSLOAD\nBoth, P, 4.\n*END STEP\n",
    );
    let on = |shells: &[usize], pressure: f64| LoadOn::Shells { shells: shells.to_vec(), pressure };
    let loads: Vec<_> = deck.loads.iter().map(|load| load.on.clone()).collect();
    assert_eq!(loads, [on(&[0, 1], 7.0), on(&[0], 7.0), on(&[0, 1], 8.0), on(&[0], -4.0), on(&[1], 4.0)]);
    assert!(notes(&deck).iter().any(|(weight, what, _)| (*weight, *what) == (Weight::Matters, "*DLOAD, P3")));
}

/// ω² about an axis through a point; an angular velocity about two points, or two nodes.
#[test]
fn rotations_are_read() {
    let deck = bricks(
        "*STEP\n*DLOAD\nEALL, CENTRIF, 100., 1., 2., 3., 0., 0., 1.\n*MOTION, ROTATION, TYPE=VELOCITY\nALL, 5., 0., 0., 1., 0., 0., -1.\n*NSET, NSET=LOW\n1, 2\n*MOTION, ROTATION, DEFINITION=NODES\nLOW, 6., 1, 5\n*END STEP\n*STEP\n*DLOAD\neall, CENTRIF, 400., 1., 2., 3., 0., 0., 1.\n*END STEP\n",
    );
    let motions: Vec<_> = deck
        .motions
        .iter()
        .map(|motion| (motion.set.as_str(), motion.speed, motion.point, motion.axis))
        .collect();
    let expected = [
        ("EALL", 20.0, [1.0, 2.0, 3.0], [0.0, 0.0, 1.0]),
        ("ALL", 5.0, [0.0, 0.0, 1.0], [0.0, 0.0, -2.0]),
        ("LOW", 6.0, [0.0; 3], [0.0, 0.0, 1.0]),
    ];
    assert_eq!(motions, expected);
    assert_eq!(notes(&deck), []);
    let angle = bricks(
        "*MOTION, ROTATION, TYPE=DISPLACEMENT\nALL, 5., 0., 0., 1., 0., 0., -1.\n*MOTION, TRANSLATION\nALL, 1, 1, 5.\n",
    );
    assert_eq!(
        (angle.motions.len(), notes(&angle)[0].0, notes(&angle)[1].0),
        (0, Weight::Matters, Weight::Matters)
    );
    fault(&format!("{BRICKS}*DLOAD\nEALL, CENTRIF, -1., 0,0,0, 0,0,1\n"), 18, "ω² = -1");
    fault(&format!("{BRICKS}*MOTION, ROTATION\nALL, 1., 0,0,1, 0,0,1\n"), 18, "two points of an axis");
}

#[test]
fn analyses_that_were_meant_are_read() {
    let deck = deck(
        "*STEP, PERTURBATION\n*FREQUENCY, EIGENSOLVER=LANCZOS\n20, 100., 5000.\n*END STEP\n*STEP\n*COMPLEX FREQUENCY, FRICTION DAMPING=YES\n, , 9000.\n*ENDSTEP\n*STEP\n*STATIC\n*END STEP\n*STEP\n*FREQUENCY\n5.\n",
    );
    let expected = [
        Analysis::Modes { count: Some(20), band: [Some(100.0), Some(5000.0)] },
        Analysis::ComplexModes { count: None, band: [None, Some(9000.0)] },
        Analysis::Modes { count: Some(5), band: [None, None] },
    ];
    assert_eq!(deck.analyses, expected);
    fault("*STEP\n*FREQUENCY\nmany\n", 3, "`many`");
}
