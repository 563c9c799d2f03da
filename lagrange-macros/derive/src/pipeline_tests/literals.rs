//! A robot as another program writes it, with sixteen digits in every literal, compared with the same robot with
//! fields.

use super::equations;
use crate::codegen::solutions;
use crate::variables::Variable;
use lagrange_random::Random;

/// A chain of links. `numbers` returns each number as a literal or as an entry of a field.
fn chain(numbers: &mut dyn FnMut() -> String) -> String {
    const LINKS: usize = 3;
    let (mut frames, mut terms) = (String::new(), Vec::new());
    for i in 0..LINKS {
        let [x, y, z, a, b, c, m, j, k, l] = [0; 10].map(|_| numbers());
        let place = if i == 0 { String::new() } else { format!(" in f{}", i - 1) };
        frames += &format!(
            "#[frame(f{i}{place}: translate([{x}, {y}, {z}]), rotate_x({a}), rotate_z(q[{i}]), translate([{a}, {b}, {c}]))]\n"
        );
        let inertia = format!("[[1 + {j}, {a}/9, {b}/9], [{a}/9, 1 + {k}, {c}/9], [{b}/9, {c}/9, 1 + {l}]]");
        terms.push(format!(
            "kinetic(f{i}, {m}, [{c}, {a}, {b}], {inertia}) - {m}*{x}*position(f{i}, [{c}, {a}, {b}])[2] - {k}*{j}*{l}*q[{i}]^2"
        ));
    }
    format!("#[coordinates(q: [{LINKS}])] {frames} #[lagrangian({})]", terms.join(" + "))
}

#[test]
fn a_robot_may_be_written_with_all_its_digits() {
    for draw in 0..4 {
        let mut random = Random(draw);
        let mut known = Vec::new();
        let written = chain(&mut || {
            known.push(random.between(0.1, 2.0));
            format!("{:?}", known[known.len() - 1])
        });
        let mut count = 0;
        let fields = chain(&mut || {
            count += 1;
            format!("p[{}]", count - 1)
        });
        let written = format!("{written} struct Written;");
        let fields = format!("{fields} struct Fields {{ p: [f64; {count}] }}");
        let [ours, theirs] = [written, fields].map(|source| {
            let (graph, problem, equations) = equations(&source);
            let found = solutions(&graph, &equations, |symbol| match Variable::of(symbol) {
                Variable::Parameter(k) => known[problem.parameters.entries[k].number],
                Variable::Coordinate(i) => 0.3 + 0.4 * i as f64,
                Variable::Velocity(i) => 0.9 - 0.7 * i as f64,
                _ => 0.0,
            });
            found.into_iter().flatten().next().expect("a solution")
        });
        let (_, ours) = ours.split_last().expect("a pivot");
        let scale = theirs.iter().fold(1.0_f64, |scale, x| scale.max(x.abs()));
        for (x, y) in ours.iter().zip(&theirs) {
            assert!((x - y).abs() < 1e-12 * scale, "{ours:?} {theirs:?}");
        }
    }
}
