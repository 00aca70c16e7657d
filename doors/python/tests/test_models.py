"""Arms of models in memory: torques of MuJoCo and Pinocchio."""

import re
import warnings
from pathlib import Path

import numpy as np
import pytest

import rne

MODELS = Path(__file__).parents[3] / "import/tests/mjcf"


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
    more = OF_TENDON.format("") + '<equality><tendon name="c" tendon1="t"/></equality>'
    text = PENDULUM.format(joint="", body="", more=more)
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
    ("", "", '<equality><weld name="w" body1="hand" body2="b"/></equality>', "capture moves are left out", False),
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
    <body name="c" pos="0 0 1"><joint name="r" axis="0 1 0"/>
    <inertial pos=".5 0 0" mass="1" diaginertia="1 1 1"/></body>
    </body>
    <body name="b" pos="1 0 0"><joint name="s" axis="0 1 0"/>
    <inertial pos="0 0 .5" mass="1" diaginertia="1 1 1"/></body>
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
    base = rne.base_from_mujoco(qpos, qvel, qacc, model)
    close(of_base(arm, (qpos[7:], qvel[6:], qacc[6:]), base), tau)
    assert any("floats in the file, so the robot has a floating base" in note for note in arm.notes)
    fixed = rne.from_mujoco(model, floating=False)
    assert "floating_base" in arm.yaml and "floating_base" not in fixed.yaml
    # where it stands in the file, it has the same torques
    qpos, qvel, qacc = np.concatenate([model.qpos0[:7], qpos[7:]]), qvel * 0, qacc * 0
    close(fixed.inverse_dynamics(qpos[7:], qvel[6:], qacc[6:]), mujoco_torques(mujoco, model, qpos, qvel, qacc)[6:])


FREE = """<body name="b" pos="1 2 3" quat="0 1 0 0"><freejoint/><inertial pos="0.1 0.02 0.03" mass="2"
diaginertia="0.1 0.12 0.15"/><body name="l" pos="0 0 0.2"><joint name="j" axis="1 0 0"/><inertial pos="0.1 0.2 0"
mass="1" diaginertia="0.01 0.02 0.02"/></body></body>"""
OTHER = '<body name="ball" pos="4 5 6"><freejoint/><inertial pos="0 0 0" mass="5" diaginertia="1 1 1"/></body>'


@pytest.mark.parametrize("first", ["", OTHER])
@pytest.mark.parametrize("option", ['<option gravity="1 2 -9"/>', '<option><flag gravity="disable"/></option>'])
def test_the_model_says_its_gravity_and_where_its_base_is(first, option):
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_string(f"<mujoco>{option}<worldbody>{first}{FREE}</worldbody></mujoco>")
    arm = rne.from_mujoco(model)
    qpos, qvel, qacc = model.qpos0.copy(), *np.random.default_rng(4).uniform(-1, 1, (2, model.nv))
    qpos[-8:-4], qpos[-1] = [0.1, 0.2, 0.3, 0.5], 0.4
    qpos[-5:-1] = [0.5, -0.5, 0.1, 0.7]
    qpos[-5:-1] /= np.linalg.norm(qpos[-5:-1])
    qvel[:-7] = qacc[:-7] = 0
    expected = mujoco_torques(mujoco, model, qpos, qvel, qacc)[-7:]
    expected[:3] = of_turned(qpos[-5:-1], expected[:3])
    base = rne.base_from_mujoco(qpos, qvel, qacc, model)
    close(of_base(arm, ([qpos[-1]], [qvel[-1]], [qacc[-1]]), base), expected)
    many = rne.base_from_mujoco(*(np.tile(vector, (3, 1)) for vector in (qpos, qvel, qacc)), model)
    assert all((many[name] == base[name]).all() for name in base)


def test_a_model_without_a_floating_base_is_refused():
    mujoco = pytest.importorskip("mujoco")
    two = FREE + FREE.replace('"b"', '"b2"').replace('"l"', '"l2"').replace('"j"', '"j2"')
    model = mujoco.MjModel.from_xml_string(f"<mujoco><worldbody>{two}</worldbody></mujoco>")
    with pytest.raises(ValueError, match="no free joint of the model carries all other joints"):
        rne.base_from_mujoco(model.qpos0, np.zeros(model.nv), np.zeros(model.nv), model)


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


