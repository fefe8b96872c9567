//! A surface in contact in the plane of a picture: seen along its mean normal, or unrolled about the axis to which it is curved.

use super::view::{View, ViewVector, along, cross, dot, unit};
use crate::results::ContactSurface;
use nalgebra::{Matrix3, SymmetricEigen, Vector3};
use std::f64::consts::TAU;

/// Surfaces whose mean normal, of length 1 on a plane, is shorter than this are unrolled where they are curved about one axis: arcs of 60° and more.
const FLAT: f64 = 0.955;
/// Those about an axis have less than this share of Σ A (n·axis)² in Σ A.
const ABOUT_AN_AXIS: f64 = 0.02;

/// One face there.
pub(super) struct PlaneFace {
    /// Its corners \[mm\].
    pub outline: Vec<[f64; 2]>,
    /// Its contact points by their numbers, with their places \[mm\].
    pub points: Vec<(usize, [f64; 2])>,
}

/// A surface there.
pub(super) struct PlaneSurface {
    pub faces: Vec<PlaneFace>,
    /// How it is seen.
    pub seen: String,
    /// The names of the axes across and up.
    pub axes: [String; 2],
    /// 1 where the counter-body slides to the right, −1 to the left, 0 where it does not slide.
    pub slides: f64,
}

/// The surface, on `nodes`, with contact points at `places` \[m\].
pub(super) fn in_plane(
    surface: &ContactSurface,
    nodes: &[ViewVector],
    places: &dyn Fn(usize) -> ViewVector,
) -> PlaneSurface {
    let outlines: Vec<Vec<ViewVector>> = surface
        .faces
        .iter()
        .map(|face| face.cell.corners().iter().map(|node| nodes[*node]).collect())
        .collect();
    let areas: Vec<Vector3<f64>> = outlines.iter().map(|outline| area(outline)).collect();
    let whole: f64 = areas.iter().map(|a| a.norm()).sum();
    let mean = areas.iter().sum::<Vector3<f64>>() / whole.max(f64::MIN_POSITIVE);
    let about = (mean.norm() < FLAT).then(|| Cylinder::through(&outlines, &areas, whole)).flatten();
    let slides = |towards: &dyn Fn(ViewVector) -> ViewVector| {
        let along = surface
            .faces
            .iter()
            .zip(&outlines)
            .map(|(face, outline)| dot(face.slides, towards(middle(outline))));
        let sum: f64 = along.sum();
        if sum == 0.0 { 0.0 } else { sum.signum() }
    };
    let faces = |project: &dyn Fn(ViewVector, ViewVector) -> [f64; 2]| {
        let face = |(face, outline): (&crate::results::ContactFace, &Vec<ViewVector>)| {
            let middle = middle(outline);
            let at = |x: ViewVector| project(x, middle).map(|c| 1e3 * c);
            PlaneFace {
                outline: outline.iter().map(|x| at(*x)).collect(),
                points: face.points.iter().map(|p| (*p, at(places(*p)))).collect(),
            }
        };
        surface.faces.iter().zip(&outlines).map(face).collect()
    };
    if let Some(cylinder) = about {
        let axis = named(cylinder.axis).map_or("its axis".to_string(), |(name, _)| name.to_string());
        return PlaneSurface {
            faces: faces(&|x, near| cylinder.unrolled(x, near)),
            seen: format!(
                "unrolled about {axis}, radius {} mm",
                super::format::significant(1e3 * cylinder.radius, 3)
            ),
            axes: ["arc length [mm]".into(), format!("along {axis} [mm]")],
            slides: slides(&|x| cylinder.around(x)),
        };
    }
    // Both sides of a disc are seen from the same side.
    let towards = positive(mean.into()).unwrap_or([0.0, 0.0, 1.0]);
    let sliding = surface.faces.iter().fold([0.0; 3], |sum, face| along(sum, 1.0, face.slides));
    let across = unit(along(sliding, -dot(sliding, towards), towards));
    let view = View::facing(towards).expect("a direction");
    let (right, words) = match across {
        Some(right) => (right, ["along the sliding direction", "across"]),
        None => (view.right, ["", ""]),
    };
    // Along an axis of the mesh places are those of the mesh.
    let label = |direction: ViewVector, words: &str| match (named(direction), words) {
        (Some((name, _)), "") => format!("{name} [mm]"),
        (Some((name, _)), words) => format!("{name} [mm], {words}"),
        (None, words) => format!("{words} [mm]"),
    };
    let turned = |direction: ViewVector| {
        named(direction).map_or(direction, |(_, sign)| direction.map(|c| c * sign + 0.0))
    };
    let (right, up) = (turned(right), turned(cross(towards, right)));
    let origin = match (named(right), named(up)) {
        (Some(_), Some(_)) => [0.0; 3],
        _ => middle(&outlines.concat()),
    };
    let from = cross(right, up).map(|c| -c);
    PlaneSurface {
        faces: faces(&|x, _| [dot(right, along(x, -1.0, origin)), dot(up, along(x, -1.0, origin))]),
        seen: format!(
            "seen along {}{}, about ({}) mm",
            direction(from),
            if mean.norm() < FLAT { ", curved" } else { "" },
            rounded(middle(&outlines.concat())).map(|c| super::format::significant(1e3 * c, 3)).join(", ")
        ),
        axes: [label(right, words[0]), label(up, words[1])],
        slides: slides(&|_| right),
    }
}

