//! Orders of the nodes of a cell in the files of other programs, and their numbers and names of kinds.

/// The place of each node of a cell in a file: at place k stands node `order[k]`.
///
/// A node that stands at several places is where nodes of a brick or a quadrilateral fall together (a *degenerate* or *collapsed* element);
/// nodes of the middles of faces and cells may be left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Order(pub(super) &'static [u8]);

/// A kind in files that number their kinds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NumberedKind {
    /// Its number.
    pub number: u8,
    /// Its nodes.
    pub order: Order,
}

/// A kind in files that name their elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NamedKind {
    names: &'static str,
    /// Its nodes.
    pub order: Order,
    /// The program's number of each side, in the order of [`super::CellTable::sides`]: faces S1 … or edges E1 … of Abaqus, face numbers
    /// of pressures of ANSYS; empty for NASTRAN, whose faces are known by corners ([`super::CellKind::side_of_corners`]).
    pub sides: &'static [u8],
}

const OWN: &[u8] =
    &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26];

/// The order of the table itself, of n nodes.
pub(super) const fn own(n: usize) -> Order {
    Order(OWN.split_at(n).0)
}

pub(super) const fn numbered(number: u8, order: Order) -> NumberedKind {
    NumberedKind { number, order }
}

/// `names` are separated by blanks.
pub(super) const fn named(names: &'static str, order: Order, sides: &'static [u8]) -> NamedKind {
    NamedKind { names, order, sides }
}

impl Order {
    /// The nodes of a cell as a file has them.
    pub fn to_file<T: Copy>(self, nodes: &[T]) -> Vec<T> {
        self.0.iter().map(|node| nodes[usize::from(*node)]).collect()
    }

    /// The nodes of a cell that stand in a file so; `None` where there are more or fewer, or where nodes differ that should be one.
    pub fn from_file<T: Copy + PartialEq>(self, file: &[T]) -> Option<Vec<T>> {
        if file.len() != self.0.len() {
            return None;
        }
        let most = self.0.iter().max().map_or(0, |node| usize::from(*node) + 1);
        let place = |node: usize| self.0.iter().position(|k| usize::from(*k) == node);
        let nodes = (0..most).map(|node| Some(file[place(node)?])).collect::<Option<Vec<T>>>()?;
        self.0.iter().zip(file).all(|(node, found)| nodes[usize::from(*node)] == *found).then_some(nodes)
    }
}

impl NamedKind {
    /// Its names: elements of other formulations that have the same nodes.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        self.names.split_whitespace()
    }
}
