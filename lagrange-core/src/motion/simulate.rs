//! What a program does with a system.

#[cfg(feature = "alloc")]
use core::array::from_fn;

use super::event::{Event, EventValue};
#[cfg(feature = "alloc")]
use super::{
    Method, MotionBuilder,
    builder::{MotionFrom, Start},
};
use crate::error::Error;
use crate::number::Real;
#[cfg(feature = "alloc")]
use crate::number::Scalar;
use crate::solution::Sample;
use crate::solution::consistent::{self, Consistent};
#[cfg(feature = "alloc")]
use crate::solution::impact::{Impact, impact};
use crate::solution::solve::solve;
#[cfg(feature = "alloc")]
use crate::solution::vector_field::LagrangianVectorField;
use crate::system::finite::check_finite;
#[cfg(feature = "alloc")]
use crate::system::lookup;
use crate::system::{Lagrangian, Solution, State};
#[cfg(feature = "alloc")]
use crate::trajectory::Trajectory;

/// Solving, integrating and setting up a system: every [`Lagrangian`] over `f64` or `f32` has it.
pub trait Simulate<const N: usize, const M: usize>: Lagrangian<N, M, Scalar: Real> + Sized {
    /// Accelerations and multipliers at a state.
    ///
    /// Those of [`accelerations_unchecked`](Lagrangian::accelerations_unchecked) where its smallest pivot exceeds ε^(1/3)
    /// (6·10⁻⁶ for `f64`), which costs at most a third of the digits. Else the general solve by null space, which copes with a
    /// mass matrix that is singular or indefinite and with constraints that depend on one another;
    /// [`Solution::multipliers_are_unique`] tells the latter.
    ///
    /// # Errors
    /// [`Error::StateNotFinite`] and [`Error::ParameterNotAsSaid`], also of what the equations do not use;
    /// [`Error::EquationsNotFinite`], [`Error::Singular`] where nothing determines some acceleration, and
    /// [`Error::Contradictory`] where dependent constraints demand different accelerations, [`Error::NoGradient`] where the row of
    /// one is zero, [`Error::DependentToFirstOrder`] where a combination has none; each names the coordinates or the constraint. Whether the state is on the constraints, and no row the
    /// round-off of zero, [`check_consistent`](Self::check_consistent) tells.
    fn solve(&self, state: &State<Self::Scalar, N>) -> Result<Solution<Self::Scalar, N, M>, Error> {
        solve(self, state)
    }

    /// Whether the state satisfies the constraints, to √ε of the size of their terms (1.5·10⁻⁸ for `f64`).
    ///
    /// # Errors
    /// [`Error::StateNotFinite`] and [`Error::ParameterNotAsSaid`]; [`Error::Inconsistent`], with the first constraint that it
    /// violates; [`Error::NoGradient`], with the first that fixes no acceleration.
    fn check_consistent(&self, state: &State<Self::Scalar, N>) -> Result<(), Error> {
        check_finite(self, state)?;
        consistent::check(self, state)
    }

    /// The nearest state on the constraints, and how far it is from the one given.
    ///
    /// First the coordinates move onto Φ = 0 of the holonomic constraints, then the velocities onto F q̇ + b = 0 of all. Near
    /// is meant in the metric of the mass matrix, of the state given for coordinates, M(q₀)(q − q₀) = Fᵀμ, and of the
    /// coordinates found for velocities; where it is not positive, of the masses on its diagonal. No small move along the
    /// constraints leads nearer, unless a hundred steps did not suffice (a chain of 50 rods far off them takes 31). Where they curve more sharply than the distance, as they do seen from near the centre of an
    /// ellipse, some point farther along may be nearer still.
    ///
    /// ```
    /// # use lagrange_core::prelude::*;
    /// #[derive(Lagrangian)]
    /// #[coordinates(x, y)]
    /// #[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
    /// #[constraint(rod: 1/2 * (x^2 + y^2 - l^2) = 0)]
    /// struct Pendulum { m: f64, g: f64, l: f64 }
    ///
    /// let pendulum = Pendulum { m: 1.0, g: 9.81, l: 2.0 };
    /// let start = pendulum.state_from(&[("x", 0.6), ("y", -0.8)])?;
    /// let (start, adjustment) = pendulum.make_consistent(&start)?;
    /// assert!((start.q[0] - 1.2).abs() < 1e-15 && (start.q[1] + 1.6).abs() < 1e-15);
    /// assert!((adjustment.largest_coordinate_change() - 0.8).abs() < 1e-15);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::StateNotFinite`], [`Error::NotProjected`] where Newton's iteration does not get there, and
    /// [`Error::NoGradient`] where a constraint holds and its gradient vanishes.
    fn make_consistent(&self, state: &State<Self::Scalar, N>) -> Result<Consistent<Self::Scalar, N>, Error> {
        check_finite(self, state)?;
        consistent::make_consistent(self, state, &[[false; N]; 2])
    }

