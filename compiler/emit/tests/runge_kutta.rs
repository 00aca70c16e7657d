//! The Runge-Kutta step in C and its derivatives give the bits of the traits of the runtime, over the same programs.

use std::array::from_fn;
use std::fmt::Write;
use std::fs;
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::process::Command;

use rne_codegen::{Arguments, Compiler, Form, Function, Interpreter, Program, Real};
use rne_emit::{Additions, Precision, Prefix, c_code_with};
use rne_model::Robot;
use rne_runtime::{
    AccelerationDerivatives, ForwardDynamics, ForwardDynamicsDerivatives, NextState, RungeKuttaStep,
    RungeKuttaStepDerivatives, Scalar,
};

/// A scalar of the runtime as a number of the interpreter.
#[derive(Clone, Copy)]
struct Number<T>(T);

impl<T: Scalar> Neg for Number<T> {
    type Output = Self;

    fn neg(self) -> Self {
        Self(-self.0)
    }
}

macro_rules! operators {
    ($($operator:ident $method:ident)*) => {$(
        impl<T: Scalar> $operator for Number<T> {
            type Output = Self;

            fn $method(self, other: Self) -> Self {
                Self($operator::$method(self.0, other.0))
            }
        }
    )*};
}

operators!(Add add Sub sub Mul mul Div div);

impl<T: Scalar> Real for Number<T> {
    fn by_sign(self, positive: Self, negative: Self) -> Self {
        Self(self.0.by_sign(positive.0, negative.0))
    }
}

/// The programs of the accelerations and of their derivatives.
struct Code([Interpreter; 2]);

impl Code {
    fn run<T: Scalar>(&self, place: usize, [q, qd, tau]: [&[T]; 3]) -> Vec<T> {
        let [q, qd, tau] = [q, qd, tau].map(|x| x.iter().copied().map(Number).collect::<Vec<_>>());
        let arguments = Arguments { tau: &tau, ..Arguments::of_joints(&q, &qd, &tau, Number(T::zero())) };
        let sin_cos = |Number(angle): Number<T>| {
            let (sine, cosine) = Scalar::sin_cos(angle);
            (Number(sine), Number(cosine))
        };
        let found = self.0[place].run(&arguments, |x| Number(T::from_f64(x)), sin_cos).expect("one per joint");
        found.into_iter().map(|Number(x)| x).collect()
    }
}

impl<const DOF: usize> ForwardDynamics<DOF> for Code {
    fn forward_dynamics<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF], tau: &[T; DOF]) -> [T; DOF] {
        self.run(0, [q, qd, tau]).try_into().unwrap_or_else(|_| panic!("one per joint"))
    }
}

impl<const DOF: usize> ForwardDynamicsDerivatives<DOF> for Code {
    fn forward_dynamics_derivatives<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        tau: &[T; DOF],
    ) -> AccelerationDerivatives<DOF, T> {
        let found = self.run(1, [q, qd, tau]);
        let block = |kind: usize| from_fn(|i| from_fn(|j| found[(kind * DOF + i) * DOF + j]));
        AccelerationDerivatives { dq: block(0), dqd: block(1), dtau: block(2) }
    }
}

/// The hexadecimal digits of what the traits give, a number in a line.
fn expected<const DOF: usize>(code: &Code, states: &[[[f64; DOF]; 3]], step: f64) -> String {
    let mut text = String::new();
    for [q, qd, tau] in states {
        let NextState { q: positions, qd: rates } = code.runge_kutta_step(q, qd, tau, step);
        let by = code.runge_kutta_step_derivatives(q, qd, tau, step);
        let blocks = [by.q.dq, by.q.dqd, by.q.dtau, by.qd.dq, by.qd.dqd, by.qd.dtau];
        for number in positions.iter().chain(&rates).chain(blocks.iter().flatten().flatten()) {
            let _ = writeln!(text, "{:016x}", number.to_bits());
        }
    }
    text
}

