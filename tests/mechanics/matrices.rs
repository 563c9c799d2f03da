//! The algebra of matrices against nalgebra's, and systems whose Lagrangians are said by matrices.

use approx::assert_relative_eq;
use lagrange_core::nalgebra::{
    Matrix2x3, Matrix3, Quaternion, Rotation, Rotation2, Rotation3, SMatrix, SVector, Unit, UnitQuaternion,
    Vector2, Vector3, Vector4,
};
use lagrange_core::prelude::*;
use lagrange_core::{Lanes, Pack};

#[derive(Lagrangian)]
#[coordinates(r: [3], p: [4], q: [4], x)]
#[define(turns = rot_z(x)*rot_x(2*x))]
#[define(raised(T) = 2^T)]
#[define(made = [[x, 1, 2], [0, x^2, 3], [4, 5, 6]])]
#[define(chain[0] = made)]
#[define(chain[i in 1..4] = chain[i-1]*a)]
#[lagrangian(dot(r_dot, r_dot)/2 + dot(p_dot, p_dot)/2 + dot(q_dot, q_dot)/2 + x_dot^2/2)]
#[observable(row_by_matrix = r*a)]
#[observable(row_by_wide = [x, 2]*wide)]
#[observable(wide_by_matrix = (wide*a)[1])]
#[observable(matrix_by_tall = (a*transpose(wide))[2])]
#[observable(by_column = a*made*r)]
#[observable(between = dot(r*a, r))]
#[observable(no_transpose = raised(3))]
#[observable(transposed = transpose(made)[0])]
#[observable(sum_of_diagonal = trace(made*a))]
#[observable(nothing = (identity(3)*a - a*identity(3))[1])]
#[observable(sum_of_matrices = (made - 2*a/x)[1])]
#[observable(by_skew = skew(r)*r_dot)]
#[observable(by_x = rot_x(x)*r)]
#[observable(by_y = rot_y(x)*r)]
#[observable(by_z = rot_z(x)*r)]
#[observable(about = rot(axis, x)*r)]
#[observable(about_known = rot([1, 2, -2], x)*r)]
#[observable(about_z = (rot([0, 0, 3], x) - rot_z(x))*r)]
#[observable(rate = der(turns)*r)]
#[observable(spin = [(transpose(turns)*der(turns))[2][1], (transpose(turns)*der(turns))[0][2], (transpose(turns)*der(turns))[1][0]])]
#[observable(end_of_chain = chain[3][2])]
#[observable(product = quat_mul(p, q))]
#[observable(conjugate = quat_conj(q))]
struct Kit {
    a: Matrix3<f64>,
    wide: Matrix2x3<f64>,
    axis: Vector3<f64>,
}

const X: f64 = 0.7;
const RATE: f64 = -1.3;

fn kit() -> Kit {
    Kit {
        a: Matrix3::new(1.0, -2.0, 0.5, 3.0, 0.0, 1.5, -1.0, 2.0, 4.0),
        wide: Matrix2x3::new(1.0, 2.0, 3.0, -4.0, 5.0, 0.5),
        axis: Vector3::new(2.0, -1.0, 0.5),
    }
}

fn made() -> Matrix3<f64> {
    Matrix3::new(X, 1.0, 2.0, 0.0, X * X, 3.0, 4.0, 5.0, 6.0)
}

fn r() -> Vector3<f64> {
    Vector3::new(1.0, -2.0, 3.0)
}

fn quaternions() -> [Quaternion<f64>; 2] {
    [Quaternion::new(0.5, -0.25, 1.0, 2.0), Quaternion::new(-1.0, 0.75, 0.5, 1.5)]
}

fn state() -> State<f64, 12> {
    let [p, q] = quaternions().map(|q| [q.w, q.i, q.j, q.k]);
    let mut coordinates = [0.0; 12];
    coordinates[..3].copy_from_slice(r().as_slice());
    coordinates[3..7].copy_from_slice(&p);
    coordinates[7..11].copy_from_slice(&q);
    coordinates[11] = X;
    let mut velocities = [0.0; 12];
    velocities[..3].copy_from_slice(&[0.5, 1.0, -1.0]);
    velocities[11] = RATE;
    State::new(coordinates, velocities)
}

fn assert_near<const K: usize>(found: SVector<f64, K>, expected: SVector<f64, K>) {
    assert!((found - expected).norm() <= 1e-14 * (1.0 + expected.norm()), "{found} instead of {expected}");
}

