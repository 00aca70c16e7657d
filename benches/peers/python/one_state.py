"""one_state.py: microseconds of a call of every function of one state from Python, and of Pinocchio's function where it has
the same one; `cargo xtask performance python_calls` writes the rows with such a time, and those above 10 microseconds.

Arguments are plain arrays of float64, as a controller has them. The arm and the robot on a floating base are read from the
URDFs of example-robot-data, which Pinocchio reads too; a robot with contacts and a closed loop are files of this repository.
Of these the table has what the first two do not compute. Times are medians of 101 calls, the smallest of some rounds in which
rne and Pinocchio alternate. On a busy machine compare the last column, the time beside that of `inverse_dynamics` of the arm.
"""

import argparse
import os
import pathlib
import sys
import time
import warnings

os.environ["RAYON_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"  # before they are read
import numpy as np

import rne

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path += [str(ROOT / "tests/reference"), str(ROOT / "doors/python/tests")]
warnings.filterwarnings("ignore")
import one_state_calls

URDFS = {
    "panda": ("panda_description/urdf/panda.urdf", dict(tip="panda_link8", lock_others=True)),
    "hyq": ("hyq_description/robots/hyq_no_sensors.urdf", dict(whole=True, floating=True)),
}


def peers(pin, model, arm, is_floating):
    """Calls of Pinocchio, by the name of the function of rne."""
    data, random = model.createData(), np.random.default_rng(4)
    q, (v, a, tau) = pin.randomConfiguration(model, -np.ones(model.nq), np.ones(model.nq)), random.normal(size=(3, model.nv))
    of = lambda function, *arguments: lambda: function(model, data, *arguments)
    frame = model.nframes - 1
    names = {
        "inverse_dynamics": of(pin.rnea, q, v, a),
        "bias_torques": of(pin.nonLinearEffects, q, v),
        "mass_matrix": of(pin.crba, q),
        "forward_dynamics": of(pin.aba, q, v, tau),
        "inverse_dynamics_derivatives": of(pin.computeRNEADerivatives, q, v, a),
        "jacobian": of(pin.computeFrameJacobian, q, frame, pin.LOCAL_WORLD_ALIGNED),
        "regressor": of(pin.computeJointTorqueRegressor, q, v, a),
        "kinetic_energy": of(pin.computeKineticEnergy, q, v),
        "potential_energy": of(pin.computePotentialEnergy, q),
    }
    if is_floating:
        renamed = {"inverse_dynamics": "inverse_dynamics_of_floating_base", "bias_torques": "floating_bias", "jacobian": "tip_jacobians"}
        names = {renamed.get(name, f"floating_{name}"): call for name, call in names.items()}
        return names | {
            "centroidal_momentum_matrix": of(pin.ccrba, q, v),
            "centroidal_momentum": of(pin.computeCentroidalMomentum, q, v),
            "floating_euler_step": lambda: pin.integrate(model, q, 1e-3 * (v + 1e-3 * pin.aba(model, data, q, v, tau))),
        }
    return names | {
        "gravity_torques": of(pin.computeGeneralizedGravity, q),
        "coriolis_matrix": of(pin.computeCoriolisMatrix, q, v),
        "inverse_mass_matrix": of(pin.computeMinverse, q),
        "forward_dynamics_derivatives": of(pin.computeABADerivatives, q, v, tau),
        "forward_kinematics": of(pin.framesForwardKinematics, q),
        "centre_of_mass": of(pin.centerOfMass, q),
        "centre_of_mass_jacobian": of(pin.jacobianCenterOfMass, q),
        "euler_step": lambda: pin.integrate(model, q, 1e-3 * (v + 1e-3 * pin.aba(model, data, q, v, tau))),
    }


def loaded():
    """The robots, and calls of Pinocchio by the robot."""
    robots, calls = dict(one_state_calls.ROBOTS), {}
    try:
        import pinocchio as pin
    except ImportError as error:
        print(f"Pinocchio: skipped, {error}", file=sys.stderr)
        return robots, calls
    import urdf

    for name, (file, options) in URDFS.items():
        path = urdf.find(file)
        arm = robots[name] = rne.load(path, snap=False, **options)
        if options.get("floating"):
            model = pin.buildModelFromUrdf(str(path), pin.JointModelFreeFlyer())
        else:
            model = urdf.Reference(path, arm.joints, arm.held, options["tip"]).model
        calls[name] = peers(pin, model, arm, options.get("floating"))
    return robots, calls


def median(call, count):
    times = []
    for _ in range(count):
        start = time.perf_counter()
        call()
        times.append(time.perf_counter() - start)
    return sorted(times)[count // 2] * 1e6


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--all", action="store_true", help="with each argument that may be given besides")
    arguments.add_argument("--above", type=float, default=0.0, help="leave out what takes less, microseconds")
    arguments.add_argument("--rounds", type=int, default=5)
    given = arguments.parse_args()
    robots, peers = loaded()
    rows = [(robot, name, what, call, peers.get(robot, {}).get(name) if not what else None)
            for robot, name, what, call in one_state_calls.all_calls(robots) if given.all or not what]
    best = {}
    for _ in range(given.rounds):
        for at, (*_, call, peer) in enumerate(rows):
            for column, one in enumerate((call, peer)):
                if one:
                    best[at, column] = min(best.get((at, column), np.inf), median(one, 101))
    one = next(best[at, 0] for at, (_, name, what, *_) in enumerate(rows) if (name, what) == ("inverse_dynamics", ""))
    width = 58 if given.all else 42
    print(f"{'robot':<9} {'function':<{width}} {'rne':>7} {'pinocchio':>9} {'/ inverse_dynamics':>18}")
    shown = set()
    for at, (robot, name, what, _, peer) in enumerate(rows):
        is_new = given.all or robot in URDFS or (name, what) not in shown
        shown.add((name, what))
        if best[at, 0] > given.above and is_new:
            theirs = f"{best[at, 1]:9.1f}" if peer else " " * 9
            print(f"{robot:<9} {f'{name} {what}':<{width}} {best[at, 0]:7.1f} {theirs} {best[at, 0] / one:18.1f}")


if __name__ == "__main__":
    main()
