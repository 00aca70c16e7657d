"""Derivatives that rne computes beside Pinocchio, which reads the URDF that rne exports.

Usage: python derivatives.py RNE [FILE ...]     where RNE is the binary; `cargo xtask derivatives --python` calls it.

Both are exact, so they differ by rounding: 1e-11 of the largest number of a matrix, times the condition number of the
mass matrix where that is inverted.
"""

import json
import pathlib
import re
import subprocess
import sys

import numpy as np
import pinocchio as pin

TOLERANCE = 1e-11
STATES = 3
SHIPPED = ["panda", "puma560", "ur5e", "iiwa14", "gen3", "z1"]
TREES = ["anymal_c", "go2", "erd_baxter", "erd_panda_hand"]


def run(program, *arguments):
    return subprocess.run([program, *arguments], check=True, capture_output=True, text=True).stdout


class Pair:
    """A robot in rne, and in Pinocchio."""

    def __init__(self, program, file):
        self.program, self.file = program, str(file)
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
        by_q, by_qd, by_tau = (np.array(part) for part in pin.computeABADerivatives(model, data, at, v, u))
        expected = [matrix(by_q), matrix(by_qd), matrix(by_tau, upper=True)]
        found = self.eval("forward_dynamics_derivatives", q=q, qd=qd, tau=tau)
        yield "forward_dynamics_derivatives", found, expected, condition
        inverse = matrix(pin.computeMinverse(model, data, at), upper=True)
        yield "inverse_mass_matrix", self.eval("inverse_mass_matrix", q=q), [inverse], condition
        found = self.eval("inverse_mass_matrix_times_torques", q=q, tau=tau)
        yield "inverse_mass_matrix_times_torques", found, [inverse @ tau], condition
        tip, axes = model.getFrameId("tip"), pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        pin.computeJointJacobiansTimeVariation(model, data, at, v)
        pin.updateFramePlacements(model, data)
        rate = np.array(pin.getFrameJacobianTimeVariation(model, data, tip, axes))[:, rows]
        yield "jacobian_rate", self.eval("jacobian_rate", q=q, qd=qd), [rate], None


def main(program, *files):
    root = pathlib.Path(__file__).parent.parent
    files = files or [root / "robots" / f"{name}.yaml" for name in SHIPPED] + [
        root / "tests/functions/trees" / f"{name}.yaml" for name in TREES
    ]
    random, worst = np.random.default_rng(7), {}
    for place, file in enumerate(files):
        if sys.stderr.isatty():
            print(f"\r[{'#' * (40 * place // len(files)):<40}] {pathlib.Path(file).stem:<20}", end="", file=sys.stderr)
        pair = Pair(program, file)
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
    if any(error > TOLERANCE for error, _ in worst.values()):
        sys.exit(f"an error is more than {TOLERANCE:.0e}")


if __name__ == "__main__":
    main(*sys.argv[1:])
