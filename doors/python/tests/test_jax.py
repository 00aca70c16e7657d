"""`Arm.jax` against the arm's own functions, and its derivatives against those that JAX takes of a recursion of jax.numpy.
Skipped where JAX is not."""

import concurrent.futures
import ctypes
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest

import rne

jax = pytest.importorskip("jax")
import jax.numpy as jnp  # noqa: E402
import jax.test_util  # noqa: E402
from jnp_recursion import Chain  # noqa: E402
from pages import run_examples  # noqa: E402

from rne.derivatives import DERIVATIVES  # noqa: E402
from rne.xla import TARGET  # noqa: E402

CLOSE = 1e-12
SHAPES = {"payload": (10,), "wrench": (6,), "wrenches": (1, 6)}
#: Functions with second derivatives.
TWICE = ["inverse_dynamics", "bias_torques", "gravity_torques", "forward_dynamics", "kinetic_energy", "potential_energy",
         "pose", "inverse_mass_matrix_times_torques"]
PENDULUM = """format: 1
name: pendulum
source: test
parameters: {m: 2}
convention: modified
gravity: [0, -9.81, 0]
joints:
  - type: revolute
    dh: {theta: 0, d: 0, a: 0, alpha: 0}
    link: {mass: m, com: [0.5, 0, 0], inertia: {xx: 0.1, yy: 0.1, zz: 0.1}}
"""


@pytest.fixture(autouse=True)
def double():
    before = jax.config.jax_enable_x64
    jax.config.update("jax_enable_x64", True)
    yield
    jax.config.update("jax_enable_x64", before)


def states(arm, *leading, seed=3):
    return np.random.default_rng(seed).uniform(-1.5, 1.5, (3, *leading, arm.dof))


def arguments(arm, call, *leading):
    """Random ones for a function: by the names that its words list."""
    random = np.random.default_rng(8)
    for name in call.__doc__.split(": ")[1].rstrip(".").split(", "):
        numbers = random.uniform(-1, 1, (*leading, *SHAPES.get(name, (arm.dof,))))
        yield name, 0.01 if name == "step" else abs(numbers) if name == "payload" else numbers


def difference(found, expected):
    """In parts of the largest number."""
    return np.abs(np.asarray(found) - np.asarray(expected)).max() / max(1.0, np.abs(expected).max())


def test_torques_and_derivatives_are_those_of_a_recursion_that_jax_derives():
    arm = rne.robots.panda
    ours, theirs = arm.jax().inverse_dynamics, Chain(arm).torques
    q, qd, qdd = states(arm, 20)
    everything = (0, 1, 2)
    batch = lambda call: jax.jit(jax.vmap(call))  # noqa: E731
    weighted = lambda call: lambda *state: (call(*state) * jnp.arange(1.0, 8.0)).sum()  # noqa: E731
    assert difference(batch(ours)(q, qd, qdd), batch(theirs)(q, qd, qdd)) < CLOSE
    for derive in (jax.jacfwd, jax.jacrev):
        pairs = zip(batch(derive(ours, everything))(q, qd, qdd), batch(derive(theirs, everything))(q, qd, qdd))
        assert all(difference(found, expected) < CLOSE for found, expected in pairs)
    found = batch(jax.grad(weighted(ours), everything))(q, qd, qdd)
    expected = batch(jax.grad(weighted(theirs), everything))(q, qd, qdd)
    assert max(map(difference, found, expected)) < CLOSE
    by_numbers = batch(Chain(arm).torques_by_numbers)(q, qd, qdd)
    assert difference(by_numbers, batch(theirs)(q, qd, qdd)) < CLOSE


def test_accelerations_and_their_derivatives_are_those_of_a_recursion_that_jax_derives():
    arm = rne.robots.panda
    torques, zero = Chain(arm).torques, jnp.zeros(arm.dof)

    def accelerations(q, qd, tau):
        mass = jax.jacfwd(torques, 2)(q, qd, zero)
        return jnp.linalg.solve(mass, tau - torques(q, qd, zero))

    ours = arm.jax().forward_dynamics
    for q, qd, tau in np.moveaxis(states(arm, 3), 1, 0):
        assert difference(ours(q, qd, tau), accelerations(q, qd, tau)) < 1e-10
        expected = jax.jacfwd(accelerations, (0, 1, 2))(q, qd, tau)
        for derive in (jax.jacfwd, jax.jacrev):
            assert max(map(difference, derive(ours, (0, 1, 2))(q, qd, tau), expected)) < 1e-10


