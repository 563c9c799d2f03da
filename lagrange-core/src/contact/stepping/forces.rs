//! Forces of a step by the θ-method, and how they change with the velocities after it.

use alloc::vec;
use alloc::vec::Vec;

use crate::contact::Contacts;
use crate::contact::bodies::Bodies;
use crate::linearized::{StateDerivatives, WideOf};
use crate::number::{Real, Scalar, Wide};
use crate::system::{Solution, StateOf};
use crate::vector::{Entrywise, Length, Vector, zeros};

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

impl<L: Contacts<Scalar: Real> + StateDerivatives + Clone> ThetaForces<L> {
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
        let (accelerations, multipliers, pivot) = (zeros(), zeros(), L::Scalar::constant(1.0));
        let none = Solution { accelerations, multipliers, pivot, rank: 0 };
        let [step, theta] = [self.step, self.theta].map(Real::to_f64);
        let largest = bodies.sizes(&state);
        let (mut added, mut sizes) = (Vec::new(), vec![0.0; n]);
        let all: Vec<usize>;
        let arguments = match L::FORCE_ARGUMENTS {
            Some(arguments) => arguments,
            None => {
                all = (1..=2 * n).collect();
                &all
            }
        };
        let arguments = &arguments[usize::from(arguments.first() == Some(&0))..];
        if arguments.is_empty() {
            return ImplicitForces { added, sizes };
        }
        let slopes = bodies.open.residual_slopes(&state, &none);
        for block in arguments.chunks(WideOf::<L>::COUNT) {
            let change = bodies.open.residual_change_by::<WideOf<L>>(&slopes, block.iter().copied());
            for (lane, &argument) in block.iter().enumerate() {
                let k = (argument - 1) % n;
                let (factor, size) = match argument <= n {
                    true => (theta * theta * step * step, largest.q[k]),
                    false => (theta * step, largest.v[k]),
                };
                for (i, size_of) in sizes.iter_mut().enumerate() {
                    let entry = change.motion[i].lane(lane).to_f64();
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
