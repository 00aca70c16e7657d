//! How far a log was read, as a bar.

use std::io::{self, IsTerminal as _};

use indicatif::{ProgressBar, ProgressFinish, ProgressStyle};
use rne_logs::{Log, LogError, Survey};

/// Surveys a log below a bar.
pub(crate) fn survey(log: &Log, is_result_shown: bool) -> Result<Survey, LogError> {
    log.survey(progress(is_result_shown))
}

/// A bar on a terminal, unless that shows the result meanwhile. It is cleared when it is dropped.
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

/// Shows shares of a log, 0 to 1, in a bar, until the function is dropped.
pub(crate) fn progress(is_result_shown: bool) -> impl FnMut(f64) {
    let bar = bar("read", is_result_shown);
    move |share| show(&bar, share)
}

/// Shows a share of 0 to 1.
pub(crate) fn show(bar: &ProgressBar, share: f64) {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of 0 to 1")]
    let thousandths = (share.clamp(0.0, 1.0) * 1000.0) as u64;
    bar.set_position(thousandths);
}
