//! Printed lines against computed values, at states of their own.

use std::ops::Range;

use lagrange_random::cases;

use super::state::State;
use super::{Page, links, outer, turns, value};
use crate::mechanics::{ConservedKind, Derived, Moment, Moments, Symmetry};
use crate::render::axes::named_axes;
use crate::render::formula::Formula;
use crate::render::letters::PageQuantity;
use crate::render::notation::Notation;
use crate::render::tests::reader::Value;
use crate::symbolic::{Id, Sample};
use crate::variables::Variable;

const STATES: u64 = 40;
/// Tolerance relative to the greatest of the compared values.
const CLOSE: f64 = 1e-8;

/// Number of states at which printed lines are compared with computed values. One state tells two different formulas
/// apart; at more states, functions such as `max` take more of their branches.
fn wanted() -> usize {
    cases([1, 1, 8])
}

/// Checks that each row, or vector of rows, is proportional to the computed one in accelerations and multipliers: the
/// printed row may be divided by a factor. Each coordinate has one row.
pub(super) fn check_motion(system: &Page) {
    let mut is_read = vec![false; system.derived.inertia.len()];
    let mut read = |rows: Range<usize>| {
        for row in rows {
            assert!(!is_read[row], "row {row} twice in {}", system.text);
            is_read[row] = true;
        }
        is_read.iter().position(|is_read| !is_read)
    };
    let mut first = read(0..0);
    let mut lines = system.lines("Equations of motion\n").into_iter().peekable();
    while let Some(&row) = lines.peek() {
        if let Some(turning) = system.derived.turnings.all.iter().find(|turning| Some(turning.first) == first)
        {
            turns::check(system, turning, &mut lines);
            first = read(turning.first..turning.first + 4);
            continue;
        }
        lines.next();
        if links::is_resultant(system, row) {
            continue;
        }
        let (label, equation) = row.split_once(": ").expect("a label");
        for (label, index) in elements(row, label) {
            let rows = rows_of(system, &label);
            check_element(system, rows.clone(), index.as_ref(), equation);
            first = read(rows);
        }
    }
    assert_eq!(first, None, "{}", system.text);
}

/// Coordinates of a row with this label: one, or those of a vector.
fn rows_of(system: &Page, label: &str) -> Range<usize> {
    let labels = system.problem.coordinates.iter();
    let labels = labels.map(|label| Notation::UNICODE.write(&Formula::labelled(&label.text, 0)));
    let is_it = |known: &String| {
        let index = known.strip_prefix(label).and_then(|rest| rest.strip_prefix('['));
        known == label || index.is_some_and(|index| index.matches(']').count() == 1)
    };
    let mut labels = labels.enumerate().skip_while(|(_, known)| !is_it(known)).peekable();
    let first = labels.peek().map(|(first, _)| *first);
    let first = first.unwrap_or_else(|| panic!("{label} has no coordinate in {}", system.text));
    first..first + labels.take_while(|(_, known)| is_it(known)).count()
}

fn check_element(system: &Page, rows: Range<usize>, index: Option<&RunningIndex>, equation: &str) {
    let equation = equation.split("   (").next().unwrap_or_default().trim();
    let has_running = index.is_some() || equation.contains('Σ') || equation.contains('∑');
    if let Some((left, right)) = equation.split_once(" = ").filter(|_| system.is_plain || !has_running) {
        let computed = |sample: &mut Sample| left_over(system, sample, rows.clone());
        check_sides(system, rows.len(), ([left, right], index), computed);
    }
}

/// Name and value of a running index.
type RunningIndex = (String, i64);

/// Names of the elements that a line is about, `(for i = 1 … 30)`, with the running index.
fn elements(line: &str, name: &str) -> Vec<(String, Option<RunningIndex>)> {
    let running = || {
        let (_, range) = line.split_once("   (for ")?;
        let (index, range) = range.split(')').next()?.split_once(" = ")?;
        let (from, to) = range.split_once(" … ")?;
        let values = from.parse().ok()?..=to.parse().ok()?;
        let at = |value| {
            let name = name.replace(&format!("[{index}]"), &format!("[{value}]"));
            (name, Some((index.to_owned(), value)))
        };
        Some(values.map(at).collect())
    };
    running().unwrap_or_else(|| vec![(name.to_owned(), None)])
}

