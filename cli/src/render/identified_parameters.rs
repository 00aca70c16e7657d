//! Writes identified parameters and friction as tables.

use std::fmt::Write as _;

use rne_identify::{Identification, Parameter};
use rne_model::{FrictionTransition, JointKind, one_line};

use crate::palette::QUIET;
use crate::render::layout::{Align, push_table, shortened};
use crate::values::numbers::rounded;

/// Writes parameters and friction as tables.
pub(crate) fn tables(found: &Identification) -> String {
    let of_links = found.structure.parameters().bases.iter().filter(|base| matches!(base.kept, Parameter::Link(..)));
    let of_links = of_links.count();
    let excited = found.bases.iter().filter(|base| base.is_excited()).count();
    let mut text = String::new();
    let rotors = match found.bases.len() - of_links {
        0 => String::new(),
        count => format!(" and {count} of rotors"),
    };
    let _ = writeln!(
        text,
        "\n{of_links} base parameters of the links{rotors}, {excited} of them excited; condition number {}",
        rounded(found.least_squares.condition, 0)
    );
    let certificate = &found.feasible.certificate;
    let _ = writeln!(
        text,
        "{QUIET}{} rows per joint over {:.1} s, {} segments; every link is a physical body, margin {:.1e}{QUIET:#}",
        found.rows, found.duration, found.least_squares.segments, certificate.margin
    );
    if let Some((delay, deviation)) = found.delay {
        let _ = writeln!(
            text,
            "{QUIET}torques lag {:.1} ± {:.1} ms behind the positions{QUIET:#}",
            1e3 * delay,
            1e3 * deviation
        );
    }
    let mut cells = vec![["  parameter", "value", "", "deviation", "", "written", "unit"].map(str::to_owned)];
    for (base, report) in found.structure.parameters().bases.iter().zip(&found.bases) {
        let unit = found.structure.unit(base.kept).to_owned();
        let (value, deviation, percent) = if report.is_excited() {
            let percent = 100.0 * report.deviation / report.value.abs();
            let percent = if percent < 1000.0 { format!("{percent:.1} %") } else { "> 999 %".to_owned() };
            (rounded(report.value, 4), rounded(report.deviation, 4), percent)
        } else {
            ("not excited".to_owned(), rounded(report.deviation, 4), String::new())
        };
        let name = format!("  {}", report.name);
        cells.push([name, value, "±".to_owned(), deviation, percent, rounded(report.written, 4), unit]);
    }
    let align = [Align::Left, Align::Right, Align::Left, Align::Right, Align::Right, Align::Right, Align::Left];
    push_table(
        &mut text,
        "base parameters: by least squares, ± one standard deviation, and as written to the robot file",
        &align,
        &cells,
    );
    friction(&mut text, found);
    inertia_of_rotors(&mut text, found);
    text
}

fn friction(text: &mut String, found: &Identification) {
    let heading = ["  joint", "viscous", "Coulomb +", "Coulomb -", "transition"].map(str::to_owned);
    let mut cells = vec![heading];
    for (joint, report) in found.robot.independent_joints().zip(&found.joints) {
        let Some(friction) = report.friction else { return };
        let with = |(value, deviation): (f64, f64)| {
            if report.is_friction_excited() {
                format!("{} ± {}", rounded(value, 3), rounded(deviation, 3))
            } else {
                "not excited".to_owned()
            }
        };
        cells.push([
            format!("  {}", shortened(&one_line(&joint.name), 14)),
            with(friction[0]),
            with(friction[1]),
            with(friction[2]),
            report
                .transition
                .filter(|_| report.is_friction_excited())
                .map_or_else(String::new, |transition| turns(transition, joint.row.kind)),
        ]);
    }
    let align = [Align::Left, Align::Right, Align::Right, Align::Right, Align::Right];
    let kinds: Vec<JointKind> = found.robot.independent_joints().map(|joint| joint.row.kind).collect();
    let units = match (kinds.contains(&JointKind::Revolute), kinds.contains(&JointKind::Prismatic)) {
        (_, false) => "N m s/rad, N m",
        (false, true) => "N s/m, N",
        (true, true) => "N m s/rad, N m or N s/m, N",
    };
    let title = format!("friction at the joint, {units}; transition: speed or displacement");
    push_table(text, &title, &align, &cells);
}

/// Describes the speed or the displacement over which friction changes its sign.
fn turns(transition: FrictionTransition, kind: JointKind) -> String {
    let unit = kind.position_unit();
    match transition {
        FrictionTransition::Speed(speed) => format!("{speed} {unit}/s"),
        FrictionTransition::Displacement(length) => format!("{length} {unit}"),
    }
}

/// Writes the inertia of rotors, if the command line asked for it.
fn inertia_of_rotors(text: &mut String, found: &Identification) {
    let mut cells = vec![["  joint", "rotor", "", ""].map(str::to_owned)];
    let bases = || found.structure.parameters().bases.iter().zip(&found.bases);
    for (at, (joint, report)) in found.robot.independent_joints().zip(&found.joints).enumerate() {
        let Some(rotor) = report.rotor else { return };
        let [unit, link] = match joint.row.kind {
            JointKind::Revolute => ["kg m²", "inertia"],
            JointKind::Prismatic => ["kg", "mass"],
        };
        let known = bases().find(|(base, _)| base.kept == Parameter::Rotor(at)).map(|(_, of)| of);
        let said = match known {
            None => format!("not separable from the {link} of links"),
            Some(base) if base.is_excited() => String::new(),
            Some(_) => "not excited".to_owned(),
        };
        cells.push([format!("  {}", shortened(&one_line(&joint.name), 14)), rounded(rotor, 4), unit.to_owned(), said]);
    }
    push_table(
        text,
        "inertia of the rotors at the joint",
        &[Align::Left, Align::Right, Align::Left, Align::Left],
        &cells,
    );
}
