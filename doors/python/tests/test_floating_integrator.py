"""Runge-Kutta steps on a floating base beside another integrator, and their models beside difference quotients."""

from pathlib import Path

import numpy as np
import pytest
from test_floating import ARM, SATELLITE, TWIST, close, poses, q, qd, rotation_of, tau, times

import rne

N, DOF = q.shape
FOLDER = Path(__file__).parents[3] / "tests/functions/floating"
POSE = poses()
GIVEN = (q, qd, tau, POSE, TWIST)
TIP = np.random.default_rng(9).normal(size=(N, 1, 6))


def of_state(state, arguments=GIVEN):
    return [argument[state] for argument in arguments]


def slopes(arm, state, tau, wrenches):
    """Rates of the rotation matrix, the origin and its velocity in world axes, the angular velocity, and the joints."""
    rotation, _, velocity, omega, q, qd = state
    base, qdd = arm.floating_forward_dynamics(q, qd, tau, omega, wrenches)
    cross = np.cross(omega[:, None, :], np.eye(3)).transpose(0, 2, 1)
    in_world = times(rotation, base[:, :3]) + np.array(arm.gravity)
    return rotation @ cross, velocity, in_world, base[:, 3:], qd, qdd


def integrated(arm, given, duration, wrenches, steps):
    """The state after short steps of the method of a textbook, on the elements of the rotation matrix."""
    q, qd, tau, pose, twist = given
    rotation = pose[:, :3, :3]
    state = [rotation, pose[:, :3, 3], times(rotation, twist[:, :3]), twist[:, 3:], q, qd]
    h = duration / steps
    for _ in range(steps):
        moved = lambda by, h: [x + h * rate for x, rate in zip(state, by)]
        first = slopes(arm, state, tau, wrenches)
        second = slopes(arm, moved(first, h / 2), tau, wrenches)
        third = slopes(arm, moved(second, h / 2), tau, wrenches)
        fourth = slopes(arm, moved(third, h), tau, wrenches)
        rates = [a + 2 * b + 2 * c + d for a, b, c, d in zip(first, second, third, fourth)]
        state = moved(rates, h / 6)
    rotation, origin, velocity, omega, q, qd = state
    pose = np.tile(np.eye(4), (len(q), 1, 1))
    pose[:, :3, :3], pose[:, :3, 3] = rotation, origin
    return pose, np.concatenate([times(rotation.transpose(0, 2, 1), velocity), omega], 1), q, qd


def test_the_error_of_steps_is_of_fourth_order():
    exact = integrated(ARM, GIVEN, 0.2, TIP, 2000)
    errors = []
    for steps in (10, 20, 40):
        found = ARM.floating_runge_kutta_step(*GIVEN, 0.2 / steps, TIP, steps=steps)
        errors.append([np.abs(one - other).max() for one, other in zip(found, exact)])
        rotation = found[0][:, :3, :3]
        assert np.abs(rotation.transpose(0, 2, 1) @ rotation - np.eye(3)).max() < 1e-14
        assert np.array_equal(found[0][:, 3], np.tile([0, 0, 0, 1], (N, 1)))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.abs(orders - 4).max() < 0.3 and np.max(errors[-1]) < 1e-6, (orders, errors)


#: After a step of 0.1 s with a wrench at the tip, by `floating_runge_kutta_step` in Rust: rows of the rotation, origin,
#: twist, q and qd; and the products of A and of B with 1, 2, 3, ….
OF_RUST = [
    -0.07073734990228742, -0.9962160414418301, 0.050495802823313896, 0.08806317942582631, 0.04418795551055221,
    0.9951343130538772, -0.9936000723420947, 0.07483998504654515, 0.08460421313396171, 0.13451088129128863,
    -0.18944697963268248, 0.2146532773710666, 1.2718365274064642, -0.48600625105216433, -0.07964815531546476,
    0.4499534097761446, -0.8293087621171802, 0.7603142167070783, 0.36938152741331975, -0.9135577390373163,
    0.7830449460163171, -1.1463100540788165,
], [
    2.7188266143516793, 3.156877779226729, 3.4205621903815797, 6.100593368609199, 6.240624769810679,
    6.762172705685849, 8.416754909048098, 9.511186117420584, 10.365689039872654, 2.0239294095651355,
    17.145819671762332, 10.703133561978865, 13.126574636963525, 15.296558324997385, 13.282882508665173,
    14.146893852543247,
], [
    -0.00012625503756112278, 4.583593593990785e-06, 2.5751163053147743e-05, 1.3411090336544303e-05,
    -0.00016925839193342748, -2.738673225785774e-05, -0.0025915441379826877, 0.011745187299165792,
    -0.0026055858485165588, 6.767965772233928e-05, 0.00019670427935367845, 0.0005561362126838268,
    -0.0036398478053509126, -0.0009134090193915977, -0.05097660416980877, 0.22783795546673127,
]


