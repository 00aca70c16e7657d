"""What the scripts of logs share: the motion that is logged, and the commands that read a log."""

import functools
import math
import os
import subprocess

import harness

# The commands that read logs, beside `rne log` itself; by the file that each may write.
READERS = {
    "log --json": (["log", "{log}", "--json"], ""),
    "log -o": (["log", "{log}", "-o", "out.csv"], "out.csv"),
    "identify": (["identify", "arm.yaml", "{log}", "-o", "identified.yaml"], "identified.yaml"),
    "watch": (["watch", "arm.yaml", "{log}"], ""),
}


@functools.cache
def arm():
    """The robot file of two joints, `joint1` and `joint2`, to which the logs belong."""
    return subprocess.run([harness.RNE, "example", "planar2"], capture_output=True, check=True).stdout


def state(t):
    """Positions, velocities and torques of both joints at a time."""
    return [
        math.sin(t),
        math.cos(1.3 * t),
        math.cos(t),
        -1.3 * math.sin(1.3 * t),
        5 + math.sin(2 * t),
        3 + math.cos(2 * t),
    ]


def read_by_all(trial, name, data, expected="any", says=(), never=(), options=(), everywhere=False, readers=READERS):
    """Gives a log to every command that reads one.

    `expected` and `says` are of `rne log`; where `everywhere` is set, the other commands must do the same. Otherwise
    they may do what they can: a log that can be listed need not be enough to identify an arm.
    """
    trial.write("arm.yaml", arm())
    log = trial.write(name, data)
    rules = {"expected": expected, "says": says, "never": never, "names": name if expected == "bad" else ""}
    trial.rne("log", log, *options, **rules)
    for command, written in readers.values():
        arguments = [log if word == "{log}" else word for word in command]
        trial.rne(
            *arguments,
            *options,
            writes=[written] if written else [],
            never=never,
            **({"expected": expected} if everywhere else {}),
        )
        if written and (trial.folder / written).exists():
            os.unlink(trial.folder / written)
