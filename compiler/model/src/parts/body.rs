//! Bodies: masses that are fixed to links, such as a camera. Reading a robot file adds each to the link that carries
//! it.

use std::fmt;

use crate::parts::inertia::principal_moments;
use crate::text::source::quoted;
use crate::text::spelling::nearest_name;
use crate::{FixedFrame, FloatingBase, Inertia, InertiaReference, Joint, Link, Robot, Transform};

/// A body that is fixed to a link: an entry of the list `bodies` of a robot file.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// The name of the body, `[A-Za-z][A-Za-z0-9_]*`; no other body has it.
    pub name: String,
    /// The link that carries the body, and the placement of the body's frame on this link. A body on a base that is
    /// fixed to the world has no effect.
    pub fixed: FixedFrame,
    /// Mass, centre of mass and inertia about the centre of mass, in the frame of the body.
    pub matter: Link,
}

/// The bodies of a robot, and the links as they are without bodies.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bodies {
    /// The bodies that are parts of links, in the order of the file.
    pub list: Vec<Body>,
    /// For each link that has bodies: the joint that moves the link, counted from 0, the link without bodies, and its
    /// inertia as the file writes it.
    pub(crate) bare: Vec<(usize, Link, (Inertia, InertiaReference))>,
    /// The floating base without bodies.
    pub(crate) bare_base: Option<Link>,
}

/// A name that no body of a robot has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownBody {
    /// The name that was asked for.
    pub name: String,
    /// The name of the robot.
    pub robot: String,
    /// The names of its bodies.
    pub bodies: Vec<String>,
}

impl fmt::Display for UnknownBody {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} has no body {}: ", self.robot, quoted(&self.name))?;
        let known: Vec<&str> = self.bodies.iter().map(String::as_str).collect();
        match (known.as_slice(), nearest_name(&self.name, &known)) {
            ([], _) => f.write_str("its file has no list `bodies`"),
            (known, meant) => {
                let listed: Vec<_> = known.iter().map(|name| quoted(name)).collect();
                write!(f, "its bodies are {}", listed.join(", "))?;
                meant.map_or(Ok(()), |meant| write!(f, "; did you mean {}?", quoted(meant)))
            }
        }
    }
}

impl std::error::Error for UnknownBody {}

impl Robot {
    /// Returns the robot without the bodies that have these names, as if the file did not have them.
    ///
    /// # Errors
    /// When no body of the robot has one of the names.
    pub fn without_bodies(&self, names: &[&str]) -> Result<Self, UnknownBody> {
        if let Some(unknown) = names.iter().find(|name| self.bodies.list.iter().all(|body| body.name != **name)) {
            return Err(UnknownBody {
                name: (*unknown).to_owned(),
                robot: self.name.clone(),
                bodies: self.bodies.list.iter().map(|body| body.name.clone()).collect(),
            });
        }
        let mut robot = self.clone();
        for (joint, link, written) in std::mem::take(&mut robot.bodies.bare) {
            if let Some(joint) = robot.joints.get_mut(joint) {
                (joint.row.link, joint.written_inertia) = (link, written);
            }
        }
        if let (Some(base), Some(link)) = (&mut robot.floating_base, robot.bodies.bare_base.take()) {
            base.link = link;
        }
        robot.bodies.list.retain(|body| !names.contains(&body.name.as_str()));
        robot.bodies.add_to(&mut robot.joints, robot.floating_base.as_mut());
        Ok(robot)
    }
}

impl Bodies {
    /// Adds the mass and inertia of each body to its link.
    pub(crate) fn add_to(&mut self, joints: &mut [Joint], mut base: Option<&mut FloatingBase>) {
        for body in &self.list {
            let matter = seen_from_link(&body.matter, &body.fixed.placement);
            let Some(on) = body.fixed.on else {
                if let Some(base) = base.as_mut() {
                    self.bare_base.get_or_insert(base.link);
                    base.link = together(&base.link, &matter);
                }
                continue;
            };
            let Some(joint) = joints.get_mut(on) else { continue };
            if self.bare.iter().all(|(known, ..)| *known != on) {
                self.bare.push((on, joint.row.link, joint.written_inertia));
            }
            joint.row.link = together(&joint.row.link, &matter);
            joint.written_inertia = (joint.row.link.inertia, InertiaReference::Com);
        }
    }
}

