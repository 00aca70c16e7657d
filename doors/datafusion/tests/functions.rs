//! Dynamics in SQL: the numbers of the arm itself, over columns, lists, slices and nulls; and what is refused.

use std::sync::Arc;

use datafusion::arrow::array::{
    Array, ArrayRef, AsArray, FixedSizeListArray, Float32Array, Float64Array, Int64Array, LargeListArray, ListArray,
    RecordBatch, StringArray,
};
use datafusion::arrow::buffer::OffsetBuffer;
use datafusion::arrow::datatypes::{DataType, Field, Float64Type, Int64Type};
use datafusion::common::Result;
use datafusion::datasource::MemTable;
use datafusion::prelude::SessionContext;
use rne::compiled::{Arguments, CompiledArm, Destination, Function, Sizes};
use rne_datafusion::{Robots, register};
use sha2::{Digest, Sha256};

/// A rod on one hinge: its torque at rest is known in closed form.
const ROD: &str = "
format: 1
name: rod
source: own
convention: standard
gravity: [0, -9.81, 0]
joints:
  - type: revolute
    dh: {theta: 0, d: 0, a: 0.8, alpha: 0}
    link: {mass: 2.5, com: [-0.4, 0, 0]}
    motor: {inertia: 0.001, gear_ratio: 10, viscous: 0.02, coulomb: [0.0, 0.0]}
";

/// A wheel whose hinge has Coulomb friction that changes its sign about a speed.
const WHEEL: &str = "
format: 1
name: wheel
source: own
convention: standard
gravity: [0, 0, -9.81]
joints:
  - type: revolute
    dh: {theta: 0, d: 0, a: 0, alpha: 0}
    link: {mass: 1.0}
    motor: {inertia: 0, gear_ratio: 1, viscous: 0, coulomb: [2.0, -1.0], coulomb_width: 0.05}
";

/// Two level jaws, of which one moves twice as far as the other.
const JAWS: &str = "
format: 2
name: jaws
source: own
convention: modified
gravity: [0, -9.81, 0]
tool: {on: left}
joints:
  - name: left
    type: prismatic
    dh: {theta: 0, d: 0, a: 0, alpha: 0}
    link: {mass: 0.3}
    motor: {inertia: 0.001, gear_ratio: 10, viscous: 0.02, coulomb: [0.0, 0.0]}
  - name: right
    parent: base
    type: prismatic
    dh: {theta: 0, d: 0, a: 0.1, alpha: 0}
    link: {mass: 0.2}
couplings:
  - {joint: right, follows: {left: 2}}
";

fn robots() -> Robots {
    let robots = Robots::shipped().and_then(|robots| robots.with_yaml(ROD));
    let robots = robots.and_then(|robots| robots.with_yaml(WHEEL));
    robots.and_then(|robots| robots.with_yaml(JAWS)).expect("they are shipped")
}

fn context() -> SessionContext {
    let context = SessionContext::new();
    register(&context, &robots());
    context
}

fn key(name: &str) -> String {
    robots().key(name).expect("it is held")
}

async fn one(context: &SessionContext, sql: &str) -> Result<RecordBatch> {
    let batches = context.sql(sql).await?.collect().await?;
    let schema = batches.first().map(RecordBatch::schema).expect("a batch");
    Ok(datafusion::arrow::compute::concat_batches(&schema, &batches)?)
}

/// What a query is refused with.
async fn refused(context: &SessionContext, sql: &str) -> String {
    one(context, sql).await.expect_err("it is refused").to_string()
}

fn random(count: usize) -> Vec<f64> {
    let mut random = fastrand::Rng::with_seed(7);
    (0..count).map(|_| 4.0 * random.f64() - 2.0).collect()
}

