//! Groups and tables as JSON.

use super::variable::{Labels, Values, Variable};
use super::{Entry, Group, Table};
use serde_json::{Map, Value, json};

impl Group<'_> {
    /// The group as a JSON object. Numbers that are not finite and what is missing are `null`.
    pub fn to_json(&self) -> Value {
        let mut object = Map::new();
        for entry in &self.entries {
            match entry {
                Entry::Variable(variable) if variable.values.are_worked_out() => {}
                Entry::Variable(variable) => {
                    object.insert(variable.key.to_string(), variable.to_json());
                }
                Entry::Group(group) => {
                    object.insert(group.key.to_string(), group.to_json());
                }
                Entry::Table(table) if table.json => {
                    object.insert(table.key.to_string(), Value::Array(table.to_json()));
                }
                Entry::Table(_) => {}
                Entry::List(key, groups) => {
                    let member = |group: &Group| {
                        let mut value = json!({ "name": group.key });
                        if let (Some(object), Value::Object(more)) = (value.as_object_mut(), group.to_json())
                        {
                            object.extend(more);
                        }
                        value
                    };
                    object.insert((*key).into(), groups.iter().map(member).collect());
                }
                Entry::Parts(key, by, tables) => {
                    let rows = tables.iter().flat_map(|table| {
                        let named = |row: Value| {
                            let mut first = json!({ *by: table.key });
                            if let (Some(object), Value::Object(more)) = (first.as_object_mut(), row) {
                                object.extend(more);
                            }
                            first
                        };
                        table.to_json().into_iter().map(named)
                    });
                    object.insert((*key).into(), rows.collect());
                }
                Entry::Absent(key) => {
                    object.insert((*key).into(), Value::Null);
                }
            }
        }
        Value::Object(object)
    }
}

impl Table<'_> {
    /// The rows as JSON objects, each with its number first.
    fn to_json(&self) -> Vec<Value> {
        let row = |k: usize| {
            let mut object = Map::new();
            if let Labels::From(first) = self.rows.labels {
                object.insert(self.rows.name.into(), (first + k as i64).into());
            }
            for column in &self.columns {
                let width = column.width();
                let values = (k * width..(k + 1) * width).map(|i| column.values.json(i)).collect::<Vec<_>>();
                object.insert(column.key.to_string(), nested(values, &column.shape()[1..]));
            }
            Value::Object(object)
        };
        (0..self.rows.length).map(row).collect()
    }
}

impl Variable<'_> {
    fn to_json(&self) -> Value {
        let shape = self.shape();
        let values: Vec<Value> = (0..shape.iter().product()).map(|i| self.values.json(i)).collect();
        nested(values, &shape)
    }
}

impl Values<'_> {
    /// Value number `i`.
    fn json(&self, i: usize) -> Value {
        match self {
            Values::Flags(all) => all[i].into(),
            Values::Integers(all) => all[i].into(),
            Values::Sparse(all) => all[i].into(),
            Values::Reals(all) => all[i].into(),
            Values::Complexes(all) => json!({ "re": all[i].re, "im": all[i].im }),
            Values::Texts(all) => all[i].clone().into(),
            Values::RealRows(_) | Values::ComplexRows(_) => Value::Null,
        }
    }
}

/// Values as lists of lists; a single one without dimensions as itself.
fn nested(mut values: Vec<Value>, shape: &[usize]) -> Value {
    match shape {
        [] => values.pop().unwrap_or(Value::Null),
        [_] => Value::Array(values),
        [first, rest @ ..] => {
            let width: usize = rest.iter().product();
            (0..*first).map(|k| nested(values[k * width..(k + 1) * width].to_vec(), rest)).collect()
        }
    }
}
