// Equations as MathML and code as text, both made of pieces that know their names.

const MATHML = "http://www.w3.org/1998/Math/MathML";

/** An element of HTML: attributes whose value is null or false are left out; children are nodes or texts. */
function element(tag, attributes = {}, ...children) {
  return filledElement(document.createElement(tag), attributes, children);
}

/** An element of MathML. */
function math(tag, attributes = {}, ...children) {
  return filledElement(document.createElementNS(MATHML, tag), attributes, children);
}

function filledElement(of, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value !== null && value !== undefined && value !== false) of.setAttribute(name, value === true ? "" : value);
  }
  of.append(...children.flat().filter((child) => child !== null));
  return of;
}

const DOTS = { "\u0304": "¯", "\u0307": "˙", "\u0308": "¨" };

/**
 * A letter such as ω̈ or (Iω). Dots are scripts above the letter and no accents: with a font such as DejaVu Math TeX Gyre
 * an accent lies on the letter, and q̇ looks like q.
 */
function letter(text) {
  const pieces = [];
  for (const c of text.normalize("NFD")) {
    if (DOTS[c] && pieces.length) {
      pieces.push(math("mover", {}, pieces.pop(), math("mo", { stretchy: "false", scriptlevel: "+0" }, DOTS[c])));
    } else if (/[()×]/.test(c)) {
      pieces.push(math("mo", { stretchy: "false", ...(c === "×" ? {} : { lspace: "0", rspace: "0" }) }, c));
    } else {
      pieces.push(math("mi", {}, c));
    }
  }
  return pieces.length === 1 ? pieces[0] : math("mrow", {}, ...pieces);
}

/** The index of a name: 2x, or 1,2 x for what link 1 exerts on link 2; `text` is the number. */
function index({ component }, text) {
  const of = [];
  const [first, second] = text.split(",");
  of.push(math("mn", {}, first));
  if (second) {
    of.push(math("mo", { separator: "true", lspace: "0", rspace: "0" }, ","), math("mn", {}, second));
  }
  if (component) of.push(math("mspace", { width: "0.12em" }), math("mi", {}, component));
  return math("mrow", {}, ...of);
}

class Typesetter {
  constructor(inspection) {
    this.inspection = inspection;
  }

  /** A name as a symbol that can be pointed at. */
  symbol(name, isPickable = true) {
    const meaning = this.inspection.meaning(name);
    if (!meaning) return math("mi", {}, name);
    let base = letter(meaning.of.letter);
    // the vector of the next joint in the axes of this one
    if (meaning.quantity.startsWith("child")) base = math("mrow", {}, base, math("mo", {}, "′"));
    const symbol = math("msub", {}, base, index(meaning, this.inspection.indexText(meaning)));
    if (!isPickable) return symbol;
    return math(
      "mrow",
      { "data-name": name, class: "pick", tabindex: "-1", role: "button", "aria-label": this.label(name) },
      symbol,
    );
  }

  /** A name as a screen reader should say it. */
  label(name) {
    const meaning = this.inspection.meaning(name);
    if (!meaning) return name;
    const component = meaning.component ? `, ${meaning.component}` : "";
    return `${name}: ${this.inspection.words(meaning)}, ${meaning.joint}${component}`;
  }

  /** Whether a term is zero for this robot whatever its state is. */
  isGone(tree) {
    if (!Array.isArray(tree)) return this.inspection.constant(tree) === 0;
    const parts = operands(tree);
    const { fold } = markOf(tree);
    if (fold === "cancelled") return true;
    switch (tree[0]) {
      case "*":
        return fold === "zero" || parts.some((part) => this.isGone(part));
      case "/":
      case "neg":
        return this.isGone(parts[0]);
      case "+":
      case "-":
        return parts.every((part) => this.isGone(part));
      default:
        return false;
    }
  }

