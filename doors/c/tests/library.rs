//! The library as C sees it: numbers, statuses and words.
#![allow(unsafe_code)]

use std::ffi::{CStr, CString, c_char};
use std::ptr::{null, null_mut};

use rne::border::{
    Input, InputF32, rne_arm_at_frame, rne_arm_builtin, rne_arm_dof, rne_arm_free, rne_arm_joint_kind,
    rne_arm_joint_limits, rne_arm_joint_name, rne_arm_load_file, rne_arm_load_text, rne_arm_load_urdf, rne_arm_name,
    rne_evaluate, rne_evaluate_batch, rne_evaluate_batch_f32, rne_evaluate_batch_threads,
    rne_evaluate_batch_threads_f32, rne_evaluate_f32, rne_function_argument, rne_function_arguments,
    rne_function_count, rne_function_find, rne_function_outputs, rne_function_prepare, rne_last_error, rne_version,
};
use rne::{Arm, JointKind, Limits, Status};
use rne_machine::{Arguments, Array, CompiledArm, Destination, Function};

/// The words of the last failure.
fn words() -> String {
    // SAFETY: it is a text of this thread's.
    unsafe { CStr::from_ptr(rne_last_error()) }.to_str().expect("UTF-8").to_owned()
}

fn text(pointer: *const c_char) -> String {
    assert!(!pointer.is_null());
    // SAFETY: the library's texts end.
    unsafe { CStr::from_ptr(pointer) }.to_str().expect("UTF-8").to_owned()
}

/// An arm that is freed at the end.
struct Held(*mut Arm);

impl Drop for Held {
    fn drop(&mut self) {
        // SAFETY: it is freed here alone.
        unsafe { rne_arm_free(self.0) };
    }
}

fn made(make: impl FnOnce(*mut *mut Arm) -> Status) -> Held {
    let mut arm = null_mut();
    assert_eq!(make(&raw mut arm), Status::Ok, "{}", words());
    Held(arm)
}

fn puma() -> Held {
    // SAFETY: a text and a place.
    made(|arm| unsafe { rne_arm_builtin(c"puma560".as_ptr(), arm) })
}

fn refused(make: impl FnOnce(*mut *mut Arm) -> Status, status: Status, part: &str) {
    let mut arm = std::ptr::dangling_mut();
    assert_eq!(make(&raw mut arm), status, "{}", words());
    assert!(words().contains(part), "{}", words());
    assert!(arm.is_null());
}

fn id(name: &CStr) -> u32 {
    let mut id = u32::MAX;
    // SAFETY: a text and a place.
    assert_eq!(unsafe { rne_function_find(name.as_ptr(), &raw mut id) }, Status::Ok);
    id
}

fn input(name: &CStr, data: &[f64], state_stride: usize, element_stride: usize) -> Input {
    Input { name: name.as_ptr(), data: data.as_ptr(), count: data.len(), state_stride, element_stride }
}

fn one(arm: &Held, id: u32, inputs: &[Input], outputs: &mut [f64]) -> Status {
    // SAFETY: slices.
    unsafe { rne_evaluate(arm.0, id, inputs.as_ptr(), inputs.len(), outputs.as_mut_ptr(), outputs.len()) }
}

fn many(arm: &Held, id: u32, states: usize, inputs: &[Input], outputs: &mut [f64]) -> Status {
    let (room, count) = (outputs.as_mut_ptr(), outputs.len());
    // SAFETY: slices.
    unsafe { rne_evaluate_batch(arm.0, id, states, inputs.as_ptr(), inputs.len(), room, count) }
}

fn numbers(value: &serde_json::Value) -> Vec<f64> {
    value.as_array().expect("an array").iter().map(|number| number.as_f64().expect("a number")).collect()
}

