//! Runs a case by all methods that apply, or by `Dop853` and Gauss's method of order 2 without the feature `thorough`.

#[cfg(feature = "thorough")]
use lagrange_core::motion::Composition::{KahanLi6, KahanLi8};
use lagrange_core::nalgebra::Const;
use lagrange_core::{Lagrangian, Method, prelude::*};

use crate::faults::case::{Case, Outcome, Scope, SetParameter};

/// Runs a case by these methods, each with its own step or tolerance if the case sets none.
macro_rules! run {
    ($case:ident, $($scope:ident: $([$name:literal, $value:literal, $make:expr])*;)*) => {{
        let mut outcomes = Vec::new();
        $($(if $case.scope == Scope::All || $case.scope == Scope::$scope {
            let make: fn(f64) -> _ = $make;
            let mut method = make($case.setting.unwrap_or($value)).max_steps($case.max_steps);
            if let Some(limit) = $case.wall_time {
                method = method.wall_time(limit);
            }
            outcomes.push($case.run($name, method));
        })*)*
        outcomes
    }};
}

/// All methods, on systems without constraints that all of them take.
pub(crate) fn free<L>(case: &Case<L>) -> Vec<Outcome>
where
    L: Lagrangian<N = Const<2>, Scalar = f64> + SetParameter + Clone + Send + 'static,
    Verlet: Method<L>,
    Gauss<1>: Method<L>,
    Gauss<4>: Method<L>,
    Taylor: Method<L>,
    Radau: Method<L>,
    Lobatto<2>: Method<L>,
    Lobatto<4>: Method<L>,
    DAlembert: Method<L>,
{
    let mut outcomes = held(case);
    outcomes.extend(run!(case, FixedSteps: ["Gauss 1", 0.01, Gauss::<1>::with_step];));
    #[cfg(feature = "thorough")]
    outcomes.extend(run!(case, FixedSteps: ["Gauss 4", 0.05, Gauss::<4>::with_step];));
    outcomes
}

/// All methods that take constraints.
pub(crate) fn held<L>(case: &Case<L>) -> Vec<Outcome>
where
    L: Lagrangian<N = Const<2>, Scalar = f64> + SetParameter + Clone + Send + 'static,
    Verlet: Method<L>,
    Taylor: Method<L>,
    Radau: Method<L>,
    Lobatto<2>: Method<L>,
    Lobatto<4>: Method<L>,
    DAlembert: Method<L>,
{
    #[cfg_attr(not(feature = "thorough"), expect(unused_mut))]
    let mut outcomes = run!(case, StepControl: ["Dop853", 1e-9, Dop853::with_tolerance];);
    #[cfg(feature = "thorough")]
    outcomes.extend(run!(
        case,
        FixedSteps:
            ["Verlet", 0.01, Verlet::with_step]
            ["Verlet, order 8", 0.05, |h| Verlet::with_step(h).composed(KahanLi8)]
            ["Lobatto 2", 0.01, Lobatto::<2>::with_step]
            ["Lobatto 4", 0.05, Lobatto::<4>::with_step]
            ["DAlembert", 0.01, DAlembert::with_step]
            ["DAlembert, order 6", 0.05, |h| DAlembert::with_step(h).composed(KahanLi6)]
            ["RungeKutta4", 0.01, RungeKutta4::with_step];
        StepControl:
            ["Dopri5", 1e-6, Dopri5::with_tolerance]
            ["Taylor", 1e-12, Taylor::with_tolerance]
            ["Radau", 1e-6, Radau::with_tolerance];
    ));
    outcomes
}
