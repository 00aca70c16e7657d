"""Logs in CSV, as instruments, spreadsheets and people spoil them."""

import math
import random

import harness
from logs import read_by_all, state

HEAD = ["t", "q1", "q2", "qd1", "qd2", "tau1", "tau2"]
CASES = harness.Cases()


def rows(count=400, dt=0.01, start=0.0):
    times = (start + i * dt for i in range(count))
    return [[f"{t:.9f}"] + [f"{x:.6f}" for x in state(t)] for t in times]


def stamped(stamp, count=400, dt=0.01):
    """The rows with other stamps: a function of the row's number."""
    return [[stamp(i)] + row[1:] for i, row in enumerate(rows(count, dt))]


def filled(cell, columns=range(1, 7)):
    """The rows with one text in these columns."""
    return [[cell if i in columns else word for i, word in enumerate(row)] for row in rows()]


def table(head=HEAD, body=None, separator=",", end="\n"):
    body = rows() if body is None else body
    return end.join(separator.join(row) for row in [head, *body]) + end


GOOD = table()
WITHOUT_TIME = table(HEAD[1:], [row[1:] for row in rows()])


def csv(name, data, expected="any", says=(), options=(), **more):
    CASES.add(
        name,
        lambda trial: read_by_all(
            trial, "log.csv", data() if callable(data) else data, expected, says, options=options, **more
        ),
    )


# Separators, encodings, comments and quotes.
csv("good", GOOD, "taken")
csv("semicolons", table(separator=";"), "taken")
csv("tabs", table(separator="\t"), "taken")
csv("blanks", table(separator=" "), "bad")
csv("pipes", table(separator="|"), "bad")
csv("lines of Windows", table(end="\r\n"), "taken")
csv("lines of old Macs", table(end="\r"))
csv("byte order mark", b"\xef\xbb\xbf" + GOOD.encode(), "taken")
csv("UTF-16", GOOD.encode("utf-16"), "bad", ["UTF-16"])
csv("UTF-16 without a mark", GOOD.encode("utf-16-le"), "bad")
csv("UTF-32", GOOD.encode("utf-32"), "bad")
csv("comments", "# a\n\n#b\n" + GOOD.replace("\n", "\n# c\n", 5), "taken")
csv("comment inside a cell", GOOD.replace("0.99", "0.9#9", 1))
csv("decimal commas between semicolons", table(separator=";").replace(".", ","), "bad", ["decimal"])
csv("decimal commas between commas", GOOD.replace(".", ","), "bad")
csv("quoted", table([f'"{name}"' for name in HEAD], [[f'"{cell}"' for cell in row] for row in rows()]), "taken")
csv("quoted comma in a name", table(['"t"', '"q1, first"', *HEAD[2:]]))
csv("quote that stays open in the header", GOOD.replace("q1", '"q1'))
csv("quote that stays open in a cell", GOOD.replace("0.010000000,", '"0.010000000,', 1))
csv("line break in a name", table(['"t\n"', "q1", *HEAD[2:]]))
csv("blanks around cells", table(body=[[f"  {cell}\t" for cell in row] for row in rows()]))

# Too little, too much, and what is cut off.
csv("empty", b"", "bad")
csv("one byte", b"t", "bad")
csv("line breaks alone", b"\n" * 1000, "bad")
csv("comments alone", b"# x\n" * 1000, "bad")
csv("header alone", ",".join(HEAD) + "\n", "bad")
csv("one row", table(body=rows(1)), "bad", ["one joint state"])
csv("two rows", table(body=rows(2)))
csv("three rows", table(body=rows(3)))
csv("row too short", GOOD + "1,2,3\n", "bad", ["line 402"])
csv("row too long", GOOD + "1,2,3,4,5,6,7,8,9\n", "bad", ["line 402"])
csv("cut inside a row", GOOD[:-20])
csv("no line break at the end", GOOD.rstrip("\n"), "taken")
csv("header in the middle", GOOD + GOOD, "bad")
csv("numbers for a header", GOOD.split("\n", 1)[1], "bad")
csv("zero bytes at the end", GOOD.encode() + b"\0" * 5000, "bad")
csv("zero byte in a late cell", GOOD.encode()[:5000] + b"\0" + GOOD.encode()[5000:])
csv("line without end", lambda: b"t,q1\n" + b"1" * (5 << 20), "bad", ["million"])
csv("header without end", lambda: b"q" * (5 << 20), "bad")

