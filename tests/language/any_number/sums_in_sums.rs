//! Sums within sums, whatever they come from, and loops over several arrays at once.

use lagrange_core::{Error, ManyBodies};
use lagrange_random::Random;

use super::written_out::{agree, positive};

macro_rules! about_the_mean {
    ($name:ident, $n:tt, $($field:tt)*) => {
        /// Sums that are named and handed to functions outside of the loops in which they are used.
        #[derive(lagrange_core::Lagrangian)]
        #[coordinates(q: [$n])]
        #[define(mean = sum(i in 0..$n, (1 + i)*q[i])/$n)]
        #[define(F(x, k) = sum(j in 0..$n, (1 + j)*q[j]*x*k))]
        #[define(G(x) = sum(l in 1..$n, x*q[l-1]^2))]
        #[lagrangian(sum(i in 0..$n, q_dot[i]^2/2) - sum(i in 1..$n, q[i]*mean*(2 + i)) - sum(i in 1..$n, F(q[i-1], i))
            - sum(h in 0..$n, q[h])*h - G(h*sin(t)) - sum(i in 0..$n, sum(j in i+1..$n, (i - j)*q[i]^2*F(q[j], j))))]
        #[force(q[i in 1..$n]: cos(mean)*i - sum(j in 0..$n, sin(mean*q[j])*q_dot[i]))]
        #[dissipation(sum(i in 1..$n, der(q[i]^2 + q[i-1])^2))]
        struct $name { $($field)* h: f64 }
    };
}

about_the_mean!(AboutTheMean, n, n: usize,);
about_the_mean!(AboutTheMean2, 2,);
about_the_mean!(AboutTheMean5, 5,);

#[test]
fn sums_from_outside_of_a_loop() {
    let mut random = Random(11);
    agree(&AboutTheMean { n: 2, h: 0.6 }, &AboutTheMean2 { h: 0.6 }, &mut random);
    agree(&AboutTheMean { n: 5, h: 0.6 }, &AboutTheMean5 { h: 0.6 }, &mut random);
}

macro_rules! opposite {
    ($name:ident, $n:tt, $($field:tt)*) => {
        /// A loop that reaches all of x, and y from its end, beside one that reaches all of y; partial sums by name.
        #[derive(lagrange_core::Lagrangian)]
        #[coordinates(x: [$n], y: [$n])]
        #[define(two = x[0] + x[1])]
        #[define(three = x[0] + x[1] + x[2])]
        #[lagrangian(sum(i in 0..$n, x_dot[i]^2/2 + y_dot[i]^2/2 - x[i]*y[$n-1-i]) - sum(i in 0..$n-1, (y[i+1] - y[i])^2)
            - two^2 - three^4)]
        struct $name { $($field)* }
    };
}

opposite!(Opposite, n, n: usize,);
opposite!(Opposite3, 3,);
opposite!(Opposite4, 4,);

#[test]
fn an_array_that_several_loops_reach() {
    let mut random = Random(12);
    agree(&Opposite { n: 3 }, &Opposite3 {}, &mut random);
    agree(&Opposite { n: 4 }, &Opposite4 {}, &mut random);
}

macro_rules! brushes {
    ($name:ident, $n:tt, $first:tt, $($field:tt)*) => {
        /// Vectors and matrices at one place, with names that mean something else beside, and a bound that is no length.
        #[derive(lagrange_core::Lagrangian)]
        #[coordinates(p, r: [$n, 2], a: [$n, 2, 2])]
        #[parameter(m: [$n])]
        #[define(d[k in 1..$n] = r[k] - r[k-1])]
        #[lagrangian(p_dot^2/2 + sum(k in 0..$n, m[k]*dot(r_dot[k], r_dot[k])/2
                + (a_dot[k][0][0]^2 + a_dot[k][0][1]^2 + a_dot[k][1][0]^2 + a_dot[k][1][1]^2)*(2 + cos(r[k][0]))/2
                + a_dot[k][1][0]*r_dot[k][1]/8) + sum(k in 1..$n-1, a_dot[k][0][1]^2*(1 + p^2))
            - sum(i in 2..$n, dot(d[i], d[i-1])*k) - sum(j in 0..$first, norm(r[j] + [3, j])*p) - dot(d[1], d[$n-1])
            - sum(i in 0..$n, sum(j in 0..i+1, a[i][1][0]*a[j][0][1]*m[$n-1-i])))]
        #[dissipation(sum(i in 1..$n, dot(der(d[i]), der(d[i])))/3)]
        #[force(a[i in 0..$n-1][1][1]: sum(j in 1..$n, d[j][0]*i) - a_dot[i][1][1])]
        struct $name { $($field)* k: f64 }
    };
}

brushes!(Brushes, n, first, first: usize, m: Vec<f64>, n: usize,);
brushes!(Brushes3, 3, 2, m: [f64; 3],);

#[test]
fn matrices_at_each_place() {
    let mut random = Random(13);
    let (m, [k]) = (positive::<3>(&mut random), positive(&mut random));
    agree(&Brushes { first: 2, m: m.to_vec(), n: 3, k }, &Brushes3 { m, k }, &mut random);
}

/// Elements by number in loops that may be empty, and a family that begins at 1.
#[derive(lagrange_core::Lagrangian)]
#[coordinates(q: [n])]
#[define(d[i in 1..n] = q[i] - q[i-1])]
#[lagrangian(sum(i in 0..n, q_dot[i]^2/2) - sum(i in 1..n, (q[i] - q[0])^2 + d[2]*q[i]))]
struct Anchored {
    n: usize,
}

#[test]
fn elements_by_number_exist_before_a_motion_begins() {
    let missing = |n: usize| match (Anchored { n }).check() {
        Err(Error::ElementMissing { array, index, from, to }) => Some((array, index, from..to)),
        _ => None,
    };
    assert_eq!(missing(0), Some(("q", 0, 0..0)));
    assert_eq!(missing(1), Some(("d", 2, 1..1)));
    assert_eq!(missing(2), Some(("d", 2, 1..2)));
    assert!(Anchored { n: 3 }.check().is_ok());
}
