"""The Python package: hostile arguments, memory that is shared, threads, children that fork, notebooks.

Each case calls the package in a process of its own. Needs the wheel, numpy and pyarrow.
"""

import copy
import gc
import html.parser
import json
import math
import os
import pathlib
import pickle
import resource
import threading

import numpy as np
import pyarrow as pa
import rne

import harness
from robots import BOMB

CASES = harness.Cases()
CLOCK = 60.0
# What programs expect where an argument is wrong. A panic is none of these.
ERRORS = (ValueError, TypeError, KeyError, OSError, IndexError, OverflowError, AttributeError, rne.EvaluationError)
ZEROS = np.zeros(6)
STATES = np.random.default_rng(1).normal(size=(257, 6))


def case(name, body):
    CASES.add(name, body, clock=CLOCK)


def puma():
    return rne.robots["puma560"]


def torques(q, **more):
    return puma().gravity_torques(q, **more)


def attempt(trial, work):
    """What a call returns, or the error that it raises; any other exception is a fault."""
    trial.verdict.commands += 1
    try:
        return work()
    except ERRORS as error:
        if any(words in str(error) for words in harness.PANIC):
            trial.fault(f"{type(error).__name__}: {error}")
        return error


def one_by_one(states):
    return np.stack([torques(state) for state in states])


def is_refused(value):
    return isinstance(value, ERRORS)


# Arguments: whatever they are, there is an answer or an error that programs expect.
def arguments():
    cycle = []
    cycle.append(cycle)
    return {
        "None": None,
        "a text": "abc",
        "texts": ["a"] * 6,
        "objects": np.array([object()] * 6),
        "complex": np.zeros(6, complex),
        "5 numbers": np.zeros(5),
        "7 numbers": np.zeros(7),
        "no number": np.zeros(0),
        "no state": np.zeros((0, 6)),
        "states of no number": np.zeros((6, 0)),
        "three axes": np.zeros((2, 3, 6)),
        "no axis": np.float64(1),
        "NaN": np.full(6, np.nan),
        "infinite": np.full(6, np.inf),
        "1e308": np.full(6, 1e308),
        "truths": np.ones(6, bool),
        "integers": np.arange(6),
        "u8": np.arange(6, dtype="u8"),
        "f2": np.zeros(6, "f2"),
        "f4": np.zeros(6, "f4"),
        "long double": np.zeros(6, np.longdouble),
        "big-endian": np.zeros(6, ">f8"),
        "strides below zero": np.zeros(12)[::-2],
        "strides of zero": np.broadcast_to(0.1, (6,)),
        "one row often": np.broadcast_to(np.zeros(6), (100, 6)),
        "one column often": np.broadcast_to(np.zeros((100, 1)), (100, 6)),
        "order of Fortran": np.zeros((100, 6), order="F"),
        "every second number": np.zeros((200, 12))[::2, ::2],
        "transposed": np.zeros((6, 100)).T,
        "not aligned": np.frombuffer(b"\0" * 49, "u1")[1:].view("f8"),
        "read-only": np.frombuffer(b"\0" * 48),
        "masked": np.ma.masked_array(np.zeros(6), [1] * 6),
        "matrix": np.matrix(np.zeros(6)),
        "records": np.zeros(6, [("a", "f8")]),
        "dates": np.zeros(6, "M8[s]"),
        "generator": (0.0 for _ in range(6)),
        "dict": {},
        "set": {1.0, 2.0},
        "ragged": [[1, 2], [3]],
        "deep list": [[[[[0] * 6]]]],
        "list of itself": cycle,
        "large integers": [10**400] * 6,
        "Arrow": pa.array([[0.0] * 6] * 3),
        "Arrow with null": pa.array([[0.0] * 5 + [None]]),
        "Arrow of 5": pa.array([[0.0] * 5]),
        "Arrow of texts": pa.array(["a"]),
        "Arrow in chunks": pa.chunked_array([[[0.0] * 6], [[1.0] * 6]]),
        "Arrow in no chunk": pa.chunked_array([], type=pa.list_(pa.float64())),
        "Arrow table": pa.table({f"c{i}": [0.0, 1.0] for i in range(6)}),
        "Arrow table of 5": pa.table({f"c{i}": [0.0] for i in range(5)}),
        "Arrow of fixed length": pa.array([[0.0] * 6], pa.list_(pa.float64(), 6)),
        "Arrow of no row": pa.array([], pa.list_(pa.float64(), 6)),
        "Arrow of a dictionary": pa.array([1.0] * 6).dictionary_encode(),
        "Arrow of structures": pa.array([{"a": 1}]),
    }


