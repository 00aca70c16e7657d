// The page: what stands where, what is open, what is lit, and what follows when the state changes.

const STEPS = ["angular velocity", "angular acceleration", "velocity", "acceleration", "gravity", "forces and moments", "torque"];
const STEP_LETTERS = ["ω", "ω̇", "ċ", "c̈", "g", "f, n", "τ"];
const byId = (id) => document.getElementById(id);

class Page {
  constructor(data) {
    const inspection = this.inspection = new Inspection(data);
    const { robot } = inspection;
    this.set = new Typesetter(inspection);
    this.folded = new Program(data.programs.folded);
    this.reduced = data.programs.reduced ? new Program(data.programs.reduced) : null;
    this.equations = new Equations(inspection.components);
    this.torques = new Torques(this.folded, new Program(data.programs.with_wrench));
    this.exercise = new Exercise(inspection, this.equations);
    this.initial = {
      q: ordinaryPose(robot, [0.4, -0.6, 0.9, -0.8, 0.7, 0.5, -0.4]),
      qd: robot.joints.map((_, index) => [0.5, 0.8, -0.6][index % 3] * (inspection.isPrismatic(index + 1) ? 0.4 : 1)),
      qdd: robot.joints.map((_, index) => [1, -1.5, 2][index % 3] * (inspection.isPrismatic(index + 1) ? 0.4 : 1)),
    };
    this.state = structuredClone(this.initial);
    this.wrench = { f: [0, 0, 0], n: [0, 0, 0] };
    this.form = "folded";
    this.language = "rust";
    this.live = [];
    this.pinned = null;
    this.pointed = null;
    this.cell = inspection.cell(Math.min(2, inspection.dof), 1);

    this.arm = new Arm(byId("arm"), inspection, (name) => this.equations.value(name));
    this.arm.changed = () => this.arm.draw(this.state.q);
    this.sliders = new Sliders(byId("sliders"), inspection, this.state, () => { this.stop(); this.update(); });
    this.bars = new Bars(byId("bars"), inspection);
    this.plot = new Plot(byId("plot"), inspection, this.torques);
    this.describe();
    this.makeSwitches();
    this.makeLayers();
    this.makeTip();
    this.makeGrid();
    this.makeMotion();
    this.listen();

    this.from = [...this.initial.q];
    this.to = ordinaryPose(robot, [-0.9, 0.7, -0.3, 0.9, -0.8, -0.9, 1.0]);
    this.given = argumentsOf(this.state);
    this.equations.set(this.given);
    this.arm.fit([this.state.q, this.to].map((q) => this.poseAt(q)));
    this.retime();
    this.open(this.cell);
    this.update();
  }

  poseAt(q) {
    const equations = new Equations(this.inspection.components);
    equations.set(argumentsOf({ ...this.state, q }));
    return new Pose(this.inspection, (name) => equations.value(name), q);
  }

  describe() {
    const { robot, generator, dof } = this.inspection;
    const mass = robot.joints.reduce((sum, joint) => sum + joint.mass, 0);
    byId("described").textContent = `${dof} joints, ${robot.convention} Denavit-Hartenberg, ${short(mass)} kg moved`;
    byId("source").textContent = `Numbers: ${robot.source}`;
    byId("generator").textContent = `Written by ${generator}. Vectors of link i are in axes fixed to link i, z along joint i. The code is evaluated in your browser: + − × ÷ give the bits of Rust.`;
    byId("key").append(...PARTS.map(([part, meaning, formula]) => element("span", { title: formula }, element("i", { class: `swatch ${part}` }), meaning)), element("span", {}, element("i", { class: "swatch total" }), "sum"));
  }

  // ---- the state

  setState(state) {
    for (const of of OF) {
      if (state[of]) state[of].slice(0, this.inspection.dof).forEach((value, index) => { this.state[of][index] = Number(value); });
    }
    this.stop();
    this.sliders.show(this.state);
    this.update();
  }

  /** Computes and paints everything that depends on the state. */
  update() {
    this.given = argumentsOf(this.state);
    this.split = this.torques.split(this.state, this.wrench);
    this.equations.set(this.given);
    if (this.reduced) this.reduced.run(this.given);
    this.arm.draw(this.state.q);
    this.bars.update(this.split, (joint) => this.exercise.hides(`tau${joint}`, this.cell));
    for (const paint of this.live) paint();
    this.readout();
  }

  /** The value of a name: the code's, or that of its equation where the code has none. */
  value(name) {
    return this.folded.has(name) ? this.folded.value(name) : this.equations.value(name);
  }

