//! What sections say of each other: names that must stand elsewhere, and what does not go together.

use super::super::reader::Section;
use super::super::{Case, ContactState, Pressing, Sense, path_matches};

/// Names that must stand elsewhere in the file: materials, parts, contacts.
pub(super) fn check_names(root: &Section, case: &Case) {
    if !root.all_named() {
        return;
    }
    let materials: Vec<&str> = case.material.keys().map(String::as_str).collect();
    let used = case
        .shell
        .iter()
        .map(|(name, s)| (format!("shell.{name}.material"), &s.material))
        .chain(case.bar.iter().map(|(name, b)| (format!("bar.{name}.material"), &b.material)));
    for (key, material) in used {
        if !material.is_empty() && !materials.contains(&material.as_str()) {
            unknown_name(root, &key, material, "material", &materials);
        }
    }
    for (name, contact) in case.contact.iter().filter(|_| case.matrices.is_none()) {
        if contact.points.is_some() {
            root.fault(
                &format!("contact.{name}.points"),
                "contact points",
                "`body` and `counter`, on a mesh",
                "",
            );
        }
    }
    let parts: Vec<&str> = case.shell.keys().chain(case.bar.keys()).map(String::as_str).collect();
    for (name, analysis) in &case.modes {
        for part in analysis.parts.iter().filter(|p| !parts.contains(&p.as_str())) {
            unknown_name(root, &format!("modes.{name}.parts"), part, "shell or bar", &parts);
        }
        if analysis.contact == ContactState::Closed && case.contact.is_empty() {
            root.fault(&format!("modes.{name}.contact"), "closed", "open, as the case has no [contact]", "");
        }
        if analysis.contact == ContactState::Closed && !analysis.parts.is_empty() {
            root.fault(
                &format!("modes.{name}.contact"),
                "closed",
                "open, when only some parts are analysed",
                "",
            );
        }
    }
    if case.cea.is_some() && case.contact.is_empty() && case.matrices.is_none() {
        root.fault("cea", "no [contact] in the case", "a contact, without which nothing slides", "");
    }
    if case.sensitivity.is_some() && case.cea.is_none() {
        root.fault("sensitivity", "no [cea] in the case", "a [cea], whose eigenvalues are looked into", "");
    }
    for (name, contact) in case.contact.iter().filter(|(_, contact)| contact.bristle.is_some()) {
        let refuse = |key: &str, found: &str, expected: &str| {
            root.fault(&format!("contact.{name}.{key}"), found, expected, "");
        };
        if contact.friction.regularisation > 0.0 {
            refuse(
                "friction.regularisation",
                "a velocity",
                "none beside a `bristle`, which sticks by itself",
            );
        }
        if contact.friction.sense != Sense::WithSlip {
            refuse("friction.sense", "against_sliding", "with_slip beside a `bristle`");
        }
        if !contact.normal.unilateral {
            refuse(
                "normal.unilateral",
                "false",
                "true beside a `bristle`: a contact that pulls does not stick",
            );
        }
    }
    if let Some(transient) = &case.transient {
        if case.cea.is_none() {
            let expected = "a [cea], whose modes the motion starts along and is compared with";
            root.fault("transient", "no [cea] in the case", expected, "");
        }
        if transient.fields_every.is_some() && case.mesh.is_none() {
            let expected = "a case with a [mesh], whose nodes have the fields";
            root.fault("transient.fields_every", "no [mesh] in the case", expected, "");
        }
        let contacts: Vec<&str> = case.contact.keys().map(String::as_str).collect();
        for name in transient.slide.keys().filter(|name| !contacts.contains(&name.as_str())) {
            unknown_name(root, &format!("transient.slide.{name}"), name, "contact", &contacts);
        }
        let pressed = case.contact.iter().filter(|(_, c)| matches!(c.pressing, Pressing::Load(_)));
        let loads: Vec<&str> =
            pressed.map(|(name, _)| name.as_str()).chain(case.force.keys().map(String::as_str)).collect();
        for name in transient.load.keys().filter(|name| !loads.contains(&name.as_str())) {
            unknown_name(
                root,
                &format!("transient.load.{name}"),
                name,
                "force or contact with a load",
                &loads,
            );
        }
        for (name, _) in transient
            .load
            .iter()
            .filter(|(name, course)| course.range()[0] < 0.0 && case.contact.contains_key(name.as_str()))
        {
            let expected = "factors of zero or more: a load presses";
            root.fault(&format!("transient.load.{name}"), "a factor below zero", expected, "");
        }
        let plain = |name: &str| name.chars().all(|c| c.is_alphanumeric() || c == '-' || c == '_');
        for name in transient.probe.keys().filter(|name| !plain(name)) {
            let key = format!("transient.probe.{name}");
            root.fault(&key, format!("the name \"{name}\""), "letters, digits, `-` and `_`", "");
        }
        let plates: Vec<&str> = case.shell.keys().map(String::as_str).collect();
        let heard = transient.sound.iter().flat_map(|sound| &sound.plates);
        for name in heard.filter(|name| !plates.contains(&name.as_str())) {
            unknown_name(root, "transient.sound.plates", name, "shell", &plates);
        }
    }
    if case.matrices.is_some() {
        check_matrices(root, case);
    } else if case.mesh.is_none() && case.point.is_empty() {
        root.fault("mesh", "nothing", "a [mesh] with a file, [point] coordinates, or [matrices]", "");
    }
}

