//! Motions far from the numbers around 1: what is tiny, huge, slow at first, or grows by high powers alone.

use lagrange_core::{TaylorSeries, nalgebra::Const, prelude::*};

#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - k*x^2/2)]
struct Spring<T> {
    k: T,
}

#[derive(Clone, Lagrangian)]
#[coordinates(theta)]
#[lagrangian(theta_dot^2/2 + g*cos(theta))]
#[force(theta: u)]
struct Pendulum<T> {
    g: T,
    u: T,
}

/// From rest far away the accelerations are so large that the first guess of a step is 10⁻³⁰ of the period.
#[test]
fn oscillations_of_any_size_are_cosines() -> Result<(), Error> {
    for start in [1e-200, 1e-30, 1e-8, 1e-2, 1e14, 1e20, 1e30, 1e100] {
        let path = Spring { k: 1.0 }.integrate(State::at_rest([start]), 10.0, Taylor::default())?;
        let off = (path.end().coordinate("x")? - start * 10.0_f64.cos()).abs();
        assert!(off < 1e-13 * f64::max(start, 1e-3), "{start:e}: {off:e}, {:?}", path.statistics());
    }
    for start in [1e-30_f32, 1e-6, 1e5, 1e6, 1e7, 1e10, 1e20] {
        for tolerance in [f64::EPSILON, 1e-6] {
            let method = Taylor::with_tolerance(tolerance);
            let path = Spring { k: 1.0_f32 }.integrate(State::at_rest([start]), 10.0, method)?;
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
    let ensemble = Ensemble::from_fn(starts.len(), |i| (Spring { k: 1.0 }, State::at_rest([starts[i]])));
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
    let pendulum = Pendulum { g, u: 0.0 };
    for lean in [1e-3, 1e-7, 1e-13, 1e-16, 1e-300] {
        let path = pendulum.integrate(State::at_rest([lean]), 1.0, Taylor::default())?;
        let off = (path.end().coordinate("theta")? - lean * g.sqrt().cos()).abs();
        assert!(off < 1e-16 + lean.powi(3), "{lean:e}: {off:e}");
    }
    let upright = pendulum.integrate(State::at_rest([core::f64::consts::PI]), 1.0, Taylor::default())?;
    assert!((upright.end().coordinate("theta")? - core::f64::consts::PI).abs() < 1e-14);
    for lean in [1e-4_f32, 1e-5, 1e-6] {
        let path =
            Pendulum { g: 9.81_f32, u: 0.0 }.integrate(State::at_rest([lean]), 1.0, Taylor::default())?;
        let off = (path.end().coordinate("theta")? / lean - 9.81_f32.sqrt().cos()).abs();
        assert!(off < 1e-5 && path.statistics().accepted < 10, "{lean:e}: {off:e}, {:?}", path.statistics());
    }
    Ok(())
}

/// Where the constraint is stated twice the general factor expands the motion.
#[test]
fn rods_begin_next_to_equilibria() -> Result<(), Error> {
    #[derive(Lagrangian)]
    #[coordinates(x, y)]
    #[lagrangian((x_dot^2 + y_dot^2)/2 - g*y)]
    #[constraint(rod: c*(x^2 + y^2 - 1)/2 = 0)]
    #[constraint(again: g*(x^2 + y^2) = g)]
    struct Rod {
        g: f64,
        c: f64,
    }
    for lean in [1e-7, 1e-15] {
        let path = Rod { g: 9.81, c: 1.0 }.integrate(State::at_rest([lean, -1.0]), 1.0, Taylor::default())?;
        let off = (path.end().coordinate("x")? - lean * 9.81_f64.sqrt().cos()).abs();
        assert!(off < 1e-15, "{lean:e}: {off:e}");
    }
    Ok(())
}

/// After a long rest, in one step, a push begins a motion whose unit of time is much shorter.
#[test]
fn a_push_after_a_long_rest_is_a_motion() -> Result<(), Error> {
    let mut motion = Motion::new(Pendulum { g: 9.81_f32, u: 0.0 }, State::at_rest([0.0]), Taylor::default())?;
    motion.advance_to(1000.0)?;
    motion.system_mut().u = 1.0;
    motion.advance_to(1001.0)?;
    let mut pushed = Motion::new(Pendulum { g: 9.81_f32, u: 1.0 }, State::at_rest([0.0]), Taylor::default())?;
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
    #[lagrangian(x_dot^2/2 - x^8/8)]
    struct Septic;
    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(x_dot^2/2 - x^10/10)]
    struct Nonic;
    fn off<L: TaylorSeries<N = Const<1>, M = Const<0>, Scalar = f64>>(
        system: &L,
        tolerance: f64,
    ) -> Result<f64, Error> {
        let start = State::new([0.0], [1.0]);
        let exact = system.integrate(start, 5.0, Dop853::with_tolerance(1e-14))?;
        let path = system.integrate(start, 5.0, Taylor::with_tolerance(tolerance))?;
        Ok((path.end().coordinate("x")? - exact.end().coordinate("x")?).abs())
    }
    for tolerance in [1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12] {
        let [septic, nonic] = [off(&Septic, tolerance)?, off(&Nonic, tolerance)?];
        assert!(
            septic < 30.0 * tolerance && nonic < 30.0 * tolerance,
            "{tolerance:e}: {septic:e}, {nonic:e}"
        );
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
