//! Whole systems, as they are to be read. `UPDATE_EXPECT=1 cargo test` accepts a change.

use expect_test::{Expect, expect};

use super::reader::assert_balanced;
use crate::diagnostics::Diagnostics;
use crate::render::{Rendered, render};
use crate::{mechanics, resolve, syntax};

fn rendered(source: &str) -> Rendered {
    let mut diagnostics = Diagnostics::default();
    let input = syn::parse_str(source).expect("a struct");
    let declaration = syntax::declaration(input, &mut diagnostics);
    let (mut graph, problem) = resolve::problem(&declaration, &mut diagnostics).expect("no errors");
    let derived = mechanics::derive(&mut graph, &problem, &mut diagnostics).expect("no errors");
    render(&declaration, &graph, &problem, &derived)
}

fn check(source: &str, text: Expect, latex: Expect) {
    let rendered = rendered(source);
    assert_balanced(&rendered.latex);
    text.assert_eq(&rendered.text);
    latex.assert_eq(&rendered.latex);
}

/// Milton (8.8)–(8.10).
#[test]
fn sphere_down_an_incline() {
    check(
        "#[coordinates(x, phi)]
         #[define(inertia = 2/5 * m * a^2)]
         #[lagrangian(m/2 * x_dot^2 + inertia/2 * phi_dot^2 + m*g*x*sin(alpha))]
         #[constraint(no_slip: x_dot - a*phi_dot = 0)]
         struct RollingSphere { m: f64, a: f64, g: f64, alpha: f64 }",
        expect![[r#"
            RollingSphere

            Lagrangian
              L = ½ m ẋ² + ½ inertia φ̇² + m g x sin α
              inertia = ⅖ m a²

            Constraints
              no_slip: ẋ − a φ̇ = 0   (integrable: x − a φ is constant)

            Equations of motion
              x: m ẍ = m g sin α + λ_no_slip
              φ: inertia φ̈ = −a λ_no_slip

            Constraint forces
              R_x = λ_no_slip
              R_phi = −a λ_no_slip

            Conserved
              E = ½ m ẋ² + ½ inertia φ̇² − m g x sin α   (T + U)

            Momenta
              p_x = m ẋ
              p_phi = inertia φ̇

            Hamiltonian
              H = ½ p_x²/m + ½ p_phi²/inertia − m g x sin α

            Hamilton's equations
              ẋ = p_x/m
              φ̇ = p_phi/inertia
              ṗ_x = λ_no_slip + m g sin α
              ṗ_phi = −a λ_no_slip
        "#]],
        expect![[r#"
            \begin{align}
              L &= \tfrac{1}{2} m \dot x^2 + \tfrac{1}{2} \, \mathit{inertia} \, \dot\varphi^2 + m g x \sin \alpha \label{eq:RollingSphere-L} \\
              \mathit{inertia} &= \tfrac{2}{5} m a^2 \label{eq:RollingSphere-inertia} \\
              \dot x - a \dot\varphi &= 0 \label{eq:RollingSphere-no_slip} \\
              m \ddot x &= m g \sin \alpha + \lambda_{\mathrm{no\,slip}} \label{eq:RollingSphere-x} \\
              \mathit{inertia} \, \ddot\varphi &= -a \lambda_{\mathrm{no\,slip}} \label{eq:RollingSphere-phi} \\
              R_x &= \lambda_{\mathrm{no\,slip}} \label{eq:RollingSphere-R_x} \\
              R_\varphi &= -a \lambda_{\mathrm{no\,slip}} \label{eq:RollingSphere-R_phi} \\
              E &= \tfrac{1}{2} m \dot x^2 + \tfrac{1}{2} \, \mathit{inertia} \, \dot\varphi^2 - m g x \sin \alpha \label{eq:RollingSphere-E} \\
              p_x &= m \dot x \label{eq:RollingSphere-p_x} \\
              p_\varphi &= \mathit{inertia} \, \dot\varphi \label{eq:RollingSphere-p_phi} \\
              H &= \frac{\tfrac{1}{2} p_x^2}{m} + \frac{\tfrac{1}{2} p_\varphi^2}{\mathit{inertia}} - m g x \sin \alpha \label{eq:RollingSphere-H} \\
              \dot x &= \frac{p_x}{m} \label{eq:RollingSphere-} \\
              \dot\varphi &= \frac{p_\varphi}{\mathit{inertia}} \label{eq:RollingSphere-phi-2} \\
              \dot p_x &= \lambda_{\mathrm{no\,slip}} + m g \sin \alpha \label{eq:RollingSphere-_x} \\
              \dot p_\varphi &= -a \lambda_{\mathrm{no\,slip}} \label{eq:RollingSphere-_phi}
            \end{align}
        "#]],
    );
}

/// Milton (8.11)–(8.14).
#[test]
fn spherical_pendulum() {
    check(
        "#[coordinates(x, y, z)]
         #[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) - m*g*z)]
         #[constraint(string: (x^2 + y^2 + z^2 - l^2)/2 = 0)]
         struct SphericalPendulum { m: f64, g: f64, l: f64 }",
        expect![[r#"
            SphericalPendulum

            Lagrangian
              L = ½ m (ẋ² + ẏ² + ż²) − m g z

            Constraints
              string: ½ (x² + y² + z² − l²) = 0   (holonomic)

            Equations of motion
              x: m ẍ = λ_string x
              y: m ÿ = λ_string y
              z: m z̈ = −m g + λ_string z

            Constraint forces
              R_x = λ_string x
              R_y = λ_string y
              R_z = λ_string z

            Conserved
              E = ½ m (ẋ² + ẏ² + ż²) + m g z   (T + U)

            Momenta
              p_x = m ẋ
              p_y = m ẏ
              p_z = m ż

            Hamiltonian
              H = m g z + ½ (p_z² + p_y² + p_x²)/m

            Hamilton's equations
              ẋ = p_x/m
              ẏ = p_y/m
              ż = p_z/m
              ṗ_x = λ_string x
              ṗ_y = λ_string y
              ṗ_z = λ_string z − m g
        "#]],
        expect![[r#"
            \begin{align}
              L &= \tfrac{1}{2} m (\dot x^2 + \dot y^2 + \dot z^2) - m g z \label{eq:SphericalPendulum-L} \\
              \tfrac{1}{2} (x^2 + y^2 + z^2 - l^2) &= 0 \label{eq:SphericalPendulum-string} \\
              m \ddot x &= \lambda_{\mathrm{string}} x \label{eq:SphericalPendulum-x} \\
              m \ddot y &= \lambda_{\mathrm{string}} y \label{eq:SphericalPendulum-y} \\
              m \ddot z &= -m g + \lambda_{\mathrm{string}} z \label{eq:SphericalPendulum-z} \\
              R_x &= \lambda_{\mathrm{string}} x \label{eq:SphericalPendulum-R_x} \\
              R_y &= \lambda_{\mathrm{string}} y \label{eq:SphericalPendulum-R_y} \\
              R_z &= \lambda_{\mathrm{string}} z \label{eq:SphericalPendulum-R_z} \\
              E &= \tfrac{1}{2} m (\dot x^2 + \dot y^2 + \dot z^2) + m g z \label{eq:SphericalPendulum-E} \\
              p_x &= m \dot x \label{eq:SphericalPendulum-p_x} \\
              p_y &= m \dot y \label{eq:SphericalPendulum-p_y} \\
              p_z &= m \dot z \label{eq:SphericalPendulum-p_z} \\
              H &= m g z + \frac{\tfrac{1}{2} (p_z^2 + p_y^2 + p_x^2)}{m} \label{eq:SphericalPendulum-H} \\
              \dot x &= \frac{p_x}{m} \label{eq:SphericalPendulum-} \\
              \dot y &= \frac{p_y}{m} \label{eq:SphericalPendulum--2} \\
              \dot z &= \frac{p_z}{m} \label{eq:SphericalPendulum--3} \\
              \dot p_x &= \lambda_{\mathrm{string}} x \label{eq:SphericalPendulum-_x} \\
              \dot p_y &= \lambda_{\mathrm{string}} y \label{eq:SphericalPendulum-_y} \\
              \dot p_z &= \lambda_{\mathrm{string}} z - m g \label{eq:SphericalPendulum-_z}
            \end{align}
        "#]],
    );
}

/// Milton (8.23).
#[test]
fn spherical_pendulum_in_angles() {
    check(
        "#[coordinates(theta, phi)]
         #[lagrangian(m*l^2/2 * (theta_dot^2 + sin(theta)^2*phi_dot^2) + m*g*l*cos(theta))]
         struct SphericalPendulum { m: f64, g: f64, l: f64 }",
        expect![[r#"
            SphericalPendulum

            Lagrangian
              L = ½ m l² (θ̇² + sin²(θ) φ̇²) + m g l cos θ

            Equations of motion
              θ: l θ̈ = l cos θ sin(θ) φ̇² − g sin θ
              φ: sin(θ) φ̈ = −2 cos(θ) θ̇ φ̇

            Conserved
              p_phi = m l² sin²(θ) φ̇
              E = m l (½ l (θ̇² + sin²(θ) φ̇²) − g cos θ)   (T + U)

            Momenta
              p_theta = m l² θ̇
              p_phi = m l² sin²(θ) φ̇

            Hamiltonian
              H = ½ (p_phi²/sin² θ + p_theta²)/(m l²) − m l g cos θ

            Hamilton's equations
              θ̇ = p_theta/(m l²)
              φ̇ = p_phi/(m l² sin² θ)
              ṗ_theta = cos(θ) p_phi²/(m l² sin³ θ) − m l g sin θ
              ṗ_phi = 0
        "#]],
        expect![[r#"
            \begin{align}
              L &= \tfrac{1}{2} m l^2 (\dot\theta^2 + \sin^2(\theta) \dot\varphi^2) + m g l \cos \theta \label{eq:SphericalPendulum-L} \\
              l \ddot\theta &= l \cos \theta \sin(\theta) \dot\varphi^2 - g \sin \theta \label{eq:SphericalPendulum-theta} \\
              \sin(\theta) \ddot\varphi &= -2 \cos(\theta) \dot\theta \dot\varphi \label{eq:SphericalPendulum-phi} \\
              p_\varphi &= m l^2 \sin^2(\theta) \dot\varphi \label{eq:SphericalPendulum-p_phi} \\
              E &= m l \bigl(\tfrac{1}{2} l (\dot\theta^2 + \sin^2(\theta) \dot\varphi^2) - g \cos \theta\bigr) \label{eq:SphericalPendulum-E} \\
              p_\theta &= m l^2 \dot\theta \label{eq:SphericalPendulum-p_theta} \\
              p_\varphi &= m l^2 \sin^2(\theta) \dot\varphi \label{eq:SphericalPendulum-p_phi-2} \\
              H &= \frac{\tfrac{1}{2} \left( \frac{p_\varphi^2}{\sin^2 \theta} + p_\theta^2 \right)}{m l^2} - m l g \cos \theta \label{eq:SphericalPendulum-H} \\
              \dot\theta &= \frac{p_\theta}{m l^2} \label{eq:SphericalPendulum-theta-2} \\
              \dot\varphi &= \frac{p_\varphi}{m l^2 \sin^2 \theta} \label{eq:SphericalPendulum-phi-2} \\
              \dot p_\theta &= \frac{\cos(\theta) p_\varphi^2}{m l^2 \sin^3 \theta} - m l g \sin \theta \label{eq:SphericalPendulum-_theta} \\
              \dot p_\varphi &= 0 \label{eq:SphericalPendulum-_phi}
            \end{align}
        "#]],
    );
}

/// Milton (8.44).
#[test]
fn rotating_frame() {
    check(
        "#[coordinates(r: [3])]
         #[function(Omega(t): [3] = spin)]
         #[function(A(t): [3] = acceleration)]
         #[function(U(r) = potential)]
         #[define(v = r_dot)]
         #[define(W = Omega(t))]
         #[lagrangian(m/2*dot(v, v) + m/2*dot(cross(W, r), cross(W, r)) + m*dot(v, cross(W, r)) - U(r) - m*dot(r, A(t)))]
         struct RotatingFrame { m: f64, spin: Spin, acceleration: Acceleration, potential: Potential }",
        expect![[r#"
            RotatingFrame

            Lagrangian
              L = ½ m v·v + ½ m (W×r)·(W×r) + m v·(W×r) − U(r) − m r·A(t)
              v = ṙ
              W = Ω(t)

            Equations of motion
              r[0]: m r̈[0] = −m (2 W[1] ṙ[2] + W[0] W[1] r[1] + r[2] Ω[1]′(t) + W[0] W[2] r[2] + A[0](t) − 2 W[2] ṙ[1] − W[1]² r[0] − W[2]² r[0] − r[1] Ω[2]′(t)) − ∂U/∂r[0]
              r[1]: m r̈[1] = −m (2 W[2] ṙ[0] + W[0] W[1] r[0] + r[0] Ω[2]′(t) + W[1] W[2] r[2] + A[1](t) − 2 W[0] ṙ[2] − W[2]² r[1] − W[0]² r[1] − r[2] Ω[0]′(t)) − ∂U/∂r[1]
              r[2]: m r̈[2] = −m (2 W[0] ṙ[1] + W[0] W[2] r[0] + W[1] W[2] r[1] + r[1] Ω[0]′(t) + A[2](t) − 2 W[1] ṙ[0] − r[0] Ω[1]′(t) − W[1]² r[2] − W[0]² r[2]) − ∂U/∂r[2]

            Momenta
              p_r[0] = m (W[1] r[2] − W[2] r[1]) + m ṙ[0]
              p_r[1] = m (W[2] r[0] − W[0] r[2]) + m ṙ[1]
              p_r[2] = m (W[0] r[1] − W[1] r[0]) + m ṙ[2]

            Hamiltonian
              H = m (r[0] A[0](t) + r[1] A[1](t) + r[2] A[2](t)) + W[1] r[0] p_r[2] + W[2] r[1] p_r[0] + W[0] r[2] p_r[1] + ½ (p_r[2]² + p_r[1]² + p_r[0]²)/m + U(r) − W[2] r[0] p_r[1] − W[0] r[1] p_r[2] − W[1] r[2] p_r[0]

            Hamilton's equations
              ṙ[0] = W[2] r[1] + p_r[0]/m − W[1] r[2]
              ṙ[1] = W[0] r[2] + p_r[1]/m − W[2] r[0]
              ṙ[2] = W[1] r[0] + p_r[2]/m − W[0] r[1]
              ṗ_r[0] = W[2] p_r[1] − m A[0](t) − ∂U/∂r[0] − W[1] p_r[2]
              ṗ_r[1] = W[0] p_r[2] − m A[1](t) − ∂U/∂r[1] − W[2] p_r[0]
              ṗ_r[2] = W[1] p_r[0] − m A[2](t) − ∂U/∂r[2] − W[0] p_r[1]
        "#]],
        expect![[r#"
            \begin{align}
              L &= \tfrac{1}{2} m v \cdot v + \tfrac{1}{2} m (W \times r) \cdot (W \times r) + m v \cdot (W \times r) \nonumber \\
                &\quad - U(r) - m r \cdot A(t) \label{eq:RotatingFrame-L} \\
              v &= \dot r \label{eq:RotatingFrame-v} \\
              W &= \Omega(t) \label{eq:RotatingFrame-W} \\
              m \ddot r_0 &= -m \bigl(2 W_1 \dot r_2 + W_0 W_1 r_1 + r_2 \Omega_1'(t) + W_0 W_2 r_2 + A_0(t) \nonumber \\
                &\quad - 2 W_2 \dot r_1 - W_1^2 r_0 - W_2^2 r_0 - r_1 \Omega_2'(t)\bigr) - \frac{\partial U}{\partial r_0} \label{eq:RotatingFrame-r-0} \\
              m \ddot r_1 &= -m \bigl(2 W_2 \dot r_0 + W_0 W_1 r_0 + r_0 \Omega_2'(t) + W_1 W_2 r_2 + A_1(t) \nonumber \\
                &\quad - 2 W_0 \dot r_2 - W_2^2 r_1 - W_0^2 r_1 - r_2 \Omega_0'(t)\bigr) - \frac{\partial U}{\partial r_1} \label{eq:RotatingFrame-r-1} \\
              m \ddot r_2 &= -m \bigl(2 W_0 \dot r_1 + W_0 W_2 r_0 + W_1 W_2 r_1 + r_1 \Omega_0'(t) + A_2(t) \nonumber \\
                &\quad - 2 W_1 \dot r_0 - r_0 \Omega_1'(t) - W_1^2 r_2 - W_0^2 r_2\bigr) - \frac{\partial U}{\partial r_2} \label{eq:RotatingFrame-r-2} \\
              p_{r, 0} &= m (W_1 r_2 - W_2 r_1) + m \dot r_0 \label{eq:RotatingFrame-p_r-0} \\
              p_{r, 1} &= m (W_2 r_0 - W_0 r_2) + m \dot r_1 \label{eq:RotatingFrame-p_r-1} \\
              p_{r, 2} &= m (W_0 r_1 - W_1 r_0) + m \dot r_2 \label{eq:RotatingFrame-p_r-2} \\
              H &= m (r_0 A_0(t) + r_1 A_1(t) + r_2 A_2(t)) + W_1 r_0 p_{r, 2} + W_2 r_1 p_{r, 0} \nonumber \\
                &\quad + W_0 r_2 p_{r, 1} + \frac{\tfrac{1}{2} (p_{r, 2}^2 + p_{r, 1}^2 + p_{r, 0}^2)}{m} + U(r) \nonumber \\
                &\quad - W_2 r_0 p_{r, 1} - W_0 r_1 p_{r, 2} - W_1 r_2 p_{r, 0} \label{eq:RotatingFrame-H} \\
              \dot r_0 &= W_2 r_1 + \frac{p_{r, 0}}{m} - W_1 r_2 \label{eq:RotatingFrame-0} \\
              \dot r_1 &= W_0 r_2 + \frac{p_{r, 1}}{m} - W_2 r_0 \label{eq:RotatingFrame-1} \\
              \dot r_2 &= W_1 r_0 + \frac{p_{r, 2}}{m} - W_0 r_1 \label{eq:RotatingFrame-2} \\
              \dot p_{r, 0} &= W_2 p_{r, 1} - m A_0(t) - \frac{\partial U}{\partial r_0} - W_1 p_{r, 2} \label{eq:RotatingFrame-_r-0} \\
              \dot p_{r, 1} &= W_0 p_{r, 2} - m A_1(t) - \frac{\partial U}{\partial r_1} - W_2 p_{r, 0} \label{eq:RotatingFrame-_r-1} \\
              \dot p_{r, 2} &= W_1 p_{r, 0} - m A_2(t) - \frac{\partial U}{\partial r_2} - W_0 p_{r, 1} \label{eq:RotatingFrame-_r-2}
            \end{align}
        "#]],
    );
}

#[test]
fn functions_families_and_vectors() {
    check(
        "#[coordinates(a: [2], b: [2], s)]
         #[function(pair(s) = interaction)]
         #[function(f(r: [2], s) = surface)]
         #[define(p[0] = a)]
         #[define(p[i in 1..3] = p[i-1] + b/i)]
         #[lagrangian(dot(a_dot, a_dot)/2 + norm(b_dot)^2/2 + s_dot^2/2 - pair(norm(a - b)) - f(a, s) - f([s, 1], s) - sum(i in 0..3, p[i][0]))]
         #[force(a: -k*a_dot)]
         #[constraint(meet: cross([a[0], a[1], 0], [b[0], b[1], 0])[2] = 0)]
         struct Everything { k: f64, interaction: Pair, surface: Surface }",
        expect![[r#"
            Everything

            Lagrangian
              L = ½ ȧ·ȧ + ½ |ḃ|² + ½ ṡ² − pair(|a − b|) − f(a, s) − f([s, 1], s) − (Σ(i = 0 … 2) p[i][0])
              p[0] = a
              p[i = 1 … 2] = p[i − 1] + b/i
              Q_a = −k ȧ

            Constraints
              meet: ([a[0], a[1], 0]×[b[0], b[1], 0])[2] = 0   (holonomic)

            Equations of motion
              a[0]: ä[0] = −k ȧ[0] − 3 − pair′(√((a[0] − b[0])² + (a[1] − b[1])²)) (a[0] − b[0])/√((a[0] − b[0])² + (a[1] − b[1])²) − (∂f/∂r[0])(a, s) + λ_meet b[1]
              a[1]: ä[1] = −k ȧ[1] − pair′(√((a[0] − b[0])² + (a[1] − b[1])²)) (a[1] − b[1])/√((a[0] − b[0])² + (a[1] − b[1])²) − (∂f/∂r[1])(a, s) − λ_meet b[0]
              b[0]: b̈[0] = pair′(√((a[0] − b[0])² + (a[1] − b[1])²)) (a[0] − b[0])/√((a[0] − b[0])² + (a[1] − b[1])²) − 5/2 − λ_meet a[1]
              b[1]: b̈[1] = pair′(√((a[0] − b[0])² + (a[1] − b[1])²)) (a[1] − b[1])/√((a[0] − b[0])² + (a[1] − b[1])²) + λ_meet a[0]
              s:    s̈ = −(∂f/∂s)(a, s) − (∂f/∂s)([s, 1], s) − (∂f/∂r[0])([s, 1], s)

            Constraint forces
              R_a[0] = λ_meet b[1]
              R_a[1] = −λ_meet b[0]
              R_b[0] = −λ_meet a[1]
              R_b[1] = λ_meet a[0]

            Momenta
              p_a[0] = ȧ[0]
              p_a[1] = ȧ[1]
              p_b[0] = ḃ[0]
              p_b[1] = ḃ[1]
              p_s = ṡ

            Hamiltonian
              H = a[0] + p[1][0] + p[2][0] + pair(√((a[0] − b[0])² + (a[1] − b[1])²)) + f(a, s) + f([s, 1], s) + ½ p_a[0]² + ½ p_a[1]² + ½ p_b[0]² + ½ p_b[1]² + ½ p_s²

            Hamilton's equations
              ȧ[0] = p_a[0]
              ȧ[1] = p_a[1]
              ḃ[0] = p_b[0]
              ḃ[1] = p_b[1]
              ṡ = p_s
              ṗ_a[0] = λ_meet b[1] − 3 − (∂f/∂r[0])(a, s) − (a[0] − b[0]) pair′(√((a[0] − b[0])² + (a[1] − b[1])²))/√((a[0] − b[0])² + (a[1] − b[1])²) − k p_a[0]
              ṗ_a[1] = −(∂f/∂r[1])(a, s) − (a[1] − b[1]) pair′(√((a[0] − b[0])² + (a[1] − b[1])²))/√((a[0] − b[0])² + (a[1] − b[1])²) − λ_meet b[0] − k p_a[1]
              ṗ_b[0] = (a[0] − b[0]) pair′(√((a[0] − b[0])² + (a[1] − b[1])²))/√((a[0] − b[0])² + (a[1] − b[1])²) − 5/2 − λ_meet a[1]
              ṗ_b[1] = (a[1] − b[1]) pair′(√((a[0] − b[0])² + (a[1] − b[1])²))/√((a[0] − b[0])² + (a[1] − b[1])²) + λ_meet a[0]
              ṗ_s = −(∂f/∂r[0])([s, 1], s) − (∂f/∂s)([s, 1], s) − (∂f/∂s)(a, s)
        "#]],
        expect![[r#"
            \begin{align}
              L &= \tfrac{1}{2} \dot a \cdot \dot a + \tfrac{1}{2} \lvert \dot b \rvert^2 + \tfrac{1}{2} \dot s^2 \nonumber \\
                &\quad - \mathit{pair}(\lvert a - b \rvert) - f(a, s) \nonumber \\
                &\quad - f([s, 1], s) - \left( \sum_{i = 0}^{2} p_{i, 0} \right) \label{eq:Everything-L} \\
              p_0 &= a \label{eq:Everything-p-0} \\
              p_{i = 1 \ldots 2} &= p_{i - 1} + \frac{b}{i} \label{eq:Everything-p-i-1-2} \\
              Q_a &= -k \dot a \label{eq:Everything-Q_a} \\
              ([a_0, a_1, 0] \times [b_0, b_1, 0])_2 &= 0 \label{eq:Everything-meet} \\
              \ddot a_0 &= -k \dot a_0 - 3 \nonumber \\
                &\quad - \frac{\mathit{pair}'\left( \sqrt{(a_0 - b_0)^2 + (a_1 - b_1)^2} \right)}{\sqrt{(a_0 - b_0)^2 + (a_1 - b_1)^2}} \bigl(a_0 \nonumber \\
                &\quad - b_0\bigr) - \left( \frac{\partial f}{\partial r_0} \right)(a, s) + \lambda_{\mathrm{meet}} b_1 \label{eq:Everything-a-0} \\
              \ddot a_1 &= -k \dot a_1 \nonumber \\
                &\quad - \frac{\mathit{pair}'\left( \sqrt{(a_0 - b_0)^2 + (a_1 - b_1)^2} \right)}{\sqrt{(a_0 - b_0)^2 + (a_1 - b_1)^2}} \bigl(a_1 \nonumber \\
                &\quad - b_1\bigr) - \left( \frac{\partial f}{\partial r_1} \right)(a, s) - \lambda_{\mathrm{meet}} b_0 \label{eq:Everything-a-1} \\
              \ddot b_0 &= \frac{\mathit{pair}'\left( \sqrt{(a_0 - b_0)^2 + (a_1 - b_1)^2} \right)}{\sqrt{(a_0 - b_0)^2 + (a_1 - b_1)^2}} \bigl(a_0 \nonumber \\
                &\quad - b_0\bigr) - \tfrac{5}{2} - \lambda_{\mathrm{meet}} a_1 \label{eq:Everything-b-0} \\
              \ddot b_1 &= \frac{\mathit{pair}'\left( \sqrt{(a_0 - b_0)^2 + (a_1 - b_1)^2} \right)}{\sqrt{(a_0 - b_0)^2 + (a_1 - b_1)^2}} \bigl(a_1 \nonumber \\
                &\quad - b_1\bigr) + \lambda_{\mathrm{meet}} a_0 \label{eq:Everything-b-1} \\
              \ddot s &= -\left( \frac{\partial f}{\partial s} \right)(a, s) - \left( \frac{\partial f}{\partial s} \right)([s, 1], s) \nonumber \\
                &\quad - \left( \frac{\partial f}{\partial r_0} \right)([s, 1], s) \label{eq:Everything-s} \\
              R_{a, 0} &= \lambda_{\mathrm{meet}} b_1 \label{eq:Everything-R_a-0} \\
              R_{a, 1} &= -\lambda_{\mathrm{meet}} b_0 \label{eq:Everything-R_a-1} \\
              R_{b, 0} &= -\lambda_{\mathrm{meet}} a_1 \label{eq:Everything-R_b-0} \\
              R_{b, 1} &= \lambda_{\mathrm{meet}} a_0 \label{eq:Everything-R_b-1} \\
              p_{a, 0} &= \dot a_0 \label{eq:Everything-p_a-0} \\
              p_{a, 1} &= \dot a_1 \label{eq:Everything-p_a-1} \\
              p_{b, 0} &= \dot b_0 \label{eq:Everything-p_b-0} \\
              p_{b, 1} &= \dot b_1 \label{eq:Everything-p_b-1} \\
              p_s &= \dot s \label{eq:Everything-p_s} \\
              H &= a_0 + p_{1, 0} + p_{2, 0} \nonumber \\
                &\quad + \mathit{pair}\left( \sqrt{(a_0 - b_0)^2 + (a_1 - b_1)^2} \right) \nonumber \\
                &\quad + f(a, s) + f([s, 1], s) + \tfrac{1}{2} p_{a, 0}^2 \nonumber \\
                &\quad + \tfrac{1}{2} p_{a, 1}^2 + \tfrac{1}{2} p_{b, 0}^2 + \tfrac{1}{2} p_{b, 1}^2 \nonumber \\
                &\quad + \tfrac{1}{2} p_s^2 \label{eq:Everything-H} \\
              \dot a_0 &= p_{a, 0} \label{eq:Everything-0} \\
              \dot a_1 &= p_{a, 1} \label{eq:Everything-1} \\
              \dot b_0 &= p_{b, 0} \label{eq:Everything-0-2} \\
              \dot b_1 &= p_{b, 1} \label{eq:Everything-1-2} \\
              \dot s &= p_s \label{eq:Everything-} \\
              \dot p_{a, 0} &= \lambda_{\mathrm{meet}} b_1 - 3 - \left( \frac{\partial f}{\partial r_0} \right)(a, s) \nonumber \\
                &\quad - \frac{(a_0 - b_0) \, \mathit{pair}'\left( \sqrt{(a_0 - b_0)^2 + (a_1 - b_1)^2} \right)}{\sqrt{(a_0 - b_0)^2 + (a_1 - b_1)^2}} \nonumber \\
                &\quad - k p_{a, 0} \label{eq:Everything-_a-0} \\
              \dot p_{a, 1} &= -\left( \frac{\partial f}{\partial r_1} \right)(a, s) \nonumber \\
                &\quad - \frac{(a_1 - b_1) \, \mathit{pair}'\left( \sqrt{(a_0 - b_0)^2 + (a_1 - b_1)^2} \right)}{\sqrt{(a_0 - b_0)^2 + (a_1 - b_1)^2}} \nonumber \\
                &\quad - \lambda_{\mathrm{meet}} b_0 - k p_{a, 1} \label{eq:Everything-_a-1} \\
              \dot p_{b, 0} &= \frac{(a_0 - b_0) \, \mathit{pair}'\left( \sqrt{(a_0 - b_0)^2 + (a_1 - b_1)^2} \right)}{\sqrt{(a_0 - b_0)^2 + (a_1 - b_1)^2}} \nonumber \\
                &\quad - \tfrac{5}{2} - \lambda_{\mathrm{meet}} a_1 \label{eq:Everything-_b-0} \\
              \dot p_{b, 1} &= \frac{(a_1 - b_1) \, \mathit{pair}'\left( \sqrt{(a_0 - b_0)^2 + (a_1 - b_1)^2} \right)}{\sqrt{(a_0 - b_0)^2 + (a_1 - b_1)^2}} \nonumber \\
                &\quad + \lambda_{\mathrm{meet}} a_0 \label{eq:Everything-_b-1} \\
              \dot p_s &= -\left( \frac{\partial f}{\partial r_0} \right)([s, 1], s) \nonumber \\
                &\quad - \left( \frac{\partial f}{\partial s} \right)([s, 1], s) - \left( \frac{\partial f}{\partial s} \right)(a, s) \label{eq:Everything-_s}
            \end{align}
        "#]],
    );
}

/// What frames would be cheaper for is told so, where the equations stand.
#[test]
fn positions_by_turns_are_told_of_frames() {
    let source = "#[coordinates(a, b, c)]
         #[define(x = rot_z(a)*rot_y(b)*rot_x(c)*centre)]
         #[lagrangian(m/2*dot(der(x), der(x)) + J/2*(a_dot^2 + b_dot^2 + c_dot^2))]
         struct Turned { m: f64, J: f64, centre: Vector3<f64> }";
    let Rendered { text, .. } = rendered(source);
    let (_, motion) = text.split_once("Equations of motion").expect("a heading");
    let (motion, _) = motion.split_once("\n\n").expect("a section after it");
    let note: Vec<&str> = motion.trim().lines().skip(3).map(str::trim).collect();
    expect![[r#"
        `der` differentiates here what three angles or more turn, one after another: say how the parts lie
        by `#[frame(…)]`, and what they do by `position(…)`, `velocity(…)` and `kinetic(…)`, and the accelerations
        take fewer operations (see lagrange_core::language#frames)."#]].assert_eq(&note.join("\n"));
}