  shown(name, value = this.value(name)) {
    return this.exercise.hides(name, this.cell) ? "?" : short(value);
  }

  // ---- controls

  makeSwitches() {
    const groups = [["unfolded", "folded", "reduced"], ["rust", "c", "equations"], ["shown", "exercise"], ["auto", "light", "dark"]];
    const choose = (group, name) => {
      for (const other of group) document.querySelector(`[data-switch="${other}"]`).setAttribute("aria-pressed", String(other === name));
    };
    const act = [
      (name) => { this.form = name; this.reopen(); },
      (name) => { this.language = name; this.reopen(); },
      (name) => { this.exercise.isOn = name === "exercise"; this.reopen(); },
      (name) => { name === "auto" ? delete document.documentElement.dataset.theme : (document.documentElement.dataset.theme = name); },
    ];
    groups.forEach((group, index) => {
      for (const name of group) {
        const button = document.querySelector(`[data-switch="${name}"]`);
        if (name === "reduced" && !this.reduced) button.disabled = true;
        button.addEventListener("click", () => {
          choose(group, name);
          act[index](name);
        });
      }
      choose(group, ["folded", "rust", "shown", "auto"][index]);
    });
  }

  makeLayers() {
    const { quantities } = this.inspection;
    this.layerButtons = new Map();
    for (const [quantity] of LAYERS) {
      if (!quantities[quantity]) continue;
      const button = element("button", { type: "button", "data-layer": quantity, title: quantities[quantity].meaning, "aria-label": quantities[quantity].meaning, "aria-pressed": "false" }, quantities[quantity].letter);
      button.addEventListener("click", () => {
        this.arm.layers.has(quantity) ? this.arm.layers.delete(quantity) : this.arm.layers.add(quantity);
        this.paintLayers();
      });
      this.layerButtons.set(quantity, button);
      byId("layers").append(button);
    }
    for (const [label, key, title] of [["frames", "showFrames", "frames of the table"], ["masses", "showComs", "centres of mass"]]) {
      const button = element("button", { type: "button", title, "aria-pressed": String(this.arm[key]) }, label);
      button.addEventListener("click", () => {
        this.arm[key] = !this.arm[key];
        button.setAttribute("aria-pressed", String(this.arm[key]));
        this.arm.draw(this.state.q);
      });
      byId("layers").append(button);
    }
  }

  paintLayers() {
    for (const [quantity, button] of this.layerButtons) button.setAttribute("aria-pressed", String(this.arm.layers.has(quantity)));
    if (this.arm.pose) this.arm.draw(this.state.q);
  }

  makeTip() {
    const most = Math.max(10, ...this.inspection.robot.joints.map((joint) => joint.mass * 5));
    AXES.forEach((axis, index) => {
      const output = element("output", {}, "0 N");
      const input = element("input", { type: "range", min: -niceAbove(most), max: niceAbove(most), step: "any", value: 0, "aria-label": `force at the tip along ${axis}, N`, "data-tip": axis });
      input.addEventListener("input", () => {
        this.wrench.f[index] = Number(input.value);
        output.textContent = `${short(this.wrench.f[index])} N`;
        this.update();
      });
      byId("tip").append(element("label", {}, `f ${axis}`, input, output));
    });
    byId("rest").addEventListener("click", () => this.setState({ qd: this.state.qd.map(() => 0), qdd: this.state.qdd.map(() => 0) }));
    byId("home").addEventListener("click", () => {
      this.wrench.f.fill(0);
      byId("tip").querySelectorAll("input").forEach((input) => { input.value = 0; });
      byId("tip").querySelectorAll("output").forEach((output) => { output.textContent = "0 N"; });
      this.setState(this.initial);
    });
  }

  // ---- the motion

  makeMotion() {
    byId("play").addEventListener("click", () => (this.playing ? this.stop() : this.play()));
    byId("time").addEventListener("input", () => {
      this.stop();
      this.goTo(Number(byId("time").value) * this.trajectory.seconds);
    });
    byId("duration").addEventListener("input", () => this.retime());
    byId("from").addEventListener("click", () => { this.from = [...this.state.q]; this.retime(); });
    byId("to").addEventListener("click", () => { this.to = [...this.state.q]; this.retime(); });
    for (let joint = 1; joint <= this.inspection.dof; joint++) {
      const button = element("button", { type: "button", "data-plot": joint, "aria-pressed": String(joint === 1) }, `τ${joint}`);
      button.addEventListener("click", () => this.plotJoint(joint));
      byId("joints").append(button);
    }
  }

