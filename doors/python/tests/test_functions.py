"""Laws that tie the functions together, and the shapes of their results."""

from pathlib import Path

import numpy as np
import pytest

import rne

N = 40


def close(a, b):
    """Equal to 1e-12 of the largest number."""
    assert np.abs(a - b).max() <= 1e-12 * max(np.abs(b).max(), 1e-9)


random = np.random.default_rng(5)

SHAPES = {
    "inverse_dynamics": ("q qd qdd", lambda n: (n,)),
    "gravity_torques": ("q", lambda n: (n,)),
    "bias_torques": ("q qd", lambda n: (n,)),
    "mass_matrix": ("q", lambda n: (n, n)),
    "inverse_mass_matrix": ("q", lambda n: (n, n)),
    "coriolis_matrix": ("q qd", lambda n: (n, n)),
    "coriolis_torques": ("q qd", lambda n: (n,)),
    "forward_dynamics": ("q qd tau", lambda n: (n,)),
    "forward_kinematics": ("q", lambda n: (4, 4)),
    "link_poses": ("q", lambda n: (n, 4, 4)),
    "jacobian": ("q", lambda n: (6, n)),
    "jacobian_rate_times_velocity": ("q qd", lambda n: (6,)),
    "kinetic_energy": ("q qd", lambda n: ()),
    "potential_energy": ("q", lambda n: ()),
    "centre_of_mass": ("q", lambda n: (3,)),
    "centre_of_mass_jacobian": ("q", lambda n: (3, n)),
    "regressor": ("q qd qdd", lambda n: (n, 10 * n)),
    "joint_wrenches": ("q qd qdd", lambda n: (n, 6)),
    "actuator_torques": ("qd qdd", lambda n: (n,)),
}


def states(n):
    return dict(zip(("q", "qd", "qdd", "tau"), random.normal(size=(4, N, n))))


@pytest.mark.parametrize("name", list(rne.robots))
def test_a_state_alone_is_the_same_among_many(name):
    arm = rne.robots[name]
    given = states(arm.dof)
    for function, (arguments, shape) in SHAPES.items():
        if function.endswith("regressor") and arm.followers:
            continue
        arguments = [given[argument] for argument in arguments.split()]
        many = getattr(arm, function)(*arguments)
        assert many.shape == (N, *shape(arm.dof)), function
        for state in (0, 17, N - 1):
            one = getattr(arm, function)(*(argument[state] for argument in arguments))
            assert np.shape(one) == shape(arm.dof), function
            assert np.array_equal(one, many[state], equal_nan=True), function
    derivatives = arm.inverse_dynamics_derivatives(given["q"], given["qd"], given["qdd"])
    assert [part.shape for part in derivatives] == [(N, arm.dof, arm.dof)] * 2
    momenta = arm.momentum_and_rate(given["q"], given["qd"], given["tau"])
    assert [part.shape for part in momenta] == [(N, arm.dof)] * 2
    one = arm.momentum_and_rate(given["q"][0], given["qd"][0], given["tau"][0])
    assert [part.shape for part in one] == [(arm.dof,)] * 2


