//! Contact of faces of solids by segments: the parts of a face of the body that lie over one face of the counter-body each.
//!
//! The pressure is linear on every face of the body, bilinear on quadrilaterals, and continuous on no edge; it is p = k_n Π(gap), with Π the
//! L² projection on such functions. With ψ_k the functions that are 1 at one of the points of the face and 0 at the others, and dA its area,
//!
//! * w_k = ∫ ψ_k dA,  δ_k = ∫ ψ_k δ dA/w_k,  and likewise the slip;
//! * forces on both bodies are those of the virtual work Σ w_k p_k δ(δ_k) = ∫ p δ(δ) dA: ∫ N p dA of the body and of the counter-body, each by its
//!   own shape functions.
//!
//! As the points are those at which the products ψ_j ψ_k are integrated exactly, ∫ ψ_j ψ_k dA = 0 for j ≠ k, and Π needs no equations. Integrals
//! are sums over the segments, inside of which the shape functions of both bodies are smooth: a constant pressure between meshes that do not match is
//! that of the discrete problem, too, whatever k_n (the patch test). By points of the body's faces alone the forces on the counter-body
//! are not those of the pressure where its faces end between these points, and the error grows with k_n.
//!
//! Pressures by faces that are eliminated: J. C. Simo, P. Wriggers & R. L. Taylor, Comput. Methods Appl. Mech. Eng. 50 (1985) 163; integrals by
//! segments, in three dimensions and of second order: M. A. Puso & T. A. Laursen, ibid. 193 (2004) 601; M. A. Puso, T. A. Laursen & J. Solberg, ibid.
//! 197 (2008) 555.

use super::candidate::{Candidate, FACING, On, Point, Sample};
use super::clip::{Point as Flat, area, clip, triangles};
use super::projection::{CounterSurface, Vector, add, cross, dot, scale, subtract, unit};
use super::surfaces::Surfaces;
use crate::mesh::{Cell, CellKind};
use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

/// Quadrature of the triangles of a segment: exact for the shape functions of all faces, and for their products with ψ up to the second order.
const DEGREE: usize = 4;
/// Parts of a face below this share of it are round-off.
const SLIVER: f64 = 1e-6;
/// Edges are followed to this part of a face.
const STRAIGHT: f64 = 1e-4;
/// Halvings of an edge at most.
const HALVINGS: usize = 4;
/// Curved faces bulge over the box of their nodes by less than this share of it.
const BULGE: f64 = 0.15;
/// Steps of Newton's method.
const STEPS: usize = 30;
/// Steps of reference coordinates below this are round-off.
const STEP: f64 = 1e-13;

/// The points of the faces that are within reach of the counter-faces and look at them; none where no face is.
pub(super) fn segments<'a>(
    surfaces: &Surfaces<'a>,
    counter: &CounterSurface<'_>,
    faces: &'a [Cell],
    reach: f64,
) -> Vec<Candidate<'a>> {
    let outlines: Vec<Vec<Vector>> =
        surfaces.faces.iter().map(|face| outline(surfaces.nodes, face)).collect();
    let quadrature: Vec<(Flat, f64)> =
        CellKind::Triangle3.quadrature(DEGREE).iter().map(|p| ([p.at[0], p.at[1]], p.weight)).collect();
    let on = |face: &'a Cell| {
        let map = FaceMap::new(surfaces.nodes, face)?;
        let cover = Cover { surfaces, counter, reach, quadrature: &quadrature };
        let covered = cover.of(&map, &outlines)?;
        points(&map, covered)
    };
    faces.iter().filter_map(on).collect()
}

/// The corners of a face and, on edges that are curved, points between them.
fn outline(nodes: &[Vector], face: &Cell) -> Vec<Vector> {
    let corners = face.kind().corners();
    let mut points = Vec::new();
    for (k, a) in corners.iter().enumerate() {
        let b = corners[(k + 1) % corners.len()];
        let at = |t: f64| face.position(nodes, std::array::from_fn(|c| a[c] + t * (b[c] - a[c])));
        let (from, way) = (at(0.0), subtract(at(1.0), at(0.0)));
        let off = cross(way, subtract(at(0.5), from));
        points.push(from);
        if dot(off, off).sqrt() > STRAIGHT * STRAIGHT * dot(way, way) {
            points.extend([0.25, 0.5, 0.75].map(at));
        }
    }
    points
}

