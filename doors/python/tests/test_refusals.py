"""What an argument cannot be is refused by every function that takes it. The loops are over the table of functions."""

import pathlib

import numpy as np
import pytest

import rne

DOCS = pathlib.Path(__file__).parents[3] / "docs"
SATELLITE = rne.load(DOCS / "satellite.yaml")
STANDING = rne.load(DOCS / "standing_hyq.yaml")
ONE, TURNED = np.eye(4), np.diag([1.0, -1.0, -1.0, 1.0])
SHEARED, MIRRORED = np.eye(4), np.diag([1.0, 1.0, -1.0, 1.0])
SHEARED[0, 1] = 0.1
POSES = [2 * ONE, MIRRORED, SHEARED, np.diag([0.0, 0.0, 0.0, 1.0])]
STEPS = [0.0, -0.01, float("nan"), float("inf")]
WRONG = {
    "step": (STEPS, "must be a finite number above 0"),
    "pose": (POSES, "must have the length 1, be at right angles|unit vectors at right angles"),
    "base_rotation": ([pose[:3, :3] for pose in POSES], "must have the length 1, be at right angles"),
    "payload": ([[-1.0] + [0.0] * 9, [1.0, 0, 0, 0, 0.1, 0.1, -0.1, 0, 0, 0], [1.0, 0, 0, 0, 0.1, 0.1, 0.1, 0.2, 0, 0]],
                "the payload's mass is -1 kg|a principal moment of -1.000e-1 kg m²"),
}


def arguments(operands):
    """Arguments of one state that are right."""
    given = {"step": 0.01, "pose": TURNED, "base_rotation": TURNED[:3, :3], "payload": rne.payload(1.0)}
    turns = {"sin": np.sin(0.1), "cos": np.cos(0.1)}
    return {name: given.get(name, np.full(shape, turns.get(name, 0.1))) for name, shape in operands}


def calls():
    """Every function of the table with its arguments, and those that are composed of others."""
    for arm in (SATELLITE, STANDING):
        for method, name, operands, _ in arm._functions():
            if name != "forward_dynamics_in_contact" or arm is STANDING:
                yield arm, method, arguments(operands)
        joints = {name: np.full(arm.dof, 0.1) for name in ("q", "qd", "tau")}
        for method in ("runge_kutta_step", "runge_kutta_step_derivatives"):
            yield arm, method, {**joints, "step": 0.01}
            yield arm, f"floating_{method}", {**joints, "pose": TURNED, "twist": np.zeros(6), "step": 0.01}
        yield arm, "rollout", {**joints, "tau": np.zeros((3, arm.dof)), "step": 0.01}


def test_every_function_refuses_what_an_argument_cannot_be():
    refused = 0
    for arm, method, given in calls():
        call = getattr(arm, method)
        if arm is SATELLITE:
            call(**given)
        for name in WRONG.keys() & given.keys():
            values, says = WRONG[name]
            for value in values:
                with pytest.raises(ValueError, match=says):
                    call(**{**given, name: value})
                refused += 1
    assert refused > 100


def test_a_sine_and_a_cosine_are_those_of_an_angle():
    arm, q = rne.load("planar2"), np.array([[0.3, 0.4], [0.5, 0.6]])
    sin, cos = np.sin(q), np.cos(q)
    assert np.allclose(arm.inverse_dynamics_from_sin_cos(sin, cos, q, q, q), arm.inverse_dynamics(q, q, q))
    sin[1, 1] += 0.1
    with pytest.raises(ValueError, match="state 2 of 2: `sin` and `cos` are .* for joint 2, but the sum of their squares"):
        arm.inverse_dynamics_from_sin_cos(sin, cos, q, q, q)


def test_every_function_takes_its_keywords_and_no_others():
    """`payload` where there is a function with a payload, `wrenches` where there are wrenches, `rotors` never."""
    names = {method for method, *_ in SATELLITE._functions()}
    for method, _, operands, _ in SATELLITE._functions():
        if method == "forward_dynamics_in_contact":
            continue
        has_payload = f"{method}_with_payload" in names and "wrenches" not in dict(operands)
        taken = {name for name, _ in operands} | ({"payload"} if has_payload else set())
        for keyword, value in {"payload": rne.payload(1.0), "wrenches": np.zeros((1, 6)), "rotors": True, "step": 0.01,
                               "wrench": np.zeros(6), "pose": TURNED, "base_rotation": TURNED[:3, :3]}.items():
            given = {**arguments(operands), keyword: value}
            if keyword in taken:
                getattr(SATELLITE, method)(**given)
            else:
                with pytest.raises(TypeError, match="unexpected keyword argument"):
                    getattr(SATELLITE, method)(**given)


