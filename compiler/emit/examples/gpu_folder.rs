//! Writes a folder with kernels of PTX, states, and what the processor computes of them, for benches/gpu/run.py on a
//! machine with a graphics card: `cargo run -p rne-emit --example gpu_folder -- FOLDER`.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use rne_emit::{Additions, Precision, Prefix, ptx};
use rne_machine::{Arguments, Array, CompiledArm, Destination, Form, Function, Number, Rollout};
use serde_json::{Value, json};

/// Functions of the arm that is looked at closely.
const OF_PANDA: [Function; 5] = [
    Function::InverseDynamics,
    Function::MassMatrix,
    Function::ForwardDynamics,
    Function::InverseDynamicsDerivatives,
    Function::InverseDynamicsWithPayload,
];

/// The rollouts of the arm: their steps, and after how many steps states are written.
const STEPS: u32 = 50;
const EVERY: [u32; 2] = [1, STEPS];
/// The duration of a step, s. With 20 ms the light wrist diverges under random torques.
const STEP: f64 = 0.002;

/// Robot files that are not shipped, and the functions that are taken of them.
const OTHERS: [(&str, &[Function]); 4] = [
    ("benches/trees/g1.yaml", &[Function::InverseDynamics]),
    (
        "benches/trees/g1_floating.yaml",
        &[Function::InverseDynamicsOfFloatingBase, Function::FloatingMassMatrix, Function::FloatingForwardDynamics],
    ),
    ("benches/trees/go2_floating.yaml", &[Function::InverseDynamicsOfFloatingBase]),
    ("benches/trees/loops/digit_like.yaml", &[Function::InverseDynamicsOfLoops]),
];

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("name the folder that is written")?);
    fs::create_dir_all(&folder)?;
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut arms = Vec::new();
    for file in rne_robots::ROBOTS {
        let arm = match file.plan {
            Some(plan) => CompiledArm::with_plan(file.yaml, plan)?,
            None => CompiledArm::from_yaml(file.yaml)?,
        };
        let functions = if file.name == "panda" { &OF_PANDA[..] } else { &OF_PANDA[..1] };
        arms.push((file.name.to_owned(), arm, functions));
    }
    for (path, functions) in OTHERS {
        let name = Path::new(path).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        arms.push((name, CompiledArm::from_file(root.join(path))?, functions));
    }
    let mut cases = Vec::new();
    for (name, arm, functions) in &arms {
        for &function in *functions {
            cases.extend(case(&folder, name, arm, function)?);
            println!("{name} {function}");
        }
        if name == "panda" {
            for every in EVERY {
                cases.extend(rollout(&folder, name, arm, every)?);
            }
        }
    }
    let manifest = json!({ "unit": rne_runtime::VectorUnit::widest().name(), "cases": cases });
    fs::write(folder.join("manifest.json"), serde_json::to_string_pretty(&manifest)?)?;
    fs::copy(root.join("benches/gpu/run.py"), folder.join("run.py"))?;
    Ok(())
}

/// One function of one robot: its kernels in both precisions, states, and results.
fn case(folder: &Path, name: &str, arm: &CompiledArm, function: Function) -> Result<Vec<Value>, Box<dyn Error>> {
    let compiled = arm.function(function)?;
    let program = compiled.program();
    let outputs = compiled.outputs();
    let states = match outputs {
        _ if name == "panda" && function == Function::InverseDynamics => 4099,
        0..8 => 515,
        8..50 => 131,
        _ => 67,
    };
    let label = format!("{name}_{}", program.name);
    let mut random = fastrand::Rng::with_seed(7);
    // numbers that are the same in both precisions
    let mut draw = |array: &str, element: usize| -> f32 {
        let range = match (array, element) {
            ("payload", 0) => 1.0..3.0,
            ("payload", 4..7) => 0.3..0.4,
            ("payload", _) => -0.05..0.05,
            ("q", _) => -3.0..3.0,
            ("base_rotation" | "passive", _) => -1.0..1.0,
            _ => -2.0..2.0,
        };
        range.start + (range.end - range.start) * random.f32()
    };
    let inputs: Vec<(&str, Vec<Vec<f32>>)> = compiled
        .arguments()
        .iter()
        .map(|&(array, elements)| {
            let column = |element| (0..states).map(|_| draw(array, element)).collect();
            (array, (0..elements).map(column).collect())
        })
        .collect();
    let numbers: Vec<u8> =
        inputs.iter().flat_map(|(_, columns)| columns.iter().flatten()).flat_map(|x| x.to_le_bytes()).collect();
    fs::write(folder.join(format!("{label}.in")), numbers)?;
    let double = results(arm, function, states, outputs, &inputs, f64::from)?;
    let single = results(arm, function, states, outputs, &inputs, |x| x)?;
    fs::write(folder.join(format!("{label}.f64")), double.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>())?;
    fs::write(folder.join(format!("{label}.f32")), single.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>())?;
    let prefix = Prefix::of(arm.robot());
    let mut cases = Vec::new();
    for (precision, type_name) in [(Precision::Double, "f64"), (Precision::Single, "f32")] {
        let text = ptx(arm.robot(), std::slice::from_ref(program), precision, &prefix, &Additions::default())?;
        let file = format!("{label}_{type_name}.ptx");
        fs::write(folder.join(&file), text)?;
        cases.push(json!({
            "label": label,
            "robot": name,
            "function": program.name,
            "type": type_name,
            "ptx": file,
            "kernel": format!("{}_{}", prefix.as_str(), program.name),
            "arrays": inputs.iter().map(|(array, columns)| json!([array, columns.len()])).collect::<Vec<_>>(),
            "outputs": outputs,
            "used": program.arguments().count(),
            "states": states,
            "operations": program.operations().total(),
            "instructions": rne_codegen::fma::instructions(program),
            "angles": program.operations().sincos,
            "form": if program.form == Form::Reduced { "reduced" } else { "seven_steps" },
        }));
    }
    Ok(cases)
}