FUNCTIONS = ("inverse_dynamics", "mass_matrix", "forward_kinematics", "gravity_torques", "jacobian")
for name in arguments():
    for function in FUNCTIONS:
        rest = [ZEROS, ZEROS] if function == "inverse_dynamics" else []
        case(
            f"{function} of {name}",
            lambda trial, name=name, function=function, rest=rest: attempt(
                trial, lambda: getattr(puma(), function)(arguments()[name], *rest)
            ),
        )


# Layouts: the same numbers give the same bits.
def not_aligned(states):
    """The same numbers at an odd address."""
    memory = np.zeros(states.size * 8 + 1, "u1")
    array = memory[1:].view("f8").reshape(states.shape)
    array[:] = states
    return array


LAYOUTS = {
    "rows": lambda q: q,
    "order of Fortran": np.asfortranarray,
    "strides": lambda q: np.repeat(np.repeat(q, 2, 0), 2, 1)[::2, ::2],
    "reversed": lambda q: q[::-1].copy()[::-1],
    "big-endian": lambda q: q.astype(">f8"),
    "Arrow columns": lambda q: pa.table({str(i): q[:, i] for i in range(6)}),
    "Arrow lists": lambda q: pa.array(list(q)),
    "Arrow slice": lambda q: pa.array([[9.0] * 6, *q, [9.0] * 6])[1:-1],
    "not aligned": not_aligned,
    "not aligned, order of Fortran": lambda q: not_aligned(np.ascontiguousarray(q.T)).T,
    "buffer at an odd place": lambda q: np.frombuffer(b"x" + q.tobytes(), "f8", offset=1).reshape(q.shape),
}


def laid_out(name):
    def body(trial):
        value = attempt(trial, lambda: torques(LAYOUTS[name](STATES)))
        if is_refused(value):
            trial.fault(f"it is refused: {value}")
        elif not np.array_equal(value, one_by_one(STATES)):
            trial.fault("another answer than state by state")

    return body


for name in LAYOUTS:
    case(f"layout: {name}", laid_out(name))


def masked(trial):
    """What a mask hides is not there: as null in Arrow and Polars it is refused, never computed with."""
    for mask in ([0, 0, 1, 0, 0, 0], [1] * 6):
        value = attempt(trial, lambda mask=mask: torques(np.ma.masked_array(np.ones(6), mask)))
        if not is_refused(value):
            trial.fault(f"it computes with masked numbers: {value}")
    states = np.ma.masked_array(np.ones((20, 6)), np.eye(20, 6))
    if not is_refused(attempt(trial, lambda: torques(states))):
        trial.fault("it computes with masked numbers of many states")


def mask_of_nothing(trial):
    value = attempt(trial, lambda: torques(np.ma.masked_array(np.ones(6), [0] * 6)))
    if not is_refused(value) and not np.array_equal(value, torques(np.ones(6))):
        trial.fault("another answer than without the mask")


case("masked numbers", masked)
case("a mask that hides nothing", mask_of_nothing)


# `out`.
def read_only():
    array = np.empty((257, 6))
    array.setflags(write=False)
    return array


