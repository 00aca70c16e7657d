//! Finds the quantities of the columns of a table in Parquet.

use super::{Clock, ParquetTable, Roles};
use crate::columns::mapping::Mapped;
use crate::columns::table::{self, Columns, note};
use crate::columns::time_column::{TimeColumn, unread, within};
use crate::formats::csv_table::{no_time, two_times};
use crate::formats::parquet::column::{Kind, Leaf};
use crate::formats::parquet::list_columns::{self, ListColumns};
use crate::remedy::Setting;
use crate::{LogError, Options, Target, TimeUnit};

impl ParquetTable {
    /// Finds the quantities of the columns: columns of lists if there is one of positions, single columns otherwise.
    pub(super) fn assign(&mut self, leaves: &[Leaf], options: &Options) -> Result<(), LogError> {
        let is_list = |leaf: &Leaf| leaf.is_list && leaf.kind.is_number() && within(&leaf.name, options).is_some();
        let lists = leaves.iter().enumerate().filter(|(_, leaf)| is_list(leaf));
        let lists = ListColumns::of(&self.path, lists.map(|(place, leaf)| (place, leaf.name.as_str())), options)?;
        let is_mapped_by_time_alone = options.map.iter().all(|mapping| mapping.target == Target::Time);
        match lists.position.filter(|_| is_mapped_by_time_alone) {
            Some(position) => self.assign_lists(leaves, lists, position, options),
            None => self.assign_scalars(leaves, options),
        }
    }

    /// Chooses columns of lists; the index and factor of the column of positions are given.
    fn assign_lists(
        &mut self,
        leaves: &[Leaf],
        lists: ListColumns,
        (position, factor): (usize, f64),
        options: &Options,
    ) -> Result<(), LogError> {
        let texts = leaves.iter().enumerate().filter(|(_, leaf)| leaf.is_list && leaf.kind == Kind::Text);
        let texts = texts.map(|(place, leaf)| (place, leaf.name.as_str()));
        let names = list_columns::names(&self.path, texts, &leaves[position].name, options)?;
        self.roles = Roles::Lists {
            names: names.map(|leaf| self.column(leaves, leaf, 1.0)),
            position: self.column(leaves, position, factor),
            velocity: lists.velocity.map(|(leaf, factor)| self.column(leaves, leaf, factor)),
            effort: lists.effort.map(|(leaf, factor)| self.column(leaves, leaf, factor)),
        };
        self.units.others = lists.units;
        let mut times = Vec::new();
        let (scalars, header) = scalars(leaves);
        for place in &scalars {
            times.extend(TimeColumn::of(&self.path, *place, &leaves[*place].name, options)?);
        }
        for mapping in &options.map {
            let found = mapping.find(&header).map_err(|what| LogError::request(&self.path, what))?;
            if let (place, Mapped::Time(unit)) = found {
                times = vec![TimeColumn::mapped(scalars[place], unit)];
            }
        }
        let name = |place: usize| leaves[place].name.as_str();
        let time = TimeColumn::choose(&self.path, &times, name, options)?;
        let mut converted = lists.converted;
        let is_other = |time: &TimeColumn| time.unit.is_some_and(|unit| unit != TimeUnit::Seconds);
        if let Some(time) = time.filter(|time| is_other(time) && leaves[time.place].kind.is_number()) {
            converted.insert(0, leaves[time.place].name.clone());
        }
        self.notes.extend(table::converted(&converted));
        note("other times that are not read", &unread(&times, time, name), &mut self.notes);
        self.tell_time(leaves, time.map(|time| (time.place, time.unit)), options)
    }

    /// Chooses columns with a single number in each row.
    fn assign_scalars(&mut self, leaves: &[Leaf], options: &Options) -> Result<(), LogError> {
        let (scalars, header) = scalars(leaves);
        let mut columns = Columns::of(&self.path, &header, options)?;
        let mut column = |column: table::Column| -> Result<usize, LogError> {
            let leaf = &leaves[scalars[column.place]];
            if leaf.kind.is_number() {
                return Ok(self.column(leaves, scalars[column.place], column.factor));
            }
            let what = format!("the column {} has {}, not numbers", leaf.name, leaf.words);
            Err(LogError::file(&self.path, what))
        };
        let position = columns.position.iter().map(|place| column(*place)).collect::<Result<_, _>>()?;
        let mut optional = |found: &[Option<table::Column>]| -> Result<Vec<Option<usize>>, LogError> {
            found.iter().map(|found| found.map(&mut column).transpose()).collect()
        };
        let others = [optional(&columns.velocity)?, optional(&columns.effort)?, optional(&columns.acceleration)?];
        self.roles = Roles::Scalars { position, others };
        if let Some((place, _)) = columns.time
            && matches!(leaves[scalars[place]].kind, Kind::Stamp(_))
        {
            // the unit is that of the column's type, not that in its name
            columns.converted.retain(|name| *name != header[place]);
        }
        self.notes = columns.remarks();
        (self.names, self.units, self.unread) = (columns.names, columns.units, columns.unread);
        self.tell_time(leaves, columns.time.map(|(place, unit)| (scalars[place], unit)), options)
    }

    /// Sets the column of times, with the unit in its name. The unit of its type takes precedence.
    fn tell_time(
        &mut self,
        leaves: &[Leaf],
        time: Option<(usize, Option<TimeUnit>)>,
        options: &Options,
    ) -> Result<(), LogError> {
        self.clock = match (time, options.rate) {
            (None, Some(rate)) => Clock::Step(1.0 / rate),
            (None, None) => {
                let error = no_time(&self.path, leaves.iter().map(|leaf| &leaf.name));
                let columns = leaves.iter().map(|leaf| leaf.name.clone()).collect();
                let error = error.give(Setting::TimeColumn(columns));
                return Err(error.give(Setting::Rate));
            }
            (Some((leaf, _)), Some(_)) => return Err(two_times(&self.path, &leaves[leaf].name)),
            (Some((leaf, said)), None) => {
                let unit = match leaves[leaf].kind {
                    Kind::Stamp(unit) => unit,
                    Kind::Real | Kind::Integer { .. } => {
                        let unit = said.or(options.time_unit);
                        self.is_time_unit_known = unit.is_some();
                        unit.unwrap_or_default()
                    }
                    Kind::Text | Kind::Other => {
                        let Leaf { name, words, .. } = &leaves[leaf];
                        let what = format!("the column {name} has {words}, not times");
                        return Err(LogError::file(&self.path, what));
                    }
                };
                Clock::Column(self.column(leaves, leaf, 1.0), unit)
            }
        };
        Ok(())
    }
}

/// Returns the indices and names of the columns without lists.
fn scalars(leaves: &[Leaf]) -> (Vec<usize>, Vec<String>) {
    let scalars = leaves.iter().enumerate().filter(|(_, leaf)| !leaf.is_list);
    scalars.map(|(place, leaf)| (place, leaf.name.clone())).unzip()
}