@pytest.mark.parametrize("frame", [None, "panda_joint4"])
def test_every_function_gives_the_numbers_of_the_arm(frame):
    arm = rne.robots.panda
    frame = frame and arm.joints[3]
    functions = arm.jax(frame=frame)
    seen = 0
    for name, call in vars(functions).items():
        words = call.__doc__ if not name.startswith("_") else ""
        if not words or any(word in words for word in ("base", "omega", "twist", "wrenches", "sin,", "pose")):
            continue
        given = dict(arguments(arm, call, 5))
        at_frame = {"frame": frame} if frame and "frame" in getattr(rne.Arm, name).__text_signature__ else {}
        expected = getattr(arm, name)(**given, **at_frame)
        if name == "euler_step_derivatives":  # the blocks of A and B
            (a, b), n = expected, arm.dof
            expected = a[:, :n, :n], a[:, :n, n:], b[:, :n], a[:, n:, :n], a[:, n:, n:], b[:, n:]
        found = jax.jit(call)(**given)
        pairs = zip(found, expected) if isinstance(expected, tuple) else [(found, expected)]
        for one, other in pairs:
            assert one.shape == np.shape(other), name
            np.testing.assert_array_equal(np.asarray(one), other, err_msg=name)
        seen += 1
    assert seen > 25


def test_functions_of_a_floating_base_and_of_trees_give_the_numbers_of_the_arm():
    arm = rne.load(Path(__file__).parents[3] / "docs/standing_hyq.yaml")
    functions, random = arm.jax(), np.random.default_rng(4)
    q, qd, qdd = states(arm, 4)
    omega, wrenches = random.normal(size=(4, 3)), random.normal(size=(4, len(arm.tips), 6))
    pose, twist = np.tile(np.eye(4), (4, 1, 1)), random.normal(size=(4, 6))
    a, b = arm.floating_euler_step_derivatives(q, qd, qdd, pose, twist, 0.01, wrenches)
    for found, expected in [
        (functions.floating_forward_dynamics(q, qd, qdd, omega, wrenches),
         arm.floating_forward_dynamics(q, qd, qdd, omega, wrenches)),
        (functions.inverse_dynamics_with_wrenches(q, qd, qdd, wrenches),
         arm.inverse_dynamics_with_wrenches(q, qd, qdd, wrenches)),
        (functions.floating_euler_step(q, qd, qdd, pose, twist, 0.01, wrenches),
         arm.floating_euler_step(q, qd, qdd, pose, twist, 0.01, wrenches)),
        # the blocks of A and B
        (functions.floating_euler_step_derivatives(q, qd, qdd, pose, twist, 0.01, wrenches),
         (a[:, :18, :18], a[:, :18, 18:], b[:, :18], a[:, 18:, :18], a[:, 18:, 18:], b[:, 18:])),
    ]:
        pairs = zip(found, expected) if isinstance(expected, tuple) else [(found, expected)]
        for one, other in pairs:
            np.testing.assert_array_equal(np.asarray(one), other)


def assert_derivatives_are_those_of_differences(call, given, argument, name):
    at = lambda x: call(**{**given, argument: x})  # noqa: E731
    x, step = given[argument], 1e-5
    units = np.eye(x.size).reshape(-1, *x.shape)
    sides = [jax.tree.map(lambda after, before: (after - before) / (2 * step), at(x + step * e), at(x - step * e))
             for e in units]
    expected = jax.tree.map(lambda *columns: np.stack(columns, -1).reshape(*np.shape(columns[0]), *x.shape), *sides)
    for derive in (jax.jacfwd, jax.jacrev):
        for found, other in zip(*map(jax.tree.leaves, (derive(at)(x), expected)), strict=True):
            assert difference(found, other) < 1e-7, (name, argument, derive)


@pytest.mark.parametrize("name", sorted(DERIVATIVES))
def test_derivatives_are_those_of_central_differences(name):
    call = getattr(rne.robots.puma560.jax(), name)
    given = dict(arguments(rne.robots.puma560, call))
    for argument in DERIVATIVES[name]:
        assert_derivatives_are_those_of_differences(call, given, argument, name)


