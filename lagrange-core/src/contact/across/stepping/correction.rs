//! Corrections of a position at the end of a step, to where no gap is negative and the constraints hold.

use alloc::vec;
use alloc::vec::Vec;

use super::middle::Middle;
use crate::cone::Set;
use crate::contact::ForceDerivatives;
use crate::contact::across::bodies::Bodies;
use crate::contact::across::reactions::ReactionProblem;
use crate::error::Error;
use crate::names::{Row, name};
use crate::number::Real;
use crate::number::limits::ITERATIONS;
use crate::system::StateOf;
use crate::vector::{Entrywise, StaticLength};

impl<L: ForceDerivatives<Scalar: Real> + Clone> Middle<L> {
    /// Moves a state by Gauss–Newton steps in the metric of the mass matrix. Velocities stay.
    pub(super) fn correct(&self, bodies: &Bodies<L>, state: &mut StateOf<L>) -> Result<(), Error> {
        for _ in 0..ITERATIONS {
            if self.violation(bodies, state, &self.touching).is_none() {
                return Ok(());
            }
            self.correct_once(bodies, state)?;
        }
        self.violation(bodies, state, &self.touching).map_or(Ok(()), Err)
    }

    /// Checks the position of a start. What it lacks is corrected in the first step.
    pub(super) fn check(&self, bodies: &Bodies<L>, state: &StateOf<L>) -> Result<(), Error> {
        self.violation(bodies, state, &self.started).map_or(Ok(()), Err)
    }

    /// The first gap that is negative, or constraint that does not hold, by more than allowed.
    fn violation(&self, bodies: &Bodies<L>, state: &StateOf<L>, allowed: &[f64]) -> Option<Error> {
        let (gaps, residual, time) = (
            bodies.closed.constraint_residual(state),
            bodies.open.constraint_residual(state),
            state.t.to_f64(),
        );
        if let Some(&row) = L::CONTACTS.iter().find(|&&row| gaps[row].to_f64() < -allowed[row]) {
            let contact = name(L::CONSTRAINTS, row);
            return Some(Error::Penetration { contact, gap: gaps[row].to_f64(), time });
        }
        let off = (0..<L::M>::COUNT).find(|&a| residual[a].to_f64().abs() > allowed[a])?;
        let (constraint, residual) = (Row::Constraint(name(L::CONSTRAINTS, off)), residual[off].to_f64());
        Some(Error::NotProjected { constraint, residual, iterations: ITERATIONS, time })
    }

    fn correct_once(&self, bodies: &Bodies<L>, state: &mut StateOf<L>) -> Result<(), Error> {
        let (gaps, residual) =
            (bodies.closed.constraint_residual(state), bodies.open.constraint_residual(state));
        let near = |k: usize| {
            let row = L::CONTACTS[k];
            self.acts(k) || gaps[row].to_f64() <= self.touching[row]
        };
        let rows = bodies.rows((0..L::CONTACTS.len()).filter(|&k| near(k)).collect(), state)?;
        let of = |(place, &a): (usize, &usize)| if place < rows.count { gaps[a] } else { residual[a] };
        let values: Vec<f64> = rows.all.iter().enumerate().map(of).map(Real::to_f64).collect();
        let noise = vec![0.0; values.len()];
        let mut problem = ReactionProblem::new(&rows, values, &noise);
        for gap in 0..rows.touching.len() {
            problem.push(gap..gap + 1, Set::HalfLine);
        }
        let found = problem.decide().map_err(|_| bodies.contradiction(&rows.touching, state))?;
        state.q = state.q.plus(&rows.velocities(&found.change));
        Ok(())
    }
}
