"""Writes models/NAME.yaml, the robot files of rne, from models/NAME.json.

  robot_files.py          write them
  robot_files.py --check  exit with 1 when one is not what would be written

Numbers are the shortest decimals that give the number of the JSON back; right angles become pi/2, to stay exact.
"""

import math
import sys

from arm import ARMS, MODELS, load


def number(x):
    return repr(int(x)) if float(x).is_integer() else repr(float(x))


def angle(x):
    quarters = x / (math.pi / 2)
    if x == 0 or quarters != round(quarters):
        return number(x)
    if quarters % 2:
        factor = {1: "", -1: "-"}.get(quarters, f"{round(quarters)}*")
        return f"{factor}pi/2"
    factor = {2: "", -2: "-"}.get(quarters, f"{round(quarters / 2)}*")
    return f"{factor}pi"


def added(x, offset, written):
    """The sum of two numbers as it is written: no digit is computed."""
    if offset == 0:
        return written(x)
    return written(offset) if x == 0 else f"{written(x)} + ({written(offset)})"


def joint(i, j):
    revolute = j["type"] == "R"
    theta = added(j["theta"], j["offset"] if revolute else 0, angle)
    d = added(j["d"], 0 if revolute else j["offset"], number)
    inertia = {key: x for key, x in zip(("xx", "yy", "zz", "xy", "xz", "yz"), j["I"]) if x}
    link = [f"mass: {number(j['m'])}"]
    if any(j["com"]):
        link.append(f"com: [{', '.join(map(number, j['com']))}]")
    if inertia:
        link.append(f"inertia: {{{', '.join(f'{key}: {number(x)}' for key, x in inertia.items())}}}")
    lines = [
        f"  - name: j{i}",
        f"    type: {'revolute' if revolute else 'prismatic'}",
        f"    dh: {{theta: {theta}, d: {d}, a: {number(j['a'])}, alpha: {angle(j['alpha'])}}}",
        f"    link: {{{', '.join(link)}}}",
    ]
    if j["Jm"]:
        lines.append(f"    motor: {{inertia: {number(j['Jm'])}, gear_ratio: {number(j['G'])}}}")
    return lines


def yaml(robot):
    lines = [
        f"# Written by benches/peers/python/robot_files.py from {robot['name']}.json.",
        "format: 1",
        f"name: {robot['name']}",
        f'source: "{robot["source"]}"',
        f"convention: {robot['convention']}",
        f"gravity: [{', '.join(map(number, robot['gravity']))}]",
        "joints:",
    ]
    for i, j in enumerate(robot["joints"], 1):
        lines += joint(i, j)
    return "\n".join(lines) + "\n"


def main():
    stale = []
    for name in ARMS:
        path, text = MODELS / f"{name}.yaml", yaml(load(name))
        if sys.argv[1:] != ["--check"]:
            path.write_text(text)
        elif not path.exists() or path.read_text() != text:
            stale.append(path.name)
    if stale:
        sys.exit(f"not what robot_files.py writes: {', '.join(stale)}")


if __name__ == "__main__":
    main()
