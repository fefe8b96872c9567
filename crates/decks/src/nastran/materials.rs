//! Materials: MAT1, MAT8, MAT9, MAT11.

use super::fields::Fields;
use super::model::Model;
use super::names::{Named, Names};
use super::parameters::Parameters;
use super::table::Table;
use crate::deck::{Elastic, Material};
use crate::ledger::Weight;

/// A material as its card has it.
#[derive(Debug, Clone, PartialEq)]
struct Raw {
    card: String,
    elastic: Option<Elastic>,
    density: Option<f64>,
    loss_factor: f64,
}

#[derive(Debug, Default)]
pub(super) struct Materials {
    table: Table<Raw>,
}

const HEAT: &str = "heat expansion, strength and reference temperatures are not read";

/// A material whose density is higher by what elements carry.
pub(super) struct Heavier {
    pub name: String,
    pub number: u64,
    /// What is added.
    pub density: f64,
}

impl Materials {
    pub fn card(&mut self, fields: &mut Fields) -> Option<()> {
        let number = fields.id(1)?;
        let (elastic, density, loss) = match fields.name() {
            "MAT1" => {
                let elastic = isotropic(fields)?;
                fields.unread(6, 7, Weight::Nothing, HEAT);
                fields.unread(9, 12, Weight::Nothing, HEAT);
                (Some(elastic), 5, 8)
            }
            "MAT8" => {
                fields.unread(9, 18, Weight::Nothing, HEAT);
                fields.unread(20, 21, Weight::Nothing, HEAT);
                (Some(in_plane(fields)?), 8, 19)
            }
            "MAT9" => {
                fields.unread(24, 29, Weight::Nothing, HEAT);
                fields.unread(30, 30, Weight::Nothing, HEAT);
                (by_stiffness(fields)?, 23, 31)
            }
            _ => {
                let [e, nu, g] = [2, 5, 8].map(|first| [0, 1, 2].map(|k| fields.real(first + k)));
                let all = |v: [Option<f64>; 3]| Some([v[0]?, v[1]?, v[2]?]);
                let (youngs_moduli, poissons_ratios, shear_moduli) = (all(e)?, all(nu)?, all(g)?);
                fields.unread(12, 15, Weight::Nothing, HEAT);
                (Some(Elastic::Orthotropic { youngs_moduli, poissons_ratios, shear_moduli }), 11, 16)
            }
        };
        let density = fields.real_if(density)?;
        let loss_factor = fields.real_or(loss, 0.0)?;
        let card = fields.name().to_string();
        self.table.push(number, fields.place(), Raw { card, elastic, density, loss_factor });
        Some(())
    }

    /// The name of a material.
    pub fn name(&self, number: u64, names: &Names) -> Option<String> {
        Some(names.of(Named::Material, number, &self.table.get(number)?.value.card))
    }

    /// Whether its directions are all alike.
    pub fn is_isotropic(&self, number: u64) -> bool {
        self.table.get(number).is_none_or(|row| matches!(row.value.elastic, Some(Elastic::Isotropic { .. })))
    }

    pub fn sort(&mut self, notes: &mut super::notes::Notes) {
        self.table.sort("material", notes);
    }

    /// Puts them into the deck, with the damping that holds for all.
    pub fn resolve(&self, heavier: Vec<Heavier>, parameters: &Parameters, model: &mut Model) {
        let material = |name: String, raw: &Raw, density: Option<f64>| Material {
            name,
            elastic: raw.elastic,
            density: density.map(|density| density * parameters.mass_factor()),
            rayleigh: parameters.rayleigh(),
            loss_factor: raw.loss_factor + parameters.loss_factor(),
        };
        for row in self.table.rows() {
            let name = model.names.of(Named::Material, row.number, &row.value.card);
            model.deck.materials.push(material(name, &row.value, row.value.density));
        }
        for Heavier { name, number, density } in heavier {
            if let Some(row) = self.table.get(number) {
                let density = row.value.density.unwrap_or(0.0) + density;
                model.deck.materials.push(material(name, &row.value, Some(density)));
            }
        }
    }
}

