"""Gives hostile inputs to a program and judges what it does with them: what every script of this folder is made of.

A script lists cases. Each case has a name, a folder of its own and a process of its own, in which it writes its inputs
and runs commands. Whatever the case expects, every command is held to these rules:

- the exit status is one of those that the case expects, and no signal ends the command,
- nothing of a panic or of an abort is printed, and no escape code,
- status 1 and 2 come with a message, and with status 2 standard output is empty,
- the command takes less than 10 s of processor time and less than 500 MB of memory, and it ends,
- it changes no input and leaves no file but those that it was asked for.

Processor time is counted, not time on the clock, so a busy machine fails nothing. The clock is a limit against hangs
alone: a command that has not ended by then is run once more with a longer limit.

    RNE=target/release/rne python3 tests/doors/csv_logs.py                       all cases
    RNE=target/release/rne python3 tests/doors/csv_logs.py good empty            some of them, by name
    RNE=target/release/rne python3 tests/doors/csv_logs.py --list
    RNE=target/release/rne python3 tests/doors/csv_logs.py --seed 7 --share 0.1  a tenth, drawn by seed and name

`cargo xtask doors` runs all scripts. Python 3.10 or newer on Linux; some scripts need packages of requirements.txt.
"""

import argparse
import contextlib
import hashlib
import json
import os
import pathlib
import resource
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import traceback
from dataclasses import dataclass, field

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
RNE = pathlib.Path(os.environ.get("RNE", ROOT / "target/release/rne")).resolve()

# The limits of a command: processor time in s, memory in MB, and s on the clock at the first and at the second attempt.
SECONDS, MEGABYTES = 10.0, 500.0
CLOCK = (40.0, 160.0)
# A command that wants more is ended before it takes the machine's memory: bytes of address space.
ADDRESS_SPACE = 6 << 30

# The statuses that a case can expect: `taken`, `bad` input, wrong `usage`.
STATUSES = {"taken": (0,), "bad": (1,), "usage": (2,), "refused": (1, 2), "any": (0, 1, 2)}

PANIC = (
    "panicked at",
    "PanicException",
    "RUST_BACKTRACE",
    "thread 'main'",
    "stack overflow",
    "internal error",
    "please report",
    "unreachable code",
    "called `Option",
    "called `Result",
    "memory allocation of",
)


@dataclass
class Answer:
    """What a command did: its status (negative: the signal that ended it) and what it printed."""

    status: int
    out: str
    err: str
    seconds: float
    megabytes: float
    hangs: bool = False

    @property
    def said(self):
        return self.out + self.err


@dataclass
class Case:
    """Something that is tried: `body` takes a Trial. `clock` is for a case that calls a library in its own process."""

    name: str
    body: object
    clock: float | None = None


@dataclass
class Verdict:
    """What came of a case."""

    faults: list = field(default_factory=list)
    commands: int = 0
    seconds: float = 0.0
    megabytes: float = 0.0
    skipped: str = ""


class Skipped(Exception):
    """This machine lacks something that the case needs."""


class Cases(list):
    """The cases of a script; names are told apart."""

    def add(self, name, body, clock=None):
        # names stand in the terminal and on command lines
        name = name.encode("unicode_escape").decode()
        if any(case.name == name for case in self):
            raise ValueError(f"two cases are called {name!r}")
        self.append(Case(name, body, clock))


