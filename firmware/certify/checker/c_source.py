"""Reads the C source of an arm as text: its functions, and their statements. check_c.py uses it."""
import hashlib
import re

from robot_table import Wrong

KERNELS = {  # of the sine, by the type, with the comments removed and the prefix replaced by PREFIX
    "float": "b5f09db3d6fb012c9a9a6fc7491c007b22054f4072e50543c1dbdd0155852b5b",
    "double": "832cb059c93293dbe679defff4e5a128e7221d57220703aa1a890c25590203ef",
}

PREPROCESSOR = re.compile(
    r'# ?(include (<float\.h>|<stdint\.h>|"[^"]*")|ifdef RNE_SIN_COS|else|endif|if .*|error ".*")')

TOKEN = re.compile(r"\s*([A-Za-z_]\w*|(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?[fu]?|[-+*/()\[\]{},;=&])")

def tokens_of(text):
    tokens, at = [], 0
    text = text.rstrip()
    while at < len(text):
        match = TOKEN.match(text, at)
        if not match:
            raise Wrong(f"the source has an unknown symbol: {text[at:at + 20]!r}")
        tokens.append(match.group(1))
        at = match.end()
    return tokens

class File:
    """The functions of a C source by their names: (parameters, body). Nothing else may stand in it but what rne adds."""
    def __init__(self, text, prefix, kind):
        def line(at):
            return f"line {text.count(chr(10), 0, at) + 1} of the source"
        if found := re.search(r"(\\|\?\?/)[ \t]*$", text, flags=re.M):  # it makes one line of two
            raise Wrong(f"{line(found.start())} ends with a backslash")
        # a comment leaves its line ends, so that the lines keep their numbers
        text = re.sub(r"//[^\n]*|/\*.*?\*/", lambda comment: "\n" * comment.group().count("\n"), text, flags=re.S)
        text, *tests = text.split("#ifdef RNE_TEST\n")
        if len(tests) > 1 or tests and re.findall(r"#\s*(?!include)\w+", tests[0]) != ["#endif"]:
            raise Wrong("the tests must be the end of the source")
        if tests and not tests[0].rstrip().endswith("#endif"):
            raise Wrong("the source has code after the tests")
        for found in re.finditer(r"^[ \t]*#.*", text, flags=re.M):
            directive = " ".join(found.group().split())
            if not PREPROCESSOR.fullmatch(directive):
                raise Wrong(f"{line(found.start())} is a line of the preprocessor that rne does not write: {directive}")
        text = re.sub(r'#include (<float.h>|<stdint.h>|"[^"\n]*")\n', "\n", text)
        first = re.search(rf"^((void|{kind}) {prefix}_|static {kind} {prefix}_by_sign)", text, flags=re.M)
        kernel, rest = (text[:first.start()], text[first.start():]) if first else (text, "")
        kernel = " ".join(kernel.replace(prefix, "PREFIX").split())
        if kernel and hashlib.sha256(kernel.encode()).hexdigest() != KERNELS[kind]:
            raise Wrong(f"the sine and cosine, above {line(len(text) - len(rest))}, are not those of rne")
        if "#" in rest:
            at = text.index("#", len(text) - len(rest))
            raise Wrong(f"{line(at)} is a line of the preprocessor among the functions: {text[at:].splitlines()[0]}")
        function = re.compile(rf"\s*(?:void|{kind}|static {kind}) ({prefix}_\w+)\(([^()]*)\)\s*\{{(.*?)\n\}}\n", flags=re.S)
        union = re.compile(rf"\s*typedef union \{{\s*{kind} number;\s*uint\d\d_t bits;\s*\}} {prefix}_number;\n")
        self.functions, at = {}, 0
        while rest[at:].strip():
            found = union.match(rest, at)
            if not found:
                found = function.match(rest, at)
                if not found:
                    at += len(rest[at:]) - len(rest[at:].lstrip())
                    place = line(len(text) - len(rest) + at)
                    raise Wrong(f"{place} is code outside the functions: {rest[at:at + 40]!r}")
                if found.group(1) in self.functions:
                    raise Wrong(f"the source must define {found.group(1)} once")
                self.functions[found.group(1)] = found.group(2, 3)
            at = found.end()