AXIS = np.array([0.36, -0.48, 0.8])
# In Python, the constructor of an unbounded joint takes no axis.
MADE = {
    "HelicalUnaligned": (AXIS, 0.1),
    "RevoluteUnboundedUnaligned": (),
    "Universal": (AXIS, np.array([0.8, 0.6, 0.0])),
    "Ellipsoid": (1.0, 2.0, 3.0),
}


def three_joints(pin, kind, leader=None):
    """A model in which a joint of this type stands between two revolute ones, and follows the first one, if that has
    the type `leader`."""
    given = MADE.get(kind, (AXIS,) if kind.endswith("Unaligned") else (0.1,) if kind[0] == "H" else ())
    middle = getattr(pin, f"JointModel{kind}")(*given)
    if kind == "Composite":
        middle.addJoint(pin.JointModelRX())
    if leader:
        middle = pin.JointModel(middle)
        middle.setIndexes(1, 0, 0)
        middle = pin.JointModelMimic(middle, -1.5, 0.3)
    model = pin.Model()
    random = np.random.default_rng(6)
    for index, joint in enumerate([getattr(pin, f"JointModel{leader or 'RX'}")(), middle, pin.JointModelRZ()]):
        place = pin.SE3(pin.Quaternion(random.normal(size=4)).normalized().matrix(), random.normal(size=3))
        index = model.addJoint(index, joint, place, f"j{index}")
        model.appendBodyToJoint(index, pin.Inertia(2.0, random.normal(size=3), np.diag([2.0, 2.5, 3.0])), place)
    return model


def types(pin):
    return [name.removeprefix("JointModel") for name in dir(pin) if name.startswith("JointModel") and len(name) > 10]


@pytest.mark.filterwarnings("error:.*degrees")
def test_every_type_of_joint_is_right_or_refused_by_name():
    """No limit is a number in degrees, either: Pinocchio's largest number is none."""
    pin = pytest.importorskip("pinocchio")
    read = []
    for kind in sorted(set(types(pin)) - {"Mimic"}):
        for leader in (None, "RX", "RUBX"):
            try:
                model = three_joints(pin, kind, leader)
            except Exception:  # a joint of several freedoms cannot follow
                assert leader, kind
                continue
            try:
                arm = rne.from_pinocchio(model)
            except ValueError as refusal:
                of = f"JointModelMimic of a JointModel{kind}" if leader else f"JointModel{kind}"
                assert f"the joint 'j1' is a {of}" in str(refusal), refusal
                continue
            read.append((kind, leader))
            q, qd, qdd = states(arm)
            close(arm.inverse_dynamics(q, qd, qdd), pinocchio_torques(pin, model, q, qd, qdd))
    kinds = [kind + axis for kind in ("P", "R") for axis in "XYZ"] + ["PrismaticUnaligned", "RevoluteUnaligned"]
    unbounded = ["RUBX", "RUBY", "RUBZ", "RevoluteUnboundedUnaligned"]
    followers = [(kind, "RX") for kind in kinds] + [(kind, "RUBX") for kind in unbounded]
    assert set(read) == {*((kind, None) for kind in kinds + unbounded), *followers}


def test_a_root_that_is_no_free_flyer_is_refused():
    pin = pytest.importorskip("pinocchio")
    text = URDF.format(links="".join(LINK.format(i) for i in range(1, 6)))
    model = pin.buildModelFromXML(text, pin.JointModelPlanar())
    with pytest.raises(ValueError, match="'root_joint' is a JointModelPlanar"):
        rne.from_pinocchio(model)
    with pytest.raises(ValueError, match="no free flyer of the model carries all other joints"):
        rne.base_from_pinocchio(np.zeros(model.nq), np.zeros(model.nv), np.zeros(model.nv), model)


PLACED = '<origin xyz="0.1 0.2 0.3" rpy="1.5707963267948966 0.2 -0.4"/>'


