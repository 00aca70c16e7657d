//! The document is LaTeX: it compiles, where there is a compiler.

use std::path::Path;
use std::process::Command;

use rne_symbolic::{ClosedForm, LatexStyle, read};

/// A compiler and its arguments before the file.
const COMPILERS: [(&str, &[&str]); 2] =
    [("pdflatex", &["-interaction=nonstopmode", "-halt-on-error"]), ("tectonic", &["--chatter=minimal"])];

fn is_there(program: &str) -> bool {
    Command::new(program).arg("--version").output().is_ok_and(|output| output.status.success())
}

fn document(name: &str, joints: usize, title: &str) -> String {
    latex(name, joints, title, LatexStyle::Article)
}

fn latex(name: &str, joints: usize, title: &str, style: LatexStyle) -> String {
    let file = rne_robots::find(name).expect("it is shipped");
    let robot = read(name, file.yaml.as_bytes()).expect("it is valid");
    ClosedForm::of(&robot, joints).latex(title, style)
}

#[test]
fn documents_compile() {
    let Some((compiler, arguments)) = COMPILERS.into_iter().find(|(program, _)| is_there(program)) else {
        eprintln!("skipped: neither pdflatex (texlive-latex-base) nor tectonic is here");
        return;
    };
    let folder = tempfile::tempdir().expect("a folder");
    let hostile = r#"50% \input{/etc/passwd} $x^2 ~ #1 & {_} -- "<Möbius>" |"#;
    let compiles = |text: &str, name: &str| {
        std::fs::write(folder.path().join("form.tex"), text).expect("a file");
        let run = Command::new(compiler).args(arguments).arg("form.tex").current_dir(folder.path()).output();
        let run = run.expect("it starts");
        let said = String::from_utf8_lossy(&run.stdout);
        assert!(run.status.success() && is_written(&folder.path().join("form.pdf")), "{name}: {said}\n{text}");
        // a formula that runs into the margin
        assert!(!said.contains("Overfull"), "{name}: {said}");
    };
    // the class of slides is a package of its own (latex-beamer, with texlive-pictures)
    let slides = Command::new("kpsewhich").args(["beamer.cls", "pgfmath.sty"]).output();
    let has_slides = slides.is_ok_and(|found| found.stdout.split(|byte| *byte == b'\n').count() > 2);
    for (name, joints) in [("planar2", 2), ("stanford", 3), ("puma560", 6)] {
        let packages = "\\usepackage{amsmath}\\usepackage[margin=2cm]{geometry}";
        let body = latex(name, joints, hostile, LatexStyle::Body);
        compiles(
            &format!("\\documentclass{{article}}{packages}\n\\begin{{document}}\n{body}\\end{{document}}\n"),
            name,
        );
        if has_slides {
            let frames = latex(name, joints, hostile, LatexStyle::Beamer);
            let head = "\\documentclass{beamer}\n\\begin{document}";
            compiles(&format!("{head}\n{frames}\\end{{document}}\n"), name);
        }
    }
    for (name, joints, title) in [
        ("planar1", 1, hostile),
        ("planar2", 2, "two links"),
        ("stanford", 3, "Stanford"),
        ("puma560", 3, "PUMA"),
        ("cylindrical_rpp", 3, "a cylinder"),
        ("puma560", 6, "its recursion"),
        ("jaco", 3, "angles that are not right"),
        ("ur5", 2, "names of several letters"),
    ] {
        compiles(&document(name, joints, title), name);
    }
}

fn is_written(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|file| file.len() > 10_000)
}

/// Letters that LaTeX has in mathematics alone, or not at all, stand nowhere.
#[test]
fn documents_are_ascii_and_groups_are_closed() {
    for file in rne_robots::ROBOTS {
        let text = document(file.name, 2, "title");
        assert!(text.is_ascii(), "{}: {:?}", file.name, text.lines().find(|line| !line.is_ascii()));
        let count = |c: char| text.chars().filter(|other| *other == c).count();
        assert_eq!(count('{'), count('}'), "{}", file.name);
        assert_eq!(count('$') % 2, 0, "{}", file.name);
    }
    let recursion = document("stanford", 6, "title");
    assert!(recursion.is_ascii(), "{:?}", recursion.lines().find(|line| !line.is_ascii()));
}
