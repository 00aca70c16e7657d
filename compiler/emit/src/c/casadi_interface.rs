//! A function in the form that CasADi expects, with the names of its derivatives, and its code.

use super::casadi::Writer;
use super::comment;

/// A function in the form that CasADi expects: the names and patterns of its inputs and outputs.
#[derive(Default)]
pub(super) struct Interface {
    pub(super) name: String,
    pub(super) inputs: Vec<(String, String)>,
    pub(super) outputs: Vec<(String, String)>,
    pub(super) body: String,
}

/// The code of a function, of its Jacobians and of its directional derivatives.
pub(super) struct Bodies {
    pub(super) value: String,
    pub(super) jacobian: String,
    pub(super) forward: String,
    pub(super) reverse: String,
}

impl Writer<'_> {
    /// Returns a function, its Jacobians with the patterns `blocks`, and its forward and reverse derivatives.
    pub(super) fn family(
        &mut self,
        name: &str,
        given: &[(String, String)],
        returned: &[(String, String)],
        blocks: &[String],
        bodies: Bodies,
    ) -> [Interface; 4] {
        let named = |start: &str, of: &[(String, String)]| -> Vec<(String, String)> {
            of.iter().map(|(name, pattern)| (format!("{start}{name}"), pattern.clone())).collect()
        };
        let value =
            Interface { name: name.to_owned(), inputs: given.to_vec(), outputs: returned.to_vec(), body: bodies.value };
        let jacobian = self.jacobian_of(&value, blocks, bodies.jacobian);
        let at = jacobian.inputs.clone();
        let forward = Interface {
            name: format!("fwd1_{name}"),
            inputs: [at.clone(), named("fwd_", given)].concat(),
            outputs: named("fwd_", returned),
            body: bodies.forward,
        };
        let reverse = Interface {
            name: format!("adj1_{name}"),
            inputs: [at, named("adj_", returned)].concat(),
            outputs: named("adj_", given),
            body: bodies.reverse,
        };
        [value, jacobian, forward, reverse]
    }

    /// Returns the Jacobians of a function; those of one output follow each other.
    pub(super) fn jacobian_of(&mut self, of: &Interface, blocks: &[String], body: String) -> Interface {
        let mut inputs = of.inputs.clone();
        for (name, pattern) in &of.outputs {
            let rows = self.rows(pattern);
            inputs.push((format!("out_{name}"), self.pattern([vec![rows, 1], vec![0, 0]].concat())));
        }
        let by = |output: &str| of.inputs.iter().map(|(input, _)| format!("jac_{output}_{input}")).collect::<Vec<_>>();
        let pairs = of.outputs.iter().flat_map(|(output, _)| by(output));
        let outputs = pairs.zip(blocks.iter().cloned()).collect();
        Interface { name: format!("jac_{}", of.name), inputs, outputs, body }
    }

    /// Returns the number of rows of the pattern with a name.
    fn rows(&self, name: &str) -> usize {
        let named = self.patterns.iter().enumerate().find(|(index, _)| self.pattern_name(*index) == name);
        named.and_then(|(_, pattern)| pattern.first().copied()).unwrap_or(0)
    }

    /// Returns the tables and the code of a function.
    pub(super) fn definition(&self, interface: &Interface) -> String {
        let Interface { name, inputs, outputs, body } = interface;
        let prefix = self.file.prefix;
        let all = || inputs.iter().chain(outputs);
        let list = |items: Vec<String>| crate::wrap::fill(&items.join(", "), crate::wrap::WIDTH, "    ", "    ");
        let names = list(all().map(|(name, _)| format!("\"{name}\"")).collect());
        let patterns = list(all().map(|(_, pattern)| pattern.clone()).collect());
        let listed = |of: &[(String, String)]| of.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>().join(", ");
        let about = comment("//", &format!("{name}: ({}) -> ({})", listed(inputs), listed(outputs)));
        format!(
            "\n{about}static const char *const {prefix}_names_{name}[] = {{\n{names}\n}};\n\
             static const casadi_int *const {prefix}_patterns_{name}[] = {{\n{patterns}\n}};\n\
             {prefix}_external({name}, {}, {})\n{{\n    (void)arg;\n    (void)iw;\n    (void)w;\n    (void)mem;\n\
             {body}    return 0;\n}}\n",
            inputs.len(),
            outputs.len()
        )
    }
}
