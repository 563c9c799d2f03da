//! Motions of any number of bodies with constraints: closed solutions, conservation, errors, memory.

use lagrange_core::error::Row;
use lagrange_core::{Error, Motion, System, prelude::*};

/// Bobs on rods, one below the other.
#[derive(Lagrangian, Clone)]
#[coordinates(r: [n, 2])]
#[parameter(m: [n])]
#[lagrangian(sum(i in 0..n, m[i]/2*dot(r_dot[i], r_dot[i]) - m[i]*g*r[i][1]))]
#[constraint(rod[0]: norm(r[0]) = l)]
#[constraint(rod[i in 1..n]: norm(r[i] - r[i-1]) = l)]
struct Chain {
    m: Vec<f64>,
    g: f64,
    l: f64,
}

/// The same for three bobs.
#[derive(Lagrangian, Clone)]
#[coordinates(r: [3, 2])]
#[lagrangian(sum(i in 0..3, m[i]/2*dot(r_dot[i], r_dot[i]) - m[i]*g*r[i][1]))]
#[constraint(rod[0]: norm(r[0]) = l)]
#[constraint(rod[i in 1..3]: norm(r[i] - r[i-1]) = l)]
struct Three {
    m: [f64; 3],
    g: f64,
    l: f64,
}

/// Atoms at constant distances.
#[derive(Lagrangian, Clone)]
#[coordinates(r: [atoms, 3])]
#[parameter(m: [atoms]; bond: [bonds, 2]; d: [bonds])]
#[lagrangian(sum(i in 0..atoms, m[i]/2*dot(r_dot[i], r_dot[i])) - k/2*sum(i in 0..atoms-1, dot(r[i+1] - r[i], r[i+1] - r[i])^2))]
#[constraint(rod[b in 0..bonds]: norm(r[bond[b][0]] - r[bond[b][1]]) = d[b])]
struct Molecule {
    m: Vec<f64>,
    bond: Vec<[usize; 2]>,
    d: Vec<f64>,
    k: f64,
}

impl Chain {
    fn of(n: usize) -> Self {
        Self { m: vec![0.3; n], g: 9.81, l: 1.0 / n as f64 }
    }

    /// Bobs of which each rod makes an angle with the vertical.
    fn at(&self, angle: impl Fn(usize) -> f64) -> impl Iterator<Item = f64> {
        let step = |i: usize| [self.l * angle(i).sin(), -self.l * angle(i).cos()];
        let places = (0..self.m.len()).scan([0.0; 2], |[x, y], i| {
            let [right, up] = step(i);
            (*x, *y) = (*x + right, *y + up);
            Some([*x, *y])
        });
        places.collect::<Vec<_>>().into_iter().flatten()
    }
}

/// The hanging chain of n equal rods swings by ω² = x g/l, where x is a zero of Laguerre's polynomial L_n: the bob that has i others
/// below it moves by L_i(x). (Bernoulli 1733, by small angles.)
#[test]
fn a_hanging_chain_has_the_frequencies_of_laguerre() {
    // The first zeros of L_10 and L_1000.
    for (n, x) in [(1, 1.0), (2, 2.0 - 2.0_f64.sqrt()), (10, 0.137_793_470_540_492), (1000, first_zero(1000))]
    {
        let chain = Chain::of(n);
        let mut shape = vec![1.0, 1.0 - x];
        for i in 1..n {
            let k = i as f64;
            shape.push(((2.0 * k + 1.0 - x) * shape[i] - k * shape[i - 1]) / (k + 1.0));
        }
        assert!(shape[n].abs() < 1e-9, "L_{n}({x}) = {}", shape[n]);
        let swing = |i: usize| 1e-7 * chain.l * shape[n - 1 - i];
        let q: Vec<f64> = (0..n).flat_map(|i| [swing(i), -chain.l * (i + 1) as f64]).collect();
        let mut a = vec![0.0; 2 * n];
        chain.accelerations(0.0, &q, &vec![0.0; 2 * n], &mut a);
        let rate = x * chain.g / chain.l;
        let sum = |of: &dyn Fn(usize) -> f64| (0..n).map(|i| of(i) * swing(i)).sum::<f64>();
        let found = -sum(&|i| a[2 * i]) / sum(&swing);
        assert!((found / rate - 1.0).abs() < if n > 10 { 1e-9 } else { 1e-12 }, "ω² {found}, not {rate}");
        for i in 0..n {
            assert!((a[2 * i] + rate * swing(i)).abs() < 1e-8 * rate * swing(n - 1), "bob {i} of {n}");
        }
    }
}