/// Rollouts of an arm: their kernels in both precisions, the first states and torques, and the states after steps.
fn rollout(folder: &Path, name: &str, arm: &CompiledArm, every: u32) -> Result<Vec<Value>, Box<dyn Error>> {
    let program = arm.function(Function::ForwardDynamics)?.program();
    let (dof, samples, steps) = (arm.dof(), 131, STEPS as usize);
    let label = format!("{name}_rollout_every_{every}");
    let mut random = fastrand::Rng::with_seed(7);
    let mut columns = |elements: usize, scale: f32| -> Vec<Vec<f32>> {
        (0..elements).map(|_| (0..samples).map(|_| scale * (2.0 * random.f32() - 1.0)).collect()).collect()
    };
    let inputs = [("q", columns(dof, 1.0)), ("qd", columns(dof, 0.5)), ("tau", columns(dof * steps, 1.0))];
    let numbers = inputs.iter().flat_map(|(_, columns)| columns.iter().flatten()).flat_map(|x| x.to_le_bytes());
    fs::write(folder.join(format!("{label}.in")), numbers.collect::<Vec<u8>>())?;
    let double = states(arm, samples, every as usize, &inputs, f64::from)?;
    let single = states(arm, samples, every as usize, &inputs, |x| x)?;
    fs::write(folder.join(format!("{label}.f64")), double.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>())?;
    fs::write(folder.join(format!("{label}.f32")), single.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>())?;
    let (prefix, additions) = (Prefix::of(arm.robot()), Additions { rollout: true, ..Additions::default() });
    let mut cases = Vec::new();
    for (precision, type_name) in [(Precision::Double, "f64"), (Precision::Single, "f32")] {
        let file = format!("{label}_{type_name}.ptx");
        let text = ptx(arm.robot(), std::slice::from_ref(program), precision, &prefix, &additions)?;
        fs::write(folder.join(&file), text)?;
        cases.push(json!({
            "label": label,
            "robot": name,
            "function": "rollout",
            "type": type_name,
            "ptx": file,
            "kernel": format!("{}_rollout", prefix.as_str()),
            "arrays": inputs.iter().map(|(array, columns)| json!([array, columns.len()])).collect::<Vec<_>>(),
            "rollout": { "steps": STEPS, "step": STEP, "every": every },
            "outputs": 2 * dof * steps / every as usize,
            "used": dof * (2 + steps),
            "states": samples,
            "operations": (program.operations().total() + 4 * dof) * steps,
            "instructions": (rne_codegen::fma::instructions(program) + 4 * dof) * steps,
            "angles": program.operations().sincos * steps,
            "form": "reduced",
        }));
    }
    Ok(cases)
}

/// The states of a rollout on the processor, by columns: positions, then velocities.
fn states<T: Number>(
    arm: &CompiledArm,
    samples: usize,
    every: usize,
    inputs: &[(&str, Vec<Vec<f32>>)],
    number: impl Fn(f32) -> T,
) -> Result<Vec<T>, Box<dyn Error>> {
    let (dof, steps) = (arm.dof(), STEPS as usize);
    let rows = |columns: &Vec<Vec<f32>>| -> Vec<T> {
        (0..samples)
            .flat_map(|sample| columns.iter().map(|column| number(column[sample])).collect::<Vec<_>>())
            .collect()
    };
    let rows: Vec<Vec<T>> = inputs.iter().map(|(_, columns)| rows(columns)).collect();
    let arguments = Arguments::new().q(Array::Rows(&rows[0])).qd(Array::Rows(&rows[1])).tau(Array::Rows(&rows[2]));
    let [mut q, mut qd] = [(); 2].map(|()| vec![number(0.0); samples * steps * dof]);
    arm.rollout(&Rollout::new(steps, STEP), samples, &arguments, &mut q, &mut qd)?;
    let of_sample = steps * dof;
    let written = (0..of_sample).filter(|element| (element / dof + 1).is_multiple_of(every));
    let column =
        |numbers: &[T], element: usize| (0..samples).map(|sample| numbers[sample * of_sample + element]).collect();
    let columns: Vec<Vec<T>> = [&q, &qd]
        .into_iter()
        .flat_map(|numbers| written.clone().map(|element| column(numbers, element)).collect::<Vec<Vec<T>>>())
        .collect();
    Ok(columns.concat())
}

/// What the processor computes, by columns.
fn results<T: Number>(
    arm: &CompiledArm,
    function: Function,
    states: usize,
    outputs: usize,
    inputs: &[(&str, Vec<Vec<f32>>)],
    number: impl Fn(f32) -> T,
) -> Result<Vec<T>, Box<dyn Error>> {
    let numbers: Vec<Vec<Vec<T>>> = inputs
        .iter()
        .map(|(_, columns)| columns.iter().map(|column| column.iter().map(|x| number(*x)).collect()).collect())
        .collect();
    let slices: Vec<Vec<&[T]>> = numbers.iter().map(|columns| columns.iter().map(Vec::as_slice).collect()).collect();
    let mut arguments = Arguments::new();
    for ((array, _), columns) in inputs.iter().zip(&slices) {
        arguments = arguments.with(array, Array::Columns(columns)).ok_or("an argument of this name")?;
    }
    let mut results = vec![number(0.0); outputs * states];
    arm.run(function, states, &arguments, Destination::Columns(results.chunks_mut(states).collect()))?;
    Ok(results)
}
