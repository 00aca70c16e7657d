"""Numbers by name: dicts of joints or of run-time parameters, and lists of joints in another order; names of arms."""

import hashlib

import numpy

from ._rne import __version__
from .columns import views


def in_order(values, names, argument, kind):
    """The values of a dict, each a number or an array (N,), as an array (n,) or (N, n) in the order of the names.

    Messages call the dict `argument`, and its keys names of a `kind`.
    """
    known = ", ".join(names)
    for name in values:
        if name not in names:
            raise ValueError(f"`{argument}`: there is no {kind} `{name}`; this arm has {known}")
    for name in names:
        if name not in values:
            raise ValueError(f"`{argument}`: the value of `{name}` is missing; this arm has {known}")
    values = [values[name] for name in names]
    if all(isinstance(value, (int, float)) for value in values):
        return values
    for at, (name, value) in enumerate(zip(names, values)):
        column = views(value, 1, argument)
        if column is not None:
            (value,) = column
        array = numpy.ma.asanyarray(value)
        if array.dtype.kind not in "fiub" or array.ndim > 1:
            raise TypeError(f"`{argument}`: `{name}` is no real number and no array (N,) of real numbers")
        if numpy.ma.is_masked(array):
            raise ValueError(f"`{argument}`, `{name}`: there are masked elements, which are not numbers: drop or fill them before")
        if not isinstance(value, (int, float)):
            values[at] = numpy.asarray(value)
    lengths = {len(value) for value in values if numpy.ndim(value)}
    if len(lengths - {1}) > 1:
        raise ValueError(f"`{argument}`: arrays have {' and '.join(map(str, sorted(lengths)))} states")
    dtype = numpy.result_type(*values)
    return numpy.stack(numpy.broadcast_arrays(*values), axis=-1).astype(dtype)


def of_tips(wrenches, tips, argument):
    """Wrenches by the names of tips as an array (tips, 6) or (N, tips, 6), or as lists where no wrench is an array."""
    for name in wrenches:
        if name not in tips:
            raise ValueError(f"`{argument}`: there is no tip `{name}`; this arm has {', '.join(tips)}")
    wrenches = [wrenches.get(name, [0.0] * 6) for name in tips]
    arrays = [numpy.ma.asanyarray(wrench) for wrench in wrenches]
    if any(array.ndim not in (1, 2) or array.shape[-1] != 6 for array in arrays):
        raise ValueError(f"`{argument}`: a wrench has the shape (6,) or (N, 6): force, then moment")
    lengths = {len(array) for array in arrays if array.ndim == 2} - {1}
    if len(lengths) > 1:
        raise ValueError(f"`{argument}`: arrays have {' and '.join(map(str, sorted(lengths)))} states")
    array = numpy.ma.stack(numpy.broadcast_arrays(*arrays, subok=True), axis=-2)
    if not (any(hasattr(wrench, "dtype") for wrench in wrenches) or numpy.ma.is_masked(array)):
        return array.tolist()
    # what is left out has no precision of its own
    return array.astype(numpy.result_type(*(w if hasattr(w, "dtype") else 0.0 for w in wrenches)))


def order(joints, names, extra, followers):
    """The place of each joint in a list of names, as an array of integers (n,).

    `followers` has the names of the joints that follow others, and the names of these others.
    """
    if isinstance(names, str):
        raise TypeError(f"`names` is the text {names!r}; write a list of names")
    names = list(names)
    known = ", ".join(joints)
    for name in names:
        if name in followers and not extra:
            followed = " and ".join(f"`{joint}`" for joint in followers[name])
            raise ValueError(f"`names`: `{name}` follows {followed}, so q has no element for it; leave it out, or give extra=True")
        if name not in joints and not extra:
            raise ValueError(f"`names`: there is no joint `{name}`; this arm has {known}; extra=True allows other names")
    for joint in joints:
        if joint not in names:
            raise ValueError(f"`names`: the joint `{joint}` is missing; this arm has {known}")
        if names.count(joint) > 1:
            raise ValueError(f"`names`: the joint `{joint}` is there twice")
    return numpy.array([names.index(joint) for joint in joints], dtype=numpy.intp)


def of_content(arm, frame):
    """A name of an arm, or of an arm at a frame, that tells its content: programs that name it may be kept in files."""
    content = repr((__version__, arm.__reduce__()[1], frame))
    return f"{arm.name}-{hashlib.sha256(content.encode()).hexdigest()[:32]}"
