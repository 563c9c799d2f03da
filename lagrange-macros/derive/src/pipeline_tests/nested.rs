//! A chain costs as much as a recursion over its links, even if its source contains sums instead.

use super::bodies::least;
use super::equations;
use crate::codegen::solutions;
use crate::symbolic::Symbol;
use crate::variables::Variable;

const LAGRANGIAN: &str = "#[lagrangian(sum(i in 0..N, m[i]/2*(vx[i]^2 + vy[i]^2) - m[i]*g*y[i]))]";
const OF_PLACES: &str = "#[lagrangian(sum(i in 0..N, m[i]/2*dot(der(r[i]), der(r[i])) - m[i]*g*r[i][1]))]";

/// Chains with each link defined from the one before: by velocities and heights, by joints and centres, by relative
/// angles.
const RECURSION: &str = "#[define(vx[0] = l[0]*cos(theta[0])*theta_dot[0])]
    #[define(vx[i in 1..N] = vx[i-1] + l[i]*cos(theta[i])*theta_dot[i])]
    #[define(vy[0] = l[0]*sin(theta[0])*theta_dot[0])]
    #[define(vy[i in 1..N] = vy[i-1] + l[i]*sin(theta[i])*theta_dot[i])]
    #[define(y[0] = -l[0]*cos(theta[0]))] #[define(y[i in 1..N] = y[i-1] - l[i]*cos(theta[i]))]";
const RECURSION_OF_CENTRES: &str = "#[define(joint[0] = [0, 0])]
    #[define(joint[i in 1..N] = joint[i-1] + l[i-1]*[sin(theta[i-1]), -cos(theta[i-1])])]
    #[define(r[i in 0..N] = joint[i] + c[i]*[sin(theta[i]), -cos(theta[i])])]";
const RECURSION_OF_ANGLES: &str = "#[define(phi[0] = theta[0])] #[define(phi[i in 1..N] = phi[i-1] + theta[i])]
    #[define(r[0] = l[0]*[sin(phi[0]), -cos(phi[0])])] #[define(r[i in 1..N] = r[i-1] + l[i]*[sin(phi[i]), -cos(phi[i])])]";

fn chain(n: usize, attributes: &[&str]) -> String {
    let attributes =
        attributes.join("\n").replace("0..N", &format!("0..{n}")).replace("1..N", &format!("1..{n}"));
    format!(
        "#[coordinates(theta: [{n}])] {attributes} struct Chain {{ m: [f64; {n}], l: [f64; {n}], c: [f64; {n}], g: f64 }}"
    )
}

/// Writes every sum term by term, in an order that no recursion has. The length must not be a multiple of 3.
fn written_out(n: usize) -> String {
    let order = (0..n).map(|k| (k * 3 + 1) % n);
    let sum = |name: &str, i: usize, term: &dyn Fn(usize) -> String| {
        let terms: Vec<String> = (0..=i).rev().map(term).collect();
        format!("#[define({name}_{i} = {})]\n", terms.join(" + "))
    };
    let mut text = String::new();
    for i in order {
        text += &sum("vx", i, &|j| format!("theta_dot[{j}]*cos(theta[{j}])*l[{j}]"));
        text += &sum("y", i, &|j| format!("(-cos(theta[{j}])*l[{j}])"));
        text += &sum("vy", i, &|j| format!("l[{j}]*theta_dot[{j}]*sin(theta[{j}])"));
    }
    let terms: Vec<String> =
        (0..n).map(|i| format!("m[{i}]/2*(vx_{i}^2 + vy_{i}^2) - m[{i}]*g*y_{i}")).collect();
    format!("{text} #[lagrangian({})]", terms.join(" + "))
}

/// Chains written with sums, each with its recursion and the largest accepted ratio of operation counts.
fn spellings(n: usize) -> Vec<(String, String, f64)> {
    let recursion = [RECURSION, LAGRANGIAN];
    let velocities = "#[define(vx[i in 0..N] = sum(j in 0..i+1, l[j]*cos(theta[j])*theta_dot[j]))]
        #[define(vy[i in 0..N] = sum(j in 0..i+1, l[j]*sin(theta[j])*theta_dot[j]))]
        #[define(y[i in 0..N] = -sum(j in 0..i+1, l[j]*cos(theta[j])))]";
    let places = "#[define(r[i in 0..N] = sum(j in 0..i+1, l[j]*[sin(theta[j]), -cos(theta[j])]))]";
    let nameless = "#[lagrangian(sum(i in 0..N, m[i]/2*(sum(j in 0..i+1, l[j]*cos(theta[j])*theta_dot[j])^2
        + sum(j in 0..i+1, l[j]*sin(theta[j])*theta_dot[j])^2) + m[i]*g*sum(j in 0..i+1, l[j]*cos(theta[j]))))]";
    let centres = "#[define(x[i in 0..N] = sum(j in 0..i, l[j]*sin(theta[j])) + c[i]*sin(theta[i]))]
        #[define(y[i in 0..N] = -sum(j in 0..i, l[j]*cos(theta[j])) - c[i]*cos(theta[i]))]
        #[define(r[i in 0..N] = [x[i], y[i]])]";
    let angles = "#[define(phi[i in 0..N] = sum(j in 0..i+1, theta[j]))]
        #[define(r[i in 0..N] = sum(j in 0..i+1, l[j]*[sin(phi[j]), -cos(phi[j])]))]";
    vec![
        (chain(n, &[velocities, LAGRANGIAN]), chain(n, &recursion), 1.01),
        (chain(n, &[places, OF_PLACES]), chain(n, &recursion), 1.01),
        (chain(n, &[&written_out(n)]), chain(n, &recursion), 1.03),
        (chain(n, &[nameless]), chain(n, &recursion), 1.25),
        (chain(n, &[centres, OF_PLACES]), chain(n, &[RECURSION_OF_CENTRES, OF_PLACES]), 1.08),
        (chain(n, &[angles, OF_PLACES]), chain(n, &[RECURSION_OF_ANGLES, OF_PLACES]), 1.01),
    ]
}

