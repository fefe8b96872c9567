//! Tests that run the program: its command line, wrong inputs, limits of the machine, kills, several processes at once.

#[path = "../common/program.rs"]
mod program;
#[path = "../common/python.rs"]
mod python;
#[path = "../common/small_rig.rs"]
mod small_rig;
#[path = "../common/sweeps.rs"]
mod sweeps;

mod command_line;
mod export;
mod extremes;
#[cfg(target_os = "linux")]
mod faults;
mod guide;
mod killed;
mod limits;
mod motion;
mod mutated_cases;
mod parts;
mod preload;
mod terminal;
mod unanswered;
mod uncertainty;
mod wrong_inputs;
mod xarray;
