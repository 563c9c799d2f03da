#[coordinates(x, phi)]
#[define(inertia = 2/5 * m * a^2)]
#[lagrangian(m/2 * x_dot^2 + inertia/2 * phi_dot^2 + m*9.81*x*sin(alpha))]
#[constraint(no_slip: x_dot - a*phi_dot = 0)]
#[dissipation(c/2 * x_dot^2)]
#[observable(friction = lambda(no_slip))]
#[observable(push = m*x_ddot - der(x_dot))]
struct Sphere { m: f64, a: f64, c: f64, alpha: f64 }
