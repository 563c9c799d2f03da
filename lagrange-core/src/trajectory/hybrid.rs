//! A motion of several legs, each of a system of its own.

use alloc::boxed::Box;
use alloc::vec::Vec;
use core::any::Any;
use core::fmt::{self, Debug, Formatter};

use super::stored::{Trajectory, between};
use crate::error::{Ending, Error};
use crate::number::Real;
use crate::solution::Sample;
use crate::solution::vector_field::VectorField;
use crate::system::Lagrangian;

/// A motion of several legs: until an event by one system, from there on by another, or by the same with other
/// parameters or another velocity. It is asked by name, whatever numbers of coordinates and constraints the legs have.
///
#[cfg_attr(
    feature = "std",
    doc = r#"
```
use lagrange_core::{HybridTrajectory, prelude::*};

/// A ladder at a wall; x and y are its middle.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*a^2/6 * theta_dot^2 - m*g*y)]
#[constraint(floor: y - a*sin(theta) = 0)]
#[constraint(wall: x - a*cos(theta) = 0)]
struct Leaning { m: f64, a: f64, g: f64 }

/// The ladder on its way down, without the wall.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*a^2/6 * theta_dot^2 - m*g*y)]
#[constraint(floor: y - a*sin(theta) = 0)]
struct Sliding { m: f64, a: f64, g: f64 }

let (m, a, g) = (3.0, 2.0, 9.81);
let (leaning, sliding) = (Leaning { m, a, g }, Sliding { m, a, g });
let (start, method) = (State::at_rest([2.0 * 1.2_f64.cos(), 2.0 * 1.2_f64.sin(), 1.2]), Dop853::default());

let leaves = leaning.event("leaves", |sample| sample.multiplier("wall")).falling().terminal();
let first = leaning.motion(start).by(method).event(leaves).towards(10.0)?;
let falls = sliding.event("falls", |sample| sample.coordinate("theta")).falling().terminal();
let second = sliding.motion(*first.end().state()).by(method).event(falls).towards(10.0)?;

let mut trajectory = HybridTrajectory::new();
trajectory.push(first.into_owned())?;
trajectory.push(second.into_owned())?;
for k in 0..=10 {
    let sample = trajectory.at(trajectory.start() + 0.1 * f64::from(k) * (trajectory.end() - trajectory.start()))?;
    println!("{} {} {}", sample.time(), sample.coordinate("theta")?, sample.multiplier("floor")?);
}
let leaning = trajectory.leg::<Trajectory<Leaning, 3, 2>>(0).expect("the first leg");
assert!(leaning.end().multiplier("wall")?.abs() < 1e-12);
# Ok::<(), Error>(())
```
"#
)]
///
/// The legs own their systems: [`Trajectory::into_owned`]. Where one ends and the next starts, the next answers: after an
/// impact velocities are those after it. What the one before says is had from that, [`legs`](Self::legs).
pub struct HybridTrajectory<T> {
    legs: Vec<Box<dyn Leg<T>>>,
}

impl<T: Real> HybridTrajectory<T> {
    /// Without a leg.
    pub fn new() -> Self {
        Self { legs: Vec::new() }
    }

    /// Goes on with this leg.
    ///
    /// # Errors
    /// [`Error::LegApart`] where it does not start when the last has ended, or leads the other way in time.
    pub fn push(&mut self, leg: impl Leg<T> + 'static) -> Result<(), Error> {
        let goes_back = |leg: &dyn Leg<T>| leg.end_time() < leg.start_time();
        let goes_on = |leg: &dyn Leg<T>| leg.end_time() > leg.start_time();
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

    /// The legs, in order.
    pub fn legs(&self) -> impl ExactSizeIterator<Item = &dyn Leg<T>> {
        self.legs.iter().map(|leg| &**leg)
    }

    /// Leg `index`, counted from 0, where it is a trajectory of this type: with its states, crossings and all else.
    pub fn leg<L: Leg<T> + 'static>(&self, index: usize) -> Option<&L> {
        let leg: &dyn Any = &**self.legs.get(index)?;
        leg.downcast_ref()
    }

