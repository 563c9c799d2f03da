//! Time and state at which expressions are evaluated, as jets.

use super::jet::Jet;

/// Time, state and parameters of an evaluation. `order` is the number of ε in use.
#[derive(Clone)]
pub(super) struct Here {
    pub(super) time: Jet,
    pub(super) coordinates: Vec<Jet>,
    pub(super) velocities: Vec<Jet>,
    pub(super) parameters: Vec<f64>,
    pub(super) order: u32,
    pub(super) index: usize,
    pub(super) arguments: Vec<Jet>,
}

impl Here {
    pub(super) fn new(time: f64, coordinates: &[f64], velocities: &[f64], parameters: &[f64]) -> Self {
        let jets = |numbers: &[f64]| numbers.iter().copied().map(Jet::number).collect();
        Self {
            time: Jet::number(time),
            coordinates: jets(coordinates),
            velocities: jets(velocities),
            parameters: parameters.to_vec(),
            order: 0,
            index: 0,
            arguments: Vec::new(),
        }
    }

    pub(super) fn with_arguments(&self, arguments: Vec<Jet>) -> Self {
        Self { arguments, ..self.clone() }
    }

    pub(super) fn at_index(&self, index: usize) -> Self {
        Self { index, ..self.clone() }
    }

    /// Moves time and coordinates by a new ε along the motion, with constant velocities.
    pub(super) fn later(&self) -> Self {
        let mut later = self.clone();
        later.time = self.time.moved(&Jet::number(1.0), self.order);
        let moved = self.coordinates.iter().zip(&self.velocities);
        later.coordinates = moved.map(|(q, v)| q.moved(v, self.order)).collect();
        later.order += 1;
        later
    }

    /// Increases one coordinate by a new ε.
    pub(super) fn by_coordinate(&self, i: usize) -> Self {
        let mut moved = self.clone();
        moved.coordinates[i] = self.coordinates[i].moved(&Jet::number(1.0), self.order);
        moved.order += 1;
        moved
    }

    /// Increases one velocity by a new ε.
    pub(super) fn by_velocity(&self, i: usize) -> Self {
        let mut moved = self.clone();
        moved.velocities[i] = self.velocities[i].moved(&Jet::number(1.0), self.order);
        moved.order += 1;
        moved
    }
}
