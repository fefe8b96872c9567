//! What is written reads back as the same deck.

use super::held as held_all;
use super::*;
use crate::deck::{
    Analysis, Contact, Coupling, CouplingKind, Elastic, Element, Equation, Load, LoadOn, Material, Motion,
    Node, PointMass, Profile, Section, SectionShape, Set, ShellFace, Spring, Surface, Tie,
};
use crate::format::{Format, read_bytes, write};
use stridor_base::bounds::{Origin::*, within};
use stridor_mesh::{CellKind, Program};

/// An element of each kind that a program has, on nodes of its own, in a section of its own.
fn one_of_each(program: Program) -> Deck {
    let mut deck = Deck { title: "One of each".into(), ..Deck::default() };
    deck.materials.push(steel());
    deck.analyses.push(Analysis::Modes { count: Some(8), band: [None, Some(2e4)] });
    for kind in CellKind::all().filter(|kind| kind.dimension() > 0) {
        let has = !kind.named(program).is_empty();
        let written = match program {
            Program::Nastran => has && !matches!(kind, CellKind::Line3 | CellKind::Quadrilateral9),
            _ => has || kind == CellKind::Pyramid13,
        };
        if !written {
            continue;
        }
        let first = deck.nodes.len();
        for at in kind.reference_coordinates() {
            let number = 10 * deck.nodes.len() as u64 + 7;
            let position = [at[0] + first as f64, at[1] / 3.0, 1e-7 * at[2]];
            deck.nodes.push(Node { number, position, place: Place::default() });
        }
        let index = deck.elements.len();
        deck.elements.push(Element {
            number: 1000 - index as u64,
            kind,
            type_name: 0,
            nodes: (first..deck.nodes.len()).collect(),
            place: Place::default(),
        });
        let shape = match kind.dimension() {
            1 if kind == CellKind::Line3 => SectionShape::Truss { area: 0.25 },
            1 => SectionShape::Beam {
                profile: Profile::General { area: 4e-4, second_moments: [2e-8, 3e-8], torsion: 1e-8 },
                first_axis: Some([0.0, 1.0, 0.5]),
            },
            2 => SectionShape::Shell { thickness: 0.00125 },
            _ => SectionShape::Solid,
        };
        let name = format!("PART_{index}");
        let (material, elements, place) = ("steel".to_string(), vec![index], Place::default());
        deck.element_sets.push(Set { name: name.clone(), members: elements.clone(), internal: false });
        deck.sections.push(Section { name, elements, material, axes: None, shape, place });
    }
    deck
}

fn steel() -> Material {
    let elastic = Some(Elastic::Isotropic { youngs_modulus: 2.1e11, poissons_ratio: 0.3 });
    Material { name: "steel".into(), elastic, density: Some(7850.0), ..Material::default() }
}

/// The deck that its text in a format reads as, and that text.
fn again(deck: &Deck, format: Format) -> (Deck, String) {
    let text = write(deck, format).unwrap().text;
    let read = read_bytes("a", text.as_bytes(), format);
    (read.unwrap_or_else(|error| panic!("{error}\n{text}")), text)
}

/// Elements by number: kind, numbers of the nodes.
fn elements(deck: &Deck) -> Vec<(u64, CellKind, Vec<u64>)> {
    let numbers = |element: &Element| element.nodes.iter().map(|node| deck.nodes[*node].number).collect();
    let mut all: Vec<_> =
        deck.elements.iter().map(|element| (element.number, element.kind, numbers(element))).collect();
    all.sort();
    all
}

fn nodes(deck: &Deck) -> Vec<(u64, [f64; 3])> {
    let mut all: Vec<_> = deck.nodes.iter().map(|node| (node.number, node.position)).collect();
    all.sort_by_key(|(number, _)| *number);
    all
}

/// Whether numbers are the same but for digits that a field does not hold.
fn close(a: f64, b: f64, part: f64) -> bool {
    within((a - b).abs(), part * a.abs(), RoundOff)
}

