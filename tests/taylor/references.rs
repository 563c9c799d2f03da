//! Motions against values of runs of another Taylor method with 113 and 170 bits, of which 20 digits agree.

use lagrange_core::nalgebra::{Const, Matrix3, SVector, Vector3};
use lagrange_core::{TaylorSeries, prelude::*};

/// The largest difference from what is known at this time, between the steps.
fn off<L, const N: usize>(path: &Trajectory<&L>, t: f64, [q, v]: [[f64; N]; 2]) -> Result<f64, Error>
where
    L: TaylorSeries<N = Const<N>, Scalar = f64>,
{
    let sample = path.at(t)?;
    let state = sample.state();
    let off = (state.q - SVector::from(q)).amax().max((state.v - SVector::from(v)).amax());
    println!("{} at {t}: {off:e}", L::NAME);
    Ok(off)
}

#[derive(Lagrangian)]
#[coordinates(a, b)]
#[lagrangian(a_dot^2 + b_dot^2/2 + a_dot*b_dot*cos(a - b) + 2*g*cos(a) + g*cos(b))]
struct Double {
    g: f64,
}

/// The start is amplified 43 times until t = 10.
#[test]
fn a_double_pendulum_that_swings() -> Result<(), Error> {
    let pendulum = Double { g: 9.81 };
    let path = pendulum.integrate(State::at_rest([0.5, -0.3]), 10.0, Taylor::default())?;
    let known = [
        (
            1.0,
            [
                [-0.035_279_954_660_697_96, -0.254_824_827_543_254_64],
                [1.777_825_196_998_367_6, -3.043_351_243_762_965_7],
            ],
        ),
        (
            5.0,
            [
                [0.327_593_287_337_393_8, -0.102_325_643_254_532_94],
                [1.685_398_973_127_354_9, -1.927_621_935_047_476_4],
            ],
        ),
        (
            10.0,
            [
                [-0.107_542_332_622_360_97, 0.387_937_148_385_276_4],
                [1.800_047_274_824_571_5, -1.734_236_997_103_352],
            ],
        ),
    ];
    for (t, state) in known {
        assert!(off(&path, t, state)? < 1e-12);
    }
    Ok(())
}

#[derive(Lagrangian)]
#[coordinates(x1, y1, x2, y2)]
#[lagrangian((x1_dot^2 + y1_dot^2 + x2_dot^2 + y2_dot^2)/2 - g*(y1 + y2))]
#[constraint(upper: x1^2 + y1^2 = 1)]
#[constraint(lower: (x2 - x1)^2 + (y2 - y1)^2 = 1)]
struct Rods {
    g: f64,
}

/// What the rods pull with, between the steps.
#[test]
fn multipliers_are_known_at_all_times() -> Result<(), Error> {
    let rods = Rods { g: 9.81 };
    let path = rods.integrate(State::at_rest([1.0, 0.0, 2.0, 0.0]), 5.0, Taylor::default())?;
    let known = [
        (1.0, [-20.818_039_436_294_907, -9.972_929_848_254_504]),
        (2.0, [-13.489_181_708_643_58, -6.670_901_799_900_733]),
        (5.0, [-13.202_418_882_577_835, -8.924_466_745_186_221]),
    ];
    for (t, known) in known {
        let sample = path.at(t)?;
        let off = [sample.multiplier("upper")? - known[0], sample.multiplier("lower")? - known[1]];
        println!("{t}: {off:?}");
        assert!(off.iter().all(|off| off.abs() < 1e-12), "{t}: {off:?}");
    }
    Ok(())
}

/// A heavy symmetric top in Euler's angles.
#[derive(Lagrangian)]
#[coordinates(phi, theta, psi)]
#[lagrangian(a/2*(theta_dot^2 + phi_dot^2*sin(theta)^2) + c/2*(psi_dot + phi_dot*cos(theta))^2 - w*cos(theta))]
struct Top {
    a: f64,
    c: f64,
    w: f64,
}

