use lagrange_core::prelude::*;

/// Wraps its last argument in a hundred parentheses for each star.
macro_rules! nested {
    ([] $inner:tt) => {
        #[derive(Lagrangian)]
        #[coordinates(x)]
        #[lagrangian(m/2 * x_dot^2 + $inner)]
        struct System {
            m: f64,
        }
    };
    ([* $($more:tt)*] $inner:tt) => {
        nested! { [$($more)*] (((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((($inner)))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))) }
    };
}

nested! { [* * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * *] x }

fn main() {
    let system = System { m: 1.0 };
    system.accelerations_unchecked(&State::at_rest([0.0]));
}
