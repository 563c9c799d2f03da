//! Every function of the language in a potential, in a mass and in a force, against another method.

use lagrange_core::prelude::*;

use super::difference;

/// The function is the potential of the first coordinate, and in the mass of the second and in a force on it.
macro_rules! functions {
    ($($name:ident, ($($function:tt)*), $from:expr, $speed:expr;)*) => {$(
        #[test]
        fn $name() -> Result<(), Error> {
            #[derive(Lagrangian)]
            #[coordinates(x, y)]
            #[define(u = $($function)*)]
            #[lagrangian(x_dot^2/2 + (3 + u)*y_dot^2/2 - c*u)]
            #[force(y: -y_dot*u/10)]
            struct System { c: f64 }

            let off = difference(&System { c: 0.7 }, State::new([$from, 0.2], [$speed, 0.8]), 1.0)?;
            assert!(off < 2e-13, "{off:e}");
            Ok(())
        }
    )*};
}

functions! {
    sine, (sin(x)), 0.3, 0.5;
    cosine, (cos(2*x + t/3)), 0.3, 0.5;
    tangent, (tan(x/2)), 0.3, 0.5;
    arcsine, (asin(x/3)), 0.3, 0.5;
    arccosine, (acos(x/3)), 0.3, 0.5;
    arctangent, (atan(x)), 0.3, 0.5;
    angle, (atan2(x + 1, 2 - x^2/8)), 0.3, 0.5;
    angle_of_a_constant, (atan2(x + 1, c)), 0.3, 0.5;
    hyperbolic_sine, (sinh(x/2)), 0.3, 0.5;
    hyperbolic_cosine, (cosh(x/2)), 0.3, 0.5;
    hyperbolic_tangent, (tanh(x)), 0.3, 0.5;
    exponential, (exp(-x)), 0.3, 0.5;
    logarithm, (ln(2 + x)), 0.3, 0.5;
    root, (sqrt(2 + x)), 0.3, 0.5;
    root_of_a_cube, ((2 + x)^(3/2)), 0.3, 0.5;
    quotient, (1/(2 + x)), 0.3, 0.5;
    quotient_of_moving, ((1 + x^2)/(2 + x)), 0.3, 0.5;
    whole_power, (x^5/8), 0.3, 0.5;
    odd_power, ((2 + x)^(7/3)/4), 0.3, 0.5;
    power_by_a_parameter, ((2 + x)^c), 0.3, 0.5;
    power_of_a_constant, (c^x), 0.3, 0.5;
    power_that_moves, ((2 + x)^(x/2)), 0.3, 0.5;
    product_with_time, (t*x + t^2/2), 0.3, 0.5;
    nested, (sin(exp(-x)/(1 + x^2)) + sqrt(1 + cos(x)^2)), 0.3, 0.5;
}
