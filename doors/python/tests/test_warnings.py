"""Files that are valid and probably wrong: `rne.load` warns; and a URDF is the same arm here and on the command line."""

import os
import subprocess
import warnings

import numpy as np
import pytest

import rne

HEAD = "format: 1\nname: x\nsource: own\nconvention: standard\ngravity: [0, 0, -9.81]\njoints:\n"
ROW = "  - {type: revolute, dh: {theta: 0, d: 0.1, a: 0.3, alpha: 0}"
BALL = "<inertia ixx='0.01' iyy='0.01' izz='0.01' ixy='0' ixz='0' iyz='0'/>"


def urdf(inertial, roll="1.5708", joints=3):
    """A chain of links of half a metre; `inertial` has the mass of each link."""
    links = "".join(f"<link name='l{i}'>{inertial(i)}</link>" for i in range(joints + 1))
    joint = ("<joint name='j{0}' type='revolute'><parent link='l{0}'/><child link='l{1}'/><origin xyz='0.5 0 0' "
             "rpy='{2} 0 0'/><axis xyz='0 0 1'/><limit lower='-1' upper='1' effort='1' velocity='1'/></joint>")
    return f"<robot name='chain'>{links}{''.join(joint.format(i, i + 1, roll) for i in range(joints))}</robot>"


def ball(mass):
    return f"<inertial><mass value='{mass}'/>{BALL}</inertial>"


def warned(source, **options):
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        rne.load(source, **options)
    assert all(one.category is rne.RobotFileWarning and one.filename == __file__ for one in found)
    return [str(one.message) for one in found]


def test_an_arm_without_inertia():
    assert issubclass(rne.RobotFileWarning, UserWarning)
    [text] = warned(urdf(lambda _: ""))
    assert text.startswith("<text>: no link has a mass or an inertia: the file has the geometry only\n")
    assert "--" not in text and "identify the links from a log" in text
    [text] = warned(HEAD + (ROW + "}\n") * 3)
    assert text.startswith("<text>:7:3: no link has a mass")


def test_placeholders_of_an_exporter(tmp_path):
    file = tmp_path / "robot.urdf"
    file.write_text(urdf(lambda _: ball(2.0), joints=6))
    light, same = warned(file)
    assert same.startswith(f"{file}: 6 of 6 links with mass have 2 kg and 0.01 kg m² about every axis")
    assert light.startswith(f"{file}: all links together have 12 kg, which is little for an arm with a reach of ")
    # masses that differ a little
    [light] = warned(urdf(lambda i: ball(2 + i / 10), joints=6))
    assert "14.1 kg" in light


def test_good_arms_are_quiet_and_filters_work():
    assert warned(urdf(lambda i: ball(8 + i))) == []
    for name in rne.robots:
        assert warned(name) == [] and warned(rne.robots[name].yaml) == [], name
    with warnings.catch_warnings():
        warnings.simplefilter("error", rne.RobotFileWarning)
        with pytest.raises(rne.RobotFileWarning):
            rne.load(urdf(lambda _: ""))


def test_one_file_gives_a_few_warnings():
    row = ROW.replace("alpha: 0}", "alpha: 90}") + ", link: {mass: 3, com: [-0.1, 0, 0], inertia: {zz: 0.1}}}\n"
    found = warned(HEAD + row * 12)
    assert len(found) == 9 and "rne check" in found[-1]
    assert found[0].startswith("<text>:7:") and "write `deg(90)`" in found[0]


def test_limits_that_are_ignored_and_degrees_in_a_urdf():
    good = urdf(lambda i: ball(8 + i))
    [text] = warned(good.replace("lower='-1' upper='1' effort='1'", "lower='2' upper='-1' effort='1'", 1))
    assert text == "<text>: the joint j0 has a lower limit, 2, above its upper limit, -1; rne ignores both limits"
    [text] = warned(good.replace("effort='1'", "effort='-1'", 1))
    assert text == "<text>: the joint j0 has a negative limit of effort, -1; rne ignores it"
    [text] = warned(good.replace("rpy='1.5708 0 0'", "rpy='90 0 0'", 1))
    assert text.startswith("<text>: joint j0 has the angle 90 rad in its rpy, more than a turn")
    [text] = warned(good.replace("lower='-1' upper='1'", "lower='-170' upper='170'", 1))
    assert text.startswith("<text>: ") and "degrees" in text


def test_a_urdf_is_snapped_as_on_the_command_line(tmp_path):
    file = tmp_path / "chain.urdf"
    file.write_text(urdf(lambda i: ball(8 + i)))
    arm, kept = rne.load(file), rne.load(file, snap=False)
    q = np.random.default_rng(3).normal(size=(20, 3))
    difference = np.abs(arm.gravity_torques(q) - kept.gravity_torques(q)).max()
    assert 0 < difference < 1e-3 and "pi/2" in arm.yaml and warned(file, snap=False) == []
    if "RNE" not in os.environ:
        pytest.skip("RNE does not name the command rne")
    command = [os.environ["RNE"], "import", "--frames", file]
    assert subprocess.run(command, capture_output=True, text=True, check=True).stdout == arm.yaml


def test_a_repair_is_proposed_as_data(tmp_path):
    for name in rne.robots:
        assert rne.repair(name) == rne.repair(rne.robots[name].yaml) == [], name
    unlike = urdf(lambda i: ball(8 + i).replace("'0.01' iyy='0.01'", "'0.013' iyy='0.012'"))
    for text, number in [(rne.robots.iiwa14.yaml, "0.033"), (unlike, "0.012")]:
        assert rne.repair(text) == []
        wrong = text.replace(number, f"-{number}", 1)
        assert wrong != text
        file = tmp_path / "arm"
        file.write_text(wrong)
        [finding] = rne.repair(file)
        assert finding == rne.repair(wrong)[0] and finding["equal"] == 1 and finding["failed"], finding
        repair = finding["candidates"][0]
        assert repair["complete"] and repair["failed"] == [] and repair["mistake"]
        [change] = repair["changes"]
        lines = wrong.splitlines(keepends=True)
        assert (finding["line"], finding["column"]) == (change["line"], change["column"])
        rest = "".join([lines[change["line"] - 1][change["column"] - 1 :], *lines[change["line"] :]])
        assert rest.startswith(change["old"])
        assert wrong.removesuffix(rest) + change["new"] + rest.removeprefix(change["old"]) == text
        if "RNE" in os.environ:
            command = [os.environ["RNE"], "check", "--repair", file]
            shown = subprocess.run(command, capture_output=True, text=True).stdout
            assert f"{file}:{change['line']}:{change['column']}: " in shown and repair["mistake"] in shown
    with pytest.raises(rne.RobotFileError):
        rne.repair("<robot><link></robot>\n")
    with pytest.raises(FileNotFoundError):
        rne.repair("nowhere.yaml")
