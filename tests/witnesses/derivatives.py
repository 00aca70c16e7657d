"""Derivatives that rne computes beside Pinocchio, which reads the URDF that rne exports.

Usage: python derivatives.py RNE [FILE ...]     where RNE is the binary; `cargo xtask derivatives --python` calls it.

Both are exact, so they differ by rounding: 1e-11 of the largest number of a matrix, times the condition number of the
mass matrix where that is inverted; 1e-9 for second derivatives. Pinocchio has these in C++ alone: `second_order.cpp`,
which g++ compiles with the headers of the packages pin and cmeel-eigen.
"""

import json
import pathlib
import re
import subprocess
import sys
import sysconfig
import tempfile

import numpy as np
import pinocchio as pin

TOLERANCE = 1e-11
SECOND_ORDER = 1e-9
# as the CMake files of Pinocchio define them
DEFINITIONS = ["BOOST_MPL_LIMIT_LIST_SIZE=30", "BOOST_MPL_LIMIT_VECTOR_SIZE=30", "BOOST_FUSION_INVOKE_MAX_ARITY=12"]
STATES = 3
SHIPPED = ["panda", "puma560", "ur5e", "iiwa14", "gen3", "z1"]
TREES = ["anymal_c", "go2", "erd_baxter", "erd_panda_hand"]


def run(program, *arguments):
    return subprocess.run([program, *arguments], check=True, capture_output=True, text=True).stdout


def second_order(folder):
    """The program of second derivatives, compiled in a folder."""
    packages = pathlib.Path(sysconfig.get_paths()["purelib"]) / "cmeel.prefix" / "include"
    eigen = next((it for it in (packages / "eigen3", pathlib.Path("/usr/include/eigen3")) if it.is_dir()), None)
    if eigen is None:
        sys.exit("The headers of Eigen are missing. Install them with: pip install cmeel-eigen")
    source, program = pathlib.Path(__file__).with_name("second_order.cpp"), pathlib.Path(folder) / "second_order"
    definitions = [f"-D{name}" for name in DEFINITIONS] + ["-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS"]
    headers = [f"-isystem{path}" for path in (packages, eigen)]
    try:
        run("g++", "-std=c++17", "-O1", "-w", *definitions, *headers, str(source), "-o", str(program))
    except FileNotFoundError:
        sys.exit("The compiler g++ is missing.")
    except subprocess.CalledProcessError as error:
        sys.exit(f"g++ cannot compile {source.name} with the headers in {packages}:\n{error.stderr[:2000]}")
    return program


