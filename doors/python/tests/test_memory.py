"""Memory that arrays share, where they lie, what `numpy.ma` hides, and processes that share an arm."""

import mmap
import multiprocessing

import numpy as np
import pytest

import rne

arm = rne.robots.puma560
random = np.random.default_rng(9)
q = random.normal(size=(257, 6))
tau = arm.gravity_torques(q)


def owned(backing, start, shape=(257, 6), dtype="f8"):
    """An array of its own owner on a memory: numpy does not know that another one has it too."""
    size = int(np.prod(shape)) * np.dtype(dtype).itemsize
    return np.asarray(memoryview(backing))[start:start + size].view(dtype).reshape(shape)


@pytest.mark.parametrize("backing", [bytearray(9 * q.nbytes), mmap.mmap(-1, 9 * q.nbytes)], ids=["bytes", "mmap"])
def test_out_shares_no_memory_with_an_argument(backing):
    size = q.nbytes
    given = owned(backing, size)
    for start in (size, size + 48, size - 48, size + 8, 8, 2 * size - 8):
        out = owned(backing, start)
        given[:] = q
        kept = bytes(backing)
        assert np.shares_memory(given, out)
        with pytest.raises(ValueError, match="`out` and `q` share memory: give `out` memory of its own"):
            arm.gravity_torques(given, out=out)
        assert bytes(backing) == kept, "nothing is written"
    # the memory just before and just after is another one's
    for start in (0, 2 * size):
        out = owned(backing, start)
        given[:] = q
        assert arm.gravity_torques(given, out=out) is out
        assert np.array_equal(out, tau) and np.array_equal(given, q)
    # in single precision
    given, out = owned(backing, size, dtype="f4"), owned(backing, size + 4, dtype="f4")
    with pytest.raises(ValueError, match="`out` and `q` share memory"):
        arm.gravity_torques(given, out=out)


