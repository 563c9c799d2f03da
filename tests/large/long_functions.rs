//! Functions that are so long that they are emitted in parts.

use lagrange_core::prelude::*;
use nalgebra::{SMatrix, SVector};
use num_dual::Dual64;

mod chain {
    use super::*;

    const N: usize = 40;

    /// Links with angles from the downward vertical.
    #[derive(Lagrangian)]
    #[coordinates(theta: [40])]
    #[define(vx[0] = l[0]*cos(theta[0])*theta_dot[0])]
    #[define(vx[i in 1..40] = vx[i-1] + l[i]*cos(theta[i])*theta_dot[i])]
    #[define(vy[0] = l[0]*sin(theta[0])*theta_dot[0])]
    #[define(vy[i in 1..40] = vy[i-1] + l[i]*sin(theta[i])*theta_dot[i])]
    #[define(y[0] = -l[0]*cos(theta[0]))]
    #[define(y[i in 1..40] = y[i-1] - l[i]*cos(theta[i]))]
    #[lagrangian(sum(i in 0..40, m[i]/2*(vx[i]^2 + vy[i]^2) - m[i]*g*y[i]))]
    struct Chain {
        m: [f64; 40],
        l: [f64; 40],
        g: f64,
    }

    impl Chain {
        /// The mass that hangs on the later of two links.
        fn hanging(&self, i: usize, j: usize) -> f64 {
            self.m[i.max(j)..].iter().sum()
        }

        /// M_ij = l_i l_j cos(θ_i − θ_j) Σ_{k ≥ i, j} m_k
        fn mass(&self, q: &SVector<f64, N>) -> SMatrix<f64, N, N> {
            SMatrix::from_fn(|i, j| self.l[i] * self.l[j] * (q[i] - q[j]).cos() * self.hanging(i, j))
        }

        /// h_i = −Σ_j l_i l_j sin(θ_i − θ_j) θ̇_j² Σ m_k − g l_i sin θ_i Σ m_k
        fn force(&self, q: &SVector<f64, N>, v: &SVector<f64, N>) -> SVector<f64, N> {
            SVector::from_fn(|i, _| {
                let turning: f64 =
                    (0..N).map(|j| self.l[j] * (q[i] - q[j]).sin() * v[j] * v[j] * self.hanging(i, j)).sum();
                -self.l[i] * (turning + self.g * q[i].sin() * self.hanging(i, i))
            })
        }
    }

    fn chain() -> Chain {
        Chain {
            m: std::array::from_fn(|i| 1.0 + 0.3 * (i as f64).sin()),
            l: std::array::from_fn(|i| 0.5 + 0.2 * (2.0 * i as f64).cos()),
            g: 9.81,
        }
    }

    fn state() -> State<f64, N> {
        State::new(
            std::array::from_fn(|i| (1.3 * i as f64).sin()),
            std::array::from_fn(|i| (0.7 * i as f64).cos()),
        )
    }

    #[test]
    fn the_mass_matrix_is_the_closed_one() {
        let (chain, state) = (chain(), state());
        let error = (chain.mass_matrix(&state) - chain.mass(&state.q)).amax();
        assert!(error < 1e-13 * chain.mass(&state.q).amax(), "{error:e}");
    }

    #[test]
    fn the_accelerations_solve_the_closed_equations() {
        let (chain, state) = (chain(), state());
        let (mass, force) = (chain.mass(&state.q), chain.force(&state.q, &state.v));
        let residual = (mass * chain.accelerations_unchecked(&state).accelerations - force).amax();
        assert!(residual < 1e-11 * force.amax(), "{residual:e}");
    }
}

mod cloud {
    use super::*;

    const N: usize = 48;

