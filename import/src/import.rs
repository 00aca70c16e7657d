//! From a URDF to a robot file, with an account of what was done.

use std::collections::BTreeSet;
use std::ops::Range;

use rne_model::{
    Angle, Bodies, ClosedLoops, Convention, FixedFrame, FloatingBase, Inertia, InertiaReference, Joint, JointKind,
    Link, Reader, Remedy, Report, Robot, Row, RunTime, Transform,
};

use crate::chain::{Chain, Extracted, extract};
use crate::comparison::Difference;
use crate::dynamics::Dynamics;
use crate::frames::{as_identifiers, named_frames, transform};
use crate::geometry::Pose;
use crate::remark::Remark;
use crate::robot_file;
use crate::selection::Selection;
use crate::snap::Snapped;
use crate::source::{names, quoted, some};
use crate::table::{FAR, NEARLY_PARALLEL, Table, table, tree_table};
use crate::urdf::Urdf;

/// Options of the conversion from a URDF to a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// The chain that is taken out of the tree.
    pub selection: Selection,
    /// Links of a whole robot that carry wrenches, beside the tip. They become frames, and the robot file lists the tip
    /// and them in `tips`.
    pub more_tips: Vec<String>,
    /// The rows of the table.
    pub convention: Convention,
    /// Whether angles within 2e-4 rad of a multiple of pi/12 are taken for it.
    pub snap: bool,
    /// Whether bodies are kept whose inertia is not positive semidefinite.
    pub keep_unphysical: bool,
    /// The acceleration of gravity in the axes of the root link, m/s². An MJCF file says its own, which is taken
    /// instead.
    pub gravity: [f64; 3],
    /// Whether the links of the chain, and the links that are fixed to them, become named frames.
    pub frames: bool,
    /// The name of the robot, `[a-z][a-z0-9_]*` [default: made of that of the URDF].
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

/// A robot made of a URDF.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Imported {
    /// The robot.
    pub robot: Robot,
    /// Its robot file: reading it gives the robot, bit for bit.
    pub text: String,
    /// The steps of the import.
    pub account: Account,
}

/// The record of an import.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Account {
    /// The links at the ends of the chain.
    pub base: String,
    /// The link at the end of the chain.
    pub tip: String,
    /// Whether the link that floats in the file became the floating base, or is fixed; `None` where none floats.
    pub floats: Option<bool>,
    /// Joints that are held, and where, rad or m.
    pub held: Vec<(String, f64)>,
    /// Movable joints on fixed links, which do not belong to the arm.
    pub aside: Vec<String>,
    /// Links that are frames of the robot file, or that could be, each with its name there.
    pub frames: Vec<(String, String)>,
    /// Per joint the links with mass that were lumped into one body.
    pub lumped: Vec<(String, Vec<String>)>,
    /// Angles and axes that were taken for what they round.
    pub snapped: Vec<Snapped>,
    /// The change by snapping; `None` where nothing was snapped.
    pub change: Option<Difference>,
    /// Between the chain and the table as rne computes it: the rounding of the conversion.
    pub rounding: Difference,
    /// Remarks on parts that the import leaves out or assumes, and probable mistakes of the file: limits that it
    /// ignores, numbers in other units.
    pub remarks: Vec<Remark>,
    /// Whether the file is an MJCF file.
    pub is_mjcf: bool,
    /// The lints of the robot file.
    pub lints: Report,
}

impl Account {
    /// The remarks as sentences.
    #[must_use]
    pub fn sentences(&self) -> Vec<String> {
        self.remarks.iter().map(ToString::to_string).collect()
    }

    /// How many angles were snapped, and how far this moves torques and tip; `None` where none was snapped.
    #[must_use]
    pub fn snapping(&self) -> Option<String> {
        self.change.as_ref().map(|change| snapping(&self.snapped, change))
    }
}

/// The words before the number of snapped angles in the notes of a robot file.
const SNAPPED: &str = "angles snapped to multiples of pi/12: ";

fn snapping(snapped: &[Snapped], Difference { position, torque, .. }: &Difference) -> String {
    let count = snapped.len();
    format!("{SNAPPED}{count}; torques move by up to {torque:.1e} of the largest, the tip by {position:.1e} m")
}

