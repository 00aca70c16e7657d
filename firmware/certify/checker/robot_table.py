#!/usr/bin/env python3
"""Reads the Denavit-Hartenberg table of a robot file, independently of rne.

    python3 robot_table.py my_arm.yaml

The command prints the table as JSON, with 17 digits. check_c.py imports this script to compare the table of a trace
with the robot file. The script shares no code with rne and needs only Python's standard library.

It reads the part of YAML that robot files use: mappings and lists, in lines or in braces, texts and comments. It
refuses anchors, tags and everything else that it does not know. Numbers are decimals and expressions with parameters,
+ - * / ^, parentheses, pi, sqrt, sin, cos, tan, deg, mm and g. They are computed with 60 digits. Base, tool, frames,
limits and friction change no torque of the links, so the script does not read them. A tree has for each joint its
parent, and the place where its row begins in the link frame of the parent.
"""
import decimal
import json
import re
import sys
from decimal import Decimal

decimal.getcontext().prec = 60

class Wrong(Exception):
    """Something in a file is wrong, or this script does not know it."""

class NotSupported(Exception):
    """The robot has something that these scripts do not compute."""

# --- numbers with 60 digits ---------------------------------------------------------------------------------------

def arctan_of_inverse(n):
    total, power, k = Decimal(0), Decimal(1) / n, 0
    while abs(power) > Decimal(10) ** -70:
        total += power / (2 * k + 1) * (-1) ** k
        power, k = power / (n * n), k + 1
    return total

PI = 4 * (4 * arctan_of_inverse(5) - arctan_of_inverse(239))  # J. Machin

def sine(x):
    x = x % (2 * PI)
    total, term, k = Decimal(0), x, 1
    while abs(term) > Decimal(10) ** -70:
        total += term
        term, k = -term * x * x / ((k + 1) * (k + 2)), k + 2
    return total

def cosine(x):
    return sine(x + PI / 2)

FUNCTIONS = {
    "sqrt": Decimal.sqrt, "sin": sine, "cos": cosine, "tan": lambda x: sine(x) / cosine(x),
    "deg": lambda x: x * PI / 180, "mm": lambda x: x / 1000, "g": lambda x: x / 1000,
}

class Expression:
    """An expression of a robot file; a power binds tighter than a sign and groups from the right."""
    TOKEN = re.compile(r"\s*((?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|[A-Za-z_]\w*|[-+*/^()])")
    def __init__(self, text, names):
        self.text, self.names, self.tokens, at = text, names, [], 0
        text = text.strip()
        while at < len(text):
            match = self.TOKEN.match(text, at)
            if not match:
                raise Wrong(f"no number: {self.text}")
            self.tokens.append(match.group(1))
            at = match.end()
    def value(self):
        try:
            value = self.sum()
        except (decimal.DecimalException, IndexError) as error:
            raise Wrong(f"no number: {self.text}") from error
        if self.tokens:
            raise Wrong(f"no number: {self.text}")
        return value
    def takes(self, *tokens):
        return self.tokens.pop(0) if self.tokens and self.tokens[0] in tokens else None
    def sum(self):
        value = self.product()
        while operator := self.takes("+", "-"):
            value = value + self.product() if operator == "+" else value - self.product()
        return value
    def product(self):
        value = self.signed()
        while operator := self.takes("*", "/"):
            value = value * self.signed() if operator == "*" else value / self.signed()
        return value
    def signed(self):
        if self.takes("-"):
            return -self.signed()
        base = self.atom()
        return base ** self.signed() if self.takes("^") else base
    def atom(self):
        token = self.tokens.pop(0)
        if token == "(":
            return self.closed()
        if token[0].isdigit() or token[0] == ".":
            if re.match(r"0\d", token):
                raise Wrong(f"readers of YAML differ about {token}")
            return Decimal(token)
        if token in FUNCTIONS and self.takes("("):
            return FUNCTIONS[token](self.closed())
        if token == "pi":
            return PI
        if token not in self.names:
            raise Wrong(f"{token} is no parameter: {self.text}")
        return self.names[token]
    def closed(self):
        value = self.sum()
        if not self.takes(")"):
            raise Wrong(f"a parenthesis is open: {self.text}")
        return value

