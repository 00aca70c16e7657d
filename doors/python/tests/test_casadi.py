"""`Arm.casadi` against expressions of CasADi, which CasADi derives: numbers, derivatives, optimal motions. Skipped where
CasADi is not."""

import concurrent.futures
import os
import re
import shlex
import shutil
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import rne

ca = pytest.importorskip("casadi")
pytest.importorskip("yaml")
from casadi_oracle import ROBOTS, Expressions  # noqa: E402
from pages import run_examples  # noqa: E402

FUNCTIONS = ["inverse_dynamics", "forward_dynamics", "gravity_torques", "bias_torques"]
ARMS = ["puma560", "panda", "trees/hyq"]


@pytest.fixture(scope="module", autouse=True)
def cache(tmp_path_factory):
    """A cache of these tests alone."""
    folder = tmp_path_factory.mktemp("cache")
    before = os.environ.get("RNE_CACHE")
    os.environ["RNE_CACHE"] = str(folder)
    yield folder
    del os.environ["RNE_CACHE"]
    if before is not None:
        os.environ["RNE_CACHE"] = before


@pytest.fixture(scope="module", params=ARMS)
def both(request):
    return rne.load(ROBOTS / f"{request.param}.yaml"), Expressions(request.param)


def numbers(matrix):
    return np.array(ca.DM(matrix).full())


def difference(found, expected):
    found, expected = numbers(found), numbers(expected)
    return np.abs(found - expected).max(initial=0) / max(1.0, np.abs(expected).max(initial=0))


def states(function, count, seed=5):
    random = np.random.default_rng(seed)
    # torques that do not throw light links about
    scale = {"tau": 0.5, "step": 0.03}
    for _ in range(count):
        yield [random.uniform(-1.5, 1.5, size) * scale.get(name, 1) for name, size in
               ((function.name_in(index), function.size1_in(index)) for index in range(function.n_in()))]


def described(function):
    inputs = [(function.name_in(index), function.size_in(index)) for index in range(function.n_in())]
    return inputs, [(function.name_out(index), function.size_out(index)) for index in range(function.n_out())]


@pytest.mark.parametrize("name", [*FUNCTIONS, "euler_step"])
def test_numbers_and_derivatives_are_those_of_expressions(both, name):
    arm, expressions = both
    ours, theirs = arm.casadi(name), getattr(expressions, name)
    # forward dynamics divide by a mass matrix, whose smallest parts are thousandths of its largest
    tolerance = 1e-8 if name in ("forward_dynamics", "euler_step") else 1e-11
    pairs = [(ours, theirs), (ours.jacobian(), theirs.jacobian())]
    pairs += [(ours.forward(count), theirs.forward(count)) for count in (1, 3)]
    pairs += [(ours.reverse(count), theirs.reverse(count)) for count in (1, 3)]
    for found, expected in pairs:
        assert described(found) == described(expected)
        random = np.random.default_rng(11)
        for state in states(ours, 10):
            directions = [random.normal(size=found.size_in(index)) for index in range(len(state), found.n_in())]
            arguments = [*state, *directions]
            if len(arguments) > len(state):
                arguments[len(state) : len(state) + theirs.n_out()] = theirs.call(state)
            for ours_out, theirs_out in zip(found.call(arguments), expected.call(arguments), strict=True):
                assert difference(ours_out, theirs_out) < tolerance, found


@pytest.mark.parametrize("name", FUNCTIONS)
def test_derivatives_go_through_expressions(both, name):
    arm, expressions = both
    x = ca.MX.sym("x", arm.dof)
    tolerance = 1e-8 if name == "forward_dynamics" else 1e-11
    derived = []
    for function in (arm.casadi(name), getattr(expressions, name)):
        arguments = [ca.sin(x), x * x, 0.5 * x][: function.n_in()]
        result = ca.sum1(function(*arguments) ** 2)
        derived.append(ca.Function("derived", [x], [ca.gradient(result, x), ca.jacobian(function(*arguments), x)]))
    for point in np.random.default_rng(2).uniform(-0.7, 0.7, size=(5, arm.dof)):
        for found, expected in zip(*(function(point) for function in derived)):
            assert difference(found, expected) < tolerance


