//! A number of single precision whose sine and cosine are computed in single precision, and a control loop on it.

use core::ops::{Add, Div, Mul, Neg, Sub};

use lagrange_core::{prelude::*, runge_kutta_step};

#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
struct Single(f32);

/// All other functions are those of `f32`; a program that does not call them does not hold them.
macro_rules! as_f32 {
    ($($operator:ident $method:ident),*; $($name:ident($($argument:ident),*)),*) => {
        $(impl $operator for Single {
            type Output = Self;
            fn $method(self, y: Self) -> Self { Self(self.0.$method(y.0)) }
        })*
        impl Neg for Single {
            type Output = Self;
            fn neg(self) -> Self { Self(-self.0) }
        }
        impl Scalar for Single {
            fn constant(x: f64) -> Self { Self(x as f32) }
            fn sin_cos(self) -> (Self, Self) { sin_cos(self.0) }
            fn select_by_order(self, y: Self, less: Self, equal: Self, greater: Self) -> Self {
                Self(Scalar::select_by_order(self.0, y.0, less.0, equal.0, greater.0))
            }
            $(fn $name(self $(, $argument: Self)*) -> Self { Self(Scalar::$name(self.0 $(, $argument.0)*)) })*
        }
    };
}

as_f32!(Add add, Sub sub, Mul mul, Div div; tan(), asin(), acos(), atan(), atan2(x), sinh(), cosh(), tanh(), exp(), ln(),
    sqrt(), abs(), powf(y), min(y), max(y));

/// By Cody and Waite's reduction to ±π/4, in three parts of π/2, and the polynomials of S. Moshier's Cephes library; NaN
/// beyond 8192, where the reduction would lose digits.
fn sin_cos(x: f32) -> (Single, Single) {
    let quarters = x * core::f32::consts::FRAC_2_PI;
    let k = (quarters + if x < 0.0 { -0.5 } else { 0.5 }) as i32;
    let part = k as f32;
    let y = ((x - part * 1.570_312_5) - part * 4.837_513e-4) - part * 7.549_79e-8;
    let y = if x.abs() <= 8192.0 { y } else { f32::NAN };
    let z = y * y;
    let sine = y + y * z * (-1.666_665_5e-1 + z * (8.332_161e-3 - z * 1.951_529_6e-4));
    let cosine = 1.0 - 0.5 * z + z * z * (4.166_664_6e-2 + z * (-1.388_731_6e-3 + z * 2.443_315_7e-5));
    let (sine, cosine) = if k & 1 == 0 { (sine, cosine) } else { (cosine, -sine) };
    let sign = if k & 2 == 0 { 1.0 } else { -1.0 };
    (Single(sign * sine), Single(sign * cosine))
}

/// A pendulum with a motor at the pivot.
#[derive(Lagrangian)]
#[coordinates(theta)]
#[lagrangian(m*l^2/2 * theta_dot^2 + m*g*l*cos(theta))]
#[force(theta: torque)]
struct Pendulum<T> {
    m: T,
    l: T,
    g: T,
    torque: T,
}

fn main() {
    // Within 10⁻⁷ of sine and cosine for all angles that a mechanism has.
    for k in -100_000..=100_000 {
        let x = k as f32 * 1e-3;
        let (sine, cosine) = sin_cos(x);
        let (exact_sine, exact_cosine) = f64::from(x).sin_cos();
        assert!((f64::from(sine.0) - exact_sine).abs() < 1e-7, "sin {x} is not {}", sine.0);
        assert!((f64::from(cosine.0) - exact_cosine).abs() < 1e-7, "cos {x} is not {}", cosine.0);
    }
    assert!(sin_cos(1e4).0.0.is_nan() && sin_cos(f32::INFINITY).1.0.is_nan());

    // Held upright by a controller that looks every 10 ms.
    let number = Single::constant;
    let mut pendulum = Pendulum { m: number(1.0), l: number(0.5), g: number(9.81), torque: number(0.0) };
    let mut state = State::at_rest([number(2.8)]);
    for _ in 0..500 {
        let lean = number(core::f64::consts::PI) - state.q[0];
        pendulum.torque = number(20.0) * lean - number(4.0) * state.v[0];
        state = runge_kutta_step(&pendulum, &state, number(0.01));
    }
    assert!((state.q[0].0 - core::f32::consts::PI).abs() < 1e-5);
}
