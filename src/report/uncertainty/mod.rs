//! Uncertain scalars: how probable instability is, of which mode, and which scalar decides.

mod growth;
mod modes;
mod scalars;
mod words;

use super::finding::{Finding, FindingClass};
use super::format::{given, power, significant};
use super::section::{Display, ReportSection};
use super::table::ReportTable;
use crate::results::{RunResults, SweepMethod, UncertaintyResult};
use words::{file, level, percent};

/// Every study of uncertain scalars.
pub(super) fn sections(results: &RunResults) -> Vec<ReportSection> {
    let section = |result: &UncertaintyResult| {
        ReportSection::new(format!("Uncertainty: {}", result.study.name))
            .findings([finding(result)])
            .pictures(modes::picture(result))
            .pictures(growth::picture(result))
            .pictures(scalars::picture(result))
            .tables(Display::Titled, [mode_table(result), scalar_table(result)])
            .words([method(result)])
    };
    results.all::<UncertaintyResult>().into_iter().map(section).collect()
}

/// How probable it is that a mode grows.
fn finding(result: &UncertaintyResult) -> Finding {
    let (unstable, study) = (&result.unstable, &result.study);
    let without = result.points.len() - unstable.of;
    let confidence = level(result);
    let [low, high] = unstable.limits.map(percent);
    let scalars = match study.scalars.len() {
        1 => "one uncertain scalar".to_string(),
        many => format!("{many} uncertain scalars"),
    };
    let mut words = format!("Uncertainty {}: ", study.name);
    words += &match (unstable.count, unstable.of) {
        (_, 0) => "no sample has an answer.".to_string(),
        (0, all) => format!(
            "none of {all} samples of {scalars} has an unstable mode: the probability is below {high} ({confidence} confidence)."
        ),
        (count, all) => format!(
            "a mode is unstable in {count} of {all} samples of {scalars}, with a probability of {} ({confidence} confidence: {low} to {high}).",
            percent(unstable.share)
        ),
    };
    if without > 0 && unstable.of > 0 {
        words += &format!(" Samples without an answer: {without}.");
    }
    let good = unstable.count == 0 && without == 0;
    Finding::new(if good { FindingClass::Good } else { FindingClass::Attention }, words)
}

/// The modes that are unstable in some sample.
fn mode_table(result: &UncertaintyResult) -> ReportTable {
    let caption = format!("Uncertainty {}: modes that are unstable in some samples", result.study.name);
    let mut table = ReportTable::of(caption, &result.mode_table().file(file(result, "_modes")), true);
    table.alarming = true;
    let grows = result.modes.iter().map(|mode| mode.unstable.count > 0);
    let rows = table.rows.iter_mut().zip(grows.clone());
    rows.for_each(|(row, grows)| row.marked = grows);
    let mut grows = grows;
    table.rows.retain(|_| grows.next().unwrap_or(true));
    if table.rows.is_empty() {
        table.notes.push(match result.unstable.count {
            0 => "No mode is unstable in any sample.".into(),
            _ => {
                "The modes that are unstable in samples are none of the case's own: those are stable in all."
                    .into()
            }
        });
    }
    let others = result.study.modes.iter().flatten().map(|all| all.len() - result.study.reference.len());
    let others = others.filter(|count| *count > 0).count();
    if others > 0 {
        table
            .notes
            .push(format!("{others} samples have modes in the band that the case itself does not have."));
    }
    table
}

/// What each scalar decides.
fn scalar_table(result: &UncertaintyResult) -> ReportTable {
    let caption = format!("Uncertainty {}: what the largest growth rate depends on", result.study.name);
    let mut table = ReportTable::of(caption, &result.scalar_table().file(file(result, "_scalars")), false);
    let error = significant(100.0 / (result.unstable.of as f64).sqrt(), 1);
    table.notes.push(format!(
        "Share of the variance: first-order Sobol index, with a standard error of about {error} %. The rest is due to scalars acting together."
    ));
    table
}

/// How it was solved, and how exactly.
fn method(result: &UncertaintyResult) -> String {
    let study = &result.study;
    let method = match study.method {
        SweepMethod::Reduced(dimension) => {
            format!("One reduced model of {dimension} degrees of freedom served every sample.")
        }
        SweepMethod::Whole => {
            "A scalar changes the structure or the contact's directions: every sample was a whole analysis."
                .into()
        }
    };
    let undecided = match result.undecided() {
        0 => "no verdict depends on it".to_string(),
        count => format!("the verdict of {count} samples depends on it"),
    };
    let sampling = match study.sampling {
        "random" => "random samples",
        _ => "a Latin hypercube",
    };
    format!(
        "{method} The largest error of an eigenvalue, measured on the full order at {} samples, is {}; {undecided}. The samples are {sampling} of seed {}.",
        result.measured.len(),
        power(result.largest_error()),
        given(study.seed as f64)
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::sample;
    use crate::results::UncertaintyStudy;

    #[test]
    fn the_probability_is_given_with_its_interval() {
        let results = sample::rig();
        let found = results.get::<UncertaintyResult>().unwrap();
        let mut study = found.study.clone();
        study.modes[39] = None;
        let result = &UncertaintyResult::new(study, found.measured.clone());
        let found = finding(result);
        assert_eq!(found.class, FindingClass::Attention);
        for part in
            ["of 39 samples of 2 uncertain scalars", "95 % confidence", "Samples without an answer: 1."]
        {
            assert!(found.words.contains(part), "{part}: {}", found.words);
        }
        let grow = result.modes.iter().filter(|mode| mode.unstable.count > 0).count();
        assert!(grow > 1 && mode_table(result).rows.len() == grow);
        let measured = format!("measured on the full order at {} samples", result.measured.len());
        assert!(method(result).contains(&measured), "{}", method(result));
        let mut none = result.study.clone();
        none.modes.iter_mut().flatten().flatten().for_each(|z| z.re = -1.0);
        let none = UncertaintyResult::new(
            UncertaintyStudy { modes: none.modes[..39].to_vec(), values: none.values[..39].to_vec(), ..none },
            Vec::new(),
        );
        let found = finding(&none);
        assert!(
            found.class == FindingClass::Good && found.words.contains("is below 9.03 %"),
            "{}",
            found.words
        );
    }
}
