//! Closed loops of an "Extended URDF", as in Gepetto/example-parallel-robots (arXiv 2504.04767): a YAML file beside the
//! URDF says which pairs of its frames coincide, which joints have motors, and which joints are really spherical or
//! universal.

use std::io::Read as _;
use std::ops::Range;
use std::path::Path;

use rne_model::document::{self, Content, Node};
use rne_model::{Cut, MAX_BYTES, Report, did_you_mean, open_file};

use crate::closed_loop::Loop;
use crate::geometry::Pose;
use crate::source::{file_name, names, quoted};
use crate::urdf::Urdf;

/// The key that distinguishes this file from other YAML files.
const LOOPS: &str = "closed_loop";

/// The keys that are read; others are for viewers and solvers.
const KEYS: [&str; 5] = [LOOPS, "type", "name_mot", "joint_name", "joint_type"];

/// Reads the file beside a URDF, `robot.yaml` beside `robot.urdf`, if it has the key `closed_loop`. Returns its path
/// and text.
pub(crate) fn beside(urdf: &str) -> Option<(String, String)> {
    let path = Path::new(urdf);
    if urdf.starts_with('<') || !path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("urdf")) {
        return None;
    }
    let path = path.with_extension("yaml");
    let mut text = String::new();
    open_file(&path).ok()?.take(MAX_BYTES as u64 + 1).read_to_string(&mut text).ok()?;
    let has_loops =
        text.lines().any(|line| line.strip_prefix(LOOPS).is_some_and(|rest| rest.trim_start().starts_with(':')));
    has_loops.then(|| (path.display().to_string(), text))
}

/// A word of the file, and its place in the text.
struct Word {
    text: String,
    span: Range<usize>,
}

impl Urdf {
    /// Adds the loops of the file `name`, whose text is `text`.
    pub(crate) fn extend(&mut self, name: &str, text: &str) -> Result<(), Report> {
        let kind = document::Kind { name: "a list of closed loops", format: 1 };
        let root = document::read(name, text, kind)?;
        // the text is appended to that of the URDF, so that error places count in both
        let start = self.source.text.len();
        self.source.text.push_str(text);
        self.source.included.push((start, name.to_owned()));
        let words = |key: &str| -> Result<Vec<Word>, Report> {
            root.get(key).map_or(Ok(Vec::new()), |node| self.words(node, start, key))
        };
        let whole = start..start;
        self.refuse_slips(&root, start)?;
        let Some(pairs) = root.get(LOOPS) else {
            let help = format!("write the two ends of each loop: `{LOOPS}: [[A, B]]`");
            return Err(self.source.error(&whole, format!("the file has no key `{LOOPS}`"), help));
        };
        let pairs = self.pairs(pairs, start)?;
        let [types, motors, changed, changes] =
            [words("type")?, words("name_mot")?, words("joint_name")?, words("joint_type")?];
        self.equally_long((LOOPS, pairs.len()), ("type", types.len()), &span_of(&types, &whole))?;
        self.equally_long(("joint_name", changed.len()), ("joint_type", changes.len()), &span_of(&changes, &whole))?;

        // the types of joints first, because a loop may end at a link that such a joint moves
        self.change_types(&changed, &changes)?;
        self.choose_motors(&motors)?;
        for (index, (ends, kind)) in pairs.iter().zip(&types).enumerate() {
            self.close_loop(format!("loop{}", index + 1), ends, kind)?;
        }
        self.remarks.push(format!("the closed loops are those of {}", quoted(file_name(name))));
        Ok(())
    }

    /// Refuses a key that is probably a misspelling of one that is read.
    fn refuse_slips(&self, root: &Node, start: usize) -> Result<(), Report> {
        let Content::Mapping(entries) = &root.content else { return Ok(()) };
        for entry in entries.iter().filter(|entry| !KEYS.contains(&entry.key.as_str())) {
            let span = start + entry.key_span.start..start + entry.key_span.end;
            if let Some(meant) = did_you_mean(&entry.key, KEYS) {
                let message = format!("there is no key {}", quoted(&entry.key));
                return Err(self.source.error(&span, message, format!("did you mean `{meant}`?")));
            }
        }
        Ok(())
    }

    /// Replaces joints that are really spherical or universal by revolute joints, as their types in the file say.
    fn change_types(&mut self, joints: &[Word], types: &[Word]) -> Result<(), Report> {
        for (joint, kind) in joints.iter().zip(types) {
            let axes = self.axes(kind)?;
            let index = self.named_joint(joint)?;
            let of = &self.joints[index];
            if !of.kind.has_one_freedom() {
                let message = format!("the joint {} is {} in the URDF", quoted(&of.name), of.kind.name());
                let help = "`joint_type` is for joints that are revolute in the URDF";
                return Err(self.source.error(&joint.span, message, help));
            }
            let source = self.source.clone();
            self.split(index, &axes, (&source, &joint.span))?;
        }
        if !joints.is_empty() {
            let joints = names(joints.iter().map(|joint| &joint.text));
            self.remarks.push(format!(
                "these joints become one revolute joint for each axis, without limits, as `joint_type` says: {joints}"
            ));
        }
        Ok(())
    }

