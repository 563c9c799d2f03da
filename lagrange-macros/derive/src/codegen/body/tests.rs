//! Checks that bodies compute the values of the graph, and that chunks read only inputs and spill slots.

use lagrange_random::cases;
use rustc_hash::FxHashMap;

use super::{Chunk, FunctionBody, Local, Operand, Slot, Statement};
use crate::codegen::operation::{Call, Operation, Register};
use crate::codegen::passes::Program;
use crate::codegen::schedule::Schedule;
use crate::symbolic::{Approximate, External, Function, Graph, Id, Symbol};

fn symbol(index: u32) -> Symbol {
    Symbol { family: 1, index }
}

fn inputs<const N: usize>(graph: &mut Graph) -> [Id; N] {
    std::array::from_fn(|index| graph.symbol(symbol(index as u32)))
}

fn body(graph: &Graph, roots: &[Id]) -> FunctionBody {
    FunctionBody::new(&Program::of(graph, roots), &FxHashMap::default())
}

fn input(symbol: Symbol) -> f64 {
    0.3 + 0.1 * f64::from(symbol.index)
}

/// Value of an unknown function, computed by a graph of its own.
fn function(call: &Call<f64>, output: u32) -> f64 {
    let mut graph = Graph::default();
    let arguments = (0..call.arguments.len()).map(|index| graph.symbol(symbol(index as u32))).collect();
    let (function, derivatives) = (call.function, call.derivatives.clone());
    let root = graph.external(External { function, output, derivatives, arguments, is_along: false });
    graph.sample(&[root], 7, |symbol| Approximate::exact(call.arguments[symbol.index as usize]))[0].value
}

/// Compares the values of graph and body, and returns the body.
fn checked(graph: &Graph, roots: &[Id]) -> FunctionBody {
    let body = body(graph, roots);
    let wanted = graph.sample(roots, 7, |symbol| Approximate::exact(input(symbol)));
    for (value, wanted) in body.values(roots.len(), input, function).into_iter().zip(wanted) {
        // Both have the rounding errors of the same operations, except that passes may regroup them.
        assert!((value - wanted.value).abs() <= 4.0 * wanted.error, "{value} for {wanted:?}");
    }
    body
}

fn statements(body: &FunctionBody) -> &[Statement] {
    let [Chunk { statements, .. }] = &body.parts[..] else { panic!("one part") };
    statements
}

#[test]
fn what_is_used_once_is_nested_and_what_is_used_twice_is_a_local() {
    let mut graph = Graph::default();
    let [x, y, z] = inputs(&mut graph);
    let shared = graph.function(Function::Exp, x);
    let (left, right) = (graph.mul(shared, y), graph.add(shared, z));
    let right = graph.function(Function::Ln, right);
    let body = checked(&graph, &[left, right]);
    let [Statement::Let(local, value)] = statements(&body) else { panic!("one local: {body:?}") };
    let exponential = Operation::Function(Function::Exp, Operand::Of(Box::new(Operation::Input(symbol(0)))));
    assert_eq!(*value, Operand::Of(Box::new(exponential)));
    let results = body.results.as_ref().expect("no arrays");
    assert!(
        results.iter().all(|result| format!("{result:?}").contains(&format!("{local:?}"))),
        "{results:?}"
    );
}

#[test]
fn nesting_ends_before_it_is_deep() {
    let mut graph = Graph::default();
    let [x, y] = inputs(&mut graph);
    let mut chain = x;
    for _ in 0..20 {
        let next = graph.function(Function::Tanh, chain);
        chain = graph.sub(next, y);
    }
    let body = checked(&graph, &[chain]);
    assert!((5..=10).contains(&statements(&body).len()), "{body:?}");
}

/// Number of angles in each statement of sines and cosines.
fn turns(body: &FunctionBody) -> Vec<usize> {
    let turns = statements(body).iter().filter_map(|statement| match statement {
        Statement::Turns(turns) => Some(turns.len()),
        _ => None,
    });
    turns.collect()
}

#[test]
fn sine_and_cosine_of_one_argument_come_together() {
    let mut graph = Graph::default();
    let [x, y] = inputs(&mut graph);
    let [sine, cosine] = [Function::Sin, Function::Cos].map(|function| graph.function(function, x));
    let inner = graph.mul(sine, y);
    let alone = graph.function(Function::Cos, inner);
    let roots = [graph.mul(cosine, alone), graph.sub(sine, y), alone];
    let body = checked(&graph, &roots);
    assert_eq!((turns(&body), statements(&body).len()), (vec![1], 2), "{body:?}");
    assert_eq!(body.parts[0].locals.len(), 3);
}

