use lagrange_core::prelude::*;

struct System {
    m: f64,
}

fn jacobian_of<L>(system: &L)
where
    L: Linearized,
{
    let _ = system.parameters();
}

fn main() {
    jacobian_of(&System { m: 1.0 });
}