    /// When it starts; NaN without a leg.
    pub fn start(&self) -> T {
        self.legs.first().map_or(T::constant(f64::NAN), |leg| leg.start_time())
    }

    /// When it ends; NaN without a leg.
    pub fn end(&self) -> T {
        self.legs.last().map_or(T::constant(f64::NAN), |leg| leg.end_time())
    }

    /// Why it gets no farther; `None` without a leg.
    pub fn ending(&self) -> Option<&Ending> {
        self.legs.last().map(|leg| leg.ending())
    }

    /// The state at this time, to be asked by name. Names that its leg does not have are [`Error::UnknownName`].
    ///
    /// # Errors
    /// [`Error::OutsideTrajectory`]; as [`Trajectory::at`].
    pub fn at(&self, t: T) -> Result<Box<dyn Named<T> + '_>, Error> {
        let covers = |leg: &&dyn Leg<T>| {
            let (start, end) = (leg.start_time(), leg.end_time());
            start <= t && t <= end || end <= t && t <= start
        };
        let leg = self.legs.iter().map(|leg| &**leg).rev().find(covers);
        let [time, start, end] = [t, self.start(), self.end()].map(Real::to_f64);
        leg.ok_or(Error::OutsideTrajectory { time, start, end })?.named_at(t)
    }

    /// `count` states at evenly spaced times, first and last included, or why there is none.
    pub fn samples(&self, count: usize) -> impl Iterator<Item = Result<Box<dyn Named<T> + '_>, Error>> {
        let (start, end, intervals) = (self.start(), self.end(), count.saturating_sub(1).max(1));
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

/// A leg of a [`HybridTrajectory`]: a [`Trajectory`] without its numbers of coordinates and constraints.
pub trait Leg<T>: Any + Debug + Send + Sync {
    /// When it starts.
    fn start_time(&self) -> T;
    /// When it ends.
    fn end_time(&self) -> T;
    /// Why it ends.
    fn ending(&self) -> &Ending;
    /// The state at this time.
    ///
    /// # Errors
    /// As [`Trajectory::at`].
    fn named_at(&self, t: T) -> Result<Box<dyn Named<T> + '_>, Error>;
}

impl<S, F, const N: usize, const M: usize> Leg<S::Scalar> for Trajectory<S, N, M, F>
where
    S: Lagrangian<N, M, Scalar: Real> + Clone + Send + Sync + 'static,
    F: VectorField<S, N, M> + Send + Sync + 'static,
{
    fn start_time(&self) -> S::Scalar {
        self.path.start.t
    }

    fn end_time(&self) -> S::Scalar {
        self.path.last.t
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
        /// A state that is asked by name: a [`Sample`] without its numbers of coordinates and constraints, where more is said
        /// about each. Names that its system does not have are [`Error::UnknownName`].
        pub trait Named<T> {
            /// The time.
            fn time(&self) -> T;
            /// The energy.
            fn energy(&self) -> T;
            $(
                $(#[$doc])*
                ///
                /// # Errors
                /// As that of a [`Sample`].
                fn $quantity(&self, name: &str) -> Result<T, Error>;
            )*
        }

        impl<S, const N: usize, const M: usize> Named<S::Scalar> for Sample<S, N, M>
        where
            S: Lagrangian<N, M, Scalar: Real>,
        {
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
    /// The generalized coordinate of this name.
    coordinate,
    /// The generalized velocity of the coordinate of this name.
    velocity,
    /// The generalized momentum of the coordinate of this name.
    momentum,
    /// The generalized acceleration of the coordinate of this name.
    acceleration,
    /// The multiplier of the constraint of this name.
    multiplier,
    /// The generalized constraint force on the coordinate of this name.
    constraint_force,
    /// The observable of this name.
    observable,
    /// The conserved quantity of this name.
    conserved,
}
