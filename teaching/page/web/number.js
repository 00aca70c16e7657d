// Numbers as people read them.

const SUPERSCRIPTS = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };

/** Four significant digits, with a minus sign that is one. */
function short(value) {
  if (!Number.isFinite(value)) return Number.isNaN(value) ? "–" : value > 0 ? "∞" : "−∞";
  if (value === 0) return "0";
  const size = Math.abs(value);
  // what is left of a difference that should vanish
  if (size < 1e-12) return "≈ 0";
  if (size >= 1e-3 && size < 1e5) {
    const digits = Math.max(0, 3 - Math.floor(Math.log10(size)));
    return minus(size >= 1e4 ? value.toFixed(0) : value.toFixed(Math.min(digits, 5)));
  }
  const [mantissa, exponent] = value.toExponential(2).split("e");
  return minus(mantissa) + "·10" + [...String(Number(exponent))].map((digit) => SUPERSCRIPTS[digit]).join("");
}

/** A number of the table, with all its digits as long as these are few. */
function exact(value) {
  const text = String(value);
  return text.length <= 9 && !text.includes("e") ? minus(text) : short(value);
}

/** All digits of the double. */
function full(value) {
  return minus(Object.is(value, -0) ? "0" : String(value));
}

function minus(text) {
  return text.replace(/^-/, "−");
}

/** Units with a centred dot instead of a blank: N·m. */
function unitText(unit) {
  return unit.replaceAll(" ", "·");
}

function withUnit(value, unit) {
  return unit ? `${short(value)} ${unitText(unit)}` : short(value);
}

/** The next number of 1, 2 or 5 times a power of ten: the end of an axis. */
function niceAbove(value) {
  if (!(value > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(value));
  const step = [1, 2, 2.5, 5, 10].find((of) => of * power >= value * (1 - 1e-9));
  return Number((step * power).toPrecision(3));
}
