#!/usr/bin/env python3
"""Write frames.json: frames on links of 20 arms by Pinocchio (pip install pin numpy).

    python3 tests/reference/frames.py > tests/reference/frames.json

Each arm is a table of plain numbers. Pinocchio gets its joints by their placements, not by a URDF. numpy computes the
poses a second time, by the definition of the table, and the script stops if the two differ by more than 1e-13.
"""

import json

import numpy as np
import pinocchio as pin

ARMS = 20


def turn(axis, angle):
    return pin.SE3(pin.utils.rotate(axis, angle), np.zeros(3))


def shift(x, y, z):
    return pin.SE3(np.eye(3), np.array([x, y, z], float))


def placed(xyz, rpy):
    return pin.SE3(pin.rpy.rpyToMatrix(*rpy), np.array(xyz, float))


def rounded(values):
    return [round(float(value), 3) for value in values]


def arm(rng, index):
    """A robot file as data: numbers with three digits."""
    joints = []
    for number in range(rng.integers(1, 8)):
        theta, alpha = rng.choice([0.0, 0.5, -1.2, 2.0]), rng.choice([0.0, 1.1, -0.7, 1.5])
        d, a = rounded(rng.uniform(-0.6, 0.6, 2))
        kind = "prismatic" if rng.random() < 0.3 else "revolute"
        dh = {"theta": float(theta), "d": d, "a": a, "alpha": float(alpha)}
        joints.append({"name": f"j{number + 1}", "type": kind, "dh": dh, "link": {"mass": 1.0}})
    place = lambda: {"xyz": rounded(rng.uniform(-0.5, 0.5, 3)), "rpy": rounded(rng.uniform(-3, 3, 3))}
    carriers = ["base"] + [joint["name"] for joint in joints]
    frames = [{"name": f"on_{on}", "on": on, **place()} for on in carriers]
    return {
        "format": 1, "name": f"arm{index}", "source": "random", "gravity": [0, 0, -9.81],
        "convention": ["standard", "modified"][index % 2], "base": place(), "frames": frames, "joints": joints,
    }


def screws(dh):
    along_x = shift(dh["a"], 0, 0) * turn("x", dh["alpha"])
    return along_x, turn("z", dh["theta"]) * shift(0, 0, dh["d"])


def model_of(robot):
    """The model, and from each joint to the link frame of the table."""
    model, joint, ends = pin.Model(), 0, []
    end = placed(**robot["base"])
    for described in robot["joints"]:
        along_x, along_z = screws(described["dh"])
        standard = robot["convention"] == "standard"
        before = end if standard else (end * along_x)
        kind = pin.JointModelRZ() if described["type"] == "revolute" else pin.JointModelPZ()
        joint = model.addJoint(joint, kind, before * along_z, described["name"])
        end = along_x if standard else pin.SE3.Identity()
        ends.append(end)
    return model, ends


def by_numpy(robot, on, q):
    """The pose of a link frame by the definition of the table."""
    matrix = placed(**robot["base"]).homogeneous
    for described, value in zip(robot["joints"][:on], q):
        dh = dict(described["dh"])
        dh["theta" if described["type"] == "revolute" else "d"] += value
        along_x, along_z = (screw.homogeneous for screw in screws(dh))
        matrix = matrix @ (along_z @ along_x if robot["convention"] == "standard" else along_x @ along_z)
    return matrix


def rate_of(model, q, qd, frame):
    """The rate of the Jacobian of a frame, in world axes."""
    data = model.createData()
    pin.computeJointJacobiansTimeVariation(model, data, q, qd)
    pin.updateFramePlacements(model, data)
    # of one joint, Pinocchio gives six numbers instead of a matrix
    rate = pin.getFrameJacobianTimeVariation(model, data, frame, pin.LOCAL_WORLD_ALIGNED)
    return np.array(rate).reshape(6, model.nv)


def main():
    rng, arms = np.random.default_rng(7), []
    for index in range(ARMS):
        robot = arm(rng, index)
        model, ends = model_of(robot)
        names = {"base": 0, **{joint["name"]: number + 1 for number, joint in enumerate(robot["joints"])}}
        ids = []
        for frame in robot["frames"]:
            joint = names[frame["on"]]
            link = ends[joint - 1] if joint else placed(**robot["base"])
            place = link * placed(frame["xyz"], frame["rpy"])
            ids.append(model.addFrame(pin.Frame(frame["name"], joint, 0, place, pin.FrameType.OP_FRAME)))
        data = model.createData()
        q, qd = (np.array(rounded(rng.uniform(-2, 2, model.nv))) for _ in range(2))
        wrench = rounded(rng.uniform(-5, 5, 6))
        pin.forwardKinematics(model, data, q, qd, np.zeros(model.nv))
        pin.computeJointJacobians(model, data, q)
        pin.updateFramePlacements(model, data)
        results = []
        for frame, at in zip(robot["frames"], ids):
            pose = data.oMf[at]
            expected = by_numpy(robot, names[frame["on"]], q) @ placed(frame["xyz"], frame["rpy"]).homogeneous
            assert np.abs(pose.homogeneous - expected).max() < 1e-13, robot
            world = pin.getFrameJacobian(model, data, at, pin.LOCAL_WORLD_ALIGNED)
            local = pin.getFrameJacobian(model, data, at, pin.LOCAL)
            rate = pin.getFrameClassicalAcceleration(model, data, at, pin.LOCAL_WORLD_ALIGNED)
            # at the velocity one of a joint alone, the rate is the derivative by its position
            derivatives = np.array([rate_of(model, q, unit, at) for unit in np.eye(model.nv)])
            results.append({
                "forward_kinematics": pose.rotation.flatten().tolist() + pose.translation.tolist(),
                "jacobian": world.flatten().tolist(),
                "jacobian_rate_times_velocity": rate.vector.tolist(),
                "wrench_torques": (local.T @ np.array(wrench)).tolist(),
                "jacobian_rate": rate_of(model, q, qd, at).flatten().tolist(),
                "jacobian_derivatives": derivatives.transpose(1, 2, 0).flatten().tolist(),
            })
        state = {"q": q.tolist(), "qd": qd.tolist(), "wrench": wrench}
        arms.append({"robot": json.dumps(robot), "state": state, "frames": results})
    lines = ",\n".join(json.dumps(arm) for arm in arms)
    print(f'{{"pinocchio": "{pin.__version__}", "arms": [\n{lines}\n]}}')


if __name__ == "__main__":
    main()
