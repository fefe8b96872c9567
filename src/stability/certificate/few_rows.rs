//! The columns of F in a few rows: what damping and interface make of the basis.

use super::coupling_factor::CouplingFactor;
use super::damping::DampingParts;
use super::rows::ColumnBlock;
use crate::dynamics::InterfaceTerm;
use crate::linalg::c64;
use crate::linalg::dense::product;
use crate::stability::analysis::CompletedAnalysis;
use faer::Mat;
use std::f64::consts::TAU;

/// Columns with entries in a few rows that represent images of the basis: D B, H_r B, and K_c B, C_c B, K_cᵀB and C_cᵀB of the interface.
///
/// Of an interface in few directions the columns are W itself, of one in many the images: of these there are not more than vectors in
/// the basis, however many points are in contact.
pub(super) struct FewRows {
    pub(super) columns: ColumnBlock,
    pub(super) images: Vec<Image>,
    /// W of the active directions, each times the root of its size, by the columns, where these represent it.
    pub(super) directions: Option<Mat<f64>>,
}

/// An image of the basis.
pub(super) struct Image {
    pub(super) kind: ImageKind,
    /// What multiplies it in Q(s).
    pub(super) factor: CouplingFactor,
    /// Its columns by those of [`FewRows`].
    pub(super) coefficients: Mat<f64>,
}

/// What makes an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ImageKind {
    /// D or H_r.
    Damping,
    /// K_c or C_c, or its transpose.
    Interface { transposed: bool },
}

const BY_VELOCITY: CouplingFactor = CouplingFactor { square: 0.0, linear: 1.0, constant: c64::new(0.0, 0.0) };
const BY_DISPLACEMENT: CouplingFactor =
    CouplingFactor { square: 0.0, linear: 0.0, constant: c64::new(1.0, 0.0) };
const BY_LOSS: CouplingFactor = CouplingFactor { square: 0.0, linear: 0.0, constant: c64::new(0.0, 1.0) };

/// An image of the basis by the interface, G of W G.
struct InterfaceImage {
    transposed: Vec<bool>,
    factor: CouplingFactor,
    /// So much larger than what it contributes at the band's top.
    unit: f64,
    coefficients: Mat<f64>,
}

impl FewRows {
    pub(super) fn new(analysis: &CompletedAnalysis<'_>, parts: &DampingParts, active: &[usize]) -> Self {
        let (m, top) = (analysis.basis.len(), TAU * analysis.band_hz[1]);
        let sizes = analysis.operator.interface.sizes(top);
        let scales: Vec<f64> = active.iter().map(|d| sizes[*d].sqrt()).collect();
        let none = || ColumnBlock { rows: Vec::new(), values: Mat::zeros(0, 0) };
        // Of one size, that of forces at the band's top.
        let (mut damped, mut kinds) = (none(), Vec::new());
        for (image, unit, factor) in [(&parts.damped, 1.0, BY_VELOCITY), (&parts.lossy, top, BY_LOSS)] {
            if let Some(image) = image {
                let values = &image.values * faer::Scale(1.0 / unit);
                damped = damped.beside(&ColumnBlock { rows: image.rows.clone(), values });
                kinds.push((factor, unit));
            }
        }
        let of_interface = interface_images(analysis, active, &scales, top);
        let by_directions = active.len() <= of_interface.len() * m;
        let (columns, coefficients) = if by_directions {
            let identity = Mat::identity(active.len(), active.len());
            damped.beside(&combined(analysis, active, &scales, &identity)).spanned()
        } else {
            let (damped, coefficients) = damped.spanned();
            let images = of_interface.iter().fold(none(), |images, image| {
                let values = &image.coefficients * faer::Scale(1.0 / image.unit);
                images.beside(&combined(analysis, active, &scales, &values))
            });
            let coefficients = block_diagonal(&coefficients, images.values.ncols());
            (damped.beside(&images), coefficients)
        };
        let part = |first: usize, width: usize| coefficients.subcols(first, width);
        let mut images: Vec<Image> = (0..kinds.len())
            .map(|k| Image {
                kind: ImageKind::Damping,
                factor: kinds[k].0,
                coefficients: part(k * m, m) * faer::Scale(kinds[k].1),
            })
            .collect();
        let first = kinds.len() * m;
        let directions = by_directions.then(|| part(first, active.len()).to_owned());
        for (k, image) in of_interface.iter().enumerate() {
            let coefficients = match &directions {
                Some(directions) => product(directions.as_ref(), image.coefficients.as_ref()),
                None => part(first + k * m, m) * faer::Scale(image.unit),
            };
            images.extend(image.transposed.iter().map(|transposed| Image {
                kind: ImageKind::Interface { transposed: *transposed },
                factor: image.factor,
                coefficients: coefficients.clone(),
            }));
        }
        FewRows { columns, images, directions }
    }
}

