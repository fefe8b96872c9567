//! Materials: MP, MPDATA, MPTEMP and tables (TB) that are no more than constants; damping of the whole model.

use super::model::{Model, RawMaterial};
use super::reader::{Command, Reader};
use crate::deck::{Elastic, Material};
use crate::ledger::Weight;
use std::collections::BTreeMap;

/// Properties that are read.
const READ: &[&str] = &[
    "EX", "EY", "EZ", "NUXY", "NUXZ", "NUYZ", "PRXY", "PRXZ", "PRYZ", "GXY", "GXZ", "GYZ", "DENS", "MU",
    "DAMP", "BETD", "ALPD", "DMPR", "DMPS",
];
/// Properties of heat, electricity and magnetism.
const HEAT: &[&str] = &[
    "ALPX", "ALPY", "ALPZ", "CTEX", "CTEY", "CTEZ", "THSX", "THSY", "THSZ", "REFT", "KXX", "KYY", "KZZ", "C",
    "ENTH", "HF", "EMIS", "QRAT", "RSVX", "RSVY", "RSVZ", "PERX", "PERY", "PERZ", "MURX", "MURY", "MURZ",
    "MGXX", "MGYY", "MGZZ", "SONC", "VISC", "LSST", "SBKX",
];

impl Reader<'_> {
    /// Reads one of these commands; `short` is the name as far as four letters.
    pub fn material(&mut self, command: &Command<'_>, short: &str) {
        match short {
            "MP" => self.property(command),
            "MPDA" => self.property_table(command),
            "MPTE" => {
                // Of a table the first value is taken; where more differ it is noted there.
            }
            "MPDE" => {
                self.note(Weight::Perhaps, &command.name, "properties that are deleted stay", command.place)
            }
            "UIMP" => self.note(
                Weight::Matters,
                &command.name,
                "materials of the user interface are not read",
                command.place,
            ),
            "TB" => self.table(command),
            "TBDA" => self.table_data(command),
            "TBPT" => {
                self.note(Weight::Nothing, &command.name, "points of a table that is not read", command.place)
            }
            _ => {}
        }
    }

    /// MP: property, material, constant, then factors of powers of the temperature.
    fn property(&mut self, command: &Command<'_>) {
        let label = command.word(0);
        if !self.is_read(&label, command) {
            return;
        }
        let Some(material) = self.id(command, 1) else { return };
        let Some(value) = self.real(command, 2) else { return };
        if (3..7).any(|k| self.value(command.arg(k)).is_some_and(|factor| factor != 0.0)) {
            let why = "depends on temperature: the constant part is taken";
            self.note(Weight::Perhaps, format!("MP {label}"), why, command.place);
        }
        self.set(material, &label, value, command);
    }

    /// MPDATA: property, material, place in the table, values; in archives after R5.0 and a count.
    fn property_table(&mut self, command: &Command<'_>) {
        // MPDATA,R5.0,count,label,material,place,values; some write no count.
        let at = match command.word(0).as_str() {
            form if !form.starts_with("R5") && !form.starts_with("UNBL") => 0,
            _ if self.value(command.arg(1)).is_some() => 2,
            _ => 1,
        };
        let label = command.word(at);
        if !self.is_read(&label, command) {
            return;
        }
        let Some(material) = self.id(command, at + 1) else { return };
        let Some(start) = self.whole(command, at + 2) else { return };
        for k in at + 3..command.args.len().min(at + 9) {
            let Some(value) = self.real(command, k) else { return };
            if start <= 1 && k == at + 3 {
                self.set(material, &label, value, command);
            } else if !command.arg(k).is_empty() {
                let first = self.model.materials.get(&material).and_then(|own| own.properties.get(&label));
                if first.is_some_and(|first| *first != value) {
                    let why = "depends on temperature: the value at the first one is taken";
                    self.note(
                        Weight::Perhaps,
                        format!("MPDATA {label} of material {material}"),
                        why,
                        command.place,
                    );
                }
            }
        }
    }

    /// Whether a property is one that is read; others are noted.
    fn is_read(&mut self, label: &str, command: &Command<'_>) -> bool {
        if READ.contains(&label) {
            return true;
        }
        let (weight, why) = match label {
            "UMID" | "UVID" => (Weight::Nothing, "names of materials"),
            _ if HEAT.contains(&label) => (Weight::Nothing, "heat or electricity"),
            _ => (Weight::Perhaps, "a property that is not known"),
        };
        self.note(weight, format!("{} {label}", command.name), why, command.place);
        false
    }

    /// Gives a material a property.
    fn set(&mut self, material: u32, label: &str, value: f64, command: &Command<'_>) {
        let own = self.model.materials.entry(material).or_default();
        own.properties.insert(label.to_string(), value);
        own.place.get_or_insert(command.place);
    }

    /// TB: property, material, temperatures, constants, form.
    fn table(&mut self, command: &Command<'_>) {
        self.model.table = None;
        let (label, form) = (command.word(0), command.word(4));
        let Some(material) = self.whole(command, 1).and_then(|id| u32::try_from(id).ok()) else { return };
        let elastic = label.starts_with("ELAS") && (form.is_empty() || form.starts_with("ISOT"));
        let friction = label.starts_with("FRIC") && (form.is_empty() || form.starts_with("ISO"));
        if elastic || friction || label == "DENS" {
            let short = label.get(..4).unwrap_or(&label).to_string();
            self.model.table = Some((material, short));
            return;
        }
        let (weight, why) = match label.get(..4).unwrap_or(&label) {
            "BISO" | "MISO" | "BKIN" | "KINH" | "MKIN" | "CHAB" | "PLAS" | "NLIS" | "RATE" | "CREE"
            | "CONC" | "UNIA" => (Weight::Nothing, "plasticity and creep"),
            "SOFT" | "FCON" | "FCLI" | "FLIM" | "CTE" | "THER" | "SPEC" => {
                (Weight::Nothing, "strength, heat")
            }
            "ELAS" | "ANEL" => (Weight::Matters, "elasticity without a symmetry that is read"),
            "SDAM" => (Weight::Perhaps, "damping of a table: give it by MP"),
            "FRIC" => (Weight::Matters, "a friction law that is no constant"),
            "HYPE" | "MOON" | "PRON" | "GASK" | "JOIN" | "CZM" => {
                (Weight::Matters, "a law that is not linear")
            }
            _ => (Weight::Perhaps, "a table that is not read"),
        };
        self.note(weight, format!("TB {label}"), why, command.place);
    }

    /// TBDATA: place, values; the first that is given counts.
    fn table_data(&mut self, command: &Command<'_>) {
        let Some((material, table)) = self.model.table.clone() else {
            return self.note(
                Weight::Nothing,
                &command.name,
                "numbers of a table that is not read",
                command.place,
            );
        };
        let labels: &[&str] = match table.as_str() {
            "ELAS" => &["EX", "NUXY"],
            "FRIC" => &["MU"],
            _ => &["DENS"],
        };
        let start = self.whole(command, 0).unwrap_or(1).max(1) as usize;
        for (k, label) in labels.iter().enumerate().skip(start - 1) {
            let Some(value) = self.real(command, k + 2 - start) else { return };
            let known =
                self.model.materials.get(&material).and_then(|own| own.properties.get(*label)).copied();
            match known {
                None => self.set(material, label, value, command),
                Some(first) if first != value => {
                    let why = "depends on temperature or stands twice: the first value is taken";
                    self.note(
                        Weight::Perhaps,
                        format!("TB {table} of material {material}"),
                        why,
                        command.place,
                    );
                }
                _ => {}
            }
        }
    }

    /// ALPHAD, BETAD, DMPSTR: damping of the whole model.
    pub fn damping(&mut self, command: &Command<'_>, short: &str) {
        let Some(value) = self.real(command, 0) else { return };
        match short {
            "ALPH" => self.model.rayleigh[0] = value,
            "BETA" => self.model.rayleigh[1] = value,
            _ => self.model.loss_factor = value,
        }
    }
}

