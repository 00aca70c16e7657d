//! Blocks with tables of the shipped robots: sources, operations, tricks of plans.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use rne_codegen::plan::{PlanSet, Trick};
use rne_codegen::{Compiler, Form, Function, Operations};
use rne_model::{JointKind, Robot};
use rne_search::PlanFile;

use crate::{inverse_dynamics, read, robot, robot_files, root};

/// The rows of the table below a heading, by the names in their first column: name, then column, then cell.
fn table(document: &str, heading: &str) -> Vec<(String, BTreeMap<String, String>)> {
    let cells = |line: &str| -> Vec<String> {
        line.trim_matches('|').split('|').map(|cell| cell.trim().replace("**", "")).collect()
    };
    let (_, below) = document.split_once(&format!("\n{heading}")).unwrap_or_else(|| panic!("{heading}"));
    let mut lines = below.lines().skip_while(|line| !line.starts_with('|')).take_while(|line| line.starts_with('|'));
    let titles = cells(lines.next().expect("a table"));
    let rows = lines.skip(1).map(cells);
    rows.map(|row| (row[0].clone(), titles.iter().cloned().zip(row).skip(1).collect())).collect()
}

/// What a call of two arms costs beside what it costs the best peer, by the tables that `benches/peers/run` and the
/// certificate have written.
pub(crate) fn headline() -> String {
    /// Rows of the table of times that are other functions, or parts of one.
    const OTHER_FUNCTIONS: &[&str] = &["pin_nle", "pin_gravity", "pin_crba", "pin_aba", "pin_rnea_deriv"];
    let peers = read(&root().join("benches/peers/README.md"));
    let (operations, times) = (table(&peers, "### Operations"), table(&peers, "### Independent calls"));
    let number = |cell: &str| -> f64 {
        let first = cell.rsplit("= ").next().and_then(|text| text.split([' ', ',']).next()).unwrap_or_default();
        first.parse().unwrap_or_else(|error| panic!("`{cell}`: {error}"))
    };
    let robots = ["puma560", "panda"];
    let cell = |rows: &[(String, BTreeMap<String, String>)], name: &str, robot: &str| {
        let (_, row) = rows.iter().find(|(other, _)| other == name).unwrap_or_else(|| panic!("no row {name}"));
        number(&row[robot])
    };
    let of = |rows: &[(String, BTreeMap<String, String>)], name: &str| {
        robots.map(|robot| cell(rows, name, robot).to_string()).join(" | ")
    };
    let best = |rows: &[(String, BTreeMap<String, String>)]| {
        let is_peer =
            |name: &str| !name.starts_with("rne") && !name.starts_with("trig_only") && !OTHER_FUNCTIONS.contains(&name);
        robots.map(|robot| {
            let peers = rows.iter().filter(|(name, row)| is_peer(name) && !row[robot].is_empty());
            let (name, row) = peers
                .min_by(|(_, a), (_, b)| number(&a[robot]).total_cmp(&number(&b[robot])))
                .expect("there are peers");
            format!("{} (`{name}`)", number(&row[robot]))
        })
    };
    let certificate = read(&root().join("docs/measured/embedded.md"));
    let (_, m4f) = certificate.split_once("\n## Cortex-M4F\n").expect("the first board");
    let instructions = |form: &str| {
        let find = |robot| {
            let row = m4f.lines().find_map(|line| line.strip_prefix(&format!("| {robot} | {form} | ")));
            row.and_then(|row| row.split(" | ").next()).unwrap_or_else(|| panic!("no row of {robot}, {form}"))
        };
        robots.map(find).join(" | ")
    };
    format!(
        "| one call, form `reduced` | PUMA 560 | Franka Panda |\n|---|---:|---:|\n\
         | operations | {} |\n\
         | operations, best peer | {} |\n\
         | time in ns, native build | {} |\n\
         | time in ns, default build | {} |\n\
         | time in ns, best peer, native build | {} |\n\
         | time in ns, Pinocchio | {} |\n\
         | instructions on a Cortex-M4F, `f32` | {} |\n",
        of(&operations, "rne, reduced"),
        best(&operations).join(" | "),
        of(&times, "rne_reduced_native"),
        of(&times, "rne_reduced_default"),
        best(&times).join(" | "),
        of(&times, "pin_rnea"),
        instructions("reduced"),
    )
}

/// The counts of the reduced form.
fn reduced(robot: &Robot, plans: &PlanSet) -> Operations {
    let program = Compiler::new(robot).with_plans(plans).compile(Function::InverseDynamics, Form::Reduced);
    program.unwrap_or_else(|error| panic!("{}: {error}", robot.name)).operations()
}

