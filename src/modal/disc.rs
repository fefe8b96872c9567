//! Recognises a plate that is a disc, and gives its nodes polar coordinates so that its modes can be named.

use super::{DiscModeName, DiscPoints};
use crate::linalg::c64;
use nalgebra::{Matrix4, Vector3, Vector4};
use std::collections::BTreeMap;

/// Nodes that move by less than this part of rotation times radius stand on nodal lines; a wave of a hundred lobes around moves them by
/// a hundredth.
const STANDING: f64 = 1e-4;

/// A complex motion stands where the part that lags by a quarter of a period has less than this of the energy of the other.
const STANDS: f64 = 0.1;

/// A flat round plate, with or without a hole.
#[derive(Debug, Clone)]
pub struct Disc {
    /// Unit normal.
    pub normal: Vector3<f64>,
    /// The centre of its outer edge \[m\].
    pub centre: Vector3<f64>,
    /// Nodes of the disc, ascending.
    pub nodes: Vec<usize>,
    /// (r \[m\], θ \[rad\]) of each node about the centre.
    pub polar: Vec<(f64, f64)>,
    /// Unit vectors along θ = 0 and θ = 90°.
    axes: [Vector3<f64>; 2],
    points: DiscPoints,
}

impl Disc {
    /// The disc that the `faces` are, each given by its corners, if they are one: flat, with an outer edge of one radius (to 2 %) and
    /// at most one hole.
    pub fn recognise(faces: &[&[usize]], positions: &[[f64; 3]]) -> Option<Disc> {
        let at = |node: usize| Vector3::from(positions[node]);
        let first = faces.first()?;
        let normal =
            (at(first[1]) - at(first[0])).cross(&(at(first[2]) - at(first[0]))).try_normalize(0.0)?;
        let edge: Vec<Vector3<f64>> = boundary_nodes(faces).into_iter().map(at).collect();
        let centre = centre_of_rim(&edge)?;
        let mut nodes: Vec<usize> = faces.concat();
        nodes.sort_unstable();
        nodes.dedup();
        let outer = edge.iter().map(|x| (x - centre).norm()).fold(0.0, f64::max);
        let (rim, hub): (Vec<f64>, Vec<f64>) =
            edge.iter().map(|x| (x - centre).norm() / outer).partition(|r| *r > 0.98);
        let hub_radius = hub.iter().copied().fold(0.0, f64::max);
        let round = rim.len() >= 12 && hub_radius < 0.9 && hub.iter().all(|r| *r > 0.9 * hub_radius);
        let flat = nodes.iter().all(|n| (at(*n) - centre).dot(&normal).abs() < 1e-6 * outer);
        if !round || !flat {
            return None;
        }
        let helper = if normal.x.abs() < 0.9 { Vector3::x() } else { Vector3::y() };
        let e1 = normal.cross(&helper).try_normalize(0.0)?;
        let e2 = normal.cross(&e1);
        let polar: Vec<(f64, f64)> = nodes
            .iter()
            .map(|n| {
                let d = at(*n) - centre;
                (d.norm(), d.dot(&e2).atan2(d.dot(&e1)))
            })
            .collect();
        let points = DiscPoints::new(&polar)?;
        Some(Disc { normal, centre, nodes, polar, axes: [e1, e2], points })
    }

    /// Nodal diameters and circles of the bending in a shape, given by the displacement \[m\] and rotation \[rad\] of each node;
    /// `None` when the disc moves more in its plane than across it, when all nodes stand on nodal lines, when the shape has
    /// shorter waves than the nodes resolve, or when [`DiscPoints::name`] has none.
    pub fn name(&self, motion: impl Fn(usize) -> [f64; 6]) -> Option<DiscModeName> {
        let motions: Vec<[f64; 6]> = self.nodes.iter().map(|node| motion(*node)).collect();
        let moved: Vec<Vector3<f64>> = motions.iter().map(|[x, y, z, ..]| Vector3::new(*x, *y, *z)).collect();
        let largest = |along: &dyn Fn(&[f64; 6]) -> f64| motions.iter().map(along).fold(0.0, f64::max);
        let [moves, turns] = [0, 3].map(|at| {
            largest(&|motion| motion[at..at + 3].iter().fold(0.0f64, |most, part| most.max(part.abs())))
        });
        let outer = self.polar.iter().map(|(r, _)| *r).fold(0.0, f64::max);
        if moves < STANDING * outer * turns {
            return None;
        }
        let transverse: Vec<f64> = moved.iter().map(|u| u.dot(&self.normal)).collect();
        let across: f64 = transverse.iter().map(|w| w * w).sum();
        let whole: f64 = moved.iter().map(Vector3::norm_squared).sum();
        // The nodes turn about the radius by (1/r) ∂w/∂θ and across it by ∂w/∂r, also where they are too few to resolve a short wave
        // from a long one by w alone.
        let mut waves = [0.0; 2];
        for (motion, (r, angle)) in motions.iter().zip(&self.polar) {
            let turned = Vector3::new(motion[3], motion[4], motion[5]);
            let [x, y] = self.axes.map(|axis| axis.dot(&turned));
            let (sin, cos) = angle.sin_cos();
            waves[0] += (r * (x * cos + y * sin)).powi(2);
            waves[1] += (y * cos - x * sin).powi(2);
        }
        let shortest = self.points.highest_wave_numbers();
        let short = waves.iter().zip(shortest).any(|(wave, most)| *wave > most * most * across);
        let resolved = across > 0.5 * whole && !short;
        if resolved { self.points.name(&transverse) } else { None }
    }

