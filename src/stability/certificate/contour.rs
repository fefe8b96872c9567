//! The winding number of d along a rectangle, covered by discs in which its phase cannot be misread.

use super::pencil::{ContourPoint, Pencil};
use super::region::CountedRegion;
use crate::linalg::c64;
use rayon::prelude::*;
use std::f64::consts::TAU;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Winding number of a region.
#[derive(Debug, Clone, Copy)]
pub(super) struct Winding {
    /// The zeros of Q_B inside.
    pub(super) zeros: i64,
    /// Discs that cover the contour.
    pub(super) points: usize,
    /// The largest ρ, and where.
    pub(super) defect: f64,
    pub(super) worst: c64,
}

/// Why a contour could not be followed.
#[derive(Debug, Clone, Copy)]
pub(super) enum Stopped {
    /// The contour passes so near an eigenvalue or a pole that it cannot be followed here.
    At(c64),
    /// It takes more points than wanted.
    TooManyPoints,
    /// What the basis leaves out is more than is of use.
    Weak,
}

/// Pieces of an edge that are covered independently of each other.
const PIECES: usize = 16;
/// The most points on a piece.
const POINTS: usize = 20_000;

/// How far a count goes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    /// The most points.
    pub(super) points: usize,
    /// ρ above which a count is given up.
    pub(super) defect: f64,
}

/// Winding number around `region`, within `limits`.
pub(super) fn wind(pencil: &Pencil<'_>, region: &CountedRegion, limits: Limits) -> Result<Winding, Stopped> {
    let path = region.path();
    let pieces: Vec<[c64; 2]> = path
        .windows(2)
        .flat_map(|edge| {
            let at = |k: usize| edge[0] + (edge[1] - edge[0]) * (k as f64 / PIECES as f64);
            let (first, last) = (edge[0], edge[1]);
            (0..PIECES).map(move |k| {
                [if k == 0 { first } else { at(k) }, if k + 1 == PIECES { last } else { at(k + 1) }]
            })
        })
        .collect();
    let resolution = 1e-11 * region.omega[1];
    // Whether all pieces together stay within the limits does not depend on who counts first.
    let budget = Budget { evaluated: AtomicUsize::new(0), weak: AtomicBool::new(false), limits };
    let covered: Vec<Result<Vec<ContourPoint>, Stopped>> =
        pieces.par_iter().map(|[a, b]| cover(pencil, *a, *b, resolution, &budget)).collect();
    if budget.weak.load(Ordering::Relaxed) {
        return Err(Stopped::Weak);
    }
    if budget.spent() {
        return Err(Stopped::TooManyPoints);
    }
    let covered: Result<Vec<Vec<ContourPoint>>, Stopped> = covered.into_iter().collect();
    let mut points: Vec<ContourPoint> = covered?.into_iter().flatten().collect();
    let count = points.len();
    let worst = points.iter().copied().reduce(|a, b| if b.defect > a.defect { b } else { a });
    if region.symmetric() {
        // d is real on the real axis: close the half with its ends there.
        let ends = [path[0], path[path.len() - 1]];
        let on_axis = |s: c64| pencil.point(s, resolution).ok_or(Stopped::At(s));
        points.insert(0, on_axis(ends[0])?);
        points.push(on_axis(ends[1])?);
    } else if let Some(first) = points.first().copied() {
        points.push(first);
    }
    // Two neighbouring discs touch, and in each the phase is within asin(3/4) of its centre's: less than half a turn.
    let change: f64 = points.windows(2).map(|p| (p[1].phase * p[0].phase.conj()).arg()).sum();
    let winding = if region.symmetric() { 2.0 * change / TAU } else { change / TAU };
    let whole = winding.round();
    match worst {
        Some(worst) if (winding - whole).abs() < 1e-3 => {
            // The winding number of d is its zeros inside less its poles; its poles are the zeros of Π p.
            let zeros = whole as i64 + pencil.poles_inside(region);
            Ok(Winding { zeros, points: count, defect: worst.defect, worst: worst.s })
        }
        _ => Err(Stopped::At(path[0])),
    }
}

/// The points of a contour, over all its pieces.
struct Budget {
    evaluated: AtomicUsize,
    weak: AtomicBool,
    limits: Limits,
}

impl Budget {
    /// Counts a point; whether it is one too many.
    fn take(&self) -> bool {
        self.evaluated.fetch_add(1, Ordering::Relaxed) >= self.limits.points
    }

    fn spent(&self) -> bool {
        self.evaluated.load(Ordering::Relaxed) > self.limits.points
    }
}

/// Discs that cover the line from `a` to `b`, in order.
fn cover(
    pencil: &Pencil<'_>,
    a: c64,
    b: c64,
    resolution: f64,
    budget: &Budget,
) -> Result<Vec<ContourPoint>, Stopped> {
    let length = (b - a).norm();
    let direction = (b - a) / length;
    let mut done = Vec::new();
    // What is still open, the next stretch last.
    let mut open = vec![(0.0, length)];
    let mut evaluated = 0;
    while let Some((from, to)) = open.pop() {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let s = a + direction * middle;
        evaluated += 1;
        if budget.take() {
            return Err(Stopped::TooManyPoints);
        }
        let point = pencil.point(s, half).ok_or(Stopped::At(s))?;
        if point.defect > budget.limits.defect {
            budget.weak.store(true, Ordering::Relaxed);
        }
        if budget.weak.load(Ordering::Relaxed) {
            return Err(Stopped::Weak);
        }
        if point.reach >= half {
            done.push((middle, point));
            continue;
        }
        if point.reach < resolution || evaluated > POINTS {
            return Err(Stopped::At(s));
        }
        // A shade less than the reach, so that rounding leaves no gap.
        let reach = 0.999 * point.reach;
        done.push((middle, point));
        open.push((middle + reach, to));
        open.push((from, middle - reach));
    }
    done.sort_by(|x, y| x.0.total_cmp(&y.0));
    Ok(done.into_iter().map(|(_, point)| point).collect())
}
