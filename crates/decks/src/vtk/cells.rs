//! Nodes and elements of all pieces, and the whole numbers of their cells.

use super::data::{Numbers, Unpacker};
use super::grid::{Array, Grid, Piece, ScalarKind};
use crate::deck::{Deck, Element, Node, Place};
use crate::ledger::Weight;
use crate::text::Files;
use std::collections::BTreeMap;
use stridor_mesh::{Cell, CellKind};

/// Whole numbers of cells: name of the array and the number of each element of the deck that has one.
#[derive(Debug, Default)]
pub(super) struct CellNumbers {
    /// In the order of the file.
    pub arrays: Vec<(String, Vec<(usize, i64)>)>,
    /// Nodes of cells that are points, each with an index of an array and its number there.
    pub points: Vec<(usize, i64, usize)>,
}

/// Reads the pieces.
pub(super) fn read(
    grid: &Grid<'_>,
    unpacker: &mut Unpacker<'_>,
    deck: &mut Deck,
    files: &mut Files,
) -> CellNumbers {
    let mut reader = Cells { unpacker, deck, files, names: BTreeMap::new(), numbers: CellNumbers::default() };
    grid.pieces.iter().for_each(|piece| reader.piece(piece));
    if grid.pieces.iter().filter(|piece| piece.n_cells > 0).count() > 1 {
        let why = "pieces are read side by side: nodes on their borders are not joined";
        reader.deck.ledger.note(Weight::Matters, "pieces", why, grid.pieces[1].place);
    }
    reader.numbers
}

struct Cells<'f, 'g, 'u> {
    unpacker: &'u mut Unpacker<'g>,
    deck: &'f mut Deck,
    files: &'f mut Files,
    /// Index of the name of each type.
    names: BTreeMap<i64, u32>,
    numbers: CellNumbers,
}

/// What the elements of a piece were made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Made {
    Element(usize),
    Point(usize),
    Nothing,
}

