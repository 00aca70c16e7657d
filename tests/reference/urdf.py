"""Robot files made by `rne import` against Pinocchio, which reads the same URDF.

Usage: python urdf.py RNE     where RNE is the binary; `cargo xtask urdf` installs what this needs and calls it.

For each arm: both conventions without snapping, where torques, mass matrix and tip must be Pinocchio's to 1e-10, and
with snapping, where they may differ by what the import tells.
"""

import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np
import pinocchio as pin

TOLERANCE = 1e-10
STATES = 5
# Where the packages keep their robots, wherever they are installed.
ROOTS = [
    next(iter(pathlib.Path(sys.prefix).glob(pattern)), pathlib.Path("/nonexistent"))
    for pattern in ("lib*/python*/site-packages/cmeel.prefix/share/example-robot-data/robots",
                    "lib*/python*/site-packages/rtbdata/xacro")
]

# URDF, options of the import.
ARMS = [
    ("ur_description/urdf/ur3_robot.urdf", "--tip tool0"),
    ("ur_description/urdf/ur5_robot.urdf", "--tip ee_link"),
    ("ur_description/urdf/ur10_robot.urdf", "--tip tool0"),
    ("panda_description/urdf/panda.urdf", "--tip panda_link8 --lock panda_finger_joint1=0.02 --lock-others"),
    ("kinova_description/robots/kinova.urdf", "--tip j2s6s200_end_effector --lock-others"),
    ("xarm_description/urdf/xarm7.urdf", "--tip link7 --lock-others"),
    ("talos_data/robots/talos_left_arm.urdf", "--tip wrist_left_ft_tool_link --lock-others"),
    ("talos_data/robots/talos_reduced.urdf",
     "--base torso_2_link --tip arm_right_7_link --lock torso_1_joint=0.3 --lock-others"),
    ("z1_description/urdf/z1.urdf", "--tip link06 --lock-others"),
    ("so_arm_description/urdf/so101.urdf", "--tip gripper_link --lock-others"),
    ("tiago_description/robots/tiago.urdf", "--tip arm_tool_link --lock-others"),
    ("baxter_description/urdf/baxter.urdf", "--tip left_gripper --lock-others"),
    ("pr2_description/urdf/pr2.urdf", "--tip r_gripper_palm_link --lock-others"),
    ("romeo_description/urdf/romeo.urdf", "--tip l_wrist --lock-others"),
    ("romeo_description/urdf/romeo_laas_small.urdf", "--tip l_sole --lock-others --keep-unphysical"),
    ("icub_description/robots/icub.urdf", "--tip l_hand --lock-others"),
    ("kuka_description/kuka_kr210/urdf/kr210l150.urdf", "--tip tool0"),
    ("double_pendulum_description/urdf/double_pendulum.urdf", ""),
]


def find(name):
    return next((root / name for root in ROOTS if (root / name).exists()), None)


class Reference:
    """The arm as Pinocchio has it, other joints held."""

    def __init__(self, path, joints, locks, tip):
        full = pin.buildModelFromUrdf(str(path))
        q = pin.neutral(full)
        for name, value in locks.items():
            joint = full.joints[full.getJointId(name)]
            if joint.nq <= 2:  # else a base that floats, which is held where it stands
                turn = [value] if joint.nq == 1 else [math.cos(value), math.sin(value)]
                q[joint.idx_q : joint.idx_q + joint.nq] = turn
        others = [i for i in range(1, full.njoints) if full.names[i] not in joints]
        self.model = pin.buildReducedModel(full, others, q)
        # A table has no friction; `rne` keeps it with the motors.
        for field in ("friction", "damping", "lowerDryFrictionLimit", "upperDryFrictionLimit", "armature"):
            if hasattr(self.model, field):
                setattr(self.model, field, np.zeros(self.model.nv))
        self.data = self.model.createData()
        self.order = [self.model.joints[self.model.getJointId(name)] for name in joints]
        self.tip = self.model.getFrameId(tip, pin.FrameType.BODY)

    def arguments(self, q, qd, qdd):
        full, v, a = pin.neutral(self.model), np.zeros(self.model.nv), np.zeros(self.model.nv)
        for joint, value, speed, acceleration in zip(self.order, q, qd, qdd):
            full[joint.idx_q : joint.idx_q + joint.nq] = (
                [value] if joint.nq == 1 else [math.cos(value), math.sin(value)])
            v[joint.idx_v], a[joint.idx_v] = speed, acceleration
        return full, v, a

    def values(self, q, qd, qdd):
        full, v, a = self.arguments(q, qd, qdd)
        rows = [joint.idx_v for joint in self.order]
        torques = pin.rnea(self.model, self.data, full, v, a)[rows]
        mass = pin.crba(self.model, self.data, full)
        mass = np.triu(mass) + np.triu(mass, 1).T
        pin.framesForwardKinematics(self.model, self.data, full)
        tip = self.data.oMf[self.tip]
        return torques, mass[np.ix_(rows, rows)], np.vstack([tip.rotation, tip.translation])


