"""Dynamics of robots on floating bases beside Pinocchio and MuJoCo, which read the same URDF.

Usage: python floating.py RNE FOLDER [--write]     where RNE is the binary and FOLDER has the URDFs that ROBOTS names.

`rne import --whole --floating --no-snap` makes the robot file. States are random: any orientation of the base, and
a position, linear and angular velocities and accelerations of it, which Pinocchio takes as a configuration with a
quaternion and as spatial vectors in axes of the base. Its mass matrix is by crba, its bias by nle, its accelerations by
aba, Jacobians and accelerations of tips are those of its frames, in world axes. Its regressor refers to frames of
joints: the parameters of units about our link frames are carried there. Its derivatives of rnea, with a wrench at
each tip, are by the tangent of its configuration, in axes of the base. With --write the robot files and the values of
Pinocchio go to tests/functions/floating; of the regressor, its product with random parameters.

Of MuJoCo it is mj_inverse, mj_fullM, qfrc_bias, qacc of mj_forward, its energies, momenta and Jacobians. Its velocity
of a free joint is linear in world axes and angular in axes of the base. It has no regressor, and its contacts are soft.

Joints that follow others, such as rotors, do so in both tools: with the ratios G between all velocities and those of
the coordinates, G v of coordinates, Gᵀ τ of forces and Gᵀ M G.
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile
from xml.etree import ElementTree

import mujoco as mj
import numpy as np
import pinocchio as pin

TOLERANCE = 1e-12
DAMPING = 1e-8
STATES = 3
DERIVATIVES = "floating_inverse_dynamics_derivatives"
FUNCTIONS = ["inverse_dynamics_of_floating_base", "floating_mass_matrix", "floating_bias", "floating_forward_dynamics",
             "centroidal_momentum_matrix", "centroidal_bias", "floating_regressor", "floating_kinetic_energy",
             "floating_potential_energy", "centroidal_momentum", "tip_jacobians", "tip_accelerations",
             "forward_dynamics_in_contact", DERIVATIVES]

# Name of the URDF, the licence, if its numbers stand in this repository, links that are tips, and the
# contacts: points hold all tips, the feet of a quadruped; welds hold the first two, the feet of a humanoid.
ROBOTS = [
    ("grid_hyq", "MIT", ["lf_lowerleg", "lh_lowerleg", "rf_lowerleg", "rh_lowerleg"], "point"),
    ("erd_anymal_c", "BSD-3-Clause", ["LF_FOOT", "RF_FOOT", "LH_FOOT", "RH_FOOT"], "point"),
    ("grid_atlas", "MIT", ["l_foot", "r_foot", "l_hand", "r_hand"], "weld"),
    ("h1", "BSD-3-Clause", ["left_ankle_link", "right_ankle_link"], "weld"),
    ("erd_solo12", None, ["FL_FOOT", "FR_FOOT", "HL_FOOT", "HR_FOOT"], "point"),
    ("go2_unitree", None, ["FL_foot", "FR_foot", "RL_foot", "RR_foot"], "point"),
    ("g1_29dof", None, ["left_ankle_roll_link", "right_ankle_roll_link", "left_rubber_hand", "head_link"], "weld"),
    ("erd_simple_humanoid", None, ["l_ankle", "r_ankle"], "weld"),
    ("grbda_mit_humanoid", None, ["right_ankle_link", "left_ankle_link", "right_elbow_link"], "weld"),
    ("grbda_mit_humanoid_approximate", None, ["right_ankle_link", "left_ankle_link", "right_elbow_link"], "weld"),
]


class Joints:
    """The joints of a robot file: their names, and which of them follow which, with the ratio."""

    def __init__(self, text):
        self.names = re.findall(r"- name: (\S+)\n", text)
        follows = re.findall(r"- \{joint: (\S+), follows: \{(.*)\}\}", text)
        ratios = lambda leaders: [(leader, float(ratio)) for leader, ratio in re.findall(r"(\S+): ([^,]+)", leaders)]
        self.follows = {joint: ratios(leaders) for joint, leaders in follows}
        self.coordinates = [name for name in self.names if name not in self.follows]

    def of(self, name, values):
        """The position or rate of a joint."""
        leaders = self.follows.get(name, [(name, 1.0)])
        return sum(ratio * values[self.coordinates.index(leader)] for leader, ratio in leaders)

    def ratios(self, places, count):
        """G: all velocities of a tool, in which the joints have these places, from those of the coordinates."""
        matrix = np.zeros((count, 6 + len(self.coordinates)))
        matrix[:6, :6] = np.eye(6)
        for name, place in zip(self.names, places):
            matrix[place, 6:] = [self.of(name, unit) for unit in np.eye(len(self.coordinates))]
        return matrix


def state(random, names, tips):
    """Joints, and the base in its own axes: v of its origin, ω, the acceleration of this point, ω̇, and gravity."""
    dof = len(names)
    joints = {"q": random.uniform(-1, 1, dof), "qd": random.uniform(-2, 2, dof), "qdd": random.uniform(-5, 5, dof)}
    tau = np.random.default_rng(dof).uniform(-20, 20, dof)
    turn = np.linalg.qr(random.normal(size=(3, 3)))[0]
    turn *= np.linalg.det(turn)
    velocity, omega, acceleration, omega_dot = random.normal(size=(4, 3))
    gravity = turn.T @ [0, 0, -9.81]
    told = {"omega": omega, "omega_dot": omega_dot, "acceleration": acceleration, "gravity": gravity}
    position = np.random.default_rng(dof + 1).normal(size=3)
    told |= {"velocity": velocity, "pose": np.array([*turn.flatten(), *position]), "base_rotation": turn.flatten()}
    joints["wrenches"] = np.random.default_rng(dof + 2).normal(size=6 * tips, scale=10)
    return {**joints, "tau": tau}, told


# Row and column of the elements of an inertia: ours, and Pinocchio's.
OURS = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)]
PINOCCHIO = [(0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2)]


def carried(pose):
    """What turns parameters about a frame, in our order, into those about the frame in which it stands at `pose`, in
    Pinocchio's order: ∫ (r, 1) (r, 1)ᵀ dm of one is that of the other between two homogeneous matrices."""
    columns = []
    for unit in np.eye(10):
        inertia = np.zeros((3, 3))
        for (row, column), value in zip(OURS, unit[4:]):
            inertia[row, column] = inertia[column, row] = value
        pseudo = np.zeros((4, 4))
        pseudo[:3, :3] = np.trace(inertia) / 2 * np.eye(3) - inertia
        pseudo[:3, 3] = pseudo[3, :3] = unit[1:4]
        pseudo[3, 3] = unit[0]
        pseudo = pose @ pseudo @ pose.T
        second = pseudo[:3, :3]
        inertia = np.trace(second) * np.eye(3) - second
        columns.append([pseudo[3, 3], *pseudo[:3, 3], *(inertia[at] for at in PINOCCHIO)])
    return np.array(columns).T


