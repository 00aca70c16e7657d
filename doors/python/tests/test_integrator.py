"""Steps of integrators beside the method of a textbook on the accelerations, and their models beside differences."""

import numpy as np
import pytest

import rne

N = 6


def states(arm, seed):
    random = np.random.default_rng(seed)
    return random.normal(size=(3, N, arm.dof)) * [[[1.0]], [[0.5]], [[2.0]]]


def euler(arm, q, qd, tau, step):
    rates = qd + step * arm.forward_dynamics(q, qd, tau)
    return np.concatenate([q + step * rates, rates], -1)


def runge_kutta(arm, q, qd, tau, step):
    """Slopes of the whole state."""
    state = np.concatenate([q, qd], -1)

    def slope(state):
        q, qd = np.split(state, 2, -1)
        return np.concatenate([qd, arm.forward_dynamics(q, qd, tau)], -1)

    first = slope(state)
    second = slope(state + step / 2 * first)
    third = slope(state + step / 2 * second)
    fourth = slope(state + step * third)
    return state + step / 6 * (first + 2 * second + 2 * third + fourth)


METHODS = {"euler_step": euler, "runge_kutta_step": runge_kutta}


@pytest.mark.parametrize("name", ["puma560", "scara_cobra600"])
@pytest.mark.parametrize("method", METHODS)
def test_steps_are_those_of_textbooks(name, method):
    arm = getattr(rne.robots, name)
    q, qd, tau = states(arm, 1)
    of, model = getattr(arm, method), getattr(arm, f"{method}_derivatives")
    for step in (0.001, np.linspace(0.001, 0.003, N)):
        durations = np.broadcast_to(step, N)[:, None]
        expected = METHODS[method](arm, q, qd, tau, durations)
        found = np.concatenate(of(q, qd, tau, step), -1)
        assert np.abs(found - expected).max() <= 1e-12 * np.abs(expected).max()
        a, b = model(q, qd, tau, step)
        assert a.shape == (N, 2 * arm.dof, 2 * arm.dof) and b.shape == (N, 2 * arm.dof, arm.dof)
        # central differences of the step in a direction
        random = np.random.default_rng(2)
        dq, dqd, dtau = random.normal(size=(3, N, arm.dof))
        ahead, back = (METHODS[method](arm, q + e * dq, qd + e * dqd, tau + e * dtau, durations) for e in (1e-6, -1e-6))
        along = a @ np.concatenate([dq, dqd], -1)[..., None] + b @ dtau[..., None]
        difference = (ahead - back) / 2e-6
        assert np.abs(along[..., 0] - difference).max() <= 1e-7 * np.abs(difference).max()
    for state in range(N):
        alone = np.concatenate(of(q[state], qd[state], tau[state], 0.001), -1)
        many = np.concatenate(of(q, qd, tau, 0.001), -1)[state]
        assert np.abs(alone - many).max() <= 1e-14 * np.abs(many).max()


def test_several_steps_follow_each_other():
    arm = rne.robots.planar2
    q, qd, tau = states(arm, 3)
    expected, by_x, by_u = (q, qd), np.eye(4), 0
    for _ in range(5):
        a, b = arm.runge_kutta_step_derivatives(*expected, tau, 0.002)
        by_x, by_u = a @ by_x, a @ by_u + b if np.ndim(by_u) else b
        expected = arm.runge_kutta_step(*expected, tau, 0.002)
    found = arm.runge_kutta_step(q, qd, tau, 0.002, steps=5)
    assert all(np.array_equal(one, other) for one, other in zip(found, expected))
    for found, expected in zip(arm.runge_kutta_step_derivatives(q, qd, tau, 0.002, steps=5), (by_x, by_u)):
        assert np.abs(found - expected).max() <= 1e-13 * np.abs(expected).max()


def test_the_error_is_of_fourth_order():
    arm = rne.robots.planar2
    start = [0.3, -0.4], [0.5, 0.2], [1.0, 0.2]

    def after(steps):
        return np.concatenate(arm.runge_kutta_step(*start, 0.2 / steps, steps=steps))

    exact = after(4000)
    errors = [np.abs(after(steps) - exact).max() for steps in (160, 320)]  # shorter steps than those whose error has higher orders
    assert abs(np.log2(errors[0] / errors[1]) - 4) < 0.2


def test_mistakes_are_told():
    arm = rne.robots.planar2
    zeros = [0.0, 0.0]
    for steps in (0, -1):
        with pytest.raises(ValueError, match=f"`steps` is {steps}"):
            arm.runge_kutta_step(zeros, zeros, zeros, 0.01, steps=steps)
    for of in (arm.euler_step, arm.runge_kutta_step):
        with pytest.raises(TypeError, match="`step` is not a real number"):
            of(zeros, zeros, zeros, "long")
        with pytest.raises(ValueError, match="`step` has the shape"):
            of(zeros, zeros, zeros, [[0.01]])
