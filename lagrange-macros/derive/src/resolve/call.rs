//! Calls: built-in functions, definitions with arguments, `der` and `lambda`.

use num_traits::Signed;

use super::frames::is_of_frames;
use super::lowering::{Definition, Lowering, Setting};
use super::problem::Limit;
use super::quaternion;
use super::scope::Entity;
use super::unknown::{nearest, or_meant};
use super::value::{Value, cross};
use crate::diagnostics::Place;
use crate::symbolic::{Function, Id, Rational, Scaled};
use crate::syntax::{Expression, Kind, Name};

impl Lowering<'_> {
    pub(super) fn call(&mut self, name: &Name, arguments: &[Expression], place: Place) -> Option<Value> {
        if let Some(function) = Function::named(&name.text) {
            let [x] = self.arguments(name, arguments, place)?;
            let x = self.inside_domain(name, x)?;
            return Some(Value::Scalar(self.graph.function(function, x)));
        }
        match name.text.as_str() {
            "lambda" => return self.lambda(name, arguments, place),
            "der" => {
                let (x, seen_from) = match arguments {
                    [x, frame] if self.frame_is_meant(frame) => (x, Some(frame)),
                    _ => (&self.arguments::<1>(name, arguments, place)?[0], None),
                };
                let value = self.lower(x)?;
                self.note_differentiated(&value);
                let rate = self.rate_seen_from(&value, seen_from, place)?;
                self.rates.push(rate.flat());
                return Some(rate);
            }
            "sqrt" => {
                let [x] = self.arguments(name, arguments, place)?;
                let x = self.inside_domain(name, x)?;
                return Some(Value::Scalar(self.graph.sqrt(x)));
            }
            "norm" => {
                let [v] = self.arguments(name, arguments, place)?;
                let v = self.vector_of(v)?;
                let square = self.graph.dot(&v, &v);
                return Some(Value::Scalar(self.graph.sqrt(square)));
            }
            "atan2" | "dot" | "cross" => return self.binary(name, arguments, place),
            "quat_rotate" | "quat_rate" | "quat_rate_body" => return self.quaternion(name, arguments, place),
            "quat_mul" => {
                let [p, q] = self.arguments(name, arguments, place)?;
                let (p, q) = (self.quaternion_of(name, p), self.quaternion_of(name, q));
                return Some(Value::vector(quaternion::product(p?, q?, &mut self.graph)));
            }
            "quat_conj" => {
                let [q] = self.arguments(name, arguments, place)?;
                let q = self.quaternion_of(name, q)?;
                return Some(Value::vector(quaternion::conjugate(q, &mut self.graph)));
            }
            "min" | "max" => {
                let [x, y] = self.arguments(name, arguments, place)?;
                let (x, y) = (self.scalar(x), self.scalar(y));
                let arguments = [x?, y?];
                let value = self.extreme(&name.text, arguments, place);
                return Some(self.limited(&name.text, value, &arguments));
            }
            "clamp" => {
                let [x, low, high] = self.arguments(name, arguments, place)?;
                let (x, low, high) = (self.scalar(x), self.scalar(low), self.scalar(high));
                let arguments = [x?, low?, high?];
                let above = self.extreme("max", [arguments[0], arguments[1]], place);
                let value = self.extreme("min", [above, arguments[2]], place);
                return Some(self.limited(&name.text, value, &arguments));
            }
            "transpose" | "trace" | "identity" | "skew" => {
                let [x] = self.arguments(name, arguments, place)?;
                return self.matrix(name, x);
            }
            "rot_x" | "rot_y" | "rot_z" => {
                let [angle] = self.arguments(name, arguments, place)?;
                return self.rotation_about_axis(name, angle);
            }
            "rot" => {
                let [axis, angle] = self.arguments(name, arguments, place)?;
                return self.rotation(name, axis, angle);
            }
            _ => {}
        }
        match self.scope.get(&name.text) {
            Some(Entity::Definition(index)) if self.defines[index].formals.is_some() => {
                self.defined_function(index, name, arguments, place)
            }
            Some(Entity::Function(index)) => self.supplied_function(index, arguments, place),
            Some(Entity::Frame) => self.frame_alone(name),
            None if is_of_frames(&name.text) => self.of_frame(name, arguments, place),
            Some(entity) => {
                let (text, kind) = (&name.text, entity.describe());
                let is_of_time =
                    matches!(arguments, [Expression { kind: Kind::Name(t), .. }] if t.text == "t");
                let advice = match entity {
                    Entity::Coordinate(_) | Entity::Velocity(_) | Entity::Acceleration(_) if is_of_time => {
                        format!("it depends on time as it is, write `{text}`")
                    }
                    _ if is_of_time => format!(
                        "a product needs its sign `*`, and a function is declared, `#[function({text}(t))]`"
                    ),
                    _ => "a product needs its sign `*`".to_owned(),
                };
                self.report(name.place, format!("`{text}` is {kind}, not a function: {advice}"))
            }
            None => {
                self.diagnostics.push(self.scope.unknown_function(name));
                None
            }
        }
    }

    /// The arguments, if their number is right; reports it otherwise.
    fn arguments<'e, const K: usize>(
        &mut self,
        name: &Name,
        arguments: &'e [Expression],
        place: Place,
    ) -> Option<&'e [Expression; K]> {
        let exact = arguments.try_into().ok();
        exact.or_else(|| self.wrong_number(name, K, arguments.len(), place))
    }

    /// max(x, y) = y + max(x − y, 0), and min(x, y) = y − max(y − x, 0).
    fn extreme(&mut self, name: &str, [x, y]: [Id; 2], place: Place) -> Id {
        let graph = &mut self.graph;
        let (more, less) = if name == "max" { (x, y) } else { (y, x) };
        let difference = graph.sub(more, less);
        self.kinks.insert(difference, place);
        let beyond = graph.function(Function::Ramp, difference);
        if name == "max" { graph.add(y, beyond) } else { graph.sub(y, beyond) }
    }

    /// A value that keeps its call as it is written.
    fn limited(&mut self, name: &str, value: Id, arguments: &[Id]) -> Value {
        let kept = self.graph.defined(value);
        let limit = || Limit { value: kept, name: name.to_owned(), arguments: arguments.to_vec() };
        self.limits.extend((kept != value).then(limit));
        Value::Scalar(kept)
    }

    /// Lowers a scalar argument. Reports a constant outside the real domain of the function.
    fn inside_domain(&mut self, name: &Name, argument: &Expression) -> Option<Id> {
        let x = self.scalar(argument)?;
        let Some(Scaled { fraction: value, exponent }) = self.graph.as_scaled(x) else { return Some(x) };
        let message = match name.text.as_str() {
            "sqrt" if value.is_negative() => "the root of a negative number has no real value",
            "ln" if !value.is_positive() => "only positive numbers have a logarithm",
            "asin" | "acos" if exponent > 0 || exponent == 0 && value.abs() > Rational::from_integer(1) => {
                "`asin` and `acos` take numbers from -1 to 1"
            }
            _ => return Some(x),
        };
        self.report(argument.place, message)
    }

    fn binary(&mut self, name: &Name, arguments: &[Expression], place: Place) -> Option<Value> {
        let [x, y] = self.arguments(name, arguments, place)?;
        if name.text == "atan2" {
            let (y, x) = (self.scalar(x), self.scalar(y));
            return Some(Value::Scalar(self.graph.atan2(y?, x?)));
        }
        let (first, second) = (self.lower(x), self.lower(y));
        let (first, second) = (first?, second?);
        let (v, w) = (self.vector_in(&first, x.place), self.vector_in(&second, y.place));
        let (v, w) = (v?, w?);
        if v.len() != w.len() {
            return self
                .report(place, format!("these vectors differ in length: {} and {}", v.len(), w.len()));
        }
        self.meeting(&first.shape(), &second, y.place, "the other one")?;
        let axes = self.along_what_axes(&[(&first, x.place), (&second, y.place)])?;
        if name.text == "dot" {
            return Some(Value::Scalar(self.graph.dot(&v, &w)));
        }
        match (<[_; 3]>::try_from(v), <[_; 3]>::try_from(w)) {
            (Ok(v), Ok(w)) => Some(Value::vector(cross(v, w, &mut self.graph)).along(axes.as_ref())),
            _ => self.report(place, "`cross` takes vectors of 3"),
        }
    }

    /// Lowers a function of a quaternion (w, x, y, z), which is not normalized.
    fn quaternion(&mut self, name: &Name, arguments: &[Expression], place: Place) -> Option<Value> {
        let [q, x] = self.arguments(name, arguments, place)?;
        let (q, v) = (self.quaternion_of(name, q), self.vector_of(x));
        let (q, v) = (q?, v?);
        let graph = &mut self.graph;
        let vector = match (name.text.as_str(), <[_; 3]>::try_from(v.clone()), <[_; 4]>::try_from(v)) {
            ("quat_rotate", Ok(v), _) => quaternion::rotate(q, v, graph),
            ("quat_rate", _, Ok(rate)) => quaternion::rate(q, rate, graph),
            ("quat_rate_body", _, Ok(rate)) => quaternion::rate_in_body(q, rate, graph),
            ("quat_rotate", ..) => return self.report(x.place, "`quat_rotate` turns a vector of 3"),
            _ => return self.report(x.place, "the rate of a quaternion is a vector of 4, such as `q_dot`"),
        };
        Some(Value::vector(vector))
    }

    fn quaternion_of(&mut self, name: &Name, argument: &Expression) -> Option<[Id; 4]> {
        let q = self.vector_of(argument)?;
        let wrong = || format!("`{}` takes a quaternion, a vector of 4: (w, x, y, z)", name.text);
        q.try_into().ok().or_else(|| self.report(argument.place, wrong()))
    }

    fn defined_function(
        &mut self,
        index: usize,
        name: &Name,
        arguments: &[Expression],
        place: Place,
    ) -> Option<Value> {
        let define = &self.defines[index];
        match self.definitions[index] {
            Definition::Pending => return self.too_early(index, name),
            Definition::Wrong => return None,
            _ => {}
        }
        let formals = define.formals.as_deref().unwrap_or_default();
        if formals.len() != arguments.len() {
            return self.wrong_number(name, formals.len(), arguments.len(), place);
        }
        let values = self.lower_all(arguments)?;
        let bound = formals.iter().map(|formal| formal.text.clone()).zip(values).collect();
        // The body of a function sees its formal arguments, but no locals of the caller.
        let outer = std::mem::replace(&mut self.locals, bound);
        self.calls.push(place);
        let value = self.lower(&define.body);
        self.calls.pop();
        self.locals = outer;
        let value = value?;
        Some(value.map(&mut |id| self.graph.defined(id)))
    }

    /// Lowers `lambda(no_slip)` or `lambda(rod[3])`.
    fn lambda(&mut self, name: &Name, arguments: &[Expression], place: Place) -> Option<Value> {
        if self.many.is_open() {
            return self.report(
                place,
                "where the number of coordinates is known when the program runs, multipliers are not in expressions yet: the method `multipliers` computes them from a state",
            );
        }
        if self.setting != Setting::Observable {
            return self.report(
                place,
                "multipliers are what the equations are solved for: they may appear in observables only; a limit of friction by the force of a contact is a coefficient, `#[contact(floor: y >= 0, friction(mu): x_dot)]`",
            );
        }
        let [constraint] = self.arguments(name, arguments, place)?;
        let Some((constraint, indices)) = constraint.element() else {
            return self.report(place, "`lambda` takes the name of a constraint");
        };
        let indices: Vec<_> = indices.into_iter().map(|index| self.integer(index)).collect();
        self.multiplier(constraint, &indices.into_iter().collect::<Option<Vec<i128>>>()?)
    }

    /// Multiplier of a constraint: the first indices select an element of the family, the rest index into its value.
    fn multiplier(&mut self, constraint: &Name, indices: &[i128]) -> Option<Value> {
        if self.failed_constraints.contains(&constraint.text) {
            return None;
        }
        let Some(group) = self.multipliers.iter().find(|group| group.name == constraint.text) else {
            let names = || self.multipliers.iter().map(|group| group.name.as_str());
            let advice =
                or_meant(&constraint.text, nearest(&constraint.text, names()), "constraint", names());
            return self
                .report(constraint.place, format!("no constraint is called `{}`{advice}", constraint.text));
        };
        let path = indices.iter().map(|&i| usize::try_from(i).ok()).collect::<Option<Vec<usize>>>();
        let found = path.and_then(|path| {
            let (own, rest) = path.split_at(path.len().min(group.elements.rank()));
            rest.iter().try_fold(group.elements.part(own)?, |value, &i| value.item(i))
        });
        let text = indices.iter().fold(constraint.text.clone(), |text, i| format!("{text}[{i}]"));
        found.or_else(|| self.report(constraint.place, format!("there is no constraint `{text}`")))
    }

    pub(super) fn wrong_number<T>(
        &mut self,
        name: &Name,
        wanted: usize,
        given: usize,
        place: Place,
    ) -> Option<T> {
        let plural = if wanted == 1 { "" } else { "s" };
        let are = if given == 1 { "is" } else { "are" };
        let advice = match (name.text.as_str(), given) {
            ("atan", 2) => ": the angle of the point (x, y) is `atan2(y, x)`",
            ("der", 2) => ": it is by the time, `der(x)`; write out one by a coordinate",
            ("dot", 1) => ": the velocity of `x` is `x_dot`",
            ("norm", 2 | 3) => ": a vector is written `[x, y]`",
            _ => "",
        };
        let message =
            format!("`{}` takes {wanted} argument{plural}, but {given} {are} given{advice}", name.text);
        self.report(place, message)
    }
}
