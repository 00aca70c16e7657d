//! The runs of a log, filtered, in pieces.

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
    /// Reads the log again and hands out its runs, filtered, in pieces of some thousand states.
    ///
    /// # Errors
    ///
    /// If positions may be degrees and nobody said, if there is no cut-off, or one that the rate does not allow, or
    /// that leaves nothing of any run.
    pub fn motions(&self, survey: &Survey) -> Result<Motions<'_>, LogError> {
        Motions::of(self, survey)
    }
}

/// States of a piece, of whatever length its run is: some megabytes.
const PIECE: usize = 16_384;

/// A part of a run, or all of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Piece {
    /// The run's number, from 0, as [`Survey::runs`] has it.
    pub run: u64,
    /// Its states: those that follow on the last of the piece before, if that is of the same run.
    pub motion: Motion,
}

/// The runs of a log, filtered, in pieces that follow each other without a gap: joined they are the same numbers, bit
/// for bit, as a run filtered at once. The ends of a run, where the filter would reach beyond it, are dropped, unless
/// they are [asked for](Motions::with_ends).
///
/// Torques are filtered as positions and velocities are, so that both sides of the equations of motion see the same
/// filter. Velocities are those of the log, filtered, where it has them: a controller measures them at a higher rate
/// and with less noise than differences of what it logs. Else they are differences of filtered positions. Accelerations
/// are differences of the filtered velocities.
pub struct Motions<'a> {
    log: &'a Log,
    pass: Pass<'a>,
    kernel: Kernel,
    dropped: usize,
    length: usize,
    /// How many runs have begun.
    begun: u64,
    grid: Option<Grid>,
    /// Whether the ends are kept, and whether that of this run's beginning was made.
    with_ends: bool,
    has_begun: bool,
    /// Rows of the run by column, of which `first` have been handed on: those that the filter still reaches stay.
    rows: Vec<Vec<f64>>,
    first: u64,
    /// ns, of the run's first row.
    begin: i64,
    /// A state that begins the next run.
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

    /// States of a piece at most, at least one: memory is this by the number of joints. Pieces of hundreds of joints
    /// are shorter.
    #[must_use]
    pub fn with_length(mut self, states: usize) -> Self {
        self.length = states.clamp(1, longest_piece(self.rows.len())).next_multiple_of(self.kernel.block());
        self
    }

    /// Keeps the ends of runs: beyond them a run goes on as the point reflection of itself in its last state, whose
    /// slope is that of the run. A run that is shorter than what is made anew is left out.
    #[must_use]
    pub fn with_ends(mut self) -> Self {
        self.with_ends = true;
        self
    }

    /// How much of the log was read, 0 to 1.
    #[must_use]
    pub fn progress(&self) -> f64 {
        self.pass.progress()
    }

    /// Reads until a piece is there or its run ends; whether it ended.
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

    /// Continues the run before its first row.
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

    /// Continues it behind its last one.
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

    /// The states whose neighbours are all there, at most a piece of them.
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
        // the numbers of the states themselves, of lists that reach further
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

/// Refuses a log whose positions may be degrees and nobody said, or whose efforts are currents without a factor.
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

/// Why a cut-off leaves nothing of any run: of the request, where another one would leave something.
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
        // rounded up
        let lowest = (lowest * 1e3).ceil() / 1e3;
        let what = format!("{what}; a higher cut-off drops fewer states: from {lowest} Hz on, some states are left");
        log.request(what).give(Setting::Cutoff)
    } else {
        LogError::file(&log.files[0], format_args!("{what}; at this sampling rate, every cut-off drops all states"))
    }
}

/// States of a piece, so that memory is bounded whatever the number of columns is.
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
            // a run that ended is emptied first
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
