//! Friction: the equations of each state against systems written by hand, and motions against closed solutions.

use lagrange_core::contact::{Contact, Friction, Transition};
use lagrange_core::prelude::*;

/// A block on a floor, pulled along it.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
#[force(x: pull)]
#[contact(floor: y >= 0, friction(mu): x_dot)]
#[observable(drag = lambda(floor_friction))]
struct Block {
    m: f64,
    g: f64,
    mu: f64,
    pull: f64,
    floor: Contact,
}

fn block(floor: Contact) -> Block {
    Block { m: 2.0, g: 10.0, mu: 0.3, pull: 1.0, floor }
}

#[test]
fn a_block_is_free_or_sticks_or_slides() {
    let state = State::new([0.5, 0.0], [0.0, 0.0]);
    for (floor, accelerations, multipliers) in [
        (Contact::Open, [0.5, -10.0], [0.0, 0.0]),
        (Contact::Closed, [0.0, 0.0], [20.0, -1.0]),
        (Contact::Slides([1.0, 0.0]), [-2.5, 0.0], [20.0, -6.0]),
        (Contact::Slides([-1.0, 0.0]), [3.5, 0.0], [20.0, 6.0]),
    ] {
        let solution = block(floor).solve(&state).expect("it moves");
        assert_eq!(solution.accelerations.as_slice(), accelerations, "{floor:?}");
        assert_eq!(solution.multipliers.as_slice(), multipliers, "{floor:?}");
    }
}

/// The block thrown along the floor slides for v/(μ g), and stops.
#[test]
fn a_block_that_slides_stops() {
    let mut thrown = block(Contact::Closed);
    thrown.pull = 0.0;
    let path = thrown.motion(State::new([0.0; 2], [3.0, 0.0])).with_contacts().to(2.0).unwrap();
    let [Transition::Sticks { time, .. }] = path.transitions() else { panic!("{:?}", path.transitions()) };
    assert!((time - 1.0).abs() < 1e-14, "{time}");
    assert!((path.end().q[0] - 1.5).abs() < 1e-14, "{:?}", path.end());
    assert_eq!(path.end().v[0], 0.0);
}

/// A sphere thrown on a floor slides until v = 5/7 v₀, at the time 2/7 v₀/(μ g), and rolls (Milton 8.8; any textbook).
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, phi)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*r^2/5 * phi_dot^2 - m*g*y)]
#[contact(floor: y - r >= 0, friction(mu): x_dot - r*phi_dot)]
struct Sphere {
    m: f64,
    g: f64,
    r: f64,
    mu: f64,
    floor: Contact,
}

#[test]
fn a_sphere_thrown_on_a_floor_slides_and_then_rolls() {
    let sphere = Sphere { m: 0.4, g: 9.81, r: 0.3, mu: 0.25, floor: Contact::Closed };
    for (speed, by_radau) in [(2.0, false), (-2.0, false), (2.0, true)] {
        let start = State::new([0.0, 0.3, 0.0], [speed, 0.0, 0.0]);
        let motion = sphere.motion(start);
        let path = match by_radau {
            true => motion.by(Radau::with_tolerance(1e-12).stages::<5>()).with_contacts().to(1.0).unwrap(),
            false => motion.with_contacts().to(1.0).unwrap(),
        };
        let [Transition::Sticks { time, .. }] = path.transitions() else {
            panic!("{:?}", path.transitions())
        };
        assert!((time - 2.0 / 7.0 * 2.0 / (0.25 * 9.81)).abs() < 1e-13, "{time}");
        let v = path.end().v;
        assert!((v[0] - 5.0 / 7.0 * speed).abs() < 1e-13 && (v[2] * 0.3 - v[0]).abs() < 1e-14, "{v:?}");
    }
}

/// A block on a belt, held by a spring (den Hartog 1931): it sticks until k x = the limit, and slides with the lower force of
/// sliding until it has the speed of the belt again.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - k/2 * x^2)]
#[friction(belt: x_dot - speed, limit: hold, sliding: pull)]
struct StickSlip {
    m: f64,
    k: f64,
    speed: f64,
    hold: f64,
    pull: f64,
    belt: Friction,
}