OUTPUTS = {
    "fits": lambda q: np.empty((257, 6)),
    "a row less": lambda q: np.empty((256, 6)),
    "f4": lambda q: np.empty((257, 6), "f4"),
    "order of Fortran": lambda q: np.empty((257, 6), order="F"),
    "read-only": lambda q: read_only(),
    "strides": lambda q: np.empty((257, 12))[:, ::2],
    "list": lambda q: [[0.0] * 6] * 257,
    "the input": lambda q: q,
    "a view of the input": lambda q: q[:],
    "the input reversed": lambda q: q[::-1],
    "None": lambda q: None,
    "not aligned": lambda q: not_aligned(np.zeros((257, 6))),
    "big-endian": lambda q: np.empty((257, 6), ">f8"),
    "one row often": lambda q: np.broadcast_to(np.empty(6), (257, 6)),
    "no axis": lambda q: np.empty(()),
    "masked": lambda q: np.ma.masked_array(np.zeros((257, 6)), np.ones((257, 6))),
}


def given_out(name):
    def body(trial):
        states = STATES.copy()
        value = attempt(trial, lambda: torques(states, out=OUTPUTS[name](states)))
        if not np.array_equal(states, STATES):
            trial.fault("the input is written to")
        if not is_refused(value) and not np.array_equal(np.asarray(value), one_by_one(STATES)):
            trial.fault("another answer than state by state")

    return body


for name in OUTPUTS:
    case(f"out: {name}", given_out(name))


def overlapping(shift):
    """Input and output are parts of one memory, which has two owners, so that numpy's own books do not tell."""

    def body(trial):
        memory = bytearray((STATES.size + 6) * 8)
        first, last = (0, shift) if shift >= 0 else (-shift, 0)
        size = STATES.size * 8
        q = np.asarray(memoryview(memory))[first : first + size].view("f8").reshape(STATES.shape)
        out = np.asarray(memoryview(memory))[last : last + size].view("f8").reshape(STATES.shape)
        q[:] = STATES
        value = attempt(trial, lambda: torques(q, out=out))
        if not is_refused(value):
            trial.fault("it computes into the memory that it reads")

    return body


for shift in (0, 8, 48, -8, -48):
    case(f"out: {shift} bytes from the input, by another owner", overlapping(shift))


def beside(trial):
    """Input and output share a memory and do not overlap: this is right."""
    size = STATES.size * 8
    memory = bytearray(2 * size)
    q = np.asarray(memoryview(memory))[:size].view("f8").reshape(STATES.shape)
    out = np.asarray(memoryview(memory))[size:].view("f8").reshape(STATES.shape)
    q[:] = STATES
    value = attempt(trial, lambda: torques(q, out=out))
    if is_refused(value) or not np.array_equal(out, one_by_one(STATES)):
        trial.fault(f"it is refused or wrong: {value if is_refused(value) else 'another answer'}")


case("out: beside the input in one memory", beside)


# Robot files, names and options.
def planar():
    return rne.robots["planar2"]


LOADED = {
    "nothing": lambda: "",
    "a blank": lambda: " ",
    "a zero byte": lambda: "a\0b",
    "a zero byte in a robot": lambda: planar().yaml.replace("planar", "\0"),
    "a long path": lambda: "x" * 5000,
    "a line break": lambda: "\n",
    "the begin of XML": lambda: "<",
    "a brace": lambda: "{",
    "bytes": lambda: b"x",
    "a number": lambda: 5,
    "None": lambda: None,
    "a missing path": lambda: pathlib.Path("/missing"),
    "a folder": lambda: "/tmp",
    "a device": lambda: "/dev/zero",
    "half a letter": lambda: "\ud800\n",
    "a bomb of aliases": lambda: BOMB,
    "deep lists": lambda: "[" * 100_000 + "\n",
    "deep XML": lambda: "<a>" * 100_000,
    "entities": lambda: "<!DOCTYPE r [<!ENTITY a 'x'>]><robot name='&a;'/>",
    "10 MB": lambda: planar().yaml + "#" * (10 << 20),
    "a path that is no UTF-8": lambda: os.fsdecode(b"/tmp/\xff"),
}
for name, source in LOADED.items():
    case(f"load: {name}", lambda trial, source=source: attempt(trial, lambda: rne.load(source())))
