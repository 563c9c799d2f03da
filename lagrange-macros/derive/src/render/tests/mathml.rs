//! Parses MathML as XML, and converts it to a line of text.

use unicode_normalization::UnicodeNormalization;

use crate::render::formula::Formula;
use crate::render::notation::Notation;
use crate::render::tests::systems::System;

/// An XML element with its contents, or text.
#[derive(Debug)]
enum Xml {
    Element { name: String, attributes: String, inside: Vec<Self> },
    Text(String),
}

/// Elements of HTML and MathML Core that the pages use.
const ELEMENTS: [&str; 24] = [
    "div",
    "h5",
    "p",
    "span",
    "wbr",
    "math",
    "mi",
    "mn",
    "mo",
    "mtext",
    "mspace",
    "mrow",
    "mfrac",
    "msqrt",
    "msub",
    "msup",
    "msubsup",
    "mover",
    "munder",
    "munderover",
    "mtable",
    "mtr",
    "mtd",
    "root",
];

/// Required number of children of these elements.
const PARTS: [(&str, usize); 7] =
    [("mfrac", 2), ("msub", 2), ("msup", 2), ("msubsup", 3), ("mover", 2), ("munder", 2), ("munderover", 3)];

/// Parses a text, which must be well-formed.
fn parsed(text: &str) -> Vec<Xml> {
    let mut open: Vec<(String, String, Vec<Xml>)> = vec![("root".into(), String::new(), Vec::new())];
    let mut rest = text;
    while let Some((before, tag)) = rest.split_once('<') {
        assert!(!before.contains('>') && !before.contains('&'), "a sign that stands for itself: {before}");
        let top = open.last_mut().expect("the root");
        if !before.trim().is_empty() {
            top.2.push(Xml::Text(before.to_owned()));
        }
        let (tag, after) = tag.split_once('>').expect("the end of a tag");
        rest = after;
        if let Some(name) = tag.strip_prefix('/') {
            let (opened, attributes, inside) = open.pop().expect("one that is open");
            assert_eq!(opened, name, "{text}");
            let element = checked(opened, attributes, inside);
            open.last_mut().expect("the root").2.push(element);
        } else if let Some(name) = tag.strip_suffix('/') {
            top.2.push(checked(name.to_owned(), String::new(), Vec::new()));
        } else {
            let (name, attributes) = tag.split_once(' ').unwrap_or((tag, ""));
            assert_eq!(attributes.matches("=\"").count() * 2, attributes.matches('"').count(), "{tag}");
            open.push((name.to_owned(), attributes.to_owned(), Vec::new()));
        }
    }
    let (root, _, inside) = open.pop().expect("the root");
    assert!(root == "root" && rest.trim().is_empty(), "{root} is not closed in {text}");
    inside
}

fn checked(name: String, attributes: String, inside: Vec<Xml>) -> Xml {
    assert!(ELEMENTS.contains(&&*name), "{name} is no element");
    if let Some((_, count)) = PARTS.iter().find(|(known, _)| *known == name) {
        assert_eq!(inside.len(), *count, "{name} of {inside:?}");
    }
    let is_leaf = ["mi", "mn", "mo", "mtext", "h5"].contains(&&*name);
    assert!(!is_leaf || matches!(inside[..], [Xml::Text(_)]), "{name} of {inside:?}");
    Xml::Element { name, attributes, inside }
}

impl Xml {
    fn is(&self, wanted: &str) -> bool {
        matches!(self, Self::Element { name, .. } if name == wanted)
    }

    fn has(&self, wanted: &str) -> bool {
        matches!(self, Self::Element { attributes, .. } if attributes.contains(wanted))
    }

    fn inside(&self) -> &[Self] {
        match self {
            Self::Element { inside, .. } => inside,
            Self::Text(_) => &[],
        }
    }

    /// The formulas of a formula that is folded where a line is short; any other element is itself.
    fn unfolded(&self) -> &[Self] {
        if self.has("inline-flex") { self.inside() } else { core::slice::from_ref(self) }
    }

    /// All text inside.
    fn text(&self) -> String {
        match self {
            Self::Text(text) => text.clone(),
            Self::Element { inside, .. } => inside.iter().map(Self::text).collect(),
        }
    }

