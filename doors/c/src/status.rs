//! The outcome of a call: a status, and the message of the last failure of each thread. Panics become a status, too.

use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};

use rne_convert::OpenError;
use rne_machine::{ArmError, EvaluationError};
use rne_model::{Remedy, Report};

/// What a call came to. Everything but RNE_STATUS_OK leaves a message for rne_last_error().
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// It is done.
    Ok = 0,
    /// A pointer is NULL that must not be.
    NullPointer = 1,
    /// A text is not UTF-8.
    NotUtf8 = 2,
    /// A file cannot be read: the message has the path and what the operating system says.
    UnreadableFile = 3,
    /// A robot file, a plan file or a URDF is wrong: the message shows each mistake with its line and column.
    InvalidFile = 4,
    /// There is no robot, function or argument of this name: the message lists those there are.
    UnknownName = 5,
    /// There is no function of this id, no joint or argument of this index; or the mass of a payload is below zero.
    OutOfRange = 6,
    /// An argument that the function takes is not among the inputs.
    MissingArgument = 7,
    /// An input has too few numbers, is there twice, or the room for the outputs has another size.
    WrongSize = 8,
    /// An array or a place is not aligned for its values, an array is larger than memory can be, or outputs and an
    /// input share memory.
    WrongMemory = 9,
    /// The function cannot be compiled for this arm: the message says why.
    CannotCompile = 10,
    /// A mistake in this library. Nothing was returned; the arm can still be used.
    Panic = 11,
}

/// Why a call failed: its status and the message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Failure {
    pub(crate) status: Status,
    pub(crate) message: String,
}

impl Failure {
    pub(crate) fn new(status: Status, message: impl Into<String>) -> Self {
        Self { status, message: message.into() }
    }

    /// The failure of a call whose pointer with this name is NULL.
    pub(crate) fn null(what: &str) -> Self {
        Self::new(Status::NullPointer, format!("`{what}` is NULL"))
    }
}

/// Returns the remedy for an error of an import, as arguments of rne_arm_load_urdf().
fn in_arguments(remedy: &Remedy) -> Option<String> {
    Some(match remedy {
        Remedy::ImportUrdf { .. } => "rne_arm_load_urdf() reads a URDF".to_owned(),
        Remedy::NameTip => "name the tip by `tip`".to_owned(),
        // the C library loads arms only, so the remedy to import the whole robot does not exist
        Remedy::LockJoint { joint } | Remedy::WholeOrLock { joint } => {
            format!("write `{joint}` into `lock_names` to hold this joint still")
        }
        Remedy::LockOthers => {
            "`lock_names` and `lock_values` hold some of the joints, `lock_others` holds all of them at zero".to_owned()
        }
        Remedy::KeepUnphysical | Remedy::Repair | Remedy::Whole | Remedy::Float | Remedy::Rotors => return None,
    })
}

impl From<Report> for Failure {
    fn from(report: Report) -> Self {
        Self::new(Status::InvalidFile, report.worded(in_arguments).render(false))
    }
}

impl From<OpenError> for Failure {
    fn from(error: OpenError) -> Self {
        let is_plan = matches!(error, OpenError::Plan { .. });
        Self::new(if is_plan { Status::InvalidFile } else { Status::UnreadableFile }, error.to_string())
    }
}

impl From<ArmError> for Failure {
    fn from(error: ArmError) -> Self {
        match error {
            ArmError::Invalid(report) => report.into(),
            error @ ArmError::Unreadable { .. } => Self::new(Status::UnreadableFile, error.to_string()),
            error => Self::new(Status::InvalidFile, error.to_string()),
        }
    }
}

impl From<EvaluationError> for Failure {
    fn from(error: EvaluationError) -> Self {
        let status = match error {
            EvaluationError::Compile(_) => Status::CannotCompile,
            EvaluationError::Missing { .. } => Status::MissingArgument,
            EvaluationError::OutOfRange { .. } => Status::OutOfRange,
            _ => Status::WrongSize,
        };
        Self::new(status, error.to_string())
    }
}

thread_local! {
    static LAST: RefCell<CString> = RefCell::default();
}

/// Returns the message of the last failure of this thread; it is empty before the first one.
pub(crate) fn last_error() -> *const c_char {
    // when a thread ends, its message may be destroyed already
    LAST.try_with(|last| last.borrow().as_ptr()).unwrap_or(c"".as_ptr())
}

/// Returns a text for C, without its zero bytes, because C texts end at the first one.
pub(crate) fn c_text(text: &str) -> CString {
    CString::new(text.replace('\0', "\u{fffd}")).unwrap_or_default()
}

fn tell(failure: &Failure) {
    let text = c_text(&failure.message);
    let _ = LAST.try_with(|last| last.replace(text));
}

/// Does the work of a call and returns its value. A failure or a panic becomes a status, and its message is kept for
/// `last_error`.
pub(crate) fn guarded<T>(work: impl FnOnce() -> Result<T, Failure>) -> Result<T, Status> {
    // After a panic no half-made state is visible: calls do not change handles. They only compile functions, and a
    // function is either compiled completely or not at all.
    let failure = match catch_unwind(AssertUnwindSafe(work)) {
        Ok(Ok(value)) => return Ok(value),
        Ok(Err(failure)) => failure,
        Err(payload) => {
            let words = payload.downcast_ref::<&str>().copied().map(str::to_owned);
            let words = words.or_else(|| payload.downcast_ref::<String>().cloned()).unwrap_or_default();
            // dropping the payload could panic again, outside of `catch_unwind`
            std::mem::forget(payload);
            Failure::new(Status::Panic, format!("a mistake in this library, please report it: {words}"))
        }
    };
    tell(&failure);
    Err(failure.status)
}

/// Does the work of a call that returns nothing but its status.
pub(crate) fn status(work: impl FnOnce() -> Result<(), Failure>) -> Status {
    guarded(work).err().unwrap_or(Status::Ok)
}

/// The version of this library, ending with a zero byte.
pub(crate) const VERSION: &CStr = match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
    Ok(version) => version,
    Err(_) => c"",
};

#[cfg(test)]
mod tests {
    use super::{Failure, Status, c_text, guarded, status};

    #[test]
    fn a_panic_is_a_status() {
        assert_eq!(guarded(|| -> Result<u8, Failure> { panic!("for the test") }), Err(Status::Panic));
        let message = super::LAST.with_borrow(|last| last.to_str().expect("UTF-8").to_owned());
        assert_eq!(message, "a mistake in this library, please report it: for the test");
        assert_eq!(status(|| panic!("of {}", "pieces")), Status::Panic);
        assert!(super::LAST.with_borrow(|last| last.to_str().expect("UTF-8").ends_with("it: of pieces")));
        // a success leaves the message of the last failure unchanged
        assert_eq!(status(|| Ok(())), Status::Ok);
        assert!(super::LAST.with_borrow(|last| !last.is_empty()));
    }

    #[test]
    fn a_zero_byte_ends_no_text() {
        assert_eq!(c_text("a\0b").to_str(), Ok("a\u{fffd}b"));
    }
}
