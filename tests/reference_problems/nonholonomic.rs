//! Nonholonomic systems: a sleigh, a knife edge, a particle, a ball on a turntable, and the stability of a rolling disc (Ju. I.
//! Neimark and N. A. Fufaev, *Dynamics of Nonholonomic Systems*, 1972).
//!
//! The reference values were recomputed by another Taylor method with 113 and 170 bits, and agree with the closed forms to 5·10⁻³⁰.
//! Vakonomic equations would give other motions in every case.

use lagrange_core::motion::Composition::KahanLi8;
use lagrange_core::prelude::*;

use crate::reference::{BAR, IS_LONG, Moment, Problem, Scale, assert_relative};

/// Runs a problem by the methods of this file. All must reach the bar.
macro_rules! every_method_reaches {
    ($problem:expr, $step:literal) => {
        let problem = $problem;
        problem.run("Taylor 2⁻⁵²", Taylor::default()).reaches_bar();
        problem.run("Dop853 1e-13", Dop853::with_tolerance(1e-13)).reaches_bar();
        if IS_LONG {
            let dalembert = DAlembert::with_step(0.005).composed(KahanLi8);
            problem.run("DAlembert Kahan–Li 8 5e-3 s", dalembert).reaches_bar();
            problem.run("Radau 1e-12", Radau::with_tolerance(1e-12)).reaches_bar();
            problem.run("Dopri5 1e-12", Dopri5::with_tolerance(1e-12)).reaches_bar();
            let fixed = RungeKutta4::with_step($step).max_steps(1_000_000);
            problem.run(concat!("RungeKutta4 ", $step, " s"), fixed).reaches_bar();
        }
    };
}

/// Chaplygin's sleigh: a blade at (x, y), with the centre of mass at the distance a before it.
#[derive(Lagrangian)]
#[coordinates(x, y, th)]
#[lagrangian(m/2*((x_dot - a*th_dot*sin(th))^2 + (y_dot + a*th_dot*cos(th))^2) + I/2*th_dot^2)]
#[constraint(blade: x_dot*sin(th) - y_dot*cos(th) = 0)]
#[allow(non_snake_case)]
struct Sleigh {
    m: f64,
    I: f64,
    a: f64,
}

#[test]
fn the_sleigh_reaches_its_reference() {
    every_method_reaches!(
        Problem {
            name: "Chaplygin's sleigh",
            system: Sleigh { m: 2.0, I: 0.3, a: 0.25 },
            start: State::new([0.0, 0.0, 0.0], [1.0, 0.0, 1.5]),
            moments: vec![
                Moment {
                    t: 0.5,
                    q: [0.514_882_212_418_535_5, 0.167_820_457_493_954_55, 0.556_944_176_184_113_7],
                    v: [0.985_053_236_922_495_7, 0.613_393_338_737_305, 0.786_784_169_287_241_2],
                    lambda: Some([-1.288_944_499_887_598_7]),
                },
                Moment {
                    t: 1.0,
                    q: [0.960_795_783_596_556_3, 0.555_799_953_188_112_9, 0.840_715_240_186_908_6],
                    v: [0.801_853_183_211_195_9, 0.895_861_716_285_167_2, 0.391_607_593_921_844_74],
                    lambda: Some([-0.664_703_541_509_871_4]),
                },
                Moment {
                    t: 2.0,
                    q: [1.644_968_817_674_402, 1.552_831_848_816_467_9, 1.049_663_159_384_744],
                    v: [0.604_906_926_894_380_5, 1.053_720_984_111_564_7, 0.094_176_241_243_929_02],
                    lambda: Some([-0.161_540_789_887_965]),
                },
                Moment {
                    t: 5.0,
                    q: [3.297_790_674_112_690_6, 4.803_317_372_676_794, 1.114_617_660_527_006_6],
                    v: [0.535_576_986_595_841_7, 1.091_458_628_585_322_7, 0.001_289_807_215_946_12],
                    lambda: Some([-0.002_213_821_760_192_539_5]),
                },
            ],
            scale: Scale::Run,
            bar: BAR,
        },
        0.0005
    );
}

/// A knife edge on an incline: it does not slide down, but drifts sideways.
#[derive(Lagrangian)]
#[coordinates(x, y, th)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) + I/2*th_dot^2 + m*g*slope*x)]
#[constraint(edge: x_dot*sin(th) - y_dot*cos(th) = 0)]
#[allow(non_snake_case)]
struct KnifeEdge {
    m: f64,
    I: f64,
    slope: f64,
    g: f64,
}

#[test]
fn the_knife_edge_reaches_its_reference() {
    every_method_reaches!(
        Problem {
            name: "knife edge",
            system: KnifeEdge { m: 1.5, I: 0.2, slope: 0.5, g: 9.81 },
            start: State::new([0.0; 3], [0.0, 0.0, 2.0]),
            moments: vec![
                Moment {
                    t: 0.5,
                    q: [0.434_137_514_578_983_36, 0.334_368_507_588_752, 1.0],
                    v: [1.115_025_969_644_992_2, 1.736_550_058_315_933_5, 2.0],
                    lambda: Some([-12.382_245_541_448_198]),
                },
                Moment {
                    t: 1.0,
                    q: [0.506_945_122_521_001, 1.458_257_264_967_836_7, 2.0],
                    v: [-0.928_029_059_871_347, 2.027_780_490_084_004, 2.0],
                    lambda: Some([-13.380_311_635_739_906]),
                },
                Moment {
                    t: 3.0,
                    q: [0.047_868_520_776_070_386, 3.843_243_135_174_508, 6.0],
                    v: [-0.657_972_540_698_033_3, 0.191_474_083_104_281_54, 2.0],
                    lambda: Some([4.111_599_055_997_194]),
                },
                Moment {
                    t: 10.0,
                    q: [0.511_020_699_525_271_5, 12.034_076_246_740_55, 20.0],
                    v: [0.913_695_013_037_801_4, 2.044_082_798_101_086, 2.0],
                    lambda: Some([-13.433_989_364_457_041]),
                },
            ],
            scale: Scale::Run,
            bar: BAR,
        },
        0.0005
    );
}

