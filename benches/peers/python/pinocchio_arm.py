"""A Pinocchio model with the exact frames of the table, without a URDF in between."""

import numpy as np
import pinocchio

from arm import split, tensor


def build(robot):
    model = pinocchio.Model()
    model.name = robot["name"]
    model.gravity = pinocchio.Motion(np.array(robot["gravity"], dtype=float), np.zeros(3))
    parent, link = 0, np.eye(4)
    for i, j in enumerate(robot["joints"]):
        before, after = split(robot, i)
        kind = pinocchio.JointModelRZ() if j["type"] == "R" else pinocchio.JointModelPZ()
        parent = model.addJoint(parent, kind, pinocchio.SE3(link @ before), f"j{i + 1}")
        inertia = pinocchio.Inertia(float(j["m"]), np.array(j["com"], dtype=float), tensor(j["I"]))
        model.appendBodyToJoint(parent, inertia, pinocchio.SE3(after))
        link = after
    return model