/// The first zero of Laguerre's polynomial, by Newton's method from the first zero of J₀: x ≈ (j₀/2)²/(n + ½).
fn first_zero(n: usize) -> f64 {
    let mut x = (2.404_825_557_695_773_f64 / 2.0).powi(2) / (n as f64 + 0.5);
    for _ in 0..5 {
        let (mut before, mut at) = (1.0, 1.0 - x);
        for i in 1..n {
            let k = i as f64;
            (before, at) = (at, ((2.0 * k + 1.0 - x) * at - k * before) / (k + 1.0));
        }
        // x L_n′ = n (L_n − L_{n−1})
        x -= at * x / (n as f64 * (at - before));
    }
    x
}

/// A motion is that of the system with its number written out, and stays on the constraints.
#[test]
fn a_chain_moves_as_the_one_written_out() {
    let chain = Chain { m: vec![1.0, 0.4, 2.0], ..Chain::of(3) };
    let three = Three { m: [1.0, 0.4, 2.0], g: chain.g, l: chain.l };
    let q: Vec<f64> = chain.at(|i| 1.0 + 0.5 * i as f64).collect();
    let method = Dop853::with_tolerance(1e-12);
    let path = chain.integrate(chain.at_rest(q.clone()), 2.0, method).unwrap();
    let known = three.integrate(State::at_rest(<[f64; 6]>::try_from(q).unwrap()), 2.0, method).unwrap();
    let (end, known) = (path.end(), known.end());
    for i in 0..6 {
        assert!((end.state().q[i] - known.state().q[i]).abs() < 1e-9);
        assert!((end.state().v[i] - known.state().v[i]).abs() < 1e-8);
    }
    let multipliers = chain.multipliers(end.state()).unwrap();
    for a in 0..3 {
        assert!((multipliers[a] - known.solution().unwrap().multipliers[a]).abs() < 1e-7);
    }
    for sample in path.samples(20) {
        let (q, v) = (&sample.state().q, &sample.state().v);
        let mut above = [0.0; 4];
        for i in 0..3 {
            let at = [q[2 * i], q[2 * i + 1], v[2 * i], v[2 * i + 1]];
            let d: Vec<f64> = at.iter().zip(above).map(|(one, other)| one - other).collect();
            assert!((d[0].hypot(d[1]) - chain.l).abs() < 1e-12, "{:e}", d[0].hypot(d[1]) - chain.l);
            assert!((d[0] * d[2] + d[1] * d[3]).abs() < 1e-11);
            above = at;
        }
    }
}

/// A long chain falls with its energy kept, and its steps allocate nothing.
#[test]
fn a_chain_of_a_hundred_keeps_its_energy_and_allocates_nothing() {
    let chain = Chain::of(100);
    let start = chain.at_rest(chain.at(|i| 1.5 + 0.3 * (i as f64 * 0.2).sin()));
    let energy = chain.energy(&start);
    let mut motion = Motion::new(chain.clone(), start, Dop853::with_tolerance(1e-10)).unwrap();
    motion.advance_to(0.2).unwrap();
    let used = allocation_counter::measure(|| motion.advance_to(0.6).unwrap());
    assert_eq!(used.count_total, 0);
    assert!((chain.energy(motion.state()) - energy).abs() < 1e-7);
}