/// The note on snapped angles in the notes of a robot file that was imported; `None` where no angle was snapped.
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
        let (chain, mut told) = extract(self, &options.selection, gravity, options.snap)?;
        told.remarks.0.splice(0..0, self.remarks.0.iter().cloned());
        // a serial arm on a floating base keeps the frame of that
        let is_tree = !chain.is_serial() || chain.floating_base.is_some();
        if is_tree && options.convention == Convention::Standard {
            let message = "a tree is written with modified rows, which may begin at gamma and b";
            let help = "choose the convention `modified`";
            return Err(self.source.error(&(0..0), message, help));
        }
        if options.selection.whole && !is_tree && options.more_tips.is_empty() {
            let remark = "no link carries two joints, so the robot is a serial arm and its file has `format: 1`";
            told.remarks.push(remark.to_owned());
        }
        let table = if is_tree { tree_table(&chain) } else { table(&chain, options.convention) };
        let mut robot = robot(&chain, &table, options.convention);
        self.close((&chain, &mut told), &table, &mut robot)?;
        robot.name = options.name.clone().unwrap_or_else(|| identifier(&self.name));
        robot.title = title(&self.name);
        if let Some(base) = &mut robot.floating_base {
            base.name = as_identifier(&told.base);
            while robot.joints.iter().any(|joint| joint.name == base.name) {
                base.name.push_str("_base");
            }
        }
        let links: Vec<String> = chain.frames.iter().map(|frame| frame.name.clone()).collect();
        let mut chain = Chain { frames: as_identifiers(chain.frames, &robot), ..chain };
        let frames: Vec<_> = links.into_iter().zip(chain.frames.iter().map(|frame| frame.name.clone())).collect();
        if options.frames {
            robot.frames = named_frames(&chain, &table);
            told.remarks.0.extend(base_remark(&told.base, &frames, transform(table.start)).map(Remark::from));
        }
        if !options.more_tips.is_empty() {
            let tips = self.tips(options, &told.tip, &frames)?;
            let all = named_frames(&chain, &table);
            robot.frames = all.into_iter().filter(|frame| options.frames || tips.contains(&frame.name)).collect();
            let place = |name: &String| robot.frames.iter().position(|frame| frame.name == *name);
            robot.tips = tips.iter().filter_map(place).collect();
            self.refuse_tips_on_base(&robot)?;
            // those that the robot has are compared
            chain.frames.retain(|frame| robot.frames.iter().any(|kept| kept.name == frame.name));
        }
        robot.source = format!(
            "{}, {}; imported by rne {}",
            printable(self.source.file_name()),
            if options.selection.whole {
                format!("everything after {}", printable(&told.base))
            } else {
                format!("from {} to {}", printable(&told.base), printable(&told.tip))
            },
            env!("CARGO_PKG_VERSION")
        );
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
        let rounding = Difference::of_table(&exact, &checked.robot);
        let joints = chain.joints.iter().map(|joint| joint.name.clone());
        let mut all: Vec<Remark> = self.ignored(&told).into_iter().map(Remark::from).collect();
        let numbers = [self.suspicious_numbers(), self.impossible_parts(&told)].concat();
        all.append(&mut told.remarks.0);
        all.extend(numbers.into_iter().map(Remark::warning));
        all.extend(remarks(&robot, &table).into_iter().map(Remark::from).chain(rotors(&robot)));
        let account = Account {
            remarks: all,
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
            rounding,
            lints: checked.lints,
        };
        Ok(Imported { robot: checked.robot, text, account })
    }

    /// The error for a joint with the name of frame 0, which other rows and frames of a robot file refer to.
    fn joint_called_base(&self) -> Option<Report> {
        let joint = self.joints.iter().find(|joint| joint.name == "base")?;
        let message = "the joint `base` has the name that a robot file gives to frame 0";
        Some(self.source.error(&joint.span, message, "rename the joint, for instance `base_joint`"))
    }

    /// The frames of the tip `first` and of the other tips; `frames` has the links and their names as frames.
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

    /// A tip must be on a link that a joint moves.
    fn refuse_tips_on_base(&self, robot: &Robot) -> Result<(), Report> {
        match robot.tips.iter().map(|&tip| &robot.frames[tip]).find(|frame| frame.fixed.on.is_none()) {
            Some(frame) => {
                let message = format!("no movable joint moves the tip {}", quoted(&frame.name));
                Err(self.source.error(&(0..0), message, None))
            }
            None => Ok(()),
        }
    }

    /// Bodies of which the inertia has a negative eigenvalue, by more than the digits of the file explain.
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

    /// Refuses a link that is made of the links `lumped`, at the inertia of the worst of them.
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

