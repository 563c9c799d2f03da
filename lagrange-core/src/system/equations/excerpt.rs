//! Parts of the readable equations. They are cut out of the pages that `render` of lagrange-macros writes, so
//! the parts take no extra space in a program.

use core::fmt::{self, Display, Formatter};

/// Start of a section heading in LaTeX.
pub(super) const LATEX_HEADING: &str = r"\par\medskip\noindent\textbf{";
/// Start of a section heading in MathML.
const MATHML_HEADING: &str = "<h5>";
const LABEL: &str = r"\label{eq:";
/// Separator of two equations in LaTeX. Line breaks inside an equation have more space after them.
const NEXT: &str = " \\\\\n  ";

/// Equations of one section of the page, or a single equation of it.
///
/// `Display` writes Unicode text, one line per equation, without a final line end. [`latex`](Self::latex) and
/// [`mathml`](Self::mathml) return the same equations for a paper and for a browser. An equation longer than
/// 250 characters is replaced by a line that states its length.
///
/// ```
/// use lagrange_core::prelude::*;
///
/// #[derive(Lagrangian)]
/// #[coordinates(x, phi)]
/// #[lagrangian(m/2 * x_dot^2 + j/2 * phi_dot^2 + m*g*x)]
/// #[constraint(no_slip: x_dot - a*phi_dot = 0)]
/// struct YoYo { m: f64, j: f64, a: f64, g: f64 }
///
/// let equations = YoYo::equations();
/// assert_eq!(equations.lagrangian().to_string(), "L = ½ m ẋ² + ½ j φ̇² + m g x");
/// let row = equations.motion().row("phi").expect("an equation of phi");
/// assert_eq!(row.to_string(), "φ: j φ̈ = −a λ_no_slip");
/// assert!(row.latex().to_string().contains(r"j \ddot\varphi &= -a \lambda"));
/// assert!(equations.momentum("x").is_some_and(|momentum| momentum.to_string() == "p_x = m ẋ"));
/// assert_eq!(equations.motion().rows().count(), 2);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Excerpt {
    text: Body,
    latex: Body,
    mathml: Body,
}

/// Equations of a section, and the note that follows them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Body {
    rows: &'static str,
    note: &'static str,
}

impl Excerpt {
    /// Returns the section below `heading`, in text, LaTeX and MathML; empty if the page has no such section.
    pub(super) fn below(heading: &str, [text, latex, mathml]: [&'static str; 3]) -> Self {
        let below = |mut sections: core::str::Split<'static, &str>, end: &str| {
            let section = sections.find_map(|section| section.strip_prefix(heading)?.strip_prefix(end));
            section.unwrap_or("")
        };
        let latex = latex.strip_suffix("\\endgroup\n").unwrap_or(latex);
        let mathml = mathml.strip_suffix("</div>\n").unwrap_or(mathml);
        let latex = latex_body(below(latex.split(LATEX_HEADING), "}\n"));
        let count = latex_rows(latex.rows).count();
        let text = text_body(below(text.split("\n\n"), "\n"), count);
        let mathml = mathml_body(below(mathml.split(MATHML_HEADING), "</h5>\n"));
        Self { text, latex, mathml }
    }

    /// True if there are neither equations nor a note in their place.
    pub const fn is_empty(&self) -> bool {
        self.text.rows.is_empty() && self.text.note.is_empty()
    }

    /// Returns an iterator over the single equations.
    pub fn rows(&self) -> impl Iterator<Item = Self> + use<> {
        let row = |rows| Body { rows, note: "" };
        let rows = text_rows(self.text.rows).zip(latex_rows(self.latex.rows)).zip(self.mathml.rows.lines());
        rows.map(move |((text, latex), mathml)| Self {
            text: row(text),
            latex: row(latex),
            mathml: row(mathml),
        })
    }

