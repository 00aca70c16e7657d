"""Every command that writes a file, onto everything that a name can lead to, and where there is no room.

A file of somebody stays as it is, a source is never overwritten, and a file is written whole or not at all.
"""

import functools
import os
import resource
import shutil
import subprocess

import harness
from harness import DOCS

CASES = harness.Cases()
LONG = "x" * 300
DOCUMENTS = {
    "desk.yaml": "desk_arm.yaml",
    "identified.yaml": "desk_arm_identified.yaml",
    "log.csv": "desk_arm_log.csv",
    "knock.csv": "desk_arm_knock.csv",
    "states.csv": "states.csv",
}
# Commands, the option that names the file included; the extension of what they write; whether they have --force.
WRITERS = {
    "emit": (["emit", "arm.yaml", "-o"], ".rs", True),
    "emit c": (["emit", "arm.yaml", "--lang", "c", "-o"], ".c", True),
    "report": (["report", "planar2.yaml", "-o"], ".html", True),
    "convert": (["convert", "arm.yaml", "--convention", "modified", "-o"], ".yaml", True),
    "export": (["export", "arm.yaml", "--urdf", "-o"], ".urdf", True),
    "import": (["import", "arm.urdf", "-o"], ".yaml", True),
    "plot": (["plot", "planar2.yaml", "-o"], ".svg", True),
    "states": (["eval", "planar2.yaml", "--states", "states.csv", "-o"], ".csv", True),
    "states as npy": (["eval", "planar2.yaml", "--states", "states.csv", "-o"], ".npy", True),
    "log": (["log", "log.csv", "-o"], ".csv", True),
    "identify": (["identify", "desk.yaml", "log.csv", "-o"], ".yaml", True),
    "plot of identify": (["identify", "desk.yaml", "log.csv", "--judge", "--plot"], ".svg", True),
    "plot of watch": (["watch", "identified.yaml", "knock.csv", "--plot"], ".svg", True),
    "excite": (["excite", "planar2.yaml", "--evaluations", "20", "-o"], ".csv", True),
    "plot of excite": (["excite", "planar2.yaml", "--evaluations", "20", "--plot"], ".svg", True),
    "new": (["new", "elbow", "--dof", "2", "-o"], ".yaml", False),
}
FOLDERS = {
    "man": ["man", "-o"],
    "firmware": ["firmware", "torque", "--robot", "planar2.yaml", "-o"],
}


@functools.cache
def printed(*command):
    return subprocess.run([harness.RNE, *command], capture_output=True, check=True).stdout


def furnish(folder):
    """The files that the commands read, and one of somebody."""
    for name, document in DOCUMENTS.items():
        shutil.copy(DOCS / document, folder / name)
    (folder / "arm.yaml").write_bytes(printed("example", "puma560"))
    (folder / "planar2.yaml").write_bytes(printed("example", "planar2"))
    (folder / "arm.urdf").write_bytes(printed("export", "planar2", "--urdf"))
    (folder / "user.txt").write_text("mine\n")


def case(writer, what, body):
    def furnished(trial):
        furnish(trial.folder)
        body(trial)

    CASES.add(f"{writer}: {what}", furnished)


def beside(name):
    """The files that a command may write for this name: a header in C stands beside."""
    return [name, os.path.splitext(name)[0] + ".h", name + ".h"]


def onto(writer, what, target, expected, make=None, writes=(), flags=()):
    """A case of one target, which `make` puts there."""
    command = WRITERS[writer][0] if writer in WRITERS else FOLDERS[writer]

    def body(trial):
        if make:
            make(trial.folder)
        trial.rne(*command, target, *flags, expected=expected, writes=writes)

    case(writer, what, body)


def onto_sources(writer, command, force):
    """No command overwrites what it reads, not even with --force or by a link."""
    for source in [word for word in command if word.endswith((".yaml", ".csv", ".urdf"))]:
        onto(writer, f"its source {source}", source, "refused")
        if force:
            onto(writer, f"its source {source} with --force", source, "refused", flags=["--force"])
            link = lambda folder, source=source: (folder / "link").symlink_to(source)
            onto(writer, f"a link to {source} with --force", "link", "refused", link, flags=["--force"])


def to_standard_output(writer, command):
    """`-` is standard output: a command prints what it would write, or refuses; no file is called `-`."""

    def body(trial):
        is_second = command[-1] == "--plot"  # standard output has the answer already
        answer = trial.rne(*command, "-", expected="usage" if is_second else "taken")
        if not is_second and not answer.out:
            trial.fault(f"rne {command[0]} -o - prints nothing")

    case(writer, "standard output", body)


