//! Forces that act only where no random state lies.

use lagrange_core::prelude::*;

use super::balance::check_rate;

/// A cart that a bumper or a wall slows down beyond x = 100, where no random state lies.
macro_rules! cart {
    ($name:ident, $along:literal, $($force:tt)*) => {
        #[derive(Clone, Lagrangian)]
        #[coordinates(x, y)]
        #[lagrangian((x_dot^2 + y_dot^2)/2)]
        #[constraint(rail: y = $along*x)]
        #[force(x: $($force)*)]
        struct $name;
    };
}
cart!(Ramp, 0.5, -max(x - 100, 0) * x_dot);
cart!(Level, 0, -max(x - 100, 0) * x_dot);
cart!(Magnitude, 0.5, -(abs(x - 100) + x - 100) * x_dot / 2);
cart!(Late, 0.5, -max(t - 100, 0) * x_dot);
cart!(Wall, 0.5, -exp(1000 * (x - 101)) * x_dot);
cart!(Root, 0.5, -(sqrt((x - 100) ^ 2) + x - 100) * x_dot / 2);

/// At all random states the force is zero, or underflows to zero.
#[test]
fn forces_that_random_states_do_not_see_are_not_taken_for_zero() {
    let beyond = State::new([101.0, 50.5], [2.0, 1.0]).at_time(101.0);
    check_rate(&Ramp, beyond, 1e-8);
    check_rate(&Level, State::new([101.0, 0.0], [2.0, 0.0]), 1e-8);
    check_rate(&Magnitude, beyond, 1e-8);
    check_rate(&Late, beyond, 1e-8);
    check_rate(&Root, beyond, 1e-8);
    check_rate(&Wall, beyond, 1e-8);
    for facts in [Ramp::FACTS, Level::FACTS, Magnitude::FACTS, Late::FACTS, Root::FACTS, Wall::FACTS] {
        assert!(facts.conserved.iter().all(|found| found.name == "p_y"), "{facts:?}");
    }
}
