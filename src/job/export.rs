//! Any case as matrices: M, C, K in MatrixMarket files, what each row is, the contact points, and a case that takes them.

use super::imported::direction_text;
use super::prepared::Prepared;
use super::pressed;
use crate::case::{
    BristleChoice, CalibrateAnalysis, Case, ContactPoints, ContactState, InitialGap, Matrices, SQUEAL, Slide,
    SlidingChoice, TransientAnalysis, path_matches,
};
use crate::dynamics::Interface;
use crate::equilibrium::{solve_steady, tangent_stiffness};
use crate::error::Result;
use crate::error::read::read_bytes;
use crate::linalg::SparseMatrix;
use crate::linalg::matrix_market::to_text;
use crate::linalg::sparse::{add_scaled, entry};
use crate::results::{FileNames, FolderLock, write_atomically};
use crate::system::{ConstantMatrices, ContactPair, FrictionAtRest, Structure, System};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

/// How an exported case has its contacts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ContactAs {
    /// `contact_NAME.csv`, with the laws in the case: M, C and K are those of the structure.
    Points,
    /// Terms of C and K, linearised at steady sliding: M, C and K are those of small motions about it.
    Matrices,
}

/// Writes `mass.mtx`, `stiffness.mtx`, `damping.mtx` and `load.mtx` (when there are any), `dofs.csv`, `contact_NAME.csv` of each pair
/// and `case.toml` into the folder `out`, with the files of what was measured as `measured_NAME`. That case gives the same
/// eigenvalues as the one it came from.
///
/// Loss factors are the imaginary part of the stiffness. Modal damping stays a key of the case, and no part of C. What depends on the
/// state (the stiffness of the preload, but in the matrices of small motions) and what asks for a part, a region or a scalar that matrices do not have is left out;
/// the returned sentences say so.
///
/// # Errors
/// Faults of the case, no steady sliding where it is asked for, or a folder that cannot be written.
pub fn export(case: &Case, contact: ContactAs, out: &Path) -> Result<Vec<String>> {
    let prepared = Prepared::new(case)?;
    let lock = FolderLock::take(out)?;
    let left_out = write_all(&prepared, contact, out);
    lock.remove(out);
    left_out
}

/// Writes what [`export`] does.
fn write_all(prepared: &Prepared, contact: ContactAs, out: &Path) -> Result<Vec<String>> {
    let case = prepared.case;
    let system = &prepared.system;
    let linearised = contact == ContactAs::Matrices;
    let ConstantMatrices { mass, damping, stiffness, loss } =
        if linearised { small_motions(prepared)? } else { system.constant_matrices()? };
    let write = |name: &str, text: String| write_atomically(out, name, text.as_bytes());
    let title = &case.title;
    write("mass.mtx", to_text(&mass, None, &format!("{title}: mass [kg, kg m2]")))?;
    let comment = format!("{title}: stiffness [N/m, N m]");
    match &loss {
        Some(h) => {
            let (re, im) =
                (add_scaled(&[(1.0, &stiffness), (0.0, h)]), add_scaled(&[(0.0, &stiffness), (1.0, h)]));
            write("stiffness.mtx", to_text(&re, Some(&im), &comment))?;
        }
        None => write("stiffness.mtx", to_text(&stiffness, None, &comment))?,
    }
    if let Some(damping) = &damping {
        write("damping.mtx", to_text(damping, None, &format!("{title}: damping [N s/m, N m s]")))?;
    }
    let load = column(&system.load).filter(|_| !linearised && system.load.iter().any(|f| *f != 0.0));
    if let Some(load) = &load {
        write("load.mtx", to_text(load, None, &format!("{title}: external force [N, N m]")))?;
    }
    write("dofs.csv", dofs(prepared))?;
    let points_files = points_files(prepared);
    for pair in system.pairs.iter().filter(|_| !linearised) {
        write(&points_files[&pair.name], points(pair))?;
    }
    let matrices = Matrices {
        mass: "mass.mtx".into(),
        stiffness: "stiffness.mtx".into(),
        damping: damping.map(|_| "damping.mtx".into()),
        load: load.map(|_| "load.mtx".into()),
        dofs: Some("dofs.csv".into()),
        scalar: BTreeMap::new(),
        term: BTreeMap::new(),
    };
    let mut left_out = Vec::new();
    if case.prestress && !linearised {
        left_out
            .push("The geometric stiffness of the preload is not part of the exported stiffness".to_string());
    }
    let mut exported = as_matrices(case, matrices, (&system.pairs, &points_files));
    if linearised {
        exported.contact.clear();
        left_out.extend(exported.transient.take().map(|_| gone("transient", "the laws of its contacts")));
        keep(&mut exported.modes, &mut left_out, ("modes", "its closed contacts"), |modes| {
            modes.contact == ContactState::Open
        });
        if case.damping.modal_ratio != 0.0 || !case.damping.modal_ratios.is_empty() {
            left_out.push(
                "The ratios of [damping] are no part of the exported C: the exported case gives them to the modes of its matrices, whose contacts \
                 are closed, not to those of the structure alone, and its eigenvalues differ by that"
                    .to_string(),
            );
        }
    }
    left_out.extend(keep_what_is_there(case, &mut exported));
    let mut names = FileNames::default();
    for (name, data) in &mut exported.measured {
        let Some(file) = &mut data.file else { continue };
        let path = case.folder.join(&*file);
        let kind = path.extension().unwrap_or_default().to_string_lossy();
        let own = format!("measured_{}.{kind}", names.next(name));
        write_atomically(out, &own, &read_bytes(&path, "a file of measured data")?)?;
        *file = own;
    }
    write("case.toml", exported.to_toml())?;
    Ok(left_out)
}