def regressor(model, names, q, v, a, ratios, links):
    """The regressor about our link frames, of which `links` has the pose in frame 0 for each joint."""
    data = model.createData()
    of_frames = ratios.T @ pin.computeJointTorqueRegressor(model, data, q, v, a)
    pin.forwardKinematics(model, data, q)
    bodies = [(1, np.eye(4))]
    for name, link in zip(names, links):
        joint = model.getJointId(name)
        bodies.append((joint, data.oMi[joint].inverse().homogeneous @ data.oMi[1].homogeneous @ link))
    return np.hstack([of_frames[:, 10 * (joint - 1):10 * joint] @ carried(pose) for joint, pose in bodies])


def pinocchio(urdf, names, tips, kind, joints, told, links):
    """The numbers of each of FUNCTIONS. Those of the base stand first; its accelerations are classical, less gravity."""
    model = pin.buildModelFromUrdf(str(urdf))
    turn, velocity = told["pose"][:9].reshape(3, 3), told["velocity"]
    q, v, a = np.zeros(model.nq), np.zeros(model.nv), np.zeros(model.nv)
    q[:3] = told["pose"][9:]
    q[3:7] = pin.Quaternion(turn).coeffs()
    v[:3], v[3:6] = velocity, told["omega"]
    # spatial: the acceleration of the point of the base less ω × v
    a[:3], a[3:6] = told["acceleration"] - np.cross(told["omega"], velocity), told["omega_dot"]
    rows = []
    for name in names.names:
        position, rate, rate_dot = (names.of(name, joints[key]) for key in ["q", "qd", "qdd"])
        joint = model.joints[model.getJointId(name)]
        if joint.nq == 2:
            q[joint.idx_q], q[joint.idx_q + 1] = np.cos(position), np.sin(position)
        else:
            q[joint.idx_q] = position
        v[joint.idx_v], a[joint.idx_v] = rate, rate_dot
        rows.append(joint.idx_v)
    model.armature = np.zeros(model.nv)
    ratios = names.ratios(rows, model.nv)
    torques = ratios.T @ pin.rnea(model, model.createData(), q, v, a)
    mass = pin.crba(model, model.createData(), q)
    mass = ratios.T @ (np.triu(mass) + np.triu(mass, 1).T) @ ratios
    # of the base whose spatial acceleration is zero and which does not fall
    classical = np.cross(told["omega"], velocity) - told["gravity"]
    at_rest = ratios.T @ pin.nonLinearEffects(model, model.createData(), q, v)
    bias = at_rest - mass[:, :3] @ classical
    tau = np.concatenate([np.zeros(6), joints["tau"]])
    if names.follows:
        accelerations = np.linalg.solve(mass, tau - at_rest)
    else:
        accelerations = ratios.T @ pin.aba(model, model.createData(), q, v, ratios @ tau)
    free = accelerations.copy()
    accelerations[:3] += classical
    # momentum about the centre of mass in world axes, and its rate
    data = model.createData()
    map_ = pin.computeCentroidalMap(model, data, q).copy()
    rate = pin.computeCentroidalMapTimeVariation(model, model.createData(), q, v) @ v
    rate -= map_[:, :3] @ np.cross(told["omega"], velocity)
    in_base = np.kron(np.eye(2), turn.T)
    centroidal = [(in_base @ map_ @ ratios).flatten(), in_base @ rate]
    columns = None if names.follows else regressor(model, names.names, q, v, a, ratios, links).flatten()
    energies = [np.array([pin.computeKineticEnergy(model, model.createData(), q, v)]),
                np.array([pin.computePotentialEnergy(model, model.createData(), q)])]
    pin.ccrba(model, data, q, v)
    momentum = in_base @ data.hg.vector
    # tips in world axes; those of a base whose acceleration is zero
    at_rest = np.zeros(model.nv)
    at_rest[:3] = -np.cross(told["omega"], velocity)
    data = model.createData()
    pin.forwardKinematics(model, data, q, v, at_rest)
    jacobians, lacking = [], []
    for tip in tips:
        frame = model.getFrameId(tip)
        axes = pin.LOCAL_WORLD_ALIGNED
        jacobian = pin.computeFrameJacobian(model, model.createData(), q, frame, axes)
        jacobians.append((jacobian @ ratios).flatten())
        lacking.append(pin.getFrameClassicalAcceleration(model, data, frame, axes).vector)
    of_tips = [np.concatenate(jacobians), np.concatenate(lacking)]
    # contacts in world axes, under Pinocchio's gravity
    rows = held(tips, kind)
    pin.forwardKinematics(model, data, q, v, np.zeros(model.nv))
    drift = [pin.getFrameClassicalAcceleration(model, data, model.getFrameId(tip), axes).vector for tip in tips]
    jacobian, drift = np.concatenate(jacobians).reshape(-1, len(tau))[rows], np.concatenate(drift)[rows]
    if names.follows:
        columns_of_forces = np.linalg.solve(mass, jacobian.T)
        held_still = jacobian @ columns_of_forces + DAMPING * np.eye(len(rows))
        forces = -np.linalg.solve(held_still, jacobian @ free + drift)
        accelerating = free + columns_of_forces @ forces
    else:
        data = model.createData()
        held_still = [ratios @ tau, jacobian @ ratios.T, drift, DAMPING]
        accelerating, forces = ratios.T @ pin.forwardDynamics(model, data, q, v, *held_still), data.lambda_c
    accelerating[:3] += classical
    wrenches = np.zeros(6 * len(tips))
    wrenches[rows] = forces
    of_tips.append(np.concatenate([accelerating, wrenches]))
    # what tips exert is constant in their axes, what acts on joints is the opposite of it
    forces = pin.StdVec_Force()
    forces.extend([pin.Force.Zero()] * model.njoints)
    for tip, wrench in zip(tips, joints["wrenches"].reshape(-1, 6)):
        at_tip = model.frames[model.getFrameId(tip)]
        forces[at_tip.parentJoint] -= at_tip.placement.act(pin.Force(wrench))
    # the matrices live in the data
    data = model.createData()
    by = pin.computeRNEADerivatives(model, data, q, v, a, forces)[:2]
    of_tips.append(np.concatenate([(ratios.T @ matrix @ ratios).flatten() for matrix in by]))
    results = [torques, mass.flatten(), bias, accelerations, *centroidal, columns, *energies, momentum, *of_tips]
    return {name: result for name, result in zip(FUNCTIONS, results) if result is not None}


