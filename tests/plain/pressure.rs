//! `[force.NAME]` with a `pressure` on faces of solids; those of shells: `shell_pressure.rs`.

use stridor::bounds::{Origin::*, within};
use stridor::case::Case;
use stridor::equilibrium::{SteadyOptions, solve_steady};
use stridor::job::Prepared;
use stridor::mesh::generate::structured_box;
use stridor::mesh::{CellKind, Mesh, write};

const E: f64 = 2e11;
const NU: f64 = 0.3;

fn with<T>(mesh: &Mesh, tables: &str, see: impl Fn(Result<Prepared<'_>, String>) -> T) -> T {
    let dir = tempfile::tempdir().unwrap();
    write(&dir.path().join("a.msh"), mesh, 1.0).unwrap();
    let text = format!(
        "[mesh]\nfile = \"a.msh\"\nunit = \"m\"\n[material.steel]\nyoungs_modulus = {E}\npoissons_ratio = {NU}\n\
         density = 7850\n[solid.block]\nmaterial = \"steel\"\n[modes.all]\ncount = 1\n{tables}"
    );
    match Case::parse("a.toml", &text, dir.path().into()) {
        Ok(case) => see(Prepared::new(&case).map_err(|error| error.to_string())),
        Err(error) => see(Err(error.to_string())),
    }
}

fn block(kind: CellKind) -> Mesh {
    let mut mesh = structured_box(kind, [0.03, 0.02, 0.01], [2, 3, 2]).unwrap();
    mesh.regions.iter_mut().filter(|r| r.dimension == 3).for_each(|r| r.name = "block".into());
    mesh
}

/// Goal: the uniform stress −p, u = (ν p x/E, ν p y/E, −p z/E), on every kind, which nodes with equal forces do not give.
#[test]
fn a_pressure_is_consistent_on_faces_of_every_kind() {
    let (p, held) = (3e6, [("x_min", "ux"), ("y_min", "uy"), ("z_min", "uz")]);
    let supports: String =
        held.iter().map(|(on, dof)| format!("[support.{on}]\non = \"{on}\"\nheld = [\"{dof}\"]\n")).collect();
    for kind in [CellKind::Tetrahedron10, CellKind::Hexahedron8, CellKind::Hexahedron20, CellKind::Wedge15] {
        let off = |push: &str| {
            with(&block(kind), &format!("{supports}[force.top]\non = \"z_max\"\n{push}\n"), |prepared| {
                let prepared = prepared.unwrap();
                let steady = solve_steady(&prepared.system, &SteadyOptions::default(), &()).unwrap();
                let u = prepared.assembled.dofs.expand(&steady.displacement);
                let exact = |x: &[f64; 3]| [NU * p * x[0] / E, NU * p * x[1] / E, -p * x[2] / E];
                let off = |(x, u): (&[f64; 3], &[f64; 6])| {
                    (0..3).map(|k| (u[k] - exact(x)[k]).abs()).fold(0.0, f64::max)
                };
                prepared.model.nodes.iter().zip(&u).map(off).fold(0.0, f64::max) / (p * 0.01 / E)
            })
        };
        let pressed = off(&format!("pressure = {p}"));
        assert!(within(pressed, 1e-11, RoundOff), "{kind:?}: {pressed:e}");
        // Of 8-node hexahedra equal forces are wrong at the edges, of others everywhere.
        let equal_forces = off(&format!("force = [0, 0, {}]", -p * 6e-4));
        assert!(equal_forces > 1e-2, "{kind:?}");
    }
}

#[test]
fn a_pressure_needs_faces() {
    let fault =
        |tables: &str| with(&block(CellKind::Hexahedron8), tables, |prepared| prepared.err().unwrap());
    let clamp = "[support.a]\non = \"x_min\"\n";
    for (push, expected) in [
        ("on = \"block\"\npressure = 1", "not one of faces of a shell or on the skin of a solid"),
        ("on = \"z_mox\"\npressure = 1", "Did you mean \"z_max\""),
        ("on = \"z_max\"\npressure = \"1 N\"", "another dimension"),
        ("on = \"z_max\"\npressure = 1\nforce = [0, 0, 1]", "both `force` and `pressure`"),
        ("on = \"z_max\"", "three forces such as"),
    ] {
        let error = fault(&format!("{clamp}[force.top]\n{push}\n"));
        assert!(error.contains(expected) && error.contains("force.top"), "{expected} not in {error}");
    }
}
