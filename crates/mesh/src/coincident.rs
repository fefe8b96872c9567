//! Nodes at the same place.

use super::quality::{dot, minus, norm};

/// Nodes closer than this share of the bounding box's diagonal are coincident.
const COINCIDENT: f64 = 1e-6;

/// Pairs of coincident places as indices, the lower first: of each place with one other, so that a heap of them is a chain.
pub fn coincident(places: &[[f64; 3]]) -> Vec<[usize; 2]> {
    let end = |pick: fn(f64, f64) -> f64, start: f64| -> [f64; 3] {
        std::array::from_fn(|k| places.iter().map(|p| p[k]).fold(start, pick))
    };
    let tolerance = COINCIDENT * norm(minus(end(f64::max, f64::NEG_INFINITY), end(f64::min, f64::INFINITY)));
    if places.is_empty() || tolerance == 0.0 {
        return Vec::new();
    }
    // Along a skew direction hardly any but coincident nodes are neighbours.
    let mut order: Vec<(f64, usize)> =
        places.iter().enumerate().map(|(n, p)| (dot(*p, [0.577, 0.613, 0.541]), n)).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut pairs: Vec<[usize; 2]> = Vec::new();
    for (k, (s, n)) in order.iter().enumerate() {
        let mut near =
            order[k + 1..].iter().take_while(|other| other.0 - s <= tolerance).map(|other| other.1);
        let partner = near.find(|m| norm(minus(places[*n], places[*m])) <= tolerance);
        pairs.extend(partner.map(|m| [*n.min(&m), *n.max(&m)]));
    }
    pairs.sort_unstable();
    pairs
}