class Imported:
    """The same arm as `rne import` writes it and `rne eval` computes it."""

    def __init__(self, rne, path, options, folder, name):
        self.rne, self.file = rne, folder / f"{name}.yaml"
        command = [rne, "import", path, *options, "-o", self.file, "--force"]
        run = subprocess.run(command, capture_output=True, text=True)
        if run.returncode != 0:
            raise RuntimeError(run.stderr)
        self.account = run.stderr
        self.locked = [option.split("=")[0] for option in options if "=" in option]
        self.joints = re.findall(r"^  - name: \"?([^\"\n]*)\"?$", self.file.read_text(), re.M)
        self.kinds = re.findall(r"^    type: (\w+)$", self.file.read_text(), re.M)
        subprocess.run([rne, "check", self.file], check=True, capture_output=True)

    def eval(self, function, **arguments):
        words = [f"--{key}={','.join(repr(float(x)) for x in value)}" for key, value in arguments.items()]
        command = [self.rne, "eval", self.file, "--function", function, "--json", *words]
        return json.loads(subprocess.run(command, check=True, capture_output=True).stdout)["result"]

    def values(self, q, qd, qdd):
        torques = np.array(self.eval("inverse_dynamics", q=q, qd=qd, qdd=qdd))
        mass = np.array(self.eval("mass_matrix", q=q))
        tip = self.eval("forward_kinematics", q=q)
        return torques, mass, np.vstack([np.array(tip["rotation"]), np.array(tip["translation"])])

    def held(self):
        """The joints that do not move, and where they stand."""
        held = {name: float(value) for name, value in re.findall(r"^  (\S+) is locked at (\S+)$", self.account, re.M)}
        missing = set(self.locked) - set(held)
        if missing:  # the words of the command have changed
            raise RuntimeError(f"the import does not print at which position {', '.join(sorted(missing))} is locked")
        return held

    def told(self):
        """The change of tip, rotation and torques that the import tells."""
        found = re.search(r"moves the tip by (\S+) m and (\S+) rad, torques by (\S+) N m or (\S+) of", self.account)
        return [float(x) for x in found.groups()] if found else [0.0] * 4


def difference(ours, theirs):
    """Torques and mass matrix relative to their largest element, the tip in m and as elements of its rotation."""
    relative = [np.abs(a - b).max() / max(np.abs(b).max(), 1e-300) for a, b in zip(ours[:2], theirs[:2])]
    return np.array([*relative, np.abs(ours[2] - theirs[2]).max()])


def states(joints, kinds, model):
    random = np.random.default_rng(7)
    result = []
    for _ in range(STATES):
        q = []
        for name, kind in zip(joints, kinds):
            joint = model.joints[model.getJointId(name)]
            low, high = (-math.pi, math.pi) if kind == "revolute" else (-0.5, 0.5)
            if joint.nq == 1:
                low = max(low, model.lowerPositionLimit[joint.idx_q])
                high = min(high, model.upperPositionLimit[joint.idx_q])
            q.append(random.uniform(low, high) if low < high else random.uniform(-1, 1))
        n = len(joints)
        result.append((q, random.uniform(-2, 2, n), random.uniform(-5, 5, n)))
    return result


def main():
    rne = sys.argv[1]
    print(f"Pinocchio {pin.__version__}; torques and mass matrix relative to the largest, tip in m")
    print(f"{'URDF':<28}{'tip':<26}{'n':>3}  {'without snapping':^28}  {'snapped: torques, tip':^24}  {'reported change':^18}")
    failed, seen = [], 0
    with tempfile.TemporaryDirectory() as folder:
        for name, words in ARMS:
            path = find(name)
            if path is None:
                print(f"{pathlib.Path(name).stem:<28}not in the packages")
                continue
            options = words.split()
            worst = np.zeros(3)
            snapped, told = np.zeros(3), np.zeros(4)
            try:
                for convention in ("standard", "modified"):
                    for snap in (False, True):
                        extra = ["--convention", convention] + ([] if snap else ["--no-snap"])
                        arm = Imported(rne, path, options + extra, pathlib.Path(folder), "arm")
                        tip = re.search(r"from \S+ to (\S+)", arm.account).group(1)
                        reference = Reference(path, arm.joints, arm.held(), tip)
                        for state in states(arm.joints, arm.kinds, reference.model):
                            found = difference(arm.values(*state), reference.values(*state))
                            if snap:
                                snapped = np.maximum(snapped, found)
                            else:
                                worst = np.maximum(worst, found)
                        if snap:
                            told = np.maximum(told, arm.told())
            except (RuntimeError, subprocess.CalledProcessError) as error:
                print(f"{pathlib.Path(name).stem:<28}failed: {error}")
                failed.append(name)
                continue
            seen += 1
            # A few states of the thousand over which the import looks for the largest.
            fine = worst.max() <= TOLERANCE and snapped[0] <= 1.2 * told[3] + TOLERANCE
            fine = fine and snapped[2] <= 1.2 * max(told[:2]) + TOLERANCE
            if not fine:
                failed.append(name)
            numbers = "  ".join(f"{x:.1e}" for x in worst)
            print(f"{pathlib.Path(name).stem:<28}{tip[:25]:<26}{len(arm.joints):>3}  {numbers:^28}"
                  f"  {snapped[0]:>10.1e}  {snapped[2]:>10.1e}  {told[3]:>8.1e}  {max(told[:2]):>8.1e}"
                  f"{'' if fine else '  FAILED'}", flush=True)
    print(f"{seen} arms")
    if failed or seen < 12:
        sys.exit(f"failed: {', '.join(failed) or 'fewer than 12 arms'}")


if __name__ == "__main__":
    main()
