"""Columns of Polars and PyArrow: the numbers of arrays, their memory, and what is refused."""

import numpy as np
import pytest

import rne
from rne.columns import views

arm = rne.robots.puma560
random = np.random.default_rng(8)
q, qd, qdd = random.normal(size=(3, 500, 6))
tau = arm.inverse_dynamics(q, qd, qdd)
mass = arm.mass_matrix(q)


def polars_forms():
    polars = pytest.importorskip("polars")
    array = lambda x: polars.Series("x", x, dtype=polars.Array(polars.Float64, 6))
    yield array
    yield lambda x: polars.concat([array(x[:200]), array(x[200:])], rechunk=False)
    yield lambda x: polars.Series("x", x.tolist(), dtype=polars.List(polars.Float64))
    yield lambda x: polars.DataFrame({f"x{joint}": x[:, joint] for joint in range(6)})
    yield lambda x: polars.concat([array(x[:7]), array(x)])[7:]


def pyarrow_forms():
    pyarrow = pytest.importorskip("pyarrow")
    lists = lambda x: pyarrow.FixedSizeListArray.from_arrays(pyarrow.array(x.ravel()), 6)
    table = lambda x: pyarrow.table({f"x{joint}": np.ascontiguousarray(x[:, joint]) for joint in range(6)})
    yield lists
    yield lambda x: pyarrow.array(x.tolist())
    yield lambda x: pyarrow.array(x.tolist(), pyarrow.large_list(pyarrow.float64()))
    yield lambda x: pyarrow.chunked_array([lists(x[:200]), lists(x[200:])])
    yield lambda x: lists(np.vstack([x[:7], x])).slice(7)
    yield table
    yield lambda x: table(x).to_batches()[0]
    yield lambda x: pyarrow.concat_tables([table(x[:200]), table(x[200:])])


@pytest.mark.parametrize("forms", [polars_forms, pyarrow_forms])
def test_columns_have_the_numbers_of_arrays(forms):
    for form in forms():
        assert np.array_equal(arm.inverse_dynamics(form(q), form(qd), form(qdd)), tau)
        assert np.array_equal(arm.inverse_dynamics(form(q), qd, form(qdd)), tau)
        assert np.array_equal(arm.mass_matrix(form(q)), mass)
        row = np.zeros(6)
        assert np.array_equal(arm.inverse_dynamics(form(q), row, row), arm.inverse_dynamics(q, row, row))


@pytest.mark.parametrize("forms", [polars_forms, pyarrow_forms])
def test_wrenches_may_be_columns(forms):
    wrench = random.normal(size=(500, 6))
    expected = arm.inverse_dynamics_with_wrench(q, qd, qdd, wrench)
    for form in forms():
        assert np.array_equal(arm.inverse_dynamics_with_wrench(form(q), qd, qdd, form(wrench)), expected)


def addresses(seen):
    arrays = seen if isinstance(seen, tuple) else (seen,)
    return [array.__array_interface__["data"][0] for array in arrays]


def test_memory_is_that_of_the_columns():
    polars, pyarrow = pytest.importorskip("polars"), pytest.importorskip("pyarrow")
    lists = polars.Series(q, dtype=polars.Array(polars.Float64, 6))
    assert addresses(views(lists, 6, "q")) == [lists.to_arrow().flatten().buffers()[1].address]
    lists = polars.Series(q.tolist(), dtype=polars.List(polars.Float64))
    start = lists.to_arrow().flatten().buffers()[1].address
    assert addresses(views(lists, 6, "q")) == [start]
    assert addresses(views(lists[3:], 6, "q")) == [start + 3 * 48]
    table = polars.DataFrame({f"q{joint}": q[:, joint] for joint in range(6)})
    assert addresses(views(table, 6, "q")) == [c.to_arrow().buffers()[1].address for c in table.get_columns()]
    numbers = pyarrow.array(q.ravel())
    lists = pyarrow.FixedSizeListArray.from_arrays(numbers, 6)
    assert addresses(views(lists, 6, "q")) == [numbers.buffers()[1].address]
    assert addresses(views(lists.slice(3), 6, "q")) == [numbers.buffers()[1].address + 3 * 48]
    lists = pyarrow.array(q.tolist())
    assert addresses(views(lists, 6, "q")) == [lists.values.buffers()[1].address]


def test_what_is_refused():
    polars, pyarrow = pytest.importorskip("polars"), pytest.importorskip("pyarrow")
    lists = lambda rows, inner=polars.Float64: polars.Series("pos", rows, dtype=polars.List(inner))
    row = [0.0] * 6
    cases = [
        (lists([row, None]), "column 'pos': there are nulls"),
        (lists([row, row[:5] + [None]]), "column 'pos': there are nulls"),
        (lists([row, row[:5]]), "the list of row 1 has 5 numbers, not 6"),
        (polars.Series("pos", [row[:5]], dtype=polars.Array(polars.Float64, 5)), "its lists have 5 numbers, not 6"),
        (lists([["a"] * 6], polars.String), "column 'pos'"),
        (polars.Series("pos", [1.0]), "column 'pos': it is no column of lists of 6 numbers"),
        (polars.DataFrame({"a": [1.0], "b": [2.0]}), "2 columns, not 6: a, b"),
        (polars.DataFrame({f"x{j}": [1.0, None if j == 3 else 1.0] for j in range(6)}), "column 'x3': there are nulls"),
        (polars.DataFrame({f"x{j}": ["a" if j == 2 else "b"] for j in range(6)}), "column 'x0'"),
        (pyarrow.array([row, None]), "`q`: there are nulls"),
        (pyarrow.array([row, row[:5] + [None]]), "there are nulls"),
        (pyarrow.array([row, row[:5]]), "its lists have 5, 6 numbers, not 6"),
        (pyarrow.array([1.0, 2.0]), "double is no list of 6 numbers"),
        (pyarrow.table({"a": [1.0]}), "1 columns, not 6: a"),
    ]
    for value, words in cases:
        with pytest.raises(ValueError, match=words.replace("(", r"\(")):
            arm.gravity_torques(value)
    with pytest.raises(TypeError, match="`collect` makes one"):
        arm.gravity_torques(polars.DataFrame({"a": [1.0]}).lazy())
    with pytest.raises(ValueError, match="`qd` has 3 states, but other arguments have 500"):
        arm.inverse_dynamics(q, polars.DataFrame({f"x{j}": [0.0] * 3 for j in range(6)}), qdd)
    with pytest.raises(ValueError, match="1 state"):
        arm.inverse_dynamics(q, polars.DataFrame({f"x{j}": [0.0] for j in range(6)}), qdd)


@pytest.mark.parametrize("forms", [polars_forms, pyarrow_forms])
def test_no_rows(forms):
    for form in forms():
        empty = form(q)[:0] if forms is polars_forms else form(q).slice(0, 0)
        assert arm.gravity_torques(empty).shape == (0, 6)
