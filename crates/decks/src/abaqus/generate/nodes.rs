//! *NGEN, *NFILL, *NCOPY.

use super::curves::{Curve, part};
use crate::abaqus::blocks;
use crate::abaqus::frames::unit;
use crate::abaqus::mesh::cartesian;
use crate::abaqus::reader::{Found, Reader, Row};
use crate::abaqus::space::Placement;
use crate::ledger::Weight;
use stridor_mesh::quality::{cross, dot};

/// Places that are this part of the largest coordinate apart are one: files have some seven digits.
const ONE_PLACE: f64 = 1e-6;
/// Parts of a radius by which the ends of an arc may differ without a note.
const ONE_RADIUS: f64 = 1e-4;

impl Reader {
    /// *NGEN: first node, last node, increment; of a curve the node of an extra point, or its coordinates, and a normal.
    pub fn nodes_on_curves(&mut self, space: usize, found: Found<'_>) {
        let mut all = Vec::new();
        for row in found.rows() {
            all.extend(self.nodes_on_curve(space, found, &row).unwrap_or_default());
        }
        if let Some(name) = found.option("NSET") {
            let set = self.spaces[space].node_set(name);
            set.members.extend(all);
            set.unsorted = false;
        }
    }

    fn nodes_on_curve(&mut self, space: usize, found: Found<'_>, row: &Row<'_>) -> Option<Vec<usize>> {
        let ends = [self.node_above(space, row, 0)?, self.node_above(space, row, 1)?];
        let [first, last] = ends.map(|node| i128::from(self.deck.nodes[node].number));
        let increment = i128::from(self.whole(row, 2, 1)?);
        if first == last || increment == 0 || (last - first) % increment != 0 {
            let words = format!("nodes from {first} to {last} by {increment}");
            self.files.fault(
                row.place,
                words,
                "two nodes, and an increment that leads from one to the other",
            );
            return None;
        }
        let n = ((last - first) / increment).unsigned_abs();
        if !self.may_generate(n - 1, row.place) {
            return None;
        }
        let places = ends.map(|node| self.deck.nodes[node].position);
        let curve = self.curve(space, found, row, places)?;
        let within = ONE_PLACE * largest(&places);
        let mut all = ends.to_vec();
        let step = (last - first) / n as i128;
        for k in 1..n {
            let number = self.shifted(first as u64, k as i128 * step, row.place)?;
            let position = curve.at(k as f64 / n as f64);
            all.extend(self.put_node(space, found, row.place, number, position, within));
        }
        Some(all)
    }

    /// The curve of a line of *NGEN.
    fn curve(&mut self, space: usize, found: Found<'_>, row: &Row<'_>, ends: [[f64; 3]; 2]) -> Option<Curve> {
        let line = found.option("LINE").unwrap_or_default().to_uppercase();
        if line.is_empty() {
            return Some(Curve::Line(ends));
        }
        let placement = self.spaces[space].placement;
        let extra = if row.cell(3).is_empty() {
            let given = cartesian(self.numbers::<3>(row, 4)?, found.option("SYSTEM"));
            placement.map_or(given, |placement| placement.place(given))
        } else {
            let node = self.node_above(space, row, 3)?;
            self.deck.nodes[node].position
        };
        match line.as_str() {
            "P" => Some(Curve::Parabola([ends[0], extra, ends[1]])),
            "C" => {
                let given = self.numbers::<3>(row, 7)?;
                let normal =
                    (given != [0.0; 3]).then(|| placement.map_or(given, |placement| placement.turn(given)));
                let arc = Curve::arc(ends, extra, normal);
                match arc {
                    Some(Curve::Arc { radii: [a, b], .. }) if (a - b).abs() > ONE_RADIUS * a.max(b) => {
                        let why = "ends at different distances from the centre: the radius changes evenly";
                        self.deck.ledger.note(Weight::Perhaps, "*NGEN, LINE=C", why, row.place);
                    }
                    Some(_) => {}
                    None => self.files.fault(
                        row.place,
                        "an arc whose ends and centre are in one line",
                        "a normal in columns 8 to 10, or ends that are off that line",
                    ),
                }
                arc
            }
            _ => {
                let words = format!("LINE={}", blocks::short(&line));
                self.files.fault(found.place(), words, "LINE=P, a parabola, or LINE=C, an arc");
                None
            }
        }
    }

