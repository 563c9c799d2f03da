//! Draws a random system. M is always definite, and every function is smooth where it is evaluated.

use super::draft::{Draft, Frame, Step, Supplied, Term, Vector};
use super::pen::{Pen, binary, function, half, negative, number, power};
use crate::symbolic::Function;
use lagrange_random::Random;

impl Draft {
    pub(super) fn new(random: &mut Random) -> Self {
        let mut draft = Self::default();
        let is_moving = random.once_in(3);
        for k in 0..1 + random.below(if is_moving { 1 } else { 2 }) {
            draft.add_coordinate(format!("q{k}"), 1 + random.below(3));
        }
        draft.add_fields(random);
        if is_moving {
            draft.add_bodies(random);
        }
        for _ in 0..random.below(3) {
            let is_function = random.once_in(2);
            let mut pen = draft.pen(random);
            pen.function = is_function;
            let term = pen.term(2);
            draft.definitions.push((term, is_function));
        }
        if is_moving {
            draft.place(random);
        }
        draft.lagrangian = draft.kinetic(random);
        for _ in 0..1 + random.below(2) {
            let term = draft.pen(random).term(3);
            draft.lagrangian.push(negative(term));
        }
        draft.act(random);
        let first = random.below(draft.count);
        let turned = draft.turned();
        for k in 0..random.below((draft.count - turned.len()).min(3)) {
            let constraint = draft.constraint((first + k) % draft.count, random);
            draft.constraints.push(constraint);
        }
        draft.implied = turned.len();
        draft.constraints.extend(turned.into_iter().map(|first| (unit(first), false)));
        draft
    }

    fn add_coordinate(&mut self, name: String, length: usize) {
        self.coordinates.push((name, length));
        self.count += length;
    }

    /// Adds scalar fields; a vector, functions and a table to some systems.
    fn add_fields(&mut self, random: &mut Random) {
        for k in 0..2 + random.below(3) {
            self.scalars.push(self.names.len());
            self.names.push(format!("p{k}"));
            self.fields.push(format!("p{k}: f64"));
        }
        if random.once_in(2) {
            self.vectors.push(self.names.len());
            self.names.extend((0..3).map(|k| format!("a[{k}]")));
            self.fields.push("a: [f64; 3]".to_owned());
        }
        if random.once_in(2) {
            self.supplied = supplied();
            self.attributes.push("function(u0(s, r) = first)".to_owned());
            self.attributes.push("function(u1(s): [3] = second)".to_owned());
            self.fields.push("first: First, second: Second".to_owned());
        }
        if let Some(length) =
            self.coordinates.iter().map(|(_, length)| *length).filter(|&length| length > 1).min()
        {
            self.table = (0..3).map(|_| random.below(length)).collect();
            self.attributes.push(format!("define(pick = {:?})", self.table));
        }
    }

    /// Adds two bodies as an array of structs, and to some systems a quaternion that may rotate a frame.
    fn add_bodies(&mut self, random: &mut Random) {
        if random.once_in(2) {
            self.add_coordinate("turn".to_owned(), 4);
        }
        for body in 0..2 {
            self.scalars.push(self.names.len());
            self.names.push(format!("body[{body}].m"));
            self.vectors.push(self.names.len());
            self.names.extend((0..3).map(|k| format!("body[{body}].c[{k}]")));
            self.inertias.push(self.names.len());
            self.names.extend((0..9).map(|k| format!("body[{body}].I[{}][{}]", k / 3, k % 3)));
        }
        self.fields.push("body: [Body; 2]".to_owned());
        self.attributes.push("parameter(body: [2] {m, c: [3], I: symmetric})".to_owned());
    }

    /// Adds one or two frames, or a tree of three.
    fn place(&mut self, random: &mut Random) {
        if random.once_in(2) {
            for k in 0..1 + random.below(2) {
                let parent = (k > 0 && !random.once_in(4)).then_some(0);
                let head = if parent.is_some() { format!("f{k} in f0") } else { format!("f{k}") };
                self.place_one(format!("f{k}"), parent, random);
                self.placed.push((head, k));
            }
            return;
        }
        let parents = [0, 0, random.below(2)];
        self.attributes.push(format!("define(parent = {parents:?})"));
        self.place_one("part[0]".to_owned(), None, random);
        self.placed.push(("part[0]".to_owned(), 0));
        let mut pen = self.pen(random);
        (pen.index, pen.placing) = (true, true);
        let steps = vec![pen.step(), pen.step()];
        for (index, parent) in parents.into_iter().enumerate().skip(1) {
            let (name, steps) = (format!("part[{index}]"), steps.clone());
            self.frames.push(Frame { name, parent: Some(parent), steps, index });
        }
        self.placed.push(("part[i in 1..3] in part[parent[i]]".to_owned(), 1));
    }

    fn place_one(&mut self, name: String, parent: Option<usize>, random: &mut Random) {
        let mut pen = self.pen(random);
        pen.placing = true;
        let steps = (0..1 + pen.random.below(2)).map(|_| pen.step()).collect();
        self.frames.push(Frame { name, parent, steps, index: 0 });
    }

    /// Quaternions that rotate a frame, each by the index of its first entry.
    fn turned(&self) -> Vec<usize> {
        let steps = || self.frames.iter().flat_map(|frame| &frame.steps);
        let is_turning =
            |first: &usize| steps().any(|step| matches!(step, Step::Quaternion(i) if i == first));
        self.blocks(|length| length == 4).into_iter().filter(is_turning).collect()
    }

