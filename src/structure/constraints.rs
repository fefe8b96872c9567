//! Slave degrees of freedom as sums of others: who follows whom and who is held, checked in one place, in the words of a model or of a case.
//!
//! Every kind of constraint is a list of [`Constraint`](super::Constraint)s, u_slave = Σ c u: rigid links, u_s = u_m + θ_m × (x_s − x_m) and
//! θ_s = θ_m, and the couplings of a model, as ties and averaging links are. Sums of slaves are resolved in topological order.

use super::drilling::Drilling;
use super::model::{Model, RigidLink};
use crate::error::{Fault, Faults};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// A sum of degrees of freedom, 6 node + component, with their coefficients.
type Sum = Vec<(usize, f64)>;

/// How messages name links, supports and nodes, which are given by their indices.
pub struct ConstraintWords<'a> {
    /// A link.
    pub link: &'a dyn Fn(usize) -> String,
    /// The place that lists its followers.
    pub followers: &'a dyn Fn(usize) -> String,
    /// The place that lists the nodes of a support.
    pub support: &'a dyn Fn(usize) -> String,
    /// A node.
    pub node: &'a dyn Fn(usize) -> String,
    /// Nodes: how many, and the first.
    pub nodes: &'a dyn Fn(&[usize]) -> String,
}

/// [`check_constraints`] of a model without names.
pub(super) fn check_unnamed(model: &Model, faults: &mut Faults) -> Vec<usize> {
    let node = |node: usize| format!("node {}", node + 1);
    let link = |k: usize| format!("rigid link {}", k + 1);
    let nodes = |all: &[usize]| match all {
        [one] => node(*one),
        all => format!("{} nodes, the first {},", all.len(), node(all[0])),
    };
    let support = |k: usize| format!("support {}", k + 1);
    check_constraints(
        model,
        &ConstraintWords { link: &link, followers: &link, support: &support, node: &node, nodes: &nodes },
        faults,
    )
}

/// The last master of every node of `model` by rigid links; its own number for a node that follows none.
///
/// Faults: a master among its followers, degrees of freedom that are slaves twice, circles, supports of slaves.
pub fn check_constraints(model: &Model, words: &ConstraintWords, faults: &mut Faults) -> Vec<usize> {
    let before = faults.0.len();
    let masters = check_links(model, words, faults);
    let producers = check_slaves(model, &masters, words, faults);
    // Supports of slaves are faults beside slaves that are slaves twice.
    check_supports(model, &masters, &producers, words, faults);
    if faults.0.len() == before {
        check_circles(model, &masters, words, faults);
    }
    masters
}

/// Rigid links: one master for every node, no circles.
fn check_links(model: &Model, words: &ConstraintWords, faults: &mut Faults) -> Vec<usize> {
    // The master of every follower, and the first link that says so.
    let mut leader: Vec<Option<(usize, usize)>> = vec![None; model.nodes.len()];
    for (k, RigidLink { master, slaves }) in model.links.iter().enumerate() {
        let twice = |slave: &&usize| leader[**slave].is_some_and(|(other, _)| other != *master);
        let twice: Vec<usize> = slaves.iter().filter(twice).copied().collect();
        if let Some((other, first)) = twice.first().and_then(|slave| leader[*slave]) {
            let (master, link) = ((words.node)(other), (words.link)(first));
            let (nodes, follow) = ((words.nodes)(&twice), follow(&twice));
            let found = format!("{nodes} that already {follow} {master} by {link}");
            let fault = Fault::new((words.followers)(k), found, "one master for every node");
            faults.push(fault.with_help("Let one of the masters follow the other instead"));
        }
        slaves.iter().for_each(|slave| {
            leader[*slave].get_or_insert((*master, k));
        });
    }
    let mut masters: Vec<usize> = (0..leader.len()).collect();
    for (node, own) in leader.iter().enumerate() {
        let Some((first, link)) = *own else { continue };
        // One that leads into a circle is not the one to be named.
        for _ in 0..leader.len() {
            let Some((next, _)) = leader[masters[node]] else { break };
            if next == node {
                faults.push(circle((words.followers)(link), [node, first], words));
                return masters;
            }
            masters[node] = next;
        }
    }
    masters
}

fn follow(nodes: &[usize]) -> &'static str {
    if nodes.len() == 1 { "follows" } else { "follow" }
}

fn circle(place: String, [node, first]: [usize; 2], words: &ConstraintWords) -> Fault {
    let (node, first) = ((words.node)(node), (words.node)(first));
    let found = format!("a circle: {node} follows {first}, which follows {node} in the end");
    Fault::new(place, found, "a master that follows none of its followers")
}