#[test]
fn torques_of_the_puma_are_pinocchios() {
    let golden: serde_json::Value =
        serde_json::from_str(include_str!("../../../tests/reference/puma560.golden.json")).expect("JSON");
    let (arm, id) = (puma(), id(c"inverse_dynamics"));
    let states = golden["states"].as_array().expect("states");
    assert_eq!(states.len(), 16);
    for state in states {
        let [q, qd, qdd, expected] = ["q", "qd", "qdd", "tau"].map(|key| numbers(&state[key]));
        let inputs = [input(c"q", &q, 0, 0), input(c"qd", &qd, 0, 0), input(c"qdd", &qdd, 0, 0)];
        let mut tau = [0.0; 6];
        assert_eq!(one(&arm, id, &inputs, &mut tau), Status::Ok, "{}", words());
        let largest = expected.iter().fold(0.0_f64, |largest, torque| largest.max(torque.abs()));
        for (torque, expected) in tau.iter().zip(&expected) {
            assert!((torque - expected).abs() <= 3e-15 * largest, "{torque} {expected}");
        }
    }
}

#[test]
fn numbers_are_the_compiled_arms_in_every_bit() {
    let file = rne_robots::find("panda").expect("it is shipped");
    let ours = CompiledArm::with_plan(file.yaml, file.plan.expect("a plan")).expect("an arm");
    // SAFETY: a text and a place.
    let arm = made(|arm| unsafe { rne_arm_builtin(c"panda".as_ptr(), arm) });
    let states = 37;
    // interleaved: q, qd, qdd of a joint stand beside each other
    let data: Vec<f64> = (0..states * 21).map(|index| f64::from(u32::try_from(index).expect("few")).sin()).collect();
    let at = |offset: usize| Array::Strided { numbers: &data[offset..], state: 21, element: 3 };
    let inputs = [c"q", c"qd", c"qdd"];
    let inputs: Vec<Input> =
        inputs.iter().enumerate().map(|(offset, name)| input(name, &data[offset..], 21, 3)).collect();
    let single: Vec<f32> = (0..21_u8).map(|index| f32::from(index).cos()).collect();
    for (name, function) in [
        (c"inverse_dynamics", Function::InverseDynamics),
        (c"mass_matrix", Function::MassMatrix),
        (c"jacobian", Function::Jacobian),
        (c"inverse_dynamics_derivatives", Function::InverseDynamicsDerivatives),
        (c"kinetic_energy", Function::KineticEnergy),
    ] {
        let id = id(name);
        let outputs = ours.function(function).expect("a function").outputs();
        let mut expected = vec![0.0; states * outputs];
        let arguments = Arguments::new().q(at(0)).qd(at(1)).qdd(at(2));
        ours.run(function, states, &arguments, Destination::Rows(&mut expected)).expect("numbers");
        let mut found = vec![f64::NAN; states * outputs];
        assert_eq!(many(&arm, id, states, &inputs, &mut found), Status::Ok, "{}", words());
        assert_eq!(found, expected);
        let mut first = vec![f64::NAN; outputs];
        assert_eq!(one(&arm, id, &inputs, &mut first), Status::Ok, "{}", words());
        assert_eq!(first, expected[..outputs]);

        // one row for all, in single precision
        let arguments = Arguments::new();
        let arguments = arguments.q(Array::Same(&single[..7])).qd(Array::Same(&single[7..14]));
        let arguments = arguments.qdd(Array::Same(&single[14..]));
        let mut expected = vec![0.0_f32; 2 * outputs];
        ours.run(function, 2, &arguments, Destination::Rows(&mut expected)).expect("numbers");
        let of = |name: &CStr, from: usize| {
            let (name, data) = (name.as_ptr(), single[from..].as_ptr());
            InputF32 { name, data, count: 7, state_stride: 0, element_stride: 1 }
        };
        let inputs = [of(c"q", 0), of(c"qd", 7), of(c"qdd", 14)];
        let mut found = vec![f32::NAN; 2 * outputs];
        let (room, count) = (found.as_mut_ptr(), found.len());
        // SAFETY: slices.
        let status = unsafe { rne_evaluate_batch_f32(arm.0, id, 2, inputs.as_ptr(), 3, room, count) };
        assert_eq!((status, &found), (Status::Ok, &expected));
        let mut found = vec![f32::NAN; outputs];
        // SAFETY: slices.
        let status = unsafe { rne_evaluate_f32(arm.0, id, inputs.as_ptr(), 3, found.as_mut_ptr(), outputs) };
        assert_eq!((status, &found[..]), (Status::Ok, &expected[..outputs]));
    }
}

