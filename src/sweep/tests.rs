use super::*;
use crate::bounds::{Origin::*, within};
use crate::contact::{Coulomb, NormalLaw, SlidingLaw};
use crate::equilibrium::samples::*;
use crate::equilibrium::{SteadyOptions, solve_steady};
use crate::modal::{ModesWanted, RealModes, compute};
use crate::stability::complex_modes;
use crate::system::{Closing, System};
use std::f64::consts::TAU;

/// Whole analyses of small systems, one a place.
struct Members<F> {
    system: F,
    band: [f64; 2],
}

impl<F: Fn(&[f64]) -> System + Sync> Members<F> {
    fn analyse(&self, at: &[f64]) -> Result<Vec<crate::stability::ComplexMode>> {
        let system = (self.system)(at);
        let steady = solve_steady(&system, &SteadyOptions::default(), &())?;
        let real: RealModes = compute(&system.structure, ModesWanted::Count(system.n_dofs()), &())?.0;
        Ok(complex_modes(&system, &steady, &real, self.band, &())?.modes)
    }
}

impl<F: Fn(&[f64]) -> System + Sync> SweepProblem for Members<F> {
    fn modes(&self, at: &[f64]) -> Result<Modes> {
        let modes = self.analyse(at)?;
        let n = modes.first().map_or(0, |m| m.right.len());
        Ok(Modes {
            eigenvalues: modes.iter().map(|m| m.eigenvalue).collect(),
            vectors: Mat::from_fn(n, modes.len(), |i, j| modes[j].right[i]),
        })
    }
}

fn axis(from: f64, to: f64, points: usize) -> Axis {
    Axis { from, to, points, log: false }
}

#[test]
fn two_dof_critical_values_are_located_to_nine_digits() {
    let by_friction = Members { system: |p: &[f64]| two_dof(0.5, 1.0, p[0]), band: [0.0, 1.0] };
    let found = sweep(&by_friction, &axis(0.1, 0.9, 9), 1e-11, &()).unwrap();
    assert_eq!(found.critical.len(), 1, "{:?}", found.critical);
    let onset = found.critical[0];
    assert!(
        within((onset.value / 0.625 - 1.0).abs(), 1e-9, Tolerance)
            && onset.rises
            && onset.kind == CriticalKind::Merging
    );
    assert!(within(onset.uncertainty, 1e-11, Stated));
    assert_eq!(found.branches.len(), 2);
    let by_stiffness = Members { system: |p: &[f64]| two_dof(0.5, p[0], 0.4), band: [0.0, 1.0] };
    let found = sweep(&by_stiffness, &axis(3.0, 1.0, 21), 1e-11, &()).unwrap();
    let values: Vec<f64> = found.critical.iter().map(|c| c.value).collect();
    assert_eq!(values.len(), 2, "{:?}", found.critical);
    assert!(
        within((values[0] / 2.5 - 1.0).abs(), 1e-9, Tolerance)
            && within((values[1] / 1.3 - 1.0).abs(), 1e-9, Tolerance),
        "{values:?}"
    );
    assert!(found.critical[0].rises && !found.critical[1].rises, "a sweep downwards meets them in its order");
}

