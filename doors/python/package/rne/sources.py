"""Sources of logs: files, or tables of columns, which are written into files for the reader of logs."""

import contextlib
import csv
import os
import pathlib
import tempfile
from collections.abc import Mapping, Sequence

import numpy as np



def numbers(value):
    """A number or several as a list; None as it is."""
    if value is None:
        return None
    return [float(number) for number in np.atleast_1d(np.asarray(value, dtype=float)).ravel()]


def reading(
    *,
    joints=None,
    topic=None,
    torque_constants=None,
    angles=None,
    cutoff=None,
    gap=3.5,
    derive_velocities=False,
    recorded=False,
    time_unit=None,
    rate=None,
    columns=None,
    map=None,
    where=None,
):
    """The keywords of logs as the reader takes them; `docs/control/python.md` says what each is for."""
    if isinstance(joints, str) or isinstance(columns, str):
        raise TypeError("`joints` and `columns` are lists of names")
    return {
        "joints": None if joints is None else list(joints),
        "topic": topic,
        "torque_constants": numbers(torque_constants) or [],
        "angles": angles,
        "cutoff": cutoff,
        "gap": gap,
        "derive_velocities": derive_velocities,
        "recorded": recorded,
        "time_unit": time_unit,
        "rate": rate,
        "columns": list(columns or []),
        "map": dict(map or {}),
        "where": {str(column): str(text) for column, text in dict(where or {}).items()},
    }


@contextlib.contextmanager
def files(source, options):
    """The paths of a source, and the options of their reader; tables are files as long as the context lasts."""
    sources = list(source) if _is_list(source) else [source]
    if not sources:
        raise ValueError("there is no log: give a path, a table, or a list of them")
    for one in filter(_is_path, sources):
        check(pathlib.Path(one))
    if all(_is_path(one) for one in sources):
        yield [pathlib.Path(one) for one in sources], options
        return
    with tempfile.TemporaryDirectory(prefix="rne-") as folder:
        paths = []
        for number, one in enumerate(sources, 1):
            if _is_path(one):
                paths.append(pathlib.Path(one))
                continue
            path = pathlib.Path(folder) / f"table_{number}.csv"
            if _write(one, path) and options["time_unit"] is None:
                options = {**options, "time_unit": "ns"}
            paths.append(path)
        yield paths, options


def check(path):
    """Raises the OSError of a file that is not there or may not be read."""
    if not path.is_dir():
        path.open("rb").close()


def label(source, number):
    """The name of a log in a trend."""
    return pathlib.Path(source).name if _is_path(source) else f"table {number}"


def _is_path(value):
    return isinstance(value, (str, os.PathLike))


def _is_list(value):
    return isinstance(value, Sequence) and not _is_path(value) and not hasattr(value, "columns")


def has_order(source):
    """Whether the joints of a source are columns of shape (N, n) of tables in memory."""
    tables = source if _is_list(source) else [] if source is None else [source]
    return all(not _is_path(one) and any(np.ndim(column) == 2 for _, column in _columns(one)) for one in tables)


def _columns(table):
    """The names and arrays of a table: of a dict, pandas, Polars or PyArrow."""
    if isinstance(table, Mapping):
        return list(table.items())
    if hasattr(table, "column_names"):  # PyArrow
        return [(name, table.column(name).to_numpy(zero_copy_only=False)) for name in table.column_names]
    if hasattr(table, "collect_schema") and hasattr(table, "collect"):
        raise TypeError("a LazyFrame has no numbers; `collect` makes a DataFrame of it")
    if hasattr(table, "columns") and hasattr(table, "__getitem__"):  # pandas and Polars
        return [(str(name), table[name].to_numpy()) for name in table.columns]
    kind = type(table).__name__
    raise TypeError(f"a log is a path, a dict of columns, or a table of pandas, Polars or PyArrow, not a {kind}")


def _write(table, path):
    """Writes a table as CSV without loss of digits; whether its times are dates, written in ns."""
    names, arrays, has_dates = [], [], False
    for name, value in _columns(table):
        if np.ma.is_masked(value):
            raise ValueError(f"column {name!r} has masked elements, which are not numbers: drop or fill them before")
        array = np.asarray(value)
        if array.dtype.kind == "M":
            array, has_dates = array.astype("datetime64[ns]").astype(np.int64), True
        if array.dtype.kind in "Of":
            array = _floats(name, array)
        if array.ndim == 2:
            # `q` of shape (N, n) is q1, q2, …
            names += [f"{name}{joint + 1}" for joint in range(array.shape[1])]
            arrays += list(array.T)
        elif array.ndim == 1:
            names.append(name)
            arrays.append(array)
        else:
            raise ValueError(f"column {name!r} has {array.ndim} dimensions; it takes one, or (N, n)")
    lengths = {len(array) for array in arrays}
    if len(lengths) != 1:
        raise ValueError(f"the columns of a table have one length, not {sorted(lengths)}")
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(names)
        # repr of a Python float has all its digits
        writer.writerows(zip(*(array.tolist() for array in arrays)))
    return has_dates


def _floats(name, array):
    """A column of numbers, or of lists of numbers, in double precision; other columns as they are."""
    if array.dtype.kind == "f":
        # a number in single precision is written as what it is
        return array.astype(float)
    if array.ndim == 1 and len(array) and hasattr(array[0], "__len__") and not isinstance(array[0], str):
        return np.array([np.asarray(one, dtype=float) for one in array])
    try:
        return array.astype(float)
    except (TypeError, ValueError):
        return array