class Pair:
    """A robot in rne, and in Pinocchio."""

    def __init__(self, program, second, file):
        self.program, self.second, self.file = program, second, str(file)
        urdf = run(program, "export", self.file, "--urdf")
        self.model = pin.buildModelFromXML(urdf)
        # the joints of rne in its order, by their places in Pinocchio
        names = re.findall(r'<joint name="([^"]*)" type="(?:revolute|continuous|prismatic)"', urdf)
        self.rows = [self.model.joints[self.model.getJointId(name)].idx_v for name in names]
        self.data = self.model.createData()

    def eval(self, function, **state):
        numbers = {f"--{name}": ",".join(map(repr, map(float, values))) for name, values in state.items()}
        given = [f"{name}={values}" for name, values in numbers.items()]
        result = json.loads(run(self.program, "eval", self.file, "--function", function, "--json", *given))["result"]
        return [np.array(part) for part in (result.values() if isinstance(result, dict) else [result])]

    def described(self):
        """The robot in the numbers that second_order.cpp reads."""
        model, data = self.model, self.model.createData()
        at = pin.neutral(model)
        numbers = [model.njoints - 1, *model.gravity.linear]
        for joint in range(1, model.njoints):
            motion = pin.computeJointJacobian(model, data, at, joint)[:, model.joints[joint].idx_v]
            slides = not motion[3:].any()
            place, body = model.jointPlacements[joint], model.inertias[joint]
            numbers += [int(model.parents[joint]), int(slides), *(motion[:3] if slides else motion[3:])]
            numbers += [*place.rotation.flat, *place.translation, body.mass, *body.lever, *body.inertia.flat]
        return numbers

    def hessian(self, *state):
        """Second derivatives of the torques times multipliers, for a state in the order of Pinocchio."""
        numbers = [*self.described(), *np.concatenate(state)]
        text = " ".join(str(x) if isinstance(x, int) else repr(float(x)) for x in numbers)
        answer = subprocess.run([self.second], input=text, check=True, capture_output=True, text=True).stdout
        nv = self.model.nv
        matrices = np.array(answer.split(), float).reshape(4, nv, nv)
        by_q_q, by_q_qd, by_qd_qd, by_q_qdd = (matrix[np.ix_(self.rows, self.rows)] for matrix in matrices)
        # the order of the keys in JSON
        return [by_q_q, by_q_qd, by_q_qdd, by_qd_qd]

    def pairs(self, q, qd, qdd, tau):
        """Function, what rne says, what Pinocchio says, and the condition of the mass matrix where it is inverted."""
        model, data, rows = self.model, self.data, self.rows

        def own(values):
            ordered = np.zeros(model.nv)
            ordered[rows] = values
            return ordered

        def matrix(part, upper=False):
            part = np.array(part)
            return (np.triu(part) + np.triu(part, 1).T if upper else part)[np.ix_(rows, rows)]

        # continuous joints have two numbers in Pinocchio
        at, v, a, u = pin.integrate(model, pin.neutral(model), own(q)), own(qd), own(qdd), own(tau)
        condition = np.linalg.cond(matrix(pin.crba(model, data, at), upper=True))
        torques = [matrix(part) for part in pin.computeRNEADerivatives(model, data, at, v, a)[:2]]
        found = self.eval("inverse_dynamics_derivatives", q=q, qd=qd, qdd=qdd)
        yield "inverse_dynamics_derivatives", found, torques, None
        mass = matrix(pin.crba(model, data, at), upper=True)
        found = self.eval("torque_gradient", q=q, qd=qd, qdd=qdd, multipliers=tau)
        yield "torque_gradient", found, [tau @ torques[0], tau @ torques[1], mass @ tau], None
        found = self.eval("torque_hessian", q=q, qd=qd, qdd=qdd, multipliers=tau)
        yield "torque_hessian", found, self.hessian(own(q), v, a, u), None
        by_q, by_qd, by_tau = (np.array(part) for part in pin.computeABADerivatives(model, data, at, v, u))
        expected = [matrix(by_q), matrix(by_qd), matrix(by_tau, upper=True)]
        found = self.eval("forward_dynamics_derivatives", q=q, qd=qd, tau=tau)
        yield "forward_dynamics_derivatives", found, expected, condition
        inverse = matrix(pin.computeMinverse(model, data, at), upper=True)
        yield "inverse_mass_matrix", self.eval("inverse_mass_matrix", q=q), [inverse], condition
        found = self.eval("inverse_mass_matrix_times_torques", q=q, tau=tau)
        yield "inverse_mass_matrix_times_torques", found, [inverse @ tau], condition
        tip, axes = model.getFrameId("tip"), pin.ReferenceFrame.LOCAL_WORLD_ALIGNED

        def rate(velocities):
            pin.computeJointJacobiansTimeVariation(model, data, at, velocities)
            pin.updateFramePlacements(model, data)
            return np.array(pin.getFrameJacobianTimeVariation(model, data, tip, axes))[:, rows]

        yield "jacobian_rate", self.eval("jacobian_rate", q=q, qd=qd), [rate(v)], None
        # at the velocity one of a joint alone, the rate is the derivative by its position
        derivatives = np.stack([rate(own(unit)) for unit in np.eye(model.nv)], axis=2)
        found = np.array(self.eval("jacobian_derivatives", q=q)).reshape(derivatives.shape)
        yield "jacobian_derivatives", [found], [derivatives], None


def main(program, *files):
    root = pathlib.Path(__file__).parents[2]
    files = files or [root / "robots" / f"{name}.yaml" for name in SHIPPED] + [
        root / "tests/functions/trees" / f"{name}.yaml" for name in TREES
    ]
    random, worst = np.random.default_rng(7), {}
    folder = tempfile.TemporaryDirectory()
    second = second_order(folder.name)
    for place, file in enumerate(files):
        if sys.stderr.isatty():
            print(f"\r[{'#' * (40 * place // len(files)):<40}] {pathlib.Path(file).stem:<20}", end="", file=sys.stderr)
        pair = Pair(program, second, file)
        for _ in range(STATES):
            q, qd, qdd, tau = (random.uniform(-scale, scale, pair.model.nv) for scale in (3.0, 2.0, 5.0, 20.0))
            for function, found, expected, condition in pair.pairs(q, qd, qdd, tau):
                for one, other in zip(found, expected, strict=True):
                    scale = np.abs(other).max() * (condition or 1.0) + (0.0 if condition else 1.0)
                    error = np.abs(one - other).max() / scale
                    worst[function] = max(worst.get(function, (0.0, "")), (error, pathlib.Path(file).stem))
    if sys.stderr.isatty():
        print(file=sys.stderr)
    for function, (error, name) in worst.items():
        print(f"{function:36} {error:.1e}  {name}")
    print(f"{len(files)} robots, {STATES} states each, beside Pinocchio {pin.__version__}")
    for function, (error, _) in worst.items():
        tolerance = SECOND_ORDER if function == "torque_hessian" else TOLERANCE
        if error > tolerance:
            sys.exit(f"the error of {function} is more than {tolerance:.0e}")


if __name__ == "__main__":
    main(*sys.argv[1:])
