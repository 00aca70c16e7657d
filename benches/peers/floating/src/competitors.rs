//! The programs, each with its functions of many states.

use std::ffi::{CString, c_char, c_int, c_void};
use std::ops::Range;

use dynibo::FloatingRobot;
use libloading::Library;
use rne_codegen::Function;
use rne_machine::{Arguments, Array, CompiledArm, Destination};

use crate::state::{GRAVITY, State};

/// The quantity that a competitor computes.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    InverseDynamics,
    ForwardDynamics,
    MassMatrix,
    MomentumMatrix,
}

impl Quantity {
    pub const ALL: [Self; 4] = [Self::InverseDynamics, Self::ForwardDynamics, Self::MassMatrix, Self::MomentumMatrix];

    pub fn name(self) -> &'static str {
        match self {
            Self::InverseDynamics => "torques",
            Self::ForwardDynamics => "forward dynamics",
            Self::MassMatrix => "mass matrix",
            Self::MomentumMatrix => "centroidal momentum matrix",
        }
    }
}

/// A function of a program.
pub struct Competitor<'a> {
    pub name: &'static str,
    pub quantity: Quantity,
    /// Whether one call computes many states.
    pub is_batch: bool,
    /// Computes these states.
    pub call: Box<dyn FnMut(Range<usize>) + 'a>,
    /// The result of one state in the vectors of rne: base first, force above moment, matrices row by row.
    pub result: Box<dyn FnMut(usize) -> Vec<f64> + 'a>,
}

/// rne, generated for one robot.
pub fn ours<'a, R, const DOF: usize, const NV: usize>(states: &'a [State<DOF>]) -> Vec<Competitor<'a>>
where
    R: rne::FloatingBase<DOF, NV, 1> + rne::CentroidalMomentum<DOF, NV> + Default + 'a,
{
    // the files have one tip, that of the tool
    let free = [rne::Wrench::zero()];
    let torques = move |s: &State<DOF>| {
        let found = R::default().inverse_dynamics_of_floating_base(&s.q, &s.qd, &s.qdd, &s.base, &free);
        (found.wrench.force, found.wrench.moment, found.tau)
    };
    let accelerations = move |s: &State<DOF>| {
        let found = R::default().floating_forward_dynamics(&s.q, &s.qd, &s.tau, &s.base.omega, &free);
        (found.base.linear, found.base.angular, found.qdd)
    };
    let joined = |(a, b, c): ([f64; 3], [f64; 3], [f64; DOF])| [&a[..], &b, &c].concat();
    let mass = |s: &State<DOF>| R::default().floating_mass_matrix(&s.q);
    let momentum = |s: &State<DOF>| R::default().centroidal_momentum_matrix(&s.q);
    vec![
        of_states(states, "rne", Quantity::InverseDynamics, torques, joined),
        of_states(states, "rne", Quantity::ForwardDynamics, accelerations, joined),
        of_states(states, "rne", Quantity::MassMatrix, mass, |rows| rows.concat()),
        of_states(states, "rne", Quantity::MomentumMatrix, momentum, |rows| rows.concat()),
    ]
}

fn of_states<'a, S, O: Copy + 'a>(
    states: &'a [S],
    name: &'static str,
    quantity: Quantity,
    function: impl Fn(&S) -> O + Copy + 'a,
    flat: impl Fn(O) -> Vec<f64> + 'a,
) -> Competitor<'a> {
    // Each result overwrites the one before, as in Pinocchio's `Data`: large matrices stay in the cache.
    let call = move |range: Range<usize>| {
        for state in &states[range] {
            std::hint::black_box(&function(state));
        }
    };
    let result = move |index: usize| flat(function(&states[index]));
    Competitor { name, quantity, is_batch: false, call: Box::new(call), result: Box::new(result) }
}

/// Numbers of all states, element by element.
fn columns<const DOF: usize>(states: &[State<DOF>], of: &dyn Fn(&State<DOF>) -> Vec<f64>) -> Vec<Vec<f64>> {
    let rows: Vec<Vec<f64>> = states.iter().map(of).collect();
    (0..rows[0].len()).map(|column| rows.iter().map(|row| row[column]).collect()).collect()
}

/// Slices of as many columns as there are.
fn slices<const N: usize>(columns: &[Vec<f64>]) -> [&[f64]; N] {
    std::array::from_fn(|index| columns[index].as_slice())
}

