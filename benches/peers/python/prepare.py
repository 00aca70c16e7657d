"""prepare.py DIR ROBOT...: the files that the driver and the plugins read.

DIR/<robot>.txt     constant transforms and inertias as plain numbers (native/flat.hpp)
DIR/<robot>.states  random states and their reference results, which are Pinocchio's: torques, those of gravity, those
                    without acceleration, mass matrix, derivatives of the torques by q and q̇
DIR/<robot>.mjb     the MuJoCo model, if MuJoCo is there
"""

import struct
import sys
from pathlib import Path

import numpy as np
import pinocchio

import pinocchio_arm
from arm import FLOATING, STATES, load, parent, split, states

try:
    import mujoco

    import mujoco_arm
except ImportError:
    mujoco = None


def flat(robot):
    def line(*numbers):
        return " ".join(repr(float(x)) for x in numbers)

    lines = [str(len(robot["joints"])), line(*robot["gravity"])]
    for i, j in enumerate(robot["joints"]):
        lines.append(f"{parent(robot, i)} {int(j['type'] == 'P')}")
        for transform in split(robot, i):
            lines += [line(*transform[:3, :3].ravel()), line(*transform[:3, 3])]
        lines += [line(j["m"], *j["com"]), line(*j["I"])]
    if "base" in robot:
        lines += [line(robot["base"]["m"], *robot["base"]["com"]), line(*robot["base"]["I"])]
    return "\n".join(lines) + "\n"


def states_and_torques(robot):
    model = pinocchio_arm.build(robot)
    data = model.createData()
    q, qd, qdd = states(robot)
    tau, gravity, bias, mass_matrix, by_q, by_qd = ([] for _ in range(6))
    for at_q, at_qd, at_qdd in zip(q, qd, qdd):
        tau.append(pinocchio.rnea(model, data, at_q, at_qd, at_qdd).copy())
        gravity.append(pinocchio.computeGeneralizedGravity(model, data, at_q).copy())
        bias.append(pinocchio.nonLinearEffects(model, data, at_q, at_qd).copy())
        upper = np.triu(pinocchio.crba(model, data, at_q))
        mass_matrix.append(upper + np.triu(upper, 1).T)
        pinocchio.computeRNEADerivatives(model, data, at_q, at_qd, at_qdd)
        by_q.append(data.dtau_dq.copy())
        by_qd.append(data.dtau_dv.copy())
    header = struct.pack("<qq", len(robot["joints"]), STATES)
    results = (q, qd, qdd, tau, gravity, bias, mass_matrix, by_q, by_qd)
    return header + b"".join(np.ascontiguousarray(x, dtype="<f8").tobytes() for x in results)


def main():
    folder, names = Path(sys.argv[1]), sys.argv[2:]
    folder.mkdir(parents=True, exist_ok=True)
    for name in names:
        robot = load(name)
        (folder / f"{name}.txt").write_text(flat(robot))
        if name in FLOATING:
            continue  # its states are made by ../floating
        (folder / f"{name}.states").write_bytes(states_and_torques(robot))
        if mujoco:
            mujoco.mj_saveModel(mujoco_arm.bare(robot), str(folder / f"{name}.mjb"))


if __name__ == "__main__":
    main()
