//! A system's equations, to be read.

use core::fmt::{self, Display, Formatter};

/// A system and its equations as text, as LaTeX and as MathML, in a form for reading.
///
/// The Lagrangian as written, the constraints with their kinds, the equations of motion, constraint forces, what is
/// conserved, and where they are short the momenta, the Hamiltonian and Hamilton's equations. Expressions are multiplied out and
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

    /// An `align` environment of the package `amsmath`, its lines no longer than those of `article`.
    ///
    /// Each equation has a label: `\eqref{eq:Pendulum-theta}` is the equation of motion of `theta`, `eq:Pendulum-L` the
    /// Lagrangian.
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

impl Display for Equations {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(self.text())
    }
}
