"""Laws that tie the functions of a robot on a floating base together, of one state and of many."""

import json
from pathlib import Path

import numpy as np
import pytest

import rne

N = 20
ROOT = Path(__file__).parents[3]
FOLDER = ROOT / "tests/functions/floating"
SATELLITE = (ROOT / "docs/satellite.yaml").read_text()
ARM = rne.load(SATELLITE.replace("gravity: [0, 0, 0]", "gravity: [1, -2, -9]"))
random = np.random.default_rng(8)
q, qd, qdd, tau = random.normal(size=(4, N, ARM.dof))
velocity, omega, omega_dot, acceleration = random.normal(size=(4, N, 3))
TWIST = np.concatenate([velocity, omega], axis=1)
V = np.concatenate([TWIST, qd], axis=1)
MOTION = {"base_omega": omega, "base_omega_dot": omega_dot, "base_acceleration": acceleration}
BASE = {**MOTION, "base_gravity": np.zeros(3)}


def close(a, b):
    assert np.abs(a - b).max() <= 1e-12 * np.abs(b).max()


def times(matrices, vectors):
    return np.einsum("nij,nj->ni", matrices, vectors)


def poses():
    pose = np.tile(np.eye(4), (N, 1, 1))
    turn = np.linalg.qr(random.normal(size=(N, 3, 3)))[0]
    pose[:, :3, :3] = turn * np.linalg.det(turn)[:, None, None]
    pose[:, :3, 3] = random.normal(size=(N, 3))
    return pose


def test_dynamics_are_one_equation():
    mass, bias = ARM.floating_mass_matrix(q), ARM.floating_bias(q, qd, omega)
    forces = np.concatenate(ARM.inverse_dynamics_of_floating_base(q, qd, qdd, **BASE), axis=1)
    close(forces, times(mass, np.concatenate([acceleration, omega_dot, qdd], axis=1)) + bias)
    found = np.concatenate(ARM.floating_forward_dynamics(q, qd, tau, omega), axis=1)
    close(times(mass, found) + bias, np.concatenate([np.zeros((N, 6)), tau], axis=1))


def test_derivatives_are_differences():
    # steps of polynomials of second degree are exact, those of positions are small
    derivatives = ARM.floating_inverse_dynamics_derivatives(q, qd, qdd, **BASE)
    assert [part.shape for part in derivatives] == [(N, 6 + ARM.dof, columns) for columns in (ARM.dof, ARM.dof, 3)]
    forces = lambda q, qd, omega: np.concatenate(
        ARM.inverse_dynamics_of_floating_base(q, qd, qdd, **{**BASE, "base_omega": omega}), axis=1)
    for part, step, tolerance in [(0, 1e-6, 1e-8), (1, 1.0, 1e-12), (2, 1.0, 1e-12)]:
        given = [q, qd, omega]
        for column in range(given[part].shape[1]):
            unit = step * np.eye(given[part].shape[1])[column]
            after, before = (forces(*given[:part], given[part] + sign * unit, *given[part + 1:]) for sign in (1, -1))
            expected = (after - before) / (2 * step)
            assert np.abs(derivatives[part][:, :, column] - expected).max() <= tolerance * np.abs(after).max()
    one = ARM.floating_inverse_dynamics_derivatives(q[0], qd[0], qdd[0], **{key: value[0] if value.ndim == 2 else value
                                                                           for key, value in BASE.items()})
    assert all(np.array_equal(alone, many[0]) for alone, many in zip(one, derivatives))


def test_derivatives_are_those_of_pinocchio_by_the_tangent():
    golden = json.loads((FOLDER / "grid_hyq.golden.json").read_text())["states"][0]
    state = {key: np.array(value) for key, value in golden.items()}
    arm = rne.load(FOLDER / "grid_hyq.yaml")
    rotation = state["base_rotation"].reshape(3, 3)
    w = np.sqrt(1 + np.trace(rotation)) / 2
    axis = np.array([rotation[k, j] - rotation[j, k] for j, k in [(1, 2), (2, 0), (0, 1)]]) / (4 * w)
    base = {f"base_{key}": state[key] for key in ("omega", "omega_dot", "acceleration", "gravity")}
    derivatives = arm.floating_inverse_dynamics_derivatives(
        state["q"], state["qd"], state["qdd"], state["wrenches"].reshape(-1, 6), **base)
    full, v = np.array([0, 0, 0, *axis, w]), np.concatenate([state["velocity"], state["omega"]])
    mass = arm.floating_mass_matrix(state["q"])
    found = rne.derivatives_to_pinocchio(derivatives, mass, full, v, gravity=[0, 0, -9.81])
    close(np.concatenate([part.ravel() for part in found]), state["derivatives_of_pinocchio"])