/// R or P for each joint, base to tip.
fn kinds(robot: &Robot) -> String {
    let letter = |kind| match kind {
        JointKind::Revolute => 'R',
        JointKind::Prismatic => 'P',
    };
    robot.rows().map(|row| letter(row.kind)).collect()
}

/// Where the numbers of every robot are from: the last sentence of `source`.
pub(crate) fn sources() -> String {
    let mut text = String::from("| file | arm | joints | convention | source quality |\n|---|---|---|---|---|\n");
    for path in robot_files("robots") {
        let robot = robot(&path);
        let quality = source_quality(&robot, &path);
        let (name, title) = (&robot.name, robot.title.as_deref().unwrap_or(&robot.name));
        let _ = writeln!(
            text,
            "| [{name}]({name}.yaml) | {title} | {} | {} | {quality} |",
            kinds(&robot),
            robot.convention.name()
        );
    }
    text
}

/// The quality of the source of a robot file.
fn source_quality(robot: &Robot, path: &Path) -> String {
    let source = robot.source.split_whitespace().collect::<Vec<_>>().join(" ");
    let quality = source.rsplit_once("Source quality: ").map(|(_, quality)| quality.trim_end_matches('.').to_owned());
    quality.unwrap_or_else(|| panic!("{}: `source` ends with `Source quality: …`", path.display()))
}

/// The robots with branches, followers or motors: sources, and the operations of `inverse_dynamics`.
pub(crate) fn trees() -> String {
    let mut text = String::from(
        "| file | robot | joints | source quality | seven steps | planned | reduced |\n\
         |---|---|---|---|---|---|---|\n",
    );
    for path in robot_files("robots/trees") {
        let robot = robot(&path);
        let quality = source_quality(&robot, &path);
        let (plans, is_planned) = plans(&path, &robot);
        assert!(is_planned, "{}: there is no plan file", robot.name);
        let planned = reduced(&robot, &rne_search::without(&robot, &plans, &[Trick::Rewriting]));
        let (name, title) = (&robot.name, robot.title.as_deref().unwrap_or(&robot.name));
        let _ = writeln!(
            text,
            "| [{name}](trees/{name}.yaml) | {title} | {} | {quality} | {} | {} | {} |",
            kinds(&robot),
            inverse_dynamics(&robot).operations().total(),
            planned.total(),
            reduced(&robot, &plans).total(),
        );
    }
    text
}

pub(crate) fn robots() -> String {
    let mut text = String::from(
        "| robot | seven steps: products | sums | both | planned | reduced | angles |\n\
         |---|---|---|---|---|---|---|\n",
    );
    for path in robot_files("robots") {
        let robot = robot(&path);
        let counts = inverse_dynamics(&robot).operations();
        let (plans, _) = plans(&path, &robot);
        let (planned, reduced) =
            (reduced(&robot, &rne_search::without(&robot, &plans, &[Trick::Rewriting])), reduced(&robot, &plans));
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} | {} → {} |",
            robot.name,
            counts.mul,
            counts.add,
            counts.total(),
            planned.total(),
            reduced.total(),
            counts.sincos,
            reduced.sincos
        );
    }
    text
}

/// The choices of the plan file of a robot, or those that a build makes by itself, and whether there is a plan.
pub(crate) fn plans(file: &Path, robot: &Robot) -> (PlanSet, bool) {
    let plan = file.with_extension("plan.yaml");
    if !plan.exists() {
        return (PlanSet::default_of(robot), false);
    }
    let plan = PlanFile::read(&plan.display().to_string(), &read(&plan), robot);
    (PlanSet::from(plan.unwrap_or_else(|report| panic!("{report}"))), true)
}

/// What the tricks save that the plans of two robots make use of.
pub(crate) fn tricks() -> String {
    let robots = ["puma560", "panda"];
    let savings = robots.map(|name| {
        let path = root().join("robots").join(name).with_extension("yaml");
        let robot = robot(&path);
        rne_search::savings(&robot, &plans(&path, &robot).0)
    });
    let mut text = format!("| trick | {} | what it is |\n|---|---:|---:|---|\n", robots.join(" | "));
    for trick in Trick::ALL {
        let saved = |robot: usize| savings[robot].iter().find(|(used, _)| *used == trick).map(|(_, saved)| *saved);
        let cell = |saved: Option<isize>| saved.map_or_else(String::new, |saved| saved.to_string());
        if saved(0).is_some() || saved(1).is_some() {
            let _ = writeln!(text, "| {trick} | {} | {} | {} |", cell(saved(0)), cell(saved(1)), trick.formula());
        }
    }
    text
}
