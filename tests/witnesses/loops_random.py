"""Random robots with one to three closed loops, planar and spatial, with all four cut joints; used by loops.py.

A tree is drawn with random positions of its joints, and the second place of each cut is put where the loop closes at
those positions. Numbers are rounded, so the loops close near there.
"""

import numpy as np

RANKS = {"revolute": 5, "spherical": 3, "universal": 4, "weld": 6}
PLANAR_RANKS = {"revolute": 2, "spherical": 2, "universal": 2, "weld": 3}


def turn(axis, angle):
    c, s = np.cos(angle), np.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    out = np.eye(4)
    out[i, i], out[i, j], out[j, i], out[j, j] = c, -s, s, c
    return out


def shift(x, y, z):
    out = np.eye(4)
    out[:3, 3] = x, y, z
    return out


def pose_of(xyz, rpy):
    return shift(*xyz) @ turn(2, rpy[2]) @ turn(1, rpy[1]) @ turn(0, rpy[0])


def angles_of(pose):
    r = pose[:3, :3]
    return [np.arctan2(r[2, 1], r[2, 2]), np.arcsin(np.clip(-r[2, 0], -1, 1)), np.arctan2(r[1, 0], r[0, 0])]


def listed(values):
    return "[" + ", ".join(f"{value:.4f}".rstrip("0").rstrip(".") if not isinstance(value, str) else value
                           for value in np.where(np.abs(values) < 5e-5, 0.0, values)) + "]"


def drawn_link(random):
    """Mass, centre of mass and inertia of a body, as text."""
    draw = lambda low, high: round(float(random.uniform(low, high)), 3)
    mass, com = draw(0.5, 4), [draw(-0.2, 0.2) for _ in range(3)]
    xx, yy, part = draw(0.01, 0.1), draw(0.01, 0.1), draw(0.3, 0.9)
    zz = round(abs(xx - yy) + part * (xx + yy - abs(xx - yy)), 4)
    small = round(0.1 * min(xx, yy, zz, xx + yy - zz, abs(zz - abs(xx - yy))), 5)
    return f"{{mass: {mass}, com: {com}, inertia: {{xx: {xx}, yy: {yy}, zz: {zz}, xy: {small}, yz: {-small}}}}}"


