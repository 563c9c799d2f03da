#[coordinates(x, x, pi, r: [0])]
#[define(a = b)] #[define(f(s) = f(s))]
#[lagrangian(x_dot^2 + y + (1/0)*r)]
#[constraint(c: r = [x, 1])]
#[force(y: x)]
struct Sides { m: f64, x: f64 }
