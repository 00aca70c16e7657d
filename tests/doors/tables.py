"""Tables that are given to commands beside logs: states, trajectories, worksheets."""

import functools
import json
import math
import random
import struct
import subprocess

import harness

CASES = harness.Cases()
NAMES = ["q1", "q2", "qd1", "qd2", "qdd1", "qdd2"]
HEAD = ",".join(NAMES)
ROWS = [[f"{x:.4f}" for x in (i * 0.1, -i * 0.2, 1, 2, 3, -1)] for i in range(20)]
NOISE = random.Random(1).randbytes(5000)


@functools.cache
def printed(*command):
    return subprocess.run([harness.RNE, *command], capture_output=True, check=True).stdout


def table(head=HEAD, rows=ROWS, end="\n"):
    return end.join([head] + [",".join(row) for row in rows]) + end


GOOD = table()


# States.
def states(name, data, expected="any", says=(), options=(), kind="csv", never=()):
    def body(trial):
        trial.write("planar2.yaml", printed("example", "planar2"))
        path = trial.write(f"states.{kind}", data() if callable(data) else data)
        rules = {"expected": expected, "says": says, "never": never}
        trial.rne("eval", "planar2.yaml", "--states", path, *options, **rules)
        command = ["eval", "planar2.yaml", "--states", path, "-o", "out.npy", *options]
        trial.rne(*command, writes=["out.npy"], **rules)
        if kind == "csv":
            trial.rne("eval", "planar2.yaml", "--states", "-", *options, stdin=path, **rules)

    CASES.add(f"states: {name}", body)


states("good", GOOD, "taken")
states("empty", "", "refused")
states("header alone", HEAD + "\n")
states("header without a line break", HEAD)
states("a column is missing", table("q1,q2,qd1,qd2,qdd1,x"), "refused", ["qdd2"])
states("a column twice", table("q1,q1,qd1,qd2,qdd1,qdd2"), "refused")
states("semicolons", GOOD.replace(",", ";"))
states("tabs", GOOD.replace(",", "\t"))
states("byte order mark", "\ufeff" + GOOD, "taken")
states("lines of Windows", table(end="\r\n"), "taken")
states("comment at the head", "# a\n" + GOOD, "taken")
states("comments between rows", GOOD.replace("\n", "\n# x\n"))
states("empty lines between rows", GOOD.replace("\n", "\n\n"))
states("quoted", table(rows=[[f'"{cell}"' for cell in row] for row in ROWS]))
states("quote that stays open", GOOD.replace("0.1", '"0.1', 1))
states("UTF-16", GOOD.encode("utf-16"), "refused")
states("noise", NOISE, "refused")
states("decimal commas", GOOD.replace(".", ","), "bad")
states("row too short", GOOD + "1,2\n", "bad")
states("row too long", GOOD + "1,2,3,4,5,6,7\n", "bad")
# A number beyond the largest is refused where a single state is: never an infinite or undefined result with status 0.
for cell, expected in (
    ("nan", "any"),
    ("inf", "any"),
    ("1e400", "bad"),
    ("", "bad"),
    ("a", "bad"),
    ("0x1", "bad"),
    ("pi/2", "bad"),
    ("=1+1", "bad"),
    ("\0", "bad"),
    ("\x1b[2J", "bad"),
):
    states(f"cell {cell!r}", GOOD + f"{cell},0,0,0,0,0\n", expected)
states("cells 1e308", GOOD + "1e308,0,1e308,0,1e308,0\n")
states("cell in Latin-1", GOOD.encode() + b"\xff,0,0,0,0,0\n", "bad")
states("name of a code of terminals", table("q1,q2,qd1,qd2,qdd1,\x1b[2J"), "refused")
states("line of 10 MB", lambda: GOOD + "1" * (10 << 20) + "\n", "bad")
states("header of 10 MB", lambda: "a" * (10 << 20), "refused")
states(
    "100000 columns",
    lambda: ",".join(NAMES + [f"x{i}" for i in range(100_000)]) + "\n" + ",".join(["0"] * 100_006) + "\n",
)
states("function that is none", GOOD, "usage", options=["--function", "x"])
states("a payload", GOOD, options=["--payload", "1,0,0,0"])
FUNCTIONS = "forward_dynamics inverse_dynamics_with_sin_cos jacobian regressor all gravity_torques mass_matrix"
for function in FUNCTIONS.split():
    states(f"function {function}", GOOD, options=["--function", function])


