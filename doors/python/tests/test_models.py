"""Arms of models in memory: torques of MuJoCo and Pinocchio."""

import warnings
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
    close(rne.from_mujoco(model, rotors=False).inverse_dynamics(q, qd, qdd), tau)
    armature = model.dof_armature.copy()
    for k in range(model.nu):
        armature[model.jnt_dofadr[model.actuator_trnid[k, 0]]] += (
            model.actuator_gear[k, 0] ** 2 * model.actuator_armature[k])
    close(arm.inverse_dynamics(q, qd, qdd), tau + armature * qdd)


def test_mujoco_is_refused():
    mujoco = pytest.importorskip("mujoco")
    text = (MODELS / "geoms.xml").read_text().replace(
        "</mujoco>", "<equality><weld body1='a' body2='d'/></equality></mujoco>")
    with pytest.raises(rne.RobotFileError, match="leave no joint that moves"):
        rne.from_mujoco(mujoco.MjModel.from_xml_string(text))
    # the element has its name, and no line of a text that nobody has written is shown
    text = PENDULUM.format(joint="", body="", more='<tendon><fixed name="t"><joint joint="j" coef="1"/></fixed></tendon>'
                           '<equality><tendon name="c" tendon1="t"/></equality>')
    with pytest.raises(rne.RobotFileError, match="the equality `c` is of the kind `tendon`") as refusal:
        rne.from_mujoco(mujoco.MjModel.from_xml_string(text))
    assert "-->" not in str(refusal.value) and "^" not in str(refusal.value) and "<" not in str(refusal.value)


#: A pendulum on a heavy foot, with attributes of the joint and the body, and sections.
PENDULUM = """<mujoco model="pendulum"><worldbody><body name="foot"><inertial pos="0 0 0" mass="3" diaginertia="1 1 1"/>
<body name="a" {body}><joint name="j" axis="0 1 0" {joint}/><inertial pos="0 0.1 1" mass="1" diaginertia="1 1 1"/>
<body name="b"><joint name="k" axis="1 0 0"/><inertial pos="0 0 1" mass="1" diaginertia="1 1 1"/></body>
</body></body></worldbody>{more}</mujoco>"""
OF_TENDON = '<tendon><fixed name="t" {}><joint joint="j" coef="1"/><joint joint="k" coef="-1"/></fixed></tendon>'
ON_MOCAP = PENDULUM.replace("<worldbody>", '<worldbody><body name="hand" mocap="true"/>')


@pytest.mark.parametrize("joint, body, more, part, differs", [
    ("", "", "", "its mass of 3 kg is left out", False),
    ('armature="2"', "", "", "the inertia of a rotor", False),
    ("", "", OF_TENDON.format(""), "tendons are left out: `t`", False),
    ("", "", OF_TENDON.format('armature="0.5"'), "armature of tendons are left out", True),
    ("", "", OF_TENDON.format('stiffness="3"'), "armature of tendons are left out", True),
    ("", "", OF_TENDON.format('damping="3"'), "armature of tendons are left out", True),
    ("", "", '<option density="1000" viscosity="0.1"/>', "forces of a fluid are left out", True),
    ('stiffness="3"', "", "", "springs of joints are left out", True),
    ('damping="0 2"', "", "", "of higher degree are left out", True),
    ("", 'gravcomp="0.5"', "", "forces that compensate gravity", True),
    ("", "", '<actuator><motor name="m" joint="j" damping="2"/></actuator>', "forces that damp actuators", True),
    ("", "", '<equality><joint name="e" joint1="j" joint2="k" active="false"/></equality>', "not active", False),
    ("", "", '<equality><weld name="w" body1="hand" body2="b"/></equality>', "a motion capture moves are left out", False),
])
def test_remarks_and_torques_of_mujoco(joint, body, more, part, differs):
    """A file and its model have the same remarks. Torques are those of `mj_inverse`, or a warning says why not."""
    mujoco = pytest.importorskip("mujoco")
    text = (ON_MOCAP if "hand" in more else PENDULUM).format(joint=joint, body=body, more=more)
    model = mujoco.MjModel.from_xml_string(text)
    told = []
    for load in (lambda: rne.load(text, whole=True, snap=False), lambda: rne.from_mujoco(model)):
        with warnings.catch_warnings(record=True) as warned:
            warnings.simplefilter("always")
            arm = load()
        warned = [str(warning.message) for warning in warned if "left out" in str(warning.message)]
        assert any(part in warning for warning in warned) == differs, (warned, arm.notes)
        told.append((sorted(arm.notes), sorted(warned)))
        assert any(part in note for note in arm.notes), arm.notes
        q, qd, qdd = states(arm)
        data = mujoco.MjData(model)
        data.qpos[:], data.qvel[:], data.qacc[:] = q, qd, qdd
        model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
        mujoco.mj_inverse(model, data)
        difference = np.abs(arm.inverse_dynamics(q, qd, qdd) - data.qfrc_inverse).max()
        assert (difference > 1e-6) == differs, difference
        columns = np.zeros((model.nv, model.nv))
        for column, unit in zip(columns, np.eye(model.nv)):
            mujoco.mj_mulM(model, data, column, unit)
        if "tendon" not in more:
            close(arm.mass_matrix(q), columns)
    assert told[0] == told[1]


def test_loops_of_mujoco():
    """Loops of a model are those of its file."""
    mujoco = pytest.importorskip("mujoco")
    text = """<mujoco><worldbody>
    <body name="a"><joint name="p" axis="0 1 0"/><inertial pos="0 0 .5" mass="1" diaginertia="1 1 1"/>
    <body name="c" pos="0 0 1"><joint name="r" axis="0 1 0"/><inertial pos=".5 0 0" mass="1" diaginertia="1 1 1"/></body>
    </body>
    <body name="b" pos="1 0 0"><joint name="s" axis="0 1 0"/><inertial pos="0 0 .5" mass="1" diaginertia="1 1 1"/></body>
    </worldbody><actuator><motor joint="p"/></actuator>
    <equality><connect name="pin" body1="c" body2="b" anchor="1 0 0"/></equality></mujoco>"""
    file, model = rne.load(text, whole=True, snap=False), rne.from_mujoco(mujoco.MjModel.from_xml_string(text))
    assert (file.joints, file.passive_joints) == (model.joints, model.passive_joints) and model.passive_joints
    q, passive = model.closures[0]
    state = q, passive, [0.3], [0.5]
    close(file.inverse_dynamics_of_loops(*state), model.inverse_dynamics_of_loops(*state))


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
    arm = rne.from_pinocchio(model)
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
