use lagrange_core::prelude::*;

struct System {
    m: f64,
}

fn jacobian_of<L, const N: usize, const M: usize, const P: usize>(system: &L)
where
    L: Linearized<N, M, P>,
{
    let _ = system.parameters();
}

fn main() {
    jacobian_of(&System { m: 1.0 });
}
