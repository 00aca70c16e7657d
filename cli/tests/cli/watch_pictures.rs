//! `rne watch --plot`: the pictures of a log and of a trend.

use std::fs;

use crate::call::{fails, folder, rne};
use crate::watch::{ARM, KNOCK, QUIET, WORN};
use crate::watch_dates::{FRIDAY, MONDAY, dated};

/// What is drawn is what is used: the contact's thresholds as curves, and the event.
#[test]
fn the_picture_has_the_events() {
    let folder = folder("watch_picture");
    let picture = folder.join("knock.svg");
    let path = picture.to_str().expect("UTF-8");
    let output = rne(&["watch", ARM, KNOCK, "--plot", path]);
    assert_eq!(output.status, 1, "{}", output.err);
    let svg = fs::read_to_string(&picture).expect("a picture");
    assert!(svg.contains("contact of shoulder: external -2.1") && svg.contains("contact threshold"), "{svg}");
    for curve in ["residual", "external torque", "contact threshold"] {
        let found = svg.matches(&format!("<title>{curve}</title>")).count();
        // of a threshold the parts inside of the axes are drawn
        assert!(found == 3 || curve == "contact threshold" && found >= 6, "{curve}: {found}");
    }
    // once more is the same; another picture is not written over it
    assert_eq!(rne(&["watch", ARM, KNOCK, "--plot", path]).status, 1);
    fails(2, &["watch", ARM, QUIET, "--plot", path], &["--force"]);
    assert_eq!(fs::read_to_string(&picture).expect("a picture"), svg);
    // friction that grew has a curve of its own
    let worn = folder.join("worn.svg");
    rne(&["watch", ARM, WORN, "--quiet", QUIET, "--plot", worn.to_str().expect("UTF-8")]);
    let svg = fs::read_to_string(&worn).expect("a picture");
    assert!(svg.contains("changed parameters") && svg.contains("friction of elbow: coulomb 0.45"), "{svg}");
}

/// The numbers of an attribute that follows each of some words.
fn numbers_after(text: &str, before: &str) -> Vec<f64> {
    let each = text.split(before).skip(1);
    each.filter_map(|rest| rest.split('"').next()?.parse().ok()).collect()
}

/// The heading of a panel is the root mean square of its curve, by the pixels of the curve and of the ticks; the curves
/// fill a half of the panel, whatever the thresholds are.
#[test]
fn the_heading_of_a_panel_is_that_of_its_curve() {
    let folder = folder("watch_heading");
    let picture = folder.join("worn.svg");
    rne(&["watch", ARM, WORN, "--quiet", QUIET, "--plot", picture.to_str().expect("UTF-8")]);
    let svg = fs::read_to_string(&picture).expect("a picture");
    let panels: Vec<&str> = svg.split(" N m, RMS<").collect();
    assert_eq!(panels.len(), 4, "{svg}");
    for panel in &panels[..3] {
        let heading: f64 = panel.rsplit("residual ").next().expect("words").parse().expect("a number");
        let tail = panel.rsplit("font-weight=\"600\"").next().expect("a panel");
        // the labels beside the axis are 5 pixels below their ticks
        let labels = tail.split("<text ").filter(|text| text.contains("text-anchor=\"end\""));
        let ticks: Vec<(f64, f64)> = labels
            .filter_map(|text| {
                let label = text.split('>').nth(1)?.split('<').next()?.replace('\u{2212}', "-");
                Some((numbers_after(text, "y=\"").first()? - 5.0, label.parse().ok()?))
            })
            .collect();
        let ((y0, v0), (y1, v1)) = (ticks[0], ticks[ticks.len() - 1]);
        let value = |y: f64| v0 + (y - y0) / (y1 - y0) * (v1 - v0);
        let curve = tail.split("<polyline points=\"").find(|curve| curve.contains("<title>residual</title>"));
        let points = curve.and_then(|curve| curve.split('"').next()).expect("a curve").split(' ');
        let values: Vec<f64> =
            points.map(|point| value(point.split_once(',').expect("a point").1.parse().expect("a number"))).collect();
        let count = f64::from(u32::try_from(values.len()).expect("few"));
        let found = (values.iter().map(|value| value * value).sum::<f64>() / count).sqrt();
        assert!((found - heading).abs() < 0.01 * heading + 1e-3, "{found} {heading}");
        let ends = values.iter().fold((0.0, 0.0), |(low, high): (f64, f64), value| (low.min(*value), high.max(*value)));
        assert!(ends.1 - ends.0 > 0.3 * (v1 - v0).abs(), "{ends:?} {v0} {v1}");
    }
    assert!(
        svg.contains(">contact threshold up to 1.") && svg.contains(">contact threshold down to \u{2212}1."),
        "{svg}"
    );
}

/// A trend is drawn over what the rows of its table are named.
#[test]
fn the_picture_of_a_trend_has_names() {
    let folder = folder("watch_trend_names");
    let logs = [dated(&folder, QUIET, "a.csv", MONDAY), dated(&folder, WORN, "b.csv", FRIDAY)];
    for (by, names) in [("day", ["2026-11-23", "2026-11-27"]), ("log", ["a.csv", "b.csv"])] {
        let picture = folder.join(format!("{by}.svg"));
        rne(&["watch", ARM, &logs[0], &logs[1], "--by", by, "--plot", picture.to_str().expect("UTF-8")]);
        let svg = fs::read_to_string(&picture).expect("a picture");
        for name in names {
            // three joints and the payload
            assert_eq!(svg.matches(&format!("\">{name}</text>")).count(), 4, "{by} {name}: {svg}");
        }
        assert!(!svg.contains(">log</text>") && svg.matches("<circle").count() == 8, "{svg}");
    }
}

/// A picture that cannot be written is refused before the logs are read.
#[test]
fn a_picture_without_a_place_is_refused_at_once() {
    let folder = folder("watch_no_place");
    let path = |name: &str| folder.join(name).to_str().expect("UTF-8").to_owned();
    fs::write(path("notes.txt"), "not a picture").expect("a file");
    for (status, name, words) in [(1, "none/knock.svg", "no folder"), (2, ".", "folder"), (2, "notes.txt", "--force")] {
        fails(status, &["watch", ARM, "there_is_none.csv", "--plot", &path(name)], &[words]);
    }
    fails(2, &["watch", ARM, QUIET, "--plot", QUIET], &["is also the file that rne reads"]);
    // a place is tried, and left as it is
    fails(1, &["watch", ARM, "there_is_none.csv", "--plot", &path("knock.svg")], &["there_is_none.csv"]);
    assert_eq!(fs::read_dir(&folder).expect("a folder").count(), 1);
}
