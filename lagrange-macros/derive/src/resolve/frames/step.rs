//! Steps from a frame to the next: `translate(v)`, `rotate_z(angle)`, `rotate(axis, angle)`, `rotate(q)`, `rotate(R)`
//! and `pose(P)`.

use super::super::lowering::Lowering;
use super::super::matrix::rotation;
use super::super::quaternion;
use super::super::turns::{Turn, move_in_time};
use super::super::value::{Value, cross};
use super::pose::{Frame, Moved, Step, Triple, Turned, columns, named};
use crate::symbolic::{Id, Sample, Symbol};
use crate::syntax::{Expression, Kind};
use crate::variables::Variable;

/// Number of random draws that test whether a matrix is a rotation.
const DRAWS: u64 = 3;
const NO_ROTATION: &str = "this matrix is no rotation, whose columns are of length 1, across each other and right-handed: say of a field that it is one, `#[parameter(R: rotation)]`, or make it a `Rotation3`";
const STEPS: &str = "a frame comes from the one that it is in by `translate(v)`, `rotate_x(angle)`, `rotate_y(angle)`, `rotate_z(angle)`, `rotate(axis, angle)`, `rotate(q)` with a quaternion, `rotate(R)` with a matrix and `pose(P)` with an isometry";
const NO_POSE: &str = "`pose` takes a field that is an `Isometry3`, or a member that is a `pose`: of other things `translate(v), rotate(R)`";

pub(crate) fn is_step(name: &str) -> bool {
    ["translate", "rotate", "rotate_x", "rotate_y", "rotate_z", "pose"].contains(&name)
}

