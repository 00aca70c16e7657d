"""The verdict on an identified model, in sentences."""


class Verdict:
    """Which joints a model predicts, and what the logs do not determine.

    The fields are those of `verdict` in `rne identify --json`: `errors_on` (`fitted` or `held_out`), `limit` (the largest
    error of a joint that counts as predicted, in parts of the deviation of its effort), `predicted` and `not_predicted`
    (names of joints), `base_parameters`, `excited_base_parameters`, `not_excited_base_parameters`, `frictions`,
    `excited_frictions`, `not_excited_friction` and `not_excited_offset`. `lines` are the sentences, and `str` joins them.
    """

    def __init__(self, reply):
        self.__dict__.update(reply["verdict"])
        self.lines = _lines(reply)

    def __str__(self):
        return "\n".join(self.lines)

    def __repr__(self):
        return f"<rne.Verdict: {self.lines[0]}>"


def _percent(part):
    if part is None:
        return "no error"
    return f"{100 * part:.1f} %" if 100 * part < 9.95 else f"{100 * part:.0f} %"


def _counted(count, total, noun):
    if count == 0:
        return f"no {noun}"
    if count == total:
        return f"the {noun}" if total == 1 else f"all {total} {noun}s"
    return f"{count} of {total} {noun}s"


def _enumerated(words):
    return " and ".join(filter(None, [", ".join(words[:-1]), *words[-1:]]))


def _reason(doubt, joint, rows):
    """A reason for doubt, in words; None for an error that has only grown."""
    reason, unit = doubt["reason"], joint["unit"]
    if reason == "offset":
        return f"it has an offset of {doubt['offset']:.3f} {unit}, more than a robot file can store"
    if reason == "outliers":
        return f"{doubt['rows']} of {rows} rows are outliers, the first at {doubt['first']:.1f} s"
    if reason == "standstill":
        said = f"it stands still from {doubt['from']:.1f} to {doubt['until']:.1f} s, where static friction is not known"
        moving = doubt["error_in_motion"]
        return said if moving is None else f"{said}; in motion, its error is {_percent(moving)}"
    if reason == "held_out_error_grown":
        return f"its error is {_percent(joint['fitted']['error'])} on the fitted part only"
    return {
        "unexplained": "no model of this arm explains its efforts",
        "not_excited": "most of its unfiltered torque is noise",
        "friction_not_excited": "the log does not excite its friction",
        "without_friction": "the robot file has no friction for it",
    }.get(reason)


def _lines(reply):
    verdict, joints = reply["verdict"], reply["joints"]
    is_fitted = verdict["errors_on"] == "fitted"
    does = "reproduces" if is_fitted else "predicts"
    data = "the data that it was fitted to" if is_fitted else "held-out data"

    def error(joint):
        return joint[verdict["errors_on"]]["error"]

    predicted = [joint for joint in joints if joint["predicted"]]
    first = f"The model {does} the torque of {_counted(len(predicted), len(joints), 'joint')} on {data}"
    errors = [error(joint) for joint in predicted if error(joint) is not None]
    if errors:
        least, most = _percent(min(errors)), _percent(max(errors))
        words = least if least == most else f"{least.removesuffix(' %')} to {most}"
        noun = "an RMS error" if len(errors) == 1 else "RMS errors"
        first += f", with {noun} of {words} of its standard deviation (limit: {_percent(verdict['limit'])})"
    lines = [first + "."]
    if is_fitted:
        lines.append("hold_out=0.3 computes errors on data that the model was not fitted to.")
    for joint in joints:
        if joint["predicted"]:
            continue
        doubts = [one for one in joint["doubts"] if len(joint["doubts"]) == 1 or one["reason"] != "held_out_error_grown"]
        reasons = list(filter(None, (_reason(doubt, joint, reply["rows"]) for doubt in doubts)))
        fails = "not reproduced" if is_fitted else "not predicted"
        why = ": " + "; ".join(reasons) if reasons else ", and no cause is known"
        lines.append(f"{joint['name']} ({_percent(error(joint))}) is {fails}{why}.")
    return lines + _excited(verdict)


def _excited(verdict):
    known = _counted(verdict["excited_base_parameters"], verdict["base_parameters"], "base parameter")
    said = f"The log determines {known}"
    if verdict["frictions"]:
        said += f" and the friction of {_counted(verdict['excited_frictions'], verdict['frictions'], 'joint')}"
    unknown = [f"{name}" for name in verdict["not_excited_base_parameters"]]
    if verdict["not_excited_friction"]:
        unknown.append(f"the friction of {_enumerated(verdict['not_excited_friction'])}")
    offsets = []
    if verdict["not_excited_offset"]:
        offsets = [
            f"The log does not determine the offset of {_enumerated(verdict['not_excited_offset'])}: gravity hides it. The "
            "ratio of the Coulomb friction in both directions stays that of the robot file, or 1 if it has no friction."
        ]
    if not unknown:
        return [said + ".", *offsets]
    return [
        *offsets,
        f"{said}, but not {_enumerated(unknown)}: the model holds for similar motions only.",
        "rne.excite(robot) designs a better motion; after such a motion, take more `evaluations` or `seconds`.",
    ]
