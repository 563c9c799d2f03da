//! Motions in several legs, each with its own system.

use alloc::boxed::Box;
use alloc::vec::Vec;
use core::any::Any;
use core::fmt::{self, Debug, Formatter};

use super::leg::outside;
use super::stored::{Trajectory, between};
use crate::error::{Ending, Error};
use crate::number::Real;
use crate::solution::Sample;
use crate::solution::vector_field::VectorField;
use crate::system::Lagrangian;

/// A motion in several legs. At an event the next leg takes over, with another system, other parameters or
/// another velocity. Samples are looked up by name, for any numbers of coordinates and constraints of the legs.
///
/// ```
/// use lagrange_core::{HybridTrajectory, prelude::*};
///
/// /// A ladder at a wall; x and y are its middle.
/// #[derive(Clone, Lagrangian)]
/// #[coordinates(x, y, theta)]
/// #[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*a^2/6 * theta_dot^2 - m*g*y)]
/// #[constraint(floor: y - a*sin(theta) = 0)]
/// #[constraint(wall: x - a*cos(theta) = 0)]
/// struct Leaning { m: f64, a: f64, g: f64 }
///
/// /// The ladder on its way down, without the wall.
/// #[derive(Clone, Lagrangian)]
/// #[coordinates(x, y, theta)]
/// #[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*a^2/6 * theta_dot^2 - m*g*y)]
/// #[constraint(floor: y - a*sin(theta) = 0)]
/// struct Sliding { m: f64, a: f64, g: f64 }
///
/// let (m, a, g) = (3.0, 2.0, 9.81);
/// let (leaning, sliding) = (Leaning { m, a, g }, Sliding { m, a, g });
/// let (start, method) = (State::at_rest([2.0 * 1.2_f64.cos(), 2.0 * 1.2_f64.sin(), 1.2]), Dop853::default());
///
/// let leaves = leaning.event("leaves", |sample| sample.multiplier("wall")).falling().terminal();
/// let first = leaning.motion(start).by(method).event(leaves).towards(10.0)?;
/// let falls = sliding.event("falls", |sample| sample.coordinate("theta")).falling().terminal();
/// let second = sliding.motion(*first.end().state()).by(method).event(falls).towards(10.0)?;
///
/// let mut trajectory = HybridTrajectory::new();
/// trajectory.push(first.into_owned())?;
/// trajectory.push(second.into_owned())?;
/// for k in 0..=10 {
///     let (start, end) = (trajectory.start_time(), trajectory.end_time());
///     let sample = trajectory.at(start + 0.1 * f64::from(k) * (end - start))?;
///     println!("{} {} {}", sample.time(), sample.coordinate("theta")?, sample.multiplier("floor")?);
/// }
/// let leaning = trajectory.leg::<Trajectory<Leaning>>(0).expect("the first leg");
/// assert!(leaning.end().multiplier("wall")?.abs() < 1e-12);
/// # Ok::<(), Error>(())
/// ```
///
/// The legs own their systems: [`Trajectory::into_owned`]; those across contacts do from the start. At a time shared by two legs, the sample is that of
/// the later one: after an impact it has the velocities after the impact. For the earlier one, query the leg
/// itself, from [`legs`](Self::legs).
pub struct HybridTrajectory<T> {
    legs: Vec<Box<dyn AnyTrajectory<T>>>,
}

impl<T: Real> HybridTrajectory<T> {
    /// Creates a trajectory without legs.
    pub fn new() -> Self {
        Self { legs: Vec::new() }
    }

    /// Appends a leg.
    ///
    /// # Errors
    /// [`Error::LegApart`] if the leg does not start at the end of the previous one, or runs in the opposite
    /// direction of time.
    pub fn push(&mut self, leg: impl AnyTrajectory<T> + 'static) -> Result<(), Error> {
        let goes_back = |leg: &dyn AnyTrajectory<T>| leg.end_time() < leg.start_time();
        let goes_on = |leg: &dyn AnyTrajectory<T>| leg.end_time() > leg.start_time();
        if let Some(last) = self.legs.last() {
            let turns = self
                .legs
                .iter()
                .any(|before| goes_back(&**before) && goes_on(&leg) || goes_on(&**before) && goes_back(&leg));
            let (start, expected) = (leg.start_time(), last.end_time());
            if start != expected || turns {
                let [start, end, expected] = [start, leg.end_time(), expected].map(Real::to_f64);
                return Err(Error::LegApart { start, end, expected });
            }
        }
        self.legs.push(Box::new(leg));
        Ok(())
    }

    /// Returns the legs, in order.
    pub fn legs(&self) -> impl ExactSizeIterator<Item = &dyn AnyTrajectory<T>> {
        self.legs.iter().map(|leg| &**leg)
    }

