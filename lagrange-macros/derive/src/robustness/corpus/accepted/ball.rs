#[coordinates(r: [3])]
#[define(U(s) = k/norm(s) + exp(-abs(s[0])))]
#[lagrangian(m/2 * dot(r_dot, r_dot) - U(r) + dot(omega, cross(r, A * r_dot)))]
#[constraint(ball: dot(r, r)/2 = 1/2)]
#[force(r: [0, -1, t])]
#[force(r[1]: -2^-1 * r_dot[1])]
#[parameter(k: 0..1_000)]
#[lagrange(crate = lagrange_core, scalar = f64)]
struct Ball { m: f64, k: f64, omega: [f64; 3], A: Matrix3<f64> }