#[test]
fn a_block_on_a_belt_sticks_and_slips() {
    let system = StickSlip { m: 1.0, k: 4.0, speed: 0.2, hold: 2.0, pull: 1.0, belt: Friction::Sticks };
    let path =
        system.motion(State::new([0.0], [0.2])).by(Taylor::default()).with_contacts().to(20.0).unwrap();
    // From x = hold/k = 1/2 at the speed 0.2 about the center pull/k = 1/4: x − 1/4 = A cos ωt + (v/ω) sin ωt, and
    // the speed is 0.2 again at the mirrored place.
    let (omega, amplitude) = (2.0_f64, 0.25_f64);
    let slides = (std::f64::consts::PI + 2.0 * (0.2_f64 / omega / amplitude).atan()) / omega;
    let sticks = 2.0 * amplitude / 0.2;
    let mut time = 0.5 / 0.2;
    for pair in path.transitions().chunks(2) {
        let [Transition::Slips { time: slips, .. }, Transition::Sticks { time: stops, .. }] = pair else {
            assert!(pair.len() == 1, "{pair:?}");
            continue;
        };
        assert!((slips - time).abs() < 1e-12, "{slips} for {time}");
        assert!((stops - time - slides).abs() < 1e-12, "{stops} for {}", time + slides);
        time += slides + sticks;
    }
    assert!(path.transitions().len() >= 8, "{:?}", path.transitions());
}

/// A block on a plate that swings sideways, x_p = A sin ωt: it sticks as long as A ω² |sin ωt| < μ g, and once it slides, its
/// acceleration is ±μ g until the plate has its velocity again.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
#[contact(plate: y >= 0, friction(mu): x_dot - a*omega*cos(omega*t))]
struct Shaken {
    m: f64,
    g: f64,
    mu: f64,
    a: f64,
    omega: f64,
    plate: Contact,
}

#[test]
fn a_block_on_a_plate_that_swings_sticks_and_slides() {
    let (g, mu, a, omega) = (10.0, 0.2, 0.05, 8.0_f64);
    let system = Shaken { m: 3.0, g, mu, a, omega, plate: Contact::Closed };
    let start = State::new([0.0; 2], [a * omega, 0.0]);
    let path = system.motion(start).by(Taylor::default()).with_contacts().to(1.0).unwrap();
    // A ω² = 3.2 > μ g = 2: it slips forwards, relative to the plate, while the plate slows down.
    let slips = (mu * g / (a * omega * omega)).asin() / omega;
    let Transition::Slips { time, .. } = path.transitions()[0] else { panic!("{:?}", path.transitions()) };
    assert!((time - slips).abs() < 1e-13, "{time} for {slips}");
    // It slows down by μ g, until its speed is that of the plate: by bisection.
    let relative =
        |t: f64| a * omega * (omega * slips).cos() - mu * g * (t - slips) - a * omega * (omega * t).cos();
    let (mut low, mut high) = (slips + 0.05, slips + 0.5);
    assert!(relative(low) > 0.0 && relative(high) < 0.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        *if relative(middle) > 0.0 { &mut low } else { &mut high } = middle;
    }
    let time = path.transitions()[1].time();
    assert!((time - low).abs() < 1e-12, "{time} for {low}");
}

/// A billiard ball on a table: without side spin its friction keeps the direction in which the contact point slides, and it
/// rolls after 2 |u₀|/(7 μ g), with the velocity v₀ − 2/7 u₀ (Coriolis 1835; u₀ the velocity of the contact point).
#[derive(Clone, Lagrangian)]
#[coordinates(r: [3], q: [4])]
#[frame(ball: translate(r), rotate(q))]
#[define(omega = angular_velocity(ball))]
#[lagrangian(m/2 * dot(r_dot, r_dot) + m*a^2/5 * dot(omega, omega) - m*g*r[2])]
#[contact(table: r[2] - a >= 0, friction(mu): [r_dot[0] - a*omega[1], r_dot[1] + a*omega[0]])]
#[observable(spin = omega)]
struct Ball {
    m: f64,
    a: f64,
    g: f64,
    mu: f64,
    table: Contact,
}

