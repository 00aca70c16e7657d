"""Certifies emitted code: `cargo xtask certify-all`.

    python3 tests/certify/all.py --rne target/debug/rne [--all | --seed S]

For each shipped robot, of inverse_dynamics and gravity_torques:

c f32      `rne certify --evidence`: compiler, listing, QEMU; check_c.py checks the C, with rotors and the observer
rust f32   `rne certify --lang rust`
c f64      check_c.py checks the C with `double`, and the tests of `rne emit --tests` run on this computer
rust f64   the tests of `rne emit --lang rust --with-sin-cos --tests` run on this computer

A Cortex-M4 has no unit for double precision, so `rne certify` has no figures of it. A cell of the table is the number of
instructions of inverse_dynamics, or the number of tests. Then comes every function of four small robots, alone, in C and,
where it takes joints alone, in Rust. Then come random arms (arms.py), whose C is also compared with a
recursion of its own, and changed sources, which check_c.py must refuse.
"""
import argparse
import json
import random
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import arms

ROOT = Path(__file__).resolve().parents[2]
CHECKER = ROOT / "firmware/certify/checker/check_c.py"
FUNCTIONS = "inverse_dynamics,gravity_torques"
SMALL = ["robots/scara_cobra600.yaml", "docs/satellite.yaml", "benches/trees/loops/five_bar.yaml",
         "benches/trees/loops/floating_four_bar_leg.yaml"]


class Failed(Exception):
    """A certificate that is none."""


def run(*words, cwd=ROOT):
    done = subprocess.run([str(word) for word in words], cwd=cwd, capture_output=True, text=True, check=False)
    if done.returncode:
        raise Failed(f"{' '.join(map(str, words))}\n{(done.stdout + done.stderr)[-3000:]}")
    return done.stdout


