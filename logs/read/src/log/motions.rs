//! Reads the filtered runs of a log in pieces.

use crate::columns::quantity::Quantity;
use crate::limits::MOST_NUMBERS;
use crate::log::pass::Pass;
use crate::log::survey::Survey;
use crate::number::short;
use crate::remedy::Setting;
use crate::signal::grid::Grid;
use crate::signal::kernel::{HIGHEST, Kernel};
use crate::spelling::listed;
use crate::{Log, LogError, Motion};

impl Log {
    /// Reads the log again and returns its filtered runs in pieces of some thousand states.
    ///
    /// # Errors
    ///
    /// If positions may be in degrees and the unit is not given; if there is no cut-off, or it is too high for the
    /// sampling rate, or so low that all runs are too short for the filter.
    pub fn motions(&self, survey: &Survey) -> Result<Motions<'_>, LogError> {
        Motions::of(self, survey)
    }
}

/// Number of states of a piece, for runs of any length: some megabytes.
const PIECE: usize = 16_384;

/// A part of a run, or all of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Piece {
    /// The number of the run, from 0, as in [`Survey::runs`].
    pub run: u64,
    /// The states. They follow those of the previous piece, if that belongs to the same run.
    pub motion: Motion,
}

/// The filtered runs of a log, in pieces that follow each other without a gap. Joined, they have the same numbers, bit
/// for bit, as a run that is filtered at once. The ends of a run, where the filter would reach beyond it, are dropped,
/// unless [`with_ends`](Motions::with_ends) keeps them.
///
/// Torques are filtered as positions and velocities are, so that both sides of the equations of motion pass the same
/// filter. Velocities are the filtered ones of the log, if it has them: a controller measures them at a higher rate, so
/// they have less noise than differences of logged positions. Otherwise, they are differences of filtered positions.
/// Accelerations are differences of the filtered velocities.
pub struct Motions<'a> {
    log: &'a Log,
    pass: Pass<'a>,
    kernel: Kernel,
    dropped: usize,
    length: usize,
    /// Number of runs that have begun.
    begun: u64,
    grid: Option<Grid>,
    /// Whether the ends of runs are kept, and whether the beginning of this run was extended.
    with_ends: bool,
    has_begun: bool,
    /// Rows of the run that the filter still needs, by column; `first` rows before them were removed.
    rows: Vec<Vec<f64>>,
    first: u64,
    /// Time of the run's first row, ns.
    begin: i64,
    /// The first state of the next run.
    next: Option<(i64, Vec<f64>)>,
    ended: bool,
}

impl<'a> Motions<'a> {
    pub(crate) fn of(log: &'a Log, survey: &Survey) -> Result<Self, LogError> {
        check_units(log, survey)?;
        let Some(hertz) = survey.cutoff.hertz() else {
            let what = "rne cannot choose the filter: it needs a run (a part of the log without gaps) of at least a \
                        second and 64 states";
            return Err(log.request(what).give(Setting::Cutoff));
        };
        if survey.longest <= survey.dropped.saturating_mul(2) as u64 {
            return Err(too_low(log, survey, hertz));
        }
        let kernel = Kernel::low_pass(hertz, log.layout.step);
        let layout = &log.layout;
        let pass = log.pass()?;
        let pass = if log.options.leave_out_spikes { pass.without(&survey.spikes) } else { pass };
        let columns = layout.width();
        let dropped = log.dropped(kernel.half());
        if dropped.saturating_mul(2).saturating_mul(columns) > MOST_NUMBERS {
            let what = format!(
                "at {} Hz a cut-off of {} Hz needs {} states in memory at once, too many for {columns} columns: use a \
                 higher cut-off or fewer joints",
                short(1.0 / layout.step),
                short(hertz),
                2 * dropped
            );
            let error = log.request(what).give(Setting::Cutoff);
            return Err(error.give(Setting::Joints(Vec::new())));
        }
        let mut motions = Self {
            pass,
            dropped,
            length: 0,
            kernel,
            log,
            begun: 0,
            grid: None,
            with_ends: false,
            has_begun: false,
            rows: vec![Vec::new(); columns],
            first: 0,
            begin: 0,
            next: None,
            ended: false,
        }
        .with_length(PIECE);
        match motions.pass.next()? {
            Some((state, _)) => motions.next = Some((state.time, state.numbers.clone())),
            None => motions.ended = true,
        }
        Ok(motions)
    }

