// What a cell of the seven steps opens: each component as equation, with numbers, what is gone, and code.

class Cards {
  constructor(page) {
    this.page = page;
  }

  cellContent(cell) {
    const head = element(
      "header",
      { class: "cell-head" },
      element("h3", {}, `${cell.joint === 0 ? "Base" : `Joint ${cell.joint}`}, step ${cell.step}: ${cell.title}`),
      element("p", { class: "hint" }, this.counts(cell)),
      this.axesHint(cell),
      cell.step === 7
        ? element("p", { class: "hint" }, "Gravity comes in by the terms −m g of step 6; point at τ to see its part.")
        : null,
    );
    const groups = new Map();
    for (const component of cell.components) {
      const { quantity } = this.page.inspection.meaning(component.name);
      if (!groups.has(quantity)) groups.set(quantity, []);
      groups.get(quantity).push(component);
    }
    const formulas = new Map(cell.formulas.map(({ quantity, text }) => [quantity, text]));
    // what the step is for comes first, what is needed on the way behind it
    const order = [...groups.keys()].sort((a, b) => Number(formulas.has(b)) - Number(formulas.has(a)));
    let isOnTheWay = false;
    const sections = order.flatMap((quantity) => {
      const of = this.page.inspection.quantities[quantity];
      const formula = formulas.get(quantity);
      // what is a number in every state comes last
      const isNumber = ({ became }) => Number(became.kind === "constant");
      const cards = groups.get(quantity).sort((a, b) => isNumber(a) - isNumber(b)).map((component) => this.card(component));
      const isAxisNamed = / e($| )/.test(formula || "");
      const heading = element(
        "h4",
        {},
        formula ? this.page.set.formula(formula) : letterIn(of.letter),
        element(
          "span",
          { class: "group-meaning" },
          [this.meaning(of, cell, formula), isAxisNamed ? "e = (0, 0, 1), the joint axis" : "", formula ? this.point(groups.get(quantity)) : ""]
            .filter(Boolean)
            .join("; "),
        ),
      );
      const before = !formula && !isOnTheWay ? [element("p", { class: "on-the-way" }, "On the way")] : [];
      isOnTheWay ||= !formula;
      if (quantity === "rotation") {
        return [...before, element("details", { class: "group" }, element("summary", {}, heading), ...cards)];
      }
      return [...before, element("section", { class: "group" }, heading, ...cards)];
    });
    return [head, ...sections];
  }

  /** What a quantity is, in words: nothing that the title of the cell, the formula or the letter before the words has said. */
  meaning(of, { title, joint }, formula) {
    const words = this.page.inspection.words({ of, joint });
    if (formula) return words === title || words.includes(" = ") ? "" : words;
    const bare = (text) => text.replace(/[ ()]/g, "");
    return bare(words) === bare(of.letter) ? "" : words.replace(`${of.letter} `, "");
  }

  /** The joint's point, whose letter is none of the lecture, where equations have it in the place of a bracket. */
  point(components) {
    const { inspection } = this.page;
    const all = components.flatMap(({ general }) => namesIn(general)).map((name) => inspection.meaning(name));
    const found = all.find((meaning) => meaning?.quantity.startsWith("joint_point"));
    return found ? `${inspection.inLetters(found.name).slice(0, -1)} is the bracket: ${inspection.words(found)}` : "";
  }

  /** In whose axes the values of a cell stand, where these are not those of its equations. */
  axesHint({ joint, components }) {
    const { axes } = this.page;
    if (!components.some(({ name }) => axes.isOther(name))) return null;
    return element(
      "p",
      { class: "hint", "data-axes-hint": "" },
      `Values of vectors of link ${joint}, at the right, are in ${axes.words(joint)}; ` +
        `equations and code have them in ${axes.words(joint, "link")}.`,
    );
  }

  /** How many operations a cell has, and its step of all joints. */
  counts({ step, before, after }) {
    const all = (which) =>
      this.page.inspection.cells
        .filter((cell) => cell.step === step)
        .reduce((sum, cell) => [sum[0] + cell[which].products, sum[1] + cell[which].sums], [0, 0]);
    const [whole, left] = [all("before"), all("after")];
    if (whole[0] + whole[1] === 0) return "no operations";
    if (this.page.form === "unfolded")
      return `${before.products} products, ${before.sums} sums; step ${step} of all joints: ${whole[0]}, ${whole[1]}`;
    return (
      `${after.products} of ${before.products} products left, ${after.sums} of ${before.sums} sums; ` +
      `step ${step} of all joints: ${left[0]} of ${whole[0]} products (${whole[0] - left[0]} saved), ` +
      `${left[1]} of ${whole[1]} sums`
    );
  }

