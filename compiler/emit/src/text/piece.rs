//! Lists in brackets, broken into lines as rustfmt does.

use crate::annotated::Annotated;
use crate::wrap::WIDTH;

/// A number, or a list of pieces in brackets.
pub(super) enum Piece {
    Number(Annotated),
    List(char, char, Vec<Self>),
}

impl Piece {
    fn line(&self) -> Annotated {
        match self {
            Self::Number(text) => text.clone(),
            Self::List(open, close, elements) => {
                Annotated::from(open.to_string())
                    + Annotated::join(elements.iter().map(Self::line), ", ")
                    + close.to_string()
            }
        }
    }

    /// Returns the text with the line breaks of rustfmt: a list of more than 60 columns has one line per element,
    /// except that short numbers fill lines. If a list has only one element and this is a list, their brackets are on
    /// the same line.
    pub(super) fn broken(&self, indent: usize) -> Annotated {
        const LIST: usize = 60;
        const SHORT: usize = 10;
        let Self::List(open, close, elements) = self else { return self.line() };
        let line = self.line();
        let width = line.as_str().len();
        let is_nested = elements.iter().any(|element| matches!(element, Self::List(..)));
        let room = if *open == '(' { WIDTH - indent } else { (LIST + 2).min(WIDTH - indent) };
        if width <= room && !(*open == '(' && is_nested && width > LIST + 2) {
            return line;
        }
        let (start, end) = (Annotated::from(open.to_string()), close.to_string());
        if let [only @ Self::List(..)] = elements.as_slice() {
            return start + only.broken(indent) + end;
        }
        let texts: Vec<Annotated> = elements.iter().map(|element| element.broken(indent + 4) + ",").collect();
        let fills = *open == '[' && !is_nested && texts.iter().all(|text| text.as_str().len() <= SHORT + 1);
        let (mut text, mut column, last) = (start, WIDTH, texts.len() - 1);
        for (index, element) in texts.into_iter().enumerate() {
            let width = element.as_str().len();
            // here rustfmt leaves the last column of a line empty, except for the last element
            if !fills || column + 1 + width >= WIDTH + usize::from(index == last) {
                text = text + "\n" + " ".repeat(indent + 4);
                column = indent + 4 + width;
            } else {
                text = text + " ";
                column += 1 + width;
            }
            text = text + element;
        }
        text + "\n" + " ".repeat(indent) + end
    }
}
