"""A MuJoCo model with the exact frames of the table; inertias are set after compilation, which would change them."""

import mujoco
import numpy as np

from arm import parent, split, tensor


def quaternion(rotation):
    result = np.zeros(4)
    mujoco.mju_mat2Quat(result, np.ascontiguousarray(rotation).ravel())
    return result / np.linalg.norm(result)


def xml(robot):
    lines = ['<mujoco><option><flag constraint="disable" contact="disable"/></option><worldbody>']
    open_joints = []
    for i, j in enumerate(robot["joints"]):
        while open_joints and open_joints[-1] != parent(robot, i):
            open_joints.pop()
            lines.append("</body>")
        open_joints.append(i)
        kind = "hinge" if j["type"] == "R" else "slide"
        lines.append(f'<body><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/><joint type="{kind}" axis="0 0 1"/>')
    lines.append("</body>" * len(open_joints) + "</worldbody></mujoco>")
    return "".join(lines)


def build(robot):
    model = mujoco.MjModel.from_xml_string(xml(robot))
    model.opt.gravity[:] = robot["gravity"]
    links = [np.eye(4)]  # of frame 0, then of every joint
    for i, j in enumerate(robot["joints"]):
        before, after = split(robot, i)
        body, place, turn = i + 1, links[parent(robot, i) + 1] @ before, after[:3, :3]
        moments, axes = np.linalg.eigh(turn @ tensor(j["I"]) @ turn.T)
        if np.linalg.det(axes) < 0:
            axes[:, 0] *= -1
        model.body_pos[body], model.body_quat[body] = place[:3, 3], quaternion(place[:3, :3])
        model.body_mass[body] = j["m"]
        model.body_ipos[body] = turn @ np.array(j["com"], dtype=float) + after[:3, 3]
        model.body_inertia[body], model.body_iquat[body] = moments, quaternion(axes)
        model.body_sameframe[body] = model.body_simple[body] = 0
        links.append(after)
    if hasattr(model, "dof_simplenum"):
        model.dof_simplenum[:] = 0
    mujoco.mj_setConst(model, mujoco.MjData(model))
    return model


def bare(robot):
    """The same with everything disabled that inverse dynamics of a free arm does not need."""
    model = build(robot)
    flags = (name for name in dir(mujoco.mjtDisableBit) if name.startswith("mjDSBL_") and name != "mjDSBL_GRAVITY")
    model.opt.disableflags |= sum(int(getattr(mujoco.mjtDisableBit, name)) for name in flags)
    return model
