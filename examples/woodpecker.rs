//! The woodpecker toy: a sleeve with a woodpecker on a spring comes down its pole by its own vibration. The sleeve jams by
//! friction at its lower edge, the woodpecker swings back and frees it; it falls, jams at its upper edge while the beak
//! hits the pole, and so on, seven times a second (Leine, Glocker and van Campen, "Nonlinear dynamics of the woodpecker
//! toy", *DETC'01*, 2001).

mod picture;

use lagrange_core::contact::{Contact, Transition};
use lagrange_core::prelude::*;
use picture::{BLUE, GREY, Panel, Points, RED, Result};

#[derive(Clone, Lagrangian)]
#[coordinates(y, sleeve, bird)]
#[lagrangian(
    (m + m_sleeve)/2 * y_dot^2 + (j_sleeve + m*a^2)/2 * sleeve_dot^2 + (j + m*b^2)/2 * bird_dot^2
    + m*a * y_dot*sleeve_dot + m*b * y_dot*bird_dot + m*a*b * sleeve_dot*bird_dot
    - c/2 * (sleeve - bird)^2 - (m + m_sleeve)*g*y - m*g*a*sleeve - m*g*b*bird
)]
#[contact(beak: reach - h_beak*bird >= 0, restitution: e, friction(mu): y_dot + a*sleeve_dot + (b - l)*bird_dot)]
#[contact(lower: play + h*sleeve >= 0, friction(mu): y_dot + r*sleeve_dot)]
#[contact(upper: play - h*sleeve >= 0, friction(mu): y_dot + r*sleeve_dot)]
struct Woodpecker {
    m: f64,
    m_sleeve: f64,
    j: f64,
    j_sleeve: f64,
    /// Stiffness of the spring between sleeve and bird.
    c: f64,
    g: f64,
    /// Distances along the bird: to its spring, on to its center of mass, and of the beak from that.
    a: f64,
    b: f64,
    l: f64,
    /// Gap of the beak, and of the edges of the sleeve, where all hangs straight.
    reach: f64,
    play: f64,
    h_beak: f64,
    h: f64,
    r: f64,
    e: f64,
    mu: f64,
    beak: Contact,
    lower: Contact,
    upper: Contact,
}

const WOODPECKER: Woodpecker = Woodpecker {
    m: 0.0045,
    m_sleeve: 0.0003,
    j: 7e-7,
    j_sleeve: 5e-9,
    c: 0.0056,
    g: 9.81,
    a: 0.010,
    b: 0.015,
    l: 0.0201,
    reach: 0.010 + 0.015 - 0.0201 - 0.0025,
    play: 0.0031 - 0.0025,
    h_beak: 0.02,
    h: 0.0058,
    r: 0.0031,
    e: 0.5,
    mu: 0.3,
    beak: Contact::Open,
    lower: Contact::Closed,
    upper: Contact::Open,
};

fn main() -> Result<()> {
    let jammed = -WOODPECKER.play / WOODPECKER.h;
    let start = State::new([0.0, jammed, -0.2788], [-0.3411, 0.0, -7.4583]);
    let path = WOODPECKER.motion(start).by(Dop853::with_tolerance(1e-10)).with_contacts().to(4.0)?;
    println!("{path}\n\nthe second period:");
    let sticks = times(&path, |transition| {
        matches!(transition, Transition::Sticks { friction: "lower_friction", .. })
    });
    let second = sticks[0]..sticks[1];
    for transition in path.transitions().iter().filter(|transition| second.contains(&transition.time())) {
        println!("  {transition}");
    }
    let [first, last] = [sticks[0], sticks[sticks.len() - 1]];
    let count = (sticks.len() - 1) as f64;
    let fallen = path.at(first)?.coordinate("y")? - path.at(last)?.coordinate("y")?;
    println!("\nit takes {:.6} s and {:.4} mm for each peck", (last - first) / count, 1e3 * fallen / count);
    let file = picture::path("woodpecker")?;
    draw(&path, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

/// Times of the transitions of a kind.
fn times(path: &Trajectory<Woodpecker>, is_it: impl Fn(&Transition<f64>) -> bool) -> Vec<f64> {
    path.transitions()
        .iter()
        .filter(|transition| is_it(transition))
        .map(|transition| transition.time())
        .collect()
}

fn draw(path: &Trajectory<Woodpecker>, file: &std::path::Path) -> Result<()> {
    const SHOWN: f64 = 0.5;
    let root = picture::sheet(file, (1100, 900))?;
    let panels = root.split_evenly((2, 2));
    let [mut height, mut bird, mut sleeve, mut cycle] = [const { Points::new() }; 4];
    for k in 0..=4000 {
        let sample = path.at(SHOWN * f64::from(k) / 4000.0)?;
        let t = 1e3 * sample.time();
        height.push((t, 1e3 * sample.coordinate("y")?));
        bird.push((t, sample.coordinate("bird")?));
        sleeve.push((t, sample.coordinate("sleeve")?));
        cycle.push((sample.coordinate("bird")?, sample.velocity("bird")?));
    }
    let mut chart = Panel::new("It comes down in steps", ["t in ms", "y in mm"]);
    chart.curve("height", BLUE, &height);
    chart.draw(&panels[0])?;
    let mut chart = Panel::new("The sleeve jams at both edges", ["t in ms", "angle in rad"]);
    chart.curve("woodpecker", BLUE, &bird);
    chart.curve("sleeve", RED, &sleeve);
    chart.draw(&panels[1])?;
    let mut chart =
        Panel::new("The limit cycle of the woodpecker", ["angle in rad", "angular velocity in 1/s"]);
    chart.curve("woodpecker", BLUE, &cycle);
    chart.draw(&panels[2])?;
    let (mut press, mut limit) = (Points::new(), Points::new());
    for k in 0..=4000 {
        let sample = path.at(0.2 * f64::from(k) / 4000.0)?;
        let t = 1e3 * sample.time();
        press.push((t, 1e3 * sample.multiplier("lower_friction")?));
        limit.push((t, 1e3 * WOODPECKER.mu * sample.multiplier("lower")?));
    }
    let mut chart = Panel::new("Friction at the lower edge, within its limit", ["t in ms", "force in mN"]);
    chart.curve("limit", GREY, &limit);
    chart.curve("friction", RED, &press);
    chart.draw(&panels[3])?;
    root.present()?;
    Ok(())
}
