//! Printed equations agree with the computed ones. For every system that any test, example or page of documentation
//! derives, the equations are read from the text and compared with the graph at random states.

mod links;
mod turns;

use std::collections::BTreeMap;
use std::ops::Deref;
use std::sync::LazyLock;

use super::mathml;
use super::reader::{Meanings, Value, read_with};
use super::systems::{self, Forms, Library, System};
use crate::mechanics::Derived;
use crate::render::arrays::Arrays;
use crate::render::axes::named_axes;
use crate::render::formula::Formula;
use crate::render::notation::Notation;
use crate::render::roots::named_roots;
use crate::resolve::{self, Entry, Parameters, Supplied};
use crate::symbolic::{Approximate, External, Function, Id, Sample, apply, superposition};
use crate::variables::Variable;

impl System {
    fn sample(&self, draw: u64) -> Sample {
        let (n, m) = (self.problem.coordinates.len(), self.problem.constraints.len());
        let kinds = [Variable::Coordinate, Variable::Velocity, Variable::Acceleration];
        let all = kinds.into_iter().flat_map(|kind| (0..n).map(kind));
        let parameters = (0..self.problem.parameters.entries.len()).map(Variable::Parameter);
        // What is printed holds while all constraints do.
        let switches = (0..self.problem.parameters.switches.len()).map(Variable::Switch);
        let all = all
            .chain(parameters)
            .chain(switches)
            .chain((0..m).map(Variable::Multiplier))
            .chain([Variable::Time]);
        let mut sample =
            Sample::new(all.map(Variable::symbol), draw, |symbol, draw| match Variable::of(symbol) {
                Variable::Switch(_) => {
                    let is_one = self.problem.parameters.switched_on(symbol) == Some(Id::ONE);
                    Approximate::exact(f64::from(u8::from(is_one)))
                }
                _ => self.problem.drawn(symbol, draw),
            });
        turns::make_consistent(self, &mut sample);
        sample
    }

    /// Redraws the accelerations and multipliers of a sample, and keeps its state.
    fn moved(&self, sample: &mut Sample, draw: u64) {
        let solved = [(Variable::Acceleration as fn(usize) -> Variable, self.problem.coordinates.len())];
        let solved = solved
            .into_iter()
            .chain([(Variable::Multiplier as fn(usize) -> Variable, self.problem.constraints.len())]);
        let solved = solved.flat_map(|(kind, count)| (0..count).map(kind)).map(Variable::symbol);
        sample.set(solved.map(|symbol| (symbol, self.problem.drawn(symbol, draw))).collect::<Vec<_>>());
        turns::make_consistent(self, sample);
    }
}

/// A page about a system.
struct Page<'a> {
    system: &'a System,
    text: String,
    /// Writes a name as `text` spells it.
    written: fn(&Arrays, &Formula) -> String,
}

impl Deref for Page<'_> {
    type Target = System;

    fn deref(&self) -> &System {
        self.system
    }
}

impl Page<'_> {
    fn written(&self, formula: &Formula) -> String {
        (self.written)(&self.arrays, formula)
    }

    /// Lines below a heading.
    fn lines(&self, heading: &str) -> Vec<&str> {
        let section = self.text.split("\n\n").find(|section| section.starts_with(heading));
        let lines = section.into_iter().flat_map(|section| section.lines().skip(1));
        lines.map(str::trim).filter(|line| line.contains(" = ") || line.contains("symbols)")).collect()
    }
}

/// Values of the names of a system at a state.
struct State<'a> {
    system: &'a Page<'a>,
    names: BTreeMap<String, Value>,
    sample: Sample,
    draw: u64,
}

