//! Functions that the user supplies, evaluated on power series.

use lagrange_core::prelude::*;

use super::{difference, end};

/// x²y/2 + sin(x + y), √(1 + x²) + eʸ
#[derive(Clone, Copy)]
struct Pair;

impl Function<2, 2> for Pair {
    fn eval<S: Scalar>(&self, [x, y]: [S; 2]) -> [S; 2] {
        let one = S::constant(1.0);
        [x * x * y * S::constant(0.5) + (x + y).sin(), (one + x * x).sqrt() + y.exp()]
    }
}

/// As a potential, in a mass, in a force, in a constraint, of coordinates, of time, of a parameter and of a constant.
#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[function(F(x, y): [2] = pair)]
#[lagrangian((x_dot^2 + y_dot^2 + (3 + F(x, t/3)[1])*z_dot^2)/2 - F(x, y)[0] - c*F(z/2, 0.3)[1])]
#[force(z: -z_dot*F(c, x)[1]/10)]
#[constraint(rail: z - F(x/4, c)[0]/5 - y/2 = 0)]
struct Supplied<'f, F> {
    c: f64,
    pair: &'f F,
}

/// The formulas instead of the functions.
#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian((x_dot^2 + y_dot^2 + (3 + sqrt(1 + x^2) + exp(t/3))*z_dot^2)/2 - x^2*y/2 - sin(x + y) - c*(sqrt(1 + z^2/4) + exp(0.3)))]
#[force(z: -z_dot*(sqrt(1 + c^2) + exp(x))/10)]
#[constraint(rail: z - (x^2*c/32 + sin(x/4 + c))/5 - y/2 = 0)]
struct Written {
    c: f64,
}

#[test]
fn functions_are_what_is_in_them() -> Result<(), Error> {
    let (supplied, written) = (Supplied { c: 0.7, pair: &Pair }, Written { c: 0.7 });
    let (start, _) = written.make_consistent(&State::new([0.4, -0.2, 0.3], [0.5, 0.8, 0.1]))?;
    let [ours, theirs] = [end(&supplied, start, 2.0)?, end(&written, start, 2.0)?];
    let off = (ours.q - theirs.q).abs().max().max((ours.v - theirs.v).abs().max());
    assert!(off < 1e-14, "{off:e}");
    let off = difference(&supplied, start, 2.0)?;
    assert!(off < 2e-13, "{off:e}");
    Ok(())
}

/// Functions and kinks are those of the system, whoever holds it.
#[test]
fn a_motion_of_a_pointer_is_that_of_the_system() -> Result<(), Error> {
    let supplied = Supplied { c: 0.7, pair: &Pair };
    let start = supplied.make_consistent(&State::new([0.4, -0.2, 0.3], [0.5, 0.8, 0.1]))?.0;
    assert_eq!(end(&&supplied, start, 2.0)?, end(&supplied, start, 2.0)?);
    let (roof, start) = (Bouncing { roof: Roof }, State::at_rest([1.0]));
    assert_eq!(end(&&roof, start, 5.0)?, end(&roof, start, 5.0)?);
    let seen = end(&Roofed, start, 5.0)?;
    assert_eq!(end(&&Roofed, start, 5.0)?, seen);
    assert!((seen.q[0] - end(&roof, start, 5.0)?.q[0]).abs() < 1e-9, "{seen}");
    Ok(())
}

/// The potential of [`Roof`], whose kink the derive sees.
#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - sqrt(x^2))]
struct Roofed;

/// −|x|, whose kink no derive can see.
struct Roof;

impl Function<1, 1> for Roof {
    fn eval<S: Scalar>(&self, [x]: [S; 1]) -> [S; 1] {
        [-x.abs()]
    }
}

#[derive(Lagrangian)]
#[coordinates(x)]
#[function(U(x) = roof)]
#[lagrangian(x_dot^2/2 + U(x))]
struct Bouncing {
    roof: Roof,
}

/// Parabolas, one after another: from x = 1 at rest the kink is reached after √2, and every 2√2 after that.
#[test]
fn steps_close_in_on_the_kink_of_a_function() -> Result<(), Error> {
    let state = end(&Bouncing { roof: Roof }, State::at_rest([1.0]), 4.0 * 2.0_f64.sqrt() + 0.5)?;
    let off = (state.q[0] - (1.0 - 0.125)).abs().max((state.v[0] + 0.5).abs());
    assert!(off < 1e-9, "{off:e}");
    Ok(())
}
