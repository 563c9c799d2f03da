//! Drift of conserved quantities along a trajectory, and of the balance of an energy that changes.

use alloc::vec::Vec;
use core::fmt::{self, Display, Formatter};

use super::leg::Leg;
use super::stored::{Trajectory, between};
use crate::error::Error;
use crate::number::{Real, Scalar, exceeds};
use crate::solution::Sample;
use crate::solution::energy_field::EnergyField;
use crate::solution::vector_field::VectorField;
use crate::system::{Lagrangian, System};
use crate::vector::{StaticLength, zeros};

/// Nodes in a step and weights of Gauss's formula of order 16 (Abramowitz and Stegun, table 25.4). In the long steps of
/// `Taylor` a formula of order 8 leaves errors 10⁶ times those of the motion
/// (6·10⁻¹⁰ instead of 6·10⁻¹⁶ for a driven oscillator).
const GAUSS: [(f64, f64); 8] = [
    (0.019_855_071_751_231_884, 0.050_614_268_145_188_13),
    (0.101_666_761_293_186_64, 0.111_190_517_226_687_24),
    (0.237_233_795_041_835_5, 0.156_853_322_938_943_63),
    (0.408_282_678_752_175_1, 0.181_341_891_689_181),
    (0.591_717_321_247_825, 0.181_341_891_689_181),
    (0.762_766_204_958_164_5, 0.156_853_322_938_943_63),
    (0.898_333_238_706_813_4, 0.111_190_517_226_687_24),
    (0.980_144_928_248_768_1, 0.050_614_268_145_188_13),
];

/// Name of the balance of the energy among the deviations.
const BALANCE: &str = "energy - work";

/// Largest deviation of a conserved quantity from its initial value.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Deviation<T> {
    /// Name of the quantity in [`Facts::conserved`](crate::facts::Facts::conserved), or `energy - work`.
    pub name: &'static str,
    /// Value at the start of the trajectory.
    pub start: T,
    /// Largest deviation from the initial value over all steps.
    pub largest: T,
}

/// Deviations of every conserved quantity of a system along a trajectory.
///
/// An energy that is not conserved, or only while nothing hits and slides, is balanced: `energy - work` is E − ∫ dE/dt dt, with the rate
/// [`energy_rate`](Lagrangian::energy_rate) of forces, moving constraints and a Lagrangian that changes with time. The integral
/// is that of Gauss's formula of order 16 over each step, on the dense output. Its error comes to that of the motion; a
/// deviation far above the tolerance tells of an inaccurate motion, or of a rate that changes abruptly within a step.
/// ```
/// use lagrange_core::prelude::*;
///
/// #[derive(Lagrangian)]
/// #[coordinates(r, phi)]
/// #[lagrangian(m/2 * (r_dot^2 + r^2 * phi_dot^2) + k/r)]
/// struct Planet { m: f64, k: f64 }
///
/// let planet = Planet { m: 1.0, k: 1.0 };
/// let path = planet.integrate(State::new([1.0, 0.0], [0.0, 1.2]), 10.0, Dop853::with_tolerance(1e-12))?;
/// let drift = path.drift();
/// println!("{drift}");
/// let names: Vec<&str> = drift.iter().map(|quantity| quantity.name).collect();
/// assert_eq!(names, ["p_phi", "energy"]);
/// assert!(drift.iter().all(|quantity| quantity.largest < 1e-10));
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(transparent))]
pub struct Drift<T> {
    quantities: Vec<Deviation<T>>,
}

impl<S: System<Scalar: Real>, F: VectorField<S>> Trajectory<S, F> {
    /// Returns the largest deviation of each conserved quantity from its initial value, and that of the balance of an energy
    /// that is not conserved, or only while nothing hits and slides. What impacts take is left out; in time steps it is work of impulses.
    pub fn drift(&self) -> Drift<S::Scalar>
    where
        F::Checks: EnergyField<S>,
    {
        let mut drift = Drift::of::<_, F::Checks>(self.legs().iter().flat_map(Leg::samples_of_steps));
        drift.quantities.extend(F::Checks::balance(self.legs()));
        drift
    }
}

