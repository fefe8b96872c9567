//! Materials: elasticity, density and damping.

use crate::schema::units::{DENSITY, NUMBER, PRESSURE, RATE, TIME};
use crate::schema::{Invalidates, Report, declare, key};
use nalgebra::{Rotation3, SMatrix, Unit, Vector3};
use std::ops::Bound;

declare! {
    /// Linear elastic material: isotropic, or orthotropic.
    #[derive(Copy)]
    pub struct Material, checked by check_material {
        /// E \[Pa\]; E₁ of an orthotropic material.
        pub youngs_modulus: f64 = key::quantity(PRESSURE).positive().label("Young's modulus"),
        /// ν; ν₁₂ of an orthotropic material.
        pub poissons_ratio: f64 = key::quantity(NUMBER)
            .within(Bound::Excluded(-1.0), Bound::Excluded(0.5))
            .expecting("a number such as 0.3")
            .label("Poisson's ratio"),
        /// ρ \[kg/m³\].
        pub density: f64 = key::quantity(DENSITY).positive(),
        /// η of K(1 + iη); zero for none.
        pub loss_factor: f64 =
            key::quantity(NUMBER).non_negative().or(0.0).invalidates(Invalidates::Damping),
        /// C = α M + β K of the parts made of it.
        pub rayleigh: RayleighDamping = key::table().invalidates(Invalidates::Damping),
        /// Other constants in other directions, of solids; isotropic when absent.
        pub orthotropic: Option<Orthotropic> = key::table().optional(),
    }
}

declare! {
    /// Orthotropic elasticity, by engineering constants: ν_ij = −ε_j/ε_i under a stress in direction i, so that ν_ij/E_i = ν_ji/E_j.
    /// With the constants of direction 3 alone the material is transversely isotropic about it, as friction linings are.
    #[derive(Copy)]
    pub struct Orthotropic {
        /// Direction 3: the normal of a lining.
        pub axis_3: [f64; 3] = key::direction().expecting("a direction such as [0, 0, 1]"),
        /// Direction 1, or any in the plane of 1 and 3.
        pub axis_1: Option<[f64; 3]> = key::direction().optional(),
        /// E₃ \[Pa\].
        pub youngs_modulus_3: f64 = key::quantity(PRESSURE).positive().label("Young's modulus E₃"),
        /// ν₁₃.
        pub poissons_ratio_13: f64 = key::quantity(NUMBER).label("Poisson's ratio ν₁₃"),
        /// G₁₃ \[Pa\].
        pub shear_modulus_13: f64 = key::quantity(PRESSURE).positive().label("shear modulus G₁₃"),
        /// E₂ \[Pa\]; E₁ when absent.
        pub youngs_modulus_2: Option<f64> =
            key::quantity(PRESSURE).positive().optional().label("Young's modulus E₂"),
        /// ν₂₃; ν₁₃ when absent.
        pub poissons_ratio_23: Option<f64> = key::quantity(NUMBER).optional().label("Poisson's ratio ν₂₃"),
        /// G₂₃ \[Pa\]; G₁₃ when absent.
        pub shear_modulus_23: Option<f64> =
            key::quantity(PRESSURE).positive().optional().label("shear modulus G₂₃"),
        /// G₁₂ \[Pa\]; E₁/2(1 + ν₁₂) when absent.
        pub shear_modulus_12: Option<f64> =
            key::quantity(PRESSURE).positive().optional().label("shear modulus G₁₂"),
    }
}

declare! {
    /// C = α M + β K.
    #[derive(Copy)]
    pub struct RayleighDamping {
        /// α \[1/s\].
        pub alpha: f64 = key::quantity(RATE).non_negative().or(0.0).label("Rayleigh coefficient"),
        /// β \[s\].
        pub beta: f64 = key::quantity(TIME).non_negative().or(0.0).label("Rayleigh coefficient"),
    }
}

impl Material {
    /// G = E/2(1+ν) \[Pa\].
    pub fn shear_modulus(&self) -> f64 {
        self.youngs_modulus / (2.0 * (1.0 + self.poissons_ratio))
    }

    /// D \[Pa\] of σ = D ε on (xx, yy, zz, xy, yz, zx) in space, shear strains γ.
    pub fn elasticity(&self) -> SMatrix<f64, 6, 6> {
        if let Some(orthotropic) = &self.orthotropic {
            let turned = to_axes(orthotropic.directions());
            return turned.transpose() * self.in_axes().unwrap_or_default() * turned;
        }
        let (e, nu, g) = (self.youngs_modulus, self.poissons_ratio, self.shear_modulus());
        let lambda = e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
        SMatrix::from_fn(|i, j| match (i < 3, j < 3) {
            (true, true) => lambda + if i == j { 2.0 * g } else { 0.0 },
            (false, false) if i == j => g,
            _ => 0.0,
        })
    }

