//! The list `motors`: motors that turn with several joints, and rotors that turn on the links that carry them.

use crate::Robot;

/// A motor of the list `motors`, whose speed is Σ n q̇ over some joints. It differs from the [`Motor`](crate::Motor) of
/// a joint, which has friction and turns with only that joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// The name of the motor; `motor1`, `motor2`, … when the file gives none.
    pub name: String,
    /// The joints with which the motor turns, counted from 0, in the order of the rows, with the ratio n of each: motor
    /// turns per joint turn (rad/rad, rad/m for a prismatic joint). No n is zero.
    pub turns: Vec<(usize, f64)>,
    /// The part of the motor that turns; `None` for a motor that only maps torques and speeds.
    pub rotor: Option<Rotor>,
}

/// The rotor of a [`Drive`]. It turns on a link, its carrier, whose mass and inertia include the rotor at rest.
///
/// With the spin s = Σ n q̇ about the axis a, relative to the carrier, it adds Jm s a to the angular momentum of the
/// carrier, and n Jm (s + a · ω) to the momentum of each joint with which it turns; ω is the angular velocity of the
/// carrier.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotor {
    /// The direction of its axis in the axes of the carrier's link frame: a unit vector.
    pub axis: [f64; 3],
    /// The joint whose link carries the rotor, counted from 0; `None` for the base.
    pub on: Option<usize>,
    /// Inertia Jm of the rotor about its axis, kg m².
    pub inertia: f64,
}

impl Robot {
    /// Returns whether the list `motors` has a rotor with inertia, which turns on a link or on the base.
    #[must_use]
    pub fn has_spinning_rotors(&self) -> bool {
        self.spinning_rotors().next().is_some()
    }

    /// Returns the rotors of the list `motors` whose inertia is not zero, with the joints with which each turns.
    pub fn spinning_rotors(&self) -> impl Iterator<Item = (&Rotor, &[(usize, f64)])> {
        self.drives.iter().filter_map(|drive| {
            let rotor = drive.rotor.as_ref().filter(|rotor| rotor.inertia != 0.0)?;
            Some((rotor, drive.turns.as_slice()))
        })
    }

    /// Returns the matrix N, by rows: N q̇ are the speeds of the motors of the list `motors`, and motor torques τ act
    /// on the coordinates as Nᵀ τ.
    #[must_use]
    pub fn motor_matrix(&self) -> Vec<Vec<f64>> {
        let coordinates: Vec<usize> = self.coordinates().collect();
        let row = |drive: &Drive| {
            let mut row = vec![0.0; coordinates.len()];
            let mut add = |joint: usize, n: f64| {
                if let Some(place) = coordinates.iter().position(|coordinate| *coordinate == joint) {
                    row[place] += n;
                }
            };
            for &(joint, n) in &drive.turns {
                match &self.joints[joint].coupling {
                    None => add(joint, n),
                    Some(coupling) => coupling.follows.iter().for_each(|&(followed, ratio)| add(followed, n * ratio)),
                }
            }
            row
        };
        self.drives.iter().map(row).collect()
    }

    /// Returns N⁻¹ of the [`motor_matrix`](Self::motor_matrix), by rows; `None` where N is singular or not square.
    #[must_use]
    pub fn inverse_motor_matrix(&self) -> Option<Vec<Vec<f64>>> {
        /// A pivot below this part of the largest element counts as zero.
        const LEAST_PIVOT: f64 = 1e-12;
        let size = self.dof();
        let mut left = self.motor_matrix();
        let largest = left.iter().flatten().fold(0.0_f64, |largest, x| largest.max(x.abs()));
        if left.len() != size || largest == 0.0 {
            return None;
        }
        let unit = |row: usize| (0..size).map(|column| f64::from(u8::from(row == column))).collect::<Vec<_>>();
        let mut right: Vec<Vec<f64>> = (0..size).map(unit).collect();
        for column in 0..size {
            let pivot = (column..size).max_by(|&a, &b| left[a][column].abs().total_cmp(&left[b][column].abs()))?;
            if left[pivot][column].abs() <= LEAST_PIVOT * largest {
                return None;
            }
            left.swap(column, pivot);
            right.swap(column, pivot);
            let scale = left[column][column];
            for matrix in [&mut left, &mut right] {
                matrix[column].iter_mut().for_each(|x| *x /= scale);
            }
            for row in (0..size).filter(|row| *row != column) {
                let factor = left[row][column];
                if factor != 0.0 {
                    for matrix in [&mut left, &mut right] {
                        let pivot = matrix[column].clone();
                        matrix[row].iter_mut().zip(pivot).for_each(|(x, p)| *x -= factor * p);
                    }
                }
            }
        }
        // adding 0.0 changes -0 to 0
        right.iter_mut().flatten().for_each(|x| *x += 0.0);
        Some(right)
    }
}
