//! A long system of unlike links: every function that is emitted, against the equations of Newton and Euler from link to link. `.ci/long`
//! makes 200 others.

mod drive;
mod system;

use drive::{drive, jacobians};

#[test]
fn a_long_system_moves_as_newton_and_euler_say() -> Result<(), String> {
    system::check()
}
