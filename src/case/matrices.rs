//! `[matrices]`: M, C and K from another program.

use super::expression::{Dual, evaluate, is_name};
use crate::schema::units::{NUMBER, parse_quantity};
use crate::schema::{Blank, Form, Report, Units, Value, declare, dotted, key, keys_of};
use std::collections::BTreeMap;
use toml::de::DeValue;

/// Expected value of a key that names a file of a matrix.
const FILE: &str = "the path of a file with a matrix";

declare! {
    /// M, C and K from files (paths relative to the case file): MatrixMarket, `.mtx` of Abaqus, DMIG or OUTPUT4 of NASTRAN.
    pub struct Matrices, checked by check {
        /// M \[kg, kg m²\].
        pub mass: String = key::name(FILE),
        /// K \[N/m, N m\]; an imaginary part is hysteretic damping.
        pub stiffness: String = key::name(FILE),
        /// C \[N s/m, N m s\]; none when absent.
        pub damping: Option<String> = key::name(FILE).optional(),
        /// External force f \[N, N m\], a matrix of one column; none when absent.
        pub load: Option<String> = key::name(FILE).optional(),
        /// A table (CSV) of what each row is: `node`, its motion `ux` … `rz`, and the node's coordinates `x`, `y`, `z`.
        pub dofs: Option<String> = key::name("the path of a table (CSV)").optional(),
        /// Scalars that the factors are expressions of, such as a speed, by name.
        pub scalar: BTreeMap<String, f64> =
            key::values(|| key::quantity(NUMBER), "letters, digits and _, not a digit first", is_name),
        /// Terms added to them, by name.
        pub term: BTreeMap<String, MatrixTerm> = key::named(),
    }
}

declare! {
    /// Matrices that are added with a common factor, a scalar of the case: M + a M₁, C + a C₁, K + a K₁. So a friction
    /// coefficient or a speed can be varied in a model that another program exported.
    pub struct MatrixTerm, checked by check_term {
        /// a.
        pub factor: Factor = key::value("a number, or an expression such as \"omega^2 - 1\""),
        /// M₁.
        pub mass: Option<String> = key::name(FILE).optional(),
        /// C₁.
        pub damping: Option<String> = key::name(FILE).optional(),
        /// K₁.
        pub stiffness: Option<String> = key::name(FILE).optional(),
    }
}

fn check_term(term: &MatrixTerm, report: &mut Report) {
    if [&term.mass, &term.damping, &term.stiffness].iter().all(|file| file.is_none()) {
        report.fault("stiffness", "no matrix", "`mass`, `damping` or `stiffness`", "");
    }
}

fn check(matrices: &Matrices, report: &mut Report) {
    for (name, term) in &matrices.term {
        let Factor::Expression(text) = &term.factor else { continue };
        if let Err((found, expected)) = evaluate(text, &matrices.scalar, "") {
            report.fault(&format!("term.{}.factor", dotted(name)), found, expected, "");
        }
    }
}

/// The factor a of a term.
#[derive(Debug, Clone, PartialEq)]
pub enum Factor {
    /// A scalar of the case.
    Number(f64),
    /// An expression of the scalars of `[matrices.scalar]`, such as `omega^2 - 1` ([`evaluate`]).
    Expression(String),
}

impl Blank for Factor {
    fn blank() -> Self {
        Factor::Number(0.0)
    }
}

impl Value for Factor {
    /// A number, or a text that is no number: an expression.
    fn read(value: &DeValue, units: &Units, k: usize) -> Result<Self, String> {
        match value.as_str().filter(|text| parse_quantity(text, NUMBER).is_err()) {
            None => f64::read(value, units, k).map(Factor::Number),
            Some("") => Err("the string \"\"".into()),
            Some(text) => Ok(Factor::Expression(text.into())),
        }
    }

    fn to_toml(&self) -> Option<toml::Value> {
        match self {
            Factor::Number(value) => value.to_toml(),
            Factor::Expression(text) => text.to_toml(),
        }
    }

    fn form() -> Form {
        Form::Either(Box::new(Form::Quantity), Box::new(Form::Text))
    }

    fn numbers(&mut self, at: &mut Vec<usize>, each: &mut dyn FnMut(&[usize], &mut f64)) {
        if let Factor::Number(value) = self {
            value.numbers(at, each);
        }
    }
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