  /** A component: general, with this robot's numbers, what is gone and why, code; and its value. */
  card(component) {
    const { name, general, became, statements = [] } = component;
    const isUnfolded = this.page.form === "unfolded";
    const isStruck = !isUnfolded;
    const symbol = (of) => this.page.set.symbol(of);
    const equation = (leaf) => this.page.set.equation(this.page.set.symbol(name), general, leaf, isStruck);
    const value = element("output", { class: "live value", "data-name": name });
    const unitOf = unitText(this.page.inspection.unit(name));
    this.page.live.push(() => {
      const isHidden = this.page.hides(name);
      value.textContent = isHidden ? `? ${unitOf}` : withUnit(this.page.told(name), unitOf);
      value.title = isHidden ? "" : full(this.page.told(name));
    });
    const { axes } = this.page;
    const inOther = axes.isOther(name) ? element("span", { class: "in-axes" }, `${axes.kind} axes`) : null;
    const lines = [["general", "in general", equation(symbol)]];
    if (namesIn(general).some((of) => !Number.isNaN(this.page.inspection.constant(of)) || this.alias(of) !== of)) {
      lines.push(["here", "this robot", equation((of) => this.here(of))]);
    }
    const gone = isUnfolded ? [] : this.page.set.gone(general);
    if (gone.length) {
      const byReason = new Map();
      for (const one of gone) {
        const why = one.why || "it vanishes";
        if (!byReason.has(why)) byReason.set(why, []);
        byReason.get(why).push(one);
      }
      const items = [...byReason].map(([why, all]) =>
        element(
          "li",
          {},
          ...all.flatMap((one, at) => [at ? ", " : null, this.goneTerm(one)]),
          element("span", { class: "why" }, why),
        ),
      );
      lines.push(["gone", "gone, why", element("ul", {}, ...items)]);
    }
    lines.push(["code", "code", this.codeOf(component, isUnfolded)]);
    const readers = isUnfolded ? [] : this.page.inspection.readersOf(component);
    if (readers.length) lines.push(["users", "used by", element("span", {}, ...this.named(readers))]);
    const rows = lines.map(([kind, label, content]) => [
      element("dt", { class: kind }, label),
      element("dd", { class: kind }, content),
    ]);
    const answer = this.page.exercise.isOn && became.kind !== "constant" ? this.question(name, unitOf) : null;
    const head = element(
      "header",
      {},
      math("math", { "data-name": name }, this.page.set.symbol(name, false)),
      element("code", { class: "own-name pick", "data-name": name, tabindex: "-1" }, name),
      value,
      inOther,
      answer,
    );
    return element(
      "article",
      {
        class: `component ${became.kind}`,
        "data-component": name,
        tabindex: "0",
        "aria-label": this.page.set.label(name),
      },
      head,
      element("dl", {}, ...rows.flat()),
    );
  }

  goneTerm({ tree, left, sign }) {
    const leaf = (of) => this.page.set.symbol(of);
    const value = left === null ? short(this.page.equations.evaluate(tree)) : null;
    const right =
      typeof left === "string"
        ? left === "0"
          ? number("0")
          : this.page.set.symbol(left.replace(/^-/, ""))
        : left === null
          ? number(value)
          : this.page.set.tree(left, { leaf, isStruck: false, isRoot: false });
    const isNegative = sign < 0 || (typeof left === "string" && left.startsWith("-"));
    return math(
      "math",
      { role: "group" },
      math(
        "mrow",
        {},
        this.page.set.tree(tree, { leaf, isStruck: false, isRoot: false }),
        math("mo", {}, "="),
        isNegative ? math("mo", { form: "prefix" }, "−") : null,
        right,
      ),
    );
  }

  /** The name under which a value stands in the code, with a minus sign for its negative. */
  alias(name) {
    const component = this.page.inspection.components.get(name);
    return component && component.became.kind === "same" ? component.became.name : name;
  }

  /** What stands in the place of a name for this robot: its number, or its other name. */
  here(name) {
    const constant = this.page.inspection.constant(name);
    if (!Number.isNaN(constant)) {
      const node = number(exact(constant));
      const whole = constant < 0 ? math("mrow", {}, paren("("), node, paren(")")) : node;
      return math(
        "mrow",
        { "data-name": name, class: "pick", tabindex: "-1", role: "button", "aria-label": `${name} = ${constant}` },
        whole,
      );
    }
    const alias = this.alias(name);
    if (!alias.startsWith("-")) return this.page.set.symbol(alias);
    return math(
      "mrow",
      {},
      paren("("),
      math("mo", { form: "prefix" }, "−"),
      this.page.set.symbol(alias.slice(1)),
      paren(")"),
    );
  }

  /** The code of a component and its numbers, or why there is none. */
  codeOf({ name, general, became, statements = [] }, isUnfolded) {
    if (isUnfolded) return this.codeLine({ name, value: general });
    if (statements.length) return element("div", {}, ...statements.map((statement) => this.codeLine(statement)));
    const said = {
      same: () => [
        `it is `,
        element("code", { "data-name": became.name.replace(/^-/, ""), class: "pick", tabindex: "-1" }, became.name),
        ": no statement",
      ],
      constant: () => [`it is ${exact(became.value)} in every state: no statement`],
      inside: () => {
        const users = this.users(name);
        return users.length ? ["inside the statement that uses it: ", ...users] : ["inside another statement"];
      },
      unused: () => ["not computed: no torque needs it"],
    }[became.kind];
    return element("p", { class: "no-code" }, ...(said ? said() : []));
  }

