"""Steps of the classical Runge-Kutta method where nothing holds the base, and their derivatives.

A step integrates 9 + 2 n numbers: the coordinates u of the turn of the base since the step began, the velocity of its
origin in world axes, its angular velocity in its axes, then q and qd of the joints. The unit quaternion of the turn is
(1 - s, 2 u) / (1 + s) with s = u·u, so a step needs no root and no sine, and is smooth at rest.
"""

import numpy

from .bases import skew
from .integrator import given, keywords
from .names import of_pose, of_vector

#: Where the numbers of the base are among those that a step integrates.
_TURN, _LINEAR, _ANGULAR, _BASE = slice(0, 3), slice(3, 6), slice(6, 9), 9


def _joined(*parts):
    """Vectors of one state or of many, one behind the other on the last axis."""
    leading = numpy.broadcast_shapes(*(part.shape[:-1] for part in parts))
    return numpy.concatenate([numpy.broadcast_to(part, leading + part.shape[-1:]) for part in parts], axis=-1)


def _times(matrices, vectors):
    return (matrices @ vectors[..., None])[..., 0]


def _dot(one, other):
    """The inner product, with an axis of one number for each of the axes of a matrix."""
    return (one * other).sum(axis=-1)[..., None, None]


def _turned(u):
    """The rotation of the coordinates u."""
    s, across = _dot(u, u), skew(u)
    scale = 4 / (1 + s) ** 2
    return numpy.eye(3, dtype=u.dtype) + scale * ((1 - s) * across + 2 * across @ across)


def _turn_by_change(u):
    """The matrix from changes of u to the turn that they make, in the turned axes."""
    scale, across = 2 / (1 + _dot(u, u)), skew(u)
    return 2 * scale * (numpy.eye(3, dtype=u.dtype) + scale * (across @ across - across))


def _unit(near):
    """The rotation next to a matrix that is nearly one: a step of Newton's method."""
    square = near.swapaxes(-1, -2) @ near
    return near @ (1.5 * numpy.eye(3, dtype=near.dtype) - 0.5 * square)


def _stages(rates, start, step):
    """The four states of a step and the rates at them, of numbers or of their changes.

    Returns the numbers after the step, the mean of the velocities of the origin with which it moves, and the states.
    """
    states, found = [start], []
    for duration in (0.5 * step, 0.5 * step, step):
        found.append(rates(len(found), states[-1]))
        states.append(start + duration * found[-1])
    found.append(rates(3, states[-1]))
    first, second, third, fourth = found
    sixth = step / 6
    after = start + sixth * (first + 2 * (second + third) + fourth)
    return after, start + sixth * (first + second + third), states


def _rates(arm, rotation, state, tau, wrenches, options):
    """The rates of the numbers, and the accelerations of the base, less gravity and in its axes, and of the joints."""
    u, omega = state[..., _TURN], state[..., _ANGULAR]
    q, qd = numpy.split(state[..., _BASE:], 2, axis=-1)
    base, qdd = arm.floating_forward_dynamics(q, qd, tau, omega, wrenches, **options)
    square, along = ((u * other).sum(axis=-1)[..., None] for other in (u, omega))
    turning = ((1 - square) * omega + 2 * numpy.cross(u, omega) + 2 * along * u) / 4
    gravity = numpy.array(arm.gravity, dtype=base.dtype)
    linear = _times(rotation @ _turned(u), base[..., :3]) + gravity
    return _joined(turning, linear, base[..., 3:], qd, qdd), base, qdd


def _changes_of_rates(arm, rotation, state, base, qdd, wrenches, options):
    """The matrices from the changes of the numbers, of the turn before the step and of the torques to those of rates."""
    n, (u, omega) = arm.dof, (state[..., _TURN], state[..., _ANGULAR])
    q, qd = numpy.split(state[..., _BASE:], 2, axis=-1)
    linear, identity = base[..., :3], numpy.eye(3, dtype=base.dtype)
    # the acceleration of the base is less gravity
    motion = {"base_omega": omega, "base_omega_dot": base[..., 3:], "base_acceleration": linear, "base_gravity": [0.0] * 3}
    dq, dqd, domega = arm.floating_inverse_dynamics_derivatives(q, qd, qdd, wrenches, **motion, **options)
    driven = numpy.concatenate([numpy.zeros((6, n)), -numpy.eye(n)]).astype(dq.dtype)
    forces = numpy.concatenate([domega, dq, dqd, numpy.broadcast_to(driven, dq.shape)], axis=-1)
    try:
        accelerations = -numpy.linalg.solve(arm.floating_mass_matrix(q, **options), forces)
    except numpy.linalg.LinAlgError:
        raise ValueError(
            "the mass matrix is singular in one of the states: the base or a joint moves no mass, so the step has no "
            "derivatives"
        ) from None
    turned = rotation @ _turned(u)
    # rows of the linear accelerations in world axes; columns by omega, q, qd and tau
    accelerations = numpy.concatenate([turned @ accelerations[..., :3, :], accelerations[..., 3:, :]], axis=-2)

    by_numbers = numpy.zeros(dq.shape[:-2] + 2 * (_BASE + 2 * n,), dtype=dq.dtype)
    outer = u[..., :, None] * omega[..., None, :]
    by_numbers[..., _TURN, _TURN] = (outer - outer.swapaxes(-1, -2) - skew(omega) + _dot(u, omega) * identity) / 2
    twice = skew(u) + u[..., :, None] * u[..., None, :]
    by_numbers[..., _TURN, _ANGULAR] = ((1 - _dot(u, u)) * identity + 2 * twice) / 4
    by_numbers[..., _LINEAR, _TURN] = -turned @ skew(linear) @ _turn_by_change(u)
    by_numbers[..., 3:_BASE, 6:] = accelerations[..., :6, : 3 + 2 * n]
    by_numbers[..., _BASE : _BASE + n, _BASE + n :] = numpy.eye(n)
    by_numbers[..., _BASE + n :, 6:] = accelerations[..., 6:, : 3 + 2 * n]

    by_torques = numpy.zeros(dq.shape[:-2] + (_BASE + 2 * n, n), dtype=dq.dtype)
    by_torques[..., 3:_BASE, :] = accelerations[..., :6, 3 + 2 * n :]
    by_torques[..., _BASE + n :, :] = accelerations[..., 6:, 3 + 2 * n :]
    return by_numbers, -skew(_times(turned, linear)) @ rotation, by_torques