/// The simplest velocity constraint without an integral.
#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian((x_dot^2 + y_dot^2 + z_dot^2)/2)]
#[constraint(surface: z_dot - y*x_dot = 0)]
struct Particle;

#[test]
fn the_particle_reaches_its_reference() {
    every_method_reaches!(
        Problem {
            name: "nonholonomic particle",
            system: Particle,
            start: State::new([0.0, 0.5, 0.0], [1.0, 0.7, 0.5]),
            moments: vec![
                Moment {
                    t: 1.0,
                    q: [0.854_116_170_663_783_2, 1.2, 0.709_178_456_653_282_9],
                    v: [0.715_747_917_892_335_3, 0.7, 0.858_897_501_470_802_3],
                    lambda: Some([0.205_337_517_428_128_97]),
                },
                Moment {
                    t: 2.0,
                    q: [1.464_283_588_866_234, 1.9, 1.643_601_109_759_372_6],
                    v: [0.520_720_342_045_891_7, 0.7, 0.989_368_649_887_194_2],
                    lambda: Some([0.079_068_164_735_818_7]),
                },
                Moment {
                    t: 5.0,
                    q: [2.577_069_497_562_538, 4.0, 4.799_674_612_352_062],
                    v: [0.271_163_072_273_320_2, 0.7, 1.084_652_289_093_280_8],
                    lambda: Some([0.011_165_538_270_077_892]),
                },
            ],
            scale: Scale::Run,
            bar: BAR,
        },
        0.0005
    );
}

/// A ball in Euler's angles, rolling on a table that turns at the rate Ω.
#[derive(Lagrangian)]
#[coordinates(x, y, ph, th, ps)]
#[define(I = 2/5*m*r^2)]
#[define(wx = th_dot*cos(ph) + ps_dot*sin(th)*sin(ph))]
#[define(wy = th_dot*sin(ph) - ps_dot*sin(th)*cos(ph))]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) + I/2*(ph_dot^2 + th_dot^2 + ps_dot^2 + 2*ph_dot*ps_dot*cos(th)))]
#[constraint(along_x: x_dot - r*wy + Omega*y = 0)]
#[constraint(along_y: y_dot + r*wx - Omega*x = 0)]
#[allow(non_snake_case)]
struct BallOnTurntable {
    m: f64,
    r: f64,
    Omega: f64,
}

#[test]
fn the_ball_on_a_turntable_reaches_its_reference() {
    every_method_reaches!(
        Problem {
            name: "ball on a turntable",
            system: BallOnTurntable { m: 0.5, r: 0.1, Omega: 3.0 },
            start: State::new([0.3, 0.0, 0.0, 1.2, 0.0], [0.093_203_908_596_722_63, 0.7, 0.5, 2.0, -1.0]),
            moments: vec![
                Moment {
                    t: 1.0,
                    q: [
                        0.100_126_556_425_063_53,
                        0.654_937_942_653_895_9,
                        -0.109_603_949_133_712_99,
                        1.986_631_257_060_954,
                        -8.402_835_381_954_302,
                    ],
                    v: [
                        -0.468_171_470_820_902_5,
                        0.528_679_905_507_197_3,
                        -6.321_389_933_971_147_5,
                        -3.906_399_982_178_762_3,
                        -15.989_530_017_487_398,
                    ],
                    lambda: Some([-0.226_577_102_360_227_43, -0.200_644_916_066_101_08]),
                },
                Moment {
                    t: 2.0,
                    q: [
                        -0.525_827_563_411_933_8,
                        0.932_560_964_093_601_3,
                        0.371_012_301_087_338_4,
                        1.120_527_501_823_663,
                        -29.248_912_697_005_018,
                    ],
                    v: [
                        -0.706_134_060_626_364_3,
                        -0.007_852_197_210_229_018,
                        12.310_890_654_553_006,
                        -7.045_241_549_285_262_5,
                        -27.971_131_337_921_31,
                    ],
                    lambda: Some([0.003_365_227_375_812_436, -0.302_628_883_125_584_67]),
                },
                Moment {
                    t: 5.0,
                    q: [
                        -0.953_630_039_163_859_9,
                        -0.589_711_378_233_392_9,
                        1.548_246_720_819_976_8,
                        1.332_276_563_524_508_4,
                        -122.931_490_400_789_57,
                    ],
                    v: [
                        0.598_670_804_225_345_1,
                        -0.374_540_033_569_022_8,
                        6.117_455_510_761_233,
                        -12.262_272_250_791_447,
                        -25.309_819_452_445_325,
                    ],
                    lambda: Some([0.160_517_157_243_866_92, 0.256_573_201_810_862_2]),
                },
            ],
            scale: Scale::Run,
            bar: BAR,
        },
        0.0001
    );
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