/// A cylinder about an axis.
struct Cylinder {
    axis: ViewVector,
    centre: ViewVector,
    radius: f64,
    /// Unit vectors from the axis to the middle of the surface, and across both.
    frame: [ViewVector; 2],
}

impl Cylinder {
    /// That through faces whose normals are across one axis: the point c of the axis is the one nearest to all lines along the normals,
    /// Σ A (1 − n nᵀ)(c − x) = 0.
    fn through(outlines: &[Vec<ViewVector>], areas: &[Vector3<f64>], whole: f64) -> Option<Self> {
        let normals = || areas.iter().filter(|a| a.norm() > 0.0).map(|a| (a.norm(), a.normalize()));
        let tensor: Matrix3<f64> = normals().map(|(size, n)| size * n * n.transpose()).sum();
        let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(tensor);
        if eigenvalues.min() > ABOUT_AN_AXIS * whole {
            return None;
        }
        let axis = Vector3::from(positive(eigenvectors.column(eigenvalues.imin()).into_owned().into())?);
        let along = axis * axis.transpose();
        let middles: Vec<Vector3<f64>> = outlines.iter().map(|outline| middle(outline).into()).collect();
        let (mut matrix, mut right) = (whole * along, Vector3::zeros());
        for ((size, n), x) in normals().zip(&middles) {
            let across = size * (Matrix3::identity() - n * n.transpose() - along);
            matrix += across;
            right += across * x;
        }
        let centre = matrix.lu().solve(&right)?;
        let from_axis: Vec<Vector3<f64>> =
            middles.iter().map(|x| x - centre - along * (x - centre)).collect();
        let radius = from_axis.iter().map(|r| r.norm()).sum::<f64>() / from_axis.len() as f64;
        let first = View::facing(axis.into())?.right;
        let mut cylinder = Cylinder {
            axis: axis.into(),
            centre: centre.into(),
            radius,
            frame: [first, cross(axis.into(), first)],
        };
        // The seam is in the widest gap between two faces.
        let mut angles: Vec<f64> = middles.iter().map(|x| cylinder.angle((*x).into())).collect();
        angles.sort_by(f64::total_cmp);
        let next = |k: usize| if k + 1 < angles.len() { angles[k + 1] } else { angles[0] + TAU };
        let widest =
            (0..angles.len()).max_by(|a, b| (next(*a) - angles[*a]).total_cmp(&(next(*b) - angles[*b])))?;
        let (sin, cos) = (0.5 * (angles[widest] + next(widest)) + 0.5 * TAU).sin_cos();
        let [e, f] = cylinder.frame;
        cylinder.frame =
            [super::view::along(e.map(|c| cos * c), sin, f), super::view::along(f.map(|c| cos * c), -sin, e)];
        Some(cylinder)
    }