    fn pen<'d>(&'d self, random: &'d mut Random) -> Pen<'d> {
        Pen { draft: self, random, function: false, velocities: false, index: false, placing: false }
    }

    /// Kinetic energy: squares of the velocities, each with some of the earlier ones, so that M is definite.
    /// Further terms either add to M or are linear in the velocities.
    fn kinetic(&self, random: &mut Random) -> Vec<Term> {
        let mut terms = Vec::new();
        for i in 0..self.count {
            let mut speed = Term::Velocity(i);
            for j in 0..i {
                if random.once_in(3) {
                    let slope = self.pen(random).bounded(2);
                    speed = binary('+', speed, binary('*', slope, Term::Velocity(j)));
                }
            }
            let mass = if random.once_in(3) { self.pen(random).positive(2) } else { Term::Parameter(0) };
            terms.push(half(binary('*', mass, power(speed, 2, 1))));
        }
        for k in 0..self.frames.len() {
            let (mut pen, body) = (self.pen(random), k % 2);
            let (mass, centre) = (Term::Parameter(self.inertias[body] - 4), pen.vector(1));
            terms.push(match pen.random.below(3) {
                0 => continue,
                1 => Term::Kinetic(k, Box::new((mass, centre)), self.inertias[body]),
                _ => {
                    let speed = Vector::Speed(k, Box::new(centre));
                    binary('*', mass, Term::Dot(Box::new([speed.clone(), speed])))
                }
            });
        }
        let i = random.below(self.count);
        terms.extend(match random.below(7) {
            0 => Some(power(Term::Der(Box::new(self.pen(random).bounded(2))), 2, 1)),
            1 => Some(Term::Der(Box::new(self.pen(random).term(2)))),
            4 => {
                let rate = Vector::Der(Box::new(self.pen(random).vector(2)));
                Some(Term::Dot(Box::new([rate.clone(), rate])))
            }
            2 => Some(binary('*', self.pen(random).bounded(2), Term::Velocity(i))),
            3 => Some(Term::Sqrt(Box::new(binary(
                '+',
                Term::Number("1", 1, 1),
                power(Term::Velocity(i), 2, 1),
            )))),
            _ => None,
        });
        terms
    }

    fn act(&mut self, random: &mut Random) {
        for i in 0..self.count {
            if random.once_in(4) {
                let mut pen = self.pen(random);
                pen.velocities = true;
                let force = pen.term(2);
                self.forces.push((i, force));
            }
        }
        if random.once_in(3) {
            let speed = Term::Velocity(random.below(self.count));
            let drag = binary('*', self.pen(random).positive(1), power(speed, 2, 1));
            self.dissipation = Some(drag);
        }
    }

    /// A constraint on coordinates, or linear in the velocities. Each has a coordinate of its own, so none follows
    /// from another.
    fn constraint(&self, i: usize, random: &mut Random) -> (Term, bool) {
        let of_velocities = random.once_in(2);
        let own = if of_velocities { Term::Velocity(i) } else { Term::Coordinate(i) };
        let mut term = binary('*', Term::Parameter(random.one_of(&self.scalars)), own);
        for j in 0..self.count {
            if j != i && random.once_in(2) {
                let factor = self.pen(random).bounded(1);
                let other = if of_velocities { Term::Velocity(j) } else { Term::Coordinate(j) };
                term = binary('+', term, binary('*', factor, other));
            }
        }
        let rest = self.pen(random).bounded(2);
        (binary('-', term, rest), of_velocities)
    }

    /// Draws a time, coordinates, velocities and parameters.
    pub(super) fn numbers(&self, random: &mut Random) -> (f64, [Vec<f64>; 3]) {
        let mut several =
            |count, low, high| (0..count).map(|_| random.between(low, high)).collect::<Vec<_>>();
        let mut numbers = [
            several(self.count, -1.5, 1.5),
            several(self.count, -1.5, 1.5),
            several(self.names.len(), 0.5, 2.0),
        ];
        for (first, (i, j)) in
            self.inertias.iter().flat_map(|&first| [(0, 1), (0, 2), (1, 2)].map(|at| (first, at)))
        {
            let product = random.between(-0.2, 0.2);
            (numbers[2][first + 3 * i + j], numbers[2][first + 3 * j + i]) = (product, product);
        }
        (random.between(0.0, 2.0), numbers)
    }
}

/// q·q − 1
fn unit(first: usize) -> Term {
    let squares = (first..first + 4).map(|i| power(Term::Coordinate(i), 2, 1));
    squares.fold(negative(number("1", 1, 1)), |sum, square| binary('+', sum, square))
}

fn supplied() -> Vec<Supplied> {
    let (s, r) = (Term::Argument(0), Term::Argument(1));
    let of = |name, x: &Term| function(name, x.clone());
    let times = |x: &Term, y: &Term| binary('*', x.clone(), y.clone());
    let first = binary('+', times(&of(Function::Sin, &s), &r), half(of(Function::Cos, &times(&s, &r))));
    let second = vec![of(Function::Sin, &s), times(&s, &of(Function::Cos, &s)), of(Function::Atan, &s)];
    vec![Supplied { results: vec![first] }, Supplied { results: second }]
}