# Numbers.
csv("NaN in a cell", GOOD.replace("0.010000", "nan", 1))
csv("NaN for all torques", table(body=filled("nan", (5, 6))))
csv("NaN for all positions", table(body=filled("nan", (1, 2))), "bad")
csv("infinite", table(body=filled("inf")), "bad")
csv("infinite once", GOOD.replace(",5.0", ",inf", 1))
csv("1e308", table(body=filled("1e308")))
csv("1e400", table(body=filled("1e400")))
csv("denormal", table(body=filled("4e-324")))
csv("zero", table(body=filled("0")))
csv("negative zero", table(body=filled("-0")))
csv("hexadecimal", table(body=filled("0x10")), "bad", ["line 2"])
csv("underscores", table(body=filled("1_0")), "bad")
csv("Arabic digits", table(body=filled("\u0661")), "bad")
csv("typographic minus", table(body=filled("\u22121")), "bad")
csv("empty cells", table(body=filled("")), "bad")
csv("cells that are no UTF-8", GOOD.encode().replace(b"0.9999", b"\xff\xff", 1), "bad", ["line"])
csv("integers", table(body=[[row[0]] + [str(int(float(cell) * 100)) for cell in row[1:]] for row in rows()]))
csv("exponents", table(body=[[f"{float(cell):.8e}" for cell in row] for row in rows()]), "taken")
csv("plus signs", table(body=[["+" + c if c[0] != "-" else c for c in row] for row in rows()]), "taken")
csv("position that jumps", table(body=[[row[0], str(1000.0 * i), *row[2:]] for i, row in enumerate(rows())]))

# Time. Whole numbers that are no seconds must not be taken for seconds.
csv("time: NaN", GOOD.replace("0.010000000", "nan", 1), "bad", ["line 3"])
csv("time: empty", GOOD.replace("0.010000000", "", 1), "bad", ["line 3"])
csv("time: infinite", GOOD.replace("0.010000000", "inf", 1), "bad", ["line 3"])
csv("time: of day", GOOD.replace("0.010000000", "12:30:01", 1), "bad", ["line 3"])
csv("time: ISO 8601", table(body=stamped(lambda i: f"2026-01-01T00:00:{i % 60:02}")), "bad")
csv("time: backwards", table(body=rows()[::-1]), "bad")
csv("time: constant", table(body=stamped(lambda i: "1")), "bad")
csv("time: every row twice", table(body=[row for row in rows() for _ in (0, 1)]))
csv("time: two states of one stamp", table(body=stamped(lambda i: f"{i // 2 * 0.01:.3f}")))
csv("time: trembles", table(body=stamped(lambda i: f"{i * 0.01 + 0.03 * (i % 2):.3f}")))
csv("time: shuffled", table(body=random.Random(1).sample(rows(), 400)))
csv("time: near the end of 64 bits", table(body=rows(start=9.2233720360e9)))
csv("time: beyond 64 bits", table(body=rows(start=9.3e9)), "bad")
csv("time: 292 years before 1970", table(body=rows(start=-9.2233720368e9)))
csv("time: 584 years in a step", table(body=[["-9223372036", *rows(1)[0][1:]]] + stamped(lambda i: "9223372036")))
csv("time: steps of 1 ns", table(body=stamped(lambda i: f"{i * 1e-9:.9f}", 5000)))
csv("time: steps of 1e-12 s", table(body=stamped(lambda i: f"{i * 1e-12:.15f}")), "bad")
csv("time: years", table(body=stamped(lambda i: str(i * 31556952))), "bad")
for unit, name, step, dt in (
    ("ms", "whole milliseconds at 1 kHz", 1, 1e-3),
    ("ms", "whole milliseconds at 500 Hz", 2, 2e-3),
    ("ms", "whole milliseconds at 50 Hz", 20, 2e-2),
    ("us", "whole microseconds at 1 MHz", 1, 1e-6),
    ("us", "whole microseconds at 1 kHz", 1000, 1e-3),
):
    body = stamped(lambda i, step=step: str(i * step), dt=dt)
    csv(f"time: {name}", table(body=body), "refused", ["time-unit"], everywhere=True)
    at = [f"at {1 / dt:.0f} Hz"]
    csv(f"time: {name}, with the unit", table(body=body), says=at, options=["--time-unit", unit])
    late = stamped(lambda i, step=step: str(1_700_000_000_000 + i * step), dt=dt)
    csv(f"time: {name} since 1970", table(body=late), "refused", everywhere=True)
