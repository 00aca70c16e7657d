"""FMUs of `rne export --fmu`, validated and simulated by FMPy. RNE names the program."""

import ctypes
import os
import subprocess
import sys
from pathlib import Path
from shutil import which

import numpy as np
import pytest
from fmpy import extract, instantiate_fmu, read_model_description, simulate_fmu
from fmpy.validation import validate_fmu
from scipy.integrate import solve_ivp

RNE = os.environ["RNE"]
ROOT = Path(__file__).parents[2]

#: A serial arm, one whose third joint slides, and a tree with links on several branches.
ROBOTS = ["panda", "puma560", "scara_cobra600", str(ROOT / "docs" / "tree.yaml"), str(ROOT / "docs" / "desk_arm.yaml")]


def run(*arguments, **options):
    return subprocess.run(arguments, check=True, capture_output=True, text=True, **options)


@pytest.fixture(scope="module", params=[(robot, version) for robot in ROBOTS for version in "23"],
                ids=lambda one: f"{Path(one[0]).stem}-{one[1]}")
def arm(request, tmp_path_factory):
    return Arm(*request.param, tmp_path_factory.mktemp("fmu"))


class Arm:
    """Both FMUs of a robot, and the code without parameters at run time, which `rne emit` writes for C."""

    def __init__(self, robot, version, folder):
        self.forward, self.inverse = str(folder / "forward.fmu"), str(folder / "inverse.fmu")
        run(RNE, "export", robot, "--fmu", version, "-o", self.forward)
        run(RNE, "export", robot, "--fmu", version, "--inverse", "-o", self.inverse)
        self.description = read_model_description(self.forward)
        self.variables = {one.name: one for one in self.description.modelVariables}
        self.joints = [name[2:] for name in self.variables if name.startswith("q.")]
        self.n = len(self.joints)
        source = folder / "robot.c"
        run(RNE, "emit", robot, "--lang", "c", "--real", "double", "--prefix", "robot",
            "--function", "inverse_dynamics,forward_dynamics,forward_dynamics_with_payload", "-o", source)
        run("cc", "-O2", "-ffp-contract=off", "-shared", "-fPIC", "-o", folder / "robot.so", source)
        self.library = ctypes.CDLL(str(folder / "robot.so"))

    def call(self, function, *arguments):
        result = (ctypes.c_double * self.n)()
        arrays = [(ctypes.c_double * len(one))(*one) for one in arguments]
        getattr(self.library, f"robot_{function}")(*arrays, result)
        return np.array(result)

    def names(self, kind):
        return [f"{kind}.{joint}" for joint in self.joints]

    def state(self, seed=7):
        random = np.random.default_rng(seed)
        return [scale * random.uniform(-1, 1, self.n) for scale in (0.5, 0.3, 0.7)]

    def start(self, kind, values):
        return dict(zip(self.names(kind), values))

    def trajectory(self, torques, times, q, qd, payload=None):
        """Positions and velocities by an integrator of order 8."""
        function, more = ("forward_dynamics", []) if payload is None else ("forward_dynamics_with_payload", [payload])

        def rate(time, x):
            return np.concatenate([x[self.n:], self.call(function, x[:self.n], x[self.n:], torques(time), *more)])
        solution = solve_ivp(rate, (times[0], times[-1]), np.concatenate([q, qd]), method="DOP853", t_eval=times,
                             rtol=1e-12, atol=1e-12)
        return solution.y.T


def columns(result, names):
    return np.array([result[name] for name in names]).T


def test_fmpy_validates(arm):
    for path in (arm.forward, arm.inverse):
        assert validate_fmu(path) == []


def test_model_exchange_gives_our_trajectory(arm):
    """Constant torques, integrated by CVode of FMPy, which does not change inputs inside of a step."""
    q, qd, qdd = arm.state()
    torques = arm.call("inverse_dynamics", q, qd, qdd)
    result = simulate_fmu(
        arm.forward, fmi_type="ModelExchange", stop_time=0.3, output_interval=0.01, relative_tolerance=1e-9,
        start_values=arm.start("q", q) | arm.start("qd", qd) | arm.start("tau", torques),
        output=arm.names("q") + arm.names("qd"))
    expected = arm.trajectory(lambda time: torques, np.clip(result["time"], 0, 0.3), q, qd)
    assert len(result) > 20
    np.testing.assert_allclose(columns(result, arm.names("q") + arm.names("qd")), expected, rtol=0, atol=1e-6)


