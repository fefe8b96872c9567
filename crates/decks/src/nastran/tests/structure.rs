//! Coordinate systems, elements, properties, materials, masses, springs.

use super::*;

/// Places and directions of displacements in cylindrical and spherical systems, against their definitions.
#[test]
fn points_are_placed_in_their_systems() {
    let text = "\
CORD2C,1,,1.,0.,0.,1.,0.,1.
,2.,0.,0.
CORD2S,2,1,0.,0.,0.,0.,0.,1.
,1.,90.,0.
CORD1R,3,1,2,3,4,1,3,2
GRID,1,1,2.,30.,5.
GRID,2,2,2.,90.,0.
GRID,3,2,1.,0.,77.
GRID,5,3,0.,0.,1.
GRID,6,1,0.,0.,0.,1
GRID,7,1,1.,0.,0.,1
GRID,8,2,2.,60.,0.,2
SPC1,1,1,6,7,8
";
    let found = deck(text);
    let at = |number: u64| found.nodes.iter().find(|node| node.number == number).unwrap().position;
    let is = |found: [f64; 3], expected: [f64; 3]| (0..3).all(|k| close(found[k], expected[k]));
    let half = 0.5_f64;
    assert!(is(at(1), [1.0 + 2.0 * (0.75_f64).sqrt(), 1.0, 5.0]), "{:?}", at(1));
    // The first axis of system 2 is y of the coordinates.
    assert!(is(at(2), [1.0, 2.0, 0.0]) && is(at(3), [1.0, 0.0, 1.0]), "{:?} {:?}", at(2), at(3));
    // System 3: the third axis from point 1 to point 2.
    let way: [f64; 3] = std::array::from_fn(|k| at(2)[k] - at(1)[k]);
    let length = way.iter().map(|x| x * x).sum::<f64>().sqrt();
    assert!(is(at(5), std::array::from_fn(|k| at(1)[k] + way[k] / length)));
    // On its axis a cylinder has its own directions; elsewhere they turn; those of a sphere are of the point.
    let frame = |number: u64| {
        let node = found.nodes.iter().position(|node| node.number == number).unwrap();
        found.supports.iter().find(|support| support.nodes.contains(&node)).unwrap().frame
    };
    assert_eq!(frame(6), Frame::Global);
    assert_eq!(frame(7), Frame::Cylindrical([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]));
    let Frame::Turned([out, down, around]) = frame(8) else { panic!() };
    let root = (0.75_f64).sqrt();
    assert!(is(out, [0.0, root, half]) && is(down, [0.0, half, -root]) && is(around, [-1.0, 0.0, 0.0]));
}

/// Nodes of second order stand in the order of the table of kinds: each middle between the corners that the table says.
#[test]
fn nodes_of_second_order_are_in_the_order_of_their_kind() {
    for (kind, name) in [
        (CellKind::Hexahedron20, "CHEXA"),
        (CellKind::Wedge15, "CPENTA"),
        (CellKind::Pyramid13, "CPYRAM"),
        (CellKind::Tetrahedron10, "CTETRA"),
    ] {
        let order = kind.named(stridor_mesh::Program::Nastran)[0].order;
        let places = order.to_file(&kind.reference_coordinates());
        let mut text = String::new();
        for (k, [x, y, z]) in places.iter().enumerate() {
            text += &format!("GRID,{},,{x:?},{y:?},{z:?}\n", k + 1);
        }
        let card = |ids: &[String]| {
            let mut fields = vec!["1".to_string(), "3".into()];
            fields.extend(ids.iter().cloned());
            fields.chunks(8).map(|row| format!(",{}\n", row.join(","))).collect::<String>()
        };
        let ids: Vec<String> = (1..=places.len()).map(|k| k.to_string()).collect();
        let rest = "PSOLID,3,5\nMAT1,5,1.,,.3\n";
        let found = deck(&format!("{text}{name}{}{rest}", card(&ids)));
        assert_eq!(found.elements[0].kind, kind);
        let at: Vec<[f64; 3]> =
            found.elements[0].nodes.iter().map(|node| found.nodes[*node].position).collect();
        assert_eq!(at, kind.reference_coordinates(), "{name}");
        // Corners alone are the kind of first order; a middle that is left out moves as the mean of its corners.
        let corners: Vec<String> = ids[..kind.n_corners()].to_vec();
        let found = deck(&format!("{text}{name}{}{rest}", card(&corners)));
        assert_eq!((found.elements[0].nodes.len(), found.equations.len()), (kind.n_corners(), 0));
        let mut partly = ids.clone();
        partly[kind.n_corners()] = String::new();
        let found = deck(&format!("{text}{name}{}{rest}", card(&partly)));
        assert_eq!(found.elements[0].kind, kind);
        let made = found.nodes.len() - 1;
        assert_eq!(found.nodes[made].position, places[kind.n_corners()]);
        assert!(found.elements[0].nodes.contains(&made));
        assert_eq!(
            found.equations.iter().map(|e| e.terms[0]).collect::<Vec<_>>(),
            [0, 1, 2].map(|k| (made, k, 1.0))
        );
        let sum = |of: &[(usize, u8, f64)]| of.iter().map(|(.., factor)| factor).sum::<f64>();
        assert!(found.equations.iter().all(|equation| sum(&equation.terms) == 0.0));
    }
}

