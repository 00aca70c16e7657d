// The text with its colours, its line numbers and what is underlined in it. The text is that of a <textarea>, whose own
// letters are invisible; a layer behind it has the same letters in colours.

/** The start of each line of a text, in units of JavaScript's strings. */
function lineStarts(text) {
  const starts = [0];
  for (let at = text.indexOf("\n"); at >= 0; at = text.indexOf("\n", at + 1)) starts.push(at + 1);
  return starts;
}

/** Where a line and a column of the compiler are in a text: lines and columns from 1, columns in characters. */
function offsetOf(text, starts, line, column) {
  const start = starts[Math.min(line, starts.length) - 1];
  const end = line < starts.length ? starts[line] - 1 : text.length;
  // a character beyond the first plane is two units
  const characters = Array.from(text.slice(start, end)).slice(0, column - 1);
  return start + characters.join("").length;
}

/** Pieces of a line of YAML with their kinds: keys, numbers, comments. */
function* piecesOf(line) {
  const pattern = /(#.*$)|("(?:[^"\\]|\\.)*"|'[^']*')|([A-Za-z_][\w-]*)(?=\s*:(?:\s|$))|(?<![\w.])([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)(?![\w.])/g;
  let at = 0;
  for (const found of line.matchAll(pattern)) {
    // a hash inside a word begins no comment
    if (found[1] && found.index > 0 && !/\s/.test(line[found.index - 1])) continue;
    if (found.index > at) yield ["", line.slice(at, found.index)];
    yield [found[1] ? "comment" : found[2] ? "quoted" : found[3] ? "key" : "number", found[0]];
    at = found.index + found[0].length;
  }
  if (at < line.length) yield ["", line.slice(at)];
}

class Editor {
  /** `changed` is called when the reader has changed the text. */
  constructor(changed) {
    this.area = byId("text");
    this.marks = [];
    this.area.addEventListener("input", () => {
      // places are those of another text: what stands before the change stays underlined until the answer comes
      this.paint();
      changed();
    });
  }

  get text() {
    return this.area.value;
  }

  set(text) {
    this.area.value = text;
    this.marks = [];
    this.paint();
    byId("scroller").scrollTo(0, 0);
    this.area.setSelectionRange(0, 0);
  }

  /** Underlines what diagnostics name. */
  mark(diagnostics) {
    const starts = lineStarts(this.text);
    this.marks = diagnostics.filter(({ line }) => line !== null).map((found) => {
      const from = offsetOf(this.text, starts, found.line, found.column);
      const to = offsetOf(this.text, starts, found.end_line, found.end_column);
      return { from, to: Math.max(to, from), severity: found.severity, line: found.line };
    });
    this.area.setAttribute("aria-invalid", String(diagnostics.some(({ severity }) => severity === "error")));
    this.paint();
  }

  /** Keeps in sight what messages would hide: the line that is being typed, or else the first mistake. */
  reveal() {
    const box = byId("scroller");
    const isTyped = document.activeElement === this.area;
    const at = isTyped ? this.area.selectionStart : this.marks.find(({ severity }) => severity === "error")?.from;
    if (at === undefined) return;
    const line = byId("gutter").children[this.text.slice(0, at).split("\n").length - 1];
    const [outer, inner] = [box.getBoundingClientRect(), line.getBoundingClientRect()];
    box.scrollTop += Math.min(0, inner.top - outer.top) || Math.max(0, inner.bottom - outer.bottom + inner.height);
  }

  /** Selects what the diagnostic of an index names and shows it. */
  goTo(index) {
    const mark = this.marks[index];
    this.area.focus({ preventScroll: true });
    if (!mark) return;
    this.area.setSelectionRange(mark.from, mark.to);
    const [box, at] = [byId("scroller"), byId("ink").querySelector(`[data-mark="${index}"]`)];
    if (!at) return;
    const [outer, inner] = [box.getBoundingClientRect(), at.getBoundingClientRect()];
    box.scrollTop += inner.top - outer.top - outer.height / 3;
    box.scrollLeft += Math.min(0, inner.left - outer.left - 64) || Math.max(0, inner.right - outer.right + 64);
  }

  paint() {
    const { text } = this;
    const starts = lineStarts(text);
    const ink = document.createDocumentFragment();
    const rank = { error: 2, warning: 1, note: 0 };
    // how far the key is indented whose lines of prose these are
    let prose = null;
    starts.forEach((start, number) => {
      let at = start;
      const end = number + 1 < starts.length ? starts[number + 1] - 1 : text.length;
      const line = text.slice(start, end);
      if (line.trim() && prose !== null && /^ */.exec(line)[0].length <= prose) prose = null;
      for (const [kind, piece] of prose === null ? piecesOf(line) : [["", line]]) {
        ink.append(...this.marked(kind, piece, at));
        at += piece.length;
      }
      if (prose === null && /:\s+[|>][-+\d]*\s*(#.*)?$/.test(line)) prose = /^ */.exec(line)[0].length;
      ink.append(...this.behind(end), "\n");
    });
    byId("ink").replaceChildren(ink);
    const worst = new Map();
    for (const { line, severity } of this.marks) {
      if (!worst.has(line) || rank[severity] > rank[worst.get(line)]) worst.set(line, severity);
    }
    byId("gutter").replaceChildren(...starts.map((_, number) => {
      const of = document.createElement("span");
      of.textContent = String(number + 1);
      if (worst.has(number + 1)) of.className = worst.get(number + 1);
      return of;
    }));
  }

  /** A piece of a line, cut where something that is underlined begins or ends. */
  marked(kind, piece, at) {
    const cuts = new Set([at, at + piece.length]);
    for (const { from, to } of this.marks) for (const cut of [from, to]) if (cut > at && cut < at + piece.length) cuts.add(cut);
    const ends = [...cuts].sort((a, b) => a - b);
    return ends.slice(1).map((end, index) => {
      const start = ends[index];
      const found = this.marks.findIndex(({ from, to }) => from <= start && end <= to && from < to);
      const of = document.createElement("span");
      of.textContent = piece.slice(start - at, end - at);
      if (kind) of.className = `of-${kind}`;
      if (found >= 0) this.underline(of, found);
      return of;
    });
  }

  /** What names no letter, as the end of a line, is underlined as a blank. */
  behind(end) {
    return this.marks.flatMap(({ from, to }, index) => {
      if (from !== end || (to > from && this.text[from] !== "\n")) return [];
      const of = document.createElement("span");
      of.textContent = " ";
      this.underline(of, index);
      return [of];
    });
  }

  underline(of, index) {
    of.dataset.mark = index;
    of.classList.add("mark", this.marks[index].severity);
  }
}
