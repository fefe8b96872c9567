//! Cases changed as a user may change them by mistake: tables and values exchanged, copied, moved or left out, names exchanged, units of
//! other quantities. No panic, no abort, and whatever `check` calls valid, `run` does not refuse.
//!
//! The test that always runs takes few members. `MUTATIONS=2000 cargo test --release --test processes mutated_cases -- --ignored
//! --nocapture` takes so many, of the seed `MUTATIONS_SEED`.

use crate::extremes::{Variant, cases, complaint, paths, slot, value};
use crate::program::CASE;
use crate::small_rig::RIG;
use std::path::PathBuf;
use stridor::case::{Case, read_case};
use stridor::linalg::random::Random;
use tempfile::TempDir;
use toml::Value;

/// Units of many quantities.
const UNITS: [&str; 24] = [
    "mm", "m", "um", "kg", "g", "N", "kN", "Hz", "kHz", "deg", "rad", "m/s", "mm/s", "GPa", "MPa", "kg/m^3",
    "N/m", "MN/m", "GN/m^3", "N s/m", "us", "s", "s/m", "%",
];
/// Tables that cases have, to be put where they may not belong.
const TABLES: [(&str, &str); 14] = [
    ("support", "{ a = { on = \"rim\" } }"),
    ("spring", "{ a = { on = \"rim\", direction = [1, 0, 0], stiffness = 1e3 } }"),
    ("mass", "{ a = { on = \"rim\", mass = 1e-3 } }"),
    ("point", "{ here = [0, 0.05, 0] }"),
    ("force", "{ a = { on = \"rim\", force = [1, 0, 0] } }"),
    ("rigid", "{ a = { master = \"here\", follow = \"rim\" } }"),
    ("modes", "{ more = { count = 3, contact = \"closed\" } }"),
    ("modes", "{ free = { below = 500, free = true } }"),
    ("sensitivity", "{ verify = true }"),
    (
        "transient",
        "{ duration = 1e-3, time_step = 1e-4, probe = { rim = { at = [0, 0, 0.075], direction = [1, 0, 0] } } }",
    ),
    (
        "transient",
        "{ duration = 1e-3, time_step = 1e-4, hold = \"load\", scheme = \"newmark\", sound = { distance = 1 } }",
    ),
    ("frf", "{ tap = { band = [100, 200], excitation = { at = [0, 0, 0.075], direction = [1, 0, 0] } } }"),
    (
        "uncertainty",
        "{ u = { samples = 10, parameters = { \"contact.pin.friction.mu0\" = { from = 0.1, to = 0.5 } } } }",
    ),
    ("sweep", "{ s = { parameter = \"contact.pin.friction.mu0\", from = 0.1, to = 0.5, points = 3 } }"),
];

/// The cases that are changed, each with its folder.
fn bases() -> Vec<Value> {
    let root =
        |case: Case| Value::Table(case.with_absolute_paths().to_toml().parse().expect("a case is TOML"));
    let text = |text: &str| root(Case::parse("case", text, PathBuf::from(".")).expect("a sound case"));
    let small =
        ["two-dof/case", "hoffmann/case", "preload/strip", "friction-laws/table", "bar-cantilever/case"];
    let files =
        small.iter().flat_map(|name| cases(name)).map(|file| root(read_case(&file).expect("a sound case")));
    [text(CASE), text(CASE), text(RIG)].into_iter().chain(files).collect()
}