def text_of(parameters, body):
    """The SHA-256 of a function's text from its parameters on, without comments and with one blank between words."""
    return hashlib.sha256(" ".join(f"{parameters}) {{ {body}".split()).encode()).hexdigest()

class Source:
    """A function of straight-line code."""
    def __init__(self, name, parameters, body, prefix, kind):
        self.kind, self.name, self.prefix = kind, name, prefix
        self.tokens, self.at = tokens_of(f"{parameters}) {{{body}"), 0
        self.parameters = self.header()
    def next(self, *expected):
        token = self.tokens[self.at] if self.at < len(self.tokens) else "the end"
        if expected and token not in expected:
            raise Wrong(f"the source has {token!r} where {' or '.join(expected)} is expected")
        self.at += 1
        return token
    def peek(self):
        return self.tokens[self.at] if self.at < len(self.tokens) else ""
    def header(self):
        parameters = []
        while True:
            is_const = self.peek() == "const"
            if is_const:
                self.next()
            self.next(self.kind)
            name = self.next()
            self.next("[")
            length = int(self.next())
            self.next("]")
            parameters.append((name, length, is_const))
            if self.next(",", ")") == ")":
                self.next("{")
                return parameters
    def run(self, machine):
        """Executes the statements. `machine` gives numbers their meaning."""
        start, names = self.at, {}
        self.machine, self.names = machine, names
        while self.peek():
            token = self.next()
            if token == "(":  # (void)qd;
                for expected in ("void", ")"):
                    self.next(expected)
                self.next()
                self.next(";")
            elif token in ("const", self.kind):
                is_const = token == "const"
                if is_const:
                    self.next(self.kind)
                name = self.next()
                if name in names or name in dict((p[0], 1) for p in self.parameters):
                    raise Wrong(f"{name} is declared twice")
                if is_const:
                    self.next("=")
                    literal = self.literal()
                    names[name] = machine.constant(name, literal) if literal is not None else self.sum()
                else:
                    names[name] = None
                self.next(";")
            elif token == f"{self.prefix}_sin_cos":
                self.next("(")
                angle = self.sum()
                turn = machine.sin_cos(angle)
                for value in turn:
                    self.next(",")
                    self.next("&")
                    name = self.next()
                    if name not in names or (names[name] is not None and name != "unused"):
                        raise Wrong(f"{name} is written where it may not be")
                    names[name] = value
                self.next(")")
                self.next(";")
            elif token == self.parameters[-1][0]:
                self.next("[")
                index = int(self.next())
                self.next("]")
                self.next("=")
                machine.output(index, self.sum())
                self.next(";")
            else:
                raise Wrong(f"the source has an unknown statement: {token}")
        self.at = start
    def literal(self):
        """A constant alone on the right side: its text, and whether it is negative."""
        end = self.at + (self.peek() == "-")
        if self.tokens[end + 1:end + 2] == [";"] and self.tokens[end][0].isdigit():
            text = "".join(self.tokens[self.at:end + 1])
            self.at = end + 1
            return text
        return None
    def sum(self):
        value = self.product()
        while self.peek() in ("+", "-"):
            operator, other = self.next(), self.product()
            value = self.machine.add(value, other if operator == "+" else self.machine.negative(other))
        return value
    def product(self):
        value = self.atom()
        while self.peek() in ("*", "/"):
            operator, other = self.next(), self.atom()
            value = (self.machine.multiply if operator == "*" else self.machine.divide)(value, other)
        return value
    def atom(self):
        token = self.next()
        if token == "-":
            return self.machine.negative(self.atom())
        if token == "(":
            value = self.sum()
            self.next(")")
            return value
        if self.peek() == "[":
            self.next()
            index = int(self.next())
            self.next("]")
            lengths = {name: length for name, length, is_const in self.parameters if is_const}
            if index >= lengths.get(token, 0):
                raise Wrong(f"{token}[{index}] does not exist")
            return self.machine.argument(token, index)
        if token[0].isdigit():
            return self.machine.number(token)
        if self.names.get(token) is None:
            raise Wrong(f"{token} is used before it has a value")
        return self.names[token]