/// M, C and K of small motions about steady sliding: with K_σ of the preload, and K_c and C_c of the contacts.
fn small_motions(prepared: &Prepared) -> Result<ConstantMatrices> {
    pressed::check(prepared)?;
    let system = &prepared.system;
    let steady = solve_steady(system, &prepared.steady_options(), &())?;
    let tangent = tangent_stiffness(system, &steady.displacement)?.into_owned();
    let structure = Structure { stiffness: tangent.into(), ..system.structure.clone() };
    let own = System { structure, ..system.clone() }.constant_matrices()?;
    // What is imported is in `own`.
    let contacts = System { coupling: None, ..system.clone() };
    let [contact_stiffness, contact_damping] = Interface::new(&contacts, &steady).assembled(system.n_dofs());
    let stiffness = add_scaled(&[(1.0, &own.stiffness), (1.0, &contact_stiffness)]);
    let damping = match &own.damping {
        Some(damping) => Some(add_scaled(&[(1.0, damping), (1.0, &contact_damping)])),
        None => (contact_damping.compute_nnz() > 0).then_some(contact_damping),
    };
    Ok(ConstantMatrices { stiffness, damping, ..own })
}

/// A vector as a matrix of one column.
fn column(vector: &[f64]) -> Option<SparseMatrix> {
    let entries: Vec<_> = vector.iter().enumerate().filter(|(_, v)| **v != 0.0).collect();
    let triplets: Vec<_> = entries.iter().map(|(i, v)| entry(*i, 0, **v)).collect();
    SparseMatrix::try_new_from_triplets(vector.len(), 1, &triplets).ok()
}

/// The file of the points of each pair, by its name.
fn points_files(prepared: &Prepared) -> BTreeMap<String, String> {
    let mut names = FileNames::default();
    let file = |pair: &ContactPair| (pair.name.clone(), format!("contact_{}.csv", names.next(&pair.name)));
    prepared.system.pairs.iter().map(file).collect()
}

/// The same analyses of the matrices. Contact points come with their own sliding directions and speeds.
fn as_matrices(
    case: &Case,
    matrices: Matrices,
    (pairs, points_files): (&[ContactPair], &BTreeMap<String, String>),
) -> Case {
    let mut exported = Case { matrices: Some(matrices), prestress: false, ..case.without_structure() };
    for pair in pairs {
        let Some(contact) = exported.contact.get_mut(&pair.name) else { continue };
        contact.points = points_files.get(&pair.name).cloned().map(ContactPoints::File);
        (contact.body, contact.counter) = (String::new(), String::new());
        (contact.into, contact.placement, contact.stroke) = (None, None, 0.0);
        contact.initial_gap = InitialGap::Geometry;
        if let SlidingChoice::About { .. } = contact.sliding {
            let (sliding_velocity, sliding_direction) = (pair.sliding_velocity, [1.0, 0.0, 0.0]);
            contact.sliding = SlidingChoice::Along { sliding_velocity, sliding_direction };
        }
        // Of points no default is elastic while they slide.
        if contact.bristle.is_none() && pair.law.at_rest() == FrictionAtRest::Elastic && !pair.sticks() {
            let (stiffness, per) = (contact.normal.stiffness, contact.normal.per);
            contact.bristle = Some(BristleChoice { stiffness, damping: 0.0, per, slides: true });
        }
    }
    exported
}

