//! Printed equations agree with the computed ones. For every system that any test, example or page of documentation
//! derives, the equations are read from the text and compared with the graph at random states.

mod checks;
mod links;
mod potential;
mod state;
mod turns;

use std::ops::Deref;
use std::sync::LazyLock;

use super::mathml;
use super::reader::Value;
use super::systems::{self, Forms, Library, System};
use crate::render::formula::Formula;
use crate::render::letters::PageQuantity;
use crate::symbolic::{Approximate, Id, Sample};
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
    /// True for the plain text. Running indices are read there alone: what other forms spell has the same symbols.
    is_plain: bool,
    /// Writes a name as `text` spells it.
    written: fn(&System, &Formula) -> String,
}

impl Deref for Page<'_> {
    type Target = System;

    fn deref(&self) -> &System {
        self.system
    }
}

impl Page<'_> {
    fn written(&self, formula: &Formula) -> String {
        (self.written)(self.system, formula)
    }

    /// Lines below a heading.
    fn lines(&self, heading: &str) -> Vec<&str> {
        let section = self.text.split("\n\n").find(|section| section.starts_with(heading));
        let lines = section.into_iter().flat_map(|section| section.lines().skip(1));
        lines.map(str::trim).filter(|line| line.contains(" = ") || line.contains("symbols)")).collect()
    }
}

fn value(sample: &Sample, variable: Variable) -> f64 {
    sample.get(variable.symbol()).value
}

fn momentum(system: &Page, i: usize) -> String {
    system.letters.text_of(PageQuantity::Momentum, &system.problem.coordinates[i].text)
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

/// Checks all pages about a system.
pub(super) fn check(system: &System) {
    for [text, _, html] in &system.forms {
        let read = mathml::read(text, html);
        let forms = [(text.clone(), systems::in_unicode as _, true), (read, mathml::written as _, false)];
        for (text, written, is_plain) in forms {
            let page = Page { system, text, is_plain, written };
            checks::check_axes(&page);
            links::check(&page);
            potential::check(&page);
            checks::check_motion(&page);
            checks::check_quantities(&page);
            checks::check_multipliers(&page);
            checks::check_totals(&page);
            checks::check_hamilton(&page);
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

/// Checks these systems. A search that finds no systems would check nothing: all files together have at least `least`, and
/// the files that were read at least half of their share.
fn check_all(systems: &Library, least: usize) {
    assert!(systems.pages.len() >= least / (2 * systems::share()), "{} systems only", systems.pages.len());
    systems.pass();
}

#[test]
fn what_the_tests_print_is_what_is_computed() {
    check_all(&OF_TESTS, 250);
}

#[test]
fn what_the_examples_print_is_what_is_computed() {
    check_all(&OF_EXAMPLES, 1);
}

#[test]
fn what_the_pipeline_prints_is_what_is_computed() {
    check_all(&Library::of(&["lagrange-macros/derive/src"], check), 50);
}