    /// The same of a complex shape. At the instant when a motion that stands has its largest deflection it has all its energy; one that
    /// travels around has the same nodal diameters a quarter of a period later.
    pub fn name_complex(&self, motion: impl Fn(usize) -> [c64; 6]) -> Option<DiscModeName> {
        let across = |node: &usize| {
            let [x, y, z, ..] = motion(*node);
            x * self.normal.x + y * self.normal.y + z * self.normal.z
        };
        let turn = c64::cis(-0.5 * self.nodes.iter().map(|n| across(n).powi(2)).sum::<c64>().arg());
        let energy = |part: fn(c64) -> f64| -> f64 {
            self.nodes.iter().map(|node| part(turn * across(node)).powi(2)).sum()
        };
        let [first, later] = [energy(|w| w.re), energy(|w| w.im)];
        let name = self.name(|node| motion(node).map(|u| (turn * u).re))?;
        let stands = later < STANDS * first;
        let same = || {
            let other = self.name(|node| motion(node).map(|u| (turn * u).im));
            other.is_some_and(|other| other.nodal_diameters == name.nodal_diameters)
        };
        (stands || same()).then_some(name)
    }
}

/// Nodes on edges that belong to one face only.
fn boundary_nodes(faces: &[&[usize]]) -> Vec<usize> {
    let mut faces_at: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for n in faces {
        for i in 0..n.len() {
            let (a, b) = (n[i], n[(i + 1) % n.len()]);
            *faces_at.entry((a.min(b), a.max(b))).or_default() += 1;
        }
    }
    let mut nodes: Vec<usize> =
        faces_at.iter().filter(|(_, count)| **count == 1).flat_map(|((a, b), _)| [*a, *b]).collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// The centre of the circle that fits the outer edge nodes best, however unevenly they are spread: least squares of
/// |x|² = 2 c·x + (r² − |c|²), held in the plane by a ridge of 1e-9.
fn centre_of_rim(edge: &[Vector3<f64>]) -> Option<Vector3<f64>> {
    let low = edge.iter().copied().reduce(|a, b| a.inf(&b))?;
    let high = edge.iter().copied().reduce(|a, b| a.sup(&b))?;
    let middle = 0.5 * (low + high);
    let far = edge.iter().map(|x| (x - middle).norm()).fold(0.0, f64::max);
    let rim: Vec<Vector3<f64>> = edge.iter().map(|x| (x - middle) / far).filter(|d| d.norm() > 0.9).collect();
    let mut normal_matrix = Matrix4::<f64>::identity() * (1e-9 * rim.len() as f64);
    let mut right_side = Vector4::<f64>::zeros();
    for d in &rim {
        let row = Vector4::new(2.0 * d.x, 2.0 * d.y, 2.0 * d.z, 1.0);
        normal_matrix += row * row.transpose();
        right_side += row * d.norm_squared();
    }
    let fit = normal_matrix.lu().solve(&right_side)?;
    Some(middle + far * Vector3::new(fit.x, fit.y, fit.z))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};

    /// A ring of quadrilaterals in a tilted plane, its nodes crowded on one side.
    #[test]
    fn a_tilted_annulus_with_uneven_nodes_is_a_disc() {
        let (n, centre) = (48, Vector3::new(1.0, 2.0, 3.0));
        let (e1, e2) = (Vector3::new(0.6, 0.0, 0.8), Vector3::new(0.0, 1.0, 0.0));
        let mut nodes = Vec::new();
        for radius in [0.3, 0.7, 1.0] {
            for i in 0..n {
                let t = std::f64::consts::TAU * i as f64 / n as f64;
                let angle = t + 0.8 * t.sin();
                nodes.push((centre + radius * (angle.cos() * e1 + angle.sin() * e2)).into());
            }
        }
        let quad = |ring: usize, i: usize| {
            let j = (i + 1) % n;
            [ring * n + i, ring * n + n + i, ring * n + n + j, ring * n + j]
        };
        let faces: Vec<[usize; 4]> = (0..2).flat_map(|ring| (0..n).map(move |i| quad(ring, i))).collect();
        let faces: Vec<&[usize]> = faces.iter().map(|face| &face[..]).collect();
        let disc = Disc::recognise(&faces, &nodes).expect("it is a disc");
        for (k, node) in disc.nodes.iter().enumerate() {
            let expected = [0.3, 0.7, 1.0][node / n];
            // The ridge of 1e-9 in the fit of the centre.
            assert!(
                within((disc.polar[k].0 - expected).abs(), 1e-8, Discretisation),
                "{} {expected}",
                disc.polar[k].0
            );
        }
        assert!(within((disc.normal.dot(&e1)).abs(), 1e-12, RoundOff));
    }

    /// Waves about an annulus that stand, or travel at any phase, have their diameters; two that travel alike have none.
    #[test]
    fn standing_and_travelling_waves_have_their_names() {
        let (around, rings) = (96, 9);
        let mut nodes = Vec::new();
        for ring in 0..rings {
            for i in 0..around {
                let (radius, angle) = (
                    0.3 + 0.7 * ring as f64 / (rings - 1) as f64,
                    std::f64::consts::TAU * i as f64 / around as f64,
                );
                nodes.push([radius * angle.cos(), radius * angle.sin(), 0.0]);
            }
        }
        let quad = |ring: usize, i: usize| {
            let j = (i + 1) % around;
            [ring * around + i, ring * around + around + i, ring * around + around + j, ring * around + j]
        };
        let faces: Vec<[usize; 4]> =
            (0..rings - 1).flat_map(|ring| (0..around).map(move |i| quad(ring, i))).collect();
        let faces: Vec<&[usize]> = faces.iter().map(|face| &face[..]).collect();
        let disc = Disc::recognise(&faces, &nodes).unwrap();
        let wave = |n: f64, s: usize, [forward, backward]: [c64; 2]| {
            let (disc, nodes) = (&disc, &nodes);
            move |node: usize| -> c64 {
                let [x, y, _] = nodes[node];
                let (r, angle) = (x.hypot(y), y.atan2(x));
                let along = if s == 0 { r * r } else { 0.65 - r };
                assert!(disc.normal.z.abs() > 0.5);
                (forward * c64::cis(n * angle) + backward * c64::cis(-n * angle)) * along
            }
        };
        let named = |w: &dyn Fn(usize) -> c64| {
            let zero = c64::new(0.0, 0.0);
            let name = disc.name_complex(|node| [zero, zero, w(node), zero, zero, zero]);
            name.map(|name| (name.nodal_diameters, name.nodal_circles))
        };
        let [one, none, turned] = [c64::new(1.0, 0.0), c64::new(0.0, 0.0), c64::new(0.3, -0.4)];
        for (n, s) in [(0, 0), (1, 0), (2, 1), (5, 0), (8, 1)] {
            for parts in [[one, one], [turned, none], [none, one], [one, turned]] {
                assert_eq!(named(&wave(f64::from(n), s, parts)), Some((n as usize, s)), "{parts:?}");
            }
        }
        let (two, five) = (wave(2.0, 0, [one, none]), wave(5.0, 0, [one, none]));
        assert_eq!(named(&|node| two(node) + five(node)), None);
    }

    #[test]
    fn a_rectangle_is_no_disc() {
        let (n, m) = (9, 6);
        let nodes: Vec<[f64; 3]> = (0..n * m).map(|k| [(k % n) as f64, (k / n) as f64, 0.0]).collect();
        let face = |i: usize, j: usize| [j * n + i, j * n + i + 1, j * n + i + n + 1, j * n + i + n];
        let faces: Vec<[usize; 4]> = (0..m - 1).flat_map(|j| (0..n - 1).map(move |i| face(i, j))).collect();
        let faces: Vec<&[usize]> = faces.iter().map(|face| &face[..]).collect();
        assert!(Disc::recognise(&faces, &nodes).is_none());
    }
}
