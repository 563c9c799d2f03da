//! Systems whose number of bodies is a field: names, energies, and checks of their fields.

use std::fmt;
use std::sync::Arc;

use lagrange_core::motion::{Composition, ManyBodyField};
use lagrange_core::nalgebra::{Const, DVector, Dyn};
use lagrange_core::structure::VelocityFreeForces;
use lagrange_core::{Ensemble, Error, Method, System, generic, prelude::*};

type State = generic::State<f64, Dyn>;

/// Bodies in the plane, tied to one another by springs without length.
#[derive(Clone)]
struct Net {
    n: usize,
    m: Vec<f64>,
    bond: Vec<[usize; 2]>,
    k: f64,
}

impl System for Net {
    type Scalar = f64;
    type Length = Dyn;
    type M = Const<0>;
    type Field = ManyBodyField;

    fn length(&self) -> Dyn {
        Dyn(2 * self.n)
    }

    fn accelerations(&self, _: f64, q: &[f64], _: &[f64], a: &mut [f64]) {
        a.fill(0.0);
        for [i, j] in &self.bond {
            for x in 0..2 {
                let pull = self.k * (q[2 * j + x] - q[2 * i + x]);
                a[2 * i + x] += pull / self.m[*i];
                a[2 * j + x] -= pull / self.m[*j];
            }
        }
    }
}

impl VelocityFreeForces for Net {}

impl ManyBodies for Net {
    const ENERGY_IS_CONSERVED: bool = true;
    const DIGEST: u32 = 0x00C0_FFEE;

    fn write_name(&self, coordinate: usize, to: &mut dyn fmt::Write) -> fmt::Result {
        write!(to, "r[{}][{}]", coordinate / 2, coordinate % 2)
    }

    fn check(&self) -> Result<(), Error> {
        let (found, expected) = (self.m.len(), self.n);
        if found != expected {
            return Err(Error::FieldLength { field: "m", found, expected, of: "n" });
        }
        match self.bond.as_flattened().iter().position(|body| *body >= self.n) {
            None => Ok(()),
            Some(entry) => {
                let index = self.bond.as_flattened()[entry];
                Err(Error::FieldIndex { field: "bond", entry, index, length: self.n })
            }
        }
    }

    fn visit_numbers(&self, visit: &mut dyn FnMut(f64)) {
        self.m.iter().chain([&self.k]).for_each(|x| visit(*x));
        self.bond.as_flattened().iter().for_each(|body| visit(*body as f64));
    }

    fn lagrangian(&self, state: &State) -> f64 {
        self.momenta(state).dot(&state.v) / 2.0 - self.stored(state)
    }

    fn energy(&self, state: &State) -> f64 {
        self.momenta(state).dot(&state.v) / 2.0 + self.stored(state)
    }

    fn momenta(&self, state: &State) -> DVector<f64> {
        DVector::from_fn(2 * self.n, |i, _| self.m[i / 2] * state.v[i])
    }
}

impl Net {
    /// A ring of bodies of different masses.
    fn ring(n: usize) -> Self {
        let m = (0..n).map(|i| 1.0 + i as f64).collect();
        Self { n, m, bond: (0..n).map(|i| [i, (i + 1) % n]).collect(), k: 2.0 }
    }

    fn stored(&self, state: &State) -> f64 {
        let distance = |[i, j]: &[usize; 2], x: usize| state.q[2 * i + x] - state.q[2 * j + x];
        let squared = self.bond.iter().map(|bond| distance(bond, 0).powi(2) + distance(bond, 1).powi(2));
        squared.sum::<f64>() * self.k / 2.0
    }
}

fn start(n: usize) -> State {
    let number = |i: usize| (1.0 + 1.7 * i as f64).sin();
    let q = DVector::from_fn(2 * n, |i, _| number(i));
    State { t: 0.0, q, v: DVector::from_fn(2 * n, |i, _| number(i + 100)) }
}

