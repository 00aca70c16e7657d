//! Where a long statement breaks into lines, as rustfmt does it.
//!
//! A part of an expression is laid out once for each room in which it is tried, and a layout holds no text: what must
//! be known of its lines is in its [`Extent`]. So the work is linear in the parts of the expression, however deep they
//! are nested.

use std::collections::HashMap;

use rne_codegen::{Expression, Operator};

use super::annotated::Annotated;
use super::expression::{Infix as _, Kind, Measured, Operand};
use super::syntax::Syntax;
use super::wrap::WIDTH;

/// `START EXPRESSION;`, where the start is `let NAME =` or the like, broken where it is too long.
pub(super) fn statement(syntax: Syntax, indent: &str, start: Annotated, expression: Expression<'_>) -> Annotated {
    LineBreaks::new(syntax, expression).statement(indent, start)
}

/// The room for an expression.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Room {
    /// Columns that are left on its first line, less what must follow it.
    width: usize,
    /// Indentation of the surrounding block; continuation lines are indented by four more columns.
    indent: usize,
    /// Columns used on its first line.
    used: usize,
}

impl Room {
    /// The room after `columns` columns.
    fn behind(self, columns: usize) -> Option<Self> {
        let width = self.width.checked_sub(columns)?;
        Some(Self { width, used: self.used + columns, ..self })
    }

    /// The room with `columns` columns after it.
    fn before(self, columns: usize) -> Option<Self> {
        let width = self.width.checked_sub(columns)?;
        Some(Self { width, ..self })
    }

    /// A line of its own, indented by four more, with the same columns after it.
    fn next_line(self) -> Option<Self> {
        let behind = WIDTH.saturating_sub(self.used + self.width);
        let indent = self.indent + 4;
        Some(Self { width: (WIDTH - behind).checked_sub(indent)?, indent, used: indent })
    }
}

/// How many columns the lines of a text take.
#[derive(Clone, Copy, Default)]
struct Extent {
    /// How many lines follow the first one.
    breaks: usize,
    /// Columns of the first line.
    first: usize,
    /// Columns of the last line, which may be the first.
    last: usize,
    /// The blanks with which the last line begins.
    blanks: usize,
}

impl Extent {
    const fn of_line(columns: usize) -> Self {
        Self { breaks: 0, first: columns, last: columns, blanks: 0 }
    }

    /// The extent of a text and another one after it.
    const fn then(self, other: Self) -> Self {
        let first = if self.breaks == 0 { self.first + other.first } else { self.first };
        let (last, blanks) =
            if other.breaks == 0 { (self.last + other.last, self.blanks) } else { (other.last, other.blanks) };
        Self { breaks: self.breaks + other.breaks, first, last, blanks }
    }
}

/// How a part is written over several lines.
#[derive(Default)]
struct Layout {
    extent: Extent,
    pieces: Vec<Piece>,
}

enum Piece {
    Text(&'static str),
    /// A new line with this number of blanks.
    NewLine(usize),
    /// A part, as it is laid out in a room.
    Part(usize, Room),
}

/// An operand that has found its place.
#[derive(Clone, Copy)]
struct Placed {
    operand: Operand,
    /// The room between its parentheses.
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

/// The layouts of the parts of an expression.
struct LineBreaks {
    measured: Measured,
    /// The layouts that have been tried. `None` where there is no room.
    layouts: HashMap<(usize, Room), Option<Layout>>,
}

impl LineBreaks {
    fn new(syntax: Syntax, expression: Expression<'_>) -> Self {
        Self { measured: Measured::new(syntax, expression), layouts: HashMap::new() }
    }

    fn statement(&mut self, indent: &str, start: Annotated) -> Annotated {
        let mut text = Annotated::default() + indent + start;
        let whole = self.measured.whole();
        // one column is for the blank before it, and one for the semicolon, wherever that stands
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
            // on one line where no line is wide enough for the names of what has no room
            self.write(whole, below, &mut text);
        }
        text + ";"
    }

    /// The extent of a part, over several lines if need be: the operands of its outermost operator each on a line of
    /// its own, and so on inside those that are still too long. `None` where there is no room for it.
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

    /// All operands on one line; only the last may be broken, and only if the text before it is short.
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
        // else it is not tried
        let may_break = before <= LITTLE && !self.measured.opens(*last);
        if !may_break && self.measured.width(*last) > beside.width {
            return None;
        }
        let last = self.place(*last, beside)?;
        layout.operand(last);
        (layout.extent.first <= room.width).then_some(layout)
    }

    /// Every operand on a line of its own.
    fn all_broken(&mut self, operator: Operator, operands: &[Operand], room: Room) -> Option<Layout> {
        let (first, others) = operands.split_first()?;
        let next = room.next_line()?;
        let sign = operator.between_blanks();
        let mut layout = Layout::default();
        layout.operand(self.place(*first, room)?);
        for other in others {
            // a text that is shorter than the indentation gets no line of its own
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

    /// Writes a part as it is laid out in a room, or on one line.
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