    /// Returns the equations in LaTeX, each with its label.
    pub(super) fn latex_rows(&self) -> impl Iterator<Item = &'static str> + use<> {
        latex_rows(self.latex.rows)
    }

    /// Returns the equation of this name: a coordinate's name among the equations of motion, a constraint's,
    /// `p_x` among momenta, `R_x` among forces of constraint, `y` for the definition of y. For coordinates that
    /// are printed as a vector, the name is the vector's.
    pub fn row(&self, name: &str) -> Option<Self> {
        self.rows().find(|row| row.is_named("", name))
    }

    /// True if the equation is named `prefix` followed by `name`.
    pub(super) fn is_named(&self, prefix: &str, name: &str) -> bool {
        let label = |label: &str| {
            let words = |text| str::split(text, |sign: char| !sign.is_ascii_alphanumeric() && sign != '_');
            let label = label.split_once('-').and_then(|(_, label)| label.strip_prefix(prefix));
            label.is_some_and(|label| words(label).eq(words(name).filter(|word| !word.is_empty())))
        };
        let labels = self.latex.rows.split_once(LABEL);
        labels.and_then(|(_, rest)| rest.split_once('}')).is_some_and(|(found, _)| label(found))
            || self.left().strip_prefix(prefix) == Some(name)
    }

    /// Returns the start of the row: a label, or the left side of the equation.
    fn left(&self) -> &'static str {
        let row = self.text.rows;
        let ends = [row.find(':'), row.find(" = ")];
        &row[..ends.into_iter().flatten().min().unwrap_or(0)]
    }

    /// Returns an `align` environment of the package `amsmath`, as a value to display or convert by
    /// `to_string`.
    ///
    /// Each equation has the label that it has in [`Equations::latex`](super::Equations::latex).
    pub const fn latex(&self) -> impl Display + Copy + use<> {
        Framed { frame: ["\\begin{align}\n  ", "\n\\end{align}\n"], body: self.latex }
    }

    /// Returns a `div` with the equations in MathML, as a value to display or convert by `to_string`.
    pub const fn mathml(&self) -> impl Display + Copy + use<> {
        Framed { frame: [GRID, "\n</div>\n"], body: self.mathml }
    }
}

/// CSS grid of the equations; the rows have the styles of grid cells.
const GRID: &str = "<div style=\"display:grid;grid-template-columns:auto minmax(0,1fr);gap:.5em .25em;align-items:baseline\">\n";

impl Display for Excerpt {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Body { rows, note } = self.text;
        for (number, line) in rows.lines().chain(note.lines()).enumerate() {
            f.write_str(if number == 0 { "" } else { "\n" })?;
            f.write_str(line.trim_start())?;
        }
        Ok(())
    }
}

/// Rows of equations between an opening and a closing text, followed by a note.
#[derive(Clone, Copy)]
struct Framed {
    frame: [&'static str; 2],
    body: Body,
}

impl Display for Framed {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Body { rows, note } = self.body;
        let [before, behind] = self.frame;
        if !rows.is_empty() {
            write!(f, "{before}{rows}{behind}")?;
        }
        f.write_str(note)
    }
}

/// Splits a section after `count` lines: the rows and the note.
fn text_body(section: &'static str, count: usize) -> Body {
    let mut ends = section.match_indices('\n').map(|(end, _)| end);
    let end = count.checked_sub(1).map_or(0, |last| ends.nth(last).unwrap_or(section.len()));
    let (rows, note) = section.split_at(end);
    Body { rows: rows.trim_start(), note: note.trim() }
}

fn text_rows(rows: &'static str) -> impl Iterator<Item = &'static str> {
    rows.lines().map(str::trim_start)
}

fn latex_body(section: &'static str) -> Body {
    let inside = section.strip_prefix("\\begin{align}\n  ");
    match inside.and_then(|inside| inside.split_once("\n\\end{align}\n")) {
        Some((rows, note)) => Body { rows, note },
        None => Body { rows: "", note: section },
    }
}

/// Splits the rows of an `align` environment: each row ends with its label.
fn latex_rows(rows: &'static str) -> impl Iterator<Item = &'static str> {
    let mut rest = rows;
    core::iter::from_fn(move || {
        let label = rest.find(LABEL)?;
        let end = label + rest[label..].find('}')? + 1;
        let (row, behind) = rest.split_at(end);
        rest = behind.strip_prefix(NEXT).unwrap_or(behind);
        Some(row)
    })
}

fn mathml_body(section: &'static str) -> Body {
    match section.strip_prefix(GRID).and_then(|inside| inside.split_once("\n</div>\n")) {
        Some((rows, note)) => Body { rows, note },
        None => Body { rows: "", note: section },
    }
}