/// Fields that do not fit are told of before the first step, wherever a motion can start or go on.
#[test]
fn fields_that_do_not_fit_are_refused() {
    let short = Net { m: vec![1.0; 3], ..Net::ring(4) };
    let mut astray = Net::ring(10);
    astray.bond[3][1] = 12;
    let said = [
        (short, 4, "the field `m` has 3 elements, and `n` is 4: give it 4"),
        (astray, 10, "entry 7 of `bond` is 12, and there are 10: indices, like entries, count from 0"),
    ];
    for (wrong, n, said) in said {
        let method = Dop853::default();
        let refused = |error: Error| assert_eq!(error.to_string(), said);
        refused(wrong.integrate(start(n), 1.0, method).unwrap_err());
        refused(wrong.motion(start(n)).every(0.5).to(1.0).unwrap_err());
        refused(Motion::new(wrong.clone(), start(n), Verlet::with_step(0.1)).unwrap_err());
        let make = |k| (if k == 1 { wrong.clone() } else { Net::ring(n) }, start(n));
        let outcome = Ensemble::from_fn(3, make).integrate(1.0, method).unwrap();
        assert_eq!(outcome.completed().count(), 2);
        refused(outcome.get(1).unwrap().result.clone().unwrap_err());

        let mut motion = Motion::new(Net::ring(n), start(n), method).unwrap();
        motion.advance_to(0.5).unwrap();
        *motion.system_mut() = wrong.clone();
        refused(motion.set_state(start(n)).unwrap_err());
        assert!(motion.advance_to(1.0).unwrap_err().to_string().contains(said));
        assert_eq!(motion.state().t, 0.5);
        *motion.system_mut() = Net::ring(n);
        motion.advance_to(1.0).unwrap();

        let net = Net::ring(n);
        let last = net.event("last", |sample| sample.system().m[n - 1] - 100.0);
        let steered = net.motion(start(n)).every(0.5).event(last).controlled(0.25, |net, state| {
            *net = if state.t > 0.6 { wrong.clone() } else { Net::ring(n) };
            Ok::<(), &str>(())
        });
        let steered = steered.towards(2.0).unwrap();
        assert!(steered.ending().to_string().contains(said), "{}", steered.ending());
        assert_eq!(steered.end().state().t, 0.75);
    }
}

#[test]
fn an_element_that_is_missing_is_named() {
    let error = Error::ElementMissing { array: "q", index: -1, from: 0, to: 5 };
    assert!(
        error.to_string().starts_with("`q[-1]` does not exist: the indices of `q` are 0..5; "),
        "{error}"
    );
}

/// States and accelerations that are no numbers are told of by the names that the system writes.
#[test]
fn messages_name_coordinates() {
    let net = Net::ring(4);
    let refused = |spoil: &dyn Fn(&mut State), name: &str| {
        let mut state = start(4);
        spoil(&mut state);
        let error = net.integrate(state, 1.0, Dop853::default()).unwrap_err();
        assert!(error.to_string().starts_with(&format!("`{name}` is")), "{error}");
    };
    refused(&|state| state.q[7] = f64::NAN, "r[3][1]");
    refused(&|state| state.v[6] = f64::INFINITY, "r_dot[3][0]");
    refused(&|state| state.t = f64::NAN, "t");
    let massless = Net { m: vec![1.0, 0.0, 1.0, 1.0], ..net };
    let error = massless.integrate(start(4), 1.0, Dopri5::default()).unwrap_err();
    assert!(error.to_string().contains("row of coordinate `r[1][0]`"), "{error}");
}

/// The mean of the places, weighted by mass, moves evenly; a motion behind a pointer is the same.
#[test]
fn the_centre_of_mass_moves_evenly() {
    fn check(method: impl Method<Net> + Method<Arc<Net>> + Clone, off: f64) {
        let net = Net::ring(5);
        let path = net.integrate(start(5), 10.0, method.clone()).unwrap();
        let total: f64 = net.m.iter().sum();
        let centre = |x: &DVector<f64>| (0..5).map(|i| net.m[i] * x[2 * i]).sum::<f64>() / total;
        for sample in path.samples(20) {
            let State { t, q, v } = sample.state();
            assert!((centre(q) - centre(&start(5).q) - t * centre(&start(5).v)).abs() < off);
            assert!((centre(v) - centre(&start(5).v)).abs() < off);
        }
        let shared = Arc::new(net.clone());
        let shared = shared.integrate(start(5), 10.0, method).unwrap();
        assert_eq!(shared.end().state(), path.end().state());
    }
    check(Dop853::with_tolerance(1e-12), 1e-13);
    check(RungeKutta4::with_step(0.05), 1e-13);
    check(Verlet::with_step(0.05).composed(Composition::KahanLi8), 1e-13);
}