def mujoco_model(urdf):
    """The robot without what is drawn. Links that are fixed keep their frames. MuJoCo refuses some inertias of real
    files, which are put in their places when it has read another one that no axes simplify."""
    robot = ElementTree.fromstring(urdf.read_text())
    ElementTree.SubElement(ElementTree.SubElement(robot, "mujoco"), "compiler", fusestatic="false")
    inertias = {}
    for link in robot.iter("link"):
        for drawn in [*link.findall("visual"), *link.findall("collision")]:
            link.remove(drawn)
        tensor = link.find("inertial/inertia")
        if tensor is not None:
            ixx, ixy, ixz, iyy, iyz, izz = (float(tensor.get(key)) for key in "ixx ixy ixz iyy iyz izz".split())
            origin = link.find("inertial/origin")
            rpy = [0.0] * 3 if origin is None else [float(x) for x in origin.get("rpy", "0 0 0").split()]
            turn = pin.rpy.rpyToMatrix(*rpy)
            inertias[link.get("name")] = turn @ [[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]] @ turn.T
            tensor.attrib.update(ixx="3", iyy="4", izz="5", ixy="0.1", ixz="0.2", iyz="0.3")
    model = mj.MjModel.from_xml_string(ElementTree.tostring(robot, encoding="unicode"))
    for name, inertia in inertias.items():
        body = model.body(name).id
        moments, axes = np.linalg.eigh(inertia)
        axes *= np.linalg.det(axes)
        model.body_inertia[body] = moments
        mj.mju_mat2Quat(model.body_iquat[body], axes.flatten())
    return model