def test_a_robot_without_contacts_has_no_motion_in_contact():
    joints = np.zeros(2)
    with pytest.raises(ValueError, match="the robot file has no `contacts`.*kind: point"):
        SATELLITE.forward_dynamics_in_contact(joints, joints, joints, np.zeros(3), np.eye(3))


def test_quaternions_have_the_length_one():
    rng = np.random.default_rng(57)
    turn = rng.normal(size=(5, 4))
    turn /= np.linalg.norm(turn, axis=1)[:, None]
    q = np.hstack([rng.normal(size=(5, 3)), turn, rng.normal(size=(5, 2))])
    v, a = rng.normal(size=(2, 5, 8))
    derivatives, mass = [np.zeros((8, 2)), np.zeros((8, 2)), np.zeros((8, 3))], np.eye(8)
    down = {"gravity": (0.0, 0.0, -9.81)}
    doors = {
        "x y z w": [lambda q: rne.base_from_pinocchio(q, v, a, **down),
                    lambda q: rne.base_from_pinocchio(q[0], v[0], a[0], **down),
                    lambda q: rne.derivatives_to_pinocchio(derivatives, mass, q[0], v[0], **down)],
        "w x y z": [lambda q: rne.base_from_mujoco(q, v, a, **down),
                    lambda q: rne.base_from_mujoco(q[0], v[0], a[0], **down)],
    }
    for order, calls in doors.items():
        for call in calls:
            call(q)
            call(q * np.array([1, 1, 1, 1.0009, 1.0009, 1.0009, 1.0009, 1, 1]))
            for scale in (0.0, 0.99, 1.002, 2.0):
                wrong = q.copy()
                wrong[0, 3:7] *= scale
                with pytest.raises(ValueError, match=f"must have the length 1.*{order}"):
                    call(wrong)
    for call in (lambda: rne.base_from_pinocchio(q[:, :6], v, a, **down), lambda: rne.base_from_mujoco(q[:, :6], v, a, **down)):
        with pytest.raises(ValueError, match="`q(pos)?` has the shape"):
            call()


def test_a_rotation_of_a_unit_is_a_rotation():
    zeros = np.zeros(3)
    for pose in POSES:
        with pytest.raises(ValueError, match="`rotation` is no rotation"):
            rne.base_from_imu(zeros, zeros, zeros, rotation=pose[:3, :3])


def test_a_payload_is_a_body():
    rne.payload(1.0, inertia=np.diag([0.0, 0.1, 0.1]))
    for inertia in (-np.eye(3), np.diag([0.1, 0.1, -0.001]), [[0.1, 0.2, 0], [0.2, 0.1, 0], [0, 0, 0.1]]):
        with pytest.raises(ValueError, match="no body has less than 0"):
            rne.payload(1.0, inertia=inertia)


def test_what_a_rotor_resists_has_accelerations():
    """A base without mass and one leg, which a rotor resists: M q̈ is solved by numpy."""
    text = """
format: 2
name: hopper
source: own
convention: modified
gravity: [0, 0, -9.81]
floating_base: {name: trunk, link: {mass: 0}}
joints:
  - {name: hip, type: revolute, dh: {theta: 0, d: 0, a: 0.2, alpha: 0.7}, motor: {gear_ratio: 10, inertia: 0.01},
     link: {mass: 2, com: [0.1, 0, 0.3], inertia: {xx: 0.5, yy: 0.8, zz: 0.7}}}
"""
    resisted = rne.load(text, rotors=True)
    state = [[0.3], [0.2], [0.5], [0.1, -0.2, 0.3]]
    base, qdd = resisted.floating_forward_dynamics(*state)
    bias = resisted.floating_bias(state[0], state[1], state[3])
    expected = np.linalg.solve(resisted.floating_mass_matrix(state[0]), np.concatenate([np.zeros(6), state[2]]) - bias)
    np.testing.assert_allclose(np.concatenate([base, qdd]), expected, rtol=1e-9)


def test_several_tips_of_a_whole_robot():
    arm_of = lambda side: (
        f"<joint name='{side}' type='revolute'><parent link='root'/><child link='{side}_arm'/><axis xyz='0 0 1'/>"
        f"<limit lower='-1' upper='1' effort='9' velocity='9'/></joint><link name='{side}_arm'><inertial>"
        "<mass value='5'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link>"
    )
    urdf = f"<robot name='two'><link name='root'/>{arm_of('left')}{arm_of('right')}</robot>"
    arm = rne.load(urdf, whole=True, tip=["left_arm", "right_arm"])
    assert arm.tips == ["left_arm", "right_arm"]
    assert rne.load(urdf, tip=["left_arm"]).joints == ["left"]
    with pytest.raises(ValueError, match="whole=True"):
        rne.load(urdf, tip=["left_arm", "right_arm"])
