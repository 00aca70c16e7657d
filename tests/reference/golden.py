#!/usr/bin/env python3
"""Writes NAME.golden.json: torques, mass matrix, tip and Jacobian of an arm at 16 seeded states, by Pinocchio from the
URDF the arm was published as, not from the table of robots/NAME.yaml.

    python tests/reference/golden.py NAME ARM.urdf --base LINK --tip LINK [--lock JOINT=VALUE]...

Needs `pip install pin` (4.1.0). Movable joints that do not lead to the tip are held at --lock, or at zero.

What a file rounded is restored first, for the table and for Pinocchio alike, or both would keep noise that is no
property of the arm: angles within 2e-4 rad of a multiple of pi/12 become it (1.5708 is pi/2), lengths of joints below
1e-8 m, centres below 1e-12 m and elements of tensors below 1e-15 kg m² become 0, links of at most 1e-8 kg, which stand for
cameras and frames, become massless. `max_rel_difference_as_published` tells how much that moves the torques.
"""

import argparse
import hashlib
import json
import math
import pathlib
import xml.etree.ElementTree as ElementTree
import zlib

import numpy as np
import pinocchio as pin

STATES = 16
ANGLE, LENGTH, CENTRE, TENSOR, MASS = 2e-4, 1e-8, 1e-12, 1e-15, 1e-8


def restored(text):
    """The URDF with what it rounded put back."""
    root = ElementTree.fromstring(text)
    for joint in root.findall("joint"):
        rewrite(joint.find("origin"), "rpy", right_angle)
        rewrite(joint.find("origin"), "xyz", lambda x: 0.0 if abs(x) < LENGTH else x)
    for link in root.findall("link"):
        inertial = link.find("inertial")
        if inertial is None:
            continue
        if float(inertial.find("mass").get("value")) <= MASS:
            link.remove(inertial)
            continue
        rewrite(inertial.find("origin"), "rpy", right_angle)
        rewrite(inertial.find("origin"), "xyz", lambda x: 0.0 if abs(x) < CENTRE else x)
        for name in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"):
            rewrite(inertial.find("inertia"), name, lambda x: 0.0 if abs(x) < TENSOR else x)
    return ElementTree.tostring(root, encoding="unicode")


def rewrite(element, name, rule):
    """Replaces those numbers of an attribute that the rule changes; the others keep their spelling."""
    if element is None or element.get(name) is None:
        return
    words = element.get(name).split()
    element.set(name, " ".join(word if rule(float(word)) == float(word) else repr(rule(float(word))) for word in words))


def right_angle(angle):
    """The multiple of pi/12 the file means, or the angle."""
    steps = round(angle / (math.pi / 12))
    return math.pi * steps / 12 if abs(angle - math.pi * steps / 12) <= ANGLE else angle


