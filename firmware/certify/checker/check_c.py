#!/usr/bin/env python3
"""Checks C code of an arm against its Denavit-Hartenberg table, independently of rne.

    python3 check_c.py [--partial] my_arm.c my_arm.trace.json my_arm.yaml

The script shares no code with rne and needs only Python's standard library. It reads the C source as text.
1. The table: robot_table.py, beside this script, reads the robot file. Each number of the table in the trace must be
   that of the robot file, but for the roundings of an expression in doubles (1e-14 of the number, 1e-14 rad).
2. Each constant: the trace gives its expression in the numbers of the table. The script evaluates the expression
   with 60 digits; the literal in the source must be the nearest float (or double) of it.
3. Each function of the trace (inverse_dynamics, bias_torques, gravity_torques): the script evaluates the source modulo a random
   prime at random points, with the expressions of the constants. It computes the torques modulo the prime by its own
   recursive Newton-Euler algorithm, in the axes of frame 0. Both must be equal. The sine and cosine of an angle are a
   random point (s, c) with s^2 + c^2 = 1. If the trace has rotors, each adds G^2 Jm qdd to the torque of its joint.
4. Sine and cosine: their source must be one of two texts whose SHA-256 stands in c_source.py. A test of rne compares
   the functions with high precision at 100,000 angles; this script does not.
5. Other functions, such as friction_torques: their text must be the one whose SHA-256 stands in the trace. The script
   does not compute what they return. A function of which the trace says nothing is an error; with --partial, the
   script names it and goes on.

c_source.py, beside this script, reads the source; it refuses anything else that stands there.

The primes have 127 bits. A wrong term survives one point with a probability below 1e-33; there are 8 points.
Not checked: the header, the compiler and the processor; without a robot file, that the table in the trace is that of the arm.
Exit status: 0 all is right, 1 something is wrong, 2 a file cannot be read, or the robot is not supported: it has
couplings, loops, a list of motors, bodies or a floating base.
"""
import json
import math
import random
import re
import struct
import sys
from decimal import Decimal

sys.dont_write_bytecode = True  # no folder __pycache__ beside this script
import robot_table
from c_source import File, Source, text_of
from robot_table import PI, NotSupported, Wrong, cosine, sine

POINTS = 8
FUNCTIONS = {  # with the arrays that they take; what they do not take is zero
    "inverse_dynamics": ["q", "qd", "qdd"],
    "bias_torques": ["q", "qd"],
    "gravity_torques": ["q"],
}

# --- numbers with 60 digits ---------------------------------------------------------------------------------------

def angle_of(s, c):
    x = Decimal(math.atan2(float(s), float(c)))
    for _ in range(4):  # Newton: the sine of what is left
        x += s * cosine(x) - c * sine(x)
    return x

def as_float(x, kind):
    """The nearest float or double of a decimal."""
    near = float(x)  # Python rounds a Decimal's text correctly
    if kind == "double":
        return near
    bits = struct.unpack("<I", struct.pack("<f", near))[0]
    candidates = [struct.unpack("<f", struct.pack("<I", (bits + k) & 0xFFFFFFFF))[0] for k in (-1, 0, 1) if bits + k >= 0]
    return min((y for y in candidates if y == y), key=lambda y: (abs(Decimal(y) - x), y != near))

# --- the field of a prime -----------------------------------------------------------------------------------------

def is_prime(n):
    if any(n % p == 0 for p in (3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37)):
        return False
    d, twos = n - 1, 0
    while d % 2 == 0:
        d, twos = d // 2, twos + 1
    for _ in range(24):  # Miller and Rabin
        x = pow(random.randrange(2, n - 1), d, n)
        if x in (1, n - 1):
            continue
        for _ in range(twos - 1):
            x = x * x % n
            if x == n - 1:
                break
        else:
            return False
    return True

def random_prime():
    while True:
        n = random.getrandbits(127) | (1 << 126) | 3  # 3 modulo 4: roots are powers
        if is_prime(n):
            return n

class NoRoot(Exception):
    """A number has no square root modulo this prime: another prime is taken."""

