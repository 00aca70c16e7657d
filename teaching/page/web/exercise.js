// Exercises: a value is hidden, the student types it, and a wrong one is answered with the slip that gives it. Slips
// are made in the component's own tree, which is then evaluated: nothing is guessed from the number alone.

class Exercise {
  constructor(inspection, equations, axes = null) {
    this.inspection = inspection;
    this.axes = axes;
    this.equations = equations;
    this.isOn = false;
    this.solved = new Set();
    // what was answered last for each name, and how often, at the state
    this.answers = new Map();
  }

  /** Forgets answers of another state or of other axes: their values are others. */
  begin(key) {
    if (this.key === key) return;
    if (this.key !== undefined) {
      this.answers.clear();
      this.solved.clear();
    }
    this.key = key;
  }

  /** The score in words. */
  score() {
    const all = [...this.answers.values()];
    const tries = all.reduce((sum, { tries }) => sum + tries, 0);
    const right = all.filter(({ isRight }) => isRight).length;
    const first = all.filter(({ isRight, tries }) => isRight && tries === 1).length;
    return `score: ${right} of ${all.length} right, ${first} at the first attempt; attempts: ${tries}`;
  }

  /** Whether a value is not to be seen: one of the open cell that has not been found yet, or another that is the same. */
  hides(name, cell) {
    if (!this.isOn || !cell) return false;
    const owner = this.inspection.owner(name);
    const isAsked = (of) => !this.solved.has(of.name) && of.became.kind !== "constant";
    if (owner?.cell === cell) return isAsked(owner);
    return owner !== null && cell.components.some((of) => isAsked(of) && this.inspection.sameAs(of) === owner);
  }

  hasSolved(name) {
    return this.solved.has(name);
  }

  /** The value that is asked for, in the axes that are chosen. */
  right(name) {
    return this.axes?.isOther(name) ? this.axes.component(name) : this.equations.value(name);
  }

  /** What to say of an answer, which counts. */
  answer(name, text) {
    const before = this.answers.get(name);
    const said = this.judged(name, text);
    // the same once more is no other attempt
    const isNew = !before || (!before.isRight && before.text !== text.trim());
    if (said.text && Number.isFinite(numberOf(text)) && isNew)
      this.answers.set(name, { text: text.trim(), isRight: said.isRight, tries: (before?.tries || 0) + 1 });
    return said;
  }

  judged(name, text) {
    const typed = numberOf(text);
    if (!text.trim()) return { isRight: false, text: "" };
    if (!Number.isFinite(typed)) return { isRight: false, text: "This is no number: write it as 0.123 or 1.2e-3." };
    const right = this.right(name);
    if (isNear(typed, right)) {
      this.solved.add(name);
      return { isRight: true, text: "Right." };
    }
    const found = [...this.slips(name), ...this.otherAxes(name)].filter((slip) => isNear(typed, slip.value) && !isNear(slip.value, right));
    const words = [...new Set(found.map((slip) => slip.text))];
    if (words.length) return { isRight: false, text: `Not yet. ${words.slice(0, 2).join("; or ")}.` };
    if (isNear(typed, right, 0.03))
      return { isRight: false, text: "Close: more digits are needed, three that count." };
    return { isRight: false, text: "Not yet, and no usual slip gives this number: compute term by term." };
  }

  /** The first term of an equation with its value, or null where there is only one or the axes are others. */
  firstTerm(name) {
    if (this.axes?.isOther(name)) return null;
    const terms = [];
    collect(this.inspection.components.get(name).general, 1, terms);
    const values = terms.map(({ tree, sign }) => ({ tree, value: sign * this.equations.evaluate(tree) })).filter(({ value }) => value !== 0);
    return values.length < 2 ? null : `The first term is ${this.inspection.lettersOf(values[0].tree)}: it adds ${short(values[0].value)}.`;
  }

