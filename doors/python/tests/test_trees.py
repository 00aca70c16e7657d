"""Trees: random ones against numpy, and a whole URDF against its arms."""

import pickle
from pathlib import Path

import numpy as np
import pytest

import rne
from oracle import RandomTree

TREE = Path(__file__).parents[3] / "docs/tree.yaml"


@pytest.mark.parametrize("part", range(5))
def test_torques_and_matrix(part):
    for seed in range(part * 10, (part + 1) * 10):
        oracle = RandomTree(seed)
        arm = rne.load(oracle.yaml())
        q, qd, qdd = oracle.states(2)
        expected = np.array([oracle.torques(*state) for state in zip(q, qd, qdd)])
        scale = np.abs(expected).max()
        tau = arm.inverse_dynamics(q, qd, qdd)
        assert np.abs(tau - expected).max() <= 1e-12 * scale, seed
        matrices = np.array([oracle.mass_matrix(row) for row in q])
        assert np.abs(arm.mass_matrix(q) - matrices).max() <= 1e-12 * max(scale, np.abs(matrices).max()), seed


def test_kinematics_and_operational_space():
    for seed in range(40):
        oracle = RandomTree(seed)
        arm = rne.load(oracle.yaml())
        q = oracle.states(1)[0, 0]
        frames = oracle.frames(q)
        poses = arm.link_poses(q)
        for pose, (turn, origin, _, _) in zip(poses, frames):
            assert np.allclose(pose[:3, :3], turn, atol=1e-13) and np.allclose(pose[:3, 3], origin, atol=1e-13)
        assert np.allclose(arm.forward_kinematics(q), poses[oracle.tip], atol=1e-13)
        # other joints do not move the tip
        moves = [oracle.carries(joint, oracle.tip) for joint in range(arm.dof)]
        jacobian = arm.jacobian(q)
        assert not jacobian[:, ~np.array(moves)].any()
        count = sum(moves)
        if count < 6:
            with pytest.raises(ValueError, match=f"^{count} joints move the tip"):
                arm.operational_space_inertia(q, rows=range(count + 1))


def test_an_arm_of_a_tree_tells_of_it(tmp_path):
    arm = rne.load(TREE)
    assert arm.joints == ["waist", "left", "finger_a", "finger_b", "right"]
    state = q, qd, qdd = np.random.default_rng(5).normal(size=(3, arm.dof))
    tau = arm.inverse_dynamics(*state)
    assert np.array_equal(pickle.loads(pickle.dumps(arm)).inverse_dynamics(*state), tau)
    assert "<th>on" in arm._repr_html_() and "row of right" in arm._repr_html_()
    assert "finger_b" in arm.report() and "f1,5" in arm.show()
    assert len(arm.base_parameters()) > arm.dof
    # in the order of the alphabet, as another tool has them
    alphabet = np.argsort(arm.joints)
    found = arm.diagnose(q, qd, qdd, tau[alphabet])["explanations"]
    assert "alphabetical order" in found[0][0]
    positions, velocities = arm.rollout(q, qd, tau[None], 1e-3)
    assert np.allclose(velocities[0], qd + 1e-3 * qdd, atol=1e-9 * np.abs(qdd).max())


def urdf():
    """Two arms of two joints on a joint, one of which slides, with a fixed hand."""
    inertial = (
        "<inertial><origin xyz='{0} 0.02 -0.03' rpy='0.1 0 0.2'/><mass value='{1}'/>"
        "<inertia ixx='0.02' iyy='0.03' izz='0.04' ixy='0.001' ixz='-0.002' iyz='0.003'/></inertial>"
    )
    names = ["base", "torso", "a1", "a2", "hand", "b1", "b2"]
    links = "".join(f"<link name='{name}'>{inertial.format(0.1, index + 1)}</link>" for index, name in enumerate(names))
    joints = [
        ("waist", "revolute", "base", "torso", "0 0 0.3", "0 0 0", "0 0 1"),
        ("left", "revolute", "torso", "a1", "0.1 0.2 0.4", "0.3 0 0.1", "0 1 0"),
        ("left_elbow", "revolute", "a1", "a2", "0.3 0 0", "0 0.2 0", "0.6 0.8 0"),
        ("wrist", "fixed", "a2", "hand", "0.2 0 0.1", "0 0 0.5", "0 0 1"),
        ("right", "revolute", "torso", "b1", "0.1 -0.2 0.4", "-0.3 0 0.1", "0 1 0"),
        ("right_slide", "prismatic", "b1", "b2", "0.2 0 0", "0 0.1 0", "1 0 0"),
    ]
    text = "".join(
        f"<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/>"
        f"<origin xyz='{xyz}' rpy='{rpy}'/><axis xyz='{axis}'/>"
        "<limit lower='-2' upper='2' velocity='3' effort='100'/></joint>"
        for name, kind, parent, child, xyz, rpy, axis in joints
    )
    return f"<robot name='two_arms'>{links}{text}</robot>"


