//! What a system says of itself to be shown.

use lagrange_core::contact::{ContactMotion, Contacts};
use lagrange_core::{Method, StateOf, generic::Vector, prelude::*};

use crate::scene::{Point, Scene, View};

/// A slider: a parameter of a system or of its start.
#[derive(Clone, Copy, Debug)]
pub struct Knob {
    /// What it is called in formulas, as the derive would have it: `theta_0`.
    pub name: &'static str,
    /// What it is.
    pub meaning: &'static str,
    /// Its unit, or nothing.
    pub unit: &'static str,
    /// From where to where it goes.
    pub range: [f64; 2],
    /// Where it is at first.
    pub value: f64,
}

/// A slider: its name in formulas, what it is, its unit, from where to where it goes, and where it is at first.
pub const fn knob(
    name: &'static str,
    meaning: &'static str,
    unit: &'static str,
    range: [f64; 2],
    value: f64,
) -> Knob {
    Knob { name, meaning, unit, range, value }
}

/// Units of what is plotted, by the name of the constraint or of the conserved quantity; times are in s, energies in J.
pub type Units = &'static [(&'static str, &'static str)];

/// A moment of the motion.
#[derive(Clone, Copy, Debug)]
pub struct Moment<L: Lagrangian> {
    /// Time, coordinates and velocities.
    pub state: StateOf<L>,
    /// The multipliers.
    pub multipliers: Vector<L::Scalar, L::M>,
    /// The constraint force on each coordinate.
    pub force: Vector<L::Scalar, L::N>,
}

impl<L: Lagrangian<Scalar = f64>> Moment<L> {
    /// The vector that starts at this coordinate.
    pub fn place(&self, first: usize) -> Point {
        self.state.q.fixed_rows::<3>(first).into()
    }

    /// The constraint force on that.
    pub fn force_at(&self, first: usize) -> Point {
        self.force.fixed_rows::<3>(first).into()
    }

    /// The vector of multipliers that starts here.
    pub fn multiplier(&self, first: usize) -> Point {
        self.multipliers.fixed_rows::<3>(first).into()
    }
}

/// A system that is shown, with `K` sliders.
///
/// The derive has its equations and what it conserves; here is what can be set, where it starts, and how it is drawn.
pub trait Exhibit<const K: usize>: Lagrangian<Scalar = f64> + Clone + 'static {
    /// What it is called.
    const TITLE: &'static str;
    /// What to look at.
    const ABOUT: &'static str;
    /// What can be set.
    const KNOBS: &'static [Knob; K];
    /// The units, of multipliers and conserved quantities too; nothing where numbers have none.
    const UNITS: Option<Units>;
    /// How much of its time passes in a second of watching.
    const PACE: f64 = 1.0;

    /// The system and its start, by the sliders. Of the start, what violates constraints is projected away.
    fn set(knobs: [f64; K]) -> (Self, StateOf<Self>);

    /// Begins its motion. A system with contacts moves [across them](across_contacts).
    ///
    /// # Errors
    /// Why it cannot start there.
    fn begin(self, start: StateOf<Self>) -> Result<Box<dyn Moves<Self>>, Error>
    where
        Dop853: Method<Self>,
    {
        Ok(Box::new(Motion::new(self, start, Dop853::with_tolerance(TOLERANCE))?))
    }

    /// From where it is seen.
    fn view(&self, state: &StateOf<Self>) -> View;

    /// Draws it.
    fn draw(&self, now: &Moment<Self>, scene: &mut Scene);

    /// The points that leave a trail.
    fn trails(&self, _: &StateOf<Self>) -> Vec<Point> {
        Vec::new()
    }
}

/// Energies and constraints come to at most so small a part of their size.
pub(crate) const TOLERANCE: f64 = 1e-12;

/// A motion that goes on from picture to picture.
pub trait Moves<E: Lagrangian> {
    /// The system as it is now.
    fn system(&self) -> &E;
    /// Where it is now.
    fn state(&self) -> &StateOf<E>;
    /// Moves on to this time.
    ///
    /// # Errors
    /// Why the motion ends before.
    fn advance(&mut self, end: f64) -> Result<(), String>;
}

macro_rules! moves {
    ($motion:ident of $($system:tt)*) => {
        impl<E: $($system)*> Moves<E> for $motion<E, Dop853>
        where
            Dop853: Method<E>,
        {
            fn system(&self) -> &E {
                self.system()
            }

            fn state(&self) -> &StateOf<E> {
                self.state()
            }

            fn advance(&mut self, end: f64) -> Result<(), String> {
                self.advance_to(end).map_err(|ending| ending.to_string())
            }
        }
    };
}

moves!(Motion of Lagrangian<Scalar = f64>);
moves!(ContactMotion of Contacts<Scalar = f64> + Clone + 'static);

/// Begins a motion across contacts.
pub(crate) fn across_contacts<E>(system: &E, start: StateOf<E>) -> Result<Box<dyn Moves<E>>, Error>
where
    E: Contacts<Scalar = f64> + Clone + 'static,
    Dop853: Method<E>,
{
    Ok(Box::new(system.motion(start).by(Dop853::with_tolerance(TOLERANCE)).with_contacts().begin()?))
}
