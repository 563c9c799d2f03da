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
    let error = Error::ElementMissing { array: "q", index: -1, length: 5 };
    assert!(
        error.to_string().starts_with("`q[-1]` is outside of the array, which has 5 elements"),
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