def mujoco(urdf, names, tips, _, joints, told, __):
    """The same of MuJoCo, for the functions that it has."""
    model = mujoco_model(urdf)
    model.dof_armature[:] = model.dof_damping[:] = model.dof_frictionloss[:] = 0
    model.opt.disableflags |= mj.mjtDisableBit.mjDSBL_CONSTRAINT
    model.opt.enableflags |= mj.mjtEnableBit.mjENBL_ENERGY
    data, turn = mj.MjData(model), told["pose"][:9].reshape(3, 3)
    data.qpos[:3] = told["pose"][9:]
    mj.mju_mat2Quat(data.qpos[3:7], told["pose"][:9].copy())
    data.qvel[:6] = [*(turn @ told["velocity"]), *told["omega"]]
    data.qacc[:6] = [*(turn @ told["acceleration"]), *told["omega_dot"]]
    places = [model.joint(name).dofadr[0] for name in names.names]
    for name, place in zip(names.names, places):
        data.qpos[model.joint(name).qposadr[0]] = names.of(name, joints["q"])
        data.qvel[place], data.qacc[place] = names.of(name, joints["qd"]), names.of(name, joints["qdd"])
    ratios = names.ratios(places, model.nv)
    # from velocities of the base in its own axes
    ratios[:3, :3] = turn
    mj.mj_inverse(model, data)
    torques = ratios.T @ data.qfrc_inverse
    tau = np.concatenate([np.zeros(6), joints["tau"]])
    data.qfrc_applied = np.linalg.pinv(ratios).T @ tau
    mj.mj_forward(model, data)
    mass = np.zeros((model.nv, model.nv))
    mj.mj_fullM(model, data, mass)
    mass, at_rest = ratios.T @ mass @ ratios, ratios.T @ data.qfrc_bias
    bias = at_rest + mass[:, :3] @ told["gravity"]
    accelerations = np.linalg.solve(mass, tau - at_rest) if names.follows else ratios.T @ data.qacc
    accelerations[:3] -= told["gravity"]
    linear, angular = np.zeros((2, 3, model.nv))
    base = model.jnt_bodyid[0]
    mj.mj_jacSubtreeCom(model, data, linear, base)
    mj.mj_angmomMat(model, data, angular, base)
    mj.mj_subtreeVel(model, data)
    of_momentum = np.kron(np.eye(2), turn.T) @ np.vstack([model.body_subtreemass[base] * linear, angular]) @ ratios
    momentum = [model.body_subtreemass[base] * data.subtree_linvel[base] @ turn, data.subtree_angmom[base] @ turn]
    jacobians, lacking = [], []
    for tip in tips:
        body = model.body(tip).id
        jacobian, rate = np.zeros((2, 6, model.nv))
        mj.mj_jacBody(model, data, jacobian[:3], jacobian[3:], body)
        mj.mj_jacDot(model, data, rate[:3], rate[3:], data.xpos[body].copy(), body)
        jacobians.append((jacobian @ ratios).flatten())
        lacking.append(rate @ data.qvel)
    potential, kinetic = data.energy
    return {"inverse_dynamics_of_floating_base": torques, "floating_mass_matrix": mass.flatten(), "floating_bias": bias,
            "floating_forward_dynamics": accelerations, "centroidal_momentum_matrix": of_momentum.flatten(),
            "floating_kinetic_energy": np.array([kinetic]), "floating_potential_energy": np.array([potential]),
            "centroidal_momentum": np.concatenate(momentum), "tip_jacobians": np.concatenate(jacobians),
            "tip_accelerations": np.concatenate(lacking)}


