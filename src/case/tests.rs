use super::*;
use crate::bounds::{Origin::*, within};
use crate::contact::Exponential;
use crate::schema::{Content, Derivative, DescribedTable, describe, json_schema, key_reference};

const RIG: &str = r#"
title = "A small rig"
assumptions = ["The hub's radius is not stated."]
prestress = true

[mesh]
file = "rig.msh"
unit = "mm"

[material.steel]
youngs_modulus = "210 GPa"
poissons_ratio = 0.3
density = 7850
rayleigh = { alpha = "1 1/s", beta = "1 us" }

[shell.disc]
material = "steel"
thickness = "1 mm"
rotary_inertia = false

[shell.slider]
material = "steel"
thickness = "10 mm"

[bar.bar]
material = "steel"
diameter = "20 mm"

[rigid.hub]
master = "bar_root"
follow = "hub"

[support.clamp]
on = "bar_clamp"

[spring.drive]
on = "slider"
direction = [1, 0, 0]
stiffness = "1 MN/m"
damping = "10 N*s/m"

[contact.rim]
body = "rim"
counter = "slider"
load = "20 N"
sliding_velocity = "0.1 m/s"
placement = { lead_angle = "4 deg", position = ["10 mm", 0] }
normal = { per = "length", stiffness = "10 GN/m^2", cubic = 1e18 }
friction = { law = "exponential", mu0 = 0.3, mu1 = 0.1, alpha = "5 s/m" }

[damping]
modal_ratio = "0.1 %"

[modes.disc]
parts = ["disc"]
clamp = ["hub"]
below = "3 kHz"
measured = [330, 936, 1697, 2600]
measured_source = "hammer"

[cea]
band = [0, "6 kHz"]
measured_squeal = [936, 1661, 2600]

[sensitivity]
modes = [936, "1.661 kHz"]
mass = "2 g"
verify = true
"#;

fn parse(text: &str) -> Result<Case> {
    Case::parse("rig.toml", text, PathBuf::from("."))
}

#[test]
fn the_resolved_case_reads_back_as_the_same_case() {
    let case = parse(RIG).unwrap();
    assert_eq!(case.shell["disc"].thickness, 1e-3);
    assert_eq!(case.contact["rim"].pressing, Pressing::Load { load: 20.0 });
    assert_eq!(case.contact["rim"].normal.stiffness, 1e10);
    assert_eq!(case.cea.as_ref().unwrap().basis_below, 9000.0);
    assert_eq!(parse(&case.to_toml()).unwrap(), case);
    let pairs =
        RIG.replace("modal_ratio = \"0.1 %\"", "modal_ratios = [[\"0.3 kHz\", \"2 %\"], [936, 0.01]]");
    let case = parse(&pairs).unwrap();
    assert_eq!(case.damping.modal_ratios, [[300.0, 0.02], [936.0, 0.01]]);
    assert_eq!(parse(&case.to_toml()).unwrap(), case);
}

#[test]
fn a_parameter_is_set_by_its_path() {
    let case = parse(RIG).unwrap();
    let other = case.with_parameter("contact.rim.friction.mu0", 0.5).unwrap();
    assert_eq!(
        other.contact["rim"].friction.law,
        FrictionCurve::Exponential { law: Exponential { mu0: 0.5, mu1: 0.1, alpha: 5.0 } }
    );
    let error = case.with_parameter("contact.rim.friction.mu", 0.5).unwrap_err().to_string();
    assert!(error.contains("contact.rim.friction.mu0"), "{error}");
    let error = case.with_parameter("material.steel.poissons_ratio", 0.5).unwrap_err();
    assert_eq!(error.exit_code(), 2);
}

