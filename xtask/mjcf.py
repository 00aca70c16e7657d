"""MJCF files imported by `rne import --whole` beside MuJoCo, which reads the same files.

Usage: python mjcf.py RNE FOLDER       where RNE is the binary and FOLDER has MJCF files and URDFs
       python mjcf.py --golden FOLDER  writes the torques of MuJoCo beside each MJCF file of the folder

`cargo xtask mjcf` calls it. MuJoCo reads each URDF without its meshes and saves it as MJCF; torques of the whole robot at
a few states must be MuJoCo's to 1e-9 of the largest one. A free joint stands still. Joints that follow others do so in
both: their torques act on the joints that they follow.
"""

import pathlib
import re
import sys
import tempfile

import mujoco
import numpy as np

TOLERANCE = 1e-9
STATES = 3


class Model:
    """An MJCF file as MuJoCo has it."""

    def __init__(self, path):
        text = path.read_text()
        if re.search(r"<mesh [^>]*file=", text):  # which are not here, and matter to no inertia
            text = re.sub(r'<geom [^>]*type="mesh"[^>]*/>|<mesh [^>]*/>', "", text)
            self.model = model = mujoco.MjModel.from_xml_string(text)
        else:
            self.model = model = mujoco.MjModel.from_xml_path(str(path))
        self.data = mujoco.MjData(model)
        kinds = (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE))
        moves = [i for i in range(model.njnt) if int(model.jnt_type[i]) in kinds]
        # Each joint's position is that of a leader times a ratio and an offset; `None` has no leader.
        self.follows = {i: (i, 1.0, 0.0) for i in moves}
        for _ in range(model.neq):
            for k in range(model.neq):
                if int(model.eq_type[k]) != int(mujoco.mjtEq.mjEQ_JOINT) or not model.eq_active0[k]:
                    continue
                one, other = int(model.eq_obj1id[k]), int(model.eq_obj2id[k])
                a, b = model.eq_data[k, :2]
                start = model.qpos0[model.jnt_qposadr[one]] + a
                if other < 0:
                    self.follows[one] = (None, 0.0, start)
                else:
                    leader, ratio, offset = self.follows[other]
                    start -= b * model.qpos0[model.jnt_qposadr[other]]
                    self.follows[one] = (leader, ratio * b, start + b * offset)
        self.free = [i for i in moves if self.follows[i][0] == i]
        self.names = [model.joint(i).name for i in self.free]

    def states(self, number=STATES):
        random = np.random.default_rng(7)
        for _ in range(number):
            yield [random.uniform(-size, size, len(self.free)) for size in (1.0, 2.0, 5.0)]

    def torques(self, q, qd, qdd, rotors):
        model, data = self.model, self.data
        data.qpos[:], data.qvel[:], data.qacc[:] = model.qpos0, 0, 0
        place = {joint: k for k, joint in enumerate(self.free)}
        for joint, (leader, ratio, offset) in self.follows.items():
            at, dof = model.jnt_qposadr[joint], model.jnt_dofadr[joint]
            data.qpos[at] = offset
            if leader is not None:
                k = place[leader]
                data.qpos[at] += ratio * q[k]
                data.qvel[dof], data.qacc[dof] = ratio * qd[k], ratio * qdd[k]
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        tau = np.zeros(model.nv)
        mujoco.mj_rne(model, data, 1, tau)
        if rotors:
            armature = model.dof_armature.copy()
            for k in range(model.nu):
                if int(model.actuator_trntype[k]) == int(mujoco.mjtTrn.mjTRN_JOINT):
                    dof = model.jnt_dofadr[model.actuator_trnid[k, 0]]
                    armature[dof] += model.actuator_gear[k, 0] ** 2 * model.actuator_armature[k]
            tau += armature * data.qacc
        result = np.zeros(len(self.free))
        for joint, (leader, ratio, _) in self.follows.items():
            if leader is not None:
                result[place[leader]] += ratio * tau[model.jnt_dofadr[joint]]
        return result


def golden(folder):
    for path in sorted(folder.glob("*.xml")):
        model = Model(path)
        lines = [",".join(model.names)]
        for q, qd, qdd in model.states():
            tau = model.torques(q, qd, qdd, rotors=True)
            lines.append(",".join(repr(float(x)) for x in np.concatenate([q, qd, qdd, tau])))
        path.with_suffix(".csv").write_text("\n".join(lines) + "\n")
        print(path.name, len(model.free))


def saved(path, folder):
    """A URDF as the MJCF file that MuJoCo saves."""
    text = re.sub(r"<(visual|collision)\b(?:[^>]*/>|.*?</\1>)", "", path.read_text(), flags=re.S)
    options = '<mujoco><compiler fusestatic="false" balanceinertia="true" boundmass="1e-6" boundinertia="1e-9"/></mujoco>'
    text = re.sub(r"(<robot\b[^>]*>)", lambda tag: tag.group(1) + options, text, count=1)
    model = mujoco.MjModel.from_xml_string(text)
    result = folder / f"{path.stem}.xml"
    mujoco.mj_saveLastXML(str(result), model)
    return result


def main():
    if sys.argv[1] == "--golden":
        return golden(pathlib.Path(sys.argv[2]))
    from urdf import Imported

    rne, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    failed, seen = [], 0
    with tempfile.TemporaryDirectory() as temporary:
        temporary = pathlib.Path(temporary)
        for path in sorted([*folder.glob("*.xml"), *folder.glob("*.urdf")]):
            try:
                file = path if path.suffix == ".xml" else saved(path, temporary)
                model = Model(file)
            except ValueError as error:
                print(f"{path.name}: MuJoCo refuses it: {str(error).splitlines()[0]}")
                continue
            try:
                arm = Imported(rne, file, ["--whole", "--no-snap", "--keep-unphysical"], temporary, f"{path.stem}-rne")
                rows = [arm.joints.index(name) for name in model.names]
                worst = 0.0
                moving = [name for name in arm.joints if name in model.names]
                order = [model.names.index(name) for name in moving]
                for q, qd, qdd in model.states():
                    found = arm.eval("inverse_dynamics", q=q[order], qd=qd[order], qdd=qdd[order])
                    expected = model.torques(q, qd, qdd, rotors=False)[order]
                    worst = max(worst, np.abs(found - expected).max() / max(np.abs(expected).max(), 1e-300))
            except (RuntimeError, ValueError) as error:
                print(f"{path.name}: FAILED: {error}")
                failed.append(path.name)
                continue
            seen += 1
            fine = worst <= TOLERANCE
            print(f"{path.name}: {len(rows)} joints, torques to {worst:.1e}{'' if fine else ', FAILED'}", flush=True)
            if not fine:
                failed.append(path.name)
    print(f"{seen} robots")
    if failed or seen == 0:
        sys.exit(f"failed: {', '.join(failed) or 'no robot is in the folder'}")


if __name__ == "__main__":
    main()
