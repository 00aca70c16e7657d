"""Dynamics of robots on floating bases beside Pinocchio, which reads the same URDF.

Usage: python floating.py RNE FOLDER [--write]     where RNE is the binary and FOLDER has the URDFs that ROBOTS names.

`rne import --whole --floating --no-snap` makes the robot file. States are random: any orientation of the base, and
a position, linear and angular velocities and accelerations of it, which Pinocchio takes as a configuration with a
quaternion and as spatial vectors in axes of the base. Its mass matrix is by crba, its bias by nle, its accelerations by
aba, Jacobians and accelerations of tips are those of its frames, in world axes. Its regressor refers to frames of
joints: the parameters of units about our link frames are carried there. Its derivatives of rnea, with a wrench at
each tip, are by the tangent of its configuration, in axes of the base. With --write the robot files and the values go
to tests/functions/floating; of the regressor, its product with random parameters.
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile

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
]


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


def regressor(model, names, q, v, a, order, links):
    """The regressor about our link frames, of which `links` has the pose in frame 0 for each joint."""
    data = model.createData()
    of_frames = pin.computeJointTorqueRegressor(model, data, q, v, a)[order]
    pin.forwardKinematics(model, data, q)
    bodies = [(1, np.eye(4))]
    for name, link in zip(names, links):
        joint = model.getJointId(name)
        bodies.append((joint, data.oMi[joint].inverse().homogeneous @ data.oMi[1].homogeneous @ link))
    return np.hstack([of_frames[:, 10 * (joint - 1):10 * joint] @ carried(pose) for joint, pose in bodies])


def expected(model, names, tips, kind, joints, told, links):
    """The numbers of each of FUNCTIONS. Those of the base stand first; its accelerations are classical, less gravity."""
    turn, velocity = told["pose"][:9].reshape(3, 3), told["velocity"]
    q, v, a = np.zeros(model.nq), np.zeros(model.nv), np.zeros(model.nv)
    q[:3] = told["pose"][9:]
    q[3:7] = pin.Quaternion(turn).coeffs()
    v[:3], v[3:6] = velocity, told["omega"]
    # spatial: the acceleration of the point of the base less ω × v
    a[:3], a[3:6] = told["acceleration"] - np.cross(told["omega"], velocity), told["omega_dot"]
    rows = []
    for name, position, rate, rate_dot in zip(names, joints["q"], joints["qd"], joints["qdd"]):
        joint = model.joints[model.getJointId(name)]
        if joint.nq == 2:
            q[joint.idx_q], q[joint.idx_q + 1] = np.cos(position), np.sin(position)
        else:
            q[joint.idx_q] = position
        v[joint.idx_v], a[joint.idx_v] = rate, rate_dot
        rows.append(joint.idx_v)
    model.armature = np.zeros(model.nv)
    order = [*range(6), *rows]
    torques = pin.rnea(model, model.createData(), q, v, a)[order]
    mass = pin.crba(model, model.createData(), q)
    mass = (np.triu(mass) + np.triu(mass, 1).T)[np.ix_(order, order)]
    # of the base whose spatial acceleration is zero and which does not fall
    classical = np.cross(told["omega"], velocity) - told["gravity"]
    bias = pin.nonLinearEffects(model, model.createData(), q, v)[order] - mass[:, :3] @ classical
    tau = np.zeros(model.nv)
    tau[rows] = joints["tau"]
    accelerations = pin.aba(model, model.createData(), q, v, tau)[order]
    accelerations[:3] += classical
    # momentum about the centre of mass in world axes, and its rate
    data = model.createData()
    map_ = pin.computeCentroidalMap(model, data, q).copy()
    rate = pin.computeCentroidalMapTimeVariation(model, model.createData(), q, v) @ v
    rate -= map_[:, :3] @ np.cross(told["omega"], velocity)
    in_base = np.kron(np.eye(2), turn.T)
    centroidal = [(in_base @ map_)[:, order].flatten(), in_base @ rate]
    columns = regressor(model, names, q, v, a, order, links).flatten()
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
        jacobians.append(pin.computeFrameJacobian(model, model.createData(), q, frame, axes)[:, order].flatten())
        lacking.append(pin.getFrameClassicalAcceleration(model, data, frame, axes).vector)
    of_tips = [np.concatenate(jacobians), np.concatenate(lacking)]
    # contacts in world axes, under Pinocchio's gravity
    rows = held(tips, kind)
    pin.forwardKinematics(model, data, q, v, np.zeros(model.nv))
    drift = [pin.getFrameClassicalAcceleration(model, data, model.getFrameId(tip), axes).vector for tip in tips]
    jacobian = np.concatenate(jacobians).reshape(-1, 6 + len(names))[rows][:, np.argsort(order)]
    data = model.createData()
    accelerating = pin.forwardDynamics(model, data, q, v, tau, jacobian, np.concatenate(drift)[rows], DAMPING)[order]
    accelerating[:3] += classical
    wrenches = np.zeros(6 * len(tips))
    wrenches[rows] = data.lambda_c
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
    of_tips.append(np.concatenate([matrix[np.ix_(order, order)].flatten() for matrix in by]))
    results = [torques, mass.flatten(), bias, accelerations, *centroidal, columns, *energies, momentum, *of_tips]
    return dict(zip(FUNCTIONS, results))


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
    write = pathlib.Path(__file__).parent.parent / "tests/functions/floating" if "--write" in sys.argv else None
    failed = []
    with tempfile.TemporaryDirectory() as temporary:
        for name, licence, tips, kind in ROBOTS:
            urdf, file = folder / f"{name}.urdf", pathlib.Path(temporary) / f"{name}.yaml"
            subprocess.run([rne, "import", urdf, "--whole", "--floating", "--no-snap", "--keep-unphysical", "-o", file,
                            *(f"--tip={tip}" for tip in tips)], check=True, capture_output=True)
            text = file.read_text()
            listed = re.search(r"^tips: \[(.*)\]", text, re.M)[1].split(", ")
            file.write_text(text.replace("joints:\n", f"contacts: [{contacts(listed, kind)}]\njoints:\n", 1))
            names = re.findall(r"- name: (\S+)\n", file.read_text())
            model = pin.buildModelFromUrdf(str(urdf), pin.JointModelFreeFlyer())
            random, worst, states = np.random.default_rng(1), 0.0, []
            for _ in range(STATES):
                joints, told = state(random, names, len(tips))
                values = expected(model, names, tips, kind, joints, told, link_poses(rne, file, joints["q"]))
                for function, wanted in values.items():
                    # accelerations are as uncertain as the mass matrix is badly conditioned
                    size, mass = 6 + len(names), values["floating_mass_matrix"]
                    of = np.linalg.cond(mass.reshape(size, size)) if "forward" in function else 1
                    error = np.abs(found(rne, file, function, joints, told, listed, mass) - wanted).max() / np.abs(wanted).max() / of
                    worst = max(worst, error)
                # ours, and the tangent of its configuration
                derivatives = values.pop(DERIVATIVES)
                if states:
                    # one matrix of each is enough
                    del values["floating_mass_matrix"]
                else:
                    values["derivatives_of_pinocchio"] = derivatives
                # of the regressor, a product is
                parameters = np.random.default_rng(len(states)).uniform(-1, 1, 10 * (1 + len(names)))
                rows = values.pop("floating_regressor").reshape(-1, len(parameters))
                values |= {"parameters": parameters, "floating_regressor_times_parameters": rows @ parameters}
                states.append({key: list(map(float, value)) for key, value in {**joints, **told, **values}.items()})
            print(f"{name}: {len(names)} joints, largest error {worst:.1e}", flush=True)
            if worst > TOLERANCE:
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
