//! Methods of Gauss and of Lobatto, and the reversible method for constraints on velocities.

use core::fmt;

use super::fixed_step::FixedStep;
use super::partitioned::advance;
use super::scheme::{CompensatedState, Scheme, SymmetricScheme};
use super::settle::NotSettled;
use super::stage_memory::StageMemory;
use super::tableau::{GAUSS_1, GAUSS_2, GAUSS_3, GAUSS_4, LOBATTO_2, LOBATTO_3, LOBATTO_4, Tableau};
#[cfg(doc)]
use super::verlet::Verlet;
use crate::number::Parts;
use crate::structure::{HolonomicConstraints, Unconstrained};
use crate::system::{Lagrangian, StateOf};

/// The methods of Gauss with `S` stages, 1 to 4: symplectic, of order 2 `S`, for every Lagrangian without constraints.
///
/// They are the implicit Runge–Kutta methods at the zeros of Legendre's polynomials, applied in coordinates and momenta
/// (Hairer, Lubich and Wanner, *Geometric Numerical Integration*, II.1.3 and VI.4). The mass matrix may depend on the
/// coordinates, and forces on the velocities; what forces take from the energy is integrated to the same order.
/// [`Gauss<1>`](Self) is the implicit midpoint rule.
///
/// ```
/// use lagrange_core::prelude::*;
///
/// /// Two equal pendulums, one below the other.
/// #[derive(Lagrangian)]
/// #[coordinates(a, b)]
/// #[lagrangian(a_dot^2 + b_dot^2/2 + a_dot*b_dot*cos(a - b) + 2*cos(a) + cos(b))]
/// struct DoublePendulum;
///
/// let start = State::new([1.0, 0.0], [0.0, 0.0]);
/// let path = DoublePendulum.integrate(start, 100.0, Gauss::<4>::with_step(0.1))?;
/// assert!((DoublePendulum.energy(path.end().state()) / DoublePendulum.energy(&start) - 1.0).abs() < 1e-9);
/// # Ok::<(), Error>(())
/// ```
///
/// An iteration finds the stages, to round-off. It begins with the stages of the step before, extrapolated, and contracts
/// by a factor proportional to the step length. If it does not converge, the motion ends and says so: the step is too
/// long. Compensated sums keep coordinates and momenta. The coefficients are rounded, so the energy drifts by about
/// 10⁻¹⁸ of itself per step.
pub type Gauss<const S: usize> = FixedStep<GaussLegendre<S>>;

/// The pair of Lobatto IIIA and IIIB with `S` stages, 2 to 4: symplectic, of order 2 `S` − 2, for every Lagrangian with
/// holonomic constraints or none.
///
/// The constraints hold at every stage and at the end of a step, to round-off, and so do those of the velocities at the
/// end (Jay, *SIAM Journal on Numerical Analysis* 33, 1996; Hairer, Lubich and Wanner, *Geometric Numerical Integration*,
/// VII.1.4). `Lobatto<2>` generalizes [`Verlet`] to mass matrices that depend on the coordinates, moving frames and
/// forces that depend on the velocities; where both apply, they give the same motion. Constraints must be independent. A
/// singular mass matrix, as that of a unit quaternion, is completed by constraints
/// ([`completed_momentum`](crate::Lagrangian::completed_momentum)). Otherwise as [`Gauss`].
///
/// ```
/// use lagrange_core::prelude::*;
///
/// /// A bead on a parabola in a frame that turns about the vertical.
/// #[derive(Lagrangian)]
/// #[coordinates(r, z)]
/// #[lagrangian((r_dot^2 + z_dot^2 + omega^2*r^2)/2 - 9.81*z)]
/// #[constraint(wire: z - r^2/2 = 0)]
/// struct Bead { omega: f64 }
///
/// let (bead, start) = (Bead { omega: 2.0 }, State::new([1.0, 0.5], [0.0, 0.0]));
/// let path = bead.integrate(start, 50.0, Lobatto::<3>::with_step(0.02))?;
/// let end = path.end();
/// assert!((bead.energy(end.state()) - bead.energy(&start)).abs() < 1e-6);
/// assert!(bead.constraint_residual(end.state())[0].abs() < 1e-15);
/// # Ok::<(), Error>(())
/// ```
pub type Lobatto<const S: usize> = FixedStep<LobattoPair<S>>;

