"""Hostile texts in a robot file, and what becomes of them in pages, pictures, tables, JSON, LaTeX, C and Rust.

Each text is a case for each key: title, source, notes, name, and the name of a joint. C is compiled where there is gcc,
and the documentation of Rust is read by rustdoc where it is there.
"""

import functools
import html.parser
import json
import os
import re
import shutil
import subprocess
from xml.etree import ElementTree

import harness
from robots import TEXTS, label, robot

CASES = harness.Cases()
KEYS = ("title", "joint", "source", "notes", "name")
STATE = ["--q", "0,0", "--qd", "0,0", "--qdd", "0,0"]
GCC, RUSTDOC = shutil.which("gcc"), shutil.which("rustdoc")
# Texts that no file of C or Rust is made of: they are about file names, shells and YAML.
TEXTS_OF_LANGUAGES = 64
STANDARDS = ("c99", "gnu17")
STRICT = ["-Wall", "-Wextra", "-Werror", "-trigraphs", "-Wno-unused", "-DRNE_TEST", "-fsyntax-only"]
ACTIVE = {"script", "foreignObject", "image", "use", "a"}


class Page(html.parser.HTMLParser):
    """The tags of a page, and its attributes that run something."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.handlers = {}, []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.tags[tag] = self.tags.get(tag, 0) + 1
        for name, value in attributes:
            if name.startswith("on") or (value or "").lower().startswith("javascript:"):
                self.handlers.append((tag, name))


@functools.cache
def harmless(folder):
    """The report of an arm with harmless texts."""
    (folder / "harmless.yaml").write_text(robot())
    page = folder / "harmless.html"
    subprocess.run([harness.RNE, "report", folder / "harmless.yaml", "-o", page], check=True, capture_output=True)
    harmless_page = Page(page.read_text())
    page.unlink()
    (folder / "harmless.yaml").unlink()
    return harmless_page


def xml(trial, what, text):
    """The root of an XML text that must be well-formed."""
    try:
        return ElementTree.fromstring(text.encode("utf-8", "surrogatepass"))
    except ElementTree.ParseError as error:
        trial.fault(f"{what} does not parse: {error}")
        return None


def report(trial, path):
    expected = harmless(trial.folder)
    if trial.rne("report", path, "-o", "page.html", writes=["page.html"]).status == 0:
        page = Page((trial.folder / "page.html").read_text())
        if page.tags != expected.tags or page.handlers != expected.handlers:
            trial.fault(f"the page of rne report has other tags: {set(page.tags.items()) ^ set(expected.tags.items())}")


def plot(trial, path):
    answer = trial.rne("plot", path)
    root = xml(trial, "the picture of rne plot", answer.out) if answer.status == 0 else None
    for element in [] if root is None else root.iter():
        if element.tag.split("}")[-1] in ACTIVE or any(name.startswith("on") for name in element.attrib):
            trial.fault(f"the picture of rne plot has {element.tag} {element.attrib}")


def urdf(trial, path):
    answer = trial.rne("export", path, "--urdf")
    if answer.status == 0 and xml(trial, "the URDF", answer.out) is not None:
        trial.write("back.urdf", answer.out.encode("utf-8", "surrogatepass"))
        trial.rne("import", "back.urdf")


def tables(trial, path):
    answer = trial.rne("eval", path, *STATE, "--trace", "--csv")
    if answer.status == 0 and any(line[:1] in "=+@" for line in answer.out.splitlines() if line):
        trial.fault("a line of the worksheet begins with a formula")
    for command in (["show", path, "--json"], ["eval", path, *STATE, "--json"]):
        answer = trial.rne(*command)
        if answer.status == 0:
            try:
                json.loads(answer.out)
            except ValueError as error:
                trial.fault(f"rne {command[0]} --json is not JSON: {error}")
    answer = trial.rne("show", path, "--latex")
    for command in ("\\input{/etc", "\\write18", "\\immediate"):
        if answer.status == 0 and command in answer.out:
            trial.fault(f"the LaTeX has the command {command}")
    trial.rne("show", path, "--ascii")
    trial.rne("convert", path, "--convention", "modified")
    trial.rne("diagnose", path, *STATE, "--tau", "1,1")


def c_code(trial, path):
    for flags in ([], ["--ascii"]):
        command = ["emit", path, "--lang", "c", "--real", "double", "--tests", *flags, "-o", "code.c"]
        if trial.rne(*command, writes=["code.c", "code.h"]).status != 0:
            continue
        for standard in STANDARDS:
            compiled = subprocess.run(
                [GCC, f"-std={standard}", *STRICT, "code.c"],
                check=False,
                cwd=trial.folder,
                capture_output=True,
                text=True,
            )
            if compiled.returncode:
                trial.fault(f"the C {flags} is not {standard}: {compiled.stderr[:300]}")
        if flags and not (trial.folder / "code.c").read_bytes().isascii():
            trial.fault("the C of --ascii is not ASCII")
        for name in ("code.c", "code.h"):
            (trial.folder / name).unlink()


def rust_code(trial, path):
    """No text of a robot file becomes a test of the documentation, which would be run."""
    if trial.rne("emit", path, "--tests", "-o", "code.rs", writes=["code.rs"]).status != 0:
        return
    tested = subprocess.run(
        [RUSTDOC, "--edition", "2021", "--test", "code.rs"],
        check=False,
        cwd=trial.folder,
        capture_output=True,
        text=True,
    )
    ran = re.search(r"(\d+) passed; (\d+) failed; (\d+) ignored", tested.stdout)
    # the head of the file has one example of its own, which is not run
    if not ran or ran.groups() != ("0", "0", "1") or os.path.exists(trial.folder / "PWNED"):
        trial.fault(f"the Rust has tests in its documentation: {tested.stdout[:300]}")


def is_refused(key, text):
    return key == "name" and not re.fullmatch(r"[a-z][a-z0-9_]*", text)


def text_of(key, index, text):
    def body(trial):
        path = trial.write("robot.yaml", robot(**{key: text}).encode("utf-8", "surrogatepass"))
        expected = "refused" if is_refused(key, text) else "any"
        if trial.rne("check", path, expected=expected).status != 0:
            return
        report(trial, path)
        plot(trial, path)
        urdf(trial, path)
        tables(trial, path)
        if GCC and index < TEXTS_OF_LANGUAGES:
            c_code(trial, path)
        if RUSTDOC and index < TEXTS_OF_LANGUAGES and key in ("title", "joint", "notes"):
            rust_code(trial, path)

    CASES.add(f"{key} {label(text)}", body)


for index, text in enumerate(TEXTS):
    for key in KEYS:
        text_of(key, index, text)

if __name__ == "__main__":
    harness.main(CASES)
