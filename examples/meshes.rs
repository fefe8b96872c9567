//! Writes the generated meshes of the folder `meshes/`, in millimetres.

use std::path::Path;
use stridor::mesh::generate::{PadOnDiscSpec, RigSpec, disc_brake, pad_on_disc, rig, solid_brake};
use stridor::mesh::{Info, write};

fn main() -> Result<(), stridor::error::Error> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes");
    for (name, mesh) in [
        ("rig-small.msh", rig(&RigSpec::small())?),
        ("rig-medium.msh", rig(&RigSpec::medium())?),
        ("pad-on-disc.msh", pad_on_disc(&PadOnDiscSpec::example())?),
        ("solid-brake.msh", solid_brake()?),
        ("disc-brake.msh", disc_brake()?),
    ] {
        write(&folder.join(name), &mesh, 0.001)?;
        println!("{name}\n{}", Info::of(&mesh));
    }
    Ok(())
}