#[test]
fn onsets_of_the_literature() {
    // Hoffmann et al. (2002): k₁₁ = 23.25, k₁₂ = 3.8971, k₂₂ = 18.75, k₃ = 11.
    let hoffmann = |p: &[f64]| {
        let k = [[23.25, 3.8971], [3.8971, 7.75]];
        let law = SlidingLaw::new(
            NormalLaw { bilateral: true, ..NormalLaw::linear(11.0) },
            Coulomb { mu0: p[0] },
            0.0,
        );
        let touch = point(0.0, 1.0, vector(&[(1, 1.0)]), vector(&[(0, 1.0)]), Default::default());
        System {
            structure: structure(2, |i, j| f64::from(i == j), |i, j| k[i][j]),
            pairs: vec![pair(vec![touch], law, Closing::Approach(1.0), 1.0)],
            load: vec![0.0; 2],
            prestress: None,
            coupling: None,
        }
    };
    let found =
        sweep(&Members { system: hoffmann, band: [0.0, 10.0] }, &axis(0.1, 0.7, 7), 1e-10, &()).unwrap();
    assert!(within((found.critical[0].value - 0.472377).abs(), 5e-7, Reference));
    // Sinou & Jézéquel (2007): unequal damping brings the onset down from 0.2917 to 0.1413.
    let sinou = |p: &[f64]| {
        let omega = [200.0 * std::f64::consts::PI, 150.0 * std::f64::consts::PI];
        let eta = [0.02, 0.001];
        let touch = |d: usize| {
            let normal = NormalLaw {
                stiffness: omega[d] * omega[d],
                cubic_stiffness: 0.0,
                damping: eta[d] * omega[d],
                bilateral: true,
            };
            let tangent = if d == 0 { vector(&[(1, -1.0)]) } else { vector(&[(0, 1.0)]) };
            let touch = point(0.0, 1.0, vector(&[(d, 1.0)]), tangent, Default::default());
            pair(
                vec![touch],
                SlidingLaw::new(normal, Coulomb { mu0: p[0] }, 0.0),
                Closing::Approach(0.0),
                1.0,
            )
        };
        System {
            structure: structure(2, |i, j| f64::from(i == j), |i, j| if i == j { 1e-9 } else { 0.0 }),
            pairs: vec![touch(0), touch(1)],
            load: vec![1.0, 1.0],
            prestress: None,
            coupling: None,
        }
    };
    let found =
        sweep(&Members { system: sinou, band: [1.0, 500.0] }, &axis(0.02, 0.4, 11), 1e-10, &()).unwrap();
    assert_eq!(found.critical.len(), 1);
    assert!(within((found.critical[0].value - 0.141296).abs(), 2e-6, Reference), "{:?}", found.critical);
    assert_eq!(found.critical[0].kind, CriticalKind::Growth);
}

/// Two undamped oscillators, ω² the eigenvalues of [1 + p, c; c, 2 − p], which meet at p = ½.
struct Oscillators {
    coupling: f64,
}

impl SweepProblem for Oscillators {
    fn modes(&self, at: &[f64]) -> Result<Modes> {
        let (half, c) = (0.5 * (2.0 * at[0] - 1.0), self.coupling);
        let root = half.hypot(c);
        let angle = 0.5 * f64::atan2(c, half);
        let z = |x: f64| c64::new(x, 0.0);
        // At the lower of the two the shape is (−sin, cos), at the upper (cos, sin).
        let vectors = faer::mat![[z(-angle.sin()), z(angle.cos())], [z(angle.cos()), z(angle.sin())]];
        let eigenvalues = [1.5 - root, 1.5 + root].map(|w| c64::new(0.0, w.sqrt())).to_vec();
        Ok(Modes { eigenvalues, vectors })
    }
}

#[test]
fn branches_pass_through_a_crossing_and_turn_away_at_an_avoided_one() {
    let follow = |coupling: f64| sweep(&Oscillators { coupling }, &axis(0.0, 1.0, 12), 1e-8, &()).unwrap();
    let through = follow(0.0);
    let [a, b] = &through.branches[..] else { panic!("two branches") };
    let last = through.values.len() - 1;
    assert!(a.at(0).unwrap().im < b.at(0).unwrap().im && a.at(last).unwrap().im > b.at(last).unwrap().im);
    assert!(a.lowest_mac > 0.999);
    assert_eq!(through.interactions.len(), 1);
    let interaction = through.interactions[0];
    assert!(
        within((interaction.value - 0.5).abs(), 1e-6, Tolerance)
            && within(interaction.distance, 1e-6, Tolerance)
    );
    assert_eq!(interaction.kind, InteractionKind::Crossing);
    let away = follow(0.005);
    let [a, b] = &away.branches[..] else { panic!("two branches") };
    let last = away.values.len() - 1;
    assert!((0..=last).all(|k| a.at(k).unwrap().im < b.at(k).unwrap().im));
    assert!(last > 11, "the step is refined where the shapes turn");
    assert!(a.lowest_mac > 0.8);
    let interaction = away.interactions[0];
    assert_eq!(interaction.kind, InteractionKind::Veering);
    // |ω₂ − ω₁|/ω₂ with ω² = 1.5 ± 0.005.
    let exact = 1.0 - (1.495f64 / 1.505).sqrt();
    assert!(
        within((interaction.value - 0.5).abs(), 1e-3, Tolerance)
            && within((interaction.distance / exact - 1.0).abs(), 1e-6, Tolerance)
    );
}