#[test]
fn every_number_of_a_case_is_a_parameter_with_unit_and_bounds() {
    fn count(value: &toml::Value) -> usize {
        match value {
            toml::Value::Float(_) => 1,
            toml::Value::Table(t) => t.values().map(count).sum(),
            toml::Value::Array(list) => list.iter().map(count).sum(),
            _ => 0,
        }
    }
    let case = parse(RIG).unwrap();
    let parameters = case.parameters();
    assert_eq!(parameters.len(), count(&toml::Value::Table(to_toml(&case))));
    for p in &parameters {
        assert!(p.accepts(p.value), "{p:?}");
        assert_eq!(case.with_parameter(&p.path, p.value).unwrap(), case, "{}", p.path);
    }
    // The rig of this text is prestressed: its load changes the stiffness.
    assert_eq!(case.parameter("contact.rim.load").unwrap().invalidates, Invalidates::Structure);
    let free = Case { prestress: false, ..case };
    let one = |path: &str| free.parameter(path).unwrap();
    assert_eq!(one("contact.rim.load").invalidates, Invalidates::Equilibrium);
    let mu = one("contact.rim.friction.mu0");
    assert_eq!((mu.unit, mu.invalidates), ("", Invalidates::Law));
    assert!(!mu.accepts(-0.1) && mu.accepts(0.0));
    assert_eq!(one("contact.rim.normal.cubic").unit, "N/m^4");
    assert_eq!(one("spring.drive.damping").invalidates, Invalidates::Damping);
    let nu = one("material.steel.poissons_ratio");
    assert!(nu.invalidates == Invalidates::Structure && !nu.accepts(0.5) && nu.accepts(0.499));
    assert_eq!(one("modes.disc.measured.2").invalidates, Invalidates::Question);
}

/// A counter-body turns in place of sliding along a direction: its speed is a scalar, and what goes with a direction only is refused beside it.
#[test]
fn a_rotation_stands_in_place_of_a_sliding_velocity() {
    let rotation = "rotation = { axis = [1, 0, 0], point = [0, \"5 mm\", 0], speed = \"-300 rpm\" }";
    let turning = RIG.replace("sliding_velocity = \"0.1 m/s\"", rotation);
    let case = parse(&turning).unwrap();
    assert_eq!(parse(&case.to_toml()).unwrap(), case);
    let speed = case.parameter("contact.rim.rotation.speed").unwrap();
    assert_eq!(speed.unit, "rad/s");
    assert!(within((speed.value + 10.0 * std::f64::consts::PI).abs(), 1e-13, RoundOff));
    let fault = |more: &str| parse(&turning.replace(rotation, more)).unwrap_err().to_string();
    let both = fault(&format!("{rotation}\nsliding_velocity = 1"));
    assert!(both.contains("both `sliding_velocity` and `rotation`"), "{both}");
    let direction = fault(&format!("{rotation}\nsliding_direction = [1, 0, 0]"));
    assert!(direction.contains("`contact.rim.sliding_direction`: found an unknown key"), "{direction}");
    let stroke = fault(&format!("{rotation}\nstroke = 0.1"));
    assert!(stroke.contains("keeps its place"), "{stroke}");
    let nothing = fault("");
    assert!(nothing.contains("`contact.rim.sliding_velocity`"), "{nothing}");
}

/// A contact that does not slide sticks elastically: that needs a stiffness, and laws that stick.
#[test]
fn a_contact_at_rest_sticks() {
    let still = RIG.replace("sliding_velocity = \"0.1 m/s\"", "sliding_velocity = 0");
    let case = parse(&still).unwrap();
    assert!(case.contact["rim"].rests() && case.contact["rim"].bristle.is_none());
    assert!(matches!(
        case.parameter("contact.rim.sliding_velocity").unwrap().derivative,
        Derivative::None(_)
    ));
    let bristle = "[contact.rim.bristle]\nstiffness = \"1 GN/m^2\"\n";
    for (text, exists) in [(RIG, false), (&still, true)] {
        let case = parse(&format!("{text}{bristle}")).unwrap();
        let of = case.parameter("contact.rim.bristle.stiffness").unwrap().derivative;
        assert!(matches!(of, Derivative::Exists) == exists && matches!(of, Derivative::Zero) != exists);
    }
    for (from, to, expected) in [
        ("stiffness = \"10 GN/m^2\", cubic", "stiffness = 0, cubic", "`contact.rim.bristle`"),
        ("cubic = 1e18 }", "cubic = 1e18, unilateral = false }", "does not stick"),
        ("mu0 = 0.3", "regularisation = 0.1, mu0 = 0.3", "friction.regularisation"),
        ("sliding_velocity = 0", "sliding_velocity = 0\nstroke = \"1 mm\"", "none where nothing slides"),
    ] {
        let faulty = still.replace(from, to);
        assert!(faulty != still, "{from}");
        let error = parse(&faulty).unwrap_err().to_string();
        assert!(error.contains(expected) && !error.contains("faults"), "{expected} not in\n{error}");
    }
}