/// Leaves out the analyses of parts and regions of `case`, what was measured of those, and the questions about scalars that are no
/// longer there; gives a sentence for each.
fn keep_what_is_there(case: &Case, exported: &mut Case) -> Vec<String> {
    let mut left_out = Vec::new();
    let out = &mut left_out;
    keep(&mut exported.modes, out, ("modes", "its parts or supports"), |modes| {
        modes.parts.is_empty() && modes.clamp.is_empty() && !modes.free
    });
    keep(&mut exported.frf, out, ("frf", "its regions"), |frf| {
        std::iter::once(&frf.excitation).chain(frf.response.values()).all(|place| place.on.is_none())
    });
    let (modes, frfs) = (&exported.modes, &exported.frf);
    keep(&mut exported.measured, out, ("measured", "the analysis that it is of"), |measured| {
        measured.of.as_ref().is_none_or(|of| modes.contains_key(of))
            && measured.frf.as_ref().is_none_or(|frf| frfs.contains_key(frf))
    });
    if exported.transient.as_ref().is_some_and(|transient| !moves_alike(case, transient)) {
        exported.transient = None;
        out.push(gone("transient", "what pushes, loads or carries it"));
    }
    if let Some(transient) = &mut exported.transient {
        keep(&mut transient.probe, out, ("transient.probe", "its region or spring"), |p| p.at.is_some());
        if transient.sound.take().is_some() {
            out.push(gone("transient.sound", "its plates"));
        }
        if transient.fields_every.take().is_some() {
            out.push(gone("transient.fields_every", "its mesh"));
        }
    }
    let bare = exported.without_studies();
    let known = |path: &String| bare.parameter(path).is_ok();
    keep(&mut exported.sweep, out, ("sweep", "its scalar"), |sweep| known(&sweep.parameter));
    keep(&mut exported.map, out, ("map", "its scalars"), |map| map.parameters.iter().all(known));
    keep(&mut exported.uncertainty, out, ("uncertainty", "its scalars"), |study| {
        study.parameter.values().flat_map(|parameter| &parameter.path).all(known)
    });
    if let Some(sensitivity) = &mut exported.sensitivity {
        let scalars = bare.parameters();
        sensitivity.parameters.retain(|pattern| {
            let holds = scalars.iter().any(|scalar| path_matches(pattern, &scalar.path));
            if !holds {
                left_out.push(format!(
                    "`{pattern}` of [sensitivity] is left out: no scalar of the exported case"
                ));
            }
            holds
        });
    }
    let names =
        |name: &String| name == SQUEAL || bare.modes.contains_key(name) || bare.measured.contains_key(name);
    let calibrates = |calibrate: &CalibrateAnalysis| {
        calibrate.against.iter().all(names) && calibrate.parameter.values().all(|p| p.path.iter().all(known))
    };
    if exported.calibrate.as_ref().is_some_and(|calibrate| !calibrates(calibrate)) {
        exported.calibrate = None;
        left_out.push(gone("calibrate", "its scalars, or what it is against"));
    }
    left_out
}

/// Whether the motion in time of `case` is the same where there are no regions, no forces of its own and no mesh to slide over.
fn moves_alike(case: &Case, transient: &TransientAnalysis) -> bool {
    let carried = |(name, slide): (&String, &Slide)| slide.travels && case.contact[name].counter != "ground";
    transient.push.is_empty()
        && transient.load.keys().all(|name| case.contact.contains_key(name))
        && !transient.slide.iter().any(carried)
}

/// Keeps the tables `[kind.NAME]` that hold.
fn keep<T>(
    tables: &mut BTreeMap<String, T>,
    left_out: &mut Vec<String>,
    (kind, lacks): (&str, &str),
    holds: impl Fn(&T) -> bool,
) {
    tables.retain(|name, table| {
        let holds = holds(table);
        if !holds {
            left_out.push(gone(&format!("{kind}.{name}"), lacks));
        }
        holds
    });
}

fn gone(table: &str, lacks: &str) -> String {
    format!("[{table}] is left out: the exported case does not have {lacks}")
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
    let mut text = String::from("normal,t1,t2,weight,gap,speed,x,y,z\n");
    for point in &*pair.points {
        let [t1, t2] = &point.tangents;
        let [x, y, z] = point.position;
        let directions = [&point.normal, t1, t2].map(direction_text).join(",");
        let _ = writeln!(text, "{directions},{},{},{},{x},{y},{z}", point.weight, point.gap, point.speed);
    }
    text
}
