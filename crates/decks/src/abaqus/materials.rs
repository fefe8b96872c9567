//! *MATERIAL, *ELASTIC, *DENSITY, *DAMPING.

use super::reader::{Found, Reader, Row};
use crate::deck::{Elastic, Material};
use crate::ledger::Weight;

impl Reader {
    /// *MATERIAL: those that follow are of it.
    pub fn material(&mut self, _: usize, found: Found<'_>) {
        let Some(name) = found.option("NAME").map(str::to_string) else {
            self.files.fault(found.place(), "*MATERIAL without a name", "*MATERIAL, NAME=…");
            return;
        };
        let next = self.deck.materials.len();
        if *self.materials.entry(&name, || next) != next {
            self.files.fault(
                found.place(),
                format!("a second *MATERIAL `{name}`"),
                "one material of each name",
            );
        }
        self.deck.materials.push(Material { name, ..Material::default() });
    }

    /// The material that a keyword belongs to.
    fn open_material(&mut self, found: Found<'_>) -> Option<usize> {
        if self.deck.materials.is_empty() {
            self.files.fault(
                found.place(),
                format!("*{} without a material", found.block.keyword),
                "*MATERIAL above",
            );
        }
        self.deck.materials.len().checked_sub(1)
    }

    /// The first line, with a note where there are others, for other temperatures.
    fn first_row<'a>(&mut self, found: Found<'a>, more: usize) -> Option<Row<'a>> {
        let first = found.rows().next();
        if first.is_none() {
            self.files.fault(
                found.place(),
                format!("*{} without data", found.block.keyword),
                "a line of numbers",
            );
        } else if found.lines().count() > more {
            let why = "the first line of a table over temperature is read";
            self.deck.ledger.note(Weight::Perhaps, format!("*{}", found.block.keyword), why, found.place());
        }
        first
    }

    /// *ELASTIC: E, ν; or engineering constants.
    pub fn elastic(&mut self, _: usize, found: Found<'_>) {
        let Some(material) = self.open_material(found) else { return };
        let kind = found.option("TYPE").unwrap_or("ISOTROPIC").to_uppercase();
        let kind: String = kind.split_whitespace().collect();
        let elastic = if kind.starts_with("ISO") {
            let Some(row) = self.first_row(found, 1) else { return };
            let Some([youngs_modulus, poissons_ratio]) = self.numbers::<2>(&row, 0) else { return };
            Elastic::Isotropic { youngs_modulus, poissons_ratio }
        } else if kind.starts_with("ENGINEERINGCONSTANTS") || kind == "ENGINEERING" {
            let Some(row) = self.first_row(found, 2) else { return };
            let Some(row) = self.nine(found, row) else { return };
            let Some([e1, e2, e3, n12, n13, n23, g12, g13, g23]) = self.numbers::<9>(&row, 0) else { return };
            Elastic::Orthotropic {
                youngs_moduli: [e1, e2, e3],
                poissons_ratios: [n12, n13, n23],
                shear_moduli: [g12, g13, g23],
            }
        } else if kind.starts_with("ORTHO") {
            let Some(row) = self.first_row(found, 2) else { return };
            let Some(row) = self.nine(found, row) else { return };
            let Some(stiffness) = self.numbers::<9>(&row, 0) else { return };
            let Some(elastic) = engineering(stiffness) else {
                let why = "stiffnesses that are not positive definite are not read";
                self.deck.ledger.note(Weight::Matters, "*ELASTIC, TYPE=ORTHO", why, row.place);
                return;
            };
            elastic
        } else {
            let why = "elastic constants of this kind are not read";
            self.deck.ledger.note(Weight::Matters, format!("*ELASTIC, TYPE={kind}"), why, found.place());
            return;
        };
        self.deck.materials[material].elastic = Some(elastic);
    }

    /// Nine numbers in two lines: eight in the first, and sometimes fewer.
    fn nine<'a>(&mut self, found: Found<'a>, first: Row<'a>) -> Option<Row<'a>> {
        let Row { place, mut cells } = first;
        while cells.last().is_some_and(|cell| cell.is_empty()) {
            cells.pop();
        }
        if cells.len() < 9 {
            cells.extend(found.rows().nth(1).into_iter().flat_map(|row| row.cells));
        }
        if cells.len() < 9 || cells[8].is_empty() {
            let words = format!("{} numbers", cells.len().min(8));
            self.files.fault(place, words, "eight numbers, and one in the line below");
            return None;
        }
        Some(Row { place, cells })
    }

    /// *DENSITY: ρ.
    pub fn density(&mut self, _: usize, found: Found<'_>) {
        let Some(material) = self.open_material(found) else { return };
        let Some(row) = self.first_row(found, 1) else { return };
        let Some(density) = self.number(&row, 0) else { return };
        self.deck.materials[material].density = Some(density);
    }

    /// *DAMPING: ALPHA, BETA, STRUCTURAL.
    pub fn damping(&mut self, _: usize, found: Found<'_>) {
        if self.step.is_some() {
            let why = "damping of modes in a step is not read; that of materials is";
            self.deck.ledger.note(Weight::Perhaps, "*DAMPING", why, found.place());
            return;
        }
        let Some(material) = self.open_material(found) else { return };
        let mut value = |name: &str| {
            let cell = found.option(name)?;
            self.number(&Row { place: found.place(), cells: vec![cell] }, 0)
        };
        let [alpha, beta, loss] = ["ALPHA", "BETA", "STRUCTURAL"].map(|name| value(name).unwrap_or(0.0));
        let material = &mut self.deck.materials[material];
        material.rayleigh = [alpha, beta];
        material.loss_factor = loss;
    }
}

/// Engineering constants of a stiffness D1111, D1122, D2222, D1133, D2233, D3333, D1212, D1313, D2323: the inverse of its first block has 1/Eᵢ
/// on its diagonal and −νᵢⱼ/Eᵢ beside it.
fn engineering([d11, d12, d22, d13, d23, d33, g12, g13, g23]: [f64; 9]) -> Option<Elastic> {
    let cofactors = [d22 * d33 - d23 * d23, d11 * d33 - d13 * d13, d11 * d22 - d12 * d12];
    let determinant = d11 * cofactors[0] - d12 * (d12 * d33 - d23 * d13) + d13 * (d12 * d23 - d22 * d13);
    let positive = determinant > 0.0 && d11 > 0.0 && cofactors[2] > 0.0;
    let youngs_moduli = cofactors.map(|cofactor| determinant / cofactor);
    // Of the inverse: entries 12, 13, 23.
    let beside = [d13 * d23 - d12 * d33, d12 * d23 - d13 * d22, d12 * d13 - d11 * d23];
    let [e1, e2, _] = youngs_moduli;
    let poissons_ratios = [-beside[0] * e1, -beside[1] * e1, -beside[2] * e2].map(|nu| nu / determinant);
    let constants = [youngs_moduli, poissons_ratios];
    let positive = positive && constants.as_flattened().iter().all(|constant| constant.is_finite());
    positive.then_some(Elastic::Orthotropic { youngs_moduli, poissons_ratios, shear_moduli: [g12, g13, g23] })
}