TENTHS = struct.pack("<120d", *[0.1] * 120)


def npy(shape="(20, 6)", descr="'<f8'", order="False", body=TENTHS, raw=None):
    text = (raw or f"{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}").encode("latin-1")
    text += b" " * (-(11 + len(text)) % 64) + b"\n"
    return b"\x93NUMPY\x01\0" + struct.pack("<H", len(text)) + text + body


def nested(depth):
    return "[('a', " * depth + "'<f8'" + ")]" * depth


IN_PARENTHESES = "{'descr': '<f8', 'fortran_order': False, 'shape': " + "(" * 30 + "20, 6" + ")" * 30 + "}"
for name, data, expected in (
    ("good", npy(), "taken"),
    ("order of Fortran", npy(order="True"), "refused"),
    ("5 columns", npy("(24, 5)"), "refused"),
    ("1 axis", npy("(120,)"), "refused"),
    ("no rows", npy("(0, 6)"), "any"),
    ("shape of 48 GB", npy("(1000000000, 6)"), "bad"),
    ("shape beyond 64 bits", npy("(9223372036854775807, 6)"), "bad"),
    ("cut", npy()[:-3], "bad"),
    ("more than it says", npy() + b"x" * 100, "any"),
    ("objects", npy(descr="'|O'"), "refused"),
    ("i8", npy(descr="'<i8'"), "refused"),
    ("big-endian", npy(descr="'>f8'", body=struct.pack(">120d", *[0.1] * 120)), "taken"),
    ("f4", npy(descr="'<f4'", body=struct.pack("<120f", *[0.1] * 120)), "taken"),
    ("kinds nested 6 deep", npy(descr=nested(6)), "refused"),
    ("kinds nested 12 deep", npy(descr=nested(12)), "refused"),
    ("shape nested 30 deep", npy(raw=IN_PARENTHESES), "any"),
    ("NaN", npy(body=struct.pack("<120d", *[math.nan] * 120)), "any"),
):
    states(f"npy, {name}", data, expected, kind="npy")


# Trajectories.
def trajectory(name, data, expected="any"):
    def body(trial):
        path = trial.write("trajectory.csv", data() if callable(data) else data)
        for flag in ([], ["--csv"]):
            trial.rne("plot", "planar2", "--trajectory", path, *flag, expected=expected)

    CASES.add(f"trajectory: {name}", body)


MOTION = "t,q1,q2\n" + "".join(
    f"{i * 0.01:.3f},{math.sin(i * 0.01):.5f},{math.cos(i * 0.01):.5f}\n" for i in range(300)
)
trajectory("good", MOTION, "taken")
trajectory("empty", "", "refused")
trajectory("header alone", "t,q1,q2\n", "refused")
trajectory("1 row", "t,q1,q2\n0,0,0\n", "refused")
trajectory("2 rows", "t,q1,q2\n0,0,0\n1,0,0\n")
trajectory("backwards", "t,q1,q2\n1,0,0\n0,0,0\n2,0,0\n", "refused")
trajectory("one time twice", "t,q1,q2\n0,0,0\n0,1,1\n1,2,2\n", "refused")
trajectory("NaN", MOTION + "nan,0,0\n", "refused")
trajectory("infinite", MOTION + "inf,0,0\n", "refused")
trajectory("1e308", MOTION + "1e308,1e308,1e308\n")
trajectory("steps of 1e-300 s", "t,q1,q2\n" + "".join(f"{i}e-300,{i},{i}\n" for i in range(10)))
trajectory("a column is missing", MOTION.replace("q2", "x"), "refused")
trajectory("a million rows", lambda: "t,q1,q2\n" + "".join(f"{i * 0.001:.3f},0.1,0.2\n" for i in range(1_000_000)))
trajectory("noise", NOISE, "refused")
trajectory("positions of 1e200", "t,q1,q2\n0,1e200,0\n1,-1e200,0\n2,1e200,0\n")
FAST = "1e200,1e200,0,0\n"
trajectory("torques without a number", f"t,q1,q2,qd1,qd2,qdd1,qdd2\n0,0,0,{FAST}1,0,0,{FAST}")