/// The pressures of a table of friction are forces per what the stiffness belongs to.
#[test]
fn pressures_of_a_friction_table_have_the_unit_of_the_normal_law() {
    let of = |per: &str, stiffness: &str, units: [&str; 2]| {
        let normal = "normal = { per = \"length\", stiffness = \"10 GN/m^2\", cubic = 1e18 }";
        let law = "friction = { law = \"exponential\", mu0 = 0.3, mu1 = 0.1, alpha = \"5 s/m\" }";
        let table = format!(
            "friction = {{ law = \"table\", velocity = [0, 1], mu = [[0.4, 0.3], [0.3, 0.2], [0.2, 0.1]], \
             pressure = [0, \"1 {}\", \"2 {}\"] }}",
            units[0], units[1]
        );
        let normal_of = format!("normal = {{ per = \"{per}\", stiffness = \"10 GN/{stiffness}\" }}");
        assert!(RIG.contains(normal) && RIG.contains(law));
        parse(&RIG.replace(normal, &normal_of).replace(law, &table))
    };
    let kinds = [
        ("area", "m^3", [("Pa", 1.0), ("MPa", 1e6), ("N/mm^2", 1e6)]),
        ("length", "m^2", [("N/m", 1.0), ("kN/m", 1e3), ("N/mm", 1e3)]),
        ("point", "m", [("N", 1.0), ("kN", 1e3), ("MN", 1e6)]),
    ];
    for (per, stiffness, own) in kinds {
        for (unit, factor) in own {
            let case = of(per, stiffness, [unit, unit]).unwrap();
            let FrictionCurve::Table { pressure, .. } = &case.contact["rim"].friction.law else { panic!() };
            assert_eq!(pressure[..], [0.0, factor, 2.0 * factor], "{unit}");
            assert_eq!(parse(&case.to_toml()).unwrap(), case);
        }
        for (other, _, units) in kinds.iter().filter(|(other, ..)| *other != per) {
            let error = of(per, stiffness, [own[0].0, units[0].0]).unwrap_err().to_string();
            let named = error.contains("`contact.rim.friction.pressure`: found \"2 ");
            let expected = format!("as `normal.per` is \"{per}\"");
            assert!(named && error.contains(&expected) && !error.contains("faults"), "{other}: {error}");
        }
    }
}

#[test]
fn every_fault_is_found_at_once_with_its_line() {
    let text = RIG
        .replace("thickness = \"1 mm\"", "thicknes = \"1 mm\"")
        .replace("\"10 mm\"\n\n[bar", "\"-10 mm\"\n\n[bar")
        .replace("poissons_ratio = 0.3", "poissons_ratio = 0.5")
        .replace("diameter = \"20 mm\"", "diameter = \"20 kg\"")
        .replace("sliding_velocity = \"0.1 m/s\"", "sliding_velocity = \"0.1 m\"")
        .replace("below = \"3 kHz\"", "below = true")
        .replace("material = \"steel\"\ndiameter", "material = \"stel\"\ndiameter");
    let error = parse(&text).unwrap_err().to_string();
    for expected in [
        "8 faults",
        "contact.rim.sliding_velocity",
        "rig.toml:18 `shell.disc.thicknes`",
        "Did you mean `thickness`?",
        "-0.01; expected a value above zero",
        "below 0.5",
        "another dimension",
        "found true; expected a frequency",
        "bar.bar.material",
        "Did you mean \"steel\"?",
    ] {
        assert!(error.contains(expected), "{expected} not in\n{error}");
    }
}

#[test]
fn a_table_that_is_missing_is_one_fault() {
    let without = RIG.replace("normal = { per = \"length\", stiffness = \"10 GN/m^2\", cubic = 1e18 }", "");
    assert!(without != RIG);
    let error = parse(&without).unwrap_err().to_string();
    assert!(error.contains("`contact.rim.normal`: found nothing") && !error.contains("faults"), "{error}");
}

