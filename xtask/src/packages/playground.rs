//! Builds the playground, `doors/playground/`: the page of `rne report` with the compiler inside.

use std::fmt::Write as _;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write as _};
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::process::Command;
use std::time::Duration;

use anyhow::{Context, Result};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use clap::Args;
use flate2::{Compression, GzBuilder};
use serde::Serialize;
use xshell::cmd;

use crate::Verdict;
use crate::machine::{self, Missing};
use crate::page;

const TARGET: &str = "wasm32-unknown-unknown";

/// The largest size of the page, bytes. Only a test of the repository checks it, so that a larger page can still be
/// built.
const LARGEST: usize = 1_300_000;

/// The scripts of the page, in their order. Each is inserted once.
const SCRIPTS: [&str; 4] = ["compiler.js", "editor.js", "share.js", "playground.js"];

/// Builds the playground, one page of HTML with the compiler as WebAssembly inside, and serves it
///
/// A robot file is edited in the browser; what is wrong with it is underlined, and the page of `rne report` follows.
/// The page is target/playground/index.html. It loads nothing, so any web site can have it, and it opens as a file too.
#[derive(Args)]
#[command(after_help = "\
Needs the target wasm32-unknown-unknown of rustup's compiler. --test needs what
`cargo xtask page` needs.

Exit status: with --test, 1 when the page is larger than it may be, or fails in
the browser.

Examples:
  cargo xtask playground                     build it, and serve it
  cargo xtask playground --install           get the target first
  cargo xtask playground --no-serve          build it
  cargo xtask playground --no-serve --test   build it, and use it in headless Chromium")]
pub(crate) struct Playground {
    /// Get the target by rustup, and with --test what the browser needs
    #[arg(long)]
    pub(crate) install: bool,
    /// Build the page, and serve it to nobody
    #[arg(long)]
    no_serve: bool,
    /// Serve it at this port of localhost; 0 for any that is free
    #[arg(long, default_value_t = 8000)]
    port: u16,
    /// Use it in headless Chromium: tests/page/playground.py
    #[arg(long)]
    test: bool,
}

impl Playground {
    /// Builds the page without serving it.
    pub(crate) fn built(install: bool) -> Result<Verdict> {
        Self { install, no_serve: true, port: 0, test: false }.run()
    }

    pub(crate) fn run(&self) -> Result<Verdict> {
        target(self.install)?;
        let folder = machine::target_folder("target")?.join("playground");
        let module = module(&folder)?;
        let html = page(&module)?;
        let path = folder.join("index.html");
        fs::write(&path, &html).with_context(|| path.display().to_string())?;
        println!("{}: {} bytes", path.display(), html.len());
        if self.test {
            if html.len() > LARGEST {
                println!("playground: the page has more than {LARGEST} bytes");
                return Ok(Verdict::Fails);
            }
            let shell = machine::shell()?;
            let python = page::python(&shell, self.install)?;
            let rne = page::rne(&shell)?;
            if cmd!(shell, "{python} tests/page/playground.py {rne} {path}").quiet().run().is_err() {
                return Ok(Verdict::Fails);
            }
        }
        if !self.no_serve {
            serve(&html, self.port)?;
        }
        Ok(Verdict::Holds)
    }
}

/// Checks that the compiler of the repository can build for WebAssembly. With `install`, it gets the missing target.
fn target(install: bool) -> Result<()> {
    let has = || {
        let mut asks = Command::new("rustc");
        asks.args(["--print", "target-libdir", "--target", TARGET]).current_dir(machine::root());
        asks.output().is_ok_and(|said| {
            let folder = String::from_utf8_lossy(&said.stdout).trim().to_owned();
            said.status.success() && fs::read_dir(folder).is_ok_and(|mut files| files.next().is_some())
        })
    };
    if has() {
        return Ok(());
    }
    if !install {
        return Err(Missing::error(format!("there is no target {TARGET} (--install gets it by rustup)")));
    }
    let shell = machine::shell()?;
    let added = cmd!(shell, "rustup target add {TARGET}").quiet().ignore_stdout().ignore_stderr().run();
    if added.is_ok() && has() {
        return Ok(());
    }
    Err(Missing::error(format!("the target {TARGET} cannot be had (rustup target add {TARGET} says why)")))
}

/// Builds the compiler as a module of WebAssembly.
fn module(folder: &Path) -> Result<Vec<u8>> {
    let shell = machine::shell()?;
    let manifest = "doors/playground/Cargo.toml";
    let fetched = cmd!(shell, "cargo fetch --quiet --locked --manifest-path {manifest} --target {TARGET}");
    let fetched = machine::without_flags(fetched).quiet().ignore_status().output()?;
    let said = String::from_utf8_lossy(&fetched.stderr);
    if said.contains("lock file") {
        // not caused by the network, so it is an error and not skipped
        anyhow::bail!("doors/playground/Cargo.lock is not that of its manifest: {}", said.trim());
    }
    if !fetched.status.success() {
        return Err(Missing::error("its crates cannot be downloaded (cargo fetch in doors/playground/ says why)"));
    }
    let build =
        cmd!(shell, "cargo build --quiet --locked --release --lib --manifest-path {manifest} --target {TARGET}");
    let build = build.arg("--target-dir").arg(folder);
    // messages of panics contain the paths of sources, which must not reveal the folders of this machine
    let sources = format!("--remap-path-prefix={}=", machine::root().display());
    let home =
        std::env::var("CARGO_HOME").ok().or_else(|| std::env::var("HOME").ok().map(|home| format!("{home}/.cargo")));
    let flags = home.map_or(sources.clone(), |home| format!("{sources} --remap-path-prefix={home}="));
    machine::without_flags(build).env("RUSTFLAGS", flags).env_remove("CARGO_TARGET_DIR").quiet().run()?;
    let path = folder.join(TARGET).join("release/rne_playground.wasm");
    fs::read(&path).with_context(|| path.display().to_string())
}