    /// Sets the largest number of states of a piece, at least one. The memory is proportional to it and to the number
    /// of joints. With hundreds of joints, pieces are shorter.
    #[must_use]
    pub fn with_length(mut self, states: usize) -> Self {
        self.length = states.clamp(1, longest_piece(self.rows.len())).next_multiple_of(self.kernel.block());
        self
    }

    /// Keeps the ends of runs: beyond its first and last state, a run is continued by its point reflection in that
    /// state, which keeps its slope. A run that is shorter than this continuation is left out.
    #[must_use]
    pub fn with_ends(mut self) -> Self {
        self.with_ends = true;
        self
    }

    /// Returns the fraction of the log that was read, 0 to 1.
    #[must_use]
    pub fn progress(&self) -> f64 {
        self.pass.progress()
    }

    /// Reads the log until a piece is complete or its run ends; returns whether the run ended.
    fn fill(&mut self) -> Result<bool, LogError> {
        if let Some((time, numbers)) = self.next.take() {
            (self.begin, self.first, self.has_begun) = (time, 0, false);
            self.begun += 1;
            let mut grid = Grid::new(self.log.layout.step * 1e9, time);
            grid.push(time, &numbers, &mut |row| append(&mut self.rows, row));
            self.grid = Some(grid);
        }
        let needed = self.length + self.kernel.behind().max(2 * self.dropped);
        while self.rows.first().is_some_and(|rows| rows.len() < needed) {
            let mut emit = |row: &[f64]| append(&mut self.rows, row);
            match self.pass.next()? {
                Some((state, None)) => {
                    if let Some(grid) = &mut self.grid {
                        grid.push(state.time, &state.numbers, &mut emit);
                    }
                }
                other => {
                    if let Some(grid) = self.grid.take() {
                        grid.finish(&mut emit);
                    }
                    self.next = other.map(|(state, _)| (state.time, state.numbers.clone()));
                    self.ended = self.next.is_none();
                    if self.with_ends {
                        self.begin_earlier();
                        self.end_later();
                    }
                    return Ok(true);
                }
            }
        }
        if self.with_ends {
            self.begin_earlier();
        }
        Ok(false)
    }

    /// Extends the run before its first row by reflection.
    fn begin_earlier(&mut self) {
        let more = self.dropped;
        if self.has_begun || self.rows.first().is_none_or(|rows| rows.len() <= more) {
            return;
        }
        for rows in &mut self.rows {
            let reflected: Vec<f64> = (1..=more).rev().map(|k| 2.0 * rows[0] - rows[k]).collect();
            rows.splice(..0, reflected);
        }
        self.has_begun = true;
    }

    /// Extends the run after its last row by reflection.
    fn end_later(&mut self) {
        if !self.has_begun {
            return;
        }
        for rows in &mut self.rows {
            let last = rows.len() - 1;
            for k in 1..=self.dropped {
                rows.push(2.0 * rows[last] - rows[last - k]);
            }
        }
    }

