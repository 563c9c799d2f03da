//! Contacts: gaps that never become negative, whose multipliers never become negative either; and friction.
//!
//! `#[contact(floor: y - r >= 0, restitution: e)]` states a gap, and a field of the same name and of the type
//! [`Contact`] says whether it is closed. While it is, the gap is a constraint, and its multiplier the force that keeps the
//! bodies apart: d/dt(∂L/∂q̇) = ∂L/∂q + Q + Fᵀλ with λ ≥ 0. While it is open, λ = 0.
//!
//! [`MotionBuilder::with_contacts`](crate::MotionBuilder::with_contacts) moves such a system from transition to transition:
//! gaps that close, and multipliers that become zero, are located as events. Which contacts push, stick and slide follows from one law for
//! impulses and velocities and for forces and accelerations (De Saxcé and Feng 1998; Acary, Brémond and Huber 2018),
//! solved to round-off and compared with the law. Restitution is Newton's, `restitution: e`: a gap that closes at the rate v opens at the rate −e v; or Poisson's,
//! `restitution(poisson): e`: the impulse that stops the gap is followed by e times as much.
//!
//! ```
//! use lagrange_core::contact::{Contact, Transition};
//! use lagrange_core::prelude::*;
//!
//! #[derive(Clone, Lagrangian)]
//! #[coordinates(x, y)]
//! #[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
//! #[contact(floor: y >= 0, restitution: e)]
//! struct Ball { m: f64, g: f64, e: f64, floor: Contact }
//!
//! let ball = Ball { m: 0.2, g: 9.81, e: 0.8, floor: Contact::Open };
//! let path = ball.motion(State::new([0.0, 1.0], [0.5, 0.0])).with_contacts().to(10.0)?;
//!
//! // It falls for T, bounces for 2 e T, 2 e² T …, and rests after the sum of them.
//! let fall = (2.0 / 9.81_f64).sqrt();
//! let Transition::Impact { time, .. } = path.transitions()[0] else { panic!() };
//! assert!((time - fall).abs() < 1e-14);
//! let rests = path.transitions().iter().find(|transition| matches!(transition, Transition::Rests { .. }));
//! assert!((rests.expect("it rests").time() - fall * 1.8 / 0.2).abs() < 1e-12);
//! assert_eq!((path.end().state().q[1], path.end().state().v[0]), (0.0, 0.5));
//! # Ok::<(), Error>(())
//! ```
//!
//! # Friction
//!
//! `friction(mu): v` adds Coulomb's friction to a contact, along a velocity v = W q̇ + b, or a vector of two. Its multiplier
//! has the name of the contact and `_friction`, and is the force along v, with the sign convention of all others: Wᵀλ is what
//! acts on the coordinates. While the bodies stick, v = 0 and |λ| ≤ μ λ_N; while they slide, λ = −μ λ_N v/|v|.
//!
//! `friction(static: mu, kinetic: nu): v` has a larger coefficient while the bodies stick. What begins to slide has ν from then on, and so
//! has an impact of bodies that slide; what stops has μ.
//!
//! λ_N is the force between the bodies if the gap is a distance where it closes, and v the velocity of one body past the other: with `3*y`
//! for `y` friction is a third of what it should be. A gap r² − x² − y² beside a velocity (x ẏ − y ẋ)/r does not compile, nor does any
//! other whose gradient is perpendicular to those of its velocities along two or three Cartesian coordinates, but differs from them in length;
//! nor a velocity that has a part across a gap of two Cartesian coordinates, as ẋ beside a hill. What depends on fewer coordinates,
//! or on angles, is not compared.
//!
//! `#[friction(belt: v, limit: hold, sliding: pull)]` is dry friction with bounds of its own, by a field `belt: Friction`: it
//! sticks with a force up to `hold`, which is `pull` if it is not given, and slides with the force −`pull` v/|v|.
//!
//! ```
//! use lagrange_core::contact::{Contact, Transition};
//! use lagrange_core::prelude::*;
//!
//! /// A sphere that is thrown along a floor.
//! #[derive(Clone, Lagrangian)]
//! #[coordinates(x, y, phi)]
//! #[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*r^2/5 * phi_dot^2 - m*g*y)]
//! #[contact(floor: y - r >= 0, friction(mu): x_dot - r*phi_dot)]
//! struct Sphere { m: f64, g: f64, r: f64, mu: f64, floor: Contact }
//!
//! let sphere = Sphere { m: 0.4, g: 9.81, r: 0.3, mu: 0.25, floor: Contact::Closed };
//! let path = sphere.motion(State::new([0.0, 0.3, 0.0], [2.0, 0.0, 0.0])).with_contacts().to(1.0)?;
//!
//! // It slides with −μ m g, until it rolls with 5/7 of its velocity.
//! let Transition::Sticks { friction: "floor_friction", time } = path.transitions()[0] else { panic!() };
//! assert!((time - 2.0 / 7.0 * 2.0 / (0.25 * 9.81)).abs() < 1e-12);
//! assert!((path.at(0.1)?.multiplier("floor_friction")? + 0.25 * 0.4 * 9.81).abs() < 1e-12);
//! assert!((path.end().state().v[0] - 5.0 / 7.0 * 2.0).abs() < 1e-12);
//! assert_eq!(path.system().floor, Contact::Closed);
//! # Ok::<(), Error>(())
//! ```
//!
//! The velocities at the start say whether friction sticks or slides, whatever the fields do.
//!
//! # A motion without `with_contacts`
//!
//! Without `with_contacts`, a motion of a system with contacts does not compile, since it would pass through them:
//!
//! ```compile_fail
//! # use lagrange_core::contact::Contact;
//! # use lagrange_core::prelude::*;
//! # #[derive(Clone, Lagrangian)]
//! # #[coordinates(y)]
//! # #[lagrangian(y_dot^2/2 - g*y)]
//! # #[contact(floor: y >= 0)]
//! # struct Ball { g: f64, floor: Contact }
//! let ball = Ball { g: 9.81, floor: Contact::Open };
//! let path = ball.integrate(State::at_rest([1.0]), 1.0, Dop853::default());
//! ```
//!
//! A [`Motion`](crate::Motion), motions with derivatives, Lyapunov exponents and `integrate` of an ensemble do not compile either.
//! [`Trajectory::sensitivity`](crate::Trajectory::sensitivity) has the derivatives across contacts.
//! What looks at one state, as `solve`, `jacobian`, `linearize`, `equilibrium` and `inputs_for`, leaves contacts as their fields say.
//!
//! # Derivatives
//!
//! [`Trajectory::sensitivity`](crate::Trajectory::sensitivity) has the derivatives of the last state by the start and by parameters, across impacts,
//! openings and friction. Where neighbouring motions pass a transition in different ways, there is none:
//! [`Error::NoDerivativeAcross`](crate::Error::NoDerivativeAcross) names it.
//!
//! ```
//! use lagrange_core::contact::Contact;
//! use lagrange_core::prelude::*;
//!
//! /// A block thrown along a floor.
//! #[derive(Clone, Lagrangian)]
//! #[coordinates(x, y)]
//! #[lagrangian((x_dot^2 + y_dot^2)/2 - g*y)]
//! #[contact(floor: y >= 0, friction(mu): x_dot)]
//! struct Block { g: f64, mu: f64, floor: Contact }
//!
//! let (block, method) = (Block { g: 9.81, mu: 0.5, floor: Contact::Closed }, Dop853::with_tolerance(1e-12));
//! let path = block.motion(State::new([0.0, 0.0], [2.0, 0.0])).by(method).with_contacts().to(1.0)?;
//! let end = path.sensitivity(&["mu"], method)?;
//! // It stops after v²/(2 μ g).
//! assert!((end.q[(0, 0)] + 4.0 / (2.0 * 0.25 * 9.81)).abs() < 1e-11);
//! # Ok::<(), Error>(())
//! ```
//!
//! # What is guaranteed
//!
//! 1. At the stored states no gap is negative and all constraints hold, to the round-off of their terms.
//! 2. Impulses and forces are compared with the law before they are used: no rate is off it by more than 10⁻¹² of its terms, each force is
//!    within its set to the bit, and none but a force that slides already gains energy. Up to the end of a leg, forces stay within the
//!    law to 10⁻⁶ of the largest of them.
//! 3. What cannot be decided so ends the motion by name and time, and what was computed until then is kept: of 100,000 random impacts of
//!    each kind on up to four contacts none where rows are independent or depend on one another, 1 where they nearly do, 48 with masses from
//!    10⁻⁴ to 10⁴, and 1,568 where contacts face each other.
//!
//! # A motion that ended before its time
//!
//! | ended with | what happened | what to do |
//! |---|---|---|
//! | [`Penetration`](crate::Error::Penetration) | a gap is negative at the start, or was passed within a step | start where no gap is negative; set `max_step` of the method |
//! | [`ClosedApart`](crate::Error::ClosedApart) | a field says `Closed`, the state does not | `Contact::Open`: what touches is found |
//! | [`NoGradient`](crate::Error::NoGradient) | a gap closes where it has no gradient, as y³ at 0 | state a distance |
//! | [`FrictionJams`](crate::Error::FrictionJams) | [Painlevé's paradox](#painlevés-paradox) | a lower coefficient, or a spring between the bodies |
//! | [`FrictionUndecided`](crate::Error::FrictionUndecided) | contacts of one body share forces that were not found | [time steps](MoreauJean), or fewer contacts |
//! | [`ContactsContradict`](crate::Error::ContactsContradict) | gaps close in on one another, as walls that move | let one of them yield |
//! | [`ImpactsDoNotEnd`](crate::Error::ImpactsDoNotEnd) | impacts follow one another at one time | less restitution, or none where a light body is between heavy ones |
//! | [`TransitionLimit`](crate::Ending::TransitionLimit) | too many transitions, as of a body that chatters | `max_transitions`, or [time steps](MoreauJean) |
//! | [`StepLimit`](crate::Ending::StepLimit), "looks stiff" | friction along two velocities begins slowly, or a spring is stiff | [`Radau`](crate::linearized::Radau) |
//! | [`MethodFailed`](crate::Ending::MethodFailed), [`TimeTooCoarse`](crate::Ending::TimeTooCoarse) | steps of a loose tolerance pass over where friction along two velocities turns | a tolerance of 10⁻⁷ or less |
//! | [`StepTooLong`](crate::Error::StepTooLong), [`ImpulsesNotFound`](crate::Error::ImpulsesNotFound) | in time steps: forces or contacts change too much in one | shorter steps |
//! | [`EventInTimeSteps`](crate::Error::EventInTimeSteps) | in time steps, an event depends on multipliers | take them as a [`quantity`](crate::MotionBuilder::quantity) of samples |
//!
//! # Bounds
//!
//! With u, the round-off of a gap, 16 ε (Σ |Wᵢ| max |qᵢ| + |rate · t|) with the largest entries so far, or with what the free
//! bodies move from rest in a millionth of the span of the motion:
//!
//! - Bodies touch up to a gap of 4 u. A contact rests if its rate is below the round-off of its terms, or if a bounce would rise by no more
//!   than 64 u. A gap that touches zero at a single point, as x² + y² at 0, does not close there.
//! - Friction is at rest if its velocity is below 16 ε Σ |Wᵢ| max |q̇ᵢ|, with the changes of velocities by impulses among the
//!   largest, or what its limit stops within the round-off of the time; or 64 times that where another one stops: heel and toe of a foot
//!   stop together. Where 10⁻³ of the relative tolerance of the
//!   method is more than 16 ε, it takes the place of that for friction along two velocities, since no step ends where both are zero. A velocity
//!   below that which no force can stop, as along a rail, then counts as rest, too, and its friction is wrong: lower the tolerance. What begins
//!   to slide along two gets 64 times that as a speed, and what its force changes within the round-off of the time.
//! - The limit of friction is left once the force exceeds it by four times its round-off, or by 64 ε of both and of the largest force on a
//!   coordinate that it could balance; a force of contact that
//!   begins at zero, once it is below by as much, but by no more than 5·10⁻⁷ of the largest force.
//! - The direction in which bodies slide along two velocities is renewed where the velocity has turned by 60°.
//! - Where friction is shared, the shares are those with the most of all limits left, to a factor of 2: as loads grow they are decided anew,
//!   until less than 2·10⁻¹² of the limits is left.
//! - A step is not searched for forces that leave their limits where the 16 stages of `Dop853`, or those of `Dopri5` and one more
//!   evaluation, bound the multipliers away from them: no force leaves its limit there unless it is off every cubic polynomial of
//!   the time by more than half its range at the stages, as in a pulse exp(−(t/w)²) with w below 0.15 steps. The search itself
//!   finds all above that, and some below.
//!
//! # Accumulating impacts
//!
//! Once a contact rests, the bounces to come take 2 v/(a (1 − e)) in total, with the rate v after the impact and the
//! acceleration a towards the contact: [`Transition::Rests`] has the time when they end. What they would move is within 64 u.
//!
//! # Impacts with friction
//!
//! Coulomb's law holds for impulses too: |Λ_T| ≤ μ Λ_N, against the velocity after the impact, and no impulse stores energy
//! along the contact. Newton's restitution may gain energy with friction (Kane and Levinson 1985): it is then lowered to where it gains
//! none.
//!
//! # Poisson's law of impact
//!
//! `restitution(poisson): e` divides an impact into compression and expansion (Pfeiffer and Glocker 1996, chapter 8; Glocker,
//! *Set-Valued Force Laws*, 2001). Compression is the impact without restitution, with the impulses Λ. In the expansion a contact pushes
//! with e Λ, and with more only where its gap would close; Coulomb's law holds in each of both. Contacts by Newton's law
//! take their restitution in the compression, and keep it in the expansion.
//!
//! Both laws agree without friction if the contacts of the impact have one e, as for a single contact. They differ where friction
//! sticks: a rod that is thrown along the floor reopens by Poisson's law as fast as its friction has pressed it together. A
//! contact at rest that takes part in an impact returns nothing by Newton's law, and e Λ by Poisson's.
//!
//! ```
//! use lagrange_core::contact::Contact;
//! use lagrange_core::prelude::*;
//!
//! /// Three balls in a row that touch.
//! #[derive(Clone, Lagrangian)]
//! #[coordinates(x: [3])]
//! #[lagrangian(dot(x_dot, x_dot)/2)]
//! #[contact(balls[i in 0..2]: x[i + 1] - x[i] >= 0, restitution(poisson): e[i])]
//! struct Balls { e: [f64; 2], balls: [Contact; 2] }
//!
//! let balls = Balls { e: [0.0, 1.0], balls: [Contact::Open; 2] };
//! let path = balls.motion(State::new([1.0; 3], [1.0, 0.0, 0.0])).with_contacts().to(1.0)?;
//! // Impulses of 2/3 and 1/3 compress. The second contact returns its 1/3, and presses the first two balls together with 1/6.
//! for (v, expected) in path.end().state().v.iter().zip([1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0]) {
//!     assert!((v - expected).abs() < 1e-15);
//! }
//! # Ok::<(), Error>(())
//! ```
//!
//! Poisson's law gains no energy without friction, nor with friction if the contacts of the impact have one e: the kinetic energy is a
//! convex function of the impulses, and those of the expansion leave no more of it than e Λ, with its friction, would. Both laws
//! in one impact may gain energy, and for friction with several e no proof excludes it: all restitutions are then lowered in
//! proportion to where they gain none.
//!
//! [`sensitivity`](crate::Trajectory::sensitivity) has derivatives across an impact by Poisson's law where one contact pushes, without
//! friction or sliding, and an error else. [Time stepping](MoreauJean) is an error, [`Error::ImpactLaw`](crate::Error::ImpactLaw).
//!
//! # Painlevé's paradox
//!
//! Friction may press the bodies together that it slows down. Beyond a coefficient of friction, no force goes with any
//! acceleration, or several do: [`Error::FrictionJams`](crate::Error::FrictionJams) ends the motion with the name of the
//! friction, where the force that presses the bodies together would grow without bound.
//!
//! Several contacts or velocities of one body may share a force of friction in more than one way, as the corners of a box, or
//! two ends of a rod that stick in a corner. While all stick, the motion is the same for all shares; where
//! a body slides on more contacts than determine their forces, as a table on four legs, it is not: three legs press in events, and
//! all four in time steps. Those three are left on which the body rests, if it can. Then only velocities that do not depend on
//! one another stick, those with most of their limit left; the others act with the part of the limit that was found, as
//! [`Contact::Shares`] says, until a force that sticks reaches its limit. Where no share is found, or a force
//! pulls by more than 5·10⁻⁷ of the largest force at the start of what follows, the motion ends with
//! [`Error::FrictionUndecided`](crate::Error::FrictionUndecided).
//!
//! # Which methods
//!
//! Those that solve for accelerations: `Dop853`, `Dopri5`, `Taylor`, `Radau`, `RungeKutta4`. Structure-preserving methods do not
//! compile for contacts with friction. Friction along two velocities v is stiff where these are small, since its direction turns at the rate
//! μ g/|v|. Explicit methods follow a body that a large force sets in motion or that comes to rest for long. Where a force grows slowly past
//! its limit, as on a table that shakes or tilts in two directions, they run into their limit on steps;
//! [`Radau`](crate::linearized::Radau) follows it.
//!
//! # Several contacts at once
//!
//! Bodies that touch several others at an impact share its impulses as the law of all contacts says. By Newton's,
//! each impulse pushes, and each gap that closes reopens at least at the rate −e v. Of contacts that depend on one another,
//! such as the fourth leg of a table, one that is not needed stays open; its gap is zero as long as the others hold.
//!
//! # Many contacts
//!
//! For stacks and heaps, [`MotionBuilder::by_time_stepping`](crate::MotionBuilder::by_time_stepping) takes steps of one length
//! instead, with the impulses of all contacts at once: [`MoreauJean`]. Games and controllers take them one at a time: [`ContactStepper`]. A motion
//! whose impacts are located can be advanced frame by frame, too: [`ContactMotion`].

