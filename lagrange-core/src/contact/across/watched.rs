//! The events that end a leg: gaps that close, forces that come to zero or to their limit, and velocities that stop or turn.

use alloc::boxed::Box;
use alloc::vec::Vec;

use super::bodies::Bodies;
use super::condition::LegCondition;
use super::friction::bounds;
use super::instant::Decided;
use super::last_value::LastValue;
use super::lifting::Lifting;
use super::limits::BEYOND;
use super::states::LegFriction;
use super::{Contacts, Friction, FrictionRows};
use crate::error::Error;
use crate::motion::event::noise;
use crate::motion::{DynEvent, Simulate};
use crate::names::name;
use crate::number::limits::{ACCUMULATED, SUM};
use crate::number::{Real, Scalar, larger, smaller};
use crate::solution::Sample;
use crate::system::{Lagrangian, SolutionOf, StateOf, System};
use crate::vector::{StaticLength, Vector};

/// An event, with the condition that it watches.
pub(super) type ConditionEvent<'w, L> = (Box<DynEvent<'w, L>>, LegCondition<<L as System>::Scalar>);

/// Quantities of a state that events share.
pub(super) struct SharedValues<'l, L: Lagrangian> {
    closed: &'l L,
    solutions: LastValue<L, SolutionOf<L>>,
    residuals: LastValue<L, Vector<L::Scalar, L::M>>,
}

impl<'l, L: Contacts<Scalar: Real> + Clone> SharedValues<'l, L> {
    /// Nothing that is known yet of a system, all contacts of which are closed in `closed`.
    pub(super) fn of(closed: &'l L) -> Self {
        Self { closed, solutions: LastValue::new(), residuals: LastValue::new() }
    }

    fn solution(&self, sample: &Sample<&L>) -> Result<SolutionOf<L>, Error> {
        self.solutions.at(sample.state(), || sample.solution())
    }

    fn gap(&self, row: usize, sample: &Sample<&L>) -> Result<L::Scalar, Error> {
        let state = sample.state();
        Ok(self.residuals.at(state, || Ok(self.closed.constraint_residual(state)))?[row])
    }

    /// Acceleration W q̈ + γ of a gap.
    fn acceleration(&self, row: usize, sample: &Sample<&L>) -> Result<L::Scalar, Error> {
        let (state, accelerations) = (sample.state(), self.solution(sample)?.accelerations);
        let jacobian = self.closed.constraint_jacobian(state);
        let bias = self.closed.constraint_bias(state)[row];
        Ok((0..<L::N>::COUNT).fold(bias, |sum, i| sum + jacobian[(row, i)] * accelerations[i]))
    }
}

/// The events that gaps close and forces of contacts come to zero, with the conditions that they watch.
pub(super) fn of_contacts<'w, L>(
    (system, bodies): (&L, &Bodies<L>),
    (shared, lifting): (&'w SharedValues<'_, L>, &'w Lifting<L::Scalar>),
    decided: &Decided<L::Scalar>,
    state: &StateOf<L>,
) -> Result<Vec<ConditionEvent<'w, L>>, Error>
where
    L: Contacts<Scalar: Real> + Clone + 'w,
{
    let zero = L::Scalar::constant(0.0);
    let watches = |(k, &row): (usize, &usize)| -> Result<ConditionEvent<'w, L>, Error> {
        let name = name(L::CONSTRAINTS, row);
        if decided.states.is_closed(k) {
            let force = move |sample: &Sample<&L>| Ok(shared.solution(sample)?.multipliers[row]);
            check_push(system, state, name, force)?;
            // One that begins at zero may have no round-off of its own.
            let solution = system.solve(state)?;
            let size = largest::<L>(&solution);
            let round_off = L::Scalar::constant(L::Scalar::EPSILON * ACCUMULATED) * size;
            let margin = margin(system, state, [round_off, size], force)?;
            let event = system.event(name, move |sample| Ok(force(sample)? + margin));
            return Ok((Box::new(event.condition().terminal()), LegCondition::Pushes { row }));
        }
        let gap = move |sample: &Sample<&L>| shared.gap(row, sample);
        if !decided.states.contacts[k].is_resting {
            return Ok((Box::new(system.event(name, gap).falling().terminal()), LegCondition::Motion));
        }
        let parts = move |sample: &Sample<&L>| shared.acceleration(row, sample);
        let noise = noise(&system.event(name, parts), system, state)?;
        let gap = move |sample: &Sample<&L>| {
            let gap = gap(sample)?;
            if !lifting.is_at_rest(k) {
                return Ok(gap);
            }
            let rises = lifting.rises(k, sample.state().t, (parts(sample)?, noise));
            Ok(if rises { larger(gap, L::Scalar::constant(0.0)) } else { gap })
        };
        let margin = margin(system, state, [bodies.touching(k, state) + least_speed(), zero], gap)?;
        let event = system.event(name, move |sample| Ok(gap(sample)? + margin));
        Ok((Box::new(event.falling().terminal()), LegCondition::Motion))
    };
    let contacts = L::CONTACTS.iter().enumerate().filter(|(k, _)| !decided.states.contacts[*k].is_implied);
    contacts.map(watches).collect()
}

