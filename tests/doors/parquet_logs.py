"""Logs in Parquet: kinds of columns, lists of any length, two arms in one table, and files with noise."""

import csv
import decimal
import random
import struct

import numpy
import pyarrow
import pyarrow.parquet

try:
    import polars
except ImportError:
    polars = None

import harness
from logs import READERS, arm, read_by_all

CASES = harness.Cases()
N = 400
T = numpy.arange(N) * 0.01
COLUMNS = {
    "t": T,
    "q1": numpy.sin(T),
    "q2": numpy.cos(1.3 * T),
    "qd1": numpy.cos(T),
    "qd2": -1.3 * numpy.sin(1.3 * T),
    "tau1": 5 + numpy.sin(2 * T),
    "tau2": 3 + numpy.cos(2 * T),
}
COUNT = numpy.arange(N)
NANOSECONDS = COUNT * 10_000_000
IDENTIFY = {"identify": READERS["identify"]}


def table(**changes):
    """The table of one column each, with some columns replaced, added, or removed by None."""
    columns = {**COLUMNS, **changes}
    return pyarrow.table({name: column for name, column in columns.items() if column is not None})


FLOAT = pyarrow.float64()


def pairs(first, second, kind=FLOAT, length=-1):
    return pyarrow.array(numpy.stack([first, second], 1).tolist(), pyarrow.list_(kind, length))


def lists(**changes):
    """The table of lists, with some columns replaced, added, or removed by None."""
    columns = {
        "t": T,
        "position": pairs(COLUMNS["q1"], COLUMNS["q2"]),
        "velocity": pairs(COLUMNS["qd1"], COLUMNS["qd2"]),
        "effort": pairs(COLUMNS["tau1"], COLUMNS["tau2"]),
        "name": pyarrow.array([["a", "b"]] * N),
        **changes,
    }
    return pyarrow.table({name: column for name, column in columns.items() if column is not None})


def parquet(name, make, expected="any", says=(), options=(), never=(), everywhere=False, **written):
    """A case of a table, which a function makes; `written` is how pyarrow writes it."""

    def write(path):
        pyarrow.parquet.write_table(make(), path, **written)

    CASES.add(
        name,
        lambda trial: read_by_all(
            trial, "log.parquet", write, expected, says, never, options, everywhere, readers=IDENTIFY
        ),
    )


def column(name, make, expected="any", says=(), options=(), to="q1", **more):
    """A case of the table with one column replaced."""
    parquet(name, lambda: table(**{to: make()}), expected, says, options, **more)


# How the file is written.
parquet("good", table, "taken")
parquet("lists", lists, "taken")
for codec in ("snappy", "gzip", "zstd", "lz4", "none"):
    parquet(f"compressed by {codec}", table, "taken", compression=codec)
# A compression that is not read is no damage of the file.
parquet("compressed by brotli", table, never=["corrupt", "cut off"], compression="brotli")
parquet("lists compressed by brotli", lists, never=["corrupt", "cut off"], compression="brotli")
parquet("pages of version 2", table, "taken", data_page_version="2.0")
parquet("no dictionary", table, "taken", use_dictionary=False)
parquet("bytes in streams", table, use_dictionary=False, use_byte_stream_split=True)
parquet("version 1.0", table, "taken", version="1.0")
column(
    "differences",
    lambda: NANOSECONDS,
    options=["--time-unit", "ns"],
    to="t",
    use_dictionary=False,
    column_encoding={"t": "DELTA_BINARY_PACKED"},
)
for rows in (1, 7):
    parquet(f"groups of {rows} rows", table, "taken", row_group_size=rows)
parquet("lists, groups of 3 rows", lists, "taken", row_group_size=3)
parquet("lists, small pages", lists, "taken", data_page_size=100, use_dictionary=False)
parquet("no rows", lambda: table().slice(0, 0), "bad")
parquet("one row", lambda: table().slice(0, 1), "bad")
parquet("no columns", lambda: pyarrow.table({}), "bad")

# Kinds of positions.
column("position f4", lambda: COLUMNS["q1"].astype("f4"), "taken")
column("position f2", lambda: COLUMNS["q1"].astype("f2"), "bad")
for kind in ("i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8"):
    column(f"position {kind}", lambda kind=kind: (COUNT % 100).astype(kind))
