//! The contact-size determinant d(s) = det(I + H(s) κ(s)) at a point, with a disc around it in which it is understood.

use super::reduced::{Oscillator, ReducedModel};
use super::region::CountedRegion;
use super::remainder::Remainder;
use crate::dynamics::InterfaceTerm;
use crate::error::{Error, Result};
use crate::linalg::c64;
use crate::linalg::dense::{product, symmetric_eigen};
use crate::linalg::lu::inverse_and_phase;
use faer::Mat;

/// Q_B(s) = diag(p) + V κ(s) Vᵀ with κ = k + s c: det Q_B = Π p · d, d(s) = det(I + H κ), H = Vᵀ diag(1/p) V.
///
/// V holds the directions of the interface, scaled so that the entries of κ are about one, and what the damping couples
/// of the real modes; where these would be more than the m coordinates, the coordinates themselves.
#[derive(Debug)]
pub(super) struct Pencil<'a> {
    oscillators: &'a [Oscillator],
    remainder: Option<&'a Remainder>,
    /// V, m × r.
    directions: Mat<f64>,
    entries: Vec<PencilEntry>,
    /// The columns of κ that are not zero: d is the determinant of their block of I + Hκ.
    columns: Vec<usize>,
    /// The square root of the size of κ's columns, relative to that of its rows and columns. X is measured with its
    /// rows times these and its columns over these, since a row of N with no column of its own must not weigh.
    balance: Vec<f64>,
    /// ‖Vᵢ‖², one a row.
    squares: Vec<f64>,
    /// The same of the columns, each times its balance.
    balanced_squares: Vec<f64>,
    /// ‖Lᵢ‖ of each term of the remainder, one a row.
    row_norms: Vec<Vec<f64>>,
}

/// An entry of κ.
#[derive(Debug, Clone, Copy)]
struct PencilEntry {
    row: usize,
    column: usize,
    /// The place of the column among those that are not zero.
    place: usize,
    stiffness: c64,
    damping: f64,
}

/// d at a point of the contour.
#[derive(Debug, Clone, Copy)]
pub(super) struct ContourPoint {
    pub(super) s: c64,
    /// d / |d|.
    pub(super) phase: c64,
    /// In the disc of this radius d has no zero, and its phase stays within asin(3/4) of that at the centre.
    pub(super) reach: f64,
    /// ρ, at its largest in that disc.
    pub(super) defect: f64,
}

/// Bound on ‖(N(s) − N(c)) N(c)⁻¹‖ in the disc of a point.
const CHANGE: f64 = 0.75;

/// The terms of the interface between the active directions, each divided by the root of its size, `scale`.
fn contact_entries(model: &ReducedModel, terms: &[InterfaceTerm], scale: &[f64]) -> Vec<PencilEntry> {
    let place = |d: usize| model.active.iter().position(|a| *a == d);
    terms
        .iter()
        .filter_map(|t| {
            let (row, column) = (place(t.row)?, place(t.column)?);
            let size = scale[row] * scale[column];
            Some(PencilEntry {
                row,
                column,
                place: 0,
                stiffness: c64::new(t.stiffness / size, 0.0),
                damping: t.damping / size,
            })
        })
        .collect()
}

