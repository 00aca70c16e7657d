"""Functions on a graphics card, with a driver that runs kernels on the processor (tests/fake_driver): the numbers of
`Arm`, without a copy, on the caller's stream, without waiting. The hardware is not tested here: benches/gpu.

The test needs the library that `cargo build -p fake-driver` makes; the variable RNE_LIBCUDA names it.
"""

import ctypes
import os
import subprocess
import sys
import types
from pathlib import Path

import numpy as np
import pytest

import rne

ROOT = Path(__file__).parents[3]
LIBRARY = Path(os.environ.setdefault("RNE_LIBCUDA", str(ROOT / "target/debug/libfake_driver.so")))
if not hasattr(rne.Arm, "gpu"):
    pytest.skip("this package is built without the feature gpu", allow_module_level=True)
if not LIBRARY.exists():
    pytest.skip(f"there is no {LIBRARY}: cargo build -p fake-driver", allow_module_level=True)

driver = ctypes.CDLL(str(LIBRARY))
driver.fakeCount.restype = ctypes.c_uint64
LAUNCHES, WAITS, STREAM, BLOCKS, TRANSLATIONS, CONTEXTS = range(6)
random = np.random.default_rng(3)


class Array:
    """An array in the memory of the fake card, of a library that knows the standard of array interfaces."""

    def __init__(self, numbers, flags=()):
        self.numbers, self.flags = numbers, flags

    shape = property(lambda self: self.numbers.shape)
    dtype = property(lambda self: self.numbers.dtype)
    device = "card"

    @property
    def __cuda_array_interface__(self):
        about = self.numbers.__array_interface__
        data = (about["data"][0], "read-only" in self.flags)
        return {"version": 3, "data": data, **{name: about[name] for name in ("shape", "typestr", "strides")}}

    def __dlpack_device__(self):
        return (2, 1 if "elsewhere" in self.flags else 0)

    def __array_namespace__(self):
        return types.SimpleNamespace(empty=empty, moveaxis=lambda a, b, c: type(self)(np.moveaxis(a.numbers, b, c)))

    def __getitem__(self, index):
        return type(self)(self.numbers[index])

    def reshape(self, *shape):
        return type(self)(self.numbers.reshape(shape))


def memory(shape, dtype):
    address, count = ctypes.c_uint64(), int(np.prod(shape)) * np.dtype(dtype).itemsize
    assert driver.cuMemAlloc_v2(ctypes.byref(address), ctypes.c_size_t(max(count, 1))) == 0
    return np.frombuffer((ctypes.c_byte * count).from_address(address.value), dtype).reshape(shape)


def empty(shape, dtype, device=None):
    assert device == "card"
    numbers = memory(shape, dtype)
    numbers[...] = np.nan
    return Array(numbers)


def on_card(numbers, order="rows", of=Array, flags=()):
    moved = numbers if order == "rows" else np.moveaxis(numbers, 0, -1)
    copy = memory(moved.shape, numbers.dtype)
    copy[...] = moved
    return of(copy if order == "rows" else np.moveaxis(copy, -1, 0), flags)


def states(arm, count, dtype, arrays=3):
    return [random.normal(size=(count, arm.dof)).astype(dtype) for _ in range(arrays)]


def same(found, expected):
    """The bits of the processor where it has fused multiply-add, which the machines of these tests have."""
    assert found.numbers.dtype == expected.dtype
    np.testing.assert_array_equal(found.numbers, expected)


@pytest.fixture(scope="module")
def panda():
    return rne.robots.panda


@pytest.mark.parametrize("order", ["rows", "columns"])
@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_functions_are_those_of_the_arm(panda, dtype, order):
    gpu = panda.gpu()
    for count in (1, 67):
        q, qd, qdd = states(panda, count, dtype)
        on = [on_card(numbers, order) for numbers in (q, qd, qdd)]
        same(gpu.inverse_dynamics(*on), panda.inverse_dynamics(q, qd, qdd))
        same(gpu.mass_matrix(q=on[0]), panda.mass_matrix(q))
        expected = panda.inverse_dynamics_derivatives(q, qd, qdd)
        for found, one in zip(gpu.inverse_dynamics_derivatives(*on), expected):
            same(found, one)
        assert gpu.kinetic_energy(*on[:2]).shape == (count,)


