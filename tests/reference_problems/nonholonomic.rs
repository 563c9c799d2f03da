//! Nonholonomic systems: a sleigh, a knife edge, a particle, a ball on a turntable, and the stability of a rolling disc (Ju. I.
//! Neimark and N. A. Fufaev, *Dynamics of Nonholonomic Systems*, 1972).
//!
//! The reference values were recomputed by another Taylor method with 113 and 170 bits, and agree with the closed forms to 5·10⁻³⁰.
//! Vakonomic equations would give other motions in every case.

use lagrange_core::motion::Composition::KahanLi8;
use lagrange_core::prelude::*;
use lagrange_systems::{BallInAngles, ChaplyginSleigh, KnifeEdge, TiedParticle};

use crate::reference::{BAR, IS_LONG, Problem, assert_relative, table};

/// Runs a problem by the methods of this file. All must reach the bar.
macro_rules! every_method_reaches {
    ($name:literal, $system:expr, $table:literal, $step:literal) => {
        let problem = Problem { name: $name, system: $system, known: table!($table) };
        problem.check(&[BAR, BAR, BAR]);
        if IS_LONG {
            let dalembert = DAlembert::with_step(0.005).composed(KahanLi8);
            problem.row("DAlembert Kahan–Li 8 5e-3 s", dalembert).reaches(BAR);
            problem.row("Radau 1e-12", Radau::with_tolerance(1e-12)).reaches(BAR);
            let fixed = RungeKutta4::with_step($step).max_steps(1_000_000);
            problem.row(concat!("RungeKutta4 ", $step, " s"), fixed).reaches(BAR);
        }
    };
}

#[test]
fn nonholonomic_motions_reach_their_references() {
    let sleigh = ChaplyginSleigh { m: 2.0, a: 0.25, inertia: 0.3 };
    every_method_reaches!("Chaplygin's sleigh", sleigh, "sleigh", 0.0005);
    let edge = KnifeEdge { m: 1.5, inertia: 0.2, g: 4.905 };
    every_method_reaches!("knife edge", edge, "knife_edge", 0.0005);
    every_method_reaches!("nonholonomic particle", TiedParticle, "particle", 0.0005);
    let ball = BallInAngles { m: 0.5, a: 0.1, turn: 3.0 };
    every_method_reaches!("ball on a turntable", ball, "turntable", 0.0001);
}

/// A disc that rolls on a plane: the point of contact, the direction, the lean, and the turn about its axle.
#[derive(Lagrangian)]
#[coordinates(x, y, yaw, lean, spin)]
#[frame(upright: translate([x, y, 0]), rotate_z(yaw), rotate_x(lean), translate([0, 0, r]))]
#[frame(disc in upright: rotate_y(spin))]
#[lagrangian(kinetic(disc, m, [0, 0, 0], [[A, 0, 0], [0, C, 0], [0, 0, A]]) - m*g*position(disc)[2])]
#[define(contact = express(vector(upright, [0, 0, -r]), disc))]
#[define(slip = express(velocity(disc) + cross(angular_velocity(disc), contact), fixed))]
#[constraint(rolls: [slip[0], slip[1]] = 0)]
#[allow(non_snake_case)]
struct Disc {
    m: f64,
    r: f64,
    A: f64,
    C: f64,
    g: f64,
}

/// An upright disc is stable if spin² > m g r A/(C (C + m r²)); the critical speeds were recomputed with 170 bits by linearization.
#[test]
fn an_upright_disc_is_stable_above_its_critical_speed() {
    let (m, r, g) = (1.3, 0.4, 9.81);
    for (name, a, c, critical) in
        [("disc", 0.25, 0.5, 1.143_678_276_439_663_8), ("hoop", 0.5, 1.0, 0.990_454_441_153_150_7)]
    {
        let disc = Disc { m, r, A: a * m * r * r, C: c * m * r * r, g };
        // Lean and yaw rate exchange: s² = a + b v² of the pair of eigenvalues that are not zero, negative if it is stable.
        let square = |speed: f64| {
            let state = State::new([0.0; 5], [speed, 0.0, 0.0, 0.0, speed / r]);
            let eigenvalues = disc.linearize(&state, &[]).unwrap().eigenvalues().unwrap();
            let largest = eigenvalues.iter().max_by(|s, t| s.norm().total_cmp(&t.norm())).unwrap();
            let square = largest * largest;
            assert!(square.im.abs() < 1e-12 * square.norm(), "{largest}");
            square.re
        };
        let (slow, fast) = (0.5, 2.0);
        let [at_slow, at_fast] = [square(slow), square(fast)];
        assert!(at_slow > 0.0 && at_fast < 0.0, "{name}: {at_slow} {at_fast}");
        let found = ((at_fast * slow * slow - at_slow * fast * fast) / (at_fast - at_slow)).sqrt();
        println!("{name}: critical speed {found}");
        assert_relative(name, found, critical, 1e-12);
        // s² is linear in v².
        let (middle, part) = (1.5, (1.5 * 1.5 - slow * slow) / (fast * fast - slow * slow));
        assert_relative(name, square(middle), at_slow + part * (at_fast - at_slow), 1e-11);
    }
}
