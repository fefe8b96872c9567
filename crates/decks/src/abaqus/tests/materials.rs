//! Materials, sections, points, springs.

use super::*;
use crate::deck::{Elastic, Profile, SectionShape};
use std::f64::consts::PI;
use stridor_base::bounds::{Origin::*, within};

#[test]
fn materials_have_their_constants() {
    let deck = deck(
        "*MATERIAL, NAME=Steel\n*ELASTIC\n2.1E+11, 0.3, 20.\n2.0E+11, 0.3, 100.\n*DENSITY\n7850.,\n*DAMPING, ALPHA=2., BETA=3e-6, STRUCTURAL=0.01\n*PLASTIC\n1e8, 0.\n\
                     *MATERIAL, NAME=Lining\n*ELASTIC, TYPE=ENGINEERING CONSTANTS\n1., 2., 3., .1, .2, .3, 4., 5.,\n6.\n",
    );
    let [steel, lining] = &deck.materials[..] else { panic!() };
    assert_eq!(steel.elastic, Some(Elastic::Isotropic { youngs_modulus: 2.1e11, poissons_ratio: 0.3 }));
    assert_eq!((steel.density, steel.rayleigh, steel.loss_factor), (Some(7850.0), [2.0, 3e-6], 0.01));
    let expected = Elastic::Orthotropic {
        youngs_moduli: [1.0, 2.0, 3.0],
        poissons_ratios: [0.1, 0.2, 0.3],
        shear_moduli: [4.0, 5.0, 6.0],
    };
    assert_eq!(lining.elastic, Some(expected));
    let seven = super::deck(
        "*MATERIAL, NAME=M\n*ELASTIC, TYPE=ENGINEERING CONSTANTS\n1., 2., 3., .1, .2, .3, 4.\n5., 6., 20.\n",
    );
    assert_eq!(seven.materials[0].elastic, Some(expected));
    assert_eq!(notes(&deck), [(Weight::Perhaps, "*ELASTIC", 2), (Weight::Nothing, "*PLASTIC", 8)]);
}

/// D of engineering constants by inverting the compliance with Gauss and Jordan; read back, the constants are the same.
#[test]
fn orthotropic_stiffness_is_the_inverse_of_the_compliance() {
    let ([e1, e2, e3], [n12, n13, n23]) = ([20e9, 12e9, 7e9], [0.25, 0.31, 0.4]);
    let mut rows = [
        [1.0 / e1, -n12 / e1, -n13 / e1, 1.0, 0.0, 0.0],
        [-n12 / e1, 1.0 / e2, -n23 / e2, 0.0, 1.0, 0.0],
        [-n13 / e1, -n23 / e2, 1.0 / e3, 0.0, 0.0, 1.0],
    ];
    for pivot in 0..3 {
        let scale = rows[pivot][pivot];
        rows[pivot] = rows[pivot].map(|x| x / scale);
        for other in (0..3).filter(|other| *other != pivot) {
            let factor = rows[other][pivot];
            (0..6).for_each(|k| rows[other][k] -= factor * rows[pivot][k]);
        }
    }
    let d = |i: usize, j: usize| rows[i][3 + j];
    let text = format!(
        "*MATERIAL, NAME=M\n*ELASTIC, TYPE=ORTHO\n{:e}, {:e}, {:e}, {:e}, {:e}, {:e}, 1e9, 2e9\n3e9\n",
        d(0, 0),
        d(0, 1),
        d(1, 1),
        d(0, 2),
        d(1, 2),
        d(2, 2)
    );
    let Some(Elastic::Orthotropic { youngs_moduli, poissons_ratios, shear_moduli }) =
        deck(&text).materials[0].elastic
    else {
        panic!()
    };
    for (own, expected) in
        youngs_moduli.iter().zip([e1, e2, e3]).chain(poissons_ratios.iter().zip([n12, n13, n23]))
    {
        assert!(within((own / expected - 1.0).abs(), 1e-12, RoundOff));
    }
    assert_eq!(shear_moduli, [1e9, 2e9, 3e9]);
    let indefinite = deck("*MATERIAL, NAME=M\n*ELASTIC, TYPE=ORTHO\n1, 2, 1, 0, 0, 1, 1, 1\n1\n");
    assert_eq!((indefinite.materials[0].elastic, notes(&indefinite)[0].0), (None, Weight::Matters));
}

