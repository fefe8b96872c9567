//! Executive and case control: what is solved, and which sets of supports, loads and methods it takes.

use super::notes::Notes;
use crate::deck::Place;
use crate::ledger::Weight;
use std::collections::BTreeMap;

/// What was asked for.
#[derive(Debug, Default)]
pub(super) struct Control {
    pub title: String,
    /// Above all subcases, then each of them.
    subcases: Vec<Subcase>,
    /// Whether the line before ends in a comma, so that this one goes on with a list.
    goes_on: bool,
}

/// A subcase.
#[derive(Debug, Default)]
struct Subcase {
    number: u64,
    chosen: BTreeMap<Choice, u64>,
}

/// A command that chooses a set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Choice {
    Spc,
    Mpc,
    Load,
    Method,
    ComplexMethod,
    Contact,
    Glue,
    Preload,
}

const CHOICES: &[(&str, Choice)] = &[
    ("SPC", Choice::Spc),
    ("MPC", Choice::Mpc),
    ("LOAD", Choice::Load),
    ("METHOD", Choice::Method),
    ("CMETHOD", Choice::ComplexMethod),
    ("BCSET", Choice::Contact),
    ("BCONTACT", Choice::Contact),
    ("BGSET", Choice::Glue),
    ("STATSUB", Choice::Preload),
];

/// Commands that change the structure.
const STRUCTURE: &[&str] = &[
    "K2GG", "M2GG", "B2GG", "K42GG", "K2PP", "M2PP", "B2PP", "TFL", "RGYRO", "SDAMPING", "A2GG", "SUPER",
    "SEALL",
];
/// Commands that may change the state at rest.
const STATE: &[&str] =
    &["TEMPERATURE", "TEMP", "DEFORM", "SUPORT1", "NLPARM", "BOLTLD", "BGADD", "NLSTEP", "IC"];

impl Control {
    /// A line of the executive control, in capitals.
    pub fn executive(line: &str, place: Place, notes: &mut Notes) {
        let mut words =
            line.split(|c: char| c.is_whitespace() || c == ',' || c == '=').filter(|w| !w.is_empty());
        if let Some(word) = words.next() {
            let why = "the executive control is not read: what is solved are the modes that METHOD and CMETHOD choose";
            let weight =
                if ["ALTER", "COMPILE", "DMAP"].contains(&word) { Weight::Perhaps } else { Weight::Nothing };
            notes.ledger.note(weight, word, why, place);
        }
    }

    /// A line of the case control.
    pub fn case(&mut self, line: &str, place: Place, notes: &mut Notes) {
        let going_on = std::mem::replace(&mut self.goes_on, line.ends_with(','));
        if going_on {
            return;
        }
        let upper = line.to_ascii_uppercase();
        let (command, value) = match line.split_once('=') {
            Some((command, value)) => (command, value.trim()),
            None => line.split_once(char::is_whitespace).map_or((line, ""), |(a, b)| (a, b.trim())),
        };
        let command = command.split(['(', ' ']).next().unwrap_or_default().to_ascii_uppercase();
        let number = || value.split([',', ' ']).next().unwrap_or_default().parse::<u64>().ok();
        if self.subcases.is_empty() {
            self.subcases.push(Subcase::default());
        }
        // Of a fluid.
        let other = line.contains('(') && upper.contains("(FLUID");
        if let Some((_, choice)) = CHOICES.iter().find(|(name, _)| *name == command && !other) {
            match (number(), self.subcases.last_mut()) {
                (Some(number), Some(subcase)) => {
                    subcase.chosen.insert(*choice, number);
                }
                _ if *choice == Choice::Contact => {
                    let why = "contact of all bodies, or of others than a set, is not read";
                    notes.ledger.note(Weight::Matters, command, why, place);
                }
                _ => notes.files.fault(place, format!("`{line}`"), format!("{command} = number of a set")),
            }
            return;
        }
        match command.as_str() {
            "SUBCASE" => self.subcases.push(Subcase { number: number().unwrap_or(0), ..Subcase::default() }),
            "TITLE" => self.title = value.to_string(),
            _ => {
                let is_in = |list: &[&str]| list.contains(&command.as_str());
                let (weight, why) = if is_in(STRUCTURE) {
                    (Weight::Matters, "what it chooses is not read")
                } else if is_in(STATE) {
                    (Weight::Perhaps, "what it chooses is not read")
                } else {
                    (Weight::Nothing, "no set of supports, loads or methods: not read")
                };
                let what = if command.is_empty() { upper } else { command };
                notes.ledger.note(weight, what, why, place);
            }
        }
    }

    /// The set that is chosen: by the subcase of the modes, the one before it whose preload it has, or the first. Others are noted.
    pub fn chosen(&self, choice: Choice, notes: &mut Notes) -> Option<u64> {
        let (common, subcases) = self.subcases.split_first()?;
        let of = |subcase: &Subcase, choice: Choice| {
            subcase.chosen.get(&choice).or(common.chosen.get(&choice)).copied()
        };
        if subcases.is_empty() {
            return of(common, choice);
        }
        let modes = subcases.iter().rev().find(|subcase| {
            [Choice::Method, Choice::ComplexMethod].iter().any(|own| subcase.chosen.contains_key(own))
        });
        let modes = modes.unwrap_or(&subcases[0]);
        let preload = modes.chosen.get(&Choice::Preload);
        let preload = subcases.iter().find(|subcase| preload == Some(&subcase.number));
        let order = match choice {
            Choice::Load => [preload, Some(&subcases[0]), Some(modes)],
            _ => [Some(modes), preload, Some(&subcases[0])],
        };
        let chosen = order.into_iter().flatten().find_map(|subcase| of(subcase, choice));
        let others = subcases.iter().any(|subcase| of(subcase, choice) != chosen);
        if let (true, Some(chosen)) = (others, chosen) {
            let name = CHOICES.iter().find(|(_, own)| *own == choice).map_or("", |(name, _)| name);
            let why = format!("subcases choose several: set {chosen} is taken");
            notes.ledger.note(Weight::Perhaps, name, why, Place { file: 0, line: 0 });
        }
        chosen
    }
}
