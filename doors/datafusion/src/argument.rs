//! The arguments of a function, read from the columns of a batch: one list column per argument, or one column per
//! number.

use datafusion::arrow::array::{Array, ArrayRef, AsArray, Float64Array, OffsetSizeTrait};
use datafusion::arrow::buffer::NullBuffer;
use datafusion::arrow::datatypes::{DataType, Field, FieldRef, Float64Type};
use datafusion::common::{Result, exec_err, plan_err};
use rne::compiled;
use rne::model::Robot;

/// The values of one argument of a function for all states of a batch.
#[derive(Debug)]
pub(crate) enum Argument<'a> {
    /// All numbers of a state next to each other, borrowed from a list column that has no gaps.
    Rows(&'a [f64]),
    /// All numbers of a state next to each other, copied because the list column has gaps.
    Gathered(Vec<f64>),
    /// One column per number of the argument.
    Columns(Vec<&'a [f64]>),
}

impl Argument<'_> {
    /// The argument as the compiled arm reads it.
    pub(crate) fn array(&self) -> compiled::Array<'_, f64> {
        match self {
            Self::Rows(numbers) => compiled::Array::Rows(numbers),
            Self::Gathered(numbers) => compiled::Array::Rows(numbers),
            Self::Columns(columns) => compiled::Array::Columns(columns),
        }
    }

    /// Returns the number that a joint has in a state.
    pub(crate) fn at(&self, state: usize, joint: usize, joints: usize) -> f64 {
        match self {
            Self::Rows(numbers) => numbers[state * joints + joint],
            Self::Gathered(numbers) => numbers[state * joints + joint],
            Self::Columns(columns) => columns[joint][state],
        }
    }
}

/// Returns how many numbers an argument has in one state of a robot, and the reason for it, for error messages.
fn needed(argument: &str, robot: &Robot) -> (usize, String) {
    let sizes = compiled::sizes_of(robot);
    let part = compiled::Argument::part_named(argument);
    let length = part.map_or(sizes.dof, |part| part.elements(sizes));
    let why = match argument {
        "q" | "qd" | "qdd" | "tau" | "multipliers" => format!("{} has {length} joints", robot.name),
        "step" => "`step` is one number".to_owned(),
        "wrenches" => {
            format!("`wrenches` has force and moment of each tip, and {} has {} tips", robot.name, sizes.tips)
        }
        _ if length == 3 => format!("`{argument}` is x, y and z"),
        _ => format!("`{argument}` has {length} numbers"),
    };
    (length, why)
}

/// A column of a call: its name, for messages, and its type.
pub(crate) struct Column<'a> {
    pub(crate) name: &'a str,
    pub(crate) of: &'a DataType,
}

/// The columns of a call after the robot.
pub(crate) fn columns(fields: &[FieldRef]) -> Vec<Column<'_>> {
    fields.iter().skip(1).map(|field| Column { name: field.name(), of: field.data_type() }).collect()
}

/// Returns the type to which a column is converted: `Float64`, or lists of `Float64`. A type without numbers is
/// returned unchanged; [`check`] refuses it later, with the name of the column.
pub(crate) fn coerced(given: &DataType) -> DataType {
    let item = |field: &Field| field.clone().with_data_type(DataType::Float64).into();
    let is_number = |of: &DataType| of.is_numeric() || *of == DataType::Null;
    match given {
        of if is_number(of) => DataType::Float64,
        DataType::List(field) if is_number(field.data_type()) => DataType::List(item(field)),
        DataType::LargeList(field) if is_number(field.data_type()) => DataType::LargeList(item(field)),
        DataType::FixedSizeList(field, length) if is_number(field.data_type()) => {
            DataType::FixedSizeList(item(field), *length)
        }
        other => other.clone(),
    }
}

/// Whether a column has the type `Float64` or is of lists of `Float64`.
fn has_numbers(of: &DataType) -> bool {
    match of {
        DataType::Float64 => true,
        DataType::List(field) | DataType::LargeList(field) | DataType::FixedSizeList(field, _) => {
            *field.data_type() == DataType::Float64
        }
        _ => false,
    }
}