# --- the part of YAML that robot files use ------------------------------------------------------------------------

KEY = re.compile(r"([A-Za-z_]\w*)\s*:(?:\s+(.*))?$")

def without_comment(line):
    quote = None
    for at, character in enumerate(line):
        before = line[at - 1] if at else " "
        if quote:
            quote = None if character == quote else quote
        elif character in "'\"" and before in " [{,:":
            quote = character
        elif character == "#" and before in " \t":
            return line[:at].rstrip()
    return line.rstrip()

def indent_of(line):
    return len(line) - len(line.lstrip(" "))

class Document:
    def __init__(self, text):
        self.lines, self.at = text.lstrip("\ufeff").splitlines(), 0
        if self.peek() is not None and self.peek().rstrip() == "---":
            self.at += 1
    def peek(self):
        """The next line with contents, without its comment."""
        while self.at < len(self.lines):
            line = without_comment(self.lines[self.at])
            if line.strip():
                if "\t" in line[:len(line) - len(line.lstrip())]:
                    raise Wrong(f"line {self.at + 1} is indented by a tab")
                return line
            self.at += 1
        return None
    def wrong(self, why):
        return Wrong(f"line {self.at + 1} of the robot file: {why}")
    def block(self, indent):
        """A mapping or a list whose lines begin at this column."""
        return self.list(indent) if self.peek().lstrip().startswith("- ") else self.mapping(indent)
    def mapping(self, indent):
        found = {}
        while (line := self.peek()) is not None and indent_of(line) == indent:
            match = KEY.match(line.strip())
            if not match:
                raise self.wrong("this script reads no such line")
            key, rest = match.group(1), match.group(2) or ""
            if key in found:
                raise self.wrong(f"the key {key} is there twice")
            self.at += 1
            found[key] = self.value(rest.strip(), indent)
        if line is not None and indent_of(line) > indent:
            raise self.wrong("the indentation is wrong")
        return found
    def list(self, indent):
        found = []
        while (line := self.peek()) is not None and indent_of(line) == indent and line.strip().startswith("- "):
            rest = line.strip()[2:]
            column = indent + 2 + indent_of(rest)
            if KEY.match(rest.strip()):
                self.lines[self.at] = " " * column + rest.strip()
                found.append(self.mapping(column))
            else:
                self.at += 1
                found.append(self.value(rest.strip(), indent))
        return found
    def value(self, text, indent):
        if not text:
            line = self.peek()
            is_list = line is not None and line.strip().startswith("- ")
            if line is None or indent_of(line) < indent or (indent_of(line) == indent and not is_list):
                raise self.wrong("a value is missing")
            if is_list or KEY.match(line.strip()):
                return self.block(indent_of(line))
            text, self.at = line.strip(), self.at + 1
        if text[0] in "|>":  # a text in lines: nothing that a torque depends on
            while self.at < len(self.lines):
                line = self.lines[self.at]
                if line.strip() and indent_of(line) <= indent:
                    break
                self.at += 1
            return ""
        if text[0] in "{['\"":
            flow = Flow(text, self)
            value = flow.value()
            if flow.rest():
                raise self.wrong(f"this script does not read {flow.rest()!r} behind a value")
            return value
        if text[0] in "&*!@`%?":
            raise self.wrong(f"this script does not read {text[0]}")
        while (line := self.peek()) is not None and indent_of(line) > indent:
            text += " " + line.strip()
            self.at += 1
        return text

