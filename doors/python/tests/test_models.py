"""Arms of models in memory: torques of MuJoCo and Pinocchio."""

from pathlib import Path

import numpy as np
import pytest

import rne

MODELS = Path(__file__).parents[3] / "rne-convert/tests/mjcf"


def states(arm):
    return np.random.default_rng(3).uniform(-1, 1, (3, arm.dof))


def close(found, expected):
    assert np.abs(found - expected).max() <= 1e-10 * np.abs(expected).max(), (found, expected)


def mujoco_torques(mujoco, model, q, qd, qdd):
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:], data.qacc[:] = q, qd, qdd
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    mujoco.mj_comVel(model, data)
    tau = np.zeros(model.nv)
    mujoco.mj_rne(model, data, 1, tau)
    return tau


@pytest.mark.parametrize("name", ["classes", "geoms"])
def test_mujoco(name):
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_path(str(MODELS / f"{name}.xml"))
    arm = rne.from_mujoco(model)
    assert arm.joints == [model.joint(i).name for i in range(model.njnt)]
    q, qd, qdd = states(arm)
    tau = mujoco_torques(mujoco, model, q, qd, qdd)
    close(arm.inverse_dynamics(q, qd, qdd), tau)
    armature = model.dof_armature.copy()
    for k in range(model.nu):
        armature[model.jnt_dofadr[model.actuator_trnid[k, 0]]] += (
            model.actuator_gear[k, 0] ** 2 * model.actuator_armature[k])
    close(rne.from_mujoco(model, rotors=True).inverse_dynamics(q, qd, qdd), tau + armature * qdd)


def test_mujoco_is_refused():
    mujoco = pytest.importorskip("mujoco")
    text = (MODELS / "geoms.xml").read_text().replace(
        "</mujoco>", "<equality><weld body1='a' body2='d'/></equality></mujoco>")
    with pytest.raises(rne.RobotFileError, match="leave no joint that moves"):
        rne.from_mujoco(mujoco.MjModel.from_xml_string(text))


def of_base(arm, state, base):
    """Force, moment and torques, in one vector."""
    wrench, tau = arm.inverse_dynamics_of_floating_base(*state, **base)
    return np.concatenate([wrench, tau])


def of_turned(quaternion, force):
    """A force in world axes, in those of the base with this orientation (w, x, y, z)."""
    w, v = quaternion[0], -np.asarray(quaternion[1:])
    return force + 2 * np.cross(v, np.cross(v, force) + w * force)


def test_mujoco_floats():
    """A free joint gives a floating base, and `floating=False` fixes it."""
    mujoco = pytest.importorskip("mujoco")
    text = (MODELS / "geoms.xml").read_text().replace('<joint name="j1" axis="0 1 0"/>', "<freejoint/>")
    text = text.replace('<body name="a">', '<body name="a" pos="1 2 3" euler="0.7 -0.4 0.3">')
    model = mujoco.MjModel.from_xml_string(text)
    arm = rne.from_mujoco(model)
    qpos, qvel, qacc = np.random.default_rng(4).uniform(-1, 1, (3, model.nv + 1))
    qpos[3:7] /= np.linalg.norm(qpos[3:7])
    qvel, qacc = qvel[:-1], qacc[:-1]
    tau = mujoco_torques(mujoco, model, qpos, qvel, qacc)
    tau[:3] = of_turned(qpos[3:7], tau[:3])
    base = rne.base_from_mujoco(qpos, qvel, qacc, gravity=model.opt.gravity)
    close(of_base(arm, (qpos[7:], qvel[6:], qacc[6:]), base), tau)
    assert any("floats in the file, so the robot has a floating base" in note for note in arm.notes)
    fixed = rne.from_mujoco(model, floating=False)
    assert "floating_base" in arm.yaml and "floating_base" not in fixed.yaml
    # where it stands in the file, it has the same torques
    qpos, qvel, qacc = np.concatenate([model.qpos0[:7], qpos[7:]]), qvel * 0, qacc * 0
    close(fixed.inverse_dynamics(qpos[7:], qvel[6:], qacc[6:]), mujoco_torques(mujoco, model, qpos, qvel, qacc)[6:])


def test_mujoco_couples():
    """The follower's torque acts on the joint that it follows, times the ratio."""
    mujoco = pytest.importorskip("mujoco")
    text = (MODELS / "gripper.xml").read_text().replace("<freejoint/>", "")
    for part in ("classes", "fingers"):
        parts = (MODELS / f"parts/gripper_{part}.xml").read_text()
        inner = parts.split("<mujocoinclude>")[1].split("</mujocoinclude>")[0]
        text = text.replace(f'<include file="parts/gripper_{part}.xml"/>', inner)
    model = mujoco.MjModel.from_xml_string(text)
    arm = rne.from_mujoco(model)
    assert arm.joints == ["wrist", "left"]
    (wrist, left), qd, qdd = states(arm)
    right = 0.035 - 0.5 * left
    q = [wrist, left, right, 0.2 + 30 * (right - 0.02), 0.8]
    turn = np.array([[1, 0], [0, 1], [0, -0.5], [0, -15], [0, 0]])
    tau = mujoco_torques(mujoco, model, q, turn @ qd, turn @ qdd)
    close(arm.inverse_dynamics([wrist, left], qd, qdd), turn.T @ tau)