#[test]
fn sums_cost_what_recursions_cost() {
    for n in [5, 10, 20] {
        for (sums, recursion, most) in spellings(n) {
            let [by_sums, by_recursion] = [&sums, &recursion].map(|source| least(source));
            println!("{n} links: {by_sums} operations, by the recursion {by_recursion}");
            assert!(by_sums as f64 <= most * by_recursion as f64, "{by_sums}, {by_recursion}: {sums}");
        }
    }
}

/// Accelerations at five states. Of the forms in which the equations are solved, the last takes the fewest operations.
fn accelerations(source: &str, n: usize) -> Vec<Vec<f64>> {
    let (graph, problem, equations) = equations(source);
    let at = |point: u64| {
        let input = |symbol: Symbol| {
            // Values go by name, because parameters are numbered in the order of their first use.
            let (index, low, width) = match Variable::of(symbol) {
                Variable::Parameter(k) => {
                    let name = problem.parameters.name(k);
                    let code = name.bytes().fold(0, |code, byte| code * 31 + u32::from(byte));
                    (code % 100_000, 0.5, 1.0)
                }
                _ => (symbol.index, -1.0, 2.0),
            };
            let place = u64::from(symbol.family) * 977 + u64::from(index) * 131 + point * 7_919;
            low + width * (place as f64 * 0.618_033_988_749_894_9).fract()
        };
        let last = solutions(&graph, &equations, input).into_iter().flatten().next_back();
        last.expect("short enough")[..n].to_vec()
    };
    (0..5).map(at).collect()
}

#[test]
fn sums_and_recursions_have_one_solution() {
    let n = 7;
    for (sums, recursion, _) in spellings(n) {
        for (one, other) in accelerations(&sums, n).iter().zip(accelerations(&recursion, n)) {
            let scale = other.iter().fold(0.0_f64, |scale, x| scale.max(x.abs()));
            let is_one = one.iter().zip(&other).all(|(x, y)| (x - y).abs() < 1e-11 * scale);
            assert!(is_one, "{one:?}, {other:?}: {sums}");
        }
    }
}

/// Two arms on a trunk of three links: positions as separate sums cost as much as positions from joint to joint.
#[test]
fn a_tree_is_found_by_its_branches() {
    let of = |way: &[usize]| {
        let terms: Vec<String> = way.iter().map(|j| format!("l*[sin(q[{j}]), -cos(q[{j}])]")).collect();
        terms.join(" + ")
    };
    let ways: [&[usize]; 7] =
        [&[0], &[0, 1], &[0, 1, 2], &[0, 1, 2, 3], &[0, 1, 2, 3, 4], &[0, 1, 2, 5], &[0, 1, 2, 5, 6]];
    let parents = [0, 0, 1, 2, 3, 2, 5];
    let system = |definitions: String| {
        format!(
            "#[coordinates(q: [7])] {definitions}
             #[lagrangian(sum(i in 0..7, m[i]/2*dot(der(r[i]), der(r[i])) - m[i]*g*r[i][1]))]
             struct Tree {{ m: [f64; 7], l: f64, g: f64 }}"
        )
    };
    let sums = ways.iter().enumerate().map(|(i, way)| format!("#[define(r[{i}] = {})]", of(way))).collect();
    let joints = (0..7).map(|i| match i {
        0 => format!("#[define(r[0] = {})]", of(&[0])),
        _ => format!("#[define(r[{i}] = r[{}] + {})]", parents[i], of(&[i])),
    });
    assert_eq!(least(&system(sums)), least(&system(joints.collect())));
}

/// Common terms of two sums that would save nothing stay as written.
#[test]
fn what_gains_nothing_stays_as_it_is() {
    let (graph, problem, _) = equations(
        "#[coordinates(x, y)] #[define(earth = sqrt((x + mu)^2 + y^2))] #[define(moon = sqrt((x - 1 + mu)^2 + y^2))]
         #[lagrangian((x_dot^2 + y_dot^2)/2 + (1 - mu)/earth + mu/moon)] struct ThreeBodies { mu: f64 }",
    );
    assert!(graph.nested(problem.lagrangian, &[problem.lagrangian]).is_none());
}
