"""Swings two links up with acados: once with the C code of `rne emit --casadi --acados`, once with CasADi's expressions.

acados, its Python package acados_template and CasADi must be installed; RNE names the program rne. IPOPT solves the same
problem from the optimum that acados finds, and must stay there.
"""

import os
import subprocess
import sys
from pathlib import Path

import casadi as ca
import numpy as np
from acados_template import AcadosModel, AcadosOcp, AcadosOcpSolver

TESTS = Path(__file__).parents[2] / "doors/python/tests"
sys.path.insert(0, str(TESTS))
from casadi_oracle import ROBOTS, Expressions  # noqa: E402

NODES, DURATION, HANGING, STANDING = 20, 2.0, [-np.pi / 2, 0, 0, 0], [np.pi / 2, 0, 0, 0]


def rate(x, u):
    arm, q, qd = Expressions("planar2"), x[:2], x[2:]
    return ca.vertcat(qd, ca.solve(arm.mass_matrix(q), u - arm.bias_torques(q, qd)))


def problem():
    x, u = ca.SX.sym("x", 4), ca.SX.sym("u", 2)
    ocp = AcadosOcp()
    ocp.model = AcadosModel()
    ocp.model.name, ocp.model.x, ocp.model.u, ocp.model.f_expl_expr = "planar2", x, u, rate(x, u)
    ocp.cost.cost_type, ocp.model.cost_expr_ext_cost = "EXTERNAL", 1e-2 * ca.sumsqr(u)
    ocp.constraints.x0 = np.array(HANGING)
    ocp.constraints.idxbx_e = np.arange(4)
    ocp.constraints.lbx_e = ocp.constraints.ubx_e = np.array(STANDING)
    options = ocp.solver_options
    options.N_horizon, options.tf, options.integrator_type = NODES, DURATION, "ERK"
    options.sim_method_num_stages, options.sim_method_num_steps = 4, 1
    options.nlp_solver_type, options.hessian_approx, options.nlp_solver_max_iter = "SQP", "EXACT", 500
    options.qp_solver, options.regularize_method = "PARTIAL_CONDENSING_HPIPM", "MIRROR"
    options.globalization, options.tol = "MERIT_BACKTRACKING", 1e-8
    return ocp


def solved(source):
    """The cost, the motion, the number of iterations, and the seconds of the integrator with its derivatives."""
    ocp, folder = problem(), Path(f"code_{source}").absolute()
    ocp.code_gen_options.code_export_directory = str(folder)
    AcadosOcpSolver.generate(ocp, verbose=False)
    if source == "rne":
        # the code of rne in place of the generated functions, which have the same names
        first, *others = sorted((folder / "planar2_model").glob("planar2_expl_*.c"))
        for file in others:
            file.write_text("", encoding="utf-8")
        command = [os.environ["RNE"], "emit", str(ROBOTS / "planar2.yaml"), "--lang", "c", "--casadi", "--acados"]
        subprocess.run([*command, "--force", "-o", first.with_name("arm.c")], check=True, capture_output=True)
        first.write_text('#define casadi_int int\n#include "arm.c"\n', encoding="utf-8")
    AcadosOcpSolver.build(str(folder), with_cython=False, verbose=False)
    solver = AcadosOcpSolver(ocp, build=False, generate=False, verbose=False)
    for node in range(NODES + 1):
        solver.set(node, "x", np.array([-np.pi / 2 + np.pi * node / NODES, 0, 0, 0]))
    status = solver.solve()
    assert status == 0, f"acados ends with status {status}"
    states = np.array([solver.get(node, "x") for node in range(NODES + 1)]).T
    torques = np.array([solver.get(node, "u") for node in range(NODES)]).T
    return solver.get_cost(), states, torques, solver.get_stats("sqp_iter"), solver.get_stats("time_sim")


def by_ipopt(states, torques):
    """The cost of the same problem, with the steps of Runge and Kutta in CasADi, by IPOPT from a motion."""
    opti, h = ca.Opti(), DURATION / NODES
    x, u = opti.variable(4, NODES + 1), opti.variable(2, NODES)
    state, torque = ca.SX.sym("x", 4), ca.SX.sym("u", 2)
    f = ca.Function("rate", [state, torque], [rate(state, torque)])
    for node in range(NODES):
        at, by = x[:, node], u[:, node]
        k1 = f(at, by)
        k2 = f(at + h / 2 * k1, by)
        k3 = f(at + h / 2 * k2, by)
        k4 = f(at + h * k3, by)
        opti.subject_to(x[:, node + 1] == at + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4))
    opti.set_initial(x, states)
    opti.set_initial(u, torques)
    opti.subject_to(x[:, 0] == HANGING)
    opti.subject_to(x[:, NODES] == STANDING)
    opti.minimize(h * 1e-2 * ca.sumsqr(u))
    opti.solver("ipopt", {"print_time": False, "ipopt": {"print_level": 0, "sb": "yes", "tol": 1e-9, "mu_init": 1e-9}})
    return opti.solve().value(opti.f)


if __name__ == "__main__":
    for source in ("expressions", "rne"):
        cost, states, torques, iterations, seconds = solved(source)
        print(f"acados, {source}: cost {cost:.9f}, {iterations} iterations, {1e3 * seconds:.0f} ms in the integrator")
    print(f"IPOPT from there: cost {by_ipopt(states, torques):.9f}")
