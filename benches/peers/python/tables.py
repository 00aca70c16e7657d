"""tables.py WORK [--readme FILE]: merges the rounds of a run into WORK/times.csv and WORK/tables.md; prints the latter.

A median is the median of the rounds' medians, a minimum the least of all rounds. A ratio is one median over another.
With --readme short tables replace what stands between the markers of the section `Measured` of FILE. They have no
minima, no deviations, no chained calls, no ratios, no rows of x86-64-v3 or of sines alone, of generated C the rows that
are the fastest of one function and one generator on some robot, and of other functions the fastest of our targets. The
tables of robots with branches leave out the versions of the other systems and the operations of Pinocchio's functions.
"""

import csv
import json
import math
import re
import sys
from pathlib import Path
from statistics import median

from arm import ROBOTS, TREES, tree
from wrap import FORMS

BATCH_KINDS = {3, 4, 5}  # RP_ID_BATCH, RP_OTHER_BATCH, RP_FD_BATCH of rnepeer.h
TOLERANCE = 1e-10  # of the largest torque

# What the project asks of its own rows. Columns: the six larger robots.
REQUIRED_ROBOTS = ["puma560", "stanford", "panda", "iiwa14", "dense7", "dense6_2p"]
REQUIRED = {
    "independent, against the best CasADi row": [2.4, 2.2, 2.0, 2.0, 1.8, 1.6],
    "chained, against the best CasADi row": [2.1, 1.9, 1.7, 1.8, 1.5, 1.4],
    "independent, against pin_rnea": [11, 11, 7.5, 8.5, 5, 5],
    "batch, against casadi_base_simd": [1.9, 1.7, 1.7, 1.7, 1.6, 1.6],
}


def asked(real, dense):
    return dict.fromkeys(("puma560", "stanford", "iiwa14"), real) | dict.fromkeys(("dense7", "dense6_2p"), dense)


# The other functions, and torques for comparison: Pinocchio's row, ours without its target, and what is asked.
# Pinocchio's derivatives compute torques and mass matrix in passing, ours do not: hence twice.
FUNCTIONS = {
    "torques": ("pin_rnea", "rne", {"puma560": 9}),
    "gravity": ("pin_gravity", "rne_gravity", {}),
    "bias": ("pin_nle", "rne_bias", {}),
    "mass matrix": ("pin_crba", "rne_mass_matrix", asked(4, 2.5)),
    "forward dynamics": ("pin_aba", "rne_forward_dynamics", asked(4, 2.5)),
    "derivatives": ("pin_rnea_deriv", "rne_derivatives", asked(3, 2)),
    "derivatives, torques, mass matrix": ("pin_rnea_deriv", "rne_derivatives_tau_m", asked(3, 2)),
}

# Robots with branches: functions, our rows of single calls and what is asked against the best of the rivals, our rows
# of batches and what is asked against Pinocchio, which has none: single calls in a loop count for both. The ends of
# names are targets of ours and compilers of generated C.
FUNCTIONS_OF_TREES = {
    "torques": (
        ["rne"],
        "pin_rnea pin_casadi casadi_dh casadi_jf casadi_base kdl_rne mj_inverse mj_kin+rne dynibo_rnea".split(),
        2.2,
        ["rne_batch", "rne_machine_batch"],
        25,
    ),
    "mass matrix": (
        ["rne_mass_matrix"],
        ["pin_crba", "pin_casadi_crba", "casadi_mass_matrix", "dynibo_mass_matrix"],
        1.5,
        ["rne_batch_mass_matrix", "rne_machine_mass_matrix"],
        8,
    ),
    "forward dynamics": (
        ["rne_forward_dynamics"],
        ["pin_aba", "pin_casadi_aba", "casadi_forward_dynamics", "dynibo_aba"],
        1.5,
        ["rne_batch_forward_dynamics", "rne_machine_forward_dynamics"],
        8,
    ),
    "derivatives": (
        ["rne_derivatives", "rne_derivatives_tau_m"],
        ["pin_rnea_deriv", "pin_casadi_deriv"],
        1.5,
        ["rne_batch_derivatives", "rne_machine_derivatives"],
        8,
    ),
}
COMPILERS = ["", "_ffast", "_clang_ffast"]
# CasADi's three ways to write the torques.
CASADI_TORQUES = ["casadi_dh", "casadi_jf", "casadi_base"]


