"""Columns of Polars and PyArrow as arrays, where their memory allows without a copy.

Every function of an arm takes them in place of an array: a column of lists (`List`, `Array`, PyArrow's list types), each
of them one state, or a table (`DataFrame`, `Table`, `RecordBatch`) whose columns are the numbers of a state, base to tip.
Columns of several chunks are joined, which copies. Null is no number: it is refused, by the column's name.
"""


NULLS = "there are nulls, which are not numbers: drop or fill them before"


def views(value, elements, name):
    """What numpy sees of a column or a table: an array (N, elements) or a tuple of arrays (N,); else None."""
    package = type(value).__module__.partition(".")[0]
    if package == "polars":
        return _of_polars(value, elements, name)
    if package == "pyarrow":
        return _of_pyarrow(value, elements, name)
    return None


def _refused(name, column, why):
    where = f"`{name}`, column {column!r}" if column else f"`{name}`"
    return ValueError(f"{where}: {why}")


def _of_polars(value, elements, name):
    import polars

    if isinstance(value, polars.DataFrame):
        columns = [(column.name, column) for column in value.get_columns()]
        return _table(columns, elements, name, lambda column: column.to_numpy())
    if not isinstance(value, polars.Series):
        kind = type(value).__name__
        raise TypeError(f"`{name}` is a {kind}: a Series or a DataFrame has numbers; `collect` makes one")
    column = value
    if isinstance(column.dtype, (polars.List, polars.Array)):
        if column.null_count():
            raise _refused(name, column.name, NULLS)
        if not isinstance(column.dtype.inner, polars.Array) and not column.dtype.inner.is_numeric():
            raise _refused(name, column.name, f"it has {column.dtype.inner}, which are no numbers")
    if isinstance(column.dtype, polars.List):
        lengths = column.list.len()
        if not (lengths == elements).all():
            odd = (lengths != elements).arg_max()
            raise _refused(name, column.name, f"the list of row {odd} has {lengths[odd]} numbers, not {elements}")
        column = column.cast(polars.Array(column.dtype.inner, elements))
    if isinstance(column.dtype, polars.Array):
        if column.dtype.shape != (elements,):
            found = "x".join(str(length) for length in column.dtype.shape)
            raise _refused(name, column.name, f"its lists have {found} numbers, not {elements}")
        inner = column.explode() if len(column) else column
        if inner.null_count():
            raise _refused(name, column.name, NULLS)
        return inner.to_numpy().reshape(len(column), elements)
    if elements == 1:
        return _table([(column.name, column)], 1, name, lambda column: column.to_numpy())
    raise _refused(name, column.name, f"it is no column of lists of {elements} numbers, nor a table of as many columns")


def _table(columns, elements, name, view):
    if len(columns) != elements:
        names = ", ".join(str(column) for column, _ in columns)
        raise _refused(name, None, f"the table has {len(columns)} columns, not {elements}: {names}")
    arrays = []
    for label, column in columns:
        if column.null_count if isinstance(column.null_count, int) else column.null_count():
            raise _refused(name, label, NULLS)
        array = view(column)
        if array.dtype.kind not in "fiu":
            raise _refused(name, label, f"it has {array.dtype}, which are no real numbers")
        arrays.append(array)
    return tuple(arrays)


def _of_pyarrow(value, elements, name):
    import pyarrow

    def view(column):
        chunk = column.combine_chunks() if isinstance(column, pyarrow.ChunkedArray) else column
        if isinstance(chunk, pyarrow.ChunkedArray):
            chunk = chunk.chunk(0) if chunk.num_chunks else pyarrow.array([], chunk.type)
        return chunk.to_numpy(zero_copy_only=False)

    if isinstance(value, (pyarrow.Table, pyarrow.RecordBatch)):
        return _table(list(zip(value.schema.names, value.columns)), elements, name, view)
    if isinstance(value, pyarrow.ChunkedArray):
        chunks = value.chunks
        value = chunks[0] if len(chunks) == 1 else pyarrow.concat_arrays(chunks or [pyarrow.array([], value.type)])
    if not isinstance(value, pyarrow.Array):
        raise TypeError(f"`{name}` is a {type(value).__name__}: an Array, a ChunkedArray or a Table has numbers")
    kinds = pyarrow.types
    if not (kinds.is_fixed_size_list(value.type) or kinds.is_list(value.type) or kinds.is_large_list(value.type)):
        if elements == 1:
            return _table([(None, value)], 1, name, view)
        raise _refused(name, None, f"{value.type} is no list of {elements} numbers, nor a table of as many columns")
    if value.null_count:
        raise _refused(name, None, NULLS)
    if kinds.is_fixed_size_list(value.type):
        widths = {value.type.list_size} if len(value) else set()
    else:
        widths = set(value.value_lengths().unique().to_pylist())
    if widths - {elements}:
        found = ", ".join(str(width) for width in sorted(widths))
        raise _refused(name, None, f"its lists have {found} numbers, not {elements}")
    inner = value.flatten()
    if inner.null_count:
        raise _refused(name, None, NULLS)
    return view(inner).reshape(len(value), elements)
