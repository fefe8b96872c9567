//! Friction coefficients: how μ depends on the slip speed and on the pressure.

use super::coefficient::{Coefficient, FrictionCoefficient};
use super::table::FrictionTable;
use crate::error::Result;
use crate::schema::units::{INVERSE_VELOCITY, NUMBER, VELOCITY};
use crate::schema::{Field, Report, declare, key, variants};
use std::ops::Bound;
use std::sync::Arc;

variants! {
    /// The curve of the friction coefficient.
    pub enum FrictionCurve by tag "law", checked by check {
        /// μ = μ₀.
        Coulomb "coulomb" {
            /// Its coefficient.
            law: Coulomb = key::flat(),
        }
        /// μ = μ₀ + μ₁ exp(−α|v|).
        Exponential "exponential" {
            /// Its coefficients.
            law: Exponential = key::flat(),
        }
        /// μ = μ_k + (μ_s − μ_k) exp(−(|v|/v_s)^δ).
        Stribeck "stribeck" {
            /// Its coefficients.
            law: Stribeck = key::flat(),
        }
        /// μ = μ_s/(1 + a|v|).
        Hyperbolic "hyperbolic" {
            /// Its coefficients.
            law: Hyperbolic = key::flat(),
        }
        /// μ over slip velocity and pressure.
        Table "table" {
            /// Slip velocities \[m/s\], ascending.
            velocity: Vec<f64> = ascending(key::quantity_list(VELOCITY), "a list of velocities"),
            /// Pressures, ascending, in N per area, length or point as `normal.per` has it; one entry when μ does not depend on it.
            pressure: Vec<f64> = ascending(key::quantity_list_of_scalar(), "a list of pressures").or(vec![0.0]),
            /// One row a pressure, one column a velocity.
            mu: Vec<Vec<f64>> = key::rows(NUMBER).expecting("rows of friction coefficients"),
        }
    }
}

impl FrictionCurve {
    /// The law of the curve; `place` names a table in faults.
    ///
    /// # Errors
    /// Those of [`FrictionTable::new`].
    pub fn coefficient(&self, place: &str) -> Result<Arc<dyn FrictionCoefficient>> {
        Ok(match self {
            FrictionCurve::Coulomb { law } => Arc::new(*law),
            FrictionCurve::Exponential { law } => Arc::new(*law),
            FrictionCurve::Stribeck { law } => Arc::new(*law),
            FrictionCurve::Hyperbolic { law } => Arc::new(*law),
            FrictionCurve::Table { velocity, pressure, mu } => {
                Arc::new(FrictionTable::new(place, velocity.clone(), pressure.clone(), mu.clone())?)
            }
        })
    }
}

/// A friction coefficient of zero or more.
fn coefficient() -> Field<f64> {
    key::quantity(NUMBER).expecting("a friction coefficient").non_negative().label("friction coefficient")
}

fn ascending(list: Field<Vec<f64>>, expected: &'static str) -> Field<Vec<f64>> {
    list.expecting(expected)
        .check("values in ascending order", |v| !v.is_empty() && v.windows(2).all(|w| w[0] < w[1]))
}

fn check(curve: &FrictionCurve, report: &mut Report) {
    let FrictionCurve::Table { velocity, pressure, mu } = curve else { return };
    let fits = |row: &Vec<f64>| row.len() == velocity.len() && row.iter().all(|m| *m >= 0.0);
    if mu.len() != pressure.len() || !mu.iter().all(fits) {
        let expected = "one row a pressure, with one value of zero or more a velocity";
        report.fault("mu", format!("{mu:?}"), expected, "");
    }
}

declare! {
    /// Coulomb friction: the same μ at every speed and pressure.
    #[derive(Copy)]
    pub struct Coulomb {
        /// μ₀.
        pub mu0: f64 = coefficient(),
    }
}

impl FrictionCoefficient for Coulomb {
    fn mu(&self, _speed: f64, _pressure: f64) -> Coefficient {
        Coefficient { value: self.mu0, by_speed: 0.0, by_pressure: 0.0 }
    }
}

declare! {
    /// Friction that falls with speed: μ(v) = μ₀ + μ₁ exp(−α |v|).
    #[derive(Copy)]
    pub struct Exponential {
        /// μ₀: the limit at high speed.
        pub mu0: f64 = coefficient(),
        /// μ₁: what μ(0) has above μ₀.
        pub mu1: f64 = {
            let mu0 = *mu0;
            let expected = "a value with which μ at rest, mu0 + mu1, is zero or more";
            key::quantity(NUMBER)
                .expecting("a friction coefficient")
                .label("friction coefficient")
                .check(expected, move |mu1| mu0 + mu1 >= 0.0)
        },
        /// α \[s/m\].
        pub alpha: f64 = key::quantity(INVERSE_VELOCITY).non_negative().label("decay with speed"),
    }
}