PRICES = [decimal.Decimal(i) / 100 for i in range(N)]
column("position decimal of 10 digits", lambda: pyarrow.array(PRICES, pyarrow.decimal128(10, 2)), "bad")
column(
    "position decimal of 9 digits",
    lambda: pyarrow.array(PRICES, pyarrow.decimal128(9, 2)),
    "bad",
    store_decimal_as_integer=True,
)
column("position a text", lambda: pyarrow.array([str(t) for t in T]), "bad")
column("position a truth", lambda: pyarrow.array([True] * N), "bad")
column("position bytes", lambda: pyarrow.array([b"x"] * N), "bad")
column("position nothing", lambda: pyarrow.nulls(N), "bad")
column("position of a dictionary", lambda: pyarrow.array(COLUMNS["q1"]).dictionary_encode())
column("position null in some", lambda: pyarrow.array([None if i % 9 == 0 else i * 0.01 for i in range(N)]))
column("position null", lambda: pyarrow.array([None] * N, pyarrow.float64()), "bad")
column("position NaN", lambda: numpy.full(N, numpy.nan), "bad")
column("torque infinite", lambda: numpy.full(N, numpy.inf), to="tau1")
parquet(
    "structure", lambda: pyarrow.table({"t": T, "j": pyarrow.array([{"q1": 0.1 * i, "q2": 0.2} for i in range(N)])})
)
parquet(
    "map",
    lambda: pyarrow.table(
        {"t": T, "position": pyarrow.array([[("a", 0.1)]] * N, pyarrow.map_(pyarrow.string(), pyarrow.float64()))}
    ),
)


# Unsigned numbers beyond half their range: right, or refused.
def beyond_half_the_range(trial):
    """Positions of 4,000,000,000 and more as u4: read as signed they would be negative."""
    positions = pyarrow.array((COUNT + 4_000_000_000).astype("u4"))
    log = trial.write("log.parquet", lambda path: pyarrow.parquet.write_table(table(q1=positions), path))
    trial.rne("log", log, names="log.parquet", never=["-2949", "-2.9", "-294"])


CASES.add("position u4 beyond 2^31", beyond_half_the_range)
MS, NS = ["--time-unit", "ms"], ["--time-unit", "ns"]
column(
    "time u4 across 2^31",
    lambda: (COUNT * 10 + 2**31 - 2000).astype("u4"),
    "taken",
    ["400 of 400"],
    MS,
    to="t",
    never=["back"],
)
column(
    "time u4 beyond 2^31",
    lambda: (COUNT * 10 + 2**31 + 2000).astype("u4"),
    "taken",
    ["400 of 400"],
    MS,
    to="t",
    never=["back"],
)
column(
    "time u8 across 2^63",
    lambda: (COUNT.astype("u8") * 10_000_000 + 2**63 - 2_000_000_000).astype("u8"),
    options=NS,
    to="t",
    never=["back"],
)

# Times.
PER_SECOND = {"s": 1, "ms": 10, "us": 10_000, "ns": 10_000_000}
for unit, step in PER_SECOND.items():
    column(
        f"stamp in {unit}", lambda unit=unit, step=step: pyarrow.array(COUNT * step, pyarrow.timestamp(unit)), to="t"
    )
column(
    "stamp with a time zone",
    lambda: pyarrow.array(COUNT * 10, pyarrow.timestamp("ms", "Europe/Berlin")),
    "taken",
    to="t",
)
column(
    "stamp of 96 bits",
    lambda: pyarrow.array(NANOSECONDS, pyarrow.timestamp("ns")),
    to="t",
    use_deprecated_int96_timestamps=True,
)
column("date", lambda: pyarrow.array(COUNT.astype("i4"), pyarrow.date32()), "bad", to="t")
column("time of day", lambda: pyarrow.array(COUNT.astype("i4") * 10, pyarrow.time32("ms")), to="t")
column("duration", lambda: pyarrow.array(COUNT * 10, pyarrow.duration("ms")), to="t")
column("time a text", lambda: pyarrow.array([str(t) for t in T]), "bad", to="t")
LEAST = numpy.iinfo("i8").min
column("stamp the least", lambda: pyarrow.array(NANOSECONDS + LEAST, pyarrow.timestamp("ns")), to="t")
column("time beyond 64 bits of ns", lambda: COUNT + 2**62, "bad", options=["--time-unit", "s"], to="t")
column(
    "stamp null",
    lambda: pyarrow.array([None if i == 7 else i * 10 for i in range(N)], pyarrow.timestamp("ms")),
    "bad",
    ["row 7"],
    to="t",
)
column("time null", lambda: pyarrow.array([None if i == 7 else i * 0.01 for i in range(N)]), "bad", ["row 7"], to="t")
column("time NaN", lambda: numpy.where(T == 0.05, numpy.nan, T), "bad", to="t")
for kind in ("f8", "i4", "i8", "u4", "u8"):
    column(
        f"time {kind} of whole milliseconds at 1 kHz",
        lambda kind=kind: COUNT.astype(kind),
        "refused",
        ["time-unit"],
        to="t",
        everywhere=True,
    )

