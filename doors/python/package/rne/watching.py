"""What has changed about an arm, by its logs: `rne.watch`."""

import contextlib
import datetime
import os
import pathlib

from ._rne import followed, log_content, watched
from .logs import as_arm, warn
from .sources import files, label, reading


class Baseline:
    """What quiet logs say of an arm, saved once and used for every later log: `text` is that of its file."""

    def __init__(self, text, name="<text>"):
        self.text, self._name = text, name

    @classmethod
    def read(cls, path):
        """The baseline of a file."""
        return cls(pathlib.Path(path).read_text(encoding="utf-8"), str(path))

    def save(self, path):
        """Writes the file that `rne.watch(…, baseline=path)` and `rne watch --baseline` read."""
        pathlib.Path(path).write_text(self.text, encoding="utf-8")


class Watch:
    """Result of `rne.watch`: the changes that were found in logs.

    `events` is a list of dicts with the keys of `rne watch --json`: cause (friction, payload, contact, sensor or model),
    joint (from 1), name, parameter, value ± deviation in `unit`, file_value, baseline_value, threshold, since and until
    (s), since_time, until_time, not_before_time and not_after_time (RFC 3339, UTC, or None), rivals. `parameters` has
    all other parameters with their thresholds, `joints` the errors of the model. With `by`, `trend` has a dict for each
    log (log, events, payload, payload_deviation, joints), `csv` its table, `left_out` the logs that cannot be compared,
    each with the reason, and `events` those of all logs, each with the key `log`; `parameters` and `joints` are empty
    then. `baseline` is that of the quiet logs, or None without any. `compared_with` says what the logs are compared with, and `notes` has the remarks on them.
    """

    def __init__(self, reply):
        self.robot, self.compared_with = reply["robot"], reply["baseline"]
        self.trend, self.csv = reply.get("logs"), reply.get("table")
        self.left_out = reply.get("left_out", {})
        self.parameters, self.joints = reply.get("parameters", []), reply.get("joints", [])
        if self.trend is None:
            self.events = reply["events"]
        else:
            self.events = [{"log": of["log"], **event} for of in self.trend for event in of["events"]]
        text = reply["baseline_file"]
        self.baseline = None if text is None else Baseline(text)
        self.notes = [words for _, words in reply["remarks"]]
        self._svg = reply["picture"]

    def _repr_svg_(self):
        """Residuals and events of the logs, or the trend."""
        return self._svg

    def __str__(self):
        return "\n".join([_sentence(event) for event in self.events] or ["no events"])

    def __repr__(self):
        count = len(self.events)
        return f"<rne.Watch of {self.robot}: {count or 'no'} event{'' if count == 1 else 's'}>"


def _sentence(event):
    """An event in words."""
    place = f" of {event['name']}" if event["name"] else ""
    where = f"{event['log']}: " if "log" in event else ""
    deviation = "" if event["deviation"] is None else f" ± {event['deviation']:.3g}"
    size = f"{event['parameter']} {event['value']:.4g}{deviation} {event['unit']}, before {event['baseline_value']:.4g}"
    others = [f"; {of} friction would explain it almost as well" for of in event["rivals"] if of in _FRICTION]
    return f"{where}{event['cause']}{place}: {size}{''.join(others)}; {_when(event)}"


#: The parameters of friction that can be rivals of each other.
_FRICTION = ("coulomb", "viscous")


def _when(event):
    """The times of an event in words, with dates where the log has them."""
    since, until, before, after = (event[f"{key}_time"] for key in ("since", "until", "not_before", "not_after"))
    if event["whole"]:
        bound = "" if before is None else f", not there at {before}"
        bound += "" if after is None else f", not there at {after}"
        dates = "" if since is None else f", {since} to {until}"
        return f"in the whole log{dates}{bound}"
    date = "" if since is None else f" ({since})"
    if event["lasts"]:
        return f"since {event['since']:.2f} s{date}"
    return f"{event['since']:.2f} s to {event['until']:.2f} s{date}"


def watch(
    robot, paths, quiet=None, baseline=None, *, by=None, gain=20.0, hold=0.005, false_alarms=0.01, **options
):
    """Find changes of an arm in its logs: friction, payload, contacts.

    Parameters
    ----------
    robot : Arm, path or text
        The arm with its friction, such as the `arm` of `rne.identify`.
    paths : path, table, or list of them
        The logs, as `rne.log` takes them, with efforts of all joints.
    quiet : path, table, or list of them, optional
        Logs in which nothing happens, for comparison; without them and without `baseline` the robot file is compared.
    baseline : Baseline or path, optional
        The baseline of an earlier watch, or the file that it was saved to.
    by : {"log", "day"}, optional
        Follow the parameters from log to log, or from day to day (UTC).
    gain : float
        Gain of the momentum observer, Hz.
    hold : float
        Shortest contact that is an event, s.
    false_alarms : float
        Permitted false contacts per hour, of all joints.
    **options
        How the logs are read: see `rne.log`.

    Returns
    -------
    Watch
        With `events`, `parameters`, `trend`, `baseline`.
    """
    if by not in (None, "log", "day"):
        raise ValueError(f"`by` is \"log\" or \"day\", not {by!r}")
    arm, given = as_arm(robot), reading(**options)
    with contextlib.ExitStack() as stack:
        quiet, quiet_given = (None, given) if quiet is None else stack.enter_context(files(quiet, given))
        if isinstance(baseline, (str, os.PathLike)):
            baseline = Baseline.read(baseline)
        known = None if baseline is None else (baseline._name, baseline.text)
        if by is None:
            found, given = stack.enter_context(files(paths, given))
            _check_apart(found, quiet)
            reply = watched(arm, found, _one(given, quiet_given), quiet, known, (gain, hold, false_alarms))
        else:
            sources = list(paths) if isinstance(paths, (list, tuple)) else [paths]
            groups = []
            for number, source in enumerate(sources, 1):
                found, given = stack.enter_context(files(source, given))
                name = label(source, number)
                groups.append((name if by == "log" else _day(arm, name, found, given), found))
            if by == "day":
                days = dict.fromkeys(day for day, _ in groups)
                groups = [(day, [path for of, found in groups if of == day for path in found]) for day in days]
            _check_apart([path for _, found in groups for path in found], quiet)
            reply = followed(arm, groups, _one(given, quiet_given), quiet, known)
    warn(reply["remarks"])
    return Watch(reply)


#: ns: earlier stamps are since the start of a machine.
_LEAST_DATE = 315_360_000 * 10**9


def _day(arm, name, paths, given):
    """The day of the first state of a log, UTC."""
    origin = log_content(paths, arm, given)["origin_ns"]
    if origin <= _LEAST_DATE:
        why = "so it belongs to no day; by=\"log\" compares the logs one by one"
        raise ValueError(f"the times of {name} are not dates, {why}")
    return datetime.datetime.fromtimestamp(origin // 10**9, datetime.timezone.utc).date().isoformat()


def _check_apart(paths, quiet):
    """Refuses a log that is quiet and watched."""
    watched_too = {path.resolve() for path in paths} & {path.resolve() for path in quiet or []}
    if watched_too:
        named = min(watched_too).name
        raise ValueError(f"{named} is also watched: `quiet` needs another log, without disturbances")


def _one(given, other):
    """The options of logs and of quiet logs: dates of tables give the unit of both."""
    return {**given, "time_unit": given["time_unit"] or other["time_unit"]}
