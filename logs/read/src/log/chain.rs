//! Reads the files of a log one after another.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};

use crate::columns::label::Label;
use crate::columns::unit::{FileUnits, JointUnits};
use crate::formats::format::Format;
use crate::formats::sample::{Sample, Source};
use crate::remedy::Setting;
use crate::{LogError, Options};

/// The files of a log, which are read one after another.
pub(crate) struct Chain<'a> {
    path: &'a Path,
    others: VecDeque<&'a PathBuf>,
    count: usize,
    options: &'a Options,
    pub(crate) source: Box<dyn Source>,
    pub(crate) format: Format,
    /// Units of the first file.
    pub(crate) units: FileUnits,
    /// The columns that name arms, with the name of the arm in the first row.
    arms: Vec<(String, String)>,
}

impl<'a> Chain<'a> {
    pub(crate) fn open(files: &'a [PathBuf], options: &'a Options) -> Result<Self, LogError> {
        let mut others: VecDeque<&PathBuf> = files.iter().collect();
        let Some(first) = others.pop_front() else {
            return Err(LogError::request(Path::new("log"), "no file is named"));
        };
        let format = Format::of(first)?;
        let source = format.open(first, options)?;
        let units = source.units();
        Ok(Self { path: first, others, count: files.len(), options, units, source, format, arms: Vec::new() })
    }

    pub(crate) fn read(&mut self, sample: &mut Sample) -> Result<bool, LogError> {
        while !self.source.read(sample)? {
            let Some(next) = self.others.pop_front() else { return Ok(false) };
            self.path = next;
            self.source = Format::of(next)?.open(next, self.options)?;
            let units = self.source.units();
            let differ = |(joint, units): &(&String, &JointUnits)| self.units.of(joint) != **units;
            if let Some(joint) = units.joints.iter().filter(differ).map(|(joint, _)| joint).min() {
                let what =
                    format!("the names of its columns give other units for {joint} than the names in the first file");
                return Err(LogError::file(next, what));
            }
        }
        self.check_arm()?;
        Ok(true)
    }

    /// Refuses rows of a second arm, because a log belongs to one arm.
    fn check_arm(&mut self) -> Result<(), LogError> {
        // a row without a text does not name its arm
        let names_one = |label: &&Label| !label.is_selecting() && !label.value.is_empty();
        for label in self.source.labels().iter().filter(names_one) {
            match self.arms.iter().find(|(column, _)| *column == label.name) {
                None => self.arms.push((label.name.clone(), label.value.clone())),
                Some((_, first)) if *first == label.value => {}
                Some((column, first)) => {
                    let what = format!(
                        "the column {column} names two arms, {first} and {}, but a log must be of one arm",
                        label.value
                    );
                    let (column, value) = (column.clone(), first.clone());
                    return Err(LogError::request(self.path, what).give(Setting::Select { column, value }));
                }
            }
        }
        Ok(())
    }

    #[expect(clippy::cast_precision_loss, reason = "files are few")]
    pub(crate) fn progress(&self) -> f64 {
        let done = self.count - self.others.len() - 1;
        (done as f64 + self.source.progress()) / self.count as f64
    }
}
