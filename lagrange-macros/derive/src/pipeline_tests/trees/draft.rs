//! A random system: the source for the macro, and the same system as a model for the oracle.

use std::collections::BTreeMap;

use super::algebra::{Matrix, Vector, product, transposed, turn_by, unit};
use super::model::{Joint, Link, Load, Model, Motion, Tie};
use lagrange_random::Random;

#[derive(Default)]
pub(super) struct Draft {
    pub(super) model: Model,
    /// Declarations, such as `r: [3]`.
    coordinates: Vec<String>,
    /// Name, type and numbers of each field, matrices row by row.
    pub(super) fields: Vec<(String, String, Vec<f64>)>,
    frames: Vec<String>,
    terms: Vec<String>,
    attributes: Vec<String>,
    dissipation: Vec<String>,
    /// Names of the multipliers, in the order of the model's ties.
    pub(super) multipliers: Vec<String>,
    /// Coordinates that are single angles or lengths.
    pub(super) scalars: Vec<usize>,
    /// Number of coordinates from which on no joint with several coordinates is added.
    pub(super) enough: usize,
    /// How often each feature was drawn.
    pub(super) counts: BTreeMap<&'static str, usize>,
}

/// A frame, declared or still being declared.
#[derive(Clone)]
pub(super) struct Frame {
    pub(super) name: String,
    pub(super) link: usize,
    /// Number of coordinates that have moved the frame since the last frame with a body.
    pub(super) light: usize,
    /// Text of the steps so far.
    pub(super) steps: Vec<String>,
}

impl Frame {
    pub(super) fn fixed() -> Self {
        Self { name: "fixed".into(), link: 0, light: 0, steps: Vec::new() }
    }
}

impl Draft {
    pub(super) fn source(&self) -> String {
        let fields: Vec<String> = self.fields.iter().map(|(name, ty, _)| format!("{name}: {ty}")).collect();
        format!("{}struct Tree {{ {} }}", self.attributes(), fields.join(", "))
    }

    /// All attributes, one per line.
    pub(super) fn attributes(&self) -> String {
        let mut attributes = vec![format!("coordinates({})", self.coordinates.join(", "))];
        attributes.extend_from_slice(&self.frames);
        attributes.push(format!("lagrangian({})", self.terms.join(" + ")));
        if !self.dissipation.is_empty() {
            attributes.push(format!("dissipation({})", self.dissipation.join(" + ")));
        }
        attributes.extend_from_slice(&self.attributes);
        attributes.iter().map(|attribute| format!("#[{attribute}]\n")).collect()
    }

    /// Returns a number of a field.
    pub(super) fn number(&self, field: &str, number: usize) -> f64 {
        let found = self.fields.iter().find(|(name, ..)| name == field);
        found.expect("a field").2[number]
    }

    /// Index of a multiplier in the oracle's solution.
    pub(super) fn multiplier(&self, name: &str) -> usize {
        self.multipliers.iter().position(|known| known == name).expect("a constraint")
    }

    pub(super) fn count(&mut self, what: &'static str) {
        *self.counts.entry(what).or_default() += 1;
    }

    pub(super) fn field(&mut self, ty: impl Into<String>, numbers: impl Into<Vec<f64>>) -> String {
        let name = format!("p{}", self.fields.len());
        self.fields.push((name.clone(), ty.into(), numbers.into()));
        name
    }

    pub(super) fn number_field(&mut self, number: f64) -> String {
        self.field("f64", [number])
    }

    pub(super) fn vector_field(&mut self, vector: Vector) -> String {
        self.field("Vector3<f64>", vector)
    }

    /// Adds a coordinate of `length` numbers. Returns its name and the index of its first number.
    pub(super) fn coordinate(&mut self, random: &mut Random, length: usize) -> (String, usize) {
        let first = self.model.coordinates.len();
        let name = format!("c{first}");
        self.coordinates.push(if length == 1 { name.clone() } else { format!("{name}: [{length}]") });
        for _ in 0..length {
            self.model.coordinates.push(random.between(-1.0, 1.0));
            self.model.velocities.push(random.between(-1.0, 1.0));
            self.model.forces.push(0.0);
        }
        if length == 1 {
            self.scalars.push(first);
        }
        (name, first)
    }

    /// Adds a unit quaternion with a rate orthogonal to it, and the norm constraint that its frame implies.
    pub(super) fn ball(&mut self, random: &mut Random) -> (String, usize) {
        let (name, first) = self.coordinate(random, 4);
        let (q, model) = (random.quaternion(), &mut self.model);
        let along: f64 = (0..4).map(|k| q[k] * model.velocities[first + k]).sum();
        for (k, entry) in q.into_iter().enumerate() {
            model.coordinates[first + k] = entry;
            model.velocities[first + k] -= along * entry;
        }
        self.tie(Tie::Unit(first), name.clone());
        (name, first)
    }

    /// Adds a tie and its multipliers.
    pub(super) fn tie(&mut self, tie: Tie, name: String) {
        match tie {
            Tie::Together(..) => self.multipliers.extend((0..3).map(|k| format!("{name}[{k}]"))),
            _ => self.multipliers.push(name),
        }
        self.model.ties.push(tie);
    }

    /// Removes the last tie and its multipliers.
    pub(super) fn untie(&mut self) {
        let rows = if let Some(Tie::Together(..)) = self.model.ties.pop() { 3 } else { 1 };
        self.multipliers.truncate(self.multipliers.len() - rows);
    }

