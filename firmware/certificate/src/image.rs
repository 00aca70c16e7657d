//! An image for a board: its functions, their instructions, sizes and stack frames.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};
use object::{Object, ObjectSection, ObjectSymbol, SymbolKind};

use crate::listing::{self, Count, Fault, Line};
use crate::tools;

/// What a function costs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Figures {
    /// Instructions of one call.
    pub(crate) instructions: u64,
    /// Bytes of instructions.
    pub(crate) code: u64,
    /// Bytes of constants.
    pub(crate) constants: u64,
    /// Bytes of stack, of what is saved and of what is spilled.
    pub(crate) stack: u64,
}

/// The functions of an image.
pub(crate) struct Image {
    functions: BTreeMap<String, Function>,
}

struct Function {
    size: u64,
    stack: Option<u64>,
    lines: Vec<Line>,
}

impl Image {
    /// Reads an ELF file that `objdump` can list.
    pub(crate) fn read(elf: &Path) -> Result<Self> {
        let bytes = fs::read(elf).with_context(|| elf.display().to_string())?;
        let file = object::File::parse(&*bytes).with_context(|| elf.display().to_string())?;
        let frames = match file.section_by_name(".stack_sizes") {
            Some(section) => frames(&section.uncompressed_data()?)?,
            None => BTreeMap::new(),
        };
        let mut listed = listing::functions(&tools::objdump(elf)?)?;
        let symbols = file.symbols().filter(|symbol| symbol.kind() == SymbolKind::Text && symbol.size() > 0);
        let mut functions = BTreeMap::new();
        for symbol in symbols {
            // the lowest bit says that it is Thumb code
            let stack = frames.get(&(symbol.address() & !1)).copied();
            let name = symbol.name()?;
            if let Some(lines) = listed.remove(name) {
                let name = format!("{:#}", rustc_demangle::demangle(name));
                functions.insert(name, Function { size: symbol.size(), stack, lines });
            }
        }
        Ok(Self { functions })
    }

    /// The same with the stack frames of functions that the image says nothing about.
    pub(crate) fn with_frames(mut self, frame: impl Fn(&str) -> Option<u64>) -> Self {
        for (name, function) in &mut self.functions {
            function.stack = function.stack.or_else(|| frame(name));
        }
        self
    }

    /// What keeps a function from being straight.
    pub(crate) fn faults(&self, name: &str) -> Result<Vec<Fault>> {
        Ok(listing::judge(&self.function(name)?.lines).1)
    }

    /// The figures of a function that must be straight; an error lists its faults.
    pub(crate) fn straight(&self, name: &str) -> Result<Figures> {
        self.straight_but_for(name, |_| false)
    }

    /// The figures of a function that may call some others, which must be straight; theirs are included.
    pub(crate) fn straight_but_for(&self, name: &str, may_be_called: impl Fn(&str) -> bool) -> Result<Figures> {
        let function = self.function(name)?;
        let (Count { instructions, constants }, faults) = listing::judge(&function.lines);
        let stack = function.stack.with_context(|| format!("nothing says how much stack {name} uses"))?;
        let mut figures = Figures { instructions, code: function.size - constants, constants, stack };
        let (calls, faults): (Vec<Fault>, Vec<Fault>) =
            faults.into_iter().partition(|fault| fault.callee().is_some_and(&may_be_called));
        if !faults.is_empty() {
            let faults: Vec<String> = faults.iter().map(|fault| format!("  {fault}")).collect();
            bail!("{name} is not straight:\n{}", faults.join("\n"));
        }
        let mut callees: BTreeMap<&str, Figures> = BTreeMap::new();
        for callee in calls.iter().filter_map(Fault::callee) {
            let called = self.straight(callee)?;
            figures.instructions += called.instructions;
            callees.insert(callee, called);
        }
        figures.code += callees.values().map(|called| called.code).sum::<u64>();
        figures.constants += callees.values().map(|called| called.constants).sum::<u64>();
        figures.stack += callees.values().map(|called| called.stack).max().unwrap_or(0);
        Ok(figures)
    }

    fn function(&self, name: &str) -> Result<&Function> {
        self.functions.get(name).with_context(|| format!("the image has no function {name}"))
    }

    /// The one function whose name begins and ends so.
    pub(crate) fn find(&self, start: &str, end: &str) -> Option<&str> {
        let mut found = self.functions.keys().filter(|name| name.starts_with(start) && name.ends_with(end));
        let first = found.next()?;
        found.next().is_none().then_some(first)
    }
}

/// The section `.stack_sizes`: addresses of four bytes, each followed by a size in LEB128.
fn frames(section: &[u8]) -> Result<BTreeMap<u64, u64>> {
    let mut frames = BTreeMap::new();
    let mut rest = section;
    while let Some((address, after)) = rest.split_first_chunk::<4>() {
        let mut size = 0;
        let mut digits = after.iter().enumerate();
        rest = loop {
            let (index, digit) = digits.next().context(".stack_sizes ends within a number")?;
            size |= u64::from(digit & 0x7f) << (7 * index);
            if digit & 0x80 == 0 {
                break &after[index + 1..];
            }
        };
        frames.insert(u64::from(u32::from_le_bytes(*address)) & !1, size);
    }
    Ok(frames)
}

#[cfg(test)]
mod tests {
    use super::frames;

    #[test]
    fn stack_sizes_are_read() {
        let section = [0x01, 0x10, 0, 0, 0x08, 0x20, 0x10, 0, 0, 0x88, 0x02];
        assert_eq!(frames(&section).expect("whole").into_iter().collect::<Vec<_>>(), [(0x1000, 8), (0x1020, 264)]);
        assert!(frames(&section[..10]).is_err());
    }
}