class Draft:
    """A robot that is being drawn: rows as text, and the pose of each link at the positions q."""

    def __init__(self, random, planar, standard, floats=False):
        self.random, self.planar, self.standard = random, planar, standard
        self.base = drawn_link(random) if floats else None
        self.rows, self.q, self.poses, self.parents, self.flat = [], [], {-1: np.eye(4)}, [], {-1: True}
        self.loops, self.moved, self.ranks = [], [], []

    def row(self, parent, may_slide):
        """A joint on the link `parent`. In a planar robot z of a link is across the plane, or it slides along it."""
        random, index = self.random, len(self.q)
        slide = may_slide and self.flat[parent] and random.random() < 0.2
        draw = lambda low, high: round(float(random.uniform(low, high)), 3)
        a, theta, d, alpha, branch = draw(0.2, 0.5), draw(-3, 3), 0.0, "0", parent != index - 1
        gamma, b = draw(-3, 3) if branch and self.flat[parent] else 0.0, 0.0
        if self.planar:
            alpha = {(True, False): "0", (True, True): "pi/2", (False, False): "-pi/2"}[self.flat[parent], slide]
            if slide:
                theta, d = 0.0, draw(-0.2, 0.2)
            self.flat[index] = not slide
        else:
            alpha = str(random.choice(["pi/2", "-pi/2", draw(-3, 3)]))
            d, b = draw(-0.2, 0.2), draw(-0.2, 0.2) if branch else 0.0
            self.flat[index] = True
        q = float(random.uniform(-0.2, 0.2) if slide else random.uniform(-1, 1))
        angle = {"0": 0.0, "pi/2": np.pi / 2, "-pi/2": -np.pi / 2}.get(alpha)
        along = shift(a, 0, 0) @ turn(0, float(alpha) if angle is None else angle)
        own = turn(2, theta + (0 if slide else q)) @ shift(0, 0, d + (q if slide else 0))
        dh, at = f"alpha: {alpha}, a: {a}, theta: {theta}, d: {d}", ""
        if self.standard:
            start = np.eye(4)
            if branch:
                xyz, rpy = ([draw(-0.3, 0.3) for _ in range(3)] for _ in range(2))
                start, at = pose_of(xyz, rpy), f" at: {{xyz: {xyz}, rpy: {rpy}}},"
            pose = start @ own @ along
        else:
            pose = turn(2, gamma) @ shift(0, 0, b) @ along @ own
            dh = f"gamma: {gamma}, b: {b}, {dh}" if branch else dh
        link = drawn_link(random)
        above = f" parent: {'base' if parent < 0 else f'j{parent + 1}'}," if branch else ""
        kind = "prismatic" if slide else "revolute"
        self.rows.append(f"- {{name: j{index + 1},{above} type: {kind},{at} dh: {{{dh}}},\n"
                         f"   link: {link}}}")
        self.poses[index] = self.poses[parent] @ pose
        self.q.append(q)
        self.parents.append(parent)
        return index

    def path(self, link):
        out = set()
        while link >= 0:
            out.add(link)
            link = self.parents[link]
        return out

    def loop(self, cut):
        """A new branch and the two places of its cut; the rank of its equations, or None if too few joints move."""
        random = self.random
        start = int(random.integers(-1, len(self.q)))
        link = start
        rank = (PLANAR_RANKS if self.planar else RANKS)[cut]
        length = max(1, rank - int(random.integers(0, 3)) + (0 if self.q else 2))
        for step in range(length):
            link = self.row(link, step not in (length - 1,) and step > 0)
        ends = [other for other in range(-1, len(self.q)) if self.flat[other]
                and len(self.path(link) ^ self.path(other)) > rank]
        if not ends or not self.flat[link]:
            return None
        other = int(random.choice(ends))
        draw = lambda size, last: [round(float(x), 3) for x in random.uniform(-size, size, last)]
        if self.planar:
            xyz, rpy = [*draw(0.3, 2), 0.0], [0.0, 0.0, draw(3, 1)[0]]
        else:
            xyz, rpy = draw(0.2, 3), draw(1.2, 3)
        first = self.poses[link] @ pose_of(xyz, rpy)
        one, two, three = random.uniform(-1, 1, 3)
        freely = {"revolute": turn(2, one), "spherical": turn(2, one) @ turn(1, two) @ turn(0, three),
                  "universal": turn(0, one) @ turn(1, two), "weld": np.eye(4)}[cut]
        words = listed(rpy)
        if self.planar:
            freely = turn(2, one) if cut != "weld" else np.eye(4)
            if cut == "universal":  # x of the first place is across the plane, y of the second in it
                words = "[0, -pi/2, 0]"
                first, freely = self.poses[link] @ pose_of(xyz, [0, -np.pi / 2, 0]), np.eye(4)
        second = np.linalg.inv(self.poses[other]) @ first @ freely
        if self.planar:
            second[2, 3] = 0
        angles = listed(angles_of(second))
        if self.planar and cut == "universal":
            angles = listed([0, 0, one])
        name = lambda end: "base" if end < 0 else f"j{end + 1}"
        self.moved.append(self.path(link) ^ self.path(other))
        self.loops.append(
            f"cut: {cut}, between: [{{on: {name(link)}, xyz: {listed(xyz)}, rpy: {words}}}, "
            f"{{on: {name(other)}, xyz: {listed(second[:3, 3])}, rpy: {angles}}}]")
        return rank

    def text(self, name, dependent):
        """The robot file. Each loop names joints that move one of its places and not the other."""
        slots = [k for k, rank in enumerate(self.ranks) for _ in range(rank)]
        holder = [None] * len(slots)

        def settle(joint, tried):  # the augmenting paths of a matching
            for slot, k in enumerate(slots):
                if joint in self.moved[k] and slot not in tried:
                    tried.add(slot)
                    if holder[slot] is None or settle(holder[slot], tried):
                        holder[slot] = joint
                        return True
            return False

        if dependent is not None and not all(settle(joint, set()) for joint in dependent):
            return None
        names = [sorted(joint for joint, of in zip(holder, slots) if of == k and joint is not None)
                 for k in range(len(self.loops))]
        loops = [f"- {{name: loop{k + 1}, {loop}, dependent: [{', '.join(f'j{row + 1}' for row in names[k])}]}}"
                 for k, loop in enumerate(self.loops)]
        gravity = "[0, -9.81, 0]" if self.planar else "[1.5, -2.5, -9.2]"
        tip = max(link for link in range(len(self.q)) if self.flat[link])
        base = [f"floating_base: {{name: base_link, link: {self.base}}}"] if self.base else []
        return "\n".join([
            "format: 2", f"name: {name}", "source: Drawn at random to test closed loops.",
            f"convention: {'standard' if self.standard else 'modified'}", f"gravity: {gravity}",
            *base, f"tool: {{on: j{tip + 1}, xyz: [0.1, -0.05, 0.08], rpy: [0.3, -0.2, 0.5]}}", "joints:", *self.rows,
            "loops:", *loops, ""])