/// Returns how many columns from `first` on make up one argument: one list column, or one column per number. `wrenches`
/// may be missing at the end of a call: then no wrench acts at the tips, and the result is 0.
fn width(function: &str, argument: &str, columns: &[Column<'_>], first: usize, robot: &Robot) -> Result<usize> {
    let (length, why) = needed(argument, robot);
    let Some(Column { name, of }) = columns.get(first) else {
        if argument == "wrenches" {
            return Ok(0);
        }
        return plan_err!("{function}: `{argument}` is missing: a list of {length} numbers, or {length} columns");
    };
    match of {
        DataType::FixedSizeList(_, found) if usize::try_from(*found) != Ok(length) => {
            plan_err!("{function}: column `{name}`, given as `{argument}`, has lists of {found} numbers, and {why}")
        }
        DataType::List(_) | DataType::LargeList(_) | DataType::FixedSizeList(..) => Ok(1),
        _ => {
            let found = columns[first..].iter().take(length).take_while(|column| *column.of == DataType::Float64);
            let found = found.count();
            if found == length {
                Ok(length)
            } else {
                plan_err!("{function}: `{argument}` has {found} columns, and {why}")
            }
        }
    }
}

/// The function and the column that an error message names.
pub(crate) struct Place<'a> {
    pub(crate) function: &'a str,
    pub(crate) column: &'a str,
    /// The reason, for an error message, why a list must have this number of elements.
    pub(crate) why: &'a str,
}

/// Returns the numbers of a list column, and which states have a null.
pub(crate) fn of_list<'a>(
    array: &'a ArrayRef,
    size: usize,
    place: &Place<'_>,
) -> Result<(Argument<'a>, Option<NullBuffer>)> {
    match array.data_type() {
        DataType::FixedSizeList(..) => {
            let list = array.as_fixed_size_list();
            let wanted = (0..list.len()).map(|state| (state * size, size));
            gather(list.values(), list.nulls(), wanted, list.len(), size, place)
        }
        DataType::List(_) => of_offsets::<i32>(array, size, place),
        DataType::LargeList(_) => of_offsets::<i64>(array, size, place),
        other => {
            let Place { function, column, .. } = place;
            exec_err!("{function}: column `{column}` is {other}, but must be lists of Float64")
        }
    }
}

/// Returns the numbers of a column whose lists may differ in length.
fn of_offsets<'a, O: OffsetSizeTrait>(
    array: &'a ArrayRef,
    size: usize,
    place: &Place<'_>,
) -> Result<(Argument<'a>, Option<NullBuffer>)> {
    let list = array.as_list::<O>();
    let at = |state: usize| list.value_offsets()[state].as_usize();
    let wanted = (0..list.len()).map(|state| (at(state), at(state + 1) - at(state)));
    gather(list.values(), list.nulls(), wanted, list.len(), size, place)
}

/// Returns the numbers of list columns of all kinds. `lists` has the start and the length of the list of each state.
fn gather<'a>(
    values: &'a ArrayRef,
    nulls: Option<&NullBuffer>,
    lists: impl Iterator<Item = (usize, usize)> + Clone,
    states: usize,
    size: usize,
    place: &Place<'_>,
) -> Result<(Argument<'a>, Option<NullBuffer>)> {
    let Place { function, column, why } = place;
    let Some(numbers) = values.as_primitive_opt::<Float64Type>() else {
        return exec_err!(
            "{function}: column `{column}` has lists of {}, but must have lists of Float64",
            values.data_type()
        );
    };
    let is_null = |state: usize| nulls.is_some_and(|nulls| nulls.is_null(state));
    let mut whole = true;
    let mut next = lists.clone().next().map_or(0, |(start, _)| start);
    let first = next;
    for (state, (start, length)) in lists.clone().enumerate() {
        if is_null(state) {
            whole &= length == size && start == next;
        } else if length != size {
            return exec_err!(
                "{function}: column `{column}`, row {} of a batch of {states}: {length} numbers, and {why}",
                state + 1
            );
        } else {
            whole &= start == next;
        }
        next = start + length;
    }
    // a null among the numbers of a state makes the whole state null
    let inner = numbers.nulls().filter(|inner| inner.null_count() > 0);
    let of_numbers = inner.map(|inner| {
        let lists = lists.clone().enumerate();
        lists
            .map(|(state, (start, length))| is_null(state) || (start..start + length).all(|at| inner.is_valid(at)))
            .collect()
    });
    let nulls = NullBuffer::union(nulls, of_numbers.as_ref());
    let argument = if whole {
        Argument::Rows(&numbers.values()[first..first + states * size])
    } else {
        let mut gathered = Vec::with_capacity(states * size);
        for (state, (start, _)) in lists.enumerate() {
            if is_null(state) {
                gathered.resize(gathered.len() + size, 0.0);
            } else {
                gathered.extend_from_slice(&numbers.values()[start..start + size]);
            }
        }
        Argument::Gathered(gathered)
    };
    Ok((argument, nulls))
}

