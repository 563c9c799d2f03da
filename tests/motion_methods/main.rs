//! Methods written against the public interface alone: a pair, an implicit one, a series, and ones that go wrong.

mod combinations;
mod midpoint;
mod radau;
mod rosenbrock;
mod taylor;
mod wrong;

use lagrange_core::nalgebra::{Const, SVector};
use lagrange_core::{Method, prelude::*};

/// The state at a time.
type Exact<const N: usize> = fn(f64) -> State<f64, N>;

/// The mean slopes of log error over log step in four halvings from t = 0 to `end`: at the end, and of the worst error in
/// between.
fn orders<L, P, const N: usize>(
    (system, exact): (&L, Exact<N>),
    end: f64,
    coarsest: f64,
    method: impl Fn(f64) -> P,
) -> [f64; 2]
where
    L: Lagrangian<N = Const<N>, Scalar = f64>,
    P: Method<L>,
{
    let errors = |h: f64| {
        let path = system.integrate(exact(0.0), end, method(h)).expect("a start and an end");
        let off = |state: &State<f64, N>| {
            let exact = exact(state.t);
            let norm = |x: SVector<f64, N>| x.norm();
            norm(state.q - exact.q) + norm(state.v - exact.v)
        };
        let between = path.samples(997).map(|sample| off(sample.state())).fold(0.0, f64::max);
        [off(path.end().state()), between]
    };
    let (coarse, fine) = (errors(coarsest), errors(coarsest / 16.0));
    [0, 1].map(|k| (coarse[k] / fine[k]).log2() / 4.0)
}
