"""Motions of floating bases in the vectors of other tools, which `tests/reference/conventions.py` got from these tools."""

import json
import pathlib

import numpy as np
import pytest

import rne

GOLDEN = pathlib.Path(__file__).parents[3] / "tests/functions/floating/conventions.json"
PARTS = {part: {key: np.array(x) for key, x in told.items()} for part, told in json.loads(GOLDEN.read_text()).items()}
BASE = PARTS["base"]
TURN = BASE["rotation"]
NAMES = ["base_omega", "base_omega_dot", "base_acceleration", "base_gravity"]


def check(told, expected):
    assert list(told) == NAMES
    for name, vector in zip(NAMES, expected):
        np.testing.assert_allclose(told[name], vector, rtol=0, atol=1e-14 * 9.81, err_msg=name)


@pytest.mark.parametrize("tool, convert", [("pinocchio", rne.base_from_pinocchio), ("mujoco", rne.base_from_mujoco)])
def test_vectors_of_tools(tool, convert):
    vectors = [PARTS[tool][key] for key in "qva"]
    expected = [BASE["omega"], BASE["omega_dot"], BASE["acceleration"], TURN.T @ BASE["gravity"]]
    check(convert(*vectors, gravity=BASE["gravity"]), expected)
    # longer vectors, and many states
    batch = [np.tile([*vector, 7.0, 8.0], (3, 1)) for vector in vectors]
    check(convert(*batch, gravity=BASE["gravity"]), [np.tile(vector, (3, 1)) for vector in expected])


def test_readings_of_a_unit():
    unit = PARTS["imu"]
    (w, *xyz), (x, y, z) = unit["quaternion"], unit["quaternion"][1:]
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    rotation = np.eye(3) + 2 * w * skew + 2 * skew @ skew
    rate = rotation.T @ BASE["omega_dot"]
    told = rne.base_from_imu(unit["gyroscope"], rate, unit["accelerometer"], rotation=rotation, position=unit["position"])
    check(told, [BASE["omega"], BASE["omega_dot"], BASE["acceleration"] - TURN.T @ BASE["gravity"], np.zeros(3)])


def test_a_satellite_takes_them():
    """The wrench of a base turns with the world: what Pinocchio's state and MuJoCo's state of one motion give."""
    arm = rne.load(pathlib.Path(__file__).parents[3] / "docs/satellite.yaml")
    state = ([0.3, -0.8], [0.2, 0.4], [1.0, -2.0])
    gravity = {"gravity": [0, 0, -9.81]}
    of_pinocchio = rne.base_from_pinocchio(*(PARTS["pinocchio"][key] for key in "qva"), **gravity)
    of_mujoco = rne.base_from_mujoco(*(PARTS["mujoco"][key] for key in "qva"), **gravity)
    for one, other in zip(*(arm.inverse_dynamics_of_floating_base(*state, **told) for told in (of_pinocchio, of_mujoco))):
        np.testing.assert_allclose(one, other, rtol=1e-12)


def test_gravity_is_not_guessed():
    """A model may have another gravity, or a base that is turned."""
    vectors = np.zeros(7), np.zeros(6), np.zeros(6)
    converts = [rne.base_from_pinocchio, rne.base_from_mujoco]
    converts.append(lambda *_, **given: rne.derivatives_to_pinocchio(np.zeros((3, 6, 3)), np.eye(6), *vectors[:2], **given))
    for convert in converts:
        for given in ({}, {"model": object(), "gravity": [0, 0, -9.81]}):
            with pytest.raises(TypeError, match="either `model`, .* or `gravity`"):
                convert(*vectors, **given)
