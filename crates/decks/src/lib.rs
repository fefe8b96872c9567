//! Finite-element models of other programs as one description, [`Deck`].
//!
//! * [`read`]: reads a file by its name; [`read_bytes`] from memory.
//! * [`Deck`]: nodes, elements, sets, materials, constraints, contacts, loads; plain data in the units of the file.
//! * [`write()`]: a deck as a file of Abaqus, CalculiX or NASTRAN.
//! * [`convert`]: a mesh, a case and a page of what was read.
//! * [`Ledger`]: what was read in part, or not at all, with its places.
//!
//! One folder a format; each reads lines with their places into [`Deck`] and knows nothing of a case; `convert` knows nothing of formats.

mod abaqus;
mod ansys;
mod convert;
mod deck;
mod format;
mod ledger;
mod nastran;
mod place;
mod skin;
mod text;
mod turn;
mod universal;
mod vtk;
mod written;

pub use convert::{Converted, Units, convert};
pub use deck::{
    Analysis, Contact, Coupling, CouplingKind, Deck, Elastic, Element, Equation, Frame, Load, LoadOn,
    Material, Motion, Node, Place, PointMass, Profile, Section, SectionShape, Set, ShellFace, Spring,
    Support, Surface, Tie,
};
pub use format::{Format, read, read_bytes, write};
pub use ledger::{Ledger, Unread, Weight};
pub use written::Written;
