//! Coordinate systems: datasets 18 and 2420, Cartesian or cylindrical.
//!
//! A cylindrical system has coordinates r, θ, z with θ in degrees from its x axis, and directions e_r, e_θ, e_z that depend on
//! the place. Of numbers 0 and 1 the file need not say anything: they are the frame of the test.

use nalgebra::{Matrix3, Vector3};
use std::collections::BTreeMap;
use stridor_base::error::Result;
use stridor_base::universal::Dataset;

/// Types of coordinates.
const CARTESIAN: i64 = 0;
const CYLINDRICAL: i64 = 1;
/// Systems that the frame of the test is.
const GLOBAL: [i64; 2] = [0, 1];
/// Axes that are this far from perpendicular and from unit length are none.
const SKEW: f64 = 1e-3;

/// A system as a dataset gives it.
#[derive(Debug, Clone)]
struct SystemRecord {
    kind: i64,
    /// The system that the axes are given in.
    reference: i64,
    /// \[m\].
    origin: Vector3<f64>,
    /// Its axes as columns.
    axes: Matrix3<f64>,
}

/// The systems of a file by number.
#[derive(Debug, Default)]
pub(super) struct Systems(BTreeMap<i64, SystemRecord>);

/// A system in the frame of the test.
#[derive(Debug, Clone)]
pub(super) struct System {
    cylindrical: bool,
    origin: Vector3<f64>,
    axes: Matrix3<f64>,
}

impl System {
    fn global() -> System {
        System { cylindrical: false, origin: Vector3::zeros(), axes: Matrix3::identity() }
    }

    /// Whether a direction at a place is the same in the frame of the test.
    pub fn is_global(&self) -> bool {
        !self.cylindrical && self.axes == Matrix3::identity()
    }

    /// The place in the frame of the test \[m\] of coordinates in this system, whose lengths are in `unit` \[m\].
    pub fn place(&self, coordinates: [f64; 3], unit: f64) -> [f64; 3] {
        let [a, b, c] = coordinates;
        let own = if self.cylindrical {
            let (sin, cos) = b.to_radians().sin_cos();
            [a * cos, a * sin, c]
        } else {
            coordinates
        };
        (self.origin + self.axes * Vector3::from(own) * unit).into()
    }

    /// The directions of this system at a place of the frame of the test, which are none on the axis of a cylindrical one.
    pub fn directions(&self, at: [f64; 3]) -> Option<[[f64; 3]; 3]> {
        let axes = if self.cylindrical {
            let own = self.axes.transpose() * (Vector3::from(at) - self.origin);
            let radius = own.x.hypot(own.y);
            // Rounding of single precision.
            if radius <= 1e-6 * Vector3::from(at).norm().max(self.origin.norm()) {
                return None;
            }
            let (cos, sin) = (own.x / radius, own.y / radius);
            self.axes * Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0)
        } else {
            self.axes
        };
        Some([0, 1, 2].map(|k| axes.column(k).into_owned().into()))
    }
}

impl Systems {
    /// Reads dataset 18 or 2420, whose lengths are in `unit` \[m\].
    pub fn read(&mut self, dataset: &Dataset<'_>, unit: f64) -> Result<()> {
        let newer = dataset.kind == 2420;
        // A part with its name comes first.
        let mut index = if newer { 2 } else { 0 };
        while index < dataset.lines.len() {
            if dataset.line(index)?.trim().is_empty() {
                index += 1;
                continue;
            }
            let (number, system, next) = if newer {
                let [number, kind, _] = dataset.wholes(index, [10; 3])?;
                let rows = [2, 3, 4, 5].map(|k| vector(dataset, index + k));
                let [x, y, z, origin] = rows;
                let axes = Matrix3::from_columns(&[x?, y?, z?]);
                (number, SystemRecord { kind, reference: 0, origin: origin? * unit, axes }, index + 6)
            } else {
                let [number, kind, reference, ..] = dataset.wholes(index, [10; 5])?;
                let mut numbers = dataset.numbers(index + 2, &[13])?;
                numbers.extend(dataset.numbers(index + 3, &[13])?);
                let [a, b, c, d, e, f, g, h, i] = numbers[..] else {
                    let found = format!("{} numbers", numbers.len());
                    return Err(dataset.fault(index + 2, found, "9: origin, +x axis, +xz plane"));
                };
                let origin = Vector3::new(a, b, c);
                let x = (Vector3::new(d, e, f) - origin).normalize();
                let plane = Vector3::new(g, h, i) - origin;
                let z = (plane - x * x.dot(&plane)).normalize();
                let axes = Matrix3::from_columns(&[x, z.cross(&x), z]);
                (number, SystemRecord { kind, reference, origin: origin * unit, axes }, index + 4)
            };
            let skew = (system.axes.transpose() * system.axes - Matrix3::identity()).norm();
            if skew.is_nan() || skew >= SKEW {
                let found = format!("axes of system {number} that are not perpendicular and of length one");
                return Err(dataset.fault(index, found, "axes of a Cartesian frame"));
            }
            // Axes are given with few digits.
            let x = system.axes.column(0).normalize();
            let y = system.axes.column(1).into_owned();
            let y = (y - x * x.dot(&y)).normalize();
            // A left-handed system keeps its side.
            let z = x.cross(&y) * system.axes.determinant().signum();
            let axes = Matrix3::from_columns(&[x, y, z]);
            self.0.insert(number, SystemRecord { axes, ..system });
            index = next;
        }
        Ok(())
    }

    /// Whether the file gives none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The system of a number in the frame of the test; in words why there is none.
    pub fn find(&self, number: i64) -> std::result::Result<System, String> {
        self.within(number, self.0.len())
    }

    /// Follows at most `deep` references.
    fn within(&self, number: i64, deep: usize) -> std::result::Result<System, String> {
        let Some(record) = self.0.get(&number) else {
            return if GLOBAL.contains(&number) {
                Ok(System::global())
            } else {
                Err(format!("system {number}, which no dataset 18 or 2420 gives"))
            };
        };
        let cylindrical = match record.kind {
            CARTESIAN => false,
            CYLINDRICAL => true,
            kind => {
                return Err(format!(
                    "system {number} of type {kind}, neither Cartesian (0) nor cylindrical (1)"
                ));
            }
        };
        let System { origin, axes, cylindrical: round } = match record.reference {
            reference if reference == number || GLOBAL.contains(&reference) => System::global(),
            _ if deep == 0 => return Err(format!("system {number}, which refers to itself")),
            reference => self.within(reference, deep - 1)?,
        };
        if round {
            return Err(format!("system {number}, which refers to a cylindrical one"));
        }
        Ok(System { cylindrical, origin: origin + axes * record.origin, axes: axes * record.axes })
    }
}

/// Three numbers of a line.
fn vector(dataset: &Dataset<'_>, index: usize) -> Result<Vector3<f64>> {
    let numbers = dataset.numbers(index, &[25])?;
    match numbers[..] {
        [x, y, z] => Ok(Vector3::new(x, y, z)),
        _ => Err(dataset.fault(index, format!("{} numbers", numbers.len()), "three of a coordinate system")),
    }
}
