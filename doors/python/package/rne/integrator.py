"""Steps of the classical Runge-Kutta method, by four calls of the accelerations."""

import numpy

from .names import have_one_count, of_joints, of_number


def given(arm, q, qd, tau, step, steps, **more):
    """The arguments of a step as arrays: of the joints, of more vectors, and of the duration, which has a last axis."""
    if steps < 1:
        raise ValueError(f"`steps` is {steps}; it is the number of steps, 1 or more")
    joints = {"q": q, "qd": qd, "tau": tau}
    vectors = {name: of_joints(arm, numbers, name) for name, numbers in joints.items()} | more
    step = of_number(step, "step")
    if not isinstance(step, numpy.ndarray):
        step = numpy.array(step, dtype=numpy.result_type(*vectors.values()))
    have_one_count({**vectors, "step": step})
    return *vectors.values(), step


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


def keywords(payload, parameters):
    """Arguments that are not None, by their names."""
    asked = {"payload": payload, "parameters": parameters}
    return {name: value for name, value in asked.items() if value is not None}


def runge_kutta_step(arm, q, qd, tau, step, steps, payload, parameters):
    """As `Arm.runge_kutta_step`."""
    q, qd, tau, step = given(arm, q, qd, tau, step, steps)
    options = keywords(payload, parameters)
    for _ in range(steps):
        (q, qd), _ = _step(lambda q, qd: arm.forward_dynamics(q, qd, tau, **options), q, qd, step)
    return q, qd


def runge_kutta_step_derivatives(arm, q, qd, tau, step, steps, payload, parameters):
    """As `Arm.runge_kutta_step_derivatives`."""
    q, qd, tau, step = given(arm, q, qd, tau, step, steps)
    options, n = keywords(payload, parameters), arm.dof
    by_x, by_u = numpy.eye(2 * n), numpy.zeros((2 * n, n))
    # rows of positions and of velocities, columns of q, qd and tau
    still = numpy.hstack([numpy.zeros((n, n)), numpy.eye(n), numpy.zeros((n, n))])
    start = numpy.hstack([numpy.eye(n), numpy.zeros((n, 2 * n))])
    h = step[..., None]
    for _ in range(steps):
        (next_q, next_qd), states = _step(lambda q, qd: arm.forward_dynamics(q, qd, tau, **options), q, qd, step)
        moved, changes = (start, still), []
        for state, duration in zip(states, (0.5 * h, 0.5 * h, h, h)):
            dq, dqd, dtau = arm.forward_dynamics_derivatives(*state, tau, **options)
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