/// rne, generated for one robot, for all states in one call.
pub fn batch<'a, R, const DOF: usize, const NV: usize>(states: &'a [State<DOF>]) -> Competitor<'a>
where
    R: rne::BatchFloatingInverseDynamics<DOF, NV, 1> + Default + 'a,
{
    let [q, qd, qdd] =
        [columns(states, &|s| s.q.to_vec()), columns(states, &|s| s.qd.to_vec()), columns(states, &|s| s.qdd.to_vec())];
    let base = columns(states, &|s| [s.base.omega, s.base.omega_dot, s.base.acceleration, s.base.gravity].concat());
    let run = move |room: &mut [f64]| {
        let [omega, omega_dot, acceleration, gravity] = [0, 3, 6, 9].map(|first| slices::<3>(&base[first..]));
        let nothing: [&[f64]; 3] = [&[]; 3];
        let base = rne::BaseMotion { omega, omega_dot, velocity: nothing, acceleration, gravity };
        let free = [rne::Wrench { force: nothing, moment: nothing }];
        let mut results = room.chunks_mut(states.len());
        let wrench = std::array::from_fn(|_| results.next().expect("room for the wrench"));
        let tau = std::array::from_fn(|_| results.next().expect("room for the torques"));
        let (q, qd, qdd) = (slices(&q), slices(&qd), slices(&qdd));
        let done = R::default().inverse_dynamics_of_floating_base_batch(q, qd, qdd, &base, &free, wrench, tau);
        done.unwrap_or_else(|mismatch| panic!("{mismatch}"));
    };
    let mut room = vec![0.0; NV * states.len()];
    run(&mut room);
    let first = room.clone();
    let result = move |index: usize| first.chunks(states.len()).map(|column| column[index]).collect();
    let call = move |_: Range<usize>| run(&mut room);
    let (call, result) = (Box::new(call), Box::new(result));
    Competitor { name: "rne_batch", quantity: Quantity::InverseDynamics, is_batch: true, call, result }
}

/// rne, compiled at run time, for all states in one call.
pub fn machine<'a, const DOF: usize>(states: &'a [State<DOF>], arm: &'a CompiledArm) -> Vec<Competitor<'a>> {
    let columns = |of: &dyn Fn(&State<DOF>) -> Vec<f64>| columns(states, of);
    let functions = [
        (Function::InverseDynamicsOfFloatingBase, Quantity::InverseDynamics),
        (Function::FloatingForwardDynamics, Quantity::ForwardDynamics),
    ];
    let competitors = functions.map(|(function, quantity)| {
        let told = [
            columns(&|s| s.q.to_vec()),
            columns(&|s| s.qd.to_vec()),
            columns(&|s| s.qdd.to_vec()),
            columns(&|s| s.tau.to_vec()),
            columns(&|s| s.base.omega.to_vec()),
            columns(&|s| s.base.omega_dot.to_vec()),
            columns(&|s| s.base.acceleration.to_vec()),
            columns(&|s| s.base.gravity.to_vec()),
        ];
        let outputs = arm.function(function).unwrap_or_else(|error| panic!("{error}")).outputs();
        let run = move |room: &mut [f64]| {
            let slices = told.each_ref().map(|columns| columns.iter().map(Vec::as_slice).collect::<Vec<_>>());
            let [q, qd, qdd, tau, omega, omega_dot, acceleration, gravity] =
                slices.each_ref().map(|s| Array::Columns(s));
            let arguments = Arguments::new().q(q).qd(qd).qdd(qdd).tau(tau).omega(omega);
            let arguments = arguments.base_omega(omega).base_omega_dot(omega_dot);
            let arguments = arguments.base_acceleration(acceleration).base_gravity(gravity);
            let arguments = arguments.wrenches(Array::Same(&[0.0; 6]));
            let results = Destination::Columns(room.chunks_mut(states.len()).collect());
            arm.run(function, states.len(), &arguments, results).unwrap_or_else(|error| panic!("{error}"));
        };
        let mut room = vec![0.0; outputs * states.len()];
        run(&mut room);
        let first = room.clone();
        let result = move |index: usize| first.chunks(states.len()).map(|column| column[index]).collect();
        let call = move |_: Range<usize>| run(&mut room);
        Competitor { name: "rne_machine", quantity, is_batch: true, call: Box::new(call), result: Box::new(result) }
    });
    competitors.into()
}

/// Places of our joints in the vectors of another program.
struct Places(Vec<usize>);

