//! Reads the header of a NumPy array.

use std::io::{ErrorKind, Read};

use super::Npy;

/// Largest number of bytes of a header, far more than an array of numbers needs.
const LONGEST_HEADER: usize = 1 << 16;

/// Largest number of elements in a header, so that the number of bytes does not overflow.
const MOST_NUMBERS: u64 = 1 << 60;

/// Number of characters of a type that a message shows.
const SHOWN: usize = 40;

/// Reads the text of a header, and the number of bytes before the numbers.
pub(super) fn header(file: &mut impl Read) -> Result<(Vec<u8>, u64), String> {
    let mut take = |bytes: &mut [u8]| {
        file.read_exact(bytes).map_err(|error| match error.kind() {
            ErrorKind::UnexpectedEof => "the file ends in its header".to_owned(),
            _ => error.to_string(),
        })
    };
    let mut magic = [0; Npy::MAGIC.len()];
    take(&mut magic)?;
    if magic != Npy::MAGIC {
        return Err("the file does not begin like a file of numpy".to_owned());
    }
    let mut version = [0; 2];
    take(&mut version)?;
    // version 1 stores the length in two bytes, later versions in four
    let of_length = match version {
        [1, 0] => 2,
        [2 | 3, 0] => 4,
        [major, minor] => return Err(format!("its version is {major}.{minor}; versions 1.0, 2.0 and 3.0 are read")),
    };
    let mut length = [0; 4];
    take(&mut length[..of_length])?;
    let length = u32::from_le_bytes(length) as usize;
    if length > LONGEST_HEADER {
        return Err(format!("its header has {length} bytes; at most {LONGEST_HEADER} are read"));
    }
    let mut text = vec![0; length];
    take(&mut text)?;
    Ok((text, (Npy::MAGIC.len() + 2 + of_length + length) as u64))
}

/// Content of a header.
#[derive(Debug, PartialEq)]
pub(super) struct Header {
    /// Type of the numbers, or the message for numbers that cannot be read.
    pub(super) kind: Result<Kind, String>,
    pub(super) is_fortran: bool,
    pub(super) shape: Vec<u64>,
}

impl Header {
    /// Reads the dictionary of a header, which has `descr`, `fortran_order` and `shape` in any order. Each byte is read
    /// only once: nothing is nested, except the types of records, which are not read.
    pub(super) fn parse(text: &[u8]) -> Result<Self, String> {
        let mut text = Text { left: text };
        let (mut kind, mut is_fortran, mut shape) = (None, None, None);
        text.expect(b'{')?;
        while !text.skip(b'}') {
            let key = text.quoted()?;
            text.expect(b':')?;
            let is_first = match key {
                b"descr" if matches!(text.next(), Some(b'[' | b'(' | b'{')) => {
                    // the rest of the header is not read, because a type may be nested very deeply
                    let kind = Err(unread(text.left));
                    return Ok(Self { kind, is_fortran: false, shape: Vec::new() });
                }
                b"descr" => {
                    let name = text.quoted()?;
                    let found = str::from_utf8(name).ok().and_then(Kind::of);
                    kind.replace(found.ok_or_else(|| unread(name))).is_none()
                }
                b"fortran_order" => is_fortran.replace(text.truth()?).is_none(),
                b"shape" => shape.replace(text.shape()?).is_none(),
                other => return Err(format!("its header has a key {}", shown(other))),
            };
            if !is_first {
                return Err(format!("its header has {} twice", shown(key)));
            }
            if !text.skip(b',') {
                text.expect(b'}')?;
                break;
            }
        }
        if text.next().is_some() {
            return Err(format!("its header continues after its end with {}", shown(text.left)));
        }
        let missing = |key: &str| format!("its header has no {key}");
        Ok(Self {
            kind: kind.ok_or_else(|| missing("descr"))?,
            is_fortran: is_fortran.ok_or_else(|| missing("fortran_order"))?,
            shape: shape.ok_or_else(|| missing("shape"))?,
        })
    }
}

/// The types of numbers that are read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    F32 { is_big: bool },
    F64 { is_big: bool },
}

