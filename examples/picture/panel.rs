//! A panel: what is drawn is kept until all of it is known, so that the legend stands above the axes and hides nothing.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::svg::{UNIT, width};
use super::{Area, Points, Ranges, Result};

/// Sizes of letters, in pixels.
const TITLE: f64 = 17.0;
const TEXT: f64 = 13.0;
/// A line of the legend, and the sample before a name.
const LINE: i32 = 20 * UNIT;
const SAMPLE: i32 = 20 * UNIT;
/// What labels take to the left and below, and what is left free.
const LEFT: i32 = 62 * UNIT;
const BELOW: i32 = 40 * UNIT;
const MARGIN: i32 = 12 * UNIT;
/// What a colour bar takes.
const BAR: i32 = 76 * UNIT;

enum Shape {
    Line(u32),
    Dots(u32),
    Face,
}

struct Mark {
    name: String,
    shape: Shape,
    color: RGBAColor,
    points: Points,
}

/// Which colour is which value.
struct ColourBar {
    name: String,
    range: std::ops::Range<f64>,
    color: fn(f64) -> RGBAColor,
}

/// A titled panel with axes.
pub(crate) struct Panel {
    title: String,
    names: [String; 2],
    ranges: Option<Ranges>,
    equal_axes: bool,
    marks: Vec<Mark>,
    bar: Option<ColourBar>,
}

impl Panel {
    /// With the names of its axes, which reach as far as what is drawn.
    pub(crate) fn new(title: &str, names: [&str; 2]) -> Self {
        let names = names.map(str::to_owned);
        Self { title: title.to_owned(), names, ranges: None, equal_axes: false, marks: Vec::new(), bar: None }
    }

    /// The axes reach as far as said.
    pub(crate) fn within(self, ranges: Ranges) -> Self {
        Self { ranges: Some(ranges), ..self }
    }

    /// A unit is as long in both directions: one of the axes reaches farther then.
    pub(crate) fn equal_axes(self) -> Self {
        Self { equal_axes: true, ..self }
    }

    fn mark(&mut self, name: &str, shape: Shape, color: RGBAColor, points: Points) {
        self.marks.push(Mark { name: name.to_owned(), shape, color, points });
    }

    /// A curve with its name in the legend.
    pub(crate) fn curve(&mut self, name: &str, color: RGBColor, points: &Points) {
        self.mark(name, Shape::Line(2), color.into(), points.clone());
    }

    /// Dots with their name in the legend.
    pub(crate) fn dots(&mut self, name: &str, color: RGBColor, points: &Points) {
        self.mark(name, Shape::Dots(4), color.into(), points.clone());
    }

    /// A line without a name.
    pub(crate) fn line(
        &mut self,
        points: impl IntoIterator<Item = (f64, f64)>,
        style: impl Into<ShapeStyle>,
    ) {
        let style = style.into();
        self.mark("", Shape::Line(style.stroke_width), style.color, points.into_iter().collect());
    }

    /// Dots of this radius in pixels, without a name.
    pub(crate) fn specks(
        &mut self,
        radius: u32,
        color: RGBColor,
        points: impl IntoIterator<Item = (f64, f64)>,
    ) {
        self.mark("", Shape::Dots(radius), color.into(), points.into_iter().collect());
    }

    /// A filled polygon without a name.
    pub(crate) fn face(
        &mut self,
        corners: impl IntoIterator<Item = (f64, f64)>,
        color: impl Into<RGBAColor>,
    ) {
        self.mark("", Shape::Face, color.into(), corners.into_iter().collect());
    }

    /// A bar at the side that tells which colour is which value.
    pub(crate) fn colour_bar(
        &mut self,
        name: &str,
        range: std::ops::Range<f64>,
        color: fn(f64) -> RGBAColor,
    ) {
        self.bar = Some(ColourBar { name: name.to_owned(), range, color });
    }

    /// Draws it: the title, the legend, the axes with what is in them, and the colour bar.
    pub(crate) fn draw(&self, area: &Area) -> Result<()> {
        let (wide, _) = area.dim_in_pixel();
        let middle = (wide as i32 / 2, 8 * UNIT);
        area.draw_text(&self.title, &text(TITLE, HPos::Center, VPos::Top), middle)?;
        let (_, below) = area.split_vertically(32 * UNIT);
        let lines = self.legend(wide as i32 - 2 * MARGIN);
        let (legend, below) = below.split_vertically(lines.len() as i32 * LINE);
        draw_legend(&lines, &legend)?;
        match &self.bar {
            None => self.draw_axes(&below),
            Some(bar) => {
                let (axes, side) = below.split_horizontally(below.dim_in_pixel().0 as i32 - BAR);
                self.draw_axes(&axes)?;
                bar.draw(&side)
            }
        }
    }

    /// The names, in lines that are not longer than said, in which each starts somewhere.
    fn legend(&self, longest: i32) -> Vec<Vec<(i32, &Mark)>> {
        let (mut lines, mut end) = (Vec::new(), i32::MAX);
        for mark in self.marks.iter().filter(|mark| !mark.name.is_empty()) {
            let length = SAMPLE + 5 * UNIT + (width(&mark.name) * TEXT) as i32 * UNIT;
            if end.saturating_add(length) > longest {
                lines.push(Vec::new());
                end = 0;
            }
            if let Some(line) = lines.last_mut() {
                line.push((MARGIN + end, mark));
            }
            end += length + 14 * UNIT;
        }
        lines
    }