/// Chain of so many operations on `factor` that the function is split into chunks. The first chunk uses `first`.
fn far(graph: &mut Graph, first: Id, factor: Id) -> Id {
    (0..6_000).fold(first, |sum, k| {
        let scaled = graph.sum([(factor, crate::symbolic::Rational::new(1, k + 2))]);
        let term = graph.sum([(sum, 1.into()), (scaled, 1.into())]);
        let product = graph.mul(term, factor);
        graph.defined(product)
    })
}

/// The first chunk of a long function uses the sine of an angle, the last its cosine, and both use another angle.
#[test]
fn what_an_earlier_part_has_taken_is_not_taken_again() {
    let mut graph = Graph::default();
    let [x, y] = inputs(&mut graph);
    let first = graph.function(Function::Sin, x);
    let sum = far(&mut graph, first, y);
    let cosine = graph.function(Function::Cos, x);
    let doubled = graph.add(y, y);
    let other = graph.function(Function::Sin, doubled);
    let last = graph.product([sum, cosine, other].map(|factor| (factor, 1.into())));
    let body = checked(&graph, &[last]);
    assert!(body.parts.len() > 1, "{} parts", body.parts.len());
}

#[test]
fn angles_that_are_at_hand_are_taken_four_at_a_time() {
    let mut graph = Graph::default();
    let [x, y] = inputs(&mut graph);
    let angles: Vec<Id> = (1..=6).map(|k| graph.sum([(x, k.into()), (y, 1.into())])).collect();
    let sines: Vec<Id> = angles.iter().map(|&angle| graph.function(Function::Sin, angle)).collect();
    let cosine = graph.function(Function::Cos, angles[0]);
    let deeper = graph.function(Function::Sin, sines[5]);
    let sum = sines.iter().fold(deeper, |sum, &sine| graph.add(sum, sine));
    let body = checked(&graph, &[sum, cosine]);
    // The sine of a sine is no plain angle and comes alone, as an expression.
    assert_eq!(turns(&body), [4, 2], "{body:?}");
    let small = statements(&body).iter().filter_map(|statement| match statement {
        Statement::Small(angles) => Some(angles.len()),
        _ => None,
    });
    assert_eq!(small.collect::<Vec<_>>(), [6], "{body:?}");
}

#[test]
fn few_angles_are_taken_one_by_one() {
    let mut graph = Graph::default();
    let [x, y] = inputs(&mut graph);
    let both = graph.add(x, y);
    let [a, b, c] = [x, y, both].map(|angle| graph.function(Function::Sin, angle));
    let cosine = graph.function(Function::Cos, both);
    let roots = [graph.mul(a, c), graph.mul(b, cosine), c];
    let body = checked(&graph, &roots);
    assert_eq!(turns(&body), [1], "{body:?}");
}

#[test]
fn the_results_of_a_call_that_are_used_come_together() {
    let mut graph = Graph::default();
    let [x, y] = inputs(&mut graph);
    let mut call = |output, derivatives: &[u32]| {
        graph.external(External {
            function: 0,
            output,
            derivatives: derivatives.into(),
            arguments: [x, y].into(),
            is_along: false,
        })
    };
    let (first, third, slope) = (call(0, &[]), call(2, &[]), call(2, &[1]));
    let roots = [graph.add(third, slope), graph.mul(first, third)];
    let body = checked(&graph, &roots);
    let calls = statements(&body).iter().filter_map(|statement| match statement {
        Statement::Call(_, calls) => Some(
            calls.iter().map(|(_, results)| results.iter().map(|(output, _)| *output).collect::<Vec<_>>()),
        ),
        _ => None,
    });
    let mut calls: Vec<_> = calls.flatten().collect();
    calls.sort();
    assert_eq!(calls, [vec![0, 2], vec![2]]);
}

/// The first and the last chunk of a long function use the first result of a call. Only the last chunk uses the
/// second result, which has a name.
#[test]
fn results_of_a_call_wait_for_later_parts() {
    let mut graph = Graph::default();
    let [x, y] = inputs(&mut graph);
    let [first, second] = [0, 1].map(|output| {
        let (derivatives, arguments) = (Box::default(), [x, y].into());
        graph.external(External { function: 0, output, derivatives, arguments, is_along: false })
    });
    let sum = far(&mut graph, first, y);
    let second = graph.defined(second);
    let last = graph.product([sum, first, second].map(|factor| (factor, 1.into())));
    let body = checked(&graph, &[last]);
    assert!(body.parts.len() > 1, "{} parts", body.parts.len());
    let names = FxHashMap::from_iter([(second, "second".to_owned())]);
    let named = FunctionBody::new(&Program::of(&graph, &[last]), &names);
    assert_eq!(named.values(1, input, function), body.values(1, input, function));
    let with_it = named.parts.iter().filter(|part| part.locals.contains(&Local::Definition(second)));
    assert_eq!(with_it.count(), 2);
}

