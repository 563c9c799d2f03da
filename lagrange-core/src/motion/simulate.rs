//! The trait [`Simulate`]: solving the equations of a system, and integrating its motion.

use super::event::{Event, EventValue};
use crate::error::Error;
use crate::number::Real;
use crate::solution::Sample;
use crate::solution::consistent::assembly::Assembly;
use crate::solution::consistent::{self, Consistent};
use crate::solution::reason::reason;
use crate::solution::solve::solve;
use crate::solution::vector_field::VectorField;
use crate::system::finite::check_finite;
use crate::system::{Lagrangian, SolutionOf, StateOf, System};
use crate::vector::Array;
#[cfg(feature = "alloc")]
use crate::{
    motion::{
        Method, MotionBuilder,
        integration::builder::{MotionFrom, Start},
    },
    number::Scalar,
    solution::impact::{Impact, impact},
    solution::system_checks::SystemChecks,
    system::{State, lookup},
    trajectory::Trajectory,
    vector::{StaticLength, Vector, from_fn},
};

/// Solves, initializes and integrates a system. It is implemented for every [`Lagrangian`] over `f64` or `f32`, and, as far as
/// accelerations alone allow, for every other [`System`].
pub trait Simulate: System<Scalar: Real, Field: VectorField<Self>> + Sized {
    /// Returns accelerations and multipliers at a state.
    ///
    /// They are the results of [`accelerations_unchecked`](Lagrangian::accelerations_unchecked) if its smallest pivot
    /// exceeds ε^(1/3) (6·10⁻⁶ for `f64`), which costs at most a third of the digits. Else the general solver by null
    /// space is used. It copes with a mass matrix that is singular or indefinite, and with dependent constraints;
    /// [`Solution::multipliers_are_unique`](crate::Solution::multipliers_are_unique) reports the latter.
    ///
    /// # Errors
    /// [`Error::StateNotFinite`] and [`Error::ParameterNotAsSaid`], even for entries that the equations do not use;
    /// [`Error::EquationsNotFinite`], [`Error::ParameterNotFinite`] and [`Error::ZeroQuaternion`]; [`Error::Singular`] if an
    /// acceleration is undetermined; [`Error::Contradictory`]
    /// if dependent constraints demand different accelerations; [`Error::NoGradient`] if the row of a constraint is
    /// zero; [`Error::DependentToFirstOrder`] if the row of a combination of constraints is zero. Each names the
    /// coordinates or the constraint. [`check_consistent`](Self::check_consistent) checks that the state is on the
    /// constraints, and that no row is zero up to round-off.
    fn solve(&self, state: &StateOf<Self>) -> Result<SolutionOf<Self>, Error>
    where
        Self: Lagrangian,
    {
        solve(self, state)
    }

    /// Checks that the state satisfies the constraints, to √ε of the size of their terms (1.5·10⁻⁸ for `f64`).
    ///
    /// # Errors
    /// [`Error::StateNotFinite`] and [`Error::ParameterNotAsSaid`]; [`Error::Inconsistent`], with the first constraint
    /// that the state violates; [`Error::NoGradient`], with the first constraint that fixes no acceleration.
    fn check_consistent(&self, state: &StateOf<Self>) -> Result<(), Error>
    where
        Self: Lagrangian,
    {
        check_finite(self, state)?;
        consistent::check(self, state)
    }

    /// Projects a state onto the constraints. Returns the nearest consistent state and its distance from the given one.
    ///
    /// First the coordinates are projected onto Φ = 0 of the holonomic constraints, then the velocities onto F q̇ + b =
    /// 0 of all constraints. Distances are measured in the metric of the mass matrix. For coordinates it is taken at
    /// the given state, M(q₀)(q − q₀) = Fᵀμ, for velocities at the projected coordinates. If the mass matrix is not
    /// positive definite, its diagonal is used. The result is a local minimum of the distance, unless a hundred steps
    /// did not suffice (a chain of 50 rods far off the constraints takes 31). If the constraints curve more sharply
    /// than the distance does, as seen from near the centre of an ellipse, some point farther along may be nearer
    /// still.
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
    /// [`Error::StateNotFinite`], [`Error::NotProjected`] if Newton's iteration does not converge, and
    /// [`Error::NoGradient`] if a constraint holds and its gradient vanishes.
    fn make_consistent(&self, state: &StateOf<Self>) -> Result<Consistent<Self::Scalar, Self::N>, Error>
    where
        Self: Lagrangian,
    {
        check_finite(self, state)?;
        consistent::make_consistent(self, state, &[Array::filled(false); 2])
            .map_err(|error| reason(self, state, error))
    }

