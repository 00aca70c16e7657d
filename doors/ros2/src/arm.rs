//! The arm of the node: a robot file, a URDF or the name of a shipped robot.

use std::path::Path;

use rne_convert::{Description, Selection};
use rne_machine::CompiledArm;

/// Loads the arm of a file or a shipped robot, with the rotors of its motors. `selection` chooses the chain of links in
/// a URDF.
///
/// # Errors
/// When there is no such file, or with all errors in the file.
pub fn open(path: &Path, selection: Selection) -> Result<CompiledArm, String> {
    let description = Description::open(path).map_err(|error| error.to_string())?;
    if selection != Selection::default() && !matches!(description, Description::Urdf(_)) {
        return Err(format!("--base, --tip, --lock-others are for a URDF, and {} is a robot file", path.display()));
    }
    let arm = match description {
        Description::Shipped(file) => match file.plan {
            Some(plan) => CompiledArm::with_plan(file.yaml, plan),
            None => CompiledArm::from_yaml(file.yaml),
        },
        Description::Urdf(bytes) => {
            let name = path.display().to_string();
            let imported = rne_convert::import_arm(&name, bytes, selection).map_err(|report| report.to_string())?;
            imported.account.remarks.iter().for_each(|remark| eprintln!("{name}: {remark}"));
            CompiledArm::from_yaml(&imported.text)
        }
        _ => CompiledArm::from_file(path),
    };
    Ok(arm.map_err(|error| error.to_string())?.with_rotors())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(path: &str, selection: Selection) -> String {
        open(Path::new(path), selection).expect_err(path)
    }

    #[test]
    fn what_no_arm_is_says_why() {
        assert!(said("puma", Selection::default()).ends_with("did you mean the shipped robot puma560?"));
        let tip = Selection { tip: Some("hand".to_owned()), ..Selection::default() };
        assert_eq!(said("puma560", tip), "--base, --tip, --lock-others are for a URDF, and puma560 is a robot file");
        let folder = std::env::temp_dir().join(format!("rne-ros2-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let file = folder.join("arm.urdf");
        for (bytes, why) in [(&b"<robot \xff/>"[..], "is not text in UTF-8"), (b"<robot name=\"a\"/>", "arm.urdf")] {
            std::fs::write(&file, bytes).expect("a file");
            let said = said(file.to_str().expect("Unicode"), Selection::default());
            assert!(said.contains(why), "{said}");
        }
        std::fs::remove_dir_all(&folder).expect("the folder");
    }

    #[test]
    fn angles_of_a_urdf_are_those_of_rne_import() {
        let file = std::env::temp_dir().join(format!("rne-ros2-{}.urdf", std::process::id()));
        let body = "<inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/>\
                    </inertial></link>";
        let text = format!(
            "<robot name=\"two\"><link name=\"base\"/><link name=\"a\">{body}<link name=\"b\">{body}\
             <joint name=\"one\" type=\"continuous\"><parent link=\"base\"/><child link=\"a\"/>\
             <axis xyz=\"0 0 1\"/></joint>\
             <joint name=\"two\" type=\"continuous\"><parent link=\"a\"/><child link=\"b\"/>\
             <origin rpy=\"1.5708 0 0\"/><axis xyz=\"0 0 1\"/></joint></robot>"
        );
        std::fs::write(&file, text).expect("a file");
        let arm = open(&file, Selection::default()).expect("an arm");
        std::fs::remove_file(&file).expect("the file");
        let mut joints = arm.robot().joints.iter();
        assert!(joints.any(|joint| joint.row.dh.alpha.radians.abs() == std::f64::consts::FRAC_PI_2), "{arm:?}");
    }

    #[test]
    fn a_shipped_robot_has_its_rotors() {
        let arm = open(Path::new("puma560"), Selection::default()).expect("the shipped robot");
        assert!(arm.robot().rotors && arm.plan().is_some() && arm.dof() == 6);
    }
}