    /// Line of text that an element stands for by itself.
    fn said(&self) -> String {
        let (Self::Element { name, inside, .. }, text) = (self, || self.text().nfkc().collect::<String>())
        else {
            return self.text();
        };
        match (&**name, &inside[..]) {
            ("mi" | "mtext", _) => self.text().replace([' ', '\u{a0}'], "_"),
            ("mn", _) => text(),
            ("mo", _) => operator(self),
            ("mrow" | "mtd", all) => line(all.iter()),
            ("mtable", rows) => separated(rows),
            ("mtr", entries) => format!("[{}]", separated(entries)),
            ("mfrac", [above, below]) if is_differential(above) => {
                format!("{}/{}", differential(above), differential(below))
            }
            ("mfrac", [above, below]) if above.text() == "d" && below.text() == "dt" => "d/dt ".to_owned(),
            ("mfrac", [above, below]) => format!("(({})/({}))", above.said(), below.said()),
            ("msqrt", all) => format!("√({})", line(all.iter())),
            ("msub", [base, below]) => indexed(base, below),
            ("msubsup", [base, below, above]) if above.text().starts_with('′') => {
                indexed(base, below) + &above.text()
            }
            ("msubsup", [base, below, above]) if above.has("normal") && above.text() == "T" => {
                indexed(base, below) + "ᵀ"
            }
            ("msubsup", [base, below, above]) => format!("({})^({})", indexed(base, below), above.said()),
            ("msup", [base, above]) if above.text().starts_with('′') => base.said() + &above.text(),
            ("msup", [base, above]) if is_function(base) => base.said() + &superscript(&above.text()),
            ("msup", [base, above]) => format!("({})^({})", base.said(), above.said()),
            ("mover", [base, dots]) => {
                let [one, two] =
                    if base.said().chars().count() == 1 { ["\u{307}", "\u{308}"] } else { ["_dot", "_ddot"] };
                base.said() + if dots.text() == "˙" { one } else { two }
            }
            ("munder" | "munderover", _) => "Σ".to_owned(),
            _ => String::new(),
        }
    }

    /// Sign of an operator; empty for other elements.
    fn sign(&self) -> &str {
        match self.inside() {
            [Self::Text(text)] if self.is("mo") => text,
            _ => "",
        }
    }
}

fn indexed(base: &Xml, below: &Xml) -> String {
    format!("{}_{}", base.said(), below.said().replace(", ", "_"))
}

fn is_function(base: &Xml) -> bool {
    base.is("mi") && base.text().chars().count() > 1
}

fn superscript(digits: &str) -> String {
    digits
        .chars()
        .map(|digit| "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().nth(digit as usize - '0' as usize).expect("a digit"))
        .collect()
}

fn is_differential(above: &Xml) -> bool {
    let first = above.inside().first().filter(|_| above.is("mrow"));
    first.is_some_and(|first| !first.is("mfrac") && first.text().starts_with('∂'))
}

fn separated(parts: &[Xml]) -> String {
    parts.iter().map(Xml::said).collect::<Vec<_>>().join(", ")
}

/// Reads a differential: `∂²U`, `∂x∂y`.
fn differential(row: &Xml) -> String {
    let part = |part: &Xml| match part.inside() {
        [sign, order] if part.is("msup") && sign.text() == "∂" => {
            format!("∂{}", superscript(&order.text()))
        }
        _ => part.said(),
    };
    row.inside().iter().map(part).collect()
}

fn operator(sign: &Xml) -> String {
    match &*sign.text() {
        "−" if sign.has("prefix") => "−".to_owned(),
        infix @ ("+" | "−" | "=") => format!(" {infix} "),
        "," => ", ".to_owned(),
        "\u{2061}" => String::new(),
        "\u{2062}" => " ".to_owned(),
        other => other.to_owned(),
    }
}

/// Joins elements side by side. A bare argument gets parentheses, and a dot before a number is no product of vectors.
fn line<'a>(all: impl Iterator<Item = &'a Xml>) -> String {
    let all: Vec<&Xml> = all.collect();
    let mut text = String::new();
    for (place, part) in all.iter().enumerate() {
        let before = |back: usize| place.checked_sub(back).map(|place| all[place]);
        let is_applied = before(2).is_some_and(|part| part.sign() == "\u{2061}");
        let is_number = |part: &&Xml| part.is("mn") || part.is("msup") && part.inside()[0].is("mn");
        let runs_on = before(1).is_some_and(|part| part.sign() == "\u{2062}");
        assert!(!(is_number(part) && runs_on), "numbers run into each other: {text} {}", part.said());
        text += &match part.sign() {
            "×" | "·" if all.get(place + 1).is_some_and(is_number) => " · ".to_owned(),
            _ if is_applied && before(1).is_some_and(|part| part.is("mspace")) => {
                format!("({})", part.said())
            }
            _ => part.said(),
        };
    }
    text
}

