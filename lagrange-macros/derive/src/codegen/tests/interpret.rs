//! Interpreter of function bodies, for tests without a compiler.

use rustc_hash::FxHashMap;

use crate::codegen::Tape;
use crate::codegen::body::{Chunk, FunctionBody, Given, Local, Operand, SineAndCosine, Slot, Statement};
use crate::codegen::operation::{Call, Register};
use crate::codegen::schedule::Schedule;
use crate::symbolic::Symbol;
use crate::variables::Variable;

#[path = "../../../tests/symbolic/functions.rs"]
pub(crate) mod functions;

impl Schedule {
    /// Evaluates the results for given inputs.
    pub(crate) fn values(&self, results: &[Register], input: impl Fn(Symbol) -> f64) -> Vec<f64> {
        Tape::of(self, results).results_by(input)
    }
}

impl FunctionBody {
    /// Evaluates `count` results. `function` evaluates user-supplied functions from the call and the index of the
    /// result.
    pub(crate) fn values(
        &self,
        count: usize,
        input: impl Fn(Symbol) -> f64,
        function: impl Fn(&Call<f64>, u32) -> f64,
    ) -> Vec<f64> {
        let (mut waiting, mut results) = (vec![f64::NAN; self.waiting], vec![0.0; count]);
        let rounds = |part: &Chunk| part.rounds.as_ref().map_or(1, |rounds| rounds.count);
        for (part, round) in
            self.parts.iter().flat_map(|part| (0..rounds(part)).map(move |round| (part, round)))
        {
            let given: Vec<f64> = part.given(round, &waiting, &input);
            let input = |symbol: Symbol| match Variable::of(symbol) {
                Variable::Given(k) => given[k],
                _ => {
                    assert!(part.inputs.contains(&symbol), "{symbol:?} is not among the inputs");
                    input(symbol)
                }
            };
            let mut frame = Frame { part, round, input, waiting: &mut waiting, locals: FxHashMap::default() };
            part.statements.iter().for_each(|statement| frame.run(statement, &function, &mut results));
            assert!(frame.locals.len() == part.locals.len(), "every local has a value");
            if let Some(values) = &self.results {
                results = values.iter().map(|value| frame.value(value)).collect();
            }
        }
        results
    }
}

impl Chunk {
    fn given(&self, round: usize, waiting: &[f64], input: impl Fn(Symbol) -> f64) -> Vec<f64> {
        let given = self.rounds.iter().flat_map(|rounds| &rounds.given).map(|given| match given {
            Given::Inputs(symbols) => input(symbols[round]),
            Given::SpillSlots(series) => waiting[series.at(round)],
        });
        given.collect()
    }
}

/// State of the execution of a chunk.
struct Frame<'b, I> {
    part: &'b Chunk,
    round: usize,
    input: I,
    waiting: &'b mut [f64],
    locals: FxHashMap<Local, f64>,
}

impl<I: Fn(Symbol) -> f64> Frame<'_, I> {
    fn run(
        &mut self,
        statement: &Statement,
        function: &impl Fn(&Call<f64>, u32) -> f64,
        results: &mut [f64],
    ) {
        match statement {
            Statement::Let(local, value) => self.define(*local, self.value(value)),
            Statement::Small(angles) => {
                angles.iter().for_each(|(local, angle)| self.define(*local, self.value(angle)));
            }
            Statement::Turns(turns) => {
                for SineAndCosine { angle, sine, cosine } in turns {
                    let angle = self.value(angle);
                    sine.iter().for_each(|&sine| self.define(sine, angle.sin()));
                    cosine.iter().for_each(|&cosine| self.define(cosine, angle.cos()));
                }
            }
            Statement::Call(call, calls) => {
                let on = call.on(|argument| self.value(argument));
                for (derivatives, outputs) in calls {
                    let call = Call { derivatives: derivatives.clone(), ..on.clone() };
                    outputs.iter().for_each(|&(output, local)| self.define(local, function(&call, output)));
                }
            }
            Statement::Store(Slot::Result(index), value) => results[*index] = self.value(value),
            Statement::Store(Slot::SpillSlots(series), value) => {
                self.waiting[series.at(self.round)] = self.value(value);
            }
        }
    }

    fn define(&mut self, local: Local, value: f64) {
        assert!(self.part.locals.contains(&local), "{local:?} is not declared");
        assert!(self.locals.insert(local, value).is_none(), "{local:?} has two values");
    }

    fn value(&self, expression: &Operand) -> f64 {
        match expression {
            Operand::Local(local) => {
                *self.locals.get(local).unwrap_or_else(|| panic!("{local:?} has no value"))
            }
            Operand::SpillSlots(place) => self.waiting[*place],
            Operand::Of(operation) => {
                operation.as_ref().clone().value(&self.input, |operand| self.value(&operand))
            }
        }
    }
}
