//! Messages about unknown names that a constant stops with, where no formatting is.

/// Stops with a message about a name that no frame of a robot has, `remark`, and the name that was probably meant: the
/// function `frame` of derived robots, which stops the build with it.
///
/// # Panics
/// Always.
#[doc(hidden)]
pub const fn unknown_frame(names: &[&str], name: &str, remark: &str) -> ! {
    let text = Text::EMPTY.with("`").with(name).with("` is not a frame of the robot").with(remark);
    panic!("{}", text.with_nearest(names, name).as_str())
}

/// The name that differs least from `name`, in one place only: in its case, in a letter that is missing, too many or
/// another one, or in two neighbours. Of names that differ equally, the first.
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

/// How many letters differ in the one place outside of which two names are alike; `None` where there are more than two,
/// or where the names are not longer than this place.
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

/// A text that is put together while a constant is computed, where no formatting is; what has no room is left out.
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

    /// The text with a question after the name that was probably meant by `name`, where one is near.
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
            // a character that has no room
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
        // one letter too many differs less than two others
        assert_eq!(nearest(&["link1", "link2", "link3", "link4"], "link_4"), Some(3));
    }

    #[test]
    fn a_text_without_room_ends_at_a_character() {
        let long = "é".repeat(600);
        assert_eq!(Text::EMPTY.with("x").with(&long).as_str(), format!("x{}", "é".repeat(499)));
    }
}
