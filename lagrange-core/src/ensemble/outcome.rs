//! What has become of the members of an ensemble.

use core::fmt::{self, Display, Formatter};

use super::fingerprint::Fingerprint;
use crate::error::{EnsembleError, Error};
use crate::motion::record::Arrival;
use crate::number::Real;
use crate::system::State;

/// What has become of one member.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(bound(serialize = "T: nalgebra::Scalar + serde::Serialize")))]
pub struct Member<T, const N: usize> {
    /// Its index in the ensemble.
    pub index: usize,
    /// Which run, start and parameters it is of.
    pub fingerprint: Fingerprint,
    /// Where its motion ended and why, or why there is none.
    pub result: Result<Arrival<T, N>, Error>,
}

impl<T: Real, const N: usize> Member<T, N> {
    /// Where its motion ended, if it has one.
    pub fn arrival(&self) -> Option<&Arrival<T, N>> {
        self.result.as_ref().ok()
    }

    /// Whether it reached the end asked for.
    pub fn is_complete(&self) -> bool {
        self.arrival().is_some_and(|arrival| arrival.ending.is_complete())
    }

    /// Whether something other than the observer kept it from the end.
    pub fn has_failed(&self) -> bool {
        self.arrival().is_none_or(|arrival| arrival.ending.is_failure())
    }
}

/// `member 17: stopped at t = 3.2: …`
impl<T: Real, const N: usize> Display for Member<T, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "member {}: ", self.index)?;
        match &self.result {
            Ok(arrival) => write!(f, "{}", arrival.ending),
            Err(error) => write!(f, "{error}"),
        }
    }
}

/// The members that are done, by index.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome<T, const N: usize> {
    pub(super) members: Vec<Member<T, N>>,
    pub(super) names: [&'static str; N],
    quantities: Vec<&'static str>,
    end: T,
    run: Fingerprint,
}

impl<T: Real, const N: usize> Outcome<T, N> {
    pub(super) fn new(
        mut members: Vec<Member<T, N>>,
        names: [&'static str; N],
        quantities: Vec<&'static str>,
        (end, run): (T, Fingerprint),
    ) -> Self {
        members.sort_by_key(|member| member.index);
        Self { members, names, quantities, end, run }
    }

    /// All members that are done, by index.
    pub fn members(&self) -> &[Member<T, N>] {
        &self.members
    }

    /// The member of this index, if it is done.
    pub fn get(&self, index: usize) -> Option<&Member<T, N>> {
        let place = self.members.binary_search_by_key(&index, |member| member.index).ok()?;
        self.members.get(place)
    }

    /// The [quantity](crate::Ensemble::quantity) of this name at the samples of the member of this index; none of one that is
    /// not done, or has no motion.
    ///
    /// # Errors
    /// [`Error::UnknownName`].
    pub fn quantity(&self, index: usize, name: &str) -> Result<impl Iterator<Item = T> + '_, Error> {
        let count = self.quantities.len();
        let place = self.quantities.iter().position(|known| *known == name).ok_or_else(|| {
            let known = self.quantities.iter().map(|known| (*known).into()).collect();
            let hint = self.quantities.is_empty().then(|| "ask for it by `Ensemble::quantity`".into());
            Error::UnknownName { name: name.into(), kind: "quantity", hint, known }
        })?;
        let values = self.get(index).and_then(Member::arrival).map_or(&[][..], |arrival| &arrival.values);
        Ok(values.iter().skip(place).step_by(count).copied())
    }

    /// The members that reached the end, with their last states.
    pub fn completed(&self) -> impl Iterator<Item = (usize, &State<T, N>)> {
        let complete = self.members.iter().filter(|member| member.is_complete());
        complete.filter_map(|member| Some((member.index, &member.arrival()?.state)))
    }

    /// The members that something kept from the end; each says by its `Display` what.
    pub fn failures(&self) -> impl Iterator<Item = &Member<T, N>> {
        self.members.iter().filter(|member| member.has_failed())
    }

    /// Puts two parts together. Of a member that is in both, this one's is kept.
    ///
    /// # Errors
    /// [`EnsembleError::Merge`] for parts of other systems, of motions to another time, with another method or other settings, and for
    /// parts in which one member has another start or other parameters.
    pub fn merge(mut self, other: Self) -> Result<Self, Error> {
        if self.names != other.names {
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
        if let Some((_, reason)) = differences.find_map(|(one, other)| one.difference(&other)) {
            return Err(Error::Ensemble(EnsembleError::Merge { reason }));
        }
        self.members.extend(other.members);
        self.members.sort_by_key(|member| member.index);
        self.members.dedup_by_key(|member| member.index);
        Ok(self)
    }
}
