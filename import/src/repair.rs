//! Proposes repairs for bodies that cannot exist: the single edits of the file after which the body is plausible.
//!
//! Functions take and return data. [`bodies_of`] finds the bodies of a URDF, an MJCF file or a robot file with the
//! places of their numbers, [`proposals`] judges them and tries every edit of a table, and [`Candidate::diffs`] writes
//! an edit in the syntax of the file.

mod edits;
mod judged;
mod read;

use std::ops::Range;

use rne_model::{Inertia, exact_digits};

pub use self::edits::Edit;
use self::edits::{EDITS, UNITS, shifted};
pub use self::judged::Test;
use self::judged::{Robot, Verdict};
pub use self::read::bodies_of;

/// Difference of two scores below which two candidates count as equally good.
const EQUAL: f64 = 0.5;

/// Difference of scores above which a candidate is not mentioned beside the best one.
const WORSE: f64 = 4.0;

/// Mass that no edit gives a link, kg.
const HEAVIEST: f64 = 1e4;

/// Largest number of candidates that a proposal has.
const MOST: usize = 8;

/// The order in which a format writes the six numbers of a tensor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Order {
    /// xx xy xz yy yz zz, as in URDF.
    #[default]
    UpperTriangle,
    /// xx yy zz xy xz yz, as in MJCF and robot files.
    MomentsFirst,
}

/// The numbers of a body: its mass, kg, and the elements xx, yy, zz, xy, xz and yz of its tensor, kg m².
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Numbers {
    /// The mass.
    pub mass: f64,
    /// The tensor in the order xx, yy, zz, xy, xz, yz.
    pub inertia: [f64; 6],
}

/// A body of a file, and the places of its numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Body {
    /// The name of the link.
    pub name: String,
    /// The mass and the tensor as the file has them.
    pub numbers: Numbers,
    /// The centre of mass in the axes of the tensor, or `None` where these axes are turned.
    pub com: Option<[f64; 3]>,
    /// Whether the tensor refers to the origin of the link and not to the centre of mass.
    pub is_about_origin: bool,
    /// The order of the tensor in this format.
    pub order: Order,
    /// The length of the link as its joints and its centre of mass tell it, m; 0 if they tell nothing.
    pub size: f64,
    /// The bodies that joints connect with this one, as indices.
    pub neighbours: Vec<usize>,
    /// The place of the mass and of the six elements, for those that are plain numbers in the text.
    pub spans: [Option<Range<usize>>; 7],
    /// The places of the elements of the file that have the mass and the tensor.
    pub elements: Vec<Range<usize>>,
    /// Whether the file says that this need not be a body, so that it is never repaired.
    pub is_exempt: bool,
}

/// A body that needs a repair, with what is possible.
#[derive(Clone, Debug)]
pub struct Proposal {
    /// The index of the body.
    pub body: usize,
    /// The tests that the body fails.
    pub failed: Vec<Test>,
    /// The candidates, best first.
    pub candidates: Vec<Candidate>,
    /// The number of candidates at the beginning of the list that are equally good: with one, it is the repair.
    pub equal: usize,
}

/// A single edit after which a body is plausible.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// The row of the table of edits.
    pub edit: &'static Edit,
    /// The assumed mistake, in words.
    pub what: String,
    /// The bodies that change, as indices, with their new numbers.
    pub changes: Vec<(usize, Numbers)>,
    /// The element of the tensor that the file does not have any more, so that a person must find it.
    pub lost: Option<usize>,
    /// The tests that the body still fails.
    pub failed: Vec<Test>,
    score: f64,
}

/// The change of one element of the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diff {
    /// The place of the element in the text.
    pub span: Range<usize>,
    /// The text of the element after the change.
    pub new: String,
}

impl Numbers {
    fn tensor(&self) -> Inertia {
        let [xx, yy, zz, xy, xz, yz] = self.inertia;
        Inertia { xx, yy, zz, xy, xz, yz }
    }

    /// Returns whether a person invented the tensor, such as 0.001 for every moment: nothing in it tells the link.
    fn is_made_up(&self) -> bool {
        let [xx, yy, zz, ..] = self.inertia;
        xx == yy && yy == zz
    }

    /// Returns the mass and the six elements in one list.
    #[must_use]
    pub fn all(&self) -> [f64; 7] {
        let [xx, yy, zz, xy, xz, yz] = self.inertia;
        [self.mass, xx, yy, zz, xy, xz, yz]
    }
}

/// Returns the bodies that need a repair, with the edits that may be right.
#[must_use]
pub fn proposals(bodies: &[Body]) -> Vec<Proposal> {
    let robot = Robot::of(bodies);
    if let Some(found) = in_one_unit(&robot) {
        return found;
    }
    let of_body = |body: usize| {
        let failed = robot.reasons(body);
        if failed.is_empty() {
            return None;
        }
        let (candidates, equal) = candidates(&robot, body);
        // a possible body that no edit improves is not reported
        let is_finding = !candidates.is_empty() || !failed.iter().all(Test::is_doubt);
        is_finding.then_some(Proposal { body, failed, candidates, equal })
    };
    (0..bodies.len()).filter_map(of_body).collect()
}