    /// Returns leg `index`, counted from 0, if it is a trajectory of type `L`, with all its states and
    /// crossings.
    pub fn leg<L: AnyTrajectory<T> + 'static>(&self, index: usize) -> Option<&L> {
        let leg: &dyn Any = &**self.legs.get(index)?;
        leg.downcast_ref()
    }

    /// Returns the start time; NaN without legs.
    pub fn start_time(&self) -> T {
        self.legs.first().map_or(T::constant(f64::NAN), |leg| leg.start_time())
    }

    /// Returns the end time; NaN without legs.
    pub fn end_time(&self) -> T {
        self.legs.last().map_or(T::constant(f64::NAN), |leg| leg.end_time())
    }

    /// Returns the ending of the last leg; `None` without legs.
    pub fn ending(&self) -> Option<&Ending> {
        self.legs.last().map(|leg| leg.ending())
    }

    /// Returns the state at this time, for lookup by name. Names that the system of its leg lacks give
    /// [`Error::UnknownName`].
    ///
    /// # Errors
    /// [`Error::OutsideTrajectory`], and those of [`Trajectory::at`].
    pub fn at(&self, t: T) -> Result<Box<dyn Named<T> + '_>, Error> {
        let covers = |leg: &&dyn AnyTrajectory<T>| {
            let (start, end) = (leg.start_time(), leg.end_time());
            start <= t && t <= end || end <= t && t <= start
        };
        let leg = self.legs.iter().map(|leg| &**leg).rev().find(covers);
        leg.ok_or_else(|| outside(t, [self.start_time(), self.end_time()]))?.named_at(t)
    }

    /// Returns `count` states at evenly spaced times, first and last included, each as the result of
    /// [`at`](Self::at).
    pub fn samples(&self, count: usize) -> impl Iterator<Item = Result<Box<dyn Named<T> + '_>, Error>> {
        let (start, end, intervals) = (self.start_time(), self.end_time(), count.saturating_sub(1).max(1));
        (0..count).map(move |i| self.at(between(start, end, i as f64 / intervals as f64)))
    }
}

impl<T: Real> Default for HybridTrajectory<T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Real> Debug for HybridTrajectory<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(&self.legs).finish()
    }
}

/// A leg of a [`HybridTrajectory`]: a [`Trajectory`] whose type does not show the numbers of coordinates and
/// constraints.
pub trait AnyTrajectory<T>: Any + Debug + Send + Sync {
    /// Returns the start time.
    fn start_time(&self) -> T;
    /// Returns the end time.
    fn end_time(&self) -> T;
    /// Returns the reason why the leg ends.
    fn ending(&self) -> &Ending;
    /// Returns the state at this time.
    ///
    /// # Errors
    /// Those of [`Trajectory::at`].
    fn named_at(&self, t: T) -> Result<Box<dyn Named<T> + '_>, Error>;
}

impl<S, F> AnyTrajectory<S::Scalar> for Trajectory<S, F>
where
    S: Lagrangian<Scalar: Real> + Clone + Send + Sync + 'static,
    F: VectorField<S> + Send + Sync + 'static,
{
    fn start_time(&self) -> S::Scalar {
        self.times()[0]
    }

    fn end_time(&self) -> S::Scalar {
        self.times()[1]
    }

    fn ending(&self) -> &Ending {
        self.ending()
    }

    fn named_at(&self, t: S::Scalar) -> Result<Box<dyn Named<S::Scalar> + '_>, Error> {
        Ok(Box::new(self.at(t)?))
    }
}

macro_rules! named {
    ($($(#[$doc:meta])* $quantity:ident,)*) => {
        /// A state with lookup by name: a [`Sample`] whose type does not show the numbers of coordinates and
        /// constraints. Names that its system lacks give [`Error::UnknownName`].
        pub trait Named<T> {
            /// Returns the time.
            fn time(&self) -> T;
            /// Returns the energy.
            fn energy(&self) -> T;
            $(
                $(#[$doc])*
                ///
                /// # Errors
                /// Those of the method of a [`Sample`] with the same name.
                fn $quantity(&self, name: &str) -> Result<T, Error>;
            )*
        }

        impl<S: Lagrangian<Scalar: Real>> Named<S::Scalar> for Sample<S> {
            fn time(&self) -> S::Scalar {
                self.time()
            }

            fn energy(&self) -> S::Scalar {
                self.energy()
            }

            $(fn $quantity(&self, name: &str) -> Result<S::Scalar, Error> {
                self.$quantity(name)
            })*
        }
    };
}

named! {
    /// Returns the generalized coordinate of this name.
    coordinate,
    /// Returns the generalized velocity of the coordinate of this name.
    velocity,
    /// Returns the generalized momentum of the coordinate of this name.
    momentum,
    /// Returns the generalized acceleration of the coordinate of this name.
    acceleration,
    /// Returns the multiplier of the constraint of this name.
    multiplier,
    /// Returns the generalized constraint force on the coordinate of this name.
    constraint_force,
    /// Returns the observable of this name.
    observable,
    /// Returns the conserved quantity of this name.
    conserved,
}
