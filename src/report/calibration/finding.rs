//! Whether the calibrated model explains the measurement, and how far it still is from it.

use crate::report::finding::{Finding, FindingClass};
use crate::report::format::{fixed, power, significant};
use crate::results::CalibrationResult;

/// A misfit, or a match by chance, of this probability is reported.
pub(super) const IMPROBABLE: f64 = 0.05;

/// By the probability of χ²: below 5 % the model or the stated deviations are wrong.
pub(super) fn finding(result: &CalibrationResult) -> Finding {
    let known = &result.calibration.knowledge;
    let (mut class, mut words) = match known.chi2_probability {
        Some(probability) if probability < IMPROBABLE => (
            FindingClass::Bad,
            format!(
                "Calibration: the model, or a stated deviation, is wrong: a misfit as large has the probability {}.",
                power(probability)
            ),
        ),
        Some(probability) => (
            FindingClass::Good,
            format!(
                "Calibration: the model explains the measurement within its stated deviations; a misfit as large has the \
                 probability {}.",
                significant(probability, 2)
            ),
        ),
        None => (
            FindingClass::Attention,
            "Calibration: there are no more facts than numbers, so that the match proves nothing.".into(),
        ),
    };
    if let Some(after) = result.largest_percent(|datum| datum.after_hz) {
        let before = result.largest_percent(|datum| datum.before_hz);
        let before = before.map_or(String::new(), |before| format!(" ({} % before)", fixed(before, 2)));
        let of = result.data.iter().max_by(|a, b| {
            let size =
                |d: &crate::results::CalibratedDatum| d.error_percent(d.after_hz).map_or(0.0, f64::abs);
            size(a).total_cmp(&size(b))
        });
        let mode = of.map_or(String::new(), |datum| format!(", at {}", datum.level));
        words += &format!(" The largest error of a frequency is {} %{mode}{before}.", fixed(after, 2));
    }
    let apart = result.responses.iter().map(|r| r.apart_db(&r.after)).reduce(f64::max);
    if let Some(apart) = apart {
        words += &format!(" The responses differ by {} dB at most (r.m.s. of each).", fixed(apart, 2));
    }
    let mut doubt = |words_of_doubt: String| {
        class = class.min(FindingClass::Attention);
        words += &words_of_doubt;
    };
    let (determined, all) = (known.determined(), known.singular_values.len());
    if determined < all {
        doubt(format!(" The data determine {determined} of {all} combinations of the numbers."));
    }
    let bound = result.numbers.iter().filter(|n| n.at_bound).count();
    if bound > 0 {
        doubt(format!(" {bound} of {} numbers ended at a bound.", result.numbers.len()));
    }
    let chance = result.calibration.chance.map(|chance| chance.probability(0));
    if let Some(chance) = chance.filter(|chance| *chance > IMPROBABLE) {
        let percent = significant(100.0 * chance, 2);
        doubt(format!(" An error as small arises by chance with a probability of {percent} %."));
    }
    if !result.calibration.best().fit.converged {
        doubt(" The fit has not converged.".into());
    }
    Finding::new(class, words)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::sample;

    #[test]
    fn the_probability_of_the_misfit_decides_and_doubts_are_named() {
        let mut result = sample::rig().take::<CalibrationResult>().unwrap();
        // The second combination is known to 2.5 of its unit.
        result.calibration.knowledge.singular_values = vec![30.0, 0.4];
        let found = finding(&result);
        assert!(found.words.contains("1 of 2 numbers ended at a bound"), "{}", found.words);
        assert!(found.words.contains("determine 1 of 2"), "{}", found.words);
        result.calibration.knowledge.chi2_probability = Some(1e-9);
        assert_eq!(finding(&result).class, FindingClass::Bad);
        result.calibration.knowledge.chi2_probability = None;
        assert_eq!(finding(&result).class, FindingClass::Attention);
        result.calibration.knowledge.chi2_probability = Some(0.4);
        assert_eq!(finding(&result).class, FindingClass::Attention);
        result.numbers.iter_mut().for_each(|n| n.at_bound = false);
        result.calibration.knowledge.singular_values.fill(1e9);
        result.calibration.chance = None;
        result.calibration.ranked.iter_mut().for_each(|ranked| ranked.fit.converged = true);
        let found = finding(&result);
        assert_eq!(found.class, FindingClass::Good, "{}", found.words);
    }
}
