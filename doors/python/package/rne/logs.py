"""Logs of an arm: `rne.log`."""

import warnings

import numpy as np

from ._rne import Arm, RobotFileWarning, load, log_content, log_motion
from .sources import files, has_order, reading

#: The beginning of a remark on the order of the joints.
_ORDER = "the log does not name its joints"


def load_unchecked(robot):
    """The arm that `rne.load` reads, without its warnings: a file for logs may have no masses yet."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RobotFileWarning)
        return load(robot)


def as_arm(robot):
    """An arm as it is; of a path, a text or the name of a built-in robot the arm that `rne.load` reads."""
    return robot if isinstance(robot, Arm) else load_unchecked(robot)


def warn(remarks, *sources):
    """Warns of what may make a result wrong; all remarks as a list of sentences.

    A column of shape (N, n) has the order of the arm, so nobody is warned of an order that its table does not tell.
    """
    is_told = bool(sources) and all(map(has_order, sources))
    for is_warning, words in remarks:
        if is_warning and not (is_told and words.startswith(_ORDER)):
            # of who calls rne.identify or rne.watch
            warnings.warn(words, UserWarning, stacklevel=3)
    return [words for _, words in remarks]


class Log:
    """What a log has, and its motion behind a filter without delay.

    `summary` is a dict with the keys of `rne log --json`. The arrays are read when one of them is first asked for:
    `time` (N,) in s, `q`, `qd`, `qdd` and `tau` (N, n) in rad, rad/s, rad/s² and N m, of sliding joints in m, m/s, m/s²
    and N; `run` (N,) has the number of the run, from 1. `tau` is None for a log without efforts.
    """

    def __init__(self, source, robot, options):
        self._source, self._robot, self._options, self._motion = source, robot, options, None
        with files(source, options) as (paths, given):
            self.summary = log_content(paths, robot, given)

    def _read(self):
        if self._motion is None:
            with files(self._source, self._options) as (paths, given):
                self._motion = log_motion(paths, self._robot, given)
        return self._motion

    @property
    def joints(self):
        """The names of the joints, base to tip."""
        return [joint["name"] for joint in self.summary["joints"]]

    @property
    def notes(self):
        """Remarks, in sentences."""
        return list(self.summary["notes"])

    @property
    def time(self):
        """s, shape (N,)"""
        return self._read()["time"]

    @property
    def run(self):
        """Numbers of runs, from 1, shape (N,)"""
        return self._read()["run"]

    @property
    def q(self):
        """Positions, rad or m, shape (N, n)"""
        return self._read()["q"]

    @property
    def qd(self):
        """Velocities, rad/s or m/s, shape (N, n)"""
        return self._read()["qd"]

    @property
    def qdd(self):
        """Accelerations, rad/s² or m/s², shape (N, n)"""
        return self._read()["qdd"]

    @property
    def tau(self):
        """Efforts, N m or N, shape (N, n); None for a log without them"""
        return self._read()["tau"]

    def columns(self):
        """The motion as a dict of columns: time, q1, …, qd1, …, qdd1, …, tau1, …, run."""
        return columns(self._read(), ("q", "qd", "qdd", "tau"))

    def to_pandas(self):
        """The columns as a DataFrame of pandas."""
        import pandas

        return pandas.DataFrame(self.columns())

    def to_polars(self):
        """The columns as a DataFrame of Polars."""
        import polars

        return polars.DataFrame(self.columns())

    def __repr__(self):
        summary = self.summary
        names = ", ".join(self.joints)
        return f"<rne.Log {summary['format']}: {summary['states']} states at {summary['rate']:.4g} Hz of {names}>"


def columns(motion, names):
    """A motion as a dict of columns."""
    table = {"time": motion["time"]}
    for name in names:
        if motion[name] is not None:
            table |= {f"{name}{joint + 1}": np.ascontiguousarray(of) for joint, of in enumerate(motion[name].T)}
    if "run" in motion:
        table["run"] = motion["run"]
    return table


def log(paths, robot=None, **options):
    """What a log of an arm has, and its filtered motion.

    Parameters
    ----------
    paths : path, table, or list of them
        CSV and npy; ROS 2 bags and Parquet where the package was built with `formats`. A table is a dict of columns, or
        a DataFrame of pandas or Polars, or a Table of PyArrow, with the names of columns that a CSV has: time, q1, …,
        qd1, …, tau1, …; a column of shape (N, n) has a number for each joint.
    robot : Arm, path or text, optional
        Selects the joints of this arm.
    **options
        How the log is read: joints, topic, torque_constants, angles, cutoff, gap, derive_velocities, recorded,
        time_unit, rate, columns, map, where. docs/control/python.md describes them.

    Returns
    -------
    Log
        With `summary`, `joints`, `notes`, `time`, `q`, `qd`, `qdd`, `tau`, `to_pandas()` and `to_polars()`.
    """
    return Log(paths, None if robot is None else as_arm(robot), reading(**options))
