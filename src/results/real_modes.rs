//! Real modes of one part or of the whole.

use super::{NodalField, PartMode, PartShares, file_name};
use crate::dataset::{Column, Describe, Dimension, Group, Table, Values, Variable, column};
use crate::modal::{DiscModeName, RealModes};
use crate::structure::DofMap;
use std::sync::Arc;

/// Units of a mass-normalised displacement and rotation: φᵀMφ = 1.
pub(super) const SHAPE_UNITS: &str = "1/√kg, 1/(m √kg)";

/// The real modes of one part or of the whole.
#[derive(Debug, Clone)]
pub struct NamedModes {
    /// `disc`, `rig`, `rig with closed contact` …
    pub name: String,
    /// Eigenvalues, shapes on the free degrees of freedom, errors and certificate.
    pub modes: RealModes,
    /// From those degrees of freedom to the nodes.
    pub dofs: Arc<DofMap>,
    /// The part with the largest share of each mode's kinetic energy; `None` where only points move.
    pub moving_part: Vec<Option<String>>,
    /// The name of each mode, where the part is a disc and the mode bends it.
    pub names: Vec<Option<DiscModeName>>,
    /// Effective mass of each mode for translations along x, y, z \[kg\].
    pub effective_mass: Vec<[f64; 3]>,
    /// Total mass \[kg\].
    pub total_mass: f64,
    /// ζ of each mode by the damping of the case.
    pub damping_ratio: Vec<f64>,
    /// Shares of the parts in each mode; `None` of imported matrices.
    pub shares: Option<PartShares>,
    /// Whether `modes_<set>.uff` is wanted.
    pub universal: bool,
}

/// A mode of a set by its index.
type RealModeRow<'a> = (&'a NamedModes, usize);

fn columns<'a>() -> Vec<Column<RealModeRow<'a>>> {
    let name = |(set, k): &RealModeRow| set.names.get(*k).copied().flatten();
    fn alone<'a>((set, k): &RealModeRow<'a>) -> Option<&'a PartMode> {
        set.shares.as_ref()?.part_mode(*k)
    }
    vec![
        column("frequency_hz", "Hz", "natural frequency ω/2π", |(set, k): &RealModeRow| {
            set.modes.frequency_hz(*k)
        }),
        column("eigenvalue", "rad^2/s^2", "ω² as computed", |(set, k): &RealModeRow| {
            set.modes.eigenvalues[*k]
        }),
        column("moving_part", "text", "the part with the most kinetic energy", |(set, k): &RealModeRow| {
            set.moving_part.get(*k).cloned().flatten()
        }),
        column("nodal_diameters", "1", "nodal diameters of a disc's mode", move |mode: &RealModeRow| {
            name(mode).map(|name| name.nodal_diameters)
        }),
        column("nodal_circles", "1", "nodal circles of a disc's mode", move |mode: &RealModeRow| {
            name(mode).map(|name| name.nodal_circles)
        }),
        column("effective_mass_kg", "kg", "modal effective mass along x, y, z", |(set, k): &RealModeRow| {
            set.effective_mass.get(*k).copied()
        })
        .along(Dimension::axes()),
        column("damping_ratio", "1", "ζ by the damping of the case", |(set, k): &RealModeRow| {
            set.damping_ratio.get(*k).copied()
        }),
        column("part_mode", "text", "the most similar mode of a part alone, by kinetic energy times MAC", {
            move |mode: &RealModeRow| alone(mode).map(|alone| alone.name.clone())
        }),
        column("part_mode_mac", "1", "MAC with it at the nodes of the part", move |mode: &RealModeRow| {
            alone(mode).map(|alone| alone.mac)
        }),
        column(
            "backward_error",
            "1",
            "η = ‖Kφ − ω²Mφ‖ / ((‖K‖ + |ω²| ‖M‖) ‖φ‖)",
            |(set, k): &RealModeRow| set.modes.backward_errors[*k],
        ),
    ]
}

impl Describe for NamedModes {
    fn describe(&self) -> Group<'_> {
        let group = Group::new("", "").list("mode_sets", vec![self.summary()]).parts(
            "modes",
            "set",
            vec![self.table()],
        );
        let Some(shares) = &self.shares else { return group };
        let file = file_name("mode_parts", &self.name);
        group.parts("part_shares", "set", vec![shares.table(&self.name, file)])
    }
}

impl NamedModes {
    /// Shape φ of mode `k`, counted from 0, at every node: (ux, uy, uz, rx, ry, rz), n_nodes × 6
    /// \[1/√kg, 1/(m √kg)\]; zero outside the part. It is worked out at each call from the vector on the free degrees of
    /// freedom.
    pub fn shape(&self, k: usize) -> NodalField<f64> {
        self.dofs.expand(self.modes.shapes.col_as_slice(k))
    }

    /// The modes, one a row, with their shapes.
    fn table(&self) -> Table<'_> {
        let modes: Vec<RealModeRow> = (0..self.modes.len()).map(|k| (self, k)).collect();
        let table = Table::of(&*self.name, "mode", &columns(), &modes).file(file_name("modes", &self.name));
        if self.modes.is_empty() {
            return table;
        }
        let nodes = Dimension::indexed("node", self.dofs.n_nodes());
        let dimensions = vec![table.rows.clone(), nodes, Dimension::freedoms()];
        let rows = Values::RealRows(Box::new(|k| self.shape(k).into_flattened()));
        table.field(Variable::new(
            "shapes",
            SHAPE_UNITS,
            "shapes φ at every node, φᵀMφ = 1",
            dimensions,
            rows,
        ))
    }

    /// Number of modes, and the Sturm count beside them.
    fn summary(&self) -> Group<'_> {
        let count = &self.modes.certificate;
        let shifts = Dimension::numbered("shift", 2);
        let counted = Values::Integers(count.counted.iter().map(|n| *n as i64).collect());
        let certificate = Group::new("certificate", "Sturm count: eigenvalues below two shifts, by inertia")
            .value("below_hz", "Hz", "the frequency below which the modes are complete", count.below_hz)
            .with(Variable::reals(
                "shifts_hz",
                "Hz",
                "shifts of the count",
                vec![shifts.clone()],
                count.shifts_hz.to_vec(),
            ))
            .with(Variable::new("counted", "1", "eigenvalues below each shift", vec![shifts], counted))
            .value("found", "1", "modes that were found", count.found)
            .value("holds", "1", "whether no mode is missing", count.holds());
        Group::new(&*self.name, "a set of real modes")
            .value("modes", "1", "number of modes", self.modes.len())
            .value(
                "rigid_bodies",
                "1",
                "how many of them move the body as a rigid one",
                self.modes.rigid_bodies,
            )
            .value(
                "negative",
                "1",
                "how many of them have ω² < 0: the state is unstable, and leaves it as exp(√(−ω²) t)",
                self.modes.negative,
            )
            .value("total_mass_kg", "kg", "total mass", self.total_mass)
            .group(certificate)
    }
}