# Lists.
SOME = [i % 7 == 3 for i in range(N)]
for what, kind, expected in (
    ("null rows", [None if some else [0.1, 0.2] for some in SOME], "any"),
    ("empty rows", [[] if some else [0.1, 0.2] for some in SOME], "any"),
    ("null in some rows", [[None, 0.2] if some else [0.1 * i, 0.2] for i, some in enumerate(SOME)], "any"),
    ("null in each row", [[None, 0.2]] * N, "any"),
    ("another length in some rows", [[0.1] if some else [0.1, 0.2] for some in SOME], "any"),
    ("lists in lists", [[[0.1, 0.2]]] * N, "any"),
    ("texts", [["0.1", "0.2"]] * N, "any"),
    ("integers", [[1, 2]] * N, "any"),
):
    parquet(f"lists, {what}", lambda kind=kind: lists(position=pyarrow.array(kind)), expected)
Q = COLUMNS["q1"], COLUMNS["q2"]
parquet("lists of f4", lambda: lists(position=pairs(*Q, pyarrow.float32())), "taken")
parquet("lists of fixed length", lambda: lists(position=pairs(*Q, length=2)), "taken")
parquet("lists of 64 bits", lambda: lists(position=pairs(*Q).cast(pyarrow.large_list(pyarrow.float64()))), "taken")
parquet("lists without names", lambda: lists(name=None))
for what, names, expected in (
    ("of three joints", [["a", "b", "c"]] * N, "bad"),
    ("twice the same", [["a", "a"]] * N, "bad"),
    ("null", [[None, "b"]] * N, "any"),
    ("of codes of terminals", [["\x1b[2J", "\x1b]0;x\x07"]] * N, "any"),
    ("of codes of colours", [["\x1b[8mhidden", "\x1b[31mred"]] * N, "any"),
    ("of 10 kB", [["a" * 10_000, "b"]] * N, "any"),
):
    parquet(f"names {what}", lambda names=names: lists(name=pyarrow.array(names)), expected)


def turned(first, second):
    """Pairs in another order in every second row."""
    return pyarrow.array([[x, y] if i % 2 else [y, x] for i, (x, y) in enumerate(zip(first, second, strict=True))])


def turned_lists():
    pairs_of = {"position": ("q1", "q2"), "velocity": ("qd1", "qd2"), "effort": ("tau1", "tau2")}
    columns = {name: turned(COLUMNS[first], COLUMNS[second]) for name, (first, second) in pairs_of.items()}
    return lists(**columns, name=turned(["a"] * N, ["b"] * N))


parquet("names in another order in every second row", turned_lists, "taken")
DICTIONARY = pyarrow.list_(pyarrow.dictionary(pyarrow.int32(), pyarrow.string()))
parquet("names of a dictionary", lambda: lists(name=pyarrow.array([["a", "b"]] * N, DICTIONARY)))

# Small files that are large once they are read.
POSITION_ALONE = {"velocity": None, "effort": None, "name": None}


def of_lengths(lengths):
    """A table whose lists of zeros have these lengths."""
    ends = numpy.concatenate([[0], numpy.cumsum(lengths)]).astype("i4")
    return lists(position=pyarrow.ListArray.from_arrays(ends, pyarrow.array(numpy.zeros(ends[-1]))), **POSITION_ALONE)


def long_name():
    words = pyarrow.DictionaryArray.from_arrays(pyarrow.array([0, 1] * N, pyarrow.int32()), ["a" * 10_000_000, "b"])
    return lists(name=pyarrow.ListArray.from_arrays((numpy.arange(N + 1) * 2).astype("i4"), words))


