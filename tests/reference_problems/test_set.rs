//! Car axis, slider crank and pendulum of the Test Set for Initial Value Problem Solvers (F. Mazzia and C. Magherini); the pendulum
//! is A01 of the IFToMM benchmark too.
//!
//! The reference values were recomputed by another Taylor method with 113 and 170 bits, which agree in all digits here; those of the
//! pendulum by elliptic functions as well.

use lagrange_core::motion::Composition::KahanLi8;
use lagrange_core::prelude::*;

use crate::reference::{BAR, Errors, IS_LONG, Moment, Problem, Scale, assert_relative};

/// Two wheels of a car axis on a bumpy road: the left one on a cylinder of given height, both at a given distance.
#[derive(Lagrangian)]
#[coordinates(xl, yl, xr, yr)]
#[define(yb = r*sin(w*t))]
#[define(xb = sqrt(L^2 - yb^2))]
#[define(left = norm([xl, yl]))]
#[define(right = norm([xr - xb, yr - yb]))]
#[define(k = M*eps^2/2)]
#[lagrangian(k/2*(xl_dot^2 + yl_dot^2 + xr_dot^2 + yr_dot^2) - (left - L0)^2/2 - (right - L0)^2/2 - k*g*(yl + yr))]
#[constraint(across: xl*xb + yl*yb = 0)]
#[constraint(axis: (xl - xr)^2 + (yl - yr)^2 = L^2)]
#[allow(non_snake_case)]
pub(crate) struct CarAxis {
    L: f64,
    L0: f64,
    M: f64,
    eps: f64,
    r: f64,
    w: f64,
    g: f64,
}

pub(crate) fn car_axis() -> Problem<CarAxis, 4, 2> {
    Problem {
        name: "car axis",
        system: CarAxis { L: 1.0, L0: 0.5, M: 10.0, eps: 0.01, r: 0.1, w: 10.0, g: 1.0 },
        start: State::new([0.0, 0.5, 1.0, 0.5], [-0.5, 0.0, -0.5, 0.0]),
        moments: vec![
            Moment {
                t: 0.5,
                q: [
                    0.047_887_818_061_671_22,
                    0.497_089_687_180_821_7,
                    1.043_577_149_975_532_9,
                    0.404_338_653_154_628_36,
                ],
                v: [
                    -0.141_384_005_050_427_72,
                    0.016_494_641_668_148_87,
                    -0.021_995_135_814_052_15,
                    1.298_143_139_671_389_2,
                ],
                lambda: Some([-0.005_723_013_666_626_728, -0.001_635_372_944_407_669_6]),
            },
            Moment {
                t: 1.0,
                q: [
                    0.027_182_095_440_113_456,
                    0.498_911_552_629_264_95,
                    1.024_548_795_970_379,
                    0.426_388_006_981_167_74,
                ],
                v: [
                    0.419_164_414_754_794_66,
                    -0.024_290_049_857_214_543,
                    0.297_172_685_763_110_4,
                    -1.701_958_828_308_764_5,
                ],
                lambda: Some([-0.003_837_120_982_712_094, -0.001_228_798_461_950_546_3]),
            },
            Moment {
                t: 2.0,
                q: [
                    -0.045_604_483_642_859_454,
                    0.497_445_343_218_971_1,
                    0.951_740_760_592_787_6,
                    0.570_263_361_597_237_8,
                ],
                v: [
                    -0.203_218_758_499_374_85,
                    -0.025_571_824_448_244_87,
                    -0.225_931_716_144_986_47,
                    0.285_514_096_246_589_13,
                ],
                lambda: Some([0.004_968_892_596_506_638, 0.001_317_462_154_507_985_8]),
            },
            Moment {
                t: 3.0,
                q: [
                    0.049_345_578_427_524_094,
                    0.496_989_460_230_008_1,
                    1.041_742_524_885_426_2,
                    0.373_911_027_265_365_8,
                ],
                v: [
                    -0.077_058_368_403_592_08,
                    0.007_446_866_592_068_417,
                    0.017_556_815_753_541_736,
                    0.770_341_043_779_601_1,
                ],
                lambda: Some([-0.004_736_886_590_853_326, -0.001_104_680_331_259_565_8]),
            },
        ],
        scale: Scale::Run,
        bar: BAR,
    }
}

