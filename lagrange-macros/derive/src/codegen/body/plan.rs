//! Plans a [`FunctionBody`] from a schedule, chunk by chunk.

mod angles;
mod planner;
mod rounds;

use std::collections::BTreeSet;
use std::ops::Range;

use rustc_hash::FxHashMap;

use super::FunctionBody;
use super::chunks::{self, OperationRange};
use super::order_of_evaluation::Order;
use super::repeats::repeats;
use crate::codegen::operation::{Operation, Register};
use crate::codegen::passes::Program;
use crate::codegen::schedule::Schedule;
use crate::symbolic::Id;
use angles::plain_angles;
use planner::Planner;

/// Minimum number of results for which a function does not store zeros, if more than half of its results are
/// zero.
const MANY: usize = 256;

impl FunctionBody {
    /// Plans the computation of the results of a program. Named definitions become locals of the same name.
    pub(in crate::codegen) fn new(program: &Program, names: &FxHashMap<Id, String>) -> Self {
        let Program { schedule, results, .. } = program;
        let order = Order::new(program);
        let peaks = [order.peak_before, order.peak()];
        let (order, segments) = segments(schedule, order);
        let ranges: Vec<Range<usize>> = segments.iter().map(|segment| segment.range.clone()).collect();
        let plain = plain_angles(schedule, &order.sequence, &ranges);
        let mut planner = Planner::new(program, &order.sequence, &ranges, names, plain);
        let zero = schedule.find(Operation::Constant(0.0_f64.to_bits()));
        let stored = results.iter().copied().enumerate().filter(|(_, result)| Some(*result) != zero);
        let stored: Vec<(usize, Register)> = stored.collect();
        let is_sparse = results.len() >= MANY && stored.len() < results.len().div_ceil(2);
        let in_locals = segments.len() == 1 && !is_sparse;
        if !in_locals {
            planner.will_store(&stored);
        }
        let mut last = None;
        let mut parts = Vec::new();
        for (k, segment) in segments.iter().enumerate() {
            let sequence = &order.sequence[segment.range.clone()];
            if let Some(repeat) = &segment.repeat {
                parts.push(planner.rounds(repeat, sequence));
                continue;
            }
            sequence.iter().for_each(|&index| planner.compute(index));
            last = in_locals.then(|| results.iter().map(|&result| planner.value(result)).collect());
            let next = segments.get(k + 1).and_then(|next| next.repeat.as_ref());
            parts.push(planner.end_part(next.map(|repeat| (repeat, &order.sequence[repeat.range.clone()]))));
        }
        parts.retain(|part| in_locals || !part.statements.is_empty());
        Self { parts, waiting: planner.waiting.length, results: last, peaks }
    }
}

/// Splits the function into chunks. A long function is first searched for loops.
fn segments(schedule: &Schedule, order: Order) -> (Order, Vec<OperationRange>) {
    if !chunks::is_long(&order) {
        let segments = chunks::segments(&order, Vec::new());
        return (order, segments);
    }
    let all = 0..order.sequence.len();
    let angles = plain_angles(schedule, &order.sequence, &[all]).concat();
    let angles: BTreeSet<Register> = angles.into_iter().collect();
    let order = order.with_sines_first(schedule, |register| angles.contains(&register));
    let repeats = repeats(schedule, &order);
    let segments = chunks::segments(&order, repeats);
    (order, segments)
}