  /** Why a term is gone, in words. */
  why(tree) {
    if (typeof tree === "string") {
      const component = this.inspection.components.get(tree);
      return component && component.became.why ? component.became.why : "";
    }
    if (!Array.isArray(tree)) return "it is a number";
    const mark = markOf(tree);
    if (mark.fold === "cancelled") return "its terms cancel";
    const ofParts = () =>
      operands(tree)
        .map((part) => (this.isGone(part) ? this.why(part) : ""))
        .filter(Boolean);
    // a sum vanishes because each of its terms does, each for its own reason
    if (isSum(tree) && this.isGone(tree)) return [...new Set(ofParts().flatMap((why) => why.split("; ")))].join("; ");
    const why = this.inspection.reasons[mark.why];
    if (why) return why === "constants" ? this.constants(tree) : why;
    return ofParts()[0] || "";
  }

  /** The numbers in the place of names that fold a tree. */
  constants(tree) {
    const { inspection } = this;
    const told = namesIn(tree).filter((name) => !Number.isNaN(inspection.constant(name)));
    return [...new Set(told)].map((name) => `${inspection.inLetters(name)} = ${exact(inspection.constant(name))}`).join(", ");
  }

  /** What folded away in a tree: each largest term, what is left of it, and why. */
  gone(tree) {
    if (this.isGone(tree)) {
      // terms that vanish for different reasons stand apart
      if (isSum(tree) && markOf(tree).fold !== "cancelled" && this.why(tree).includes("; "))
        return operands(tree).flatMap((part) => this.gone(part));
      return typeof tree === "number" ? [] : [{ tree, left: "0", why: this.why(tree) }];
    }
    if (!Array.isArray(tree)) return [];
    const mark = markOf(tree);
    const parts = operands(tree);
    if (mark.fold === "shared") return [{ tree, left: mark.name || "the same", why: "computed before" }];
    if (mark.fold === "constant") return [{ tree, left: null, why: this.constants(tree) }];
    const own = [];
    const unit = this.unitFactor(tree);
    if (unit !== null)
      own.push({ tree, left: parts[1 - unit], sign: this.inspection.constant(parts[unit]), why: this.why(tree) });
    return [...own, ...parts.flatMap((part, at) => (at === unit ? [] : this.gone(part)))];
  }

  /** Which factor of a product is 1 or -1 and so needs no multiplication: 0, 1 or null. */
  unitFactor(tree) {
    if (tree[0] !== "*" || markOf(tree).fold !== "one") return null;
    const parts = operands(tree);
    const at = [1, 0].find((of) => Math.abs(this.inspection.constant(parts[of])) === 1);
    return at === undefined ? null : at;
  }

  /**
   * A tree as MathML. `leaf(name)` sets a name, `isStruck` whether what folded is struck through; terms of the sum at
   * the root can be pointed at, each with its tree.
   */
  tree(tree, { leaf, isStruck, isRoot = true }) {
    // what is struck as a whole has no strokes inside
    const within = (part) => ({ leaf, isStruck: isStruck && !this.isGone(part), isRoot: false });
    const inner = isRoot && tree[0] === "*" ? within(tree) : { leaf, isStruck, isRoot: false };
    const set = (part, least) => {
      const of = this.tree(part, inner);
      return rank(part, this.inspection) < least ? math("mrow", {}, paren("("), of, paren(")")) : of;
    };
    const struck = (part, node) => {
      if (!isStruck || !this.isGone(part)) return node;
      return this.strike(node, part);
    };
    if (typeof tree === "number") return number(exact(tree));
    if (typeof tree === "string") return leaf(tree);
    const parts = operands(tree);
    const mark = markOf(tree);
    switch (tree[0]) {
      case "+":
      case "-": {
        const chain = isRoot
          ? summands(tree)
          : [
              { sign: 1, part: parts[0] },
              { sign: tree[0] === "+" ? 1 : -1, part: parts[1] },
            ];
        const row = chain.map(({ sign, part }, at) => {
          const operator =
            at === 0 && sign > 0 ? null : math("mo", { form: at === 0 ? "prefix" : "infix" }, sign > 0 ? "+" : "−");
          const isBare = isSum(part) ? at === 0 && !isRoot : at === 0 || rank(part, this.inspection) >= 1;
          const node = isBare
            ? this.tree(part, within(part))
            : math("mrow", {}, paren("("), this.tree(part, within(part)), paren(")"));
          const piece = struck(part, math("mrow", {}, operator, node));
          return isRoot ? this.term(piece, part, sign) : piece;
        });
        return math("mrow", {}, ...row);
      }
      case "*": {
        const unit = this.unitFactor(tree);
        const factors = parts.map((part, at) => {
          const node = set(part, 2);
          if (!inner.isStruck || at !== unit) return node;
          // of a factor -1 the sign is left
          return this.inspection.constant(part) < 0 ? this.sign(node, tree) : this.strike(node, tree, "one");
        });
        const isNumeric = factors.some((factor) => factor.querySelector?.("mn.value") || factor.matches("mn"));
        const times = math("mo", isNumeric ? { lspace: "0.12em", rspace: "0.12em" } : {}, isNumeric ? "·" : "\u2062");
        const gap = isNumeric ? null : math("mspace", { width: "0.14em" });
        const row = math("mrow", {}, factors[0], times, gap, factors[1]);
        return this.marked(isRoot ? this.term(struck(tree, row), tree, 1) : row, mark, isStruck);
      }
      case "/":
        return math("mfrac", {}, this.tree(parts[0], inner), this.tree(parts[1], inner));
      case "neg":
        return math("mrow", {}, math("mo", { form: "prefix" }, "−"), set(parts[0], 1));
      case "sin":
      case "cos":
        return math(
          "mrow",
          {},
          math("mi", {}, tree[0]),
          math("mo", {}, "\u2061"),
          paren("("),
          this.tree(parts[0], inner),
          paren(")"),
        );
      default:
        return math(
          "mrow",
          {},
          math("mi", {}, tree[0]),
          paren("("),
          ...parts.flatMap((part, at) => [at ? math("mo", {}, ",") : null, this.tree(part, inner)]),
          paren(")"),
        );
    }
  }

