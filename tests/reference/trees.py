"""Whole robots imported by `rne import --whole` beside Pinocchio, which reads the same URDF.

Usage: python trees.py RNE FOLDER [--write]     where RNE is the binary and FOLDER has the URDFs that TREES names;
`cargo xtask urdf --trees FOLDER` calls it.

Every function of VALUES at a few states, with unsnapped numbers, to 1e-12 of its largest number; accelerations to 1e-12
times the condition number of the mass matrix. Joints that follow others are held at zero by both. With --write the robot files and the values at one state of those trees
whose licence allows it go to tests/functions/trees, for tests that need neither Pinocchio nor the URDFs.
"""

import json
import pathlib
import re
import sys
import tempfile

import numpy as np
import pinocchio as pin

from urdf import Imported, Reference, states

TOLERANCE = 1e-12
STATES = 3
# Matrices of more joints than this are not written: they are long, and their products with vectors are.
MATRICES = 7

# Name of the URDF, options of the import, and the licence, if the numbers may stand in this repository.
TREES = [
    ("grid_hyq", "--lock-others", "MIT"),
    ("grid_atlas", "--lock-others --keep-unphysical", "MIT"),
    ("grid_iiwa", "", "MIT"),
    ("grbda_four_bar", "", "MIT"),
    ("grbda_six_bar", "", "MIT"),
    ("grbda_planar_leg_linkage", "", "MIT"),
    ("grbda_revolute_rotor_chain", "", "MIT"),
    ("grbda_mini_cheetah_approximate", "--lock-others", "MIT"),
    ("grbda_mini_cheetah", "--lock-others", "MIT"),
    ("grbda_mit_humanoid_approximate", "--lock-others", "MIT"),
    ("grbda_mit_humanoid", "--lock-others", None),
    ("grbda_tello_humanoid", "--lock-others", None),
    ("grbda_jvrc1_humanoid", "--lock-others", None),
    ("epr_5bar_linkage", "", "BSD-3-Clause"),
    ("epr_robot_delta", "", "BSD-3-Clause"),
    ("epr_cassie_like", "", "BSD-3-Clause"),
    ("epr_digit_like_2legs", "", None),
    ("erd_solo12", "", "BSD-3-Clause"),
    ("erd_anymal_c", "", "BSD-3-Clause"),
    ("erd_simple_humanoid", "", "BSD-2-Clause"),
    ("erd_panda_hand", "", "Apache-2.0"),
    ("erd_baxter", "", "BSD"),
    ("erd_romeo", "", None),
    ("g1_29dof", "", None),
    ("g1_29dof_with_hand", "", "BSD-3-Clause"),
    ("h1", "", "BSD-3-Clause"),
    ("go2_unitree", "", "BSD-3-Clause"),
    # copyleft, or a licence that is not stated
    ("erd_allegro_right", "", None),
    ("erd_b1_z1", "", None),
    ("erd_go2", "", None),
    ("erd_icub", "", None),
    ("erd_talos_full_v2", "--keep-unphysical", None),
]


class Values(Reference):
    """What Pinocchio has for each function, in the order of rne's joints; wrenches in tip axes, the rest in the world's."""

    def values(self, state):
        q, v, a = self.arguments(state["q"], state["qd"], state["qdd"])
        rows = [joint.idx_v for joint in self.order]
        tau = np.zeros(len(rows))
        tau[rows] = state["tau"]
        model, data = self.model, self.data
        mass = pin.crba(model, data, q)
        mass = (np.triu(mass) + np.triu(mass, 1).T)[np.ix_(rows, rows)]
        rnea = pin.rnea(model, data, q, v, a)[rows]
        dq, dqd, _ = (np.array(part)[np.ix_(rows, rows)] for part in pin.computeRNEADerivatives(model, data, q, v, a))
        pin.computeJointJacobians(model, data, q)
        axes = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        jacobian = pin.getFrameJacobian(model, data, self.tip, axes)[:, rows]
        tip = pin.updateFramePlacement(model, data, self.tip)
        wrench = np.concatenate([tip.rotation @ state["wrench"][:3], tip.rotation @ state["wrench"][3:]])
        pin.forwardKinematics(model, data, q, v, np.zeros(len(rows)))
        drift = pin.getFrameClassicalAcceleration(model, data, self.tip, axes)
        momentum = mass @ state["qd"]
        return {
            "inverse_dynamics": rnea,
            "inverse_dynamics_with_wrench": rnea + jacobian.T @ wrench,
            "gravity_torques": pin.computeGeneralizedGravity(model, data, q)[rows],
            "bias_torques": pin.nonLinearEffects(model, data, q, v)[rows],
            "mass_matrix": mass,
            "forward_dynamics": pin.aba(model, data, q, v, tau)[rows],
            "inverse_dynamics_derivatives": np.vstack([dq, dqd]),
            "forward_kinematics": np.vstack([tip.rotation, tip.translation]),
            "jacobian": jacobian,
            "jacobian_rate_times_velocity": np.concatenate([drift.linear, drift.angular]),
            "wrench_torques": jacobian.T @ wrench,
            "kinetic_energy": np.array(momentum @ state["qd"] / 2),
            "potential_energy": np.array(pin.computePotentialEnergy(model, data, q)),
            "centre_of_mass": pin.centerOfMass(model, data, q),
        }


