//! Forces on coordinates, and forces along velocities.

use super::expression::is_literal_zero;
use super::label::element_name;
use super::lowering::{Lowering, Setting};
use super::scope::Entity;
use super::unknown::{nearest, or_meant};
use super::value::{Axes, Shape, Value};
use crate::diagnostics::Place;
use crate::symbolic::Id;
use crate::syntax::{Declaration, Expression, Force, Power, numbers};
use crate::variables::{Variable, has_velocity, symbols};

impl Lowering<'_> {
    pub(super) fn forces(&mut self, declaration: &Declaration) -> Vec<Id> {
        if self.many.is_open() {
            self.open_forces(declaration);
            return Vec::new();
        }
        let mut forces = vec![Id::ZERO; self.count];
        for force in &declaration.forces {
            let name = &force.target.name;
            let Some(Entity::Coordinate(index)) = self.scope.get(&name.text) else {
                self.diagnostics.error(name.place, self.no_coordinate(&name.text));
                continue;
            };
            let indices = &force.target.indices;
            for element in self.elements(indices) {
                let value = self.with_indices(indices, &element, |lowering| lowering.lower(&force.value));
                if let Some(value) = value {
                    self.add_force(&mut forces, index, &element, force, &value);
                }
            }
        }
        forces
    }

    /// Describes the target of a force that is no coordinate, and suggests a coordinate.
    pub(super) fn no_coordinate(&self, name: &str) -> String {
        let coordinates = || self.coordinates.iter().map(|coordinate| coordinate.name.text.as_str());
        let near = match self.scope.get(name) {
            Some(Entity::Frame) => {
                return format!(
                    "a force acts on a coordinate, and `{name}` is a frame: what acts on a body is written `#[power(push, velocity({name}, point))]`, a torque `#[power(torque, angular_velocity({name}))]`"
                );
            }
            Some(Entity::Velocity(index)) => Some(self.coordinates[index].name.text.as_str()),
            _ => nearest(name, coordinates()),
        };
        format!(
            "a force acts on a coordinate, and `{name}` is none{}",
            or_meant(name, near, "coordinate", coordinates())
        )
    }

    fn add_force(
        &mut self,
        forces: &mut [Id],
        coordinate: usize,
        element: &[usize],
        Force { target, value: expression }: &Force,
        value: &Value,
    ) {
        let lengths = &self.coordinates[coordinate].lengths;
        let name = element_name(&target.name.text, element);
        if element.len() > lengths.len() || element.iter().zip(lengths).any(|(i, length)| i >= length) {
            let message = format!("there is no coordinate `{name}`");
            return self.diagnostics.error(target.name.place, message);
        }
        let (outer, inner) = lengths.split_at(element.len());
        let before = element.iter().zip(outer).fold(0, |number, (i, length)| number * length + i);
        let start = self.offsets[coordinate] + before * numbers(inner);
        if is_literal_zero(expression) {
            return;
        }
        if value.shape().lengths != inner {
            let wanted = Shape::plain(inner.to_vec());
            let message = format!("the force on `{name}` is {wanted}, but this is {}", value.shape());
            return self.diagnostics.error(expression.place, message);
        }
        if let Some(Axes { name: axes, .. }) = value.axes().filter(|axes| axes.frame != 0) {
            let message = format!(
                "a force on `{name}` is a number for each coordinate, but this is a vector in the axes of `{axes}`: write `express(…, fixed)` where the coordinates are along the fixed axes"
            );
            return self.diagnostics.error(expression.place, message);
        }
        for (slot, entry) in forces[start..].iter_mut().zip(value.flat()) {
            *slot = self.graph.add(*slot, entry);
        }
    }

    /// Pairs of scalar components: force, and velocity that it acts along.
    pub(super) fn powers(&mut self, declaration: &Declaration) -> Vec<(Id, Id)> {
        let mut powers = Vec::new();
        for power in &declaration.powers {
            for element in self.elements(&power.indices) {
                let acting = self.with_indices(&power.indices, &element, |lowering| lowering.power_of(power));
                let Some(acting) = acting else { break };
                powers.extend(acting);
            }
        }
        powers
    }

    fn power_of(&mut self, Power { force, velocity, .. }: &Power) -> Option<Vec<(Id, Id)>> {
        let (along, by) = (self.lower(velocity), self.lower(force));
        self.acting((&by?, force.place), (&along?, velocity.place))
    }

    fn acting(
        &mut self,
        (force, at): (&Value, Place),
        (velocity, of): (&Value, Place),
    ) -> Option<Vec<(Id, Id)>> {
        if velocity.as_matrix().is_some() {
            let shape = velocity.shape();
            return self.report(
                of,
                format!("a force acts along a velocity, a scalar or a vector, but this is {shape}"),
            );
        }
        self.meeting(&velocity.shape(), force, at, "the velocity that it acts along")?;
        self.along_what_axes(&[(force, at), (velocity, of)])?;
        let velocities = velocity.flat();
        if !has_velocity(&self.graph, &velocities) {
            return self.report(of, "no velocity occurs in this, so that a force along it does nothing");
        }
        let slopes = self.slopes(&velocities);
        if has_velocity(&self.graph, &slopes.concat()) {
            return self.report(of, "a force acts along what is linear in the velocities: its virtual work is force · ∂velocity/∂q̇ · δq");
        }
        Some(force.flat().into_iter().zip(velocities).collect())
    }

    /// Gradients ∂v/∂q̇ of several scalars by all velocities.
    fn slopes(&mut self, of: &[Id]) -> Vec<Vec<Id>> {
        let symbols = symbols(self.count, Variable::Velocity);
        of.iter().map(|&one| self.graph.gradient(one, &symbols)).collect()
    }

    /// Lowers `jacobian(v)`: ∂v/∂q̇, with a row for each component of v and a column for each coordinate.
    pub(super) fn jacobian(&mut self, velocity: &Expression, place: Place) -> Option<Value> {
        if self.setting != Setting::Observable {
            return self.report(place, "a Jacobian is for observables: what a force does by it, Jᵀ·force, is `#[power(force, velocity)]`");
        }
        let value = self.lower(velocity)?;
        if value.as_scalar().is_none() && value.as_vector().is_none() {
            let shape = value.shape();
            return self.report(
                velocity.place,
                format!("a Jacobian is that of a scalar or a vector, but this is {shape}"),
            );
        }
        let velocities = value.flat();
        if !has_velocity(&self.graph, &velocities) {
            return self.report(velocity.place, "no velocity occurs in this: a Jacobian is that of a velocity, such as `velocity(hand, point)` or `der(x)`");
        }
        let rows = self.slopes(&velocities);
        if has_velocity(&self.graph, &rows.concat()) {
            return self.report(velocity.place, "a Jacobian is that of what is linear in the velocities");
        }
        let mut rows: Vec<Value> = rows.into_iter().map(Value::vector).collect();
        Some(if value.as_scalar().is_some() { rows.remove(0) } else { Value::Vector(rows) })
    }
}