    fn angle(&self, x: ViewVector) -> f64 {
        let r = along(x, -1.0, self.centre);
        dot(r, self.frame[1]).atan2(dot(r, self.frame[0]))
    }

    /// Arc and place along the axis \[m\]; beyond the seam where the place `near` is on the other side of it.
    fn unrolled(&self, x: ViewVector, near: ViewVector) -> [f64; 2] {
        let near = self.angle(near);
        let apart = self.angle(x) - near;
        let apart = apart - TAU * (apart / TAU).round();
        [self.radius * (near + apart), dot(x, self.axis)]
    }

    /// The direction of growing angles.
    fn around(&self, x: ViewVector) -> ViewVector {
        cross(self.axis, along(x, -1.0, self.centre))
    }
}

/// The area of a face along its normal.
fn area(outline: &[ViewVector]) -> Vector3<f64> {
    let at = |k: usize| Vector3::from(outline[k]);
    (2..outline.len()).map(|k| 0.5 * (at(k - 1) - at(0)).cross(&(at(k) - at(0)))).sum()
}

fn middle(outline: &[ViewVector]) -> ViewVector {
    let share = 1.0 / outline.len().max(1) as f64;
    outline.iter().fold([0.0; 3], |sum, x| along(sum, share, *x))
}

/// Without coordinates that are rounding beside the others.
fn rounded(x: ViewVector) -> ViewVector {
    let largest = x.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
    x.map(|c| if c.abs() > 1e-9 * largest { c } else { 0.0 })
}

/// The unit vector along `a` or against it whose largest component is positive.
fn positive(a: ViewVector) -> Option<ViewVector> {
    let a = unit(a)?;
    let largest = (0..3).max_by(|i, k| a[*i].abs().total_cmp(&(a[*k].abs() + 1e-9)))?;
    Some(a.map(|c| c * a[largest].signum()))
}

/// The axis of the mesh that a unit vector is along, and 1 or −1 where it points against it.
fn named(a: ViewVector) -> Option<(&'static str, f64)> {
    let k = (0..3).find(|k| a[*k].abs() > 1.0 - 1e-9)?;
    Some((["x", "y", "z"][k], a[k].signum()))
}

