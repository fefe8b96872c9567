//! Whether a force of a frequency response moves the places whose motion is computed.

use super::motion::Motion;
use crate::connected::lowest_connected;
use crate::error::{Error, Fault, Result};
use crate::linalg::SparseVector;
use crate::system::System;

/// Pieces of a system: degrees of freedom between which M, C and K have entries, and contacts where these transmit.
pub(super) struct Pieces(Vec<usize>);

impl Pieces {
    /// Of a system with its contacts or, if they are open, without them.
    pub(super) fn new(system: &System, in_contact: bool) -> Pieces {
        let structure = &system.structure;
        let skew = system.skew().map(|skew| [&skew.stiffness, &skew.damping]);
        let matrices =
            [Some(&structure.mass), Some(&structure.stiffness), structure.damping.viscous.as_ref()];
        let matrices = matrices.into_iter().flatten().chain(skew.into_iter().flatten());
        let entries = matrices.flat_map(|matrix| {
            let of = matrix.symbolic();
            (0..matrix.ncols()).map(move |j| of.row_idx_of_col(j).chain([j]).collect::<Vec<_>>())
        });
        let together = |directions: &[&SparseVector]| {
            directions.iter().flat_map(|d| d.indices()).copied().collect::<Vec<_>>()
        };
        let rest = system.coupling.iter().map(|rest| together(&rest.directions.iter().collect::<Vec<_>>()));
        let points = system.points().filter(|_| in_contact);
        let points =
            points.map(|(_, point)| together(&[&point.normal, &point.tangents[0], &point.tangents[1]]));
        let groups = entries.chain(rest).chain(points);
        Pieces(lowest_connected(system.n_dofs(), groups))
    }

    /// Checks that `force` moves the place `seen`, which `key` gives.
    ///
    /// # Errors
    /// A place in other pieces than the force, with what to do where `contacts` are open.
    pub(super) fn check(&self, (force, seen): (&Motion, &Motion), key: &str, contacts: usize) -> Result<()> {
        let of =
            |motion: &Motion| motion.direction.indices().iter().map(|dof| self.0[*dof]).collect::<Vec<_>>();
        let driven = of(force);
        if of(seen).iter().any(|piece| driven.contains(piece)) {
            return Ok(());
        }
        let found = format!("{}, which no force at {} moves: nothing joins them", seen.place, force.place);
        let fault = Fault::new(format!("`{key}`"), found, "a place that the force moves");
        let open = "The contacts are open here: `contact = \"sliding\"` has them closed as in steady sliding";
        Err(Error::input(if contacts > 0 { fault.with_help(open) } else { fault }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Case;
    use crate::equilibrium::samples::{fluttering_bar, skew_parts};
    use crate::job::Prepared;
    use crate::job::frf::frfs;
    use crate::linalg::random::Random;

    /// Masses that springs join, or not, to the one before, and a contact that joins the last to the ground.
    #[test]
    fn places_that_the_force_does_not_move_are_faults() {
        let mut random = Random::seeded(3);
        for _ in 0..20 {
            let joined: Vec<bool> = (0..6).map(|k| k > 0 && random.between(0.0, 1.0) < 0.6).collect();
            let mut text = String::from("[point]\n");
            (0..6).for_each(|k| text += &format!("p{k} = [{k}, 0, 0]\n"));
            for (k, joined) in joined.iter().enumerate() {
                text += &format!(
                    "[mass.p{k}]\non = \"p{k}\"\nmass = 2\n\
                     [support.p{k}]\non = \"p{k}\"\nheld = [\"uy\", \"uz\", \"rx\", \"ry\", \"rz\"]\n\
                     [spring.g{k}]\non = \"p{k}\"\ndirection = [1, 0, 0]\nstiffness = 1e5\n"
                );
                if *joined {
                    let before = k - 1;
                    text += &format!(
                        "[spring.s{k}]\non = \"p{k}\"\nto = \"p{before}\"\ndirection = [1, 0, 0]\nstiffness = 1e4\n"
                    );
                }
            }
            text += "[frf.a]\nband = [1, 40]\nquantity = \"receptance\"\nexcitation = { on = \"p0\", direction = [1, 0, 0] }\n";
            (0..6).for_each(|k| {
                text += &format!("response.q{k} = {{ on = \"p{k}\", direction = [1, 0, 0] }}\n")
            });
            let case = Case::parse("masses", &text, ".".into()).unwrap();
            let prepared = Prepared::new(&case).unwrap();
            let words = frfs(&prepared).err().map_or(String::new(), |error| error.to_string());
            for k in 0..6 {
                let moved = (1..=k).all(|k| joined[k]);
                assert_eq!(words.contains(&format!("frf.a.response.q{k}`")), !moved, "{joined:?}: {words}");
            }
        }
    }

    /// A bar whose motions across and along itself only its contacts join.
    #[test]
    fn contacts_join_what_they_touch_where_the_response_has_them_closed() {
        let system = fluttering_bar(9.0, 1);
        let place = |dof: usize| Motion {
            place: format!("node {dof}"),
            at: [0.0; 3],
            along: [0.0, 0.0, 1.0],
            nodes: vec![dof],
            direction: SparseVector::from_entries([(dof, 1.0)]),
        };
        for in_contact in [false, true] {
            let pieces = Pieces::new(&system, in_contact);
            assert!(pieces.check((&place(3), &place(50)), "frf.a.response.b", 1).is_ok());
            let other = pieces.check((&place(3), &place(70)), "frf.a.response.b", 1);
            assert_eq!(other.is_ok(), in_contact);
            if let Err(error) = other {
                let words = error.to_string();
                assert!(
                    words.contains("frf.a.response.b") && words.contains("contact = \"sliding\""),
                    "{words}"
                );
            }
        }
        let mut turning = system.clone();
        turning.coupling = Some(skew_parts(120, 1, 1.0, 0.0));
        assert!(Pieces::new(&turning, false).check((&place(3), &place(70)), "frf.a.response.b", 1).is_ok());
    }
}