/// A reversible method of order 2 for every Lagrangian with constraints on velocities, holonomic ones or both.
///
/// It is a discrete Lagrange–d'Alembert principle: the change of the coordinates over a step satisfies the constraints at
/// its middle, and the velocities at its end satisfy them there (Cortés and Martínez, *Nonlinearity* 14, 2001; McLachlan
/// and Perlmutter, *Journal of Nonlinear Science* 16, 2006). [`composed`](FixedStep::composed) makes it a method of order 4,
/// 6 or 8. With holonomic constraints alone it is [`Lobatto<2>`](Lobatto). Constraints must be independent.
///
/// The method is reversible. It does not keep a symplectic form, because a nonholonomic motion has none. It keeps the energy
/// on the usual problems, but not on motions that no reversal maps to themselves, as no known method does (Modin and
/// Verdier, *Numerische Mathematik* 145, 2020): the page “Which method” of the book, `book/src/methods.md`, has a table.
///
/// ```
/// use lagrange_core::prelude::*;
///
/// /// A skate on an inclined plane, at the position (x, y) with the direction θ.
/// #[derive(Lagrangian)]
/// #[coordinates(x, y, theta)]
/// #[lagrangian((x_dot^2 + y_dot^2 + theta_dot^2)/2 + x)]
/// #[constraint(blade: x_dot*sin(theta) - y_dot*cos(theta) = 0)]
/// struct Skate;
///
/// let start = State::new([0.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
/// let path = Skate.integrate(start, 100.0, DAlembert::with_step(0.01))?;
/// // It does not slide down: x = sin²(t)/2.
/// assert!((path.end().coordinate("x")? - 100.0_f64.sin().powi(2) / 2.0).abs() < 1e-4);
/// # Ok::<(), Error>(())
/// ```
pub type DAlembert = FixedStep<LagrangeDAlembert>;

/// The scheme of [`Gauss`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GaussLegendre<const S: usize>;

/// The scheme of [`Lobatto`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LobattoPair<const S: usize>;

/// The scheme of [`DAlembert`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LagrangeDAlembert;

impl SymmetricScheme for LagrangeDAlembert {}

/// A number of stages with coefficients.
#[diagnostic::on_unimplemented(
    message = "there are no coefficients for `{Self}`",
    label = "no such number of stages",
    note = "`Gauss` has 1 to 4 stages and the orders 2 to 8, `Lobatto` 2 to 4 stages and the orders 2 to 6; for smaller errors take shorter steps, or `Taylor`"
)]
pub trait StageCount {
    #[doc(hidden)]
    type Table: 'static;
    #[doc(hidden)]
    const TABLE: &'static Self::Table;
}

macro_rules! tables {
    ($($scheme:ident<$stages:literal> $table:ident),*) => {$(
        impl StageCount for $scheme<$stages> {
            type Table = Tableau<$stages>;
            const TABLE: &'static Tableau<$stages> = &$table;
        }
    )*};
}

tables!(
    GaussLegendre<1> GAUSS_1, GaussLegendre<2> GAUSS_2, GaussLegendre<3> GAUSS_3, GaussLegendre<4> GAUSS_4,
    LobattoPair<2> LOBATTO_2, LobattoPair<3> LOBATTO_3, LobattoPair<4> LOBATTO_4
);

macro_rules! schemes {
    ($([$($generic:tt)*] $scheme:ty, $stages:expr, $order:expr, $name:literal, $table:expr, [$($bound:tt)*];)*) => {$(
        impl<L, $($generic)*> Scheme<L> for $scheme
        where
            L: Lagrangian<Scalar: Parts> $($bound)*
        {
            type Carried = StageMemory<L::Factor, L::Scalar, L::N, L::M, { $stages }>;

            const ORDER: usize = $order;

            fn identify(to: &mut dyn fmt::Write) -> fmt::Result {
                write!(to, "{} {}", $name, $stages)
            }

            fn start(system: &L, state: &StateOf<L>) -> Self::Carried {
                StageMemory::start(system, state)
            }

            fn start_after(system: &L, state: &StateOf<L>, before: &Self::Carried) -> Self::Carried {
                StageMemory::start_after(system, state, before)
            }

            fn advance(
                system: &L,
                point: &mut CompensatedState<L::Scalar, L::N>,
                carried: &mut Self::Carried,
                step: (L::Scalar, L::Scalar),
            ) -> Result<usize, NotSettled> {
                advance($table, system, point, carried, step)
            }
        }
    )*};
}

schemes! {
    [const S: usize] GaussLegendre<S>, S, 2 * S, "Gauss", Self::TABLE,
        [+ Unconstrained, Self: StageCount<Table = Tableau<S>>];
    [const S: usize] LobattoPair<S>, S, 2 * S - 2, "Lobatto", Self::TABLE,
        [+ HolonomicConstraints, Self: StageCount<Table = Tableau<S>>];
    [] LagrangeDAlembert, 2, 2, "DAlembert", &LOBATTO_2, [];
}