/// Kinds, orders of nodes, numbers, coordinates; sections with their shapes by the numbers of their elements.
#[test]
fn every_kind_of_element_reads_back() {
    for (format, program, digits) in
        [(Format::Abaqus, Program::Abaqus, 1e-12), (Format::Nastran, Program::Nastran, 1e-8)]
    {
        let deck = one_of_each(program);
        let (read, text) = again(&deck, format);
        assert_eq!(elements(&read), elements(&deck), "{text}");
        for (own, other) in nodes(&deck).iter().zip(nodes(&read)) {
            assert_eq!(own.0, other.0);
            assert!((0..3).all(|k| close(own.1[k], other.1[k], digits)), "{own:?} {other:?}");
        }
        assert_eq!(read.nodes.len(), deck.nodes.len());
        assert_eq!(read.analyses, deck.analyses, "{text}");
        assert_eq!(read.title, deck.title);
        assert_eq!(read.sections.len(), deck.sections.len(), "{text}");
        for section in &deck.sections {
            let number = deck.elements[section.elements[0]].number;
            let index = read.elements.iter().position(|element| element.number == number).unwrap();
            let other = read.sections.iter().find(|other| other.elements == [index]).unwrap();
            assert_eq!((&other.name, &other.shape), (&section.name, &section.shape), "{text}");
            let material = read.material(&other.material).unwrap();
            let Some(Elastic::Isotropic { youngs_modulus, poissons_ratio }) = material.elastic else {
                panic!()
            };
            assert!(
                close(2.1e11, youngs_modulus, 1e-12) && close(0.3, poissons_ratio, 1e-10),
                "{material:?}"
            );
            assert_eq!(material.density, Some(7850.0));
        }
    }
}

