//! What the derive takes: the outermost of what is right.

use lagrange_core::prelude::*;

/// Every attribute with trailing commas.
#[derive(Lagrangian)]
#[coordinates(x, r: [2],)]
#[define(half(a,) = a/2,)]
#[lagrangian(half(m*x_dot^2,) + m/2 * dot(r_dot, r_dot,),)]
#[constraint(rod: x = l,)]
#[force(r: [0, 1,],)]
#[dissipation(x_dot^2,)]
#[observable(pull = lambda(rod,),)]
#[parameter(m: 0..1,)]
#[lagrange(crate = lagrange_core, scalar = f64,)]
struct Commas {
    m: f64,
    l: f64,
}

#[test]
fn trailing_commas_are_taken() {
    let (system, state) = (Commas { m: 1.0, l: 0.0 }, State::at_rest([0.0; 3]));
    assert_eq!(system.pull(&state, &system.accelerations_unchecked(&state)), 0.0);
}

/// Numbers, signs and powers.
#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2)]
#[observable(read = [1_000, 5., 1.5e-3, -x^2, 2^-1, 2^3^2, 2*-x - -x, 2/5, 8/4/2, x^0.5 - sqrt(x)])]
#[observable(zero = 0 + [x, x])]
struct Numbers;

#[test]
fn numbers_are_read_as_they_are_written() {
    let state = State::at_rest([3.0]);
    let expected = [1000.0, 5.0, 0.0015, -9.0, 0.5, 512.0, -3.0, 0.4, 1.0, 0.0];
    assert_eq!(Numbers.read(&state).as_slice(), expected);
    assert_eq!(Numbers.zero(&state)[1], 3.0);
}

/// Names of items of the program, which would be patterns in its scope.
mod items {
    use lagrange_core::prelude::*;

    pub(super) const G: f64 = 6.0;
    pub(super) struct Mass;

    #[derive(Lagrangian)]
    #[coordinates(X)]
    #[lagrangian(Mass*X_dot^2/2 - G*g*X)]
    #[allow(non_snake_case, reason = "as they are written in the Lagrangian")]
    pub(super) struct Fall {
        pub(super) G: f64,
        pub(super) g: f64,
        pub(super) Mass: f64,
    }
}

#[test]
fn fields_may_have_names_of_constants() {
    let fall = items::Fall { G: 2.0, g: 3.0, Mass: 4.0 };
    assert_eq!(fall.accelerations_unchecked(&State::at_rest([0.0])).accelerations[0], -1.5);
    // The items are those of the program still.
    let items::Mass = items::Mass;
    assert_eq!(items::G, 6.0);
}

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2)]
#[force(x: 1)]
#[force(y: -k*y)]
#[force(x: 2)]
#[force(y: -c*y_dot)]
struct Pulled {
    k: f64,
    c: f64,
}

#[test]
fn forces_on_one_coordinate_are_added() {
    let (pulled, state) = (Pulled { k: 2.0, c: 3.0 }, State::new([0.0, 1.0], [0.0, 1.0]));
    assert_eq!(pulled.accelerations_unchecked(&state).accelerations.as_slice(), [3.0, -5.0]);
    let page = Pulled::equations().to_string();
    assert!(page.contains("Q_x = 3\n") && page.contains("Q_y = −k y − c ẏ\n"), "{page}");
}

#[derive(Lagrangian)]
#[coordinates(a)]
#[frame(arm: rotate_z(a))]
#[define(point(k) = [k*l, 0, 0])]
#[define(speed(k) = express(velocity(arm, point(k)), fixed))]
#[lagrangian(m/2*dot(speed(2), speed(2)))]
#[observable(tip = speed(1))]
struct Arm {
    m: f64,
    l: f64,
}

#[test]
fn functions_may_contain_those_of_frames() {
    let (arm, state) = (Arm { m: 1.0, l: 0.5 }, State::new([core::f64::consts::FRAC_PI_2], [3.0]));
    assert_eq!(arm.mass_matrix(&state)[(0, 0)], 1.0);
    let tip = arm.tip(&state);
    assert!((tip[0] + 1.5).abs() < 1e-15 && tip[1].abs() < 1e-15, "{tip}");
}