#[test]
fn materials_that_are_wrong_are_faults() {
    fault("*ELASTIC\n1, 2\n", 1, "without a material");
    fault("*MATERIAL, NAME=A\n*ELASTIC\n1x, 0.3\n", 3, "`1x`");
    fault("*MATERIAL, NAME=A\n*ELASTIC\n1e999, 0.3\n", 3, "`1e999`");
    fault("*MATERIAL, NAME=A\n*DENSITY\n", 2, "without data");
    fault("*MATERIAL, NAME=A\n*MATERIAL, NAME=a\n", 2, "a second *MATERIAL");
    fault("*MATERIAL\n", 1, "without a name");
    fault("*MATERIAL, NAME=A\n*ELASTIC, TYPE=ORTHO\n1, 2, 3, 4, 5, 6, 7, 8\n", 3, "8 numbers");
    let deck = deck("*MATERIAL, NAME=A\n*ELASTIC, TYPE=ANISO\n1, 2\n*HYPERELASTIC\n1\n");
    assert_eq!(notes(&deck).iter().map(|(weight, ..)| *weight).collect::<Vec<_>>(), [Weight::Matters; 2]);
}

#[test]
fn sections_have_their_shapes_and_axes() {
    let text = format!(
        "{BRICKS}*ELEMENT, TYPE=S4, ELSET=SH\n11, 1, 2, 3, 4\n*ELEMENT, TYPE=T3D2, ELSET=TR\n12, 1, 9\n*ORIENTATION, NAME=O\n0., 2., 0., -3., 0., 0.\n3, 90.\n\
                        *SOLIDSECTION, ELSET=EALL, MATERIAL=M, ORIENTATION=O\n*SHELL SECTION, ELSET=SH, MATERIAL=M\n0.25, 5\n*SOLID SECTION, ELSET=TR, MATERIAL=M\n3.\n"
    );
    let deck = deck(&text);
    let [solid, shell, truss] = &deck.sections[..] else { panic!("{:?}", deck.sections) };
    assert_eq!(
        (&solid.shape, &solid.elements[..], solid.material.as_str()),
        (&SectionShape::Solid, &[0, 1][..], "M")
    );
    assert_eq!(shell.shape, SectionShape::Shell { thickness: 0.25 });
    assert_eq!(truss.shape, SectionShape::Truss { area: 3.0 });
    // x along the global y, y along −x; a quarter turn about z: x along −x, y along −y.
    let axes = solid.axes.unwrap();
    for (own, expected) in axes.as_flattened().iter().zip([-1.0, 0.0, 0.0, 0.0, -1.0, 0.0]) {
        assert!(within((own - expected).abs(), 1e-13, RoundOff));
    }
    assert_eq!(notes(&deck), []);
    let cylindrical = bricks(
        "*ORIENTATION, NAME=O, SYSTEM=CYLINDRICAL\n0,0,0,0,0,1\n*SOLID SECTION, ELSET=EALL, MATERIAL=M, ORIENTATION=O\n",
    );
    assert_eq!(notes(&cylindrical), [(Weight::Matters, "*ORIENTATION", 19)]);
    fault(&format!("{BRICKS}*ORIENTATION, NAME=O\n1,0,0,2,0,0\n"), 18, "in one line");
    fault(&format!("{BRICKS}*SOLID SECTION, ELSET=EALL, MATERIAL=M, ORIENTATION=P\n"), 17, "ORIENTATION=P");
    fault(&format!("{BRICKS}*SOLID SECTION, ELSET=NONE, MATERIAL=M\n"), 17, "`NONE`");
}

fn profile(lines: &str) -> Profile {
    let text = format!(
        "*NODE\n1,0,0,0\n2,1,0,0\n*ELEMENT, TYPE=B31, ELSET=B\n1,1,2\n*BEAM SECTION, ELSET=B, MATERIAL=M, {lines}"
    );
    match deck(&text).sections[0].shape {
        SectionShape::Beam { profile, .. } => profile,
        ref other => panic!("{other:?}"),
    }
}

