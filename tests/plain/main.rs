//! Tests that call the library or read its sources.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/python.rs"]
mod python;

mod architecture;
mod belt;
mod bounds;
mod circles;
mod closed_forms;
mod constraints;
mod contact;
mod curved;
mod elements;
mod equations;
mod export;
mod import;
mod joined;
mod kinds;
mod matrices;
mod measured;
mod meshes;
mod mindlin;
mod plates;
mod pressure;
mod properties;
mod rig;
mod rotation;
mod schema;
mod shell_pressure;
mod solids;
mod stick_slip;
mod sticking;
mod supply;
