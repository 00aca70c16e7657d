//! Gives events their dates. A change that lasts over a whole log gets the span of time in which it began.

use rne_identify::ArmLog;
use rne_logs::UtcTime;

use crate::event::{Cause, Event};

/// The dates of a log, and the span of the quiet logs.
pub(crate) struct Dates<'a> {
    log: &'a ArmLog,
    span: Option<[UtcTime; 2]>,
    quiet: Option<[UtcTime; 2]>,
}

impl<'a> Dates<'a> {
    pub(crate) fn of(log: &'a ArmLog, quiet: Option<[UtcTime; 2]>) -> Self {
        Self { log, span: log.span(), quiet }
    }

    /// Sets the dates of events.
    pub(crate) fn give(&self, events: &mut [Event]) {
        let layout = self.log.log().layout();
        for event in events {
            let [start, end] = self.span.map_or([None; 2], |span| span.map(Some));
            event.since_time = if event.is_whole { start } else { layout.utc(event.since) };
            event.until_time = if event.lasts { end } else { layout.utc(event.until) };
            // the error of a model is a mean over the log, so its beginning is unknown
            if event.is_whole && event.cause != Cause::Model {
                [event.not_before, event.not_after] = beside(self.span, self.quiet);
            }
        }
    }
}

/// Returns when a change over a whole log did not exist yet, and when it did not exist any more: the end of quiet logs
/// before the log, and the beginning of quiet logs after it.
fn beside(span: Option<[UtcTime; 2]>, quiet: Option<[UtcTime; 2]>) -> [Option<UtcTime>; 2] {
    let (Some([start, end]), Some([quiet_start, quiet_end])) = (span, quiet) else { return [None; 2] };
    [Some(quiet_end).filter(|before| *before <= start), Some(quiet_start).filter(|after| *after >= end)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quiet_logs_bound_a_change_from_their_side() {
        let at = |second: i64| UtcTime::of_stamp(1_795_420_800_000_000_000 + 1_000_000_000 * second).expect("a date");
        let log = Some([at(100), at(200)]);
        assert_eq!(beside(log, Some([at(0), at(50)])), [Some(at(50)), None]);
        assert_eq!(beside(log, Some([at(300), at(350)])), [None, Some(at(300))]);
        // quiet logs that overlap the log give no bound
        assert_eq!(beside(log, Some([at(0), at(350)])), [None; 2]);
        assert_eq!((beside(log, None), beside(None, log)), ([None; 2], [None; 2]));
    }
}