@pytest.mark.parametrize("name", FUNCTIONS)
def test_second_derivatives_are_those_of_expressions(both, name):
    """The Hessian of λᵀτ or λᵀq̈, as CasADi asks for it: the Jacobian of what goes backwards."""
    arm, expressions = both
    tolerance = 1e-8 if name == "forward_dynamics" else 1e-10
    ours, theirs = (of.reverse(1).jacobian() for of in (arm.casadi(name), getattr(expressions, name)))
    assert described(ours) == described(theirs)
    random = np.random.default_rng(6)
    for _ in range(10):
        arguments = [random.uniform(-1.5, 1.5, size=ours.size_in(index)) for index in range(ours.n_in())]
        for found, expected in zip(ours.call(arguments), theirs.call(arguments), strict=True):
            assert difference(found, expected) < tolerance
    # the number of a Lagrangian
    x, multipliers = ca.MX.sym("x", arm.dof), ca.MX.sym("multipliers", arm.dof)
    hessians = [ca.Function("hessian", [x, multipliers], [ca.hessian(
        ca.dot(multipliers, of(*[ca.sin(x), x * x, 0.5 * x][: of.n_in()])), x)[0]])
        for of in (arm.casadi(name), getattr(expressions, name))]
    for point in random.uniform(-0.7, 0.7, size=(5, 2, arm.dof)):
        found, expected = (hessian(*point) for hessian in hessians)
        assert difference(found, expected) < tolerance


def test_second_derivatives_of_a_step_are_those_of_expressions(both):
    """The Hessian of the multipliers of both results, by the state, the torques and the duration."""
    arm, expressions = both
    ours, theirs = (of.euler_step if of is expressions else of.casadi("euler_step") for of in (arm, expressions))
    ours, theirs = ours.reverse(1).jacobian(), theirs.reverse(1).jacobian()
    assert described(ours) == described(theirs)
    random = np.random.default_rng(6)
    for state in states(ours, 5):
        state[3] = random.choice([0.01, -0.02, 0.0, 0.5])
        for index, (found, expected) in enumerate(zip(ours.call(state), theirs.call(state), strict=True)):
            assert difference(found, expected) < 1e-7, ours.name_out(index)


def test_zeros_of_a_tree_are_left_out():
    jacobian = rne.load(ROBOTS / "trees/hyq.yaml").casadi("inverse_dynamics").jacobian()
    # four legs of three joints
    assert [jacobian.nnz_out(index) <= 4 * 9 for index in range(3)] == [True] * 3
    step = rne.load(ROBOTS / "trees/hyq.yaml").casadi("euler_step")
    jacobian, hessian = step.jacobian(), step.reverse(1).jacobian()
    assert all(jacobian.nnz_out(index) <= 4 * 9 for index in range(8))
    assert all(hessian.nnz_out(index) <= 4 * 9 for index in range(hessian.n_out()))


def test_absent_arguments_are_zero():
    arm = rne.robots.panda
    function = arm.casadi()
    q = np.linspace(-1, 1, 7)
    assert difference(function(q, [], []), arm.gravity_torques(q)[:, None]) < 1e-14


def test_a_matrix_and_functions_without_derivatives():
    arm = rne.robots.panda
    function, q = arm.casadi("mass_matrix"), np.linspace(-1, 1, 7)
    assert difference(function(q), arm.mass_matrix(q)) < 1e-14
    with pytest.raises(RuntimeError, match="(?i)jacobian|derivative|differen"):
        function.jacobian()
    with pytest.raises(ValueError, match="CasADi cannot call this"):
        arm.casadi("forward_kinematics")
    with pytest.raises(ValueError, match="did you mean `inverse_dynamics`"):
        arm.casadi("inverse_dynamic")
    free = rne.load(Path(ROBOTS.parent, "docs/desk_arm.yaml"), run_time=["upper"])
    with pytest.raises(ValueError, match="run-time parameters, such as `upper`.* load the robot file without `run_time`"):
        free.casadi()
    for name, instead in (
        ("euler_step_derivatives", r"jacobian\(\)"),
        ("runge_kutta_step", "composes a step of Runge-Kutta from"),
        ("floating_runge_kutta_step", "it takes and returns poses"),
        ("friction_torques", "write the law of friction with CasADi's own operations"),
    ):
        with pytest.raises(ValueError, match=instead):
            arm.casadi(name)


