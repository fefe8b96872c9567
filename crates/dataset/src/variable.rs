//! A quantity with a name, a unit, a sentence, dimensions and values.

use num_complex::Complex64 as c64;
use std::borrow::Cow;
use std::fmt;

/// A quantity.
#[derive(Debug)]
pub struct Variable<'a> {
    /// Its name in every file.
    pub key: Cow<'a, str>,
    /// Its unit, `1` of a pure number, `text` of words.
    pub unit: Cow<'a, str>,
    /// One sentence: what it is, with its symbol.
    pub description: Cow<'static, str>,
    /// Its dimensions; none of a single value. The last runs fastest.
    pub dimensions: Vec<Dimension>,
    /// As many as the lengths of the dimensions multiply to.
    pub values: Values<'a>,
    /// How tables for people show it, if they do.
    pub shown: Option<Shown>,
}

/// A column of a table for people.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Shown {
    /// The words above it.
    pub heading: &'static str,
    /// The values, rounded.
    pub cells: Vec<String>,
    /// Whether they are words, set left.
    pub words: bool,
    /// Whether it proves the other columns (an error, a condition number) and stands in a table of its own.
    pub proof: bool,
}

/// A dimension of a [`Variable`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Dimension {
    /// Its name.
    pub name: &'static str,
    /// Number of values along it.
    pub length: usize,
    /// The values of its coordinate.
    pub labels: Labels,
}

/// The coordinate of a [`Dimension`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Labels {
    /// Whole numbers from this one on.
    From(i64),
    /// Names.
    Names(&'static [&'static str]),
    /// The variable of the group that has the name of the dimension.
    Variable,
}

impl Dimension {
    /// Counted from 1.
    pub fn numbered(name: &'static str, length: usize) -> Self {
        Dimension { name, length, labels: Labels::From(1) }
    }

    /// Indices, from 0, as those of nodes.
    pub fn indexed(name: &'static str, length: usize) -> Self {
        Dimension { name, length, labels: Labels::From(0) }
    }

    /// Names.
    pub fn named(name: &'static str, names: &'static [&'static str]) -> Self {
        Dimension { name, length: names.len(), labels: Labels::Names(names) }
    }

    /// With the values of the variable that has its name.
    pub fn of_variable(name: &'static str, length: usize) -> Self {
        Dimension { name, length, labels: Labels::Variable }
    }

    /// x, y, z.
    pub fn axes() -> Self {
        Self::named("axis", &["x", "y", "z"])
    }

    /// Displacements and rotations of a node.
    pub fn freedoms() -> Self {
        Self::named("freedom", &["ux", "uy", "uz", "rx", "ry", "rz"])
    }

    /// The lower and the upper limit of a range.
    pub fn limits() -> Self {
        Self::named("limit", &["lower", "upper"])
    }

    /// The coordinate, for a group that has no variable of this name.
    pub fn coordinate(&self) -> Variable<'static> {
        let n = self.length;
        let (unit, values) = match self.labels {
            Labels::From(first) => ("1", Values::Integers((first..first + n as i64).collect())),
            Labels::Names(names) => {
                ("text", Values::Texts(names.iter().map(|name| Some((*name).to_string())).collect()))
            }
            Labels::Variable => ("1", Values::Integers((0..n as i64).collect())),
        };
        let description = match self.labels {
            Labels::From(0) => "index, from 0",
            Labels::From(_) => "number, from 1",
            Labels::Names(_) | Labels::Variable => "the parts of each value",
        };
        Variable::new(self.name, unit, description, vec![self.clone()], values)
    }
}

/// Values, row after row.
pub enum Values<'a> {
    /// Yes or no.
    Flags(Vec<bool>),
    /// Whole numbers.
    Integers(Vec<i64>),
    /// Whole numbers that may be missing.
    Sparse(Vec<Option<i64>>),
    /// Numbers, NaN where there is none.
    Reals(Vec<f64>),
    /// Complex numbers.
    Complexes(Vec<c64>),
    /// Words.
    Texts(Vec<Option<String>>),
    /// Numbers that are worked out when they are written: those of one index of the first dimension at a time.
    RealRows(Box<dyn Fn(usize) -> Vec<f64> + 'a>),
    /// The same of complex numbers.
    ComplexRows(Box<dyn Fn(usize) -> Vec<c64> + 'a>),
}

/// The type of values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// [`Values::Flags`].
    Flag,
    /// [`Values::Integers`].
    Integer,
    /// [`Values::Sparse`].
    Sparse,
    /// [`Values::Reals`].
    Real,
    /// [`Values::Complexes`].
    Complex,
    /// [`Values::Texts`].
    Text,
}

