//! Trajectories: the accepted steps of a motion, with dense output between them.

mod csv;
mod drift;
mod hybrid;
mod kept;
mod leg;
mod path;
mod records;
mod samples;
mod stored;
#[cfg(test)]
mod tests;
mod transition;

pub use csv::Csv;
pub(crate) use drift::balance;
pub use drift::{Deviation, Drift};
pub use hybrid::{AnyTrajectory, HybridTrajectory, Named};
pub use kept::{KeptStates, Legs};
pub use leg::Leg;
pub(crate) use path::{Chord, Path};
pub use records::Records;
pub use samples::{SampledTrajectory, Samples};
pub use stored::Trajectory;
pub use transition::Transition;
