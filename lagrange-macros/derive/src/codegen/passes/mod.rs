//! Optimization passes on schedules: fewer operations for the same results, up to rounding.

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
use super::slopes::SlopeBlock;
use super::time::Time;
use crate::symbolic::{Graph, Id};
use crate::variables::Variable;

/// Maximum number of operations of a function that is optimized. The passes do not halve a function, so a
/// longer one would exceed the limit anyway.
const HOPELESS: usize = 2 * OPERATION_LIMIT;

/// Schedule with the registers of its results, and its operation count after each pass.
pub(super) struct Program {
    pub(super) schedule: Schedule,
    pub(super) results: Vec<Register>,
    /// Gradients that follow the results of a program of slopes.
    pub(super) blocks: Vec<SlopeBlock>,
    /// Operation counts, as derived and after each pass.
    pub(super) counts: Vec<(&'static str, Count)>,
}

impl Program {
    /// Compiles nodes of the graph.
    pub(super) fn of(graph: &Graph, roots: &[Id]) -> Self {
        let (schedule, results) = scheduled(graph, roots);
        Self::new(schedule, results)
    }

    /// Compiles directional derivatives to two programs. The first computes the numbers that do not depend on the
    /// direction, the second applies them to a direction. A derivative that does not exist does not spoil the others,
    /// where `residual`, which is differentiated, is finite.
    pub(super) fn of_changes(graph: &Graph, roots: &[Id], residual: &[Id]) -> [Self; 2] {
        let (schedule, registers) = scheduled(graph, &[roots, residual].concat());
        let (results, residual) = registers.split_at(roots.len());
        let (schedule, results) = guard::guarded(&schedule, results, residual);
        let whole = Self::new(schedule, results);
        let split::TwoParts { slopes, changes, blocks } = split::split(&whole.schedule, &whole.results);
        let [slopes, changes] =
            [slopes, changes].map(|(schedule, results)| Self::unchanged(schedule, results).fused());
        [Self { blocks, ..slopes }, changes]
    }

    /// Compiles functions that are linear in Taylor coefficients. The first program computes the numbers that do not
    /// depend on the coefficients; the other two read them and compute one list of results each. Also returns the
    /// index of each of `kept` among the numbers.
    pub(super) fn of_orders(
        schedule: Schedule,
        results: [Vec<Register>; 2],
        kept: &[Register],
    ) -> (Self, [Self; 2], Vec<Option<usize>>) {
        let whole = Self::new(schedule, [&results.concat(), kept].concat());
        let split::TwoParts { slopes: (numbers, slopes), changes: (changes, all), blocks } =
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
        (Self { blocks, ..Self::unchanged(numbers, slopes) }, parts, kept)
    }

    /// Optimizes the schedule with all passes.
    pub(super) fn new(schedule: Schedule, results: Vec<Register>) -> Self {
        let program = Self::unchanged(schedule, results);
        if program.count().total() > HOPELESS {
            return program;
        }
        program
            .after("signs gathered", signs::gathered)
            .after("factors taken out", factors::taken_out)
            // Sums combined by the first run may share factors.
            .after("and taken out again", factors::taken_out)
            .after("reciprocals shared", reciprocals::shared)
    }

    fn unchanged(schedule: Schedule, results: Vec<Register>) -> Self {
        let counts = vec![("as derived", schedule.count(&results))];
        Self { schedule, results, blocks: Vec::new(), counts }
    }

    /// Rewrites long sums as balanced trees, for functions whose latency matters.
    pub(super) fn balanced(mut self) -> Self {
        (self.schedule, self.results) = balance::balanced(&self.schedule, &self.results);
        self
    }

    /// Removes products with zero, for functions of states already known to be finite.
    pub(super) fn without_zeros(mut self) -> Self {
        (self.schedule, self.results) = vanishing::left_out(&self.schedule, &self.results);
        self
    }

    /// Fuses products and sums into single operations. The code is harder to read; use it for functions that are
    /// called all the time.
    pub(super) fn fused(mut self) -> Self {
        (self.schedule, self.results) = fuse::fused(&self.schedule, &self.results);
        self
    }

    /// Number of fused operations.
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

    /// Applies a pass, unless the result takes more work.
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

/// Returns the operation count of `root` if it exceeds [`HOPELESS`].
pub(super) fn hopeless(graph: &Graph, root: Id) -> Option<Count> {
    let (schedule, results) = scheduled(graph, &[root]);
    Some(schedule.count(&results)).filter(|count| count.total() > HOPELESS)
}

fn scheduled(graph: &Graph, roots: &[Id]) -> (Schedule, Vec<Register>) {
    let schedule = Schedule::new(graph, roots);
    let results = roots.iter().map(|&root| schedule.register(root)).collect();
    (schedule, results)
}
