"""A robot of models/*.json: its table, its constant transforms, the random states of the comparison.

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

standard:  A_i = Rz(theta_i) Tz(d_i) Tx(a_i) Rx(alpha_i), link frame i at the far end of link i
modified:  A_i = Rx(alpha_i) Tx(a_i) Rz(theta_i) Tz(d_i), link frame i on joint axis i
"""

import json
import math
from pathlib import Path

import numpy as np

MODELS = Path(__file__).resolve().parent.parent / "models"
ROBOTS = ["planar2", "puma560", "stanford", "panda", "iiwa14", "dense6_2p", "dense7"]
STATES, SEED = 1024, 77


def load(name):
    return json.loads((MODELS / f"{name}.json").read_text())


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

    `before` places joint i in link frame i-1; `after` places link frame i in the frame that moves with the joint.
    """
    joint = robot["joints"][i]
    along_z = homogeneous(turn_z(constant_theta(joint)), [0, 0, constant_d(joint)])
    along_x = homogeneous(turn_x(joint["alpha"]), [joint["a"], 0, 0])
    if robot["convention"] == "standard":
        return np.eye(4), along_z @ along_x
    return along_x @ along_z, np.eye(4)


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
