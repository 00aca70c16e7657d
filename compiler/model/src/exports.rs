//! The public names that exist only with the feature `std`: robots, their files, readers and errors.

pub use crate::check::{Checked, Reader};
pub use crate::lints::mirror::other_side;
pub use crate::loops::closed_loop::{ClosedLoop, ClosedLoops, Cut, Pivot};
pub use crate::loops::dependents::{Actuation, NoDependents, choose_dependents};
pub use crate::parts::body::{Bodies, Body, UnknownBody};
pub use crate::parts::coupling::Coupling;
pub use crate::parts::double::{Double, decimal_digits};
pub use crate::parts::drive::{Drive, Rotor};
pub use crate::parts::floating_base::FloatingBase;
pub use crate::parts::formula::Formula;
pub use crate::parts::frame::{Frame, FrameId, UnknownFrame};
pub use crate::parts::friction::{Friction, FrictionTransition, TransitionSign};
pub use crate::parts::golden::{GoldenFile, GoldenState};
pub use crate::parts::inertia::NegativeMoment;
pub use crate::parts::run_time::{Entry, InertiaElement, RunTime};
pub use crate::robot::{InertiaReference, Joint, Limits, Robot};
pub use crate::text::data_file::{
    MAX_BYTES, golden_of, misnamed_golden_of, open_file, plan_of, read_file, read_limited, robot_of,
};
pub use crate::text::diagnostic::{Diagnostic, Remedy, Report, Severity};
pub use crate::text::document;
pub use crate::text::expression::number;
pub use crate::text::identifier::JointIdentifier;
pub use crate::text::keys::{Key, Mapping, mappings};
pub use crate::text::other_formats::is_urdf;
pub use crate::text::source::{exact_digits, half_of_last_digit, is_control, one_line, six_digits};
pub use crate::text::spelling::{did_you_mean, nearest_name, no_shipped_robot};
