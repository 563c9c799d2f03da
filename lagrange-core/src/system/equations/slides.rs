//! The readable equations as slides of the LaTeX class `beamer`.

use core::fmt::{self, Display, Formatter};

use super::Equations;
use super::excerpt::{Excerpt, LATEX_HEADING};

/// Most lines of equations on a slide of 16:9 in the size `small`, of which each may hold a fraction.
const LINES: usize = 6;
/// Separator of two lines of one equation.
const LINE: &str = "\\nonumber \\\\*";

/// Slides of a page of equations: see [`Equations::slides`].
#[derive(Clone, Copy)]
pub(super) struct Slides(pub(super) Equations);

impl Display for Slides {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str("\\documentclass[aspectratio=169]{beamer}\n\\usepackage[utf8]{inputenc}\n\\usepackage{amsmath}\n\\begin{document}\n")?;
        let sections = self.0.latex().split(LATEX_HEADING).skip(1);
        for heading in sections.filter_map(|section| section.split_once("}\n").map(|(heading, _)| heading)) {
            section(f, heading, &self.0.below(heading))?;
        }
        f.write_str("\\end{document}\n")
    }
}

/// Writes the slides of a section. Equations that fit stand together on one.
fn section(f: &mut Formatter<'_>, heading: &str, excerpt: &Excerpt) -> fmt::Result {
    let mut lines = 0;
    for row in excerpt.latex_rows() {
        let more = row.matches(LINE).count() + 1;
        match lines {
            0 => begin(f, heading)?,
            lines if lines + more <= LINES => f.write_str(" \\\\\n  ")?,
            _ => {
                f.write_str(END)?;
                lines = 0;
                begin(f, heading)?;
            }
        }
        f.write_str(row)?;
        lines += more;
    }
    f.write_str(if lines > 0 { END } else { "" })
}

fn begin(f: &mut Formatter<'_>, heading: &str) -> fmt::Result {
    write!(f, "\\begin{{frame}}{{{heading}}}\n\\small\n\\begin{{align}}\n  ")
}

/// End of a slide.
const END: &str = "\n\\end{align}\n\\end{frame}\n";

#[cfg(test)]
mod tests {
    use super::LINES;
    use crate::prelude::*;

    #[derive(Lagrangian)]
    #[coordinates(a, b)]
    #[define(x[0] = [l[0]*sin(a), -l[0]*cos(a)])]
    #[define(x[1] = x[0] + [l[1]*sin(b), -l[1]*cos(b)])]
    #[lagrangian(sum(k in 0..2, m[k]/2*norm(der(x[k]))^2 - m[k]*g*x[k][1]))]
    struct DoublePendulum {
        m: [f64; 2],
        l: [f64; 2],
        g: f64,
    }

    #[test]
    fn every_equation_stands_on_one_slide_that_is_not_too_long() {
        let (equations, labels) =
            (DoublePendulum::equations(), |text: &str| text.matches("\\label{").count());
        let slides = equations.slides().to_string();
        assert_eq!(labels(&slides), labels(equations.latex()));
        let frames: Vec<&str> = slides.split("\\begin{frame}").skip(1).collect();
        assert!(frames.len() > 6, "{slides}");
        for frame in frames {
            let (equations, rest) = frame.split_once("\n\\end{align}\n\\end{frame}\n").expect("an end");
            let lines = equations.matches(" \\\\").count() + 1;
            assert!(lines <= LINES && (rest.is_empty() || rest == "\\end{document}\n"), "{lines}: {frame}");
        }
    }
}