impl Places {
    fn there(&self, first: usize, ours: &[f64]) -> Vec<f64> {
        let mut vector = vec![0.0; first + ours.len()];
        for (place, x) in self.0.iter().zip(ours) {
            vector[first + place] = *x;
        }
        vector
    }

    fn ours(&self, theirs: &[f64]) -> Vec<f64> {
        self.0.iter().map(|place| theirs[*place]).collect()
    }
}

type Call = unsafe extern "C" fn(*mut c_void, *const f64, *const f64, *const f64, *mut f64);

/// Pinocchio behind `native/pinocchio_floating.cpp`.
pub fn pinocchio<'a, const DOF: usize>(
    library: &'a Library,
    [folder, robot]: [&str; 2],
    states: &'a [State<DOF>],
) -> Vec<Competitor<'a>> {
    let text = |text: &str| CString::new(text).unwrap_or_else(|error| panic!("{error}"));
    // SAFETY: the types are those of the file.
    let (open, place, matrix) = unsafe {
        (
            symbol::<unsafe extern "C" fn(*const c_char, *const c_char, f64) -> *mut c_void>(library, b"pf_open"),
            symbol::<unsafe extern "C" fn(*const c_void, c_int) -> c_int>(library, b"pf_place"),
            [b"pf_mass_matrix".as_slice(), b"pf_momentum_matrix"]
                .map(|name| symbol::<unsafe extern "C" fn(*mut c_void) -> *const f64>(library, name)),
        )
    };
    let [folder, robot] = [folder, robot].map(text);
    // SAFETY: strings of C, and a robot that stays to the end of the process.
    let robot = unsafe { open(folder.as_ptr(), robot.as_ptr(), GRAVITY) };
    let place = |joint: usize| {
        let number = c_int::try_from(joint + 1).expect("few joints");
        // SAFETY: the robot, which has this joint.
        usize::try_from(unsafe { place(robot, number) }).expect("a place") - 6
    };
    let places: &'static Places = Box::leak(Box::new(Places((0..DOF).map(place).collect())));
    let nv = DOF + 6;
    let functions = [
        (b"pf_rnea".as_slice(), "pin_rnea", Quantity::InverseDynamics),
        (b"pf_aba", "pin_aba", Quantity::ForwardDynamics),
        (b"pf_crba", "pin_crba", Quantity::MassMatrix),
        (b"pf_ccrba", "pin_ccrba", Quantity::MomentumMatrix),
    ];
    let competitors = functions.map(|(symbol_name, name, quantity)| {
        // SAFETY: the type is that of the file.
        let function = unsafe { symbol::<Call>(library, symbol_name) };
        let arguments: Vec<[Vec<f64>; 3]> = states
            .iter()
            .map(|s| {
                let with = |base: &[f64], ours: &[f64]| {
                    let mut vector = places.there(base.len(), ours);
                    vector[..base.len()].copy_from_slice(base);
                    vector
                };
                let (q, v, a) = &s.pinocchio;
                let third = match quantity {
                    Quantity::ForwardDynamics => with(&[0.0; 6], &s.tau),
                    _ => with(a, &s.qdd),
                };
                [with(q, &s.q), with(v, &s.qd), third]
            })
            .collect();
        let arguments: &'static [[Vec<f64>; 3]] = arguments.leak();
        let run = move |index: usize, out: &mut [f64]| {
            let [q, v, third] = &arguments[index];
            // SAFETY: 7 + n, 6 + n and 6 + n numbers, and room for 6 + n, which overlaps nothing.
            unsafe { function(robot, q.as_ptr(), v.as_ptr(), third.as_ptr(), out.as_mut_ptr()) };
        };
        let mut room = vec![0.0; nv];
        let call = move |range: Range<usize>| range.for_each(|index| run(index, &mut room));
        let result = move |index: usize| {
            let mut out = vec![0.0; nv];
            run(index, &mut out);
            let matrix = match quantity {
                Quantity::InverseDynamics => return [&out[..6], &places.ours(&out[6..])].concat(),
                Quantity::ForwardDynamics => return accelerations(&states[index], &out, places),
                Quantity::MassMatrix => matrix[0],
                Quantity::MomentumMatrix => matrix[1],
            };
            let rows = if quantity == Quantity::MassMatrix { nv } else { 6 };
            // SAFETY: a matrix of `rows` rows and 6 + n columns, column by column, until the next call.
            let numbers = unsafe { std::slice::from_raw_parts(matrix(robot), rows * nv) };
            matrix_in_base(&states[index], numbers, rows, places)
        };
        Competitor { name, quantity, is_batch: false, call: Box::new(call), result: Box::new(result) }
    });
    competitors.into()
}

