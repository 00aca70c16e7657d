//! Converts a URDF to a robot file, with a record of what was done.

pub(crate) mod remarks;
pub(crate) mod robot;

use std::ops::Range;

use rne_model::{Convention, FloatingBase, Inertia, Link, Reader, Remedy, Report, Robot, one_line};

use self::remarks::{SNAPPED, base_remark, notes, snapping};
use self::robot::{identifier, robot, title};
use crate::chain::{Chain, Extracted, extract};
use crate::comparison::Difference;
use crate::dynamics::Dynamics;
use crate::frames::{as_identifier, as_identifiers, named_frames, transform};
use crate::remark::Remark;
use crate::robot_file;
use crate::selection::Selection;
use crate::snap::Snapped;
use crate::source::{names, quoted};
use crate::table::{Table, table, tree_table};
use crate::urdf::Urdf;

/// Options of the conversion from a URDF to a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// The chain that is taken out of the tree.
    pub selection: Selection,
    /// Further links of a whole robot on which wrenches act, in addition to the tip. They become frames, and the robot
    /// file lists the tip and them in `tips`.
    pub more_tips: Vec<String>,
    /// The convention of the rows of the table.
    pub convention: Convention,
    /// Whether an angle within 2e-4 rad of a multiple of pi/12 is replaced by this multiple.
    pub snap: bool,
    /// Whether a body is kept although its inertia is not positive semidefinite.
    pub keep_unphysical: bool,
    /// The acceleration of gravity in the axes of the root link, m/s². If the file is an MJCF file, its own gravity is
    /// used instead.
    pub gravity: [f64; 3],
    /// Whether links of the chain, and links that are fixed to these, become named frames of the robot file.
    pub frames: bool,
    /// The name of the robot, `[a-z][a-z0-9_]*` [default: made from the name in the URDF].
    pub name: Option<String>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            selection: Selection::default(),
            more_tips: Vec::new(),
            convention: Convention::Standard,
            snap: true,
            keep_unphysical: false,
            gravity: [0.0, 0.0, -9.81],
            frames: false,
            name: None,
        }
    }
}

/// The result of importing a URDF.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Imported {
    /// The robot.
    pub robot: Robot,
    /// The robot file of the robot; reading it gives the same robot, bit for bit.
    pub text: String,
    /// A record of what the import did.
    pub account: Account,
}

/// A record of what an import did.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Account {
    /// The link at the base of the chain.
    pub base: String,
    /// The link at the end of the chain.
    pub tip: String,
    /// Whether the link that floats in the file became the floating base; `false` if it was fixed, `None` where none
    /// floats.
    pub floats: Option<bool>,
    /// Joints that are locked, with their positions, rad or m.
    pub held: Vec<(String, f64)>,
    /// Movable joints on links that stand still, which do not belong to the arm.
    pub aside: Vec<String>,
    /// Links that are frames of the robot file, or could be, each with its name as a frame.
    pub frames: Vec<(String, String)>,
    /// For each joint, the links with mass that were merged into the link that it moves.
    pub lumped: Vec<(String, Vec<String>)>,
    /// Angles and axes that were replaced by the exact values that they probably round.
    pub snapped: Vec<Snapped>,
    /// The differences that replacing rounded angles causes; `None` where none was replaced.
    pub change: Option<Difference>,
    /// The differences between the chain and the table, as rne computes it: the rounding of the conversion.
    pub rounding: Difference,
    /// Remarks on parts that the import leaves out or assumes, and on probable mistakes in the file: limits that it
    /// ignores, numbers in other units.
    pub remarks: Vec<Remark>,
    /// Whether the file is an MJCF file and not a URDF.
    pub is_mjcf: bool,
    /// The warnings and notes about the robot file.
    pub lints: Report,
}

impl Account {
    /// Returns the remarks as sentences.
    #[must_use]
    pub fn sentences(&self) -> Vec<String> {
        self.remarks.iter().map(ToString::to_string).collect()
    }

    /// Returns a sentence on how many angles were snapped, and how much this changes torques and tip; `None` where none
    /// was.
    #[must_use]
    pub fn snapping(&self) -> Option<String> {
        self.change.as_ref().map(|change| snapping(&self.snapped, change))
    }
}

/// Finds the note on snapped angles in the notes of an imported robot file; `None` where no angle was snapped.
#[must_use]
pub fn snapping_in(notes: &str) -> Option<&str> {
    let items = notes.lines().filter_map(|line| line.trim().strip_prefix("- "));
    items.into_iter().find(|item| item.starts_with(SNAPPED))
}

