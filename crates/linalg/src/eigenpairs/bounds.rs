//! Bounds between eigenvalues that are known, and where others are to be expected.

/// Half the distance of the two certifying shifts, relative to the bound.
pub(super) const APART: f64 = 1e-5;

/// A bound next to the wanted one with space for two shifts around it: the wanted bound itself unless an eigenvalue
/// sits on it, else the middle of the next gap above. `values` ascend; those from `first_above` on are not below the
/// bound, and nothing else lies below `beyond`.
pub(super) fn gap(values: &[f64], first_above: usize, bound: f64, beyond: f64) -> (f64, [f64; 2]) {
    let near = 1e-9 * bound;
    let reach = APART * bound;
    let mut k = first_above;
    loop {
        let low = if k > 0 { values[k - 1] } else { 0.0 };
        let high = values.get(k).copied().unwrap_or(beyond);
        let at = if bound - low > near { bound } else { 0.5 * (low + high) };
        if (at - low > near && high - at > near) || k >= values.len() {
            return (at, [at - reach.min(0.5 * (at - low)), at + reach.min(0.5 * (high - at))]);
        }
        k += 1;
    }
}

/// Where the eigenvalue number `count` lies, as those known from the lowest on have it: their number grows with a power
/// of θ. `None` when there are too few.
pub(super) fn extrapolated(known: &[f64], count: usize) -> Option<f64> {
    if let Some(value) = known.get(count - 1) {
        return Some(*value);
    }
    let (m, half) = (known.len(), known.len() / 2);
    let (last, middle) = (*known.last()?, *known.get(half.checked_sub(1)?)?);
    // Rigid bodies say nothing of the power.
    if m < 8 || middle <= 1e-6 * last {
        return None;
    }
    // From bending of a beam, N ~ θ^¼, to a solid, N ~ θ^(3/2).
    let power = ((m as f64 / half as f64).ln() / (last / middle).ln()).clamp(0.25, 1.5);
    Some(last * (count as f64 / m as f64).powf(1.0 / power))
}
