use lagrange_core::function::FunctionWithDerivatives;
use lagrange_core::{prelude::*, function::WithDerivatives};

struct Parabola;

impl FunctionWithDerivatives<1, 1> for Parabola {
    fn value(&self, [t]: [f64; 1]) -> [f64; 1] {
        [t * t]
    }
    fn gradient(&self, [t]: [f64; 1]) -> [[f64; 1]; 1] {
        [[2.0 * t]]
    }
    fn hessian(&self, _: [f64; 1]) -> [[[f64; 1]; 1]; 1] {
        [[[2.0]]]
    }
}

#[derive(Lagrangian)]
#[coordinates(x)]
#[function(height(t) = lift)]
#[lagrangian(x_dot^2/2 + x_dot*der(der(height(t))))]
struct System {
    lift: WithDerivatives<Parabola>,
}

fn main() {}
