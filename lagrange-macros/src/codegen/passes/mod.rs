//! What is done to a schedule before it is written: the same results, up to rounding, for less work.

mod balance;
mod factors;
mod fuse;
mod guard;
mod reciprocals;
mod rewrite;
mod signs;
mod split;
#[cfg(test)]
mod tests;
mod vanishing;

use super::count::{Count, OPERATION_LIMIT};
use super::operation::{Operation, Register};
use super::schedule::Schedule;
use super::time::Time;
use crate::symbolic::{Graph, Id};
use crate::variables::Variable;

/// The passes do not make a function half as long: beyond, they are not tried.
const HOPELESS: usize = 2 * OPERATION_LIMIT;

/// A schedule with the registers of its results, and its length after each pass.
pub(super) struct Program {
    pub(super) schedule: Schedule,
    pub(super) results: Vec<Register>,
    /// What the operations were before any pass, and after each.
    pub(super) counts: Vec<(&'static str, Count)>,
}

impl Program {
    /// Computes nodes of the graph.
    pub(super) fn of(graph: &Graph, roots: &[Id]) -> Self {
        let (schedule, results) = scheduled(graph, roots);
        Self::new(schedule, results)
    }

    /// Computes derivatives along a direction, of which none that does not exist spoils another: first the numbers that
    /// do not depend on the direction, then, by these, what it makes of them.
    pub(super) fn of_changes(graph: &Graph, roots: &[Id]) -> [Self; 2] {
        let (schedule, results) = scheduled(graph, roots);
        let (schedule, results) = guard::guarded(&schedule, &results);
        let whole = Self::new(schedule, results);
        let split::TwoParts { slopes, changes } = split::split(&whole.schedule, &whole.results);
        [slopes, changes].map(|(schedule, results)| Self::unchanged(schedule, results))
    }

    /// Computes what is linear in Taylor coefficients: first the numbers that do not depend on them, then each of two lists of
    /// results by these. Tells where among the numbers those of `kept` are.
    pub(super) fn of_orders(
        schedule: Schedule,
        results: [Vec<Register>; 2],
        kept: &[Register],
    ) -> (Self, [Self; 2], Vec<Option<usize>>) {
        let whole = Self::new(schedule, [&results.concat(), kept].concat());
        let split::TwoParts { slopes: (numbers, slopes), changes: (changes, all) } =
            split::split(&whole.schedule, &whole.results);
        let (first, rest) = all.split_at(results[0].len());
        let (second, kept) = rest.split_at(results[1].len());
        let parts = [first, second].map(|results| Self::unchanged(changes.clone(), results.to_vec()));
        let place = |kept: &Register| match changes.operations[kept.index()] {
            Operation::Input(symbol) => match Variable::of(symbol) {
                Variable::Slope(place) => Some(place),
                _ => None,
            },
            _ => None,
        };
        let kept = kept.iter().map(place).collect();
        (Self::unchanged(numbers, slopes), parts, kept)
    }

    /// The results in as few operations as the passes find.
    pub(super) fn new(schedule: Schedule, results: Vec<Register>) -> Self {
        let program = Self::unchanged(schedule, results);
        if program.count().total() > HOPELESS {
            return program;
        }
        program
            .after("signs gathered", signs::gathered)
            .after("factors taken out", factors::taken_out)
            // What the first time has put together may be a factor in its turn.
            .after("and taken out again", factors::taken_out)
            .after("reciprocals shared", reciprocals::shared)
    }

    fn unchanged(schedule: Schedule, results: Vec<Register>) -> Self {
        let counts = vec![("as derived", schedule.count(&results))];
        Self { schedule, results, counts }
    }

    /// With long sums as trees, for functions that are waited for.
    pub(super) fn balanced(mut self) -> Self {
        (self.schedule, self.results) = balance::balanced(&self.schedule, &self.results);
        self
    }

    /// Without what is multiplied by zero, for functions of a state of which is known that it is one.
    pub(super) fn without_zeros(mut self) -> Self {
        (self.schedule, self.results) = vanishing::left_out(&self.schedule, &self.results);
        self
    }

    /// The same with products and sums in one operation each. That is harder to read, and for what is called all the
    /// time.
    pub(super) fn fused(mut self) -> Self {
        (self.schedule, self.results) = fuse::fused(&self.schedule, &self.results);
        self
    }

    /// How many operations are a product and a sum in one.
    pub(super) fn fusions(&self) -> usize {
        let is_fused = |operation: &Operation| {
            matches!(operation, Operation::MultiplyAdd(..) | Operation::SubtractProduct(..))
        };
        let uses = self.schedule.uses(&self.results);
        self.schedule
            .operations
            .iter()
            .zip(uses)
            .filter(|(operation, uses)| *uses > 0 && is_fused(operation))
            .count()
    }

    /// With another pass, unless that leaves more to do.
    fn after(
        mut self,
        name: &'static str,
        pass: fn(&Schedule, &[Register]) -> (Schedule, Vec<Register>),
    ) -> Self {
        let (schedule, results) = pass(&self.schedule, &self.results);
        if schedule.time(&results).work <= self.time().work {
            (self.schedule, self.results) = (schedule, results);
        }
        self.counts.push((name, self.schedule.count(&self.results)));
        self
    }

    pub(super) fn count(&self) -> Count {
        self.schedule.count(&self.results)
    }

    pub(super) fn time(&self) -> Time {
        self.schedule.time(&self.results)
    }
}

/// What computing `root` takes as it is, if that is far too much.
pub(super) fn hopeless(graph: &Graph, root: Id) -> Option<Count> {
    let (schedule, results) = scheduled(graph, &[root]);
    Some(schedule.count(&results)).filter(|count| count.total() > HOPELESS)
}

fn scheduled(graph: &Graph, roots: &[Id]) -> (Schedule, Vec<Register>) {
    let schedule = Schedule::new(graph, roots);
    let results = roots.iter().map(|&root| schedule.register(root)).collect();
    (schedule, results)
}
