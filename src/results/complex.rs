//! Complex modes, the count of the unstable ones, and the second method beside them.

use super::real_modes::SHAPE_UNITS;
use super::{NodalField, PartMode, PartShares};
use crate::dataset::{Column, Describe, Dimension, Group, Table, Values, Variable, column};
use crate::linalg::c64;
use crate::modal::DiscModeName;
use crate::numbers::{growth, hertz, power, signed, significant};
use crate::stability::{Certificate, CloseCall, ComplexMode, ComplexModes, Confirmation, ROUND_OFF, Verdict};
use crate::structure::DofMap;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Complex modes, for people.
#[derive(Debug, Clone)]
pub struct ComplexResult {
    /// Eigenvalues, vectors, errors, budgets.
    pub modes: ComplexModes,
    /// From the free degrees of freedom, on which the vectors of the modes stand, to the nodes.
    pub dofs: Arc<DofMap>,
    /// A few words on the real modes that take part in each mode: `61 % disc (0,1), 22 % (3,0)`.
    pub participation: Vec<String>,
    /// Names of the real modes, in the order that [`ComplexMode::participation`](crate::stability::ComplexMode)
    /// counts them: `disc (0, 1)`, `mode 1718 Hz`.
    pub real_modes: Vec<String>,
    /// Whether these are the real modes with the contact closed as in steady sliding, and not those of the structure alone.
    pub contact_closed: bool,
    /// The name of the motion of the disc in each mode, where it moves and has one.
    pub discs: Vec<Option<DiscModeName>>,
    /// Shares of the parts in each mode; `None` of imported matrices.
    pub shares: Option<PartShares>,
    /// σ of each unstable mode \[1/s\], to first order, if the double modes of bodies of revolution were not split by the mesh; `None` of others, and where
    /// there is no such body.
    pub without_split: Vec<Option<f64>>,
    /// Frequencies that measurements show squealing \[Hz\], with their source; may be empty.
    pub measured_squeal_hz: Vec<(f64, String)>,
    /// The frequency \[Hz\] up to which real modes have the modal damping of the whole; `None` where there is none.
    pub modal_damping_below_hz: Option<f64>,
    /// Frequency band of the analysis \[Hz\].
    pub band_hz: [f64; 2],
    /// The count of the unstable eigenvalues, where there is one.
    pub certificate: Option<Certificate>,
    /// The second method beside it, if the case requests one.
    pub confirmation: Option<Confirmation>,
}

/// A complex mode with the words on its real modes, the name of its disc's motion, σ without split, and the mode of a part that it is like.
type ComplexModeRow<'a> = (&'a ComplexMode, &'a str, Option<DiscModeName>, Option<f64>, Option<&'a PartMode>);