impl Kind {
    /// Returns the type of numbers with this name, such as `<f8`.
    fn of(name: &str) -> Option<Self> {
        let (is_big, size) = match name.split_at_checked(1)? {
            ("<", size) => (false, size),
            (">", size) => (true, size),
            _ => return None,
        };
        match size {
            "f4" => Some(Self::F32 { is_big }),
            "f8" => Some(Self::F64 { is_big }),
            _ => None,
        }
    }

    pub(super) fn bytes(self) -> usize {
        match self {
            Self::F32 { .. } => 4,
            Self::F64 { .. } => 8,
        }
    }
}

/// The part of a header that was not read yet.
struct Text<'a> {
    left: &'a [u8],
}

impl<'a> Text<'a> {
    /// Skips spaces and returns the next byte without reading it.
    fn next(&mut self) -> Option<u8> {
        self.left = self.left.trim_ascii_start();
        self.left.first().copied()
    }

    fn skip(&mut self, byte: u8) -> bool {
        let is_there = self.next() == Some(byte);
        if is_there {
            self.left = &self.left[1..];
        }
        is_there
    }

    fn expect(&mut self, byte: u8) -> Result<(), String> {
        if self.skip(byte) {
            return Ok(());
        }
        let there = if self.left.is_empty() { "it ends".to_owned() } else { format!("there is {}", shown(self.left)) };
        Err(format!("its header must have {:?} here, but {there}", char::from(byte)))
    }

    /// Reads a text in single or double quotes.
    fn quoted(&mut self) -> Result<&'a [u8], String> {
        let quote = if self.next() == Some(b'"') { b'"' } else { b'\'' };
        self.expect(quote)?;
        let Some(end) = self.left.iter().position(|byte| *byte == quote || *byte == b'\\') else {
            return Err("a text in its header has no closing quote".to_owned());
        };
        if self.left[end] == b'\\' {
            return Err("a text in its header has a backslash".to_owned());
        }
        let text = &self.left[..end];
        self.left = &self.left[end + 1..];
        Ok(text)
    }

    /// Reads the letters and digits that come next.
    fn word(&mut self) -> &'a [u8] {
        self.next();
        let end = self.left.iter().position(|byte| !byte.is_ascii_alphanumeric()).unwrap_or(self.left.len());
        let (word, left) = self.left.split_at(end);
        self.left = left;
        word
    }

    fn truth(&mut self) -> Result<bool, String> {
        match self.word() {
            b"True" => Ok(true),
            b"False" => Ok(false),
            _ => Err("fortran_order is neither True nor False".to_owned()),
        }
    }

    /// Reads a tuple of whole numbers. Refuses a product, in which zeros count as 1, above the largest number of
    /// elements.
    fn shape(&mut self) -> Result<Vec<u64>, String> {
        let wrong = || "its shape is too large, or is not a tuple of whole numbers".to_owned();
        self.expect(b'(')?;
        let (mut shape, mut product) = (Vec::new(), 1_u64);
        while !self.skip(b')') {
            let word = str::from_utf8(self.word()).unwrap_or_default();
            let length: u64 = word.parse().map_err(|_| wrong())?;
            product = product.checked_mul(length.max(1)).filter(|product| *product < MOST_NUMBERS).ok_or_else(wrong)?;
            shape.push(length);
            if !self.skip(b',') {
                // in Python, (5) is a number and (5,) a tuple
                if shape.len() == 1 {
                    return Err(wrong());
                }
                self.expect(b')')?;
                break;
            }
        }
        Ok(shape)
    }
}

/// Returns the message for numbers that cannot be read.
fn unread(kind: &[u8]) -> String {
    format!("the numbers are {}; save them as float64 or float32", shown(kind))
}

