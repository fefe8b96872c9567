//! The sections of a case that are its structure: the only place that lists them all.

use super::Case;
use std::collections::BTreeMap;

/// The tables of parts.
pub(super) const PARTS: [&str; 3] = ["shell", "bar", "solid"];

impl Case {
    /// The parts: table, name and material of each.
    pub(super) fn parts(&self) -> impl Iterator<Item = (&'static str, &str, &str)> {
        let [shell, bar, solid] = PARTS;
        let shells = self.shell.iter().map(move |(name, own)| (shell, name, &own.material));
        let bars = self.bar.iter().map(move |(name, own)| (bar, name, &own.material));
        let solids = self.solid.iter().map(move |(name, own)| (solid, name, &own.material));
        shells
            .chain(bars)
            .chain(solids)
            .map(|(kind, name, material)| (kind, name.as_str(), material.as_str()))
    }

    /// The sections of the structure, and whether the case has them.
    pub(super) fn structure(&self) -> [(&'static str, bool); 15] {
        [
            ("mesh", self.mesh.is_some()),
            ("point", !self.point.is_empty()),
            ("material", !self.material.is_empty()),
            ("shell", !self.shell.is_empty()),
            ("bar", !self.bar.is_empty()),
            ("solid", !self.solid.is_empty()),
            ("mass", !self.mass.is_empty()),
            ("spring", !self.spring.is_empty()),
            ("rigid", !self.rigid.is_empty()),
            ("averaging", !self.averaging.is_empty()),
            ("tie", !self.tie.is_empty()),
            ("equation", !self.equation.is_empty()),
            ("support", !self.support.is_empty()),
            ("rotation", !self.rotation.is_empty()),
            ("force", !self.force.is_empty()),
        ]
    }

    /// The same case without them.
    pub(crate) fn without_structure(&self) -> Case {
        Case {
            mesh: None,
            point: BTreeMap::new(),
            material: BTreeMap::new(),
            shell: BTreeMap::new(),
            bar: BTreeMap::new(),
            solid: BTreeMap::new(),
            mass: BTreeMap::new(),
            spring: BTreeMap::new(),
            rigid: BTreeMap::new(),
            averaging: BTreeMap::new(),
            tie: BTreeMap::new(),
            equation: BTreeMap::new(),
            support: BTreeMap::new(),
            rotation: BTreeMap::new(),
            force: BTreeMap::new(),
            ..self.clone()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Case;
    use std::path::PathBuf;

    /// A case of every section of the structure has none of them when it is to stand on matrices.
    #[test]
    fn nothing_of_the_structure_is_left() {
        let text = "point.tip = [1, 0, 0]\n[mesh]\nfile = \"a.msh\"\nunit = \"m\"\n\
                    [material.steel]\nyoungs_modulus = 2e11\npoissons_ratio = 0.3\ndensity = 7850\n\
                    [shell.a]\nmaterial = \"steel\"\nthickness = 0.001\n\
                    [bar.b]\nmaterial = \"steel\"\ndiameter = 0.01\n[solid.c]\nmaterial = \"steel\"\n\
                    [mass.m]\non = \"tip\"\nmass = 1\n[spring.s]\non = \"tip\"\nstiffness = 1\ndirection = [1, 0, 0]\n\
                    [rigid.r]\nmaster = \"tip\"\nfollow = [\"a\"]\n[averaging.v]\npoint = \"tip\"\nof = [\"c\"]\n\
                    [tie.t]\non = \"a\"\nto = \"c\"\n[equation.e]\nfile = \"e.csv\"\n[support.u]\non = \"b\"\n\
                    [rotation.o]\nparts = [\"c\"]\nspeed = 1\n[force.f]\non = \"tip\"\nforce = [1, 0, 0]\n";
        let case = Case::parse("case.toml", text, PathBuf::new()).unwrap();
        let there = |case: &Case| case.structure().iter().filter(|(_, there)| *there).count();
        assert_eq!((there(&case), there(&case.without_structure())), (15, 0));
    }
}
