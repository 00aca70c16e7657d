"""The operational-space inertia and the dynamically consistent inverse: numpy, and forward dynamics as a witness."""

from pathlib import Path

import numpy as np
import pytest

import rne
from oracle import RandomArm

DESK = (Path(__file__).parents[3] / "docs" / "desk_arm_frames.yaml").read_text(encoding="utf-8")


def by_numpy(mass, jacobian):
    """Λ and J̄ by numpy's inverses, and by how much these magnify rounding."""
    inverse = np.linalg.inv(mass)
    mobility = jacobian @ inverse @ np.swapaxes(jacobian, -1, -2)
    inertia = np.linalg.inv(mobility)
    magnification = np.linalg.cond(mass) + np.linalg.cond(mobility)
    return inertia, inverse @ np.swapaxes(jacobian, -1, -2) @ inertia, magnification


def same(found, expected, magnification):
    error = np.abs(found - expected).max((-1, -2)) / np.abs(expected).max((-1, -2))
    assert (error <= 1e-15 * magnification).all(), (error / magnification).max()


# of a tree, some joints do not move the tip
SERIAL = [name for name in rne.robots if "\nformat: 1" in rne.robots[name].yaml]


@pytest.mark.parametrize("name", [name for name in SERIAL if rne.robots[name].dof >= 6])
def test_shipped_arms_are_those_of_numpy(name):
    arm = rne.robots[name]
    q = np.random.default_rng(71).uniform(-2.5, 2.5, (40, arm.dof))
    for rows in (None, [0, 1, 2], [2, 5, 0]):
        jacobian = arm.jacobian(q)[:, rows or slice(None)]
        inertia, inverse, magnification = by_numpy(arm.mass_matrix(q), jacobian)
        regular = magnification < 1e8
        assert regular.any()
        found = arm.operational_space_inertia(q, rows=rows)
        same(found[regular], inertia[regular], magnification[regular])
        assert np.array_equal(found, np.swapaxes(found, -1, -2), equal_nan=True)
        found = arm.dynamically_consistent_inverse(q, rows=rows)
        same(found[regular], inverse[regular], magnification[regular])


def test_random_arms_move_as_forward_dynamics_says():
    compared = 0
    for seed in range(40):
        model = RandomArm(seed)
        arm = rne.load(model.yaml())
        q = model.states(1)[0, 0]
        jacobian = arm.jacobian(q)
        rows = [row for row in range(6) if np.abs(jacobian[row]).max() > 1e-3][: min(2, model.n)]
        mass, jacobian = model.mass_matrix(q), jacobian[rows]
        if not rows or np.linalg.cond(jacobian @ np.linalg.inv(mass) @ jacobian.T) * np.linalg.cond(mass) > 1e6:
            continue
        compared += 1
        inertia = arm.operational_space_inertia(q, rows=rows)
        inverse = arm.dynamically_consistent_inverse(q, rows=rows)
        still, weight = np.zeros(model.n), arm.gravity_torques(q)
        force, tau = model.random.normal(size=len(rows)), model.random.normal(size=model.n)
        moved = jacobian @ arm.forward_dynamics(q, still, weight + jacobian.T @ force)
        np.testing.assert_allclose(inertia @ moved, force, atol=1e-7)
        assert np.allclose(jacobian @ inverse, np.eye(len(rows)), atol=1e-9)
        # torques of the null space do not move the tip
        projected = tau - jacobian.T @ (inverse.T @ tau)
        qdd = arm.forward_dynamics(q, still, weight + projected)
        assert np.abs(jacobian @ qdd).max() <= 1e-7 * max(1, np.abs(qdd).max())
    assert compared > 20


def test_frames_payloads_and_parameters():
    arm = rne.load(DESK)
    q = np.array([[0.4, 0.7, -1.1], [0.2, 1.1, -0.6]])
    body = rne.payload(0.5, [0.0, 0.01, 0.05])
    expected = by_numpy(arm.mass_matrix(q, payload=body), arm.jacobian(q, frame="camera")[:, :3])
    keywords = {"frame": "camera", "rows": [0, 1, 2], "payload": body}
    same(arm.operational_space_inertia(q, **keywords), expected[0], expected[2])
    same(arm.dynamically_consistent_inverse(q, **keywords), expected[1], expected[2])
    # a state for all payloads, and a payload for all states
    many = arm.operational_space_inertia(q[0], rows=[2], payload=[[m, 0, 0, 0] for m in (0.0, 1.0, 2.0)])
    assert many.shape == (3, 1, 1) and (np.diff(many[:, 0, 0]) > 0).all()
    assert np.array_equal(many[0], arm.operational_space_inertia(q[0], rows=[2]))
    one = arm.operational_space_inertia(q[1], **keywords)
    assert one.shape == (3, 3) and np.array_equal(one, arm.operational_space_inertia(q, **keywords)[1])


def test_precision_and_out():
    arm = rne.robots.panda
    q = np.array([[0.3, -0.8, 0.5, -1.9, 0.2, 1.4, -0.6]])
    double, single = arm.operational_space_inertia(q), arm.operational_space_inertia(q.astype(np.float32))
    assert double.dtype == np.float64 and single.dtype == np.float32
    assert np.abs(single - double).max() < 1e-4 * np.abs(double).max()
    mixed = arm.operational_space_inertia(q.astype(np.float32), payload=rne.payload(0.0))
    assert mixed.dtype == np.float64 and np.abs(mixed - double).max() < 1e-4 * np.abs(double).max()
    room = np.empty((1, 7, 6))
    assert arm.dynamically_consistent_inverse(q, out=room) is room
    assert np.array_equal(room, arm.dynamically_consistent_inverse(q))
    with pytest.raises(ValueError, match=r"shape \(1, 6, 6\)"):
        arm.operational_space_inertia(q, out=room)
    assert arm.operational_space_inertia(np.empty((0, 7))).shape == (0, 6, 6)


def test_rows_that_no_arm_has():
    arm = rne.robots.planar2
    with pytest.raises(ValueError, match=r"2 joints move the tip, so 6 rows .* name at most 2 rows that"):
        arm.operational_space_inertia([0.1, 0.2])
    for rows in ([], [0, 6], [1, 1], [-1]):
        with pytest.raises(ValueError, match="write different numbers from 0 to 5"):
            arm.dynamically_consistent_inverse([0.1, 0.2], rows=rows)
    with pytest.raises(ValueError, match="each joint names its link frame"):
        arm.operational_space_inertia([0.1, 0.2], frame="camera", rows=[0, 1])


def test_a_singular_pose_is_no_error_and_spares_other_states():
    q = np.array([[0.4, 0.0], [0.4, 1.0]])
    found = rne.robots.planar2.operational_space_inertia(q, rows=[0, 1])
    assert not (np.abs(found[0]) < 1e10).all() and (np.abs(found[1]) < 100).all()
    assert not np.isfinite(rne.robots.planar2.operational_space_inertia(q[1], rows=[0, 2])).all()
