//! Identification in SQL: what is found is what was put in, in whatever parts the rows come.

use std::sync::Arc;

use datafusion::arrow::array::{
    Array, ArrayRef, AsArray, FixedSizeListArray, Float64Array, Int64Array, ListArray, RecordBatch, StructArray,
};
use datafusion::arrow::datatypes::{Float64Type, Int64Type};
use datafusion::arrow::util::pretty::pretty_format_batches;
use datafusion::common::Result;
use datafusion::datasource::MemTable;
use datafusion::prelude::{SessionConfig, SessionContext};
use fastrand::Rng;
use rne::compiled::{Arguments, CompiledArm, Destination, Function};
use rne::model::Robot;
use rne_datafusion::{Robots, register};
use rne_identify::{Options, Structure};

/// Two bodies in three dimensions, with friction.
const ARM: &str = include_str!("../../../logs/identify/tests/two.yaml");
const JOINTS: usize = 2;

/// Three joints and a finger that follows another.
const GRIPPER: &str = include_str!("../../../docs/gripper.yaml");

/// Those that are shipped, and the arm.
fn robots() -> Robots {
    let robots = Robots::shipped().and_then(|robots| robots.with_yaml(ARM));
    robots.and_then(|robots| robots.with_yaml(GRIPPER)).expect("they are right")
}

fn context(partitions: usize) -> SessionContext {
    let context = SessionContext::new_with_config(SessionConfig::new().with_target_partitions(partitions));
    register(&context, &robots());
    context
}

fn key(name: &str) -> String {
    robots().key(name).expect("it is held")
}

/// A state: number, then positions, rates, accelerations and torques of all joints.
#[derive(Clone)]
struct State {
    number: i64,
    lists: [Vec<f64>; 4],
}

/// Random states of an arm with the torques of its file, friction of its motors included, and noise.
fn states(yaml: &str, count: i64, noise: f64) -> Vec<State> {
    let arm = CompiledArm::from_yaml(yaml).expect("it is right");
    let joints = arm.dof();
    let mut random = Rng::with_seed(7);
    let state = |number: i64| {
        let mut numbers = |size: f64| -> Vec<f64> { (0..joints).map(|_| size * (2.0 * random.f64() - 1.0)).collect() };
        let (q, qd, qdd, white) = (numbers(3.0), numbers(2.0), numbers(10.0), numbers(noise));
        let rows = rne::compiled::Array::Rows;
        let given = Arguments::new().q(rows(&q)).qd(rows(&qd)).qdd(rows(&qdd));
        let mut tau = vec![0.0; joints];
        arm.run(Function::InverseDynamics, 1, &given, Destination::Rows(&mut tau)).expect("it computes");
        for (joint, tau) in tau.iter_mut().enumerate() {
            let friction = arm.robot().independent_joint(joint).map_or(0.0, |of| of.friction(qd[joint]));
            *tau += friction + white[joint];
        }
        State { number, lists: [q, qd, qdd, tau] }
    };
    (0..count).map(state).collect()
}

/// A column `number`, lists `q`, `qd`, `qdd`, `tau`, and columns `q1`, ….
fn batch(states: &[State]) -> RecordBatch {
    let mut columns: Vec<(String, ArrayRef)> = Vec::new();
    columns.push(("number".into(), Arc::new(states.iter().map(|state| Some(state.number)).collect::<Int64Array>())));
    for (at, name) in ["q", "qd", "qdd", "tau"].iter().enumerate() {
        let lists = states.iter().map(|state| Some(state.lists[at].iter().copied().map(Some)));
        columns.push(((*name).into(), Arc::new(ListArray::from_iter_primitive::<Float64Type, _, _>(lists))));
        for joint in 0..states.first().map_or(JOINTS, |state| state.lists[at].len()) {
            let column: Float64Array = states.iter().map(|state| Some(state.lists[at][joint])).collect();
            columns.push((format!("{name}{}", joint + 1), Arc::new(column)));
        }
    }
    RecordBatch::try_from_iter(columns).expect("columns of one length")
}

/// A table of so many partitions, each of some batches, that are slices.
fn table(states: &[State], partitions: usize) -> MemTable {
    let partitions: Vec<Vec<RecordBatch>> = states
        .chunks(states.len().div_ceil(partitions))
        .map(|part| {
            let all = batch(part);
            (0..part.len()).step_by(37).map(|start| all.slice(start, 37.min(part.len() - start))).collect()
        })
        .collect();
    MemTable::try_new(partitions[0][0].schema(), partitions).expect("batches of one schema")
}

async fn one(context: &SessionContext, sql: &str) -> Result<RecordBatch> {
    let batches = context.sql(sql).await?.collect().await?;
    let schema = batches.first().map(RecordBatch::schema).expect("a batch");
    Ok(datafusion::arrow::compute::concat_batches(&schema, &batches)?)
}

