//! Panels of curves, as an SVG file under `target/`.

// An example may do without some of it.
#![allow(dead_code)]

use std::error::Error;
use std::path::PathBuf;

use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

pub(crate) type Result<T> = std::result::Result<T, Box<dyn Error>>;
pub(crate) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub(crate) type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;
pub(crate) type Points = Vec<(f64, f64)>;

pub(crate) const BLUE: RGBColor = RGBColor(31, 98, 168);
pub(crate) const RED: RGBColor = RGBColor(196, 64, 48);
pub(crate) const GREY: RGBColor = RGBColor(120, 120, 120);
const TEXT: (&str, i32) = ("sans-serif", 15);

/// Where the picture of an example goes.
pub(crate) fn path(name: &str) -> Result<PathBuf> {
    let folder = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| PathBuf::from("target"), PathBuf::from);
    std::fs::create_dir_all(&folder)?;
    Ok(folder.join(format!("{name}.svg")))
}

/// The smallest rectangle around the points, with a margin.
pub(crate) fn bounds(curves: &[&Points]) -> [std::ops::Range<f64>; 2] {
    let range = |pick: fn(&(f64, f64)) -> f64| {
        let values = || curves.iter().flat_map(|points| points.iter()).map(pick);
        let (low, high) = (values().fold(f64::MAX, f64::min), values().fold(f64::MIN, f64::max));
        let margin = 0.06 * (high - low).max(1e-9 * high.abs().max(1e-9));
        low - margin..high + margin
    };
    [range(|point| point.0), range(|point| point.1)]
}

/// The ranges with this part of the height more above, where a legend has room.
pub(crate) fn with_room_above([x, y]: [std::ops::Range<f64>; 2], part: f64) -> [std::ops::Range<f64>; 2] {
    let top = y.end + part * (y.end - y.start);
    [x, y.start..top]
}

/// The ranges widened until a unit is as long in both directions, for an area of this many pixels.
pub(crate) fn to_scale([x, y]: [std::ops::Range<f64>; 2], size: (u32, u32)) -> [std::ops::Range<f64>; 2] {
    let plot = (f64::from(size.0) - 75.0, f64::from(size.1) - 100.0);
    let unit = ((x.end - x.start) / plot.0).max((y.end - y.start) / plot.1);
    let widen = |range: std::ops::Range<f64>, pixels: f64| {
        let (middle, half) = (f64::midpoint(range.start, range.end), unit * pixels / 2.0);
        middle - half..middle + half
    };
    [widen(x, plot.0), widen(y, plot.1)]
}

/// A titled panel with axes.
pub(crate) fn panel<'a, 'b>(
    area: &'a Area<'b>,
    title: &str,
    [x_name, y_name]: [&str; 2],
    [x, y]: [std::ops::Range<f64>; 2],
) -> Result<Chart<'a, 'b>> {
    let mut chart = ChartBuilder::on(area)
        .caption(title, ("sans-serif", 18))
        .margin(10)
        .x_label_area_size(40)
        .y_label_area_size(65)
        .build_cartesian_2d(x, y)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(BLACK.mix(0.08))
        .x_desc(x_name)
        .y_desc(y_name)
        .x_labels(6)
        .y_labels(6)
        .x_label_formatter(&label)
        .y_label_formatter(&label)
        .label_style(TEXT)
        .axis_desc_style(TEXT)
        .draw()?;
    Ok(chart)
}

/// A label of an axis, of at most six significant digits and without a negative zero.
fn label(x: &f64) -> String {
    let rounded = (x * 1e6).round() / 1e6;
    format!("{}", rounded + 0.0)
}

/// A curve with its name in the legend.
pub(crate) fn curve(chart: &mut Chart<'_, '_>, name: &str, color: RGBColor, points: &Points) -> Result<()> {
    let style = color.stroke_width(2);
    chart
        .draw_series(LineSeries::new(points.iter().copied(), style))?
        .label(name)
        .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], style));
    Ok(())
}

/// Dots with their name in the legend.
pub(crate) fn dots(chart: &mut Chart<'_, '_>, name: &str, color: RGBColor, points: &Points) -> Result<()> {
    let circle = move |at: (f64, f64)| Circle::new(at, 4, color.filled());
    chart
        .draw_series(points.iter().map(|&at| circle(at)))?
        .label(name)
        .legend(move |(x, y)| Circle::new((x + 9, y), 4, color.filled()));
    Ok(())
}

/// The legend of the curves drawn so far.
pub(crate) fn legend<'a, 'b: 'a>(chart: &mut Chart<'a, 'b>, position: SeriesLabelPosition) -> Result<()> {
    chart
        .configure_series_labels()
        .position(position)
        .background_style(WHITE.mix(0.85))
        .border_style(BLACK.mix(0.2))
        .label_font(TEXT)
        .draw()?;
    Ok(())
}
