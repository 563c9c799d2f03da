//! Errors for unknown names, with a suggestion of the name probably meant.

use super::scope::{CONSTANTS, Entity, Scope, functions};
use crate::syntax::{GREEK, Name};

/// Names of common quantities in other tools, separated by spaces, and the advice for each group.
const NAMES: [(&str, &str); 8] = [
    ("fixed", "it is the frame at rest, and stands where a frame is asked for: `express(v, fixed)`"),
    ("time Time", "the time is `t`"),
    ("e E exp1", "a parameter is a field of the struct, and the exponential function is `exp(x)`"),
    ("deg degree degrees rad radians", "angles are in radians, and a degree is `pi/180`"),
    ("inf Inf infinity oo nan NaN", "the expression must have a value everywhere"),
    ("TAU", "a full turn is `2*pi`"),
    ("π", "it is written `pi`"),
    (
        "position",
        "of a frame it is `position(frame, [x, y, z])`, which does not stand in definitions with arguments",
    ),
];

/// Groups of synonyms, such as a letter and a word for the same quantity.
const SYNONYMS: [&str; 8] = [
    "m mass",
    "g gravity gravitation",
    "l L len length",
    "k stiffness spring spring_constant",
    "c b damping friction",
    "r R radius",
    "q charge",
    "omega w frequency angular_velocity",
];

/// Names of functions in other tools, separated by spaces, and the advice for each group.
const CALLS: [(&str, &str); 31] = [
    (
        "Min minimum Max maximum saturate sat",
        "the smaller and the larger of two are `min(x, y)` and `max(x, y)`, a limit on both sides `clamp(x, low, high)`",
    ),
    ("log Log log2 log10", "the natural logarithm is `ln`"),
    ("pow Pow powi powf Power", "a power is written `x^2`"),
    ("sqr square sq squared", "a square is written `x^2`"),
    ("fabs magnitude", "the absolute value is `abs(x)`, the length of a vector `norm(v)`"),
    ("arcsin arccos arctan ArcSin ArcCos ArcTan", "inverse functions are `asin`, `acos`, `atan`"),
    (
        "sign sgn signum Sign",
        "the expression must be smooth (`tanh` may serve); dry friction is `#[friction(name: velocity, limit: …, sliding: …)]`, by a field `name: Friction`",
    ),
    (
        "omega Omega",
        "the angular velocity of a frame is `angular_velocity(frame)`, and a function of yours is supplied as a field named in `#[function(…)]`",
    ),
    (
        "floor ceil round mod heaviside Heaviside step Piecewise",
        "the expression must be smooth (`abs`, `sqrt` and `tanh` may serve, and `min`, `max` and `clamp` in forces)",
    ),
    ("cot", "write `1/tan(x)`"),
    ("sec", "write `1/cos(x)`"),
    ("csc", "write `1/sin(x)`"),
    ("asinh acosh atanh arcsinh arccosh arctanh", "write it with `ln`, as in `ln(x + sqrt(x^2 + 1))`"),
    ("cbrt", "write `x^(1/3)`"),
    ("hypot", "write `sqrt(x^2 + y^2)`, or `norm(v)` of a vector"),
    ("arctan2 ArcTan2 Atan2", "the angle of a point is `atan2(y, x)`"),
    (
        "diff Diff d D Dt Derivative derivative ddt",
        "the total time derivative is `der(x)`, a velocity `x_dot`",
    ),
    ("Rational Fraction frac", "fractions are exact as they are: write `1/2`"),
    ("Vector vec vector vec2 vec3 Vec2 Vec3 Vector2 Vector3", "a vector is written `[a, b, c]`"),
    ("Matrix mat matrix", "a matrix is written by its rows, `[[a, b], [c, d]]`"),
    ("eye Identity unit_matrix", "the matrix that changes nothing is `identity(3)`"),
    ("transp Transpose tr", "the transpose is `transpose(A)`, the sum of the diagonal `trace(A)`"),
    ("hat tilde wedge cross_matrix", "the matrix of `cross(v, …)` is `skew(v)`"),
    (
        "Rx Ry Rz rotx roty rotz RotX RotY RotZ rotate rotation Rotation",
        "the rotations about the axes are `rot_x(angle)`, `rot_y(angle)` and `rot_z(angle)`, about any other `rot(axis, angle)`",
    ),
    ("det determinant Det", "there are no determinants: write it out, as in `dot(cross(A[0], A[1]), A[2])`"),
    ("matmul multiply mul", "a product is written `A*B`"),
    (
        "inv inverse Inverse",
        "there is no inverse; that of a rotation is `transpose(R)`, that of a quaternion of length 1 `quat_conj(q)`",
    ),
    ("integrate Integral", "there are no integrals"),
    ("deg rad radians degrees deg2rad", "angles are in radians: write `x*pi/180`"),
    ("sind cosd tand", "angles are in radians: write `sin(x*pi/180)`"),
    (
        "prod product Product",
        "products of many are defined one by one: `#[define(p[i in 1..3] = p[i-1]*a[i])]`",
    ),
];

