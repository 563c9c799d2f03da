//! Writes long systems as source files with the oracle's solutions, for `tests/long` to compile and compare with.

use std::collections::BTreeMap;
use std::fmt::Write;

use quote::ToTokens;

use super::draft::Draft;
use super::{forest, oracle};

/// Types of fields that become members: type, text of the member's kind in the attribute, name of the member.
const MEMBERS: [(&str, &str, &str); 5] = [
    ("f64", "", "x"),
    ("Vector3<f64>", ": [3]", "v"),
    ("Matrix3<f64>", ": [3, 3]", "a"),
    ("Rotation3<f64>", ": rotation", "r"),
    ("UnitQuaternion<f64>", ": quaternion", "u"),
];

/// `LAGRANGE_LONG=first..last` selects the systems, `LAGRANGE_LONG_FOLDER` the folder for the files.
#[test]
fn long_systems_are_written() {
    let asked = |name: &str| std::env::var(name).ok();
    let range = asked("LAGRANGE_LONG").unwrap_or_else(|| "0..3".into());
    let (first, last) = range.split_once("..").expect("first..last");
    for number in first.parse().expect("a number")..last.parse::<u64>().expect("a number") {
        let Some(folder) = asked("LAGRANGE_LONG_FOLDER") else {
            parsed(&written(number, &forest::long(number), true));
            continue;
        };
        // If the mass matrix exceeds the length limit of a function, take the next system of the same kind.
        let drafts = (0..).map(|again| forest::long(number + 12_000 * again));
        let text = { drafts }.find_map(|draft| accepted(number, &draft)).expect("one that is short enough");
        std::fs::write(format!("{folder}/s{number}.rs"), text).expect("a folder");
    }
}

