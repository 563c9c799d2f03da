//! What the examples draw with: circles are round, legends keep off the axes, signs are those of print.

#[path = "../../examples/picture/mod.rs"]
mod picture;

use picture::{BLUE, Panel, Points, RED};
use plotters::prelude::BLACK;

type Result = std::result::Result<(), Box<dyn std::error::Error>>;

/// A picture of one panel.
fn drawn(
    name: &str,
    size: (u32, u32),
    panel: &Panel,
) -> std::result::Result<String, Box<dyn std::error::Error>> {
    let file = std::env::temp_dir().join(format!("lagrange-{name}-{}.svg", std::process::id()));
    let sheet = picture::sheet(&file, size)?;
    panel.draw(&sheet)?;
    sheet.present()?;
    let text = std::fs::read_to_string(&file)?;
    std::fs::remove_file(&file)?;
    Ok(text)
}

/// The corners of the lines, one after the other.
fn lines(svg: &str) -> Vec<Points> {
    let corner = |pair: &str| {
        let (x, y) = pair.split_once(',').expect("a pair");
        (x.parse().expect("x"), y.parse().expect("y"))
    };
    let of = |part: &str| part.split('"').next().unwrap_or("").split_whitespace().map(corner).collect();
    svg.split("<polyline points=\"").skip(1).map(of).collect()
}

#[test]
fn circles_are_round() -> Result {
    let circle: Points = (0..360).map(|k| f64::from(k).to_radians().sin_cos()).collect();
    for size in [(330, 400), (1100, 450), (520, 900)] {
        let mut panel = Panel::new("A circle", ["x", "y"]).equal_axes();
        panel.line(circle.clone(), BLACK);
        let lines = lines(&drawn("circle", size, &panel)?);
        let found = lines.iter().find(|line| line.len() == 360).ok_or("no circle")?;
        let middle = |pick: fn(&(f64, f64)) -> f64| found.iter().map(pick).sum::<f64>() / 360.0;
        let (x, y) = (middle(|p| p.0), middle(|p| p.1));
        let radii = found.iter().map(|p| (p.0 - x).hypot(p.1 - y));
        let (least, most) = radii.fold((f64::MAX, 0.0_f64), |(least, most), r| (least.min(r), most.max(r)));
        assert!(most / least < 1.005 && least > 80.0, "from {least} to {most} at {size:?}");
    }
    Ok(())
}

#[test]
fn names_stand_above_the_axes() -> Result {
    let mut panel = Panel::new("Many names", ["t in s", "λ_x in N"]);
    for k in 0..9 {
        panel.curve(&format!("a curve whose number is {k}"), BLUE, &vec![(-1.0, -3.0), (1.0, f64::from(k))]);
    }
    panel.dots("dots", RED, &vec![(0.0, 0.0)]);
    let svg = drawn("names", (500, 500), &panel)?;
    let lines = lines(&svg);
    let horizontal = |line: &&Points| line.len() == 2 && line[0].1 == line[1].1;
    let samples: Vec<f64> = lines
        .iter()
        .filter(horizontal)
        .filter(|line| line[1].0 - line[0].0 == 20.0)
        .map(|line| line[0].1)
        .collect();
    let rising =
        lines.iter().filter(|line| line.len() == 2 && line[0].0 != line[1].0 && line[0].1 != line[1].1);
    let top = rising.flatten().map(|point| point.1).fold(f64::MAX, f64::min);
    assert_eq!(samples.len(), 9);
    assert!(samples.iter().all(|y| *y < top), "{samples:?} reach below {top}");
    assert!(svg.contains(">−2<") && !svg.contains(">-"), "minus signs are hyphens");
    assert!(svg.contains("λ<tspan dy=\"0.25em\" font-size=\"75%\">x</tspan>"), "no index");
    Ok(())
}