/// The robot of a chain and its table, without texts.
pub(crate) fn robot(chain: &Chain, table: &Table, convention: Convention) -> Robot {
    let start = chain.base * table.start;
    let gravity = start.rotation.transpose() * (chain.base.rotation * chain.gravity);
    let parts = chain.joints.iter().zip(&table.rows).zip(table.frames.iter().zip(&table.branches)).enumerate();
    let joints = parts.map(|(index, ((joint, dh), (frame, &[gamma, b])))| {
        let branch = (joint.parent != index.checked_sub(1) || [gamma, b] != [0.0; 2]).then(|| {
            let rpy = [0.0, 0.0, gamma].map(Angle::new);
            FixedFrame { on: joint.parent, placement: Transform { xyz: [0.0, 0.0, b], rpy } }
        });
        let link = joint.body.to_link_at(frame.inverse());
        let kind = if joint.is_prismatic { JointKind::Prismatic } else { JointKind::Revolute };
        Joint {
            name: printable(&joint.name),
            row: Row { kind, dh: *dh, link },
            branch,
            written_inertia: (
                link.inertia,
                if link.has_first_moment() { InertiaReference::Origin } else { InertiaReference::Com },
            ),
            limits: joint.limits,
            motor: joint.motor,
            coupling: joint.coupling.clone(),
            coulomb_width: joint.coulomb_width,
            coulomb_displacement: joint.coulomb_displacement,
        }
    });
    Robot {
        name: String::new(),
        title: None,
        source: String::new(),
        notes: None,
        convention,
        gravity: gravity.rounded(10.0),
        base: transform(start),
        tool: transform(table.tool),
        // the importer names it
        floating_base: chain
            .floating_base
            .map(|body| FloatingBase { name: String::new(), link: body.to_link_at(Pose::identity()) }),
        tip_on: Some(chain.tip_on).filter(|on| on + 1 != chain.joints.len()),
        parameters: Vec::new(),
        joints: joints.collect(),
        drives: Vec::new(),
        frames: Vec::new(),
        tips: Vec::new(),
        contacts: Vec::new(),
        bodies: Bodies::default(),
        at: None,
        run_time: RunTime::default(),
        closed: ClosedLoops::default(),
        rotors: false,
    }
}

/// The name of a link as that of a floating base.
fn as_identifier(name: &str) -> String {
    let name: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if name.starts_with(|c: char| c.is_ascii_alphabetic()) { name } else { format!("base_{name}") }
}

/// A name for a robot file.
pub(crate) fn identifier(name: &str) -> String {
    let mut identifier = String::new();
    for c in name.chars().take(60) {
        let c = c.to_ascii_lowercase();
        if c.is_ascii_lowercase() || (c.is_ascii_digit() && !identifier.is_empty()) {
            identifier.push(c);
        } else if !identifier.is_empty() && !identifier.ends_with('_') {
            identifier.push('_');
        }
    }
    let identifier = identifier.trim_end_matches('_');
    if identifier.is_empty() { "arm".to_owned() } else { identifier.to_owned() }
}

fn title(name: &str) -> Option<String> {
    let title = printable(name).trim().to_owned();
    (!title.is_empty()).then_some(title)
}

/// A text of the URDF in one of a robot file: one line, without control characters.
fn printable(text: &str) -> String {
    rne_model::one_line(text)
}

/// Notes for the reader of the robot file.
fn notes(told: &Extracted, change: Option<&Difference>) -> Option<String> {
    let mut notes = Vec::new();
    for (joint, value) in &told.held {
        notes.push(format!("- the joint {} is locked at {}", printable(joint), rne_model::exact_digits(*value)));
    }
    notes.extend(told.remarks.0.iter().map(|remark| format!("- {remark}")));
    notes.extend(change.map(|change| format!("- {}", snapping(&told.snapped, change))));
    (!notes.is_empty()).then(|| notes.join("\n"))
}

impl Urdf {
    /// Unknown names in the chain, and beside the links and joints.
    fn ignored(&self, told: &Extracted) -> Vec<String> {
        let links = told.links.iter().map(|&link| &self.links[link].unknown);
        let joints = told.joints.iter().map(|&joint| &self.joints[joint].unknown);
        let kinds: BTreeSet<usize> = links.chain(joints).chain([&self.beside]).flatten().copied().collect();
        if kinds.is_empty() {
            return Vec::new();
        }
        let kinds = some(kinds.into_iter().map(|kind| self.unknown[kind].clone()));
        vec![format!("the import ignores these parts, which it does not know: {kinds}")]
    }

    /// Origins that were probably meant in other units.
    fn suspicious_numbers(&self) -> Vec<String> {
        let joints = self.joints.iter().map(|joint| ("joint", &joint.name, joint.xyz, joint.rpy));
        let links = self.links.iter().map(|link| ("the inertia of", &link.name, link.xyz, link.rpy));
        let mut remarks = Vec::new();
        for (what, name, xyz, rpy) in joints.chain(links) {
            let name = printable(name);
            if let Some(angle) = rpy.into_iter().find(|angle| angle.abs() > 2.0 * std::f64::consts::PI + 1e-6) {
                let radians = angle.to_radians();
                remarks.push(format!(
                    "{what} {name} has the angle {angle} rad in its rpy, more than a turn: {angle}° is {radians:.4} rad"
                ));
            }
            if let Some(length) = xyz.into_iter().find(|length| length.abs() > FAR) {
                remarks.push(format!("{what} {name} has an origin that is {length} m away: lengths are in metres"));
            }
        }
        remarks
    }

