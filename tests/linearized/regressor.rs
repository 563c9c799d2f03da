//! Regressors of inertial parameters, and the combinations of these that can be found.

use lagrange_core::linearized::{BaseParameters, Regressor};
use lagrange_core::nalgebra::{DMatrix, DVector, Matrix3, SVector, Vector3};
use lagrange_core::prelude::*;

use lagrange_random::Random;

#[derive(Clone, Copy)]
struct Body {
    m: f64,
    centre: Vector3<f64>,
    inertia: Matrix3<f64>,
}

fn body(random: &mut Random) -> Body {
    let mut vector = || Vector3::from(random.vector::<3>());
    let (centre, [a, b, c]) = (vector(), [0, 1, 2].map(|_| vector()));
    let root = Matrix3::from_columns(&[a, b, c]);
    Body { m: 2.0 + random.number(), centre, inertia: root * root.transpose() }
}

/// A PUMA 560 by the convention of Denavit and Hartenberg, with the lengths of B. Armstrong, O. Khatib and J. Burdick, "The
/// explicit dynamic model and inertial parameters of the PUMA 560 arm", ICRA 1986. Its first axis is vertical.
#[derive(Clone, Lagrangian)]
#[coordinates(q: [6])]
#[define(a = [0, 0.4318, 0.0203, 0, 0, 0])]
#[define(d = [0, 0.2435, -0.0934, 0.4331, 0, 0])]
#[define(alpha = [pi/2, 0, -pi/2, pi/2, -pi/2, 0])]
#[frame(link[0]: rotate_z(q[0]), translate([a[0], 0, d[0]]), rotate_x(alpha[0]))]
#[frame(link[i in 1..6] in link[i-1]: rotate_z(q[i]), translate([a[i], 0, d[i]]), rotate_x(alpha[i]))]
#[parameter(body: [6] {m, centre: [3], inertia: symmetric})]
#[lagrangian(sum(i in 0..6,
    kinetic(link[i], body[i].m, body[i].centre, body[i].inertia) - body[i].m*g*position(link[i], body[i].centre)[2]
))]
#[dissipation(c/2*sum(i in 0..6, q_dot[i]^2))]
#[force(q: torque)]
struct Puma {
    body: [Body; 6],
    g: f64,
    c: f64,
    torque: SVector<f64, 6>,
}

const LINKS: [&str; 6] = ["body[0]", "body[1]", "body[2]", "body[3]", "body[4]", "body[5]"];

fn puma(random: &mut Random) -> Puma {
    let bodies = [0; 6].map(|_| body(random));
    Puma { body: bodies, g: 9.81, c: 0.3, torque: random.vector::<6>().into() }
}

fn somewhere<const N: usize>(random: &mut Random) -> (State<f64, N>, SVector<f64, N>) {
    let mut all = |size: f64| core::array::from_fn(|_| size * random.number());
    (State::new(all(3.0), all(2.0)), all(5.0).into())
}

#[test]
fn forces_are_those_of_the_regressor() {
    let mut random = Random(1);
    for _ in 0..200 {
        let puma = puma(&mut random);
        let (state, accelerations) = somewhere(&mut random);
        let regressor = puma.regressor(&state, &accelerations, &LINKS).unwrap();
        let found = &regressor.matrix * puma.inertial_parameters(&LINKS).unwrap() + &regressor.offset;
        let exact = puma.inverse_dynamics(&state, &accelerations, &SVector::zeros());
        let off = (found - DVector::from_column_slice(exact.as_slice())).amax();
        assert!(off < 1e-13 * exact.amax(), "off by {off:e} of {:e}", exact.amax());
        // What is no body is damping and torque.
        let others = puma.c * state.v - puma.torque;
        assert!(
            (regressor.offset - DVector::from_column_slice(others.as_slice())).amax() < 1e-13 * others.amax()
        );
    }
}

/// The number of independent columns by singular values.
fn rank(regressors: &[Regressor<f64>]) -> usize {
    let rows: Vec<_> = regressors
        .iter()
        .flat_map(|regressor| {
            let matrix = regressor.along_free().0;
            (0..matrix.nrows()).map(move |i| matrix.row(i).into_owned()).collect::<Vec<_>>()
        })
        .collect();
    DMatrix::from_rows(&rows).svd(false, false).rank(1e-9)
}

