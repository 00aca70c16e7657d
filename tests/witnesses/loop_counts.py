"""Operations of closed loops: the form `reduced` beside the spanning tree with a dense projection.

Usage: python3 loop_counts.py RNE ROBOT.yaml ...     `cargo xtask tree-counts --loops` calls it; needs PyYAML.

Both sides come from one robot file, are given positions that close the loops, and return the torques of the independent
joints, or the matrix G of `loop_map`. Products and sums are counted together; divisions, one for each dependent joint
on both sides, and sines and cosines are not. The peer is what a program does that knows trees and linear algebra:

tree         the torques of all joints of the spanning tree, by the customised algorithm of tree_counts.py (SYMORO)
K            the derivative of the equations of all cuts, by the frame Jacobians of both places: z x (p - p_j) of each
             joint that moves one place and not the other, and z (x1 x z2) for axes that stay perpendicular. Frames
             refer to the last link that carries both places
G            the LU decomposition of K_p without a search for pivots, and G = -K_p^-1 K_q. Both matrices are dense: no
             zero of them is used
rates        the velocities and accelerations of the dependent joints, G q' and G q'' + g; g from the velocity products
             of both places, by the same LU decomposition
projection   tau_q + G^T tau_p

There are two peers. That of the table computes K and g with numbers, as a library does: a product with a constant is a
product, also if the constant is 0 or 1. `customised` does so with symbols, as for the tree: products with 0 and 1 cost
nothing. Both leave out the equations that are zero everywhere, such as those across a plane, compute equal
subexpressions once, and compute nothing that no result needs.

Ours takes a wrench at the tip in none of these functions.
"""

import json
import math
import pathlib
import subprocess
import sys

import yaml

from tree_counts import AXES, NOTHING, Sheet, about, applied, composed, exact, read, torques_on

PERPENDICULAR = {"revolute": [(0, 2), (1, 2)], "spherical": [], "universal": [(0, 1)],
                 "weld": [(1, 2), (2, 0), (0, 1)]}
BAR = 0.6


class Numbers(Sheet):
    """Constants are numbers in memory: a product with 0 or 1 is a product. Only signs are for nothing."""

    def times(self, a, b):
        if isinstance(b, float):
            a, b = b, a
        if isinstance(b, float) or not isinstance(a, float) or a == -1:
            return super().times(a, b)
        return self.node(("scaled", a, b[0]), tuple(a * x for x in self.values[b[0]]))[0], b[1]

    def plus(self, a, b):
        if isinstance(a, float) and isinstance(b, float) or 0.0 in (a, b):
            return super().plus(a, b)
        total = tuple(x + y for x, y in zip(self.value(a), self.value(b)))
        return self.node(("sum", *sorted((a, b), key=str)), total)


class Place:
    """A place of a cut in the axes of a link that carries it: where it is, its axes and its motion."""

    def __init__(self, sheet, rows, chain, xyz, axes):
        plus, times, cross = sheet.add, sheet.times, sheet.cross
        frame, origin = about(2, 0.0), NOTHING
        spin, spin_rate, acceleration = [NOTHING] * 3
        self.joints = []
        for index in chain:
            row = rows[index]
            arm = sheet.of(frame, row.p)
            acceleration = plus(acceleration, plus(cross(spin_rate, arm), cross(spin, cross(spin, arm))))
            origin = plus(origin, arm)
            sine, cosine = sheet.turn(sheet.argument(f"q{row.name}"), row.theta)
            turned = [[sheet.dot(line, [r[k] for r in row.turn]) for k in AXES] for line in frame]
            z = [line[2] for line in turned]
            frame = [[sheet.plus(times(x, cosine), times(y, sine)), sheet.minus(times(y, cosine), times(x, sine)), w]
                     for x, y, w in turned]
            rate = [times(x, sheet.argument(f"d{row.name}")) for x in z]
            spin_rate, spin = plus(spin_rate, cross(spin, rate)), plus(spin, rate)
            self.joints.append((index, z, origin))
        arm = sheet.of(frame, xyz)
        self.origin = plus(origin, arm)
        self.axes = [sheet.of(frame, [line[k] for line in axes]) for k in AXES]
        self.spin, self.spin_rate = spin, spin_rate
        self.acceleration = plus(acceleration, plus(cross(spin_rate, arm), cross(spin, cross(spin, arm))))

    def bend(self, sheet, axis):
        """The rate of an axis, and its second derivative without accelerations of joints."""
        rate = sheet.cross(self.spin, axis)
        return rate, sheet.add(sheet.cross(self.spin_rate, axis), sheet.cross(self.spin, rate))


