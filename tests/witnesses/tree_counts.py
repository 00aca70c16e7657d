"""Operations of inverse dynamics of robots with branches: the form `reduced` beside Khalil's Newton-Euler algorithm.

Usage: python3 tree_counts.py RNE ROBOT.yaml ...     `cargo xtask tree-counts` calls it; needs PyYAML.

Both columns come from one robot file. Ours is what `rne ops` counts in the emitted program, with the plan file beside
the robot file. The peer is the customised Newton-Euler algorithm of Khalil and Kleinfinger (1987) with base
parameters, on the modified rows of the file, as SYMORO writes it: each formula of the recursion is an operation of
its own, a product with 0, 1 or -1 and a sum with 0 cost nothing, equal subexpressions are computed once, and what no
torque needs is left out. The rules that only help the peer: the base is turned into the frame of each joint on it,
and the constant angle of a last joint is part of its link. Followers cost their linear form. Rotors in `motors` are
no part of the peer here.

Where nothing holds the base, ω, ω̇ and a - g of the base are arguments, and the wrench on the base is a result, too. The
base has its ten parameters. Ours takes a wrench at one tip, which the peer does not have.
"""

import json
import math
import pathlib
import random
import subprocess
import sys

import yaml

# Bars of the issue, and the peer where this script has none, with its source.
BARS = {"hyq": 634, "anymal_c": 694, "go2": 672, "solo12": 554, "atlas": 2158, "g1": 2600, "sr400": 517}
BARS |= {"mini_cheetah": 563, "hyq_floating": 1304, "anymal_c_floating": 1328, "go2_floating": 1295}
BARS |= {"solo12_floating": 1024, "atlas_floating": 2746, "g1_floating": 3082, "mini_cheetah_floating": 1219}
TOLD = {"mini_cheetah": "704 (rotors as 12 more bodies: specification)"}
TOLD["mini_cheetah_floating"] = "1469 (rotors as 12 more bodies: specification)"

AXES = range(3)
NOTHING = [0.0, 0.0, 0.0]


class Sheet:
    """Expressions are numbers, or (node, sign). A node has its values at two random states: what is 0 at both is 0."""

    def __init__(self):
        self.nodes, self.values, self.places = [], [], {}

    def node(self, key, values):
        if key not in self.places:
            self.places[key] = len(self.nodes)
            self.nodes.append(key)
            self.values.append(values)
        return (self.places[key], 1)

    def value(self, x):
        return (x, x) if isinstance(x, float) else tuple(x[1] * value for value in self.values[x[0]])

    def argument(self, name):
        dice = random.Random(name)
        return self.node(("argument", name), (dice.uniform(-1.3, 1.3), dice.uniform(-1.3, 1.3)))

    def times(self, a, b):
        if isinstance(b, float):
            a, b = b, a
        if isinstance(b, float):
            return a * b
        if isinstance(a, float):
            if abs(a) < 1e-14:
                return 0.0
            sign = b[1] if a > 0 else -b[1]
            if abs(abs(a) - 1) < 1e-13:
                return (b[0], sign)
            key = self.nodes[b[0]]
            if key[0] == "scaled":
                return self.times(a * key[1] * b[1], (key[2], 1))
            node, _ = self.node(("scaled", abs(a), b[0]), tuple(abs(a) * x for x in self.values[b[0]]))
            return (node, sign)
        i, j = sorted((a[0], b[0]))
        node, _ = self.node(("product", i, j), tuple(x * y for x, y in zip(self.values[i], self.values[j])))
        return (node, a[1] * b[1])

    def plus(self, a, b):
        if isinstance(a, float):
            a, b = b, a
        if isinstance(a, float):
            return a + b
        total = tuple(x + y for x, y in zip(self.value(a), self.value(b)))
        if isinstance(b, float):
            return a if abs(b) < 1e-13 else self.node(("sum", a, b), total)
        if max(map(abs, total)) < 1e-11:
            return 0.0
        if a[0] == b[0]:
            return self.times(2.0, a)
        a, b = sorted((a, b))
        node, _ = self.node(("sum", (a[0], 1), (b[0], a[1] * b[1])), tuple(a[1] * x for x in total))
        return (node, a[1])

    def minus(self, a, b):
        return self.plus(a, -b if isinstance(b, float) else (b[0], -b[1]))

    def turn(self, angle, theta):
        """Sine and cosine of an angle and a constant; a right angle costs nothing."""
        quarters = round(theta / (math.pi / 2))
        if abs(theta - quarters * math.pi / 2) > 1e-9:
            angle, quarters = self.plus(angle, theta), 0
        node, sign = angle
        sine = self.node(("sine", node), tuple(map(math.sin, self.values[node])))
        cosine = self.node(("cosine", node), tuple(map(math.cos, self.values[node])))
        sine = (sine[0], sign)
        for _ in range(quarters % 4):
            sine, cosine = cosine, (sine[0], -sine[1])
        return sine, cosine

    def operations(self, results):
        left, seen, products, sums = [x[0] for x in results if not isinstance(x, float)], set(), 0, 0
        while left:
            node = left.pop()
            if node in seen:
                continue
            seen.add(node)
            kind, *of = self.nodes[node]
            if kind == "product":
                products += 1
                left += of
            elif kind == "scaled":
                products += 1
                left.append(of[1])
            elif kind == "sum":
                sums += 1
                left += [x[0] for x in of if not isinstance(x, float)]
            elif kind != "argument":
                left.append(of[0])
        return products, sums

    # vectors
    def dot(self, a, b):
        total = 0.0
        for x, y in zip(a, b):
            total = self.plus(total, self.times(x, y))
        return total

    def of(self, matrix, v):
        return [self.dot(row, v) for row in matrix]

    def add(self, a, b):
        return [self.plus(x, y) for x, y in zip(a, b)]

    def cross(self, a, b):
        pairs = ((1, 2), (2, 0), (0, 1))
        return [self.minus(self.times(a[i], b[j]), self.times(a[j], b[i])) for i, j in pairs]