OPTIONS = {
    "form": {"form": "x"},
    "convention": {"convention": "x"},
    "run_time": {"run_time": ["zz"]},
    "run_time as a text": {"run_time": "abc"},
    "settings": {"settings": {"zz": 1.0}},
    "settings NaN": {"settings": {"zz": math.nan}},
    "lock": {"lock": {"a": 1.0}},
    "tip": {"tip": "x"},
    "tip and base": {"tip": "x", "base": "y", "lock_others": True},
}
for name, more in OPTIONS.items():
    case(f"load with {name}", lambda trial, more=more: attempt(trial, lambda: rne.load(planar().yaml, **more)))
for name in ("", "x", "../puma560", "\0", "puma560 ", "PUMA560", "\xe9" * 1000):

    def by_name(trial, name=name):
        attempt(trial, lambda: rne.robots[name])
        attempt(trial, lambda: getattr(rne.robots, name))

    case(f"robot {name[:20]!r}", by_name)
CALLS = {
    "payload of a text": lambda: rne.payload("x"),
    "payload with a centre of two": lambda: rne.payload(1, [0, 0]),
    "payload with a tensor of two": lambda: rne.payload(1, [0, 0, 0], np.zeros((2, 2))),
    "payload with a tensor that is not symmetric": lambda: rne.payload(1, [0, 0, 0], np.arange(9).reshape(3, 3)),
    "operations of nothing": lambda: puma().operations("x"),
    "show nothing": lambda: puma().show("x"),
    **{f"show joint {joint}": lambda joint=joint: puma().show(joint=joint) for joint in (0, 99, -1, 1 << 64)},
    "code of nothing": lambda: puma().code("x"),
    "code in no language": lambda: puma().code(lang="x"),
    "diagnose NaN": lambda: puma().diagnose(ZEROS, ZEROS, ZEROS, np.full(6, np.nan)),
    "diagnose 5 numbers": lambda: puma().diagnose(ZEROS, ZEROS, ZEROS, np.zeros(5)),
    "search for -1 s": lambda: planar().search(seconds=-1),
    "search for NaN": lambda: planar().search(seconds=math.nan),
    "search for 0 s": lambda: planar().search(seconds=0),
    "an arm of nothing": rne.Arm,
    "another number of joints": lambda: setattr(puma(), "dof", 5),
    "hash": lambda: hash(puma()),
    "pickle": lambda: pickle.loads(pickle.dumps(planar())).gravity_torques([0, 0]),
    "pickle of another name": lambda: pickle.loads(pickle.dumps(planar()).replace(b"planar2", b"planarX")),
    "copy": lambda: copy.deepcopy(planar()),
    "equal": lambda: planar() == planar(),
    "repr": lambda: repr(puma()),
}
for name, work in CALLS.items():
    case(name, lambda trial, work=work: attempt(trial, work))


def refused_payload(mass):
    """A payload is heavy or nothing at all: the command line, the C library and Python say so alike."""

    def body(trial):
        by_helper = attempt(trial, lambda: rne.payload(mass))
        load = np.zeros(10)
        load[0] = mass
        by_numbers = attempt(trial, lambda: puma().inverse_dynamics_with_payload(ZEROS, ZEROS, ZEROS, load))
        if not is_refused(by_numbers):
            trial.fault(f"it computes with a payload of {mass} kg: {by_numbers}; rne.payload: {by_helper!r}")

    return body


case("payload of -1 kg", refused_payload(-1.0))


