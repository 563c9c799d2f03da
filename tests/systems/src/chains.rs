use std::fmt;

use lagrange_core::motion::{AccelerationField, ManyBodyField};
use lagrange_core::nalgebra::{Const, DVector, Dyn};
use lagrange_core::structure::VelocityFreeForces;
use lagrange_core::{Error, Lagrangian, ManyBodies, State, System, generic};

/// Fermi, Pasta, Ulam and Tsingou's chain of unit masses between two walls, U = Σ d²/2 + β d⁴/4 over the springs. Its length is known
/// when the program runs.
#[derive(Clone, Debug)]
pub struct Chain {
    pub masses: usize,
    pub beta: f64,
}

/// The same chain of `N` masses, by its accelerations alone.
#[derive(Clone, Debug)]
pub struct ChainOf<const N: usize> {
    pub beta: f64,
}

/// The same chain of five masses, from its Lagrangian.
#[derive(Clone, Debug, Lagrangian)]
#[coordinates(x: [5])]
#[define(walls = x[0]^2/2 + beta*x[0]^4/4 + x[4]^2/2 + beta*x[4]^4/4)]
#[lagrangian(dot(x_dot, x_dot)/2 - walls - sum(i in 0..4, (x[i+1] - x[i])^2/2 + beta*(x[i+1] - x[i])^4/4))]
pub struct ChainOfFive {
    pub beta: f64,
}

impl Chain {
    /// At rest in an uneven shape.
    pub fn start(masses: usize) -> generic::State<f64, Dyn> {
        let q = DVector::from_fn(masses, |i, _| place(i));
        generic::State { t: 0.0, v: DVector::zeros(masses), q }
    }

    /// Energy of the springs.
    fn stored(&self, x: &[f64]) -> f64 {
        let of_spring = |d: f64| d * d / 2.0 + self.beta * d.powi(4) / 4.0;
        let ends = x.first().into_iter().chain(x.last()).copied();
        ends.chain(x.windows(2).map(|pair| pair[1] - pair[0])).map(of_spring).sum()
    }
}

impl<const N: usize> ChainOf<N> {
    /// The same start.
    pub fn start() -> State<f64, N> {
        State::at_rest(std::array::from_fn::<_, N, _>(place))
    }
}

fn place(i: usize) -> f64 {
    0.4 * (1.0 + 1.7 * i as f64).sin()
}

fn write_accelerations(beta: f64, x: &[f64], a: &mut [f64]) {
    let pull = |stretch: f64| stretch + beta * stretch * stretch * stretch;
    let mut from_left = x.first().map_or(0.0, |x| pull(*x));
    for (a, pair) in a.iter_mut().zip(x.windows(2)) {
        let from_right = pull(pair[1] - pair[0]);
        *a = from_right - from_left;
        from_left = from_right;
    }
    if let (Some(a), Some(x)) = (a.last_mut(), x.last()) {
        *a = pull(-x) - from_left;
    }
}

impl System for Chain {
    type Scalar = f64;
    type Length = Dyn;
    type M = Const<0>;
    type Field = ManyBodyField;

    fn length(&self) -> Dyn {
        Dyn(self.masses)
    }

    fn accelerations(&self, _: f64, q: &[f64], _: &[f64], a: &mut [f64]) {
        write_accelerations(self.beta, q, a);
    }
}

impl VelocityFreeForces for Chain {}

impl ManyBodies for Chain {
    const ENERGY_IS_CONSERVED: bool = true;
    const DIGEST: u32 = 0;

    fn write_name(&self, coordinate: usize, to: &mut dyn fmt::Write) -> fmt::Result {
        write!(to, "x[{coordinate}]")
    }

    fn check(&self) -> Result<(), Error> {
        Ok(())
    }

    fn visit_numbers(&self, visit: &mut dyn FnMut(f64)) {
        visit(self.masses as f64);
        visit(self.beta);
    }

    fn lagrangian(&self, state: &generic::State<f64, Dyn>) -> f64 {
        state.v.norm_squared() / 2.0 - self.stored(state.q.as_slice())
    }

    fn energy(&self, state: &generic::State<f64, Dyn>) -> f64 {
        state.v.norm_squared() / 2.0 + self.stored(state.q.as_slice())
    }

    fn momenta(&self, state: &generic::State<f64, Dyn>) -> DVector<f64> {
        state.v.clone()
    }
}

impl<const N: usize> System for ChainOf<N> {
    type Scalar = f64;
    type Length = Const<N>;
    type M = Const<0>;
    type Field = AccelerationField;

    fn length(&self) -> Const<N> {
        Const
    }

    fn accelerations(&self, _: f64, q: &[f64; N], _: &[f64; N], a: &mut [f64; N]) {
        write_accelerations(self.beta, q, a);
    }
}

impl<const N: usize> VelocityFreeForces for ChainOf<N> {}