#[cfg(feature = "alloc")]
pub(crate) mod across;

use core::fmt::Debug;

use crate::number::Broadcast;
use crate::solution::switched::Switched;
pub use crate::system::switch::{Contact, Friction};
use crate::system::{Direction, StateOf};
use crate::vector::Vector;
#[cfg(feature = "alloc")]
pub use {
    crate::trajectory::Transition,
    across::{
        AcrossContacts, ContactMotion, ContactStepper, CrossesContacts, Located, MoreauJean, Stepwise,
        TimeStep,
    },
};

/// Law of impact of a contact, with a coefficient of restitution e.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ImpactLaw {
    /// `restitution: e`: a gap that closes at the rate v opens at least at the rate −e v.
    #[default]
    Newton,
    /// `restitution(poisson): e`: an impulse Λ that stops the gap is followed by one of at least e Λ.
    Poisson,
}

/// A system with contacts whose forces can be differentiated by the state, as [time steps](MoreauJean) need it. The derive macro
/// implements it together with [`Contacts`].
#[diagnostic::on_unimplemented(
    message = "the derivatives of the forces of `{Self}` are not known",
    label = "no `ForceDerivatives`",
    note = "`#[derive(Lagrangian)]` gives it to every system with contacts whose functions (`#[function(…)]`) have one derivative more than its forces need"
)]
pub trait ForceDerivatives: Contacts {
    /// Plain numbers from which the derivatives of the forces along all directions are computed.
    type ForceSlopes: Copy + Debug;

