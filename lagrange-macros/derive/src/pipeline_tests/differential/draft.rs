//! A random system: its parts, and its source text.

use crate::symbolic::Function;

/// A random system, as a list of its parts.
#[derive(Default)]
pub(super) struct Draft {
    /// Name and length of each coordinate.
    pub(super) coordinates: Vec<(String, usize)>,
    pub(super) count: usize,
    /// Numbers of the fields, as expressions name them. `scalars` are the indices of those that are no entries of a
    /// vector or matrix.
    pub(super) names: Vec<String>,
    pub(super) scalars: Vec<usize>,
    /// Vectors and inertias, each by the index of its first number.
    pub(super) vectors: Vec<usize>,
    pub(super) inertias: Vec<usize>,
    pub(super) fields: Vec<String>,
    /// Body of each definition; true for a function of one argument.
    pub(super) definitions: Vec<(Term, bool)>,
    pub(super) supplied: Vec<Supplied>,
    pub(super) frames: Vec<Frame>,
    /// Head of each frame declaration, before the steps, and index of its frame. A head may declare a family.
    pub(super) placed: Vec<(String, usize)>,
    /// Further attributes, as source text.
    pub(super) attributes: Vec<String>,
    /// Integers that index a coordinate, each below its length.
    pub(super) table: Vec<usize>,
    pub(super) lagrangian: Vec<Term>,
    pub(super) dissipation: Option<Term>,
    pub(super) forces: Vec<(usize, Term)>,
    /// Left side of each constraint, equal to 0; true for a velocity constraint.
    pub(super) constraints: Vec<(Term, bool)>,
    /// Number of constraints, the last ones, that quaternions imply and the source does not contain.
    pub(super) implied: usize,
}

/// A user-supplied function, of s or of s and r.
pub(super) struct Supplied {
    pub(super) results: Vec<Term>,
}

/// A random scalar expression.
#[derive(Clone, Debug)]
pub(super) enum Term {
    Number(&'static str, i128, i128),
    Pi,
    Time,
    /// Index of a sum or of a family.
    Index,
    /// Argument of a function, by its position.
    Argument(usize),
    Coordinate(usize),
    Velocity(usize),
    Parameter(usize),
    /// Entry `pick[i]` of the coordinate that begins at this index.
    Picked(usize),
    /// An earlier definition.
    Defined(usize),
    Applied(usize, Box<Self>),
    /// A user-supplied function.
    Supplied(usize, Box<[Self; 2]>),
    Negative(Box<Self>),
    Binary(char, Box<[Self; 2]>),
    /// A constant power, by numerator and denominator.
    Power(Box<Self>, i128, i128),
    /// A power of a positive base with any exponent.
    Exponential(Box<[Self; 2]>),
    Function(Function, Box<Self>),
    Sqrt(Box<Self>),
    Atan2(Box<[Self; 2]>),
    Dot(Box<[Vector; 2]>),
    Norm(Box<Vector>),
    Component(Box<Vector>, usize),
    /// Kinetic energy: frame, mass and centre, and index of the first number of the inertia.
    Kinetic(usize, Box<(Self, Vector)>, usize),
    Sum(usize, Box<Self>),
    Der(Box<Self>),
}

/// Operator precedence. An operand of lower precedence than needed is written in parentheses.
pub(super) const SUM: u8 = 1;
pub(super) const PRODUCT: u8 = 2;
pub(super) const SIGN: u8 = 3;
pub(super) const POWER: u8 = 4;
pub(super) const ATOM: u8 = 5;

/// A random expression for a vector of three.
#[derive(Clone, Debug)]
pub(super) enum Vector {
    Entries(Box<[Term; 3]>),
    /// A coordinate, by the index of its first entry.
    Coordinate(usize),
    Velocity(usize),
    /// A field or a member of one, by the index of its first number.
    Parameter(usize),
    Sum(Box<[Self; 2]>),
    Scaled(Box<(Term, Self)>),
    Cross(Box<[Self; 2]>),
    /// Rotation by a coordinate that is a quaternion.
    Turned(usize, Box<Self>),
    Supplied(usize, Box<Term>),
    Der(Box<Self>),
    /// Position of a point of a frame, along the fixed axes. The variants below are along the axes of the frame.
    Position(usize, Box<Self>),
    Speed(usize, Box<Self>),
    Spin(usize),
    Along(usize, Box<Self>),
    /// Components along the axes of the second frame, from those along the first.
    Express(Box<Self>, [usize; 2]),
}

/// A step from one frame to the next.
#[derive(Clone, Debug)]
pub(super) enum Step {
    Translate(Vector),
    /// Rotation about a coordinate axis, by the number of the axis.
    About(usize, Term),
    Rotate(Vector, Term),
    /// Rotation by a coordinate that is a quaternion.
    Quaternion(usize),
}

#[derive(Clone, Debug)]
pub(super) struct Frame {
    pub(super) name: String,
    pub(super) parent: Option<usize>,
    pub(super) steps: Vec<Step>,
    /// Index of the frame in its family, or 0.
    pub(super) index: usize,
}

impl Draft {
    pub(super) fn coordinate(&self, i: usize, suffix: &str) -> String {
        let mut rest = i;
        for (name, length) in &self.coordinates {
            match length {
                1 if rest == 0 => return format!("{name}{suffix}"),
                _ if rest < *length => return format!("{name}{suffix}[{rest}]"),
                _ => rest -= length,
            }
        }
        unreachable!("there is no coordinate {i}")
    }

