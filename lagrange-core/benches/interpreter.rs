//! One evaluation of accelerations and multipliers: the emitted code, and the interpreter of the same text.
//!
//! `cargo bench -p lagrange-benches --bench interpreter`

use std::hint::black_box;

use criterion::Criterion;
use lagrange_core::{System as _, nalgebra::Const, prelude::*};
use lagrange_interpreter::{Model, Parameters, System};

/// Derives a system, and keeps its text.
macro_rules! system {
    ($(#[$attribute:meta])* struct $name:ident { $($field:ident: $type:ty = $value:expr),* }) => {
        #[derive(Lagrangian)]
        $(#[$attribute])*
        struct $name { $($field: $type),* }

        impl $name {
            const VALUE: Self = Self { $($field: $value),* };
            const TEXT: &'static str = stringify!($(#[$attribute])* struct $name { $($field: $type),* });
        }
    };
}

system! {
    #[coordinates(a, b)]
    #[lagrangian((m[0] + m[1])/2*l[0]^2*a_dot^2 + m[1]/2*l[1]^2*b_dot^2 + m[1]*l[0]*l[1]*a_dot*b_dot*cos(a - b)
        + (m[0] + m[1])*g*l[0]*cos(a) + m[1]*g*l[1]*cos(b))]
    struct DoublePendulum { m: [f64; 2] = [1.0, 2.0], l: [f64; 2] = [1.0, 0.5], g: f64 = 9.81 }
}

system! {
    #[coordinates(theta: [10])]
    #[define(v[0] = l*[cos(theta[0]), sin(theta[0])]*theta_dot[0])]
    #[define(v[i in 1..10] = v[i-1] + l*[cos(theta[i]), sin(theta[i])]*theta_dot[i])]
    #[lagrangian(sum(i in 0..10, m/2*dot(v[i], v[i]) + m*g*l*(10 - i)*cos(theta[i])))]
    struct TenPendulums { m: f64 = 1.0, l: f64 = 0.5, g: f64 = 9.81 }
}

system! {
    #[coordinates(r: [20, 2])]
    #[lagrangian(sum(i in 0..20, m/2*dot(r_dot[i], r_dot[i]) - m*g*r[i][1]))]
    #[constraint(first: dot(r[0], r[0]) = l^2)]
    #[constraint(rod[i in 1..20]: dot(r[i] - r[i-1], r[i] - r[i-1]) = l^2)]
    struct TwentyRods { m: f64 = 1.0, g: f64 = 9.81, l: f64 = 0.5 }
}

system! {
    #[coordinates(x: [24])]
    #[lagrangian(sum(i in 0..24, 30*x_dot[i]^2 - x[i]^2 + sum(j in 0..i, cos(x[i] - x[j] + k)*x_dot[i]*x_dot[j])))]
    struct CoupledByAll { k: f64 = 0.3 }
}

fn evaluate<L, const N: usize>(criterion: &mut Criterion, system: &L, text: &str)
where
    L: Lagrangian<Scalar = f64, N = Const<N>>,
{
    let state = State::new(std::array::from_fn::<_, N, _>(|i| (i as f64).sin()), [0.3; N]);
    let mut parameters = Vec::new();
    system.visit_parameters(&mut |name, value| parameters.push((name, value)));
    let parsed = System::parse(text).expect("it is derived");
    let model = Model::new(&parsed, parameters.into_iter().collect::<Parameters>()).expect("it moves");
    criterion.bench_function(&format!("{}, emitted", L::NAME), |bencher| {
        bencher.iter(|| system.accelerations_unchecked(black_box(&state)));
    });
    let mut a = [0.0; N];
    criterion.bench_function(&format!("{}, interpreted", L::NAME), |bencher| {
        bencher.iter(|| model.accelerations(0.0, black_box(state.q.as_slice()), state.v.as_slice(), &mut a));
    });
}

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    evaluate(&mut criterion, &DoublePendulum::VALUE, DoublePendulum::TEXT);
    evaluate(&mut criterion, &TenPendulums::VALUE, TenPendulums::TEXT);
    evaluate(&mut criterion, &TwentyRods::VALUE, TwentyRods::TEXT);
    evaluate(&mut criterion, &CoupledByAll::VALUE, CoupledByAll::TEXT);
}
