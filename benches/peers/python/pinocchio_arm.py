"""A Pinocchio model with the exact frames of the table, without a URDF in between."""

import numpy as np
import pinocchio

from arm import parent, split, tensor


def build(robot):
    model = pinocchio.Model()
    model.name = robot["name"]
    model.gravity = pinocchio.Motion(np.array(robot["gravity"], dtype=float), np.zeros(3))
    joints, links = [0], [np.eye(4)]  # of frame 0, then of every joint
    for i, j in enumerate(robot["joints"]):
        before, after = split(robot, i)
        kind = pinocchio.JointModelRZ() if j["type"] == "R" else pinocchio.JointModelPZ()
        above = parent(robot, i) + 1
        joint = model.addJoint(joints[above], kind, pinocchio.SE3(links[above] @ before), f"j{i + 1}")
        inertia = pinocchio.Inertia(float(j["m"]), np.array(j["com"], dtype=float), tensor(j["I"]))
        model.appendBodyToJoint(joint, inertia, pinocchio.SE3(after))
        joints.append(joint)
        links.append(after)
    return model