impl<'a> Pencil<'a> {
    /// The reduced model with the numbers of an interface, scaled for frequencies up to `top` \[rad/s\]; `sizes` are
    /// those of the operator's directions.
    pub(super) fn new(
        model: &'a ReducedModel,
        terms: &[InterfaceTerm],
        sizes: &[f64],
        top: f64,
    ) -> Result<Self> {
        let m = model.oscillators.len();
        let zero = c64::new(0.0, 0.0);
        let scale: Vec<f64> = model.active.iter().map(|d| sizes[*d].sqrt()).collect();
        let mut columns: Vec<Vec<f64>> =
            (0..scale.len()).map(|j| (0..m).map(|i| model.interface[(i, j)] * scale[j]).collect()).collect();
        let mut entries = contact_entries(model, terms, &scale);
        let mut add = |coupled: &Option<Mat<f64>>, unit: f64, stiffness: c64, damping: f64| -> Result<()> {
            let Some(a) = coupled else { return Ok(()) };
            let (values, vectors) = symmetric_eigen(a.as_ref())?;
            let largest = values.iter().fold(0.0f64, |l, v| l.max(v.abs()));
            for (j, value) in values.iter().enumerate().filter(|(_, v)| v.abs() > 1e-13 * largest) {
                let here = columns.len();
                columns.push((0..m).map(|i| vectors[(i, j)] * (value.abs() * unit).sqrt()).collect());
                let sign = value.signum();
                entries.push(PencilEntry {
                    row: here,
                    column: here,
                    place: 0,
                    stiffness: stiffness * sign,
                    damping: damping * sign,
                });
            }
            Ok(())
        };
        add(&model.coupled_damping, top, zero, 1.0 / top)?;
        add(&model.coupled_loss, 1.0, c64::new(0.0, 1.0), 0.0)?;
        let mut directions = Mat::from_fn(m, columns.len(), |i, j| columns[j][i]);
        if columns.len() > m {
            (directions, entries) = in_coordinates(&directions, &entries, top);
        }
        let mut sizes = vec![0.0f64; directions.ncols()];
        for entry in &entries {
            let size = entry.stiffness.norm() + top * entry.damping.abs();
            sizes[entry.column] = sizes[entry.column].max(size);
        }
        if let Some(entry) = entries.iter().find(|e| !(e.stiffness.norm() + e.damping.abs()).is_finite()) {
            let (stiffness, damping) = (entry.stiffness, entry.damping);
            return Err(Error::analysis(
                "certificate of the complex modes",
                format!("an entry of the scaled interface is {stiffness:.3e} + s {damping:.3e}"),
                "Check the stiffness, damping and friction of the contacts",
            ));
        }
        let columns: Vec<usize> = (0..sizes.len()).filter(|j| sizes[*j] > 0.0).collect();
        entries.retain(|entry| sizes[entry.column] > 0.0);
        let place: Vec<usize> = (0..sizes.len()).map(|j| columns.partition_point(|c| *c < j)).collect();
        entries.iter_mut().for_each(|entry| entry.place = place[entry.column]);
        let balance: Vec<f64> = columns.iter().map(|j| sizes[*j].sqrt()).collect();
        let squares = (0..m).map(|i| directions.row(i).norm_l2().powi(2)).collect();
        let balanced =
            |i: usize| columns.iter().zip(&balance).map(|(j, b)| (directions[(i, *j)] * b).powi(2)).sum();
        let balanced_squares = (0..m).map(balanced).collect();
        let remainder = model.remainder.as_ref();
        let row_norms = remainder.map_or(Vec::new(), |r| {
            r.terms.iter().map(|(_, l)| (0..m).map(|i| l.row(i).norm_l2()).collect()).collect()
        });
        Ok(Pencil {
            oscillators: &model.oscillators,
            remainder,
            directions,
            entries,
            columns,
            balance,
            squares,
            balanced_squares,
            row_norms,
        })
    }

    /// The zeros of Π p in a region.
    pub(super) fn poles_inside(&self, region: &CountedRegion) -> i64 {
        self.oscillators.iter().flat_map(|o| o.roots()).filter(|root| region.contains(*root)).count() as i64
    }

    /// κ(s) and c, r × the columns that are not zero, when they are full enough to be multiplied as matrices.
    fn as_matrices(&self, s: c64) -> Option<[Mat<c64>; 2]> {
        let (r, columns) = (self.directions.ncols(), self.columns.len());
        (self.entries.len() > 6 * r).then(|| {
            let (mut kappa, mut rate) = (Mat::zeros(r, columns), Mat::zeros(r, columns));
            for e in &self.entries {
                kappa[(e.row, e.place)] += e.stiffness + s * e.damping;
                rate[(e.row, e.place)] += c64::new(e.damping, 0.0);
            }
            [kappa, rate]
        })
    }

    /// x κ, in the columns that are not zero.
    fn times_entries(&self, x: &Mat<c64>, value: impl Fn(&PencilEntry) -> c64) -> Mat<c64> {
        let mut y = Mat::zeros(x.nrows(), self.columns.len());
        for entry in &self.entries {
            let factor = value(entry);
            let from = x.col_as_slice(entry.row);
            y.col_as_slice_mut(entry.place).iter_mut().zip(from).for_each(|(y, x)| *y += x * factor);
        }
        y
    }

    /// κ x or c x, with the rows of `x` those columns.
    fn entries_times(&self, x: &Mat<c64>, value: impl Fn(&PencilEntry) -> c64) -> Mat<c64> {
        let mut y = Mat::zeros(self.directions.ncols(), x.ncols());
        for j in 0..x.ncols() {
            let (from, to) = (x.col_as_slice(j), y.col_as_slice_mut(j));
            for entry in &self.entries {
                to[entry.row] += value(entry) * from[entry.place];
            }
        }
        y
    }

