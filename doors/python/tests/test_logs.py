"""Logs, identification and watching: the numbers are those of the command line, whatever the source of the log."""

import json
import os
import signal
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest

import rne

# what is warned of has a test of its own
pytestmark = pytest.mark.filterwarnings("ignore::UserWarning")

LOGS = Path(__file__).parents[3] / "logs/identify/tests/logs"
ARMS = ["ur10", "panda"]


def log_of(name):
    return LOGS / f"{name}.csv"


def robot_of(name):
    return LOGS / f"{name}_log.yaml"


def table_of(name):
    """The columns of a log by their names."""
    header, *_ = log_of(name).read_text().splitlines()
    numbers = np.loadtxt(log_of(name), delimiter=",", skiprows=1)
    return dict(zip(header.split(","), numbers.T))


def part_of(table, start, end):
    return {name: column[start:end] for name, column in table.items()}


def write(table, path):
    rows = zip(*(column.tolist() for column in table.values()))
    lines = [",".join(table), *(",".join(map(repr, row)) for row in rows)]
    path.write_text("\n".join(lines) + "\n")
    return path


@pytest.fixture(scope="module")
def program():
    """The command line that `cargo xtask python` built."""
    path = os.environ.get("RNE")
    if not path:
        pytest.skip("RNE is not set to the program `rne`; `cargo xtask python` sets it")
    return path


@pytest.fixture(scope="module")
def command_line(program):
    """Calls the command line, and reads its JSON."""

    def call(*arguments):
        called = subprocess.run([program, *map(str, arguments), "--json"], capture_output=True, text=True, check=False)
        assert called.stdout, called.stderr
        return json.loads(called.stdout)

    return call


@pytest.fixture(scope="module", params=ARMS)
def name(request):
    return request.param


@pytest.fixture(scope="module")
def identified(name):
    return rne.identify(robot_of(name), log_of(name), hold_out=0.3)


def assert_same(found, expected, place=""):
    """The same structure with the same numbers, to 1e-12 of themselves."""
    if isinstance(expected, dict):
        assert isinstance(found, dict) and set(found) >= set(expected), place
        for key in expected:
            assert_same(found[key], expected[key], f"{place}.{key}")
    elif isinstance(expected, list):
        assert len(found) == len(expected), place
        for at, (one, other) in enumerate(zip(found, expected)):
            assert_same(one, other, f"{place}[{at}]")
    elif isinstance(expected, float):
        assert found == pytest.approx(expected, rel=1e-12, abs=1e-300), place
    else:
        assert found == expected, place


def test_log_is_that_of_the_command_line(name, command_line):
    expected = command_line("log", log_of(name), "--robot", robot_of(name))
    # remedies are keywords here and options there
    assert len(expected.pop("notes")) == len(rne.log(log_of(name), robot_of(name)).notes)
    assert_same(rne.log(log_of(name), robot_of(name)).summary, expected)


def test_motion_is_that_of_the_command_line(name, command_line, tmp_path):
    path = tmp_path / "motion.csv"
    command_line("log", log_of(name), "--robot", robot_of(name), "-o", path)
    written = np.loadtxt(path, delimiter=",", skiprows=1)
    log = rne.log(log_of(name), robot_of(name))
    ours = np.column_stack([log.time, log.q, log.qd, log.qdd, log.tau, log.run])
    np.testing.assert_allclose(ours, written, rtol=1e-12, atol=0)
    assert log.q.shape == (len(log.time), len(log.joints))


def test_identification_is_that_of_the_command_line(name, identified, command_line, tmp_path):
    path = tmp_path / "identified.yaml"
    expected = command_line("identify", robot_of(name), log_of(name), "--hold-out", "0.3", "-o", path)
    for joint in expected["joints"]:
        assert joint.pop("judged") is None
    assert_same(identified.joints, expected["joints"], "joints")
    assert_same(identified.parameters, expected["base_parameters"], "base_parameters")
    assert_same(identified.friction, expected["friction"], "friction")
    assert_same(identified.delay, expected["delay"], "delay")
    assert_same(identified.held_out, expected["held_out"], "held_out")
    assert_same(vars(identified.verdict), expected["verdict"], "verdict")
    assert (identified.states, identified.cutoff) == (expected["states"], pytest.approx(expected["cutoff"], rel=1e-12))
    assert identified.robot_file == path.read_text()


