//! The interpreter and the emitted code have the same results: accelerations, multipliers, energies, observables, conserved quantities and
//! residuals of 60 systems and more, at random states.

use lagrange_core::nalgebra::{Const, DVector};
use lagrange_core::{Lagrangian, ManyBodies, Simulate, State, System as _, generic};
use lagrange_interpreter::{Model, System};
use lagrange_random::Random;
use lagrange_systems::random_state;

/// Largest difference, relative to the largest entry of a result: the operations are the same, but the compiler of the emitted code may
/// compute sine and cosine together.
const TOLERANCE: f64 = 1e-13;

/// A field with random numbers of positive sign.
trait Drawn {
    fn drawn(random: &mut Random) -> Self;
}

impl Drawn for f64 {
    fn drawn(random: &mut Random) -> Self {
        random.between(0.5, 1.5)
    }
}

impl<T: Drawn, const N: usize> Drawn for [T; N] {
    fn drawn(random: &mut Random) -> Self {
        std::array::from_fn(|_| T::drawn(random))
    }
}

/// Derives each system, and checks it against its text.
macro_rules! systems {
    ($($(#[$attribute:meta])* struct $name:ident $({ $($field:ident: $type:ty),* })? $(;)?)*) => {
        use crate::{Drawn, check};
        use lagrange_core::prelude::*;
        use lagrange_random::Random;

        $(#[derive(Lagrangian)] $(#[$attribute])* struct $name { $($($field: $type),*)? })*

        /// Checks all systems. Returns how many there are.
        pub(crate) fn check_all(random: &mut Random) -> usize {
            $({
                let system = $name { $($($field: Drawn::drawn(random)),*)? };
                check(stringify!($(#[$attribute])* struct $name { $($($field: $type),*)? }), &system, random);
            })*
            [$(stringify!($name)),*].len()
        }
    };
}

mod corpus;

#[test]
fn results_are_those_of_the_emitted_code() {
    let mut random = Random(65);
    let checked = corpus::check_all(&mut random) + check_shared(&mut random);
    assert!(checked >= 60, "{checked} systems");
}

/// Checks the systems that tests share, by their text in the source. Returns how many there are.
fn check_shared(random: &mut Random) -> usize {
    macro_rules! shared {
        ($($file:literal: $($name:ident { $($field:ident),* }),+;)*) => {{
            $($({
                let system = lagrange_systems::$name { $($field: Drawn::drawn(random)),* };
                let text = include_str!(concat!("../../../../tests/systems/src/", $file, ".rs"));
                check(&text_of(text, stringify!($name)), &system, random);
            })+)*
            [$($(stringify!($name)),+),*].len()
        }};
    }
    shared! {
        "bobs": ShakenPendulum { m, g, l, a, w }, TwoBobs { m, g }, DoubledRod { g, a, c };
        "chains": ChainOfFive { beta };
        "oscillators": Spring { m, k }, DrivenSpring { m, k, c, a, w }, Sticking { m, k, belt }, HenonHeiles {};
        "pendulums": Pendulum { m, l, g }, DoublePendulum { m, l, g }, SphericalPendulum { m, g, l },
            PolarPendulum { m, g, l }, BeadOnHoop { r, g, omega }, Foucault { m, g, l, rate, latitude };
        "planets": Planet { mu }, ThreeBodies { mu }, OuterSolarSystem { m, G };
        "rolling": ChaplyginSleigh { m, a, inertia }, KnifeEdge { m, inertia, g }, TiedParticle {},
            BallInAngles { m, a, turn };
        "tops": HeavyTop { i1, i3, mgl };
    }
}

/// Text of a struct in a source file, with `f64` in the place of the type parameter `T`.
fn text_of(file: &str, name: &str) -> String {
    let at = |pattern: String| file.find(&pattern);
    let of_struct = ["<", " ", ";"].into_iter().find_map(|after| at(format!("pub struct {name}{after}")));
    let of_struct = of_struct.expect("the struct stands in its file");
    let start = file[..of_struct].rfind("#[derive(").expect("it is derived");
    let length = file[start..].find("\n}\n").map_or(usize::MAX, |length| length + 2);
    let line = file[of_struct..].find(";\n").map_or(usize::MAX, |length| of_struct - start + length + 1);
    let text = &file[start..start + length.min(line)];
    text.replace("<T>", "").replace(": T", ": f64").replace("[T;", "[f64;")
}

/// Compares all results of a text with those of the emitted code at three random states.
fn check<L, const N: usize, const M: usize>(text: &str, system: &L, random: &mut Random)
where
    L: Lagrangian<Scalar = f64, Length = Const<N>, N = Const<N>, M = Const<M>>,
{
    let parsed = System::parse(text).unwrap_or_else(|refusal| panic!("{}: {refusal}", L::NAME));
    let mut parameters = Vec::new();
    system.visit_parameters(&mut |name, value| parameters.push((name, value)));
    let model = Model::new(&parsed, parameters.into_iter().collect::<lagrange_interpreter::Parameters>())
        .unwrap_or_else(|error| panic!("{}: {error}", L::NAME));
    assert!(model.constraints().eq(L::CONSTRAINTS.iter().copied()));
    for _ in 0..3 {
        compare(&model, system, &random_state::<N>(random));
    }
}

fn compare<L, const N: usize, const M: usize>(model: &Model, system: &L, state: &State<f64, N>)
where
    L: Lagrangian<Scalar = f64, Length = Const<N>, N = Const<N>, M = Const<M>>,
{
    let vector = |x: &[f64]| DVector::from_column_slice(x);
    let [q, v] = [state.q.as_slice(), state.v.as_slice()];
    let of_model = generic::State { t: state.t, q: vector(q), v: vector(v) };
    let emitted = system.accelerations_unchecked(state);
    let emitted = if emitted.pivot > 1e-5 { emitted } else { system.solve(state).expect(L::NAME) };
    let mut accelerations = vec![f64::NAN; N];
    model.accelerations(state.t, q, v, &mut accelerations);
    let equal = |what: &str, found: &[f64], expected: &[f64]| equal((L::NAME, what), found, expected);
    equal("accelerations", &accelerations, emitted.accelerations.as_slice());
    equal(
        "multipliers",
        model.multipliers(&of_model).expect(L::NAME).as_slice(),
        emitted.multipliers.as_slice(),
    );
    equal("energy", &[model.energy(&of_model)], &[system.energy(state)]);
    equal("Lagrangian", &[model.lagrangian(&of_model)], &[system.lagrangian(state)]);
    equal("momenta", model.momenta(&of_model).as_slice(), system.momentum(state).as_slice());
    let of_system = |value: &dyn Fn(usize) -> Option<f64>| (0..).map_while(value).collect::<Vec<f64>>();
    let observables = of_system(&|k| system.observable(k, state, &emitted));
    equal("observables", &model.observe(&of_model).expect(L::NAME), &observables);
    equal(
        "conserved",
        &model.conserved(&of_model).expect(L::NAME),
        &of_system(&|k| system.conserved(k, state)),
    );
    let [residual, rate] = model.residuals(&of_model).expect(L::NAME);
    equal("residual", &residual, system.constraint_residual(state).as_slice());
    equal("rate", &rate, system.constraint_rate(state).as_slice());
}

fn equal((system, what): (&str, &str), found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{system}: {what}");
    let largest = |x: &[f64]| x.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let difference = found.iter().zip(expected).map(|(x, y)| (x - y).abs()).fold(0.0, |worst: f64, x| {
        // NaN is worst.
        if worst >= x { worst } else { x }
    });
    assert!(difference <= TOLERANCE * largest(expected), "{system}: {what} are {found:?}, not {expected:?}");
}
