"""Robots of PyPI through every door that imports a whole robot, beside Pinocchio and MuJoCo.

Usage: python corpora.py [WORD ...]      only files whose path has one of these words; `small-models` is those below

Needs the wheel of rne, and the packages pin, mujoco, example-robot-data, dm_control, gymnasium and robosuite-models;
`cargo xtask urdf --corpora` installs them. Each robot goes through `rne.load` with `whole=True`, which is
`rne import --whole`, and through `rne.from_pinocchio` or `rne.from_mujoco`: on a fixed base, on a floating one, and on
one whose parent frame has a random place and turn in the world. Small models have each type of joint of Pinocchio, and
the ways in which MuJoCo places a free body.

The inverse dynamics at random states, with gravity, must be that of the tool that reads the same robot, to 1e-9 of the
largest torque. Otherwise the door must refuse the robot with a reason. The script prints what is right, what is refused
and why, and what is wrong; one wrong number makes the exit status 1.
"""

import collections
import importlib.util
import multiprocessing
import os
import pathlib
import re
import sys
import warnings
from xml.etree import ElementTree

import mujoco
import numpy as np
import pinocchio as pin

import mjcf
import rne

# Its warnings would go to a file in the current folder.
mujoco.set_mju_user_warning(lambda message: None)

TOLERANCE = 1e-9
STATES = 2
GRAVITY = np.array([1.0, -2.0, -9.0])
RANDOM = np.random.default_rng(5)
PACKAGES = ["dm_control", "gymnasium", "robosuite_models"]

# Of each door: the names of the robots by verdict, with the reason or the error.
VERDICTS = collections.defaultdict(list)


class Wrong(Exception):
    """A number that is not that of the other tool."""


def judged(door, name, peer, make, compare):
    """Compares one robot at one door. `peer` reads it by the other tool, `make` by rne."""
    try:
        theirs = peer()
    except Exception as error:
        VERDICTS[door, "not read by the tool"].append((name, first_line(error)))
        return
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            arm = make(theirs)
            verdict, reason = "right", f"{compare(arm, theirs):.0e}"
    except ValueError as error:  # of which RobotFileError is one
        verdict, reason = "refused", first_line(error)
    except Exception as error:
        verdict, reason = "WRONG", f"{type(error).__name__}: {first_line(error)}"
        print(f"WRONG: {door}: {name}: {reason}", flush=True)
    VERDICTS[door, verdict].append((name, reason))


def first_line(error):
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    message = next((line for line in lines if line.startswith("error")), lines[0] if lines else repr(error))
    return re.sub(r"^\S*:\d+:\d+: ", "", message)[:150]


def worst(found, expected):
    error = np.abs(found - expected).max() / max(np.abs(expected).max(), 1e-9)
    if not error <= TOLERANCE:
        raise Wrong(f"{error:.1e} of the largest: {found[:7]} for {expected[:7]}")
    return error


def turn():
    matrix = np.linalg.qr(RANDOM.normal(size=(3, 3)))[0]
    return matrix * np.linalg.det(matrix)


def quaternion():
    numbers = RANDOM.normal(size=4)
    return numbers / np.linalg.norm(numbers)


def of_base(arm, state, base):
    wrench, tau = arm.inverse_dynamics_of_floating_base(*state, **base)
    return np.concatenate([wrench, tau])


def is_floating(arm):
    return "\nfloating_base:" in arm.yaml


# Pinocchio


def followers(text):
    """Of each joint of a URDF that follows another one: the joint, ratio and offset."""
    follows = {}
    for joint in ElementTree.fromstring(text).iter("joint"):
        mimic = joint.find("mimic")
        if mimic is not None:
            ratio, offset = float(mimic.get("multiplier", 1)), float(mimic.get("offset", 0))
            follows[joint.get("name")] = mimic.get("joint"), ratio, offset
    return follows