class Flow:
    """A value in braces, brackets or quotes, which may go on in the next lines."""
    def __init__(self, text, document):
        self.text, self.document = text, document
    def rest(self):
        self.text = self.text.lstrip()
        return self.text
    def peek(self):
        while not self.rest():
            line = self.document.peek()
            if line is None:
                raise self.document.wrong("a bracket or a quote is open")
            self.text = line
            self.document.at += 1
        return self.text[0]
    def next(self, *expected):
        character = self.peek()
        if expected and character not in expected:
            raise self.document.wrong(f"{' or '.join(expected)} is expected before {self.text!r}")
        self.text = self.text[1:]
        return character
    def value(self):
        first = self.peek()
        if first in "'\"":
            return self.quoted(self.next())
        if first == "[":
            return self.items("]", self.value)
        if first == "{":
            pairs = self.items("}", self.pair)
            if len(dict(pairs)) < len(pairs):
                raise self.document.wrong("a key is there twice")
            return dict(pairs)
        if first in "&*!@`%?|>":
            raise self.document.wrong(f"this script does not read {first}")
        match = re.match(r"[^,\[\]{}:]+", self.text)
        if not match:
            raise self.document.wrong(f"a value is expected before {self.text!r}")
        self.text = self.text[match.end():]
        return match.group(0).strip()
    def pair(self):
        key = self.value()
        self.next(":")
        return key, self.value()
    def items(self, end, item):
        found = []
        self.next()
        while self.peek() != end:
            found.append(item())
            if self.peek() != end:
                self.next(",")
        self.next()
        return found
    def quoted(self, quote):
        parts = []
        while quote not in self.text:
            parts.append(self.text)
            self.text = ""
            self.peek()
        last, self.text = self.text.split(quote, 1)
        return " ".join(parts + [last])

# --- the table ----------------------------------------------------------------------------------------------------

ELEMENTS = ["xx", "yy", "zz", "xy", "xz", "yz"]

def only(mapping, keys, what):
    if not isinstance(mapping, dict):
        raise Wrong(f"{what} is no mapping")
    if unknown := set(mapping) - set(keys.split()):
        raise Wrong(f"{what} has a key that this script does not know: {', '.join(sorted(unknown))}")
    return mapping

def complete(table):
    """Adds to the table of a serial arm what only a tree writes: each row begins where the row before it ends."""
    for index, joint in enumerate(table["joints"]):
        given = [key for key in ("parent", "xyz", "rpy") if key in joint]
        if len(joint.get("rotor", "GJ")) != 2:
            raise Wrong(f"the rotor of joint {index + 1} is not a ratio and an inertia")
        if len(given) not in (0, 3) or joint.get("parent", "0") not in map(str, range(index + 1)):
            raise Wrong(f"joint {index + 1} begins nowhere in the trace")
        if not given:
            joint.update(parent=str(index), xyz=["0.0"] * 3, rpy=["0.0"] * 3)

def table_of(text):
    """The table of the text of a robot file, with numbers of 60 digits."""
    document = Document(text)
    robot = document.block(0) if document.peek() else {}
    if document.peek() is not None:
        raise document.wrong("this script reads no such line")
    unsupported = [key for key in ("couplings", "loops", "motors", "bodies", "floating_base") if key in robot]
    if unsupported:
        raise NotSupported(f"the robot file has the key {', '.join(unsupported)}, which this script does not compute")
    only(robot, "format name title source notes parameters convention gravity base tool frames tips joints", "the file")
    is_tree, is_modified = robot.get("format") == "2", robot.get("convention") == "modified"
    if robot.get("format") not in ("1", "2") or robot.get("convention") not in ("standard", "modified"):
        raise Wrong("the robot file needs format: 1 or format: 2, and a convention")
    names = {}
    for name, formula in robot.get("parameters", {}).items():
        names[name] = Expression(formula, names).value()
    def number(formula):
        return Expression(formula, names).value()
    def vector(formulas):
        if len(formulas) != 3:
            raise Wrong(f"three numbers are expected: {formulas}")
        return [number(formula) for formula in formulas]
    joints, names_of_links = [], ["base"]  # a joint may have the name `base`, too: without a parent, the place counts
    for index, joint in enumerate(robot["joints"]):
        what = f"joint {index + 1}"
        only(joint, "name type dh link limits motor" + " parent at" * is_tree, what)
        dh = only(joint["dh"], "theta d a alpha" + " gamma b" * (is_tree and is_modified), f"dh of {what}")
        parents = [at for at, name in enumerate(names_of_links) if name == joint.get("parent")]
        if len(parents) != 1 and "parent" in joint:
            raise Wrong(f"the parent of {what} must be the name of one joint above it")
        if "at" in joint and ("gamma" in dh or "b" in dh):
            raise Wrong(f"{what} has both `at` and `gamma` or `b`")
        place = only(joint.get("at", {}), "xyz rpy", f"at of {what}")
        link = only(joint.get("link", {}), "mass com first_moment inertia inertia_about physical", f"link of {what}")
        tensor = only(link.get("inertia", {}), " ".join(ELEMENTS), f"inertia of {what}")
        motor = only(joint.get("motor", {}), "inertia gear_ratio viscous coulomb coulomb_width coulomb_displacement",
                     f"motor of {what}")
        mass = number(link.get("mass", "0"))
        com = vector(link.get("com", ["0"] * 3))
        if "first_moment" in link:
            if mass == 0 or "com" in link:
                raise Wrong(f"the first moment of {what} needs a mass and no com")
            com = [x / mass for x in vector(link["first_moment"])]
        if joint["type"] not in ("revolute", "prismatic") or link.get("inertia_about", "com") not in ("com", "origin"):
            raise Wrong(f"{what} has an unknown type or inertia_about")
        joints.append({
            "parent": str(parents[0] if parents else index),
            "xyz": vector(place.get("xyz", ["0", "0", dh.get("b", "0")])),
            "rpy": vector(place.get("rpy", ["0", "0", dh.get("gamma", "0")])), "type": joint["type"], **{key: number(dh[key]) for key in ("theta", "d", "a", "alpha")}, "mass": mass,
            "com": com, "inertia": [number(tensor.get(element, "0")) for element in ELEMENTS],
            "inertia_about": link.get("inertia_about", "com"),
            "rotor": [number(motor.get("gear_ratio", "1")), number(motor.get("inertia", "0"))],
        })
        names_of_links.append(joint.get("name", f"joint{index + 1}"))
    return {"convention": robot["convention"], "gravity": vector(robot["gravity"]), "joints": joints}

