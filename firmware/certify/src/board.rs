//! Makes a program in C that calls a function on the boards that QEMU emulates, and reads its output.

/// The C file that starts the processor, reads the timer and prints; it includes [`HEADER`] as `board.h`.
pub const SOURCE: &str = include_str!("../board/board.c");
/// The header of [`SOURCE`].
pub const HEADER: &str = include_str!("../board/board.h");
/// The linker script.
pub const LINKER_SCRIPT: &str = include_str!("../board/board.ld");
/// Options of the C compiler: strict warnings, and rounding of each sum and product as written.
pub const OPTIONS: [&str; 10] = [
    "-std=c99",
    "-pedantic",
    "-Wall",
    "-Wextra",
    "-Wconversion",
    "-Wdouble-promotion",
    "-Wshadow",
    "-Werror",
    "-O2",
    "-ffp-contract=off",
];
/// The states at which [`SOURCE`] calls the functions.
pub const STATES: u32 = 32;
/// The largest number of joints of `struct state`.
pub const MOST_JOINTS: usize = 32;
/// Ticks of the timer (25 MHz) during an instruction, which takes 1024 ns in QEMU.
const TICKS: f64 = 25.6;

/// Returns positions, velocities and accelerations between -3 and 3, equal to those of `state_of` in C.
#[must_use]
pub fn state(number: u32, dof: usize) -> [Vec<f32>; 3] {
    // xorshift generator: G. Marsaglia, Journal of Statistical Software 8 (2003)
    let mut x = number.wrapping_mul(747_796_405).wrapping_add(2_891_336_453) | 1;
    let mut next = || {
        x ^= x << 13;
        x ^= x >> 17;
        x ^= x << 5;
        #[allow(clippy::cast_precision_loss)] // 24 bits fit
        let number = (x >> 8) as f32;
        number * (6.0 / 16_777_216.0) - 3.0
    };
    [(); 3].map(|()| (0..dof).map(|_| next()).collect())
}

/// A call of a C function that writes its numbers to its last argument, or returns its only number.
#[derive(Clone, Debug)]
pub struct Call {
    /// The name of the function.
    pub function: String,
    /// The types and the C expressions of the arguments, without the result; `s` points to the `struct state`.
    pub arguments: Vec<(String, String)>,
    /// How many numbers the function writes.
    pub length: usize,
    /// Lines of C before the call; `out` is the result.
    pub before: Vec<String>,
    /// The type of an element of the result, `float` or a struct of numbers.
    pub element: String,
    /// The lengths of the dimensions of the result; empty if it is one struct or one number.
    pub lengths: Vec<usize>,
}

impl Call {
    /// Makes the call of a function that takes no arguments and writes `length` numbers.
    #[must_use]
    pub fn new(function: String, length: usize) -> Self {
        let (arguments, before) = (Vec::new(), Vec::new());
        Self { function, arguments, length, before, element: "float".to_owned(), lengths: vec![length] }
    }

    /// Makes the call of a function that takes the given members of the state.
    #[must_use]
    pub fn of_arrays(function: &str, arrays: &[&str], length: usize) -> Self {
        let argument = |array: &&str| ("const float *".to_owned(), format!("s->{array}"));
        Self { arguments: arrays.iter().map(argument).collect(), ..Self::new(function.to_owned(), length) }
    }
}

