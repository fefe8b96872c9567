//! `[contact.NAME]`: what presses and slides, and its laws.

use crate::contact::Sliding;
pub use crate::contact::{FrictionCurve, FrictionSense as Sense};
use crate::schema::units::*;
use crate::schema::{Derivative, Form, Invalidates, Report, Units, Value, choices, declare, key, variants};
use std::f64::consts::FRAC_PI_4;
use std::ops::Bound;
use toml::de::DeValue;

declare! {
    /// A contact pair.
    pub struct Contact, checked by check {
        /// The contact points themselves; only with matrices, where they stand for the regions.
        pub points: Option<ContactPoints> =
            key::value("the path of a table (CSV), or rows of normal, t1 and perhaps t2").optional(),
        /// Region of the body: rim lines or a face of a shell, faces of a solid, or a point.
        pub body: String = region(points.is_some(), "a region of rim lines, of faces, or of a point"),
        /// The counter-body: a shell, a region of faces of a shell or a solid, or `ground`.
        pub counter: String = region(points.is_some(), "a region, or \"ground\""),
        /// Direction in which the body moves into the ground; only for a contact with the ground.
        pub into: Option<[f64; 3]> = key::direction().optional().invalidates(Invalidates::Interface),
        /// Contact points across the thickness of a rim: 2, one at each edge, or 1, in the middle.
        pub points_across: usize = key::whole(1..=2).or(2),
        /// Points with a larger initial gap are left out \[m\].
        pub reach: f64 = key::quantity(LENGTH)
            .positive()
            .or(1e-3)
            .invalidates(Invalidates::Interface)
            .derivative(|_, _| Derivative::None("it only decides which contact points are considered")),
        /// Normal load or approach of the pair.
        pub pressing: Pressing = key::flat(),
        /// Gaps of the points within reach: those of the meshes, or none.
        pub initial_gap: InitialGap =
            key::choice().or(InitialGap::Geometry).invalidates(Invalidates::Interface),
        /// How the counter-body moves past the body.
        pub sliding: SlidingChoice = key::flat(),
        /// How far the counter-body travels in all along the sliding direction \[m\]; it must stay under the body.
        pub stroke: f64 = {
            let given = points.is_some();
            key::quantity(LENGTH)
                .non_negative()
                .check("0 beside `points`, which do not travel", move |v| !given || *v == 0.0)
                .or(0.0)
                .invalidates(Invalidates::Interface)
                .derivative(|_, _| Derivative::None("it only decides which contact points are considered"))
        },
        /// Tilts and moves everything connected to the body; as meshed when absent.
        pub placement: Option<Placement> = key::table().optional(),
        /// Normal law.
        pub normal: Normal = key::table()
            .required("a table with `per` and a `stiffness` above zero")
            .invalidates(Invalidates::Law),
        /// Friction law.
        pub friction: Friction = key::table()
            .required("a table such as { law = \"coulomb\", mu0 = 0.4 }")
            .invalidates(Invalidates::Law),
        /// Tangential stiffness before a point slips: by default the normal one where nothing slides, and where faces of solids touch, whose
        /// points are more than what they could hold rigidly; else none.
        pub bristle: Option<BristleChoice> = {
            let (per, slides) = (normal.per, sliding.rate() != 0.0);
            key::table()
                .invalidates(Invalidates::Law)
                .optional()
                .beforehand(move |b: &mut BristleChoice| (b.per, b.slides) = (per, slides))
        },
    }
}

/// A region of a mesh, which is not there where the contact points are given.
fn region(given: bool, expected: &'static str) -> crate::schema::Field<String> {
    if given { key::text() } else { key::name(expected).required_sometimes("required without `points`") }
}

