//! Motions far from the numbers around 1: what is tiny, huge, slow at first, or grows by high powers alone; and
//! roots at their branch points.

use lagrange_core::{Ending, prelude::*};
use lagrange_systems::{DoubledRod, DrivenSpring, Pendulum, Spring, Thrown};

use super::SPRING;

/// A pendulum of length 1.
fn pendulum<T: Scalar>(g: T) -> Pendulum<T> {
    Pendulum { m: T::constant(1.0), l: T::constant(1.0), g }
}

/// From rest far away the accelerations are so large that the first guess of a step is 10⁻³⁰ of the period.
#[test]
fn oscillations_of_any_size_are_cosines() -> Result<(), Error> {
    for start in [1e-200, 1e-30, 1e-8, 1e-2, 1e14, 1e20, 1e30, 1e100] {
        let path = SPRING.integrate(State::at_rest([start]), 10.0, Taylor::default())?;
        let off = (path.end().coordinate("x")? - start * 10.0_f64.cos()).abs();
        assert!(off < 1e-13 * f64::max(start, 1e-3), "{start:e}: {off:e}, {:?}", path.statistics());
    }
    for start in [1e-30_f32, 1e-6, 1e5, 1e6, 1e7, 1e10, 1e20] {
        for tolerance in [f64::EPSILON, 1e-6] {
            let method = Taylor::with_tolerance(tolerance);
            let path = Spring { m: 1.0_f32, k: 1.0 }.integrate(State::at_rest([start]), 10.0, method)?;
            let off = (path.end().coordinate("x")? - start * 10.0_f32.cos()).abs();
            assert!(
                off < 1e-5 * f32::max(start, 1.0),
                "{start:e}, {tolerance:e}: {off:e}, {:?}",
                path.statistics()
            );
        }
    }
    Ok(())
}

/// So they do on lanes, beside members of other sizes.
#[test]
fn members_of_any_size_are_cosines() -> Result<(), Error> {
    let starts = [1e-30, 1.0, 1e14, 1e30, 0.0, 1e-3, 1e100, 1e8, 1e20];
    let ensemble = Ensemble::from_fn(starts.len(), |i| (SPRING, State::at_rest([starts[i]])));
    let outcome = ensemble.integrate_on_lanes(10.0, Taylor::default())?;
    for (member, start) in outcome.members().iter().zip(starts) {
        let end = member.arrival().expect("an arrival").state.q[0];
        assert!((end - start * 10.0_f64.cos()).abs() < 1e-13 * f64::max(start, 1e-3), "{start:e}: {end:e}");
    }
    Ok(())
}

/// Near an equilibrium the accelerations are so small that the first guess of a step is 10¹⁵ periods.
#[test]
fn pendulums_begin_next_to_equilibria() -> Result<(), Error> {
    let g: f64 = 9.81;
    let swing = pendulum(g);
    for lean in [1e-3, 1e-7, 1e-13, 1e-16, 1e-300] {
        let path = swing.integrate(State::at_rest([lean]), 1.0, Taylor::default())?;
        let off = (path.end().coordinate("theta")? - lean * g.sqrt().cos()).abs();
        assert!(off < 1e-16 + lean.powi(3), "{lean:e}: {off:e}");
    }
    let upright = swing.integrate(State::at_rest([core::f64::consts::PI]), 1.0, Taylor::default())?;
    assert!((upright.end().coordinate("theta")? - core::f64::consts::PI).abs() < 1e-14);
    for lean in [1e-4_f32, 1e-5, 1e-6] {
        let swing = pendulum(9.81_f32);
        let path = swing.integrate(State::at_rest([lean]), 1.0, Taylor::default())?;
        let off = (path.end().coordinate("theta")? / lean - 9.81_f32.sqrt().cos()).abs();
        assert!(off < 1e-5 && path.statistics().accepted < 10, "{lean:e}: {off:e}, {:?}", path.statistics());
    }
    Ok(())
}

/// Where the constraint is stated twice the general factor expands the motion.
#[test]
fn rods_begin_next_to_equilibria() -> Result<(), Error> {
    let rod = DoubledRod { g: 9.81, a: 1.0, c: 0.0 };
    for lean in [1e-7, 1e-15] {
        let path = rod.integrate(State::at_rest([lean, -1.0]), 1.0, Taylor::default())?;
        let off = (path.end().coordinate("x")? - lean * 9.81_f64.sqrt().cos()).abs();
        assert!(off < 1e-15, "{lean:e}: {off:e}");
    }
    Ok(())
}

/// After a long rest, in one step, a push begins a motion whose unit of time is much shorter.
#[test]
fn a_push_after_a_long_rest_is_a_motion() -> Result<(), Error> {
    let driven = |a| DrivenSpring { m: 1.0_f32, k: 9.81, c: 0.0, a, w: 0.0 };
    let mut motion = Motion::new(driven(0.0), State::at_rest([0.0]), Taylor::default())?;
    motion.advance_to(1000.0)?;
    motion.system_mut().a = 1.0;
    motion.advance_to(1001.0)?;
    let mut pushed = Motion::new(driven(1.0), State::at_rest([0.0]), Taylor::default())?;
    pushed.advance_to(1.0)?;
    let [late, early] = [motion.state().q[0], pushed.state().q[0]];
    assert!(early > 0.1 && (late - early).abs() < 1e-4, "{late} and {early}");
    Ok(())
}

