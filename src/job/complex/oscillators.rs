//! Analyses of small imported matrices whose eigenvalues are known: oscillators in mixed coordinates, alone and in equal numbers, that
//! oscillate, creep, drift, diverge, or are at the edge between two of these.

use super::tests::write_matrix;
use crate::bounds::{Origin::*, within};
use crate::case::Case;
use crate::job::checks::results_hold;
use crate::job::{Prepared, Selection, analyse};
use crate::linalg::c64;
use crate::linalg::random::Random;
use crate::results::ComplexResult;
use faer::Mat;
use std::f64::consts::TAU;
use std::path::Path;

/// λ² + cλ + k of each, in units of a frequency of one.
fn oscillator(kind: usize, random: &mut Random) -> [f64; 2] {
    let omega = random.between(0.3, 2.0);
    let sign = [1.0, -1.0][random.below(2)];
    // From far below rounding to what is plainly apart.
    let near = sign * 10f64.powf(random.between(-17.0, -3.0));
    let ratio = match kind {
        0 => random.between(-0.3, 0.5),
        1 => 0.0,
        2 => [1.0, -1.0][random.below(2)],
        3 => [1.0, -1.0][random.below(2)] * (1.0 + near),
        4 => random.between(1.0, 3.0) * sign,
        // Drifts, with friction or without.
        5 => return [[0.0, random.between(-1.0, 1.0)][random.below(2)], 0.0],
        // Diverges.
        6 => return [[0.0, random.between(-0.5, 1.0)][random.below(2)], -omega * omega],
        // Creeps away, far slower than the others.
        7 => return [random.between(0.1, 1.0), -(10f64.powf(random.between(-9.0, -4.0)))],
        // At the onset of divergence.
        _ => return [random.between(0.1, 1.0), near],
    };
    [2.0 * ratio * omega, omega * omega]
}

/// The roots of λ² + cλ + k.
fn roots([c, k]: [f64; 2]) -> [c64; 2] {
    let inside = 0.25 * c * c - k;
    let root = c64::new(inside, 0.0).sqrt();
    if inside < 0.0 {
        return [root - 0.5 * c, -root - 0.5 * c];
    }
    // Without cancellation.
    let large = -0.5 * c - root.re.copysign(c);
    let small = if large == 0.0 { 0.0 } else { k / large };
    [large, small].map(|z| c64::new(z, 0.0))
}

struct Member {
    own: Vec<[f64; 2]>,
    unit: f64,
    matrices: [Mat<f64>; 3],
    band: [f64; 2],
    confirm: bool,
}

fn member(random: &mut Random) -> Member {
    let n = 1 + random.below(6);
    let mut own: Vec<[f64; 2]> = Vec::new();
    let alike = random.below(3);
    for i in 0..n {
        let kind = random.below(9);
        let next = oscillator(kind, random);
        // All alike, or now and then.
        let again = i > 0 && (alike == 0 || alike == 1 && random.below(2) == 0);
        own.push(if again { own[i - 1] } else { next });
    }
    let unit = 10f64.powi(random.below(6) as i32 - 1);
    let coordinates = random.below(3);
    let mix = Mat::from_fn(n, n, |i, j| match coordinates {
        0 => f64::from(i == j),
        _ => random.next() + 1.5 * f64::from(i == j),
    });
    let of = |value: &dyn Fn(usize) -> f64| {
        let diagonal = Mat::from_fn(n, n, |i, j| if i == j { value(i) } else { 0.0 });
        let turned = mix.transpose() * diagonal * &mix;
        Mat::from_fn(n, n, |i, j| turned[(i.max(j), i.min(j))])
    };
    let matrices = [of(&|_| 1.0), of(&|i| own[i][0] * unit), of(&|i| own[i][1] * unit * unit)];
    let top = unit * random.between(0.5, 3.0) / TAU;
    let low = [0.0, 0.0, 0.2 * top][random.below(3)];
    Member { own, unit, matrices, band: [low, top], confirm: random.below(2) == 0 }
}

impl Member {
    fn case(&self, folder: &Path) -> Case {
        for (name, a) in ["m.mtx", "c.mtx", "k.mtx"].iter().zip(&self.matrices) {
            write_matrix(&folder.join(name), a);
        }
        let text = format!(
            "[matrices]\nmass = \"m.mtx\"\ndamping = \"c.mtx\"\nstiffness = \"k.mtx\"\n[cea]\nband = {:?}\nconfirm = {}\n",
            self.band, self.confirm
        );
        Case::parse("small", &text, folder.into()).unwrap()
    }

