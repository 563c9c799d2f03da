use lagrange_core::nalgebra::Const;
use lagrange_core::{Jacobian, prelude::*};

#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[define(weight = g*m)]
#[define(wrong = nothing*stiffness)]
#[lagrangian(m/2 * x_dot^2 - weight*x - wrong - dot(u, u))]
struct System {
    m: f64,
    g: f64,
    stiffness: f64,
    u: [f64; 2],
    unused: [f64; 7],
    label: &'static str,
}

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - 2k*x)]
struct Unread {
    m: f64,
    k: f64,
    unused: f64,
}

fn parameters<L: Linearized<Scalar = f64, P = Const<P>>, const P: usize>(system: &L) -> [f64; P] {
    system.parameters().into()
}

fn main() {
    let system = System { m: 1.0, g: 9.8, stiffness: 1.0, u: [0.0; 2], unused: [0.0; 7], label: "" };
    let jacobian: Result<Jacobian<f64, Const<1>, Const<0>, Const<5>>, Error> = system.jacobian(&State::at_rest([0.0]));
    println!("{:?} {jacobian:?}", <System as Linearized>::PARAMETERS);
    let near = system.linearize(&State::at_rest([0.0]), &["u"]);
    println!("{near:?} {:?}", system.parameters().map(|value| value + 1.0));
    let [m, k] = parameters::<_, 2>(&Unread { m: 1.0, k: 1.0, unused: 1.0 });
    println!("{m} {k}");
}
