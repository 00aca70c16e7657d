"""The two optimal control problems of the tests: cost, iterations of IPOPT and seconds within the functions of the problem,
with rne's functions beside CasADi's expressions, as they are and compiled by `cc -O3`.

    chrt -f 50 taskset -c 1 python benches/peers/python/optimal_control.py

It needs the packages rne, casadi, PyYAML and pytest, and cc.
"""

import os
import sys
import tempfile
from pathlib import Path

import casadi as ca
import numpy as np
import rne

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "doors/python/tests"))
from casadi_oracle import Expressions  # noqa: E402
from test_casadi import OPTIONS, gauss_newton, reach, swing_up  # noqa: E402



def compiled(libraries=()):
    """Options by which CasADi writes the functions of the problem in C, and compiles them with these libraries."""
    flags = {"flags": ["-O3"], "verbose": False}
    if libraries:
        flags["linker_flags"] = [str(library) for library in libraries]
    return {"jit": True, "compiler": "shell", "jit_options": flags}


REPETITIONS = 5


def solve(problem, options):
    """The cost, the iterations, and the least seconds in the functions of several runs."""
    opti, cost = problem
    opti.minimize(cost)
    opti.solver("ipopt", {**OPTIONS, "hess_lag": gauss_newton(opti, cost), **options})
    times = []
    for _ in range(REPETITIONS):
        solution = opti.solve()
        stats = solution.stats()
        times.append(sum(value for key, value in stats.items() if key.startswith("t_wall_nlp_")))
    return solution.value(cost), stats["iter_count"], min(times)


def main():
    limits = np.array([87.0] * 4 + [12.0] * 3)
    problems = {
        "swing-up": ("planar2", "forward_dynamics", swing_up),
        "reach of the Panda": ("panda", "inverse_dynamics", lambda of: reach(of, limits)),
    }
    print(f"{'':44} {'cost':>14} {'iterations':>10} {'ms in functions':>16} {'of compiled':>12}")
    for title, (robot, function, problem) in problems.items():
        theirs = getattr(Expressions(robot), function)
        ours = getattr(rne.robots, robot).casadi(function)
        library = max(Path(os.environ["RNE_CACHE"]).glob("*"), key=lambda path: path.stat().st_mtime)
        runs = {
            "expressions, cc -O3": (theirs, compiled()),
            "expressions": (theirs, {}),
            "rne": (ours, {}),
            "rne, cc -O3": (ours, compiled([library])),
        }
        reference = None
        for name, (of, options) in runs.items():
            cost, iterations, seconds = solve(problem(of), options)
            reference = reference or seconds
            print(f"{title + ', ' + name:44} {cost:14.9f} {iterations:10} {1e3 * seconds:16.2f} "
                  f"{seconds / reference:12.2f}", flush=True)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as cache:
        os.environ["RNE_CACHE"] = cache
        main()
