//! Energy errors of methods on nonholonomic problems, over many periods.
//!
//! Modin and Verdier (*Numerische Mathematik* 145, 2020) show that the usual problems of the literature are integrable and
//! reversible, and that this is why reversible methods keep their energy. The problems here are these, one that is
//! chaotic, one whose distribution is perturbed, and two that a pendulum drives. It turns over and over, so that its
//! velocity never changes sign; if its potential is not symmetric, no reversal maps the motion to itself.
//!
//! `LAGRANGE_CASES=full cargo test --release --test motion_geometric nonholonomic -- --nocapture
//! --test-threads 1` prints the table of the book; without the first of them three problems are taken, by `DAlembert` alone.

use std::f64::consts::TAU;
use std::time::Instant;

use lagrange_core::motion::Composition::KahanLi6;
use lagrange_core::nalgebra::Const;
use lagrange_core::{Lagrangian, Method, prelude::*};
use lagrange_random::cases;
use lagrange_systems::KnifeEdge;

use crate::IS_LONG;
use crate::systems::{Particle, sleigh};

/// Two oscillators, geared by a ratio that a third one changes (McLachlan and Perlmutter, *Journal of Nonlinear Science* 16,
/// 2006): the model of a continuously variable transmission. `epsilon` stiffens a spring, `gauge` adds a derivative by time to
/// the Lagrangian, which makes other momenta and the same motion, and `bend` couples all three velocities.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian((x_dot^2 + y_dot^2 + z_dot^2)/2 - (x^2 + y^2 + z^2 + epsilon*x^2*z^2)/2 + gauge*z_dot*cos(z))]
#[constraint(gear: x_dot + y*z_dot + bend*(x*y + z)*y_dot = 0)]
struct Transmission {
    epsilon: f64,
    gauge: f64,
    bend: f64,
}

const TRANSMISSION: Transmission = Transmission { epsilon: 0.0, gauge: 0.0, bend: 0.0 };

/// A disc that rolls upright, and a robot on wheels, with a potential of their angle (Cortés and Martínez 2001).
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta, psi)]
#[lagrangian((x_dot^2 + y_dot^2 + turning*theta_dot^2 + rolling*psi_dot^2)/2 - k*sin(psi))]
#[constraint(along: x_dot - psi_dot*cos(theta) = 0)]
#[constraint(across: y_dot - psi_dot*sin(theta) = 0)]
struct Wheeled {
    turning: f64,
    rolling: f64,
    k: f64,
}

/// Seven coordinates with a quartic potential, whose motion is chaotic (McLachlan and Perlmutter 2006).
#[derive(Clone, Lagrangian)]
#[coordinates(x, y: [3], z: [3])]
#[lagrangian((x_dot^2 + dot(y_dot, y_dot) + dot(z_dot, z_dot))/2
    - (x^2 + dot(y, y) + dot(z, z) + z[0]^2*z[1]^2 + sum(i in 0..3, y[i]^2*z[i]^2))/2)]
#[constraint(contact: x_dot + dot(z, y_dot) = 0)]
struct Quartic;

/// Two oscillators, geared by a ratio that a pendulum changes as it turns over.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, phi)]
#[lagrangian((x_dot^2 + y_dot^2 + phi_dot^2)/2 - (x^2 + y^2)/2 + cos(phi)/5 - epsilon*sin(2*phi))]
#[constraint(gear: y_dot - sin(phi)*x_dot = 0)]
struct DrivenTransmission {
    epsilon: f64,
}

/// A knife edge in a bowl, turned by a pendulum.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta)]
#[lagrangian((x_dot^2 + y_dot^2 + theta_dot^2)/2 - (x^2 + y^2)/2 + cos(theta)/5 - epsilon*sin(2*theta))]
#[constraint(blade: x_dot*sin(theta) - y_dot*cos(theta) = 0)]
struct DrivenEdge {
    epsilon: f64,
}

/// Largest relative energy errors during the first and the last ten periods; infinite if the motion ends before. Time in µs
/// of one period.
#[derive(Clone, Copy)]
struct Row {
    first: f64,
    last: f64,
    cost: f64,
}

impl Row {
    fn grows_by(self) -> f64 {
        self.last / self.first
    }
}

/// Errors of `DAlembert` with 40 steps in a period, of its composition of order 6 with 10 steps, and of two methods with step
/// control that cost about as much or less. No step is a fraction of a period.
struct Errors {
    periods: f64,
    by_steps: Row,
    of_order_6: Row,
    /// By `Dop853` and by `Taylor`.
    others: Option<[Row; 2]>,
}

impl Errors {
    fn of<L, const N: usize>(name: &str, system: &L, start: State<f64, N>) -> Self
    where
        L: Lagrangian<N = Const<N>, Scalar = f64> + Clone,
        DAlembert: Method<L>,
        Taylor: Method<L>,
    {
        let (start, _) = system.make_consistent(&start).unwrap();
        let periods = cases([PERIODS, PERIODS, 10_000]) as f64;
        let steps = |count: f64| DAlembert::with_step(TAU / count).max_steps(usize::MAX);
        let by_steps = row(system, start, periods, steps(40.38));
        let of_order_6 = row(system, start, periods, steps(10.38).composed(KahanLi6));
        // What is not long is not compiled either.
        let others = if IS_LONG {
            let pair = Dop853::with_tolerance(1e-12).max_steps(usize::MAX);
            let series = Taylor::default().max_steps(usize::MAX);
            Some([row(system, start, periods, pair), row(system, start, periods, series)])
        } else {
            None
        };
        let cell = |Row { first, last, cost }: &Row| format!("{first:.0e} → {last:.0e}, {cost:.0} µs");
        let cells: Vec<_> = [by_steps, of_order_6].iter().chain(others.iter().flatten()).map(cell).collect();
        println!("| {name} | {} |", cells.join(" | "));
        Self { periods, by_steps, of_order_6, others }
    }