csv(
    "time: whole milliseconds at 1 kHz without velocities",
    table([*HEAD[:3], *HEAD[5:]], [row[:3] + row[5:] for row in stamped(str, dt=1e-3)]),
    "refused",
    ["time-unit"],
    everywhere=True,
)
csv("time: whole milliseconds as 1.0", table(body=stamped(lambda i: f"{i}.0", dt=1e-3)), "refused", everywhere=True)
csv(
    "time: whole milliseconds, some lost",
    table(body=[row for i, row in enumerate(stamped(str, dt=1e-3)) if i % 7]),
    "refused",
    everywhere=True,
)
csv("time: numbers of frames", table(body=stamped(str, dt=0.004)), "refused", everywhere=True)
csv("no time", WITHOUT_TIME, "refused", ["--rate"])

# Options.
far, century = rows(200) + rows(200, start=9e4), rows(200) + rows(200, start=3e9)
csv("gap of a century", table(body=century), "taken")
csv("gap 1e15", table(body=century), options=["--gap", "1e15"])
csv("gap 1e7", table(body=far), options=["--gap", "1e7"])
csv("gap 1e7 beside a century", table(body=century), options=["--gap", "1e7"])
csv("gap 1.5", GOOD, options=["--gap", "1.5"])
for option, values in {
    "gap": ("nan", "inf"),
    "cutoff": ("0", "-1", "nan", "1e300"),
    "torque-constant": ("0", "nan", "1,2,3"),
    "rate": ("100",),
    "joints": ("a,b", "", "1,1"),
    "topic": ("\x1b[31mx", "x\nok"),
    "columns": ("q",),
}.items():
    for value in values:
        csv(f"{option} {value!r}", GOOD, "refused", options=[f"--{option}={value}"])
for cutoff in ("1e-300", "1e-3"):
    csv(f"cutoff {cutoff!r}", GOOD, options=[f"--cutoff={cutoff}"])
csv("torque-constant '1e308'", GOOD, options=["--torque-constant=1e308"])
csv("no time, rate 100", WITHOUT_TIME, "taken", options=["--rate=100"])
for rate in ("1e300", "1e12", "1e9", "1e-9"):
    csv(f"no time, rate {rate}", WITHOUT_TIME, options=[f"--rate={rate}"])
for rate in ("0", "inf"):
    csv(f"no time, rate {rate}", WITHOUT_TIME, "refused", options=[f"--rate={rate}"])