    /// The constants and directions of an orthotropic material; none of an isotropic one.
    pub fn engineering(&self) -> Option<Engineering> {
        let o = self.orthotropic.as_ref()?;
        let e2 = o.youngs_modulus_2.unwrap_or(self.youngs_modulus);
        let nu23 = o.poissons_ratio_23.unwrap_or(o.poissons_ratio_13);
        let g12 = o.shear_modulus_12.unwrap_or_else(|| self.shear_modulus());
        let g23 = o.shear_modulus_23.unwrap_or(o.shear_modulus_13);
        Some(Engineering {
            youngs_moduli: [self.youngs_modulus, e2, o.youngs_modulus_3],
            poissons_ratios: [self.poissons_ratio, o.poissons_ratio_13, nu23],
            shear_moduli: [g12, o.shear_modulus_13, g23],
            directions: o.directions().map(Into::into),
        })
    }

    /// Whether it is the same in all directions about an axis, a unit vector.
    pub fn is_isotropic_about(&self, axis: [f64; 3]) -> bool {
        let turn = Rotation3::from_axis_angle(&Unit::new_unchecked(Vector3::from(axis)), 1.0);
        let (turned, d) = (to_axes([0, 1, 2].map(|k| turn * Vector3::ith(k, 1.0))), self.elasticity());
        (turned.transpose() * d * turned - d).norm() < 1e-9 * d.norm()
    }

    /// D on (11, 22, 33, 12, 23, 31): the inverse of the compliance; none where that is not positive definite.
    fn in_axes(&self) -> Option<SMatrix<f64, 6, 6>> {
        let Engineering { youngs_moduli, poissons_ratios, shear_moduli, .. } = self.engineering()?;
        let ([e1, e2, e3], [nu12, nu13, nu23], [g12, g13, g23]) =
            (youngs_moduli, poissons_ratios, shear_moduli);
        let mut compliance = SMatrix::<f64, 6, 6>::zeros();
        for (k, stiffness) in [e1, e2, e3, g12, g23, g13].into_iter().enumerate() {
            compliance[(k, k)] = 1.0 / stiffness;
        }
        for (i, j, value) in [(0, 1, nu12 / e1), (0, 2, nu13 / e1), (1, 2, nu23 / e2)] {
            (compliance[(i, j)], compliance[(j, i)]) = (-value, -value);
        }
        Some(compliance.cholesky()?.inverse())
    }
}

/// Engineering constants of an orthotropic material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Engineering {
    /// E₁, E₂, E₃ \[Pa\].
    pub youngs_moduli: [f64; 3],
    /// ν₁₂, ν₁₃, ν₂₃.
    pub poissons_ratios: [f64; 3],
    /// G₁₂, G₁₃, G₂₃ \[Pa\].
    pub shear_moduli: [f64; 3],
    /// Directions 1, 2, 3.
    pub directions: [[f64; 3]; 3],
}

impl Orthotropic {
    /// Whether directions 1 and 2 are alike.
    fn is_transversely_isotropic(&self) -> bool {
        [self.youngs_modulus_2, self.poissons_ratio_23, self.shear_modulus_23, self.shear_modulus_12]
            .iter()
            .all(Option::is_none)
    }

    /// Directions 1, 2, 3; where no first one is given, any that is normal to the third.
    fn directions(&self) -> [Vector3<f64>; 3] {
        let third = Vector3::from(self.axis_3).normalize();
        let first = match self.axis_1 {
            Some(first) => Vector3::from(first),
            None => Vector3::ith(third.iamin(), 1.0),
        };
        let first = (first - third * first.dot(&third)).normalize();
        [first, third.cross(&first), third]
    }
}

/// T of ε′ = T ε, with ε′ on (11, 22, 33, 12, 23, 31) in these directions and ε on (xx, yy, zz, xy, yz, zx), shear strains γ.
fn to_axes(directions: [Vector3<f64>; 3]) -> SMatrix<f64, 6, 6> {
    const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)];
    SMatrix::from_fn(|row, column| {
        let ((i, j), (k, l)) = (PAIRS[row], PAIRS[column]);
        let (a, b) = (directions[i], directions[j]);
        match (i == j, k == l) {
            (true, true) => a[k] * a[k],
            (true, false) => a[k] * a[l],
            (false, true) => 2.0 * a[k] * b[k],
            (false, false) => a[k] * b[l] + a[l] * b[k],
        }
    })
}

/// Sine of the least angle between two directions.
const PARALLEL: f64 = 1e-6;

