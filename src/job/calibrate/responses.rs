//! Frequency responses of the case beside measured ones, and how they follow the unknowns.

use super::super::compare::matches;
use super::super::frf::{PreparedFrf, frfs};
use super::super::measured::measured_set;
use super::super::modes::{damping_of_response, response_needs};
use super::super::motion::Motion;
use super::super::prepared::Prepared;
use super::neighbours::Change;
use crate::calibration::ResponseLine;
use crate::case::{FrfSolution, MeasuredData};
use crate::dynamics::Harmonic;
use crate::error::{Fault, Faults, Result};
use crate::linalg::multivector::gram;
use crate::linalg::sparse::{multiply, times};
use crate::linalg::{SparseMatrix, SparseVector, c64};
use crate::measured::{MeasuredFrf, Quantity};
use crate::modal::RealModes;
use crate::reduction::{DampingOfModes, Receptance};
use faer::Mat;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Standard deviation of ln |h| that the case does not state.
const DEVIATION: f64 = 0.1;
/// Most lines of a response that are taken, where the case does not say.
const LINES: usize = 200;
/// Below this share of its median a response counts as if it were no smaller: what is left at an antiresonance.
const FLOOR: f64 = 0.05;

/// Responses of one `[frf.NAME]` measured in a test.
#[derive(Debug, Clone)]
pub struct MeasuredFrfData {
    /// The name of `[measured.NAME]`.
    pub name: String,
    /// That of `[frf.NAME]`.
    pub frf: String,
    /// The responses that are of places of the case.
    pub responses: Vec<Response>,
}

/// A measured response.
#[derive(Debug, Clone)]
pub struct Response {
    /// Name in the test.
    pub name: String,
    /// Name of its place in the case.
    pub place: String,
    /// Index of the place.
    seen: usize,
    /// Receptance, mobility or accelerance.
    pub quantity: Quantity,
    /// The lines that are compared \[Hz\].
    pub frequencies_hz: Vec<f64>,
    /// |h| measured at each, in the SI unit of the quantity.
    pub sizes: Vec<f64>,
    /// n: sizes below it are as good as none.
    pub floor: f64,
    /// Standard deviation of ln |h|.
    pub deviation: f64,
}

/// ½ ln(|h|² + n²): ln |h| where it is well above the floor n.
fn level(size: f64, floor: f64) -> f64 {
    0.5 * (size * size + floor * floor).ln()
}

impl Response {
    /// Measured level at each line, ½ ln(|h|² + n²).
    pub fn levels(&self) -> impl Iterator<Item = f64> + '_ {
        self.sizes.iter().map(|size| level(*size, self.floor))
    }
}

/// The responses of `[measured.NAME]` that are compared.
///
/// # Errors
/// A file that cannot be read, responses of which none is of a place of the case, a band without lines.
pub fn measured(prepared: &Prepared, name: &str, data: &MeasuredData, frf: &str) -> Result<MeasuredFrfData> {
    let (set, _) = measured_set(prepared.case, name)?;
    let all = frfs(prepared)?;
    let mut faults = Faults::new();
    let mut found = MeasuredFrfData { name: name.to_string(), frf: frf.to_string(), responses: Vec::new() };
    let key = |key: &str| format!("`measured.{name}.{key}`");
    let Some(wanted) = all.iter().find(|wanted| wanted.name() == frf) else { return Ok(found) };
    if wanted.slides() {
        let expected = "contact = \"open\": a calibration is of responses without contact";
        faults.push(Fault::new(format!("`frf.{frf}.contact`"), "contacts in steady sliding", expected));
    }
    if prepared.system.coupling.is_some() {
        let expected = "symmetric matrices, for responses to calibrate against";
        let place = if prepared.case.matrices.is_some() { "`matrices`" } else { "`rotation`" };
        faults.push(Fault::new(place, "matrices that are not symmetric", expected));
    }
    if set.frfs.is_empty() {
        faults.push(Fault::new(key("frf"), "no frequency response in the file", "some"));
        return faults.into_result(found);
    }
    let band = data.response_band.unwrap_or(wanted.band());
    let (matches, alone) = matches(data, &set, wanted);
    if matches.is_empty() {
        let words = if alone.is_empty() { "no response".into() } else { alone.join("; ") };
        faults.push(Fault::new(key("frf"), words, format!("a response at a place of [frf.{frf}]")));
    }
    for own in matches {
        let function = &set.frfs[own.measured];
        let place = wanted.seen()[own.seen].0.clone();
        let response = response(function, (place, own.seen), band, data);
        if response.frequencies_hz.len() < 2 {
            let (first, last) = (function.frequencies_hz.first(), function.frequencies_hz.last());
            let words = format!(
                "{:.1} to {:.1} Hz, without two lines of {} ({:.1} to {:.1} Hz)",
                band[0],
                band[1],
                function.name,
                first.copied().unwrap_or(0.0),
                last.copied().unwrap_or(0.0)
            );
            faults.push(Fault::new(key("response_band"), words, "a band in which the test has lines"));
        }
        found.responses.push(response);
    }
    faults.into_result(found)
}