    /// The same, with some entries as they are given: named as in [`state_from`](Self::state_from), `r` and `r_dot` for
    /// all of a vector. The others move, to the nearest state in the metric of their part of the mass matrix.
    ///
    /// ```
    /// # use lagrange_core::prelude::*;
    /// # #[derive(Lagrangian)]
    /// # #[coordinates(x, y)]
    /// # #[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
    /// # #[constraint(rod: 1/2 * (x^2 + y^2 - l^2) = 0)]
    /// # struct Pendulum { m: f64, g: f64, l: f64 }
    /// let pendulum = Pendulum { m: 1.0, g: 9.81, l: 2.0 };
    /// // Its place and speed along x are given; y is sought from below.
    /// let start = pendulum.state_from(&[("x", 1.2), ("y", -1.0), ("x_dot", 0.4)])?;
    /// let (start, _) = pendulum.make_consistent_holding(&start, &["x", "x_dot"])?;
    /// assert_eq!((start.q[0], start.v[0]), (1.2, 0.4));
    /// assert!((start.q[1] + 1.6).abs() < 1e-15 && (start.v[1] - 0.3).abs() < 1e-15);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`make_consistent`](Self::make_consistent); [`Error::HeldTooMuch`], with the constraint that the other
    /// entries cannot satisfy; [`Error::UnknownName`] and [`Error::RepeatedName`].
    #[cfg(feature = "alloc")]
    fn make_consistent_holding(
        &self,
        state: &State<Self::Scalar, N>,
        held: &[&str],
    ) -> Result<Consistent<Self::Scalar, N>, Error> {
        check_finite(self, state)?;
        let known = lookup::entries::<Self, N, M>();
        let held = lookup::indices::<Self, N, M>(&known, "coordinate or velocity", held)?;
        let [q, v] = [0, N].map(|half| from_fn(|i| held.contains(&(half + i))));
        consistent::make_consistent(self, state, &[q, v])
    }

    /// A state of this system, to be asked for what follows from it, by name.
    fn sample(&self, state: State<Self::Scalar, N>) -> Sample<&Self, N, M> {
        Sample { system: self, state }
    }