impl FrictionCoefficient for Exponential {
    fn mu(&self, speed: f64, _pressure: f64) -> Coefficient {
        let decaying = self.mu1 * (-self.alpha * speed).exp();
        Coefficient { value: self.mu0 + decaying, by_speed: -self.alpha * decaying, by_pressure: 0.0 }
    }
}

declare! {
    /// Static and kinetic friction with Stribeck's transition: μ(v) = μ_k + (μ_s − μ_k) exp(−(|v|/v_s)^δ) (B. Armstrong-Hélouvry,
    /// P. Dupont & C. Canudas de Wit, Automatica 30 (1994) 1083).
    #[derive(Copy)]
    pub struct Stribeck {
        /// μ_s, at rest.
        pub mu_static: f64 = coefficient(),
        /// μ_k, at high speed.
        pub mu_kinetic: f64 = coefficient(),
        /// v_s \[m/s\].
        pub stribeck_velocity: f64 = key::quantity(VELOCITY).positive().label("Stribeck velocity"),
        /// δ: 1 for an exponential, 2 for a bell.
        pub exponent: f64 =
            key::quantity(NUMBER).within(Bound::Included(1.0), Bound::Included(10.0)).or(2.0),
    }
}

impl FrictionCoefficient for Stribeck {
    fn mu(&self, speed: f64, _pressure: f64) -> Coefficient {
        let part = speed / self.stribeck_velocity;
        let above = (self.mu_static - self.mu_kinetic) * (-part.powf(self.exponent)).exp();
        let slope = self.exponent * part.powf(self.exponent - 1.0) / self.stribeck_velocity;
        Coefficient { value: self.mu_kinetic + above, by_speed: -slope * above, by_pressure: 0.0 }
    }
}

declare! {
    /// Friction that falls to nothing: μ(v) = μ_s/(1 + a|v|), as in textbook examples of stick–slip.
    #[derive(Copy)]
    pub struct Hyperbolic {
        /// μ_s, at rest.
        pub mu_static: f64 = coefficient(),
        /// a \[s/m\].
        pub decline: f64 = key::quantity(INVERSE_VELOCITY).non_negative(),
    }
}

impl FrictionCoefficient for Hyperbolic {
    fn mu(&self, speed: f64, _pressure: f64) -> Coefficient {
        let value = self.mu_static / (1.0 + self.decline * speed);
        Coefficient {
            value,
            by_speed: -self.decline * value / (1.0 + self.decline * speed),
            by_pressure: 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};

    #[test]
    fn exponential_runs_from_the_static_to_the_high_speed_limit() {
        let law = Exponential { mu0: 0.3, mu1: 0.2, alpha: 4.0 };
        assert_eq!(law.mu(0.0, 0.0).value, 0.5);
        assert!(within((law.mu(50.0, 0.0).value - 0.3).abs(), 1e-15, RoundOff));
        let (slow, h) = (law.mu(0.25, 0.0), 1e-6);
        assert!(within((slow.value - (0.3 + 0.2 * (-1.0f64).exp())).abs(), 1e-15, RoundOff));
        let difference = (law.mu(0.25 + h, 0.0).value - law.mu(0.25 - h, 0.0).value) / (2.0 * h);
        assert!(within((slow.by_speed - difference).abs(), 1e-9, Reference));
    }

    #[test]
    fn falling_laws_start_at_rest_and_have_the_slopes_of_their_curves() {
        let bell = Stribeck { mu_static: 0.6, mu_kinetic: 0.4, stribeck_velocity: 0.05, exponent: 2.0 };
        let laws: [(&dyn FrictionCoefficient, f64, f64); 3] = [
            (&bell, 0.6, 0.4 + 0.2 * (-0.36f64).exp()),
            (&Stribeck { exponent: 1.0, ..bell }, 0.6, 0.4 + 0.2 * (-0.6f64).exp()),
            (&Hyperbolic { mu_static: 1.0, decline: 3.0 }, 1.0, 1.0 / 1.09),
        ];
        for (law, at_rest, moving) in laws {
            assert_eq!(law.mu(0.0, 0.0).value, at_rest);
            assert!(law.mu(0.0, 0.0).by_speed.is_finite());
            let (there, h) = (law.mu(0.03, 0.0), 1e-7);
            assert!(within((there.value - moving).abs(), 1e-14, RoundOff), "{law:?}");
            let slope = (law.mu(0.03 + h, 0.0).value - law.mu(0.03 - h, 0.0).value) / (2.0 * h);
            assert!(within((there.by_speed - slope).abs(), 1e-6, Reference), "{law:?}");
        }
    }
}
