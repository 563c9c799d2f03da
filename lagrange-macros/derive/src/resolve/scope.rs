//! Name resolution: the meaning of each name.

use indexmap::IndexMap;

use crate::diagnostics::{Diagnostics, Place};
use crate::symbolic;
use crate::syntax::{Declaration, FunctionDeclaration, Name, normal_form};

/// Meaning of a name in an expression.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Entity {
    Field(usize),
    /// An entry of the `coordinates` attribute.
    Coordinate(usize),
    Velocity(usize),
    Acceleration(usize),
    /// Index of the first definition of that name.
    Definition(usize),
    /// Index of a user-supplied function.
    Function(usize),
    /// A frame, or a family of frames.
    Frame,
}

/// Built-in functions besides those of one argument that the graph has.
const CALLS: &str = "atan2 sqrt quat_rotate quat_rate quat_rate_body quat_mul quat_conj dot cross norm transpose trace \
    identity skew rot rot_x rot_y rot_z min max clamp sum der lambda in";

/// All built-in functions.
pub(super) fn functions() -> impl Iterator<Item = &'static str> {
    symbolic::Function::callable().map(|(name, _)| name).chain(CALLS.split(' '))
}

/// Built-in names that are not functions.
pub(super) const CONSTANTS: [&str; 2] = ["t", "pi"];

/// Single namespace of fields, coordinates, definitions, functions and frames.
#[derive(Debug)]
pub(super) struct Scope {
    pub(super) entities: IndexMap<String, (Entity, Place)>,
    /// Fields with the name of a built-in: an error only if an expression uses that name.
    shadowing: IndexMap<String, Place>,
    /// Names of user-supplied functions, keyed by the field that holds each.
    pub(super) functions: IndexMap<String, String>,
    /// Outermost array length of coordinates and fields that are arrays.
    pub(super) lengths: IndexMap<String, usize>,
}

impl Scope {
    pub(super) fn new(declaration: &Declaration, diagnostics: &mut Diagnostics) -> Self {
        let names =
            |function: &FunctionDeclaration| (function.field.text.clone(), function.name.text.clone());
        let functions = declaration.functions.iter().map(names).collect();
        let lengths = lengths(declaration).map(|(name, length)| (name.text.clone(), length)).collect();
        let mut scope = Self { entities: IndexMap::new(), shadowing: IndexMap::new(), functions, lengths };
        for (index, coordinate) in declaration.coordinates.iter().enumerate() {
            scope.declare(&coordinate.name, Entity::Coordinate(index), diagnostics);
        }
        for (index, coordinate) in declaration.coordinates.iter().enumerate() {
            scope.declare_rates(&coordinate.name, index, diagnostics);
        }
        for (index, function) in declaration.functions.iter().enumerate() {
            scope.declare(&function.name, Entity::Function(index), diagnostics);
        }
        for (index, field) in declaration.fields.iter().enumerate() {
            // The field of a function may have the same name as the function.
            if scope.functions.contains_key(&field.name.text) {
                continue;
            }
            if is_built_in(&field.name.text) {
                scope.shadowing.insert(field.name.text.clone(), field.name.place);
            } else {
                scope.declare(&field.name, Entity::Field(index), diagnostics);
            }
        }
        for frame in &declaration.frames {
            if scope.get(&frame.target.name.text) != Some(Entity::Frame) {
                scope.declare(&frame.target.name, Entity::Frame, diagnostics);
            }
        }
        for (index, define) in declaration.defines.iter().enumerate() {
            scope.declare_definition(declaration, index, &define.target.name, diagnostics);
        }
        scope
    }