    /// Particles, each bound to each; the first two by a rod.
    #[derive(Lagrangian)]
    #[coordinates(x: [24], y: [24])]
    #[function(U(s) = potential)]
    #[define(r(i, j) = sqrt((x[i] - x[j])^2 + (y[i] - y[j])^2 + a))]
    #[define(bond(i, j) = k[i]*k[j]*(1 + r(i, j)^2)*exp(-r(i, j)))]
    #[lagrangian(sum(i in 0..24, m[i]/2*(x_dot[i]^2 + y_dot[i]^2) - U(x[i]) - sum(j in 0..i, bond(i, j))))]
    #[constraint(rod: (x[0] - x[1])^2 + (y[0] - y[1])^2 = 1)]
    #[define(pull[i in 0..24] = sum(j in 0..24, k[i]*k[j]*(x[i] - x[j] + (y[i] + 2*y[j])^3)*sin(r(i, j))) + U(y[i])*x_dot[i])]
    #[observable(pulls = pull)]
    #[observable(first = pull[0])]
    #[observable(eighth = pull[7])]
    #[observable(last = pull[23])]
    #[observable(powers = lambda(rod)*pull)]
    #[observable(second = lambda(rod)*pull[1])]
    struct Cloud<T> {
        m: [T; 24],
        k: [T; 24],
        a: T,
        potential: Well,
    }

    struct Well;

    impl Function<1, 1> for Well {
        fn eval<S: Scalar>(&self, [s]: [S; 1]) -> [S; 1] {
            [s * s * s.cos()]
        }
    }

    fn cloud<T: Scalar>() -> Cloud<T> {
        let number = |i: usize| T::constant(1.0 + 0.3 * (i as f64).sin());
        Cloud {
            m: std::array::from_fn(number),
            k: std::array::from_fn(number),
            a: T::constant(0.1),
            potential: Well,
        }
    }

    fn coordinates() -> [f64; N] {
        std::array::from_fn(|i| 3.0 * (1.3 * i as f64).sin())
    }

    fn velocities() -> [f64; N] {
        std::array::from_fn(|i| (0.7 * i as f64).cos())
    }

    /// −∂L/∂q by dual numbers, through the parts of the Lagrangian, and by the parts of its own.
    #[test]
    fn the_forces_are_the_derivatives_of_the_lagrangian() {
        let rates = cloud::<f64>().momentum_rate(&State::new(coordinates(), velocities()));
        let dual = cloud::<Dual64>();
        for i in 0..N {
            let mut q = coordinates().map(Dual64::from_re);
            q[i].eps = 1.0;
            let expected = dual.lagrangian(&State::new(q, velocities().map(Dual64::from_re))).eps;
            assert!(
                (rates[i] - expected).abs() < 1e-11 * (1.0 + expected.abs()),
                "{i}: {} {expected}",
                rates[i]
            );
        }
    }

    /// The accelerations by the general solver, from M, h, F and γ of other functions.
    #[test]
    fn the_accelerations_are_those_of_the_general_solver() {
        let (cloud, state) = (cloud::<f64>(), State::new(coordinates(), velocities()));
        let solution = cloud.accelerations_unchecked(&state);
        let force = cloud.forcing(&state) + cloud.constraint_force(&state, &solution.multipliers);
        let residual = (cloud.mass_matrix(&state) * solution.accelerations - force).amax();
        assert!(residual < 1e-12 * force.amax(), "{residual:e}");
        let bias = cloud.constraint_jacobian(&state) * solution.accelerations + cloud.constraint_bias(&state);
        assert!(bias.amax() < 1e-12 * force.amax(), "{bias}");
    }

    /// Up to the order of the terms: which factors are taken out depends on what else a function computes.
    #[test]
    fn functions_in_parts_and_whole_ones_agree() {
        let (cloud, state) = (cloud::<f64>(), State::new(coordinates(), velocities()));
        let pulls = cloud.pulls(&state);
        let agree = |x: f64, y: f64, scale: f64| assert!((x - y).abs() < 1e-14 * scale, "{x} {y}");
        agree(pulls[0], cloud.first(&state), pulls.amax());
        agree(pulls[7], cloud.eighth(&state), pulls.amax());
        agree(pulls[23], cloud.last(&state), pulls.amax());
        let solution = cloud.accelerations_unchecked(&state);
        let powers = cloud.powers(&state, &solution);
        agree(powers[1], cloud.second(&state, &solution), powers.amax());
    }
}

