//! Lengths and indices are checked where a motion starts; names and energies are those of derived systems.

use lagrange_core::prelude::*;
use lagrange_core::{Ensemble, Error};

/// Atoms, of which some are bound.
#[derive(Clone, lagrange_core::Lagrangian)]
#[coordinates(r: [atoms, 2])]
#[parameter(m: [atoms]; bond: [bonds, 2])]
#[lagrangian(sum(i in 0..atoms, m[i]/2*dot(r_dot[i], r_dot[i]))
    - sum(b in 0..bonds, k/2*dot(r[bond[b][0]] - r[bond[b][1]], r[bond[b][0]] - r[bond[b][1]])) - k/2*dot(r[0], r[0]))]
#[observable(centre = sum(i in 0..atoms, m[i]*r[i])/sum(i in 0..atoms, m[i]))]
struct Molecule {
    atoms: usize,
    m: Vec<f64>,
    bond: Vec<[usize; 2]>,
    k: f64,
}

fn molecule() -> Molecule {
    Molecule { atoms: 3, m: vec![1.0, 2.0, 3.0], bond: vec![[0, 1], [1, 2]], k: 2.0 }
}

/// Message of the error with which a motion does not begin.
fn refusal(molecule: &Molecule) -> String {
    let start = molecule.at_rest(vec![0.5; 2 * molecule.atoms]);
    molecule.integrate(start, 1.0, Dop853::default()).expect_err("a refusal").to_string()
}

#[test]
fn fields_of_other_lengths_are_told() {
    let short = Molecule { m: vec![1.0; 2], ..molecule() };
    assert_eq!(short.check(), Err(Error::FieldLength { field: "m", found: 2, expected: 3, of: "atoms" }));
    assert!(refusal(&short).contains("`m` has 2 elements, and `atoms` is 3"), "{}", refusal(&short));
}

#[test]
fn entries_of_tables_beyond_the_array_are_told() {
    let wrong = Molecule { bond: vec![[0, 1], [1, 2], [2, 3]], ..molecule() };
    assert_eq!(wrong.check(), Err(Error::FieldIndex { field: "bond", entry: 2, index: 3, length: 3 }));
    assert!(refusal(&wrong).contains("`bond`"), "{}", refusal(&wrong));
}

/// An element that is there for some lengths only.
#[derive(lagrange_core::Lagrangian)]
#[coordinates(x: [n])]
#[lagrangian(sum(i in 0..n, x_dot[i]^2/2) - sum(i in 0..held, x[i]^2/2) - x[0]*x[n-2])]
struct Held {
    n: usize,
    held: usize,
}

#[test]
fn elements_that_may_be_missing_are_looked_for_at_the_start() {
    assert_eq!(Held { n: 3, held: 3 }.check(), Ok(()));
    let beyond = Held { n: 3, held: 5 }.check();
    assert_eq!(beyond, Err(Error::ElementMissing { array: "x", index: 3, from: 0, to: 3 }));
    let below = Held { n: 1, held: 1 }.check();
    assert_eq!(below, Err(Error::ElementMissing { array: "x", index: -1, from: 0, to: 1 }));
    let none = Held { n: 0, held: 0 }.check();
    assert_eq!(none, Err(Error::ElementMissing { array: "x", index: 0, from: 0, to: 0 }));
}

