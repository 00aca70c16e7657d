// The playground: a text, what the compiler says of it, and the page of the last text without a mistake.

const byId = (id) => document.getElementById(id);

/** Rest of the keyboard before a text is compiled, ms. */
const DELAY = 150;
const FIRST = "puma560";

class Playground {
  constructor(module, robots) {
    this.robots = robots;
    this.frame = null;
    this.page = null;
    this.title = "";
    this.editor = new Editor(() => this.later());
    this.compiler = new Compiler(module, byId("worker").textContent, (said, asked) => this.answered(said, asked));
    for (const { name, title } of robots) byId("robots").append(new Option(title, name));
    byId("robots").addEventListener("change", () => this.choose(byId("robots").value));
    byId("fold").addEventListener("click", () => {
      const isShown = byId("fold").getAttribute("aria-pressed") !== "true";
      byId("fold").setAttribute("aria-pressed", String(isShown));
      byId("editor").hidden = !isShown;
    });
    byId("link").addEventListener("click", () => this.copyLink());
    byId("save-text").addEventListener("click", () => this.save(this.editor.text, "yaml", "application/yaml"));
    byId("save-page").addEventListener("click", () => this.save(this.page, "html", "text/html"));
    byId("messages").addEventListener("click", (event) => {
      const button = event.target.closest("button");
      if (button) this.editor.goTo(Number(button.dataset.goto));
    });
    window.addEventListener("message", ({ source, data }) => this.told(source, data));
    window.addEventListener("hashchange", () => { if (location.hash !== this.fragment) this.open(); });
    this.open();
  }

  /** Takes the text of the address. */
  async open() {
    let text = null;
    let problem = "";
    try {
      text = await textOf(location.hash, this.robots);
    } catch (error) {
      problem = error.message;
    }
    this.problem = problem;
    this.fragment = location.hash;
    this.view = this.asked = viewOfFragment(location.hash);
    this.take(text ?? this.robots.find(({ name }) => name === FIRST).text);
  }

  choose(name) {
    const robot = this.robots.find((one) => one.name === name);
    if (!robot) {
      this.tellRobot();
      return;
    }
    // the way back in the browser leads to the text that was here
    history.pushState(null, "", location.hash);
    this.view = this.asked = "";
    this.take(robot.text);
  }

  /** Takes another text as a whole. */
  take(text) {
    this.editor.set(text);
    this.compile(true);
  }

  later() {
    clearTimeout(this.timer);
    this.problem = "";
    this.timer = setTimeout(() => this.compile(false), DELAY);
  }

  compile(isOther) {
    clearTimeout(this.timer);
    this.tellRobot();
    this.tell("busy", "compiling");
    this.compiler.ask({ text: this.editor.text.replace(/^\uFEFF/, ""), isOther: isOther || Boolean(this.compiler.asked?.isOther) });
    this.address();
  }

  /** The menu says whose text this is. */
  tellRobot() {
    byId("robots").value = this.robots.find(({ text }) => text === this.editor.text)?.name || "";
  }

  /** Writes the text into the address. */
  async address() {
    const { text } = this.editor;
    const shipped = this.robots.find((robot) => robot.text === text);
    const ofText = shipped ? `#robot=${shipped.name}` : await fragmentOf(text);
    if (text !== this.editor.text) return;
    const fragment = this.view ? `${ofText}&${this.view}` : ofText;
    this.fragment = fragment;
    history.replaceState(null, "", fragment);
  }

  answered(said, { text, isOther }) {
    // the text has changed since: its own answer comes
    if (text !== this.editor.text.replace(/^\uFEFF/, "")) return;
    if (said.failed) {
      this.list([{ severity: "error", line: null, message: `the compiler stopped: ${said.failed}. This is a mistake of its own; please report it with this text.`, help: null }]);
      this.stale();
      return;
    }
    this.list(said.diagnostics);
    const errors = said.diagnostics.filter(({ severity }) => severity === "error").length;
    if (said.page === undefined) {
      this.stale(errors);
      return;
    }
    this.milliseconds = said.milliseconds;
    this.page = said.page;
    byId("save-page").disabled = false;
    this.show(said.page, isOther);
    const remarks = said.diagnostics.length;
    const also = remarks ? `, ${remarks} remark${remarks > 1 ? "s" : ""}` : "";
    this.tell("good", `compiled in ${Math.round(said.milliseconds)} ms${also}${this.problem ? `; ${this.problem}` : ""}`);
  }

  stale(errors = 1) {
    if (this.page) byId("shown").dataset.state = "stale";
    const last = this.page ? "; shown is the last text without one" : "";
    this.tell("wrong", `${errors} mistake${errors > 1 ? "s" : ""}${last}${this.problem ? `; ${this.problem}` : ""}`);
  }

