//! Case control, supports, equations, rigid elements, loads, contact, methods.

use super::*;

/// A cube of one element above another, which shares nothing with it.
fn two_cubes() -> String {
    let mut text = CUBE.to_string();
    for k in 1..=8 {
        let node = CUBE.lines().nth(k - 1).unwrap();
        let [_, _, _, x, y, z] = node.split(',').collect::<Vec<_>>()[..] else { panic!() };
        text += &format!("GRID,{},,{x},{y},{:?}\n", 10 + k, 1.0 + z.parse::<f64>().unwrap());
    }
    text + "CHEXA,20,3,11,12,13,14,15,16,\n,17,18\n"
}

#[test]
fn subcases_choose_their_sets() {
    let cards = "SPC1,1,123,1,THRU,4\nSPC1,2,12,5,THRU,8,EXCEPT,6\nSPC,3,8,3,.1\nSPCADD,9,1,3\nFORCE,1,1,0,2.,0.,0.,1.\nFORCE,2,2,0,3.,1.,0.,0.\nLOAD,4,10.,1.,1,.5,2\nEIGRL,1,,1000.,20\nEIGRL,2,,,5\nEIGC,7,HESS,MAX,,,,12\n";
    let with = |control: &str| deck(&format!("{control}BEGIN BULK\n{CUBE}{cards}ENDDATA\n"));
    let found = with(
        "SOL 110\nCEND\nSUBCASE 1\nSPC=9\nLOAD=4\nSUBCASE 2\nSPC=9\nMETHOD=2\nCMETHOD = 7\nSTATSUB(PRELOAD) = 1\nDISP(PLOT) = ALL\n",
    );
    let held: Vec<_> = found.supports.iter().map(|s| (numbers(&found, &s.nodes), s.held)).collect();
    let [t, f] = [true, false];
    assert_eq!(held, [(vec![1, 2, 3, 4], [t, t, t, f, f, f]), (vec![8], [f, f, t, f, f, f])]);
    assert_eq!(found.supports[0].name.as_deref(), Some("SPC_1"));
    assert_eq!(found.node_set("SPC_1").unwrap().members, [0, 1, 2, 3]);
    let forces: Vec<_> = found.loads.iter().map(|load| load.on.clone()).collect();
    assert_eq!(forces[0], LoadOn::Nodes { nodes: vec![0], force: [0.0, 0.0, 20.0] });
    assert_eq!(forces[1], LoadOn::Nodes { nodes: vec![1], force: [15.0, 0.0, 0.0] });
    let modes = Analysis::Modes { count: Some(5), band: [None, None] };
    assert_eq!(found.analyses, [modes, Analysis::ComplexModes { count: Some(12), band: [None; 2] }]);
    assert!(notes(&found, Weight::Perhaps, "SPC", "motions of supports"));
    assert!(notes(&found, Weight::Nothing, "DISP", ""));
    assert!(notes(&found, Weight::Nothing, "SPC", "not chosen"));
    // None is chosen: all are taken.
    let found = with("CEND\n");
    assert_eq!((found.supports.len(), found.analyses.len()), (3, 3));
    assert_eq!(numbers(&found, &found.node_set("SPC_2").unwrap().members), [5, 7, 8]);
    assert!(notes(&found, Weight::Matters, "SPC", "all are taken"));
    let found = with("CEND\nSPC = 77\n");
    assert!(found.supports.is_empty() && notes(&found, Weight::Matters, "SPC", "set 77"));
}

#[test]
fn permanent_supports_are_those_of_the_points() {
    let found = deck("GRDSET,,,,,,,456\nGRID,1\nGRID,2,,1.,0.,0.,,12\nGRID,3,,1.,1.,0.\n");
    let held: Vec<_> = found.supports.iter().map(|s| (numbers(&found, &s.nodes), s.held)).collect();
    let [t, f] = [true, false];
    assert_eq!(held, [(vec![1, 3], [f, f, f, t, t, t]), (vec![2], [t, t, f, f, f, f])]);
}

/// Displacements of a point in a cylinder, as sums of those in the coordinates.
#[test]
fn equations_are_in_the_directions_of_displacements() {
    let text = "CORD2C,1,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nGRID,1,1,2.,30.,0.,1\nGRID,2\nMPC,5,1,1,2.,2,6,-1.\n,,2,3,4.\n";
    let found = deck(text);
    let terms = &found.equations[0].terms;
    let expected = [(0, 0, 2.0 * (0.75_f64).sqrt()), (0, 1, 1.0), (1, 5, -1.0), (1, 2, 4.0)];
    assert_eq!(terms.len(), 4, "{terms:?}");
    assert!(
        terms.iter().zip(expected).all(|(a, b)| (a.0, a.1) == (b.0, b.1) && close(a.2, b.2)),
        "{terms:?}"
    );
    assert!(faults("GRID,1\nMPC,5,1,1,0.,1,2,1.\n").contains("first term"));
}