/// A face of the body and its projection on the plane at its middle.
struct FaceMap<'a> {
    face: &'a Cell,
    nodes: &'a [Vector],
    middle: Vector,
    axes: [Vector; 2],
    /// Its nodes in the plane.
    flat: Vec<Flat>,
    /// The corners of its reference cell.
    window: Vec<Flat>,
}

impl<'a> FaceMap<'a> {
    /// `None` of a face without area.
    fn new(nodes: &'a [Vector], face: &'a Cell) -> Option<Self> {
        let corners = face.kind().corners();
        let middle = face.position(nodes, mean(corners));
        let [a, b, _] = face.tangents(nodes, mean(corners));
        let (e1, normal) = (unit(a)?, unit(cross(a, b))?);
        let axes = [e1, cross(normal, e1)];
        let window = corners.iter().map(|c| [c[0], c[1]]).collect();
        let mut map = FaceMap { face, nodes, middle, axes, flat: Vec::new(), window };
        map.flat = face.nodes().iter().map(|node| map.project(nodes[*node])).collect();
        Some(map)
    }

    fn project(&self, x: Vector) -> Flat {
        self.axes.map(|axis| dot(axis, subtract(x, self.middle)))
    }

    /// The rectangle about the face in the plane.
    fn rectangle(&self) -> [Flat; 4] {
        let [[x0, y0], [x1, y1]] = bounds(&self.flat);
        let margin = if self.face.kind().is_first_order() { 0.0 } else { BULGE * (x1 - x0).max(y1 - y0) };
        let [x0, y0, x1, y1] = [x0 - margin, y0 - margin, x1 + margin, y1 + margin];
        [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]
    }

    /// The box about the face, wider by `margin`, and its diagonal.
    fn space(&self, margin: f64) -> ([Vector; 2], f64) {
        let positions: Vec<Vector> = self.face.nodes().iter().map(|node| self.nodes[*node]).collect();
        let [low, high] = bounds(&positions);
        let way = subtract(high, low);
        let size = dot(way, way).sqrt();
        let wide = margin + if self.face.kind().is_first_order() { 0.0 } else { BULGE * size };
        ([low.map(|x| x - wide), high.map(|x| x + wide)], size)
    }

    /// The reference coordinates of a point of the plane, beyond the face, too, by Newton's method; where that fails, those of the parallelogram at
    /// the middle.
    fn reference(&self, x: Flat) -> Flat {
        let start = mean(self.face.kind().corners());
        let step = |at: Flat| {
            let at = [at[0], at[1], 0.0];
            let (mut rest, mut j) = (x, [[0.0; 2]; 2]);
            let kind = self.face.kind();
            for ((own, share), slope) in
                self.flat.iter().zip(kind.shape_functions(at)).zip(kind.shape_gradients(at))
            {
                for (i, x) in own.iter().enumerate() {
                    rest[i] -= share * x;
                    (0..2).for_each(|k| j[i][k] += slope[k] * x);
                }
            }
            let det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
            [(rest[0] * j[1][1] - rest[1] * j[0][1]) / det, (rest[1] * j[0][0] - rest[0] * j[1][0]) / det]
        };
        let mut at = [start[0], start[1]];
        let mut first = None;
        for _ in 0..STEPS {
            let step = step(at);
            at = [at[0] + step[0], at[1] + step[1]];
            first.get_or_insert(at);
            if step.iter().all(|s| s.abs() < STEP * (1.0 + at[0].abs().max(at[1].abs()))) {
                return at;
            }
        }
        first.unwrap_or(at)
    }

    /// A polygon of the plane in reference coordinates. A straight edge there is curved here where the face is no parallelogram.
    fn lifted(&self, polygon: &[Flat]) -> Vec<Flat> {
        let at: Vec<Flat> = polygon.iter().map(|x| self.reference(*x)).collect();
        let mut points = Vec::with_capacity(polygon.len());
        for k in 0..polygon.len() {
            let next = (k + 1) % polygon.len();
            points.push(at[k]);
            self.follow([polygon[k], polygon[next]], [at[k], at[next]], HALVINGS, &mut points);
        }
        points
    }