class Trial:
    """The place of a case: its folder, and the commands that are run and judged there."""

    def __init__(self, folder):
        self.folder = folder
        self.verdict = Verdict()

    def fault(self, what):
        self.verdict.faults.append(what)

    def write(self, name, data):
        """Writes a file. A large one is given as a function, which runs in a process of its own: a process starts with
        the memory of the one that made it, and this must not be counted to the commands."""
        path = self.folder / name
        if callable(data):
            child = os.fork()
            if child == 0:
                try:
                    data(path)
                except Exception:  # noqa: BLE001
                    traceback.print_exc()
                    os._exit(1)
                os._exit(0)
            if os.waitpid(child, 0)[1] != 0:
                raise RuntimeError(f"{name} cannot be made")
        else:
            path.write_bytes(data if isinstance(data, bytes) else data.encode("utf-8", "surrogateescape"))
        return path

    def rne(self, *arguments, **expected):
        """Runs `rne` and judges it by `judge`."""
        return self.judge([RNE, *arguments], **expected)

    def judge(
        self,
        command,
        expected="any",
        says=(),
        never=(),
        names="",
        writes=(),
        seconds=SECONDS,
        megabytes=MEGABYTES,
        folder=None,
        colours=False,
        limits=(),
        **run,
    ):
        """Runs a command in the folder, and notes what is wrong with what it did.

        `says`: what it must print; `never`: what it must not; `names`: what a refusal must name; `writes`: the files
        that it may make or change; `colours`: it prints as on a terminal, where its own colours are right.
        """
        folder = folder or self.folder
        before = digests(folder)
        answer = execute(command, folder, seconds=seconds, colours=colours, limits=limits, **run)
        self.verdict.commands += 1
        self.verdict.seconds = max(self.verdict.seconds, answer.seconds)
        self.verdict.megabytes = max(self.verdict.megabytes, answer.megabytes)
        faults = list(faults_of(answer, expected, seconds, megabytes, colours))
        if any(what == resource.RLIMIT_FSIZE for what, _ in limits):
            # its messages go to a file too
            faults = [fault for fault in faults if fault != "no message"]
        faults += [f"does not say {words!r}" for words in says if words not in answer.said]
        faults += [f"says {words!r}" for words in never if words in answer.said]
        if answer.status in (1, 2) and names and names not in answer.said:
            faults.append(f"does not name {names}")
        faults += list(changes(before, digests(folder), {os.fspath(name) for name in writes}))
        if faults:
            words = [str(word) for word in command]
            words[0] = pathlib.Path(words[0]).name
            shown = shlex.join(words)[:200].encode("unicode_escape").decode()
            self.fault(f"{shown}: {'; '.join(faults)}; it says {answer.said.strip()[:200]!r}")
        return answer


def faults_of(answer, expected, seconds=SECONDS, megabytes=MEGABYTES, colours=False):
    """What is wrong with an answer whatever the input was."""
    if answer.hangs:
        yield f"does not end within {CLOCK[-1]:.0f} s"
    elif answer.status == -signal.SIGXCPU:
        yield f"takes more than {seconds:.0f} s of processor time"
    elif answer.status not in STATUSES[expected]:
        ended = f"signal {-answer.status}" if answer.status < 0 else f"status {answer.status}"
        yield f"{ended}, expected {expected}"
    if answer.seconds > seconds and answer.status != -signal.SIGXCPU:
        yield f"takes {answer.seconds:.1f} s of processor time"
    if answer.megabytes > megabytes:
        yield f"takes {answer.megabytes:.0f} MB"
    for words in PANIC:
        if words in answer.said:
            yield f"panics: {words!r}"
    if answer.status in (1, 2) and not answer.said.strip():
        yield "no message"
    if answer.status == 2 and answer.out.strip():
        yield "status 2 with standard output"
    if "\x1b" in answer.said and not colours:
        yield "escape codes where there is no terminal"


def digests(folder):
    """What a folder has: its files by digest, large ones by size and time, other entries by kind."""
    found = {}
    for root, folders, names in os.walk(folder):
        for name in names + folders:
            path = os.path.join(root, name)
            status = os.lstat(path)
            key = os.path.relpath(path, folder)
            if not os.path.isfile(path) or os.path.islink(path):
                found[key] = status.st_mode
            elif status.st_size < 8 << 20:
                with open(path, "rb") as file:
                    found[key] = hashlib.sha1(file.read()).hexdigest()
            else:
                found[key] = (status.st_size, status.st_mtime_ns)
    return found


