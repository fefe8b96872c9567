//! A plate of a mesh as small pistons at its nodes, whatever it moves in.

use super::Plate;
use faer::Mat;
use nalgebra::Vector3;
use std::collections::BTreeMap;
use stridor_linalg::SparseVector;

/// A plate is flat when its nodes are within this part of its extent of its plane.
const FLAT: f64 = 1e-3;

/// Makes a linear form of the degrees of freedom from terms (node, axis, coefficient) in nodal translations.
type ReduceMotion<'a> = dyn Fn(&[(usize, usize, f64)]) -> SparseVector + 'a;

/// A flat plate as pistons at its nodes, each with its share of the area; a quadrilateral is four triangles of half weight.
#[derive(Debug, Clone)]
pub struct Surface {
    /// Its name.
    pub name: String,
    /// Unit normal n; the front of a plate is where its largest component is positive, that of a face of a solid outside.
    pub normal: [f64; 3],
    /// [`Plate::both_sides`].
    both_sides: bool,
    /// Its centroid \[m\].
    pub middle: [f64; 3],
    /// A \[m²\].
    pub area: f64,
    /// The largest piston \[m²\].
    largest: f64,
    /// Where the pistons are \[m\].
    points: Vec<[f64; 3]>,
    /// The volume that each displaces towards the front, A_i n·u(x_i), as a linear form of the degrees of freedom \[m²\].
    forms: Vec<SparseVector>,
}

impl Surface {
    /// Of `faces` with three or four nodes each, on a plate heard on `both_sides`, or seen from outside counter-clockwise; `None` when they
    /// are not flat, or have no area.
    pub fn new(
        name: &str,
        nodes: &[[f64; 3]],
        (faces, both_sides): (impl IntoIterator<Item = Vec<usize>>, bool),
        reduce: &ReduceMotion<'_>,
    ) -> Option<Surface> {
        let at = |node: usize| Vector3::from(nodes[node]);
        let areas = vector_areas(nodes, faces);
        let whole: Vector3<f64> = areas.values().sum();
        let area = whole.norm();
        let turn = if both_sides { whole[whole.iamax()].signum() } else { 1.0 };
        let normal = whole * (turn / area);
        let share = |a: &Vector3<f64>| turn * a.dot(&normal);
        let middle: Vector3<f64> = areas.iter().map(|(node, a)| at(*node) * (share(a) / area)).sum();
        let from_middle = |node: &usize| at(*node) - middle;
        let extent = areas.keys().map(|n| from_middle(n).norm()).fold(0.0, f64::max);
        let flat = areas.keys().all(|n| from_middle(n).dot(&normal).abs() <= FLAT * extent);
        let form = |(node, a): (&usize, &Vector3<f64>)| {
            let entries: Vec<_> = (0..3).map(|c| (*node, c, turn * a[c])).collect();
            reduce(&entries)
        };
        (flat && area > 0.0).then(|| Surface {
            name: name.to_string(),
            normal: normal.into(),
            both_sides,
            middle: middle.into(),
            area,
            largest: areas.values().map(share).fold(0.0, f64::max),
            points: areas.keys().map(|n| nodes[*n]).collect(),
            forms: areas.iter().map(form).collect(),
        })
    }

    /// Whether a place \[m\] is nearer to a piston than the largest one is wide.
    pub fn touches(&self, at: [f64; 3]) -> bool {
        let square = |x: &[f64; 3]| (0..3).map(|c| (x[c] - at[c]).powi(2)).sum::<f64>();
        self.points.iter().any(|x| square(x) < self.largest)
    }

    /// [`Plate::side`].
    pub fn side(&self, at: [f64; 3]) -> f64 {
        self.moving(&Mat::zeros(0, 0)).side(at)
    }

    /// Whether a place is behind it, heard there or not.
    pub fn is_behind(&self, at: [f64; 3]) -> bool {
        Plate { both_sides: true, ..self.moving(&Mat::zeros(0, 0)) }.side(at) < 0.0
    }

