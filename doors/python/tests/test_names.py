"""Joints by name: dicts, and lists of names in the order of another program."""

import numpy as np
import pytest

import rne

ARM = rne.robots.puma560
N = 5
Q, QD, QDD, TAU = np.random.default_rng(11).normal(size=(4, N, 6))
# of another program: other order, and joints of its own
THEIRS = ["gripper", "j6", "j2", "lift", "j4", "j1", "j3", "j5"]
OURS = [name for name in THEIRS if name in ARM.joints]


def by_name(array):
    return dict(zip(reversed(ARM.joints), array.T[::-1]))


def test_a_dict_is_its_array():
    expected = ARM.inverse_dynamics(Q, QD, QDD)
    assert np.array_equal(ARM.inverse_dynamics(by_name(Q), by_name(QD), by_name(QDD)), expected)
    assert np.array_equal(ARM.inverse_dynamics(by_name(Q), QD, QDD), expected)
    one = dict(zip(ARM.joints, Q[0].tolist()))
    assert np.array_equal(ARM.mass_matrix(one), ARM.mass_matrix(Q[0]))
    mixed = by_name(Q) | {"j2": 0.5}
    assert np.array_equal(ARM.gravity_torques(mixed), ARM.gravity_torques(np.where(np.arange(6) == 1, 0.5, Q)))


def test_every_function_of_joints_takes_dicts():
    q, qd, qdd, tau = map(by_name, (Q, QD, QDD, TAU))
    for given, arrays, names in [
        ((q,), (Q,), ["jacobian", "pose", "operational_space_inertia", "potential_energy"]),
        ((q, qd), (Q, QD), ["coriolis_matrix", "bias_torques"]),
        ((q, qd, qdd), (Q, QD, QDD), ["regressor", "inverse_dynamics_on_moving_base"]),
        ((q, qd, tau), (Q, QD, TAU), ["forward_dynamics"]),
    ]:
        for name in names:
            function = getattr(ARM, name)
            assert np.array_equal(function(*given), function(*arrays)), name
    steps = np.stack([TAU] * 3, axis=1)[0]
    torques = dict(zip(ARM.joints, steps.T))
    for found, expected in zip(ARM.rollout(q, qd, torques, 1e-3), ARM.rollout(Q, QD, steps, 1e-3)):
        assert np.array_equal(found, expected)


def test_the_precision_is_that_of_the_arrays():
    single = {name: column.astype(np.float32) for name, column in by_name(Q).items()}
    assert ARM.gravity_torques(single).dtype == np.float32
    numbers = dict.fromkeys(ARM.joints, 0)
    assert ARM.bias_torques(Q.astype(np.float32), numbers).dtype == np.float32


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda q: q.pop("j3"), "`q`: the value of `j3` is missing; this arm has j1, j2"),
        (lambda q: q.update(elbow=0.0), "`q`: there is no joint `elbow`; this arm has j1, j2"),
        (lambda q: q.update(j2=[0.1, 0.2]), "`q`: arrays have 2 and 5 states"),
        (lambda q: q.update(j2="0.1"), "`q`: `j2` is no real number"),
        (lambda q: q.update(j2=np.ma.masked_array([0.1] * 5, [0, 0, 1, 0, 0])), "`q`, `j2`: there are masked elements"),
    ],
)
def test_a_wrong_dict_names_the_joint(change, message):
    q = by_name(Q)
    change(q)
    with pytest.raises((TypeError, ValueError), match=message):
        ARM.gravity_torques(q)


def test_columns_of_tables_are_values():
    polars = pytest.importorskip("polars")
    q = {name: polars.Series(column) for name, column in by_name(Q).items()}
    assert np.array_equal(ARM.gravity_torques(q), ARM.gravity_torques(Q))
    q["j4"] = polars.Series([0.1, None, 0.2, 0.3, 0.4])
    with pytest.raises(ValueError, match="`q`.*nulls"):
        ARM.gravity_torques(q)


def test_an_order_reads_and_writes_the_array_of_another_program():
    order = ARM.order(OURS)
    assert order.dtype == np.intp and order.tolist() == [OURS.index(name) for name in ARM.joints]
    assert ARM.order(ARM.joints).tolist() == list(range(6))
    theirs = np.arange(6.0)
    q = theirs[order]
    assert q.tolist() == [OURS.index(name) for name in ARM.joints]
    written = np.zeros(6)
    written[order] = q
    assert np.array_equal(written, theirs)


def test_extra_takes_names_of_other_joints():
    order = ARM.order(THEIRS, extra=True)
    assert [THEIRS[place] for place in order] == ARM.joints
    theirs = np.full((N, 8), np.nan)
    theirs[:, order] = Q
    assert np.array_equal(theirs[:, order], Q) and np.isnan(theirs[:, [0, 3]]).all()
    with pytest.raises(ValueError, match="there is no joint `gripper`; this arm has j1, .*; extra=True"):
        ARM.order(THEIRS)


@pytest.mark.parametrize(
    ("names", "message"),
    [
        (OURS[1:], "the joint `j6` is missing"),
        ([*OURS, "j2"], "the joint `j2` is there twice"),
        (OURS[1:] + ["wrist"], "there is no joint `wrist`"),
        ("j1", "`names` is the text 'j1'; write a list"),
        ([], "the joint `j1` is missing"),
    ],
)
def test_a_wrong_list_names_the_joint(names, message):
    for extra in (False, True):
        if extra and "no joint" in message:
            message = "the joint `j6` is missing"
        with pytest.raises((TypeError, ValueError), match=message):
            ARM.order(names, extra=extra)
