"""Dynamics of robot arms: any Denavit-Hartenberg table, URDF or MJCF file, compiled when it is read.

>>> import rne
>>> arm = rne.robots.puma560
>>> arm.inverse_dynamics([0, 0.8, -0.4, 0, 0.5, 0], [0.1] * 6, [0] * 6).shape
(6,)

`rne.load` reads a robot file, a URDF or an MJCF file; `rne.from_mujoco` and `rne.from_pinocchio` take models in
memory; `rne.robots` has the robots in the box. Arrays have the shape `(n,)` for one state or `(N, n)` for many; units are
SI: rad, m, N m, N, kg. Torques are what the actuators must deliver.

`rne.log`, `rne.identify`, `rne.identify_payload`, `rne.watch` and `rne.excite` are about logs: docs/python.md.
"""

from typing import Iterator

import numpy as _numpy

from ._rne import (
    Arm,
    EvaluationError,
    RobotFileError,
    RobotFileWarning,
    __version__,
    builtin as _builtin,
    load,
    names as _names,
    pose_log,
)
from .bases import base_from_imu, base_from_mujoco, base_from_pinocchio, derivatives_to_pinocchio
from .excitation import Excitation, excite
from .identification import Identification, identify
from .logs import Log, log
from .models import from_mujoco, from_pinocchio
from .payloads import IdentifiedPayload, identify_payload
from .verdicts import Verdict
from .watching import Baseline, Watch, watch

__all__ = [
    "Arm",
    "Baseline",
    "EvaluationError",
    "Excitation",
    "Identification",
    "IdentifiedPayload",
    "Log",
    "RobotFileError",
    "RobotFileWarning",
    "Verdict",
    "Watch",
    "base_from_imu",
    "base_from_mujoco",
    "base_from_pinocchio",
    "derivatives_to_pinocchio",
    "excite",
    "from_mujoco",
    "from_pinocchio",
    "identify",
    "identify_payload",
    "load",
    "log",
    "payload",
    "pose_log",
    "robots",
    "watch",
    "__version__",
]


class _Robots:
    """The robots in the box, by name: `rne.robots.puma560`, `rne.robots["ur5"]`, `list(rne.robots)`."""

    def __getattr__(self, name: str) -> Arm:
        try:
            return _builtin(name)
        except KeyError as error:
            raise AttributeError(error.args[0]) from None

    def __getitem__(self, name: str) -> Arm:
        return _builtin(name)

    def __dir__(self) -> list[str]:
        return _names()

    def __iter__(self) -> Iterator[str]:
        return iter(_names())

    def __len__(self) -> int:
        return len(_names())

    def __contains__(self, name: object) -> bool:
        return name in _names()

    def __repr__(self) -> str:
        return f"<rne.robots: {', '.join(_names())}>"


robots = _Robots()


def payload(mass, com=(0.0, 0.0, 0.0), inertia=None):
    """The argument `payload` of the functions of an `Arm`, shape (10,).

    mass: kg. com: centre of mass (m) from the origin of the tip frame, in its axes. inertia: about the centre of mass
    (kg m²), the symmetric tensor of shape (3, 3), or None for a point mass.
    """
    mass = _numbers("mass", mass, (), "a number, in kg")
    com = _numbers("com", com, (3,), "three numbers x, y, z, in m")
    tensor = _numpy.zeros((3, 3)) if inertia is None else inertia
    tensor = _numbers("inertia", tensor, (3, 3), "a symmetric tensor of shape (3, 3), in kg m²")
    if mass < 0:
        said = _numpy.format_float_positional(mass, trim="-")
        raise ValueError(f"the payload's mass is {said} kg: no body has less than 0")
    if not _numpy.allclose(tensor, tensor.T):
        raise ValueError("`inertia` is a symmetric tensor of shape (3, 3)")
    elements = [tensor[0, 0], tensor[1, 1], tensor[2, 2], tensor[0, 1], tensor[0, 2], tensor[1, 2]]
    return _numpy.concatenate([[mass], com, elements])


def _numbers(name, value, shape, allowed):
    """Finite numbers of a shape, or an error that names the argument and what it may be."""
    if _numpy.ma.is_masked(value):
        raise ValueError(f"`{name}`: there are masked elements, which are not numbers: drop or fill them before")
    try:
        array = _numpy.asarray(value)
    except ValueError:
        array = None
    if array is None or array.dtype.kind not in "fiub":
        raise TypeError(f"`{name}` is {value!r}, but it must be {allowed}")
    array = array.astype(float)
    if array.shape != shape:
        raise ValueError(f"`{name}` has the shape {array.shape}, but it must be {allowed}")
    for place in _numpy.argwhere(~_numpy.isfinite(array)):
        at = f"[{', '.join(map(str, place))}]" if len(place) else ""
        raise ValueError(f"`{name}{at}` is {array[tuple(place)]}, but it must be finite")
    return array
