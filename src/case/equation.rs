//! `[equation.NAME]`: linear constraints between degrees of freedom.

use super::model::DOF_NAMES;
use crate::schema::units::NUMBER;
use crate::schema::{key, variants};

/// What the list `component` has.
const COMPONENTS: &str = "a list of ux, uy, uz, rx, ry, rz, one for each of `on`";

variants! {
    /// Linear constraints, a₁ u₁ + a₂ u₂ + … = 0, whose first degree of freedom follows the others: u₁ = −(a₂ u₂ + …)/a₁. One of the
    /// regions in the case, or many in a file.
    pub enum Equation by presence {
        /// The terms in the case.
        Terms "on" {
            /// The region of each term, of one point, the first of the one that follows. The first may have more nodes: each follows
            /// in an equation of its own; terms of that same region are at the same node.
            on: Vec<String> = key::names("regions, one for each term").not_empty(),
            /// The component of each term: ux, uy, uz, rx, ry or rz.
            component: Vec<String> = {
                let count = on.len();
                key::names(COMPONENTS)
                    .check(COMPONENTS, |list| list.iter().all(|name| DOF_NAMES.contains(&name.as_str())))
                    .check(COMPONENTS, move |list| count == 0 || list.len() == count)
            },
            /// The factor a of each term, the first not zero; of rotations beside displacements in m.
            factor: Vec<f64> = {
                let count = on.len();
                key::quantity_list(NUMBER)
                    .check("one factor for each of `on`", move |list| count == 0 || list.len() == count)
                    .check("a first factor that is not zero", |list| list.first().is_none_or(|a| *a != 0.0))
            },
        }
        /// The terms in a file.
        File "file" {
            /// A table (CSV, relative to the case file), a row a term: `equation`, a number or name that rows of one equation share,
            /// `node`, its number in the file of the mesh or the name of a region of one point, `component`, ux to rz, and `factor`, a.
            file: String = key::name("the path of a table (CSV)"),
        }
    }
}
