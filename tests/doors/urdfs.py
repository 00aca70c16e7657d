"""URDF: XML that is a bomb or reads other files, trees that are none, misspelt words, numbers, names and options."""

import functools
import html
import random
import subprocess

import harness
from robots import TEXTS, label

CASES = harness.Cases()


@functools.cache
def exported():
    """The URDF of a shipped arm."""
    command = [harness.RNE, "export", "planar2", "--urdf"]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def body_of(text):
    """An XML text without its first line `<?xml …?>`."""
    return text.split("?>", 1)[1] if "?>" in text else text


def urdf(name, text, expected="any", options=(), says=(), never=()):
    """A case of a URDF, or of a function that makes one. What is imported must pass `rne check`."""

    def body(trial):
        trial.write("arm.urdf", text() if callable(text) else text)
        names = "arm.urdf" if expected == "bad" else ""
        answer = trial.rne("import", "arm.urdf", *options, expected=expected, says=says, never=never, names=names)
        if answer.status == 0:
            trial.write("imported.yaml", answer.out.encode("utf-8", "surrogatepass"))
            trial.rne("check", "imported.yaml", expected="taken")

    CASES.add(name, body)


def link(name, mass="1"):
    return (
        f'<link name="{name}"><inertial><origin xyz="0 0 0.1" rpy="0 0 0"/><mass value="{mass}"/>'
        '<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
    )


LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'


def joint(name, parent, child, kind="revolute", axis="0 0 1", more=LIMIT, xyz="0 0 0.3", rpy="0 0 0"):
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="{axis}"/>{more}</joint>'
    )


def tree(*parts, attributes='name="r"'):
    return f"<robot {attributes}>" + "".join(parts) + "</robot>"


LINKS = link("b") + link("l1") + link("l2")
FIRST, SECOND = joint("j1", "b", "l1"), joint("j2", "l1", "l2", axis="0 1 0")
TWO = tree(LINKS, FIRST, SECOND)