def transposed(a):
    return [list(row) for row in zip(*a)]


def composed(a, b):
    return [[sum(a[i][k] * b[k][j] for k in AXES) for j in AXES] for i in AXES]


def applied(a, v):
    return [sum(a[i][k] * v[k] for k in AXES) for i in AXES]


def exact(x):
    return float(round(x)) if abs(x - round(x)) < 1e-12 else x


def about(axis, angle):
    c, s = exact(math.cos(angle)), exact(math.sin(angle))
    i, j = (axis + 1) % 3, (axis + 2) % 3
    turn = [[float(k == m) for m in AXES] for k in AXES]
    turn[i][i], turn[i][j], turn[j][i], turn[j][j] = c, -s, s, c
    return turn


class Matter:
    """Mass, first moment and inertia about the origin of a frame."""

    def __init__(self, mass=0.0, h=NOTHING, inertia=(NOTHING,) * 3):
        self.mass, self.h, self.inertia = mass, list(h), [list(row) for row in inertia]

    def turned(self, turn):
        inertia = composed(composed(turn, self.inertia), transposed(turn))
        return Matter(self.mass, applied(turn, self.h), inertia)

    def add_rod(self, rod, p, u):
        """Matter on the line p + x u: its mass, first and second moment along u."""
        mass, first, second = rod
        self.mass += mass
        # ∫ r rᵀ dm of it
        mixed = [[p[i] * u[j] + u[i] * p[j] for j in AXES] for i in AXES]
        s = [[mass * p[i] * p[j] + first * mixed[i][j] + second * u[i] * u[j] for j in AXES] for i in AXES]
        trace = sum(s[i][i] for i in AXES)
        for i in AXES:
            self.h[i] += mass * p[i] + first * u[i]
            for j in AXES:
                self.inertia[i][j] += (trace if i == j else 0.0) - s[i][j]

    def clean(self):
        def dust(x):
            return 0.0 if abs(x) < 1e-12 else x

        self.mass, self.h = dust(self.mass), list(map(dust, self.h))
        self.inertia = [list(map(dust, row)) for row in self.inertia]


class Row:
    """A revolute joint: its parent, the turn before the joint, its place, the constant angle, and the matter."""

    def __init__(self, joint, names, number):
        if joint["type"] != "revolute":
            raise SystemExit(f"{joint['name']}: only revolute joints are counted")
        self.name = joint["name"]
        before = len(names) - 1
        parent = joint.get("parent")
        self.parent = before if parent is None else names.get(parent, -1)
        dh = {key: number(value) for key, value in joint["dh"].items()}
        at = joint.get("at", {})
        roll, pitch, yaw = (number(x) for x in at.get("rpy", NOTHING))
        place = composed(composed(about(2, yaw), about(1, pitch)), about(0, roll))
        turn = composed(place, about(2, dh.get("gamma", 0.0)))
        self.turn = [[exact(x) for x in row] for row in composed(turn, about(0, dh["alpha"]))]
        self.theta = dh["theta"]
        u = [row[2] for row in self.turn]
        along = applied(turn, [dh["a"], 0.0, dh.get("b", 0.0)])
        xyz = [number(x) for x in at.get("xyz", NOTHING)]
        self.p = [exact(xyz[i] + along[i] + dh["d"] * u[i]) for i in AXES]
        self.matter = matter_of(joint.get("link", {}), number)


