//! Checks across sections: names that must be defined elsewhere, and keys that exclude each other.

use super::consistent::Consistent;
use super::names::unknown_name;
use super::structure::PARTS;
use super::{Case, ContactState, HoldChoice, Parameter, Pressing, TransientAnalysis, path_matches};
use crate::schema::{Report, dotted, key};

impl Consistent for Case {
    fn check(&self, report: &mut Report) {
        // Tables of named tables without names may have meant to define any name.
        let others = ["material", "spring", "force", "contact", "modes", "frf", "measured"];
        if !others.iter().chain(&PARTS).any(|section| report.unread_itself(section)) {
            check_names(report, self);
        }
        super::measured::check(report, self);
        let sound = report.is_sound(&["sensitivity", "sweep", "map", "uncertainty", "calibrate"]);
        let scalars = (sound && self.has_studies()).then(|| self.without_studies().parameters());
        check_sensitivity(report, self, scalars.as_deref());
        super::explore::check(self, scalars.as_deref(), report);
        super::uncertainty::check(self, scalars.as_deref(), report);
        super::calibrate::check(self, scalars.as_deref(), report);
    }
}

/// Names that must stand elsewhere in the file, and sections that need others.
fn check_names(root: &mut Report, case: &Case) {
    check_materials(root, case);
    check_modes(root, case);
    super::rotation::check(root, case);
    if case.cea.is_some() && case.contact.is_empty() && case.rotation.is_empty() && case.matrices.is_none() {
        let expected = "a contact or a [rotation], without which no mode is complex";
        root.fault("cea", "no [contact] in the case", expected, "");
    }
    if case.sensitivity.is_some() && case.cea.is_none() {
        root.fault("sensitivity", "no [cea] in the case", "a [cea], whose eigenvalues are looked into", "");
    }
    if let Some(transient) = &case.transient {
        check_transient(root, case, transient);
    }
    if case.matrices.is_some() {
        check_matrices(root, case);
    } else if case.mesh.is_none() && case.point.is_empty() {
        root.fault("mesh", "nothing", "a [mesh] with a file, [point] coordinates, or [matrices]", "");
    }
}

/// Materials of parts, and contacts that are given point by point.
fn check_materials(root: &mut Report, case: &Case) {
    let materials: Vec<&str> = case.material.keys().map(String::as_str).collect();
    for (kind, name, material) in case.parts() {
        if !material.is_empty() && !materials.contains(&material) {
            let key = format!("{kind}.{}.material", dotted(name));
            unknown_name(root, &key, material, "material", &materials);
        }
    }
    for (name, contact) in case.contact.iter().filter(|_| case.matrices.is_none()) {
        if contact.points.is_some() {
            root.fault(
                &format!("contact.{}.points", dotted(name)),
                "contact points",
                "`body` and `counter`, on a mesh",
                "",
            );
        }
    }
}

/// Parts and contacts of analyses of real modes.
fn check_modes(root: &mut Report, case: &Case) {
    let parts: Vec<&str> = case.parts().map(|(_, name, _)| name).collect();
    let [others @ .., last] = PARTS;
    let kinds = format!("{} or {last}", others.join(", "));
    for (name, analysis) in &case.modes {
        for part in analysis.parts.iter().filter(|p| !parts.contains(&p.as_str())) {
            unknown_name(root, &format!("modes.{}.parts", dotted(name)), part, &kinds, &parts);
        }
        if analysis.contact == ContactState::Closed && case.contact.is_empty() {
            root.fault(
                &format!("modes.{}.contact", dotted(name)),
                "closed",
                "open, as the case has no [contact]",
                "",
            );
        }
        if analysis.contact == ContactState::Closed && !analysis.parts.is_empty() {
            root.fault(
                &format!("modes.{}.contact", dotted(name)),
                "closed",
                "open, when only some parts are analysed",
                "",
            );
        }
    }
}

/// Checks the names in `[transient]`, and the sections that it needs.
fn check_transient(root: &mut Report, case: &Case, transient: &TransientAnalysis) {
    if case.cea.is_none() {
        let expected = "a [cea], whose modes the motion starts along and is compared with";
        root.fault("transient", "no [cea] in the case", expected, "");
    }
    if transient.fields_every.is_some() && case.mesh.is_none() {
        let expected = "a case with a [mesh], whose nodes have the fields";
        root.fault("transient.fields_every", "no [mesh] in the case", expected, "");
    }
    check_courses(root, case, transient);
    let loaded = case.contact.values().any(|contact| matches!(contact.pressing, Pressing::Load { .. }));
    if transient.hold == Some(HoldChoice::Load) && !loaded {
        let expected = "a contact that a load closes: one with an `approach` keeps that";
        let help = "Give the contact a `load` in place of its `approach`, or remove `hold`";
        root.fault("transient.hold", "\"load\", and no contact with a `load`", expected, help);
    }
    for name in transient.probe.keys().filter(|name| !key::is_file_name(name)) {
        let place = format!("transient.probe.{}", dotted(name));
        root.fault(&place, format!("the name \"{name}\""), "letters, digits, `-` and `_`", "");
    }
}

/// Contacts that slide and loads that change in time.
fn check_courses(root: &mut Report, case: &Case, transient: &TransientAnalysis) {
    let contacts: Vec<&str> = case.contact.keys().map(String::as_str).collect();
    for name in transient.slide.keys().filter(|name| !contacts.contains(&name.as_str())) {
        unknown_name(root, &format!("transient.slide.{}", dotted(name)), name, "contact", &contacts);
    }
    let pressed = case.contact.iter().filter(|(_, c)| matches!(c.pressing, Pressing::Load { .. }));
    let loads: Vec<&str> =
        pressed.map(|(name, _)| name.as_str()).chain(case.force.keys().map(String::as_str)).collect();
    for name in transient.load.keys().filter(|name| !loads.contains(&name.as_str())) {
        unknown_name(
            root,
            &format!("transient.load.{}", dotted(name)),
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
        root.fault(&format!("transient.load.{}", dotted(name)), "a factor below zero", expected, "");
    }
}

/// Refuses patterns that name no scalar of a case that is valid but for them.
fn check_sensitivity(root: &mut Report, case: &Case, scalars: Option<&[Parameter]>) {
    let (Some(analysis), Some(parameters)) = (&case.sensitivity, scalars) else { return };
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

/// Checks the keys that a case with matrices excludes, and those that only such a case has.
fn check_matrices(root: &mut Report, case: &Case) {
    for (key, _) in case.structure().into_iter().filter(|(_, there)| *there) {
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
                &format!("contact.{}.points", dotted(name)),
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
                &format!("modes.{}.{key}", dotted(name)),
                "a part of a model",
                "no such key beside [matrices]",
                "Remove it",
            );
        }
    }
}