    fn declare(&mut self, name: &Name, entity: Entity, diagnostics: &mut Diagnostics) {
        if is_built_in(&name.text) {
            let message = format!("`{}` has a fixed meaning in expressions: choose another name", name.text);
            diagnostics.error(name.place, message);
        } else if let Some((earlier, place)) = self.entities.get(&name.text) {
            let message = format!("the name `{}` is already taken by {}", name.text, earlier.describe());
            let note = match earlier {
                Entity::Velocity(_) | Entity::Acceleration(_) => {
                    format!("`{}` belongs to this coordinate", name.text)
                }
                _ => format!("the other `{}` is here", name.text),
            };
            diagnostics.push(name.place.error_beside(message, *place, note));
        } else {
            self.entities.insert(name.text.clone(), (entity, name.place));
        }
    }

    /// Declares the names `x_dot` and `ẋ` of a velocity, `x_ddot` and `ẍ` of an acceleration.
    fn declare_rates(&mut self, name: &Name, index: usize, diagnostics: &mut Diagnostics) {
        let text = &name.text;
        let rates = [
            (format!("{text}_dot"), Entity::Velocity(index)),
            (normal_form(&format!("{text}\u{307}")), Entity::Velocity(index)),
            (format!("{text}_ddot"), Entity::Acceleration(index)),
            (normal_form(&format!("{text}\u{308}")), Entity::Acceleration(index)),
        ];
        for (rate, entity) in rates {
            match self.entities.get(&rate) {
                Some((Entity::Coordinate(_), place)) => {
                    let kind = entity.describe();
                    let message =
                        format!("the name `{rate}` is already taken by {kind}: choose another name");
                    let note = format!("`{rate}` belongs to this coordinate");
                    diagnostics.push(place.error_beside(message, name.place, note));
                }
                _ => {
                    self.entities.insert(rate, (entity, name.place));
                }
            }
        }
    }

    /// Declares a definition. Elements of a family share a name and a number of indices; any other repeated name is an error.
    fn declare_definition(
        &mut self,
        declaration: &Declaration,
        index: usize,
        name: &Name,
        diagnostics: &mut Diagnostics,
    ) {
        let rank = |index: usize| declaration.defines[index].target.indices.len();
        match self.entities.get(&name.text) {
            Some(&(Entity::Definition(first), place)) if rank(first) > 0 && rank(index) > 0 => {
                if rank(first) != rank(index) {
                    let message = format!(
                        "`{}` has {} here: the elements of a family have equally many",
                        name.text,
                        indices(rank(index))
                    );
                    let note = format!("`{}` has {}", name.text, indices(rank(first)));
                    diagnostics.push(name.place.error_beside(message, place, note));
                }
            }
            _ => self.declare(name, Entity::Definition(index), diagnostics),
        }
    }

    pub(super) fn get(&self, name: &str) -> Option<Entity> {
        self.entities.get(name).map(|(entity, _)| *entity)
    }

    /// Field that makes the name of a built-in ambiguous.
    pub(super) fn shadowing(&self, name: &str) -> Option<Place> {
        self.shadowing.get(name).copied()
    }
}

fn indices(rank: usize) -> String {
    if rank == 1 { "one index".to_owned() } else { format!("{rank} indices") }
}

/// Coordinates and fields that are arrays, with their outermost length.
fn lengths(declaration: &Declaration) -> impl Iterator<Item = (&Name, usize)> {
    let coordinates =
        declaration.coordinates.iter().filter_map(|known| Some((&known.name, *known.lengths.first()?)));
    let fields = declaration.fields.iter().filter_map(|field| {
        let length = *field.shape.as_ref().ok()?.layout.lengths.first()?;
        Some((&field.name, length))
    });
    coordinates.chain(fields)
}

impl Entity {
    pub(super) fn describe(self) -> &'static str {
        match self {
            Self::Field(_) => "a field",
            Self::Coordinate(_) => "a coordinate",
            Self::Velocity(_) => "the velocity of a coordinate",
            Self::Acceleration(_) => "the acceleration of a coordinate",
            Self::Definition(_) => "a definition",
            Self::Function(_) => "a function",
            Self::Frame => "a frame",
        }
    }
}

pub(crate) fn is_built_in(name: &str) -> bool {
    functions().any(|function| function == name) || CONSTANTS.contains(&name)
}
