#!/usr/bin/env python3
"""Draws the roofline of docs/control/gpu.md from the table of the page: `python3 benches/gpu/roofline.py` writes the picture
docs/pictures/gpu-roofline.svg. It needs Python's standard library alone.

The roof is what the card did at best: the slope is the copy of memory, the flat parts are chains of fused multiply-adds.
A point is a row of the table: its height is "of chains" times what the chains did, its place on the axis is this rate
divided by GB/s. The table rounds "of chains" to percent, so a point of 3% may be a sixth off.
"""

import math
import pathlib
import re
import sys
from xml.sax.saxutils import escape

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE, PICTURE = ROOT / "docs/control/gpu.md", ROOT / "docs/pictures/gpu-roofline.svg"
FONT = "Inter, 'Helvetica Neue', Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif"
COLOURS = {"f32": "#0072b2", "f64": "#d55e00"}
LEFT, RIGHT, TOP, BOTTOM = 110, 1240, 130, 640
X, Y = (0.15, 20), (0.3, 50)  # fused multiply-adds per byte, 10^12 fused multiply-adds per second
# Labels of rows, and where they stand beside the point; other rows have none.
LABELS = {
    ("panda inverse_dynamics", "f32"): ("Panda, torques", 2, 36),
    ("panda inverse_dynamics", "f64"): ("Panda, torques", 12, 18),
    ("panda forward_dynamics", "f32"): ("Panda, accelerations", 12, -6),
    ("panda forward_dynamics", "f64"): ("Panda, accelerations", 12, 8),
    ("panda mass_matrix", "f32"): ("Panda, mass matrix", 12, 14),
    ("panda mass_matrix", "f64"): ("Panda, mass matrix", 12, 16),
    ("panda inverse_dynamics_derivatives", "f64"): ("Panda, derivatives", 12, 16),
    ("g1 inverse_dynamics", "f64"): ("G1, torques", -12, 18),
    ("g1_floating inverse_dynamics_of_floating_base", "f64"): ("G1 with floating base, torques", 12, 18),
    ("g1_floating floating_mass_matrix", "f32"): ("G1, mass matrix", 12, 14),
    ("g1_floating floating_mass_matrix", "f64"): ("G1, mass matrix", 12, 14),
    ("g1_floating floating_forward_dynamics", "f32"): ("G1, accelerations", 12, 6),
    ("g1_floating floating_forward_dynamics", "f64"): ("G1, accelerations", 12, 6),
    ("digit_like inverse_dynamics_of_loops", "f32"): ("Digit with loops, torques", -12, 24),
    ("digit_like inverse_dynamics_of_loops", "f64"): ("Digit with loops, torques", 12, 14),
}


def read(page):
    """The limits of the card, and the rows: name, type, GB/s, part of chains."""
    text = " ".join(page.split())  # lines of the page are wrapped anywhere
    copy = float(re.search(r"moved ([\d,]+) GB/s", text)[1].replace(",", ""))
    single, double = re.search(r"did ([\d.]+) · 10¹² per second in `f32` and ([\d.]+) · 10¹² in `f64`", text).groups()
    rows = []
    for line in page.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) == 11 and cells[1] in COLOURS:
            rows.append((cells[0], cells[1], float(cells[6]), float(cells[8].rstrip("%")) / 100))
    if not rows:
        raise SystemExit(f"{PAGE}: there is no table of measured functions")
    return copy, {"f32": float(single), "f64": float(double)}, rows


def x(value):
    return LEFT + (RIGHT - LEFT) * math.log(value / X[0]) / math.log(X[1] / X[0])


def y(value):
    return BOTTOM - (BOTTOM - TOP) * math.log(value / Y[0]) / math.log(Y[1] / Y[0])


def text(at, down, words, **about):
    about = "".join(f' {key.replace("_", "-")}="{value}"' for key, value in about.items())
    return f' <text x="{at:.1f}" y="{down:.1f}"{about}>{escape(words)}</text>'