@pytest.mark.parametrize("file, frame", [("docs/gripper.yaml", "finger"), ("robots/panda.yaml", "panda_joint4")])
def test_derivatives_at_a_frame_are_those_of_differences(file, frame):
    arm = rne.load(Path(__file__).parents[3] / file)
    frame = next(joint for joint in arm.frames + arm.joints if frame in joint)
    functions = arm.jax(frame=frame)
    for name in ("pose", "jacobian", "wrench_torques", "inverse_dynamics_with_wrench"):
        call = getattr(functions, name)
        given = dict(arguments(arm, call))
        for argument in DERIVATIVES[name]:
            assert_derivatives_are_those_of_differences(call, given, argument, name)


def test_second_derivatives_are_those_of_a_recursion_that_jax_derives():
    arm = rne.robots.panda
    states_ = states(arm, 3)
    weights = jnp.arange(1.0, 8.0)
    batch = lambda call: jax.jit(jax.vmap(call))  # noqa: E731
    # λᵀτ and a cost of torques at once: XLA compiles this recursion for long
    of = lambda call: lambda *state: (lambda tau: weights @ tau + weights @ tau**2)(call(*state))  # noqa: E731
    expected = jax.tree.leaves(batch(jax.hessian(of(Chain(arm).torques), (0, 1, 2)))(*states_))
    ours = of(arm.jax().inverse_dynamics)
    for derive in (jax.hessian, lambda f, by: jax.jacfwd(jax.grad(f, by), by), lambda f, by: jax.jacrev(jax.grad(f, by), by)):
        found = jax.tree.leaves(batch(derive(ours, (0, 1, 2)))(*states_))
        assert max(difference(*pair) for pair in zip(found, expected, strict=True)) < 1e-11


@pytest.mark.parametrize("name", TWICE)
def test_second_derivatives_are_those_of_differences(name):
    call = getattr(rne.robots.puma560.jax(), name)
    given = dict(arguments(rne.robots.puma560, call))
    jax.test_util.check_grads(call, list(given.values()), order=2, atol=1e-5, rtol=1e-5, eps=1e-5)


def test_the_derivative_of_the_gradient_is_one_hessian():
    arm = rne.robots.panda
    call, state = arm.jax().torque_gradient, states(arm)
    derived = jax.jit(jax.jacfwd(lambda q: call(q, *state[1:], jnp.ones(7))[0]))
    text = derived.lower(state[0]).as_text()
    assert text.count('"torque_hessian"') == 1 and "x7x7xf64" not in text.split('"torque_hessian"')[1].split("\n")[0]
    assert difference(derived(state[0]), arm.torque_hessian(*state, np.ones(7))[0]) == 0


def test_mapped_axes_are_one_call_and_shared_arguments_are_not_copied():
    arm = rne.robots.panda
    call = arm.jax().inverse_dynamics
    q, qd, qdd = states(arm, 6)
    expected = np.array([arm.inverse_dynamics(one, qd, qdd[0]) for one in q])
    twice = jax.vmap(jax.vmap(call, (None, 0, None)), (0, None, None))
    np.testing.assert_array_equal(np.asarray(twice(q, qd, qdd[0])), expected)
    # numpy's rules of broadcasting
    np.testing.assert_array_equal(np.asarray(call(q[:, None], qd[None], qdd[0])), expected)
    text = jax.jit(twice).lower(q, qd, qdd[0]).as_text()
    assert text.count(f"@{TARGET}(") == 1
    assert "tensor<6x1x7xf64>" in text and "tensor<1x1x7xf64>" in text
    # a row for all, in other ways
    for axes in [(0, None, None), (None, 0, None), (0, 0, None)]:
        given = [array if axis == 0 else array[0] for array, axis in zip((q, qd, qdd), axes)]
        np.testing.assert_array_equal(np.asarray(jax.vmap(call, axes)(*given)), arm.inverse_dynamics(*given))


def test_no_state_gives_no_torques():
    arm = rne.robots.panda
    assert arm.jax().inverse_dynamics(*np.zeros((3, 0, 7))).shape == (0, 7)


