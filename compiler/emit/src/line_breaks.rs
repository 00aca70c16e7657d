//! Breaks a long statement into lines where rustfmt would break it.
//!
//! A part of an expression is laid out once for each room in which it is tried. A layout has no text: an [`Extent`] has
//! all that must be known of its lines. So the work is linear in the number of parts, however deep they are nested.

use std::collections::HashMap;

use rne_codegen::{Expression, Operator};

use super::annotated::Annotated;
use super::expression::{Infix as _, Kind, Measured, Operand};
use super::syntax::Syntax;
use super::wrap::WIDTH;

/// Returns `START EXPRESSION;`, where the start is such as `let NAME =`, broken into lines if it is too long.
pub(super) fn statement(syntax: Syntax, indent: &str, start: Annotated, expression: Expression<'_>) -> Annotated {
    LineBreaks::new(syntax, expression).statement(indent, start)
}

/// The space in which an expression is written.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Room {
    /// Number of columns that are left on the first line, without those for the text that must follow.
    width: usize,
    /// Indentation of the surrounding block; continuation lines are indented by four more columns.
    indent: usize,
    /// Number of columns that are already used on the first line.
    used: usize,
}

impl Room {
    /// Returns the room that is left after a text of `columns` columns.
    fn behind(self, columns: usize) -> Option<Self> {
        let width = self.width.checked_sub(columns)?;
        Some(Self { width, used: self.used + columns, ..self })
    }

    /// Returns the room that is left before a text of `columns` columns.
    fn before(self, columns: usize) -> Option<Self> {
        let width = self.width.checked_sub(columns)?;
        Some(Self { width, ..self })
    }

    /// Returns the room on a new line that is indented by four more columns; the text that must follow is the same.
    fn next_line(self) -> Option<Self> {
        let behind = WIDTH.saturating_sub(self.used + self.width);
        let indent = self.indent + 4;
        Some(Self { width: (WIDTH - behind).checked_sub(indent)?, indent, used: indent })
    }
}

/// The size of a text that may have several lines.
#[derive(Clone, Copy, Default)]
struct Extent {
    /// Number of lines after the first one.
    breaks: usize,
    /// Number of columns of the first line.
    first: usize,
    /// Number of columns of the last line, which may be the first.
    last: usize,
    /// Number of blanks at the beginning of the last line.
    blanks: usize,
}

impl Extent {
    const fn of_line(columns: usize) -> Self {
        Self { breaks: 0, first: columns, last: columns, blanks: 0 }
    }

    /// Returns the extent of this text followed by another one.
    const fn then(self, other: Self) -> Self {
        let first = if self.breaks == 0 { self.first + other.first } else { self.first };
        let (last, blanks) =
            if other.breaks == 0 { (self.last + other.last, self.blanks) } else { (other.last, other.blanks) };
        Self { breaks: self.breaks + other.breaks, first, last, blanks }
    }
}

/// The layout of a part over several lines.
#[derive(Default)]
struct Layout {
    extent: Extent,
    pieces: Vec<Piece>,
}

enum Piece {
    Text(&'static str),
    /// A new line with this number of blanks.
    NewLine(usize),
    /// A part, and the room in which it is laid out.
    Part(usize, Room),
}

/// An operand with the room in which it is laid out.
#[derive(Clone, Copy)]
struct Placed {
    operand: Operand,
    /// The room of the operand, inside its parentheses.
    room: Room,
    extent: Extent,
}

impl Layout {
    fn text(&mut self, text: &'static str) {
        self.extent = self.extent.then(Extent::of_line(text.len()));
        self.pieces.push(Piece::Text(text));
    }

    fn new_line(&mut self, indent: usize) {
        self.extent = self.extent.then(Extent { breaks: 1, first: 0, last: indent, blanks: indent });
        self.pieces.push(Piece::NewLine(indent));
    }

    fn operand(&mut self, Placed { operand: Operand { part, in_parentheses }, room, extent }: Placed) {
        if in_parentheses {
            self.text("(");
        }
        self.extent = self.extent.then(extent);
        self.pieces.push(Piece::Part(part, room));
        if in_parentheses {
            self.text(")");
        }
    }
}

/// The expression and the layouts of its parts.
struct LineBreaks {
    measured: Measured,
    /// The layouts that have been tried, for each part and room. `None` if the part does not fit.
    layouts: HashMap<(usize, Room), Option<Layout>>,
}

impl LineBreaks {
    fn new(syntax: Syntax, expression: Expression<'_>) -> Self {
        Self { measured: Measured::new(syntax, expression), layouts: HashMap::new() }
    }

