//! The modes that were asked for.

use super::converter::Converter;
use super::text::{number, quantity};
use crate::deck::{Analysis, Place};
use crate::ledger::Weight;

impl Converter<'_> {
    /// The analyses that were meant, the first of each kind; modes where there is none.
    pub fn analyses(&mut self) {
        let first = |complex: bool| {
            self.deck.analyses.iter().find_map(|analysis| match analysis {
                Analysis::Modes { count, band } if !complex => Some((*count, *band)),
                Analysis::ComplexModes { count, band } if complex => Some((*count, *band)),
                _ => None,
            })
        };
        let [modes, complex] = [false, true].map(first);
        let joined = !self.deck.contacts.is_empty();
        if let Some((count, band)) = modes {
            self.modes(count, band);
        } else if complex.is_none() && !joined {
            self.case.table("modes", "imported").key("count", "10");
        }
        match (complex, modes) {
            // The band of the real modes, from which complex ones are made, where these say none.
            (Some((count, [_, None])), Some((other, band))) => self.complex(count.or(other), band),
            (Some((count, band)), _) => self.complex(count, band),
            (None, modes) if joined => {
                let (count, band) = modes.unwrap_or_default();
                self.complex(count, band);
            }
            _ => {}
        }
    }

    /// A frequency of the file \[Hz\].
    fn hertz(&self, frequency: f64) -> String {
        number(frequency / self.units.time)
    }

    /// `from 20 to 3000 Hz`, as far as it is said.
    fn band_words(&self, [low, top]: [Option<f64>; 2]) -> String {
        let word = |word: &str, f: Option<f64>| f.map(|f| format!("{word} {} ", self.hertz(f)));
        [word("from", low), word("to", top)].into_iter().flatten().collect::<String>() + "Hz"
    }

    /// `[modes.imported]`: so many modes, or all below a frequency.
    fn modes(&mut self, count: Option<usize>, band: [Option<f64>; 2]) {
        let words = self.band_words(band);
        let low = band[0].is_some_and(|low| low > 0.0);
        self.case.table("modes", "imported");
        match (count, band[1]) {
            (Some(count), _) => self.case.key("count", count.to_string()),
            (None, Some(top)) => self.case.key("below", quantity(top / self.units.time, 1.0, "Hz")),
            (None, None) => self.case.key("count", "10"),
        };
        if low || count.is_some() && band[1].is_some() {
            self.case.comment(format!(
                "The file asks for frequencies {words}: here are all modes from the lowest on."
            ));
            let why =
                format!("the band {words} is a comment in [modes]: the modes are those from the lowest on");
            self.ledger.note(Weight::Nothing, "modes", why, Place::default());
        }
    }

    fn complex(&mut self, count: Option<usize>, band: [Option<f64>; 2]) {
        if self.deck.contacts.is_empty() && self.deck.motions.is_empty() {
            let why = "complex modes need a contact or a rotation";
            self.ledger.note(Weight::Matters, "complex modes", why, Place::default());
            return;
        }
        let low = band[0].map_or("0".into(), |f| self.hertz(f));
        let top = band[1].map_or("10000".into(), |f| self.hertz(f));
        self.case.only("cea");
        if band[1].is_none() {
            self.case.comment("The file names no highest frequency.");
        }
        if let Some(count) = count {
            self.case.comment(format!("The file asks for {count} modes: here are all of the band."));
            let why = format!("{count} modes are asked for: [cea] finds all of its band");
            self.ledger.note(Weight::Nothing, "complex modes", why, Place::default());
        }
        self.case.key("band", format!("[{low}, {top}]"));
    }
}