#[test]
fn the_car_axis_reaches_its_reference() {
    let axis = car_axis();
    axis.run("Taylor 2⁻⁵²", Taylor::default()).reaches_bar();
    axis.run("Dop853 1e-13", Dop853::with_tolerance(1e-13)).reaches_bar();
    if IS_LONG {
        axis.run("Verlet Kahan–Li 8 5e-3 s", Verlet::with_step(5e-3).composed(KahanLi8)).reaches_bar();
        axis.run("Lobatto 4 1e-3 s", Lobatto::<4>::with_step(1e-3)).reaches_bar();
        axis.run("Radau 1e-12", Radau::with_tolerance(1e-12)).reaches_bar();
        axis.run("Dopri5 1e-13", Dopri5::with_tolerance(1e-13)).reaches_bar();
        axis.run("RungeKutta4 1e-5 s", RungeKutta4::with_step(1e-5).max_steps(1_000_000)).reaches_bar();
    }
}

/// Crank, rod and slider, all rigid; the crank turns at a given rate, so that no degree of freedom is left.
#[derive(Lagrangian)]
#[coordinates(phi1, phi2, x3)]
#[lagrangian((J1 + M2*L1^2)/2*phi1_dot^2 + J2/2*phi2_dot^2 + L1*L2*M2/2*cos(phi1 - phi2)*phi1_dot*phi2_dot + M3/2*x3_dot^2)]
#[constraint(height: L1*sin(phi1) + L2*sin(phi2) = 0)]
#[constraint(slider: x3 - L1*cos(phi1) - L2*cos(phi2) = 0)]
#[constraint(drive: phi1 - Omega*t = 0)]
#[allow(non_snake_case)]
struct DrivenSliderCrank {
    L1: f64,
    L2: f64,
    M2: f64,
    M3: f64,
    J1: f64,
    J2: f64,
    Omega: f64,
}

/// Positions are kinematics, and the multipliers are the whole answer.
#[test]
fn the_driven_slider_crank_reaches_its_reference() {
    let crank = Problem {
        name: "driven slider crank",
        system: DrivenSliderCrank {
            L1: 0.15,
            L2: 0.3,
            M2: 0.151_104,
            M3: 0.075_552,
            J1: 0.002_727,
            J2: 0.004_533_925_9,
            Omega: 150.0,
        },
        start: State::new([0.0, 0.0, 0.45], [150.0, -75.0, 0.0]),
        moments: vec![
            Moment {
                t: 0.01,
                q: [1.5, -0.522_153_108_253_930_6, 0.270_634_779_918_657_4],
                v: [150.0, -6.120_918_897_365_660_5, -23.359_475_085_621_064],
                lambda: Some([33.923_325_574_174_93, 127.341_873_813_286_07, -38.466_810_382_412_63]),
            },
            Moment {
                t: 0.05,
                q: [7.5, -0.488_158_175_306_990_24, 0.316_954_749_252_921_2],
                v: [150.0, -29.435_804_629_154_28, -25.246_617_086_205_493],
                lambda: Some([-80.834_626_151_350_16, 16.385_740_168_051_964, -0.407_926_719_913_581_2]),
            },
            Moment {
                t: 0.1,
                q: [15.0, -0.331_163_913_464_838_2, 0.169_746_176_502_319_05],
                v: [150.0, 60.250_322_145_936_65, -8.754_468_624_977_381],
                lambda: Some([60.764_479_088_421_59, 163.717_059_081_817_4, -25.014_657_779_961_57]),
            },
        ],
        scale: Scale::Run,
        bar: BAR,
    };
    let begins = crank.system.solve(&crank.start).unwrap().multipliers;
    assert_relative("λ of the slider at the start", begins[1], -382.482, 1e-14);
    assert!(begins[0].abs() < 1e-12 && begins[2].abs() < 1e-12, "{begins}");
    crank.run("Taylor 2⁻⁵²", Taylor::default()).reaches_bar();
    crank.run("Dop853 1e-12", Dop853::with_tolerance(1e-12)).reaches_bar();
    crank.run("Lobatto 4 1e-4 s", Lobatto::<4>::with_step(1e-4)).reaches_bar();
    if IS_LONG {
        crank.run("Radau 1e-12", Radau::with_tolerance(1e-12)).reaches_bar();
        crank.run("Dopri5 1e-12", Dopri5::with_tolerance(1e-12)).reaches_bar();
        crank.run("RungeKutta4 1e-4 s", RungeKutta4::with_step(1e-4)).reaches_bar();
    }
}

