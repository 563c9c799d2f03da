//! For a game.

use lagrange_core::{Ending, HybridTrajectory, prelude::*};

type Result = std::result::Result<(), Error>;

/// “A rope bridge of 12 planks on which the player walks, at 60 frames a second; it must never come apart.”
#[test]
fn a_rope_bridge() -> Result {
    /// The joints between the planks; the bridge hangs from two posts.
    #[derive(Lagrangian)]
    #[coordinates(r: [11, 2])]
    #[define(post = [span, 0])]
    #[lagrangian(sum(i in 0..11, m/2*dot(r_dot[i], r_dot[i]) - m*g*r[i][1]))]
    #[constraint(first: norm(r[0])^2 = plank^2)]
    #[constraint(planks[i in 1..11]: norm(r[i] - r[i-1])^2 = plank^2)]
    #[constraint(last: norm(post - r[10])^2 = plank^2)]
    #[force(r[i in 0..11]: -c*r_dot[i])]
    #[force(r[i in 0..11][1]: -load[i]*g)]
    struct Bridge {
        m: f64,
        g: f64,
        c: f64,
        plank: f64,
        span: f64,
        load: [f64; 11],
    }

    let bridge = Bridge { m: 15.0, g: 9.81, c: 20.0, plank: 1.0, span: 11.5, load: [0.0; 11] };
    // Roughly an arc; the nearest bridge that holds together.
    let mut rough = State::at_rest([0.0; 22]);
    for i in 0..11 {
        let x = 11.5 * (i + 1) as f64 / 12.0;
        rough.q[2 * i] = x;
        rough.q[2 * i + 1] = -0.12 * x * (11.5 - x) / 4.0;
    }
    let (start, _) = bridge.make_consistent(&rough)?;
    let mut motion = Motion::new(bridge, start, RungeKutta4::with_step(1.0 / 240.0))?;
    let mut lowest = 0.0_f64;
    for frame in 1..=600 {
        // A player of 80 kg walks over it in 10 s; their weight is shared by the joints beside.
        let at = 11.0 * f64::from(frame) / 600.0;
        motion.system_mut().load = std::array::from_fn(|i| 80.0 * (1.0 - (at - i as f64).abs()).max(0.0));
        motion.advance_to(f64::from(frame) / 60.0)?;
        let q = motion.state().q;
        let length = |i: usize| (q[2 * i] - q[2 * i - 2]).hypot(q[2 * i + 1] - q[2 * i - 1]);
        assert!((1..11).all(|i| (length(i) - 1.0).abs() < 1e-9), "it comes apart at frame {frame}");
        lowest = (0..11).map(|i| q[2 * i + 1]).fold(lowest, f64::min);
    }
    assert!((-3.5..-1.0).contains(&lowest), "{lowest}");
    Ok(())
}

/// “A grappling hook: the player swings on a rope, lets go, flies, and bounces off the ground twice.”
#[test]
fn a_grappling_hook() -> Result {
    #[derive(Clone, Lagrangian)]
    #[coordinates(x, y)]
    #[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
    #[constraint(rope: x^2 + (y - hook)^2 = l^2)]
    struct Swinging {
        m: f64,
        g: f64,
        hook: f64,
        l: f64,
    }

    #[derive(Clone, Lagrangian)]
    #[coordinates(x, y)]
    #[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
    struct Flying {
        m: f64,
        g: f64,
    }

    #[derive(Lagrangian)]
    #[coordinates(x, y)]
    #[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
    #[constraint(ground: y = 0)]
    struct Landed {
        m: f64,
        g: f64,
    }

    let (m, g) = (70.0, 9.81);
    let (swinging, flying, landed) = (Swinging { m, g, hook: 8.0, l: 6.0 }, Flying { m, g }, Landed { m, g });
    let mut trajectory = HybridTrajectory::new();
    // The player lets go at 45° on the way up.
    let lets_go =
        swinging.event("lets go", |sample| sample.state().q[0] - 6.0 * 0.5_f64.sqrt()).rising().terminal();
    let start = State::at_rest([-6.0, 8.0]);
    let swing = swinging.motion(start).event(lets_go).to(10.0)?;
    let mut state = *swing.end().state();
    assert!((state.v.norm_squared() / 2.0 - g * 6.0 * 0.5_f64.sqrt()).abs() < 1e-6);
    trajectory.push(swing.into_owned())?;
    let mut lands = flying.event("lands", |sample| sample.coordinate("y")).falling().terminal();
    for _ in 0..3 {
        let flight = flying.motion(state).event(&mut lands).towards(60.0)?;
        assert!(matches!(flight.ending(), Ending::Event { event: "lands", .. }));
        state = landed.impact(flight.end().state(), "ground", 0.4)?.state;
        trajectory.push(flight.into_owned())?;
    }
    // Frames for the screen, whatever leg they are of.
    let frames: Vec<_> = trajectory.samples(300).collect::<std::result::Result<_, _>>()?;
    assert!(frames.iter().all(|frame| frame.coordinate("y").is_ok_and(|y| y > -1e-9)));
    assert!(frames.iter().any(|frame| frame.multiplier("rope").is_ok_and(|rope| rope < 0.0)));
    assert_eq!(trajectory.legs().len(), 4);
    Ok(())
}