# the regressor is that of the links: neither followers nor rotors on links are in it
@pytest.mark.parametrize("name", [name for name in rne.robots if "\nformat: 1" in rne.robots[name].yaml])
def test_laws(name):
    arm = rne.robots[name]
    given = states(arm.dof)
    q, qd, qdd = given["q"], given["qd"], given["qdd"]
    tau = arm.inverse_dynamics(q, qd, qdd)
    scale = np.abs(tau).max()
    mass = arm.mass_matrix(q)
    condition = np.linalg.cond(mass)
    regular = condition < 1e10
    expected, inverse = np.linalg.inv(mass[regular]), arm.inverse_mass_matrix(q)[regular]
    error = np.abs(inverse - expected).max((1, 2)) / np.abs(expected).max((1, 2))
    assert regular.any() and (error <= 1e-13 * condition[regular]).all()
    momentum, rate = arm.momentum_and_rate(q, qd, tau)
    size = np.abs(mass).max() * np.abs(qd).max()
    assert np.allclose(momentum, np.einsum("nij,nj->ni", mass, qd), rtol=0, atol=1e-12 * size)
    turned = np.einsum("nji,nj->ni", arm.coriolis_matrix(q, qd), qd)
    assert np.allclose(rate, tau + turned - arm.gravity_torques(q), rtol=0, atol=1e-11 * scale)

    def close(a, b, on=scale):
        assert np.abs(a - b).max() <= 1e-12 * max(on, 1e-9), name

    close(np.einsum("nij,nj->ni", mass, qdd) + arm.bias_torques(q, qd), tau)
    close(np.einsum("nij,nj->ni", arm.coriolis_matrix(q, qd), qd) + arm.gravity_torques(q), arm.bias_torques(q, qd))
    close(arm.coriolis_torques(q, qd) + arm.gravity_torques(q), arm.bias_torques(q, qd))
    close(arm.regressor(q, qd, qdd) @ arm.inertial_parameters().ravel(), tau)
    close(arm.kinetic_energy(q, qd), 0.5 * np.einsum("ni,nij,nj->n", qd, mass, qd), np.abs(mass).max() * 10)
    close(arm.inverse_dynamics_from_sin_cos(np.sin(q), np.cos(q), q, qd, qdd), tau)
    close(arm.inverse_dynamics_on_moving_base(q, qd, qdd), tau)
    wrench = random.normal(size=(N, 6))
    tip = arm.forward_kinematics(q)[:, :3, :3]
    turned = np.concatenate([np.einsum("nij,nj->ni", tip, part) for part in (wrench[:, :3], wrench[:, 3:])], axis=1)
    close(arm.inverse_dynamics_with_wrench(q, qd, qdd, wrench),
          tau + np.einsum("nij,ni->nj", arm.jacobian(q), turned), scale + 100)
    close(arm.inverse_dynamics_with_payload(q, qd, qdd, rne.payload(0.0)), tau)
    # the parameters that the torques can see
    values = {f"{parameter}_{link + 1}": value for link, row in enumerate(arm.inertial_parameters())
              for parameter, value in zip("m mcx mcy mcz Jxx Jxy Jxz Jyy Jyz Jzz".split(), row)}
    base = arm.base_parameters()
    for parameter in base:
        told = sum(values[name] * factor for name, factor in parameter["combination"].items())
        assert abs(told - parameter["value"]) <= 1e-9 * max(1, abs(told))
    assert len(base) == np.linalg.matrix_rank(arm.regressor(*random.normal(size=(3, 60, arm.dof))).reshape(-1, 10 * arm.dof))


def test_forms_agree():
    reduced = rne.robots.panda
    steps = rne.load(reduced.yaml, form="seven_steps")
    q, qd, qdd = random.normal(size=(3, N, 7))
    assert steps.form == "seven_steps" and reduced.form == "reduced"
    assert np.allclose(steps.inverse_dynamics(q, qd, qdd), reduced.inverse_dynamics(q, qd, qdd), rtol=0, atol=1e-11)
    assert reduced.operations()["total"] < 0.6 * steps.operations()["total"]


def test_rotors_belong_to_the_arm_when_asked():
    bare = rne.robots.puma560
    whole = rne.load(bare.yaml, rotors=True)
    q = random.normal(size=6)
    added = whole.mass_matrix(q) - bare.mass_matrix(q)
    assert np.allclose(added, np.diag(np.diag(added)), atol=1e-12) and (np.diag(added) > 0).all()


def test_parameters_stay_free():
    text = """
format: 1
name: rod
source: own
convention: standard
gravity: [0, -9.81, 0]
parameters: {m: 2.0}
joints: [{type: revolute, dh: {theta: 0, d: 0, a: 1, alpha: 0}, link: {mass: m, com: [-0.5, 0, 0]}}]
"""
    arm = rne.load(text, run_time=["m"])
    assert arm.parameters == ["m"]
    q = np.zeros((4, 1))
    masses = np.array([[1.0], [2.0], [3.0], [4.0]])
    assert np.allclose(arm.gravity_torques(q, parameters=masses), 9.81 * 0.5 * masses)
    assert np.allclose(arm.gravity_torques(q), 9.81 * 0.5 * 2)
    assert np.allclose(rne.load(text, settings={"m": 5}).gravity_torques(q), 9.81 * 0.5 * 5)


