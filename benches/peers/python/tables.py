"""tables.py WORK [--readme FILE]: merges the rounds of a run into WORK/times.csv and WORK/tables.md; prints the latter.

A median is the median of the rounds' medians, a minimum the least of all rounds. A ratio is one median over another.
With --readme the tables replace what stands between the markers of the section `Measured` of FILE.
"""

import csv
import json
import math
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


class Times:
    """Every competitor's times for every robot."""

    def __init__(self, folder):
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
        return "-" if x is None else f"{nanoseconds(x)} ({nanoseconds(times.get(robot, peer, key + '_min'))})"

    return [bold(peer), *map(cell, times.robots)]


def time_table(times, peers, key):
    rows = [time_cells(times, peer, key) for peer in peers]
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


def ratios(times):
    rows = []
    for measure in REQUIRED:
        for peer in times.ours(batch=measure.startswith("batch")):
            values = [ratio(times, measure, robot, peer) for robot in times.robots]
            rows.append([measure, peer, *("-" if x is None else f"{x:.2f}" for x in values)])
    return markdown(["ratio", "our row", *times.robots], rows)


def required(times):
    rows, reached, total = [], 0, 0
    robots = [robot for robot in REQUIRED_ROBOTS if robot in times.robots]
    for measure, limits in REQUIRED.items():
        rows.append([f"**{measure}**", *(f"≥ {limits[REQUIRED_ROBOTS.index(robot)]:g}" for robot in robots)])
        peers = times.ours(batch=measure.startswith("batch"))
        if not peers:
            rows.append(["(no such row of ours in this run)", *("-" for _ in robots)])
        for peer in peers:
            cells = []
            for robot in robots:
                x = ratio(times, measure, robot, peer)
                if x is None:
                    cells.append("-")
                    continue
                is_reached = x >= limits[REQUIRED_ROBOTS.index(robot)]
                reached, total = reached + is_reached, total + 1
                cells.append(f"{x:.2f} {'reached' if is_reached else 'not reached'}")
            rows.append([peer, *cells])
    if not total:
        return "Nothing is required of what this run measured."
    return markdown(["required", *robots], rows) + f"\n\n{reached} of {total} reached."


def function_times(times):
    peers = []
    for name, (other, own, _) in FUNCTIONS.items():
        if name != "torques":
            peers += [other, *(own + target for target in times.targets())]
    rows = []
    for peer in dict.fromkeys(peers):
        errors = [x for robot in times.robots if (x := times.get(robot, peer, "error")) is not None]
        rows.append([*time_cells(times, peer, "independent"), f"{max(errors):.1e}" if errors else "-"])
    return markdown(["competitor", *times.robots, "deviation"], rows)


def function_ratios(times):
    robots = [robot for robot in REQUIRED_ROBOTS if robot in times.robots]
    rows, reached, total = [], 0, 0
    for name, (other, own, limits) in FUNCTIONS.items():
        head = [f"≥ {limits[robot]:g}" if robot in limits else "" for robot in robots]
        rows.append([f"**{name}**, against {other}", *head])
        for target in times.targets():
            cells = []
            for robot in robots:
                time, rival = (times.get(robot, peer, "independent") for peer in (own + target, other))
                if time is None or rival is None:
                    cells.append("-")
                elif robot not in limits:
                    cells.append(f"{rival / time:.2f}")
                else:
                    is_reached = rival / time >= limits[robot]
                    reached, total = reached + is_reached, total + 1
                    cells.append(f"{rival / time:.2f} {'reached' if is_reached else 'not reached'}")
            rows.append([own + target, *cells])
    return markdown(["ratio of medians", *robots], rows) + f"\n\n{reached} of {total} reached."


