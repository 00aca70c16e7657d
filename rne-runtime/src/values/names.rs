//! Errors about unknown names at compile time: a constant panics with a message, which is put together without
//! formatting.

/// Panics with a message about a name that no frame of a robot has, `remark`, and the name that was probably meant. The
/// function `frame` of derived robots calls it and so stops the build.
///
/// # Panics
/// Always.
#[doc(hidden)]
pub const fn unknown_frame(names: &[&str], name: &str, remark: &str) -> ! {
    let text = Text::EMPTY.with("`").with(name).with("` is not a frame of the robot").with(remark);
    panic!("{}", text.with_nearest(names, name).as_str())
}

/// Returns the index of the name that is most similar to `name`, if they differ in one place only: in upper and lower
/// case, in one letter that is missing, added or replaced, or in two swapped letters. If several names are equally
/// similar, it is the first of them.
const fn nearest(names: &[&str], name: &str) -> Option<usize> {
    let (mut index, mut nearest, mut least) = (0, None, usize::MAX);
    while index < names.len() {
        if let Some(differing) = difference(names[index].as_bytes(), name.as_bytes())
            && differing < least
        {
            (nearest, least) = (Some(index), differing);
        }
        index += 1;
    }
    nearest
}

/// Returns how many letters differ in the only place in which two names differ. `None` if more than two differ, or if
/// the names are not longer than this place.
const fn difference(a: &[u8], b: &[u8]) -> Option<usize> {
    let shorter = if a.len() < b.len() { a.len() } else { b.len() };
    let longer = a.len() + b.len() - shorter;
    let mut before = 0;
    while before < shorter && a[before].eq_ignore_ascii_case(&b[before]) {
        before += 1;
    }
    let mut after = 0;
    while after < shorter - before && a[a.len() - 1 - after].eq_ignore_ascii_case(&b[b.len() - 1 - after]) {
        after += 1;
    }
    let differing = longer - before - after;
    if differing <= 2 && before + after > differing { Some(differing) } else { None }
}

/// A text that is put together at compile time, where there is no formatting. Parts for which there is no space are
/// left out.
pub(crate) struct Text {
    bytes: [u8; Self::ROOM],
    length: usize,
}

impl Text {
    const ROOM: usize = 1000;
    pub(crate) const EMPTY: Self = Self { bytes: [0; Self::ROOM], length: 0 };

    pub(crate) const fn with(mut self, text: &str) -> Self {
        let mut at = 0;
        while at < text.len() && self.length < Self::ROOM {
            self.bytes[self.length] = text.as_bytes()[at];
            (at, self.length) = (at + 1, self.length + 1);
        }
        self
    }

    /// Returns the text with a question for the name that was probably meant by `name`, if one is similar.
    pub(crate) const fn with_nearest(self, names: &[&str], name: &str) -> Self {
        match nearest(names, name) {
            Some(index) => self.with("; did you mean `").with(names[index]).with("`?"),
            None => self,
        }
    }

    pub(crate) const fn as_str(&self) -> &str {
        let text = self.bytes.split_at(self.length).0;
        match core::str::from_utf8(text) {
            Ok(text) => text,
            // a character at the end is incomplete, because there was no space for it
            Err(error) => match core::str::from_utf8(text.split_at(error.valid_up_to()).0) {
                Ok(text) => text,
                Err(_) => "",
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Text, nearest};

    #[test]
    fn a_name_with_one_slip_is_near() {
        let names = ["camera", "gripper", "j1", "j2"];
        for (name, expected) in [
            ("camra", Some(0)),
            ("camerra", Some(0)),
            ("CAMERA", Some(0)),
            ("camear", Some(0)),
            ("griper", Some(1)),
            ("camera_link", None),
            ("j3", None),
            ("c", None),
            ("", None),
        ] {
            assert_eq!(nearest(&names, name), expected, "{name}");
        }
        assert_eq!(nearest(&[], "camera"), None);
        // one added letter counts as a smaller difference than two replaced letters
        assert_eq!(nearest(&["link1", "link2", "link3", "link4"], "link_4"), Some(3));
    }

    #[test]
    fn a_text_without_room_ends_at_a_character() {
        let long = "é".repeat(600);
        assert_eq!(Text::EMPTY.with("x").with(&long).as_str(), format!("x{}", "é".repeat(499)));
    }
}