def compare_pinocchio(arm, model, follows={}, floating=None):
    """The largest error of an arm beside a model, in which the joints of `follows` are free."""
    data, largest = model.createData(), 0.0
    has_base = model.njoints > 1 and model.joints[1].shortname() == "JointModelFreeFlyer"
    floating = has_base if floating is None else floating
    if floating != is_floating(arm):
        raise Wrong(f"the base floats: {is_floating(arm)}")

    def ratios(name):
        """The position of a joint: a ratio for each coordinate, and the offset."""
        if name in follows:
            leader, ratio, offset = follows[name]
            row, start = ratios(leader)
            return ratio * row, ratio * start + offset
        return np.array([float(name == joint) for joint in arm.joints]), 0.0

    turns = np.zeros((model.nv, arm.dof))
    offsets = {}
    for name, joint in zip(model.names, model.joints):
        if joint.nv == 1:
            turns[joint.idx_v], offsets[name] = ratios(name)
    for _ in range(STATES):
        q, qd, qdd = state = RANDOM.uniform(-1, 1, (3, arm.dof))
        full, v, a = pin.neutral(model), turns @ qd, turns @ qdd
        for name, joint in zip(model.names, model.joints):
            if joint.nv == 1:
                value = turns[joint.idx_v] @ q + offsets[name]
                angle = [value] if joint.nq == 1 else [np.cos(value), np.sin(value)]
                full[joint.idx_q : joint.idx_q + joint.nq] = angle
            elif joint.nv == 0:
                raise Wrong("a joint of the model has no place in this comparison")
        if floating:
            full[:3], full[3:7] = RANDOM.normal(size=3), quaternion()
            v[:6], a[:6] = RANDOM.normal(size=(2, 6))
        tau = pin.rnea(model, data, full, v, a)
        expected = turns.T @ tau
        if floating:
            found = of_base(arm, state, rne.base_from_pinocchio(full, v, a, model))
            expected = np.concatenate([tau[:6], expected])
        else:
            found = arm.inverse_dynamics(*state)
        largest = max(largest, worst(found, expected))
    return largest


def without_rotors(model, gravity=None):
    model.armature = np.zeros(model.nv)
    if gravity is not None:
        model.gravity.linear = gravity
    return model


def placed(text):
    """A URDF on a floating joint whose parent frame is turned, behind a fixed one."""
    robot = ElementTree.fromstring(text)
    children = [child.get("link") for child in robot.findall("joint/child")]
    root = next(link.get("name") for link in robot.findall("link") if link.get("name") not in children)
    origin = lambda: '<origin xyz="{} {} {}" rpy="{} {} {}"/>'.format(*RANDOM.uniform(-1, 1, 6).tolist())
    joint = '<joint name="{0}_" type="{1}">{2}<parent link="{3}_"/><child link="{4}"/></joint>'.format
    joints = joint("z0", "fixed", origin(), "w0", "w1_") + joint("z1", "floating", origin(), "w1", root)
    return text.replace("</robot>", f'<link name="w0_"/><link name="w1_"/>{joints}</robot>')


def urdf(name, path):
    text = path.read_text(errors="replace")
    follows = followers(text)
    options = {"whole": True, "snap": False, "keep_unphysical": True, "form": "seven_steps"}
    taken = {"keep_unphysical": True, "form": "seven_steps"}
    build = lambda *root, text=text: without_rotors(pin.buildModelFromXML(text, *root))
    by_text = lambda arm, model: compare_pinocchio(arm, model, follows)
    judged("URDF, --whole", name, build, lambda _: rne.load(text, floating=False, **options), by_text)
    flyer = pin.JointModelFreeFlyer()
    judged("URDF, --whole --floating", name, lambda: build(flyer),
           lambda _: rne.load(text, floating=True, **options), by_text)
    turned = placed(text)
    judged("URDF, --whole, floating joint in a turned frame", name, lambda: build(text=turned),
           lambda _: rne.load(turned, **options), by_text)

    def flying():
        model = without_rotors(pin.buildModelFromXML(text, pin.JointModelFreeFlyer()), GRAVITY)
        model.jointPlacements[1] = pin.SE3(turn(), RANDOM.normal(size=3))
        return model

    judged("from_pinocchio", name, lambda: without_rotors(pin.buildModelFromXML(text), GRAVITY),
           lambda model: rne.from_pinocchio(model, **taken), compare_pinocchio)
    judged("from_pinocchio, free-flyer in a turned frame", name, flying,
           lambda model: rne.from_pinocchio(model, **taken), compare_pinocchio)
    judged("from_pinocchio, the same held", name, flying,
           lambda model: rne.from_pinocchio(model, floating=False, **taken),
           lambda arm, model: compare_pinocchio(arm, model, floating=False))
    if follows:
        judged("from_pinocchio, with mimic joints", name,
               lambda: without_rotors(pin.buildModelFromXML(text, mimic=True), GRAVITY),
               lambda model: rne.from_pinocchio(model, **taken),
               lambda arm, _: compare_pinocchio(arm, without_rotors(pin.buildModelFromXML(text), GRAVITY), follows))


