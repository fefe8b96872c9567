//! The committed meshes of `meshes/` are sound and are those of the built-in generator.

use std::path::Path;
use stridor::bounds::{Origin::*, within};
use stridor::mesh::generate::{PadOnDiscSpec, RigSpec, disc_brake, pad_on_disc, rig, solid_brake};
use stridor::mesh::{Mesh, diagnose_apart, read};

fn stored(name: &str) -> Mesh {
    read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes").join(name), 0.001).unwrap()
}

fn committed(name: &str) -> Mesh {
    let mesh = stored(name);
    let diagnosis = diagnose_apart(&mesh, &[["pad_face", "disc_face"]], Default::default());
    assert!(diagnosis.warnings.is_empty(), "{name}: {:?}", diagnosis.warnings);
    mesh
}

/// Same regions, same number of nodes, every node within a nanometre of a generated one. (Another machine's sine may
/// differ in the last bit and turn a diagonal, so elements are not compared one by one.)
fn same(committed: &Mesh, generated: &Mesh) {
    let names =
        |mesh: &Mesh| mesh.regions.iter().map(|r| (r.name.clone(), r.elements.len())).collect::<Vec<_>>();
    assert_eq!(names(committed), names(generated));
    assert_eq!(committed.nodes.len(), generated.nodes.len());
    for (p, q) in committed.nodes.iter().zip(&generated.nodes) {
        assert!((0..3).all(|k| within((p[k] - q[k]).abs(), 1e-9, Reference)), "{p:?} {q:?}");
    }
}

#[test]
fn committed_meshes_are_those_of_the_generator() {
    same(&committed("rig-small.msh"), &rig(&RigSpec::small()).unwrap());
    same(&committed("rig-medium.msh"), &rig(&RigSpec::medium()).unwrap());
    same(&committed("pad-on-disc.msh"), &pad_on_disc(&PadOnDiscSpec::example()).unwrap());
    same(&committed("solid-brake.msh"), &solid_brake().unwrap());
    same(&stored("disc-brake.msh"), &disc_brake().unwrap());
}
