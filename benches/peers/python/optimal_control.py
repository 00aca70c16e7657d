"""optimal_control.py [-r N]: two optimal control problems by IPOPT, with rne's functions and with CasADi's own.

The problems are those of doors/python/tests/test_casadi.py: a swing-up of two links by multiple shooting, and a reach of
the Panda by direct collocation. CasADi's expressions (the formulation of fewest operations, common subexpressions
removed) stand there twice: in CasADi's virtual machine, and compiled with their Jacobians by cc -O3 -march=native, loaded
as rne's are. All have the same problem, options and second derivatives of Gauss and Newton. Printed: cost, iterations,
and the time in the functions of the problem, as CasADi's statistics have it: the median of N solutions, taken in turn.
Needs casadi, numpy, pyyaml, the Python package of rne, and cc.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import casadi as ca
import numpy as np

HERE = Path(__file__).resolve().parents[1]
ROOT = HERE.parents[1]
sys.path += [str(ROOT / "doors/python/tests")]

import rne  # noqa: E402
from arm import load  # noqa: E402
from casadi_code import torques_joint_frames  # noqa: E402
from test_casadi import OPTIONS, gauss_newton, reach, swing_up  # noqa: E402


def robot_of(name):
    """The robot that rne ships. Of planar2, models/ has one of other lengths and masses."""
    robot = load(name)
    for joint, mass, length in zip(robot["joints"], (2.0, 1.5), (0.5, 0.4)) if name == "planar2" else ():
        about = mass * length**2 / 12
        joint.update(a=length, m=mass, com=[-length / 2, 0, 0], I=[0, about, about, 0, 0, 0])
    return robot


def expressions(name, function):
    """CasADi's function of a robot at its best: by the names and arguments of rne."""
    robot = robot_of(name)
    n = len(robot["joints"])
    q, qd, third = (ca.SX.sym(of, n) for of in ("q", "qd", "third"))
    torques = torques_joint_frames(robot, q, qd, third, True)
    if function == "forward_dynamics":
        mass = ca.triu2symm(ca.triu(ca.jacobian(torques, third)))
        bias = ca.substitute(torques, third, ca.SX.zeros(n))
        torques = ca.ldl_solve(third - bias, *ca.ldl(mass))
    result = ca.cse(ca.densify(torques))
    return ca.Function(function, [q, qd, third], [result], ["q", "qd", "third"], ["result"])


def compiled(function, folder):
    """The same from a shared library, with its Jacobian."""
    jacobian = function.jacobian()
    # what is derived has common subexpressions again
    inputs = [ca.SX.sym(jacobian.name_in(k), jacobian.sparsity_in(k)) for k in range(jacobian.n_in())]
    names = jacobian.name_in(), jacobian.name_out()
    jacobian = ca.Function(jacobian.name(), inputs, ca.cse(list(jacobian.call(inputs))), *names)
    made = ca.CodeGenerator(f"{function.name()}.c")
    made.add(function)
    made.add(jacobian)
    made.generate(f"{folder}/")
    source, library = f"{folder}/{function.name()}.c", f"{folder}/{function.name()}.so"
    flags = ["-O3", "-march=native", "-DNDEBUG", "-shared", "-fPIC", "-w"]
    subprocess.run([os.environ.get("CC", "cc"), *flags, source, "-o", library], check=True)
    return ca.external(function.name(), library)


def solved(problem):
    """Cost, iterations, and the seconds in the functions of the problem and in all."""
    opti, cost = problem
    opti.minimize(cost)
    opti.solver("ipopt", {**OPTIONS, "hess_lag": gauss_newton(opti, cost)})
    began = time.perf_counter()
    solution = opti.solve()
    took = time.perf_counter() - began
    stats = solution.stats()
    # without `nlp_hess_l`, which is that of the quadratic cost
    inside = sum(time for key, time in stats.items() if key.startswith("t_wall_nlp"))
    return solution.value(cost), stats["iter_count"], inside, took


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-r", "--repetitions", type=int, default=9, metavar="N", help="solutions of each problem")
    args = parser.parse_args()
    limits = np.array([87.0] * 4 + [12.0] * 3)
    problems = {
        "swing-up of planar2": ("planar2", "forward_dynamics", swing_up),
        "reach of a Panda": ("panda", "inverse_dynamics", lambda function: reach(function, limits)),
    }
    print("| problem | functions | cost | iterations | ms in functions | ratio | ms in all |")
    print("|---|---|--:|--:|--:|--:|--:|")
    with tempfile.TemporaryDirectory() as folder:
        for title, (name, function, problem) in problems.items():
            casadi = expressions(name, function)
            state = np.random.default_rng(1).uniform(-1, 1, (3, casadi.numel_in(0)))
            there = np.ravel(getattr(getattr(rne.robots, name), function)(*state))
            error = np.abs(there - np.ravel(casadi(*state))).max() / np.abs(there).max()
            assert error < 1e-10, f"{name}: the robots are not the same ({error})"
            sources = {
                "rne": getattr(rne.robots, name).casadi(function),
                "CasADi, compiled": compiled(casadi, folder),
                "CasADi": casadi,
            }
            runs = {source: [] for source in sources}
            for _ in range(args.repetitions):
                for source, of in sources.items():
                    runs[source].append(solved(problem(of)))
            ours = np.median([run[2] for run in runs["rne"]])
            for source, found in runs.items():
                cost, iterations = found[0][:2]
                inside, whole = np.median(np.array(found)[:, 2:], axis=0)
                print(f"| {title} | {source} | {cost:.9g} | {iterations} | {inside * 1e3:.1f} | {inside / ours:.2f} | "
                      f"{whole * 1e3:.0f} |", flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
