"""Robot files of real trees, and their torques by Pinocchio: what the test `real_trees.rs` compares with.

    python from_urdf.py NAME TITLE ROBOT.urdf -o FOLDER      # needs numpy and pin

The root link is fixed to the world. Fixed joints join their links to the parent; a joint that follows another one is
fixed at 0. Rotations whose elements are within SNAP of those of a turn by right angles are snapped to them, in the robot
file and in the model that Pinocchio gets: both have the same numbers.
"""

import argparse
import math
import pathlib
import xml.etree.ElementTree as ET

import numpy as np
import pinocchio as pin

SNAP = 3e-4
STATES = 5


def rotation(roll, pitch, yaw):
    (cr, cp, cy), (sr, sp, sy) = map(math.cos, (roll, pitch, yaw)), map(math.sin, (roll, pitch, yaw))
    return snapped(
        np.array(
            [
                [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
                [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
                [-sp, cp * sr, cp * cr],
            ]
        )
    )


def snapped(matrix):
    near = np.where(np.abs(matrix) < SNAP, 0.0, matrix)
    near = np.where(np.abs(np.abs(near) - 1) < SNAP**2, np.round(near), near)
    u, _, v = np.linalg.svd(near)
    orthogonal = u @ v
    return np.where(np.abs(orthogonal - np.round(orthogonal)) < 1e-12, np.round(orthogonal), orthogonal)


def along_z(axis):
    """A rotation whose third column is the axis."""
    axis = np.where(np.abs(axis) < SNAP, 0.0, axis)
    z = axis / np.linalg.norm(axis)
    if np.count_nonzero(z) == 1:
        # the cyclic order of axes where it can stay
        x = np.roll(np.abs(z), 1)
        return np.stack([x, np.cross(z, x), z], 1)
    x = np.cross([0.0, 0.0, 1.0], z)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z], 1)


def origin(element):
    of = element.find("origin") if element is not None else None
    numbers = lambda key: [float(x) for x in (of.get(key) if of is not None and of.get(key) else "0 0 0").split()]
    return rotation(*numbers("rpy")), np.array(numbers("xyz"))


def body(link):
    inertial = link.find("inertial")
    if inertial is None:
        return 0.0, np.zeros(3), np.zeros((3, 3))
    turn, com = origin(inertial)
    get = lambda key: float(inertial.find("inertia").get(key, 0))
    rows = [["ixx", "ixy", "ixz"], ["ixy", "iyy", "iyz"], ["ixz", "iyz", "izz"]]
    inertia = np.array([[get(key) for key in row] for row in rows])
    return float(inertial.find("mass").get("value")), com, turn @ inertia @ turn.T


def joined(one, other):
    # what is alone keeps its digits
    for [alone, nothing] in [(one, other), (other, one)]:
        if nothing[0] == 0 and not nothing[2].any():
            return alone
    mass = one[0] + other[0]
    if mass == 0:
        return mass, one[1], one[2] + other[2]
    com = (one[0] * one[1] + other[0] * other[1]) / mass
    about = lambda of: of[2] + of[0] * ((of[1] - com) @ (of[1] - com) * np.eye(3) - np.outer(of[1] - com, of[1] - com))
    return mass, com, about(one) + about(other)


def rows_of(path):
    root = ET.parse(path).getroot()
    links = {link.get("name"): link for link in root.findall("link")}
    joints = root.findall("joint")
    children = {joint.find("child").get("link") for joint in joints}
    rows = []

    def visit(link, turn, place, row):
        mass, com, inertia = body(links[link])
        if row is not None:
            row["body"] = joined(row["body"], (mass, turn @ com + place if mass else com, turn @ inertia @ turn.T))
        for joint in (joint for joint in joints if joint.find("parent").get("link") == link):
            of_joint, at = origin(joint)
            of_joint, at = turn @ of_joint, turn @ at + place
            kind, child = joint.get("type"), joint.find("child").get("link")
            if kind in ("fixed", "floating") or joint.find("mimic") is not None:
                visit(child, of_joint, at, row)
                continue
            axis = joint.find("axis")
            align = along_z(np.array([float(x) for x in (axis.get("xyz") if axis is not None else "1 0 0").split()]))
            parent = row["name"] if row else "base"
            new = {"name": joint.get("name"), "parent": parent, "turn": snapped(of_joint @ align), "at": at}
            new |= {"prismatic": kind == "prismatic", "body": (0.0, np.zeros(3), np.zeros((3, 3)))}
            rows.append(new)
            visit(child, align.T, np.zeros(3), new)

    [base] = [link for link in links if link not in children]
    visit(base, np.eye(3), np.zeros(3), None)
    return rows