/// The coupling that makes each of its degrees of freedom a slave; faults where another one, or a rigid link, does so before.
fn check_slaves(
    model: &Model,
    masters: &[usize],
    words: &ConstraintWords,
    faults: &mut Faults,
) -> HashMap<usize, usize> {
    let mut producers: HashMap<usize, usize> = HashMap::new();
    for (k, coupling) in model.couplings.iter().enumerate() {
        let mut twice: BTreeMap<String, BTreeSet<usize>> = BTreeMap::new();
        for (node, component) in coupling.constraints.iter().map(|constraint| constraint.slave) {
            let other = match producers.insert(6 * node + component, k) {
                Some(other) => Some(model.couplings[other].name.clone()),
                None if masters[node] != node => {
                    model.links.iter().position(|link| link.slaves.contains(&node)).map(words.link)
                }
                None => None,
            };
            if let Some(other) = other {
                twice.entry(other).or_default().insert(node);
            }
        }
        for (other, nodes) in twice {
            let nodes: Vec<usize> = nodes.into_iter().collect();
            let found = format!("{} that already {} by {other}", (words.nodes)(&nodes), follow(&nodes));
            let fault = Fault::new(&coupling.name, found, "nodes that follow others in one way alone");
            faults.push(fault.with_help("Leave them out of one of both, or let them lead in one"));
        }
    }
    producers
}

/// Supports that hold slaves.
fn check_supports(
    model: &Model,
    masters: &[usize],
    producers: &HashMap<usize, usize>,
    words: &ConstraintWords,
    faults: &mut Faults,
) {
    let mut check = |place: String, held: &mut dyn Iterator<Item = (usize, [bool; 6])>| {
        let (mut moved, mut coupled) = (Vec::new(), Vec::new());
        for (node, held) in held.filter(|(_, held)| held.contains(&true)) {
            if masters[node] != node {
                moved.push(node);
            } else if let Some(by) = (0..6).find_map(|k| held[k].then(|| producers.get(&(6 * node + k)))?) {
                coupled.push((node, *by));
            }
        }
        if let Some(first) = moved.first() {
            let (master, nodes) = ((words.node)(masters[*first]), (words.nodes)(&moved));
            let found = format!("{nodes} that {} {master} rigidly", follow(&moved));
            let fault = Fault::new(&place, found, "regions of masters, or of nodes that follow none");
            faults.push(fault.with_help(format!("Hold the master, {master}")));
        }
        if let Some((_, by)) = coupled.first() {
            let nodes: Vec<usize> = coupled.iter().map(|(node, _)| *node).collect();
            let name = &model.couplings[*by].name;
            let found = format!("{} that {} others by {name}", (words.nodes)(&nodes), follow(&nodes));
            let fault = Fault::new(&place, found, "nodes that follow none in the held directions");
            faults.push(fault.with_help(format!("Hold what they follow, or leave them out of {name}")));
        }
    };
    for (k, support) in model.supports.iter().enumerate() {
        check((words.support)(k), &mut support.nodes.iter().map(|node| (*node, support.held)));
    }
    let mut inclined: BTreeMap<&str, Vec<(usize, [bool; 6])>> = BTreeMap::new();
    for support in &model.inclined_supports {
        let held = std::array::from_fn(|k| support.held.iter().any(|direction| direction[k] != 0.0));
        inclined.entry(&support.name).or_default().push((support.node, held));
    }
    inclined.into_iter().for_each(|(name, held)| check(name.to_string(), &mut held.into_iter()));
}

/// Couplings that follow themselves in the end.
fn check_circles(model: &Model, masters: &[usize], words: &ConstraintWords, faults: &mut Faults) {
    let definitions = definitions(model, masters, &|_| None);
    let Err(left) = resolve(&definitions) else { return };
    // From one that is left to one that is left, until one comes again.
    let next = |row: usize| definitions[&row].iter().map(|(row, _)| *row).find(|row| left.contains(row));
    let Some(mut row) = left.first().copied() else { return };
    let mut passed = BTreeSet::new();
    while passed.insert(row) {
        row = next(row).expect("it waits for another that is left");
    }
    let node = row / 6;
    let other = std::iter::successors(next(row), |row| next(*row)).take(left.len()).map(|row| row / 6);
    let first = other.into_iter().find(|other| *other != node).unwrap_or(node);
    let has = |constraint: &super::Constraint| 6 * constraint.slave.0 + constraint.slave.1 == row;
    let coupling = model.couplings.iter().find(|coupling| coupling.constraints.iter().any(has));
    let link = || model.links.iter().position(|link| link.slaves.contains(&node)).map(words.followers);
    let place = coupling.map(|coupling| coupling.name.clone()).or_else(link).unwrap_or_default();
    faults.push(circle(place, [node, first], words));
}

/// What every slave is a sum of, slaves among them: the followers of rigid links of their last master, those of the couplings. The
/// rotation of a follower about the normal that `free` gives is its own, the degree of freedom 6 n + node of a model of n nodes.
fn definitions(
    model: &Model,
    masters: &[usize],
    free: &dyn Fn(usize) -> Option<[f64; 3]>,
) -> HashMap<usize, Sum> {
    let mut all = HashMap::new();
    for (slave, master) in masters.iter().enumerate().filter(|(slave, master)| slave != *master) {
        let mut rows = rigid_rows(model, slave, *master);
        if let Some(normal) = free(slave) {
            for (k, row) in rows[3..].iter_mut().enumerate() {
                let kept = |j: usize| f64::from(u8::from(j == k)) - normal[k] * normal[j];
                *row = (0..3).map(|j| (6 * master + 3 + j, kept(j))).collect();
                row.push((6 * model.nodes.len() + slave, normal[k]));
                row.retain(|(_, coefficient)| *coefficient != 0.0);
            }
        }
        all.extend(rows.into_iter().enumerate().map(|(k, row)| (6 * slave + k, row)));
    }
    for constraint in model.couplings.iter().flat_map(|coupling| &coupling.constraints) {
        let terms = constraint.terms.iter().map(|(node, component, c)| (6 * node + component, *c)).collect();
        all.insert(6 * constraint.slave.0 + constraint.slave.1, terms);
    }
    all
}

