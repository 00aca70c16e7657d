"""Friction of the joints beside its closed form, by hand from the numbers of a robot file."""

import math

import numpy as np
import pytest

import rne

#: A joint with a gear and another friction in each direction, one with viscous friction alone, one without a motor.
MOTORS = [
    "motor: {inertia: 2e-5, gear_ratio: -50, viscous: 2e-4, coulomb: [0.06, -0.04], coulomb_width: 0.02}",
    "motor: {gear_ratio: 3, viscous: 0.7}",
    "",
]
JOINT = "type: revolute, dh: {theta: 0, d: 0, a: 0.3, alpha: 0}, link: {mass: 1, com: [-0.1, 0, 0], inertia: {}}"


def robot(*motors):
    joints = ", ".join("{" + ", ".join(filter(None, [JOINT, motor])) + "}" for motor in motors)
    return f"{{format: 1, name: rubbing, source: test, convention: standard, gravity: [0, -9.81, 0], joints: [{joints}]}}"


ARM = rne.load(robot(*MOTORS))


def of_first(speed, width):
    """The friction of the first joint, N m: G² B = 0.5, |G| Tc⁺ = 3, |G| Tc⁻ = -2."""
    s = speed / math.hypot(speed, width)
    return 0.5 * speed + 2.5 * s + 0.5 * s * s


def test_friction_is_the_closed_form():
    speeds = [-3.0, -0.05, -0.002, 0.0, 0.001, 0.02, 0.5, 40.0]
    qd = np.array([[speed, 0.3 * speed, speed] for speed in speeds])
    for given, width in (({}, 0.02), ({"width": 0.1}, 0.1)):
        found = ARM.friction_torques(qd, **given)
        expected = [[of_first(speed, width), 9 * 0.7 * 0.3 * speed, 0.0] for speed in speeds]
        assert np.abs(found - expected).max() < 1e-14
        slopes = ARM.friction_derivatives(qd, **given)
        # by hand: the derivatives of s and of s² by the speed
        by_hand = []
        for speed in speeds:
            root = math.hypot(speed, width)
            by_hand.append([0.5 + (2.5 + 2 * 0.5 * speed / root) * width**2 / root**3, 6.3, 0.0])
        assert np.abs(slopes - by_hand).max() < 1e-12
        h = 1e-6
        difference = (ARM.friction_torques(qd + h, **given) - ARM.friction_torques(qd - h, **given)) / (2 * h)
        assert np.abs(slopes - difference).max() < 1e-4 * np.abs(slopes).max()
    # far from rest it is that of actuator_torques, where no joint accelerates
    far = np.array([30.0, 20.0, 10.0])
    for sign in (1, -1):
        assert np.abs(ARM.friction_torques(sign * far) - ARM.actuator_torques(sign * far, 0 * far)).max() < 1e-5
    assert not ARM.friction_torques([0.0] * 3).any()


def test_rollouts_have_this_friction():
    arm, random = rne.load(robot(*MOTORS[:2])), np.random.default_rng(4)
    start, rates, torques = random.normal(size=(3, 5, 2))
    q, qd, step = start, rates, 1e-3
    for _ in range(3):
        qd = qd + step * arm.forward_dynamics(q, qd, torques - arm.friction_torques(qd, width=0.05))
        q = q + step * qd
    found = arm.rollout(start, rates, np.repeat(torques[:, None], 3, axis=1), step, friction=0.05)
    for one, other in zip(found, (q, qd)):
        assert np.abs(one[:, -1] - other).max() < 1e-12


def test_states_names_and_precisions():
    qd = np.array([0.1, -0.2, 0.3])
    for function in (ARM.friction_torques, ARM.friction_derivatives):
        many = function(np.stack([qd, 2 * qd]))
        assert many.shape == (2, 3) and np.array_equal(many[0], function(qd))
        assert np.array_equal(function(dict(zip(ARM.joints, qd))), function(qd))
        assert np.array_equal(function(qd.tolist()), function(qd))
        single = function(np.float32(qd))
        assert single.dtype == np.float32 and np.abs(single - function(qd)).max() < 1e-5
        assert np.isnan(function([math.nan, 0.0, 0.0])[0])
    assert not rne.load(robot("", "")).friction_torques([1.0, 2.0]).any()


def test_squares_of_fast_joints_do_not_overflow():
    arm = rne.load(robot("motor: {coulomb: [3, -2], coulomb_width: 0.02}"))
    for speed in (1e200, -1e200, np.float32(1e25)):
        qd = np.array([speed])
        assert arm.friction_torques(qd)[0] == pytest.approx(3 if speed > 0 else -2)
        assert arm.friction_derivatives(qd)[0] == pytest.approx(0)


def test_mistakes_are_told():
    for function in (ARM.friction_torques, ARM.friction_derivatives):
        with pytest.raises(ValueError, match=r"`qd` has the shape \(2,\); it is \(3,\)"):
            function([0.1, 0.2])
        with pytest.raises(TypeError, match="`qd` is not an array of real numbers"):
            function(["fast"] * 3)
        for width in (0.0, -1.0, 1e-10, math.nan, math.inf):
            with pytest.raises(ValueError, match="`width` is .*, but it must be a finite number of at least 1e-9"):
                function([0.1] * 3, width=width)
        for width in (True, "0.1", [0.1, 0.2]):
            with pytest.raises(TypeError, match="`width` is .*, but it must be one number, in rad/s or m/s"):
                function([0.1] * 3, width=width)
        with pytest.raises(ValueError, match="`width` is 1e-200, but"):
            function([0.1] * 3, width=1e-200)
    without = robot("motor: {coulomb: [3, -2]}")
    with pytest.raises(ValueError, match="the joint joint1 has Coulomb friction without `coulomb_width`.* one `width`"):
        rne.load(without).friction_torques([0.1])
    over_a_way = rne.load(robot("motor: {coulomb: [3, -2], coulomb_displacement: 0.01}"))
    with pytest.raises(ValueError, match="the joint joint1 has `coulomb_displacement`.* one `width`"):
        over_a_way.friction_torques([0.1])
    assert over_a_way.friction_torques([10.0], width=0.01)[0] == pytest.approx(3.0, abs=1e-5)
    free = rne.load(robot("motor: {viscous: rubbing}").replace("name: rubbing", "name: one, parameters: {rubbing: 0.4}"),
                    run_time=["rubbing"])
    with pytest.raises(ValueError, match="depends on a parameter that is given at run time: give this parameter a value"):
        free.friction_torques([0.1])
