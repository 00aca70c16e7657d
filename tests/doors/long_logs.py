"""Logs of millions of rows: memory must not grow with them. A draw has the shorter ones."""

import struct

import harness
from harness import DOCS

CASES = harness.Cases()
LINES = [line for line in (DOCS / "desk_arm_log.csv").read_bytes().splitlines() if line and not line.startswith(b"#")]
HEAD, ROWS = LINES[0], [line.split(b",", 1)[1] for line in LINES[1:]]
# There and back again, so that no row is far from the next.
MIRRORED = ROWS + ROWS[::-1]

# Time grows with the rows, a few µs each; so much is allowed, far more than is needed.
SECONDS_PER_MILLION = 90
COMMANDS = {
    "log": ["log", "log.csv"],
    "log -o": ["log", "log.csv", "-o", "motion.csv"],
    "identify": ["identify", DOCS / "desk_arm.yaml", "log.csv"],
    "watch": ["watch", DOCS / "desk_arm_identified.yaml", "log.csv"],
    "watch --json": ["watch", DOCS / "desk_arm_identified.yaml", "log.csv", "--json"],
}


def written(head, row, count):
    def write(path):
        with open(path, "wb") as file:
            file.write(head + b"\n")
            file.writelines(row(i) for i in range(count))

    return write


def long_log(name, command, write, millions):
    def body(trial):
        trial.write("log.csv", write)
        seconds = 10 + SECONDS_PER_MILLION * millions
        trial.rne(*command, writes=["motion.csv"], seconds=seconds, clock=10 * seconds)

    CASES.add(name, body)


def jumps(i):
    """Positions that no arm reaches in a step: from row 2000 on, each row is a run of its own."""
    return b"%.2f,%d,0,1,1\n" % (i * 0.04, 100 * (i % 2) if i > 2000 else 0)


def gaps(i):
    """A second without a row after every third row."""
    return b"%.2f,0,0,1,1\n" % (i * 0.04 + i // 3)


for millions in (0.5, 2):
    count = int(millions * 1e6)
    motion = written(HEAD, lambda i: b"%.2f,%s\n" % (i * 0.04, MIRRORED[i % len(MIRRORED)]), count)
    for name, command in COMMANDS.items():
        long_log(f"{name} of {millions:g} million rows", command, motion, millions)
    for make in (jumps, gaps):
        write = written(b"t,q1,q2,tau1,tau2", make, count)
        long_log(f"log of {millions:g} million rows with {make.__name__}", COMMANDS["log"], write, millions)


def npy(count):
    """An array whose numbers are all zero takes no place on the disk."""

    def body(trial):
        text = f"{{'descr': '<f4', 'fortran_order': False, 'shape': ({count}, 2), }}".encode()
        text += b" " * (-(11 + len(text)) % 64) + b"\n"

        def write(path):
            with open(path, "wb") as file:
                file.write(b"\x93NUMPY\x01\0" + struct.pack("<H", len(text)) + text)
                file.truncate(10 + len(text) + count * 8)

        trial.write("log.npy", write)
        seconds = 10 + count * 2e-6
        trial.rne("log", "log.npy", "--columns", "q", "--rate", "1000", seconds=seconds, clock=10 * seconds)

    CASES.add(f"npy of {count} rows", body)


npy(1_000_000)
npy(100_000_000)

if __name__ == "__main__":
    harness.main(CASES)
