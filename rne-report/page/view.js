// What a reader has chosen, as data: a page of the same arm with other numbers can be looked at in the same way.

const kindsOf = (page) => page.inspection.robot.joints.map((joint) => joint.kind).join(" ");

/** What a page shows and how. */
function viewOf(page) {
  return structuredClone({
    kinds: kindsOf(page),
    state: page.state,
    force: page.wrench.f,
    from: page.from,
    to: page.to,
    duration: byId("duration").value,
    time: byId("time").value,
    plot: page.plot.joint,
    form: page.form,
    language: page.language,
    exercise: page.exercise.isOn,
    theme: document.documentElement.dataset.theme || "auto",
    cell: [page.cell.joint, page.cell.step],
    layers: [...page.arm.layers],
    look: page.arm.look,
    pinned: page.reading.pinned?.name || null,
    tip: document.querySelector(".tip").open,
    scrolled: [window.scrollX, window.scrollY, byId("cell").scrollTop],
  });
}

/** Shows a page as another one was: the switches, and of an arm with the same joints everything else. */
function showView(page, view) {
  const press = (name) => {
    const button = document.querySelector(`[data-switch="${name}"]`);
    if (!button.disabled && button.getAttribute("aria-pressed") !== "true") button.click();
  };
  for (const name of [view.form, view.language, view.exercise ? "exercise" : "shown", view.theme]) press(name);
  if (view.kinds !== kindsOf(page)) return;
  const cell = page.inspection.cell(...view.cell);
  if (cell) page.open(cell);
  document.querySelectorAll("[data-tip]").forEach((input, index) => {
    input.value = view.force[index];
    if (view.force[index] !== 0) input.dispatchEvent(new Event("input"));
  });
  document.querySelector(".tip").open = view.tip;
  Object.assign(page, { from: view.from, to: view.to });
  byId("duration").value = view.duration;
  page.plotJoint(view.plot);
  page.retime();
  byId("time").value = view.time;
  page.plot.point(Number(view.time) * page.trajectory.seconds);
  page.arm.layers = new Set(view.layers.filter((quantity) => page.layerButtons.has(quantity)));
  page.paintLayers();
  page.arm.look = view.look;
  page.setState(view.state);
  if (view.pinned) page.reading.select(view.pinned);
  window.scrollTo(view.scrolled[0], view.scrolled[1]);
  byId("cell").scrollTop = view.scrolled[2];
}
