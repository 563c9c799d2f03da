//! Names of the description as names of Rust and of the language of the attributes, each once.

use std::collections::HashSet;

use crate::options::Options;
use crate::tree::{Moving, Tree};

/// Words that are no names in Rust, and names with a meaning in expressions or among the fields that are written.
const TAKEN: &str = "as async await break const continue crate dyn else enum extern false fn for gen if impl in let loop \
    match mod move mut pub ref return self Self static struct super trait true type unsafe use where while abstract \
    become box do final macro override priv try typeof unsized virtual yield _ \
    t pi g fixed sin cos tan asin acos atan sinh cosh tanh exp ln abs atan2 sqrt quat_rotate quat_rate quat_rate_body \
    quat_mul quat_conj dot cross norm transpose trace identity skew rot rot_x rot_y rot_z min max clamp sum der lambda \
    position velocity angular_velocity jacobian kinetic express vector translate rotate rotate_x rotate_y rotate_z pose";

/// Names that are taken among types.
const TYPES: [&str; 7] = ["Body", "Contact", "Limit", "Matrix3", "Vector3", "Friction", "Self"];

/// Names of all that is written.
pub(crate) struct Labels {
    /// Name of the struct.
    pub(crate) robot: String,
    /// One for each moving link.
    pub(crate) links: Vec<Label>,
    /// One for each tool.
    pub(crate) tools: Vec<String>,
    /// Contacts with the floor.
    pub(crate) feet: Vec<String>,
    /// Coefficient of friction of the floor.
    pub(crate) mu: String,
    /// Names of the description with other names here.
    renamed: Vec<(String, String)>,
}

/// Names that belong to a moving link and its joint.
pub(crate) struct Label {
    pub(crate) frame: String,
    pub(crate) body: String,
    /// Coordinate, or the definition in its place.
    pub(crate) q: String,
    /// Quaternion of what is free in space.
    pub(crate) turn: String,
    pub(crate) tau: String,
    pub(crate) damping: String,
    pub(crate) friction: String,
    pub(crate) coulomb: String,
    /// Contacts at the limits of the joint.
    pub(crate) stops: [String; 2],
}

impl Labels {
    pub(crate) fn new(robot: &str, tree: &Tree, options: &Options) -> Self {
        let mut names = Names::default();
        let joints =
            tree.links.iter().map(|moving| moving.joint.map_or("place", |joint| joint.name.as_str()));
        let coordinates: Vec<String> = joints.map(|joint| names.renaming(joint, "joint")).collect();
        let frames: Vec<String> =
            tree.links.iter().map(|moving| names.renaming(&moving.link.name, "link")).collect();
        let labels = tree.links.iter().zip(coordinates).zip(frames);
        let links: Vec<Label> = labels.map(|((moving, q), frame)| names.label(moving, q, frame)).collect();
        let tools = tree.tools.iter().map(|tool| match &tree.links[tool.host] {
            moving if moving.link.name == tool.link => links[tool.host].frame.clone(),
            _ => names.renaming(tool.link, "tool"),
        });
        let tools = tools.collect();
        let feet = tree.feet.iter().map(|foot| names.claim(&format!("{}_floor", foot.link), "contact"));
        let feet = feet.collect();
        let mu = names.claim("mu", "floor");
        let robot = type_name(options.name.as_deref().unwrap_or(robot));
        Self { robot, links, tools, feet, mu, renamed: names.renamed }
    }

    /// True where names of fields have capitals, which rustc warns of.
    pub(crate) fn have_capitals(&self) -> bool {
        self.links
            .iter()
            .any(|label| (label.q.clone() + &label.frame).contains(|c: char| c.is_ascii_uppercase()))
    }

    /// A note on names that differ from those of the description.
    pub(crate) fn notes(&self) -> Option<String> {
        let pairs: Vec<String> =
            self.renamed.iter().map(|(from, to)| format!("`{from}` is `{to}`")).collect();
        (!pairs.is_empty()).then(|| format!("names that had to change: {}", pairs.join(", ")))
    }
}

/// Names that are taken, and those that had to change.
#[derive(Default)]
struct Names {
    taken: HashSet<String>,
    renamed: Vec<(String, String)>,
}

impl Names {
    fn label(&mut self, moving: &Moving, q: String, frame: String) -> Label {
        let turn = if moving.joint.is_some() { format!("{q}_turn") } else { "turn".to_owned() };
        let mut claim = |name: String| self.claim(&name, "field");
        Label {
            body: claim(format!("{frame}_body")),
            turn: claim(turn),
            tau: claim(format!("tau_{q}")),
            damping: claim(format!("{q}_damping")),
            friction: claim(format!("{q}_friction")),
            coulomb: claim(format!("{q}_coulomb")),
            stops: ["lower", "upper"].map(|end| claim(format!("{q}_{end}"))),
            q,
            frame,
        }
    }

    /// Claims a name of the description, and notes it down if it changes.
    fn renaming(&mut self, name: &str, kind: &str) -> String {
        let claimed = self.claim(name, kind);
        if claimed != name {
            self.renamed.push((name.to_owned(), claimed.clone()));
        }
        claimed
    }