  /** An equation as a line that breaks between its terms, which MathML by itself does not. */
  equation(left, tree, leaf, isStruck) {
    const right = this.tree(tree, { leaf, isStruck });
    // a formula as such is one thing to a screen reader; of this one the parts can be reached
    const group = { role: "group" };
    const pieces = isSum(tree) ? [...right.children] : [right];
    return element(
      "div",
      { class: "equation" },
      math("math", group, left, math("mo", { form: "infix" }, "=")),
      ...pieces.flatMap((piece) => [" ", math("math", group, piece)]),
    );
  }

  /** A term of a sum, which can be pointed at. */
  term(node, tree, sign) {
    const term = math("mrow", { class: "term pick", tabindex: "-1", role: "group" }, node);
    term.tree = tree;
    term.sign = sign;
    term.setAttribute("aria-label", codeOf(tree) + (this.isGone(tree) ? `, gone: ${this.why(tree)}` : ""));
    return term;
  }

  strike(node, tree, how = "gone") {
    const why = `${how === "one" ? "a factor of 1" : "gone"}: ${this.why(tree) || "it is zero"}`;
    const struck = math(
      "mrow",
      { class: `struck ${how} pick`, "data-why": why, tabindex: "-1", role: "group" },
      node,
    );
    struck.setAttribute("aria-label", `${codeOf(tree)}, ${why}`);
    struck.tree = tree;
    struck.sign = 1;
    return struck;
  }

  sign(node, tree) {
    return math("mrow", { class: "folded", "data-why": `a sign, no product: ${this.why(tree)}` }, node);
  }

  /** What is computed elsewhere or is never needed looks different, and is no strike. */
  marked(node, mark, isStruck) {
    if (!isStruck || !["shared", "constant", "unused"].includes(mark.fold)) return node;
    const why = {
      shared: `computed before${mark.name ? ` as ${mark.name}` : ""}`,
      constant: "constants",
      unused: "nothing that is returned needs it",
    };
    return math("mrow", { class: `folded ${mark.fold}`, "data-why": why[mark.fold] }, node);
  }

