//! Names: what each one means, and what was probably meant by one that means nothing.

use indexmap::IndexMap;

use crate::diagnostics::{Diagnostics, Place};
use crate::syntax::{Declaration, Function, Name, normal_form};

/// What a name in an expression may refer to.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Entity {
    Field(usize),
    /// An entry of the `coordinates` attribute.
    Coordinate(usize),
    Velocity(usize),
    Acceleration(usize),
    /// The first of the definitions of that name.
    Definition(usize),
    /// A function that the user supplies.
    Function(usize),
}

/// Functions that expressions may call.
pub(super) const FUNCTIONS: [&str; 24] = [
    "sin",
    "cos",
    "tan",
    "asin",
    "acos",
    "atan",
    "atan2",
    "sinh",
    "cosh",
    "tanh",
    "exp",
    "ln",
    "sqrt",
    "abs",
    "quat_rotate",
    "quat_rate",
    "quat_rate_body",
    "dot",
    "cross",
    "norm",
    "sum",
    "der",
    "lambda",
    "in",
];

/// Names with a fixed meaning that are not functions.
const CONSTANTS: [&str; 2] = ["t", "pi"];

/// The one namespace of fields, coordinates and definitions.
#[derive(Debug)]
pub(super) struct Scope {
    entities: IndexMap<String, (Entity, Place)>,
    /// Fields that bear a built-in's name, which is fine while no expression uses it.
    shadowing: IndexMap<String, Place>,
    /// Fields that are functions, by the functions' names.
    functions: IndexMap<String, String>,
}

impl Scope {
    pub(super) fn new(declaration: &Declaration, diagnostics: &mut Diagnostics) -> Self {
        let names = |function: &Function| (function.field.text.clone(), function.name.text.clone());
        let functions = declaration.functions.iter().map(names).collect();
        let mut scope = Self { entities: IndexMap::new(), shadowing: IndexMap::new(), functions };
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
            // The field of a function may bear the function's name.
            if scope.functions.contains_key(&field.name.text) {
                continue;
            }
            if is_built_in(&field.name.text) {
                scope.shadowing.insert(field.name.text.clone(), field.name.place);
            } else {
                scope.declare(&field.name, Entity::Field(index), diagnostics);
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
            let mut error = name.place.error(message);
            error.combine(place.error(match earlier {
                Entity::Velocity(_) | Entity::Acceleration(_) => {
                    format!("`{}` belongs to this coordinate", name.text)
                }
                _ => format!("the other `{}` is here", name.text),
            }));
            diagnostics.push(error);
        } else {
            self.entities.insert(name.text.clone(), (entity, name.place));
        }
    }