/// States of an arm as a table of columns `q1`, …, `qdd6` and of lists `q`, `qd`, `qdd`, in batches of some rows.
fn table(joints: usize, states: usize, batch: usize) -> (MemTable, [Vec<f64>; 3]) {
    let names = ["q", "qd", "qdd"];
    let numbers = random(3 * states * joints);
    let rows: Vec<Vec<f64>> = numbers.chunks(states * joints).map(<[f64]>::to_vec).collect();
    let mut columns: Vec<(String, ArrayRef)> = Vec::new();
    for (name, rows) in names.iter().zip(&rows) {
        for joint in 0..joints {
            let column: Vec<f64> = rows.iter().copied().skip(joint).step_by(joints).collect();
            columns.push((format!("{name}{}", joint + 1), Arc::new(Float64Array::from(column))));
        }
        let lists = rows.chunks(joints).map(|row| Some(row.iter().copied().map(Some)));
        columns.push(((*name).to_owned(), Arc::new(ListArray::from_iter_primitive::<Float64Type, _, _>(lists))));
    }
    let number: Vec<i64> = (0..).take(states).collect();
    columns.push(("number".to_owned(), Arc::new(Int64Array::from(number))));
    let all = RecordBatch::try_from_iter(columns).expect("columns of one length");
    // slices of one batch, not copies: their offsets are not zero
    let slices = (0..states).step_by(batch).map(|start| all.slice(start, batch.min(states - start))).collect();
    let table = MemTable::try_new(all.schema(), vec![slices]).expect("batches of one schema");
    (table, rows.try_into().expect("three arguments"))
}

/// The innermost numbers of a column.
fn numbers(column: &ArrayRef) -> Vec<f64> {
    match column.data_type() {
        DataType::FixedSizeList(..) => numbers(column.as_fixed_size_list().values()),
        _ => column.as_primitive::<Float64Type>().values().to_vec(),
    }
}

/// The sizes of an arm with these joints and one tip.
const fn sizes(dof: usize) -> Sizes {
    Sizes { dof, tips: 1, passive: 0, equations: 0 }
}

/// The numbers of a part of a record, which may be a record itself.
fn of_record(column: &ArrayRef) -> Vec<f64> {
    match column.data_type() {
        DataType::Struct(_) => column.as_struct().columns().iter().flat_map(of_record).collect(),
        _ => numbers(column),
    }
}

#[tokio::test]
async fn columns_lists_and_slices_give_the_numbers_of_the_arm() -> Result<()> {
    let (context, joints, states) = (context(), 6, 1000);
    let (table, [q, qd, qdd]) = table(joints, states, 37);
    context.register_table("log", Arc::new(table))?;
    let file = rne_robots::find("puma560").expect("it is shipped");
    let arm = CompiledArm::with_plan(file.yaml, file.plan.expect("it has one")).expect("it is right");
    let of = |name: &str| (1..=joints).map(|joint| format!("{name}{joint}")).collect::<Vec<_>>().join(", ");
    for (function, arguments) in [
        (Function::InverseDynamics, vec!["q", "qd", "qdd"]),
        (Function::GravityTorques, vec!["q"]),
        (Function::BiasTorques, vec!["q", "qd"]),
        (Function::MassMatrix, vec!["q"]),
        (Function::Jacobian, vec!["q"]),
        (Function::KineticEnergy, vec!["q", "qd"]),
    ] {
        let array = rne::compiled::Array::Rows;
        let given = Arguments::new().q(array(&q)).qd(array(&qd)).qdd(array(&qdd));
        let mut expected = vec![0.0; states * function.layout(sizes(joints)).len()];
        arm.run(function, states, &given, Destination::Rows(&mut expected)).expect("it computes");
        let columns: Vec<String> = arguments.iter().map(|name| of(name)).collect();
        for arguments in [arguments.join(", "), columns.join(", ")] {
            let call = format!("{function}('{}', {arguments})", key("puma560"));
            let found = one(&context, &format!("SELECT {call} AS it FROM log ORDER BY number")).await?;
            assert_eq!(numbers(found.column(0)), expected, "{call}");
        }
    }
    // one argument as a list, others as columns
    let call = format!("inverse_dynamics('{}', q, {}, qdd)", key("puma560"), of("qd"));
    let mixed = one(&context, &format!("SELECT {call} FROM log ORDER BY number")).await?;
    let lists = format!("inverse_dynamics('{}', q, qd, qdd)", key("puma560"));
    let lists = one(&context, &format!("SELECT {lists} FROM log ORDER BY number")).await?;
    assert_eq!(numbers(mixed.column(0)), numbers(lists.column(0)));
    Ok(())
}