    /// *NFILL: two sets, intervals, increment.
    pub fn nodes_between(&mut self, space: usize, found: Found<'_>) {
        let bias = match found.option("BIAS").map(stridor_base::numbers::parse) {
            None => 1.0,
            Some(Some(bias)) if bias > 0.0 && bias.is_finite() => bias,
            Some(_) => {
                let words = format!("BIAS={}", found.option("BIAS").unwrap_or_default());
                self.files.fault(found.place(), words, "the ratio of an interval to the next one, above 0");
                return;
            }
        };
        if found.option("SINGULAR").is_some() {
            let why = "nodes beside the tip of a crack are not moved to quarters";
            self.deck.ledger.note(Weight::Matters, "*NFILL, SINGULAR", why, found.place());
        }
        let two_step = found.block.has("TWOSTEP");
        let mut all = Vec::new();
        for row in found.rows() {
            all.extend(self.fill(space, found, &row, bias, two_step).unwrap_or_default());
        }
        if let Some(name) = found.option("NSET") {
            self.spaces[space].node_set(name).members.extend(all);
        }
    }

    fn fill(
        &mut self,
        space: usize,
        found: Found<'_>,
        row: &Row<'_>,
        bias: f64,
        two_step: bool,
    ) -> Option<Vec<usize>> {
        let from = self.nodes_so_far(space, row.cell(0), row.place)?;
        let to = self.nodes_so_far(space, row.cell(1), row.place)?;
        let n = self.count(row, 2)? as usize;
        let increment = i128::from(self.whole(row, 3, 1)?);
        let refused = [
            (
                from.len() != to.len(),
                format!("sets of {} and {} nodes", from.len(), to.len()),
                "as many in both",
            ),
            (two_step && n % 2 == 1, format!("TWO STEP with {n} intervals"), "an even number"),
        ];
        if let Some((_, words, expected)) = refused.into_iter().find(|(is, ..)| *is) {
            self.files.fault(row.place, words, expected);
            return None;
        }
        if !self.may_generate((n as u128 - 1) * from.len() as u128, row.place) {
            return None;
        }
        let places: Vec<[f64; 3]> =
            from.iter().chain(&to).map(|node| self.deck.nodes[*node].position).collect();
        let within = ONE_PLACE * largest(&places);
        let at = |k: usize| {
            if two_step {
                0.5 * (part(k / 2, n / 2, bias) + part(k.div_ceil(2), n / 2, bias))
            } else {
                part(k, n, bias)
            }
        };
        let mut all = [from.as_slice(), to.as_slice()].concat();
        for (line, (a, b)) in from.iter().zip(&places[from.len()..]).enumerate() {
            let number = self.deck.nodes[*a].number;
            let curve = Curve::Line([places[line], *b]);
            for k in 1..n {
                let number = self.shifted(number, k as i128 * increment, row.place)?;
                all.extend(self.put_node(space, found, row.place, number, curve.at(at(k)), within));
            }
        }
        Some(all)
    }