def _derivatives(states, matrices, after, rotations, twist, step):
    """A and B of a step, by its states and the matrices of the changes of the rates there."""
    n = (states[0].shape[-1] - _BASE) // 2
    before, turn, next_rotation = rotations
    back, size = next_rotation.swapaxes(-1, -2), 6 + n
    # columns: the positions, then the velocities, each of the base before the joints, then the torques
    shape = matrices[0][0].shape[:-1] + (2 * size + n,)
    turning, torques = slice(3, 6), slice(2 * size, 2 * size + n)
    start = numpy.zeros(shape, dtype=after.dtype)
    start[..., _LINEAR, turning] = -before @ skew(twist[..., :3])
    start[..., _LINEAR, size : size + 3] = before
    start[..., _ANGULAR, size + 3 : size + 6] = numpy.eye(3)
    start[..., _BASE : _BASE + n, 6:size] = numpy.eye(n)
    start[..., _BASE + n :, size + 6 : 2 * size] = numpy.eye(n)

    def rates(number, change):
        by_numbers, by_turn, by_torques = matrices[number]
        found = by_numbers @ change
        found[..., _LINEAR, turning] += by_turn
        found[..., torques] += by_torques
        return found

    change, mean, _ = _stages(rates, start, step)
    shift = step * mean[..., _LINEAR, :]
    shift[..., :3] += before
    turned = _turn_by_change(after[..., _TURN]) @ change[..., _TURN, :]
    turned[..., turning] += turn.swapaxes(-1, -2)
    velocity = skew(_times(back, after[..., _LINEAR]))
    joints = change[..., _BASE:, :]
    rows = [back @ shift, turned, joints[..., :n, :]]
    rows += [back @ change[..., _LINEAR, :] + velocity @ turned, change[..., _ANGULAR, :], joints[..., n:, :]]
    model = numpy.concatenate(rows, axis=-2)
    return model[..., : 2 * size], model[..., 2 * size :]


def _steps(arm, q, qd, tau, pose, twist, step, wrenches, steps, parameters, with_derivatives):
    """The state after the steps: rotation, origin, twist, q and qd; and A and B over all steps, or neither."""
    base = {"pose": of_vector(of_pose(pose, "pose"), 12, "pose"), "twist": of_vector(twist, 6, "twist")}
    q, qd, tau, pose, twist, step = given(arm, q, qd, tau, step, steps, **base)
    rotation, origin = pose[..., :9].reshape(*pose.shape[:-1], 3, 3), pose[..., 9:]
    options, model = keywords(None, parameters), None
    for _ in range(steps):
        start = _joined(numpy.zeros_like(origin), _times(rotation, twist[..., :3]), twist[..., 3:], q, qd)
        found = []

        def rates(_, state):
            rates, *accelerations = _rates(arm, rotation, state, tau, wrenches, options)
            found.append(accelerations)
            return rates

        after, mean, states = _stages(rates, start, step)
        turn = _turned(after[..., _TURN])
        next_rotation = _unit(rotation @ turn)
        if with_derivatives:
            matrices = [_changes_of_rates(arm, rotation, state, *accelerations, wrenches, options)
                        for state, accelerations in zip(states, found)]
            rotations = rotation, turn, next_rotation
            a, b = _derivatives(states, matrices, after, rotations, twist, step[..., None])
            model = (a, b) if model is None else (a @ model[0], a @ model[1] + b)
        rotation, origin = next_rotation, origin + step * mean[..., _LINEAR]
        twist = _joined(_times(rotation.swapaxes(-1, -2), after[..., _LINEAR]), after[..., _ANGULAR])
        q, qd = numpy.split(after[..., _BASE:], 2, axis=-1)
    return (rotation, origin, twist, q, qd), model


def floating_runge_kutta_step(arm, q, qd, tau, pose, twist, step, wrenches, steps, parameters):
    """As `Arm.floating_runge_kutta_step`."""
    (rotation, origin, twist, q, qd), _ = _steps(
        arm, q, qd, tau, pose, twist, step, wrenches, steps, parameters, False)
    pose = numpy.zeros(origin.shape[:-1] + (4, 4), dtype=origin.dtype)
    pose[..., :3, :3], pose[..., :3, 3], pose[..., 3, 3] = rotation, origin, 1.0
    return pose, twist, q, qd


def floating_runge_kutta_step_derivatives(arm, q, qd, tau, pose, twist, step, wrenches, steps, parameters):
    """As `Arm.floating_runge_kutta_step_derivatives`."""
    return _steps(arm, q, qd, tau, pose, twist, step, wrenches, steps, parameters, True)[1]
