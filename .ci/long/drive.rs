//! What a long system is asked: every function that is emitted, against the equations of Newton and Euler or against others.

use lagrange_core::nalgebra::{Const, SMatrix, SVector};
use lagrange_core::prelude::*;
use lagrange_random::Random;

/// An error where they are further apart than this part of the largest entry, or of `scale`.
pub(crate) fn close<const R: usize>(
    what: &str,
    found: &SVector<f64, R>,
    expected: &SVector<f64, R>,
    scale: f64,
    tolerance: f64,
) -> Result<(), String> {
    let (off, scale) = ((found - expected).amax(), scale.max(expected.amax()).max(1e-3));
    // What is not a number is near nothing.
    let is_close = (0..R).all(|i| (found[i] - expected[i]).abs() <= tolerance * scale);
    if is_close { Ok(()) } else { Err(format!("{what}: {off:e} of {scale:e} off")) }
}

/// The derivative at 0, from differences with three steps (Richardson).
pub(crate) fn slope<const R: usize>(f: impl Fn(f64) -> SVector<f64, R>) -> SVector<f64, R> {
    let difference = |h: f64| (f(h) - f(-h)) / (2.0 * h);
    let [a, b, c] = [1e-3, 5e-4, 2.5e-4].map(difference);
    let [x, y] = [(b * 4.0 - a) / 3.0, (c * 4.0 - b) / 3.0];
    (y * 16.0 - x) / 15.0
}

pub(crate) fn one(x: f64) -> SVector<f64, 1> {
    SMatrix::from_element(x)
}

pub(crate) fn constraints<L: Lagrangian>(_: &L) -> &'static [&'static str] {
    L::CONSTRAINTS
}

pub(crate) fn parameters<L>(_: &L) -> &'static [&'static str]
where
    L: Linearized,
{
    L::PARAMETERS
}

/// A time, coordinates and velocities to move along.
pub(crate) type Along<const N: usize> = (f64, SVector<f64, N>, SVector<f64, N>);

pub(crate) fn random_direction<const N: usize>(random: &mut Random) -> Along<N> {
    (random.number(), random.vector().into(), random.vector().into())
}

/// The state by this part farther.
pub(crate) fn moved<const N: usize>(
    state: &State<f64, N>,
    part: f64,
    &(t, q, v): &Along<N>,
) -> State<f64, N> {
    State { t: state.t + part * t, q: state.q + q * part, v: state.v + v * part }
}

/// Accelerations, or no numbers.
pub(crate) fn accelerations<L, const N: usize>(system: &L, state: &State<f64, N>) -> SVector<f64, N>
where
    L: Lagrangian<N = Const<N>, Scalar = f64>,
{
    system.solve(state).map_or(SVector::from_element(f64::NAN), |found| found.accelerations)
}