#[test]
fn an_arm_tells_of_itself() {
    let arm = puma();
    // SAFETY: an arm that lives, and places.
    unsafe {
        assert_eq!(text(rne_version()), env!("CARGO_PKG_VERSION"));
        assert_eq!((text(rne_arm_name(arm.0)).as_str(), rne_arm_dof(arm.0)), ("puma560", 6));
        assert_eq!(text(rne_arm_joint_name(arm.0, 5)), "j6");
        assert!(rne_arm_joint_name(arm.0, 6).is_null());
        assert!(words().contains("there is no joint 6: this arm has 6"), "{}", words());
        let mut kind = JointKind::Prismatic;
        assert_eq!(rne_arm_joint_kind(arm.0, 5, &raw mut kind), Status::Ok);
        assert_eq!(kind, JointKind::Revolute);
        let stanford = made(|arm| rne_arm_builtin(c"stanford".as_ptr(), arm));
        assert_eq!(rne_arm_joint_kind(stanford.0, 2, &raw mut kind), Status::Ok);
        assert_eq!(kind, JointKind::Prismatic);
        assert_eq!(rne_arm_joint_kind(arm.0, 6, &raw mut kind), Status::OutOfRange);
        assert_eq!(rne_arm_joint_kind(arm.0, 0, null_mut()), Status::NullPointer);
        assert_eq!(rne_arm_joint_kind(null(), 0, &raw mut kind), Status::NullPointer);
        let mut limits = Limits { lower: 0.0, upper: 0.0, velocity: 0.0, effort: 0.0 };
        assert_eq!(rne_arm_joint_limits(arm.0, 0, &raw mut limits), Status::Ok);
        let end = 160_f64.to_radians();
        assert!((limits.lower + end).abs() < 1e-12 && (limits.upper - end).abs() < 1e-12, "{limits:?}");
        assert_eq!((limits.velocity, limits.effort), (f64::INFINITY, f64::INFINITY));
        assert_eq!(rne_arm_joint_limits(arm.0, 6, &raw mut limits), Status::OutOfRange);
        assert_eq!(rne_arm_joint_limits(arm.0, 0, null_mut()), Status::NullPointer);

        let id = id(c"inverse_dynamics_with_wrench");
        assert!(id < rne_function_count());
        assert_eq!(rne_function_prepare(arm.0, id), Status::Ok);
        let (mut count, mut outputs) = (0, 0);
        assert_eq!(rne_function_arguments(arm.0, id, &raw mut count), Status::Ok);
        assert_eq!(rne_function_outputs(arm.0, id, &raw mut outputs), Status::Ok);
        assert_eq!((count, outputs), (5, 6));
        let argument = |index| {
            let (mut name, mut elements) = (null(), 0);
            assert_eq!(rne_function_argument(arm.0, id, index, &raw mut name, &raw mut elements), Status::Ok);
            (text(name), elements)
        };
        let found: Vec<(String, usize)> = (0..count).map(argument).collect();
        let expected = [("q", 6), ("qd", 6), ("qdd", 6), ("force", 3), ("moment", 3)];
        assert_eq!(found, expected.map(|(name, elements)| (name.to_owned(), elements)));
        assert_eq!(rne_function_argument(arm.0, id, 5, null_mut(), null_mut()), Status::OutOfRange);
        assert_eq!(rne_function_argument(arm.0, id, 4, null_mut(), null_mut()), Status::Ok);
    }
}

#[test]
fn every_failure_of_reading_has_its_status() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| CString::new(folder.path().join(name).to_str().expect("UTF-8")).expect("no zero");
    let rod = "format: 1\nname: rod\nsource: own\nconvention: standard\ngravity: [0, -9.81, 0]\n\
               joints:\n  - {type: revolute, dh: {theta: 0, d: 0, a: 0.8, alpha: 0}, link: {mass: 2.5}}\n";
    std::fs::write(folder.path().join("rod.yaml"), rod).expect("a file");
    std::fs::write(folder.path().join("wrong.yaml"), rod.replace("mass", "mess")).expect("a file");
    std::fs::write(folder.path().join("latin.urdf"), b"<robot name=\"\xe9\"/>").expect("a file");
    let urdf = r#"<robot name="two"><link name="base"/><link name="a"><inertial><mass value="1"/>
