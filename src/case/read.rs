//! What each section of a case file may say. All faults of the file are found in one pass.

mod check;
#[cfg(test)]
mod tests;

pub(super) use self::check::unknown_name;
use self::check::{check_names, check_sensitivity};
use super::reader::{LARGEST, Quantity, Section, read_document};
use super::units::*;
use super::*;
use crate::error::Result;
use crate::error::text::read_text;
use crate::structure;
use std::f64::consts::FRAC_PI_4;
use std::ops::Bound;
use std::path::Path;

/// Reads and validates the case file at `path`.
///
/// # Errors
/// Every fault of the file, each with its line and key.
pub fn read_case(path: &Path) -> Result<Case> {
    let text = read_text(path, "a case file in TOML, such as `stridor new NAME` writes")?;
    let folder = path.parent().unwrap_or(Path::new(".")).to_path_buf();
    Case::parse(&path.display().to_string(), &text, folder)
}

impl Case {
    /// Reads a case from TOML text; `file` names it in faults and `folder` is where relative paths start.
    pub fn parse(file: &str, text: &str, folder: PathBuf) -> Result<Case> {
        read_document(file, text, |root| read_root(root, folder)).map(|(case, _)| case)
    }

    /// The quantities of the resolved case, each with its path, value, unit and bounds.
    ///
    /// # Errors
    /// A case that is made in code and has what no file may say.
    pub(super) fn quantities(&self) -> Result<Vec<Quantity>> {
        read_document("the resolved case", &self.to_toml(), |root| read_root(root, PathBuf::new()))
            .map(|(_, quantities)| quantities)
    }
}

fn read_root(root: &Section, folder: PathBuf) -> Case {
    let case = Case {
        title: root.text("title").or("untitled".into()),
        assumptions: root.texts("assumptions").or(Vec::new()),
        prestress: root.boolean("prestress").or(false),
        folder,
        places: root.places(),
        mesh: root.section("mesh", super::mesh::read),
        matrices: root.section("matrices", super::matrices::read),
        point: root
            .section("point", |s| {
                let position = |name: &String| (name.clone(), s.quantities(name, LENGTH).or([0.0; 3]));
                s.sound_names().iter().map(position).collect()
            })
            .unwrap_or_default(),
        material: collect(root, "material", read_material),
        shell: collect(root, "shell", |s| Shell {
            material: s.string("material").required("the name of a material"),
            thickness: s.quantity("thickness", LENGTH).positive().required(LENGTH.name),
            bending_only: s.boolean("bending_only").or(false),
            rotary_inertia: s.boolean("rotary_inertia").or(true),
        }),
        bar: collect(root, "bar", read_bar),
        mass: collect(root, "mass", |s| Mass {
            on: s.string("on").required("a region of points"),
            mass: s.quantity("mass", MASS).non_negative().required(MASS.name),
            inertia: s.quantities("inertia", INERTIA).or([0.0; 3]),
        }),
        spring: collect(root, "spring", read_spring),
        rigid: collect(root, "rigid", |s| Rigid {
            master: s.string("master").required("a region of one point"),
            follow: s.strings("follow").not_empty().required("regions that move with the master"),
        }),
        support: collect(root, "support", read_support),
        force: collect(root, "force", |s| Force {
            on: s.string("on").required("a region"),
            force: s.quantities("force", FORCE).required("three forces such as [0, \"1 N\", 0]"),
        }),
        contact: collect(root, "contact", read_contact),
        damping: root.section("damping", read_damping).unwrap_or_default(),
        modes: collect(root, "modes", read_modes),
        cea: root.section("cea", read_cea),
        sensitivity: root.section("sensitivity", read_sensitivity),
        transient: root.section("transient", super::transient::read),
        frf: collect(root, "frf", super::frf::read),
        measured: collect(root, "measured", super::measured::read),
        calibrate: None,
        sweep: BTreeMap::new(),
        map: BTreeMap::new(),
    };
    check_names(root, &case);
    super::measured::check(root, &case);
    check_sensitivity(root, &case);
    super::calibrate::read(root, super::explore::read(root, case))
}

