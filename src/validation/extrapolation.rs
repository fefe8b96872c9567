//! Integration of ẏ = f(t, y) to round-off, for reference solutions that share nothing with the program's integrators.

/// Rows of the extrapolation; the order is twice as many.
const ROWS: usize = 8;

/// y(t + h): Gragg's modified midpoint rule with 2, 4 … 16 parts, whose errors hold even powers of the part only,
/// extrapolated to parts of no length (R. Bulirsch & J. Stoer, Numer. Math. 8 (1966) 1). Where f is smooth the error is
/// at round-off for steps that turn the fastest oscillation by less than about half a radian.
///
/// ```
/// // ẍ = −x over a quarter of a turn, in eight steps.
/// let f = |_: f64, y: &[f64; 2]| [y[1], -y[0]];
/// let h = std::f64::consts::FRAC_PI_2 / 8.0;
/// let y = (0..8).fold([1.0, 0.0], |y, k| stridor::validation::extrapolation::step(&f, k as f64 * h, y, h));
/// assert!(y[0].abs() < 1e-13 && (y[1] + 1.0).abs() < 1e-13);
/// ```
pub fn step<const N: usize>(
    f: &impl Fn(f64, &[f64; N]) -> [f64; N],
    t: f64,
    y: [f64; N],
    h: f64,
) -> [f64; N] {
    let mut row: Vec<[f64; N]> = Vec::with_capacity(ROWS);
    for k in 0..ROWS {
        let mut next = vec![midpoint(f, t, y, h, 2 * (k + 1))];
        for (j, above) in row.iter().enumerate() {
            let ratio = (k + 1) as f64 / (k - j) as f64;
            let (last, weight) = (next[j], 1.0 / (ratio * ratio - 1.0));
            next.push(std::array::from_fn(|i| last[i] + weight * (last[i] - above[i])));
        }
        row = next;
    }
    row[ROWS - 1]
}

/// Gragg's rule with an even number of parts.
fn midpoint<const N: usize>(
    f: &impl Fn(f64, &[f64; N]) -> [f64; N],
    t: f64,
    y: [f64; N],
    h: f64,
    parts: usize,
) -> [f64; N] {
    let part = h / parts as f64;
    let moved = |y: &[f64; N], slope: [f64; N], by: f64| std::array::from_fn(|i| y[i] + by * slope[i]);
    let (mut before, mut now): ([f64; N], [f64; N]) = (y, moved(&y, f(t, &y), part));
    for k in 1..parts {
        let next = moved(&before, f(t + k as f64 * part, &now), 2.0 * part);
        (before, now) = (now, next);
    }
    let end = moved(&before, f(t + h, &now), part);
    std::array::from_fn(|i| 0.5 * (now[i] + end[i]))
}
