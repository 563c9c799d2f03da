use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - k*x)]
struct System<'a, T> {
    m: &'a T,
    k: T,
}

fn main() {
    let m = 1.0;
    let ensemble = Ensemble::from_fn(10, |k| (System { m: &m, k: k as f64 }, State::at_rest([0.0])));
    let _ = ensemble.integrate_on_lanes(1.0, Dop853::default());
}
