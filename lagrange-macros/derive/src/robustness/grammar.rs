//! Random combinations of the language's forms. Most names are declared; shapes fit by chance.

use lagrange_random::Random;

const NUMBERS: [&str; 10] = ["0", "1", "2", "3", "0.5", "9.81", "1e-3", "1_000", "6.62607015e-34", "1e300"];
const SCALARS: [&str; 12] =
    ["x", "y", "x_dot", "y_dot", "m", "k", "r[0]", "r_dot[2]", "t", "pi", "A[0][1]", "d"];
const VECTORS: [&str; 7] = ["r", "r_dot", "g", "A[1]", "v", "position(body)", "q[0..3]"];
const MATRICES: [&str; 5] = ["A", "identity(3)", "skew(r)", "rot_z(x)", "transpose(A)"];
const FUNCTIONS: [&str; 14] =
    ["sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "exp", "ln", "sqrt", "abs", "der"];

/// Draws a system whose parts are more often right than wrong.
pub(super) fn system(random: &mut Random) -> String {
    let mut attributes = vec![
        "coordinates(x, y, r: [3], q: [4])".to_owned(),
        "frame(body: translate(r), rotate(q))".to_owned(),
        format!("define(d = {})", scalar(random, 2)),
        format!("define(v = {})", vector(random, 2)),
    ];
    attributes.push(format!("define(f(a, b) = a*{} + b)", scalar(random, 1)));
    let kinetic = "m/2*(x_dot^2 + y_dot^2) + kinetic(body, m, [0, 0, 0], A)";
    attributes.push(format!("lagrangian({kinetic} + {})", scalar(random, 3)));
    for _ in 0..random.below(3) {
        attributes.push(attribute(random));
    }
    let attributes: String = attributes.iter().map(|attribute| format!("#[{attribute}]\n")).collect();
    format!("{attributes}struct System {{ m: f64, k: f64, g: [f64; 3], A: [[f64; 3]; 3] }}")
}

fn attribute(random: &mut Random) -> String {
    match random.below(12) {
        0 => format!("constraint(c: {} = {})", scalar(random, 2), scalar(random, 1)),
        1 => format!("constraint(c: {} = {})", vector(random, 1), vector(random, 1)),
        2 => format!("constraint(c[i in 0..{}]: r[i] = {})", random.below(4), scalar(random, 2)),
        3 => format!("force({}: {})", scalar(random, 0), scalar(random, 3)),
        4 => format!("force(r: {})", vector(random, 2)),
        5 => format!("power({}, {})", vector(random, 1), vector(random, 1)),
        6 => format!("dissipation({})", scalar(random, 3)),
        7 => format!("observable(o = {})", any(random, 3)),
        8 => format!("observable(o[i in 0..2] = {})", any(random, 2)),
        9 => format!("conserved(e = {})", scalar(random, 2)),
        10 => format!(
            "parameter({}: {})",
            scalar(random, 0),
            random.one_of(&["symmetric", "rotation", "0..2", "{m}"])
        ),
        _ => format!("define(w = {})", any(random, 3)),
    }
}

/// Draws an expression of random shape, instead of the required one.
fn any(random: &mut Random, depth: usize) -> String {
    match random.below(3) {
        0 => scalar(random, depth),
        1 => vector(random, depth),
        _ => matrix(random, depth),
    }
}

fn scalar(random: &mut Random, depth: usize) -> String {
    if depth == 0 {
        return if random.once_in(3) { random.one_of(&NUMBERS) } else { random.one_of(&SCALARS) }.to_owned();
    }
    let below = depth - 1;
    match random.below(40) {
        0 => any(random, below),
        1..9 => binary(random, below, scalar),
        9..18 => format!("{}({})", random.one_of(&FUNCTIONS), scalar(random, below)),
        18..21 => format!(
            "({})^{}",
            scalar(random, below),
            random.one_of(&["2", "3", "-1", "0", "0.5", "(1/3)", "-2", "x"])
        ),
        21 => format!("-{}", scalar(random, below)),
        22..25 => format!("dot({}, {})", vector(random, below), vector(random, below)),
        25 | 26 => format!("norm({})", vector(random, below)),
        27 => format!("trace({})", matrix(random, below)),
        28 | 29 => format!("{}[{}]", vector(random, below), random.below(4)),
        30 | 31 => format!(
            "sum(i in {}..{}, {})",
            random.below(2),
            random.below(4),
            random.one_of(&["r[i]*i", "g[i]*r_dot[i]", "A[i][i]^i"])
        ),
        32 => format!("f({}, {})", scalar(random, below), scalar(random, below)),
        33 => format!("atan2({}, {})", scalar(random, below), scalar(random, below)),
        34 => format!(
            "{}({}, {})",
            random.one_of(&["min", "max"]),
            scalar(random, below),
            scalar(random, below)
        ),
        35 => format!(
            "kinetic(body, {}, {}, {})",
            scalar(random, 0),
            vector(random, below),
            matrix(random, below)
        ),
        36 => random
            .one_of(&["x_ddot", "lambda(c)", "r_ddot[1]", "q_dot[0]", "unknown", "d_dot", "clamp(x, 0, 1)"])
            .to_string(),
        _ => scalar(random, 0),
    }
}

fn vector(random: &mut Random, depth: usize) -> String {
    if depth == 0 {
        return random.one_of(&VECTORS).to_string();
    }
    let below = depth - 1;
    match random.below(12) {
        0 => any(random, below),
        1 => format!("[{}, {}, {}]", scalar(random, below), scalar(random, below), scalar(random, below)),
        2 => format!("({} + {})", vector(random, below), vector(random, below)),
        3 => format!("({})*{}", scalar(random, below), vector(random, below)),
        4 => format!("({})*{}", matrix(random, below), vector(random, below)),
        5 => format!("cross({}, {})", vector(random, below), vector(random, below)),
        6 => format!("quat_rotate(q, {})", vector(random, below)),
        7 => format!("der({})", vector(random, below)),
        8 => format!("velocity(body, {})", vector(random, below)),
        9 => format!("position(body, {})", vector(random, below)),
        10 => random
            .one_of(&["quat_rate(q, q_dot)", "angular_velocity(body)", "vector(body, g)", "0"])
            .to_string(),
        _ => vector(random, 0),
    }
}

fn matrix(random: &mut Random, depth: usize) -> String {
    if depth == 0 {
        return random.one_of(&MATRICES).to_string();
    }
    let below = depth - 1;
    match random.below(6) {
        0 => binary(random, below, matrix),
        1 => format!("rot({}, {})", vector(random, below), scalar(random, below)),
        2 => format!("[{}, {}, {}]", vector(random, below), vector(random, below), vector(random, below)),
        3 => format!("skew({})", vector(random, below)),
        4 => format!("jacobian({})", vector(random, below)),
        _ => matrix(random, 0),
    }
}

fn binary(random: &mut Random, depth: usize, operand: fn(&mut Random, usize) -> String) -> String {
    format!(
        "({} {} {})",
        operand(random, depth),
        random.one_of(&["+", "-", "*", "/"]),
        operand(random, depth)
    )
}
