// Shapes on the screen: paths of SVG.

const SVG = "http://www.w3.org/2000/svg";

function svg(tag, attributes = {}, ...children) {
  return filledElement(document.createElementNS(SVG, tag), attributes, children);
}

const round = (value) => Math.round(value * 10) / 10;
const segment = (a, b) => `M${round(a.x)} ${round(a.y)}L${round(b.x)} ${round(b.y)}`;
const polygon = (points) => `M${points.map((point) => `${round(point.x)} ${round(point.y)}`).join("L")}Z`;
const mean = (points) => points.reduce((sum, point) => sum + point.depth, 0) / points.length;
/** A ring: an arrow that points at the viewer, around what is at its place. */
const ringAt = (at) => `M${round(at.x - 11)} ${round(at.y)}a11 11 0 1 0 22 0a11 11 0 1 0 -22 0Zm2 0a9 9 0 1 1 18 0a9 9 0 1 1 -18 0Z`;

function direction(from, to) {
  const [x, y] = [to.x - from.x, to.y - from.y];
  const length = Math.hypot(x, y);
  return { x: length > 0 ? x / length : 0, y: length > 0 ? y / length : 0, length };
}

const heads_x = (from, to) => direction(from, to).x;
const heads_y = (from, to) => direction(from, to).y;

/** The head of an arrow, or two of them; null where the arrow points at the viewer. */
function arrowhead(from, to, isDouble) {
  const { x, y, length } = direction(from, to);
  if (length < 3) return null;
  const long = Math.min(11, length * 0.6);
  const wide = long * 0.42;
  const triangle = (tip) => {
    const back = { x: tip.x - x * long, y: tip.y - y * long };
    const side = (sign) => ({ x: back.x - sign * y * wide, y: back.y + sign * x * wide });
    return polygon([tip, side(1), side(-1)]);
  };
  const second = { x: to.x - x * long * 0.75, y: to.y - y * long * 0.75 };
  const neck = { x: to.x - x * long * 0.9, y: to.y - y * long * 0.9 };
  return { path: triangle(to) + (isDouble && length > 12 ? triangle(second) : ""), neck };
}

/** The outline of a rod with round ends. */
function capsule(a, b, radius) {
  const points = [];
  for (const end of [a, b]) {
    for (let corner = 0; corner < 14; corner++) {
      const angle = (corner * 2 * Math.PI) / 14;
      points.push({
        x: end.x + Math.cos(angle) * radius * end.scale,
        y: end.y + Math.sin(angle) * radius * end.scale,
      });
    }
  }
  return polygon(hull(points));
}

/** The convex hull of points in the plane (Andrew's monotone chain). */
function hull(points) {
  const sorted = [...points].sort((a, b) => a.x - b.x || a.y - b.y);
  const side = (o, a, b) => (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
  const half = (list) => {
    const chain = [];
    for (const point of list) {
      while (chain.length >= 2 && side(chain[chain.length - 2], chain[chain.length - 1], point) <= 0) chain.pop();
      chain.push(point);
    }
    return chain.slice(0, -1);
  };
  return [...half(sorted), ...half(sorted.reverse())];
}
