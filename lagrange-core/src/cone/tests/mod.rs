//! Decisions of random problems against the law as it is stated, and against closed solutions.

mod cases;
mod exact;

use lagrange_random::{Random, cases};

use super::{ConeDecision, Face, Limit, RowBlock, Set};
use cases::{ALL_ROWS, Case, dot};

#[test]
fn roots_need_no_library() {
    for x in [0.0, f64::MIN_POSITIVE, 1e-200, 0.3, 1.0, 2.0, 3.999_999, 4.0, 1e17, f64::MAX, f64::INFINITY] {
        let root = crate::numerics::bare::root_by_heron(x);
        assert!(root == x.sqrt() || (root / x.sqrt() - 1.0).abs() <= f64::EPSILON, "{x:e} {root:e}");
    }
    assert_eq!(crate::numerics::bare::root_by_heron(-1.0), 0.0);
}

/// By how much reactions are off the law as it is stated, as a multiple of what is guaranteed; none of it by scaled rows.
fn off(case: &Case, found: &ConeDecision) -> f64 {
    let (r, x) = (&found.reactions, &found.change);
    let g = |i: usize| dot(&case.rows[i], &case.rows[i]);
    let unit = (0..r.len()).map(|i| case.q[i].abs() / g(i).sqrt()).fold(0.0, f64::max);
    let terms =
        |i: usize| case.rows[i].iter().zip(x).map(|(j, x)| (j * x).abs()).sum::<f64>() + case.q[i].abs();
    let mut worst = 0.0_f64;
    // x = Jᵀ r.
    for c in 0..case.n {
        let parts = || case.rows.iter().zip(r).map(|(row, r)| row[c] * r);
        let size = parts().map(f64::abs).sum::<f64>();
        let allowed = 1e-13 * size + 2e-12 * dot(x, x).sqrt() + f64::MIN_POSITIVE;
        worst = worst.max((parts().sum::<f64>() - x[c]).abs() / allowed);
    }
    for block in &case.blocks {
        let rate = |i: usize| dot(&case.rows[i], x) + case.q[i];
        let most = block.rows().map(g).fold(0.0, f64::max).sqrt();
        let allowed = block.rows().map(|i| 4e-12 * (terms(i) + unit * most) + case.noise[i]).sum::<f64>();
        let size = |of: &dyn Fn(usize) -> f64| block.rows().map(|i| of(i).powi(2)).sum::<f64>().sqrt();
        let i = block.first;
        let limit = match block.set {
            Set::Line => {
                worst = worst.max(rate(i).abs() / allowed);
                continue;
            }
            Set::HalfLine => {
                worst = worst.max((r[i] * g(i)).min(rate(i)).abs() / allowed);
                assert!(r[i] >= 0.0);
                continue;
            }
            Set::Ray { force, gap } => {
                let push = r[case.blocks[gap].first];
                assert!(block.rows().zip(force).all(|(i, force)| r[i] == force * push));
                continue;
            }
            Set::Disc(Limit { radius, mu, gap }) => {
                radius + gap.map_or(0.0, |gap| mu * r[case.blocks[gap].first])
            }
        };
        let (drag, slip) = (size(&|i| r[i]), size(&rate));
        assert!(drag <= limit * (1.0 + 1e-14), "{drag} {limit}");
        // What friction takes is the most that it can: −r·u = limit |u|.
        let power = block.rows().map(|i| r[i] * rate(i)).sum::<f64>();
        let slack = 4.0 * limit * allowed + f64::MIN_POSITIVE;
        worst = worst.max((limit * slip + power) / slack);
    }
    worst
}

/// Decides problems; of 10,000 at most so many may stay undecided.
fn check(what: &str, most: usize, count: usize, case: impl Fn(u64) -> Case) {
    let mut undecided = 0;
    for seed in 0..count as u64 {
        let case = case(seed);
        let found = case.decision();
        if !found.is_found {
            undecided += 1;
            continue;
        }
        let worst = off(&case, &found);
        assert!(worst <= 1.0, "{what}, seed {seed}: {worst}");
        let after: Vec<f64> = case.motion.iter().zip(&found.change).map(|(v, x)| v + x).collect();
        let [after, before] = [&after, &case.motion].map(|v| dot(v, v));
        assert!(after <= before * (1.0 + 1e-9), "{what}, seed {seed}: energy {before} becomes {after}");
    }
    println!("{what}: {undecided} of {count} undecided");
    // Of few problems a few more.
    let allowed = most * count / 10_000 + 3 * usize::from(most > 0 || count > 10_000);
    assert!(undecided <= allowed, "{what}: {undecided} of {count} undecided");
}

#[test]
fn random_contacts_are_decided() {
    for (kind, most) in ALL_ROWS.into_iter().zip([0, 1, 2, 20, 250]) {
        check(&format!("{kind:?}"), most, cases([300, 2_000, 100_000]), |seed| Case::contacts(seed, kind));
    }
}

