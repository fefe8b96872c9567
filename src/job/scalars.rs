//! The scalars of a case as something to differentiate by: which can be, in what steps, and the system they lead to.

use super::contacts::with_laws;
use super::forces::external_load;
use super::prepared::Prepared;
use crate::case::{Case, Invalidates, Parameter, path_matches};
use crate::error::{Error, Result};
use crate::schema::Derivative;
use crate::system::System;

/// A scalar of the case that the complex eigenvalues may depend on.
#[derive(Debug, Clone)]
pub struct CaseScalar {
    /// Its path.
    pub path: String,
    /// Its value \[SI\].
    pub value: f64,
    /// Its SI unit; empty for a pure number.
    pub unit: &'static str,
    /// The largest size of the scalars of its list, which it is one component of; its own size where it is in none.
    pub size: f64,
    /// Part of the problem that depends on it.
    pub kind: ScalarKind,
}

/// Part of the problem that depends on a scalar, which decides how a neighbouring system is built.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ScalarKind {
    /// Contact laws, loads, velocities: the structure and the contact points stay.
    Law,
    /// Ratios of modal damping: C is linear in them.
    Ratio,
    /// Everything else: the model is rebuilt.
    Structure,
}

/// A path with the reason why λ has no derivative by it.
pub type WithoutDerivative = (String, String);

/// The scalars that `patterns` name, in the order of the case, and those of them that have no derivative.
pub fn chosen(case: &Case, patterns: &[String]) -> (Vec<CaseScalar>, Vec<WithoutDerivative>) {
    let (mut scalars, mut left_out) = (Vec::new(), Vec::new());
    let all = case.parameters();
    for parameter in all.clone() {
        if !patterns.iter().any(|pattern| path_matches(pattern, &parameter.path)) {
            continue;
        }
        match kind(&parameter) {
            Ok(Some(kind)) => scalars.push(CaseScalar::new(parameter, kind, &all)),
            Ok(None) => {}
            Err(reason) => left_out.push((parameter.path, reason.to_string())),
        }
    }
    (scalars, left_out)
}

/// Kind of a scalar; `None` when no eigenvalue depends on it; the reason when λ has no derivative by it.
fn kind(parameter: &Parameter) -> std::result::Result<Option<ScalarKind>, &'static str> {
    match parameter.derivative {
        Derivative::Zero => Ok(None),
        Derivative::None(reason) => Err(reason),
        Derivative::Exists => Ok(Some(match parameter.invalidates {
            Invalidates::Damping if parameter.path.starts_with("damping.") => ScalarKind::Ratio,
            Invalidates::Law | Invalidates::Equilibrium => ScalarKind::Law,
            _ => ScalarKind::Structure,
        })),
    }
}

/// The scalar at `path`.
///
/// # Errors
/// A path that is not a number of the case, or one that nothing has a derivative by.
pub fn scalar(case: &Case, path: &str) -> Result<Option<CaseScalar>> {
    let parameter = case.parameter(path)?;
    let kind = kind(&parameter).map_err(no_derivative)?;
    Ok(kind.map(|kind| CaseScalar::new(parameter, kind, &case.parameters())))
}

impl CaseScalar {
    fn new(parameter: Parameter, kind: ScalarKind, all: &[Parameter]) -> CaseScalar {
        let Parameter { path, value, unit, .. } = parameter;
        let list = |path: &str| {
            path.rsplit_once('.')
                .filter(|(_, k)| k.parse::<usize>().is_ok())
                .map(|(list, _)| list.to_string())
        };
        let own = list(&path);
        let beside = all.iter().filter(|other| own.is_some() && list(&other.path) == own);
        let size = beside.fold(value.abs(), |size, other| size.max(other.value.abs()));
        CaseScalar { path, value, unit, size, kind }
    }

    /// A step that is small against the magnitude of the scalar, and a guess where it is zero.
    pub fn step(&self) -> f64 {
        const SHARE: f64 = 1e-3;
        let least = match (self.unit, self.path.rsplit('.').next()) {
            ("rad", _) => 1e-3,
            ("m", Some("thickness")) => 0.0,
            ("m", _) => 1e-6,
            ("s", _) => 1e-12,
            ("kg m^2", _) => 1e-12,
            (unit, _) if unit.starts_with("N/m") => 1.0,
            _ if self.value == 0.0 => 1e-4,
            _ => 0.0,
        };
        (SHARE * self.value.abs()).max(least)
    }

    /// The longest step from zero, where the effect on λ asks for more than the guess: an angle of 0.01, a length of 1 mm, a hundredth
    /// of the largest component of a direction; of other quantities any, as zero says nothing of their size.
    pub fn longest_step(&self) -> f64 {
        match self.unit {
            "rad" => 1e-2,
            "m" => 1e-3,
            "" if self.size > 0.0 => 1e-2 * self.size,
            "" => 1e-2,
            _ => f64::INFINITY,
        }
    }

