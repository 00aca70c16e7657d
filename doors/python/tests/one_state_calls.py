"""Calls of every function of a state with plain arrays, as a controller makes them: for the test that counts what a call
does, and for benches/peers/python/one_state.py, which measures the time."""

import inspect
from pathlib import Path

import numpy as np

import rne

ROOT = Path(__file__).parents[3]

#: An arm, a robot with four legs on a floating base, one with contacts, and closed loops on a fixed and on a floating base.
ROBOTS = {
    "panda": "panda",
    "hyq": ROOT / "tests/functions/floating/grid_hyq.yaml",
    "standing": ROOT / "docs/standing_hyq.yaml",
    "four_bar": ROOT / "docs/four_bar.yaml",
    "flying": Path(__file__).parent / "flying_four_bar.yaml",
}

#: Methods with a state that search or compose for seconds, and functions of the package that take no state.
OTHERS = {"diagnose"}
OF_NO_STATE = {
    "excite", "from_mujoco", "from_pinocchio", "identify", "identify_payload", "load", "log", "repair", "watch",
}


def arguments_of(arm, random):
    """Plain arrays of one state for the arguments of all functions, by name."""
    n, tips = arm.dof, len(arm.tips)
    q, passive = arm.closures[0] if arm.closures else (0.5 * random.normal(size=n), [])
    q = np.array(q)
    pose = np.eye(4)
    pose[:3, 3] = 0.1, 0.2, 0.3
    given = dict(zip(("qd", "qdd", "tau", "multipliers"), 0.5 * random.normal(size=(4, n))))
    given |= dict(zip(("base_omega", "base_omega_dot", "base_acceleration", "base_gravity", "omega"), random.normal(size=(5, 3))))
    return given | {
        "q": q, "sin": np.sin(q), "cos": np.cos(q), "passive": np.array(passive), "guess": np.array(passive),
        "wrench": random.normal(size=6), "wrenches": random.normal(size=(tips, 6)), "payload": rne.payload(0.5, [0.01, 0, 0.1]),
        "twist": random.normal(size=6), "pose": pose, "target": pose, "base_rotation": np.eye(3), "step": 0.001,
        "frame": arm.joints[-1], "rows": [0, 1, 2], "width": 0.1,
    }


def of_arm(arm):
    """Names of calls and the calls: each method with what it needs, and with each thing that it may be given besides."""
    given = arguments_of(arm, np.random.default_rng(4))
    for name in dir(rne.Arm):
        method = getattr(arm, name)
        if name.startswith("_") or name in OTHERS or not callable(method):
            continue
        parameters = inspect.signature(method).parameters.values()
        if not {"q", "qd"} & {parameter.name for parameter in parameters}:
            continue
        here = given | {"tau": given["tau"][None]} if name == "rollout" else given
        needed = [here[parameter.name] for parameter in parameters if parameter.default is parameter.empty]
        yield name, "", lambda method=method, needed=needed: method(*needed)
        for parameter in parameters:
            if parameter.default is not parameter.empty and parameter.name in here:
                keywords = {parameter.name: here[parameter.name]}
                yield name, f"{parameter.name}=", lambda method=method, needed=needed, keywords=keywords: method(*needed, **keywords)


def of_package():
    """As `of_arm`, of the functions of the package: a robot with twelve joints in the vectors of other tools."""
    random = np.random.default_rng(5)
    q, v, a = random.normal(size=19), random.normal(size=18), random.normal(size=18)
    q[3:7] /= np.linalg.norm(q[3:7])
    readings, gravity = random.normal(size=(3, 3)), np.array([0, 0, -9.81])
    matrices = [random.normal(size=(18, columns)) for columns in (12, 12, 3)]
    calls = {
        "base_from_imu": [(readings, {}), (readings, {"rotation": np.eye(3)})],
        "base_from_mujoco": [((q, v, a), {"gravity": gravity})],
        "base_from_pinocchio": [((q, v, a), {"gravity": gravity})],
        "derivatives_to_pinocchio": [((matrices, np.eye(18), q, v), {"gravity": gravity})],
        "payload": [((0.5,), {}), ((0.5, np.zeros(3), np.eye(3)), {})],
        "pose_log": [((np.eye(4),), {})],
    }
    functions = {name for name in rne.__all__ if inspect.isroutine(getattr(rne, name))}
    assert functions == set(calls) | OF_NO_STATE, "each function of the package is measured, or takes no state"
    for name, variants in calls.items():
        for arguments, keywords in variants:
            label = "".join(f"{keyword}=" for keyword in keywords)
            yield name, label, lambda name=name, a=arguments, k=keywords: getattr(rne, name)(*a, **k)


def all_calls(robots=None):
    """The robot, the function, what it is given besides, and the call; what a robot has not is left out."""
    missing = {name for name, *_ in of_arm(rne.robots.panda)}
    for robot, source in (robots or ROBOTS).items():
        for name, given, call in of_arm(source if isinstance(source, rne.Arm) else rne.load(source)):
            try:
                call()
            except (ValueError, rne.EvaluationError):
                continue
            missing.discard(name)
            yield robot, name, given, call
    assert not missing, f"no robot computes {missing}"
    yield from (("package", *call) for call in of_package())
