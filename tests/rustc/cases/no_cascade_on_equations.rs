use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - k*x)]
struct System {
    m: f64,
}

const TEXT: lagrange_core::facts::Equations = System::equations();

fn main() {
    println!("{} {} {TEXT}", System::equations(), System::equations().latex());
}
