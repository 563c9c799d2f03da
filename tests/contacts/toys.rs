//! Machines and toys with impacts and friction whose motions are published.

use lagrange_core::contact::{Contact, Transition};
use lagrange_core::{Ending, prelude::*};

/// The woodpecker toy: a sleeve (angle φ_M) with a woodpecker on a spring (φ_S) goes down a pole (y) by its own vibration
/// (Pfeiffer 1984). Model and numbers of Leine, Glocker and van Campen, "Nonlinear dynamics of the woodpecker toy", *DETC'01*,
/// 2001, whose constraints are linear in the angles: the beak hits the pole, and the sleeve jams at its upper or lower edge.
#[derive(Clone, Lagrangian)]
#[coordinates(y, phi_m, phi_s)]
#[lagrangian(
    (m_s + m_m)/2 * y_dot^2 + (j_m + m_s*l_m^2)/2 * phi_m_dot^2 + (j_s + m_s*l_g^2)/2 * phi_s_dot^2
    + m_s*l_m * y_dot*phi_m_dot + m_s*l_g * y_dot*phi_s_dot + m_s*l_m*l_g * phi_m_dot*phi_s_dot
    - c/2 * (phi_m - phi_s)^2 - (m_s + m_m)*g*y - m_s*g*l_m*phi_m - m_s*g*l_g*phi_s
)]
#[contact(beak: l_m + l_g - l_s - r_o - h_s*phi_s >= 0, restitution: e,
    friction(mu): y_dot + l_m*phi_m_dot + (l_g - l_s)*phi_s_dot)]
#[contact(lower: r_m - r_o + h_m*phi_m >= 0, friction(mu): y_dot + r_m*phi_m_dot)]
#[contact(upper: r_m - r_o - h_m*phi_m >= 0, friction(mu): y_dot + r_m*phi_m_dot)]
struct Woodpecker {
    m_m: f64,
    m_s: f64,
    j_m: f64,
    j_s: f64,
    c: f64,
    g: f64,
    r_o: f64,
    r_m: f64,
    h_m: f64,
    h_s: f64,
    l_m: f64,
    l_g: f64,
    l_s: f64,
    e: f64,
    mu: f64,
    beak: Contact,
    lower: Contact,
    upper: Contact,
}

const WOODPECKER: Woodpecker = Woodpecker {
    m_m: 0.0003,
    m_s: 0.0045,
    j_m: 5e-9,
    j_s: 7e-7,
    c: 0.0056,
    g: 9.81,
    r_o: 0.0025,
    r_m: 0.0031,
    h_m: 0.0058,
    h_s: 0.02,
    l_m: 0.010,
    l_g: 0.015,
    l_s: 0.0201,
    e: 0.5,
    mu: 0.3,
    beak: Contact::Open,
    lower: Contact::Closed,
    upper: Contact::Open,
};

/// A state of the periodic motion is published: φ_S = −0.2788, ẏ = −0.3411, φ̇_S = −7.4583, while the lower edge slides down.
/// Its fourth digits are not those of the model, whose sleeve jams at φ_M = −0.1034 and not at the published −0.1036: the
/// motion comes back to it within a percent, and to its own within what is left of its start, 0.84 of it per period.
#[test]
fn the_woodpecker_comes_down_its_pole_in_the_published_steps() {
    let lowest = -0.0006 / 0.0058;
    let start = State::new([0.0, lowest, -0.2788], [-0.3411, 0.0, -7.4583]);
    let path = WOODPECKER.motion(start).by(Dop853::with_tolerance(1e-11)).with_contacts().to(4.0).unwrap();
    let closes = path.transitions().iter().filter_map(|transition| match transition {
        Transition::Closes { contact: "lower", time } => Some(*time),
        _ => None,
    });
    let closes: Vec<f64> = closes.collect();
    assert!(closes.len() > 20, "{:?}", path.transitions());
    let angle = |t: f64| path.at(t).unwrap().coordinate("phi_s").unwrap();
    let mut returns = Vec::new();
    for &time in &closes[1..closes.len() - 1] {
        let (mut low, mut high) = (time, time + 0.04);
        assert!(angle(low) > -0.2788 && angle(high) < -0.2788);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            *if angle(middle) > -0.2788 { &mut low } else { &mut high } = middle;
        }
        let state = path.at(low).unwrap();
        let [v, omega] = ["y", "phi_s"].map(|name| state.velocity(name).unwrap());
        assert!((v + 0.3411).abs() < 0.01 * 0.3411, "{low}: {v}");
        assert!((omega + 7.4583).abs() < 0.005 * 7.4583, "{low}: {omega}");
        returns.push(v);
    }
    for three in returns.windows(3) {
        let ratio = (three[2] - three[1]) / (three[1] - three[0]);
        assert!((ratio + 0.84).abs() < 0.02, "{ratio}");
    }
}

/// A slender block that rocks from corner to corner on a rough floor (Housner, *Bulletin of the Seismological Society of America*
/// 53, 1963). At each impact its energy falls by the factor (1 − 3/2 sin² α)², its equation (8); the largest angle between
/// two impacts follows from the energy.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta)]
#[define(corner(s) = [x + s*b*cos(theta) + h*sin(theta), y + s*b*sin(theta) - h*cos(theta)])]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*(b^2 + h^2)/6 * theta_dot^2 - m*g*y)]
#[contact(floor[i in 0..2]: corner(2*i - 1)[1] >= 0, friction(mu): der(corner(2*i - 1))[0])]
struct Block {
    m: f64,
    b: f64,
    h: f64,
    g: f64,
    mu: f64,
    floor: [Contact; 2],
}

#[test]
fn a_block_rocks_as_housner_says() {
    let (b, h, g) = (0.1_f64, 0.5_f64, 9.81);
    let (r, alpha) = (b.hypot(h), (b / h).atan());
    let block = Block { m: 3.0, b, h, g, mu: 0.8, floor: [Contact::Closed, Contact::Open] };
    // It leans on the left corner, by θ > 0.
    let theta = 0.6 * alpha;
    let (s, c) = theta.sin_cos();
    let start = State::at_rest([b * c - h * s, b * s + h * c, theta]);
    let motion = block.motion(start).by(Dop853::with_tolerance(1e-12));
    let path = motion.with_contacts().to(3.0).unwrap();
    let impacts: Vec<f64> = path
        .transitions()
        .iter()
        .filter(|transition| matches!(transition, Transition::Impact { .. }))
        .map(Transition::time)
        .collect();
    assert!(impacts.len() > 4, "{:?}", path.transitions());
    let energy = |t: f64| {
        let at = path.at(t).unwrap();
        at.energy() - 3.0 * g * h
    };
    let ratio = (1.0 - 1.5 * alpha.sin().powi(2)).powi(2);
    let mut expected = 3.0 * g * r * ((alpha - theta).cos() - alpha.cos());
    for (impact, next) in impacts.iter().zip(&impacts[1..]) {
        let before = energy(impact - 1e-3);
        assert!((before - expected).abs() < 1e-9, "{before} for {expected}");
        expected *= ratio;
        // The largest angle, half way between two impacts.
        let top = path.at(0.5 * (impact + next)).unwrap();
        let largest = alpha - (alpha.cos() + expected / (3.0 * g * r)).acos();
        let found = top.coordinate("theta").unwrap().abs();
        assert!((found - largest).abs() < 1e-9, "{found} for {largest}");
    }
    assert!(matches!(path.ending(), Ending::Complete { .. }));
}