pub(super) fn check_sides(
    system: &Page,
    count: usize,
    (sides, index): ([&str; 2], Option<&RunningIndex>),
    computed: impl Fn(&mut Sample) -> Vec<f64>,
) {
    let mut states = 0;
    for draw in 0..STATES {
        let mut sample = system.sample(draw);
        let moved = (0..3).flat_map(|other| {
            system.moved(&mut sample, 1000 * (other + 1) + draw);
            let left_over = computed(&mut sample);
            let state = State::new(system, &mut sample, draw);
            let [left, right] = sides.map(|side| state.read_at(side, index));
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
pub(super) fn left_over(system: &Page, sample: &mut Sample, rows: Range<usize>) -> Vec<f64> {
    let Derived { equations, inertia, .. } = &system.derived;
    let row = |i: usize| {
        let force = equations.constraint_force.get(i).copied().unwrap_or(Id::ZERO);
        let parts = sample.values(&system.graph, &[inertia[i], equations.forcing[i], force]);
        parts[0].value - parts[1].value - parts[2].value
    };
    rows.map(row).collect()
}

/// Checks the rotation matrices against those of the quaternions.
pub(super) fn check_axes(system: &Page) {
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
pub(super) fn check_quantities(system: &Page) {
    let equations = &system.derived.equations;
    let conserved = system.lines("Conserved\n");
    let energy = system.lines("Energy\n");
    let name = system.written(&system.letters.name(PageQuantity::Energy));
    let [energy_is, rate_is] = [format!("{name} = "), format!("d/dt {name} = ")];
    for line in conserved.iter().chain(&energy).filter(|line| line.starts_with(&energy_is)) {
        check_line(system, line, |sample| vec![sample.values(&system.graph, &[equations.energy])[0].value]);
    }
    for line in energy.iter().filter(|line| line.starts_with(&rate_is)) {
        check_line(system, line, |sample| {
            vec![sample.values(&system.graph, &[system.derived.facts.energy_rate])[0].value]
        });
    }
    let value = |sample: &mut Sample, root: Option<&Id>| {
        root.map_or(0.0, |&root| sample.values(&system.graph, &[root])[0].value)
    };
    check_by_coordinate(
        system,
        &system.lines("Constraint forces\n"),
        (Some(PageQuantity::ConstraintForce), 0),
        |sample, i| value(sample, equations.constraint_force.get(i)),
    );
    for lines in [conserved, system.lines("Momenta\n")] {
        check_by_coordinate(system, &lines, (Some(PageQuantity::Momentum), 0), |sample, i| {
            value(sample, equations.momentum.get(i))
        });
    }
}

/// Checks the momentum and angular momentum of all vectors against the computed ones.
pub(super) fn check_totals(system: &Page) {
    let quantities = [
        (Symmetry::Translation, PageQuantity::TotalMomentum),
        (Symmetry::Rotation, PageQuantity::AngularMomentum),
    ];
    for (symmetry, quantity) in quantities {
        let totals = system.derived.facts.conserved.iter().filter_map(|conserved| match conserved.quantity {
            ConservedKind::Total(of, component, [value, _]) if of == symmetry => Some((component, value)),
            _ => None,
        });
        let totals: Vec<(Option<usize>, Id)> = totals.collect();
        let letter = system.letters.letter(quantity);
        for line in system.lines("Conserved\n") {
            let left = line.split(" = ").next().expect("a side");
            let names = |component: Option<usize>| {
                let element = component.map(|k| format!("{letter}[{k}]"));
                let mut names = element.into_iter().chain([letter.to_owned()]);
                names.any(|name| system.written(&Formula::labelled(&name, 0)) == left)
            };
            let values: Vec<Id> =
                totals.iter().filter(|(component, _)| names(*component)).map(|(_, value)| *value).collect();
            if !values.is_empty() {
                check_line(system, line, |sample| {
                    sample.values(&system.graph, &values).iter().map(|value| value.value).collect()
                });
            }
        }
    }
}

/// Checks multipliers against those that solve the equations of motion at states on the constraints.
pub(super) fn check_multipliers(system: &Page) {
    let labels = system.problem.constraints.iter().enumerate();
    let names: Vec<(usize, Formula)> =
        labels.map(|(a, (label, _))| (a, Formula::Multiplier(label.text.clone()))).collect();
    let moments = Moments::new(&system.problem, &system.derived.equations, false);
    for line in system.lines("Constraint forces\n") {
        let left = line.split(" = ").next().expect("a side");
        let is_it = |name: &Formula| {
            system.written(name) == left || outer(name).iter().any(|name| system.written(name) == left)
        };
        let rows: Vec<usize> = names.iter().filter(|(_, name)| is_it(name)).map(|(a, _)| *a).collect();
        if !rows.is_empty() {
            check_line_at(system, (line, None), |draw| {
                let Moment(sample) = Moment::drawn(&system.graph, &moments, draw)?;
                let values = rows.iter().map(|&a| value(&sample, Variable::Multiplier(a))).collect();
                Some((sample, values))
            });
        }
    }
}

/// Checks that at p = ∂L/∂q̇ of a state, H is the energy, ∂H/∂p the velocity and ṗ the forces.
pub(super) fn check_hamilton(system: &Page) {
    let equations = &system.derived.equations;
    for line in system.lines("Hamiltonian\n") {
        check_line(system, line, |sample| vec![sample.values(&system.graph, &[equations.energy])[0].value]);
    }
    let lines = system.lines("Hamilton's equations\n");
    check_by_coordinate(system, &lines, (None, 1), |sample, i| value(sample, Variable::Velocity(i)));
    check_by_coordinate(system, &lines, (Some(PageQuantity::Momentum), 1), |sample, i| {
        let force = equations.constraint_force.get(i).copied().unwrap_or(Id::ZERO);
        let parts = sample.values(&system.graph, &[equations.momentum_rate[i], force]);
        parts[0].value + parts[1].value
    });
}

/// Checks the lines whose left side is a name formed from a coordinate or a vector of coordinates; skips others.
fn check_by_coordinate(
    system: &Page,
    lines: &[&str],
    (quantity, dots): (Option<PageQuantity>, usize),
    computed: impl Fn(&mut Sample, usize) -> f64,
) {
    let coordinates = system.problem.coordinates.iter();
    let names = coordinates.map(|label| match quantity {
        Some(quantity) => system.letters.name_of(quantity, &label.text, dots),
        None => Formula::labelled(&label.text, dots),
    });
    let names: Vec<Formula> = names.collect();
    for line in lines {
        let left = line.split(" = ").next().expect("a side");
        let elements =
            elements(line, left).into_iter().filter(|(_, index)| system.is_plain || index.is_none());
        for (left, index) in elements {
            let is_it = |name: &Formula| {
                let written = |formula: &Formula| system.written(formula) == left;
                written(name) || outer(name).last().is_some_and(written)
            };
            let rows: Vec<usize> = (0..names.len()).filter(|&i| is_it(&names[i])).collect();
            if !rows.is_empty() {
                check_element_of_line(system, line, index.as_ref(), |sample| {
                    rows.iter().map(|&i| computed(sample, i)).collect()
                });
            }
        }
    }
}

/// Checks that the right side of a line has the computed value, within the rounding errors of both.
pub(super) fn check_line(system: &Page, line: &str, computed: impl Fn(&mut Sample) -> Value) {
    check_element_of_line(system, line, None, computed);
}

/// The same for a value of a running index.
fn check_element_of_line(
    system: &Page,
    line: &str,
    index: Option<&RunningIndex>,
    computed: impl Fn(&mut Sample) -> Value,
) {
    check_line_at(system, (line, index), |draw| {
        let mut sample = system.sample(draw);
        let computed = computed(&mut sample);
        Some((sample, computed))
    });
}

/// The same at states that are given with their values.
fn check_line_at(
    system: &Page,
    (line, index): (&str, Option<&RunningIndex>),
    state: impl Fn(u64) -> Option<(Sample, Value)>,
) {
    let Some((_, text)) = line.split_once(" = ") else { return };
    if !system.is_plain && (text.contains('Σ') || text.contains('∑')) {
        return;
    }
    let text = text.split("   (").next().expect("a formula");
    let mut states = 0;
    for draw in 0..STATES {
        let Some((mut sample, computed)) = state(draw) else { continue };
        let read = State::new(system, &mut sample, draw).read_at(text, index);
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
