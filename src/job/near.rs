//! Which of some frequencies is meant by one that is given.

/// How far a frequency may lie from the one that is given, as a part of that.
const REACH: f64 = 0.1;

/// Index of the frequency nearest to `hz` \[Hz\]; none where none is within 10 % of it.
pub fn near(frequencies_hz: impl IntoIterator<Item = f64>, hz: f64) -> Option<usize> {
    let away = frequencies_hz.into_iter().map(|f| (f - hz).abs()).enumerate();
    let (nearest, away) = away.min_by(|a, b| a.1.total_cmp(&b.1))?;
    (away <= REACH * hz).then_some(nearest)
}

#[cfg(test)]
mod tests {
    use super::near;

    #[test]
    fn the_nearest_is_meant_where_one_is_near() {
        let all = [0.0, 100.0, 200.0];
        assert_eq!((near(all, 104.0), near(all, 0.0), near(all, 186.0)), (Some(1), Some(0), Some(2)));
        assert_eq!((near(all, 150.0), near(all, 1e5), near([], 100.0)), (None, None, None));
    }
}
