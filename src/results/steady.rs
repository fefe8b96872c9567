//! Steady sliding.

use super::{ContactSurface, NodalField};
use crate::dataset::{Column, Describe, Dimension, Group, Table, Values, Variable, column};
use crate::equilibrium::{PointState, SteadySliding};
use crate::mesh::Cell;
use crate::numbers::{given, significant};
use std::collections::BTreeMap;

/// Steady sliding, for people.
#[derive(Debug, Clone)]
pub struct SteadyResult {
    /// The solution.
    pub state: SteadySliding,
    /// Displacement of every node.
    pub displacement: NodalField<f64>,
    /// Pair name and position \[m\] of every contact point.
    pub points: Vec<(String, [f64; 3])>,
    /// The area that every contact point stands for \[m²\]; `None` where its stiffness is not one per area.
    pub areas: Vec<Option<f64>>,
    /// The faces that the points are on, of pairs whose bodies touch with faces.
    pub surfaces: Vec<ContactSurface>,
    /// Load \[N\] and sliding velocity \[m/s\] of each pair, with its name.
    pub pairs: Vec<(String, f64, f64)>,
    /// For each pair two unit vectors: where the load presses the body (the disc) and where the counter-body (the
    /// slider) moves. Pictures draw them as arrows; empty where the case has no geometry.
    pub directions: Vec<[[f64; 3]; 2]>,
}

/// A contact pair.
fn pair_columns<'a>() -> Vec<Column<PairTotals<'a>>> {
    type Pair<'a> = PairTotals<'a>;
    let micrometres = |length: Option<f64>| length.map_or("–".into(), |d| significant(1e6 * d, 3));
    let sum = "ΣF₁, ΣF₂, friction on the body";
    vec![
        column("name", "text", "name of the pair", |p: &Pair| p.name.to_string())
            .shown("pair", |p| p.name.to_string()),
        column("load_n", "N", "load", |p: &Pair| p.load).shown("load [N]", |p| given(p.load)),
        column(
            "sliding_velocity_m_per_s",
            "m/s",
            "sliding velocity V, of a counter-body that turns at the mean radius",
            |p: &Pair| p.sliding_velocity,
        )
        .shown("V [m/s]", |p| given(p.sliding_velocity)),
        column("normal_force_n", "N", "ΣN, positive in compression", |p: &Pair| p.normal_force)
            .shown("ΣN [N]", |p| significant(p.normal_force, 4)),
        column("friction_force_n", "N", sum, |p: &Pair| p.friction_force)
            .along(directions())
            .shown("ΣF₁, ΣF₂ [N]", |p| p.friction_force.map(|force| significant(force, 4)).join(", ")),
        column("points_closed", "1", "points that carry load", |p: &Pair| p.closed)
            .shown("closed", |p| p.closed.to_string()),
        column("points_open", "1", "points that do not", |p: &Pair| p.open)
            .shown("open", |p| p.open.to_string()),
        column("largest_penetration_m", "m", "largest δ", |p: &Pair| p.largest_penetration)
            .shown("deepest [µm]", move |p| micrometres(p.largest_penetration)),
        column("largest_pressure_pa", "Pa", "largest p = N/A, of points that stand for areas", |p: &Pair| {
            p.largest_pressure
        })
        .shown("p max [MPa]", |p| p.largest_pressure.map_or("–".into(), |p| significant(1e-6 * p, 3))),
        column("approach_m", "m", "approach of body and counter-body", |p: &Pair| p.approach)
            .shown("approach [µm]", move |p| micrometres(p.approach)),
    ]
}

/// The pair, the position, the pressure, the state in a word and as it is of a contact point.
type ContactPointRow<'a> = (&'a str, [f64; 3], Option<f64>, &'static str, &'a PointState);