    /// Links with inertias that no body has, with the place of each. The robot file may hide them: it has one body of
    /// links that are fixed to each other.
    fn impossible_parts(&self, told: &Extracted) -> Vec<String> {
        let links = told.lumped.iter().flatten().chain([&told.base]);
        let links = links.filter_map(|name| self.links.iter().find(|link| link.name == *name));
        let remark = |link: &crate::urdf::Link, [a, b, c]: [f64; 3]| {
            let report = self.source.error(&link.span_of_inertia, "", None);
            let place = report.diagnostics.first().map(|found| format!("line {}, column {}", found.line, found.column));
            format!(
                "no body can have the inertia of {} ({}): its largest principal moment is {c:.3e} kg m², the sum of \
                 the two others is {:.3e} kg m²; is one number wrong by a power of ten?",
                quoted(&link.name),
                place.unwrap_or_default(),
                a + b
            )
        };
        links.filter_map(|link| Some(remark(link, link.inertia.impossible_moments()?))).collect()
    }
}

/// Says which frame of the robot file is the base link, `link`, where it is not frame 0 by name and place. `start` is
/// frame 0 in the axes of this link; `frames` has the links and their names as frames.
fn base_remark(link: &str, frames: &[(String, String)], start: Transform) -> Option<String> {
    let (_, name) = frames.iter().find(|(known, _)| known == link)?;
    let is_frame_0 = start == Transform::IDENTITY;
    if is_frame_0 && name == link {
        return None;
    }
    let place = if is_frame_0 {
        "which is at the same place".to_owned()
    } else {
        let [x, y, z] = start.xyz.map(|x| format!("{x:.6}").trim_end_matches('0').trim_end_matches('.').to_owned());
        let turned = if start.rpy == Transform::IDENTITY.rpy { "" } else { " and is turned against it" };
        format!("which is at [{x}, {y}, {z}] m in the axes of this link{turned}")
    };
    Some(format!(
        "the base link {} of the file is the frame {}; `base` in a robot file is frame 0 of the table, {place}",
        quoted(link),
        quoted(name)
    ))
}

/// A remark on the rotors, which belong to the arm only on request.
fn rotors(robot: &Robot) -> Option<Remark> {
    let has_rotor = |joint: &&Joint| joint.motor.is_some_and(|motor| motor.inertia != 0.0);
    let joints: Vec<&str> = robot.joints.iter().filter(has_rotor).map(|joint| joint.name.as_str()).collect();
    let (count, s) = (joints.len(), if joints.len() == 1 { " has" } else { "s have" });
    let text = || format!("{count} joint{s} the inertia of a rotor (`armature` of MJCF): {}", names(&joints));
    (count > 0).then(|| Remark::from(text()).remedy(Remedy::Rotors))
}

/// Remarks on a table.
pub(crate) fn remarks(robot: &Robot, table: &Table) -> Vec<String> {
    let mut remarks = Vec::new();
    for ([first, second], tilt) in &table.levelled {
        let pair = if *first > robot.dof() {
            format!("z of the base and the axis of joint {second}")
        } else {
            format!("the axes of joints {first} and {second}")
        };
        remarks.push(format!(
            "{pair} are {tilt:.1e} rad off parallel, and rne takes them as parallel: their common normal is too far \
             away for a table"
        ));
    }
    for (index, row) in robot.rows().enumerate() {
        if row.dh.d.abs() > FAR || row.dh.a.abs() > FAR {
            let (row, d, a, tilt) = (index + 1, row.dh.d, row.dh.a, row.dh.alpha.sin.abs());
            let is_nearly_parallel = tilt != 0.0 && tilt < NEARLY_PARALLEL;
            let why = if is_nearly_parallel {
                ", because two axes are nearly parallel; so large numbers lose digits"
            } else {
                ""
            };
            remarks.push(format!("row {row} has d = {d:.0} m and a = {a:.0} m{why}"));
        }
    }
    for (row, joint) in robot.joints.iter().enumerate() {
        let distance = joint.row.link.com.iter().map(|x| x * x).sum::<f64>().sqrt();
        if distance > FAR {
            remarks.push(format!(
                "the centre of mass of link {} is {distance:.0} m from the origin of its link frame: single precision \
                 loses digits there, most of all in code of the form `seven_steps`; a joint with the key `at` (format \
                 2) needs no such frame",
                row + 1
            ));
        }
    }
    let has_mass = |joint: &Joint| {
        let link = joint.row.link;
        link.mass != 0.0 || link.inertia != Inertia::default() || link.has_first_moment()
    };
    if !robot.joints.iter().any(has_mass) {
        remarks.push("no link has mass: the file has no inertial data".to_owned());
    }
    remarks
}