/// A shipped robot in the menu of the page.
#[derive(Serialize)]
struct Shipped {
    name: String,
    title: String,
    text: String,
}

/// Reads the robot files in the folder `robots/`, sorted by name.
fn shipped() -> Result<Vec<Shipped>> {
    let folder = machine::root().join("robots");
    let mut robots = Vec::new();
    for entry in fs::read_dir(&folder).context("robots/")? {
        let path = entry?.path();
        let name = path.file_name().and_then(|name| name.to_str()).and_then(|name| name.strip_suffix(".yaml"));
        let Some(name) = name.filter(|name| !name.contains('.')) else { continue };
        let text = fs::read_to_string(&path).with_context(|| path.display().to_string())?;
        let file: serde_yaml::Value = serde_yaml::from_str(&text).with_context(|| path.display().to_string())?;
        let joints = file["joints"].as_sequence().map_or(0, Vec::len);
        let ending = if joints == 1 { "" } else { "s" };
        let called = file["title"].as_str().unwrap_or(name);
        let title = format!("{called} · {joints} joint{ending}");
        robots.push(Shipped { name: name.to_owned(), title, text });
    }
    robots.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(robots)
}

/// Returns the page with the compiler, the scripts and the robot files inside.
fn page(module: &[u8]) -> Result<String> {
    let read = |name: &str| machine::read(&format!("doors/playground/page/{name}"));
    let (packed, files) = (packed(module)?, packed(&serde_json::to_vec(&shipped()?)?)?);
    let mut script = String::new();
    for name in SCRIPTS {
        let _ = write!(script, "\n// ---- {name}\n\n{}", read(name)?);
    }
    let (worker, bridge) = (read("worker.js")?, read("bridge.js")?);
    println!("  {:>7} the compiler: {} bytes of WebAssembly, compressed, in base64", packed.len(), module.len());
    println!("  {:>7} the shipped robots", files.len());
    println!("  {:>7} scripts", script.len() + worker.len() + bridge.len());
    // of the style of `rne report` only the colours, controls and head: the inner page has its own style for panels
    let report_style = machine::read("teaching/page/web/style.css")?;
    let end = "/* ---- panels */";
    let (report_style, _) = report_style.split_once(end).with_context(|| format!("the style has no {end}"))?;
    let parts = [
        ("report_style", report_style.to_owned()),
        ("style", read("style.css")?),
        ("module", packed),
        ("files", files),
        ("worker", worker),
        ("bridge", bridge),
        ("script", script),
    ];
    // placeholders are searched only in the rest of the template, never in inserted text
    let mut html = String::new();
    let template = read("index.html")?;
    let mut rest = template.as_str();
    for (name, text) in parts {
        let gap = format!("{{{{{name}}}}}");
        let (before, after) = rest.split_once(&gap).with_context(|| format!("index.html has no {gap} in its place"))?;
        html.push_str(before);
        html.push_str(&text);
        rest = after;
    }
    html.push_str(rest);
    Ok(html)
}

/// Compresses bytes by gzip and encodes them as base64.
fn packed(bytes: &[u8]) -> Result<String> {
    let mut writer = GzBuilder::new().write(Vec::new(), Compression::best());
    writer.write_all(bytes)?;
    Ok(STANDARD.encode(writer.finish()?))
}

/// Serves a page at localhost until the program is stopped.
fn serve(html: &str, port: u16) -> Result<()> {
    let listener = TcpListener::bind(("127.0.0.1", port))
        .with_context(|| format!("port {port} of localhost; --port chooses another"))?;
    println!("http://localhost:{}/ (Ctrl-C ends it)", listener.local_addr()?.port());
    for stream in listener.incoming() {
        // an error with one browser, for example one that closed the connection, does not stop the server
        let _ = stream.and_then(|stream| respond(&stream, html));
    }
    Ok(())
}

/// Answers one request: the page for `/`, an error for every other path.
fn respond(mut stream: &TcpStream, html: &str) -> std::io::Result<()> {
    stream.set_read_timeout(Some(Duration::from_secs(2)))?;
    let mut request = BufReader::new(stream.take(16 * 1024));
    let mut first = String::new();
    request.read_line(&mut first)?;
    let mut line = String::new();
    while request.read_line(&mut line)? > 0 && !line.trim().is_empty() {
        line.clear();
    }
    let (status, body) = match first.split(' ').nth(1).map(|path| path.split('?').next().unwrap_or_default()) {
        Some("/" | "/index.html") => ("200 OK", html),
        _ => ("404 Not Found", "there is nothing but the playground at /\n"),
    };
    let kind = if status.starts_with("200") { "text/html" } else { "text/plain" };
    let length = body.len();
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}; charset=utf-8\r\nContent-Length: {length}\r\n\
         Cache-Control: no-store\r\nConnection: close\r\n\r\n"
    );
    stream.write_all(head.as_bytes())?;
    stream.write_all(body.as_bytes())
}
