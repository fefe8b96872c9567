//! What solid materials have: the axes of the chart of modulus over density in M. F. Ashby, Materials Selection in Mechanical Design (charts of
//! material properties), a little widened.

use std::ops::RangeInclusive;

/// E \[Pa\] from flexible foams to diamond.
pub const MODULUS: RangeInclusive<f64> = 1e5..=1.3e12;
/// ρ \[kg/m³\] from foams to osmium.
pub const DENSITY: RangeInclusive<f64> = 10.0..=2.3e4;
/// √(E/ρ) \[m/s\], the speed of waves along a rod: rubber has some 30, steel 5,200, beryllium 12,900, diamond 18,000.
pub const SPEED: RangeInclusive<f64> = 10.0..=2e4;