fn columns<'a>() -> Vec<Column<ComplexModeRow<'a>>> {
    vec![
        column("frequency_hz", "Hz", "ω/2π", |(m, ..): &ComplexModeRow| m.frequency_hz())
            .shown("f [Hz]", |(m, ..)| hertz(m.frequency_hz(), 1)),
        column(
            "growth_rate",
            "1/s",
            "σ; the mode is unstable when it is positive",
            |(m, ..): &ComplexModeRow| m.growth_rate(),
        )
        .shown("σ [1/s]", |(m, ..)| growth(m.growth_rate(), m.eigenvalue.norm(), ROUND_OFF)),
        column("damping_ratio", "1", "ζ = −σ/|λ|", |(m, ..): &ComplexModeRow| m.damping_ratio())
            .shown("ζ [%]", |(m, ..)| signed(100.0 * m.damping_ratio(), 3)),
        column(
            "verdict",
            "text",
            "stable, unstable, undecided or not accurate",
            |(m, ..): &ComplexModeRow| m.verdict().word(),
        )
        .shown("", |(m, ..)| match m.verdict() {
            Verdict::Stable => String::new(),
            Verdict::Undecided if m.is_zero() => "zero".into(),
            Verdict::Undecided => Verdict::Undecided.word().into(),
            alarming => alarming.word().to_uppercase(),
        }),
        column("unstable", "1", "whether the mode is unstable", |(m, ..): &ComplexModeRow| m.unstable()),
        column("undecided", "1", "whether σ is within its error", |(m, ..): &ComplexModeRow| {
            m.verdict() == Verdict::Undecided
        }),
        column(
            "growth_structural_damping",
            "1/s",
            "part of σ by structural damping",
            |(m, ..): &ComplexModeRow| m.growth.structural_damping,
        ),
        column(
            "growth_falling_friction",
            "1/s",
            "part of σ by friction that falls with speed",
            |(m, ..): &ComplexModeRow| m.growth.falling_friction,
        ),
        column(
            "growth_transverse_friction",
            "1/s",
            "part of σ by friction across the sliding",
            |(m, ..): &ComplexModeRow| m.growth.transverse_friction,
        ),
        column(
            "growth_mode_coupling",
            "1/s",
            "part of σ by the unsymmetric stiffness",
            |(m, ..): &ComplexModeRow| m.growth.mode_coupling,
        ),
        column(
            "backward_error",
            "1",
            "η = ‖Q(λ)φ‖ / ((|λ|²‖M‖ + |λ|‖C‖ + ‖K‖)‖φ‖)",
            |(m, ..): &ComplexModeRow| m.backward_error,
        )
        .proof("η", |(m, ..)| power(m.backward_error)),
        column("eigenvalue_error", "1", "estimated |Δλ|/|λ|", |(m, ..): &ComplexModeRow| {
            m.eigenvalue_error
        })
        .proof("|Δλ|/|λ|", |(m, ..)| power(m.eigenvalue_error)),
        column("condition", "1", "condition number κ of λ", |(m, ..): &ComplexModeRow| m.condition)
            .proof("κ", |(m, ..)| significant(m.condition, 2)),
        column(
            "nodal_diameters",
            "1",
            "nodal diameters of the motion of the disc, where that has a tenth of the kinetic energy",
            |(_, _, disc, ..): &ComplexModeRow| disc.map(|disc| disc.nodal_diameters),
        ),
        column("nodal_circles", "1", "nodal circles of that motion", |(_, _, disc, ..): &ComplexModeRow| {
            disc.map(|disc| disc.nodal_circles)
        }),
        column(
            "unsplit_growth_rate",
            "1/s",
            "σ of an unstable mode, to first order, if the mesh did not split the double modes of bodies of revolution",
            |(_, _, _, without, _): &ComplexModeRow| *without,
        ),
        column(
            "unstable_by_mesh",
            "1",
            "whether the mode is unstable only by the asymmetry of the mesh: without that split it does not grow",
            |(mode, _, _, without, _): &ComplexModeRow| {
                without.is_some_and(|without| only_by_mesh(mode, without))
            },
        ),
        column(
            "part_mode",
            "text",
            "the most similar mode of a part alone, by kinetic energy times MAC",
            |(.., alone): &ComplexModeRow| alone.map(|alone| alone.name.clone()),
        ),
        column(
            "part_mode_mac",
            "1",
            "MAC with it at the nodes of the part",
            |(.., alone): &ComplexModeRow| alone.map(|alone| alone.mac),
        ),
        column(
            "participation",
            "text",
            "the real modes that take part",
            |(_, words, ..): &ComplexModeRow| (*words).to_string(),
        )
        .shown("real modes that take part", |(_, words, ..)| (*words).to_string()),
    ]
}

/// Growth without the split below this part of that with it is the error of first order.
const FIRST_ORDER: f64 = 0.01;

/// Whether a growth `without` the split of double modes is none: at most the error of λ, or what is left of first order.
fn only_by_mesh(mode: &ComplexMode, without: f64) -> bool {
    let resolved = mode.resolution().max(ROUND_OFF * mode.eigenvalue.norm());
    mode.unstable() && without <= resolved.max(FIRST_ORDER * mode.growth_rate())
}

impl ComplexResult {
    /// σ of mode `k` without the split of double modes \[1/s\], where it is known.
    pub fn growth_without_split(&self, k: usize) -> Option<f64> {
        self.without_split.get(k).copied().flatten()
    }

    /// Whether mode `k` is unstable only because the mesh of a body of revolution is not symmetric.
    pub fn unstable_by_mesh(&self, k: usize) -> bool {
        self.growth_without_split(k).is_some_and(|without| only_by_mesh(&self.modes.modes[k], without))
    }
}

