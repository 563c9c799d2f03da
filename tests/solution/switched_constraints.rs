//! Constraints that a field switches on and off: one struct, in the place of one for each set of constraints.

// What helps tests may panic as they do.
#![allow(clippy::unwrap_used)]

use approx::assert_relative_eq;
use lagrange_core::{Method, prelude::*};

/// A cart that a hand holds or lets go, with a bob on a rod.
#[derive(Clone, Lagrangian)]
#[coordinates(x, u, w)]
#[lagrangian(cart/2 * x_dot^2 + bob/2 * (u_dot^2 + w_dot^2) - bob*g*w - k/2 * x^2)]
#[constraint(rod: (u - x)^2 + w^2 = l^2)]
#[constraint(hand: x = place, when: held)]
struct Cart {
    cart: f64,
    bob: f64,
    g: f64,
    k: f64,
    l: f64,
    place: f64,
    held: bool,
}

/// The same, always held.
#[derive(Clone, Lagrangian)]
#[coordinates(x, u, w)]
#[lagrangian(cart/2 * x_dot^2 + bob/2 * (u_dot^2 + w_dot^2) - bob*g*w - k/2 * x^2)]
#[constraint(rod: (u - x)^2 + w^2 = l^2)]
#[constraint(hand: x = place)]
struct Held {
    cart: f64,
    bob: f64,
    g: f64,
    k: f64,
    l: f64,
    place: f64,
}

/// The same, let go.
#[derive(Clone, Lagrangian)]
#[coordinates(x, u, w)]
#[lagrangian(cart/2 * x_dot^2 + bob/2 * (u_dot^2 + w_dot^2) - bob*g*w - k/2 * x^2)]
#[constraint(rod: (u - x)^2 + w^2 = l^2)]
struct Free {
    cart: f64,
    bob: f64,
    g: f64,
    k: f64,
    l: f64,
}

const CART: Cart = Cart { cart: 2.0, bob: 0.5, g: 9.81, k: 3.0, l: 0.8, place: 0.1, held: true };
const HELD: Held = Held { cart: 2.0, bob: 0.5, g: 9.81, k: 3.0, l: 0.8, place: 0.1 };
const FREE: Free = Free { cart: 2.0, bob: 0.5, g: 9.81, k: 3.0, l: 0.8 };

fn start() -> State<f64, 3> {
    State::at_rest([0.1, 0.1 + 0.8 * 0.6, -0.8 * 0.8])
}

#[test]
fn each_state_of_the_switch_is_the_system_written_for_it() {
    let (on, off) = (CART, Cart { held: false, ..CART });
    let state = start();
    let (found, expected) = (on.solve(&state).unwrap(), HELD.solve(&state).unwrap());
    assert_relative_eq!(found.accelerations, expected.accelerations, epsilon = 1e-14);
    assert_relative_eq!(found.multipliers, expected.multipliers, epsilon = 1e-14);
    let (found, expected) = (off.solve(&state).unwrap(), FREE.solve(&state).unwrap());
    assert_relative_eq!(found.accelerations, expected.accelerations, epsilon = 1e-14);
    assert_relative_eq!(found.multipliers[0], expected.multipliers[0], epsilon = 1e-14);
    assert_eq!(found.multipliers[1], 0.0);
    // No general solver is needed: the rank is that of the elimination, and the pivots are good.
    assert!(off.accelerations_unchecked(&state).pivot > 0.1);
}

