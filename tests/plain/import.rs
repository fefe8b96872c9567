//! Models of other programs: an imported case is the same as one that was made here.

use std::fmt::Write as _;
use std::path::Path;
use stridor::bounds::{Origin::*, within};
use stridor::case::read_case;
use stridor::decks::{self, Converted, Units, convert};
use stridor::job::{Prepared, Selection, analyse};
use stridor::linalg::c64;
use stridor::mesh::{Cell, CellKind, Mesh, Region, to_msh_exactly};
use stridor::results::{ComplexResult, RunResults};

/// A block of n × m × l bricks of some size \[mm\]: nodes of a grid, and bricks in the order of Abaqus.
struct Block {
    cells: [usize; 3],
    size: [f64; 3],
}

impl Block {
    fn node(&self, [i, j, k]: [usize; 3]) -> usize {
        i + (self.cells[0] + 1) * (j + (self.cells[1] + 1) * k)
    }

    fn grid(n: [usize; 3]) -> impl Iterator<Item = [usize; 3]> {
        (0..n[2]).flat_map(move |k| (0..n[1]).flat_map(move |j| (0..n[0]).map(move |i| [i, j, k])))
    }

    fn nodes(&self) -> Vec<[f64; 3]> {
        let place =
            |at: [usize; 3]| std::array::from_fn(|k| self.size[k] * at[k] as f64 / self.cells[k] as f64);
        Block::grid(self.cells.map(|n| n + 1)).map(place).collect()
    }

