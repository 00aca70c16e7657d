"""`Arm.torch` against the arm's own functions, and its derivatives against differences. Skipped where PyTorch is not."""

from pathlib import Path

import numpy as np
import pytest

import rne

torch = pytest.importorskip("torch", minversion="2.4")

from pages import run_examples  # noqa: E402

from rne.derivatives import DERIVATIVES  # noqa: E402

SHAPES = {"payload": (10,), "wrench": (6,), "wrenches": (1, 6)}
#: Functions with second derivatives.
TWICE = ["inverse_dynamics", "bias_torques", "gravity_torques", "forward_dynamics", "kinetic_energy", "potential_energy",
         "pose", "inverse_mass_matrix_times_torques"]
EVERY = ["kinetic_energy", "mass_matrix", "inverse_dynamics_derivatives", "pose", "link_poses", "jacobian", "regressor",
         "forward_dynamics", "inverse_dynamics_with_payload", "inverse_dynamics_with_wrench", "torque_gradient"]


def arguments(arm, call, *leading):
    random = np.random.default_rng(8)
    for name in call.__doc__.split(": ")[1].rstrip(".").split(", "):
        numbers = random.uniform(-1, 1, (*leading, *SHAPES.get(name, (arm.dof,))))
        yield name, torch.from_numpy(abs(numbers) if name == "payload" else numbers)


@pytest.mark.parametrize("name", EVERY)
def test_functions_give_the_numbers_of_the_arm(name):
    arm = rne.robots.panda
    call = getattr(arm.torch(), name)
    for leading in [(), (5,)]:
        given = dict(arguments(arm, call, *leading))
        found = call(**given)
        expected = getattr(arm, name)(**{key: value.numpy() for key, value in given.items()})
        pairs = zip(found, expected) if isinstance(expected, tuple) else [(found, expected)]
        for one, other in pairs:
            np.testing.assert_array_equal(one.numpy(), other)


@pytest.mark.parametrize("name", sorted(DERIVATIVES))
def test_derivatives_are_those_of_differences(name):
    arm = rne.robots.puma560
    call = getattr(arm.torch(), name)
    given, many = dict(arguments(arm, call)), dict(arguments(arm, call, 3))
    for argument in DERIVATIVES[name]:
        # one number of all results
        def at(x):
            found = call(**{**given, argument: x})  # noqa: B023
            parts = [part.flatten() for part in (found if isinstance(found, tuple) else (found,))]
            return torch.cat(parts) @ torch.linspace(1, 2, sum(map(len, parts)), dtype=x.dtype)

        x, step = given[argument], 1e-5
        units = torch.eye(x.numel(), dtype=x.dtype).reshape(-1, *x.shape)
        sides = [(at(x + step * e) - at(x - step * e)) / (2 * step) for e in units]
        expected = torch.stack(sides).reshape(x.shape)
        found = torch.autograd.functional.jacobian(at, x)
        assert (found - expected).abs().max() <= 1e-7 * max(1, expected.abs().max()), argument
        # many states at once have the gradients of each alone
        total = lambda found: sum(part.sum() for part in found) if isinstance(found, tuple) else found.sum()  # noqa: E731
        many[argument].requires_grad_()
        total(call(**many)).backward()
        for state in range(3):
            alone = {key: value[state].detach().clone() for key, value in many.items()}
            alone[argument].requires_grad_()
            total(call(**alone)).backward()
            torch.testing.assert_close(many[argument].grad[state], alone[argument].grad, rtol=1e-12, atol=1e-10)
        many[argument].requires_grad_(False)


@pytest.mark.parametrize("name", TWICE)
def test_second_derivatives_are_those_of_differences(name):
    arm = rne.robots.puma560
    call = getattr(arm.torch(), name)
    given = [one.requires_grad_() for _, one in arguments(arm, call, 2)]
    torch.autograd.gradgradcheck(call, given, eps=1e-5, atol=1e-5, rtol=1e-5)


def test_the_hessian_is_that_of_the_arm():
    arm = rne.robots.panda
    q, qd, qdd, multipliers = (one for _, one in arguments(arm, arm.torch().torque_gradient))
    call = arm.torch().inverse_dynamics
    found = torch.autograd.functional.hessian(lambda q: multipliers @ call(q, qd, qdd), q)
    expected = arm.torque_hessian(*(one.numpy() for one in (q, qd, qdd, multipliers)))[0]
    np.testing.assert_array_equal(found.numpy(), expected)


def test_compiled_programs_give_the_same():
    arm = rne.robots.panda
    call = arm.torch().inverse_dynamics
    given = [one.requires_grad_() for _, one in arguments(arm, call, 4)]
    cost = lambda *state: (call(*state).square() * 2).sum()  # noqa: E731
    compiled = torch.compile(cost, fullgraph=True, backend="aot_eager")
    found, expected = (torch.autograd.grad(one(*given), given) for one in (compiled, cost))
    for one, other in zip(found, expected, strict=True):
        torch.testing.assert_close(one, other, rtol=1e-14, atol=1e-14)