    /// Evaluates d at `c`, and finds how far around it, at most `wish`, what is known there holds. `None` when `c` is an
    /// eigenvalue or a pole.
    ///
    /// With X(s) = (N(s) − N(c)) N(c)⁻¹ and N = I + Hκ, d(s)/d(c) = det(I + X). The sum of the magnitudes of X's
    /// eigenvalues is at most its nuclear norm, which is bounded in the disc ([`Pencil::change`]). As the matrices with
    /// ‖X‖ < 1 are a convex set without a singular I + X, the phase of d changes by Σ arg(1 + xᵢ), and by asin(Σ|xᵢ|) at
    /// most.
    pub(super) fn point(&self, c: c64, wish: f64) -> Option<ContourPoint> {
        let (v, r) = (&self.directions, self.columns.len());
        let used = Mat::from_fn(v.nrows(), r, |i, j| v[(i, self.columns[j])]);
        let poles: Vec<Pole> = self.oscillators.iter().map(|o| Pole::new(o, c)).collect();
        let nearest = poles.iter().fold(f64::INFINITY, |d, p| d.min(p.distances[0].min(p.distances[1])));
        let weighted = |f: fn(&Pole) -> f64| {
            let right = Mat::from_fn(v.nrows(), v.ncols(), |i, j| v[(i, j)] * f(&poles[i]));
            product(used.transpose(), right.as_ref())
        };
        let both =
            |re: Mat<f64>, im: Mat<f64>| Mat::from_fn(r, v.ncols(), |i, j| c64::new(re[(i, j)], im[(i, j)]));
        let h = both(weighted(|p| p.compliance.re), weighted(|p| p.compliance.im));
        let h_rate = both(weighted(|p| p.rate.re), weighted(|p| p.rate.im));
        let kappa = |e: &PencilEntry| e.stiffness + c * e.damping;
        let rate = |e: &PencilEntry| c64::new(e.damping, 0.0);
        let full = self.as_matrices(c);
        let mut n = match &full {
            Some([kappa, _]) => product(h.as_ref(), kappa.as_ref()),
            None => self.times_entries(&h, kappa),
        };
        (0..r).for_each(|i| n[(i, i)] += 1.0);
        let (inverse, phase) = inverse_and_phase(n)?;
        let (stiff, damped) = match &full {
            Some([kappa, rate]) => {
                (product(kappa.as_ref(), inverse.as_ref()), product(rate.as_ref(), inverse.as_ref()))
            }
            None => (self.entries_times(&inverse, kappa), self.entries_times(&inverse, rate)),
        };
        let mut slope = product(h_rate.as_ref(), stiff.as_ref()) + product(h.as_ref(), damped.as_ref());
        let over = |x: &mut Mat<c64>, rows: bool| {
            for (j, b) in self.balance.iter().enumerate() {
                for i in 0..x.nrows() {
                    x[(i, j)] *= if rows { self.balance[i] / b } else { 1.0 / b };
                }
            }
        };
        over(&mut slope, true);
        let (mut balanced_stiff, mut balanced_damped) = (stiff.clone(), damped.clone());
        over(&mut balanced_stiff, false);
        over(&mut balanced_damped, false);
        let state = DiscState {
            stiff_rows: row_norms(v, &balanced_stiff),
            damped_rows: row_norms(v, &balanced_damped),
            stiff: size(&stiff),
            damped: size(&damped),
            slope: (r as f64).sqrt() * size(&slope),
            poles,
            c,
        };
        let reach = self.reach(&state, wish.min(0.9 * nearest))?;
        Some(ContourPoint { s: c, phase, reach, defect: self.defect(&state, reach) })
    }

    /// A bound on the nuclear norm of X in the disc of radius `h`.
    ///
    /// V weighted by the largest change of each 1/p bounds (H(s) − H(c)) κ N⁻¹ by a product of two Frobenius norms. Near
    /// two nearly equal eigenvalues that is too large by orders of magnitude, as it is blind to what cancels in d′; there
    /// (s − c) N′N⁻¹ itself is used, with a bound of the same kind on the second-order rest. The smaller counts.
    fn change(&self, state: &DiscState, h: f64) -> f64 {
        let mut first = [0.0; 2];
        let (mut fixed, mut second, mut cross) = ([0.0; 2], [0.0; 2], [0.0; 2]);
        for (i, pole) in state.poles.iter().enumerate() {
            let (v, stiff, damped) = (self.balanced_squares[i], state.stiff_rows[i], state.damped_rows[i]);
            let (beta, rest, size) = (pole.change(h), pole.second_change(h), pole.size);
            let add = |sum: &mut [f64; 2], weight: f64, row: f64| {
                sum[0] += weight * v;
                sum[1] += weight * row * row;
            };
            add(&mut first, beta, stiff + h * damped);
            add(&mut fixed, size, damped);
            add(&mut second, rest, stiff);
            add(&mut cross, beta, damped);
        }
        let norm = |sum: [f64; 2]| (sum[0] * sum[1]).sqrt();
        let coarse = norm(first) + h * norm(fixed);
        let fine = h * state.slope + norm(second) + h * norm(cross);
        // Products of zero and infinity are no bound.
        if fine.is_nan() { coarse } else { fine.min(coarse) }
    }

