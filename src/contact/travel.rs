//! Contacts whose counter-body travels under them.

use crate::mesh::{Cell, cell_nodes};
use crate::system::ContactPoint;
use nalgebra::Vector3;

/// Stations on each element of the counter-body.
const STATIONS: f64 = 2.0;

/// The points of a pair at equally spaced travels of its counter-body; one of them is zero.
#[derive(Debug, Clone)]
pub struct Stations {
    /// Travel s of the counter-body along the sliding direction at the first station \[m\].
    pub first: f64,
    /// From one station to the next \[m\].
    pub spacing: f64,
    /// The points at each station, of which there are two or more.
    pub points: Vec<Vec<ContactPoint>>,
}

impl Stations {
    /// From the least to the greatest travel \[m\], two on each element of the counter-body, whose edges are `edge` \[m\] long;
    /// `at` gives the points at a travel. `None` where it has none.
    pub fn new(
        [least, greatest]: [f64; 2],
        edge: f64,
        at: impl Fn(f64) -> Option<Vec<ContactPoint>>,
    ) -> Option<Stations> {
        let spacing = edge / STATIONS;
        let first = (least / spacing).floor() as i64;
        let last = ((greatest / spacing).ceil() as i64).max(first + 1);
        let points = (first..=last).map(|k| at(k as f64 * spacing)).collect::<Option<_>>()?;
        Some(Stations { first: first as f64 * spacing, spacing, points })
    }
}

/// The nodes with those of `faces` moved by `travel` \[m\] along a direction of whatever length.
pub fn travelled(nodes: &[[f64; 3]], faces: &[Cell], direction: [f64; 3], travel: f64) -> Vec<[f64; 3]> {
    let way = Vector3::from(direction).normalize() * travel;
    let mut nodes = nodes.to_vec();
    cell_nodes(faces).into_iter().for_each(|node| nodes[node] = (Vector3::from(nodes[node]) + way).into());
    nodes
}

/// The mean length of the edges of `faces` \[m\], those of two faces counted twice; zero without any.
pub fn mean_edge<'a>(nodes: &[[f64; 3]], faces: impl IntoIterator<Item = &'a Cell>) -> f64 {
    let (mut sum, mut count) = (0.0, 0);
    for face in faces {
        let corners = face.corners();
        for (k, a) in corners.iter().enumerate() {
            let b = corners[(k + 1) % corners.len()];
            sum += (0..3).map(|i| (nodes[*a][i] - nodes[b][i]).powi(2)).sum::<f64>().sqrt();
            count += 1;
        }
    }
    sum / f64::from(count.max(1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};

    #[test]
    fn stations_reach_over_the_way_and_one_is_where_the_pair_stands() {
        let nodes = [[0.0, 0.0, 0.0], [0.3, 0.0, 0.0], [0.0, 0.4, 0.0], [9.0; 3]];
        let faces = [Cell::triangle([0, 1, 2])];
        let edge = mean_edge(&nodes, &faces);
        assert!(within((edge - 0.4).abs(), 1e-15, RoundOff));
        let stations = Stations::new([-0.3, 0.5], edge, |_| Some(Vec::new())).unwrap();
        let near = |a: f64, b: f64| within((a - b).abs(), 1e-15, RoundOff);
        assert!(near(stations.first, -0.4) && near(stations.spacing, 0.2) && stations.points.len() == 6);
        let still = Stations::new([0.0, 0.0], edge, |_| Some(Vec::new())).unwrap();
        assert_eq!((still.first, still.points.len()), (0.0, 2));
        assert!(Stations::new([0.0, 1.0], edge, |s| (s < 0.7).then(Vec::new)).is_none());
        let moved = travelled(&nodes, &faces, [0.0, 2.0, 0.0], 0.5);
        assert_eq!(moved, [[0.0, 0.5, 0.0], [0.3, 0.5, 0.0], [0.0, 0.9, 0.0], [9.0; 3]]);
    }
}