    /// Sets for every joint whether it has a motor, if the file names the motors.
    fn choose_motors(&mut self, motors: &[Word]) -> Result<(), Report> {
        let with_motors: Vec<usize> = motors.iter().map(|motor| self.named_joint(motor)).collect::<Result<_, _>>()?;
        if !motors.is_empty() {
            for (index, joint) in self.joints.iter_mut().enumerate() {
                joint.has_motor = Some(with_motors.contains(&index));
            }
        }
        Ok(())
    }

    /// Adds a loop between two links; a link is named by its own name or by that of the joint that moves it.
    fn close_loop(&mut self, name: String, [one, other]: &[Word; 2], kind: &Word) -> Result<(), Report> {
        let cut = match kind.text.to_ascii_lowercase().as_str() {
            "6d" => Cut::Weld,
            "3d" => Cut::Spherical,
            _ => {
                let message = format!("the type of a loop is {}; it must be `6d` or `3d`", quoted(&kind.text));
                let help = "6d: the two frames are one; 3d: their origins are one";
                return Err(self.source.error(&kind.span, message, help));
            }
        };
        let end = |word: &Word| {
            let link = self.link_or_moved(&word.text).ok_or_else(|| {
                let message =
                    format!("the loop names {}, which is no link and no joint of the URDF", quoted(&word.text));
                self.source.error(&word.span, message, None)
            })?;
            Ok((link, Pose::identity()))
        };
        let ends = [end(one)?, end(other)?];
        let span = one.span.start..other.span.end.max(one.span.end);
        let source = self.source.clone();
        self.add_loop(Loop { name, span, cut, ends }, &source)
    }

    fn equally_long(
        &self,
        (one, length): (&str, usize),
        (other, other_length): (&str, usize),
        span: &Range<usize>,
    ) -> Result<(), Report> {
        if length == other_length {
            return Ok(());
        }
        let message = format!("`{one}` has {length} entries and `{other}` has {other_length}");
        Err(self.source.error(span, message, format!("write an entry of `{other}` for each entry of `{one}`")))
    }

    /// Reads the words in the list under a key; a single word counts as a list of one.
    fn words(&self, node: &Node, start: usize, key: &str) -> Result<Vec<Word>, Report> {
        match &node.content {
            Content::Sequence(items) => items.iter().map(|item| self.word(item, start, key)).collect(),
            _ => Ok(vec![self.word(node, start, key)?]),
        }
    }

    fn word(&self, node: &Node, start: usize, key: &str) -> Result<Word, Report> {
        let span = start + node.head().start..start + node.head().end;
        match &node.content {
            Content::Scalar(scalar) if !scalar.text.trim().is_empty() => Ok(Word { text: scalar.text.clone(), span }),
            _ => {
                let message = format!("found {} in `{key}` where a name is needed", node.described());
                Err(self.source.error(&span, message, None))
            }
        }
    }

    fn pairs(&self, node: &Node, start: usize) -> Result<Vec<[Word; 2]>, Report> {
        let refused = |node: &Node, what: &str| {
            let span = start + node.head().start..start + node.head().end;
            let message = format!("found {} where {what} is needed", node.described());
            self.source.error(&span, message, format!("write `{LOOPS}: [[A, B], [C, D]]`"))
        };
        let Content::Sequence(items) = &node.content else {
            return Err(refused(node, "a list of pairs"));
        };
        let pair = |item: &std::rc::Rc<Node>| match &item.content {
            Content::Sequence(ends) if ends.len() == 2 => {
                Ok([self.word(&ends[0], start, LOOPS)?, self.word(&ends[1], start, LOOPS)?])
            }
            _ => Err(refused(item, "a list of two names")),
        };
        items.iter().map(pair).collect()
    }

    fn named_joint(&self, word: &Word) -> Result<usize, Report> {
        self.joints.iter().position(|joint| joint.name == word.text).ok_or_else(|| {
            let message = format!("there is no joint {} in the URDF", quoted(&word.text));
            let known = self.joints.iter().map(|joint| joint.name.as_str());
            let help = did_you_mean(&word.text, known).map(|meant| format!("did you mean {}?", quoted(meant)));
            self.source.error(&word.span, message, help)
        })
    }

    /// Returns the axes of a type of joint, such as `SPHERICAL` or `UJOINT_XY`, as numbers 0 to 2 for x to z.
    fn axes(&self, kind: &Word) -> Result<Vec<usize>, Report> {
        let axis = |letter: char| "XYZ".find(letter);
        if kind.text == "SPHERICAL" {
            return Ok(vec![0, 1, 2]);
        }
        let axes: Option<Vec<usize>> =
            kind.text.strip_prefix("UJOINT_").and_then(|word| word.chars().map(axis).collect());
        match axes.as_deref() {
            Some([one, other]) if one != other => Ok(vec![*one, *other]),
            _ => {
                let message = format!("the type of a joint is {}", quoted(&kind.text));
                let help = "it must be SPHERICAL, or UJOINT_ with two letters of XYZ, such as UJOINT_XY";
                Err(self.source.error(&kind.span, message, help))
            }
        }
    }
}

/// Returns the place of the first of some words, or `other` without words.
fn span_of(words: &[Word], other: &Range<usize>) -> Range<usize> {
    words.first().map_or(other.clone(), |word| word.span.clone())
}