/// Friction that slides may press bodies together, so that reactions need not exist; here they do.
#[test]
fn contacts_that_slide_already_are_decided() {
    for (kind, most) in ALL_ROWS.into_iter().zip([1, 1, 1, 2, 20]) {
        let case = |seed| Case::pushed(seed, kind);
        check(&format!("{kind:?}, pushed"), most, cases([300, 2_000, 100_000]), case);
    }
}

/// The gap responds to its own force by a = W_nn + μ W_nT: there is one solution where that is positive, and where it is not, none if the
/// rod falls without a force, and two if it rises, with a force and without one.
#[test]
fn painleves_rod_has_none_one_or_two_solutions() {
    let mut seen = [0; 3];
    for seed in 0..cases([300, 3_000, 100_000]) as u64 {
        let mut random = Random(seed);
        let mu = random.between(0.0, 4.0);
        let case = Case::rod(random.between(0.05, 1.5), mu, random.between(-2.0, 2.0));
        let (a, free) =
            (dot(&case.rows[0], &case.rows[0]) + mu * dot(&case.rows[0], &case.rows[1]), case.q[0]);
        if a.abs() < 1e-6 || free.abs() < 1e-6 {
            continue;
        }
        let expected = if a > 0.0 { 1 } else { 2 * usize::from(free > 0.0) };
        seen[expected] += 1;
        let (found, solutions) = (case.decision(), case.solver().solutions(1_000).expect("two trials"));
        assert_eq!((solutions.len(), found.is_found), (expected, expected > 0), "seed {seed}");
        for r in &solutions {
            assert!(r[0] == 0.0 || (a * r[0] + free).abs() < 1e-14 * r[0], "seed {seed}");
        }
    }
    assert!(seen.iter().all(|count| *count > 20), "{seen:?}");
}

#[test]
fn all_sets_are_decided_together() {
    check("all sets", 1, cases([300, 2_000, 100_000]), Case::of_all_sets);
}

#[test]
fn tables_are_decided() {
    for legs in [3, 4, 6, 8] {
        check(&format!("{legs} legs"), 1, cases([50, 300, 50_000]), |seed| Case::table(seed, legs));
    }
}

/// A block of mass 1 with a gap and one or two velocities.
fn block(rates: [f64; 3], mu: f64) -> ConeDecision {
    let rows = (0..3).map(|i| (0..3).map(|c| f64::from(u8::from(i == c))).collect()).collect();
    Case::impact(rows, rates.to_vec(), cases::contact(0, 0, 2, mu).into()).decision()
}

#[test]
fn a_block_sticks_slides_and_parts() {
    let sticks = block([-1.0, 0.3, 0.4], 0.5);
    assert_eq!((sticks.reactions, sticks.faces), (vec![1.0, -0.3, -0.4], vec![Face::Stick; 2]));
    let slides = block([-1.0, 3.0, 4.0], 0.5);
    assert_eq!(slides.rates[0], 0.0);
    for (found, expected) in slides.reactions.iter().zip([1.0, -0.3, -0.4]) {
        assert!((found - expected).abs() < 1e-15, "{:?}", slides.reactions);
    }
    let parts = block([1.0, 3.0, 4.0], 0.5);
    assert_eq!((parts.reactions, parts.faces), (vec![0.0; 3], vec![Face::Open; 2]));
}

/// Four legs of a square table share its weight alike, whatever the order of the legs.
#[test]
fn legs_that_are_alike_share_alike() {
    let corners = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
    let rows = corners.iter().map(|[x, y]| vec![1.0, *x, *y]).collect();
    let blocks = (0..4).map(|k| RowBlock { first: k, count: 1, set: Set::HalfLine }).collect();
    let found = Case::impact(rows, vec![-1.0, 0.0, 0.0], blocks).decision();
    assert!(found.is_found && found.rates == [0.0; 4]);
    assert!(found.reactions.iter().all(|r| (r - 0.25).abs() < 1e-15), "{:?}", found.reactions);
}

/// Balls of equal mass in a row that hit one another: those at the front that are slower are pushed by those behind, as a body that has
/// all their momentum.
#[test]
fn balls_in_a_row_that_meet_go_on_together() {
    for seed in 0..cases([200, 2_000, 100_000]) as u64 {
        let case = Case::balls(seed);
        let found = case.decision();
        // The least change to ascending velocities, by pooling of neighbours (Ayer and others 1955).
        let mut pools: Vec<(f64, usize)> = vec![];
        for &v in &case.motion {
            pools.push((v, 1));
            while let [.., (u, a), (v, b)] = pools[..]
                && u > v
            {
                pools.truncate(pools.len() - 2);
                pools.push(((u * a as f64 + v * b as f64) / (a + b) as f64, a + b));
            }
        }
        let expected = pools.iter().flat_map(|&(v, count)| core::iter::repeat_n(v, count));
        for ((v, x), expected) in case.motion.iter().zip(&found.change).zip(expected) {
            assert!(found.is_found && (v + x - expected).abs() < 1e-14, "seed {seed}");
        }
    }
}
