//! How a contact changes as the counter-body travels under it.

use crate::system::ContactPoint;

/// The points of a pair at equally spaced positions of the counter-body.
///
/// The body's own part of a point stays; the counter-body's part runs over its mesh. Between the positions directions
/// and gaps are interpolated by Catmull & Rom's cubics, which are smooth and exact for what changes quadratically.
#[derive(Debug, Clone)]
pub struct Track {
    /// Travel s \[m\] of the counter-body along t₁ at the first station.
    pub first: f64,
    /// From one station to the next \[m\].
    pub spacing: f64,
    /// The points at each station, of which there are two or more; as many and in the same order as the pair has.
    pub stations: Vec<Vec<ContactPoint>>,
}

/// Stations with their shares in a place between them; what is not needed has the share 0.
pub(super) type Shares = [(usize, f64); 4];

impl Track {
    /// The shares of the stations at a travel \[m\]; beyond the ends the track runs on as it ended.
    pub(super) fn shares(&self, travel: f64) -> Shares {
        let last = self.stations.len() - 1;
        let place = (travel - self.first) / self.spacing;
        let from = (place.floor().max(0.0) as usize).min(last.saturating_sub(1));
        let x = place - from as f64;
        let (before, after) = (from.checked_sub(1), (from + 2 <= last).then_some(from + 2));
        let mut share = [
            ((2.0 - x) * x - 1.0) * x * 0.5,
            ((3.0 * x - 5.0) * x * x + 2.0) * 0.5,
            ((4.0 - 3.0 * x) * x + 1.0) * x * 0.5,
            (x - 1.0) * x * x * 0.5,
        ];
        // A station that is not there lies on the line through the two next to it.
        if before.is_none() {
            share[1] += 2.0 * share[0];
            share[2] -= share[0];
            share[0] = 0.0;
        }
        if after.is_none() {
            share[2] += 2.0 * share[3];
            share[1] -= share[3];
            share[3] = 0.0;
        }
        let stations = [before.unwrap_or(from), from, from + 1, after.unwrap_or(from)];
        std::array::from_fn(|k| (stations[k], share[k]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};

    #[test]
    fn between_stations_what_is_quadratic_is_exact_and_all_is_smooth() {
        let track = Track { first: -0.2, spacing: 0.1, stations: vec![vec![]; 6] };
        let at = |f: &dyn Fn(f64) -> f64, s: f64| -> f64 {
            track.shares(s).iter().map(|(k, share)| share * f(-0.2 + 0.1 * *k as f64)).sum()
        };
        let (line, square) = (|s: f64| 2.0 + 3.0 * s, |s: f64| (s - 0.05).powi(2));
        for k in 0..=50 {
            let s = -0.2 + 0.01 * f64::from(k);
            assert!(within((at(&line, s) - line(s)).abs(), 1e-14, RoundOff), "{s}");
            if (-0.1..=0.2).contains(&s) {
                assert!(within((at(&square, s) - square(s)).abs(), 1e-14, RoundOff), "{s}");
            }
            let rough = |s: f64| (25.0 * s).sin();
            let (h, slope) = (1e-7, |a: f64, b: f64| (at(&rough, b) - at(&rough, a)) / (b - a));
            if k % 10 == 0 && k > 0 && k < 50 {
                assert!(within((slope(s - h, s) - slope(s, s + h)).abs(), 1e-4, Reference), "{s}");
                assert!(within((at(&rough, s) - rough(s)).abs(), 1e-12, RoundOff));
            }
        }
        assert!(
            within((at(&line, -0.25) - line(-0.25)).abs(), 1e-14, RoundOff)
                && within((at(&line, 0.4) - line(0.4)).abs(), 1e-14, RoundOff)
        );
    }
}
