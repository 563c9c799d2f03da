//! Random vectors and frame steps.

use super::draft::{Step, Term, Vector};
use super::pen::Pen;

impl Pen<'_> {
    /// A vector whose components refer to the axes of no frame.
    pub(super) fn vector(&mut self, depth: usize) -> Vector {
        let draft = self.draft;
        let Some(below) = depth.checked_sub(1) else { return self.entries(0) };
        let (triples, turns) = (draft.blocks(|length| length == 3), draft.blocks(|length| length == 4));
        match self.random.below(10) {
            0 | 1 if !triples.is_empty() && self.velocities => Vector::Velocity(self.random.one_of(&triples)),
            0..3 if !triples.is_empty() => Vector::Coordinate(self.random.one_of(&triples)),
            3 | 4 if !draft.vectors.is_empty() => Vector::Parameter(self.random.one_of(&draft.vectors)),
            5 => Vector::Sum(Box::new([self.vector(below), self.vector(below)])),
            6 => Vector::Scaled(Box::new((self.term(below), self.vector(below)))),
            7 => Vector::Cross(Box::new([self.vector(below), self.vector(below)])),
            8 if !turns.is_empty() => {
                Vector::Turned(self.random.one_of(&turns), Box::new(self.vector(below)))
            }
            9 if !draft.supplied.is_empty() => Vector::Supplied(1, Box::new(self.term(below))),
            _ => self.entries(below),
        }
    }

    fn entries(&mut self, depth: usize) -> Vector {
        Vector::Entries(Box::new(std::array::from_fn(|_| self.term(depth))))
    }

    /// A random frame, if expressions may refer to one.
    fn frame(&mut self) -> Option<usize> {
        let count = if self.placing || self.function { 0 } else { self.draft.frames.len() };
        (count > 0).then(|| self.random.below(count))
    }

    /// A vector along the axes of a frame.
    fn along(&mut self, frame: usize, depth: usize) -> Vector {
        let Some(below) = depth.checked_sub(1) else { return Vector::Along(frame, Box::new(self.vector(0))) };
        match self.random.below(6) {
            0 => Vector::Sum(Box::new([self.along(frame, below), self.along(frame, below)])),
            1 => {
                let other = self.random.below(self.draft.frames.len());
                Vector::Express(Box::new(self.along(other, below)), [other, frame])
            }
            2 if self.velocities => {
                // The point must not depend on velocities: its own velocity would contain accelerations, which a
                // force must not.
                self.velocities = false;
                let point = self.vector(below);
                self.velocities = true;
                Vector::Speed(frame, Box::new(point))
            }
            3 if self.velocities => Vector::Spin(frame),
            _ => Vector::Along(frame, Box::new(self.vector(below))),
        }
    }

    pub(super) fn dot(&mut self, depth: usize) -> Term {
        let vectors = match self.frame() {
            Some(frame) => [self.along(frame, depth), self.along(frame, depth)],
            None => [self.vector(depth), self.vector(depth)],
        };
        Term::Dot(Box::new(vectors))
    }

    pub(super) fn component(&mut self, depth: usize) -> Term {
        let vector = match self.frame() {
            Some(frame) if self.random.once_in(2) => Vector::Position(frame, Box::new(self.vector(depth))),
            Some(frame) => self.along(frame, depth),
            None => Vector::Cross(Box::new([self.vector(depth), self.vector(depth)])),
        };
        Term::Component(Box::new(vector), self.random.below(3))
    }

    pub(super) fn step(&mut self) -> Step {
        let turns = self.draft.blocks(|length| length == 4);
        match self.random.below(6) {
            0 if !turns.is_empty() => Step::Quaternion(self.random.one_of(&turns)),
            0 | 1 => Step::Translate(self.vector(1)),
            2 | 3 => Step::About(self.random.below(3), self.term(1)),
            4 => {
                let axis = Box::new([self.positive(0), self.bounded(0), self.bounded(0)]);
                Step::Rotate(Vector::Entries(axis), self.term(1))
            }
            _ => Step::About(self.random.below(3), Term::Coordinate(self.random.below(self.draft.count))),
        }
    }
}
