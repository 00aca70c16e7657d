//! Trees through the functions of C, beside the numbers that `rne eval` prints for the same state: those of a recursion
//! in loops, which shares no code with the compiler.
#![allow(unsafe_code)]

use std::ffi::CStr;
use std::ptr::null_mut;

use rne::Status;
use rne::border::{
    Input, rne_arm_at_frame, rne_arm_dof, rne_arm_free, rne_arm_joint_name, rne_arm_load_file, rne_evaluate,
    rne_function_find, rne_last_error,
};

const FILE: &CStr =
    match CStr::from_bytes_with_nul(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/tree.yaml\0").as_bytes()) {
        Ok(path) => path,
        Err(_) => panic!("a path has no zero"),
    };

const Q: [f64; 5] = [0.3, -0.8, 0.1, 0.2, 1.1];
const QD: [f64; 5] = [0.5, -0.7, 0.3, -0.2, 0.9];
const QDD: [f64; 5] = [1.0, 2.0, -0.5, 0.4, -1.5];

/// `rne eval docs/tree.yaml --q … --qd … --qdd … --json`
const TORQUES: [f64; 5] = [
    0.458_229_406_214_130_33,
    3.648_410_095_189_874,
    -0.811_071_132_802_740_9,
    0.782_511_634_594_111,
    1.643_852_153_227_713_7,
];

/// `rne eval docs/tree.yaml --function jacobian --q … --json`
const JACOBIAN: [[f64; 5]; 6] = [
    [-0.361_358_731_581_716_55, -0.113_622_015_594_965_36, 0.211_993_220_232_397_64, 0.0, 0.0],
    [-0.111_781_354_791_178_7, 0.367_309_087_565_244_3, -0.685_316_449_332_819_2, 0.0, 0.0],
    [0.0, 0.178_252_831_012_932_96, -0.696_706_709_347_165_4, 0.0, 0.0],
    [0.0, 0.955_336_489_125_606, 0.0, 0.0, 0.0],
    [0.0, 0.295_520_206_661_339_55, 0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0, 0.0, 0.0],
];

#[test]
fn a_tree_has_the_numbers_of_rne_eval() {
    // SAFETY: texts that end, places for what is written, and arrays of their lengths.
    unsafe {
        let mut arm = null_mut();
        let status = rne_arm_load_file(FILE.as_ptr(), &raw mut arm);
        assert_eq!(status, Status::Ok, "{:?}", CStr::from_ptr(rne_last_error()));
        assert_eq!(rne_arm_dof(arm), 5);
        // in the order of the rows
        assert_eq!(CStr::from_ptr(rne_arm_joint_name(arm, 4)), c"right");
        let inputs = [(c"q", &Q), (c"qd", &QD), (c"qdd", &QDD)].map(|(name, data)| Input {
            name: name.as_ptr(),
            data: data.as_ptr(),
            count: data.len(),
            state_stride: 0,
            element_stride: 0,
        });
        let numbers = |arm, function: &CStr, expected: &[f64]| {
            let mut id = 0;
            assert_eq!(rne_function_find(function.as_ptr(), &raw mut id), Status::Ok);
            let mut found = vec![f64::NAN; expected.len()];
            let status = rne_evaluate(arm, id, inputs.as_ptr(), 3, found.as_mut_ptr(), found.len());
            assert_eq!(status, Status::Ok, "{:?}", CStr::from_ptr(rne_last_error()));
            found
        };
        for (function, expected) in [(c"inverse_dynamics", &TORQUES[..]), (c"jacobian", JACOBIAN.as_flattened())] {
            for (found, expected) in numbers(arm, function, expected).iter().zip(expected) {
                assert!((found - expected).abs() < 1e-13, "{function:?}: {found} {expected}");
            }
        }
        // the waist turns the right arm, and no joint of the left one moves it
        let mut right = null_mut();
        assert_eq!(rne_arm_at_frame(arm, c"right".as_ptr(), &raw mut right), Status::Ok);
        let jacobian = numbers(right, c"jacobian", JACOBIAN.as_flattened());
        let columns = [0, 1, 2, 3, 4].map(|joint| (0..6).any(|row| jacobian[5 * row + joint].abs() > 1e-9));
        assert_eq!(columns, [true, false, false, false, true]);
        rne_arm_free(right);
        rne_arm_free(arm);
    }
}

const GRIPPER: &CStr =
    match CStr::from_bytes_with_nul(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/gripper.yaml\0").as_bytes()) {
        Ok(path) => path,
        Err(_) => panic!("a path has no zero"),
    };

/// `rne eval docs/gripper.yaml --q 0.3,-0.8,0.01 --qd 0.5,-0.7,0.3 --qdd 1,2,-0.5 --json`
const TORQUES_OF_GRIPPER: [f64; 3] = [0.029_574_074_712_580_382, 3.546_112_620_453_954, -0.101_237_299_880_575_28];

#[test]
fn a_follower_is_no_joint_of_an_array() {
    // SAFETY: texts that end, places for what is written, and arrays of their lengths.
    unsafe {
        let mut arm = null_mut();
        assert_eq!(rne_arm_load_file(GRIPPER.as_ptr(), &raw mut arm), Status::Ok);
        assert_eq!(rne_arm_dof(arm), 3);
        assert_eq!(CStr::from_ptr(rne_arm_joint_name(arm, 2)), c"finger_a");
        assert!(rne_arm_joint_name(arm, 3).is_null());
        let state = [(c"q", [0.3, -0.8, 0.01]), (c"qd", [0.5, -0.7, 0.3]), (c"qdd", [1.0, 2.0, -0.5])];
        let inputs = state.each_ref().map(|(name, data)| Input {
            name: name.as_ptr(),
            data: data.as_ptr(),
            count: data.len(),
            state_stride: 0,
            element_stride: 0,
        });
        let mut id = 0;
        assert_eq!(rne_function_find(c"inverse_dynamics".as_ptr(), &raw mut id), Status::Ok);
        let mut found = [f64::NAN; 3];
        assert_eq!(rne_evaluate(arm, id, inputs.as_ptr(), 3, found.as_mut_ptr(), 3), Status::Ok);
        for (found, expected) in found.iter().zip(TORQUES_OF_GRIPPER) {
            assert!((found - expected).abs() < 1e-13, "{found} {expected}");
        }
        rne_arm_free(arm);
    }
}
