//! Trajectories report how far conserved quantities stray.

use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(theta, phi)]
#[lagrangian(m*l^2/2 * (theta_dot^2 + sin(theta)^2 * phi_dot^2) - m*g*l*cos(theta))]
#[conserved(square = p^2)]
#[define(p = sin(theta)^2 * phi_dot)]
struct Pendulum {
    m: f64,
    l: f64,
    g: f64,
}

#[test]
fn the_drift_is_the_largest_deviation_of_any_step() {
    let pendulum = Pendulum { m: 0.5, l: 2.0, g: 9.81 };
    let start = State::new([2.0, 0.0], [0.3, 1.1]);
    // So loose that there is something to see.
    let path = pendulum.integrate(start, 20.0, Dopri5::with_tolerance(1e-4)).unwrap();
    let drift = path.drift();
    let largest = |of: &dyn Fn(&State<f64, 2>) -> f64| {
        let change = path.steps().map(|step| (of(step.state()) - of(&start)).abs());
        change.fold(0.0, f64::max)
    };
    let energy = drift.get("energy").unwrap();
    assert_eq!(
        (energy.start, energy.largest),
        (pendulum.energy(&start), largest(&|state| pendulum.energy(state)))
    );
    assert!(energy.largest > 1e-5);
    assert_eq!(drift.get("p_phi").unwrap().largest, largest(&|state| pendulum.momentum(state)[1]));
    assert!(drift.get("p_theta").is_none() && path.end().conserved("p_x").is_err());

    let table = drift.to_string();
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines.len(), 4, "{table}");
    assert_eq!(lines[0], "conserved   at the start  largest deviation");
    let names = ["p_phi ", "energy ", "square "];
    assert!(lines[1..].iter().zip(names).all(|(line, name)| line.starts_with(name)), "{table}");
    let width = lines[0].chars().count();
    assert!(lines.iter().all(|line| line.chars().count() == width), "{table}");
}

/// Counts its calls, to measure work.
struct Counted<'a>(&'a std::cell::Cell<usize>);

impl Function<1, 1> for Counted<'_> {
    fn eval<S: Scalar>(&self, [x]: [S; 1]) -> [S; 1] {
        self.0.set(self.0.get() + 1);
        [x * x]
    }
}

#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[function(mass(x))]
#[lagrangian((1 + mass(x))/2 * (x_dot^2 + y_dot^2 + z_dot^2))]
struct Heavier<'a> {
    mass: Counted<'a>,
}

/// In momenta each step takes a search for its velocity.
#[test]
fn all_quantities_take_one_walk_along_the_steps() {
    let asked = std::cell::Cell::new(0);
    let system = Heavier { mass: Counted(&asked) };
    let start = PhaseState::new([0.1, 0.0, 0.0], [0.5, 1.0, -1.0]);
    let path = system.motion_in_momenta(start).by(Dopri5::default()).to(5.0).unwrap();
    let work = |walk: &dyn Fn()| {
        asked.set(0);
        walk();
        asked.get()
    };
    let names = ["p_y", "p_z", "energy"];
    let walk = || path.steps().for_each(|step| names.iter().for_each(|name| drop(step.conserved(name))));
    assert_eq!(path.drift().iter().map(|quantity| quantity.name).collect::<Vec<_>>(), names);
    assert_eq!(work(&|| drop(path.drift())), work(&walk));
}
