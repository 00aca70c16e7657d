//! Writes the recursion in letters, for an arm whose closed form is too long for a page: the formulas of the seven
//! steps, and the constants of each link.

use rne_codegen::Quantity;
use rne_model::{Convention, JointKind, one_line};

use crate::collected::Collector;
use crate::derivation::Derivation;
use crate::document::{Composer, Item, Section, used, words};
use crate::letters::letters;
use crate::lines::Pieces;
use crate::notation::{Notation, Script};
use crate::polynomial::Polynomial;
use crate::table::Row;
use crate::vector::{Matrix, Vector};
use crate::written::MOST_TERMS;
use crate::{ClosedForm, MOST_LINES, written};

/// A formula of the recursion: left side and right side, each for a terminal and for LaTeX.
type Formula = ([&'static str; 2], [&'static str; 2]);

const FORWARD: [Formula; 4] = [
    (["ωi", r"\boldsymbol\omega_i"], ["Riᵀ ωp + q̇i e", r"R_i^{\mathrm T} \boldsymbol\omega_p + \dot q_i \mathbf e"]),
    (
        ["ω̇i", r"\dot{\boldsymbol\omega}_i"],
        [
            "Riᵀ ω̇p + q̈i e + q̇i ωi × e",
            concat!(
                r"R_i^{\mathrm T} \dot{\boldsymbol\omega}_p + \ddot q_i \mathbf e ",
                r"+ \dot q_i\,\boldsymbol\omega_i \times \mathbf e",
            ),
        ],
    ),
    (
        ["c̈i", r"\ddot{\mathbf c}_i"],
        [
            "Riᵀ (c̈p + ω̇p × rp + ωp × (ωp × rp)) + ω̇i × di + ωi × (ωi × di)",
            concat!(
                r"R_i^{\mathrm T} (\ddot{\mathbf c}_p + \dot{\boldsymbol\omega}_p \times \mathbf r_p ",
                r"+ \boldsymbol\omega_p \times (\boldsymbol\omega_p \times \mathbf r_p)) ",
                r"+ \dot{\boldsymbol\omega}_i \times \mathbf d_i ",
                r"+ \boldsymbol\omega_i \times (\boldsymbol\omega_i \times \mathbf d_i)",
            ),
        ],
    ),
    (["gi", r"\mathbf g_i"], ["Riᵀ gp", r"R_i^{\mathrm T} \mathbf g_p"]),
];

const BACKWARD: [Formula; 4] = [
    (
        ["ni", r"\mathbf n_i"],
        [
            "Ii ω̇i + ωi × (Ii ωi)",
            r"I_i \dot{\boldsymbol\omega}_i + \boldsymbol\omega_i \times (I_i \boldsymbol\omega_i)",
        ],
    ),
    (
        ["fp,i", r"\mathbf f_{p,i}"],
        ["mi (c̈i - gi) + Rk fi,k", r"m_i (\ddot{\mathbf c}_i - \mathbf g_i) + R_k \mathbf f_{i,k}"],
    ),
    (
        ["np,i", r"\mathbf n_{p,i}"],
        [
            "ni + Rk ni,k + di × fp,i + ri × Rk fi,k",
            concat!(
                r"\mathbf n_i + R_k \mathbf n_{i,k} + \mathbf d_i \times \mathbf f_{p,i} ",
                r"+ \mathbf r_i \times R_k \mathbf f_{i,k}",
            ),
        ],
    ),
    (["τi", r"\tau_i"], ["e · np,i", r"\mathbf e \cdot \mathbf n_{p,i}"]),
];