#[tokio::test]
async fn a_rod_weighs_what_it_weighs() -> Result<()> {
    let (context, rod) = (context(), key("rod"));
    for angle in [0.0, 0.5, -2.0] {
        let found = one(&context, &format!("SELECT gravity_torques('{rod}', [{angle}]) AS tau")).await?;
        let expected = 2.5 * 9.81 * 0.4 * f64::cos(angle);
        assert!((numbers(found.column(0))[0] - expected).abs() < 1e-14, "{angle}");
    }
    // integers are numbers; a constant call is a literal
    let found =
        one(&context, &format!("SELECT gravity_torques('{rod}', [0])[1] AS tau FROM (VALUES (1), (2))")).await?;
    assert_eq!(found.num_rows(), 2);
    assert!((numbers(found.column(0))[1] - 9.81).abs() < 1e-14);
    Ok(())
}

/// The numbers of some rows of a column, row by row.
fn of_rows(column: &ArrayRef, rows: std::ops::Range<usize>) -> Vec<f64> {
    match column.data_type() {
        DataType::Struct(_) => {
            let columns = column.as_struct().columns();
            rows.flat_map(|row| columns.iter().flat_map(move |part| of_rows(part, row..row + 1))).collect()
        }
        DataType::FixedSizeList(_, length) => {
            let length = usize::try_from(*length).expect("a length");
            of_rows(column.as_fixed_size_list().values(), rows.start * length..rows.end * length)
        }
        _ => column.as_primitive::<Float64Type>().values()[rows].to_vec(),
    }
}

/// Every function with all of its arguments, on robots with a floating base and with several tips.
#[tokio::test]
async fn every_function_takes_its_own_arguments() -> Result<()> {
    let mut tested = 0;
    for yaml in [include_str!("../../../docs/satellite.yaml"), include_str!("../../../robots/trees/dex3_left.yaml")] {
        let arm = CompiledArm::from_yaml(yaml).expect("it is right");
        let robots = Robots::none().with_yaml(yaml)?;
        let (context, key) = (SessionContext::new(), robots.key(&arm.robot().name).expect("it is held"));
        register(&context, &robots);
        let sizes = rne::compiled::sizes_of(arm.robot());
        for function in Function::OF_TREES {
            let parts: Vec<_> = function.arguments().iter().flat_map(|argument| argument.parts()).collect();
            let lists: Vec<Vec<f64>> = parts.iter().map(|part| random(part.elements(sizes))).collect();
            let mut given = Arguments::new();
            for (part, list) in parts.iter().zip(&lists) {
                given = given.with(part.name, rne::compiled::Array::Rows(list)).expect("it is an argument");
            }
            let mut expected = vec![0.0; function.layout(sizes).len()];
            let has_it = arm.run(function, 1, &given, Destination::Rows(&mut expected)).is_ok();
            let written: Vec<String> = lists.iter().map(|list| format!("{list:?}")).collect();
            let call = format!("SELECT {function}('{key}', {}) AS it", written.join(", "));
            let found = one(&context, &call).await;
            // functions with sines, cosines or a payload are no functions of SQL
            let is_left_out = parts.iter().any(|part| ["sin", "cos", "payload"].contains(&part.name));
            assert_eq!(found.is_ok(), has_it && !is_left_out, "{call}: {:?}", found.err());
            if let Ok(found) = found {
                assert_eq!(of_rows(found.column(0), 0..1), expected, "{call}");
                tested += 1;
            }
        }
    }
    assert!(tested > 60, "{tested}");
    Ok(())
}

