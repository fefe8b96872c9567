//! Two bodies that touch: where ([`pairing`]) and with which forces ([`law`], from [`normal`] and [`friction`]).
//!
//! N = w (k_n δ + k_nl δ³ + c_n δ̇) for a penetration δ > 0 and a weight w of the point; friction on the body is
//! F = μ(|v|, p) N v/√(|v|² + v_ε²) along the slip velocity v of the counter-body, p = N/w.
//!
//! A [`SlidingLaw`] is a pure function (penetration, slip velocity) → (N, F₁, F₂) with its Jacobian;
//! [`pair_surfaces`] builds the contact points of a pair from the meshes of its bodies. Together with a closing
//! load they make a [`crate::system::ContactPair`]. [`ground_points`] are those of nodes on rigid ground, [`place`] sets a
//! body on its counter-body, [`Sliding`] is how that one moves, [`Stations`] are the points of a pair whose counter-body travels.

mod bristle;
mod candidate;
mod clip;
mod coefficient;
mod coulomb;
pub mod friction;
mod ground;
pub mod law;
pub mod normal;
pub mod pairing;
mod placement;
mod projection;
mod segments;
mod sliding;
mod slip;
mod surfaces;
mod table;
mod touching;
mod travel;
mod tributary;

pub use bristle::Bristle;
pub use coefficient::{Coefficient, FrictionCoefficient};
pub use friction::{Coulomb, Exponential, FrictionCurve, Hyperbolic, Stribeck};
pub use ground::{GroundFault, ground_points};
pub use law::{FrictionSense, SlidingLaw};
pub use normal::{NormalForce, NormalLaw};
pub use pairing::{Reduce, pair_surfaces};
pub use placement::{BodyPlacement, OffCounter, place};
pub use sliding::Sliding;
pub use surfaces::{ContactPatch, ContactSide, Surfaces};
pub use table::FrictionTable;
pub use travel::{Stations, mean_edge, travelled};
pub use tributary::tributary;
