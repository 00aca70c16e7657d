//! Makes the sections of a closed form for a terminal or LaTeX: torques, M, h, γ, and the meaning of the letters.

use std::collections::BTreeSet;

use unicode_width::UnicodeWidthStr as _;

use crate::ClosedForm;
use crate::collected::Sum;
use crate::equations::Equations;
use crate::letters::letters;
use crate::lines::Pieces;
use crate::notation::{Notation, Script};
use crate::polynomial::Polynomial;
use crate::recursion;
use crate::symbol::Symbol;
use crate::written::{COLUMNS, Written};

/// Largest number of lines of a torque; a longer one is given only by its parts.
const MOST_LINES_OF_A_TORQUE: usize = 8;

/// A part of the document.
#[derive(Debug)]
pub(crate) struct Section {
    /// Words and formulas alternately, words first.
    pub(crate) title: Vec<String>,
    pub(crate) items: Vec<Item>,
}

/// A formula or words.
#[derive(Debug)]
pub(crate) enum Item {
    /// A formula left = right; `width` is that of the left side on a terminal, in columns.
    Formula { left: String, width: usize, right: Pieces },
    /// Words and formulas alternately, words first.
    Words(Vec<String>),
    /// Formulas in a row, each with words after it: the values of letters.
    List(Vec<(String, String)>),
}

/// Writes formulas in a script, and computes their width on a terminal.
pub(crate) struct Composer<'a> {
    pub(crate) notation: Notation<'a>,
    pub(crate) plain: Notation<'a>,
}

impl Composer<'_> {
    pub(crate) fn formula(&self, left: impl Fn(&Notation<'_>) -> String, right: Pieces) -> Item {
        Item::Formula { left: left(&self.notation), width: left(&self.plain).width(), right }
    }

    pub(crate) fn both(&self, of: impl Fn(&Notation<'_>) -> String) -> (String, String) {
        (of(&self.notation), of(&self.plain))
    }
}

/// Returns the sections of a closed form, or of the recursion if there is no closed form.
pub(crate) fn sections(form: &ClosedForm, script: Script) -> Vec<Section> {
    let kinds = crate::written::kinds(&form.table);
    let notation = Notation { script, constants: &form.table.constants, kinds: &kinds };
    let composer = Composer { notation, plain: Notation { script: Script::Unicode, ..notation } };
    let mut sections = Vec::new();
    if form.joints() < form.dof {
        let words = format!(
            "The first {} of {} joints: what joint {} carries is left away with its mass.",
            form.joints(),
            form.dof,
            form.joints() + 1
        );
        sections.push(Section { title: Vec::new(), items: vec![Item::Words(vec![words])] });
    }
    match &form.written {
        Ok((equations, written)) => {
            sections.push(torques(&composer, written));
            sections.push(mass_matrix(&composer, equations, written));
            sections.push(velocity(&composer, equations, written));
            sections.push(gravity(&composer, written));
            sections.extend(letters(&composer, &form.table, &used(equations.all())));
            if form.is_lagranges() == Some(true) {
                let words = "Checked: the seven steps and Lagrange's equations give the same polynomials, term by \
                             term; what stands here is these, collected.";
                sections.push(Section { title: Vec::new(), items: vec![Item::Words(vec![words.to_owned()])] });
            }
        }
        Err(_) => sections.extend(recursion::sections(&composer, form)),
    }
    sections
}

/// Makes a text of words only, without formulas.
pub(crate) fn words(text: &str) -> Vec<String> {
    vec![text.to_owned()]
}

fn math(notation: &Notation<'_>, unicode: &str, latex: &str) -> String {
    if notation.script == Script::Unicode { unicode.to_owned() } else { latex.to_owned() }
}

fn torques(composer: &Composer<'_>, written: &Written) -> Section {
    let notation = &composer.notation;
    let dof = written.torques.len();
    let lines = |sum: &Sum| Pieces::of(sum, &composer.plain).lines(7, 6, COLUMNS).len();
    let is_short = written.torques.iter().all(|torque| !torque.is_zero() && lines(torque) <= MOST_LINES_OF_A_TORQUE);
    let item = |i: usize| {
        let index = (i + 1).to_string();
        let left = |notation: &Notation<'_>| notation.indexed(notation.letter("τ"), &index);
        if is_short {
            return composer.formula(left, Pieces::of(&written.torques[i], notation));
        }
        let mut terms = Vec::new();
        for (j, _) in written.mass_matrix[i].iter().enumerate().filter(|(_, element)| !element.is_zero()) {
            terms.push(composer.both(|notation| {
                let name = notation.indexed("M", &notation.indices(&[i, j]));
                format!("{name}{}{}", notation.times(), notation.variable(j, 2))
            }));
        }
        if written.christoffel[i].iter().flatten().any(|symbol| !symbol.is_zero()) {
            terms.push(composer.both(|notation| notation.indexed("h", &index)));
        }
        if !written.gravity[i].is_zero() {
            terms.push(composer.both(|notation| notation.indexed(notation.letter("γ"), &index)));
        }
        composer.formula(left, Pieces::of_terms(&terms))
    };
    let title = vec![
        "Torques, ".to_owned(),
        math(
            notation,
            "τ = M(θ)θ̈ + h(θ,θ̇) + γ(θ)",
            r"\tau = M(\theta)\,\ddot\theta + h(\theta,\dot\theta) + \gamma(\theta)",
        ),
    ];
    Section { title, items: (0..dof).map(item).collect() }
}

fn mass_matrix(composer: &Composer<'_>, equations: &Equations, written: &Written) -> Section {
    let mut items = Vec::new();
    let dof = written.mass_matrix.len();
    let mut zeros = 0;
    for i in 0..dof {
        for j in i..dof {
            let sum = &written.mass_matrix[i][j];
            // zeros outside of the diagonal are only counted
            if sum.is_zero() && i != j {
                zeros += 1;
                continue;
            }
            let is_symmetric = equations.mass_matrix[i][j] == equations.mass_matrix[j][i];
            let left = |notation: &Notation<'_>| {
                let name = notation.indexed("M", &notation.indices(&[i, j]));
                if i == j || !is_symmetric {
                    return name;
                }
                format!("{name} = {}", notation.indexed("M", &notation.indices(&[j, i])))
            };
            items.push(composer.formula(left, Pieces::of(sum, &composer.notation)));
        }
    }
    if zeros > 0 {
        items.push(Item::Words(words("All other elements are 0.")));
    }
    let title = vec!["Mass matrix, ".to_owned(), math(&composer.notation, "M(θ)", r"M(\theta)")];
    Section { title, items }
}