ARGUMENTS = {
    "inverse_dynamics": ["q", "qd", "qdd"],
    "inverse_dynamics_with_wrench": ["q", "qd", "qdd", "wrench"],
    "bias_torques": ["q", "qd"],
    "forward_dynamics": ["q", "qd", "tau"],
    "inverse_dynamics_derivatives": ["q", "qd", "qdd"],
    "jacobian_rate_times_velocity": ["q", "qd"],
    "wrench_torques": ["q", "wrench"],
    "kinetic_energy": ["q", "qd"],
}


def flat(value):
    """All numbers of an answer in JSON, in their order."""
    if isinstance(value, dict):
        return [x for part in value.values() for x in flat(part)]
    return [x for part in value for x in flat(part)] if isinstance(value, list) else [value]


def compare(arm, reference, state):
    """The largest error of each function."""
    errors = {}
    expected = reference.values(state)
    eigenvalues = np.linalg.eigvalsh(expected["mass_matrix"])
    for function, values in expected.items():
        keys = ARGUMENTS.get(function, ["q"])
        found = np.array(flat(arm.eval(function, **{key: state[key] for key in keys})))
        scale = max(np.abs(values).max(), 1e-300)
        if function in ("gravity_torques", "bias_torques", "wrench_torques", "inverse_dynamics_derivatives"):
            scale = max(scale, np.abs(expected["inverse_dynamics_with_wrench"]).max())  # may vanish
        if function == "forward_dynamics":
            scale *= eigenvalues[-1] / eigenvalues[0]
        elif function.endswith("energy") or function == "jacobian_rate_times_velocity":
            scale = max(scale, 1.0)
        errors[function] = np.abs(found - values.ravel()).max() / scale
    return errors


def golden(reference, state, licence):
    """The values at one state, a line each."""
    values = {name: values for name, values in reference.values(state).items()
              if values.ndim < 2 or values.size <= 12 or len(state["q"]) <= MATRICES}
    listed = lambda values: json.dumps([float(x) for x in np.ravel(values)])
    lines = [f'"by": "Pinocchio {pin.__version__}"', f'"licence": "{licence}"']
    lines += [f'"{key}": {listed(numbers)}' for key, numbers in [*state.items(), *values.items()]]
    return "{\n" + ",\n".join(lines) + "\n}\n"


def main():
    rne, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    names = [name for name in sys.argv[3:] if not name.startswith("--")]
    write = pathlib.Path(__file__).parent.parent / "functions/trees" if "--write" in sys.argv else None
    failed, seen = [], 0
    with tempfile.TemporaryDirectory() as temporary:
        for name, words, licence in TREES:
            path = folder / f"{name}.urdf"
            if not path.exists() or names and name not in names:
                continue
            # the trees, without the closed loops of the text and of the YAML beside it
            text, path = re.sub(r"<loop\b.*?</loop>", "", path.read_text(), flags=re.S), pathlib.Path(temporary) / path.name
            path.write_text(text)
            followers = re.findall(r'<joint\s+name="([^"]*)"[^>]*>(?:(?!</joint>).)*<mimic', text, re.S)
            words += "".join(f" --lock {follower}=0" for follower in followers)
            try:
                arm = Imported(rne, path, ["--whole", "--no-snap", *words.split()], pathlib.Path(temporary), name)
                tip = arm.account.split("\n")[1].rsplit(" to ", 1)[1]
                reference = Values(path, arm.joints, arm.held(), tip)
                random, worst = np.random.default_rng(1), {}
                for q, qd, qdd in states(arm.joints, arm.kinds, reference.model)[:STATES]:
                    vectors = {"tau": random.uniform(-20, 20, len(q)), "wrench": random.uniform(-10, 10, 6)}
                    state = {"q": np.array(q), "qd": qd, "qdd": qdd, **vectors}
                    for function, error in compare(arm, reference, state).items():
                        worst[function] = max(worst.get(function, 0.0), error)
            except (RuntimeError, ValueError) as error:
                print(f"{name}: failed: {error}", flush=True)
                failed.append(name)
                continue
            seen += 1
            function = max(worst, key=worst.get)
            fine = worst[function] <= TOLERANCE
            print(f"{name}: {len(arm.joints)} joints, {len(worst)} functions, largest error {worst[function]:.1e} of "
                  f"{function}{'' if fine else ', FAILED'}", flush=True)
            if not fine:
                failed.append(name)
            elif write and licence:
                text = arm.file.read_text()
                (write / f"{name}.yaml").write_text(text)
                (write / f"{name}.golden.json").write_text(golden(reference, state, licence))
    print(f"{seen} trees")
    if failed or seen == 0:
        sys.exit(f"failed: {', '.join(failed) or 'no tree is in the folder'}")


if __name__ == "__main__":
    main()