/// A satellite with an arm. Its base takes ω, ω̇ and a - g as lists or as a column per number.
#[tokio::test]
async fn a_base_that_floats_has_its_functions() -> Result<()> {
    let yaml = include_str!("../../../docs/satellite.yaml");
    let robots = Robots::none().with_yaml(yaml)?;
    let (context, key) = (SessionContext::new(), robots.key("satellite").expect("it is held"));
    register(&context, &robots);
    let states = 5;
    let lists = [("q", 2), ("qd", 2), ("qdd", 2), ("tau", 2), ("omega", 3), ("omega_dot", 3), ("felt", 3)];
    let mut columns: Vec<(String, ArrayRef)> = Vec::new();
    let mut given: Vec<Vec<f64>> = Vec::new();
    for (at, (name, length)) in lists.into_iter().enumerate() {
        let rows = random(states * 3 * lists.len())[at * states * 3..][..states * length].to_vec();
        let list = rows.chunks(length).map(|row| Some(row.iter().copied().map(Some)));
        columns.push((name.to_owned(), Arc::new(ListArray::from_iter_primitive::<Float64Type, _, _>(list))));
        for part in 0..length {
            let column: Vec<f64> = rows.iter().copied().skip(part).step_by(length).collect();
            columns.push((format!("{name}_{part}"), Arc::new(Float64Array::from(column))));
        }
        given.push(rows);
    }
    context.register_batch("log", RecordBatch::try_from_iter(columns)?)?;
    let arm = CompiledArm::from_yaml(yaml).expect("it is right");
    let zeros = vec![0.0; 6 * states];
    let array = rne::compiled::Array::Rows;
    let [q, qd, qdd, tau, omega, omega_dot, felt] = [0, 1, 2, 3, 4, 5, 6].map(|at| array(&given[at]));
    let all = Arguments::new().q(q).qd(qd).qdd(qdd).tau(tau).omega(omega).wrenches(array(&zeros));
    let all = all.base_omega(omega).base_omega_dot(omega_dot).base_acceleration(felt);
    let all = all.base_gravity(array(&zeros[..3 * states]));
    let mut results = Vec::new();
    for (function, arguments, parts) in [
        (Function::InverseDynamicsOfFloatingBase, "q, qd, qdd, omega, omega_dot, felt, [0, 0, 0]", "wrench tau"),
        (Function::FloatingMassMatrix, "q", ""),
        (Function::FloatingBias, "q, qd, omega", ""),
        (Function::FloatingForwardDynamics, "q, qd, tau, omega_0, omega_1, omega_2", "base qdd"),
        (Function::CentroidalMomentumMatrix, "q", ""),
        (Function::CentroidalBias, "q, qd_0, qd_1, omega", ""),
        (
            Function::FloatingInverseDynamicsDerivatives,
            "q, qd, qdd, omega, omega_dot, felt, [0, 0, 0]",
            "dq dqd domega",
        ),
    ] {
        let mut expected = vec![0.0; states * function.layout(sizes(2)).len()];
        arm.run(function, states, &all, Destination::Rows(&mut expected)).expect("it computes");
        let call = format!("{function}('{key}', {arguments})");
        let found = one(&context, &format!("SELECT {call} AS it FROM log")).await?;
        let of_state = |state: usize| -> Vec<f64> {
            if parts.is_empty() {
                return numbers(&found.column(0).slice(state, 1));
            }
            let record = found.column(0).as_struct();
            let part = |name: &str| record.column_by_name(name).expect("a part").slice(state, 1);
            parts.split(' ').flat_map(|name| of_record(&part(name))).collect()
        };
        let found: Vec<f64> = (0..states).flat_map(of_state).collect();
        assert_eq!(found, expected, "{call}");
        results.push(expected);
    }
    // M a + bias = (0, τ)
    let [_, mass, bias, accelerations, ..] = &results[..] else { panic!("six functions") };
    for state in 0..states {
        for row in 0..8 {
            let products = (0..8).map(|column| mass[64 * state + 8 * row + column] * accelerations[8 * state + column]);
            let force = products.sum::<f64>() + bias[8 * state + row];
            let expected = if row < 6 { 0.0 } else { given[3][2 * state + row - 6] };
            assert!((force - expected).abs() < 1e-11, "row {row}: {force} {expected}");
        }
    }
    for (call, words) in [
        ("floating_bias('K', q, qd)", vec!["`omega` is missing", "3 numbers"]),
        ("floating_bias('K', q, qd, q)", vec!["row 1", "2 numbers", "`omega` is x, y and z"]),
        ("floating_bias('K', q, qd, omega_0, omega_1)", vec!["`omega` has 2 columns"]),
        ("floating_bias('K', q, qd, omega, omega)", vec!["3 numbers", "satellite has 1 tips"]),
        ("floating_mass_matrix('K', omega)", vec!["satellite has 2 joints"]),
    ] {
        let said = refused(&context, &format!("SELECT {} FROM log", call.replace('K', &key))).await;
        for word in words {
            assert!(said.contains(word), "{call}: {said}");
        }
    }
    Ok(())
}