#[test]
fn sections_have_the_names_of_their_properties() {
    let names = "$HMNAME PROP       3\"disc\" 4\n$ANSA_NAME_COMMENT;5;MAT1;cast iron;\n";
    let more = "CQUAD4,11,3,1,2,3,4\n$*  Simcenter Nastran Property: cover\nPSHELL,3,6,.02,6,,6\n$ Femap Material 6 : steel\nMAT1,6,,8.+10,.25,7800.,,,.02\n";
    let found = deck(&format!("{names}{CUBE}{more}PARAM,WTMASS,.5\nPARAM,G,.01\nPARAM,ALPHA2,1.-6\n"));
    let sections: Vec<_> =
        found.sections.iter().map(|s| (s.name.as_str(), s.material.as_str(), &s.shape)).collect();
    // One number, two classes: each has the name that stands for the number, and the second one a count.
    assert_eq!(sections[0], ("disc", "cast iron", &SectionShape::Solid));
    assert_eq!((sections[1].1, sections[1].2), ("steel", &SectionShape::Shell { thickness: 0.02 }));
    assert_eq!(found.element_set("disc").unwrap().members, [0]);
    assert_ne!(sections[1].0, "disc");
    let steel = &found.materials[1];
    assert_eq!(steel.elastic, Some(Elastic::Isotropic { youngs_modulus: 2.0e11, poissons_ratio: 0.25 }));
    assert_eq!((steel.density, steel.rayleigh), (Some(3900.0), [0.0, 1e-6]));
    assert!(close(steel.loss_factor, 0.03));
    assert_eq!(deck(CUBE).element_set("PSOLID_3").unwrap().members, [0]);
    for (comment, name) in [
        ("$ Femap Property 3 : pad\n", "pad"),
        ("$*  I-DEAS property: 3  name: BACK PLATE\n", "BACK PLATE"),
        ("$HMNAME PROP 3\"a\"\n$HMNAME PROP 4\"a\"\n", "a_3"),
        ("$ANSA_NAME_COMMENT;3;PSOLID;lining;;NO;\n", "lining"),
    ] {
        assert!(deck(&format!("{comment}{CUBE}")).element_set(name).is_some(), "{name}");
    }
    let before = CUBE.replace("PSOLID", "$ Elements and Element Properties for region : hub\nPSOLID");
    assert_eq!(
        deck(&before.replace("MAT1", "$ Description of Material : Date: 1\nMAT1")).sections[0].name,
        "hub"
    );
    assert_eq!(deck(&before).sections[0].material, "MAT1_5");
}

/// Mass that a shell carries, 3 on an area of thickness 0.02, is a density of 150 more of its own material.
#[test]
fn carried_mass_is_a_higher_density() {
    let found = deck(&format!("{CUBE}CQUAD4,11,4,1,2,3,4\nPSHELL,4,5,.02,5,,5,,3.\nPARAM,WTMASS,.5\n"));
    let density =
        |name: &str| found.materials.iter().find(|material| material.name == name).and_then(|m| m.density);
    assert_eq!((found.sections[0].material.as_str(), density("MAT1_5")), ("MAT1_5", Some(3925.0)));
    assert_eq!(found.sections[1].material, "MAT1_5 of PSHELL_4");
    assert!(close(density("MAT1_5 of PSHELL_4").unwrap() / 4000.0, 1.0));
}