#[test]
fn the_boundary_of_a_map_lies_on_the_closed_form() {
    let problem = Members { system: |p: &[f64]| two_dof(0.5, p[1], p[0]), band: [0.0, 1.0] };
    let axes = [axis(0.2, 0.8, 9), axis(0.8, 3.0, 8)];
    let (points, unanswered) = map(&problem, &axes, &mut |_, _| Ok(()), &()).unwrap();
    assert!(unanswered.is_empty() && points.len() == 72);
    let closed = |mu: f64, k_n: f64| ((1.5 - k_n) / 2.0).powi(2) + 0.5 * (0.5 - mu * k_n);
    for (k, p) in points.iter().enumerate() {
        let (mu, k_n) = (axes[0].value(k % 9), axes[1].value(k / 9));
        let exact = closed(mu, k_n);
        if exact.abs() > 1e-9 {
            assert_eq!(p.unstable > 0, exact < 0.0, "{mu} {k_n}");
        }
        if exact < 0.0 {
            // λ² = −a ± i√−d: the growth rate is the real part of its root.
            let root = c64::new(-0.5 * (2.5 + k_n), (-exact).sqrt()).sqrt();
            assert!(
                within((p.growth_rate - root.re).abs(), 1e-9 * root.norm(), Tolerance),
                "{} {root}",
                p.growth_rate
            );
            assert!(within((p.frequency_hz - root.im / TAU).abs(), 1e-9, Tolerance));
        }
    }
    let line = boundary(&problem, &axes, &points, 1e-9, &()).unwrap();
    assert!(line.points.len() > 8 && !line.lines.is_empty());
    for [mu, k_n] in &line.points {
        assert!(within(closed(*mu, *k_n).abs(), 1e-8, Tolerance), "{mu} {k_n}");
    }
    assert_eq!(line.lines.iter().map(Vec::len).sum::<usize>(), line.points.len());
}

#[test]
fn a_resumed_map_and_another_number_of_threads_give_the_same_bits() {
    let problem = Members { system: |p: &[f64]| two_dof(0.5, p[1], p[0]), band: [0.0, 1.0] };
    let axes = [axis(0.2, 0.8, 8), Axis { from: 0.8, to: 3.0, points: 8, log: true }];
    let run = |threads: usize, store: &Stored| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut seen = 0;
        let mut record = |first: usize, chunk: &[MapPoint]| {
            assert_eq!(first, seen);
            seen += chunk.len();
            Ok(())
        };
        let answered = Answered::new(&problem, store);
        let points = pool.install(|| map(&answered, &axes, &mut record, &()).unwrap().0);
        let line = pool.install(|| boundary(&answered, &axes, &points, 1e-6, &()).unwrap());
        (points, line)
    };
    let all = Stored::default();
    let whole = run(1, &all);
    assert_eq!(whole, run(3, &Stored::default()));
    let some = all.0.into_inner().unwrap().into_iter().take(37).collect();
    assert_eq!(whole, run(2, &Stored(std::sync::Mutex::new(some))));
}

#[test]
fn a_place_without_an_answer_leaves_a_gap_in_a_map_and_in_a_sweep() {
    let problem = Members {
        system: |p: &[f64]| {
            let mut system = two_dof(0.5, 1.0, 0.4);
            system.pairs[0].sliding_velocity = p[0];
            system
        },
        band: [0.0, 1.0],
    };
    let axes = [axis(-1.0, 1.0, 3), axis(0.0, 1.0, 2)];
    let (points, unanswered) = map(&problem, &axes, &mut |_, _| Ok(()), &()).unwrap();
    assert!(
        unanswered.len() == 2 && unanswered[0].0 == 1 && unanswered[0].1.to_string().contains("velocity")
    );
    assert!(points[1].growth_rate.is_nan() && points[0].growth_rate.is_finite());
    let found = sweep(&problem, &axes[0], 1e-6, &()).unwrap();
    let [(1, why)] = &found.unanswered[..] else { panic!("{:?}", found.unanswered) };
    assert!(why.to_string() == unanswered[0].1.to_string() && found.answered().eq([-1.0, 1.0]));
}

/// Two oscillators of which the first grows beyond ½, without an answer inside some ranges.
struct Gaps(Vec<[f64; 2]>);

