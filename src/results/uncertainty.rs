//! Complex modes of samples of uncertain scalars: how probable instability is, and which scalar decides.

use super::explored::SweepMethod;
use super::file_name;
use crate::dataset::{Column, Describe, Dimension, Group, Table, Values, Variable, column};
use crate::linalg::c64;
use crate::numbers::{hertz, signed, significant};
use crate::stability::{ROUND_OFF, unstable};
use crate::sweep::{MapPoint, SampleModes};
use crate::uncertainty::{Distribution, Proportion, first_order, proportion, quantile, spearman};
use std::f64::consts::TAU;

/// The probabilities of the quantiles that are given.
const QUANTILES: [f64; 3] = [0.05, 0.5, 0.95];

/// An uncertain scalar, or several of one value.
#[derive(Debug, Clone, PartialEq)]
pub struct SampledScalar {
    /// The name the case gives it.
    pub name: String,
    /// The paths of its scalars.
    pub paths: Vec<String>,
    /// Name of the quantity with its symbol, for axes.
    pub label: String,
    /// Its SI unit; empty for a pure number.
    pub unit: String,
    /// Its distribution.
    pub distribution: Distribution,
    /// The value of the case itself.
    pub nominal: f64,
}

/// The samples of a study of uncertain scalars and their modes.
#[derive(Debug, Clone)]
pub struct UncertaintyStudy {
    /// The name the case gives it.
    pub name: String,
    /// The uncertain scalars.
    pub scalars: Vec<SampledScalar>,
    /// For each sample the value of each scalar \[SI\].
    pub values: Vec<Vec<f64>>,
    /// How they were drawn.
    pub sampling: &'static str,
    /// The seed.
    pub seed: usize,
    /// How often the interval of a probability contains it.
    pub confidence: f64,
    /// λ of the modes at the values of the case itself, by frequency \[1/s\].
    pub reference: Vec<c64>,
    /// For each sample λ of its modes, in the order of `reference`, then others.
    pub modes: Vec<SampleModes>,
    /// How it was solved.
    pub method: SweepMethod,
}

/// A sample that was measured on the full order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CheckedSample {
    /// Its index.
    pub sample: usize,
    /// The largest |Δλ|/|λ| of its modes.
    pub eigenvalue_error: f64,
}

/// Statistics of a mode over the samples in which it was found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModeStatistics {
    /// λ at the values of the case itself \[1/s\].
    pub reference: c64,
    /// How often it is unstable, of the samples in which it was found.
    pub unstable: Proportion,
    /// Mean of ω/2π \[Hz\].
    pub mean_hz: f64,
    /// Standard deviation of ω/2π \[Hz\].
    pub deviation_hz: f64,
    /// Quantiles 0.05, 0.5 and 0.95 of ω/2π \[Hz\].
    pub frequency_hz: [f64; 3],
    /// Quantiles 0.05, 0.5 and 0.95 of σ \[1/s\].
    pub growth_rate: [f64; 3],
}

/// How the largest growth rate of a sample depends on a scalar; not numbers where it does not vary.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScalarStatistics {
    /// Spearman's rank correlation, from −1 to 1.
    pub correlation: f64,
    /// First-order Sobol index: share of the variance that would vanish if the scalar were known.
    pub first_order: f64,
}

/// A study of uncertain scalars with its statistics.
#[derive(Debug, Clone)]
pub struct UncertaintyResult {
    /// Its samples.
    pub study: UncertaintyStudy,
    /// The samples that were measured on the full order.
    pub measured: Vec<CheckedSample>,
    /// The largest growth rate of each sample, and how many modes grow; none of samples without an answer.
    pub points: Vec<Option<MapPoint>>,
    /// How often a mode is unstable.
    pub unstable: Proportion,
    /// The same for each mode of the case itself.
    pub modes: Vec<ModeStatistics>,
    /// What each scalar decides.
    pub scalars: Vec<ScalarStatistics>,
}