/// Balance of the energy along these legs. What it changes from one to the next, as at an impact, is left out.
pub(crate) fn balance<S: Lagrangian<Scalar: Real>, F: VectorField<S>>(
    legs: &[Leg<S, F>],
) -> Option<Deviation<S::Scalar>> {
    let (first, zero) = (legs.first()?, S::Scalar::constant(0.0));
    let start = first.system.energy(&first.path.start);
    let mut balance = Deviation { name: BALANCE, start, largest: zero };
    legs.iter().fold(zero, |left, leg| leg.balance(left, &mut balance));
    Some(balance)
}

impl<S: Lagrangian<Scalar: Real>, F: VectorField<S>> Leg<S, F> {
    /// Adds E − ∫ dE/dt dt − `start` at each step to the largest deviation, and returns the last; NaN if a state or its
    /// multipliers have an error.
    fn balance(&self, start: S::Scalar, balance: &mut Deviation<S::Scalar>) -> S::Scalar {
        let (mut left, mut from) = (start, self.path.start.t);
        let mut before = self.system.energy(&self.path.start);
        for step in self.samples_of_steps().skip(1) {
            let energy = step.energy();
            left += energy - before - self.work(from, step.time()).unwrap_or(S::Scalar::constant(f64::NAN));
            balance.largest = farther(balance.largest, left);
            (from, before) = (step.time(), energy);
        }
        left
    }

    /// ∫ dE/dt dt between two times.
    fn work(&self, from: S::Scalar, to: S::Scalar) -> Result<S::Scalar, Error> {
        GAUSS.iter().try_fold(S::Scalar::constant(0.0), |sum, (node, weight)| {
            let sample = self.sample_at(between(from, to, *node))?;
            let rate = match <S::M>::COUNT {
                0 => self.system.energy_rate(sample.state(), &zeros()),
                _ => sample.energy_rate()?,
            };
            Ok(sum + rate * (to - from) * S::Scalar::constant(*weight))
        })
    }
}

impl<T: Real> Drift<T> {
    /// The largest deviations from the first of these samples.
    fn of<'s, S, F>(mut steps: impl Iterator<Item = Sample<&'s S>>) -> Self
    where
        S: System<Scalar = T> + 's,
        F: EnergyField<S>,
    {
        // One pass for all quantities: in (q, p) every state requires a search for the velocity.
        let start = steps.next().into_iter().flat_map(|start| {
            let conserved = F::CONSERVED.iter().enumerate();
            conserved.filter_map(move |(index, conserved)| {
                let (name, start) = (conserved.name, F::conserved(start.system(), index, start.state())?);
                Some((index, Deviation { name, start, largest: T::constant(0.0) }))
            })
        });
        let mut quantities: Vec<_> = start.collect();
        for step in steps {
            for (index, Deviation { start, largest, .. }) in &mut quantities {
                if let Some(value) = F::conserved(step.system(), *index, step.state()) {
                    *largest = farther(*largest, value - *start);
                }
            }
        }
        Self { quantities: quantities.into_iter().map(|(_, deviation)| deviation).collect() }
    }

    /// Iterates over the quantities in the order of [`Facts::conserved`](crate::facts::Facts::conserved).
    pub fn iter(&self) -> core::slice::Iter<'_, Deviation<T>> {
        self.quantities.iter()
    }

    /// Returns the quantity of this name, or `None` if there is none.
    pub fn get(&self, name: &str) -> Option<&Deviation<T>> {
        self.iter().find(|quantity| quantity.name == name)
    }
}

/// Returns the larger distance; once a distance is NaN, the result stays NaN.
fn farther<T: Real>(largest: T, difference: T) -> T {
    let distance = Scalar::abs(difference);
    let is_number = largest.partial_cmp(&largest).is_some();
    if is_number && exceeds(distance, largest) { distance } else { largest }
}

impl<'d, T> IntoIterator for &'d Drift<T> {
    type Item = &'d Deviation<T>;
    type IntoIter = core::slice::Iter<'d, Deviation<T>>;

    fn into_iter(self) -> Self::IntoIter {
        self.quantities.iter()
    }
}

impl<T: Real> Display for Drift<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let width = self.iter().map(|quantity| quantity.name.chars().count()).max().unwrap_or(0).max(9);
        writeln!(f, "{:width$}  {:>13}  {:>17}", "conserved", "at the start", "largest deviation")?;
        for Deviation { name, start, largest } in self {
            writeln!(f, "{name:width$}  {:>13.6e}  {:>17.1e}", start.to_f64(), largest.to_f64())?;
        }
        Ok(())
    }
}