impl SweepProblem for Gaps {
    fn modes(&self, at: &[f64]) -> Result<Modes> {
        if self.0.iter().any(|[low, high]| (*low..=*high).contains(&at[0])) {
            return Err(crate::error::Error::analysis("modes", format!("none at {}", at[0]), "Take others"));
        }
        let mut modes = Oscillators { coupling: 0.005 }.modes(at)?;
        modes.eigenvalues[0].re += at[0] - 0.52;
        Ok(modes)
    }
}

/// A sweep is that of the stretches that have an answer, in which a critical value and an interaction are or are not.
#[test]
fn a_sweep_with_gaps_is_the_sweeps_between_them() {
    let gaps: [&[[f64; 2]]; 7] = [
        &[[0.0, 0.1]],
        &[[0.9, 1.0]],
        &[[0.25, 0.35]],
        &[[0.45, 0.55]],
        &[[0.0, 0.25], [0.75, 1.0]],
        &[[0.15, 0.2], [0.6, 0.65], [0.8, 0.95]],
        // Between two values of the axis alone.
        &[[0.401, 0.449], [0.501, 0.549]],
    ];
    for (gaps, reversed) in gaps.into_iter().flat_map(|gaps| [(gaps, false), (gaps, true)]) {
        let axis = if reversed { axis(1.0, 0.0, 21) } else { axis(0.0, 1.0, 21) };
        let problem = Gaps(gaps.to_vec());
        let found = sweep(&problem, &axis, 1e-8, &()).unwrap();
        let none = |value: f64| gaps.iter().any(|[low, high]| (*low..=*high).contains(&value));
        let at = found.unanswered.iter().map(|(k, _)| *k);
        assert!(at.eq((0..found.values.len()).filter(|k| none(found.values[*k]))), "{gaps:?}");
        assert!(
            found.unanswered.iter().all(|(k, why)| why.to_string().contains(&found.values[*k].to_string()))
        );
        assert!(axis.values().iter().all(|value| found.values.contains(value)));
        assert_eq!(found.answered().count(), found.values.len() - found.unanswered.len());
        // Two branches in each stretch, through all its values.
        let mut stretches: Vec<&[f64]> = found.values.split(|value| none(*value)).collect();
        stretches.retain(|values| !values.is_empty());
        assert_eq!((found.branches.len(), found.broken()), (2 * stretches.len(), 0), "{gaps:?}");
        for (pair, values) in found.branches.chunks(2).zip(&stretches) {
            for branch in pair {
                assert_eq!(branch.eigenvalues.len(), values.len(), "{gaps:?}");
                assert_eq!(found.values[branch.first], values[0]);
            }
            for (k, value) in values.iter().enumerate() {
                let exact = problem.modes(&[*value]).unwrap().eigenvalues;
                assert!(pair.iter().all(|branch| exact.contains(&branch.eigenvalues[k])));
            }
        }
        // σ of the lower mode passes zero at 0.52, where that is known.
        let passes = stretches.iter().any(|s| (s[0] - 0.52) * (s[s.len() - 1] - 0.52) < 0.0);
        assert_eq!(found.critical.len(), usize::from(passes), "{gaps:?}");
        assert!(found.critical.iter().all(|c| within(
            (c.value - 0.52).abs(),
            c.uncertainty.max(1e-6),
            Stated
        )));
    }
}

/// A sweep of which nothing has an answer has no branches, and every reason.
#[test]
fn a_sweep_without_any_answer_has_every_reason() {
    let found = sweep(&Gaps(vec![[0.0, 1.0]]), &axis(0.0, 1.0, 9), 1e-8, &()).unwrap();
    assert!(found.branches.is_empty() && found.critical.is_empty() && found.answered().count() == 0);
    assert!(found.unanswered.len() == 9 && found.unanswered[8].1.to_string().contains("none at 1"));
}

/// A problem that counts how often it is solved, and has no answer at places above ¾.
struct Counted(Oscillators, std::sync::atomic::AtomicUsize);

impl Counted {
    fn new() -> Self {
        Counted(Oscillators { coupling: 0.005 }, Default::default())
    }

    fn count(&self) -> usize {
        self.1.load(std::sync::atomic::Ordering::Relaxed)
    }
}