#[test]
fn what_is_empty_or_beyond_all_measure_is_refused() {
    for (from, to, expected) in [
        ("material = \"steel\"\nthickness", "material = \"\"\nthickness", "at least one character"),
        ("body = \"rim\"", "body = \"\"", "contact.rim.body"),
        ("counter = \"slider\"", "counter = \"\"", "contact.rim.counter"),
        ("follow = \"hub\"", "follow = []", "at least one"),
        ("on = \"bar_clamp\"", "on = \"a\\nb\"", "support.clamp.on"),
        ("[support.clamp]", "[support.\"\"]", "a name of at least one character"),
        ("density = 7850", "density = 1e-100", "1e-60 to 1e60"),
        ("below = \"3 kHz\"", "count = 9223372036854775807", "to a billion"),
        ("mu1 = 0.1", "mu1 = -0.4", "mu0 + mu1, is zero or more"),
        ("band = [0, \"6 kHz\"]", "nearest = 1e308\ncount = 1", "1e-60 to 1e60"),
        (
            "[sensitivity]",
            "[transient]\nduration = 1\ntime_step = 0.1\nmodel = \"reduced\"\n\
             compare_steps = 1e20\n[sensitivity]",
            "transient.compare_steps",
        ),
    ] {
        assert!(RIG.contains(from), "{from}");
        let error = parse(&RIG.replacen(from, to, 1)).unwrap_err().to_string();
        assert!(error.contains(expected), "{to}: {expected} not in\n{error}");
    }
    let case = parse(&RIG.replace("band = [0, \"6 kHz\"]", "nearest = 1e60\ncount = 1")).unwrap();
    assert_eq!(Case::parse("again", &case.to_toml(), ".".into()).unwrap(), case);
}

#[test]
fn text_that_is_not_toml_is_refused_with_its_line() {
    let error = parse("title = \"a\"\n[mesh\n").unwrap_err().to_string();
    assert!(error.contains("rig.toml:2"), "{error}");
    assert!(parse("").is_err());
}

/// Schema and reference name every key that a case may have.
#[test]
fn schema_and_reference_name_every_key() {
    fn keys(table: &DescribedTable, all: &mut Vec<String>) {
        let of_variants = table.variants.iter().flat_map(|v| &v.each).flat_map(|(_, _, keys)| &keys.keys);
        for key in table.keys.iter().chain(of_variants) {
            all.push(key.name.clone());
            assert!(!key.doc.is_empty(), "{} has no documentation", key.name);
            if let Content::Table(_, inner) = &key.content {
                keys(inner, all);
            }
        }
    }
    let case = describe::<Case>();
    let mut all = Vec::new();
    keys(&case, &mut all);
    assert!(all.len() > 150, "{}", all.len());
    let (schema, reference) = (json_schema("case", &case).to_string(), key_reference(&case));
    for key in &all {
        assert!(schema.contains(&format!("\"{key}\"")), "{key}");
        assert!(
            reference.contains(&format!("`{key}`"))
                || reference.contains(&format!("{key}]`"))
                || reference.contains(&format!("{key}.NAME]`")),
            "{key}"
        );
    }
}

#[test]
fn scalars_of_a_case_are_named_as_the_quantities_they_are() {
    let text = include_str!("../../validation/rig-coarse/case.toml");
    let case = Case::parse("case", text, ".".into()).unwrap();
    for (path, label) in [
        ("contact.rim.friction.mu0", "friction coefficient μ₀ of rim"),
        ("contact.rim.load", "load ΣN of rim"),
        ("contact.rim.placement.lead_angle", "lead angle θ of rim"),
        ("contact.rim.normal.stiffness", "stiffness k_n of rim"),
        ("material.steel.youngs_modulus", "Young's modulus E of steel"),
        ("damping.modal_ratio", "modal damping ratio ζ"),
    ] {
        assert_eq!(case.parameter(path).unwrap().label, label);
    }
}

/// Contacts closed by loads and approaches, one to three: `hold = "load"` needs one with a load.
#[test]
fn a_load_is_held_where_there_is_one() {
    for contacts in 1..=3usize {
        for loaded in 0..1usize << contacts {
            for hold in ["load", "approach"] {
                let (before, rest) = RIG.split_once("[contact.rim]").unwrap();
                let (contact, after) = rest.split_once("[damping]").unwrap();
                let one = |k: usize| {
                    let own = match loaded >> k & 1 {
                        1 => contact.to_string(),
                        _ => contact.replace("load = \"20 N\"", "approach = \"1 um\""),
                    };
                    format!("[contact.c{k}]{own}")
                };
                let all: String = (0..contacts).map(one).collect();
                let text = format!(
                    "{before}{all}[damping]{after}\n[transient]\nduration = 1e-3\ntime_step = 1e-5\nhold = \"{hold}\"\n"
                );
                let said = parse(&text).map_or_else(|error| error.to_string(), |_| String::new());
                let refused = said.contains("`transient.hold`") && said.contains("no contact with a `load`");
                assert_eq!(refused, hold == "load" && loaded == 0, "{text}{said}");
            }
        }
    }
}
