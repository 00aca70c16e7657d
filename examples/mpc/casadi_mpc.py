"""The plans of this example by CasADi: the same horizon, cost, limits and inputs, beside the times of the example.

    python examples/mpc/casadi_mpc.py [SOLVER...]        hpipm osqp piqp proxqp, if none is named; also daqp, qpoases

It needs the packages casadi and rne, PyYAML, cc and cargo. The model is that of the example (semi-implicit Euler), once
with the dynamics as CasADi's expressions, once with rne's functions. CasADi writes one function in C that makes all the
numbers of a quadratic program, and `cc -O3` compiles it. The first samples are not counted.
"""

import csv
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import casadi as ca
import numpy as np
import rne

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parents[1] / "doors/python/tests"))
from casadi_oracle import Expressions, turned  # noqa: E402

DOF, NODES, STEP = 7, 20, 0.02
TIP, LAST, POSTURE, VELOCITY, TORQUE = 300.0, 10.0, 0.05, 0.2, 1e-3
REST = np.array([0.0, -0.4, 0.0, -2.0, 0.0, 1.7, 0.8])
WARM_UP = 10
OPTIONS = {
    # those of the example
    "osqp": {"osqp": {"verbose": False, "eps_abs": 1e-4, "eps_rel": 1e-4, "max_iter": 100, "check_termination": 5,
                      "adaptive_rho": False}, "warm_start_primal": True, "warm_start_dual": True},
    "qpoases": {"printLevel": "none", "sparse": True},
    "hpipm": {"hpipm": {"mode": "speed"}},
}


def tip_of(expressions, q):
    """The origin of the tip in the world, as an expression."""
    turn, origin = ca.SX.eye(3), ca.SX.zeros(3)
    for index, joint in enumerate(expressions.joints):
        for axis, angle, move in expressions._row(joint, q[index])[0]:
            turn = ca.mtimes(turn, turned(axis, angle))
            origin = origin + ca.mtimes(turn, move)
    tool = (expressions.text.get("tool") or {}).get("xyz", [0, 0, 0])
    return origin + ca.mtimes(turn, ca.SX(list(map(expressions.number, tool))))


def program(source, arm, expressions, folder, stages, level="-O3"):
    """The numbers of a quadratic program, in C: of the plan, the goal and the external torques. With
    `stages`, an interval gives the next positions without the next velocities, as solvers for optimal control need it."""
    q = ca.SX.sym("q", DOF)
    place = tip_of(expressions, q)
    tip = ca.Function("tip", [q], [place, ca.jacobian(place, q)])
    if source == "rne":
        forward, gravity = arm.casadi("forward_dynamics"), arm.casadi("gravity_torques")
    else:
        forward, gravity = expressions.forward_dynamics, expressions.gravity_torques
    q, qd, tau = (ca.MX.sym(name, DOF) for name in ("q", "qd", "tau"))
    qdd = forward(q, qd, tau)
    slope = ca.Function("slope", [q, qd, tau], [qdd, ca.jacobian(qdd, q), ca.jacobian(qdd, qd), ca.jacobian(qdd, tau)])

    x, u = ca.MX.sym("x", 2 * DOF, NODES + 1), ca.MX.sym("u", DOF, NODES)
    goal, external = ca.MX.sym("goal", 3), ca.MX.sym("external", DOF)
    eye, zero = ca.MX.eye(DOF), ca.MX(DOF, DOF)
    hessian, gradient, rows, right = [], [], [], []
    width, total = 3 * DOF, NODES * 3 * DOF + 2 * DOF
    for node in range(NODES + 1):
        at, rate = x[:DOF, node], x[DOF:, node]
        where, jacobian = tip(at)
        weight = TIP * (LAST if node == NODES else 1.0)
        of_tip = weight * ca.mtimes(jacobian.T, jacobian)
        hessian += [of_tip + POSTURE * eye, VELOCITY * eye]
        gradient += [weight * ca.mtimes(jacobian.T, where - goal) + POSTURE * (at - REST), VELOCITY * rate]
        if node == NODES:
            break
        hessian.append(TORQUE * eye)
        gradient.append(TORQUE * (u[:, node] - gravity(at) + external))
        qdd, by_q, by_qd, by_tau = slope(at, rate, u[:, node] + external)
        before, after = ca.MX(2 * DOF, node * width), ca.MX(2 * DOF, total - (node + 1) * width - 2 * DOF)
        velocities = rate + STEP * qdd - x[DOF:, node + 1]
        if stages:
            here = ca.blockcat([[eye + STEP**2 * by_q, STEP * eye + STEP**2 * by_qd, STEP**2 * by_tau],
                                [STEP * by_q, eye + STEP * by_qd, STEP * by_tau]])
            there, positions = -ca.MX.eye(2 * DOF), at + STEP * rate + STEP**2 * qdd - x[:DOF, node + 1]
            velocities, positions = -velocities, -positions
        else:
            here = ca.blockcat([[-eye, zero, zero], [-STEP * by_q, -eye - STEP * by_qd, -STEP * by_tau]])
            there, positions = ca.blockcat([[eye, -STEP * eye], [zero, eye]]), at + STEP * x[DOF:, node + 1] - x[:DOF, node + 1]
        rows.append(ca.horzcat(before, here, there, after))
        right += [positions, velocities]
    matrices = [ca.diagcat(*hessian), ca.vertcat(*gradient), ca.vertcat(*rows), ca.vertcat(*right)]
    numbers = ca.Function("numbers", [x, u, goal, external], matrices)
    name = f"{source}_{stages}"
    generator = ca.CodeGenerator(f"{name}.c")
    generator.add(numbers)
    generator.generate(f"{folder}/")
    libraries = [str(path) for path in Path(os.environ["RNE_CACHE"]).glob("*")] if source == "rne" else []
    command = ["cc", level, "-fPIC", "-shared", f"{name}.c", *libraries, "-o", f"{name}.so"]
    subprocess.run(command, cwd=folder, check=True)
    return ca.external("numbers", f"{folder}/{name}.so")