/// Members of an ensemble are told apart by the numbers of their fields.
#[test]
fn fingerprints_tell_fields_apart() {
    let ensemble = |k: f64| {
        let make = move |_| (Net { k, ..Net::ring(3) }, start(3));
        Ensemble::from_fn(2, make).integrate(1.0, Dop853::default()).unwrap()
    };
    let [one, other] = [2.0, 3.0].map(ensemble);
    assert!(one.clone().merge(ensemble(2.0)).is_ok());
    assert!(one.merge(other).unwrap_err().to_string().contains("the start or the parameters"));
}

/// A ring that has moved, and its path.
fn moved(net: &Net) -> Trajectory<&Net> {
    net.integrate(start(net.n), 5.0, Dop853::with_tolerance(1e-12)).expect("a motion")
}

/// Entries of states are found by name, in samples, at the end, and in events.
#[test]
fn entries_are_looked_up_by_name() {
    let net = Net::ring(4);
    let path = moved(&net);
    let (end, state) = (path.end(), path.end().state().clone());
    assert_eq!(end.coordinate("r[3][1]").unwrap(), state.q[7]);
    assert_eq!(end.velocity("r[0][1]").unwrap(), state.v[1]);
    assert_eq!(end.momentum("r[2][0]").unwrap(), 3.0 * state.v[4]);
    // The neighbours of body 2 are 1 and 3.
    let pull = 2.0 * (state.q[3] + state.q[7] - 2.0 * state.q[5]) / 3.0;
    assert!((end.acceleration("r[2][1]").unwrap() - pull).abs() < 1e-14);
    assert_eq!(end.conserved("energy").unwrap(), net.energy(&state));
    let event = net.event("axis", |sample| sample.coordinate("r[1][1]"));
    let crossed = net.motion(start(4)).event(event).to(5.0).unwrap();
    assert!(!crossed.crossings().is_empty());
    assert!(crossed.crossings().iter().all(|crossing| crossing.state.q[3].abs() < 1e-14));
}

/// Names that there are not lead to those that there are.
#[test]
fn unknown_names_have_hints() {
    let net = Net::ring(4);
    let path = moved(&net);
    let end = path.end();
    let said = |error: Result<f64, Error>| error.unwrap_err().to_string();
    assert_eq!(
        said(end.coordinate("r")),
        "there is no coordinate `r`: it is a vector: name an element, such as `r[0][0]`"
    );
    assert_eq!(
        said(end.coordinate("r_dot[3][1]")),
        "there is no coordinate `r_dot[3][1]`: it is the velocity of `r[3][1]`, which a sample's `velocity(\"r[3][1]\")` gives"
    );
    assert_eq!(said(end.velocity("r[3]1]")), "there is no coordinate `r[3]1]`: did you mean `r[3][1]`?");
    for near in ["r[4][0]", "r[3][1]]", "r[3][1", "", "s[3][1]"] {
        let error = end.coordinate(near).unwrap_err();
        assert!(matches!(&error, Error::UnknownName { known, .. } if known.len() == 8), "{error}");
    }
    assert!(said(end.conserved("momentum")).contains("`energy`"));
}