def test_unused_derivatives_are_not_computed():
    arm = rne.robots.panda
    q, qd, qdd = states(arm)
    call = arm.jax().inverse_dynamics
    text = jax.jit(jax.grad(lambda qdd: call(q, qd, qdd).sum())).lower(qdd).as_text()
    assert '"mass_matrix"' in text and "derivatives" not in text


def test_single_precision_and_the_option_x64():
    arm = rne.robots.panda
    q, qd, qdd = states(arm, 5).astype(np.float32)
    found = arm.jax().inverse_dynamics(q, qd, qdd)
    assert found.dtype == jnp.float32
    np.testing.assert_array_equal(np.asarray(found), arm.inverse_dynamics(q, qd, qdd))
    assert arm.jax().gravity_torques([0] * 7).dtype == jnp.float64
    jax.config.update("jax_enable_x64", False)
    with pytest.warns(UserWarning, match="computed in float32, because JAX's option jax_enable_x64 is off"):
        assert arm.jax().gravity_torques(np.zeros(7)).dtype == jnp.float32
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        arm.jax().gravity_torques(jnp.zeros(7))
    assert "jax_enable_x64 is off" in repr(arm.jax())


@pytest.mark.parametrize(
    "derive, words",
    [
        (lambda one, q: jax.jacfwd(one.regressor)(q, q, q), "`regressor` has no derivative by `q`, but these functions"),
        (lambda one, q: jax.hessian(lambda q: one.centre_of_mass(q).sum())(q), "has no second derivatives"),
        (lambda one, q: jax.grad(lambda p: one.gravity_torques_with_payload(q, p).sum())(jnp.ones(10)), "by `payload`, but by q"),
    ],
)
def test_what_has_no_derivative_is_refused_in_one_line(derive, words):
    with pytest.raises(NotImplementedError, match=words) as refused:
        derive(rne.robots.panda.jax(), jnp.zeros(7))
    assert "\n" not in str(refused.value)


def test_wrong_arguments_are_refused():
    one = rne.robots.panda.jax()
    q = jnp.zeros(7)
    for call, error, words in [
        (lambda: one.gravity_torques(jnp.zeros(6)), ValueError, r"`q` has the shape \(6,\), but it must be \(..., 7\)"),
        (lambda: one.bias_torques(q), TypeError, "`bias_torques` needs `qd`; it takes q, qd"),
        (lambda: one.bias_torques(q, q, q), TypeError, "`bias_torques` takes q, qd, each once"),
        (lambda: one.bias_torques(q, q=q), TypeError, "each once"),
        (lambda: one.gravity_torques(q * 1j), TypeError, "real numbers"),
        (lambda: rne.robots.panda.jax(frame="elbow"), ValueError, "elbow"),
    ]:
        with pytest.raises(error, match=words):
            call()


def test_the_same_arm_has_the_same_functions():
    arm = rne.robots.panda
    assert arm.jax() is arm.jax() is rne.robots.panda.jax()
    assert arm.jax() is not rne.robots.ur5.jax()
    assert arm.jax() is not arm.jax(frame=arm.joints[0])


def test_run_time_parameters_are_an_argument():
    arm = rne.load(PENDULUM, run_time=["m"])
    call = arm.jax().gravity_torques
    assert np.allclose(call(jnp.zeros(1)), 9.81) and np.allclose(call(jnp.zeros(1), [4.0]), 19.62)
    with pytest.raises(NotImplementedError, match="`parameters`"):
        jax.grad(lambda m: call(jnp.zeros(1), m).sum())(jnp.ones(1))


# What a program of XLA says that nobody checked: an error, and no memory is touched.


def hostile(arrays, result, **attributes):
    given = {"arm": "?", "function": "gravity_torques", **attributes}
    given = {name: value for name, value in given.items() if value is not None}
    call = jax.ffi.ffi_call(TARGET, jax.ShapeDtypeStruct(*result) if isinstance(result, tuple) else result)
    return jax.block_until_ready(jax.jit(lambda *arrays: call(*arrays, **given))(*arrays))


