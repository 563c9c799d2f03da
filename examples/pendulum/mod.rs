//! What the examples with a pendulum on a sphere share: its exact laws by quadrature, and turning points found on an
//! integrated motion.

mod orbit;
mod zeros;

pub(crate) use orbit::Orbit;
pub(crate) use zeros::crossings;