class Times:
    """Every competitor's times for every robot."""

    def __init__(self, folder, is_short=False):
        self.is_short = is_short
        samples = {}
        for path in sorted(folder.glob("*.csv")):
            for row in csv.DictReader(path.open()):
                samples.setdefault((row["robot"], row["peer"]), []).append(row)
        self.rounds = max(map(len, samples.values()), default=0)
        self.rows = {
            key: {
                "batch": int(rows[0]["kind"]) in BATCH_KINDS,
                "inverse_dynamics": int(rows[0]["kind"]) in (0, 3),
                "independent": median(float(row["independent_median"]) for row in rows),
                "independent_min": min(float(row["independent_min"]) for row in rows),
                "chained": median(float(row["chained_median"]) for row in rows),
                "chained_min": min(float(row["chained_min"]) for row in rows),
                "error": max(float(row["error"]) for row in rows),
                "rounds": [float(row["independent_median"]) for row in rows],
            }
            for key, rows in samples.items()
        }
        measured = {robot for robot, _ in self.rows}
        self.robots = [robot for robot in ROBOTS if robot in measured]
        self.peers = list(dict.fromkeys(peer for _, peer in self.rows))

    def get(self, robot, peer, key):
        """A number, or None where there is none."""
        x = self.rows.get((robot, peer), {}).get(key, math.nan)
        return None if math.isnan(x) else x

    def is_batch(self, peer):
        return any(row["batch"] for (_, p), row in self.rows.items() if p == peer)

    def is_inverse_dynamics(self, peer):
        return any(row["inverse_dynamics"] for (_, p), row in self.rows.items() if p == peer)

    def ours(self, batch):
        """Our inverse dynamics."""
        return [p for p in self.peers if is_ours(p) and self.is_inverse_dynamics(p) and self.is_batch(p) == batch]

    def targets(self):
        """The ends of the names of our rows that have the other functions."""
        row = "rne_mass_matrix"
        return [peer.removeprefix(row) for peer in self.peers if peer.startswith(row)]

    def is_shown(self, peer):
        """Whether a row is in the tables; the short ones leave out rows that no comparison needs."""
        if not self.is_short:
            return True
        if is_ours(peer):
            return not peer.endswith("_v3")
        if peer.startswith("trig_only"):
            return False
        name = next(peer.removesuffix(end) for end in sorted(COMPILERS, key=len, reverse=True) if peer.endswith(end))
        names = CASADI_TORQUES if name in CASADI_TORQUES else [name]
        rivals = [name + end for name in names for end in COMPILERS if name + end in self.peers]
        for robot in self.robots:
            of_robot = [(x, rival) for rival in rivals if (x := self.get(robot, rival, "independent")) is not None]
            if of_robot and min(of_robot)[1] == peer:
                return True
        return False

    def best_casadi(self, robot, key):
        """The fastest of CasADi's functions of one state, as (time, name), or None."""
        forms = [form[0] for form in FORMS.values() if "casadi" in form[0] and form[1] == "RP_ID"]
        names = {name + end for name in forms for end in COMPILERS}
        peers = [p for p in self.peers if p in names]
        times = [(self.get(robot, p, key), p) for p in peers if self.get(robot, p, key) is not None]
        return min(times, default=None)


def is_ours(peer):
    return peer.split("_")[0] == "rne"


def nanoseconds(x):
    return f"{x:.0f}" if x >= 60 else f"{x:.1f}"