<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
<link name="b"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
<joint name="one" type="continuous"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/></joint>
<joint name="two" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 1 0"/></joint></robot>"#;
    std::fs::write(folder.path().join("two.urdf"), urdf).expect("a file");
    let (lower, upper) = (c"base".as_ptr(), c"b".as_ptr());
    // SAFETY: texts, arrays and places.
    unsafe {
        let arm = made(|arm| rne_arm_load_file(path("rod.yaml").as_ptr(), arm));
        assert_eq!(rne_arm_dof(arm.0), 1);
        let arm = made(|arm| rne_arm_load_text(CString::new(rod).expect("no zero").as_ptr(), arm));
        assert_eq!(text(rne_arm_joint_name(arm.0, 0)), "joint1");
        refused(|arm| rne_arm_load_file(path("none.yaml").as_ptr(), arm), Status::UnreadableFile, "none.yaml");
        let wrong = path("wrong.yaml");
        refused(|arm| rne_arm_load_file(wrong.as_ptr(), arm), Status::InvalidFile, "wrong.yaml:7:");
        refused(|arm| rne_arm_load_text(c"name: [".as_ptr(), arm), Status::InvalidFile, "robot file:1:");
        refused(|arm| rne_arm_load_text(c"\xff".as_ptr(), arm), Status::NotUtf8, "`yaml` is not text");
        refused(|arm| rne_arm_load_text(null(), arm), Status::NullPointer, "`yaml` is NULL");
        refused(|arm| rne_arm_load_file(null(), arm), Status::NullPointer, "`path` is NULL");
        refused(|arm| rne_arm_builtin(null(), arm), Status::NullPointer, "`name` is NULL");
        refused(|arm| rne_arm_builtin(c"puma".as_ptr(), arm), Status::UnknownName, "puma560_mdh");
        assert_eq!(rne_arm_builtin(c"puma560".as_ptr(), null_mut()), Status::NullPointer);

        let urdf = path("two.urdf");
        let whole = |arm| rne_arm_load_urdf(urdf.as_ptr(), null(), null(), null(), null(), 0, false, arm);
        assert_eq!(rne_arm_dof(made(whole).0), 2);
        let (names, values) = ([c"one".as_ptr()], [0.5]);
        let locked =
            |arm| rne_arm_load_urdf(urdf.as_ptr(), lower, upper, names.as_ptr(), values.as_ptr(), 1, false, arm);
        let arm = made(locked);
        assert_eq!((rne_arm_dof(arm.0), text(rne_arm_joint_name(arm.0, 0)).as_str()), (1, "two"));
        let values_missing =
            |arm| rne_arm_load_urdf(urdf.as_ptr(), lower, upper, names.as_ptr(), null(), 1, false, arm);
        refused(values_missing, Status::NullPointer, "`lock_values` is NULL");
        let none = [null()];
        let name_missing =
            |arm| rne_arm_load_urdf(urdf.as_ptr(), lower, upper, none.as_ptr(), values.as_ptr(), 1, false, arm);
        refused(name_missing, Status::NullPointer, "lock_names");
        let tip = |arm| rne_arm_load_urdf(urdf.as_ptr(), null(), c"hand".as_ptr(), null(), null(), 0, true, arm);
        refused(tip, Status::InvalidFile, "hand");
        // a robot file, a shipped robot, and the function that reads a URDF
        refused(|arm| rne_arm_load_file(urdf.as_ptr(), arm), Status::InvalidFile, "rne_arm_load_urdf() reads a URDF");
        refused(|arm| rne_arm_load_file(c"puma".as_ptr(), arm), Status::UnreadableFile, "shipped robot puma560?");
        assert_eq!(rne_arm_dof(made(|arm| rne_arm_load_file(c"puma560".as_ptr(), arm)).0), 6);
        let latin = path("latin.urdf");
        let latin = |arm| rne_arm_load_urdf(latin.as_ptr(), null(), null(), null(), null(), 0, false, arm);
        refused(latin, Status::InvalidFile, "UTF-8");
        rne_arm_free(null_mut());
    }
}

