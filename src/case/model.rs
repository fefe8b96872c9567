//! `[shell]`, `[bar]`, `[solid]`, `[mass]`, `[spring]`, `[rigid]`, `[averaging]`, `[tie]`, `[support]`, `[force]`, `[damping]`: the structure.

use crate::schema::units::*;
use crate::schema::{Derivative, Invalidates, Report, choices, declare, key, variants};
use crate::structure::{Integration, PlateTheory, Section};
use std::ops::Bound;

declare! {
    /// A plate.
    pub struct Shell, checked by check_shell {
        /// Material by name.
        pub material: String = key::name("the name of a material"),
        /// h \[m\].
        pub thickness: f64 = key::quantity(LENGTH).positive(),
        /// `kirchhoff`: thin, rigid in transverse shear; `mindlin`: with transverse shear and rotary inertia, for thick plates, too.
        pub theory: PlateTheory = key::choice().or(PlateTheory::Kirchhoff),
        /// Holds the membrane.
        pub bending_only: bool = key::flag(false),
        /// Counts rotary inertia, as Mindlin's theory always does.
        pub rotary_inertia: bool = key::flag(true),
    }
}

fn check_shell(shell: &Shell, report: &mut Report) {
    if shell.theory == PlateTheory::Mindlin && !shell.rotary_inertia {
        report.fault(
            "rotary_inertia",
            "false, with `theory = \"mindlin\"`",
            "true: without it the rotations of the section would have no mass",
            "Leave `rotary_inertia` out, or take `theory = \"kirchhoff\"`",
        );
    }
}

declare! {
    /// A bar.
    pub struct Bar {
        /// Material by name.
        pub material: String = key::name("the name of a material"),
        /// A vector in the plane of the section's first axis.
        pub orientation: [f64; 3] = key::direction().or([0.0, 0.0, 1.0]),
        /// Its section.
        pub profile: Profile = key::flat(),
    }
}

declare! {
    /// A solid.
    pub struct Solid {
        /// Material by name.
        pub material: String = key::name("the name of a material"),
        /// Takes 4-node tetrahedra, 5-node pyramids and 6-node wedges, too, which are far too stiff in bending and shear (locking).
        pub allow_locking: bool = key::flag(false),
        /// `full` or, of 20-node hexahedra, `reduced` (2 × 2 × 2 points): softer in bending, and less stiff where
        /// ν is near ½; a thousandth of the full stiffness holds its hourglass modes.
        pub integration: Integration = key::choice().or(Integration::Full),
    }
}

variants! {
    /// The section of a bar: a diameter that is a scalar of the case, or its properties in full.
    #[derive(Copy)]
    pub enum Profile by presence {
        /// A full round bar.
        Round "diameter" {
            /// d \[m\].
            diameter: f64 = key::quantity(LENGTH).positive(),
        }
        /// Any section.
        Full "section" {
            /// Its properties.
            section: Section = key::table(),
        }
    }
}

impl Profile {
    /// The properties of the section.
    pub fn section(&self) -> Section {
        match *self {
            Profile::Round { diameter } => Section::round(diameter),
            Profile::Full { section } => section,
        }
    }
}

declare! {
    /// A concentrated mass at every point of a region.
    pub struct Mass {
        /// The region.
        pub on: String = key::name("a region of points"),
        /// m \[kg\] at each node.
        pub mass: f64 = key::quantity(MASS).non_negative(),
        /// Moments of inertia about x, y, z \[kg m²\].
        pub inertia: [f64; 3] = key::quantities(INERTIA)
            .check("three moments of zero or more", |inertia| inertia.iter().all(|i| *i >= 0.0))
            .or([0.0; 3]),
    }
}

choices! {
    /// What the stiffness of springs belongs to.
    pub enum SpringPer {
        /// The region, shared equally by its nodes \[N/m\].
        Region = "region",
        /// The area of faces \[N/m³\].
        Area = "area",
    }
}