def picture(page):
    copy, peaks, rows = read(page)
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1280 720" width="1280" height="720" role="img" '
        f'font-family="{escape(FONT, {chr(39): "&apos;"})}" font-size="15" fill="#222222">',
        " <title>Functions of robots below the roof of an H200</title>",
        ' <rect width="100%" height="100%" fill="#ffffff"/>',
        text(40, 46, "Functions of robots on an H200, one thread per state", font_size=26, font_weight=600),
        text(40, 74, "One run, columns, 2²² states or more; the rows of the table in docs/control/gpu.md. The roof is what a copy and chains "
             "of fused multiply-adds did.", font_size=16, fill="#595959"),
    ]
    for value in (0.2, 0.5, 1, 2, 5, 10, 20):
        out.append(f' <line x1="{x(value):.1f}" y1="{TOP}" x2="{x(value):.1f}" y2="{BOTTOM}" stroke="#e4e4e4"/>')
        out.append(text(x(value), BOTTOM + 22, f"{value:g}", text_anchor="middle", fill="#595959"))
    for value in (0.5, 1, 2, 5, 10, 20, 50):
        out.append(f' <line x1="{LEFT}" y1="{y(value):.1f}" x2="{RIGHT}" y2="{y(value):.1f}" stroke="#e4e4e4"/>')
        out.append(text(LEFT - 10, y(value) + 5, f"{value:g}", text_anchor="end", fill="#595959"))
    out.append(text((LEFT + RIGHT) / 2, BOTTOM + 52, "fused multiply-adds per byte of memory read and written", text_anchor="middle"))
    out.append(text(LEFT - 60, TOP - 18, "10¹² fused multiply-adds per second"))
    for kind, peak in peaks.items():
        knee, low = peak * 1e3 / copy, max(X[0], Y[0] * 1e3 / copy)
        points = " ".join(f"{x(a):.1f},{y(b):.1f}" for a, b in ((low, low * copy / 1e3), (knee, peak), (X[1], peak)))
        dash = ' stroke-dasharray="9 3"' if kind == "f64" else ""
        out.append(f' <polyline points="{points}" fill="none" stroke="{COLOURS[kind]}" stroke-width="2.2"{dash}/>')
        out.append(text(RIGHT, y(peak) - 8, f"{kind}: {peak:g} · 10¹²/s", text_anchor="end", fill=COLOURS[kind]))
    slope = -math.degrees(math.atan2(y(1) - y(2), x(2) - x(1)))
    place = x(0.42), y(0.42 * copy / 1e3) - 10
    out.append(text(*place, f"copy: {copy:,.0f} GB/s", fill="#595959", transform=f"rotate({slope:.1f} {place[0]:.1f} {place[1]:.1f})"))
    for name, kind, bandwidth, part in rows:
        rate = part * peaks[kind]
        across, down = x(rate * 1e3 / bandwidth), y(rate)
        if kind == "f32":
            out.append(f' <circle cx="{across:.1f}" cy="{down:.1f}" r="5" fill="{COLOURS[kind]}"><title>{name}, {kind}</title></circle>')
        else:
            out.append(f' <rect x="{across - 4.5:.1f}" y="{down - 4.5:.1f}" width="9" height="9" fill="{COLOURS[kind]}">'
                       f"<title>{name}, {kind}</title></rect>")
        if (name, kind) in LABELS:
            words, right, below = LABELS[name, kind]
            anchor = "start" if right > 0 else "end"
            out.append(text(across + right, down + below, words, text_anchor=anchor, font_size=13, fill=COLOURS[kind]))
    return "\n".join([*out, "</svg>", ""])


def main():
    drawn = picture(PAGE.read_text(encoding="utf-8"))
    if sys.argv[1:] == ["--check"]:
        if PICTURE.read_text(encoding="utf-8") != drawn:
            raise SystemExit(f"{PICTURE} is out of date: python3 benches/gpu/roofline.py writes it")
    else:
        PICTURE.write_text(drawn, encoding="utf-8")


if __name__ == "__main__":
    main()