#[test]
fn every_failure_of_a_call_has_its_status_and_writes_nothing() {
    let (arm, id) = (puma(), id(c"bias_torques"));
    let (q, qd) = ([0.1; 6], [0.2; 12]);
    let good = [input(c"q", &q, 0, 0), input(c"qd", &qd, 6, 1)];
    let mut tau = [7.0; 12];
    let mut check = |states, inputs: &[Input], room: usize, status, part: &str| {
        tau.fill(7.0);
        assert_eq!(many(&arm, id, states, inputs, &mut tau[..room]), status, "{}", words());
        assert!(words().contains(part), "{}", words());
        assert_eq!(tau, [7.0; 12]);
    };
    check(2, &good[..1], 12, Status::MissingArgument, "`bias_torques` needs the argument `qd`");
    check(3, &good, 12, Status::WrongSize, "that is 18 numbers; `count` says 12");
    check(2, &good, 11, Status::WrongSize, "must hold 6 numbers for each of 2 states");
    check(2, &[good[0], good[1], good[0]], 12, Status::WrongSize, "the argument `q` is given twice");
    check(2, &[input(c"q", &q[..5], 0, 1), good[1]], 12, Status::WrongSize, "`q` has 6 elements");
    check(2, &[input(c"q", &q, usize::MAX, 1), good[1]], 12, Status::WrongSize, "more than memory");
    check(usize::MAX, &[input(c"q", &q, 2, 1), good[1]], 12, Status::WrongSize, "more than memory");
    check(2, &[input(c"p", &q, 0, 1), good[1]], 12, Status::UnknownName, "no argument `p`; the arguments are q, qd");
    check(2, &[input(c"\xff", &q, 0, 1), good[1]], 12, Status::NotUtf8, "input 0");
    check(2, &[Input { data: null(), ..good[0] }, good[1]], 12, Status::NullPointer, "`q` is NULL");
    check(2, &[good[0], Input { name: null(), ..good[0] }], 12, Status::NullPointer, "input 1: `name");
    let odd = Input { data: good[1].data.wrapping_byte_add(1), count: 6, ..good[1] };
    check(1, &[good[0], odd], 6, Status::WrongMemory, "not a multiple of 8");
    let huge = Input { count: usize::MAX / 8, ..good[1] };
    check(1, &[good[0], huge], 6, Status::WrongMemory, "more than fit into memory");

    // of the rest of a call
    let (inputs, count) = (good.as_ptr(), good.len());
    let mut tau = [7.0; 6];
    let room = tau.as_mut_ptr();
    // SAFETY: slices, and pointers that are looked at before they are used.
    unsafe {
        assert_eq!(rne_evaluate(null(), id, inputs, count, room, 6), Status::NullPointer);
        assert_eq!(words(), "`arm` is NULL");
        assert_eq!(rne_evaluate(arm.0, id, null(), count, room, 6), Status::NullPointer);
        assert_eq!(rne_evaluate(arm.0, id, inputs, count, null_mut(), 6), Status::NullPointer);
        assert_eq!(rne_evaluate(arm.0, rne_function_count(), inputs, count, room, 6), Status::OutOfRange);
        assert_eq!(rne_evaluate(arm.0, u32::MAX, inputs, count, room, 6), Status::OutOfRange);
        let shared = [Input { data: room.cast_const(), ..good[0] }, good[1]];
        assert_eq!(rne_evaluate(arm.0, id, shared.as_ptr(), 2, room, 6), Status::WrongMemory);
        assert_eq!(words(), "`outputs` and `q` share memory");
        assert_eq!(tau, [7.0; 6]);
        // no states: nothing is read and nothing written
        assert_eq!(rne_evaluate_batch(arm.0, id, 0, inputs, count, null_mut(), 0), Status::Ok);

        let mut place = 0;
        assert_eq!(rne_function_find(c"inverse".as_ptr(), &raw mut place), Status::UnknownName);
        assert!(words().contains("inverse_dynamics"), "{}", words());
        assert_eq!(rne_function_find(c"jacobian".as_ptr(), null_mut()), Status::NullPointer);
        assert_eq!(rne_function_find(null(), &raw mut place), Status::NullPointer);
        assert_eq!(rne_function_outputs(arm.0, id, null_mut()), Status::NullPointer);
        assert_eq!(rne_function_arguments(null(), id, null_mut()), Status::NullPointer);
        assert_eq!(rne_function_prepare(null(), id), Status::NullPointer);
        assert!(rne_arm_name(null()).is_null() && rne_arm_joint_name(null(), 0).is_null());
        assert_eq!(rne_arm_dof(null()), 0);
    }
}

