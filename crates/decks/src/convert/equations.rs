//! Linear equations, Σ a u = 0, as a table beside the case: those of the deck, and supports along directions that are no axes.

use super::Converted;
use super::converter::Converter;
use super::text::{number, quoted};
use crate::deck::{Equation, Frame, Place, Support};
use crate::ledger::Weight;
use crate::written::{HeldNode, held_nodes};
use std::collections::{HashMap, HashSet};
use std::fmt::Write;

/// Node, degree of freedom from 0 (ux) to 5 (rz), a.
type Term = (usize, u8, f64);

/// The first degree of freedom follows the others of its node where its factor is not less than this part of theirs.
const FIRST: f64 = 0.1;
/// What a sum of terms leaves of their size by rounding.
const ROUND_OFF: f64 = 1e-13;

impl Converter<'_> {
    /// Finds the nodes that equations alone use, and those of solids whose rotations follow others.
    pub fn find_uses_of_equations(&mut self) {
        for equation in &self.deck.equations {
            for (k, (node, dof, _)) in equation.terms.iter().enumerate() {
                let alone = !self.uses[*node].moves;
                let uses = &mut self.uses[*node];
                uses.moves = true;
                uses.rotates |= alone || (k == 0 && *dof > 2);
                uses.follows |= k == 0;
            }
        }
    }

    /// Holds nodes in some directions of a frame by equations.
    pub fn hold_by_equations(&mut self, nodes: Vec<usize>, held: [bool; 6], frame: Frame, place: Place) {
        let support = Support { title: String::new(), name: None, nodes, held, frame, place };
        for HeldNode { node, held, sums } in held_nodes(self.deck, &support) {
            let single = (0..6).filter(|k| held[*k]).map(|k| vec![(node, k as u8, 1.0)]);
            self.held.extend(single.chain(sums).map(|terms| Equation { terms, place }));
        }
    }

    /// `[equation.imported]` and its file, if there are equations.
    pub fn equations(&mut self) -> Option<String> {
        let deck = self.deck;
        let mut all = deck.equations.clone();
        all.append(&mut self.held);
        for Equation { terms, place } in &mut all {
            // A rotation beside displacements: a θ is a length.
            for (.., a) in terms.iter_mut().filter(|(_, dof, _)| *dof > 2) {
                *a *= self.units.length;
            }
            let before = terms.len();
            terms.retain(|(node, dof, _)| *dof < 3 || self.uses[*node].rotates);
            if terms.len() < before {
                let why = "rotations of nodes of solids, which have none, are taken as held";
                self.ledger.note(Weight::Perhaps, "equations", why, *place);
            }
        }
        all.retain(|equation| !equation.terms.is_empty());
        let supports = deck.supports.iter().filter(|support| support.frame == Frame::Global);
        let held = supports.flat_map(|support| {
            let held = (0..6).filter(|k| support.held[*k]);
            held.flat_map(|k| support.nodes.iter().map(move |node| (*node, k as u8)))
        });
        let mut taken: HashSet<(usize, u8)> = held.collect();
        let mut led: HashMap<(usize, u8), Vec<usize>> = HashMap::new();
        for k in 0..all.len() {
            let (before, rest) = all.split_at_mut(k);
            let terms = &mut rest[0].terms;
            add_alike(terms);
            let (node, dof, _) = terms[0];
            let same = led.entry((node, dof / 3)).or_default();
            for other in same.iter() {
                eliminate(terms, &before[*other].terms);
            }
            choose_first(terms, &taken);
            taken.insert((terms[0].0, terms[0].1));
            same.push(k);
        }
        if all.is_empty() {
            return None;
        }
        let mut there = vec![false; deck.nodes.len()];
        let cells = self.regions.mesh.elements.iter();
        cells.flat_map(|cell| cell.nodes()).for_each(|node| there[*node] = true);
        let terms = all.iter().flat_map(|equation| &equation.terms);
        let alone: Vec<usize> = terms.map(|(node, ..)| *node).filter(|node| !there[*node]).collect();
        self.regions.points("equation_nodes", &alone);
        self.case.table("equation", "imported").key("file", quoted(Converted::EQUATIONS_FILE));
        Some(self.table(&all))
    }

    fn table(&self, all: &[Equation]) -> String {
        let mut text = String::from("equation,node,component,factor\n");
        for (k, Equation { terms, place }) in all.iter().enumerate() {
            let from = if place.line == 0 { String::new() } else { format!(" {}", self.short_place(*place)) };
            let name = format!("{}{from}", k + 1).replace('"', "'");
            let name = if name.contains([',', ';', '\t', '\'']) { format!("\"{name}\"") } else { name };
            for (node, dof, a) in terms {
                let component = ["ux", "uy", "uz", "rx", "ry", "rz"][usize::from(*dof)];
                writeln!(text, "{name},{},{component},{}", node + 1, number(*a)).expect("memory");
            }
        }
        text
    }
}

