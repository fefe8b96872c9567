//! Templates of `stridor new`: cases of the validation suite, each with the files that it reads.

use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::mesh::generate::{PadOnDiscSpec, RigSpec, disc_brake, pad_on_disc, rig, solid_brake};
use clap::ValueEnum;
use std::path::Path;

/// Template of a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Template {
    /// A disc on a bar that touches a slider with its rim: the reference case
    Rig,
    /// A pad that a piston presses on the face of a disc
    Pad,
    /// A pad of solids on the face of a disc of solids
    Solid,
    /// A disc between two pads in a floating calliper, of solids joined by ties
    Brake,
    /// Two degrees of freedom on a belt, without a mesh
    TwoDof,
    /// Matrices M, C, K of another program, with terms that depend on the speed
    Imported,
    /// The rig on a small mesh in time, to its limit cycle, with the sound that it radiates
    Transient,
    /// A clamped disc beside measured modes and frequency responses from universal files
    Measured,
}

/// Makes a mesh.
type Generator = fn() -> Result<Mesh>;

/// Case file of a template, and its files.
struct Content {
    case: String,
    /// Name and generator of its mesh.
    mesh: Option<(&'static str, Generator)>,
    /// Names and bytes.
    files: &'static [(&'static str, &'static [u8])],
}

macro_rules! suite_files {
    ($folder:literal: $($name:literal),+) => {
        &[$(($name, include_bytes!(concat!("../../validation/", $folder, "/", $name)) as &[u8])),+]
    };
}

/// Microphones for the template in time.
const SOUND: &str = "
# Sound pressure at a microphone in front of the disc, sound power, tones and a WAV file.
[transient.sound]
distance = \"1 m\"
";

impl Template {
    fn content(self) -> Content {
        let meshed = |case: &str, stored: &str, mesh, generate: Generator| Content {
            case: case.replace(&format!("../../meshes/{stored}"), mesh),
            mesh: Some((mesh, generate)),
            files: &[],
        };
        let plain = |case: &str, files| Content { case: case.into(), mesh: None, files };
        match self {
            Template::Rig => {
                let case = include_str!("../../validation/rig/case.toml");
                meshed(case, "rig-medium.msh", "rig.msh", || rig(&RigSpec::medium()))
            }
            Template::Pad => {
                let case = include_str!("../../validation/pad-on-disc/case.toml");
                meshed(case, "pad-on-disc.msh", "pad.msh", || pad_on_disc(&PadOnDiscSpec::example()))
            }
            Template::Solid => {
                let case = include_str!("../../validation/solid-brake/case.toml");
                meshed(case, "solid-brake.msh", "brake.msh", solid_brake)
            }
            Template::Brake => {
                let case = include_str!("../../validation/disc-brake/case.toml");
                meshed(case, "disc-brake.msh", "brake.msh", disc_brake)
            }
            Template::TwoDof => plain(include_str!("../../validation/two-dof/case.toml"), &[]),
            Template::Imported => plain(
                include_str!("../../validation/rotating-matrices/case.toml"),
                suite_files!("rotating-matrices": "m.mtx", "c.mtx", "k.mtx", "gyro.mtx", "geo.mtx", "follower.mtx"),
            ),
            Template::Transient => {
                let case = include_str!("../../validation/rig-limit-cycle/case.toml");
                let content = meshed(case, "rig-small.msh", "rig.msh", || rig(&RigSpec::small()));
                Content { case: content.case + SOUND, ..content }
            }
            Template::Measured => plain(
                include_str!("../../validation/measured-disc/case.toml"),
                suite_files!("measured-disc": "shapes.uff", "text.uff", "binary.uff", "list.csv", "list.toml"),
            ),
        }
    }

    /// Writes `case.toml`, with `first_line` before it, and its files into the folder `dir`.
    ///
    /// # Errors
    /// [`Error::Io`] when a file cannot be written.
    pub fn write(self, dir: &Path, first_line: &str) -> Result<()> {
        let content = self.content();
        if let Some((name, generate)) = content.mesh {
            crate::mesh::write(&dir.join(name), &generate()?, 1e-3)?;
        }
        let case = format!("{first_line}\n{}", content.case);
        for (name, bytes) in content.files.iter().copied().chain([("case.toml", case.as_bytes())]) {
            let file = dir.join(name);
            std::fs::write(&file, bytes)
                .map_err(|error| Error::io(&file, error, "Choose a folder that can be written"))?;
        }
        Ok(())
    }
}
