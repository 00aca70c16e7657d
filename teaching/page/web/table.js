// The table of the robot, and on paper the vectors of all steps.

/** An angle as a fraction of π, where it is one. */
function angleText(angle) {
  for (const part of [1, 2, 3, 4, 6]) {
    const times = (angle * part) / Math.PI;
    const whole = Math.round(times);
    if (whole && Math.abs(times - whole) < 1e-9)
      return minus(`${whole === 1 ? "" : whole === -1 ? "-" : whole}π${part > 1 ? `/${part}` : ""}`);
  }
  return exact(angle);
}

/** Fills a table with a row for each link: Denavit-Hartenberg, mass, centre of mass, inertia. */
function fillTable(table, { robot, floating }) {
  const heads = ["joint", "θ", "d, m", "a, m", "α", "mass, kg", "centre of mass, m", "inertia xx, yy, zz, xy, xz, yz, kg m²"];
  const row = (link, first, ofTable) => {
    const cells = [...ofTable, exact(link.mass), link.com.map(exact).join(", "), link.inertia.map(exact).join(", ")];
    return element("tr", {}, element("th", { scope: "row" }, first), ...cells.map((text) => element("td", {}, text)));
  };
  // the variable of a joint stands in its own column, beside a constant part
  const variable = (text, name) => (text === "0" ? name : `${name} + ${text}`);
  const rows = robot.joints.map((joint, index) => {
    const [theta, d] = [angleText(joint.theta), exact(joint.d)];
    const q = `q${index + 1}`;
    const turns = joint.kind === "revolute";
    return row(joint, index + 1, [turns ? variable(theta, q) : theta, turns ? d : variable(d, q), exact(joint.a), angleText(joint.alpha)]);
  });
  table.append(
    element("caption", {}, `${robot.convention} Denavit-Hartenberg; centres of mass and inertia in the link frames of this table`),
    element("thead", {}, element("tr", {}, ...heads.map((head) => element("th", { scope: "col" }, head)))),
    element("tbody", {}, ...(floating ? [row(floating, "base", ["", "", "", ""])] : []), ...rows),
  );
}

/** Every vector of the seven steps with its formula and its numbers at this state, for paper. */
function vectorsOf(page) {
  const { inspection, set } = page;
  const line = (components, { quantity, text }) => {
    const names = components.map(({ name }) => name).filter((name) => inspection.meaning(name).quantity === quantity);
    const numbers = names.map((name) => page.shown(name, page.told(name))).join(", ");
    return element("p", {}, set.formula(text), `= ${names.length > 1 ? `(${numbers})` : numbers} ${unitText(inspection.unit(names[0]))}`);
  };
  return STEPS.flatMap((title, at) => {
    const cells = inspection.cells.filter(({ step }) => step === at + 1);
    const lines = cells.flatMap(({ formulas, components }) => formulas.map((formula) => line(components, formula)));
    return [element("h3", {}, `Step ${at + 1}: ${title}`), ...lines];
  });
}
