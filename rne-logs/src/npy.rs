//! The format of numpy's arrays.

use std::io::{self, ErrorKind, Read};

use npyz::{DType, NpyFile, NpyHeader, Order};

/// The longest header of an array, far more than one of numbers has.
const LONGEST_HEADER: usize = 1 << 16;

/// An array of numbers, `*.npy`, that is read from its beginning to its end.
pub struct Npy {
    /// Elements along each axis.
    pub shape: Vec<u64>,
    /// The numbers as they stand in the file, the last axis first: float64, or float32 made wider.
    pub numbers: Box<dyn Iterator<Item = io::Result<f64>>>,
}

impl Npy {
    /// What a file of numpy begins with.
    pub const MAGIC: &[u8] = b"\x93NUMPY";

    /// Reads the header of an array that has states and their numbers as its two axes.
    ///
    /// # Errors
    /// One line: when there is no array of numbers, or it is in Fortran's order.
    pub fn open(mut file: impl Read + 'static) -> Result<Self, String> {
        let header = header(&mut file).map_err(|error| {
            // the first line will do: the rest of it shows the header
            let reason = error.to_string();
            let reason = match error.kind() {
                ErrorKind::UnexpectedEof => "the file ends in its header",
                _ => reason.lines().next().unwrap_or_default(),
            };
            format!("no array of numpy: {reason}")
        })?;
        let shape = header.shape().to_vec();
        if header.order() == Order::Fortran && shape.iter().filter(|&&length| length > 1).count() > 1 {
            return Err("the array is in Fortran's order; save numpy.ascontiguousarray(states)".to_owned());
        }
        let kind = match header.dtype() {
            DType::Plain(kind) => kind.to_string(),
            other => other.descr(),
        };
        let npy = NpyFile::with_header(header, file);
        let unreadable = |error: npyz::DTypeError| error.to_string();
        let numbers: Box<dyn Iterator<Item = io::Result<f64>>> = match kind.trim_start_matches(['<', '>', '=', '|']) {
            "f8" => Box::new(npy.data::<f64>().map_err(unreadable)?),
            "f4" => Box::new(npy.data::<f32>().map_err(unreadable)?.map(|x| x.map(f64::from))),
            _ => return Err(format!("the numbers are `{}`; save them as float64 or float32", kind.escape_debug())),
        };
        Ok(Self { shape, numbers })
    }
}

impl std::fmt::Debug for Npy {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Npy").field("shape", &self.shape).finish_non_exhaustive()
    }
}

/// The header of an array; the file stands before its numbers then.
fn header(file: &mut impl Read) -> io::Result<NpyHeader> {
    let invalid = |what: &str| io::Error::new(ErrorKind::InvalidData, what);
    let mut bytes = vec![0; Npy::MAGIC.len() + 2];
    file.read_exact(&mut bytes)?;
    // version 1 tells the length by two bytes, later ones by four
    let of_length = if bytes[Npy::MAGIC.len()] == 1 { 2 } else { 4 };
    let mut length = [0; 4];
    file.read_exact(&mut length[..of_length])?;
    bytes.extend_from_slice(&length[..of_length]);
    let length = u32::from_le_bytes(length) as usize;
    if length > LONGEST_HEADER {
        return Err(invalid("its header is too long"));
    }
    let start = bytes.len();
    bytes.resize(start + length, 0);
    file.read_exact(&mut bytes[start..])?;
    if !is_countable(&String::from_utf8_lossy(&bytes[start..])) {
        return Err(invalid("its shape is too large, or none"));
    }
    NpyHeader::from_reader(&bytes[..])
}

/// Whether the integers of a header are decimal and their product, in which a zero is as good as 1, is one too: so are
/// the number of elements, and the strides, that are computed from a shape.
fn is_countable(header: &str) -> bool {
    let words = header.split(|c: char| !c.is_alphanumeric() && c != '_');
    let mut numbers = words.filter(|word| word.starts_with(|c: char| c.is_ascii_digit()));
    let product = numbers.try_fold(1_u64, |product, word| product.checked_mul(word.parse::<u64>().ok()?.max(1)));
    product.is_some_and(|product| product < 1 << 60)
}
