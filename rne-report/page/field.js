// Numbers that are typed: a field beside a slider.

/** The number of a text, with a decimal point or comma; NaN where it is none. */
function numberOf(text) {
  const plain = text.trim().replace(",", ".").replace(/^[−–]/, "-");
  return plain === "" ? Number.NaN : Number(plain);
}

/** A number for a field, as short as its digits allow: a typed number comes back as it was typed. */
function typedText(value) {
  const rounded = String(Number(value.toPrecision(6)));
  return minus(String(value).length <= 9 ? String(value) : rounded);
}

/** A field for a number; `taken(value)` is called with each finite number that is typed, and refused ones are marked. */
function numberField(attributes, taken) {
  const field = element("input", { type: "text", inputmode: "decimal", autocomplete: "off", ...attributes });
  const take = () => {
    const value = numberOf(field.value);
    const isFine = Number.isFinite(value);
    field.setAttribute("aria-invalid", String(!isFine));
    if (isFine) taken(value);
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