fn point_columns<'a>() -> Vec<Column<ContactPointRow<'a>>> {
    vec![
        column("pair", "text", "name of the pair", |(pair, ..): &ContactPointRow| (*pair).to_string()),
        column("position_m", "m", "position", |(_, position, ..): &ContactPointRow| *position)
            .along(Dimension::axes()),
        column("penetration_m", "m", "δ, negative when open", |(.., state): &ContactPointRow| {
            state.penetration
        }),
        column("normal_force_n", "N", "N, positive in compression", |(.., state): &ContactPointRow| {
            state.forces.normal
        }),
        column(
            "pressure_pa",
            "Pa",
            "p = N/A, of a point that stands for an area",
            |(_, _, p, ..): &ContactPointRow| *p,
        ),
        column(
            "friction_force_n",
            "N",
            "F₁, F₂ on the body, along t₁ and t₂",
            |(.., state): &ContactPointRow| state.forces.friction,
        )
        .along(directions()),
        column("closed", "1", "whether the point carries load", |(.., state): &ContactPointRow| {
            state.closed()
        }),
        column(
            "state",
            "text",
            "open; sticking, where the bodies do not slide and friction is below its limit; or sliding",
            |(.., word, _): &ContactPointRow| *word,
        ),
    ]
}

/// t₁ and t₂.
fn directions() -> Dimension {
    Dimension::numbered("direction", 2)
}

impl Describe for SteadyResult {
    fn describe(&self) -> Group<'_> {
        let places = self.points.iter().zip(&self.state.points).zip(self.pressures()).zip(self.states());
        let points: Vec<ContactPointRow> = places
            .map(|((((pair, position), state), p), word)| (&**pair, *position, p, word, state))
            .collect();
        let mut points =
            Table::of("points", "point", &point_columns(), &points).file("contact_points").long();
        let rows = points.rows.clone();
        let forces = Dimension::named("force", &["N", "F1", "F2"]);
        let tangent = |key: &'static str,
                       unit: &'static str,
                       description: &'static str,
                       of: fn(&PointState) -> Vec<f64>,
                       more: Option<Dimension>| {
            let dimensions = [rows.clone(), forces.clone()].into_iter().chain(more).collect();
            let values = self.state.points.iter().flat_map(of).collect();
            Variable::reals(key, unit, description, dimensions, values)
        };
        points.fields = vec![
            tangent(
                "force_by_penetration",
                "N/m",
                "∂(N, F₁, F₂)/∂δ",
                |p| p.tangent.by_penetration.to_vec(),
                None,
            ),
            tangent(
                "force_by_penetration_rate",
                "N s/m",
                "∂(N, F₁, F₂)/∂δ̇",
                |p| p.tangent.by_penetration_rate.to_vec(),
                None,
            ),
            tangent(
                "force_by_slip_velocity",
                "N s/m",
                "∂(N, F₁, F₂)/∂(v₁, v₂)",
                |p| p.tangent.by_slip_velocity.as_flattened().to_vec(),
                Some(directions()),
            ),
            tangent(
                "force_by_slid",
                "N/m",
                "∂(N, F₁, F₂)/∂(Δ₁, Δ₂), what the counter-body slid, of points that stick",
                |p| p.tangent.by_slid.as_flattened().to_vec(),
                Some(directions()),
            ),
        ];
        let nodes = vec![Dimension::indexed("node", self.displacement.len()), Dimension::freedoms()];
        let displacement = Values::RealRows(Box::new(|node| self.displacement[node].to_vec()));
        Group::new("steady_sliding", "the state of steady sliding")
            .value("iterations", "1", "Newton iterations", self.state.iterations)
            .value("residual", "1", "relative residual of equilibrium", self.state.residual)
            .with(Variable::new("displacement", "m, rad", "displacement of every node", nodes, displacement))
            .table(self.pair_table())
            .table(points)
    }
}

impl SteadyResult {
    /// The pairs, one a row.
    pub(crate) fn pair_table(&self) -> Table<'static> {
        Table::by("pairs", "name", &pair_columns(), &self.totals())
    }
}

/// The sums over the points of one contact pair.
#[derive(Debug, Clone, PartialEq)]
pub struct PairTotals<'a> {
    /// The pair's name.
    pub name: &'a str,
    /// The load it was given \[N\].
    pub load: f64,
    /// Sliding velocity \[m/s\].
    pub sliding_velocity: f64,
    /// Approach \[m\].
    pub approach: Option<f64>,
    /// ΣN \[N\].
    pub normal_force: f64,
    /// ΣF₁, ΣF₂ \[N\], friction on the body.
    pub friction_force: [f64; 2],
    /// Points that carry load.
    pub closed: usize,
    /// Points that do not.
    pub open: usize,
    /// Largest δ \[m\] of the closed points.
    pub largest_penetration: Option<f64>,
    /// Largest p \[Pa\] of the closed points.
    pub largest_pressure: Option<f64>,
}