async fn refused(context: &SessionContext, sql: &str) -> String {
    one(context, sql).await.expect_err("it is refused").to_string()
}

/// What a row of the result says.
#[derive(Debug)]
struct Found {
    states: i64,
    names: Vec<String>,
    values: Vec<f64>,
    deviations: Vec<f64>,
    excited: Vec<bool>,
    noise: Vec<f64>,
    robot: String,
}

fn found(column: &StructArray, row: usize) -> Found {
    let list = |name: &str| column.column_by_name(name).expect("it is there").as_list::<i32>().value(row);
    let parameters = list("parameters");
    let parameter = |name: &str| parameters.as_struct().column_by_name(name).expect("it is there").clone();
    let numbers = |array: &ArrayRef| array.as_primitive::<Float64Type>().values().to_vec();
    Found {
        states: column.column_by_name("states").expect("it is there").as_primitive::<Int64Type>().value(row),
        names: parameter("parameter").as_string::<i32>().iter().flatten().map(str::to_owned).collect(),
        values: numbers(&parameter("value")),
        deviations: numbers(&parameter("deviation")),
        excited: parameter("excited").as_boolean().iter().flatten().collect(),
        noise: numbers(&list("noise")),
        robot: column.column_by_name("robot").expect("it is there").as_string::<i32>().value(row).to_owned(),
    }
}

async fn identified(context: &SessionContext, sql: &str) -> Result<Found> {
    let batch = one(context, sql).await?;
    assert_eq!(batch.num_rows(), 1, "{sql}");
    Ok(found(batch.column(0).as_struct(), 0))
}

fn same(one: &Found, other: &Found) {
    assert_eq!((one.states, &one.names, &one.excited), (other.states, &other.names, &other.excited));
    let pairs = |of: fn(&Found) -> &Vec<f64>| of(one).iter().zip(of(other)).collect::<Vec<_>>();
    let largest = one.values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    for (at, (a, b)) in pairs(|found| &found.values).into_iter().enumerate() {
        assert!((a - b).abs() <= 1e-10 * largest, "{}: {a} {b}", one.names[at]);
    }
    for (a, b) in [pairs(|found| &found.deviations), pairs(|found| &found.noise)].concat() {
        assert!((a - b).abs() <= 1e-10 * a.abs(), "{a} {b}");
    }
}

/// Base parameters and friction that were put in, by name.
fn truth(yaml: &str) -> Vec<(String, f64)> {
    let robot = Robot::from_yaml(yaml).expect("it is right");
    let structure = Structure::new(&robot, Options::default());
    let parameters = structure.parameters();
    let values = &parameters.regrouping * parameters.of_robot(&robot);
    let bases = parameters.bases.iter().zip(values.iter()).map(|(base, value)| (base.name(), *value));
    let friction = robot.joints.iter().enumerate().flat_map(|(at, joint)| {
        let motor = joint.motor.expect("it has one");
        let [forward, backward] = motor.coulomb;
        let named = [("viscous", motor.viscous), ("coulomb_forward", forward), ("coulomb_backward", -backward)];
        named.map(|(name, value)| (format!("{name}{}", at + 1), value))
    });
    bases.chain(friction).collect()
}

#[tokio::test]
async fn an_arm_is_identified_from_made_up_torques() -> Result<()> {
    let context = context(4);
    context.register_table("log", Arc::new(table(&states(ARM, 3000, 1e-6), 5)))?;
    let found =
        identified(&context, &format!("SELECT identification('{}', q, qd, qdd, tau) FROM log", key("two"))).await?;
    let truth = truth(ARM);
    assert_eq!(found.states, 3000);
    assert_eq!(found.names, truth.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>());
    for (at, (name, value)) in truth.iter().enumerate() {
        assert!((found.values[at] - value).abs() < 1e-6, "{name}: {} for {value}", found.values[at]);
        assert!(found.excited[at], "{name}");
    }
    // uniform noise of that size
    for noise in &found.noise {
        assert!((noise / (1e-6 / 3_f64.sqrt()) - 1.0).abs() < 0.1, "{noise}");
    }
    // the robot file has the torques of the arm, its friction included
    for (measured, identified) in states(ARM, 100, 0.0).iter().zip(states(&found.robot, 100, 0.0)) {
        let [_, _, _, measured] = &measured.lists;
        for (measured, identified) in measured.iter().zip(&identified.lists[3]) {
            assert!((measured - identified).abs() < 1e-5, "{measured} {identified}");
        }
    }
    Ok(())
}