def is_near(found, expected, is_angle):
    """Whether a double is a number of 60 digits but for the roundings of an expression in doubles."""
    difference = Decimal(found) - expected
    if is_angle:  # a right angle may be written as another one
        difference -= (difference / (2 * PI)).to_integral_value() * 2 * PI
    return abs(difference) <= max(abs(expected), Decimal(1) if is_angle else abs(Decimal(found))) * Decimal("1e-14")

def compare(found, text):
    """Compares the complete table of a trace with the text of a robot file."""
    try:
        expected = table_of(text)
    except (KeyError, TypeError, AttributeError) as error:
        raise Wrong(f"the robot file is incomplete: {error}") from error
    if len(found["joints"]) != len(expected["joints"]):
        raise Wrong(f"the trace has {len(found['joints'])} joints, the robot file {len(expected['joints'])}")
    pairs = [("the robot", found, expected)]
    pairs += [(f"joint {i + 1}", *pair) for i, pair in enumerate(zip(found["joints"], expected["joints"]))]
    count = 0
    for what, trace, table in pairs:
        for key, value in table.items():
            if key == "joints":
                continue
            if key == "rotor" and key not in trace:
                continue  # the code is without rotors
            if isinstance(value, str):
                if trace[key] != value:
                    raise Wrong(f"{key} of {what} is {trace[key]} in the trace, {value} in the robot file")
                continue
            listed = (trace[key], value) if isinstance(value, list) else ([trace[key]], [value])
            if len(listed[0]) != len(listed[1]):
                raise Wrong(f"{key} of {what} has another length in the trace")
            for a, b in zip(*listed):
                count += 1
                if not is_near(a, b, key in ("theta", "alpha", "rpy")):
                    raise Wrong(f"{key} of {what} is {a} in the trace, {float(b)!r} in the robot file")
    return count

def main():
    if len(sys.argv) != 2:
        print(__doc__)
        return 2
    try:
        with open(sys.argv[1], encoding="utf-8") as file:
            table = table_of(file.read())
    except (OSError, ValueError) as error:
        print(f"error: {error}")
        return 2
    except NotSupported as error:
        print(f"not supported: {error}")
        return 2
    except (Wrong, KeyError, TypeError, AttributeError) as error:
        print(f"wrong: {error}")
        return 1
    print(json.dumps(table, indent=2, default=float))
    return 0

if __name__ == "__main__":
    sys.exit(main())
