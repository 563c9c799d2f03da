//! ROS3P, an implicit method of order 3 for stiff systems: J. Lang and J. Verwer, *ROS3P, an accurate third-order Rosenbrock
//! solver designed for parabolic problems*, BIT 41 (2001); the form without products of the Jacobian is that of Hairer and
//! Wanner, *Solving Ordinary Differential Equations II*, (IV.7.25).

use lagrange_core::generic::Length;
use lagrange_core::motion::{Interpolant, Limits, PhaseVector, Polynomial, StagePoint, Step};
use lagrange_core::nalgebra::{Const, DMatrix, DVector, Dyn, LU, SVector};
use lagrange_core::{Ending, Jacobian, Method, StateDerivatives, Statistics, prelude::*};

use crate::midpoint::Bead;

const GAMMA: f64 = 0.788_675_134_594_812_9;
const A: f64 = 1.267_949_192_431_123;
const C: [[f64; 2]; 3] =
    [[0.0; 2], [-1.607_695_154_586_736, 0.0], [-3.464_101_615_137_755, -1.732_050_807_568_877]];
const NODES: [f64; 3] = [0.0, 1.0, 1.0];
const GAMMAS: [f64; 3] = [GAMMA, -0.211_324_865_405_187_1, -1.077_350_269_189_626];
const WEIGHTS: [f64; 3] = [2.0, 0.577_350_269_189_625_8, 0.422_649_730_810_374_2];
const EMBEDDED: [f64; 3] = [2.113_248_654_051_871, 1.0, 0.422_649_730_810_374_2];

/// With steps chosen by the error of the embedded method of order 2, or all of one size where there is no tolerance.
#[derive(Clone, Copy)]
struct Rosenbrock {
    step: f64,
    tolerance: Option<f64>,
}

impl Rosenbrock {
    fn fixed(step: f64) -> Self {
        Self { step, tolerance: None }
    }

    fn with_tolerance(tolerance: f64) -> Self {
        Self { step: 1e-3, tolerance: Some(tolerance) }
    }
}

/// A step that has been taken leads from `before` to `state`.
struct Memory<const N: usize> {
    before: State<f64, N>,
    state: State<f64, N>,
    step: f64,
}

type Pair<const N: usize> = [SVector<f64, N>; 2];

/// What solves (1/(γh) − J) u = r, for J = ∂(v, a)/∂(q, v): N equations for the second half of u.
struct Stages<const N: usize> {
    by_q: DMatrix<f64>,
    factors: LU<f64, Dyn, Dyn>,
    gamma_h: f64,
}

impl<const N: usize> Stages<N> {
    fn at<M: Length>(jacobian: &Jacobian<f64, Const<N>, M, Const<0>>, h: f64) -> Self {
        let dense = |x: &dyn Fn(usize, usize) -> f64| DMatrix::from_fn(N, N, x);
        let a = &jacobian.accelerations;
        let (by_q, by_v, gamma_h) = (dense(&|i, j| a.q[(i, j)]), dense(&|i, j| a.v[(i, j)]), GAMMA * h);
        let factors = (DMatrix::identity(N, N) / gamma_h - by_v - &by_q * gamma_h).lu();
        Self { by_q, factors, gamma_h }
    }

    fn solve(&self, [first, second]: Pair<N>) -> Option<Pair<N>> {
        let right = DVector::from_column_slice(second.as_slice())
            + &self.by_q * DVector::from_column_slice(first.as_slice()) * self.gamma_h;
        let solved = self.factors.solve(&right)?;
        let second = SVector::from_column_slice(solved.as_slice());
        Some([(first + second) * self.gamma_h, second])
    }
}

fn moved<const N: usize>(state: &State<f64, N>, after: f64, by: &[(f64, Pair<N>)]) -> State<f64, N> {
    let mut moved = State { t: state.t + after, ..*state };
    for (weight, [q, v]) in by {
        moved.q += q * *weight;
        moved.v += v * *weight;
    }
    moved
}

