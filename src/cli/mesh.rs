//! `stridor mesh`: generators and a look inside a mesh file.

use super::output::{Common, SUCCESS, say};
use crate::error::{Error, Fault, Result};
use crate::mesh::generate::{self, BarSide, BarSpec, DiscSpec, Grading, PlateSpec, RigSpec};
use crate::mesh::{self, Info, Mesh};
use crate::schema::units::{LENGTH, parse_quantity};
use clap::{Args, Subcommand};
use std::path::{Path, PathBuf};

#[derive(Subcommand)]
pub enum MeshAction {
    /// A disc or an annulus: regions disc, rim, hub
    Disc(DiscOptions),
    /// A rectangular plate: regions slider, slider_edge_x_min, …
    Plate(PlateOptions),
    /// Disc, bar and slider in one mesh
    Rig(RigOptions),
    /// Contents of a mesh file, and its faults
    Info(InfoOptions),
}

/// Element sizes and where the mesh goes.
#[derive(Args)]
pub struct Output {
    /// The file to write (Gmsh 4.1, in millimetres)
    #[arg(long, short, value_name = "FILE")]
    out: PathBuf,
    /// Overwrite an existing file
    #[arg(long)]
    force: bool,
}

/// Where the mesh is fine: about the lowest rim point of a disc, about the contact's position on a plate.
#[derive(Args)]
pub struct Fine {
    /// Element size at the contact
    #[arg(long, default_value = "0.4 mm", value_parser = length, allow_hyphen_values = true)]
    contact_size: f64,
    /// Distance from the contact within which elements stay fine
    #[arg(long, default_value = "2 mm", value_parser = length, allow_hyphen_values = true)]
    contact_radius: f64,
}

impl Fine {
    /// Elements of `coarse` size away from the contact.
    fn grading(&self, coarse: f64) -> Grading {
        Grading::graded(self.contact_size, self.contact_radius, coarse)
    }
}

#[derive(Args)]
pub struct DiscOptions {
    #[command(flatten)]
    output: Output,
    /// Outer radius
    #[arg(long, default_value = "75 mm", value_parser = length, allow_hyphen_values = true)]
    outer_radius: f64,
    /// Radius of the hub; 0 for a full disc
    #[arg(long, default_value = "20 mm", value_parser = length, allow_hyphen_values = true)]
    hub_radius: f64,
    /// Element size away from the contact
    #[arg(long, default_value = "3 mm", value_parser = length, allow_hyphen_values = true)]
    size: f64,
    #[command(flatten)]
    fine: Fine,
}

#[derive(Args)]
pub struct PlateOptions {
    #[command(flatten)]
    output: Output,
    /// Length along x
    #[arg(long, default_value = "200 mm", value_parser = length, allow_hyphen_values = true)]
    length: f64,
    /// Width along y
    #[arg(long, default_value = "120 mm", value_parser = length, allow_hyphen_values = true)]
    width: f64,
    /// Position of the contact along x, from the middle
    #[arg(long, default_value = "0", value_parser = length, allow_hyphen_values = true)]
    contact_x: f64,
    /// Position of the contact along y, from the middle
    #[arg(long, default_value = "0", value_parser = length, allow_hyphen_values = true)]
    contact_y: f64,
    /// Element size away from the contact
    #[arg(long, default_value = "8 mm", value_parser = length, allow_hyphen_values = true)]
    size: f64,
    #[command(flatten)]
    fine: Fine,
}

