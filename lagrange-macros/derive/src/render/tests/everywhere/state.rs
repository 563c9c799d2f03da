//! Values of the names of a system at a state.

use std::collections::BTreeMap;

use super::{Page, links, momentum, outer, potential, turns, value};
use crate::codegen;
use crate::render::axes::named_axes;
use crate::render::formula::Formula;
use crate::render::letters::PageQuantity;
use crate::render::roots::named_roots;
use crate::render::tests::reader::{Meanings, Value, read_at, read_with};
use crate::render::tests::systems::System;
use crate::resolve::{self, Entry, Parameters, Supplied};
use crate::symbolic::{Approximate, External, Function, Id, Sample, superposition};
use crate::variables::Variable;

/// Values of the names of a system at a state.
pub(super) struct State<'a> {
    system: &'a Page<'a>,
    names: BTreeMap<String, Value>,
    sample: Sample,
    draw: u64,
}

impl<'a> State<'a> {
    pub(super) fn new(system: &'a Page<'a>, sample: &mut Sample, draw: u64) -> Self {
        let System { graph, problem, .. } = system.system;
        let n = problem.coordinates.len();
        let mut names: BTreeMap<String, Value> = BTreeMap::new();
        let mut vectors: BTreeMap<String, Value> = BTreeMap::new();
        let mut put = |formula: Formula, value: f64| {
            for outer in outer(&formula) {
                vectors.entry(system.written(&outer)).or_default().push(value);
            }
            let name = system.written(&formula);
            assert!(
                names.insert(name.clone(), vec![value]).is_none(),
                "{name} stands for two in {}",
                system.text
            );
        };
        let kinds: [fn(usize) -> Variable; 3] =
            [Variable::Coordinate, Variable::Velocity, Variable::Acceleration];
        for (dots, kind) in kinds.into_iter().enumerate() {
            for i in 0..n {
                put(Formula::labelled(&problem.coordinates[i].text, dots), value(sample, kind(i)));
            }
        }
        for (a, (label, _)) in problem.constraints.iter().enumerate() {
            put(Formula::Multiplier(label.text.clone()), value(sample, Variable::Multiplier(a)));
        }
        for (entry, k) in all_entries(&problem.parameters) {
            put(
                Formula::labelled(&problem.parameters.name_of(entry), 0),
                value(sample, Variable::Parameter(k)),
            );
        }
        for turning in &system.derived.turnings.all {
            let quaternion = &problem.coordinates[turning.first].text;
            let quaternion = quaternion.strip_suffix("[0]").expect("a vector");
            for (dots, values) in turns::angular(sample, turning).into_iter().enumerate() {
                for (axis, value) in values.into_iter().enumerate() {
                    put(
                        system.letters.name_of(
                            PageQuantity::AngularVelocity,
                            &format!("{quaternion}[{axis}]"),
                            dots,
                        ),
                        value,
                    );
                }
            }
            let euler = turning.euler.iter().flat_map(|euler| euler.inertia.iter().enumerate());
            for (i, row) in euler {
                for (j, &entry) in row.iter().enumerate() {
                    let value = sample.values(graph, &[entry])[0].value;
                    put(
                        system.letters.name_of(PageQuantity::Inertia, &format!("{quaternion}[{i}][{j}]"), 0),
                        value,
                    );
                }
            }
        }
        let mut transposes = Vec::new();
        for axes in named_axes(problem, &system.derived.turnings) {
            let values = axes.entries.map(|row| row.map(|entry| sample.values(graph, &[entry])[0].value));
            let places = (0..3).flat_map(|i| (0..3).map(move |j| [i, j]));
            places.for_each(|place| put(axes.entry(place), values[place[0]][place[1]]));
            let transpose = (0..9).map(|k| values[k % 3][k / 3]).collect();
            transposes.push((Formula::Transpose(Box::new(axes.name())), transpose));
        }
        for i in 0..n {
            let value = sample.values(graph, &[system.derived.equations.momentum[i]])[0].value;
            put(Formula::labelled(&momentum(system, i), 0), value);
        }
        put(Formula::labelled("t", 0), value(sample, Variable::Time));
        put(Formula::Pi, std::f64::consts::PI);
        let mut definitions: Vec<(&Id, &String)> = problem.names.iter().collect();
        definitions.sort();
        for (&id, name) in definitions {
            put(Formula::labelled(name, 0), sample.values(graph, &[id])[0].value);
        }
        if potential::name(system).is_some() {
            put(
                system.letters.name(PageQuantity::Lagrangian),
                sample.values(graph, &[problem.lagrangian])[0].value,
            );
        }
        links::rates_of_definitions(system, sample).into_iter().for_each(|(name, value)| put(name, value));
        vectors.append(&mut names);
        vectors.extend(transposes.into_iter().map(|(name, entries)| (system.written(&name), entries)));
        for (name, value) in links::values(system, sample) {
            let all = links::with_entries(&name, value).into_iter();
            vectors.extend(all.map(|(name, value)| (system.written(&name), value)));
        }
        let mut state = Self { system, names: vectors, sample: sample.clone(), draw };
        state.read_roots();
        state.read_resultants();
        state
    }

    /// Reads the values of named roots from the lines that state them.
    fn read_roots(&mut self) {
        let System { graph, problem, .. } = self.system.system;
        let lines = self.system.lines("Lagrangian\n");
        for root in named_roots(graph, problem).iter().filter(|root| root.definition.is_none()) {
            let name = self.system.written(&root.name);
            let text = lines.iter().find_map(|line| line.strip_prefix(&format!("{name} = ")));
            if let Some(value) = text.map(|text| self.read(text)) {
                assert!(self.names.insert(name, value).is_none(), "{} stands for two", self.system.text);
            }
        }
    }

