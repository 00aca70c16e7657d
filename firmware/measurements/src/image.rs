//! Reads an image for a board from an ELF file.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use object::{Object, ObjectSection, ObjectSymbol, SymbolKind};
use rne_certify::image::Function;
pub(crate) use rne_certify::image::{Figures, Image};
use rne_certify::listing;

use crate::tools;

/// Reads an ELF file that `objdump` can list.
pub(crate) fn read(elf: &Path) -> Result<Image> {
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
        // the lowest bit of an address marks Thumb code
        let stack = frames.get(&(symbol.address() & !1)).copied();
        let name = symbol.name()?;
        if let Some(lines) = listed.remove(name) {
            let name = format!("{:#}", rustc_demangle::demangle(name));
            functions.insert(name, Function { size: symbol.size(), stack, lines });
        }
    }
    Ok(Image::new(functions))
}

/// Reads the section `.stack_sizes`: addresses of four bytes, each followed by a size in LEB128.
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