/// Links of an arm, of which most are computed in loops.
mod arm {
    use nalgebra::{Matrix3, UnitQuaternion, Vector3};

    use super::*;

    const N: usize = 12;

    struct Link {
        m: f64,
        c: [f64; 3],
        inertia: Matrix3<f64>,
        turn: UnitQuaternion<f64>,
    }

    #[derive(Lagrangian)]
    #[coordinates(q: [12])]
    #[parameter(link: [12] {m, c: [3], inertia: symmetric, turn: quaternion})]
    #[frame(part[0]: rotate(link[0].turn), rotate_z(q[0]))]
    #[frame(part[i in 1..12] in part[i-1]: translate(arm[i]), rotate(link[i].turn), rotate_z(q[i]))]
    #[lagrangian(sum(i in 0..12, kinetic(part[i], link[i].m, link[i].c, link[i].inertia)
        - link[i].m*g*position(part[i], link[i].c)[2]))]
    #[force(q: tau)]
    struct Arm {
        link: [Link; 12],
        arm: [Vector3<f64>; 12],
        g: f64,
        tau: [f64; 12],
    }

    fn arm() -> Arm {
        let number = |i: usize, k: usize| (1.3 * i as f64 + 0.9 * k as f64).sin();
        let link = |i| Link {
            m: 1.5 + number(i, 0),
            c: [1, 2, 3].map(|k| 0.2 * number(i, k)),
            inertia: Matrix3::from_diagonal(&Vector3::from_fn(|k, _| 2.0 + 0.3 * number(i, 4 + k)))
                .map_with_location(|r, c, x| if r == c { x } else { 0.2 * number(i, 7 + r + c) }),
            turn: UnitQuaternion::from_euler_angles(number(i, 11), number(i, 12), number(i, 13)),
        };
        Arm {
            link: std::array::from_fn(link),
            arm: std::array::from_fn(|i| Vector3::from_fn(|k, _| 0.4 * number(i, 14 + k))),
            g: 9.81,
            tau: std::array::from_fn(|i| 3.0 * number(i, 17)),
        }
    }

    fn state() -> State<f64, N> {
        let number = |scale: f64| move |i: usize| (scale * i as f64).sin();
        State::new(std::array::from_fn(number(1.7)), std::array::from_fn(number(0.6)))
    }

    /// By M and h, which are computed without the recursions by which the equations are solved, and by the balance of forces.
    #[test]
    fn what_is_computed_in_loops_solves_the_equations() {
        let (arm, state) = (arm(), state());
        let accelerations = arm.accelerations_unchecked(&state).accelerations;
        let force = arm.forcing(&state);
        let residual = (arm.mass_matrix(&state) * accelerations - force).amax();
        assert!(residual < 1e-11 * force.amax(), "{residual:e}");
        let balance = arm.inverse_dynamics(&state, &accelerations, &[].into()).amax();
        assert!(balance < 1e-11 * force.amax(), "{balance:e}");
        let factor = arm.factor(&state);
        let solved = arm.solve_with(&factor, &force, &[].into()).accelerations;
        assert!((solved - accelerations).amax() < 1e-11 * accelerations.amax());
    }
}

/// Links of two kinds, in turn A, A, B: loops leave the sine of an angle whose cosine is taken elsewhere.
mod unlike_links {
    use std::array::from_fn;

    use lagrange_core::linearized::PartialDerivatives;
    use nalgebra::{Matrix3, Vector3};
    use num_dual::{Dual2_64, DualNum};

    use super::*;

    const N: usize = 15;