  plotJoint(joint) {
    this.plot.joint = joint;
    for (const button of byId("joints").children) button.setAttribute("aria-pressed", String(Number(button.dataset.plot) === joint));
    this.plot.draw();
    byId("plot-words").textContent = this.plot.words();
  }

  retime() {
    const seconds = Math.round(100 * 10 ** Number(byId("duration").value)) / 100;
    byId("seconds").textContent = `${seconds.toFixed(2)} s`;
    byId("duration").setAttribute("aria-valuetext", `${seconds} s`);
    this.trajectory = new Trajectory(this.from, this.to, seconds);
    this.plot.set(this.trajectory);
    byId("plot-words").textContent = this.plot.words();
    // the intermediates of the code belong to the state again
    this.folded.run(this.given);
  }

  goTo(time) {
    Object.assign(this.state, this.trajectory.at(time));
    this.plot.point(time);
    byId("time").value = time / this.trajectory.seconds;
    byId("time").setAttribute("aria-valuetext", `${time.toFixed(2)} s`);
    this.sliders.show(this.state);
    this.update();
  }

  play() {
    const begun = Number(byId("time").value) < 1 ? Number(byId("time").value) * this.trajectory.seconds : 0;
    byId("play").textContent = "■ stop";
    byId("play").setAttribute("aria-pressed", "true");
    let first = null;
    const frame = (now) => {
      first ??= now;
      const time = begun + (now - first) / 1000;
      this.goTo(Math.min(time, this.trajectory.seconds));
      if (time < this.trajectory.seconds) this.playing = requestAnimationFrame(frame);
      else this.stop();
    };
    this.playing = requestAnimationFrame(frame);
  }

  stop() {
    if (!this.playing) return;
    cancelAnimationFrame(this.playing);
    this.playing = null;
    byId("play").textContent = "▶ play";
    byId("play").setAttribute("aria-pressed", "false");
  }

  // ---- the seven steps

  makeGrid() {
    const { dof, cells } = this.inspection;
    const most = Math.max(...cells.map((cell) => cell.after.products + cell.after.sums), 1);
    const head = element("tr", {}, element("td", {}, "operations of joint"), ...Array.from({ length: dof }, (_, joint) => element("th", { scope: "col" }, String(joint + 1))));
    const body = element("tbody");
    STEPS.forEach((title, index) => {
      const row = element("tr", {}, element("th", { scope: "row" }, element("span", { class: "step-number" }, String(index + 1)), element("span", { class: "step-letter" }, STEP_LETTERS[index]), element("span", { class: "step-title" }, title)));
      for (let joint = 1; joint <= dof; joint++) {
        const cell = this.inspection.cell(joint, index + 1);
        const [before, after] = cell ? [cell.before, cell.after].map((of) => of.products + of.sums) : [0, 0];
        const button = element("button", {
          type: "button", "data-cell": `${joint}-${index + 1}`, tabindex: "-1", disabled: !cell,
          style: `--share:${(after / most).toFixed(3)}`,
          "aria-label": `joint ${joint}, step ${index + 1}, ${title}: ${before} operations, ${after} after folding`,
          title: `${before} operations, ${after} after folding`,
        }, element("b"));
        button.counts = { unfolded: before, folded: after };
        row.append(element("td", {}, button));
      }
      body.append(row);
    });
    byId("grid").append(element("caption", { class: "visually-hidden" }, "operations of each step of each joint; a cell opens its equations"), element("thead", {}, head), body);
  }

  reopen() {
    this.open(this.cell);
    this.update();
  }

  /** Opens a cell: its equations, its code, and its vectors on the arm. */
  open(cell) {
    const { counts, programs } = this.inspection;
    const isOther = this.cell !== cell;
    this.cell = cell;
    this.live = [];
    const body = document.documentElement.dataset;
    Object.assign(body, { form: this.form, language: this.language, exercise: this.exercise.isOn ? "on" : "off" });
    const told = (of) => `${of.products} products, ${of.sums} sums`;
    const text = { unfolded: `${told(counts.before)} before folding`, folded: `${told(counts.after)}; before folding ${counts.before.products}, ${counts.before.sums}` };
    if (this.reduced) text.reduced = `${told(programs.reduced.counts.after)}; in the seven steps ${counts.after.products}, ${counts.after.sums}`;
    byId("counts").textContent = text[this.form];
    for (const button of byId("grid").querySelectorAll("button")) {
      const isOpen = this.form !== "reduced" && button.dataset.cell === `${cell.joint}-${cell.step}`;
      button.setAttribute("aria-pressed", String(isOpen));
      button.tabIndex = button.dataset.cell === `${cell.joint}-${cell.step}` ? 0 : -1;
      button.firstChild.textContent = String(button.counts[this.form === "unfolded" ? "unfolded" : "folded"]);
    }
    const content = this.form === "reduced" ? this.reducedCode() : this.cellContent(cell);
    byId("cell").replaceChildren(...content);
    if (isOther || this.arm.layers.size === 0) {
      byId("cell").scrollTop = 0;
      this.arm.layers = new Set(LAYERS.filter(([quantity, step]) => step === cell.step && this.layerButtons.has(quantity)).map(([quantity]) => quantity));
      this.paintLayers();
    }
    for (const paint of this.live) paint();
    this.relight();
  }