def test_co_simulation_gives_our_trajectory(arm):
    """Constant torques, integrated by the FMU itself; half of the step leaves a sixteenth of the error."""
    q, qd, qdd = arm.state()
    torques = arm.call("inverse_dynamics", q, qd, qdd)
    errors = []
    for step in (0.01, 0.005, 0.0005):
        result = simulate_fmu(
            arm.forward, fmi_type="CoSimulation", stop_time=0.2, output_interval=0.01,
            start_values=arm.start("q", q) | arm.start("qd", qd) | arm.start("tau", torques) | {"step": step},
            output=arm.names("q") + arm.names("qd"))
        expected = arm.trajectory(lambda time: torques, np.clip(result["time"], 0, 0.2), q, qd)
        errors.append(np.abs(columns(result, arm.names("q") + arm.names("qd")) - expected).max())
    assert errors[2] < 1e-8
    assert errors[1] < errors[0] / 8 or errors[0] < 1e-10


def test_a_payload_that_is_set_moves_with_the_tip(arm):
    q, qd, qdd = arm.state()
    torques = arm.call("inverse_dynamics", q, qd, qdd)
    payload = {"payload.mass": 1.5, "payload.com.x": 0.05, "payload.com.y": -0.03, "payload.com.z": 0.1}
    payload |= {f"payload.inertia.{element}": value for element, value in
                {"xx": 0.012, "yy": 0.015, "zz": 0.009, "xy": 0.001, "xz": -0.002, "yz": 0.0015}.items()}
    assert set(payload) == {name for name in arm.variables if name.startswith("payload.")}
    for kind, options in [("ModelExchange", {"relative_tolerance": 1e-9}), ("CoSimulation", {})]:
        step = {"step": 0.0005} if kind == "CoSimulation" else {}
        result = simulate_fmu(
            arm.forward, fmi_type=kind, stop_time=0.2, output_interval=0.01, **options,
            start_values=arm.start("q", q) | arm.start("qd", qd) | arm.start("tau", torques) | payload | step,
            output=arm.names("q") + arm.names("qd"))
        expected = arm.trajectory(lambda time: torques, np.clip(result["time"], 0, 0.2), q, qd, list(payload.values()))
        np.testing.assert_allclose(columns(result, arm.names("q") + arm.names("qd")), expected, rtol=0, atol=1e-6)
        without = arm.trajectory(lambda time: torques, np.clip(result["time"], 0, 0.2), q, qd)
        assert np.abs(expected - without).max() > 1e-3


def test_inverse_gives_our_torques(arm):
    q, qd, qdd = arm.state(3)
    for kind in ("CoSimulation", "ModelExchange"):
        result = simulate_fmu(
            arm.inverse, fmi_type=kind, stop_time=0.1, output_interval=0.1,
            start_values=arm.start("q", q) | arm.start("qd", qd) | arm.start("qdd", qdd), output=arm.names("tau"))
        expected = arm.call("inverse_dynamics", q, qd, qdd)
        np.testing.assert_allclose(columns(result, arm.names("tau"))[-1], expected, rtol=1e-12, atol=1e-12)


class Instance:
    """An FMU in initialization mode, by the functions of FMI."""

    def __init__(self, path, folder):
        description = read_model_description(path)
        self.is_second = description.fmiVersion == "2.0"
        self.references = {one.name: one.valueReference for one in description.modelVariables}
        self.fmu = instantiate_fmu(extract(path, folder), description, "ModelExchange")
        if self.is_second:
            self.fmu.setupExperiment(startTime=0.0)
        self.fmu.enterInitializationMode()
        self.get = self.fmu.getReal if self.is_second else self.fmu.getFloat64
        self.set = self.fmu.setReal if self.is_second else self.fmu.setFloat64

    def of(self, names):
        return [self.references[name] for name in names]

    def close(self):
        self.fmu.terminate()
        self.fmu.freeInstance()


@pytest.mark.parametrize("which_fmu", ["forward", "inverse"])
def test_derivatives_agree_with_differences(arm, which_fmu, tmp_path):
    arguments, result = (("q", "qd", "tau"), "qdd") if which_fmu == "forward" else (("q", "qd", "qdd"), "tau")
    instance = Instance(getattr(arm, which_fmu), tmp_path)
    knowns = [name for kind in arguments for name in arm.names(kind)]
    unknowns = instance.of(arm.names(result))
    point = np.concatenate(arm.state(5))
    seed = np.random.default_rng(1).uniform(-1, 1, len(point))
    row = np.random.default_rng(2).uniform(-1, 1, arm.n)

    def at(x):
        instance.set(instance.of(knowns), list(x))
        return np.array(instance.get(unknowns))
    h = 1e-5
    expected = (8 * (at(point + h * seed) - at(point - h * seed)) - at(point + 2 * h * seed)
                + at(point - 2 * h * seed)) / (12 * h)
    at(point)
    found = np.array(instance.fmu.getDirectionalDerivative(unknowns, instance.of(knowns), list(seed)))
    np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-6 * np.abs(expected).max())
    if not instance.is_second:
        adjoint = np.array(instance.fmu.getAdjointDerivative(unknowns, instance.of(knowns), list(row), len(knowns)))
        assert adjoint @ seed == pytest.approx(row @ found, rel=1e-9, abs=1e-9)
    instance.close()