/// Returns the proposals for a file with all tensors in another unit: at least half of the bodies are too large, and in
/// this unit no body needs a repair.
fn in_one_unit(robot: &Robot) -> Option<Vec<Proposal>> {
    /// The usual radius of gyration as a part of the length of the link.
    const USUAL: f64 = 0.3;
    /// Two units are equally good if the logarithms of their radii differ by less than this.
    const ALIKE_UNITS: f64 = 0.25;
    let all: Vec<usize> = (0..robot.bodies.len()).filter(|&body| !robot.bodies[body].is_exempt).collect();
    let is_large = |body: &&usize| robot.reasons(**body).contains(&Test::Wide);
    let large = all.iter().filter(is_large).count();
    if large < 2 || 2 * large < all.len() || !all.iter().all(|&body| robot.can_scale(body)) {
        return None;
    }
    let scaled = |power: i32| {
        let mut bodies = robot.bodies.to_vec();
        for &body in &all {
            bodies[body].numbers.inertia = bodies[body].numbers.inertia.map(|number| shifted(number, power));
        }
        bodies
    };
    let fits = |&(power, unit): &(i32, &'static str)| {
        let bodies = scaled(power);
        let robot = Robot::of(&bodies);
        let is_good = all.iter().all(|&body| robot.reasons(body).is_empty());
        let gyration = robot.usual_gyration().filter(|_| is_good)?;
        Some(((gyration - USUAL.log10()).abs(), unit, bodies))
    };
    let mut found: Vec<_> = UNITS.iter().filter_map(fits).collect();
    found.sort_by(|one, other| one.0.total_cmp(&other.0));
    let nearest = found.first()?.0;
    let edit = EDITS.iter().find(|edit| edit.name == "unit")?;
    let proposal = |&body: &usize| {
        let candidate = |(apart, unit, bodies): &(f64, &str, Vec<Body>)| {
            let what = format!("all tensors of the file are in {unit}");
            let changes = vec![(body, bodies[body].numbers)];
            Candidate { edit, what, changes, lost: None, failed: Vec::new(), score: *apart }
        };
        let equal = found.iter().filter(|(apart, ..)| *apart <= nearest + ALIKE_UNITS).count();
        Proposal { body, failed: vec![Test::Unit], candidates: found.iter().map(candidate).collect(), equal }
    };
    let has_tensor = |body: &&usize| robot.bodies[**body].numbers.inertia != [0.0; 6];
    Some(all.iter().filter(has_tensor).map(proposal).collect())
}

/// Returns the good edits of a body, best first, and the number of equally good ones at the beginning.
fn candidates(robot: &Robot, body: usize) -> (Vec<Candidate>, usize) {
    let before = robot.verdict(body, &robot.bodies[body].numbers);
    let mut found: Vec<Candidate> = Vec::new();
    for edit in &EDITS {
        for change in (edit.tries)(robot, body) {
            let Some(verdict) = judge(robot, body, &before, &change) else { continue };
            let edits::Change { what, numbers, lost, other, cost } = change;
            let changes: Vec<_> = [(body, numbers)].into_iter().chain(other).collect();
            let score = verdict.distance + edit.cost + cost;
            match found.iter_mut().find(|known| known.changes == changes) {
                Some(known) if known.score <= score => {}
                Some(known) => (known.edit, known.what, known.score) = (edit, what, score),
                None => found.push(Candidate { edit, what, changes, lost, failed: verdict.failed, score }),
            }
        }
    }
    found.sort_by(|a, b| a.failed.len().cmp(&b.failed.len()).then(a.score.total_cmp(&b.score)));
    let Some(best) = found.first() else { return (found, 0) };
    let (failed, score) = (best.failed.len(), best.score);
    found.retain(|candidate| candidate.failed.len() == failed && candidate.score <= score + WORSE);
    // only its size tells the decimal point of a product, so that another one is as good
    let old = robot.bodies[body].numbers.inertia;
    let is_product = |one: &Candidate| one.edit.name == "decimal point" && one.changes[0].1.inertia[..3] == old[..3];
    let is_equal = |one: &Candidate| one.score <= score + EQUAL || is_product(one) && is_product(&found[0]);
    let (mut equal, others): (Vec<_>, Vec<_>) = found.iter().cloned().partition(is_equal);
    let count = equal.len().min(MOST);
    equal.extend(others);
    equal.truncate(MOST);
    (equal, count)
}

