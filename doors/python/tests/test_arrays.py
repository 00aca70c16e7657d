"""Layouts, precisions, room for results, and what is refused."""

import functools
import pickle
import threading

import numpy as np
import pytest

import rne

arm = rne.robots.puma560
random = np.random.default_rng(6)
q, qd, qdd = random.normal(size=(3, 200, 6))
tau = arm.inverse_dynamics(q, qd, qdd)


def test_layouts_do_not_matter():
    for change in (np.asfortranarray, lambda x: np.repeat(x, 2, axis=0)[::2], lambda x: x[::-1].copy()[::-1],
                   lambda x: np.hstack([x, x])[:, :6], list):
        assert np.array_equal(arm.inverse_dynamics(change(q), change(qd), change(qdd)), tau)


def test_a_row_stands_for_all():
    for row in (np.zeros(6), np.zeros((1, 6)), [0] * 6):
        assert np.array_equal(arm.inverse_dynamics(q, row, row), arm.inverse_dynamics(q, 0 * q, 0 * q))
    assert arm.inverse_dynamics(q[0], qd, qdd[:1]).shape == (200, 6)


def test_single_precision_is_kept():
    single = arm.inverse_dynamics(*(x.astype(np.float32) for x in (q, qd, qdd)))
    assert single.dtype == np.float32
    assert np.abs(single - tau).max() < 1e-4 * np.abs(tau).max()
    assert arm.inverse_dynamics(q.astype(np.float32), qd, qdd).dtype == np.float64
    assert arm.inverse_dynamics(q.astype(np.float32), [0] * 6, [0] * 6).dtype == np.float32


def test_integers_and_lists_are_numbers():
    assert np.array_equal(arm.gravity_torques([0] * 6), arm.gravity_torques(np.zeros(6)))
    assert np.array_equal(arm.gravity_torques(np.zeros(6, dtype=int)), arm.gravity_torques(np.zeros(6)))


def test_out():
    room = np.full((200, 6), np.nan)
    assert arm.inverse_dynamics(q, qd, qdd, out=room) is room
    assert np.array_equal(room, tau)
    for wrong in (np.zeros((6, 200)), np.zeros((200, 6), dtype=np.float32), np.zeros((6, 200)).T, [[0.0] * 6] * 200):
        with pytest.raises(ValueError, match="`out` must be a writable array"):
            arm.inverse_dynamics(q, qd, qdd, out=wrong)
    frozen = np.zeros((200, 6))
    frozen.flags.writeable = False
    same = q.copy()
    for wrong in (frozen, same):
        with pytest.raises(ValueError, match="`out`"):
            arm.inverse_dynamics(same, qd, qdd, out=wrong)


def test_no_states():
    assert arm.inverse_dynamics(*np.zeros((3, 0, 6))).shape == (0, 6)
    assert arm.mass_matrix(np.zeros((0, 6))).shape == (0, 6, 6)


@pytest.mark.parametrize("wrong, says", [
    ((q[:, :5], qd, qdd), r"`q` has the shape \(200, 5\); it is \(6,\) for one state or \(N, 6\) for many"),
    ((q, qd[:7], qdd), "`qd` has 7 states, but other arguments have 200"),
    ((q, qd, np.zeros(())), r"`qdd` has the shape \(\)"),
    ((q[None], qd, qdd), r"`q` has the shape \(1, 200, 6\)"),
])
def test_wrong_shapes(wrong, says):
    with pytest.raises(ValueError, match=says):
        arm.inverse_dynamics(*wrong)


@pytest.mark.parametrize("wrong", ["text", None, object(), q * 1j, [["a"] * 6]])
def test_no_numbers(wrong):
    with pytest.raises((TypeError, ValueError), match="`q`"):
        arm.inverse_dynamics(wrong, qd, qdd)


def test_mistakes_in_files_have_line_and_column():
    text = arm.yaml.replace("type: revolute", "type: revolut", 1)
    line = next(number for number, words in enumerate(text.splitlines(), 1) if "revolut," in words or words.endswith("revolut"))
    with pytest.raises(rne.RobotFileError, match="revolut") as found:
        rne.load(text)
    assert found.value.line == line and found.value.column > 0
    with pytest.raises(FileNotFoundError):
        rne.load("no_such_file.yaml")
    with pytest.raises(AttributeError, match="puma560"):
        rne.robots.puma
    with pytest.raises(ValueError, match="seven_steps"):
        rne.load(arm.yaml, form="seven")
    with pytest.raises(rne.RobotFileError):
        rne.load("<robot name='r'><link name='a'/></robot>")


