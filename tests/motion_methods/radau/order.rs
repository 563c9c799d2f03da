//! The orders of three, five and seven stages.

use lagrange_core::nalgebra::Const;
use lagrange_core::{Method, TaylorSeries, prelude::*};
use lagrange_systems::{KnifeEdge, ShakenPendulum};

use crate::radau::off;

/// A bob on a spring.
#[derive(Clone, Lagrangian)]
#[coordinates(r, a)]
#[lagrangian((r_dot^2 + r^2*a_dot^2)/2 + 9.81*r*cos(a) - 50*(r - 1)^2)]
#[dissipation(r_dot^2/20)]
struct Elastic;

/// A method with this tolerance and first step.
type MethodOf<P> = fn(f64, f64) -> P;

/// Error after this many equal steps, each a run of its own, with the least tolerance 10^(−k/4) at which all of them are accepted at
/// once; and this k, from `least` on. Without a limit on the error, the tolerance still decides how well a step is solved.
fn in_equal_steps<L, P: Method<L>, const N: usize>(
    (count, least): (u32, u32),
    method: MethodOf<P>,
    (system, start, end): (&L, State<f64, N>, &State<f64, N>),
) -> Option<(u32, f64)>
where
    L: Lagrangian<N = Const<N>, Scalar = f64>,
{
    let step = end.t / f64::from(count);
    let run = |tolerance: f64| {
        (1..=count).try_fold(start, |state, k| {
            let time = if k == count { end.t } else { step * f64::from(k) };
            let path = system.integrate(state, time, method(tolerance, 1.01 * step)).ok()?;
            let counts = path.statistics();
            ((counts.accepted, counts.rejected) == (1, 0)).then(|| *path.end().state())
        })
    };
    let of = |k: u32| Some((k, off(&run(10.0_f64.powf(-0.25 * f64::from(k)))?, end)));
    (least..60).rev().find_map(of)
}

/// Asserts the order, the slope of log error over log number of equal steps, between errors of 10⁻² and 10³ times the least.
fn is_of_order<L, P: Method<L>, const N: usize>(
    order: f64,
    name: &str,
    method: MethodOf<P>,
    (system, start, end): (&L, State<f64, N>, f64),
) where
    L: TaylorSeries<N = Const<N>, Scalar = f64>,
{
    let exact = *system.integrate(start, end, Taylor::default()).unwrap().end().state();
    let (mut points, mut least_power) = (Vec::new(), 4);
    for k in 11.. {
        let count = 2.0_f64.powf(0.2 * f64::from(k)).round();
        // Few steps are accepted at no tolerance.
        if let Some((power, error)) =
            in_equal_steps((count as u32, least_power), method, (system, start, &exact))
        {
            points.push((count, error));
            least_power = power;
        }
        // From here on the tolerance is round-off.
        if least_power == 59 {
            break;
        }
    }
    let least = points.iter().map(|point| point.1).fold(f64::INFINITY, f64::min);
    let is_between = |point: &&(f64, f64)| point.1 < 1e-2 && point.1 > 1e3 * least;
    let points: Vec<_> = points.iter().filter(is_between).map(|(n, e)| (n.log2(), e.log2())).collect();
    let count = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (n, e) = (mean(|point| point.0), mean(|point| point.1));
    let slope = points.iter().map(|point| (point.0 - n) * (point.1 - e)).sum::<f64>()
        / points.iter().map(|point| (point.0 - n).powi(2)).sum::<f64>();
    println!("{name}: order {:.2} of {count} numbers of steps, least error {least:.1e}", -slope);
    assert!(count > 5.0 && -slope > order - 0.3, "{name}: order {} of {count}", -slope);
    assert!(least < 1e-10, "{name}: {least:e}");
}

fn are_of_order<P>(order: f64, method: MethodOf<P>, end: f64)
where
    P: Method<Elastic> + Method<ShakenPendulum<f64>> + Method<KnifeEdge<f64>>,
{
    let shaken = ShakenPendulum { m: 1.0, g: 9.81, l: 1.0, a: 0.02, w: 3.0 };
    let edge = KnifeEdge { m: 1.0, inertia: 1.0, g: 1.0 };
    let (hanging, _) = shaken.make_consistent(&State::at_rest([0.6, -0.8])).unwrap();
    is_of_order(order, "bob on a spring", method, (&Elastic, State::new([1.1, 1.0], [0.0, 0.3]), end));
    is_of_order(order, "rod with a shaken pivot", method, (&shaken, hanging, end));
    is_of_order(order, "blade", method, (&edge, State::new([0.0; 3], [1.0, 0.0, 1.5]), end));
}

#[test]
fn their_orders_are_five_nine_and_thirteen() {
    are_of_order(5.0, |tolerance, step| Radau::with_tolerance(tolerance).first_step(step), 3.0);
    let nine = |tolerance, step| Radau::with_tolerance(tolerance).first_step(step).stages::<5>();
    are_of_order(9.0, nine, 3.0);
    let thirteen = |tolerance, step| Radau::with_tolerance(tolerance).first_step(step).stages::<7>();
    are_of_order(13.0, thirteen, 6.0);
}
