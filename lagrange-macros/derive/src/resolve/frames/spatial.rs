//! Vectors in space, and functions of a frame such as `position(frame, point)`.

use super::super::lowering::Lowering;
use super::super::value::{Axes, Shape, Value, cross};
use super::pose::{Triple, sum, symmetric};
use super::registry::{Body, FIXED};
use crate::diagnostics::Place;
use crate::symbolic::{Id, Rational, Symbol, Verdict, to_f64};
use crate::syntax::{Expression, Name};
use crate::variables::Variable;

/// Functions of a frame. Their names stay free for other uses if no frame is the argument.
const CALLS: [&str; 7] =
    ["position", "velocity", "angular_velocity", "jacobian", "kinetic", "vector", "express"];

pub(crate) fn is_of_frames(name: &str) -> bool {
    CALLS.contains(&name)
}

impl Lowering<'_> {
    /// Lowers a call of one of [`CALLS`].
    pub(crate) fn of_frame(&mut self, name: &Name, arguments: &[Expression], place: Place) -> Option<Value> {
        match (name.text.as_str(), arguments) {
            ("position", [frame, point @ ..]) if point.len() <= 1 => {
                let (axes, point) = self.point(frame, point)?;
                let position = self.frames.all[axes.frame].position_of(point, &mut self.graph);
                Some(Value::Spatial(self.fixed(), position))
            }
            ("velocity", [frame, point @ ..]) if point.len() <= 1 => {
                let (axes, r) = self.point(frame, point)?;
                let rate = self.rate_of(&Value::vector(r), place)?;
                let rate = self.components(&rate)?;
                let velocity = self.frames.all[axes.frame].velocity_of(r, rate, &mut self.graph);
                self.rates.push(velocity.to_vec());
                Some(Value::Spatial(axes, velocity))
            }
            ("jacobian", [velocity]) => self.jacobian(velocity, place),
            ("angular_velocity", [frame]) => {
                let axes = self.frame(frame)?;
                let angular_velocity = self.frames.all[axes.frame].angular_velocity;
                Some(Value::Spatial(axes, angular_velocity))
            }
            ("kinetic", [frame, mass, more @ ..]) if more.len() <= 2 => self.kinetic(frame, mass, more),
            ("vector", [frame, components]) => {
                let (axes, components) =
                    (self.frame(frame), self.lower(components).zip(Some(components.place)));
                let (axes, (value, place)) = (axes?, components?);
                self.along(axes, &value, place)
            }
            ("express", [vector, frame]) => {
                let (value, axes) = (self.lower(vector), self.frame(frame));
                let (value, axes) = (value?, axes?);
                let (Some(from), Some(components)) = (value.axes().cloned(), self.components(&value)) else {
                    let message = format!(
                        "`express` takes a vector in the axes of a frame, but this is {}: `vector(frame, v)` says which axes are meant",
                        value.shape()
                    );
                    return self.report(vector.place, message);
                };
                let components = self.turned_into(components, from.frame, axes.frame);
                Some(Value::Spatial(axes, components))
            }
            (_, given) => {
                let takes = match name.text.as_str() {
                    "position" | "velocity" => {
                        "a frame, and a point in its axes where that is not its origin"
                    }
                    "kinetic" => {
                        "a frame, a mass, its centre and the inertia about it, `kinetic(body, m, c, I)`"
                    }
                    "vector" => "a frame and the components along its axes",
                    "express" => "a vector and the frame along whose axes it is wanted",
                    _ => return self.wrong_number(name, 1, given.len(), place),
                };
                self.report(place, format!("`{}` takes {takes}", name.text))
            }
        }
    }

    /// Resolves a frame and a point along its axes, by default its origin.
    fn point(&mut self, frame: &Expression, point: &[Expression]) -> Option<(Axes, Triple)> {
        let (axes, point) = (self.frame(frame), self.lower_all(point).map(|values| (values, point)));
        let (axes, (values, expressions)) = (axes?, point?);
        let [value] = &values[..] else { return Some((axes, [Id::ZERO; 3])) };
        let place = expressions[0].place;
        let value = self.along(axes.clone(), value, place)?;
        Some((axes, self.components(&value)?))
    }

    /// Attaches axes to a vector of three entries. Reports a vector that has other axes.
    fn along(&mut self, axes: Axes, value: &Value, place: Place) -> Option<Value> {
        let Some(components) = self.components(value) else {
            let inertia = value.as_map_of_space().is_some();
            let hint =
                if inertia { ": an inertia comes after the centre, `kinetic(body, m, c, I)`" } else { "" };
            let message = format!("a vector of 3 belongs here, but this is {}{hint}", value.shape());
            return self.report(place, message);
        };
        match value.axes() {
            Some(other) if *other != axes => {
                let (name, shape) = (&axes.name, value.shape());
                self.report(place, format!("this is {shape}: write `express(…, {name})`"))
            }
            _ => Some(Value::Spatial(axes, components)),
        }
    }

    /// Kinetic energy ½ m u² + ½ ω·Iω, with u the velocity of the centre of mass. If m, c and I are parameters, the
    /// energy is written by the twist alone: ½ m v² + v·(ω × h) + ½ ω·Jω, with h = m c and J = I + m (c² 1 − c cᵀ)
    /// about the origin.
    fn kinetic(&mut self, frame: &Expression, mass: &Expression, more: &[Expression]) -> Option<Value> {
        let (centre, inertia) = (&more[..more.len().min(1)], more.get(1));
        let (point, mass) = (self.point(frame, centre), self.scalar(mass));
        let inertia = inertia.map(|inertia| self.inertia(inertia).ok_or(())).transpose();
        let ((axes, centre), mass, inertia) = (point?, mass?, inertia.ok()?);
        let inertia = inertia.unwrap_or([[Id::ZERO; 3]; 3]);
        if self.is_rigid(mass, centre, inertia) {
            let body = self.body(axes.frame, mass, centre, inertia);
            let energy = Value::Scalar(body.energy);
            self.frames.bodies.push(body);
            return Some(energy);
        }
        let rate = self.rate_of(&Value::vector(centre), frame.place)?;
        let rate = self.components(&rate)?;
        let frame = &self.frames.all[axes.frame];
        let (angular_velocity, velocity) =
            (frame.angular_velocity, frame.velocity_of(centre, rate, &mut self.graph));
        self.rates.extend([angular_velocity.to_vec(), velocity.to_vec()]);
        let square = self.graph.dot(&velocity, &velocity);
        let moving = self.graph.mul(mass, square);
        let turning = self.quadratic(angular_velocity, inertia);
        let half = Rational::new(1, 2);
        Some(Value::Scalar(self.graph.sum([(moving, half), (turning, half)])))
    }

    /// Returns whether mass, centre and inertia contain parameters only. Newton's and Euler's equations then have no
    /// term in ṁ, ċ or İ, nor in their derivatives by coordinates.
    fn is_rigid(&self, mass: Id, centre: Triple, inertia: [Triple; 3]) -> bool {
        let parts: Vec<Id> = [mass].into_iter().chain(centre).chain(inertia.into_iter().flatten()).collect();
        self.graph.symbols(&parts).all(|symbol| matches!(Variable::of(symbol), Variable::Parameter(_)))
    }

    fn body(&mut self, frame: usize, mass: Id, centre: Triple, inertia: [Triple; 3]) -> Body {
        let graph = &mut self.graph;
        let moment =
            centre.map(|component| graph.mul(mass, component)).map(|component| graph.defined(component));
        let square = graph.dot(&moment, &centre);
        let entry = |i: usize, j: usize| {
            let product = graph.mul(moment[i], centre[j]);
            let shift = if i == j { graph.sub(square, product) } else { graph.neg(product) };
            // The antisymmetric part of an inertia matrix does not contribute.
            let half = Rational::new(1, 2);
            let own = graph.sum([(inertia[i][j], half), (inertia[j][i], half)]);
            let entry = graph.add(own, shift);
            graph.defined(entry)
        };
        let (central, inertia) = (inertia, symmetric(entry));
        let energy = self.energy(frame, mass, moment, inertia);
        Body { frame, mass, moment, inertia, centre, central, energy }
    }

    fn energy(&mut self, frame: usize, mass: Id, moment: Triple, inertia: [Triple; 3]) -> Id {
        let (angular_velocity, velocity) = {
            let frame = &self.frames.all[frame];
            (frame.angular_velocity, frame.velocity)
        };
        let turning = self.quadratic(angular_velocity, inertia);
        let graph = &mut self.graph;
        let square = graph.dot(&velocity, &velocity);
        let moving = graph.mul(mass, square);
        let carried = cross(angular_velocity, moment, graph);
        let mixed = graph.dot(&velocity, &carried);
        let half = Rational::new(1, 2);
        let energy = graph.sum([(moving, half), (mixed, Rational::from_integer(1)), (turning, half)]);
        graph.defined(energy)
    }

    fn inertia(&mut self, expression: &Expression) -> Option<[Triple; 3]> {
        let value = self.lower(expression)?;
        let wrong = || {
            let advice =
                if matches!(value, Value::Scalar(_)) { ": write it times `identity(3)`" } else { "" };
            format!("an inertia is a 3 by 3 matrix, but this is {}{advice}", value.shape())
        };
        let rows = value.as_map_of_space().or_else(|| self.report(expression.place, wrong()))?;
        self.reject_unsymmetric(rows, expression)?;
        Some(rows)
    }

    /// Reports an inertia matrix with entries across the diagonal that differ for all parameter values.
    fn reject_unsymmetric(&mut self, rows: [Triple; 3], at: &Expression) -> Option<()> {
        let mut pairs = [(0, 1), (0, 2), (1, 2)].into_iter();
        let Some((i, j)) = pairs.find(|&(i, j)| self.surely_differ(rows[i][j], rows[j][i])) else {
            return Some(());
        };
        let numbers = [rows[i][j], rows[j][i]].map(|entry| self.graph.as_number(entry));
        let values = match numbers {
            [Some(x), Some(y)] => format!(", {} and {}", to_f64(x), to_f64(y)),
            _ => String::new(),
        };
        let message = format!(
            "an inertia is symmetric, but its entries [{i}][{j}] and [{j}][{i}] differ{values}: write the same in both"
        );
        match [(i, j), (j, i)].map(|(row, column)| at.entry(row).and_then(|row| row.entry(column))) {
            [Some(first), Some(second)] => {
                self.diagnostics.push(second.place.error_beside(
                    message,
                    first.place,
                    "the other one is here",
                ));
                None
            }
            _ => self.report(at.place, message),
        }
    }

    /// Returns whether the difference of two expressions, or its derivative by a variable other than a parameter, is
    /// free of parameters and not zero.
    fn surely_differ(&mut self, x: Id, y: Id) -> bool {
        let difference = self.graph.sub(x, y);
        let is_parameter = |symbol| matches!(Variable::of(symbol), Variable::Parameter(_));
        let moving: Vec<Symbol> =
            self.graph.symbols(&[difference]).filter(|&symbol| !is_parameter(symbol)).collect();
        let mut candidates = self.graph.gradient(difference, &moving);
        candidates.push(difference);
        candidates.into_iter().any(|candidate| {
            let is_known =
                !self.graph.has_external(&[candidate]) && !self.graph.symbols(&[candidate]).any(is_parameter);
            let drawn = |symbol, draw| self.parameters.value_of(symbol, draw);
            is_known && self.graph.is_zero(candidate, drawn) == Verdict::NonZero
        })
    }

    fn quadratic(&mut self, vector: Triple, matrix: [Triple; 3]) -> Id {
        let image = matrix.map(|row| self.graph.dot(&row, &vector));
        self.graph.dot(&vector, &image)
    }

    fn fixed(&self) -> Axes {
        Axes { frame: 0, name: FIXED.into() }
    }

    /// Converts the components of a vector between frames: up to their common ancestor, then down.
    fn turned_into(&mut self, mut vector: Triple, mut from: usize, to: usize) -> Triple {
        let mut down = Vec::new();
        let mut to = to;
        while from != to {
            // A frame has a larger index than its ancestors, so the later of two frames is no ancestor of the other.
            if from > to {
                let frame = self.frames.all[from].clone();
                vector = frame.step.back(vector, &mut self.graph);
                from = frame.before;
            } else {
                down.push(to);
                to = self.frames.all[to].before;
            }
        }
        for frame in down.into_iter().rev() {
            let step = self.frames.all[frame].step.clone();
            vector = step.forth(vector, &mut self.graph);
        }
        vector
    }

    /// Lowers `der(v)` of a vector in the axes of a frame, as seen from the fixed frame or from another: (dr/dt)_B =
    /// dr/dt − ω_B × r (Goldstein, Poole and Safko, *Classical Mechanics*, 4.86).
    pub(crate) fn rate_seen_from(
        &mut self,
        value: &Value,
        seen_from: Option<&Expression>,
        place: Place,
    ) -> Option<Value> {
        let seen_from = match seen_from {
            Some(frame) => Some(self.frame(frame)?),
            None => None,
        };
        let rate = self.rate_of(value, place);
        let Some(axes) = value.axes().cloned() else {
            let message = "this has a rate of change of its own, as a vector in the axes of a frame has none: write `der(x)`";
            return if seen_from.is_some() { self.report(place, message) } else { rate };
        };
        let (vector, rate) = (self.components(value)?, self.components(&rate?)?);
        let mut turning = self.frames.all[axes.frame].angular_velocity;
        if let Some(seen_from) = seen_from {
            let other = self.frames.all[seen_from.frame].angular_velocity;
            let other = self.turned_into(other, seen_from.frame, axes.frame);
            turning = std::array::from_fn(|i| self.graph.sub(turning[i], other[i]));
        }
        let carried = cross(turning, vector, &mut self.graph);
        Some(Value::Spatial(axes, sum([rate, carried], &mut self.graph)))
    }

    /// Common shape of two operands; reports incompatible ones.
    pub(crate) fn meeting(
        &mut self,
        first: &Shape,
        other: &Value,
        place: Place,
        what: &str,
    ) -> Option<Shape> {
        let shape = other.shape();
        match first.with(&shape) {
            Some(both) => Some(both),
            None if first.is_turned_to(&shape) => self.report(
                place,
                format!("this is {shape}, but {what} is {first}: write `express(…, frame)` to have both in the axes of one frame"),
            ),
            None => self.report(place, format!("this is {shape}, but {what} is {first}")),
        }
    }

    /// Common axes of several operands. A vector without axes takes those of the others, unless it contains coordinates
    /// or their derivatives: its axes are then ambiguous, which is reported.
    pub(crate) fn along_what_axes(&mut self, values: &[(&Value, Place)]) -> Option<Option<Axes>> {
        let axes = values.iter().find_map(|(value, _)| value.axes().cloned());
        let Some(known) = &axes else { return Some(None) };
        for (value, place) in values {
            let moves = self.graph.symbols(&value.flat()).any(|symbol| {
                matches!(
                    Variable::of(symbol),
                    Variable::Coordinate(_) | Variable::Velocity(_) | Variable::Acceleration(_)
                )
            });
            if value.axes().is_none() && value.as_vector().is_some() && moves {
                let name = &known.name;
                let or = if known.frame == 0 { String::new() } else { format!("`vector({name}, …)` or ") };
                return self.report(*place, format!(
                    "this vector meets one in the axes of `{name}`, but its own axes are not stated: write {or}`vector(fixed, …)`"
                ));
            }
        }
        Some(axes)
    }
}
