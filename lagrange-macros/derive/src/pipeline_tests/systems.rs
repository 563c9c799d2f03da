//! Systems for the tests, as users would write them.

/// A planar pendulum.
pub(super) const PENDULUM: &str = "
    #[coordinates(theta)]
    #[lagrangian(m*l^2/2 * theta_dot^2 + m*g*l*cos(theta))]
    struct Pendulum { m: f64, l: f64, g: f64 }
";

/// A sphere that rolls down an incline, with a definition, a velocity constraint and an observable.
pub(super) const SPHERE: &str = "
    #[coordinates(x, phi)]
    #[define(inertia = 2/5 * m * a^2)]
    #[lagrangian(m/2 * x_dot^2 + inertia/2 * phi_dot^2 + m*g*x*sin(alpha))]
    #[constraint(no_slip: x_dot - a*phi_dot = 0)]
    #[observable(friction = lambda(no_slip))]
    struct RollingSphere { m: f64, a: f64, g: f64, alpha: f64 }
";

/// A planar chain of `n` links in absolute angles. Each position is the one before plus a link.
pub(super) fn chain(n: usize) -> String {
    format!(
        "#[coordinates(theta: [{n}])]
         #[define(vx[0] = l[0]*cos(theta[0])*theta_dot[0])]
         #[define(vx[i in 1..{n}] = vx[i-1] + l[i]*cos(theta[i])*theta_dot[i])]
         #[define(vy[0] = l[0]*sin(theta[0])*theta_dot[0])]
         #[define(vy[i in 1..{n}] = vy[i-1] + l[i]*sin(theta[i])*theta_dot[i])]
         #[define(y[0] = -l[0]*cos(theta[0]))]
         #[define(y[i in 1..{n}] = y[i-1] - l[i]*cos(theta[i]))]
         #[lagrangian(sum(i in 0..{n}, m[i]/2*(vx[i]^2 + vy[i]^2) - m[i]*g*y[i]))]
         struct Chain {{ m: [f64; {n}], l: [f64; {n}], g: f64 }}"
    )
}

/// The same chain in Cartesian coordinates, with rigid rods as constraints.
pub(super) fn rods(n: usize) -> String {
    format!(
        "#[coordinates(x: [{n}], y: [{n}])]
         #[lagrangian(sum(i in 0..{n}, m[i]/2*(x_dot[i]^2 + y_dot[i]^2) - m[i]*g*y[i]))]
         #[constraint(rod[0]: x[0]^2 + y[0]^2 - l[0]^2 = 0)]
         #[constraint(rod[i in 1..{n}]: (x[i]-x[i-1])^2 + (y[i]-y[i-1])^2 - l[i]^2 = 0)]
         struct Rods {{ m: [f64; {n}], l: [f64; {n}], g: f64 }}"
    )
}

/// `n` windows of four bars side by side. M couples neighbouring corners, so its inverse is dense.
pub(super) fn windows(n: usize) -> String {
    let corners = n + 1;
    format!(
        "#[coordinates(b: [{corners}, 2])]
         #[lagrangian(sum(i in 0..{corners}, dot(b_dot[i], b_dot[i])/6 - g*b[i][1]/2)
             + sum(i in 0..{n}, dot(b_dot[i] + b_dot[i+1], b_dot[i] + b_dot[i+1])/6))]
         #[constraint(vertical[i in 0..{corners}]: (b[i][0] - i)^2 + b[i][1]^2 - 1 = 0)]
         #[constraint(coupler[i in 0..{n}]: dot(b[i+1] - b[i], b[i+1] - b[i]) - 1 = 0)]
         struct Windows {{ g: f64 }}"
    )
}

/// A heavy top with a unit quaternion as orientation: M is singular.
pub(super) const TOP: &str = "
    #[coordinates(q: [4])]
    #[define(w = quat_rate_body(q, q_dot))]
    #[lagrangian((J[0]*w[0]^2 + J[1]*w[1]^2 + J[2]*w[2]^2)/2 - m*g*l*quat_rotate(q, [0, 0, 1])[2])]
    #[constraint(unit: (dot(q, q) - 1)/2 = 0)]
    struct Top { J: [f64; 3], m: f64, g: f64, l: f64 }
";
