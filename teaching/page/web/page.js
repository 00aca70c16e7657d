// The page: what stands where, what is open, what is lit, and what follows when the state changes.

const STEPS = [
  "angular velocity",
  "angular acceleration",
  "velocity",
  "acceleration",
  "gravity",
  "forces and moments",
  "torque",
];
const STEP_LETTERS = ["ω", "ω̇", "ċ", "c̈", "g", "f, n", "τ"];
const byId = (id) => document.getElementById(id);

class Page {
  constructor(data) {
    const inspection = (this.inspection = new Inspection(data));
    const { robot } = inspection;
    this.set = new Typesetter(inspection);
    this.folded = new Program(data.programs.folded);
    this.reduced = data.programs.reduced ? new Program(data.programs.reduced) : null;
    this.equations = new Equations(inspection.components);
    const withWrench = data.programs.with_wrench ? new Program(data.programs.with_wrench) : this.folded;
    this.torques = new Torques(inspection, this.folded, withWrench);
    this.axes = new ChosenAxes(inspection, (name) => this.value(name), () => this.state.q);
    this.exercise = new Exercise(inspection, this.equations, this.axes);
    this.isLecture = false;
    this.initial = {
      q: ordinaryPose(robot, [0.4, -0.6, 0.9, -0.8, 0.7, 0.5, -0.4]),
      qd: robot.joints.map((_, index) => [0.5, 0.8, -0.6][index % 3] * (inspection.isPrismatic(index + 1) ? 0.4 : 1)),
      qdd: robot.joints.map((_, index) => [1, -1.5, 2][index % 3] * (inspection.isPrismatic(index + 1) ? 0.4 : 1)),
      ...(inspection.floating ? { base: levelBase() } : {}),
    };
    inspection.follow(this.initial);
    this.state = structuredClone(this.initial);
    this.wrench = inspection.freeTips();
    this.form = "folded";
    this.language = "rust";
    this.live = [];
    this.cards = new Cards(this);
    this.reading = new Reading(this);
    // the first step that begins with something that moves
    const first = Math.min(2, inspection.dof);
    const moves = ({ name, became }, [formula]) => inspection.meaning(name).quantity === formula?.quantity && became.kind !== "constant";
    const isFirst = ({ joint, formulas, components }) => joint === first && components.some((of) => moves(of, formulas));
    this.cell = inspection.cells.find(isFirst) || inspection.cell(first, 1);
    this.firstCell = [this.cell.joint, this.cell.step];
    this.handIn = new HandIn(this);

    this.arm = new Arm(byId("arm"), inspection, (name) => this.equations.value(name), this.axes);
    this.arm.changed = () => {
      this.arm.draw(this.state.q);
      this.paintView();
      this.address?.later();
    };
    this.sliders = new Sliders(byId("sliders"), inspection, this.state, () => {
      this.stop();
      this.update();
    });
    this.tip = new WrenchSliders(byId("tip"), inspection, this.wrench, () => {
      this.update();
      this.retime();
    });
    this.bars = new Bars(byId("bars"), barsOfJoints(inspection));
    if (inspection.floating) this.makeBase();
    this.plot = new Plot(byId("plot"), inspection, this.torques);
    this.describe();
    this.makeSwitches();
    this.makeLayers();
    this.makeViews();
    this.makeStill();
    this.makeGrid();
    this.makeMotion();
    this.reading.listen();

    this.arm.placed = this.placed();
    this.from = [...this.initial.q];
    this.to = ordinaryPose(robot, [-0.9, 1.1, -0.3, 0.9, -0.8, -0.9, 1.0]);
    this.given = this.argumentsOfCode();
    this.equations.set(this.given);
    this.arm.fit([this.poseAt(this.state.q)]);
    this.retime();
    this.open(this.cell);
    this.update();
    this.paintView();
    this.foldSettings();
    this.address = new Address(this);
    window.addEventListener("beforeprint", () => {
      byId("vectors").replaceChildren(element("h2", {}, "All vectors"), ...vectorsOf(this));
    });
  }