def test_parameters_have_names():
    text = """
format: 1
name: rod
source: own
convention: standard
gravity: [0, -9.81, 0]
parameters: {m: 2.0, half: 0.5}
joints: [{type: revolute, dh: {theta: 0, d: 0, a: 1, alpha: 0}, link: {mass: m, com: [-half, 0, 0]}}]
"""
    arm = rne.load(text, run_time=["half", "m"])
    q, masses = np.zeros((4, 1)), np.array([1.0, 2.0, 3.0, 4.0])
    of = lambda parameters, q=q: arm.gravity_torques(q, parameters=parameters)
    assert np.allclose(of({"m": 3, "half": 0.5}), 9.81 * 0.5 * 3)
    assert np.array_equal(of({"m": 3, "half": 0.5}), of({"half": 0.5, "m": 3.0}))
    assert np.array_equal(of({"m": 3, "half": 0.5}), of([0.5, 3]))
    assert np.allclose(of({"m": masses, "half": 0.5}), 9.81 * 0.5 * masses[:, None])
    assert np.array_equal(of({"m": masses.tolist(), "half": [0.5]}), of({"m": masses, "half": 0.5}))
    single = {"m": masses.astype("f4"), "half": 0.5}
    assert of(single, q.astype("f4")).dtype == np.float32 == of({"m": 1, "half": 1}, q.astype("f4")).dtype
    for wrong, says in [
        ({"m": 3}, "the value of `half` is missing; this arm has half, m"),
        ({"m": 3, "half": 0.5, "l": 1}, "there is no run-time parameter `l`; this arm has half, m"),
        ({"m": masses, "half": masses[:3]}, "arrays have 3 and 4 states"),
        ({"m": masses[:3], "half": 0.5}, "`parameters` has 3 states, but other arguments have 4"),
        ({"m": "three", "half": 0.5}, "`m` is no real number"),
        ({"m": q, "half": 0.5}, "`m` is no real number and no array"),
        ({"m": np.ma.array(masses, mask=[0, 0, 1, 0]), "half": 0.5}, "`m`: there are masked elements"),
        ("three", "an array of real numbers: write them in the order of `arm.parameters`, or as a dict by their names"),
    ]:
        with pytest.raises((TypeError, ValueError), match=says):
            of(wrong)


LOADED = {
    "inverse_dynamics": ("q", "qd", "qdd"),
    "gravity_torques": ("q",),
    "bias_torques": ("q", "qd"),
    "mass_matrix": ("q",),
    "forward_dynamics": ("q", "qd", "tau"),
    "inverse_dynamics_derivatives": ("q", "qd", "qdd"),
    "momentum_and_rate": ("q", "qd", "tau"),
}


@pytest.mark.parametrize("name", LOADED)
def test_a_payload_of_every_function(name):
    """`payload=` is the function of that name with a payload; a payload of zero is the arm alone."""
    arm = rne.robots.panda
    random = np.random.default_rng(29)
    state = {key: random.uniform(-1.5, 1.5, (5, arm.dof)) for key in ("q", "qd", "qdd", "tau")}
    given = [state[key] for key in LOADED[name]]
    body = rne.payload(1.5, [0.02, -0.03, 0.1], np.diag([0.02, 0.03, 0.04]) + 0.001)
    found = np.asarray(getattr(arm, name)(*given, payload=body))
    assert np.array_equal(found, np.asarray(getattr(arm, f"{name}_with_payload")(*given, np.tile(body, (5, 1)))))
    alone = np.asarray(getattr(arm, name)(*given))
    assert not np.allclose(found, alone)
    close(np.asarray(getattr(arm, name)(*given, payload=rne.payload(0.0))), alone)


def test_equations_of_motion_with_a_payload():
    """M q̈ + bias = τ with the same payload, and q̈ back from τ."""
    arm = rne.robots.puma560
    random = np.random.default_rng(30)
    q, qd, qdd = random.uniform(-1.5, 1.5, (3, 40, arm.dof))
    body = rne.payload(2.0, [0.0, 0.05, 0.1], np.diag([0.02, 0.03, 0.04]))
    tau = arm.inverse_dynamics(q, qd, qdd, payload=body)
    mass, bias = arm.mass_matrix(q, payload=body), arm.bias_torques(q, qd, payload=body)
    close(np.einsum("nij,nj->ni", mass, qdd) + bias, tau)
    np.testing.assert_allclose(arm.forward_dynamics(q, qd, tau, payload=body), qdd, rtol=1e-9, atol=1e-9)


def test_payloads():
    arm = rne.robots.panda
    q, qd, qdd = random.normal(size=(3, N, 7))
    com = random.normal(size=(N, 3))
    of = lambda payload: arm.inverse_dynamics_with_payload(q, qd, qdd, payload)
    points = np.hstack([np.linspace(0, 3, N)[:, None], com])
    whole = np.hstack([points, np.zeros((N, 6))])
    assert np.array_equal(of(points), of(whole))
    assert np.array_equal(of(points[7]), of(rne.payload(points[7, 0], points[7, 1:])))
    assert np.array_equal(of(points.tolist()), of(whole))
    with pytest.raises(ValueError, match=r"shape \(5,\); it is \(10,\) .* 4 numbers in place of 10 are a point mass"):
        of([1.0] * 5)
    points[5, 0] = -0.5
    room = np.full((N, 7), 7.0)
    with pytest.raises(ValueError, match="state 6 of 40: the payload's mass is -0.5 kg: no body has less than 0"):
        arm.inverse_dynamics_with_payload(q, qd, qdd, points, out=room)
    assert (room == 7).all()
    for work in (lambda: of([-2.0] + [0.0] * 9), lambda: rne.payload(-2)):
        with pytest.raises(ValueError, match="the payload's mass is -2 kg: no body has less than 0"):
            work()