    #[derive(Clone, Lagrangian)]
    #[coordinates(q: [15])]
    #[frame(part[0]: translate([0, 0, l[0]]), rotate_x(bend[0]*sin(q[0])), rotate_z(q[0]/2))]
    #[frame(part[1] in part[0]: translate([0, 0, l[1]]), rotate_x(bend[1]*sin(q[1])), rotate_z(q[1]/2))]
    #[frame(part[2] in part[1]: translate(arm[2]), rotate(axis[2], q[2]))]
    #[frame(part[3] in part[2]: translate([0, 0, l[3]]), rotate_x(bend[3]*sin(q[3])), rotate_z(q[3]/2))]
    #[frame(part[4] in part[3]: translate([0, 0, l[4]]), rotate_x(bend[4]*sin(q[4])), rotate_z(q[4]/2))]
    #[frame(part[5] in part[4]: translate(arm[5]), rotate(axis[5], q[5]))]
    #[frame(part[6] in part[5]: translate([0, 0, l[6]]), rotate_x(bend[6]*sin(q[6])), rotate_z(q[6]/2))]
    #[frame(part[7] in part[6]: translate([0, 0, l[7]]), rotate_x(bend[7]*sin(q[7])), rotate_z(q[7]/2))]
    #[frame(part[8] in part[7]: translate(arm[8]), rotate(axis[8], q[8]))]
    #[frame(part[9] in part[8]: translate([0, 0, l[9]]), rotate_x(bend[9]*sin(q[9])), rotate_z(q[9]/2))]
    #[frame(part[10] in part[9]: translate([0, 0, l[10]]), rotate_x(bend[10]*sin(q[10])), rotate_z(q[10]/2))]
    #[frame(part[11] in part[10]: translate(arm[11]), rotate(axis[11], q[11]))]
    #[frame(part[12] in part[11]: translate([0, 0, l[12]]), rotate_x(bend[12]*sin(q[12])), rotate_z(q[12]/2))]
    #[frame(part[13] in part[12]: translate([0, 0, l[13]]), rotate_x(bend[13]*sin(q[13])), rotate_z(q[13]/2))]
    #[frame(part[14] in part[13]: translate(arm[14]), rotate(axis[14], q[14]))]
    #[lagrangian(sum(i in 0..15, kinetic(part[i], m[i], c[i], J[i])))]
    #[allow(non_snake_case)]
    struct Chain {
        l: [f64; 15],
        bend: [f64; 15],
        arm: [Vector3<f64>; 15],
        axis: [Vector3<f64>; 15],
        m: [f64; 15],
        c: [Vector3<f64>; 15],
        J: [Matrix3<f64>; 15],
    }

    fn chain() -> Chain {
        let number = |i: usize, k: usize| (1.3 * i as f64 + 0.9 * k as f64).sin();
        let vector = |k: usize| move |i: usize| Vector3::from_fn(|row, _| number(i, k + row));
        Chain {
            l: from_fn(|i| 0.5 + 0.2 * number(i, 0)),
            bend: from_fn(|i| 0.8 + 0.3 * number(i, 1)),
            arm: from_fn(vector(2)),
            axis: from_fn(|i| vector(5)(i) + Vector3::new(0.0, 0.0, 1.5)),
            m: from_fn(|i| 1.5 + number(i, 8)),
            c: from_fn(vector(9)),
            J: from_fn(|i| {
                Matrix3::from_fn(|j, k| {
                    if j == k { 2.0 + 0.3 * number(i, 12 + j) } else { 0.2 * number(i, 15 + j + k) }
                })
            }),
        }
    }

    fn state() -> State<f64, N> {
        State::new(from_fn(|i| (1.7 * i as f64).sin()), from_fn(|i| (0.6 * i as f64).sin()))
    }

    /// The rotation by an angle about an axis (Rodrigues).
    fn about<D: DualNum<Primitive = f64> + Copy>(axis: Vector3<f64>, angle: D) -> Matrix3<D> {
        let [x, y, z] = (axis / axis.norm()).into();
        let cross = Matrix3::new(0.0, -z, y, z, 0.0, -x, -y, x, 0.0);
        let [first, second] = [cross, cross * cross].map(|m| m.map(D::from));
        Matrix3::from_diagonal_element(D::one()) + first * angle.sin() + second * (D::one() - angle.cos())
    }

