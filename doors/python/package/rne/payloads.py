"""A payload from the logs of an arm: `rne.identify_payload`."""

import pathlib

import numpy

from ._rne import payload_identified
from .logs import as_arm, load_unchecked, warn
from .sources import files, reading


class IdentifiedPayload:
    """The rigid body that the last link carries beyond what the robot file has.

    All numbers are in tip axes, as those of the keyword `payload`. `payload` is an array of ten numbers for this
    keyword; it is zero where the logs show no payload, and None where they do not determine the mass or show less mass than the
    robot file has. `found` says whether the logs show a payload. `mass` (kg), `com` (the centre of mass x, y, z from
    the origin of the tip frame, m) and `inertia` (xx, yy, zz, xy, xz, yz about the centre of mass, kg m²) are dicts with
    `value`, `deviation`, `unit` and `excited`, or lists of them; value and deviation are None where the logs do not
    determine the number.
    `joints` has the errors without and with the payload, `robot_file` the text of the robot file with the payload in its
    last link and `arm` the arm that it describes; both are None if the logs do not determine the mass.
    """

    def __init__(self, reply):
        found = reply["payload"]
        self.found, self.mass, self.com, self.inertia = found["found"], found["mass"], found["com"], found["inertia"]
        self.payload = None if found["numbers"] is None else numpy.array(found["numbers"])
        self.joints, self.delay, self.cutoff = reply["joints"], reply["delay"], reply["cutoff"]
        self.logs, self.robot = reply["logs"], reply["robot"]
        self.states, self.duration = reply["states"], reply["duration"]
        self.robot_file = reply["robot_file"]
        self.arm = None if self.robot_file is None else load_unchecked(self.robot_file)
        self.notes = [words for _, words in reply["remarks"]]

    def save(self, path):
        """Writes the robot file with the payload."""
        if self.robot_file is None:
            raise ValueError("the logs do not determine the mass of a payload, so there is no robot file")
        pathlib.Path(path).write_text(self.robot_file, encoding="utf-8")

    def __str__(self):
        if not self.mass["excited"]:
            return "the logs do not determine the mass of a payload"
        mass = f"{self.mass['value']:.3f} ± {self.mass['deviation']:.3f} kg"
        com = [number["value"] for number in self.com]
        at = "" if None in com else " at ({:.3f}, {:.3f}, {:.3f}) m in tip axes".format(*com)
        return f"payload of {mass}{at}" if self.found else f"no payload: {mass} beyond the robot file"

    def __repr__(self):
        return f"<rne.IdentifiedPayload of {self.robot}: {self}>"


def identify_payload(robot, paths, **options):
    """Identify what the last link carries in addition, such as a tool or a load.

    Parameters
    ----------
    robot : Arm, path or text
        The arm with its links and friction, such as the `arm` of `rne.identify` from a log without the payload.
    paths : path, table, or list of them
        The logs with the payload, as `rne.log` takes them, with efforts of all joints.
    **options
        How the logs are read: see `rne.log`.

    Returns
    -------
    IdentifiedPayload
        With `payload`, `mass`, `com`, `inertia`, `arm`.
    """
    arm = as_arm(robot)
    with files(paths, reading(**options)) as (found, given):
        reply = payload_identified(arm, found, given)
    warn(reply["remarks"], paths)
    return IdentifiedPayload(reply)