@pytest.mark.parametrize("given, error, says", [
    (dict(mass="2"), TypeError, "`mass` is '2', but it must be a number, in kg"),
    (dict(mass=[1.0, 2.0]), ValueError, r"`mass` has the shape \(2,\), but it must be a number, in kg"),
    (dict(mass=np.nan), ValueError, "`mass` is nan, but it must be finite"),
    (dict(mass=1.0, com=[0.0, np.nan, 0.0]), ValueError, r"`com\[1\]` is nan, but it must be finite"),
    (dict(mass=1.0, com="abc"), TypeError, "`com` is 'abc', but it must be three numbers x, y, z, in m"),
    (dict(mass=1.0, com=[0.0, [1.0], 0.0]), TypeError, "`com` is .* three numbers"),
    (dict(mass=1.0, inertia=np.diag([1.0, np.inf, 1.0])), ValueError, r"`inertia\[1, 1\]` is inf"),
    (dict(mass=1.0, inertia=np.zeros(3)), ValueError, r"`inertia` has the shape \(3,\), but it must be a symmetric"),
    (dict(mass=1.0, inertia=np.triu(np.ones((3, 3)))), ValueError, "`inertia` is a symmetric tensor"),
])
def test_what_is_wrong_with_a_payload_is_said(given, error, says):
    with pytest.raises(error, match=says):
        rne.payload(**given)


def test_a_payload_that_is_no_array_says_what_is_allowed():
    zeros = np.zeros(7)
    for payload in ("2", [None] * 10):
        with pytest.raises(TypeError, match="`payload` is not an array of real numbers: it has 10 numbers, .* 4 numbers"):
            rne.robots.panda.gravity_torques(zeros, payload=payload)


def test_limits_of_the_file():
    row = "  - {type: revolute, dh: {theta: 0, d: 0.1, a: 0.3, alpha: 0}, link: {mass: 1, inertia: {zz: 0.1}}"
    head = "format: 1\nname: x\nsource: own\nconvention: standard\ngravity: [0, 0, -9.81]\njoints:\n"
    arm = rne.load(f"{head}{row}, limits: {{position: [-1, 2], velocity: 3, effort: 40}}}}\n{row}}}\n")
    assert np.array_equal(arm.limits, [[-1, 2], [-np.inf, np.inf]])
    assert np.array_equal(arm.velocity_limits, [3, np.inf])
    assert np.array_equal(arm.effort_limits, [40, np.inf])


# Of a base that floats: the arguments, and the parts of the result, whose numbers are those of the base, then the joints.
FLOATING = {
    "inverse_dynamics_of_floating_base": ("q qd qdd", lambda n: [(6,), (n,)]),
    "floating_mass_matrix": ("q", lambda n: [(6 + n, 6 + n)]),
    "floating_bias": ("q qd omega", lambda n: [(6 + n,)]),
    "floating_forward_dynamics": ("q qd tau omega", lambda n: [(6,), (n,)]),
    "centroidal_momentum_matrix": ("q", lambda n: [(6, 6 + n)]),
    "centroidal_bias": ("q qd omega", lambda n: [(6,)]),
}


def cross(vector):
    """The matrix of vector ×."""
    x, y, z = vector
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def floating(arm):
    """The parts of each function of FLOATING at N states, and the states."""
    given = states(arm.dof) | {"omega": random.normal(size=(N, 3))}
    motion = {f"base_{name}": random.normal(size=(N, 3)) for name in ("omega_dot", "acceleration", "gravity")}
    motion["base_omega"] = given["omega"]
    results = {}
    for function, (arguments, shapes) in FLOATING.items():
        more = motion if function == "inverse_dynamics_of_floating_base" else {}
        call = lambda at: getattr(arm, function)(*(given[name][at] for name in arguments.split()),
                                                 **{name: vector[at] for name, vector in more.items()})
        parts = call(slice(None))
        parts = parts if isinstance(parts, tuple) else (parts,)
        assert [part.shape for part in parts] == [(N, *shape) for shape in shapes(arm.dof)], function
        # a state alone is the same among many
        alone = call(17)
        alone = alone if isinstance(alone, tuple) else (alone,)
        assert all(np.array_equal(one, part[17]) for one, part in zip(alone, parts)), function
        results[function] = np.concatenate(parts, axis=1) if len(parts) > 1 else parts[0]
    return results, given, motion