def test_the_order_of_statements_changes_no_bit():
    arm = rne.robots.puma560
    formulas, registers = (arm.code(form="reduced", order=order) for order in ("formulas", "registers"))
    assert formulas != registers
    lines = [{line.strip() for line in code.splitlines() if " = " in line} for code in (formulas, registers)]
    assert lines[0] == lines[1]
    with pytest.raises(ValueError, match="`stack` is not a valid order"):
        arm.code(order="stack")
    with pytest.raises(ValueError, match="code of the seven steps keeps their order"):
        arm.code(order="registers", form="seven_steps")


def test_threads_share_a_function():
    function = rne.robots.puma560.casadi("forward_dynamics").jacobian()
    random = np.random.default_rng(3)
    points = [random.uniform(-1, 1, size=(6, 64)) for _ in range(3)] + [np.zeros((6, 64))]
    serial, threads = function.map(64), function.map(64, "thread", 4)
    for one, other in zip(serial.call(points), threads.call(points)):
        assert np.array_equal(numbers(one), numbers(other))


def test_a_library_is_compiled_once(tmp_path, monkeypatch):
    monkeypatch.setenv("RNE_CACHE", str(tmp_path / "of/mine"))
    arm = rne.robots.planar2
    arm.casadi()
    (library,) = (tmp_path / "of/mine").iterdir()
    made = library.stat().st_mtime_ns
    arm.casadi()
    assert [library] == list((tmp_path / "of/mine").iterdir()) and library.stat().st_mtime_ns == made
    # many at once make one library each, and each of them whole
    monkeypatch.setenv("RNE_CACHE", str(tmp_path / "of/ours"))
    code = "import rne; print(rne.robots.planar2.casadi()([0.1, 0.2], [0, 0], [0, 0]))"
    run = [sys.executable, "-c", code]
    with concurrent.futures.ThreadPoolExecutor() as pool:
        printed = set(pool.map(lambda _: subprocess.run(run, capture_output=True, check=True).stdout, range(4)))
    assert len(printed) == 1 and len(list((tmp_path / "of/ours").iterdir())) == 1


def test_what_is_missing_is_said(tmp_path, monkeypatch):
    monkeypatch.setenv("RNE_CACHE", str(tmp_path))
    monkeypatch.setenv("CC", "no_compiler_of_this_name -m64")
    with pytest.raises(RuntimeError, match="`no_compiler_of_this_name`, which the variable CC names"):
        rne.robots.planar2.casadi()
    monkeypatch.delenv("CC")
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(RuntimeError, match="there is no cc, gcc or clang on PATH"):
        rne.robots.planar2.casadi()
    monkeypatch.setitem(sys.modules, "casadi", None)
    with pytest.raises(ImportError, match="pip install casadi"):
        rne.robots.planar2.casadi()


#: A tolerance below that of the comparison.
OPTIONS = {"print_time": False, "ipopt": {"print_level": 0, "sb": "yes", "tol": 1e-9, "max_iter": 3000}}


def gauss_newton(opti, cost):
    """The second derivatives of Gauss and Newton: those of a quadratic cost, without those of the constraints."""
    of_cost, of_constraints = ca.MX.sym("lam_f"), ca.MX.sym("lam_g", opti.ng)
    hessian = of_cost * ca.triu(ca.hessian(cost, opti.x)[0])
    names = ["x", "p", "lam_f", "lam_g"], ["triu_hess_gamma_x_x"]
    return ca.Function("hessian", [opti.x, opti.p, of_cost, of_constraints], [hessian], *names)


def solved(title, problem):
    """The least cost with rne's functions and with expressions; iterations and times are printed beside each other."""
    costs = []
    for source, (opti, cost) in problem.items():
        opti.minimize(cost)
        opti.solver("ipopt", {**OPTIONS, "hess_lag": gauss_newton(opti, cost)})
        began = time.perf_counter()
        solution = opti.solve()
        took = time.perf_counter() - began
        costs.append(solution.value(cost))
        print(f"{title}, {source}: cost {costs[-1]:.9g}, {solution.stats()['iter_count']} iterations, {took:.2f} s")
    return costs


