//! A system at random: what it is made of, and how it is written.

use crate::symbolic::Function;

/// A system as it is drawn.
#[derive(Default)]
pub(super) struct Draft {
    /// Names and how many numbers they are of.
    pub(super) coordinates: Vec<(String, usize)>,
    pub(super) count: usize,
    /// The numbers of the fields, as expressions name them, and those among them that may stand alone.
    pub(super) names: Vec<String>,
    pub(super) scalars: Vec<usize>,
    /// Vectors and inertias, by their first numbers.
    pub(super) vectors: Vec<usize>,
    pub(super) inertias: Vec<usize>,
    pub(super) fields: Vec<String>,
    /// A value, or a function of one argument.
    pub(super) definitions: Vec<(Term, bool)>,
    pub(super) supplied: Vec<Supplied>,
    pub(super) frames: Vec<Frame>,
    /// What stands before the steps of a frame in its declaration, which may be that of a family.
    pub(super) placed: Vec<(String, usize)>,
    /// Those that are written as they are.
    pub(super) attributes: Vec<String>,
    /// Whole numbers below the length of the coordinate that is picked from.
    pub(super) table: Vec<usize>,
    pub(super) lagrangian: Vec<Term>,
    pub(super) dissipation: Option<Term>,
    pub(super) forces: Vec<(usize, Term)>,
    /// Whether it constrains velocities.
    pub(super) constraints: Vec<(Term, bool)>,
    /// So many of them, the last ones, come with quaternions.
    pub(super) implied: usize,
}

/// A function that is not written in the language, of s or of s and r.
pub(super) struct Supplied {
    pub(super) results: Vec<Term>,
}

/// What is written at random.
#[derive(Clone, Debug)]
pub(super) enum Term {
    Number(&'static str, i128, i128),
    Pi,
    Time,
    /// The number of an index.
    Index,
    /// What a function is given.
    Argument(usize),
    Coordinate(usize),
    Velocity(usize),
    Parameter(usize),
    /// An entry of the coordinate that begins there, by the table of whole numbers.
    Picked(usize),
    /// A definition before this.
    Defined(usize),
    Applied(usize, Box<Self>),
    /// A function that is not written in the language.
    Supplied(usize, Box<[Self; 2]>),
    Negative(Box<Self>),
    Binary(char, Box<[Self; 2]>),
    /// To a fixed power.
    Power(Box<Self>, i128, i128),
    /// To any power, of what is positive.
    Exponential(Box<[Self; 2]>),
    Function(Function, Box<Self>),
    Sqrt(Box<Self>),
    Atan2(Box<[Self; 2]>),
    Dot(Box<[Vector; 2]>),
    Norm(Box<Vector>),
    Component(Box<Vector>, usize),
    /// Of a frame: mass, centre, and the first number of the inertia.
    Kinetic(usize, Box<(Self, Vector)>, usize),
    Sum(usize, Box<Self>),
    Der(Box<Self>),
}

/// Where in the order of operations what is written stands: it takes parentheses where more is needed.
pub(super) const SUM: u8 = 1;
pub(super) const PRODUCT: u8 = 2;
pub(super) const SIGN: u8 = 3;
pub(super) const POWER: u8 = 4;
pub(super) const ATOM: u8 = 5;

/// A vector of three, written at random.
#[derive(Clone, Debug)]
pub(super) enum Vector {
    Entries(Box<[Term; 3]>),
    /// A coordinate, by its first entry.
    Coordinate(usize),
    Velocity(usize),
    /// A field or a member of one, by its first number.
    Parameter(usize),
    Sum(Box<[Self; 2]>),
    Scaled(Box<(Term, Self)>),
    Cross(Box<[Self; 2]>),
    /// By a coordinate that is a quaternion.
    Turned(usize, Box<Self>),
    Supplied(usize, Box<Term>),
    Der(Box<Self>),
    /// Where a point of a frame is, along the fixed axes; the others are along those of the frame.
    Position(usize, Box<Self>),
    Speed(usize, Box<Self>),
    Spin(usize),
    Along(usize, Box<Self>),
    /// From the axes of one frame to those of another.
    Express(Box<Self>, [usize; 2]),
}

/// A step that leads from frame to frame.
#[derive(Clone, Debug)]
pub(super) enum Step {
    Translate(Vector),
    /// About one of its own axes.
    About(usize, Term),
    Rotate(Vector, Term),
    /// By a coordinate that is a quaternion.
    Quaternion(usize),
}

#[derive(Clone, Debug)]
pub(super) struct Frame {
    pub(super) name: String,
    pub(super) parent: Option<usize>,
    pub(super) steps: Vec<Step>,
    /// Of a family.
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

    /// A coordinate of several numbers as a whole, by the first.
    pub(super) fn block(&self, first: usize, suffix: &str) -> String {
        self.coordinate(first, suffix).trim_end_matches("[0]").to_owned()
    }

    /// A field or a member of several numbers as a whole, by the first.
    pub(super) fn whole(&self, first: usize) -> String {
        self.names[first].trim_end_matches("[0]").to_owned()
    }

    /// The first entries of coordinates of so many.
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
