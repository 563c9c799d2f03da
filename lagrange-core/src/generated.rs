//! Functions that only generated code calls. They change with the derive macro, without notice.

pub use crate::number::array::{matrix, vector};
pub use crate::number::numeric::{only_where, sin_cos_of_small};
pub use crate::solution::eliminate::{LoopFactor, eliminate, nan_if_ill_conditioned};
pub use crate::system::defect::{Defect, asymmetry, distortion};
pub use crate::system::equations::equations;
pub use crate::system::member::FieldMember;
