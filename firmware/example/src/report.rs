//! Records the results while the loop runs, and prints them afterwards, because printing takes longer than a period.

use cortex_m_semihosting::{hprint, hprintln};

/// Number of periods of a run, and the periods with a row in the table.
pub const PERIODS: u16 = 1000;
const ROWS: [u16; 6] = [0, 50, 100, 200, 400, PERIODS - 1];

/// The joint that is pushed, counted from 0, and the external torque of the push, N m. At the end of the push, the
/// observed torque may differ from it by the part `DEVIATION`.
pub const PUSHED: usize = 1;
const PUSH: f32 = 10.0;
const DEVIATION: f32 = 0.05;

/// Returns the external torque on the joint in a period, N m.
pub const fn push(period: u16) -> f32 {
    if period >= ROWS[3] && period < ROWS[4] { PUSH } else { 0.0 }
}

/// Error of every joint at the start, and the largest error at the end, rad.
pub const INITIAL_ERROR: f32 = 0.2;
const FINAL_ERROR: f32 = INITIAL_ERROR / 1000.0;

/// The results of one period.
#[derive(Clone, Copy)]
pub struct Row<const DOF: usize> {
    /// The largest error of the joints, rad.
    pub error: f32,
    /// The external torque of the pushed joint from the observer, N m.
    pub observed: f32,
    pub torques: [f32; DOF],
}

/// The results of a run.
pub struct Report<const DOF: usize> {
    rows: [Row<DOF>; ROWS.len()],
    /// The largest shares of a period that had elapsed when the torques were computed, and when the arm was simulated.
    control: f32,
    simulation: f32,
    /// Number of periods that were missed.
    pub missed: u32,
    /// Largest size of the stack, bytes.
    pub stack: u32,
}

impl<const DOF: usize> Report<DOF> {
    pub fn new() -> Self {
        let row = Row { error: 0.0, observed: 0.0, torques: [0.0; DOF] };
        Self { rows: [row; ROWS.len()], control: 0.0, simulation: 0.0, missed: 0, stack: 0 }
    }

    pub fn add(&mut self, period: u16, row: Row<DOF>, control: f32, simulation: f32) {
        if let Some(place) = self.rows.iter_mut().zip(ROWS).find_map(|(place, at)| (at == period).then_some(place)) {
            *place = row;
        }
        self.control = self.control.max(control);
        self.simulation = self.simulation.max(simulation);
    }

    /// Whether no period was missed and the arm reached the trajectory.
    fn is_tracked(&self) -> bool {
        self.missed == 0 && self.rows.last().is_some_and(|row| row.error < FINAL_ERROR)
    }

    /// Whether the observer shows the push at its end, and no push before it and long after it.
    fn is_observed(&self) -> bool {
        let differs = |row: usize, push: f32| (self.rows[row].observed - push).abs() < DEVIATION * PUSH;
        differs(3, 0.0) && differs(4, PUSH) && differs(5, 0.0)
    }

    /// Whether tracking and observation are good.
    pub fn is_good(&self) -> bool {
        self.is_tracked() && self.is_observed()
    }

    pub fn print(&self) {
        hprintln!("    ms  error/mrad  push/(N m)  torques/(N m)");
        for (row, period) in self.rows.iter().zip(ROWS) {
            hprint!("{:6}{:12.3}{:12.3}", period, 1000.0 * row.error, row.observed);
            row.torques.iter().for_each(|torque| hprint!("{:9.3}", torque));
            hprintln!();
        }
        let [control, simulation] = [self.control, self.simulation].map(|share| 100.0 * share);
        hprintln!("of a period: {control:.1} % until the torques are there, {simulation:.1} % with the simulated arm");
        hprintln!("periods missed: {}, stack: {} bytes", self.missed, self.stack);
        let tracked = if self.is_tracked() { "tracked" } else { "NOT tracked" };
        let observed = if self.is_observed() { "observed" } else { "NOT observed" };
        hprintln!("{tracked}, the push of joint {} by {PUSH} N m is {observed}\n", PUSHED + 1);
    }
}
