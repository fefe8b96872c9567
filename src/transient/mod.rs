//! Motion in time: implicit integration of M ü + (C + G) u̇ + (K + N) u + D r(Dᵀu, Dᵀu̇) = f with the contact laws as they are;
//! G and N are sparse skew parts, gyroscopic and circulatory, where a system has them.
//!
//! [`Scheme`] is the generalised-α family, [`TransientModel`] what it needs of a system, [`march`] the run. The structure is
//! factorised once for a time step; contact is condensed exactly onto the few directions in which it acts, so that a
//! step costs one solution with sparse factors and Newton's method on a small dense system (`condensed`). A reduced model with more contact
//! points than coordinates has Newton's method on these (`reduced`). Newton's method
//! on the whole is kept beside it to compare with (`full_newton`). Friction that is set-valued at rest is an unknown of both, so
//! that points stick, turn round and slip again without regularisation. [`Work`] is the balance of energy. A [`Checkpoint`] holds
//! the state from which a run resumes as if it had never stopped; a [`Watch`] detects when contact points open, close and turn.

mod along;
mod checkpoint;
mod condensed;
mod drive;
mod effective;
mod energy_balance;
mod events;
mod full_newton;
mod initial;
mod interface;
mod march;
mod model;
mod products;
mod reaction;
mod reduced;
mod rows;
mod scheme;
mod skew;
mod slopes;
mod solver;
mod state;
mod stepper;
mod tangent;
#[cfg(test)]
mod tests;
mod track;

pub use checkpoint::Checkpoint;
pub use drive::{Loading, Pulse, Push, TimeProfile};
pub use energy_balance::Work;
pub use events::{Event, EventKind, Watch};
pub use march::{Control, Marched, Plan, march, resume};
pub use model::{NO_LOAD, TransientModel, refuse_hysteretic};
pub use scheme::Scheme;
pub use state::State;
pub use stepper::StepMethod;
pub use track::Track;
