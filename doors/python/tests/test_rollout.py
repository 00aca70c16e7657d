"""Rollouts against Euler's method in numpy, with accelerations of numpy and of Pinocchio.

Motions of arms are chaotic: rounding grows from step to step. So each step is compared by itself, from the state that the
rollout has reached before it.
"""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import rne
from oracle import RandomArm

ROOT = Path(__file__).parents[3]
# All of them with CI_FULL=1.
ARMS = 500 if os.environ.get("CI_FULL") else 100
SAMPLES, STEPS, STEP = 2, 2, 2e-3
# The unit is the larger of 1 and the numbers of the step. Where the mass matrix has a greater condition, accelerations are rounding.
TOLERANCE, CONDITION = 1e-12, 1e5

random = np.random.default_rng(8)


def before(start, found):
    """The states before each step."""
    return [np.concatenate([first[:, None], states[:, :-1]], axis=1) for first, states in zip(start, found)]


def compare(arm, accelerations, mass, seed):
    """Compares a rollout with steps of Euler's method from its own states; returns how many were compared."""
    q, qd = random.normal(size=(2, SAMPLES, arm.dof))
    tau = arm.inverse_dynamics(np.repeat(q, STEPS, 0), np.repeat(qd, STEPS, 0),
                               random.normal(size=(SAMPLES * STEPS, arm.dof)) * 3).reshape(SAMPLES, STEPS, arm.dof)
    found = arm.rollout(q, qd, tau, STEP)
    assert [part.shape for part in found] == [tau.shape] * 2
    compared = 0
    for at in np.ndindex(SAMPLES, STEPS):
        state = [part[at] for part in before((q, qd), found)]
        if not np.isfinite(state).all() or np.linalg.cond(mass(state[0])) > CONDITION:
            continue
        velocity = state[1] + STEP * accelerations(*state, tau[at])
        position = state[0] + STEP * velocity
        for expected, part in zip((position, velocity), found):
            assert np.abs(part[at] - expected).max() <= TOLERANCE * max(1.0, np.abs(expected).max()), seed
        compared += 1
    return compared


def of_numpy(oracle):
    def accelerations(q, qd, tau):
        return np.linalg.solve(oracle.mass_matrix(q), tau - oracle.torques(q, qd, np.zeros(oracle.n)))

    return accelerations, oracle.mass_matrix


def test_random_arms():
    compared = 0
    for seed in range(ARMS):
        oracle = RandomArm(seed)
        compared += compare(rne.load(oracle.yaml()), *of_numpy(oracle), seed) > 0
    assert compared >= 0.9 * ARMS


def of_pinocchio(robot):
    pinocchio = pytest.importorskip("pinocchio")
    sys.path.insert(0, str(ROOT / "benches/peers/python"))
    import pinocchio_arm

    model = pinocchio_arm.build(robot)
    data = model.createData()

    def mass(q):
        upper = np.triu(pinocchio.crba(model, data, q))
        return upper + np.triu(upper, 1).T

    return lambda q, qd, tau: pinocchio.aba(model, data, q, qd, tau).copy(), mass


def test_random_arms_beside_pinocchio():
    compared = 0
    for seed in range(ARMS):
        oracle = RandomArm(seed)
        joints = [{"type": joint["type"][0].upper(), "offset": 0.0, "m": joint["mass"], "com": list(joint["com"]),
                   "I": [joint["inertia"][i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))],
                   **{key: float(joint[key]) for key in ("theta", "d", "a", "alpha")}} for joint in oracle.joints]
        robot = {"name": "random_arm", "convention": oracle.convention, "gravity": list(oracle.gravity), "joints": joints}
        compared += compare(rne.load(oracle.yaml()), *of_pinocchio(robot), seed) > 0
    assert compared >= 0.9 * ARMS


# The mass matrix of the Stanford arm, with published inertias that no body has, has a condition above 2e5 everywhere.
MODELS = [path for path in sorted((ROOT / "benches/peers/models").glob("*.json")) if path.stem != "stanford"]


@pytest.mark.parametrize("path", MODELS, ids=lambda path: path.stem)
def test_real_arms_beside_pinocchio(path):
    arm = rne.load(path.with_suffix(".yaml"))
    compared = sum(compare(arm, *of_pinocchio(json.loads(path.read_text())), path.stem) for _ in range(5))
    assert compared > 0


