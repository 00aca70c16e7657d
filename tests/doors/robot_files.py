"""Robot files: YAML that is broken or a bomb, numbers, expressions, and arms at the edge of what is computed."""

import random

import harness
from robots import BOMB, robot

CASES = harness.Cases()
GOOD = robot()
INPUTS = harness.ROOT / "tests/doors/inputs"
STATE = ["--q", "0.1,0.2", "--qd", "0,0", "--qdd", "0,0"]
COMMANDS = (["check"], ["show"], ["emit"], ["eval", *STATE])


def feed(name, text, expected="any", commands=COMMANDS, **more):
    """A case of a robot file, given to several commands."""

    def body(trial):
        path = trial.write("robot.yaml", text() if callable(text) else text)
        for command, *options in commands:
            names = "robot.yaml" if expected == "bad" else ""
            trial.rne(command, path, *options, expected=expected, names=names, **more)

    CASES.add(name, body)


# YAML.
feed("good", GOOD, "taken")
feed("empty", "", "bad")
feed("line breaks alone", "\n\n", "bad")
feed("a comment alone", "# x\n", "bad")
feed("zero byte", GOOD.replace("own", "o\0n"), "bad")
feed("noise", random.Random(1).randbytes(5000), "bad")
feed("Latin-1", GOOD.replace("own", "\xfcnn").encode("latin-1"), "bad")
feed("escaped zero", GOOD.replace("own", "\\u0000"))
feed("UTF-16", GOOD.encode("utf-16"))
feed("byte order mark", b"\xef\xbb\xbf" + GOOD.encode())
feed("lines of Windows", GOOD.replace("\n", "\r\n"), "taken")
feed("lines of old Macs", GOOD.replace("\n", "\r"))
feed("tabs", GOOD.replace("  -", "\t-"), "bad")
feed("bomb of aliases", BOMB + GOOD, "bad")
feed("bomb of aliases for joints", GOOD.replace("joints:\n", "joints: *j\n") + "\n" + BOMB, "bad")
feed("alias to itself", "a: &a [*a]\n" + GOOD, "bad")
feed("alias to nothing", GOOD.replace('"own"', "*nobody"), "bad")
feed("alias of a mass", GOOD.replace("mass: 2.5", "mass: &m 2.5", 1).replace("mass: 2.5", "mass: *m"))
feed("merge key", "<<: {format: 1}\n" + GOOD, "bad")
feed("tag of Python", GOOD.replace('"own"', "!!python/object/apply:os.system ['id']"))
feed("tag of bytes", GOOD.replace('"own"', "!!binary aGk="))
feed("two documents", GOOD + "---\n" + GOOD, "bad")
feed("end of a document", GOOD + "...\n")
feed("directive", "%YAML 1.1\n---\n" + GOOD)
feed("deep lists", "x: " + "[" * 100_000, "bad")
feed("deep lists that are closed", "x: " + "[" * 50_000 + "]" * 50_000, "bad")
feed("deep maps", "x: " + "{a: " * 50_000, "bad")
feed("deep blocks", lambda: "".join(" " * i + "a:\n" for i in range(2000)), "bad")
feed("key of 1 MB", lambda: "k" * 1_000_000 + ": 1\n" + GOOD, "bad")
for megabytes, expected in ((10, "any"), (100, "bad")):
    feed(f"{megabytes} MB", lambda size=megabytes: GOOD + "#" + "x" * (size << 20), expected)
feed("100000 keys", lambda: "".join(f"k{i}: 1\n" for i in range(100_000)) + GOOD, "bad")
feed("key twice", GOOD + "name: other\n", "bad")
feed("list for a key", "? [a, b]\n: c\n" + GOOD, "bad")
feed("null for a key", "~: 1\n" + GOOD, "bad")
feed("text of 100000 lines", GOOD.replace('"n"', "|\n" + "   x\n" * 100_000))
feed("quote that stays open", GOOD.replace('"own"', '"own'), "bad")
feed("a list", "- 1\n", "bad")
feed("a text", "hello\n", "bad")

