//! What was read, in Markdown: sizes, masses, what each thing became, and what was not read.

use super::converter::Converter;
use crate::deck::SectionShape;
use std::collections::BTreeMap;
use std::fmt::Write;
use stridor_base::numbers::{given, significant};
use stridor_mesh::{Cell, CellKind, QuadraturePoint};

/// Mass, volume and first moment of a part.
#[derive(Debug, Clone, Copy, Default)]
struct MassOf {
    mass: f64,
    volume: f64,
    moment: [f64; 3],
}

impl Converter<'_> {
    /// The page, and the mass of all \[kg\].
    pub fn page(&mut self) -> (String, f64) {
        let mut text = String::new();
        self.head(&mut text);
        let mass = self.masses(&mut text);
        self.types(&mut text);
        self.unread(&mut text);
        (text, mass)
    }

    fn head(&self, text: &mut String) {
        let deck = self.deck;
        let mut line = |words: std::fmt::Arguments<'_>| writeln!(text, "{words}").expect("memory");
        line(format_args!("# What was read\n"));
        if !deck.title.is_empty() {
            line(format_args!("{}\n", deck.title));
        }
        let names = deck.files.iter().map(|file| file.file_name().unwrap_or_default().to_string_lossy());
        line(format_args!("Files: {}\n", names.collect::<Vec<_>>().join(", ")));
        line(format_args!("Units supposed: {}. No file states its own.\n", self.units.words));
        let counts = [
            ("nodes", deck.nodes.len()),
            ("elements", deck.elements.len()),
            ("sets of nodes", deck.node_sets.len()),
            ("sets of elements", deck.element_sets.len()),
            ("surfaces", deck.surfaces.len()),
            ("materials", deck.materials.len()),
            ("sections", deck.sections.len()),
            ("supports", deck.supports.len()),
            ("equations", deck.equations.len()),
            ("ties", deck.ties.len()),
            ("couplings", deck.couplings.len()),
            ("contacts", deck.contacts.len()),
            ("masses", deck.masses.len()),
            ("springs", deck.springs.len()),
            ("loads", deck.loads.len()),
            ("motions", deck.motions.len()),
        ];
        line(format_args!("| what | count |\n|---|---|"));
        for (what, count) in counts.into_iter().filter(|(_, count)| *count > 0) {
            line(format_args!("| {what} | {count} |"));
        }
    }

    fn masses(&mut self, text: &mut String) -> f64 {
        let mut rows = Vec::new();
        let mut whole = MassOf::default();
        let mut extent = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for part in &self.parts {
            let (of, own) = self.mass_of(part.section, &part.elements);
            whole.mass += of.mass;
            whole.volume += of.volume;
            (0..3).for_each(|k| whole.moment[k] += of.moment[k]);
            for k in 0..3 {
                extent[0][k] = extent[0][k].min(own[0][k]);
                extent[1][k] = extent[1][k].max(own[1][k]);
            }
            rows.push((part.name.clone(), of, own));
        }
        let points: f64 =
            self.deck.masses.iter().map(|mass| mass.mass * mass.nodes.len() as f64 * self.units.mass).sum();
        rows.push(("all parts".into(), whole, extent));
        let mut line = |words: std::fmt::Arguments<'_>| writeln!(text, "{words}").expect("memory");
        line(format_args!(
            "\n## Masses\n\n| part | mass [kg] | volume [m³] | centre of gravity [m] | extent [m] |\n|---|---|---|---|---|"
        ));
        for (name, of, [low, high]) in rows {
            let centre = of.moment.map(|moment| if of.mass > 0.0 { moment / of.mass } else { 0.0 });
            let list = |values: [f64; 3]| values.map(given).join(", ");
            let size = list(std::array::from_fn(|k| high[k] - low[k]));
            let (mass, volume) = (significant(of.mass, 7), significant(of.volume, 7));
            line(format_args!("| {name} | {mass} | {volume} | {} | {size} |", list(centre)));
        }
        if points > 0.0 {
            line(format_args!("\nConcentrated masses: {} kg.", significant(points, 7)));
        }
        for warning in &self.warnings {
            line(format_args!("\n**{warning}.**"));
        }
        if whole.mass > 1e6 {
            let warning = format!(
                "All parts weigh {} kg: is the unit of the density that of the lengths",
                significant(whole.mass, 3)
            );
            line(format_args!("\n**{warning}?**"));
            self.warnings.push(warning);
        }
        whole.mass + points
    }

    /// ∫ρ dV, ∫dV and ∫ρ x dV of a section's elements in SI units, and its extent.
    fn mass_of(&self, section: usize, elements: &[usize]) -> (MassOf, [[f64; 3]; 2]) {
        let section = &self.deck.sections[section];
        let material = self.deck.material(&section.material);
        let density = material.and_then(|material| material.density).unwrap_or(0.0) * self.units.density();
        let length = self.units.length;
        let across = match section.shape {
            SectionShape::Solid | SectionShape::Unstated => 1.0,
            SectionShape::Shell { thickness } => thickness * length,
            SectionShape::Beam { profile, .. } => profile.area() * length * length,
            SectionShape::Truss { area } => area * length * length,
        };
        let nodes = &self.regions.mesh.nodes;
        let mut sum = MassOf::default();
        let mut quadratures: BTreeMap<CellKind, Vec<QuadraturePoint>> = BTreeMap::new();
        let mut extent = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for element in elements {
            let element = &self.deck.elements[*element];
            let Some(cell) = Cell::new(element.kind, &element.nodes) else { continue };
            for node in &element.nodes {
                for k in 0..3 {
                    extent[0][k] = extent[0][k].min(nodes[*node][k]);
                    extent[1][k] = extent[1][k].max(nodes[*node][k]);
                }
            }
            let quadrature = quadratures.entry(element.kind).or_insert_with(|| element.kind.quadrature(5));
            for point in quadrature.iter() {
                let volume = point.weight * cell.scale(nodes, point.at) * across;
                let at = cell.position(nodes, point.at);
                sum.volume += volume;
                sum.mass += density * volume;
                (0..3).for_each(|k| sum.moment[k] += density * volume * at[k]);
            }
        }
        (sum, extent)
    }

    fn types(&self, text: &mut String) {
        let mut counts = vec![0; self.deck.type_names.len()];
        self.deck.elements.iter().for_each(|element| counts[element.type_name as usize] += 1);
        writeln!(text, "\n## Elements\n\n| type in the file | count |\n|---|---|").expect("memory");
        for (name, count) in self.deck.type_names.iter().zip(counts).filter(|(_, count)| *count > 0) {
            writeln!(text, "| {name} | {count} |").expect("memory");
        }
    }

    fn unread(&self, text: &mut String) {
        writeln!(text, "\n## Not read, or read in part\n").expect("memory");
        let mut none = true;
        for row in self.ledger.rows() {
            if std::mem::take(&mut none) {
                writeln!(
                    text,
                    "| what | why | matters for vibrations | first | count |\n|---|---|---|---|---|"
                )
                .expect("memory");
            }
            let first = if row.first.line == 0 { String::new() } else { self.short_place(row.first) };
            writeln!(
                text,
                "| {} | {} | {} | {first} | {} |",
                row.what,
                row.why,
                row.weight.word(),
                row.count
            )
            .expect("memory");
        }
        if none {
            writeln!(text, "Everything was read.").expect("memory");
        }
    }

    /// The place without its folder.
    pub(super) fn short_place(&self, place: crate::deck::Place) -> String {
        let file = self.deck.files.get(place.file as usize).and_then(|file| file.file_name());
        format!("{}:{}", file.unwrap_or_default().to_string_lossy(), place.line)
    }
}
