//! The cell that a notebook shows for an arm.

use std::fmt::Write as _;

use pyo3::PyResult;
use rne::compiled::{Form, Function};
use rne_codegen::Program;
use rne_emit::{Heading, Selection};
use rne_model::{JointKind, Robot};

/// The functions whose counts of operations a notebook shows.
const COUNTED: [Function; 6] = [
    Function::InverseDynamics,
    Function::GravityTorques,
    Function::MassMatrix,
    Function::ForwardDynamics,
    Function::Jacobian,
    Function::InverseDynamicsDerivatives,
];

/// Returns HTML with the table, the counts of some functions, and the annotated torques of the seven steps, joint by
/// joint. It has some tens of kilobytes and no script, so it can be kept in the notebook and shown where notebooks are
/// not trusted.
pub(crate) fn cell(robot: &Robot, rows: &str, program: impl Fn(&str, &str) -> PyResult<Program>) -> PyResult<String> {
    let mut html = table(robot, rows);
    html += &counts(&program);
    let torques = program(Function::InverseDynamics.name(), Form::SevenSteps.name())?;
    for (index, joint) in robot.joints.iter().enumerate() {
        let what = Selection { joint: Some(index + 1), explain: true, ..Selection::default() };
        let listing = rne_emit::listing(robot, &torques, what).to_string();
        // the listing begins with the table and the counts, which are shown above already
        let code = listing.find("    //").map_or("", |start| &listing[start..]);
        let code: Vec<&str> = code.lines().map(|line| line.strip_prefix("    ").unwrap_or(line)).collect();
        let _ = write!(
            html,
            "<details><summary>the seven steps of joint {}, {}</summary><pre style=\"line-height:1.3\">{}</pre>\
             </details>",
            index + 1,
            escape(&joint.name),
            escape(code.join("\n").trim_end())
        );
    }
    html += "<p><code>arm.report()</code> is a page of HTML in which the arm moves and every equation has its numbers.";
    Ok(html)
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

/// Returns the table of the robot as HTML.
fn table(robot: &Robot, rows: &str) -> String {
    let title = escape(robot.title.as_deref().unwrap_or(&robot.name));
    let (on, places) = if robot.is_serial() {
        ("", String::new())
    } else {
        // for a tree, the link on which each row begins, and where the tip is
        ("<th>on", format!("<p>{}</p>", escape(&Heading::of(robot).frames).replace('\n', "<br>")))
    };
    let mut html = format!(
        "<p><b>{title}</b>: {} joints, {rows} table</p>{places}<table><tr><th>joint{on}<th>type<th>θ (rad)\
         <th>d (m)<th>a (m)<th>α (rad)<th>mass (kg)</tr>",
        robot.dof()
    );
    for (index, joint) in robot.joints.iter().enumerate() {
        let (kind, dh) = (joint.row.kind, &joint.row.dh);
        let variable = |is_variable: bool, constant: f64| match (is_variable, constant) {
            (true, 0.0) => format!("q{}", index + 1),
            (true, constant) => {
                let sign = if constant < 0.0 { '−' } else { '+' };
                format!("q{} {sign} {:.6}", index + 1, constant.abs())
            }
            (false, constant) => format!("{constant:.6}"),
        };
        let word = match kind {
            JointKind::Revolute => "revolute",
            JointKind::Prismatic => "prismatic",
        };
        let on = match robot.parent(index) {
            _ if robot.is_serial() => String::new(),
            Some(parent) => format!("<td>{}", escape(&robot.joints[parent].name)),
            None => "<td>base".to_owned(),
        };
        let _ = write!(
            html,
            "<tr><td>{}{on}<td>{word}<td>{}<td>{}<td>{:.6}<td>{:.6}<td>{:.6}</tr>",
            escape(&joint.name),
            variable(kind == JointKind::Revolute, dh.theta.radians),
            variable(kind == JointKind::Prismatic, dh.d),
            dh.a,
            dh.alpha.radians,
            joint.row.link.mass
        );
    }
    html + "</table>"
}

/// Returns a table of the numbers of operations of some functions.
fn counts(program: impl Fn(&str, &str) -> PyResult<Program>) -> String {
    let mut html = "<table><tr><th>operations<th>form<th>mul<th>add<th>div<th>sin/cos</tr>".to_owned();
    for function in COUNTED {
        for form in Form::ALL {
            // a function that cannot be compiled, because it divides by zero, has no row
            let Ok(program) = program(function.name(), form.name()) else { continue };
            let counts = program.operations();
            let _ = write!(
                html,
                "<tr><td>{function}<td>{form}<td>{}<td>{}<td>{}<td>{}</tr>",
                counts.mul, counts.add, counts.div, counts.sincos
            );
        }
    }
    html + "</table>"
}
