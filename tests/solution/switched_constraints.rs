//! Constraints that a field switches on and off: one struct, in the place of one for each set of constraints.

// What helps tests may panic as they do.
#![allow(clippy::unwrap_used)]

use approx::assert_relative_eq;
use lagrange_core::prelude::*;

/// A cart that a hand holds or lets go, with a bob on a rod.
macro_rules! cart {
    ($name:ident { $($held:ident)? } $(#[$hand:meta])?) => {
        #[derive(Clone, Lagrangian)]
        #[coordinates(x, u, w)]
        #[lagrangian(cart/2 * x_dot^2 + bob/2 * (u_dot^2 + w_dot^2) - bob*g*w - k/2 * x^2)]
        #[constraint(rod: (u - x)^2 + w^2 = l^2)]
        $(#[$hand])?
        #[allow(dead_code, reason = "who holds no cart needs no place")]
        pub(crate) struct $name {
            cart: f64,
            bob: f64,
            g: f64,
            k: f64,
            l: f64,
            place: f64,
            $(pub(crate) $held: bool,)?
        }

        impl $name {
            pub(crate) fn new($($held: bool)?) -> Self {
                Self { cart: 2.0, bob: 0.5, g: 9.81, k: 3.0, l: 0.8, place: 0.1, $($held)? }
            }
        }
    };
}

cart!(Cart { held } #[constraint(hand: x = place, when: held)]);
cart!(Held {} #[constraint(hand: x = place)]);
cart!(Free {});

pub(crate) fn start() -> State<f64, 3> {
    State::at_rest([0.1, 0.1 + 0.8 * 0.6, -0.8 * 0.8])
}

#[test]
fn each_state_of_the_switch_is_the_system_written_for_it() {
    let (on, off) = (Cart::new(true), Cart::new(false));
    let state = start();
    let (found, expected) = (on.solve(&state).unwrap(), Held::new().solve(&state).unwrap());
    assert_relative_eq!(found.accelerations, expected.accelerations, epsilon = 1e-14);
    assert_relative_eq!(found.multipliers, expected.multipliers, epsilon = 1e-14);
    let (found, expected) = (off.solve(&state).unwrap(), Free::new().solve(&state).unwrap());
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
        let (cart, state) = (Cart::new(held), start());
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

/// A chain whose velocities share partial sums, which the derive rewrites: the switch goes along.
#[test]
fn a_switch_in_a_chain_is_that_of_its_constraint() {
    macro_rules! chain {
        ($name:ident { $($locked:ident)? } #[$lock:meta]) => {
            #[derive(Clone, Lagrangian)]
            #[coordinates(theta: [3])]
            #[define(v[i in 0..3] = sum(j in 0..i + 1, l*theta_dot[j]*cos(theta[j])))]
            #[define(w[i in 0..3] = sum(j in 0..i + 1, l*theta_dot[j]*sin(theta[j])))]
            #[lagrangian(sum(i in 0..3, m/2 * (v[i]^2 + w[i]^2)) + m*g*l*sum(i in 0..3, (3 - i)*cos(theta[i])))]
            #[$lock]
            struct $name {
                m: f64,
                l: f64,
                g: f64,
                $($locked: bool,)?
            }
        };
    }
    chain!(Chain { locked } #[constraint(lock: theta[1] = theta[0], when: locked)]);
    chain!(Locked {} #[constraint(lock: theta[1] = theta[0])]);
    let state = State::new([0.3, 0.3, -0.8], [0.5, 0.5, -1.0]);
    let expected = Locked { m: 1.3, l: 0.7, g: 9.81 }.solve(&state).unwrap();
    let found = Chain { m: 1.3, l: 0.7, g: 9.81, locked: true }.solve(&state).unwrap();
    assert_relative_eq!(found.accelerations, expected.accelerations, epsilon = 1e-12);
    assert_relative_eq!(found.multipliers, expected.multipliers, epsilon = 1e-12);
    assert_eq!(Chain { m: 1.3, l: 0.7, g: 9.81, locked: false }.solve(&state).unwrap().multipliers[0], 0.0);
}
