//! The program in Rust that does what the page does.

use lagrange_interpreter::System;

use crate::Settings;
use crate::run::STEPS;

/// Program with the text as it was typed. Fields that the equations do not contain have no values.
pub(crate) fn program(text: &str, system: &System, settings: &Settings<'_>) -> String {
    let derive = if text.contains("derive(") { "" } else { "#[derive(Lagrangian)]\n" };
    let [q, v] =
        [settings.q, settings.v].map(|numbers| literal(&mut numbers.iter().copied(), &[numbers.len()]));
    let project = if system.constraints().is_empty() {
        ""
    } else {
        "    let (start, _) = system.make_consistent(&start)?;\n"
    };
    let method = match settings.method {
        "RungeKutta4" => format!("RungeKutta4::with_step({:?})", settings.end / STEPS),
        "Dopri5" => "Dopri5::with_tolerance(1e-8)".to_owned(),
        _ => "Dop853::with_tolerance(1e-10)".to_owned(),
    };
    format!(
        "use lagrange_core::prelude::*;\n\n{derive}{}\n\nfn main() -> Result<(), Error> {{\n    let system = {};\n    \
         let start = State::new({q}, {v});\n{project}    let path = system.integrate(start, {:?}, {method})?;\n    \
         println!(\"{{path}}\");\n    println!(\"{{}}\", path.csv(100));\n    Ok(())\n}}\n",
        text.trim(),
        instance(system, settings.parameters),
        settings.end,
    )
}

/// The struct with its fields, `Spring { m: 1.0, k: [2.0, 3.0] }`.
fn instance(system: &System, values: &[f64]) -> String {
    let fields = system.tapes().map(|tapes| tapes.parameters).unwrap_or_default();
    let fields = fields.iter().map(|field| {
        let value = |entry: &Option<usize>| entry.and_then(|place| values.get(place).copied()).unwrap_or(0.0);
        format!("{}: {}", field.name, literal(&mut field.entries.iter().map(value), &field.lengths))
    });
    let fields: Vec<String> = fields.collect();
    let name = system.name();
    if fields.is_empty() { name.to_owned() } else { format!("{name} {{ {} }}", fields.join(", ")) }
}

/// Nested arrays of these lengths.
fn literal(values: &mut dyn Iterator<Item = f64>, lengths: &[usize]) -> String {
    match lengths.split_first() {
        None => format!("{:?}", values.next().unwrap_or(0.0)),
        Some((&length, inner)) => {
            let items: Vec<String> = (0..length).map(|_| literal(values, inner)).collect();
            format!("[{}]", items.join(", "))
        }
    }
}