def test_a_written_table_is_read_everywhere(program, tmp_path):
    pandas, polars, pyarrow = (pytest.importorskip(name) for name in ("pandas", "polars", "pyarrow.parquet"))
    path = tmp_path / "motion.parquet"
    subprocess.run([program, "log", log_of("panda"), "-o", path], check=True, capture_output=True, timeout=60)
    log = rne.log(log_of("panda"))
    table = pyarrow.read_table(path)
    frames = [pandas.read_parquet(path), polars.read_parquet(path), {name: table[name] for name in table.column_names}]
    for frame in frames:
        for name in ("q", "qd", "qdd", "tau"):
            column = frame[name]
            rows = np.array(column.to_pylist() if hasattr(column, "to_pylist") else [list(row) for row in column])
            np.testing.assert_allclose(rows, getattr(log, name), rtol=1e-12, atol=0)
        np.testing.assert_allclose(np.asarray(frame["time"], dtype=float), log.time, rtol=1e-12, atol=0)
    assert rne.log(path).q.shape[1] == 7


def test_bags_are_logs():
    log = rne.log(Path(__file__).parents[3] / "logs/read/tests/data/ur10.db3")
    assert len(log.joints) == 6 and log.q.shape == log.tau.shape == (len(log.time), 6)


DOCS = Path(__file__).parents[3] / "docs"


def test_a_payload_is_that_of_the_command_line(command_line, tmp_path):
    path = tmp_path / "loaded.yaml"
    robot, log = DOCS / "desk_arm_identified.yaml", DOCS / "desk_arm_loaded.csv"
    expected = command_line("identify", robot, log, "--payload", "-o", path)
    found = rne.identify_payload(robot, log)
    assert found.found and found.robot_file == path.read_text()
    for key in ("mass", "com", "inertia"):
        assert_same(getattr(found, key), expected["payload"][key], key)
    assert_same(found.joints, expected["joints"], "joints")
    assert_same(found.delay, expected["delay"], "delay")
    # the log of the arm alone shows none; an arm without masses cannot tell
    quiet = rne.identify_payload(robot, DOCS / "desk_arm_log.csv")
    assert not quiet.found and str(quiet).startswith("no payload")
    with pytest.raises(ValueError, match="rne.identify"):
        rne.identify_payload(robot_of("ur10"), log_of("ur10"))


def test_an_identified_payload_is_an_argument_in_tip_axes():
    """The tip is turned and 0.2 m away from the last link: what is found is what the log was computed with."""
    text = rne.robots.iiwa14.yaml
    [tool] = [line for line in text.splitlines() if line.startswith("tool:")]
    arm = rne.load(text.replace(tool, "tool: {xyz: [0.05, -0.03, 0.2], rpy: [0.4, -pi/4, 1.1]}"))
    motion = rne.excite(arm, seconds=10, evaluations=20, rate=100)
    truth = rne.payload(2.0, [0.03, -0.02, 0.06], np.diag([0.004, 0.005, 0.003]))
    rng = np.random.default_rng(7)
    tau = arm.inverse_dynamics(motion.q, motion.qd, motion.qdd, payload=truth)
    tau = tau + 0.02 * rng.normal(size=tau.shape)
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        found = rne.identify_payload(arm, {"time": motion.time, "q": motion.q, "qd": motion.qd, "tau": tau})
    assert not [one for one in said if "does not name its joints" in str(one.message)]
    assert found.found and found.payload.shape == (10,) and "tip axes" in str(found)
    assert abs(found.payload[0] - truth[0]) < 0.1 and np.abs(found.payload[1:4] - truth[1:4]).max() < 0.02
    assert [number["value"] for number in found.com] == list(found.payload[1:4])
    for number, true in zip(found.com, truth[1:4]):
        assert abs(number["value"] - true) < 3 * number["deviation"]
    # the same body in the robot file and as an argument
    q, qd, qdd = rng.normal(size=(3, 20, arm.dof))
    given = arm.inverse_dynamics(q, qd, qdd, payload=found.payload)
    written = found.arm.inverse_dynamics(q, qd, qdd)
    np.testing.assert_allclose(given, written, atol=1e-7 * np.abs(given).max())
    # its weight, by numpy: the work of gravity at its centre of mass
    at = lambda q: (arm.pose(q) @ np.append(found.payload[1:4], 1.0))[..., :3]
    change = np.eye(arm.dof) * 1e-6
    slope = np.stack([(at(q[0] + step) - at(q[0] - step)) / 2e-6 for step in change])
    weight = -found.payload[0] * slope @ np.asarray(arm.gravity)
    found_weight = arm.gravity_torques(q[0], payload=found.payload) - arm.gravity_torques(q[0])
    np.testing.assert_allclose(found_weight, weight, atol=1e-6)