/// The lines of a measured response that are compared.
fn response(
    function: &MeasuredFrf,
    (place, seen): (String, usize),
    [low, high]: [f64; 2],
    data: &MeasuredData,
) -> Response {
    let inside: Vec<(f64, f64)> = function
        .frequencies_hz
        .iter()
        .zip(&function.values)
        .filter(|(hz, h)| (low..=high).contains(*hz) && h.norm() > 0.0)
        .map(|(hz, h)| (*hz, h.norm()))
        .collect();
    let mut sorted: Vec<f64> = inside.iter().map(|(_, size)| *size).collect();
    sorted.sort_by(f64::total_cmp);
    let floor = FLOOR * sorted.get(sorted.len() / 2).copied().unwrap_or(0.0);
    let levels: Vec<f64> = inside.iter().map(|(_, size)| level(*size, floor)).collect();
    let chosen = thinned(&levels, data.response_lines.unwrap_or(LINES));
    Response {
        name: function.name.clone(),
        place,
        seen,
        quantity: function.quantity,
        frequencies_hz: chosen.iter().map(|k| inside[*k].0).collect(),
        sizes: chosen.iter().map(|k| inside[*k].1).collect(),
        floor,
        deviation: data.response_deviation.unwrap_or(DEVIATION),
    }
}

/// At most `most` of the lines: half of them evenly, half where the level changes most, so that peaks keep theirs.
fn thinned(levels: &[f64], most: usize) -> Vec<usize> {
    if levels.len() <= most {
        return (0..levels.len()).collect();
    }
    let changes: f64 = levels.windows(2).map(|ends| (ends[1] - ends[0]).abs()).sum();
    let mut way = 0.0;
    let mut ways = vec![0.0];
    for ends in levels.windows(2) {
        let steep = if changes > 0.0 { (ends[1] - ends[0]).abs() / changes } else { 0.0 };
        way += 0.5 / (levels.len() - 1) as f64 + 0.5 * steep;
        ways.push(way);
    }
    let place = |k: usize| ways.partition_point(|w| *w < way * (k as f64 / (most - 1) as f64) - 1e-12);
    let mut chosen: Vec<usize> = (0..most).map(|k| place(k).min(levels.len() - 1)).collect();
    chosen.dedup();
    chosen
}

/// The places of a response, its force first, of which the forms are made on any mesh of the case.
pub struct ResponsePlaces<'a> {
    frf: PreparedFrf<'a>,
}