# Pages of notebooks.
class Page(html.parser.HTMLParser):
    """The tags of a page, and its attributes that run something."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.handlers = {}, []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.tags[tag] = self.tags.get(tag, 0) + 1
        self.handlers += [name for name, value in attributes if name.startswith("on") or "javascript" in (value or "")]


ACTIVE = (
    "</script><script>alert(1)</script>",
    "<img src=x onerror=alert(1)>",
    '"><svg onload=alert(1)>',
    "' onmouseover=alert(1) x='",
    "&lt;script&gt;",
    "<!--",
    "</pre><b>",
    "{{data}}",
    "$\\href{javascript:alert(1)}{x}$",
    "![](javascript:alert(1))",
)


def yaml_with(key, text):
    """The arm of two joints with a text for a key, or for the name of its first joint."""
    yaml, quoted = planar().yaml, json.dumps(text)
    if key == "joint":
        named = yaml.replace("  - type", f"  - name: {quoted}\n    type", 1)
        return named.replace("  - {type", "  - {name: " + quoted + ", type", 1)
    rest = [line for line in yaml.splitlines() if not line.startswith(key + ":")]
    return f"{key}: {quoted}\n" + "\n".join(rest) + "\n"


def notebook(key, text):
    def body(trial):
        arm = attempt(trial, lambda: rne.load(yaml_with(key, text)))
        if is_refused(arm):
            return
        page, harmless = Page(arm._repr_html_()), Page(planar()._repr_html_())
        if page.tags != harmless.tags or page.handlers:
            trial.fault(f"its picture has other tags: {set(page.tags.items()) ^ set(harmless.tags.items())}")
        if handlers := Page(arm.report()).handlers:
            trial.fault(f"its report runs something: {handlers}")

    return body


for text in ACTIVE:
    for key in ("title", "source", "name", "joint"):
        case(f"notebook: {key} {text}", notebook(key, text))


# Threads and children.
MANY = 200_000


def many():
    return np.random.default_rng(2).normal(size=(MANY, 6))


def one_arm_in_threads(trial):
    arm, states, wrong = puma(), many(), []
    expected = arm.gravity_torques(states)

    def work(number):
        for _ in range(5):
            if number % 2:
                rne.load(planar().yaml).mass_matrix(np.zeros((1000, 2)))
            elif not np.array_equal(arm.gravity_torques(states), expected):
                wrong.append(number)

    in_threads(work, 8)
    if wrong:
        trial.fault(f"another answer in threads {wrong}")


def in_threads(work, count):
    threads = [threading.Thread(target=work, args=(number,)) for number in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def one_output_in_threads(trial):
    arm, states = puma(), many()
    expected = arm.gravity_torques(states)
    out = np.empty_like(expected)

    def work(number):
        for _ in range(10):
            attempt(trial, lambda: arm.gravity_torques(states, out=out))

    in_threads(work, 4)
    if not np.array_equal(out, expected):
        trial.fault("another answer")


def many_arms(trial):
    rne.load(planar().yaml).mass_matrix([0.1, 0.2])
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for _ in range(300):
        rne.load(planar().yaml).mass_matrix([0.1, 0.2])
    gc.collect()
    more = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) // 1024
    if more > 50:
        trial.fault(f"300 arms that are gone keep {more} MB")


def forked(count, before):
    """A child is forked after so many states were computed at once, as by `multiprocessing` and by loaders of data."""

    def body(trial):
        arm, states = puma(), many()[:count]
        expected = arm.gravity_torques(states[: count if before else 1])
        child = os.fork()
        if child == 0:
            answer = arm.gravity_torques(states)
            os._exit(0 if not before or np.array_equal(answer, expected) else 1)
        hangs, status, _ = harness.wait(child, CLOCK / 3)
        if hangs:
            trial.fault("a child that forks after a batch does not end")
        elif status != 0:
            trial.fault(f"a child that forks has another answer: status {status}")

    return body


case("one arm in eight threads", one_arm_in_threads)
case("one output in four threads", one_output_in_threads)
case("300 arms", many_arms)
case("a child forks after a few states", forked(100, before=True))
case("a child forks after a batch", forked(MANY, before=True))
case("a child forks before any batch", forked(MANY, before=False))

if __name__ == "__main__":
    harness.main(CASES)
