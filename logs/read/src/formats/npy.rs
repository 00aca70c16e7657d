//! Reads and writes the format of NumPy arrays.

mod header;

use std::io::{self, BufReader, Read};

use self::header::{Header, Kind, header};

/// An array of numbers in a file `*.npy`, which is read from its beginning to its end.
pub struct Npy {
    /// Number of elements along each axis.
    pub shape: Vec<u64>,
    /// The numbers in the order of the file, in which the last index changes fastest; float32 is converted to float64.
    pub numbers: Box<dyn Iterator<Item = io::Result<f64>>>,
    /// Number of bytes of the header and the numbers.
    pub(crate) length: u64,
}

impl Npy {
    /// The first bytes of a NumPy file.
    pub const MAGIC: &[u8] = b"\x93NUMPY";

    /// Reads the header of an array of numbers; no number is read yet.
    ///
    /// # Errors
    /// A message of one line if the file is no array of float64 or float32, or has Fortran order.
    pub fn open(mut file: impl Read + 'static) -> Result<Self, String> {
        let (text, before) = header(&mut file).map_err(|reason| format!("not an array of numpy: {reason}"))?;
        let Header { kind, is_fortran, shape } =
            Header::parse(&text).map_err(|reason| format!("not an array of numpy: {reason}"))?;
        let kind = kind?;
        if is_fortran && shape.iter().filter(|&&length| length > 1).count() > 1 {
            return Err("the array is in Fortran's order; save numpy.ascontiguousarray(states)".to_owned());
        }
        let count: u64 = shape.iter().product();
        let length = before + count * kind.bytes() as u64;
        let numbers = Numbers { file: BufReader::with_capacity(1 << 16, file), kind, left: count };
        Ok(Self { shape, numbers: Box::new(numbers), length })
    }

    /// Returns the header of a table of float64 in version 1 of the format. It always has 128 bytes, so it can be
    /// overwritten when the number of rows is known.
    #[must_use]
    pub fn header(rows: u64, columns: u64) -> Vec<u8> {
        let text = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({rows}, {columns}), }}");
        let mut bytes = Self::MAGIC.to_vec();
        // version 1.0, and the length of the rest of the header in two bytes: 118
        bytes.extend([1, 0, 118, 0]);
        bytes.extend(format!("{text:<117}\n").bytes());
        bytes
    }
}

impl std::fmt::Debug for Npy {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Npy").field("shape", &self.shape).finish_non_exhaustive()
    }
}

/// Iterates over the numbers of an array.
struct Numbers<R> {
    file: BufReader<R>,
    kind: Kind,
    left: u64,
}

impl<R: Read> Numbers<R> {
    fn read(&mut self) -> io::Result<f64> {
        let mut double = [0; 8];
        let mut single = [0; 4];
        match self.kind {
            Kind::F64 { is_big } => {
                self.file.read_exact(&mut double)?;
                Ok(if is_big { f64::from_be_bytes(double) } else { f64::from_le_bytes(double) })
            }
            Kind::F32 { is_big } => {
                self.file.read_exact(&mut single)?;
                Ok(f64::from(if is_big { f32::from_be_bytes(single) } else { f32::from_le_bytes(single) }))
            }
        }
    }
}

impl<R: Read> Iterator for Numbers<R> {
    type Item = io::Result<f64>;

    fn next(&mut self) -> Option<Self::Item> {
        self.left = self.left.checked_sub(1)?;
        let number = self.read();
        if number.is_err() {
            self.left = 0;
        }
        Some(number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_header_that_is_written_is_that_of_numpy() {
        // output of numpy.lib.format.write_array_header_1_0 of NumPy 2, without the spaces after the text
        let text = "\u{1}\0v\0{'descr': '<f8', 'fortran_order': False, 'shape': (1500, 7), }";
        for (rows, columns) in [(0, 1), (1500, 7), (u64::MAX, u64::MAX)] {
            let bytes = Npy::header(rows, columns);
            assert_eq!((bytes.len(), bytes.last()), (128, Some(&b'\n')));
            if rows == 1500 {
                assert!(bytes[Npy::MAGIC.len()..].starts_with(text.as_bytes()));
            }
            if rows == 1500 {
                let npy = Npy::open(io::Cursor::new(bytes)).unwrap();
                assert_eq!((npy.shape, npy.length), (vec![1500, 7], 128 + 8 * 1500 * 7));
            }
        }
    }
}