/// Returns sections with the formulas, the constants of each link, and the letters; for a tree, only the reason why
/// there is no closed form.
pub(crate) fn sections(composer: &Composer<'_>, form: &ClosedForm) -> Vec<Section> {
    let script = composer.notation.script;
    let mut why = vec![no_closed_form(form)];
    if let Some(joints) = form.shorter {
        why.extend([String::new(), format!(" The arm up to joint {joints} has a closed form that fits.")]);
    }
    let mut sections = vec![Section { title: Vec::new(), items: vec![Item::Words(why)] }];
    if !form.table.robot.is_serial() {
        return sections;
    }
    let formula = |(left, right): &Formula| {
        let at = usize::from(script == Script::Latex);
        let right = Pieces::of_terms(&[(right[at].to_owned(), right[0].to_owned())]);
        Item::Formula { left: left[at].to_owned(), width: left[0].chars().count(), right }
    };
    let mut forward: Vec<Item> = FORWARD.iter().map(formula).collect();
    let mut backward: Vec<Item> = BACKWARD.iter().map(formula).collect();
    besides(form, script, &mut forward, &mut backward);
    // words and formulas alternately
    let title = |parts: [&str; 5]| parts.map(str::to_owned).to_vec();
    let forward_title = title(["Forward, ", "i = 1", " to the last, ", "p = i - 1", "; the base stands still"]);
    sections.push(Section { title: forward_title, items: forward });
    let backward_title = title(["Backward, ", "i", " from the last to 1, ", "k = i + 1", "; the tip is free"]);
    sections.push(Section { title: backward_title, items: backward });
    let mut constants = LinkFormulas {
        composer,
        collector: Collector::new(composer.notation.constants),
        seen: Vec::new(),
        items: Vec::new(),
    };
    constants.vector("g", 0, &form.table.gravity);
    let quantities = [Quantity::D, Quantity::R, Quantity::Inertia, Quantity::MasslessMoment];
    if let Ok(link) = Derivation::at_rest(&form.table, &quantities) {
        (1..=form.table.rows.len()).for_each(|index| constants.link(form, &link, index));
    }
    let LinkFormulas { seen, mut items, .. } = constants;
    let is_revolute = |row: &&Row| row.kind == JointKind::Revolute;
    if script == Script::Unicode && form.table.rows.iter().filter(is_revolute).any(|row| !row.d.is_zero()) {
        items.push(Item::Words(words(
            "On the left d is the vector from the joint to the centre of mass, on the right the table's offset.",
        )));
    }
    sections.push(Section { title: words("Of each link, in the frame at its joint, z along the joint's axis"), items });
    sections.extend(letters(composer, &form.table, &used(seen.iter())));
    sections
}

/// Collects the formulas of the constants of links, and their polynomials.
struct LinkFormulas<'c> {
    composer: &'c Composer<'c>,
    collector: Collector<'c>,
    seen: Vec<Polynomial>,
    items: Vec<Item>,
}

impl LinkFormulas<'_> {
    /// Adds the formula of a vector with an index.
    fn vector(&mut self, left: &str, index: usize, vector: &Vector) {
        self.seen.extend(vector.0.iter().cloned());
        // vectors are bold in LaTeX, because d is also a letter of the table
        let left = |notation: &Notation<'_>| match notation.script {
            Script::Latex if left.len() == 1 => notation.indexed(&format!("\\mathbf {left}"), &index.to_string()),
            _ => notation.indexed(left, &index.to_string()),
        };
        let sums: Vec<_> = vector.0.iter().filter_map(|component| self.collector.collected(component)).collect();
        self.items.push(self.composer.formula(left, Pieces::components(&sums, &self.composer.notation)));
    }

    /// Adds the constants of a link, counted from 1, that the recursion uses.
    fn link(&mut self, form: &ClosedForm, link: &Derivation, index: usize) {
        let (composer, rows) = (self.composer, &form.table.rows);
        let i = index - 1;
        let row = &rows[i];
        let before = match form.table.convention {
            Convention::Standard => i.checked_sub(1).and_then(|p| rows.get(p)).map(|row| (row, i)),
            Convention::Modified => Some((row, i)),
        };
        let turns = composer.both(|notation| turns(notation, before, row, i));
        let left = |notation: &Notation<'_>| notation.indexed("R", &index.to_string());
        self.items.push(composer.formula(left, Pieces::of_terms(&[turns])));
        self.vector("d", index, &link.vector(Quantity::D, index));
        if index < form.joints() {
            self.vector("r", index, &link.vector(Quantity::R, index));
        }
        let own = |notation: &Notation<'_>| notation.indexed("m", &index.to_string());
        if written::polynomial(&form.table, &row.mass) != own(&composer.plain) {
            let sums = Collector::new(composer.notation.constants).collected(&row.mass);
            self.items.extend(sums.map(|sum| composer.formula(own, Pieces::of(&sum, &composer.notation))));
        }
        self.seen.extend([row.mass.clone(), row.rotor.clone()]);
        let Matrix(rows) = link.matrix(Quantity::Inertia, index);
        let diagonal = Vector([0, 1, 2].map(|axis| rows[axis].0[axis].clone()));
        let products = Vector([rows[0].0[1].clone(), rows[0].0[2].clone(), rows[1].0[2].clone()]);
        if !diagonal.is_zero() || !products.is_zero() {
            self.vector("(Ixx, Iyy, Izz)", index, &diagonal);
        }
        if !products.is_zero() {
            self.vector("(Ixy, Ixz, Iyz)", index, &products);
        }
        let first_moment = link.vector(Quantity::MasslessMoment, index);
        if !first_moment.is_zero() {
            self.vector("h", index, &first_moment);
        }
    }
}