impl fmt::Debug for Values<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Values::Flags(v) => v.fmt(f),
            Values::Integers(v) => v.fmt(f),
            Values::Sparse(v) => v.fmt(f),
            Values::Reals(v) => v.fmt(f),
            Values::Complexes(v) => v.fmt(f),
            Values::Texts(v) => v.fmt(f),
            Values::RealRows(_) | Values::ComplexRows(_) => f.write_str("rows"),
        }
    }
}

impl Values<'_> {
    /// Whether these are fields that are only worked out when they are written, to HDF5.
    pub fn are_worked_out(&self) -> bool {
        matches!(self, Values::RealRows(_) | Values::ComplexRows(_))
    }

    /// No values of a kind.
    pub fn empty(kind: Kind) -> Self {
        match kind {
            Kind::Flag => Values::Flags(Vec::new()),
            Kind::Integer => Values::Integers(Vec::new()),
            Kind::Sparse => Values::Sparse(Vec::new()),
            Kind::Real => Values::Reals(Vec::new()),
            Kind::Complex => Values::Complexes(Vec::new()),
            Kind::Text => Values::Texts(Vec::new()),
        }
    }
}

impl<'a> Variable<'a> {
    /// A quantity with these values.
    pub fn new(
        key: impl Into<Cow<'a, str>>,
        unit: impl Into<Cow<'a, str>>,
        description: impl Into<Cow<'static, str>>,
        dimensions: Vec<Dimension>,
        values: Values<'a>,
    ) -> Self {
        let unit = unit.into();
        let unit = if unit.is_empty() { "1".into() } else { unit };
        Variable { key: key.into(), unit, description: description.into(), dimensions, values, shown: None }
    }

    /// Numbers.
    pub fn reals(
        key: impl Into<Cow<'a, str>>,
        unit: impl Into<Cow<'a, str>>,
        description: impl Into<Cow<'static, str>>,
        dimensions: Vec<Dimension>,
        values: Vec<f64>,
    ) -> Self {
        Self::new(key, unit, description, dimensions, Values::Reals(values))
    }

    /// Words.
    pub fn texts(
        key: impl Into<Cow<'a, str>>,
        description: impl Into<Cow<'static, str>>,
        dimension: Dimension,
        values: Vec<String>,
    ) -> Self {
        let values = Values::Texts(values.into_iter().map(Some).collect());
        Self::new(key, "text", description, vec![dimension], values)
    }

    /// A single text.
    pub fn text(key: impl Into<Cow<'a, str>>, description: impl Into<Cow<'static, str>>, text: &str) -> Self {
        Self::new(key, "text", description, Vec::new(), Values::Texts(vec![Some(text.into())]))
    }

    /// The lengths of the dimensions.
    pub fn shape(&self) -> Vec<usize> {
        self.dimensions.iter().map(|d| d.length).collect()
    }

    /// How many values belong to one index of the first dimension.
    pub fn width(&self) -> usize {
        self.dimensions.iter().skip(1).map(|d| d.length).product()
    }

    /// The name of a column: the key with the unit, where that says more.
    pub fn title(&self) -> String {
        const SUFFIXES: [(&str, &str); 10] = [
            ("_hz", "Hz"),
            ("_percent", "%"),
            ("_n", "N"),
            ("_m", "m"),
            ("_kg", "kg"),
            ("_s", "s"),
            ("_w", "W"),
            ("_pa", "Pa"),
            ("_j", "J"),
            ("_db", "dB"),
        ];
        let named = SUFFIXES.iter().any(|(suffix, unit)| self.key.ends_with(suffix) && self.unit == *unit);
        if named || ["1", "text", "unit"].contains(&&*self.unit) {
            self.key.to_string()
        } else {
            format!("{} [{}]", self.key, self.unit)
        }
    }
}