fn direction(a: ViewVector) -> String {
    match named(a) {
        Some((name, sign)) => format!("{}{name}", if sign < 0.0 { "−" } else { "+" }),
        None => format!("({})", a.map(|c| super::format::fixed(c, 2)).join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::mesh::Cell;
    use crate::results::ContactFace;

    /// Quadrilaterals of a mapped strip (s, t) → x(s, t) of n × 3 faces, each with a point in its middle, sliding along +s.
    fn strip(
        n: usize,
        at: &dyn Fn(f64, f64) -> ViewVector,
    ) -> (ContactSurface, Vec<ViewVector>, Vec<ViewVector>) {
        let nodes: Vec<ViewVector> = (0..=n)
            .flat_map(|i| (0..4).map(move |k| (i, k)))
            .map(|(i, k)| at(i as f64 / n as f64, k as f64 / 3.0))
            .collect();
        let cells = (0..n)
            .flat_map(|i| (0..3).map(move |k| [4 * i + k, 4 * i + 4 + k, 4 * i + 5 + k, 4 * i + k + 1]));
        let mut places = Vec::new();
        let face = |nodes_of: [usize; 4]| {
            let [a, b, c, d] = nodes_of.map(|node| nodes[node]);
            places.push(middle(&[a, b, c, d]));
            ContactFace {
                cell: Cell::quadrilateral(nodes_of),
                points: vec![places.len() - 1],
                slides: along(b, -1.0, a),
            }
        };
        let faces = cells.map(face).collect();
        (ContactSurface { pair: "p".into(), name: "s".into(), faces }, nodes, places)
    }

    fn flat_area(face: &PlaneFace) -> f64 {
        let space: Vec<ViewVector> = face.outline.iter().map(|[x, y]| [*x, *y, 0.0]).collect();
        area(&space).z
    }

    /// Arcs of a cylinder about any axis anywhere are unrolled with their areas, without overlaps, sliding to the right or the left; short ones are seen
    /// along their mean normal.
    #[test]
    fn arcs_are_unrolled_with_their_areas() {
        for (axis, centre) in [([0.0, 0.0, 1.0], [0.0; 3]), ([0.6, 0.0, 0.8], [1.0, -2.0, 0.3])] {
            let [e, f] = {
                let view = View::facing(axis).unwrap();
                [view.right, view.up]
            };
            for (arc, unrolled) in [(TAU, true), (4.0, true), (1.5, true), (0.8, false)] {
                for start in [0.0, 2.0, 5.0] {
                    let n = 48;
                    let at = |s: f64, t: f64| {
                        let (sin, cos) = (start + arc * s).sin_cos();
                        let r = along(e.map(|c| 0.02 * cos * c), 0.02 * sin, f);
                        along(along(centre, 1.0, r), 0.01 * t, axis)
                    };
                    let (surface, nodes, places) = strip(n, &at);
                    let plane = in_plane(&surface, &nodes, &|p| places[p]);
                    assert_eq!(plane.seen.contains("unrolled"), unrolled, "{arc}: {}", plane.seen);
                    if !unrolled {
                        assert_eq!(plane.slides, 1.0);
                        continue;
                    }
                    assert!(plane.slides != 0.0);
                    let chord = 2.0 * 20.0 * (0.5 * arc / n as f64).sin();
                    let areas: Vec<f64> = plane.faces.iter().map(flat_area).collect();
                    for area in &areas {
                        // The arc of the mean radius is longer than the chord by its square.
                        assert!(
                            within(area.abs() / (chord * 10.0 / 3.0) - 1.0, (arc / n as f64).powi(2), Theory),
                            "{area}"
                        );
                    }
                    assert!(areas.iter().all(|area| area.signum() == areas[0].signum()));
                    let xs = plane.faces.iter().flat_map(|face| &face.outline).map(|x| x[0]);
                    let [low, high] =
                        xs.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)]);
                    assert!(within((high - low) / (20.0 * arc) - 1.0, 0.01, Theory), "{low} {high}");
                }
            }
        }
    }

    /// The two sides of a disc that turns are seen from the same side, so that what is opposite is at one place.
    #[test]
    fn both_sides_of_a_disc_are_seen_alike() {
        for height in [-0.006, 0.006] {
            let at = |s: f64, t: f64| {
                let (sin, cos) = (0.5 * s - 0.25).sin_cos();
                let side = if height < 0.0 { 1.0 - t } else { t };
                [(0.08 + 0.03 * side) * cos, (0.08 + 0.03 * side) * sin, height]
            };
            let (surface, nodes, places) = strip(5, &at);
            let plane = in_plane(&surface, &nodes, &|p| places[p]);
            assert!(
                plane.seen.starts_with("seen along +z, about (9")
                    && plane.seen.contains(", 0,")
                    && plane.slides == 1.0,
                "{}",
                plane.seen
            );
            let outer = plane
                .faces
                .iter()
                .flat_map(|face| &face.outline)
                .map(|x| x[1])
                .fold(f64::NEG_INFINITY, f64::max);
            assert!(
                plane.axes[0].starts_with("y [mm], along") && (100.0..111.0).contains(&outer.abs()),
                "{:?} {outer}",
                plane.axes
            );
            let sum: f64 = plane.faces.iter().map(|face| flat_area(face).abs()).sum();
            assert!(
                within(sum / (0.5 * (110.0 * 110.0 - 80.0 * 80.0) * 0.5) - 1.0, 0.01, Discretisation),
                "{sum}"
            );
        }
    }
}
