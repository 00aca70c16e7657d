"""The motion of a floating base in the vectors of other tools, as arguments of
`Arm.inverse_dynamics_of_floating_base`, and its derivatives as their matrices.

docs/conventions.md has the table of these conventions. Each function takes one state or many: vectors are the last axis
of an array.
"""

import numpy as np

_GRAVITY = (0.0, 0.0, -9.81)


def base_from_imu(gyroscope, gyroscope_rate, accelerometer, *, rotation=None, position=(0.0, 0.0, 0.0)):
    """The base whose inertial measurement unit reads these values.

    gyroscope: ω, rad/s, of shape (3,) or (N, 3), in axes of the unit.
    gyroscope_rate: ω̇, rad/s²: a difference of readings, or zeros.
    accelerometer: the specific force a - g, m/s². At rest it points up.
    rotation: 3×3, from the axes of the unit to those of the base. Without it they are the same.
    position: where the unit is on the base, m, in axes of the base.

    Returns a dict of `base_omega`, `base_omega_dot`, `base_acceleration` (here a - g) and `base_gravity` (here zero).
    """
    rotation = np.eye(3) if rotation is None else np.asarray(rotation, float)
    readings = (gyroscope, gyroscope_rate, accelerometer)
    omega, omega_dot, felt = (np.asarray(reading, float) @ rotation.T for reading in readings)
    arm = np.asarray(position, float)
    felt = felt - np.cross(omega_dot, arm) - np.cross(omega, np.cross(omega, arm))
    return _told(omega, omega_dot, felt, np.zeros(3))


def base_from_pinocchio(q, v, a, *, gravity=_GRAVITY):
    """The base of a Pinocchio model with a free flyer, which is its first joint.

    q, v, a: the vectors of `pinocchio.rnea`, of shape (nq,), (nv,), (nv,) or (N, …). Only the first 7, 6 and 6 elements
    count. `a` is Pinocchio's spatial acceleration.
    gravity: in the world, m/s².

    Returns a dict of `base_omega`, `base_omega_dot`, `base_acceleration` and `base_gravity`, in axes of the base.
    """
    q, v, a = (np.asarray(vector, float) for vector in (q, v, a))
    x, y, z, w = np.moveaxis(q[..., 3:7], -1, 0)
    velocity, omega = v[..., :3], v[..., 3:6]
    return _told(omega, a[..., 3:6], a[..., :3] + np.cross(omega, velocity), _in_base((w, x, y, z), gravity))


def derivatives_to_pinocchio(derivatives, mass, q, v, *, gravity=_GRAVITY):
    """The matrices ∂τ/∂q and ∂τ/∂v of `pinocchio.computeRNEADerivatives` with a free flyer; its ∂τ/∂a is `mass`.

    derivatives: what `Arm.floating_inverse_dynamics_derivatives` returns for the base of `base_from_pinocchio`.
    mass: `Arm.floating_mass_matrix` at the same positions, of shape (6 + n, 6 + n) or (N, 6 + n, 6 + n).
    q, v: the vectors of Pinocchio, of which the first 7 and 6 elements count.
    gravity: in the world, m/s².

    Returns two matrices of this shape. Rows are force, moment and torques. Columns are those of Pinocchio's tangent
    space, in axes of the base: translation and rotation of the base, or its linear and angular velocity, then the
    joints in the order of the arm.
    """
    dq, dqd, domega = (np.asarray(matrix, float) for matrix in derivatives)
    linear = np.asarray(mass, float)[..., :, :3]
    q, v = (np.asarray(vector, float) for vector in (q, v))
    x, y, z, w = np.moveaxis(q[..., 3:7], -1, 0)
    gravity = _in_base((w, x, y, z), gravity)
    # Pinocchio holds gravity in world axes, and its spatial acceleration a - ω × v
    turned = -linear @ skew(gravity)
    by_q = np.concatenate([np.zeros_like(turned), turned, dq], axis=-1)
    by_linear, by_angular = linear @ skew(v[..., 3:6]), domega - linear @ skew(v[..., :3])
    return by_q, np.concatenate([by_linear, by_angular, dqd], axis=-1)


def base_from_mujoco(qpos, qvel, qacc, *, gravity=_GRAVITY):
    """The base of a MuJoCo model with a free joint, which is its first joint.

    qpos, qvel, qacc: the vectors of `MjData`, of shape (nq,), (nv,), (nv,) or (N, …). Only the first 7, 6 and 6 elements
    count.
    gravity: in the world, m/s²: `model.opt.gravity`.

    Returns a dict of `base_omega`, `base_omega_dot`, `base_acceleration` and `base_gravity`, in axes of the base.
    """
    qpos, qvel, qacc = (np.asarray(vector, float) for vector in (qpos, qvel, qacc))
    turn = np.moveaxis(qpos[..., 3:7], -1, 0)
    return _told(qvel[..., 3:6], qacc[..., 3:6], _in_base(turn, qacc[..., :3]), _in_base(turn, gravity))


def skew(vector):
    """The matrix of the cross product with a vector."""
    return np.cross(vector[..., None, :], np.eye(3, dtype=vector.dtype)).swapaxes(-1, -2)


def _in_base(quaternion, vector):
    """A vector in world axes, turned back by a unit quaternion w, x, y, z."""
    w, axis = quaternion[0], np.stack(quaternion[1:], axis=-1)
    vector = np.broadcast_to(np.asarray(vector, float), axis.shape)
    twice = 2 * np.cross(axis, vector)
    return vector - w[..., None] * twice + np.cross(axis, twice)


def _told(omega, omega_dot, acceleration, gravity):
    return {"base_omega": omega, "base_omega_dot": omega_dot, "base_acceleration": acceleration, "base_gravity": gravity}