def inertia():
    return pin.Inertia(RANDOM.uniform(1, 3), RANDOM.uniform(-0.3, 0.3, 3), np.diag(RANDOM.uniform(0.2, 0.3, 3)))


def pinocchio_joints():
    """A model for each type of joint of Pinocchio, which stands between two revolute ones."""
    axis = np.array([0.36, -0.48, 0.8])
    makes = [lambda kind: kind(), lambda kind: kind(axis), lambda kind: kind(0.1), lambda kind: kind(axis, 0.1),
             lambda kind: kind(axis, np.array([0.8, 0.6, 0.0])), lambda kind: kind(1.0, 1.0, 1.0)]

    def joint(kind):
        for make in sorted(makes, key=lambda make: "Unaligned" in kind and make is makes[0]):
            try:
                made = make(getattr(pin, kind))
            except Exception:
                continue
            if kind == "JointModelComposite":
                made.addJoint(pin.JointModelRX())
                made.addJoint(pin.JointModelRY(), pin.SE3.Identity())
            return made
        raise ValueError("no way to make it is known")

    def model(kind, leader, flies):
        result = pin.Model()
        result.gravity.linear = GRAVITY
        place = lambda: pin.SE3(turn(), RANDOM.uniform(-0.5, 0.5, 3))
        kinds = [getattr(pin, leader or "JointModelRX")(), joint(kind), pin.JointModelRZ()]
        if leader:
            follower = pin.JointModel(kinds[1])
            follower.setIndexes(1, 0, 0)
            kinds[1] = pin.JointModelMimic(follower, -1.5, 0.3)
        last = 0
        for index, made in enumerate([pin.JointModelFreeFlyer(), *kinds] if flies else kinds):
            last = result.addJoint(last, made, place(), f"j{index}")
            result.appendBodyToJoint(last, inertia(), pin.SE3.Identity())
        return result

    for kind in sorted(name for name in dir(pin) if re.fullmatch("JointModel.+", name) and name != "JointModelMimic"):
        for flies in (False, True):
            peer = lambda: model(kind, None, flies)
            judged("joint types of Pinocchio", kind + (" on a free-flyer" if flies else ""), peer,
                   lambda model: rne.from_pinocchio(model, form="seven_steps"), compare_pinocchio)
        for leader in ("JointModelRX", "JointModelRUBX"):
            judged("joint types of Pinocchio", f"{kind} that follows {leader}", lambda: model(kind, leader, False),
                   lambda model: rne.from_pinocchio(model, form="seven_steps"), compare_mimic)


def compare_mimic(arm, model):
    """j1 follows j0 in Pinocchio, too: its torques are those of q without the follower."""
    largest = 0.0
    for _ in range(STATES):
        q, qd, qdd = RANDOM.uniform(-1, 1, (3, arm.dof))
        turns = [[value] if joint.nq == 1 else [np.cos(value), np.sin(value)]
                 for joint, value in zip((joint for joint in model.joints[1:] if joint.nv), q)]
        expected = pin.rnea(model, model.createData(), np.concatenate(turns), qd, qdd)
        largest = max(largest, worst(arm.inverse_dynamics(q, qd, qdd), expected))
    return largest


# MuJoCo


