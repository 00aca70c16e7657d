// A text in the fragment of an address, which no server sees: `#robot=NAME` or `#text=` and the deflated text. What
// follows the first `&` is the view: address.js of the page reads it.

/** What the compiler takes of a robot file, bytes. */
const LARGEST_TEXT = 1 << 20;

/** Bytes in the letters of base64 that an address can have. */
function base64url(bytes) {
  let letters = "";
  for (const byte of bytes) letters += String.fromCharCode(byte);
  return btoa(letters).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

async function fragmentOf(text) {
  const stream = new Blob([text]).stream().pipeThrough(new CompressionStream("deflate-raw"));
  return `#text=${base64url(new Uint8Array(await new Response(stream).arrayBuffer()))}`;
}

/** The view of a fragment, without the `&` before it. */
const viewOfFragment = (fragment) => /^#(?:robot|text)=[^&]*&(.*)$/.exec(fragment)?.[1] || "";

/** The text of a fragment; null when it has none, an error when it is damaged or too large. */
async function textOf(fragment, robots) {
  const [, kind, value] = /^#(robot|text)=([^&]*)/.exec(fragment) || [];
  if (kind === "robot") {
    const name = decodeURIComponent(value);
    const found = robots.find((robot) => robot.name === name);
    if (!found) throw new Error(`no robot \`${name}\` is shipped; the menu has those that are`);
    return found.text;
  }
  if (kind !== "text") return null;
  try {
    const bytes = await unpacked(value.replaceAll("-", "+").replaceAll("_", "/"), "deflate-raw", LARGEST_TEXT);
    if (bytes) return new TextDecoder("utf-8", { fatal: true }).decode(bytes);
  } catch {
    throw new Error("the link is damaged: its text cannot be read; copy it once more as a whole");
  }
  throw new Error(`the link has a text of more than ${LARGEST_TEXT} bytes (1 MiB), the most that a robot file may have`);
}
