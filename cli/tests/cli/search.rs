//! `rne search`: what it writes, what it goes on from, and what it refuses.

use std::fs;

use crate::call::{ROOT, fails, fine, folder, rne, rne_reading};

/// A copy of a small robot in a folder of its own: the robot file and its plan file.
fn arm(name: &str) -> (String, String) {
    let folder = folder(name);
    let path = |file: &str| folder.join(file).to_str().expect("UTF-8").to_owned();
    fs::copy(format!("{ROOT}/robots/scara_cobra600.yaml"), path("arm.yaml")).expect("a copy");
    (path("arm.yaml"), path("arm.plan.yaml"))
}

/// The plan that is shipped with that robot, which has rewritten graphs: how many a search finds in a time is no matter
/// of a test.
fn shipped_plan(plan: &str) {
    fs::copy(format!("{ROOT}/robots/scara_cobra600.plan.yaml"), plan).expect("a copy");
}

/// Products and sums of each form that a search says it has found.
fn totals(out: &str) -> Vec<u64> {
    let counts = out.lines().filter_map(|line| line.split_once("sums = ")?.1.split(',').next());
    counts.map(|count| count.parse().unwrap_or_else(|_| panic!("{out}"))).collect()
}

#[test]
fn a_plan_is_written_replayed_and_never_becomes_worse() {
    let (robot, plan) = arm("search");
    let first = fine(&["search", &robot, "--seconds", "0.5", "--rewrite"]);
    let told = "arm.plan.yaml is written\nbuilds, emit and certify use this plan from now on: their code changes\n";
    assert!(first.ends_with(told), "{first}");
    shipped_plan(&plan);
    let first = fine(&["search", &robot, "--seconds", "0"]);
    let written = fs::read_to_string(&plan).expect("a plan");
    for part in
        ["format: 3\n", "fingerprint: ", "\nreduced:\n", "\nrewritten:\n  inverse_dynamics:\n", "    graph: |\n"]
    {
        assert!(written.contains(part), "no `{part}` in {written}");
    }
    let found = totals(&first);
    assert!(found.len() > 2, "{first}");
    assert!(found[1] < found[0], "rewriting helps: {first}");

    // what was found is what is built
    for (without, total) in [(&["--without", "rewriting"][..], found[0]), (&[], found[1])] {
        let call: Vec<&str> = ["ops", &robot].iter().chain(without).copied().collect();
        let ops = fine(&call);
        let line = ops.lines().find(|line| line.contains("inverse_dynamics ") && line.contains("reduced"));
        let line = line.expect("the reduced form");
        let generated = line.split_once('→').expect("an arrow").1;
        assert_eq!(generated.split_whitespace().nth(2), Some(total.to_string().as_str()), "{line}");
    }

    let again = fine(&["search", &robot, "--seconds", "0.5", "--rewrite", "--seed", "2"]);
    let better = totals(&again);
    assert!(better.len() == found.len() && better.iter().zip(&found).all(|(a, b)| a <= b), "{first}{again}");
    let is_anew = again.contains("is written anew");
    assert!(is_anew || (better == found && again.contains("is as good as it was")), "{first}{again}");
    let before = fs::read_to_string(&plan).expect("a plan");
    let idle = fine(&["search", &robot, "--seconds", "0"]);
    assert!(idle.contains("is as good as it was") && totals(&idle) == better, "{idle}");
    assert_eq!(fs::read_to_string(&plan).expect("a plan"), before, "a rewritten graph is kept");

    let fresh = fine(&["search", &robot, "--seconds", "0", "--fresh"]);
    assert!(fresh.contains("is as good as it was"), "a plan that fits is kept: {fresh}");
    assert_eq!(totals(&fresh), better);
    fs::write(&plan, "my: notes\n").expect("written");
    fails(
        2,
        &["search", &robot, "--seconds", "0", "--fresh"],
        &["was not written by `rne search`", "rne does not overwrite it"],
    );
    assert_eq!(fs::read_to_string(&plan).expect("notes"), "my: notes\n");
    let names: Vec<_> =
        fs::read_dir(folder_of(&robot)).expect("a folder").map(|entry| entry.expect("an entry").file_name()).collect();
    assert_eq!(names.len(), 2, "no temporary file is left: {names:?}");
}