/// Tables have the names as headings, with an energy on request.
#[test]
fn tables_have_names_as_headings() {
    let net = Net::ring(2);
    let path = moved(&net);
    let heading = "t,r[0][0],r[0][1],r[1][0],r[1][1],r_dot[0][0],r_dot[0][1],r_dot[1][0],r_dot[1][1]";
    let first = |table: String| table.lines().next().unwrap().to_string();
    assert_eq!(first(path.csv(3).to_string()), heading);
    let records = path.csv(3).energy().conserved().records();
    assert_eq!(records.names.join(","), format!("{heading},energy"));
    for (row, sample) in records.rows.iter().zip(path.samples(3)) {
        let state = sample.state();
        let expected = [&[state.t], state.q.as_slice(), state.v.as_slice(), &[net.energy(state)]].concat();
        assert_eq!(*row, expected);
    }
    let sampled = net.motion(start(2)).every(1.0).quantity("E", |sample| sample.energy()).to(5.0).unwrap();
    assert_eq!(first(sampled.csv().to_string()), format!("{heading},E"));
    let text = format!("{:.2}", path.start());
    let named = ["r[0][0] = 0.84", "r[1][1] = -0.18", "r_dot[0][0] = ", "r_dot[1][1] = "];
    assert!(named.iter().all(|entry| text.contains(entry)), "{text}");
}

/// Kinetic and stored energy from the textbook are that of samples, and it does not drift.
#[test]
fn energies_of_samples_are_conserved() {
    let net = Net::ring(3);
    let path = moved(&net);
    let energy = |state: &State| {
        let moving = |i: usize| net.m[i / 2] * state.v[i].powi(2) / 2.0;
        let apart = |i: usize| (state.q[i] - state.q[(i + 2) % 6]).powi(2);
        (0..6).map(moving).sum::<f64>() + (0..6).map(apart).sum::<f64>()
    };
    for sample in path.samples(20) {
        assert!((sample.energy() - energy(sample.state())).abs() < 1e-13);
        let kinetic_twice = net.momenta(sample.state()).dot(&sample.state().v);
        assert!((net.lagrangian(sample.state()) + sample.energy() - kinetic_twice).abs() < 1e-13);
    }
    let drift = path.drift();
    assert_eq!(drift.iter().map(|quantity| quantity.name).collect::<Vec<_>>(), ["energy"]);
    let deviation = drift.get("energy").unwrap();
    assert!((deviation.start - energy(&start(3))).abs() < 1e-13);
    assert!(deviation.largest < 1e-10 && deviation.largest > 0.0);
    // Of samples alone the ends are kept.
    let sampled = net.motion(start(3)).every(1.0).to(5.0).unwrap();
    assert!((sampled.end().energy() - path.start().energy()).abs() < 1e-6);
}

/// A net in a fluid: its energy is not conserved, and the power of the forces is not known.
#[derive(Clone)]
struct Damped(Net);

impl System for Damped {
    type Scalar = f64;
    type Length = Dyn;
    type M = Const<0>;
    type Field = ManyBodyField;

    fn length(&self) -> Dyn {
        self.0.length()
    }

    fn accelerations(&self, t: f64, q: &[f64], v: &[f64], a: &mut [f64]) {
        self.0.accelerations(t, q, v, a);
        a.iter_mut().zip(v).for_each(|(a, v)| *a -= 0.1 * v);
    }
}

impl ManyBodies for Damped {
    const ENERGY_IS_CONSERVED: bool = false;
    const DIGEST: u32 = 0;

    fn write_name(&self, coordinate: usize, to: &mut dyn fmt::Write) -> fmt::Result {
        self.0.write_name(coordinate, to)
    }

    fn check(&self) -> Result<(), Error> {
        self.0.check()
    }

    fn visit_numbers(&self, visit: &mut dyn FnMut(f64)) {
        self.0.visit_numbers(visit);
    }

    fn lagrangian(&self, state: &State) -> f64 {
        self.0.lagrangian(state)
    }

    fn energy(&self, state: &State) -> f64 {
        self.0.energy(state)
    }

    fn momenta(&self, state: &State) -> DVector<f64> {
        self.0.momenta(state)
    }
}

#[test]
fn an_energy_that_is_lost_is_no_drift() {
    let damped = Damped(Net::ring(3));
    let path = damped.integrate(start(3), 5.0, Dop853::default()).unwrap();
    assert!(path.end().energy() < 0.9 * path.start().energy());
    assert_eq!(path.drift().iter().count(), 0);
    assert!(!path.csv(2).conserved().to_string().contains("energy"));
    assert!(path.csv(2).energy().to_string().contains("energy"));
}
