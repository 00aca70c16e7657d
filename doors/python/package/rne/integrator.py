"""Steps of the classical Runge-Kutta method, by four calls of the accelerations."""

import numpy

from .names import in_order, of_number


def _given(arm, q, qd, tau, step, steps):
    """Arrays of the joints and of the duration, with a last axis."""
    if steps < 1:
        raise ValueError(f"`steps` is {steps}; it is the number of steps, 1 or more")
    named = [(q, "q"), (qd, "qd"), (tau, "tau")]
    joints = [in_order(one, arm.joints, name, "joint") if isinstance(one, dict) else one for one, name in named]
    return *map(numpy.asarray, joints), numpy.asarray(of_number(step, "step"))


def _stages(accelerations, q, qd, step):
    """The four states at which the method has the accelerations, and these."""
    states, found = [(q, qd)], []
    for duration in (0.5 * step, 0.5 * step, step):
        found.append(accelerations(*states[-1]))
        states.append((q + duration * states[-1][1], qd + duration * found[-1]))
    found.append(accelerations(*states[-1]))
    return states, found


def _weighted(first, second, third, fourth):
    """Six times the mean of the accelerations for the positions, and for the velocities."""
    middle = second + third
    return first + middle, first + 2 * middle + fourth


def _step(accelerations, q, qd, step):
    states, found = _stages(accelerations, q, qd, step)
    mean, rates = _weighted(*found)
    sixth = step / 6
    return (q + step * (qd + sixth * mean), qd + sixth * rates), states


def _keywords(payload, parameters):
    given = {"payload": payload, "parameters": parameters}
    return {name: value for name, value in given.items() if value is not None}


def runge_kutta_step(arm, q, qd, tau, step, steps, payload, parameters):
    """As `Arm.runge_kutta_step`."""
    q, qd, tau, step = _given(arm, q, qd, tau, step, steps)
    keywords = _keywords(payload, parameters)
    for _ in range(steps):
        (q, qd), _ = _step(lambda q, qd: arm.forward_dynamics(q, qd, tau, **keywords), q, qd, step)
    return q, qd


def runge_kutta_step_derivatives(arm, q, qd, tau, step, steps, payload, parameters):
    """As `Arm.runge_kutta_step_derivatives`."""
    q, qd, tau, step = _given(arm, q, qd, tau, step, steps)
    keywords, n = _keywords(payload, parameters), arm.dof
    by_x, by_u = numpy.eye(2 * n), numpy.zeros((2 * n, n))
    # rows of positions and of velocities, columns of q, qd and tau
    still = numpy.hstack([numpy.zeros((n, n)), numpy.eye(n), numpy.zeros((n, n))])
    start = numpy.hstack([numpy.eye(n), numpy.zeros((n, 2 * n))])
    h = step[..., None]
    for _ in range(steps):
        (next_q, next_qd), states = _step(lambda q, qd: arm.forward_dynamics(q, qd, tau, **keywords), q, qd, step)
        moved, changes = (start, still), []
        for state, duration in zip(states, (0.5 * h, 0.5 * h, h, h)):
            dq, dqd, dtau = arm.forward_dynamics_derivatives(*state, tau, **keywords)
            change = dq @ moved[0] + dqd @ moved[1]
            change[..., 2 * n :] += dtau
            changes.append(change)
            moved = start + duration * moved[1], still + duration * change
        mean, rates = _weighted(*changes)
        model = numpy.concatenate([start + h * (still + h / 6 * mean), still + h / 6 * rates], axis=-2)
        a, b = model[..., : 2 * n], model[..., 2 * n :]
        by_x, by_u = a @ by_x, a @ by_u + b
        q, qd = next_q, next_qd
    return by_x, by_u
