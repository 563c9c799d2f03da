//! SVG for plotters, to a twentieth of a pixel: its own backend has whole ones, which makes eggs of circles.

use std::fmt::Write;
use std::path::PathBuf;

use plotters::prelude::DrawingBackend;
use plotters::style::text_anchor::{HPos, VPos};
use plotters_backend::{BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingErrorKind};

/// What plotters takes for a pixel is that part of one. Widths of strokes, radii and sizes of letters are in pixels.
pub(crate) const UNIT: i32 = 20;
/// About how wide a letter is, as a part of its size.
const LETTER: f64 = 0.58;

/// A picture that is written when it is presented.
pub(crate) struct Svg {
    file: PathBuf,
    size: (u32, u32),
    text: String,
}

type Done = Result<(), DrawingErrorKind<std::io::Error>>;

impl Svg {
    /// Of this size in pixels. Whoever likes it dark sees it so: the colours' lightness is turned over, not their hue.
    pub(crate) fn new(file: PathBuf, (width, height): (u32, u32)) -> Self {
        let text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" stroke-linejoin=\"round\">\n\
             <style>@media (prefers-color-scheme: dark) {{ svg {{ filter: invert(0.9) hue-rotate(180deg) }} }}</style>\n"
        );
        Self { file, size: (width, height), text }
    }

    fn put(&mut self, element: std::fmt::Arguments<'_>) -> Done {
        // Writing to a string does not fail.
        let _ = self.text.write_fmt(element);
        self.text.push('\n');
        Ok(())
    }
}

/// In pixels.
fn pixels(units: i32) -> f64 {
    f64::from(units) / f64::from(UNIT)
}

fn points(path: impl IntoIterator<Item = BackendCoord>) -> String {
    path.into_iter().fold(String::new(), |text, (x, y)| text + &format!("{},{} ", pixels(x), pixels(y)))
}

/// How a shape is filled, or its line drawn.
fn paint(color: BackendColor, width: Option<u32>) -> String {
    let (r, g, b) = color.rgb;
    let color = format!("#{r:02x}{g:02x}{b:02x}\" opacity=\"{:.3}", color.alpha);
    match width {
        None => format!("fill=\"{color}\""),
        Some(width) => format!("fill=\"none\" stroke-width=\"{width}\" stroke=\"{color}\""),
    }
}

fn shape<S: BackendStyle>(style: &S, fill: bool) -> String {
    paint(style.color(), (!fill).then(|| style.stroke_width()))
}

impl DrawingBackend for Svg {
    type ErrorType = std::io::Error;

    fn get_size(&self) -> (u32, u32) {
        (self.size.0 * UNIT as u32, self.size.1 * UNIT as u32)
    }

    fn ensure_prepared(&mut self) -> Done {
        Ok(())
    }

    fn present(&mut self) -> Done {
        std::fs::write(&self.file, self.text.clone() + "</svg>\n").map_err(DrawingErrorKind::DrawingError)
    }

    fn draw_pixel(&mut self, at: BackendCoord, color: BackendColor) -> Done {
        self.draw_circle(at, 1, &color, true)
    }

    fn draw_line<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, style: &S) -> Done {
        self.draw_path([from, to], style)
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        a: BackendCoord,
        b: BackendCoord,
        style: &S,
        fill: bool,
    ) -> Done {
        let corner = (pixels(a.0.min(b.0)), pixels(a.1.min(b.1)));
        let (width, height) = (pixels((b.0 - a.0).abs()), pixels((b.1 - a.1).abs()));
        let (x, y) = corner;
        let style = shape(style, fill);
        self.put(format_args!("<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" shape-rendering=\"crispEdges\" {style}/>"))
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Done {
        self.put(format_args!("<polyline points=\"{}\" {}/>", points(path), shape(style, false)))
    }

    fn draw_circle<S: BackendStyle>(&mut self, (x, y): BackendCoord, r: u32, style: &S, fill: bool) -> Done {
        let (x, y, style) = (pixels(x), pixels(y), shape(style, fill));
        self.put(format_args!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\" {style}/>"))
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Done {
        self.put(format_args!("<polygon points=\"{}\" {}/>", points(path), shape(style, true)))
    }

    fn draw_text<S: BackendTextStyle>(&mut self, text: &str, style: &S, (x, y): BackendCoord) -> Done {
        let (x, y, size) = (pixels(x), pixels(y), style.size());
        let anchor = match style.anchor().h_pos {
            HPos::Left => "start",
            HPos::Center => "middle",
            HPos::Right => "end",
        };
        let down = match style.anchor().v_pos {
            VPos::Top => 0.8,
            VPos::Center => 0.35,
            VPos::Bottom => -0.2,
        } * size;
        let (one, zero) = style.transform().transform(1, 0);
        let turn = f64::from(zero).atan2(f64::from(one)).to_degrees();
        let fill = paint(style.color(), None);
        let text = lowered(&text.replace('&', "&amp;").replace('<', "&lt;"));
        self.put(format_args!(
            "<text xml:space=\"preserve\" transform=\"translate({x} {y}) rotate({turn})\" dy=\"{down}\" font-size=\"{size}\" \
             text-anchor=\"{anchor}\" {fill}>{text}</text>"
        ))
    }

    fn estimate_text_size<S: BackendTextStyle>(
        &self,
        text: &str,
        style: &S,
    ) -> Result<(u32, u32), DrawingErrorKind<Self::ErrorType>> {
        let size = style.size() * f64::from(UNIT);
        Ok(((width(text) * size) as u32, size as u32))
    }
}

/// The letter after an underscore stands below the line.
fn lowered(text: &str) -> String {
    let mut parts = text.split('_');
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |text, part| {
        let (index, rest) = part.split_at(part.chars().next().map_or(0, char::len_utf8));
        text + &format!(
            "<tspan dy=\"0.25em\" font-size=\"75%\">{index}</tspan><tspan dy=\"-0.19em\">{rest}</tspan>"
        )
    })
}

/// About how wide a text is, as a part of its letters' size.
pub(crate) fn width(text: &str) -> f64 {
    let marks = '\u{300}'..='\u{36f}';
    LETTER * text.chars().filter(|letter| !marks.contains(letter)).count() as f64
}
