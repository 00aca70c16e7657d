// The state of a page in its address: a link opens the exact view. Only what is not as at first stands there.

/** The words of an address that have no value. */
const WORDS = ["exercise", "lecture", "unfolded", "reduced", "c", "equations", "joint", "base", "light", "dark", "frames"];

/** The keys of an address that have a value; those of a floating base come on top. */
const KEYS = ["q", "qd", "qdd", "f", "n", "cell", "look", "arrows"];
const keysOf = (page) => (page.state.base ? [...KEYS, ...Object.keys(OF_BASE)] : KEYS);

/** What an address asks for: lists by their names, and words. */
function readAddress(fragment, keys = KEYS) {
  const asked = { lists: {}, given: new Set(), words: new Set(), cell: null, look: null, wrong: [], unknown: [] };
  for (const part of fragment.replace(/^#/, "").split("&").filter(Boolean)) {
    const [key, value] = part.includes("=") ? [part.slice(0, part.indexOf("=")), part.slice(part.indexOf("=") + 1)] : [part, null];
    if (value === null) {
      if (WORDS.includes(key) || key === "no-masses") asked.words.add(key);
      // the link at the top of the page leads to the element of this name
      else if (key !== "steps") asked.unknown.push(key);
      continue;
    }
    asked.given.add(key);
    const texts = decodeURIComponent(value).split(",");
    const numbers = texts.map(numberOf);
    if (key === "look" && VIEWS.includes(value)) asked.look = value;
    else if (key === "arrows") asked.arrows = texts.filter(Boolean);
    else if (key === "cell" && /^\d+\.\d$/.test(value)) asked.cell = value.split(".").map(Number);
    else if (!keys.includes(key)) asked.unknown.push(key);
    else if (key === "cell") asked.wrong.push(`cell=${value} is no cell: write cell=JOINT.STEP`);
    else if (numbers.every(Number.isFinite)) asked.lists[key] = numbers;
    else if (key === "look") asked.wrong.push(`look=${value} is no view: it is ${VIEWS.join(", ")}, or three numbers`);
    else asked.wrong.push(`“${texts.find((_, at) => !Number.isFinite(numbers[at]))}” in ${key} is no number`);
  }
  if (asked.unknown.length)
    asked.wrong.push(`${asked.unknown.join(", ")} is not known: the keys are ${keys.join(", ")}; the words are ${WORDS.join(", ")}, no-masses`);
  return asked;
}

/** Shows what an address asks for; returns what it cannot show, in words. */
function showAddress(page, fragment) {
  const { lists, words, cell, look, arrows, wrong } = readAddress(fragment, keysOf(page));
  const { coordinates } = page.inspection;
  const fits = (key, count) => {
    if (!lists[key]) return false;
    if (lists[key].length === count) return true;
    const numbers = lists[key].length === 1 ? "1 number" : `${lists[key].length} numbers`;
    wrong.push(`${key} has ${numbers}; ${count} ${count === 1 ? "is" : "are"} needed`);
    return false;
  };
  const state = structuredClone(page.initial);
  for (const of of OF) if (fits(of, coordinates.length)) state[of] = page.inspection.ofJoints(lists[of]);
  for (const of of Object.keys(state.base || {})) if (fits(of, 3)) state.base[of] = lists[of];
  const wrench = page.inspection.freeTips();
  for (const of of ["f", "n"]) if (fits(of, wrench[of].length)) wrench[of] = lists[of];
  const chosen = (group, first) => group.find((name) => words.has(name)) || first;
  const view = {
    ...viewOf(page),
    state,
    wrench,
    form: chosen(["unfolded", "reduced"], "folded"),
    language: chosen(["c", "equations"], "rust"),
    axes: chosen(["joint", "base"], "link"),
    theme: chosen(["light", "dark"], "auto"),
    exercise: words.has("exercise"),
    lecture: words.has("lecture"),
    frames: words.has("frames"),
    masses: !words.has("no-masses"),
    pinned: null,
    scrolled: [0, 0, 0],
  };
  if (cell && page.inspection.cell(...cell)) {
    view.cell = cell;
    view.layers = page.layersOf(cell[1]);
  } else if (cell) {
    wrong.push(`there is no cell ${cell.join(".")}`);
  }
  const none = arrows?.filter((quantity) => !page.layerButtons.has(quantity)) || [];
  if (none.length) wrong.push(`there are no arrows ${none.join(", ")}: there are ${[...page.layerButtons.keys()].join(", ")}`);
  else if (arrows) view.layers = arrows;
  if (look) view.look = page.arm.lookOf(look);
  else if (fits("look", 3)) [view.look] = [{ yaw: lists.look[0], pitch: lists.look[1], zoom: lists.look[2] }];
  else view.look = page.arm.home;
  showView(page, view);
  return wrong;
}

/** The numbers of a list of the address: joints that follow others have none. */
const listed = (page, ofJoints) => page.inspection.coordinates.map((joint) => ofJoints[joint]);

/** The address of what a page shows. */
function addressOf(page) {
  const view = viewOf(page);
  const parts = [];
  const isFirst = (a, b) => a.every((value, index) => value === b[index]);
  for (const of of OF) if (!isFirst(view.state[of], page.initial[of])) parts.push(`${of}=${listed(page, view.state[of]).join(",")}`);
  for (const [of, vector] of Object.entries(view.state.base || {})) if (!isFirst(vector, page.initial.base[of])) parts.push(`${of}=${vector.join(",")}`);
  for (const of of ["f", "n"]) if (view.wrench[of].some((value) => value !== 0)) parts.push(`${of}=${view.wrench[of].join(",")}`);
  if (!isFirst(view.cell, page.firstCell)) parts.push(`cell=${view.cell.join(".")}`);
  const ofCell = page.layersOf(view.cell[1]);
  if (view.layers.length !== ofCell.length || !isFirst(view.layers, ofCell)) parts.push(`arrows=${view.layers.join(",")}`);
  const name = page.arm.viewName();
  if (name ? page.arm.lookOf(name) !== page.arm.home : true)
    parts.push(`look=${name || [view.look.yaw, view.look.pitch, view.look.zoom].join(",")}`);
  for (const word of [view.form, view.language, view.axes, view.theme]) if (WORDS.includes(word)) parts.push(word);
  for (const word of ["exercise", "lecture", "frames"]) if (view[word]) parts.push(word);
  if (!view.masses) parts.push("no-masses");
  return parts.length ? `#${parts.join("&")}` : "";
}

/** Keeps the address of a page that of what it shows, and shows what an address asks for that is typed or followed. */
class Address {
  constructor(page) {
    this.page = page;
    this.show(location.hash);
    window.addEventListener("hashchange", () => {
      if (location.hash !== this.written) this.show(location.hash);
    });
  }

  show(fragment) {
    const { words, unknown, cell, given } = readAddress(fragment, keysOf(this.page));
    const wrong = words.size || unknown.length || fragment.includes("=") ? showAddress(this.page, fragment) : [];
    this.note(OF.some((of) => given.has(of)) ? ["qd", "qdd"].filter((of) => !given.has(of)) : []);
    byId("address-notice").hidden = wrong.length === 0;
    byId("address-notice").textContent = wrong.length ? `The address is not shown as it stands: ${wrong.join("; ")}.` : "";
    // where everything stands below each other, the cell that is asked for is far below
    if (cell && matchMedia("(max-width: 900px)").matches) byId("cell").scrollIntoView();
  }

  /** Says what an address with a part of a state does not give: `rne eval` takes 0 there. */
  note(missing) {
    const values = missing.map((of) => `${LETTERS[of]} = (${listed(this.page, this.page.state[of]).map(typedText).join(", ")})`);
    const zeros = missing.map((of) => `${of}=${listed(this.page, this.page.state[of]).map(() => 0).join(",")}`);
    byId("state-note").hidden = missing.length === 0;
    byId("state-note").textContent =
      `The address does not give ${missing.join(" and ")}, so the page takes ${values.join(" and ")} of its first view. ` +
      `“rne eval” takes 0; for 0 here, add ${zeros.join("&")} to the address.`;
    this.noted = JSON.stringify(this.page.state);
  }

  /** Soon: a slider that moves would write it a hundred times. */
  later() {
    if (JSON.stringify(this.page.state) !== this.noted) byId("state-note").hidden = true;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.write(), 250);
  }

  write() {
    clearTimeout(this.timer);
    const address = addressOf(this.page);
    if (address === this.written) return;
    this.written = address;
    document.documentElement.dispatchEvent(new CustomEvent("address", { detail: address }));
    try {
      history.replaceState(null, "", address || location.pathname + location.search);
    } catch {
      // a frame without an address of its own: the page around it has one
    }
  }
}