def limits_of(arm, node, now, plan, torques):
    """Bounds of the changes of a node's positions, velocities and torques."""
    back = 0.5**node
    q, qd = now[:DOF], now[DOF:]
    (lower, upper), speed, effort = np.array(arm.limits).T, arm.velocity_limits, arm.effort_limits
    low = np.concatenate([lower - back * np.maximum(lower - q, 0), -speed - back * np.maximum(np.abs(qd) - speed, 0)])
    high = np.concatenate([upper + back * np.maximum(q - upper, 0), speed + back * np.maximum(np.abs(qd) - speed, 0)])
    low, high = low - plan, high - plan
    if node == 0:
        # the first state is measured
        low = high = now - plan
    if torques is not None:
        low, high = np.concatenate([low, -effort - torques]), np.concatenate([high, effort - torques])
    return low, high


def planned(numbers, solver, arm, samples):
    """The torques of each sample, and seconds of whole iterations and of the numbers of the program."""
    blank = numbers.sparsity_out(0), numbers.sparsity_out(2)
    options = {"print_time": False, "error_on_fail": False, **OPTIONS.get(solver, {})}
    qp = ca.conic("qp", solver, {"h": blank[0], "a": blank[1]}, options)
    states = np.tile(np.concatenate([REST, np.zeros(DOF)])[:, None], NODES + 1)
    inputs = np.tile(np.asarray(arm.gravity_torques(REST))[:, None], NODES)
    torques, whole, model, failed = [], [], [], 0
    for sample in samples:
        now, external = (np.array([float(sample[f"{name}{joint}"]) for name in names for joint in range(1, DOF + 1)])
                         for names in (("measured_q", "measured_qd"), ("external",)))
        goal = [float(sample[f"goal{axis}"]) for axis in (1, 2, 3)]
        began = time.perf_counter()
        states = np.hstack([states[:, 1:], states[:, -1:]])
        inputs = np.hstack([inputs[:, 1:], inputs[:, -1:]])
        h, g, a, right = numbers(states, inputs, goal, external)
        model.append(time.perf_counter() - began)
        bounds = [limits_of(arm, node, now, states[:, node], inputs[:, node] if node < NODES else None)
                  for node in range(NODES + 1)]
        low, high = (np.concatenate(side) for side in zip(*bounds))
        found = qp(h=h, g=g, a=a, lba=right, uba=right, lbx=low, ubx=high)
        status = qp.stats()
        change = np.array(found["x"]).ravel()
        if np.isfinite(change).all() and (status["success"] or solver == "osqp"):
            for node in range(NODES + 1):
                part = change[node * 3 * DOF:]
                states[:, node] += part[: 2 * DOF]
                if node < NODES:
                    inputs[:, node] += part[2 * DOF: 3 * DOF]
        failed += not status["success"]
        torques.append(np.clip(inputs[:, 0], -arm.effort_limits, arm.effort_limits))
        whole.append(time.perf_counter() - began)
    return np.array(torques), whole, model, failed


def main(solvers):
    arm, expressions = rne.robots.panda, Expressions("panda")
    with tempfile.TemporaryDirectory() as folder:
        motion = f"{folder}/motion.csv"
        example = ["cargo", "run", "--release", "--quiet", "--manifest-path", str(HERE / "Cargo.toml"), "--", motion]
        subprocess.run(example, check=True, stdout=subprocess.DEVNULL)
        with open(motion, newline="", encoding="utf-8") as file:
            samples = list(csv.DictReader(file))
        tau = np.array([[float(sample[f"tau{joint}"]) for joint in range(1, DOF + 1)] for sample in samples])

        def line(name, whole, model, rest):
            whole, model = (1e3 * np.median(numbers[WARM_UP:]) for numbers in (whole, model))
            print(f"{name:34} {whole:10.3f} {model:18.3f}   {rest}", flush=True)

        print(f"{'median of an iteration, ms':34} {'whole':>10} {'model or numbers':>18}   torques from the example's")
        line("rne in Rust, OSQP", *([float(sample[key]) for sample in samples] for key in ("whole", "model")), "")
        for source in ("expressions", "rne"):
            programs = {}
            for solver in solvers:
                stages = solver == "hpipm"
                numbers = programs.get(stages) or program(source, arm, expressions, folder, stages)
                programs[stages] = numbers
                torques, whole, model, failed = planned(numbers, solver, arm, samples)
                far = np.abs(torques - tau).max(1) / arm.effort_limits.max()
                rest = f"median {np.median(far):.1e} of the largest limit, at most {far.max():.1e}"
                line(f"CasADi, {source}, {solver}", whole, model, rest + (f"; {failed} not solved" if failed else ""))


if __name__ == "__main__":
    # the libraries of rne's functions, which the compiled numbers call
    with tempfile.TemporaryDirectory() as cache:
        os.environ["RNE_CACHE"] = cache
        main(sys.argv[1:] or ["hpipm", "osqp", "piqp", "proxqp"])