    /// The radius, at most `wish`, in which the change stays below [`CHANGE`].
    fn reach(&self, state: &DiscState, wish: f64) -> Option<f64> {
        let at = |h: f64| self.change(state, h);
        let (mut good, mut bad) = (0.0, wish);
        if at(wish) <= CHANGE {
            return Some(wish);
        }
        // The bound grows faster than h: where it is too large by a factor, h over that factor is small enough.
        for _ in 0..60 {
            let value = at(bad);
            let next = if value.is_finite() { bad * CHANGE / value } else { 0.5 * bad };
            if at(next) <= CHANGE {
                good = next;
                break;
            }
            bad = next;
        }
        for _ in 0..8 {
            let middle = 0.5 * (good + bad);
            if at(middle) <= CHANGE { good = middle } else { bad = middle }
        }
        (good > 0.0).then_some(good)
    }

    /// A bound on ρ(s) = q ‖E‖ in the disc of radius `h`, as far as the contour goes: not left of the imaginary axis and
    /// not above the band.
    fn defect(&self, state: &DiscState, h: f64) -> f64 {
        let Some(remainder) = self.remainder else { return 0.0 };
        let (c, v, change) = (state.c, &self.directions, self.change(state, h));
        let omega = (c.im.abs() + h).min(remainder.tau.sqrt());
        let q = remainder.amplification([(c.re - h).max(0.0), c.re + h], omega);
        if !q.is_finite() {
            return f64::INFINITY;
        }
        // Y = Σ Lᵀ diag(1/p) V at the centre; what changes in the disc is bounded row by row.
        let weighted = |f: fn(c64) -> f64| {
            Mat::from_fn(v.nrows(), v.ncols(), |i, j| v[(i, j)] * f(state.poles[i].compliance))
        };
        let (flex_re, flex_im) = (weighted(|z| z.re), weighted(|z| z.im));
        let f = remainder.terms.first().map_or(0, |(_, l)| l.ncols());
        let mut y = Mat::<c64>::zeros(f, v.ncols());
        for (factor, l) in &remainder.terms {
            let (re, im) =
                (product(l.transpose(), flex_re.as_ref()), product(l.transpose(), flex_im.as_ref()));
            let g = factor.at(c);
            y += Mat::from_fn(f, v.ncols(), |i, j| g * c64::new(re[(i, j)], im[(i, j)]));
        }
        let (mut own, mut y_change) = (0.0, 0.0);
        for (i, pole) in state.poles.iter().enumerate() {
            let (mut size, mut size_change) = (0.0, 0.0);
            for ((factor, _), norms) in remainder.terms.iter().zip(&self.row_norms) {
                size += factor.at(c).norm() * norms[i];
                size_change += factor.change(c, h) * norms[i];
            }
            let (compliance, beta) = (pole.size, pole.change(h));
            own += (compliance + beta) * (size + size_change).powi(2);
            y_change += (compliance * size_change + beta * (size + size_change)) * self.squares[i].sqrt();
        }
        let y = size(&y) + y_change + remainder.missed.response;
        let stiff = (state.stiff + h * state.damped) / (1.0 - change);
        q * (own + stiff * y * y)
    }
}

/// Values at the centre of a disc.
struct DiscState {
    c: c64,
    poles: Vec<Pole>,
    /// ‖(V κ N⁻¹)ᵢ‖ and ‖(V c N⁻¹)ᵢ‖ in balanced columns, one a row.
    stiff_rows: Vec<f64>,
    damped_rows: Vec<f64>,
    /// ‖κ N⁻¹‖ and ‖c N⁻¹‖.
    stiff: f64,
    damped: f64,
    /// √r ‖N′ N⁻¹‖, balanced.
    slope: f64,
}

