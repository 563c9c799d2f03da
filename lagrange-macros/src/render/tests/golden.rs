//! Entire systems as rendered. `UPDATE_EXPECT=1 cargo test` accepts a change.

use expect_test::{Expect, expect};

use super::reader::assert_balanced;
use crate::diagnostics::Diagnostics;
use crate::render::{Rendered, render};
use crate::{mechanics, resolve, syntax};

pub(super) fn rendered(source: &str) -> Rendered {
    let mut diagnostics = Diagnostics::default();
    let input = syn::parse_str(source).expect("a struct");
    let declaration = syntax::declaration(input, &mut diagnostics);
    let (mut graph, problem) =
        resolve::problem(&declaration, &mut diagnostics).unwrap_or_else(|| panic!("errors in {source}"));
    let derived = mechanics::derive(&mut graph, &problem, &mut diagnostics).expect("no errors");
    render(&declaration, &graph, &problem, &derived)
}

pub(super) fn check(source: &str, text: Expect, latex: Expect) {
    let rendered = rendered(source);
    let [[shortest, in_latex, _], ..] = rendered.forms;
    assert_balanced(&in_latex);
    text.assert_eq(&shortest);
    latex.assert_eq(&in_latex);
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
              R_φ = −a λ_no_slip

            Conserved
              E = ½ m ẋ² + ½ inertia φ̇² − m g x sin α   (T + U if U is −m g x sin α)

            Momenta
              p_x = m ẋ
              p_φ = inertia φ̇

            Hamiltonian
              H = p_x²/(2 m) + p_φ²/(2 inertia) − m g x sin α

            Hamilton's equations
              ẋ = p_x/m
              φ̇ = p_φ/inertia
              ṗ_x = m g sin α + λ_no_slip
              ṗ_φ = −a λ_no_slip
        "#]],
        expect![[r#"
            \begingroup\allowdisplaybreaks
            \par\medskip\noindent\textbf{Lagrangian}
            \begin{align}
              L &= \tfrac{1}{2} m \dot x^2 + \tfrac{1}{2} \, \mathit{inertia} \, \dot\varphi^2 + m g x \sin \alpha \label{eq:RollingSphere-L} \\
              \mathit{inertia} &= \tfrac{2}{5} m a^2 \label{eq:RollingSphere-inertia}
            \end{align}
            \par\medskip\noindent\textbf{Constraints}
            \begin{align}
              \dot x - a \dot\varphi &= 0 \quad \text{(integrable: }x - a \varphi\text{ is constant)} \label{eq:RollingSphere-no_slip}
            \end{align}
            \par\medskip\noindent\textbf{Equations of motion}
            \begin{align}
              m \ddot x &= m g \sin \alpha + \lambda_{\mathrm{no}\,\mathrm{slip}} \label{eq:RollingSphere-x} \\
              \mathit{inertia} \, \ddot\varphi &= -a \lambda_{\mathrm{no}\,\mathrm{slip}} \label{eq:RollingSphere-phi}
            \end{align}
            \par\medskip\noindent\textbf{Constraint forces}
            \begin{align}
              R_x &= \lambda_{\mathrm{no}\,\mathrm{slip}} \label{eq:RollingSphere-R_x} \\
              R_\varphi &= -a \lambda_{\mathrm{no}\,\mathrm{slip}} \label{eq:RollingSphere-R_phi}
            \end{align}
            \par\medskip\noindent\textbf{Conserved}
            \begin{align}
              E &= \tfrac{1}{2} m \dot x^2 + \tfrac{1}{2} \, \mathit{inertia} \, \dot\varphi^2 - m g x \sin \alpha \nonumber \\*
                &\quad \quad \text{(}T + U\text{ if }U\text{ is }-m g x \sin \alpha\text{)} \label{eq:RollingSphere-E}
            \end{align}
            \par\medskip\noindent\textbf{Momenta}
            \begin{align}
              p_x &= m \dot x \label{eq:RollingSphere-p_x} \\
              p_\varphi &= \mathit{inertia} \, \dot\varphi \label{eq:RollingSphere-p_phi}
            \end{align}
            \par\medskip\noindent\textbf{Hamiltonian}
            \begin{align}
              H &= \frac{p_x^2}{2 m} + \frac{p_\varphi^2}{2 \, \mathit{inertia}} - m g x \sin \alpha \label{eq:RollingSphere-H}
            \end{align}
            \par\medskip\noindent\textbf{Hamilton's equations}
            \begin{align}
              \dot x &= \frac{p_x}{m} \label{eq:RollingSphere-x-dot} \\
              \dot\varphi &= \frac{p_\varphi}{\mathit{inertia}} \label{eq:RollingSphere-phi-dot} \\
              \dot p_x &= m g \sin \alpha + \lambda_{\mathrm{no}\,\mathrm{slip}} \label{eq:RollingSphere-p-dot_x} \\
              \dot p_\varphi &= -a \lambda_{\mathrm{no}\,\mathrm{slip}} \label{eq:RollingSphere-p-dot_phi}
            \end{align}
            \endgroup
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
              E = ½ m (ẋ² + ẏ² + ż²) + m g z   (T + U if U is m g z)

            Momenta
              p_x = m ẋ
              p_y = m ẏ
              p_z = m ż

            Hamiltonian
              H = (p_x² + p_y² + p_z²)/(2 m) + m g z

            Hamilton's equations
              ẋ = p_x/m
              ẏ = p_y/m
              ż = p_z/m
              ṗ_x = λ_string x
              ṗ_y = λ_string y
              ṗ_z = λ_string z − m g
        "#]],
        expect![[r#"
            \begingroup\allowdisplaybreaks
            \par\medskip\noindent\textbf{Lagrangian}
            \begin{align}
              L &= \tfrac{1}{2} m (\dot x^2 + \dot y^2 + \dot z^2) - m g z \label{eq:SphericalPendulum-L}
            \end{align}
            \par\medskip\noindent\textbf{Constraints}
            \begin{align}
              \tfrac{1}{2} (x^2 + y^2 + z^2 - l^2) &= 0 \quad \text{(holonomic)} \label{eq:SphericalPendulum-string}
            \end{align}
            \par\medskip\noindent\textbf{Equations of motion}
            \begin{align}
              m \ddot x &= \lambda_{\mathrm{string}} x \label{eq:SphericalPendulum-x} \\
              m \ddot y &= \lambda_{\mathrm{string}} y \label{eq:SphericalPendulum-y} \\
              m \ddot z &= -m g + \lambda_{\mathrm{string}} z \label{eq:SphericalPendulum-z}
            \end{align}
            \par\medskip\noindent\textbf{Constraint forces}
            \begin{align}
              R_x &= \lambda_{\mathrm{string}} x \label{eq:SphericalPendulum-R_x} \\
              R_y &= \lambda_{\mathrm{string}} y \label{eq:SphericalPendulum-R_y} \\
              R_z &= \lambda_{\mathrm{string}} z \label{eq:SphericalPendulum-R_z}
            \end{align}
            \par\medskip\noindent\textbf{Conserved}
            \begin{align}
              E &= \tfrac{1}{2} m (\dot x^2 + \dot y^2 + \dot z^2) + m g z \quad \text{(}T + U\text{ if }U\text{ is }m g z\text{)} \label{eq:SphericalPendulum-E}
            \end{align}
            \par\medskip\noindent\textbf{Momenta}
            \begin{align}
              p_x &= m \dot x \label{eq:SphericalPendulum-p_x} \\
              p_y &= m \dot y \label{eq:SphericalPendulum-p_y} \\
              p_z &= m \dot z \label{eq:SphericalPendulum-p_z}
            \end{align}
            \par\medskip\noindent\textbf{Hamiltonian}
            \begin{align}
              H &= \frac{p_x^2 + p_y^2 + p_z^2}{2 m} + m g z \label{eq:SphericalPendulum-H}
            \end{align}
            \par\medskip\noindent\textbf{Hamilton's equations}
            \begin{align}
              \dot x &= \frac{p_x}{m} \label{eq:SphericalPendulum-x-dot} \\
              \dot y &= \frac{p_y}{m} \label{eq:SphericalPendulum-y-dot} \\
              \dot z &= \frac{p_z}{m} \label{eq:SphericalPendulum-z-dot} \\
              \dot p_x &= \lambda_{\mathrm{string}} x \label{eq:SphericalPendulum-p-dot_x} \\
              \dot p_y &= \lambda_{\mathrm{string}} y \label{eq:SphericalPendulum-p-dot_y} \\
              \dot p_z &= \lambda_{\mathrm{string}} z - m g \label{eq:SphericalPendulum-p-dot_z}
            \end{align}
            \endgroup
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
              θ: l θ̈ = l φ̇² sin θ cos θ − g sin θ
              φ: φ̈ sin θ = −2 θ̇ φ̇ cos θ

            Conserved
              p_φ = m l² φ̇ sin² θ
              E = ½ m l² (θ̇² + φ̇² sin² θ) − m g l cos θ   (T + U if U is −m g l cos θ)

            Momenta
              p_θ = m l² θ̇

            Hamiltonian
              H = p_θ²/(2 m l²) + p_φ²/(2 m l² sin² θ) − m g l cos θ

            Hamilton's equations
              θ̇ = p_θ/(m l²)
              φ̇ = p_φ/(m l² sin² θ)
              ṗ_θ = p_φ² cos(θ)/(m l² sin³ θ) − m g l sin θ
              ṗ_φ = 0
        "#]],
        expect![[r#"
            \begingroup\allowdisplaybreaks
            \par\medskip\noindent\textbf{Lagrangian}
            \begin{align}
              L &= \tfrac{1}{2} m l^2 (\dot\theta^2 + \sin^2(\theta) \dot\varphi^2) + m g l \cos \theta \label{eq:SphericalPendulum-L}
            \end{align}
            \par\medskip\noindent\textbf{Equations of motion}
            \begin{align}
              l \ddot\theta &= l \dot\varphi^2 \sin \theta \cos \theta - g \sin \theta \label{eq:SphericalPendulum-theta} \\
              \ddot\varphi \sin \theta &= -2 \dot\theta \dot\varphi \cos \theta \label{eq:SphericalPendulum-phi}
            \end{align}
            \par\medskip\noindent\textbf{Conserved}
            \begin{align}
              p_\varphi &= m l^2 \dot\varphi \sin^2 \theta \label{eq:SphericalPendulum-p_phi} \\
              E &= \tfrac{1}{2} m l^2 (\dot\theta^2 + \dot\varphi^2 \sin^2 \theta) - m g l \cos \theta \nonumber \\*
                &\quad \quad \text{(}T + U\text{ if }U\text{ is }-m g l \cos \theta\text{)} \label{eq:SphericalPendulum-E}
            \end{align}
            \par\medskip\noindent\textbf{Momenta}
            \begin{align}
              p_\theta &= m l^2 \dot\theta \label{eq:SphericalPendulum-p_theta}
            \end{align}
            \par\medskip\noindent\textbf{Hamiltonian}
            \begin{align}
              H &= \frac{p_\theta^2}{2 m l^2} + \frac{p_\varphi^2}{2 m l^2 \sin^2 \theta} - m g l \cos \theta \label{eq:SphericalPendulum-H}
            \end{align}
            \par\medskip\noindent\textbf{Hamilton's equations}
            \begin{align}
              \dot\theta &= \frac{p_\theta}{m l^2} \label{eq:SphericalPendulum-theta-dot} \\
              \dot\varphi &= \frac{p_\varphi}{m l^2 \sin^2 \theta} \label{eq:SphericalPendulum-phi-dot} \\
              \dot p_\theta &= \frac{p_\varphi^2 \cos \theta}{m l^2 \sin^3 \theta} - m g l \sin \theta \label{eq:SphericalPendulum-p-dot_theta} \\
              \dot p_\varphi &= 0 \label{eq:SphericalPendulum-p-dot_phi}
            \end{align}
            \endgroup
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
              r: m r̈ = m (r×Ω′(t) + 2 (ṙ×W) − W×(W×r) − A(t)) − ∂U/∂r

            Energy
              E = ½ m ṙ·ṙ + m A(t)·r − ½ m (W×r)·(W×r) + U(r)   (L₂ − L₀ by degree in the velocities)
              d/dt E = m Ω[0]′(t) (W[1] r[0] r[1] + W[2] r[0] r[2] − W[0] (r[1]² + r[2]²)) + m Ω[1]′(t) (W[0] r[0] r[1] + W[2] r[1] r[2] − W[1] (r[0]² + r[2]²)) + m Ω[2]′(t) (W[0] r[0] r[2] + W[1] r[1] r[2] − W[2] (r[0]² + r[1]²)) + m A′(t)·r − m Ω′(t)·(r×ṙ)   (−∂L/∂t)

            Momenta
              p_r = m ṙ + m (W×r)

            Hamiltonian
              H = (p_r·p_r)/(2 m) − W·(r×p_r) + m A(t)·r + U(r)

            Hamilton's equations
              ṙ = p_r/m + r×W
              ṗ_r = p_r×W − m A(t) − ∂U/∂r
        "#]],
        expect![[r#"
            \begingroup\allowdisplaybreaks
            \par\medskip\noindent\textbf{Lagrangian}
            \begin{align}
              L &= \tfrac{1}{2} m \mathbf{v} \cdot \mathbf{v} + \tfrac{1}{2} m (\mathbf{W} \times \mathbf{r}) \cdot (\mathbf{W} \times \mathbf{r}) + m \mathbf{v} \cdot (\mathbf{W} \times \mathbf{r}) \nonumber \\*
                &\quad - U(\mathbf{r}) - m \mathbf{r} \cdot \mathbf{A}(t) \label{eq:RotatingFrame-L} \\
              \mathbf{v} &= \dot{\mathbf{r}} \label{eq:RotatingFrame-v} \\
              \mathbf{W} &= \boldsymbol{\Omega}(t) \label{eq:RotatingFrame-W}
            \end{align}
            \par\medskip\noindent\textbf{Equations of motion}
            \begin{align}
              m \ddot{\mathbf{r}} &= m (\mathbf{r} \times \boldsymbol{\Omega}'(t) + 2 (\dot{\mathbf{r}} \times \mathbf{W}) - \mathbf{W} \times (\mathbf{W} \times \mathbf{r}) - \mathbf{A}(t)) - \frac{\partial U}{\partial \mathbf{r}} \label{eq:RotatingFrame-r}
            \end{align}
            \par\medskip\noindent\textbf{Energy}
            \begin{align}
              E &= \tfrac{1}{2} m \dot{\mathbf{r}} \cdot \dot{\mathbf{r}} + m \mathbf{A}(t) \cdot \mathbf{r} - \tfrac{1}{2} m (\mathbf{W} \times \mathbf{r}) \cdot (\mathbf{W} \times \mathbf{r}) \nonumber \\*
                &\quad + U(\mathbf{r}) \quad \text{(}L_2 - L_0\text{ by degree in the velocities)} \label{eq:RotatingFrame-E} \\
              \frac{d}{dt} E &= m \Omega_0'(t) (W_1 r_0 r_1 + W_2 r_0 r_2 - W_0 (r_1^2 + r_2^2)) \nonumber \\*
                &\quad + m \Omega_1'(t) (W_0 r_0 r_1 + W_2 r_1 r_2 - W_1 (r_0^2 + r_2^2)) \nonumber \\*
                &\quad + m \Omega_2'(t) (W_0 r_0 r_2 + W_1 r_1 r_2 - W_2 (r_0^2 + r_1^2)) \nonumber \\*
                &\quad + m \mathbf{A}'(t) \cdot \mathbf{r} - m \boldsymbol{\Omega}'(t) \cdot (\mathbf{r} \times \dot{\mathbf{r}}) \quad \text{(}-\frac{\partial L}{\partial t}\text{)} \label{eq:RotatingFrame-d-dt-E}
            \end{align}
            \par\medskip\noindent\textbf{Momenta}
            \begin{align}
              \mathbf{p}_r &= m \dot{\mathbf{r}} + m (\mathbf{W} \times \mathbf{r}) \label{eq:RotatingFrame-p_r}
            \end{align}
            \par\medskip\noindent\textbf{Hamiltonian}
            \begin{align}
              H &= \frac{\mathbf{p}_r \cdot \mathbf{p}_r}{2 m} - \mathbf{W} \cdot (\mathbf{r} \times \mathbf{p}_r) + m \mathbf{A}(t) \cdot \mathbf{r} + U(\mathbf{r}) \label{eq:RotatingFrame-H}
            \end{align}
            \par\medskip\noindent\textbf{Hamilton's equations}
            \begin{align}
              \dot{\mathbf{r}} &= \frac{\mathbf{p}_r}{m} + \mathbf{r} \times \mathbf{W} \label{eq:RotatingFrame-r-dot} \\
              \dot{\mathbf{p}}_r &= \mathbf{p}_r \times \mathbf{W} - m \mathbf{A}(t) - \frac{\partial U}{\partial \mathbf{r}} \label{eq:RotatingFrame-p-dot_r}
            \end{align}
            \endgroup
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
              a[0]: ä[0] = pair′(|a − b|) (b[0] − a[0])/|a − b| − k ȧ[0] − 3 − (∂f/∂r[0])(a, s) + λ_meet b[1]
              a[1]: ä[1] = pair′(|a − b|) (b[1] − a[1])/|a − b| − k ȧ[1] − (∂f/∂r[1])(a, s) − λ_meet b[0]
              b[0]: b̈[0] = pair′(|a − b|) (a[0] − b[0])/|a − b| − 5/2 − λ_meet a[1]
              b[1]: b̈[1] = pair′(|a − b|) (a[1] − b[1])/|a − b| + λ_meet a[0]
              s:    s̈ = −(∂f/∂s)(a, s) − (∂f/∂s)([s, 1], s) − (∂f/∂r[0])([s, 1], s)

            Constraint forces
              R_a[0] = λ_meet b[1]
              R_a[1] = −λ_meet b[0]
              R_b[0] = −λ_meet a[1]
              R_b[1] = λ_meet a[0]

            Energy
              E = ½ ȧ·ȧ + ½ ḃ·ḃ + ½ ṡ² + a[0] + pair(|a − b|) + f(a, s) + f([s, 1], s) + p[2][0] + p[1][0]   (T + U if U is a[0] + pair(|a − b|) + f(a, s) + f([s, 1], s) + p[2][0] + p[1][0])
              d/dt E = −k ȧ·ȧ   (Q·q̇)

            Momenta
              p_a = ȧ
              p_b = ḃ
              p_s = ṡ

            Hamiltonian
              H = ½ p_a·p_a + ½ p_b·p_b + ½ p_s² + a[0] + pair(|a − b|) + f(a, s) + f([s, 1], s) + p[2][0] + p[1][0]

            Hamilton's equations
              ȧ = p_a
              ḃ = p_b
              ṡ = p_s
              ṗ_a[0] = pair′(|a − b|) (b[0] − a[0])/|a − b| − k p_a[0] − 3 − (∂f/∂r[0])(a, s) + λ_meet b[1]
              ṗ_a[1] = pair′(|a − b|) (b[1] − a[1])/|a − b| − k p_a[1] − (∂f/∂r[1])(a, s) − λ_meet b[0]
              ṗ_b[0] = pair′(|a − b|) (a[0] − b[0])/|a − b| − 5/2 − λ_meet a[1]
              ṗ_b[1] = pair′(|a − b|) (a[1] − b[1])/|a − b| + λ_meet a[0]
              ṗ_s = −(∂f/∂s)(a, s) − (∂f/∂s)([s, 1], s) − (∂f/∂r[0])([s, 1], s)
        "#]],
        expect![[r#"
            \begingroup\allowdisplaybreaks
            \par\medskip\noindent\textbf{Lagrangian}
            \begin{align}
              L &= \tfrac{1}{2} \dot{\mathbf{a}} \cdot \dot{\mathbf{a}} + \tfrac{1}{2} \lvert \dot{\mathbf{b}} \rvert^2 + \tfrac{1}{2} \dot s^2 - \mathit{pair}(\lvert \mathbf{a} - \mathbf{b} \rvert) - f(\mathbf{a}, s) \nonumber \\*
                &\quad - f([s, 1], s) - \left( \sum_{i = 0}^{2} p_{i, 0} \right) \label{eq:Everything-L} \\
              \mathbf{p}_0 &= \mathbf{a} \label{eq:Everything-p-0} \\
              \mathbf{p}_{i = 1 \ldots 2} &= \mathbf{p}_{i - 1} + \frac{\mathbf{b}}{i} \label{eq:Everything-p-i-1-2} \\
              \mathbf{Q}_a &= -k \dot{\mathbf{a}} \label{eq:Everything-Q_a}
            \end{align}
            \par\medskip\noindent\textbf{Constraints}
            \begin{align}
              ([a_0, a_1, 0] \times [b_0, b_1, 0])_2 &= 0 \quad \text{(holonomic)} \label{eq:Everything-meet}
            \end{align}
            \par\medskip\noindent\textbf{Equations of motion}
            \begin{align}
              \ddot a_0 &= \frac{\mathit{pair}'(\lvert \mathbf{a} - \mathbf{b} \rvert) (b_0 - a_0)}{\lvert \mathbf{a} - \mathbf{b} \rvert} - k \dot a_0 - 3 - \left( \frac{\partial f}{\partial r_0} \right)(\mathbf{a}, s) \nonumber \\*
                &\quad + \lambda_{\mathrm{meet}} b_1 \label{eq:Everything-a-0} \\
              \ddot a_1 &= \frac{\mathit{pair}'(\lvert \mathbf{a} - \mathbf{b} \rvert) (b_1 - a_1)}{\lvert \mathbf{a} - \mathbf{b} \rvert} - k \dot a_1 - \left( \frac{\partial f}{\partial r_1} \right)(\mathbf{a}, s) \nonumber \\*
                &\quad - \lambda_{\mathrm{meet}} b_0 \label{eq:Everything-a-1} \\
              \ddot b_0 &= \frac{\mathit{pair}'(\lvert \mathbf{a} - \mathbf{b} \rvert) (a_0 - b_0)}{\lvert \mathbf{a} - \mathbf{b} \rvert} - \tfrac{5}{2} - \lambda_{\mathrm{meet}} a_1 \label{eq:Everything-b-0} \\
              \ddot b_1 &= \frac{\mathit{pair}'(\lvert \mathbf{a} - \mathbf{b} \rvert) (a_1 - b_1)}{\lvert \mathbf{a} - \mathbf{b} \rvert} + \lambda_{\mathrm{meet}} a_0 \label{eq:Everything-b-1} \\
              \ddot s &= -\left( \frac{\partial f}{\partial s} \right)(\mathbf{a}, s) - \left( \frac{\partial f}{\partial s} \right)([s, 1], s) - \left( \frac{\partial f}{\partial r_0} \right)([s, 1], s) \label{eq:Everything-s}
            \end{align}
            \par\medskip\noindent\textbf{Constraint forces}
            \begin{align}
              R_{a, 0} &= \lambda_{\mathrm{meet}} b_1 \label{eq:Everything-R_a-0} \\
              R_{a, 1} &= -\lambda_{\mathrm{meet}} b_0 \label{eq:Everything-R_a-1} \\
              R_{b, 0} &= -\lambda_{\mathrm{meet}} a_1 \label{eq:Everything-R_b-0} \\
              R_{b, 1} &= \lambda_{\mathrm{meet}} a_0 \label{eq:Everything-R_b-1}
            \end{align}
            \par\medskip\noindent\textbf{Energy}
            \begin{align}
              E &= \tfrac{1}{2} \dot{\mathbf{a}} \cdot \dot{\mathbf{a}} + \tfrac{1}{2} \dot{\mathbf{b}} \cdot \dot{\mathbf{b}} + \tfrac{1}{2} \dot s^2 + a_0 + \mathit{pair}(\lvert \mathbf{a} - \mathbf{b} \rvert) \nonumber \\*
                &\quad + f(\mathbf{a}, s) + f([s, 1], s) + p_{2, 0} + p_{1, 0} \quad \text{(}T + U\text{ if }U\text{ is }a_0 \nonumber \\*
                &\quad + \mathit{pair}(\lvert \mathbf{a} - \mathbf{b} \rvert) + f(\mathbf{a}, s) + f([s, 1], s) + p_{2, 0} + p_{1, 0}\text{)} \label{eq:Everything-E} \\
              \frac{d}{dt} E &= -k \dot{\mathbf{a}} \cdot \dot{\mathbf{a}} \quad \text{(}Q \cdot \dot q\text{)} \label{eq:Everything-d-dt-E}
            \end{align}
            \par\medskip\noindent\textbf{Momenta}
            \begin{align}
              \mathbf{p}_a &= \dot{\mathbf{a}} \label{eq:Everything-p_a} \\
              \mathbf{p}_b &= \dot{\mathbf{b}} \label{eq:Everything-p_b} \\
              p_s &= \dot s \label{eq:Everything-p_s}
            \end{align}
            \par\medskip\noindent\textbf{Hamiltonian}
            \begin{align}
              H &= \tfrac{1}{2} \mathbf{p}_a \cdot \mathbf{p}_a + \tfrac{1}{2} \mathbf{p}_b \cdot \mathbf{p}_b + \tfrac{1}{2} p_s^2 + a_0 + \mathit{pair}(\lvert \mathbf{a} - \mathbf{b} \rvert) \nonumber \\*
                &\quad + f(\mathbf{a}, s) + f([s, 1], s) + p_{2, 0} + p_{1, 0} \label{eq:Everything-H}
            \end{align}
            \par\medskip\noindent\textbf{Hamilton's equations}
            \begin{align}
              \dot{\mathbf{a}} &= \mathbf{p}_a \label{eq:Everything-a-dot} \\
              \dot{\mathbf{b}} &= \mathbf{p}_b \label{eq:Everything-b-dot} \\
              \dot s &= p_s \label{eq:Everything-s-dot} \\
              \dot p_{a, 0} &= \frac{\mathit{pair}'(\lvert \mathbf{a} - \mathbf{b} \rvert) (b_0 - a_0)}{\lvert \mathbf{a} - \mathbf{b} \rvert} - k p_{a, 0} - 3 \nonumber \\*
                &\quad - \left( \frac{\partial f}{\partial r_0} \right)(\mathbf{a}, s) + \lambda_{\mathrm{meet}} b_1 \label{eq:Everything-p-dot_a-0} \\
              \dot p_{a, 1} &= \frac{\mathit{pair}'(\lvert \mathbf{a} - \mathbf{b} \rvert) (b_1 - a_1)}{\lvert \mathbf{a} - \mathbf{b} \rvert} - k p_{a, 1} - \left( \frac{\partial f}{\partial r_1} \right)(\mathbf{a}, s) \nonumber \\*
                &\quad - \lambda_{\mathrm{meet}} b_0 \label{eq:Everything-p-dot_a-1} \\
              \dot p_{b, 0} &= \frac{\mathit{pair}'(\lvert \mathbf{a} - \mathbf{b} \rvert) (a_0 - b_0)}{\lvert \mathbf{a} - \mathbf{b} \rvert} - \tfrac{5}{2} - \lambda_{\mathrm{meet}} a_1 \label{eq:Everything-p-dot_b-0} \\
              \dot p_{b, 1} &= \frac{\mathit{pair}'(\lvert \mathbf{a} - \mathbf{b} \rvert) (a_1 - b_1)}{\lvert \mathbf{a} - \mathbf{b} \rvert} + \lambda_{\mathrm{meet}} a_0 \label{eq:Everything-p-dot_b-1} \\
              \dot p_s &= -\left( \frac{\partial f}{\partial s} \right)(\mathbf{a}, s) - \left( \frac{\partial f}{\partial s} \right)([s, 1], s) - \left( \frac{\partial f}{\partial r_0} \right)([s, 1], s) \label{eq:Everything-p-dot_s}
            \end{align}
            \endgroup
        "#]],
    );
}

/// Systems for which frames are cheaper get that advice beside their equations.
#[test]
fn positions_by_turns_are_told_of_frames() {
    let source = "#[coordinates(a, b, c)]
         #[define(x = rot_z(a)*rot_y(b)*rot_x(c)*centre)]
         #[lagrangian(m/2*dot(der(x), der(x)) + J/2*(a_dot^2 + b_dot^2 + c_dot^2))]
         struct Turned { m: f64, J: f64, centre: Vector3<f64> }";
    let [[text, ..], ..] = rendered(source).forms;
    let (_, motion) = text.split_once("Equations of motion").expect("a heading");
    let (motion, _) = motion.split_once("\n\n").expect("a section after it");
    let note: Vec<&str> = motion.trim().lines().skip(3).map(str::trim).collect();
    expect![[r#"
        `der` differentiates here what three angles or more turn, one after another: say how the parts lie
        by `#[frame(…)]`, and what they do by `position(…)`, `velocity(…)` and `kinetic(…)`, and the accelerations
        take fewer operations (see lagrange_core::language#frames)."#]].assert_eq(&note.join("\n"));
}

/// Products are expanded, and sin² + cos² and the common factor of all terms are removed.
#[test]
fn a_mass_on_a_wedge_by_cartesian_coordinates() {
    let source = "#[coordinates(x)] #[define(px = x*cos(alpha))] #[define(py = -x*sin(alpha))]
         #[lagrangian(m/2*(der(px)^2 + der(py)^2) - m*g*py)] #[force(x: -k*x)]
         struct Wedge { m: f64, g: f64, alpha: f64, k: f64 }";
    let [[text, ..], [named, ..], [written_out, ..]] = rendered(source).forms;
    assert!(text.contains("x: m ẍ = m g sin α − k x"), "{text}");
    assert!(
        named.contains("− k x") && written_out.contains("L = ½ m ẋ² + m g x sin α"),
        "{named}{written_out}"
    );
}

/// Lines of a system between a heading and an empty line.
pub(super) fn lines(source: &str, heading: &str) -> String {
    let [[text, ..], ..] = rendered(source).forms;
    let (_, lines) = text.split_once(heading).unwrap_or_else(|| panic!("no {heading} in {text}"));
    lines.split("\n\n").next().unwrap_or_default().trim().to_owned()
}

#[test]
fn momenta_are_factored() {
    let bead = "#[coordinates(x)] #[define(y = x^2/(2*a))] #[lagrangian(m/2*(x_dot^2 + der(y)^2) - m*g*y)]
         struct Bead { m: f64, a: f64, g: f64 }";
    assert_eq!(lines(bead, "Momenta\n"), "p_x = m (1 + x²/a²) ẋ");
}

#[test]
fn a_momentum_that_is_conserved_is_written_once() {
    let free = "#[coordinates(r: [3], s)] #[lagrangian(m/2*dot(r_dot, r_dot) + s_dot^2/2 - s^2)]
         struct Free { m: f64 }";
    assert_eq!(lines(free, "Conserved\n"), "p_r = m ṙ\n  E = ½ m ṙ·ṙ + ½ ṡ² + s²   (T + U if U is s²)");
    assert_eq!(lines(free, "Momenta\n"), "p_s = ṡ");
    let falling = "#[coordinates(r: [3])] #[lagrangian(m/2*dot(r_dot, r_dot) - m*g*r[2])]
         struct Falling { m: f64, g: f64 }";
    assert!(lines(falling, "Conserved\n").starts_with("p_r[0] = m ṙ[0]\n  p_r[1] = m ṙ[1]"));
    assert_eq!(lines(falling, "Momenta\n"), "p_r = m ṙ");
}

/// Ω·(r×p) in a frame that turns at a constant rate, and the energy with (Ω×r)².
#[test]
fn scalars_of_vectors_are_products_of_vectors() {
    let turning = "#[coordinates(r: [3])] #[define(v = r_dot + cross(Omega, r))]
         #[lagrangian(m/2*dot(v, v) + G*m/norm(r))] struct Turning { m: f64, G: f64, Omega: Vector3<f64> }";
    assert_eq!(lines(turning, "Hamiltonian\n"), "H = (p_r·p_r)/(2 m) − Ω·(r×p_r) − G m/|r|");
    assert_eq!(
        lines(turning, "Conserved\n"),
        "E = ½ m ṙ·ṙ − G m/|r| − ½ m (Ω×r)·(Ω×r)   (L₂ − L₀ by degree in the velocities)"
    );
}

#[test]
fn halves_of_angles_are_put_together() {
    let half = "#[coordinates(theta)] #[define(y = 2*l*sin(theta/2)^2)]
         #[lagrangian(m*l^2/2*theta_dot^2 - m*g*y)] struct Half { m: f64, g: f64, l: f64 }";
    assert_eq!(lines(half, "Equations of motion\n"), "θ: l θ̈ = −g sin θ");
}

/// The suspension of the pendulum moves; the second constraint is a velocity constraint that is not integrable.
#[test]
fn constraints_say_their_kinds_in_every_form() {
    let source = "#[coordinates(x, y, z)] #[lagrangian((x_dot^2 + y_dot^2 + z_dot^2)/2 - g*y)]
         #[constraint(rod: (x - a*sin(omega*t))^2 + y^2 - l^2 = 0)] #[constraint(slide: z_dot - y*x_dot = 0)]
         struct Moved { g: f64, a: f64, omega: f64, l: f64 }";
    let [[text, latex, html], ..] = rendered(source).forms;
    for kind in ["(holonomic, rheonomic)", "(nonholonomic, as far as 8 points show)"] {
        assert!(text.contains(kind) && html.contains(kind), "{text}{html}");
        let clauses = kind.replace(", ", r", }\text{");
        assert!(latex.contains(&format!(r"\text{{{clauses}}}")), "{latex}");
    }
}

/// Goldstein, Poole and Safko, *Classical Mechanics*, 2.7: E is T + U if the coordinates do not move with time. L alone
/// cannot decide this, and the remark appears only if it is certain.
#[test]
fn the_energy_is_called_t_plus_u_where_that_is_certain() {
    let cases = [
        (
            "pendulum",
            "#[coordinates(theta)] #[lagrangian(m/2*l^2*theta_dot^2 + m*g*l*cos(theta))]
             struct S { m: f64, l: f64, g: f64 }",
            "Conserved\n",
            "E = ½ m l² θ̇² − m g l cos θ   (T + U if U is −m g l cos θ)",
        ),
        (
            "free",
            "#[coordinates(x)] #[lagrangian(m/2*x_dot^2)] #[force(x: -k*x)] struct S { m: f64, k: f64 }",
            "Energy\n",
            "E = ½ m ẋ²   (T if U is 0)\n  d/dt E = −k x ẋ   (Q·q̇)",
        ),
        // Here U is 0 and E is not T + U, so the remark must not claim it.
        (
            "bead on a wire that is turned",
            "#[coordinates(r)] #[lagrangian(m/2*(r_dot^2 + w^2*r^2))] struct S { m: f64, w: f64 }",
            "Conserved\n",
            "E = ½ m ṙ² − ½ m w² r²   (T + U if U is −½ m w² r²)",
        ),
        (
            "hoop that is turned, in space",
            "#[coordinates(theta)] #[define(x = a*sin(theta)*cos(w*t))] #[define(y = a*sin(theta)*sin(w*t))]
             #[define(z = -a*cos(theta))] #[lagrangian(m/2*(der(x)^2 + der(y)^2 + der(z)^2) - m*g*z)]
             struct S { m: f64, a: f64, w: f64, g: f64 }",
            "Conserved\n",
            "(not T + U, as positions move with time; conserved in all random motions tried)",
        ),
        (
            "rotating frame by hand",
            "#[coordinates(x, y)] #[lagrangian(m/2*((x_dot - w*y)^2 + (y_dot + w*x)^2))]
             struct S { m: f64, w: f64 }",
            "Conserved\n",
            "E = ½ m (ẋ² + ẏ²) − ½ m w² (x² + y²)   (L₂ − L₀ by degree in the velocities)",
        ),
        (
            "charge",
            "#[coordinates(x, y)] #[lagrangian(m/2*(x_dot^2 + y_dot^2) + q*B*x*y_dot - q*V*x)]
             struct S { m: f64, q: f64, B: f64, V: f64 }",
            "Conserved\n",
            "E = ½ m (ẋ² + ẏ²) + q V x   (L₂ − L₀ by degree in the velocities)",
        ),
        (
            "pendulum whose pivot is moved",
            "#[coordinates(theta)] #[define(x = a*cos(w*t) + l*sin(theta))] #[define(y = -l*cos(theta))]
             #[lagrangian(m/2*(der(x)^2 + der(y)^2) - m*g*y)]
             struct S { m: f64, l: f64, a: f64, w: f64, g: f64 }",
            "Energy\n",
            "(not T + U, as positions move with time)\n  d/dt E = ",
        ),
        (
            "body on a frame that is turned",
            "#[coordinates(r)] #[frame(arm: rotate_z(w*t))] #[frame(bead in arm: translate([r, 0, 0]))]
             #[lagrangian(kinetic(bead, m) - k/2*r^2)] struct S { m: f64, k: f64, w: f64 }",
            "Conserved\n",
            "(not T + U, as positions move with time)",
        ),
        (
            "velocity in a frame that is turned",
            "#[coordinates(r)] #[frame(arm: rotate_z(w*t))] #[define(v = velocity(arm, [r, 0, 0]))]
             #[lagrangian(m/2*dot(v, v) - k/2*r^2)] struct S { m: f64, k: f64, w: f64 }",
            "Conserved\n",
            "(not T + U, as positions move with time)",
        ),
        (
            "body on a frame that turns freely",
            "#[coordinates(a, r)] #[frame(arm: rotate_z(a))] #[frame(bead in arm: translate([r, 0, 0]))]
             #[lagrangian(kinetic(bead, m) - k/2*r^2)] struct S { m: f64, k: f64 }",
            "Conserved\n",
            "E = ½ m (r² ȧ² + ṙ²) + ½ k r²   (T + U)",
        ),
        // −½ m v² is kinetic energy along the string, not a part of U.
        (
            "pendulum that is pulled in",
            "#[coordinates(theta)] #[define(l = b - v*t)]
             #[lagrangian(m/2*(v^2 + l^2*theta_dot^2) + m*g*l*cos(theta))]
             struct S { m: f64, b: f64, v: f64, g: f64 }",
            "Energy\n",
            "E = ½ m l² θ̇² − m g l cos θ − ½ m v²   (L₂ − L₀ by degree in the velocities)",
        ),
        // A gauge term does not change the motion.
        (
            "total derivative",
            "#[coordinates(x)] #[lagrangian(m/2*x_dot^2 - k/2*x^2 + c*der(x*t))]
             struct S { m: f64, k: f64, c: f64 }",
            "Energy\n",
            "(L₂ − L₀ by degree in the velocities)\n  d/dt E = −c ẋ   (−∂L/∂t)",
        ),
        (
            "relativistic",
            "#[coordinates(x)] #[lagrangian(-m*c^2*sqrt(1 - x_dot^2/c^2) - k/2*x^2)]
             struct S { m: f64, c: f64, k: f64 }",
            "Conserved\n",
            "(p·q̇ − L)",
        ),
        (
            "constraint that is moved",
            "#[coordinates(x, y)] #[lagrangian(m/2*(x_dot^2 + y_dot^2))]
             #[constraint(rod: (x - a*sin(w*t))^2 + y^2 = l^2)] struct S { m: f64, a: f64, w: f64, l: f64 }",
            "Energy\n",
            "(T if U is 0)\n  d/dt E = 2 a w λ_rod (x − a sin(w t)) cos(w t)   (−λ·b)",
        ),
    ];
    let missed = cases.into_iter().filter_map(|(what, source, heading, line)| {
        let printed = lines(source, heading);
        (!printed.contains(line)).then(|| format!("{what}: {printed}"))
    });
    let missed: Vec<String> = missed.collect();
    assert!(missed.is_empty(), "{}", missed.join("\n"));
}

#[test]
fn a_hamiltonian_that_is_not_written_says_why() {
    let cases = [
        (
            "#[coordinates(x)] #[lagrangian(x_dot^4 + x_dot^2 - x^2)] struct S {}",
            "no closed form of the velocities by the momenta is known",
        ),
        (
            "#[coordinates(q: [4])] #[define(w = quat_rate_body(q, q_dot))]
             #[lagrangian(i/2*w[0]^2 + j/2*w[1]^2 + k/2*w[2]^2)] #[constraint(unit: dot(q, q) = 1)]
             struct S { i: f64, j: f64, k: f64 }",
            "the mass matrix is singular, and constraints decide on the velocities",
        ),
        (
            "#[coordinates(x: [10])] #[lagrangian(dot(x_dot, x_dot)/2 - x[0]*x[1])] struct S {}",
            "it is too long to be read",
        ),
    ];
    for (source, why) in cases {
        let note = format!("not written out, as {why}: `hamiltonian` computes it");
        assert_eq!(lines(source, "Hamiltonian\n"), note);
        let [[_, latex, html], ..] = rendered(source).forms;
        assert!(html.contains(&format!("<h5>Hamiltonian</h5>\n<p>{note}</p>")), "{html}");
        assert!(
            latex.contains(&note.replace('`', "").replace("hamiltonian", r"\texttt{hamiltonian}")),
            "{latex}"
        );
    }
    let relativistic = "#[coordinates(x)] #[lagrangian(-m*c^2*sqrt(1 - x_dot^2/c^2) - k/2*x^2)]
         struct S { m: f64, c: f64, k: f64 }";
    assert_eq!(lines(relativistic, "Momenta\n"), "p_x = m γ ẋ");
    assert!(lines(relativistic, "Lagrangian\n").ends_with("γ = 1/√(1 − ẋ²/c²)"));
}

/// The own acceleration of a row has a plus sign, also where that of another coordinate comes first.
#[test]
fn rows_are_positive_in_their_own_acceleration() {
    let sleigh = "#[coordinates(x, y, phi)] #[define(c = [x + a*cos(phi), y + a*sin(phi)])]
         #[lagrangian(m/2*dot(der(c), der(c)) + I/2*phi_dot^2)]
         #[constraint(skate: y_dot*cos(phi) - x_dot*sin(phi) = 0)] #[force(phi: torque)]
         struct Sleigh { m: f64, a: f64, I: f64, torque: f64 }";
    expect![[r#"
        x: m ẍ − m a φ̈ sin φ = m a φ̇² cos φ − λ_skate sin φ
          y: m ÿ + m a φ̈ cos φ = m a φ̇² sin φ + λ_skate cos φ
          φ: m a ÿ cos φ + (m a² + I) φ̈ − m a ẍ sin φ = torque"#]]
    .assert_eq(&lines(sleigh, "Equations of motion\n"));
    let particles =
        "#[coordinates(r: [2], s: [2])] #[lagrangian(-m*dot(r_dot, s_dot) + m/2*dot(s_dot, s_dot))]
         #[force(s: f)] struct Particles { m: f64, f: [f64; 2] }";
    expect![[r#"
        r: s̈ = 0
          s: m s̈ − m r̈ = f"#]]
    .assert_eq(&lines(particles, "Equations of motion\n"));
}

/// A constant stands before what changes with time, as the positions of motions are written.
#[test]
fn constants_come_before_times() {
    let lift = "#[coordinates(x, y)] #[lagrangian(m/2*(x_dot^2 + y_dot^2) - (U + V*cos(w*t))*x^2)]
         #[constraint(floor: x^2 + y^2 = (a + b*t)^2)]
         struct S { m: f64, U: f64, V: f64, w: f64, a: f64, b: f64 }";
    expect![[r#"
        E = ½ m (ẋ² + ẏ²) + x² (U + V cos(w t))   (T + U if U is x² (U + V cos(w t)))
          d/dt E = 2 b λ_floor (a + b t) − V w x² sin(w t)   (−∂L/∂t − λ·b)"#]]
    .assert_eq(&lines(lift, "Energy\n"));
}

/// Distances of two bodies and of one are told apart by the numbers of their coordinates.
#[test]
fn distances_of_one_body_have_its_number() {
    let planets = "#[coordinates(x1, y1, x2, y2)]
         #[lagrangian(m/2*(x1_dot^2 + y1_dot^2 + x2_dot^2 + y2_dot^2) + k/sqrt((x1 - x2)^2 + (y1 - y2)^2)
             + s/sqrt(x1^2 + y1^2) + s/sqrt(x2^2 + y2^2))]
         struct S { m: f64, k: f64, s: f64 }";
    expect![[r#"
        L = ½ m (ẋ₁² + ẏ₁² + ẋ₂² + ẏ₂²) + k/√((x₁ − x₂)² + (y₁ − y₂)²) + s/√(x₁² + y₁²) + s/√(x₂² + y₂²)
          r₁₂ = √((x₁ − x₂)² + (y₁ − y₂)²)
          r₁ = √(x₁² + y₁²)
          r₂ = √(x₂² + y₂²)"#]]
    .assert_eq(&lines(planets, "Lagrangian\n"));
}

/// A line of LaTeX breaks at a thin space between two words only in a term that is wider than a line.
#[test]
fn lines_do_not_break_at_thin_spaces() {
    let gyroscope = "#[coordinates(x, q: [4])] #[frame(gyro: translate([x, 0, h]), rotate(q))]
         #[lagrangian(M/2*x_dot^2 + kinetic(gyro, mass, [0, 0, length], inertia) - mass*g*position(gyro, [0, 0, length])[2])]
         struct S { M: f64, mass: f64, g: f64, h: f64, length: f64, inertia: Matrix3<f64> }";
    let [[_, latex, _], ..] = rendered(gyroscope).forms;
    assert!(
        latex.contains(r"\mathit{mass} \, \mathit{length} \, (1") && !latex.contains(r"\, \nonumber"),
        "{latex}"
    );
}

/// A ball's quaternion: q·q̇ = 0 and |q|² = 1.
#[test]
fn momenta_of_quaternions_are_those_on_the_sphere() {
    let ball = "#[coordinates(q: [4])] #[frame(ball: rotate(q))]
         #[lagrangian(kinetic(ball, 0, [0, 0, 0], j*identity(3)))] struct Ball { j: f64 }";
    expect!["p_q = 4 j q̇"].assert_eq(&lines(ball, "Momenta\n"));
}

/// Goldstein, Poole and Safko, *Classical Mechanics*, (5.39): the equation of a top in its angular velocity.
#[test]
fn bodies_turn_by_their_angular_velocities() {
    let top = "#[coordinates(q: [4])] #[frame(top: rotate(q))]
         #[lagrangian(kinetic(top, m, [0, 0, l], inertia) - m*g*position(top, [0, 0, l])[2])]
         struct Top { m: f64, g: f64, l: f64, inertia: Matrix3<f64> }";
    expect![[r#"
        q:   q̇ = ½ q ω_q   (product of quaternions, ω_q along the turned axes)
          ω_q: I_q ω̇_q + ω_q×(I_q ω_q) = [2 m g l (q[0] q[1] + q[2] q[3]), 2 m g l (q[0] q[2] − q[1] q[3]), 0]
          I_q = [[m l² + inertia[0][0], inertia[0][1], inertia[0][2]], [inertia[0][1], m l² + inertia[1][1], inertia[1][2]], [inertia[0][2], inertia[1][2], inertia[2][2]]]"#]]
    .assert_eq(&lines(top, "Equations of motion\n"));
    expect!["E = ½ ω_q·(I_q ω_q) + m g l (1 − 2 q[1]² − 2 q[2]²)   (T + U)"]
        .assert_eq(&lines(top, "Conserved\n"));
    // Where |q|² = 1 is needed to read −½ m A² ω² sin², the torque −¼ c ω of −c q̇ and the power of friction.
    let shaken = "#[coordinates(q: [4])] #[frame(top: translate([0, 0, A*cos(w*t)]), rotate(q))]
         #[define(spin = angular_velocity(top))]
         #[lagrangian(kinetic(top, m, [0, 0, l], inertia))] #[dissipation(b/2*dot(spin, spin))]
         #[force(q: -c*q_dot)]
         struct Shaken { m: f64, l: f64, A: f64, w: f64, b: f64, c: f64, inertia: Matrix3<f64> }";
    expect![[r#"
        q:   q̇ = ½ q ω_q   (product of quaternions, ω_q along the turned axes)
          ω_q: I_q ω̇_q + ω_q×(I_q ω_q) = [−(b + ¼ c) ω_q[0] − 2 m l A w² (q[0] q[1] + q[2] q[3]) cos(w t), 2 m l A w² (q[1] q[3] − q[0] q[2]) cos(w t) − (b + ¼ c) ω_q[1], −(b + ¼ c) ω_q[2]]
          I_q = [[m l² + inertia[0][0], inertia[0][1], inertia[0][2]], [inertia[0][1], m l² + inertia[1][1], inertia[1][2]], [inertia[0][2], inertia[1][2], inertia[2][2]]]"#]].assert_eq(&lines(shaken, "Equations of motion\n"));
    expect![[r#"
        E = ½ ω_q·(I_q ω_q) − ½ m A² w² sin²(w t)   (not T + U, as positions move with time)
          d/dt E = m A w² (2 l (q[1] q[3] − q[0] q[2]) ω_q[1] − 2 l (q[0] q[1] + q[2] q[3]) ω_q[0] − A w sin(w t)) cos(w t) − (b + ¼ c) ω_q·ω_q   (−∂L/∂t + Q·q̇)"#]].assert_eq(&lines(shaken, "Energy\n"));
    // The components of ω stand in their order.
    let rolling = "#[coordinates(q: [4])] #[frame(top: rotate(q))] #[define(axis = express(vector(top, [0, 0, 1]), fixed))]
         #[lagrangian(kinetic(top, 0, [0, 0, 0], [[A, 0, 0], [0, A, 0], [0, 0, C]]) - axis[2])]
         struct Top { A: f64, C: f64 }";
    expect!["E = ½ A (ω_q[0]² + ω_q[1]²) + ½ C ω_q[2]² + axis[2]   (T + U)"]
        .assert_eq(&lines(rolling, "Conserved\n"));
    // With a diagonal matrix the components are shorter: Euler's equations.
    let free = "#[coordinates(r: [3], q: [4])] #[frame(body: translate(r), rotate(q))]
         #[lagrangian(kinetic(body, m, [0, 0, 0], [[a, 0, 0], [0, b, 0], [0, 0, c]]))]
         struct Free { m: f64, a: f64, b: f64, c: f64 }";
    expect![[r#"
        r:      r̈ = 0
          q:      q̇ = ½ q ω_q   (product of quaternions, ω_q along the turned axes)
          ω_q[0]: a ω̇_q[0] = (b − c) ω_q[1] ω_q[2]
          ω_q[1]: b ω̇_q[1] = (c − a) ω_q[0] ω_q[2]
          ω_q[2]: c ω̇_q[2] = (a − b) ω_q[0] ω_q[1]"#]]
    .assert_eq(&lines(free, "Equations of motion\n"));
}
