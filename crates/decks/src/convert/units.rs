//! Systems of units, of which no file states its own.

use stridor_base::error::{Error, Fault, Result, nearest};
use stridor_base::solids::{DENSITY, MODULUS, SPEED};

/// A system of units: the SI value of its units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Units {
    /// Its name on the command line.
    pub name: &'static str,
    /// Its units in words.
    pub words: &'static str,
    /// Of length, as Gmsh files and cases call it.
    pub length_name: &'static str,
    /// \[m\].
    pub length: f64,
    /// \[kg\].
    pub mass: f64,
    /// \[s\].
    pub time: f64,
}

/// All of them.
const SYSTEMS: &[Units] = &[
    Units { name: "m", words: "m, kg, s (N, Pa)", length_name: "m", length: 1.0, mass: 1.0, time: 1.0 },
    Units { name: "mm", words: "mm, t, s (N, MPa)", length_name: "mm", length: 1e-3, mass: 1e3, time: 1.0 },
    Units {
        name: "mm-kg",
        words: "mm, kg, s (mN, kPa)",
        length_name: "mm",
        length: 1e-3,
        mass: 1.0,
        time: 1.0,
    },
    Units {
        name: "mm-kg-ms",
        words: "mm, kg, ms (kN, GPa)",
        length_name: "mm",
        length: 1e-3,
        mass: 1.0,
        time: 1e-3,
    },
    Units { name: "cm", words: "cm, g, s (dyn)", length_name: "cm", length: 1e-2, mass: 1e-3, time: 1.0 },
    // lbf s²/in.
    Units {
        name: "in",
        words: "in, lbf·s²/in, s (lbf, psi)",
        length_name: "in",
        length: 0.0254,
        mass: 175.126_835_246_477,
        time: 1.0,
    },
];

impl Units {
    /// The names of all.
    pub fn names() -> impl Iterator<Item = &'static str> {
        SYSTEMS.iter().map(|units| units.name)
    }

    /// The system of this name.
    ///
    /// # Errors
    /// No such system.
    pub fn named(name: &str) -> Result<Units> {
        if let Some(units) = SYSTEMS.iter().find(|units| units.name == name) {
            return Ok(*units);
        }
        let all: Vec<_> = SYSTEMS.iter().map(|units| format!("{} ({})", units.name, units.words)).collect();
        let fault = Fault::new("--unit", format!("`{name}`"), format!("one of {}", all.join("; ")));
        Err(Error::input(match nearest(name, Units::names()) {
            Some(near) => fault.with_help(format!("Did you mean `{near}`?")),
            None => fault,
        }))
    }

    /// \[N\].
    pub fn force(&self) -> f64 {
        self.mass * self.length / (self.time * self.time)
    }

    /// \[Pa\].
    pub fn stress(&self) -> f64 {
        self.mass / (self.length * self.time * self.time)
    }

    /// \[kg/m³\].
    pub fn density(&self) -> f64 {
        self.mass / self.length.powi(3)
    }

    /// The systems in which a density and a modulus of elasticity are those of a solid material.
    pub fn likelier(density: f64, modulus: f64) -> impl Iterator<Item = &'static Units> {
        SYSTEMS.iter().filter(move |units| plausible(density * units.density(), modulus * units.stress()))
    }
}

/// Whether a density \[kg/m³\] and a modulus \[Pa\] are those of a solid.
pub(super) fn plausible(density: f64, modulus: f64) -> bool {
    DENSITY.contains(&density) && MODULUS.contains(&modulus) && SPEED.contains(&(modulus / density).sqrt())
}
