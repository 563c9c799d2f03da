use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2)]
#[force(x: -abs(x))]
struct Kinked;

#[derive(Lagrangian)]
#[coordinates(x)]
#[function(U(x))]
#[lagrangian(x_dot^2/2 - U(x))]
struct Supplied<F> {
    U: F,
}

struct Square;

impl Function<1, 1> for Square {
    fn eval<S: Scalar>(&self, [x]: [S; 1]) -> [S; 1] {
        [x * x]
    }
}

fn main() {
    let start = State::at_rest([1.0]);
    let _ = Kinked.integrate(start, 1.0, Taylor::default());
    let _ = Supplied { U: Square }.integrate(start, 1.0, Taylor::default());
}
