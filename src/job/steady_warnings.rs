//! What to know of a steady state that was found: contacts that carry nothing, that friction drives in, that tip, or that are pressed too deep.

use super::prepared::Prepared;
use crate::equilibrium::{EDGE, PointState, SteadySliding, by_pair, carrying_share};
use crate::numbers::significant;
use crate::schema::dotted;
use crate::system::{Closing, ContactPair};

/// The penetration, as a part of the thinnest part, up to which it is small beside the bodies.
pub(super) const SMALL_PENETRATION: f64 = 0.1;
/// A force below this part of those that act is what the solution of the equations leaves of zero.
const NO_FORCE: f64 = 1e-9;
/// A penetration below this part of the largest coordinate is rounding of the nodes: some 50 units in the last place.
const NO_PENETRATION: f64 = 1e-14;

/// The warnings, pair by pair.
pub(super) fn warnings(prepared: &Prepared, state: &SteadySliding) -> Vec<String> {
    let system = &prepared.system;
    let size = |x: &[f64]| x.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let pairs = by_pair(&system.pairs, &state.points).zip(&state.approach);
    let all: Vec<SteadyPair> =
        pairs.map(|((pair, states), approach)| SteadyPair { pair, approach: *approach, states }).collect();
    let acting = all.iter().map(SteadyPair::normal_force).fold(size(&system.load), f64::max);
    let nodes = prepared.model.nodes.iter().chain(system.points().map(|(_, point)| &point.position));
    let length = nodes.map(|node| size(node)).fold(0.0, f64::max);
    let alone = all.len() == 1 && size(&system.load) == 0.0;
    let thinnest = prepared.thinnest();
    all.iter()
        .flat_map(|pair| {
            let words = [
                pair.carries_nothing([acting, length]),
                pair.too_deep(thinnest),
                pair.driven_in(alone),
                pair.on_an_edge(),
            ];
            words.into_iter().flatten()
        })
        .collect()
}

/// A pair in its steady state.
struct SteadyPair<'a> {
    pair: &'a ContactPair,
    approach: f64,
    states: &'a [PointState],
}

