//! Single lines as rendered. `UPDATE_EXPECT=1 cargo test` accepts a change.

use expect_test::expect;

use super::golden::rendered;

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
        E = ½ m (ẋ² + ẏ²) + x² (U + V cos(w t))   (T + Φ if Φ is x² (U + V cos(w t)))
          d/dt E = 2 b λ_floor (a + b t) − V w x² sin(w t)   (−∂L/∂t − λ·β)"#]]
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

/// The momentum of a ball by its quaternion is short because q·q̇ = 0 and |q|² = 1.
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