impl Rosenbrock {
    /// The three u; `None` where the matrix of the stages is singular.
    fn stages<L, const N: usize>(
        system: &L,
        from: &State<f64, N>,
        h: f64,
        statistics: &mut Statistics,
    ) -> Result<Option<[Pair<N>; 3]>, Error>
    where
        L: StateDerivatives<N = Const<N>, Scalar = f64>,
    {
        let jacobian = system.state_jacobian(from)?;
        let stages = Stages::at(&jacobian, h);
        let mut u = [[SVector::zeros(); 2]; 3];
        for i in 0..3 {
            let at = if i == 0 { *from } else { moved(from, NODES[i] * h, &[(A, u[0])]) };
            statistics.evaluations += 1;
            let mut right = [at.v, system.solve(&at)?.accelerations];
            for j in 0..i {
                (0..2).for_each(|half| right[half] += u[j][half] * (C[i][j] / h));
            }
            right[1] += jacobian.accelerations.t * (GAMMAS[i] * h);
            let Some(solved) = stages.solve(right) else { return Ok(None) };
            u[i] = solved;
        }
        Ok(Some(u))
    }
}

impl<L, const N: usize> Method<L> for Rosenbrock
where
    L: StateDerivatives<N = Const<N>, Scalar = f64>,
{
    type Memory = Memory<N>;
    type Interpolant = Dense<N>;

    fn limits(&self) -> Limits {
        Limits::default()
    }

    fn identify(&self, to: &mut dyn std::fmt::Write) -> std::fmt::Result {
        write!(to, "Rosenbrock {:?} {:?}", self.step, self.tolerance)
    }

    fn check(&self) -> Result<(), Error> {
        if self.step > 0.0 { Ok(()) } else { Err(Error::Setting { name: "step", value: self.step }) }
    }

    fn begin(&self, _: &L, start: &State<f64, N>, _: &mut Statistics) -> Result<Memory<N>, Error> {
        Ok(Memory { before: *start, state: *start, step: self.step })
    }

    fn step(
        &self,
        system: &L,
        memory: &mut Memory<N>,
        end: f64,
        statistics: &mut Statistics,
    ) -> Step<f64, Const<N>> {
        let (from, left) = (memory.state, end - memory.state.t);
        let time =
            if left.abs() <= memory.step * (1.0 + 1e-9) { end } else { from.t + memory.step * left.signum() };
        let h = time - from.t;
        let failed = |reason| Step::Failed(Ending::MethodFailed { time: from.t, reason });
        let u = match Self::stages(system, &from, h, statistics) {
            Ok(Some(u)) => u,
            Ok(None) => return failed("the matrix of the stages is singular"),
            Err(_) => return failed("the equations could not be solved in a stage"),
        };
        let weighted = |weights: [f64; 3]| [0, 1, 2].map(|i| (weights[i], u[i]));
        let (next, embedded) = (moved(&from, h, &weighted(WEIGHTS)), moved(&from, h, &weighted(EMBEDDED)));
        if let Some(tolerance) = self.tolerance {
            let error = (next.q - embedded.q).norm().max((next.v - embedded.v).norm()) / tolerance;
            memory.step = h.abs() * (0.9 * error.max(1e-9).powf(-1.0 / 3.0)).clamp(0.2, 5.0);
            if error > 1.0 {
                return Step::Rejected;
            }
        }
        match system.make_consistent(&State { t: time, ..next }) {
            Ok((next, _)) => {
                (memory.before, memory.state) = (from, next);
                Step::Accepted(next)
            }
            Err(_) => failed("there is no state on the constraints nearby"),
        }
    }

    fn interpolant(
        &self,
        system: &L,
        memory: &mut Memory<N>,
        _: &mut Statistics,
    ) -> Result<Self::Interpolant, Error> {
        let node = |state: &State<f64, N>| {
            let rates = PhaseVector::of(state.v, system.solve(state)?.accelerations);
            Ok::<_, Error>((PhaseVector::of(state.q, state.v), rates))
        };
        let Memory { before, state, .. } = memory;
        Ok(Dense(Polynomial::hermite(before.t, state.t - before.t, &node(before)?, &node(state)?)))
    }
}

/// The states within a step, by an interpolant from outside of the crate.
struct Dense<const N: usize>(Polynomial<f64, [PhaseVector<f64, Const<N>>; 4]>);

impl<const N: usize> Interpolant<f64, Const<N>> for Dense<N> {
    fn at(&self, t: f64) -> StagePoint<f64, Const<N>> {
        self.0.at(t)
    }
}

/// x = cos t, whatever the damping: what it damps is the deviation.
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - x^2/2)]
#[force(x: -c*(x_dot + sin(t)))]
struct Attracted {
    c: f64,
}

fn cosine(t: f64) -> State<f64, 1> {
    State::new([t.cos()], [-t.sin()]).at_time(t)
}