/// A joint that follows another has no torque of its own: three noises, and torques of three joints.
#[tokio::test]
async fn a_gripper_is_identified() -> Result<()> {
    let context = context(4);
    context.register_table("log", Arc::new(table(&states(GRIPPER, 3000, 1e-6), 5)))?;
    let call = format!("identification('{}', q, qd, qdd, tau)", key("gripper"));
    let found = identified(&context, &format!("SELECT {call} FROM log")).await?;
    assert_eq!((found.states, found.noise.len()), (3000, 3));
    let of_friction = found.names.iter().filter(|name| name.starts_with("viscous") || name.starts_with("coulomb"));
    assert_eq!(of_friction.count(), 3 * 3, "{:?}", found.names);
    for (measured, identified) in states(GRIPPER, 100, 0.0).iter().zip(states(&found.robot, 100, 0.0)) {
        for (measured, identified) in measured.lists[3].iter().zip(&identified.lists[3]) {
            assert!((measured - identified).abs() < 1e-5, "{measured} {identified}");
        }
    }
    Ok(())
}

#[tokio::test]
async fn one_and_sixty_four_shuffled_partitions_are_one() -> Result<()> {
    let call = format!("identification('{}', q, qd, qdd, tau)", key("two"));
    let mut states = states(ARM, 4000, 0.3);
    let one_part = context(1);
    one_part.register_table("log", Arc::new(table(&states, 1)))?;
    let whole = identified(&one_part, &format!("SELECT {call} FROM log")).await?;
    Rng::with_seed(5).shuffle(&mut states);
    let many = context(64);
    many.register_table("log", Arc::new(table(&states, 64)))?;
    let sql = format!("SELECT {call} FROM log");
    // gathered in parts that travel, and merged
    let plan = one(&many, &format!("EXPLAIN {sql}")).await?;
    let plan = pretty_format_batches(&[plan])?.to_string();
    assert!(plan.contains("mode=Partial") && plan.contains("mode=Final"), "{plan}");
    same(&identified(&many, &sql).await?, &whole);
    // columns are lists
    let of = |name: &str| format!("{name}1, {name}2");
    let columns = ["q", "qd", "qdd", "tau"].map(of).join(", ");
    same(&identified(&many, &format!("SELECT identification('{}', {columns}) FROM log", key("two"))).await?, &whole);
    // a deviation is about what is off
    for ((name, value), (found, deviation)) in truth(ARM).iter().zip(whole.values.iter().zip(&whole.deviations)) {
        assert!((found - value).abs() < 5.0 * deviation, "{name}: {found} ± {deviation} for {value}");
    }
    Ok(())
}

#[tokio::test]
async fn groups_are_identified_by_themselves() -> Result<()> {
    let call = format!("identification('{}', q, qd, qdd, tau)", key("two"));
    for partitions in [1, 3] {
        let context = context(partitions);
        context.register_table("log", Arc::new(table(&states(ARM, 3000, 0.2), 3)))?;
        let groups =
            one(&context, &format!("SELECT number % 3 AS part, {call} FROM log GROUP BY part ORDER BY part")).await?;
        assert_eq!(groups.num_rows(), 3);
        for part in 0..3 {
            let alone = identified(&context, &format!("SELECT {call} FROM log WHERE number % 3 = {part}")).await?;
            same(&found(groups.column(1).as_struct(), part), &alone);
        }
        let filtered = format!("SELECT {call} FILTER (WHERE number % 3 = 1) FROM log");
        same(&identified(&context, &filtered).await?, &found(groups.column(1).as_struct(), 1));
    }
    Ok(())
}

#[tokio::test]
async fn an_unnested_result_is_a_table_of_parameters() -> Result<()> {
    let context = context(2);
    context.register_table("log", Arc::new(table(&states(ARM, 500, 0.1), 2)))?;
    let sql = format!(
        "SELECT p['parameter'], p['value'], p['deviation'], p['unit'] FROM (SELECT \
         unnest(identification('{}', q, qd, qdd, tau)['parameters']) AS p FROM log) WHERE p['excited']",
        key("two")
    );
    let batch = one(&context, &sql).await?;
    assert_eq!(batch.num_rows(), truth(ARM).len());
    let units: Vec<&str> = batch.column(3).as_string::<i32>().iter().flatten().collect();
    assert!(units.contains(&"kg m²") && units.contains(&"N m s/rad"), "{units:?}");
    Ok(())
}

