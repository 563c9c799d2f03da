//! What only generated code calls. It changes as the derive does, without notice.

pub use crate::number::array::{matrix, vector};
pub use crate::number::numeric::only_where;
pub use crate::solution::eliminate::eliminate;
pub use crate::system::equations::equations;