/// E, G and ν, of which one may be left out: E = 2 (1 + ν) G.
fn isotropic(fields: &mut Fields) -> Option<Elastic> {
    let (e, g, nu) = (fields.real_if(2)?, fields.real_if(3)?, fields.real_if(4)?);
    let (youngs_modulus, poissons_ratio) = match (e, g, nu) {
        (Some(e), Some(g), Some(nu)) => {
            if (e - 2.0 * (1.0 + nu) * g).abs() > 0.01 * e.abs() {
                fields.note(
                    Weight::Perhaps,
                    "a shear modulus G other than E/(2 (1 + ν)) is not read: E and ν hold",
                );
            }
            (e, nu)
        }
        (Some(e), Some(g), None) if g != 0.0 => (e, e / (2.0 * g) - 1.0),
        (None, Some(g), Some(nu)) => (2.0 * (1.0 + nu) * g, nu),
        (Some(e), _, nu) => (e, nu.unwrap_or(0.0)),
        (None, Some(g), None) => (2.0 * g, 0.0),
        _ => {
            fields.fault(2, "MAT1 with neither E nor G", "two of E, G and ν");
            return None;
        }
    };
    Some(Elastic::Isotropic { youngs_modulus, poissons_ratio })
}

/// MAT8: E₁, E₂, ν₁₂, G₁₂, G₁z, G₂z of a plane; across it as direction 2.
fn in_plane(fields: &mut Fields) -> Option<Elastic> {
    let (e1, e2, nu) = (fields.real(2)?, fields.real(3)?, fields.real_or(4, 0.0)?);
    let g12 = fields.real_or(5, 0.0)?;
    let [g13, g23] = [fields.real_or(6, 0.0)?, fields.real_or(7, 0.0)?];
    if g13 == 0.0 || g23 == 0.0 {
        fields.note(Weight::Perhaps, "shells without transverse shear are not read: it is as in the plane");
    }
    fields.note(
        Weight::Nothing,
        "the modulus across the plane, which shells do not need, is that of direction 2",
    );
    let or = |g: f64| if g == 0.0 { g12 } else { g };
    Some(Elastic::Orthotropic {
        youngs_moduli: [e1, e2, e2],
        poissons_ratios: [nu; 3],
        shear_moduli: [g12, or(g13), or(g23)],
    })
}

/// MAT9: the upper triangle of the stiffness of xx, yy, zz, xy, yz, zx by rows. It is orthotropic where nothing couples shear; else it is noted.
///
/// The compliance S = C⁻¹ has 1/Eᵢ and −νᵢⱼ/Eᵢ.
fn by_stiffness(fields: &mut Fields) -> Option<Option<Elastic>> {
    let c = fields.symmetric(2, true)?;
    let largest = c.iter().flatten().fold(0.0_f64, |most, value| most.max(value.abs()));
    let couples = (0..6).any(|i| (3..6).any(|j| i != j && c[i][j].abs() > 1e-9 * largest));
    let minor = |i: usize, j: usize| {
        let [a, b] = [(i + 1) % 3, (i + 2) % 3];
        let [p, q] = [(j + 1) % 3, (j + 2) % 3];
        c[a][p] * c[b][q] - c[a][q] * c[b][p]
    };
    let determinant: f64 = (0..3).map(|j| c[0][j] * minor(0, j)).sum();
    if couples || determinant <= 0.0 || (3..6).any(|k| c[k][k] <= 0.0) {
        fields.note(
            Weight::Matters,
            "a stiffness that is not orthotropic in the directions of the material is not read",
        );
        return Some(None);
    }
    let s = |i: usize, j: usize| minor(j, i) / determinant;
    let e = [0, 1, 2].map(|k| 1.0 / s(k, k));
    Some(Some(Elastic::Orthotropic {
        youngs_moduli: e,
        poissons_ratios: [(0, 1), (0, 2), (1, 2)].map(|(i, j)| -s(j, i) * e[i]),
        shear_moduli: [c[3][3], c[5][5], c[4][4]],
    }))
}
