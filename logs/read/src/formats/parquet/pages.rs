//! Reads the pages of a Parquet column with bounded memory, because a small page may unpack to gigabytes, or have a
//! list of millions of numbers.

use std::fmt;
use std::fs::File;
use std::io::{BufRead as _, Read, copy, sink};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use bytes::Bytes;
use flate2::read::MultiGzDecoder;
use parquet::basic::{Compression, Encoding, Type as Physical};
use parquet::column::page::{Page, PageMetadata, PageReader};
use parquet::column::reader::{ColumnReader, get_column_reader};
use parquet::errors::{ParquetError, Result};
use parquet::file::reader::{ChunkReader, FileReader as _, Length, SerializedFileReader};
use parquet::file::serialized_reader::SerializedPageReader;

use crate::limits::MOST_JOINTS;

/// Largest number of bytes of unpacked pages that all columns have in memory at once.
const MOST_BYTES: u64 = 320 << 20;

/// Additional bytes that a text of a dictionary needs in memory, compared with its length field in the file.
const OF_TEXT: u64 = 12;

/// The kind of a page with a dictionary of values, to which other pages refer.
const DICTIONARY: u64 = 2;

/// The kind of a page whose levels are not compressed.
const DATA_PAGE_V2: u64 = 3;

/// The byte in Thrift's compact protocol before a 32-bit integer whose field number is one more than the previous one.
const NEXT: u8 = 0x15;

/// The first bytes of an LZ4 frame, which need not contain its unpacked length.
const LZ4_FRAME: [u8; 4] = [0x04, 0x22, 0x4D, 0x18];

/// The error for valid content of a file that this crate does not read.
#[derive(Debug)]
pub(crate) struct Refused(String);

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Refused {}

impl Refused {
    pub(crate) fn error(what: impl fmt::Display) -> ParquetError {
        ParquetError::External(Box::new(Self(what.to_string())))
    }

    /// Returns the refused content, if an error contains it.
    pub(crate) fn of(error: &ParquetError) -> Option<&Self> {
        match error {
            ParquetError::External(inner) => inner.downcast_ref(),
            _ => None,
        }
    }
}

/// The memory for pages that all columns of a table share.
#[derive(Debug, Default)]
pub(crate) struct Room {
    used: AtomicU64,
}

/// Opens the reader of a column in a group of rows.
pub(crate) fn column_reader(
    file: &SerializedFileReader<File>,
    source: &Arc<File>,
    room: &Arc<Room>,
    group: usize,
    (leaf, name): (usize, &str),
) -> Result<ColumnReader> {
    let rows = file.metadata().row_group(group);
    let chunk = rows.column(leaf);
    let compression = chunk.compression();
    if matches!(compression, Compression::BROTLI(_) | Compression::LZO) {
        let what = format!(
            "the column {name} is compressed with {}, which rne does not read: write the file with zstd, snappy, gzip \
             or lz4, in pandas to_parquet(…, compression=\"zstd\")",
            compression.to_string().split('(').next().unwrap_or_default().to_lowercase()
        );
        return Err(Refused::error(what));
    }
    let (start, length) = chunk.byte_range();
    let bounds = Arc::new(Bounds {
        file: Arc::clone(source),
        room: Arc::clone(room),
        of_texts: chunk.column_type() == Physical::BYTE_ARRAY,
        compression,
        next: AtomicU64::new(start),
        unpacked: AtomicU64::new(0),
        levels: AtomicU64::new(0),
        page: AtomicU64::new(0),
        dictionary: AtomicU64::new(0),
    });
    let total = usize::try_from(rows.num_rows()).unwrap_or(0);
    let descriptor = chunk.column_descr_ptr();
    let pages = Pages {
        reader: SerializedPageReader::new(Arc::clone(&bounds), chunk, total, None)?,
        bounds,
        end: start.saturating_add(length),
        is_list: descriptor.max_rep_level() == 1,
        length: 0,
        name: name.to_owned(),
    };
    Ok(get_column_reader(descriptor, Box::new(pages)))
}

/// The file of a column. The memory of each page is counted before the page is unpacked. The library reads from here a
/// page header, then the page, one after another.
struct Bounds {
    file: Arc<File>,
    room: Arc<Room>,
    of_texts: bool,
    compression: Compression,
    /// Position of the next page header in the file.
    next: AtomicU64,
    /// The number of bytes of the unpacked next page, from its header.
    unpacked: AtomicU64,
    /// The number of bytes before the values of the next page, which are never compressed.
    levels: AtomicU64,
    /// Number of bytes that are counted for this column: of its page, and of its dictionary.
    page: AtomicU64,
    dictionary: AtomicU64,
}

