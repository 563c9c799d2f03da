use lagrange_core::prelude::*;

struct Newton;

impl Function<3, 1> for Newton {
    fn eval<S: Scalar>(&self, [x, y, z]: [S; 3]) -> [S; 1] {
        [S::constant(-1.0) / (x * x + y * y + z * z).sqrt()]
    }
}

#[derive(Lagrangian)]
#[coordinates(x, r: [3])]
#[function(U(x) = potential)]
#[function(A(r): [3] = potential)]
#[lagrangian(x_dot^2/2 + dot(r_dot, r_dot)/2 - U(x) + dot(r_dot, A(r)))]
struct System {
    potential: Newton,
}

fn main() {}
