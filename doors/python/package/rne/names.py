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


def of_pose(pose, argument):
    """Homogeneous matrices, (4, 4) or (N, 4, 4), as arrays of twelve numbers: rows of the rotation, then the origin.

    Rotations are checked to 1e-4, as single precision has them. A matrix with a NaN passes: its results are NaN.
    """
    array = numpy.ma.asanyarray(pose)
    if array.ndim not in (2, 3) or array.shape[-2:] != (4, 4):
        raise ValueError(f"`{argument}`: a pose has the shape (4, 4) or (N, 4, 4), not {array.shape}")
    rotation = array[..., :3, :3]
    if rotation.dtype.kind in "fiu":
        x, y, z = (rotation[..., row, :].astype(float) for row in range(3))
        errors = [(x * x).sum(-1) - 1, (y * y).sum(-1) - 1, (x * y).sum(-1), *numpy.moveaxis(z - numpy.cross(x, y), -1, 0)]
        if numpy.any([numpy.abs(error) > 1e-4 for error in errors]):
            raise ValueError(
                f"`{argument}` is no rigid pose: the three rows of its rotation must have the length 1, be at right angles "
                "to each other, and be right-handed"
            )
        if numpy.any(numpy.abs(array[..., 3, :].astype(float) - [0, 0, 0, 1]) > 1e-4):
            raise ValueError(f"`{argument}` is no homogeneous matrix: its last row must be 0, 0, 0, 1")
    numbers = (rotation.reshape(*array.shape[:-2], 9), array[..., :3, 3])
    numbers = numpy.ma.concatenate(numbers, axis=-1)
    return numbers if numpy.ma.is_masked(array) else numpy.asarray(numbers)


def of_tips(wrenches, tips, argument):
    """Wrenches by tip, a dict or an array (tips, 6) or (N, tips, 6), as an array of 6 numbers per tip, one after the other."""
    known = ", ".join(tips)
    if isinstance(wrenches, dict):
        for name in wrenches:
            if name not in tips:
                raise ValueError(f"`{argument}`: there is no tip `{name}`; this arm has {known}")
        wrenches = [wrenches.get(name, [0.0] * 6) for name in tips]
        follows = not any(hasattr(wrench, "dtype") for wrench in wrenches)
        arrays = [numpy.ma.asanyarray(wrench) for wrench in wrenches]
        if any(array.ndim not in (1, 2) or array.shape[-1] != 6 for array in arrays):
            raise ValueError(f"`{argument}`: a wrench has the shape (6,) or (N, 6): force, then moment")
        lengths = {len(array) for array in arrays if array.ndim == 2} - {1}
        if len(lengths) > 1:
            raise ValueError(f"`{argument}`: arrays have {' and '.join(map(str, sorted(lengths)))} states")
        # what is left out has no precision of its own
        dtype = numpy.result_type(*(w if hasattr(w, "dtype") else 0.0 for w in wrenches))
        array = numpy.ma.stack(numpy.broadcast_arrays(*arrays, subok=True), axis=-2).astype(dtype)
    else:
        follows = not hasattr(wrenches, "dtype")
        array = numpy.ma.asanyarray(wrenches)
    return rows(array, (len(tips), 6), argument, f"; the tips of this arm are {known}", follows)


def of_rotation(rotation, argument):
    """A rotation matrix, an array (3, 3) or (N, 3, 3), as an array of its 9 numbers, row by row."""
    return rows(numpy.ma.asanyarray(rotation), (3, 3), argument, "", not hasattr(rotation, "dtype"))


def of_number(number, argument):
    """A number, or one for each of N states, as an array of shape (1,) or (N, 1)."""
    array = numpy.ma.asanyarray(number)
    if array.dtype.kind not in "fiub":
        raise TypeError(f"`{argument}` is not a real number")
    if numpy.ma.is_masked(array):
        raise ValueError(f"`{argument}`: there are masked elements, which are not numbers: drop or fill them before")
    if array.ndim > 1:
        raise ValueError(f"`{argument}` has the shape {array.shape}; it is a number for all states or (N,) for many")
    array = numpy.asarray(array).reshape(*array.shape, 1)
    # a number follows the precision of the arrays
    return array if array.ndim == 2 and hasattr(number, "dtype") else array.tolist()


def of_vector(vector, length, argument):
    """Numbers of one state or of many, as an array of shape (length,) or (N, length) of single or double precision."""
    try:
        array = numpy.ma.asanyarray(vector)
    except ValueError:
        array = numpy.ma.asanyarray(None)  # rows of different lengths
    if array.dtype.kind not in "fiub":
        raise TypeError(f"`{argument}` is not an array of real numbers")
    if numpy.ma.is_masked(array):
        raise ValueError(f"`{argument}`: there are masked elements, which are not numbers: drop or fill them before")
    if array.ndim not in (1, 2) or array.shape[-1] != length:
        raise ValueError(f"`{argument}` has the shape {array.shape}; it is ({length},) for one state or (N, {length}) for many")
    array = numpy.asarray(array)
    return array if array.dtype == numpy.float32 else array.astype(float)


def of_joints(arm, values, argument):
    """Numbers of the joints of an arm, an array or a dict by their names, as an array of shape (n,) or (N, n)."""
    if isinstance(values, dict):
        values = in_order(values, arm.joints, argument, "joint")
    return of_vector(values, arm.dof, argument)


def have_one_count(arrays):
    """Refuses arrays (N, …) of different numbers of states; one of a single state serves all."""
    counts = {name: len(array) for name, array in arrays.items() if array.ndim == 2 and len(array) != 1}
    for name, count in counts.items():
        for other, expected in counts.items():
            if count != expected:
                raise ValueError(f"`{other}` has {expected} states, but `{name}` has {count}")


def rows(array, shape, argument, known, follows):
    """Rows of numbers, or those of N states, one after the other; lists follow the precision of other arguments."""
    if array.dtype.kind not in "fiub":
        raise TypeError(f"`{argument}` is not an array of real numbers")
    if numpy.ma.is_masked(array):
        raise ValueError(f"`{argument}`: there are masked elements, which are not numbers: drop or fill them before")
    if array.ndim not in (2, 3) or array.shape[-2:] != shape:
        wanted = ", ".join(map(str, shape))
        raise ValueError(f"`{argument}` has the shape {array.shape}, not ({wanted}) or (N, {wanted}){known}")
    flat = numpy.asarray(array).reshape(*array.shape[:-2], shape[0] * shape[1])
    return flat.tolist() if follows else flat


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