pub(super) fn collect<T>(root: &Section, key: &str, read: impl Fn(&Section) -> T) -> BTreeMap<String, T> {
    root.named(key, |name, s| (name.to_string(), read(s))).into_iter().collect()
}

fn read_material(s: &Section) -> Material {
    Material {
        youngs_modulus: s.quantity("youngs_modulus", PRESSURE).positive().required(PRESSURE.name),
        poissons_ratio: s
            .quantity("poissons_ratio", NUMBER)
            .within(Bound::Excluded(-1.0), Bound::Excluded(0.5))
            .required("a number such as 0.3"),
        density: s.quantity("density", DENSITY).positive().required(DENSITY.name),
        loss_factor: s.quantity("loss_factor", NUMBER).non_negative().or(0.0),
        rayleigh: s
            .section("rayleigh", |r| structure::RayleighDamping {
                alpha: r.quantity("alpha", RATE).non_negative().or(0.0),
                beta: r.quantity("beta", TIME).non_negative().or(0.0),
            })
            .unwrap_or_default(),
    }
}

fn read_bar(s: &Section) -> Bar {
    let full = s.section("section", |f| structure::Section {
        area: f.quantity("area", AREA).positive().required(AREA.name),
        inertia_1: f.quantity("inertia_1", AREA_MOMENT).positive().required(AREA_MOMENT.name),
        inertia_2: f.quantity("inertia_2", AREA_MOMENT).positive().required(AREA_MOMENT.name),
        torsion: f.quantity("torsion", AREA_MOMENT).positive().required(AREA_MOMENT.name),
    });
    let diameter = s.quantity("diameter", LENGTH).positive();
    let profile = match full {
        Some(section) => {
            if s.has("diameter") {
                s.fault("diameter", "both `diameter` and `section`", "one of them", "");
            }
            Profile::Full { section }
        }
        None => Profile::Round { diameter: diameter.required("a diameter, or a [section] in full") },
    };
    Bar {
        material: s.string("material").required("the name of a material"),
        profile,
        orientation: s.direction("orientation").or([0.0, 0.0, 1.0]),
    }
}

fn read_spring(s: &Section) -> SpringSet {
    let rotational = s.boolean("rotational").or(false);
    let (stiffness, damping) =
        if rotational { (ROTATIONAL_STIFFNESS, ROTATIONAL_DASHPOT) } else { (STIFFNESS, DASHPOT) };
    SpringSet {
        on: s.string("on").required("a region"),
        to: s.string("to").optional(),
        direction: s.direction("direction").required("a direction such as [1, 0, 0]"),
        rotational,
        stiffness: s.quantity("stiffness", stiffness).non_negative().required(stiffness.name),
        damping: s.quantity("damping", damping).non_negative().or(0.0),
    }
}

/// The names of the six degrees of freedom of a node, in order.
pub(crate) const DOF_NAMES: [&str; 6] = ["ux", "uy", "uz", "rx", "ry", "rz"];

fn read_support(s: &Section) -> Held {
    let all = || DOF_NAMES.map(String::from).to_vec();
    let held = s
        .strings("held")
        .check("\"all\", or some of ux, uy, uz, rx, ry, rz", |list| {
            list.iter().all(|name| name == "all" || DOF_NAMES.contains(&name.as_str()))
        })
        .or(all());
    Held {
        on: s.strings("on").not_empty().required("a region, or a list of them"),
        held: if held.iter().any(|name| name == "all") { all() } else { held },
    }
}