#[test]
fn elements_have_names_and_systems_an_energy() {
    let molecule = molecule();
    let start = molecule.state([0.1, 0.0, 1.0, 0.2, 0.5, 1.0], [0.0, 0.3, 0.0, 0.0, 0.2, 0.0]);
    let path = molecule.integrate(start.clone(), 5.0, Dop853::with_tolerance(1e-12)).expect("a motion");
    assert_eq!(path.end().coordinate("r[2][1]").expect("a motion"), path.end().state().q[5]);
    assert_eq!(path.end().velocity("r[1][0]").expect("a motion"), path.end().state().v[2]);
    assert!(path.end().coordinate("r[3][0]").is_err());
    let drift = path.drift();
    assert!(drift.iter().any(|quantity| quantity.name == "energy" && quantity.largest < 1e-10), "{drift}");
    assert!((molecule.energy(&start) - path.end().energy()).abs() < 1e-10);
    let centre = molecule.centre(&start);
    assert!((centre[0] - (0.1 + 2.0 + 1.5) / 6.0).abs() < 1e-15);
    let mut wrong = start;
    wrong.v[3] = f64::NAN;
    let error = molecule.integrate(wrong, 1.0, Dop853::default()).expect_err("a refusal").to_string();
    assert!(error.contains("r[1][1]") || error.contains("r_dot[1][1]"), "{error}");
}

#[test]
fn systems_without_bodies_rest() {
    #[derive(Clone, lagrange_core::Lagrangian)]
    #[coordinates(r: [n, 3])]
    #[lagrangian(sum(i in 0..n, dot(r_dot[i], r_dot[i])/2) + sum(i in 0..n, sum(j in 0..i, 1/norm(r[i] - r[j]))))]
    struct Cluster {
        n: usize,
    }
    for n in [0, 1] {
        let cluster = Cluster { n };
        let path =
            cluster.integrate(cluster.at_rest(vec![1.0; 3 * n]), 2.0, Dop853::default()).expect("a motion");
        assert_eq!(path.end().time(), 2.0);
        let verlet = cluster
            .integrate(cluster.at_rest(vec![1.0; 3 * n]), 2.0, Verlet::with_step(0.1))
            .expect("a motion");
        assert!(verlet.end().state().q.iter().all(|&q| q == 1.0));
    }
}

#[test]
fn members_of_ensembles_have_numbers_of_their_own() {
    let member = |k: usize| {
        let n = 1 + k;
        let molecule =
            Molecule { atoms: n, m: vec![1.0; n], bond: (1..n).map(|i| [i - 1, i]).collect(), k: 1.0 };
        let start = molecule.at_rest((0..2 * n).map(|i| i as f64));
        (molecule, start)
    };
    let outcome = Ensemble::from_fn(4, member).integrate(3.0, Dop853::default()).expect("a motion");
    assert_eq!(outcome.completed().count(), 4);
    for (k, end) in outcome.completed() {
        let (molecule, start) = member(k);
        assert_eq!(end.q.len(), 2 * (1 + k));
        assert!((molecule.energy(end) - molecule.energy(&start)).abs() < 1e-6);
    }
}

/// Pairs of oscillators whose velocities are coupled: M = (1 c; c 1) for each.
#[derive(Clone, lagrange_core::Lagrangian)]
#[coordinates(x: [n], y: [n])]
#[parameter(c: [n])]
#[lagrangian(sum(i in 0..n, (x_dot[i]^2 + y_dot[i]^2)/2 + c[i]*x_dot[i]*y_dot[i] - (x[i]^2 + y[i]^2)/2))]
struct Coupled {
    n: usize,
    c: Vec<f64>,
}

#[test]
fn accelerations_that_would_lose_their_digits_are_refused() {
    let moved = |c: f64| {
        let coupled = Coupled { n: 2, c: vec![0.5, c] };
        let path = coupled.integrate(coupled.at_rest([1.0; 4]), 1.0, Dop853::with_tolerance(1e-13));
        path.map(|path| path.end().state().q.clone()).map_err(|error| error.to_string())
    };
    let end = moved(0.25).expect("a motion");
    for (k, c) in [0.5f64, 0.25].into_iter().enumerate() {
        let expected = (1.0 / (1.0 + c).sqrt()).cos();
        assert!((end[k] - expected).abs() < 1e-12, "{}", end[k]);
    }
    for c in [1.0, -1.0, 1.0 - 1e-15, 2.0] {
        let error = moved(c).expect_err("a refusal");
        assert!(error.contains("x[1]") || error.contains("y[1]"), "{error}");
    }
}