def compare_mujoco(arm, model):
    theirs, largest = mjcf.Model(model), 0.0
    names = {joint: place for place, joint in enumerate(theirs.names)}
    is_named = set(arm.joints) == set(theirs.names)
    if len(arm.joints) != len(theirs.names):
        raise Wrong(f"the joints are {arm.joints} for {theirs.names}")
    order = [names[joint] if is_named else place for place, joint in enumerate(arm.joints)]
    root = model.body_rootid[model.jnt_bodyid]
    moves = root[model.jnt_type > 1]
    free = next((i for i in np.flatnonzero(model.jnt_type == 0) if set(moves) == {root[i]}), None)
    if is_floating(arm) != (free is not None):
        raise Wrong(f"the base floats: {is_floating(arm)}")
    for _ in range(STATES):
        state = RANDOM.uniform(-1, 1, (3, arm.dof))
        data = theirs.put(*state[:, np.argsort(order)])
        if free is not None:
            place, dof = model.jnt_qposadr[free], model.jnt_dofadr[free]
            data.qpos[place : place + 7] = *RANDOM.normal(size=3), *quaternion()
            data.qvel[dof : dof + 6], data.qacc[dof : dof + 6] = RANDOM.normal(size=(2, 6))
        tau, expected = theirs.torques_of_data()
        expected = expected[order]
        if free is None:
            found = arm.inverse_dynamics(*state)
        else:
            found = of_base(arm, state, rne.base_from_mujoco(data.qpos, data.qvel, data.qacc, model))
            rotation = np.zeros(9)
            mujoco.mju_quat2Mat(rotation, data.qpos[place + 3 : place + 7])
            force = rotation.reshape(3, 3).T @ tau[dof : dof + 3]
            expected = np.concatenate([force, tau[dof + 3 : dof + 6], expected])
        largest = max(largest, worst(found, expected))
    return largest


def without_free_rotors(model):
    """Free joints have no armature here: a note of the import says that it is left out."""
    for joint in np.flatnonzero(model.jnt_type == 0):
        model.dof_armature[model.jnt_dofadr[joint] :][:6] = 0
    return model


def framed(text):
    """An MJCF file whose bodies stand in two frames that are turned."""
    place = lambda: 'pos="{} {} {}" quat="{} {} {} {}"'.format(*RANDOM.uniform(-1, 1, 3), *quaternion())
    text = re.sub(r"<worldbody>", lambda it: f"<worldbody><frame {place()}><frame {place()}>", text)
    return text.replace("</worldbody>", "</frame></frame></worldbody>")


def mujoco_file(name, path):
    options = {"whole": True, "snap": False, "keep_unphysical": True, "form": "seven_steps", "rotors": True}
    taken = {"keep_unphysical": True, "form": "seven_steps", "rotors": True}
    read = lambda: without_free_rotors(mujoco.MjModel.from_xml_path(str(path)))
    judged("MJCF, --whole", name, read, lambda _: rne.load(path, **options), compare_mujoco)
    judged("from_mujoco", name, read, lambda model: rne.from_mujoco(model, **taken), compare_mujoco)
    # as MuJoCo writes it: one file, without files that are included
    text = []

    def saved():
        text[:] = [framed(mujoco.MjSpec.from_file(str(path)).to_xml())]
        here = os.getcwd()
        try:
            os.chdir(path.parent)
            return without_free_rotors(mujoco.MjModel.from_xml_string(text[0]))
        finally:
            os.chdir(here)

    judged("MJCF, --whole, in a turned frame", name, saved, lambda _: rne.load(text[0], **options), compare_mujoco)
    judged("from_mujoco, in a turned frame", name, saved, lambda model: rne.from_mujoco(model, **taken), compare_mujoco)


ARM = """<inertial pos="0.1 0.02 0.03" quat="0.5 0.5 -0.5 0.5" mass="2" diaginertia="0.1 0.12 0.15"/>
<frame euler="20 -50 70" pos="0 0.1 0"><body name="l" pos="0 0 0.2" axisangle="1 2 3 40">
<joint name="j" axis="1 0 0.2"/><inertial pos="0.1 0.2 0" mass="1" diaginertia="0.01 0.02 0.02"/></body></frame>"""
BALL = """<body name="ball"><freejoint/><inertial pos="1 0 0" mass="5" diaginertia="1 1 1"/></body>"""
FREE = f"""<body name="b" pos="1 2 3" xyaxes="0 1 0.2 -1 0 0.3"><freejoint/>{ARM}</body>"""
BODIES = {
    "a free body": FREE,
    "in frames": f'<frame euler="30 40 50"><frame pos="1 0 0" zaxis="1 1 0">{FREE}</frame></frame>',
    "behind another free body": BALL + FREE,
    "before another free body": FREE + BALL,
    "beside a fixed body": f'<body name="rock"><geom size="1"/></body>{FREE}',
    "on a fixed body that is turned": f'<body name="post" pos="0 1 0" euler="10 70 30">{ARM}</body>',
    "two free arms": FREE + re.sub(r'name="(\w+)"', r'name="\1_2"', FREE),
}
OPTIONS = {
    "": '<option gravity="1 -2 -9"/>',
    ", gravity off by its flag": '<option gravity="1 -2 -9"><flag gravity="disable"/></option>',
    ", no option": "",
    ", angles in radians, other Euler angles": '<compiler angle="radian" eulerseq="ZYX"/>',
}