def number(x):
    return repr(0.0 if abs(x) < 1e-15 else float(x))


def angle(x):
    quarters = round(x / (math.pi / 2))
    if abs(x - quarters * math.pi / 2) < 1e-9:
        return {0: "0", 1: "pi/2", 2: "pi", -1: "-pi/2", -2: "-pi"}[quarters]
    return number(x)


def roll_pitch_yaw(matrix):
    if abs(matrix[2, 0]) > 1 - 1e-12:
        return 0.0, -math.copysign(math.pi / 2, matrix[2, 0]), math.atan2(-matrix[0, 1], matrix[1, 1])
    pitch = math.atan2(-matrix[2, 0], math.hypot(matrix[0, 0], matrix[1, 0]))
    return math.atan2(matrix[2, 1], matrix[2, 2]), pitch, math.atan2(matrix[1, 0], matrix[0, 0])


def robot_file(name, title, rows):
    head = f"# By from_urdf.py.\nformat: 2\nname: {name}\nsource: {title}\nconvention: modified\n"
    head += f'gravity: [0, 0, -9.81]\ntool: {{on: "{rows[-1]["name"]}"}}\njoints:\n'
    entries = ["xx", "yy", "zz", "xy", "xz", "yz"]
    for row in rows:
        mass, com, inertia = row["body"]
        of = dict(zip(entries, [*np.diag(inertia), inertia[0, 1], inertia[0, 2], inertia[1, 2]]))
        tensor = ", ".join(f"{key}: {number(value)}" for key, value in of.items())
        physical = "" if np.linalg.eigvalsh(inertia)[0] >= 0 else "physical: false, "
        kind = "prismatic" if row["prismatic"] else "revolute"
        xyz, rpy = (", ".join(map(of, values)) for of, values in [(number, row["at"]), (angle, roll_pitch_yaw(row["turn"]))])
        head += f'- {{name: "{row["name"]}", parent: "{row["parent"]}", type: {kind},\n'
        head += f"   at: {{xyz: [{xyz}], rpy: [{rpy}]}}, dh: {{theta: 0, d: 0, a: 0, alpha: 0}},\n"
        head += f"   link: {{{physical}mass: {number(mass)}, com: [{', '.join(map(number, com))}],\n"
        head += f"     inertia: {{{tensor}}}}}}}\n"
    return head


def golden(rows):
    model = pin.Model()
    ids = {"base": 0}
    for row in rows:
        joint = pin.JointModelPZ() if row["prismatic"] else pin.JointModelRZ()
        ids[row["name"]] = model.addJoint(ids[row["parent"]], joint, pin.SE3(row["turn"], row["at"]), row["name"])
        model.appendBodyToJoint(ids[row["name"]], pin.Inertia(*row["body"]), pin.SE3.Identity())
    model.gravity.linear = np.array([0, 0, -9.81])
    order = [model.joints[ids[row["name"]]].idx_v for row in rows]
    lines = [f"# Pinocchio {pin.__version__}", ",".join(f"{q}{i + 1}" for q in ("q", "qd", "qdd", "tau") for i in range(len(rows)))]
    random = np.random.default_rng(1)
    data = model.createData()
    for _ in range(STATES):
        q, qd, qdd = random.uniform(-3, 3, len(rows)), random.uniform(-2, 2, len(rows)), random.uniform(-5, 5, len(rows))
        v = [np.zeros(len(rows)) for _ in range(3)]
        for of, values in zip(v, (q, qd, qdd)):
            of[order] = values
        tau = pin.rnea(model, data, *v)[order]
        lines.append(",".join(repr(float(x)) for x in [*q, *qd, *qdd, *tau]))
    return "\n".join(lines) + "\n"


parser = argparse.ArgumentParser()
parser.add_argument("name")
parser.add_argument("title")
parser.add_argument("urdf", type=pathlib.Path)
parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path(__file__).parent)
arguments = parser.parse_args()
found = rows_of(arguments.urdf)
(arguments.output / f"{arguments.name}.yaml").write_text(robot_file(arguments.name, arguments.title, found))
(arguments.output / f"{arguments.name}.golden.csv").write_text(golden(found))