def test_a_whole_urdf_has_the_torques_of_its_arms():
    whole = rne.load(urdf(), whole=True, tip="hand")
    assert whole.convention == "modified" and whole.dof == 5
    with pytest.raises(rne.RobotFileError, match="modified"):
        rne.load(urdf(), whole=True, convention="standard")
    random = np.random.default_rng(2)
    for tip, other in [("hand", ["right", "right_slide"]), ("b2", ["left", "left_elbow"])]:
        # the joints of the other arm are held still where they are
        held = dict(zip(other, random.uniform(-1, 1, size=2)))
        arm = rne.load(urdf(), tip=tip, lock=held, snap=False)
        q, qd, qdd = random.normal(size=(3, 4, arm.dof))
        places = [whole.joints.index(name) for name in arm.joints]
        states = np.zeros((3, 4, whole.dof))
        for state, numbers in zip(states, (q, qd, qdd)):
            state[:, places] = numbers
        states[0][:, [whole.joints.index(name) for name in other]] = list(held.values())
        tau, expected = whole.inverse_dynamics(*states)[:, places], arm.inverse_dynamics(q, qd, qdd)
        assert np.abs(tau - expected).max() <= 1e-12 * np.abs(expected).max()
        if tip == "hand":
            assert np.allclose(whole.forward_kinematics(states[0]), arm.forward_kinematics(q), atol=1e-12)


def test_the_root_of_a_whole_urdf_may_float():
    fixed, floating = rne.load(urdf(), whole=True, tip="hand"), rne.load(urdf(), whole=True, floating=True, tip="hand")
    assert "floating_base" in floating.yaml and "floating_base" not in fixed.yaml
    assert (floating.floating, fixed.floating) == (True, False)
    told = "the base stands still: its mass of 1 kg is left out; whole=True, floating=True makes the base float"
    assert told in fixed.notes and told not in floating.notes
    still = np.zeros(5)
    zero = {name: np.zeros(3) for name in ["base_omega", "base_omega_dot", "base_acceleration"]}
    with pytest.raises(ValueError, match="has no `floating_base`.*floating=True"):
        fixed.inverse_dynamics_of_floating_base(still, still, still, base_gravity=[0, 0, -9.81], **zero)
    wrench, tau = floating.inverse_dynamics_of_floating_base(still, still, still, base_gravity=[0, 0, -9.81], **zero)
    # the base weighs 1 kg, each other link what its joint carries
    assert np.isclose(wrench[2], 9.81 * floating.floating_mass_matrix(still)[0, 0])
    assert np.allclose(tau, fixed.gravity_torques(still))
    with pytest.raises(rne.RobotFileError, match="whole=True"):
        rne.load(urdf())
    with pytest.raises(rne.RobotFileError, match="whole=True imports the whole robot"):
        rne.load(urdf(), floating=True, tip="hand", lock_others=True)


GRIPPER = Path(__file__).parents[3] / "docs/gripper.yaml"


def test_a_follower_has_no_place_in_an_order():
    arm = rne.load(GRIPPER)
    names = ["finger_b", "shoulder", "elbow", "finger_a"]
    with pytest.raises(ValueError, match="`finger_b` follows `finger_a`, so q has no element for it; leave it out"):
        arm.order(names)
    assert arm.order(names, extra=True).tolist() == [1, 2, 3]


def test_a_gripper_has_the_torques_of_free_fingers():
    arm = rne.load(GRIPPER)
    assert arm.joints == ["shoulder", "elbow", "finger_a"] and arm.dof == 3
    assert arm.followers == {"finger_b": ({"finger_a": 1.0}, 0.0)} and rne.load("puma560").followers == {}
    assert arm.limits.shape == (3, 2) and arm.limits[2, 1] == 0.04
    # all joints move freely without the list of couplings, the last one of the file
    free = rne.load(GRIPPER.read_text().split("couplings:")[0])
    ratios = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 1]])
    q, qd, qdd = np.random.default_rng(9).normal(size=(3, 5, 3))
    of_all = [x @ ratios.T for x in (q, qd, qdd)]
    tau = arm.inverse_dynamics(q, qd, qdd)
    assert np.abs(tau - free.inverse_dynamics(*of_all) @ ratios).max() <= 1e-12 * np.abs(tau).max()
    matrix = arm.mass_matrix(q)
    assert np.abs(matrix - ratios.T @ free.mass_matrix(of_all[0]) @ ratios).max() <= 1e-12 * np.abs(matrix).max()
    assert np.abs(arm.forward_dynamics(q, qd, tau) - qdd).max() <= 1e-10
    named = dict(zip(arm.joints, q[0]))
    assert np.array_equal(arm.gravity_torques(named), arm.gravity_torques(q[0]))
    with pytest.raises(ValueError, match="finger_b"):
        arm.gravity_torques(named | {"finger_b": 0.0})
    positions, velocities = arm.rollout(q[0], qd[0], tau[:1], 1e-3)
    assert np.allclose(velocities[0], qd[0] + 1e-3 * qdd[0], atol=1e-9)
    with pytest.raises(ValueError, match="finger_b"):
        arm.regressor(q, qd, qdd)