impl Urdf {
    /// Converts a chain of the tree into a table.
    ///
    /// ```
    /// let text = r#"
    /// <robot name="Pendulum">
    ///   <link name="base"/>
    ///   <link name="rod"><inertial>
    ///     <origin xyz="0 0 -0.25"/><mass value="2"/>
    ///     <inertia ixx="0.04" ixy="0" ixz="0" iyy="0.04" iyz="0" izz="0"/>
    ///   </inertial></link>
    ///   <joint name="hinge" type="continuous">
    ///     <parent link="base"/><child link="rod"/><axis xyz="0 1 0"/>
    ///   </joint>
    /// </robot>"#;
    /// let imported = rne_convert::Urdf::read("pendulum.urdf", text).unwrap().import(&Default::default()).unwrap();
    /// assert_eq!(imported.robot.name, "pendulum");
    /// assert_eq!(imported.robot.gravity, [0.0, 9.81, 0.0]);
    /// assert_eq!(imported.robot.joints[0].row.link.com, [0.0, 0.25, 0.0]);
    /// ```
    ///
    /// A robot with closed loops is taken as a whole where `selection` names no tip and holds no others: no arm alone
    /// has them. [`Account::remarks`] says which joints are dependent, and why.
    ///
    /// # Errors
    ///
    /// An error with its place in the URDF: a name that is not there, a tip that must be named, movable
    /// joints off the chain that nobody holds, joints that no row of a table can say, bodies that are none.
    pub fn import(&self, options: &Options) -> Result<Imported, Report> {
        let Selection { whole, tip, lock_others, .. } = &options.selection;
        if !self.loops.is_empty() && !whole && tip.is_none() && !lock_others {
            let selection = Selection { whole: true, ..options.selection.clone() };
            let options = Options { selection, convention: Convention::Modified, ..options.clone() };
            return self.import(&options);
        }
        let gravity = self.gravity.unwrap_or(options.gravity);
        let (mut chain, mut told) = extract(self, &options.selection, gravity, options.snap)?;
        told.remarks.0.splice(0..0, self.remarks.0.iter().cloned());
        let table = self.table(options, &chain)?;
        if options.selection.whole && chain.is_arm() && options.more_tips.is_empty() {
            let remark = "no link carries two joints, so the robot is a serial arm and its file has `format: 1`";
            told.remarks.push(remark.to_owned());
        }
        let mut robot = robot(&chain, &table, options.convention);
        self.close((&chain, &mut told), &table, &mut robot)?;
        self.name_robot(&mut robot, options, &told);
        let frames = self.take_frames((&mut chain, &mut told), &table, options, &mut robot)?;
        if !options.keep_unphysical {
            self.refuse_unphysical(&robot, &told)?;
        }
        let exact = Dynamics::of(&chain);
        let change = if told.snapped.is_empty() {
            None
        } else {
            let (raw, _) = extract(self, &options.selection, gravity, false)?;
            Some(Difference::of_chains(&Dynamics::of(&raw), &exact))
        };
        robot.notes = notes(&told, change.as_ref());
        let text = robot_file::write(&robot);
        let file = format!("{}, imported", self.source.file);
        let checked = Reader::new(&file).trees().couplings().loops().read(&text);
        let checked = checked.map_err(|report| self.joint_called_base().unwrap_or(report))?;
        let joints = chain.joints.iter().map(|joint| joint.name.clone());
        let account = Account {
            remarks: self.remarks_on(&mut told, &robot, &table),
            is_mjcf: self.gravity.is_some(),
            lumped: joints.zip(told.lumped).filter(|(_, links)| links.len() > 1).collect(),
            base: told.base,
            tip: told.tip,
            floats: told.floats,
            held: told.held,
            frames,
            aside: told.aside,
            snapped: told.snapped,
            change,
            rounding: Difference::of_table(&exact, &checked.robot),
            lints: checked.lints,
        };
        Ok(Imported { robot: checked.robot, text, account })
    }

    /// Makes the table of a chain or of a tree. Only the modified convention has rows for a tree.
    fn table(&self, options: &Options, chain: &Chain) -> Result<Table, Report> {
        if chain.is_arm() {
            return Ok(table(chain, options.convention));
        }
        if options.convention == Convention::Standard {
            let message = "a tree is written with modified rows, which may begin at gamma and b";
            let help = "choose the convention `modified`";
            return Err(self.source.error(&(0..0), message, help));
        }
        Ok(tree_table(chain))
    }

    /// Sets the name, the title and the source of the robot, and gives its floating base a name that no joint has.
    fn name_robot(&self, robot: &mut Robot, options: &Options, told: &Extracted) {
        robot.name = options.name.clone().unwrap_or_else(|| identifier(&self.name));
        robot.title = title(&self.name);
        if let Some(base) = &mut robot.floating_base {
            base.name = as_identifier(&told.base, "base_");
            while robot.joints.iter().any(|joint| joint.name == base.name) {
                base.name.push_str("_base");
            }
        }
        let [base, tip] = [&told.base, &told.tip].map(|link| one_line(link));
        let links =
            if options.selection.whole { format!("everything after {base}") } else { format!("from {base} to {tip}") };
        let (file, version) = (one_line(self.source.file_name()), env!("CARGO_PKG_VERSION"));
        robot.source = format!("{file}, {links}; imported by rne {version}");
    }

    /// Returns the error for a joint named `base`: in a robot file this is the name of frame 0, to which other rows and
    /// frames refer.
    fn joint_called_base(&self) -> Option<Report> {
        let joint = self.joints.iter().find(|joint| joint.name == "base")?;
        let message = "the joint `base` has the name that a robot file gives to frame 0";
        Some(self.source.error(&joint.span, message, "rename the joint, for instance `base_joint`"))
    }