def test_the_regressor_gives_the_forces():
    columns = ARM.floating_regressor(q, qd, qdd, **BASE)
    parameters = ARM.floating_inertial_parameters()
    assert columns.shape == (N, 6 + ARM.dof, 10 * (ARM.dof + 1)) and parameters.shape == (ARM.dof + 1, 10)
    assert np.array_equal(parameters[1:], ARM.inertial_parameters())
    forces = np.concatenate(ARM.inverse_dynamics_of_floating_base(q, qd, qdd, **BASE), axis=1)
    close(columns @ parameters.ravel(), forces)


def test_energies_and_momentum_are_those_of_the_matrices():
    close(ARM.floating_kinetic_energy(q, qd, TWIST), (V * times(ARM.floating_mass_matrix(q), V)).sum(axis=1) / 2)
    close(ARM.centroidal_momentum(q, qd, TWIST), times(ARM.centroidal_momentum_matrix(q), V))
    # its rate, where only velocities count: a base that does not accelerate, less gravity
    step = 1e-6
    turned = [ARM.centroidal_momentum(q + h * qd, qd, np.concatenate([velocity, omega], axis=1)) for h in (step, -step)]
    rate = (turned[0] - turned[1]) / (2 * step)
    momentum = ARM.centroidal_momentum(q, qd, TWIST)
    rate += np.concatenate([np.cross(omega, momentum[:, :3]), np.cross(omega, momentum[:, 3:])], axis=1)
    # the velocity of a base that turns is constant in its axes, so that its origin accelerates by ω × v
    mass = ARM.floating_mass_matrix(q)[:, 0, 0]
    rate[:, :3] -= mass[:, None] * np.cross(omega, velocity)
    expected = ARM.centroidal_bias(q, qd, omega)
    assert np.abs(rate - expected).max() <= 1e-7 * np.abs(expected).max()


def test_potential_energy_is_that_of_the_pose():
    close(ARM.floating_potential_energy(q, np.eye(4)), ARM.potential_energy(q))
    pose = poses()
    found = ARM.floating_potential_energy(q, pose)
    centre = np.einsum("nij,nj->ni", pose[:, :3, :3], ARM.centre_of_mass(q)) + pose[:, :3, 3]
    weight = ARM.floating_mass_matrix(q)[:, 0, 0, None] * ARM.gravity
    assert np.abs(found + (weight * centre).sum(axis=1)).max() <= 1e-12 * max(np.abs(found).max(), 1)
    with pytest.raises(ValueError, match=r"`pose`: a pose has the shape \(4, 4\) or \(N, 4, 4\), not \(3, 4\)"):
        ARM.floating_potential_energy(q, np.eye(4)[:3])


def test_a_state_alone_is_the_same_among_many():
    pose = poses()
    for function, arguments, shape in [
        ("floating_mass_matrix", (q,), (6 + ARM.dof, 6 + ARM.dof)),
        ("floating_bias", (q, qd, omega), (6 + ARM.dof,)),
        ("centroidal_momentum_matrix", (q,), (6, 6 + ARM.dof)),
        ("centroidal_bias", (q, qd, omega), (6,)),
        ("centroidal_momentum", (q, qd, TWIST), (6,)),
        ("floating_regressor", (q, qd, qdd), (6 + ARM.dof, 10 * (ARM.dof + 1))),
        ("floating_kinetic_energy", (q, qd, TWIST), ()),
        ("floating_potential_energy", (q, pose), ()),
    ]:
        many = getattr(ARM, function)(*arguments)
        assert many.shape == (N, *shape), function
        for state in (0, N - 1):
            one = getattr(ARM, function)(*(argument[state] for argument in arguments))
            assert np.shape(one) == shape and np.array_equal(one, many[state]), function