impl Bounds {
    fn charge(&self, place: &AtomicU64, bytes: u64) -> Result<()> {
        let before = place.swap(bytes, Relaxed);
        let used = self.room.used.fetch_add(bytes, Relaxed).wrapping_add(bytes).wrapping_sub(before);
        self.room.used.fetch_sub(before, Relaxed);
        if used > MOST_BYTES {
            let what = format!(
                "its pages take more than {} MB at once: write the file in groups of fewer rows, in pandas \
                 to_parquet(…, row_group_size=10000)",
                MOST_BYTES >> 20
            );
            return Err(Refused::error(what));
        }
        Ok(())
    }

    /// Checks that a page does not unpack to more bytes than its header states. The library checks this for Snappy and
    /// zstd, but unpacks gzip and LZ4 frames completely.
    fn check_unpacked(&self, page: &[u8]) -> Result<()> {
        let levels = self.levels.load(Relaxed);
        let unpacked = self.unpacked.load(Relaxed).saturating_sub(levels);
        let packed = usize::try_from(levels).ok().and_then(|levels| page.get(levels..)).unwrap_or_default();
        let is_more = match self.compression {
            // the library reports errors in the compressed data
            Compression::GZIP(_) => copy(&mut MultiGzDecoder::new(packed).take(unpacked + 1), &mut sink())
                .is_ok_and(|bytes| bytes > unpacked),
            Compression::LZ4 => packed.starts_with(&LZ4_FRAME),
            _ => false,
        };
        if is_more {
            let what = "a page unpacks to more bytes than its header states: write the file again, in pandas \
                        to_parquet(…, compression=\"zstd\")";
            return Err(Refused::error(what));
        }
        Ok(())
    }
}

impl Drop for Bounds {
    fn drop(&mut self) {
        let held = self.page.load(Relaxed) + self.dictionary.load(Relaxed);
        self.room.used.fetch_sub(held, Relaxed);
    }
}

impl Length for Bounds {
    fn len(&self) -> u64 {
        Length::len(&*self.file)
    }
}

impl ChunkReader for Bounds {
    type T = <File as ChunkReader>::T;

    fn get_read(&self, start: u64) -> Result<Self::T> {
        let mut read = self.file.get_read(start)?;
        let Head { kind, unpacked, packed, levels } = Head::read(read.fill_buf()?)
            .ok_or_else(|| ParquetError::General("a page does not begin with a valid header".to_owned()))?;
        let size = unpacked.max(packed);
        self.unpacked.store(unpacked, Relaxed);
        self.levels.store(levels, Relaxed);
        if kind == DICTIONARY {
            self.charge(&self.dictionary, size.saturating_mul(if self.of_texts { OF_TEXT } else { 2 }))?;
        } else {
            self.charge(&self.page, size)?;
        }
        Ok(read)
    }

    fn get_bytes(&self, start: u64, length: usize) -> Result<Bytes> {
        self.next.store(start.saturating_add(length as u64), Relaxed);
        let page = self.file.get_bytes(start, length)?;
        self.check_unpacked(&page)?;
        Ok(page)
    }
}

/// The kind and the sizes in a page header.
#[derive(Debug, PartialEq)]
struct Head {
    kind: u64,
    unpacked: u64,
    packed: u64,
    /// The number of bytes before the values, which are never compressed.
    levels: u64,
}

impl Head {
    /// Reads a page header in Thrift's compact protocol. A byte before each field gives the distance of its number from
    /// that of the previous field, and its type.
    fn read(mut bytes: &[u8]) -> Option<Self> {
        let (kind, unpacked, packed) = (number(&mut bytes)?, number(&mut bytes)?, number(&mut bytes)?);
        let mut levels = 0;
        if kind == DATA_PAGE_V2 {
            // the fourth field is an optional checksum, and the eighth has the data of this kind of page
            let to_own = if bytes.first() == Some(&NEXT) {
                bytes = varint(&bytes[1..])?.1;
                0x4C
            } else {
                0x5C
            };
            bytes = bytes.strip_prefix(&[to_own])?;
            for _ in ["values", "nulls", "rows", "encoding"] {
                number(&mut bytes)?;
            }
            levels = number(&mut bytes)?.saturating_add(number(&mut bytes)?);
        }
        Some(Self { kind, unpacked, packed, levels })
    }
}

/// Reads the value of the next field.
fn number(bytes: &mut &[u8]) -> Option<u64> {
    let (number, rest) = varint(bytes.strip_prefix(&[NEXT])?)?;
    *bytes = rest;
    // zigzag encoding: even numbers are not negative
    (number & 1 == 0).then_some(number >> 1)
}

/// Reads an integer with seven bits in each byte, the lowest first.
fn varint(bytes: &[u8]) -> Option<(u64, &[u8])> {
    let mut number = 0;
    for (place, byte) in bytes.iter().enumerate().take(5) {
        number |= u64::from(byte & 0x7F) << (7 * place);
        if byte & 0x80 == 0 {
            return Some((number, &bytes[place + 1..]));
        }
    }
    None
}