/// Suffixes for velocities and accelerations in other tools, longest first, and the suffix used here.
const RATE_SUFFIXES: [(&str, &str); 2] =
    [("_dot_dot _dotdot dotdot _ddot ddot", "_ddot"), ("_dot dot _prime _dt _do _d _t", "_dot")];
const RATE_PREFIXES: [(&str, &str); 2] = [("dd d2", "_ddot"), ("dot_ d v_ v", "_dot")];

/// Pairs every word of a table with the advice beside it.
fn words<'t>(table: &[(&'t str, &'t str)]) -> impl Iterator<Item = (&'t str, &'t str)> {
    table.iter().flat_map(|&(words, beside)| words.split(' ').map(move |word| (word, beside)))
}

fn listed(table: &[(&'static str, &'static str)], name: &str) -> Option<&'static str> {
    words(table).find(|(known, _)| *known == name).map(|(_, advice)| advice)
}

impl Scope {
    /// Error for an unknown name, with a suggestion.
    pub(super) fn unknown(&self, name: &Name, more: &[String]) -> syn::Error {
        let text = &name.text;
        if let Some(error) = self.is_field_of_function(name).or_else(|| self.is_no_velocity(name)) {
            return error;
        }
        let candidates = self.known().chain(CONSTANTS).chain(more.iter().map(String::as_str));
        let advice = product(text)
            .or_else(|| listed(&NAMES, text).map(String::from))
            .or_else(|| is_function(text))
            .or_else(|| self.element(text))
            .or_else(|| self.velocity(text))
            .or_else(|| self.synonym(text).or_else(|| nearest(text, candidates)).map(did_you_mean))
            .or_else(|| rate_of_none(text));
        let advice = advice.unwrap_or_else(|| "make it a field, a coordinate or a `#[define(…)]`".to_owned());
        name.place.error(format!("nothing is called `{text}`: {advice}"))
    }

    /// Error for an unknown function, with a suggestion.
    pub(super) fn unknown_function(&self, name: &Name) -> syn::Error {
        let text = &name.text;
        if let Some(error) = self.is_field_of_function(name) {
            return error;
        }
        let callable: Vec<&str> = functions().filter(|&function| function != "in").collect();
        let advice = product(text).or_else(|| listed(&CALLS, text).map(String::from));
        let advice = advice.or_else(|| nearest(text, self.known().chain(callable)).map(did_you_mean));
        let advice = advice.unwrap_or_else(|| {
            format!("define it with `#[define({text}(x) = …)]`, or supply it as a field named in `#[function({text}(x))]`")
        });
        name.place.error(format!("there is no function `{text}`: {advice}"))
    }

    /// Error for the field that holds a supplied function: expressions name the function, not the field.
    fn is_field_of_function(&self, name: &Name) -> Option<syn::Error> {
        let function = self.functions.get(&name.text)?;
        let message =
            format!("the field `{}` is the function `{function}`: write `{function}(…)`", name.text);
        Some(name.place.error(message))
    }

