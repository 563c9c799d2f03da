//! Names: raw, Greek, dotted, and handed on by `macro_rules`.

use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(r#move)]
#[define(r#dyn = r#type*move_dot)]
#[lagrangian(r#dyn*r#move_dot/2 - r#loop*r#move)]
#[constraint(r#fn: r#move = 0)]
#[observable(r#where = 2*r#move)]
#[observable(r#force = lambda(r#fn))]
struct Raw {
    r#type: f64,
    r#loop: f64,
}

#[test]
fn raw_identifiers_are_names_like_any_other() {
    let raw = Raw { r#type: 2.0, r#loop: 3.0 };
    let state = State::at_rest([4.0]);
    let solution = raw.accelerations_unchecked(&state);
    assert_eq!(Raw::COORDINATES, ["move"]);
    assert_eq!(Raw::CONSTRAINTS, ["fn"]);
    assert_eq!(Raw::OBSERVABLES, ["where", "force"]);
    assert_eq!((raw.r#where(&state), raw.force(&state, &solution)), (8.0, 3.0));
    assert_eq!(raw.mass_matrix(&state)[0], 2.0);
}

#[derive(Lagrangian)]
#[coordinates(θ, x)]
#[lagrangian(m/2*(l^2*θ̇^2 + ẋ^2) + μ*θ_dot*ẋ + m*g*l*cos(θ) - ω^2*x^2/2)]
#[observable(θ_rate = der(θ))]
#[observable(ẍ_twice = 2*ẍ)]
struct Greek {
    m: f64,
    l: f64,
    g: f64,
    μ: f64,
    ω: f64,
}

#[test]
fn greek_letters_and_dots_are_names() {
    let greek = Greek { m: 2.0, l: 3.0, g: 9.0, μ: 0.5, ω: 4.0 };
    let state = State::new([0.0, 0.25], [1.0, 2.0]);
    let solution = greek.accelerations_unchecked(&state);
    assert_eq!(Greek::COORDINATES, ["θ", "x"]);
    assert_eq!(greek.momentum(&state).as_slice(), [18.0 + 1.0, 4.0 + 0.5]);
    assert_eq!(greek.forcing(&state).as_slice(), [0.0, -4.0]);
    assert_eq!(greek.θ_rate(&state), 1.0);
    assert_eq!(greek.ẍ_twice(&state, &solution), 2.0 * solution.accelerations[1]);
}

/// Names that the emitted code uses itself.
#[derive(Lagrangian)]
#[coordinates(state, solution)]
#[define(r1 = index*state)]
#[define(vector = state_dot + r1)]
#[lagrangian(
    matrix/2*(vector^2 + solution_dot^2) - multipliers*sin(state)*cos(state) - eliminate*exp(solution)
)]
#[constraint(multipliers: state_dot + solution*cos(r1)*sin(r1) = 0)]
#[observable(results = lambda(multipliers) + r1)]
struct Emitted<T> {
    matrix: T,
    index: T,
    multipliers: T,
    eliminate: T,
}

#[test]
fn names_of_the_emitted_code_do_not_clash() {
    let system = Emitted { matrix: 2.0, index: 0.5, multipliers: 3.0, eliminate: 1.0 };
    let state = State::new([0.4, 0.3], [0.1_f64, 0.2]);
    let solution = system.accelerations_unchecked(&state);
    let (sin, cos) = 0.2_f64.sin_cos();
    assert!((system.momentum(&state)[0] - 2.0 * (0.1 + 0.2)).abs() < 1e-15);
    assert!((system.constraint_rate(&state)[0] - (0.1 + 0.3 * cos * sin)).abs() < 1e-15);
    assert_eq!(system.results(&state, &solution), solution.multipliers[0] + 0.2);
}

/// Fields that are called like locals of the emitted code, one of them where a supplied function is called.
#[test]
fn fields_may_be_called_like_locals() {
    #[derive(Lagrangian)]
    #[coordinates(x, y)]
    #[function(U(x) = call1)]
    #[lagrangian(x_dot^2/2 + y_dot^2/2 - r0*r1*x^2/2 - (r2 + r3)*y*x^3 - r4*sin(r5*x*y)*r6 - U(x) - U(y)*call0[0] - call0[1]*x)]
    struct Locals {
        r0: f64,
        r1: f64,
        r2: f64,
        r3: f64,
        r4: f64,
        r5: f64,
        r6: f64,
        call0: [f64; 2],
        call1: Cube,
    }
    struct Cube;
    impl Function<1, 1> for Cube {
        fn eval<S: Scalar>(&self, [s]: [S; 1]) -> [S; 1] {
            [s * s * s]
        }
    }
    let [r0, r1, r2, r3, r4, r5, r6] = [1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7];
    let system = Locals { r0, r1, r2, r3, r4, r5, r6, call0: [1.8, 1.9], call1: Cube };
    let (x, y) = (0.4_f64, 0.3_f64);
    let force = system.forcing(&State::at_rest([x, y]));
    let turn = r4 * r5 * r6 * (r5 * x * y).cos();
    let expected = [
        -r0 * r1 * x - 3.0 * (r2 + r3) * y * x * x - turn * y - 3.0 * x * x - 1.9,
        -(r2 + r3) * x * x * x - turn * x - 3.0 * y * y * 1.8,
    ];
    assert!(
        (force[0] - expected[0]).abs() < 1e-14 && (force[1] - expected[1]).abs() < 1e-14,
        "{force} {expected:?}"
    );
    let accelerations = system.accelerations_unchecked(&State::at_rest([x, y])).accelerations;
    assert!((accelerations - force).amax() < 1e-14);
}

macro_rules! oscillator {
    ($(#[$attribute:meta])* $name:ident, $x:ident, $velocity:ident, $field:ident: $number:ty,
     $kinetic:expr, $potential:expr, $stiffness:literal, $left:expr, $constraint:ident, $length:literal) => {
        $(#[$attribute])*
        #[derive(Lagrangian)]
        #[coordinates($x, r: [$length])]
        #[define($constraint = $kinetic)]
        #[lagrangian($constraint - $stiffness/2*$potential + dot(r_dot, r_dot)/2 + $field*$velocity*0)]
        #[constraint($constraint: $left = 0)]
        #[force($x: -$field*der($x))]
        #[observable($constraint = lambda($constraint))]
        struct $name {
            $field: $number,
            arm: [$number; $length],
        }
    };
}

oscillator!(
    /// The sum in the kinetic energy and the one in the potential keep their parentheses.
    Oscillator, x, x_dot, m: f64, m + m*x_dot^2/2 - m, 1 + x^2, 2.5, r[1] - arm[1], pinned, 2
);

#[test]
fn macro_rules_may_pass_names_expressions_and_numbers() {
    let system = Oscillator { m: 2.0, arm: [0.0, 0.5] };
    let state = State::new([0.4, 0.0, 0.5], [0.2, 0.0, 0.0]);
    let solution = system.accelerations_unchecked(&state);
    assert_eq!(Oscillator::COORDINATES, ["x", "r[0]", "r[1]"]);
    assert_eq!(Oscillator::CONSTRAINTS, ["pinned"]);
    assert_eq!(system.mass_matrix(&state).diagonal().as_slice(), [2.0, 1.0, 1.0]);
    assert!((system.lagrangian(&state) - (0.04 - 1.25 * 1.16)).abs() < 1e-15);
    assert!((system.forcing(&state)[0] - (-2.5 * 0.4 - 2.0 * 0.2)).abs() < 1e-15);
    assert_eq!(system.constraint_residual(&state)[0], 0.0);
    assert_eq!(system.pinned(&state, &solution), 0.0);
}

/// A whole attribute from a macro, an index and an exponent too.
macro_rules! chain {
    ($name:ident, $n:literal, $power:literal, $i:ident, $term:expr) => {
        #[derive(Lagrangian)]
        #[coordinates(x: [$n])]
        #[define(reach[$i in 0..$n] = sum(j in 0..$i + 1, x[j]))]
        #[lagrangian(sum($i in 0..$n, $term) - (reach[$n - 1] - 1)^$power)]
        struct $name;
    };
}

chain!(Chain, 3, 2, i, der(reach[i]) ^ 2 / 2);

#[test]
fn macro_rules_may_pass_ranges_and_exponents() {
    let mass = Chain.mass_matrix(&State::at_rest([0.0; 3]));
    assert_eq!(mass.as_slice(), [3.0, 2.0, 1.0, 2.0, 2.0, 1.0, 1.0, 1.0, 1.0]);
    assert_eq!(Chain.forcing(&State::at_rest([0.0, 0.5, 0.0])).as_slice(), [1.0; 3]);
}

/// Types that are called like those of the runtime.
mod like_the_runtime {
    use lagrange_core::prelude::Lagrangian;

    type Scalar = f64;

    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(m/2 * x_dot^2 - k/2 * sin(x)^2)]
    #[constraint(held: x = 0)]
    #[observable(pull = lambda(held))]
    #[lagrange(scalar = Scalar)]
    pub(super) struct State {
        pub(super) m: Scalar,
        pub(super) k: Scalar,
    }

    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(m/2 * x_dot^2)]
    pub(super) struct Solution<Scalar> {
        pub(super) m: Scalar,
    }
}

#[test]
fn types_may_be_called_like_those_of_the_runtime() {
    let state = State::new([0.0], [1.0]);
    assert_eq!(like_the_runtime::State { m: 2.0, k: 3.0 }.momentum(&state)[0], 2.0);
    assert_eq!(like_the_runtime::Solution { m: 5.0_f32 }.momentum(&State::new([0.0], [1.0]))[0], 5.0);
}