/// The same top, its weight 1 above the point that stands still, about which its inertia is.
#[derive(Lagrangian)]
#[coordinates(q: [4])]
#[frame(body: rotate(q))]
#[lagrangian(kinetic(body, 0, [0, 0, 0], inertia) - w*position(body, [0, 0, 1])[2])]
struct TopInSpace {
    inertia: Matrix3<f64>,
    w: f64,
}

/// The quaternion of Euler's angles, about z, x and z, and its rate.
fn quaternion([phi, theta, psi]: [f64; 3], [phi_dot, theta_dot, psi_dot]: [f64; 3]) -> State<f64, 4> {
    let ((s, c), (sum, sum_dot), (apart, apart_dot)) = (
        (theta / 2.0).sin_cos(),
        ((phi + psi) / 2.0, (phi_dot + psi_dot) / 2.0),
        ((phi - psi) / 2.0, (phi_dot - psi_dot) / 2.0),
    );
    let ((ss, cs), (sa, ca)) = (sum.sin_cos(), apart.sin_cos());
    let (s_dot, c_dot) = (c * theta_dot / 2.0, -s * theta_dot / 2.0);
    let q = [c * cs, s * ca, s * sa, c * ss];
    let v = [
        c_dot * cs - c * ss * sum_dot,
        s_dot * ca - s * sa * apart_dot,
        s_dot * sa + s * ca * apart_dot,
        c_dot * ss + c * cs * sum_dot,
    ];
    State::new(q, v)
}

/// Both tops from a start to t = 10, where the angles and their rates are known.
fn heavy_top(rates: [f64; 3], known: [[f64; 3]; 2]) -> Result<(), Error> {
    let (a, c, w) = (0.4, 0.25, 2.0);
    let start = [0.0, 0.6, 0.0];
    let top = Top { a, c, w };
    let path = top.integrate(State::new(start, rates), 10.0, Taylor::default())?;
    assert!(off(&path, 10.0, known)? < 1e-11);

    let top = TopInSpace { inertia: Matrix3::from_diagonal(&Vector3::new(a, a, c)), w };
    let path = top.integrate(quaternion(start, rates), 10.0, Taylor::default())?;
    let known = quaternion(known[0], known[1]);
    assert!(off(&path, 10.0, [known.q.into(), known.v.into()])? < 1e-11);
    Ok(())
}

/// Its axis comes to rest once in each nutation.
#[test]
fn a_heavy_top_that_stops_and_goes_on() -> Result<(), Error> {
    heavy_top(
        [0.0, 0.0, 20.0],
        [
            [4.137_625_742_300_713, 0.609_593_017_856_764_5, 196.655_189_092_703_67],
            [0.208_000_363_755_802_66, -0.200_906_469_091_832_46, 19.829_464_433_632_264],
        ],
    )
}

#[test]
fn a_heavy_top_on_a_wave() -> Result<(), Error> {
    heavy_top(
        [3.0, 0.0, 12.0],
        [
            [5.585_891_628_307_535, 0.591_313_973_914_920_4, 140.907_367_513_442_07],
            [2.936_002_836_889_697_8, 0.376_735_837_482_993_5, 12.038_511_105_922_59],
        ],
    )
}

/// No force: energy and the angular momentum in space lead it.
#[test]
fn a_free_body_without_symmetry() -> Result<(), Error> {
    let inertia = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 3.0));
    let start = quaternion(
        [0.0, 1.2, 0.3],
        [0.946_824_320_193_854_5, 0.145_718_430_321_170_74, 0.756_910_865_450_651_9],
    );
    let body = TopInSpace { inertia, w: 0.0 };
    let path = body.integrate(start, 30.0, Taylor::default())?;
    let known = quaternion(
        [-0.545_207_115_432_375_9, 0.642_716_949_022_687_2, 39.866_596_608_405_05],
        [-0.605_663_828_267_342_4, 0.817_445_876_306_949_9, 1.646_283_040_118_199_4],
    );
    assert!(off(&path, 30.0, [known.q.into(), known.v.into()])? < 1e-12);
    Ok(())
}
