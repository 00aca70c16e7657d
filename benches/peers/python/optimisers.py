"""optimisers.py [-w DIR] [-r N] [ROBOT ...]: what optimisers call, beside CasADi's compiled C and Pinocchio.

Functions: the derivatives of the torques by q and qd, those of the accelerations by q, qd and tau, and the gradient and
the Hessian of the torques weighted by multipliers, in (q, qd, qdd). CasADi's code stands there twice:

  as documented  it derives the seven steps (`dh` of casadi_code.py) and ca.solve; gcc -O3 -march=native
  best           it derives the formulation of fewest operations (`base`), of the accelerations the implicit equation,
                 and removes common subexpressions; the faster of gcc -O3 -march=native and clang with -ffast-math

Ours is the C of `rne emit --order registers`, the faster of gcc and clang with -O3 -march=native. All competitors run
in turn in one process, one state per call. Every result is checked first.
Needs the work folder of `benches/peers/run` (its packages and the states), gcc, g++ and clang.
"""

import argparse
import json
import os
import subprocess
import sys
import sysconfig
from pathlib import Path

import casadi as ca
import numpy as np

from arm import load
from casadi_code import operations, torques_dh, torques_joint_frames

HERE = Path(__file__).resolve().parents[1]
ROOT = HERE.parents[1]
WARNINGS = ["-w", "-DBOOST_MPL_LIMIT_LIST_SIZE=30", "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS",
            "-DBOOST_MPL_LIMIT_VECTOR_SIZE=30", "-DBOOST_FUSION_INVOKE_MAX_ARITY=12"]  # fmt: skip
FAST = ["-O3", "-march=native", "-DNDEBUG"]

#: Our function, and whether it takes multipliers.
FUNCTIONS = {
    "torque derivatives": ("inverse_dynamics_derivatives", False),
    "acceleration derivatives": ("forward_dynamics_derivatives", False),
    "gradient of λᵀτ": ("torque_gradient", True),
    "Hessian of λᵀτ": ("torque_hessian", True),
}


def of_casadi(robot, best):
    """CasADi's functions of one vector, by the names of the table; each result is a row-major matrix behind another."""
    n = len(robot["joints"])
    state = ca.SX.sym("state", 4 * n)
    q, v, third, multipliers = ca.vertsplit(state, n)
    a = ca.SX.sym("a", n)
    torques = torques_joint_frames(robot, q, v, a, True) if best else torques_dh(robot, q, v, a)

    def rows(*matrices):
        return ca.vertcat(*[ca.vec(ca.densify(matrix).T) for matrix in matrices])

    by_state = [ca.jacobian(torques, x) for x in (q, v)]
    bias = ca.substitute(torques, a, ca.SX.zeros(n))
    mass = ca.jacobian(torques, a)
    if best:
        factors = ca.ldl(ca.triu2symm(ca.triu(mass)))
        inverse = ca.ldl_solve(ca.SX.eye(n), *factors)
        acceleration = ca.ldl_solve(third - bias, *factors)
        accelerations = [*(-inverse @ x for x in ca.substitute(by_state, [a], [acceleration])), inverse]
    else:
        acceleration = ca.solve(mass, third - bias)
        accelerations = [ca.jacobian(acceleration, x) for x in (q, v, third)]
    weighted = ca.dot(multipliers, torques)
    hessian = ca.hessian(weighted, ca.vertcat(q, v, a))[0]
    block = {(i, j): hessian[i * n : (i + 1) * n, j * n : (j + 1) * n] for i in range(3) for j in range(3)}
    symmetric = [ca.triu2symm(ca.triu(block[i, i])) for i in range(2)]
    results = {
        "torque derivatives": rows(*by_state),
        "acceleration derivatives": rows(*accelerations),
        "gradient of λᵀτ": ca.vertcat(*[ca.gradient(weighted, x) for x in (q, v, a)]),
        "Hessian of λᵀτ": rows(symmetric[0], block[0, 1], symmetric[1], block[0, 2]),
    }
    finished = {name: ca.densify(ca.substitute(x, a, third)) for name, x in results.items()}
    return {name: ca.Function("peer", [state], [ca.cse(x) if best else x]) for name, x in finished.items()}


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **options)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command[:4]))} …: {done.stderr.strip()[-2000:]}")
    return done.stdout


