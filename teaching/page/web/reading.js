// Reading: what is pointed at or chosen, everything that is lit with it, and what is said of it.

class Reading {
  constructor(page) {
    this.page = page;
    // a click keeps what pointing shows
    this.pinned = null;
    this.pointed = null;
    // a hand has no Escape
    this.letGo = element("button", { type: "button", class: "let-go", "aria-label": "let it go" }, "×");
    this.letGo.addEventListener("click", () => this.release());
  }

  release() {
    this.pinned = this.pointed = null;
    this.relight();
  }

  /** Everything that belongs to a selection: names, arrows, places on the arm, a cell. */
  related(selection) {
    if (!selection) return { names: [] };
    if (selection.arrow) {
      const { quantity, joint, carries } = arrowOfKey(selection.arrow);
      const nameOf = (axis) => this.page.inspection.nameOf(quantity, joint, axis, carries);
      const names = [null, ...AXES].map(nameOf).filter(Boolean);
      const cell = names.map((name) => this.page.inspection.owner(name)?.cell).find(Boolean);
      const first = this.page.inspection.meaning(names[0]);
      return { names, arrows: [selection.arrow], cell, frame: first && this.page.inspection.axes(first) };
    }
    const names = selection.tree !== undefined ? namesIn(selection.tree) : [selection.name];
    if (selection.tree !== undefined) {
      const all = names.map((name) => this.related({ name }));
      const own = this.statementOf(selection.tree);
      return { names: own ? [...names, own.name] : names, arrows: all.flatMap((one) => one.arrows || []) };
    }
    const { name } = selection;
    const meaning = this.page.inspection.meaning(name);
    if (!meaning || this.page.form === "reduced") {
      const own = this.page.inspection.programs.reduced?.names[name];
      const isJoint = own && ["position", "rate", "rate_dot", "torque", "sine", "cosine"].includes(own[0]);
      return { names: [name], axis: isJoint ? own[1] : null };
    }
    const owner = this.page.inspection.owner(name);
    const told = { names: [name], cell: owner?.cell };
    if (owner && owner.name !== name) told.names.push(owner.name);
    const alias = this.page.cards.alias(name);
    if (alias !== name) told.names.push(alias.replace(/^-/, ""));
    const { quantity, joint, component, of } = meaning;
    const isVector = of.axes && component && component.length === 1;
    if (isVector) {
      told.arrows = [keyOfArrow(meaning)];
      told.component = AXES.indexOf(component);
      told.frame = this.page.inspection.axes(meaning);
    } else if (of.drawn === "axis") {
      told.axis = joint;
      if (AXIAL.includes(quantity)) told.arrows = [keyOfArrow(meaning)];
    } else if (of.drawn === "frame") {
      told.frame = joint;
    } else if (of.drawn === "link") {
      told.link = joint;
    }
    return told;
  }

  /** The statement that computes a term by itself, if there is one. */
  statementOf(tree) {
    const name = typeof tree === "string" ? tree : markOf(tree).name;
    return (name && this.page.inspection.statements.get(name.replace(/^-/, ""))) || null;
  }

  /** Shows what is pointed at, or else what was chosen last. */
  relight() {
    const selection = this.pointed || this.pinned;
    for (const old of document.querySelectorAll(".lit:not(.arrow)")) old.classList.remove("lit");
    const related = this.related(selection);
    this.page.arm.light(related);
    for (const name of related.names) {
      for (const node of document.querySelectorAll(
        `[data-name="${CSS.escape(name)}"], [data-component="${CSS.escape(name)}"]`,
      ))
        node.classList.add("lit");
    }
    if (selection && selection.term) selection.term.classList.add("lit");
    if (related.cell)
      document.querySelector(`[data-cell="${related.cell.joint}-${related.cell.step}"]`)?.classList.add("lit");
    this.readout();
  }