def test_the_identified_arm_predicts_the_log(identified, name):
    log = rne.log(log_of(name), robot_of(name), cutoff=identified.cutoff)
    arm = identified.arm
    predicted = arm.inverse_dynamics(log.q, log.qd, log.qdd) + arm.actuator_torques(log.qd, log.qdd)
    errors = np.sqrt(np.mean((predicted - log.tau) ** 2, axis=0)) / np.std(log.tau, axis=0)
    for of, error in zip(identified.joints, errors):
        # behind another filter, and with the part that was fitted to: near, not the same
        assert not of["predicted"] or error < 1.5 * identified.verdict.limit, of["name"]


def test_the_verdict_comes_first(identified, name):
    lines = identified.verdict.lines
    predicted, count = len(identified.verdict.predicted), len(identified.joints)
    assert lines[0].startswith("The model predicts the torque of ") and " on held-out data, with RMS errors of " in lines[0]
    assert (f"{predicted} of {count} joints" if predicted < count else f"all {count} joints") in lines[0]
    for joint in identified.verdict.not_predicted:
        assert any(line.startswith(joint) and "is not predicted" in line for line in lines[1:])
    assert "The log determines" in str(identified) and str(identified) == "\n".join(lines)
    fitted = rne.identify(robot_of(name), log_of(name), friction=False)
    assert fitted.verdict.errors_on == "fitted" and fitted.friction == []
    assert fitted.verdict.lines[0].startswith("The model reproduces ")
    assert fitted.verdict.lines[1].startswith("hold_out=0.3 ")
    assert identified._repr_svg_().startswith("<svg")


def test_watch_is_that_of_the_command_line(name, identified, command_line, tmp_path):
    arm = tmp_path / "arm.yaml"
    identified.save(arm)
    table = table_of(name)
    middle = int(0.6 * len(table["time"]))
    quiet = write(part_of(table, 0, middle), tmp_path / "quiet.csv")
    worn = part_of(table, middle, None)
    # elbow of the UR10, joint 5 of the Panda: twice the Coulomb friction
    joint = {"ur10": 3, "panda": 5}[name]
    friction = identified.friction[joint - 1]["coulomb_forward"]["value"]
    worn[f"tau{joint}"] = worn[f"tau{joint}"] + friction * np.tanh(worn[f"qd{joint}"] / 0.01)
    log = write(worn, tmp_path / "worn.csv")
    saved = tmp_path / "baseline.yaml"
    expected = command_line("watch", arm, log, "--quiet", quiet, "--save-baseline", saved)
    found = rne.watch(identified.arm, log, quiet=quiet)
    assert_same(found.events, expected["events"], "events")
    assert_same(found.parameters, expected["parameters"], "parameters")
    assert_same(found.joints, expected["joints"], "joints")
    assert [(event["cause"], event["joint"]) for event in found.events] == [("friction", joint)]
    assert str(found).startswith(f"friction of {found.events[0]['name']}: coulomb ")
    assert found.baseline.text == saved.read_text()
    # a baseline that was saved does what the quiet log does, and so do tables
    found.baseline.save(tmp_path / "ours.yaml")
    for baseline in (found.baseline, tmp_path / "ours.yaml"):
        assert_same(rne.watch(arm, log, baseline=baseline).events, found.events)
    assert_same(rne.watch(identified.arm, worn, quiet=part_of(table, 0, middle)).events, found.events)
    assert found._repr_svg_().startswith("<svg")


def test_trend_is_that_of_the_command_line(name, identified, command_line, tmp_path):
    arm = tmp_path / "arm.yaml"
    identified.save(arm)
    table = table_of(name)
    middle = int(0.6 * len(table["time"]))
    one = write(part_of(table, 0, middle), tmp_path / "one.csv")
    two = write(part_of(table, middle, None), tmp_path / "two.csv")
    expected = command_line("watch", arm, one, two, "--by", "log")
    found = rne.watch(identified.arm, [one, two], by="log")
    assert_same(found.trend, expected["logs"])
    assert [row["log"] for row in found.trend] == ["one.csv", "two.csv"]
    assert found.csv.startswith("log,") and len(found.csv.splitlines()) == 3
    assert found._repr_svg_().startswith("<svg")
    assert found.baseline is None