    /// `x_dot` and `ẋ`, `x_ddot` and `ẍ`.
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
                    let message = format!(
                        "the name `{rate}` is already taken by {}: choose another name",
                        entity.describe()
                    );
                    let mut error = place.error(message);
                    error.combine(name.place.error(format!("`{rate}` belongs to this coordinate")));
                    diagnostics.push(error);
                }
                _ => {
                    self.entities.insert(rate, (entity, name.place));
                }
            }
        }
    }

    /// Elements of a family share their name; anything else of one name clashes.
    fn declare_definition(
        &mut self,
        declaration: &Declaration,
        index: usize,
        name: &Name,
        diagnostics: &mut Diagnostics,
    ) {
        let is_element = |index: usize| {
            !matches!(declaration.defines[index].target.index, crate::syntax::TargetIndex::None)
        };
        match self.entities.get(&name.text) {
            Some((Entity::Definition(first), _)) if is_element(*first) && is_element(index) => {}
            _ => self.declare(name, Entity::Definition(index), diagnostics),
        }
    }

    pub(super) fn get(&self, name: &str) -> Option<Entity> {
        self.entities.get(name).map(|(entity, _)| *entity)
    }

    /// The field that makes a built-in's name ambiguous.
    pub(super) fn shadowing(&self, name: &str) -> Option<Place> {
        self.shadowing.get(name).copied()
    }

    /// An error for a name that means nothing, with the nearest that does.
    pub(super) fn unknown(&self, name: &Name, more: &[String]) -> syn::Error {
        let text = &name.text;
        if let Some(error) = self.is_field_of_function(name) {
            return error;
        }
        if let Some(base) = text.strip_suffix("_dot").or_else(|| text.strip_suffix("_ddot"))
            && let Some(entity @ (Entity::Definition(_) | Entity::Field(_))) = self.get(base)
        {
            let kind = entity.describe();
            return name.place.error(format!(
                "`{text}` would be the velocity of a coordinate, but `{base}` is {kind}: write `der({base})`"
            ));
        }
        if ["e", "E"].contains(&text.as_str()) {
            return name
                .place
                .error(format!("nothing is called `{text}`: the exponential function is `exp(x)`"));
        }
        if let Some(function) = FUNCTIONS.into_iter().find(|function| function.eq_ignore_ascii_case(text)) {
            return name
                .place
                .error(format!("nothing is called `{text}`: functions are written `{function}(x)`"));
        }
        let candidates =
            self.entities.keys().map(String::as_str).chain(CONSTANTS).chain(more.iter().map(String::as_str));
        match nearest(text, candidates) {
            Some(near) => name.place.error(format!("nothing is called `{text}`: did you mean `{near}`?")),
            None => name.place.error(format!(
                "nothing is called `{text}`: make it a field, a coordinate or a `#[define(…)]`"
            )),
        }
    }

    /// An error for a function that does not exist.
    pub(super) fn unknown_function(&self, name: &Name) -> syn::Error {
        let text = name.text.as_str();
        if let Some(error) = self.is_field_of_function(name) {
            return error;
        }
        let advice = match text {
            "log" | "Log" | "log2" | "log10" => Some("the natural logarithm is `ln`"),
            "pow" | "Pow" | "powi" | "powf" => Some("a power is written `x^2`"),
            "arcsin" | "arccos" | "arctan" | "ArcSin" | "ArcCos" | "ArcTan" => {
                Some("inverse functions are `asin`, `acos`, `atan`")
            }
            "min" | "max" | "floor" | "ceil" | "round" | "mod" | "sign" | "sgn" | "signum" | "heaviside"
            | "Heaviside" | "step" | "Piecewise" => {
                Some("the expression must be smooth (`abs`, `sqrt` and `tanh` may serve)")
            }
            "cot" => Some("write `1/tan(x)`"),
            "sec" => Some("write `1/cos(x)`"),
            "csc" => Some("write `1/sin(x)`"),
            "asinh" | "acosh" | "atanh" | "arcsinh" | "arccosh" | "arctanh" => {
                Some("write it with `ln`, as in `ln(x + sqrt(x^2 + 1))`")
            }
            "cbrt" => Some("write `x^(1/3)`"),
            "hypot" => Some("write `sqrt(x^2 + y^2)`, or `norm(v)` of a vector"),
            "arctan2" => Some("the angle of a point is `atan2(y, x)`"),
            "diff" | "d" | "D" | "Derivative" | "derivative" | "ddt" => {
                Some("the total time derivative is `der(x)`, a velocity `x_dot`")
            }
            "Rational" | "Fraction" | "frac" => Some("fractions are exact as they are: write `1/2`"),
            "Vector" | "Matrix" | "vec" => Some("a vector is written `[a, b, c]`"),
            "integrate" | "Integral" => Some("there are no integrals"),
            _ => None,
        };
        let near = nearest(text, self.entities.keys().map(String::as_str).chain(FUNCTIONS));
        match (advice, near) {
            (Some(advice), _) => name.place.error(format!("there is no function `{text}`: {advice}")),
            (None, Some(near)) => {
                name.place.error(format!("there is no function `{text}`: did you mean `{near}`?"))
            }
            (None, None) => name
                .place
                .error(format!("there is no function `{text}`: define it with `#[define({text}(x) = …)]`, or supply it as a field named in `#[function({text}(x))]`")),
        }
    }

    /// The field of a function does not stand in expressions: the function does.
    fn is_field_of_function(&self, name: &Name) -> Option<syn::Error> {
        let function = self.functions.get(&name.text)?;
        let message =
            format!("the field `{}` is the function `{function}`: write `{function}(…)`", name.text);
        Some(name.place.error(message))
    }
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
        }
    }
}

pub(crate) fn is_built_in(name: &str) -> bool {
    FUNCTIONS.contains(&name) || CONSTANTS.contains(&name)
}

/// The candidate that differs by the least, if it differs by little; in capital letters least of all.
pub(super) fn nearest<'a>(name: &str, candidates: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let allowed = match name.chars().count() {
        0 | 1 => return None,
        2..=5 => 1,
        6..=8 => 2,
        _ => 3,
    };
    let distance = |candidate: &&str| match candidate.eq_ignore_ascii_case(name) {
        true => 0,
        false => strsim::damerau_levenshtein(name, candidate),
    };
    candidates.filter(|candidate| distance(candidate) <= allowed && *candidate != name).min_by_key(distance)
}
