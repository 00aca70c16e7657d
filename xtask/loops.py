"""Golden values of robots with closed loops, by two oracles that share no formula with rne.

Usage: python loops.py [NAME …]         the robots of benches/trees/loops, to tests/golden/loops/NAME.json
       python loops.py random N FILE    N random robots, their files inside; tests/golden/loops/random.json has 60

Needs numpy, mpmath, PyYAML and pin. The values come from the closed kinematics alone: the loops are closed by Newton
steps at 60 digits, and rates, accelerations and virtual displacements are differences of the closed poses. The virtual
work of all points of a body, tr(T'' S dT'), is Lagrange's and d'Alembert's principle: no Newton-Euler recursion,
no Jacobian and no equation of a loop is differentiated by a formula. The second oracle is Pinocchio in double
precision: rnea, crba and the rates of the loop equations, put together as the system of KKT.
"""

import json
import pathlib
import sys

import mpmath as mp
import numpy as np
import pinocchio as pin
import yaml

from random_loops import random_robots

mp.mp.dps = 60
STEP = mp.mpf("1e-13")  # of time and of positions: differences are exact to about 1e-24
STATES, RANDOM_STATES = 5, 3
ROOT = pathlib.Path(__file__).parent.parent
FOLDER = ROOT / "benches/trees/loops"
NAMES = {name: getattr(mp, name) for name in ("pi", "sqrt", "sin", "cos", "radians")} | {"deg": mp.radians}
# A position of the independent joints at which the loops close, a guess of the dependent ones, and how far the states
# are from it. All others are zero.
START = {
    "palletiser": ({"j7": -1.5, "j8": 1.5}, 0.4),
    "four_bar": ({"joint1": 1.2, "joint2": -1.2, "joint3": 1.2}, 0.6),
    "six_bar": ({"joint1": 0.5, "joint2": 0.6, "joint3": -0.7, "joint4": 1.5, "joint5": -2.0}, 0.3),
    "planar_leg_linkage": ({"thigh_to_driver": 0.8, "driver_to_foot": -0.8, "thigh_to_support": 0.8}, 0.3),
}


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


def inverse(pose):
    out = shift(-pose[:3, :3].T @ pose[:3, 3])
    out[:3, :3] = pose[:3, :3].T
    return out


class Robot:
    """A robot file of format 2 with loops: rows as constants before and after each joint, links as second moments."""

    def __init__(self, text):
        file = yaml.load(text, yaml.BaseLoader)  # all words stay words: `on`, and all digits
        self.name, self.joints = file["name"], [joint["name"] for joint in file["joints"]]
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
            link = joint.get("link", {"mass": 0})
            mass, centre = number(link["mass"]), np.array([number(x) for x in link.get("com", [0, 0, 0])])
            element = lambda key: number(link.get("inertia", {}).get(key, 0))
            xx, yy, zz, xy, xz, yz = map(element, ("xx", "yy", "zz", "xy", "xz", "yz"))
            tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])  # about the centre of mass
            moment = shift([0, 0, 0])
            moment[:3, :3] = moment[:3, :3] * ((xx + yy + zz) / 2) - tensor + mass * np.outer(centre, centre)
            moment[:3, 3] = moment[3, :3] = mass * centre
            moment[3, 3] = mass
            self.moments.append(moment)
            self.links.append((mass, centre, tensor))
        self.cuts = [(loop["cut"], [(self.link(end["on"]), place(end)) for end in loop["between"]])
                     for loop in file["loops"]]
        dependent = {name for loop in file["loops"] for name in loop["dependent"]}
        self.passive = [row for row, name in enumerate(self.joints) if name in dependent]
        self.free = [row for row, name in enumerate(self.joints) if name not in dependent]
        self.tip = (self.link(file["tool"]["on"]), place(file["tool"])) if "tool" in file else None

    def link(self, name):
        return -1 if name == "base" else self.joints.index(name)

    def poses(self, q):
        """Poses of all links, the base last."""
        out = []
        for row, parent in enumerate(self.parents):
            pose = (out[parent] if parent >= 0 else shift([0, 0, 0])) @ self.before[row]
            if self.slides[row]:
                pose[:3, 3] = pose[:3, 3] + pose[:3, 2] * q[row]
            else:
                c, s = mp.cos(q[row]), mp.sin(q[row])
                pose[:3, 0], pose[:3, 1] = c * pose[:3, 0] + s * pose[:3, 1], c * pose[:3, 1] - s * pose[:3, 0]
            out.append(pose if self.after[row] is None else pose @ self.after[row])
        return [*out, shift([0, 0, 0])]

    def gaps(self, poses):
        """What is left of the loops: zeros where they are closed."""
        out = []
        for cut, ends in self.cuts:
            first, second = (poses[link] @ frame for link, frame in ends)
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
        """Derivative of the gaps, in double precision."""
        gaps, tiny = self.gaps(self.poses(q)), mp.mpf("1e-30")
        out = []
        for column in columns:
            moved = list(q)
            moved[column] += tiny
            out.append([float(x) for x in (self.gaps(self.poses(moved)) - gaps) / tiny])
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


