//! The generalised-α family of implicit integrators.

use crate::linalg::c64;

/// With X_{n+1−α} = (1−α) X_{n+1} + α X_n, the equation of motion is met as
///
/// M a_{n+1−α_m} + C v_{n+1−α_f} + K u_{n+1−α_f} + r_{n+1−α_f} = f_{n+1−α_f},
///
/// with Newmark's u_{n+1} = u_n + Δt v_n + Δt²[(½−β) a_n + β a_{n+1}], v_{n+1} = v_n + Δt[(1−γ) a_n + γ a_{n+1}]
/// (Chung & Hulbert, J. Appl. Mech. 60 (1993) 371). The contact forces r are taken at the α-level, too: at n+1 the
/// order would drop to one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scheme {
    /// α_m.
    pub alpha_m: f64,
    /// α_f.
    pub alpha_f: f64,
    /// β.
    pub beta: f64,
    /// γ.
    pub gamma: f64,
}

impl Scheme {
    /// Newmark's β = ¼, γ = ½: second order, no numerical damping, energy of a linear system conserved.
    pub const TRAPEZOIDAL: Scheme = Scheme::newmark(0.25, 0.5);

    /// Newmark's method. Unconditionally stable for 2β ≥ γ ≥ ½, second order for γ = ½ only.
    pub const fn newmark(beta: f64, gamma: f64) -> Scheme {
        Scheme { alpha_m: 0.0, alpha_f: 0.0, beta, gamma }
    }

    /// Hilber, Hughes & Taylor's method for α ∈ \[−1/3, 0\]: α_f = −α, γ = ½ − α, β = (1 − α)²/4. Second order; damps
    /// what Δt does not resolve (Earthq. Eng. Struct. Dyn. 5 (1977) 283).
    pub fn hht(alpha: f64) -> Scheme {
        Scheme { alpha_m: 0.0, alpha_f: -alpha, beta: 0.25 * (1.0 - alpha).powi(2), gamma: 0.5 - alpha }
    }

    /// Chung & Hulbert's method with the spectral radius ρ∞ ∈ \[0, 1\] at infinite frequency: second order, the least
    /// damping of low frequencies for that of high ones.
    pub fn generalised_alpha(rho: f64) -> Scheme {
        let (alpha_m, alpha_f) = ((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0));
        let shift = alpha_f - alpha_m;
        Scheme { alpha_m, alpha_f, beta: 0.25 * (1.0 + shift).powi(2), gamma: 0.5 + shift }
    }

    /// The scheme of the steps at whose beginning or end a point sticks whose friction at rest is set-valued; `None` where this
    /// one does.
    ///
    /// A point that sticks has v_{n+1} = v_n, so that a_{n+1} = −((1−γ)/γ) a_n, and the force that holds it changes with a. For
    /// γ = ½ it alternates for ever; HHT with α = −0.05 has 0.82.
    pub fn for_sticking(&self) -> Option<Scheme> {
        (self.gamma <= 0.5).then(|| Scheme::hht(-0.05))
    }

    /// By how much the scheme itself changes σ \[1/s\] of an oscillation of `omega` \[rad/s\] without damping in steps of `step`
    /// seconds: ln|ζ|/Δt with ζ the larger of the two roots that follow the motion, negative for numerical damping. With
    /// z = (ωΔt)² the three roots of the amplification matrix of (u, Δt v, Δt² a) solve
    /// p₃ζ³ + p₂ζ² + p₁ζ + p₀ = 0 with, for a = 1−α_m, b = 1−α_f,
    ///
    /// (a ζ + α_m)(ζ − 1)² + z (b ζ + α_f)(β ζ² + (½ + γ − 2β) ζ + ½ − γ + β) = 0.
    pub fn own_growth(&self, omega: f64, step: f64) -> f64 {
        let Scheme { alpha_m, alpha_f, beta, gamma } = *self;
        let z = (omega * step).powi(2);
        let value = |x: c64| {
            let (inertia, spring) = ((1.0 - alpha_m) * x + alpha_m, (1.0 - alpha_f) * x + alpha_f);
            inertia * (x - 1.0) * (x - 1.0)
                + z * spring * (beta * x * x + (0.5 + gamma - 2.0 * beta) * x + (0.5 - gamma + beta))
        };
        // Newton's method from the exact root; where that is not in its reach the step does not follow the motion at all.
        let mut x = c64::from_polar(1.0, omega * step);
        for _ in 0..50 {
            let h = 1e-6;
            let slope = (value(x + h) - value(x - h)) / (2.0 * h);
            let change = value(x) / slope;
            x -= change;
            if change.norm() < 1e-14 {
                break;
            }
        }
        x.norm().ln() / step
    }
}

/// The constants of a scheme at one time step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Weights {
    /// The scheme.
    pub(super) scheme: Scheme,
    /// Δt \[s\].
    pub(super) step: f64,
    /// 1/(β Δt²).
    pub(super) inertia: f64,
    /// c₁ = γ/(β Δt): how u_{n+1} enters v_{n+1}.
    pub(super) rate: f64,
}

impl Weights {
    pub(super) fn new(scheme: Scheme, step: f64) -> Self {
        let Scheme { beta, gamma, .. } = scheme;
        Weights { scheme, step, inertia: 1.0 / (beta * step * step), rate: gamma / (beta * step) }
    }

    /// The factors of u, v and a in u_t = u + Δt v + Δt² (½ − β) a, the displacement predicted without a_{n+1}.
    pub(super) fn predicted(&self) -> [f64; 3] {
        [1.0, self.step, self.step * self.step * (0.5 - self.scheme.beta)]
    }

    /// The factors of u, v and a in v_t = v + Δt (1 − γ) a.
    pub(super) fn predicted_rate(&self) -> [f64; 3] {
        [0.0, 1.0, self.step * (1.0 - self.scheme.gamma)]
    }

    /// 1 − α_f, the share of n+1 in what is taken at the α-level.
    pub(super) fn share(&self) -> f64 {
        1.0 - self.scheme.alpha_f
    }

    /// A = (1−α_m)/(β Δt²) M + (1−α_f) c₁ C + (1−α_f) K: the factors of M, C and K.
    pub(super) fn effective(&self) -> [f64; 3] {
        [(1.0 - self.scheme.alpha_m) * self.inertia, self.share() * self.rate, self.share()]
    }
}