    /// Gives the robot its named frames and its tips, and removes from the chain the frames that the robot does not
    /// have. Returns the links, each with its name as a frame.
    fn take_frames(
        &self,
        (chain, told): (&mut Chain, &mut Extracted),
        table: &Table,
        options: &Options,
        robot: &mut Robot,
    ) -> Result<Vec<(String, String)>, Report> {
        let links: Vec<String> = chain.frames.iter().map(|frame| frame.name.clone()).collect();
        chain.frames = as_identifiers(std::mem::take(&mut chain.frames), robot);
        let frames: Vec<_> = links.into_iter().zip(chain.frames.iter().map(|frame| frame.name.clone())).collect();
        let all = named_frames(chain, table);
        if !options.more_tips.is_empty() {
            let tips = self.tips(options, &told.tip, &frames)?;
            robot.frames = all.into_iter().filter(|frame| options.frames || tips.contains(&frame.name)).collect();
            let place = |name: &String| robot.frames.iter().position(|frame| frame.name == *name);
            robot.tips = tips.iter().filter_map(place).collect();
            self.refuse_tips_on_base(robot)?;
            // only frames of the robot are compared between chain and table
            chain.frames.retain(|frame| robot.frames.iter().any(|kept| kept.name == frame.name));
        } else if options.frames {
            robot.frames = all;
        }
        if options.frames {
            told.remarks.0.extend(base_remark(&told.base, &frames, transform(table.start)).map(Remark::from));
        }
        Ok(frames)
    }

    /// Returns the names of the frames of the tip `first` and of the other tips; `frames` has the links with their
    /// names as frames.
    fn tips(&self, options: &Options, first: &str, frames: &[(String, String)]) -> Result<Vec<String>, Report> {
        if !options.selection.whole {
            let message = "several tips are of a whole robot, and this is one arm";
            let help = "name one tip";
            return Err(self.source.error_with(&(0..0), message, help, &Remedy::Whole));
        }
        let mut tips: Vec<String> = Vec::new();
        for link in [first].into_iter().chain(options.more_tips.iter().map(String::as_str)) {
            let index = crate::selection::link(self, link, "tip")?;
            let Some((_, name)) = frames.iter().find(|(known, _)| known == link) else {
                let message = format!("the tip {} does not come after the base", quoted(link));
                return Err(self.source.error(&self.links[index].span, message, None));
            };
            if tips.contains(name) {
                let message = format!("the tip {} is named twice; each tip carries one wrench", quoted(link));
                return Err(self.source.error(&self.links[index].span, message, None));
            }
            tips.push(name.clone());
        }
        Ok(tips)
    }

    /// Refuses a tip on the base, because a joint must move each tip.
    fn refuse_tips_on_base(&self, robot: &Robot) -> Result<(), Report> {
        match robot.tips.iter().map(|&tip| &robot.frames[tip]).find(|frame| frame.fixed.on.is_none()) {
            Some(frame) => {
                let message = format!("no movable joint moves the tip {}", quoted(&frame.name));
                Err(self.source.error(&(0..0), message, None))
            }
            None => Ok(()),
        }
    }

    /// Refuses bodies whose inertia has a negative principal moment that the rounding of the digits in the file does
    /// not explain.
    fn refuse_unphysical(&self, robot: &Robot, told: &Extracted) -> Result<(), Report> {
        if let Some(FloatingBase { link, .. }) = &robot.floating_base {
            let name = format!("the base {}", quoted(&told.base));
            self.refuse_negative(&(0..0), &name, link, std::slice::from_ref(&told.base))?;
        }
        for ((joint, span), lumped) in robot.joints.iter().zip(&told.spans).zip(&told.lumped) {
            let name = format!("the link that the joint {} moves", quoted(&joint.name));
            self.refuse_negative(span, &name, &joint.row.link, lumped)?;
        }
        Ok(())
    }

    /// Refuses a link with a negative principal moment. It is merged from the links `lumped`; the error is at the one
    /// with the smallest moment.
    fn refuse_negative(&self, joint: &Range<usize>, name: &str, link: &Link, lumped: &[String]) -> Result<(), Report> {
        let least = |inertia: &Inertia| inertia.principal_moments().map_or(f64::NAN, |moments| moments[0]);
        let parts = || self.links.iter().filter(|link| lumped.contains(&link.name));
        let (moment, rounding) = (least(&link.inertia), parts().map(|part| part.inertia.rounding()).sum::<f64>());
        if link.is_physical(&link.inertia) || moment >= -rounding {
            return Ok(());
        }
        let worst = parts().min_by(|a, b| least(&a.inertia).total_cmp(&least(&b.inertia)));
        let span = worst.map_or(joint, |part| &part.span_of_inertia);
        let message =
            format!("{name} has the principal moment of inertia {moment:.3e} kg m²; no body has a negative one");
        let several = if lumped.len() > 1 { format!(" (lumped of {})", names(lumped)) } else { String::new() };
        let help = format!("correct the inertia{several}, or keep it");
        Err(self.source.error_with(span, message, help, &Remedy::KeepUnphysical))
    }
}
