//! The generalised-α family of implicit integrators.

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
