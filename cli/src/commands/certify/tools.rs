//! The tools of `rne certify`: a compiler with its `objdump`, and, if they are installed, QEMU and cppcheck.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use clap::ValueEnum;

use crate::commands::certify::{Arguments, Language};
use crate::commands::toolchain;
use crate::outcome::Failure;
use crate::palette::{TITLE, TYPED};

/// A tool that the certificate uses if it is installed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Tool {
    Qemu,
    Cppcheck,
}

impl Tool {
    const fn program(self) -> &'static str {
        match self {
            Self::Qemu => "qemu-system-arm",
            Self::Cppcheck => "cppcheck",
        }
    }

    const fn name(self) -> &'static str {
        match self {
            Self::Qemu => "qemu",
            Self::Cppcheck => "cppcheck",
        }
    }

    /// Returns the note on a certificate that was made without the tool.
    fn is_missing(self) -> String {
        let what = match self {
            Self::Qemu => "does not run the code",
            Self::Cppcheck => "says nothing about rules of MISRA C",
        };
        let program = self.program();
        format!(
            "{program} is not installed, so the certificate {what}; on Debian and Ubuntu, {TYPED}apt-get install \
             {program}{TYPED:#} installs it"
        )
    }
}

/// Returns the versions of QEMU and cppcheck, and notes on those that are not installed; an error if a missing one is
/// required.
pub(super) fn versions(lang: Language, required: &[Tool]) -> Result<([Option<String>; 2], String), Failure> {
    let mut notes = String::new();
    let mut version = |tool: Tool| {
        // the rules of MISRA C are only for C
        if tool == Tool::Cppcheck && lang != Language::C {
            return Ok(None);
        }
        let version = toolchain::version_of(tool.program());
        if version.is_none() {
            let missing = tool.is_missing();
            if required.contains(&tool) {
                let option = format!("--require {}", tool.name());
                return Err(input_error!("{missing} ({TYPED}{option}{TYPED:#} asks for it)"));
            }
            let _ = writeln!(notes, "{TITLE}note{TITLE:#}: {missing}");
        }
        Ok(version)
    };
    let versions = [version(Tool::Qemu)?, version(Tool::Cppcheck)?];
    Ok((versions, notes))
}

/// Returns the compiler, its `objdump`, and the versions of both and of rne.
pub(super) fn compiler(arguments: &Arguments) -> Result<(String, String, BTreeMap<String, String>), Failure> {
    let compiler = arguments.cc.clone().unwrap_or_else(|| arguments.lang.compiler().to_owned());
    let version = match arguments.lang {
        Language::C => toolchain::version_of_gcc(&compiler)?,
        Language::Rust => toolchain::version(&compiler)?,
    };
    let objdump = match arguments.lang {
        Language::C => toolchain::objdump_of(&compiler),
        Language::Rust => toolchain::objdump_of(""),
    };
    let tools = BTreeMap::from([
        ("rne".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
        (compiler.clone(), version),
        (objdump.clone(), toolchain::version(&objdump)?),
    ]);
    Ok((compiler, objdump, tools))
}