def swing_up(forward):
    """Two links from hanging to standing within 2 s: multiple shooting with 20 steps of Runge and Kutta."""
    opti, nodes, step = ca.Opti(), 20, 2.0 / 20
    x, u = opti.variable(4, nodes + 1), opti.variable(2, nodes)
    state, tau = ca.MX.sym("x", 4), ca.MX.sym("tau", 2)
    rate = ca.Function("rate", [state, tau], [ca.vertcat(state[2:], forward(state[:2], state[2:], tau))])
    for node in range(nodes):
        at, by = x[:, node], u[:, node]
        k1 = rate(at, by)
        k2 = rate(at + step / 2 * k1, by)
        k3 = rate(at + step / 2 * k2, by)
        k4 = rate(at + step * k3, by)
        opti.subject_to(x[:, node + 1] == at + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4))
        opti.set_initial(x[0, node], -np.pi / 2 + np.pi * node / nodes)
    opti.subject_to(x[:, 0] == [-np.pi / 2, 0, 0, 0])
    opti.subject_to(x[:, nodes] == [np.pi / 2, 0, 0, 0])
    return opti, step * ca.sumsqr(u) * 1e-2


def reach(inverse, limits):
    """The Panda from one pose to another within 1 s: direct collocation with linear accelerations, 20 steps."""
    opti, nodes, step = ca.Opti(), 20, 1.0 / 20
    q, qd, qdd, tau = (opti.variable(7, nodes + 1) for _ in range(4))
    begin = np.array([0, -0.6, 0, -2.2, 0, 1.6, 0.7])
    end = np.array([0.8, 0.3, -0.4, -1.4, 0.5, 1.9, -0.2])
    for node in range(nodes + 1):
        # in parts of the largest torque, so that all numbers are of one size
        opti.subject_to(inverse(q[:, node], qd[:, node], qdd[:, node]) / limits == tau[:, node])
        opti.subject_to(opti.bounded(-1, tau[:, node], 1))
        opti.set_initial(q[:, node], begin + (end - begin) * node / nodes)
        if node < nodes:
            opti.subject_to(qd[:, node + 1] == qd[:, node] + step / 2 * (qdd[:, node] + qdd[:, node + 1]))
            change = step * qd[:, node] + step**2 / 6 * (2 * qdd[:, node] + qdd[:, node + 1])
            opti.subject_to(q[:, node + 1] == q[:, node] + change)
    for node, pose in ((0, begin), (nodes, end)):
        opti.subject_to(q[:, node] == pose)
        opti.subject_to(qd[:, node] == np.zeros(7))
    return opti, step * ca.sumsqr(tau) + 1e-3 * step * ca.sumsqr(qdd)


def test_a_swing_up_has_the_same_optimum():
    arm, expressions = rne.robots.planar2, Expressions("planar2")
    functions = {"rne": arm.casadi("forward_dynamics"), "expressions": expressions.forward_dynamics}
    found, expected = solved("swing-up", {source: swing_up(of) for source, of in functions.items()})
    assert abs(found - expected) < 1e-6 * abs(expected)


def turned_up(next_state):
    """Two links from hanging to level by 30 discrete steps, whose duration is free: multiple shooting."""
    opti, nodes = ca.Opti(), 30
    q, qd, tau, step = opti.variable(2, nodes + 1), opti.variable(2, nodes + 1), opti.variable(2, nodes), opti.variable()
    for node in range(nodes):
        next_q, next_qd = next_state(q[:, node], qd[:, node], tau[:, node], step)
        opti.subject_to(q[:, node + 1] == next_q)
        opti.subject_to(qd[:, node + 1] == next_qd)
        opti.set_initial(q[0, node], -np.pi / 2 + np.pi / 2 * node / nodes)
    for node, pose in ((0, [-np.pi / 2, 0]), (nodes, [0, 0])):
        opti.subject_to(q[:, node] == pose)
        opti.subject_to(qd[:, node] == [0, 0])
    opti.subject_to(opti.bounded(0.005, step, 0.1))
    opti.set_initial(step, 0.03)
    opti.minimize(nodes * step + 1e-2 * step * ca.sumsqr(tau))
    return opti


