//! `rne import`: makes a robot file from an arm in a URDF or an MJCF file, and prints what was done.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use rne_convert::{Account, Description, Difference, Imported, Options, Selection, Urdf};
use rne_model::Convention;

use crate::files::file_name::Format;
use crate::files::input_file;
use crate::files::output_file::Output;
use crate::files::robot_file::{gravity, not_opened, notes};
use crate::outcome::{Failure, Outcome};
use crate::palette::{QUIET, TITLE, TYPED};
use crate::render::heading::rounding;
use crate::values::choice::{convention, robot_name};
use crate::values::numbers::not_a_number;

/// Convert a URDF, or an MJCF file of MuJoCo, to a robot file
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne export puma560 --urdf -o puma.urdf         a URDF to try it on
  rne import puma.urdf --convention modified     to the terminal
  rne import quadruped.urdf --whole -o quadruped.yaml
  rne import scene.xml --tip hand -o arm.yaml    MJCF: bodies are the links

For an arm with several ends: --base torso_lift_link --tip arm_tool_link. For a
URDF with joints outside the arm: --lock torso_lift_joint=0.1 --lock-others.

rne joins links that are fixed to each other. rne replaces an angle within 2e-4
rad of a multiple of pi/12 by this multiple, and reports the resulting change.
Without -o the robot file goes to standard output, the report to standard error.")]
#[allow(clippy::struct_excessive_bools)] // each is a flag of its own
pub(crate) struct Arguments {
    /// URDF file, or MJCF file, whose root element is mujoco; - is standard input
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Link at the base of the arm [default: the root link, or the link that floats]
    #[arg(long, value_name = "LINK")]
    base: Option<String>,
    /// Last link of the arm [default: the last link, if only one is an end]; with --whole, several give `tips`
    #[arg(long, value_name = "LINK")]
    tip: Vec<String>,
    /// Convert the whole robot after the base, a tree, and not one arm; --tip then says where the tip is
    #[arg(long)]
    whole: bool,
    /// With --whole: the root link becomes the floating base [default: as in the file]
    #[arg(long, requires = "whole")]
    floating: bool,
    /// With --whole: fix a base that floats in the file
    #[arg(long, requires = "whole", conflicts_with = "floating")]
    fixed: bool,
    /// Convention of the new table: standard or modified [default: standard; modified for a tree]
    #[arg(long, value_name = "C", value_parser = convention(), hide_possible_values = true)]
    convention: Option<Convention>,
    /// Lock a movable joint at this position, rad or m, such as finger=0.04; may be repeated; 0 holds a floating base
    #[arg(long, value_name = "JOINT=VALUE", value_parser = lock)]
    lock: Vec<(String, f64)>,
    /// Lock all movable joints outside the arm at zero, except joints of --lock
    #[arg(long)]
    lock_others: bool,
    /// Keep angles that are nearly exact: 1.5708 stays 1.5708 and does not become pi/2
    #[arg(long)]
    no_snap: bool,
    /// Keep the links, and links fixed to them, as named frames: the list `frames` of the robot file
    #[arg(long)]
    frames: bool,
    /// YAML file with closed loops of a URDF [default: NAME.yaml beside NAME.urdf]
    #[arg(long, value_name = "YAML")]
    loops: Option<PathBuf>,
    /// Accept inertias that no physical body can have
    #[arg(long)]
    keep_unphysical: bool,
    /// Name of the robot [default: the name in the file]
    #[arg(long, value_parser = robot_name)]
    name: Option<String>,
    #[command(flatten)]
    output: Output,
}

/// Reads an argument of the form `JOINT=VALUE`.
fn lock(text: &str) -> Result<(String, f64), String> {
    let (joint, value) = text.rsplit_once('=').ok_or("write JOINT=VALUE, such as finger=0.04")?;
    let value = rne_model::number(value.trim())
        .map_err(|mistake| format!("{}; write for example {joint}=0.04", not_a_number(value, &mistake.message)))?;
    Ok((joint.to_owned(), value))
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    if arguments.tip.len() > 1 && !arguments.whole {
        return Err(usage_error!(
            "an arm has one tip; {TYPED}--whole{TYPED:#} imports the whole robot, with these links in the list `tips`"
        ));
    }
    let (file, text) = read(&arguments.file)?;
    let urdf = match &arguments.loops {
        None => Urdf::read(&file, &text),
        Some(loops) => {
            let (name, loops) = read(loops)?;
            Urdf::read_with_loops(&file, &text, Some((&name, &loops)))
        }
    };
    let urdf = urdf.map_err(|report| Failure::from(&report))?;
    let selection = Selection {
        base: arguments.base.clone(),
        tip: arguments.tip.first().cloned(),
        lock: arguments.lock.clone(),
        lock_others: arguments.lock_others,
        whole: arguments.whole,
        floating: (arguments.floating || arguments.fixed).then_some(arguments.floating),
    };
    let usual = if arguments.whole { Convention::Modified } else { Convention::Standard };
    urdf.check_names(&selection).map_err(|report| Failure::unknown_name(&report))?;
    let more_tips: Vec<String> = arguments.tip.iter().skip(1).cloned().collect();
    let named = more_tips.iter().map(|tip| Selection { tip: Some(tip.clone()), ..Selection::default() });
    named.into_iter().try_for_each(|tip| urdf.check_names(&tip)).map_err(|report| Failure::unknown_name(&report))?;
    let options = Options {
        selection,
        more_tips,
        convention: arguments.convention.unwrap_or(usual),
        snap: !arguments.no_snap,
        keep_unphysical: arguments.keep_unphysical,
        frames: arguments.frames,
        name: arguments.name.clone(),
        ..Options::default()
    };
    let Imported { robot, text, account, .. } = urdf.import(&options).map_err(|report| Failure::from(&report))?;
    let joints = if robot.dof() == 1 { "1 joint".to_owned() } else { format!("{} joints", robot.dof()) };
    let base = if robot.floating_base.is_some() { "floating" } else { "fixed" };
    let remark = format!(
        "{TITLE}{}{TITLE:#}: {joints}, {base} base\n{}\
         {QUIET}{}; if the base is turned, edit `gravity`{QUIET:#}\n",
        robot.name,
        told(&account, arguments),
        gravity(&robot)
    );
    arguments.output.deliver(Format::RobotFile, text, remark, &arguments.file)
}

