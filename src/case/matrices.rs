//! `[matrices]`: M, C and K from another program.

use super::expression::{Dual, evaluate, is_name};
use super::keys::keys_of;
use super::read::collect;
use super::reader::Section;
use super::units::{NUMBER, parse_quantity};
use serde::Serialize;
use std::collections::BTreeMap;

/// M, C and K from MatrixMarket files (paths relative to the case file).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Matrices {
    /// M \[kg, kg m²\].
    pub mass: String,
    /// K \[N/m, N m\]; an imaginary part is hysteretic damping.
    pub stiffness: String,
    /// C \[N s/m, N m s\]; none when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damping: Option<String>,
    /// External force f \[N, N m\], a matrix of one column; none when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load: Option<String>,
    /// A table (CSV) of what each row is: `node`, its motion `ux` … `rz`, and the node's coordinates `x`, `y`, `z`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dofs: Option<String>,
    /// Scalars that the factors are expressions of, such as a speed, by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub scalar: BTreeMap<String, f64>,
    /// What is added to them, by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub term: BTreeMap<String, MatrixTerm>,
}

/// The factor a of a term.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Factor {
    /// A scalar of the case.
    Number(f64),
    /// An expression of the scalars of `[matrices.scalar]`, such as `omega^2 - 1` ([`evaluate`]).
    Expression(String),
}

impl Matrices {
    /// The value of a factor; NaN of one that the case refuses.
    pub fn value(&self, factor: &Factor) -> f64 {
        match factor {
            Factor::Number(value) => *value,
            Factor::Expression(text) => evaluate(text, &self.scalar, "").map_or(f64::NAN, |dual| dual.value),
        }
    }

    /// The derivatives of all factors by the scalar at a path of the case, by term; none when it is no scalar of theirs.
    pub fn slopes(&self, path: &str) -> Option<BTreeMap<&str, f64>> {
        let keys = keys_of(path);
        let keys: Vec<&str> = keys.iter().map(String::as_str).collect();
        match keys[..] {
            ["matrices", "term", name, "factor"] => {
                self.term.get_key_value(name).map(|(name, _)| [(name.as_str(), 1.0)].into())
            }
            ["matrices", "scalar", by] => {
                let slope = |factor: &Factor| match factor {
                    Factor::Number(_) => 0.0,
                    Factor::Expression(text) => {
                        evaluate(text, &self.scalar, by).map_or(0.0, |dual: Dual| dual.slope)
                    }
                };
                let all = self.term.iter().map(|(name, term)| (name.as_str(), slope(&term.factor)));
                Some(all.filter(|(_, slope)| *slope != 0.0).collect())
            }
            _ => None,
        }
    }
}

/// Matrices that are added with a common factor, a scalar of the case: M + a M₁, C + a C₁, K + a K₁. So a friction
/// coefficient or a speed can be varied in a model that another program exported.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MatrixTerm {
    /// a.
    pub factor: Factor,
    /// M₁.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass: Option<String>,
    /// C₁.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damping: Option<String>,
    /// K₁.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<String>,
}

pub(super) fn read(s: &Section) -> Matrices {
    const FILE: &str = "the path of a MatrixMarket file";
    let scalar = s.section("scalar", |all| {
        let mut scalars = BTreeMap::new();
        for name in all.names() {
            if !is_name(&name) {
                all.fault(&name, "a name", "letters, digits and _, not a digit first", "");
            }
            scalars.insert(name.clone(), all.quantity(&name, NUMBER).required("a number"));
        }
        scalars
    });
    let scalar = scalar.unwrap_or_default();
    let term = |t: &Section| {
        let term = MatrixTerm {
            factor: read_factor(t, &scalar),
            mass: t.string("mass").optional(),
            damping: t.string("damping").optional(),
            stiffness: t.string("stiffness").optional(),
        };
        if [&term.mass, &term.damping, &term.stiffness].iter().all(|file| file.is_none()) {
            t.fault("stiffness", "no matrix", "`mass`, `damping` or `stiffness`", "");
        }
        term
    };
    Matrices {
        mass: s.string("mass").required(FILE),
        stiffness: s.string("stiffness").required(FILE),
        damping: s.string("damping").optional(),
        load: s.string("load").optional(),
        dofs: s.string("dofs").optional(),
        term: collect(s, "term", term),
        scalar,
    }
}

/// A number, or a text that is no number: an expression.
fn read_factor(t: &Section, scalar: &BTreeMap<String, f64>) -> Factor {
    const EXPECTED: &str = "a number, or an expression such as \"omega^2 - 1\"";
    let expression = t.is_string("factor").then(|| t.string("factor").optional()).flatten();
    match expression.filter(|text| parse_quantity(text, NUMBER).is_err()) {
        None => Factor::Number(t.quantity("factor", NUMBER).required(EXPECTED)),
        Some(text) => {
            if let Err((found, expected)) = evaluate(&text, scalar, "") {
                t.fault("factor", found, expected, "");
            }
            Factor::Expression(text)
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::case::Case;

    fn case(factor: &str, scalar: &str) -> crate::error::Result<Case> {
        let text = format!(
            "[matrices]\nmass = \"m\"\nstiffness = \"k\"\n{scalar}\n[matrices.term.spin]\nfactor = {factor}\ndamping = \"g\"\n"
        );
        Case::parse("case", &text, ".".into())
    }

    #[test]
    fn factors_follow_the_scalars_of_the_case() {
        let spun = case("\"1/omega - 1\"", "[matrices.scalar]\nomega = 2.0").unwrap();
        let matrices = spun.matrices.as_ref().unwrap();
        assert_eq!(matrices.value(&matrices.term["spin"].factor), -0.5);
        assert_eq!(matrices.slopes("matrices.scalar.omega").unwrap()["spin"], -0.25);
        assert_eq!(spun.parameter("matrices.scalar.omega").unwrap().value, 2.0);
        let faster = spun.with_parameter("matrices.scalar.omega", 4.0).unwrap();
        let matrices = faster.matrices.unwrap();
        assert_eq!(matrices.value(&matrices.term["spin"].factor), -0.75);
        let refused = spun.with_parameter("matrices.scalar.omega", 0.0).unwrap_err().to_string();
        assert!(
            refused.contains("matrices.term.spin.factor") && refused.contains("division by zero"),
            "{refused}"
        );
        for number in ["0.5", "\"0.5\""] {
            let plain = case(number, "").unwrap();
            assert_eq!(plain.parameter("matrices.term.spin.factor").unwrap().value, 0.5);
            assert_eq!(plain.matrices.unwrap().slopes("matrices.term.spin.factor").unwrap()["spin"], 1.0);
        }
    }

    #[test]
    fn expressions_without_a_value_are_faults_with_their_key() {
        for (factor, scalar, part) in [
            ("\"omga\"", "[matrices.scalar]\nomega = 1", "\"omga\""),
            ("\"omega\"", "", "no [matrices.scalar]"),
            ("\"1e400 * omega\"", "[matrices.scalar]\nomega = 1", "inf"),
            ("\"omega\"", "[matrices.scalar]\n\"a.b\" = 1\nomega = 1", "letters, digits"),
            ("\"(\"", "", "its end"),
            ("true", "", "matrices.term.spin.factor"),
        ] {
            let refused = case(factor, scalar).unwrap_err();
            let text = refused.to_string();
            assert!(refused.exit_code() == 2 && text.contains(part), "{factor}: {text}");
        }
    }
}