impl Lowering<'_> {
    /// Adds the frame that this step leads to from frame `before`. Frames with an index above `first` have no name.
    pub(super) fn step(&mut self, before: usize, first: usize, expression: &Expression) -> Option<usize> {
        let Kind::Call(name, arguments) = &expression.kind else {
            return self.report(expression.place, STEPS);
        };
        let (before, turns) = match (name.text.as_str(), &arguments[..]) {
            ("translate", [by]) => (self.translated(before, by)?, Vec::new()),
            ("rotate_x" | "rotate_y" | "rotate_z", [angle]) => {
                let axis = "xyz".chars().position(|axis| name.text.ends_with(axis))?;
                let axis = std::array::from_fn(|i| if i == axis { Id::ONE } else { Id::ZERO });
                let angle = self.scalar(angle)?;
                (before, vec![self.turned_about(axis, angle, expression)?])
            }
            ("rotate", [axis, angle]) => {
                let (axis, angle) = (self.unit(name, axis), self.scalar(angle));
                (before, vec![self.turned_about(axis?, angle?, expression)?])
            }
            ("rotate", [by]) => (before, self.turned(by)?),
            ("pose", [place]) => {
                let Some([translation, rotation]) = self.parts_of_pose(place) else {
                    return self.report(place.place, NO_POSE);
                };
                (self.translated(before, &translation)?, self.turned(&rotation)?)
            }
            (text, _) if is_step(text) => {
                return self.report(expression.place, format!("`{text}` takes other arguments: {STEPS}"));
            }
            (text, _) => {
                return self.report(name.place, format!("`{text}` is no step: {STEPS}"));
            }
        };
        Some(turns.iter().fold(before, |before, turned| self.turn(before, first, turned)))
    }

    /// Adds a rotation. A constant placement before it is merged with it, so that each vector is rotated once.
    fn turn(&mut self, before: usize, first: usize, turned: &Turned) -> usize {
        let graph = &mut self.graph;
        let next = match &self.frames.all[before] {
            Frame { before: root, step: Step::Turned(placement), .. }
                if before > first && placement.is_placement() =>
            {
                let (root, both) = (*root, placement.then(turned, graph));
                self.frames.all.pop();
                self.frames.all[root].turned(root, both, graph)
            }
            frame => frame.turned(before, turned.clone(), graph),
        };
        self.add_frame(next)
    }

    fn add_frame(&mut self, frame: Frame) -> usize {
        self.frames.all.push(frame);
        self.frames.all.len() - 1
    }

    fn translated(&mut self, before: usize, by: &Expression) -> Option<usize> {
        let moved = self.moved(by)?;
        let next = self.frames.all[before].moved(before, moved, &mut self.graph);
        Some(self.add_frame(next))
    }

    fn moved(&mut self, by: &Expression) -> Option<Moved> {
        let value = self.lower(by)?;
        let Some(vector) = self.components(&value).filter(|_| value.axes().is_none()) else {
            let message = format!(
                "a frame is translated by a vector of 3 in the axes reached so far, but this is {}",
                value.shape()
            );
            return self.report(by.place, message);
        };
        let rate = self.rates(vector, by)?;
        Some(Moved { by: vector, rate })
    }

    /// Rotation about a unit axis.
    fn turned_about(&mut self, axis: Triple, angle: Id, at: &Expression) -> Option<Turned> {
        if move_in_time(&self.graph, &axis) {
            let rows = rotation(axis, angle, &mut self.graph);
            return self.turned_by_matrix(rows, at);
        }
        let [speed] = self.rates([angle], at)?;
        let by = rotation(axis, angle, &mut self.graph);
        let rate = axis.map(|component| self.graph.mul(component, speed));
        Some(self.turned_at(by, rate))
    }

    fn turned(&mut self, by: &Expression) -> Option<Vec<Turned>> {
        let value = self.lower(by)?;
        if let Some(matrix) = value.as_map_of_space() {
            return self.turned_by_product(matrix, by);
        }
        match value.as_vector().map(<[Id; 4]>::try_from) {
            Some(Ok(q)) => Some(vec![self.turned_by_quaternion(q, by)?]),
            _ => {
                let message = format!(
                    "`rotate` takes a quaternion (w, x, y, z), a 3 by 3 matrix, or an axis and an angle, but this is {}",
                    value.shape()
                );
                self.report(by.place, message)
            }
        }
    }

    /// Splits a product of rotations into its known turns. If a factor alone is no rotation, the whole product may
    /// still be.
    fn turned_by_product(&mut self, matrix: [Triple; 3], at: &Expression) -> Option<Vec<Turned>> {
        let turns = self.turns.of(&self.graph, matrix).unwrap_or_default();
        let is_rotation = |turn: &Turn| !matches!(turn, &Turn::Placed(rows) if self.is_no_rotation(rows));
        if !turns.is_empty() && turns.iter().all(is_rotation) {
            let turned = turns.into_iter().map(|turn| match turn {
                Turn::About(axis, angle) => self.turned_about(axis, angle, at),
                Turn::Placed(rows) => self.turned_by_matrix(rows, at),
            });
            return turned.collect();
        }
        if self.is_no_rotation(matrix) {
            return self.report(at.place, NO_ROTATION);
        }
        Some(vec![self.turned_by_matrix(matrix, at)?])
    }

    /// Tests at random values whether a matrix surely is no rotation. User-supplied functions make the answer `false`,
    /// since nothing is known of them.
    fn is_no_rotation(&mut self, rows: [Triple; 3]) -> bool {
        let graph = &mut self.graph;
        let [a, b, c] = columns(rows);
        let lengths = [graph.dot(&a, &a), graph.dot(&b, &b)].map(|square| graph.sub(square, Id::ONE));
        let third = cross(a, b, graph);
        let third: Triple = std::array::from_fn(|i| graph.sub(third[i], c[i]));
        let zeros = [&lengths[..], &[graph.dot(&a, &b)], &third].concat();
        if graph.has_external(&zeros) {
            return false;
        }
        let symbols: Vec<Symbol> = graph.symbols(&zeros).collect();
        (0..DRAWS).any(|draw| {
            let value = |symbol, draw| self.parameters.value_of(symbol, draw);
            let mut sample = Sample::new(symbols.iter().copied(), draw, value);
            sample.values(&self.graph, &zeros).iter().any(|value| value.excludes_zero())
        })
    }

    /// Rotation by a matrix E, whose angular velocity ω follows from S(ω) = Eᵀ Ė.
    fn turned_by_matrix(&mut self, by: [Triple; 3], at: &Expression) -> Option<Turned> {
        let rates = self.rates(by.concat().try_into().unwrap_or([Id::ZERO; 9]), at)?;
        let rates = std::array::from_fn(|i| [rates[3 * i], rates[3 * i + 1], rates[3 * i + 2]]);
        let (axes, rates) = (columns(by), columns(rates));
        let rate = [(2, 1), (0, 2), (1, 0)].map(|(i, j)| self.graph.dot(&axes[i], &rates[j]));
        Some(self.turned_at(by, rate))
    }

    /// Rotation by q/|q|, independent of the length of q.
    fn turned_by_quaternion(&mut self, q: [Id; 4], at: &Expression) -> Option<Turned> {
        let graph = &mut self.graph;
        let square = graph.dot(&q, &q);
        self.frames.quaternions.push(q);
        let is_unit = self.is_unit_parameter(at);
        let graph = &mut self.graph;
        let two = graph.integer(2);
        let scale = if is_unit { two } else { graph.div(two, square) };
        let scale = graph.defined(scale);
        let by = quaternion::matrix(q, scale, graph);
        let rates = self.rates(q, at)?;
        let graph = &mut self.graph;
        let half = quaternion::half_rate_in_body(q, rates, graph);
        let rate = half.map(|component| graph.mul(scale, component));
        Some(self.turned_at(by, rate))
    }

    fn turned_at(&mut self, by: [Triple; 3], rate: Triple) -> Turned {
        let by = by.map(|row| named(row, &mut self.graph));
        let rate = named(rate, &mut self.graph);
        Turned { by, rate }
    }

    /// Returns whether the type of a field says that it is a unit quaternion.
    fn is_unit_parameter(&self, at: &Expression) -> bool {
        self.field_in(at).is_some_and(|field| self.parameters.is_unit_quaternion(field))
    }

    /// d/dt of expressions that may depend on coordinates, parameters and time only.
    fn rates<const K: usize>(&mut self, of: [Id; K], at: &Expression) -> Option<[Id; K]> {
        let has_rates = self.graph.symbols(&of).any(|symbol| {
            !matches!(Variable::of(symbol), Variable::Coordinate(_) | Variable::Parameter(_) | Variable::Time)
        });
        if has_rates {
            return self
                .report(at.place, "where a frame lies depends on coordinates and time, not on velocities");
        }
        of.iter().for_each(|&one| self.reject_kink("the placement of a frame", one, at.place));
        let rate = Value::vector(of);
        let rates = self.rate_of(&rate, at.place)?.flat();
        rates.try_into().ok()
    }

    /// Components of a vector in space, along any axes.
    pub(super) fn components(&self, value: &Value) -> Option<Triple> {
        value.as_vector()?.try_into().ok()
    }
}
