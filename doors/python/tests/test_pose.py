"""Logarithms and errors of poses, by numpy: Rodrigues' formula, and the exponential as a power series."""

import pickle
import warnings

import numpy as np
import pytest

import rne
from oracle import RandomArm


def skew(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def exponential(twist):
    """exp of a twist: its power series for a 1024th, squared ten times."""
    m = np.zeros((4, 4))
    m[:3, :3], m[:3, 3] = skew(twist[3:]), twist[:3]
    m /= 1024
    pose, term = np.eye(4), np.eye(4)
    for n in range(1, 12):
        term = term @ m / n
        pose = pose + term
    for _ in range(10):
        pose = pose @ pose
    return pose


def twists(angle, count=50):
    random = np.random.default_rng(5)
    axes = random.normal(size=(count, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    return np.hstack([random.uniform(-2, 2, (count, 3)), angle * axes])


@pytest.mark.parametrize("angle", [0.0, 1e-9, 1e-3, 0.3, 1.5, 3.0, np.pi - 1e-3])
def test_log_undoes_the_exponential(angle):
    given = twists(angle)
    poses = np.stack([exponential(twist) for twist in given])
    found = rne.pose_log(poses)
    assert found.shape == (50, 6)
    # beside pi, a rounding of the matrix turns the axis by its 1000-fold
    assert np.abs(found - given).max() < (1e-12 if angle < 3.1 else 1e-9)
    assert np.array_equal(rne.pose_log(poses[7]), found[7])
    assert np.array_equal(rne.pose_log(poses.reshape(5, 10, 4, 4)), found.reshape(5, 10, 6))


def test_half_a_turn_has_a_logarithm():
    pose = np.diag([-1.0, -1.0, 1.0, 1.0])
    assert np.allclose(np.abs(rne.pose_log(pose)), [0, 0, 0, 0, 0, np.pi], atol=1e-15)


def test_error_leads_to_the_target():
    for seed in range(10):
        given = RandomArm(seed)
        arm = rne.load(given.yaml())
        random = np.random.default_rng(seed)
        q, other = random.uniform(-1, 1, (2, 20, arm.dof))
        here, target = arm.forward_kinematics(q), arm.forward_kinematics(other)
        error = arm.pose_error(q, target)
        assert error.shape == (20, 6)
        assert np.abs(error[:, :3] - (target - here)[:, :3, 3]).max() < 1e-14
        for one, a, b in zip(error, here, target):
            turned = exponential(np.concatenate([np.zeros(3), one[3:]]))[:3, :3] @ a[:3, :3]
            assert np.abs(turned - b[:3, :3]).max() < 1e-12
        # rows are those of the Jacobian: a small step of the joints
        step = 1e-6 * random.normal(size=arm.dof)
        moved = arm.pose_error(q[0], arm.forward_kinematics(q[0] + step))
        assert np.abs(moved - arm.jacobian(q[0]) @ step).max() < 1e-9
        assert np.array_equal(arm.pose_error(q[3], target), np.stack([arm.pose_error(q[3], one) for one in target]))
        joint = arm.joints[0]
        frame = arm.forward_kinematics(q, frame=joint)
        assert np.abs(arm.pose_error(q, frame, frame=joint)).max() < 1e-14


def test_shapes_and_names_are_told():
    arm = rne.robots.puma560
    with pytest.raises(ValueError, match="shape \\(4, 4\\) or \\(N, 4, 4\\)"):
        arm.pose_error([0] * 6, [0.1, 0.2, 0.3])
    with pytest.raises(ValueError, match="one for each state, \\(2, 4, 4\\)"):
        arm.pose_error(np.zeros((2, 6)), np.stack([np.eye(4)] * 3))
    with pytest.raises(ValueError, match="elbo"):
        arm.pose_error([0] * 6, np.eye(4), frame="elbo")
    with pytest.raises(ValueError, match="`pose` has the shape"):
        rne.pose_log(np.eye(3))
    for wrong in (np.diag([1.1, 1.1, 1.1, 1]), np.diag([1, 1, -1, 1.0]), np.zeros((4, 4))):
        with pytest.raises(ValueError, match="the rotation of `target`, state 0, is none"):
            arm.pose_error([0] * 6, wrong)
    assert np.isnan(arm.pose_error([np.nan] + [0] * 5, np.eye(4))).any()


def test_rows_that_too_few_joints_move_are_refused():
    arm = rne.robots.puma560
    fourth = arm.joints[3]
    with pytest.raises(ValueError, match=f"4 joints move the frame `{fourth}`.*at most 4 rows"):
        arm.operational_space_inertia([0.1] * 6, frame=fourth)
    assert arm.operational_space_inertia([0.1, 0.2, 0.3, 0.4, 0, 0], frame=fourth, rows=[0, 1, 2]).shape == (3, 3)


def test_limits_and_friction_that_no_joint_has_are_told():
    arm = rne.load(
        "format: 1\nname: bare\nsource: own\nconvention: standard\ngravity: [0, -9.81, 0]\njoints:\n"
        "  - {type: revolute, dh: {theta: 0, d: 0, a: 0.8, alpha: 0}, link: {mass: 2, com: [-0.4, 0, 0], inertia: {zz: 0.1, yy: 0.1}}}\n"
    )
    start = [0.0], [0.0], [[1.0]] * 3, 0.001
    with pytest.warns(UserWarning, match="the samples are not limited"):
        arm.rollout(*start, limits=["effort"])
    with pytest.warns(UserWarning, match="the samples have no friction"):
        arm.rollout(*start, friction=0.05)


def test_a_step_that_is_too_long_for_the_friction_is_told():
    arm = rne.load(
        "format: 1\nname: light\nsource: own\nconvention: standard\ngravity: [0, 0, -9.81]\njoints:\n"
        "  - {type: revolute, dh: {theta: 0, d: 0, a: 0.1, alpha: 0}, link: {mass: 0.01, inertia: {zz: 1e-6}},\n"
        "     motor: {viscous: 10}}\n"
    )
    tau = np.zeros((3, 2000, 1))
    tau[1:] = 1.0
    with pytest.warns(UserWarning, match=r"the state of sample 1 is not finite after step \d+ .*2 samples.*shorter"):
        q, qd = arm.rollout([0.0], [0.0], tau, 0.01, friction=0.05)
    assert np.isfinite(q[0]).all() and not np.isfinite(q[1]).all()
    first = int(np.argmin((np.isfinite(q[1]) & np.isfinite(qd[1])).all(axis=1)))
    with pytest.warns(UserWarning, match=f"after step {first} "):
        arm.rollout([0.0], [0.0], tau, 0.01, friction=0.05)
    # arguments that are no numbers are not the fault of the step
    tau[0, 0] = np.nan
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        arm.rollout([0.0], [0.0], tau, 0.01, friction=0.05)


URDF = """<robot name="r"><link name="base"/><link name="a"><inertial><mass value="1"/>
<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link><link name="eye"/>
<joint name="j" type="revolute"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="f" type="fixed"><parent link="a"/><child link="eye"/><origin xyz="0.1 0 0.2"/></joint></robot>"""


def test_an_import_keeps_its_frames_and_notes():
    arm = rne.load(URDF)
    assert "eye" in arm.frames, arm.frames
    assert all(isinstance(note, str) for note in arm.notes)
    again = pickle.loads(pickle.dumps(arm))
    assert (again.frames, again.notes) == (arm.frames, arm.notes)
    assert not any("snapped" in note for note in arm.notes)
    rounded = URDF.replace('xyz="0.1 0 0.2"', 'xyz="0.1 0 0.2" rpy="1.5708 0 0"')
    [note] = [note for note in rne.load(rounded).notes if "angles snapped" in note]
    assert "torques move by" in note and "`snap=False`" in note
    assert not any("snapped" in note for note in rne.load(rounded, snap=False).notes)
    assert rne.robots.puma560.notes == [] == rne.robots.puma560.frames
    assert rne.__version__.count(".") == 2