def functions(times):
    """The section on the other functions, or nothing where the run had none."""
    if not times.targets():
        return []
    return [
        "### Other functions, beside Pinocchio's, independent calls: median ns (minimum ns)",
        function_times(times),
        "The column `deviation` shows the largest deviation from the results of Pinocchio's Python package, divided by "
        "the largest value of the robot, at 1024 states of each robot. For forward dynamics it is the deviation from "
        "the accelerations of the states. For `rne_derivatives` both matrices are compared, and for "
        "`rne_derivatives_tau_m` also the torques and the mass matrix.",
        "### Other functions: how many times faster than Pinocchio's, and what is required",
        function_ratios(times),
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
            ahead = ", ".join(f"{p} ({nanoseconds(x)})" for x, p in sorted(own) if x > min(others)[0])
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
        for peer in [*rivals, *own] if calls == "single" else own:
            errors = [x for robot in times.robots if (x := times.get(robot, peer, "error")) is not None]
            name, *cells = time_cells(times, peer, "independent")
            row = [function, name, *cells, f"{max(errors):.1e}" if errors else "-"]
            (single if calls == "single" else batch).append(row)
        for peer in own:
            cells = []
            for robot in times.robots:
                time = times.get(robot, peer, "independent")
                best = min((x, rival) for rival in rivals if (x := times.get(robot, rival, "independent")) is not None)
                is_reached = best[0] / time >= required
                reached, total = reached + is_reached, total + 1
                name = f" ({best[1]})" if calls == "single" else ""
                cells.append(f"{best[0] / time:.2f}{name} {'reached' if is_reached else 'not reached'}")
            against = f"{calls}, against {'the best' if calls == 'single' else rivals[0]}"
            ratios.append([function, against, peer, f"≥ {required}", *cells])
    times_head = ["function", "competitor", *times.robots, "deviation"]
    return [
        "### Independent calls, one state per call: median ns (minimum ns)",
        markdown(times_head, single),
        "### Batch of 1024 states: median ns (minimum ns) per state",
        markdown(times_head, batch),
        "### Ratios of medians, and what is required",
        markdown(["function", "calls", "our row", "required", *times.robots], ratios),
        f"{reached} of {total} reached.",
    ]


OTHER_FUNCTIONS = "gravity_torques", "bias_torques", "mass_matrix", "forward_dynamics", "inverse_dynamics_derivatives"


def operations(casadi, ours):
    """Operations of CasADi's functions (a CSV file) and of ours (the JSON of `rne ops`)."""
    counts = {}  # (function, robot): cell

    def count(function, robot, mul, add, angles):
        counts[function, robot] = f"{mul} + {add} = {int(mul) + int(add)}, {angles}"

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
    return markdown(["function", *robots], [[f, *(counts.get((f, robot), "-") for robot in robots)] for f in functions])


def report(work):
    times = Times(work / "rounds")
    own = times.ours(batch=False)
    single = [peer for peer in times.peers if not times.is_batch(peer) and (peer in own or not is_ours(peer))]
    batch = [peer for peer in times.peers if times.is_batch(peer)]
    head = [(work / "conditions.md").read_text().strip(), correctness(times), spread(times)]
    counts = [
        "### Operations: products + sums = both, angles",
        operations(work / "build/generated/operations.csv", work / "build/operations.json"),
    ]
    if set(times.robots) <= set(TREES):
        return "\n\n".join([*head, *trees(times), *counts]) + "\n", times
    parts = [
        *head,
        "### Independent calls, one state per call: median ns (minimum ns)",
        time_table(times, single, "independent"),
        "### Chained calls, each needs the result before: median ns (minimum ns)",
        time_table(times, single, "chained"),
        "### Batch of 1024 states: median ns (minimum ns) per state",
        time_table(times, batch, "independent"),
        "### Ratios of medians: how many times faster our rows are",
        ratios(times),
        "The best CasADi row of a robot is its fastest row `casadi_*` or `pin_casadi*` with one state per call.",
        "### What is required",
        required(times),
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
        write_readme(Path(sys.argv[3]), tables, "trees" if set(times.robots) <= set(TREES) else "measured")
    print(tables)
    if "**Wrong results**" in tables:
        sys.exit(1)


if __name__ == "__main__":
    main()