fn read_contact(s: &Section) -> Contact {
    let points = if s.is_string("points") {
        s.string("points").optional().map(ContactPoints::File)
    } else {
        let three =
            |rows: &Vec<Vec<String>>| !rows.is_empty() && rows.iter().all(|r| matches!(r.len(), 2 | 3));
        s.string_rows("points")
            .check("rows of normal, t1 and perhaps t2", three)
            .optional()
            .map(ContactPoints::Rows)
    };
    let given = s.has("points");
    let region = |key: &str, expected: &str| {
        let found = s.string(key);
        if given { found.or(String::new()) } else { found.required(expected) }
    };
    let counter = region("counter", "a region, or \"ground\"");
    let ground = counter == "ground";
    for key in ["body", "counter", "into", "placement"].into_iter().filter(|key| given && s.has(key)) {
        s.fault(key, "a place on a mesh", "no such key beside `points`", "Remove it");
    }
    let load = s.quantity("load", FORCE).positive().optional();
    let approach = s.quantity("approach", LENGTH).optional();
    if load.is_some() && approach.is_some() {
        s.fault("approach", "both `load` and `approach`", "one of them", "");
    }
    let pressing = match (load, approach) {
        (Some(load), _) => Pressing::Load(load),
        (None, Some(approach)) => Pressing::Approach(approach),
        (None, None) => {
            if !s.has("load") && !s.has("approach") {
                s.fault("load", "nothing", "`load = \"20 N\"` (the normal load), or an `approach`", "");
            }
            Pressing::Approach(0.0)
        }
    };
    let into = s.direction("into").optional();
    if ground && into.is_none() && !s.has("into") {
        s.fault(
            "into",
            "nothing",
            "the direction in which the body moves into the ground, such as [0, 0, -1]",
            "",
        );
    }
    if !ground && !given && s.has("into") {
        s.fault("into", "a direction", "no such key for a contact between two parts", "Remove it");
    }
    let normal = s.section("normal", |n| {
        let per = n
            .choice("per", &["point", "length", "area"])
            .required("what the stiffness belongs to: point, length or area");
        let per = match per {
            "length" => StiffnessPer::Length,
            "area" => StiffnessPer::Area,
            _ => StiffnessPer::Point,
        };
        let [stiffness, cubic, damping] = contact_units(per);
        Normal {
            per,
            stiffness: n.quantity("stiffness", stiffness).non_negative().required(stiffness.name),
            cubic: n.quantity("cubic", cubic).non_negative().or(0.0),
            damping: n.quantity("damping", damping).non_negative().or(0.0),
            unilateral: n.boolean("unilateral").or(true),
        }
    });
    if normal.as_ref().is_none_or(|n| n.stiffness == 0.0 && n.cubic == 0.0) {
        s.fault("normal", "no contact stiffness", "a table with `per` and a `stiffness` above zero", "");
    }
    let per = normal.as_ref().map_or(StiffnessPer::Point, |n| n.per);
    let bristle = s.section("bristle", |b| {
        let [stiffness, _, damping] = contact_units(per);
        BristleChoice {
            stiffness: b.quantity("stiffness", stiffness).positive().required(stiffness.name),
            damping: b.quantity("damping", damping).non_negative().or(0.0),
        }
    });
    let friction = s.section("friction", read_friction);
    if friction.is_none() && !s.has("friction") {
        s.fault("friction", "nothing", "a table such as { law = \"coulomb\", mu0 = 0.4 }", "");
    }
    Contact {
        points,
        body: region("body", "a region of rim lines, of faces, or of a point"),
        counter,
        placement: s.section("placement", |p| Placement {
            lead_angle: p
                .quantity("lead_angle", ANGLE)
                .within(Bound::Included(-FRAC_PI_4), Bound::Included(FRAC_PI_4))
                .or(0.0),
            position: p.quantities("position", LENGTH).or([0.0; 2]),
        }),
        into,
        points_across: s.count("points_across").check("1 or 2", |n| *n <= 2).or(2),
        reach: s.quantity("reach", LENGTH).positive().or(1e-3),
        pressing,
        sliding_velocity: s
            .quantity("sliding_velocity", VELOCITY)
            .check("a velocity that is not zero (steady sliding has no state at rest)", |v| *v != 0.0)
            .required(VELOCITY.name),
        stroke: s
            .quantity("stroke", LENGTH)
            .non_negative()
            .check("0 beside `points`, which do not travel", |v| !given || *v == 0.0)
            .or(0.0),
        sliding_direction: s.direction("sliding_direction").or([1.0, 0.0, 0.0]),
        normal: normal.unwrap_or(Normal {
            per: StiffnessPer::Point,
            stiffness: 0.0,
            cubic: 0.0,
            damping: 0.0,
            unilateral: true,
        }),
        friction: friction.unwrap_or(Friction {
            law: FrictionCurve::Coulomb { mu0: 0.0 },
            regularisation: 0.0,
            sense: Sense::WithSlip,
        }),
        bristle,
    }
}

