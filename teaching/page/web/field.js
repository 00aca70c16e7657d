// Numbers that are typed: a field beside a slider.

/** The number of a text, with a decimal point or comma; `pi/4`, `2pi/3`, `deg(30)`, `30deg` and `30°` in radians; NaN for other words. */
function numberOf(text) {
  const plain = text.trim().replace(",", ".").replace(/^[−–]/, "-").replace("π", "pi");
  const parts = plain.match(/^([+-]?)([\d.]*) *\*? *pi *(?:\/ *([\d.]+))?$/);
  if (parts) return (Number(`${parts[1]}${parts[2] || 1}`) * Math.PI) / Number(parts[3] ?? 1);
  const degrees = plain.match(/^([+-]?)deg\( *([+-]?[\d.]+) *\)$/) || plain.match(/^()(.*[\d.]) *(?:deg|°)$/);
  if (degrees) return ((degrees[1] === "-" ? -1 : 1) * Number(degrees[2]) * Math.PI) / 180;
  return plain === "" ? Number.NaN : Number(plain);
}

/** A number for a field, as short as its digits allow: a typed number comes back as it was typed. */
function typedText(value) {
  const rounded = String(Number(value.toPrecision(4)));
  return minus(String(value).length <= 7 ? String(value) : rounded);
}

/** A field for a number; `taken(value, text)` is called with each finite number that is typed; refused ones are marked. */
function numberField(attributes, taken) {
  const field = element("input", { type: "text", inputmode: "decimal", autocomplete: "off", ...attributes });
  const take = () => {
    const value = numberOf(field.value);
    const isFine = Number.isFinite(value);
    field.setAttribute("aria-invalid", String(!isFine));
    if (isFine) taken(value, field.value);
  };
  field.addEventListener("change", take);
  field.addEventListener("keydown", (event) => {
    if (event.key === "Enter") take();
  });
  return field;
}

/** Writes a number into a field, unless somebody is typing there. */
function fill(field, value) {
  if (field.ownerDocument.activeElement === field && field.value !== "" && numberOf(field.value) === value) return;
  field.value = typedText(value);
  field.removeAttribute("aria-invalid");
}

/** A field for an angle in degrees; `taken(value)` is called with radians. */
function degreesField(attributes, taken) {
  const inRadians = (value, text) => taken(/[a-zπ°]/.test(text) ? value : (value * Math.PI) / 180);
  return numberField({ class: "number degrees", ...attributes }, inRadians);
}

const fillDegrees = (field, angle) => fill(field, Number(((angle * 180) / Math.PI).toFixed(2)));

/** Lets arrow keys move a slider by hundredths of its range; with the step "any" they would go by a tenth. */
function goByHundredths(slider) {
  slider.addEventListener("keydown", (event) => {
    const way = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
    if (!way) return;
    event.preventDefault();
    slider.value = Number(slider.value) + (way * (slider.max - slider.min)) / (event.shiftKey ? 1000 : 100);
    slider.dispatchEvent(new Event("input", { bubbles: true }));
  });
}
