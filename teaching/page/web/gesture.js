// The hand on the arm: a pointer or a finger turns it, two fingers and the wheel zoom, and keys do both.

/** Lets a hand turn and zoom the arm. */
function listenToHand(arm) {
  const { root } = arm;
  const pointers = new Map();
  root.addEventListener("pointerdown", (event) => {
    pointers.set(event.pointerId, event);
  });
  root.addEventListener("pointermove", (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    // a click on an arrow stays one, if the hand trembles
    const isTurning = root.hasPointerCapture(event.pointerId);
    if (!isTurning && Math.hypot(event.clientX - before.clientX, event.clientY - before.clientY) < 4) return;
    const others = [...pointers.values()].filter((other) => other.pointerId !== event.pointerId);
    if (others.length) {
      const far = (of) => Math.hypot(of.clientX - others[0].clientX, of.clientY - others[0].clientY) || 1;
      arm.zoomBy(far(event) / far(before));
    } else {
      arm.turnBy(-(event.clientX - before.clientX) * 0.01, (event.clientY - before.clientY) * 0.01);
    }
    pointers.set(event.pointerId, event);
    // from now on the turn goes on outside of the picture too
    if (!root.hasPointerCapture(event.pointerId)) root.setPointerCapture(event.pointerId);
  });
  for (const end of ["pointerup", "pointercancel"]) {
    root.addEventListener(end, (event) => pointers.delete(event.pointerId));
  }
  root.addEventListener("lostpointercapture", (event) => {
    // a finger is captured by what it touches first, which loses it when the picture takes it over
    if (event.target === root) pointers.delete(event.pointerId);
  });
  root.addEventListener(
    "wheel",
    (event) => {
      // as maps do: the wheel alone scrolls the page
      if (!event.ctrlKey) return;
      event.preventDefault();
      arm.zoomBy(Math.exp(-event.deltaY * 0.005));
    },
    { passive: false },
  );
  root.addEventListener("keydown", (event) => {
    const step = 0.12;
    const keys = {
      ArrowLeft: () => arm.turnBy(-step, 0),
      ArrowRight: () => arm.turnBy(step, 0),
      ArrowUp: () => arm.turnBy(0, step),
      ArrowDown: () => arm.turnBy(0, -step),
      "+": () => arm.zoomBy(1.15),
      "=": () => arm.zoomBy(1.15),
      "-": () => arm.zoomBy(1 / 1.15),
      0: () => arm.reset(),
    };
    if (!keys[event.key] || event.altKey || event.metaKey) return;
    event.preventDefault();
    keys[event.key]();
  });
}
