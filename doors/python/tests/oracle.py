"""Newton and Euler in numpy, in the axes of frame 0 and with sums over all links behind a joint: no recursion of forces,
no link axes, nothing of rne's."""

import numpy as np


def rotation(axis, angle):
    c, s = np.cos(angle), np.sin(angle)
    if axis == "x":
        return np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    if axis == "y":
        return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


class RandomArm:
    """A table of random numbers: revolute and prismatic joints, either convention, some zeros and right angles."""

    def __init__(self, seed):
        random = self.random = np.random.default_rng(seed)
        self.n = int(random.integers(1, 8))
        self.parents = list(range(-1, self.n - 1))
        self.convention = random.choice(["standard", "modified"])
        self.gravity = random.normal(size=3) * 6
        sparsity = random.choice([0.0, 0.3, 0.7])

        def number(scale):
            return 0.0 if random.random() < sparsity else random.normal() * scale

        def angle():
            return random.choice([0, np.pi / 2, -np.pi / 2, np.pi]) if random.random() < sparsity else random.normal()

        self.joints = []
        for _ in range(self.n):
            factor = random.normal(size=(3, 3)) * 0.2
            self.joints.append(
                {
                    "type": "revolute" if random.random() < 0.7 else "prismatic",
                    "theta": angle(), "d": number(0.4), "a": number(0.4), "alpha": angle(),
                    "mass": abs(random.normal()) * 4 + 0.1,
                    "com": np.array([number(0.2), number(0.2), number(0.2)]),
                    # of a body: the tensor of a sum of point masses
                    "inertia": np.trace(factor @ factor.T) * np.eye(3) - factor @ factor.T,
                }
            )
        # where a row begins on its parent
        self.places = [(np.zeros(3), np.zeros(3))] * self.n

    def carries(self, joint, link):
        """Whether a joint moves a link."""
        return link == joint or link > joint and self.carries(joint, self.parents[link])

    def yaml(self):
        def numbers(values):
            return "[" + ", ".join(repr(float(value)) for value in values) + "]"

        lines = ["format: 1", "name: random_arm", "source: random numbers", f"convention: {self.convention}",
                 f"gravity: {numbers(self.gravity)}", "joints:"]
        for joint in self.joints:
            dh = ", ".join(f"{key}: {float(joint[key])!r}" for key in ("theta", "d", "a", "alpha"))
            inertia = joint["inertia"]
            elements = {"xx": (0, 0), "yy": (1, 1), "zz": (2, 2), "xy": (0, 1), "xz": (0, 2), "yz": (1, 2)}
            tensor = ", ".join(f"{name}: {float(inertia[place])!r}" for name, place in elements.items())
            lines += [f"  - type: {joint['type']}", f"    dh: {{{dh}}}",
                      f"    link: {{mass: {float(joint['mass'])!r}, com: {numbers(joint['com'])}, "
                      f"inertia: {{{tensor}}}}}"]
        return "\n".join(lines) + "\n"

    def states(self, count):
        return self.random.normal(size=(3, count, self.n))

    def frames(self, q):
        """Of every link: its frame's rotation and origin, and the point and direction of its joint's axis."""
        found = []
        for index, (joint, position) in enumerate(zip(self.joints, q)):
            parent = self.parents[index]
            turn, origin = (np.eye(3), np.zeros(3)) if parent < 0 else found[parent][:2]
            xyz, (roll, pitch, yaw) = self.places[index]
            origin = origin + turn @ xyz
            turn = turn @ rotation("z", yaw) @ rotation("y", pitch) @ rotation("x", roll)
            revolute = joint["type"] == "revolute"
            theta = joint["theta"] + (position if revolute else 0)
            d = joint["d"] + (0 if revolute else position)
            about_z = (rotation("z", theta), np.array([0, 0, d]))
            about_x = (rotation("x", joint["alpha"]), np.array([joint["a"], 0, 0]))
            parts = [about_z, about_x] if self.convention == "standard" else [about_x, about_z]
            axis = None
            for turned, moved in parts:
                if turned is about_z[0]:
                    axis = (origin, turn @ [0, 0, 1])
                origin = origin + turn @ moved
                turn = turn @ turned
            found.append((turn, origin, *axis))
        return found

    def torques(self, q, qd, qdd):
        base = np.zeros(3), np.zeros(3), np.zeros(3), -self.gravity
        frames, forces, motions = self.frames(q), [], []
        for parent, joint, speed, change, (turn, origin, point, axis) in zip(
            self.parents, self.joints, qd, qdd, frames
        ):
            omega, alpha, at, acceleration = base if parent < 0 else motions[parent]
            def of_point(place):
                arm = place - at
                return acceleration + np.cross(alpha, arm) + np.cross(omega, np.cross(omega, arm))

            if joint["type"] == "revolute":
                here = of_point(point)
                alpha = alpha + axis * change + np.cross(omega, axis * speed)
                omega = omega + axis * speed
                arm = origin - point
                acceleration = here + np.cross(alpha, arm) + np.cross(omega, np.cross(omega, arm))
            else:
                acceleration = of_point(origin) + axis * change + 2 * np.cross(omega, axis * speed)
            at = origin
            motions.append((omega, alpha, at, acceleration))
            arm = turn @ joint["com"]
            of_com = acceleration + np.cross(alpha, arm) + np.cross(omega, np.cross(omega, arm))
            tensor = turn @ joint["inertia"] @ turn.T
            forces.append((origin + arm, joint["mass"] * of_com, tensor @ alpha + np.cross(omega, tensor @ omega)))
        torques = []
        for index, (joint, (_, _, point, axis)) in enumerate(zip(self.joints, frames)):
            behind = [force for link, force in enumerate(forces) if self.carries(index, link)]
            if joint["type"] == "revolute":
                torques.append(sum(axis @ (moment + np.cross(where - point, force)) for where, force, moment in behind))
            else:
                torques.append(sum(axis @ force for _, force, _ in behind))
        return np.array(torques)

    def mass_matrix(self, q):
        zero = np.zeros(self.n)
        still = self.torques(q, zero, zero)
        return np.array([self.torques(q, zero, row) - still for row in np.eye(self.n)]).T


class RandomTree(RandomArm):
    """A table whose rows are on any link before them; `tip` is the joint whose link carries the tip."""

    def __init__(self, seed):
        super().__init__(seed)
        random = self.random
        self.parents = [int(random.integers(-1, joint)) if joint else -1 for joint in range(self.n)]
        self.places = [(random.normal(size=3) * 0.3, random.normal(size=3)) for _ in range(self.n)]
        self.tip = int(random.integers(0, self.n))

    def yaml(self):
        def numbers(values):
            return "[" + ", ".join(repr(float(value)) for value in values) + "]"

        lines, joint = [], 0
        for line in super().yaml().splitlines():
            if line == "format: 1":
                lines += ["format: 2", f"tool: {{on: j{self.tip}, xyz: [0, 0, 0], rpy: [0, 0, 0]}}"]
                continue
            if line.startswith("  - type:"):
                parent = "base" if self.parents[joint] < 0 else f"j{self.parents[joint]}"
                xyz, rpy = (numbers(values) for values in self.places[joint])
                lines += [f"  - name: j{joint}", f"    parent: {parent}", f"    at: {{xyz: {xyz}, rpy: {rpy}}}"]
                line = line.replace("  - type", "    type")
                joint += 1
            lines.append(line)
        return "\n".join(lines) + "\n"