/// x = v − v⁹/72 + …: between are more zeros than coefficients are looked at.
#[test]
fn coefficients_far_apart_are_not_the_end_of_a_series() -> Result<(), Error> {
    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(x_dot^2/2 - a*x^8/8 - b*x^10/10)]
    struct Steep {
        a: f64,
        b: f64,
    }
    let start = State::new([0.0], [1.0]);
    for steep in [Steep { a: 1.0, b: 0.0 }, Steep { a: 0.0, b: 1.0 }] {
        let exact = steep.integrate(start, 5.0, Dop853::with_tolerance(1e-14))?.end().coordinate("x")?;
        for tolerance in [1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12] {
            let path = steep.integrate(start, 5.0, Taylor::with_tolerance(tolerance))?;
            let off = (path.end().coordinate("x")? - exact).abs();
            assert!(off < 30.0 * tolerance, "{tolerance:e}: {off:e}");
        }
    }
    Ok(())
}

/// (x²)ᵖ with p = ½ has a kink, of which no exponent tells while compiling.
#[test]
fn a_root_by_a_parameter_is_watched() -> Result<(), Error> {
    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(x_dot^2/2)]
    #[force(x: -(x^2)^p)]
    struct Bent {
        p: f64,
    }
    // A cosine down to zero, and beyond a hyperbolic sine.
    let bent = Bent { p: 0.5 };
    let path =
        bent.integrate(State::at_rest([1.0]), core::f64::consts::FRAC_PI_2 + 1.0, Taylor::default())?;
    let off = (path.end().coordinate("x")? + 1.0_f64.sinh()).abs();
    assert!(off < 1e-14, "{off:e}");
    Ok(())
}

/// √p and its like, of a parameter that is zero.
#[test]
fn what_rests_at_a_branch_point_stays_there() -> Result<(), Error> {
    #[derive(Clone, Copy)]
    struct Bent;
    impl Function<2, 1> for Bent {
        fn eval<S: Scalar>(&self, [x, p]: [S; 2]) -> [S; 1] {
            let (half, one) = (S::constant(0.5), S::constant(1.0));
            let at_rest = p.sqrt() + p.powf(half) + (one + p).acos();
            [x * x * half + at_rest * x]
        }
    }
    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[function(U(x, p) = f)]
    #[lagrangian(x_dot^2/2 - U(x, p))]
    struct Supplied {
        p: f64,
        f: Bent,
    }
    let path = Supplied { p: 0.0, f: Bent }.integrate(State::at_rest([1.0]), 10.0, Taylor::default())?;
    let off = (path.end().coordinate("x")? - 10.0_f64.cos()).abs();
    assert!(off < 1e-14, "{off:e}");
    Ok(())
}

/// m v̇ = −m g − c v √v² upwards and down: v = w tan(φ₀ − g t/w) to the top, then −w tanh(g t/w), with w = √(m g/c).
#[test]
fn drag_by_the_root_of_a_square_turns_with_the_velocity() -> Result<(), Error> {
    let (g, c, v) = (9.81, 0.7, 3.0_f64);
    let terminal = (g / c).sqrt();
    let up = terminal / g * (v / terminal).atan();
    let thrown = Thrown { g, c };
    let path = thrown.motion(State::new([0.0], [v])).by(Taylor::default()).towards(2.0)?;
    let expected = -terminal * (g * (2.0 - up) / terminal).tanh();
    let off = (path.end().velocity("x")? - expected).abs();
    assert!(off < 4e-14, "{off:e} {:?} {:?}", path.ending(), path.statistics());
    Ok(())
}

/// A potential |sin x|, by no even power that one could see: about the kink its root is rounding errors.
#[test]
fn a_kink_that_numbers_do_not_resolve_ends_the_motion() -> Result<(), Error> {
    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(x_dot^2/2 - sqrt(1 - cos(x)^2))]
    struct Valley;
    let path = Valley.motion(State::at_rest([1.0])).by(Taylor::default()).towards(20.0)?;
    let end = path.end();
    let (x, v) = (end.coordinate("x")?, end.velocity("x")?);
    let off = v * v / 2.0 + x.sin().abs() - 1.0_f64.sin();
    assert!(matches!(path.ending(), Ending::NotFinite { .. }) && x.abs() < 1e-7, "{:?}", path.ending());
    assert!(off.abs() < 1e-8, "{off:e}");
    Ok(())
}

/// A motion that has left the domain of its equations is set back into it.
#[test]
fn what_was_no_number_is_forgotten() -> Result<(), Error> {
    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(x_dot^2/2 + x^(3/2))]
    struct Slope;
    let mut motion = Motion::new(Slope, State::new([1.0], [-1.0]), Taylor::default())?;
    for _ in 0..3 {
        motion.set_state(State::new([0.0], [-1.0]))?;
        assert!(motion.advance_to(1.0).is_err());
        motion.set_state(State::new([1.0], [2.0 / 5.0_f64.sqrt()]))?;
        assert_eq!(motion.advance_to(0.5), Ok(()));
        let state = motion.state();
        let off = state.v[0].powi(2) / 2.0 - state.q[0].powf(1.5) - (0.4 - 1.0);
        assert!(off.abs() < 1e-14, "{off:e}");
    }
    Ok(())
}