/// Adds the terms of each degree of freedom.
fn add_alike(terms: &mut Vec<Term>) {
    let mut known: HashMap<(usize, u8), usize> = HashMap::new();
    let mut sums: Vec<Term> = Vec::with_capacity(terms.len());
    for (node, dof, a) in terms.drain(..) {
        let at = *known.entry((node, dof)).or_insert(sums.len());
        match sums.get_mut(at) {
            Some(sum) => sum.2 += a,
            None => sums.push((node, dof, a)),
        }
    }
    *terms = sums;
}

/// Takes the first degree of freedom of another equation of the same node out of one that has others of that node first, too, as those
/// of a frame of the node have.
fn eliminate(terms: &mut Vec<Term>, other: &[Term]) {
    let pivot = (other[0].0, other[0].1);
    let of_node = |term: &&Term| term.0 == pivot.0 && term.1 / 3 == pivot.1 / 3;
    if terms.iter().take_while(of_node).count() < 2 {
        return;
    }
    let Some(own) = terms.iter().find(|term| (term.0, term.1) == pivot).map(|term| term.2) else { return };
    let size = terms.iter().fold(0.0_f64, |size, term| size.max(term.2.abs()));
    for (node, dof, a) in other {
        let change = -own / other[0].2 * a;
        match terms.iter_mut().find(|term| (term.0, term.1) == (*node, *dof)) {
            Some(term) => term.2 += change,
            None => terms.push((*node, *dof, change)),
        }
    }
    let kept: Vec<Term> = terms.iter().copied().filter(|term| term.2.abs() > ROUND_OFF * size).collect();
    // An equation that says the same again stays, for the case to refuse.
    if kept.first().is_some_and(|first| first.0 == pivot.0) {
        *terms = kept;
    }
}

/// Puts the degree of freedom first that follows the others: the first, or of those of its node beside it the one with the largest
/// factor that nothing holds and no other equation has first.
fn choose_first(terms: &mut [Term], taken: &HashSet<(usize, u8)>) {
    let (node, kind) = (terms[0].0, terms[0].1 / 3);
    let count = terms.iter().take_while(|(other, dof, _)| (*other, dof / 3) == (node, kind)).count();
    let free = |k: &usize| !taken.contains(&(node, terms[*k].1)) && terms[*k].2 != 0.0;
    let size = |k: usize| terms[k].2.abs();
    let Some(largest) = (0..count).filter(free).max_by(|a, b| size(*a).total_cmp(&size(*b))) else { return };
    if !free(&0) || size(0) < FIRST * size(largest) {
        terms.swap(0, largest);
    }
}

#[cfg(test)]
mod tests {
    use crate::{Format, Units, convert, read_bytes};
    use stridor_base::bounds::{Origin::*, within};

    /// Node, component and factor of each term.
    type Rows = Vec<Vec<(usize, String, f64)>>;

    /// What a brick with more cards becomes, in mm: its equations and its case.
    fn imported(more: &str) -> (Rows, String) {
        let text = format!(
            "*NODE\n1, 0, 0, 0\n2, 10, 0, 0\n3, 10, 10, 0\n4, 0, 10, 0\n5, 0, 0, 10\n6, 10, 0, 10\n7, 10, 10, 10\n8, 0, 10, 10\n\
             100, 20, 0, 0\n*ELEMENT, TYPE=C3D8, ELSET=E\n1, 1, 2, 3, 4, 5, 6, 7, 8\n*SOLID SECTION, ELSET=E, MATERIAL=M\n\
             *MATERIAL, NAME=M\n*ELASTIC\n210000., .3\n*DENSITY\n7.85E-9\n{more}*STEP\n*FREQUENCY\n5\n*END STEP\n"
        );
        let deck = read_bytes("a.inp", text.as_bytes(), Format::Abaqus).unwrap_or_else(|e| panic!("{e}"));
        let made = convert(&deck, Units::named("mm").unwrap()).unwrap();
        let matters = made.ledger.rows().filter(|row| row.weight == crate::Weight::Matters);
        assert_eq!(matters.count(), 0, "{}", made.page);
        let (mut rows, mut last) = (Rows::new(), String::new());
        for line in made.equations.unwrap_or_default().lines().skip(1) {
            let cells: Vec<&str> = line.split(',').collect();
            if last != cells[0] {
                rows.push(Vec::new());
                last = cells[0].to_string();
            }
            let term = (cells[1].parse().unwrap(), cells[2].to_string(), cells[3].parse().unwrap());
            rows.last_mut().unwrap().push(term);
        }
        (rows, made.case)
    }