fn close_call_columns() -> Vec<Column<CloseCall>> {
    vec![
        column("frequency_hz", "Hz", "ω/2π of the mode", |call: &CloseCall| call.frequency_hz),
        column("growth_rate", "1/s", "σ of the mode", |call: &CloseCall| call.growth_rate),
        column("distance", "1/s", "distance from the contour", |call: &CloseCall| call.distance),
        column("inside", "1", "whether it counts as inside", |call: &CloseCall| call.inside),
    ]
}

fn certificate_columns() -> Vec<Column<Certificate>> {
    type Count = Certificate;
    vec![
        column("holds", "1", "whether as many were found as were counted, at full order", |c: &Count| {
            c.holds()
        }),
        column(
            "band_hz",
            "Hz",
            "frequencies of the region; from zero on with the conjugates",
            |c: &Count| c.band_hz,
        )
        .along(Dimension::limits()),
        column("growth_rate", "1/s", "growth rates of the region", |c: &Count| c.growth)
            .along(Dimension::limits()),
        column("unstable_counted", "1", "eigenvalues counted in the region", |c: &Count| c.counted),
        column("unstable_found", "1", "eigenvalues found in the region", |c: &Count| c.found),
        column(
            "margin",
            "1",
            "least margin on the contour; the count holds at full order above 1",
            |c: &Count| c.margin,
        ),
        column("tightest_hz", "Hz", "frequency on the contour where the margin is least", |c: &Count| {
            c.tightest[0]
        }),
        column("points", "1", "points of the contour", |c: &Count| c.points),
        column("structure_poles", "1", "zeros of the oscillators in the region", |c: &Count| {
            c.structure_poles
        }),
        column("dissipative", "1", "whether the damping is known to dissipate", |c: &Count| c.dissipative),
        column("nothing_faster", "1", "whether no eigenvalue of the band grows faster", |c: &Count| {
            c.nothing_faster
        }),
        column(
            "proven",
            "1",
            "whether it is a proof but for rounding, the real modes taken as exact",
            |c: &Count| c.proven,
        ),
    ]
}

fn second_method_columns() -> Vec<Column<Confirmation>> {
    vec![
        column("holds", "1", "whether both methods found the same modes", |c: &Confirmation| c.holds()),
        column("shifts", "1", "shifts at which the full order was factorised", |c: &Confirmation| c.shifts),
        column("confirmed", "1", "modes that both found", |c: &Confirmation| c.confirmed),
        column("largest_difference", "1", "largest |Δλ|/|λ| of those", |c: &Confirmation| {
            c.largest_difference
        }),
        column("condition", "1", "condition number of that eigenvalue", |c: &Confirmation| c.condition),
    ]
}

impl Describe for ComplexResult {
    fn describe(&self) -> Group<'_> {
        let count = |verdict| self.modes.modes.iter().filter(|m| m.verdict() == verdict).count();
        let band = self.band_hz.to_vec();
        let squeal: Vec<(f64, String)> = self.measured_squeal_hz.clone();
        let squeal_columns = [
            column("frequency_hz", "Hz", "frequency", |(hz, _): &(f64, String)| *hz),
            column("source", "text", "source", |(_, source): &(f64, String)| source.clone()),
        ];
        let group = Group::new("cea", "complex eigenvalues at steady sliding")
            .with(Variable::reals("band_hz", "Hz", "band of the analysis", vec![Dimension::limits()], band))
            .value("unstable", "1", "unstable modes", count(Verdict::Unstable))
            .value("undecided", "1", "modes with σ within its error", count(Verdict::Undecided))
            .value("not_accurate", "1", "modes that are not accurate", count(Verdict::Inaccurate))
            .value("subspace_dimension", "1", "dimension of the subspace", self.modes.subspace_dimension)
            .value("refinements", "1", "steps of refinement", self.modes.refinements)
            .value(
                "contact_closed",
                "1",
                "whether the real modes that take part are those with the contact closed",
                self.contact_closed,
            )
            .value(
                "modal_damping_below_hz",
                "Hz",
                "frequency up to which real modes have the modal damping of the whole",
                self.modal_damping_below_hz,
            )
            .table(self.with_vectors())
            .optional("certificate", self.certificate.as_ref().map(certificate))
            .optional("second_method", self.confirmation.as_ref().map(second_method))
            .table(Table::of("measured_squeal", "measurement", &squeal_columns, &squeal));
        match &self.shares {
            Some(shares) => group.table(shares.table("part_shares", "complex_modes_parts".into())),
            None => group,
        }
    }
}