    /// Returns the states for which all rows in reach of the filter are known, at most one piece.
    #[expect(clippy::cast_precision_loss, reason = "rows are fewer than 2^53")]
    fn filtered(&mut self) -> Motion {
        let there = self.rows.first().map_or(0, Vec::len);
        let count = there.saturating_sub(2 * self.dropped).min(self.length);
        if count == 0 {
            return Motion::default();
        }
        let layout = &self.log.layout;
        let more = self.dropped - self.kernel.half();
        let smooth = |rows: &Vec<f64>| self.kernel.smooth(rows, count + 2 * more);
        // cuts off the additional numbers at both ends
        let inner = |numbers: &Vec<f64>| {
            let beyond = (numbers.len() - count) / 2;
            numbers[beyond..beyond + count].to_vec()
        };
        let each_list = |of: fn(&Kernel, &[f64]) -> Vec<f64>, lists: &[Vec<f64>]| -> Vec<Vec<f64>> {
            lists.iter().map(|list| of(&self.kernel, list)).collect()
        };
        let smoothed = |quantity| -> Vec<Vec<f64>> { self.rows[layout.places(quantity)].iter().map(smooth).collect() };
        let q = smoothed(Quantity::Position);
        let qd =
            if layout.has_velocities { smoothed(Quantity::Velocity) } else { each_list(Kernel::differentiate, &q) };
        let qdd = if layout.has_accelerations {
            smoothed(Quantity::Acceleration)
        } else {
            each_list(Kernel::differentiate, &qd)
        };
        let tau = smoothed(Quantity::Effort);
        let recorded = self.rows[layout.places(Quantity::Effort)]
            .iter()
            .map(|rows| rows[self.dropped..self.dropped + count].to_vec());
        let begin = self.log.seconds(self.begin);
        let before = if self.has_begun { 0 } else { self.dropped as u64 };
        let time = |i: u64| begin + (self.first + before + i) as f64 * layout.step;
        let motion = Motion {
            time: (0..count as u64).map(time).collect(),
            q: q.iter().map(inner).collect(),
            qd: qd.iter().map(inner).collect(),
            qdd: qdd.iter().map(inner).collect(),
            tau: tau.iter().map(inner).collect(),
            recorded: recorded.collect(),
        };
        self.rows.iter_mut().for_each(|rows| drop(rows.drain(..count)));
        self.first += count as u64;
        motion
    }
}

/// Refuses a log whose positions may be in degrees although no unit is given, or whose efforts are currents without
/// torque constants.
pub(crate) fn check_units(log: &Log, survey: &Survey) -> Result<(), LogError> {
    if let Some((joint, range)) = survey.may_be_degrees(log) {
        let what = format!(
            "positions of {} range over {range:.1}, more than 4π: they may be degrees",
            log.layout.joints[joint]
        );
        return Err(log.request(what).give(Setting::Angles));
    }
    let currents = log.unsaid_currents();
    if !currents.is_empty() {
        let what = format!("the names of columns say that efforts of {} are currents", listed(currents));
        return Err(log.request(what).give(Setting::TorqueConstants));
    }
    Ok(())
}

/// Returns the error for a cut-off that is so low that all runs are too short, with the lowest possible one, if any.
fn too_low(log: &Log, survey: &Survey, hertz: f64) -> LogError {
    let (longest, step) = (usize::try_from(survey.longest).unwrap_or(usize::MAX), log.layout.step);
    let half = (longest.saturating_sub(1) / 2).saturating_sub(log.of_differences());
    let lowest = Kernel::lowest_of(half, step);
    let what = format!(
        "no run (a part of the log without gaps) is long enough for the filter: at {} Hz a cut-off of {} Hz drops {} \
         states at each end, and the longest run has {longest}",
        short(1.0 / step),
        short(hertz),
        survey.dropped
    );
    if lowest <= HIGHEST / step {
        // rounded up, so that some states are left at the printed cut-off
        let lowest = (lowest * 1e3).ceil() / 1e3;
        let what = format!("{what}; a higher cut-off drops fewer states: from {lowest} Hz on, some states are left");
        log.request(what).give(Setting::Cutoff)
    } else {
        LogError::file(&log.files[0], format_args!("{what}; at this sampling rate, every cut-off drops all states"))
    }
}

/// Returns the largest number of states of a piece, so that memory is bounded for any number of columns.
fn longest_piece(columns: usize) -> usize {
    MOST_NUMBERS / columns.max(1)
}

fn append(columns: &mut [Vec<f64>], row: &[f64]) {
    for (column, number) in columns.iter_mut().zip(row) {
        column.push(*number);
    }
}

impl Iterator for Motions<'_> {
    type Item = Result<Piece, LogError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            // returns the rest of a run that has ended first
            if self.grid.is_none() {
                let motion = self.filtered();
                if !motion.is_empty() {
                    return Some(Ok(Piece { run: self.begun - 1, motion }));
                }
                self.rows.iter_mut().for_each(Vec::clear);
                if self.ended {
                    return None;
                }
            }
            match self.fill() {
                Ok(true) => {}
                Ok(false) => {
                    let motion = self.filtered();
                    return Some(Ok(Piece { run: self.begun - 1, motion }));
                }
                Err(error) => {
                    self.ended = true;
                    self.grid = None;
                    self.next = None;
                    self.rows.iter_mut().for_each(Vec::clear);
                    return Some(Err(error));
                }
            }
        }
    }
}
