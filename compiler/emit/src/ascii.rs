//! Converts text to ASCII, for compilers, editors and terminals that cannot show other characters. Code is ASCII in any
//! case, so only comments and formulas change.

/// Superscripts, and below each of them the character that replaces it.
const RAISED: [&str; 2] = ["ᵀ⁻⁺⁰¹²³⁴⁵⁶⁷⁸⁹", "T-+0123456789"];

/// Letters with dots that are one character: the character, the plain letter, and the number of dots.
const DOTTED: [(char, char, usize); 8] = [
    ('Ġ', 'G', 1),
    ('Ṁ', 'M', 1),
    ('ḃ', 'b', 1),
    ('ċ', 'c', 1),
    ('ḋ', 'd', 1),
    ('ṡ', 's', 1),
    ('ẋ', 'x', 1),
    ('ẍ', 'x', 2),
];

/// Pairs of a character and its spelling in ASCII.
const SPELLINGS: &str = "\
    α alpha β beta γ gamma Δ Delta δ delta ε epsilon θ theta Θ Theta λ lambda μ mu π pi ρ rho Σ sum σ sigma τ tau \
    φ phi ψ psi Ω Omega ω w ∂ d · * × x − - – - — - ─ - ± +- ≤ <= ≥ >= → -> √ sqrt ∫ int ½ 1/2 ₀ 0 ₁ 1 ₂ 2 ₃ 3 ₖ k \
    … ... ’ ' ‘ ' “ \" ” \" ä a à a á a â a å a ç c è e é e ê e ë e ï i í i ñ n ö o ó o ô o ø o ü u ú u û u Ä A É E \
    Ö O Ü U ß ss";

/// Returns a text in which every character that is not ASCII is spelled out: ω is `w`, ω̇ `dw` and q̈ `qdd` as in the
/// code, so θ̈ is `thetadd`; × is `x`, ᵀ `^T`, s⁻² `s^-2`. A character without a spelling, such as a letter in a title,
/// becomes `_`.
#[must_use]
pub fn ascii(text: &str) -> String {
    let mut written = String::with_capacity(text.len());
    let mut characters = text.chars().peekable();
    let mut was_raised = false;
    while let Some(c) = characters.next() {
        let raised = RAISED[0].chars().zip(RAISED[1].chars()).find(|(from, _)| *from == c);
        if let Some((_, raised)) = raised {
            written.extend((!was_raised).then_some('^').into_iter().chain([raised]));
        } else {
            let (c, mut dots) =
                DOTTED.into_iter().find(|(dotted, ..)| *dotted == c).map_or((c, 0), |(_, letter, dots)| (letter, dots));
            while let Some(more) = characters.peek().and_then(|mark| dots_of(*mark)) {
                dots += more;
                characters.next();
            }
            write_letter(c, &"d".repeat(dots), &mut written);
        }
        was_raised = raised.is_some();
    }
    written
}

fn write_letter(c: char, dots: &str, written: &mut String) {
    match c {
        'q' => written.extend(["q", dots]),
        'θ' => written.extend(["theta", dots]),
        c if c.is_ascii() => written.extend([dots, c.encode_utf8(&mut [0])]),
        // a blank keeps `*` away from `/`, because compilers warn about `/*` in a comment
        '·' if dots.is_empty() && written.ends_with('/') => written.push_str(" *"),
        c => written.extend([dots, spelling(c)]),
    }
}

/// Returns the number of dots that a combining mark puts above the letter before it; `None` for other marks.
const fn dots_of(mark: char) -> Option<usize> {
    match mark {
        '\u{307}' => Some(1),
        '\u{308}' => Some(2),
        _ => None,
    }
}

fn spelling(c: char) -> &'static str {
    let mut words = SPELLINGS.split(' ');
    match c {
        '°' => " deg",
        '\u{A0}' => " ",
        _ => words.find(|word| word.chars().eq([c])).and_then(|_| words.next()).unwrap_or("_"),
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
        assert_eq!(ascii("G q̈ + Ġ q̇, Ġ q̇; Σ Jₖᵀ wₖ"), "G qdd + dG qd, dG qd; sum Jk^T wk");
        assert_eq!(ascii("M⁻¹ in s⁻¹², (Rᵀ)²"), "M^-1 in s^-12, (R^T)^2");
    }
}
