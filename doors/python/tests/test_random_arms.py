"""Random arms, revolute and prismatic, against numpy."""

import os

import numpy as np
import pytest

import rne
from oracle import RandomArm

# All of them with CI_FULL=1.
ARMS = 1000 if os.environ.get("CI_FULL") else 200


@pytest.mark.parametrize("part", range(10))
def test_torques_matrix_and_accelerations(part):
    for seed in range(part * ARMS // 10, (part + 1) * ARMS // 10):
        oracle = RandomArm(seed)
        arm = rne.load(oracle.yaml())
        q, qd, qdd = oracle.states(2)
        expected = np.array([oracle.torques(*state) for state in zip(q, qd, qdd)])
        tau = arm.inverse_dynamics(q, qd, qdd)
        scale = np.abs(expected).max()
        assert np.abs(tau - expected).max() <= 1e-12 * scale, seed
        mass = arm.mass_matrix(q)
        matrices = np.array([oracle.mass_matrix(row) for row in q])
        # a difference of torques, each rounded on the scale of gravity's
        assert np.abs(mass - matrices).max() <= 1e-12 * max(scale, np.abs(matrices).max()), seed
        found = arm.forward_dynamics(q, qd, tau)
        condition = np.linalg.cond(matrices).max()
        if condition < 1e8:
            # rounding of the torques, through the inverse of the matrix
            limit = 1e-14 * condition * max(np.abs(qdd).max(), scale / np.abs(matrices).max())
            assert np.abs(found - qdd).max() <= limit + 1e-12, seed


def test_kinematics():
    for seed in range(100):
        oracle = RandomArm(seed)
        arm = rne.load(oracle.yaml())
        q = oracle.states(1)[0, 0]
        poses = arm.link_poses(q)
        for pose, (turn, origin, _, _) in zip(poses, oracle.frames(q)):
            assert np.allclose(pose[:3, :3], turn, atol=1e-13) and np.allclose(pose[:3, 3], origin, atol=1e-13)
            assert (pose[3] == [0, 0, 0, 1]).all()
        assert np.allclose(arm.forward_kinematics(q), poses[-1], atol=1e-13)
        step = 1e-6
        jacobian = arm.jacobian(q)
        for joint in range(arm.dof):
            ahead, behind = (q + sign * step * np.eye(arm.dof)[joint] for sign in (1, -1))
            slope = (arm.forward_kinematics(ahead) - arm.forward_kinematics(behind)) / (2 * step)
            assert np.allclose(jacobian[:3, joint], slope[:3, 3], atol=1e-8)