@pytest.mark.parametrize("hessian", ["exact", "limited-memory"])
def test_discrete_steps_of_a_free_duration_have_the_same_optimum(hessian):
    functions = {"rne": rne.robots.planar2.casadi("euler_step"), "expressions": Expressions("planar2").euler_step}
    costs, iterations, durations = [], [], []
    for function in functions.values():
        opti = turned_up(function)
        opti.solver("ipopt", {**OPTIONS, "ipopt": {**OPTIONS["ipopt"], "hessian_approximation": hessian}})
        solution = opti.solve()
        costs.append(solution.value(opti.f))
        iterations.append(solution.stats()["iter_count"])
        durations.append(solution.value(opti.x)[-1])
        called = {name for name in solution.stats() if name.startswith("n_call_nlp")}
        assert "n_call_nlp_jac_g" in called and ("n_call_nlp_hess_l" in called) == (hessian == "exact")
    assert abs(costs[0] - costs[1]) < 1e-6 * abs(costs[1]), (costs, iterations)
    assert abs(durations[0] - durations[1]) < 1e-5, durations
    if hessian == "exact":
        assert iterations[0] == iterations[1], iterations


def test_a_reach_of_the_panda_has_the_same_optimum():
    arm, expressions = rne.robots.panda, Expressions("panda")
    functions = {"rne": arm.casadi("inverse_dynamics"), "expressions": expressions.inverse_dynamics}
    limits = np.array([87.0] * 4 + [12.0] * 3)
    found, expected = solved("reach", {source: reach(of, limits) for source, of in functions.items()})
    assert abs(found - expected) < 1e-6 * abs(expected)


def test_code_that_casadi_writes_calls_the_library(tmp_path, monkeypatch):
    if shutil.which("cc") is None:
        pytest.skip("there is no compiler of C called cc")
    monkeypatch.setenv("RNE_CACHE", str(tmp_path / "cache"))
    function = rne.robots.planar2.casadi()
    x = ca.MX.sym("x", 2)
    outer = ca.Function("outer", [x], [function(x, x, x)])
    made = ca.CodeGenerator("outer.c")
    made.add(outer)
    made.generate(str(tmp_path) + "/")
    (library,) = (tmp_path / "cache").iterdir()
    command = ["cc", "-shared", "-fPIC", "outer.c", str(library), "-o", "outer.so"]
    subprocess.run(command, cwd=tmp_path, check=True)
    linked = ca.external("outer", str(tmp_path / "outer.so"))
    assert difference(linked([0.3, 0.4]), outer([0.3, 0.4])) == 0


def test_the_example_of_a_controller_plans_alike_with_expressions_and_with_rne(tmp_path, monkeypatch):
    if shutil.which("cc") is None:
        pytest.skip("there is no compiler of C called cc")
    monkeypatch.setenv("RNE_CACHE", str(tmp_path / "cache"))
    monkeypatch.syspath_prepend(ROBOTS.parent / "examples/mpc")
    import casadi_mpc

    arm, expressions = rne.robots.panda, Expressions("panda")
    sample = {f"goal{axis}": x for axis, x in zip((1, 2, 3), (0.4, 0.3, 0.4))}
    for joint in range(7):
        sample |= {f"measured_q{joint + 1}": casadi_mpc.REST[joint], f"measured_qd{joint + 1}": 0.01 * joint}
        sample |= {f"external{joint + 1}": 0.1}
    torques = []
    for source, solver in (("rne", "hpipm"), ("rne", "piqp"), ("expressions", "piqp")):
        numbers = casadi_mpc.program(source, arm, expressions, tmp_path, solver == "hpipm", "-O0")
        planned, _, _, failed = casadi_mpc.planned(numbers, solver, arm, [sample] * 3)
        assert failed == 0
        torques.append(planned)
    for found in torques[1:]:
        assert np.abs(found - torques[0]).max() < 1e-3 * np.abs(torques[0]).max()


