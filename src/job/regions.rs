//! The mesh of a case with the case's own points, and its regions by name.

use crate::case::{Case, MeshSource};
use crate::error::{Error, Fault, Faults, Result, nearest};
use crate::mesh::{Cell, CellKind, Mesh, Region, made_of};
use crate::schema::dotted;
use std::sync::Arc;

/// A mesh whose regions are looked up by name, with a fault that lists the existing ones.
#[derive(Debug, Clone)]
pub struct Regions {
    /// The mesh, in metres.
    pub mesh: Arc<Mesh>,
    /// The file of the mesh, in back-ticks, or `the mesh`.
    name: String,
}

/// What to do where a plate is meshed as a solid.
const NOT_SOLID: &str = "A region of solids is a [solid]; plates are meshed as mid-surfaces: make the mid-surface a surface of the \
                         geometry and mesh that (of a solid `gmsh -2` meshes the skin, which is something else)";

fn kind(region: &Region) -> &'static str {
    made_of(region.dimension)
}

impl Regions {
    /// Adds the case's points to `mesh` as regions of one point.
    pub fn new(mut mesh: Arc<Mesh>, case: &Case) -> Self {
        for (name, position) in &case.point {
            let mesh = Arc::make_mut(&mut mesh);
            mesh.nodes.push(*position);
            mesh.elements.push(Cell::point(mesh.nodes.len() - 1));
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
    /// A fault with the regions that the mesh has; a name of several regions.
    pub fn region(&self, name: &str, place: &str) -> Result<&Region> {
        let same: Vec<&str> = self.mesh.regions.iter().filter(|r| r.name == name).map(kind).collect();
        if same.len() > 1 {
            let found = format!("\"{name}\", the name of {} regions: {}", same.len(), same.join(", "));
            let fault = Fault::new(place, found, "a name of one region alone");
            return Err(Error::input(
                fault.with_help("Rename one of them: a physical group in the mesh, or a [point] of the case"),
            ));
        }
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
        for name in case.point.keys() {
            let mut regions = self.mesh.regions.iter().filter(|region| region.name == *name);
            if let Some(region) = regions.next().filter(|_| regions.next().is_some()) {
                let found = format!("the name of a region of {} of {}, too", kind(region), self.name);
                let place = format!("`point.{}`", dotted(name));
                faults.push(Fault::new(place, found, "a name that no region of the mesh has"));
            }
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

    /// The region `name`, which must have `dimension`.
    fn region_of(&self, name: &str, dimension: usize, place: &str) -> Result<&Region> {
        let region = self.region(name, place)?;
        if region.dimension == dimension {
            return Ok(region);
        }
        let found = format!("region \"{name}\" of {}", kind(region));
        let fault = Fault::new(place, found, format!("a region of {}", made_of(dimension)));
        Err(Error::input(fault.with_help(if region.dimension == 3 { NOT_SOLID } else { "" })))
    }

    /// The cells of a region.
    pub fn cells(&self, region: &Region) -> Vec<Cell> {
        region.elements.iter().map(|e| self.mesh.elements[*e].clone()).collect()
    }

    /// The solids of region `name`; kinds that lock only where that is allowed.
    pub fn solids(&self, name: &str, allow_locking: bool, place: &str) -> Result<Vec<Cell>> {
        let region = self.region_of(name, 3, place)?;
        let locks =
            |kind: CellKind| matches!(kind, CellKind::Tetrahedron4 | CellKind::Pyramid5 | CellKind::Wedge6);
        let mut stiff = region.elements.iter().filter(|e| locks(self.mesh.elements[**e].kind()));
        if let Some(first) = stiff.next().filter(|_| !allow_locking) {
            let found = format!(
                "region \"{name}\" with {} elements that are far too stiff in bending (locking), the first element {}, a {}",
                1 + stiff.count(),
                self.mesh.element_place(*first),
                self.mesh.elements[*first].kind().table().name
            );
            let fault = Fault::new(place, found, "solids of second order, or 8-node hexahedra");
            let help = "Mesh with second order: `gmsh -3 -order 2 model.geo -o model.msh`; `allow_locking = true` takes these";
            return Err(Error::input(fault.with_help(help)));
        }
        Ok(self.cells(region))
    }

    /// The elements of region `name`, which must have `dimension` and be of first order.
    pub fn elements(&self, name: &str, dimension: usize, place: &str) -> Result<Vec<Cell>> {
        let region = self.region_of(name, dimension, place)?;
        let higher = region.elements.iter().filter(|e| !self.mesh.elements[**e].kind().is_first_order());
        if let Some(first) = higher.clone().next() {
            let found = format!(
                "region \"{name}\" with {} elements of second order, the first element {}, a {}",
                higher.count(),
                self.mesh.element_place(*first),
                self.mesh.elements[*first].kind().table().name
            );
            let fault = Fault::new(place, found, format!("{} of first order", made_of(dimension)));
            let help = "Mesh again with first order: `gmsh -2 -order 1 model.geo -o model.msh`";
            return Err(Error::input(fault.with_help(help)));
        }
        Ok(self.cells(region))
    }
}

#[cfg(test)]
mod tests {
    use crate::case::Case;
    use crate::job::Prepared;

    /// Two regions of one name, of all kinds, in either order: a fault where the case names it, and none where it does not.
    #[test]
    fn a_name_of_two_regions_is_a_fault_whatever_their_order() {
        let groups = [("0 15 2 1 1 1", 0), ("0 1 2 2 1 1 2", 1), ("0 2 2 3 1 1 2 3", 2)];
        let dir = tempfile::tempdir().unwrap();
        for (first, second) in [(0, 1), (1, 0), (0, 2), (2, 0), (1, 2), (2, 1)] {
            let lines: Vec<String> = [first, second]
                .iter()
                .enumerate()
                .map(|(k, g)| groups[*g].0.replacen('0', &format!("{}", k + 2), 1))
                .collect();
            let names = [first, second].map(|g| format!("{} {} \"twice\"\n", groups[g].1, g + 1)).concat();
            let mesh = format!(
                "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n2 9 \"plate\"\n{names}$EndPhysicalNames\n\
                 $Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n$Elements\n3\n1 2 2 9 1 1 2 3\n{}\n{}\n$EndElements\n",
                lines[0], lines[1]
            );
            std::fs::write(dir.path().join("a.msh"), mesh).unwrap();
            let prepare = |on: &str, point: &str| {
                let text = format!(
                    "{point}[mesh]\nfile = \"a.msh\"\nunit = \"m\"\n[material.steel]\nyoungs_modulus = 2e11\n\
                     poissons_ratio = 0.3\ndensity = 8000\n[shell.plate]\nmaterial = \"steel\"\nthickness = 0.01\n\
                     [support.s]\non = \"{on}\"\nheld = [\"ux\"]\n[modes.all]\ncount = 1\n"
                );
                let case = Case::parse("a.toml", &text, dir.path().into()).unwrap();
                Prepared::new(&case).map(drop).map_err(|error| error.to_string())
            };
            let text = prepare("twice", "").unwrap_err();
            assert!(text.contains("`support.s.on`") && text.contains("the name of 2 regions"), "{text}");
            prepare("plate", "").unwrap();
            let text = prepare("plate", "[point]\nplate = [0, 0, 0]\n").unwrap_err();
            assert!(text.contains("`point.plate`") && text.contains("faces"), "{text}");
        }
    }
}
