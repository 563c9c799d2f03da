use lagrange_core::{prelude::*, function::{WithDerivatives, FunctionWithDerivatives, Table}};

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

impl FunctionWithDerivatives<1, 1> for Square {
    fn value(&self, [x]: [f64; 1]) -> [f64; 1] {
        [x * x]
    }

    fn gradient(&self, [x]: [f64; 1]) -> [[f64; 1]; 1] {
        [[2.0 * x]]
    }

    fn hessian(&self, _: [f64; 1]) -> [[[f64; 1]; 1]; 1] {
        [[[2.0]]]
    }
}

fn main() {
    let start = State::at_rest([1.0]);
    let _ = Kinked.integrate(start, 1.0, Taylor::default());
    let _ = Supplied { U: WithDerivatives(Square) }.integrate(start, 1.0, Taylor::default());
    let table = Table::new(&[(0.0, 0.0), (1.0, 1.0)]).unwrap();
    let _ = Supplied { U: table }.integrate(start, 1.0, Taylor::default());
}