/// J of a rectangle by St Venant's series: (a b³/3)(1 − 192 b/(π⁵ a) Σ tanh(nπa/2b)/n⁵), n odd. Source: Timoshenko and Goodier, *Theory of
/// Elasticity*, article 109. The closed form that is read is within 4 · 10⁻³ of it.
#[test]
fn profiles_have_their_areas_and_moments() {
    for (a, b) in [(2.0, 1.0), (1.0, 1.0), (0.3, 3.0)] {
        let Profile::General { area, second_moments, torsion } =
            profile(&format!("SECTION=RECT\n{a}, {b}\n"))
        else {
            panic!()
        };
        assert!(within((area / (a * b) - 1.0_f64).abs(), 1e-13, RoundOff));
        // Along the first axis it is a wide: ∫x² dA = a³b/12.
        assert!(within((second_moments[0] / (a * a * a * b / 12.0) - 1.0).abs(), 1e-13, RoundOff));
        assert!(within((second_moments[1] / (a * b * b * b / 12.0) - 1.0).abs(), 1e-13, RoundOff));
        let (long, short) = (a.max(b), a.min(b));
        let term = |n: f64| (n * PI * long / (2.0 * short)).tanh() / n.powi(5);
        let sum: f64 = (0..40).map(|k| term(f64::from(2 * k + 1))).sum();
        let series = long * short.powi(3) / 3.0 * (1.0 - 192.0 * short / (PI.powi(5) * long) * sum);
        assert!(within((torsion / series - 1.0).abs(), 4e-3, Theory), "{torsion} {series}");
    }
    assert_eq!(profile("SECTION=CIRC\n0.5\n"), Profile::Round { diameter: 1.0 });
    assert_eq!(profile("SECTION=CIRC\n0.5, 0.5\n"), Profile::Round { diameter: 0.5 });
    let Profile::General { area, second_moments, torsion } = profile("SECTION=PIPE\n2., 0.5\n") else {
        panic!()
    };
    assert!(within((area - PI * 1.75).abs(), 1e-13, RoundOff));
    assert!(within((second_moments[0] - PI * (16.0 - 5.0625) / 4.0).abs(), 1e-13, RoundOff));
    assert!(within((torsion - PI * (16.0 - 5.0625) / 2.0).abs(), 1e-13, RoundOff));
    // 4 × 2, wall 0.5: 8 − 3 · 1; (64 · 2 − 27 · 1)/12; (4 · 8 − 3 · 1)/12; 2 (3.5 · 1.5)² 0.5/(4 + 2 − 1).
    let Profile::General { area, second_moments, torsion } = profile("SECTION=BOX\n4., 2., .5, .5, .5, .5\n")
    else {
        panic!()
    };
    assert!(within((area - 5.0).abs(), 1e-13, RoundOff));
    assert!(within((second_moments[0] - 101.0 / 12.0).abs(), 1e-13, RoundOff));
    assert!(within((second_moments[1] - 29.0 / 12.0).abs(), 1e-13, RoundOff));
    assert!(within((torsion - 27.5625 / 5.0).abs(), 1e-13, RoundOff));
    // A, I₁₁, I₁₂, I₂₂, J: I₁₁ is about the first axis, so across it.
    assert_eq!(
        profile("SECTION=GENERAL\n1., 2., 0., 3., 4.\n"),
        Profile::General { area: 1.0, second_moments: [3.0, 2.0], torsion: 4.0 }
    );
    let beam = "*NODE\n1,0,0,0\n2,1,0,0\n*ELEMENT, TYPE=B31, ELSET=B\n1,1,2\n";
    let text = format!(
        "{beam}*BEAM GENERAL SECTION, ELSET=B, SECTION=GENERAL, DENSITY=7.\n1., 2., 0., 3., 4.\n0., 1., 0.\n26., 10.\n"
    );
    let own = deck(&text);
    assert_eq!(
        (own.sections[0].material.as_str(), own.materials[0].name.as_str(), own.materials[0].density),
        ("B", "B", Some(7.0))
    );
    let Some(Elastic::Isotropic { youngs_modulus, poissons_ratio }) = own.materials[0].elastic else {
        panic!()
    };
    assert_eq!(youngs_modulus, 26.0);
    assert!(within((poissons_ratio - 0.3).abs(), 1e-13, RoundOff));
    let SectionShape::Beam { first_axis, .. } = own.sections[0].shape else { panic!() };
    assert_eq!(first_axis, Some([0.0, 1.0, 0.0]));
    fault(
        &format!("{beam}*BEAM SECTION, ELSET=B, MATERIAL=M, SECTION=RECT\n1., -1.\n"),
        7,
        "a profile of area -1",
    );
    let other = deck(&format!("{beam}*BEAM SECTION, ELSET=B, MATERIAL=M, SECTION=I\n1., 1.\n"));
    assert_eq!(notes(&other), [(Weight::Matters, "*BEAM SECTION, SECTION=I", 6)]);
}