/// The published number, 36: M. Gautier, "Numerical calculation of the base inertial parameters of robots", *Journal of Robotic
/// Systems* 8, 1991; H. Mayeda, K. Yoshida and K. Osuka, "Base parameters of manipulator dynamic models", *IEEE Transactions on Robotics
/// and Automation* 6, 1990.
#[test]
fn a_puma_has_36_base_parameters() {
    let mut random = Random(1);
    let arm = puma(&mut random);
    let regressors: Vec<_> = (0..40)
        .map(|_| {
            let (state, accelerations) = somewhere(&mut random);
            arm.regressor(&state, &accelerations, &LINKS).unwrap()
        })
        .collect();
    let base = BaseParameters::of(&regressors).unwrap();
    // Masses are regrouped by lengths.
    assert!(base.combinations.amax() < 2.1, "{base}");
    assert_eq!((base.count(), rank(&regressors)), (36, 36));
    // The combinations give the same forces, elsewhere too.
    for _ in 0..100 {
        let arm = puma(&mut random);
        let (state, accelerations) = somewhere(&mut random);
        let regressor = arm.regressor(&state, &accelerations, &LINKS).unwrap();
        let beta = &base.combinations * arm.inertial_parameters(&LINKS).unwrap();
        let found = base.columns(&regressor) * beta + &regressor.offset;
        let exact = arm.inverse_dynamics(&state, &accelerations, &SVector::zeros());
        assert!((found - DVector::from_column_slice(exact.as_slice())).amax() < 1e-12 * exact.amax());
    }
}

/// A parallelogram of four bars in a vertical plane, cut open at a joint, whose cut is a constraint.
#[derive(Clone, Lagrangian)]
#[coordinates(q: [3])]
#[frame(left: rotate_z(q[0]))]
#[frame(coupler in left: translate([l, 0, 0]), rotate_z(q[1]))]
#[frame(right: translate([w, 0, 0]), rotate_z(q[2]))]
#[parameter(a: {m, centre: [3], inertia: symmetric})]
#[parameter(b: {m, centre: [3], inertia: symmetric})]
#[parameter(c: {m, centre: [3], inertia: symmetric})]
#[lagrangian(
    kinetic(left, a.m, a.centre, a.inertia) + kinetic(coupler, b.m, b.centre, b.inertia) + kinetic(right, c.m, c.centre, c.inertia)
    - g*(a.m*position(left, a.centre)[1] + b.m*position(coupler, b.centre)[1] + c.m*position(right, c.centre)[1])
)]
#[define(gap = position(coupler, [w, 0, 0]) - position(right, [l, 0, 0]))]
#[constraint(closed: [gap[0], gap[1]] = 0)]
#[force(q: torque)]
struct Bars {
    a: Body,
    b: Body,
    c: Body,
    l: f64,
    w: f64,
    g: f64,
    torque: [f64; 3],
}

/// The bars of a parallelogram move as one body: q₁ = −q₀ and q₂ = q₀. Three combinations can be found: the inertia I(a) +
/// I(c) + m(b) l², and the moments along and across that gravity acts on; the coupler does not turn.
#[test]
fn a_parallelogram_has_three_base_parameters() {
    let mut random = Random(1);
    let [a, b, c] = [0; 3].map(|_| body(&mut random));
    let bars = Bars { a, b, c, l: 0.7, w: 1.1, g: 9.81, torque: [0.4, 0.0, -0.3] };
    let names = ["a", "b", "c"];
    let regressors: Vec<_> = (0..20)
        .map(|k| {
            let (angle, speed) = (0.25 * f64::from(k) - 2.4, 1.0 + (1.7 * f64::from(k)).sin());
            let state = State::new([angle, -angle, angle], [speed, -speed, speed]);
            let moved = bars.solve(&state).unwrap().accelerations;
            let regressor = bars.regressor(&state, &moved, &names).unwrap();
            // The motion satisfies its equation along what is free, with the torques in the offset.
            let (matrix, offset) = regressor.along_free();
            assert_eq!(matrix.nrows(), 1);
            let left = matrix * bars.inertial_parameters(&names).unwrap() + offset;
            assert!(left.amax() < 1e-11, "{left}");
            regressor
        })
        .collect();
    let base = BaseParameters::of(&regressors).unwrap();
    let told: Vec<String> = base.to_string().lines().map(String::from).collect();
    assert_eq!(
        told,
        [
            "I(a)[2][2] + 0.49 m(b) + 1 I(c)[2][2]",
            "mc(a)[0] + 0.7 m(b) + 1 mc(c)[0]",
            "mc(a)[1] + 1 mc(c)[1]",
        ]
    );
}

