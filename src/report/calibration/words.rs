//! Quality of a calibration, in sentences.

use super::super::format::{fixed, given, power, significant};
use super::finding::IMPROBABLE;
use crate::results::CalibrationResult;

/// Correlations above this are reported.
const TIED: f64 = 0.95;

/// Facts against numbers, what the data determine, the assignments, chance, trials.
pub(in crate::report) fn words(result: &CalibrationResult) -> Vec<String> {
    let mut words = vec![counted(result)];
    words.extend(misfit(result));
    words.push(determined(result));
    words.extend(tied(result));
    words.extend((!result.data.is_empty()).then(|| assignments(result)));
    if result.calibration.knowledge.freedom == 0 {
        words.push(
            "Nothing can be predicted from the others: the facts are no more than the numbers that are to be found.".into(),
        );
    }
    for (d, _) in
        result.data.iter().zip(&result.calibration.left_out.data).filter(|(d, _)| d.left_out_hz.is_none())
    {
        words.push(format!(
            "The other data do not predict {} Hz: they leave open what it depends on.",
            given(d.measured_hz)
        ));
    }
    for (r, _) in
        result.responses.iter().zip(&result.calibration.left_out.curves).filter(|(r, _)| r.left_out.is_none())
    {
        words.push(format!(
            "The other data do not predict the response {} at {}: they leave open what it depends on.",
            r.name, r.place
        ));
    }
    words.extend(chance(result));
    words.extend(trials(result));
    for n in result.numbers.iter().filter(|n| n.at_bound) {
        let name = &n.name;
        words.push(format!(
            "`{name}` is at its bound: the data pull beyond it, or its bounds say what they do not."
        ));
    }
    for d in result.data.iter().filter(|d| d.growth.is_some_and(|g| g <= 0.0)) {
        words.push(format!(
            "The mode beside {} Hz does not grow with the values found.",
            given(d.measured_hz)
        ));
    }
    if !result.calibration.best().fit.converged {
        words.push("The fit has not converged: its values are not the best ones.".into());
    }
    words
}

fn counted(result: &CalibrationResult) -> String {
    let expected = result.numbers.iter().filter(|n| n.deviation.is_some()).count();
    let components: usize = result.shapes().map(|shape| shape.components).sum();
    let lines: usize = result.responses.iter().map(|r| r.frequencies_hz.len()).sum();
    let parts = [
        (result.data.len(), "measured frequencies".to_string()),
        (
            result.shapes().count(),
            format!(
                "measured shapes (of {components} components together, each in the scale that fits it best)"
            ),
        ),
        (result.responses.len(), format!("measured responses (of {lines} lines together)")),
        (expected, "expected values".to_string()),
    ];
    let parts: Vec<String> =
        parts.iter().filter(|(n, _)| *n > 0).map(|(n, words)| format!("{n} {words}")).collect();
    let list = match parts.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => parts.concat(),
    };
    let (numbers, free) = (result.numbers.len(), result.calibration.knowledge.freedom);
    format!("{numbers} numbers were found from {list}: {free} facts are left over.")
}

fn misfit(result: &CalibrationResult) -> Option<String> {
    let known = &result.calibration.knowledge;
    let (reduced, probability) = (known.reduced_chi2?, known.chi2_probability?);
    let chi2 = significant(result.calibration.best().fit.chi2, 3);
    let stated = match probability < IMPROBABLE {
        true => format!(
            "so much has the probability {}. The model, or the stated deviation, is wrong by more than it says: trust the \
             scaled intervals, which take deviations {} times as large",
            power(probability),
            significant(reduced.sqrt(), 2)
        ),
        false => format!("so much or more has the probability {}", significant(probability, 2)),
    };
    Some(format!("χ² = {chi2}, {} a fact left over; {stated}.", significant(reduced, 3)))
}