  cellContent(cell) {
    const head = element("header", { class: "cell-head" }, element("h3", {}, `Joint ${cell.joint}, step ${cell.step}: ${cell.title}`));
    const groups = new Map();
    for (const component of cell.components) {
      const { quantity } = this.inspection.meaning(component.name);
      if (!groups.has(quantity)) groups.set(quantity, []);
      groups.get(quantity).push(component);
    }
    const formulas = new Map(cell.formulas.map(({ quantity, text }) => [quantity, text]));
    // what the step is for comes first, what is needed on the way behind it
    const order = [...groups.keys()].sort((a, b) => Number(formulas.has(b)) - Number(formulas.has(a)));
    let isOnTheWay = false;
    const sections = order.flatMap((quantity) => {
      const of = this.inspection.quantities[quantity];
      const formula = formulas.get(quantity);
      const cards = groups.get(quantity).map((component) => this.card(component));
      const heading = element("h4", {}, formula ? this.set.formula(formula) : letterIn(of.letter), element("span", { class: "group-meaning" }, this.inspection.words({ of, joint: cell.joint })));
      const before = !formula && !isOnTheWay ? [element("p", { class: "on-the-way" }, "On the way")] : [];
      isOnTheWay ||= !formula;
      if (quantity === "rotation") {
        return [...before, element("details", { class: "group" }, element("summary", {}, heading), ...cards)];
      }
      return [...before, element("section", { class: "group" }, heading, ...cards)];
    });
    return [head, ...sections];
  }

  /** A component: general, with this robot's numbers, what is gone and why, code; and its value. */
  card(component) {
    const { name, general, became, statements = [] } = component;
    const isUnfolded = this.form === "unfolded";
    const isStruck = !isUnfolded;
    const symbol = (of) => this.set.symbol(of);
    const equation = (leaf) => this.set.equation(this.set.symbol(name), general, leaf, isStruck);
    const value = element("output", { class: "live value", "data-name": name });
    const unitOf = unitText(this.inspection.unit(name));
    this.live.push(() => {
      value.textContent = this.exercise.hides(name, this.cell) ? `? ${unitOf}` : withUnit(this.value(name), unitOf);
      value.title = this.exercise.hides(name, this.cell) ? "" : full(this.value(name));
    });
    const lines = [["general", "in general", equation(symbol)]];
    if (namesIn(general).some((of) => !Number.isNaN(this.inspection.constant(of)) || this.alias(of) !== of)) {
      lines.push(["here", "this robot", equation((of) => this.here(of))]);
    }
    const gone = isUnfolded ? [] : this.set.gone(general);
    if (gone.length) {
      const byReason = new Map();
      for (const one of gone) {
        const why = one.why || "it vanishes";
        if (!byReason.has(why)) byReason.set(why, []);
        byReason.get(why).push(one);
      }
      const items = [...byReason].map(([why, all]) => element("li", {}, ...all.flatMap((one, at) => [at ? ", " : null, this.goneTerm(one)]), element("span", { class: "why" }, why)));
      lines.push(["gone", "gone, why", element("ul", {}, ...items)]);
    }
    lines.push(["code", "code", this.codeOf(component, isUnfolded)]);
    const rows = lines.map(([kind, label, content]) => [element("dt", { class: kind }, label), element("dd", { class: kind }, content)]);
    const answer = this.exercise.isOn && became.kind !== "constant" ? this.question(name, unitOf) : null;
    const head = element("header", {}, math("math", {}, this.set.symbol(name)), element("code", { class: "own-name pick", "data-name": name, tabindex: "-1" }, name), value, answer);
    return element("article", { class: `component ${became.kind}`, "data-component": name, tabindex: "0", "aria-label": this.set.label(name) }, head, element("dl", {}, ...rows.flat()));
  }