@pytest.mark.parametrize("placed", ["", "by the model", "by the file"])
def test_pinocchio_floats(placed):
    """A free-flyer gives a floating base, also in a frame that is turned, and `floating=False` fixes it."""
    pin = pytest.importorskip("pinocchio")
    text = URDF.format(links="".join(LINK.format(i) for i in range(1, 6)))
    text = text.replace('<link name="base"/>', LINK.format(6).replace("l6", "base"))
    if placed == "by the file":
        text = re.sub("<mimic.*?/>", "", text)  # which Pinocchio and rne count differently
        root = f'<joint name="root" type="floating">{PLACED}<parent link="world"/><child link="base"/></joint>'
        text = text.replace('<robot name="r">', f'<robot name="r"><link name="world"/>{root}')
        model = pin.buildModelFromXML(text)
        arms = [rne.from_pinocchio(model, tip="hand"), rne.load(text, whole=True, tip="hand", snap=False)]
        note = "the floating joint of `base` has the placement xyz [0.1, 0.2, 0.3] m, rpy [1.57"
        assert any(note in remark for remark in arms[1].notes), arms[1].notes
    else:
        model = pin.buildModelFromXML(text, pin.JointModelFreeFlyer())
        if placed:
            model.jointPlacements[1] = pin.SE3(pin.rpy.rpyToMatrix(0.3, -1.0, 2.0), np.array([1.0, 2.0, 3.0]))
            model.gravity.linear = np.array([1.0, 2.0, -9.0])
        arms = [rne.from_pinocchio(model, tip="hand")]
    # held where the model has it
    held = rne.from_pinocchio(model, tip="hand", floating=False)
    full = pin.neutral(model)
    full[7:] = pin.integrate(model, full, np.concatenate([np.zeros(6), states(held)[0]]))[7:]
    zero = np.zeros(model.nv)
    close(held.gravity_torques(states(held)[0]), pin.rnea(model, model.createData(), full, zero, zero)[6:])
    for arm in arms:
        floats(pin, model, arm)


def test_a_free_flyer_is_found_behind_another():
    pin = pytest.importorskip("pinocchio")
    model = pin.Model()
    box = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "box")
    model.appendBodyToJoint(box, pin.Inertia.FromBox(3.0, 1.0, 2.0, 3.0), pin.SE3.Identity())
    base = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3(pin.rpy.rpyToMatrix(1.0, 2.0, 3.0), np.ones(3)), "base")
    hinge = model.addJoint(base, pin.JointModelRX(), pin.SE3(np.eye(3), np.ones(3)), "hinge")
    for joint in (base, hinge):
        model.appendBodyToJoint(joint, pin.Inertia.FromBox(2.0, 1.0, 2.0, 3.0), pin.SE3(np.eye(3), np.ones(3)))
    arm = rne.from_pinocchio(model)
    random = np.random.default_rng(7)
    q = pin.integrate(model, pin.neutral(model), random.normal(size=model.nv))
    v, a = random.normal(size=(2, model.nv))
    found = of_base(arm, (q[14:], v[12:], a[12:]), rne.base_from_pinocchio(q, v, a, model))
    close(found, pin.rnea(model, model.createData(), q, v, a)[6:])


def floats(pin, model, arm):
    state = q, qd, qdd = states(arm)
    full = pin.integrate(model, pin.neutral(model), np.concatenate([[0.4, 0.5, 0.6, 0.7, 0.8, 0.9], q]))
    v, a = np.concatenate([[0.1, -0.2, 0.3, -0.4, 0.5, 0.6], qd]), np.concatenate([[1, 2, -3, 4, -5, 6], qdd])
    base = rne.base_from_pinocchio(full, v, a, model)
    close(of_base(arm, state, base), pin.rnea(model, model.createData(), full, v, a))
    assert "floating_base" not in rne.from_pinocchio(model, tip="hand", floating=False).yaml
    # its derivatives turn with the same gravity
    data = model.createData()  # in which the matrices live
    by = pin.computeRNEADerivatives(model, data, full, v, a)
    derivatives = arm.floating_inverse_dynamics_derivatives(*state, **base)
    found = rne.derivatives_to_pinocchio(derivatives, arm.floating_mass_matrix(q), full, v, model)
    for one, other in zip(found, by):
        close(one, other)
