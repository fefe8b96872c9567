//! Real modes of a free steel plate of 200 mm by 100 mm and 2 mm: `cargo run --release --example plate_modes`.

use stridor::mesh::generate::{Faces, structured_plate};
use stridor::modal::{ModesWanted, real_modes};
use stridor::structure::{Material, Model, Part, Shell, assemble};

fn main() -> stridor::error::Result<()> {
    let steel =
        Material { youngs_modulus: 210e9, poissons_ratio: 0.3, density: 7850.0, ..Material::default() };
    let mesh = structured_plate(0.2, 0.1, 32, 16, Faces::Triangles)?;
    let plate = Part::new("plate", mesh.faces("plate")?, Shell::new(steel, 2e-3));
    let model = Model { nodes: mesh.nodes, parts: vec![plate], ..Model::default() };
    let modes = real_modes(&assemble(&model)?.structure, ModesWanted::BelowHz(1500.0))?;
    let elastic: Vec<f64> = (0..modes.len()).map(|k| modes.frequency_hz(k)).filter(|hz| *hz > 1.0).collect();
    println!("Hz: {elastic:.1?}");
    // Six rigid motions, and by Sturm's count no mode is missing.
    assert!(modes.len() - elastic.len() == 6 && modes.certificate.holds());
    Ok(())
}

#[test]
fn it_runs() {
    main().unwrap();
}