impl ComplexResult {
    /// Shape φ of mode `k`, counted from 0, at every node: (ux, uy, uz, rx, ry, rz), n_nodes × 6
    /// \[1/√kg, 1/(m √kg)\]. It is worked out at each call from the vector on the free degrees of freedom.
    pub fn shape(&self, k: usize) -> NodalField<c64> {
        self.dofs.expand_complex(&self.modes.modes[k].right)
    }

    /// The modes, one a row.
    pub(crate) fn mode_table(&self) -> Table<'static> {
        let row = |(k, mode)| -> ComplexModeRow {
            let words = self.participation.get(k).map_or("", String::as_str);
            let alone = self.shares.as_ref().and_then(|shares| shares.part_mode(k));
            (mode, words, self.discs.get(k).copied().flatten(), self.growth_without_split(k), alone)
        };
        let modes: Vec<ComplexModeRow> = self.modes.modes.iter().enumerate().map(row).collect();
        Table::of("eigenvalues", "mode", &columns(), &modes).file("complex_modes")
    }

    fn with_vectors(&self) -> Table<'_> {
        let modes = &self.modes.modes;
        let table = self.mode_table();
        let rows = table.rows.clone();
        let along = |more: &[Dimension]| std::iter::once(&rows).chain(more).cloned().collect::<Vec<_>>();
        let eigenvalues = Values::Complexes(modes.iter().map(|m| m.eigenvalue).collect());
        let mut table =
            table.field(Variable::new("eigenvalue", "1/s", "λ = σ + iω", vec![rows.clone()], eigenvalues));
        let n_nodes = if modes.is_empty() { 0 } else { self.dofs.n_nodes() };
        let right = Values::ComplexRows(Box::new(|k| self.shape(k).into_flattened()));
        let dimensions = along(&[Dimension::indexed("node", n_nodes), Dimension::freedoms()]);
        table =
            table.field(Variable::new("right", SHAPE_UNITS, "φ at every node, φᴴMφ = 1", dimensions, right));
        if let Some(n_dofs) = modes.first().map(|m| m.left.len()).filter(|n| *n > 0) {
            let left = Values::ComplexRows(Box::new(|k| modes[k].left.clone()));
            let story = "ψ on the free degrees of freedom of the solver, ψᴴQ(λ) = 0";
            let dimensions = along(&[Dimension::indexed("dof", n_dofs)]);
            table = table.field(Variable::new("left", SHAPE_UNITS, story, dimensions, left));
        }
        let n_real = modes.iter().flat_map(|m| &m.participation).map(|(k, _)| k + 1).max().unwrap_or(0);
        let real = Dimension::numbered("real_mode", n_real);
        let shares = move |k: usize| {
            let mut row = vec![0.0; n_real];
            modes[k].participation.iter().for_each(|(k, share)| row[*k] = *share);
            row
        };
        let story = "share of each real mode of the system";
        let shares = Values::RealRows(Box::new(shares));
        table = table.field(Variable::new(
            "real_mode_share",
            "1",
            story,
            along(std::slice::from_ref(&real)),
            shares,
        ));
        let names = (0..n_real).map(|k| self.real_modes.get(k).cloned().unwrap_or_default()).collect();
        table.field(Variable::texts("real_mode_name", "names of the real modes", real, names))
    }
}

/// The count of the unstable eigenvalues.
fn certificate(count: &Certificate) -> Group<'static> {
    Group::of(
        "certificate",
        "eigenvalues that grow, counted without looking for them",
        &certificate_columns(),
        count,
    )
    .table(Table::of("close_calls", "call", &close_call_columns(), &count.close_calls))
}

/// Results of two-level Arnoldi on the full order.
fn second_method(confirmation: &Confirmation) -> Group<'static> {
    let hz = |key: &'static str, description: &'static str, all: &[c64]| {
        let dimension = Dimension::of_variable(key, all.len());
        Variable::reals(key, "Hz", description, vec![dimension], all.iter().map(|z| z.im / TAU).collect())
    };
    Group::of("second_method", "two-level Arnoldi on the full order", &second_method_columns(), confirmation)
        .with(hz("missed_hz", "modes that only the second method found", &confirmation.missed))
        .with(hz("unconfirmed_hz", "modes that only the analysis found", &confirmation.unconfirmed))
}