/// The stiffness of MAT9 gives back the engineering constants that it is made of.
#[test]
fn stiffness_is_inverted() {
    // E = 1, 2, 3; ν₁₂ = 0.1, ν₁₃ = 0.2, ν₂₃ = 0.3: S by hand, C = S⁻¹.
    let (e, nu) = ([1.0, 2.0, 3.0], [0.1, 0.2, 0.3]);
    let s = [
        [1.0 / e[0], -nu[0] / e[0], -nu[1] / e[0]],
        [0.0, 1.0 / e[1], -nu[2] / e[1]],
        [0.0, 0.0, 1.0 / e[2]],
    ];
    let (a, b, c) = (s[0][0], s[0][1], s[0][2]);
    let (d, f, g) = (s[1][1], s[1][2], s[2][2]);
    let det = a * (d * g - f * f) - b * (b * g - f * c) + c * (b * f - d * c);
    let m = [d * g - f * f, c * f - b * g, b * f - c * d, a * g - c * c, b * c - a * f, a * d - b * b]
        .map(|x| x / det);
    let text = format!(
        "MAT9,5,{:?},{:?},{:?},0.,0.,0.,{:?}\n,{:?},0.,0.,0.,{:?},0.,0.,0.\n,4.,0.,0.,5.,0.,6.,7.\n",
        m[0], m[1], m[2], m[3], m[4], m[5]
    );
    let found = deck(&text);
    let Some(Elastic::Orthotropic { youngs_moduli, poissons_ratios, shear_moduli }) =
        found.materials[0].elastic
    else {
        panic!()
    };
    assert!((0..3).all(|k| close(youngs_moduli[k], e[k]) && close(poissons_ratios[k], nu[k])));
    // xy, yz, zx: G₁₂ = 4, G₁₃ = 6, G₂₃ = 5.
    assert_eq!((shear_moduli, found.materials[0].density), ([4.0, 6.0, 5.0], Some(7.0)));
    let found = deck(&text.replacen(",0.,0.,0.,", ",.1,0.,0.,", 1));
    assert_eq!(found.materials[0].elastic, None);
    assert!(notes(&found, Weight::Matters, "MAT9", "orthotropic"));
}

/// Areas and moments of profiles: a tube and an I of full walls are a circle and a rectangle; a box is the difference of two rectangles.
#[test]
fn profiles_have_their_moments() {
    let profile = |kind: &str, dimensions: &str| {
        let text = format!(
            "GRID,1\nGRID,2,,1.,0.,0.\nCBAR,1,1,1,2,0.,2.,0.\nPBARL,1,1,,{kind}\n,{dimensions}\nMAT1,1,1.,,.3\n"
        );
        let found = deck(&text);
        let SectionShape::Beam { profile, first_axis } = found.sections[0].shape else { panic!() };
        assert_eq!(first_axis, Some([0.0, 2.0, 0.0]));
        profile
    };
    assert_eq!(profile("ROD", "2."), Profile::Round { diameter: 4.0 });
    let pi = std::f64::consts::PI;
    let is = |found: Profile, expected: [f64; 4]| {
        let Profile::General { area, second_moments: [i1, i2], torsion } = found else { panic!() };
        assert!(
            [area, i1, i2, torsion].iter().zip(expected).all(|(a, b)| close(*a, b)),
            "{found:?} {expected:?}"
        );
    };
    is(profile("TUBE", "2.,0."), [4.0 * pi, 4.0 * pi, 4.0 * pi, 8.0 * pi]);
    // A bar 3 wide and 6 high in the plane of y.
    let torsion = 6.0 * 27.0 * (1.0 / 3.0 - 0.21 * 0.5 * (1.0 - 0.0625 / 12.0));
    is(profile("BAR", "3.,6."), [18.0, 54.0, 13.5, torsion]);
    let box_torsion = 2.0 * (2.0 * 5.0_f64).powi(2) / (2.0 + 5.0);
    is(profile("BOX", "3.,6.,1.,1."), [14.0, 54.0 - 64.0 / 12.0, 13.5 - 4.0 / 12.0, box_torsion]);
    let i_torsion = (3.0 * 8.0 + 3.0 * 8.0 + 2.0 * 27.0) / 3.0;
    is(profile("I", "6.,3.,3.,3.,2.,2."), [18.0, 54.0, 13.5, i_torsion]);
    let found = deck(
        "GRID,1\nGRID,2,,1.,0.,0.\nCBAR,1,1,1,2,0.,2.,0.\nPBARL,1,1,,HAT\n,1.,2.,3.,4.\nMAT1,1,1.,,.3\n",
    );
    assert!(found.sections.is_empty() && notes(&found, Weight::Matters, "PBARL", "HAT"));
}

