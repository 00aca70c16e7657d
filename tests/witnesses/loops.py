"""Golden values of robots with closed loops, by two oracles that share no formula with rne.

Usage: python loops.py [NAME …]                       the robots of benches/trees/loops, to tests/golden/loops/NAME.json
       python loops.py random N FILE [PROCESSES]      N random robots, their files inside; 60 in random.json there
       python loops.py floating N FILE [PROCESSES]    the same on floating bases; 20 in floating_random.json there

Needs numpy, mpmath, PyYAML and pin. The values come from the closed kinematics alone: the loops are closed by Newton
steps at 60 digits, and rates, accelerations and virtual displacements are differences of the closed poses. The virtual
work of all points of a body, tr(T'' S dT'), is Lagrange's and d'Alembert's principle: no Newton-Euler recursion,
no Jacobian and no equation of a loop is differentiated by a formula. The second oracle is Pinocchio in double
precision: rnea, crba and the rates of the loop equations, put together as the system of KKT.

A state has q, qd, qdd and tau of the independent joints, and passive, the positions of the dependent ones, both in the
order of the file; wrench is that of the robot on its surroundings, in axes of the tip, force first. Matrices stand by
rows: loop_map has a row for each dependent joint, which is its rate for each rate of an independent one.
passive_accelerations_bias are the accelerations of the dependent joints while those of the independent ones are zero.

Where the robot has a floating base, these are the values while something holds it still, in the gravity of the file.
The values beside a motion `base` of the base (loops_floating.py) have six numbers of the base first: force and moment,
or acceleration less gravity and angular acceleration; then those of the independent joints.
"""

import json
import multiprocessing
import pathlib
import sys

import mpmath as mp
import numpy as np

from loops_floating import FloatingPinocchio, floating_values, motion_of_base
from loops_peer import Pinocchio
from loops_random import random_robots, wrong_choice
from loops_robot import STEP, Robot

STATES, RANDOM_STATES, PART = 5, 3, 60
ROOT = pathlib.Path(__file__).parents[2]
FOLDER = ROOT / "benches/trees/loops"
# A position of the independent joints at which the loops close, a guess of the dependent ones, and how far the states
# are from it. All others are zero.
START = {
    "bennett": ({"j1": 1.0, "j2": 2.5, "j3": -1.0}, 0.4),
    "cassie_like": ({"motor_ankle": 0.5, "free_knee": 0.5, "free_ankle": -0.6, "ankle_rod_1": 1.3, "ankle_foot_1": -0.7,
                     "heel_rod_1": -0.5, "heel_tigh_1": -0.8}, 0.2),
    "digit_like": ({"free_foot1": -2.4, "rod1_x": 1.1, "rod2_x": 1.1}, 0.2),
    "five_bar": ({"mot1": 0.5, "mot2": -0.5, "free1": -1.4, "free2": 1.4}, 0.4),
    "palletiser": ({"j7": -1.5, "j8": 1.5}, 0.4),
    "floating_four_bar_leg": ({"crank": 1.2, "shank": -1.03, "rocker": 1.18}, 0.4),
    "four_bar": ({"joint1": 1.2, "joint2": -1.2, "joint3": 1.2}, 0.6),
    "six_bar": ({"joint1": 0.5, "joint2": 0.6, "joint3": -0.7, "joint4": 1.5, "joint5": -2.0}, 0.3),
    "planar_leg_linkage": ({"thigh_to_driver": 0.8, "driver_to_foot": -0.8, "thigh_to_support": 0.8}, 0.3),
}


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
    return {key: as_floats(numbers) for key, numbers in values.items()}


def as_floats(numbers):
    return [float(x) if abs(x) > 1e-20 else 0.0 for x in numbers]


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
        if values[-1] * 300 < values[0]:
            continue
        parts, wrench = random.uniform(-1, 1, len(goal)), random.uniform(-10, 10, 6)
        found.append((closed[0], {
            "q": [float(y) for y in goal], "passive": [float(closed[0][row]) for row in robot.passive],
            "qd": draw(2), "qdd": draw(5), "parts": [float(x) for x in parts],
            "wrench": [round(float(x), 3) for x in wrench]}))
    return found