def changes(before, after, allowed):
    """Files that were changed, lost or left."""
    is_allowed = lambda path: path in allowed or any(path.startswith(name + os.sep) for name in allowed)
    for path, value in before.items():
        if not is_allowed(path):
            if path not in after:
                yield f"loses {path}"
            elif after[path] != value:
                yield f"changes {path}"
    for path in after:
        if path not in before and not is_allowed(path):
            yield f"leaves {path}"


def execute(command, folder, stdin=None, seconds=SECONDS, limits=(), clock=None, limited=True, colours=False):
    """Runs a command to its end, a second time where the clock ended it.

    `stdin`: a file, which it gets by a pipe; `limits`: pairs of what is limited and how; `limited`: whether its address
    space is, which a program with sanitizers does not bear.
    """
    for patience in (clock,) if clock else CLOCK:
        answer = attempt(command, folder, stdin, seconds, limits, patience, limited, colours)
        if not answer.hangs:
            break
    return answer


def attempt(command, folder, stdin, seconds, limits, clock, limited, colours):
    def set_up():
        os.setsid()
        heed_signals()
        time_limit(seconds)
        if limited:
            resource.setrlimit(resource.RLIMIT_AS, (ADDRESS_SPACE, ADDRESS_SPACE))
        for what, value in limits:
            resource.setrlimit(what, (value, value))
            if what == resource.RLIMIT_FSIZE:
                signal.signal(signal.SIGXFSZ, signal.SIG_IGN)

    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err, contextlib.ExitStack() as stack:
        source = subprocess.DEVNULL
        if stdin is not None:
            feeder = stack.enter_context(subprocess.Popen(["cat", stdin], stdout=subprocess.PIPE, stderr=err))
            source = feeder.stdout
        child = subprocess.Popen(
            [os.fspath(word) if isinstance(word, os.PathLike) else str(word) for word in command],
            cwd=folder,
            stdin=source,
            stdout=out,
            stderr=err,
            env={**os.environ, "CLICOLOR_FORCE": "1"} if colours else None,
            preexec_fn=set_up,  # noqa: PLW1509
        )
        if stdin is not None:
            feeder.stdout.close()
        hangs, status, usage = wait(child.pid, clock, whole_group=True)
        child.returncode = status
        texts = []
        for file in (out, err):
            file.seek(0)
            texts.append(file.read(4 << 20).decode("utf-8", "replace"))
    return Answer(status, *texts, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, hangs)


