//! The arm that a command line chooses: a file, optionally with rotors or with other values of its parameters.

use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::Args;
use rne::Payload;
use rne_codegen::Function;
use rne_model::{Checked, Robot};

use crate::files::robot_file::{self, Frames, Shape};
use crate::outcome::Failure;
use crate::palette::{TITLE, TYPED};
use crate::values::numbers::{List, not_a_number};
use crate::values::payload::payload;

/// Rotors belong to the arm.
#[derive(Args, Clone, Copy, Default)]
pub(crate) struct Rotors {
    /// Include the inertia of the motors' rotors
    #[arg(long)]
    pub(crate) rotors: bool,
}

impl Rotors {
    /// Reads the robot of a file.
    pub(crate) fn robot(self, path: &Path, shape: Shape) -> Result<Robot, Failure> {
        Ok(self.of(robot_file::robot(path, shape)?))
    }

    /// Applies the option to a robot that has been read.
    pub(crate) fn of(self, robot: Robot) -> Robot {
        Robot { rotors: self.rotors, ..robot }
    }

    /// Returns a note if the option has no effect on a robot.
    pub(crate) fn note(self, robot: &Robot) -> String {
        if !self.rotors || robot.has_rotors() {
            return String::new();
        }
        format!(
            "{TITLE}note{TITLE:#}: no joint of {} has a rotor inertia, so {TYPED}--rotors{TYPED:#} changes nothing\n",
            robot.name
        )
    }
}

/// Refuses to identify rotors whose inertia the list `motors` already has, because it would be counted twice.
pub(crate) fn check_unknown_rotors(robot: &Robot, is_asked: bool) -> Result<(), Failure> {
    if is_asked && robot.has_spinning_rotors() {
        return Err(usage_error!(
            "the list `motors` of {} has the inertia of its rotors, which is known; leave out {TYPED}--rotors{TYPED:#}",
            robot.name
        ));
    }
    Ok(())
}

/// The frame that stands in the place of the tip.
#[derive(Args, Clone)]
pub(crate) struct AtFrame {
    /// Take it at this frame or joint, not at the tip
    #[arg(long, value_name = "NAME")]
    pub(crate) frame: Option<String>,
}

impl AtFrame {
    /// Puts the frame in place of the robot's tip.
    pub(crate) fn of(&self, robot: Robot) -> Result<Robot, Failure> {
        let Some(name) = &self.frame else { return Ok(robot) };
        at_frame(robot, name)
    }

    /// Checks that a function can be computed at a frame.
    pub(crate) fn check(&self, function: Function) -> Result<(), Failure> {
        if self.frame.is_none() || function.of_frame().is_some() {
            return Ok(());
        }
        Err(not_of_frames(format_args!("{function} is not one of them")))
    }
}

/// Makes the error for functions that cannot be computed at the frames of `--frame`.
pub(crate) fn not_of_frames(why: impl Display) -> Failure {
    let with: Vec<&str> = Function::of_frames().map(Function::name).collect();
    usage_error!("{TYPED}--frame{TYPED:#} is for functions of a frame, and {why}; these are: {}", with.join(", "))
}

/// Returns a robot with the frame of this name in place of its tip.
pub(crate) fn at_frame(robot: Robot, name: &str) -> Result<Robot, Failure> {
    let frame = robot.frame(name).map_err(Failure::usage)?;
    Ok(robot.at_frame(frame))
}

/// A parameter of the file and the value that the command line gives it: `payload=2`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Setting {
    pub(crate) name: String,
    pub(crate) value: f64,
}

impl FromStr for Setting {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, value) = text.split_once('=').ok_or("write NAME=VALUE, such as payload=2")?;
        let (name, value) = (name.trim(), value.trim());
        if name.is_empty() {
            return Err("the name is missing; write NAME=VALUE, such as payload=2".to_owned());
        }
        if value.is_empty() {
            return Err(format!("the value is missing; write {name}=VALUE, such as {name}=2"));
        }
        let value = rne_model::number(value).map_err(|mistake| {
            let hint = mistake.help.as_deref().unwrap_or("write a number or an expression, such as 0.5 or pi/2");
            format!("{}; {hint}", not_a_number(value, &mistake.message))
        })?;
        Ok(Self { name: name.to_owned(), value })
    }
}

/// A body that the arm carries at its tip.
#[derive(Args, Clone)]
pub(crate) struct Carried {
    /// Payload: m,cx,cy,cz[,xx,yy,zz,xy,xz,yz], tip axes
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    pub(crate) payload: Option<List>,
    /// Frame or joint with --payload, not the tip
    #[arg(long, value_name = "NAME", requires = "payload")]
    pub(crate) payload_on: Option<String>,
}