def test_a_pose_is_twelve_numbers(panda):
    (q,) = states(panda, 5, "float64", 1)
    pose = panda.gpu().forward_kinematics(on_card(q)).numbers
    expected = panda.forward_kinematics(q)
    np.testing.assert_array_equal(pose[:, :9].reshape(5, 3, 3), expected[:, :3, :3])
    np.testing.assert_array_equal(pose[:, 9:], expected[:, :3, 3])


def test_a_payload_and_parameters_of_each_state():
    arm = rne.robots.puma560
    q, qd, qdd = states(arm, 9, "float64")
    payload = np.array([rne.payload(mass, (0.1, 0, mass / 9)) for mass in range(1, 10)])
    found = arm.gpu().inverse_dynamics(*map(on_card, (q, qd, qdd)), payload=on_card(payload))
    same(found, arm.inverse_dynamics(q, qd, qdd, payload=payload))

    desk = rne.load(ROOT / "docs/desk_arm.yaml", run_time=["upper", "fore"])
    q, qd, qdd = states(desk, 9, "float32")
    lengths = random.uniform(0.2, 0.4, (9, 2)).astype("float32")
    gpu = desk.gpu()
    on = list(map(on_card, (q, qd, qdd)))
    same(gpu.inverse_dynamics(*on, parameters=on_card(lengths)), desk.inverse_dynamics(q, qd, qdd, parameters=lengths))
    found = gpu.rollout(*on[:2], on_card(qdd[:, None]), 0.01, parameters=on_card(lengths))
    for one, expected in zip(found, desk.rollout(q, qd, qdd[:, None], 0.01, parameters=lengths)):
        same(one, expected)
    with pytest.raises(TypeError, match="needs `parameters`, an array with a row for each state"):
        gpu.inverse_dynamics(*on)


@pytest.mark.parametrize("order", ["rows", "columns"])
@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_a_rollout_is_one_launch(panda, dtype, order):
    gpu, (q, qd) = panda.gpu(), states(panda, 33, dtype, 2)
    tau = random.normal(size=(33, 6, 7)).astype(dtype)
    on = [on_card(numbers, order) for numbers in (q, qd, tau)]
    expected = panda.rollout(q, qd, tau, 0.002)
    gpu.prepare(dtype=dtype, rollout=True)
    before = [driver.fakeCount(which) for which in (LAUNCHES, WAITS, TRANSLATIONS)]
    found = gpu.rollout(*on, 0.002)
    assert [driver.fakeCount(which) for which in (LAUNCHES, WAITS, TRANSLATIONS)] == [before[0] + 1, *before[1:]]
    for one, all_states in zip(found, expected):
        same(one, all_states)
    for one, all_states in zip(gpu.rollout(*on, 0.002, every=4), expected):
        same(one, all_states[:, 3:4])
    # into arrays of the caller
    rooms = [on_card(np.zeros((33, 1, 7), dtype), order) for _ in range(2)]
    assert gpu.rollout(*on, 0.002, every=6, out=rooms)[0] is rooms[0]
    same(rooms[1], expected[1][:, 5:])
    payload = np.tile(rne.payload(1.5), (33, 1)).astype(dtype)
    for one, loaded in zip(gpu.rollout(*on, 0.002, payload=on_card(payload, order)),
                           panda.rollout(q, qd, tau, 0.002, payload=payload)):
        same(one, loaded)