/// Returns a body in the axes of the link frame: centre R c + p and inertia R I Rᵀ, with R = Rz(yaw) Ry(pitch)
/// Rx(roll).
fn seen_from_link(matter: &Link, placement: &Transform) -> Link {
    let [roll, pitch, yaw] = placement.rpy.map(|angle| (angle.sin, angle.cos));
    let about = |x: usize, (s, c): (f64, f64)| {
        let (y, z) = ((x + 1) % 3, (x + 2) % 3);
        let mut rows = [[0.0; 3]; 3];
        (rows[x][x], rows[y][y], rows[z][z]) = (1.0, c, c);
        (rows[y][z], rows[z][y]) = (-s, s);
        rows
    };
    let rotation = product(&product(&about(2, yaw), &about(1, pitch)), &about(0, roll));
    let transposed = [0, 1, 2].map(|row| [0, 1, 2].map(|column: usize| rotation[column][row]));
    let tensor = product(&product(&rotation, &matter.inertia.rows()), &transposed);
    let com = [0, 1, 2].map(|row| {
        let turned: f64 = rotation[row].iter().zip(matter.com).map(|(element, x)| element * x).sum();
        turned + placement.xyz[row]
    });
    let inertia = Inertia {
        xx: tensor[0][0],
        yy: tensor[1][1],
        zz: tensor[2][2],
        xy: tensor[0][1],
        xz: tensor[0][2],
        yz: tensor[1][2],
    };
    Link { mass: matter.mass, com, inertia, first_moment: [0.0; 3] }
}

fn product(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    [0, 1, 2].map(|row: usize| {
        // adding 0.0 changes -0 to 0
        [0, 1, 2].map(|column: usize| (0..3).map(|k| a[row][k] * b[k][column]).sum::<f64>() + 0.0)
    })
}

/// Combines two bodies into one, by the parallel axis theorem: with the vector δ from one centre of mass to the other
/// and the reduced mass μ = m₁ m₂ / (m₁ + m₂), the inertia about the common centre of mass is I₁ + I₂ + μ (|δ|² 1 - δ
/// δᵀ).
fn together(one: &Link, other: &Link) -> Link {
    let mass = one.mass + other.mass;
    let delta = [0, 1, 2].map(|axis: usize| other.com[axis] - one.com[axis]);
    let (com, reduced) = if one.mass == 0.0 {
        (if other.mass == 0.0 { one.com } else { other.com }, 0.0)
    } else {
        let part = other.mass / mass;
        ([0, 1, 2].map(|axis: usize| one.com[axis] + part * delta[axis]), one.mass * part)
    };
    let [x, y, z] = delta;
    let (a, b) = (one.inertia, other.inertia);
    let inertia = Inertia {
        xx: a.xx + b.xx + reduced * (y * y + z * z),
        yy: a.yy + b.yy + reduced * (x * x + z * z),
        zz: a.zz + b.zz + reduced * (x * x + y * y),
        xy: a.xy + b.xy - reduced * (x * y),
        xz: a.xz + b.xz - reduced * (x * z),
        yz: a.yz + b.yz - reduced * (y * z),
    };
    Link { mass, com, inertia, first_moment: [0.0; 3] }
}

/// Returns the first body, counted from 0, that makes the numbers of its link infinite by overflow, and the joint of
/// the link.
pub(crate) fn overflow(list: &[Body], joints: &[Joint]) -> Option<(usize, usize)> {
    let mut links: Vec<Link> = joints.iter().map(|joint| joint.row.link).collect();
    list.iter().enumerate().find_map(|(index, body)| {
        let on = body.fixed.on?;
        let link = links.get_mut(on)?;
        *link = together(link, &seen_from_link(&body.matter, &body.fixed.placement));
        let numbers = [link.mass].into_iter().chain(link.com);
        let is_finite = numbers.chain(link.com.map(|c| link.mass * c)).all(f64::is_finite);
        (!is_finite || principal_moments(&link.inertia).is_none()).then_some((index, on))
    })
}