    /// The rotation of every part, and where its centre of mass is.
    fn poses<D: DualNum<Primitive = f64> + Copy>(chain: &Chain, q: [D; N]) -> [(Matrix3<D>, Vector3<D>); N] {
        let (mut turn, mut place) =
            (Matrix3::from_diagonal_element(D::one()), Vector3::from_element(D::zero()));
        from_fn(|i| {
            let (arm, step) = match i % 3 {
                2 => (chain.arm[i], about(chain.axis[i], q[i])),
                _ => {
                    let bent = about(Vector3::x(), q[i].sin() * chain.bend[i]);
                    (Vector3::new(0.0, 0.0, chain.l[i]), bent * about(Vector3::z(), q[i] / 2.0))
                }
            };
            place += turn * arm.map(D::from);
            turn *= step;
            (turn, place + turn * chain.c[i].map(D::from))
        })
    }

    /// The forces of inertia by d'Alembert's principle: Σ m p̈·∂p/∂qᵢ + tr(R̈ E (∂R/∂qᵢ)ᵀ) over the parts, where
    /// E = ½ tr(I) 1 − I.
    fn inertia(chain: &Chain, q: [f64; N], v: [f64; N], accelerations: [f64; N]) -> [f64; N] {
        let moving = poses(chain, from_fn(|i| Dual2_64::new(q[i], v[i], accelerations[i])));
        from_fn(|i| {
            let varied = poses(chain, from_fn(|k| Dual64::new(q[k], f64::from(u8::from(k == i)))));
            let part = |k: usize| {
                let (turn, place) = (moving[k].0.map(|x| x.v2), moving[k].1.map(|x| x.v2));
                let symmetric = (chain.J[k] + chain.J[k].transpose()) / 2.0;
                let of_density = Matrix3::from_diagonal_element(symmetric.trace() / 2.0) - symmetric;
                chain.m[k] * place.dot(&varied[k].1.map(|x| x.eps))
                    + (turn * of_density * varied[k].0.map(|x| x.eps).transpose()).trace()
            };
            (0..N).map(part).sum()
        })
    }

    #[test]
    fn the_accelerations_are_those_of_free_motion() {
        let (chain, state) = (chain(), state());
        let accelerations = chain.accelerations_unchecked(&state).accelerations;
        let scale = SVector::from(inertia(&chain, state.q.into(), state.v.into(), [0.0; N])).amax();
        let off = SVector::from(inertia(&chain, state.q.into(), state.v.into(), accelerations.into())).amax();
        assert!(off < 1e-11 * scale, "{off:e} of {scale:e}");
        let needed = chain.inverse_dynamics(&state, &[1.0; N].into(), &[].into());
        let expected = SVector::from(inertia(&chain, state.q.into(), state.v.into(), [1.0; N]));
        assert!((needed - expected).amax() < 1e-12 * expected.amax());
    }

    /// M δq̈ + δ(forces of inertia) = 0 where coordinates, velocities and all parameters change at once, by differences of
    /// fourth order.
    #[test]
    fn the_derivatives_are_those_of_the_forces_of_inertia() {
        let (system, state) = (chain(), state());
        let accelerations = system.accelerations_unchecked(&state).accelerations;
        let (jacobian, mass) = (system.jacobian(&state).unwrap(), system.mass_matrix(&state));
        for direction in 0..3 {
            let along = |k: usize| (0.37 * (direction + 2) as f64 * (k + 1) as f64).sin();
            let (dq, dv) = (SVector::from_fn(|i, _| along(i)), SVector::from_fn(|i, _| along(N + i)));
            let dp = system.parameters().map_with_location(|k, _, _| along(2 * N + k));
            let forces = |h: f64| {
                let mut moved = system.clone();
                for (k, p) in (system.parameters() + dp * h).iter().enumerate() {
                    moved.set_parameter(k, *p);
                }
                SVector::from(inertia(
                    &moved,
                    (state.q + dq * h).into(),
                    (state.v + dv * h).into(),
                    accelerations.into(),
                ))
            };
            let difference = |h: f64| (forces(h) - forces(-h)) / (2.0 * h);
            let slope = (difference(1e-3) * 4.0 - difference(2e-3)) / 3.0;
            let PartialDerivatives { q, v, parameters, .. } = &jacobian.accelerations;
            let off = (mass * (q * dq + v * dv + parameters * dp) + slope).amax();
            assert!(off < 1e-8 * slope.amax(), "{off:e} of {:e}", slope.amax());
        }
    }
}