def mujoco_bodies():
    for (body, inner), (option, outer) in ((body, option) for body in BODIES.items() for option in OPTIONS.items()):
        text = f"<mujoco>{outer}<worldbody>{inner}</worldbody></mujoco>"
        peer = lambda: mujoco.MjModel.from_xml_string(text)
        read = lambda _: rne.load(text, whole=True, snap=False, form="seven_steps")
        judged("placed bodies of MuJoCo, file", body + option, peer, read, compare_mujoco)
        taken = lambda model: rne.from_mujoco(model, form="seven_steps")
        judged("placed bodies of MuJoCo, model", body + option, peer, taken, compare_mujoco)


def apart(compare, name, *arguments):
    """Compares a robot in a process of its own: MuJoCo does not end for some files whose meshes are missing."""

    def run(end):
        VERDICTS.clear()
        # what the tools themselves print
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
        compare(name, *arguments)
        end.send(dict(VERDICTS))

    fork = multiprocessing.get_context("fork")
    ours, theirs = fork.Pipe()
    process = fork.Process(target=run, args=(theirs,))
    process.start()
    theirs.close()

    def time():
        """Processor time, which does not grow where a thread waits for ever."""
        return pathlib.Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()[11:13]

    found, before = {("all", "not read by the tool"): [(name, "it waits for ever")]}, None
    try:
        while not (ended := ours.poll(30)) and before != time():
            before = time()
        found = ours.recv() if ended else found
    except EOFError:
        found = {("all", "WRONG"): [(name, "the process ended by a signal or an exception")]}
    for key, names in found.items():
        VERDICTS[key] += names
    process.kill()
    process.join()


def files(folder, suffix, words):
    for path in sorted(folder.rglob(f"*{suffix}")):
        name = str(path.relative_to(folder.parent))
        if not words or any(word in name for word in words):
            yield name, path


def folder_of(package):
    return pathlib.Path(importlib.util.find_spec(package).submodule_search_locations[0])


def main():
    words = sys.argv[1:]
    data = next(pathlib.Path(entry, "cmeel.prefix/share/example-robot-data/robots") for entry in sys.path
                if pathlib.Path(entry, "cmeel.prefix/share/example-robot-data/robots").exists())
    for name, path in files(data, ".urdf", words):
        if "<joint" in path.read_text(errors="replace"):
            apart(urdf, name.removeprefix("robots/"), path)
    for package in PACKAGES:
        for name, path in files(folder_of(package), ".xml", words):
            if re.search(r"<mujoco\b(?!include)", path.read_text()) and "<joint" in path.read_text():
                apart(mujoco_file, name, path)
    if not words or "small-models" in words:
        pinocchio_joints()
        mujoco_bodies()
    kinds = ["right", "refused", "WRONG", "not read by the tool"]
    doors = list(dict.fromkeys(door for door, _ in VERDICTS))
    print(f"Pinocchio {pin.__version__}, MuJoCo {mujoco.__version__}; "
          f"inverse dynamics with gravity, to {TOLERANCE:.0e} of the largest torque")
    print(f"{'door':<52}" + "".join(f"{kind:>22}" for kind in kinds) + f"{'largest error':>16}")
    for door in doors:
        errors = max((float(reason) for _, reason in VERDICTS[door, "right"]), default=0.0)
        print(f"{door:<52}" + "".join(f"{len(VERDICTS[door, kind]):>22}" for kind in kinds) + f"{errors:>16.0e}")
    for kind in kinds[1:]:
        reasons = collections.defaultdict(list)
        for door in doors:
            for name, reason in VERDICTS[door, kind]:
                reasons[reason].append(f"{name} ({door})")
        print(f"\n{kind}:")
        for reason, names in reasons.items():
            print(f"  {reason}\n    {', '.join(names)}")
    if any(VERDICTS[door, "WRONG"] for door in doors):
        sys.exit("some numbers are wrong")


if __name__ == "__main__":
    main()