  poseAt(q) {
    const equations = new Equations(this.inspection.components);
    equations.set(this.inspection.argumentsOf({ ...this.state, q }));
    return new Pose(this.inspection, (name) => equations.value(name), q, this.placed());
  }

  /** Where frame 0 stands in the world: a floating base is turned as its state says. */
  placed() {
    const { base } = this.inspection.robot;
    return this.state.base ? { ...base, rpy: this.state.base.rpy } : base;
  }

  /** What only a robot with a floating base has: the motion of the base, and the force and moment on it. */
  makeBase() {
    this.baseSliders = new BaseSliders(this.inspection, () => this.state, (of) => {
      this.stop();
      this.update();
      if (of === "rpy") this.retime();
    });
    byId("sliders").parentNode.before(this.baseSliders.root);
    this.onBase = new OnBase(this.inspection);
    byId("bars").before(this.onBase.root);
    byId("tip-hint").textContent = "They are arguments of the code: vectors, equations and the force on the base have them, too.";
  }

  describe() {
    const { robot, generator, dof } = this.inspection;
    const { floating } = this.inspection;
    const mass = robot.joints.reduce((sum, joint) => sum + joint.mass, floating ? floating.mass : 0);
    const count = dof === 1 ? "1 joint" : `${dof} joints`;
    const joints = this.inspection.isTree() ? `a tree of ${count}` : count;
    const what = floating ? `${joints} on a floating base` : joints;
    byId("described").textContent = `${what}, ${robot.convention} Denavit-Hartenberg, ${short(mass)} kg moved`;
    if (this.inspection.tips.length > 1) {
      byId("tip-where").textContent = "each tip";
      byId("tip-link").textContent = "the robot";
    } else if (this.inspection.isTree()) {
      byId("tip-link").textContent = `link ${robot.tip}`;
    }
    byId("source").textContent = `Numbers: ${robot.source}`;
    byId("generator").textContent =
      `Written by ${generator}. The code has the vectors of link i in axes fixed to link i, z along joint i; ` +
      "“Axes of vectors” tells them in others. The code is evaluated in your browser: + − × ÷ give the bits of Rust.";
    fillTable(byId("table"), this.inspection);
    byId("key").append(
      ...PARTS.map(([part, meaning, formula]) =>
        element("span", { title: floating ? PARTS_WITH_BASE[part] : formula }, element("i", { class: `swatch ${part}` }), meaning),
      ),
      element("span", {}, element("i", { class: "swatch total" }), "sum"),
    );
  }

  // ---- the state

  setState(state) {
    for (const of of OF) {
      if (state[of])
        state[of].slice(0, this.inspection.dof).forEach((value, index) => {
          this.state[of][index] = Number(value);
        });
    this.inspection.follow(this.state);
    }
    for (const of of Object.keys((this.state.base && state.base) || {})) this.state.base[of] = state.base[of].map(Number);
    this.stop();
    this.showSliders();
    this.update();
    // the motion has the base as it stands
    if (this.state.base && this.trajectory) this.retime();
  }

  showSliders() {
    this.sliders.show(this.state);
    this.baseSliders?.show();
  }

  /** Computes and paints everything that depends on the state. */
  update() {
    this.inspection.follow(this.state);
    this.sliders.tellFollowers(this.state);
    this.arm.wrench = this.wrench;
    this.arm.placed = this.placed();
    this.given = this.argumentsOfCode();
    this.split = this.torques.split(this.state, this.wrench);
    this.equations.set(this.given);
    if (this.reduced) this.reduced.run(this.given);
    this.arm.draw(this.state.q);
    this.paintBars();
    this.paintHand();
    for (const paint of this.live) paint();
    this.reading.readout();
    this.exercise.begin(JSON.stringify([this.state, this.axes.kind]));
    this.handIn.show();
    this.address?.later();
  }

