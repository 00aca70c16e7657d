//! Text in ASCII alone, for compilers, editors and terminals that know nothing else. Code is ASCII as it is; what
//! changes are comments and formulas.

/// A text with every letter that is not ASCII written out: ω is `w`, ω̇ `dw` and q̈ `qdd` as in the code, so θ̈ is
/// `thetadd`; × is `x`, ᵀ `^T`, s⁻² `s^-2`. What has no such spelling, as a letter of a title may, is `_`.
#[must_use]
pub fn ascii(text: &str) -> String {
    let mut written = String::with_capacity(text.len());
    let mut characters = text.chars().peekable();
    let mut was_raised = false;
    while let Some(c) = characters.next() {
        if let Some(raised) = raised(c) {
            written.extend((!was_raised).then_some('^').into_iter().chain([raised]));
            was_raised = true;
            continue;
        }
        was_raised = false;
        let mut dots = 0;
        while let Some(more) = characters.peek().and_then(|mark| dots_of(*mark)) {
            dots += more;
            characters.next();
        }
        // one character for a letter and its dot
        let (c, dots) = match c {
            'Ṁ' => ('M', dots + 1),
            'ċ' => ('c', dots + 1),
            'ḋ' => ('d', dots + 1),
            'ẋ' => ('x', dots + 1),
            'ẍ' => ('x', dots + 2),
            c => (c, dots),
        };
        let dots = "d".repeat(dots);
        match c {
            c if dots.is_empty() && c.is_ascii() => written.push(c),
            'q' => written.extend(["q", &dots]),
            'θ' => written.extend(["theta", &dots]),
            c => {
                written.push_str(&dots);
                let mut ascii = [0; 4];
                let spelling = if c.is_ascii() { &*c.encode_utf8(&mut ascii) } else { spelling(c) };
                // no `*` after a `/`: compilers warn of comments inside comments
                written.push_str(if spelling == "*" && written.ends_with('/') { " *" } else { spelling });
            }
        }
    }
    written
}

/// The dots that a mark puts above the letter before it.
const fn dots_of(mark: char) -> Option<usize> {
    match mark {
        '\u{307}' => Some(1),
        '\u{308}' => Some(2),
        _ => None,
    }
}

/// What an exponent is on the line.
const fn raised(c: char) -> Option<char> {
    Some(match c {
        'ᵀ' => 'T',
        '⁻' => '-',
        '⁺' => '+',
        '⁰' => '0',
        '¹' => '1',
        '²' => '2',
        '³' => '3',
        '⁴' => '4',
        '⁵' => '5',
        '⁶' => '6',
        '⁷' => '7',
        '⁸' => '8',
        '⁹' => '9',
        _ => return None,
    })
}

fn spelling(c: char) -> &'static str {
    match c {
        'α' => "alpha",
        'β' => "beta",
        'γ' => "gamma",
        'Δ' => "Delta",
        'δ' => "delta",
        'ε' => "epsilon",
        'θ' => "theta",
        'Θ' => "Theta",
        'λ' => "lambda",
        'μ' => "mu",
        'π' => "pi",
        'ρ' => "rho",
        'Σ' => "sum",
        'σ' => "sigma",
        'τ' => "tau",
        'φ' => "phi",
        'ψ' => "psi",
        'Ω' => "Omega",
        'ω' => "w",
        '∂' => "d",
        '·' => "*",
        '×' => "x",
        '−' | '–' | '—' | '─' => "-",
        '±' => "+-",
        '≤' => "<=",
        '≥' => ">=",
        '→' => "->",
        '√' => "sqrt",
        '∫' => "int",
        '½' => "1/2",
        '₀' => "0",
        '₁' => "1",
        '₂' => "2",
        '₃' => "3",
        '°' => " deg",
        '…' => "...",
        '’' | '‘' => "'",
        '“' | '”' => "\"",
        'ä' | 'à' | 'á' | 'â' | 'å' => "a",
        'ç' => "c",
        'è' | 'é' | 'ê' | 'ë' => "e",
        'ï' | 'í' => "i",
        'ñ' => "n",
        'ö' | 'ó' | 'ô' | 'ø' => "o",
        'ü' | 'ú' | 'û' => "u",
        'Ä' => "A",
        'É' => "E",
        'Ö' => "O",
        'Ü' => "U",
        'ß' => "ss",
        '\u{A0}' => " ",
        _ => "_",
    }
}

#[cfg(test)]
mod tests {
    use super::ascii;

    #[test]
    fn letters_are_those_of_the_code() {
        assert_eq!(ascii("ω3 = R3ᵀ ω2 + q̇3 e"), "w3 = R3^T w2 + qd3 e");
        assert_eq!(ascii("ω̇, ċ and c̈, q̈ in m/s²; Ṁ - 2C = ∂τ/∂q̇"), "dw, dc and ddc, qdd in m/s^2; dM - 2C = dtau/dqd");
        assert_eq!(ascii("a/·b — 腕"), "a/ *b - _");
        assert_eq!(ascii("θ̇1² + θ̈2 sin² θ1 - γ1"), "thetad1^2 + thetadd2 sin^2 theta1 - gamma1");
        assert_eq!(ascii("d3, ḋ3, d̈3"), "d3, dd3, ddd3");
        assert_eq!(ascii("M⁻¹ in s⁻¹², (Rᵀ)²"), "M^-1 in s^-12, (R^T)^2");
    }
}