def checked(*files):
    """What check_c.py prints; it accepts the source, or does not support the robot."""
    done = subprocess.run([sys.executable, CHECKER, *files], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


class Robot:
    def __init__(self, rne, path, folder):
        self.rne, self.path, self.folder = rne, path, folder
        self.rotors = ["--rotors"] if re.search(r"\bmotor:", path.read_text()) else []
        self.passed = 0

    def certify(self, *more):
        words = [self.rne, "certify", self.path, "--function", FUNCTIONS, "--states", "100", "--json", *self.rotors, *more]
        return json.loads(run(*words))["cost"]["instructions"]

    def check(self):
        stem = self.folder / self.path.stem
        status, said = checked(stem.with_suffix(".c"), stem.with_suffix(".trace.json"), self.path)
        if status != 0 and not said.startswith("not supported: "):
            raise Failed(f"check_c.py refuses {self.path.name}: {said}")
        self.passed += status == 0

    def c_f32(self):
        cost = self.certify("--observer", "--evidence", self.folder)
        self.check()
        return cost

    def rust_f32(self):
        return self.certify("--lang", "rust")

    def tests(self, output, *compile):
        function = ["--function", FUNCTIONS, *self.rotors]
        run(self.rne, "emit", self.path, *function, "--tests", "--force", "-o", output, *compile)

    def c_f64(self):
        self.certify("--real", "double", "--evidence", self.folder)
        self.check()
        source, program = self.folder / "tested.c", self.folder / "tested"
        self.tests(source, "--lang", "c", "--real", "double")
        run("cc", "-std=c99", "-O1", "-ffp-contract=off", "-DRNE_TEST", "-o", program, source, "-lm")
        return re.search(r"(\d+ tests), 0 wrong", run(program)).group(1)

    def rust_f64(self):
        source, program = self.folder / "tested.rs", self.folder / "tested_rs"
        self.tests(source, "--lang", "rust", "--form", "reduced", "--with-sin-cos")
        run("rustc", "--edition", "2024", "--test", "-o", program, source)
        return re.search(r"(\d+) passed; 0 failed", run(program)).group(1) + " tests"


CELLS = {"c f32": Robot.c_f32, "rust f32": Robot.rust_f32, "c f64": Robot.c_f64, "rust f64": Robot.rust_f64}


def robots(rne, chosen, folder):
    failures, passed = [], 0
    print("| robot | " + " | ".join(CELLS) + " | s |\n|---|" + "---:|" * (len(CELLS) + 1), flush=True)
    for path in chosen:
        start, cells, robot = time.monotonic(), [], Robot(rne, path, folder)
        for name, cell in CELLS.items():
            try:
                cells.append(str(cell(robot)))
            except (Failed, AttributeError) as error:
                cells.append("FAILS")
                failures.append(f"{path.stem}, {name}: {error}")
        passed += robot.passed
        print(f"| {path.stem} | {' | '.join(cells)} | {time.monotonic() - start:.0f} |", flush=True)
    print(f"{len(chosen)} robots, {len(chosen) * len(CELLS)} certificates, {len(failures)} fail; check_c.py accepts {passed}")
    return failures


def all_functions(rne, folder):
    """Certifies every function of a chain, of robots with a floating base and of a closed loop, in C and in Rust."""
    failures, passed, refused, source = [], 0, [], folder / "all.c"
    for path in [ROOT / path for path in SMALL]:
        run(rne, "emit", path, "--lang", "c", "--function", "all", "--prefix", "robot", "--force", "-o", source)
        header = source.with_suffix(".h").read_text()
        for name in re.findall(r"^(?:void|float) robot_(?!observer)(\w+)\(", header, re.MULTILINE):
            for language in ["c", "rust"] if path.stem == "scara_cobra600" else ["c"]:
                words = [rne, "certify", path, "--function", name, "--states", "20", "--lang", language]
                said = subprocess.run(list(map(str, words)), capture_output=True, text=True, check=False)
                passed += said.returncode == 0
                if said.returncode and re.search("is not straight|arrays of the joints alone", said.stderr):
                    refused.append((name, language))
                elif said.returncode:
                    failures.append(f"{path.stem}, {name}, {language}: {said.stderr[-2000:]}")
    # friction has branches; all other C is straight
    if {name for name, language in refused if language == "c"} - {"actuator_torques"}:
        failures.append(f"refused: {refused}")
    print(f"{passed} certificates of single functions, {len(refused)} refused, {len(failures)} fail")
    return failures


def random_arms(rne, seeds, folder):
    failures, refused, worst = [], 0, {"float": 0.0, "double": 0.0}
    for number, seed in enumerate(seeds):
        kind = ["format 1", "format 2", "tree"][number % 3]
        real, rotors = ["double", "float"][number // 3 % 2], number % 4 != 3
        arm = arms.arm(seed, kind)
        path = folder / "arm.yaml"
        path.write_text(arms.robot_file(arm))
        what = f"random arm {seed}, {kind}, {real}"
        try:
            evidence = ["--evidence", folder, "--real", real, "--states", "1", *["--rotors"] * rotors]
            functions = "inverse_dynamics,bias_torques,gravity_torques"
            said = subprocess.run([rne, "certify", path, "--function", functions, "--observer", *evidence],
                                  capture_output=True, text=True, check=False)
            if said.returncode:
                raise Failed(said.stderr)
            source, trace = folder / "arm.c", folder / "arm.trace.json"
            status, said = checked(source, trace, path)
            if status:
                raise Failed(said)
            error = arms.compare(arm, source, real, rotors, seed)
            worst[real] = max(worst[real], error)
            if error > {"float": 2e-4, "double": 1e-11}[real]:
                raise Failed(f"differs from the recursion by {error}")
            text = source.read_text()
            functions = ["inverse_dynamics", "observer_update"]
            for function in functions:
                for old, mutant in arms.mutants(text, function, random.Random(seed)):
                    source.write_text(mutant)
                    status, said = checked(source, trace, path)
                    if status != 1 or "wrong: " not in said or "parent" in said:
                        raise Failed(f"{function}, {old.strip()!r} changed: {said}")
                    refused += 1
            # a number of the robot file that the code does not have
            source.write_text(text)
            for key in ["mass: ", "gear_ratio: "] if rotors else ["mass: "]:
                path.write_text(path.read_text().replace(key, f"{key}1.5 * ", 1))
                status, said = checked(source, trace, path)
                if status != 1 or "in the robot file" not in said:
                    raise Failed(f"another {key}: {said}")
                path.write_text(arms.robot_file(arm))
        except Failed as error:
            failures.append(f"{what}: {error}")
    print(f"{len(seeds)} random arms, {refused} changed sources refused, {len(failures)} fail; the C differs from the "
          f"recursion by {worst['double']:.1e} (double) and {worst['float']:.1e} (float) of the largest torque")
    return failures


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rne", type=Path, required=True)
    parser.add_argument("--all", action="store_true", help="all shipped robots and 60 random arms")
    parser.add_argument("--seed", default="1", help="draws 3 robots and 6 random arms")
    parser.add_argument("names", nargs="*", help="robots, instead of drawing them")
    given = parser.parse_args()
    draw = random.Random(given.seed)
    files = sorted(path for path in [*ROOT.glob("robots/*.yaml"), *ROOT.glob("robots/trees/*.yaml")]
                   if not path.name.endswith(".plan.yaml"))
    chosen = files if given.all else sorted(draw.sample(files, 3))
    if given.names:
        chosen = [path for path in files if path.stem in given.names]
    seeds = [draw.randrange(10**6) for _ in range(60 if given.all else 6)]
    print(f"seed {given.seed}", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        failures = robots(given.rne.resolve(), chosen, Path(folder))
        failures += all_functions(given.rne.resolve(), Path(folder))
        failures += random_arms(given.rne.resolve(), seeds, Path(folder))
    for failure in failures:
        print(failure)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
