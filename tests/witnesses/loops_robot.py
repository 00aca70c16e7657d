"""Robots with closed loops at 60 digits: the reader of their files, the poses of links, and the closing of loops.

It shares nothing with rne but the meaning of the robot file.
"""

import mpmath as mp
import numpy as np
import yaml

mp.mp.dps = 60
STEP = mp.mpf("1e-13")  # of time and of positions: differences are exact to about 1e-24
LOADER = getattr(yaml, "CBaseLoader", yaml.BaseLoader)
NAMES = {name: getattr(mp, name) for name in ("pi", "sqrt", "sin", "cos", "radians")} | {"deg": mp.radians}


def number(text):
    """A number or an expression of the file, as the decimals that stand there."""
    try:
        return mp.mpf(text)
    except ValueError:
        return mp.mpf(eval(text.replace("^", "**"), NAMES))


def rotation(axis, angle):
    c, s = mp.cos(angle), mp.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    out = np.array([[mp.mpf(int(row == column)) for column in range(4)] for row in range(4)], dtype=object)
    out[i, i], out[i, j], out[j, i], out[j, j] = c, -s, s, c
    return out


def shift(xyz):
    out = rotation(2, mp.mpf(0))
    out[:3, 3] = xyz
    return out


def place(entry):
    """Placement of `at` or of a frame: xyz, and Rz(yaw) Ry(pitch) Rx(roll)."""
    xyz, rpy = ([number(x) for x in entry.get(key, [0, 0, 0])] for key in ("xyz", "rpy"))
    return shift(xyz) @ rotation(2, rpy[2]) @ rotation(1, rpy[1]) @ rotation(0, rpy[0])


def body(link):
    """Mass, centre of mass, and inertia about it."""
    element = lambda key: number(link.get("inertia", {}).get(key, 0))
    xx, yy, zz, xy, xz, yz = map(element, ("xx", "yy", "zz", "xy", "xz", "yz"))
    tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    return number(link["mass"]), np.array([number(x) for x in link.get("com", [0, 0, 0])]), tensor


def second_moments(mass, centre, tensor):
    """∫ (r, 1) (r, 1)ᵀ dm of a body."""
    out = shift([0, 0, 0])
    out[:3, :3] = out[:3, :3] * (tensor.trace() / 2) - tensor + mass * np.outer(centre, centre)
    out[:3, 3] = out[3, :3] = mass * centre
    out[3, 3] = mass
    return out