def oracle(robot, q, state):
    """The values at one state, from differences of closed poses."""
    y = [q[row] for row in robot.free]
    slopes, degrees = robot.slopes(q, robot.passive), range(len(y))
    closed = lambda moved: robot.close(moved, q, slopes)
    path = lambda *rates: closed([sum((r * STEP**k / mp.factorial(k) for k, r in enumerate(terms, 1)), x)
                                  for x, *terms in zip(y, *rates)])
    qd, qdd, wrench = ([mp.mpf(x) for x in state[key]] for key in ("qd", "qdd", "wrench"))
    back = [-x for x in qd]
    here = (q, robot.poses(q))
    bodies = range(len(q))

    def second(rate):  # accelerations of joints and links on a path through here
        ahead, behind = path(qd, *rate), path(back, *rate)
        joints = [(a - 2 * x + b) / STEP**2 for a, x, b in zip(ahead[0], q, behind[0])]
        return joints, [(ahead[1][b] - 2 * here[1][b] + behind[1][b]) / STEP**2 for b in bodies]

    bends, moves = [], []  # of joints and of links, for each independent joint
    for i in degrees:
        unit = [STEP if k == i else mp.mpf(0) for k in degrees]
        ahead, behind = (closed([x + sign * u for x, u in zip(y, unit)]) for sign in (1, -1))
        bends.append([(a - b) / (2 * STEP) for a, b in zip(ahead[0], behind[0])])
        moves.append([(a - b) / (2 * STEP) for a, b in zip(ahead[1], behind[1])])

    def work(accelerations):
        out = []
        for i in degrees:
            total = mp.mpf(0)
            for b in bodies:
                if accelerations is not None:
                    total += ((accelerations[b] @ robot.moments[b])[:3] * moves[i][b][:3]).sum()
                total -= robot.gravity @ moves[i][b][:3] @ robot.moments[b][:, 3]
            out.append(total)
        return out

    drift, drifting = second([])
    accelerations, moving = second([qdd])
    mass = mp.matrix([[sum(((moves[i][b] @ robot.moments[b])[:3] * moves[j][b][:3]).sum() for b in bodies)
                       for j in degrees] for i in degrees])
    bias, torques = work(drifting), work(moving)
    assert max(abs(a - b - c) for a, b, c in zip(torques, bias, mass * mp.matrix(qdd))) < 1e-18 * max(map(abs, torques))
    state["tau"] = [float(f"{float(max(map(abs, torques))) * part:.3g}") for part in state.pop("parts")]
    link, frame = robot.tip
    turn = (here[1][link] @ frame)[:3, :3]
    force, moment = turn @ np.array(wrench[:3]), turn @ np.array(wrench[3:])
    carried = []
    for i in degrees:
        move = moves[i][link] @ frame
        spin = move[:3, :3] @ turn.T
        carried.append(move[:3, 3] @ force + np.array([spin[2, 1], spin[0, 2], spin[1, 0]]) @ moment)
    at = lambda values: [values[row] for row in robot.passive]
    values = {
        "loop_map": [x for row in robot.passive for x in (bend[row] for bend in bends)],
        "passive_rates": [sum(bend[row] * rate for bend, rate in zip(bends, qd)) for row in robot.passive],
        "passive_accelerations": at(accelerations),
        "passive_accelerations_bias": at(drift),
        "inverse_dynamics": torques,
        "inverse_dynamics_with_wrench": [a + b for a, b in zip(torques, carried)],
        "gravity_torques": work(None),
        "bias_torques": bias,
        "mass_matrix": list(mass),
        "forward_dynamics": list(mp.lu_solve(mass, mp.matrix([a - b for a, b in zip(state["tau"], bias)]))),
    }
    return {key: [float(x) for x in numbers] for key, numbers in values.items()}


