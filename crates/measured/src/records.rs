//! Contents of a file of a test, by the numbers of its points; and their conversion to a [`MeasuredSet`].

use super::set::{MeasuredDof, MeasuredFrf, MeasuredMode, MeasuredPoint, MeasuredSet, Quantity};
use std::collections::{BTreeMap, BTreeSet};
use stridor_linalg::c64;

/// The content of a file, in SI units. A shape gives the points that it has; what it leaves out is at rest.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TestRecords {
    /// Points by number \[m\].
    pub points: BTreeMap<u64, [f64; 3]>,
    /// The three directions of the motion of points in shapes by number, where they are not x, y and z.
    pub axes: BTreeMap<u64, [[f64; 3]; 3]>,
    /// Modes in any order.
    pub modes: Vec<ModeRecord>,
    /// Frequency responses.
    pub functions: Vec<FunctionRecord>,
    /// Warnings, one sentence each without its full stop.
    pub warnings: Vec<String>,
}

/// A mode.
#[derive(Debug, Clone, PartialEq)]
pub struct ModeRecord {
    /// See [`MeasuredMode`].
    pub frequency_hz: f64,
    /// See [`MeasuredMode`].
    pub damping_ratio: Option<f64>,
    /// See [`MeasuredMode`].
    pub deviation: Option<f64>,
    /// Displacement along x, y, z, or the [`TestRecords::axes`] of the point, by its number; empty where no shape is known.
    pub shape: BTreeMap<u64, [c64; 3]>,
}

/// A frequency response.
#[derive(Debug, Clone, PartialEq)]
pub struct FunctionRecord {
    /// See [`MeasuredFrf`].
    pub name: String,
    /// See [`MeasuredFrf`].
    pub quantity: Quantity,
    /// The number of the point that the force acts on, and its direction.
    pub excitation: (u64, [f64; 3]),
    /// The number of the point whose motion it is, and its direction.
    pub response: (u64, [f64; 3]),
    /// See [`MeasuredFrf`].
    pub frequencies_hz: Vec<f64>,
    /// See [`MeasuredFrf`].
    pub values: Vec<c64>,
}

impl TestRecords {
    /// The set with its modes in ascending order, and the warnings. A direction in which no mode moves a point was not
    /// measured there. What belongs to a point without a place is left out with a warning, and so are modes at 0 Hz.
    pub fn into_set(self) -> (MeasuredSet, Vec<String>) {
        let TestRecords { points: places, axes, mut modes, functions, mut warnings } = self;
        let points: Vec<MeasuredPoint> =
            places.iter().map(|(id, position)| MeasuredPoint { id: *id, position: *position }).collect();
        let index = |id: &u64| points.binary_search_by_key(id, |p| p.id).ok();
        let mut lost: BTreeSet<u64> = BTreeSet::new();
        let all = modes.len();
        modes.retain(|mode| mode.frequency_hz > 0.0);
        if modes.len() < all {
            warnings.push(format!("{} modes at 0 Hz were left out", all - modes.len()));
        }
        modes.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
        let mut moving: BTreeSet<(usize, usize)> = BTreeSet::new();
        for (id, motion) in modes.iter().flat_map(|mode| &mode.shape) {
            let Some(point) = index(id) else {
                lost.insert(*id);
                continue;
            };
            moving.extend((0..3).filter(|axis| motion[*axis].norm_sqr() > 0.0).map(|axis| (point, axis)));
        }
        let unit = |axis: usize| [0, 1, 2].map(|k| f64::from(k == axis));
        let along =
            |point: usize, axis: usize| axes.get(&points[point].id).map_or(unit(axis), |own| own[axis]);
        let dof =
            |(point, axis): &(usize, usize)| MeasuredDof { point: *point, direction: along(*point, *axis) };
        let dofs = moving.iter().map(dof);
        let shape = |shape: &BTreeMap<u64, [c64; 3]>| -> Option<Vec<c64>> {
            let at = |(point, axis): &(usize, usize)| {
                shape.get(&points[*point].id).map_or(c64::new(0.0, 0.0), |motion| motion[*axis])
            };
            let values: Vec<c64> = moving.iter().map(at).collect();
            values.iter().any(|v| v.norm_sqr() > 0.0).then_some(values)
        };
        let mode = |mode: &ModeRecord| MeasuredMode {
            frequency_hz: mode.frequency_hz,
            damping_ratio: mode.damping_ratio,
            deviation: mode.deviation,
            shape: shape(&mode.shape),
        };
        let mut frfs = Vec::new();
        for function in functions {
            let mut place = |(id, direction): (u64, [f64; 3])| {
                let point = index(&id);
                lost.extend(point.is_none().then_some(id));
                point.map(|point| MeasuredDof { point, direction })
            };
            if let (Some(excitation), Some(response)) = (place(function.excitation), place(function.response))
            {
                let FunctionRecord { name, quantity, frequencies_hz, values, .. } = function;
                frfs.push(MeasuredFrf { name, quantity, excitation, response, frequencies_hz, values });
            }
        }
        if !lost.is_empty() {
            let few: Vec<String> = lost.iter().take(8).map(u64::to_string).collect();
            let more = if lost.len() > few.len() { " …" } else { "" };
            let list = few.join(", ") + more;
            warnings.push(format!(
                "data measured at points without coordinates were left out (points {list}); `point` may give coordinates"
            ));
        }
        let set = MeasuredSet { dofs: dofs.collect(), modes: modes.iter().map(mode).collect(), frfs, points };
        (set, warnings)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_that_never_move_were_not_measured_and_lost_points_are_told() {
        let real = |v: [f64; 3]| v.map(|x| c64::new(x, 0.0));
        let mode = |frequency_hz: f64, shape: &[(u64, [f64; 3])]| ModeRecord {
            frequency_hz,
            damping_ratio: None,
            deviation: None,
            shape: shape.iter().map(|(id, v)| (*id, real(*v))).collect(),
        };
        let points = BTreeMap::from([(7, [0.0; 3]), (9, [1.0; 3])]);
        let modes = vec![
            mode(20.0, &[(9, [0.0, 0.0, 2.0])]),
            mode(10.0, &[(7, [1.0, 0.0, 0.0]), (8, [5.0; 3])]),
            mode(0.0, &[]),
            mode(30.0, &[]),
        ];
        let (set, warnings) = TestRecords { points, modes, ..TestRecords::default() }.into_set();
        assert_eq!(set.modes.iter().map(|m| m.frequency_hz).collect::<Vec<_>>(), [10.0, 20.0, 30.0]);
        assert_eq!(set.dofs[0], MeasuredDof { point: 0, direction: [1.0, 0.0, 0.0] });
        assert_eq!(set.dofs[1], MeasuredDof { point: 1, direction: [0.0, 0.0, 1.0] });
        assert_eq!(set.modes[1].shape.as_ref().unwrap()[1].re, 2.0);
        assert!(set.dofs.len() == 2 && set.modes[2].shape.is_none());
        assert!(warnings.len() == 2 && warnings[1].contains("points 8"), "{warnings:?}");
    }
}