/// A rigid motion u = u₀ + θ × x fulfils the equations of a link of some degrees of freedom, and a strain does not.
#[test]
fn rigid_elements_follow_wholly_or_partly() {
    let text = format!(
        "{CUBE}GRID,100,,3.,-1.,2.\nRBE2,50,100,123,1,2,3,4,1.-6\nRBE2,51,100,13,5,THRU,8\nRBAR,52,100,1,123456\n"
    );
    let found = deck(&text);
    assert_eq!(found.couplings.len(), 2);
    let first = &found.couplings[0];
    assert_eq!((numbers(&found, &first.nodes), first.kind), (vec![1, 2, 3, 4], CouplingKind::Rigid));
    assert_eq!(found.nodes[first.reference].number, 100);
    assert_eq!(found.equations.len(), 8);
    let (u0, theta) = ([0.3, -0.2, 0.5], [0.7, 0.1, -0.4]);
    let motion = |node: usize, dof: usize| {
        let turned = stridor_mesh::quality::cross(theta, found.nodes[node].position);
        if dof < 3 { u0[dof] + turned[dof] } else { theta[dof - 3] }
    };
    for equation in &found.equations {
        let sum: f64 = equation.terms.iter().map(|(node, dof, a)| a * motion(*node, usize::from(*dof))).sum();
        assert!(close(sum, 0.0), "{equation:?} {sum}");
        assert!(equation.terms.iter().any(|(node, ..)| found.nodes[*node].number == 100));
    }
}

#[test]
fn averages_have_their_nodes() {
    let text = format!(
        "{CUBE}GRID,100,,3.,0.,0.\nRBE3,60,,100,123456,1.,123,1,2\n,3,THRU,5,2.,123,6,,\n,UM,1,123\n"
    );
    let found = deck(&text);
    let coupling = &found.couplings[0];
    assert_eq!(
        (numbers(&found, &coupling.nodes), coupling.kind),
        (vec![1, 2, 3, 4, 5, 6], CouplingKind::Averaging)
    );
    assert!(
        notes(&found, Weight::Perhaps, "RBE3", "weights") && notes(&found, Weight::Matters, "RBE3", "UM")
    );
}

/// Equal forces of a set are one load; a node that has one twice has two.
#[test]
fn equal_forces_are_one_load() {
    let force = |node: usize| format!("FORCE,1,{node},0,2.,0.,0.,1.\n");
    let found =
        deck(&format!("{CUBE}{}{}{}{}FORCE,1,4,0,3.,0.,0.,1.\n", force(1), force(2), force(1), force(3)));
    let loads: Vec<_> = found.loads.iter().map(|load| load.on.clone()).collect();
    let on = |nodes: &[usize], force: f64| LoadOn::Nodes { nodes: nodes.to_vec(), force: [0.0, 0.0, force] };
    assert_eq!(loads, [on(&[0, 1], 2.0), on(&[0, 2], 2.0), on(&[3], 3.0)]);
}

/// Along the normal of plates; of PLOAD along that of its points, inwards on solids where they go round as seen from inside.
#[test]
fn pressures_on_plates_and_on_points() {
    let plate = "CQUAD4,20,2,5,6,7,8\nPSHELL,2,1,1.\nMAT1,1,2.+5,,.3,1.-9\n";
    let found = deck(&format!(
        "{CUBE}{plate}PLOAD2,1,2.,20\nPLOAD4,1,20,3.\nPLOAD,1,4.,6,5,8,7\nPLOAD,1,5.,1,2,3,4\nPLOAD,1,5.,4,3,2,1\nPLOAD,1,5.,1,2,7\n"
    ));
    let loads: Vec<_> = found.loads.iter().map(|load| load.on.clone()).collect();
    let shell = found.elements.iter().position(|element| element.number == 20).unwrap();
    let on = |pressure: f64| LoadOn::Shells { shells: vec![shell], pressure };
    assert_eq!(loads[..3], [on(2.0), on(3.0), on(-4.0)]);
    let pressures: Vec<f64> = loads[3..]
        .iter()
        .map(|on| if let LoadOn::Faces { pressure, .. } = on { *pressure } else { f64::NAN })
        .collect();
    // The lower side is seen from outside as 4, 3, 2, 1: that way round the normal points outwards.
    assert_eq!(pressures, [5.0, -5.0]);
    assert!(notes(&found, Weight::Matters, "PLOAD", "no element has"));
}

#[test]
fn pressures_and_rotations() {
    // The top of the cube: corners 5 and 7; all of a range, of which none but the first says a face.
    let found = deck(&format!("{CUBE}PLOAD4,1,10,2.5,,,,5,7\nRFORCE,1,2,,3.,0.,0.,2.\n"));
    let LoadOn::Faces { faces, pressure } = &found.loads[0].on else { panic!() };
    let sides = CellKind::Hexahedron8.table().sides;
    let mut corners = numbers(
        &found,
        &sides[faces[0].1].1.iter().map(|k| found.elements[0].nodes[usize::from(*k)]).collect::<Vec<_>>(),
    );
    corners.sort_unstable();
    assert_eq!((corners, *pressure), (vec![5, 6, 7, 8], 2.5));
    // Six revolutions a unit of time about z through point 2.
    let motion = &found.motions[0];
    assert_eq!((motion.point, motion.axis), ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]));
    assert!(close(motion.speed, 12.0 * std::f64::consts::PI));
    assert!(faults(&format!("{CUBE}PLOAD4,1,10,2.5,,,,5,6\n")).contains("PLOAD4 with corners 5 and 6"));
}