#[test]
fn a_billiard_ball_slides_in_the_plane_and_then_rolls() {
    let ball = Ball { m: 0.17, a: 0.028, g: 9.8, mu: 0.2, table: Contact::Closed };
    for (velocity, spin) in
        [([1.0, 0.0], [0.0, 0.0]), ([1.0, 0.5], [20.0, 60.0]), ([0.0, 0.0], [-30.0, 10.0])]
    {
        // q̇ = ω q / 2 at q = 1.
        let start = State::new(
            [0.0, 0.0, 0.028, 1.0, 0.0, 0.0, 0.0],
            [velocity[0], velocity[1], 0.0, 0.0, spin[0] / 2.0, spin[1] / 2.0, 0.0],
        );
        let path = ball.motion(start).by(Dop853::with_tolerance(1e-12)).with_contacts().to(1.0).unwrap();
        let slip = [velocity[0] - 0.028 * spin[1], velocity[1] + 0.028 * spin[0]];
        let time = 2.0 / 7.0 * slip[0].hypot(slip[1]) / (0.2 * 9.8);
        let [Transition::Sticks { time: rolls, .. }] = path.transitions() else {
            panic!("{:?}", path.transitions())
        };
        assert!((rolls - time).abs() < 1e-11, "{rolls} for {time}");
        for (v, (v0, u0)) in path.end().v.iter().zip(velocity.iter().zip(slip)) {
            assert!((v - (v0 - 2.0 / 7.0 * u0)).abs() < 1e-11, "{:?}", path.end());
        }
    }
}

/// A block on an inclined plane, thrown across it: v turns towards the line of fall, and with tan α = μ its speed plus its
/// velocity down the plane stays the same, so that it ends with half its speed straight down.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) + m*g*(sin(alpha)*y - cos(alpha)*z))]
#[contact(plane: z >= 0, friction(mu): [x_dot, y_dot])]
struct Slope {
    m: f64,
    g: f64,
    alpha: f64,
    mu: f64,
    plane: Contact,
}

#[test]
fn a_block_thrown_across_a_slope_turns_down() {
    let alpha = 0.4_f64;
    let slope = Slope { m: 1.0, g: 10.0, alpha, mu: alpha.tan(), plane: Contact::Closed };
    let start = State::new([0.0; 3], [2.0, 0.0, 0.0]);
    let path = slope.motion(start).by(Dop853::with_tolerance(1e-12)).with_contacts().to(20.0).unwrap();
    let v = path.end().v;
    assert!((v[0].hypot(v[1]) + v[1] - 2.0).abs() < 1e-10, "{v:?}");
    assert!((v[1] - 1.0).abs() < 1e-6 && v[0].abs() < 1e-6, "{v:?}");
}

/// A block at rest on a slope that is too steep slides straight down.
#[test]
fn a_block_at_rest_slides_down_a_steep_slope() {
    let (alpha, mu, g) = (0.5_f64, 0.3, 10.0);
    let slope = Slope { m: 2.0, g, alpha, mu, plane: Contact::Closed };
    let expected = g * (alpha.sin() - mu * alpha.cos()) * 3.0;
    for method in [true, false] {
        let motion = slope.motion(State::at_rest([0.0; 3]));
        let path = match method {
            true => motion.by(Dop853::with_tolerance(1e-12)).with_contacts().to(3.0).unwrap(),
            false => motion.by(Taylor::default()).with_contacts().to(3.0).unwrap(),
        };
        let v = path.end().v;
        assert!(v[0].abs() < 1e-12 && (v[1] - expected).abs() < 1e-11, "{v:?} {expected}");
    }
}