    /// The plate in its modes, whose shapes are n_dofs × n_modes.
    pub fn moving(&self, shapes: &Mat<f64>) -> Plate {
        let modes = shapes.ncols();
        let strength = Mat::from_fn(if modes > 0 { self.forms.len() } else { 0 }, modes, |i, m| {
            self.forms[i].dot(shapes.col_as_slice(m))
        });
        Plate {
            name: self.name.clone(),
            normal: self.normal,
            both_sides: self.both_sides,
            middle: self.middle,
            points: self.points.clone(),
            strength,
        }
    }
}

/// The vector area of each node \[m²\]: a third of that of its triangles.
fn vector_areas(
    nodes: &[[f64; 3]],
    faces: impl IntoIterator<Item = Vec<usize>>,
) -> BTreeMap<usize, Vector3<f64>> {
    let mut areas = BTreeMap::<usize, Vector3<f64>>::new();
    let at = |node: usize| Vector3::from(nodes[node]);
    let mut add = |[a, b, c]: [usize; 3], weight: f64| {
        let area = (at(b) - at(a)).cross(&(at(c) - at(a))) * (0.5 * weight / 3.0);
        for node in [a, b, c] {
            *areas.entry(node).or_default() += area;
        }
    };
    for face in faces {
        match face[..] {
            [a, b, c] => add([a, b, c], 1.0),
            [a, b, c, d] => {
                [[a, b, c], [a, c, d], [a, b, d], [b, c, d]].into_iter().for_each(|t| add(t, 0.5));
            }
            _ => {}
        }
    }
    areas
}

#[cfg(test)]
mod tests {
    use super::*;
    use stridor_base::bounds::{Origin::*, within};

    #[test]
    fn pistons_share_the_area_and_a_bent_plate_is_none() {
        let mut nodes =
            vec![[0.0, 0.0, 1.0], [2.0, 0.0, 1.0], [2.0, 1.0, 1.0], [0.0, 1.0, 1.0], [3.0, 0.0, 1.0]];
        let faces = || [vec![0, 3, 2, 1], vec![1, 2, 4]];
        let reduce = |terms: &[(usize, usize, f64)]| {
            SparseVector::from_entries(terms.iter().map(|(node, axis, v)| (3 * node + axis, *v)))
        };
        let surface = Surface::new("p", &nodes, (faces(), true), &reduce).unwrap();
        // The front is up though the faces look down: the volume of a rise of one millimetre is the area times that.
        assert!(surface.normal == [0.0, 0.0, 1.0] && within((surface.area - 2.5).abs(), 1e-14, RoundOff));
        let rise = Mat::from_fn(15, 1, |i, _| if i % 3 == 2 { 1e-3 } else { 0.0 });
        let volume: f64 = surface.moving(&rise).strength.col_as_slice(0).iter().sum();
        assert!(within((volume - 2.5e-3).abs(), 1e-17, RoundOff));
        // Centroid of a rectangle of 2 m² at x = 1 and a triangle of half a square metre at x = 7/3.
        let exact = (2.0 + 0.5 * 7.0 / 3.0) / 2.5;
        assert!(
            within((surface.middle[0] - exact).abs(), 1e-14, RoundOff)
                && within((surface.middle[2] - 1.0).abs(), 1e-14, RoundOff),
            "{:?}",
            surface.middle
        );
        assert!(surface.touches([2.0, 0.5, 1.1]) && !surface.touches([2.0, 0.5, 3.0]));
        assert_eq!((surface.side([0.0, 0.0, 2.0]), surface.side([0.0, 0.0, 0.0])), (1.0, -1.0));
        // A face of a solid looks where its nodes turn, and is heard there only.
        let face = Surface::new("p", &nodes, (faces(), false), &reduce).unwrap();
        assert_eq!(face.normal, [0.0, 0.0, -1.0]);
        assert_eq!((face.side([0.0, 0.0, 2.0]), face.side([0.0, 0.0, 0.0])), (0.0, 1.0));
        let volume: f64 = face.moving(&rise).strength.col_as_slice(0).iter().sum();
        assert!(within((volume + 2.5e-3).abs(), 1e-17, RoundOff));
        nodes[4][2] = 1.1;
        assert!(Surface::new("p", &nodes, (faces(), true), &reduce).is_none());
    }
}