/// Base parameters are found from torques with noise. In 100 runs each is within three of its standard errors in 95 or more, and
/// within one in 50 to 85.
#[test]
fn parameters_are_identified_within_their_errors() {
    let mut random = Random(7);
    let arm = puma(&mut random);
    // Torques of the motors at 60 states, less those of damping, which is known.
    let (regressors, torques): (Vec<_>, Vec<_>) = (0..60)
        .map(|_| {
            let (state, accelerations) = somewhere::<6>(&mut random);
            let unloaded = Puma { torque: SVector::zeros(), c: 0.0, ..arm.clone() };
            let regressor = unloaded.regressor(&state, &accelerations, &LINKS).unwrap();
            (regressor, unloaded.inverse_dynamics(&state, &accelerations, &SVector::zeros()))
        })
        .unzip();
    let base = BaseParameters::of(&regressors).unwrap();
    let exact = &base.combinations * arm.inertial_parameters(&LINKS).unwrap();
    let rows: Vec<_> = regressors.iter().map(|regressor| base.columns(regressor)).collect();
    let stacked = DMatrix::from_fn(6 * rows.len(), base.count(), |i, j| rows[i / 6][(i % 6, j)]);
    let inverse = (stacked.transpose() * &stacked).try_inverse().unwrap();
    let (noise, mut within) = (0.5, vec![[0, 0]; base.count()]);
    for _ in 0..100 {
        let measured = DVector::from_fn(6 * rows.len(), |i, _| {
            let normal: f64 = (0..12).map(|_| random.between(-0.5, 0.5)).sum();
            torques[i / 6][i % 6] + noise * normal
        });
        let found = &inverse * stacked.tr_mul(&measured);
        for (j, within) in within.iter_mut().enumerate() {
            let off = (found[j] - exact[j]).abs() / (noise * inverse[(j, j)].sqrt());
            within[0] += usize::from(off < 3.0);
            within[1] += usize::from(off < 1.0);
        }
    }
    assert!(within.iter().all(|[three, one]| *three >= 95 && (50..=85).contains(one)), "{within:?}");
}

/// A body whose mass does more than it should, and one that cannot be set.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[frame(cart: translate([x, 0, 0]))]
#[parameter(odd: {m, centre: [3], inertia: symmetric})]
#[lagrangian(kinetic(cart, odd.m, odd.centre, odd.inertia) - odd.m^2*x^2/2)]
struct Odd {
    odd: Body,
}

/// The inertia of a body may be any matrix, of which the symmetric part counts.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[frame(wheel: rotate_z(x))]
#[parameter(body: {m, centre: [3], inertia: [3, 3]})]
#[lagrangian(kinetic(wheel, body.m, body.centre, body.inertia))]
struct Loose {
    body: Body,
}

#[test]
fn what_is_no_body_is_refused() {
    let mut random = Random(1);
    let odd = Odd { odd: body(&mut random) };
    let state = State::new([0.3], [0.2]);
    let told = |bodies: &[&str]| odd.regressor(&state, &[1.0].into(), bodies).unwrap_err().to_string();
    assert!(told(&["odd"]).contains("not linear in the masses"), "{}", told(&["odd"]));
    // The name of a frame, one with a slip, and another.
    assert!(told(&["od"]).ends_with("`od`: did you mean `odd`?"), "{}", told(&["od"]));
    assert!(told(&["dod"]).ends_with("`dod`: did you mean `odd`?"), "{}", told(&["dod"]));
    assert!(told(&["wheels"]).ends_with("`wheels`: there are `odd`"), "{}", told(&["wheels"]));
    assert!(told(&["odd.inertia"]).ends_with("there are `odd`"), "{}", told(&["odd.inertia"]));
    // At m = 2 its derivative is that at m = 1 of another law.
    for m in [0.0, 1.0, 2.0] {
        let odd = Odd { odd: Body { m, ..odd.odd } };
        let error = odd.regressor(&state, &[1.0].into(), &["odd"]).unwrap_err().to_string();
        assert!(error.contains("not linear in the masses"), "{m}: {error}");
    }
    let loose = Loose { body: odd.odd };
    let error = loose.regressor(&state, &[1.0].into(), &["body"]).unwrap_err().to_string();
    assert!(error.contains("`inertia: symmetric`"), "{error}");
    assert!(told(&["odd", "odd"]).contains("`odd`"));
    let puma = puma(&mut random);
    let (state, accelerations) = somewhere(&mut random);
    let one = puma.regressor(&state, &accelerations, &LINKS[..1]).unwrap();
    let all = puma.regressor(&state, &accelerations, &LINKS).unwrap();
    assert!(BaseParameters::of(&[one, all]).unwrap_err().to_string().contains("different bodies"));
    assert_eq!(BaseParameters::<f64>::of(&[]).unwrap().count(), 0);
}

/// Joints that hardly move do not say whether some parameter matters.
#[test]
fn states_that_hardly_differ_do_not_decide() {
    let mut random = Random(1);
    let arm = puma(&mut random);
    let regressors: Vec<_> = (0..40)
        .map(|_| {
            let (state, _) = somewhere::<6>(&mut random);
            let resting = State { q: state.q * 1e-6, v: SVector::zeros(), ..state };
            arm.regressor(&resting, &SVector::zeros(), &LINKS).unwrap()
        })
        .collect();
    let error = BaseParameters::of(&regressors).map(|base| base.count()).unwrap_err().to_string();
    assert!(error.contains("it is not decided whether"), "{error}");
}
