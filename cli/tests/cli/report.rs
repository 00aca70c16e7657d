//! `rne report`: the file that it writes.

use std::fs;

use crate::call::{ROOT, fails, fine, folder, rne};

#[test]
fn a_page_is_written_once() {
    let path = folder("report").join("planar2.html");
    let out = path.to_str().expect("UTF-8");
    let called = rne(&["report", "planar2", "-o", out]);
    assert_eq!((called.status, called.out.as_str()), (0, ""), "{}", called.err);
    assert!(called.err.contains("wrote"), "{}", called.err);
    let page = fs::read_to_string(&path).expect("a page");
    assert!(page.starts_with("<!doctype html>") && page.ends_with("</html>\n"), "{}", page.len());
    // the same page is no change, another is not written over it
    assert!(rne(&["report", "planar2", "-o", out]).err.contains("up to date"));
    fails(2, &["report", "puma560", "-o", out], &["exists and is not changed", "--force"]);
    assert_eq!(fs::read_to_string(&path).expect("a page"), page);
    assert_eq!(rne(&["report", "puma560", "-o", out, "--force"]).status, 0);
    assert!(fs::read_to_string(&path).expect("a page").contains("PUMA 560"));
}

/// The reduced code of a page is that of the plan file, as everywhere else.
#[test]
fn a_page_has_the_operations_of_the_plan() {
    let path = folder("report_plan").join("puma560.html");
    assert_eq!(rne(&["report", "robots/puma560.yaml", "-o", path.to_str().expect("UTF-8")]).status, 0);
    let page = fs::read_to_string(&path).expect("a page");
    let (_, rest) = page.split_once("id=\"data\">").expect("data");
    let (data, _) = rest.split_once("</script>").expect("data end");
    let data: serde_json::Value = serde_json::from_str(data).expect("JSON");
    let json = fine(&["show", "robots/puma560.yaml", "--form", "reduced", "--json"]);
    let shown: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(data["programs"]["reduced"]["counts"], shown["counts"]);
    assert_eq!(data["programs"]["reduced"]["outputs"], shown["outputs"]);
}

#[test]
fn what_is_wrong_is_said() {
    let robot = format!("{ROOT}/robots/puma560.yaml");
    fails(2, &["report", &robot, "-o", &robot], &["is also the file that rne reads"]);
    fails(2, &["report", "puma560"], &["--output"]);
    let nowhere = format!("{}/x.html", folder("report_nowhere").join("none").display());
    let called = rne(&["report", "planar1", "-o", &nowhere]);
    assert!(
        called.status == 1 && called.err.contains("none; make it first") && !called.err.contains(".tmp"),
        "{called:?}"
    );
    fails(1, &["report", "nowhere.yaml", "-o", "x.html"], &["nowhere.yaml"]);
}

/// The page is of the arm with what it carries, whose numbers are not those of the plan file.
#[test]
fn a_page_has_the_payload() {
    let page = |payload: &[&str]| {
        let path = folder("report_payload").join("planar2.html");
        let out = path.to_str().expect("UTF-8");
        let called = rne(&[&["report", "planar2", "-o", out], payload].concat());
        assert_eq!(called.status, 0, "{called:?}");
        let page = fs::read_to_string(&path).expect("a page");
        let (_, rest) = page.split_once("id=\"data\">").expect("data");
        let (data, _) = rest.split_once("</script>").expect("data end");
        let data: serde_json::Value = serde_json::from_str(data).expect("JSON");
        assert_eq!(data["programs"]["reduced"]["outputs"].as_array().map(Vec::len), Some(2));
        page
    };
    let nothing = page(&["--payload", "0,0,0,0"]);
    assert!(page(&["--payload", "0,0,0,0,0,0,0,0,0,0"]) == nothing && page(&["--payload", "1,0,0,0"]) != nothing);
}
