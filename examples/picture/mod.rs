//! Panels of curves, as an SVG file under `target/`.

// An example may do without some of it.
#![allow(dead_code)]

mod panel;
mod svg;

use std::error::Error;
use std::path::{Path, PathBuf};

pub(crate) use panel::Panel;
use plotters::coord::Shift;
use plotters::prelude::*;
use svg::{Svg, UNIT};

pub(crate) type Result<T> = std::result::Result<T, Box<dyn Error>>;
pub(crate) type Area = DrawingArea<Svg, Shift>;
pub(crate) type Points = Vec<(f64, f64)>;
pub(crate) type Ranges = [std::ops::Range<f64>; 2];

pub(crate) const BLUE: RGBColor = RGBColor(31, 98, 168);
pub(crate) const RED: RGBColor = RGBColor(196, 64, 48);
pub(crate) const GREY: RGBColor = RGBColor(120, 120, 120);

/// Where the picture of an example goes.
pub(crate) fn path(name: &str) -> Result<PathBuf> {
    let folder = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| PathBuf::from("target"), PathBuf::from);
    std::fs::create_dir_all(&folder)?;
    Ok(folder.join(format!("{name}.svg")))
}

/// A white sheet of this size in pixels.
pub(crate) fn sheet(file: &Path, size: (u32, u32)) -> Result<Area> {
    let sheet = Svg::new(file.to_owned(), size).into_drawing_area();
    sheet.fill(&WHITE)?;
    Ok(sheet)
}

/// A length in pixels, as areas are split by.
pub(crate) fn px(length: i32) -> i32 {
    length * UNIT
}
