//! What an error costs by each method: eight systems, their motions known from elsewhere.
//!
//! Each is integrated with tolerances of 10⁻³ … 10⁻¹⁵ and of round-off. Of an error, the cost is that of the cheapest run that is at least as exact.

mod picture;

use std::f64::consts::FRAC_PI_2;
use std::time::Instant;

use lagrange_core::nalgebra::{Const, Matrix3, SVector, Vector3};
use lagrange_core::{Method, TaylorSeries, prelude::*};
use picture::{BLUE, GREY, Panel, Points, RED, Result};

#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 + 1/sqrt(x^2 + y^2))]
struct Kepler;

/// A satellite of Earth and Moon, in the frame that turns with them.
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x, y)]
#[lagrangian(((x_dot - y)^2 + (y_dot + x)^2)/2 + (1 - mu)/sqrt((x + mu)^2 + y^2) + mu/sqrt((x + mu - 1)^2 + y^2))]
struct Satellite {
    mu: f64,
}

#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - (x^2 + y^2)/2 - x^2*y + y^3/3)]
struct HenonHeiles;

#[derive(Lagrangian, Clone, Copy)]
#[coordinates(a, b)]
#[lagrangian(a_dot^2 + b_dot^2/2 + a_dot*b_dot*cos(a - b) + 2*g*cos(a) + g*cos(b))]
struct Double {
    g: f64,
}

#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x1, y1, x2, y2)]
#[lagrangian((x1_dot^2 + y1_dot^2 + x2_dot^2 + y2_dot^2)/2 - g*(y1 + y2))]
#[constraint(upper: x1^2 + y1^2 = 1)]
#[constraint(lower: (x2 - x1)^2 + (y2 - y1)^2 = 1)]
struct Rods {
    g: f64,
}

#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x, y, z)]
#[lagrangian((x_dot^2 + y_dot^2 + z_dot^2)/2 - g*z)]
#[constraint(string: x^2 + y^2 + z^2 = 1)]
struct Spherical {
    g: f64,
}

/// A heavy top; its inertia is about the point that stands still.
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(q: [4])]
#[frame(body: rotate(q))]
#[lagrangian(kinetic(body, 0, [0, 0, 0], inertia) - w*position(body, [0, 0, 1])[2])]
struct Top {
    inertia: Matrix3<f64>,
    w: f64,
}

#[derive(Lagrangian, Clone, Copy)]
#[coordinates(theta: [10])]
#[define(vx[0] = cos(theta[0])*theta_dot[0])]
#[define(vx[i in 1..10] = vx[i-1] + cos(theta[i])*theta_dot[i])]
#[define(y[0] = -cos(theta[0]))]
#[define(y[i in 1..10] = y[i-1] - cos(theta[i]))]
#[lagrangian(sum(i in 0..10, (vx[i]^2 + der(y[i])^2)/2 - g*y[i]))]
struct Chain {
    g: f64,
}

const G: f64 = 9.81;
const TARGETS: [f64; 3] = [1e-6, 1e-9, 1e-12];
const NAMES: [&str; 3] = ["Taylor", "Dop853", "Dopri5"];

/// Error and time in µs of each run.
type Curve = Points;

/// A motion whose end is known.
struct Known<L, const N: usize> {
    name: &'static str,
    system: L,
    start: State<f64, N>,
    end: f64,
    q: [f64; N],
}

struct Row {
    name: &'static str,
    curves: [Curve; 3],
}

