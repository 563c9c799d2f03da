//! Members whose motions cross contacts.

use super::job::Job;
use super::outcome::Outcome;
use super::settings::Ensemble;
use crate::StateOf;
use crate::contact::Contacts;
use crate::contact::across::arrive;
use crate::error::Error;
use crate::motion::integration::progress::unless_broken;
use crate::motion::{Arrival, Method};
use crate::number::Real;
use crate::system::finite::check_finite;

impl<L: Contacts<Scalar: Real> + Clone, const HAS_DENSE_OUTPUT: bool> Ensemble<'_, L, HAS_DENSE_OUTPUT> {
    /// Integrates all members to the time `end` across their [contacts](crate::contact), one after the other on each thread, like
    /// [`integrate`](Self::integrate).
    ///
    /// Samples, events and the controller are those of a motion
    /// [across contacts](crate::MotionBuilder::with_contacts). Of transitions, nothing is kept: an event of a gap tells of impacts.
    ///
    /// ```
    /// use lagrange_core::contact::Contact;
    /// use lagrange_core::prelude::*;
    ///
    /// #[derive(Clone, Lagrangian)]
    /// #[coordinates(y)]
    /// #[lagrangian(y_dot^2/2 - g*y)]
    /// #[contact(floor: y >= 0, restitution: e)]
    /// struct Ball { g: f64, e: f64, floor: Contact }
    ///
    /// let ball = |k: usize| Ball { g: 9.81, e: 0.1 * k as f64, floor: Contact::Open };
    /// let lands = ball(0).event("lands", |sample| sample.state().q[0]).falling();
    /// let balls = Ensemble::from_fn(8, |k| (ball(k), State::at_rest([1.0]))).event(lands);
    /// let outcome = balls.integrate_with_contacts(1.0, Dop853::default())?;
    /// // With e = 0.7 it lands after √(2h/g) = 0.45, and again 2 e times that later.
    /// assert_eq!(outcome.get(7).unwrap().arrival().unwrap().crossings.len(), 1);
    /// assert!(outcome.get(0).unwrap().arrival().unwrap().state.q[0].abs() < 1e-15);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`integrate`](Self::integrate).
    pub fn integrate_with_contacts<P: Method<L> + Sync>(
        self,
        end: L::Scalar,
        method: P,
    ) -> Result<Outcome<L::Scalar, L::N>, Error> {
        method.check()?;
        let run = self.plan.fingerprint(&method, end, false);
        self.run(end, run, |job| job.across_contacts(&method))
    }
}

impl<L: Contacts<Scalar: Real> + Clone> Job<'_, L> {
    /// Integrates members across their contacts, one after the other, until none is left.
    pub(super) fn across_contacts<P: Method<L>>(&self, method: &P) {
        while let Some(index) = self.next() {
            let (system, start) = (self.make)(index);
            let fingerprint = self.run.with_start(&system, &start);
            let result = self.cross(index, &system, &start, method);
            self.report(self.member(index, fingerprint, result));
        }
    }

    fn cross<P: Method<L>>(
        &self,
        index: usize,
        system: &L,
        start: &StateOf<L>,
        method: &P,
    ) -> Result<Arrival<L::Scalar, L::N>, Error> {
        check_finite(system, start)?;
        let (plan, steering) = (&self.member_plan.samples, self.member_plan.steering(index));
        let accept = |state: &StateOf<L>, _| unless_broken(self.observe(index, state), state.t.to_f64());
        let along = (plan, self.member_plan.fresh_events(), steering);
        arrive((system, *start), self.end, method, along, Box::new(accept))
    }
}