/// Reads a file; returns its text and its name in messages. A robot file is refused later, when its text is read as
/// XML.
fn read(path: &Path) -> Result<(String, String), Failure> {
    let description = Description::open_by(path, input_file::open).map_err(|error| not_opened(&error))?;
    let (Description::RobotFile(bytes) | Description::Urdf(bytes)) = description else {
        return Err(usage_error!("{} is a shipped robot, no URDF", path.display()));
    };
    let text = String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        input_error!("{}: byte {at} is not UTF-8; save the file as UTF-8", path.display())
    })?;
    Ok((input_file::name(path), text))
}

/// Largest number of lines of a list that are shown.
const SHOWN: usize = 40;

/// Lists the links that are frames of the robot file, or would be with `--frames`.
fn frames(account: &Account, keeps_frames: bool) -> String {
    let names: Vec<&str> = account.frames.iter().take(SHOWN).map(|(_, name)| name.as_str()).collect();
    let more = account.frames.len().saturating_sub(SHOWN);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let names = names.join(", ") + &more;
    if !keeps_frames {
        return format!("  not kept as frames, {TYPED}--frames{TYPED:#} keeps them: {names}\n");
    }
    let mut text = format!("  frames: {names}\n");
    for (link, name) in account.frames.iter().filter(|(link, name)| link != name).take(SHOWN) {
        let _ = writeln!(text, "  the link {} is the frame {name}", rne_model::one_line(link));
    }
    text
}

/// Returns the option that changes whether the link that floats in the file becomes a floating base.
fn other_base(account: &Account, arguments: &Arguments) -> Option<String> {
    let option = match (account.floats?, arguments) {
        (true, _) => return Some(format!("{TYPED}--fixed{TYPED:#} fixes the base where the file has it")),
        (false, Arguments { whole: false, .. }) => {
            return Some(format!("with {TYPED}--whole{TYPED:#}, it is the floating base of the whole robot"));
        }
        (false, Arguments { fixed: true, .. }) => "--fixed",
        (false, Arguments { base: Some(_), .. }) => "--base",
        _ => "--lock",
    };
    Some(format!("without {TYPED}{option}{TYPED:#}, it is the floating base"))
}

/// Describes an import line by line.
fn told(account: &Account, arguments: &Arguments) -> String {
    let mut text = String::new();
    let _ = writeln!(text, "from {} to {}", account.base, account.tip);
    for (joint, links) in &account.lumped {
        let _ = writeln!(text, "  {joint} moves {} as one body", links.join(", "));
    }
    for (joint, value) in account.held.iter().take(SHOWN) {
        let _ = writeln!(text, "  {joint} is locked at {value}");
    }
    if account.held.len() > SHOWN {
        let _ = writeln!(text, "  and {} more", account.held.len() - SHOWN);
    }
    if !account.aside.is_empty() {
        let _ = writeln!(text, "  on the base, left out: {}", account.aside.join(", "));
    }
    text += &frames(account, arguments.frames);
    if let Some(change) = &account.change {
        let _ = writeln!(text, "{TITLE}snapped{TITLE:#} to multiples of pi/12, {TYPED}--no-snap{TYPED:#} keeps them:");
        for snapped in account.snapped.iter().take(SHOWN) {
            let _ = writeln!(
                text,
                "  {}: {} is {} {QUIET}(by {:.1e} rad){QUIET:#}",
                snapped.place, snapped.from, snapped.to, snapped.by
            );
        }
        if account.snapped.len() > SHOWN {
            let _ = writeln!(text, "  and {} more", account.snapped.len() - SHOWN);
        }
        text += &changed(change);
    }
    text += &notes(&account.remarks);
    text.extend(other_base(account, arguments).map(|option| format!("{TITLE}note{TITLE:#}: {option}\n")));
    let _ = writeln!(text, "{QUIET}{}{QUIET:#}", rounding(&account.rounding));
    let lints = account.lints.warnings().count();
    if lints > 0 {
        let lints = if lints == 1 { "1 warning".to_owned() } else { format!("{lints} warnings") };
        let _ = writeln!(text, "{lints} in the robot file; {TYPED}rne check{TYPED:#} shows where");
    }
    text
}

/// Describes the change that snapping makes.
fn changed(change: &Difference) -> String {
    let accelerations = change.acceleration.map_or_else(
        || "the mass matrix is singular".to_owned(),
        |acceleration| format!("accelerations by {acceleration:.1e}"),
    );
    format!(
        "  over 1,000 states this moves the tip by {:.1e} m and {:.1e} rad, torques by {:.1e} N m or {:.1e} of the \
         largest, {accelerations}\n",
        change.position, change.rotation, change.absolute_torque, change.torque
    )
}