#[tokio::test]
async fn a_residual_is_what_the_model_and_its_motors_do_not_explain() -> Result<()> {
    let (context, rod) = (context(), key("rod"));
    // gravity, inertia of link and rotor, viscous friction: each by hand
    let (angle, speed, acceleration, measured) = (0.4_f64, 1.5, -2.0, 20.0);
    let model =
        2.5 * 9.81 * 0.4 * angle.cos() + (2.5 * 0.4 * 0.4 + 100.0 * 0.001) * acceleration + 100.0 * 0.02 * speed;
    let call = format!("residual('{rod}', [{angle}], [{speed}], [{acceleration}], [{measured}])");
    let found = numbers(one(&context, &format!("SELECT {call}")).await?.column(0))[0];
    assert!((found - (measured - model)).abs() < 1e-13, "{found}, by hand {}", measured - model);
    Ok(())
}

/// The mass of a follower counts by the square of its ratio.
#[tokio::test]
async fn a_residual_has_the_followers() -> Result<()> {
    let (context, name) = (context(), key("jaws"));
    let (speed, acceleration, measured) = (1.5, -2.0, 20.0);
    let inertia = 0.3 + 100.0 * 0.001 + 4.0 * 0.2;
    let model = inertia * acceleration + 100.0 * 0.02 * speed;
    let call = format!("residual('{name}', [0.4], [{speed}], [{acceleration}], [{measured}])");
    let found = numbers(one(&context, &format!("SELECT {call}")).await?.column(0))[0];
    assert!((found - (measured - model)).abs() < 1e-13, "{found}, by hand {}", measured - model);
    Ok(())
}

/// Coulomb's friction changes its sign about the width of the file, as identification has it.
#[tokio::test]
async fn a_residual_has_the_friction_of_the_file() -> Result<()> {
    let (context, name) = (context(), key("wheel"));
    // 2 N m forward, 1 backward; at the width s is 0.7: from their mean on, so much of the way to the forward one
    let s = 0.5_f64.sqrt();
    let by_hand = 1.5 * s + 0.5;
    let call = format!("residual('{name}', [0.0], [0.05], [0.0], [0.0])");
    let found = numbers(one(&context, &format!("SELECT {call}")).await?.column(0))[0];
    assert!((found + by_hand).abs() < 1e-13, "{found}, by hand {}", -by_hand);
    Ok(())
}