    /// Error for `z_dot` where `z` is a field or a definition, not a coordinate.
    fn is_no_velocity(&self, name: &Name) -> Option<syn::Error> {
        let text = &name.text;
        let base = text.strip_suffix("_dot").or_else(|| text.strip_suffix("_ddot"))?;
        let entity = self.get(base)?;
        let kind = entity.describe();
        matches!(entity, Entity::Definition(_) | Entity::Field(_)).then(|| {
            name.place.error(format!(
                "`{text}` would be the velocity of a coordinate, but `{base}` is {kind}: write `der({base})`"
            ))
        })
    }

    /// Suggests elements of an array for names such as `m1`, `theta2_dot` or `theta_dot_2`.
    fn element(&self, text: &str) -> Option<String> {
        let (base, rate) = self.rate(text).unwrap_or((text, ""));
        let name = without_number(base);
        let (array, inner) = self.rate(name).unwrap_or((name, ""));
        let length = self.lengths.get(array).filter(|_| name != base)?;
        Some(format!(
            "the elements of `{array}` are `{array}{rate}{inner}[0]` to `{array}{rate}{inner}[{}]`",
            length - 1
        ))
    }

    /// Suggests a velocity for names such as `xdot`, `dx`, `x_dot_dot` or `vel`.
    fn velocity(&self, text: &str) -> Option<String> {
        if let Some((base, rate)) = self.rate(text).filter(|(base, _)| self.is_coordinate(base)) {
            return Some(did_you_mean(&format!("{base}{rate}")));
        }
        let first = self.known().find(|name| self.is_coordinate(name))?;
        let is_velocity = ["v", "vel", "velocity", "speed"].contains(&text);
        is_velocity.then(|| format!("the velocity of `{first}` is `{first}_dot`"))
    }

    /// Splits a name into a coordinate, or an element of one, and the suffix `_dot` or `_ddot` of its derivative.
    fn rate<'t>(&self, text: &'t str) -> Option<(&'t str, &'static str)> {
        let suffixed = words(&RATE_SUFFIXES).map(|(suffix, rate)| (text.strip_suffix(suffix), rate));
        let prefixed = words(&RATE_PREFIXES).map(|(prefix, rate)| (text.strip_prefix(prefix), rate));
        let mut split = suffixed.chain(prefixed).filter_map(|(base, rate)| Some((base?, rate)));
        split.find(|(base, _)| self.is_coordinate(without_number(base)) || self.is_coordinate(base))
    }

    fn is_coordinate(&self, name: &str) -> bool {
        matches!(self.get(name), Some(Entity::Coordinate(_)))
    }

    /// A known name for the same quantity, such as a Greek letter for its Latin spelling.
    fn synonym(&self, text: &str) -> Option<&str> {
        let plain = latin(text);
        if let Some(same) = self.known().find(|known| latin(known) == plain) {
            return Some(same);
        }
        let group = SYNONYMS.iter().find(|group| group.split(' ').any(|name| name == text))?;
        self.known().find(|known| group.split(' ').any(|name| name == *known))
    }

    fn known(&self) -> impl Iterator<Item = &str> {
        self.entities.keys().map(String::as_str)
    }
}

/// Advice for names with a dot between factors, which Rust takes for a letter.
fn product(text: &str) -> Option<String> {
    text.contains('·').then(|| format!("a product is written `{}`", text.replace('·', "*")))
}

fn did_you_mean(name: &str) -> String {
    format!("did you mean `{name}`?")
}

/// Ends a message about the unknown name `text`: suggests the nearest name, or lists the names that are least unlike it and
/// the number of the others.
pub(super) fn or_meant<'n>(
    text: &str,
    near: Option<&str>,
    kind: &str,
    names: impl Iterator<Item = &'n str>,
) -> String {
    if let Some(near) = near {
        return format!(": {}", did_you_mean(near));
    }
    let mut names: Vec<&str> = names.collect();
    let more = if names.len() > NAMED + 1 { names.len() - NAMED } else { 0 };
    if more > 0 {
        names.sort_by_key(|name| distance(text, name));
        names.truncate(NAMED);
    }
    let mut names: Vec<String> = names.into_iter().map(|name| format!("`{name}`")).collect();
    let last = if more > 0 { format!("{more} more") } else { names.pop().unwrap_or_default() };
    match (&names[..], &*last) {
        ([], "") => format!(": there are no {kind}s"),
        ([], only) => format!(": the only {kind} is {only}"),
        (names, last) => format!(": the {kind}s are {} and {last}", names.join(", ")),
    }
}