impl<'a> ResponsePlaces<'a> {
    /// Those of `[frf.NAME]`.
    ///
    /// # Errors
    /// Places that the mesh does not have.
    pub fn new(prepared: &Prepared<'a>, name: &str) -> Result<ResponsePlaces<'a>> {
        let found = frfs(prepared)?.into_iter().find(|frf| frf.name() == name);
        Ok(ResponsePlaces { frf: found.expect("the case was checked for it") })
    }

    fn motions(&self) -> impl Iterator<Item = &Motion> {
        std::iter::once(self.frf.force()).chain(self.frf.seen().iter().map(|(_, motion)| motion))
    }

    /// The same nodes on a neighbouring mesh.
    pub fn forms(&self, prepared: &Prepared) -> Vec<SparseVector> {
        let dofs = &prepared.assembled.dofs;
        self.motions().map(|motion| dofs.mean_motion(&motion.nodes, motion.along)).collect()
    }
}

/// ∂ζ of every real mode by every unknown; none by one that damping ratios do not depend on.
pub type Ratios<'a> = dyn Fn(&RealModes) -> Result<Vec<Option<Vec<f64>>>> + 'a;

/// Derivatives of the reduced matrices, VᵀAV.
struct ReducedMatrices {
    stiffness: Mat<f64>,
    mass: Mat<f64>,
    viscous: Mat<f64>,
    hysteretic: Mat<f64>,
}

/// Receptances at one frequency: of every place, and their slopes by every unknown.
struct ReceptancesAt {
    values: Vec<c64>,
    slopes: Vec<Vec<c64>>,
}

/// The lines of the case beside the measured ones, with their slopes. An unknown has the `changes` of the structure and the
/// `ratios`, ∂ζ of every real mode, if it has either.
///
/// With Z = K − ω²M + iωC + iH, symmetric as nothing slides, a force form f and a place d
///
/// h = dᵀZ⁻¹f,   ∂h = ∂dᵀ u_f + u_dᵀ ∂f − u_dᵀ ∂Z u_f,   u_x = Z⁻¹x
///
/// (Lin and Ewins, Mech. Syst. Signal Process. 8 (1994) 437), and of ½ ln(|h|² + n²) the slope is Re(h̄ ∂h)/(|h|² + n²). The u
/// are superposed of modes and static residuals, or solved for at full order, as `[frf]` says.
///
/// # Errors
/// Modes that cannot be computed, a resonance that nothing damps.
pub fn lines(
    prepared: &Prepared,
    (measured, places): (&MeasuredFrfData, &ResponsePlaces),
    changes: &[Option<Change>],
    ratios: &Ratios,
) -> Result<Vec<ResponseLine>> {
    let wanted = &prepared.case.frf[&measured.frf];
    let forms = places.forms(prepared);
    let highest = measured
        .responses
        .iter()
        .filter_map(|r| r.frequencies_hz.last())
        .fold(wanted.band[1], |a, b| a.max(*b));
    let of = |mass: &SparseMatrix, real: &RealModes| damping_of_response(mass, real, prepared.case);
    let damping = DampingOfModes { of: &of, needs_below: response_needs(prepared.case) };
    let whole = Receptance::new(&prepared.system, None, (highest, &forms), damping, &())?;
    let rates = ratios(&whole.real)?;
    let small: Vec<ReducedMatrices> = changes
        .iter()
        .zip(&rates)
        .map(|(c, r)| reduced(&whole, c.as_ref(), r.as_deref(), wanted.solution))
        .collect();
    let seen: Vec<SparseVector> = forms.iter().map(|form| whole.reduced.form(form)).collect();
    let few = Harmonic::new(&whole.small.0, &whole.small.1)?;
    let full = Harmonic::new(&whole.system, &whole.steady)?;
    let at = |hz: f64| -> Result<ReceptancesAt> {
        let omega = TAU * hz;
        let (moved, own, few) = match wanted.solution {
            FrfSolution::Modes => {
                let moved = few.moved(omega, &seen)?;
                (None, &seen, moved)
            }
            FrfSolution::Direct => {
                let moved = full.moved(omega, &forms)?;
                let coordinates = along(&whole.reduced.inertia, &moved);
                (Some(moved), &forms, coordinates)
            }
        };
        let u = moved.as_ref().unwrap_or(&few);
        let on = |form: &SparseVector, k: usize| -> c64 { form.iter().map(|(i, v)| u[(i, k)] * v).sum() };
        let count = forms.len() - 1;
        let slope = |(small, change): (&ReducedMatrices, &Option<Change>)| -> Vec<c64> {
            // ∂Z u_f: of the small matrices all of it, at full order the modal damping alone.
            let inner = |a: &Mat<f64>, k: usize| bilinear(&few, a, k);
            let sparse =
                moved.as_ref().zip(change.as_ref()).map(|(moved, change)| applied(change, omega, moved));
            let turned: Vec<SparseVector> = match (change, &moved) {
                (Some(change), Some(_)) => change.seen.clone(),
                (Some(change), None) => change.seen.iter().map(|form| whole.reduced.form(form)).collect(),
                (None, _) => vec![SparseVector::default(); forms.len()],
            };
            (1..=count)
                .map(|k| {
                    let mut z = c64::new(0.0, omega) * inner(&small.viscous, k);
                    match &sparse {
                        Some(applied) => {
                            z += (0..applied.nrows()).map(|i| u[(i, k)] * applied[(i, 0)]).sum::<c64>()
                        }
                        None => {
                            z += inner(&small.stiffness, k) - inner(&small.mass, k) * (omega * omega)
                                + c64::new(0.0, 1.0) * inner(&small.hysteretic, k);
                        }
                    }
                    on(&turned[k], 0) + on(&turned[0], k) - z
                })
                .collect()
        };
        Ok(ReceptancesAt {
            values: (1..=count).map(|k| on(&own[k], 0)).collect(),
            slopes: small.iter().zip(changes).map(slope).collect(),
        })
    };
    beside_measured(measured, &at)
}

/// Lines at the measured frequencies, each frequency computed once by `at`.
fn beside_measured(
    measured: &MeasuredFrfData,
    at: &(dyn Fn(f64) -> Result<ReceptancesAt> + Sync),
) -> Result<Vec<ResponseLine>> {
    let mut all: Vec<f64> =
        measured.responses.iter().flat_map(|r| r.frequencies_hz.iter().copied()).collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    let answers = all.par_iter().map(|hz| at(*hz)).collect::<Result<Vec<ReceptancesAt>>>()?;
    let line = |response: &Response, hz: f64| {
        let answer = &answers[all.partition_point(|f| *f < hz)];
        let factor = response.quantity.factor(hz).norm();
        let h = answer.values[response.seen] * factor;
        let size = h.norm_sqr() + response.floor * response.floor;
        let slope = |slopes: &Vec<c64>| (h.conj() * slopes[response.seen] * factor).re / size;
        ResponseLine {
            value: level(h.norm(), response.floor),
            slope: answer.slopes.iter().map(slope).collect(),
        }
    };
    let of = |r: &Response| r.frequencies_hz.iter().map(|hz| line(r, *hz)).collect::<Vec<ResponseLine>>();
    Ok(measured.responses.iter().flat_map(of).collect())
}

/// VᵀX of a complex X.
fn along(v: &Mat<f64>, x: &Mat<c64>) -> Mat<c64> {
    let part = |f: fn(&c64) -> f64| {
        gram(v.as_ref(), Mat::from_fn(x.nrows(), x.ncols(), |i, j| f(&x[(i, j)])).as_ref())
    };
    let (re, im) = (part(|z| z.re), part(|z| z.im));
    Mat::from_fn(re.nrows(), re.ncols(), |i, j| c64::new(re[(i, j)], im[(i, j)]))
}

/// q_kᵀ A q₀.
fn bilinear(q: &Mat<c64>, a: &Mat<f64>, k: usize) -> c64 {
    let row = |i: usize| (0..a.ncols()).map(|j| q[(j, 0)] * a[(i, j)]).sum::<c64>();
    (0..a.nrows()).map(|i| q[(i, k)] * row(i)).sum()
}

/// (∂K − ω²∂M + iω∂C + i∂H) u of the first column.
fn applied(change: &Change, omega: f64, u: &Mat<c64>) -> Mat<c64> {
    let mut sum = Mat::<c64>::zeros(u.nrows(), 1);
    let mut add = |a: &SparseMatrix, factor: c64| {
        let mut y = Mat::<c64>::zeros(u.nrows(), 1);
        multiply(a, u.subcols(0, 1), y.as_mut());
        sum += y * faer::Scale(factor);
    };
    add(&change.stiffness, c64::new(1.0, 0.0));
    add(&change.mass, c64::new(-omega * omega, 0.0));
    change.viscous.iter().for_each(|c| add(c, c64::new(0.0, omega)));
    change.hysteretic.iter().for_each(|h| add(h, c64::new(0.0, 1.0)));
    sum
}

/// VᵀAV of the changes of a structure. Of modal damping C = MΦGΦᵀM, G = diag(g) with g = 2ζω, in which modes and
/// frequencies follow K and M: with A = Vᵀ∂KV and B = Vᵀ∂MV
///
/// (Vᵀ∂CV)_kl = A_kl g\[λ_k, λ_l\] − B_kl (λg)\[λ_k, λ_l\] + B_kl (g_k + g_l) + δ_kl 2ω_k ∂ζ_k
///
/// with the divided differences f\[a, b\] = (f(a) − f(b))/(a − b) (Daleckii and Krein; Higham, Functions of Matrices, 2008,
/// theorem 3.11); g is zero beyond the modes. At full order the small viscous matrix has this part alone.
fn reduced(
    whole: &Receptance,
    change: Option<&Change>,
    ratios: Option<&[f64]>,
    solution: FrfSolution,
) -> ReducedMatrices {
    let v = whole.reduced.basis.as_ref();
    let size = whole.reduced.basis.ncols();
    let onto = |a: &SparseMatrix| gram(v, times(a, v).as_ref());
    let none = || Mat::<f64>::zeros(size, size);
    let mut small = ReducedMatrices {
        stiffness: change.map_or_else(none, |c| onto(&c.stiffness)),
        mass: change.map_or_else(none, |c| onto(&c.mass)),
        viscous: match (solution, change.and_then(|c| c.viscous.as_ref())) {
            (FrfSolution::Modes, Some(c)) => onto(c),
            _ => none(),
        },
        hysteretic: change.and_then(|c| c.hysteretic.as_ref()).map_or_else(none, onto),
    };
    let lambda = |k: usize| whole.reduced.system.structure.stiffness[(k, k)];
    if let Some(modal) = &whole.system.structure.damping.modal {
        let g = |k: usize| modal.coefficients.get(k).copied().unwrap_or(0.0);
        for k in 0..size {
            for l in 0..size {
                let (a, b) = (lambda(k), lambda(l));
                let close = (a - b).abs() <= 1e-6 * (a.abs() + b.abs());
                // g = 2ζ√λ: its own derivative is g/2λ.
                let (rise, moment) = match close {
                    true if a > 0.0 => (0.5 * g(k) / a, 1.5 * g(k)),
                    true => (0.0, 0.0),
                    false => ((g(k) - g(l)) / (a - b), (a * g(k) - b * g(l)) / (a - b)),
                };
                small.viscous[(k, l)] +=
                    small.stiffness[(k, l)] * rise + small.mass[(k, l)] * (g(k) + g(l) - moment);
            }
        }
    }
    for (k, rate) in ratios.iter().flat_map(|rates| rates.iter().enumerate()) {
        small.viscous[(k, k)] += 2.0 * lambda(k).max(0.0).sqrt() * rate;
    }
    small
}
