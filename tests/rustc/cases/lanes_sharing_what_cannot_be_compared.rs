use lagrange_core::prelude::*;

#[derive(Clone)]
struct Quartic;

impl Function<1, 1> for Quartic {
    fn eval<S: Scalar>(&self, [x]: [S; 1]) -> [S; 1] {
        [x * x * x * x]
    }
}

#[derive(Lagrangian)]
#[coordinates(x)]
#[function(U(x) = potential)]
#[lagrangian(m/2 * x_dot^2 - U(x))]
struct System<T> {
    m: T,
    potential: Quartic,
}

fn main() {
    let member = |k| (System { m: 1.0, potential: Quartic }, State::at_rest([k as f64]));
    let _ = Ensemble::from_fn(10, member).integrate_on_lanes(1.0, Dop853::default());
}