@pytest.mark.parametrize(
    "wrong, words",
    [
        (dict(arm="nobody"), "no arm `nobody`"),
        (dict(arm=None), "no attribute `arm`"),
        (dict(arm=np.int64(7)), "`arm` is no text"),
        (dict(arm=np.zeros(3)), "`arm` is no text"),
        (dict(function="gravity"), "gravity_torques"),
        (dict(function="closure_step"), "no function `closure_step`"),
        (dict(arrays=[]), "takes 1 arrays, but 0 are given"),
        (dict(arrays=[np.zeros((3, 7)), np.zeros((3, 7))]), "takes 1 arrays, but 2 are given"),
        (dict(arrays=[np.zeros((3, 6))]), r"`q` has the shape \[3, 6\]"),
        (dict(arrays=[np.zeros((2, 7))]), r"`q` has the shape \[2, 7\]"),
        (dict(arrays=[np.zeros((1, 3, 7))]), r"`q` has the shape \[1, 3, 7\]"),
        (dict(arrays=[np.zeros(())]), r"`q` has the shape \[\]"),
        (dict(arrays=[np.zeros((3, 7), np.float32)]), "another precision"),
        (dict(arrays=[np.zeros((3, 7), np.int32)]), "data type 4"),
        (dict(result=((3, 8), np.float64)), r"the shape \[3, 8\]; its last axis is 7"),
        (dict(result=((), np.float64)), "its last axis is 7"),
        (dict(result=((3, 7), np.int64)), "the result has the data type 5"),
        (dict(result=[jax.ShapeDtypeStruct((3, 7), np.float32)] * 2), "2 results, but there is one"),
    ],
)
def test_hostile_calls_are_refused(wrong, words):
    name = rne.robots.panda.jax()._all["gravity_torques"].arm
    given = {"arrays": [np.zeros((3, 7))], "result": ((3, 7), np.float64), "arm": name, **wrong}
    with pytest.raises(Exception, match=words):
        hostile(given.pop("arrays"), given.pop("result"), **given)


def test_frames_of_another_size_are_refused():
    """What is too short to be a call frame is not read, and there is no way to make an error of XLA."""
    capsule = rne._rne.xla_handler(*rne.xla.version())
    pointer = ctypes.pythonapi.PyCapsule_GetPointer
    pointer.restype, pointer.argtypes = ctypes.c_void_p, [ctypes.py_object, ctypes.c_char_p]
    handler = ctypes.CFUNCTYPE(ctypes.c_void_p, ctypes.c_void_p)(pointer(capsule, b"xla._CUSTOM_CALL_TARGET"))
    with pytest.raises(RuntimeError, match="version 1.0 of XLA's foreign-function interface, but rne knows 0.0 to 0.3"):
        rne._rne.xla_handler(1, 0)
    assert handler(None) is None
    for size in (0, 8, 24, 96):
        frame = (ctypes.c_size_t * 64)(size)
        assert handler(ctypes.addressof(frame)) is None and list(frame)[1:] == [0] * 63


def test_threads_compute_at_once():
    arm = rne.robots.panda
    call = jax.jit(arm.jax().inverse_dynamics)
    given = states(arm, 50_000)
    expected = arm.inverse_dynamics(*given)
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        for found in pool.map(lambda _: np.asarray(call(*given)), range(8)):
            np.testing.assert_array_equal(found, expected)


def test_a_program_of_the_cache_of_another_process_is_that_of_its_arm(tmp_path):
    """JAX keeps compiled programs in files: the name of an arm tells its content, not its place in a process."""
    program = (
        "import jax, numpy as np, rne\n"
        f"jax.config.update('jax_compilation_cache_dir', {str(tmp_path)!r})\n"
        "jax.config.update('jax_persistent_cache_min_compile_time_secs', 0)\n"
        "jax.config.update('jax_enable_x64', True)\n"
        "for name in {}:\n"
        "    arm = rne.robots[name]\n"
        "    q = np.full(arm.dof, 0.3)\n"
        "    assert (np.asarray(jax.jit(arm.jax().gravity_torques)(q)) == arm.gravity_torques(q)).all(), name\n"
    )
    for order in (["panda", "iiwa14"], ["iiwa14", "panda"]):
        subprocess.run([sys.executable, "-c", program.format(order)], check=True)


def test_the_examples_of_the_page_run():
    page = Path(__file__).parents[3] / "docs/control/jax.md"
    names = run_examples(page, lambda text: text.split("\n## PyTorch\n")[0])
    assert "power" in names
