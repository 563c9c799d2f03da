//! A system's equations, to be read.

mod excerpt;

use core::fmt::{self, Display, Formatter};

pub use excerpt::Excerpt;

/// A system and its equations as text, as LaTeX and as MathML, in a form for reading.
///
/// The Lagrangian as written, the constraints with their kinds, the equations of motion, constraint forces, what is
/// conserved, the energy, and where they are short the momenta, the Hamiltonian and Hamilton's equations; where no Hamiltonian is
/// printed it says why. Expressions are multiplied out and
/// collected, sines and cosines put together (sin² + cos², sums of angles), each row is divided by what its terms have in
/// common, and components are put together into vectors where the rows are those of one. Definitions appear by their names or
/// written out, as is shorter; [`named`](Self::named) and [`written_out`](Self::written_out) have it one way everywhere.
/// A row with a factor divided away is the equation still; with a coordinate divided away it says more only where that
/// vanishes. Nothing is computed with this form.
///
/// What would take more than 250 signs is not printed but counted, and expressions of more than 100 terms multiplied out are
/// printed as they are computed.
///
/// `Type::equations()` gives them for every type with `#[derive(Lagrangian)]`; they also stand in its
/// documentation, typeset, and as plain text at `equations`, where editors show them. A method of the type's own needs another
/// name: rustc calls two `equations` duplicate definitions (E0592).
///
/// ```
/// use lagrange_core::prelude::*;
///
/// #[derive(Lagrangian)]
/// #[coordinates(theta)]
/// #[lagrangian(m/2 * l^2 * theta_dot^2 + m*g*l*cos(theta))]
/// struct Pendulum { m: f64, l: f64, g: f64 }
///
/// assert!(Pendulum::equations().text().contains("l θ̈ = −g sin θ"));
/// println!("{}", Pendulum::equations());
///
/// // Parts, each as text, as LaTeX and as MathML.
/// assert_eq!(Pendulum::equations().hamiltonian().to_string(), "H = p_θ²/(2 m l²) − m l g cos θ");
/// let row = Pendulum::equations().motion().row("theta").expect("its equation");
/// assert_eq!(
///     row.latex().to_string(),
///     "\\begin{align}\n  l \\ddot\\theta &= -g \\sin \\theta \\label{eq:Pendulum-theta}\n\\end{align}\n"
/// );
/// // A document of as many pages as it takes.
/// assert!(Pendulum::equations().document().to_string().starts_with(r"\documentclass{article}"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Equations {
    forms: [[&'static str; 3]; 3],
    form: usize,
}

impl Equations {
    /// In Unicode, a line for each equation.
    pub const fn text(&self) -> &'static str {
        self.forms[self.form][0]
    }

    /// Headings, and below each an `align` environment of the package `amsmath`, its lines no longer than those of `article`.
    ///
    /// Pages may end between any two equations. Each equation has a label: `\eqref{eq:Pendulum-theta}` is the equation of motion of
    /// `theta`, `eq:Pendulum-L` the Lagrangian. [`document`](Self::document) is a whole document,
    /// [`motion`](Self::motion) and others are parts of the page.
    pub const fn latex(&self) -> &'static str {
        self.forms[self.form][1]
    }

    /// A piece of HTML with the equations in MathML, which browsers show without a script.
    ///
    /// One `div` of the class `equations`, that needs no style sheet: a heading and rows for each part. Long equations take as
    /// many lines as the page is narrow. It is well-formed XML without an empty line, so it can stand in Markdown too.
    pub const fn mathml(&self) -> &'static str {
        self.forms[self.form][2]
    }

    /// The same with definitions by their names wherever they occur.
    pub const fn named(self) -> Self {
        Self { form: 1, ..self }
    }

    /// The same with what definitions stand for, also in the Lagrangian.
    pub const fn written_out(self) -> Self {
        Self { form: 2, ..self }
    }
}

/// Of these forms, each as text, as LaTeX and as HTML with MathML.
pub const fn equations(forms: [[&'static str; 3]; 3]) -> Equations {
    Equations { forms, form: 0 }
}

/// Parts of the page: empty where the page has none.
impl Equations {
    /// The Lagrangian, frames, definitions, the dissipation function and forces, as written.
    pub fn lagrangian(&self) -> Excerpt {
        self.below("Lagrangian")
    }

    /// The constraints with their kinds.
    pub fn constraints(&self) -> Excerpt {
        self.below("Constraints")
    }

    /// The equations of motion, one for each coordinate, or for a vector of coordinates.
    pub fn motion(&self) -> Excerpt {
        self.below("Equations of motion")
    }

    /// The generalized forces of constraint, R = Fᵀλ.
    pub fn constraint_forces(&self) -> Excerpt {
        self.below("Constraint forces")
    }

    /// What the motion conserves: momenta, the energy, and quantities given in `#[conserved(…)]`.
    pub fn conserved(&self) -> Excerpt {
        self.below("Conserved")
    }

    /// The energy function E = p·q̇ − L, and in parentheses what it is and, where it is not known to be conserved, what changes it
    /// (see [`EnergyForm`](crate::facts::EnergyForm)).
    pub fn energy(&self) -> Excerpt {
        let changing = || self.below("Energy");
        self.conserved().row("E").unwrap_or_else(changing)
    }

    /// The momentum of a coordinate, by the coordinate's name; of a vector of coordinates that is printed as such, by the vector's.
    ///
    /// `None` where it is not printed: momenta are where they are short together, or the Hamiltonian is printed.
    pub fn momentum(&self, coordinate: &str) -> Option<Excerpt> {
        let mut rows = self.conserved().rows().chain(self.below("Momenta").rows());
        rows.find(|row| row.is_named("p_", coordinate))
    }

    /// The Hamiltonian, or the reason why it is not printed.
    pub fn hamiltonian(&self) -> Excerpt {
        self.below("Hamiltonian")
    }

    /// Hamilton's equations, where the Hamiltonian is printed.
    pub fn canonical(&self) -> Excerpt {
        self.below("Hamilton's equations")
    }

    fn below(&self, heading: &str) -> Excerpt {
        Excerpt::below(heading, self.forms[self.form])
    }

    /// A document in LaTeX with the page in it, displayed or written by `to_string`.
    ///
    /// It needs the class `article` and the package `amsmath`. Long systems take as many pages as they need.
    pub const fn document(&self) -> impl Display + Copy + use<> {
        Document(*self)
    }
}

#[derive(Clone, Copy)]
struct Document(Equations);

impl Display for Document {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let name = self.0.text().lines().next().unwrap_or("");
        f.write_str("\\documentclass{article}\n\\usepackage[utf8]{inputenc}\n\\usepackage{amsmath}\n\\begin{document}\n")?;
        f.write_str("\\section*{")?;
        for (number, word) in name.split('_').enumerate() {
            f.write_str(if number == 0 { "" } else { "\\_" })?;
            f.write_str(word)?;
        }
        write!(f, "}}\n{}\\end{{document}}\n", self.0.latex())
    }
}

impl Display for Equations {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(self.text())
    }
}