#[tokio::test]
async fn a_pose_has_its_parts() -> Result<()> {
    let context = context();
    let sql = format!("SELECT forward_kinematics('{}', [0.0, 0.0]) AS pose", key("planar2"));
    let sql = format!("SELECT pose['translation'] AS p, pose['rotation'][1][1] AS r FROM ({sql})");
    let found = one(&context, &sql).await?;
    assert_eq!(numbers(found.column(0)).len(), 3);
    assert_eq!(numbers(found.column(1)), [1.0]);
    Ok(())
}

#[tokio::test]
async fn what_is_null_makes_a_state_null_and_no_other() -> Result<()> {
    let (context, planar) = (context(), key("planar2"));
    let lists = |rows: [Option<[Option<f64>; 2]>; 4]| rows.map(|row| row.map(Vec::from));
    let q = lists([Some([Some(0.1), Some(0.2)]), None, Some([Some(0.3), None]), Some([Some(0.4), Some(0.5)])]);
    let whole = [Some(vec![Some(0.1), Some(0.2)]), Some(vec![Some(0.4), Some(0.5)])];
    let list = |rows: &[Option<Vec<Option<f64>>>]| -> ArrayRef {
        Arc::new(ListArray::from_iter_primitive::<Float64Type, _, _>(rows.iter().cloned()))
    };
    let large: ArrayRef = Arc::new(LargeListArray::from_iter_primitive::<Float64Type, _, _>(q.iter().cloned()));
    let fixed: ArrayRef = Arc::new(FixedSizeListArray::from_iter_primitive::<Float64Type, _, _>(q.iter().cloned(), 2));
    let first: ArrayRef = Arc::new(Float64Array::from(vec![Some(0.1), None, Some(0.3), Some(0.4)]));
    let second: ArrayRef = Arc::new(Float64Array::from(vec![Some(0.2), Some(9.0), None, Some(0.5)]));
    let batch = RecordBatch::try_from_iter([
        ("list", list(&q)),
        ("large", large),
        ("fixed", fixed),
        ("q1", first),
        ("q2", second),
    ])?;
    context.register_batch("log", batch)?;
    context.register_batch("whole", RecordBatch::try_from_iter([("q", list(&whole))])?)?;
    let expected =
        numbers(one(&context, &format!("SELECT gravity_torques('{planar}', q) FROM whole")).await?.column(0));
    for arguments in ["list", "large", "fixed", "q1, q2"] {
        let found = one(&context, &format!("SELECT gravity_torques('{planar}', {arguments}) FROM log")).await?;
        let column = found.column(0);
        let nulls: Vec<bool> = (0..4).map(|state| column.is_null(state)).collect();
        assert_eq!(nulls, [false, true, true, false], "{arguments}");
        let column = numbers(column);
        assert_eq!([&column[..2], &column[6..]].concat(), expected, "{arguments}");
    }
    Ok(())
}

/// A part of a record that is null is null: where, averages and lists of parts would take its numbers in.
#[tokio::test]
async fn parts_of_what_is_null_are_null() -> Result<()> {
    let (context, planar) = (context(), key("planar2"));
    let q: ArrayRef = Arc::new(ListArray::from_iter_primitive::<Float64Type, _, _>([
        Some(vec![Some(0.3), Some(0.4)]),
        None,
        Some(vec![Some(0.3), None]),
    ]));
    context.register_batch("log", RecordBatch::try_from_iter([("q", q)])?)?;
    for (call, part, length) in [
        ("forward_kinematics('P', q)", "rotation", 9),
        ("forward_kinematics('P', q)", "translation", 3),
        ("momentum_and_rate('P', q, q, q)", "momentum", 2),
        ("momentum_and_rate('P', q, q, q)", "rate", 2),
        ("inverse_dynamics_derivatives('P', q, q, q)", "dq", 4),
    ] {
        let call = call.replace('P', &planar);
        let sql = format!("SELECT count(s) n, count({call}['{part}']) p FROM (SELECT {call} s, q FROM log)");
        let found = one(&context, &sql).await?;
        let counts = [0, 1].map(|at| found.column(at).as_primitive::<Int64Type>().value(0));
        assert_eq!(counts, [1, 1], "{part} of {call}");
        let found = one(&context, &format!("SELECT {call}['{part}'] p FROM log")).await?;
        assert!(found.column(0).is_valid(0) && found.column(0).is_null(1) && found.column(0).is_null(2));
        assert_eq!(numbers(&found.column(0).slice(0, 1)).len(), length, "{part} of {call}");
    }
    Ok(())
}