/// Compares all functions of a system at a state, but for its Jacobians; multipliers are given with their names.
macro_rules! drive {
    ($name:literal, $system:ident, $state:ident, $accelerations:expr, $multipliers:expr) => {{
        use lagrange_core::{Lanes, Pack};
        use lagrange_random::Random;
        use $crate::long::drive::{close, constraints, moved, one, random_direction, slope};
        let (mut random, sides) = (Random(7), &$multipliers as &[(&str, f64)]);
        let expected = Vec::from($accelerations);
        let solution = $system.solve(&$state).map_err(|error| format!("{}: {error}", $name))?;
        let said = |found: Result<(), String>| found.map_err(|found| format!("{}: {found}", $name));

        // Newton's and Euler's equations.
        let mut accelerations = solution.accelerations;
        accelerations.copy_from_slice(&expected);
        said(close("accelerations", &solution.accelerations, &accelerations, 0.0, 1e-8))?;
        let mut multipliers = solution.multipliers;
        for (multiplier, name) in multipliers.iter_mut().zip(constraints(&$system)) {
            *multiplier = sides.iter().find(|(known, _)| known == name).expect("a constraint").1;
        }
        said(close("multipliers", &solution.multipliers, &multipliers, accelerations.amax(), 1e-8))?;
        let unchecked = $system.accelerations_unchecked(&$state).accelerations;
        said(close("unchecked", &unchecked, &accelerations, 0.0, 1e-7))?;

        // On lanes, between other states.
        let packed = $system.pack();
        let lanes = |x: f64, k: usize| {
            let mut all = [0.0; Lanes::COUNT];
            all.iter_mut().enumerate().for_each(|(i, entry)| *entry = x + 0.01 * (i as f64 - k as f64));
            Lanes::from(all)
        };
        let side_by_side = State::<Lanes, _> {
            t: lanes($state.t, 1),
            q: $state.q.map(|x| lanes(x, 1)),
            v: $state.v.map(|x| lanes(x, 1)),
        };
        let on_lanes = packed.accelerations_unchecked(&side_by_side).accelerations.map(|x| x.to_array()[1]);
        said(close("lanes", &on_lanes, &accelerations, 0.0, 1e-7))?;

        // The equations' parts, and the forces that other accelerations take.
        let (m, h) = ($system.mass_matrix(&$state), $system.forcing(&$state));
        let (f, gamma) = ($system.constraint_jacobian(&$state), $system.constraint_bias(&$state));
        let scale = (m * accelerations).amax().max(h.amax());
        said(close("M a", &(m * accelerations), &(h + f.transpose() * multipliers), scale, 1e-8))?;
        said(close("F a", &(f * accelerations), &-gamma, accelerations.amax(), 1e-8))?;
        let (other, others) = (random.vector().into(), multipliers.map(|_| random.number()));
        let dynamics = $system.inverse_dynamics(&$state, &other, &others);
        let expected = m * other - h - $system.constraint_force(&$state, &others);
        said(close("inverse dynamics", &dynamics, &expected, scale, 1e-8))?;
        said(close(
            "constraint force",
            &$system.constraint_force(&$state, &others),
            &(f.transpose() * others),
            0.0,
            1e-8,
        ))?;

        // The Lagrangian: momenta, energy, and the mass matrix as their derivative.
        let (_, _, v) = random_direction(&mut random);
        let zero = v * 0.0;
        let (p, lagrangian) = ($system.momentum(&$state), $system.lagrangian(&$state));
        let by_difference = slope(|h| one($system.lagrangian(&moved(&$state, h, &(0.0, zero, v)))));
        said(close("momentum", &one(p.dot(&v)), &by_difference, lagrangian.abs(), 1e-7))?;
        let energy = p.dot(&$state.v) - lagrangian;
        said(close("energy", &one($system.energy(&$state)), &one(energy), lagrangian.abs(), 1e-9))?;
        let by_difference = slope(|h| $system.momentum(&moved(&$state, h, &(0.0, zero, v))));
        said(close("mass matrix", &(m * v), &by_difference, 0.0, 1e-7))?;
        // dp/dt = ∂L/∂q + Q + Fᵀλ along the motion.
        let along = slope(|h| $system.momentum(&moved(&$state, h, &(1.0, $state.v, accelerations))));
        let rate = $system.momentum_rate(&$state) + f.transpose() * multipliers;
        said(close("momentum rate", &rate, &along, scale, 1e-7))?;

        // Taylor's method and another one, where the state is on the constraints.
        if let Ok((start, _)) = $system.make_consistent(&$state) {
            let end = $state.t + 0.01;
            let taylor = $system
                .integrate(start, end, Taylor::default())
                .map_err(|error| format!("{}: {error}", $name))?;
            let other = $system
                .integrate(start, end, Dop853::default().relative_tolerance(1e-12))
                .map_err(|error| format!("{}: {error}", $name))?;
            let (a, b) = (*taylor.end().state(), *other.end().state());
            said(close("Taylor", &a.q, &b.q, 1.0, 1e-8))?;
            said(close("Taylor's velocities", &a.v, &b.v, 1.0, 1e-7))?;
        }
    }};
}

/// Compares derivatives by the state and by parameters with differences.
macro_rules! jacobians {
    ($name:literal, $system:ident, $state:ident) => {{
        use lagrange_core::StateDerivatives;
        use lagrange_random::Random;
        use $crate::long::drive::{accelerations, close, moved, parameters, random_direction, slope};
        let said = |found: Result<(), String>| found.map_err(|found| format!("{}: {found}", $name));
        let unsolved = |error: Error| format!("{}: {error}", $name);
        let scale = accelerations(&$system, &$state).amax();
        let jacobian = $system.state_jacobian(&$state).map_err(unsolved)?;
        let (by, along) = (&jacobian.accelerations, random_direction(&mut Random(7)));
        let derivative = by.t * along.0 + by.q * along.1 + by.v * along.2;
        let by_difference = slope(|h| accelerations(&$system, &moved(&$state, h, &along)));
        said(close("state Jacobian", &derivative, &by_difference, scale, 1e-5))?;
        let (all, names) = ($system.parameters(), parameters(&$system));
        let mut tried = 0;
        for k in (0..names.len()).step_by(1 + names.len() / 12) {
            if !$system.clone().set_parameter(k, all[k]) {
                continue;
            }
            tried += 1;
            let with = |h: f64| {
                let mut system = $system.clone();
                system.set_parameter(k, all[k] + h);
                accelerations(&system, &$state)
            };
            let by = $system.jacobian_by(&$state, &[names[k]]).map_err(unsolved)?;
            let column = derivative.map_with_location(|i, _, _| by.accelerations[(i, 0)]);
            said(close(names[k], &column, &slope(with), scale, 1e-5))?;
        }
        if tried == 0 {
            return Err(format!("{}: no parameter", $name));
        }
    }};
}

pub(crate) use {drive, jacobians};