#[test]
fn matrices_multiply_rows_columns_and_each_other() {
    let (kit, state, a, r) = (kit(), state(), kit().a, r());
    assert_near(kit.row_by_matrix(&state), a.transpose() * r);
    assert_near(kit.row_by_wide(&state), kit.wide.transpose() * Vector2::new(X, 2.0));
    assert_near(kit.wide_by_matrix(&state), (kit.wide * a).row(1).transpose());
    assert_near(kit.matrix_by_tall(&state), (a * kit.wide.transpose()).row(2).transpose());
    assert_near(kit.by_column(&state), a * made() * r);
    assert_relative_eq!(kit.between(&state), r.dot(&(a * r)), max_relative = 1e-14);
    assert_eq!(kit.no_transpose(&state), 8.0);
    assert_near(kit.end_of_chain(&state), (made() * a * a * a).row(2).transpose());
}

#[test]
fn matrices_add_up_and_are_taken_apart() {
    let (kit, state) = (kit(), state());
    assert_near(kit.transposed(&state), made().column(0).into_owned());
    assert_relative_eq!(kit.sum_of_diagonal(&state), (made() * kit.a).trace(), max_relative = 1e-14);
    assert_eq!(kit.nothing(&state), Vector3::zeros());
    assert_near(kit.sum_of_matrices(&state), (made() - kit.a * (2.0 / X)).row(1).transpose());
    assert_near(kit.by_skew(&state), r().cross(&Vector3::new(0.5, 1.0, -1.0)));
}

#[test]
fn rotations_are_those_of_nalgebra() {
    let (kit, state, r) = (kit(), state(), r());
    let about = |axis: Vector3<f64>| Rotation3::from_axis_angle(&Unit::new_normalize(axis), X) * r;
    assert_near(kit.by_x(&state), about(Vector3::x()));
    assert_near(kit.by_y(&state), about(Vector3::y()));
    assert_near(kit.by_z(&state), about(Vector3::z()));
    assert_near(kit.about(&state), about(kit.axis));
    assert_near(kit.about_known(&state), about(Vector3::new(1.0, 2.0, -2.0)));
    assert_eq!(kit.about_z(&state), Vector3::zeros());
}

#[test]
fn quaternions_are_those_of_nalgebra() {
    let (kit, state, [p, q]) = (kit(), state(), quaternions());
    let numbers = |q: Quaternion<f64>| Vector4::new(q.w, q.i, q.j, q.k);
    assert_near(kit.product(&state), numbers(p * q));
    assert_near(kit.conjugate(&state), numbers(q.conjugate()));
}

/// R = rot_z(x) rot_x(2x) turns by ẋ about z of the fixed frame and by 2ẋ about x of its own: Ṙ = ẋ ẑ × R + R (2ẋ x̂ ×).
#[test]
fn a_matrix_has_a_rate() {
    let (kit, state) = (kit(), state());
    let [about_z, about_x] = [Vector3::z() * RATE, Vector3::x() * (2.0 * RATE)];
    let turns = Rotation3::new(Vector3::z() * X) * Rotation3::new(Vector3::x() * (2.0 * X));
    let rate = about_z.cross_matrix() * turns.matrix() + turns.matrix() * about_x.cross_matrix();
    assert_near(kit.rate(&state), rate * r());
    assert_near(kit.spin(&state), about_x + turns.inverse() * about_z);
}

/// A rigid body, by its orientation as a matrix of nine coordinates and RᵀR = 1, six equations.
#[derive(Lagrangian)]
#[coordinates(a: [3], b: [3], c: [3])]
#[define(turn = transpose([a, b, c]))]
#[define(rate = der(turn))]
#[define(metric = transpose(turn)*turn)]
#[lagrangian(trace(rate*spread*transpose(rate))/2)]
#[constraint(lengths: [metric[0][0], metric[1][1], metric[2][2]] = [1, 1, 1])]
#[constraint(angles: [metric[0][1], metric[0][2], metric[1][2]] = 0)]
struct Body {
    /// ∫ x xᵀ dm.
    spread: Matrix3<f64>,
}

/// Euler's equations for it: I ω̇ = −ω × I ω with I = tr(K) 1 − K, and R̈ = R (ω̂² + ω̇̂).
#[test]
fn a_body_by_nine_coordinates_obeys_eulers_equations() {
    let spread = Matrix3::new(1.0, 0.1, 0.2, 0.1, 2.0, -0.3, 0.2, -0.3, 0.5);
    let inertia = Matrix3::identity() * spread.trace() - spread;
    let turn = UnitQuaternion::from_euler_angles(0.4, -0.9, 2.0).to_rotation_matrix().into_inner();
    let w = Vector3::new(0.7, -1.2, 0.4);
    let rate = turn * w.cross_matrix();
    let numbers = |x: &Matrix3<f64>| std::array::from_fn::<f64, 9, _>(|i| x[(i % 3, i / 3)]);
    let state = State::new(numbers(&turn), numbers(&rate));
    let w_dot = inertia.try_inverse().unwrap() * -w.cross(&(inertia * w));
    let expected = turn * (w.cross_matrix() * w.cross_matrix() + w_dot.cross_matrix());
    let found = Body { spread }.solve(&state).unwrap();
    assert_near(found.accelerations, SVector::from(numbers(&expected)));
}

