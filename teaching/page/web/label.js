// Words in the picture of the arm: each stands inside the picture, on no other, and where few lines run through it.

const overlaps = (a, b) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;

const grown = ({ left, right, top, bottom }, by) => ({ left: left - by, right: right + by, top: top - by, bottom: bottom + by });

/** Whether a way from a to b runs through a box (Liang and Barsky). */
function crosses([a, b], box) {
  let [first, last] = [0, 1];
  for (const [from, along, low, high] of [
    [a.x, b.x - a.x, box.left, box.right],
    [a.y, b.y - a.y, box.top, box.bottom],
  ]) {
    if (along === 0 && (from < low || from > high)) return false;
    if (along === 0) continue;
    const [one, other] = [(low - from) / along, (high - from) / along];
    first = Math.max(first, Math.min(one, other));
    last = Math.min(last, Math.max(one, other));
  }
  return first <= last;
}

class Labels {
  constructor() {
    // by kinds of words: their font, and the width of each text
    this.fonts = new Map();
    this.canvas = document.createElement("canvas").getContext("2d");
  }

  /** Forgets what stands in the picture, whose size this is. */
  begin(width, height) {
    if (width !== this.width || height !== this.height) this.fonts.clear();
    Object.assign(this, { width, height, boxes: [], lines: [] });
  }

  /** A line that words should not hide: its half width is `around`, in pixels. */
  addLine(from, to, around = 1) {
    this.lines.push({ way: [from, to], around });
  }

  addBox(box) {
    this.boxes.push(box);
  }

  /** Wide, above and below the line of writing: by the font alone, for to ask the page would lay it out anew. */
  sizeOf(words) {
    const text = words.textContent.replace(/\d/g, "0");
    const kind = `${words.getAttribute("class")} ${words.parentNode.getAttribute("class")} ${document.documentElement.dataset.lecture}`;
    if (!this.fonts.has(kind)) {
      const { font, fontSize } = getComputedStyle(words);
      this.fonts.set(kind, { font, high: parseFloat(fontSize), widths: new Map() });
    }
    const { font, high, widths } = this.fonts.get(kind);
    if (!widths.has(text)) {
      this.canvas.font = font;
      widths.set(text, this.canvas.measureText(text).width);
    }
    return { width: widths.get(text), above: 0.95 * high, below: (words.firstElementChild ? 0.4 : 0.26) * high };
  }

  /** The box of words at a point, and the point moved so that the box stands inside the picture. */
  inside(words, { x, y }, anchor, size = this.sizeOf(words)) {
    const { width, above, below } = size;
    const left = anchor === "start" ? x : anchor === "end" ? x - width : x - width / 2;
    const dx = Math.max(3 - left, Math.min(0, this.width - 3 - left - width));
    const dy = Math.max(2 - (y - above), Math.min(0, this.height - 2 - y - below));
    const box = { left: left + dx, right: left + dx + width, top: y + dy - above, bottom: y + dy + below };
    return { x: x + dx, y: y + dy, anchor, box, moved: Math.hypot(dx, dy) };
  }

  /** What is bad about words in a box. */
  cost(box) {
    const near = grown(box, 1);
    const written = this.boxes.filter((other) => overlaps(near, other)).length;
    const struck = this.lines.filter(({ way, around }) => crosses(way, grown(box, around - 1))).length;
    return 100 * written + 40 * struck;
  }

  /** Writes words at the best of some places, the one that is wanted most first. */
  write(words, places) {
    const size = this.sizeOf(words);
    const all = places.map(({ point, anchor }, index) => {
      const place = this.inside(words, point, anchor, size);
      return { ...place, cost: this.cost(place.box) + 0.5 * place.moved + index };
    });
    this.put(words, all.reduce((best, place) => (place.cost < best.cost ? place : best)));
  }

  put(words, { x, y, anchor, box }) {
    this.addBox(box);
    words.setAttribute("x", round(x));
    words.setAttribute("y", round(y));
    words.setAttribute("text-anchor", anchor);
  }
}