# XML.
urdf("good", exported, "taken")
urdf("two joints", TWO, "taken")
ENTITIES = '<!ENTITY a "aaaaaaaaaa">' + "".join(
    f'<!ENTITY {chr(98 + i)} "{("&" + chr(97 + i) + ";") * 10}">' for i in range(9)
)
PASSWORDS = 'SYSTEM "file:///etc/passwd"'
NAMED = TWO.replace('name="', 'name="{}', 1)
urdf("bomb of entities in a name", f"<!DOCTYPE r [{ENTITIES}]>" + NAMED.format("&j;"))
urdf("bomb of entities in a text", f"<!DOCTYPE r [{ENTITIES}]>" + TWO.replace("</robot>", "&j;</robot>"))
urdf("entity of a file", f"<!DOCTYPE r [<!ENTITY x {PASSWORDS}>]>" + NAMED.format("&x;"), never=["root:"])
urdf("entity of parameters", f"<!DOCTYPE r [<!ENTITY % x {PASSWORDS}> %x;]>" + TWO, never=["root:"])
urdf("definition of another machine", '<!DOCTYPE r SYSTEM "http://127.0.0.1:9/x.dtd">' + TWO)
urdf("long entity often", lambda: f'<!DOCTYPE r [<!ENTITY x "{"a" * 100_000}">]>' + NAMED.format("&x;" * 10_000))
urdf("empty", "", "bad")
urdf("noise", random.Random(1).randbytes(3000), "bad")
urdf("UTF-16", lambda: exported().encode("utf-16"))
LATIN = b'<?xml version="1.0" encoding="latin-1"?>'
urdf("Latin-1", LATIN + NAMED.format("\xfc").encode("latin-1"))
urdf("cut", lambda: exported()[: len(exported()) // 2], "bad")
urdf("deep", "<a>" * 100_000, "bad")
urdf("deep and closed", "<robot name='x'>" + "<a>" * 50_000 + "</a>" * 50_000 + "</robot>")
urdf("another root", "<html/>", "bad")
urdf("two roots", TWO + TWO)
urdf("17 MB", lambda: TWO + "<!--" + "x" * (17 << 20) + "-->", "bad")
urdf("comment that stays open", TWO.replace("<link", "<!-- <link", 1), "bad")
urdf("zero byte", NAMED.format("\0"))
urdf(
    "mesh of a file",
    TWO.replace("</link>", '<visual><geometry><mesh filename="/etc/passwd"/></geometry></visual></link>', 1),
    never=["root:"],
)
urdf("instruction of PHP", "<?php system('id') ?>" + TWO)
XACRO = 'name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"'
# A finished file may declare the namespace of templates; one that uses it is a template.
urdf("namespace of xacro", tree(LINKS, FIRST, SECOND, attributes=XACRO), "taken")
urdf("include of xacro", tree("<xacro:include filename='/etc/passwd'/>", LINKS, FIRST, SECOND, attributes=XACRO), "bad")

# Trees.
urdf("ring", tree(LINKS, FIRST, joint("j2", "l1", "b")), "bad")
urdf("joint from a link to itself", tree(LINKS, joint("j1", "b", "b")), "bad")
urdf("two parents", tree(LINKS, FIRST, joint("j2", "l2", "l1")), "bad")
urdf("no joint", tree(LINKS), "bad")
urdf("parent that is not there", tree(LINKS, joint("j1", "x", "l1")), "bad")
urdf("name of a link twice", tree(link("b"), link("b"), joint("j1", "b", "b")), "bad")
urdf("name of a joint twice", tree(LINKS, joint("j", "b", "l1"), joint("j", "l1", "l2")))


def chain(count, kind="revolute", parent=lambda i: f"l{i - 1}"):
    """A tree of so many links."""
    return tree(
        *(link(f"l{i}") for i in range(count)),
        *(joint(f"j{i}", parent(i), f"l{i}", kind if i > 1 else "revolute") for i in range(1, count)),
    )


urdf("10000 links", lambda: chain(9999))
urdf("30000 links", lambda: chain(30_000), "bad")
urdf("5000 fixed joints", lambda: chain(5000, "fixed"))
urdf("5000 children", lambda: chain(5000, parent=lambda i: "l0"))
urdf(
    "64 joints",
    lambda: tree(
        *(link(f"l{i}") for i in range(65)),
        *(joint(f"j{i}", f"l{i - 1}", f"l{i}", axis="0 0 1" if i % 2 else "1 0 0") for i in range(1, 65)),
    ),
)
urdf("65 joints", lambda: chain(66))

# Words that are nearly right: what they say must not be passed over in silence. They are refused, or told.
AXIS, PLACE = '<axis xyz="0 1 0"/>', '<origin xyz="0 0 0.3" rpy="0 0 0"/>'
CENTRE = '<origin xyz="0 0 0.1" rpy="0 0 0"/>'
for what, right, wrong, word in (
    ("axes for axis", AXIS, AXIS.replace("axis", "axes"), "axes"),
    ("Axis for axis", AXIS, AXIS.replace("axis", "Axis"), "Axis"),
    ("xzy for xyz of an axis", AXIS, AXIS.replace("xyz", "xzy"), "xzy"),
    ("Origin of a joint", PLACE, PLACE.replace("origin", "Origin"), "Origin"),
    ("xzy for xyz of a joint", PLACE, PLACE.replace("xyz", "xzy"), "xzy"),
    ("ryp for rpy of a joint", PLACE, PLACE.replace("rpy", "ryp"), "ryp"),
    ("Origin of a link", CENTRE, CENTRE.replace("origin", "Origin"), "Origin"),
    ("inertal for inertial", "inertial>", "inertal>", "inertal"),
):
    urdf(f"misspelt: {what}", TWO.replace(right, wrong), says=[word])

# Followers. What moves with another joint is not at rest.
MIMIC = '<mimic joint="{}" multiplier="2" offset="0"/>' + LIMIT
urdf("follower in the chain", tree(LINKS, FIRST, joint("j2", "l1", "l2", more=MIMIC.format("j1"))))
urdf("follower of itself", tree(LINKS, joint("j1", "b", "l1", more=MIMIC.format("j1")), joint("j2", "l1", "l2")))
BESIDE = link("x") + joint("k", "l1", "x", axis="0 1 0", more=MIMIC.format("j1"))
HELD = ["--tip", "l2", "--lock-others"]
urdf(
    "follower beside the chain, of a joint that moves", tree(LINKS, FIRST, SECOND, BESIDE), "refused", HELD, says=["k"]
)
RING = (
    link("x")
    + link("y")
    + joint("k", "l1", "x", more=MIMIC.format("m"))
    + joint("m", "l1", "y", more=MIMIC.format("k"))
)
urdf("two followers of each other", tree(LINKS, FIRST, SECOND, RING), options=HELD, says=["k"])

# Numbers.
for axis in ("0 0 0", "nan 0 0", "1e300 0 0", "1e-300 0 0", "0 0", "0 0 0 1", "a b c", "inf 0 0", "", "0,0,1"):
    urdf(f"axis {axis!r}", tree(LINKS, joint("j1", "b", "l1", axis=axis), SECOND))
for mass in ("-1", "0", "nan", "inf", "1e308", "1e400", "", "x", "1e-320", "0x1"):
    urdf(f"mass {mass!r}", tree(link("b"), link("l1", mass), FIRST))
for kind in ("floating", "planar", "spherical", "continuous", "prismatic", "fixed", "REVOLUTE", "", "evil"):
    urdf(f"type {kind!r}", tree(LINKS, joint("j1", "b", "l1", kind), joint("j2", "l1", "l2")))
for xyz in ("1e300 0 0", "nan 0 0", "1e10 0 0", "0 0"):
    urdf(f"xyz {xyz!r}", tree(LINKS, joint("j1", "b", "l1", xyz=xyz), SECOND))
for rpy in ("1e300 0 0", "nan 0 0", "1e17 0 0", "1e-300 0 0", "1.5708 1.5708 1.5708"):
    urdf(f"rpy {rpy!r}", tree(LINKS, joint("j1", "b", "l1", rpy=rpy), SECOND))
TURNED = '<limit lower="1" upper="-1" effort="-1" velocity="-1"/>'
urdf("limits the wrong way round", tree(LINKS, joint("j1", "b", "l1", more=TURNED)))

# Names.
for text in TEXTS[:71]:
    name = html.escape(text)
    urdf(f"link and joint {label(text, 16)}", tree(link("b"), link(name), joint(name, "b", name)))
    urdf(f"robot {label(text, 16)}", tree(link("b"), link("l1"), FIRST, attributes=f'name="{name}"'))

# Options.
for options in (
    ["--base", "x"],
    ["--tip", ""],
    ["--tip", "\x1b[2J"],
    ["--lock", "j1"],
    ["--lock", "j1=nan"],
    ["--lock", "j1=1e300"],
    ["--lock", "=1"],
    ["--lock", "j1=0", "--lock", "j1=1"],
    ["--lock", "zz=1"],
    ["--name", "../x"],
    ["--name", "\xc4"],
    ["--base", "l2", "--tip", "b"],
    ["--base", "l1", "--tip", "l1"],
    ["--convention", "x"],
):
    urdf("options " + " ".join(options), TWO, options=options)

if __name__ == "__main__":
    harness.main(CASES)
