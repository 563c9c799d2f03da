//! Results of the members of a batch, encoded for MPI: numbers, and the endings as text.

use std::sync::Arc;

use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, Destination, MatchedReceiveVec, Source};

use crate::ensemble::fingerprint::Fingerprint;
use crate::ensemble::names::ColumnNames;
use crate::ensemble::outcome::Member;
use crate::ensemble::table::{MemberCrossing, MemberRow, entries, entry, state_of};
use crate::number::Real;
use crate::statistics::Statistics;
use crate::system::State;
use crate::vector::Length;

/// Encodes each member as a row of a table; the names of events and quantities are known to all ranks.
#[derive(Default)]
pub(super) struct MemberMessage {
    /// Numbers of all members; integers are exact up to 2⁵³.
    numbers: Vec<f64>,
    /// Concatenated endings; `numbers` holds the length of each.
    words: String,
}

const NUMBERS: i32 = 0;
const WORDS: i32 = 1;

impl MemberMessage {
    pub(super) fn of<T: Real, N: Length>(members: &[Member<T, N>]) -> Self {
        let mut message = Self::default();
        members.iter().for_each(|member| message.pack(member));
        message
    }

    fn pack<T: Real, N: Length>(&mut self, member: &Member<T, N>) {
        let MemberRow { index, fingerprint, state, statistics, ending, samples, values, crossings, .. } =
            member.row();
        let Statistics { accepted, rejected, evaluations, multipliers_are_unique } = statistics;
        let ending = ending.to_string();
        self.words += &ending;
        self.counts([index, fingerprint.start as usize, ending.len()]);
        self.counts([accepted, rejected, evaluations, multipliers_are_unique.into(), state.is_some().into()]);
        self.counts([samples.len(), values.len(), crossings.len()]);
        state.iter().for_each(|state| self.state(state));
        samples.iter().for_each(|state| self.state(state));
        self.numbers.extend(values.iter().map(|x| x.to_f64()));
        for MemberCrossing { index, count, rising, state, .. } in &crossings {
            self.counts([*index, *count, (*rising).into()]);
            self.state(state);
        }
    }

    fn counts<const K: usize>(&mut self, counts: [usize; K]) {
        self.numbers.extend(counts.map(|count| count as f64));
    }

    fn state<T: Real, N: Length>(&mut self, state: &State<T, N>) {
        self.numbers.extend((0..entries::<N>()).map(|place| entry(state, place).to_f64()));
    }

    pub(super) fn send(&self, to: &impl Destination) {
        to.send_with_tag(&self.numbers[..], NUMBERS);
        to.send_with_tag(self.words.as_bytes(), WORDS);
    }

    /// Receives the first message that has arrived from any rank; returns that rank and the message.
    pub(super) fn arrived(world: &SimpleCommunicator) -> Option<(usize, Self)> {
        let message = world.any_process().immediate_matched_probe_with_tag(NUMBERS)?;
        let rank = message.1.source_rank();
        let (numbers, _) = message.matched_receive_vec();
        let (words, _) = world.process_at_rank(rank).receive_vec_with_tag(WORDS);
        let words = String::from_utf8_lossy(&words).into_owned();
        Some((rank.unsigned_abs() as usize, Self { numbers, words }))
    }

    /// Decodes the members. `run` is the fingerprint of the run, `events` and `names` are those of the job.
    pub(super) fn members<T: Real, N: Length>(
        &self,
        run: Fingerprint,
        events: &[&'static str],
        names: &Arc<ColumnNames>,
    ) -> impl Iterator<Item = Member<T, N>> {
        let mut rest = Rest { numbers: self.numbers.iter(), words: &self.words };
        core::iter::from_fn(move || rest.member(run, events, names))
    }
}

/// Numbers and text not yet decoded.
struct Rest<'p> {
    numbers: core::slice::Iter<'p, f64>,
    words: &'p str,
}

impl Rest<'_> {
    fn member<T: Real, N: Length>(
        &mut self,
        run: Fingerprint,
        events: &[&'static str],
        names: &Arc<ColumnNames>,
    ) -> Option<Member<T, N>> {
        let [index, start, length] = self.counts()?;
        let [accepted, rejected, evaluations, is_unique, has_motion] = self.counts()?;
        let [samples, values, crossings] = self.counts()?;
        let (ending, words) = self.words.split_at_checked(length)?;
        self.words = words;
        let state = if has_motion == 1 { Some(self.state()?) } else { None };
        let row = MemberRow {
            index,
            fingerprint: Fingerprint { start: start as u32, ..run },
            state,
            statistics: Statistics {
                accepted,
                rejected,
                evaluations,
                multipliers_are_unique: is_unique == 1,
            },
            ending: ending.into(),
            samples: (0..samples).map_while(|_| self.state()).collect(),
            values: (0..values).map_while(|_| self.number()).collect(),
            crossings: (0..crossings).map_while(|_| self.crossing(events)).collect(),
            names: names.clone(),
        };
        row.into_member(events, names).ok()
    }

    fn crossing<T: Real, N: Length>(&mut self, events: &[&'static str]) -> Option<MemberCrossing<T, N>> {
        let [index, count, rising] = self.counts()?;
        let event = (*events.get(index)?).into();
        Some(MemberCrossing { event, index, count, rising: rising == 1, state: self.state()? })
    }

    fn state<T: Real, N: Length>(&mut self) -> Option<State<T, N>> {
        state_of(|_| self.number().ok_or(())).ok()
    }

    fn number<T: Real>(&mut self) -> Option<T> {
        self.numbers.next().copied().map(T::constant)
    }

    fn counts<const K: usize>(&mut self) -> Option<[usize; K]> {
        let (counts, _) = self.numbers.as_slice().split_first_chunk::<K>()?;
        self.numbers.nth(K - 1);
        Some(counts.map(|count| count as usize))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prelude::{State, *};

    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(x_dot^2/2 - k/2 * x^2)]
    struct Spring<T> {
        k: T,
    }

    /// Endings by events, crossings and samples survive encoding and decoding; errors arrive as text.
    #[test]
    fn what_is_kept_of_members_survives_the_way() {
        let spring = |index: usize| {
            let k = if index == 4 { f64::NAN } else { index as f64 };
            (Spring { k }, State::at_rest([1.0]))
        };
        let zero = spring(0).0.event("zero", |sample| sample.state().q[0]);
        let turn = spring(0).0.event("turn", |sample| sample.state().v[0]).terminal_at(2);
        let springs = Ensemble::from_fn(9, spring).event(zero).event(turn).samples_at([0.0, 1.5, 3.0]);
        let springs = springs.quantity("speed", |sample| sample.velocity("x"));
        let outcome = springs.integrate_on_lanes(3.0, Dop853::default()).expect("an outcome");
        assert!(outcome.members().iter().any(|member| member.to_string().contains("event `turn`")));
        let run = outcome.members()[0].fingerprint;
        let message = MemberMessage::of(outcome.members());
        let members: Vec<Member<f64, nalgebra::Const<1>>> =
            message.members(run, &["zero", "turn"], &outcome.names).collect();
        assert_eq!(members.len(), 9);
        for (member, original) in members.iter().zip(outcome.members()) {
            assert_eq!(member.row(), original.row());
            assert_eq!(member.arrival(), original.arrival());
        }
    }
}