/// F and its transpose agree in every function, for multipliers that are not those of a solution too.
#[test]
fn a_constraint_that_is_off_has_no_force() {
    let multipliers = [0.7, -1.3].into();
    for held in [true, false] {
        let (cart, state) = (Cart { held, ..CART }, start());
        let expected = cart.constraint_jacobian(&state).tr_mul(&multipliers);
        assert_relative_eq!(cart.constraint_force(&state, &multipliers), expected, epsilon = 1e-15);
        let zero = [0.0; 3].into();
        let balance = cart.inverse_dynamics(&state, &zero, &multipliers);
        assert_relative_eq!(balance, -(cart.forcing(&state) + expected), epsilon = 1e-14);
        assert_eq!(expected[0] == -2.0 * 0.48 * 0.7, !held);
    }
    assert!(Cart::equations().text().contains("λ_hand"), "{}", Cart::equations().text());
    assert!(!Cart::equations().text().contains("held λ"), "{}", Cart::equations().text());
}

/// Compares where a method ends, on and off.
fn compare<P>(method: P)
where
    P: Method<Cart> + Method<Held> + Method<Free> + Clone,
{
    let (on, off) = (CART, Cart { held: false, ..CART });
    let ends = |found: State<f64, 3>, expected: State<f64, 3>| {
        assert_relative_eq!(found.q, expected.q, epsilon = 1e-10);
        assert_relative_eq!(found.v, expected.v, epsilon = 1e-10);
    };
    let found = *on.integrate(start(), 1.0, method.clone()).unwrap().end().state();
    ends(found, *HELD.integrate(start(), 1.0, method.clone()).unwrap().end().state());
    let found = *off.integrate(start(), 1.0, method.clone()).unwrap().end().state();
    ends(found, *FREE.integrate(start(), 1.0, method).unwrap().end().state());
}

#[test]
fn every_method_takes_switches() {
    compare(Dop853::with_tolerance(1e-10));
    compare(Taylor::default());
    compare(RungeKutta4::with_step(0.01));
    compare(Verlet::with_step(0.01));
    compare(Lobatto::<3>::with_step(0.01));
    compare(DAlembert::with_step(0.01));
    compare(Radau::with_tolerance(1e-10));
}

/// A chain whose velocities share partial sums, which the derive rewrites: the switch goes along.
#[test]
fn a_switch_in_a_chain_is_that_of_its_constraint() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(theta: [3])]
    #[define(v[i in 0..3] = sum(j in 0..i + 1, l*theta_dot[j]*cos(theta[j])))]
    #[define(w[i in 0..3] = sum(j in 0..i + 1, l*theta_dot[j]*sin(theta[j])))]
    #[lagrangian(sum(i in 0..3, m/2 * (v[i]^2 + w[i]^2)) + m*g*l*sum(i in 0..3, (3 - i)*cos(theta[i])))]
    #[constraint(lock: theta[1] = theta[0], when: locked)]
    struct Chain {
        m: f64,
        l: f64,
        g: f64,
        locked: bool,
    }
    #[derive(Clone, Lagrangian)]
    #[coordinates(theta: [3])]
    #[define(v[i in 0..3] = sum(j in 0..i + 1, l*theta_dot[j]*cos(theta[j])))]
    #[define(w[i in 0..3] = sum(j in 0..i + 1, l*theta_dot[j]*sin(theta[j])))]
    #[lagrangian(sum(i in 0..3, m/2 * (v[i]^2 + w[i]^2)) + m*g*l*sum(i in 0..3, (3 - i)*cos(theta[i])))]
    #[constraint(lock: theta[1] = theta[0])]
    struct Locked {
        m: f64,
        l: f64,
        g: f64,
    }
    let state = State::new([0.3, 0.3, -0.8], [0.5, 0.5, -1.0]);
    let expected = Locked { m: 1.3, l: 0.7, g: 9.81 }.solve(&state).unwrap();
    let found = Chain { m: 1.3, l: 0.7, g: 9.81, locked: true }.solve(&state).unwrap();
    assert_relative_eq!(found.accelerations, expected.accelerations, epsilon = 1e-12);
    assert_relative_eq!(found.multipliers, expected.multipliers, epsilon = 1e-12);
    assert_eq!(Chain { m: 1.3, l: 0.7, g: 9.81, locked: false }.solve(&state).unwrap().multipliers[0], 0.0);
}