/// An address that is no multiple of what the type asks for is refused before anything is written there.
#[test]
fn places_are_aligned() {
    fn odd<T>(place: &mut [T; 2]) -> *mut T {
        place.as_mut_ptr().wrapping_byte_add(1)
    }
    let arm = puma();
    let id = id(c"bias_torques");
    let check = |status: Status, what: &str| {
        assert_eq!(status, Status::WrongMemory, "{}", words());
        assert!(words().starts_with(&format!("`{what}` is not aligned")), "{}", words());
    };
    let (mut arms, mut ids, mut sizes) = ([null_mut(); 2], [7; 2], [7; 2]);
    let (mut kinds, mut names) = ([JointKind::Prismatic; 2], [null(); 2]);
    let mut limits = [Limits { lower: 7.0, upper: 7.0, velocity: 7.0, effort: 7.0 }; 2];
    // SAFETY: pointers that are looked at before they are used.
    unsafe {
        check(rne_arm_builtin(c"puma560".as_ptr(), odd(&mut arms)), "arm");
        check(rne_arm_load_text(c"".as_ptr(), odd(&mut arms)), "arm");
        check(rne_arm_joint_kind(arm.0, 0, odd(&mut kinds)), "kind");
        check(rne_arm_joint_limits(arm.0, 0, odd(&mut limits)), "limits");
        check(rne_function_find(c"jacobian".as_ptr(), odd(&mut ids)), "id");
        check(rne_function_outputs(arm.0, id, odd(&mut sizes)), "outputs");
        check(rne_function_arguments(arm.0, id, odd(&mut sizes)), "arguments");
        check(rne_function_argument(arm.0, id, 0, odd(&mut names), null_mut()), "name");
        check(rne_function_argument(arm.0, id, 0, names.as_mut_ptr(), odd(&mut sizes)), "elements");
        check(rne_function_prepare(arm.0.wrapping_byte_add(1), id), "arm");
        assert_eq!(rne_arm_dof(arm.0.wrapping_byte_add(1)), 0);
    }
    assert!(arms.iter().all(|arm| arm.is_null()) && names.iter().all(|name| name.is_null()));
    assert_eq!((ids, sizes, kinds), ([7; 2], [7; 2], [JointKind::Prismatic; 2]));
    assert!(limits.iter().all(|limits| limits.lower == 7.0 && limits.effort == 7.0));
}

#[test]
fn a_payload_of_negative_mass_has_its_status_and_writes_nothing() {
    // the mass is in the last of three tasks
    const STATES: usize = 3 * 4096;
    let (arm, id) = (puma(), id(c"inverse_dynamics_with_payload"));
    let zeros = [0.0; 6];
    let mut payload = vec![1.0; 10 * STATES];
    payload[10 * (STATES - 1)] = -0.5;
    let names = [c"q", c"qd", c"qdd"];
    let mut inputs = names.map(|name| input(name, &zeros, 0, 0)).to_vec();
    inputs.push(input(c"payload", &payload, 10, 1));
    let mut tau = vec![7.0; 6 * STATES];
    assert_eq!(many(&arm, id, STATES, &inputs, &mut tau), Status::OutOfRange);
    assert_eq!(words(), "state 12288 of 12288: the payload's mass is -0.5 kg: no body has less than 0");
    let (room, count) = (tau.as_mut_ptr(), tau.len());
    // SAFETY: slices.
    let status = unsafe { rne_evaluate_batch_threads(arm.0, id, 2, STATES, inputs.as_ptr(), 4, room, count) };
    assert_eq!(status, Status::OutOfRange);
    assert_eq!(words(), "state 12288 of 12288: the payload's mass is -0.5 kg: no body has less than 0");
    assert!(tau.iter().all(|torque| *torque == 7.0));
    inputs[3] = input(c"payload", &payload[10 * (STATES - 1)..], 0, 0);
    assert_eq!(one(&arm, id, &inputs, &mut tau[..6]), Status::OutOfRange);
    assert_eq!(words(), "the payload's mass is -0.5 kg: no body has less than 0");
}