def test_days_are_groups_of_logs(name, identified):
    table = table_of(name)
    start = np.datetime64("2026-11-23T23:00:00", "ns")

    def at(hours):
        dates = start + np.timedelta64(hours, "h") + (1e9 * table["time"]).astype("timedelta64[ns]")
        return {**table, "time": dates}

    found = rne.watch(identified.arm, [at(0), at(2), at(3)], by="day")
    assert [row["log"] for row in found.trend] == ["2026-11-23", "2026-11-24"]
    # two logs of a day tell more than one
    first, second = (row["joints"][0]["coulomb_deviation"] for row in found.trend)
    assert second < first


def test_quiet_logs_have_no_events(name, identified):
    found = rne.watch(identified.arm, log_of(name))
    assert found.events == [] and str(found) == "no events"


def test_tables_are_logs():
    pandas, polars, pyarrow = (pytest.importorskip(package) for package in ("pandas", "polars", "pyarrow"))
    table = table_of("ur10")
    blocks = {"time": table["time"]}
    for quantity in ("q", "qd", "tau"):
        blocks[quantity] = np.column_stack([table[f"{quantity}{joint}"] for joint in range(1, 7)])
    expected = rne.log(log_of("ur10"), robot_of("ur10"))
    lists = polars.DataFrame({name: column.tolist() for name, column in blocks.items()})
    dates = {**table, "time": (1.7e18 + 1e9 * table["time"]).astype("datetime64[ns]")}
    tables = [table, blocks, pandas.DataFrame(table), polars.DataFrame(table), pyarrow.table(table), lists]
    for one in [*tables, pandas.DataFrame(dates)]:
        log = rne.log(one, robot_of("ur10"))
        assert log.summary["states"] == 602
        is_dated = isinstance(one, pandas.DataFrame) and one["time"].dtype.kind == "M"
        # times of dates are counted in ns, and the filter's grid with them
        np.testing.assert_allclose(log.tau, expected.tau, rtol=1e-5 if is_dated else 0, atol=1e-5 if is_dated else 0)
    assert list(expected.to_pandas().columns) == expected.to_polars().columns == list(expected.columns())
    # what was filtered is a log again
    assert rne.log(expected.to_polars()).summary["states"] == len(expected.time)


def test_errors_name_keywords(tmp_path):
    with pytest.raises(FileNotFoundError, match="no_such.csv"):
        rne.log(tmp_path / "no_such.csv")
    with pytest.raises(TypeError, match="topik"):
        rne.log(log_of("ur10"), topik="x")
    with pytest.raises(ValueError, match="`angles` is \"degrees\" or \"radians\""):
        rne.log(log_of("ur10"), angles="grad")
    with pytest.raises(ValueError, match="`hold_out` lies between 0 and 1"):
        rne.identify(robot_of("ur10"), log_of("ur10"), hold_out=1.5)
    with pytest.raises(ValueError, match="columns of a table have one length"):
        rne.log({"time": [0.0, 1.0], "q1": [0.0]})
    with pytest.raises(TypeError, match="not a int"):
        rne.log(3)
    with pytest.raises(ValueError, match="`joints`"):
        rne.identify(robot_of("ur10"), log_of("ur10"), joints=["1", "2"])
    with pytest.raises(ValueError, match="`cutoff` can be from"):
        rne.identify(robot_of("ur10"), log_of("ur10"), cutoff=15.6)
    table = table_of("ur10")
    degrees = {name: np.degrees(column) if name[0] == "q" else column for name, column in table.items()}
    with pytest.raises(ValueError, match="angles=\"degrees\"") as refused:
        rne.identify(robot_of("ur10"), degrees)
    assert "--" not in str(refused.value)
    assert rne.identify(robot_of("ur10"), degrees, angles="degrees").states == 602
    without = {name: column for name, column in table.items() if not name.startswith("tau")}
    with pytest.raises(ValueError, match="the log has no efforts"):
        rne.watch(robot_of("ur10"), without)
    with pytest.raises(ValueError, match="`quiet` or `baseline`"):
        rne.watch(robot_of("ur10"), table, quiet=log_of("ur10"), baseline=rne.Baseline(""))
    with pytest.raises(ValueError, match="ur10.csv is also watched"):
        rne.watch(robot_of("ur10"), log_of("ur10"), quiet=[log_of("ur10")])
    with pytest.raises(ValueError, match="the times of table 1 are not dates"):
        rne.watch(robot_of("ur10"), table, by="day")
    (tmp_path / "words.csv").write_text("no log\nat all\n")
    with pytest.raises(ValueError, match="words.csv"):
        rne.log(tmp_path / "words.csv")
    with pytest.raises(rne.RobotFileError):
        rne.watch(robot_of("ur10"), log_of("ur10"), baseline=rne.Baseline("format: 1\n"))


