//! Trajectories: the accepted steps of a motion, with dense output between them.

mod csv;
mod drift;
mod hybrid;
mod path;
mod records;
mod stored;
#[cfg(test)]
mod tests;

pub use csv::{Csv, Tabulated};
pub use drift::{Deviation, Drift};
pub use hybrid::{HybridTrajectory, Leg, Named};
pub(crate) use path::Path;
pub use records::Records;
pub use stored::Trajectory;
pub(crate) use stored::between;
