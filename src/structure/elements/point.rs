//! Point masses, springs and dashpots.

use super::{Acting, ElementMatrix, FiniteElement};
use crate::structure::{PointMass, Spring};

/// The diagonal of M of a point mass on (ux, uy, uz, rx, ry, rz) \[kg, kg m²\].
pub fn mass_diagonal(point: &PointMass) -> [f64; 6] {
    let [ix, iy, iz] = point.inertia;
    [point.mass, point.mass, point.mass, ix, iy, iz]
}

/// The unit vector a on (ux, uy, uz, rx, ry, rz) of one end: the spring's matrix is k a aᵀ to the ground, and
/// k (a, −a)(a, −a)ᵀ between two nodes. `None` when the direction has no length.
pub fn spring_direction(spring: &Spring) -> Option<[f64; 6]> {
    let norm = spring.direction.iter().map(|d| d * d).sum::<f64>().sqrt();
    if !(norm > 0.0 && norm.is_finite()) {
        return None;
    }
    let mut a = [0.0; 6];
    let offset = if spring.rotational { 3 } else { 0 };
    for (k, d) in spring.direction.iter().enumerate() {
        a[offset + k] = d / norm;
    }
    Some(a)
}

/// A concentrated mass, 6 freedoms.
pub struct MassElement<'a> {
    point: &'a PointMass,
    coordinates: &'a [[f64; 3]],
}

impl<'a> MassElement<'a> {
    /// The mass on a node with coordinates \[m\] among the given ones.
    pub fn new(point: &'a PointMass, coordinates: &'a [[f64; 3]]) -> Self {
        MassElement { point, coordinates }
    }
}

impl FiniteElement for MassElement<'_> {
    fn nodes(&self) -> &[usize] {
        std::slice::from_ref(&self.point.node)
    }

    fn acting(&self) -> Acting {
        let heavy = mass_diagonal(self.point).into_iter().enumerate().filter(|(_, mass)| *mass > 0.0);
        Acting::Along(heavy.map(|(k, _)| std::array::from_fn(|i| if i == k { 1.0 } else { 0.0 })).collect())
    }

    fn mass(&self, m: &mut ElementMatrix) -> bool {
        mass_diagonal(self.point).into_iter().enumerate().for_each(|(k, mass)| m.set(k, k, mass));
        true
    }

    fn mass_and_center(&self) -> (f64, [f64; 3]) {
        (self.point.mass, self.coordinates[self.point.node])
    }
}

/// A spring with its dashpot between two nodes, 12 freedoms, or to the ground, 6.
pub struct SpringElement<'a> {
    spring: &'a Spring,
    nodes: [usize; 2],
    count: usize,
}

impl<'a> SpringElement<'a> {
    /// The element of `spring`.
    pub fn new(spring: &'a Spring) -> Self {
        let nodes = [spring.node, spring.other.unwrap_or(spring.node)];
        SpringElement { spring, nodes, count: 1 + usize::from(spring.other.is_some()) }
    }

    /// `factor` · b bᵀ with b = (a, −a), or a to the ground.
    fn dyad(&self, factor: f64, to: &mut ElementMatrix) -> bool {
        let a = spring_direction(self.spring).expect("checked: it has a direction");
        let b = |k: usize| if k < 6 { a[k] } else { -a[k - 6] };
        for j in 0..to.size() {
            for i in 0..to.size() {
                to.set(i, j, b(i) * b(j) * factor);
            }
        }
        true
    }
}

impl FiniteElement for SpringElement<'_> {
    fn nodes(&self) -> &[usize] {
        &self.nodes[..self.count]
    }

    /// A spring of no stiffness and no damping would leave a direction without mass a row of zeros. What moves does not
    /// notice that it is left out: a spring that acts alone on such a direction takes no force, however stiff.
    fn acting(&self) -> Acting {
        let acts = self.spring.stiffness != 0.0 || self.spring.damping != 0.0;
        Acting::Along(spring_direction(self.spring).filter(|_| acts).into_iter().collect())
    }

    fn stiffness(&self, k: &mut ElementMatrix) -> bool {
        self.dyad(self.spring.stiffness, k)
    }

    fn has_dashpot(&self) -> bool {
        self.spring.damping != 0.0
    }

    fn dashpot(&self, c: &mut ElementMatrix) -> bool {
        self.has_dashpot() && self.dyad(self.spring.damping, c)
    }

    fn mass_and_center(&self) -> (f64, [f64; 3]) {
        (0.0, [0.0; 3])
    }
}
