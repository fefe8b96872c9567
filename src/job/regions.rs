//! The mesh of a case with the case's own points, and its regions by name.

use crate::case::{Case, MeshSource};
use crate::error::{Error, Fault, Faults, Result, nearest};
use crate::mesh::{Element, Mesh, Region};

/// A mesh whose regions are looked up by name, with a fault that lists the existing ones.
#[derive(Debug, Clone)]
pub struct Regions {
    /// The mesh, in metres.
    pub mesh: Mesh,
    /// The file of the mesh, in back-ticks, or `the mesh`.
    name: String,
}

impl Regions {
    /// Adds the case's points to `mesh` as regions of one point.
    pub fn new(mut mesh: Mesh, case: &Case) -> Self {
        for (name, position) in &case.point {
            mesh.nodes.push(*position);
            mesh.elements.push(Element::Point([mesh.nodes.len() - 1]));
            mesh.regions.push(Region {
                name: name.clone(),
                dimension: 0,
                elements: vec![mesh.elements.len() - 1],
            });
        }
        let name = match &case.mesh {
            Some(MeshSource::File { file, .. }) => format!("`{file}`"),
            _ => "the mesh".to_string(),
        };
        Regions { mesh, name }
    }

    /// The region `name`, that `place` asks for.
    ///
    /// # Errors
    /// A fault with the regions that the mesh has.
    pub fn region(&self, name: &str, place: &str) -> Result<&Region> {
        self.mesh.region(name).ok_or_else(|| {
            let names: Vec<&str> = self.mesh.regions.iter().map(|r| r.name.as_str()).collect();
            let known = if names.is_empty() { "it has none".to_string() } else { names.join(", ") };
            let help = nearest(name, names).map_or(String::new(), |near| format!("Did you mean \"{near}\"?"));
            Error::input(
                Fault::new(place, format!("\"{name}\""), format!("a region of {} ({known})", self.name))
                    .with_help(help),
            )
        })
    }

    /// Looks up the regions that the case names beside those its structure is built of.
    ///
    /// # Errors
    /// Every one that is missing.
    pub fn check_named(&self, case: &Case) -> Result<()> {
        let mut asked: Vec<(String, &str)> = Vec::new();
        asked.extend(case.force.iter().map(|(name, f)| (format!("force.{name}.on"), f.on.as_str())));
        asked.extend(case.contact.iter().map(|(name, c)| (format!("contact.{name}.body"), c.body.as_str())));
        for (name, modes) in &case.modes {
            asked.extend(modes.clamp.iter().map(|on| (format!("modes.{name}.clamp"), on.as_str())));
        }
        for (name, frf) in &case.frf {
            let responses = frf.response.iter().map(|(place, at)| (format!("response.{place}"), at));
            let places = responses.chain([("excitation".to_string(), &frf.excitation)]);
            asked.extend(
                places.filter_map(|(key, at)| Some((format!("frf.{name}.{key}.on"), at.on.as_deref()?))),
            );
        }
        if let Some(transient) = &case.transient {
            let push = transient.push.iter();
            asked.extend(push.map(|(name, p)| (format!("transient.push.{name}.on"), p.on.as_str())));
            let probe = transient.probe.iter();
            asked.extend(
                probe.filter_map(|(name, p)| Some((format!("transient.probe.{name}.on"), p.on.as_deref()?))),
            );
        }
        let mut faults = Faults::new();
        for (place, name) in asked {
            faults.take(self.region(name, &format!("`{place}`")));
        }
        faults.into_result(())
    }

    /// The nodes of region `name`, ascending.
    pub fn nodes(&self, name: &str, place: &str) -> Result<Vec<usize>> {
        Ok(self.mesh.region_nodes(self.region(name, place)?))
    }

    /// The nodes of several regions, ascending, each once; regions that are missing are noted in `faults`.
    pub fn nodes_of(&self, names: &[String], place: &str, faults: &mut Faults) -> Vec<usize> {
        let mut nodes: Vec<usize> =
            names.iter().filter_map(|name| faults.take(self.nodes(name, place))).flatten().collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// A node for a message: its number in the mesh file, and its region if that has only this node.
    pub fn name_of_node(&self, node: usize) -> String {
        let own = self.mesh.regions.iter().find(|region| {
            region.dimension == 0
                && matches!(region.elements[..], [e] if self.mesh.elements[e].nodes() == [node])
        });
        let own = own.map_or(String::new(), |region| format!(" (`{}`)", region.name));
        format!("node {}{own}", self.mesh.node_tag(node))
    }

    /// Nodes for a message: `24 nodes, the first node 32,`, or the name of the only one.
    pub fn count_of_nodes(&self, nodes: &[usize]) -> String {
        match nodes {
            [node] => self.name_of_node(*node),
            _ => format!("{} nodes, the first {},", nodes.len(), self.name_of_node(nodes[0])),
        }
    }

    /// The only node of region `name`.
    pub fn node(&self, name: &str, place: &str) -> Result<usize> {
        match self.nodes(name, place)?.as_slice() {
            [node] => Ok(*node),
            nodes => Err(Error::input(Fault::new(
                place,
                format!("region \"{name}\" of {} nodes", nodes.len()),
                "a region of one point",
            ))),
        }
    }

    /// The elements of region `name`, which must have `dimension`.
    pub fn elements(&self, name: &str, dimension: usize, place: &str) -> Result<Vec<Element>> {
        let region = self.region(name, place)?;
        if region.dimension != dimension {
            let kind = |d: usize| ["points", "lines", "faces"][d.min(2)];
            return Err(Error::input(Fault::new(
                place,
                format!("region \"{name}\" of {}", kind(region.dimension)),
                format!("a region of {}", kind(dimension)),
            )));
        }
        Ok(region.elements.iter().map(|e| self.mesh.elements[*e].clone()).collect())
    }
}