/// Returns the program that calls a C function at [`STATES`] states of an arm with `dof` joints and prints its results.
/// It also prints the time of one call, and that of an empty function.
#[must_use]
pub fn cases(header: &str, dof: usize, call: &Call) -> String {
    let Call { function, arguments, length, before, element, lengths } = call;
    let brackets = |lengths: &[usize]| lengths.iter().map(|length| format!("[{length}]")).collect::<Vec<_>>().concat();
    let declared = format!("{element} out{}", brackets(lengths));
    let pointer = |name: &str| match lengths.get(1..) {
        Some(rows @ [_, ..]) => format!("{element} (*{name}){}", brackets(rows)),
        _ => format!("{element} *{name}"),
    };
    let place = if lengths.is_empty() { "&out" } else { "out" };
    let is_returned = lengths.is_empty() && element == "float";
    let list = |each: &dyn Fn(usize, &(String, String)) -> String| -> String {
        arguments.iter().enumerate().map(|(index, argument)| each(index, argument)).collect()
    };
    let types = list(&|_, (kind, _)| format!("{kind}, "));
    // in C, the name of a pointer to arrays is within the parentheses
    let parameters = list(&|index, (kind, _)| match kind.split_once("(*)") {
        Some((element, lengths)) => format!("{element}(*a{index}){lengths}, "),
        None => format!("{kind} a{index}, "),
    });
    let names = list(&|index, _| format!("a{index}, "));
    let voids = list(&|index, _| format!("    (void)a{index};\n"));
    let values = list(&|_, (_, value)| format!("{value}, "));
    let before: String = before.iter().flat_map(|line| ["    ", line, "\n"]).collect();
    let out = pointer("out");
    // arguments of a function, with `out` if the result is not returned
    let of_function = |list: &str, out: &str| {
        if is_returned { list.trim_end_matches(", ").to_owned() } else { format!("{list}{out}") }
    };
    let (returned, into, into_pointer, end) = if is_returned {
        // returns any value of an FPU register, without an instruction that loads it
        ("float", "out = ", "*out = ", "float out;\n    __asm__(\"\" : \"=t\"(out));\n    return out;")
    } else {
        ("void", "", "", "(void)out;")
    };
    let (types, empty) = (of_function(&types, &pointer("")), of_function(&parameters, &out));
    let (call, call_measured) = (of_function(&values, place), of_function(&names, "out"));
    format!(
        "#include \"board.h\"\n#include \"{header}\"\n\n\
         typedef {returned} certified({types});\n\n\
         __attribute__((noinline, noipa)) static {returned} nothing({empty})\n{{\n{voids}    {end}\n}}\n\n\
         __attribute__((noinline, noipa)) static void measure(\n    \
         const char *what, certified *function, {parameters}{out})\n{{\n    \
         const uint32_t start = timer();\n    {into_pointer}function({call_measured});\n    \
         const uint32_t end = timer();\n    print_ticks(what, start, end);\n}}\n\n\
         void run_cases(uint32_t number)\n{{\n    const struct state state = state_of(number, {dof}u);\n    \
         const struct state *s = &state;\n    {declared};\n\
         {before}    {into}{function}({call});\n    \
         print_results(\"results\", number, (const float *){place}, {length}u);\n    if (number == 0u) {{\n        \
         measure(\"function\", {function}, {values}{place});\n        \
         measure(\"nothing\", nothing, {values}{place});\n    }}\n}}\n"
    )
}

/// The results that the program prints.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Printed {
    /// Number of instructions of the call at the first state.
    pub instructions: u64,
    /// The bits of the results, for each state.
    pub results: Vec<Vec<u32>>,
}

impl Printed {
    /// Reads the output of the program; `None` if it does not have the form that the program of [`cases`] prints.
    #[must_use]
    pub fn read(text: &str) -> Option<Self> {
        let mut printed = Self::default();
        let (mut function, mut nothing) = (None, None);
        for line in text.lines() {
            match line.split_whitespace().collect::<Vec<_>>().as_slice() {
                ["results", _, bits @ ..] => {
                    let bits = bits.iter().map(|word| u32::from_str_radix(word, 16).ok());
                    printed.results.push(bits.collect::<Option<_>>()?);
                }
                ["ticks", "function", ticks] => function = Some(ticks.parse::<f64>().ok()?),
                ["ticks", "nothing", ticks] => nothing = Some(ticks.parse::<f64>().ok()?),
                _ => return None,
            }
        }
        // an empty function has one instruction: bx lr
        let instructions = (function? - nothing?) / TICKS + 1.0;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a timer of 24 bits
        let rounded = instructions.round().max(0.0) as u64;
        printed.instructions = rounded;
        Some(printed)
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp)] // the same bits
mod tests {
    use super::{Printed, state};

    #[test]
    fn states_are_those_of_the_board() {
        // calculated by hand: x = 2891336453 | 1 for the first state
        let [q, ..] = state(0, 1);
        assert!(q[0].abs() <= 3.0 && state(0, 2)[0][0] == q[0] && state(1, 1)[0] != q);
    }

    #[test]
    fn a_log_is_read() {
        let text = "results 0 3f800000 40000000\nticks function 2560\nticks nothing 128\nresults 1 00000000 80000000\n";
        let printed = Printed::read(text).expect("a log");
        assert_eq!(printed.instructions, 96);
        assert_eq!(printed.results, [[0x3f80_0000, 0x4000_0000], [0, 0x8000_0000]]);
        assert_eq!(Printed::read("fault\n"), None);
        assert_eq!(Printed::read("results 0 3f800000\n"), None);
    }
}
