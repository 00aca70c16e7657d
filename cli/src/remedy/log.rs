//! Remedies for errors of logs, as options of the command line.

use rne_logs::{LogError, Mapping, Remedy, Setting, suggested};
use rne_model::one_line;

/// Returns an error of a log with the options that help; `joints` are those of the arm, if they are known.
pub(crate) fn sentence(error: &LogError, joints: &[String]) -> String {
    // names in a log may contain any characters, so they are quoted for a shell
    let remedies = error.remedies().iter().map(|remedy| match remedy {
        Remedy::Give(Setting::Map(columns)) if joints.is_empty() => {
            format!("name the columns: {}", map(&suggested(columns, &["JOINT".to_owned()])))
        }
        Remedy::Give(Setting::Map(columns)) => format!("name the columns: {}", map(&suggested(columns, joints))),
        Remedy::Give(Setting::TimeColumn(columns)) => {
            let column = suggested(columns, &[]).pop().map_or_else(|| "COLUMN".to_owned(), |mapping| mapping.column);
            format!("--time-column {} names the column of times", quoted(column))
        }
        Remedy::Give(setting) => given(setting),
        Remedy::LeaveOut(setting) => format!("remove {}", option(setting)),
        Remedy::BuildWithFormats => {
            "`cargo install --path cli --features full` in a clone of rne builds one that does".to_owned()
        }
    });
    one_line(&[error.to_string()].into_iter().chain(remedies).collect::<Vec<_>>().join("; "))
}

/// Returns the options that map columns, in the form in which they are typed into a shell.
pub(crate) fn map(mappings: &[Mapping]) -> String {
    let options = mappings
        .iter()
        .map(|mapping| format!("--map {}={}", quoted(mapping.target.to_string()), quoted(mapping.column.clone())));
    options.collect::<Vec<_>>().join(" ")
}

/// Quotes a text as one word for a shell.
pub(crate) fn quoted(text: String) -> String {
    let is_word = !text.is_empty() && text.chars().all(|c| c.is_alphanumeric() || "._-/=".contains(c));
    if is_word { text } else { format!("'{}'", text.replace('\'', "'\\''")) }
}

/// Returns the option of a setting with its value.
fn given(setting: &Setting) -> String {
    let about = match setting {
        Setting::Joints(names) if names.is_empty() => "A,B,… lists the joints to read, from base to tip".to_owned(),
        Setting::Joints(names) => format!("{} reads these joints", names.join(",")),
        Setting::Topic => "TOPIC reads one topic".to_owned(),
        Setting::Prefix => "actual reads the columns whose names begin with actual".to_owned(),
        Setting::TorqueConstants => "gives the factors in N m/A from currents to torques".to_owned(),
        Setting::Angles => {
            return "--degrees if they are in degrees, --radians if they are in radians or metres".to_owned();
        }
        Setting::Gap => "STEPS sets the limit of gaps".to_owned(),
        Setting::Cutoff => "HZ sets the cut-off".to_owned(),
        Setting::TimeUnit => "s, ms, us or ns gives the unit of the times".to_owned(),
        Setting::Rate => "HZ gives the sampling rate".to_owned(),
        Setting::Columns => "gives the order, as in --columns time,q,tau".to_owned(),
        Setting::Select { column, value } => {
            let by = quoted(column.clone());
            let one = quoted(format!("{column}={value}"));
            return format!(
                "--where {one} reads only the rows with this text; `rne log` describes each text with --by {by}"
            );
        }
        Setting::Map(_) | Setting::TimeColumn(_) => "names a column".to_owned(),
    };
    format!("{} {about}", option(setting))
}

fn option(setting: &Setting) -> &'static str {
    match setting {
        Setting::Joints(_) => "--joints",
        Setting::Topic | Setting::Prefix => "--topic",
        Setting::TorqueConstants => "--torque-constant",
        Setting::Angles => "--degrees and --radians",
        Setting::Gap => "--gap",
        Setting::Cutoff => "--cutoff",
        Setting::TimeUnit => "--time-unit",
        Setting::Rate => "--rate",
        Setting::Map(_) => "--map",
        Setting::TimeColumn(_) => "--time-column",
        Setting::Select { .. } => "--where",
        Setting::Columns => "--columns",
    }
}
