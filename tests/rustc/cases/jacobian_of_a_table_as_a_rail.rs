use lagrange_core::function::Table;
use lagrange_core::prelude::*;

/// The rail needs second derivatives for the motion, and third ones for its Jacobian.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[function(height(x) = rail)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - g*y)]
#[constraint(on_the_rail: y = height(x))]
struct Bead {
    g: f64,
    rail: Table,
}

fn jacobian_of<L>(system: &L)
where
    L: Linearized,
{
    let _ = system.parameters();
}

fn roll(bead: &Bead) -> Result<(), Error> {
    let state = State::at_rest([0.0, 0.0]);
    bead.solve(&state)?;
    bead.jacobian(&state)?;
    jacobian_of(bead);
    Ok(())
}

fn main() {}
