"""Run-time parameters by name."""

import numpy


def in_order(values, names):
    """The values of a dict, each a number or an array (N,), as an array (n,) or (N, n) in the order of the names."""
    known = ", ".join(names)
    for name in values:
        if name not in names:
            raise ValueError(f"`parameters`: there is no run-time parameter `{name}`; this arm has {known}")
    for name in names:
        if name not in values:
            raise ValueError(f"`parameters`: the value of `{name}` is missing; this arm has {known}")
    values = [values[name] for name in names]
    if all(isinstance(value, (int, float)) for value in values):
        return values
    for at, (name, value) in enumerate(zip(names, values)):
        array = numpy.ma.asanyarray(value)
        if array.dtype.kind not in "fiub" or array.ndim > 1:
            raise TypeError(f"`parameters`: `{name}` is no real number and no array (N,) of real numbers")
        if numpy.ma.is_masked(array):
            raise ValueError(f"`parameters`, `{name}`: there are masked elements, which are not numbers: drop or fill them before")
        if not isinstance(value, (int, float)):
            values[at] = numpy.asarray(value)
    lengths = {len(value) for value in values if numpy.ndim(value)}
    if len(lengths - {1}) > 1:
        raise ValueError(f"`parameters`: arrays have {' and '.join(map(str, sorted(lengths)))} states")
    dtype = numpy.result_type(*values)
    return numpy.stack(numpy.broadcast_arrays(*values), axis=-1).astype(dtype)
