//! Parses the rendered page: lagrange-core finds the same number of rows in each form, and leaves nothing over.

use super::everywhere::pages;
use super::systems::share;
use excerpt::Excerpt;

#[expect(dead_code, unreachable_pub, reason = "a module of lagrange-core, which has more uses for it")]
#[path = "../../../../../lagrange-core/src/system/equations/excerpt.rs"]
mod excerpt;

const HEADINGS: [&str; 10] = [
    "Lagrangian",
    "Constraints",
    "Equations of motion",
    "Constraint forces",
    "Conserved",
    "Energy",
    "Momenta",
    "Hamiltonian",
    "Hamilton's equations",
    "Total time derivatives in the Lagrangian",
];

fn check([text, latex, html]: [&'static str; 3]) {
    let name = text.lines().next().expect("a name");
    let (mut lines, mut equations, mut formulas) = (vec![name.to_owned()], String::new(), String::new());
    for heading in HEADINGS {
        let excerpt = Excerpt::below(heading, [text, latex, html]);
        assert_eq!(excerpt.is_empty(), !text.contains(&format!("\n\n{heading}\n")), "{heading} in {text}");
        if excerpt.is_empty() {
            continue;
        }
        let all = excerpt.to_string();
        lines.extend(["".to_owned(), heading.to_owned()]);
        lines.extend(all.lines().map(|line| format!("  {line}")));
        equations += &format!("{}{heading}}}\n{}", excerpt::LATEX_HEADING, excerpt.latex());
        formulas += &format!("<h5>{heading}</h5>\n{}", excerpt.mathml());
        let rows: Vec<Excerpt> = excerpt.rows().collect();
        assert_eq!(rows.len(), latex_rows(&excerpt.latex().to_string()), "{heading} in {latex}");
        assert_eq!(rows.len(), all.lines().filter(|line| is_row(line)).count(), "{heading} in {text}");
        for row in rows {
            assert!(all.lines().any(|line| line == row.to_string()), "{row} in {text}");
            assert_eq!(latex_rows(&row.latex().to_string()), 1, "{row} in {latex}");
            assert!(
                html.contains(row.mathml().to_string().lines().nth(1).expect("a row")),
                "{row} in {html}"
            );
        }
    }
    assert_eq!(lines.join("\n") + "\n", text);
    assert_eq!(format!("\\begingroup\\allowdisplaybreaks\n{equations}\\endgroup\n"), latex);
    assert!(html.ends_with(&format!("{formulas}</div>\n")), "{formulas} of {html}");
}

fn latex_rows(latex: &str) -> usize {
    latex.matches(r"\label{eq:").count()
}

/// Returns whether a line is a row, not a note.
fn is_row(line: &str) -> bool {
    let notes =
        ["velocity constraints, or", "take fewer operations", "not written out, as", "three angles or more"];
    let is_note = notes.iter().any(|note| line.contains(note)) || line.starts_with("by `#[frame");
    !is_note
}

#[test]
fn pages_come_apart() {
    pages().flatten().for_each(|form| check(form.each_ref().map(String::as_str)));
    assert!(pages().count() > 250 / (2 * share()), "{} systems only", pages().count());
}