def test_a_call_is_on_the_callers_stream_and_does_not_wait(panda, monkeypatch):
    gpu, numbers = panda.gpu(), states(panda, 2, "float32")
    on = [on_card(one) for one in numbers]
    gpu.prepare("inverse_dynamics")
    waits = driver.fakeCount(WAITS)

    class Stream:
        def __cuda_stream__(self):
            return 0, 77

    of_torch, of_cupy = types.SimpleNamespace(cuda_stream=6), types.SimpleNamespace(ptr=7)
    for stream, handle in [(None, 0), (5, 5), (of_torch, 6), (of_cupy, 7), (Stream(), 77)]:
        gpu.inverse_dynamics(*on, stream=stream)
        assert driver.fakeCount(STREAM) == handle
    with pytest.raises(TypeError, match="`stream` is 'fast'"):
        gpu.inverse_dynamics(*on, stream="fast")

    # libraries with a current stream
    tensor = type("Tensor", (Array,), {"__module__": "torch"})
    current = types.SimpleNamespace(current_stream=lambda device: types.SimpleNamespace(cuda_stream=88))
    made, movedim = lambda *a, **k: tensor(empty(*a, **k).numbers), lambda a, b, c: tensor(np.moveaxis(a.numbers, b, c))
    monkeypatch.setitem(sys.modules, "torch", types.SimpleNamespace(cuda=current, empty=made, movedim=movedim))
    found = gpu.inverse_dynamics(*(on_card(one, "columns", tensor) for one in numbers))
    assert driver.fakeCount(STREAM) == 88 and type(found) is tensor
    same(found, panda.inverse_dynamics(*numbers))
    # contexts of other libraries stay current: each call takes its own away again
    assert driver.fakeCount(WAITS) == waits and driver.fakeCount(CONTEXTS) == 0

    # JAX has no stream that others may use
    jax_array = type("ArrayImpl", (Array,), {"__module__": "jaxlib.xla", "block_until_ready": lambda self: self})
    space = types.SimpleNamespace(empty=lambda *a, **k: jax_array(empty(*a, **k).numbers))
    monkeypatch.setitem(sys.modules, "jax", types.SimpleNamespace(numpy=space))
    same(gpu.inverse_dynamics(*(on_card(one, of=jax_array) for one in numbers)), panda.inverse_dynamics(*numbers))
    assert driver.fakeCount(WAITS) == waits + 1 and driver.fakeCount(STREAM) == 0


class Capsule(Array):
    """An array that has DLPack alone."""

    __cuda_array_interface__ = None

    def __dlpack__(self):
        return self.numbers.__dlpack__()


def test_dlpack_is_enough(panda):
    numbers = states(panda, 5, "float64")
    for order in ("rows", "columns"):
        found = panda.gpu().inverse_dynamics(*(on_card(one, order, Capsule) for one in numbers))
        same(found, panda.inverse_dynamics(*numbers))


