//! Makes one page of the gallery: styles, scripts and the compiled systems, compressed, stand in it, so that it opens from
//! a file.

use std::error::Error;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use wasm_bindgen_cli_support::Bindgen;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

const TARGET: &str = "wasm32-unknown-unknown";
/// In the order in which they are read.
const SCRIPTS: [&str; 6] = ["names.js", "formulas.js", "scene.js", "plots.js", "settings.js", "page.js"];

fn main() -> Result<()> {
    let gallery = Path::new(env!("CARGO_MANIFEST_DIR")).parent().ok_or("no folder above")?;
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| gallery.join("target"), PathBuf::from);
    let target = std::path::absolute(target)?;
    compile(gallery)?;
    let bindings = target.join("bindings");
    Bindgen::new()
        .input_path(target.join(TARGET).join("page/gallery.wasm"))
        .no_modules(true)?
        .typescript(false)
        .generate(&bindings)?;
    let page = page(&gallery.join("page"), &bindings)?;
    let file = target.join("gallery.html");
    fs::write(&file, &page)?;
    eprintln!("{} kB", page.len() / 1000);
    println!("{}", file.display());
    Ok(())
}

fn compile(gallery: &Path) -> Result<()> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut build = Command::new(cargo);
    build.args([
        "build",
        "--locked",
        "--package",
        "gallery",
        "--lib",
        "--profile",
        "page",
        "--target",
        TARGET,
    ]);
    let status = build.current_dir(gallery).status()?;
    if status.success() { Ok(()) } else { Err("the systems were not compiled".into()) }
}

/// The template with everything in its place.
fn page(folder: &Path, bindings: &Path) -> Result<String> {
    let read = |name: &str| fs::read_to_string(folder.join(name));
    let scripts = SCRIPTS.map(read).into_iter().collect::<std::io::Result<String>>()?;
    let wasm = compressed(&fs::read(bindings.join("gallery_bg.wasm"))?)?;
    let script = format!("{}\n{scripts}", fs::read_to_string(bindings.join("gallery.js"))?);
    let parts = [("STYLE", read("style.css")?), ("WASM", wasm), ("SCRIPT", script)];
    let fill = |page: String, (name, part): (&str, String)| page.replace(&format!("<!--{name}-->"), &part);
    Ok(parts.into_iter().fold(read("index.html")?, fill))
}

fn compressed(bytes: &[u8]) -> Result<String> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes)?;
    Ok(BASE64_STANDARD.encode(encoder.finish()?))
}