impl Carried {
    /// Returns the robot with the payload added to the link that carries the tip.
    pub(crate) fn of(&self, robot: Robot) -> Result<Robot, Failure> {
        let Some(list) = &self.payload else { return Ok(robot) };
        let Payload { mass, com, inertia } = payload(list)?;
        let frame = match self.payload_on.as_deref().map(|name| robot.frame(name)) {
            None => Some(robot.tip()),
            Some(Ok(frame)) => Some(robot.fixed_frame(frame)),
            Some(Err(unknown)) if unknown.is_base => None,
            Some(Err(unknown)) => return Err(Failure::usage(unknown)),
        };
        let Some(frame) = frame.filter(|frame| frame.on.is_some()) else {
            return Err(Failure::usage(if robot.floating_base.is_some() {
                "--payload-on names the floating base or a frame on it; write a payload there into the list `bodies`"
            } else {
                "--payload-on names the base or a frame on it, where a payload has no effect"
            }));
        };
        Ok(rne_convert::carrying_at(&robot, &frame, mass, com, inertia))
    }

    /// Returns whether the payload can be an argument of a function: only if it is at the tip and not at another frame.
    pub(crate) const fn is_at_tip(&self) -> bool {
        self.payload.is_some() && self.payload_on.is_none()
    }
}

/// The arm whose numbers a command computes.
#[derive(Args)]
pub(crate) struct ChosenArm {
    /// Robot file, or a name from `rne list`
    #[arg(value_name = "FILE")]
    file: PathBuf,
    #[command(flatten)]
    rotors: Rotors,
    /// Set a parameter of FILE; may be repeated
    #[arg(long, value_name = "NAME=VALUE")]
    pub(crate) set: Vec<Setting>,
    /// Leave out a body of `bodies`; may be repeated
    #[arg(long, value_name = "BODY")]
    pub(crate) without: Vec<String>,
    #[command(flatten)]
    pub(crate) carried: Carried,
}

impl ChosenArm {
    /// Returns the file as the command line names it.
    pub(crate) fn file(&self) -> &Path {
        &self.file
    }

    /// Refuses a payload and rotors if they do not change the results of a function.
    pub(crate) fn check(&self, function: Function) -> Result<(), Failure> {
        if self.carried.payload.is_some() && !function.entry().feels_links {
            let with = Function::ALL.into_iter().filter(|other| other.with_payload().is_some()).map(Function::name);
            return Err(usage_error!(
                "{function} takes no {TYPED}--payload{TYPED:#}: masses do not change it. These functions take one, as \
                 do others of forces, energies and the centre of mass: {}",
                with.collect::<Vec<_>>().join(", ")
            ));
        }
        if self.rotors.rotors && !function.feels_rotors() {
            let with = Function::ALL
                .into_iter()
                .filter(|other| other.feels_rotors() && other.is_of_closed_loops() == function.is_of_closed_loops());
            return Err(usage_error!(
                "{function} takes no {TYPED}--rotors{TYPED:#}: the inertia of rotors does not change it. It changes {}",
                with.map(Function::name).collect::<Vec<_>>().join(", ")
            ));
        }
        Ok(())
    }

    /// Returns the robot with the payload added to the link that carries the tip.
    pub(crate) fn robot_with_payload(&self, shape: Shape) -> Result<Robot, Failure> {
        self.carried.of(self.read(Frames::Dropped, shape)?)
    }

    /// Returns the robot without the payload, with a frame in place of its tip; and a note if `--rotors` has no effect.
    pub(crate) fn robot_at(&self, at: &AtFrame) -> Result<(Robot, String), Failure> {
        let names_frame = at.frame.is_some() || self.carried.payload_on.is_some();
        let robot = self.read(if names_frame { Frames::Kept } else { Frames::Dropped }, Shape::Closed)?;
        let note = self.rotors.note(&robot);
        Ok((at.of(robot)?, note))
    }

    fn read(&self, frames: Frames, shape: Shape) -> Result<Robot, Failure> {
        let shown = self.file.display();
        if !self.file.exists() && shown.to_string().parse::<List>().is_ok() {
            return Err(usage_error!(
                "found `{shown}` where FILE, the robot, is expected; write the numbers of a list with commas and \
                 without blanks, as in {TYPED}rne eval planar2 --q 0.5,0.3{TYPED:#}"
            ));
        }
        let robot = with_settings(&self.file, &self.set, frames, shape)?.robot;
        let without: Vec<&str> = self.without.iter().map(String::as_str).collect();
        self.rotors.of(robot).without_bodies(&without).map_err(Failure::usage)
    }
}

/// Reads the robot of a file with other values of its parameters.
fn with_settings(path: &Path, settings: &[Setting], frames: Frames, shape: Shape) -> Result<Checked, Failure> {
    for (index, Setting { name, .. }) in settings.iter().enumerate() {
        if settings[..index].iter().any(|other| other.name == *name) {
            return Err(usage_error!("--set gives {name} twice"));
        }
    }
    let settings: Vec<(&str, f64)> = settings.iter().map(|Setting { name, value }| (name.as_str(), *value)).collect();
    robot_file::read_with(path, &settings, frames, shape)
}