fn check(contact: &Contact, report: &mut Report) {
    let given = contact.points.is_some();
    let on_mesh = [
        ("body", !contact.body.is_empty()),
        ("counter", !contact.counter.is_empty()),
        ("into", contact.into.is_some()),
        ("placement", contact.placement.is_some()),
        ("initial_gap", contact.initial_gap != InitialGap::Geometry),
        ("rotation", matches!(contact.sliding, SlidingChoice::About { .. })),
    ];
    for (key, _) in on_mesh.into_iter().filter(|(_, there)| given && *there) {
        report.fault(key, "a place on a mesh", "no such key beside `points`", "Remove it");
    }
    if !given && !contact.body.is_empty() && contact.body == contact.counter {
        let expected =
            "another region than the `body`: a body is in contact with another one, or with the \"ground\"";
        report.fault("counter", format!("\"{}\", the body itself", contact.counter), expected, "");
    }
    let pressure = contact.normal.per.pressure();
    for (_, text) in report.given("friction.pressure") {
        if let Err(found) = parse_of_scalar(&text, pressure) {
            report.fault("friction.pressure", found, pressure.name, "");
        }
    }
    let ground = contact.counter == "ground";
    if ground && contact.into.is_none() {
        let expected = "the direction in which the body moves into the ground, such as [0, 0, -1]";
        report.fault("into", "nothing", expected, "");
    }
    if !ground && !given && contact.into.is_some() {
        report.fault("into", "a direction", "no such key for a contact between two parts", "Remove it");
    }
    if contact.stroke > 0.0 && matches!(contact.sliding, SlidingChoice::About { .. }) {
        let expected = "no such key beside `rotation`: a counter-body that turns keeps its place";
        report.fault("stroke", "a way along a direction", expected, "Remove it");
    }
    let rests = contact.rests() && !report.unread("sliding_velocity") && !report.unread("rotation");
    if rests && contact.stroke > 0.0 {
        report.fault("stroke", "a way along a direction", "none where nothing slides", "Remove it");
    }
    if rests && contact.bristle.is_none() && contact.normal.stiffness == 0.0 {
        let expected = "{ stiffness = … }, the tangential stiffness, as the normal one is cubic alone";
        report.fault("bristle", "nothing", expected, "");
    }
    if contact.bristle.is_none() && !rests {
        return;
    }
    if contact.friction.regularisation > 0.0 {
        let expected = "none where points stick elastically (with a `bristle`, or without sliding)";
        report.fault("friction.regularisation", "a velocity", expected, "");
    }
    if contact.friction.sense != Sense::WithSlip {
        report.fault("friction.sense", "against_sliding", "with_slip where points stick elastically", "");
    }
    if !contact.normal.unilateral {
        let expected = "true where points stick elastically: a contact that pulls does not stick";
        report.fault("normal.unilateral", "false", expected, "");
    }
}

/// Contact points that are given, not found on a mesh.
///
/// A direction is a sum of degrees of freedom counted from 1, each with an optional factor before it:
/// `12 -45` is u₁₂ − u₄₅, `-3 +0.5*7` is −u₃ + ½ u₇. The normal closes the contact when u moves along it; the tangents
/// are the displacement of the body relative to the counter-body along and across the sliding direction.
#[derive(Debug, Clone, PartialEq)]
pub enum ContactPoints {
    /// A table (CSV) with the columns `normal`, `t1` and, when there are any, `t2`, `weight` (1), `gap` (0) \[m\],
    /// `speed` (1), the sliding velocity there over that of the pair, `x`, `y`, `z` \[m\].
    File(String),
    /// Rows of `normal`, `t1` and, when there is one, `t2`.
    Rows(Vec<Vec<String>>),
}

impl crate::schema::Blank for ContactPoints {
    fn blank() -> Self {
        ContactPoints::Rows(Vec::new())
    }
}

impl Value for ContactPoints {
    fn read(value: &DeValue, units: &Units, k: usize) -> Result<Self, String> {
        if let Some(file) = value.as_str() {
            let sound = key::is_name(file);
            return if sound {
                Ok(ContactPoints::File(file.into()))
            } else {
                Err(format!("the string {file:?}"))
            };
        }
        let rows: Vec<Vec<String>> = Value::read(value, units, k)?;
        match rows.iter().position(|row| !matches!(row.len(), 2 | 3)) {
            None if !rows.is_empty() => Ok(ContactPoints::Rows(rows)),
            None => Err("no rows".into()),
            Some(k) => Err(format!("a row of {}, row {}", rows[k].len(), k + 1)),
        }
    }

    fn to_toml(&self) -> Option<toml::Value> {
        match self {
            ContactPoints::File(file) => file.to_toml(),
            ContactPoints::Rows(rows) => rows.to_toml(),
        }
    }

    fn form() -> Form {
        let rows = Form::List(Box::new(Form::List(Box::new(Form::Text), None)), None);
        Form::Either(Box::new(Form::Text), Box::new(rows))
    }
}