/// diag(A, I) with the identity of the order `n`.
fn block_diagonal(a: &Mat<f64>, n: usize) -> Mat<f64> {
    let (rows, columns) = a.shape();
    Mat::from_fn(rows + n, columns + n, |i, j| match (i < rows, j < columns) {
        (true, true) => a[(i, j)],
        (false, false) if i - rows == j - columns => 1.0,
        _ => 0.0,
    })
}

/// What of a term acts, its stiffness or its damping.
type Coefficient = fn(&InterfaceTerm) -> f64;

/// G of K_c B = W G, C_c B, and the same transposed where that differs; none that is zero.
fn interface_images(
    analysis: &CompletedAnalysis<'_>,
    active: &[usize],
    scales: &[f64],
    top: f64,
) -> Vec<InterfaceImage> {
    let (interface, m) = (&analysis.operator.interface, analysis.basis.len());
    let of = |value: Coefficient, transposed: bool| {
        let mut image = Mat::zeros(active.len(), m);
        for term in interface.terms.iter().filter(|term| value(term) != 0.0) {
            let (to, from) = if transposed { (term.column, term.row) } else { (term.row, term.column) };
            let Ok(place) = active.binary_search(&to) else { continue };
            let seen = analysis.basis.interface.col_as_slice(from);
            (0..m).for_each(|j| image[(place, j)] += value(term) / scales[place] * seen[j]);
        }
        image
    };
    let kinds: [(Coefficient, _, _); 2] =
        [(|term| term.stiffness, BY_DISPLACEMENT, top), (|term| term.damping, BY_VELOCITY, 1.0)];
    let mut images = Vec::new();
    for (value, factor, unit) in kinds {
        let mut acting = interface.terms.iter().filter(|term| value(term) != 0.0).peekable();
        if acting.peek().is_none() {
            continue;
        }
        // Of one contact point or of damping across the sliding direction: entries on the diagonal alone.
        let symmetric = acting.all(|term| term.row == term.column);
        let sides = if symmetric { vec![vec![false, true]] } else { vec![vec![false], vec![true]] };
        for transposed in sides {
            let coefficients = of(value, transposed[0]);
            images.push(InterfaceImage { transposed, factor, unit, coefficients });
        }
    }
    images
}

/// W G, of the `active` directions times their `scales`.
fn combined(
    analysis: &CompletedAnalysis<'_>,
    active: &[usize],
    scales: &[f64],
    coefficients: &Mat<f64>,
) -> ColumnBlock {
    let all: Vec<_> = active.iter().map(|d| analysis.operator.interface.directions[*d]).collect();
    let mut rows: Vec<usize> = all.iter().flat_map(|d| d.indices().iter().copied()).collect();
    rows.sort_unstable();
    rows.dedup();
    let entries: Vec<Vec<(usize, f64)>> = all
        .iter()
        .zip(scales)
        .map(|(d, scale)| d.iter().map(|(i, v)| (rows.partition_point(|r| *r < i), scale * v)).collect())
        .collect();
    let mut values = Mat::zeros(rows.len(), coefficients.ncols());
    for j in 0..coefficients.ncols() {
        let column = values.col_as_slice_mut(j);
        for (entries, coefficient) in entries.iter().zip(coefficients.col_as_slice(j)) {
            entries.iter().filter(|_| *coefficient != 0.0).for_each(|(i, v)| column[*i] += coefficient * v);
        }
    }
    ColumnBlock { rows, values }
}
