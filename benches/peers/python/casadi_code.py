"""casadi_code.py OUT ROBOT...: inverse dynamics by CasADi's code generator, and the operations of each function.

Three formulations, from what a textbook has to what an expert would do:

  dh    the seven steps over link frames (Luh, Walker, Paul): inertia about the centre of mass, frames of the table
  jf    over joint frames (Khalil, Craig): inertia about the frame's origin, U = [dw]x + [w]x[w]x
  base  jf, with the inertia that a joint cannot feel moved to the link before (exact for the torques)

and `pin`, Pinocchio's RNEA on CasADi's symbols, where pinocchio_casadi has written OUT/<robot>_pin.casadi.

Of robots with branches also the mass matrix (`m`, the derivative of `base` by the accelerations), forward dynamics
(`fd`, `m` factorised without fill-in), and the functions of Pinocchio that pinocchio_casadi has written.

SX folds x*0, x+0 and x*1 while it builds, constants are exact at right angles, and casadi.cse comes last.
Writes OUT/<robot>_<form>.c, OUT/<robot>_<form>_v.h (the same over vectors of states) and OUT/operations.csv.
"""

import os
import re
import sys
from pathlib import Path

import casadi as ca
import numpy as np

from arm import TREES, constant_d, constant_theta, load, parent, sin_cos, tensor, turn_x, turn_z

FORMS = ("dh", "jf", "base")


# Symbols


def constant(x):
    """A constant whose zeros are structural."""
    return ca.sparsify(ca.SX(ca.DM(np.asarray(x, dtype=float))))


ZERO, E_Z = constant([0, 0, 0]), constant([0, 0, 1])