choices! {
    /// Gaps between the bodies before anything moves.
    pub enum InitialGap {
        /// As the bodies are meshed or placed; where they overlap, they press.
        Geometry = "geometry",
        /// None at any point within reach: faces that fit, whose meshes do not.
        Closed = "closed",
    }
}

variants! {
    /// How the counter-body moves past the body: along one direction, or about an axis.
    #[derive(Copy)]
    pub enum SlidingChoice by presence or "sliding_velocity" {
        /// Along one direction.
        Along "sliding_velocity" {
            /// V \[m/s\] of the counter-body relative to the body along the sliding direction; 0 for bodies that do not slide, whose points
            /// stick elastically (`bristle`).
            sliding_velocity: f64 = key::quantity(VELOCITY)
                .derivative(at_rest)
                .invalidates(Invalidates::Equilibrium),
            /// Direction in which the counter-body slides.
            sliding_direction: [f64; 3] =
                key::direction().or([1.0, 0.0, 0.0]).invalidates(Invalidates::Interface),
        }
        /// About an axis.
        About "rotation" {
            /// The counter-body turns about an axis: every point slides across its own radius, at its own speed.
            rotation: ContactRotation =
                key::table().required("a table such as { axis = [0, 0, 1], speed = \"600 rpm\" }"),
        }
    }
}

/// Whether there is a derivative by a velocity of sliding.
fn at_rest(_: &[usize], velocity: f64) -> Derivative {
    match velocity == 0.0 {
        true => Derivative::None("at rest the contact sticks, at any other velocity it slides"),
        false => Derivative::Exists,
    }
}

impl Contact {
    /// Whether the bodies do not slide past each other.
    pub fn rests(&self) -> bool {
        self.sliding.rate() == 0.0
    }
}

impl SlidingChoice {
    /// The direction of sliding at every point.
    pub fn way(&self) -> Sliding {
        match self {
            SlidingChoice::Along { sliding_direction, sliding_velocity: 0.0 } => {
                Sliding::AtRest(*sliding_direction)
            }
            SlidingChoice::Along { sliding_direction, .. } => Sliding::Along(*sliding_direction),
            SlidingChoice::About { rotation } => {
                Sliding::About { axis: rotation.axis, point: rotation.point }
            }
        }
    }

    /// V \[m/s\] along one direction, Ω \[rad/s\] about an axis.
    pub fn rate(&self) -> f64 {
        match self {
            SlidingChoice::Along { sliding_velocity, .. } => *sliding_velocity,
            SlidingChoice::About { rotation } => rotation.speed,
        }
    }
}

declare! {
    /// A counter-body that turns about an axis relative to the body: v = Ω × (x − x₀).
    #[derive(Copy)]
    pub struct ContactRotation {
        /// Direction of the axis; the speed is right-handed about it.
        pub axis: [f64; 3] = key::direction().invalidates(Invalidates::Interface),
        /// x₀ \[m\], a point of the axis.
        pub point: [f64; 3] = key::quantities(LENGTH).or([0.0; 3]).invalidates(Invalidates::Interface),
        /// Ω \[rad/s\]; 0 for bodies that do not slide.
        pub speed: f64 = key::quantity(ANGULAR_VELOCITY)
            .derivative(at_rest)
            .label("speed of rotation")
            .invalidates(Invalidates::Equilibrium),
    }
}

variants! {
    /// Normal load or approach of a contact pair.
    #[derive(Copy)]
    pub enum Pressing by presence or "approach" {
        /// A normal load.
        Load "load" {
            /// ΣN \[N\].
            load: f64 = key::quantity(FORCE).positive().invalidates(Invalidates::Equilibrium),
        }
        /// A prescribed approach of the bodies, between which forces of the case may press, too.
        Approach "approach" {
            /// Approach \[m\]; 0 for the bodies as they are meshed or placed.
            approach: f64 = key::quantity(LENGTH).or(0.0).invalidates(Invalidates::Equilibrium),
        }
    }
}

declare! {
    /// Elastic bristles between the bodies, for sticking in time and where nothing slides; in the unit of the normal stiffness.
    pub struct BristleChoice {
        /// k_t.
        pub stiffness: f64 = key::quantity(per.dimensions()[0]).positive().derivative(in_time(*slides)),
        /// c_t.
        pub damping: f64 =
            key::quantity(per.dimensions()[2]).non_negative().or(0.0).derivative(in_time(*slides)),
    }
    also {
        /// Reference of the normal stiffness: a point, a length or an area.
        pub per: StiffnessPer,
        /// Whether the bodies slide: bristles act in time only then.
        pub slides: bool,
    }
}

