//! Parts of an ensemble for the ranks of MPI.

use std::collections::BTreeSet;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use super::{Job, Ledger, Part};
use crate::Lagrangian;
use crate::ensemble::fingerprint::Fingerprint;
use crate::ensemble::plan::MemberObserver;
use crate::number::Real;

impl<L: Lagrangian<Scalar: Real>> Job<'_, L> {
    /// Creates a job that integrates only the members of `list`, with its own work queue and results. Rank 0
    /// [reports](Self::report) the results of all batches to its job of the whole ensemble.
    pub(in crate::ensemble) fn batch(&self, list: Vec<usize>) -> Job<'_, L> {
        let observer = self.observer.as_ref().map(|observe| {
            let observer: MemberObserver<'_, L> = Box::new(observe);
            observer
        });
        let ledger = Mutex::new(Ledger { members: Vec::new(), of: list.len(), watch: None });
        Job {
            make: Box::new(&self.make),
            observer,
            member_plan: self.member_plan.clone(),
            names: self.names.clone(),
            end: self.end,
            run: self.run,
            part: Part { count: self.part.count, shard: 0, shards: 1, list: Some(list) },
            done: BTreeSet::new(),
            given: AtomicUsize::new(0),
            stopped: AtomicBool::new(false),
            ledger,
        }
    }

    /// Hashes and counts that must agree on all ranks of MPI.
    pub(in crate::ensemble) fn identity(&self) -> [u64; 3] {
        let Fingerprint { system, run, .. } = self.run;
        [u64::from(system) << 32 | u64::from(run), self.part.count as u64, self.part.len() as u64]
    }

    /// Number of members not yet handed out, including members taken over from an earlier run.
    pub(in crate::ensemble) fn left(&self) -> usize {
        self.part.len().saturating_sub(self.given.load(Ordering::Relaxed))
    }

    /// Names of the events.
    pub(in crate::ensemble) fn events(&self) -> Vec<&'static str> {
        self.member_plan.events()
    }
}