/// # Safety
/// The symbol has this type.
unsafe fn symbol<T: Copy>(library: &Library, name: &[u8]) -> T {
    // SAFETY: as this function's.
    *unsafe { library.get::<T>(name) }.unwrap_or_else(|error| panic!("{error}"))
}

/// Pinocchio's spatial acceleration as the classical one less gravity.
fn accelerations<const DOF: usize>(s: &State<DOF>, found: &[f64], places: &Places) -> Vec<f64> {
    let ([x, y, z], [u, v, w]) = (s.base.omega, s.base.velocity);
    let turned = [y * w - z * v, z * u - x * w, x * v - y * u];
    let linear = [0, 1, 2].map(|i| found[i] + turned[i] - s.base.gravity[i]);
    [&linear[..], &found[3..6], &places.ours(&found[6..])].concat()
}

/// A matrix of columns in our order and row by row; rows of a momentum in axes of the base, not in world axes.
fn matrix_in_base<const DOF: usize>(s: &State<DOF>, numbers: &[f64], rows: usize, places: &Places) -> Vec<f64> {
    let order: Vec<usize> = (0..6).chain(places.0.iter().map(|place| place + 6)).collect();
    let columns: Vec<Vec<f64>> = order
        .iter()
        .map(|&column| {
            let column = &numbers[column * rows..][..rows];
            if rows == 6 {
                let halves = [0, 3].map(|half| s.in_base([column[half], column[half + 1], column[half + 2]]));
                halves.concat()
            } else {
                order.iter().map(|&row| column[row]).collect()
            }
        })
        .collect();
    (0..rows).flat_map(|row| columns.iter().map(move |column| column[row])).collect()
}

/// dynibo.
pub fn dynibo<'a, const DOF: usize>(urdf: &str, joints: &[String], states: &'a [State<DOF>]) -> Vec<Competitor<'a>> {
    let nv = DOF + 6;
    let functions = [("dynibo_rnea", Quantity::InverseDynamics), ("dynibo_aba", Quantity::ForwardDynamics)];
    let competitors = functions.map(|(name, quantity)| {
        let mut robot = FloatingRobot::from_urdf(urdf).unwrap_or_else(|error| panic!("{urdf}: {error}"));
        let names: Vec<String> =
            (0..DOF).map(|i| robot.joint_name(i).unwrap_or_else(|error| panic!("{error}")).to_owned()).collect();
        let place = |name: &String| names.iter().position(|other| other == name).expect("the joint of the URDF");
        let places: &'static Places = Box::leak(Box::new(Places(joints.iter().map(place).collect())));
        let arguments: Vec<[Vec<f64>; 3]> = states
            .iter()
            .map(|s| {
                let third = match quantity {
                    Quantity::ForwardDynamics => places.there(6, &s.tau),
                    _ => places.there(0, &s.qdd),
                };
                [places.there(0, &s.q), places.there(0, &s.qd), third]
            })
            .collect();
        let arguments: &'static [[Vec<f64>; 3]] = arguments.leak();
        let mut run = move |index: usize, out: &mut [f64]| {
            let ([q, qd, third], base) = (&arguments[index], &states[index].dynibo);
            let done = match quantity {
                Quantity::ForwardDynamics => robot.forward_dynamics(base, q, qd, third, &[], out),
                _ => robot.inverse_dynamics(base, q, qd, third, &[], out),
            };
            done.unwrap_or_else(|error| panic!("{error}"));
        };
        let mut firsts = vec![0.0; nv * states.len()];
        firsts.chunks_mut(nv).enumerate().for_each(|(index, out)| run(index, out));
        let result = move |index: usize| {
            let (found, s) = (&firsts[index * nv..][..nv], &states[index]);
            // moment above force, or angular above linear, in world axes
            let [angular, mut linear] = [0, 3].map(|half| s.in_base([found[half], found[half + 1], found[half + 2]]));
            if quantity == Quantity::ForwardDynamics {
                linear = [0, 1, 2].map(|i| linear[i] - s.base.gravity[i]);
            }
            [&linear[..], &angular, &places.ours(&found[6..])].concat()
        };
        let mut room = vec![0.0; nv];
        let call = move |range: Range<usize>| range.for_each(|index| run(index, &mut room));
        Competitor { name, quantity, is_batch: false, call: Box::new(call), result: Box::new(result) }
    });
    competitors.into()
}
