//! Pages as texts: complete in themselves, small, and inert whatever a robot file says.

use rne_codegen::{Compiler, Form, Function};
use rne_model::Robot;
use rne_search::PlanFile;
use serde_json::Value;

fn robot(yaml: &str) -> Robot {
    Robot::from_yaml(yaml).unwrap_or_else(|error| panic!("{error}"))
}

fn page(robot: &Robot) -> String {
    rne_report::page(robot, None).unwrap_or_else(|error| panic!("{}: {error}", robot.name))
}

fn puma560() -> Robot {
    robot(rne_robots::find("puma560").expect("it is shipped").yaml)
}

const BEFORE_DATA: &str = r#"<script type="application/json" id="data">"#;

/// The page before its data, the data, and the page behind it.
fn parts(page: &str) -> (&str, &str, &str) {
    let (before, rest) = page.split_once(BEFORE_DATA).expect("a page has data");
    let (data, behind) = rest.split_once("</script>").expect("the data end");
    (before, data, behind)
}

#[test]
fn a_page_loads_nothing() {
    let page = page(&puma560());
    let (before, _, behind) = parts(&page);
    // names of languages are no addresses
    let own = [before, behind].concat().replace("http://www.w3.org/1998/Math/MathML", "");
    let own = own.replace("http://www.w3.org/2000/svg", "");
    for loading in ["http:", "https:", "src=", "url(", "@import", "fetch(", "XMLHttpRequest", "import(", "WebSocket"] {
        assert!(!own.contains(loading), "{loading}");
    }
    // and a browser would not let it
    assert!(before.contains("default-src 'none'"), "{before}");
    let addresses = own.matches("href=").count();
    assert_eq!(addresses, own.matches("href=\"#").count() + own.matches("href=\"data:,\"").count());
}

#[test]
fn pages_of_arms_with_seven_joints_are_small() {
    const LARGEST: usize = 425_000;
    let mut sizes = Vec::new();
    for file in shipped::tried() {
        let robot = robot(file.yaml);
        if robot.dof() != 7 {
            continue;
        }
        let compiler = Compiler::new(&robot);
        let compiler = match file.plan {
            Some(plan) => compiler.with_plans(PlanFile::read(file.name, plan, &robot).expect("shipped plans fit")),
            None => compiler,
        };
        let reduced = compiler.compile(Function::InverseDynamics, Form::Reduced).expect("it compiles");
        let page = rne_report::page(&robot, Some(&reduced)).expect("it compiles");
        sizes.push((page.len(), file.name));
    }
    sizes.sort_unstable();
    println!("{sizes:?} bytes, at most {LARGEST}");
    let (largest, name) = sizes.last().expect("some have seven joints");
    assert!(*largest <= LARGEST, "{name}: {largest} bytes");
}

/// For JavaScript 1 and 1.0 are the same number.
fn read_by_a_browser(value: Value) -> Value {
    match value {
        Value::Number(number) => number.as_f64().into(),
        Value::Array(values) => values.into_iter().map(read_by_a_browser).collect(),
        Value::Object(values) => values.into_iter().map(|(key, value)| (key, read_by_a_browser(value))).collect(),
        other => other,
    }
}

#[test]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // numbers of reasons
fn the_data_of_a_page_are_the_inspection() {
    let robot = puma560();
    let page = page(&robot);
    let data: Value = read_by_a_browser(serde_json::from_str(parts(&page).1).expect("JSON"));
    let inspection = rne_inspection::inspect(&robot, Function::InverseDynamics).expect("it compiles");
    let whole = read_by_a_browser(serde_json::to_value(&inspection).expect("JSON"));
    for same in ["robot", "counts"] {
        assert_eq!(data[same], whole[same], "{same}");
    }
    let list = |data: &Value| data["reasons"].as_array().expect("reasons").clone();
    assert!(list(&data).starts_with(&list(&whole)));
    let (cells, all) = (data["cells"].as_array().expect("cells"), whole["cells"].as_array().expect("cells"));
    assert_eq!(cells.len(), all.len());
    for (cell, of) in cells.iter().zip(all) {
        let (components, of) =
            (cell["components"].as_array().expect("some"), of["components"].as_array().expect("some"));
        assert_eq!(components.len(), of.len());
        for (component, of) in components.iter().zip(of) {
            assert_eq!((&component["name"], &component["general"]), (&of["name"], &of["general"]));
            let (became, of) = (&component["became"], &of["became"]);
            if of["kind"] == "computed" {
                assert!(became.is_null(), "{became}");
                continue;
            }
            assert_eq!((&became["kind"], &became["value"], &became["name"]), (&of["kind"], &of["value"], &of["name"]));
            let why = became["why"].as_f64().map(|at| &data["reasons"][at as usize]);
            assert!(why == of.get("why") || of["why"] == "of the table", "{became} {of}");
        }
    }
    for statement in data["programs"]["folded"]["statements"].as_array().expect("statements") {
        let name = statement["name"].as_str().expect("a name");
        assert!(data["names"][name].is_array(), "{name}");
        assert!(data["quantities"][data["names"][name][0].as_str().expect("a quantity")].is_object(), "{name}");
    }
}

/// Whoever writes a robot file writes no page.
#[test]
fn texts_of_a_robot_file_stay_texts() {
    let hostile = r#"</script><script>alert(1)</script><!-- {{data}} "'&amp; <img onerror=alert(2)>"#;
    let mut robot = puma560();
    let ordinary = page(&robot);
    robot.title = Some(hostile.to_owned());
    robot.source = hostile.to_owned();
    robot.joints[0].name = hostile.to_owned();
    let page = page(&robot);
    for tag in ["<script", "</script", "<!--", "<img"] {
        assert_eq!(page.matches(tag).count(), ordinary.matches(tag).count(), "{tag}");
    }
    let (before, data, _) = parts(&page);
    assert!(before.contains("&lt;/script&gt;"), "{before}");
    assert!(!data.contains(['<', '>', '&']), "{data}");
    let data: Value = serde_json::from_str(data).expect("JSON");
    assert_eq!(data["robot"]["title"], hostile);
    assert_eq!(data["robot"]["source"], hostile);
    assert_eq!(data["robot"]["joints"][0]["name"], hostile);
}

/// Texts of a robot file reach the page's tree as texts alone.
#[test]
fn the_scripts_write_no_html() {
    for (name, script) in rne_report::SCRIPTS {
        for writes in
            ["innerHTML", "outerHTML", "insertAdjacentHTML", "document.write", "eval(", "new Function", "</script"]
        {
            assert!(!script.contains(writes), "{name}: {writes}");
        }
    }
}

#[test]
fn every_shipped_robot_has_a_page() {
    for file in shipped::tried() {
        let robot = robot(file.yaml);
        let page = page(&robot);
        let data: Value = serde_json::from_str(parts(&page).1).expect("JSON");
        assert_eq!(data["cells"].as_array().map(Vec::len), Some(7 * robot.dof()), "{}", robot.name);
    }
}