/// Explains why there is no closed form and, for a serial arm, what follows instead.
fn no_closed_form(form: &ClosedForm) -> String {
    if let Some(row) = form.table.oblique() {
        let name = one_line(&form.table.robot.joints[row].name);
        return format!(
            "There is no closed form, because the row of {name} begins at an angle (`gamma` or `rpy` of `at`) that is \
             not a multiple of pi/2."
        );
    }
    let long = format!(
        "The closed form of these {} joints is too long to be read: a torque takes more than {MOST_LINES} lines, or \
         has more than {MOST_TERMS} terms multiplied out.",
        form.joints()
    );
    if form.table.robot.is_serial() {
        long + " So here is the recursion that gives it, in the same letters."
    } else {
        long
    }
}

/// Adds the additional terms of prismatic joints, rotors and first moments without mass, in words.
fn besides(form: &ClosedForm, script: Script, forward: &mut Vec<Item>, backward: &mut Vec<Item>) {
    let rows = &form.table.rows;
    let math = |unicode: &str, latex: &str| if script == Script::Latex { latex } else { unicode }.to_owned();
    if rows.iter().any(|row| row.kind == JointKind::Prismatic) {
        forward.push(Item::Words(vec![
            "A sliding joint turns nothing: its link has no terms with e in the first two, and in the third it has "
                .to_owned(),
            math("q̈i e + 2 q̇i ωi × e", r"\ddot q_i \mathbf e + 2\,\dot q_i\,\boldsymbol\omega_i \times \mathbf e"),
            " besides.".to_owned(),
        ]));
        let force = math("e · fp,i", r"\mathbf e \cdot \mathbf f_{p,i}");
        backward.push(Item::Words(vec!["The force of a sliding joint is ".to_owned(), force, ".".to_owned()]));
    }
    if rows.iter().any(|row| !row.rotor.is_zero()) {
        let rotor = if script == Script::Latex { r"G_i^2 J_{m,i} \ddot q_i" } else { "Gi² Jmi q̈i" }.to_owned();
        backward.push(Item::Words(vec!["The rotor of joint i adds ".to_owned(), rotor, " to its torque.".to_owned()]));
    }
    if rows.iter().any(|row| !row.first_moment.is_zero()) {
        backward.push(Item::Words(vec![
            "A link without mass that has a first moment h adds ".to_owned(),
            math(
                "ω̇i × hi + ωi × (ωi × hi)",
                concat!(
                    r"\dot{\boldsymbol\omega}_i \times \mathbf h_i ",
                    r"+ \boldsymbol\omega_i \times (\boldsymbol\omega_i \times \mathbf h_i)",
                ),
            ),
            " to the force on it and ".to_owned(),
            math("hi × (c̈i - gi)", r"\mathbf h_i \times (\ddot{\mathbf c}_i - \mathbf g_i)"),
            " to the moment.".to_owned(),
        ]));
    }
}

/// Writes R_i as a product of rotations about x and z.
fn turns(notation: &Notation<'_>, before: Option<(&Row, usize)>, row: &Row, joint: usize) -> String {
    let [about_x, about_z] = match notation.script {
        Script::Unicode => ["Rx", "Rz"],
        Script::Latex => ["R_x", "R_z"],
    };
    let right = |(sine, cosine): &(Polynomial, Polynomial)| -> Option<&'static str> {
        let letter = |x: &Polynomial| match x.single() {
            None if x.is_zero() => Some(0.0),
            Some((monomial, value)) if monomial.0.is_empty() => Some(crate::rational::nearest(value)),
            _ => None,
        };
        let pi = |text: [&'static str; 2]| text[usize::from(notation.script == Script::Latex)];
        match (letter(sine)?, letter(cosine)?) {
            (1.0, _) => Some(pi(["π/2", r"\pi/2"])),
            (-1.0, _) => Some(pi(["-π/2", r"-\pi/2"])),
            (_, -1.0) => Some(pi(["π", r"\pi"])),
            _ => Some(""),
        }
    };
    let mut factors = Vec::new();
    if let Some((before, index)) = before {
        match right(&before.alpha) {
            Some("") => {}
            Some(angle) => factors.push(format!("{about_x}({angle})")),
            None => {
                let alpha = notation.indexed(notation.letter("α"), &index.to_string());
                factors.push(format!("{about_x}({alpha})"));
            }
        }
    }
    let theta = notation.indexed(notation.letter("θ"), &(joint + 1).to_string());
    match right(&row.theta) {
        Some("") => {}
        Some(angle) => factors.push(format!("{about_z}({angle})")),
        None => factors.push(format!("{about_z}({theta})")),
    }
    if factors.is_empty() { "1".to_owned() } else { factors.join(notation.times()) }
}