    pub(super) fn term(&mut self, text: String) {
        self.terms.push(text);
    }

    pub(super) fn dissipation(&mut self, text: String) {
        self.dissipation.push(text);
    }

    pub(super) fn attribute(&mut self, text: String) {
        self.attributes.push(text);
    }

    pub(super) fn load(&mut self, load: Load) {
        self.model.loads.push(load);
    }

    /// Adds a step to a frame. One step may be several links of the model.
    pub(super) fn step(&mut self, frame: &mut Frame, text: String, joints: impl IntoIterator<Item = Joint>) {
        frame.steps.push(text);
        for joint in joints {
            self.model.links.push(Link { before: frame.link, joint });
            frame.link = self.model.links.len();
        }
    }

    pub(super) fn frame_attribute(&mut self, text: String) {
        self.frames.push(format!("frame({text})"));
    }

    /// Adds a constant step, before or after a joint.
    pub(super) fn placed(&mut self, random: &mut Random, frame: &mut Frame) {
        match random.below(5) {
            0 | 1 => {
                let by = random.vector();
                let text = format!("translate({})", self.vector_field(by));
                self.step(frame, text, [Joint::Slide(by.map(Motion::fixed))]);
            }
            2 => {
                self.count("placed by a rotation");
                let by = turn_by(random.quaternion());
                let text = format!("rotate({})", self.field("Rotation3<f64>", by.concat()));
                self.step(frame, text, [Joint::Placed(by)]);
            }
            3 => {
                self.count("placed by a matrix");
                let by = turn_by(random.quaternion());
                let name = self.field("Matrix3<f64>", by.concat());
                self.attribute(format!("parameter({name}: rotation)"));
                let text = format!("rotate({name})");
                self.step(frame, text, [Joint::Placed(by)]);
            }
            _ => {
                self.count("placed by a unit quaternion");
                let by = random.quaternion();
                let text = format!("rotate({})", self.field("UnitQuaternion<f64>", by));
                self.step(frame, text, [Joint::Placed(turn_by(by))]);
            }
        }
    }

    /// Draws a positive factor about 1 for a mass or an inertia. One in four varies with time or with a coordinate;
    /// the text of the others is `None`.
    pub(super) fn growth(&mut self, random: &mut Random) -> (Option<String>, Motion) {
        if !random.once_in(4) {
            return (None, Motion::fixed(1.0));
        }
        let [a, c] = [random.between(-0.5, 0.5), random.between(0.2, 1.0)];
        let wave = format!("{}*sin({}*t)", self.number_field(a), self.number_field(2.0 * c));
        let mut growth = Motion { constant: 1.0, waves: vec![[a, 2.0 * c, 0.0]], ..Motion::default() };
        let scalars = &self.scalars;
        if scalars.is_empty() || random.once_in(3) {
            self.count("mass or inertia that varies with time");
            return (Some(format!("(1 + {wave})")), growth);
        }
        let i = scalars[random.below(scalars.len())];
        self.count("mass or inertia that varies with a coordinate");
        growth.products.push((c, i, i));
        (Some(format!("(1 + {wave} + {}*c{i}^2)", self.number_field(c))), growth)
    }

    /// Draws a mass, which may vary.
    pub(super) fn mass(&mut self, random: &mut Random) -> (String, Motion) {
        let mass = random.between(0.5, 2.0);
        let (field, (text, growth)) = (self.number_field(mass), self.growth(random));
        (text.map_or(field.clone(), |text| format!("{field}*{text}")), growth.times(mass))
    }

    /// Draws an inertia: its text with a factor, its matrix, and the factor. The field may have an antisymmetric
    /// part, which has no effect.
    pub(super) fn inertia(&mut self, random: &mut Random) -> (String, Matrix, Motion) {
        let (name, own) = self.inertia_at_rest(random);
        let (text, growth) = self.growth(random);
        (text.map_or(name.clone(), |text| format!("{text}*{name}")), own, growth)
    }

    fn inertia_at_rest(&mut self, random: &mut Random) -> (String, Matrix) {
        let own = inertia(random);
        let mut entries = own.concat();
        match random.below(3) {
            0 => {
                let [x, y, z] = random.vector();
                let odd = [0.0, -z, y, z, 0.0, -x, -y, x, 0.0];
                entries.iter_mut().zip(odd).for_each(|(entry, odd)| *entry += odd);
                (self.field("Matrix3<f64>", entries), own)
            }
            1 => {
                let name = self.field("Matrix3<f64>", entries);
                self.attribute(format!("parameter({name}: symmetric)"));
                (name, own)
            }
            _ => (self.field("Matrix3<f64>", entries), own),
        }
    }
}

/// Random inertia with principal moments between 0.2 and 1 about random axes.
pub(super) fn inertia(random: &mut Random) -> Matrix {
    let axes = turn_by(random.quaternion());
    let [a, b, c] = [0; 3].map(|_| random.between(0.2, 1.0));
    product(product(axes, [[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]]), transposed(axes))
}

/// Random axis, at least 0.2 long, and the unit vector along it.
pub(super) fn axis(random: &mut Random) -> (Vector, Vector) {
    let axis = random.vector();
    if super::algebra::norm(axis) < 0.2 { self::axis(random) } else { (axis, unit(axis)) }
}