/// The pages of a column. The lengths of lists are checked before any number is read.
struct Pages {
    reader: SerializedPageReader<Bounds>,
    bounds: Arc<Bounds>,
    /// Position of the end of the column in the file.
    end: u64,
    is_list: bool,
    /// Length of the list at the end of the last page.
    length: usize,
    name: String,
}

impl Pages {
    /// Refuses a page with a list that is longer than the largest number of joints.
    fn check(&mut self, page: &Page) -> Result<()> {
        let (levels, count) = match page {
            Page::DataPage { buf, num_values, rep_level_encoding, .. } => {
                if *rep_level_encoding != Encoding::RLE {
                    let what = format!(
                        "the lists of {} are written in an old encoding that rne does not read: read it with \
                         pandas.read_parquet and write it again with to_parquet",
                        self.name
                    );
                    return Err(Refused::error(what));
                }
                let length = buf.first_chunk().map_or(0, |length| u32::from_le_bytes(*length)) as usize;
                (buf.get(4..length.saturating_add(4)), *num_values)
            }
            Page::DataPageV2 { buf, num_values, rep_levels_byte_len, .. } => {
                (buf.get(..*rep_levels_byte_len as usize), *num_values)
            }
            Page::DictionaryPage { .. } => return Ok(()),
        };
        let levels = levels.ok_or_else(|| {
            ParquetError::General("a part of the file (a page) contains less data than its header states".to_owned())
        })?;
        let longest = longest_list(levels, count as usize, &mut self.length);
        if longest > MOST_JOINTS {
            let what =
                format!("a list of {} has {longest} numbers or more; rne reads at most {MOST_JOINTS}", self.name);
            return Err(Refused::error(what));
        }
        Ok(())
    }
}

/// Returns the length of the longest list of a page with `count` values, from the repetition levels, which are 0 where
/// a list begins and are written as runs and as bits. `length` is that of the list that continues from the previous
/// page, and becomes that of the last list. The search stops at a list that is too long.
fn longest_list(mut levels: &[u8], count: usize, length: &mut usize) -> usize {
    let (mut seen, mut longest) = (0, 0);
    while seen < count && longest <= MOST_JOINTS {
        let Some((head, rest)) = varint(levels) else { break };
        let head = usize::try_from(head).unwrap_or(usize::MAX);
        if head & 1 == 0 {
            let Some((level, rest)) = rest.split_first() else { break };
            let run = (head >> 1).min(count - seen);
            if level & 1 == 1 {
                *length += run;
            } else if run > 0 {
                *length = 1;
            }
            longest = longest.max(*length);
            (seen, levels) = (seen + run, rest);
        } else {
            let (bytes, rest) = rest.split_at((head >> 1).min(rest.len()));
            for bit in bytes.iter().flat_map(|byte| (0..8).map(move |bit| byte >> bit & 1)).take(count - seen) {
                *length = if bit == 1 { *length + 1 } else { 1 };
                longest = longest.max(*length);
            }
            (seen, levels) = (seen.saturating_add(8 * bytes.len()), rest);
            if bytes.is_empty() {
                break;
            }
        }
    }
    longest
}

impl PageReader for Pages {
    fn get_next_page(&mut self) -> Result<Option<Page>> {
        let page = self.reader.get_next_page()?;
        if let Some(page) = page.as_ref().filter(|_| self.is_list) {
            self.check(page)?;
        }
        Ok(page)
    }

    /// Refuses to look ahead: the library's reader would read the page header here, and then the page without its
    /// header.
    fn peek_next_page(&mut self) -> Result<Option<PageMetadata>> {
        Err(ParquetError::General("no page is skipped".to_owned()))
    }

    fn skip_next_page(&mut self) -> Result<()> {
        Err(ParquetError::General("no page is skipped".to_owned()))
    }

    fn at_record_boundary(&mut self) -> Result<bool> {
        Ok(self.bounds.next.load(Relaxed) >= self.end)
    }
}

impl Iterator for Pages {
    type Item = Result<Page>;