    fn bricks(&self) -> Vec<[usize; 8]> {
        let corners =
            [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
        let brick = |at: [usize; 3]| {
            corners.map(|c: [usize; 3]| self.node([at[0] + c[0], at[1] + c[1], at[2] + c[2]]))
        };
        Block::grid(self.cells).map(brick).collect()
    }

    /// Nodes of the lowest or the highest plane z = constant.
    fn plane(&self, k: usize) -> Vec<usize> {
        Block::grid([self.cells[0] + 1, self.cells[1] + 1, 1]).map(|[i, j, _]| self.node([i, j, k])).collect()
    }

    /// *PART of it, with a set of all elements.
    fn part(&self, name: &str, material: &str) -> String {
        let mut text = format!("*Part, name={name}\n*Node\n");
        for (n, [x, y, z]) in self.nodes().into_iter().enumerate() {
            writeln!(text, "{}, {x:?}, {y:?}, {z:?}", n + 1).unwrap();
        }
        text += "*Element, type=C3D8I, elset=All\n";
        for (e, brick) in self.bricks().into_iter().enumerate() {
            writeln!(text, "{}, {}", e + 1, brick.map(|n| (n + 1).to_string()).join(", ")).unwrap();
        }
        text + &format!("*Solid Section, elset=ALL, material={material}\n*End Part\n")
    }
}

const DISC: Block = Block { cells: [6, 6, 1], size: [60.0, 60.0, 6.0] };
const PAD: Block = Block { cells: [4, 3, 1], size: [20.0, 16.0, 5.0] };
const BACK: Block = Block { cells: [3, 3, 1], size: [20.0, 16.0, 4.0] };
/// Where pad and backplate stand \[mm\], and the angle about the z axis through (31.3, 29.7) that they are turned by: no corner of one mesh on an edge of another.
const AT: [[f64; 3]; 2] = [[20.0, 22.0, 6.0], [20.0, 22.0, 11.0]];
const ANGLE: f64 = 25.0;

fn numbers(list: impl IntoIterator<Item = usize>) -> String {
    let all: Vec<String> = list.into_iter().map(|n| (n + 1).to_string()).collect();
    all.chunks(12).map(|line| line.join(", ")).collect::<Vec<_>>().join(",\n") + "\n"
}

/// A disc, a pad that slides on it, and a backplate glued to the pad, as Abaqus' preprocessor writes it.
fn deck() -> String {
    let mut text = "*Heading\n A pad on a disc\n".to_string();
    text += &(DISC.part("Disc", "Iron") + &PAD.part("Pad", "Lining") + &BACK.part("Back", "Steel"));
    text += "*Assembly, name=Assembly\n*Instance, name=Disc-1, part=Disc\n*End Instance\n";
    for (name, [x, y, z]) in ["Pad", "Back"].into_iter().zip(AT) {
        writeln!(
            text,
            "*Instance, name={name}-1, part={name}\n{x}, {y}, {z}\n31.3, 29.7, 0., 31.3, 29.7, 1., {ANGLE}"
        )
        .unwrap();
        text += "*End Instance\n";
    }
    let set = |name: &str, instance: &str, nodes: Vec<usize>| {
        format!("*Nset, nset={name}, instance={instance}\n{}", numbers(nodes))
    };
    text += &set("Bottom", "Disc-1", DISC.plane(0));
    text += &set("Turning", "Disc-1", (0..DISC.nodes().len()).collect());
    text += &set("Guided", "Back-1", BACK.plane(1));
    for (name, instance, face) in [
        ("Disc_top", "Disc-1", 2),
        ("Pad_face", "Pad-1", 1),
        ("Pad_back", "Pad-1", 2),
        ("Back_face", "Back-1", 1),
        ("Piston", "Back-1", 2),
    ] {
        let n = [DISC, PAD, BACK][["Disc-1", "Pad-1", "Back-1"].iter().position(|i| *i == instance).unwrap()]
            .bricks()
            .len();
        writeln!(text, "*Elset, elset=_{name}_S{face}, internal, instance={instance}, generate\n1, {n}, 1")
            .unwrap();
        writeln!(text, "*Surface, type=ELEMENT, name={name}\n_{name}_S{face}, S{face}").unwrap();
    }
    text + "*Tie, name=Glue, adjust=no, position tolerance=0.1\nBack_face, Pad_back\n*End Assembly\n\
        *Material, name=Iron\n*Density\n7.2e-09,\n*Elastic\n120000., 0.26\n\
        *Material, name=Lining\n*Density\n2.5e-09,\n*Elastic\n8000., 0.25\n\
        *Material, name=Steel\n*Density\n7.85e-09,\n*Elastic\n210000., 0.3\n\
        *Surface Interaction, name=Rub\n*Friction\n0.5,\n*Surface Behavior, pressure-overclosure=LINEAR\n1000.,\n\
        *Contact Pair, interaction=Rub, type=SURFACE TO SURFACE\nPad_face, Disc_top\n\
        *Boundary\nBottom, ENCASTRE\nGuided, 1, 2\n\
        *Step, name=Press, nlgeom=YES\n*Static\n1., 1.\n*Dsload\nPiston, P, 0.8\n*End Step\n\
        *Step, name=Turn\n*Static\n*Motion, rotation\nTurning, 0.6, -3000., 30., 0., -3000., 30., 1.\n*End Step\n\
        *Step, name=Squeal\n*Complex Frequency, friction damping=NO\n20, 100., 80000.\n*Output, field\n*End Step\n"
}

/// The same as a mesh \[m\] with its case.
fn native() -> (Mesh, &'static str) {
    let mut mesh = Mesh::default();
    let (sin, cos) = f64::to_radians(ANGLE).sin_cos();
    let placed = |[x, y, z]: [f64; 3], at: [f64; 3]| {
        let [u, v] = [x + at[0] - 31.3, y + at[1] - 29.7];
        [u * cos - v * sin + 31.3, u * sin + v * cos + 29.7, z + at[2]]
    };
    let region = |mesh: &mut Mesh, name: &str, dimension, cells: Vec<Cell>| {
        let first = mesh.elements.len();
        mesh.elements.extend(cells);
        let elements = (first..mesh.elements.len()).collect();
        mesh.regions.push(Region { name: name.into(), dimension, elements });
    };
    for (name, block, at) in [("disc", &DISC, None), ("pad", &PAD, Some(AT[0])), ("back", &BACK, Some(AT[1]))]
    {
        let first = mesh.nodes.len();
        let nodes = block.nodes().into_iter().map(|p| at.map_or(p, |at| placed(p, at)));
        mesh.nodes.extend(nodes.map(|p| p.map(|x| x * 1e-3)));
        let shifted = |nodes: &[usize]| nodes.iter().map(|n| n + first).collect::<Vec<_>>();
        let bricks = block.bricks();
        let brick = |b: &[usize; 8]| Cell::new(CellKind::Hexahedron8, &shifted(b)).unwrap();
        let cells: Vec<Cell> = bricks.iter().map(brick).collect();
        // S1 and S2.
        for (side, word) in ["low", "high"].into_iter().enumerate() {
            let faces = cells.iter().map(|cell| cell.sides().nth(side).unwrap()).collect();
            region(&mut mesh, &format!("{name}_{word}"), 2, faces);
        }
        region(&mut mesh, name, 3, cells);
    }
    let case = r#"title = "The same"
mesh = { file = "mesh.msh", unit = "m" }
material.iron = { youngs_modulus = "120 GPa", poissons_ratio = 0.26, density = "7200 kg/m^3" }
material.lining = { youngs_modulus = "8 GPa", poissons_ratio = 0.25, density = "2500 kg/m^3" }
material.steel = { youngs_modulus = "210 GPa", poissons_ratio = 0.3, density = "7850 kg/m^3" }
solid.disc = { material = "iron" }
solid.pad = { material = "lining" }
solid.back = { material = "steel" }
tie.glue = { on = "back_low", to = "pad_high", within = "0.1 mm" }
support.bottom = { on = "disc_low" }
support.guided = { on = "back_high", held = ["ux", "uy"] }
force.piston = { on = "back_high", pressure = "0.8 MPa" }
cea = { band = [100, 80000] }

[contact.pad]
body = "pad_low"
counter = "disc_high"
approach = 0
rotation = { axis = [0, 0, 1], point = ["-3 m", "30 mm", 0], speed = "0.6 rad/s" }
normal = { per = "area", stiffness = "1000 GN/m^3" }
friction = { law = "coulomb", mu0 = 0.5 }
"#;
    (mesh, case)
}

/// The complex eigenvalues of a case in a folder.
fn eigenvalues(folder: &Path, mesh: &Mesh, case: &str) -> Vec<c64> {
    std::fs::write(folder.join(Converted::MESH_FILE), to_msh_exactly(mesh).unwrap()).unwrap();
    std::fs::write(folder.join("case.toml"), case).unwrap();
    let case = read_case(&folder.join("case.toml")).unwrap_or_else(|error| panic!("{error}\n{case}"));
    let prepared = Prepared::new(&case).unwrap();
    let results: RunResults = analyse(&prepared, Selection::Only("cea"), &mut |_| Ok(()), &()).unwrap();
    results.get::<ComplexResult>().unwrap().modes.modes.iter().map(|mode| mode.eigenvalue).collect()
}

fn imported(folder: &Path, text: &str) -> Converted {
    let path = folder.join("brake.inp");
    std::fs::write(&path, text).unwrap();
    let deck = decks::read(&path, None).unwrap_or_else(|error| panic!("{error}"));
    convert(&deck, Units::named("mm").unwrap()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_brake_of_abaqus_has_the_eigenvalues_of_the_same_made_here() {
    let (from, to) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let made = imported(from.path(), &deck());
    let (mesh, case) = native();
    let (own, other) =
        (eigenvalues(to.path(), &mesh, case), eigenvalues(from.path(), &made.mesh, &made.case));
    assert!(own.len() > 10 && own.len() == other.len(), "{} {}", own.len(), other.len());
    for (a, b) in own.iter().zip(&other) {
        assert!(within((a - b).norm(), 1e-9 * a.norm(), Tolerance), "{a} {b}");
    }
    // 120 × 60 … of all three: ρ V.
    let mass = 7200.0 * 60e-3 * 60e-3 * 6e-3 + 2500.0 * 20e-3 * 16e-3 * 5e-3 + 7850.0 * 20e-3 * 16e-3 * 4e-3;
    assert!(within((made.mass - mass).abs(), 1e-12 * mass, RoundOff), "{}", made.mass);
    assert_eq!(
        made.ledger.rows().filter(|row| row.weight == decks::Weight::Matters).count(),
        0,
        "{}",
        made.page
    );
    assert!(made.page.contains("| *OUTPUT | nothing of the vibrations | no |"), "{}", made.page);
}

#[test]
fn the_same_file_gives_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let [a, b] = [(); 2].map(|()| imported(folder.path(), &deck()));
    assert_eq!(
        (&a.case, &a.page, to_msh_exactly(&a.mesh).unwrap()),
        (&b.case, &b.page, to_msh_exactly(&b.mesh).unwrap())
    );
}

#[test]
fn a_slip_of_units_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let slip = deck().replace("7.2e-09", "7200.");
    let made = imported(folder.path(), &slip);
    let text = made.warnings.join("\n");
    assert!(
        text.contains("Material `Iron`") && text.contains("mixes units") && text.contains("All parts weigh"),
        "{text}"
    );
    // The whole file in SI beside lengths in mm.
    let si = deck().replace("*Density\n7.2e-09,\n*Elastic\n120000.", "*Density\n7200.,\n*Elastic\n1.2e11");
    let text = imported(folder.path(), &si).warnings.join("\n");
    assert!(text.contains("with --unit m"), "{text}");
}

#[test]
fn every_fault_of_a_deck_is_found_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("brake.inp");
    let wrong = deck()
        .replace("Bottom, ENCASTRE", "Botom, ENCASTRE")
        .replace("Back_face, Pad_back", "Back_face, Pad_bak")
        .replace("120000., 0.26", "12o000., 0.26");
    std::fs::write(&path, wrong).unwrap();
    let text = decks::read(&path, None).unwrap_err().to_string();
    for word in ["3 faults", "`Botom`", "`Pad_bak`", "`12o000.`", "brake.inp:"] {
        assert!(text.contains(word), "{word}: {text}");
    }
}

