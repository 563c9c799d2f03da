//! What cannot be combined in a motion.

use lagrange_core::prelude::*;

#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - k/2 * x^2)]
struct Spring {
    k: f64,
}

fn main() -> Result<(), Error> {
    let (spring, start) = (Spring { k: 1.0 }, State::at_rest([1.0]));
    // Between the steps of a motion that is stored there would be other parameters.
    let _: Trajectory<_> = spring.motion(start).controlled(0.1, |_, _| Ok::<_, Error>(())).to(1.0)?;
    // Derivatives know nothing of a controller.
    let derivatives = spring.sensitivity(&start, &["x"])?;
    spring.motion_with_derivatives(&derivatives).controlled(0.1, |_, _| Ok::<_, Error>(())).to(1.0)?;
    // An event that has no derivative.
    spring.motion_with_derivatives(&derivatives).event(spring.event("zero", |s| s.coordinate("x"))).to(1.0)?;
    // Taylor's series are those of Lagrange's equations.
    spring.motion_in_momenta(PhaseState::new([1.0], [0.0])).by(Taylor::default()).every(0.1).to(1.0)?;
    // The number type is no parameter.
    spring.motion_with_derivatives(&derivatives).by(Taylor::default()).to(1.0)?;
    Ok(())
}
