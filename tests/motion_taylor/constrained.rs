//! Motions on constraints: there and back, between the steps, constraints too many, inputs that change.

use lagrange_core::{TaylorSeries, prelude::*};
use lagrange_systems::{DoublePendulum, SphericalPendulum};

const SPHERICAL: SphericalPendulum<f64> = SphericalPendulum { m: 1.0, g: 9.81, l: 1.0 };

fn thrown() -> State<f64, 3> {
    State::new([0.6, 0.0, -0.8], [0.0, 1.3, 0.0])
}

#[test]
fn there_and_back() -> Result<(), Error> {
    let path = SPHERICAL.integrate(thrown(), 20.0, Taylor::default())?;
    let there = *path.end().state();
    let path = SPHERICAL.integrate(there, 0.0, Taylor::default())?;
    let back = *path.end().state();
    let off = (back.q - thrown().q).amax().max((back.v - thrown().v).amax());
    assert!(off < 1e-13 && (there.q - thrown().q).amax() > 0.1, "{off:e} {there:?}");
    Ok(())
}

/// At times on a grid, which are not those of steps, by both ways that there are to them.
#[test]
fn constraints_hold_between_the_steps() -> Result<(), Error> {
    let path = SPHERICAL.integrate(thrown(), 20.0, Taylor::default())?;
    assert!(path.statistics().accepted < 300);
    let mut motion = Motion::new(&SPHERICAL, thrown(), Taylor::default())?;
    let times = (0..=2000).map(|k| 0.01 * f64::from(k));
    let mut worst = [0.0_f64; 3];
    for state in motion.states_at(times) {
        let state = state?;
        let sampled = *path.at(state.t)?.state();
        for state in [&state, &sampled] {
            let energy = SPHERICAL.energy(state) - SPHERICAL.energy(&thrown());
            let off =
                [2.0 * SPHERICAL.constraint_residual(state)[0], SPHERICAL.constraint_rate(state)[0], energy];
            worst = std::array::from_fn(|i| worst[i].max(off[i].abs()));
        }
        assert_eq!(state, sampled);
    }
    // In units of l² and of l·max|v|, which is 4.
    let most = [16.0 * f64::EPSILON, 64.0 * f64::EPSILON, 1e-13];
    assert!(worst.iter().zip(most).all(|(off, most)| *off <= most), "{worst:?}");
    Ok(())
}

#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian((x_dot^2 + y_dot^2 + z_dot^2)/2 - g*y)]
#[constraint(sphere: a*(x^2 + y^2 + z^2 - 1)/2 = 0)]
#[constraint(plane: z = 0)]
#[constraint(cylinder: b*(x^2 + y^2) = b)]
struct Thrice {
    g: f64,
    /// Were one of them zero, the constraint with the other would be needed.
    a: f64,
    b: f64,
}

/// Any two make a circle. A bob that is let go at the height of its suspension is held by 3 g y along it: the sphere's row r and the
/// cylinder's 2 r carry half of it each.
#[test]
fn a_constraint_too_many_shares_its_force() -> Result<(), Error> {
    let system = Thrice { g: 9.81, a: 1.0, b: 1.0 };
    let path = system.integrate(State::at_rest([1.0, 0.0, 0.0]), 10.0, Taylor::default())?;
    assert!(!path.multipliers_are_unique());
    for sample in path.steps().chain(path.samples(500)) {
        let y = sample.coordinate("y")?;
        let half = 3.0 * 9.81 * y / 2.0;
        let [sphere, plane, cylinder] = sample.solution()?.multipliers.into();
        let speed = sample.state().v.norm_squared() + 2.0 * 9.81 * y;
        let off = [sphere - half, plane, 2.0 * cylinder - half, speed];
        assert!(off.iter().all(|off| off.abs() < 1e-12), "{off:?} at {}", sample.time());
    }
    Ok(())
}

