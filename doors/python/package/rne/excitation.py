"""A motion that excites an arm: `rne.excite`."""

from ._rne import exciting
from .logs import as_arm, columns
from .sources import numbers


class Excitation:
    """A motion from rest to rest, sampled.

    `time` (N,) in s, `q`, `qd` and `qdd` (N, n) in rad, rad/s and rad/s², of sliding joints in m, m/s and m/s².
    `condition` is the condition number of the equations, `evaluations` the number of motions that were tried. `joints`
    has where each joint starts and how far it moves, `parameters` how well a log would determine each base parameter:
    if each row had noise of 1 % of the effort limits, or of 5 % of the torques of plausible links where a joint has no
    limit. A log with less noise determines more. With `rotors=True`, the rotors have base parameters, too, here and in
    `rne.identify`.
    """

    def __init__(self, reply, of="links"):
        self._of = of
        self.time, self.q, self.qd, self.qdd = reply["time"], reply["q"], reply["qd"], reply["qdd"]
        self.condition, self.first_condition = reply["condition"], reply["first_condition"]
        self.evaluations = reply["evaluations"]
        self.joints, self.parameters = reply["joints"], reply["base_parameters"]

    def columns(self):
        """The motion as a dict of columns: time, q1, …, qd1, …, qdd1, …"""
        motion = {"time": self.time, "q": self.q, "qd": self.qd, "qdd": self.qdd}
        return columns(motion, ("q", "qd", "qdd"))

    def to_pandas(self):
        """The columns as a DataFrame of pandas."""
        import pandas

        return pandas.DataFrame(self.columns())

    def to_polars(self):
        """The columns as a DataFrame of Polars."""
        import polars

        return polars.DataFrame(self.columns())

    def __repr__(self):
        limited = all(joint["effort"] is not None for joint in self.joints)
        noise = "1 % of the effort limits" if limited else "5 % of the torques"
        excited = sum(of["excited"] for of in self.parameters)
        return (
            f"<rne.Excitation: {self.time[-1]:.4g} s, condition {self.condition:.4g}, {excited} of "
            f"{len(self.parameters)} base parameters of {self._of} excited with noise of {noise}>"
        )


def excite(
    robot,
    *,
    seconds=20.0,
    periods=1,
    harmonics=5,
    range=None,
    velocity=None,
    acceleration=None,
    friction=True,
    rotors=False,
    evaluations=5000,
    seed=1,
    rate=100.0,
):
    """Find a motion that excites the parameters of an arm; Ctrl-C ends the search and keeps the best.

    Collisions are not checked, only limits: try the motion in a simulator or at low speed first.

    Parameters
    ----------
    robot : Arm, path or text
        The arm.
    seconds : float
        Duration of the motion, s.
    periods : int
        Number of repetitions in this time.
    harmonics : int
        Harmonics of each joint's series, 2 or more.
    range, velocity, acceleration : float or sequence, optional
        Largest distance from the middle of the limits (or from 0 without limits), speed and acceleration: a number for
        all joints, or one for each, in rad or m. Limits of the robot hold, too.
    friction, rotors : bool
        Whether friction and the inertia of rotors are to be identified.
    evaluations : int
        Number of motions to try.
    seed : int
        Seed of the random numbers: same arguments give the same motion.
    rate : float
        Samples per second of the result.

    Returns
    -------
    Excitation
        With `time`, `q`, `qd`, `qdd`, `condition`, `joints` and `parameters`.
    """
    asked = {
        "seconds": seconds,
        "periods": periods,
        "harmonics": harmonics,
        "range": numbers(range),
        "velocity": numbers(velocity),
        "acceleration": numbers(acceleration),
        "friction": friction,
        "rotors": rotors,
        "evaluations": evaluations,
        "seed": seed,
        "rate": rate,
    }
    return Excitation(exciting(as_arm(robot), asked), "links and rotors" if rotors else "links")