impl UncertaintyResult {
    /// The statistics of a study.
    pub fn new(study: UncertaintyStudy, measured: Vec<CheckedSample>) -> Self {
        let found = |modes: &Vec<c64>| modes.iter().copied().filter(|z| !z.re.is_nan()).collect::<Vec<_>>();
        let point = |sample: &SampleModes| sample.as_ref().map(|modes| MapPoint::of(&found(modes)));
        let points: Vec<Option<MapPoint>> = study.modes.iter().map(point).collect();
        let answered = points.iter().flatten().count();
        let grows = points.iter().flatten().filter(|point| point.unstable > 0).count();
        let modes = (0..study.reference.len()).map(|k| mode_statistics(&study, k)).collect();
        let with_growth = |k: &usize| points[*k].is_some_and(|point| point.growth_rate.is_finite());
        let chosen: Vec<usize> = (0..points.len()).filter(with_growth).collect();
        let growth: Vec<f64> =
            chosen.iter().filter_map(|k| points[*k]).map(|point| point.growth_rate).collect();
        let scalar = |j: usize| {
            let values: Vec<f64> = chosen.iter().map(|k| study.values[*k][j]).collect();
            ScalarStatistics {
                correlation: spearman(&values, &growth),
                first_order: first_order(&values, &growth),
            }
        };
        let scalars = (0..study.scalars.len()).map(scalar).collect();
        let unstable = proportion(grows, answered, study.confidence);
        UncertaintyResult { measured, points, unstable, modes, scalars, study }
    }

    /// The largest growth rates of the samples that have one, ascending \[1/s\].
    pub fn growth_rates(&self) -> Vec<f64> {
        let all = self.points.iter().flatten().map(|point| point.growth_rate);
        let mut all: Vec<f64> = all.filter(|rate| rate.is_finite()).collect();
        all.sort_by(f64::total_cmp);
        all
    }

    /// The largest error of an eigenvalue that was measured on the full order.
    pub fn largest_error(&self) -> f64 {
        self.measured.iter().map(|own| own.eigenvalue_error).fold(0.0, f64::max)
    }

    /// Samples whose verdict an error as large as the largest that was measured could change: σ of the mode that grows most is within
    /// |Δλ| of what counts as growth ([`ROUND_OFF`]). One that is zero does not grow.
    pub fn undecided(&self) -> usize {
        let error = self.largest_error();
        let near = |point: &&MapPoint| {
            let size = TAU * point.frequency_hz.hypot(point.growth_rate / TAU);
            size > 0.0 && (point.growth_rate - ROUND_OFF * size).abs() <= error * size
        };
        self.points.iter().flatten().filter(near).count()
    }

    /// The modes, one a row.
    pub(crate) fn mode_table(&self) -> Table<'static> {
        Table::of("modes", "mode", &mode_columns(), &self.modes)
    }

    /// The scalars, one a row, in the order of the case.
    pub(crate) fn scalar_table(&self) -> Table<'static> {
        let rows: Vec<ScalarRow> =
            self.study.scalars.iter().cloned().zip(self.scalars.iter().copied()).collect();
        Table::of("scalars", "scalar", &scalar_columns(), &rows)
    }

    /// The samples, one a row.
    fn sample_table(&self) -> Table<'_> {
        let part = |of: fn(&MapPoint) -> f64| move |point: &Option<MapPoint>| point.as_ref().map(of);
        let columns = [
            column("growth_rate", "1/s", "the largest σ of all modes in the band", part(|p| p.growth_rate)),
            column("frequency_hz", "Hz", "ω/2π of that mode", part(|p| p.frequency_hz)),
            column("unstable", "1", "how many modes grow", |point: &Option<MapPoint>| {
                point.map(|point| point.unstable as usize)
            }),
        ];
        let mut table = Table::of("samples", "sample", &columns, &self.points).long();
        let rows = table.rows.clone();
        for (j, scalar) in self.study.scalars.iter().enumerate() {
            let values = self.study.values.iter().map(|sample| sample[j]).collect();
            let (path, unit) = (scalar.paths[0].clone(), scalar.unit.clone());
            let column = Variable::reals(path, unit, "value of the scalar", vec![rows.clone()], values);
            table.columns.insert(j, column);
        }
        let modes = Dimension::numbered("mode", self.study.reference.len());
        let none = vec![c64::new(f64::NAN, f64::NAN); modes.length];
        let of = move |k: usize| match &self.study.modes[k] {
            Some(all) => all[..none.len()].to_vec(),
            None => none.clone(),
        };
        let story = "λ = σ + iω of each mode of the case; not a number where a sample does not have it";
        let values = Values::ComplexRows(Box::new(of));
        table.field(Variable::new("eigenvalue", "1/s", story, vec![rows, modes], values))
    }

    fn group(&self) -> Group<'_> {
        let study = &self.study;
        let file = file_name("uncertainty", &study.name);
        let unstable = &self.unstable;
        let growth = self.growth_rates();
        let measured = [
            column("sample", "1", "number of the sample, from 1", |own: &CheckedSample| own.sample + 1),
            column("eigenvalue_error", "1", "largest estimated |Δλ|/|λ| there", |own: &CheckedSample| {
                own.eigenvalue_error
            }),
        ];
        let limits = |key: &'static str, story: &'static str, values: [f64; 2]| {
            Variable::reals(key, "1", story, vec![Dimension::limits()], values.to_vec())
        };
        let quantiles = QUANTILES.map(|p| quantile(&growth, p)).to_vec();
        let quantiles =
            Variable::reals("growth_rate", "1/s", "quantiles of the largest σ", vec![levels()], quantiles);
        Group::new(&*study.name, "complex modes of samples of uncertain scalars")
            .value("drawn", "1", "samples", self.points.len())
            .value("answered", "1", "samples with an answer", unstable.of)
            .value("unstable_samples", "1", "samples in which a mode grows", unstable.count)
            .value("probability", "1", "P, their share of those with an answer", unstable.share)
            .with(limits("probability_limits", "confidence interval of P", unstable.limits))
            .value("confidence", "1", "how often the interval contains P, at least", study.confidence)
            .value(
                "undecided",
                "1",
                "samples whose verdict the error at full order could change",
                self.undecided(),
            )
            .with(quantiles)
            .value("sampling", "text", "how the samples were drawn", study.sampling)
            .value("seed", "1", "the same seed gives the same samples", study.seed)
            .group(study.method.group())
            .table(self.mode_table().file(format!("{file}_modes")))
            .table(self.scalar_table().file(format!("{file}_scalars")))
            .table(Table::of("full_order_sample", "measured", &measured, &self.measured))
            .table(self.sample_table().file(file))
    }
}

