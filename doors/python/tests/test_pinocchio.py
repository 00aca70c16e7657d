"""Real arms as URDF against Pinocchio, which reads the same file. Skipped where Pinocchio is not."""

import pathlib
import shlex
import sys

import numpy as np
import pytest

import rne

pytest.importorskip("pinocchio")
sys.path.insert(0, str(pathlib.Path(__file__).parents[3] / "tests/reference"))
urdf = pytest.importorskip("urdf")

N = 20


def keywords(options):
    words = iter(shlex.split(options))
    found = {"lock": {}}
    for word in words:
        if word == "--lock":
            joint, value = next(words).split("=")
            found["lock"][joint] = float(value)
        elif word in ("--lock-others", "--keep-unphysical"):
            found[word[2:].replace("-", "_")] = True
        else:
            found[word[2:]] = next(words)
    return found


@pytest.mark.parametrize("name, options", urdf.ARMS)
@pytest.mark.parametrize("convention", ["standard", "modified"])
def test_arm(name, options, convention):
    path = urdf.find(name)
    if path is None:
        pytest.skip(f"{name} is not installed")
    given = keywords(options)
    arm = rne.load(path, convention=convention, snap=False, **given)
    random = np.random.default_rng(7)
    q, qd, qdd = random.uniform(-1.5, 1.5, size=(3, N, arm.dof))
    tip = given.get("tip") or "link2"
    reference = urdf.Reference(path, arm.joints, arm.held, tip)
    theirs = [reference.values(*state) for state in zip(q, qd, qdd)]
    ours = zip(arm.inverse_dynamics(q, qd, qdd), arm.mass_matrix(q), arm.forward_kinematics(q))
    for (tau, mass, tip), expected in zip(ours, theirs):
        found = (tau, mass, np.vstack([tip[:3, :3], tip[:3, 3]]))
        assert urdf.difference(found, expected).max() < 1e-12


@pytest.mark.parametrize("name, options", urdf.ARMS)
def test_rollout(name, options):
    """Each step of a rollout against one of Euler's method, from the state that the rollout has reached before it."""
    pinocchio = pytest.importorskip("pinocchio")
    path = urdf.find(name)
    if path is None:
        pytest.skip(f"{name} is not installed")
    given = keywords(options)
    # the angles of the file, which Pinocchio has too
    arm = rne.load(path, snap=False, **given)
    reference = urdf.Reference(path, arm.joints, arm.held, given.get("tip") or "link2")
    rows = [joint.idx_v for joint in reference.order]
    random = np.random.default_rng(9)
    q, qd, qdd = random.uniform(-1.5, 1.5, size=(3, N, arm.dof))
    tau, step = np.repeat(arm.inverse_dynamics(q, qd, qdd)[:, None], 3, axis=1), 1e-3
    found = arm.rollout(q, qd, tau, step)
    for sample in range(N):
        state = q[sample], qd[sample]
        for index in range(3):
            arguments = reference.arguments(*state, tau[sample, index])
            qdd = pinocchio.aba(reference.model, reference.data, *arguments)[rows]
            velocity = state[1] + step * qdd
            for part, expected in zip(found, (state[0] + step * velocity, velocity)):
                error = np.abs(part[sample, index] - expected).max()
                assert error <= 1e-12 * max(1.0, np.abs(expected).max())
            state = [part[sample, index] for part in found]