class Model:
    """The chain from base to tip, other joints held."""

    def __init__(self, text, base, tip, locks):
        full = pin.buildModelFromXML(text)
        parents = {joint.find("child").get("link"): joint for joint in ElementTree.fromstring(text).findall("joint")}
        names, link = [], tip
        while link != base:
            joint = parents[link]
            if joint.get("type") != "fixed":
                names.insert(0, joint.get("name"))
            link = joint.find("parent").get("link")
        at_rest = pin.neutral(full)
        for name, value in locks.items():
            at_rest[full.joints[full.getJointId(name)].idx_q] = value
        held = [index for index in range(1, full.njoints) if full.names[index] not in names]
        self.model = pin.buildReducedModel(full, held, at_rest)
        assert list(self.model.names)[1:] == names, "the chain is not in the order of its joints"
        self.data, self.tip, self.base = self.model.createData(), self.frame(tip), self.frame(base)
        assert self.model.frames[self.base].parentJoint == 0
        # the world of the values is the base, so gravity, which is the root's, must be the same in both
        root = self.model.frames[self.base].placement
        assert np.abs(root.rotation - np.eye(3)).max() < 1e-15
        self.offset = root.translation
        limits = {joint.get("name"): joint for joint in ElementTree.fromstring(text).findall("joint")}
        self.limits = [self.range(limits[name]) for name in names]

    def frame(self, name):
        return self.model.getFrameId(name, pin.FrameType.BODY)

    @staticmethod
    def range(joint):
        limit = joint.find("limit")
        if joint.get("type") == "continuous" or limit is None or limit.get("lower") is None:
            return (-math.pi, math.pi) if joint.get("type") != "prismatic" else (-0.5, 0.5)
        return float(limit.get("lower")), float(limit.get("upper"))

    def configuration(self, q):
        """q of Pinocchio: continuous joints are points of the circle."""
        out = pin.neutral(self.model)
        for joint, value in zip(list(self.model.joints)[1:], q):
            out[joint.idx_q : joint.idx_q + joint.nq] = value if joint.nq == 1 else (math.cos(value), math.sin(value))
        return out

    def torques(self, q, qd, qdd, *external):
        return pin.rnea(self.model, self.data, self.configuration(q), np.array(qd), np.array(qdd), *external).copy()

    def values(self, q, qd, qdd, wrench):
        model, data, zero = self.model, self.data, np.zeros(self.model.nv)
        tau, gravity = self.torques(q, qd, qdd), self.torques(q, zero, zero)
        keep, model.gravity = model.gravity.copy(), pin.Motion.Zero()
        coriolis = self.torques(q, qd, zero)
        model.gravity = keep
        mass = pin.crba(model, data, self.configuration(q)).copy()
        mass = np.triu(mass) + np.triu(mass, 1).T
        frame = model.frames[self.tip]
        forces = pin.StdVec_Force()
        for _ in range(model.njoints):
            forces.append(pin.Force.Zero())
        # what the link exerts on the environment, the environment exerts back
        forces[frame.parentJoint] = -frame.placement.act(pin.Force(np.array(wrench[:3]), np.array(wrench[3:])))
        with_wrench = self.torques(q, qd, qdd, forces)
        pin.framesForwardKinematics(model, data, self.configuration(q))
        tip = data.oMf[self.tip].homogeneous
        tip[:3, 3] -= self.offset
        at_tip = [
            pin.computeFrameJacobian(model, data, self.configuration(q), self.tip, axes).copy()
            for axes in (pin.ReferenceFrame.LOCAL_WORLD_ALIGNED, pin.ReferenceFrame.LOCAL)
        ]
        scale = max(np.abs(tau).max(), np.abs(with_wrench).max())
        assert np.abs(with_wrench - tau - at_tip[1].T @ wrench).max() < 1e-13 * scale
        assert np.abs(mass @ qdd + coriolis + gravity - tau).max() < 1e-13 * scale
        return {
            "q": list(q), "qd": list(qd), "qdd": list(qdd), "tau": tau.tolist(), "gravity": gravity.tolist(),
            "coriolis": coriolis.tolist(), "mass_matrix": mass.tolist(), "T_tip": tip.tolist(), "wrench": list(wrench),
            "tau_wrench": with_wrench.tolist(), "jacobian_world": at_tip[0].tolist(),
        }  # fmt: skip


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("name")
    parser.add_argument("urdf", type=pathlib.Path)
    parser.add_argument("--base", required=True)
    parser.add_argument("--tip", required=True)
    parser.add_argument("--lock", action="append", default=[])
    given = parser.parse_args()
    locks = {name: float(value) for name, value in (lock.split("=") for lock in given.lock)}
    text = given.urdf.read_text()
    arm, published = (Model(xml, given.base, given.tip, locks) for xml in (restored(text), text))

    seed = zlib.crc32(given.name.encode())
    rng, joints = np.random.default_rng(seed), arm.model.nv
    states, moved = [], 0.0
    for _ in range(STATES):
        q = np.array([rng.uniform(*limits) for limits in arm.limits])
        qd, qdd, wrench = rng.uniform(-2, 2, joints), rng.uniform(-5, 5, joints), rng.uniform(-10, 10, 6)
        states.append(arm.values(q, qd, qdd, wrench))
        tau = np.array(states[-1]["tau"])
        moved = max(moved, np.abs(published.torques(q, qd, qdd) - tau).max() / np.abs(tau).max())
    document = {
        "robot": given.name,
        "seed": seed,
        "rng": "numpy default_rng; q uniform in the limits of the URDF (else +-pi rad, +-0.5 m), |qd| <= 2, |qdd| <= 5",
        "engine": f"pinocchio {pin.__version__} rnea/crba on the URDF, not on the table; tests/reference/golden.py",
        "description": {
            "file": given.urdf.name, "sha256": hashlib.sha256(text.encode()).hexdigest(),
            "base": given.base, "tip": given.tip, "locked": locks,
        },
        "max_rel_difference_as_published": float(f"{moved:.1e}"),
        "wrench_convention": "[fx,fy,fz,nx,ny,nz] exerted BY the last link ON the environment at the tip frame origin,"
        " tip-frame axes; tau_wrench = tau + J^T w. jacobian_world: linear rows first, world axes, at the tip; the world"
        " is the base link of the URDF",
        "states": states,
    }  # fmt: skip
    path = pathlib.Path(__file__).parent / f"{given.name}.golden.json"
    path.write_text(json.dumps(document) + "\n")
    print(f"{path.name}: restored digits move the torques by {moved:.1e} of the largest")


if __name__ == "__main__":
    main()