fn folder_of(file: &str) -> &std::path::Path {
    std::path::Path::new(file).parent().expect("a folder")
}

#[test]
fn a_stale_plan_is_refused_and_stays_as_it_is() {
    let (robot, plan) = arm("search_stale");
    fine(&["search", &robot, "--seconds", "0"]);
    let written = fs::read_to_string(&plan).expect("a plan");
    let text = fs::read_to_string(&robot).expect("a robot");
    let heavier = text.replacen("mass: ", "mass: 1+", 1);
    assert_ne!(text, heavier);
    fs::write(&robot, &heavier).expect("written");

    let parts = ["arm.plan.yaml:7:14", "numbers of the robot file have changed", "--fresh"];
    for call in [
        &["search", &robot, "--seconds", "0"][..],
        &["show", &robot, "--form", "reduced"],
        &["emit", &robot, "--form", "reduced"],
        &["ops", &robot],
    ] {
        fails(1, call, &parts);
    }
    assert_eq!(fs::read_to_string(&plan).expect("a plan"), written, "nothing is overwritten");
    assert!(!fine(&["show", &robot]).is_empty(), "the seven steps need no plan");
    assert!(!fine(&["emit", &robot]).is_empty());

    assert!(fine(&["search", &robot, "--seconds", "0", "--fresh"]).contains("is written"));
    assert_ne!(fs::read_to_string(&plan).expect("a plan"), written);
    fine(&["show", &robot, "--form", "reduced"]);

    // names and comments are no numbers
    fs::write(&robot, format!("# a comment\n{heavier}")).expect("written");
    fine(&["show", &robot, "--form", "reduced"]);

    fs::write(&plan, "format: 3\nrobot: scara_cobra600\n").expect("written");
    fails(1, &["search", &robot, "--seconds", "0"], &["arm.plan.yaml:", "fingerprint"]);
    fails(1, &["show", &robot, "--form", "reduced"], &["arm.plan.yaml:", "fingerprint"]);
    let older = written.replacen("format: 3", "format: 1", 1);
    fs::write(&plan, older).expect("written");
    fails(1, &["show", &robot, "--form", "reduced"], &["arm.plan.yaml:5:9", "`format: 3`", "rne search"]);
}

/// Functions that other algorithms write, and one that no choice touches.
#[test]
fn any_function_is_rewritten_where_it_pays() {
    let (robot, plan) = arm("search_rewritten");
    let total = |function: &str, without: &[&str]| -> u64 {
        let call: Vec<&str> = ["ops", &robot, "--function", function].iter().chain(without).copied().collect();
        let ops = fine(&call);
        let line = ops.lines().find(|line| line.contains(" reduced ")).unwrap_or_else(|| panic!("{ops}"));
        let generated = line.split_once('→').expect("an arrow").1;
        generated.split_whitespace().nth(2).and_then(|total| total.parse().ok()).unwrap_or_else(|| panic!("{line}"))
    };
    shipped_plan(&plan);
    let functions = ["mass_matrix", "forward_dynamics", "jacobian_rate_times_velocity"];
    let found = fine(&["search", &robot, "--seconds", "0", "--rewrite", "--function", &functions.join(",")]);
    let written = fs::read_to_string(&plan).expect("a plan");
    for function in functions {
        assert!(found.contains(&format!("{function}  ")), "{found}");
        assert!(total(function, &[]) < total(function, &["--without", "rewriting"]), "{function}: {found}");
    }
    let at = |text: &str| written.find(text).unwrap_or_else(|| panic!("no `{text}` in {written}"));
    assert!(written[at("  forward_dynamics:")..].contains("    algorithm: "), "{written}");
    let checked = fine(&["check", &robot.replace(".yaml", ".plan.yaml")]);
    assert!(checked.contains(" other functions rewritten; proved"), "{checked}");
    let shown = fine(&["show", &robot, "--function", "mass_matrix", "--form", "reduced"]);
    assert!(shown.contains("rewritten by algebra") && shown.contains("Identical to the seven steps"), "{shown}");

    // a trick that no graph uses leaves the graphs, one that all use does not
    let operations = total("mass_matrix", &[]);
    assert_eq!(total("mass_matrix", &["--without", "carried-prismatics"]), operations);
    assert!(total("mass_matrix", &["--without", "regrouping"]) > operations);

    // functions that have no graph, or not by this algorithm, or two
    let refused = |wrong: &str, parts: &[&str]| {
        fs::write(&plan, wrong).expect("written");
        let called = rne(&["check", &robot]);
        assert!(called.status == 1 && parts.iter().all(|part| called.out.contains(part)), "{called:?}");
    };
    let replaced = |from: &str, to: &str| written.replacen(from, to, 1);
    refused(&replaced("  mass_matrix:", "  joint_wrenches:"), &["`joint_wrenches` has no reduced form"]);
    refused(&replaced("  mass_matrix:", "  forward_dynamics:"), &["repeated key `forward_dynamics`"]);
    refused(&replaced("  mass_matrix:", "  jacobian:"), &["the choices of a plan have no effect on `jacobian`"]);
    let (before, graph) = written.split_at(at("  mass_matrix:"));
    let wrong = graph.replacen("    algorithm: ", "    algorithm: aba_by_joints # ", 1);
    refused(
        &format!("{before}{wrong}"),
        &["the algorithms of `mass_matrix` are `crba_by_groups`", "algorithm: aba_by_joints"],
    );

    // a graph with a wrong sign: no time is spent on a search from there, and a fresh one keeps the others
    let wrong = format!("{before}{}", graph.replacen("results ", "results -", 1).replacen("--", "", 1));
    let edited = "this form of `mass_matrix` does not compute the same as the seven steps";
    refused(&wrong, &["graph: |", edited]);
    for call in [&["search", &robot, "--seconds", "1000"][..], &["ops", &robot]] {
        fails(1, call, &["arm.plan.yaml:", "graph: |", edited, "--fresh"]);
    }
    assert_eq!(fs::read_to_string(&plan).expect("a plan"), wrong, "nothing is overwritten");
    let fresh = fine(&["search", &robot, "--seconds", "0", "--fresh"]);
    assert!(fresh.contains("`--rewrite --function mass_matrix`") && fresh.contains("forward_dynamics  "), "{fresh}");
    let kept = fs::read_to_string(&plan).expect("a plan");
    assert!(!kept.contains("  mass_matrix:") && kept.contains("  forward_dynamics:"), "{kept}");
}

