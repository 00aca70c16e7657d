"""Random arms with rotors and awkward joint names: the emitted C beside a recursion of this file, and check_c.py.

The arms are made here, as numbers; the robot file is written from them. The recursion computes with doubles in world
axes and shares nothing with rne or with check_c.py. `cc` compiles the C for this computer.
"""
import ctypes
import math
import random
import re
import subprocess

# keywords of C, YAML, Rust and of robot files, and names that differ by case alone
NAMES = ["base", "tip", "world", "null", "true", "for", "int", "float", "self", "tau", "q", "joint1", "link", "Base", "~"]


def arm(seed, kind):
    """A random arm: format 1, or format 2 as a chain or as a tree."""
    draw = random.Random(f"{kind} {seed}")
    number = lambda low, high: round(draw.uniform(low, high), draw.choice([1, 3, 6]))
    count = draw.randint(2, 6)
    names = draw.sample(NAMES, count)
    if kind == "format 1" and "base" not in names:
        names[draw.randrange(count)] = "base"
    if kind == "tree":  # `parent: base` has one meaning alone
        names = [name if name != "base" else "basis" for name in names]
    joints = []
    for at in range(count):
        joints.append({
            "name": names[at], "type": draw.choice(["revolute", "revolute", "prismatic"]),
            "theta": draw.choice([0.0, number(-2, 2)]), "d": number(-0.4, 0.4), "a": draw.choice([0.0, number(-0.5, 0.5)]),
            "alpha": draw.choice([0.0, math.pi / 2, -math.pi / 2, number(-2, 2)]), "mass": number(0.5, 9),
            "com": [number(-0.2, 0.2) for _ in range(3)],
            "inertia": [0.3, 0.31, 0.32, *(number(-0.02, 0.02) for _ in range(3))],
            "about": draw.choice(["com", "origin"]), "parent": draw.randrange(at + 1) if kind == "tree" else at,
            "ratio": draw.choice([1.0, number(20, 160), -number(20, 160)]), "rotor": draw.choice([0.0, number(1e-6, 1e-3)]),
        })
        if joints[-1]["about"] == "origin":  # of a body, wherever its centre of mass is
            m, (x, y, z) = joints[-1]["mass"], joints[-1]["com"]
            more = [m * (y * y + z * z), m * (x * x + z * z), m * (x * x + y * y), -m * x * y, -m * x * z, -m * y * z]
            joints[-1]["inertia"] = [a + b for a, b in zip(joints[-1]["inertia"], more)]
    if all(joint["rotor"] == 0 for joint in joints):
        joints[-1]["rotor"] = 2e-4
    return {"convention": draw.choice(["standard", "modified"]), "joints": joints,
            "gravity": [number(-3, 3), number(-3, 3), -9.81], "is_tree": kind == "tree", "format": 1 if kind == "format 1" else 2}


def robot_file(arm):
    lines = [f"format: {arm['format']}", "name: arm", "source: drawn at random", f"convention: {arm['convention']}",
             f"gravity: {arm['gravity']}"]
    if arm["is_tree"]:
        lines.append(f"tool: {{on: '{arm['joints'][-1]['name']}'}}")
    lines.append("joints:")
    names = ["base"] + [joint["name"] for joint in arm["joints"]]
    for joint in arm["joints"]:
        tensor = ", ".join(f"{key}: {value!r}" for key, value in zip(["xx", "yy", "zz", "xy", "xz", "yz"], joint["inertia"]))
        parent = f" parent: '{names[joint['parent']]}'," if arm["is_tree"] else ""
        lines.append(
            f"  - {{name: '{joint['name']}',{parent} type: {joint['type']}, dh: {{theta: {joint['theta']!r}, d: {joint['d']!r}, "
            f"a: {joint['a']!r}, alpha: {joint['alpha']!r}}}, link: {{mass: {joint['mass']}, com: {joint['com']}, inertia: "
            f"{{{tensor}}}, inertia_about: {joint['about']}}}, motor: {{gear_ratio: {joint['ratio']}, inertia: {joint['rotor']!r}}}}}")
    return "\n".join(lines) + "\n"


def product(a, b):
    return [[sum(x * y for x, y in zip(row, column)) for column in zip(*b)] for row in a]


def by(a, v):
    return [sum(x * y for x, y in zip(row, v)) for row in a]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def plus(*vectors):
    return [sum(parts) for parts in zip(*vectors)]


def times(k, v):
    return [k * x for x in v]