def markdown(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|---|" + "---:|" * (len(head) - 1)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def time_cells(times, peer, key):
    def cell(robot):
        x = times.get(robot, peer, key)
        if x is None:
            return "-"
        least = "" if times.is_short else f" ({nanoseconds(times.get(robot, peer, key + '_min'))})"
        return nanoseconds(x) + least

    return [bold(peer), *map(cell, times.robots)]


def time_table(times, peers, key):
    rows = [time_cells(times, peer, key) for peer in peers if times.is_shown(peer)]
    return markdown(["competitor", *times.robots], [row for row in rows if any(c != "-" for c in row[1:])])


def bold(peer):
    return f"**{peer}**" if is_ours(peer) else peer


def rivals(times, measure, robot):
    """The time to beat, and the key of ours that is compared with it."""
    key = "chained" if measure.startswith("chained") else "independent"
    if measure.endswith("best CasADi row"):
        best = times.best_casadi(robot, key)
        return (best[0] if best else None), key
    return times.get(robot, measure.split()[-1], key), key


def ratio(times, measure, robot, peer):
    rival, key = rivals(times, measure, robot)
    own = times.get(robot, peer, key)
    return None if rival is None or own is None else rival / own


def marked(ratio, required):
    """A ratio, with a mark if it is below what is required."""
    return f"{ratio:.2f}" + (" ✗" if required is not None and ratio < required else "")


def counted(reached, total, is_short=False):
    if is_short:
        return f"{reached} of {total} ratios that the project requires of its rows are reached; `tables.md` lists them."
    return f"{reached} of {total} required ratios are reached; ✗ marks a ratio below the required one."


def ratios(times):
    rows, reached, total = [], 0, 0
    for measure, limits in REQUIRED.items():
        required = dict(zip(REQUIRED_ROBOTS, limits))
        heads = (f"≥ {required[robot]:g}" if robot in required else "" for robot in times.robots)
        rows.append([f"**{measure}**", *heads])
        for peer in times.ours(batch=measure.startswith("batch")):
            cells = []
            for robot in times.robots:
                x, limit = ratio(times, measure, robot, peer), required.get(robot)
                cells.append("-" if x is None else marked(x, limit))
                if x is not None and limit is not None:
                    reached, total = reached + (x >= limit), total + 1
            rows.append([peer, *cells])
    if times.is_short:
        return counted(reached, total, is_short=True)
    return "\n\n".join(
        [
            "### Ratios of medians: how many times faster our rows are, and what is required",
            markdown(["our row; required", *times.robots], rows),
            counted(reached, total),
            "The best CasADi row of a robot is its fastest row `casadi_*` or `pin_casadi*` with one state per call.",
        ]
    )


def deviation(times, peer):
    """The cell of the largest deviation on any robot; the short tables have none."""
    if times.is_short:
        return []
    errors = [x for robot in times.robots if (x := times.get(robot, peer, "error")) is not None]
    return [f"{max(errors):.1e}" if errors else "-"]


def function_times(times):
    """Times of the other functions; in brackets how many times faster than Pinocchio's ours are, or the minimum."""
    rows, reached, total = {}, 0, 0
    for name, (other, own, limits) in FUNCTIONS.items():
        for peer in [other, *(own + target for target in times.targets())]:
            cells = time_cells(times, peer, "independent")
            for at, robot in enumerate(times.robots, 1):
                time, rival = (times.get(robot, of, "independent") for of in (peer, other))
                if peer == other or robot not in REQUIRED_ROBOTS or time is None or rival is None:
                    continue
                limit = limits.get(robot)
                cells[at] = f"{nanoseconds(time)} ({marked(rival / time, limit)})"
                if limit is not None:
                    reached, total = reached + (rival / time >= limit), total + 1
            is_shown = peer == other or peer.endswith("_native") or not times.is_short
            if name != "torques" and is_shown:
                rows[peer] = [*cells, *deviation(times, peer)]
    head = ["competitor", *times.robots, *([] if times.is_short else ["deviation"])]
    return markdown(head, rows.values()) + "\n\n" + counted(reached, total)


DEVIATION = (
    "The column `deviation` shows the largest deviation from the results of Pinocchio's Python package, divided by the "
    "largest value of the robot, at 1024 states of each robot. For forward dynamics it is the deviation from the "
    "accelerations of the states. For `rne_derivatives` both matrices are compared, and for `rne_derivatives_tau_m` "
    "also the torques and the mass matrix."
)


def functions(times):
    """The section on the other functions, or nothing where the run had none."""
    if not times.targets():
        return []
    return [
        "### Other functions, independent calls: median ns (how many times faster than Pinocchio's)",
        function_times(times),
        "" if times.is_short else DEVIATION,
    ]


def losses(times):
    """Every inverse dynamics of others that is faster than our slowest or even our fastest row of its kind."""
    rows = []
    for what, key, batch in (
        ("independent", "independent", False),
        ("chained", "chained", False),
        ("batch", "independent", True),
    ):
        for robot in times.robots:
            own = [(x, p) for p in times.ours(batch) if (x := times.get(robot, p, key)) is not None]
            others = [
                (x, p)
                for p in times.peers
                if not is_ours(p) and times.is_batch(p) == batch and times.is_inverse_dynamics(p)
                if (x := times.get(robot, p, key)) is not None
            ]
            if not own or not others or min(others) > max(own):
                continue
            slower = [(x, p) for x, p in sorted(own) if x > min(others)[0] and times.is_shown(p)]
            ahead = ", ".join(f"{p} ({nanoseconds(x)})" for x, p in slower)
            before_all = sum(other < min(own) for other in others)
            rows.append(
                [f"{what}, {robot}", ahead, f"{min(others)[1]} ({nanoseconds(min(others)[0])})", str(before_all)]
            )
    if not rows:
        return "In this run, no row of another system is faster than our slowest row with the same kind of call."
    fastest, number = "fastest row of another system (ns)", "number of rows faster than all our rows"
    return markdown(["calls, robot", "our slower rows (ns)", fastest, number], rows)


def correctness(times):
    checked = {key: row["error"] for key, row in times.rows.items() if not math.isnan(row["error"])}
    wrong = [f"{peer} on {robot}: {error:.1e}" for (robot, peer), error in checked.items() if error > TOLERANCE]
    if wrong:
        return "**Wrong results**, largest deviation over largest reference value: " + "; ".join(wrong)
    torques = {key: error for key, error in checked.items() if times.is_inverse_dynamics(key[1])}
    others = max((e for (_, p), e in torques.items() if not is_ours(p)), default=math.nan)
    own = max((e for (_, p), e in torques.items() if is_ours(p)), default=math.nan)
    return (
        "The torques of every row agree with the reference torques at 1024 states of each robot. The largest "
        f"deviation, divided by the largest torque, is {own:.1e} for our rows and {others:.1e} for the other rows. "
        f"The limit is {TOLERANCE:g}."
    )


def spread(times):
    """How much the rounds differ."""
    if times.rounds < 2:
        return "There was one round, so it is unknown how much rounds differ."
    ratios = sorted((max(row["rounds"]) / min(row["rounds"]), *key) for key, row in times.rows.items())
    worst, robot, peer = ratios[-1]
    return (
        f"The {times.rounds} rounds of a row differ. For the median row of independent calls and batches, the slowest "
        f"round takes {100 * (ratios[len(ratios) // 2][0] - 1):.0f} % more time than the fastest round. For the worst "
        f"row ({peer} on {robot}) it takes {100 * (worst - 1):.0f} % more time."
    )


def rows_of_trees(times):
    """(function, calls, what is required, our rows, their rivals) in the order of the tables."""
    for function, (own, rivals, single, batches, batch) in FUNCTIONS_OF_TREES.items():
        ends = times.targets()
        names = [name + end for name in own for end in ends]
        against = [name + end for name in rivals for end in COMPILERS]
        yield function, "single", single, names, [name for name in against if name in times.peers]
        yield function, "batch", batch, [name + end for name in batches for end in ends], rivals[:1]


def trees(times):
    """Times of every row, then ratios and what is asked."""
    single, batch, ratios, reached, total = [], [], [], 0, 0
    for function, calls, required, own, rivals in rows_of_trees(times):
        own = [name for name in own if name in times.peers]
        for peer in filter(times.is_shown, [*rivals, *own] if calls == "single" else own):
            row = [function, *time_cells(times, peer, "independent"), *deviation(times, peer)]
            (single if calls == "single" else batch).append(row)
        for peer in own:
            cells = []
            for robot in times.robots:
                time = times.get(robot, peer, "independent")
                best = min((x, rival) for rival in rivals if (x := times.get(robot, rival, "independent")) is not None)
                reached, total = reached + (best[0] / time >= required), total + 1
                cells.append(marked(best[0] / time, required) + (f" ({best[1]})" if calls == "single" else ""))
            against = f"{calls}, against {'the best' if calls == 'single' else rivals[0]}"
            ratios.append([function, against, peer, f"≥ {required}", *cells])
    times_head = ["function", "competitor", *times.robots, *([] if times.is_short else ["deviation"])]
    return [
        f"### Independent calls, one state per call: {unit(times)}",
        markdown(times_head, single),
        f"### Batch of 1024 states: {unit(times)} per state",
        markdown(times_head, batch),
        *([] if times.is_short else ratios_of_trees(times, ratios)),
        counted(reached, total, times.is_short),
    ]


def ratios_of_trees(times, ratios):
    head = ["function", "calls", "our row", "required", *times.robots]
    return ["### Ratios of medians, and what is required", markdown(head, ratios)]


OTHER_FUNCTIONS = "gravity_torques", "bias_torques", "mass_matrix", "forward_dynamics", "inverse_dynamics_derivatives"


def unit(times):
    return "median ns" if times.is_short else "median ns (minimum ns)"


def operations(casadi, ours, is_short):
    """Operations of CasADi's functions (a CSV file) and of ours (the JSON of `rne ops`)."""
    counts = {}  # (function, robot): cell

    def count(function, robot, mul, add, angles):
        parts = "" if is_short else f"{mul} + {add} = "
        counts[function, robot] = f"{parts}{int(mul) + int(add)}, {angles}"

    for row in csv.DictReader(casadi.open()):
        count(FORMS[row["form"]][0], row["robot"], row["mul"], row["add"], row["sin"])
    names = {tree(name)["title"]: name for name in TREES}
    rows = [row | {"robot": names.get(row["robot"], row["robot"])} for row in json.loads(ours.read_text())]
    for row in rows:
        if row["function"] == "inverse_dynamics":
            count(f"**rne, {row['form']}**", row["robot"], row["mul"], row["add"], row["sincos"])
    for row in rows:
        if row["function"] in OTHER_FUNCTIONS and row["form"] == "reduced":
            count(f"**rne, {row['function']}**", row["robot"], row["mul"], row["add"], row["sincos"])
    robots = [robot for robot in ROBOTS if any(robot == r for _, r in counts)]
    functions = list(dict.fromkeys(function for function, _ in counts))
    if is_short and set(robots) <= set(TREES):
        functions = [function for function in functions if not function.startswith("pin_")]
    return markdown(["function", *robots], [[f, *(counts.get((f, robot), "-") for robot in robots)] for f in functions])


def report(work, is_short=False):
    times = Times(work / "rounds", is_short)
    own = times.ours(batch=False)
    single = [peer for peer in times.peers if not times.is_batch(peer) and (peer in own or not is_ours(peer))]
    batch = [peer for peer in times.peers if times.is_batch(peer)]
    conditions = (work / "conditions.md").read_text().strip()
    if is_short and set(times.robots) <= set(TREES):
        versions = ("| processor |", "| load |", "| compilers |", "| dynibo |")
        lines = conditions.splitlines()
        conditions = "\n".join(line for line in lines if not re.match(r"\| \w", line) or line.startswith(versions))
    head = [conditions, correctness(times), spread(times)]
    counts = [
        "### Operations: products and sums, angles" if is_short else "### Operations: products + sums = both, angles",
        operations(work / "build/generated/operations.csv", work / "build/operations.json", is_short),
    ]
    if set(times.robots) <= set(TREES):
        return "\n\n".join([*head, *trees(times), *counts]) + "\n", times
    elsewhere = {other for other, own, _ in FUNCTIONS.values() if own != "rne" and times.targets()}
    chained = [
        "### Chained calls, each needs the result before: median ns (minimum ns)",
        time_table(times, single, "chained"),
    ]
    parts = [
        *head,
        f"### Independent calls, one state per call: {unit(times)}",
        time_table(times, [peer for peer in single if not is_short or peer not in elsewhere], "independent"),
        *([] if is_short else chained),
        f"### Batch of 1024 states: {unit(times)} per state",
        time_table(times, batch, "independent"),
        ratios(times),
        "### Where our code loses",
        losses(times),
        *functions(times),
        *counts,
    ]
    return "\n\n".join(part for part in parts if part) + "\n", times


def write_csv(times, path):
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["robot", "peer", "batch", "independent", "independent_min", "chained", "chained_min", "error"])
        for (robot, peer), row in times.rows.items():
            numbers = (row[key] for key in ("independent", "independent_min", "chained", "chained_min"))
            writer.writerow([robot, peer, int(row["batch"]), *(f"{x:.3f}" for x in numbers), f"{row['error']:.1e}"])


END = "<!-- end -->"


def write_readme(path, tables, what):
    marker = f"<!-- begin: {what}, written by: benches/peers/run --write-readme -->"
    head, begin, rest = path.read_text().partition(marker)
    _, end, tail = rest.partition(END)
    if not begin or not end:
        sys.exit(f"{path.name} has no section between {marker} and {END}")
    path.write_text(f"{head}{marker}\n{tables}{END}{tail}")


def main():
    work = Path(sys.argv[1])
    if sys.argv[2:3] == ["--floating"]:
        return write_readme(Path(sys.argv[3]), (work / "floating.md").read_text(), "floating")
    tables, times = report(work)
    (work / "tables.md").write_text(tables)
    write_csv(times, work / "times.csv")
    if sys.argv[2:3] == ["--readme"]:
        short, _ = report(work, is_short=True)
        write_readme(Path(sys.argv[3]), short, "trees" if set(times.robots) <= set(TREES) else "measured")
    print(tables)
    if "**Wrong results**" in tables:
        sys.exit(1)


if __name__ == "__main__":
    main()
