//! What is known about a system when it is compiled: [`Facts`], the kinds of its constraints, and its [`Equations`] in print.

pub use crate::system::{
    Classification, Conserved, EnergyForm, Equations, Evidence, Excerpt, Extent, Facts, Integrability,
    Integrals, LinearPart, TotalDerivative,
};