    fn draw_axes(&self, area: &Area) -> Result<()> {
        let mut builder = ChartBuilder::on(area);
        builder.margin(MARGIN).margin_top(6 * UNIT).x_label_area_size(BELOW).y_label_area_size(LEFT);
        let inside = builder.build_cartesian_2d(0.0..1.0, 0.0..1.0)?.plotting_area().dim_in_pixel();
        let ranges = self.ranges.clone().unwrap_or_else(|| bounds(&self.marks));
        let [x, y] = if self.equal_axes { widened(&ranges, inside) } else { ranges };
        let mut chart = builder.build_cartesian_2d(x, y)?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.1))
            .set_all_tick_mark_size(4 * UNIT)
            .x_desc(&self.names[0])
            .y_desc(&self.names[1])
            .x_labels(6)
            .y_labels(6)
            .x_label_formatter(&label)
            .y_label_formatter(&label)
            .label_style(text(TEXT, HPos::Left, VPos::Top))
            .axis_desc_style(text(TEXT + 1.0, HPos::Left, VPos::Top))
            .draw()?;
        for Mark { shape, color, points, .. } in &self.marks {
            let points = points.iter().copied();
            match *shape {
                Shape::Line(width) => {
                    chart.draw_series(LineSeries::new(points, color.stroke_width(width)))?
                }
                Shape::Dots(radius) => {
                    chart.draw_series(points.map(|at| Circle::new(at, radius, color.filled())))?
                }
                Shape::Face => {
                    chart.draw_series([Polygon::new(points.collect::<Points>(), color.filled())])?
                }
            };
        }
        Ok(())
    }
}

fn text(size: f64, h: HPos, v: VPos) -> TextStyle<'static> {
    TextStyle::from(("sans-serif", size)).pos(Pos::new(h, v))
}

fn draw_legend(lines: &[Vec<(i32, &Mark)>], area: &Area) -> Result<()> {
    for (line, k) in lines.iter().zip(0..) {
        let middle = k * LINE + LINE / 2;
        for (start, mark) in line {
            match mark.shape {
                Shape::Dots(radius) => {
                    area.draw(&Circle::new((start + SAMPLE / 2, middle), radius, mark.color.filled()))?;
                }
                _ => {
                    let sample = [(*start, middle), (start + SAMPLE, middle)];
                    area.draw(&PathElement::new(sample, mark.color.stroke_width(2)))?;
                }
            }
            let place = (start + SAMPLE + 5 * UNIT, middle);
            area.draw_text(&mark.name, &text(TEXT, HPos::Left, VPos::Center), place)?;
        }
    }
    Ok(())
}

/// The smallest rectangle around the marks, with a margin.
fn bounds(marks: &[Mark]) -> Ranges {
    let range = |pick: fn(&(f64, f64)) -> f64| {
        let values = || marks.iter().flat_map(|mark| mark.points.iter()).map(pick);
        let (low, high) = (values().fold(f64::MAX, f64::min), values().fold(f64::MIN, f64::max));
        let margin = 0.06 * (high - low).max(1e-9 * high.abs().max(1e-9));
        low - margin..high + margin
    };
    [range(|point| point.0), range(|point| point.1)]
}

/// The ranges, one of them wider, with which a unit is as long in both directions of an area of this size.
fn widened([x, y]: &Ranges, (width, height): (u32, u32)) -> Ranges {
    let unit = ((x.end - x.start) / f64::from(width)).max((y.end - y.start) / f64::from(height));
    let widen = |range: &std::ops::Range<f64>, length: u32| {
        let (middle, half) = (f64::midpoint(range.start, range.end), unit * f64::from(length) / 2.0);
        middle - half..middle + half
    };
    [widen(x, width), widen(y, height)]
}

/// A label of an axis, of at most six significant digits, with a real minus sign and without a negative zero.
fn label(x: &f64) -> String {
    let rounded = (x * 1e6).round() / 1e6;
    format!("{}", rounded + 0.0).replace('-', "−")
}

impl ColourBar {
    fn draw(&self, area: &Area) -> Result<()> {
        let mut chart = ChartBuilder::on(area)
            .margin_top(6 * UNIT)
            .margin_bottom(MARGIN + BELOW)
            .margin_right(44 * UNIT)
            .right_y_label_area_size(0)
            .build_cartesian_2d(0.0..1.0, self.range.clone())?;
        let step = (self.range.end - self.range.start) / 100.0;
        chart.draw_series((0..100).map(|k| {
            let low = self.range.start + f64::from(k) * step;
            Rectangle::new([(0.0, low), (1.0, low + step)], (self.color)(low + step / 2.0).filled())
        }))?;
        let (xs, ys) = chart.plotting_area().get_pixel_range();
        for k in 0..=5 {
            let value = self.range.start + 20.0 * f64::from(k) * step;
            let y = ys.end - (ys.end - ys.start) * k / 5;
            let (left, top) = area.get_base_pixel();
            area.draw_text(
                &label(&value),
                &text(TEXT, HPos::Left, VPos::Center),
                (xs.end - left + 5 * UNIT, y - top),
            )?;
        }
        let (left, top) = area.get_base_pixel();
        let below = (xs.start - left, ys.end - top + 10 * UNIT);
        area.draw_text(&self.name, &text(TEXT, HPos::Left, VPos::Top), below)?;
        Ok(())
    }
}