    /// *NCOPY: the nodes of a set, shifted and turned, or reflected.
    pub fn copied_nodes(&mut self, space: usize, found: Found<'_>) {
        if found.block.has("POLE") {
            let why = "nodes away from a pole, of infinite elements, are not read";
            self.deck.ledger.note(Weight::Matters, "*NCOPY, POLE", why, found.place());
            return;
        }
        let (Some(by), Some(name)) =
            (self.shift(found, "CHANGENUMBER", "CHANGE NUMBER"), self.old_set(found))
        else {
            return;
        };
        let Some(map) = self.map(found) else { return };
        let Some(old) = self.nodes_so_far(space, name, found.place()) else { return };
        if !self.may_generate(old.len() as u128, found.place()) {
            return;
        }
        let placement = self.spaces[space].placement;
        // In the part, where it is placed.
        let moved = |x: [f64; 3]| match placement {
            Some(placement) => placement.place(map.place(placement.back(x))),
            None => map.place(x),
        };
        let places: Vec<[f64; 3]> = old.iter().map(|node| moved(self.deck.nodes[*node].position)).collect();
        let within = ONE_PLACE * largest(&places);
        let mut all = Vec::with_capacity(old.len());
        for (node, position) in old.into_iter().zip(places) {
            let number = self.deck.nodes[node].number;
            let Some(number) = self.shifted(number, i128::from(by), found.place()) else { return };
            all.extend(self.put_node(space, found, found.place(), number, position, within));
        }
        if let Some(new) = found.option("NEWSET") {
            let unsorted = self.spaces[space].node_sets.get(name).is_some_and(|set| set.unsorted);
            let set = self.spaces[space].node_set(new);
            set.unsorted = unsorted && (set.unsorted || set.members.is_empty());
            set.members.extend(all);
        }
    }

    /// Where a point goes by *NCOPY.
    fn map(&mut self, found: Found<'_>) -> Option<Placement> {
        let mut rows = found.rows();
        let reflect = found.option("REFLECT").map(str::to_uppercase);
        let unread = if reflect.is_some() { rows.next() } else { None };
        let map = match (reflect.as_deref(), &unread) {
            (None, _) if found.block.has("SHIFT") => {
                let times = found.option("MULTIPLE").map(|times| times.parse::<u32>().ok());
                match times.unwrap_or(Some(1)) {
                    Some(times) => self.placement(found, f64::from(times)),
                    None => None,
                }
            }
            (Some("POINT"), Some(row)) => {
                let centre = self.numbers::<3>(row, 0)?;
                Some(reflection([0.0; 3], centre, [-1.0, 0.0]))
            }
            (Some("LINE"), Some(row)) => {
                let [ax, ay, az, bx, by, bz] = self.numbers::<6>(row, 0)?;
                let direction = unit([bx - ax, by - ay, bz - az]);
                direction.map(|direction| reflection(direction, [ax, ay, az], [-1.0, 2.0]))
            }
            (Some("MIRROR"), Some(row)) => {
                let [ax, ay, az, bx, by, bz] = self.numbers::<6>(row, 0)?;
                let third = rows.next().and_then(|row| self.numbers::<3>(&row, 0));
                let [cx, cy, cz] = third.unwrap_or([ax, ay, az]);
                let normal = unit(cross([bx - ax, by - ay, bz - az], [cx - ax, cy - ay, cz - az]));
                normal.map(|normal| reflection(normal, [ax, ay, az], [1.0, -2.0]))
            }
            _ => None,
        };
        if map.is_none() {
            self.files.fault(
                found.place(),
                "*NCOPY without a motion",
                "SHIFT and a translation; REFLECT=POINT and a point, LINE and two, MIRROR and three that are no line",
            );
        }
        map
    }

    /// A node by its number, of those that stand above; a fault where there is none.
    fn node_above(&mut self, space: usize, row: &Row<'_>, at: usize) -> Option<usize> {
        let number = self.label(row.place, row.cell(at))?;
        let node = self.spaces[space].nodes.get(&number).copied();
        if node.is_none() {
            self.files.fault(row.place, format!("node {number}"), "a node above this line");
        }
        node
    }
}

/// x ↦ a + M (x − a) with M = p I + q n nᵀ.
fn reflection(n: [f64; 3], a: [f64; 3], [p, q]: [f64; 2]) -> Placement {
    let rotation =
        std::array::from_fn(|i| std::array::from_fn(|j| (if i == j { p } else { 0.0 }) + q * n[i] * n[j]));
    let turned: [f64; 3] = std::array::from_fn(|i| p * a[i] + q * dot(n, a) * n[i]);
    Placement { rotation, translation: std::array::from_fn(|i| a[i] - turned[i]) }
}

/// The largest coordinate.
fn largest(places: &[[f64; 3]]) -> f64 {
    places.iter().flatten().fold(0.0, |most, x| x.abs().max(most))
}
