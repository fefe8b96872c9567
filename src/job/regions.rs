//! The mesh of a case with the case's own points, and its regions by name.

use crate::case::Case;
use crate::error::{Error, Fault, Result, nearest};
use crate::mesh::{Element, Mesh, Region};

/// A mesh whose regions are asked for by name, with a fault that lists those there are.
#[derive(Debug, Clone)]
pub struct Regions {
    /// The mesh, in metres.
    pub mesh: Mesh,
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
        Regions { mesh }
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
                Fault::new(place, format!("\"{name}\""), format!("a region of the mesh ({known})"))
                    .with_help(help),
            )
        })
    }

    /// The nodes of region `name`, ascending.
    pub fn nodes(&self, name: &str, place: &str) -> Result<Vec<usize>> {
        Ok(self.mesh.region_nodes(self.region(name, place)?))
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