impl SweepProblem for Counted {
    fn modes(&self, at: &[f64]) -> Result<Modes> {
        self.1.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        let [first, rest @ ..] = at else { panic!("no values") };
        if *first > 0.75 && !rest.is_empty() {
            return Err(crate::error::Error::analysis("modes", format!("{first} is too much"), "Take less"));
        }
        let mut modes = self.0.modes(at)?;
        // In a map the growth rate is zero on a circle.
        let growth = rest.first().map_or(0.0, |second| 0.3 - first.hypot(*second));
        modes.eigenvalues.iter_mut().for_each(|z| z.re += growth);
        Ok(modes)
    }
}

/// Answers in memory.
#[derive(Default)]
struct Stored(std::sync::Mutex<std::collections::BTreeMap<Vec<u64>, Result<Modes>>>);

impl AnswerStore for Stored {
    fn find(&self, place: &[u64]) -> Option<Result<Modes>> {
        self.0.lock().unwrap().get(place).cloned()
    }

    fn keep(&self, place: Vec<u64>, answer: &Result<Modes>) -> Result<()> {
        self.0.lock().unwrap().insert(place, answer.clone());
        Ok(())
    }
}

/// All that `count` blocks of a grid ask for, each computed by itself; how often a whole is solved beyond that.
fn in_blocks(axes: &[Axis], count: usize, whole: impl Fn(&dyn SweepProblem) -> String) -> usize {
    let all = Stored::default();
    for block in blocks(axes, count) {
        let own = Stored::default();
        let problem = Counted::new();
        // Its error, if any, is that of the whole.
        let _ = block.solve(&Answered::new(&problem, &own), axes, 1e-8, &());
        all.0.lock().unwrap().extend(own.0.into_inner().unwrap());
    }
    let (alone, rest) = (Counted::new(), Counted::new());
    assert_eq!(whole(&Answered::new(&rest, &all)), whole(&alone));
    assert!(alone.count() > points(axes));
    rest.count()
}

#[test]
fn blocks_computed_apart_have_all_that_a_sweep_asks_for() {
    let axis = axis(0.0, 1.0, 12);
    for count in [1, 2, 3, 5, 11, 40] {
        let rest = in_blocks(&[axis], count, |p| format!("{:?}", sweep(p, &axis, 1e-8, &()).unwrap()));
        assert_eq!(rest, 0, "{count} blocks");
    }
}

#[test]
fn blocks_computed_apart_have_all_that_a_map_and_its_boundary_ask_for() {
    let axes = [axis(0.0, 1.0, 9), axis(-1.0, 1.0, 6)];
    let whole = |p: &dyn SweepProblem| {
        let (points, unanswered) = map(p, &axes, &mut |_, _| Ok(()), &()).unwrap();
        assert_eq!(unanswered[0].1.to_string(), "modes: 0.875 is too much. Take less.");
        assert_eq!(unanswered.iter().map(|(k, _)| k % 9).collect::<Vec<_>>(), [7, 8].repeat(6));
        format!("{points:?} {:?}", boundary(p, &axes, &points, 1e-8, &()).unwrap())
    };
    for count in [1, 2, 5, 6, 13, 40, 100] {
        assert_eq!(in_blocks(&axes, count, whole), 0, "{count} blocks");
    }
}

#[test]
fn blocks_cover_a_grid_and_share_the_points_between_them() {
    let [a, b] = [axis(0.0, 1.0, 8), axis(0.0, 1.0, 4)];
    assert_eq!(blocks(&[a], 3), [[0, 2], [2, 4], [4, 7]].map(|along| Block(vec![along])));
    assert_eq!(blocks(&[a], 100).len(), 7);
    for (most, count) in [(1, 1), (4, 4), (6, 6), (7, 7), (11, 10), (13, 12), (21, 21), (500, 21)] {
        let all = blocks(&[a, b], most);
        assert_eq!(all.len(), count, "{most}: {all:?}");
        let covered: std::collections::BTreeSet<usize> =
            all.iter().flat_map(|block| block.points(&[a, b])).collect();
        assert_eq!(covered.len(), 32);
        let cells = |Block(ends): &Block| ends.iter().map(|[first, last]| last - first).product::<usize>();
        assert_eq!(all.iter().map(cells).sum::<usize>(), 21, "{all:?}");
    }
}