fn velocity(composer: &Composer<'_>, equations: &Equations, written: &Written) -> Section {
    let dof = written.christoffel.len();
    let mut items = Vec::new();
    let mut symbols: Vec<Item> = Vec::new();
    let mut known: Vec<([usize; 3], &Polynomial)> = Vec::new();
    let name = |notation: &Notation<'_>, indices: [usize; 3]| notation.indexed("c", &notation.indices(&indices));
    for i in 0..dof {
        let mut terms = Vec::new();
        for j in 0..dof {
            for k in j..dof {
                if written.christoffel[i][j][k].is_zero() {
                    continue;
                }
                terms.push(composer.both(|notation| {
                    let (name, times) = (name(notation, [i, j, k]), notation.times());
                    let (first, second) = (notation.variable(j, 1), notation.variable(k, 1));
                    match (j == k, notation.script) {
                        (true, Script::Unicode) => format!("{name}{times}{first}²"),
                        (true, Script::Latex) => format!("{name}{times}{first}^{{2}}"),
                        (false, _) => format!("2{times}{name}{times}{first}{times}{second}"),
                    }
                }));
                let symbol = &equations.christoffel[i][j][k];
                let negative = -symbol;
                let same = known.iter().find(|(_, other)| **other == *symbol);
                let opposite = known.iter().find(|(_, other)| **other == negative);
                let own = |notation: &Notation<'_>| name(notation, [i, j, k]);
                let right = if let Some((indices, _)) = same.or(opposite) {
                    let sign = if same.is_some() { "" } else { "-" };
                    Pieces::of_terms(&[composer.both(|notation| format!("{sign}{}", name(notation, *indices)))])
                } else {
                    known.push(([i, j, k], symbol));
                    Pieces::of(&written.christoffel[i][j][k], &composer.notation)
                };
                symbols.push(composer.formula(own, right));
            }
        }
        let index = (i + 1).to_string();
        items.push(composer.formula(|notation| notation.indexed("h", &index), Pieces::of_terms(&terms)));
    }
    let are_some = !symbols.is_empty();
    items.extend(symbols);
    if are_some {
        let rest = math(
            &composer.notation,
            "c_ijk = c_ikj = (∂M_ij/∂θk + ∂M_ik/∂θj - ∂M_jk/∂θi)/2",
            concat!(
                r"c_{ijk} = c_{ikj} = \tfrac12\left(\frac{\partial M_{ij}}{\partial\theta_k} ",
                r"+ \frac{\partial M_{ik}}{\partial\theta_j} - \frac{\partial M_{jk}}{\partial\theta_i}\right)",
            ),
        );
        items.push(Item::Words(vec!["Christoffel's symbols, ".to_owned(), rest, "; all others are 0.".to_owned()]));
    }
    let title = vec![
        "Coriolis and centrifugal torques, ".to_owned(),
        math(&composer.notation, "h(θ,θ̇)", r"h(\theta,\dot\theta)"),
    ];
    Section { title, items }
}

fn gravity(composer: &Composer<'_>, written: &Written) -> Section {
    let item = |(i, sum): (usize, &Sum)| {
        let index = (i + 1).to_string();
        let left = |notation: &Notation<'_>| notation.indexed(notation.letter("γ"), &index);
        composer.formula(left, Pieces::of(sum, &composer.notation))
    };
    let title = vec!["Gravity, ".to_owned(), math(&composer.notation, "γ(θ)", r"\gamma(\theta)")];
    Section { title, items: written.gravity.iter().enumerate().map(item).collect() }
}

/// Returns the letters that occur in some polynomials.
pub(crate) fn used<'p>(polynomials: impl Iterator<Item = &'p Polynomial>) -> BTreeSet<Symbol> {
    let terms = polynomials.filter_map(Polynomial::terms).flatten();
    terms.flat_map(|(monomial, _)| monomial.0.iter().map(|(symbol, _)| *symbol)).collect()
}