#[test]
fn masses_springs_and_dashpots_are_read() {
    let deck = bricks(
        "*ELEMENT, TYPE=MASS, ELSET=M\n21, 1\n22, 2\n*MASS, ELSET=M\n3.\n*ELEMENT, TYPE=ROTARYI, ELSET=R\n23, 3\n*ROTARY INERTIA, ELSET=R\n1., 2., 3.\n\
         *ELEMENT, TYPE=SPRING1, ELSET=S1\n31, 4\n*SPRING, ELSET=S1\n2\n10.\n*ELEMENT, TYPE=SPRING2, ELSET=S2\n32, 4, 8\n*SPRING, ELSET=S2\n3, 3\n20.\n\
         *ELEMENT, TYPE=SPRINGA, ELSET=SA\n33, 1, 7\n*SPRING, ELSET=SA\n\n30.\n*SPRING, ELSET=SA\n,\n40.\n*ELEMENT, TYPE=DASHPOTA, ELSET=DA\n34, 1, 7\n*DASHPOT, ELSET=DA\n\n5.\n\
         *ELEMENT, TYPE=DASHPOT1, ELSET=D1\n35, 9\n*DASHPOT, ELSET=D1\n1\n6.\n",
    );
    let [mass, inertia] = &deck.masses[..] else { panic!() };
    assert_eq!((numbers(&deck, &mass.nodes), mass.mass, mass.inertia), (vec![1, 2], 3.0, [0.0; 3]));
    assert_eq!(
        (numbers(&deck, &inertia.nodes), inertia.mass, inertia.inertia),
        (vec![3], 0.0, [1.0, 2.0, 3.0])
    );
    let springs: Vec<_> = deck
        .springs
        .iter()
        .map(|spring| (spring.ends[0], spring.dof, spring.stiffness, spring.damping))
        .collect();
    let expected = [
        ((3, None), Some(1), 10.0, 0.0),
        ((3, Some(7)), Some(2), 20.0, 0.0),
        ((0, Some(6)), None, 30.0, 0.0),
        ((0, Some(6)), None, 40.0, 0.0),
        ((0, Some(6)), None, 0.0, 5.0),
        ((8, None), Some(0), 0.0, 6.0),
    ];
    assert_eq!(springs, expected);
    assert_eq!(notes(&deck), []);
    let spring = "*ELEMENT, TYPE=SPRING2, ELSET=S\n31, 4, 5\n";
    fault(&format!("{BRICKS}{spring}*SPRING, ELSET=S\n7, 7\n1.\n"), 20, "`7`");
    fault(&format!("{BRICKS}{spring}*SPRING, ELSET=S\n1, 1\n"), 20, "no line below");
    let listed = |text: &str| {
        notes(&bricks(&format!("{spring}{text}"))).iter().map(|(weight, ..)| *weight).collect::<Vec<_>>()
    };
    assert_eq!(listed("*SPRING, ELSET=S\n1, 2\n1.\n"), [Weight::Matters]);
    assert_eq!(listed("*SPRING, ELSET=S, NONLINEAR\n1, 1\n1., 2.\n"), [Weight::Matters]);
    assert_eq!(listed("*MASS, ELSET=S\n1.\n"), [Weight::Perhaps]);
    assert_eq!(listed("*TRANSFORM, NSET=ALL\n0,1,0,-1,0,0\n*SPRING, ELSET=S\n1, 1\n1.\n"), [Weight::Matters]);
}
