//! Any case as matrices: M, C, K in MatrixMarket files, what each row is, the contact points, and a case that takes them.

use super::imported::direction_text;
use super::prepared::Prepared;
use crate::case::{Case, ContactPoints, Matrices};
use crate::error::Result;
use crate::linalg::SparseMatrix;
use crate::linalg::matrix_market::to_text;
use crate::linalg::sparse::add_scaled;
use crate::results::write_atomically;
use crate::system::ContactPair;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

/// Writes `mass.mtx`, `stiffness.mtx`, `damping.mtx` and `load.mtx` (when there are any), `dofs.csv`, `contact_NAME.csv` of each pair
/// and `case.toml` into the folder `out`. That case gives the same eigenvalues as the one it came from.
///
/// Loss factors are the imaginary part of the stiffness. Modal damping stays a key of the case. What depends on the
/// state (the stiffness of the preload) and real modes of parts are left out; the returned sentences say so.
///
/// # Errors
/// Faults of the case, or a folder that cannot be written.
pub fn export(case: &Case, out: &Path) -> Result<Vec<String>> {
    let prepared = Prepared::new(case)?;
    let (system, structure) = (&prepared.system, &prepared.system.structure);
    let rest = system.coupling.as_ref().map(|c| c.assembled(system.n_dofs())).transpose()?;
    let whole = |symmetric: &SparseMatrix, which: usize| match &rest {
        Some(rest) => add_scaled(&[(1.0, symmetric), (1.0, &rest[which])]),
        None => symmetric.clone(),
    };
    let write = |name: &str, text: String| write_atomically(out, name, text.as_bytes());
    let title = &case.title;
    write("mass.mtx", to_text(&structure.mass, None, &format!("{title}: mass [kg, kg m2]")))?;
    let stiffness = whole(&structure.stiffness, 0);
    let comment = format!("{title}: stiffness [N/m, N m]");
    match &structure.damping.hysteretic {
        Some(h) => {
            let (re, im) =
                (add_scaled(&[(1.0, &stiffness), (0.0, h)]), add_scaled(&[(0.0, &stiffness), (1.0, h)]));
            write("stiffness.mtx", to_text(&re, Some(&im), &comment))?;
        }
        None => write("stiffness.mtx", to_text(&stiffness, None, &comment))?,
    }
    let damping = match (&structure.damping.viscous, &rest) {
        (Some(viscous), _) => Some(whole(viscous, 1)),
        (None, Some(rest)) => Some(rest[1].clone()),
        (None, None) => None,
    };
    if let Some(damping) = &damping {
        write("damping.mtx", to_text(damping, None, &format!("{title}: damping [N s/m, N m s]")))?;
    }
    let load = column(&system.load).filter(|_| system.load.iter().any(|f| *f != 0.0));
    if let Some(load) = &load {
        write("load.mtx", to_text(load, None, &format!("{title}: external force [N, N m]")))?;
    }
    write("dofs.csv", dofs(&prepared))?;
    for pair in &system.pairs {
        write(&points_file(&pair.name), points(pair))?;
    }
    let matrices = Matrices {
        mass: "mass.mtx".into(),
        stiffness: "stiffness.mtx".into(),
        damping: damping.map(|_| "damping.mtx".into()),
        load: load.map(|_| "load.mtx".into()),
        dofs: Some("dofs.csv".into()),
        term: BTreeMap::new(),
    };
    write("case.toml", as_matrices(case, matrices).to_toml())?;
    let mut left_out = Vec::new();
    if case.prestress {
        left_out
            .push("The geometric stiffness of the preload is not part of the exported stiffness".to_string());
    }
    if case.modes.values().any(|m| !m.parts.is_empty() || !m.clamp.is_empty() || m.free) {
        left_out.push(
            "Real modes of single parts are not exported: the matrices are those of the whole".to_string(),
        );
    }
    Ok(left_out)
}

/// A vector as a matrix of one column.
fn column(vector: &[f64]) -> Option<SparseMatrix> {
    let entries: Vec<_> = vector.iter().enumerate().filter(|(_, v)| **v != 0.0).collect();
    let triplets: Vec<_> = entries.iter().map(|(i, v)| faer::sparse::Triplet::new(*i, 0, **v)).collect();
    SparseMatrix::try_new_from_triplets(vector.len(), 1, &triplets).ok()
}

fn points_file(pair: &str) -> String {
    format!("contact_{pair}.csv")
}

/// The same analyses of the matrices.
fn as_matrices(case: &Case, matrices: Matrices) -> Case {
    let mut exported = Case {
        matrices: Some(matrices),
        mesh: None,
        prestress: false,
        point: BTreeMap::new(),
        material: BTreeMap::new(),
        shell: BTreeMap::new(),
        bar: BTreeMap::new(),
        mass: BTreeMap::new(),
        spring: BTreeMap::new(),
        rigid: BTreeMap::new(),
        support: BTreeMap::new(),
        force: BTreeMap::new(),
        measured: BTreeMap::new(),
        ..case.clone()
    };
    exported.modes.retain(|_, m| m.parts.is_empty() && m.clamp.is_empty() && !m.free);
    for (name, contact) in &mut exported.contact {
        contact.points = Some(ContactPoints::File(points_file(name)));
        (contact.body, contact.counter) = (String::new(), String::new());
        (contact.into, contact.placement, contact.stroke) = (None, None, 0.0);
    }
    exported
}

/// One line a degree of freedom: its number, its node, its motion, where the node is.
fn dofs(prepared: &Prepared) -> String {
    let mut text = String::from("dof,node,ux,uy,uz,rx,ry,rz,x,y,z\n");
    let nodes = prepared.geometry().nodes;
    for (k, dof) in prepared.assembled.dofs.free_dofs().iter().enumerate() {
        let _ = write!(text, "{},{}", k + 1, dof.node + 1);
        let [x, y, z] = nodes[dof.node];
        for value in dof.direction.iter().chain(&[x, y, z]) {
            let _ = write!(text, ",{value}");
        }
        text.push('\n');
    }
    text
}

fn points(pair: &ContactPair) -> String {
    let mut text = String::from("normal,t1,t2,weight,gap,x,y,z\n");
    for point in &pair.points {
        let [t1, t2] = &point.tangents;
        let [x, y, z] = point.position;
        let directions = [&point.normal, t1, t2].map(direction_text).join(",");
        let _ = writeln!(text, "{directions},{},{},{x},{y},{z}", point.weight, point.gap);
    }
    text
}