/// A mass beside a point that a beam turns is at a node of its own, which follows that point; the tensor of a turned system is turned.
#[test]
fn masses_may_be_beside_their_points() {
    let text = "\
GRID,1
GRID,2,,1.,0.,0.
CBAR,1,1,1,2,0.,1.,0.
PBAR,1,1,1.,1.,1.,1.
MAT1,1,1.,,.3
CONM2,5,2,,3.,0.,2.,0.
CONM2,6,1,-1,4.,0.,0.,7.
";
    let found = deck(text);
    let places: Vec<_> =
        found.masses.iter().map(|mass| (found.nodes[mass.nodes[0]].position, mass.mass)).collect();
    assert_eq!(places, [([1.0, 2.0, 0.0], 3.0), ([0.0, 0.0, 7.0], 4.0)]);
    let links: Vec<_> =
        found.couplings.iter().map(|link| (link.reference, link.nodes.clone(), link.kind)).collect();
    assert_eq!(links, [(1, vec![2], CouplingKind::Rigid), (0, vec![3], CouplingKind::Rigid)]);
    let found = deck(&format!("{CUBE}CONM2,5,2,,3.,0.,2.,0.\n"));
    assert_eq!(found.masses[0].nodes, [1]);
    assert!(notes(&found, Weight::Matters, "CONM2", "offset"));
}

#[test]
fn masses_and_springs_are_read_in_their_directions() {
    // The first axis of system 1 is y.
    let text = "\
CORD2R,1,,0.,0.,0.,0.,0.,1.
,0.,1.,0.
GRID,1
GRID,2,,3.,4.,0.
GRID,3,,0.,0.,0.,1
CONM2,1,1,1,2.
,.1,,.2,,,.3
CELAS1,2,5,3,1
PELAS,5,7.,,,6,8.
CBUSH,3,9,1,3,,,,1
PBUSH,9,K,1.,2.,3.,4.,5.,6.
,,B,.1
CBUSH1D,4,10,1,2
PBUSH1D,10,50.,.5
CDAMP2,5,.25,1,3,2,3
CBUSH,6,11,1,2,1.,0.,0.
PBUSH,11,K,9.
CBUSH,7,12,1,2,1.,0.,0.
PBUSH,12,K,9.,8.
";
    let found = deck(text);
    assert_eq!((found.masses[0].mass, found.masses[0].inertia), (2.0, [0.2, 0.1, 0.3]));
    let find = |name: &str, dof: Option<u8>| {
        let spring = found.springs.iter().find(|s| s.name == name && s.dof == dof);
        spring.map(|s| (s.ends.clone(), s.stiffness, s.damping))
    };
    assert_eq!(find("PELAS_5", Some(1)), Some((vec![(2, None)], 7.0, 0.0)));
    let ends = vec![(0, Some(2))];
    for (dof, k) in [(0, 2.0), (2, 3.0), (3, 5.0), (4, 4.0), (5, 6.0)] {
        assert_eq!(find("PBUSH_9", Some(dof)), Some((ends.clone(), k, 0.0)), "{dof}");
    }
    assert_eq!(find("PBUSH_9", Some(1)), Some((ends, 1.0, 0.1)));
    assert_eq!(find("PBUSH1D_10", None), Some((vec![(0, Some(1))], 50.0, 0.5)));
    assert_eq!(find("CDAMP2_5", Some(2)), Some((vec![(0, Some(1))], 0.0, 0.25)));
    assert_eq!(find("PBUSH_11", None), Some((vec![(0, Some(1))], 9.0, 0.0)));
    assert!(notes(&found, Weight::Matters, "CBUSH", "directions other than"));
}