/// Two bricks side by side and a third on them, with all that a deck has beside elements.
fn bricks() -> Deck {
    let place = Place::default();
    let mut deck = Deck { title: "Bricks".into(), ..Deck::default() };
    for origin in [[0.0; 3], [0.0, 0.0, 1.0]] {
        for at in CellKind::Hexahedron8.reference_coordinates() {
            let position = std::array::from_fn(|k| origin[k] + 0.5 * (at[k] + 1.0));
            deck.nodes.push(Node { number: deck.nodes.len() as u64 + 1, position, place });
        }
    }
    // A point above, and one beside.
    for position in [[0.5, 0.5, 3.0], [2.0, 0.5, 0.5]] {
        deck.nodes.push(Node { number: deck.nodes.len() as u64 + 1, position, place });
    }
    for first in [0, 8] {
        let nodes = (first..first + 8).collect();
        deck.elements.push(Element {
            number: first as u64 + 1,
            kind: CellKind::Hexahedron8,
            type_name: 0,
            nodes,
            place,
        });
    }
    deck.materials.push(steel());
    deck.materials.push(Material {
        name: "lining".into(),
        elastic: Some(Elastic::Orthotropic {
            youngs_moduli: [8e9, 7e9, 1e9],
            poissons_ratios: [0.25, 0.2, 0.3],
            shear_moduli: [3e9, 1.5e9, 1.25e9],
        }),
        density: Some(2500.0),
        rayleigh: [0.0; 2],
        loss_factor: 0.0625,
    });
    for (k, (name, material)) in [("LOWER", "steel"), ("UPPER", "lining")].into_iter().enumerate() {
        let axes = (k == 1).then_some([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        let (name, material) = (name.to_string(), material.to_string());
        deck.element_sets.push(Set { name: name.clone(), members: vec![k], internal: false });
        deck.sections.push(Section {
            name,
            elements: vec![k],
            material,
            axes,
            shape: SectionShape::Solid,
            place,
        });
    }
    let sides = |element: usize, side: usize, name: &str| Surface {
        name: name.into(),
        faces: vec![(element, side)],
        ..Surface::default()
    };
    deck.surfaces.extend([sides(0, 1, "BELOW"), sides(1, 0, "ABOVE"), sides(1, 1, "TOP")]);
    let floor = vec![0, 1, 2, 3];
    deck.node_sets.push(Set { name: "FLOOR".into(), members: floor.clone(), internal: false });
    let held = [true, false, true, false, false, false];
    deck.supports.push(crate::deck::Support {
        title: "wall".into(),
        name: Some("FLOOR".into()),
        nodes: floor,
        held,
        frame: Frame::Global,
        place,
    });
    deck
}

/// Supports, equations, ties, rigid bodies, contacts, masses, springs, loads, rotations, materials with axes.
#[test]
fn what_joins_and_loads_elements_reads_back() {
    let place = Place::default();
    for format in [Format::Abaqus, Format::Nastran] {
        let mut deck = bricks();
        let (slave, master) = ("ABOVE".to_string(), "BELOW".to_string());
        deck.equations.push(Equation { terms: vec![(5, 1, 2.0), (6, 1, -1.0), (7, 0, 0.5)], place });
        deck.ties.push(Tie {
            name: "BGSET_1".into(),
            slave: slave.clone(),
            master: master.clone(),
            within: Some(0.125),
            place,
        });
        deck.contacts.push(Contact {
            name: "BCTSET_1".into(),
            slave,
            master,
            friction: 0.375,
            stiffness: (format == Format::Abaqus).then_some(1e12),
            stick: (format == Format::Abaqus).then_some(2.5e11),
            closed: false,
            place,
        });
        let coupling = |kind, nodes| Coupling {
            name: "JOINT".into(),
            reference: 16,
            nodes,
            of: Some("TOP".into()),
            kind,
            place,
        };
        deck.couplings.push(coupling(CouplingKind::Rigid, vec![12, 13, 14, 15]));
        deck.masses.push(PointMass {
            name: "LUMP".into(),
            nodes: vec![16],
            mass: 0.5,
            inertia: [0.0; 3],
            place,
        });
        for (ends, dof) in
            [(vec![(17, Some(5))], None), (vec![(16, None)], Some(2)), (vec![(5, Some(6))], Some(0))]
        {
            let name = "SPRINGS".to_string();
            deck.springs.push(Spring { name, ends, dof, stiffness: 1e6, damping: 0.0, place });
        }
        let of = |on: LoadOn| Load { name: String::new(), on, place };
        deck.loads.push(of(LoadOn::Nodes { nodes: vec![14], force: [0.0, -20.0, 0.0] }));
        deck.loads.push(of(LoadOn::Faces { faces: vec![(1, 3)], pressure: 1e5 }));
        let (read, text) = again(&deck, format);
        let same_support = |a: &Support, b: &Support| (&a.nodes, a.held) == (&b.nodes, b.held);
        assert!(read.supports.len() == 1 && same_support(&read.supports[0], &deck.supports[0]), "{text}");
        let terms = |deck: &Deck| deck.equations.iter().map(|e| e.terms.clone()).collect::<Vec<_>>();
        assert_eq!(terms(&read), terms(&deck), "{text}");
        let faces = |deck: &Deck, name: &str| deck.surface(name).unwrap().faces.clone();
        for (own, other) in deck.ties.iter().zip(&read.ties) {
            assert_eq!(
                (own.within, faces(&deck, &own.slave)),
                (other.within, faces(&read, &other.slave)),
                "{text}"
            );
            assert_eq!(faces(&deck, &own.master), faces(&read, &other.master));
        }
        for (own, other) in deck.contacts.iter().zip(&read.contacts) {
            assert_eq!(
                (own.friction, own.stiffness, own.stick),
                (other.friction, other.stiffness, other.stick)
            );
            assert_eq!(faces(&deck, &own.slave), faces(&read, &other.slave));
        }
        for (own, other) in deck.couplings.iter().zip(&read.couplings) {
            assert_eq!((own.reference, &own.nodes, own.kind), (other.reference, &other.nodes, other.kind));
        }
        for (own, other) in deck.masses.iter().zip(&read.masses) {
            assert_eq!((&own.nodes, own.mass, own.inertia), (&other.nodes, other.mass, other.inertia));
        }
        let springs = |deck: &Deck| {
            let of = |s: &Spring| (s.dof, s.ends.clone(), s.stiffness.to_bits(), s.damping.to_bits());
            let mut all: Vec<_> = deck.springs.iter().map(of).collect();
            all.sort();
            all
        };
        assert_eq!(springs(&read), springs(&deck), "{text}");
        let loads = |deck: &Deck| deck.loads.iter().map(|load| load.on.clone()).collect::<Vec<_>>();
        assert_eq!(loads(&read), loads(&deck), "{text}");
        let counts =
            |deck: &Deck| [deck.ties.len(), deck.contacts.len(), deck.couplings.len(), deck.masses.len()];
        assert_eq!(counts(&read), counts(&deck));
        let axes = |deck: &Deck| deck.sections.iter().map(|section| section.axes).collect::<Vec<_>>();
        assert_eq!(axes(&read), axes(&deck));
        assert_eq!(read.materials, deck.materials, "{text}");
    }
}

/// Names that a format has a comment for: of supports and contacts in Abaqus, of surfaces in NASTRAN.
#[test]
fn names_in_comments_read_back() {
    for format in [Format::Abaqus, Format::Nastran] {
        let mut deck = bricks();
        deck.contacts.push(Contact {
            name: "rub: inner".into(),
            slave: "ABOVE".into(),
            master: "BELOW".into(),
            friction: 0.4,
            stiffness: None,
            stick: None,
            closed: false,
            place: Place::default(),
        });
        let (read, text) = again(&deck, format);
        let (contact, support) = (&read.contacts[0], &read.supports[0]);
        assert_eq!((contact.slave.as_str(), contact.master.as_str()), ("ABOVE", "BELOW"), "{text}");
        let names = if format == Format::Abaqus { ["rub: inner", "wall"] } else { [""; 2] };
        assert_eq!([contact.name.as_str(), support.title.as_str()], names, "{text}");
        let floor = read.node_set("FLOOR").map(|set| set.members.as_slice());
        assert_eq!(floor, deck.node_set("FLOOR").map(|set| set.members.as_slice()), "{text}");
    }
}

/// What a deck lost before, and what a format does not hold: comments of the file, which are read back.
#[test]
fn what_is_lost_stands_in_the_file() {
    for format in [Format::Abaqus, Format::Nastran] {
        let mut deck = bricks();
        let place = Place::default();
        deck.ledger.note(Weight::Matters, "contact.rub", "a load of 50 N is not written: press", place);
        deck.ledger.note(Weight::Perhaps, "shell.disc", "is another one", place);
        let (point, axis) = ([0.0; 3], [0.0, 0.0, 1.0]);
        deck.motions.push(Motion { set: "LOWER".into(), point, axis, speed: 1.0, place });
        let (read, text) = again(&deck, format);
        let what: Vec<&str> = read.lost.iter().map(|(what, _)| what.as_str()).collect();
        let wanted =
            if format == Format::Abaqus { &["contact.rub"][..] } else { &["contact.rub", "rotations"] };
        assert_eq!(what, wanted, "{text}");
        assert_eq!(read.lost[0].1, "a load of 50 N is not written: press");
    }
}

/// A rotation is of the nodes of its set.
#[test]
fn a_rotation_reads_back() {
    let mut deck = bricks();
    let (point, axis, place) = ([0.5, 0.5, 0.0], [0.0, 0.0, 1.0], Place::default());
    deck.motions.push(Motion { set: "LOWER".into(), point, axis, speed: 62.5, place });
    let (read, text) = again(&deck, Format::Abaqus);
    let [motion] = &read.motions[..] else { panic!("{text}") };
    assert_eq!((motion.point, motion.axis, motion.speed), (point, axis, 62.5));
    assert_eq!(read.node_set(&motion.set).unwrap().members, (0..8).collect::<Vec<_>>());
    let written = write(&deck, Format::Nastran).unwrap();
    assert!(written.left_out.rows().any(|row| row.what == "rotations" && row.weight == Weight::Matters));
}

/// Directions about an axis are held by sums that are met by what is free, and by nothing else.
#[test]
fn directions_about_an_axis_are_held_by_equations() {
    let frame = Frame::Cylindrical([[0.0; 3], [0.0, 0.0, 2.0]]);
    let mut deck = bricks();
    deck.supports[0].frame = frame;
    deck.supports[0].held = [true, false, true, false, false, false];
    let held = held_nodes(&deck, &deck.supports[0]);
    for HeldNode { node, held, sums } in &held {
        let [x, y, _] = deck.nodes[*node].position;
        let tangent = if x == 0.0 && y == 0.0 { [0.0, 1.0, 0.0] } else { [-y, x, 0.0] };
        let free =
            |sum: &[(usize, u8, f64)]| sum.iter().map(|(_, k, a)| a * tangent[usize::from(*k)]).sum::<f64>();
        assert!(
            held[2] && sums.iter().all(|sum| within(free(sum).abs(), 1e-14, RoundOff)),
            "{held:?} {sums:?}"
        );
        assert!((0..2).all(|k| !held[k] || tangent[k] == 0.0));
        assert_eq!(held.iter().filter(|held| **held).count() + sums.len(), 2);
    }
    let (read, _) = again(&deck, Format::Abaqus);
    assert_eq!(read.equations.len(), 1, "that at (1, 1)");
    // With uy held by another support nothing is left of it but ux.
    let other = Support {
        title: String::new(),
        held: [false, true, false, false, false, false],
        frame: Frame::Global,
        ..deck.supports[0].clone()
    };
    deck.supports.push(other);
    let all = held_all(&deck);
    assert!(all.sums.is_empty() && all.more == [(2, 0)], "{all:?}");
}

/// Names that a format does not take, and two that differ in the case of their letters.
#[test]
fn names_are_made_ones_of_the_format() {
    let mut names = Names::default();
    assert_eq!(names.of("pad.inner"), "pad_inner");
    assert_eq!(names.of("pad inner"), "pad_inner_2");
    assert_eq!(names.of("PAD.INNER"), "pad_inner");
    assert_eq!(names.of("2nd"), "N2nd");
    let long = names.of(&"x".repeat(200));
    assert_eq!(long.len(), LONGEST);
}

/// Shells of both faces, of surfaces.
#[test]
fn faces_of_shells_read_back() {
    let mut deck = one_of_each(Program::Abaqus);
    let shells: Vec<(usize, ShellFace)> = (0..deck.elements.len())
        .filter(|index| deck.elements[*index].kind.dimension() == 2)
        .map(|index| (index, if index % 2 == 0 { ShellFace::Positive } else { ShellFace::Negative }))
        .collect();
    deck.surfaces.push(Surface { name: "SKIN".into(), shells: shells.clone(), ..Surface::default() });
    let (read, _) = again(&deck, Format::Abaqus);
    assert_eq!(read.surface("SKIN").unwrap().shells, shells);
}
