//! An arm as URDF, the only description that the crate `dynibo` reads.

use std::fmt::Write;

use rne::model::{Angle, Convention, Robot};

/// Gravity of `dynibo`, m/s² along -z of the world. It cannot be set.
pub const GRAVITY: f64 = 9.80665;

type Matrix = [[f64; 3]; 3];

/// A placement: rotation and translation.
#[derive(Clone, Copy)]
struct Frame {
    turn: Matrix,
    shift: [f64; 3],
}

impl Frame {
    const IDENTITY: Self = Self { turn: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], shift: [0.0; 3] };

    fn about_x(angle: Angle) -> Self {
        let Angle { sin: s, cos: c, .. } = angle;
        Self { turn: [[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]], shift: [0.0; 3] }
    }

    fn about_z(angle: Angle) -> Self {
        let Angle { sin: s, cos: c, .. } = angle;
        Self { turn: [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]], shift: [0.0; 3] }
    }

    fn along(x: f64, z: f64) -> Self {
        Self { shift: [x, 0.0, z], ..Self::IDENTITY }
    }

    fn place(&self, point: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| self.shift[i] + (0..3).map(|k| self.turn[i][k] * point[k]).sum::<f64>())
    }

    fn then(self, next: Self) -> Self {
        let turn = std::array::from_fn(|i| {
            std::array::from_fn(|j| (0..3).map(|k| self.turn[i][k] * next.turn[k][j]).sum::<f64>())
        });
        Self { turn, shift: self.place(next.shift) }
    }

    /// `<origin …/>`: R = Rz(yaw) Ry(pitch) Rx(roll).
    fn origin(&self) -> String {
        let (r, [x, y, z]) = (&self.turn, self.shift);
        let pitch = f64::atan2(-r[2][0], r[2][1].hypot(r[2][2]));
        let (roll, yaw) = (f64::atan2(r[2][1], r[2][2]), f64::atan2(r[1][0], r[0][0]));
        format!("<origin xyz='{x:e} {y:e} {z:e}' rpy='{roll:e} {pitch:e} {yaw:e}'/>")
    }
}

/// The arm as URDF. URDF has the frame of a link on its joint's axis; a standard table has it at the far end, so masses
/// and inertias move with the constant part of the row.
pub fn urdf(robot: &Robot) -> String {
    let name = &robot.name;
    let mut text = format!("<robot name='{name}'>\n<link name='link0'/>\n");
    let mut before = Frame::IDENTITY; // from the frame of the link before to the joint's axis
    for (index, row) in robot.rows().enumerate() {
        let dh = &row.dh;
        let along_and_about_z = Frame::about_z(dh.theta).then(Frame::along(0.0, dh.d));
        let along_and_about_x = Frame::along(dh.a, 0.0).then(Frame::about_x(dh.alpha));
        // The placement of the axis, and that of the link's frame of the table in the link's frame of URDF.
        let (axis, table) = match robot.convention {
            Convention::Standard => (before, along_and_about_z.then(along_and_about_x)),
            Convention::Modified => (before.then(along_and_about_x).then(along_and_about_z), Frame::IDENTITY),
        };
        before = table;
        let (link, inertia) = (index + 1, &row.link.inertia);
        let kind = row.kind.name();
        let placed = Frame { shift: table.place(row.link.com), ..table };
        let _ = writeln!(
            text,
            "<joint name='joint{link}' type='{kind}'>{}<parent link='link{index}'/><child link='link{link}'/>\
             <axis xyz='0 0 1'/><limit lower='-100' upper='100' effort='1' velocity='100'/></joint>\n\
             <link name='link{link}'><inertial>{}<mass value='{:e}'/><inertia ixx='{:e}' iyy='{:e}' izz='{:e}' \
             ixy='{:e}' \
             ixz='{:e}' iyz='{:e}'/></inertial></link>",
            axis.origin(),
            placed.origin(),
            row.link.mass,
            inertia.xx,
            inertia.yy,
            inertia.zz,
            inertia.xy,
            inertia.xz,
            inertia.yz,
        );
    }
    text.push_str("</robot>\n");
    text
}
