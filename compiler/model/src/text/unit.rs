//! Help for units after numbers: numbers of a robot file have no unit, and a message gives the number to write instead.

/// Returns the help for a `number` with a `unit` after it; `None` where the word is no unit.
///
/// The units of a robot file are rad, m, kg, s and N. The functions `deg`, `mm` and `g` convert degrees, millimetres
/// and grams.
pub(crate) fn instead(number: &str, unit: &str) -> Option<String> {
    if number.is_empty() || unit.len() > 16 {
        return None;
    }
    // `kg m²`, `kg*m^2` and `kg·m2` are one unit.
    let unit: String = unit
        .chars()
        .filter(|c| !matches!(c, ' ' | '*' | '·' | '⋅' | '^'))
        .map(|c| match c {
            '²' => '2',
            '−' => '-',
            c => c,
        })
        .collect();
    let literal = number.parse::<f64>().is_ok();
    let times = |what: &str, factor: &str| {
        let number = if literal { number.to_owned() } else { format!("({number})") };
        format!("{what}: write `{number}{factor}`")
    };
    let as_it_is = |what: &str| match unit.as_str() {
        "m" => format!("{what}: write `{number}` alone; a product is written `{number}*{unit}`"),
        _ => format!("{what}: write `{number}` alone"),
    };
    let (lengths, masses, inertias) = ("lengths are in metres", "masses are in kilograms", "inertias are in kg m²");
    Some(match unit.as_str() {
        "°" | "deg" | "degree" | "degrees" => format!("angles are in radians: write `deg({number})`"),
        "rad" => as_it_is("angles are in radians"),
        "m" => as_it_is(lengths),
        "cm" => times(lengths, "/100"),
        "mm" => format!("{lengths}: write `mm({number})`"),
        "in" | "inch" | "inches" => times(lengths, "*0.0254"),
        "kg" => as_it_is(masses),
        "g" => format!("{masses}: write `g({number})`"),
        "lb" | "lbs" => times(masses, "*0.45359237"),
        "kgm2" => as_it_is(inertias),
        "kgcm2" => times(inertias, "*1e-4"),
        "kgmm2" => times(inertias, "*1e-6"),
        "gcm2" => times(inertias, "*1e-7"),
        "gmm2" => times(inertias, "*1e-9"),
        "m/s2" => as_it_is("accelerations are in m/s²"),
        "rad/s" | "m/s" => as_it_is("speeds are in rad/s or m/s"),
        "deg/s" | "°/s" => format!("speeds are in rad/s or m/s: write `deg({number})`"),
        "mm/s" => times("speeds are in rad/s or m/s", "/1000"),
        "rpm" | "1/min" | "min-1" => times("speeds are in rad/s or m/s", "*2*pi/60"),
        "N" | "Nm" => as_it_is("forces are in N, torques in N m"),
        "kN" | "kNm" => times("forces are in N, torques in N m", "*1000"),
        _ => return None,
    })
}
