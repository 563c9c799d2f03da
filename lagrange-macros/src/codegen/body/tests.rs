//! Bodies compute what the graph says, and their parts see nothing but what waits for them.

use rustc_hash::FxHashMap;

use super::{Body, Expression, Local, Part, Place, Statement};
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

fn body(graph: &Graph, roots: &[Id]) -> Body {
    Body::new(&Program::of(graph, roots), &FxHashMap::default())
}

fn input(symbol: Symbol) -> f64 {
    0.3 + 0.1 * f64::from(symbol.index)
}

/// The value of a function of which nothing is known, by a graph of its own.
fn function(call: &Call<f64>, output: u32) -> f64 {
    let mut graph = Graph::default();
    let arguments = (0..call.arguments.len()).map(|index| graph.symbol(symbol(index as u32))).collect();
    let (function, derivatives) = (call.function, call.derivatives.clone());
    let root = graph.external(External { function, output, derivatives, arguments });
    graph.sample(&[root], 7, |symbol| Approximate::exact(call.arguments[symbol.index as usize]))[0].value
}

/// Computes both, and returns the body.
fn checked(graph: &Graph, roots: &[Id]) -> Body {
    let body = body(graph, roots);
    let wanted = graph.sample(roots, 7, |symbol| Approximate::exact(input(symbol)));
    for (value, wanted) in body.values(roots.len(), input, function).into_iter().zip(wanted) {
        // Both are off by the rounding of the same operations, but that the passes may group them in another way.
        assert!((value - wanted.value).abs() <= 4.0 * wanted.error, "{value} for {wanted:?}");
    }
    body
}

fn statements(body: &Body) -> &[Statement] {
    let [Part { statements, .. }] = &body.parts[..] else { panic!("one part") };
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
    let exponential =
        Operation::Function(Function::Exp, Expression::Of(Box::new(Operation::Input(symbol(0)))));
    assert_eq!(*value, Expression::Of(Box::new(exponential)));
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

/// How many angles are taken at once, statement by statement.
fn turns(body: &Body) -> Vec<usize> {
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

/// What takes so many operations with `factor`, one after another, that they are cut into parts, of which the first uses `first`.
fn far(graph: &mut Graph, first: Id, factor: Id) -> Id {
    (0..6_000).fold(first, |sum, k| {
        let scaled = graph.sum([(factor, crate::symbolic::Rational::new(1, k + 2))]);
        let term = graph.sum([(sum, 1.into()), (scaled, 1.into())]);
        let product = graph.mul(term, factor);
        graph.defined(product)
    })
}

/// The sine is used in the first part of a long function, the cosine in the last, and another angle in both.
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
    // What is of a sine comes alone, as an expression.
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
        })
    };
    let (first, third, slope) = (call(0, &[]), call(2, &[]), call(2, &[1]));
    let roots = [graph.add(third, slope), graph.mul(first, third)];
    let body = checked(&graph, &roots);
    let calls = statements(&body).iter().filter_map(|statement| match statement {
        Statement::Call(_, results) => Some(results.iter().map(|(output, _)| *output).collect::<Vec<_>>()),
        _ => None,
    });
    let mut calls: Vec<_> = calls.collect();
    calls.sort();
    assert_eq!(calls, [vec![0, 2], vec![2]]);
}

/// The first result of a call is used in the first part of a long function and in the last, the second, which has a name, in the
/// last alone.
#[test]
fn results_of_a_call_wait_for_later_parts() {
    let mut graph = Graph::default();
    let [x, y] = inputs(&mut graph);
    let [first, second] = [0, 1].map(|output| {
        let (derivatives, arguments) = (Box::default(), [x, y].into());
        graph.external(External { function: 0, output, derivatives, arguments })
    });
    let sum = far(&mut graph, first, y);
    let second = graph.defined(second);
    let last = graph.product([sum, first, second].map(|factor| (factor, 1.into())));
    let body = checked(&graph, &[last]);
    assert!(body.parts.len() > 1, "{} parts", body.parts.len());
    let names = FxHashMap::from_iter([(second, "second".to_owned())]);
    let named = Body::new(&Program::of(&graph, &[last]), &names);
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
    let body = Body::new(&Program::of(&graph, &roots), &names);
    assert_eq!(body.parts[0].locals, [Local::Definition(defined)]);
}

/// Operations at random, so many that they are cut into parts.
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
    Program { schedule, results, counts: Vec::new() }
}

#[test]
fn parts_see_what_waits_for_them_and_places_are_taken_again() {
    for seed in 1..=5 {
        let program = long(seed, 12_000);
        let body = Body::new(&program, &FxHashMap::default());
        assert!(body.parts.len() > 2 && body.results.is_none());
        let stored =
            body.parts.iter().flat_map(|part| &part.statements).filter_map(|statement| match statement {
                Statement::Store(Place::Waiting(place), _) => Some(*place),
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
    assert_eq!(places, [Some(Place::Result(9)), Some(Place::Result(7))]);
}
