"""The verdict on an identified model, in sentences."""


class Verdict:
    """Which joints a model predicts, and what the logs do not determine.

    The fields are those of `verdict` in `rne identify --json`: `errors_on` (`fitted` or `held_out`), `limit` (the largest
    error of a joint that counts as predicted, in parts of the deviation of its effort), `predicted` and `not_predicted`
    (names of joints), `base_parameters`, `excited_base_parameters`, `not_excited_base_parameters`, `frictions`,
    `excited_frictions` and `not_excited_friction`. `lines` are the sentences, and `str` joins them.
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
        part = _percent(doubt["part_of_squared_error"])
        return (
            f"it stands still from {doubt['from']:.1f} to {doubt['until']:.1f} s, and its friction at rest is not known "
            f"({part} of its squared error arises at rest)"
        )
    if reason == "held_out_error_grown":
        fitted = joint["fitted"]["error"]
        return f"its error is {doubt['factor']:.1f} times the error on the fitted part ({_percent(fitted)})"
    return {
        "unexplained": "no model of this arm explains its efforts",
        "not_excited": "its torque in this log is mostly noise",
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
    first = f"The model {does} {_counted(len(predicted), len(joints), 'joint')} on {data}"
    errors = [error(joint) for joint in predicted if error(joint) is not None]
    if errors:
        least, most = _percent(min(errors)), _percent(max(errors))
        words = least if least == most else f"{least.removesuffix(' %')} to {most}"
        noun = "an error" if len(errors) == 1 else "errors"
        first += f", with {noun} of {words} of the standard deviation of the measured torque"
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
    if not unknown:
        return [said + "."]
    return [
        f"{said}. It does not excite {_enumerated(unknown)}.",
        "To excite more, record the motion that rne.excite(robot) designs.",
    ]