/// Returns the verdict on an edit that the file allows and that makes a possible body out of one that fails more tests.
fn judge(robot: &Robot, body: usize, before: &Verdict, change: &edits::Change) -> Option<Verdict> {
    let can_write = |body: usize, numbers: &Numbers| {
        let Body { spans, numbers: old, .. } = &robot.bodies[body];
        let mut all = spans.iter().zip(old.all().into_iter().zip(numbers.all()));
        all.all(|(span, (old, new))| old == new || span.is_some() || robot.has_no_text())
    };
    let old = &robot.bodies[body].numbers;
    let is_absurd = change.numbers.mass > HEAVIEST && change.numbers.mass > old.mass;
    if change.numbers == *old || is_absurd || !can_write(body, &change.numbers) {
        return None;
    }
    let mut beside = 0.0;
    if let Some((other, numbers)) = &change.other {
        let was = robot.verdict(*other, &robot.bodies[*other].numbers);
        let verdict = robot.verdict(*other, numbers);
        if !can_write(*other, numbers) || !verdict.failed.is_empty() || !was.failed.iter().all(Test::is_doubt) {
            return None;
        }
        beside = verdict.distance - was.distance;
    }
    let mut verdict = robot.verdict(body, &change.numbers);
    verdict.distance += beside;
    let is_possible = verdict.failed.iter().all(Test::is_doubt);
    (is_possible && verdict.weight() < before.weight()).then_some(verdict)
}

impl Proposal {
    /// Returns the line and the column, both counted from 1, of the element that the best candidate changes, or of the
    /// last element of the body.
    #[must_use]
    pub fn place(&self, text: &str, bodies: &[Body]) -> [usize; 2] {
        let elements = &bodies[self.body].elements;
        let diffs = self.candidates.first().map(|first| first.diffs(text, bodies)).unwrap_or_default();
        let place = diffs.iter().map(|diff| &diff.span).find(|span| elements.contains(span)).or(elements.last());
        line_and_column(text, place.map_or(0, |place| place.start))
    }

    /// Returns the only repair, if there is one and the file has all its numbers.
    #[must_use]
    pub fn repair(&self) -> Option<&Candidate> {
        self.candidates.first().filter(|first| self.equal == 1 && first.is_complete())
    }
}

/// Returns the line and the column of a byte of the text, both counted from 1.
#[must_use]
pub fn line_and_column(text: &str, at: usize) -> [usize; 2] {
    let before = text.get(..at).unwrap_or_default();
    let start = before.rfind('\n').map_or(0, |at| at + 1);
    [1 + before.matches('\n').count(), 1 + before[start..].chars().count()]
}

impl Candidate {
    /// Returns whether the file has all numbers of the repaired body, so that the edit can be written.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.lost.is_none()
    }

    /// Returns the new text of each element that changes, in the order of the file. A number that the file does not
    /// have is a question mark.
    #[must_use]
    pub fn diffs(&self, text: &str, bodies: &[Body]) -> Vec<Diff> {
        let mut diffs: Vec<Diff> = Vec::new();
        for (index, numbers) in &self.changes {
            let Some(body) = bodies.get(*index) else { continue };
            let words = self.words(text, body, numbers);
            for element in &body.elements {
                let within = |span: &Range<usize>| element.start <= span.start && span.end <= element.end;
                let mut here: Vec<_> = words.iter().filter(|(span, _)| within(span)).collect();
                here.sort_by_key(|(span, _)| std::cmp::Reverse(span.start));
                let Some(mut new) = text.get(element.clone()).map(str::to_owned) else { continue };
                for (span, word) in &here {
                    new.replace_range(span.start - element.start..span.end - element.start, word);
                }
                if !here.is_empty() {
                    diffs.push(Diff { span: element.clone(), new });
                }
            }
        }
        diffs.sort_by_key(|diff| diff.span.start);
        diffs
    }

    /// Returns the places of the numbers that change, with the new words. A number that the body has already keeps its
    /// spelling.
    fn words(&self, text: &str, body: &Body, numbers: &Numbers) -> Vec<(Range<usize>, String)> {
        let old = body.numbers.all();
        let spelled = |number: f64| {
            let same = (0..7).find(|&at| old[at].abs() == number.abs() && number != 0.0)?;
            let word = text.get(body.spans[same].clone()?)?;
            let word = word.trim_start_matches(['-', '+']);
            Some(if number < 0.0 { format!("-{word}") } else { word.to_owned() })
        };
        let word = |at: usize, number: f64| match self.lost {
            Some(lost) if lost + 1 == at => "?".to_owned(),
            _ => spelled(number).unwrap_or_else(|| exact_digits(number)),
        };
        let all = numbers.all().into_iter().enumerate();
        let changed = all.filter(|&(at, number)| number != old[at] || self.lost.is_some_and(|lost| lost + 1 == at));
        changed.filter_map(|(at, number)| Some((body.spans[at].clone()?, word(at, number)))).collect()
    }
}

/// Returns the text with the changes of all candidates, and no other byte changed; `None` if two candidates change the
/// same element in different ways.
#[must_use]
pub fn written<'a>(text: &str, bodies: &[Body], candidates: impl IntoIterator<Item = &'a Candidate>) -> Option<String> {
    let mut diffs: Vec<Diff> = candidates.into_iter().flat_map(|candidate| candidate.diffs(text, bodies)).collect();
    diffs.sort_by_key(|diff| std::cmp::Reverse(diff.span.start));
    diffs.dedup();
    let mut new = text.to_owned();
    let mut end = text.len();
    for Diff { span, new: element } in diffs {
        if span.end > end {
            return None;
        }
        end = span.start;
        new.replace_range(span, &element);
    }
    Some(new)
}