def floating(urdf, folder):
    """The URDF with a floating joint at its root, if it has none."""
    text = re.sub(r"<!--.*?-->|<mujoco>.*?</mujoco>", "", urdf.read_text(), flags=re.S)
    held = re.search(r'type="floating">.*?<parent\s+link="([^"]+)"', text, re.S)
    if held:
        # MuJoCo knows that this one stands still
        text = text.replace(f'"{held[1]}"', '"world"')
    else:
        children = re.findall(r'<child\s+link="([^"]+)"', text)
        root = next(link for link in re.findall(r'<link\s+name="([^"]+)"', text) if link not in children)
        joint = f'<joint name="free" type="floating"><parent link="world"/><child link="{root}"/></joint>'
        text = text.replace("</robot>", f'<link name="world"/>{joint}</robot>')
    file = folder / urdf.name
    file.write_text(text)
    return file


def held(tips, kind):
    """The accelerations that contacts keep zero, by their places among six for each tip."""
    points = [6 * tip + row for tip in range(len(tips)) for row in range(3)]
    return points if kind == "point" else list(range(12))


def contacts(tips, kind):
    """The list `contacts` of the robot file."""
    contact = "{{tip: {}, kind: {}}}"
    return ", ".join(contact.format(tip, kind) for tip in (tips if kind == "point" else tips[:2]))