fn parsed(text: &str) -> syn::File {
    syn::parse_file(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// Source of the module of a system, `None` if the derive refuses it. The module asks for Jacobians unless the
/// derive leaves them out for their length.
fn accepted(number: u64, draft: &Draft) -> Option<String> {
    let file = parsed(&written(number, draft, true));
    let system =
        file.items.iter().find(|item| matches!(item, syn::Item::Struct(item) if item.ident == "System"));
    let emitted = crate::expand(system.to_token_stream()).to_string();
    let is_refused = emitted.contains("compile_error");
    (!is_refused).then(|| written(number, draft, emitted.contains("StateDerivatives")))
}

/// Source of the module of a system, with fields as they are, in arrays, or in an array of structs.
fn written(number: u64, draft: &Draft, has_jacobians: bool) -> String {
    let solution = oracle::solve(&draft.model);
    assert!(solution.pivot > 1e-7, "system {number} is all but singular: {:e}", solution.pivot);
    let attributes = draft.attributes();
    let Layout { names, parameter, fields, made, structs } = Layout::new(draft, &attributes, number % 4);
    let attributes = renamed(&attributes, &names);
    let model = &draft.model;
    let multipliers: Vec<String> = draft
        .multipliers
        .iter()
        .zip(&solution.multipliers)
        .map(|(name, x)| format!("(\"{name}\", {x:?})"))
        .collect();
    format!(
        "//! System {number} of `.ci/long/run`: {count} frames.\n\n#![allow(unused_imports)]\n\nuse lagrange_core::nalgebra::{{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3}};
use lagrange_core::prelude::*;\n\n{structs}#[derive(Lagrangian, Clone, Debug)]\n{parameter}{attributes}struct System<T> {{ {fields} }}\n
pub(crate) fn check() -> Result<(), String> {{
    let system = System::<f64> {{ {made} }};
    let state = State::new({q:?}, {v:?}).at_time({t:?});
    super::drive!(\"{number}\", system, state, {accelerations:?}, [{multipliers}]);{jacobians}
    Ok(())
}}\n",
        count = draft.attributes().matches("#[frame(").count(),
        q = model.coordinates,
        v = model.velocities,
        t = model.time,
        accelerations = solution.accelerations,
        multipliers = multipliers.join(", "),
        jacobians = match has_jacobians {
            true => format!("\n    super::jacobians!(\"{number}\", system, state);"),
            false => String::new(),
        },
    )
}

/// Declarations and values of the fields.
#[derive(Default)]
struct Layout {
    /// Expression that replaces a field, if it is not the field's name.
    names: BTreeMap<String, String>,
    parameter: String,
    fields: String,
    made: String,
    structs: String,
}

impl Layout {
    fn new(draft: &Draft, attributes: &str, kind: u64) -> Self {
        let mut layout = Self::default();
        let mut members: Vec<Vec<String>> = vec![Vec::new(); MEMBERS.len()];
        for (name, ty, numbers) in &draft.fields {
            let is_plain = kind == 0 || attributes.contains(&format!("parameter({name}:"));
            let member = MEMBERS.iter().position(|(known, ..)| known == ty).filter(|_| !is_plain);
            if let Some(k) = member {
                let place = members[k].len();
                let text = if kind == 1 {
                    format!("{}[{place}]", MEMBERS[k].2)
                } else {
                    format!("link[{place}].{}", MEMBERS[k].2)
                };
                layout.names.insert(name.clone(), text);
                members[k].push(value(ty, numbers));
            } else {
                layout.field(name, &over(ty), &value(ty, numbers));
            }
        }
        match kind {
            0 => {}
            1 => layout.arrays(&members),
            _ => layout.links(&members),
        }
        layout
    }

    fn field(&mut self, name: &str, ty: &str, value: &str) {
        write!(self.fields, "{name}: {ty}, ").expect("a string");
        write!(self.made, "{name}: {value}, ").expect("a string");
    }

    fn arrays(&mut self, members: &[Vec<String>]) {
        for ((ty, _, name), values) in MEMBERS.iter().zip(members).filter(|(_, values)| !values.is_empty()) {
            self.field(
                name,
                &format!("[{}; {}]", over(ty), values.len()),
                &format!("[{}]", values.join(", ")),
            );
        }
    }

    /// A link that lacks a member gets the value of the first link.
    fn links(&mut self, members: &[Vec<String>]) {
        let used: Vec<usize> = (0..MEMBERS.len()).filter(|&k| !members[k].is_empty()).collect();
        let count = members.iter().map(Vec::len).max().unwrap_or(0);
        let said: Vec<String> = used.iter().map(|&k| format!("{}{}", MEMBERS[k].2, MEMBERS[k].1)).collect();
        self.parameter = format!("#[parameter(link: [{count}] {{{}}})]\n", said.join(", "));
        let declared: Vec<String> =
            used.iter().map(|&k| format!("{}: {}", MEMBERS[k].2, over(MEMBERS[k].0))).collect();
        self.structs = format!("#[derive(Clone, Debug)]\nstruct Link<T> {{ {} }}\n\n", declared.join(", "));
        let each = |said: fn(&str) -> String| used.iter().map(|&k| said(MEMBERS[k].2)).collect::<String>();
        write!(
            self.structs,
            "impl lagrange_core::Packed<Link<f64>> for Link<lagrange_core::Lanes> {{
    fn splat(link: &Link<f64>) -> Self {{ Self {{ {} }} }}\n
    fn place(&mut self, lane: usize, link: &Link<f64>) {{ {} }}\n}}\n\n",
            each(|name| format!("{name}: lagrange_core::Packed::splat(&link.{name}), ")),
            each(|name| format!("lagrange_core::Packed::place(&mut self.{name}, lane, &link.{name}); ")),
        )
        .expect("a string");
        let link = |i: usize| {
            let values: Vec<String> = used
                .iter()
                .map(|&k| format!("{}: {}", MEMBERS[k].2, members[k].get(i).unwrap_or(&members[k][0])))
                .collect();
            format!("Link {{ {} }}", values.join(", "))
        };
        let links: Vec<String> = (0..count).map(link).collect();
        self.field("link", &format!("[Link<T>; {count}]"), &format!("[{}]", links.join(", ")));
    }
}

/// The type with `T` for `f64`.
fn over(ty: &str) -> String {
    ty.replace("f64", "T")
}

/// Rust expression for a value of this type, from its numbers row by row.
fn value(ty: &str, numbers: &[f64]) -> String {
    let list = |numbers: &[f64]| numbers.iter().map(|x| format!("{x:?}")).collect::<Vec<_>>().join(", ");
    let all = list(numbers);
    match ty {
        "f64" => all,
        "Vector3<f64>" => format!("Vector3::new({all})"),
        "Matrix3<f64>" => format!("Matrix3::new({all})"),
        "Rotation3<f64>" => format!("Rotation3::from_matrix_unchecked(Matrix3::new({all}))"),
        "UnitQuaternion<f64>" => format!("UnitQuaternion::new_unchecked(Quaternion::new({all}))"),
        _ => format!("[{all}]"),
    }
}

/// Replaces words of a text.
fn renamed(text: &str, names: &BTreeMap<String, String>) -> String {
    let mut renamed = String::new();
    for piece in text.split_inclusive(|c: char| !c.is_alphanumeric() && c != '_') {
        let word = piece.trim_end_matches(|c: char| !c.is_alphanumeric() && c != '_');
        renamed += names.get(word).map_or(word, String::as_str);
        renamed += &piece[word.len()..];
    }
    renamed
}
