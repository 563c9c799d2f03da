//! A break: a ball hits a rack of six, and all of them hit one another and the cushions. A family of contacts has an element for
//! each pair.

mod picture;

use lagrange_core::contact::Contact;
use lagrange_core::prelude::*;
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::prelude::*;

#[derive(Clone, Lagrangian)]
#[coordinates(r: [7, 2])]
#[lagrangian(sum(i in 0..7, m/2 * dot(r_dot[i], r_dot[i])))]
#[contact(pair[i in 1..7, j in 0..i]: norm(r[i] - r[j]) - 2*a >= 0, restitution: e)]
#[contact(low[i in 0..7, k in 0..2]: r[i][k] - a >= 0, restitution: cushion)]
#[contact(high[i in 0..7, k in 0..2]: size[k] - a - r[i][k] >= 0, restitution: cushion)]
struct Table {
    m: f64,
    a: f64,
    size: [f64; 2],
    e: f64,
    cushion: f64,
    pair: [[Contact; 6]; 7],
    low: [[Contact; 2]; 7],
    high: [[Contact; 2]; 7],
}

const OPEN: Contact = Contact::Open;
const TABLE: Table = Table {
    m: 0.17,
    a: 0.0286,
    size: [2.54, 1.27],
    e: 1.0,
    cushion: 1.0,
    pair: [[OPEN; 6]; 7],
    low: [[OPEN; 2]; 7],
    high: [[OPEN; 2]; 7],
};

type Path = Trajectory<Table>;

fn main() -> Result<()> {
    let file = picture::path("billiards_break")?;
    let root = picture::sheet(&file, (1100, 760))?;
    let panels = root.split_evenly((2, 2));
    for (k, (e, cushion)) in [(1.0, 1.0), (0.93, 0.7)].into_iter().enumerate() {
        let path = Table { e, cushion, ..TABLE }.motion(rack()).with_contacts().to(1.5)?;
        println!("restitution {e} between balls, {cushion} at cushions\n{path}");
        for sample in path.samples(6) {
            let [x, y] = [0, 1].map(|k| (0..7).map(|i| TABLE.m * sample.state().v[2 * i + k]).sum::<f64>());
            println!(
                "t = {:.1}: momentum ({x:8.5}, {y:8.5}) Ns, energy {:.12} J",
                sample.time(),
                sample.energy()
            );
        }
        println!();
        draw(&path, &format!("Restitution {e}, {cushion} at cushions"), &panels[2 * k])?;
        draw_energy(&path, &panels[2 * k + 1])?;
    }
    root.present()?;
    println!("picture: {}", file.display());
    Ok(())
}

/// The first ball rolls towards the others, which are next to one another, a little off the axis of the table.
fn rack() -> State<f64, 14> {
    let mut start = State::at_rest([0.0; 14]);
    (start.q[0], start.q[1], start.v[0]) = (0.6, 0.63, 6.0);
    let places = (0..3).flat_map(|row| (0..=row).map(move |place| (row, 2 * place - row)));
    for (ball, (row, place)) in (1..).zip(places) {
        let apart = 1.001 * TABLE.a;
        start.q[2 * ball] = 1.8 + 3.0_f64.sqrt() * apart * f64::from(row);
        start.q[2 * ball + 1] = 0.5 * TABLE.size[1] + apart * f64::from(place);
    }
    start
}

/// The ways of the balls, and where they are in the end.
fn draw(path: &Path, title: &str, area: &picture::Area) -> Result<()> {
    let [wide, high] = TABLE.size;
    let mut chart = Panel::new(title, ["x in m", "y in m"]).equal_axes();
    chart.line([(0.0, 0.0), (wide, 0.0), (wide, high), (0.0, high), (0.0, 0.0)], GREY.stroke_width(2));
    for i in 0..7 {
        let color = if i == 0 { RED } else { BLUE };
        let way: Points = path.samples(1500).map(|s| (s.state().q[2 * i], s.state().q[2 * i + 1])).collect();
        chart.line(way, color.mix(0.4).stroke_width(1));
        let [x, y] = [0, 1].map(|k| path.end().state().q[2 * i + k]);
        let rim = (0..=36).map(|k| f64::from(k).to_radians() * 10.0);
        chart.face(rim.map(|angle| (x + TABLE.a * angle.cos(), y + TABLE.a * angle.sin())), color);
    }
    chart.draw(area)
}

fn draw_energy(path: &Path, area: &picture::Area) -> Result<()> {
    let of = |i: usize| -> Points {
        let speed = move |v: &[f64]| v[2 * i].hypot(v[2 * i + 1]);
        path.samples(1500)
            .map(|s| (s.time(), 0.5 * TABLE.m * speed(s.state().v.as_slice()).powi(2)))
            .collect()
    };
    let mut chart = Panel::new("Energies", ["t in s", "E in J"]);
    (1..7).for_each(|i| chart.line(of(i), BLUE.mix(0.4).stroke_width(1)));
    chart.curve("the first ball", RED, &of(0));
    chart.curve("all", GREY, &path.samples(1500).map(|s| (s.time(), s.energy())).collect());
    chart.draw(area)
}