fn main() -> Result<()> {
    let rows = measured();
    println!(
        "Time in µs of the cheapest run that is at least as exact, to the end that is named; –, where none is\n"
    );
    let wide = |text: &str| format!("{text:^27}");
    println!("{:<32}{}", "", TARGETS.map(|target| wide(&format!("error {target:.0e}"))).concat());
    let names = NAMES.map(|name| format!("{name:>9}")).concat();
    println!("{:<32}{} {:>12}", "", names.repeat(3), "Taylor's");
    println!("{:<32}{} {:>12}", "", " ".repeat(81), "least error");
    for row in &rows {
        let cells =
            TARGETS.map(|target| row.curves.each_ref().map(|curve| cell(cost(curve, target))).concat());
        let least = row.curves[0].iter().map(|point| point.0).fold(f64::INFINITY, f64::min);
        println!("{:<32}{} {least:12.0e}", row.name, cells.concat());
    }
    let file = picture::path("methods")?;
    draw(&rows, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

fn cost(curve: &Curve, target: f64) -> Option<f64> {
    let exact = curve.iter().filter(|point| point.0 <= target);
    exact.map(|point| point.1).min_by(f64::total_cmp)
}

fn cell(time: Option<f64>) -> String {
    time.map_or_else(|| format!("{:>9}", "–"), |time| format!("{time:9.0}"))
}

/// The values with 16 digits are those of Taylor runs with 113 and 170 bits, of which 20 and more agree; the chain's is that of an
/// extrapolated midpoint rule of order 16 with 64 bits, where 100 and 160 steps differ by 4·10⁻¹⁶.
fn measured() -> Vec<Row> {
    let inertia = Matrix3::from_diagonal(&Vector3::new(0.4, 0.4, 0.25));
    let (sine, cosine) = 0.3_f64.sin_cos();
    vec![
        row(Known {
            name: "Kepler, e = 0.6, t = 10",
            system: Kepler,
            start: State::new([0.4, 0.0], [0.0, 2.0]),
            end: 10.0,
            q: [-1.535_023_591_909_813_7, -0.283_668_406_499_780_86],
        }),
        row(Known {
            name: "satellite by Arenstorf, t = 5",
            system: Satellite { mu: 0.012_277_471 },
            start: State::new([0.994, 0.0], [0.0, -2.001_585_106_379_082_5]),
            end: 5.0,
            q: [0.022_688_783_647_977_124, 0.866_540_140_171_247_3],
        }),
        row(Known {
            name: "Hénon and Heiles, t = 100",
            system: HenonHeiles,
            start: State::new([0.1, -0.05], [0.35, 0.12]),
            end: 100.0,
            q: [-0.323_724_224_978_209_76, -0.225_657_616_590_660_48],
        }),
        row(Known {
            name: "double pendulum, t = 10",
            system: Double { g: G },
            start: State::at_rest([FRAC_PI_2; 2]),
            end: 10.0,
            q: [-0.568_474_664_015_950_2, -0.526_393_727_932_404_7],
        }),
        row(Known {
            name: "the same, by rods",
            system: Rods { g: G },
            start: State::at_rest([1.0, 0.0, 2.0, 0.0]),
            end: 10.0,
            q: [
                -0.538_347_239_612_226_4,
                -0.842_723_115_620_958_9,
                -1.040_765_783_246_170_5,
                -1.707_347_662_469_327_3,
            ],
        }),
        row(Known {
            name: "spherical pendulum, t = 10",
            system: Spherical { g: G },
            start: State::new([0.75_f64.sqrt(), 0.0, -0.5], [0.0, 1.5 * 0.75_f64.sqrt(), 0.0]),
            end: 10.0,
            q: [-0.278_812_335_078_511_2, 0.617_807_531_269_102_6, -0.735_239_781_374_243_1],
        }),
        row(Known {
            name: "top by a quaternion, t = 10",
            system: Top { inertia, w: 2.0 },
            start: State::new([cosine, sine, 0.0, 0.0], [0.0, 0.0, -10.0 * sine, 10.0 * cosine]),
            end: 10.0,
            q: [
                0.945_285_465_426_883_1,
                -0.127_879_896_206_656_83,
                -0.271_488_828_046_002_6,
                -0.127_968_500_987_797,
            ],
        }),
        row(Known {
            name: "chain of 10 links, t = 2",
            system: Chain { g: G },
            start: State::at_rest([0.5; 10]),
            end: 2.0,
            q: [
                -0.212_031_891_054_568_63,
                -0.233_742_107_844_550_24,
                -0.256_849_903_293_800_1,
                -0.277_116_629_219_685_4,
                -0.319_020_098_504_466_1,
                -0.345_252_064_298_405_05,
                -0.407_712_849_613_006_86,
                -0.483_504_218_065_262_34,
                -0.580_913_617_619_503_8,
                -1.020_942_989_244_883_8,
            ],
        }),
    ]
}

fn row<L, const N: usize>(known: Known<L, N>) -> Row
where
    L: TaylorSeries<N = Const<N>, Scalar = f64> + Copy,
    Dop853: Method<L>,
    Dopri5: Method<L>,
{
    let curves = [
        curve(&known, Taylor::with_tolerance),
        curve(&known, Dop853::with_tolerance),
        curve(&known, Dopri5::with_tolerance),
    ];
    Row { name: known.name, curves }
}

/// Runs that do not end are left out.
fn curve<L, P, const N: usize>(known: &Known<L, N>, method: fn(f64) -> P) -> Curve
where
    L: Lagrangian<N = Const<N>, Scalar = f64> + Copy,
    P: Method<L> + Copy,
{
    let tolerances = (3..=15).map(|k| 10_f64.powi(-k)).chain([f64::EPSILON]);
    tolerances.filter_map(|tolerance| run(known, method(tolerance))).collect()
}

/// The error, and the least time of five runs, in which nothing is stored.
fn run<L, P, const N: usize>(known: &Known<L, N>, method: P) -> Option<(f64, f64)>
where
    L: Lagrangian<N = Const<N>, Scalar = f64> + Copy,
    P: Method<L> + Copy,
{
    let (mut error, mut best) = (f64::NAN, f64::INFINITY);
    for _ in 0..5 {
        let mut motion = Motion::new(known.system, known.start, method).ok()?;
        let begun = Instant::now();
        motion.advance_to(known.end).ok()?;
        best = best.min(1e6 * begun.elapsed().as_secs_f64());
        error = (motion.state().q - SVector::from(known.q)).amax();
    }
    Some((error, best))
}

fn draw(rows: &[Row], file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1500, 760))?;
    for (row, area) in rows.iter().zip(root.split_evenly((2, 4))) {
        let log = |curve: &Curve| -> Points {
            curve.iter().map(|point| (-point.0.max(1e-17).log10(), point.1.log10())).collect()
        };
        let curves = row.curves.each_ref().map(log);
        let axes = ["digits that are right", "log₁₀ of time in µs"];
        let mut chart = Panel::new(row.name, axes);
        for ((name, color), points) in NAMES.iter().zip([BLUE, RED, GREY]).zip(&curves) {
            chart.curve(name, color, points);
        }
        chart.draw(&area)?;
    }
    root.present()?;
    Ok(())
}