@pytest.mark.parametrize("name", list(rne.robots))
def test_a_rollout_is_a_loop_of_forward_dynamics(name):
    """With friction and limits; the loop is numpy's, the accelerations are rne's."""
    arm = rne.load(rne.robots[name].yaml, rotors=True)
    file = rne.robots[name].limits
    q, qd = random.uniform(-1, 1, size=(2, 33, arm.dof))
    tau = arm.gravity_torques(q)[:, None] + random.normal(size=(33, 6, arm.dof)) * 3
    load = rne.payload(0.4, [0.01, 0.0, 0.05])
    found = arm.rollout(q, qd, tau, 1e-3, friction=0.05, limits=["position"], payload=load)
    width, zero = 0.05, np.zeros(arm.dof)
    # at two speeds: viscous friction alone makes the difference
    forward, faster, backward = (arm.actuator_torques(zero + speed, zero) for speed in (1.0, 2.0, -1.0))
    viscous = faster - forward
    forward, backward = forward - viscous, backward + viscous
    for step in range(6):
        s = qd / np.sqrt(qd * qd + width * width)
        friction = viscous * qd + 0.5 * (forward - backward) * s + 0.5 * (forward + backward) * s * s
        qd = qd + 1e-3 * arm.forward_dynamics(q, qd, tau[:, step] - friction, payload=load)
        q = q + 1e-3 * qd
        stops = (q < file[:, 0]) | (q > file[:, 1])
        q, qd = np.clip(q, file[:, 0], file[:, 1]), np.where(stops, 0.0, qd)
        for expected, part in zip((q, qd), found):
            assert np.abs(part[:, step] - expected).max() <= 1e-12 * max(1.0, np.abs(expected).max())
        # from what was reached: rounding grows
        q, qd = (part[:, step] for part in found)


def test_arguments_without_the_axis_of_samples_are_those_of_all():
    arm = rne.robots.puma560
    q, qd = random.normal(size=(2, 9, 6))
    tau = random.normal(size=(9, 4, 6))
    for start in ((q[0], qd), (q, qd[:1]), (q[0], qd[0])):
        found = arm.rollout(*start, tau, STEP)
        rows = [np.broadcast_to(row, (9, 6)) for row in start]
        assert np.array_equal(found, arm.rollout(*rows, tau, STEP))
    one = arm.rollout(q, qd, tau[3], STEP)
    assert np.array_equal(one, arm.rollout(q, qd, np.broadcast_to(tau[3], (9, 4, 6)), STEP))
    alone = arm.rollout(q[2], qd[2], tau[3], STEP)
    assert alone[0].shape == (4, 6) and np.array_equal(alone, np.array(one)[:, 2])
    loads = np.array([rne.payload(mass, [0, 0, 0.1]) for mass in np.linspace(0, 2, 9)])
    loaded = arm.rollout(q[0], qd[0], tau[0], STEP, payload=loads)
    assert np.array_equal(loaded[0][5], arm.rollout(q[0], qd[0], tau[0], STEP, payload=loads[5])[0])


def test_layouts_precision_and_room():
    arm = rne.robots.puma560
    q, qd = random.normal(size=(2, 9, 6))
    tau = random.normal(size=(9, 4, 6))
    expected = arm.rollout(q, qd, tau, STEP)
    for change in (np.asfortranarray, lambda x: x[::-1].copy()[::-1], lambda x: x.tolist()):
        assert np.array_equal(arm.rollout(change(q), change(qd), change(tau), STEP), expected)
    out = np.full((2, 9, 4, 6), np.nan)
    found = arm.rollout(q, qd, tau, STEP, out=out)
    assert np.array_equal(out, expected) and all(np.shares_memory(part, out) for part in found)
    single = arm.rollout(*(x.astype(np.float32) for x in (q, qd, tau)), STEP)
    assert single[0].dtype == np.float32 and np.allclose(single, expected, rtol=1e-3, atol=1e-3)
    assert arm.rollout(q.astype(np.float32), qd.tolist(), tau.tolist(), STEP)[0].dtype == np.float32
    assert [part.shape for part in arm.rollout(q[:0], qd[:0], tau[:0], STEP)] == [(0, 4, 6)] * 2
    assert [part.shape for part in arm.rollout(q, qd, tau[:, :0], STEP)] == [(9, 0, 6)] * 2
    assert np.array_equal(arm.rollout(q, qd, tau, STEP, friction=False, limits=False), expected)


def test_nan_stays_in_its_sample():
    arm = rne.robots.puma560
    q, qd = random.normal(size=(2, 100, 6))
    tau = random.normal(size=(100, 4, 6))
    expected = np.array(arm.rollout(q, qd, tau, STEP))
    tau[37, 2, 1] = np.nan
    found = np.array(arm.rollout(q, qd, tau, STEP))
    assert np.isnan(found[:, 37, 2:]).any(axis=(0, 2)).all()
    expected[:, 37, 2:] = found[:, 37, 2:]
    assert np.array_equal(found, expected, equal_nan=True)