/// The materials that elements have, by number.
pub(super) fn materials(model: &Model) -> BTreeMap<u32, Material> {
    let named = |(number, own): (&u32, &RawMaterial)| (*number, material(model, *number, own));
    model.materials.iter().map(named).collect()
}

/// The name of a material.
pub(super) fn name(number: u32) -> String {
    format!("MATERIAL_{number}")
}

/// A material: damping is its own and that of the whole model. `DMPR` is a ratio ξ: η = 2ξ; `DMPS` is η.
fn material(model: &Model, number: u32, own: &RawMaterial) -> Material {
    let get = |label: &str| own.properties.get(label).copied();
    let or = |label: &str| get(label).unwrap_or(0.0);
    let beta = get("BETD").or(get("DAMP")).unwrap_or(0.0);
    Material {
        name: name(number),
        elastic: elastic(own),
        density: get("DENS"),
        rayleigh: [or("ALPD") + model.rayleigh[0], beta + model.rayleigh[1]],
        loss_factor: 2.0 * or("DMPR") + or("DMPS") + model.loss_factor,
    }
}

/// EX alone is isotropic; EY and EZ are EX where they are not given, and so on. NUXY is the minor ratio: PRXY = NUXY·EX/EY.
fn elastic(own: &RawMaterial) -> Option<Elastic> {
    let get = |label: &str| own.properties.get(label).copied();
    let x = get("EX")?;
    let (y, z) = (get("EY").unwrap_or(x), get("EZ").unwrap_or(x));
    let ratio = |major: &str, minor: &str, factor: f64| get(major).or(get(minor).map(|nu| nu * factor));
    // ANSYS takes 0.3 where no ratio is given.
    let xy = ratio("PRXY", "NUXY", x / y).unwrap_or(0.3);
    let (xz, yz) = (ratio("PRXZ", "NUXZ", x / z).unwrap_or(xy), ratio("PRYZ", "NUYZ", y / z).unwrap_or(xy));
    let shear = x / (2.0 * (1.0 + xy));
    let shears = ["GXY", "GXZ", "GYZ"].map(|label| get(label).unwrap_or(shear));
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-6 * b.abs();
    let same = y == x && z == x && xz == xy && yz == xy && shears.iter().all(|own| near(*own, shear));
    Some(if same {
        Elastic::Isotropic { youngs_modulus: x, poissons_ratio: xy }
    } else {
        Elastic::Orthotropic { youngs_moduli: [x, y, z], poissons_ratios: [xy, xz, yz], shear_moduli: shears }
    })
}