/// What the code in C prints of them.
fn printed<const DOF: usize>(robot: &Robot, programs: &[Program], states: &[[[f64; DOF]; 3]], step: f64) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let prefix: Prefix = "arm".parse().expect("a prefix");
    let additions = Additions { runge_kutta: true, ..Additions::default() };
    let code = c_code_with(robot, programs, Precision::Double, &prefix, &additions).expect("code");
    let list = |numbers: &[f64]| numbers.iter().map(|x| format!("{x:?}")).collect::<Vec<_>>().join(", ");
    let rows: Vec<String> = states.iter().map(|state| format!("{{{}}}", list(state.as_flattened()))).collect();
    let main = format!(
        "#include <inttypes.h>\n#include <stdio.h>\n#include <string.h>\n\n\
         static void print(const double *x, int count)\n{{\n    for (int i = 0; i < count; i++) {{\n        \
         uint64_t bits;\n        memcpy(&bits, &x[i], sizeof bits);\n        \
         printf(\"%016\" PRIx64 \"\\n\", bits);\n    }}\n}}\n\n\
         int main(void)\n{{\n    static const double states[][{all}] = {{{rows}}};\n    \
         for (int i = 0; i < {count}; i++) {{\n        const double *q = states[i];\n        \
         arm_next_state next;\n        arm_next_state_derivatives by;\n        \
         arm_runge_kutta_step(q, q + {DOF}, q + 2 * {DOF}, {step:?}, &next);\n        \
         arm_runge_kutta_step_derivatives(q, q + {DOF}, q + 2 * {DOF}, {step:?}, &by);\n        \
         print((const double *)&next, 2 * {DOF});\n        \
         print((const double *)&by, 6 * {DOF} * {DOF});\n    }}\n    return 0;\n}}\n",
        all = 3 * DOF,
        count = states.len(),
        rows = rows.join(", "),
    );
    let place = |name: &str| folder.path().join(name);
    fs::write(place("main.c"), format!("{}\n{main}", code.one_file())).expect("written");
    let flags = ["-std=c99", "-O1", "-Wall", "-Wextra", "-Wconversion", "-pedantic", "-Werror", "-ffp-contract=off"];
    let compiled = Command::new("cc").current_dir(folder.path()).args(flags).args(["main.c", "-o", "main"]).output();
    let compiled = compiled.expect("a compiler");
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    let output = Command::new(place("main")).output().expect("it runs");
    String::from_utf8(output.stdout).expect("text")
}

fn compare<const DOF: usize>(name: &str) {
    let robot = Robot::from_yaml(rne_robots::find(name).expect("a robot").yaml).expect("a robot");
    let mut random = fastrand::Rng::with_seed(4);
    let states: Vec<[[f64; DOF]; 3]> = (0..4).map(|_| from_fn(|_| from_fn(|_| 2.0 * random.f64() - 1.0))).collect();
    for form in Form::ALL {
        let compiler = Compiler::new(&robot);
        let programs = [Function::ForwardDynamics, Function::ForwardDynamicsDerivatives]
            .map(|function| compiler.compile(function, form).expect("a program"));
        let code = Code(programs.each_ref().map(Interpreter::new));
        assert_eq!(printed(&robot, &programs, &states, 0.03), expected(&code, &states, 0.03), "{name}, {form}");
    }
}

#[test]
fn the_code_in_c_has_the_bits_of_the_traits() {
    if Command::new("cc").arg("--version").output().is_err() {
        println!("not compiled: there is no cc");
        return;
    }
    compare::<2>("planar2");
    compare::<6>("puma560");
}

/// Without the derivatives of the accelerations there is the step alone, and no function that nothing calls.
#[test]
fn the_step_alone_needs_the_accelerations_alone() {
    let robot = Robot::from_yaml(rne_robots::find("planar2").expect("a robot").yaml).expect("a robot");
    let program = Compiler::new(&robot).compile(Function::ForwardDynamics, Form::Reduced).expect("a program");
    let prefix: Prefix = "arm".parse().expect("a prefix");
    let additions = Additions { runge_kutta: true, ..Additions::default() };
    let code = c_code_with(&robot, &[program], Precision::Single, &prefix, &additions).expect("code").one_file();
    assert!(code.contains("void arm_runge_kutta_step("), "{code}");
    for absent in ["runge_kutta_step_derivatives", "arm_chain", "next_state_derivatives"] {
        assert!(!code.contains(absent), "{absent}");
    }
}
