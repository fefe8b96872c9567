//! Measured data, as plain data in SI units.

use stridor_linalg::c64;
use stridor_schema::choices;

/// Everything of one test: where, which modes, which frequency responses.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MeasuredSet {
    /// The points of the test.
    pub points: Vec<MeasuredPoint>,
    /// Where and along what the mode shapes were measured.
    pub dofs: Vec<MeasuredDof>,
    /// The modes, ascending in frequency.
    pub modes: Vec<MeasuredMode>,
    /// The frequency responses, in the order of the file.
    pub frfs: Vec<MeasuredFrf>,
}

/// A point of a test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredPoint {
    /// Its number in the test.
    pub id: u64,
    /// Its coordinates in the frame of the test \[m\].
    pub position: [f64; 3],
}

/// A place and a direction of a test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredDof {
    /// Index into [`MeasuredSet::points`].
    pub point: usize,
    /// A unit vector in the frame of the test; zero where the test does not state it.
    pub direction: [f64; 3],
}

/// A mode that was measured.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredMode {
    /// Its undamped natural frequency |λ|/2π \[Hz\].
    pub frequency_hz: f64,
    /// ζ = −Re λ/|λ|.
    pub damping_ratio: Option<f64>,
    /// Standard deviation of the frequency over the frequency.
    pub deviation: Option<f64>,
    /// Displacement at each of [`MeasuredSet::dofs`], in whatever scale.
    pub shape: Option<Vec<c64>>,
}

impl MeasuredMode {
    /// The shape of a real mode that it is nearest to: Re(ψ e^{iα}) with the phase α in which it is largest, the imaginary
    /// rest left out (Ewins, Modal Testing, 2nd ed. 2000, on complex modes made real).
    pub fn real_shape(&self) -> Option<Vec<f64>> {
        let shape = self.shape.as_ref()?;
        // Σ Re(ψ e^{iα})² = ½ Σ |ψ|² + ½ Re(e^{2iα} Σ ψ²).
        let square: c64 = shape.iter().map(|v| v * v).sum();
        let turn = c64::from_polar(1.0, -0.5 * square.arg());
        Some(shape.iter().map(|v| (v * turn).re).collect())
    }
}

/// A frequency response that was measured.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredFrf {
    /// Name in the test.
    pub name: String,
    /// Receptance, mobility or accelerance.
    pub quantity: Quantity,
    /// Where the force acts.
    pub excitation: MeasuredDof,
    /// Where motion was measured.
    pub response: MeasuredDof,
    /// Frequencies \[Hz\], ascending.
    pub frequencies_hz: Vec<f64>,
    /// Motion over force at each of them, in the SI unit of the quantity; the motion leads where the phase is positive.
    pub values: Vec<c64>,
}

choices! {
    /// Motion that is divided by the force.
    pub enum Quantity {
        /// Displacement: u/F \[m/N\].
        Receptance = "receptance",
        /// Velocity: iω u/F \[m/(N s)\].
        Mobility = "mobility",
        /// Acceleration: −ω² u/F \[1/kg\].
        Accelerance = "accelerance",
    }
}

impl Quantity {
    /// All of them, in the order of differentiation.
    pub const ALL: [Quantity; 3] = [Quantity::Receptance, Quantity::Mobility, Quantity::Accelerance];

    /// The SI unit.
    pub fn unit(self) -> &'static str {
        match self {
            Quantity::Receptance => "m/N",
            Quantity::Mobility => "m/(N s)",
            Quantity::Accelerance => "m/(N s^2)",
        }
    }

    /// (iω)ⁿ, which leads from displacement to the quantity at `hz`.
    pub fn factor(self, hz: f64) -> c64 {
        let turn = c64::new(0.0, std::f64::consts::TAU * hz);
        match self {
            Quantity::Receptance => c64::new(1.0, 0.0),
            Quantity::Mobility => turn,
            Quantity::Accelerance => turn * turn,
        }
    }
}