/// A pendulum in Cartesian coordinates, of length and mass 1.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - g*y)]
#[constraint(rod: x^2 + y^2 - 1 = 0)]
struct Pendulum {
    g: f64,
}

const PENDULUM: [Moment<2, 1>; 7] = [
    Moment {
        t: 1.0,
        q: [-0.986_291_751_131_875_3, -0.165_010_853_125_541_17],
        v: [-0.296_905_515_916_315_8, 1.774_643_641_112_655_6],
        lambda: Some([-2.428_134_703_742_338]),
    },
    Moment {
        t: 2.0,
        q: [0.793_566_195_343_321_7, -0.608_483_930_443_791_6],
        v: [2.102_437_874_436_126, 2.741_935_393_010_509_3],
        lambda: Some([-8.953_841_036_480_393]),
    },
    Moment {
        t: 5.0,
        q: [0.942_305_435_043_757_3, -0.334_754_338_414_000_6],
        v: [-0.857_904_256_885_949_1, -2.414_928_654_370_488_6],
        lambda: Some([-4.925_910_089_762_018]),
    },
    Moment {
        t: 10.0,
        q: [0.275_087_462_576_116_9, -0.961_419_205_099_125],
        v: [-4.175_598_100_951_729, -1.194_749_054_560_475_3],
        lambda: Some([-14.147_283_603_033_625]),
    },
    Moment {
        t: 100.0,
        q: [0.181_513_351_427_031_37, -0.983_388_480_334_057_5],
        v: [-4.319_536_780_534_662, -0.797_297_927_855_360_5],
        lambda: Some([-14.470_561_488_115_656]),
    },
    Moment {
        t: 1000.0,
        q: [-0.683_230_188_552_314_9, -0.730_203_060_422_762_3],
        v: [-2.763_853_217_052_379_3, 2.586_058_669_110_933_3],
        lambda: Some([-10.744_938_034_120_947]),
    },
    Moment {
        t: 2000.0,
        q: [-0.814_603_068_589_032_2, -0.580_018_827_836_935_5],
        v: [1.956_647_707_882_657_8, -2.747_999_117_430_392],
        lambda: Some([-8.534_977_051_620_505]),
    },
];

fn pendulum(name: &'static str, moments: usize) -> Problem<Pendulum, 2, 1> {
    Problem {
        name,
        system: Pendulum { g: 9.81 },
        start: State::at_rest([1.0, 0.0]),
        moments: PENDULUM[..moments].to_vec(),
        scale: Scale::Run,
        bar: BAR,
    }
}

#[test]
fn the_pendulum_reaches_its_reference() {
    let pendulum = pendulum("A01 pendulum, 10 s", 4);
    pendulum.run("Taylor 2⁻⁵²", Taylor::default()).reaches_bar();
    pendulum.run("Dop853 1e-12", Dop853::with_tolerance(1e-12)).reaches_bar();
    pendulum.run("Verlet Kahan–Li 8 0.02 s", Verlet::with_step(0.02).composed(KahanLi8)).reaches_bar();
    if IS_LONG {
        pendulum.run("Lobatto 4 5e-3 s", Lobatto::<4>::with_step(5e-3)).reaches_bar();
        pendulum.run("Radau 1e-12", Radau::with_tolerance(1e-12)).reaches_bar();
        pendulum.run("Dopri5 1e-12", Dopri5::with_tolerance(1e-12)).reaches_bar();
        pendulum.run("RungeKutta4 1e-4 s", RungeKutta4::with_step(1e-4).max_steps(1_000_000)).reaches_bar();
    }
}

/// A01 lasts 2000 s, 845 periods.
#[test]
fn the_pendulum_reaches_its_reference_after_many_periods() {
    let (name, moments) = if IS_LONG { ("A01 pendulum, 2000 s", 7) } else { ("A01 pendulum, 100 s", 5) };
    let pendulum = pendulum(name, moments);
    pendulum.run("Taylor 2⁻⁵²", Taylor::default()).reaches_bar();
    if IS_LONG {
        let _ = pendulum.run("Dop853 1e-14", Dop853::with_tolerance(1e-14).max_steps(10_000_000));
    }
}