# Names of columns.
csv("name of a column twice", table(["t", "q1", "q1", *HEAD[3:]]), "refused")
csv("two columns of time", table(["t", "time", "q2", *HEAD[3:]]))
csv("joints 1 and 3", table(["t", "q1", "q3", "qd1", "qd3", "tau1", "tau3"]))
csv("velocities of other joints", table(["t", "q1", "q2", "qd3", "qd4", "tau1", "tau2"]))
csv("no positions", table(["t", "a", "b", "c", "d", "e", "f"]), "bad")
csv("joint 4294967296", table(["t", "q4294967296", "q2", *HEAD[3:]]))
csv("joint 1e30", table(["t", "q1" + "0" * 30, "q2", *HEAD[3:]]))
csv("a formula for a name", table(["t", "q1", "q2", "=cmd|' /C calc'!A0", *HEAD[4:]]))
for what, first, second in (
    ("codes of terminals", "\x1b]0;owned\x07", "\x1b[2J"),
    ("codes of colours", "\x1b[8mhidden", "\x1b[31mred"),
    ("codes of one byte", "\x9b8mhidden", "\x9b2J"),
    ("codes of direction", "\u202eabc", "\u2066b"),
    ("HTML", "<img src=x onerror=alert(1)>", "b"),
):
    csv(f"names with {what}", table(["t", first + "/position", second + "/position", "x", "y", "z", "w"]))


def on_a_terminal(trial):
    """A colour code in a name conceals nothing of what stands after it."""
    names = ["\x1b[8mhidden/position", "b\x1b[31m/position", "x", "y", "z", "w"]
    log = trial.write("log.csv", table(["t", *names]))
    for command in (["log", log], ["log", log, "--topic", "\x1b[8mhidden"], ["log", "\x1b[8mhidden.csv"]):
        trial.rne(*command, never=["\x1b[8m", "\x1b[31m/"], colours=True)


CASES.add("names with codes of colours, on a terminal", on_a_terminal)
NO_UTF8 = b"t,\xff\xfe\xfdq/position,b/position\n" + b"".join(b"%.3f,0,1\n" % (i * 0.01) for i in range(400))
csv("names that are no UTF-8", NO_UTF8)


# Two arms in a table: each has names and a clock of its own.
def two_arms():
    """The left arm at 50 Hz and the right arm at 100 Hz, each with its own clock, in one row."""
    head = ["left/t", "left/q1", "left/q2", "right/t", "right/q1", "right/q2"]
    body = []
    for i in range(400):
        left, right = i * 0.02, i * 0.01
        body.append(
            [f"{left:.3f}"]
            + [f"{x:.6f}" for x in state(left)[:2]]
            + [f"{right:.3f}"]
            + [f"{x + 2:.6f}" for x in state(right)[:2]]
        )
    return table(head, body)


csv("two arms", two_arms, "refused")
csv("two arms, the right one by its topic", two_arms, options=["--topic", "right"], never=["at 50 Hz"])
csv("two arms, the left one by its topic", two_arms, options=["--topic", "left"], never=["at 100 Hz"])


# Many columns: what is taken must not grow with their square, and what is too much is refused.
def wide(joints, count, dt):
    head = ",".join(["t"] + [f"q{i}" for i in range(joints)])
    values = ",".join(f"{math.sin(j):.3f}" for j in range(joints))
    return "\n".join([head] + [f"{i * dt:.6f},{values}" for i in range(count)]) + "\n"


csv("100 joints", lambda: wide(100, 200, 0.01))
csv("1000 joints", lambda: wide(1000, 200, 0.01))
csv("1000 joints at 1 MHz", lambda: wide(1000, 100, 1e-6))
for joints, count, dt in ((2000, 100, 1e-6), (5000, 100, 0.01), (20_000, 100, 1e-6), (130_000, 70, 1e-6)):
    csv(
        f"{joints} joints",
        lambda joints=joints, count=count, dt=dt: wide(joints, count, dt),
        "refused",
        everywhere=True,
    )
csv("300000 columns and no row", lambda: ",".join(["t"] + [f"q{i}" for i in range(1, 300_000)]) + "\n", "bad")

if __name__ == "__main__":
    harness.main(CASES)
