"""Logs as arrays of numpy: headers that lie, nest or claim too much."""

import math
import struct

import harness
from logs import read_by_all, state

CASES = harness.Cases()
NUMBERS = [x for i in range(400) for x in [i * 0.01, *state(i * 0.01)]]
BODY = struct.pack(f"<{len(NUMBERS)}d", *NUMBERS)


def head(shape="(400, 7)", descr="'<f8'", order="False", version=1, length=None, raw=None):
    """The header of a file; `raw` replaces its dictionary, `length` what it says of its length."""
    text = f"{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}" if raw is None else raw
    text = text.encode("latin-1", "replace")
    size = 10 if version == 1 else 12
    text += b" " * (-(size + len(text) + 1) % 64) + b"\n"
    length = len(text) if length is None else length
    width = struct.pack("<H", length & 0xFFFF) if version == 1 else struct.pack("<I", length)
    return b"\x93NUMPY" + bytes([version, 0]) + width + text


def npy(name, data, expected="any", says=(), options=(), **more):
    CASES.add(name, lambda trial: read_by_all(trial, "log.npy", data, expected, says, options=options, **more))


def dictionary(descr="'<f8'", shape="(400, 7)"):
    return f"{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}}}"


def nested(depth, leaf="'<f8'"):
    return "[('a', " * depth + leaf + ")]" * depth


npy("good", head() + BODY, "taken")
npy("version 2", head(version=2) + BODY, "taken")
npy("version 3", head(version=3) + BODY, "taken")
npy("version 9", head(version=9) + BODY)

# Kinds of numbers.
npy("big-endian", head(descr="'>f8'") + struct.pack(f">{len(NUMBERS)}d", *NUMBERS), "taken")
npy("f4", head(descr="'<f4'") + struct.pack(f"<{len(NUMBERS)}f", *NUMBERS), "taken")
npy("native order", head(descr="'=f8'") + BODY)
for descr in ("<f2", "<f16", "<i8", "<c16", "|b1", "<U10", "<M8[ns]", "|V8"):
    npy(f"kind {descr}", head(descr=f"'{descr}'") + BODY * 2, "bad")
PICKLE = b"\x80\x04\x95" + b"cos\nsystem\n(S'touch pwned'\ntR." * 9
npy("pickled objects", head(descr="'|O'") + PICKLE, "bad")
npy("structured", head(descr="[('t', '<f8'), ('q', '<f8', (2,))]", shape="(400,)") + BODY, "bad")
npy("structured, two axes", head(descr="[('t', '<f8')]") + BODY, "bad")
npy("order of Fortran", head(order="True") + BODY, "bad", ["Fortran"])
npy("order of Fortran, one column", head(order="True", shape="(400, 1)") + BODY)

# Shapes.
npy("shape of 2 GB", head("(40000000, 7)") + BODY, "bad", ["cut off"])
for shape in (
    "(100000000000000000, 7)",
    "(4294967296, 4294967296)",
    "(-1, 7)",
    "(0, 7)",
    "(0, 4611686018427387904)",
    "(2800,)",
    "()",
    "(40, 10, 7)",
    "(4e2, 7)",
):
    npy(f"shape {shape}", head(shape) + BODY, "bad")
for shape in ("(0x190, 7)", "(400L, 7L)"):
    npy(f"shape {shape}", head(shape) + BODY)
npy("shape (400, 0)", head("(400, 0)") + BODY, "refused")
npy("shape (350, 8)", head("(350, 8)") + BODY, "refused")
npy("one row", head("(1, 7)") + BODY, "bad")
npy("1025 joints", head("(10, 1025)") + bytes(8 * 10250), "refused", options=["--columns=q", "--rate=100"])
npy("no shape", head(raw="{'descr': '<f8', 'fortran_order': False}") + BODY, "bad")
npy("two shapes", head(raw=dictionary()[:-1] + ", 'shape': (1, 1)}") + BODY)

# Headers. Those that nest must not take time that grows with more than their length.
npy("header of 4 GB", head(version=2, length=0xFFFFFFFF) + BODY, "bad")
npy("header of 64 kB of blanks", head(version=2, raw=dictionary() + " " * 65000) + BODY)
for depth in (2, 6, 8, 10, 12, 20, 5000):
    npy(f"kinds nested {depth} deep", head(version=2, raw=dictionary(nested(depth))) + BODY, "bad", everywhere=True)
npy("192 bytes that nest 12 deep", head(raw=dictionary(nested(12), "(1, 1)"))[:192], "bad", everywhere=True)
npy("shape nested 30 deep", head("(" * 30 + "400, 7" + ")" * 30) + BODY)
npy("dictionaries nested 12 deep", head(raw="{'a': " * 12 + "1" + "}" * 12) + BODY, "bad", everywhere=True)
npy("60000 open parentheses", head(version=2, raw="(" * 60000) + BODY, "bad", everywhere=True)
npy("header that is no UTF-8", head(raw=dictionary("'\xff'")) + BODY, "bad")
npy("header of Python code", head(raw="__import__('os').system('touch pwned')") + BODY, "bad")
npy("empty header", b"\x93NUMPY\x01\x00\x00\x00" + BODY, "bad")
npy("magic alone", b"\x93NUMPY", "bad")
npy("magic and a half", b"\x93NUMPY\x01", "bad")

# Bodies.
npy("cut inside a row", head() + BODY[:-5], "bad", ["cut off"])
npy("cut after a row", head() + BODY[:-56], "bad", ["cut off"])
npy("twice as long", head() + BODY + BODY)
npy("NaN", head() + struct.pack("<d", math.nan) * 2800, "bad")
npy("gzip", b"\x1f\x8b" + BODY, "bad", ["gzip"])
npy("npz", b"PK\x03\x04" + BODY, "bad", ["zip"])
STEPS = [[float(i), *state(i * 1e-3)] for i in range(400)]
MILLISECONDS = struct.pack("<2800d", *[x for row in STEPS for x in row])
npy("whole milliseconds at 1 kHz", head() + MILLISECONDS, "refused", ["time-unit"], everywhere=True)

# What the columns are said to be.
npy("columns time, q, qd, tau", head() + BODY, "taken", options=["--columns=time,q,qd,tau"])
for columns in ("q,q", "x", "", "time,tau"):
    npy(f"columns {columns!r}", head() + BODY, "refused", options=[f"--columns={columns}"])
npy("columns 'q' and a rate", head() + BODY, options=["--columns=q", "--rate=100"])

if __name__ == "__main__":
    harness.main(CASES)