    /// The points between the ends of an edge.
    fn follow(&self, [a, b]: [Flat; 2], [at, to]: [Flat; 2], halvings: usize, points: &mut Vec<Flat>) {
        let half = |a: Flat, b: Flat| [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
        let (middle, chord) = (half(a, b), half(at, to));
        let there = self.reference(middle);
        if halvings > 0 && (0..2).any(|c| (there[c] - chord[c]).abs() > STRAIGHT) {
            self.follow([a, middle], [at, there], halvings - 1, points);
            points.push(there);
            self.follow([middle, b], [there, to], halvings - 1, points);
        }
    }
}

fn mean(corners: &[Vector]) -> Vector {
    let sum = corners.iter().fold([0.0; 3], |sum, corner| add(sum, *corner));
    scale(1.0 / corners.len() as f64, sum)
}

fn bounds<const N: usize>(points: &[[f64; N]]) -> [[f64; N]; 2] {
    let of = |pick: fn(f64, f64) -> f64, start: f64| {
        std::array::from_fn(|k| points.iter().map(|x| x[k]).fold(start, pick))
    };
    [of(f64::min, f64::INFINITY), of(f64::max, f64::NEG_INFINITY)]
}

/// What of a face is over the counter-faces.
struct Covered<'a> {
    samples: Vec<Sample<'a>>,
    /// Reference coordinates of every sample, the area of the reference cell and that of the face that it stands for.
    at: Vec<(Flat, [f64; 2])>,
    /// Whether that is all of the face.
    whole: bool,
}

/// Finds it.
struct Cover<'s, 'a, 'c> {
    surfaces: &'s Surfaces<'a>,
    counter: &'s CounterSurface<'c>,
    reach: f64,
    quadrature: &'s [(Flat, f64)],
}

impl Cover<'_, '_, '_> {
    /// `None` where next to nothing of the face is over a counter-face.
    fn of<'a>(&self, map: &FaceMap<'a>, outlines: &[Vec<Vector>]) -> Option<Covered<'a>> {
        let half = 0.5 * self.surfaces.counter.thickness();
        let foot = self.counter.foot(map.middle)?;
        let apart = foot.places.first()?.distance;
        let margin = self.reach.max(-foot.height) + half;
        let ([low, high], size) = map.space(margin);
        if apart > margin + size {
            return None;
        }
        let mut covered = Covered { samples: Vec::new(), at: Vec::new(), whole: false };
        let rectangle = map.rectangle();
        for number in self.counter.faces_in(low, high) {
            let mut polygon: Vec<Flat> = outlines[number].iter().map(|x| map.project(*x)).collect();
            if area(&polygon) < 0.0 {
                polygon.reverse();
            }
            let near = clip(&polygon, &rectangle);
            if near.len() > 2 {
                self.take(map, number, &clip(&map.lifted(&near), &map.window), &mut covered);
            }
        }
        let reference = area(&map.window);
        let share = |covered: &Covered| covered.at.iter().map(|(_, of)| of[0]).sum::<f64>() / reference;
        if share(&covered) > 1.0 + SLIVER {
            // Counter-faces over each other: the nearest one is touched.
            let tolerance = SLIVER * size;
            let near =
                |s: &Sample| s.foot.places[0].distance <= self.counter.distance(s.position) + tolerance;
            let kept: Vec<bool> = covered.samples.iter().map(near).collect();
            let (mut first, mut second) = (kept.iter(), kept.iter());
            covered.samples.retain(|_| first.next() == Some(&true));
            covered.at.retain(|_| second.next() == Some(&true));
        }
        let share = share(&covered);
        covered.whole = (share - 1.0).abs() <= SLIVER;
        (share > SLIVER).then_some(covered)
    }

    /// Takes the samples of a segment, a polygon in the reference cell over one counter-face.
    fn take<'a>(&self, map: &FaceMap<'a>, number: usize, segment: &[Flat], covered: &mut Covered<'a>) {
        let half = 0.5 * self.surfaces.counter.thickness();
        for [a, b, c] in triangles(segment) {
            let twice = 2.0 * area(&[a, b, c]);
            if twice == 0.0 {
                continue;
            }
            for ([x, y], weight) in self.quadrature {
                let at = [0, 1].map(|k| a[k] + x * (b[k] - a[k]) + y * (c[k] - a[k]));
                let place = [at[0], at[1], 0.0];
                let position = map.face.position(map.nodes, place);
                let [along, across, _] = map.face.tangents(map.nodes, place);
                let vector = cross(along, across);
                let length = dot(vector, vector).sqrt();
                let foot = self.counter.foot_on(number, position);
                let gap = foot.height - half;
                if -dot(vector, foot.normal) < FACING * length || gap > self.reach + self.counter.tolerance()
                {
                    continue;
                }
                let area = weight * twice;
                covered.at.push((at, [area, area * length]));
                covered.samples.push(Sample {
                    on: On::Face(map.face, place),
                    offset: [0.0; 3],
                    position,
                    gap,
                    foot,
                });
            }
        }
    }
}

