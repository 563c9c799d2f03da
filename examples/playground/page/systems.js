// Systems to begin with.

function systemToBegin(key, title, text, parameters, start, end = 10, joined = true) {
  return { key, title, set: { text: text.trim(), parameters, start, method: "Dop853", end, joined } };
}

const SYSTEMS = [
  systemToBegin("pendulum", "Pendulum", `
#[coordinates(theta)]
#[lagrangian(m/2 * l^2 * theta_dot^2 + m*g*l*cos(theta))]
#[observable(bob = [l*sin(theta), -l*cos(theta)])]
struct Pendulum { m: f64, l: f64, g: f64 }`, { m: 1, l: 1, g: 9.81 }, { theta: [2, 0] }),
  systemToBegin("double-pendulum", "Double pendulum", `
#[coordinates(theta1, theta2)]
#[define(r1 = [l1*sin(theta1), -l1*cos(theta1)])]
#[define(r2 = r1 + [l2*sin(theta2), -l2*cos(theta2)])]
#[lagrangian(m1/2*dot(der(r1), der(r1)) + m2/2*dot(der(r2), der(r2))
    - m1*g*r1[1] - m2*g*r2[1])]
#[observable(upper = r1)]
#[observable(lower = r2)]
struct DoublePendulum { m1: f64, m2: f64, l1: f64, l2: f64, g: f64 }`,
    { m1: 1, m2: 1, l1: 1, l2: 1, g: 9.81 }, { theta1: [2, 0], theta2: [1, 0] }, 20),
  systemToBegin("spring-pendulum", "Spring pendulum", `
#[coordinates(x, y)]
#[define(stretch = sqrt(x^2 + y^2) - l)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y - k/2*stretch^2)]
struct SpringPendulum { m: f64, g: f64, k: f64, l: f64 }`, { m: 1, g: 9.81, k: 40, l: 1 }, { x: [0.8, 0], y: [-0.9, 0] }),
  systemToBegin("spherical-pendulum", "Spherical pendulum, on a rod", `
#[coordinates(x, y, z)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2 + z_dot^2) - m*g*z)]
#[constraint(rod: x^2 + y^2 + z^2 = l^2)]
#[observable(tension = 2*l*lambda(rod))]
struct Spherical { m: f64, g: f64, l: f64 }`, { m: 1, g: 9.81, l: 1 }, { x: [0.8, 0], y: [0, 1.2], z: [-0.6, 0] }),
  systemToBegin("bead", "Bead on a turning hoop", `
#[coordinates(theta)]
#[lagrangian(m*r^2/2*(theta_dot^2 + omega^2*sin(theta)^2) + m*g*r*cos(theta))]
#[observable(bead = [r*sin(theta), -r*cos(theta)])]
struct Bead { m: f64, r: f64, g: f64, omega: f64 }`, { m: 1, r: 1, g: 9.81, omega: 4 }, { theta: [0.1, 0] }),
  systemToBegin("planet", "Planet", `
#[coordinates(r, phi)]
#[lagrangian(m/2*(r_dot^2 + r^2*phi_dot^2) + k/r)]
#[observable(place = [r*cos(phi), r*sin(phi)])]
struct Planet { m: f64, k: f64 }`, { m: 1, k: 1 }, { r: [1, 0], phi: [0, 1.25] }, 30, false),
  systemToBegin("three-bodies", "Three bodies on an eight", `
#[coordinates(r: [3, 2])]
#[lagrangian(sum(i in 0..3, m/2*dot(r_dot[i], r_dot[i])
    + sum(j in 0..i, G*m^2/norm(r[i] - r[j]))))]
struct ThreeBodies { m: f64, G: f64 }`, { m: 1, G: 1 }, {
      "r[0][0]": [0.97000436, 0.466203685], "r[0][1]": [-0.24308753, 0.43236573],
      "r[1][0]": [-0.97000436, 0.466203685], "r[1][1]": [0.24308753, 0.43236573],
      "r[2][0]": [0, -0.93240737], "r[2][1]": [0, -0.86473146],
    }, 12.65, false),
  systemToBegin("henon-heiles", "Hénon and Heiles", `
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - (x^2 + y^2)/2 - x^2*y + y^3/3)]
struct HenonHeiles;`, {}, { x: [0, 0.45], y: [0.2, 0.1] }, 100, false),
  systemToBegin("rods", "Chain of five rods", `
#[coordinates(r: [5, 2])]
#[lagrangian(sum(i in 0..5, m/2*dot(r_dot[i], r_dot[i]) - m*g*r[i][1]))]
#[constraint(first: dot(r[0], r[0]) = l^2)]
#[constraint(rod[i in 1..5]: dot(r[i] - r[i-1], r[i] - r[i-1]) = l^2)]
struct Rods { m: f64, g: f64, l: f64 }`, { m: 1, g: 9.81, l: 0.4 },
    Object.fromEntries([0, 1, 2, 3, 4].flatMap(i => [[`r[${i}][0]`, [+(0.4 * (i + 1)).toFixed(1), 0]], [`r[${i}][1]`, [0, 0]]]))),
  systemToBegin("sleigh", "Chaplygin's sleigh", `
#[coordinates(x, y, theta)]
#[define(centre = [x + a*cos(theta), y + a*sin(theta)])]
#[lagrangian(m/2*dot(der(centre), der(centre)) + j/2*theta_dot^2)]
#[constraint(blade: y_dot*cos(theta) - x_dot*sin(theta) = 0)]
#[observable(edge = [x, y])]
#[observable(middle = centre)]
struct Sleigh { m: f64, a: f64, j: f64 }`, { m: 1, a: 0.5, j: 0.3 }, { x: [0, 0.6], y: [0, 0], theta: [0, 2] }, 10, false),
  systemToBegin("cart-pole", "Cart with a pole", `
#[coordinates(x, theta)]
#[define(tip = [x + l*sin(theta), l*cos(theta)])]
#[lagrangian(big/2*x_dot^2 + m/2*dot(der(tip), der(tip)) - m*g*tip[1])]
#[dissipation(c/2*x_dot^2)]
#[observable(cart = [x, 0])]
#[observable(top = tip)]
struct CartPole { big: f64, m: f64, l: f64, g: f64, c: f64 }`, { big: 2, m: 1, l: 1, g: 9.81, c: 0.5 }, { x: [0, 0], theta: [0.1, 0] }, 15, false),
  systemToBegin("heavy-top", "Heavy top", `
#[coordinates(phi, theta, psi)]
#[lagrangian(i1/2*(theta_dot^2 + phi_dot^2*sin(theta)^2)
    + i3/2*(psi_dot + phi_dot*cos(theta))^2 - m*g*l*cos(theta))]
#[observable(axis = l*[sin(theta)*sin(phi), -sin(theta)*cos(phi), cos(theta)])]
struct Top { i1: f64, i3: f64, m: f64, g: f64, l: f64 }`, { i1: 1, i3: 0.5, m: 1, g: 9.81, l: 1 }, { phi: [0, 0], theta: [0.6, 0], psi: [0, 20] }),
];