  goneTerm({ tree, left, sign }) {
    const leaf = (of) => this.set.symbol(of);
    const value = left === null ? short(this.equations.evaluate(tree)) : null;
    const right = typeof left === "string"
      ? (left === "0" ? number("0") : this.set.symbol(left.replace(/^-/, "")))
      : left === null ? number(value) : this.set.tree(left, { leaf, isStruck: false, isRoot: false });
    const isNegative = sign < 0 || (typeof left === "string" && left.startsWith("-"));
    return math("math", {}, math("mrow", {}, this.set.tree(tree, { leaf, isStruck: false, isRoot: false }), math("mo", {}, "="), isNegative ? math("mo", { form: "prefix" }, "−") : null, right));
  }

  /** The name under which a value stands in the code, with a minus sign for its negative. */
  alias(name) {
    const component = this.inspection.components.get(name);
    return component && component.became.kind === "same" ? component.became.name : name;
  }

  /** What stands in the place of a name for this robot: its number, or its other name. */
  here(name) {
    const constant = this.inspection.constant(name);
    if (!Number.isNaN(constant)) {
      const node = number(exact(constant));
      const whole = constant < 0 ? math("mrow", {}, paren("("), node, paren(")")) : node;
      return math("mrow", { "data-name": name, class: "pick", tabindex: "-1", role: "button", "aria-label": `${name} = ${constant}` }, whole);
    }
    const alias = this.alias(name);
    if (!alias.startsWith("-")) return this.set.symbol(alias);
    return math("mrow", {}, paren("("), math("mo", { form: "prefix" }, "−"), this.set.symbol(alias.slice(1)), paren(")"));
  }

  /** The code of a component and its numbers, or why there is none. */
  codeOf({ name, general, became, statements = [] }, isUnfolded) {
    if (isUnfolded) return this.codeLine({ name, value: general, rust: `let ${name} = ${codeOf(general)};` });
    if (statements.length) return element("div", {}, ...statements.map((statement) => this.codeLine(statement)));
    const said = {
      same: () => [`it is `, element("code", { "data-name": became.name.replace(/^-/, ""), class: "pick", tabindex: "-1" }, became.name), ": no statement"],
      constant: () => [`it is ${exact(became.value)} in every state: no statement`],
      inside: () => ["inside the statement that uses it: ", ...this.users(name)],
      unused: () => ["no torque needs it: no statement"],
    }[became.kind];
    return element("p", { class: "no-code" }, ...(said ? said() : []));
  }

  users(name) {
    const computed = (this.inspection.usedBy.get(name) || []).filter((user) => this.inspection.components.get(user).statements);
    return computed.slice(0, 4).flatMap((user, at) => [at ? ", " : "", element("code", { class: "pick", "data-name": user, tabindex: "-1" }, user)]);
  }

  /** A statement in the language of choice, and below it the same with numbers. */
  codeLine(statement, program = this.folded, isKnown) {
    const { name, value } = statement;
    const text = this.textOf(statement);
    const read = (of) => (program === this.folded ? this.shown(of) : short(program.value(of)));
    const pieces = [];
    const numbers = codeOf(value).split(/([A-Za-z_][A-Za-z_0-9]*)/).map((piece) => {
      if (!/^[A-Za-z_]/.test(piece) || piece === "sin" || piece === "cos") return piece.replaceAll("*", "×").replaceAll("-", "−");
      const at = element("span", { "data-name": piece });
      pieces.push([at, piece]);
      return at;
    });
    const result = element("b", {});
    this.live.push(() => {
      for (const [at, piece] of pieces) {
        const told = read(piece);
        at.textContent = told.startsWith("−") ? `(${told})` : told;
      }
      result.textContent = read(name);
    });
    return element("div", { class: "statement" },
      element("code", { "data-name": name, class: "line pick", tabindex: "-1" }, ...this.set.code(text, isKnown)),
      element("span", { class: "numbers", "aria-hidden": "true" }, "= ", ...numbers, " = ", result));
  }

  /** A statement in the language of choice, in one line: it breaks where the page is narrow. */
  textOf({ name, value, rust }) {
    return this.language === "c" ? `const double ${name} = ${codeOf(value, true)};` : rust.replace(/\n\s*/g, " ");
  }