def test_every_argument_is_apart_from_out():
    backing = bytearray(40 * q.nbytes)
    size = q.nbytes
    whole = owned(backing, 0)
    out = owned(backing, size // 2)
    other = np.zeros((257, 6))
    columns = np.asfortranarray(q)
    wide = owned(backing, 0, (257, 12))
    cases = [
        (lambda a: arm.inverse_dynamics(other, other, a, out=out), "qdd", whole),
        (lambda a: arm.inverse_dynamics_with_wrench(other, other, other, a, out=out), "wrench", whole),
        (lambda a: arm.inverse_dynamics_on_moving_base(other, other, other, base_omega=a, out=out), "base_omega",
         owned(backing, size, (257, 3))),
        (lambda a: arm.gravity_torques(a, out=out), "q", wide[:, ::2]),
        (lambda a: arm.gravity_torques(a, out=out), "q", whole[::-1]),
        (lambda a: arm.gravity_torques(a, out=out), "q", owned(backing, 0, (6, 257)).T),
        (lambda a: arm.gravity_torques(a, out=out), "q", owned(backing, size, (6,))),
    ]
    for work, name, given in cases:
        assert np.may_share_memory(given, out)
        with pytest.raises(ValueError, match=f"`out` and `{name}` share memory"):
            work(given)
    assert np.array_equal(arm.gravity_torques(columns, out=out), tau)
    # views of one owner
    both = np.vstack([q, q])
    for given, out in ((both[:257], both[1:258]), (both[:257], both[:257])):
        with pytest.raises(ValueError, match="`out` and `q` share memory"):
            arm.gravity_torques(given, out=out)
    assert np.array_equal(arm.gravity_torques(both[:257], out=both[257:]), tau)
    with pytest.raises(ValueError, match="read-only"):
        frozen = np.zeros((257, 6))
        frozen.flags.writeable = False
        arm.gravity_torques(q, out=frozen)
    # no states: no memory
    assert arm.gravity_torques(both[:0], out=owned(backing, 0, (0, 6))).shape == (0, 6)


def test_columns_share_no_memory_with_out():
    pyarrow = pytest.importorskip("pyarrow")
    backing = bytearray(q.nbytes)
    out = owned(backing, 0)
    numbers = pyarrow.Array.from_buffers(pyarrow.float64(), 257 * 6, [None, pyarrow.py_buffer(backing)])
    columns = pyarrow.record_batch({f"q{joint}": numbers.slice(257 * joint, 257) for joint in range(6)})
    for given in (pyarrow.FixedSizeListArray.from_arrays(numbers, 6), columns):
        with pytest.raises(ValueError, match="`out` and `q` share memory"):
            arm.gravity_torques(given, out=out)


def test_arrays_that_are_not_aligned_are_copied():
    def unaligned(numbers):
        found = np.zeros(numbers.nbytes + 1, "u1")[1:].view(numbers.dtype).reshape(numbers.shape)
        found[...] = numbers
        assert found.flags.c_contiguous and not found.flags.aligned
        return found

    single = q.astype("f4")
    for given, expected in ((q, tau), (single, arm.gravity_torques(single))):
        assert np.array_equal(arm.gravity_torques(unaligned(given)), expected)
        assert np.array_equal(arm.gravity_torques(unaligned(given.T.copy()).T), expected)
        assert np.array_equal(arm.gravity_torques(unaligned(given[3])), expected[3])
    packed = np.frombuffer(b"\0" + q.tobytes(), dtype=[("flag", "u1"), ("q", "f8", (257, 6))])["q"][0]
    assert np.array_equal(arm.gravity_torques(packed), tau)
    with pytest.raises(ValueError, match="`out` is not aligned: its address must be a multiple of 8"):
        arm.gravity_torques(q, out=unaligned(tau))
    with pytest.raises(ValueError, match="multiple of 4"):
        arm.gravity_torques(single, out=unaligned(single))


def test_columns_that_are_not_aligned_are_copied():
    pyarrow = pytest.importorskip("pyarrow")
    buffer = pyarrow.py_buffer(b"\0" + q.tobytes()).slice(1)
    numbers = pyarrow.Array.from_buffers(pyarrow.float64(), 257 * 6, [None, buffer])
    assert np.array_equal(arm.gravity_torques(pyarrow.FixedSizeListArray.from_arrays(numbers, 6)), tau)
    table = pyarrow.table({f"q{joint}": numbers.slice(257 * joint, 257) for joint in range(6)})
    assert np.array_equal(arm.gravity_torques(table), arm.gravity_torques(q.reshape(6, 257).T))


def test_masked_numbers_are_refused():
    masked = lambda numbers: np.ma.array(numbers, mask=np.arange(np.size(numbers)).reshape(np.shape(numbers)) == 4)
    row, zeros = q[0], np.zeros(6)
    for given in (masked(row), masked(q), masked(row.astype("f4")), masked(np.arange(6)),
                  np.ma.masked_invalid([0, np.inf] * 3), [q[0], masked(row)], (masked(row), q[0]),
                  [0.1, np.ma.masked, 0.2, 0.3, 0.4, 0.5], np.ma.array(np.asfortranarray(q), mask=q > 2),
                  np.ma.array(q, mask=True)):
        with pytest.raises(ValueError, match="`q`: there are masked elements, which are not numbers: drop or fill"):
            arm.gravity_torques(given)
    with pytest.raises(ValueError, match="`qdd`: there are masked elements"):
        arm.inverse_dynamics(zeros, zeros, masked(zeros))
    with pytest.raises(ValueError, match="`out`: there are masked elements"):
        arm.gravity_torques(q, out=masked(np.zeros((257, 6))))
    for work in (lambda: rne.payload(1, np.ma.array([0, 0, 0], mask=[0, 1, 0])),
                 lambda: rne.payload(1, inertia=np.ma.array(np.eye(3), mask=np.eye(3)))):
        with pytest.raises(ValueError, match="there are masked elements"):
            work()
    with pytest.raises(ValueError, match="masked"):
        arm.diagnose(zeros, masked(zeros), zeros, zeros)
    # nothing is masked: numbers as all others
    for given in (np.ma.array(q), np.ma.array(q, mask=False), list(np.ma.array(q, mask=q > 1e9))):
        assert np.array_equal(arm.gravity_torques(given), tau)


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="this system does not fork")
def test_a_child_of_fork_computes_batches():
    many = random.normal(size=(10_000, 6))
    expected, mass = arm.gravity_torques(many), arm.mass_matrix(many)

    def work():
        same = np.array_equal(arm.gravity_torques(many), expected) and np.array_equal(arm.mass_matrix(many), mass)
        raise SystemExit(0 if same else 1)

    children = [multiprocessing.get_context("fork").Process(target=work) for _ in range(2)]
    [child.start() for child in children]
    # a child that waits for ever is ended, and has no status 0
    [child.join(120) for child in children]
    [child.kill() for child in children if child.is_alive()]
    [child.join() for child in children]
    assert [child.exitcode for child in children] == [0, 0]