@pytest.mark.parametrize("arguments, keywords, says", [
    (dict(tau=np.zeros((4, 5))), {}, r"`tau` has the shape \(4, 5\); it is \(T, 6\) for one sample or \(N, T, 6\) for many"),
    (dict(tau=np.zeros(6)), {}, r"`tau` has the shape \(6,\)"),
    (dict(tau=np.zeros((3, 4, 6))), {}, r"`tau` has the shape \(3, 4, 6\), but `q` has the shape \(9, 6\): .* and N is 9"),
    # the axes of steps and samples exchanged, for one step
    (dict(tau=np.zeros((1, 9, 6))), {}, r"`tau` has the shape \(1, 9, 6\), but `q` has the shape \(9, 6\)"),
    (dict(q=np.zeros(6), qd=np.zeros((9, 6)), tau=np.zeros((1, 9, 6))), {}, r"but `qd` has the shape \(9, 6\)"),
    (dict(tau="text"), {}, "`tau`"),
    (dict(tau=[[0.0], [0.0, 1.0]]), {}, "`tau` is not an array of real numbers"),
    (dict(step=0.0), {}, "the step of a rollout is 0 s, but it must be a finite number above 0"),
    ({}, dict(friction=0.0), "the width of Coulomb friction is 0"),
    ({}, dict(friction=True), "joint `.*` has Coulomb friction, but no `coulomb_width` in the robot file"),
    ({}, dict(friction="much"), "`friction` is True or a number"),
    ({}, dict(limits=["effort", "speed"]), "`speed` is not a limit"),
    ({}, dict(limits=3), "`limits` is True, False or a list"),
    ({}, dict(payload=[-1.0, 0, 0, 0]), "the payload's mass is -1 kg"),
    ({}, dict(out=np.zeros((9, 2, 4, 6))), r"`out` must be a writable array in C order of the shape \(2, 9, 4, 6\)"),
])
def test_what_is_wrong_is_said(arguments, keywords, says):
    given = dict(q=np.zeros((9, 6)), qd=np.zeros(6), tau=np.zeros((9, 4, 6)), step=STEP) | arguments
    with pytest.raises((TypeError, ValueError), match=says):
        rne.robots.puma560.rollout(**given, **keywords)


def test_friction_and_limits_of_the_file():
    """A joint that is pushed into its stop; Coulomb friction about the width of the file."""
    text = rne.robots.planar1.yaml
    assert "limits" not in text and "motor" not in text
    text = text.rstrip() + "\n    limits: {position: [-1, 0.2]}\n    motor: {coulomb: [2, -2], coulomb_width: 0.1}\n"
    arm = rne.load(text)
    q, qd = arm.rollout([0.0], [0.0], np.full((200, 1), 50.0), 1e-3, limits=True)
    assert q.max() == 0.2 == q[-1, 0] and qd[-1, 0] == 0.0
    of_file = arm.rollout([0.0], [1.0], np.zeros((5, 1)), 1e-3, friction=True)
    assert np.array_equal(of_file, arm.rollout([0.0], [1.0], np.zeros((5, 1)), 1e-3, friction=0.1))
    assert not np.array_equal(of_file, arm.rollout([0.0], [1.0], np.zeros((5, 1)), 1e-3, friction=0.2))


def test_run_time_parameters():
    text = rne.robots.planar1.yaml
    free = rne.load(text).rollout([0.1], [0.0], np.ones((3, 1)), STEP)
    arm = rne.load(text, run_time=["m"]) if "m:" in text else pytest.skip("planar1 has no parameter m")
    assert np.allclose(arm.rollout([0.1], [0.0], np.ones((3, 1)), STEP), free, rtol=1e-14)
    both = arm.rollout([0.1], [0.0], np.ones((3, 1)), STEP, parameters=[[1.0], [2.0]])
    assert both[0].shape == (2, 3, 1) and not np.array_equal(both[1][0], both[1][1])


THREADS = """
import sys, numpy as np, rne
random = np.random.default_rng(1)
q, qd = random.normal(size=(2, 700, 6))
found = rne.robots.puma560.rollout(q, qd, random.normal(size=(700, 30, 6)), 1e-3)
sys.stdout.write(np.array(found).tobytes().hex())
"""


def test_the_number_of_threads_changes_no_bit():
    def with_threads(count):
        environment = os.environ | {"RAYON_NUM_THREADS": str(count)}
        return subprocess.run([sys.executable, "-c", THREADS], env=environment, check=True, capture_output=True).stdout

    one = with_threads(1)
    assert len(one) == 2 * 700 * 30 * 6 * 16 and one == with_threads(3)