def test_wrong_arrays_are_refused(panda):
    gpu = panda.gpu()
    q, qd, qdd = (on_card(one) for one in states(panda, 4, "float32"))

    def refused(error, words, *arguments, **keywords):
        launches = driver.fakeCount(LAUNCHES)
        with pytest.raises(error, match=words):
            gpu.inverse_dynamics(*arguments, **keywords)
        assert driver.fakeCount(LAUNCHES) == launches

    refused(ValueError, "`q` is not on a graphics card of NVIDIA: copy it there", *[np.zeros((4, 7))] * 3)
    refused(TypeError, "`q` is a list, but it must be an array on a graphics card", [0] * 7, [0] * 7, [0] * 7)
    refused(TypeError, "`qd` is a list, but it must be an array on a graphics card", q, [0] * 7, qdd)
    other = on_card(qd.numbers, of=type("Other", (Array,), {"__module__": "other.arrays"}))
    refused(TypeError, "`qd` is of other, but others are of test_gpu: use one library", q, other, qdd)
    refused(TypeError, "needs `qdd`; it takes q, qd, qdd", q, qd)
    refused(TypeError, "takes q, qd, qdd, each once", q, qd, qdd, q=q)
    refused(TypeError, "`qd` is of float64, but `q` is of float32", q, on_card(np.zeros((4, 7))), qdd)
    refused(TypeError, "`qdd` is of <i8, but it must be float32 or float64", q, qd, on_card(np.zeros((4, 7), "int64")))
    for shape, words in [((4, 6), r"`q` has the shape \(4, 6\), but"), ((7,), r"`q` has the shape \(7,\), but")]:
        refused(ValueError, words + r" it must be \(N, 7\)", on_card(np.zeros(shape, "float32")), qd, qdd)
    refused(ValueError, "`qd` has 1 rows, but `q` has 4", q, on_card(np.zeros((1, 7), "float32")), qdd)
    refused(ValueError, "`qd` is not contiguous", q, Array(memory((8, 7), "float32")[::2]), qdd)
    refused(ValueError, "in rows and in columns", q, on_card(qd.numbers, "columns"), qdd)
    elsewhere = on_card(qdd.numbers, flags=["elsewhere"])
    refused(ValueError, "`qdd` is on graphics card 1, but the arm is on card 0", q, qd, elsewhere)
    refused(ValueError, "`out` shares memory with `qd`", q, qd, qdd, out=qd)
    refused(ValueError, "`out` can only be read", q, qd, qdd, out=on_card(qdd.numbers, flags=["read-only"]))
    refused(ValueError, "it must have 4 states of float32", q, qd, qdd, out=on_card(np.zeros((4, 7))))
    refused(TypeError, "`inverse_dynamics` has no argument `speed`; it takes q, qd, qdd", q, qd, qdd, speed=q)
    refused(TypeError, "this arm has no run-time parameters; `rne.load", q, qd, qdd, parameters=q)
    refused(TypeError, "takes q, qd, qdd, each once", q, qd, qdd, q)
    # rows with two bytes between them, and numbers between the addresses of numbers
    padded = Array(memory((4,), np.dtype([("row", "f4", 7), ("flag", "i2")]))["row"])
    refused(ValueError, "`qd` is not contiguous", q, padded, qdd)
    refused(ValueError, "it must have 4 states of float32", q, qd, qdd, out=padded)
    shifted = Array(memory((4 * 7 * 4 + 2,), "u1")[2:].view("f4").reshape(4, 7))
    refused(ValueError, "`qd` begins at the address 0x.*, but it must be a multiple of 4 bytes", q, shifted, qdd)
    refused(ValueError, "`out` begins at the address", q, qd, qdd, out=shifted)
    out = on_card(np.zeros((4, 7), "float32"))
    assert gpu.inverse_dynamics(q, qd, qdd, out=out) is out
    same(out, panda.inverse_dynamics(q.numbers, qd.numbers, qdd.numbers))

    tau = on_card(np.zeros((4, 3, 7), "float32"))
    with pytest.raises(ValueError, match="`every` is 4, but it must be from 1 to the number of steps, 3"):
        gpu.rollout(q, qd, tau, 0.1, every=4)
    with pytest.raises(ValueError, match=r"`tau` has the shape \(4, 7\), but it must be \(N, T, 7\)"):
        gpu.rollout(q, qd, qdd, 0.1)
    for every in (1.5, "2"):
        with pytest.raises(TypeError, match=f"`every` is {every!r}, but it must be a whole number"):
            gpu.rollout(q, qd, tau, 0.1, every=every)
    # the last two are 0 and infinite in float32
    for step in (0, -0.1, float("nan"), 1e-60, 1e60):
        with pytest.raises(ValueError, match="`step` is .* s, but it must be a finite number above zero"):
            gpu.rollout(q, qd, tau, step)
    with pytest.raises(TypeError, match="`step` is 'fast', but it must be a number"):
        gpu.rollout(q, qd, tau, "fast")
    with pytest.raises(TypeError, match="has no argument `friction`: it has neither friction nor limits, and `Arm.rollout`"):
        gpu.rollout(q, qd, tau, 0.1, friction=True)
    with pytest.raises(ValueError, match="`out` has 4 arrays, but it must have 2: for positions and for velocities"):
        gpu.rollout(q, qd, tau, 0.1, out=[q] * 4)
    with pytest.raises(ValueError, match="`out` has 1 arrays, but it must have 2"):
        gpu.rollout(q, qd, tau, 0.1, out=tau)
    with pytest.raises(AttributeError, match="has no function `torques` on a graphics card"):
        gpu.torques(q)
    with pytest.raises(TypeError, match="`kinetic_energy` takes no payload"):
        gpu.kinetic_energy(q, qd, payload=q)
    with pytest.raises(AttributeError, match="has no function `mass_matrx` on a graphics card; did you mean `mass_matrix`"):
        gpu.mass_matrx(q)
    with pytest.raises(ValueError, match="has no function `mass_matrx` on a graphics card; did you mean `mass_matrix`"):
        gpu.prepare("mass_matrx")
    with pytest.raises(TypeError, match="`dtype` is half, but it must be float32 or float64"):
        gpu.prepare(dtype="half")
    with pytest.raises(ValueError, match="`device` is -1, but it must be the number of a graphics card, counted from 0"):
        panda.gpu(-1)
    with pytest.raises(TypeError, match="`device` is 'cuda:0', but it must be a whole number"):
        panda.gpu("cuda:0")
    with pytest.raises(RuntimeError, match="there is no graphics card 3: this machine has 1, counted from 0"):
        panda.gpu(3)