def matter_of(link, number):
    """The matter of a link of the file."""
    mass = number(link.get("mass", 0.0))
    c = [number(x) for x in link.get("com", NOTHING)]
    of = {key: number(value) for key, value in link.get("inertia", {}).items()}
    tensor = [[of.get("".join(sorted("xyz"[i] + "xyz"[j])), 0.0) for j in AXES] for i in AXES]
    square = 0.0 if link.get("inertia_about") == "origin" else mass * sum(x * x for x in c)
    moved = 0.0 if link.get("inertia_about") == "origin" else mass
    inertia = [[tensor[i][j] + (square if i == j else 0.0) - moved * c[i] * c[j] for j in AXES] for i in AXES]
    return Matter(mass, [mass * x for x in c], inertia)


def read(path):
    """Rows, the joints that each follower follows, gravity, and the matter of a floating base, or None."""
    file = yaml.safe_load(path.read_text())
    if file["convention"] != "modified":
        raise SystemExit(f"{path}: only modified rows are counted")
    known = {"pi": math.pi, "deg": math.radians, "sqrt": math.sqrt, "sin": math.sin, "cos": math.cos}

    def number(value):
        return float(value if isinstance(value, (int, float)) else eval(value.replace("^", "**"), {}, known))

    for name, value in (file.get("parameters") or {}).items():
        known[name] = number(value)
    rows, names = [], {}
    for joint in file["joints"]:
        rows.append(Row(joint, names, number))
        names[joint["name"]] = len(rows) - 1
    follows = {}
    for coupling in file.get("couplings", []):
        follower = names[coupling["joint"]]
        follows[follower] = [(names[name], number(ratio)) for name, ratio in coupling["follows"].items()]
        rows[follower].theta += number(coupling.get("offset", 0.0))
    for loop in file.get("loops", []):
        if loop.get("kind") != "parallelogram":
            continue  # of a closed loop, the tree that is left is counted
        follows |= parallelogram(rows, names, loop, number)
    floating = file.get("floating_base")
    base = floating and matter_of(floating["link"], number)
    return rows, follows, [number(x) for x in file["gravity"]], base


def parallelogram(rows, names, loop, number):
    """Two ways of two joints: the last joint of each way turns against its first and with the first of the other."""
    # YAML 1.1 reads the key `on` as true
    ends = [(names[end.get("on", end.get(True))], [number(x) for x in end["xyz"]]) for end in loop["between"]]
    follows = {}
    for (last, cut), (other, _) in (ends, ends[::-1]):
        first, opposite = rows[last].parent, rows[other].parent
        direction = lambda p: math.atan2(p[1], p[0])
        offset = direction(rows[other].p) + rows[opposite].theta - rows[first].theta - direction(cut)
        follows[last] = ([(opposite, 1.0), (first, -1.0)], exact(offset / (math.pi / 2)) * math.pi / 2)
    for last, (_, offset) in follows.items():
        rows[last].theta = offset
    return {last: ratios for last, (ratios, _) in follows.items()}


def peer(rows, follows, gravity, base):
    """Products and sums of Khalil's algorithm with base parameters."""
    sheet = Sheet()
    return sheet.operations(torques_on(sheet, rows, follows, gravity, base))