declare! {
    /// Springs from the nodes of a region to the ground or to a point, or spread between two faces.
    pub struct SpringSet, checked by check_spring {
        /// The region whose nodes are sprung.
        pub on: String = key::name("a region"),
        /// The other end, the ground when absent: a region of one point; per area a shell, or a region of faces, onto which the nodes
        /// of `on` are projected as those of a [tie].
        pub to: Option<String> = key::name("a region of one point; per area a shell, or a region of faces").optional(),
        /// Direction.
        pub direction: [f64; 3] = key::direction().expecting("a direction such as [1, 0, 0]"),
        /// Acts on rotations.
        pub rotational: bool = key::flag(false),
        /// What `stiffness` and `damping` belong to: the region, or its area.
        pub per: SpringPer = key::choice().or(SpringPer::Region),
        /// Total k \[N/m or N m\], shared equally by the nodes, or k per area \[N/m³\].
        pub stiffness: f64 = key::quantity(match per {
            SpringPer::Area => STIFFNESS.per_metre(2, "N/m^3", "a stiffness per area such as \"10 GN/m^3\""),
            SpringPer::Region if *rotational => ROTATIONAL_STIFFNESS,
            SpringPer::Region => STIFFNESS,
        })
        .non_negative(),
        /// Total c \[N s/m or N m s\], or c per area \[N s/m³\].
        pub damping: f64 = key::quantity(match per {
            SpringPer::Area => DASHPOT.per_metre(2, "N s/m^3", "a damping constant per area such as \"1 MN*s/m^3\""),
            SpringPer::Region if *rotational => ROTATIONAL_DASHPOT,
            SpringPer::Region => DASHPOT,
        })
        .non_negative()
        .or(0.0)
        .invalidates(Invalidates::Damping),
    }
}

fn check_spring(spring: &SpringSet, report: &mut Report) {
    if spring.rotational && spring.per == SpringPer::Area {
        let expected = "false with `per = \"area\"`: springs spread over faces act on displacements";
        report.fault("rotational", "true", expected, "");
    }
}

declare! {
    /// Regions that move as one rigid body with a point.
    pub struct Rigid {
        /// A region of one point.
        pub master: String = key::name("a region of one point"),
        /// The regions that follow.
        pub follow: Vec<String> = key::names("regions that move with the master").not_empty(),
    }
}

declare! {
    /// A point that moves as regions do in the mean: what is on it is spread over them, which it does not make stiffer.
    pub struct Averaging {
        /// A region of one point, which follows: with loads, masses, springs or sensors on it.
        pub point: String = key::name("a region of one point"),
        /// The regions whose mean motion it has, by least squares; nodes count by their share of areas or lengths.
        pub of: Vec<String> = key::names("regions whose mean motion the point has").not_empty(),
    }
}

declare! {
    /// Two surfaces that are joined although their meshes do not match.
    pub struct Tie {
        /// The surface that follows (slave): faces of a solid or a shell, or lines on the edge of a shell; best the one of the finer mesh.
        pub on: String = key::name("a region of faces, or of lines on the edge of a shell"),
        /// The surface that leads (master): a shell, or a region of faces of a shell or a solid.
        pub to: String = key::name("a shell, or a region of faces"),
        /// The largest gap that is joined \[m\]; gaps are kept, and nodes farther away are not joined. When not said: a tenth of the
        /// mean size of the faces of `to`.
        pub within: Option<f64> = key::quantity(LENGTH)
            .positive()
            .derivative(|_, _| Derivative::None("it only decides which nodes are joined"))
            .optional(),
    }
}

/// The names of the six degrees of freedom of a node, in order.
pub(crate) const DOF_NAMES: [&str; 6] = ["ux", "uy", "uz", "rx", "ry", "rz"];
/// The names of displacements about an axis: away from it, around it, along it.
pub(crate) const ABOUT_AXIS: [&str; 3] = ["radial", "tangential", "axial"];
/// What may be held.
const HELD: &str = "\"all\", or some of ux, uy, uz, rx, ry, rz; with an `axis` of radial, tangential, axial";

declare! {
    /// The axis of cylindrical directions.
    pub struct Axis {
        /// A point on it \[m\].
        pub through: [f64; 3] = key::quantities(LENGTH).or([0.0; 3]),
        /// Its direction.
        pub along: [f64; 3] = key::direction().or([0.0, 0.0, 1.0]),
    }
}

