//! Worksheets against the lecture's formulas, typed here over vectors in the axes of frame 0, and against positions
//! that are differentiated; then mistakes that were made on purpose.

mod agreement;
mod lecture;
mod mistakes;
mod spoiled;