/// The points of a face, of what of it is covered: of a whole quadrilateral those of Gauss, 2 × 2; else three.
fn points<'a>(map: &FaceMap<'a>, covered: Covered<'a>) -> Option<Candidate<'a>> {
    let at: Vec<(Flat, f64)> = covered.at.iter().map(|(at, [_, area])| (*at, *area)).collect();
    let functions = match map.window.len() {
        4 if covered.whole => gauss(&at),
        _ => three(&at)?,
    };
    let point = |(place, values): (Flat, Vec<f64>)| {
        let weight: f64 = values.iter().zip(&at).map(|(value, (_, area))| value * area).sum();
        Point {
            position: map.face.position(map.nodes, [place[0], place[1], 0.0]),
            weight,
            shares: values.iter().zip(&at).map(|(value, (_, area))| value * area / weight).collect(),
        }
    };
    let points = functions.into_iter().map(point).collect();
    Some(Candidate { samples: covered.samples, points })
}

/// The points of Gauss of a square, and ψ of each at every sample.
fn gauss(at: &[(Flat, f64)]) -> Vec<(Flat, Vec<f64>)> {
    let root = 1.0 / 3.0_f64.sqrt();
    let places = [[-root, -root], [-root, root], [root, -root], [root, root]];
    let of = |place: Flat| {
        let value = |x: Flat| 0.25 * (1.0 + 3.0 * place[0] * x[0]) * (1.0 + 3.0 * place[1] * x[1]);
        (place, at.iter().map(|(x, _)| value(*x)).collect())
    };
    places.map(of).into()
}

/// Three points of equal weight that integrate polynomials of second degree over whatever is covered: c + √2 S e_k, with its middle c, the root S of
/// its second moments ∫ (x − c)(x − c)ᵀ dA/A, and unit vectors e_k 120° apart; ψ_k = (1 + √2 e_k·S⁻¹(x − c))/3. Those of a triangle are the usual ones.
///
/// `None` of what is no wider than a line.
fn three(at: &[(Flat, f64)]) -> Option<Vec<(Flat, Vec<f64>)>> {
    let area: f64 = at.iter().map(|(_, area)| area).sum();
    let of = |value: &dyn Fn(Flat) -> f64| at.iter().map(|(x, a)| a * value(*x)).sum::<f64>() / area;
    let c = [of(&|x| x[0]), of(&|x| x[1])];
    let moment = |i: usize, k: usize| of(&|x| (x[i] - c[i]) * (x[k] - c[k]));
    let [xx, xy, yy] = [moment(0, 0), moment(0, 1), moment(1, 1)];
    // S = (C + det S I)/t with C the moments, det S = √det C and t = √(tr C + 2 det S).
    let det = (xx * yy - xy * xy).sqrt();
    let t = (xx + yy + 2.0 * det).sqrt();
    let root = [(xx + det) / t, xy / t, (yy + det) / t];
    if det.is_nan() || det <= SLIVER * SLIVER * (xx + yy) {
        return None;
    }
    // e₀ = −(1, 1)/√2, and this turned by ±120°.
    let turned = |angle: f64| {
        let (sin, cos) = angle.sin_cos();
        [-FRAC_1_SQRT_2 * (cos - sin), -FRAC_1_SQRT_2 * (sin + cos)]
    };
    let third = std::f64::consts::TAU / 3.0;
    let of = |e: Flat| {
        let place = [
            c[0] + SQRT_2 * (root[0] * e[0] + root[1] * e[1]),
            c[1] + SQRT_2 * (root[1] * e[0] + root[2] * e[1]),
        ];
        let inverse = [(root[2] * e[0] - root[1] * e[1]) / det, (root[0] * e[1] - root[1] * e[0]) / det];
        let value =
            |x: Flat| (1.0 + SQRT_2 * (inverse[0] * (x[0] - c[0]) + inverse[1] * (x[1] - c[1]))) / 3.0;
        (place, at.iter().map(|(x, _)| value(*x)).collect())
    };
    Some([0.0, third, -third].map(|angle| of(turned(angle))).into())
}
