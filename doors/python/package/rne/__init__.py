"""Dynamics of robot arms: any Denavit-Hartenberg table, URDF or MJCF file, compiled when it is read.

>>> import rne
>>> arm = rne.robots.puma560
>>> arm.inverse_dynamics([0, 0.8, -0.4, 0, 0.5, 0], [0.1] * 6, [0] * 6).shape
(6,)

`rne.load` reads a robot file, a URDF or an MJCF file; `rne.from_mujoco` and `rne.from_pinocchio` take models in
memory; `rne.robots` has the robots in the box. Arrays have the shape `(n,)` for one state or `(N, n)` for many; units are
SI: rad, m, N m, N, kg. Torques are what the actuators must deliver.

`rne.log`, `rne.identify`, `rne.identify_payload`, `rne.watch` and `rne.excite` are about logs: docs/control/python.md.
"""

from typing import Iterator

from ._rne import (
    Arm,
    EvaluationError,
    RobotFileError,
    RobotFileWarning,
    __version__,
    base_from_imu,
    base_from_mujoco,
    base_from_pinocchio,
    builtin as _builtin,
    derivatives_to_pinocchio,
    load,
    names as _names,
    payload,
    pose_log,
    repair,
)
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
    "repair",
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
