//! Systems that are derived at compile time, with their text: each feature of the language that the interpreter has, alone and with others.

systems! {
    #[coordinates(x)]
    #[lagrangian(m*x_dot^2/2 - k*abs(x)^3 - a*exp(-b*x^2) + ln(1 + x^2))]
    struct Functions { m: f64, k: f64, a: f64, b: f64 }

    #[coordinates(x)]
    #[lagrangian(m*x_dot^2/2 - k*cosh(x) - a*sinh(x/2) - b*tanh(x) - tan(x/4))]
    struct Hyperbolic { m: f64, k: f64, a: f64, b: f64 }

    #[coordinates(x)]
    #[lagrangian(x_dot^2/2 + a*asin(x/4) + b*acos(x/5) + c*atan(x))]
    struct Inverse { a: f64, b: f64, c: f64 }

    #[coordinates(x, y)]
    #[lagrangian(x_dot^2/2 + y_dot^2/2 - k*atan2(y, 3 + x)^2 - sqrt(1 + x^2 + y^2))]
    struct Angle { k: f64 }

    #[coordinates(x)]
    #[lagrangian(m*x_dot^2/2 - k*(2 + x)^1.5 - (3 + x)^n)]
    struct Powers { m: f64, k: f64, n: f64 }

    #[coordinates(x)]
    #[lagrangian(m*x_dot^2/2 - k*x^2/2)]
    #[force(x: clamp(-c*x_dot, -f, f) + max(0, x) - min(x_dot, 1))]
    struct Limited { m: f64, k: f64, c: f64, f: f64 }

    #[coordinates(x)]
    #[lagrangian(exp(c*t)*(m*x_dot^2/2 - k*x^2/2))]
    struct Caldirola { m: f64, k: f64, c: f64 }

    #[coordinates(x, y)]
    #[lagrangian(m/2*(x_dot^2 + y_dot^2) + b/2*(x*y_dot - y*x_dot) - k/2*(x^2 + y^2))]
    #[dissipation(c/4*(x_dot^2 + y_dot^2)^2)]
    struct Magnetic { m: f64, b: f64, k: f64, c: f64 }

    #[coordinates(x)]
    #[lagrangian(-m*c^2*sqrt(1 - x_dot^2/c^2/9) - k*x^2/2)]
    struct Relativistic { m: f64, c: f64, k: f64 }

    #[coordinates(x, theta)]
    #[define(v = der([x + l*sin(theta), -l*cos(theta)]))]
    #[lagrangian(big/2*x_dot^2 + m/2*dot(v, v) + m*g*l*cos(theta))]
    #[force(x: u - c*x_dot)]
    #[observable(tip = [x + l*sin(theta), -l*cos(theta)])]
    #[observable(pull = x_ddot*big)]
    struct CartPole { big: f64, m: f64, l: f64, g: f64, u: f64, c: f64 }

    #[coordinates(r, theta)]
    #[lagrangian((a + b)*r_dot^2/2 + a*r^2*theta_dot^2/2 - g*r*(b - a*cos(theta)))]
    struct SwingingAtwood { a: f64, b: f64, g: f64 }

    #[coordinates(r, phi)]
    #[lagrangian(m/2*(r_dot^2*(1 + 4*a^2*r^2) + r^2*phi_dot^2) - m*g*a*r^2)]
    struct Paraboloid { m: f64, a: f64, g: f64 }

    #[coordinates(r, phi)]
    #[lagrangian(m/2*(r_dot^2 + r^2*phi_dot^2) + k/r)]
    struct Kepler { m: f64, k: f64 }

    #[coordinates(theta1, theta2, theta3)]
    #[define(v1 = der([l*sin(theta1), -l*cos(theta1)]))]
    #[define(v2 = v1 + der([l*sin(theta2), -l*cos(theta2)]))]
    #[define(v3 = v2 + der([l*sin(theta3), -l*cos(theta3)]))]
    #[lagrangian(m/2*(dot(v1, v1) + dot(v2, v2) + dot(v3, v3)) + m*g*l*(3*cos(theta1) + 2*cos(theta2) + cos(theta3)))]
    struct TriplePendulum { m: f64, l: f64, g: f64 }

    #[coordinates(r: [3])]
    #[lagrangian(m/2*dot(r_dot, r_dot) - m*g*r[2])]
    #[constraint(sphere: norm(r)^2 = l^2)]
    #[observable(tension = 2*l*lambda(sphere))]
    struct BobOnString { m: f64, g: f64, l: f64 }

    #[coordinates(r: [3, 3])]
    #[define(height = sum(i in 0..3, r[i][2]))]
    #[lagrangian(sum(i in 0..3, m[i]/2*dot(r_dot[i], r_dot[i]) - m[i]*g*r[i][2]))]
    #[constraint(first: norm(r[0])^2 = l^2)]
    #[constraint(rod[i in 1..3]: norm(r[i] - r[i-1])^2 = l^2)]
    #[force(r[i in 0..3]: drag*(wind - r_dot[i]))]
    #[force(r[2][2]: pull*cos(omega*t))]
    #[observable(mean_height = height/3)]
    #[observable(push[i in 0..2] = -2*l*lambda(rod[i+1]))]
    struct ThreeRods { m: [f64; 3], l: f64, g: f64, drag: f64, wind: [f64; 3], pull: f64, omega: f64 }

    #[coordinates(x, y)]
    #[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y)]
    #[constraint(rail: y = a*x^2 + b*sin(w*t))]
    struct MovingRail { m: f64, g: f64, a: f64, b: f64, w: f64 }

    #[coordinates(x, phi)]
    #[lagrangian(m/2*x_dot^2 + j/2*phi_dot^2 + m*g*x)]
    #[constraint(no_slip: x_dot - a*phi_dot = 0)]
    struct YoYo { m: f64, j: f64, a: f64, g: f64 }

    #[coordinates(x, y, phi, theta)]
    #[lagrangian(m/2*(x_dot^2 + y_dot^2) + i/2*phi_dot^2 + j/2*theta_dot^2)]
    #[constraint(along: x_dot - a*cos(theta)*phi_dot = 0)]
    #[constraint(across: y_dot - a*sin(theta)*phi_dot = 0)]
    #[force(phi: u)]
    struct UprightDisk { m: f64, i: f64, j: f64, a: f64, u: f64 }

    #[coordinates(x, y, theta, psi)]
    #[lagrangian(m/2*(x_dot^2 + y_dot^2) + i/2*theta_dot^2 + j/2*(theta_dot + psi_dot)^2)]
    #[constraint(rear: -x_dot*sin(theta) + y_dot*cos(theta) - theta_dot = 0)]
    #[constraint(front: -x_dot*sin(theta + psi) + y_dot*cos(theta + psi) - cos(psi)*theta_dot = 0)]
    struct Snakeboard { m: f64, i: f64, j: f64 }

    #[coordinates(a, b, c)]
    #[define(p = [l[0]*cos(a) + l[1]*cos(b) - l[2]*cos(c) - d, l[0]*sin(a) + l[1]*sin(b) - l[2]*sin(c)])]
    #[lagrangian(j[0]/2*a_dot^2 + j[1]/2*b_dot^2 + j[2]/2*c_dot^2 - m*g*(sin(a) + sin(b) + sin(c)))]
    #[constraint(closed: p = [0, 0])]
    struct FourBar { l: [f64; 3], j: [f64; 3], m: f64, g: f64, d: f64 }

    #[coordinates(x, y, z)]
    #[lagrangian(m/2*x_dot^2 - k/2*(z - y)^2 - c/2*x^2)]
    #[constraint(gear: y = 2*x)]
    #[constraint(belt: z = sin(x))]
    struct Massless { m: f64, k: f64, c: f64 }

    #[coordinates(phi, theta, psi)]
    #[define(p = phi_dot*sin(theta)*sin(psi) + theta_dot*cos(psi))]
    #[define(q = phi_dot*sin(theta)*cos(psi) - theta_dot*sin(psi))]
    #[define(r = phi_dot*cos(theta) + psi_dot)]
    #[lagrangian((i[0]*p^2 + i[1]*q^2 + i[2]*r^2)/2 - m*g*l*cos(theta))]
    #[observable(rates = [p, q, r])]
    struct AsymmetricTop { i: [f64; 3], m: f64, g: f64, l: f64 }

    #[coordinates(q: [3])]
    #[frame(rod[0]: rotate_y(q[0]))]
    #[frame(rod[i in 1..3] in rod[i-1]: translate([l, 0, 0]), rotate_y(q[i]))]
    #[define(middle = [l/2, 0, 0])]
    #[define(inertia = [[i, 0, 0], [0, i, 0], [0, 0, i]])]
    #[lagrangian(sum(k in 0..3, kinetic(rod[k], m, middle, inertia) - m*g*position(rod[k], middle)[2]))]
    #[observable(tip = position(rod[2], [l, 0, 0]))]
    struct Arm { m: f64, l: f64, g: f64, i: f64 }

    #[coordinates(r: [3], q: [4])]
    #[frame(body: translate(r), rotate(q))]
    #[define(inertia = [[i[0], 0, 0], [0, i[1], 0], [0, 0, i[2]]])]
    #[lagrangian(kinetic(body, m, [0, 0, 0], inertia) - m*g*r[2] - k*position(body, [1, 0, 0])[1])]
    struct FreeBody { m: f64, g: f64, i: [f64; 3], k: f64 }

    #[coordinates(a, b)]
    #[frame(outer: rotate_z(a), rotate_x(tilt))]
    #[frame(inner in outer: translate([0, l, 0]), rotate_y(b))]
    #[lagrangian(kinetic(outer, m, [0, 0, 0], [[i, 0, 0], [0, 2*i, 0], [0, 0, 3*i]]) + kinetic(inner, m, [0, h, 0], [[i, 0, 0], [0, i, 0], [0, 0, 2*i]]) - m*g*position(inner, [0, 0, h])[2])]
    #[dissipation(c/2*(a_dot^2 + b_dot^2))]
    struct Gimbals { m: f64, i: f64, tilt: f64, l: f64, h: f64, g: f64, c: f64 }

    #[coordinates(x: [4])]
    #[lagrangian(sum(i in 0..4, sum(j in 0..4, M[i][j]*x_dot[i]*x_dot[j]/2)) - k*dot(x, x)/2 + 4*dot(x_dot, x_dot))]
    #[parameter(M: symmetric)]
    #[allow(non_snake_case)]
    struct Coupled { M: [[f64; 4]; 4], k: f64 }

    #[coordinates(x: [6])]
    #[lagrangian(sum(i in 0..6, x_dot[i]^2/2) - sum(i in 0..5, exp(x[i] - x[i+1])))]
    #[conserved(total = sum(i in 0..6, x_dot[i]))]
    struct Toda;

    #[coordinates(r: [5, 2])]
    #[lagrangian(sum(i in 0..5, dot(r_dot[i], r_dot[i])/2 + sum(j in 0..i, e*ln(norm(r[i] - r[j])))))]
    struct Vortices { e: f64 }

    #[coordinates(x: [3, 2])]
    #[lagrangian(sum(i in 0..3, m/2*dot(x_dot[i], x_dot[i])) - sum(i in 0..3, sum(j in 0..i, k/2*(norm(x[i] - x[j]) - l)^2)))]
    struct Springs { m: f64, k: f64, l: f64 }

    #[coordinates(x, y, theta, s)]
    #[define(place = [x + s*cos(theta), y + s*sin(theta)])]
    #[lagrangian(big/2*(x_dot^2 + y_dot^2) + i/2*theta_dot^2 + m/2*dot(der(place), der(place)) - k/2*s^2)]
    #[power([0, u], der(place))]
    struct Slider { big: f64, i: f64, m: f64, k: f64, u: f64 }

    #[coordinates(theta: [10])]
    #[define(vx[0] = l[0]*cos(theta[0])*theta_dot[0])]
    #[define(vx[i in 1..10] = vx[i-1] + l[i]*cos(theta[i])*theta_dot[i])]
    #[define(vy[0] = l[0]*sin(theta[0])*theta_dot[0])]
    #[define(vy[i in 1..10] = vy[i-1] + l[i]*sin(theta[i])*theta_dot[i])]
    #[define(y[0] = -l[0]*cos(theta[0]))]
    #[define(y[i in 1..10] = y[i-1] - l[i]*cos(theta[i]))]
    #[lagrangian(sum(i in 0..10, m[i]/2*(vx[i]^2 + vy[i]^2) - m[i]*g*y[i]))]
    struct ChainOfTen { m: [f64; 10], l: [f64; 10], g: f64 }

    #[coordinates(x: [24])]
    #[lagrangian(sum(i in 0..24, 30*x_dot[i]^2 - x[i]^2 + sum(j in 0..i, cos(x[i] - x[j] + k)*x_dot[i]*x_dot[j])))]
    struct CoupledByAll { k: f64 }

    #[coordinates(r: [8, 2])]
    #[lagrangian(sum(i in 0..8, m/2*dot(r_dot[i], r_dot[i]) - m*g*r[i][1]))]
    #[constraint(first: dot(r[0], r[0]) = l^2)]
    #[constraint(rod[i in 1..8]: dot(r[i] - r[i-1], r[i] - r[i-1]) = l^2)]
    struct EightRods { m: f64, g: f64, l: f64 }

    #[coordinates(x, y)]
    #[lagrangian(a/2*(x_dot^2 + y_dot^2) + b*x_dot*y_dot/3 - (x^4 + y^4)/4 - k*x^2*y^2)]
    struct Quartic { a: f64, b: f64, k: f64 }

    #[coordinates(x)]
    #[lagrangian(m*x_dot^2/2 - k*x^2/2)]
    #[dissipation(c/2*x_dot^2)]
    #[force(x: f*sin(w*t) + a*x_dot^3)]
    #[observable(power = f*sin(w*t)*x_dot)]
    struct VanDerPol { m: f64, k: f64, c: f64, f: f64, w: f64, a: f64 }

    #[coordinates(theta, phi)]
    #[lagrangian(m*l^2/2*(theta_dot^2 + (phi_dot + w)^2*sin(theta)^2) + m*g*l*cos(theta))]
    struct SphericalInRotation { m: f64, l: f64, w: f64, g: f64 }

    #[coordinates(q, i)]
    #[lagrangian(l1/2*q_dot^2 + l2/2*i_dot^2 + m12/3*q_dot*i_dot - q^2/(2*c1) - i^2/(2*c2))]
    #[dissipation(r/2*q_dot^2)]
    #[force(q: v*cos(w*t))]
    struct Circuit { l1: f64, l2: f64, m12: f64, c1: f64, c2: f64, r: f64, v: f64, w: f64 }

    #[coordinates(x, y, z)]
    #[lagrangian(m/2*(x_dot^2 + y_dot^2 + z_dot^2) - m*g*z)]
    #[constraint(wire: [x - a*cos(z), y - a*sin(z)] = [0, 0])]
    struct Helix { m: f64, g: f64, a: f64 }

    #[coordinates(theta)]
    #[lagrangian(m/2*l^2*theta_dot^2 + m*(g - a*w^2*cos(w*t))*l*cos(theta))]
    struct Kapitza { m: f64, l: f64, g: f64, a: f64, w: f64 }

    #[coordinates(x)]
    #[lagrangian(m[1][0]*x_dot^2/2 - m[0][1]*x^2)]
    struct TwoOfFour { m: [[f64; 2]; 2] }
}