/// u_s = u_m + θ_m × (x_s − x_m), θ_s = θ_m.
pub(super) fn rigid_rows(model: &Model, slave: usize, master: usize) -> [Sum; 6] {
    let r: [f64; 3] = std::array::from_fn(|k| model.nodes[slave][k] - model.nodes[master][k]);
    std::array::from_fn(|k| {
        let mut row = vec![(6 * master + k, 1.0)];
        if k < 3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let arms = [(6 * master + 3 + i, r[j]), (6 * master + 3 + j, -r[i])];
            row.extend(arms.into_iter().filter(|(_, arm)| *arm != 0.0));
        }
        row
    })
}

/// Every slave as a sum of degrees of freedom that are none, ascending; those that wait for each other in a circle.
fn resolve(definitions: &HashMap<usize, Sum>) -> Result<HashMap<usize, Sum>, Vec<usize>> {
    let mut order: Vec<usize> = definitions.keys().copied().collect();
    order.sort_unstable();
    // How many slaves each waits for, and who waits for it.
    let mut waits: HashMap<usize, usize> = HashMap::new();
    let mut waiting: HashMap<usize, Vec<usize>> = HashMap::new();
    for row in &order {
        let slaves = definitions[row].iter().filter(|(other, _)| definitions.contains_key(other));
        for (other, _) in slaves {
            *waits.entry(*row).or_default() += 1;
            waiting.entry(*other).or_default().push(*row);
        }
    }
    let mut ready: Vec<usize> = order.iter().rev().filter(|row| !waits.contains_key(row)).copied().collect();
    let mut resolved: HashMap<usize, Sum> = HashMap::with_capacity(order.len());
    while let Some(row) = ready.pop() {
        let mut sum: BTreeMap<usize, f64> = BTreeMap::new();
        for (other, c) in &definitions[&row] {
            match resolved.get(other) {
                Some(terms) => terms.iter().for_each(|(k, v)| *sum.entry(*k).or_default() += c * v),
                None => *sum.entry(*other).or_default() += c,
            }
        }
        resolved.insert(row, sum.into_iter().filter(|(_, c)| *c != 0.0).collect());
        for next in waiting.get(&row).into_iter().flatten() {
            let left = waits.get_mut(next).expect("it waits");
            *left -= 1;
            if *left == 0 {
                ready.push(*next);
            }
        }
    }
    if resolved.len() == order.len() {
        return Ok(resolved);
    }
    order.retain(|row| !resolved.contains_key(row));
    Err(order)
}

/// Slaves as sums of degrees of freedom that are none.
pub(super) struct Sums {
    n_nodes: usize,
    sums: HashMap<usize, Sum>,
}

impl Sums {
    /// Those of `model`, whose constraints are known to be sound.
    pub fn new(model: &Model, masters: &[usize], drilling: &Drilling) -> Self {
        let free = |node: usize| drilling.normal(node);
        let sums = resolve(&definitions(model, masters, &free)).unwrap_or_default();
        Sums { n_nodes: model.nodes.len(), sums }
    }

    /// What a degree of freedom is a sum of, ascending; `None` of one that is no slave.
    pub fn of(&self, row: usize) -> Option<&[(usize, f64)]> {
        self.sums.get(&row).map(Vec::as_slice)
    }

    /// Node and component of a degree of freedom; `None` of a rotation about a normal.
    pub fn component(&self, row: usize) -> Option<(usize, usize)> {
        (row < 6 * self.n_nodes).then_some((row / 6, row % 6))
    }

    /// The node of a rotation about a normal.
    pub fn turning(&self, row: usize) -> Option<usize> {
        row.checked_sub(6 * self.n_nodes)
    }

    /// The nodes with a slave among their degrees of freedom, ascending.
    pub fn slave_nodes(&self) -> Vec<usize> {
        let nodes: BTreeSet<usize> = self.sums.keys().map(|row| row / 6).collect();
        nodes.into_iter().collect()
    }

    /// The nodes that a node moves with: itself where it has degrees of freedom of its own.
    pub fn nodes_of(&self, node: usize) -> Vec<usize> {
        let mut nodes = Vec::with_capacity(1);
        for row in 6 * node..6 * node + 6 {
            match self.of(row) {
                None => nodes.push(node),
                Some(sum) => nodes.extend(sum.iter().map(|(row, _)| self.turning(*row).unwrap_or(row / 6))),
            }
        }
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }
}