def torques_on(sheet, rows, follows, gravity, base):
    """The torques, and behind them the wrench on a floating base. The parameters of the rows become base parameters."""
    ends = set(range(len(rows))) - {row.parent for row in rows}
    for index, row in enumerate(rows):
        if index in ends and index not in follows:
            row.matter, row.theta = row.matter.turned(about(2, row.theta)), 0.0
    for row in reversed(rows):
        row.matter.clean()
        # mass, m z and J_yy of the link
        rod = (row.matter.mass, row.matter.h[2], row.matter.inertia[1][1])
        row.matter.add_rod([-x for x in rod], NOTHING, [0.0, 0.0, 1.0])
        row.matter.clean()
        carrier = rows[row.parent].matter if row.parent >= 0 else base
        if carrier is not None:
            carrier.add_rod(rod, row.p, [line[2] for line in row.turn])

    def moving(quantity, index):
        total = 0.0
        for joint, ratio in follows.get(index, [(index, 1.0)]):
            total = sheet.plus(total, sheet.times(ratio, sheet.argument(quantity + rows[joint].name)))
        return total

    def gradient(w, wd):
        square = [[sheet.times(w[i], w[j]) for j in AXES] for i in AXES]
        minus = [sheet.times(-1.0, square[i][i]) for i in AXES]
        return [
            [sheet.plus(minus[1], minus[2]), sheet.minus(square[0][1], wd[2]), sheet.plus(square[0][2], wd[1])],
            [sheet.plus(square[0][1], wd[2]), sheet.plus(minus[0], minus[2]), sheet.minus(square[1][2], wd[0])],
            [sheet.minus(square[0][2], wd[1]), sheet.plus(square[1][2], wd[0]), sheet.plus(minus[0], minus[1])],
        ]

    told = [[sheet.argument(f"{quantity}{axis}") for axis in AXES] for quantity in ("w0", "wd0", "a0")]
    of_base = (*told, gradient(*told[:2])) if base else None
    moved = []
    for index, row in enumerate(rows):
        sine, cosine = sheet.turn(moving("q", index), row.theta)
        turn, place = row.turn, row.p
        if row.parent < 0 and base:
            w, wd, a, u = of_base
        elif row.parent < 0:
            # the base does not move, and is turned into the frame of the joint
            w, wd, a, u = NOTHING, NOTHING, applied(transposed(turn), [-g for g in gravity]), [NOTHING] * 3
            turn, place = about(2, 0.0), NOTHING
        else:
            w, wd, a, u, _ = moved[row.parent]
        r = [
            [
                sheet.plus(sheet.times(line[0], cosine), sheet.times(line[1], sine)),
                sheet.minus(sheet.times(line[1], cosine), sheet.times(line[0], sine)),
                line[2],
            ]
            for line in turn
        ]
        back, rate = transposed(r), moving("d", index)
        before, accelerated = sheet.of(back, w), sheet.of(back, wd)
        omega = [before[0], before[1], sheet.plus(before[2], rate)]
        omega_dot = [
            sheet.plus(accelerated[0], sheet.times(before[1], rate)),
            sheet.minus(accelerated[1], sheet.times(before[0], rate)),
            sheet.plus(accelerated[2], moving("e", index)),
        ]
        acceleration = sheet.of(back, sheet.add(a, sheet.of(u, place)))
        moved.append((omega, omega_dot, acceleration, gradient(omega, omega_dot), r))
    # the last one is that of the base
    carried = [(NOTHING, NOTHING) for _ in range(len(rows) + 1)]
    torques = [0.0] * len(rows)

    def wrench(matter, motion, of_others):
        w, wd, a, u = motion
        force = sheet.add([sheet.times(matter.mass, x) for x in a], sheet.of(u, matter.h))
        moment = sheet.add(sheet.of(matter.inertia, wd), sheet.cross(w, sheet.of(matter.inertia, w)))
        return sheet.add(force, of_others[0]), sheet.add(sheet.add(moment, of_others[1]), sheet.cross(matter.h, a))

    for index in reversed(range(len(rows))):
        row, (*motion, r) = rows[index], moved[index]
        force, moment = wrench(row.matter, motion, carried[index])
        torques[index] = moment[2]
        if row.parent >= 0 or base:
            of, about_parent = carried[row.parent], sheet.of(r, force)
            lever = sheet.add(sheet.of(r, moment), sheet.cross(row.p, about_parent))
            carried[row.parent] = (sheet.add(of[0], about_parent), sheet.add(of[1], lever))
    for follower, ratios in follows.items():
        for joint, ratio in ratios:
            torques[joint] = sheet.plus(torques[joint], sheet.times(ratio, torques[follower]))
    results = [torque for index, torque in enumerate(torques) if index not in follows]
    if base:
        base.clean()
        results += [x for part in wrench(base, of_base, carried[-1]) for x in part]
    return results


def ours(rne, path, floats):
    function = "inverse_dynamics_of_floating_base" if floats else "inverse_dynamics"
    command = [rne, "ops", str(path), "--function", function, "--json"]
    entries = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    return next((entry["mul"], entry["add"]) for entry in entries if entry["form"] == "reduced")


def main():
    rne, *paths = sys.argv[1:]
    print("| robot | joints | Khalil, base parameters | rne, reduced | ratio | bar |\n|---|---:|---:|---:|---:|---:|")
    holds = True
    for path in map(pathlib.Path, paths):
        rows, follows, gravity, base = read(path)
        joints = len(rows) - len(follows)
        bar = BARS.get(path.stem)
        products, sums = ours(rne, path, base is not None)
        total = products + sums
        if path.stem in TOLD:
            told, ratio = TOLD[path.stem], total / float(TOLD[path.stem].split()[0])
        else:
            of_peer = peer(rows, follows, gravity, base)
            told, ratio = f"{of_peer[0]} + {of_peer[1]} = {sum(of_peer)}", total / sum(of_peer)
        holds &= bar is None or total <= bar
        of_rne = f"{products} + {sums} = {total}"
        print(f"| {path.stem} | {joints} | {told} | {of_rne} | {ratio:.3f} | {bar or ''} |", flush=True)
    sys.exit(0 if holds else 1)


if __name__ == "__main__":
    main()