impl Describe for UncertaintyResult {
    fn describe(&self) -> Group<'_> {
        Group::new("", "").list("uncertainty", vec![self.group()])
    }
}

/// The probabilities of [`QUANTILES`].
fn levels() -> Dimension {
    Dimension::named("quantile", &["0.05", "0.5", "0.95"])
}

fn mode_statistics(study: &UncertaintyStudy, k: usize) -> ModeStatistics {
    let found: Vec<c64> =
        study.modes.iter().flatten().map(|modes| modes[k]).filter(|z| !z.re.is_nan()).collect();
    let sorted = |part: fn(&c64) -> f64| {
        let mut values: Vec<f64> = found.iter().map(part).collect();
        values.sort_by(f64::total_cmp);
        values
    };
    let (frequencies, rates) = (sorted(|z| z.im / TAU), sorted(|z| z.re));
    let n = found.len() as f64;
    let mean_hz = frequencies.iter().sum::<f64>() / n;
    let squares = frequencies.iter().map(|hz| (hz - mean_hz).powi(2)).sum::<f64>();
    ModeStatistics {
        reference: study.reference[k],
        unstable: proportion(found.iter().filter(|z| unstable(**z)).count(), found.len(), study.confidence),
        mean_hz,
        deviation_hz: (squares / (n - 1.0)).sqrt(),
        frequency_hz: QUANTILES.map(|p| quantile(&frequencies, p)),
        growth_rate: QUANTILES.map(|p| quantile(&rates, p)),
    }
}

/// A share in percent.
fn percent(share: f64) -> String {
    significant(100.0 * share, 3)
}

fn mode_columns() -> Vec<Column<ModeStatistics>> {
    type Row = ModeStatistics;
    vec![
        column("case_frequency_hz", "Hz", "ω/2π at the values of the case", |m: &Row| m.reference.im / TAU)
            .shown("f of the case [Hz]", |m| hertz(m.reference.im / TAU, 1)),
        column("case_growth_rate", "1/s", "σ at the values of the case", |m: &Row| m.reference.re),
        column("found", "1", "samples that have the mode", |m: &Row| m.unstable.of),
        column("probability", "1", "share of these in which it grows", |m: &Row| m.unstable.share)
            .shown("P(unstable) [%]", |m| percent(m.unstable.share)),
        column("probability_limits", "1", "confidence interval of that share", |m: &Row| m.unstable.limits)
            .along(Dimension::limits())
            .shown("interval [%]", |m| {
                let [low, high] = m.unstable.limits.map(percent);
                format!("{low} to {high}")
            }),
        column("frequency_mean_hz", "Hz", "mean of ω/2π", |m: &Row| m.mean_hz)
            .shown("mean f [Hz]", |m| hertz(m.mean_hz, 1)),
        column("frequency_deviation_hz", "Hz", "standard deviation of ω/2π", |m: &Row| m.deviation_hz)
            .shown("deviation [Hz]", |m| significant(m.deviation_hz, 3)),
        column("frequency_hz", "Hz", "quantiles of ω/2π", |m: &Row| m.frequency_hz).along(levels()),
        column("growth_rate", "1/s", "quantiles of σ", |m: &Row| m.growth_rate)
            .along(levels())
            .shown("σ, 5 to 95 % [1/s]", |m| {
                format!("{} to {}", signed(m.growth_rate[0], 2), signed(m.growth_rate[2], 2))
            }),
    ]
}