    /// Asserts that the energy errors by steps of one length stay, and that those of methods with step control grow.
    fn stay(&self) {
        assert!(self.by_steps.grows_by() < 2.0, "by a factor of {}", self.by_steps.grows_by());
        assert!(self.of_order_6.grows_by() < 4.0, "by a factor of {}", self.of_order_6.grows_by());
        self.grow_by_others();
    }

    /// Asserts that the energy errors by steps of one length grow as well.
    fn grow(&self) {
        assert!(self.by_steps.grows_by() > 4.0, "by a factor of {}", self.by_steps.grows_by());
        assert!(self.of_order_6.grows_by() > 4.0, "by a factor of {}", self.of_order_6.grows_by());
        self.grow_by_others();
    }

    fn grow_by_others(&self) {
        let Some([by_pair, by_series]) = self.others else { return };
        assert!(by_pair.grows_by() > 10.0, "by a factor of {}", by_pair.grows_by());
        assert!(by_series.last < 1e-13 * self.periods, "{:e}", by_series.last);
    }
}

/// Number of periods if not asked for. Errors that grow are four times as large from 100 on, by steps of one length of each order.
const PERIODS: usize = 150;

fn row<L, P, const N: usize>(system: &L, start: State<f64, N>, periods: f64, method: P) -> Row
where
    L: Lagrangian<N = Const<N>, Scalar = f64> + Clone,
    P: Method<L> + Copy,
{
    let (energy, part) = (system.energy(&start), 10.0 * TAU);
    let error = |state: &State<f64, N>| (system.energy(state) / energy - 1.0).abs();
    let largest = |from: State<f64, N>| match system.integrate(from, from.t + part, method) {
        Ok(path) => path.steps().map(|step| error(step.state())).fold(0.0, f64::max),
        Err(_) => f64::INFINITY,
    };
    let mut motion = Motion::new(system.clone(), start, method).unwrap();
    let begun = Instant::now();
    let ended = motion.advance_to(periods * TAU - part);
    let cost = 1e6 * begun.elapsed().as_secs_f64() / (periods - 10.0);
    let last = ended.map_or(f64::INFINITY, |()| largest(*motion.state()));
    Row { first: largest(start), last, cost }
}

fn geared() -> State<f64, 3> {
    State::new([1.0, 0.8, 0.3], [0.0, 0.2, 0.5])
}

fn driven() -> State<f64, 3> {
    State::new([1.0, 0.3, 0.0], [0.3, 0.2, 1.2])
}

#[test]
fn energy_on_reversible_nonholonomic_problems() {
    Errors::of("transmission", &TRANSMISSION, geared()).stay();
    if IS_LONG {
        for (name, system) in [
            ("transmission, spring that stiffens", Transmission { epsilon: 0.3, ..TRANSMISSION }),
            ("transmission, other momenta", Transmission { gauge: 0.2, ..TRANSMISSION }),
            ("transmission, perturbed distribution", Transmission { bend: 0.2, ..TRANSMISSION }),
        ] {
            Errors::of(name, &system, geared()).stay();
        }
    }
}

#[test]
fn energy_of_reversible_bodies_on_blades_and_wheels() {
    // The disc rolls on a circle from the start.
    let disc = Wheeled { turning: 0.25, rolling: 0.5, k: 0.0 };
    let disc = Errors::of("vertical disc", &disc, State::new([0.0; 4], [0.0, 0.0, 1.0, 0.7]));
    assert!(disc.by_steps.last < 1e-14 * disc.periods && disc.of_order_6.last < 1e-14 * disc.periods);
    if IS_LONG {
        let start = State::new([1.0, 0.8, 0.3], [0.3, 0.2, 0.5]);
        Errors::of("particle with two springs", &Particle { k: 1.0 }, start).stay();
        let edge = KnifeEdge { m: 1.0, inertia: 1.0, g: 1.0 };
        Errors::of("knife edge on a slope", &edge, State::new([0.0; 3], [0.5, 0.0, 1.0])).stay();
        let start = State::new([0.0, 0.0, 0.3, 0.5], [0.0, 0.0, 1.0, 0.7]);
        Errors::of("mobile robot", &Wheeled { turning: 1.0, rolling: 3.0, k: 10.0 }, start).stay();
        // The sleigh ends in a straight line, on which no method makes an error.
        let start = State::new([0.0; 3], [0.5, 0.0, 0.5]);
        let sleigh = Errors::of("Chaplygin's sleigh", &sleigh().0, start);
        assert!(sleigh.by_steps.grows_by() < 2.0 && sleigh.of_order_6.grows_by() < 2.0);
    }
}

#[test]
fn energy_on_a_chaotic_nonholonomic_problem() {
    if IS_LONG {
        let start = State::new([0.76, 0.6, 0.4, 0.2, 1.0, 1.0, 1.0], [0.0, 0.64, 0.0, 0.0, 0.0, 0.0, 0.0]);
        Errors::of("quartic oscillators, chaotic", &Quartic, start).grow_by_others();
    }
}

#[test]
fn energy_on_nonholonomic_problems_without_reversal() {
    let transmission = |epsilon| DrivenTransmission { epsilon };
    Errors::of("transmission by a symmetric pendulum", &transmission(0.0), driven()).stay();
    Errors::of("transmission by an asymmetric pendulum", &transmission(0.2), driven()).grow();
    if IS_LONG {
        let edge = |epsilon| DrivenEdge { epsilon };
        Errors::of("knife edge by a symmetric pendulum", &edge(0.0), driven()).stay();
        Errors::of("knife edge by an asymmetric pendulum", &edge(0.2), driven()).grow();
    }
}