def test_the_motion_that_excites_is_that_of_the_command_line(program, tmp_path):
    path = tmp_path / "motion.csv"
    arguments = ["--seconds", "5", "--rate", "50", "--evaluations", "60", "--velocity", "1.5"]
    subprocess.run([program, "excite", robot_of("ur10"), *arguments, "-o", path], capture_output=True, check=True)
    found = rne.excite(robot_of("ur10"), seconds=5, rate=50, evaluations=60, velocity=1.5)
    written = np.loadtxt(path, delimiter=",", skiprows=1)
    ours = np.column_stack([found.time, found.q, found.qd, found.qdd])
    np.testing.assert_allclose(ours, written, rtol=1e-12, atol=1e-15)
    assert np.abs(found.qd).max() <= 1.5 * (1 + 1e-9) and found.evaluations == 60
    assert list(found.to_polars().columns) == list(found.to_pandas().columns)
    with pytest.raises(ValueError, match="velocity has 2 numbers, but the robot has 6 joints"):
        rne.excite(robot_of("ur10"), velocity=[1, 2])
    with pytest.raises(ValueError, match="`harmonics`"):
        rne.excite(robot_of("ur10"), harmonics=1)


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="there is no timer of signals")
def test_a_signal_ends_reading(tmp_path):
    """Where a handler raises while Rust reads, the call ends there with what it raised."""
    table = table_of("ur10")
    # long enough that a timer rings before it is read
    long = {name: np.tile(column, 200) for name, column in table.items()}
    long["time"] = 0.032 * np.arange(len(long["time"]))
    path = write(long, tmp_path / "long.csv")
    arm = rne.load(robot_of("ur10"))
    ends = []

    def observe(_frame, event, function):
        if getattr(function, "__name__", "") == "watched":
            ends.append(event)

    def interrupt(_signal, _frame):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        sys.setprofile(observe)
        signal.setitimer(signal.ITIMER_REAL, 0.05)
        with pytest.raises(KeyboardInterrupt):
            rne.watch(arm, path)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        sys.setprofile(None)
        signal.signal(signal.SIGALRM, before)
    # the call into Rust did not return: it raised
    assert ends == ["c_call", "c_exception"]


def test_what_may_make_a_result_wrong_is_a_warning():
    with pytest.warns(UserWarning, match="derive_velocities=True ignores them") as warned:
        found = rne.identify(robot_of("panda"), log_of("panda"))
    assert warned[0].filename == __file__ and str(warned[0].message) in found.notes
    # a robot without friction and masses is none that explains a log
    with pytest.warns(UserWarning, match="the model explains nothing of the torques of "):
        rne.watch(robot_of("ur10"), log_of("ur10"))
    still = {name: np.zeros(400) for name in table_of("ur10")} | {"time": 0.01 * np.arange(400)}
    noise = np.random.default_rng(5)
    still |= {f"tau{joint}": noise.normal(size=400) for joint in range(1, 7)}
    with pytest.warns(UserWarning, match="nothing is excited"):
        nothing = rne.identify(robot_of("ur10"), still, cutoff=4)
    assert nothing.arm is None and nothing.robot_file is None
    with pytest.raises(ValueError, match="there is no robot file"):
        nothing.save("nothing.yaml")


def test_one_arm_of_a_table_with_two_is_read():
    table = Path(__file__).parents[3] / "docs/two_arms_log.csv"
    with pytest.raises(ValueError, match='where={"robot_id": "r1"}'):
        rne.log(table)
    assert rne.log(table, where={"robot_id": "r1"}).summary["states"] == 250
