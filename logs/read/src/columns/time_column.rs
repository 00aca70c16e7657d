//! Finds the column of times of a table.

use std::path::Path;

use crate::columns::guess::time;
use crate::remedy::Setting;
use crate::{LogError, Options, TimeUnit};

/// A column whose name shows that it has times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TimeColumn {
    pub(crate) place: usize,
    /// The unit in the name.
    pub(crate) unit: Option<TimeUnit>,
    /// Whether the name begins with the prefix of the joints that the options ask for.
    is_of_group: bool,
    /// Whether the options map the column to times.
    pub(crate) is_mapped: bool,
}

/// Returns a name without the prefix that the options ask for; `None` if it begins with something else.
pub(crate) fn within<'a>(name: &'a str, options: &Options) -> Option<&'a str> {
    match &options.topic {
        Some(prefix) => name.trim_start_matches('/').strip_prefix(prefix.trim_matches('/')),
        None => Some(name),
    }
}

impl TimeColumn {
    /// Makes the column that the options map to times.
    pub(crate) fn mapped(place: usize, unit: Option<TimeUnit>) -> Self {
        Self { place, unit, is_of_group: true, is_mapped: true }
    }

    /// Makes the column of times from its name; `None` if the name is not that of times.
    pub(crate) fn of(path: &Path, place: usize, name: &str, options: &Options) -> Result<Option<Self>, LogError> {
        let inner = within(name, options);
        let Some(unit) = time(name).or_else(|| inner.and_then(time)) else { return Ok(None) };
        let unit = unit.map_err(|text| {
            let what = format!("the column {name} has times in {text}, but the known units are s, ms, us, ns");
            LogError::file(path, what)
        })?;
        Ok(Some(Self { place, unit, is_of_group: inner.is_some(), is_mapped: false }))
    }

    /// Chooses the column of times that is read: the first whose name begins with the prefix of the joints, or the only
    /// one.
    pub(crate) fn choose<'a>(
        path: &Path,
        times: &[Self],
        name: impl Fn(usize) -> &'a str,
        options: &Options,
    ) -> Result<Option<Self>, LogError> {
        let mut of_group: Vec<Self> = times.iter().filter(|time| time.is_of_group).copied().collect();
        if of_group.is_empty() {
            if let [first, second, ..] = times {
                let what = format!(
                    "the columns {} and {} both contain times, and neither begins with {} like the columns of the \
                     joints: rename the right one so that it begins like this, or remove the other",
                    name(first.place),
                    name(second.place),
                    options.topic.as_deref().unwrap_or_default()
                );
                return Err(LogError::request(path, what));
            }
            of_group.extend(times);
        }
        let Some((&chosen, others)) = of_group.split_first() else { return Ok(None) };
        let said = name(chosen.place);
        if let (Some(unit), Some(asked)) = (chosen.unit, options.time_unit)
            && unit != asked
        {
            let what = format!("the column {said} has times in {}, but you gave {}", unit.name(), asked.name());
            return Err(LogError::request(path, what).leave_out(Setting::TimeUnit));
        }
        // refuses one time in two columns, such as stamp_sec and stamp_nanosec
        let stem = |name: &'a str| name.rsplit_once('_').map(|(stem, _)| stem);
        let other = others.iter().find(|other| {
            chosen.unit.is_some()
                && other.unit.is_some()
                && other.unit != chosen.unit
                && stem(name(other.place)) == stem(said)
        });
        if let Some(other) = other {
            let what = format!(
                "the columns {said} and {} both contain times: if they are two parts of one time, combine them in one \
                 column, otherwise remove one",
                name(other.place)
            );
            return Err(LogError::file(path, what));
        }
        Ok(Some(chosen))
    }
}

/// Returns the names of the columns of times that are not read.
pub(crate) fn unread<'a>(
    times: &[TimeColumn],
    chosen: Option<TimeColumn>,
    name: impl Fn(usize) -> &'a str,
) -> Vec<&'a str> {
    times.iter().filter(|time| Some(**time) != chosen).map(|time| name(time.place)).collect()
}