/// Formula as it appears in the lines that are read.
pub(super) fn written(system: &System, formula: &Formula) -> String {
    line(parsed(&system.notation(Notation::MATHML).write(formula)).iter())
}

/// The text of a page with its equations replaced by those of the HTML. Letters and digits must be equal in both.
pub(super) fn read(text: &str, html: &str) -> String {
    assert!(!html.contains("\n\n"), "an empty line");
    let page = parsed(html);
    let mut rows = page[0].inside().iter().filter(|part| part.is("div")).flat_map(rows);
    let lines = text.lines().map(|plain| match is_row(plain) {
        true => rows.next().unwrap_or_else(|| panic!("{plain} is missing in {html}")).instead_of(plain),
        false => plain.to_owned(),
    });
    let read = lines.collect::<Vec<_>>().join("\n");
    assert!(rows.next().is_none(), "{html} has more than {text}");
    read
}

/// Returns whether a line is a row, not a note.
fn is_row(plain: &str) -> bool {
    plain.starts_with("  ")
        && !plain.contains('`')
        && !plain.contains("velocity constraints, or")
        && !plain.contains("take fewer operations")
}

struct Row {
    equation: String,
    symbols: String,
}

/// Rows of a part of the page.
fn rows(part: &Xml) -> Vec<Row> {
    let (mut rows, mut left) = (Vec::new(), Vec::new());
    for cell in part.inside() {
        left.push(cell);
        if !cell.has("text-align:right") {
            let cells = std::mem::take(&mut left);
            let parts = || cells.iter().flat_map(|cell| cell.inside()).flat_map(Xml::unfolded);
            let formulas = parts().filter(|part| part.is("math")).flat_map(Xml::inside);
            let symbols: String = parts().filter(|part| !part.is("span")).map(Xml::text).collect();
            // A formula too wide for a root sign is written as a power with exponent 1/2.
            let symbols = symbols.replace("1/2", "");
            rows.push(Row { equation: by_rows(line(formulas)), symbols });
        }
    }
    rows
}

/// A matrix that is a list of columns, each a matrix itself, by its rows.
fn by_rows(equation: String) -> String {
    let columns = equation.split_once(" = ").filter(|(_, matrix)| matrix.starts_with("[[["));
    let Some((name, matrix)) = columns else { return equation };
    let columns: Vec<Vec<&str>> = items(matrix).into_iter().map(items).collect();
    let entry = |column: &Vec<&str>, k: usize| items(column[k]).concat();
    let row = |k| columns.iter().map(|column| entry(column, k)).collect::<Vec<_>>().join(", ");
    let rows = (0..columns[0].len()).map(|k| format!("[{}]", row(k)));
    format!("{name} = [{}]", rows.collect::<Vec<_>>().join(", "))
}

/// Items of a list in brackets.
fn items(list: &str) -> Vec<&str> {
    let inside = list.strip_prefix('[').and_then(|list| list.strip_suffix(']')).expect("a list");
    let mut depth = 0;
    let items = inside.split(|sign: char| {
        depth += i32::from("[(".contains(sign)) - i32::from("])".contains(sign));
        sign == ',' && depth == 0
    });
    items.map(str::trim).collect()
}

impl Row {
    /// Line of text with this equation in place of its own.
    fn instead_of(&self, plain: &str) -> String {
        let (label, said) = plain.split_once(": ").unwrap_or(("", plain));
        let said = said.trim();
        let (equation, remark) =
            said.split_once("   (").map_or((said, ""), |(equation, remark)| (equation, remark));
        let remark = match remark {
            "" => String::new(),
            // The elements for which the row stands.
            range if range.starts_with("for ") => format!("   ({range}"),
            _ => "   (…)".to_owned(),
        };
        let [ours, theirs] = [&self.symbols, equation].map(symbols);
        assert_eq!(ours, theirs, "{} for {plain}", self.equation);
        if self.equation.is_empty() {
            return plain.to_owned();
        }
        let label = if label.is_empty() { "  ".to_owned() } else { format!("{label}: ") };
        format!("{label}{}{remark}", self.equation)
    }
}

/// Sorted symbols without those that show how a formula is composed. A 1 may stand alone above a fraction bar.
fn symbols(text: &str) -> String {
    let text = text.replace('∑', "Σ").replace("_ddot", "\u{308}").replace("_dot", "\u{307}");
    let is_symbol = |sign: &char| !sign.is_whitespace() && !"1()[]/_,.^√⁄…·\u{2061}\u{2062}".contains(*sign);
    let mut symbols: Vec<char> = text.nfkd().filter(is_symbol).collect();
    symbols.sort_unstable();
    symbols.into_iter().collect()
}
