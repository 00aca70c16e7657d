//! The certificate of the generated code on microcontrollers. Started by `scripts/embedded-certificate`.

mod board;
mod c_code;
mod functions;
mod image;
mod listing;
mod log;
mod table;
mod tools;

use std::path::Path;

use anyhow::Result;
use board::Board;
use log::Log;

fn main() -> Result<()> {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("a workspace");
    let expected = Log::of_host();
    for row in c_code::examine(workspace, &expected)? { println!("{} {} {:?} {}", row.name, row.form, row.figures, row.results); }
    let m4 = Board { machine: "mps2-an386", flags: &["-Cllvm-args=-pre-RA-sched=list-ilp"], is_fused: false };
    let examined = m4.examine(workspace)?;
    for row in examined.robots(&expected)? { println!("{} {} {:?} {}", row.name, row.form, row.figures, row.results); }
    for row in examined.methods(&expected)? { println!("{} {} {:?} {}", row.name, row.form, row.figures, row.results); }
    println!("{}", examined.measured("puma560 runtime", 6)?);
    examined.runtime_agrees()?;
    Ok(())
}