  /** A formula between vectors, such as ω2 = R2ᵀ ω1 + q̇2 e. */
  formula(text) {
    // a line of terms, which breaks between them
    const terms = [[]];
    let depth = 0;
    const pieces = text.normalize("NFD").match(/[A-Za-zα-ω][\u0300-\u036f]*(?:\d+(?:[,_]\d+)?)?ᵀ?|\d+|\s+|./gu) || [];
    for (const piece of pieces) {
      depth += { "(": 1, ")": -1 }[piece] || 0;
      const isOperator = ["+", "-", "="].includes(piece);
      if (isOperator && depth === 0) terms.push([]);
      const row = terms[terms.length - 1];
      const found = /^([A-Za-zα-ω][\u0300-\u036f]*)(\d+(?:[,_]\d+)?)?(ᵀ)?$/u.exec(piece);
      if (found) {
        row.push(withIndices(letter(found[1]), found[2], found[3]), math("mspace", { width: "0.1em" }));
      } else if (/^\d+$/.test(piece)) {
        row.push(math("mn", {}, piece));
      } else if (/[()]/.test(piece)) {
        row.push(paren(piece));
      } else if (piece.trim()) {
        row.push(math("mo", isOperator ? { form: "infix" } : {}, piece === "-" ? "−" : piece));
      }
    }
    return element("span", { class: "formula" }, ...terms.flatMap((row) => [math("math", {}, ...row), " "]));
  }

  /** A line of code whose names can be pointed at. */
  code(text, known = (name) => this.inspection.meaning(name) !== null) {
    const pieces = text.split(/([A-Za-z_][A-Za-z_0-9]*)/);
    return pieces.map((piece) => {
      if (/^(let|const|double)$/.test(piece)) return element("span", { class: "keyword" }, piece);
      if (!known(piece)) return piece;
      return element("span", { "data-name": piece, class: "pick", tabindex: "-1", role: "button" }, piece);
    });
  }
}

/** A letter with its index and the sign of the transpose, where it has them. */
function withIndices(base, low, isTransposed) {
  const index = low ? math("mn", {}, low.replace("_", ",")) : null;
  const transposed = isTransposed ? math("mi", { mathvariant: "normal" }, "T") : null;
  if (index && transposed) return math("msubsup", {}, base, index, transposed);
  if (index) return math("msub", {}, base, index);
  return transposed ? math("msup", {}, base, transposed) : base;
}

function paren(text) {
  return math("mo", { stretchy: "false" }, text);
}

function number(text) {
  return math("mn", { class: "value" }, text);
}

function isSum(tree) {
  return Array.isArray(tree) && (tree[0] === "+" || tree[0] === "-");
}

/** The summands of a sum that is computed from left to right; parentheses stay what they are. */
function summands(tree) {
  if (!Array.isArray(tree) || (tree[0] !== "+" && tree[0] !== "-")) return [{ sign: 1, part: tree }];
  const [a, b] = operands(tree);
  const isChain = Array.isArray(a) && (a[0] === "+" || a[0] === "-");
  return [...(isChain ? summands(a) : [{ sign: 1, part: a }]), { sign: tree[0] === "+" ? 1 : -1, part: b }];
}

/** How tightly a tree holds together as it is written: sums least. */
function rank(tree, inspection) {
  if (typeof tree === "number") return tree < 0 ? 0 : 2;
  if (typeof tree === "string") return 2;
  return { "+": 0, "-": 0, neg: 0, "*": 1, "/": 1 }[tree[0]] ?? 2;
}

/** A tree as Rust has it. `isC` adds the parentheses that C's compilers want around products. */
function codeOf(tree, isC = false) {
  if (typeof tree === "string") return tree;
  if (typeof tree === "number") return String(tree) + (Number.isInteger(tree) && Math.abs(tree) < 1e21 ? ".0" : "");
  const parts = operands(tree);
  const inner = (part, least) => {
    const text = codeOf(part, isC);
    return rank(part) < least ? `(${text})` : text;
  };
  switch (tree[0]) {
    case "+":
    case "-": {
      const side = (part, least) =>
        isC && Array.isArray(part) && "*/".includes(part[0]) ? `(${codeOf(part, isC)})` : inner(part, least);
      const first = Array.isArray(parts[0]) && parts[0][0] === "neg" ? codeOf(parts[0], isC) : side(parts[0], 0);
      return `${first} ${tree[0]} ${side(parts[1], 1)}`;
    }
    case "*":
    case "/":
      return `${inner(parts[0], 1)} ${tree[0]} ${inner(parts[1], 2)}`;
    case "neg":
      return `-${inner(parts[0], 2)}`;
    default:
      return `${tree[0]}(${parts.map((part) => codeOf(part, isC)).join(", ")})`;
  }
}