URDF = """<robot name="r"><link name="base"/>
{links}
<joint name="a" type="revolute"><origin xyz="0.1 0.2 0.3" rpy="0.4 0.5 0.6"/><parent link="base"/><child link="l1"/>
<axis xyz="1 2 3"/><limit lower="-2" upper="1" effort="7" velocity="3"/>
<dynamics damping="0.5" friction="0.25"/></joint>
<joint name="b" type="prismatic"><origin xyz="0.3 0 0.1" rpy="1 0 2"/><parent link="l1"/><child link="l2"/>
<axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="7" velocity="3"/></joint>
<joint name="c" type="revolute"><origin xyz="0.2 0 0"/><parent link="l2"/><child link="l3"/><axis xyz="0 -1 0.1"/>
<limit lower="-2" upper="1" effort="7" velocity="3"/></joint>
<joint name="d" type="continuous"><origin xyz="0 0.2 0"/><parent link="l2"/><child link="l4"/>
<axis xyz="0 0 1"/></joint>
<joint name="e" type="revolute"><origin xyz="0 0.2 0"/><parent link="l4"/><child link="l5"/><axis xyz="0 -1 0.1"/>
<mimic joint="c" multiplier="-2" offset="0.3"/><limit lower="-9" upper="9" effort="7" velocity="3"/></joint>
<joint name="to_hand" type="fixed"><origin xyz="0 0 0.1"/><parent link="l5"/><child link="hand"/></joint>
<link name="hand"/>
</robot>"""
LINK = (
    "<link name='l{0}'><inertial><origin xyz='0.1 0.0{0} -0.03' rpy='0.1 0 0.2'/><mass value='{0}'/>"
    "<inertia ixx='0.02' iyy='0.03' izz='0.04' ixy='0.001' ixz='-0.002' iyz='0.003'/></inertial></link>"
)


def pinocchio_torques(pin, model, q, qd, qdd):
    full = pin.neutral(model)
    for joint, value in zip([j for j in model.joints[1:] if j.nv], q):
        full[joint.idx_q : joint.idx_q + joint.nq] = [value] if joint.nq == 1 else [np.cos(value), np.sin(value)]
    return pin.rnea(model, model.createData(), full, np.asarray(qd), np.asarray(qdd))


@pytest.mark.parametrize("mimic", [False, True])
def test_pinocchio(mimic):
    pin = pytest.importorskip("pinocchio")
    text = URDF.format(links="".join(LINK.format(i) for i in range(1, 6)))
    model = pin.buildModelFromXML(text, mimic=mimic)
    model.gravity.linear = np.array([1.0, 2.0, -9.0])
    arm = rne.from_pinocchio(model, tip="hand")
    assert arm.joints == [model.names[i] for i in range(1, model.njoints) if model.joints[i].nv]
    assert "hand" in arm.frames
    q, qd, qdd = states(arm)
    tau = pinocchio_torques(pin, model, q, qd, qdd)
    close(arm.inverse_dynamics(q, qd, qdd), tau)
    model.rotorInertia, model.rotorGearRatio = np.full(model.nv, 1e-4), np.full(model.nv, 50.0)
    arm = rne.from_pinocchio(model, rotors=True)
    close(arm.inverse_dynamics(q, qd, qdd), tau + 0.25 * qdd)
    model.armature = np.arange(1.0, model.nv + 1)
    arm = rne.from_pinocchio(model, rotors=True)
    close(arm.inverse_dynamics(q, qd, qdd), pinocchio_torques(pin, model, q, qd, qdd))


def test_pinocchio_is_refused():
    pin = pytest.importorskip("pinocchio")
    text = URDF.format(links="".join(LINK.format(i) for i in range(1, 6)))
    with pytest.raises(ValueError, match="'root_joint' is a JointModelPlanar"):
        rne.from_pinocchio(pin.buildModelFromXML(text, pin.JointModelPlanar()))


def test_pinocchio_floats():
    """A free-flyer gives a floating base, and `floating=False` fixes it."""
    pin = pytest.importorskip("pinocchio")
    text = URDF.format(links="".join(LINK.format(i) for i in range(1, 6)))
    text = text.replace('<link name="base"/>', LINK.format(6).replace("l6", "base"))
    model = pin.buildModelFromXML(text, pin.JointModelFreeFlyer())
    arm = rne.from_pinocchio(model, tip="hand")
    state = q, qd, qdd = states(arm)
    full = pin.integrate(model, pin.neutral(model), np.concatenate([[0.4, 0.5, 0.6, 0.7, 0.8, 0.9], q]))
    v, a = np.concatenate([[0.1, -0.2, 0.3, -0.4, 0.5, 0.6], qd]), np.concatenate([[1, 2, -3, 4, -5, 6], qdd])
    base = rne.base_from_pinocchio(full, v, a, gravity=model.gravity.linear)
    close(of_base(arm, state, base), pin.rnea(model, model.createData(), full, v, a))
    assert "floating_base" not in rne.from_pinocchio(model, tip="hand", floating=False).yaml