def test_numbers_are_those_of_rust():
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = [[0, -1, 0], [0, 0, 1], [-1, 0, 0]], [0.1, -0.2, 0.3]
    given = [0.3, -0.8], [0.6, -1.1], [5.0, -2.0], pose, [0.4, -0.3, 0.2, 0.5, -0.9, 0.7], 0.1, [[1, -2, 3, 0.1, 0.2, -0.3]]
    after, *numbers = ARM.floating_runge_kutta_step(*given)
    found = np.concatenate([after[:3, :3].ravel(), after[:3, 3], *numbers])
    a, b = ARM.floating_runge_kutta_step_derivatives(*given)
    for one, other in zip((found, a @ np.arange(1, 17), b @ np.arange(1, 3)), OF_RUST):
        assert np.abs(one - other).max() < 1e-13 * np.abs(other).max()


def changed(arguments, change, dof):
    """A state and torques after a change in the tangent space."""
    q, qd, tau, pose, twist = arguments
    shift, turn, of_q, of_twist, of_qd, of_tau = np.split(change, np.cumsum([3, 3, dof, 6, dof]))
    moved = np.eye(4)
    moved[:3, :3], moved[:3, 3] = pose[:3, :3] @ rotation_of(turn), pose[:3, 3] + pose[:3, :3] @ shift
    return q + of_q, qd + of_qd, tau + of_tau, moved, twist + of_twist


def are_difference_quotients(arm, model, arguments, *others, **keywords):
    """Compares A and B of a state with central differences on the manifold."""
    dof, small = arm.dof, 1e-5
    after = lambda change: arm.floating_runge_kutta_step(*changed(arguments, change, dof), *others, **keywords)
    model = np.concatenate(model, axis=-1)
    back = after(np.zeros(12 + 3 * dof))[0][:3, :3].T
    for column, unit in enumerate(np.eye(12 + 3 * dof)):
        (pose_after, *after_it), (pose_before, *before_it) = after(small * unit), after(-small * unit)
        turn, shift = back @ (pose_after - pose_before)[:3, :3], back @ (pose_after - pose_before)[:3, 3]
        twist, of_q, of_qd = (x - y for x, y in zip(after_it, before_it))
        change = np.concatenate([shift, [turn[2, 1], turn[0, 2], turn[1, 0]], of_q, twist, of_qd]) / (2 * small)
        np.testing.assert_allclose(change, model[:, column], atol=1e-8 * np.abs(model).max())


@pytest.mark.parametrize("steps", [1, 3])
def test_derivatives_are_difference_quotients(steps):
    step = 0.1
    a, b = ARM.floating_runge_kutta_step_derivatives(*GIVEN, step, TIP, steps=steps)
    assert a.shape == (N, 12 + 2 * DOF, 12 + 2 * DOF) and b.shape == (N, 12 + 2 * DOF, DOF)
    for state in (0, 1, N - 1):
        model, arguments = (a[state], b[state]), of_state(state)
        are_difference_quotients(ARM, model, arguments, step, TIP[state], steps=steps)


@pytest.mark.filterwarnings("ignore::rne.RobotFileWarning")
def test_derivatives_of_a_robot_with_four_legs_are_difference_quotients():
    arm = rne.load(FOLDER / "grid_hyq.yaml")
    random = np.random.default_rng(3)
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = rotation_of(random.normal(size=3)), random.normal(size=3)
    arguments = [*random.normal(size=(3, arm.dof)), pose, random.normal(size=6)]
    wrenches = {"lf_lowerleg": [1.0, -2.0, 30.0, 0.1, 0.2, 0.3]}
    model = arm.floating_runge_kutta_step_derivatives(*arguments, 0.02, wrenches)
    are_difference_quotients(arm, model, arguments, 0.02, wrenches)
    # a base at rest, whose turn is smooth there
    arguments[-1] = np.zeros(6)
    are_difference_quotients(arm, arm.floating_runge_kutta_step_derivatives(*arguments, 0.02), arguments, 0.02)


def test_a_state_alone_is_the_same_among_many():
    durations = np.linspace(0.01, 0.02, N)
    for function in (ARM.floating_runge_kutta_step, ARM.floating_runge_kutta_step_derivatives):
        many = function(*GIVEN, durations, TIP, steps=2)
        for state in (0, N - 1):
            alone = function(*of_state(state), durations[state], TIP[state], steps=2)
            for one, all_of_them in zip(alone, many, strict=True):
                assert one.shape == all_of_them.shape[1:]
                close(one, all_of_them[state])
        # each argument alone may be that of many states
        first = [*of_state(0), durations[0], TIP[0]]
        for place, argument in enumerate([*GIVEN, durations, TIP]):
            found = function(*[argument if at == place else one for at, one in enumerate(first)])
            expected = function(*[argument[3] if at == place else one for at, one in enumerate(first)])
            for all_of_them, one in zip(found, expected, strict=True):
                assert all_of_them.shape == (N, *one.shape), place
                close(all_of_them[3], one)
        singles = [np.float32(argument) for argument in GIVEN]
        for single, double in zip(function(*singles, 0.01), function(*GIVEN, 0.01), strict=True):
            assert single.dtype == np.float32 and np.abs(single - double).max() < 1e-4


