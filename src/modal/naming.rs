//! Names disc modes by their nodal diameters and circles.
//!
//! The transverse displacement at scattered points (r, θ) is fitted for each n by itself, by weighted least squares, with
//!
//!   w(r, θ) ≈ Σ_k [ a_k cos nθ + b_k sin nθ ] φ_k(r),
//!
//! φ_k the piecewise linear functions that are 1 at one of some radii, the knots, and 0 at the others. Each point stands for the area
//! about it, so that it does not matter where the mesh is fine. The share of n is the part of the energy Σ w² that its fit
//! explains, corrected for the number of its coefficients. A mode is named when one n has most of the energy and no other explains
//! nearly as much; its nodal circles are the sign changes of the fitted values along the radius. Where a value between two of one
//! sign is within its own uncertainty, where a lobe has fewer than two knots, or where there are fewer than 2 s + 2 knots for s
//! circles, the shape does not bear a name, and has none.

use super::DiscModeName;
use crate::linalg::dense::cholesky;
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::{Mat, Par, c64};
use std::f64::consts::{PI, TAU};

/// The most nodal diameters that are distinguished.
const MOST_DIAMETERS: usize = 24;
/// The most knots.
const MOST_KNOTS: usize = 25;
/// Points for each knot, at least.
const POINTS_A_KNOT: usize = 6;
/// Points from a knot to the next, at least.
const LEAST: usize = 10;
/// Knots are at least this part of the width of the annulus apart.
const CLOSEST: f64 = 0.025;
/// More points than this add nothing; a fixed selection of them is used.
const MOST_POINTS: usize = 4000;
/// Cells, along the radius and around, within which the points share the cell's area.
const CELLS: [usize; 2] = [12, 24];
/// Part of the mean weight that holds values that no point determines at zero.
const RIDGE: f64 = 1e-6;
/// A mode is named when one n has this share of the energy.
const DOMINANT: f64 = 0.7;
/// Every other n leaves this many times as much of the energy unexplained, and a tenth of all more.
const APART: f64 = 2.0;
/// A value along the radius has a sign where it is larger than this share of the largest,
const SMALLEST: f64 = 0.03;
/// and than as many standard deviations.
const DEVIATIONS: f64 = 2.0;
/// A value of another sign than the next one at an edge is a lobe where it is larger than this share of the largest,
const EDGE: f64 = 0.2;
/// and what a fit misses that is straight between knots where it is smaller than this share of the next one.
const MISSED: f64 = 0.25;
/// Where there are circles, knots are less than this part of a mean lobe apart: of rings of nodes, and of scattered points, which
/// may leave out a lobe at an edge.
const WIDEST: [f64; 2] = [0.67, 0.45];

/// The points of a disc, ready to name any number of its modes.
#[derive(Debug, Clone)]
pub struct DiscPoints {
    n_points: usize,
    chosen: Vec<Chosen>,
    /// Radii at which the fits are free \[m\].
    knots: Vec<f64>,
    /// The number of points of equal weight that would be worth as much.
    worth: f64,
    /// Points around the median knot.
    around: usize,
    /// One of [`WIDEST`].
    widest: f64,
    /// The fits of n = 0, 1, 2 …
    orders: Vec<Order>,
}

/// A point used.
#[derive(Debug, Clone)]
struct Chosen {
    point: usize,
    weight: f64,
    angle: f64,
    /// The knot below, and φ of the knot above.
    knot: usize,
    part: f64,
}

/// The fit of one n: a_k and b_k are unknowns 2k and 2k + 1, without the latter for n = 0.
#[derive(Debug, Clone)]
struct Order {
    /// L of L Lᵀ = the normal matrix.
    factor: Mat<f64>,
    /// Larger entry of a knot on the diagonal of its inverse.
    variance: Vec<f64>,
}

/// What one n explains of a shape.
struct Explained {
    /// Its coefficients.
    fit: Mat<f64>,
    /// Share of the energy.
    share: f64,
    /// Variance of a point about the fit.
    rest: f64,
}