def draw(random, kind, floats):
    """A draft of one to three loops, or None: `kind` says how many, and whether it is planar or in standard rows."""
    planar = kind % 5 < 2
    draft = Draft(random, planar, not planar and kind % 4 == 3, floats)
    for _ in range(int(random.integers(0, 3))):
        draft.row(len(draft.q) - 1, False)
    for _ in range(1 + kind % 3):
        draft.ranks.append(draft.loop(str(random.choice(list(RANKS)))))
        if draft.ranks[-1] is None:
            return None
    for _ in range(int(random.integers(0, 3))):  # joints beside the loops or behind them
        draft.row(int(random.integers(-1, len(draft.q))), True)
    return draft if len(draft.q) <= 20 and 1 <= len(draft.q) - sum(draft.ranks) <= 5 else None


def choice(random, slopes, rank):
    """Columns of full rank, drawn with random weights."""
    weighted = slopes * random.uniform(0.3, 3, slopes.shape[1])
    columns = []
    for _ in range(rank):
        columns.append(int(np.argmax((weighted**2).sum(axis=0))))
        direction = weighted[:, columns[-1]] / np.linalg.norm(weighted[:, columns[-1]])
        weighted = weighted - np.outer(direction, direction @ weighted)
        weighted[:, columns] = 0
    return sorted(columns)


def wrong_choice(random, robot, closed):
    """Names of dependent joints by loop that are refused, and why: there are too many or too few of them, or, where the
    robot has such a choice, they are as many as the rank and lose it at all of the closed positions."""
    slopes, rank, chosen = [robot.slopes(q, range(len(q))) for q in closed], len(robot.passive), robot.dependent
    lists = lambda gone, added, k: [[row for row in of if row != gone] + [added] * (loop == k and added is not None)
                                    for loop, of in enumerate(chosen)]
    more = [(row, k) for k, joints in enumerate(robot.moving()) for row in sorted(joints & set(robot.free))]

    def is_lost(choice):
        columns = sum(choice, [])
        values = [np.linalg.svd(of[:, columns], compute_uv=False) for of in slopes]
        return all(of[rank - 1] < 1e-10 * of[0] for of in values)

    exchanged = [lists(gone, row, k) for gone in robot.passive for row, k in more]
    choices = {"rank": [choice for choice in exchanged if is_lost(choice)],
               "too few": [lists(gone, None, 0) for gone in robot.passive],
               "too many": [lists(None, row, k) for row, k in more]}
    why = "rank" if choices["rank"] else str(random.choice([why for why in choices if choices[why]]))
    choice = choices[why][int(random.integers(len(choices[why])))]
    return {"why": why, "dependent": [[robot.joints[row] for row in rows] for rows in choice]}


def random_robots(count, robot_of, floats=False, part=0):
    """Names, texts and closed positions of random robots; every sixth is the one before with other dependent joints.

    `robot_of` reads a text; with `floats` nothing holds their bases. Each `part` has others."""
    random, found, kind = np.random.default_rng((21 if floats else 20) + 1000 * part), [], 0
    while len(found) < count:
        draft = draw(random, kind, floats)
        if draft is None:
            continue
        name, rank = f"random{len(found) + 1}", sum(draft.ranks)
        slopes = robot_of(draft.text(name, None)).slopes(draft.q, range(len(draft.q)))
        values = np.linalg.svd(slopes, compute_uv=False)
        if min(slopes.shape) < rank or values[rank - 1] < 0.015 * values[0] or (values[rank:] > 1e-3).any():
            continue
        dependent = choice(random, slopes, rank)
        others = [choice(random, slopes, rank) for _ in range(20)]
        others = next((other for other in others if other != dependent), None)
        texts = [draft.text(name, dependent)]
        if len(found) % 6 == 4 and others:
            texts.append(draft.text(f"random{len(found) + 2}", others))
        for text in texts[: count - len(found)]:
            if text is None:
                break
            robot = robot_of(text)
            y = [draft.q[row] for row in robot.free]
            closed = robot.close(y, draft.q)
            if closed is None or not robot.sensible(closed[1]) or max(
                    abs(float(a) - b) for a, b in zip(closed[0], draft.q)) > 0.1:
                break
            slopes = robot.slopes(closed[0], range(len(draft.q)))
            loop_map = np.linalg.pinv(slopes[:, robot.passive], rcond=1e-7) @ slopes[:, robot.free]
            if np.abs(loop_map).max(axis=1).min() < 0.02 or np.abs(loop_map).max() > 20:
                break  # a loop that is rigid, or that is close to another one
            found.append((robot, text, closed[0]))
            kind += text is texts[0]
    return found