  reducedCode() {
    const { programs } = this.inspection;
    const known = (name) => Object.hasOwn(programs.reduced.names, name);
    const lines = programs.reduced.statements.map((statement) => this.codeLine(statement, this.reduced, known));
    const torques = element("p", { class: "hint" });
    this.live.push(() => {
      const result = this.reduced.outputs.map((output) => output());
      torques.textContent = `Its torques here: ${result.map(short).join(", ")}; those of the seven steps: ${this.split.free.map(short).join(", ")}.`;
    });
    return [
      element("header", { class: "cell-head" }, element("h3", {}, "The reduced form")),
      element("p", { class: "hint" }, "The same torques with the fewest operations that are known. Only the torques keep a meaning: its vectors are in frames of its own, of matter that is regrouped."),
      torques,
      element("div", { class: "listing", tabindex: "0", role: "group", "aria-label": "statements of the reduced form" }, ...lines),
    ];
  }

  question(name, unitOf) {
    const input = element("input", { type: "text", inputmode: "text", autocomplete: "off", "data-exercise": name, "aria-label": `value of ${name}, ${unitOf}`, size: "9", placeholder: "?" });
    const said = element("span", { class: "answer", role: "status" });
    const check = () => {
      const { isRight, text } = this.exercise.answer(name, input.value);
      said.textContent = text;
      said.className = `answer ${text ? (isRight ? "right" : "wrong") : ""}`;
      input.setAttribute("aria-invalid", String(Boolean(text) && !isRight));
      this.bars.update(this.split, (joint) => this.exercise.hides(`tau${joint}`, this.cell));
      for (const paint of this.live) paint();
      this.readout();
    };
    input.addEventListener("change", check);
    input.addEventListener("keydown", (event) => { if (event.key === "Enter") check(); });
    return element("span", { class: "question" }, input, said);
  }

  // ---- what is lit

  /** Everything that belongs to a selection: names, arrows, places on the arm, a cell. */
  related(selection) {
    if (!selection) return { names: [] };
    if (selection.arrow) {
      const at = selection.arrow.lastIndexOf("-");
      const [quantity, joint] = [selection.arrow.slice(0, at), Number(selection.arrow.slice(at + 1))];
      const names = [null, ...AXES].map((axis) => this.inspection.nameOf(quantity, joint, axis)).filter(Boolean);
      const cell = names.map((name) => this.inspection.owner(name)?.cell).find(Boolean);
      const first = this.inspection.meaning(names[0]);
      return { names, arrows: [selection.arrow], cell, frame: first && this.inspection.axes(first) };
    }
    const names = selection.tree !== undefined ? namesIn(selection.tree) : [selection.name];
    if (selection.tree !== undefined) {
      const all = names.map((name) => this.related({ name }));
      return { names, arrows: all.flatMap((one) => one.arrows || []) };
    }
    const { name } = selection;
    const meaning = this.inspection.meaning(name);
    if (!meaning || this.form === "reduced") {
      const own = this.inspection.programs.reduced?.names[name];
      const isJoint = own && ["position", "rate", "rate_dot", "torque", "sine", "cosine"].includes(own[0]);
      return { names: [name], axis: isJoint ? own[1] : null };
    }
    const owner = this.inspection.owner(name);
    const told = { names: [name], cell: owner?.cell };
    if (owner && owner.name !== name) told.names.push(owner.name);
    const alias = this.alias(name);
    if (alias !== name) told.names.push(alias.replace(/^-/, ""));
    const { quantity, joint, component, of } = meaning;
    const isVector = of.axes && component && component.length === 1;
    if (isVector) {
      told.arrows = [`${quantity}-${joint}`];
      told.component = AXES.indexOf(component);
      told.frame = this.inspection.axes(meaning);
    } else if (of.drawn === "axis") {
      told.axis = joint;
      if (["torque", "rate", "rate_dot"].includes(quantity)) told.arrows = [`${quantity}-${joint}`];
    } else if (of.drawn === "frame") {
      told.frame = joint;
    } else if (of.drawn === "link") {
      told.link = joint;
    }
    return told;
  }

  /** Shows what is pointed at, or else what was chosen last. */
  relight() {
    const selection = this.pointed || this.pinned;
    for (const old of document.querySelectorAll(".lit:not(.arrow)")) old.classList.remove("lit");
    const related = this.related(selection);
    this.arm.light(related);
    for (const name of related.names) {
      for (const node of document.querySelectorAll(`[data-name="${CSS.escape(name)}"], [data-component="${CSS.escape(name)}"]`)) node.classList.add("lit");
    }
    if (selection && selection.term) selection.term.classList.add("lit");
    if (related.cell) document.querySelector(`[data-cell="${related.cell.joint}-${related.cell.step}"]`)?.classList.add("lit");
    this.readout();
  }