/// A bead on a ring, pushed along it.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2)]
#[force(x: -u*y)]
#[force(y: u*x)]
#[constraint(ring: x^2 + y^2 = 1)]
pub(crate) struct Bead<T> {
    pub(crate) u: T,
}

/// A force along the ring is an angular acceleration: between changes the angle is a parabola.
#[test]
fn inputs_change_every_ten_milliseconds() -> Result<(), Error> {
    let mut bead = Motion::new(Bead { u: 0.0 }, State::new([1.0, 0.0], [0.0, 0.5]), Taylor::default())?;
    let (mut angle, mut rate) = (0.0_f64, 0.5_f64);
    for k in 1..=500 {
        let (u, tick) = (20.0 * (f64::from(k) * 0.7).sin() + 3.0, 0.01 * f64::from(k) - bead.state().t);
        bead.system_mut().u = u;
        bead.advance_to(0.01 * f64::from(k))?;
        angle += tick * (rate + tick * u / 2.0);
        rate += tick * u;
        let State { q, v, .. } = *bead.state();
        let off = [q[0] - angle.cos(), q[1] - angle.sin(), v[0] + rate * q[1], v[1] - rate * q[0]];
        assert!(off.iter().all(|off| off.abs() < 2e-13), "{k}: {off:?}");
    }
    Ok(())
}

/// Two bobs on rods, the first on a support that moves.
macro_rules! carried {
    ($name:ident, $upper:expr, $lower:expr) => {
        #[derive(Lagrangian)]
        #[coordinates(x, y, a, b)]
        #[lagrangian((x_dot^2 + y_dot^2)/2 + a_dot^2 + b_dot^2 - g*(y + 2*b))]
        #[define(above = (x - u*t)^2 + y^2)]
        #[define(below = (a - x)^2 + (b - y)^2)]
        #[constraint(upper: $upper = 0)]
        #[constraint(lower: $lower = 0)]
        struct $name {
            g: f64,
            u: f64,
            l: f64,
        }
    };
}

carried!(Squares, above - l ^ 2, below - l ^ 2);
carried!(Lengths, sqrt(above) - l, sqrt(below) - l);
carried!(Mixed, above - l ^ 2, sqrt(below) - l);

/// A constraint of second degree is expanded two orders ahead, and takes fewer sums; what is a length is not.
#[test]
fn constraints_in_other_words_lead_to_one_motion() -> Result<(), Error> {
    let (g, u, l, [theta, phi]) = (9.81, 1.7, 0.8, [1.1_f64, 0.4_f64]);
    // Seen from the support.
    let unconstrained = DoublePendulum { m: [1.0, 2.0], l: [l; 2], g };
    let by_angles = unconstrained.integrate(State::at_rest([theta, phi]), 5.0, Taylor::default())?;
    let place = |q: [f64; 2]| [q[0].sin(), -q[0].cos(), q[0].sin() + q[1].sin(), -q[0].cos() - q[1].cos()];
    let start = State::new(place([theta, phi]).map(|x| l * x), [u, 0.0, u, 0.0]);
    macro_rules! check {
        ($($name:ident: $sums:literal),*) => {$(
            assert_eq!(size_of::<<$name as TaylorSeries>::Sums>() / size_of::<f64>(), $sums);
            let system = $name { g, u, l };
            let path = system.integrate(start, 5.0, Taylor::default())?;
            let mut worst = 0.0_f64;
            for sample in path.steps().chain(path.samples(300)) {
                let State { t, q, .. } = *sample.state();
                let expected = place(by_angles.at(t)?.state().q.into());
                let moved = [u * t, 0.0, u * t, 0.0];
                worst = (0..4).map(|i| (q[i] - l * expected[i] - moved[i]).abs()).fold(worst, f64::max);
            }
            let steps = path.statistics().accepted;
            assert!(worst < 1e-13 && steps < 150, "{}: {worst:e} in {steps} steps", stringify!($name));
        )*};
    }
    check!(Squares: 8, Mixed: 24, Lengths: 36);
    Ok(())
}