    /// Reads the values of I, F and N of bodies from the lines that state them.
    fn read_resultants(&mut self) {
        let mut lines = self.system.lines("Lagrangian\n");
        lines.extend(self.system.lines("Equations of motion\n"));
        for name in links::resultants(self.system).into_iter().chain(potential::name(self.system)) {
            let start = self.system.written(&name) + " = ";
            let text = lines.iter().find_map(|line| line.strip_prefix(&start));
            if let Some(value) = text.map(|text| self.read(text.split("   (").next().expect("a formula"))) {
                let all = links::with_entries(&name, value).into_iter();
                self.names.extend(all.map(|(name, value)| (self.system.written(&name), value)));
            }
        }
    }

    pub(super) fn read(&self, text: &str) -> Value {
        read_with(text, self)
    }

    /// Value of a text for a value of a running index.
    pub(super) fn read_at(&self, text: &str, index: Option<&(String, i64)>) -> Value {
        read_at(text, self, index.cloned().into_iter().collect())
    }

    /// Returns whether a written name is this entry, or an array that contains it.
    fn is_in(&self, written: &str, entry: &str) -> bool {
        let entry = Formula::labelled(entry, 0);
        let mut all = outer(&entry);
        all.push(entry);
        all.iter().any(|formula| self.system.written(formula) == written)
    }

    /// All results of a function, or the named one.
    fn external(&self, function: &str, derivatives: &[u32], arguments: &[f64]) -> Value {
        let functions = self.system.problem.functions.iter().enumerate();
        let outputs = functions.flat_map(|(index, function)| {
            let names =
                if function.outputs == 1 { vec![function.name.clone()] } else { function.names.clone() };
            names.into_iter().enumerate().map(move |(output, name)| (name, index, output))
        });
        let is_it = |name: &str| self.is_in(function, name);
        let found = outputs.filter(|(name, ..)| is_it(name));
        let arguments: Vec<_> = arguments.iter().copied().map(Approximate::exact).collect();
        let values: Value = found
            .map(|(_, index, output)| {
                let (function, output) = (index as u32, output as u32);
                let derivatives = derivatives.into();
                let external =
                    External { function, output, derivatives, arguments: Box::default(), is_along: false };
                superposition(&external, &arguments, self.draw).value
            })
            .collect();
        assert!(!values.is_empty(), "no function {function}");
        values
    }
}

/// Entries in the order of the fields, with the index of the parameter that each is: the lower triangle of a symmetric matrix
/// is that of the upper one.
fn all_entries(parameters: &Parameters) -> Vec<(Entry, usize)> {
    let mirrored = |&entry: &Entry| parameters.is_symmetric(entry).then(|| parameters.mirrored(entry));
    let both = |(k, entry): (usize, &Entry)| [Some((*entry, k)), mirrored(entry).map(|entry| (entry, k))];
    let mut all: Vec<_> = parameters.entries.iter().enumerate().flat_map(both).flatten().collect();
    all.sort_unstable();
    all.dedup();
    all
}

impl Meanings for State<'_> {
    fn elements(&self) -> i64 {
        let labels = self.system.problem.coordinates.iter();
        let first = labels.filter_map(|label| label.text.split_once('[')?.1.split_once(']')?.0.parse().ok());
        first.max().map_or(0, |last: i64| last + 1)
    }

    fn name(&self, name: &str) -> Option<Value> {
        self.names.get(name).cloned()
    }

    fn call(&self, function: &str, primes: usize, arguments: &[f64]) -> Value {
        let number = match (Function::named(function), function, arguments) {
            (Some(function), _, &[x]) => codegen::apply(function, &x),
            (_, "max", [x, y]) => x.max(*y),
            (_, "min", [x, y]) => x.min(*y),
            (_, "clamp", [x, low, high]) => x.max(*low).min(*high),
            (_, "step", [x]) => f64::from(u8::from(*x > 0.0)),
            (_, "atan2", [y, x]) => y.atan2(*x),
            _ => return self.external(function, &vec![0; primes], arguments),
        };
        vec![number]
    }

    fn rate_of_partial(&self, function: &str, by: &[String]) -> Value {
        potential::rate_of_momentum(self.system, &self.sample, function, &by[0]).expect("a potential")
    }

    fn partial(&self, function: &str, by: &[String], arguments: Option<&[f64]>) -> Value {
        if let ([by], None) = (by, arguments)
            && let Some(value) = links::partial(self.system, &self.sample, function, by)
        {
            return value;
        }
        let mut functions = self.system.problem.functions.iter();
        let is_it = |supplied: &&Supplied| supplied.names.iter().any(|name| self.is_in(function, name));
        let supplied = functions.find(is_it).expect("a function");
        let formals = supplied.formals.iter().flat_map(|(name, lengths)| resolve::entry_names(name, lengths));
        let formals: Vec<String> = formals.collect();
        let written = |name: &str| self.system.written(&Formula::labelled(name, 0));
        let own = || formals.iter().flat_map(|name| self.names[&written(name)].clone()).collect();
        let arguments: Value = arguments.map_or_else(own, <[f64]>::to_vec);
        let places = |x: &String| {
            let found = formals.iter().enumerate().filter(|(_, formal)| self.is_in(x, formal));
            found.map(|(place, _)| place as u32).collect::<Vec<u32>>()
        };
        match by {
            [by] => {
                places(by).iter().flat_map(|&place| self.external(function, &[place], &arguments)).collect()
            }
            several => {
                self.external(function, &several.iter().flat_map(places).collect::<Vec<_>>(), &arguments)
            }
        }
    }
}
