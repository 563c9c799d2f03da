//! Results of the members of an ensemble.

use core::fmt::{self, Display, Formatter};
use std::sync::Arc;

use super::fingerprint::Fingerprint;
use super::names::ColumnNames;
use crate::error::{EnsembleError, Error};
use crate::generic::{Element, Length, State};
use crate::motion::Arrival;
use crate::number::Real;

/// Result of one member.
///
/// With the feature `serde` it is serialized as its [row](super::MemberRow).
#[derive(Clone, Debug, PartialEq)]
pub struct Member<T: Element, N: Length> {
    /// Index of the member in the ensemble.
    pub index: usize,
    /// Hashes of the member's run, start and parameters.
    pub fingerprint: Fingerprint,
    pub(super) names: Arc<ColumnNames>,
    /// End of the motion: its last state and the reason why it ended there; an error if the motion did not start.
    pub result: Result<Arrival<T, N>, Error>,
}

impl<T: Real, N: Length> Member<T, N> {
    /// End of the motion; `None` if the motion did not start.
    pub fn arrival(&self) -> Option<&Arrival<T, N>> {
        self.result.as_ref().ok()
    }

    /// True if the motion reached the requested end.
    pub fn is_complete(&self) -> bool {
        self.arrival().is_some_and(|arrival| arrival.ending.is_complete())
    }

    /// True if the motion did not start, or if it ended early and neither the observer nor a terminal event ended it.
    pub fn has_failed(&self) -> bool {
        self.arrival().is_none_or(|arrival| arrival.ending.is_failure())
    }
}

/// Prints the index and the ending: `member 17: stopped at t = 3.2: …`
impl<T: Real, N: Length> Display for Member<T, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "member {}: ", self.index)?;
        match &self.result {
            Ok(arrival) => write!(f, "{}", arrival.ending),
            Err(error) => write!(f, "{error}"),
        }
    }
}

/// Results of the finished members, in ascending order of index.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome<T: Element, N: Length> {
    pub(super) members: Vec<Member<T, N>>,
    pub(super) names: Arc<ColumnNames>,
    end: T,
    run: Fingerprint,
}

impl<T: Real, N: Length> Outcome<T, N> {
    pub(super) fn new(
        mut members: Vec<Member<T, N>>,
        names: Arc<ColumnNames>,
        (end, run): (T, Fingerprint),
    ) -> Self {
        members.sort_by_key(|member| member.index);
        Self { members, names, end, run }
    }

    /// All finished members, in ascending order of index.
    pub fn members(&self) -> &[Member<T, N>] {
        &self.members
    }

    /// The member of this index; `None` if it is not finished.
    pub fn get(&self, index: usize) -> Option<&Member<T, N>> {
        let place = self.members.binary_search_by_key(&index, |member| member.index).ok()?;
        self.members.get(place)
    }

    /// Values of the [quantity](crate::Ensemble::quantity) `name` at the samples of the member `index`. Empty for a
    /// member that is not finished or did not start.
    ///
    /// # Errors
    /// [`Error::UnknownName`].
    pub fn quantity(&self, index: usize, name: &str) -> Result<impl Iterator<Item = T> + '_, Error> {
        let values = self.get(index).and_then(Member::arrival).map_or(&[][..], |arrival| &arrival.values);
        self.names.values(name, values)
    }

    /// Indices and last states of the members that reached the end.
    pub fn completed(&self) -> impl Iterator<Item = (usize, &State<T, N>)> {
        let complete = self.members.iter().filter(|member| member.is_complete());
        complete.filter_map(|member| Some((member.index, &member.arrival()?.state)))
    }

    /// Members that failed; the `Display` of each tells the reason.
    pub fn failures(&self) -> impl Iterator<Item = &Member<T, N>> {
        self.members.iter().filter(|member| member.has_failed())
    }

    /// Combines the results of two parts of an ensemble. For a member in both, the result of `self` is kept.
    ///
    /// # Errors
    /// [`EnsembleError::Merge`] if the parts differ in system, end time, method or settings, or if a member in both has
    /// another start, other parameters, or other numbers where it reached the end or an event.
    pub fn merge(mut self, other: Self) -> Result<Self, Error> {
        if self.names.state != other.names.state {
            return Err(Error::Ensemble(EnsembleError::Merge { reason: "their coordinates differ" }));
        }
        if self.end != other.end {
            return Err(Error::Ensemble(EnsembleError::Merge {
                reason: "they were integrated to different times",
            }));
        }
        let differences = self
            .members
            .iter()
            .filter_map(|member| Some((member.fingerprint, other.get(member.index)?.fingerprint)));
        let mut differences = core::iter::once((self.run, other.run)).chain(differences);
        if let Some(reason) = differences.find_map(|(one, other)| one.difference(&other)) {
            return Err(Error::Ensemble(EnsembleError::Merge { reason }));
        }
        let contradicts = |member: &Member<T, N>| {
            other.get(member.index).is_some_and(|again| member.row().contradicts(&again.row()))
        };
        if self.members.iter().any(contradicts) {
            let reason = "a member in both has two results: other code, or a library with other roundings, was at work";
            return Err(Error::Ensemble(EnsembleError::Merge { reason }));
        }
        self.members.extend(other.members);
        self.members.sort_by_key(|member| member.index);
        self.members.dedup_by_key(|member| member.index);
        Ok(self)
    }
}