def golden(robot, q, reach, count):
    """Closed positions and states with their values, and the largest difference between both oracles by function."""
    peer, out, errors, conditions = Pinocchio(robot), [], {}, [0.0, 0.0]
    floating = FloatingPinocchio(robot) if robot.floating_base else None
    random = np.random.default_rng(8)
    for closed, state in states(robot, q, reach, count):
        values = oracle(robot, closed, state)
        state_errors, *of_state = peer.compare(closed, state, values)
        if floating:
            state["base"] = motion_of_base(random)
            of_base = {key: as_floats(numbers) for key, numbers in floating_values(robot, closed, state).items()}
            state_errors |= floating.compare(closed, state, values | of_base)
            values |= of_base
        conditions = [max(pair) for pair in zip(conditions, of_state)]
        errors = {key: max(error, errors.get(key, 0.0)) for key, error in state_errors.items()}
        out.append((closed, state | values))
    return out, errors, conditions


def report(name, robot, found, errors, conditions):
    cuts = ", ".join(cut for cut, _ in robot.cuts)
    solved = [key for key in errors if "forward_dynamics" in key]
    accelerations = max(map(errors.pop, solved), default=0.0)
    key = max(errors, key=errors.get) if errors else ""
    print(f"{name}: {len(robot.joints)} joints, cuts {cuts}, independent {len(robot.free)}, dependent "
          f"{len(robot.passive)}, states {len(found)}, condition {conditions[0]:.1f}, of M {conditions[1]:.0f}, "
          f"largest difference {errors.get(key, 0):.1e} of {key}, of forward_dynamics {accelerations:.1e}", flush=True)
    if not errors or max(errors.values()) > 1e-10 or accelerations > 1e-10:
        raise RuntimeError(f"{name}: failed")


def random_entries(part):
    """Random robots with their states, and for each a wrong choice of its dependent joints."""
    count, floats, number = part
    entries, random = [], np.random.default_rng(number)
    for robot, text, q in random_robots(count, Robot, floats, number):
        found, errors, conditions = golden(robot, q, 0.15, RANDOM_STATES)
        report(f"{robot.name} of part {number}", robot, [state for _, state in found], errors, conditions)
        wrong = wrong_choice(random, robot, [closed for closed, _ in found])
        entries.append({"yaml": text, "wrong": wrong, "states": [state for _, state in found]})
    return entries


def line(value):
    return json.dumps(value, separators=(",", ":"))


def main():
    if sys.argv[1:2] in (["random"], ["floating"]):
        count, floats = int(sys.argv[2]), sys.argv[1] == "floating"
        parts = [(min(PART, count - start), floats, start // PART) for start in range(0, count, PART)]
        with multiprocessing.Pool(int(sys.argv[4]) if len(sys.argv) > 4 else 1) as pool:
            entries = sum(pool.imap(random_entries, parts), [])
        pathlib.Path(sys.argv[3]).write_text("[\n" + ",\n".join(map(line, entries)) + "\n]\n")
        return
    for path in sorted(FOLDER.glob("*.yaml")):
        if sys.argv[1:] and path.stem not in sys.argv[1:]:
            continue
        robot = Robot(path.read_text())
        near, reach = START.get(path.stem, START.get(path.stem.removeprefix("floating_"), ({}, 0.3)))
        guess = [mp.mpf(near.get(name, 0)) for name in robot.joints]
        closed = robot.close([guess[row] for row in robot.free], guess)
        if closed is None or not robot.sensible(closed[1]):
            sys.exit(f"{path.stem}: no closed positions near the start")
        found, errors, conditions = golden(robot, closed[0], reach, STATES)
        found = [state for _, state in found]
        report(path.stem, robot, found, errors, conditions)
        out = ROOT / "tests/golden/loops" / f"{path.stem}.json"
        out.parent.mkdir(exist_ok=True)
        out.write_text("[\n" + ",\n".join(map(line, found)) + "\n]\n")


if __name__ == "__main__":
    main()
