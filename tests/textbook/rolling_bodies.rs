//! Round bodies that roll on an incline without slipping: Milton (8.4)–(8.10).
//!
//! m ẍ = F + λ and I φ̈ = N − a λ with ẍ = a φ̈ give λ = (m N a − I F)/(I + m a²). The constraint ẋ − a φ̇ = 0 and its integral x − a φ = c are
//! the same.

use approx::assert_relative_eq;
use lagrange_core::{ConstraintKind, prelude::*};
use lagrange_random::{Random, cases};

use crate::largest;

/// A body of the inertia `shape` m a² on an incline at `alpha`, with a spring of stiffness `k` at the axle and a weight off the axis
/// that pulls by `pull sin φ`.
macro_rules! rolling_body {
    ($name:ident, $($constraint:tt)*) => {
        #[derive(Lagrangian)]
        #[coordinates(x, phi)]
        #[define(inertia = shape*m*a^2)]
        #[lagrangian(m/2*x_dot^2 + inertia/2*phi_dot^2 + m*g*x*sin(alpha) - k/2*x^2 + pull*cos(phi))]
        #[constraint(no_slip: $($constraint)*)]
        #[observable(friction = lambda(no_slip))]
        struct $name {
            m: f64,
            a: f64,
            shape: f64,
            g: f64,
            alpha: f64,
            k: f64,
            pull: f64,
            offset: f64,
        }
    };
}

rolling_body!(ByVelocities, x_dot - a * phi_dot = 0);
rolling_body!(ByPosition, x - a * phi = offset);

impl ByVelocities {
    fn start(&self, phi: f64, rate: f64) -> State<f64, 2> {
        State::new([self.a * phi + self.offset, phi], [self.a * rate, rate])
    }

    /// ẍ and λ.
    fn exact(&self, [x, phi]: [f64; 2]) -> [f64; 2] {
        let &Self { m, a, .. } = self;
        let (along, torque) = (m * self.g * self.alpha.sin() - self.k * x, -self.pull * phi.sin());
        let inertia = self.shape * m * a * a;
        let whole = inertia + m * a * a;
        [(along * a * a + torque * a) / whole, (m * torque * a - inertia * along) / whole]
    }
}

#[test]
fn both_forms_have_the_same_acceleration_and_friction_at_random_states() {
    let mut random = Random(2);
    assert_eq!(ByVelocities::CONSTRAINT_KINDS, [ConstraintKind::Velocity]);
    assert_eq!(ByPosition::CONSTRAINT_KINDS, [ConstraintKind::Holonomic]);
    for _ in 0..cases([200, 1000, 10_000]) {
        let [m, a, shape, g, alpha, k, pull] = random.array(Random::positive);
        let (alpha, offset) = (alpha / 2.0, random.signed());
        let velocity = ByVelocities { m, a, shape, g, alpha, k, pull, offset };
        let position = ByPosition { m, a, shape, g, alpha, k, pull, offset };
        let state = velocity.start(random.signed(), random.signed());
        position.check_consistent(&state).unwrap();
        let [acceleration, friction] = velocity.exact(state.q.into());
        for solution in [velocity.solve(&state).unwrap(), position.solve(&state).unwrap()] {
            let scale = 1.0 + acceleration.abs() + friction.abs();
            assert!((solution.accelerations[0] - acceleration).abs() < 1e-12 * scale);
            assert!((solution.accelerations[1] * a - acceleration).abs() < 1e-12 * scale);
            assert!((solution.multipliers[0] - friction).abs() < 1e-12 * scale);
        }
    }
}

/// Shapes of a sphere, a shell, a cylinder and a hoop.
const SHAPES: [f64; 4] = [2.0 / 5.0, 2.0 / 3.0, 1.0 / 2.0, 1.0];

/// ẍ = g sin α/(1 + shape) and λ = −shape/(1 + shape) m g sin α: friction points up the slope. The motion from rest is the parabola
/// that follows.
#[test]
fn bodies_roll_down_8_10() {
    for shape in SHAPES {
        for (m, a, g, alpha) in [(1.0, 0.1, 9.81, 0.3), (2.5, 0.07, 1.62, 1.1), (0.01, 3.0, 24.8, 0.02)] {
            let body = ByVelocities { m, a, shape, g, alpha, k: 0.0, pull: 0.0, offset: 0.0 };
            let slope = g * f64::sin(alpha);
            let friction = -shape / (1.0 + shape) * m * slope;
            let start = State::new([0.3, -0.2], [0.0, 0.0]);
            let path = body.integrate(start, 3.0, Dop853::with_tolerance(1e-12)).unwrap();
            let end = path.end();
            let exact = 0.3 + slope / (1.0 + shape) * 4.5;
            assert_relative_eq!(end.coordinate("x").unwrap(), exact, max_relative = 1e-12);
            let solution = body.solve(&start).unwrap();
            for found in [end.multiplier("no_slip").unwrap(), body.friction(&start, &solution)] {
                assert_relative_eq!(found, friction, max_relative = 1e-14);
            }
            let force = end.constraint_force("phi").unwrap();
            assert_relative_eq!(force, -a * friction, max_relative = 1e-14);
        }
    }
}

/// x oscillates about m g sin α/k with ω² = k/(1 + shape) m, and λ = −shape m ẍ. The constraint is enforced on velocities alone: x − a φ
/// stays what it is.
#[test]
fn on_a_spring_they_oscillate_harmonically() {
    let (m, a, g, alpha, k, offset) = (1.5, 0.2, 9.81, 0.4_f64, 30.0, 0.3);
    for shape in SHAPES {
        let body = ByVelocities { m, a, shape, g, alpha, k, pull: 0.0, offset };
        let path = body.integrate(body.start(-1.5, 0.0), 50.0, Dop853::with_tolerance(1e-12)).unwrap();
        let (middle, omega) = (m * g * alpha.sin() / k, (k / ((1.0 + shape) * m)).sqrt());
        let deviation = largest(path.samples(1001).flat_map(|s| {
            let cosine = (omega * s.time()).cos();
            let friction = -shape * m * omega * omega * middle * cosine;
            let [x, lambda] = [s.coordinate("x").unwrap(), s.multiplier("no_slip").unwrap()];
            let kept = x - a * s.state().q[1] - offset;
            [(x - middle * (1.0 - cosine)).abs(), (lambda - friction).abs() / k, 100.0 * kept.abs()]
        }));
        assert!(deviation < 1e-8, "{deviation:e}");
    }
}
