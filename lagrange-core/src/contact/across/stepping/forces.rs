//! Forces of a step by the θ-method, and how they change with the velocities after it.

use alloc::vec;
use alloc::vec::Vec;

use crate::contact::across::bodies::Bodies;
use crate::contact::{Contacts, ForceDerivatives};
use crate::derivatives::tangent::WideOf;
use crate::number::{Real, Scalar, Wide};
use crate::system::{Direction, StateOf};
use crate::vector::{Entrywise, StaticLength, Vector};

/// Forces h f(t + θ h, q⁻ + θ h v, v) of a step of length h at the velocities v = v⁻ + θ (v⁺ − v⁻).
pub(super) struct ThetaForces<L: Contacts<Scalar: Real>> {
    from: StateOf<L>,
    step: L::Scalar,
    theta: L::Scalar,
}

/// What forces change with the velocities after a step, without the part of it that is skew.
pub(super) struct ImplicitForces {
    /// Entries of θ h C + θ² h² K, which are added to the mass matrix.
    pub(super) added: Vec<(usize, usize, f64)>,
    /// Sizes of the terms of h f.
    pub(super) sizes: Vec<f64>,
}

impl<L: ForceDerivatives<Scalar: Real> + Clone> ThetaForces<L> {
    pub(super) fn new(from: &StateOf<L>, step: L::Scalar, theta: f64) -> Self {
        Self { from: *from, step, theta: L::Scalar::constant(theta) }
    }

    /// The state at which forces are taken.
    fn state(&self, after: &Vector<L::Scalar, L::N>) -> StateOf<L> {
        let Self { from, step, theta } = self;
        let (time, theta) = (*step * *theta, *theta);
        let v = from.v.each_with(after, |before, after| before + theta * (after - before));
        StateOf::<L> { t: from.t + time, q: from.q.plus(&v.each(|v| v * time)), v }
    }

    /// h f.
    pub(super) fn impulse(&self, bodies: &Bodies<L>, after: &Vector<L::Scalar, L::N>) -> Vec<f64> {
        let forcing = bodies.open.forcing(&self.state(after));
        forcing.iter().map(|force| (*force * self.step).to_f64()).collect()
    }

    /// How the forces change with the velocities after the step, about those before it.
    pub(super) fn linearize(&self, bodies: &Bodies<L>) -> ImplicitForces {
        let (n, state) = (<L::N>::COUNT, self.state(&self.from.v));
        let [step, theta] = [self.step, self.theta].map(Real::to_f64);
        let largest = bodies.sizes(&state);
        let (mut added, mut sizes) = (Vec::new(), vec![0.0; n]);
        let arguments = &L::FORCE_ARGUMENTS[usize::from(L::FORCE_ARGUMENTS.first() == Some(&0))..];
        if arguments.is_empty() {
            return ImplicitForces { added, sizes };
        }
        let slopes = bodies.open.force_slopes(&state);
        for block in arguments.chunks(WideOf::<L>::COUNT) {
            let direction = Direction::of_arguments::<L::Scalar>(block.iter().copied());
            let change: Vector<WideOf<L>, L::N> = bodies.open.force_change_with(&slopes, &direction);
            for (lane, &argument) in block.iter().enumerate() {
                let k = (argument - 1) % n;
                let (factor, size) = match argument <= n {
                    true => (theta * theta * step * step, largest.q[k]),
                    false => (theta * step, largest.v[k]),
                };
                for (i, size_of) in sizes.iter_mut().enumerate() {
                    let entry = -change[i].lane(lane).to_f64();
                    if entry != 0.0 {
                        *size_of += step * (entry * size.to_f64()).abs();
                        let half = factor * entry / 2.0;
                        added.extend([(i, k, half), (k, i, half)]);
                    }
                }
            }
        }
        ImplicitForces { added, sizes }
    }
}