impl Cells<'_, '_, '_> {
    fn piece(&mut self, piece: &Piece<'_>) {
        let first = self.deck.nodes.len();
        let named = |name: &str| piece.arrays.iter().find(|array| array.name == name);
        let [connectivity, offsets, types] = ["connectivity", "offsets", "types"].map(named);
        let points =
            piece.arrays.iter().find(|array| !["connectivity", "offsets", "types"].contains(&&*array.name));
        self.points(piece, points);
        let Some((connectivity, (offsets, types))) = self
            .whole(piece, "connectivity", connectivity, None)
            .zip(self.whole(piece, "offsets", offsets, Some(piece.n_cells)).zip(self.whole(
                piece,
                "types",
                types,
                Some(piece.n_cells),
            )))
        else {
            return;
        };
        let place = named("connectivity").map_or(piece.place, |array| array.place);
        let mut begin = 0;
        let mut made = Vec::new();
        for (cell, (end, vtk)) in offsets.into_iter().zip(types).enumerate() {
            let end = usize::try_from(end).unwrap_or(usize::MAX);
            let Some(own) = connectivity.get(begin..end) else {
                let found = format!("cell {cell} of the entries {begin} to {end} of {}", connectivity.len());
                self.files.fault(place, found, "offsets that ascend within the connectivity");
                return;
            };
            begin = end;
            made.push(self.cell(cell, vtk, own, [first, piece.n_points], place));
        }
        piece.cell_data.iter().for_each(|array| self.cell_data(array, &made));
    }

    fn points(&mut self, piece: &Piece<'_>, array: Option<&Array<'_>>) {
        let expected = format!("{} points of three coordinates", piece.n_points);
        let Some(array) = array else {
            if piece.n_points > 0 {
                self.files.fault(piece.place, "no Points", expected);
            }
            return;
        };
        let place = array.place;
        let places = match self.unpacker.numbers(array) {
            Ok(numbers) => numbers.reals(),
            Err(found) => return self.files.fault(place, format!("points: {found}"), expected),
        };
        if Some(places.len()) != piece.n_points.checked_mul(3) {
            return self.files.fault(place, format!("{} coordinates", places.len()), expected);
        }
        if let Some(at) = places.iter().position(|x| !x.is_finite()) {
            let found = format!("the coordinate {} of point {}", places[at], at / 3);
            return self.files.fault(place, found, "finite numbers");
        }
        let first = self.deck.nodes.len();
        let node = |(k, at): (usize, &[f64])| Node {
            number: (first + k + 1) as u64,
            position: [at[0], at[1], at[2]],
            place,
        };
        self.deck.nodes.extend(places.chunks_exact(3).enumerate().map(node));
    }

    /// The whole numbers of an array of the cells.
    fn whole(
        &mut self,
        piece: &Piece<'_>,
        name: &str,
        array: Option<&Array<'_>>,
        count: Option<usize>,
    ) -> Option<Vec<i64>> {
        let expected = match count {
            Some(count) => format!("{count} whole numbers, one for each cell"),
            None => "whole numbers, the points of each cell".to_string(),
        };
        let Some(array) = array else {
            if piece.n_cells > 0 {
                self.files.fault(piece.place, format!("no array `{name}` of the cells"), expected);
            }
            return None;
        };
        let found = match self.unpacker.numbers(array) {
            Ok(Numbers::Whole(all)) if count.is_none_or(|count| count == all.len()) => return Some(all),
            Ok(Numbers::Whole(all)) => format!("{} numbers in `{name}`", all.len()),
            Ok(Numbers::Real(_)) => format!("real numbers in `{name}`"),
            Err(found) => format!("`{name}`: {found}"),
        };
        self.files.fault(array.place, found, expected);
        None
    }

    /// A cell of the points `first` to `first + count`.
    fn cell(&mut self, cell: usize, vtk: i64, own: &[i64], [first, count]: [usize; 2], place: Place) -> Made {
        let node = |point: &i64| {
            usize::try_from(*point).ok().filter(|point| *point < count).map(|point| first + point)
        };
        let Some(nodes) = own.iter().map(node).collect::<Option<Vec<usize>>>() else {
            let point = own.iter().find(|point| node(point).is_none()).unwrap_or(&0);
            let found = format!("cell {cell} on point {point}, which is not there");
            self.files.fault(place, found, format!("points 0 to {}", count.saturating_sub(1)));
            return Made::Nothing;
        };
        let Some((kind, _)) = CellKind::of_vtk(vtk) else {
            let what = format!("cells of VTK's type {vtk}");
            self.deck.ledger.note(Weight::Matters, what, "cells of this type are not read", place);
            return Made::Nothing;
        };
        // Points whose coordinates are no numbers are faults.
        let at = |node: usize| self.deck.nodes.get(node).map_or([0.0; 3], |node| node.position);
        let Some(cell) = Cell::from_vtk(vtk, &nodes, at) else {
            let found = format!("cell {cell} of {} points", nodes.len());
            self.files.fault(place, found, format!("{} of a {}", kind.n_nodes(), kind.table().name));
            return Made::Nothing;
        };
        let nodes = cell.nodes().to_vec();
        if kind.dimension() == 0 {
            return Made::Point(nodes[0]);
        }
        let deck = &mut *self.deck;
        let type_name = *self.names.entry(vtk).or_insert_with(|| {
            deck.type_names.push(format!("VTK's type {vtk}, {}", kind.table().name));
            deck.type_names.len() as u32 - 1
        });
        let number = deck.elements.len() as u64 + 1;
        deck.elements.push(Element { number, kind, type_name, nodes, place });
        Made::Element(deck.elements.len() - 1)
    }

    /// Whole numbers of the cells; others are noted.
    fn cell_data(&mut self, array: &Array<'_>, made: &[Made]) {
        let Array { name, place, .. } = array;
        let whole =
            array.scalar.is_some_and(|scalar| scalar.kind != ScalarKind::Real) && array.components == 1;
        if !whole {
            let why = "only whole numbers, one a cell, are parts and sets";
            self.deck.ledger.note(Weight::Nothing, format!("CellData {name}"), why, *place);
            return;
        }
        let expected = format!("{} whole numbers, one for each cell", made.len());
        let found = match self.unpacker.numbers(array) {
            Ok(Numbers::Whole(all)) if all.len() == made.len() => all,
            Ok(Numbers::Whole(all)) => {
                return self.files.fault(*place, format!("{} numbers in `{name}`", all.len()), expected);
            }
            Ok(Numbers::Real(_)) => return,
            Err(found) => return self.files.fault(*place, format!("`{name}`: {found}"), expected),
        };
        let arrays = &mut self.numbers.arrays;
        let known = arrays.iter().position(|(own, _)| own == name).unwrap_or_else(|| {
            arrays.push((name.clone(), Vec::new()));
            arrays.len() - 1
        });
        for (made, number) in made.iter().zip(found) {
            match made {
                Made::Element(element) => arrays[known].1.push((*element, number)),
                Made::Point(node) => self.numbers.points.push((known, number, *node)),
                Made::Nothing => {}
            }
        }
    }
}