/// “A car with a trailer that is steered by the keys: no slipping sideways, backing up must fold the trailer.”
#[test]
fn a_car_with_a_trailer() -> Result {
    /// The rear axle is the car's point; the front axle is `b` ahead of it.
    #[derive(Clone, Lagrangian)]
    #[coordinates(x, y, heading, hitch)]
    #[frame(car: translate([x, y, 0]), rotate_z(heading))]
    #[frame(trailer in car: translate([-d, 0, 0]), rotate_z(hitch), translate([-l, 0, 0]))]
    #[define(ahead = velocity(car)[0])]
    #[lagrangian(kinetic(car, m, [0, 0, 0]) + kinetic(trailer, m/4, [0, 0, 0]) + inertia/2*(heading_dot^2 + hitch_dot^2))]
    #[constraint(rear: velocity(car)[1] = 0)]
    #[constraint(trailing: velocity(trailer)[1] = 0)]
    #[constraint(front: cos(steer)*velocity(car, [b, 0, 0])[1] = sin(steer)*velocity(car, [b, 0, 0])[0])]
    #[power(engine - c*ahead, ahead)]
    #[observable(speed = ahead)]
    struct Car {
        m: f64,
        inertia: f64,
        b: f64,
        d: f64,
        l: f64,
        c: f64,
        engine: f64,
        steer: f64,
    }

    let car = Car { m: 1000.0, inertia: 800.0, b: 2.6, d: 0.8, l: 3.0, c: 300.0, engine: 0.0, steer: 0.0 };
    let mut state = State::at_rest([0.0, 0.0, 0.0, 0.1]);
    let mut drive = |engine: f64, steer: f64, seconds: f64| -> std::result::Result<State<f64, 4>, Error> {
        let car = Car { engine, steer, ..car.clone() };
        // The wheels turned, the velocity is the nearest that does not slip.
        let (start, _) = car.make_consistent(&state)?;
        let mut motion = Motion::new(car, start, RungeKutta4::with_step(1.0 / 120.0))?;
        let end = motion.state().t + seconds;
        motion.advance_to(end)?;
        state = *motion.state();
        Ok(state)
    };

    // Straight ahead the trailer falls into line.
    let straight = drive(3000.0, 0.0, 10.0)?;
    assert!(straight.q[3].abs() < 1e-3 && straight.q[0] > 50.0, "{straight:?}");
    // In a bend the rear axle keeps to a circle of radius b/tan(steer).
    let bend = drive(1500.0, 0.3, 8.0)?;
    let speed = bend.v[0].hypot(bend.v[1]);
    assert!((speed / bend.v[2] - 2.6 / 0.3_f64.tan()).abs() < 1e-3, "{bend:?}");
    // Backing up, what is a little folded folds on.
    let folded = bend.q[3].abs();
    drive(-3000.0, 0.0, 5.0)?;
    let back = drive(-3000.0, 0.0, 3.0)?;
    assert!(back.q[3].abs() > 2.0 * folded, "{folded} {back:?}");
    Ok(())
}