impl DiscPoints {
    /// Points at radius r \[m\] and angle θ \[rad\] about the disc's centre. `None` when there are too few of them, or
    /// they leave out more than a quarter of the circle.
    pub fn new(points: &[(f64, f64)]) -> Option<Self> {
        if points.iter().any(|(r, angle)| !r.is_finite() || !angle.is_finite()) {
            return None;
        }
        let inner = points.iter().map(|p| p.0).fold(f64::INFINITY, f64::min);
        let outer = points.iter().map(|p| p.0).fold(0.0, f64::max);
        if points.is_empty() || outer - inner <= 1e-9 * outer {
            return None;
        }
        let gap = largest_gap(points);
        if gap > PI / 2.0 {
            return None;
        }
        let chosen = choose(points.len());
        let mut weights = weights(points, &chosen, [inner, outer]);
        let (sum, squares) = weights.iter().fold((0.0, 0.0), |(s, q), w| (s + w, q + w * w));
        let worth = sum * sum / squares;
        weights.iter_mut().for_each(|w| *w *= worth / sum);
        let mut radii: Vec<f64> = chosen.iter().map(|k| points[*k].0).collect();
        radii.sort_by(f64::total_cmp);
        if chosen.len() < 2 * LEAST {
            return None;
        }
        let most = (worth as usize / POINTS_A_KNOT).clamp(4, MOST_KNOTS);
        let knots = knots(&radii, most, CLOSEST * (outer - inner));
        let chosen: Vec<Chosen> = chosen
            .into_iter()
            .zip(weights)
            .map(|(point, weight)| {
                let (r, angle) = points[point];
                let knot = knots.partition_point(|at| *at <= r).clamp(1, knots.len() - 1) - 1;
                let part = ((r - knots[knot]) / (knots[knot + 1] - knots[knot])).clamp(0.0, 1.0);
                Chosen { point, weight, angle, knot, part }
            })
            .collect();
        let between = chosen.iter().filter(|p| (0.2..0.8).contains(&p.part)).count();
        let widest = WIDEST[usize::from(20 * between > chosen.len())];
        let around = points_around(&chosen, knots.len());
        let diameters = MOST_DIAMETERS.min((0.9 * PI / gap) as usize).min((0.45 * around as f64) as usize);
        if diameters == 0 {
            return None;
        }
        let orders = (0..=diameters).map(|n| Order::new(n, &chosen, knots.len())).collect::<Option<_>>()?;
        Some(DiscPoints { n_points: points.len(), chosen, knots, worth, around, widest, orders })
    }

    /// Shapes with higher wave numbers, around the circle \[1/rad\] and along the radius \[1/m\], look as if they had lower ones: π over
    /// the distance of the points.
    pub fn highest_wave_numbers(&self) -> [f64; 2] {
        let last = self.knots.len() - 1;
        [0.5 * self.around as f64, PI * last as f64 / (self.knots[last] - self.knots[0])]
    }

    /// The name of the mode with transverse displacement `w` at the points, in their order; `None` where the shape does not
    /// bear one, or is zero.
    ///
    /// # Panics
    /// When `w` has another length than the points.
    pub fn name(&self, w: &[f64]) -> Option<DiscModeName> {
        assert_eq!(w.len(), self.n_points, "one displacement for each point");
        let energy: f64 = self.chosen.iter().map(|p| p.weight * w[p.point].powi(2)).sum();
        if energy == 0.0 || !energy.is_finite() {
            return None;
        }
        let explained = self.explained(w, energy);
        let share = |n: &usize| explained[*n].share;
        let n = (0..explained.len()).max_by(|a, b| share(a).total_cmp(&share(b)))?;
        let unexplained = 1.0 - share(&n);
        let alone = (0..explained.len()).all(|m| m == n || 1.0 - share(&m) > APART * unexplained + 0.1);
        let (values, deviations, standing) = self.along(n, &explained[n]);
        if !alone || share(&n) * standing < DOMINANT {
            return None;
        }
        let nodal_circles = circles((&self.knots, self.widest), &values, &deviations)?;
        Some(DiscModeName { nodal_diameters: n, nodal_circles })
    }

