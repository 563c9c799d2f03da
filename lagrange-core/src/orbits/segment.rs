//! One segment of an orbit, with its derivatives.

use alloc::string::String;
use alloc::vec::Vec;

use nalgebra::{DMatrix, DVector};

use super::frame::{OrbitUnits, flat};
use super::monodromy::stacked;
use crate::StateOf;
use crate::error::Error;
use crate::linearized::{DifferentiableMethod, Linearized, MotionDerivatives};
use crate::motion::Simulate;
use crate::number::Real;
use crate::system::lookup;

/// A segment of an orbit.
#[derive(Clone)]
pub(super) struct Segment<L: Linearized> {
    /// State at the end, which should be the start of the next.
    pub(super) end: StateOf<L>,
    /// Derivatives of the end by (q, q̇) at the start.
    pub(super) by_state: DMatrix<L::Scalar>,
    /// Derivative of the end by the parameter, and that of the start, which moves with the constraints.
    pub(super) by_parameter: Option<[DVector<L::Scalar>; 2]>,
    /// Largest coordinate and velocity on the way.
    pub(super) size: OrbitUnits<L::Scalar>,
    /// Rate (q̇, q̈) at the end.
    pub(super) rate: DVector<L::Scalar>,
}

impl<L: Linearized<Scalar: Real> + MotionDerivatives> Segment<L> {
    pub(super) fn from<D: DifferentiableMethod<L>>(
        system: &L,
        start: &StateOf<L>,
        duration: L::Scalar,
        method: D,
        parameter: Option<usize>,
    ) -> Result<Self, Error> {
        let mut names: Vec<String> = lookup::entries::<L>();
        let entries = names.len();
        names.extend(parameter.map(|k| String::from(L::PARAMETERS[k])));
        let names: Vec<&str> = names.iter().map(|name| &**name).collect();
        let begun = system.sensitivity(start, &names)?;
        let motion = system.motion_with_derivatives(&begun).by(method).to(start.t + duration)?;
        let end = motion.derivatives_at_end()?;
        let all = stacked(end, names.len());
        let column = |all: &DMatrix<_>| all.column(entries).into_owned();
        let by_parameter = match parameter {
            None => None,
            Some(_) => Some([column(&all), column(&stacked(&motion.derivatives_at(start.t)?, names.len()))]),
        };
        let accelerations = system.solve(&end.state)?.accelerations;
        let rates = end.state.v.iter().chain(&accelerations).copied();
        Ok(Self {
            end: end.state,
            size: OrbitUnits::of(core::iter::once(&*motion)),
            by_state: all.columns(0, entries).into_owned(),
            by_parameter,
            rate: DVector::from_iterator(entries, rates),
        })
    }

    /// Change of the start on the way back from the end: the error of the method, there and back.
    pub(super) fn round_trip<D: DifferentiableMethod<L>>(
        &self,
        system: &L,
        start: &StateOf<L>,
        method: D,
    ) -> Result<DVector<L::Scalar>, Error> {
        let back = system.motion(self.end).by(method).to(start.t)?;
        Ok(flat::<L>(back.end().state()) - flat::<L>(start))
    }
}