class Robot:
    """A robot file of format 2 with loops: rows as constants before and after each joint, links as second moments."""

    def __init__(self, text):
        file = yaml.load(text, LOADER)  # all words stay words: `on`, and all digits
        self.name, self.joints = file["name"], [joint["name"] for joint in file["joints"]]
        self.floating_base = file.get("floating_base")
        if self.floating_base:
            self.base = body(self.floating_base["link"])
        self.slides = [joint["type"] == "prismatic" for joint in file["joints"]]
        self.gravity = np.array([number(x) for x in file["gravity"]])
        self.parents, self.before, self.after, self.moments, self.links = [], [], [], [], []
        for row, joint in enumerate(file["joints"]):
            parent = joint.get("parent")
            self.parents.append(row - 1 if parent is None else self.link(parent))
            dh = {key: number(value) for key, value in joint["dh"].items()}
            along = shift([dh["a"], 0, 0]) @ rotation(0, dh["alpha"])
            turn = rotation(2, dh["theta"]) @ shift([0, 0, dh["d"]])
            start = place(joint.get("at", {})) @ rotation(2, dh.get("gamma", 0)) @ shift([0, 0, dh.get("b", 0)])
            modified = file["convention"] == "modified"
            self.before.append(start @ along @ turn if modified else start)
            self.after.append(None if modified else turn @ along)
            self.links.append(body(joint.get("link", {"mass": 0})))
            self.moments.append(second_moments(*self.links[-1]))
        constant = lambda poses: [pose if pose is None else pose.astype(complex) for pose in poses]
        self.rough = constant(self.before), constant(self.after)
        self.cuts = [(loop["cut"], [(self.link(end["on"]), place(end)) for end in loop["between"]])
                     for loop in file["loops"]]
        self.dependent = [[self.link(name) for name in loop["dependent"]] for loop in file["loops"]]
        self.passive = sorted(sum(self.dependent, []))
        self.free = [row for row in range(len(self.joints)) if row not in self.passive]
        self.tip = (self.link(file["tool"]["on"]), place(file["tool"])) if "tool" in file else None

    def link(self, name):
        is_base = name == "base" or self.floating_base and name == self.floating_base["name"]
        return -1 if is_base else self.joints.index(name)

    def moving(self):
        """For each loop the joints that move one of its places and not the other."""
        def path(link):
            return {link} | path(self.parents[link]) if link >= 0 else set()

        return [path(first[0]) ^ path(second[0]) for _, (first, second) in self.cuts]

    def poses(self, q):
        """Poses of all links, the base last. Positions that are complex numbers have poses in double precision."""
        rough = isinstance(q[0], complex)
        before, after = (self.rough if rough else (self.before, self.after))
        sin, cos, out = np.sin if rough else mp.sin, np.cos if rough else mp.cos, []
        for row, parent in enumerate(self.parents):
            pose = out[parent] @ before[row] if parent >= 0 else before[row].copy()
            if self.slides[row]:
                pose[:3, 3] = pose[:3, 3] + pose[:3, 2] * q[row]
            else:
                c, s = cos(q[row]), sin(q[row])
                x, y = pose[:3, 0], pose[:3, 1]  # arrays first: mpmath would print an array that it multiplies
                pose[:3, 0], pose[:3, 1] = x * c + y * s, y * c - x * s
            out.append(pose if after[row] is None else pose @ after[row])
        return [*out, np.eye(4) if rough else shift([0, 0, 0])]

    def gaps(self, poses):
        """What is left of the loops: zeros where they are closed."""
        out = []
        for cut, ends in self.cuts:
            first, second = (poses[link] @ frame.astype(poses[link].dtype) for link, frame in ends)
            turn = first[:3, :3].T @ second[:3, :3]
            out += list(second[:3, 3] - first[:3, 3])
            out += {"revolute": [turn[0, 2], turn[1, 2]], "spherical": [], "universal": [turn[0, 1]],
                    "weld": [turn[1, 2] - turn[2, 1], turn[2, 0] - turn[0, 2], turn[0, 1] - turn[1, 0]]}[cut]
        return np.array(out)

    def sensible(self, poses):
        """Whether no cut is closed upside down, which its equations allow."""
        turns = [(cut, (poses[ends[0][0]] @ ends[0][1])[:3, :3].T @ (poses[ends[1][0]] @ ends[1][1])[:3, :3])
                 for cut, ends in self.cuts]
        return all({"revolute": turn[2, 2] > 0, "weld": turn.trace() > 2}.get(cut, True) for cut, turn in turns)

    def slopes(self, q, columns):
        """Derivative of the gaps, in double precision: a small imaginary part of a position takes no difference."""
        tiny, out = 1e-30, []
        for column in columns:
            moved = [complex(x) for x in q]
            moved[column] += tiny * 1j
            out.append([x.imag / tiny for x in self.gaps(self.poses(moved))])
        return np.array(out).T

    def close(self, y, guess, slopes=None):
        """All positions where the independent joints stand at y; None if Newton steps from the guess find none."""
        q = list(guess)
        for row, value in zip(self.free, y):
            q[row] = value
        last = mp.inf
        for _ in range(40):
            poses = self.poses(q)
            gaps = self.gaps(poses)
            size = max(abs(x) for x in gaps)
            if size < mp.mpf("1e-54"):
                return q, poses
            if size < mp.mpf("1e-9") and size > last / 10:
                return None  # equations without a solution
            inverted = np.linalg.pinv(self.slopes(q, self.passive) if slopes is None else slopes, rcond=1e-7)
            step = inverted.astype(object) @ gaps
            if max(abs(x) for x in step) > 0.7 and slopes is None:
                step = step * (mp.mpf("0.7") / max(abs(x) for x in step))
            for row, value in zip(self.passive, step):
                q[row] -= value
            last = size
        return None