# Worksheets.
WORK = ["eval", "planar2", "--q", "0.3,0.1", "--qd", "0.5,0", "--qdd", "1,0", "--trace"]
COLUMNS = "joint,quantity,component,value\n"


def worksheet(name, data, expected="any", options=()):
    def body(trial):
        text = data() if callable(data) else data
        path = trial.write("mine.csv", text.encode("utf-8", "surrogatepass") if isinstance(text, str) else text)
        trial.rne(*WORK, "--compare", path, *options, expected=expected)

    CASES.add(f"worksheet: {name}", body)


def sheet():
    return printed(*WORK, "--csv").decode()


def other_format():
    """The worksheet in JSON, of a format that is not known."""
    work = json.loads(printed(*WORK, "--json"))
    return json.dumps({**work, "format": 2})


def row_in_json(row):
    return json.dumps({"trace": {"rows": [row]}})


worksheet("good", sheet, "taken")
worksheet("JSON", lambda: printed(*WORK, "--json"), "taken")
worksheet("empty", "", "refused")
worksheet("noise", NOISE, "refused")
worksheet("header alone", COLUMNS)
worksheet("rows twice", lambda: sheet() + "\n".join(sheet().splitlines()[2:]) + "\n")
for joint in ("0", "99", "99999999999999999999"):
    worksheet(f"joint {joint}", f"{COLUMNS}{joint},omega,x,1\n", "refused")
worksheet("quantity that is none", f"{COLUMNS}1,evil,x,1\n", "refused")
for value in ("9^9^9^9", "(" * 5000 + "1" + ")" * 5000, "nan"):
    worksheet(f"value {value[:10]}", f"{COLUMNS}1,omega,x,{value}\n", "refused")
worksheet("deep lists in JSON", "[" * 100_000, "refused")
worksheet("deep maps in JSON", '{"trace":' * 50_000, "refused")
worksheet("a number in JSON", "5", "refused")
worksheet("null in JSON", "null", "refused")
worksheet("half a letter in JSON", row_in_json({"joint": "\ud800", "quantity": "omega", "value": 1}), "refused")
LARGE = {"joint": 1, "quantity": "omega", "component": "x", "value": 0}
worksheet("1e999 in JSON", row_in_json(LARGE).replace('"value": 0', '"value": 1e999'), "refused")
worksheet("another format in JSON", other_format)
worksheet("another format", lambda: sheet().replace("format 1", "format 2"), "refused")
worksheet("of another robot", lambda: sheet().replace("planar2", "puma560"))
worksheet("0 digits", sheet, "refused", ["--digits=0"])
worksheet("-1 digits", sheet, "refused", ["--digits=-1"])
worksheet("99 digits", sheet, options=["--digits=99"])
worksheet("lines of old Macs", lambda: sheet().replace("\n", "\r"))
worksheet("first line of Excel", lambda: "sep=,\n" + sheet())
worksheet("200 MB", lambda: sheet() + "#" * (200 << 20))
worksheet("codes of terminals", lambda: sheet().replace("omega", "\x1b[2Jomega", 1))
worksheet("semicolons", lambda: sheet().replace(",", ";"))

if __name__ == "__main__":
    harness.main(CASES)