def test_names_and_a_step_of_duration_zero():
    by_name = [dict(zip(ARM.joints, argument[0])) for argument in (q, qd, tau)]
    expected = ARM.floating_runge_kutta_step(*of_state(0), 0.01)
    for one, other in zip(ARM.floating_runge_kutta_step(*by_name, POSE[0], TWIST[0], 0.01), expected):
        assert np.array_equal(one, other)
    for function in (ARM.floating_runge_kutta_step, ARM.floating_runge_kutta_step_derivatives):
        with pytest.raises(rne.EvaluationError, match="the step is 0 s, but it must be a finite number above 0"):
            function(*GIVEN, 0.0)


def test_mistakes_are_told():
    given = of_state(0)
    for function in (ARM.floating_runge_kutta_step, ARM.floating_runge_kutta_step_derivatives):
        with pytest.raises(ValueError, match="`steps` is 0"):
            function(*given, 0.01, steps=0)
        with pytest.raises(TypeError, match="`step` is not a real number"):
            function(*given, "long")
        with pytest.raises(ValueError, match=r"`pose`: a pose has the shape \(4, 4\) or \(N, 4, 4\), not \(3, 4\)"):
            function(*given[:3], np.eye(4)[:3], TWIST[0], 0.01)
        with pytest.raises(ValueError, match=r"`twist` has the shape \(3,\); it is \(6,\) for one state"):
            function(*given[:4], [0.0] * 3, 0.01)
        with pytest.raises(ValueError, match=rf"`twist` has 4 states, but other arguments have {N}"):
            function(*GIVEN[:4], TWIST[:4], 0.01)
        with pytest.raises(ValueError, match="`tau`: there are masked elements"):
            function(*given[:2], np.ma.masked_array(given[2], mask=[True, False]), *given[3:], 0.01)
        with pytest.raises(ValueError, match=f"`wrenches` has 3 states, but other arguments have {N}"):
            function(*GIVEN, 0.01, np.zeros((3, 1, 6)))
    nothing = "link: {mass: 0, com: [0, 0, 0], inertia: {xx: 0, yy: 0, zz: 0}}"
    weightless = rne.load(SATELLITE.replace("link: {mass: 6, com: [0.4, 0, 0], inertia: {xx: 0.01, yy: 0.5, zz: 0.5}}", nothing))
    with pytest.raises(ValueError, match="the mass matrix is singular in one of the states"):
        weightless.floating_runge_kutta_step_derivatives(*given, 0.01)


def test_functions_of_a_floating_base_need_one():
    """At every door of Python; a file that holds the base does not say its mass."""
    arm, floats = rne.robots.planar2, rne.load(SATELLITE)
    assert (arm.floating, floats.floating) == (False, True)
    assert "floating base" in repr(floats) and "floating base" not in repr(arm)
    words = "the file of planar2 has no `floating_base`.*floating=True"
    q, qd, qdd = joints = ([0, 0], [0, 0], [0, 0])
    omega, twist, pose, turn = [0] * 3, [0] * 6, np.eye(4), np.eye(3)
    for names, arguments in [
        ("floating_mass_matrix centroidal_momentum_matrix", (q,)),
        ("floating_bias centroidal_bias", (q, qd, omega)),
        ("floating_kinetic_energy centroidal_momentum", (q, qd, twist)),
        ("floating_potential_energy", (q, pose)),
        ("inverse_dynamics_of_floating_base floating_regressor floating_inverse_dynamics_derivatives", joints),
        ("floating_forward_dynamics", (*joints, omega)),
        ("tip_jacobians", (q, turn)),
        ("tip_accelerations", (q, qd, omega, turn)),
        ("forward_dynamics_in_contact", (*joints, omega, turn)),
        ("floating_euler_step floating_euler_step_derivatives", (*joints, pose, twist, 0.01)),
        ("floating_runge_kutta_step floating_runge_kutta_step_derivatives", (*joints, pose, twist, 0.01)),
    ]:
        for name in names.split():
            with pytest.raises(ValueError, match=words):
                getattr(arm, name)(*arguments)
    with pytest.raises(ValueError, match=words):
        arm.code(functions=["floating_mass_matrix"])


def test_a_matrix_that_is_no_pose_is_refused():
    twice, mirrored, row = (np.eye(4) for _ in range(3))
    twice[:3, :3] *= 2
    mirrored[2, 2] = -1
    row[3, 0] = 1
    for pose, words in ((twice, "no rigid pose"), (mirrored, "right-handed"), (row, "last row")):
        for name in ("floating_euler_step", "floating_runge_kutta_step", "floating_runge_kutta_step_derivatives"):
            with pytest.raises(ValueError, match=words):
                getattr(ARM, name)(*of_state(0)[:3], pose, TWIST[0], 0.01)
    unknown = np.where(np.eye(4) == 1, np.nan, 0)
    unknown[3, 3] = 1
    assert np.isnan(ARM.floating_runge_kutta_step(*of_state(0)[:3], unknown, TWIST[0], 0.01)[0]).any()
