//! The ball on a turntable in Euler angles φ, θ, ψ (z, x, z): against reference values, and against the unit
//! quaternion.
//!
//! The reference values were integrated in 113- and in 170-bit arithmetic, which agree in all digits given.

use lagrange_core::nalgebra::{UnitQuaternion, Vector3};
use lagrange_core::prelude::*;

use crate::chapter_rolling::ball::Ball;
use crate::chapter_rolling::largest;

#[derive(Lagrangian)]
#[coordinates(x, y, ph, th, ps)]
#[define(inertia = 2/5 * m * a^2)]
#[define(spin = inertia/2 * (ph_dot^2 + th_dot^2 + ps_dot^2 + 2*ph_dot*ps_dot*cos(th)))]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) + spin)]
#[define(wx = th_dot*cos(ph) + ps_dot*sin(th)*sin(ph))]
#[define(wy = th_dot*sin(ph) - ps_dot*sin(th)*cos(ph))]
#[constraint(along: x_dot - a*wy + turn*y = 0)]
#[constraint(across: y_dot + a*wx - turn*x = 0)]
#[observable(angular_velocity = [wx, wy, ph_dot + ps_dot*cos(th)])]
struct InAngles {
    m: f64,
    a: f64,
    turn: f64,
}

const BALL: InAngles = InAngles { m: 0.5, a: 0.1, turn: 3.0 };

fn start() -> State<f64, 5> {
    State::new([0.3, 0.0, 0.0, 1.2, 0.0], [0.093_203_908_596_722_63, 0.7, 0.5, 2.0, -1.0])
}

struct Reference {
    t: f64,
    q: [f64; 5],
    v: [f64; 5],
    multipliers: [f64; 2],
    energy: f64,
}

const REFERENCE: [Reference; 3] = [
    Reference {
        t: 1.0,
        q: [
            0.100_126_556_425_063_54,
            0.654_937_942_653_896,
            -0.109_603_949_133_712_99,
            1.986_631_257_060_954,
            -8.402_835_381_954_303,
        ],
        v: [
            -0.468_171_470_820_902_5,
            0.528_679_905_507_197_3,
            -6.321_389_933_971_148,
            -3.906_399_982_187_762,
            -15.989_530_017_487_398,
        ],
        multipliers: [-0.226_577_102_360_227_42, -0.200_644_916_066_101_06],
        energy: 0.353_896_621_837_330_9,
    },
    Reference {
        t: 2.0,
        q: [
            -0.525_827_563_411_933_9,
            0.932_560_964_093_601_4,
            0.371_012_301_087_338_4,
            1.120_527_501_823_663,
            -29.248_912_697_005_018,
        ],
        v: [
            -0.706_134_060_626_364_3,
            -0.007_852_197_210_229_018,
            12.310_890_654_553_061,
            -7.045_241_549_285_262,
            -27.971_131_337_911_82,
        ],
        multipliers: [0.003_365_227_375_812_436, -0.302_628_883_125_584_7],
        energy: 0.808_522_327_515_254_7,
    },
    Reference {
        t: 5.0,
        q: [
            -0.953_630_039_163_859_9,
            -0.589_711_378_233_392_9,
            1.548_246_720_819_976_8,
            1.332_276_563_524_508_5,
            -122.931_490_400_789_56,
        ],
        v: [
            0.598_670_804_225_345_1,
            -0.374_540_033_542_628,
            6.117_455_510_761_233,
            -12.262_272_250_791_447,
            -25.309_819_452_426_54,
        ],
        multipliers: [0.160_517_157_243_866_9, 0.256_573_201_810_862_2],
        energy: 0.879_882_802_312_973_8,
    },
];

/// The energy is not constant: the table does work.
#[test]
fn turntable_against_reference_values() {
    let path = BALL.integrate(start(), 5.0, Dop853::with_tolerance(1e-13)).unwrap();
    for reference in REFERENCE {
        let sample = path.at(reference.t).unwrap();
        let (state, multipliers) = (sample.state(), sample.solution().unwrap().multipliers);
        let relative = |found: f64, exact: f64| (found - exact).abs() / exact.abs().max(1.0);
        let q = state.q.iter().zip(reference.q).map(|(a, b)| relative(*a, b));
        let v = state.v.iter().zip(reference.v).map(|(a, b)| relative(*a, b));
        let lambda = multipliers.iter().zip(reference.multipliers).map(|(a, b)| relative(*a, b));
        let worst = largest(q.chain(v).chain(lambda).chain([relative(BALL.energy(state), reference.energy)]));
        assert!(worst < 1e-9, "{worst:e} at t = {}", reference.t);
    }
}

fn in_quaternion(state: &State<f64, 5>) -> UnitQuaternion<f64> {
    let about = |axis: Vector3<f64>, angle: f64| UnitQuaternion::from_scaled_axis(axis * angle);
    let [_, _, ph, th, ps] = state.q.into();
    about(Vector3::z(), ph) * about(Vector3::x(), th) * about(Vector3::z(), ps)
}

/// Centre, orientation and angular velocity agree over 50 s. A larger ball turns slowly: the tolerance is relative
/// to angles that grow.
#[test]
fn angles_and_quaternion_give_one_motion() {
    let large = InAngles { m: 0.5, a: 0.4, turn: 1.0 };
    let ball = Ball {
        m: large.m,
        a: large.a,
        inertia: 0.4 * large.m * large.a * large.a,
        g: Vector3::zeros(),
        n: Vector3::z(),
        turn: large.turn,
    };
    let (s, _) = large.make_consistent(&start()).unwrap();
    let about_normal = large.angular_velocity(&s)[2];
    let [r, v] = [s.q, s.v].map(|x| Vector3::new(x[0], x[1], 0.0));
    let method = Dop853::with_tolerance(1e-12);
    let angles = large.integrate(s, 50.0, method).unwrap();
    let quaternion =
        ball.integrate(ball.rolling(r, v, about_normal, in_quaternion(&s)), 50.0, method).unwrap();
    let apart = largest(angles.samples(1001).zip(quaternion.samples(1001)).flat_map(|(one, other)| {
        let (one, other) = (one.state(), other.state());
        let [place, _] = Ball::place(other);
        let spin = large.angular_velocity(one) - ball.angular_velocity(other);
        [
            (one.q[0] - place[0]).hypot(one.q[1] - place[1]),
            in_quaternion(one).angle_to(&Ball::orientation(other)),
            spin.norm() / ball.angular_velocity(other).norm(),
        ]
    }));
    assert!(apart < 1e-8, "{apart:e}");
}