#[test]
fn arguments_of_a_search() {
    let (robot, plan) = arm("search_arguments");
    let text = fs::read_to_string(&robot).expect("a robot");
    let called = rne_reading(&["search", "-"], &text);
    assert_eq!((called.status, called.out.as_str()), (2, ""));
    assert!(called.err.contains("next to the robot file, so it needs a file"), "{}", called.err);
    for seconds in ["-1", "nan", "1e9", "soon"] {
        fails(2, &["search", &robot, "--seconds", seconds], &["--seconds", "a number of seconds, 0 to 1000000"]);
    }
    fails(2, &["search", &robot, "--seed", "x"], &["--seed"]);
    fails(2, &["search", &robot, "--function", "mass_matrix"], &["--rewrite"]);
    for functions in ["joint_wrenches", "joint_wrenches,all"] {
        fails(2, &["search", &robot, "--rewrite", "--function", functions], &["has only the form seven_steps"]);
    }
    assert_eq!(rne(&["search"]).status, 2);
    fails(1, &["search", "nowhere.yaml"], &["no robot file nowhere.yaml"]);
    assert!(!fs::exists(&plan).expect("a folder"), "nothing was written");
}

/// A plan with a function that the robot does not have is refused by all that read it, so no search writes one.
#[test]
fn functions_that_the_robot_does_not_have_are_refused() {
    let folder = folder("search_refused");
    let path = folder.join("arm.yaml");
    let robot = path.to_str().expect("UTF-8");
    for (file, function, says) in [
        ("docs/gripper.yaml", "regressor", "the joint `finger_b` follows other joints"),
        ("robots/planar2.yaml", "floating_forward_dynamics", "has no `floating_base`"),
        ("docs/satellite.yaml", "forward_dynamics_in_contact", "has no `contacts`"),
        ("robots/planar2.yaml", "inverse_dynamics_of_loops", "robots with closed loops"),
    ] {
        fs::copy(format!("{ROOT}/{file}"), &path).expect("a copy");
        fails(2, &["search", robot, "--seconds", "0", "--rewrite", "--function", function], &[says]);
        assert!(!folder.join("arm.plan.yaml").exists(), "{function}");
    }
}