/// A field of each form, each number by its place.
#[derive(Lagrangian, Clone)]
#[coordinates(x, r: [3])]
#[lagrangian(x_dot^2/2 + dot(r_dot, r_dot)/2)]
#[observable(of_matrices = matrices[1]*r + transpose(matrices[0])*r)]
#[observable(of_arrays = arrays[1][0][2] + 10*arrays[0][1][1])]
#[observable(of_vectors = vectors[1] - vectors[0])]
#[observable(of_turn = turn*r)]
#[observable(of_turns = turns[0]*turns[1]*r)]
#[observable(of_plane = plane*[x, 1])]
#[observable(of_unit = quat_rotate(unit, r))]
#[observable(of_units = quat_rotate(quat_mul(units[1], units[0]), r))]
#[observable(of_quaternion = quaternion)]
struct Fields<T: lagrange_core::nalgebra::Scalar> {
    matrices: [SMatrix<T, 3, 3>; 2],
    arrays: [[[T; 3]; 2]; 2],
    vectors: [Vector3<T>; 2],
    turn: Rotation3<T>,
    turns: [Rotation<T, 3>; 2],
    plane: Rotation2<T>,
    unit: UnitQuaternion<T>,
    units: [UnitQuaternion<T>; 2],
    quaternion: Quaternion<T>,
}

fn fields() -> Fields<f64> {
    let turn = |x: f64| Rotation3::from_euler_angles(x, 0.5 - x, 2.0 * x);
    let unit = |x: f64| UnitQuaternion::from_euler_angles(x, 0.3, -x);
    Fields {
        matrices: [kit().a, made()],
        arrays: [[[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], [[7.0, 8.0, 9.0], [10.0, 11.0, 12.0]]],
        vectors: [r(), Vector3::new(0.5, 0.25, 8.0)],
        turn: turn(0.3),
        turns: [turn(1.1), turn(-0.4)],
        plane: Rotation2::new(0.8),
        unit: unit(0.9),
        units: [unit(-1.3), unit(0.2)],
        quaternion: quaternions()[0],
    }
}

#[test]
fn fields_are_read_by_their_indices() {
    let (fields, r) = (fields(), r());
    let state = State::new([X, r.x, r.y, r.z], [0.0; 4]);
    assert_near(fields.of_matrices(&state), fields.matrices[1] * r + fields.matrices[0].transpose() * r);
    assert_eq!(fields.of_arrays(&state), 9.0 + 50.0);
    assert_near(fields.of_vectors(&state), fields.vectors[1] - fields.vectors[0]);
    assert_near(fields.of_turn(&state), fields.turn * r);
    assert_near(fields.of_turns(&state), fields.turns[0] * fields.turns[1] * r);
    assert_near(fields.of_plane(&state), fields.plane * Vector2::new(X, 1.0));
    assert_near(fields.of_unit(&state), fields.unit * r);
    assert_near(fields.of_units(&state), fields.units[1] * fields.units[0] * r);
    let Quaternion { coords } = fields.quaternion;
    assert_near(fields.of_quaternion(&state), Vector4::new(coords.w, coords.x, coords.y, coords.z));
    let names = Fields::<f64>::PARAMETERS;
    assert!(names.contains(&"matrices[1][2][0]") && names.contains(&"units[1][3]"), "{names:?}");
}

/// Each lane has the numbers of its own system.
#[test]
fn rotations_and_quaternions_lie_on_lanes() {
    let (one, other) = (fields(), Fields { turn: fields().turns[0], units: [fields().unit; 2], ..fields() });
    let mut packed: Fields<Lanes> = one.pack();
    assert!(other.place(&mut packed, 2));
    let state = State::new([X, 1.0, -2.0, 3.0], [0.0; 4]);
    let on_lanes = State::new([X, 1.0, -2.0, 3.0].map(Lanes::constant), [Lanes::constant(0.0); 4]);
    let (turned, twice) = (packed.of_turn(&on_lanes), packed.of_units(&on_lanes));
    for lane in 0..Lanes::COUNT {
        let alone = if lane == 2 { &other } else { &one };
        assert_near(turned.map(|x| x.to_array()[lane]), alone.of_turn(&state));
        assert_near(twice.map(|x| x.to_array()[lane]), alone.of_units(&state));
    }
}

/// Derivatives by the numbers of a rotation are known, but one number of it cannot be changed alone.
#[test]
fn a_rotation_stays_one() {
    let mut fields = fields();
    let is_set = Fields::<f64>::PARAMETERS.iter().enumerate().filter(|&(k, _)| fields.set_parameter(k, 7.0));
    let fixed = Fields::<f64>::PARAMETERS.len() - is_set.count();
    assert_eq!(fixed, 9 + 2 * 9 + 4 + 4 + 2 * 4);
    assert_eq!(fields.quaternion, Quaternion::new(7.0, 7.0, 7.0, 7.0));
    assert_eq!(fields.matrices, [SMatrix::<f64, 3, 3>::from_element(7.0); 2]);
}

/// A particle in a frame that is turned by fields: r × ṙ is conserved because these are rotations, of any kind. Where the
/// random numbers of the check were none, this would not compile.
#[derive(Lagrangian)]
#[coordinates(r: [3], s: [3])]
#[define(x = turn*quat_rotate(quaternions[1], r))]
#[define(y = plane*[s[0], s[1]])]
#[lagrangian(
    dot(der(x), der(x))/2 + (dot(der(y), der(y)) + s_dot[2]^2)/2 - k/dot(r, r) - k/dot(s, s)
        + (dot(quaternions[0], quaternions[0]) - 1)*s[2]
)]
#[conserved(spin = cross(r, r_dot))]
#[conserved(other_spin = cross(s, s_dot))]
struct Turned {
    turn: Rotation3<f64>,
    quaternions: [UnitQuaternion<f64>; 2],
    plane: Rotation2<f64>,
    k: f64,
}