/// A ring of six atoms whose bonds and diagonals of three are rigid.
fn molecule() -> (Molecule, [f64; 18], [f64; 18]) {
    let place = |i: usize| {
        let angle = std::f64::consts::TAU * i as f64 / 6.0;
        [angle.cos(), angle.sin(), 0.2 * (i % 2) as f64]
    };
    let bond = vec![[3, 4], [0, 1], [4, 5], [2, 1], [5, 0], [2, 3], [0, 3]];
    let distance = |[a, b]: &[usize; 2]| {
        let d: Vec<f64> = place(*a).iter().zip(place(*b)).map(|(a, b)| a - b).collect();
        d.iter().map(|d| d * d).sum::<f64>().sqrt()
    };
    let d = bond.iter().map(distance).collect();
    let molecule = Molecule { m: (1..=6).map(f64::from).collect(), bond, d, k: 0.3 };
    let q = std::array::from_fn(|i| place(i / 3)[i % 3]);
    let v = std::array::from_fn(|i| (i as f64 * 1.7).sin());
    (molecule, q, v)
}

/// Momentum and angular momentum are conserved whatever the table holds, and are methods, because that is proved.
#[test]
fn a_molecule_keeps_its_momenta_and_allocates_nothing() {
    let (molecule, q, v) = molecule();
    let start = molecule.project(&molecule.state(q, v)).unwrap().0;
    let (p, j) = (molecule.total_momentum(&start), molecule.total_angular_momentum(&start));
    const { assert!(Molecule::ENERGY_IS_CONSERVED) };
    let energy = molecule.energy(&start);
    let mut motion = Motion::new(molecule.clone(), start, Dop853::with_tolerance(1e-11)).unwrap();
    motion.advance_to(1.0).unwrap();
    let used = allocation_counter::measure(|| motion.advance_to(4.0).unwrap());
    assert_eq!(used.count_total, 0);
    let end = motion.state();
    assert!((molecule.total_momentum(end) - p).norm() < 1e-11);
    assert!((molecule.total_angular_momentum(end) - j).norm() < 1e-9);
    assert!((molecule.energy(end) - energy).abs() < 1e-9);
}

/// Systems with the same numbers of rows and entries in turn, with other tables, do not disturb one another.
#[test]
fn what_is_analysed_for_one_table_is_not_used_for_another() {
    let (one, q, v) = molecule();
    let other =
        Molecule { bond: vec![[0, 1], [1, 2], [2, 3], [3, 4], [4, 5], [5, 0], [1, 4]], ..one.clone() };
    let accelerations = |system: &Molecule| {
        let mut a = vec![0.0; 18];
        system.accelerations(0.0, &q, &v, &mut a);
        a
    };
    let alone = [one.clone(), other.clone()]
        .map(|system| std::thread::spawn(move || molecule_accelerations(&system, q, v)).join().unwrap());
    for _ in 0..3 {
        assert_eq!([&one, &other].map(accelerations), alone);
    }
}

fn molecule_accelerations(system: &Molecule, q: [f64; 18], v: [f64; 18]) -> Vec<f64> {
    let mut a = vec![0.0; 18];
    system.accelerations(0.0, &q, &v, &mut a);
    a
}

/// Bobs of very different masses: the load that hangs on light links pulls with its weight, and multipliers keep their digits.
#[test]
fn a_load_on_light_links_pulls_with_its_weight() {
    for light in [1e-3, 1e-5, 1e-7] {
        let n = 5;
        let mut m = vec![light; n];
        m[n - 1] = 1.0;
        let chain = Chain { m, ..Chain::of(n) };
        let hanging = chain.at_rest(chain.at(|_| 0.0));
        let multipliers = chain.multipliers(&hanging).unwrap();
        for (i, multiplier) in multipliers.iter().enumerate() {
            let load: f64 = chain.m[i..].iter().sum::<f64>() * chain.g;
            assert!((multiplier + load).abs() < 1e-9 * load, "rod {i}: {multiplier}, not {load}");
        }
    }
    let mut m = vec![1e-12; 5];
    m[4] = 1.0;
    let chain = Chain { m, ..Chain::of(5) };
    let error = chain.multipliers(&chain.at_rest(chain.at(|_| 0.1))).unwrap_err();
    assert!(error.to_string().starts_with("constraint `rod["), "{error}");
}

