//! The interface to JavaScript: a text is passed byte by byte, and the answer is returned four bytes at a time.
//!
//! A page calls [`clear`], then [`push`] for every byte of the text in UTF-8, then [`compile`], which returns how many
//! bytes the answer has, then [`word`] for each four of them. Only integers are passed, no addresses and no memory to
//! which both sides write. So the compiler of Rust can check everything.
//!
//! `unsafe` is here the attribute alone that keeps the names of the exports, and it is sound: what it asks for is that
//! no other symbol of the module has these names. They start with `rne_`, and the linker refuses two of one name.
#![allow(unsafe_code)]

use std::cell::RefCell;

thread_local! {
    /// The text that is being passed, and then the answer.
    static BYTES: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
}

/// Begins another text.
#[unsafe(export_name = "rne_clear")]
pub extern "C" fn clear() {
    BYTES.with_borrow_mut(Vec::clear);
}

/// Appends a byte to the text; only the lowest eight bits count.
#[unsafe(export_name = "rne_push")]
pub extern "C" fn push(byte: u32) {
    BYTES.with_borrow_mut(|bytes| bytes.push(byte.to_le_bytes()[0]));
}

/// Compiles the text. Returns the length of the answer in bytes; it is JSON in UTF-8, as [`crate::answer`] has it.
#[unsafe(export_name = "rne_compile")]
pub extern "C" fn compile() -> usize {
    let text = String::from_utf8_lossy(&BYTES.take()).into_owned();
    let answer = crate::answer(&text).to_string().into_bytes();
    let length = answer.len();
    BYTES.set(answer);
    length
}

/// Four bytes of the answer, the first one lowest: those from `4 * index` on. Behind its end there are zeros.
#[unsafe(export_name = "rne_word")]
pub extern "C" fn word(index: usize) -> u32 {
    BYTES.with_borrow(|bytes| {
        let start = index.saturating_mul(4);
        let byte = |at: usize| bytes.get(start.saturating_add(at)).copied().unwrap_or(0);
        u32::from_le_bytes([byte(0), byte(1), byte(2), byte(3)])
    })
}
