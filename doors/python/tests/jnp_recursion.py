"""Newton and Euler in jax.numpy, link by link as a user of JAX writes it, from the poses and parameters of an arm at rest:
the oracle of `Arm.jax`, and what `benches/peers/python/in_jax.py` times. Revolute joints, one chain, modified tables."""

import jax.numpy as jnp
import numpy as np


class Chain:
    """The constants of a chain: where each link stands on the one before at q = 0, and its mass properties."""

    def __init__(self, arm):
        assert arm.convention == "modified" and len(arm.tips) == 1 and not arm.followers
        poses = [np.eye(4), *arm.link_poses(np.zeros(arm.dof))]
        steps = [np.linalg.solve(before, pose) for before, pose in zip(poses, poses[1:])]
        self.steps = [(step[:3, :3], step[:3, 3]) for step in steps]
        self.gravity = np.array(arm.gravity)
        self.bodies = []
        for m, cx, cy, cz, xx, xy, xz, yy, yz, zz in arm.inertial_parameters():
            c = np.array([cx, cy, cz]) / m
            about_origin = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
            self.bodies.append((m, c, about_origin - m * (c @ c * np.eye(3) - np.outer(c, c))))

    def torques(self, q, qd, qdd):
        """Of one state, with vectors of three and matrices: shape (n,)."""
        axis = np.array([0.0, 0.0, 1.0])
        omega, omega_dot, acceleration = jnp.zeros(3), jnp.zeros(3), -self.gravity
        turns, forces, moments = [], [], []
        for i, ((fixed, place), (m, c, inertia)) in enumerate(zip(self.steps, self.bodies)):
            cos, sin = jnp.cos(q[i]), jnp.sin(q[i])
            turn = fixed @ jnp.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
            moved = jnp.cross(omega_dot, place) + jnp.cross(omega, jnp.cross(omega, place))
            acceleration = turn.T @ (acceleration + moved)
            carried = turn.T @ omega
            omega_dot = turn.T @ omega_dot + jnp.cross(carried, axis * qd[i]) + axis * qdd[i]
            omega = carried + axis * qd[i]
            centre = acceleration + jnp.cross(omega_dot, c) + jnp.cross(omega, jnp.cross(omega, c))
            turns.append(turn)
            forces.append(m * centre)
            moments.append(inertia @ omega_dot + jnp.cross(omega, inertia @ omega))
        force, moment, torques = jnp.zeros(3), jnp.zeros(3), []
        for i in reversed(range(len(self.bodies))):
            if i + 1 < len(self.bodies):
                turn, place = turns[i + 1], self.steps[i + 1][1]
                force = turn @ force
                moment = turn @ moment + jnp.cross(place, force)
            force = force + forces[i]
            moment = moment + moments[i] + jnp.cross(self.bodies[i][1], forces[i])
            torques.append(moment[2])
        return jnp.stack(torques[::-1])

    def torques_by_numbers(self, q, qd, qdd):
        """The same with a number in place of each element: one loop for XLA, with no matrix in memory."""
        def cross(a, b):
            return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]

        def plus(*vectors):
            return [sum(elements[1:], elements[0]) for elements in zip(*vectors)]

        def times(matrix, vector):
            # a zero of the table costs nothing
            rows = [[(x, y) for x, y in zip(row, vector) if not (isinstance(x, float) and x == 0)] for row in matrix]
            return [sum((x * y for x, y in row), 0.0) for row in rows]

        def scaled(number, vector):
            return [number * x for x in vector]

        def plain(array):
            return [plain(one) for one in array] if np.ndim(array) else float(array)

        omega, omega_dot, acceleration = [0.0] * 3, [0.0] * 3, plain(-self.gravity)
        turns, forces, moments = [], [], []
        for i, ((fixed, place), (m, c, inertia)) in enumerate(zip(self.steps, self.bodies)):
            fixed = plain(np.where(abs(fixed) < 1e-15, 0, fixed))
            place, c, inertia = plain(place), plain(c), plain(inertia)
            cos, sin = jnp.cos(q[i]), jnp.sin(q[i])
            columns = list(zip(*fixed))
            turn = list(zip(
                plus(scaled(cos, columns[0]), scaled(sin, columns[1])),
                plus(scaled(cos, columns[1]), scaled(-sin, columns[0])),
                columns[2],
            ))
            back = list(zip(*turn))
            moved = plus(acceleration, cross(omega_dot, place), cross(omega, cross(omega, place)))
            acceleration = times(back, moved)
            carried = times(back, omega)
            turned = [carried[1] * qd[i], -carried[0] * qd[i], qdd[i]]
            omega_dot = plus(times(back, omega_dot), turned)
            omega = [carried[0], carried[1], carried[2] + qd[i]]
            centre = plus(acceleration, cross(omega_dot, c), cross(omega, cross(omega, c)))
            turns.append(turn)
            forces.append(scaled(m, centre))
            moments.append(plus(times(inertia, omega_dot), cross(omega, times(inertia, omega))))
        force, moment, torques = [0.0] * 3, [0.0] * 3, []
        for i in reversed(range(len(self.bodies))):
            if i + 1 < len(self.bodies):
                turn, place = turns[i + 1], plain(self.steps[i + 1][1])
                force = times(turn, force)
                moment = plus(times(turn, moment), cross(place, force))
            force = plus(force, forces[i])
            moment = plus(moment, moments[i], cross(plain(self.bodies[i][1]), forces[i]))
            torques.append(moment[2])
        return jnp.stack(torques[::-1])
