//! What happened, kept while the loop runs and printed afterwards: printing takes longer than a period.

use cortex_m_semihosting::{hprint, hprintln};

/// Periods of a run, and those after which the table has a row.
pub const PERIODS: u16 = 1000;
const ROWS: [u16; 6] = [0, 50, 100, 200, 400, PERIODS - 1];

/// How far off its trajectory every joint starts, and what may be left at the end, in rad.
pub const INITIAL_ERROR: f32 = 0.2;
const FINAL_ERROR: f32 = INITIAL_ERROR / 1000.0;

/// What the loop saw in one period.
#[derive(Clone, Copy)]
pub struct Row<const DOF: usize> {
    /// The largest of the joints, in rad.
    pub error: f32,
    pub torques: [f32; DOF],
}

/// A run.
pub struct Report<const DOF: usize> {
    rows: [Row<DOF>; ROWS.len()],
    /// The largest shares of a period that were over when the torques were there, and when the arm was simulated.
    control: f32,
    simulation: f32,
    /// Periods that went by unseen.
    pub missed: u32,
    /// Bytes at most.
    pub stack: u32,
}

impl<const DOF: usize> Report<DOF> {
    pub fn new() -> Self {
        let row = Row { error: 0.0, torques: [0.0; DOF] };
        Self { rows: [row; ROWS.len()], control: 0.0, simulation: 0.0, missed: 0, stack: 0 }
    }

    pub fn add(&mut self, period: u16, row: Row<DOF>, control: f32, simulation: f32) {
        if let Some(place) = self.rows.iter_mut().zip(ROWS).find_map(|(place, at)| (at == period).then_some(place)) {
            *place = row;
        }
        self.control = self.control.max(control);
        self.simulation = self.simulation.max(simulation);
    }

    /// In time, and on the trajectory.
    pub fn is_good(&self) -> bool {
        self.missed == 0 && self.rows.last().is_some_and(|row| row.error < FINAL_ERROR)
    }

    pub fn print(&self) {
        hprintln!("    ms  error/mrad  torques/(N m)");
        for (row, period) in self.rows.iter().zip(ROWS) {
            hprint!("{:6}{:12.3}", period, 1000.0 * row.error);
            row.torques.iter().for_each(|torque| hprint!("{:9.3}", torque));
            hprintln!();
        }
        let [control, simulation] = [self.control, self.simulation].map(|share| 100.0 * share);
        hprintln!("of a period: {control:.1} % until the torques are there, {simulation:.1} % with the simulated arm");
        hprintln!("periods missed: {}, stack: {} bytes", self.missed, self.stack);
        hprintln!("{}\n", if self.is_good() { "tracked" } else { "NOT tracked" });
    }
}