#[derive(Args)]
pub struct RigOptions {
    #[command(flatten)]
    output: Output,
    /// Outer radius of the disc
    #[arg(long, default_value = "75 mm", value_parser = length, allow_hyphen_values = true)]
    outer_radius: f64,
    /// Radius of the hub
    #[arg(long, default_value = "20.75 mm", value_parser = length, allow_hyphen_values = true)]
    hub_radius: f64,
    /// Length of the bar from the hub to the clamp; negative for a bar along +x
    #[arg(long, default_value = "75 mm", value_parser = length, allow_hyphen_values = true)]
    bar_length: f64,
    /// Elements of the bar
    #[arg(long, default_value_t = 10)]
    bar_elements: usize,
    /// Length of the slider along x
    #[arg(long, default_value = "200 mm", value_parser = length, allow_hyphen_values = true)]
    slider_length: f64,
    /// Width of the slider along y
    #[arg(long, default_value = "120 mm", value_parser = length, allow_hyphen_values = true)]
    slider_width: f64,
    /// Thickness of the slider
    #[arg(long, default_value = "10 mm", value_parser = length, allow_hyphen_values = true)]
    slider_thickness: f64,
    /// Element size of the disc away from the contact
    #[arg(long, default_value = "3 mm", value_parser = length, allow_hyphen_values = true)]
    disc_size: f64,
    /// Element size of the slider away from the contact
    #[arg(long, default_value = "8 mm", value_parser = length, allow_hyphen_values = true)]
    slider_size: f64,
    #[command(flatten)]
    fine: Fine,
    /// Position of the contact on the slider along x, from its middle
    #[arg(long, default_value = "0", value_parser = length, allow_hyphen_values = true)]
    contact_x: f64,
    /// Position of the contact on the slider along y, from its middle
    #[arg(long, default_value = "0", value_parser = length, allow_hyphen_values = true)]
    contact_y: f64,
}

#[derive(Args)]
pub struct InfoOptions {
    /// The mesh file
    file: PathBuf,
    /// Its unit of length
    #[arg(long, default_value = "mm", value_parser = ["m", "cm", "mm", "in"])]
    unit: String,
}

/// A length with its unit; zero needs none.
fn length(text: &str) -> std::result::Result<f64, String> {
    let text = if text.trim() == "0" { "0 m" } else { text };
    parse_quantity(text, LENGTH).map_err(|found| format!("found {found}; expected {}", LENGTH.name))
}

pub fn run(action: &MeshAction, common: &Common) -> Result<u8> {
    match action {
        MeshAction::Info(options) => return info(options, common),
        MeshAction::Disc(o) => {
            let grading = o.fine.grading(o.size);
            let spec = DiscSpec { outer_radius: o.outer_radius, hub_radius: o.hub_radius, grading };
            write(&generate::disc(&spec)?, &o.output, common)?;
        }
        MeshAction::Plate(o) => {
            let grading = o.fine.grading(o.size);
            let contact = [o.contact_x, o.contact_y];
            let spec = PlateSpec { length: o.length, width: o.width, contact, grading };
            write(&generate::plate(&spec)?, &o.output, common)?;
        }
        MeshAction::Rig(o) => write(&generate::rig(&rig_spec(o))?, &o.output, common)?,
    }
    Ok(SUCCESS)
}

fn rig_spec(o: &RigOptions) -> RigSpec {
    RigSpec {
        disc: DiscSpec {
            outer_radius: o.outer_radius,
            hub_radius: o.hub_radius,
            grading: o.fine.grading(o.disc_size),
        },
        bar: BarSpec {
            length: o.bar_length.abs(),
            elements: o.bar_elements,
            side: if o.bar_length < 0.0 { BarSide::Plus } else { BarSide::Minus },
        },
        slider: PlateSpec {
            length: o.slider_length,
            width: o.slider_width,
            contact: [o.contact_x, o.contact_y],
            grading: o.fine.grading(o.slider_size),
        },
        slider_thickness: o.slider_thickness,
    }
}

fn write(mesh: &Mesh, output: &Output, common: &Common) -> Result<()> {
    if !output.force {
        refuse_existing(&output.out, "`--force` overwrites it")?;
    }
    mesh::write(&output.out, mesh, 1e-3)?;
    if !common.quiet {
        say(format!("{}\nwritten to {} in millimetres", Info::of(mesh), output.out.display()))?;
    }
    Ok(())
}

/// Refuses to overwrite an existing file; `help` is the corrective action.
pub(super) fn refuse_existing(path: &Path, help: &str) -> Result<()> {
    if path.exists() {
        let fault = Fault::new(path.display().to_string(), "something there already", "a new name");
        return Err(Error::input(fault.with_help(help)));
    }
    Ok(())
}

fn info(options: &InfoOptions, common: &Common) -> Result<u8> {
    let mesh = mesh::read(&options.file, mesh::unit_in_metres(&options.unit))?;
    if !common.quiet {
        say(Info::of(&mesh))?;
    }
    mesh::diagnose(&mesh).faults.into_result(())?;
    Ok(SUCCESS)
}