/// Asserts the slopes of log error over log step, in four halvings from t = 0 to `end`: at the end, and of the worst error in
/// between.
fn is_of_order_three<L, const N: usize>(
    system: &L,
    exact: fn(f64) -> State<f64, N>,
    end: f64,
    is_order: fn(f64) -> bool,
) where
    L: StateDerivatives<N = Const<N>, Scalar = f64>,
{
    let errors = |h: f64| {
        let path = system.integrate(exact(0.0), end, Rosenbrock::fixed(h)).expect("a start and an end");
        let off = |state: &State<f64, N>| {
            let exact = exact(state.t);
            (state.q - exact.q).norm() + (state.v - exact.v).norm()
        };
        let between = path.samples(997).map(|sample| off(sample.state())).fold(0.0, f64::max);
        [off(path.end().state()), between]
    };
    let (coarse, fine) = (errors(0.1), errors(0.1 / 16.0));
    let orders = [0, 1].map(|k| (coarse[k] / fine[k]).log2() / 4.0);
    assert!(orders.into_iter().all(is_order), "{orders:?}");
}

#[test]
fn it_is_of_order_three_at_the_end_and_between() {
    let is_three = |order: f64| (order - 3.0).abs() < 0.15;
    is_of_order_three(&Attracted { c: 0.0 }, cosine, 8.0, is_three);
    is_of_order_three(&Attracted { c: 0.0 }, cosine, -8.0, is_three);
    // With time and velocities in the forces.
    is_of_order_three(&Attracted { c: 1.0 }, cosine, 8.0, is_three);
    // On a constraint.
    let circle = |t: f64| State::new([t.cos(), t.sin()], [-t.sin(), t.cos()]).at_time(t);
    let bead = Bead { k: 0.0 };
    is_of_order_three(&bead, circle, 3.0, |order| order > 2.8);
    let path = bead.integrate(circle(0.0), 3.0, Rosenbrock::fixed(0.05)).unwrap();
    assert!(path.samples(100).all(|sample| (sample.state().q.norm() - 1.0).abs() < 1e-12));
}

/// An explicit method's steps are as short as the fastest decay, which the motion has long forgotten.
#[test]
fn a_stiff_system_takes_few_steps() {
    let system = Attracted { c: 1e4 };
    let off = |state: &State<f64, 1>| (state.q[0] - state.t.cos()).abs() + (state.v[0] + state.t.sin()).abs();
    let path = system.integrate(cosine(0.0), 10.0, Rosenbrock::with_tolerance(1e-4)).unwrap();
    assert!(path.ending().is_complete(), "{}", path.ending());
    assert!(path.statistics().accepted < 1000, "{:?}", path.statistics());
    assert!(path.steps().all(|step| off(step.state()) < 1e-3));
    let explicit = Dopri5::with_tolerance(1e-4);
    let mut motion = Motion::new(system, cosine(0.0), explicit).unwrap();
    motion.advance_to(1.0).unwrap();
    assert!(motion.statistics().accepted > 2000, "{:?}", motion.statistics());
    // Steered, on a system behind a reference.
    let mut motion = Motion::new(&system, cosine(0.0), Rosenbrock::with_tolerance(1e-4)).unwrap();
    for k in 1..=10 {
        motion.advance_to(f64::from(k)).unwrap();
        assert!(off(motion.state()) < 1e-3 && off(&motion.at(f64::from(k) - 1e-6).unwrap()) < 1e-3);
    }
}

/// The interpolant meets both ends, with its velocity.
#[test]
fn its_interpolant_meets_the_states() {
    let system = Attracted { c: 1.0 };
    let (method, mut statistics) = (Rosenbrock::fixed(0.3), Statistics::default());
    let mut memory = method.begin(&system, &cosine(0.0), &mut statistics).unwrap();
    let Step::Accepted(next) = method.step(&system, &mut memory, 1.0, &mut statistics) else {
        panic!("a step")
    };
    let interpolant = method.interpolant(&system, &mut memory, &mut statistics).unwrap();
    for state in [cosine(0.0), next] {
        let point = interpolant.at(state.t);
        let off = [point.y[0][0] - state.q[0], point.y[1][0] - state.v[0], point.velocity[0] - state.v[0]];
        assert!(off.iter().all(|x| x.abs() < 1e-14), "{off:?}");
    }
}