/// Returns the beginning of a text for a message.
fn shown(text: &[u8]) -> String {
    let cut = if text.len() > SHOWN { "…" } else { "" };
    let text: String = String::from_utf8_lossy(&text[..text.len().min(SHOWN)])
        .chars()
        .map(|c| if c.is_ascii_graphic() || c == ' ' { c } else { '?' })
        .collect();
    format!("`{text}`{cut}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Header, String> {
        Header::parse(text.as_bytes())
    }

    #[test]
    fn headers_of_other_writers_are_read() {
        let wanted = |is_big, shape: &[u64]| {
            Ok(Header { kind: Ok(Kind::F64 { is_big }), is_fortran: false, shape: shape.into() })
        };
        for (text, is_big, shape) in [
            ("{'descr': '<f8', 'fortran_order': False, 'shape': (3, 2), }  \n", false, &[3, 2][..]),
            ("{'shape':(3,2),'fortran_order':False,'descr':'>f8'}", true, &[3, 2]),
            ("{\"descr\": \"<f8\",\n \"fortran_order\": False, \"shape\": (7,)}\n", false, &[7]),
            ("{'descr': '<f8', 'fortran_order': False, 'shape': ()}", false, &[]),
            ("{'descr': '<f8', 'fortran_order': False, 'shape': (0, 4, 1,)}", false, &[0, 4, 1]),
        ] {
            assert_eq!(parse(text), wanted(is_big, shape), "{text}");
        }
    }

    #[test]
    fn other_headers_are_refused() {
        let with = |shape: &str| format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}}}");
        for (text, wanted) in [
            (with("(-1, 7)"), "too large, or is not a tuple of whole numbers"),
            (with("(4e2, 7)"), "too large, or is not a tuple of whole numbers"),
            (with("(0x190, 7)"), "too large, or is not a tuple of whole numbers"),
            (with("(400L, 7L)"), "too large, or is not a tuple of whole numbers"),
            (with("(4294967296, 4294967296)"), "too large, or is not a tuple of whole numbers"),
            (with("(0, 4611686018427387904)"), "too large, or is not a tuple of whole numbers"),
            (with("(99999999999999999999, 1)"), "too large, or is not a tuple of whole numbers"),
            (with("(5)"), "too large, or is not a tuple of whole numbers"),
            (with("((5, 6), 7)"), "too large, or is not a tuple of whole numbers"),
            (with("(5, 6"), "must have ')' here"),
            (with("(5, 6), 'shape': (1, 1)"), "has `shape` twice"),
            (with("(5, 6), 'other': 1"), "has a key `other`"),
            (with("(5, 6)}, {"), "continues after its end with"),
            (with("[5, 6]"), "must have '(' here"),
            (String::new(), "must have '{' here, but"),
            ("{}".to_owned(), "no descr"),
            ("{'descr': '<f8', 'fortran_order': False}".to_owned(), "no shape"),
            ("{'descr': '<f8', 'fortran_order': 0, 'shape': ()}".to_owned(), "neither True nor False"),
            ("{'descr': '<f8".to_owned(), "has no closing quote"),
            ("{'descr': '\\x3cf8'".to_owned(), "a backslash"),
            ("__import__('os')".to_owned(), "must have '{' here"),
        ] {
            let error = parse(&text).unwrap_err();
            assert!(error.contains(wanted), "{text}: {error}");
        }
        for kind in ["'<i8'", "'=f8'", "'|f8'", "'<f2'", "'<f16'", "'f8'", "''", "'<c16'", "'\u{ff}'", "[('t', '<f8')]"]
        {
            let text = format!("{{'descr': {kind}, 'fortran_order': False, 'shape': (1, 2)}}");
            let error = parse(&text).unwrap().kind.unwrap_err();
            assert!(error.contains("the numbers are `") && error.contains("float64"), "{text}: {error}");
        }
    }

    /// Deeply nested types are refused without reading them: an earlier reader needed four times as long for each
    /// level.
    #[test]
    fn types_of_types_are_refused_at_once() {
        for depth in [1, 3, 8, 12, 5000] {
            let text = format!("{{'descr': {}'<f8'{}, ", "[('a', ".repeat(depth), ")]".repeat(depth));
            let error = parse(&text).unwrap().kind.unwrap_err();
            assert!(error.starts_with("the numbers are `[('a', ") && error.len() < 120, "{error}");
        }
        for open in ["(", "[", "{", "{'shape': ((((", "{'fortran_order': [[[["] {
            assert!(parse(&open.repeat(9000)).is_err());
        }
    }
}