    /// The fit of each n to `w`, which has `energy`.
    fn explained(&self, w: &[f64], energy: f64) -> Vec<Explained> {
        let unknowns = |n: usize| if n == 0 { self.knots.len() } else { 2 * self.knots.len() };
        let mut right: Vec<Mat<f64>> =
            (0..self.orders.len()).map(|_| Mat::zeros(2 * self.knots.len(), 1)).collect();
        for p in &self.chosen {
            let (turn, mut wave) = (c64::cis(p.angle), c64::new(p.weight * w[p.point], 0.0));
            for right in &mut right {
                for (knot, phi) in [(p.knot, 1.0 - p.part), (p.knot + 1, p.part)] {
                    right[(2 * knot, 0)] += phi * wave.re;
                    right[(2 * knot + 1, 0)] += phi * wave.im;
                }
                wave *= turn;
            }
        }
        let fit = |(n, (order, right)): (usize, (&Order, Mat<f64>))| {
            let mut fit = right.clone();
            solve_lower_triangular_in_place(order.factor.as_ref(), fit.as_mut(), Par::Seq);
            solve_upper_triangular_in_place(order.factor.transpose(), fit.as_mut(), Par::Seq);
            let explained: f64 = (0..2 * self.knots.len()).map(|k| fit[(k, 0)] * right[(k, 0)]).sum();
            let free = (self.worth - unknowns(n) as f64).max(1.0);
            let rest = (energy - explained).max(0.0) / free;
            Explained { fit, share: 1.0 - rest * self.worth / energy, rest }
        };
        self.orders.iter().zip(right).enumerate().map(fit).collect()
    }

    /// a cos ψ + b sin ψ at the knots with the ψ that holds most energy, as the nodal diameters of a single mode stand still along
    /// r; the standard deviations; and the share of the energy of this n that it holds.
    fn along(&self, n: usize, explained: &Explained) -> (Vec<f64>, Vec<f64>, f64) {
        let mut mass = vec![0.0; self.knots.len()];
        for p in &self.chosen {
            mass[p.knot] += p.weight * (1.0 - p.part);
            mass[p.knot + 1] += p.weight * p.part;
        }
        let part = |k: usize, which: usize| explained.fit[(2 * k + which, 0)];
        let sum = |x: usize, y: usize| -> f64 {
            (0..self.knots.len()).map(|k| mass[k] * part(k, x) * part(k, y)).sum()
        };
        let (aa, ab, bb) = (sum(0, 0), sum(0, 1), sum(1, 1));
        let psi = 0.5 * (2.0 * ab).atan2(aa - bb);
        let (c, s) = (psi.cos(), psi.sin());
        let values: Vec<f64> = (0..self.knots.len()).map(|k| part(k, 0) * c + part(k, 1) * s).collect();
        let variance = &self.orders[n].variance;
        let deviation = |k: usize| (explained.rest * variance[k]).sqrt();
        let standing = (aa * c * c + 2.0 * ab * c * s + bb * s * s) / (aa + bb);
        (values, (0..self.knots.len()).map(deviation).collect(), standing)
    }
}