#[tokio::test]
async fn no_states_give_no_results_and_single_precision_is_read() -> Result<()> {
    let (context, planar) = (context(), key("planar2"));
    let columns: [(&str, ArrayRef); 2] =
        [("q1", Arc::new(Float32Array::from(vec![0.5_f32]))), ("q2", Arc::new(Float32Array::from(vec![0.25_f32])))];
    context.register_batch("log", RecordBatch::try_from_iter(columns)?)?;
    let call = format!("gravity_torques('{planar}', q1, q2)");
    let single = numbers(one(&context, &format!("SELECT {call} FROM log")).await?.column(0));
    let double = numbers(one(&context, &format!("SELECT gravity_torques('{planar}', [0.5, 0.25])")).await?.column(0));
    assert_eq!(single, double);
    let none = context.sql(&format!("SELECT {call} FROM log WHERE q1 > 9")).await?.collect().await?;
    assert_eq!(none.iter().map(RecordBatch::num_rows).sum::<usize>(), 0);
    let empty = MemTable::try_new(
        Arc::new(datafusion::arrow::datatypes::Schema::new(vec![
            Field::new("q1", DataType::Float64, true),
            Field::new("q2", DataType::Float64, true),
        ])),
        vec![vec![]],
    )?;
    context.register_table("empty", Arc::new(empty))?;
    assert_eq!(context.sql(&format!("SELECT {call} FROM empty")).await?.count().await?, 0);
    Ok(())
}

#[tokio::test]
async fn what_is_wrong_is_said_with_the_columns_name() -> Result<()> {
    let (context, puma) = (context(), key("puma560"));
    let ragged =
        ListArray::from_iter_primitive::<Float64Type, _, _>([Some(vec![Some(0.0); 6]), Some(vec![Some(0.0); 5])]);
    let words = ListArray::new(
        Arc::new(Field::new_list_field(DataType::Utf8, true)),
        OffsetBuffer::from_lengths([1, 1]),
        Arc::new(StringArray::from(vec!["a", "b"])),
        None,
    );
    let columns: [(&str, ArrayRef); 5] = [
        ("ragged", Arc::new(ragged)),
        ("words", Arc::new(words)),
        ("word", Arc::new(StringArray::from(vec!["a", "b"]))),
        ("q1", Arc::new(Float64Array::from(vec![0.0, 0.0]))),
        ("fixed", Arc::new(FixedSizeListArray::from_iter_primitive::<Float64Type, _, _>([Some([Some(0.0); 5]); 2], 5))),
    ];
    context.register_batch("log", RecordBatch::try_from_iter(columns)?)?;
    for (call, words) in [
        ("gravity_torques('puma560', ragged)".to_owned(), vec!["which puma560", puma.as_str()]),
        ("gravity_torques('puma560@0000000000000000', ragged)".to_owned(), vec!["is not the puma560", puma.as_str()]),
        ("gravity_torques('puma', ragged)".to_owned(), vec!["no robot `puma`", "puma560"]),
        (format!("gravity_torques('{puma}', ragged)"), vec!["`ragged`", "row 2", "5 numbers", "6 joints"]),
        (format!("gravity_torques('{puma}', word)"), vec!["column `word` is Utf8", "lists of numbers"]),
        (format!("gravity_torques('{puma}', q1, q1, q1, q1, q1, word)"), vec!["column `word` is Utf8"]),
        (format!("gravity_torques('{puma}', words)"), vec!["column `words` is List"]),
        (format!("identification('{puma}', ragged, ragged, ragged, word)"), vec!["column `word` is Utf8"]),
        (format!("gravity_torques('{puma}', fixed)"), vec!["column `fixed`", "`q`", "5 numbers", "6 joints"]),
        (format!("gravity_torques('{puma}', q1, q1, q1)"), vec!["`q`", "3 columns", "6 joints"]),
        (format!("gravity_torques('{puma}', q1, q1, q1, q1, q1, q1, q1)"), vec!["1 columns too many"]),
        (format!("inverse_dynamics('{puma}', ragged, ragged)"), vec!["`qdd` is missing"]),
        (format!("inverse_dynamics('{puma}')"), vec!["`q` is missing"]),
        ("inverse_dynamics()".to_owned(), vec!["inverse_dynamics"]),
        ("gravity_torques(word, ragged)".to_owned(), vec!["first argument is the robot", "literal"]),
        ("gravity_torques(1, ragged)".to_owned(), vec!["first argument is the robot"]),
    ] {
        let said = refused(&context, &format!("SELECT {call} FROM log")).await;
        for word in words {
            assert!(said.contains(word), "{call}: {said}");
        }
    }
    Ok(())
}