/// What a function does not take is not looked at, whatever it says of itself.
#[test]
fn an_input_that_is_not_taken_may_have_any_stride() {
    const STATES: usize = 3 * 4096;
    let (arm, id) = (puma(), id(c"gravity_torques"));
    let q: Vec<f64> = (0_u32..).map(|index| f64::from(index % 1009) * 0.003).take(6 * STATES).collect();
    let [mut expected, mut found] = [(); 2].map(|()| vec![f64::NAN; 6 * STATES]);
    assert_eq!(many(&arm, id, STATES, &[input(c"q", &q, 6, 1)], &mut expected), Status::Ok, "{}", words());
    for stride in [usize::MAX, usize::MAX / 2 + 3, usize::MAX / 4096] {
        let inputs = [input(c"q", &q, 6, 1), input(c"tau", &q[..6], stride, stride)];
        let (room, count) = (found.as_mut_ptr(), found.len());
        // SAFETY: slices.
        let status = unsafe { rne_evaluate_batch_threads(arm.0, id, 2, STATES, inputs.as_ptr(), 2, room, count) };
        assert_eq!(status, Status::Ok, "{}", words());
        assert!(found == expected, "another number with a stride of {stride}");
        found.fill(f64::NAN);
    }
}

/// However many threads, and however arrays lie: the bits of one thread. Mistakes are told, and nothing is written
/// then.
#[test]
fn threads_change_no_number() {
    // three tasks, and some states that fill none
    const STATES: usize = 3 * 4096 + 17;
    let (arm, id) = (puma(), id(c"bias_torques"));
    let q: Vec<f64> = (0_u32..).map(|index| f64::from(index % 1009) * 0.003).take(6 * STATES).collect();
    let same = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6];
    for inputs in
        [[input(c"q", &q, 6, 1), input(c"qd", &same, 0, 0)], [input(c"q", &q, 1, STATES), input(c"qd", &q, 6, 1)]]
    {
        let mut expected = vec![f64::NAN; 6 * STATES];
        assert_eq!(many(&arm, id, STATES, &inputs, &mut expected), Status::Ok, "{}", words());
        for threads in [0, 1, 2, 5, 1000] {
            let mut found = vec![f64::NAN; 6 * STATES];
            let call = |states: usize, inputs: &[Input], room: &mut [f64]| {
                let (to, count) = (room.as_mut_ptr(), room.len());
                // SAFETY: slices.
                unsafe {
                    rne_evaluate_batch_threads(arm.0, id, threads, states, inputs.as_ptr(), inputs.len(), to, count)
                }
            };
            let room = found.len();
            assert_eq!(call(STATES, &inputs, &mut found[..room - 1]), Status::WrongSize);
            assert_eq!(call(STATES, &inputs[..1], &mut found), Status::MissingArgument, "{}", words());
            assert_eq!(call(STATES + 1, &inputs, &mut found), Status::WrongSize, "{}", words());
            assert_eq!(call(usize::MAX, &inputs, &mut found), Status::WrongSize, "{}", words());
            assert!(found.iter().all(|number| number.is_nan()));
            assert_eq!(call(STATES, &inputs, &mut found), Status::Ok, "{}", words());
            assert_eq!(found, expected, "{threads} threads");
            assert_eq!(call(0, &inputs, &mut []), Status::Ok);
        }
    }
    // in single precision
    #[allow(clippy::cast_possible_truncation)] // rounding is the purpose
    let q: Vec<f32> = q.iter().map(|x| *x as f32).collect();
    let of = |name: &CStr| InputF32 {
        name: name.as_ptr(),
        data: q.as_ptr(),
        count: q.len(),
        state_stride: 6,
        element_stride: 1,
    };
    let inputs = [of(c"q"), of(c"qd")];
    let [mut expected, mut found] = [(); 2].map(|()| vec![f32::NAN; 6 * STATES]);
    let (one, many, count) = (expected.as_mut_ptr(), found.as_mut_ptr(), found.len());
    // SAFETY: slices.
    let statuses = unsafe {
        [
            rne_evaluate_batch_f32(arm.0, id, STATES, inputs.as_ptr(), 2, one, count),
            rne_evaluate_batch_threads_f32(arm.0, id, 3, STATES, inputs.as_ptr(), 2, many, count),
        ]
    };
    assert_eq!((statuses, &found), ([Status::Ok; 2], &expected));
}

