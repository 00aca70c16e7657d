"""Plan files beside a robot file: mangled, of another robot, no files at all. None may lead to other code."""

import functools
import os
import random
import re
import subprocess

import harness
from robots import BOMB

CASES = harness.Cases()
COMMANDS = (["check"], ["emit", "--form", "reduced"], ["ops"])


@functools.cache
def example(*options):
    return subprocess.run([harness.RNE, "example", *options], capture_output=True, text=True, check=True).stdout


def robot():
    return example("planar2")


def plan():
    return example("planar2", "--plan")


def planned(name, make, expected="any"):
    """A case of the text of a plan, which a function makes."""

    def body(trial):
        path = trial.write("robot.yaml", robot())
        trial.write("robot.plan.yaml", make())
        for command, *options in COMMANDS:
            trial.rne(command, path, *options, expected=expected)
        given = (trial.folder / "robot.plan.yaml").read_bytes()
        answer = trial.rne("search", path, "--seconds", "0", writes=["robot.plan.yaml"])
        if answer.status != 0 and (trial.folder / "robot.plan.yaml").read_bytes() != given:
            trial.fault("rne search: it fails, and the file at the place of the plan is another one")

    CASES.add(name, body)


def mangled(seed):
    """Lines removed, repeated, with other numbers, with other signs."""

    def make():
        draw, lines = random.Random(seed), plan().splitlines()
        for _ in range(draw.randrange(1, 4)):
            i = draw.randrange(len(lines))
            what = draw.randrange(4)
            if what == 0:
                del lines[i]
            elif what == 1:
                lines.insert(i, lines[draw.randrange(len(lines))])
            elif what == 2:
                number = str(draw.choice([0, -1, 99999999999999999999, 3]))
                lines[i] = re.sub(r"\d+", number, lines[i], count=1)
            else:
                lines[i] = lines[i].replace("+", "-").replace("*", "+")
        return "\n".join(lines) + "\n"

    return make


planned("good", plan, "taken")
planned("empty", lambda: "", "bad")
planned("noise", lambda: random.Random(1).randbytes(1000), "bad")
planned("notes of a person", lambda: "my notes\n", "bad")
planned("cut", lambda: plan()[: len(plan()) // 2])
planned("a robot", robot, "bad")
planned("bomb of aliases", lambda: BOMB + plan(), "bad")
planned("17 MB", lambda: plan() + "#" * (17 << 20))
planned("of another robot", lambda: re.sub(r"robot: .*", "robot: ../../etc/passwd", plan()))
planned("fingerprint 0", lambda: re.sub(r"fingerprint: .*", "fingerprint: 0", plan()), "bad")
planned("fingerprint of 400 digits", lambda: re.sub(r"fingerprint: .*", "fingerprint: " + "9" * 400, plan()), "bad")
planned("deep lists", lambda: "[" * 100_000, "bad")
planned("lines of Windows", lambda: plan().replace("\n", "\r\n"))
for seed in range(30):
    planned(f"mangled {seed}", mangled(seed))


def no_file(make):
    def body(trial):
        path = trial.write("robot.yaml", robot())
        make(trial.folder / "robot.plan.yaml")
        trial.rne("check", path, expected="bad")
        trial.rne("search", path, "--seconds", "0", expected="bad")

    return body


CASES.add("a folder", no_file(lambda path: path.mkdir()))
CASES.add("a pipe", no_file(os.mkfifo))

if __name__ == "__main__":
    harness.main(CASES)