    /// Name of a coordinate of several numbers, by the index of the first.
    pub(super) fn block(&self, first: usize, suffix: &str) -> String {
        self.coordinate(first, suffix).trim_end_matches("[0]").to_owned()
    }

    /// Name of a field or member of several numbers, by the index of the first.
    pub(super) fn whole(&self, first: usize) -> String {
        self.names[first].trim_end_matches("[0]").to_owned()
    }

    /// Indices of the first entries of all coordinates whose length satisfies `of`.
    pub(super) fn blocks(&self, of: impl Fn(usize) -> bool) -> Vec<usize> {
        let firsts = self.coordinates.iter().scan(0, |next, (_, length)| {
            *next += length;
            Some((*next - length, *length))
        });
        firsts.filter(|&(_, length)| of(length)).map(|(first, _)| first).collect()
    }

    pub(super) fn source(&self) -> String {
        let coordinates = self.coordinates.iter().map(|(name, length)| match length {
            1 => name.clone(),
            _ => format!("{name}: [{length}]"),
        });
        let mut attributes = vec![format!("coordinates({})", coordinates.collect::<Vec<_>>().join(", "))];
        attributes.extend(self.attributes.iter().cloned());
        for (k, (term, is_function)) in self.definitions.iter().enumerate() {
            let argument = if *is_function { "(s)" } else { "" };
            attributes.push(format!("define(d{k}{argument} = {})", term.text(self)));
        }
        let steps = |k: &usize| self.frames[*k].steps.iter().map(|step| step.text(self)).collect::<Vec<_>>();
        let placed = self.placed.iter();
        attributes.extend(placed.map(|(head, k)| format!("frame({head}: {})", steps(k).join(", "))));
        let terms: Vec<String> = self.lagrangian.iter().map(|term| term.text(self)).collect();
        attributes.push(format!("lagrangian({})", terms.join(" + ")));
        attributes.extend(self.dissipation.iter().map(|term| format!("dissipation({})", term.text(self))));
        for (i, term) in &self.forces {
            attributes.push(format!("force({}: {})", self.coordinate(*i, ""), term.text(self)));
        }
        let written = self.constraints.iter().take(self.constraints.len() - self.implied);
        for (k, (term, _)) in written.enumerate() {
            attributes.push(format!("constraint(c{k}: {} = 0)", term.text(self)));
        }
        let attributes: String = attributes.iter().map(|text| format!("#[{text}]\n")).collect();
        format!("{attributes}struct Random {{ {} }}", self.fields.join(", "))
    }
}