    /// Makes a name of Rust of this one, and takes the first that is free: the name, with the kind after it, with a number.
    fn claim(&mut self, name: &str, kind: &str) -> String {
        let name = identifier(name, kind);
        let mut candidate = name.clone();
        let mut count = 1;
        while TAKEN.split_whitespace().any(|taken| taken == candidate)
            || !self.taken.insert(candidate.clone())
        {
            candidate = if count == 1 { format!("{name}_{kind}") } else { format!("{name}_{kind}_{count}") };
            count += 1;
        }
        candidate
    }
}

/// The name with `_` in place of all that is no letter or digit. Names of velocities and accelerations end in `_dot` and
/// `_ddot`, and no others.
fn identifier(name: &str, kind: &str) -> String {
    let words: Vec<&str> =
        name.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty()).collect();
    let mut text = words.join("_");
    if !text.starts_with(|c: char| c.is_ascii_alphabetic()) {
        text = if text.is_empty() { kind.to_owned() } else { format!("{kind}_{text}") };
    }
    if text.ends_with("_dot") || text.ends_with("_ddot") {
        text.push('_');
    }
    text
}

/// The name in camel case.
fn type_name(name: &str) -> String {
    let words = name.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    let name: String = words.map(|word| word[..1].to_ascii_uppercase() + &word[1..]).collect();
    if name.is_empty() || TYPES.contains(&name.as_str()) || name.starts_with(|c: char| c.is_ascii_digit()) {
        return format!("Robot{name}");
    }
    name
}

/// The most similar name, if it is similar enough: the bounds are those of names in `lagrange-core`.
pub(crate) fn nearest<'a>(name: &str, known: &[&'a str]) -> Option<&'a str> {
    let allowed = match name.chars().count() {
        0 | 1 => return None,
        2..=4 => 1,
        5..=8 => 2,
        _ => 3,
    };
    let apart = |known: &str| {
        if known.eq_ignore_ascii_case(name) { 0 } else { strsim::damerau_levenshtein(name, known) }
    };
    known.iter().copied().filter(|known| apart(known) <= allowed).min_by_key(|known| apart(known))
}

/// End of a message on a name that is not known.
pub(crate) fn suggestion(name: &str, known: &[&str]) -> String {
    nearest(name, known)
        .filter(|near| *near != name)
        .map_or(String::new(), |near| format!(": did you mean `{near}`?"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_one_of_rust_and_given_once() {
        let mut names = Names::default();
        let given = [
            "elbow",
            "elbow",
            "elbow",
            "base-link",
            "base link",
            "7th",
            "t",
            "type",
            "x_dot",
            "",
            "é",
            "_a",
            "wheel__left_",
        ];
        let claimed = given.map(|name| names.renaming(name, "joint"));
        let expected = [
            "elbow",
            "elbow_joint",
            "elbow_joint_2",
            "base_link",
            "base_link_joint",
            "joint_7th",
            "t_joint",
            "type_joint",
            "x_dot_",
            "joint",
            "joint_joint",
            "a",
            "wheel_left",
        ];
        assert_eq!(claimed, expected);
        assert_eq!(names.renamed.len(), 12);
    }

    /// Words in quotes of a constant of the macro, without those that no expression may call.
    fn words(file: &str, constant: &str) -> Vec<String> {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../lagrange-macros").join(file);
        let text = std::fs::read_to_string(path).expect("the macro beside this crate");
        let start = text.find(constant).expect("the constant");
        let body =
            text[start..].split_once('=').and_then(|(_, rest)| rest.split_once(';')).expect("its value").0;
        let quoted = body.split('"').skip(1).step_by(2).flat_map(|words| words.split([' ', '\n', '\\']));
        let words = quoted.filter(|word| !word.is_empty() && !["ramp", "step"].contains(word));
        words.map(str::to_owned).collect()
    }

    #[test]
    fn names_of_the_language_are_taken() {
        let taken: Vec<&str> = TAKEN.split_whitespace().collect();
        for (file, constant, least) in [
            ("derive/src/resolve/scope.rs", "const CALLS", 20),
            ("derive/src/resolve/scope.rs", "const CONSTANTS", 2),
            ("derive/src/resolve/frames/spatial.rs", "const CALLS", 7),
            ("symbolic/src/graph.rs", "const NAMES", 10),
        ] {
            let words = words(file, constant);
            assert!(words.len() >= least, "{file}: {words:?}");
            let free: Vec<_> = words.iter().filter(|word| !taken.contains(&word.as_str())).collect();
            assert!(free.is_empty(), "{file}: {free:?}");
        }
    }

    #[test]
    fn a_robot_has_the_name_of_a_type() {
        let names = ["two_link-arm", "UR5", "7dof", "body", "", "Body"].map(type_name);
        assert_eq!(names, ["TwoLinkArm", "UR5", "Robot7dof", "RobotBody", "Robot", "RobotBody"]);
    }
}
