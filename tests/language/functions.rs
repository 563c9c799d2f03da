//! Functions that the user supplies, in every form.

use lagrange_core::function::{SmoothTable, Table};
use lagrange_core::{nalgebra::Const, prelude::*};

/// A body on a spring whose force was measured, in a lift whose height is known at some times.
#[derive(Lagrangian)]
#[coordinates(x)]
#[function(U(x))]
#[function(height(t) = lift)]
#[lagrangian(m/2*(x_dot + der(height(t)))^2 - U(x) - m*g*(x + height(t)))]
#[expect(non_snake_case, reason = "as it is written in the Lagrangian")]
struct Lift {
    m: f64,
    g: f64,
    U: Table,
    lift: Table,
}

#[test]
fn tables_are_potentials_and_motions() -> Result<(), Error> {
    // Both parabolas x² inside, away from the ends where the spline straightens.
    let parabola: Vec<_> = (-400..=400).map(|i| f64::from(i) / 40.0).map(|x| (x, x * x)).collect();
    let table = Table::new(&parabola)?;
    let lift = Lift { m: 2.0, g: 9.81, U: table.clone(), lift: table };
    let state = State::new([0.3], [0.1]).at_time(0.2);
    // m (ẍ + height″) = −U′ − m g
    let expected = -2.0 - 2.0 * 0.3 / 2.0 - 9.81;
    assert!((lift.solve(&state)?.accelerations[0] - expected).abs() < 1e-12);
    Ok(())
}

/// U′ and U″ in the Lagrangian itself: the equations need the third derivative.
#[derive(Lagrangian)]
#[coordinates(x)]
#[function(height(t) = lift)]
#[lagrangian(x_dot^2/2 + x_dot*der(der(height(t))))]
struct Jerked<F> {
    lift: F,
}

struct Cubic;

impl Function<1, 1> for Cubic {
    fn eval<S: Scalar>(&self, [t]: [S; 1]) -> [S; 1] {
        [t * t * t]
    }
}

impl<F> Jerked<F>
where
    Self: Lagrangian<N = Const<1>, M = Const<0>, Scalar = f64>,
{
    /// −d³h/dt³
    fn jerk(lift: F, t: f64) -> f64 {
        Self { lift }.accelerations_unchecked(&State::at_rest([0.0]).at_time(t)).accelerations[0]
    }
}

#[test]
fn third_derivatives_are_known_of_smooth_tables_and_of_what_is_written_for_every_scalar() -> Result<(), Error>
{
    assert_eq!(Jerked::jerk(Cubic, 0.7), -6.0);
    let parabola: Vec<_> = (0..9).map(f64::from).map(|t| (t, t * t)).collect();
    assert!(Jerked::jerk(SmoothTable::new(&parabola)?, 3.7).abs() < 1e-11);
    let sines: Vec<_> = (0..=80).map(|i| f64::from(i) / 10.0).map(|t| (t, t.sin())).collect();
    assert!((Jerked::jerk(SmoothTable::new(&sines)?, 4.03) - 4.03_f64.cos()).abs() < 1e-4);
    Ok(())
}

/// Nothing is asked of a function that no expression calls.
#[derive(Lagrangian)]
#[coordinates(x)]
#[function(U(x) = spare)]
#[lagrangian(x_dot^2/2)]
struct Free {
    #[expect(dead_code, reason = "no expression calls it")]
    spare: &'static str,
}

#[test]
fn a_function_that_is_not_called_may_be_anything() {
    assert_eq!(Free { spare: "" }.accelerations_unchecked(&State::at_rest([0.0])).accelerations[0], 0.0);
}

/// A reference to a function, and a function shared by two names.
#[derive(Lagrangian)]
#[coordinates(x)]
#[function(U(x) = potential)]
#[function(again(s) = potential)]
#[lagrangian(x_dot^2/2 - U(x) - again(2*x))]
struct Shared<'a, F: ?Sized> {
    potential: &'a F,
}

#[test]
fn a_function_may_be_borrowed_and_named_twice() {
    let shared = Shared { potential: &Cubic };
    // −(x³ + 8x³)′ at 2
    assert_eq!(shared.forcing(&State::at_rest([2.0]))[0], -108.0);
}

/// The smaller of x and a number that nothing here comes near.
struct Capped;

impl Function<1, 1> for Capped {
    fn eval<S: Scalar>(&self, [x]: [S; 1]) -> [S; 1] {
        [x.min(S::constant(1e16))]
    }
}

#[test]
fn a_bound_far_away_leaves_value_and_force() {
    let capped = Shared { potential: &Capped };
    let state = State::at_rest([1.5]);
    // −U(x) − U(2x) with U(x) = x
    assert_eq!(capped.lagrangian(&state), -4.5);
    assert_eq!(capped.forcing(&state)[0], -3.0);
}
