//! The units of an FMU.

/// A unit: its name, and the exponents of kg, m, s and rad.
pub(super) type Unit = (&'static str, [i8; 4]);

/// All units; those of angles come first.
pub(super) const ALL: [Unit; 12] = [
    ("rad", [0, 0, 0, 1]),
    ("rad/s", [0, 0, -1, 1]),
    ("rad/s2", [0, 0, -2, 1]),
    ("N.m", [1, 2, -2, 0]),
    ("m", [0, 1, 0, 0]),
    ("m/s", [0, 1, -1, 0]),
    ("m/s2", [0, 1, -2, 0]),
    ("N", [1, 1, -2, 0]),
    ("kg", [1, 0, 0, 0]),
    ("kg.m", [1, 1, 0, 0]),
    ("kg.m2", [1, 2, 0, 0]),
    ("s", [0, 0, 1, 0]),
];

/// Returns the unit of a number of a robot file in the spelling of FMI; `None` if it is not in the list.
pub(super) fn of_file(unit: &str) -> Option<&'static str> {
    let name = unit.replace('²', "2").replace(' ', ".");
    ALL.iter().find(|(known, _)| *known == name).map(|(known, _)| *known)
}
