//! A method that steps one member at a time.
use lagrange_core::RungeKutta4;
use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2)]
struct System<T> {
    m: T,
}

fn main() {
    let ensemble = Ensemble::from_fn(10, |k| (System { m: 1.0 }, State::at_rest([k as f64])));
    let _ = ensemble.integrate_on_lanes(1.0, RungeKutta4::with_step(0.1));
}