def test_a_body_in_free_flight_obeys_newton_and_euler():
    """One body, whose arm weighs nothing: each function in closed form, about the origin of frame 0."""
    mass, com = 3.0, np.array([0.1, -0.2, 0.3])
    inertia = np.array([[0.5, 0.02, -0.03], [0.02, 0.6, 0.04], [-0.03, 0.04, 0.7]])
    arm = rne.load(f"""
format: 2
name: body
source: own
convention: modified
gravity: [0, 0, 0]
floating_base:
  name: bus
  link: {{mass: {mass}, com: {com.tolist()}, inertia: {{xx: 0.5, yy: 0.6, zz: 0.7, xy: 0.02, xz: -0.03, yz: 0.04}}}}
joints: [{{type: revolute, dh: {{theta: 0, d: 0.2, a: 0.1, alpha: 0.3}}, link: {{mass: 0}}}}]
""")
    results, given, motion = floating(arm)
    about_origin = inertia - mass * cross(com) @ cross(com)
    block = np.block([[mass * np.eye(3), -mass * cross(com)], [mass * cross(com), about_origin]])
    matrix = np.zeros((7, 7))
    matrix[:6, :6] = block
    close(results["floating_mass_matrix"], np.tile(matrix, (N, 1, 1)))
    centroidal = np.zeros((6, 7))
    centroidal[:3, :6], centroidal[3:, 3:6] = block[:3], inertia
    close(results["centroidal_momentum_matrix"], np.tile(centroidal, (N, 1, 1)))
    omega, felt = given["omega"], motion["base_acceleration"] - motion["base_gravity"]
    turning = np.cross(omega, np.cross(omega, com))
    gyroscopic = np.cross(omega, omega @ inertia)
    zero = np.zeros((N, 1))
    force = mass * (felt + np.cross(motion["base_omega_dot"], com) + turning)
    moment = motion["base_omega_dot"] @ inertia + gyroscopic + np.cross(com, force)
    close(results["inverse_dynamics_of_floating_base"], np.hstack([force, moment, zero]))
    close(results["centroidal_bias"], np.hstack([mass * turning, gyroscopic]))
    close(results["floating_bias"], np.hstack([mass * turning, gyroscopic + np.cross(com, mass * turning), zero]))


def test_laws_of_a_base_that_floats():
    arm = rne.load(Path(__file__).parents[3] / "docs/satellite.yaml")
    results, given, motion = floating(arm)
    mass, bias = results["floating_mass_matrix"], results["floating_bias"]
    times = lambda matrices, vectors: np.einsum("nij,nj->ni", matrices, vectors)
    felt = motion["base_acceleration"] - motion["base_gravity"]
    accelerations = np.hstack([felt, motion["base_omega_dot"], given["qdd"]])
    forces = results["inverse_dynamics_of_floating_base"]
    close(times(mass, accelerations) + bias, forces)
    # in free flight nothing acts on the base
    free = np.hstack([np.zeros((N, 6)), given["tau"]])
    solved = np.linalg.solve(mass, (free - bias)[..., None])[..., 0]
    error = np.abs(results["floating_forward_dynamics"] - solved).max(axis=1)
    assert (error <= 1e-13 * np.linalg.cond(mass) * np.abs(solved).max(axis=1)).all()
    # the base that stands still is that of the arm
    close(mass[:, 6:, 6:], arm.mass_matrix(given["q"]))
    # the rate of the momentum about the centre of mass is the force, and its moment about that
    com, force, moment = arm.centre_of_mass(given["q"]), forces[:, :3], forces[:, 3:6]
    rate = times(results["centroidal_momentum_matrix"], accelerations) + results["centroidal_bias"]
    close(rate, np.hstack([force, moment - np.cross(com, force)]))
    # the momentum itself is M v of the base, about the centre of mass
    velocities = np.hstack([random.normal(size=(N, 3)), given["omega"], given["qd"]])
    momentum = times(mass, velocities)[:, :6]
    found = times(results["centroidal_momentum_matrix"], velocities)
    close(found, np.hstack([momentum[:, :3], momentum[:, 3:] - np.cross(com, momentum[:, :3])]))
