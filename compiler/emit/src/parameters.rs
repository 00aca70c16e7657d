//! Parameters of the robot file in emitted code: those that are arguments, and those whose values are constants.

use std::fmt::Write;

use rne_codegen::{Name, Program, Quantity};
use rne_model::{Entry, Formula, Robot};

/// If more numbers of the table depend on a parameter, they are counted instead of named.
const MOST_NAMED: usize = 4;

/// A parameter whose value is given at run time.
pub(super) struct Parameter {
    /// The name of the parameter in the robot file.
    pub(super) name: String,
    /// The value in the robot file.
    pub(super) value: f64,
    /// The name of the parameter as a member of a struct.
    pub(super) member: String,
    /// The unit, if the numbers of the table determine it.
    pub(super) unit: Option<&'static str>,
    /// The numbers of the table that depend on the parameter.
    entries: Vec<String>,
}

impl Parameter {
    /// Returns the parameters of a robot in their order, as members of a struct in a language with these keywords.
    pub(super) fn of(robot: &Robot, keywords: &str) -> Vec<Self> {
        let run_time = &robot.run_time;
        let parameter = |(index, (name, value)): (usize, (&String, f64))| {
            let depends = || run_time.entries.iter().filter(move |(_, formula)| formula.depends_on(index));
            let mut units = depends().filter(|(_, formula)| is_added(formula, index)).map(|(entry, _)| words(*entry).1);
            let first = units.next();
            // if numbers with different units depend on it, its unit is unknown
            let unit = first.filter(|first| units.all(|other| other == *first));
            let entries = depends().map(|(entry, _)| words(*entry).0).collect();
            Self { name: name.clone(), value, member: member(name, &run_time.names, keywords), unit, entries }
        };
        run_time.names.iter().zip(run_time.values(robot)).enumerate().map(parameter).collect()
    }

    /// Returns the documentation of its member: its value in the file, its unit, and what depends on it.
    pub(super) fn about(&self) -> String {
        let mut text = String::new();
        if self.name != self.member {
            let _ = write!(text, "The parameter {}. ", self.name);
        }
        let unit = self.unit.map_or(String::new(), |unit| format!(" {unit}"));
        let _ = write!(text, "In the file {}{unit}; ", self.value);
        let named = if self.entries.len() > MOST_NAMED + 1 { MOST_NAMED } else { self.entries.len() };
        text.push_str(&self.entries[..named].join(", "));
        if named < self.entries.len() {
            let _ = write!(text, " and {} more", self.entries.len() - named);
        }
        let verb = if self.entries.len() == 1 { "depends" } else { "depend" };
        let _ = write!(text, " {verb} on it.");
        text
    }
}

/// Returns lines of a heading: which parameters of the file are given at run time, and which are constants.
pub(super) fn heading(robot: &Robot) -> Vec<String> {
    let run_time = &robot.run_time;
    let is_folded = |(index, (name, _)): &(usize, &(String, f64))| {
        !run_time.names.contains(name) && run_time.parameters.iter().all(|(varying, _)| varying != index)
    };
    let said = |values: Vec<(&String, f64)>| -> String {
        values.into_iter().map(|(name, value)| format!("{name} = {value}")).collect::<Vec<_>>().join(", ")
    };
    let free: Vec<_> = run_time.names.iter().zip(run_time.values(robot)).collect();
    let folded = robot.parameters.iter().enumerate().filter(is_folded);
    let folded: Vec<_> = folded.map(|(_, (name, value))| (name, *value)).collect();
    let mut lines = Vec::new();
    if !free.is_empty() {
        lines.push(format!("parameters at run time, with their values in the file: {}", said(free)));
    }
    if !folded.is_empty() {
        lines.push(format!("parameters folded: {}", said(folded)));
    }
    lines
}

/// Returns the run-time parameters that a program uses, each with its index and its name in the code.
pub(super) fn used(program: &Program) -> impl Iterator<Item = (usize, Name)> {
    let names = (0..program.parameters).map(|index| (index, Name::scalar(Quantity::Parameter, index + 1)));
    names.filter(|(_, name)| program.arguments().any(|used| used == *name))
}

/// Whether a program depends on run-time parameters: then these are its last argument.
pub(super) fn are_used(program: &Program) -> bool {
    used(program).next().is_some()
}

/// Returns a name that is no keyword of the language, and no other parameter's name.
fn member(name: &str, others: &[String], keywords: &str) -> String {
    let mut member = name.to_owned();
    while keywords.split(' ').any(|keyword| keyword == member) || member != name && others.contains(&member) {
        member.push('_');
    }
    member
}

/// Whether a formula is the parameter or a sum that contains it: then the formula and the parameter have the same unit.
fn is_added(formula: &Formula, parameter: usize) -> bool {
    match formula {
        Formula::Parameter(index) => *index == parameter,
        Formula::Negative(x) => is_added(x, parameter),
        Formula::Sum(x, y) | Formula::Difference(x, y) => is_added(x, parameter) || is_added(y, parameter),
        Formula::Number(_) | Formula::Product(..) | Formula::Quotient(..) => false,
    }
}