    /// An event of this system: where a function of its motion crosses zero. The function is given a sample, and gives a
    /// number, or what gives one by name.
    ///
    /// ```
    /// # use lagrange_core::prelude::*;
    /// #[derive(Lagrangian)]
    /// #[coordinates(height)]
    /// #[lagrangian(height_dot^2/2 - g*height)]
    /// struct Ball { g: f64 }
    ///
    /// let ball = Ball { g: 9.81 };
    /// let mut lands = ball.event("lands", |sample| sample.state().q[0]).falling();
    /// let mut motion = Motion::new(&ball, State::at_rest([1.0]), Dop853::default())?;
    /// for bounce in 0..3 {
    ///     let landing = motion.advance_to_event(10.0, &mut [&mut lands])?.expect("it falls");
    ///     assert!(landing.state.q[0].abs() < 1e-15);
    ///     let State { t, q, v } = landing.state;
    ///     motion.set_state(State { t, q, v: -0.5 * v })?;
    /// }
    /// // It falls for a second of √(2/g), then for two halves and two quarters of one.
    /// assert!((motion.state().t - (2.0 / 9.81_f64).sqrt() * 2.5).abs() < 1e-12);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// [`Event`] says what is found and what is not, and has the settings.
    fn event<V, G>(&self, name: &'static str, function: G) -> Event<Self, G, N, M>
    where
        V: EventValue<Self::Scalar>,
        G: Fn(&Sample<&Self, N, M>) -> V,
    {
        Event::new(name, function)
    }

    /// The state after an impact: the constraint of this name is hit, its rate turns round and is `restitution` times what it
    /// was, while all others hold on.
    ///
    /// M(v⁺ − v⁻) = FᵀΛ with F v⁺ + b = −e (F v⁻ + b) in the row that is hit, and F v⁺ + b = 0 in the others, e from 0, a
    /// plastic impact, to 1, an elastic one. It is solved by the factor of this system, the one that has the constraint;
    /// the motions before and after may be those of another one with the same coordinates. Where the momenta are linear in the
    /// velocities they jump by FᵀΛ.
    ///
    /// Whether the bodies approach is for the caller to know: a rate that leads away is turned round as well, by an impulse that pulls.
    /// After a plastic impact they stay together, and the motion goes on by the system that has the constraint, as long as its
    /// multiplier pushes.
    ///
    /// ```
    /// # use lagrange_core::prelude::*;
    /// /// A ball and the floor.
    /// #[derive(Lagrangian)]
    /// #[coordinates(x, y)]
    /// #[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
    /// #[constraint(floor: y = 0)]
    /// struct Touching { m: f64, g: f64 }
    ///
    /// let floor = Touching { m: 2.0, g: 9.81 };
    /// let before = State::new([0.5, 0.0], [1.0, -3.0]);
    /// let impact = floor.impact(&before, "floor", 0.5)?;
    /// assert_eq!((impact.state.v[0], impact.state.v[1]), (1.0, 1.5));
    /// assert_eq!(impact.impulse("floor")?, 2.0 * (1.5 + 3.0));
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::UnknownName`]; [`Error::Restitution`]; [`Error::StateNotFinite`]; [`Error::Inconsistent`] where the
    /// coordinates are not on a constraint; [`Error::Singular`] and [`Error::Contradictory`] as [`solve`](Self::solve).
    #[cfg(feature = "alloc")]
    fn impact(
        &self,
        state: &State<Self::Scalar, N>,
        constraint: &str,
        restitution: Self::Scalar,
    ) -> Result<Impact<Self, N, M>, Error> {
        let hit = lookup::index::<Self, N, M>(&Self::CONSTRAINTS, "constraint", constraint)?;
        impact(self, state, hit, restitution)
    }

    /// The motion from a state to the time `end`, by the method named; backwards where that lies before the state.
    ///
    /// The state must pass [`check_consistent`](Self::check_consistent); what is left is projected away, and [`Trajectory::adjustment`] tells how far that moved it.
    ///
    /// Every step is kept. Where the end alone is of interest, or states at some times, [`motion(state).every(0.1)`](MotionBuilder::every)
    /// keeps none.
    ///
    /// Steps lead from one time that the scalar can hold to the next, which at a Unix time in seconds are 2.4·10⁻⁷
    /// apart: where a motion is faster, count the time from nearby.
    ///
    /// # Errors
    /// What is wrong before the first step: entries, equations, settings or times that are not finite or not
    /// positive, a state off the constraints ([`make_consistent`](Self::make_consistent) helps), singular or
    /// contradictory equations. [`Error::Unfinished`] where the motion stops before its end: it says when, by which
    /// coordinate or constraint, why and what helps. [`motion`](Self::motion) has more settings.
    #[cfg(feature = "alloc")]
    fn integrate<P: Method<Self, N, M>>(
        &self,
        state: State<Self::Scalar, N>,
        end: Self::Scalar,
        method: P,
    ) -> Result<Trajectory<&Self, N, M>, Error> {
        self.motion(state).by(method).to(end)
    }

    /// The settings of a motion from this state: method, events, who looks at its progress, what is kept and who steers are chosen one by
    /// one, then [`to`](MotionBuilder::to) integrates. [`motion_in_momenta`](crate::Hamiltonian::motion_in_momenta) does the same for Hamilton's
    /// equations, [`motion_with_derivatives`](crate::MotionDerivatives::motion_with_derivatives) for a motion with its derivatives.
    ///
    /// ```
    /// use lagrange_core::{Ending, prelude::*};
    ///
    /// /// A bead that slides off a sphere.
    /// #[derive(Lagrangian)]
    /// #[coordinates(r, theta)]
    /// #[lagrangian(m/2 * (r_dot^2 + r^2 * theta_dot^2) - m*g*r*cos(theta))]
    /// #[constraint(sphere: r - a = 0)]
    /// struct Bead { m: f64, g: f64, a: f64 }
    ///
    /// let bead = Bead { m: 1.0, g: 9.81, a: 1.0 };
    /// let start = State::new([1.0, 0.0], [0.0, 0.1]);
    /// let leaves = bead.event("leaves", |sample| sample.multiplier("sphere")).falling().terminal();
    /// let path = bead.motion(start).by(Dop853::with_tolerance(1e-12)).event(leaves).to(100.0)?;
    /// assert!(matches!(path.ending(), Ending::Event { event: "leaves", .. }));
    /// // From rest it would be where cos θ = 2/3.
    /// let leaves = path.end().coordinate("theta")?.cos();
    /// assert!((leaves - (2.0 + 0.01 / 9.81) / 3.0).abs() < 1e-9);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// Where a motion fails before its end, [`to`](MotionBuilder::to) returns an error, [`towards`](MotionBuilder::towards) the trajectory
    /// up to there:
    ///
    /// ```
    /// # use lagrange_core::{Ending, prelude::*};
    /// /// A stone that falls into a star.
    /// #[derive(Lagrangian)]
    /// #[coordinates(r)]
    /// #[lagrangian(r_dot^2/2 + 1/r)]
    /// struct Stone;
    ///
    /// let start = State::at_rest([1.0]);
    /// let error = Stone.motion(start).to(2.0).unwrap_err();
    /// assert!(error.to_string().starts_with("stopped at t = 1.11"));
    ///
    /// let path = Stone.motion(start).towards(2.0)?;
    /// let collision = core::f64::consts::PI / 8.0_f64.sqrt();
    /// assert!((path.end().time() - collision).abs() < 1e-6);
    /// assert!(path.ending().is_failure() && path.at(1.0)?.velocity("r")? < -1.0);
    /// # Ok::<(), Error>(())
    /// ```
    #[cfg(feature = "alloc")]
    fn motion<'w>(
        &self,
        start: State<Self::Scalar, N>,
    ) -> MotionFrom<'_, 'w, Self, LagrangianVectorField, N, M> {
        MotionBuilder::new(self, Start::new(check_finite(self, &start).map(|()| start)))
    }

    /// A state at t = 0 from names: `x` a coordinate, `x_dot` its velocity, `r[0]` and `r_dot[0]` those of a vector;
    /// what is not named is zero.
    ///
    /// # Errors
    /// [`Error::UnknownName`], which says what the name means instead or lists the names, and [`Error::RepeatedName`].
    #[cfg(feature = "alloc")]
    fn state_from(&self, entries: &[(&str, Self::Scalar)]) -> Result<State<Self::Scalar, N>, Error> {
        let mut state = State::at_rest([Self::Scalar::constant(0.0); N]);
        let known = lookup::entries::<Self, N, M>();
        for (i, (name, value)) in entries.iter().enumerate() {
            if entries.iter().take(i).any(|(earlier, _)| earlier == name) {
                return Err(Error::RepeatedName { name: (*name).into() });
            }
            let index = lookup::index::<Self, N, M>(&known, "coordinate or velocity", name)?;
            let half = if index < N { &mut state.q } else { &mut state.v };
            half[index % N] = *value;
        }
        Ok(state)
    }
}

impl<L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize> Simulate<N, M> for L {}