impl<'a> State<'a> {
    fn new(system: &'a Page<'a>, sample: &mut Sample, draw: u64) -> Self {
        let System { graph, problem, .. } = system.system;
        let n = problem.coordinates.len();
        let mut names: BTreeMap<String, Value> = BTreeMap::new();
        let mut vectors: BTreeMap<String, Value> = BTreeMap::new();
        let mut put = |formula: Formula, value: f64| {
            for outer in outer(&formula) {
                vectors.entry(system.written(&outer)).or_default().push(value);
            }
            names.insert(system.written(&formula), vec![value]);
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
                    put(Formula::labelled(&format!("omega_{quaternion}[{axis}]"), dots), value);
                }
            }
            let euler = turning.euler.iter().flat_map(|euler| euler.inertia.iter().enumerate());
            for (i, row) in euler {
                for (j, &entry) in row.iter().enumerate() {
                    let value = sample.values(graph, &[entry])[0].value;
                    put(Formula::labelled(&format!("I_{quaternion}[{i}][{j}]"), 0), value);
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
        let lines = self.system.lines("Equations of motion\n");
        for name in links::resultants(self.system) {
            let start = self.system.written(&name) + " = ";
            let text = lines.iter().find_map(|line| line.strip_prefix(&start));
            if let Some(value) = text.map(|text| self.read(text.split("   (").next().expect("a formula"))) {
                let all = links::with_entries(&name, value).into_iter();
                self.names.extend(all.map(|(name, value)| (self.system.written(&name), value)));
            }
        }
    }

    fn read(&self, text: &str) -> Value {
        read_with(text, self)
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
                let external = External { function, output, derivatives, arguments: Box::default() };
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

fn value(sample: &Sample, variable: Variable) -> f64 {
    sample.get(variable.symbol()).value
}

/// Arrays that contain an entry, such as `r` for `r[0]`.
fn outer(formula: &Formula) -> Vec<Formula> {
    match formula {
        Formula::Name { base, dots, indices } => {
            let lengths = 0..indices.len();
            let name = |length| Formula::Name {
                base: base.clone(),
                dots: *dots,
                indices: indices[..length].to_vec(),
            };
            lengths.map(name).collect()
        }
        Formula::Member(of, member) => {
            outer(member).into_iter().map(|member| Formula::Member(of.clone(), Box::new(member))).collect()
        }
        Formula::Multiplier(entry) => match entry.rsplit_once('[') {
            Some((vector, _)) => vec![Formula::Multiplier(vector.to_owned())],
            None => Vec::new(),
        },
        _ => Vec::new(),
    }
}

impl Meanings for State<'_> {
    fn name(&self, name: &str) -> Option<Value> {
        self.names.get(name).cloned()
    }

    fn call(&self, function: &str, primes: usize, arguments: &[f64]) -> Value {
        let number = match (Function::named(function), function, arguments) {
            (Some(function), _, &[x]) => apply(function, &x),
            (_, "max", [x, y]) => x.max(*y),
            (_, "step", [x]) => f64::from(u8::from(*x > 0.0)),
            (_, "atan2", [y, x]) => y.atan2(*x),
            _ => return self.external(function, &vec![0; primes], arguments),
        };
        vec![number]
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

const STATES: u64 = 40;
/// Tolerance relative to the greatest of the compared values.
const CLOSE: f64 = 1e-8;

/// Number of states to compare at. One distinguishes two formulas; more reach more branches. The environment variable
/// `LAGRANGE_STATES` overrides it.
fn wanted() -> usize {
    static WANTED: LazyLock<usize> =
        LazyLock::new(|| std::env::var("LAGRANGE_STATES").ok().and_then(|n| n.parse().ok()).unwrap_or(1));
    *WANTED
}

/// Checks that each row, or vector of rows, is proportional to the computed one in accelerations and multipliers: the
/// printed row may be divided by a factor.
fn check_motion(system: &Page) {
    let mut first = 0;
    let mut lines = system.lines("Equations of motion\n").into_iter().peekable();
    while let Some(row) = lines.peek() {
        if let Some(turning) = system.derived.turnings.all.iter().find(|turning| turning.first == first) {
            turns::check(system, turning, &mut lines);
            first += 4;
            continue;
        }
        let row = *row;
        lines.next();
        if links::is_resultant(system, row) {
            continue;
        }
        let (label, equation) = row.split_once(": ").expect("a label");
        let labels = system.problem.coordinates[first..].iter();
        let labels = labels.map(|label| Notation::UNICODE.write(&Formula::labelled(&label.text, 0)));
        let is_it = |known: &String| {
            let index = known.strip_prefix(label).and_then(|rest| rest.strip_prefix('['));
            *known == label || index.is_some_and(|index| index.matches(']').count() == 1)
        };
        let count = labels.take_while(is_it).count();
        assert!(count > 0, "{row} has no coordinate in {}", system.text);
        if let Some((left, right)) = equation.trim().split_once(" = ") {
            check_rows(system, first..first + count, [left, right]);
        }
        first += count;
    }
    assert_eq!(first, system.derived.inertia.len(), "{}", system.text);
}

fn check_rows(system: &Page, rows: std::ops::Range<usize>, sides: [&str; 2]) {
    check_sides(system, rows.len(), sides, |sample| left_over(system, sample, rows.clone()));
}

fn check_sides(system: &Page, count: usize, sides: [&str; 2], computed: impl Fn(&mut Sample) -> Vec<f64>) {
    let mut states = 0;
    for draw in 0..STATES {
        let mut sample = system.sample(draw);
        let moved = (0..3).flat_map(|other| {
            system.moved(&mut sample, 1000 * (other + 1) + draw);
            let left_over = computed(&mut sample);
            let state = State::new(system, &mut sample, draw);
            let [left, right] = sides.map(|side| state.read(side));
            assert!(right.len() == left.len() || right == [0.0], "{sides:?}");
            let right = right.into_iter().chain(std::iter::repeat(0.0));
            let read: Vec<f64> = left.into_iter().zip(right).map(|(left, right)| left - right).collect();
            assert_eq!(read.len(), count, "{sides:?} in {}", system.text);
            read.into_iter().zip(left_over).map(|(read, computed)| [read, computed]).collect::<Vec<_>>()
        });
        let pairs: Vec<[f64; 2]> = moved.collect();
        if !pairs.iter().flatten().all(|x| x.is_finite()) {
            continue;
        }
        let greatest = |k: usize| pairs.iter().map(|pair| pair[k].abs()).fold(0.0, f64::max);
        assert!((greatest(0) > 0.0) == (greatest(1) > 0.0), "{sides:?} in {}", system.text);
        for pair in &pairs[1..] {
            let difference = pairs[0][0] * pair[1] - pairs[0][1] * pair[0];
            let close = difference.abs() <= CLOSE * greatest(0) * greatest(1);
            assert!(close, "{sides:?}: {pairs:?} in {}", system.text);
        }
        states += 1;
        if states == wanted() {
            return;
        }
    }
    assert!(states > 0, "no state for {sides:?} in {}", system.text);
}

/// Residual M q̈ − h − Fᵀλ.
fn left_over(system: &Page, sample: &mut Sample, rows: std::ops::Range<usize>) -> Vec<f64> {
    let Derived { equations, inertia, .. } = &system.derived;
    let row = |i: usize| {
        let force = equations.constraint_force.get(i).copied().unwrap_or(Id::ZERO);
        let parts = sample.values(&system.graph, &[inertia[i], equations.forcing[i], force]);
        parts[0].value - parts[1].value - parts[2].value
    };
    rows.map(row).collect()
}

/// Checks the rotation matrices against those of the quaternions.
fn check_axes(system: &Page) {
    for axes in named_axes(&system.problem, &system.derived.turnings) {
        let name = system.written(&axes.name());
        for line in system.lines("Lagrangian\n").iter().filter(|line| line.starts_with(&format!("{name} = ")))
        {
            check_line(system, line, |sample| {
                sample.values(&system.graph, &axes.entries.concat()).iter().map(|entry| entry.value).collect()
            });
        }
    }
}

/// Checks energies, momenta and constraint forces against the computed ones.
fn check_quantities(system: &Page) {
    let equations = &system.derived.equations;
    let conserved = system.lines("Conserved\n");
    let energy = system.lines("Energy\n");
    for line in conserved.iter().chain(&energy).filter(|line| line.starts_with("E = ")) {
        check_line(system, line, |sample| vec![sample.values(&system.graph, &[equations.energy])[0].value]);
    }
    for line in energy.iter().filter(|line| line.starts_with("d/dt E = ")) {
        check_line(system, line, |sample| {
            vec![sample.values(&system.graph, &[system.derived.facts.energy_rate])[0].value]
        });
    }
    let value = |sample: &mut Sample, root: Option<&Id>| {
        root.map_or(0.0, |&root| sample.values(&system.graph, &[root])[0].value)
    };
    check_by_coordinate(system, &system.lines("Constraint forces\n"), ("R_", 0), |sample, i| {
        value(sample, equations.constraint_force.get(i))
    });
    for lines in [conserved, system.lines("Momenta\n")] {
        check_by_coordinate(system, &lines, ("p_", 0), |sample, i| value(sample, equations.momentum.get(i)));
    }
}

/// Checks that at p = ∂L/∂q̇ of a state, H is the energy, ∂H/∂p the velocity and ṗ the forces.
fn check_hamilton(system: &Page) {
    let equations = &system.derived.equations;
    let n = system.problem.coordinates.len();
    let names = (0..n).map(|i| momentum(system, i));
    if names.into_iter().any(|name| system.problem.names.values().any(|known| *known == name)) {
        return;
    }
    for line in system.lines("Hamiltonian\n") {
        check_line(system, line, |sample| vec![sample.values(&system.graph, &[equations.energy])[0].value]);
    }
    let lines = system.lines("Hamilton's equations\n");
    check_by_coordinate(system, &lines, ("", 1), |sample, i| value(sample, Variable::Velocity(i)));
    check_by_coordinate(system, &lines, ("p_", 1), |sample, i| {
        let force = equations.constraint_force.get(i).copied().unwrap_or(Id::ZERO);
        let parts = sample.values(&system.graph, &[equations.momentum_rate[i], force]);
        parts[0].value + parts[1].value
    });
}

fn momentum(system: &Page, i: usize) -> String {
    format!("p_{}", system.problem.coordinates[i].text)
}

/// Checks the lines whose left side is a name formed from a coordinate or a vector of coordinates; skips others.
fn check_by_coordinate(
    system: &Page,
    lines: &[&str],
    (prefix, dots): (&str, usize),
    computed: impl Fn(&mut Sample, usize) -> f64,
) {
    let coordinates = system.problem.coordinates.iter();
    let names = coordinates.map(|label| Formula::labelled(&format!("{prefix}{}", label.text), dots));
    let names: Vec<Formula> = names.collect();
    for line in lines {
        let left = line.split(" = ").next().expect("a side");
        let is_it = |name: &Formula| {
            let written = |formula: &Formula| system.written(formula) == left;
            written(name) || outer(name).last().is_some_and(written)
        };
        let rows: Vec<usize> = (0..names.len()).filter(|&i| is_it(&names[i])).collect();
        if !rows.is_empty() {
            check_line(system, line, |sample| rows.iter().map(|&i| computed(sample, i)).collect());
        }
    }
}

/// Checks that the right side of a line has the computed value, within the rounding errors of both.
fn check_line(system: &Page, line: &str, computed: impl Fn(&mut Sample) -> Value) {
    let Some((_, text)) = line.split_once(" = ") else { return };
    let text = text.split("   (").next().expect("a formula");
    let mut states = 0;
    for draw in 0..STATES {
        let mut sample = system.sample(draw);
        let computed = computed(&mut sample);
        let read = State::new(system, &mut sample, draw).read(text);
        if !computed.iter().chain(&read).all(|x| x.is_finite()) {
            continue;
        }
        assert!(read.len() == computed.len() || read == [0.0], "{line} in {}", system.text);
        let read = read.into_iter().chain(std::iter::repeat(0.0));
        for (read, computed) in read.zip(computed) {
            let close = (read - computed).abs() <= CLOSE * (1.0 + computed.abs());
            assert!(close, "{line}: {read} is not {computed} in {}", system.text);
        }
        states += 1;
        if states == wanted() {
            return;
        }
    }
    assert!(states > 0, "no state for {text} in {}", system.text);
}

/// Checks all pages about a system.
pub(super) fn check(system: &System) {
    for [text, _, html] in &system.forms {
        let read = mathml::read(text, html);
        for (text, written) in [(text.clone(), systems::in_unicode as _), (read, mathml::written as _)] {
            let page = Page { system, text, written };
            check_axes(&page);
            links::check(&page);
            check_motion(&page);
            check_quantities(&page);
            check_hamilton(&page);
        }
    }
}

static OF_TESTS: LazyLock<Library> = LazyLock::new(|| Library::of(&["tests"], check));

static OF_EXAMPLES: LazyLock<Library> = LazyLock::new(|| {
    let folders = &[
        "examples",
        "lagrange-core/src",
        "lagrange-core/examples",
        "lagrange-core/benches",
        "lagrange-core/tests",
    ];
    Library::of(folders, check)
});

/// Pages about the systems of tests and examples.
pub(super) fn pages() -> impl Iterator<Item = &'static Forms> {
    OF_EXAMPLES.pages.iter().chain(&OF_TESTS.pages)
}

/// Checks all of these systems. There must be at least `least`, because a search that finds none checks nothing.
fn check_all(systems: &Library, least: usize) {
    assert!(systems.pages.len() >= least, "{} systems only", systems.pages.len());
    systems.pass();
}

#[test]
fn what_the_tests_print_is_what_is_computed() {
    check_all(&OF_TESTS, 400);
}

#[test]
fn what_the_examples_print_is_what_is_computed() {
    check_all(&OF_EXAMPLES, 1);
}

#[test]
fn what_the_pipeline_prints_is_what_is_computed() {
    check_all(&Library::of(&["lagrange-macros/src"], check), 50);
}