impl Order {
    /// Of `n` diameters; `None` where the matrix has no factor.
    fn new(n: usize, chosen: &[Chosen], n_knots: usize) -> Option<Order> {
        let mut normal = Mat::<f64>::zeros(2 * n_knots, 2 * n_knots);
        let mut sum = 0.0;
        for p in chosen {
            let (sin, cos) = (n as f64 * p.angle).sin_cos();
            let entries = [(p.knot, 1.0 - p.part), (p.knot + 1, p.part)]
                .map(|(knot, phi)| [(2 * knot, phi * cos), (2 * knot + 1, phi * sin)]);
            for (i, x) in entries.as_flattened() {
                entries.as_flattened().iter().for_each(|(j, y)| normal[(*i, *j)] += p.weight * x * y);
            }
            sum += p.weight;
        }
        (0..2 * n_knots).for_each(|k| normal[(k, k)] += RIDGE * sum / n_knots as f64);
        let factor = cholesky(normal.as_ref()).ok()?;
        let mut inverse = Mat::<f64>::identity(2 * n_knots, 2 * n_knots);
        solve_lower_triangular_in_place(factor.as_ref(), inverse.as_mut(), Par::Seq);
        let of = |k: usize| inverse.col(k).squared_norm_l2();
        let sine = |k: usize| if n > 0 { of(2 * k + 1) } else { 0.0 };
        let variance = (0..n_knots).map(|k| of(2 * k).max(sine(k))).collect();
        Some(Order { factor, variance })
    }
}

/// How often the values at the knots, which may be `widest` of a mean lobe apart, change sign along the radius; `None` where that
/// is not certain.
fn circles((knots, widest): (&[f64], f64), values: &[f64], deviations: &[f64]) -> Option<usize> {
    let largest = values.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    let last = values.len() - 1;
    let opposite = |[a, b]: &[usize; 2]| values[*a] * values[*b] < 0.0;
    // A value at an edge that alone has another sign, small enough to be what the fit misses there.
    let edges = [[0, 1], [last, last - 1]];
    let sign = |k: usize| values[k].abs() > (SMALLEST * largest).max(DEVIATIONS * deviations[k]);
    let small = edges.map(|ends| opposite(&ends) && sign(ends[0]) && values[ends[0]].abs() < EDGE * largest);
    let zero = [0, 1].map(|k| {
        let [edge, next] = edges[k].map(|k| values[k].abs());
        small[k] && edge < MISSED * next
    });
    let sure = |k: &usize| sign(*k) && !(*k == 0 && zero[0]) && !(*k == last && zero[1]);
    let sure: Vec<usize> = (0..values.len()).filter(sure).collect();
    let pairs: Vec<[usize; 2]> = sure.windows(2).map(|ends| [ends[0], ends[1]]).collect();
    let turns: Vec<[usize; 2]> = pairs.iter().copied().filter(opposite).collect();
    // Values without a sign between two of one sign may hide a lobe.
    let hidden = pairs.iter().any(|ends| ends[1] > ends[0] + 1 && !opposite(ends));
    // A lobe from one turn to the next has two knots.
    let narrow = turns.windows(2).any(|two| two[1][0] == two[0][1]);
    let doubtful = [0, 1].into_iter().any(|k| small[k] && !zero[k]);
    let lobe = (knots[last] - knots[0]) / (turns.len() + 1) as f64;
    let apart = knots.windows(2).map(|ends| ends[1] - ends[0]).fold(0.0, f64::max);
    let certain =
        !(sure.is_empty() || hidden || narrow || doubtful) && (turns.is_empty() || apart < widest * lobe);
    certain.then_some(turns.len())
}

/// The area that each of the `chosen` points stands for: that of its cell, shared by the points in it.
fn weights(points: &[(f64, f64)], chosen: &[usize], [inner, outer]: [f64; 2]) -> Vec<f64> {
    let part = |x: f64, count: usize| ((x * count as f64) as usize).min(count - 1);
    let cell = |k: &usize| {
        let (r, angle) = points[*k];
        let along = part((r - inner) / (outer - inner), CELLS[0]);
        along * CELLS[1] + part(angle.rem_euclid(TAU) / TAU, CELLS[1])
    };
    let mut count = [0usize; CELLS[0] * CELLS[1]];
    chosen.iter().for_each(|k| count[cell(k)] += 1);
    let middle = |cell: usize| inner + (outer - inner) * ((cell / CELLS[1]) as f64 + 0.5) / CELLS[0] as f64;
    chosen.iter().map(|k| middle(cell(k)) / count[cell(k)] as f64).collect()
}

