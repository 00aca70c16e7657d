"""Real arms as URDF against Pinocchio, which reads the same file. Skipped where Pinocchio is not."""

import pathlib
import shlex
import sys

import numpy as np
import pytest

import rne

pytest.importorskip("pinocchio")
sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "xtask"))
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
