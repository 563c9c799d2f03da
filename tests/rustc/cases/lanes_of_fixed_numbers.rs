use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2)]
struct System {
    m: f64,
}

fn main() {
    let ensemble = Ensemble::from_fn(10, |k| (System { m: 1.0 }, State::at_rest([k as f64])));
    let _ = ensemble.integrate_on_lanes(1.0, Dop853::default());
}
