//! Contact pairs and rotations.

use super::Maker;
use crate::case::{self, FrictionCurve, InitialGap, Pressing, SlidingChoice, StiffnessPer};
use crate::decks::{Contact, Motion, Place, Weight};
use crate::error::Result;
use crate::job::counter::counter_faces;

impl Maker<'_> {
    pub(super) fn contacts(&mut self) -> Result<()> {
        for (name, contact) in &self.case.contact {
            let what = format!("contact.{name}");
            if contact.counter == "ground" {
                self.note(Weight::Matters, &what, "a contact with the ground is not written");
                continue;
            }
            let friction = self.friction(&what, contact)?;
            let law = &contact.normal;
            let by_area = law.per == StiffnessPer::Area;
            if !by_area {
                self.note(
                    Weight::Matters,
                    &what,
                    "a stiffness that is not per area is written as hard contact",
                );
            }
            if law.cubic != 0.0 || law.damping != 0.0 || !law.unilateral {
                let why = "cubic stiffness, damping and pull of a contact are not written";
                self.note(Weight::Matters, &what, why);
            }
            match contact.pressing {
                Pressing::Load { load } => {
                    let why = format!(
                        "a load of {load} N of the pair is not written: press the bodies together by forces"
                    );
                    self.note(Weight::Matters, &what, why);
                }
                Pressing::Approach { approach } if approach != 0.0 => {
                    let why =
                        format!("an approach of {approach} m of the pair is not written: move the bodies");
                    self.note(Weight::Matters, &what, why);
                }
                Pressing::Approach { .. } => {}
            }
            let (slave, master) = (self.surface_of(&contact.body), self.surface_of(&contact.counter));
            self.deck.contacts.push(Contact {
                name: name.clone(),
                slave,
                master,
                friction,
                stiffness: (by_area && law.stiffness > 0.0).then_some(law.stiffness),
                stick: contact.bristle.as_ref().filter(|_| by_area).map(|bristle| bristle.stiffness),
                closed: contact.initial_gap == InitialGap::Closed,
                place: Place::default(),
            });
        }
        Ok(())
    }

    /// μ of sliding, at the speed and without pressure.
    fn friction(&mut self, what: &str, contact: &case::Contact) -> Result<f64> {
        if !matches!(contact.friction.law, FrictionCurve::Coulomb { .. }) {
            let why = "friction that depends on speed or pressure is a constant: that at the speed of sliding, without pressure";
            self.note(Weight::Matters, what, why);
        }
        let speed = match &contact.sliding {
            SlidingChoice::Along { sliding_velocity, .. } => sliding_velocity.abs(),
            SlidingChoice::About { .. } => 0.0,
        };
        Ok(contact.friction.law.coefficient(what)?.mu(speed, 0.0).value)
    }

    /// Rotations of parts, and those of counter-bodies that slide.
    pub(super) fn rotations(&mut self) -> Result<()> {
        let place = Place::default();
        let case = self.case;
        for rotation in case.rotation.values() {
            let of = |set: &String| Motion {
                set: set.clone(),
                point: rotation.point,
                axis: rotation.axis,
                speed: rotation.speed,
                place,
            };
            self.deck.motions.extend(rotation.parts.iter().map(of));
        }
        for (name, contact) in case.contact.iter().filter(|(_, contact)| contact.counter != "ground") {
            let what = format!("contact.{name}");
            let SlidingChoice::About { rotation } = &contact.sliding else {
                if !contact.rests() {
                    self.note(Weight::Matters, what, "sliding along a direction is not written");
                }
                continue;
            };
            let counter = counter_faces(&contact.counter, &self.prepared.regions, self.model, (&what, ""))?;
            let parts: Vec<String> = counter.parts.iter().map(|part| part.name.clone()).collect();
            for set in parts {
                if !self.deck.motions.iter().any(|motion| motion.set == set) {
                    let (point, axis, speed) = (rotation.point, rotation.axis, rotation.speed);
                    self.deck.motions.push(Motion { set, point, axis, speed, place });
                }
            }
        }
        Ok(())
    }
}