def cross(vector):
    """The matrix of a cross product."""
    return np.cross(vector, np.eye(3), axisb=0, axisc=0)


def by_tangent(rne, file, options, velocity, mass):
    """∂τ/∂q and ∂τ/∂v of Pinocchio: its spatial acceleration and gravity in world axes are constant."""
    result = evaluated(rne, file, DERIVATIVES, options)
    dq, dqd, domega = (np.array(result[name]) for name in ["dq", "dqd", "domega"])
    linear, omega = mass.reshape(len(dq), -1)[:, :3], options["base-omega"]
    by_turn, by_linear = -linear @ cross(options["gravity"]), linear @ cross(omega)
    by_angular = domega - linear @ cross(velocity)
    by_q = np.hstack([np.zeros_like(by_turn), by_turn, dq])
    return np.concatenate([by_q.flatten(), np.hstack([by_linear, by_angular, dqd]).flatten()])


def numbers(result):
    """All numbers of a result, in order."""
    if isinstance(result, dict):
        names = ["accelerations", "wrench", "force", "moment", "tau", "base", "linear", "angular", "qdd", "wrenches_on_robot"]
        result = [result[name] for name in names if name in result]
    return [x for part in result for x in numbers(part)] if isinstance(result, list) else [result]


def link_poses(rne, file, q):
    """The link frames in frame 0 as homogeneous matrices."""
    poses = evaluated(rne, file, "link_poses", {"q": q})
    matrix = lambda pose: np.vstack([np.column_stack([pose["rotation"], pose["translation"]]), [0, 0, 0, 1]])
    return [matrix(pose) for pose in poses]


def found(rne, file, function, joints, told, listed, mass):
    """The same of the runtime library."""
    wrenches = joints["wrenches"].reshape(-1, 6)
    options = {**joints, "base-rotation": told["base_rotation"], "base-omega": told["omega"],
               "base-omega-dot": told["omega_dot"], "base-acceleration": told["acceleration"],
               "gravity": told["gravity"], "base-velocity": told["velocity"], "base-pose": told["pose"]}
    takes = {
        "inverse_dynamics_of_floating_base": ["q", "qd", "qdd", "base-omega", "base-omega-dot", "base-acceleration", "gravity"],
        "floating_regressor": ["q", "qd", "qdd", "base-omega", "base-omega-dot", "base-acceleration", "gravity"],
        "floating_mass_matrix": ["q"],
        "floating_kinetic_energy": ["q", "qd", "base-velocity", "base-omega"],
        "floating_potential_energy": ["q", "base-pose"],
        "centroidal_momentum": ["q", "qd", "base-velocity", "base-omega"],
        "centroidal_momentum_matrix": ["q"],
        "centroidal_bias": ["q", "qd", "base-omega"],
        "tip_jacobians": ["q", "base-rotation"],
        "forward_dynamics_in_contact": ["q", "qd", "tau", "base-omega", "base-rotation"],
        "tip_accelerations": ["q", "qd", "base-omega", "base-rotation"],
        "floating_bias": ["q", "qd", "base-omega"],
        "floating_forward_dynamics": ["q", "qd", "tau", "base-omega"],
    }
    if function == DERIVATIVES:
        told = {key: options[key] for key in takes["inverse_dynamics_of_floating_base"]}
        told |= {f"tip-wrench={tip}": wrench for tip, wrench in zip(listed, wrenches)}
        return by_tangent(rne, file, told, options["base-velocity"], mass)
    return np.array(numbers(evaluated(rne, file, function, {key: options[key] for key in takes[function]})))


