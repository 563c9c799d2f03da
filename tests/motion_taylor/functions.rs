//! Every function of the language in a potential, in a mass and in a force, against another method.

use lagrange_core::prelude::*;

use super::difference;

/// The sum `u` is the potential of the first coordinate, and in the mass of the second and in a force on it.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[define(u = w[0]*sin(x)
    + w[1]*cos(2*x + t/3)
    + w[2]*tan(x/2)
    + w[3]*asin(x/3)
    + w[4]*acos(x/3)
    + w[5]*atan(x)
    + w[6]*atan2(x + 1, 2 - x^2/8)
    + w[7]*atan2(x + 1, c)
    + w[8]*sinh(x/2)
    + w[9]*cosh(x/2)
    + w[10]*tanh(x)
    + w[11]*exp(-x)
    + w[12]*ln(2 + x)
    + w[13]*sqrt(2 + x)
    + w[14]*((2 + x)^(3/2))
    + w[15]/(2 + x)
    + w[16]*((1 + x^2)/(2 + x))
    + w[17]*(x^5/8)
    + w[18]*((2 + x)^(7/3)/4)
    + w[19]*((2 + x)^c)
    + w[20]*(c^x)
    + w[21]*((2 + x)^(x/2))
    + w[22]*(t*x + t^2/2)
    + w[23]*(sin(exp(-x)/(1 + x^2)) + sqrt(1 + cos(x)^2)))]
#[lagrangian(x_dot^2/2 + (3 + u)*y_dot^2/2 - c*u)]
#[force(y: -y_dot*u/10)]
struct System {
    c: f64,
    w: [f64; 24],
}

#[test]
fn every_function_is_expanded() -> Result<(), Error> {
    for k in 0..24 {
        let w = std::array::from_fn(|i| f64::from(u8::from(i == k)));
        let off = difference(&System { c: 0.7, w }, State::new([0.3, 0.2], [0.5, 0.8]), 1.0)?;
        assert!(off < 2e-13, "w[{k}]: {off:e}");
    }
    Ok(())
}