class Pinocchio:
    """The tree in Pinocchio; the loops are equations between its frames."""

    def __init__(self, robot):
        self.robot, self.model, rows = robot, pin.Model(), {-1: 0}
        place = lambda pose: pin.SE3(pose[:3, :3].astype(float), pose[:3, 3].astype(float))
        ends = {-1: pin.SE3.Identity()}

        def add(row):  # depth first, as Pinocchio wants it
            parent = robot.parents[row]
            kind = pin.JointModelPZ() if robot.slides[row] else pin.JointModelRZ()
            rows[row] = self.model.addJoint(rows[parent], kind, ends[parent] * place(robot.before[row]),
                                            robot.joints[row])
            ends[row] = pin.SE3.Identity() if robot.after[row] is None else place(robot.after[row])
            mass, centre, tensor = robot.links[row]
            body = pin.Inertia(float(mass), centre.astype(float), tensor.astype(float))
            self.model.appendBodyToJoint(rows[row], body, ends[row])
            for child, above in enumerate(robot.parents):
                if above == row:
                    add(child)

        for row, parent in enumerate(robot.parents):
            if parent == -1:
                add(row)
        frame = lambda name, end: self.model.addFrame(
            pin.Frame(name, rows[end[0]], ends[end[0]] * place(end[1]), pin.FrameType.OP_FRAME))
        self.cuts = [(cut, [frame(f"{k}{side}", end) for side, end in enumerate(ends_of)])
                     for k, (cut, ends_of) in enumerate(robot.cuts)]
        self.tip = frame("tip", robot.tip)
        self.model.gravity.linear = robot.gravity.astype(float)
        self.data = self.model.createData()
        self.order = [self.model.joints[rows[row]].idx_v for row in range(len(robot.joints))]

    def equations(self, q, v):
        """K and k of K q'' = k, from products of vectors that stay zero."""
        axes, zero = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED, np.zeros(self.model.nv)
        pin.computeJointJacobians(self.model, self.data, q)
        pin.forwardKinematics(self.model, self.data, q, v, zero)
        pin.updateFramePlacements(self.model, self.data)
        rows, rest = [], []
        for cut, frames in self.cuts:
            jacobians = [pin.getFrameJacobian(self.model, self.data, f, axes) for f in frames]
            drifts = [pin.getFrameClassicalAcceleration(self.model, self.data, f, axes) for f in frames]
            spins = [pin.getFrameVelocity(self.model, self.data, f, axes).angular for f in frames]
            rows += list(jacobians[1][:3] - jacobians[0][:3])
            rest += list(drifts[0].linear - drifts[1].linear)
            if cut == "weld":
                rows += list(jacobians[1][3:] - jacobians[0][3:])
                rest += list(drifts[0].angular - drifts[1].angular)
            for first, second in {"revolute": [(0, 2), (1, 2)], "universal": [(0, 1)]}.get(cut, []):
                x, z = (self.data.oMf[f].rotation[:, column] for f, column in zip(frames, (first, second)))
                (xd, zd) = np.cross(spins[0], x), np.cross(spins[1], z)
                bend = lambda side, axis, rate: np.cross(drifts[side].angular, axis) + np.cross(spins[side], rate)
                rows.append(np.cross(z, x) @ (jacobians[1][3:] - jacobians[0][3:]))
                rest.append(-(bend(0, x, xd) @ z + 2 * xd @ zd + x @ bend(1, z, zd)))
        return np.array(rows)[:, self.order], np.array(rest)

    def compare(self, q, state, expected):
        """The largest differences, relative to the largest number, and the singular values of the dependent joints."""
        robot, size = self.robot, len(q)
        rates, accelerations = np.zeros(size), np.zeros(size)
        rates[robot.free], rates[robot.passive] = state["qd"], expected["passive_rates"]
        accelerations[robot.free] = state["qdd"]
        q, v = self._spread(q), self._spread(rates)
        keys, rest = self.equations(q, v)
        values = np.linalg.svd(keys[:, robot.passive], compute_uv=False)
        rank = int((values > 1e-7 * values[0]).sum())
        assert rank == len(robot.passive), "the dependent joints do not follow"
        inverted = np.linalg.pinv(keys[:, robot.passive], rcond=1e-7)
        loop_map = -inverted @ keys[:, robot.free]
        drift = inverted @ rest
        follow = np.eye(size)[:, robot.free]
        follow[robot.passive] = loop_map
        accelerations[robot.passive] = drift + loop_map @ state["qdd"]
        torques = follow.T @ pin.rnea(self.model, self.data, q, v, self._spread(accelerations))[self.order]
        tip = pin.computeFrameJacobian(self.model, self.data, q, self.tip, pin.ReferenceFrame.LOCAL)[:, self.order]
        tree = pin.crba(self.model, self.data, q)
        tree = (np.triu(tree) + np.triu(tree, 1).T)[np.ix_(self.order, self.order)]
        zeros = np.zeros(size)
        gravity = follow.T @ pin.rnea(self.model, self.data, q, zeros, zeros)[self.order]
        nle = pin.nonLinearEffects(self.model, self.data, q, v)[self.order]
        mass, added = follow.T @ tree @ follow, np.zeros(size)
        added[robot.passive] = drift
        # Forward dynamics of the whole system: multipliers of redundant equations are not unique, accelerations are.
        pushed = np.zeros(size)
        pushed[robot.free] = state["tau"]
        system = np.block([[tree, keys.T], [keys, np.zeros((len(keys), len(keys)))]])
        solved = np.linalg.lstsq(system, np.concatenate([pushed - nle, rest]), rcond=1e-13)[0][:size]
        found = {
            "loop_map": loop_map, "passive_rates": loop_map @ state["qd"], "passive_accelerations_bias": drift,
            "passive_accelerations": accelerations[robot.passive], "inverse_dynamics": torques,
            "inverse_dynamics_with_wrench": torques + follow.T @ tip.T @ state["wrench"],
            "gravity_torques": gravity, "bias_torques": follow.T @ (nle + tree @ added), "mass_matrix": mass,
            "forward_dynamics": solved[robot.free],
        }
        largest = max(np.abs(expected["inverse_dynamics"]).max(), 1e-300)
        scales = {"gravity_torques": largest, "bias_torques": largest}
        errors = {key: np.abs(np.ravel(found[key]) - expected[key]).max()
                  / max(np.abs(expected[key]).max(), scales.get(key, 1e-12)) for key in expected}
        return errors, values[0] / values[rank - 1], np.linalg.cond(mass)

    def _spread(self, values):
        out = np.zeros(self.model.nv)
        out[self.order] = [float(x) for x in values]
        return out


