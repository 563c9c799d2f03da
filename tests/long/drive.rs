//! What a long system is asked: every function that is emitted, against the equations of Newton and Euler or against others.

use lagrange_core::nalgebra::{SMatrix, SVector};
use lagrange_core::prelude::*;

/// Numbers in (−1, 1), always the same.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    pub(crate) fn vector<const K: usize>(&mut self) -> SVector<f64, K> {
        SVector::from_fn(|_, _| self.number())
    }
}

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
    let [a, b, c] = [4e-3, 2e-3, 1e-3].map(difference);
    let [x, y] = [(b * 4.0 - a) / 3.0, (c * 4.0 - b) / 3.0];
    (y * 16.0 - x) / 15.0
}

pub(crate) fn one(x: f64) -> SVector<f64, 1> {
    SMatrix::from_element(x)
}

pub(crate) fn constraints<L: Lagrangian<N, M>, const N: usize, const M: usize>(_: &L) -> [&'static str; M] {
    L::CONSTRAINTS
}

pub(crate) fn parameters<L, const N: usize, const M: usize, const P: usize>(_: &L) -> [&'static str; P]
where
    L: Linearized<N, M, P>,
{
    L::PARAMETERS
}

/// Compares all functions of a system at a state; multipliers are given with their names.
macro_rules! drive {
    ($name:literal, $system:ident, $state:ident, $accelerations:expr, $multipliers:expr) => {{
        use lagrange_core::{Lanes, Pack, StateDerivatives};
        use $crate::drive::{Random, close, constraints, one, parameters, slope};
        let (mut random, sides) = (Random(7), &$multipliers as &[(&str, f64)]);
        let (n, expected) = ($state.q.len(), Vec::from($accelerations));
        let solution = $system.solve(&$state).map_err(|error| format!("{}: {error}", $name))?;
        let said = |found: Result<(), String>| found.map_err(|found| format!("{}: {found}", $name));

        // Newton's and Euler's equations.
        let mut accelerations = solution.accelerations;
        accelerations.copy_from_slice(&expected);
        said(close("accelerations", &solution.accelerations, &accelerations, 0.0, 1e-8))?;
        let mut multipliers = solution.multipliers;
        for (multiplier, name) in multipliers.iter_mut().zip(constraints(&$system)) {
            *multiplier = sides.iter().find(|(known, _)| *known == name).expect("a constraint").1;
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
        let (other, others) = (random.vector(), multipliers.map(|_| random.number()));
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
        let (t, q, v) = (random.number(), random.vector(), random.vector());
        let moved = |h: f64,
                     t: f64,
                     q: &lagrange_core::nalgebra::SVector<f64, _>,
                     v: &lagrange_core::nalgebra::SVector<f64, _>| {
            State { t: $state.t + h * t, q: $state.q + q * h, v: $state.v + v * h }
        };
        let zero = v * 0.0;
        let (p, lagrangian) = ($system.momentum(&$state), $system.lagrangian(&$state));
        let by_difference = slope(|h| one($system.lagrangian(&moved(h, 0.0, &zero, &v))));
        said(close("momentum", &one(p.dot(&v)), &by_difference, lagrangian.abs(), 1e-7))?;
        let energy = p.dot(&$state.v) - lagrangian;
        said(close("energy", &one($system.energy(&$state)), &one(energy), lagrangian.abs(), 1e-9))?;
        let by_difference = slope(|h| $system.momentum(&moved(h, 0.0, &zero, &v)));
        said(close("mass matrix", &(m * v), &by_difference, 0.0, 1e-7))?;
        // dp/dt = ∂L/∂q + Q + Fᵀλ along the motion.
        let along = slope(|h| $system.momentum(&moved(h, 1.0, &$state.v, &accelerations)));
        let rate = $system.momentum_rate(&$state) + f.transpose() * multipliers;
        said(close("momentum rate", &rate, &along, scale, 1e-7))?;

        // Derivatives by the state and by parameters.
        let jacobian = $system.state_jacobian(&$state).map_err(|error| format!("{}: {error}", $name))?;
        let by = &jacobian.accelerations;
        let derivative = by.t * t + by.q * q + by.v * v;
        let accelerations_at = |system: &System<f64>, state: &State<f64, _>| {
            system.solve(state).map(|found| found.accelerations)
        };
        let by_difference =
            slope(|h| accelerations_at(&$system, &moved(h, t, &q, &v)).unwrap_or(zero * f64::NAN));
        said(close("state Jacobian", &derivative, &by_difference, accelerations.amax(), 1e-5))?;
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
                accelerations_at(&system, &$state).unwrap_or(zero * f64::NAN)
            };
            let by =
                $system.jacobian_by(&$state, &[names[k]]).map_err(|error| format!("{}: {error}", $name))?;
            let column = by.accelerations.column(0).into_owned();
            let mut derivative = zero;
            derivative.copy_from_slice(column.as_slice());
            said(close(names[k], &derivative, &slope(with), accelerations.amax(), 1e-5))?;
        }
        if tried == 0 || n == 0 {
            return Err(format!("{}: no parameter", $name));
        }

        // Taylor's method and another one, where the state is on the constraints.
        if let Ok((start, _)) = $system.make_consistent(&$state) {
            let end = $state.t + 0.01;
            let taylor = $system
                .integrate(start, end, Taylor::default())
                .map_err(|error| format!("{}: {error}", $name))?;
            let other = $system
                .integrate(start, end, Dop853::default().relative(1e-12))
                .map_err(|error| format!("{}: {error}", $name))?;
            let (a, b) = (*taylor.end().state(), *other.end().state());
            said(close("Taylor", &a.q, &b.q, 1.0, 1e-8))?;
            said(close("Taylor's velocities", &a.v, &b.v, 1.0, 1e-7))?;
        }
        Ok(())
    }};
}

pub(crate) use drive;