parquet("lists of 2000 numbers", lambda: of_lengths([2000] * N), "refused", everywhere=True)
parquet("lists of 200000 numbers", lambda: of_lengths([200_000] * N), "refused", everywhere=True)
parquet("one list of 50 million numbers", lambda: of_lengths([50_000_000] + [2] * (N - 1)), "refused", everywhere=True)
parquet("one list of 2000 numbers late", lambda: of_lengths([2] * 300 + [2000] + [2] * 99), "refused", everywhere=True)
parquet("name of 10 MB in each row", long_name)
parquet(
    "10000 columns",
    lambda: pyarrow.table({"t": T[:100], **{f"q{i}": numpy.zeros(100) for i in range(1, 10_001)}}),
    "refused",
    everywhere=True,
)
MILLIONS = 20_000_000


def millions_of_rows():
    zeros = numpy.zeros(MILLIONS)
    return pyarrow.table({"t": numpy.arange(MILLIONS) * 1e-3, "q1": zeros, "q2": zeros})


def long_table(trial):
    log = trial.write("log.parquet", lambda path: pyarrow.parquet.write_table(millions_of_rows(), path))
    trial.rne("log", log, seconds=120, clock=600)


CASES.add("20 million rows", long_table)

# Names of columns.
for what, name in (
    ("a code of terminals", "\x1b[2J"),
    ("a code of colours", "\x1b[8mhidden"),
    ("HTML", "<script>"),
    ("a zero byte", "a\0b"),
):
    parquet(f"column of {what}", lambda name=name: table(**{f"{name}/position": T}))

# Two arms in one table: each has its own names, order and clock.
LEFT, RIGHT = pyarrow.array([["j1", "j2"]] * N), pyarrow.array([["j2", "j1"]] * N)


def two_arms(**more):
    columns = {
        "left.name": LEFT,
        "left.position": pairs(numpy.sin(T), numpy.cos(T)),
        "right.name": RIGHT,
        "right.position": pairs(numpy.sin(T) + 20, numpy.cos(T) - 20),
    }
    return pyarrow.table({**({} if "left.stamp" in more else {"t": T}), **columns, **more})