  /** What is pointed at, in words and numbers. */
  readout() {
    const root = document.querySelector("[data-readout]");
    const selection = this.pointed || this.pinned;
    root.classList.toggle("chosen", Boolean(selection));
    // away from what is pointed at
    const cell = byId("cell").getBoundingClientRect();
    root.dataset.at = this.pointerY > cell.top + cell.height / 2 && this.pointerY < cell.bottom ? "top" : "bottom";
    this.tell(root, selection);
    if (selection) root.append(this.letGo);
  }

  tell(root, selection) {
    const line = (kind, ...content) => element("span", { class: `readout-${kind}` }, ...content);
    if (!selection) {
      root.replaceChildren(
        line(
          "hint",
          "Point at a symbol, a line of code or an arrow; Tab and arrow keys do the same. " +
            "A click keeps it, Escape lets it go. “Exercise” above checks numbers of your own.",
        ),
      );
      return;
    }
    if (selection.tree !== undefined) {
      const isGone = this.page.form !== "unfolded" && this.page.set.isGone(selection.tree);
      const isHidden = namesIn(selection.tree).some((name) => this.page.hides(name));
      root.replaceChildren(
        line("name", `${selection.sign < 0 ? "−" : ""} ${codeOf(selection.tree)}`),
        line("value", isHidden ? "?" : short(selection.sign * this.page.equations.evaluate(selection.tree))),
        line("meaning", isGone ? `gone: ${this.page.set.why(selection.tree)}` : this.inTerm(selection.tree)),
        ...(isGone ? [] : [line("code", this.whereIs(selection.tree))]),
      );
      return;
    }
    if (selection.arrow) {
      const arrow = this.page.arm.arrows.get(selection.arrow);
      if (!arrow) return;
      const names = this.related(selection).names;
      const unitOf = unitText(this.page.inspection.unitOf(arrow.quantity, arrow.joint));
      root.replaceChildren(
        line("name", names.join(", ")),
        line("value", `(${names.map((name) => this.page.shown(name, this.page.told(name))).join(", ")}) ${unitOf}`),
        line(
          "meaning",
          this.page.inspection.words(arrow),
          `; ${this.ofWhat(arrow)}${this.axesWords(this.page.inspection.meaning(names[0]))}`,
        ),
        ...(arrow.quantity === "d" ? [line("meaning", this.inWorld(arrow.joint))] : []),
      );
      return;
    }
    const { name } = selection;
    const isReduced = this.page.form === "reduced" && this.page.reduced && this.page.reduced.has(name);
    const meaning = this.page.inspection.meaning(name);
    if (isReduced || !meaning) {
      const own = this.page.inspection.programs.reduced?.names[name];
      if (!own) return;
      const of = this.page.inspection.quantities[own[0]];
      const statement = this.page.inspection.programs.reduced.statements.find((one) => one.name === name);
      root.replaceChildren(
        line("name", name),
        line("value", withUnit(this.page.reduced.value(name), of.units[0])),
        line("meaning", `${of.meaning}; ${own[1]}`),
        line("code", statement ? this.page.cards.textOf(statement) : "an argument"),
      );
      return;
    }
    const unitOf = this.page.inspection.unit(name);
    const isHidden = this.page.hides(name);
    const statement = this.page.inspection.statements.get(name);
    const owner = this.page.inspection.owner(name);
    const value = this.page.told(name);
    const code = statement ? this.page.cards.textOf(statement) : this.withoutStatement(name, owner);
    const what = line("value", isHidden ? `? ${unitText(unitOf)}` : withUnit(value, unitOf));
    what.title = isHidden ? "" : full(value);
    root.replaceChildren(
      line("name", math("math", {}, this.page.set.symbol(name, false)), element("code", {}, name)),
      what,
      line(
        "meaning",
        `${this.page.inspection.words(meaning)}${meaning.part ? ", a term of it" : ""}`,
        `; ${this.ofWhat(meaning)}${this.axesWords(meaning)}`,
      ),
      // a reason is read to its end, code stays a line
      line(statement ? "code" : "meaning", code, isHidden ? "" : this.inCode(name, unitOf)),
      ...(meaning.quantity === "torque" && !isHidden ? [line("meaning", this.parts(meaning.joint, unitOf))] : []),
      ...(selection.why
        ? [line("why", `This term is ${selection.why.replace(/^a factor/, "left out as a factor")}`)]
        : []),
    );
  }

