//! What a motion leaves behind.

mod audit;
mod endings;
mod owned;
mod pointers;
mod table;
mod written;

use lagrange_core::prelude::*;

/// A spring whose end swings, with friction, pulled by a force: ẍ = −k (x − f sin (t − s)) − c ẋ + u. Where c or √k are large,
/// x soon follows that end, and fast motions are there in the equations only.
#[derive(Clone, Copy, Debug, Default, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - k/2 * (x - f*sin(t - s))^2)]
#[force(x: u - c*x_dot)]
struct Spring<T> {
    k: T,
    c: T,
    u: T,
    f: T,
    s: T,
}

/// ẍ = 6 x², so x = 1/(1 − t)² from `START`.
#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 + 2*x^3)]
struct BlowUp;

const START: State<f64, 1> = State {
    t: 0.0,
    q: lagrange_core::nalgebra::SVector::<f64, 1>::new(1.0),
    v: lagrange_core::nalgebra::SVector::<f64, 1>::new(2.0),
};