#[tokio::test]
async fn what_is_null_is_left_out_and_no_rows_are_null() -> Result<()> {
    let (context, two) = (context(2), key("two"));
    let states = states(ARM, 400, 0.1);
    context.register_table("log", Arc::new(table(&states, 2)))?;
    let whole = identified(&context, &format!("SELECT identification('{two}', q, qd, qdd, tau) FROM log")).await?;
    // the same rows, and some of which a list, a number or a column is null
    let with_nulls = "(SELECT q, qd, qdd, tau, tau1, tau2 FROM log UNION ALL SELECT NULL, qd, qdd, tau, tau1, tau2 \
                      FROM log UNION ALL SELECT q, [NULL, 0.5], qdd, tau, NULL, tau2 FROM log)";
    let lists = format!("SELECT identification('{two}', q, qd, qdd, tau) FROM {with_nulls}");
    same(&identified(&context, &lists).await?, &whole);
    let columns = format!("SELECT identification('{two}', q, qd, qdd, tau1, tau2) FROM {with_nulls}");
    same(&identified(&context, &columns).await?, &whole);
    // no rows, or none without a null: nothing is known
    for from in ["log WHERE number < 0", "(SELECT CAST(NULL AS DOUBLE[]) AS q, qd, qdd, tau FROM log)"] {
        let none = one(&context, &format!("SELECT identification('{two}', q, qd, qdd, tau) FROM {from}")).await?;
        assert_eq!((none.num_rows(), none.column(0).null_count()), (1, 1), "{from}");
    }
    // fewer rows than unknowns: what they do not say is not excited
    let few = format!("SELECT identification('{two}', q, qd, qdd, tau) FROM log WHERE number < 3");
    let few = identified(&context, &few).await?;
    assert!(few.states == 3 && few.excited.contains(&false) && few.values.iter().all(|value| value.is_finite()));
    Ok(())
}

#[tokio::test]
async fn what_is_wrong_is_said_with_the_columns_name() -> Result<()> {
    let (context, two, puma) = (context(2), key("two"), key("puma560"));
    let mut states = states(ARM, 20, 0.0);
    states[12].lists[2][1] = f64::NAN;
    let log = batch(&states);
    let ragged = ListArray::from_iter_primitive::<Float64Type, _, _>(
        (0..20).map(|row| Some(vec![Some(0.0); if row == 3 { 3 } else { 2 }])),
    );
    let fixed = FixedSizeListArray::from_iter_primitive::<Float64Type, _, _>(vec![Some([Some(0.0); 3]); 20], 3);
    let mut columns: Vec<(String, ArrayRef)> =
        log.schema().fields().iter().map(|field| field.name().clone()).zip(log.columns().to_vec()).collect();
    columns.push(("ragged".into(), Arc::new(ragged)));
    columns.push(("fixed".into(), Arc::new(fixed)));
    context.register_batch("log", RecordBatch::try_from_iter(columns)?)?;
    for (call, words) in [
        ("identification('two', q, qd, qdd, tau)".to_owned(), vec!["which two", two.as_str()]),
        ("identification('two@0000000000000000', q, qd, qdd, tau)".to_owned(), vec!["is not the two", two.as_str()]),
        ("identification(number, q, qd, qdd, tau)".to_owned(), vec!["first argument is the robot"]),
        ("identification()".to_owned(), vec!["identification"]),
        (format!("identification('{two}', q, qd, qdd)"), vec!["`tau` is missing"]),
        (format!("identification('{two}', q, qd, qdd, tau, tau)"), vec!["1 columns too many"]),
        (format!("identification('{puma}', q, qd, qdd, tau)"), vec!["`q`", "row 1", "2 numbers", "6 joints"]),
        (format!("identification('{two}', q, ragged, q, tau)"), vec!["`ragged`", "row 4", "3 numbers", "2 joints"]),
        (format!("identification('{two}', q, qd, fixed, tau)"), vec!["`qdd`", "3 numbers", "2 joints"]),
        (format!("identification('{two}', q1, qd, q, tau)"), vec!["`q`", "1 columns", "2 joints"]),
        (format!("identification('{two}', q, qd, qdd, tau)"), vec!["`qdd`", "row 13", "joint 2", "NaN"]),
        (format!("identification('{two}', q, qd, qdd1, qdd2, tau)"), vec!["`qdd2`", "row 13", "NaN"]),
        (format!("identification(DISTINCT '{two}', q, qd, qdd, tau)"), vec!["DISTINCT"]),
    ] {
        let said = refused(&context, &format!("SELECT {call} FROM log")).await;
        for word in words {
            assert!(said.contains(word), "{call}: {said}");
        }
    }
    Ok(())
}

/// The PUMA with rotors: what its file says of them is not asked, what the torques say is.
#[tokio::test]
async fn rotors_are_identified_where_the_file_has_some() -> Result<()> {
    let file = rne_robots::find("puma560").expect("it is shipped").yaml;
    let context = context(2);
    context.register_table("log", Arc::new(table(&states(file, 2500, 0.01), 4)))?;
    let found =
        identified(&context, &format!("SELECT identification('{}', q, qd, qdd, tau) FROM log", key("puma560"))).await?;
    // the torques were made without rotors
    for (name, value) in found.names.iter().zip(&found.values).filter(|(name, _)| name.starts_with("Jm")) {
        assert!(value.abs() < 1e-3, "{name}: {value}");
    }
    assert!(found.names.iter().any(|name| name.starts_with("Jm")), "{:?}", found.names);
    Ok(())
}