fn check_material(material: &Material, report: &mut Report) {
    let Some(orthotropic) = &material.orthotropic else { return };
    match orthotropic.axis_1 {
        None if !orthotropic.is_transversely_isotropic() => report.fault(
            "orthotropic.axis_1",
            "none, with constants that differ between directions 1 and 2",
            "the direction of E₁",
            "Give `axis_1`; with `youngs_modulus_3`, `poissons_ratio_13` and `shear_modulus_13` alone none is needed",
        ),
        Some(first) => {
            let [first, third] = [first, orthotropic.axis_3].map(|axis| Vector3::from(axis).normalize());
            if first.cross(&third).norm() < PARALLEL {
                report.fault(
                    "orthotropic.axis_1",
                    "a direction along `axis_3`",
                    "one at an angle to it",
                    "Direction 1 lies in the plane whose normal is `axis_3`",
                );
            }
        }
        None => {}
    }
    if material.in_axes().is_none() {
        report.fault(
            "orthotropic",
            "constants with which some strain releases energy",
            "a compliance matrix that is positive definite",
            "ν_ij = −ε_j/ε_i under a stress in direction i: |ν_ij| stays below √(E_i/E_j); a ratio given the other way round is ν_ji = ν_ij E_j/E_i",
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::structure::samples::STEEL;

    fn lining(axis_3: [f64; 3], axis_1: Option<[f64; 3]>, full: bool) -> Material {
        let orthotropic = Orthotropic {
            axis_3,
            axis_1,
            youngs_modulus_3: 1.1e9,
            poissons_ratio_13: 0.31,
            shear_modulus_13: 1.9e9,
            youngs_modulus_2: full.then_some(5e9),
            poissons_ratio_23: full.then_some(0.22),
            shear_modulus_23: full.then_some(1.4e9),
            shear_modulus_12: full.then_some(3.7e9),
        };
        Material { youngs_modulus: 8e9, poissons_ratio: 0.25, orthotropic: Some(orthotropic), ..STEEL }
    }

    /// 1/E of a stress along the unit vector n: S₁₁n₁⁴ + S₂₂n₂⁴ + S₃₃n₃⁴ + Σ (2S_ij + 1/G_ij) n_i²n_j² (S. G. Lekhnitskii, Theory of
    /// Elasticity of an Anisotropic Body, 1963).
    #[test]
    fn the_modulus_along_any_direction_is_that_of_lekhnitskii() {
        let axes = [Vector3::new(0.6, 0.8, 0.0), Vector3::new(0.48, -0.36, 0.8)];
        let [first, third] = axes;
        for full in [false, true] {
            let material = lining(third.into(), full.then_some((first + third * 3.0).into()), full);
            let o = material.orthotropic.unwrap();
            let compliance = material.elasticity().cholesky().unwrap().inverse();
            let (e1, nu12, g12) = (8e9, 0.25, o.shear_modulus_12.unwrap_or(8e9 / 2.5));
            let (e2, nu23) = (o.youngs_modulus_2.unwrap_or(e1), o.poissons_ratio_23.unwrap_or(0.31));
            let g23 = o.shear_modulus_23.unwrap_or(1.9e9);
            let first = (first - third * first.dot(&third)).normalize();
            let second = third.cross(&first);
            for n in [[1.0, 0.0, 0.0], [0.3, -0.7, 0.2], [0.0, 0.5, 0.5], [0.48, -0.36, 0.8]] {
                let n = Vector3::from(n).normalize();
                let stress = SMatrix::<f64, 6, 1>::from_iterator([
                    n[0] * n[0],
                    n[1] * n[1],
                    n[2] * n[2],
                    n[0] * n[1],
                    n[1] * n[2],
                    n[2] * n[0],
                ]);
                let found = (stress.transpose() * compliance * stress)[0];
                let [a, b, c] = [first, second, third].map(|axis| axis.dot(&n).powi(2));
                let right = a * a / e1
                    + b * b / e2
                    + c * c / 1.1e9
                    + (1.0 / g12 - 2.0 * nu12 / e1) * a * b
                    + (1.0 / g23 - 2.0 * nu23 / e2) * b * c
                    + (1.0 / 1.9e9 - 2.0 * 0.31 / e1) * a * c;
                assert!(within((found / right - 1.0).abs(), 1e-13, RoundOff), "{full} {n}: {found} {right}");
            }
        }
    }

    #[test]
    fn isotropic_constants_in_any_axes_are_isotropy() {
        let g = STEEL.shear_modulus();
        for (axis_3, axis_1) in [([0.0, 0.0, 1.0], None), ([0.2, -0.4, 0.3], Some([1.0, 1.0, 0.0]))] {
            let orthotropic = Orthotropic {
                axis_3,
                axis_1,
                youngs_modulus_3: STEEL.youngs_modulus,
                poissons_ratio_13: STEEL.poissons_ratio,
                shear_modulus_13: g,
                youngs_modulus_2: None,
                poissons_ratio_23: None,
                shear_modulus_23: None,
                shear_modulus_12: None,
            };
            let turned = Material { orthotropic: Some(orthotropic), ..STEEL }.elasticity();
            let error = (turned - STEEL.elasticity()).norm() / STEEL.elasticity().norm();
            assert!(within(error, 1e-14, RoundOff), "{error:.1e}");
        }
    }
}
