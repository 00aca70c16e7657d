"""The state of a floating base in other tools: each line of the table of docs/reference/conventions.md, by the tool itself.

Usage: python conventions.py [--write]     with numpy, and those of pin, mujoco, drake, idyntree and dynibo at hand

One body floats and is accelerated. The wrench on it follows from Newton's and Euler's laws in axes of the base. Each
tool gets the state in the vectors that the table says, and its inverse dynamics must return this wrench in the vector
that the table says. With --write the vectors go to tests/functions/floating/conventions.json, where Rust tests read
them.
"""

import importlib.util
import json
import pathlib
import sys
import tempfile

import numpy as np

TOLERANCE = 1e-12
MASS, COM = 2.5, np.array([0.1, -0.2, 0.3])
INERTIA = np.array([[0.5, 0.02, -0.03], [0.02, 0.6, 0.04], [-0.03, 0.04, 0.7]])
GRAVITY = np.array([0.0, 0.0, -9.80665])  # dynibo has no other

# A unit that measures the motion of the body, in a place of its own. MuJoCo adds what it reads.
IMU = {"position": [0.3, -0.1, 0.2], "quaternion": [0.5, 0.5, -0.5, 0.5]}


def written(vector):
    """An attribute."""
    return " ".join(map(repr, map(float, vector)))


def state(random):
    """Pose of the base in the world; v, ω, classical acceleration of its origin and ω̇ in axes of the base."""
    w, *xyz = quaternion = random.normal(size=4)
    w, xyz = w / np.linalg.norm(quaternion), np.array(xyz) / np.linalg.norm(quaternion)
    skew = np.array([[0, -xyz[2], xyz[1]], [xyz[2], 0, -xyz[0]], [-xyz[1], xyz[0], 0]])
    turn = np.eye(3) + 2 * w * skew + 2 * skew @ skew
    return turn, (w, *xyz), *random.normal(size=(5, 3))


def wrench(turn, omega, acceleration, omega_dot):
    """Force and moment about the base's origin that accelerate the body, in axes of the base."""
    at_com = acceleration + np.cross(omega_dot, COM) + np.cross(omega, np.cross(omega, COM))
    force = MASS * (at_com - turn.T @ GRAVITY)
    return force, INERTIA @ omega_dot + np.cross(omega, INERTIA @ omega) + np.cross(COM, force)


def urdf(folder):
    """The body, for the tools that read nothing else."""
    entries = {"ixx": (0, 0), "ixy": (0, 1), "ixz": (0, 2), "iyy": (1, 1), "iyz": (1, 2), "izz": (2, 2)}
    inertia = " ".join(f'{key}="{INERTIA[at]}"' for key, at in entries.items())
    path = pathlib.Path(folder) / "body.urdf"
    path.write_text(f'<robot name="body"><link name="base"><inertial><origin xyz="{written(COM)}"/>'
                    f'<mass value="{MASS}"/><inertia {inertia}/></inertial></link></robot>')
    return str(path)


def pinocchio(told, _):
    """Position, x y z w; linear, angular in base axes; spatial acceleration; force, moment in base axes."""
    import pinocchio as pin
    turn, (w, x, y, z), position, velocity, omega, acceleration, omega_dot = told
    model = pin.Model()
    model.gravity.linear = GRAVITY
    joint = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "base")
    model.appendBodyToJoint(joint, pin.Inertia(MASS, COM, INERTIA), pin.SE3.Identity())
    q = np.array([*position, x, y, z, w])
    v = np.array([*velocity, *omega])
    a = np.array([*(acceleration - np.cross(omega, velocity)), *omega_dot])
    force, moment = wrench(turn, omega, acceleration, omega_dot)
    return (q, v, a), pin.rnea(model, model.createData(), q, v, a), np.concatenate([force, moment])


def mujoco(told, _):
    """Position, w x y z; linear in the world, angular in base axes; their derivatives; force in the world, moment."""
    import mujoco as mj
    turn, quaternion, position, velocity, omega, acceleration, omega_dot = told
    full = [INERTIA[at] for at in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]]
    model = mj.MjModel.from_xml_string(
        f'<mujoco><option gravity="{written(GRAVITY)}"/><compiler inertiafromgeom="false"/><worldbody>'
        '<body><freejoint/>'
        f'<inertial pos="{written(COM)}" mass="{MASS}" fullinertia="{written(full)}"/>'
        f'<site name="imu" pos="{written(IMU["position"])}" quat="{written(IMU["quaternion"])}"/></body></worldbody>'
        '<sensor><gyro site="imu"/><accelerometer site="imu"/></sensor></mujoco>')
    data = mj.MjData(model)
    q = np.array([*position, *quaternion])
    v, a = np.array([*(turn @ velocity), *omega]), np.array([*(turn @ acceleration), *omega_dot])
    data.qpos, data.qvel, data.qacc = q, v, a
    mj.mj_inverse(model, data)
    IMU["gyroscope"], IMU["accelerometer"] = data.sensordata.reshape(2, 3).tolist()
    force, moment = wrench(turn, omega, acceleration, omega_dot)
    return (q, v, a), data.qfrc_inverse.copy(), np.concatenate([turn @ force, moment])