/// Two bricks that are tied, or touch, have nodes at one place and one section, one set of elements and one of nodes.
#[test]
fn pieces_of_a_section_that_touch_are_parts_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    let block = Block { cells: [1, 1, 1], size: [10.0; 3] };
    let mut text = "*Node, nset=Nall\n".to_string();
    for (n, [x, y, z]) in block.nodes().into_iter().enumerate() {
        writeln!(text, "{}, {x}, {y}, {z}\n{}, {}, {y}, {z}", n + 1, n + 11, x + 10.0).unwrap();
    }
    text += "*Element, type=C3D8I, elset=Eall\n";
    let brick = block.bricks()[0];
    for (e, first) in [1, 11].into_iter().enumerate() {
        writeln!(text, "{}, {}", e + 1, brick.map(|n| (n + first).to_string()).join(", ")).unwrap();
    }
    // S4 and S6: x = 10 of the first, and of the second.
    text += "*Surface, name=Left\n1, S4\n*Surface, name=Right\n2, S6\n*Tie, name=Glue\nRight, Left\n\
        *Solid Section, elset=Eall, material=Steel\n*Material, name=Steel\n*Density\n7.85e-9\n*Elastic\n210000, 0.3\n\
        *Boundary\n1, 1, 3\n3, 1, 3\n5, 1, 3\n*Step\n*Frequency\n4\n*End Step\n";
    let made = imported(folder.path(), &text);
    std::fs::write(folder.path().join(Converted::MESH_FILE), to_msh_exactly(&made.mesh).unwrap()).unwrap();
    std::fs::write(folder.path().join("case.toml"), &made.case).unwrap();
    let case = read_case(&folder.path().join("case.toml")).unwrap();
    let prepared = Prepared::new(&case).unwrap_or_else(|error| panic!("{error}"));
    let parts: Vec<&str> = prepared.model.parts.iter().map(|part| part.name.as_str()).collect();
    assert_eq!(parts, ["Eall_1", "Eall_2"]);
    assert_eq!(case.tie.len(), 1);
}