def cross(a, b):
    return ca.vertcat(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def turn_by(q, theta):
    """Rz(q + theta); a right angle theta is not added to q, its effect is exact."""
    s0, c0 = sin_cos(theta)
    if (s0, c0) == (0.0, 1.0):
        s, c = ca.sin(q), ca.cos(q)
    elif s0 in (0.0, 1.0, -1.0):
        s, c = ca.sin(q) * c0 + ca.cos(q) * s0, ca.cos(q) * c0 - ca.sin(q) * s0
    else:
        s, c = ca.sin(q + theta), ca.cos(q + theta)
    result = ca.SX(3, 3)
    result[2, 2] = 1
    result[0, 0], result[1, 1], result[0, 1], result[1, 0] = c, c, -s, s
    return ca.sparsify(result)


# The formulations: q, v, a are positions, velocities and accelerations


def torques_dh(robot, q, v, a):
    standard = robot["convention"] == "standard"
    base = ZERO, ZERO, constant(-np.array(robot["gravity"]))
    motions, turns, offsets, forces, moments = [], [], [], [], []
    for i, j in enumerate(robot["joints"]):
        prismatic = j["type"] == "P"
        sa, ca_ = sin_cos(j["alpha"])
        Rx = constant(before_angle(j))
        above = parent(robot, i)
        w, dw, acceleration = base if above < 0 else motions[above]
        Rz = constant(turn_z(j["theta"])) if prismatic else turn_by(q[i], constant_theta(j))
        d = j["d"] + q[i] + j["offset"] if prismatic else j["d"]
        if standard:

            def into(x):
                return Rx.T @ (Rz.T @ x)

            turns.append((Rz, Rx))
            offset = ca.vertcat(j["a"], d * sa, d * ca_)  # from origin i-1 to origin i, in frame i
            if prismatic:
                w, dw = into(w), into(dw)
                axis = Rx.T @ E_Z
                acceleration = into(acceleration) + cross(dw, offset) + cross(w, cross(w, offset))
                acceleration = acceleration + axis * a[i] + 2 * cross(w, axis * v[i])
            else:
                before = w
                w = into(before + E_Z * v[i])
                dw = into(dw + E_Z * a[i] + cross(before, E_Z * v[i]))
                acceleration = into(acceleration) + cross(dw, offset) + cross(w, cross(w, offset))
        else:

            def into(x):
                return Rz.T @ (Rx.T @ x)

            turns.append((Rx, Rz))
            offset = offset_in_parent(j, d)  # origin i in the frame of the parent
            acceleration = into(acceleration + cross(dw, offset) + cross(w, cross(w, offset)))
            if prismatic:
                w, dw = into(w), into(dw)
                acceleration = acceleration + 2 * cross(w, E_Z * v[i]) + E_Z * a[i]
            else:
                before = into(w)
                dw = into(dw) + cross(before, E_Z * v[i]) + E_Z * a[i]
                w = before + E_Z * v[i]
        motions.append((w, dw, acceleration))
        offsets.append(offset)
        com, inertia = constant(j["com"]), constant(tensor(j["I"]))
        forces.append(j["m"] * (acceleration + cross(dw, com) + cross(w, cross(w, com))))
        moments.append(inertia @ dw + cross(w, inertia @ w))

    count = len(robot["joints"])
    from_children, tau = [(ZERO, ZERO)] * count, [None] * count
    for i, j in reversed(list(enumerate(robot["joints"]))):
        com = constant(j["com"])
        child_force, child_moment = from_children[i]
        force = child_force + forces[i]
        if standard:  # moment about origin i-1, in frame i
            moment = child_moment + cross(offsets[i], child_force) + cross(offsets[i] + com, forces[i]) + moments[i]
            axis = constant(turn_x(j["alpha"])).T @ E_Z
            tau[i] = ca.dot(force if j["type"] == "P" else moment, axis)
        else:  # moment about origin i, in frame i
            moment = moments[i] + child_moment + cross(com, forces[i])
            tau[i] = (force if j["type"] == "P" else moment)[2]
        above = parent(robot, i)
        if above >= 0:
            force, moment = (turns[i][0] @ (turns[i][1] @ x) for x in (force, moment))
            if not standard:
                moment = moment + cross(offsets[i], force)
            from_children[above] = from_children[above][0] + force, from_children[above][1] + moment
    return ca.vertcat(*tau)


def before_angle(joint):
    """The constant turn before that of the joint."""
    return turn_z(joint.get("gamma", 0.0)) @ turn_x(joint["alpha"])


def offset_in_parent(joint, d):
    """Origin of the frame of a modified row in the frame of the parent; d may be a symbol."""
    along = before_angle(joint)[:, 2]
    constant_part = turn_z(joint.get("gamma", 0.0))[:, 0] * joint["a"] + np.array([0, 0, joint.get("b", 0.0)])
    return constant(constant_part) + constant(along) * d


def joint_frames(robot):
    """Each joint in modified rows, with mass, first moment and inertia about the origin of the joint's frame."""
    result = []
    for i, j in enumerate(robot["joints"]):
        if robot["convention"] == "standard":
            before = robot["joints"][i - 1]
            alpha, a = (before["alpha"], before["a"]) if i else (0.0, 0.0)
            turn, offset = turn_x(j["alpha"]), np.array([j["a"], 0, 0])
        else:
            alpha, a, turn, offset = j["alpha"], j["a"], np.eye(3), np.zeros(3)
        com, mass = turn @ np.array(j["com"], dtype=float) + offset, j["m"]
        inertia = turn @ tensor(j["I"]) @ turn.T + mass * (com @ com * np.eye(3) - np.outer(com, com))
        result.append(
            dict(
                prismatic=j["type"] == "P",
                alpha=alpha,
                a=a,
                gamma=j.get("gamma", 0.0),
                b=j.get("b", 0.0),
                parent=parent(robot, i),
                theta=constant_theta(j),
                d=constant_d(j),
                mass=mass,
                first=mass * com,
                inertia=inertia,
            )
        )
    return result


def transformed(transform, mass, first, inertia):
    """Mass, first moment and inertia seen through a 4x4 transform."""
    pseudo = np.zeros((4, 4))
    pseudo[:3, :3] = 0.5 * np.trace(inertia) * np.eye(3) - inertia
    pseudo[:3, 3] = pseudo[3, :3] = first
    pseudo[3, 3] = mass
    pseudo = transform @ pseudo @ transform.T
    second = pseudo[:3, :3]
    return pseudo[3, 3], pseudo[:3, 3].copy(), np.trace(second) * np.eye(3) - second


def regroup(links):
    """Moves to the link before what a joint cannot feel: from the tip to the base, in place."""
    for i in reversed(range(len(links))):
        link = links[i]
        if link["prismatic"]:
            mass, first, inertia = 0.0, np.zeros(3), link["inertia"].copy()
        else:
            yy = link["inertia"][1, 1]
            mass, first, inertia = link["mass"], np.array([0, 0, link["first"][2]]), np.diag([yy, yy, 0.0])
        link["mass"] -= mass
        link["first"] = link["first"] - first
        link["inertia"] = link["inertia"] - inertia
        if link["parent"] < 0:
            continue
        turn = before_angle(link)
        if link["prismatic"]:  # inertia alone moves, wherever the slide is
            turn = turn @ turn_z(link["theta"])
            inertia = turn @ inertia @ turn.T
        else:
            transform = np.eye(4)
            transform[:3, :3] = turn
            transform[:3, 3] = np.array(ca.DM(ca.evalf(offset_in_parent(link, link["d"])))).ravel()
            mass, first, inertia = transformed(transform, mass, first, inertia)
        before = links[link["parent"]]
        before["mass"] += mass
        before["first"] = before["first"] + first
        before["inertia"] = before["inertia"] + inertia
    for link in links:  # rounding noise would hide zeros
        for key in ("first", "inertia"):
            largest = max(1e-300, np.abs(link[key]).max())
            link[key] = np.where(np.abs(link[key]) < 1e-14 * largest, 0.0, link[key])
    return links


def torques_joint_frames(robot, q, v, a, base):
    links = joint_frames(robot)
    if base:
        links = regroup(links)
    still = ZERO, ZERO, constant(-np.array(robot["gravity"])), ca.SX(3, 3)
    motions, turns, offsets, forces, moments = [], [], [], [], []
    for link in links:
        i = len(motions)
        w, dw, acceleration, U = still if link["parent"] < 0 else motions[link["parent"]]
        Rx = constant(before_angle(link))
        if link["prismatic"]:
            Rz, d = constant(turn_z(link["theta"])), link["d"] + q[i]
        else:
            Rz, d = turn_by(q[i], link["theta"]), link["d"]

        def into(x):
            return Rz.T @ (Rx.T @ x)

        offset = offset_in_parent(link, d)
        acceleration = into(acceleration) if link["parent"] < 0 else into(acceleration + U @ ca.SX(offset))
        w, dw = into(w), into(dw)
        if link["prismatic"]:
            acceleration = acceleration + ca.vertcat(2 * w[1] * v[i], -2 * w[0] * v[i], a[i])
        else:
            dw = dw + ca.vertcat(w[1] * v[i], -w[0] * v[i], a[i])
            w = w + ca.vertcat(0, 0, v[i])
        x, y, z = w[0], w[1], w[2]
        xx, yy, zz, xy, xz, yz = x * x, y * y, z * z, x * y, x * z, y * z
        U = ca.vertcat(
            ca.horzcat(-yy - zz, xy - dw[2], xz + dw[1]),
            ca.horzcat(xy + dw[2], -xx - zz, yz - dw[0]),
            ca.horzcat(xz - dw[1], yz + dw[0], -xx - yy),
        )
        first, I = constant(link["first"]), constant(link["inertia"])
        forces.append(link["mass"] * acceleration + U @ first)
        # I dw + w x I w, with the products that U has already.
        Ixx, Iyy, Izz, Ixy, Ixz, Iyz = I[0, 0], I[1, 1], I[2, 2], I[0, 1], I[0, 2], I[1, 2]
        moment = ca.vertcat(
            Ixx * dw[0] + (Izz - Iyy) * yz + Ixy * (dw[1] - xz) + Ixz * (dw[2] + xy) + Iyz * (yy - zz),
            Iyy * dw[1] + (Ixx - Izz) * xz + Ixy * (dw[0] + yz) + Iyz * (dw[2] - xy) + Ixz * (zz - xx),
            Izz * dw[2] + (Iyy - Ixx) * xy + Ixz * (dw[0] - yz) + Iyz * (dw[1] + xz) + Ixy * (xx - yy),
        )
        moments.append(moment + cross(first, acceleration))
        motions.append((w, dw, acceleration, U))
        turns.append((Rx, Rz))
        offsets.append(offset)

    tau = [None] * len(links)
    for i, link in reversed(list(enumerate(links))):
        force, moment = forces[i], moments[i]  # of this link and all behind it
        tau[i] = (force if link["prismatic"] else moment)[2]
        above = link["parent"]
        if above >= 0:
            outer, inner = turns[i]
            force, moment = outer @ (inner @ force), outer @ (inner @ moment)
            forces[above] = forces[above] + force
            moments[above] = moments[above] + moment + cross(offsets[i], force)
    return ca.vertcat(*tau)


# Code and counts


def function(robot, form):
    count = len(robot["joints"])
    q, v, a = ca.SX.sym("q", count), ca.SX.sym("v", count), ca.SX.sym("a", count)
    tau = torques_dh(robot, q, v, a) if form == "dh" else torques_joint_frames(robot, q, v, a, form == "base")
    return ca.Function("id", [q, v, a], [ca.cse(ca.densify(tau))])


def other_functions(robot):
    """Mass matrix and forward dynamics from the torques of `base`."""
    count = len(robot["joints"])
    q, v, a = ca.SX.sym("q", count), ca.SX.sym("v", count), ca.SX.sym("a", count)
    torques = torques_joint_frames(robot, q, v, a, True)
    matrix = ca.triu2symm(ca.triu(ca.jacobian(torques, a)))
    bias = ca.substitute(torques, a, ca.SX.zeros(count))
    acceleration = ca.ldl_solve(a - bias, *ca.ldl(matrix))
    results = {"m": matrix, "fd": acceleration}
    return {form: ca.Function("id", [q, v, a], [ca.cse(ca.densify(x))]) for form, x in results.items()}


def function_of_pinocchio(path, count):
    saved = ca.Function.load(str(path))
    x = [ca.SX.sym(f"x{i}", count) for i in range(3)]
    return ca.Function("id", x, ca.cse([ca.densify(y) for y in saved.call(x)]))


def operations(f):
    kinds = {
        "OP_MUL": "mul", "OP_SQ": "mul", "OP_ADD": "add", "OP_SUB": "add", "OP_TWICE": "add", "OP_NEG": "neg",
        "OP_DIV": "div", "OP_INV": "div", "OP_SIN": "sin", "OP_COS": "cos",
    }  # fmt: skip
    names = {getattr(ca, name): name for name in dir(ca) if name.startswith("OP_")}
    count = dict.fromkeys(("mul", "add", "neg", "div", "sin", "cos", "other"), 0)
    for k in range(f.n_instructions()):
        name = names[f.instruction_id(k)]
        if name not in ("OP_CONST", "OP_INPUT", "OP_OUTPUT"):
            count[kinds.get(name, "other")] += 1
    return count


def vectorised(source):
    """The body of CasADi's function over vectors of states; the macros are those of wrap.py."""
    body = source[source.index("static int casadi_f0") :]
    body = body[body.index("{") + 1 : body.index("return 0;")]
    body = body.replace("casadi_real ", "vec ")
    body = re.sub(r"arg\[(\d)\]\? arg\[\d\]\[(\d+)\] : 0", r"LOAD(x\1, \2)", body)
    body = re.sub(r"if \(res\[0\]!=0\) res\[0\]\[(\d+)\]=(\w+);", r"STORE(out, \1, \2);", body)
    body = re.sub(r"\b(sin|cos)\(", r"vec_\1(", body)
    body = re.sub(r"casadi_sq\((\w+)\)", r"(\1*\1)", body)
    return re.sub(r"=([-+]?[0-9][0-9.eE+-]*);", r"=(vec){0}+(\1);", body)


def write(f, name):
    f.generate(f"{name}.c")  # into the current folder: it takes no path
    return Path(f"{name}.c").read_text()


def main():
    folder, names = Path(sys.argv[1]), sys.argv[2:]
    folder.mkdir(parents=True, exist_ok=True)
    os.chdir(folder)
    rows = ["robot,form,mul,add,neg,div,sin,cos,other"]
    for name in names:
        robot = load(name)
        functions = {form: function(robot, form) for form in FORMS}
        for form, f in functions.items():
            Path(f"{name}_{form}_v.h").write_text(vectorised(write(f, f"{name}_{form}")))
        others = other_functions(robot) if name in TREES else {}
        for form in ("pin", "pinm", "pinfd", "pind"):
            saved = Path(f"{name}_{form}.casadi")
            if saved.exists():
                others[form] = function_of_pinocchio(saved, len(robot["joints"]))
        for form, f in others.items():
            write(f, f"{name}_{form}")
        functions |= others
        rows += [",".join(map(str, (name, form, *operations(f).values()))) for form, f in functions.items()]
    Path("operations.csv").write_text("\n".join(rows) + "\n")


if __name__ == "__main__":
    main()