def test_a_source_is_a_shipped_robot_a_urdf_or_a_robot_file(tmp_path):
    assert rne.load("puma560").yaml == arm.yaml
    with pytest.raises(FileNotFoundError, match="did you mean the shipped robot puma560"):
        rne.load("puma")
    with pytest.raises(KeyError, match="did you mean `puma560`"):
        rne.robots["puma"]
    inertial = "<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>"
    links = "".join(f"<link name='{name}'>{inertial}</link>" for name in ["base", "a", "b"])
    joint = "<joint name='{0}{1}' type='continuous'><parent link='{0}'/><child link='{1}'/></joint>"
    tree = f"<robot name='r'>{links}{joint.format('base', 'a')}{joint.format('base', 'b')}</robot>"
    # by its content, whatever its name is
    file = tmp_path / "tree.xml"
    file.write_text(tree)
    with pytest.raises(rne.RobotFileError, match='name the tip with tip="LINK"'):
        rne.load(file)
    assert rne.load(file, tip="a", lock_others=True).dof == 1


def test_files_and_their_plans(tmp_path):
    file = tmp_path / "arm.yaml"
    file.write_text(arm.yaml)
    bare = rne.load(file)
    assert np.allclose(bare.inverse_dynamics(q, qd, qdd), tau, rtol=0, atol=1e-11)
    (tmp_path / "arm.plan.yaml").write_text("nonsense")
    with pytest.raises(rne.RobotFileError):
        rne.load(str(file))


def test_pickle_and_copies():
    import copy

    searched = rne.load(arm.yaml).search(0.0)
    for original in (arm, searched, rne.load(arm.yaml, form="seven_steps")):
        expected = original.inverse_dynamics(q, qd, qdd)
        for other in (pickle.loads(pickle.dumps(original)), copy.copy(original), copy.deepcopy(original)):
            assert other.form == original.form and np.array_equal(other.inverse_dynamics(q, qd, qdd), expected)


def test_threads_share_an_arm():
    fresh = rne.load(arm.yaml.replace("name: puma560", "name: puma_of_threads", 1))
    found = [None] * 8

    def work(index):
        found[index] = fresh.inverse_dynamics(q, qd, qdd)

    threads = [threading.Thread(target=work, args=(index,)) for index in range(8)]
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    assert all(np.array_equal(one, found[0]) for one in found)


def test_insight():
    assert "joint 2" in arm.show(joint=2) and "w2_z" in arm.show(joint=2)
    with pytest.raises(IndexError, match="1 to 6"):
        arm.show(joint=7)
    assert "puma560_inverse_dynamics" in arm.code("c")
    assert "fn inverse_dynamics" in arm.code("rust")
    with pytest.raises(ValueError, match="c or rust"):
        arm.code("fortran")
    html = arm._repr_html_()
    assert html.count("<table>") == 2 and html.count("<details>") == 6 and "q6" in html and "w6_z" in html
    assert html.count("<tr>") == 1 + 6 + 1 + 2 * 6, "the table, and counts in both forms"
    assert "&lt;" not in arm.name and "<script" not in html and len(html) < 60_000
    assert all(len(robot._repr_html_()) < 100_000 for robot in map(rne.robots.__getitem__, rne.robots))
    told = arm.diagnose(q[0], qd[0], qdd[0], -tau[0])
    assert not told["agrees"] and told["explanations"]
    assert arm.diagnose(q[0], qd[0], qdd[0], tau[0])["agrees"]
    # right are 14.541 and 2.4086: each number may be off by half of its last digit
    rods = functools.partial(rne.robots.planar2.diagnose, [0.3, 0.4], [0.1, 0.2], [0.5, 0.6])
    assert rods([14.5, 2.4])["agrees"] and rods([14.54, 2.4])["agrees"] and rods([14.5, 2.41])["agrees"]
    assert not rods([14.51, 2.4])["agrees"] and not rods([14.5, 2.4], tolerance=1e-6)["agrees"]
    assert repr(arm) == "<rne.Arm puma560: 6 joints, standard, reduced>"


def test_a_search_tells_its_progress_and_passes_errors_on():
    told = []
    found = rne.load(arm.yaml).search(1.0, progress=lambda over, operations: told.append((over, operations)))
    assert found.operations()["total"] <= rne.load(arm.yaml).operations()["total"]
    assert told and all(0 <= over <= 1 for over, _ in told)

    def broken(*_):
        raise RuntimeError("of the caller")

    with pytest.raises(RuntimeError, match="of the caller"):
        rne.load(arm.yaml).search(5.0, progress=broken)