#[test]
fn what_cannot_be_compiled_is_told() {
    // the way from the joint to the centre of mass is no number of double precision
    let text = "{format: 1, name: rod, source: own, convention: standard, gravity: [9.81, 0, 0], joints: [\
                {type: revolute, dh: {theta: 0, d: 0, a: 1e308, alpha: 0}, link: {mass: 2.5, com: [1e308, 0, 0]}}]}";
    let text = CString::new(text).expect("no zero");
    // SAFETY: a text and a place.
    let arm = made(|arm| unsafe { rne_arm_load_text(text.as_ptr(), arm) });
    let q = [0.1];
    let mut tau = [7.0];
    let status = one(&arm, id(c"gravity_torques"), &[input(c"q", &q, 0, 0)], &mut tau);
    assert_eq!((status, tau), (Status::CannotCompile, [7.0]), "{}", words());
    assert!(words().contains("is too large for a number of double precision"), "{}", words());
}

#[test]
fn words_are_those_of_a_thread() {
    // SAFETY: an empty place is looked at before it is used.
    let status = unsafe { rne_arm_builtin(c"none".as_ptr(), null_mut()) };
    assert_eq!((status, words().as_str()), (Status::NullPointer, "`arm` is NULL"));
    std::thread::spawn(|| assert_eq!(words(), "")).join().expect("no panic");
    assert_eq!(words(), "`arm` is NULL");
}

#[test]
fn an_arm_at_a_frame_computes_at_the_frame() {
    let yaml = include_str!("../../../docs/desk_arm_frames.yaml");
    let text = CString::new(yaml).expect("no zero byte");
    // SAFETY: a text and a place.
    let arm = made(|arm| unsafe { rne_arm_load_text(text.as_ptr(), arm) });
    let ours = CompiledArm::from_yaml(yaml).expect("an arm");
    let (q, jacobian) = ([0.4, 0.7, -1.1], id(c"jacobian"));
    for name in [c"camera", c"table", c"shoulder"] {
        // SAFETY: an arm, a text and a place.
        let at = made(|at| unsafe { rne_arm_at_frame(arm.0, name.as_ptr(), at) });
        let mut found = [0.0; 18];
        assert_eq!(one(&at, jacobian, &[input(c"q", &q, 0, 0)], &mut found), Status::Ok, "{}", words());
        let expected = ours.at_frame(name.to_str().expect("UTF-8")).expect("a frame").jacobian(&q).expect("numbers");
        assert_eq!(found.to_vec(), expected.concat());
    }
    // SAFETY: an arm, a text and a place.
    refused(
        |at| unsafe { rne_arm_at_frame(arm.0, c"camra".as_ptr(), at) },
        Status::UnknownName,
        "did you mean `camera`?",
    );
    // SAFETY: NULL is looked for.
    refused(|at| unsafe { rne_arm_at_frame(null(), c"camera".as_ptr(), at) }, Status::NullPointer, "arm");
    // SAFETY: the same.
    refused(|at| unsafe { rne_arm_at_frame(arm.0, null(), at) }, Status::NullPointer, "frame");
}
