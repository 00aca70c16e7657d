//! Shows how much of a log has been read, as a progress bar.

use std::io::{self, IsTerminal as _};

use indicatif::{ProgressBar, ProgressFinish, ProgressStyle};
use rne_logs::{Log, LogError, Survey};

/// Surveys a log and shows a progress bar.
pub(crate) fn survey(log: &Log, is_result_shown: bool) -> Result<Survey, LogError> {
    log.survey(progress(is_result_shown))
}

/// Makes a progress bar on a terminal, unless the result is shown there at the same time. It is cleared when it is
/// dropped.
pub(crate) fn bar(word: &str, is_result_shown: bool) -> ProgressBar {
    if is_result_shown && io::stdout().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(1000).with_finish(ProgressFinish::AndClear);
    match ProgressStyle::with_template(&format!("{{bar:30}} {{percent}} % {word}, {{eta}} to go")) {
        Ok(style) => bar.with_style(style.progress_chars("=> ")),
        Err(_) => bar,
    }
}

/// Returns a function that shows the part of a log that was read, 0 to 1, in a progress bar, until the function is
/// dropped.
pub(crate) fn progress(is_result_shown: bool) -> impl FnMut(f64) {
    let bar = bar("read", is_result_shown);
    move |share| show(&bar, share)
}

/// Sets a progress bar to a part from 0 to 1.
pub(crate) fn show(bar: &ProgressBar, share: f64) {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of 0 to 1")]
    let thousandths = (share.clamp(0.0, 1.0) * 1000.0) as u64;
    bar.set_position(thousandths);
}
