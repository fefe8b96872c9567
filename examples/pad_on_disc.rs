//! Squeal of a pad on a disc without a case file, with a friction law of one's own:
//! `cargo run --release --example pad_on_disc`.

use std::sync::Arc;
use stridor::contact::{
    Coefficient, ContactSide, FrictionCoefficient, NormalLaw, Sliding, SlidingLaw, Surfaces, pair_surfaces,
};
use stridor::equilibrium::steady_sliding;
use stridor::modal::{ModesWanted, real_modes};
use stridor::stability::complex_eigenvalues;
use stridor::structure::{Material, Model, Part, RayleighDamping, Shell, Spring, Support, assemble};
use stridor::system::{Closing, ContactPair, System};

/// μ(v) = 0.6 − 0.2 tanh(v/(1 m/s)): falls with speed, to 0.4.
#[derive(Debug)]
struct Falling;

impl FrictionCoefficient for Falling {
    fn mu(&self, speed: f64, _pressure: f64) -> Coefficient {
        let tanh = speed.tanh();
        Coefficient { value: 0.6 - 0.2 * tanh, by_speed: -0.2 * (1.0 - tanh * tanh), by_pressure: 0.0 }
    }
}

fn main() -> stridor::error::Result<()> {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes/pad-on-disc.msh");
    let mesh = stridor::mesh::read(&path, 1e-3)?;
    let rayleigh = RayleighDamping { alpha: 1.0, beta: 0.0 };
    let steel = Material {
        youngs_modulus: 210e9,
        poissons_ratio: 0.3,
        density: 7850.0,
        rayleigh,
        ..Material::default()
    };
    let lining =
        Material { youngs_modulus: 8e9, poissons_ratio: 0.25, density: 2500.0, ..Material::default() };
    let disc = Part::new("disc", mesh.faces("disc")?, Shell::new(steel, 1e-3));
    let pad = Part::new("pad", mesh.faces("pad")?, Shell::new(lining, 5e-3));
    let pad_nodes = mesh.region_nodes(mesh.require("pad", 2)?);
    let stiffness = 20e6 / pad_nodes.len() as f64;
    let held = |node: &usize, direction| Spring {
        node: *node,
        other: None,
        direction,
        rotational: false,
        stiffness,
        damping: 0.0,
    };
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let model = Model {
        springs: pad_nodes.iter().flat_map(|node| axes.map(|direction| held(node, direction))).collect(),
        supports: vec![Support { nodes: mesh.region_nodes(mesh.require("hub", 1)?), held: [true; 6] }],
        nodes: mesh.nodes,
        parts: vec![disc, pad],
        ..Model::default()
    };
    let assembled = assemble(&model)?;
    let [disc, pad] = [&model.parts[0], &model.parts[1]];
    let (side, sliding) = (ContactSide::Face(&pad.cells), Sliding::Along([0.0, 1.0, 0.0]));
    let surfaces = Surfaces::new("face", &model.nodes, [pad, disc], side, sliding);
    let pair = ContactPair {
        name: "face".into(),
        points: pair_surfaces(&surfaces, &|entries| assembled.dofs.reduce(entries))?.into(),
        law: Arc::new(SlidingLaw::new(NormalLaw::linear(100e9), Falling, 0.0)),
        closing: Closing::Load(500.0),
        sliding_velocity: 0.2,
    };
    let system = System::new(assembled.structure, vec![pair]);
    let steady = steady_sliding(&system)?;
    let real = real_modes(&system.structure, ModesWanted::BelowHz(9e3))?;
    let found = complex_eigenvalues(&system, &steady, &real, [0.0, 6e3])?;
    for mode in found.modes.iter().filter(|mode| mode.unstable()) {
        println!("unstable: {:.1} Hz, growth rate {:.1} 1/s", mode.frequency_hz(), mode.growth_rate());
    }
    assert!(found.modes.iter().all(|mode| mode.accepted()));
    assert!(found.modes.iter().any(|mode| mode.unstable()));
    Ok(())
}

#[test]
fn it_runs() {
    main().unwrap();
}
