"""Newton and Euler as expressions of CasADi, from the rows of a robot file: the equations of motion of each body in the
axes of frame 0, projected on the joint axes. CasADi derives them; nothing here is of rne's."""

import math
from pathlib import Path

import casadi as ca
import yaml

ROBOTS = Path(__file__).parents[3] / "robots"

#: What the numbers of a robot file may be made of.
_WORDS = {"pi": math.pi, "deg": math.radians, "sqrt": math.sqrt, "sin": math.sin, "cos": math.cos, "__builtins__": {}}


def cross(a, b):
    return ca.vertcat(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def turned(axis, angle):
    c, s = ca.cos(angle), ca.sin(angle)
    rows = {"x": [[1, 0, 0], [0, c, -s], [0, s, c]], "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]],
            "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]]}[axis]
    return ca.vertcat(*[ca.horzcat(*map(ca.SX, row)) for row in rows])


class Expressions:
    """The functions of the robot of a file, as functions of CasADi with the names of rne's."""

    def __init__(self, name):
        text = yaml.safe_load((ROBOTS / f"{name}.yaml").read_text(encoding="utf-8"))
        words = dict(_WORDS)

        def number(value):
            # YAML reads `1e-3` as text
            return float(eval(str(value).replace("^", "**"), words))  # noqa: S307

        for key, value in (text.get("parameters") or {}).items():
            words[key] = number(value)
        self.number, self.text = number, text
        self.joints = text["joints"]
        self.n = len(self.joints)
        assert not any("follows" in joint or "at" in joint for joint in self.joints)
        self.gravity = ca.SX(list(map(number, text["gravity"])))
        names = [joint.get("name") for joint in self.joints]
        self.parents = [
            names.index(joint["parent"]) if joint.get("parent", "base") != "base"
            else -1 if "parent" in joint else index - 1
            for index, joint in enumerate(self.joints)
        ]
        q, qd, qdd, tau = (ca.SX.sym(of, self.n) for of in ("q", "qd", "qdd", "tau"))
        torques = self._torques(q, qd, qdd)
        zero = ca.SX.zeros(self.n)
        bias = ca.substitute(torques, qdd, zero)
        mass = ca.jacobian(torques, qdd)
        self.inverse_dynamics = ca.Function("inverse_dynamics", [q, qd, qdd], [torques], ["q", "qd", "qdd"], ["tau"])
        self.bias_torques = ca.Function("bias_torques", [q, qd], [bias], ["q", "qd"], ["tau"])
        self.gravity_torques = ca.Function("gravity_torques", [q], [ca.substitute(bias, qd, zero)], ["q"], ["tau"])
        self.mass_matrix = ca.Function("mass_matrix", [q], [ca.densify(mass)], ["q"], ["mass_matrix"])
        parts = ca.Function("parts", [q, qd], [mass, bias])
        q, qd, tau = (ca.MX.sym(of, self.n) for of in ("q", "qd", "tau"))
        mass, bias = parts(q, qd)
        accelerations = ca.solve(mass, tau - bias, "ldl")
        self.forward_dynamics = ca.Function(
            "forward_dynamics", [q, qd, tau], [accelerations], ["q", "qd", "tau"], ["qdd"]
        )
        step = ca.MX.sym("step")
        velocities = qd + step * accelerations
        self.euler_step = ca.Function(
            "euler_step", [q, qd, tau, step], [q + step * velocities, velocities],
            ["q", "qd", "tau", "step"], ["next_q", "next_qd"],
        )

    def _row(self, joint, position):
        """The turns and moves of a row of the table in their order, and the place of the joint among them."""
        dh = {key: self.number(value) for key, value in joint["dh"].items()}
        revolute = joint["type"] == "revolute"
        theta, d = dh["theta"] + (position if revolute else 0), dh["d"] + (0 if revolute else position)
        about_z = ("z", theta, ca.vertcat(0, 0, d))
        about_x = ("x", dh["alpha"], ca.vertcat(dh["a"], 0, 0))
        if self.text["convention"] == "standard":
            return [about_z, about_x], 0
        return [("z", dh.get("gamma", 0.0), ca.vertcat(0, 0, dh.get("b", 0.0))), about_x, about_z], 2

    def _torques(self, q, qd, qdd):
        base = (ca.SX.eye(3), ca.SX.zeros(3), ca.SX.zeros(3), ca.SX.zeros(3), -self.gravity)
        frames, axes, forces = [], [], []
        for index, joint in enumerate(self.joints):
            parent = self.parents[index]
            turn, origin, omega, alpha, acceleration = base if parent < 0 else frames[parent]
            start = origin
            parts, place = self._row(joint, q[index])
            for number, (axis, angle, move) in enumerate(parts):
                if number == place:
                    point, direction = origin, turn[:, 2]
                turn = ca.mtimes(turn, turned(axis, angle))
                # a turn about x or z leaves its own axis where it is
                origin = origin + ca.mtimes(turn, move)

            def moved(arm):
                return cross(alpha, arm) + cross(omega, cross(omega, arm))

            if joint["type"] == "revolute":
                acceleration = acceleration + moved(point - start)
                alpha = alpha + direction * qdd[index] + cross(omega, direction * qd[index])
                omega = omega + direction * qd[index]
                acceleration = acceleration + moved(origin - point)
            else:
                acceleration = acceleration + moved(origin - start)
                acceleration = acceleration + direction * qdd[index] + 2 * cross(omega, direction * qd[index])
            frames.append((turn, origin, omega, alpha, acceleration))
            axes.append((point, direction))
            link = joint.get("link") or {}
            inertia = {key: self.number(value) for key, value in (link.get("inertia") or {}).items()}
            tensor = ca.SX(ca.DM([[inertia.get("".join(sorted(row + column)), 0.0) for column in "xyz"] for row in "xyz"]))
            tensor = ca.mtimes([turn, tensor, turn.T])
            arm = ca.mtimes(turn, ca.SX(list(map(self.number, link.get("com", [0, 0, 0])))))
            force = self.number(link.get("mass", 0)) * (acceleration + moved(arm))
            moment = ca.mtimes(tensor, alpha) + cross(omega, ca.mtimes(tensor, omega))
            forces.append((origin + arm, force, moment))
        torques = []
        for index, (joint, (point, direction)) in enumerate(zip(self.joints, axes)):
            torque = 0
            for link, (where, force, moment) in enumerate(forces):
                if self._carries(index, link):
                    revolute = joint["type"] == "revolute"
                    torque += ca.dot(direction, moment + cross(where - point, force) if revolute else force)
            torques.append(torque)
        return ca.vertcat(*torques)

    def _carries(self, joint, link):
        return link == joint or link > joint and self._carries(joint, self.parents[link])