def states(robot, q, reach, count):
    """States near the closed positions q, where the dependent joints are well determined."""
    random, found, tries = np.random.default_rng(7), [], 0
    draw = lambda size: [round(float(x), 3) for x in random.uniform(-size, size, len(robot.free))]
    while len(found) < count and tries < 20 * count:
        tries += 1
        start = [q[row] for row in robot.free]
        goal = [mp.mpf(str(round(float(y) + reach * x, 4))) for y, x in zip(start, draw(1))]
        closed = (q, None)
        for step in range(1, 4):
            closed = robot.close([a + (b - a) * step / 3 for a, b in zip(start, goal)], closed[0])
            if closed is None:
                break
        if closed is None or not robot.sensible(closed[1]):
            continue
        values = np.linalg.svd(robot.slopes(closed[0], robot.passive), compute_uv=False)[: len(robot.passive)]
        if values[-1] * 100 < values[0]:
            continue
        parts, wrench = random.uniform(-1, 1, len(goal)), random.uniform(-10, 10, 6)
        found.append((closed[0], {
            "q": [float(y) for y in goal], "passive": [float(closed[0][row]) for row in robot.passive],
            "qd": draw(2), "qdd": draw(5), "parts": [float(x) for x in parts],
            "wrench": [round(float(x), 3) for x in wrench]}))
    return found


