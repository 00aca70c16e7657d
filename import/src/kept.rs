//! Keeps finished imports, so that reading the same URDF again needs no second conversion.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

use rne_model::Report;

use crate::extended_urdf::beside;
use crate::import::{Imported, Options};
use crate::selection::Selection;
use crate::urdf::Urdf;

/// Finished imports with what they were made from, the latest last.
static KEPT: Mutex<VecDeque<(Content, Arc<Imported>)>> = Mutex::new(VecDeque::new());

/// Largest number of imports that are kept.
const MOST: usize = 32;

/// Largest total size of the URDFs of kept imports, bytes: that of two URDFs of the largest size.
const MOST_BYTES: usize = 32 << 20;

/// Everything on which the result of an import depends. Meshes and other files that a URDF names are never opened, and
/// a document type, by which XML can include files, is refused: so the text and that of the closed loops beside it are
/// enough. An import that reads further files is not kept.
#[derive(Debug, PartialEq, Eq)]
struct Content {
    /// The name of the file, which the robot file and reports contain.
    file: String,
    text: String,
    /// The file beside the URDF that has its closed loops, and its text.
    loops: Option<(String, String)>,
    /// The options as `Debug` writes them, which distinguishes -0.0 from 0.0 and includes every field, also future
    /// ones.
    options: String,
}

/// Calls [`Urdf::read`] and [`Urdf::import`], or returns the kept result if this process has already imported the same
/// file name, text and options.
///
/// # Errors
/// As those two; an import that fails is not kept.
pub fn import(file: &str, text: &str, options: &Options) -> Result<Arc<Imported>, Report> {
    let loops = beside(file);
    let content = Content { file: file.to_owned(), text: text.to_owned(), loops, options: format!("{options:?}") };
    let known = |kept: &VecDeque<(Content, Arc<Imported>)>| {
        kept.iter().find(|(other, _)| *other == content).map(|(_, imported)| Arc::clone(imported))
    };
    if let Some(imported) = known(&KEPT.lock().unwrap_or_else(PoisonError::into_inner)) {
        return Ok(imported);
    }
    let loops = content.loops.as_ref().map(|(name, text)| (name.as_str(), text.as_str()));
    let urdf = Urdf::read_with_loops(file, text, loops)?;
    let imported = Arc::new(urdf.import(options)?);
    if !urdf.source.included.is_empty() {
        return Ok(imported);
    }
    let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    // another thread may have finished the same import meanwhile; then all share that result
    if let Some(imported) = known(&kept) {
        return Ok(imported);
    }
    kept.push_back((content, Arc::clone(&imported)));
    while kept.len() > MOST || kept.iter().map(|(content, _)| content.text.len()).sum::<usize>() > MOST_BYTES {
        kept.pop_front();
    }
    Ok(imported)
}

/// Imports an arm from the bytes of a URDF, in the way in which the libraries open one: angles are snapped as by `rne
/// import` ([`Options::snap`]), so that every interface has the same arm, and links become named frames.
///
/// # Errors
/// As [`import`], and when the bytes are not UTF-8.
pub fn import_arm(file: &str, bytes: Vec<u8>, selection: Selection) -> Result<Arc<Imported>, Report> {
    let text = String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let text = String::from_utf8_lossy(error.as_bytes());
        let span = at..at + char::REPLACEMENT_CHARACTER.len_utf8();
        Report::of_error(file, &text, span, "the file is not text in UTF-8".to_owned(), Some("save it as UTF-8"))
    })?;
    import(file, &text, &Options { selection, frames: true, ..Options::default() })
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROD: &str = r#"<robot name="rod"><link name="base"/>
<link name="rod"><inertial><origin xyz="0 0 -0.25"/><mass value="2"/>
<inertia ixx="0.04" ixy="0" ixz="0" iyy="0.04" iyz="0" izz="0"/></inertial></link>
<joint name="hinge" type="continuous"><parent link="base"/><child link="rod"/><axis xyz="0 1 0"/></joint>
<joint name="finger" type="continuous"><parent link="rod"/><child link="tip"/><axis xyz="1 0 0"/></joint>
<link name="tip"><inertial><mass value="0.1"/>
<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link></robot>"#;

    #[test]
    fn the_same_text_is_converted_once() {
        let made = import("rod.urdf", ROD, &Options::default()).expect("an arm");
        assert!(Arc::ptr_eq(&made, &import("rod.urdf", ROD, &Options::default()).expect("an arm")));
        let anew = Urdf::read("rod.urdf", ROD).expect("a URDF").import(&Options::default()).expect("an arm");
        assert_eq!(made.text, anew.text);
    }

    #[test]
    fn whatever_decides_an_import_tells_it_from_others() {
        let held = |at: f64| Selection {
            tip: Some("rod".to_owned()),
            lock: vec![("finger".to_owned(), at)],
            ..<_>::default()
        };
        let at = |at: f64| Options { selection: held(at), ..Options::default() };
        let first = import("rod.urdf", ROD, &at(0.0)).expect("an arm");
        let others = [
            import("other.urdf", ROD, &at(0.0)),
            import("rod.urdf", &ROD.replace("0.25", "0.26"), &at(0.0)),
            import("rod.urdf", ROD, &at(-0.0)),
            import("rod.urdf", ROD, &at(0.5)),
            import("rod.urdf", ROD, &Options { snap: false, ..at(0.0) }),
            import("rod.urdf", ROD, &Options { convention: rne_model::Convention::Modified, ..at(0.0) }),
            import("rod.urdf", ROD, &Options::default()),
        ];
        for (index, other) in others.into_iter().enumerate() {
            assert!(!Arc::ptr_eq(&first, &other.expect("an arm")), "{index}");
        }
        assert!(Arc::ptr_eq(&first, &import("rod.urdf", ROD, &at(0.0)).expect("an arm")));
    }

    #[test]
    fn a_refusal_is_made_anew() {
        let none =
            Options { selection: Selection { tip: Some("hand".to_owned()), ..<_>::default() }, ..<_>::default() };
        let told = |file| import(file, ROD, &none).expect_err("no such tip").render(false);
        assert_eq!(told("rod.urdf"), told("rod.urdf"));
        assert!(told("arms/rod.urdf").contains("arms/rod.urdf"));
    }

    #[test]
    fn what_is_kept_is_bounded() {
        for index in 0..2 * MOST {
            import(&format!("{index}.urdf"), ROD, &Options::default()).expect("an arm");
        }
        // a comment makes the file nearly as long as is allowed
        let long = format!("<!--{}-->{ROD}", " ".repeat(12 << 20));
        for index in 0..4 {
            import(&format!("long{index}.urdf"), &long, &Options::default()).expect("an arm");
        }
        let kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
        assert!(kept.len() <= MOST, "{}", kept.len());
        assert!(kept.iter().map(|(content, _)| content.text.len()).sum::<usize>() <= MOST_BYTES);
    }
}
