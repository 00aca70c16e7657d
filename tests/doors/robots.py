"""What the scripts of robot files share: a small arm in YAML, and hostile texts."""

import json


def robot(
    title="x",
    name="evil",
    joint="j1",
    source="own",
    notes="n",
    extra="",
    mass="2.5",
    a="0.8",
    theta="0",
    alpha="0",
    joints=2,
    com="[-0.4, 0, 0]",
):
    """A robot file. Texts are quoted; numbers stand as they are given."""
    quoted = json.dumps
    rows = "".join(
        f"  - {{name: {quoted(joint if i == 0 else f'j{i + 1}')}, type: revolute, "
        f"dh: {{theta: {theta}, d: 0, a: {a}, alpha: {alpha}}}, "
        f"link: {{mass: {mass}, com: {com}, inertia: {{xx: 0.01, yy: 0.02, zz: 0.02}}}}}}\n"
        for i in range(joints)
    )
    return (
        f"format: 1\nname: {quoted(name)}\ntitle: {quoted(title)}\nsource: {quoted(source)}\nnotes: {quoted(notes)}\n"
        f"convention: standard\ngravity: [0, -9.81, 0]\n{extra}joints:\n{rows}"
    )


# Aliases that stand for 10^10 letters.
BOMB = "a: &a [x,x,x,x,x,x,x,x,x,x]\n" + "".join(
    f"{chr(98 + i)}: &{chr(98 + i)} [{','.join(['*' + chr(97 + i)] * 10)}]\n" for i in range(9)
)

# Texts that are commands in some language that a text of a robot file is written into: HTML, Markdown and Rust, C,
# formats, terminals and directions, LaTeX, spreadsheets, file names, shells, YAML.
TEXTS = [
    "</script><script>alert(1)</script>",
    "<img src=x onerror=alert(1)>",
    '"><svg onload=alert(1)>',
    "'-alert(1)-'",
    "{{data}} {{script}} {{title}}",
    "${alert(1)}`",
    "<!--",
    "-->",
    "]]>",
    "<![CDATA[",
    "&lt;script&gt;",
    "&#0;",
    "```\nfn main() {}",
    '     let _ = std::fs::write("PWNED", "x"); //',
    "~~~",
    "```rust",
    "# heading",
    "[a](javascript:alert(1))",
    "*/ int main(){return 0;} /*",
    "*/",
    "/*",
    "//",
    "\\",
    "x\\",
    "??/",
    "x??/",
    "??/\n#error pwned",
    "a \\\n#error pwned",
    "#error x",
    '"; system("id"); //',
    "%s%n",
    "{}",
    "{0}",
    "{{}}",
    "\u2028x\u2029",
    "\u202eabc",
    "\x1b[31mred",
    "\x1b]0;t\x07",
    "a\rb",
    "a\nb",
    "a\n\n\nb",
    "\u0085",
    "\ufeff",
    "\u200b",
    "\x00",
    "\x7f",
    "\x9b2J",
    "\\input{/etc/passwd}",
    "\\write18{id}",
    "$ \\immediate\\write18{id} $",
    "\\end{document}",
    "% comment",
    "_^~&#$",
    "=cmd|' /C calc'!A0",
    "+1",
    "@SUM(1)",
    "-1+1",
    "a,b;c\td",
    "a'b\"c",
    "A" * 5000,
    "\U0001f600",
    "\U000e0001",
    "\U0001f1e9\U0001f1ea" * 100,
    "\ufdfa" * 100,
    "a\u0300" * 500,
    "../../etc/passwd",
    "/etc/passwd",
    "..",
    "C:\\x",
    "CON",
    "-o",
    "--help",
    "$(id)",
    "`id`",
    "|id",
    "null",
    "~",
    "true",
    "0x1",
    "",
    " ",
    "  lead",
    "trail  ",
    'r#"',
    '"#',
    "///",
    "//!",
    "#![feature(x)]",
    'include!("/etc/passwd")',
    "\\u{41}",
    "\\x41",
    "@@",
    "\u202e\u2066\u2069",
    "\x1b[8mhidden",
]


def label(text, length=24):
    """A text as part of the name of a case."""
    shown = repr(text[:length])
    return shown if len(text) <= length else f"{shown} of {len(text)} letters"
