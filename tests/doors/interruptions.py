"""Commands that are interrupted: by a reader that goes, a closed or full stream, a signal, a full disk, each other.

Nothing half is written and nothing is left behind. A full disk needs a user who may mount one.
"""

import contextlib
import os
import shlex
import signal
import subprocess
import time

import harness
from written_files import furnish, printed

CASES = harness.Cases()
WAIT_AT_MOST = 60
LONG_ROWS = 1_500_000
PLAN = "arm.plan.yaml"


def states_of(count):
    """So many states: a function that writes them."""
    head, *rows = [
        line for line in (harness.DOCS / "states.csv").read_bytes().splitlines() if not line.startswith(b"#")
    ]
    block = b"\n".join(rows) + b"\n"

    def write(path):
        with open(path, "wb") as file:
            file.write(head + b"\n")
            file.writelines(block for _ in range(count // len(rows)))

    return write


def case(name, body):
    def furnished(trial):
        furnish(trial.folder)
        body(trial)

    CASES.add(name, furnished)


# Streams.
STREAMS = [
    ["show", "arm.yaml"],
    ["emit", "arm.yaml"],
    ["report", "arm.yaml", "-o", "-"],
    ["plot", "planar2.yaml"],
    ["plot", "planar2.yaml", "--csv"],
    ["eval", "planar2.yaml", "--states", "big.csv"],
    ["log", "log.csv", "-o", "-"],
    ["identify", "desk.yaml", "log.csv", "-o", "-"],
    ["list"],
    ["check", "arm.yaml"],
    ["man"],
    ["explain", "functions"],
    ["completions", "bash"],
    ["--help"],
    ["--version"],
    ["emit", "--help"],
    ["example", "puma560"],
    ["export", "arm.yaml", "--urdf"],
    ["excite", "planar2.yaml", "--evaluations", "5", "-o", "-"],
    [],
]
# What the shell does with the streams, and the status that must come of it.
PIPES = {
    "a reader that goes": ("| head -c 1 > /dev/null; exit ${PIPESTATUS[0]}", "taken"),
    "a full output": ("> /dev/full", "bad"),
    "no output": (">&-", "any"),
    "no errors": ("2>&- > /dev/null", "any"),
    "no stream at all": ("<&- >&- 2>&-", "any"),
    "full errors": ("2> /dev/full > /dev/null", "any"),
}


def stream(command, pipe, expected):
    def body(trial):
        if "big.csv" in command:
            trial.write("big.csv", states_of(200_000))
        line = f"{shlex.join([str(harness.RNE), *command])} {pipe}"
        run = harness.execute(["bash", "-c", line], trial.folder)
        trial.verdict.commands += 1
        # where standard error is closed there is no message to read
        faults = [fault for fault in harness.faults_of(run, expected) if fault != "no message"]
        for fault in faults:
            trial.fault(f"rne {shlex.join(command)} {pipe}: {fault}; it says {run.err[:200]!r}")

    return body


for command in STREAMS:
    for what, (pipe, expected) in PIPES.items():
        case(f"{what}: rne {shlex.join(command)}", stream(command, pipe, expected))


# Signals.
def started(trial, *command):
    words = [os.fspath(harness.RNE), *map(str, command)]
    trial.verdict.commands += 1
    return subprocess.Popen(
        words,
        cwd=trial.folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=harness.heed_signals,  # noqa: PLW1509
    )


def ended(trial, child):
    """What a process that was started said, and its status; a fault where it goes on."""
    try:
        out, err = child.communicate(timeout=WAIT_AT_MOST)
    except subprocess.TimeoutExpired:
        child.kill()
        out, err = child.communicate()
        trial.fault(f"does not end within {WAIT_AT_MOST} s")
    if any(words in out + err for words in harness.PANIC):
        trial.fault(f"panics: {err[:300]!r}")
    return out + err


def until(condition, seconds=WAIT_AT_MOST):
    """Waits until something is so; whether it is."""
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.005)
    return True


def has_begun(folder, before):
    """Whether a command has begun to write: there is a new entry with something in it."""
    for name in set(os.listdir(folder)) - before:
        with contextlib.suppress(FileNotFoundError):
            if os.stat(folder / name).st_size > 0:
                return True
    return False


WRITERS = {
    "eval as CSV": (["eval", "planar2.yaml", "--states", "big.csv", "-o", "out.csv"], "out.csv"),
    "eval as npy": (["eval", "planar2.yaml", "--states", "big.csv", "-o", "out.npy"], "out.npy"),
    "log": (["log", "long.csv", "-o", "out.csv"], "out.csv"),
}


def long_log(path):
    lines = [line for line in (harness.DOCS / "desk_arm_log.csv").read_bytes().splitlines() if line[:1] not in b"#"]
    rows = [line.split(b",", 1)[1] for line in lines[1:]]
    rows += rows[::-1]
    with open(path, "wb") as file:
        file.write(lines[0] + b"\n")
        file.writelines(b"%.2f,%s\n" % (i * 0.04, rows[i % len(rows)]) for i in range(LONG_ROWS // 2))


def interrupted(command, out, number):
    """A command that writes for long is ended by a signal: what it wrote so far is gone."""

    def body(trial):
        if "long.csv" in command:
            trial.write("long.csv", long_log)
        else:
            trial.write("big.csv", states_of(LONG_ROWS))
        before = set(os.listdir(trial.folder))
        child = started(trial, *command)
        if not until(lambda: child.poll() is not None or has_begun(trial.folder, before)):
            trial.fault("writes nothing")
        with contextlib.suppress(ProcessLookupError):
            child.send_signal(number)
        ended(trial, child)
        left = set(os.listdir(trial.folder)) - before
        if child.returncode == 0 and left == {out}:
            return
        if left:
            trial.fault(f"status {child.returncode}, and it leaves {sorted(left)}")

    return body


SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
for writer, (command, out) in WRITERS.items():
    for number in SIGNALS:
        case(f"{number.name}: {writer}", interrupted(command, out, number))


def is_whole(trial):
    """The plan is none, or one that `rne check` takes; nothing is left beside it."""
    left = [name for name in os.listdir(trial.folder) if name.endswith(".tmp")]
    if left:
        trial.fault(f"it leaves {left}")
    if (trial.folder / PLAN).exists():
        trial.rne("check", "arm.yaml", expected="taken")


def searched(number, delay, again=None):
    def body(trial):
        child = started(trial, "search", "arm.yaml", "--seconds", "5", "--rewrite")
        time.sleep(delay)
        child.send_signal(number)
        if again is not None:
            time.sleep(again)
            with contextlib.suppress(ProcessLookupError):
                child.send_signal(number)
        ended(trial, child)
        if again is not None and child.returncode not in (0, 130, -signal.SIGINT):
            trial.fault(f"status {child.returncode}")
        is_whole(trial)

    return body


for number in SIGNALS:
    for delay in (0.02, 0.1, 0.5, 1.5):
        case(f"{number.name}: search after {delay} s", searched(number, delay))
for again in (0.0, 0.01, 0.05, 0.3):
    case(f"SIGINT twice: search, again after {again} s", searched(signal.SIGINT, 0.7, again))


# Searches beside each other, and beside a person.
def four_searches(trial_number):
    def body(trial):
        flags = ["--fresh"] if trial_number % 2 else []
        seeds = [str(i + 10 * trial_number) for i in range(4)]
        command = ["search", "arm.yaml", "--seconds", "1", "--rewrite", *flags]
        children = [started(trial, *command, "--seed", seed) for seed in seeds]
        for child in children:
            said = ended(trial, child)
            if child.returncode != 0:
                trial.fault(f"one of four searches ends with status {child.returncode}: {said[:200]!r}")
        is_whole(trial)

    return body


for number in range(6):
    case(f"four searches at once {number}", four_searches(number))


def searching(trial, meanwhile):
    """Does something while a search runs; what the search said, and its status."""
    child = started(trial, "search", "arm.yaml", "--seconds", "2")
    time.sleep(0.7)
    meanwhile()
    said = ended(trial, child)
    return child.returncode, said


def robot_changes(trial):
    """The robot becomes another one: no plan of the old one may stand beside it as if it were good."""
    path = trial.folder / "arm.yaml"
    status, said = searching(trial, lambda: path.write_bytes(printed("example", "ur5")))
    check = trial.rne("check", "arm.yaml", never=["rne search: it is written"])
    if status == 0 and check.status != 0:
        trial.fault(f"rne search: status 0 for an arm that changed meanwhile; it says {said[-200:]!r}")
    if (trial.folder / PLAN).exists() and check.status != 0:
        trial.fault("rne search: a plan of the arm as it was stands beside the arm as it is")


def notes_appear(trial):
    """A file of a person appears where the plan goes."""
    status, said = searching(trial, lambda: (trial.folder / PLAN).write_text("my notes\n"))
    if (trial.folder / PLAN).read_text() != "my notes\n":
        trial.fault("rne search: it overwrites a file that is no plan")
    if status == 0:
        trial.fault(f"rne search: status 0, though the plan is not written; it says {said[-200:]!r}")


def wrong_plan_appears(trial):
    """A plan that cannot be proved appears where the plan goes: it is not merged."""
    plan = printed("example", "puma560", "--plan").decode()
    wrong = plan.replace("+", "-", 3).replace("sin", "cos", 2)
    searching(trial, lambda: (trial.folder / PLAN).write_text(wrong))
    if (trial.folder / PLAN).read_text() != wrong:
        trial.rne("check", "arm.yaml", expected="taken")


case("search, the robot changes meanwhile", robot_changes)
case("search, notes appear meanwhile", notes_appear)
case("search, a wrong plan appears meanwhile", wrong_plan_appears)


def two_writers(trial):
    """Two writers replace a file over and over, and a reader sees one whole file or the other."""
    rne = shlex.quote(str(harness.RNE))
    line = "for i in $(seq 40); do {} emit {}.yaml -o out.rs --force > /dev/null 2>&1; done"
    trial.rne("emit", "arm.yaml", "-o", "out.rs", writes=["out.rs"])
    loops = [line.format(rne, arm) for arm in ("arm", "planar2")]
    writers = [subprocess.Popen(["bash", "-c", loop], cwd=trial.folder) for loop in loops]
    sizes = set()
    while any(writer.poll() is None for writer in writers):
        sizes.add(len((trial.folder / "out.rs").read_bytes()))
    if len(sizes) > 2:
        trial.fault(f"files of {sorted(sizes)} bytes are seen")


case("two writers and a reader", two_writers)


# A full disk.
@contextlib.contextmanager
def small_disk(trial, size="300k"):
    """A file system of its own with the files that the commands read."""
    place = trial.folder / "disk"
    place.mkdir()
    mounted = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", f"size={size}", "none", place], check=False, capture_output=True
    )
    if mounted.returncode != 0:
        raise harness.Skipped("this user may not mount a file system")
    try:
        for name in ("arm.yaml", "planar2.yaml", "states.csv"):
            (place / name).write_bytes((trial.folder / name).read_bytes())
        yield place
    finally:
        subprocess.run(["umount", place], check=True)


def fill(place, free):
    disk = os.statvfs(place)
    (place / "fill").write_bytes(bytes(max(0, disk.f_bavail * disk.f_bsize - free)))


FULL = {
    "report": (["report", "arm.yaml", "-o", "old.html", "--force"], 40),
    "emit": (["emit", "arm.yaml", "--function", "all", "-o", "x.rs"], 40),
    "emit c": (["emit", "arm.yaml", "--lang", "c", "--function", "all", "-o", "x.c"], 40),
    "firmware": (["firmware", "torque", "-o", "firmware"], 40),
    "man": (["man", "-o", "man"], 20),
    "search": (["search", "arm.yaml", "--seconds", "1"], 2),
    "eval": (["eval", "planar2.yaml", "--states", "../big.csv", "-o", "out.csv"], 40),
    "plot": (["plot", "arm.yaml", "-o", "x.svg"], 2),
}


def full_disk(command, kilobytes):
    """What is written on a full disk is whole, or it is not there: not one of two files, not half a folder."""

    def body(trial):
        if "../big.csv" in command:
            trial.write("big.csv", states_of(20_000))
        with small_disk(trial) as place:
            (place / "old.html").write_text("old\n")
            (place / "man").mkdir()
            fill(place, kilobytes << 10)
            before = harness.digests(place)
            answer = trial.rne(*command, folder=place, writes=["old.html", *small_outputs(command)])
            left = harness.digests(place).keys() - before.keys()
            if answer.status != 0 and left:
                trial.fault(f"status {answer.status}, and it leaves {sorted(left)}")
            if answer.status != 0 and (place / "old.html").read_text() != "old\n":
                trial.fault("the file that was there is lost")

    return body


def small_outputs(command):
    """The names that a command may write, a header beside its source included."""
    out = command[command.index("-o") + 1] if "-o" in command else PLAN
    return [out, os.path.splitext(out)[0] + ".h"]


for name, (command, kilobytes) in FULL.items():
    case(f"full disk: {name}", full_disk(command, kilobytes))


def pair_on_a_full_disk(trial):
    """A source and its header are there: after a failure both are the old ones."""
    with small_disk(trial) as place:
        emit = ["emit", "arm.yaml", "--lang", "c", "-o", "x.c"]
        trial.rne(*emit, folder=place, expected="taken", writes=["x.c", "x.h"])
        old = [(place / name).read_bytes() for name in ("x.c", "x.h")]
        for kilobytes in (0, 4, 8, 16, 24, 32, 48):
            fill(place, kilobytes << 10)
            command = [*emit, "--function", "all", "--force"]
            answer = trial.rne(*command, folder=place, writes=["x.c", "x.h"])
            now = [(place / name).read_bytes() for name in ("x.c", "x.h")]
            if answer.status != 0 and now != old:
                trial.fault(f"{kilobytes} kB are free: one file is new and the other one is old")
            (place / "fill").unlink()
            if answer.status == 0:
                break


case("full disk: a source and its header are there", pair_on_a_full_disk)

if __name__ == "__main__":
    harness.main(CASES)