@pytest.mark.filterwarnings("ignore::UserWarning")
def test_a_log_of_a_gripper_has_its_free_joints():
    arm = rne.load(GRIPPER)
    found = rne.excite(arm, seconds=4.0, rate=200.0, range=2.0, velocity=1.0, acceleration=5.0, evaluations=50)
    q, qd, qdd = found.q, found.qd, found.qdd
    assert q.shape == (len(found.time), 3) and [joint["name"] for joint in found.joints] == arm.joints
    tau = arm.inverse_dynamics(q, qd, qdd)
    log = found.columns() | {f"tau{joint + 1}": tau[:, joint] for joint in range(3)}
    identified = rne.identify(arm, log, friction=False, cutoff=10.0)
    errors = np.abs(identified.arm.inverse_dynamics(q, qd, qdd) - tau).max(axis=0)
    assert (errors <= 1e-2 * np.abs(tau).max(axis=0)).all(), errors


def test_wrenches_at_tips_by_name_and_by_array():
    arm = rne.load((TREE.parent / "dual_arm.yaml").read_text(encoding="utf-8"))
    assert arm.tips == ["left_hand", "right_hand"]
    q, qd, qdd = np.random.default_rng(5).normal(size=(3, 4, 5))
    left, right = np.random.default_rng(6).normal(size=(2, 6))
    by_array = arm.inverse_dynamics_with_wrenches(q, qd, qdd, np.stack([left, right]))
    expected = arm.inverse_dynamics(q, qd, qdd)
    for frame, wrench in [("left_hand", left), ("right_hand", right)]:
        expected = expected + arm.wrench_torques(q, wrench, frame=frame)
    assert np.allclose(by_array, expected, atol=1e-12)
    assert np.array_equal(arm.inverse_dynamics_with_wrenches(q, qd, qdd, {"right_hand": right, "left_hand": left}), by_array)
    alone = arm.inverse_dynamics_with_wrenches(q, qd, qdd, {"right_hand": np.tile(right, (4, 1))})
    assert np.allclose(alone, arm.inverse_dynamics(q, qd, qdd) + arm.wrench_torques(q, right, frame="right_hand"), atol=1e-12)
    wrenches = {"left_hand": left.tolist(), "right_hand": right.tolist()}
    assert np.allclose(arm.forward_dynamics_with_wrenches(q, qd, by_array, wrenches), qdd, atol=1e-9)
    with pytest.raises(ValueError, match="there is no tip `hand`; this arm has left_hand, right_hand"):
        arm.inverse_dynamics_with_wrenches(q, qd, qdd, {"hand": left})
    with pytest.raises(ValueError, match="has the shape"):
        arm.inverse_dynamics_with_wrenches(q, qd, qdd, left)


def test_a_tip_whose_name_has_two_meanings_is_refused(tmp_path):
    path = tmp_path / "two.yaml"
    path.write_text("""{format: 2, name: two, source: own, convention: modified, gravity: [0, 0, -9.81],
        frames: [{name: tip, on: j1, xyz: [0.1, 0, 0]}], joints: [
        {name: j1, type: revolute, dh: {theta: 0, d: 0, a: 0, alpha: 0}, link: {mass: 1, inertia: {zz: 0.1}}},
        {name: j2, type: revolute, dh: {theta: 0, d: 0, a: 1, alpha: 0}, link: {mass: 1, inertia: {zz: 0.1}}}]}""")
    with pytest.warns(UserWarning, match="the name of the tip"):
        arm = rne.load(path)
    still, wrench = np.zeros(2), np.array([0.0, 0, 0, 1, 2, 3])
    with pytest.raises(ValueError, match="also a frame of its file"):
        arm.inverse_dynamics_with_wrenches(still, still, still, {"tip": wrench})
    np.testing.assert_allclose(arm.inverse_dynamics_with_wrenches(still, still, still, wrench[None]), [3, 3])