class Field:
    def __init__(self, prime):
        self.p, self.points = prime, {}
    def inverse(self, x):
        if x % self.p == 0:
            raise NoRoot
        return pow(x, self.p - 2, self.p)
    def root(self, x):
        y = pow(x, (self.p + 1) // 4, self.p)
        if y * y % self.p != x % self.p:
            raise NoRoot
        return y
    def decimal(self, text):
        sign, digits, exponent = Decimal(text).as_tuple()
        value = int("".join(map(str, digits))) * (-1) ** sign
        return value * (pow(10, exponent, self.p) if exponent >= 0 else self.inverse(pow(10, -exponent, self.p))) % self.p
    def circle(self):
        t = random.randrange(2, self.p)
        scale = self.inverse(1 + t * t)
        return 2 * t * scale % self.p, (1 - t * t) * scale % self.p
    def turn(self, radians):
        """Sine and cosine of a constant angle: the same point, up to right angles and sign, for related angles."""
        x = Decimal(radians)
        quarters = int((x / (PI / 2)).to_integral_value())
        if abs(x - quarters * PI / 2) < Decimal(radians if radians else 1.0).copy_abs() * Decimal(2) ** -49:
            s, c = 0, 1
        else:
            rest = x - quarters * PI / 2
            values = [float(abs(sine(rest))), float(cosine(rest))]
            point = self.points.setdefault(tuple(sorted(values)), self.circle())
            s, c = point if values[0] <= values[1] else point[::-1]
            s = s if rest > 0 else -s
        for _ in range(quarters % 4):
            s, c = c, -s
        return s % self.p, c % self.p

# --- the trace ----------------------------------------------------------------------------------------------------

def evaluate(steps, leaf, add, multiply, negate, inverse, root):
    values = []
    for operator, *operands in steps:
        if operator in ("number", "sin", "cos"):
            values.append(leaf(operator, operands[0]))
            continue
        if any(not 0 <= at < len(values) for at in operands):
            raise Wrong("the trace names a step that does not stand before")
        a = [values[at] for at in operands]
        values.append({"+": add, "*": multiply, "-": negate, "/": inverse, "sqrt": root}[operator](*a))
    return values

def exact_values(steps):
    def leaf(operator, number):
        return Decimal(number) if operator == "number" else (sine if operator == "sin" else cosine)(Decimal(float(number)))
    return evaluate(steps, leaf, lambda a, b: a + b, lambda a, b: a * b, lambda a: -a, lambda a: 1 / a, Decimal.sqrt)

def field_values(steps, field):
    def leaf(operator, number):
        return field.decimal(number) if operator == "number" else field.turn(float(number))[operator == "cos"]
    return evaluate(steps, leaf, lambda a, b: (a + b) % field.p, lambda a, b: a * b % field.p, lambda a: -a % field.p,
                    field.inverse, field.root)

# --- the numbers of the source ---------------------------------------------------------------------------------------

class Machine:
    """Arithmetic of a field. A value is (number, turn); a turn is the (sine, cosine) of the value as an angle."""
    def __init__(self, field, table, constants, literals, kind, arrays):
        self.field, self.p, self.constants, self.literals, self.kind = field, field.p, constants, literals, kind
        n = len(table["joints"])
        self.arguments = {name: [random.randrange(self.p) if name in arrays else 0 for _ in range(n)]
                          for name in ("q", "qd", "qdd")}
        self.turns = [field.circle() for _ in range(n)]
        self.outputs, self.used = {}, set()
    def constant(self, name, text):
        if name not in self.constants:
            raise Wrong(f"the trace does not know the constant {name}")
        self.used.add(name)
        if (text.endswith("f")) != (self.kind == "float") or as_literal(text, self.kind) != self.literals[name]:
            raise Wrong(f"{name} = {text} is not the nearest {self.kind} of its expression, {self.literals[name]!r}")
        return self.constants[name]
    def argument(self, name, index):
        turn = self.turns[index] if name == "q" else None
        return self.arguments[name][index], turn
    def number(self, text):
        if as_literal(text, self.kind) != 0.0:
            raise Wrong(f"the source has a number without a name: {text}")
        return 0, None
    def add(self, a, b):
        turn = None
        if a[1] and b[1]:
            (s, c), (t, d) = a[1], b[1]
            turn = (s * d + c * t) % self.p, (c * d - s * t) % self.p
        return (a[0] + b[0]) % self.p, turn
    def negative(self, a):
        return -a[0] % self.p, a[1] and (-a[1][0] % self.p, a[1][1])
    def multiply(self, a, b):
        return a[0] * b[0] % self.p, None
    def divide(self, a, b):
        return a[0] * self.field.inverse(b[0]) % self.p, None
    def sin_cos(self, angle):
        if not angle[1]:
            raise Wrong("the sine of a value that is no angle")
        return (angle[1][0], None), (angle[1][1], None)
    def output(self, index, value):
        if index in self.outputs:
            raise Wrong(f"output {index} is written twice")
        self.outputs[index] = value[0]

def as_literal(text, kind):
    value = Decimal(text.rstrip("fu"))
    return as_float(value, kind)

# --- recursive Newton-Euler in the axes of frame 0 ------------------------------------------------------------------

def torques(field, table, machine):
    p = field.p
    def dot(a, b):
        return sum(x * y for x, y in zip(a, b)) % p
    def cross(a, b):
        return [(a[1] * b[2] - a[2] * b[1]) % p, (a[2] * b[0] - a[0] * b[2]) % p, (a[0] * b[1] - a[1] * b[0]) % p]
    def add(*vectors):
        return [sum(parts) % p for parts in zip(*vectors)]
    def times(k, v):
        return [k * x % p for x in v]
    def by(matrix, v):
        return [dot(row, v) for row in matrix]
    def product(a, b):
        return [[dot(row, column) for column in zip(*b)] for row in a]
    def about_x(turn):
        s, c = turn
        return [[1, 0, 0], [0, c, -s % p], [0, s, c]]
    def about_y(turn):
        s, c = turn
        return [[c, 0, s], [0, 1, 0], [-s % p, 0, c]]
    def about_z(turn):
        s, c = turn
        return [[c, -s % p, 0], [s, c, 0], [0, 0, 1]]

    # of the base and each link: rotation, origin, omega, alpha, acceleration of the origin less gravity
    zero = [0, 0, 0]
    states = [([[1, 0, 0], [0, 1, 0], [0, 0, 1]], zero, zero, zero, times(-1, map(field.decimal, table["gravity"])))]
    links = []
    for index, joint in enumerate(table["joints"]):
        rotation, origin, omega, alpha, acceleration = states[int(joint["parent"])]
        start = add(origin, by(rotation, [field.decimal(x) for x in joint["xyz"]]))
        roll, pitch, yaw = (field.turn(float(x)) for x in joint["rpy"])
        rotation = product(product(product(rotation, about_z(yaw)), about_y(pitch)), about_x(roll))
        is_revolute = joint["type"] == "revolute"
        theta, twist = field.turn(float(joint["theta"])), field.turn(float(joint["alpha"]))
        slide, a = field.decimal(joint["d"]), field.decimal(joint["a"])
        if is_revolute:
            q = machine.turns[index]
            theta = (theta[0] * q[1] + theta[1] * q[0]) % p, (theta[1] * q[1] - theta[0] * q[0]) % p
        else:
            slide = (slide + machine.arguments["q"][index]) % p
        rate, rate_dot = machine.arguments["qd"][index], machine.arguments["qdd"][index]
        if table["convention"] == "modified":
            rotation_before = product(rotation, about_x(twist))  # the axis of the joint comes after alpha and a
            point = add(start, by(rotation, [a, 0, 0]))
            axis = by(rotation_before, [0, 0, 1])
            step = times(slide, axis)
            after = product(rotation_before, about_z(theta))
        else:
            axis = by(rotation, [0, 0, 1])
            turned = product(rotation, about_z(theta))
            point = start
            step = add(times(slide, axis), by(turned, [a, 0, 0]))
            after = product(turned, about_x(twist))
        # the point moves with the link before; what follows it moves with the joint
        arm = add(point, times(-1, origin))
        acceleration = add(acceleration, cross(alpha, arm), cross(omega, cross(omega, arm)))
        if is_revolute:
            alpha = add(alpha, times(rate_dot, axis), cross(omega, times(rate, axis)))
            omega = add(omega, times(rate, axis))
        else:
            acceleration = add(acceleration, times(rate_dot, axis), times(2, cross(omega, times(rate, axis))))
        acceleration = add(acceleration, cross(alpha, step), cross(omega, cross(omega, step)))
        origin, rotation = add(point, step), after
        states.append((rotation, origin, omega, alpha, acceleration))
        mass = field.decimal(joint["mass"])
        com = [field.decimal(x) for x in joint["com"]]
        xx, yy, zz, xy, xz, yz = (field.decimal(x) for x in joint["inertia"])
        inertia = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
        if joint["inertia_about"] == "origin":  # Steiner
            square = dot(com, com)
            inertia = [[(inertia[i][j] - mass * ((square if i == j else 0) - com[i] * com[j])) % p for j in range(3)]
                       for i in range(3)]
        arm = by(rotation, com)
        of_com = add(acceleration, cross(alpha, arm), cross(omega, cross(omega, arm)))
        inertia = product(product(rotation, inertia), [list(column) for column in zip(*rotation)])
        force = times(mass, of_com)
        moment = add(by(inertia, alpha), cross(omega, by(inertia, omega)))
        moment = add(moment, cross(add(origin, arm), force))  # about the origin of frame 0
        links.append((int(joint["parent"]), is_revolute, axis, point, force, moment))
    result, carried = [], [(zero, zero)] * (len(links) + 1)
    rotors = [joint.get("rotor", ["1", "0"]) for joint in table["joints"]]
    for parent, is_revolute, axis, point, own_force, own_moment in reversed(links):
        force, moment = (add(*pair) for pair in zip(carried.pop(), (own_force, own_moment)))
        about_axis = add(moment, times(-1, cross(point, force)))
        ratio, rotor = (field.decimal(x) for x in rotors.pop())
        resists = ratio * ratio * rotor * machine.arguments["qdd"][len(rotors)]
        result.append((dot(axis, about_axis if is_revolute else force) + resists) % p)
        carried[parent] = tuple(add(*pair) for pair in zip(carried[parent], (force, moment)))
    return result[::-1]

# --- all of it ----------------------------------------------------------------------------------------------------

def check(file, traced, trace):
    """Checks a function of the trace; says what was checked."""
    table, kind, prefix = trace["table"], trace["real"], trace["prefix"]
    function, steps, constants_of = traced["function"], traced["steps"], traced["constants"]
    if function not in file.functions:
        raise Wrong(f"the source must define {function} once")
    source = Source(function, *file.functions[function], prefix, kind)
    joints = len(table["joints"])
    arrays = FUNCTIONS.get(function.removeprefix(prefix + "_"))
    if arrays is None:
        raise Wrong(f"this script does not know the function {function}")
    if source.parameters != [(array, joints, True) for array in arrays] + [("tau", joints, False)]:
        raise Wrong(f"{function} must take {', '.join(arrays)} and write tau, with one element per joint")
    exact = exact_values(steps)
    literals = {}
    for name, of in constants_of.items():
        value = exact[of] if isinstance(of, int) else angle_of(exact[of["sin"]], exact[of["cos"]])
        literals[name] = as_float(value, kind)
    points = 0
    while points < POINTS:
        field = Field(random_prime())
        try:
            values = field_values(steps, field)
            constants = {}
            for name, of in constants_of.items():
                is_number = isinstance(of, int)
                constants[name] = (values[of], None) if is_number else (random.randrange(field.p),
                                                                       (values[of["sin"]], values[of["cos"]]))
            machine = Machine(field, table, constants, literals, kind, arrays)
            source.run(machine)
        except NoRoot:
            continue
        expected = torques(field, table, machine)
        if sorted(machine.outputs) != list(range(joints)):
            raise Wrong(f"{function} does not write every torque")
        for index, value in enumerate(expected):
            if machine.outputs[index] != value:
                raise Wrong(f"{function}: torque {index + 1} is another function than recursive Newton-Euler")
        points += 1
    return f"{function}: {joints} torques are those of the table at {POINTS} points; {len(literals)} constants are right"

def missing(trace):
    """What a trace lacks, in words; None if it has the form of a trace."""
    def lacks(mapping, what, **kinds):
        if not isinstance(mapping, dict):
            return f"{what} is no mapping"
        for key, kind in kinds.items():
            if not isinstance(mapping.get(key), kind):
                return f"{what} has no {kind.__name__} '{key}'"
    if found := lacks(trace, "the file", prefix=str, real=str, functions=list, texts=dict, table=dict):
        return found
    if found := lacks(trace["table"], "the table", convention=str, gravity=list, joints=list):
        return found
    row = dict.fromkeys(("type", "theta", "d", "a", "alpha", "mass", "inertia_about"), str)
    found = [lacks(joint, "a joint", com=list, inertia=list, **row) for joint in trace["table"]["joints"]]
    found += [lacks(of, "a function", function=str, steps=list, constants=dict) for of in trace["functions"]]
    return next(filter(None, found), None)

def is_of_another_robot(text, trace):
    """In words, that functions of the trace have another prefix in the source; None if one of them is there."""
    for traced in trace["functions"]:
        function = traced["function"].removeprefix(trace["prefix"] + "_")
        found = re.findall(rf"\b(\w+_){re.escape(function)}\(", text)
        if trace["prefix"] + "_" in found:
            return None
        if found:
            return f"the trace is of {trace['prefix']}_, the source has {found[0]}: name the files of one robot and prefix"
    return None

def main():
    files = [name for name in sys.argv[1:] if name != "--partial"]
    if len(files) not in (2, 3):
        print(__doc__)
        return 2
    try:
        texts = []
        for name in files:
            with open(name, encoding="utf-8") as file:
                texts.append(file.read())
        text, trace, robot = texts[0], json.loads(texts[1]), texts[2] if len(texts) > 2 else None
    except (OSError, ValueError) as error:
        print(f"error: {error}")
        return 2
    if what := missing(trace):
        print(f"error: {files[1]} is no trace that rne certify --evidence writes: {what}")
        return 2
    try:
        if trace.get("not_supported"):
            raise NotSupported(f"the robot has {', '.join(trace['not_supported'])}, which this script does not compute")
        robot_table.complete(trace["table"])
        if robot is not None:
            count = robot_table.compare(trace["table"], robot)
            print(f"{files[2]}: {count} numbers of the table in the trace are those of the robot file")
        if what := is_of_another_robot(text, trace):
            raise Wrong(what)
        file = File(text, trace["prefix"], trace["real"])
        for traced in trace["functions"]:
            print(check(file, traced, trace))
        if not trace["functions"]:
            raise Wrong("the trace names no function")
        checked, same = [traced["function"] for traced in trace["functions"]], trace["texts"]
        for name, text in same.items():
            if name not in file.functions:
                raise Wrong(f"the source must define {name} once")
            if text_of(*file.functions[name]) != text:
                raise Wrong(f"{name} is not the text that rne wrote; this script does not compute what it returns")
        if same:
            print(f"compared by their texts alone, not computed: {', '.join(same)}")
        others = [name for name in file.functions if name not in checked and name not in same]
        if others and "--partial" not in sys.argv:
            raise Wrong(f"the trace does not name these functions of the source: {', '.join(others)}; write a trace of "
                        "all of them by rne certify --evidence, or give --partial to check the others alone")
        if others:
            print(f"not checked, because the trace does not name them: {', '.join(others)}")
    except NotSupported as error:
        print(f"not supported: {error}")
        return 2
    except Wrong as error:
        print(f"wrong: {error}")
        return 1
    if robot is None:
        print("the table in the trace is not compared with a robot file: name the file as the third argument")
    return 0

if __name__ == "__main__":
    sys.exit(main())