    /// What is wrong with the analysis, or nothing.
    fn fault(&self, folder: &Path) -> Option<String> {
        let case = self.case(folder);
        let prepared = match Prepared::new(&case) {
            Ok(prepared) => prepared,
            Err(error) => return Some(format!("prepare: {error}")),
        };
        let results = match analyse(&prepared, Selection::Only("cea"), &mut |_| Ok(()), &()) {
            Ok(results) => results,
            Err(error) => return Some(format!("analysis: {error}")),
        };
        if let Err(error) = results_hold(&results) {
            let second = &results.get::<ComplexResult>().unwrap().confirmation;
            return Some(format!("check: {error} {second:?}"));
        }
        let complex = results.get::<ComplexResult>().unwrap();
        // Six equal eigenvalues or more, in ill-conditioned coordinates, are not accurate, and nothing is said about stability then.
        if complex.modes.broken_premise.is_some() {
            return self
                .own
                .iter()
                .all(|own| roots(*own)[0].re <= 0.0)
                .then(|| "nothing is said".to_string());
        }
        let modes = &complex.modes.modes;
        let found: Vec<c64> = modes.iter().map(|mode| mode.eigenvalue).collect();
        let exact: Vec<c64> = self.own.iter().flat_map(|own| roots(*own)).map(|z| z * self.unit).collect();
        let [low, top] = self.band.map(|f| TAU * f);
        // A double eigenvalue is known to the root of rounding, one of three to its cube root.
        let near = 3e-4 * self.unit;
        for z in &exact {
            let real = z.im.abs() < near;
            let inside = match real {
                true => low == 0.0 && z.norm() < top * 0.999 || z.re > 1e-3 * top && z.re > 2.0 * near,
                false => z.im > low * 1.001 && z.im < top * 0.999,
            };
            if !inside || z.im < 0.0 || (real && z.norm() < near) {
                continue;
            }
            let there = found.iter().filter(|other| (*other - z).norm() < near).count();
            let expected = exact.iter().filter(|other| (*other - z).norm() < 0.1 * near).count();
            // Conjugates that rounding parts from one real eigenvalue count as one.
            let least = if real { expected.div_ceil(2) } else { expected };
            if there < least {
                return Some(format!(
                    "{z} is there {there} times, not {least}: {found:?} {:?}",
                    results.warnings
                ));
            }
        }
        // Slow ones that stand alone are there once, each.
        for z in
            exact.iter().filter(|z| z.im == 0.0 && z.re > 1e-10 * self.unit && z.norm() < near && low == 0.0)
        {
            let own =
                |others: &[c64]| others.iter().filter(|other| (*other - z).norm() < 1e-2 * z.norm()).count();
            if own(&found) != own(&exact) {
                return Some(format!("{z} is there {} times, not {}: {found:?}", own(&found), own(&exact)));
            }
        }
        for mode in modes {
            let z = mode.eigenvalue;
            let off = exact.iter().map(|other| (other - z).norm()).fold(f64::INFINITY, f64::min);
            if !within(off, near, RoundOff) {
                return Some(format!("{z} is none of {exact:?}"));
            }
            let rounding = exact.iter().all(|other| (other - z).norm() > 0.1 * z.norm());
            if z.norm() < 1e-7 * self.unit && z.norm() > 1e-13 * self.unit && rounding && !mode.is_zero() {
                return Some(format!("{z} is nothing but rounding"));
            }
            let hz = mode.frequency_hz();
            if hz != 0.0 && hz < mode.uncertainty / TAU {
                return Some(format!("{hz} Hz is nothing but rounding: {z}"));
            }
            if mode.unstable() && exact.iter().all(|z| z.re < 0.0) {
                return Some(format!("{z} grows, of {exact:?}"));
            }
        }
        None
    }
}

#[test]
fn small_matrices_with_known_eigenvalues_are_analysed_whatever_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let (mut random, count) = (Random::seeded(91), 400);
    let mut faults = Vec::new();
    for trial in 0..count {
        let member = member(&mut random);
        if let Some(fault) = member.fault(folder.path()) {
            faults.push(format!(
                "{trial}: {fault}\n   {:?} unit {:e} band {:?} confirm {}",
                member.own, member.unit, member.band, member.confirm
            ));
        }
    }
    assert!(faults.is_empty(), "{} of {count}:\n{}", faults.len(), faults.join("\n"));
}
