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
    /** The joints that follow no other, from 0, in the order of arrays of `rne`. */
    this.coordinates = data.robot.joints.flatMap((joint, index) => (joint.follows ? [] : [index]));
    // the angle is its constant part and q: two letters; of a robot whose axes are turned by quarters only it has no name
    const { theta, angle } = data.quantities;
    if (theta) theta.letter = "θ\u0304";
    if (angle) angle.meaning = "constant part θ\u0304 of the table + q";
    /** Where wrenches act: the tips of the list of the file, or the one tip. */
    this.tips = this.floating?.tips || [null];
    if (this.floating) this.nameBase();
    this.components = new Map();
    for (const component of data.table) this.components.set(component.name, component);
    for (const cell of data.cells) {
      for (const component of cell.components) {
        component.cell = cell;
        this.components.set(component.name, component);
      }
    }
    const folded = data.programs.folded;
    this.reasons = data.reasons.map((why) => this.inLetters(why).replace(/ = (?=[-\dπ])/g, "\u00a0=\u00a0"));
    for (const component of this.components.values()) {
      const became = (component.became ||= { kind: "computed" });
      if (became.why !== undefined) became.why = this.reasons[became.why];
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

  /** Names of a floating base: its argument a is no c̈, and its F and N are other vectors than f0 and n0. */
  nameBase() {
    const { acceleration, base_force, base_moment } = this.quantities;
    const meaning = "a: acceleration of the origin of frame 0";
    this.quantities.frame_acceleration = { ...acceleration, letter: "a", meaning, drawn: "joint" };
    for (const names of [this.names, this.programs.reduced?.names || {}])
      for (const axis of AXES) names[`ddc0_${axis}`] = ["frame_acceleration", 0, axis];
    Object.assign(base_force, { letter: "F", drawn: "joint" });
    Object.assign(base_moment, { letter: "N", drawn: "joint" });
  }

  /** Gives the joints that follow others what they have in a state of those. */
  follow(state) {
    this.robot.joints.forEach((joint, index) => {
      if (!joint.follows) return;
      for (const of of OF) {
        const sum = joint.follows.ratios.reduce((sum, [followed, ratio]) => sum + ratio * state[of][followed - 1], 0);
        state[of][index] = of === "q" ? sum + joint.follows.offset : sum;
      }
    });
    return state;
  }

  /**
   * The arguments of a state by their names in the code: q1, qd1, qdd1; the motion of a floating base with gravity in
   * its axes; and wrenches at the tips. Followers have none.
   */
  argumentsOf(state, wrench = null) {
    const given = {};
    for (const of of OF) {
      for (const index of this.coordinates) given[`${of}${index + 1}`] = state[of][index];
    }
    if (state.base) {
      const { rpy, omega, omega_dot, acceleration } = state.base;
      const turned = ofAngles(rpy);
      const gravity = AXES.map((_, at) => dot(column(turned, at), this.robot.gravity));
      const ofBase = { w0: omega, dw0: omega_dot, ddc0: acceleration, g0: gravity };
      for (const [name, vector] of Object.entries(ofBase)) AXES.forEach((axis, at) => (given[`${name}_${axis}`] = vector[at]));
      for (const of of wrench ? ["f", "n"] : [])
        wrench[of].forEach((value, at) => (given[`${of}t${1 + Math.floor(at / 3)}_${AXES[at % 3]}`] = value));
    } else if (wrench) {
      const ends = `${this.dof}_${this.dof + 1}`;
      ["x", "y", "z"].forEach((axis, index) => {
        given[`f${ends}_${axis}`] = wrench.f[index];
        given[`n${ends}_${axis}`] = wrench.n[index];
      });
    }
    return given;
  }

  /** Forces and moments at the tips when nothing touches them: three numbers for each tip. */
  freeTips() {
    const zeros = () => this.tips.flatMap(() => [0, 0, 0]);
    return { f: zeros(), n: zeros() };
  }

  /** A number for each joint, from one for each coordinate; a follower has `rest`. */
  ofJoints(ofCoordinates, rest = 0) {
    const all = this.robot.joints.map(() => rest);
    this.coordinates.forEach((joint, index) => (all[joint] = ofCoordinates[index]));
    return all;
  }

  /** Whether a torque or the wrench on the base depends on a cell, also by terms that vanish; the velocities of step 3 are for the reader. */
  isNeeded(cell) {
    if (!this.needed) {
      this.needed = new Set();
      const isResult = (name) => ["torque", "base_force", "base_moment"].includes(this.meaning(name)?.quantity);
      const waiting = [...this.components.keys()].filter(isResult);
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

  /** The link that carries a joint or the tip, n + 1, by its joint; 0 is the base. */
  parentOf(joint) {
    return joint > this.dof ? this.robot.tip : joint > 0 ? this.robot.joints[joint - 1].parent : 0;
  }

  /** The joints on a link, and n + 1 where it has the tip. */
  carriedBy(link) {
    return Array.from({ length: this.dof + 1 }, (_, index) => index + 1).filter((joint) => this.parentOf(joint) === link);
  }

  /** The joints from the base to a link or the tip. */
  pathTo(link) {
    return link === 0 ? [] : [...this.pathTo(this.parentOf(link)), link];
  }

  /** The runs of joints of which each is the only one on the link of the one before. */
  branches() {
    const runs = [];
    for (let joint = 1; joint <= this.dof; joint++) {
      const parent = this.parentOf(joint);
      const isAlone = this.carriedBy(parent).filter((other) => other <= this.dof).length === 1;
      if (parent === joint - 1 && isAlone && runs.length) runs.at(-1).push(joint);
      else runs.push([joint]);
    }
    return runs;
  }

  /** Whether some link carries no joint, or several, before the last one. */
  isTree() {
    return this.branches().length > 1;
  }

  /** Where a lever or what is handed on leads: a joint, or n + 1, the tip. */
  endOf({ joint, carries = 0 }) {
    return carries || this.carriedBy(joint)[0] || this.dof + 1;
  }

  /** The number of a name, in text: 2, or 1,2 for what link 1 exerts on link 2, whose own f2 is m c̈. */
  indexText(meaning) {
    const { quantity, joint, carries } = meaning;
    if (quantity.startsWith("child_")) return `${joint},${this.endOf(meaning)}`;
    if (quantity.startsWith("joint_force") || quantity.startsWith("joint_moment")) return `${this.parentOf(joint)},${joint}`;
    return carries ? `${joint},${carries}` : String(joint);
  }

  /** A tree in the letters of the lecture: ω₂z · (ω × d)₂y. */
  lettersOf(tree) {
    return minus(this.inLetters(codeOf(tree)).replaceAll("*", "·"));
  }

  /** Words with the names of the code in them, in the letters of the lecture. */
  inLetters(text) {
    const low = (index) => index.replace(/\d/g, (digit) => "₀₁₂₃₄₅₆₇₈₉"[digit]);
    const letters = (name) => {
      const meaning = this.meaning(name);
      // the angles of the table
      if (!meaning) return name.replace(/^(alpha|theta)(\d+)$/, (_, word, index) => (word === "alpha" ? "α" : "θ") + low(index));
      return `${meaning.of.letter}${low(this.indexText(meaning))}${meaning.component || ""}`;
    };
    return text.replace(/\b[A-Za-z_]\w*/g, letters);
  }

  /** What a name means: its quantity, joint and component, and what there is to know of the quantity. */
  meaning(name) {
    const found = Object.hasOwn(this.names, name) ? this.names[name] : null;
    if (!found) return null;
    const [quantity, joint, component = null, part = 0, carries = 0] = found;
    return { name, quantity, joint, component, part, carries, of: this.quantities[quantity] };
  }

  /** What a name is, in words with its own numbers. */
  words({ of, joint }) {
    const parent = this.parentOf(joint);
    const numbers = { "h = i - 1": parent, "i-1": parent, i: joint };
    return of.meaning
      .replace(/^[^ ]*: /, "")
      .replace(/\b(link|joint|frame) (h = i - 1|i-1\b|i\b)/g, (_, what, which) => `${what} ${numbers[which]}`);
  }

  /** The component of the lecture that a name is, or is a part of. */
  owner(name) {
    const statement = this.statements.get(name);
    return this.components.get((statement && statement.component) || name) || null;
  }

  /** The component whose value, or its negative, is that of another as it stands. */
  sameAs({ became, statements = [] }) {
    const tree = became.kind === "same" ? became.name : statements.length === 1 ? statements[0].value : null;
    const name = Array.isArray(tree) && tree[0] === "neg" ? tree[1] : tree;
    return typeof name === "string" ? this.owner(name.replace(/^-/, "")) : null;
  }

  /** The name of a component of a quantity; `carries` tells levers of one link apart. */
  nameOf(quantity, joint, component = null, carries = 0) {
    const key = (of) => [of[0], of[1], of[2] || "", of[4] || 0].join(" ");
    if (!this.byMeaning) {
      this.byMeaning = new Map();
      for (const [name, of] of Object.entries(this.names)) {
        if (!of[3]) this.byMeaning.set(key(of), name);
      }
    }
    return this.byMeaning.get(key([quantity, joint, component, 0, carries])) || null;
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
    return meaning.of.axes === "parent" ? this.parentOf(meaning.joint) : meaning.joint;
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