def evaluated(rne, file, function, options):
    """What `rne eval` prints for these options."""
    options = [f"--{key}={','.join(repr(float(x)) for x in value)}" for key, value in options.items()]
    done = subprocess.run([rne, "eval", file, "--function", function, *options, "--json"], capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(done.stderr)
    return json.loads(done.stdout)["result"]


def main():
    rne, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    write = pathlib.Path(__file__).parent.parent / "functions/floating" if "--write" in sys.argv else None
    failed = []
    with tempfile.TemporaryDirectory() as temporary:
        for name, licence, tips, kind in ROBOTS:
            file = pathlib.Path(temporary) / f"{name}.yaml"
            urdf = floating(folder / f"{name}.urdf", pathlib.Path(temporary))
            subprocess.run([rne, "import", folder / urdf.name, "--whole", "--floating", "--no-snap", "--keep-unphysical",
                            "-o", file, *(f"--tip={tip}" for tip in tips)], check=True, capture_output=True)
            text = file.read_text()
            listed = re.search(r"^tips: \[(.*)\]", text, re.M)[1].split(", ")
            file.write_text(text.replace("joints:\n", f"contacts: [{contacts(listed, kind)}]\njoints:\n", 1))
            names = Joints(text)
            random, worst, states = np.random.default_rng(1), {}, []
            for _ in range(STATES):
                joints, told = state(random, names.coordinates, len(tips))
                links = None if names.follows else link_poses(rne, file, joints["q"])
                ours = {}
                for tool in [mujoco, pinocchio]:
                    values = tool(urdf, names, tips, kind, joints, told, links)
                    for function, wanted in values.items():
                        if function not in ours:
                            ours[function] = found(rne, file, function, joints, told, listed, values["floating_mass_matrix"])
                        # accelerations are as uncertain as the mass matrix is badly conditioned
                        size = 6 + len(names.coordinates)
                        mass = values["floating_mass_matrix"].reshape(size, size)
                        of = np.linalg.cond(mass) if "forward" in function else 1
                        error = np.abs(ours[function] - wanted).max() / np.abs(wanted).max() / of
                        worst[tool.__name__] = max(worst.get(tool.__name__, (0.0, 0)), (error, len(values)))
                if names.follows:
                    continue
                # ours, and the tangent of its configuration
                derivatives = values.pop(DERIVATIVES)
                if states:
                    # one matrix of each is enough
                    del values["floating_mass_matrix"]
                else:
                    values["derivatives_of_pinocchio"] = derivatives
                # of the regressor, a product is
                parameters = np.random.default_rng(len(states)).uniform(-1, 1, 10 * (1 + len(names.names)))
                rows = values.pop("floating_regressor").reshape(-1, len(parameters))
                values |= {"parameters": parameters, "floating_regressor_times_parameters": rows @ parameters}
                states.append({key: list(map(float, value)) for key, value in {**joints, **told, **values}.items()})
            for tool, (error, functions) in sorted(worst.items()):
                joints = f"{len(names.coordinates):2} joints"
                print(f"{name:31} {joints} {tool:10} {functions:2} functions {error:.1e}", flush=True)
            if any(error > TOLERANCE for error, _ in worst.values()):
                failed.append(name)
            elif write and licence:
                (write / f"{name}.yaml").write_text(file.read_text())
                golden = {"by": f"Pinocchio {pin.__version__}", "licence": licence, "states": states}
                # a line for each array
                text = re.sub(r",\n(?=[-\d])", ", ", json.dumps(golden, indent=0))
                (write / f"{name}.golden.json").write_text(re.sub(r"\[\n(?=[-\d])|(?<=\d)\n(?=\])", lambda it: it[0].strip(), text) + "\n")
    if failed:
        sys.exit(f"failed: {', '.join(failed)}")


if __name__ == "__main__":
    main()
