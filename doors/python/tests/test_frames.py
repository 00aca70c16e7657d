"""Functions at named frames: laws by numpy, and what a wrong name says."""

from pathlib import Path

import numpy as np
import pytest

import rne

TEXT = (Path(__file__).parents[3] / "docs" / "desk_arm_frames.yaml").read_text(encoding="utf-8")
Q, QD = np.array([0.4, 0.7, -1.1]), np.array([0.9, -0.5, 1.3])
FRAMES = ["camera", "gripper", "table", "waist", "shoulder", "elbow"]


@pytest.fixture(name="arm")
def fixture_arm():
    return rne.load(TEXT)


def test_a_frame_is_a_place_on_its_link(arm):
    elbow = arm.link_poses(Q)[2]
    assert np.allclose(arm.pose(Q, frame="elbow"), elbow, atol=1e-15)
    place = np.eye(4)
    place[:3] = [[1, 0, 0, 0], [0, 0, 1, 0.05], [0, -1, 0, 0]]
    assert np.allclose(arm.pose(Q, frame="camera"), elbow @ place, atol=1e-15)
    assert np.array_equal(arm.pose(Q), arm.forward_kinematics(Q))
    assert np.array_equal(arm.pose(Q, frame="camera"), arm.forward_kinematics(Q, frame="camera"))


@pytest.mark.parametrize("frame", FRAMES)
def test_jacobians_are_derivatives(arm, frame):
    step = 1e-6
    before, after = (arm.pose(Q + sign * step * QD, frame=frame) for sign in (-1, 1))
    velocity = arm.jacobian(Q, frame=frame) @ QD
    assert np.allclose((after - before)[:3, 3] / (2 * step), velocity[:3], atol=1e-9)
    turning = (after - before)[:3, :3] / (2 * step) @ arm.pose(Q, frame=frame)[:3, :3].T
    assert np.allclose([turning[2, 1], turning[0, 2], turning[1, 0]], velocity[3:], atol=1e-9)
    before, after = (arm.jacobian(Q + sign * step * QD, frame=frame) @ QD for sign in (-1, 1))
    assert np.allclose((after - before) / (2 * step), arm.jacobian_rate_times_velocity(Q, QD, frame=frame), atol=1e-8)
    before, after = (arm.jacobian(Q + sign * step * QD, frame=frame) for sign in (-1, 1))
    rate = arm.jacobian_rate(Q, QD, frame=frame)
    assert np.allclose((after - before) / (2 * step), rate, atol=1e-8)
    assert np.allclose(arm.jacobian_derivatives(Q, frame=frame) @ QD, rate, atol=1e-14)


@pytest.mark.parametrize("frame", FRAMES)
def test_torques_of_a_wrench(arm, frame):
    wrench = np.array([2.0, -1.5, 4.0, 0.3, 0.7, -0.2])
    turn = arm.pose(Q, frame=frame)[:3, :3]
    world = np.concatenate([turn @ wrench[:3], turn @ wrench[3:]])
    expected = arm.jacobian(Q, frame=frame).T @ world
    assert np.allclose(arm.wrench_torques(Q, wrench, frame=frame), expected, atol=1e-14)


def test_many_states_are_computed_at_once(arm):
    many = np.random.default_rng(1).normal(size=(50, 3))
    jacobians = arm.jacobian(many, frame="camera")
    assert jacobians.shape == (50, 6, 3)
    assert np.array_equal(jacobians[7], arm.jacobian(many[7], frame="camera"))


@pytest.mark.parametrize("frame", [3, b"camera", ["camera"]])
def test_a_frame_that_is_no_name_lists_the_names(arm, frame):
    calls = [
        lambda: arm.pose(Q, frame=frame),
        lambda: arm.jacobian(Q, frame=frame),
        lambda: arm.wrench_torques(Q, np.zeros(6), frame=frame),
        lambda: arm.pose_error(Q, np.eye(4), frame=frame),
        lambda: arm.operational_space_inertia(Q, rows=[0], frame=frame),
        lambda: arm.dynamically_consistent_inverse(Q, rows=[0], frame=frame),
    ]
    for call in calls:
        with pytest.raises(TypeError) as refused:
            call()
        for part in (f"`frame` is {frame!r}", "the name of a frame", *(f"`{name}`" for name in FRAMES)):
            assert part in str(refused.value)


def test_a_wrong_name_lists_the_names(arm):
    with pytest.raises(ValueError, match="did you mean `camera`"):
        arm.jacobian(Q, frame="camra")
    with pytest.raises(ValueError, match="each joint names its link frame"):
        rne.robots.puma560.pose(np.zeros(6), frame="camera")


def test_links_of_a_urdf_are_frames():
    text = """<robot name="one"><link name="base"/><link name="rod"><inertial><mass value="1"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link><link name="lens"/>
      <joint name="hinge" type="continuous"><parent link="base"/><child link="rod"/><axis xyz="0 0 1"/></joint>
      <joint name="glue" type="fixed"><parent link="rod"/><child link="lens"/><origin xyz="0.5 0 0"/></joint></robot>"""
    arm = rne.load(text)
    assert np.allclose(arm.pose(np.array([np.pi / 2]), frame="lens")[:3, 3], [0, 0.5, 0], atol=1e-15)
    assert np.allclose(arm.jacobian(np.array([0.0]), frame="lens")[:, 0], [0, 0.5, 0, 0, 0, 1], atol=1e-15)