  /** Of a floating base, the code takes the wrenches at the tips, too. */
  argumentsOfCode() {
    return this.inspection.argumentsOf(this.state, this.state.base ? this.wrench : null);
  }

  paintBars() {
    const isHidden = (name) => this.hides(name);
    this.bars.update(this.split, isHidden);
    this.onBase?.update(this.split, { state: this.state, wrench: this.wrench, isHidden });
  }

  /** The value of a name: the code's, or that of its equation where the code has none. */
  value(name) {
    return this.folded.has(name) ? this.folded.value(name) : this.equations.value(name);
  }

  /** The value of a name in the axes that are chosen. */
  told(name) {
    return this.axes.component(name);
  }

  /** Whether the exercise asks for a name, or for what it is computed of in the axes that are chosen. */
  hides(name) {
    if (this.exercise.hides(name, this.cell)) return true;
    const meaning = this.exercise.isOn && this.axes.isOther(name) ? this.inspection.meaning(name) : null;
    if (!meaning || meaning.component.length > 1 || this.exercise.hasSolved(name)) return false;
    return this.axes.vectorOf(meaning).some((of) => of && this.exercise.hides(of, this.cell));
  }

  shown(name, value = this.value(name)) {
    return this.hides(name) ? "?" : short(value);
  }

  // ---- controls

  makeSwitches() {
    const groups = [
      ["unfolded", "folded", "reduced"],
      ["rust", "c", "equations"],
      KINDS_OF_AXES,
      ["shown", "exercise"],
      ["auto", "light", "dark"],
    ];
    const choose = (group, name) => {
      for (const other of group)
        document.querySelector(`[data-switch="${other}"]`).setAttribute("aria-pressed", String(other === name));
    };
    const act = [
      (name) => {
        this.form = name;
        this.reopen();
      },
      (name) => {
        this.language = name;
        this.reopen();
      },
      (name) => {
        this.axes.kind = name;
        this.reopen();
      },
      (name) => {
        this.exercise.isOn = name === "exercise";
        this.reopen();
      },
      (name) => {
        name === "auto"
          ? delete document.documentElement.dataset.theme
          : (document.documentElement.dataset.theme = name);
        this.address?.later();
      },
    ];
    groups.forEach((group, index) => {
      for (const name of group) {
        const button = document.querySelector(`[data-switch="${name}"]`);
        if (name === "reduced" && !this.reduced) button.disabled = true;
        button.addEventListener("click", () => {
          // an exercise ends where it began
          const chosen = name === "exercise" && this.exercise.isOn ? "shown" : name;
          choose(group, chosen);
          act[index](chosen);
        });
      }
      choose(group, ["folded", "rust", "link", "shown", "auto"][index]);
    });
  }

  makeLayers() {
    const { quantities } = this.inspection;
    this.layerButtons = new Map();
    for (const [quantity] of LAYERS) {
      // nobody gives the velocity of a floating base
      if (!quantities[quantity] || (quantity === "velocity" && this.inspection.floating)) continue;
      const before = this.inspection.isTree() ? "p, the parent of link i," : "i-1";
      const meaning = quantities[quantity].meaning.replace("h = i - 1", before);
      const button = element(
        "button",
        {
          type: "button",
          "data-layer": quantity,
          title: meaning,
          "aria-label": meaning,
          "aria-pressed": "false",
        },
        quantities[quantity].letter,
      );
      button.addEventListener("click", () => {
        this.arm.layers.has(quantity) ? this.arm.layers.delete(quantity) : this.arm.layers.add(quantity);
        this.paintLayers();
        this.address?.later();
      });
      this.layerButtons.set(quantity, button);
      byId("layers").append(button);
    }
    const ofTable = this.inspection.robot.convention === "standard" ? "joint axes" : "link axes";
    for (const [label, key, title] of [
      ["frames", "showFrames", `the axes of vectors that are chosen above; the frames of the table are ${ofTable}`],
      ["masses", "showComs", "centres of mass"],
      ["dimensions", "showDrawing", "angles and lengths, where the arm is seen along parallel axes"],
    ]) {
      const button = element(
        "button",
        { type: "button", title, "data-shows": label, "aria-pressed": String(this.arm[key]) },
        label,
      );
      button.addEventListener("click", () => {
        this.arm[key] = !this.arm[key];
        button.setAttribute("aria-pressed", String(this.arm[key]));
        this.arm.draw(this.state.q);
        this.address?.later();
      });
      byId("layers").append(button);
    }
  }