/// The key is that of the robot file and of the plan beside it: another plan computes other bits.
#[test]
fn a_key_is_that_of_the_files_that_are_read() {
    let shipped = rne_robots::find("planar2").expect("it is shipped");
    let plan = shipped.plan.expect("it has one");
    let key = |text: &str| {
        let digest = Sha256::digest(text);
        format!("planar2@{:016x}", u64::from_be_bytes(digest[..8].try_into().expect("eight bytes")))
    };
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("planar2.yaml");
    let held = || Robots::none().with_file(&path).map(|robots| robots.key("planar2").expect("it is held"));
    std::fs::write(&path, shipped.yaml).expect("a file");
    assert_eq!(held().expect("a robot"), key(shipped.yaml));
    assert_eq!(Robots::none().with_yaml(shipped.yaml).expect("a robot").key("planar2"), Some(key(shipped.yaml)));
    std::fs::write(folder.path().join("planar2.plan.yaml"), plan).expect("a file");
    assert_eq!(held().expect("a robot"), key(&format!("{}{plan}", shipped.yaml)));
    assert_eq!(Robots::shipped().expect("robots").key("planar2"), Some(key(&format!("{}{plan}", shipped.yaml))));
    // mistakes are told with the name of the file
    std::fs::write(folder.path().join("planar2.plan.yaml"), "nonsense").expect("a file");
    assert!(held().expect_err("no plan").to_string().contains("planar2.plan.yaml"));
    std::fs::write(&path, "format: 3").expect("a file");
    assert!(held().expect_err("no robot").to_string().contains("planar2.yaml:1:"));
}

/// The names of SQL are those of the list that `cargo xtask surface` compares for the other doors.
#[test]
fn names_are_those_of_the_surface() {
    let robots = robots();
    let names =
        rne_datafusion::functions(&robots).iter().map(|function| function.name().to_owned()).collect::<Vec<_>>();
    let aggregates = rne_datafusion::aggregates(&robots).into_iter().map(|function| function.name().to_owned());
    let windows = rne_datafusion::windows(&robots).into_iter().map(|function| function.name().to_owned());
    let mut names: Vec<String> = names.into_iter().chain(aggregates).chain(windows).collect();
    names.sort();
    let list = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/surface.txt"));
    let list = list.expect("the list");
    let listed: Vec<&str> = list.lines().filter_map(|line| line.strip_prefix("sql ")).collect();
    assert_eq!(names, listed);
}