    #[test]
    fn rotations_are_in_metres_and_nodes_of_no_element_are_points() {
        let (rows, case) =
            imported("*EQUATION\n3\n7, 3, 2., 100, 4, -5., 100, 3, 1.\n*BOUNDARY\n100, 1, 2\n");
        let term = |node, component: &str, factor| (node, component.to_string(), factor);
        assert_eq!(rows, [[term(7, "uz", 2.0), term(9, "rx", -0.005), term(9, "uz", 1.0)]]);
        assert!(case.contains("[equation.imported]\nfile = \"equations.csv\""), "{case}");
        assert!(case.contains("held = [\"ux\", \"uy\"]"), "{case}");
    }

    /// A node that springs alone have may be held.
    #[test]
    fn ends_of_springs_are_held() {
        let spring = "*ELEMENT, TYPE=SPRING2, ELSET=S\n2, 100, 7\n*SPRING, ELSET=S\n1, 1\n100.\n*BOUNDARY\n100, 1, 3\n";
        let (rows, case) = imported(spring);
        assert!(rows.is_empty() && case.contains("held = [\"ux\", \"uy\", \"uz\"]"), "{case}");
    }

    /// A rotation of a node of solids is none, unless an equation leads it.
    #[test]
    fn rotations_of_solids_are_left_out() {
        let (rows, _) = imported("*EQUATION\n3\n7, 3, 2., 1, 4, -5., 2, 3, 1.\n");
        assert_eq!(rows[0].len(), 2);
        let (rows, _) = imported("*EQUATION\n3\n7, 3, 2., 1, 4, -5., 2, 3, 1.\n2\n1, 4, 1., 3, 3, 9.\n");
        assert_eq!((rows[0].len(), rows[1].len()), (3, 2));
    }

    /// Two directions of a frame that is turned by 30° follow others: each equation has a first degree of freedom of its own, and with what
    /// they say of the node the equations of the deck hold.
    #[test]
    fn directions_of_a_frame_follow_by_different_components() {
        let (c, s) = (0.75_f64.sqrt(), 0.5);
        let frame = format!("*NSET, NSET=T\n7\n*TRANSFORM, NSET=T\n{c}, {s}, 0., {}, {c}, 0.\n", -s);
        let equations = "*EQUATION\n2\n7, 1, 1., 2, 1, -1.\n2\n7, 2, 1., 3, 2, -3.\n";
        let (rows, _) = imported(&format!("{frame}{equations}"));
        let firsts: Vec<&str> = rows.iter().map(|row| row[0].1.as_str()).collect();
        assert_eq!(firsts, ["ux", "uy"]);
        // u₂ₓ = 0.7 and u₃ᵧ = 0.4: the last equation first, as the other may follow it.
        let known = |node: usize| if node == 2 { 0.7 } else { 0.4 };
        let mut u = [0.0; 2];
        for row in rows.iter().rev() {
            let axis = |name: &str| usize::from(name == "uy");
            let value = |(node, name, a): &(usize, String, f64)| {
                a * if *node == 7 { u[axis(name)] } else { known(*node) }
            };
            let others: f64 = row[1..].iter().map(value).sum();
            u[axis(&row[0].1)] = -others / row[0].2;
        }
        let off = [c * u[0] + s * u[1] - 0.7, c * u[1] - s * u[0] - 1.2].map(f64::abs);
        assert!(within(off[0], 1e-14, RoundOff) && within(off[1], 1e-14, RoundOff), "{off:?}");
        // One of them held, along no axis: an equation, too.
        let (rows, case) = imported(&format!("*BOUNDARY\n7, 2\n{frame}*EQUATION\n2\n7, 1, 1., 2, 1, -1.\n"));
        assert_eq!((rows.len(), rows[1].len()), (2, 2), "{rows:?}");
        assert!(rows[0][0].1 != rows[1][0].1 && !case.contains("[support"), "{case}");
    }
}