def heed_signals():
    """A process that was started in the background, as by CI, passes over these, and its children would too."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)


def time_limit(seconds):
    """The kernel ends this process a little after so much processor time."""
    limit = int(seconds) + 1
    resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 5))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def wait(pid, clock, whole_group=False):
    """Waits for a process, and ends it when the clock is over: whether it was, its status and what it took."""
    end, pause, hangs = time.monotonic() + clock, 0.001, False
    while True:
        done, status, usage = os.wait4(pid, os.WNOHANG)
        if done:
            return hangs, os.waitstatus_to_exitcode(status), usage
        if time.monotonic() > end:
            hangs = True
            # a process that is not yet the first of its group is ended by itself
            for end_it in (os.killpg, os.kill) if whole_group else (os.kill,):
                with contextlib.suppress(ProcessLookupError):
                    end_it(pid, signal.SIGKILL)
        time.sleep(pause)
        pause = min(2 * pause, 0.02)


def run(case, place):
    """Runs a case, once more where it calls a library in its own process and the clock ended it."""
    for clock in (case.clock, 4 * case.clock) if case.clock else (3600.0,):
        verdict = run_once(case, place, clock)
        if verdict:
            return verdict
    return Verdict(faults=[f"does not end within {clock:.0f} s"])


def run_once(case, place, clock):
    """The verdict of a case, which runs in a process of its own; None where the clock ended it."""
    folder, report = place / "case", place / "verdict.json"
    folder.mkdir()
    pid = os.fork()
    if pid == 0:
        report.write_text(json.dumps(vars(verdict_of(case, folder))))
        os._exit(0)
    hangs, status, usage = wait(pid, clock, whole_group=bool(case.clock))
    shutil.rmtree(folder, ignore_errors=True)
    if hangs:
        return None
    if status != 0:
        return Verdict(faults=[f"its process ends with {status}"])
    verdict = Verdict(**json.loads(report.read_text()))
    if case.clock:
        verdict.seconds, verdict.megabytes = usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024
        if verdict.megabytes > MEGABYTES:
            verdict.faults.append(f"takes {verdict.megabytes:.0f} MB")
    return verdict


def verdict_of(case, folder):
    trial = Trial(folder)
    if case.clock:
        os.setsid()
        time_limit(case.clock)
    try:
        case.body(trial)
    except Skipped as lack:
        trial.verdict.skipped = str(lack)
    except BaseException as error:  # noqa: BLE001 (a panic is no Exception)
        place = traceback.extract_tb(error.__traceback__)[-1]
        said = " ".join(str(error).split())[:300]
        trial.fault(f"{pathlib.Path(place.filename).name}:{place.lineno}: {type(error).__name__}: {said}")
    sys.stdout.flush()
    return trial.verdict


def is_drawn(script, name, seed, share):
    """Whether a case is part of a draw: seed and name alone decide, not the other cases."""
    number = int.from_bytes(hashlib.sha256(f"{seed}/{script}/{name}".encode()).digest()[:8], "big")
    return number < share * 2**64


def main(cases):
    """The command line of a script."""
    script = pathlib.Path(sys.argv[0]).stem
    parser = argparse.ArgumentParser(prog=f"{script}.py", description=sys.modules["__main__"].__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="run these cases alone")
    parser.add_argument("--list", action="store_true", help="print the names of the cases")
    parser.add_argument("--seed", default="0", help="what draws the cases [default: 0]")
    parser.add_argument("--share", type=float, default=1.0, help="the share of the cases that is drawn [default: 1]")
    parser.add_argument("--summary", type=pathlib.Path, metavar="FILE", help="write what came of it, as JSON")
    options = parser.parse_args()
    if unknown := set(options.names) - {case.name for case in cases}:
        parser.error(f"there is no case {min(unknown)!r} (--list prints their names)")
    drawn = [case for case in cases if is_drawn(script, case.name, options.seed, options.share)]
    if options.names:
        drawn = [case for case in cases if case.name in options.names]
    if options.list:
        print("\n".join(case.name for case in drawn))
        return
    verdicts = []
    with tempfile.TemporaryDirectory(prefix="doors-") as place:
        for case in drawn:
            verdict = run(case, pathlib.Path(place))
            verdicts.append(verdict)
            if verdict.faults:
                more = f" (and {len(verdict.faults) - 1} more)" if len(verdict.faults) > 1 else ""
                repeat = f"python3 tests/doors/{script}.py {shlex.quote(case.name)}"
                # all that is wrong is told where the case is repeated
                told = "\n    ".join(verdict.faults) if options.names else verdict.faults[0] + more
                print(f"FAILED {case.name}: {told} [{repeat}]", flush=True)
            elif verdict.skipped:
                print(f"skipped {case.name}: {verdict.skipped}", flush=True)
    failed = sum(bool(verdict.faults) for verdict in verdicts)
    skipped = sum(bool(verdict.skipped) and not verdict.faults for verdict in verdicts)
    summary = {
        "cases": len(verdicts),
        "commands": sum(verdict.commands for verdict in verdicts),
        "failed": failed,
        "skipped": skipped,
        "seconds": max((verdict.seconds for verdict in verdicts), default=0.0),
        "megabytes": max((verdict.megabytes for verdict in verdicts), default=0.0),
    }
    if options.summary:
        options.summary.write_text(json.dumps(summary))
    print(f"{script}: {len(verdicts) - failed - skipped} passed, {failed} failed, {skipped} skipped")
    sys.exit(failed > 0)