  /** What is pointed at, in words and numbers. */
  readout() {
    const root = document.querySelector("[data-readout]");
    const selection = this.pointed || this.pinned;
    const line = (kind, ...content) => element("span", { class: `readout-${kind}` }, ...content);
    if (!selection) {
      root.replaceChildren(line("hint", "Point at a symbol, a line of code or an arrow; Tab and arrow keys do the same. A click keeps it, Escape lets it go."));
      return;
    }
    if (selection.tree !== undefined) {
      const isGone = this.form !== "unfolded" && this.set.isGone(selection.tree);
      const isHidden = namesIn(selection.tree).some((name) => this.exercise.hides(name, this.cell));
      root.replaceChildren(
        line("name", `${selection.sign < 0 ? "−" : ""} ${codeOf(selection.tree)}`),
        line("value", isHidden ? "?" : short(selection.sign * this.equations.evaluate(selection.tree))),
        line("meaning", isGone ? `gone: ${this.set.why(selection.tree)}` : "a term of the equation"));
      return;
    }
    if (selection.arrow) {
      const arrow = this.arm.arrows.get(selection.arrow);
      if (!arrow) return;
      const names = this.related(selection).names;
      const unitOf = unitText(this.inspection.unitOf(arrow.quantity, arrow.joint));
      root.replaceChildren(
        line("name", names.join(", ")),
        line("value", `(${names.map((name) => this.shown(name)).join(", ")}) ${unitOf}`),
        line("meaning", `${this.inspection.words(arrow)}; ${this.ofWhat(arrow)}${this.axesWords(this.inspection.meaning(names[0]))}`));
      return;
    }
    const { name } = selection;
    const isReduced = this.form === "reduced" && this.reduced && this.reduced.has(name);
    const meaning = this.inspection.meaning(name);
    if (isReduced || !meaning) {
      const own = this.inspection.programs.reduced?.names[name];
      if (!own) return;
      const of = this.inspection.quantities[own[0]];
      const statement = this.inspection.programs.reduced.statements.find((one) => one.name === name);
      root.replaceChildren(
        line("name", name), line("value", withUnit(this.reduced.value(name), of.units[0])),
        line("meaning", `${of.meaning}; ${own[1]}`), line("code", statement ? this.textOf(statement) : "an argument"));
      return;
    }
    const unitOf = this.inspection.unit(name);
    const isHidden = this.exercise.hides(name, this.cell);
    const statement = this.inspection.statements.get(name);
    const owner = this.inspection.owner(name);
    const value = this.value(name);
    const code = statement ? this.textOf(statement) : this.withoutStatement(name, owner);
    const what = line("value", isHidden ? `? ${unitText(unitOf)}` : withUnit(value, unitOf));
    what.title = isHidden ? "" : full(value);
    root.replaceChildren(
      line("name", math("math", {}, this.set.symbol(name, false)), element("code", {}, name)),
      what,
      line("meaning", `${this.inspection.words(meaning)}${meaning.part ? ", a term of it" : ""}; ${this.ofWhat(meaning)}${this.axesWords(meaning)}`),
      line("code", code));
  }

  ofWhat({ of, joint }) {
    if (joint === 0) return "base";
    return joint > this.inspection.dof ? "tip" : `${of.drawn === "link" || of.axes ? "link" : "joint"} ${joint}`;
  }

  axesWords(meaning) {
    const frame = meaning && this.inspection.axes(meaning);
    if (frame === null || frame === undefined) return "";
    return `, in the axes of ${frame === 0 ? "the base" : `link ${frame}`}`;
  }

  withoutStatement(name, owner) {
    if (Object.hasOwn(this.given, name)) return "an argument of the function";
    if (this.inspection.constants.has(name)) return "a number of the table, in the code";
    if (!owner) return this.folded.has(name) ? "evaluated with its angle before all steps" : "";
    const { became } = owner;
    return {
      same: `the same as ${became.name}`, constant: `a number: ${became.why || "of the table"}`,
      inside: "inside the statement that uses it", unused: "no torque needs it", computed: "computed",
    }[became.kind] || "";
  }