def test_a_step_moves_the_base_by_its_velocities():
    pose, step = poses(), 0.01
    # rotations
    pose[:, :3, :3] *= np.linalg.det(pose[:, :3, :3])[:, None, None]
    given = (q, qd, tau, pose, TWIST, step)
    found, twist, positions, rates = ARM.floating_euler_step(*given)
    base, accelerations = ARM.floating_forward_dynamics(q, qd, tau, omega)
    rotation, next_rotation = pose[:, :3, :3], found[:, :3, :3]
    in_world = times(rotation, velocity + step * base[:, :3]) + step * np.array(ARM.gravity)
    close(times(next_rotation, twist[:, :3]), in_world)
    close(found[:, :3, 3], pose[:, :3, 3] + step * in_world)
    assert np.array_equal(found[:, 3], np.tile([0, 0, 0, 1], (N, 1)))
    turning = omega + step * base[:, 3:]
    close(twist[:, 3:], turning)
    # Rodrigues
    axis = turning / np.linalg.norm(turning, axis=1)[:, None]
    angle = 4 * np.arctan(step * np.linalg.norm(turning, axis=1) / 4)[:, None, None]
    cross = np.cross(axis[:, None, :], np.eye(3)).transpose(0, 2, 1)
    turn = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    close(next_rotation, rotation @ turn)
    close(rates, qd + step * accelerations)
    close(positions, q + step * rates)
    numbers = np.empty((N, 18 + 2 * ARM.dof))
    ARM.floating_euler_step(*given, out=numbers)
    flat = [next_rotation.reshape(N, 9), found[:, :3, 3], twist, positions, rates]
    assert np.array_equal(numbers, np.concatenate(flat, axis=1))
    alone = ARM.floating_euler_step(q[3], qd[3], tau[3], pose[3], TWIST[3], step, None)
    for part, many in zip(alone, (found, twist, positions, rates)):
        assert part.shape == many.shape[1:] and np.array_equal(part, many[3])


def rotation_of(vector):
    angle = np.linalg.norm(vector)
    x, y, z = vector / angle if angle else vector
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def test_derivatives_of_a_step_are_difference_quotients():
    n, step, small = ARM.dof, 0.01, 1e-5
    pose = poses()
    pose[:, :3, :3] *= np.linalg.det(pose[:, :3, :3])[:, None, None]
    a, b = ARM.floating_euler_step_derivatives(q, qd, tau, pose, TWIST, step)
    assert a.shape == (N, 12 + 2 * n, 12 + 2 * n) and b.shape == (N, 12 + 2 * n, n)
    model, state = np.concatenate([a, b], axis=2), 2
    rotation, origin = pose[state, :3, :3], pose[state, :3, 3]

    def after(change):
        shift, turn, of_q, of_twist, of_qd, of_tau = np.split(change, np.cumsum([3, 3, n, 6, n]))
        moved = np.eye(4)
        moved[:3, :3], moved[:3, 3] = rotation @ rotation_of(turn), origin + rotation @ shift
        return ARM.floating_euler_step(
            q[state] + of_q, qd[state] + of_qd, tau[state] + of_tau, moved, TWIST[state] + of_twist, step)

    back = after(np.zeros(12 + 3 * n))[0][:3, :3].T
    for column, unit in enumerate(np.eye(12 + 3 * n)):
        (pose_after, *after_it), (pose_before, *before_it) = after(small * unit), after(-small * unit)
        turn = back @ (pose_after - pose_before)[:3, :3]
        shift = back @ (pose_after - pose_before)[:3, 3]
        twist, of_q, of_qd = (x - y for x, y in zip(after_it, before_it))
        change = np.concatenate([shift, [turn[2, 1], turn[0, 2], turn[1, 0]], of_q, twist, of_qd]) / (2 * small)
        np.testing.assert_allclose(change, model[state, :, column], atol=1e-6 * np.abs(model[state]).max())
    alone = ARM.floating_euler_step_derivatives(q[state], qd[state], tau[state], pose[state], TWIST[state], step, None)
    assert np.array_equal(alone[0], a[state]) and np.array_equal(alone[1], b[state])
