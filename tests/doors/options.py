"""Options and arguments: numbers at the edge, names that lead elsewhere, files of another kind."""

import harness
from harness import DOCS

CASES = harness.Cases()
REST = ["--qd", "0,0", "--qdd", "0,0"]
AT_ZERO = ["--q", "0,0", *REST]


def options(name, command, expected="any", **rules):
    CASES.add(name, lambda trial: trial.rne(*command, expected=expected, **rules))


def shown(value):
    return repr(value if len(value) <= 20 else f"{value[:16]}… of {len(value)} letters")


def each(command, option, values, expected="any"):
    """A case of each value of an option."""
    for value in values:
        options(f"{command[0]} {option} {shown(value)}", [*command, f"{option}={value}"], expected)


each(
    ["eval", "planar2", *REST],
    "--q",
    [
        "",
        ",",
        "nan,0",
        "inf,0",
        "1e400,0",
        "1,2,3",
        "1",
        "a,b",
        "1;2",
        "1,,2",
        " 1 , 2 ",
        "pi/2,deg(90)",
        "0x1,0",
        "-1,-2",
    ]
    + ["1e308,1e308", ",".join(["1"] * 50_000), "1\n2", "\x1b[2J,1", "9^9^9^9,1", "(" * 3000 + "1" + ")" * 3000 + ",1"],
)
each(
    ["eval", "planar2", *AT_ZERO],
    "--payload",
    ["1", "1,2,3", "1,0,0,0,1", "1,0,0,0,1,1,1,0,0,0", "1,0,0,0,-1,-1,-1,0,0,0"],
)
each(["eval", "planar2", *AT_ZERO], "--payload", ["1e308,1e308,0,0", "0,0,0,0"])
each(["eval", "planar2", *AT_ZERO], "--payload", ["-1,0,0,0", "nan,0,0,0"], "usage")
each(["show", "planar2"], "--joint", ["0", "3", "-1", "99999999999999999999", "x", "", "1.5"], "usage")
each(["show", "planar2"], "--step", ["0", "8", "-1", "x", "99999999999"], "usage")
each(["show", "planar2", "--symbolic"], "--first", ["0", "3", "-1", "99999999999999"], "usage")
each(["eval", "planar2"], "--golden", ["0", "-1", "1", "99999999999999999999", "x"])
each(["new", "x", "-o", "-"], "--dof", ["0", "-1", "65", "1e3", "99999999999999999999"], "usage")
each(["new", "x", "-o", "-"], "--dof", ["64"], "taken")

# Names that would lead out of the folder, or nowhere.
for name in ("../evil", "/etc/evil", "Evil", "", "a" * 5000, "\xe9vil", "a b", "-x", "a\nb"):
    expected = "refused" if len(name) > 255 else "usage"
    options(f"new {shown(name)}", ["new", "--dof=2", "--", name], expected)
    # a package may begin with a capital
    expected = "any" if name == "Evil" else expected
    options(f"firmware {shown(name)}", ["firmware", "-o", "firmware", "--", name], expected, writes=["firmware"])
for name in ("con", "fn", "self"):
    options(f"new {name}", ["new", "--dof=2", "--", name], writes=[f"{name}.yaml"])
options("firmware self", ["firmware", "-o", "firmware", "--", "self"], "usage")

EXCITE = {
    "--seconds": ["0", "-1", "nan", "1e300"],
    "--periods": ["0", "99999999999"],
    "--harmonics": ["0", "1", "100000"],
    "--range": ["0", "-1", "nan", "1e300", "1,2,3"],
    "--velocity": ["0", "nan", "1e-300"],
    "--acceleration": ["1e-300", "1e300"],
    "--rate": ["0", "1e300", "1e9", "nan", "1e-9"],
    "--seed": ["-1", "99999999999999999999"],
}
for option, values in EXCITE.items():
    each(["excite", "planar2", "--evaluations=20", "-o", "-"], option, values)
each(["excite", "planar2", "-o", "-"], "--evaluations", ["0", "-1"])
each(["plot", "planar2"], "--duration", ["0", "-1", "nan", "1e300", "1e-300"])
each(["plot", "planar2"], "--set", ["x=1", "x", "=1"])
WATCH = {
    "--gain": ["0", "nan", "1e300", "1e-300"],
    "--hold": ["0", "-1", "1e300", "nan"],
    "--false-alarms": ["0", "-1", "1e300", "nan", "1e-300"],
}
for option, values in WATCH.items():
    each(["watch", DOCS / "desk_arm_identified.yaml", DOCS / "desk_arm_knock.csv"], option, values)
IDENTIFY = {
    "--pull": ["nan", "-1", "0", "1e300"],
    "--hold-out": ["0", "1", "-1", "nan", "0.999", "1e-9"],
}
for option, values in IDENTIFY.items():
    each(["identify", DOCS / "desk_arm.yaml", DOCS / "desk_arm_log.csv"], option, values)

# Files of another kind.
LOG, ROBOT = DOCS / "desk_arm_log.csv", DOCS / "desk_arm.yaml"
options("identify, a log twice", ["identify", ROBOT, LOG, LOG], "usage")
options("identify, a robot for a log", ["identify", ROBOT, ROBOT], "bad")
options("check a log", ["check", LOG], "bad")
options("check a folder", ["check", DOCS], "bad")
options("check a device without end", ["check", "/dev/zero"], "refused")
options("check a missing file", ["check", "missing.yaml"], "bad")
options("check 100 times", ["check", *["planar2"] * 100], seconds=60)
options("log a device without end", ["log", "/dev/zero"], "refused")
options("log a file of the kernel", ["log", "/proc/self/maps"], "refused")
options("explain a code of terminals", ["explain", "\x1b[2J"], "refused")
options("completions of a shell that is none", ["completions", "tcsh"], "usage")
options("a command that is none", ["chekc"], "usage")
DIAGNOSE = ["diagnose", "planar2", *AT_ZERO]
options("diagnose zeros", [*DIAGNOSE, "--tau", "0,0"])
options("diagnose NaN", [*DIAGNOSE, "--tau", "nan,0"], "refused")
options("diagnose 1e308", [*DIAGNOSE, "--tau", "1e308,-1e308"])


def billion(trial):
    """A billion states are computed until nobody reads them."""
    rne = harness.shlex.quote(str(harness.RNE))
    trial.judge(["bash", "-c", f"{rne} eval planar2 --golden=1000000000 | head -n 1000 > /dev/null"], "any")


CASES.add("eval --golden of a billion, a thousand are read", billion)

if __name__ == "__main__":
    harness.main(CASES)
