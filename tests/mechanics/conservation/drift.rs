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
    let energies: Vec<f64> = path.steps().map(|step| pendulum.energy(step.state())).collect();
    let largest = energies.iter().map(|energy| (energy - energies[0]).abs()).fold(0.0, f64::max);
    let energy = drift.get("energy").unwrap();
    assert_eq!((energy.start, energy.largest), (energies[0], largest));
    assert!(largest > 1e-5);
    let momenta: Vec<f64> = path.steps().map(|step| pendulum.momentum(step.state())[1]).collect();
    let largest = momenta.iter().map(|p| (p - momenta[0]).abs()).fold(0.0, f64::max);
    assert_eq!(drift.get("p_phi").unwrap().largest, largest);
    assert!(drift.get("p_theta").is_none());

    let table = drift.to_string();
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines.len(), 4, "{table}");
    assert_eq!(lines[0], "conserved   at the start  largest deviation");
    assert!(
        lines[1].starts_with("p_phi ") && lines[2].starts_with("energy ") && lines[3].starts_with("square ")
    );
    let width = lines[0].chars().count();
    assert!(lines.iter().all(|line| line.chars().count() == width), "{table}");
}

#[test]
fn tighter_tolerances_drift_less() {
    let pendulum = Pendulum { m: 0.5, l: 2.0, g: 9.81 };
    let start = State::new([2.0, 0.0], [0.3, 1.1]);
    let [loose, tight] = [1e-6, 1e-10].map(|tolerance| {
        let path = pendulum.integrate(start, 20.0, Dop853::with_tolerance(tolerance)).unwrap();
        path.drift().get("energy").unwrap().largest
    });
    assert!(tight < loose / 100.0, "{tight} {loose}");
    assert!(pendulum.integrate(start, 1.0, Dop853::default()).unwrap().end().conserved("p_x").is_err());
}

/// Counts how often it is asked, so that the work can be told.
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

#[test]
fn an_energy_that_is_not_conserved_is_balanced() {
    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(x_dot^2/2 - x^2/2)]
    #[dissipation(x_dot^2/2)]
    struct Damped;

    let path = Damped.integrate(State::at_rest([1.0]), 1.0, Dop853::default()).unwrap();
    let said = path.drift().to_string();
    let lines: Vec<&str> = said.lines().collect();
    assert!(lines.len() == 2 && lines[1].starts_with("energy - work"), "{said}");
}
