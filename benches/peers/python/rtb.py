"""rtb.py ROBOTS_DIR OUT.csv ROBOT...: roboticstoolbox's C code, one Python call over all states; the driver's CSV."""

import sys
import time
from statistics import median

import numpy as np
import roboticstoolbox

from arm import load, states, tensor

REPETITIONS = 15


def build(robot):
    standard = robot["convention"] == "standard"
    links = []
    for j in robot["joints"]:
        row = {key: j[key] for key in ("a", "alpha", "offset", "m")}
        common = dict(row, r=j["com"], I=tensor(j["I"]), Jm=0.0, G=1.0)
        if j["type"] == "R":
            kind = roboticstoolbox.RevoluteDH if standard else roboticstoolbox.RevoluteMDH
            links.append(kind(d=j["d"], **common))
        else:
            kind = roboticstoolbox.PrismaticDH if standard else roboticstoolbox.PrismaticMDH
            links.append(kind(theta=j["theta"], **common))
    result = roboticstoolbox.DHRobot(links, name=robot["name"])
    result.gravity = list(robot["gravity"])  # since release 1.5 the acceleration of gravity; before, its opposite
    return result


def main():
    folder, out, names = sys.argv[1], sys.argv[2], sys.argv[3:]
    with open(out, "w") as csv:
        print("robot,peer,kind,independent_median,independent_min,chained_median,chained_min,error", file=csv)
        for name in names:
            robot = load(name)
            arm, (q, qd, qdd) = build(robot), states(robot)
            with open(f"{folder}/{name}.states", "rb") as file:
                numbers = np.frombuffer(file.read()[16:], dtype="<f8")
            reference = numbers[3 * q.size : 4 * q.size].reshape(q.shape)  # behind q, qd and qdd
            error = np.abs(arm.rne(q, qd, qdd) - reference).max() / np.abs(reference).max()
            times = []
            for _ in range(REPETITIONS):
                start = time.perf_counter()
                arm.rne(q, qd, qdd)
                times.append((time.perf_counter() - start) / len(q) * 1e9)
            print(f"{name},rtb_c_batch,3,{median(times):.3f},{min(times):.3f},nan,nan,{error:.1e}", file=csv)


if __name__ == "__main__":
    main()