def step(theta, d, a, alpha, convention):
    """The 4 x 4 matrix of a row, and the part of it before the axis of the joint."""
    def screw(axis, angle, way):
        s, c = math.sin(angle), math.cos(angle)
        turn = {"x": [[1, 0, 0], [0, c, -s], [0, s, c]], "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]]}[axis]
        place = [way if name == axis else 0.0 for name in "xyz"]
        return [row + [p] for row, p in zip(turn, place)] + [[0.0, 0.0, 0.0, 1.0]]
    of_x, of_z = screw("x", alpha, a), screw("z", theta, d)
    one = screw("x", 0.0, 0.0)
    return (product(of_x, of_z), of_x) if convention == "modified" else (product(of_z, of_x), one)


def torques(arm, q, qd, qdd, rotors):
    """Forward and backward in world axes about points; the derivative of each point is that of the link."""
    frames = [([[1.0, 0, 0, 0], [0, 1.0, 0, 0], [0, 0, 1.0, 0], [0, 0, 0, 1.0]], [0.0] * 3, [0.0] * 3, times(-1, arm["gravity"]))]
    links = []
    for at, joint in enumerate(arm["joints"]):
        whole, omega, alpha, linear = frames[joint["parent"]]
        turns = joint["type"] == "revolute"
        row, before = step(joint["theta"] + q[at] * turns, joint["d"] + q[at] * (not turns), joint["a"], joint["alpha"],
                           arm["convention"])
        origin = [line[3] for line in whole[:3]]
        at_axis, after = product(whole, before), product(whole, row)
        axis, end = [line[2] for line in at_axis[:3]], [line[3] for line in after[:3]]
        point = [line[3] for line in at_axis[:3]]
        # a prismatic joint carries the end along; both kinds move all that is behind the axis
        way = plus(end, times(-1, origin))
        if turns:
            arm_of = plus(end, times(-1, point))
            new_omega = plus(omega, times(qd[at], axis))
            new_alpha = plus(alpha, times(qdd[at], axis), cross(omega, times(qd[at], axis)))
            before_axis = plus(point, times(-1, origin))
            linear = plus(linear, cross(alpha, before_axis), cross(omega, cross(omega, before_axis)),
                          cross(new_alpha, arm_of), cross(new_omega, cross(new_omega, arm_of)))
            omega, alpha = new_omega, new_alpha
        else:
            linear = plus(linear, cross(alpha, way), cross(omega, cross(omega, way)), times(qdd[at], axis),
                          times(2 * qd[at], cross(omega, axis)))
        frames.append((after, omega, alpha, linear))
        turn = [line[:3] for line in after[:3]]
        xx, yy, zz, xy, xz, yz = joint["inertia"]
        tensor, c, m = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]], joint["com"], joint["mass"]
        if joint["about"] == "origin":
            square = sum(x * x for x in c)
            tensor = [[tensor[i][k] - m * (square * (i == k) - c[i] * c[k]) for k in range(3)] for i in range(3)]
        tensor = product(product(turn, tensor), [list(column) for column in zip(*turn)])
        lever = by(turn, c)
        force = times(m, plus(linear, cross(alpha, lever), cross(omega, cross(omega, lever))))
        moment = plus(by(tensor, alpha), cross(omega, by(tensor, omega)))
        links.append((joint["parent"], turns, axis, point, plus(end, lever), force, moment))
    result = []
    for at, (_, turns, axis, point, _, _, _) in enumerate(links):
        behind = {at}
        for other in range(at + 1, len(links)):
            if links[other][0] - 1 in behind:
                behind.add(other)
        total = 0.0
        for other in behind:
            _, _, _, _, centre, force, moment = links[other]
            load = plus(moment, cross(plus(centre, times(-1, point)), force)) if turns else force
            total += sum(x * y for x, y in zip(axis, load))
        joint = arm["joints"][at]
        result.append(total + rotors * joint["ratio"] ** 2 * joint["rotor"] * qdd[at])
    return result


def compare(arm, source, real, rotors, seed):
    """The largest difference of the compiled C from the recursion, in parts of the largest torque."""
    library = source.with_name(f"arm_{seed}.so")  # a library that is loaded would be taken again for its name
    subprocess.run(["cc", "-std=c99", "-O1", "-ffp-contract=off", "-shared", "-fPIC", "-o", library, source], check=True)
    function = ctypes.CDLL(str(library)).arm_inverse_dynamics
    count, draw, worst = len(arm["joints"]), random.Random(seed), 0.0
    array = (ctypes.c_float if real == "float" else ctypes.c_double) * count
    for _ in range(20):
        q, qd, qdd = ([draw.uniform(-2, 2) for _ in range(count)] for _ in range(3))
        found = array()
        function(array(*q), array(*qd), array(*qdd), found)
        expected = torques(arm, q, qd, qdd, rotors)
        largest = max(1.0, *map(abs, expected))
        worst = max(worst, *(abs(a - b) / largest for a, b in zip(found, expected)))
    return worst


def mutants(text, function, draw):
    """One change of each kind in a function of a C source: an operator, a sign, an index, a constant."""
    start = text.index(f"_{function}(")
    end = text.index("\n}\n", start)
    body = text[start:end]
    kinds = [(r" \+ ", " - "), (r" - ", " + "), (r"(?<==) (?=\(?[a-z]\w+ [-+*])", " -"), (r"tau\[0\] =", "tau[1] ="),
             (r"(?<= = )-?(\d+\.\d*)", None), (r"qd\[0\];", "qd[1];"), (r"\n    const", "\n#define q1 q2\n    const")]
    for pattern, new in kinds:
        is_code = lambda place: "//" not in body[body.rindex("\n", 0, place.end()):place.start()]
        places = list(filter(is_code, re.finditer(pattern, body)))
        if places:
            place = draw.choice(places)
            changed = new if new is not None else f"{float(place.group()) * 1.000001 + 1e-5:.9e}".replace("e+00", "")
            yield body[place.start():place.end()], text[:start] + body[:place.start()] + changed + body[place.end():] + text[end:]
