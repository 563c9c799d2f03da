#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/(2*x^0.5) - sqrt(x*y)^3 + x^y * ln(x) - tanh(1e-3 * x))]
#[conserved(e = (x_dot^2 + y_dot^2)/(2*x^0.5) + sqrt(x*y)^3 - x^y * ln(x) + tanh(1e-3 * x))]
struct Odd<'a> { t: String, other: &'a [u8] }