/// Refuses patterns that name no scalar of a case that is sound but for them.
pub(super) fn check_sensitivity(root: &Section, case: &Case) {
    let Some(analysis) = case.sensitivity.as_ref().filter(|_| root.sound_so_far()) else {
        return;
    };
    // The scalars of the model: what is asked about them is none.
    let Some(parameters) = root.take(Case { sensitivity: None, ..case.clone() }.parameters()) else { return };
    let paths = || parameters.iter().map(|p| p.path.as_str());
    for pattern in
        analysis.parameters.iter().filter(|pattern| !paths().any(|path| path_matches(pattern, path)))
    {
        let help = crate::error::nearest(pattern, paths())
            .map_or("`stridor check CASE --parameters` lists them".into(), |near| {
                format!("Did you mean \"{near}\"?")
            });
        let expected = "the path of a scalar of the case, or part of one with `*`";
        root.fault("sensitivity.parameters", format!("\"{pattern}\""), expected, &help);
    }
}

/// What a case with matrices may not say besides, and what only such a case may say.
fn check_matrices(root: &Section, case: &Case) {
    let built = ["mesh", "point", "material", "shell", "bar", "mass", "spring", "rigid", "support", "force"];
    for key in built.into_iter().filter(|key| root.has(key)) {
        root.fault(
            key,
            "a part of a model",
            "no such section beside [matrices], which are the model",
            "Remove one of them",
        );
    }
    if case.prestress {
        root.fault(
            "prestress",
            "true",
            "false beside [matrices]",
            "Export K with the geometric stiffness in it",
        );
    }
    for (name, contact) in &case.contact {
        if contact.points.is_none() {
            let help = "Each point gives its normal and tangential degrees of freedom";
            root.fault(
                &format!("contact.{name}.points"),
                "nothing",
                "contact points, beside [matrices]",
                help,
            );
        }
    }
    for (name, modes) in &case.modes {
        let parts =
            [("parts", !modes.parts.is_empty()), ("clamp", !modes.clamp.is_empty()), ("free", modes.free)];
        for (key, _) in parts.into_iter().filter(|(_, there)| *there) {
            root.fault(
                &format!("modes.{name}.{key}"),
                "a part of a model",
                "no such key beside [matrices]",
                "Remove it",
            );
        }
    }
}

pub(in crate::case) fn unknown_name(root: &Section, key: &str, name: &str, kind: &str, known: &[&str]) {
    let help = crate::error::nearest(name, known.iter().copied())
        .map_or(String::new(), |near| format!("Did you mean \"{near}\"?"));
    let list = if known.is_empty() { "none is defined".to_string() } else { known.join(", ") };
    root.fault(key, format!("\"{name}\""), format!("the name of a {kind} ({list})"), &help);
}