def measured(robot, args):
    folder = args.work.resolve() / "optimisers" / robot
    folder.mkdir(parents=True, exist_ok=True)
    os.chdir(folder)
    n = len(load(robot)["joints"])
    states = np.random.default_rng(20261127).uniform(-2, 2, (256, 4 * n))
    states.tofile("states")

    file, count = HERE / "models" / f"{robot}.yaml", {}
    ours = [of for of, *_ in FUNCTIONS.values()]
    for compiler, command in (("gcc", "gcc"), ("clang", args.clang)):
        run(args.rne, "emit", file, "--lang", "c", "--real", "double", "--form", "reduced", "--order", "registers",
            "--function", ",".join(ours), "--prefix", compiler, "--force", "-o", f"{compiler}.c")  # fmt: skip
        run(command, *FAST, "-w", "-c", f"{compiler}.c")
    counted = run(args.rne, "ops", file, "--function", ",".join(ours), "--json")
    for row in json.loads(counted):
        if row["form"] == "reduced":
            count[row["function"]] = row["mul"] + row["add"] + row["div"]

    table, objects, casadi_count = ['#include "optimisers.h"'], ["gcc.o", "clang.o"], {}
    rows, usual, best = [], of_casadi(load(robot), False), of_casadi(load(robot), True)
    for index, (name, (of, weighted)) in enumerate(FUNCTIONS.items()):
        size = best[name].numel_out(0)
        for compiler in ("gcc", "clang"):
            table += [
                f"void {compiler}_{of}();",
                f"static void {compiler}{index}(const double *x, double *out) {{",
                f"  {compiler}_{of}(x, x + {n}, x + {2 * n}{f', x + {3 * n}' if weighted else ''}, out);",
                "}",
            ]
            rows.append(f'{{"{name}", "rne {compiler}", {compiler}{index}, {size}}}')
        casadi_count[name] = sum(
            number for kind, number in operations(best[name]).items() if kind in ("mul", "add", "div")
        )
        for function, compiler, flags, label in (
            (usual[name], "gcc", FAST, "usual"),
            (best[name], "gcc", FAST, "gcc"),
            (best[name], args.clang, [*FAST, "-ffast-math"], "clang"),
        ):
            call = f"casadi{index}_{label}"
            function.generate("peer.c")
            Path(f"{call}.c").write_text(Path("peer.c").read_text().replace("peer", call))
            run(compiler, *flags, "-w", "-c", f"{call}.c")
            objects.append(f"{call}.o")
            table += [
                f"int {call}(const double **, double **, long long *, double *, int);",
                f"static void call_{call}(const double *x, double *out) {{",
                "  const double *from[1] = {x}; double *to[1] = {out};",
                f"  {call}(from, to, 0, 0, 0);",
                "}",
            ]
            rows.append(f'{{"{name}", "CasADi {label}", call_{call}, {size}}}')
    table += ["const optimiser optimisers[] = {" + ",\n".join(rows) + "};",
              f"const size_t optimiser_count = {len(rows)};"]  # fmt: skip
    Path("table.c").write_text("\n".join(table) + "\n")
    run("gcc", *FAST, "-w", f"-I{HERE}/native", "-c", "table.c")
    prefix = Path(sysconfig.get_paths()["purelib"]) / "cmeel.prefix"
    program, source = args.work.resolve() / "optimisers" / "optimisers.o", HERE / "native" / "optimisers.cpp"
    if not program.exists() or program.stat().st_mtime < source.stat().st_mtime:
        run(args.clang.replace("clang", "clang++"), "-std=c++17", *WARNINGS, *FAST, "-c", source, "-o", program,
            f"-I{prefix}/include", f"-I{prefix}/include/eigen3")  # fmt: skip
    run("g++", program, "table.o", *objects, "-o", "optimisers", f"-L{prefix}/lib", f"-Wl,-rpath,{prefix}/lib",
        "-lpinocchio_default", "-lm")  # fmt: skip
    run(sys.executable, HERE / "python" / "prepare.py", folder, robot)
    times = {}
    for line in run("./optimisers", folder, robot, "states", args.repetitions).splitlines():
        name, competitor, time = line.split(",", 1)[0], *line.split(",", 1)[1].rsplit(",", 1)
        times.setdefault(name, {})[competitor] = float(time)
    for name, of in times.items():
        mine, best = min(of["rne gcc"], of["rne clang"]), min(of["CasADi gcc"], of["CasADi clang"])
        others = [of["CasADi usual"], best, of.get("Pinocchio")]
        cells = [f"{ns:.0f} ({ns / mine:.1f})" if ns else "" for ns in others]
        print("|", " | ".join([robot, name, str(count[FUNCTIONS[name][0]]), str(casadi_count[name]), f"{mine:.0f}", *cells]),
              "|", flush=True)  # fmt: skip


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-w", "--work", type=Path, required=True, metavar="DIR", help="the work folder of run")
    parser.add_argument("-r", "--repetitions", type=int, default=200, metavar="N", help="repetitions that count")
    parser.add_argument("--rne", default=str(ROOT / "target" / "release" / "rne"), help="the program rne")
    parser.add_argument("--clang", default="clang-19", help="a C compiler of LLVM; its C++ compiler is beside it")
    parser.add_argument("robots", nargs="*", default=["panda", "iiwa14"], metavar="ROBOT")
    args = parser.parse_args()
    print("| robot | function | operations, rne | CasADi, best | ns, rne | CasADi, documented | CasADi, best | Pinocchio |")
    print("|---|---|--:|--:|--:|--:|--:|--:|")
    for robot in args.robots:
        measured(robot, args)


if __name__ == "__main__":
    main()