/// At most `most` radii of points, the ends among them: closer towards the ends, where a fit that is straight between knots is off
/// at the end itself; no closer than `closest`, and with some points from one to the next.
fn knots(radii: &[f64], most: usize, closest: f64) -> Vec<f64> {
    let (first, last) = (radii[0], radii[radii.len() - 1]);
    let target = |k: usize| first + 0.5 * (last - first) * (1.0 - (PI * k as f64 / (most - 1) as f64).cos());
    let mut knots = vec![first];
    let (mut since, mut next) = (0, 1);
    for r in radii {
        since += 1;
        let far = *r >= knots[knots.len() - 1] + closest && *r <= last - closest;
        // A ring of nodes has one radius but for rounding.
        if *r >= target(next) - 1e-6 * last && far && since >= LEAST {
            knots.push(*r);
            since = 0;
            while next + 1 < most && *r >= target(next) - 1e-6 * last {
                next += 1;
            }
        }
    }
    knots.push(last);
    knots
}

/// In how many of 128 sectors there are points at the median knot.
fn points_around(chosen: &[Chosen], n_knots: usize) -> usize {
    let mut occupied = vec![[false; 128]; n_knots];
    for p in chosen {
        let sector = (p.angle.rem_euclid(TAU) / TAU * 128.0) as usize;
        occupied[p.knot + usize::from(p.part > 0.5)][sector.min(127)] = true;
    }
    let mut counts: Vec<usize> =
        occupied.iter().map(|sectors| sectors.iter().filter(|o| **o).count()).collect();
    counts.sort_unstable();
    counts[counts.len() / 2]
}

/// The largest angle without a point: it limits the n that can be distinguished (n < π / gap).
fn largest_gap(points: &[(f64, f64)]) -> f64 {
    let mut angles: Vec<f64> = points.iter().map(|p| p.1.rem_euclid(TAU)).collect();
    angles.sort_by(f64::total_cmp);
    let (Some(first), Some(last)) = (angles.first(), angles.last()) else { return TAU };
    let around = first + TAU - last;
    angles.windows(2).map(|w| w[1] - w[0]).fold(around, f64::max)
}