    /// The system of the case with this scalar at `value`, which has the degrees of freedom, the elements and the contact
    /// points that `prepared` has.
    ///
    /// # Errors
    /// A value that the case refuses, or one with which the model is another.
    pub fn system_at(&self, prepared: &Prepared, value: f64) -> Result<System> {
        let system = &prepared.system;
        let case = prepared.case.with_parameter(&self.path, value)?;
        if self.kind != ScalarKind::Structure {
            let load = external_load(&case, &prepared.regions, &prepared.model, &prepared.assembled)?;
            return Ok(System { pairs: with_laws(&system.pairs, &case)?, load, ..system.clone() });
        }
        let other = prepared.rebuilt(&case)?;
        let points = |s: &System| s.pairs.iter().map(|p| p.points.len()).collect::<Vec<_>>();
        same_structure(prepared, &other)?;
        if points(&other.system) != points(system) {
            return Err(no_derivative("it changes the number of contact points"));
        }
        Ok(other.system)
    }
}

/// That two models have the same elements and degrees of freedom.
pub(super) fn same_structure(a: &Prepared, b: &Prepared) -> Result<()> {
    if a.regions.mesh.elements != b.regions.mesh.elements {
        return Err(no_derivative("it changes the elements of the mesh"));
    }
    if a.system.n_dofs() != b.system.n_dofs() {
        let reason = "it changes the number of degrees of freedom, as a spring that alone acts on a node without mass does \
                      where its stiffness is zero";
        return Err(no_derivative(reason));
    }
    Ok(())
}

pub(super) fn no_derivative(reason: &str) -> Error {
    Error::analysis("derivative", reason, "Leave the scalar out")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::modal::{ModesWanted, compute};

    #[test]
    fn questions_are_no_scalars_of_the_machine() {
        let text = include_str!("../../validation/rig-coarse/case.toml");
        let more = "[transient]\nduration = 1\ntime_step = 0.1\n";
        let case = Case::parse("case", &format!("{text}\n{more}"), ".".into()).unwrap();
        let kind = |path: &str| kind(&case.parameter(path).unwrap());
        assert_eq!((kind("cea.band.1"), kind("transient.time_step")), (Ok(None), Ok(None)));
        assert!(kind("mesh.rig.disc_size").is_err() && kind("contact.rim.reach").is_err());
        assert_eq!(kind("mesh.rig.bar_length"), Ok(Some(ScalarKind::Structure)));
        assert_eq!(kind("contact.rim.friction.mu0"), Ok(Some(ScalarKind::Law)));
        assert_eq!(kind("contact.rim.load"), Ok(Some(ScalarKind::Law)));
        assert_eq!(kind("damping.modal_ratio"), Ok(Some(ScalarKind::Ratio)));
    }

    #[test]
    fn modes_do_not_notice_that_a_spring_without_stiffness_is_left_out() {
        let prepare = |stiffness: &str, test: &dyn Fn(&Prepared)| {
            let text = format!(
                "[point]\nblock = [0, 0, 0]\neye = [1, 0, 0]\n[mass.block]\non = \"block\"\nmass = 1\n\
                 [support.line]\non = \"block\"\nheld = [\"uy\", \"uz\", \"rx\", \"ry\", \"rz\"]\n\
                 [spring.ground]\non = \"block\"\ndirection = [1, 0, 0]\nstiffness = 1\n\
                 [spring.eye]\non = \"eye\"\nto = \"block\"\ndirection = [1, 0, 0]\nstiffness = {stiffness}\n"
            );
            test(&Prepared::new(&Case::parse("case", &text, ".".into()).unwrap()).unwrap());
        };
        for (stiffness, n_dofs) in [("0", 1), ("1e-9", 2), ("1", 2)] {
            prepare(stiffness, &|prepared| {
                let structure = &prepared.assembled.structure;
                let (real, _) = compute(structure, ModesWanted::BelowHz(1.0), &()).unwrap();
                assert_eq!((structure.n_dofs(), real.len()), (n_dofs, 1));
                assert!(
                    within((real.eigenvalues[0] - 1.0).abs(), 1e-12, RoundOff),
                    "{}",
                    real.eigenvalues[0]
                );
            });
        }
        prepare("0", &|prepared| {
            let scalar = scalar(prepared.case, "spring.eye.stiffness").unwrap().unwrap();
            let refused = scalar.system_at(prepared, 1.0).unwrap_err().to_string();
            assert!(refused.contains("degrees of freedom, as a spring"), "{refused}");
        });
    }
}