    fn statement(&mut self, indent: &str, start: Annotated) -> Annotated {
        let mut text = Annotated::default() + indent + start;
        let whole = self.measured.whole();
        // one column is for the blank before the expression, and one for the semicolon
        let used = text.as_str().len() + 1;
        if used + self.measured.visit(whole).width < WIDTH {
            text.push_str(" ");
            self.measured.write(whole, &mut text);
            return text + ";";
        }
        let room = |used: usize| (WIDTH - 1).saturating_sub(used);
        let beside = Room { width: room(used), indent: indent.len(), used };
        let below = indent.len() + 4;
        let below = Room { width: room(below), indent: below, used: below };
        let is_beside = match (self.extent(whole, beside), self.extent(whole, below)) {
            (Some(beside), Some(below)) => below.breaks > 0 && beside.breaks <= below.breaks + 1,
            (beside, _) => beside.is_some(),
        };
        if is_beside {
            text.push_str(" ");
            self.write(whole, beside, &mut text);
        } else {
            text = text + "\n" + indent + "    ";
            // if no line is wide enough, parts that cannot be broken are written on one line
            self.write(whole, below, &mut text);
        }
        text + ";"
    }

    /// Returns the extent of a part. If it is too long for one line, each operand of its outermost operator gets a
    /// line, and operands that are still too long are broken in the same way. `None` if it does not fit.
    fn extent(&mut self, part: usize, room: Room) -> Option<Extent> {
        let measure = self.measured.visit(part);
        if measure.width <= room.width || matches!(measure.kind, Kind::Word(_) | Kind::Call(..)) {
            return Some(Extent::of_line(measure.width));
        }
        if let Some(layout) = self.layouts.get(&(part, room)) {
            return layout.as_ref().map(|layout| layout.extent);
        }
        let layout = self.layout(part, room);
        let extent = layout.as_ref().map(|layout| layout.extent);
        self.layouts.insert((part, room), layout);
        extent
    }

    fn layout(&mut self, part: usize, room: Room) -> Option<Layout> {
        match &self.measured.visit(part).kind {
            Kind::Word(_) | Kind::Call(..) => None,
            Kind::Negative(operand) => {
                let operand = *operand;
                let mut layout = Layout::default();
                layout.text("-");
                layout.operand(self.place(operand, room.behind(1)?)?);
                Some(layout)
            }
            Kind::Chain(operator, operands) => {
                let (operator, operands) = (*operator, operands.clone());
                self.last_line_broken(operator, &operands, room).or_else(|| self.all_broken(operator, &operands, room))
            }
        }
    }

    fn place(&mut self, operand: Operand, room: Room) -> Option<Placed> {
        let room = if operand.in_parentheses { room.behind(1)?.before(1)? } else { room };
        Some(Placed { operand, room, extent: self.extent(operand.part, room)? })
    }

    /// Lays out all operands on one line; only the last one may be broken, and only if the text before it is short.
    fn last_line_broken(&mut self, operator: Operator, operands: &[Operand], room: Room) -> Option<Layout> {
        const LITTLE: usize = 4;
        let (last, others) = operands.split_last()?;
        let mut layout = Layout::default();
        for (index, other) in others.iter().enumerate() {
            let room = if index == 0 { room } else { room.next_line()?.behind(2)? };
            layout.operand(self.place(*other, room)?);
            if layout.extent.breaks > 0 {
                return None;
            }
            layout.text(operator.between_blanks());
        }
        let before = layout.extent.last;
        let beside = room.behind(before)?;
        // otherwise a broken last operand is not tried
        let may_break = before <= LITTLE && !self.measured.opens(*last);
        if !may_break && self.measured.width(*last) > beside.width {
            return None;
        }
        let last = self.place(*last, beside)?;
        layout.operand(last);
        (layout.extent.first <= room.width).then_some(layout)
    }

    /// Lays out every operand on its own line.
    fn all_broken(&mut self, operator: Operator, operands: &[Operand], room: Room) -> Option<Layout> {
        let (first, others) = operands.split_first()?;
        let next = room.next_line()?;
        let sign = operator.between_blanks();
        let mut layout = Layout::default();
        layout.operand(self.place(*first, room)?);
        for other in others {
            // a text that is shorter than the indentation is followed by the next operand on the same line
            let Extent { breaks, last, blanks, .. } = layout.extent;
            let used = if breaks > 0 { 0 } else { room.used };
            let beside = if last + used <= next.used { room.behind(sign.len() + last - blanks) } else { None };
            if let Some(beside) = beside.and_then(|room| self.place(*other, room)) {
                layout.text(sign);
                layout.operand(beside);
            } else {
                layout.new_line(next.indent);
                layout.text(sign.trim_start());
                layout.operand(self.place(*other, next.behind(2)?)?);
            }
        }
        Some(layout)
    }

    /// Writes a part with its layout for a room; without a layout, on one line.
    fn write(&self, part: usize, room: Room, text: &mut Annotated) {
        let Some(Some(layout)) = self.layouts.get(&(part, room)) else { return self.measured.write(part, text) };
        self.measured.visit(part);
        for piece in &layout.pieces {
            match piece {
                Piece::Text(piece) => text.push_str(piece),
                Piece::NewLine(blanks) => {
                    text.push_str("\n");
                    text.push_str(&" ".repeat(*blanks));
                }
                Piece::Part(part, room) => self.write(*part, *room, text),
            }
        }
    }
}

#[cfg(test)]
mod tests;
