//! Compile-time facts about a system: [`Facts`], the kinds of its constraints, and its [`Equations`] in
//! readable form.

pub use crate::system::{
    Classification, Conserved, EnergyForm, Equations, Evidence, Excerpt, Extent, Facts, Integrability,
    Integrals, LinearPart, TotalDerivative,
};