def golden(robot, q, reach, count):
    """States with their values, and the largest difference between both oracles by function."""
    peer, out, errors, conditions = Pinocchio(robot), [], {}, [0.0, 0.0]
    for closed, state in states(robot, q, reach, count):
        values = oracle(robot, closed, state)
        state_errors, *of_state = peer.compare(closed, state, values)
        conditions = [max(pair) for pair in zip(conditions, of_state)]
        errors = {key: max(error, errors.get(key, 0.0)) for key, error in state_errors.items()}
        out.append(state | values)
    return out, errors, conditions


def report(name, robot, found, errors, conditions):
    cuts = ", ".join(cut for cut, _ in robot.cuts)
    accelerations = errors.pop("forward_dynamics", 0.0)
    key = max(errors, key=errors.get) if errors else ""
    print(f"{name}: {len(robot.joints)} joints, cuts {cuts}, independent {len(robot.free)}, dependent "
          f"{len(robot.passive)}, states {len(found)}, condition {conditions[0]:.1f}, of M {conditions[1]:.0f}, largest "
          f"difference {errors.get(key, 0):.1e} of {key}, of forward_dynamics {accelerations:.1e}", flush=True)
    if not errors or max(errors.values()) > 1e-9 or accelerations > 1e-9:
        sys.exit(f"{name}: failed")


def line(value):
    return json.dumps(value, separators=(",", ":"))


def main():
    if sys.argv[1:2] == ["random"]:
        entries = []
        for robot, text, q in random_robots(int(sys.argv[2]), Robot):
            name = robot.name
            found, errors, conditions = golden(robot, q, 0.15, RANDOM_STATES)
            report(name, robot, found, errors, conditions)
            entries.append({"yaml": text, "states": found})
        pathlib.Path(sys.argv[3]).write_text("[\n" + ",\n".join(map(line, entries)) + "\n]\n")
        return
    for path in sorted(FOLDER.glob("*.yaml")):
        if sys.argv[1:] and path.stem not in sys.argv[1:]:
            continue
        robot = Robot(path.read_text())
        near, reach = START.get(path.stem, ({}, 0.3))
        guess = [mp.mpf(near.get(name, 0)) for name in robot.joints]
        closed = robot.close([guess[row] for row in robot.free], guess)
        if closed is None or not robot.sensible(closed[1]):
            sys.exit(f"{path.stem}: no closed positions near the start")
        found, errors, conditions = golden(robot, closed[0], reach, STATES)
        report(path.stem, robot, found, errors, conditions)
        out = ROOT / "tests/golden/loops" / f"{path.stem}.json"
        out.parent.mkdir(exist_ok=True)
        out.write_text("[\n" + ",\n".join(map(line, found)) + "\n]\n")


if __name__ == "__main__":
    main()