# Joints.
feed("64 joints", robot(joints=64), commands=(["check"], ["show", "--joint", "3"]))
for joints in (0, 65, 10_000):
    feed(f"{joints} joints", robot(joints=joints), "bad")
feed("joints a map", GOOD.split("joints:")[0] + "joints: {a: 1}\n", "bad")
feed("joints a number", GOOD.split("joints:")[0] + "joints: 5\n", "bad")

# Numbers and expressions.
NUMBERS = {
    "taken": ["4/2"],
    "bad": [
        "nan", ".nan", ".inf", "-.inf", "1e999", "1e400", "-1", "\u0663", "1/0", "0/0", "sqrt(-1)", "9^9^9^9",
        "(" * 5000 + "1" + ")" * 5000, "-" * 5000 + "1", "2" + "^2" * 5000, "__import__('os')", "1;2", "1 2", "''",
        "null", "true", "[1]", "1e", "asin(2)", "5%2", "unknown", "\u22122",
    ],
    "any": [
        "1e-320", "0x10", "1_000", "2^2^2^2^2^2", "+".join(["1"] * 100_000), "deg(deg(deg(1)))", "pi*pi", "1" * 100_000,
        "0." + "0" * 100_000 + "1", "1,5", "1e-5000", "1+" * 500_000 + "1", "5e-324*0.5",
    ],
}  # fmt: skip
for expected, numbers in NUMBERS.items():
    for number in numbers:
        shown = number if len(number) < 20 else f"{number[:12]}… of {len(number)} letters"
        feed(f"mass {shown}", GOOD.replace("mass: 2.5", f"mass: {number}"), expected)
feed("mass with a comment inside", GOOD.replace("mass: 2.5", "mass: 2.5 # kg"), "bad")
for name, parameters, expected in (
    ("of itself", "{m: m}", "bad"),
    ("in a ring", "{a: b, b: a}", "bad"),
    ("called pi", "{pi: 3}", "bad"),
    ("called ä", "{ä: 3}", "any"),
    ("called fn", "{fn: 3}", "any"),
):
    feed(f"parameter {name}", robot(extra=f"parameters: {parameters}\n"), expected)
DOUBLING = "".join(f"  a{i}: a{i - 1}+a{i - 1}\n" for i in range(1, 2000))
feed("2000 parameters that double", robot(extra="parameters:\n  a0: 1\n" + DOUBLING))
feed("10000 parameters", robot(extra="parameters:\n" + "".join(f"  p{i}: {i}\n" for i in range(10_000))))
feed("parameters a list", robot(extra="parameters: [1]\n"), "bad")

# Arms at the edge.
for a in ("1e300", "1e-300", "1e154", "5e-324", "1e9", "1e10"):
    feed(f"a {a}", robot(a=a))
for theta in ("pi/2", "deg(90)", "1.5707963267948966", "1e-300"):
    feed(f"theta {theta}", robot(theta=theta))
# A large angle leaves no digits for its sine: it must not be taken for a right angle.
for angle in ("1e13", "1e16", "1e17", "1e300"):
    feed(f"theta {angle}", robot(theta=angle), "bad")
    feed(f"alpha {angle}", robot(alpha=angle), "bad")
feed("massless", robot(mass="0", com="[0,0,0]"))
feed("gravity 1e300", GOOD.replace("-9.81", "-1e300"), never=["inf m/s"])

# Arms on whose code the printer once took exponential time.
SLOW = ("slow_derivatives_8", "slow_derivatives_8_scale", "slow_dup_8", "slow_prism_9", "hang_derivatives_10")
for name in SLOW:
    for language in ("rust", "c"):
        command = ["emit", INPUTS / f"{name}.yaml", "--lang", language, "--function", "all", "--form", "reduced"]
        CASES.add(f"emit {language} of {name}", lambda trial, command=command: trial.rne(*command, expected="taken"))
    show = ["show", INPUTS / f"{name}.yaml", "--form", "reduced"]
    CASES.add(f"show {name}", lambda trial, command=show: trial.rne(*command))

if __name__ == "__main__":
    harness.main(CASES)