    /// What [`forcing`](crate::Lagrangian::forcing) depends on, in ascending order: 0 is the time, 1 … N are coordinates, N + 1 … 2N
    /// velocities.
    const FORCE_ARGUMENTS: &'static [usize];

    /// Computes the numbers from which the derivatives of [`forcing`](crate::Lagrangian::forcing) at a state follow.
    fn force_slopes(&self, state: &StateOf<Self>) -> Self::ForceSlopes;

    /// Derivative of [`forcing`](crate::Lagrangian::forcing) along a direction, from the [`force_slopes`](Self::force_slopes) of a
    /// state; on [`Lanes`](crate::Lanes), along several directions at once.
    fn force_change_with<S: Broadcast<Self::Scalar>>(
        &self,
        slopes: &Self::ForceSlopes,
        direction: &Direction<S, Self::N>,
    ) -> Vector<S, Self::N>;
}

/// The constraints of one friction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrictionRows {
    /// Index, among the constraints, of the first velocity.
    pub row: usize,
    /// Number of velocities: 1 or 2.
    pub count: usize,
    /// Index of the contact that presses the bodies together; `None` for dry friction with bounds of its own.
    pub contact: Option<usize>,
    /// True if the limit of the force, or its ratio to that of the contact, depends on parameters alone.
    pub has_constant_limit: bool,
}