/// Contact and glue between the top of one cube and the bottom of another, in the words of three programs.
#[test]
fn contact_is_between_surfaces() {
    let cubes = two_cubes();
    let regions = "BSURFS,1,,,,10,5,6,7\nBSURFS,2,,,,20,11,12,13\n";
    let found = deck(&format!(
        "CEND\nBCSET=8\nBGSET=9\nBEGIN BULK\n{cubes}{regions}BCTADD,8,81\nBCTSET,81,1,2,.4,,.1\nBGSET,9,2,1,.05\nENDDATA\n"
    ));
    let (contact, tie) = (&found.contacts[0], &found.ties[0]);
    assert_eq!(
        (contact.slave.as_str(), contact.master.as_str(), contact.friction),
        ("BSURFS_1", "BSURFS_2", 0.4)
    );
    assert_eq!((tie.slave.as_str(), tie.master.as_str(), tie.within), ("BSURFS_2", "BSURFS_1", Some(0.05)));
    // Sides S2 and S1 of the table: above and below.
    assert_eq!(
        (&found.surface("BSURFS_1").unwrap().faces[..], &found.surface("BSURFS_2").unwrap().faces[..]),
        (&[(0, 1)][..], &[(1, 0)][..])
    );

    let bodies = "BSURF,1,10\nBSURF,2,20\nBCBODY,3,3D,DEFORM,1\nBCBODY,4,3D,DEFORM,2\n";
    let table = "BCTABLE,5,,,1\n,SLAVE,3,.1,,.2\n,,\n,MASTERS,4\n";
    let found = deck(&format!("{cubes}{bodies}{table}"));
    let contact = &found.contacts[0];
    assert_eq!(
        (contact.slave.as_str(), contact.master.as_str(), contact.friction),
        ("BSURF_1", "BSURF_2", 0.2)
    );
    // A body touches with all of its skin.
    assert_eq!(found.surface("BSURF_1").unwrap().faces, [0, 1, 2, 3, 4, 5].map(|side| (0, side)));

    let own = "SURF,1,ELFACE\n,10,5,7,0\nSURF,2,ELFACE\n,20,11,13\n,30,,,1\nCQUAD4,30,4,11,12,13,14\nPSHELL,4,5,.1,5,,5\nPCONT,6,,,.35\nCONTACT,7,6,1,2\nTIE,8,,2,1\n";
    let found = deck(&format!("{cubes}{own}"));
    assert_eq!(
        (found.contacts[0].friction, found.contacts[0].slave.as_str(), found.ties.len()),
        (0.35, "SURF_1", 1)
    );
    let surface = found.surface("SURF_2").unwrap();
    assert_eq!((&surface.faces[..], &surface.shells[..]), (&[(1, 0)][..], &[(2, ShellFace::Negative)][..]));
    assert!(faults(&format!("{cubes}BSURFS,1,,,,10,5,6,1,20,17,18,3\n")).contains("corners of BSURFS"));
}

/// Lists that go on over lines which begin with blanks, and over commas at the ends of lines.
#[test]
fn lists_of_surfaces_go_on_over_lines() {
    let shells: String = (1..=30).map(|k| format!("CQUAD4,{},4,1,2,3,4\n", 100 + k)).collect();
    let rest = "PSHELL,4,5,.1,5,,5\n";
    let list = "BSURF          1     101     102     103     104     105     106     107\n             108    THRU     110     113      BY       2     117\nBSURF, 2,101,102,103,104,105,106,\n107,108,109\n";
    let fault = faults(&format!("{CUBE}{shells}{rest}{list}"));
    assert!(fault.contains("BY of BSURF"), "{fault}");
    let found = deck(&format!(
        "{CUBE}{shells}{rest}{}",
        list.replace("     113      BY       2     117", "     113    THRU     119      BY       2")
    ));
    let elements = |name: &str| {
        let shells = &found.surface(name).unwrap().shells;
        shells.iter().map(|(element, _)| found.elements[*element].number).collect::<Vec<_>>()
    };
    assert_eq!(elements("BSURF_1"), [101, 102, 103, 104, 105, 106, 107, 108, 109, 110, 113, 115, 117, 119]);
    assert_eq!(elements("BSURF_2"), [101, 102, 103, 104, 105, 106, 107, 108, 109]);
    let found = deck(&format!(
        "{CUBE}SET,3,GRID,LIST\n,1,THRU,8,EXCEPT,3,5\n$HMSET 4 2 \"linings\"\nSET,4,ELEM,LIST\n,10\n"
    ));
    assert_eq!(numbers(&found, &found.node_set("SET_3").unwrap().members), [1, 2, 4, 6, 7, 8]);
    assert_eq!(found.element_set("linings").unwrap().members, [0]);
}