def test_the_page_runs_as_it_stands(tmp_path, monkeypatch):
    page = ROBOTS.parent / "docs/control/optimal-control.md"
    text = page.read_text(encoding="utf-8")
    program = os.environ.get("RNE")
    if program is None:
        pytest.skip("RNE names no command line")
    monkeypatch.chdir(tmp_path)
    (command,) = re.findall(r"^cargo run -- (export .*)$", text, re.MULTILINE)
    for folder in ("robots", "docs"):
        (tmp_path / folder).symlink_to(ROBOTS.parent / folder)
    subprocess.run([program, *shlex.split(command)], check=True)
    run_examples(page)
    # the commands of the shell, and what reads their library
    (block,) = (block[1] for block in re.finditer(r"```sh\n(rne emit .*?)```", text, re.DOTALL))
    for command in block.splitlines():
        words = shlex.split(command)
        subprocess.run([program if words[0] == "rne" else words[0], *words[1:]], cwd=tmp_path, check=True)
    (call,) = re.findall(r"^(casadi.external\(.*\)) +# Python$", text, re.MULTILINE)
    q, qd, qdd = np.random.default_rng(4).uniform(-1, 1, size=(3, 7))
    loaded = eval(call.replace("./panda.so", str(tmp_path / "panda.so")), {"casadi": ca})  # noqa: S307
    assert difference(loaded(q, qd, qdd), rne.robots.panda.inverse_dynamics(q, qd, qdd)[:, None]) < 1e-13


def test_functions_for_acados_are_those_that_casadi_generates(tmp_path):
    """By the expressions of acados's own generator, with its integers."""
    program = os.environ.get("RNE")
    if program is None or shutil.which("cc") is None:
        pytest.skip("RNE names no command line, or there is no cc")
    code = [program, "emit", str(ROBOTS / "puma560.yaml"), "--lang", "c", "--casadi", "--acados", "-o", "arm.c"]
    subprocess.run(code, cwd=tmp_path, check=True)
    subprocess.run(["cc", "-std=c99", "-O2", "-fPIC", "-shared", "arm.c", "-o", "arm.so"], cwd=tmp_path, check=True)
    # as acados reads them
    subprocess.run(["cc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-Dcasadi_int=int", "-c", "arm.c"], cwd=tmp_path,
                   check=True)
    x, u, p = ca.MX.sym("x", 12), ca.MX.sym("u", 6), ca.MX.sym("p", 0, 0)
    from_x, from_u, multipliers = ca.MX.sym("Sx", 12, 12), ca.MX.sym("Su", 12, 6), ca.MX.sym("lambda", 12)
    rate = ca.vertcat(x[6:], Expressions("puma560").forward_dynamics(x[:6], x[6:], u))
    backward = ca.jtimes(rate, ca.vertcat(x, u), multipliers, True)
    moved = ca.vertcat(ca.horzcat(from_x, from_u), ca.horzcat(ca.DM.zeros(6, 12), ca.DM.eye(6)))
    hessian = ca.densify(moved.T @ ca.jtimes(backward, ca.vertcat(x, u), moved))
    lower = ca.vertcat(*[hessian[row, column] for column in range(18) for row in range(column, 18)])
    forward = [rate, ca.jtimes(rate, x, from_x), ca.jacobian(rate, u) + ca.jtimes(rate, x, from_u)]
    theirs = {
        "expl_ode_fun": ([x, u, p], [rate]),
        "expl_vde_forw": ([x, from_x, from_u, u, p], forward),
        "expl_vde_adj": ([x, multipliers, u, p], [backward]),
        "expl_ode_hess": ([x, from_x, from_u, multipliers, u, p], [backward, lower]),
    }
    random = np.random.default_rng(8)
    for name, (inputs, outputs) in theirs.items():
        found = ca.external(f"puma560_{name}", str(tmp_path / "arm.so"))
        expected = ca.Function(name, inputs, outputs)
        sizes = [[function.size_in(index) for index in range(function.n_in())] for function in (found, expected)]
        assert sizes[0] == sizes[1]
        for _ in range(10):
            arguments = [random.uniform(-1, 1, size=size) for size in sizes[0]]
            for ours_out, theirs_out in zip(found.call(arguments), expected.call(arguments), strict=True):
                assert difference(ours_out, theirs_out) < 1e-8, name