/// A sphere that bounces on a rough floor: the impulse along the floor is μ times that of the impact, or stops the point of
/// contact, which takes 2/7 of the momentum along it.
#[test]
fn a_sphere_with_spin_bounces() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(x, y, phi)]
    #[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*r^2/5 * phi_dot^2 - m*g*y)]
    #[contact(floor: y - r >= 0, restitution: e, friction(mu): x_dot - r*phi_dot)]
    struct Bouncing {
        m: f64,
        g: f64,
        r: f64,
        e: f64,
        mu: f64,
        floor: Contact,
    }
    let (r, e, mu) = (0.1, 0.8, 0.1);
    let sphere = Bouncing { m: 0.4, g: 0.0, r, e, mu, floor: Contact::Open };
    for spin in [0.0, 15.0, 19.0, 30.0, -30.0] {
        let path =
            sphere.motion(State::new([0.0, 1.0, 0.0], [2.0, -1.0, spin])).with_contacts().to(2.0).unwrap();
        let slip = 2.0 - r * spin;
        let change = -(mu * (1.0 + e)).min(2.0 / 7.0 * slip.abs()) * slip.signum();
        let v = path.end().v;
        assert!((v[1] - e).abs() < 1e-14 && (v[0] - (2.0 + change)).abs() < 1e-14, "{spin}: {v:?}");
        assert!((v[2] - (spin - 2.5 * change / r)).abs() < 1e-12, "{spin}: {v:?}");
    }
}

/// Painlevé's rod: it slides on its lower end with a coefficient above 4/3, leaning so that friction presses it into the floor.
/// No force goes with any acceleration (Painlevé 1895; Génot and Brogliato 1999).
#[test]
fn a_rod_that_digs_in_is_named() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(x, y, theta)]
    #[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*a^2/6 * theta_dot^2 - m*g*y)]
    #[contact(floor: y - a*sin(theta) >= 0, friction(mu): x_dot + a*sin(theta)*theta_dot)]
    struct Rod {
        m: f64,
        a: f64,
        g: f64,
        mu: f64,
        floor: Contact,
    }
    let theta = 1.1_f64;
    let rod = |mu| Rod { m: 1.0, a: 0.5, g: 9.81, mu, floor: Contact::Closed };
    let start = State::new([0.0, 0.5 * theta.sin(), theta], [-3.0, 0.0, 0.0]);
    for sign in [1.0, -1.0] {
        let start = State { v: start.v * sign, ..start };
        let result = rod(3.0).motion(start).with_contacts().to(1.0);
        let jams = matches!(&result, Err(Error::FrictionJams { friction: "floor_friction", .. }))
            || matches!(&result, Err(Error::Unfinished(ending)) if ending.to_string().contains("Painlevé"));
        assert_eq!(jams, sign > 0.0, "{result:?}");
    }
    assert!(rod(0.5).motion(start).with_contacts().to(0.1).is_ok());
}

