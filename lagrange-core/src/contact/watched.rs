//! The events that end a leg: gaps that close, forces that come to zero or to their limit, and velocities that stop or turn.

use alloc::boxed::Box;
use alloc::vec::Vec;

use super::bodies::Bodies;
use super::condition::LegCondition;
use super::friction::bounds;
use super::instant::Decided;
use super::last_value::LastValue;
use super::lifting::Lifting;
use super::{Contacts, Friction, FrictionRows};
use crate::error::Error;
use crate::motion::event::noise;
use crate::motion::{DynEvent, Simulate};
use crate::names::name;
use crate::number::{Real, Scalar, larger};
use crate::solution::Sample;
use crate::system::{Lagrangian, SolutionOf, StateOf};
use crate::vector::{Length, Vector};

/// An event, with the condition that it watches.
pub(super) type ConditionEvent<'w, L> = (Box<DynEvent<'w, L>>, LegCondition<<L as Lagrangian>::Scalar>);

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
    let watches = |(k, &row): (usize, &usize)| {
        let (name, is_resting) = (name(L::CONSTRAINTS, row), decided.is_resting[k]);
        if decided.states.is_closed[k] {
            let force = move |sample: &Sample<&L>| Ok(shared.solution(sample)?.multipliers[row]);
            check_push(system, state, name, force)?;
            // One that begins at zero has no sign before, and may have no round-off of its own.
            let rest = if is_resting { Some(round_off::<L>(&system.solve(state)?)) } else { None };
            return Ok((watched(system, state, name, rest, force)?, LegCondition::Pushes { row }));
        }
        let gap = move |sample: &Sample<&L>| shared.gap(row, sample);
        let event = match is_resting {
            false => watched(system, state, name, None, gap)?,
            true => {
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
                watched(system, state, name, Some(bodies.touching(k, state) + least_speed()), gap)?
            }
        };
        Ok((event, LegCondition::Motion))
    };
    let contacts = L::CONTACTS.iter().enumerate().filter(|(k, _)| !decided.is_implied[*k]);
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
    let zero = L::Scalar::constant(0.0);
    if push >= zero {
        return Ok(());
    }
    let multipliers = sample.solution()?.multipliers;
    let largest = L::CONTACTS.iter().fold(zero, |size, &row| larger(size, Scalar::abs(multipliers[row])));
    let noise = noise(&system.event(name, force), system, state)?;
    let allowed = L::Scalar::constant(BEYOND) * largest + L::Scalar::constant(AT_LIMIT) * noise;
    if push < -allowed {
        return Err(Error::FrictionUndecided { friction: name, time: state.t.to_f64() });
    }
    Ok(())
}

/// Distance of a force from its limit, in units of round-off of both, within which it is watched for leaving it.
const AT_LIMIT: f64 = 64.0;

/// Part of its terms by which a force may exceed the limit of friction that is to stick, or pull. The solver of dependent
/// contacts shares forces by their least norm, which need not be within the limits.
pub(super) const BEYOND: f64 = 1e-6;

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
    let (closed, mut events) = (shared.closed, Vec::new());
    for (f, &FrictionRows { row, contact, .. }) in L::FRICTIONS.iter().enumerate() {
        if contact.is_some_and(|k| !decided.states.is_closed[k]) || decided.slip_is_implied[f] {
            continue;
        }
        let name = name(L::CONSTRAINTS, row);
        let event = match decided.states.frictions[f] {
            Friction::Sticks | Friction::Shares(_) => {
                let left = move |sample: &Sample<&L>| {
                    let [limit, force] = held(closed, f, sample.state(), &shared.solution(sample)?)?;
                    Ok(limit - force)
                };
                // A force that begins at its limit has no sign before, and may have no round-off.
                let solution = system.solve(state)?;
                let [limit, force] = held(closed, f, state, &solution)?;
                let least = L::Scalar::constant(L::Scalar::EPSILON * AT_LIMIT) * (limit + force);
                if force - limit > L::Scalar::constant(BEYOND) * (limit + force) + round_off::<L>(&solution) {
                    return Err(Error::FrictionUndecided { friction: name, time: state.t.to_f64() });
                }
                watched(system, state, name, Some(least + least_speed::<L::Scalar>()), left)?
            }
            Friction::Slides(direction) => {
                let along = move |sample: &Sample<&L>| slid(closed, f, direction, sample);
                // One that begins within the round-off of zero may turn at once.
                watched(system, state, name, Some(least_speed()), along)?
            }
        };
        events.push((event, LegCondition::of_friction((closed, f), &decided.states, state)?));
    }
    Ok(events)
}

/// What round-off leaves of a force of contact or friction beside the largest of them.
pub(super) fn round_off<L: Contacts<Scalar: Real>>(
    SolutionOf::<L> { multipliers, .. }: &SolutionOf<L>,
) -> L::Scalar {
    let frictions = L::FRICTIONS.iter().flat_map(|friction| friction.row..friction.row + friction.count);
    let rows = L::CONTACTS.iter().copied().chain(frictions);
    let largest =
        rows.fold(L::Scalar::constant(0.0), |size, row| larger(size, Scalar::abs(multipliers[row])));
    L::Scalar::constant(L::Scalar::EPSILON * AT_LIMIT) * largest
}

/// A number whose square is the least one: it gives a sign to what begins at zero and has no size.
fn least_speed<T: Real>() -> T {
    Scalar::sqrt(T::constant(T::SMALLEST)) * T::constant(AT_LIMIT)
}

/// Limit of friction that sticks, and its force.
pub(super) fn held<L: Contacts<Scalar: Real> + Clone>(
    closed: &L,
    f: usize,
    state: &StateOf<L>,
    SolutionOf::<L> { multipliers, .. }: &SolutionOf<L>,
) -> Result<[L::Scalar; 2], Error> {
    let FrictionRows { row, count, contact, .. } = L::FRICTIONS[f];
    let [limit, _] = bounds(closed, f, state)?;
    let press = contact.map_or(L::Scalar::constant(1.0), |k| multipliers[L::CONTACTS[k]]);
    let force = match count {
        1 => Scalar::abs(multipliers[row]),
        _ => {
            let [x, y] = [multipliers[row], multipliers[row + 1]];
            Scalar::sqrt(x * x + y * y)
        }
    };
    Ok([limit * press, force])
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

/// The event that a gap or a multiplier becomes negative. If it rests at zero, it may do so at once, without a sign before: it
/// is then watched for exceeding four times its round-off, and the least that `rest` gives.
fn watched<'w, L>(
    system: &L,
    state: &StateOf<L>,
    name: &'static str,
    rest: Option<L::Scalar>,
    function: impl Fn(&Sample<&L>) -> Result<L::Scalar, Error> + Copy + 'w,
) -> Result<Box<DynEvent<'w, L>>, Error>
where
    L: Lagrangian<Scalar: Real> + 'w,
{
    let zero = L::Scalar::constant(0.0);
    let mut margin = zero;
    if let Some(least) = rest {
        let noise = noise(&system.event(name, function), system, state)?;
        let allowed = larger(L::Scalar::constant(4.0) * noise, least);
        let value = function(&system.sample(*state))?;
        if value <= allowed {
            margin = allowed + larger(-value, zero);
        }
    }
    let event = system.event(name, move |sample| Ok(function(sample)? + margin));
    Ok(Box::new(event.falling().terminal()))
}