/// Number of names listed in a message that counts the others; a single other one is listed too.
const NAMED: usize = 3;

/// Advice for the name of a function in the place of a value, such as `Sin`.
fn is_function(text: &str) -> Option<String> {
    let function = functions().find(|function| function.eq_ignore_ascii_case(text))?;
    Some(format!("functions are written `{function}(x)`"))
}

/// Advice for `y_dot` if nothing is called `y`.
fn rate_of_none(text: &str) -> Option<String> {
    let rates = [("_dot", "velocity"), ("_ddot", "acceleration")];
    let (base, rate) = rates.iter().find_map(|(suffix, rate)| Some((text.strip_suffix(suffix)?, rate)))?;
    (!base.is_empty())
        .then(|| format!("it would be the {rate} of `{base}`: add `{base}` to the `#[coordinates(…)]`"))
}

/// Strips a trailing number: `m` from `m2` and from `m_2`.
fn without_number(text: &str) -> &str {
    let name = text.trim_end_matches(|c: char| c.is_ascii_digit());
    if name.len() < text.len() { name.trim_end_matches('_') } else { text }
}

/// Spells out Greek letters and combining dots in Latin letters.
fn latin(text: &str) -> String {
    let text = GREEK.iter().fold(text.to_owned(), |text, (latin, greek)| text.replace(greek, latin));
    text.replace("var", "").replace('\u{307}', "_dot").replace('\u{308}', "_ddot")
}

/// Nearest candidate within the allowed distance. A difference in capitals alone counts as distance 0.
pub(super) fn nearest<'a>(name: &str, candidates: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let near = candidates.filter(|candidate| *candidate != name && !are_apart(name, candidate));
    near.map(|candidate| (distance(name, candidate), candidate))
        .filter(|(distance, _)| *distance <= allowed(name))
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

/// Maximum distance of a suggestion from a name, in units of [`distance`].
fn allowed(name: &str) -> usize {
    match name.chars().count() {
        0..=2 => 0,
        3..=5 => 2,
        6..=8 => 4,
        _ => 6,
    }
}

/// Returns whether two names are surely distinct, as `m1` and `m2`, `psi` and `phi`, or `x_dot` and `y_dot` are.
fn are_apart(name: &str, other: &str) -> bool {
    let digits = |text: &str| text.chars().filter(char::is_ascii_digit).collect::<String>();
    let numbers = [digits(name), digits(other)];
    let have_numbers = numbers.iter().all(|number| !number.is_empty());
    let words = || name.split('_').zip(other.split('_'));
    let are_as_many = name.matches('_').count() == other.matches('_').count();
    have_numbers && numbers[0] != numbers[1]
        || are_as_many && words().any(|(word, other)| are_other_words(word, other))
}

fn are_other_words(word: &str, other: &str) -> bool {
    let is_letter = |text: &str| GREEK.iter().any(|(latin, _)| latin.eq_ignore_ascii_case(text));
    is_letter(word) && is_letter(other) && !word.eq_ignore_ascii_case(other)
        || distance(word, other) > allowed(word)
}

/// Twice the Damerau–Levenshtein distance. Permuted letters, as in `tetha`, count 1, and capitals 0.
fn distance(name: &str, other: &str) -> usize {
    let sorted = |text: &str| {
        let mut letters: Vec<char> = text.chars().collect();
        letters.sort_unstable();
        letters
    };
    if other.eq_ignore_ascii_case(name) {
        0
    } else if sorted(name) == sorted(other) {
        1
    } else {
        2 * strsim::damerau_levenshtein(name, other)
    }
}
