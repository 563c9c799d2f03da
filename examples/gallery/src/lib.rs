//! Mechanical systems that move on a page in the browser, from the derives that programs use.
//!
//! An [`Exhibit`] is a system with its sliders and how it is drawn; [`systems`] has them, a file each. What the page asks of
//! it, it asks a [`Show`].

pub mod exhibit;
mod running;
pub mod scene;
pub mod systems;
#[cfg(test)]
mod tests;

pub use exhibit::{Exhibit, Knob, Moment, Units, knob};
use running::{Quantity, Running};
pub use scene::{Paint, Point, Scene, View, xy};
pub use systems::Entry;
use wasm_bindgen::prelude::*;

/// The systems, in their order.
#[wasm_bindgen]
pub fn cards() -> Vec<Card> {
    systems::all().into_iter().map(Card).collect()
}

/// What is said of a system before it runs.
#[wasm_bindgen]
#[derive(Clone, Copy, Debug)]
pub struct Card(Entry);

#[wasm_bindgen]
impl Card {
    /// The name in links.
    #[wasm_bindgen(getter)]
    pub fn key(&self) -> String {
        self.0.key.into()
    }

    /// What it is called.
    #[wasm_bindgen(getter)]
    pub fn title(&self) -> String {
        self.0.title.into()
    }

    /// What to look at.
    #[wasm_bindgen(getter)]
    pub fn about(&self) -> String {
        self.0.about.into()
    }

    /// How much of its time passes in a second of watching.
    #[wasm_bindgen(getter)]
    pub fn pace(&self) -> f64 {
        self.0.pace
    }

    /// Its equations, as the derive writes them.
    #[wasm_bindgen(getter)]
    pub fn text(&self) -> String {
        self.0.equations.text().into()
    }

    /// The same as HTML, its formulas in MathML.
    #[wasm_bindgen(getter)]
    pub fn mathml(&self) -> String {
        self.0.equations.mathml().into()
    }

    /// The same as LaTeX.
    #[wasm_bindgen(getter)]
    pub fn latex(&self) -> String {
        self.0.equations.latex().into()
    }

    /// Whether the derive found that the energy is conserved.
    #[wasm_bindgen(getter)]
    pub fn conserves_energy(&self) -> bool {
        self.0.conserves_energy
    }

    /// Whether its numbers have units: times in s, forces in N.
    #[wasm_bindgen(getter)]
    pub fn has_units(&self) -> bool {
        self.0.has_units
    }

    /// The coordinates and then their velocities, as [`Show::state`] has them.
    #[wasm_bindgen(getter)]
    pub fn coordinates(&self) -> Vec<String> {
        self.0.coordinates.iter().map(|name| (*name).into()).collect()
    }

    /// Its sliders.
    pub fn knobs(&self) -> Vec<Slider> {
        self.0.knobs.iter().copied().map(Slider).collect()
    }

    /// The system at its start, with the sliders at these values.
    ///
    /// # Errors
    /// Why it cannot start.
    pub fn open(&self, values: &[f64]) -> Result<Show, String> {
        (self.0.open)(values).map(Show)
    }
}

/// A slider.
#[wasm_bindgen]
#[derive(Clone, Copy, Debug)]
pub struct Slider(Knob);

#[wasm_bindgen]
impl Slider {
    /// What it is called in formulas and in links.
    #[wasm_bindgen(getter)]
    pub fn name(&self) -> String {
        self.0.name.into()
    }

    /// What it is.
    #[wasm_bindgen(getter)]
    pub fn meaning(&self) -> String {
        self.0.meaning.into()
    }

    /// Its unit.
    #[wasm_bindgen(getter)]
    pub fn unit(&self) -> String {
        self.0.unit.into()
    }

    /// Its least value.
    #[wasm_bindgen(getter)]
    pub fn low(&self) -> f64 {
        self.0.range[0]
    }

    /// Its largest value.
    #[wasm_bindgen(getter)]
    pub fn high(&self) -> f64 {
        self.0.range[1]
    }

    /// Where it is at first.
    #[wasm_bindgen(getter)]
    pub fn value(&self) -> f64 {
        self.0.value
    }
}

/// A system that runs.
#[wasm_bindgen]
#[expect(missing_debug_implementations, reason = "any system")]
pub struct Show(Box<dyn Running>);

#[wasm_bindgen]
impl Show {
    /// Goes on to this time.
    ///
    /// # Errors
    /// Why the motion ends before.
    pub fn advance(&mut self, end: f64) -> Result<(), String> {
        self.0.advance(end)
    }

    /// From when to when the motion is known.
    pub fn span(&self) -> Vec<f64> {
        self.0.span().into()
    }

    /// The middle of the view, its radius, the force whose arrow is that long, and, in space, azimuth and elevation.
    pub fn view(&self, t: f64) -> Vec<f64> {
        let View { centre, radius, from, force } = self.0.view(t);
        let mut numbers = vec![centre.x, centre.y, centre.z, radius, force];
        numbers.extend(from.into_iter().flatten());
        numbers
    }

    /// What is drawn at a time; [`scene`] tells how to read it.
    pub fn scene(&self, t: f64, with_forces: bool) -> Vec<f32> {
        self.0.scene(t, with_forces)
    }

    /// Coordinates and velocities at a time.
    pub fn state(&self, t: f64) -> Vec<f64> {
        self.0.state(t)
    }

    /// The quantities that are plotted, each with its kind, its name and its unit, if it has one: `multiplier rod N/m`.
    pub fn quantities(&self) -> Vec<String> {
        let quantities = self.0.quantities();
        quantities.iter().map(|Quantity { kind, name, unit }| format!("{kind} {name} {unit}")).collect()
    }

    /// The times of the frames between two times.
    pub fn times(&self, from: f64, to: f64) -> Vec<f64> {
        self.0.times(from, to)
    }

    /// The values of a quantity in these frames.
    pub fn series(&self, quantity: usize, from: f64, to: f64) -> Vec<f64> {
        self.0.series(quantity, from, to)
    }
}