/// A system with contacts. The derive macro implements it for a struct with `#[contact(…)]`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no contacts",
    label = "no contacts",
    note = "a contact is stated by `#[contact(floor: y >= 0)]`, with a field `floor: Contact`"
)]
pub trait Contacts: Switched {
    /// Index, among the constraints, of each contact.
    const CONTACTS: &'static [usize];

    /// Returns whether contact `index` is open or closed; `None` if there is none of this index.
    fn contact(&self, index: usize) -> Option<Contact>;

    /// Opens or closes contact `index`. Returns `false` if there is none of this index.
    fn set_contact(&mut self, index: usize, contact: Contact) -> bool;

    /// The law of impact of each contact.
    const IMPACT_LAWS: &'static [ImpactLaw];

    /// Coefficient of restitution of contact `index`, from 0 for a plastic impact to 1 for an elastic one.
    fn restitution(&self, index: usize, state: &StateOf<Self>) -> Option<Self::Scalar>;

    /// The constraints of each friction.
    const FRICTIONS: &'static [FrictionRows];

    /// Returns whether friction `index` sticks or slides; `None` if its contact is open.
    fn friction(&self, index: usize) -> Option<Friction>;

    /// Lets friction `index` stick or slide. Returns `false` if there is none of this index.
    fn set_friction(&mut self, index: usize, state: Friction) -> bool;

    /// Largest force of friction `index` while the bodies stick, as a multiple of the multiplier of its contact if it has one.
    fn friction_limit(&self, index: usize, state: &StateOf<Self>) -> Option<Self::Scalar>;

    /// Force of friction `index` while the bodies slide, as a multiple of the multiplier of its contact if it has one.
    fn sliding_friction(&self, index: usize, state: &StateOf<Self>) -> Option<Self::Scalar>;
}
