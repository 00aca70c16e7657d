"""A robot of models/*.json or TREES: its table, its constant transforms, the random states of the comparison.

The JSON of one robot
---------------------
name        string
convention  "standard" or "modified"
gravity     acceleration of gravity in frame 0, e.g. [0, 0, -9.81]
joints[i]   type "R" or "P", theta, d, a, alpha, offset, m, com[3], I[6], Jm, G
            theta_i = theta + (q_i + offset if R else 0)
            d_i     = d     + (q_i + offset if P else 0)
            com     centre of mass in link frame i
            I       [Ixx, Iyy, Izz, Ixy, Ixz, Iyz] about the centre of mass, axes of link frame i, elements of the
                    tensor itself
            Jm, G   rotor inertia and gear ratio; no torque of this comparison includes them
source      where the numbers come from
parent      of a robot with branches: number of the joint before this one, -1 on frame 0
gamma, b    of a robot with branches: Rz(gamma) Tz(b) before A_i, on the axis of the parent

A robot with branches is a robot file of rne with modified rows, read as it is.

standard:  A_i = Rz(theta_i) Tz(d_i) Tx(a_i) Rx(alpha_i), link frame i at the far end of link i
modified:  A_i = Rx(alpha_i) Tx(a_i) Rz(theta_i) Tz(d_i), link frame i on joint axis i
"""

import json
import math
import sys
from pathlib import Path

import numpy as np
import yaml

MODELS = Path(__file__).resolve().parent.parent / "models"
ROOT = MODELS.parent.parent.parent
ARMS = ["planar2", "puma560", "stanford", "panda", "iiwa14", "dense6_2p", "dense7"]
TREES = {"hyq": "robots/trees/hyq.yaml", "atlas": "benches/trees/atlas.yaml", "g1": "benches/trees/g1.yaml"}
# Nothing holds the bases of these; ../floating compares them.
FLOATING = {f"{name}_floating": f"benches/trees/{name}_floating.yaml" for name in ("hyq", "g1")}
ROBOTS = [*ARMS, *TREES]
STATES, SEED = 1024, 77


def load(name):
    return tree(name) if name in TREES | FLOATING else json.loads((MODELS / f"{name}.json").read_text())


def tree(name):
    """A robot file in the terms of the JSON. What this comparison lacks is refused."""
    path = (TREES | FLOATING)[name]
    file = yaml.safe_load((ROOT / path).read_text())
    if file["convention"] != "modified" or {"parameters", "couplings", "loops", "base"} & set(file):
        sys.exit(f"{path}: only modified rows of numbers on a fixed base are compared")
    numbers, joints = {}, []
    for i, joint in enumerate(file["joints"]):
        if not {"name", "parent", "type", "dh", "link", "limits"} >= set(joint):
            sys.exit(f"{path}: {joint['name']} has what is not compared: {', '.join(joint)}")
        dh = {key: value(x) for key, x in joint["dh"].items()}
        joints.append(
            dict(
                {"gamma": 0.0, "b": 0.0, "offset": 0.0},
                **dh,
                type="R" if joint["type"] == "revolute" else "P",
                parent=numbers.get(joint["parent"], -1) if "parent" in joint else i - 1,
                **body(joint["link"]),
            )
        )
        numbers[joint["name"]] = i
    robot = dict(name=name, title=file["name"], convention="modified", gravity=file["gravity"], joints=joints)
    return robot | ({"base": body(file["floating_base"]["link"])} if "floating_base" in file else {})


def body(link):
    link = {key: value(x) for key, x in link.items()}
    inertia = [link.get("inertia", {}).get(key, 0.0) for key in ("xx", "yy", "zz", "xy", "xz", "yz")]
    return dict(m=link["mass"], com=link.get("com", [0, 0, 0]), I=inertia)


def value(x):
    """Numbers of a robot file, where expressions with pi are text."""
    if isinstance(x, str):
        return float(eval(x, {"__builtins__": {}}, {"pi": math.pi}))
    if isinstance(x, dict):
        return {key: value(y) for key, y in x.items()}
    return [value(y) for y in x] if isinstance(x, list) else x


def parent(robot, i):
    """The joint before joint i; -1 on frame 0."""
    return robot["joints"][i].get("parent", i - 1)


def sin_cos(angle):
    """Sine and cosine, exactly 0, 1 or -1 at multiples of pi/2: only so can a generator fold zeros."""
    quarters = angle / (math.pi / 2)
    if abs(quarters - round(quarters)) < 1e-12:
        return [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)][round(quarters) % 4]
    return math.sin(angle), math.cos(angle)


def turn_x(angle):
    s, c = sin_cos(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def turn_z(angle):
    s, c = sin_cos(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def tensor(inertia):
    xx, yy, zz, xy, xz, yz = inertia
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]], dtype=float)


def homogeneous(rotation, translation):
    result = np.eye(4)
    result[:3, :3], result[:3, 3] = rotation, translation
    return result


def constant_theta(joint):
    return joint["theta"] + (joint["offset"] if joint["type"] == "R" else 0.0)


def constant_d(joint):
    return joint["d"] + (joint["offset"] if joint["type"] == "P" else 0.0)


def split(robot, i):
    """(before, after): A_i = before J(q_i) after, where J = Rz(q) or Tz(q) and both others are constant.

    `before` places joint i in the link frame of its parent; `after` places link frame i in the frame that moves with the joint.
    """
    joint = robot["joints"][i]
    along_z = homogeneous(turn_z(constant_theta(joint)), [0, 0, constant_d(joint)])
    along_x = homogeneous(turn_x(joint["alpha"]), [joint["a"], 0, 0])
    if robot["convention"] == "standard":
        return np.eye(4), along_z @ along_x
    on_parent = homogeneous(turn_z(joint.get("gamma", 0.0)), [0, 0, joint.get("b", 0.0)])
    return on_parent @ along_x @ along_z, np.eye(4)


def states(robot, count=STATES, seed=SEED):
    """Seeded random q, qd, qdd: angles within a turn, slides 0.1 to 0.9 m, rates within 2, accelerations within 5."""
    random = np.random.default_rng(seed)
    joints = len(robot["joints"])
    revolute = np.array([joint["type"] == "R" for joint in robot["joints"]])
    u = random.uniform(-1, 1, (count, joints))
    q = np.where(revolute, math.pi * u, 0.5 + 0.4 * u)
    qd = random.uniform(-2, 2, (count, joints))
    qdd = random.uniform(-5, 5, (count, joints))
    return q, qd, qdd
