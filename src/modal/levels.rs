//! Levels of real modes: a single one, or the two of a double one, of which only the space that they span has a meaning.

use super::DiscModeName;
use std::ops::Range;

/// Two neighbours of one name are a level where their frequencies differ by less than this part. What is round has them
/// equal; a mesh that is not parts them, that of `meshes/rig-medium.msh` by 6e-4 at most, and a test resolves frequencies to about
/// 5e-3.
const OF_ONE_NAME: f64 = 2e-3;
/// The same without names, where the two may be neighbours by chance: as near as this one pair in a thousand is, where modes lie
/// a tenth of their frequency apart.
const WITHOUT_NAMES: f64 = 1e-4;

/// The levels of modes that ascend in frequency. Modes that a whole disc has once, without nodal diameters, are single.
pub fn levels(frequencies_hz: &[f64], names: &[Option<DiscModeName>]) -> Vec<Range<usize>> {
    let doublet = |a: usize, b: usize| {
        let near = match names[a] {
            Some(name) if name.nodal_diameters == 0 => 0.0,
            Some(_) => OF_ONE_NAME,
            None => WITHOUT_NAMES,
        };
        names[a] == names[b] && frequencies_hz[b] - frequencies_hz[a] < near * frequencies_hz[b]
    };
    let mut all: Vec<Range<usize>> = Vec::new();
    for k in 0..frequencies_hz.len() {
        match all.last_mut().filter(|level| level.len() == 1 && doublet(level.start, k)) {
            Some(level) => level.end = k + 1,
            None => all.push(k..k + 1),
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_of_one_name_are_a_level_and_those_that_meet_by_chance_are_not() {
        let name = |nodal_diameters, nodal_circles| Some(DiscModeName { nodal_diameters, nodal_circles });
        // (6, 0) and (2, 1) of a disc lie nearer to each other than a mesh may part the two of either.
        let hz = [1000.0, 1001.5, 2099.0, 2099.1, 2100.0, 2100.1, 2100.2, 2800.0, 2810.0, 3000.0, 3000.1];
        let names = [(4, 0), (4, 0), (6, 0), (6, 0), (2, 1), (2, 1), (2, 1), (7, 0), (7, 0), (0, 2), (0, 2)];
        let named: Vec<_> = names.iter().map(|(n, s)| name(*n, *s)).collect();
        assert_eq!(levels(&hz, &named), [0..2, 2..4, 4..6, 6..7, 7..8, 8..9, 9..10, 10..11]);
        assert_eq!(levels(&[100.0, 100.005, 100.05, 100.07], &[None; 4]), [0..2, 2..3, 3..4]);
        assert_eq!(levels(&[100.0, 100.001], &[name(1, 0), None]), [0..1, 1..2]);
        assert!(levels(&[], &[]).is_empty());
    }
}