#[test]
fn a_local_is_called_after_the_definition() {
    let mut graph = Graph::default();
    let [x, y] = inputs(&mut graph);
    let sum = graph.add(x, y);
    let defined = graph.defined(sum);
    let roots = [graph.mul(defined, x), graph.mul(defined, y)];
    let names = FxHashMap::from_iter([(defined, "sum".to_owned())]);
    let body = FunctionBody::new(&Program::of(&graph, &roots), &names);
    assert_eq!(body.parts[0].locals, [Local::Definition(defined)]);
}

/// Random operations, enough to be split into chunks.
fn long(seed: u64, length: usize) -> Program {
    let mut state = seed;
    let mut below = |limit: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 33) as usize) % limit
    };
    let mut schedule = Schedule::default();
    let mut registers: Vec<Register> =
        (0..4).map(|index| schedule.push(Operation::Input(symbol(index)))).collect();
    while registers.len() < length {
        let mut near = || registers[registers.len() - 1 - below(registers.len().min(300))];
        let (x, y) = (near(), near());
        let operation = match below(8) {
            0 => Operation::Function(Function::Sin, x),
            1 => Operation::Function(Function::Cos, x),
            2..=4 => Operation::Subtract(x, y),
            5 => Operation::Multiply(x, schedule.constant(0.5)),
            _ => Operation::Add(x, y),
        };
        registers.push(schedule.push(operation));
    }
    let results = (0..300).map(|_| registers[below(length)]).chain([registers[0]]).collect();
    Program { schedule, results, blocks: Vec::new(), counts: Vec::new() }
}

#[test]
fn parts_see_what_waits_for_them_and_places_are_taken_again() {
    for seed in 1..=cases([1, 1, 20]) as u64 {
        let program = long(seed, cases([8_000, 8_000, 12_000]));
        let body = FunctionBody::new(&program, &FxHashMap::default());
        assert!(body.parts.len() > 2 && body.results.is_none());
        let stored =
            body.parts.iter().flat_map(|part| &part.statements).filter_map(|statement| match statement {
                Statement::Store(Slot::SpillSlots(series), _) => Some(series.first),
                _ => None,
            });
        let stored: Vec<usize> = stored.collect();
        assert!(stored.len() > body.waiting && stored.iter().all(|&place| place < body.waiting));
        assert_eq!(
            body.values(program.results.len(), input, function),
            program.schedule.values(&program.results, input),
            "seed {seed}"
        );
    }
}

/// Random numbers below a limit.
fn random(seed: u64) -> impl FnMut(usize) -> usize {
    let mut state = seed;
    move |limit| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 33) as usize) % limit
    }
}

/// Operand of an operation in an iteration.
#[derive(Clone, Copy)]
enum Taken {
    /// Operation of an iteration: its index, and how many iterations back.
    Computed(usize, usize),
    /// Input per iteration, at a constant stride; `Reversed` has a negative stride.
    Input(usize),
    Reversed(usize),
    /// Input per iteration, at irregular indices.
    Scattered(usize),
    /// Result of the first chunk per iteration, at irregular indices.
    Early(usize),
    Shared,
    Constant,
    /// Operation of an iteration as `Computed`, but another one in every eleventh iteration.
    Unsteady(usize, usize),
}