def without_room(writer, command, end, force):
    """Files may have at most so many bytes: what was there stays, or all of the new is there."""

    def body(trial):
        out = trial.folder / f"out{end}"
        answer = trial.rne(*command, out.name, writes=beside(out.name))
        if answer.status != 0:
            return
        whole = out.read_bytes()
        for limit in (0, 1, 1000, max(1, len(whole) // 2)):
            for name in beside(out.name)[1:]:
                (trial.folder / name).unlink(missing_ok=True)
            old = whole if force and writer.startswith("emit") else b"old\n"
            if force:
                out.write_bytes(old)
            else:
                out.unlink(missing_ok=True)
            flags = ["--force"] if force else []
            limits = [(resource.RLIMIT_FSIZE, limit)]
            answer = trial.rne(*command, out.name, *flags, writes=beside(out.name), limits=limits)
            now = out.read_bytes() if out.exists() else b""
            if now not in (whole, old if force else b""):
                trial.fault(f"{len(now)} of {len(whole)} bytes are written where files have at most {limit}")
            if answer.status == 0 and now != whole:
                trial.fault(f"status 0, and nothing is written where files have at most {limit} bytes")

    case(writer, "no room", body)


NOT_UTF8 = os.fsdecode(b"\xff\xfe")
for writer, (command, end, force) in WRITERS.items():
    out = f"out{end}"
    onto(writer, "a file of somebody", "user.txt", "usage")
    onto_sources(writer, command, force)
    dangling = lambda folder, end=end: (folder / f"link{end}").symlink_to(f"nowhere{end}")
    onto(writer, "a link to nothing", f"link{end}", "any", dangling, beside(f"link{end}") + beside(f"nowhere{end}"))
    onto(writer, "a link to itself", "loop", "refused", lambda folder: (folder / "loop").symlink_to("loop"))
    folder = lambda folder: (folder / "folder").mkdir()
    onto(writer, "a folder", "folder", "refused", folder)
    onto(writer, "a folder with a slash", "folder/", "refused", folder)
    if writer.startswith("emit"):
        onto(writer, "a folder that is not there", f"missing/x{end}", "taken", writes=["missing"])
    else:
        onto(writer, "a folder that is not there", f"missing/x{end}", "refused")
    onto(writer, "a file for a folder", f"user.txt/x{end}", "refused")
    onto(writer, "a long name", LONG + end, "refused")
    onto(writer, "no name", "", "any")
    onto(writer, "the folder above", "..", "refused")
    onto(writer, "a full device", "/dev/full", "any")
    onto(writer, "a device of nothing", "/dev/null", "any")
    onto(writer, "the memory of the process", "/proc/self/mem", "refused")
    onto(writer, "a pipe", "pipe", "refused", lambda folder: os.mkfifo(folder / "pipe"))
    onto(writer, "a name of a code of terminals", f"\x1b[2J{end}", "any", writes=beside(f"\x1b[2J{end}"))
    onto(writer, "a name that is no UTF-8", NOT_UTF8 + end, "any", writes=beside(NOT_UTF8 + end))
    onto(writer, "a new file", out, "any", writes=beside(out))
    if writer not in ("emit c", "states as npy"):
        to_standard_output(writer, command)
    without_room(writer, command, end, force)


def folder_of_somebody(folder):
    (folder / "mine").mkdir()
    (folder / "mine/user.txt").write_text("mine\n")


for writer in FOLDERS:
    onto(writer, "a file of somebody", "user.txt", "refused")
onto("man", "a folder that is not there", "man", "taken", writes=["man"])
onto("man", "a folder", "man", "taken", lambda folder: (folder / "man").mkdir(), writes=["man"])
onto("firmware", "a folder that is not there", "firmware", "taken", writes=["firmware"])
onto("firmware", "a folder of somebody", "mine", "refused", folder_of_somebody)

# A format of tables that `rne log` does not write must not get a table of another format under its name.
onto("log", "a bag", "out.mcap", "refused")

# C: a header beside the source.
onto("emit c", "a header of somebody", "arm.c", "usage", lambda folder: (folder / "arm.h").write_text("// mine\n"))
for out in ("x.h", "x", "x.c.", ".c", "x.H", "-o.c", "x.yaml"):
    stem = os.path.splitext(out)[0]
    case(
        "emit c",
        f"-o{out}",
        lambda trial, out=out, stem=stem: trial.rne(
            "emit", "arm.yaml", "--lang", "c", f"-o{out}", writes=[out, f"{stem}.h", f"{out}.h", ".c.h", "x.h"]
        ),
    )
onto("emit", "the plan with --force", "arm.plan.yaml", "any", writes=["arm.plan.yaml"], flags=["--force"])

if __name__ == "__main__":
    harness.main(CASES)