    fn next(&mut self) -> Option<Self::Item> {
        self.get_next_page().transpose()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column(room: Arc<Room>, compression: Compression) -> Bounds {
        Bounds {
            file: Arc::new(tempfile::tempfile().unwrap()),
            room,
            of_texts: false,
            compression,
            next: AtomicU64::new(0),
            unpacked: AtomicU64::new(0),
            levels: AtomicU64::new(0),
            page: AtomicU64::new(0),
            dictionary: AtomicU64::new(0),
        }
    }

    /// All columns of a table share the memory for pages, and release what they used.
    #[test]
    fn pages_are_charged_to_the_room() {
        let room = Arc::new(Room::default());
        let column = || column(Arc::clone(&room), Compression::UNCOMPRESSED);
        let (one, two) = (column(), column());
        one.charge(&one.dictionary, MOST_BYTES / 4).unwrap();
        one.charge(&one.page, MOST_BYTES / 4).unwrap();
        one.charge(&one.page, MOST_BYTES / 2).unwrap();
        two.charge(&two.page, MOST_BYTES / 4).unwrap();
        let error = two.charge(&two.page, MOST_BYTES / 4 + 1).unwrap_err().to_string();
        assert!(error.contains("its pages take more than 320 MB at once: write the file in groups"), "{error}");
        drop(one);
        two.charge(&two.page, MOST_BYTES).unwrap();
        drop(two);
        assert_eq!(room.used.load(Relaxed), 0);
    }

    #[test]
    fn heads_of_pages_say_their_sizes() {
        let read = |bytes: &[u8]| Head::read(bytes).map(|head| (head.kind, head.unpacked, head.packed, head.levels));
        assert_eq!(read(&[0x15, 0, 0x15, 0x80, 1, 0x15, 6]), Some((0, 64, 3, 0)));
        assert_eq!(read(&[0x15, 4, 0x15, 2, 0x15, 0xFE, 0xFF, 0xFF, 0xFF, 0x0F]), Some((2, 1, 0x7FFF_FFFF, 0)));
        for bytes in [&[][..], &[0x15, 0, 0x15, 1, 0x15, 2], &[0x18, 0, 0x15], &[0x15, 0x80, 0x80, 0x80, 0x80, 0x80, 0]]
        {
            assert_eq!(read(bytes), None, "{bytes:?}");
        }
        // levels of 5 and 7 bytes, with and without a checksum
        let own = [0x15, 20, 0x15, 0, 0x15, 20, 0x15, 0, 0x15, 10, 0x15, 14];
        let with = |middle: &[u8]| [&[0x15, 6, 0x15, 80, 0x15, 60][..], middle, &own[..]].concat();
        assert_eq!(read(&with(&[0x5C])), Some((3, 40, 30, 12)));
        assert_eq!(read(&with(&[0x15, 0xFF, 1, 0x4C])), Some((3, 40, 30, 12)));
        assert_eq!(read(&with(&[0x15, 2])), None);
    }

    /// Gzip does not store its unpacked length, so a page is unpacked once only to count its bytes.
    #[test]
    fn pages_unpack_to_what_their_heads_say() {
        let mut gzip = flate2::read::GzEncoder::new(&[7; 5000][..], flate2::Compression::default());
        let mut page = b"levels".to_vec();
        gzip.read_to_end(&mut page).unwrap();
        let column = |compression, unpacked: u64| {
            let bounds = column(Arc::default(), compression);
            bounds.unpacked.store(unpacked, Relaxed);
            bounds.levels.store(6, Relaxed);
            bounds
        };
        let gzip = Compression::GZIP(parquet::basic::GzipLevel::default());
        column(gzip, 5006).check_unpacked(&page).unwrap();
        let error = column(gzip, 5005).check_unpacked(&page).unwrap_err();
        assert!(error.to_string().contains("a page unpacks to more bytes than its header states"), "{error}");
        // if the page is cut off, the library reports it
        column(gzip, 5005).check_unpacked(&page[..20]).unwrap();
        column(Compression::LZ4, 9000).check_unpacked(b"levels\x04\x22\x4D\x18").unwrap_err();
        column(Compression::LZ4, 9000).check_unpacked(b"levels\0\0\x10\0").unwrap();
    }

    /// Lists with lengths of 2, 3, 1 and so on.
    #[test]
    fn lists_are_as_long_as_their_levels_say() {
        // 0 1 0 1 1 0 as bits, then 1 twice and 0 once as runs
        let levels = [3, 0b01_1010, 4, 1, 2, 0];
        let mut length = 0;
        assert_eq!(longest_list(&levels, 6, &mut length), 3);
        // with eight bits, the last list of length 1 and two more of length 1 come before the runs
        let mut length = 0;
        assert_eq!(longest_list(&levels, 11, &mut length), 3);
        assert_eq!(length, 1);
        // a list continues on the next page
        let mut length = 1000;
        assert_eq!(longest_list(&[60, 1], 30, &mut length), 1030);
        // the check is fast, whatever lengths a page states
        let mut length = 0;
        assert!(longest_list(&[0xFE, 0xFF, 0xFF, 0xFF, 0x0F, 1], 50_000_000, &mut length) > MOST_JOINTS);
        assert_eq!(longest_list(&[1, 0, 0], 50, &mut 0), 0);
    }
}