/// Iterations of the same random operations, between other random operations. The last ones use results of all
/// iterations.
fn with_rounds(seed: u64, rounds: usize, length: usize, is_steady: bool) -> Program {
    let mut below = random(seed);
    let mut schedule = Schedule::default();
    let given = |schedule: &mut Schedule, k: usize| schedule.push(Operation::Input(symbol(k as u32)));
    let early: Vec<Register> = (0..300)
        .map(|k| {
            let (x, y) = (given(&mut schedule, k), given(&mut schedule, k * 7 % 31));
            let scaled = schedule.constant(0.5);
            let product = schedule.push(Operation::Multiply(x, scaled));
            schedule.push(Operation::Subtract(product, y))
        })
        .collect();
    let template: Vec<(usize, [Taken; 2])> = (0..length)
        .map(|k| {
            let mut operand = |other: usize| match below(12) {
                _ if other == 1 && k > 0 => Taken::Computed(k - 1, 0),
                0..=2 if k > 90 && !is_steady => Taken::Unsteady(below(k - 80), below(2)),
                0..=3 if k > 0 => Taken::Computed(below(k), 0),
                4 | 5 => Taken::Computed(below(length), 1),
                6 => Taken::Computed(below(length), 2),
                7 => Taken::Input(below(5)),
                8 => Taken::Reversed(below(5)),
                9 => Taken::Scattered(below(5)),
                10 => Taken::Early(below(5)),
                11 => Taken::Constant,
                _ => Taken::Shared,
            };
            let operands = [operand(0), operand(1)];
            (below(3), operands)
        })
        .collect();
    let mut computed: Vec<Vec<Register>> = Vec::new();
    for round in 0..rounds {
        let mut now: Vec<Register> = Vec::new();
        for &(kind, operands) in &template {
            let [x, y] = operands.map(|taken| match taken {
                Taken::Computed(k, 0) => now[k],
                Taken::Computed(k, back) if round >= back => computed[round - back][k],
                Taken::Computed(k, _) => early[k % 290],
                Taken::Input(k) => given(&mut schedule, 1_000 + 5 * round + k),
                Taken::Reversed(k) => given(&mut schedule, 3_000 - 5 * round + k),
                Taken::Scattered(k) => given(&mut schedule, 4_000 + round * round + k),
                Taken::Early(k) => early[(round * round + 3 * k) % 290],
                Taken::Constant => schedule.constant(0.25),
                Taken::Unsteady(k, _) if round < 2 => early[k],
                Taken::Unsteady(k, 0) if round % 11 == 5 => early[k],
                Taken::Unsteady(k, 0) => now[k],
                Taken::Unsteady(k, back) if round % 11 == 5 => computed[round - back - 1][k],
                Taken::Unsteady(k, back) => computed[round - back][k],
                Taken::Shared => early[299],
            });
            let halves = schedule.constant(0.5);
            now.push(match kind {
                0 => schedule.push(Operation::Subtract(x, y)),
                1 => schedule.push(Operation::MultiplyAdd(x, halves, y)),
                _ => schedule.push(Operation::SubtractProduct(y, halves, x)),
            });
        }
        computed.push(now);
    }
    let all: Vec<Register> = computed.concat();
    let mut results: Vec<Register> = computed.iter().rev().map(|now| now[length - 1]).collect();
    let late = (0..1_500).fold(early[0], |sum, k| {
        let other = if k % 3 == 0 { all[below(all.len())] } else { early[below(300)] };
        let other = schedule.push(Operation::Subtract(other, sum));
        schedule.push(Operation::Minimum(other, early[k % 300]))
    });
    results.push(late);
    Program { schedule, results, blocks: Vec::new(), counts: Vec::new() }
}

fn rounds(body: &FunctionBody) -> Vec<usize> {
    body.parts.iter().filter_map(|part| Some(part.rounds.as_ref()?.count)).collect()
}

#[test]
fn what_comes_again_and_again_is_computed_in_a_loop() {
    let mut found = [0, 0];
    let programs = cases([4, 8, 200]);
    for (seed, is_steady) in (1..=programs as u64).flat_map(|seed| [(seed, true), (seed, false)]) {
        let program = with_rounds(seed, 40, 150, is_steady);
        let body = FunctionBody::new(&program, &FxHashMap::default());
        assert_eq!(
            body.values(program.results.len(), input, function),
            program.schedule.values(&program.results, input),
            "seed {seed}, steady {is_steady}"
        );
        found[usize::from(is_steady)] += rounds(&body).iter().sum::<usize>();
    }
    // A program has 40 iterations. At least 35 of them, where they are alike, become rounds of a loop.
    assert!(found[1] > 35 * programs && found[0] > 5 * programs, "{found:?}");
}

#[test]
fn of_many_results_zeros_are_not_stored() {
    let mut graph = Graph::default();
    let [x] = inputs(&mut graph);
    let mut roots = vec![Id::ZERO; 300];
    roots[7] = graph.function(Function::Exp, x);
    roots[9] = x;
    let body = checked(&graph, &roots);
    let places: Vec<_> = statements(&body)
        .iter()
        .map(|statement| match statement {
            Statement::Store(place, _) => Some(*place),
            _ => None,
        })
        .collect();
    assert_eq!(places, [Some(Slot::Result(9)), Some(Slot::Result(7))]);
}
