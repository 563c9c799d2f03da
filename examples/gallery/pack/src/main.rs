//! Makes one page of a folder, the gallery or the playground: styles, scripts and the compiled package, compressed, stand in it, so that
//! it opens from a file.
//!
//!     pack FOLDER
//!
//! The template is `page/index.html` in the folder. In the place of `<!--FILES a b-->` stand the files `a` and `b` of `page/`, in the
//! place of `<!--BINDINGS-->` the bindings for JavaScript, and in the place of `<!--WASM-->` the package.

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
fn main() -> Result<()> {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).parent().ok_or("no folder above")?;
    let folder = std::path::absolute(std::env::args().nth(1).ok_or("the folder of the page is missing")?)?;
    let name = folder.file_name().and_then(|name| name.to_str()).ok_or("the folder has no name")?;
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| workspace.join("target"), PathBuf::from);
    let target = std::path::absolute(target)?;
    compile(workspace, name)?;
    let bindings = target.join("bindings");
    Bindgen::new()
        .input_path(target.join(TARGET).join(format!("page/{name}.wasm")))
        .no_modules(true)?
        .typescript(false)
        .generate(&bindings)?;
    let page = page(&folder.join("page"), &bindings.join(name))?;
    let file = target.join(format!("{name}.html"));
    fs::write(&file, &page)?;
    eprintln!("{} kB", page.len() / 1000);
    println!("{}", file.display());
    Ok(())
}

fn compile(workspace: &Path, name: &str) -> Result<()> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut build = Command::new(cargo);
    build.args(["build", "--locked", "--package", name, "--lib", "--profile", "page", "--target", TARGET]);
    let status = build.current_dir(workspace).status()?;
    if status.success() { Ok(()) } else { Err("the package was not compiled".into()) }
}

/// The template with everything in its place. The bindings have names that begin as `package` does.
fn page(folder: &Path, package: &Path) -> Result<String> {
    let generated =
        |end: &str| package.as_os_str().to_str().map(|path| format!("{path}{end}")).ok_or("no text");
    let template = fs::read_to_string(folder.join("index.html"))?;
    let mut pieces = template.split("<!--FILES ");
    let mut page = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        let (names, rest) = piece.split_once("-->").ok_or("a list of files does not end")?;
        for name in names.split_whitespace() {
            page += &fs::read_to_string(folder.join(name))?;
        }
        page += rest;
    }
    let page = page.replace("<!--BINDINGS-->", &fs::read_to_string(generated(".js")?)?);
    Ok(page.replace("<!--WASM-->", &compressed(&fs::read(generated("_bg.wasm")?)?)?))
}

fn compressed(bytes: &[u8]) -> Result<String> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes)?;
    Ok(BASE64_STANDARD.encode(encoder.finish()?))
}