def test_every_parameter_has_an_effect(arm, tmp_path):
    """A change of any parameter changes torques at one of some states, and nothing else is offered."""
    instance = Instance(arm.inverse, tmp_path)
    names = [name for name in instance.references if name.split(".")[0] not in ("time", "q", "qd", "qdd", "tau")]
    # an arm that moves in a plane does not feel all numbers of a payload, and only a payload feels where the tip is
    payload = [name for name in names if name.startswith("payload.")]
    instance.set(instance.of(payload), [1.5, 0.05, -0.03, 0.1, 0.012, 0.015, 0.009, 0.001, -0.002, 0.0015])
    names = [name for name in names if name not in payload]
    assert names
    states = [np.concatenate(arm.state(seed)) for seed in range(5)]
    inputs = instance.of([name for kind in ("q", "qd", "qdd") for name in arm.names(kind)])

    def torques():
        found = []
        for state in states:
            instance.set(inputs, list(state))
            found.append(instance.get(instance.of(arm.names("tau"))))
        return np.array(found)
    before = torques()
    for name in names:
        reference = instance.of([name])
        value = instance.get(reference)[0]
        instance.set(reference, [1.5 * value])
        assert (torques() != before).any(), name
        instance.set(reference, [value])
    np.testing.assert_array_equal(torques(), before)
    instance.close()


def test_states_are_saved_and_restored(arm, tmp_path):
    instance = Instance(arm.forward, tmp_path)
    references = instance.of(arm.names("q") + arm.names("qd"))
    fmu = instance.fmu
    state = fmu.getFMUstate() if instance.is_second else fmu.getFMUState()
    serialized = fmu.serializeFMUstate(state) if instance.is_second else fmu.serializeFMUState(state)
    before = instance.get(references)
    instance.set(references, [value + 0.25 for value in before])
    restored = (fmu.deSerializeFMUstate if instance.is_second else fmu.deserializeFMUState)(serialized)
    (fmu.setFMUstate if instance.is_second else fmu.setFMUState)(restored)
    assert list(instance.get(references)) == list(before)
    for one in (state, restored):
        (fmu.freeFMUstate if instance.is_second else fmu.freeFMUState)(one)
    instance.close()


def test_sources_build_with_cmake(arm, tmp_path):
    """From an FMU without a binary, with the commands of its documentation."""
    build = tmp_path / "build"
    folder = Path(extract(arm.forward, tmp_path / "fmu"))
    for binary in (folder / "binaries").rglob("*.*"):
        binary.unlink()
    run("cmake", "-S", "sources", "-B", build, cwd=folder)
    run("cmake", "--build", build, "--target", "fmu", cwd=folder)
    packed = build / f"{arm.description.modelName}.fmu"
    assert validate_fmu(str(packed)) == []
    built, given = (simulate_fmu(fmu, fmi_type="CoSimulation", stop_time=0.02, output_interval=0.01)
                    for fmu in (str(packed), arm.forward))
    for name in given.dtype.names:
        np.testing.assert_allclose(built[name], given[name], rtol=1e-12, atol=1e-12)


def test_fmpy_compiles_the_sources(arm, tmp_path):
    fmu = tmp_path / "without.fmu"
    fmu.write_bytes(Path(arm.forward).read_bytes())
    run(sys.executable, "-m", "fmpy", "compile", str(fmu))
    simulate_fmu(str(fmu), fmi_type="CoSimulation", stop_time=0.02, output_interval=0.01)


def test_a_prebuilt_fmu_needs_no_compiler(arm):
    code = "import sys, fmpy; print(len(fmpy.simulate_fmu(sys.argv[1], stop_time=0.1, output_interval=0.01)))"
    environment = {"PATH": str(Path(sys.executable).parent / "nowhere")}
    assert which("cc", path=environment["PATH"]) is None
    assert int(run(sys.executable, "-c", code, arm.forward, env=environment).stdout) >= 11


def test_signatures_are_those_of_the_standard(arm, tmp_path):
    """The sources compile with the headers of the standard in place of the types that they declare."""
    import fmpy
    version = arm.description.fmiVersion[0]
    headers = Path(fmpy.__file__).parent / "c-code"
    sources = Path(extract(arm.forward, tmp_path)) / "sources"
    (sources / "fmi-types.h").write_text(f'#include "fmi{version}Functions.h"\n', encoding="utf-8")
    run("cc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-Wno-strict-prototypes", f"-I{headers}", "-c", "fmi-functions.c",
        cwd=sources)