  /** Buttons that look at the arm from the front, from above and obliquely. */
  makeViews() {
    for (const name of VIEWS) {
      const button = element("button", { type: "button", "data-view": name, "aria-pressed": "false" }, name);
      button.addEventListener("click", () => this.arm.lookFrom(name));
      byId("views").append(button);
    }
    byId("lecture-mode").addEventListener("click", () => {
      this.setLecture(!this.isLecture);
      this.address.later();
    });
    byId("copy-link").addEventListener("click", async () => {
      this.address.write();
      const isCopied = await copied(location.href);
      byId("copy-link").textContent = isCopied ? "link copied" : "the link is in the address bar";
      setTimeout(() => {
        byId("copy-link").textContent = "copy link";
      }, 2000);
    });
    // on a phone and in a lecture the settings are folded
    this.small = window.matchMedia("(max-width: 900px)");
    this.small.addEventListener("change", () => this.foldSettings());
    const forget = () => {
      document.documentElement.dataset.helped = "1";
    };
    document.addEventListener("click", forget, { once: true, capture: true });
  }

  paintView() {
    const name = this.arm.viewName();
    for (const button of byId("views").children) button.setAttribute("aria-pressed", String(button.dataset.view === name));
    const figure = document.querySelector('[data-shows="dimensions"]');
    if (figure) figure.disabled = !this.arm.isFigure();
  }

  foldSettings() {
    byId("settings").open = !(this.small.matches || this.isLecture);
  }

  /** Large letters and wide equations, for a projector. */
  setLecture(isOn) {
    this.isLecture = isOn;
    document.documentElement.dataset.lecture = isOn ? "on" : "off";
    byId("lecture-mode").setAttribute("aria-pressed", String(isOn));
    this.foldSettings();
    this.reachCell();
  }

  layersOf(step) {
    return LAYERS.filter(([quantity, of]) => of === step && this.layerButtons.has(quantity)).map(([quantity]) => quantity);
  }

  paintLayers() {
    for (const [quantity, button] of this.layerButtons)
      button.setAttribute("aria-pressed", String(this.arm.layers.has(quantity)));
    if (this.arm.pose) this.arm.draw(this.state.q);
  }