declare! {
    /// Held degrees of freedom of regions.
    pub struct Held, checked by check_held {
        /// The regions.
        pub on: Vec<String> = key::names("a region, or a list of them").not_empty(),
        /// Names of held degrees of freedom among ux, uy, uz, rx, ry, rz, with an `axis` among radial, tangential, axial, or `all`. Along
        /// an edge with no displacement the rotation about the normal of a membrane stays free: it is half the shear strain there.
        pub held: Vec<String> = key::names(HELD)
            .check(HELD, |list| {
                let known = |name: &str| DOF_NAMES.contains(&name) || ABOUT_AXIS.contains(&name);
                list.iter().all(|name| name == "all" || known(name))
            })
            .or(vec!["all".into()]),
        /// An axis about which displacements are held: radial, tangential, axial.
        pub axis: Option<Axis> = key::table().optional(),
    }
}

/// Names of the one kind or the other.
fn check_held(support: &Held, report: &mut Report) {
    let (names, help): (&[&str], _) = match support.axis {
        Some(_) => {
            (&ABOUT_AXIS, "Give rotations, and displacements along x, y, z, in a support of their own")
        }
        None => (&DOF_NAMES, "Give the axis, as `axis = { through = [0, 0, 0], along = [0, 0, 1] }`"),
    };
    let other = support.held.iter().find(|name| *name != "all" && !names.contains(&name.as_str()));
    if let Some(name) = other {
        let with = if support.axis.is_some() { "with" } else { "without" };
        let expected = format!("\"all\", or some of {}", names.join(", "));
        report.fault("held", format!("\"{name}\" {with} an `axis`"), expected, help);
    }
}

impl Held {
    /// Whether each of the six degrees of freedom is held.
    pub fn holds(&self) -> [bool; 6] {
        let along = ABOUT_AXIS.map(|name| self.names(name));
        let all = along == [true; 3];
        let mut number = 0..6;
        DOF_NAMES.map(|dof| self.names(dof) || number.next().is_some_and(|k| k < 3 && all))
    }

    /// Whether displacements away from the axis, around it and along it are held; none where all are ([`Held::holds`]).
    pub fn holds_about_axis(&self) -> [bool; 3] {
        let along = ABOUT_AXIS.map(|name| self.names(name));
        if along == [true; 3] { [false; 3] } else { along }
    }

    fn names(&self, dof: &str) -> bool {
        self.held.iter().any(|name| name == dof || name == "all")
    }
}

declare! {
    /// A force on a region, or a pressure on faces.
    pub struct Force {
        /// The region.
        pub on: String = key::name("a region"),
        /// What acts on it.
        pub load: ForceChoice = key::flat(),
    }
}

variants! {
    /// What acts on a region.
    #[derive(Copy)]
    pub enum ForceChoice by presence or "force" {
        /// A force shared equally by the nodes.
        Total "force" {
            /// Total force \[N\], shared equally by the nodes of the region.
            force: [f64; 3] = key::quantities(FORCE).expecting("three forces such as [0, \"1 N\", 0]"),
        }
        /// A pressure on faces of a solid or a shell.
        Pressure "pressure" {
            /// p \[Pa\], positive where it presses: inwards on the faces of a solid; on a shell against its normal, which is that of the right hand
            /// about the nodes of a face.
            pressure: f64 = key::quantity(PRESSURE).expecting("a pressure such as \"1 MPa\""),
        }
    }
}

declare! {
    /// Damping of the whole structure beyond its materials'.
    pub struct StructureDamping {
        /// ζ of every real mode up to `modal_below`, with contacts open.
        pub modal_ratio: f64 = key::quantity(NUMBER)
            .label("modal damping ratio")
            .within(Bound::Included(0.0), Bound::Excluded(1.0))
            .or(0.0),
        /// Real modes above this frequency \[Hz\] have no `modal_ratio`. When not said: 1.5 times the upper end of `cea.band` in
        /// what is about complex modes; in a frequency response twice the upper end of its band; elsewhere no limit.
        pub modal_below: Option<f64> = key::quantity(FREQUENCY)
            .positive()
            .derivative(|_, _| Derivative::None("it decides which modes are damped"))
            .optional(),
        /// ζ of single modes instead: (frequency near the mode \[Hz\], ζ).
        pub modal_ratios: Vec<[f64; 2]> = key::pairs([FREQUENCY, NUMBER])
            .check("rows of a frequency and a ratio from 0 to below 1", |rows| {
                rows.iter().all(|[hz, ratio]| *hz >= 0.0 && (0.0..1.0).contains(ratio))
            })
            .or(Vec::new())
            .derivative(|at, _| match at {
                [_, 0] => Derivative::None("it names a mode"),
                _ => Derivative::Exists,
            }),
    }
}