/// Friction in all its states on random systems, against M, h, W and γ written by hand and a dense solver.
#[test]
fn each_state_solves_the_equations_written_by_hand() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(x, y, theta)]
    #[lagrangian(m/2 * (x_dot^2 + y_dot^2) + j/2 * theta_dot^2 - m*g*y)]
    #[define(end(s) = [x + s*a*cos(theta), y + s*a*sin(theta)])]
    #[contact(floor[i in 0..2]: end(2*i - 1)[1] >= 0, friction(mu): der(end(2*i - 1))[0])]
    struct Rod {
        m: f64,
        j: f64,
        a: f64,
        g: f64,
        mu: f64,
        floor: [Contact; 2],
    }
    let mut seed = 3_u64;
    let mut next = |low: f64, high: f64| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    let slides = |sign| Contact::Slides([sign, 0.0]);
    let shares = Contact::Shares([Some(-0.4), None]);
    let states = [Contact::Open, Contact::Closed, slides(1.0), slides(-1.0), shares];
    let mut jams = 0;
    for case in 0..2_000 {
        // Two closed contacts of which one sticks are three rows at most.
        let floor = [states[case % 5], states[[0, 2, 3, 4][case / 5 % 4]]];
        let rod = Rod {
            m: next(0.5, 2.0),
            j: next(0.1, 1.0),
            a: next(0.3, 1.0),
            g: 9.81,
            mu: next(0.0, 0.5),
            floor,
        };
        let theta = next(-1.3, 1.3);
        let state = State::new([0.0, 1.0, theta], [next(-2.0, 2.0), next(-2.0, 2.0), next(-2.0, 2.0)]);
        let omega = state.v[2];
        let (s, c) = theta.sin_cos();
        // Unknowns: q̈, then N and T of both ends.
        let mut k = nalgebra::SMatrix::<f64, 7, 7>::zeros();
        let mut rhs = nalgebra::SVector::<f64, 7>::zeros();
        for (i, mass) in [rod.m, rod.m, rod.j].into_iter().enumerate() {
            k[(i, i)] = mass;
        }
        rhs[1] = -rod.m * rod.g;
        for (end, side) in [-1.0, 1.0].into_iter().enumerate() {
            let (normal, tangent) = ([0.0, 1.0, side * rod.a * c], [1.0, 0.0, -side * rod.a * s]);
            let bias = [-side * rod.a * s * omega * omega, -side * rod.a * c * omega * omega];
            let (n, t) = (3 + end, 5 + end);
            for i in 0..3 {
                (k[(i, n)], k[(i, t)]) = (-normal[i], -tangent[i]);
            }
            let set = |k: &mut nalgebra::SMatrix<f64, 7, 7>, row: usize, of: [f64; 3]| {
                (0..3).for_each(|i| k[(row, i)] = of[i]);
            };
            match floor[end] {
                Contact::Open => (k[(n, n)], k[(t, t)]) = (1.0, 1.0),
                Contact::Closed => {
                    set(&mut k, n, normal);
                    set(&mut k, t, tangent);
                    (rhs[n], rhs[t]) = (-bias[0], -bias[1]);
                }
                Contact::Slides([sign, _]) => {
                    set(&mut k, n, normal);
                    rhs[n] = -bias[0];
                    (k[(t, t)], k[(t, n)]) = (1.0, rod.mu * sign);
                }
                Contact::Shares([part, _]) => {
                    set(&mut k, n, normal);
                    rhs[n] = -bias[0];
                    (k[(t, t)], k[(t, n)]) = (1.0, -rod.mu * part.unwrap());
                }
            }
        }
        let expected = k.lu().solve(&rhs).expect("a solution");
        let found = match rod.solve(&state) {
            Ok(found) => found,
            Err(Error::FrictionJams { .. }) => {
                jams += 1;
                continue;
            }
            Err(other) => panic!("case {case}, {floor:?}: {other}"),
        };
        let scale = 1e-11 * (1.0 + expected.amax());
        assert!((found.accelerations - expected.fixed_rows::<3>(0)).amax() < scale, "case {case}, {floor:?}");
        assert!((found.multipliers - expected.fixed_rows::<4>(3)).amax() < scale, "case {case}, {floor:?}");
        // Derivatives by central differences of accelerations, the emitted Jacobian's.
        let jacobian = rod.jacobian(&state).unwrap().accelerations;
        for column in 0..6 {
            let moved = |step: f64| {
                let mut moved = state;
                if column < 3 {
                    moved.q[column] += step;
                } else {
                    moved.v[column - 3] += step;
                }
                rod.solve(&moved).unwrap().accelerations
            };
            let difference = (moved(1e-6) - moved(-1e-6)) / 2e-6;
            let slopes = if column < 3 { jacobian.q.column(column) } else { jacobian.v.column(column - 3) };
            let error = (difference - slopes).amax();
            assert!(
                error < 1e-6 * (1.0 + difference.amax()),
                "case {case}, {floor:?}, column {column}: {error:e}"
            );
        }
    }
    // Rods that lean far and are light to turn dig in.
    assert!(jams < 200, "{jams}");
}