def equations(sheet, rows, cut, ends):
    """For each equation of a cut its derivatives by joint, and its second derivative without accelerations."""
    ways = []
    for link, _, _ in ends:
        way = []
        while link >= 0:
            way.insert(0, link)
            link = rows[link].parent
        ways.append(way)
    shared = sum(1 for pair in zip(*ways) if pair[0] == pair[1])
    places = [Place(sheet, rows, way[shared:], xyz, axes) for way, (_, xyz, axes) in zip(ways, ends)]
    found, sub = [], lambda a, b: [sheet.minus(x, y) for x, y in zip(a, b)]
    columns = [[(index, sheet.cross(z, sub(place.origin, p))) for index, z, p in place.joints] for place in places]
    negative = lambda x: sheet.times(-1.0, x)
    for axis in AXES:
        slopes = {index: negative(column[axis]) for index, column in columns[0]}
        slopes |= {index: column[axis] for index, column in columns[1]}
        found.append((slopes, sheet.minus(places[1].acceleration[axis], places[0].acceleration[axis])))
    for first, second in PERPENDICULAR[cut]:
        a, b = places[0].axes[first], places[1].axes[second]
        normal = sheet.cross(a, b)
        slopes = {index: sheet.dot(z, normal) for index, z, _ in places[0].joints}
        slopes |= {index: negative(sheet.dot(z, normal)) for index, z, _ in places[1].joints}
        (a_rate, a_bend), (b_rate, b_bend) = places[0].bend(sheet, a), places[1].bend(sheet, b)
        both = sheet.plus(sheet.dot(a_bend, b), sheet.dot(a, b_bend))
        found.append((slopes, sheet.plus(both, sheet.times(2.0, sheet.dot(a_rate, b_rate)))))
    return found


def peer(path, kind):
    """Products and sums together, by what they are for; `kind` of sheet for K and for the rates."""
    rows, follows, gravity, base = read(path)
    if follows or base:
        raise SystemExit(f"{path}: followers and floating bases are not counted")
    file = yaml.safe_load(path.read_text())
    names = {joint["name"]: index for index, joint in enumerate(file["joints"])}
    number = lambda x: float(x if isinstance(x, (int, float)) else eval(x, {}, {"pi": math.pi}))
    thetas, sheet = [row.theta for row in rows], Sheet()
    count = lambda sheet, results: sum(sheet.operations(results))
    torques = torques_on(sheet, rows, {}, gravity, None)
    tree, sheets = count(sheet, torques), {Sheet: (sheet, []), kind: (sheet if kind is Sheet else kind(), [])}
    for loop in file["loops"]:
        ends = []
        for end in loop["between"]:
            link = names.get(end.get("on", end.get(True)), -1)  # YAML 1.1 reads the key `on` as true
            xyz, (roll, pitch, yaw) = ([number(x) for x in end.get(key, NOTHING)] for key in ("xyz", "rpy"))
            # the constant angle of a last joint has become part of its link
            inner = about(2, thetas[link] - rows[link].theta if link >= 0 else 0.0)
            axes = composed(inner, composed(composed(about(2, yaw), about(1, pitch)), about(0, roll)))
            ends.append((link, [exact(x) for x in applied(inner, xyz)], [[exact(x) for x in line] for line in axes]))
        for on, found in sheets.values():
            found += equations(on, rows, loop["cut"], ends)
    moves = lambda slopes: any(not isinstance(x, float) for x in slopes.values())
    kept = [index for index, (slopes, _) in enumerate(sheets[Sheet][1]) if moves(slopes)]
    n = sum(len(loop["dependent"]) for loop in file["loops"])
    m = len(rows) - n
    if len(kept) != n:
        raise SystemExit(f"{path}: {len(kept)} equations for {n} dependent joints")
    on, found = sheets[kind]
    slopes = [x for index in kept for x in found[index][0].values()]
    before = torques if kind is Sheet else []  # what the tree has is there already
    first = count(on, before)
    to_slopes, to_rest = count(on, before + slopes), count(on, before + slopes + [found[index][1] for index in kept])
    # step k of LU has n-k quotients, by the reciprocal of the pivot, and (n-k)^2 products and sums
    squares, triangle = (n - 1) * n * (2 * n - 1) // 6, n * (n - 1) // 2
    solving = lambda sides: sides * (4 * triangle + n)
    return {
        "tree": tree, "K": to_slopes - first, "K alone": count(on, slopes), "G": 2 * squares + triangle + solving(m),
        "rates": to_rest - to_slopes + solving(1) + 2 * n * m + n * (m - 1) + n * m, "projection": 2 * n * m,
    }


def ours(rne, path, function):
    command = [rne, "ops", str(path), "--function", function, "--json"]
    entries = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    return next(entry["mul"] + entry["add"] for entry in entries if entry["form"] == "reduced")


TORQUES, MAP = ["tree", "K", "G", "rates", "projection"], ["K alone", "G"]


def main():
    rne, *paths = sys.argv[1:]
    holds = True
    for row, (function, keys) in enumerate([("inverse_dynamics_of_loops", TORQUES), ("loop_map", MAP)]):
        if row:
            print()
        heads = [*(key.removesuffix(" alone") for key in keys), "peer", "rne", "rne / peer", "customised", "rne / customised"]
        print(f"| `{function}` | {' | '.join(heads)} |\n|---{'|---:' * len(heads)}|")
        for path in map(pathlib.Path, paths):
            parts, customised = ([peer(path, kind)[key] for key in keys] for kind in (Numbers, Sheet))
            found, total, least = ours(rne, path, function), sum(parts), sum(customised)
            holds &= found <= BAR * total
            listed = " | ".join(map(str, [*parts, total, found, f"{found / total:.3f}", least, f"{found / least:.3f}"]))
            print(f"| {path.stem} | {listed} |", flush=True)
    sys.exit(0 if holds else 1)


if __name__ == "__main__":
    main()
