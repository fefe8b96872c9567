//! A plate as a sum of small pistons.

use faer::Mat;

/// Acoustic model of a flat plate: small pistons in its plane, and how much volume each displaces in each mode.
#[derive(Debug, Clone)]
pub struct Plate {
    /// Its name.
    pub name: String,
    /// Unit normal n; the front is where it points to.
    pub normal: [f64; 3],
    /// Whether its back sends out sound, too, as that of a thin plate does; that of a face of a solid does not.
    pub both_sides: bool,
    /// A point of its plane \[m\].
    pub middle: [f64; 3],
    /// Where the pistons are \[m\].
    pub points: Vec<[f64; 3]>,
    /// Volume displaced towards the front: A_i n·φ_m(x_i) \[m³ a unit of the modal coordinate\], points × modes.
    pub strength: Mat<f64>,
}

impl Plate {
    /// +1 in front of the plate, −1 behind it where its back is heard, 0 in its plane and where nothing is heard.
    pub fn side(&self, place: [f64; 3]) -> f64 {
        let ahead: f64 = (0..3).map(|k| self.normal[k] * (place[k] - self.middle[k])).sum();
        let away: f64 = (0..3).map(|k| (place[k] - self.middle[k]).powi(2)).sum::<f64>().sqrt();
        if ahead.abs() <= 1e-9 * away || ahead < 0.0 && !self.both_sides { 0.0 } else { ahead.signum() }
    }

    /// Coordinates of the pistons in the plane, from its middle \[m\].
    pub(super) fn in_plane(&self) -> Vec<[f64; 2]> {
        let n = self.normal;
        let helper = if n[0].abs() < 0.9 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
        let cross = |a: [f64; 3], b: [f64; 3]| {
            [0, 1, 2].map(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
        };
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let e1 = cross(n, helper);
        let e1 = e1.map(|x| x / dot(e1, e1).sqrt());
        let e2 = cross(n, e1);
        let from_middle = |x: &[f64; 3]| [0, 1, 2].map(|k| x[k] - self.middle[k]);
        self.points.iter().map(from_middle).map(|d| [dot(d, e1), dot(d, e2)]).collect()
    }
}

#[cfg(test)]
pub(super) mod samples {
    use super::*;
    use std::f64::consts::{PI, TAU};
    use stridor_base::bounds::{Origin::*, within};

    /// A disc of radius `a` in the plane z = 0 that moves as `shapes` say at polar coordinates (r, θ): pistons on rings
    /// by Gauss' midpoint rule.
    pub fn disc(a: f64, rings: usize, shapes: &[&dyn Fn(f64, f64) -> f64]) -> Plate {
        let (mut points, mut areas, mut polar) = (Vec::new(), Vec::new(), Vec::new());
        for ring in 0..rings {
            let r = a * (ring as f64 + 0.5) / rings as f64;
            let around = 6 * ring + 6;
            for k in 0..around {
                let angle = TAU * (k as f64 + 0.5 * (ring % 2) as f64) / around as f64;
                points.push([r * angle.cos(), r * angle.sin(), 0.0]);
                areas.push(TAU * r * (a / rings as f64) / around as f64);
                polar.push((r, angle));
            }
        }
        let strength =
            Mat::from_fn(points.len(), shapes.len(), |i, m| areas[i] * shapes[m](polar[i].0, polar[i].1));
        Plate {
            name: "disc".into(),
            normal: [0.0, 0.0, 1.0],
            both_sides: true,
            middle: [0.0; 3],
            points,
            strength,
        }
    }

    #[test]
    fn the_sample_has_the_area_of_a_disc_and_two_sides() {
        let plate = disc(0.1, 20, &[&|_, _| 1.0]);
        let area: f64 = (0..plate.points.len()).map(|i| plate.strength[(i, 0)]).sum();
        assert!(within((area / (PI * 0.01) - 1.0).abs(), 1e-12, RoundOff));
        assert_eq!([1.0, -2.0, 0.0].map(|z| plate.side([0.3, 0.0, z])), [1.0, -1.0, 0.0]);
        let face = Plate { both_sides: false, ..plate.clone() };
        assert_eq!([1.0, -2.0, 0.0].map(|z| face.side([0.3, 0.0, z])), [1.0, 0.0, 0.0]);
        let tilted = Plate { normal: [0.6, 0.0, 0.8], ..plate };
        let along = tilted.in_plane();
        assert!(along.iter().zip(&tilted.points).all(|(p, x)| within(
            p[0].hypot(p[1]) - x[0].hypot(x[1]),
            1e-15,
            RoundOff
        )));
    }
}