  /** What gravity, speed and acceleration have in a torque. */
  parts(joint, unitOf) {
    const { split, wrench } = this.page;
    const told = PARTS.filter(([part]) => part !== "tip" || [...wrench.f, ...wrench.n].some((of) => of !== 0)).map(
      ([part, meaning]) => `${meaning} ${short(split[part][joint - 1])}`,
    );
    return `of it ${told.join(", ")} ${unitText(unitOf)}`;
  }

  /** The names of a term, in words. */
  inTerm(tree) {
    const words = [...new Set(namesIn(tree))].slice(0, 3).map((name) => {
      const meaning = this.page.inspection.meaning(name);
      return meaning ? `${name}: ${this.page.inspection.words(meaning)}` : name;
    });
    return words.join("; ") || "a number";
  }

  /** Where the code computes a term. */
  whereIs(tree) {
    const { fold, name } = markOf(tree);
    if (fold === "shared" && name) return `computed before as ${name}`;
    const statement = this.page.form === "unfolded" ? null : this.statementOf(tree);
    return statement ? this.page.cards.textOf(statement) : "a term of the statement";
  }

  ofWhat({ of, joint, quantity }) {
    if (quantity === "joint_force" && joint <= this.page.inspection.dof) return `drawn at joint ${joint}`;
    if (joint === 0) return "base";
    return joint > this.page.inspection.dof ? "tip" : `${of.drawn === "link" || of.axes ? "link" : "joint"} ${joint}`;
  }

  axesWords(meaning) {
    if (!meaning) return "";
    const { axes } = this.page;
    const { quantity, joint } = meaning;
    if (meaning.component?.length === 2) {
      if (quantity === "inertia") return `, in ${axes.words(joint)}`;
      return axes.isOther(meaning.name) ? ", between the lecture's axes" : "";
    }
    const frame = this.page.inspection.axes(meaning);
    return frame === null ? "" : `, in ${axes.words(frame, meaning.part ? "link" : axes.kind)}`;
  }

  /** Where the centre of mass of a link is. */
  inWorld(joint) {
    return `centre of mass of link ${joint}, in the world: (${this.page.arm.pose.coms[joint].map(short).join(", ")}) m`;
  }

  /** What the code computes, where a value is told in other axes. */
  inCode(name, unitOf) {
    if (!this.page.axes.isOther(name)) return "";
    return ` (in link axes, ${withUnit(this.page.value(name), unitOf)})`;
  }

  withoutStatement(name, owner) {
    if (Object.hasOwn(this.page.given, name)) return "an argument of the function";
    if (this.page.inspection.constants.has(name)) return "a number of the table, in the code";
    if (!owner) return this.page.folded.has(name) ? "evaluated with its angle before all steps" : "";
    const { became } = owner;
    return (
      {
        same: `the same as ${became.name}`,
        constant: `a number: ${became.why || "of the table"}`,
        inside: "inside the statement that uses it",
        unused: "no torque needs it",
        computed: "computed",
      }[became.kind] || ""
    );
  }