/// Does one thing to a case; what it was.
fn mutate(root: &mut Value, random: &mut Random) -> String {
    let mut all = Vec::new();
    paths(root, &mut Vec::new(), &mut all);
    if all.is_empty() {
        return "nothing".into();
    }
    let kind = random.below(8);
    let mut path = || all[random.below(all.len())].clone();
    let (a, b) = (path(), path());
    let [own, other] = [&a, &b].map(|path| slot(root, path).expect("it is there").clone());
    let [shown_a, shown_b] = [&a, &b].map(|path| path.join("."));
    let mut put = |path: &[String], new: Value| {
        // An exchange of a table with a part of it leaves nothing there.
        if let Some(place) = slot(root, path) {
            *place = new;
        }
    };
    match kind {
        0 => {
            // Of one kind, so that the reader is not stopped by the first look.
            let like = |path: &&Vec<String>| {
                let same = |v: &Value| std::mem::discriminant(v) == std::mem::discriminant(&own);
                **path != a && slot(&mut root.clone(), path).is_some_and(|v| same(v))
            };
            let like: Vec<&Vec<String>> = all.iter().filter(like).collect();
            if like.is_empty() {
                return "nothing".into();
            }
            let b = like[random.below(like.len())].clone();
            let other = slot(root, &b).expect("it is there").clone();
            for (path, new) in [(&a, &other), (&b, &own)] {
                if let Some(place) = slot(root, path) {
                    *place = new.clone();
                }
            }
            format!("{shown_a} exchanged with {}", b.join("."))
        }
        1 => {
            put(&a, other);
            format!("{shown_b} copied to {shown_a}")
        }
        2 => {
            let unit = UNITS[random.below(UNITS.len())];
            let number = own.as_float().or(own.as_integer().map(|n| n as f64));
            let Some(number) = number else { return "nothing".into() };
            let place = slot(root, &a).expect("it is there");
            *place = Value::String(format!("{number} {unit}"));
            format!("{shown_a} in {unit}")
        }
        3 => {
            // Keys and strings are names.
            let names: Vec<String> = all
                .iter()
                .filter_map(|path| path.last())
                .filter(|key| key.parse::<usize>().is_err())
                .cloned()
                .collect();
            let name = names[random.below(names.len())].clone();
            let Value::String(_) = own else { return "nothing".into() };
            *slot(root, &a).expect("it is there") = Value::String(name.clone());
            format!("{shown_a} = \"{name}\"")
        }
        4 | 5 => {
            let (last, before) = a.split_last().expect("not the root");
            let Some(Value::Table(table)) = slot(root, before) else { return "nothing".into() };
            table.remove(last);
            if kind == 4 {
                return format!("no {shown_a}");
            }
            let name = b.last().expect("not the root").clone();
            table.insert(name.clone(), own);
            format!("{shown_a} is called {name}")
        }
        6 => {
            let (last, before) = a.split_last().expect("not the root");
            let Some(Value::Table(table)) = slot(root, before) else { return "nothing".into() };
            table.insert(format!("{last}_2"), own);
            format!("{shown_a} twice")
        }
        _ => {
            let (key, text) = TABLES[random.below(TABLES.len())];
            if let Value::Table(table) = root {
                table.insert(key.into(), value(text));
            }
            format!("{key} = {text}")
        }
    }
}

/// So many members; what is wrong with the way that the program takes them.
fn complaints(members: usize, seed: u64) -> Vec<String> {
    let bases = bases();
    let folder = TempDir::new().expect("a temporary folder");
    let mut random = Random::seeded(seed);
    let mut found = Vec::new();
    for member in 0..members {
        let mut root = bases[random.below(bases.len())].clone();
        let what: Vec<String> = (0..1 + random.below(3)).map(|_| mutate(&mut root, &mut random)).collect();
        let text = toml::to_string(&root).expect("TOML");
        let variant = Variant { what: format!("{member}: {}", what.join("; ")), text };
        if let Some(said) = complaint(folder.path(), &variant) {
            found.push(format!("{said}\n{}", variant.text));
            eprintln!("{said}");
        }
    }
    found
}

#[test]
fn a_case_changed_by_mistake_is_refused_by_check_or_runs() {
    let found = complaints(120, 47);
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
#[ignore = "takes minutes"]
fn many_cases_changed_by_mistake_are_refused_by_check_or_run() {
    let number = |name: &str, default: u64| {
        std::env::var(name).map_or(default, |text| text.parse().expect("a number"))
    };
    let found = complaints(number("MUTATIONS", 1000) as usize, number("MUTATIONS_SEED", 1));
    assert!(found.is_empty(), "{} complaints:\n{}", found.len(), found.join("\n"));
}