def test_tensors_of_pytorch():
    """Strides, new tensors and views of PyTorch itself, whose tensors of the processor pass for those on a card."""
    pytest.importorskip("torch")
    command = [sys.executable, ROOT / "benches/gpu/mppi.py", "--fake", LIBRARY, "--samples=33", "--steps=4", "--cycles=3"]
    said = subprocess.run(command, capture_output=True, text=True)
    assert "rollouts of 4 steps per second" in said.stdout and "distance to the goal" in said.stdout, said.stderr


def test_what_is_prepared_is_not_translated_again():
    arm = rne.robots.planar2
    gpu, (q, qd, tau) = arm.gpu(), (on_card(one) for one in states(arm, 2, "float64"))
    payload = on_card(np.tile(rne.payload(1.5), (2, 1)))
    gpu.prepare("mass_matrix", dtype=np.float64, rollout=True)
    gpu.prepare("inverse_dynamics", dtype=np.float64, rollout=True, payload=True)
    translations = driver.fakeCount(TRANSLATIONS)
    gpu.mass_matrix(q)
    gpu.inverse_dynamics(q, qd, tau, payload=payload)
    torques = on_card(tau.numbers[:, None])
    gpu.rollout(q, qd, torques, 0.1)
    gpu.rollout(q, qd, torques, 0.1, payload=payload)
    assert driver.fakeCount(TRANSLATIONS) == translations


def test_no_state_is_no_launch(panda):
    launches = driver.fakeCount(LAUNCHES)
    nothing = on_card(np.zeros((0, 7), "float32"))
    assert panda.gpu().inverse_dynamics(nothing, nothing, nothing).shape == (0, 7)
    assert driver.fakeCount(LAUNCHES) == launches


def test_a_machine_without_a_driver_gives_one_line():
    command = "import rne\ntry: rne.robots.panda.gpu()\nexcept RuntimeError as error: print(error)"
    environment = {**os.environ, "RNE_LIBCUDA": "libcuda-of-nobody.so.1"}
    said = subprocess.run([sys.executable, "-c", command], env=environment, capture_output=True, text=True, check=True)
    assert said.stdout.startswith("no NVIDIA driver: libcuda-of-nobody.so.1 cannot be opened (")
    assert "No such file" in said.stdout or sys.platform != "linux"
    assert said.stdout.count("\n") == 1 and said.stderr == ""