def drake(told, folder):
    """w x y z, position; angular, linear in the world; their derivatives; moment, force in the world."""
    from pydrake.multibody.parsing import Parser
    from pydrake.multibody.plant import MultibodyPlant
    from pydrake.multibody.tree import MultibodyForces
    turn, quaternion, position, velocity, omega, acceleration, omega_dot = told
    plant = MultibodyPlant(0.0)
    Parser(plant).AddModels(urdf(folder))
    plant.mutable_gravity_field().set_gravity_vector(GRAVITY)
    plant.Finalize()
    context = plant.CreateDefaultContext()
    q = np.array([*quaternion, *position])
    v = np.array([*(turn @ omega), *(turn @ velocity)])
    a = np.array([*(turn @ omega_dot), *(turn @ acceleration)])
    plant.SetPositions(context, q)
    plant.SetVelocities(context, v)
    forces = MultibodyForces(plant)
    plant.CalcForceElementsContribution(context, forces)
    force, moment = wrench(turn, omega, acceleration, omega_dot)
    return (q, v, a), plant.CalcInverseDynamics(context, a, forces), np.concatenate([turn @ moment, turn @ force])


def idyntree(told, folder):
    """Pose by a matrix; mixed, the default: linear, angular in world axes; force, moment in world axes."""
    import idyntree.bindings as idyn
    turn, _, position, velocity, omega, acceleration, omega_dot = told
    loader = idyn.ModelLoader()
    loader.loadModelFromFile(urdf(folder))
    tree = idyn.KinDynComputations()
    tree.loadRobotModel(loader.model())
    if tree.getFrameVelocityRepresentation() != idyn.MIXED_REPRESENTATION:
        raise RuntimeError("iDynTree's default is no longer mixed")
    placed = idyn.Transform(idyn.Rotation(turn), idyn.Position(*position))
    v, a = np.array([*(turn @ velocity), *(turn @ omega)]), np.array([*(turn @ acceleration), *(turn @ omega_dot)])
    none = idyn.VectorDynSize(0)
    tree.setRobotState(placed, none, idyn.Twist.FromPython(v), none, idyn.Vector3.FromPython(GRAVITY))
    found = idyn.FreeFloatingGeneralizedTorques(tree.model())
    tree.inverseDynamics(idyn.Vector6.FromPython(a), none, idyn.LinkWrenches(tree.model()), found)
    force, moment = wrench(turn, omega, acceleration, omega_dot)
    found = found.baseWrench()
    found = np.array([found.getVal(i) for i in range(6)])
    return (position, v, a), found, np.concatenate([turn @ force, turn @ moment])


def dynibo(told, folder):
    """Position, x y z w; angular, linear in world axes at the base's origin; classical; moment, force in world axes."""
    import dynibo as dy
    turn, (w, x, y, z), position, velocity, omega, acceleration, omega_dot = told
    twist = lambda linear, angular: dy.Twist(linear=tuple(turn @ linear), angular=tuple(turn @ angular))
    base = dy.BaseState(frame=dy.Pose(translation=tuple(position), rotation_xyzw=(x, y, z, w)),
                        velocity=twist(velocity, omega), acceleration=twist(acceleration, omega_dot))
    q = np.array([*position, x, y, z, w])
    v = np.array([*(turn @ omega), *(turn @ velocity)])
    a = np.array([*(turn @ omega_dot), *(turn @ acceleration)])
    with dy.FloatingRobot.from_urdf(urdf(folder)) as robot:
        none = np.zeros(robot.joint_count)
        found = np.array(robot.inverse_dynamics(base, none, none, none))
    force, moment = wrench(turn, omega, acceleration, omega_dot)
    return (q, v, a), found, np.concatenate([turn @ moment, turn @ force])


TOOLS = [pinocchio, mujoco, drake, idyntree, dynibo]
MODULES = {"drake": "pydrake"}


def main():
    random, failed, golden = np.random.default_rng(3), [], {}
    told = state(random)
    turn, _, position, velocity, omega, acceleration, omega_dot = told
    with tempfile.TemporaryDirectory() as folder:
        for tool in TOOLS:
            name = tool.__name__
            if importlib.util.find_spec(MODULES.get(name, name)) is None:
                print(f"{name}: not installed")
                continue
            (q, v, a), found, expected = tool(told, folder)
            error = np.abs(found - expected).max() / np.abs(expected).max()
            print(f"{name}: largest error {error:.1e}  ({tool.__doc__})")
            if error > TOLERANCE:
                failed.append(name)
            golden[name] = {"q": list(q), "v": list(v), "a": list(a), "force": list(found)}
    if failed:
        sys.exit(f"failed: {', '.join(failed)}")
    if "--write" in sys.argv:
        force, moment = wrench(turn, omega, acceleration, omega_dot)
        base = {"rotation": turn.tolist(), "position": list(position), "velocity": list(velocity), "omega": list(omega),
                "acceleration": list(acceleration), "omega_dot": list(omega_dot), "gravity": list(GRAVITY),
                "force": list(force), "moment": list(moment)}
        file = pathlib.Path(__file__).parent.parent / "functions/floating/conventions.json"
        parts = {"base": base, "imu": IMU, **golden}
        parts = {name: {key: np.asarray(x, float).tolist() for key, x in part.items()} for name, part in parts.items()}
        file.write_text(json.dumps(parts, indent=1) + "\n")


if __name__ == "__main__":
    main()