impl SteadyResult {
    /// p = N/A \[Pa\] of every contact point; `None` where its stiffness is not one per area.
    pub fn pressures(&self) -> impl Iterator<Item = Option<f64>> + '_ {
        self.state
            .points
            .iter()
            .zip(&self.areas)
            .map(|(state, area)| area.filter(|area| *area > 0.0).map(|area| state.forces.normal / area))
    }

    /// Whether each contact point is `open`, `sticking` or `sliding`: closed points stick where the sliding velocity of their pair is zero and they
    /// are below their friction limit.
    pub fn states(&self) -> impl Iterator<Item = &'static str> + '_ {
        let slides: BTreeMap<&str, bool> =
            self.pairs.iter().map(|(name, _, velocity)| (&**name, *velocity != 0.0)).collect();
        self.points.iter().zip(&self.state.points).map(move |((pair, _), state)| {
            match (state.closed(), slides.get(pair.as_str())) {
                (false, _) => "open",
                (true, Some(false)) if !state.slips => "sticking",
                (true, _) => "sliding",
            }
        })
    }

    /// The sums over each pair, in the order of [`SteadyResult::pairs`].
    pub fn totals(&self) -> Vec<PairTotals<'_>> {
        self.pairs.iter().enumerate().map(|(k, pair)| self.pair_totals(k, pair)).collect()
    }

    fn pair_totals<'a>(
        &'a self,
        k: usize,
        (name, load, sliding_velocity): &'a (String, f64, f64),
    ) -> PairTotals<'a> {
        let mut totals = PairTotals {
            name,
            load: *load,
            sliding_velocity: *sliding_velocity,
            approach: self.state.approach.get(k).copied(),
            normal_force: 0.0,
            friction_force: [0.0; 2],
            closed: 0,
            open: 0,
            largest_penetration: None,
            largest_pressure: None,
        };
        let points = self.points.iter().zip(&self.state.points).zip(self.pressures());
        for ((_, state), pressure) in points.filter(|(((pair, _), _), _)| pair == name) {
            totals.normal_force += state.forces.normal;
            totals.friction_force[0] += state.forces.friction[0];
            totals.friction_force[1] += state.forces.friction[1];
            if state.closed() {
                totals.closed += 1;
                let largest = totals.largest_penetration.unwrap_or(state.penetration);
                totals.largest_penetration = Some(largest.max(state.penetration));
                let largest = totals.largest_pressure;
                totals.largest_pressure = pressure.map(|p| largest.map_or(p, |largest| largest.max(p)));
            } else {
                totals.open += 1;
            }
        }
        totals
    }
}

/// Coordinates, faces by the surface, and their pressures and status.
type PressedFaces = (Vec<[f64; 3]>, Vec<(String, Vec<Cell>)>, Vec<(f64, i32)>);

impl SteadyResult {
    /// Faces of all surfaces on the nodes that they have: the coordinates \[m\], their faces by the pair, and for each face in this order
    /// its pressure ΣN/ΣA \[Pa\], zero where the points stand for no areas, and its status: 0 where no point is closed, 1 where all closed
    /// points stick, 2 where one slides.
    pub(crate) fn pressed_faces(&self, nodes: &[[f64; 3]]) -> PressedFaces {
        let (mut own, mut coordinates) = (BTreeMap::new(), Vec::new());
        let (mut parts, mut values) = (Vec::new(), Vec::new());
        let states: Vec<&str> = self.states().collect();
        for surface in &self.surfaces {
            let mut cells = Vec::with_capacity(surface.faces.len());
            for face in &surface.faces {
                for node in face.cell.nodes() {
                    own.entry(*node).or_insert_with(|| {
                        coordinates.push(nodes[*node]);
                        coordinates.len() - 1
                    });
                }
                cells.push(face.cell.renumbered(|node| own[&node]));
                let sum = |of: &dyn Fn(usize) -> f64| face.points.iter().map(|p| of(*p)).sum::<f64>();
                let area = sum(&|p| self.areas[p].unwrap_or(0.0));
                let force = sum(&|p| self.state.points[p].forces.normal);
                let has = |word: &str| face.points.iter().any(|p| states[*p] == word);
                let status = if has("sliding") { 2 } else { i32::from(has("sticking")) };
                values.push((if area > 0.0 { force / area } else { 0.0 }, status));
            }
            parts.push((format!("{} {}", surface.pair, surface.name), cells));
        }
        (coordinates, parts, values)
    }
}