def test_derivatives_at_a_frame_are_those_of_differences():
    arm = rne.robots.panda
    functions = arm.torch(frame=arm.joints[3])
    for name in ("pose", "jacobian", "wrench_torques", "inverse_dynamics_with_wrench"):
        call = getattr(functions, name)
        given = [one.requires_grad_() for _, one in arguments(arm, call)]
        torch.autograd.gradcheck(call, given, eps=1e-5, atol=1e-6)


def test_a_row_for_all_states_gets_the_sum_of_their_gradients():
    arm = rne.robots.panda
    call = arm.torch().inverse_dynamics
    q, qd, qdd = (one for _, one in arguments(arm, call, 4))
    row = q[0].clone().requires_grad_()
    call(row, qd, qdd).sum().backward()
    rows = q[:1].expand(4, 7).clone().requires_grad_()
    call(rows, qd, qdd).sum().backward()
    torch.testing.assert_close(row.grad, rows.grad.sum(0), rtol=1e-13, atol=1e-13)
    np.testing.assert_array_equal(call(q[:, None], qd[None], qdd[0]).shape, (4, 4, 7))


def test_single_precision_stays():
    arm = rne.robots.panda
    q = torch.full((5, 7), 0.2, dtype=torch.float32)
    found = arm.torch().gravity_torques(q)
    assert found.dtype == torch.float32
    np.testing.assert_array_equal(found.numpy(), arm.gravity_torques(q.numpy()))
    assert arm.torch().gravity_torques([0] * 7).dtype == torch.float64


@pytest.mark.skipif(not hasattr(torch.library, "register_vmap"), reason="torch 2.5 has it")
def test_mapped_axes_are_one_call():
    arm = rne.robots.panda
    call = arm.torch().inverse_dynamics
    q, qd, qdd = (one for _, one in arguments(arm, call, 4))
    found = torch.vmap(torch.vmap(call, (None, 0, None)), (0, None, None))(q, qd, qdd[0])
    np.testing.assert_array_equal(found.numpy(), call(q[:, None], qd[None], qdd[0]).numpy())


def test_the_operator_is_what_pytorch_asks_of_one():
    arm = rne.robots.panda
    call = arm.torch().inverse_dynamics
    given = [one.requires_grad_() for _, one in arguments(arm, call, 4)]
    operator = torch.ops.rne.compute.default
    torch.library.opcheck(operator, (given, rne.names.of_content(arm, None), "inverse_dynamics"),
                          test_utils=("test_schema", "test_autograd_registration", "test_faketensor"))


def test_what_has_no_derivative_is_refused_in_one_line():
    functions = rne.robots.panda.torch()
    q = torch.zeros(7, dtype=torch.float64, requires_grad=True)
    slope = torch.autograd.grad(functions.centre_of_mass(q).sum(), q, create_graph=True)[0]
    for value, words in [(functions.link_poses(q), "`link_poses` has no derivative by `q`"), (slope, "no second")]:
        with pytest.raises(NotImplementedError, match=words) as refused:
            value.sum().backward()
        assert "\n" not in str(refused.value)


def test_wrong_arguments_are_refused():
    one = rne.robots.panda.torch()
    q = torch.zeros(7)
    for call, error, words in [
        (lambda: one.gravity_torques(q[:6]), ValueError, r"`q` has the shape \(6,\), but it must be \(..., 7\)"),
        (lambda: one.bias_torques(q), TypeError, "`bias_torques` needs `qd`; it takes q, qd"),
        (lambda: one.bias_torques(q, q, q), TypeError, "`bias_torques` takes q, qd, each once"),
        (lambda: one.gravity_torques(q * 1j), TypeError, "real numbers"),
        (lambda: one.gravity_torques(q.to("meta")), ValueError, "`q` is on meta, but rne computes on the CPU"),
        (lambda: rne.robots.panda.torch(frame="elbow"), ValueError, "elbow"),
    ]:
        with pytest.raises(error, match=words):
            call()


def test_frames_and_no_state():
    arm = rne.robots.panda
    frame, q = arm.joints[3], torch.full((2, 7), 0.3, dtype=torch.float64)
    np.testing.assert_array_equal(arm.torch(frame=frame).pose(q).numpy(), arm.pose(q.numpy(), frame=frame))
    assert arm.torch().gravity_torques(torch.zeros(0, 7)).shape == (0, 7)


def test_the_example_of_the_page_runs():
    run_examples(Path(__file__).parents[3] / "docs/control/jax.md", lambda text: text.split("\n## PyTorch\n")[1])
