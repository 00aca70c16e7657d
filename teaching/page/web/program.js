// The interpreter. A statement is a tree of names, numbers and operators; + - * / are those of IEEE 754 here as they
// are in Rust, so the values are the same bits. Sine and cosine are the browser's and may differ in the last digit.

/** A tree as a function without arguments; `read(name)` gives a function that returns the value of a name. */
function compiled(tree, read) {
  if (typeof tree === "number") return () => tree;
  if (typeof tree === "string") return read(tree);
  const [a, b, c] = operands(tree).map((operand) => compiled(operand, read));
  switch (tree[0]) {
    case "+":
      return () => a() + b();
    case "-":
      return () => a() - b();
    case "*":
      return () => a() * b();
    case "/":
      return () => a() / b();
    case "neg":
      return () => -a();
    case "sin":
      return () => Math.sin(a());
    case "cos":
      return () => Math.cos(a());
    case "sign":
      return () => {
        const by = a();
        return by > 0 ? b() : by < 0 ? c() : 0;
      };
    default:
      throw new Error(`there is no operator ${tree[0]}`);
  }
}

/** Straight-line code: every statement uses only what stands before it. */
class Program {
  constructor(record) {
    this.slots = new Map();
    const values = [];
    const slot = (name, value = 0) => {
      this.slots.set(name, values.length);
      values.push(value);
      return values.length - 1;
    };
    const read = (name) => {
      const at = this.slots.get(name);
      if (at === undefined) throw new Error(`${name} is used before it is known`);
      return () => this.values[at];
    };
    const assign = (name, value) => {
      const at = slot(name);
      return () => {
        this.values[at] = value();
      };
    };
    this.arguments = record.arguments.map((name) => [name, slot(name)]);
    for (const [name, value] of record.constants) slot(name, value);
    this.steps = [];
    // a statement whose text is not shown is its name and its value
    const state = (of) => {
      const [name, value] = Array.isArray(of) ? of : [of.name, of.value];
      this.steps.push(assign(name, compiled(value, read)));
    };
    record.angles.forEach(state);
    for (const { sine, cosine, angle } of record.sines_and_cosines) {
      const of = compiled(angle, read);
      if (sine) this.steps.push(assign(sine, () => Math.sin(of())));
      if (cosine) this.steps.push(assign(cosine, () => Math.cos(of())));
    }
    record.statements.forEach(state);
    this.outputs = record.outputs.map(([, value]) => compiled(value, read));
    this.values = new Float64Array(values);
  }

  /** Evaluates the code; `given` has a number for each argument. Returns what the function returns. */
  run(given) {
    for (const [name, at] of this.arguments) this.values[at] = given[name] || 0;
    for (const step of this.steps) step();
    return this.outputs.map((output) => output());
  }

  has(name) {
    return this.slots.has(name);
  }

  value(name) {
    return this.values[this.slots.get(name)];
  }
}

/** The equations before folding, each evaluated when it is asked for. */
class Equations {
  constructor(components) {
    this.components = components;
    this.known = new Map();
    this.given = {};
    this.functions = new Map();
  }

  /** Another state: everything has to be computed again. */
  set(given) {
    this.given = given;
    this.known.clear();
  }

  /** The value of a name; NaN of one that is not known. */
  value(name) {
    const known = this.known.get(name);
    if (known !== undefined) return known;
    let value = NaN;
    if (Object.hasOwn(this.given, name)) {
      value = this.given[name];
    } else if (this.components.has(name)) {
      if (!this.functions.has(name)) this.functions.set(name, this.function(this.components.get(name).general));
      value = this.functions.get(name)();
    }
    this.known.set(name, value);
    return value;
  }

  function(tree) {
    return compiled(tree, (name) => () => this.value(name));
  }

  /** The value of a tree over these values. */
  evaluate(tree) {
    return this.function(tree)();
  }
}