def filtered(trial, log, *options):
    """What `rne log -o` writes for a log, by columns; None where it refuses."""
    answer = trial.rne("log", log, *options, "-o", "out.csv", writes=["out.csv"], names="log.parquet")
    if answer.status != 0:
        return None
    with open(trial.folder / "out.csv", newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    letters = {"position": "q", "velocity": "qd", "acceleration": "qdd", "effort": "tau"}
    columns = {}
    for name in rows[0]:
        column = numpy.array([float(row[name]) for row in rows if row[name]])
        # `a.position` of the first joint is q1
        if of := letters.get(name.rpartition(".")[2]):
            name = next(f"{of}{joint}" for joint in range(1, 1000) if f"{of}{joint}" not in columns)
        columns[name] = column
    return columns


def names_of_the_right_arm(trial):
    """The joint `j1` of the right arm is its second: near -20, not near 20."""
    log = trial.write("log.parquet", lambda path: pyarrow.parquet.write_table(two_arms(), path))
    columns = filtered(trial, log, "--topic", "right", "--joints", "j1,j2")
    positions = columns and [c for name, c in columns.items() if name.startswith("q") and name[1:].isdigit()]
    if positions and not (numpy.all(positions[0] < 0) and numpy.all(positions[1] > 0)):
        trial.fault("rne log --topic right: the positions stand under the names of the left arm")


def clock_of_the_right_arm(trial, kind):
    """The left arm is logged at 50 Hz, the right one at 100 Hz."""
    clocks = {"left.stamp": T * 2, "right.stamp": T}
    if kind == "lists":
        arms = two_arms(**clocks)
    else:
        joints = {f"{side}.q{k}": numpy.sin(T + k) for side in ("left", "right") for k in (1, 2)}
        arms = pyarrow.table({**clocks, **joints})
    log = trial.write("log.parquet", lambda path: pyarrow.parquet.write_table(arms, path))
    columns = filtered(trial, log, "--topic", "right")
    # 4 s of the right arm or 8 s of the left one, and the filter takes 0.8 s of both ends
    if columns and not 2 < columns["t"][-1] - columns["t"][0] < 4.5:
        trial.fault(f"rne log --topic right, {kind}: the times are those of the left arm")


CASES.add("two arms, names of the right one", names_of_the_right_arm)
for kind in ("lists", "columns"):
    CASES.add(
        f"two arms, clock of the right one, {kind}", lambda trial, kind=kind: clock_of_the_right_arm(trial, kind)
    )
parquet("two arms", two_arms, "refused")

# A motion that is written: other readers find the numbers of CSV in it.


def motion_for_others(trial, make, is_stamped):
    log = trial.write("log.parquet", lambda path: pyarrow.parquet.write_table(make(), path))
    columns = filtered(trial, log)
    trial.rne("log", log, "-o", "motion.parquet", writes=["motion.parquet"], names="log.parquet", expected="taken")
    motion = pyarrow.parquet.read_table(trial.folder / "motion.parquet")
    for quantity in ("q", "qd", "qdd", "tau"):
        lists = numpy.array(motion[quantity].to_pylist()).T
        if not all(numpy.array_equal(lists[joint], columns[f"{quantity}{joint + 1}"]) for joint in (0, 1)):
            trial.fault(f"rne log -o motion.parquet: {quantity} is not that of CSV")
    if set(map(tuple, motion["name"].to_pylist())) != {("a", "b")} or set(motion["run"].to_pylist()) != {1}:
        trial.fault("rne log -o motion.parquet: the names of joints or the numbers of runs are wrong")
    time = motion["time"]
    if is_stamped != pyarrow.types.is_timestamp(time.type):
        trial.fault(f"rne log -o motion.parquet: times are {time.type}")
    seconds = time.cast(pyarrow.int64()).to_numpy() * 1e-9 - 1.7e9 if is_stamped else time.to_numpy()
    if not numpy.allclose(seconds, columns["t"], rtol=0, atol=1e-6):
        trial.fault("rne log -o motion.parquet: times are not those of CSV")
    if polars and polars.read_parquet(trial.folder / "motion.parquet")["q"].to_list() != motion["q"].to_pylist():
        trial.fault("polars reads other positions")


STAMPS = pyarrow.array(NANOSECONDS + 1_700_000_000_000_000_000, pyarrow.timestamp("ns"))
CASES.add("motion for other readers", lambda trial: motion_for_others(trial, lists, False))
CASES.add("motion with stamps", lambda trial: motion_for_others(trial, lambda: lists(t=STAMPS), True))

# Files with noise.


def bytes_of(make):
    sink = pyarrow.BufferOutputStream()
    pyarrow.parquet.write_table(make(), sink)
    return sink.getvalue().to_pybytes()


GOOD, LISTS = bytes_of(table), bytes_of(lists)


def raw(name, data, expected="any"):
    def body(trial):
        trial.write("arm.yaml", arm())
        trial.rne("log", trial.write("log.parquet", data), expected=expected, names="log.parquet")

    CASES.add(name, body)


def footer(data, length=None):
    return b"PAR1" + data + struct.pack("<I", len(data) if length is None else length) + b"PAR1"


raw("magic", b"PAR1", "bad")
raw("magic twice", b"PAR1PAR1", "bad")
raw("encrypted", b"PARE" + GOOD[4:])
raw("cut", GOOD[:-100], "bad")
raw("half", GOOD[: len(GOOD) // 2], "bad")
for length in (0, 2**31 - 1, 2**32 - 1):
    raw(f"footer of length {length}", GOOD[:-8] + struct.pack("<I", length) + b"PAR1", "bad")
raw("footer of zeros", footer(bytes(1000)), "bad")
raw("footer of ones", footer(b"\xff" * 1000), "bad")
raw("footer that nests", footer(b"\x1c" * 1_000_000), "bad")
raw("footer of long lists", footer(b"\x19\xfc\xff\xff\xff\xff\x0f" * 10_000), "bad")


def flipped(seed):
    data, draw = bytearray(GOOD if seed % 2 else LISTS), random.Random(seed)
    start = len(data) - 8 - struct.unpack("<I", data[-8:-4])[0]
    first, last = (4, start) if seed % 3 == 0 else (start, len(data) - 8)
    for _ in range(draw.randrange(1, 8)):
        data[draw.randrange(first, last)] = draw.randrange(256)
    return bytes(data)


for seed in range(60):
    raw(f"bytes of noise {seed}", flipped(seed))

if __name__ == "__main__":
    harness.main(CASES)