/// The units of stiffness, cubic stiffness and damping of a contact.
fn contact_units(per: StiffnessPer) -> [Dimension; 3] {
    let (power, [plain, cubic, dashpot], example) = match per {
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

fn read_friction(s: &Section) -> Friction {
    let coefficient = |key: &str| s.quantity(key, NUMBER).non_negative();
    const LAWS: [&str; 5] = ["coulomb", "exponential", "stribeck", "hyperbolic", "table"];
    let law = match s.choice("law", &LAWS).required("coulomb, exponential, stribeck, hyperbolic or table") {
        "exponential" => {
            let mu0 = coefficient("mu0").required("a friction coefficient");
            let at_rest = |mu1: &f64| mu0 + mu1 >= 0.0;
            FrictionCurve::Exponential {
                mu0,
                mu1: s
                    .quantity("mu1", NUMBER)
                    .check("a value with which μ at rest, mu0 + mu1, is zero or more", at_rest)
                    .required("a friction coefficient"),
                alpha: s.quantity("alpha", INVERSE_VELOCITY).non_negative().required(INVERSE_VELOCITY.name),
            }
        }
        "stribeck" => FrictionCurve::Stribeck {
            mu_static: coefficient("mu_static").required("a friction coefficient"),
            mu_kinetic: coefficient("mu_kinetic").required("a friction coefficient"),
            stribeck_velocity: s.quantity("stribeck_velocity", VELOCITY).positive().required(VELOCITY.name),
            exponent: s
                .quantity("exponent", NUMBER)
                .within(Bound::Included(1.0), Bound::Included(10.0))
                .or(2.0),
        },
        "hyperbolic" => FrictionCurve::Hyperbolic {
            mu_static: coefficient("mu_static").required("a friction coefficient"),
            decline: s.quantity("decline", INVERSE_VELOCITY).non_negative().required(INVERSE_VELOCITY.name),
        },
        "table" => {
            let ascending = |v: &Vec<f64>| !v.is_empty() && v.windows(2).all(|w| w[0] < w[1]);
            let velocity = s
                .quantity_list("velocity", VELOCITY)
                .check("velocities in ascending order", ascending)
                .required("a list of velocities");
            let pressure = s
                .quantity_list("pressure", NUMBER)
                .check("pressures in ascending order", ascending)
                .or(vec![0.0]);
            let mu = s
                .rows("mu", NUMBER)
                .check("one row a pressure, with one value of zero or more a velocity", |rows| {
                    rows.len() == pressure.len()
                        && rows.iter().all(|r| r.len() == velocity.len() && r.iter().all(|m| *m >= 0.0))
                })
                .required("rows of friction coefficients");
            FrictionCurve::Table { velocity, pressure, mu }
        }
        _ => FrictionCurve::Coulomb { mu0: coefficient("mu0").required("a friction coefficient") },
    };
    Friction {
        law,
        regularisation: s.quantity("regularisation", VELOCITY).non_negative().or(0.0),
        sense: match s.choice("sense", &["with_slip", "against_sliding"]).or("with_slip") {
            "against_sliding" => Sense::AgainstSliding,
            _ => Sense::WithSlip,
        },
    }
}

fn read_damping(s: &Section) -> StructureDamping {
    let pairs = s
        .pairs("modal_ratios", [FREQUENCY, NUMBER])
        .check("rows of a frequency and a ratio from 0 to below 1", |rows| {
            rows.iter().all(|[hz, ratio]| *hz >= 0.0 && (0.0..1.0).contains(ratio))
        });
    StructureDamping {
        modal_ratio: s
            .quantity("modal_ratio", NUMBER)
            .check("a ratio from 0 to below 1", |v| (0.0..1.0).contains(v))
            .or(0.0),
        modal_ratios: pairs.or(Vec::new()),
    }
}

fn read_modes(s: &Section) -> ModesAnalysis {
    let below = s.quantity("below", FREQUENCY).positive().optional();
    let count = s.count("count").optional();
    match (below, count) {
        (None, None) if !s.has("below") && !s.has("count") => {
            s.fault("below", "nothing", "`below = \"3 kHz\"`, or a `count` of modes", "");
        }
        (Some(_), Some(_)) => s.fault("count", "both `below` and `count`", "one of them", ""),
        _ => {}
    }
    ModesAnalysis {
        parts: s.strings("parts").or(Vec::new()),
        clamp: s.strings("clamp").or(Vec::new()),
        free: s.boolean("free").or(false),
        below,
        count,
        contact: match s.choice("contact", &["open", "closed"]).or("open") {
            "closed" => ContactState::Closed,
            _ => ContactState::Open,
        },
        frequency_scale: s.quantity("frequency_scale", NUMBER).positive().or(1.0),
        measured: s.quantity_list("measured", FREQUENCY).or(Vec::new()),
        measured_source: s.text("measured_source").or(String::new()),
        uff: s.boolean("uff").or(false),
    }
}

fn read_cea(s: &Section) -> CeaAnalysis {
    let nearest = s.quantity("nearest", FREQUENCY).positive().optional();
    let count = s.count("count").optional();
    if s.has("nearest") != s.has("count") {
        let absent = if s.has("count") { "nearest" } else { "count" };
        s.fault(absent, "nothing", "`nearest = \"2 kHz\"` and `count = 50` together", "");
    }
    let band =
        s.quantities("band", FREQUENCY).check("a lower and a higher frequency", |[a, b]| *a >= 0.0 && b > a);
    let band = match nearest {
        Some(hz) => band
            .check("a band that holds the frequency of `nearest`", |[a, b]| *a <= hz && hz <= *b)
            .or([0.0, (4.0 * hz).min(LARGEST)]),
        None => band.required("a band such as [0, \"6 kHz\"]"),
    };
    CeaAnalysis {
        nearest,
        count,
        band,
        basis_below: s
            .quantity("basis_below", FREQUENCY)
            .within(Bound::Included(band[1]), Bound::Unbounded)
            .or((1.5 * band[1]).min(LARGEST)),
        certify: s.boolean("certify").optional(),
        confirm: s.boolean("confirm").or(false),
        left_vectors: s.boolean("left_vectors").or(true),
        measured_squeal: s.quantity_list("measured_squeal", FREQUENCY).or(Vec::new()),
        measured_source: s.text("measured_source").or(String::new()),
    }
}

fn read_sensitivity(s: &Section) -> SensitivityAnalysis {
    let default = SensitivityAnalysis::default();
    SensitivityAnalysis {
        modes: s
            .quantity_list("modes", FREQUENCY)
            .check("frequencies of zero or more", |list| list.iter().all(|f| *f >= 0.0))
            .or(Vec::new()),
        parameters: s.strings("parameters").or(default.parameters),
        advice: s.boolean("advice").or(default.advice),
        mass: s.quantity("mass", MASS).positive().or(default.mass),
        damper: s.quantity("damper", DASHPOT).positive().or(default.damper),
        verify: s.boolean("verify").or(default.verify),
    }
}