/// Which points are used: all, or a selection without a pattern (multiples of the golden ratio).
fn choose(n: usize) -> Vec<usize> {
    if n <= MOST_POINTS {
        return (0..n).collect();
    }
    let golden = 0.618_033_988_749_895;
    let mut chosen: Vec<usize> =
        (0..MOST_POINTS).map(|k| ((k as f64 * golden).fract() * n as f64) as usize).collect();
    chosen.sort_unstable();
    chosen.dedup();
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::random::Random;

    /// Points scattered over an annulus 0.015 … 0.075 m, finer towards the lowest rim point (θ = −π/2), where the
    /// disc touches.
    fn scattered(n: usize, seed: u64) -> Vec<(f64, f64)> {
        let mut random = Random::seeded(seed);
        let mut unit = || 0.5 + 0.5 * random.next();
        (0..n)
            .map(|k| {
                let r = (0.015f64.powi(2) + unit() * (0.075f64.powi(2) - 0.015f64.powi(2))).sqrt();
                let fine = k % 3 == 0;
                let spread = if fine { 0.2 * (unit() - 0.5) } else { unit() - 0.5 };
                let r = if fine { 0.075 - 0.2 * (0.075 - r) } else { r };
                (r, -PI / 2.0 + TAU * spread)
            })
            .collect()
    }

    /// Clamped at the hub, with s sign changes between hub and rim.
    fn radial(r: f64, s: usize) -> f64 {
        let x = (r - 0.015) / 0.06;
        x * x * (1..=s).map(|k| 1.0 - x / (0.35 + 0.55 * k as f64 / (s as f64 + 0.5))).product::<f64>()
    }

    #[test]
    fn analytic_shapes_are_named() {
        for (count, most) in [(900, 5), (3000, 8), (20_000, 8)] {
            let points = scattered(count, 11);
            let disc = DiscPoints::new(&points).unwrap();
            let mut random = Random::seeded(5);
            for n in [0, 1, 2, 3, 5, 8].into_iter().filter(|n| *n <= most) {
                for s in 0..=2 {
                    // Each of a double pair, turned by any angle, with 3 % noise.
                    for turn in [0.0, 0.3, PI / (2.0 * (n as f64).max(1.0))] {
                        if n == 0 && turn > 1.0 {
                            continue;
                        }
                        let w: Vec<f64> = points
                            .iter()
                            .map(|(r, a)| {
                                radial(*r, s) * (n as f64 * (a - turn)).cos() + 0.003 * random.next()
                            })
                            .collect();
                        let expected = DiscModeName { nodal_diameters: n, nodal_circles: s };
                        assert_eq!(disc.name(&w), Some(expected), "{count} points, turned by {turn}");
                    }
                }
            }
        }
    }

    /// Without noise, and few points away from the contact.
    #[test]
    fn forty_scatters_of_900_points_have_no_wrong_name() {
        let mut named = 0;
        for seed in 0..40 {
            let points = scattered(900, seed);
            let disc = DiscPoints::new(&points).unwrap();
            for (n, s) in (0..=8).flat_map(|n| [0, 1, 2].map(|s| (n, s))) {
                let w: Vec<f64> =
                    points.iter().map(|(r, a)| radial(*r, s) * (n as f64 * a + 0.3).cos()).collect();
                let expected = DiscModeName { nodal_diameters: n, nodal_circles: s };
                let found = disc.name(&w);
                assert!(found.is_none_or(|found| found == expected), "{seed}: {expected:?} {found:?}");
                named += usize::from(found.is_some());
            }
        }
        assert!(named > 1000, "{named} of 1080");
    }

    /// s sign changes between the edges at x = 0 and 1, of which each is free or held.
    fn profile(x: f64, s: usize, [inner, outer]: [bool; 2]) -> f64 {
        let s = s as f64;
        match (inner, outer) {
            (false, false) => (PI * (s + 0.3) * x).cos(),
            (false, true) => (PI * (s + 0.5) * x).cos(),
            (true, false) => x / (x + 0.1) * (PI * (s + 0.8) * x).sin(),
            (true, true) => x / (x + 0.1) * (1.0 - x) / (1.1 - x) * (PI * (s + 1.0) * x).sin(),
        }
    }

    /// Rings of nodes as meshes have them, aligned or moved by up to a third of their distances, and scattered points: at most two
    /// names in a thousand are wrong, and none of a shape that the points resolve; of these at most one in fifty has no name.
    #[test]
    fn no_name_is_wrong_and_resolved_shapes_have_one() {
        let mut random = Random::seeded(17);
        let (mut named, mut resolved, mut wrong, mut unnamed) = (0, 0, 0, 0);
        for round in 0..600 {
            let (rings, around) = (3 + random.below(14), 12 + random.below(60));
            let (inner, moved) = ([0.0, 0.2, 0.5, 0.8][random.below(4)], [0.0, 0.02, 0.33][random.below(3)]);
            let scattered = round % 4 == 0;
            let count = 200 + random.below(2000);
            let points: Vec<(f64, f64)> = if scattered {
                let mut unit = || 0.5 + 0.5 * random.next();
                (0..count)
                    .map(|_| ((inner * inner + unit() * (1.0 - inner * inner)).sqrt(), TAU * unit()))
                    .collect()
            } else {
                let (width, sector) = ((1.0 - inner) / (rings - 1) as f64, TAU / around as f64);
                let mut place = |i: usize, j: usize| {
                    let off = moved * random.next();
                    let r = if i == 0 || i + 1 == rings { 0.0 } else { off };
                    let turn = moved * random.next();
                    (inner + width * (i as f64 + r), sector * (j as f64 + turn))
                };
                (0..rings * around).map(|k| place(k / around, k % around)).collect()
            };
            let Some(disc) = DiscPoints::new(&points) else { continue };
            let edges = [random.below(2) == 1, random.below(2) == 1];
            for _ in 0..4 {
                let (n, s, turn) = (random.below(10), random.below(5), random.next());
                // More diameters than half of the nodes of a ring, or as many circles as rings, are fewer to them.
                let fewest = if moved > 0.1 { 2 * s + 1 } else { s + 2 };
                if !scattered && (2 * n > around || rings < fewest) {
                    continue;
                }
                let w: Vec<f64> = points
                    .iter()
                    .map(|(r, a)| {
                        profile((r - inner) / (1.0 - inner), s, edges) * (n as f64 * (a - turn)).cos()
                    })
                    .collect();
                // Nodes may all stand on nodal lines, or nearly.
                if w.iter().fold(0.0f64, |m, w| m.max(w.abs())) < 0.1 {
                    continue;
                }
                let expected = DiscModeName { nodal_diameters: n, nodal_circles: s };
                let found = disc.name(&w);
                let label = format!(
                    "round {round}: {rings} × {around}, moved {moved}, scattered {scattered} {count}, inner {inner}, edges {edges:?}: {expected:?}"
                );
                // Four points along half a wave, along the radius and about the middle circle.
                let spacing = (PI * (1.0 - inner * inner) / count as f64).sqrt();
                let half_waves = [(1.0 - inner) / (s + 1) as f64, PI * 0.5 * (1.0 + inner) / (n + 1) as f64];
                let (more_rings, per_wave) = if moved > 0.1 { (5, 8) } else { (3, 4) };
                let fine = match scattered {
                    true => half_waves.iter().all(|half| *half > 4.0 * spacing),
                    false => rings > 4 * s + more_rings && around > per_wave * (n + 1),
                };
                let right = found.is_none_or(|found| found == expected);
                assert!(right || !fine, "{label} has the name {found:?}");
                wrong += usize::from(!right);
                resolved += usize::from(fine);
                named += usize::from(found.is_some());
                unnamed += usize::from(found.is_none() && fine);
            }
        }
        assert!(named > 1500 && resolved > 600, "{named} named, {resolved} resolved");
        assert!(500 * wrong <= named, "{wrong} of {named} names are wrong");
        assert!(50 * unnamed <= resolved, "{unnamed} of {resolved} have no name");
    }

    #[test]
    fn rings_of_few_points_do_not_alias() {
        let points: Vec<(f64, f64)> = (0..10)
            .flat_map(|i| (0..32).map(move |j| (0.02 + 0.005 * i as f64, TAU * j as f64 / 32.0)))
            .collect();
        let disc = DiscPoints::new(&points).unwrap();
        for n in [0, 1, 4, 7] {
            let w: Vec<f64> = points.iter().map(|(r, a)| r * r * (n as f64 * a).cos()).collect();
            assert_eq!(disc.name(&w), Some(DiscModeName { nodal_diameters: n, nodal_circles: 0 }));
        }
    }

    #[test]
    fn mixed_modes_and_nothing_have_no_name() {
        let points = scattered(3000, 11);
        let disc = DiscPoints::new(&points).unwrap();
        let mixed: Vec<f64> =
            points.iter().map(|(r, a)| radial(*r, 0) * ((2.0 * a).cos() + (3.0 * a).sin())).collect();
        assert_eq!(disc.name(&mixed), None);
        assert_eq!(disc.name(&vec![0.0; 3000]), None);
        let mut random = Random::seeded(3);
        let noise: Vec<f64> = points.iter().map(|_| random.next()).collect();
        assert_eq!(disc.name(&noise), None);
    }

    #[test]
    fn too_few_points_or_half_a_disc_cannot_be_named() {
        assert!(DiscPoints::new(&[]).is_none());
        assert!(DiscPoints::new(&[(1.0, 0.0), (1.0, 2.0)]).is_none());
        let half: Vec<(f64, f64)> = scattered(2000, 11).into_iter().map(|(r, a)| (r, 0.5 * a)).collect();
        assert!(DiscPoints::new(&half).is_none());
        assert!(DiscPoints::new(&[(f64::NAN, 0.0)]).is_none());
    }
}
