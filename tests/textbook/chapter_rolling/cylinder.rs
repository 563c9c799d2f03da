//! A cylinder on a plane: Ẋ − a φ̇ = 0 and its integral X − a φ = c are the same constraint (Milton 8.4, 8.5).
//!
//! m Ẍ = F_X + λ and I φ̈ = F_φ − a λ with Ẍ = a φ̈ give λ = (m F_φ a − I F_X)/(I + m a²), in both forms.

use lagrange_core::{ConstraintKind, Sample, prelude::*};

use crate::chapter_rolling::largest;
use lagrange_random::Random;

/// An incline at `alpha`, a spring of stiffness `k` at the axle, and a weight off the axis that pulls by
/// `pull sin φ`.
macro_rules! cylinder {
    ($name:ident, $($constraint:tt)*) => {
        #[derive(Lagrangian)]
        #[coordinates(X, phi)]
        #[define(inertia = m/2 * a^2)]
        #[lagrangian(m/2*X_dot^2 + inertia/2*phi_dot^2 + m*g*X*sin(alpha) - k/2*X^2 + pull*cos(phi))]
        #[constraint($($constraint)*)]
        struct $name {
            m: f64,
            a: f64,
            g: f64,
            alpha: f64,
            k: f64,
            pull: f64,
            offset: f64,
        }

        impl $name {
            fn random(random: &mut Random) -> Self {
                let [m, a, g, alpha, k, pull] = random.array(Random::positive);
                Self { m, a, g, alpha: alpha / 2.0, k, pull, offset: random.signed() }
            }
        }
    };
}

cylinder!(ByVelocities, no_slip: X_dot - a*phi_dot = 0);
cylinder!(ByPosition, no_slip: X - a*phi = offset);

impl ByVelocities {
    fn start(&self, phi: f64, rate: f64) -> State<f64, 2> {
        State::new([self.a * phi + self.offset, phi], [self.a * rate, rate])
    }

    /// Ẍ and λ from the rows of the equations, solved by hand.
    fn exact(&self, [x, phi]: [f64; 2]) -> [f64; 2] {
        let along = self.m * self.g * self.alpha.sin() - self.k * x;
        let torque = -self.pull * phi.sin();
        let inertia = self.m / 2.0 * self.a * self.a;
        let whole = inertia + self.m * self.a * self.a;
        let acceleration = (along * self.a * self.a + torque * self.a) / whole;
        [acceleration, (self.m * torque * self.a - inertia * along) / whole]
    }
}

#[test]
fn both_forms_have_the_same_acceleration_and_friction_at_random_states() {
    let mut random = Random(2);
    assert_eq!(ByVelocities::CONSTRAINT_KINDS, [ConstraintKind::Velocity]);
    assert_eq!(ByPosition::CONSTRAINT_KINDS, [ConstraintKind::Holonomic]);
    for _ in 0..1000 {
        let seed = Random(random.0);
        let velocity = ByVelocities::random(&mut Random(seed.0));
        let position = ByPosition::random(&mut random);
        let state = velocity.start(random.signed(), random.signed());
        position.check_consistent(&state).unwrap();
        let [acceleration, friction] = velocity.exact(state.q.into());
        for solution in [velocity.solve(&state).unwrap(), position.solve(&state).unwrap()] {
            let scale = 1.0 + acceleration.abs() + friction.abs();
            assert!((solution.accelerations[0] - acceleration).abs() < 1e-12 * scale);
            assert!((solution.accelerations[1] * velocity.a - acceleration).abs() < 1e-12 * scale);
            assert!((solution.multipliers[0] - friction).abs() < 1e-12 * scale);
        }
    }
}

#[test]
fn both_forms_have_the_same_motion_and_friction() {
    let (m, a, g, alpha, k, pull, offset) = (1.5, 0.2, 9.81, 0.4, 30.0, 0.5, 0.3);
    let velocity = ByVelocities { m, a, g, alpha, k, pull, offset };
    let position = ByPosition { m, a, g, alpha, k, pull, offset };
    let start = velocity.start(-1.0, 4.0);
    let method = Dop853::with_tolerance(1e-12);
    let paths = (velocity.integrate(start, 50.0, method), position.integrate(start, 50.0, method));
    let (by_velocities, by_position) = (paths.0.unwrap(), paths.1.unwrap());
    let pairs = || by_velocities.samples(1001).zip(by_position.samples(1001));

    let apart = largest(pairs().map(|(a, b)| (a.state().q - b.state().q).norm()));
    assert!(apart < 1e-8, "{apart:e}");
    let friction = |sample: Sample<&ByVelocities>| sample.multiplier("no_slip").unwrap();
    let other = |sample: Sample<&ByPosition>| sample.multiplier("no_slip").unwrap();
    let apart = largest(pairs().map(|(a, b)| (friction(a) - other(b)).abs()));
    assert!(apart < 1e-8, "{apart:e}");
    // Enforced on velocities alone, the integral keeps its value.
    let offset = largest(by_velocities.samples(1001).map(|s| {
        let [x, phi]: [f64; 2] = s.state().q.into();
        (x - 0.2 * phi - 0.3).abs()
    }));
    assert!(offset < 1e-10, "{offset:e}");
}

/// Without the weight: X oscillates about m g sin α / k with ω² = 2k/3m, and λ = −m Ẍ/2.
#[test]
fn on_a_spring_it_oscillates_harmonically() {
    let velocity = ByVelocities { m: 1.5, a: 0.2, g: 9.81, alpha: 0.4, k: 30.0, pull: 0.0, offset: 0.0 };
    let path = velocity.integrate(State::at_rest([0.0; 2]), 50.0, Dop853::with_tolerance(1e-12)).unwrap();
    let (middle, omega) = (1.5 * 9.81 * 0.4_f64.sin() / 30.0, f64::sqrt(2.0 * 30.0 / 4.5));
    let deviation = largest(path.samples(1001).flat_map(|s| {
        let cosine = (omega * s.time()).cos();
        let friction = -0.75 * omega * omega * middle * cosine;
        let [x, lambda] = [s.coordinate("X").unwrap(), s.multiplier("no_slip").unwrap()];
        [(x - middle * (1.0 - cosine)).abs(), (lambda - friction).abs() / 30.0]
    }));
    assert!(deviation < 1e-8, "{deviation:e}");
}