/// Errors name a constraint with its index.
#[test]
fn errors_name_a_constraint_by_its_index() {
    let chain = Chain::of(4);
    let mut q: Vec<f64> = chain.at(|_| 0.3).collect();
    q[4] += 1e-3;
    let off = chain.at_rest(q);
    let error = chain.integrate(off.clone(), 1.0, Dop853::default()).map(|_| ()).unwrap_err();
    assert!(
        matches!(error, Error::Inconsistent { constraint: Row::WrittenConstraint(name), rate: false, .. } if &*name == "rod[2]")
    );
    assert!(error.to_string().starts_with("the state violates constraint `rod[2]` at t = 0"), "{error}");
    assert!(error.to_string().contains("`project`"), "{error}");
    let (start, moved) = chain.project(&off).unwrap();
    assert!(moved.largest_coordinate_change() < 1e-3);
    assert!(chain.integrate(start, 1.0, Dop853::default()).unwrap().ending().is_complete());

    let (molecule, q, v) = molecule();
    let mut twice = molecule.clone();
    twice.bond.push([1, 0]);
    twice.d.push(twice.d[1]);
    let error = twice.multipliers(&twice.state(q, v)).unwrap_err();
    assert!(matches!(error, Error::Dependent { .. }), "{error}");
    assert!(error.to_string().starts_with("constraint `rod["), "{error}");
    let start = molecule.project(&molecule.state(q, v)).unwrap().0;
    let error = twice.integrate(start, 1.0, Dop853::default()).map(|_| ()).unwrap_err();
    assert!(matches!(error, Error::Dependent { .. }), "{error}");

    // Of the bonds [1, 2] and [2, 1] the one that is eliminated last, not one behind them.
    let pair = Molecule { bond: vec![[0, 1], [1, 2], [2, 1], [3, 4]], d: vec![1.0; 4], ..molecule.clone() };
    let error = pair.multipliers(&pair.state(q, v)).unwrap_err();
    assert!(
        matches!(error, Error::Dependent { constraint: Row::WrittenConstraint(name), .. } if ["rod[1]", "rod[2]"].contains(&&*name)),
        "{error}"
    );

    let start = molecule.state(q, v);
    let astray = Molecule { bond: vec![[0, 6]; 7], ..molecule.clone() };
    assert!(matches!(astray.project(&start).unwrap_err(), Error::FieldIndex { .. }));
    assert!(matches!(
        molecule.multipliers(&molecule.at_rest([0.0; 3])).unwrap_err(),
        Error::StateLength { .. }
    ));
    let massless = Molecule { m: vec![0.0; 6], ..molecule.clone() };
    let error = massless.multipliers(&start).unwrap_err();
    assert!(
        matches!(error, Error::EquationsNotFinite { row: Row::Written(name), .. } if &*name == "r[0][0]"),
        "{error}"
    );
}

/// A field of a constraint that is changed during a motion ends it, by name.
#[test]
fn a_change_that_violates_a_constraint_is_told() {
    let chain = Chain::of(3);
    let mut motion = Motion::new(chain.clone(), chain.at_rest(chain.at(|_| 0.4)), Dop853::default()).unwrap();
    motion.advance_to(0.5).unwrap();
    motion.system_mut().l = 0.4;
    let error = motion.advance_to(1.0).unwrap_err();
    assert!(error.to_string().contains("the state violates constraint `rod[0]`"), "{error}");
}