impl SteadyPair<'_> {
    fn normal_force(&self) -> f64 {
        self.states.iter().map(|state| state.forces.normal).sum()
    }

    fn friction(&self) -> f64 {
        self.states.iter().map(|state| state.forces.friction[0].hypot(state.forces.friction[1])).sum()
    }

    fn deepest(&self) -> f64 {
        self.states.iter().map(|state| state.penetration).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Closed without a load: its stiffness and friction are in every analysis, as that of a contact which is pressed.
    fn carries_nothing(&self, [acting, length]: [f64; 2]) -> Option<String> {
        let (force, deepest) = (self.normal_force(), self.deepest());
        let closed = self.states.iter().filter(|state| state.closed()).count();
        let beside = if force <= NO_FORCE * acting {
            format!("beside {} N elsewhere", significant(acting, 3))
        } else if deepest <= NO_PENETRATION * length {
            format!("{} m deep, which is rounding", significant(deepest, 2))
        } else {
            return None;
        };
        let asked = matches!(self.pair.closing, Closing::Load(_)) || self.pair.is_bilateral();
        (closed > 0 && !asked).then(|| {
            format!(
                "The contact {} carries nothing: {} N in sum ({beside}), though {closed} of {} points are closed. The analyses have its stiffness and friction as if it \
                 were pressed; press it by `contact.{}.load`, by a [force] on its body (`pressure` on a face) or by an `approach` above zero, or leave it out",
                self.pair.name,
                significant(force, 2),
                self.states.len(),
                dotted(&self.pair.name)
            )
        })
    }

    /// Pressed so deep that the faces are elsewhere.
    fn too_deep(&self, thinnest: f64) -> Option<String> {
        let deepest = self.deepest();
        (deepest > SMALL_PENETRATION * thinnest).then(|| {
            format!(
                "The contact {} is pressed {} mm deep, {} of the thinnest part, {} mm: the faces are where they are without deformation, which \
                 holds up to about {SMALL_PENETRATION}. Raise its `normal.stiffness`, or lower the load",
                self.pair.name,
                significant(1e3 * deepest, 3),
                significant(deepest / thinnest, 2),
                significant(1e3 * thinnest, 3)
            )
        })
    }

    /// Self-locking: ΣN = L at an approach at which the undeformed bodies are apart, though nothing but this pair presses them, so that it is
    /// friction that presses.
    fn driven_in(&self, alone: bool) -> Option<String> {
        let touch = self.pair.least_gap();
        let Closing::Load(load) = self.pair.closing else { return None };
        (alone && self.approach < touch && self.friction() > 0.0 && !self.pair.is_bilateral()).then(|| {
            format!(
                "The contact {} locks: friction drives its body in, so that the bodies have to be held {} µm apart for {} N to be carried. No load presses as \
                 this state assumes; lower the friction, or support the body nearer to its face",
                self.pair.name,
                significant(1e6 * (touch - self.approach), 3),
                significant(load, 4)
            )
        })
    }

    /// A face that fits its counter-face, and carries on little of it.
    fn on_an_edge(&self) -> Option<String> {
        let gaps = || self.pair.points.iter().map(|point| point.gap);
        let apart = gaps().fold(f64::NEG_INFINITY, f64::max) - gaps().fold(f64::INFINITY, f64::min);
        let share = carrying_share(self.pair, self.states);
        let fits = self.states.len() > 3 && apart <= 0.1 * self.deepest();
        (fits && share < EDGE && self.friction() > 0.0).then(|| {
            format!(
                "The contact {} carries on {} % of its area, though its faces fit: the body tips about an edge. Friction at a face turns the body by its distance \
                 from where it is held; lower the friction, press nearer to the middle, or support the body against turning",
                self.pair.name,
                significant(100.0 * share, 2)
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Case;
    use crate::equilibrium::solve_steady;
    use crate::job::check_case;
    use std::path::Path;

    fn of(folder: &str, changes: &[(&str, &str)]) -> Vec<String> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation").join(folder);
        let mut text = std::fs::read_to_string(folder.join("case.toml")).unwrap();
        for (from, to) in changes {
            assert!(text.contains(from), "{from}");
            text = text.replace(from, to);
        }
        let case = Case::parse("case.toml", &text, folder).unwrap();
        let prepared = Prepared::new(&case).unwrap();
        // Templates of `stridor new`.
        assert!(!changes.is_empty() || check_case(&prepared).unwrap().words().next().is_none());
        let state = solve_steady(&prepared.system, &prepared.steady_options(), &()).unwrap();
        let pair = SteadyPair {
            pair: &prepared.system.pairs[0],
            approach: state.approach[0],
            states: &state.points,
        };
        let beside = pair.carries_nothing([1e13 * pair.normal_force(), 0.0]);
        let asked = matches!(pair.pair.closing, Closing::Load(_));
        assert_eq!(beside.is_some_and(|words| words.contains(" N elsewhere")), !asked);
        warnings(&prepared, &state)
    }

    #[test]
    fn a_contact_that_carries_nothing_is_named() {
        assert_eq!(of("solid-brake", &[]), Vec::<String>::new());
        let force = "[force.piston]\non = \"pad_back\"\nforce = [0, 0, \"-2 kN\"]";
        // Held where it stands, by a spring, and not pressed.
        let held = "[spring.behind]\non = \"pad_back\"\ndirection = [0, 0, 1]\nstiffness = \"50 MN/m\"";
        let [words] = &of("solid-brake", &[(force, held), ("approach = 0", "approach = 5e-16")])[..] else {
            panic!("one warning")
        };
        assert!(words.contains("face carries nothing") && words.contains("`contact.face.load`"), "{words}");
        // Of 10 nm it carries some newtons.
        let light = [(force, held), ("approach = 0", "approach = 1e-8")];
        assert_eq!(of("solid-brake", &light), Vec::<String>::new());
    }

    #[test]
    fn a_contact_that_is_pressed_too_deep_is_named() {
        let soft = of("solid-brake", &[("100 GN/m^3", "0.15 GN/m^3")]);
        assert!(
            soft.len() == 1 && soft[0].contains("face is pressed") && soft[0].contains("thinnest"),
            "{soft:?}"
        );
    }

    /// The brake carries 8 kN up to μ of about 1.1, beyond 0.9 with its linings held apart.
    #[test]
    fn contacts_that_tip_and_lock_are_named() {
        assert_eq!(of("disc-brake", &[]), Vec::<String>::new());
        let said = of("disc-brake", &[("mu0 = 0.4", "mu0 = 1")]);
        let [locks, tips] = &said[..] else { panic!("{said:?}") };
        assert!(locks.contains("pads locks") && locks.contains("97."), "{locks}");
        assert!(tips.contains("pads carries on") && tips.contains("tips about an edge"), "{tips}");
    }
}