/// A scalar with its statistics.
type ScalarRow = (SampledScalar, ScalarStatistics);

fn scalar_columns() -> Vec<Column<ScalarRow>> {
    type Row = ScalarRow;
    let normal = |of: &SampledScalar, k: usize| of.distribution.normal.map(|normal| normal[k]);
    vec![
        column("name", "text", "name of the uncertain scalar", |(of, _): &Row| of.name.clone())
            .shown("scalar", |(of, _)| of.name.clone()),
        column("paths", "text", "paths of its scalars", |(of, _): &Row| of.paths.join(", ")),
        column("unit", "text", "its unit; empty of a pure number", |(of, _): &Row| of.unit.clone()),
        column("between", "unit", "its bounds", |(of, _): &Row| of.distribution.between)
            .along(Dimension::limits()),
        column("expected", "unit", "expected value of a normal distribution", move |(of, _): &Row| normal(of, 0)),
        column("deviation", "unit", "its standard deviation, of ln x with `log`", move |(of, _): &Row| {
            normal(of, 1)
        }),
        column("log", "1", "whether its logarithm is distributed so", |(of, _): &Row| of.distribution.log),
        column("nominal", "unit", "the value of the case", |(of, _): &Row| of.nominal),
        column("correlation", "1", "ρ, Spearman's rank correlation with the largest σ", |(_, s): &Row| {
            s.correlation
        })
        .shown("rank correlation with growth", |(_, s)| signed(s.correlation, 2)),
        column(
            "first_order",
            "1",
            "S, first-order Sobol index: share of the variance of the largest σ that would vanish if the scalar were known",
            |(_, s): &Row| s.first_order,
        )
        .shown("share of the variance [%]", |(_, s)| significant(100.0 * s.first_order.max(0.0), 2)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};

    #[test]
    fn modes_and_samples_are_counted_where_they_were_found() {
        let nan = c64::new(f64::NAN, f64::NAN);
        let z = |re: f64, hz: f64| c64::new(re, TAU * hz);
        let modes = vec![
            Some(vec![z(1.0, 100.0), z(-2.0, 200.0)]),
            Some(vec![z(-1.0, 110.0), nan]),
            // A mode that the case itself does not have.
            Some(vec![z(-3.0, 120.0), nan, z(5.0, 300.0)]),
            None,
            Some(vec![z(-3.0, 130.0), z(-1e-3, 200.0)]),
        ];
        let distribution = Distribution { between: [0.0, 5.0], normal: None, log: false };
        let study = UncertaintyStudy {
            name: "all".into(),
            scalars: vec![SampledScalar {
                name: "mu".into(),
                paths: vec!["contact.a.friction.mu0".into()],
                label: "μ".into(),
                unit: String::new(),
                distribution,
                nominal: 1.0,
            }],
            values: (0..5).map(|k| vec![f64::from(k)]).collect(),
            sampling: "random",
            seed: 1,
            confidence: 0.95,
            reference: vec![z(-1.0, 105.0), z(-1.0, 200.0)],
            modes,
            method: SweepMethod::Whole,
        };
        let measured = vec![CheckedSample { sample: 0, eigenvalue_error: 1e-6 }];
        let result = UncertaintyResult::new(study, measured);
        assert_eq!((result.unstable.count, result.unstable.of), (2, 4));
        let [first, second] = [0, 1].map(|k| result.modes[k]);
        assert_eq!((first.unstable.count, first.unstable.of, first.mean_hz), (1, 4, 115.0));
        assert_eq!((second.unstable.count, second.unstable.of), (0, 2));
        assert_eq!(first.frequency_hz[1], 115.0);
        assert!(within((first.deviation_hz - (500.0_f64 / 3.0).sqrt()).abs(), 1e-12, RoundOff));
        assert_eq!(result.growth_rates(), [-1.0, -1e-3, 1.0, 5.0]);
        // An error of 1e-6 of 2π 200 Hz is more than 1e-3 1/s.
        assert_eq!(result.undecided(), 1);
        // Eigenvalues that are zero do not grow, however small the error is.
        for eigenvalue_error in [0.0, 1e-31, 1e-16, 1e-6] {
            let measured = vec![CheckedSample { sample: 0, eigenvalue_error }];
            let points = vec![Some(MapPoint::of(&[c64::new(0.0, 0.0)])); 282];
            assert_eq!(UncertaintyResult { measured, points, ..result.clone() }.undecided(), 0);
        }
    }
}
