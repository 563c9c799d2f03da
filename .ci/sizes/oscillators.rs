//! N oscillators of which the first M are held, and all that the runtime does with a system, on one of them. `.ci/sizes/run`
//! compiles it for every N.

use lagrange_core::{Real, nalgebra::Const, prelude::*};

/// A module of this name with N oscillators on `scalar`, the first M of them held at 1.
#[macro_export]
macro_rules! oscillators {
    ($name:ident, $scalar:ident, $n:tt $(, $m:tt)?) => {
        mod $name {
            use lagrange_core::{Real, prelude::*};

            #[derive(Clone, Lagrangian)]
            #[coordinates(x: [$n])]
            #[lagrangian(sum(i in 0..$n, x_dot[i]^2/2 - k*x[i]^2/2))]
            $(#[constraint(held[i in 0..$m]: x[i] - 1 = 0)])?
            pub(crate) struct Oscillators<T> {
                k: T,
            }

            pub(crate) fn run() -> Result<(), Error> {
                let start = State::at_rest([1.0; $n]);
                let end = $crate::sizes::oscillators::everything::<_, $scalar, $n, _>(&Oscillators { k: 4.0 }, start)?;
                let member = |_| (Oscillators { k: 4.0_f64 }, State::at_rest([1.0; $n]));
                let lanes = Ensemble::from_fn(5, member);
                for (_, state) in lanes.integrate_on_lanes(0.5, Dop853::default())?.completed() {
                    let same = (0..$n).all(|i| (state.q[i] - Real::to_f64(end[i])).abs() < 1e-5);
                    assert!(same, "lanes end at {state:?}, not at {end:?}");
                }
                Ok(())
            }
        }
    };
}

/// Every part of the runtime once; the coordinates at t = 1/2 of oscillators with k = 4 that are let go at 1.
pub(crate) fn everything<L, T, const N: usize, const M: usize>(
    system: &L,
    start: State<T, N>,
) -> Result<[T; N], Error>
where
    L: Linearized<N = Const<N>, M = Const<M>, Scalar = T> + Clone,
    T: Real,
{
    let close = |x: T, y: f64, what: &str| assert!((x.to_f64() - y).abs() < 1e-5, "{what}: {x:?}, not {y}");
    let solution = system.solve(&start)?;
    for i in 0..N {
        close(solution.accelerations[i], if i < M { 0.0 } else { -4.0 }, "acceleration");
    }
    // What holds a coordinate at 1 balances the spring.
    solution.multipliers.iter().for_each(|force| close(*force, 4.0, "multiplier"));

    let (consistent, adjustment) = system.make_consistent(&start)?;
    close(adjustment.largest_coordinate_change(), 0.0, "adjustment");
    let half = T::constant(0.5);
    let path = system.integrate(consistent, half, Dop853::default())?;
    for i in 0..N {
        close(path.end().state().q[i], if i < M { 1.0 } else { 1.0_f64.cos() }, "coordinate");
    }
    assert_eq!(path.csv(2).to_string().lines().count(), 3);
    for deviation in path.drift().iter() {
        close(
            deviation.largest / T::constant(2.0 * N as f64),
            0.0,
            "drift, as a part of the energy at the start",
        );
    }
    let other = system.integrate(start, half, Dopri5::default())?;
    let phases = system.motion_in_momenta(system.phase_state(&start)).to(half)?;
    for i in 0..N {
        close(other.end().state().q[i], path.end().state().q[i].to_f64(), "by Dopri5");
        close(phases.end().state().q[i], path.end().state().q[i].to_f64(), "in (q, p)");
    }

    let jacobian = system.jacobian(&start)?;
    close(jacobian.accelerations.q[(N - 1, N - 1)], if M < N { -4.0 } else { 0.0 }, "Jacobian");
    let at_rest = system.equilibrium(&State::at_rest([half; N]), &[])?;
    for i in 0..N {
        close(at_rest.state.q[i], if i < M { 1.0 } else { 0.0 }, "equilibrium");
    }
    // What is beyond is of no length known to the compiler.
    assert_eq!(system.linearize(&at_rest.state, &[])?.a.nrows(), 2 * (N - M));
    Ok(path.end().state().q.into())
}
