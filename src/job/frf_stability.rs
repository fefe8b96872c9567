//! Whether the state of a frequency response is one that motion stays near.
//!
//! A force Re(f e^{iωt}) moves the structure as Σ a_k φ_k e^{λ_k t} + Re(Q(iω)⁻¹ f e^{iωt}): the second term, the response, is what a test measures once
//! the first has died out, which it does only where Re λ_k < 0 of every mode.

use crate::error::Result;
use crate::linalg::c64;
use crate::progress::Observer;
use crate::reduction::{MODES, Receptance};
use crate::results::{ComplexResult, FrfResult};
use crate::stability::complex_modes;

/// Unstable modes that a message names.
const NAMED: usize = 5;

/// λ of the unstable modes about the state of a response up to `top_hz` \[Hz\], ascending in frequency: those of the `known` complex analysis,
/// and beyond its band those of the small model that gives the response, whose real modes reach to [`MODES`] times that frequency.
///
/// # Errors
/// Complex modes that cannot be computed.
pub(super) fn unstable_modes(
    of: &Receptance,
    top_hz: f64,
    known: Option<&ComplexResult>,
    observer: &dyn Observer,
) -> Result<Vec<c64>> {
    let counted = |hz: f64| known.is_some_and(|known| (known.band_hz[0]..=known.band_hz[1]).contains(&hz));
    let known_modes = known.iter().flat_map(|known| &known.modes.modes);
    let mut all: Vec<c64> = known_modes.filter(|mode| mode.unstable()).map(|mode| mode.eigenvalue).collect();
    if !(counted(0.0) && counted(top_hz)) {
        let (system, steady) = &of.small;
        let own = complex_modes(system, steady, &of.reduced.real_modes(), [0.0, MODES * top_hz], observer)?;
        let beyond = own.modes.iter().filter(|mode| mode.unstable() && !counted(mode.frequency_hz()));
        all.extend(beyond.map(|mode| mode.eigenvalue));
    }
    all.sort_by(|a, b| a.im.total_cmp(&b.im));
    Ok(all)
}

/// What to know of a response about an unstable state.
pub fn unsteady(frf: &FrfResult) -> Option<String> {
    (!frf.unstable.is_empty()).then(|| {
        format!(
            "frf.{}: the state about which it is computed is unstable, by {}. Motion grows and leaves that state, so that no test measures this \
             response: change the operating point until the complex modes are stable (`[cea]`), or compute the motion with `[transient]`",
            frf.name,
            frf.unstable_words(NAMED)
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::case::Case;
    use crate::job::{Prepared, Selection, analyse};
    use crate::results::RunResults;
    use std::f64::consts::TAU;

    /// A mass m on springs k, k along and into a belt that presses with N and slides at V with μ = μ₀ + μ₁ e^{−αv}: along the belt
    /// m ÿ + (c + N μ′(V)) ẏ + k y = 0.
    fn run(damping: f64, more: &str) -> RunResults {
        let text = format!(
            "[point]\ntip = [0, 0, 0]\n[mass.tip]\non = \"tip\"\nmass = 2\n[support.tip]\non = \"tip\"\nheld = [\"ux\", \"rx\", \"ry\", \"rz\"]\n\
             [spring.along]\non = \"tip\"\ndirection = [0, 1, 0]\nstiffness = 8e5\ndamping = {damping}\n\
             [spring.into]\non = \"tip\"\ndirection = [0, 0, 1]\nstiffness = 3e5\ndamping = 40\n\
             [contact.belt]\nbody = \"tip\"\ncounter = \"ground\"\ninto = [0, 0, -1]\nload = 10\nsliding_velocity = 0.5\nsliding_direction = [0, 1, 0]\n\
             normal = {{ per = \"point\", stiffness = 5e4 }}\n\
             friction = {{ law = \"exponential\", mu0 = 0.1, mu1 = 0.4, alpha = 2 }}\n\
             [frf.along]\nexcitation = {{ on = \"tip\", direction = [0, 1, 0] }}\nquantity = \"receptance\"\nband = [10, 150]\ncontact = \"sliding\"\n\
             [frf.open]\nexcitation = {{ on = \"tip\", direction = [0, 1, 0] }}\nquantity = \"receptance\"\nband = [10, 150]\n{more}"
        );
        let case = Case::parse("belt", &text, ".".into()).unwrap();
        let prepared = Prepared::new(&case).unwrap();
        analyse(&prepared, Selection::Listed, &mut |_| Ok(()), &()).unwrap()
    }

    #[test]
    fn a_response_about_an_unstable_state_names_the_modes_that_grow() {
        // N μ′(V) = −10 · 0.4 · 2 e^{−1} = −2.943 kg/s.
        let falling = -10.0 * 0.4 * 2.0 * (-1.0f64).exp();
        for (damping, more) in
            [(1.0, ""), (1.0, "[cea]\nband = [0, 400]\n"), (1.0, "[cea]\nband = [0, 50]\n")]
        {
            let results = run(damping, more);
            let [along, open] = results.all::<FrfResult>()[..] else { panic!("two responses") };
            let [found] = along.unstable[..] else { panic!("{:?}", along.unstable) };
            let sigma = -(damping + falling) / 4.0;
            let omega = (4e5 - sigma * sigma).sqrt();
            assert!(
                within((found - c64::new(sigma, omega)).norm(), 1e-8 * omega, RoundOff),
                "{more} {found}"
            );
            let warnings: Vec<_> =
                results.warnings.iter().filter(|w| w.contains("is unstable, by")).collect();
            let named = warnings.len() == 1 && warnings[0].starts_with("frf.along: ");
            let hz = format!("{:.1} Hz", omega / TAU);
            assert!(named && warnings[0].contains(&hz), "{:?}", results.warnings);
            assert!(open.unstable.is_empty());
        }
        let stable = run(4.0, "");
        assert!(stable.all::<FrfResult>().iter().all(|frf| frf.unstable.is_empty()));
        assert!(!stable.warnings.iter().any(|words| words.contains("is unstable, by")));
    }
}