/// Crank, flexible rod and slider (B. Simeon, "Modelling a flexible slider crank mechanism by a mixed system of DAEs and PDEs",
/// *Mathematical Modelling of Systems* 2, 1996): two modes of bending, two nodes along the rod. The stiffness is linear, and nothing is
/// damped. The test set has `p` for π, to eight digits.
#[derive(Lagrangian)]
#[coordinates(phi1, phi2, x3, q: [4])]
#[define(cosine = cos(phi1 - phi2))]
#[define(sine = sin(phi1 - phi2))]
// Integrals over the rod, times its density: of the displacements, of these times the place, and of their moments.
#[define(c1(u) = M2*(2/3*u[2] + u[3]/6))]
#[define(c2(u) = M2*2/p*u[0])]
#[define(c12(u) = M2*L2*(u[2]/3 + u[3]/6))]
#[define(c21(u) = M2*L2*(u[0] - u[1]/2)/p)]
#[define(turned = M2*(-16/p^3*(q[0]*q_dot[2] - q[2]*q_dot[0]) + (8/p^3 - 1/p)*(q[0]*q_dot[3] - q[3]*q_dot[0])
    + (q[1]*q_dot[3] - q[3]*q_dot[1])/(2*p)))]
#[define(mass(u) = M2*((u[0]^2 + u[1]^2)/2 + 8*u[2]^2 + 2*u[2]*u[3] + 2*u[3]^2))]
#[define(stiffness = E*b*h/L2*(p^4*(h/L2)^2*(q[0]^2/24 + 2/3*q[1]^2) + (16*q[2]^2 - 16*q[2]*q[3] + 7*q[3]^2)/3))]
#[lagrangian((J1 + M2*L1^2)/2*phi1_dot^2 + (J2 + mass(q) + 2*c12(q))/2*phi2_dot^2
    + (L1*L2*M2/2*cosine + L1*(sine*c2(q) + cosine*c1(q)))*phi1_dot*phi2_dot
    + L1*phi1_dot*(cosine*c2(q_dot) - sine*c1(q_dot)) + phi2_dot*(c21(q_dot) + turned)
    + M3/2*x3_dot^2 + mass(q_dot)/2 - stiffness/2)]
#[constraint(height: L1*sin(phi1) + (L2 + q[3])*sin(phi2) = 0)]
#[constraint(slider: x3 - L1*cos(phi1) - (L2 + q[3])*cos(phi2) = 0)]
#[constraint(drive: phi1 - Omega*t = 0)]
#[allow(non_snake_case)]
struct FlexibleSliderCrank {
    L1: f64,
    L2: f64,
    M2: f64,
    M3: f64,
    J1: f64,
    J2: f64,
    /// Young's modulus, and the sides of the rod's section.
    E: f64,
    b: f64,
    h: f64,
    Omega: f64,
    p: f64,
}

#[allow(clippy::approx_constant, reason = "the test set has π to eight digits")]
const FLEXIBLE: FlexibleSliderCrank = FlexibleSliderCrank {
    L1: 0.15,
    L2: 0.3,
    M2: 0.151_104,
    M3: 0.075_552,
    J1: 0.002_727,
    J2: 0.004_533_925_9,
    E: 2e11,
    b: 0.008,
    h: 0.008,
    Omega: 150.0,
    p: 3.141_592_7,
};

/// The start of the test set, close to the smooth motion, with x₃ and the rate of φ₂ from the constraints.
fn flexible_start() -> State<f64, 7> {
    State::new(
        [0.0, 0.0, 0.450_016_932_796_9, 0.0, 0.0, 0.103_339_863e-4, 0.169_327_969e-4],
        [
            150.0,
            -74.995_767_039_694_53,
            -0.268_938_672e-5,
            0.444_896_105,
            0.463_434_311e-2,
            -0.178_591_076e-5,
            -0.268_938_672e-5,
        ],
    )
}

/// The published accelerations and multipliers at the start, to the digits that its nine digits of x₃ and φ̇₂ leave. The test set has
/// the other sign of λ.
#[test]
fn the_flexible_slider_crank_starts_as_published() {
    let solution = FLEXIBLE.solve(&flexible_start()).unwrap();
    let known = [(2, -5_062.194_923_138_079), (5, -4.268_463_211_410_861), (6, 0.209_833_468_794_737_6)];
    for (index, published) in known {
        assert_relative("acceleration", solution.accelerations[index], published, 1e-6);
    }
    assert_relative("multiplier", solution.multipliers[1], -382.458_950_832_928_1, 1e-9);
}

