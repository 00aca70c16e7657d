"""The C library under capi.c: one case for each part of that program, which also runs with the compiler's sanitizers.

Needs cc and the prefix that `cargo xtask capi` makes, in PREFIX.
"""

import functools
import math
import os
import pathlib
import shutil
import subprocess
import tempfile

import harness

CASES = harness.Cases()
PREFIX = pathlib.Path(os.environ.get("PREFIX", harness.ROOT / "target/capi/prefix")).resolve()
SOURCE = harness.ROOT / "tests/doors/capi.c"
PARTS = ("no_arm", "arms", "arguments", "inputs", "strides", "lengths", "single", "not_finite", "threads", "lifetimes")
FLAGS = {
    "plain": ["-O1"],
    "sanitized": ["-O1", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"],
}
PLACE = tempfile.TemporaryDirectory(prefix="doors-")


@functools.cache
def compiled(kind):
    """The program, compiled; a case is skipped where it cannot be."""
    if not shutil.which("cc") or not (PREFIX / "include/rne.h").exists():
        raise harness.Skipped("there is no cc, or no library in PREFIX (cargo xtask capi)")
    program, library = pathlib.Path(PLACE.name) / kind, PREFIX / "lib"
    words = ["cc", "-std=c11", "-D_GNU_SOURCE", "-Wall", "-Wextra", "-Werror", *FLAGS[kind], f"-I{PREFIX / 'include'}"]
    words += [SOURCE, f"-L{library}", "-lrne", "-lm", "-pthread", f"-Wl,-rpath,{library}", "-o", program]
    subprocess.run(words, check=True)
    return program


def part(kind, name):
    def body(trial):
        # a sanitizer keeps freed memory
        is_plain = kind == "plain"
        most = {} if is_plain else {"megabytes": math.inf}
        trial.judge([compiled(kind), name], "taken", limited=is_plain, **most)

    return body


for kind in FLAGS:
    for name in PARTS:
        CASES.add(f"{name}, {kind}", part(kind, name))

if __name__ == "__main__":
    harness.main(CASES)