  tell(is, text) {
    byId("status").dataset.is = is;
    byId("status").textContent = text;
    document.documentElement.dataset.is = is;
  }

  /** What the compiler says, below the text and in it. */
  list(diagnostics) {
    // marks are found by the index of their diagnostic, so those without a place come last
    const all = [...diagnostics.filter(({ line }) => line !== null), ...diagnostics.filter(({ line }) => line === null)];
    this.editor.mark(all);
    byId("messages").replaceChildren(...all.map((found, index) => {
      const make = (tag, kind, text) => {
        const of = document.createElement(tag);
        of.className = kind;
        of.textContent = text;
        return of;
      };
      const button = make("button", "goto", "");
      button.type = "button";
      button.dataset.goto = index;
      const place = found.line === null ? "" : `${found.line}:${found.column} `;
      button.append(make("span", "place", place), make("span", "severity", found.severity), ": ", make("span", "message", found.message));
      if (found.label) button.append(make("span", "label", ` (${found.label})`));
      if (found.help) button.append(make("span", "help", found.help));
      const item = make("li", found.severity, "");
      item.append(button);
      return item;
    }));
    this.editor.reveal();
  }

  /** Puts the page of an arm in the place of the one before, as that was looked at. */
  show(page, isOther) {
    const next = document.createElement("iframe");
    next.title = "the arm, its equations, its code and its torques";
    // an origin of its own: no script of the page reaches this document, its address, or other pages of this site
    next.sandbox = "allow-scripts";
    next.srcdoc = `${page}<script>${byId("bridge").textContent}<\/script>`;
    next.className = "next";
    this.next?.remove();
    this.next = next;
    this.isOther = isOther;
    byId("shown").append(next);
  }

  /** What the frames tell: bridge.js. */
  told(source, said) {
    const { frame, next, isOther } = this;
    if (source === next?.contentWindow) {
      if (said.title !== undefined) {
        next.dataset.title = said.title;
        if (frame) frame.contentWindow.postMessage({ ask: "view" }, "*");
        else this.put();
      }
      if (said.shown) this.put();
      this.follow(next, said);
    } else if (source === frame?.contentWindow) {
      const { view } = said;
      // for a next page that is not loaded yet the view is asked once more
      if (view !== undefined && next?.dataset.title !== undefined) {
        if (view) next.contentWindow.postMessage({ show: isOther ? { ...view, kinds: null } : view }, "*");
        else this.put();
      }
      this.follow(frame, said);
    }
  }

  /** The next page takes the place of the one before. */
  put() {
    const { next } = this;
    this.frame?.remove();
    this.frame = next;
    this.next = null;
    next.className = "";
    if (this.asked) next.contentWindow.postMessage({ address: this.asked }, "*");
    this.asked = "";
    byId("shown").dataset.state = "good";
    document.title = `${next.dataset.title} – rne playground`;
    this.colour(next.dataset.theme);
    document.documentElement.dataset.shown = String(Number(document.documentElement.dataset.shown || 0) + 1);
  }

  /** A frame is as high as its page where the screen is narrow; its colours are those of the whole. */
  follow(frame, { height, theme, address }) {
    if (typeof address === "string" && frame === this.frame && !this.asked) {
      this.view = address.replace(/^#/, "");
      this.address();
    }
    if (height !== undefined) frame.style.setProperty("--height", `${Number(height)}px`);
    if (theme === undefined) return;
    frame.dataset.theme = theme;
    if (frame === this.frame) this.colour(theme);
  }

  colour(theme) {
    if (theme) document.documentElement.dataset.theme = theme;
    else delete document.documentElement.dataset.theme;
  }

  async copyLink() {
    await this.address();
    try {
      await navigator.clipboard.writeText(location.href);
      this.tell(byId("status").dataset.is, `link copied: ${location.href.length} characters`);
    } catch {
      this.tell(byId("status").dataset.is, "the link stands in the address bar");
    }
  }

  /** Saves a text as a file. */
  save(text, extension, type) {
    const name = /^name:\s*([A-Za-z_]\w*)/m.exec(this.editor.text)?.[1] || "my_arm";
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([text], { type: `${type};charset=utf-8` }));
    link.download = `${name}.${extension}`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }
}

async function begin() {
  if (!window.DecompressionStream || !window.WebAssembly) throw new Error("this browser is too old: it has no DecompressionStream or no WebAssembly (since 2023 all have them)");
  const [module, files] = await Promise.all([unpacked(byId("module").textContent, "gzip"), unpacked(byId("files").textContent, "gzip")]);
  window.playground = new Playground(module, JSON.parse(new TextDecoder().decode(files)));
}

begin().catch((error) => {
  byId("status").dataset.is = "wrong";
  byId("status").textContent = error.message;
});