/// Whether there are derivatives of eigenvalues by a bristle.
fn in_time(slides: bool) -> fn(&[usize], f64) -> Derivative {
    if slides { |_, _| Derivative::Zero } else { |_, _| Derivative::Exists }
}

declare! {
    /// Where the body stands on the counter-body.
    pub struct Placement {
        /// θ \[rad\]: body and all that hangs on it rotated about the lateral axis y through the body's centre; the
        /// lowest point moves towards −x when θ > 0.
        pub lead_angle: f64 = key::quantity(ANGLE)
            .within(Bound::Included(-FRAC_PI_4), Bound::Included(FRAC_PI_4))
            .or(0.0),
        /// x, y of the lowest point, from the middle of the counter-body's region \[m\].
        pub position: [f64; 2] = key::quantities(LENGTH).or([0.0; 2]),
    }
}

choices! {
    /// Reference of a contact stiffness.
    pub enum StiffnessPer {
        /// The one point nearest to the counter-body, on the ground the whole region, shared equally by its points \[N/m\].
        Point = "point",
        /// Length of a line contact \[N/m²\].
        Length = "length",
        /// Area of a face contact \[N/m³\].
        Area = "area",
    }
}

impl StiffnessPer {
    /// The dimension of a normal force.
    fn pressure(self) -> Dimension {
        let (power, symbol, example) = match self {
            StiffnessPer::Point => (0, "N", "a force such as \"20 N\", as `normal.per` is \"point\""),
            StiffnessPer::Length => {
                (1, "N/m", "a force per length such as \"2 kN/m\", as `normal.per` is \"length\"")
            }
            StiffnessPer::Area => (2, "Pa", "a pressure such as \"1 MPa\", as `normal.per` is \"area\""),
        };
        FORCE.per_metre(power, symbol, example)
    }

    /// The dimensions of stiffness, cubic stiffness and damping.
    fn dimensions(self) -> [Dimension; 3] {
        let (power, [plain, cubic, dashpot], example) = match self {
            StiffnessPer::Point => (0, ["N/m", "N/m^3", "N s/m"], "a stiffness such as \"10 MN/m\""),
            StiffnessPer::Length => {
                (1, ["N/m^2", "N/m^4", "N s/m^2"], "a stiffness per length such as \"10 GN/m^2\"")
            }
            StiffnessPer::Area => {
                (2, ["N/m^3", "N/m^5", "N s/m^3"], "a stiffness per area such as \"10 GN/m^3\"")
            }
        };
        [
            STIFFNESS.per_metre(power, plain, example),
            STIFFNESS.per_metre(power + 2, cubic, "a cubic stiffness: the unit of `stiffness` per m^2"),
            DASHPOT.per_metre(power, dashpot, "a damping constant: the unit of `stiffness` times s"),
        ]
    }
}

declare! {
    /// N = k_n δ + k_nl δ³ + c_n δ̇.
    pub struct Normal, checked by check_normal {
        /// Reference of the coefficients: a point, a length or an area.
        pub per: StiffnessPer =
            key::choice().expecting("what the stiffness belongs to: point, length or area"),
        /// k_n.
        pub stiffness: f64 = key::quantity(per.dimensions()[0]).non_negative(),
        /// k_nl.
        pub cubic: f64 = key::quantity(per.dimensions()[1]).non_negative().or(0.0).label("cubic stiffness"),
        /// c_n.
        pub damping: f64 = key::quantity(per.dimensions()[2]).non_negative().or(0.0),
        /// Never pulls.
        pub unilateral: bool = key::flag(true),
    }
}

fn check_normal(normal: &Normal, report: &mut Report) {
    if normal.stiffness == 0.0 && normal.cubic == 0.0 {
        report.fault("stiffness", "no contact stiffness", "a `stiffness` or a `cubic` above zero", "");
    }
}

declare! {
    /// μ(v, p).
    pub struct Friction {
        /// The friction coefficient.
        pub law: FrictionCurve = key::flat(),
        /// v_ε \[m/s\] of the regularised slip direction.
        pub regularisation: f64 = key::quantity(VELOCITY).non_negative().or(0.0),
        /// Which way friction pulls the body.
        pub sense: Sense = key::choice().or(Sense::WithSlip),
    }
}