/// Fails if a force pulls at the start of a leg, by more than what the decision leaves of the largest force of all contacts and
/// its own round-off.
fn check_push<L: Contacts<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
    name: &'static str,
    force: impl Fn(&Sample<&L>) -> Result<L::Scalar, Error> + Copy,
) -> Result<(), Error> {
    let sample = system.sample(*state);
    let push = force(&sample)?;
    if push >= L::Scalar::constant(0.0) {
        return Ok(());
    }
    let size = largest::<L>(&sample.solution()?);
    let noise = noise(&system.event(name, force), system, state)?;
    if push < -larger(L::Scalar::constant(BEYOND) * size, L::Scalar::constant(ACCUMULATED) * noise) {
        return Err(Error::FrictionUndecided { friction: name, time: state.t.to_f64() });
    }
    Ok(())
}

/// The events that friction reaches its limit, or stops the bodies, with the conditions that they watch.
pub(super) fn of_friction<'w, L>(
    system: &L,
    shared: &'w SharedValues<'_, L>,
    decided: &Decided<L::Scalar>,
    state: &StateOf<L>,
) -> Result<Vec<ConditionEvent<'w, L>>, Error>
where
    L: Contacts<Scalar: Real> + Clone + 'w,
{
    let (closed, zero, mut events) = (shared.closed, L::Scalar::constant(0.0), Vec::new());
    for (f, &FrictionRows { row, .. }) in L::FRICTIONS.iter().enumerate() {
        if !decided.states.is_pressed::<L>(f) {
            continue;
        }
        let LegFriction { friction, is_implied, .. } = decided.states.frictions[f];
        let [limit, force, least] =
            if friction.is_at_rest() { check_held(system, (closed, f), state)? } else { [zero; 3] };
        // A force that is a part of that of sliding, and of a velocity that others keep zero, stays where it is.
        if is_implied {
            continue;
        }
        let name = name(L::CONSTRAINTS, row);
        let event: Box<DynEvent<'w, L>> = match friction {
            Friction::Sticks | Friction::Shares(_) => {
                let left = move |sample: &Sample<&L>| {
                    let [limit, force] = held(closed, f, sample.state(), &shared.solution(sample)?)?;
                    Ok(limit - force)
                };
                // A force that begins at its limit has no sign before, and may have no round-off.
                let margin =
                    margin(system, state, [least + least_speed::<L::Scalar>(), limit + force], left)?;
                let event = system.event(name, move |sample| Ok(left(sample)? + margin));
                Box::new(event.condition().terminal())
            }
            Friction::Slides(direction) => {
                let along = move |sample: &Sample<&L>| slid(closed, f, direction, sample);
                // One that begins within the round-off of zero may turn at once.
                let margin = margin(system, state, [least_speed(), zero], along)?;
                let event = system.event(name, move |sample| Ok(along(sample)? + margin));
                Box::new(event.falling().terminal())
            }
        };
        events.push((event, LegCondition::of_friction((closed, f), &decided.states, state)?));
    }
    Ok(events)
}

/// The largest force of contact or friction.
fn largest<L: Contacts<Scalar: Real>>(SolutionOf::<L> { multipliers, .. }: &SolutionOf<L>) -> L::Scalar {
    let frictions = L::FRICTIONS.iter().flat_map(FrictionRows::rows);
    let rows = L::CONTACTS.iter().copied().chain(frictions);
    rows.fold(L::Scalar::constant(0.0), |size, row| larger(size, Scalar::abs(multipliers[row])))
}