  makeStill() {
    const still = () => this.state.qd.map(() => 0);
    const twice = (rates) => rates.map((rate) => 2 * rate);
    byId("rest").addEventListener("click", () => this.setState({ qd: still(), qdd: still(), base: AT_REST }));
    byId("faster").addEventListener("click", () => {
      const { qd, base } = this.state;
      this.setState({ qd: twice(qd), base: base && { omega: twice(base.omega) } });
    });
    byId("home").addEventListener("click", () => {
      this.tip.show(this.inspection.freeTips());
      this.retime();
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
    byId("duration").addEventListener("input", () => {
      const isOnMotion = this.plot.has(this.state);
      this.retime();
      if (isOnMotion) this.goTo(Number(byId("time").value) * this.trajectory.seconds);
    });
    byId("from").addEventListener("click", () => {
      this.from = [...this.state.q];
      this.retime();
    });
    byId("to").addEventListener("click", () => {
      this.to = [...this.state.q];
      this.retime();
    });
    for (const joint of this.inspection.coordinates.map((index) => index + 1)) {
      const button = element(
        "button",
        { type: "button", "data-plot": joint, "aria-pressed": String(joint === this.plot.joint) },
        `τ${joint}`,
      );
      button.addEventListener("click", () => this.plotJoint(joint));
      byId("joints").append(button);
    }
  }

  plotJoint(joint) {
    this.plot.joint = joint;
    for (const button of byId("joints").children)
      button.setAttribute("aria-pressed", String(Number(button.dataset.plot) === joint));
    this.plot.draw();
    this.paintHand();
  }

  /** The cursor of the plot: only where the bars show the state of the motion. */
  paintHand() {
    const isOnMotion = this.plot.has(this.state);
    this.plot.hand.toggleAttribute("hidden", !isOnMotion);
    const told = isOnMotion ? "" : " The bars show the state of the sliders, which is not on this motion; “time” sets it.";
    const ofBase = this.state.base ? " In the motion the base stands still, in the orientation that it has." : "";
    byId("plot-words").textContent = this.plot.words() + ofBase + told;
  }

  retime() {
    const seconds = Math.round(100 * 10 ** Number(byId("duration").value)) / 100;
    byId("seconds").textContent = `${seconds.toFixed(2)} s`;
    byId("duration").setAttribute("aria-valuetext", `${seconds} s`);
    this.trajectory = new Trajectory(this.from, this.to, seconds, structuredClone(this.state.base));
    this.plot.set(this.trajectory, this.wrench);
    this.paintHand();
    // the intermediates of the code belong to the state again
    this.folded.run(this.given);
  }

  goTo(time) {
    Object.assign(this.state, this.trajectory.at(time));
    this.plot.point(time);
    byId("time").value = time / this.trajectory.seconds;
    byId("time").setAttribute("aria-valuetext", `${time.toFixed(2)} s`);
    this.showSliders();
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
    const total = (of) => of.products + of.sums;
    this.most = {
      unfolded: Math.max(...cells.map((cell) => total(cell.before)), 1),
      folded: Math.max(...cells.map((cell) => total(cell.after)), 1),
    };
    const branches = this.inspection.branches();
    // a line stands before each branch
    const begins = new Set(branches.slice(1).map(([joint]) => joint));
    const edge = (joint) => (begins.has(joint) ? "branch" : null);
    // a floating base has steps of its own
    const first = this.inspection.floating ? 0 : 1;
    const columns = Array.from({ length: dof + 1 - first }, (_, index) => index + first);
    // of more joints than fit beside each other the table is as wide as it has to be, and scrolls
    this.isWide = dof > 7;
    byId("grid").classList.toggle("wide", this.isWide);
    byId("grid").style.setProperty("--joints", columns.length);
    const head = element(
      "tr",
      {},
      element("td", {}, "operations of joint"),
      ...columns.map((joint) => element("th", { scope: "col", class: edge(joint), title: joint ? this.inspection.robot.joints[joint - 1].name : this.inspection.floating.name }, joint ? String(joint) : "base")),
    );
    const ofBranch = ([joint, ...more]) => {
      const parent = this.inspection.parentOf(joint);
      const names = this.inspection.robot.joints[joint - 1].name;
      return element(
        "th",
        { scope: "colgroup", colspan: 1 + more.length, class: edge(joint), title: `from joint ${joint}, ${names}` },
        parent === 0 ? "base" : `link ${parent}`,
      );
    };
    const heads = begins.size ? [element("tr", { class: "branches" }, element("td", {}, "branch on"), first ? null : element("th", {}), ...branches.map(ofBranch)), head] : [head];
    const body = element("tbody");
    STEPS.forEach((title, index) => {
      const row = element(
        "tr",
        {},
        element(
          "th",
          { scope: "row" },
          element("span", { class: "step-number" }, String(index + 1)),
          element("span", { class: "step-letter" }, STEP_LETTERS[index]),
          element("span", { class: "step-title" }, title),
        ),
      );
      for (const joint of columns) {
        const cell = this.inspection.cell(joint, index + 1);
        const isNeeded = !cell || this.inspection.isNeeded(cell);
        const [before, after] = cell ? [total(cell.before), total(cell.after)] : [0, 0];
        const button = element(
          "button",
          {
            type: "button",
            "data-cell": `${joint}-${index + 1}`,
            tabindex: "-1",
            disabled: !cell,
            "aria-label": `${joint ? `joint ${joint}` : "base"}, step ${index + 1}, ${title}: ${before} operations, ${after} after folding`,
            title: cell ? `${before} operations, ${after} after folding${isNeeded ? "" : "; no torque needs it"}` : "no torque needs it",
          },
          element("b"),
        );
        button.counts = { unfolded: before, folded: after };
        button.isNeeded = isNeeded;
        row.append(element("td", { class: edge(joint) }, button));
      }
      body.append(row);
    });
    byId("grid").append(
      element(
        "caption",
        { class: "visually-hidden" },
        "operations of each step of each joint; a cell opens its equations",
      ),
      element("thead", {}, ...heads),
      body,
    );
  }

  /** Scrolls a wide table to the cell that is open; its first column stays in sight. */
  reachCell() {
    const [wrap, button] = [byId("grid").parentNode, byId("grid").querySelector('[aria-pressed="true"]')];
    if (!button) return;
    const [outer, inner] = [wrap, button].map((of) => of.getBoundingClientRect());
    const left = outer.left + byId("grid").querySelector("tbody th").offsetWidth;
    if (inner.left < left || inner.right > outer.right) wrap.scrollLeft += inner.left - (left + outer.right - inner.width) / 2;
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
    const text = {
      unfolded: `${told(counts.before)} before folding`,
      folded: `${told(counts.after)}; before folding ${counts.before.products}, ${counts.before.sums}`,
    };
    if (this.reduced) {
      const { products, sums } = counts.after;
      text.reduced = `${told(programs.reduced.counts.after)}; in the seven steps ${products}, ${sums}`;
    }
    byId("counts").textContent = text[this.form];
    for (const button of byId("grid").querySelectorAll("button")) {
      const isOpen = this.form !== "reduced" && button.dataset.cell === `${cell.joint}-${cell.step}`;
      button.setAttribute("aria-pressed", String(isOpen));
      button.tabIndex = button.dataset.cell === `${cell.joint}-${cell.step}` ? 0 : -1;
      const which = this.form === "unfolded" ? "unfolded" : "folded";
      const isNeedless = which === "folded" && !button.isNeeded;
      button.firstChild.textContent = button.disabled ? "" : isNeedless ? (this.isWide ? "–" : "not needed") : String(button.counts[which]);
      button.firstChild.classList.toggle("not-needed", isNeedless && !this.isWide);
      button.style.setProperty("--share", (button.counts[which] / this.most[which]).toFixed(3));
    }
    const first = this.inspection.floating ? 0 : 1;
    [...byId("table").tBodies[0].rows].forEach((row, at) => row.classList.toggle("open", at + first === cell.joint));
    this.reachCell();
    const content = this.form === "reduced" ? this.cards.reducedCode() : this.cards.cellContent(cell);
    byId("cell").replaceChildren(...content);
    if (isOther || this.arm.layers.size === 0) {
      byId("cell").scrollTop = 0;
      this.arm.layers = new Set(this.layersOf(cell.step));
      this.paintLayers();
    }
    for (const paint of this.live) paint();
    this.reading.relight();
    this.address?.later();
  }

  // ---- what is lit
}

const page = new Page(JSON.parse(byId("data").textContent));
window.rne = {
  setState: (state) => page.setState(state),
  torques: () => page.folded.run(page.given),
  total: () => page.split.total,
  parts: () => page.split,
  value: (name) => page.value(name),
  told: (name) => page.told(name),
  select: (name) => page.reading.select(name),
  view: () => viewOf(page),
  show: (view) => showView(page, view),
  address: () => addressOf(page),
  showAddress: (fragment) => page.address.show(fragment),
};
requestAnimationFrame(() =>
  requestAnimationFrame(() => {
    document.documentElement.dataset.ready = "1";
  }),
);
