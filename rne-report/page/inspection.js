// What the page knows of the arm: look-ups in the data that stand in it.

/** The operands of a tree: everything behind the operator except the mark of folding. */
function operands(tree) {
  return tree.slice(1).filter((part) => !isMark(part));
}

/** What folding made of the operation at the root of a tree; `kept` goes without saying. */
function markOf(tree) {
  const last = Array.isArray(tree) ? tree[tree.length - 1] : null;
  return isMark(last) ? last : { fold: "kept" };
}

function isMark(part) {
  return typeof part === "object" && part !== null && !Array.isArray(part);
}

/** The names in a tree, from left to right. */
function namesIn(tree) {
  if (typeof tree === "string") return [tree];
  return Array.isArray(tree) ? operands(tree).flatMap(namesIn) : [];
}

class Inspection {
  constructor(data) {
    Object.assign(this, data);
    this.dof = data.robot.joints.length;
    this.components = new Map();
    for (const component of data.table) this.components.set(component.name, component);
    for (const cell of data.cells) {
      for (const component of cell.components) {
        component.cell = cell;
        this.components.set(component.name, component);
      }
    }
    const folded = data.programs.folded;
    for (const component of this.components.values()) {
      const became = (component.became ||= { kind: "computed" });
      if (became.why !== undefined) became.why = data.reasons[became.why];
    }
    this.statements = new Map();
    for (const statement of [...folded.angles, ...folded.statements]) {
      this.statements.set(statement.name, statement);
      const owner = this.components.get(statement.component || statement.name);
      if (owner) (owner.statements ||= []).push(statement);
    }
    this.constants = new Map(folded.constants);
    this.usedBy = new Map();
    for (const component of this.components.values()) {
      for (const name of new Set(namesIn(component.general))) {
        if (!this.usedBy.has(name)) this.usedBy.set(name, []);
        this.usedBy.get(name).push(component.name);
      }
    }
  }

  /** Whether a torque depends on a cell, also by terms that vanish; the velocities of step 3 are for the reader. */
  isNeeded(cell) {
    if (!this.needed) {
      this.needed = new Set();
      const waiting = [...this.components.keys()].filter((name) => this.meaning(name)?.quantity === "torque");
      while (waiting.length) {
        const name = waiting.pop();
        if (this.needed.has(name)) continue;
        this.needed.add(name);
        const component = this.components.get(name);
        if (component) waiting.push(...namesIn(component.general));
      }
    }
    return cell.components.some(({ name }) => this.needed.has(name));
  }

  /** The statements that read a component or a part of it, by name, in the order of the code. */
  readersOf({ name, statements = [] }) {
    const own = new Set(statements.map((statement) => statement.name));
    if (!own.size) return [];
    return [...this.statements.values()]
      .filter((other) => !own.has(other.name) && namesIn(other.value).some((of) => own.has(of)))
      .map((other) => other.name);
  }

  /** What a name means: its quantity, joint and component, and what there is to know of the quantity. */
  meaning(name) {
    const found = Object.hasOwn(this.names, name) ? this.names[name] : null;
    if (!found) return null;
    const [quantity, joint, component = null, part = 0] = found;
    return { name, quantity, joint, component, part, of: this.quantities[quantity] };
  }

  /** What a name is, in words with its own numbers. */
  words({ of, joint }) {
    const numbers = { "h = i - 1": joint - 1, "i-1": joint - 1, i: joint };
    return of.meaning
      .replace(/^[^ ]*: /, "")
      .replace(/\b(link|joint|frame) (h = i - 1|i-1|i)\b/g, (_, what, which) => `${what} ${numbers[which]}`);
  }

  /** The component of the lecture that a name is, or is a part of. */
  owner(name) {
    const statement = this.statements.get(name);
    return this.components.get((statement && statement.component) || name) || null;
  }

  /** The name of a component of a quantity. */
  nameOf(quantity, joint, component = null) {
    if (!this.byMeaning) {
      this.byMeaning = new Map();
      for (const [name, of] of Object.entries(this.names)) {
        if (!of[3]) this.byMeaning.set(`${of[0]} ${of[1]} ${of[2] || ""}`, name);
      }
    }
    return this.byMeaning.get(`${quantity} ${joint} ${component || ""}`) || null;
  }

  unit(name) {
    const meaning = this.meaning(name);
    return meaning ? this.unitOf(meaning.quantity, meaning.joint) : "";
  }

  unitOf(quantity, joint) {
    const of = this.robot.joints[joint - 1];
    return this.quantities[quantity].units[of && of.kind === "prismatic" ? 1 : 0];
  }

  isPrismatic(joint) {
    return this.robot.joints[joint - 1].kind === "prismatic";
  }

  /** The cell of a joint and a step. */
  cell(joint, step) {
    return this.cells.find((cell) => cell.joint === joint && cell.step === step) || null;
  }

  /** In whose axes the components of a vector are: the number of a frame, or null. */
  axes(meaning) {
    if (!meaning.of.axes) return null;
    return meaning.of.axes === "parent" ? meaning.joint - 1 : meaning.joint;
  }

  /** What became of a name: a number that is 0, 1 or -1 for every state, or NaN. */
  constant(tree) {
    if (typeof tree === "number") return tree;
    if (typeof tree === "string") {
      const component = this.components.get(tree);
      return component && component.became.kind === "constant" ? component.became.value : NaN;
    }
    return tree[0] === "neg" ? -this.constant(tree[1]) : NaN;
  }
}