/// Returns the description of a number of the table, and its unit.
fn words(entry: Entry) -> (String, &'static str) {
    let axis = |axis: usize| ["x", "y", "z"].get(axis).copied().unwrap_or_default();
    match entry {
        Entry::Gravity(of) => (format!("{} of gravity", axis(of)), "m/s²"),
        Entry::BaseXyz(of) => (format!("{} of the base", axis(of)), "m"),
        Entry::ToolXyz(of) => (format!("{} of the tool", axis(of)), "m"),
        Entry::FrameXyz(frame, of) => (format!("{} of frame {}", axis(of), frame + 1), "m"),
        Entry::D(joint) => (format!("d{}", joint + 1), "m"),
        Entry::A(joint) => (format!("a{}", joint + 1), "m"),
        Entry::ThetaSine(joint) => (format!("sin θ{}", joint + 1), "1"),
        Entry::ThetaCosine(joint) => (format!("cos θ{}", joint + 1), "1"),
        Entry::AlphaSine(joint) => (format!("sin α{}", joint + 1), "1"),
        Entry::AlphaCosine(joint) => (format!("cos α{}", joint + 1), "1"),
        Entry::Mass(joint) => (format!("m{}", joint + 1), "kg"),
        Entry::Com(joint, of) => (format!("{} of the centre of mass of link {}", axis(of), joint + 1), "m"),
        Entry::FirstMoment(joint, of) => (format!("{} of the first moment of link {}", axis(of), joint + 1), "kg m"),
        Entry::Inertia(joint, element) => (format!("I{} of link {}", element.key(), joint + 1), "kg m²"),
        Entry::MotorInertia(joint) => (format!("inertia of motor {}", joint + 1), "kg m²"),
        Entry::GearRatio(joint) => {
            (format!("gear ratio of motor {}", joint + 1), "turns of the motor per turn of the joint")
        }
        Entry::Viscous(joint) => (format!("viscous friction of motor {}", joint + 1), "N m s/rad"),
        Entry::CoulombPositive(joint) => (format!("Coulomb friction of motor {}, speed positive", joint + 1), "N m"),
        Entry::CoulombNegative(joint) => (format!("Coulomb friction of motor {}, speed negative", joint + 1), "N m"),
    }
}

/// Keywords of Rust.
pub(super) const OF_RUST: &str = "\
    abstract as async await become box break const continue crate do dyn else enum extern false final fn for gen \
    if impl in let loop macro match mod move mut override priv pub ref return self Self static struct super trait \
    true try type typeof unsafe unsized use virtual where while yield _";

/// Keywords of C and C++, because both read the header; the last two are keywords of a compiler that does not follow
/// the standard.
pub(super) const OF_C: &str = "\
    alignas alignof and and_eq asm auto bitand bitor bool break case catch char char16_t char32_t char8_t class \
    co_await co_return co_yield compl concept const const_cast consteval constexpr constinit continue decltype \
    default delete do double dynamic_cast else enum explicit export extern false float for friend goto if inline \
    int long mutable namespace new noexcept not not_eq nullptr operator or or_eq private protected public register \
    reinterpret_cast requires restrict return short signed sizeof static static_assert static_cast struct switch \
    template this thread_local throw true try typedef typeid typename typeof typeof_unqual union unsigned using \
    virtual void volatile wchar_t while xor xor_eq _Alignas _Alignof _Atomic _Bool _Complex _Generic _Imaginary \
    _Noreturn _Static_assert _Thread_local linux unix";

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "
        format: 1
        name: rod
        source: own numbers
        convention: standard
        gravity: [0, -g, 0]
        parameters: {g: 9.81, int: 2, int_: 0.5, half: 0.25, twice: 2 * half, rest: 0.125, fixed: 3}
        joints:
          - type: revolute
            dh: {theta: 0, d: rest, a: twice, alpha: 0}
            link: {mass: int + int_ * fixed, com: [half - 1, 0, 0], inertia: {zz: int * int_ + half}}
    ";

    fn robot(names: &[&str]) -> Robot {
        let checked = rne_model::Reader::new("rod.yaml").run_time(names).read(TEXT);
        checked.unwrap_or_else(|report| panic!("{report}")).robot
    }

    #[test]
    fn members_are_names_of_the_language() {
        let robot = robot(&["int", "int_", "half"]);
        let members = |keywords| Parameter::of(&robot, keywords).into_iter().map(|one| one.member).collect::<Vec<_>>();
        assert_eq!(members(OF_RUST), ["int", "int_", "half"]);
        assert_eq!(members(OF_C), ["int__", "int_", "half"]);
    }

    #[test]
    fn a_unit_is_said_where_the_table_has_it() {
        let about = |name| {
            Parameter::of(&robot(&["g", "int", "half", "int_"]), OF_C)
                .into_iter()
                .find(|one| one.name == name)
                .map(|one| one.about())
        };
        for (name, expected) in [
            ("g", "In the file 9.81 m/s²; y of gravity depends on it."),
            ("int", "The parameter int. In the file 2 kg; m1, Izz of link 1 depend on it."),
            // a parameter that is a factor, and one for numbers with different units
            ("int_", "In the file 0.5; m1, Izz of link 1 depend on it."),
            ("half", "In the file 0.25; a1, x of the centre of mass of link 1, Izz of link 1 depend on it."),
        ] {
            assert_eq!(about(name).as_deref(), Some(expected));
        }
    }

    #[test]
    fn headings_leave_no_parameter_out() {
        let free = "parameters at run time, with their values in the file: ";
        assert_eq!(
            heading(&robot(&["half", "g"])),
            [
                format!("{free}half = 0.25, g = 9.81"),
                // twice is half times 2, so it also varies
                "parameters folded: int = 2, int_ = 0.5, rest = 0.125, fixed = 3".to_owned()
            ]
        );
        let all = "parameters folded: g = 9.81, int = 2, int_ = 0.5, half = 0.25, twice = 0.5, rest = 0.125, fixed = 3";
        assert_eq!(heading(&robot(&[])), [all]);
        assert_eq!(heading(&Robot { parameters: Vec::new(), ..robot(&[]) }), [""; 0]);
    }
}
