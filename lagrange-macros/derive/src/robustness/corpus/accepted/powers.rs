#[coordinates(x, phi, r: [2])]
#[lagrangian(m/2 * x_dot^2 + m/2 * a^2 * phi_dot^2 + m/2 * dot(r_dot, r_dot) - c * (x^2 + phi^2)^1000000)]
#[constraint(no_slip: a * x^170141183460469231731687303715884105727 * x_dot - phi_dot = 0)]
#[force(x: c * (sin(x/2) * cos(x/2))^200)]
#[force(phi: c * sin(x) * cos(phi)/3 + 170141183460469231731687303715884105727 * c * cos(x) * sin(phi))]
#[force(r: c * r / dot(r, r)^170141183460469231731687303715884105727)]
#[power(c * x_dot^170141183460469231731687303715884105727 * phi_dot^170141183460469231731687303715884105727 + c * x_dot^5, x_dot)]
#[dissipation(c/2 * (x_dot^170141183460469231731687303715884105727 + x_dot^2))]
struct Powers { m: f64, a: f64, c: f64 }
