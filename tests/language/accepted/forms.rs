//! Every attribute with trailing commas.
use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x, r: [2],)]
#[define(half(a,) = a/2,)]
#[lagrangian(half(m*x_dot^2,) + m/2 * dot(r_dot, r_dot,),)]
#[constraint(rod: x = l,)]
#[force(r: [0, 1,],)]
#[dissipation(x_dot^2,)]
#[observable(pull = lambda(rod,),)]
#[parameter(m: 0..1,)]
#[lagrange(crate = lagrange_core, scalar = f64,)]
struct System {
    m: f64,
    l: f64,
}

#[test]
fn trailing_commas_are_taken() {
    let system = System { m: 1.0, l: 0.0 };
    let state = State::at_rest([0.0; 3]);
    let solution = system.accelerations_unchecked(&state);
    assert!(system.pull(&state, &solution).is_finite());
}