fn determined(result: &CalibrationResult) -> String {
    let known = &result.calibration.knowledge;
    let (determined, all) = (known.determined(), known.singular_values.len());
    let condition = known.condition();
    let mut text = format!("The data determine {determined} of {all} combinations of the numbers");
    if condition.is_finite() && all > 1 {
        text += &format!(" (condition number {})", significant(condition, 3));
    }
    for (value, direction) in known.singular_values.iter().zip(&known.directions).skip(determined) {
        text += &format!(
            "; they leave open {} (known to {} of its unit)",
            combination(result, direction),
            if *value > 1e-9 { significant(1.0 / value, 2) } else { "any multiple".into() }
        );
    }
    if determined < all || all > 1 {
        text += ". Each number counts in units of its expected deviation, or of half the width of its bounds";
    }
    if determined == all && all > 1 {
        text += &format!("; the least known is {}", combination(result, &known.directions[all - 1]));
    }
    text + "."
}

/// `0.71 hub − 0.70 scale`, parts below a twentieth left out.
fn combination(result: &CalibrationResult, direction: &[f64]) -> String {
    let mut parts: Vec<(f64, &str)> =
        direction.iter().zip(&result.numbers).map(|(v, n)| (*v, n.name.as_str())).collect();
    parts.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
    let mut text = String::new();
    for (k, (v, name)) in parts.iter().filter(|(v, _)| v.abs() >= 0.05).enumerate() {
        let sign = match (k, *v < 0.0) {
            (0, false) => "",
            (0, true) => "−",
            (_, false) => " + ",
            (_, true) => " − ",
        };
        text += &format!("{sign}{} {name}", fixed(v.abs(), 2));
    }
    text
}

fn tied(result: &CalibrationResult) -> Vec<String> {
    let correlations = &result.calibration.knowledge.correlations;
    let n = result.numbers.len();
    let pairs = (0..n).flat_map(|i| (0..i).map(move |j| (j, i)));
    let tied = pairs.filter(|(j, i)| correlations[*i][*j].abs() > TIED);
    tied.map(|(j, i)| {
        let (a, b) = (&result.numbers[j].name, &result.numbers[i].name);
        format!(
            "`{a}` and `{b}` are hard to distinguish: their correlation is {}.",
            fixed(correlations[i][j], 3)
        )
    })
    .collect()
}

fn assignments(result: &CalibrationResult) -> String {
    let found = &result.calibration;
    let more = if found.all_counted { "" } else { "more than " };
    let mut text = format!(
        "{more}{} assignments of {} computed levels are plausible; the best {} on the linearised model were fitted",
        found.plausible,
        result.levels.len(),
        found.tried
    );
    if !found.all_searched {
        text += ", of those that a search cut short had found";
    }
    if !result.responses.is_empty() {
        text += &format!(
            " to the modes; with the responses computed there, the best {} of them were fitted to all, and are ranked by \
             the χ² of all",
            found.ranked.len()
        );
    }
    if let Some(second) = found.ranked.get(1) {
        text += &format!("; the next best has the weight {}", power(second.weight));
    }
    text + "."
}

fn chance(result: &CalibrationResult) -> Option<String> {
    let chance = result.calibration.chance?;
    let percent = |k: usize| significant(100.0 * chance.probability(k), 2);
    let alone = match (result.shapes().next().is_some(), !result.responses.is_empty()) {
        (_, true) => {
            "Chance is asked about the frequencies alone: shapes take no part in it, nor do responses, which are not matched \
             with one of many. "
        }
        (true, false) => "Chance is asked about the frequencies alone: shapes take no part in it. ",
        (false, false) => "",
    };
    Some(format!(
        "{alone}Of {} sets of as many frequencies drawn at random, evenly in their logarithm over the measured span, {} are matched as \
         well in their largest error and {} in χ², with the numbers free and the best assignment (linearised): a match as good \
         arises by chance with a probability of {} % and {} %.",
        chance.draws,
        chance.by_error,
        chance.by_chi2,
        percent(chance.by_error),
        percent(chance.by_chi2)
    ))
}

fn trials(result: &CalibrationResult) -> Option<String> {
    let trials = result.calibration.trials.as_ref()?;
    let each = result.numbers.iter().zip(&trials.covered).map(|(n, held)| format!("`{}` in {held}", n.name));
    Some(format!(
        "With synthetic data of the stated deviation the 95 % interval holds the truth of {} of {} trials; {} of their fits \
         converged (on a model quadratic in ln f near it, which is wrong by {} of the deviation at most).",
        each.collect::<Vec<_>>().join(", of "),
        trials.count,
        trials.converged,
        significant(trials.model_error, 2)
    ))
}