  /** Chooses a name, an arrow or a term: it stays lit, and its cell opens. Whether there is such a one. */
  select(what) {
    const selection = typeof what === "string" ? { name: what } : what;
    const isKnown = selection.tree !== undefined || selection.arrow
      ? true : this.inspection.meaning(selection.name) !== null || Object.hasOwn(this.inspection.programs.reduced?.names || {}, selection.name);
    if (!isKnown) return false;
    this.pointed = null;
    this.pinned = selection;
    const { cell } = this.related(selection);
    if (cell && cell !== this.cell && this.form !== "reduced") this.open(cell);
    this.relight();
    if (selection.name || selection.arrow) {
      const target = document.querySelector(`[data-component="${CSS.escape(this.related(selection).names.at(-1) || "")}"]`);
      if (target && !byId("cell").contains(document.activeElement)) {
        const box = byId("cell");
        target.closest("details")?.setAttribute("open", "");
        box.scrollTop += target.getBoundingClientRect().top - box.getBoundingClientRect().top - 8;
      }
    }
    byId("said").textContent = document.querySelector("[data-readout]").textContent;
    return true;
  }

  /** What stands under a node: a term, a name or an arrow. */
  selectionAt(node) {
    const found = node instanceof Element ? node.closest("[data-name], [data-arrow], .term, [data-component]") : null;
    if (!found) return null;
    if (found.dataset.arrow) return { arrow: found.dataset.arrow };
    if (found.dataset.name) return { name: found.dataset.name };
    if (found.tree !== undefined) return { tree: found.tree, sign: found.sign, term: found };
    return { name: found.dataset.component };
  }

  listen() {
    const point = (selection) => {
      const key = (of) => of && (of.term || of.arrow || of.name);
      if (key(selection) === key(this.pointed)) return;
      this.pointed = selection;
      this.relight();
    };
    document.addEventListener("pointerover", (event) => {
      if (event.pointerType !== "touch") point(this.selectionAt(event.target));
    });
    document.documentElement.addEventListener("pointerleave", () => point(null));
    document.addEventListener("focusin", (event) => {
      if (event.target.matches(":focus-visible")) point(this.selectionAt(event.target));
    });
    document.addEventListener("click", (event) => {
      const cell = event.target.closest?.("[data-cell]");
      if (cell) {
        const [joint, step] = cell.dataset.cell.split("-").map(Number);
        if (this.form === "reduced") document.querySelector('[data-switch="folded"]').click();
        this.pinned = null;
        this.open(this.inspection.cell(joint, step));
        this.update();
        return;
      }
      if (event.target.closest?.("input, summary")) return;
      const selection = this.selectionAt(event.target);
      if (selection) this.select(selection);
    });
    document.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => {
      this.arm.draw(this.state.q);
      this.plot.draw();
    }).observe(byId("arm"));
  }

  key(event) {
    if (event.key === "Escape") {
      this.pinned = this.pointed = null;
      this.relight();
      return;
    }
    const { target } = event;
    if (target.matches("input")) return;
    if ((event.key === "Enter" || event.key === " ") && target.matches(".pick, [data-arrow], [data-component]") && !target.matches("button")) {
      event.preventDefault();
      this.select(this.selectionAt(target));
      return;
    }
    const way = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowDown: [0, 1], ArrowUp: [0, -1] }[event.key];
    if (!way) return;
    if (target.matches("[data-cell]")) {
      const [joint, step] = target.dataset.cell.split("-").map(Number);
      const next = document.querySelector(`[data-cell="${joint + way[0]}-${step + way[1]}"]:not(:disabled)`);
      if (next) { event.preventDefault(); next.focus(); }
      return;
    }
    // inside a component the arrow keys go from piece to piece, up and down to the next component
    const card = target.closest("[data-component], .listing");
    if (!card) return;
    if (way[1] && card.matches("[data-component]")) {
      const cards = [...byId("cell").querySelectorAll("[data-component]")].filter((other) => other.offsetParent !== null);
      cards[cards.indexOf(card) + way[1]]?.focus();
      event.preventDefault();
      return;
    }
    const pieces = [...card.querySelectorAll(".pick")];
    const next = pieces[pieces.indexOf(target) + (way[0] || way[1])];
    (next || card).focus();
    event.preventDefault();
  }
}

/** A letter by itself in a line of text. */
function letterIn(text) {
  return math("math", {}, letter(text));
}

const page = new Page(JSON.parse(byId("data").textContent));
window.rne = {
  setState: (state) => page.setState(state),
  torques: () => page.folded.run(page.given),
  value: (name) => page.value(name),
  select: (name) => page.select(name),
  view: () => viewOf(page),
  show: (view) => showView(page, view),
};
requestAnimationFrame(() => requestAnimationFrame(() => { document.documentElement.dataset.ready = "1"; }));
