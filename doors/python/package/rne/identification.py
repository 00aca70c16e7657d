"""Parameters of an arm from its logs: `rne.identify`."""

import pathlib

from ._rne import identified
from .logs import as_arm, load_unchecked, warn
from .sources import files, reading
from .verdicts import Verdict


class Identification:
    """A model that was identified from logs.

    `verdict` says first what it is good for. `joints`, `parameters` (base parameters) and `friction` are tables: lists
    of dicts with the keys of `rne identify --json`, which `pandas.DataFrame` takes. `errors` has the errors of each
    joint that decide: on held-out data where there are some. `robot_file` is the text of the robot file, and `arm` the
    arm that it describes; both are None if the logs determine nothing. `delay` is that of the efforts against the
    positions (`value` and `deviation`, s), `cutoff` the low-pass of both sides of the equations (Hz), `states` the
    number of states, `duration` that of the motion (s), `held_out` the part that was held out, `notes` the remarks on
    the logs.
    """

    def __init__(self, reply):
        self.verdict = Verdict(reply)
        self.joints, self.parameters, self.friction = reply["joints"], reply["base_parameters"], reply["friction"]
        side = self.verdict.errors_on
        self.errors = [{"joint": of["joint"], "name": of["name"], "unit": of["unit"], **of[side]} for of in self.joints]
        self.robot_file = reply["robot_file"]
        self.arm = None if self.robot_file is None else load_unchecked(self.robot_file)
        self.logs, self.robot = reply["logs"], reply["robot"]
        self.delay, self.cutoff, self.held_out = reply["delay"], reply["cutoff"], reply["held_out"]
        self.states, self.duration = reply["states"], reply["duration"]
        self.notes = [words for _, words in reply["remarks"]]
        self._svg = reply["picture"]

    def save(self, path):
        """Writes the robot file."""
        if self.robot_file is None:
            raise ValueError("the logs determine no link and no friction of this arm, so there is no robot file")
        pathlib.Path(path).write_text(self.robot_file, encoding="utf-8")

    def _repr_svg_(self):
        """Measured and predicted torques."""
        return self._svg

    def __str__(self):
        return str(self.verdict)

    def __repr__(self):
        return f"<rne.Identification of {self.robot}: {self.verdict.lines[0]}>"


def identify(robot, paths, *, hold_out=None, rotors=False, friction=True, regularization=1.0, **options):
    """Identify links and friction of an arm from its logs.

    Parameters
    ----------
    robot : Arm, path or text
        The geometry of the arm.
    paths : path, table, or list of them
        The logs, as `rne.log` takes them, with efforts of all joints.
    hold_out : float, optional
        Compute errors on this last part of the logs, 0 to 1, such as 0.3; the model is fitted to the rest.
    rotors : bool
        Identify the inertia of the rotors, too.
    friction : bool
        Whether there is friction.
    regularization : float
        Regularization to the links of `robot`, 1e-6 or more; 1 is as strong as one row of noise.
    **options
        How the logs are read: see `rne.log`.

    Returns
    -------
    Identification
        Its `verdict` says first what the model is good for; `arm` is ready to call.
    """
    if hold_out is not None and not 0 < hold_out < 1:
        raise ValueError("`hold_out` lies between 0 and 1, such as 0.3")
    if not 1e-6 <= regularization < float("inf"):
        raise ValueError("`regularization` is a number of 1e-6 or more; 1 is as strong as one row of noise")
    arm = as_arm(robot)
    with files(paths, reading(**options)) as (found, given):
        reply = identified(arm, found, given, hold_out, rotors, friction, regularization)
    if reply["robot_file"] is None:
        nothing = "nothing is excited: the log determines no link and no friction of this arm, so there is no robot file"
        reply["remarks"].append((True, nothing))
    warn(reply["remarks"], paths)
    return Identification(reply)