/// Reference values were computed by `recompute.py slider_crank` from the published mass matrix and forces, not from a Lagrangian, by
/// extrapolation with 46 digits, of which 18 are right.
///
/// The rod vibrates at some kilohertz, and x₃ holds its displacements of 10⁻⁵ m to an ulp of 0.3 m alone. A change of x₃ by half of that
/// at the start makes a difference of 10⁻⁹ in the velocities of the rod: no method can be asked for less.
#[test]
fn the_flexible_slider_crank_reaches_its_reference_to_the_rounding_of_its_start() {
    let problem = |name, moments| Problem {
        name,
        system: FLEXIBLE,
        start: flexible_start(),
        moments,
        scale: Scale::Run,
        bar: Errors { v: 3e-9, ..BAR },
    };
    let crank = problem(
        "flexible slider crank",
        vec![
            Moment {
                t: 0.05,
                q: [
                    7.5,
                    -0.488_158_117_057_644_5,
                    0.316_954_786_512_635_7,
                    0.001_273_942_652_374_460_6,
                    4.208_688_675_381_361e-5,
                    -1.270_513_744_675_351_6e-7,
                    3.290_771_218_049_767e-8,
                ],
                v: [
                    150.0,
                    -29.442_524_980_269_756,
                    -25.250_917_884_695_89,
                    -0.246_820_724_582_069_38,
                    0.004_197_479_712_893_984,
                    -0.002_095_625_876_471_393_6,
                    -0.003_798_971_866_940_175,
                ],
                lambda: Some([-81.448_716_196_793, 16.643_851_458_893_035, -0.008_688_549_997_745_034]),
            },
            Moment {
                t: 0.1,
                q: [
                    15.0,
                    -0.331_173_498_825_644_7,
                    0.169_737_332_639_958_55,
                    0.000_189_319_284_302_004_2,
                    2.375_751_320_488_572_6e-5,
                    -5.323_896_778_192_386_5e-6,
                    -8.363_313_291_666_587e-6,
                ],
                v: [
                    150.0,
                    60.253_467_551_296_026,
                    -8.753_116_326_727_14,
                    -0.030_055_411_709_507_23,
                    -0.005_500_430_645_925_284,
                    0.000_497_411_166_367_457_1,
                    0.001_105_559_971_607_831_4,
                ],
                lambda: Some([62.329_359_278_286_79, 163.792_099_344_186_68, -25.298_579_487_869_894]),
            },
        ],
    );
    crank.run("Taylor 2⁻⁵²", Taylor::default()).reaches_bar();
    let _ = crank.run("Dop853 1e-14", Dop853::with_tolerance(1e-14));
    if IS_LONG {
        let _ = crank.run("Dopri5 1e-13", Dopri5::with_tolerance(1e-13));
        let _ = crank.run("RungeKutta4 1e-7 s", RungeKutta4::with_step(1e-7).max_steps(1_100_000));
    }
    // The published values at t = 0.1 are right to 9 digits of φ₂ and x₃, and 5 of the multipliers.
    let published = Moment {
        t: 0.1,
        q: [
            15.0,
            -0.331_173_498_791_088_1,
            0.169_737_332_671_841,
            1.893_192_460_247_178e-4,
            2.375_751_865_617_931e-5,
            -5.323_907_988_763_734e-6,
            -8.363_283_141_616_84e-6,
        ],
        v: [
            150.0,
            60.253_466_826_457_89,
            -8.753_116_989_887_888,
            -3.005_536_801_092_212e-2,
            -5.500_488_291_932_075e-3,
            4.978_243_404_809_343e-4,
            1.104_933_470_696_396e-3,
        ],
        lambda: Some([62.328_932_625_337_17, 163.791_013_168_747_2, -25.298_532_137_327_81]),
    };
    let Errors { q, v, lambda } = problem("the same, published", vec![published])
        .run("Taylor 2⁻⁵²", Taylor::default())
        .outcome
        .unwrap();
    let lambda = lambda.unwrap();
    assert!(
        1e-10 < q && q < 1e-5 && 1e-8 < v && v < 1e-2 && 1e-6 < lambda && lambda < 1e-4,
        "{q:e} {v:e} {lambda:e}"
    );
}
