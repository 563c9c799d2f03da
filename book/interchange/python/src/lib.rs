//! A pendulum as a module of Python.

use lagrange_core::prelude::*;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// A pendulum with friction.
#[pyclass]
#[derive(Lagrangian)]
#[coordinates(theta)]
#[lagrangian(l^2/2 * theta_dot^2 + g*l*cos(theta))]
#[dissipation(c/2 * theta_dot^2)]
struct Pendulum {
    g: f64,
    l: f64,
    c: f64,
}

#[pymethods]
impl Pendulum {
    #[new]
    fn new(g: f64, l: f64, c: f64) -> Self {
        Self { g, l, c }
    }

    /// Angles and angular velocities at these times, from rest at an angle.
    fn swing(&self, angle: f64, times: Vec<f64>) -> PyResult<Vec<(f64, f64)>> {
        let mut motion =
            Motion::new(self, State::at_rest([angle]), Dop853::default()).map_err(value_error)?;
        let mut swing = Vec::new();
        for state in motion.states_at(times) {
            let state = state.map_err(value_error)?;
            swing.push((state.q[0], state.v[0]));
        }
        Ok(swing)
    }

    /// θ̈, for a solver of Python's.
    fn acceleration(&self, angle: f64, velocity: f64) -> f64 {
        self.accelerations_unchecked(&State::new([angle], [velocity])).accelerations[0]
    }

    /// The equations of motion.
    #[staticmethod]
    #[pyo3(name = "equations")]
    fn written() -> &'static str {
        Self::equations().text()
    }
}

fn value_error(error: impl std::error::Error) -> PyErr {
    PyValueError::new_err(error.to_string())
}

#[pymodule]
mod pendulum {
    #[pymodule_export]
    use super::Pendulum;
}