    /// Assembles a mechanism from a rough guess: finds consistent coordinates, and velocities along the constraints, near
    /// the guess. Reports the number of independent constraints, the degrees of freedom and redundant constraints.
    ///
    /// From a guess where [`make_consistent`](Self::make_consistent) fails, the coordinates with the least squared
    /// residuals are sought first (Levenberg and Marquardt). If the constraints do not hold there, those that remain
    /// violated are named.
    ///
    /// ```
    /// # use lagrange_core::prelude::*;
    /// /// Two rods from pivots a distance d apart, and a coupler.
    /// #[derive(Lagrangian)]
    /// #[coordinates(p: [2], q: [2])]
    /// #[lagrangian((dot(p_dot, p_dot) + dot(q_dot, q_dot))/2)]
    /// #[constraint(left: dot(p, p) = 1)]
    /// #[constraint(right: (q[0] - d)^2 + q[1]^2 = 1)]
    /// #[constraint(coupler: dot(q - p, q - p) = 4)]
    /// struct Linkage { d: f64 }
    ///
    /// let guess = State::at_rest([0.0, 0.3, 5.0, 0.1]);
    /// let assembly = Linkage { d: 3.0 }.assemble(&guess)?;
    /// assert_eq!((assembly.rank, assembly.degrees_of_freedom), (3, 1));
    ///
    /// // The rods and the coupler do not reach from one pivot to the other.
    /// let error = Linkage { d: 6.0 }.assemble(&guess).unwrap_err();
    /// assert!(error.to_string().starts_with("the constraints `left`, `right`, `coupler` conflict"), "{error}");
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Conflicting`]; the errors of [`make_consistent`](Self::make_consistent).
    fn assemble(&self, guess: &StateOf<Self>) -> Result<Assembly<Self::Scalar, Self::N>, Error>
    where
        Self: Lagrangian,
    {
        check_finite(self, guess)?;
        consistent::assembly::assemble(self, guess)
    }

    /// Like [`make_consistent`](Self::make_consistent), with some entries held at their given values. They are named as
    /// in [`state_from`](Self::state_from), or `r` and `r_dot` for all entries of a vector. The other entries move to
    /// the nearest state, in the metric of their block of the mass matrix.
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
    /// The errors of [`make_consistent`](Self::make_consistent); [`Error::HeldTooMuch`], with the constraint that the
    /// other entries cannot satisfy; [`Error::UnknownName`] and [`Error::RepeatedName`].
    #[cfg(feature = "alloc")]
    fn make_consistent_holding(
        &self,
        state: &StateOf<Self>,
        held: &[&str],
    ) -> Result<Consistent<Self::Scalar, Self::N>, Error>
    where
        Self: Lagrangian,
    {
        check_finite(self, state)?;
        let known = lookup::entries::<Self>();
        let held = lookup::indices::<Self>(&known, "coordinate or velocity", held)?;
        let [q, v] = [0, <Self::N>::COUNT].map(|half| from_fn(|i| held.contains(&(half + i))));
        consistent::make_consistent(self, state, &[q, v])
    }

    /// Pairs a state with this system, to evaluate coordinates, energies, forces and other quantities by name.
    fn sample(&self, state: StateOf<Self>) -> Sample<&Self> {
        Sample::of(self, state)
    }

    /// Defines an event of this system: the zero crossings of a function of its motion. The function takes a sample and
    /// returns a number, or the result of a query by name.
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
    /// [`Event`] describes which crossings are found and which are not, and has the settings.
    fn event<V: EventValue<Self::Scalar>, G: Fn(&Sample<&Self>) -> V>(
        &self,
        name: &'static str,
        function: G,
    ) -> Event<Self, G> {
        Event::new(name, function)
    }

    /// Returns the state after an impact on the constraint `constraint`. The rate of this constraint is reversed and
    /// multiplied by `restitution`; all other constraints continue to hold.
    ///
    /// The impact satisfies M(v⁺ − v⁻) = FᵀΛ, with F v⁺ + b = −e (F v⁻ + b) in the row of the impact and F v⁺ + b = 0
    /// in the other rows. The restitution e ranges from 0, a plastic impact, to 1, an elastic one. This system, which
    /// has the constraint, provides the factorization; the motions before and after may be those of another system with
    /// the same coordinates. If the momenta are linear in the velocities, they jump by FᵀΛ.
    ///
    /// The caller must know that the bodies approach: a separating rate is reversed as well, by an impulse that pulls.
    /// After a plastic impact the bodies stay together. The motion then continues by the system that has the
    /// constraint, as long as its multiplier pushes.
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
    /// [`Error::UnknownName`]; [`Error::Restitution`]; [`Error::StateNotFinite`]; [`Error::Inconsistent`] if the
    /// coordinates are not on a constraint; [`Error::Singular`] and [`Error::Contradictory`] as [`solve`](Self::solve).
    #[cfg(feature = "alloc")]
    fn impact(
        &self,
        state: &StateOf<Self>,
        constraint: &str,
        restitution: Self::Scalar,
    ) -> Result<Impact<Self>, Error>
    where
        Self: Lagrangian,
    {
        let hit = lookup::index::<Self>(Self::CONSTRAINTS, "constraint", constraint)?;
        impact(self, state, hit, restitution)
    }

    /// Integrates the motion from a state to the time `end` by the given method. If `end` is before the state, it
    /// integrates backwards.
    ///
    /// The state must pass [`check_consistent`](Self::check_consistent). The remaining violation is projected away;
    /// [`Trajectory::adjustment`] holds the change of the state.
    ///
    /// Every step is kept. If only the end is needed, or states at some times,
    /// [`motion(state).every(0.1)`](MotionBuilder::every) keeps no steps.
    ///
    /// Steps lead from one representable time to another. Near a Unix time in seconds these are 2.4·10⁻⁷ s apart: if a
    /// motion is faster, choose a nearer origin of time.
    ///
    /// # Errors
    /// Errors before the first step: entries, equations, settings or times that are not finite or not positive; a state
    /// off the constraints (use [`make_consistent`](Self::make_consistent)); singular or contradictory equations.
    /// [`Error::Unfinished`] if the motion stops before its end, with the time, the coordinate or constraint, the
    /// reason and a remedy. [`motion`](Self::motion) has more settings.
    #[cfg(feature = "alloc")]
    fn integrate<P: Method<Self>>(
        &self,
        state: StateOf<Self>,
        end: Self::Scalar,
        method: P,
    ) -> Result<Trajectory<&Self>, Error> {
        self.motion(state).by(method).to(end)
    }

    /// Returns the settings of a motion from this state. Method, events, progress callback, samples and controller are
    /// chosen one by one; then [`to`](MotionBuilder::to) integrates.
    /// [`motion_in_momenta`](crate::Hamiltonian::motion_in_momenta) does the same for Hamilton's equations,
    /// [`motion_with_derivatives`](crate::MotionDerivatives::motion_with_derivatives) for a motion with its
    /// derivatives.
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
    /// // For a start at rest, cos θ = 2/3.
    /// let leaves = path.end().coordinate("theta")?.cos();
    /// assert!((leaves - (2.0 + 0.01 / 9.81) / 3.0).abs() < 1e-9);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// If a motion fails before its end, [`to`](MotionBuilder::to) returns an error,
    /// [`towards`](MotionBuilder::towards) the trajectory up to there:
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
    fn motion<'w>(&self, start: StateOf<Self>) -> MotionFrom<'_, 'w, Self, Self::Field> {
        MotionBuilder::new(
            self,
            Start::new(
                <Self::Field as VectorField<Self>>::Checks::check_entries(self, &start).map(|()| start),
            ),
        )
    }

    /// Returns a state at t = 0 from named entries: `x` for a coordinate, `x_dot` for its velocity, `r[0]` and
    /// `r_dot[0]` for an entry of a vector. Entries that are not named are zero.
    ///
    /// # Errors
    /// [`Error::UnknownName`], which suggests a name or lists all names, and [`Error::RepeatedName`].
    #[cfg(feature = "alloc")]
    fn state_from(&self, entries: &[(&str, Self::Scalar)]) -> Result<StateOf<Self>, Error>
    where
        Self: Lagrangian,
    {
        let mut state = State::at_rest(Array::filled(Self::Scalar::constant(0.0)));
        let known = lookup::entries::<Self>();
        for (i, (name, value)) in entries.iter().enumerate() {
            if entries.iter().take(i).any(|(earlier, _)| earlier == name) {
                return Err(Error::RepeatedName { name: (*name).into() });
            }
            let index = lookup::index::<Self>(&known, "coordinate or velocity", name)?;
            let half: &mut Vector<_, _> = if index < <Self::N>::COUNT { &mut state.q } else { &mut state.v };
            half[index % <Self::N>::COUNT] = *value;
        }
        Ok(state)
    }
}

impl<L: System<Scalar: Real, Field: VectorField<L>>> Simulate for L {}
