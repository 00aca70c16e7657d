"""Friction of the joints, by the numbers viscous, odd, even and width of each joint."""

import numpy

from .names import of_joints


def _law(arm, qd, numbers):
    """The velocities, 1 / √(qd² + width²), whose squares may be too large, and the numbers in their precision."""
    qd = of_joints(arm, qd, "qd")
    viscous, odd, even, width = numpy.array(numbers, dtype=qd.dtype).reshape(-1, 4).T
    return qd, 1 / numpy.hypot(qd, width), viscous, odd, even, width


def torques(arm, qd, numbers):
    """As `Arm.friction_torques`."""
    qd, inverse, viscous, odd, even, _ = _law(arm, qd, numbers)
    s = qd * inverse
    return viscous * qd + odd * s + even * s * s


def derivatives(arm, qd, numbers):
    """As `Arm.friction_derivatives`."""
    qd, inverse, viscous, odd, even, width = _law(arm, qd, numbers)
    return viscous + (odd + 2 * even * qd * inverse) * (width * inverse) ** 2 * inverse
