//! States at which results are compared.

/// Number of states.
pub const STATES: u32 = 32;

/// Positions, velocities and accelerations between -3 and 3, the same on every machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<const DOF: usize, T = f32> {
    pub q: [T; DOF],
    pub qd: [T; DOF],
    pub qdd: [T; DOF],
}

impl<const DOF: usize> State<DOF> {
    /// Returns the state with this number, below [`STATES`].
    #[must_use]
    pub fn new(number: u32) -> Self {
        let mut random = Xorshift(number.wrapping_mul(747_796_405).wrapping_add(2_891_336_453) | 1);
        let mut next = |_| random.next();
        Self {
            q: core::array::from_fn(&mut next),
            qd: core::array::from_fn(&mut next),
            qdd: core::array::from_fn(&mut next),
        }
    }

    /// Returns the state with its numbers in double precision.
    #[must_use]
    pub fn double(&self) -> State<DOF, f64> {
        State { q: self.q.map(f64::from), qd: self.qd.map(f64::from), qdd: self.qdd.map(f64::from) }
    }
}

/// Xorshift generator of random numbers: G. Marsaglia, Journal of Statistical Software 8 (2003).
struct Xorshift(u32);

impl Xorshift {
    #[allow(clippy::cast_precision_loss)] // 24 bits fit
    fn next(&mut self) -> f32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        (self.0 >> 8) as f32 * (6.0 / 16_777_216.0) - 3.0
    }
}