  /** Chooses a name, an arrow or a term: it stays lit, and its cell opens. Whether there is such a one. */
  select(what) {
    const selection = typeof what === "string" ? { name: what } : what;
    const isKnown =
      selection.tree !== undefined || selection.arrow
        ? true
        : this.page.inspection.meaning(selection.name) !== null ||
          Object.hasOwn(this.page.inspection.programs.reduced?.names || {}, selection.name);
    if (!isKnown) return false;
    this.pointed = null;
    this.pinned = selection;
    const { cell } = this.related(selection);
    if (cell && cell !== this.page.cell && this.page.form !== "reduced") this.page.open(cell);
    this.relight();
    if (selection.name || selection.arrow) {
      const target = document.querySelector(
        `[data-component="${CSS.escape(this.related(selection).names.at(-1) || "")}"]`,
      );
      if (target && !byId("cell").contains(document.activeElement)) {
        const box = byId("cell");
        target.closest("details")?.setAttribute("open", "");
        const reach = () => {
          box.scrollTop += target.getBoundingClientRect().top - box.getBoundingClientRect().top - 8;
        };
        // what had not been laid out has its height only when it is in sight
        const settle = (times) => {
          reach();
          if (times > 0) requestAnimationFrame(() => settle(times - 1));
        };
        settle(3);
      }
    }
    byId("said").textContent = document.querySelector("[data-readout]").textContent;
    return true;
  }

  /** What stands under a node: a term, a name or an arrow. */
  selectionAt(node) {
    const found =
      node instanceof Element ? node.closest("[data-name], [data-arrow], [data-com], .term, .struck, [data-component]") : null;
    if (!found) return null;
    if (found.dataset.arrow) return { arrow: found.dataset.arrow };
    // a centre of mass is at the end of its d
    if (found.dataset.com) return { arrow: `d-${found.dataset.com}` };
    const why = found.closest("[data-why]")?.dataset.why;
    if (found.dataset.name) return { name: found.dataset.name, why };
    if (found.tree !== undefined) return { tree: found.tree, sign: found.sign, term: found };
    return { name: found.dataset.component };
  }

  listen() {
    const point = (selection) => {
      const key = (of) => of && (of.term || of.arrow || `${of.name} ${of.why}`);
      if (key(selection) === key(this.pointed)) return;
      this.pointed = selection;
      this.relight();
    };
    document.addEventListener("pointerover", (event) => {
      this.pointerY = event.clientY;
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
        if (this.page.form === "reduced") document.querySelector('[data-switch="folded"]').click();
        this.pinned = null;
        this.page.open(this.page.inspection.cell(joint, step));
        this.page.update();
        return;
      }
      if (event.target.closest?.("input, textarea, summary")) return;
      const selection = this.selectionAt(event.target);
      if (selection) this.select(selection);
    });
    document.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => {
      this.page.arm.measure();
      this.page.arm.draw(this.page.state.q);
      this.page.plot.draw();
    }).observe(byId("arm"));
  }

  key(event) {
    if (event.key === "Escape") {
      this.release();
      return;
    }
    const { target } = event;
    if (target.matches("input, textarea")) return;
    if (
      (event.key === "Enter" || event.key === " ") &&
      target.matches(".pick, [data-arrow], [data-com], [data-component]") &&
      !target.matches("button")
    ) {
      event.preventDefault();
      this.select(this.selectionAt(target));
      return;
    }
    const way = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowDown: [0, 1], ArrowUp: [0, -1] }[event.key];
    if (!way) return;
    if (target.matches("[data-cell]")) {
      const [joint, step] = target.dataset.cell.split("-").map(Number);
      const at = (times) => document.querySelector(`[data-cell="${joint + times * way[0]}-${step + times * way[1]}"]`);
      let times = 1;
      while (at(times)?.disabled) times += 1;
      const next = at(times);
      if (next) {
        event.preventDefault();
        next.focus();
      }
      return;
    }
    // inside a component the arrow keys go from piece to piece, up and down to the next component
    const card = target.closest("[data-component], .listing");
    if (!card) return;
    if (way[1] && card.matches("[data-component]")) {
      const cards = [...byId("cell").querySelectorAll("[data-component]")].filter(
        (other) => other.offsetParent !== null,
      );
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