/// Returns a column of `Float64`, or an error for a column of another type.
pub(crate) fn of_column<'a>(array: &'a ArrayRef, place: &Place<'_>) -> Result<&'a Float64Array> {
    let Some(numbers) = array.as_primitive_opt::<Float64Type>() else {
        let Place { function, column, .. } = place;
        return exec_err!("{function}: column `{column}` is {}, but must be Float64", array.data_type());
    };
    Ok(numbers)
}

/// Returns the arguments of a function from the columns of a batch, and which states have a null.
///
/// `names` are the names of the arguments, `columns` those of the columns.
pub(crate) fn all<'a>(
    function: &str,
    names: &[&str],
    columns: &[&str],
    arrays: &'a [ArrayRef],
    robot: &Robot,
) -> Result<(Vec<Argument<'a>>, Option<NullBuffer>)> {
    let given = columns.iter().zip(arrays).map(|(&name, array)| Column { name, of: array.data_type() });
    let given: Vec<Column<'_>> = given.collect();
    let (mut first, mut nulls) = (0, None);
    let mut arguments = Vec::with_capacity(names.len());
    for name in names {
        let (length, why) = needed(name, robot);
        let width = width(function, name, &given, first, robot)?;
        if width == 0 {
            arguments.push(Argument::Gathered(vec![0.0; arrays.first().map_or(0, Array::len) * length]));
            continue;
        }
        let (these, called) = (&arrays[first..first + width], &columns[first..first + width]);
        let place = |column| Place { function, column, why: &why };
        let is_list = !matches!(these[0].data_type(), DataType::Float64);
        if is_list {
            let (argument, of_argument) = of_list(&these[0], length, &place(called[0]))?;
            nulls = NullBuffer::union(nulls.as_ref(), of_argument.as_ref());
            arguments.push(argument);
        } else {
            let mut numbers = Vec::with_capacity(length);
            for (array, column) in these.iter().zip(called) {
                let column = of_column(array, &place(column))?;
                nulls = NullBuffer::union(nulls.as_ref(), column.nulls());
                numbers.push(&column.values()[..]);
            }
            arguments.push(Argument::Columns(numbers));
        }
        first += width;
    }
    if first < arrays.len() {
        return plan_err!(
            "{function}: {} columns too many after `{}`: each of {} is a list, or a column per number",
            arrays.len() - first,
            columns[first - 1],
            names.join(", ")
        );
    }
    Ok((arguments, nulls))
}

/// Checks that columns are the arguments of a function, before any batch of numbers exists; [`all`] checks the same for
/// a batch.
pub(crate) fn check(function: &str, names: &[&str], columns: &[Column<'_>], robot: &Robot) -> Result<()> {
    if let Some(Column { name, of }) = columns.iter().find(|column| !has_numbers(column.of)) {
        return plan_err!(
            "{function}: column `{name}` is {of}, but must be lists of numbers; or give one column per number"
        );
    }
    let mut first = 0;
    for name in names {
        first += width(function, name, columns, first, robot)?;
    }
    if first < columns.len() {
        return plan_err!(
            "{function}: {} columns too many: each of {} is a list, or a column per number",
            columns.len() - first,
            names.join(", ")
        );
    }
    Ok(())
}