/// A number whose square is the least one: it gives a sign to what begins at zero and has no size.
fn least_speed<T: Real>() -> T {
    Scalar::sqrt(T::constant(T::SMALLEST)) * T::constant(ACCUMULATED)
}

/// Limit of friction at rest, its force at the start of a leg, and the round-off of both. Fails if the force exceeds the limit by more than
/// that, and than what the decision leaves of the largest force.
fn check_held<L: Contacts<Scalar: Real> + Clone>(
    system: &L,
    (closed, f): (&L, usize),
    state: &StateOf<L>,
) -> Result<[L::Scalar; 3], Error> {
    let solution = system.solve(state)?;
    let [limit, force] = held(closed, f, state, &solution)?;
    let sizes = limit + force + applied(closed, f, state);
    let round_off = L::Scalar::constant(L::Scalar::EPSILON * ACCUMULATED) * sizes;
    if force - limit > larger(round_off, L::Scalar::constant(BEYOND) * largest::<L>(&solution)) {
        let friction = name(L::CONSTRAINTS, L::FRICTIONS[f].row);
        return Err(Error::FrictionUndecided { friction, time: state.t.to_f64() });
    }
    Ok([limit, force, round_off])
}

/// Returns the friction that would balance the force on one coordinate alone, for the coordinate where it is largest. Its round-off is
/// that of the friction.
fn applied<L: Contacts<Scalar: Real> + Clone>(closed: &L, f: usize, state: &StateOf<L>) -> L::Scalar {
    let (forces, rows) = (closed.forcing(state), closed.constraint_jacobian(state));
    let zero = L::Scalar::constant(0.0);
    let along = |a: usize, i: usize| match rows[(a, i)] == zero {
        true => zero,
        false => Scalar::abs(forces[i] / rows[(a, i)]),
    };
    let each = L::FRICTIONS[f].rows().flat_map(|a| (0..<L::N>::COUNT).map(move |i| along(a, i)));
    each.fold(zero, larger)
}

/// Limit of friction that sticks, and its force.
pub(crate) fn held<L: Contacts<Scalar: Real> + Clone>(
    closed: &L,
    f: usize,
    state: &StateOf<L>,
    SolutionOf::<L> { multipliers, .. }: &SolutionOf<L>,
) -> Result<[L::Scalar; 2], Error> {
    let [limit, _] = bounds(closed, f, state)?;
    let press = L::FRICTIONS[f].contact.map_or(L::Scalar::constant(1.0), |k| multipliers[L::CONTACTS[k]]);
    Ok([limit * press, L::FRICTIONS[f].size(|a| multipliers[a])])
}

/// Velocity of friction that slides along its direction. That of two velocities has turned by 60° where this is zero, before
/// its force changes its sign.
fn slid<L: Contacts<Scalar: Real> + Clone>(
    closed: &L,
    f: usize,
    direction: [f64; 2],
    sample: &Sample<&L>,
) -> Result<L::Scalar, Error> {
    let FrictionRows { row, count, .. } = L::FRICTIONS[f];
    bounds(closed, f, sample.state())?;
    let rates = closed.constraint_rate(sample.state());
    let zero = L::Scalar::constant(0.0);
    let [along, square] = (0..count).fold([zero; 2], |[along, square], c| {
        [along + L::Scalar::constant(direction[c]) * rates[row + c], square + rates[row + c] * rates[row + c]]
    });
    let half = L::Scalar::constant(0.5);
    Ok(if count == 1 { along } else { along - half * Scalar::sqrt(square) })
}

/// How far below zero a gap, a force or a velocity that begins at zero must fall to be an event, since it has no sign at the start:
/// four times its round-off, and at least `least`. For a force this is at most a part [`BEYOND`] of the largest force, `size`, unless
/// all of that is round-off. Zero for what begins above.
fn margin<L: Lagrangian<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
    [least, size]: [L::Scalar; 2],
    function: impl Fn(&Sample<&L>) -> Result<L::Scalar, Error> + Copy,
) -> Result<L::Scalar, Error> {
    let noise = noise(&system.event("", function), system, state)?;
    let round_off = larger(L::Scalar::constant(SUM) * noise, least);
    let most = L::Scalar::constant(BEYOND) * size;
    let allowed = if round_off < size { smaller(round_off, most) } else { round_off };
    let (value, zero) = (function(&system.sample(*state))?, L::Scalar::constant(0.0));
    Ok(if value <= allowed { allowed + larger(-value, zero) } else { zero })
}