/// A body about its centre of mass, in coordinates that are turned against its own.
#[derive(Lagrangian, Clone)]
#[coordinates(q: [4])]
#[parameter(inertia: symmetric)]
#[parameter(turn: rotation)]
#[define(w = turn*quat_rate_body(q, q_dot))]
#[lagrangian(dot(w, inertia[1]*w)/2)]
#[constraint(unit: dot(q, q) = 1)]
#[conserved(spin = quat_rotate(q, transpose(turn)*(inertia[1]*w)))]
#[conserved(other_spin = quat_rotate(q, (w*inertia[1])*turn))]
struct Spinning<T> {
    inertia: [[[T; 3]; 3]; 2],
    turn: Matrix3<T>,
}

fn spinning() -> Spinning<f64> {
    let inertia = [[2.0, 0.1, -0.2], [0.1, 1.5, 0.3], [-0.2, 0.3, 0.7]];
    let turn = Rotation3::from_euler_angles(0.4, 1.0, -2.0).into_inner();
    Spinning { inertia: [[[f64::NAN; 3]; 3], inertia], turn }
}

/// Turning at ω = 2 q̄ q̇ = (0.4, −0.2, 1).
fn spinning_state() -> State<f64, 4> {
    State::new([1.0, 0.0, 0.0, 0.0], [0.0, 0.2, -0.1, 0.5])
}

#[test]
fn what_is_said_of_a_matrix_is_verified() {
    let (good, state) = (spinning(), spinning_state());
    // The numbers on both sides of the diagonal are one parameter.
    let names = Spinning::<f64>::PARAMETERS;
    assert_eq!(names.iter().filter(|name| name.starts_with("inertia")).count(), 6);
    assert!(good.solve(&state).is_ok());
    let fault = |spinning: &Spinning<f64>| match spinning.solve(&state) {
        Err(Error::ParameterNotAsSaid { name, wanted, defect }) => (name, wanted, defect),
        other => panic!("{other:?}"),
    };
    let mut skew = good.clone();
    skew.inertia[1][2][0] += 5e-3;
    let (name, wanted, defect) = fault(&skew);
    assert_eq!((name, wanted), ("inertia[1]", "symmetric"));
    assert_relative_eq!(defect, 0.01 / 5.395, max_relative = 1e-12);
    let error = skew.integrate(state, 1.0, Dop853::default()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the parameter `inertia[1]` is not symmetric: it is off by 1.9e-3 of its size"
    );
    assert!(skew.motion_in_momenta(skew.phase_state(&state)).to(1.0).is_err());
    // The other matrix is not in use, and round-off is no fault.
    skew.inertia[1][2][0] = good.inertia[1][0][2] * (1.0 + 1e-13);
    assert!(skew.solve(&state).is_ok());
    for (i, j, factor) in [(0, 0, 1.001), (2, 1, 0.99)] {
        let mut bent = good.clone();
        bent.turn[(i, j)] *= factor;
        assert_eq!(fault(&bent).1, "a rotation");
    }
    let mirrored = Spinning { turn: -good.turn, ..good.clone() };
    assert_eq!(fault(&mirrored).0, "turn");
}