  /** The components of the code that a value without a statement is part of. */
  users(name) {
    const { usedBy, components } = this.page.inspection;
    const above = (of) =>
      (usedBy.get(of) || []).flatMap((user) => {
        const { statements, became } = components.get(user);
        return statements ? [user] : ["inside", "same"].includes(became.kind) ? above(user) : [];
      });
    return this.named([...new Set(above(name))].slice(0, 4));
  }

  /** Names of the code in a line, each of which can be pointed at. */
  named(names) {
    return names.flatMap((name, at) => [
      at ? ", " : "",
      element("code", { class: "pick", "data-name": name, tabindex: "-1" }, name),
    ]);
  }

  /** A statement in the language of choice, and below it the same with numbers. */
  codeLine(statement, program = this.page.folded, isKnown) {
    const { name, value } = statement;
    const text = this.textOf(statement);
    const read = (of) => (program === this.page.folded ? this.page.shown(of) : short(program.value(of)));
    const pieces = [];
    const numbers = codeOf(value)
      .split(/([A-Za-z_][A-Za-z_0-9]*)/)
      .map((piece) => {
        if (!/^[A-Za-z_]/.test(piece) || piece === "sin" || piece === "cos")
          return piece.replaceAll("*", "×").replaceAll("-", "−");
        const at = element("span", { "data-name": piece });
        pieces.push([at, piece]);
        return at;
      });
    const result = element("b", {});
    this.page.live.push(() => {
      for (const [at, piece] of pieces) {
        const told = read(piece);
        at.textContent = told.startsWith("−") ? `(${told})` : told;
      }
      result.textContent = read(name);
    });
    return element(
      "div",
      { class: "statement" },
      element(
        "code",
        { "data-name": name, class: "line pick", tabindex: "-1" },
        ...this.page.set.code(text, isKnown),
      ),
      element(
        "span",
        { class: "numbers", "aria-hidden": "true" },
        element("b", { class: "left-side", "data-name": name }, `${name} `),
        "= ",
        ...numbers,
        " = ",
        result,
      ),
    );
  }

  /** A statement in the language of choice, in one line: it breaks where the page is narrow. */
  textOf({ name, value }) {
    return this.page.language === "c" ? `const double ${name} = ${codeOf(value, true)};` : `let ${name} = ${codeOf(value)};`;
  }

  reducedCode() {
    const { programs } = this.page.inspection;
    const known = (name) => Object.hasOwn(programs.reduced.names, name);
    const lines = programs.reduced.statements.map((statement) => this.codeLine(statement, this.page.reduced, known));
    const torques = element("p", { class: "hint" });
    this.page.live.push(() => {
      const result = this.page.reduced.outputs.map((output) => output());
      const { free, total, onBase } = this.page.split;
      const [own, others] = [result, onBase ? [...onBase.total, ...total] : free].map((torques) => torques.map(short).join(", "));
      const what = onBase ? "force and moment on the base and torques" : "torques";
      torques.textContent = `Its ${what} here: ${own}; those of the seven steps: ${others}.`;
    });
    return [
      element("header", { class: "cell-head" }, element("h3", {}, "The reduced form")),
      element(
        "p",
        { class: "hint" },
        "The same torques with the fewest operations that are known. Only the torques keep a meaning: " +
          "its vectors are in frames of its own, of matter that is regrouped.",
      ),
      ...(programs.reduced.refusals ?? []).map((refusal) => element("p", { class: "hint" }, `Refused: ${refusal}.`)),
      torques,
      element(
        "div",
        { class: "listing", tabindex: "0", role: "group", "aria-label": "statements of the reduced form" },
        ...lines,
      ),
    ];
  }

  question(name, unitOf) {
    const input = element("input", {
      type: "text",
      inputmode: "text",
      autocomplete: "off",
      "data-exercise": name,
      "aria-label": `value of ${name}, ${unitOf}`,
      size: "9",
      placeholder: "?",
    });
    const said = element("span", { class: "answer", role: "status" });
    const check = () => {
      const { isRight, text } = this.page.exercise.answer(name, input.value);
      said.textContent = text;
      said.className = `answer ${text ? (isRight ? "right" : "wrong") : ""}`;
      input.setAttribute("aria-invalid", String(Boolean(text) && !isRight));
      this.page.handIn.show();
      this.page.paintBars();
      for (const paint of this.page.live) paint();
      this.page.reading.readout();
    };
    input.addEventListener("change", check);
    input.addEventListener("keydown", (event) => {
      if (event.key === "Enter") check();
    });
    const hint = element("button", { type: "button", class: "first-term", title: "of several that are not 0" }, "show the first term");
    hint.addEventListener("click", () => {
      said.textContent = this.page.exercise.firstTerm(name) ?? "There is only one term, or its axes are others than those of the equation.";
      said.className = "answer";
    });
    return element("span", { class: "question" }, input, hint, said);
  }
}

/** A letter by itself in a line of text. */
function letterIn(text) {
  return math("math", {}, letter(text));
}
