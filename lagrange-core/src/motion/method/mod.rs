//! Integration methods: Runge–Kutta steps, and the control of their length.

mod adaptive;
pub(crate) mod bounds;
pub(crate) mod clock;
pub(crate) mod contract;
pub(crate) mod control;
mod dop853;
mod dopri5;
pub(crate) mod pair;
pub(crate) mod pair_memory;
mod pair_stages;
mod runge_kutta;
mod slope;
pub(crate) mod step;
mod stiff;

pub use adaptive::Adaptive;
pub use bounds::MultiplierBounds;
pub use contract::{Limits, Method, Step};
pub use dop853::{Dop853, DormandPrince853};
pub use dopri5::{Dopri5, DormandPrince54};
pub use pair::{Pair, TableauRow};
pub use runge_kutta::{RungeKutta4, runge_kutta_step};
