//! The stiffness of faces in contact beside that of the bodies.
//!
//! A layer of thickness h and modulus E gives way to a pressure p by p h/E: E/h \[N/m³\] is the stiffness per area of a body. A contact much
//! softer than that lets the bodies into each other before they deform. Of one much stiffer, k, only E/(h k) of the deflection is: it changes
//! nothing but the rounding of the equations.

use crate::case::{Contact, StiffnessPer};
use crate::error::Fault;
use crate::job::prepared::Prepared;
use crate::numbers::significant;
use crate::schema::dotted;

/// k over the E/h of the softest body, and of the stiffest, within which a contact is plausible: linings pressed against discs are near 1.
const RANGE: [f64; 2] = [1e-4, 1e4];

pub fn warnings(prepared: &Prepared) -> Vec<Fault> {
    let contacts = prepared.case.contact.iter();
    contacts.filter_map(|(name, contact)| of_contact(prepared, name, contact)).collect()
}

fn of_contact(prepared: &Prepared, name: &str, contact: &Contact) -> Option<Fault> {
    let stiffness = contact.normal.stiffness;
    if contact.normal.per != StiffnessPer::Area || stiffness == 0.0 {
        return None;
    }
    let (model, regions) = (&prepared.model, &prepared.regions);
    let of_body = |region: &String| {
        let nodes = regions.nodes(region, "").unwrap_or_default();
        let parts = model.parts.iter();
        let touching =
            parts.filter(move |part| part.nodes().iter().any(|node| nodes.binary_search(node).is_ok()));
        touching.map(|part| {
            let thickness = match part.as_shell() {
                Some(shell) => shell.thickness,
                None => part.smallest_extent(&model.nodes),
            };
            (part.kind.material().youngs_modulus / thickness, part, thickness)
        })
    };
    let bodies = || [&contact.body, &contact.counter].into_iter().flat_map(of_body);
    let soft = bodies().min_by(|a, b| a.0.total_cmp(&b.0))?;
    let stiff = bodies().max_by(|a, b| a.0.total_cmp(&b.0))?;
    let ((own, part, thickness), help) = if stiffness < RANGE[0] * soft.0 {
        (soft, "So soft a contact lets the bodies into each other before they deform")
    } else if stiffness > RANGE[1] * stiff.0 {
        (stiff, "So stiff a contact changes no deflection, but costs digits and time")
    } else {
        return None;
    };
    let help = format!("{help}: check its unit, such as \"100 GN/m^3\"");
    let found = format!("{} N/m^3", significant(stiffness, 3));
    let expected = format!(
        "{} to {} N/m^3: `{}` alone has E/h = {} N/m^3, h = {} m",
        significant(RANGE[0] * soft.0, 2),
        significant(RANGE[1] * stiff.0, 2),
        part.name,
        significant(own, 3),
        significant(thickness, 3)
    );
    Some(Fault::new(format!("`contact.{}.normal.stiffness`", dotted(name)), found, expected).with_help(help))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::read_case;
    use std::path::Path;

    #[test]
    fn contacts_far_softer_or_stiffer_than_the_bodies_are_warned_of() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation/disc-brake/case.toml");
        let mut case = read_case(&file).unwrap();
        // Linings of 8 GPa, discs of 120 GPa, parts of some 10 mm.
        for (stiffness, word) in
            [(1e11, ""), (1e9, ""), (1e14, ""), (1e3, "So soft"), (1e18, "So stiff"), (0.0, "")]
        {
            case.contact.get_mut("pads").unwrap().normal.stiffness = stiffness;
            case.contact.get_mut("pads").unwrap().normal.cubic = 1e20;
            let prepared = Prepared::new(&case).unwrap();
            let found = warnings(&prepared);
            assert_eq!(found.len(), usize::from(!word.is_empty()), "{stiffness:e} {found:?}");
            for fault in found {
                let text = fault.to_string();
                let both = text.contains("`contact.pads.normal.stiffness`") && text.contains("E/h = ");
                assert!(both && text.contains(word), "{text}");
            }
        }
    }
}