/// An oscillator seen from a point.
struct Pole {
    /// 1/p(c) and its size.
    compliance: c64,
    size: f64,
    /// (1/p)′(c).
    rate: c64,
    /// |p′(c)|.
    slope: f64,
    /// Distances of c from the two zeros of p.
    distances: [f64; 2],
}

impl Pole {
    fn new(oscillator: &Oscillator, c: c64) -> Self {
        let roots = oscillator.roots();
        let p = (c - roots[0]) * (c - roots[1]);
        let slope = c * 2.0 + oscillator.damping;
        let compliance = c64::new(1.0, 0.0) / p;
        Pole {
            compliance,
            size: compliance.norm(),
            rate: -slope / (p * p),
            slope: slope.norm(),
            distances: roots.map(|root| (c - root).norm()),
        }
    }

    /// A bound on |1/p(s) − 1/p(c)| within `h` of c.
    fn change(&self, h: f64) -> f64 {
        let [a, b] = self.distances;
        if h >= a.min(b) {
            return f64::INFINITY;
        }
        self.size * h * (self.slope + h) / ((a - h) * (b - h))
    }

    /// A bound on |1/p(s) − 1/p(c) − (s − c)(1/p)′(c)| within `h` of c.
    fn second_change(&self, h: f64) -> f64 {
        let [a, b] = self.distances;
        if h >= a.min(b) {
            return f64::INFINITY;
        }
        self.size * (h * h / ((a - h) * (b - h)) + h * self.slope * self.change(h))
    }
}

impl Oscillator {
    /// The two zeros of s² + a s + θ + i h.
    pub(super) fn roots(&self) -> [c64; 2] {
        let half = c64::new(-0.5 * self.damping, 0.0);
        let constant = c64::new(self.stiffness, self.loss);
        let root = (half * half - constant).sqrt();
        // The larger one without cancellation, the other by Vieta.
        let large = if (half + root).norm() >= (half - root).norm() { half + root } else { half - root };
        if large.norm() == 0.0 { [large; 2] } else { [large, constant / large] }
    }
}

/// ‖(V X)ᵢ‖, one a row.
fn row_norms(v: &Mat<f64>, x: &Mat<c64>) -> Vec<f64> {
    let part = |f: fn(&c64) -> f64| Mat::from_fn(x.nrows(), x.ncols(), |i, j| f(&x[(i, j)]));
    let mut squares = vec![0.0; v.nrows()];
    for part in [part(|z| z.re), part(|z| z.im)] {
        let y = product(v.as_ref(), part.as_ref());
        for j in 0..y.ncols() {
            squares.iter_mut().zip(y.col_as_slice(j)).for_each(|(sum, y)| *sum += y * y);
        }
    }
    squares.iter().map(|s| s.sqrt()).collect()
}

/// ‖X‖ of Frobenius.
fn size(x: &Mat<c64>) -> f64 {
    (0..x.ncols()).flat_map(|j| x.col_as_slice(j)).map(|z| z.norm_sqr()).sum::<f64>().sqrt()
}

/// V κ Vᵀ as entries between the coordinates themselves, scaled so that they are about one.
fn in_coordinates(v: &Mat<f64>, entries: &[PencilEntry], top: f64) -> (Mat<f64>, Vec<PencilEntry>) {
    let (m, r) = (v.nrows(), v.ncols());
    let dense = |value: &dyn Fn(&PencilEntry) -> f64| {
        let mut left = Mat::<f64>::zeros(m, r);
        for entry in entries {
            (0..m).for_each(|i| left[(i, entry.column)] += v[(i, entry.row)] * value(entry));
        }
        product(left.as_ref(), v.transpose())
    };
    let (re, im) = (dense(&|e| e.stiffness.re), dense(&|e| e.stiffness.im));
    let c = dense(&|e| e.damping);
    let size = |i: usize| {
        let row =
            (0..m).fold(0.0f64, |s, j| s.max(re[(i, j)].abs() + im[(i, j)].abs() + top * c[(i, j)].abs()));
        if row > 0.0 { row.sqrt() } else { 1.0 }
    };
    let scale: Vec<f64> = (0..m).map(size).collect();
    let directions = Mat::from_fn(m, m, |i, j| if i == j { scale[i] } else { 0.0 });
    let mut all = Vec::with_capacity(m * m);
    for column in 0..m {
        for row in 0..m {
            let s = scale[row] * scale[column];
            let stiffness = c64::new(re[(row, column)] / s, im[(row, column)] / s);
            all.push(PencilEntry { row, column, place: 0, stiffness, damping: c[(row, column)] / s });
        }
    }
    (directions, all)
}