  /** Each usual slip in a component, in words, with the value that it gives. */
  slips(name) {
    const { general, cell } = this.inspection.components.get(name);
    const right = this.right(name);
    const all = [{ text: "The sign is the other one", value: -right }];
    // the equation's terms are in link axes
    if (this.axes?.isOther(name)) return all;
    const terms = [];
    collect(general, 1, terms);
    for (const { tree, sign } of terms) {
      const value = sign * this.equations.evaluate(tree);
      if (value === 0) continue;
      const term = this.inspection.lettersOf(tree);
      all.push({ text: `The term ${term} is left out`, value: right - value });
      all.push({ text: `The term ${term} has the other sign`, value: right - 2 * value });
      if (namesIn(tree).some((of) => of.startsWith("twice_")))
        all.push({ text: `The term ${term} has lost its factor 2`, value: right - value / 2 });
    }
    const joints = [...new Set(this.anglesOf(general, cell))].sort();
    for (const joint of joints) {
      const swapped = { [`s${joint}`]: `c${joint}`, [`c${joint}`]: `s${joint}` };
      all.push({
        text: `Sine stands for cosine of joint ${joint}, or cosine for sine`,
        value: this.evaluate(general, cell, (of) => (swapped[of] ? this.equations.value(swapped[of]) : undefined)),
      });
    }
    if (joints.length) {
      const inDegrees = (of) => {
        const found = /^([sc])(\d+)$/.exec(of);
        if (!found) return undefined;
        const angle = (this.angle(Number(found[2])) * Math.PI) / 180;
        return found[1] === "s" ? Math.sin(angle) : Math.cos(angle);
      };
      all.push({
        text: "The calculator takes degrees, and the angles are in radians",
        value: this.evaluate(general, cell, inDegrees),
      });
    }
    all.push({ text: "The number is in degrees", value: (right * 180) / Math.PI });
    all.push({
      text: "The rotation turns the other way: R instead of its transpose, or the transpose instead of R",
      value: this.evaluate(general, cell, (of) => {
        const found = /^(rot\d+_)([xyz])([xyz])$/.exec(of);
        return found ? this.equations.value(found[1] + found[3] + found[2]) : undefined;
      }),
    });
    const meaning = this.inspection.meaning(name);
    for (const axis of AXES) {
      const other = this.inspection.nameOf(meaning.quantity, meaning.joint, axis, meaning.carries);
      if (other && other !== name)
        all.push({ text: `This is the ${axis} component`, value: this.equations.value(other) });
    }
    return all;
  }

  /** The other components of a vector in the axes that are chosen, and the component itself in other axes. */
  otherAxes(name) {
    const meaning = this.inspection.meaning(name);
    if (!this.axes || !this.axes.has(meaning) || meaning.component.length > 1) return [];
    const others = this.axes.vectorOf(meaning).filter((of) => of && of !== name && this.axes.isOther(of));
    return [
      ...others.map((of) => ({
        text: `This is the ${this.inspection.meaning(of).component} component`,
        value: this.axes.component(of),
      })),
      ...KINDS_OF_AXES.filter((kind) => kind !== this.axes.kind).map((kind) => ({
        text: `This is in ${this.axes.words(this.inspection.axes(meaning), kind)}`,
        value: this.axes.component(name, kind),
      })),
    ];
  }

  /** The angle whose sine and cosine are meant, rad. */
  angle(joint) {
    const sine = this.inspection.components.get(`s${joint}`);
    return sine && Array.isArray(sine.general)
      ? this.equations.evaluate(sine.general[1])
      : this.equations.value(`q${joint}`);
  }

  /** A tree over other values; equations of the same cell are evaluated anew with these. */
  evaluate(tree, cell, other) {
    const value = (name) => () => {
      const replaced = other(name);
      if (replaced !== undefined) return replaced;
      const component = this.inspection.components.get(name);
      return component && component.cell === cell ? compiled(component.general, value)() : this.equations.value(name);
    };
    return compiled(tree, value)();
  }

  /** The joints whose sines and cosines stand in a tree, or in what it uses of its cell. */
  anglesOf(tree, cell) {
    return namesIn(tree).flatMap((name) => {
      const found = /^[sc](\d+)$/.exec(name);
      if (found) return [found[1]];
      const component = this.inspection.components.get(name);
      return component && component.cell === cell ? this.anglesOf(component.general, cell) : [];
    });
  }
}

/** The terms of sums inside sums, with their signs. */
function collect(tree, sign, terms) {
  if (Array.isArray(tree) && (tree[0] === "+" || tree[0] === "-")) {
    const [a, b] = operands(tree);
    collect(a, sign, terms);
    collect(b, tree[0] === "+" ? sign : -sign, terms);
  } else if (Array.isArray(tree) && tree[0] === "neg") {
    collect(tree[1], -sign, terms);
  } else {
    terms.push({ tree, sign });
  }
}

/** Whether two numbers agree as well as an answer of three digits can. */
function isNear(a, b, relative = 0.005) {
  return Math.abs(a - b) <= Math.max(relative * Math.abs(b), 5e-5);
}
