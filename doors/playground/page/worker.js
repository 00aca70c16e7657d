// Beside the page: holds the module of WebAssembly and answers texts, one after the other.

// a promise: texts may come before it is compiled
let module = null;
let rne = null;

/** What the compiler says of a text. Only integers cross the border: bytes go in, words come out. */
function answer(text) {
  rne.rne_clear();
  for (const byte of new TextEncoder().encode(text)) rne.rne_push(byte);
  const length = rne.rne_compile() >>> 0;
  const words = new Uint32Array(Math.ceil(length / 4));
  for (let index = 0; index < words.length; index++) words[index] = rne.rne_word(index);
  return JSON.parse(new TextDecoder().decode(new Uint8Array(words.buffer, 0, length)));
}

onmessage = async ({ data }) => {
  try {
    if (data.module) {
      module = WebAssembly.compile(data.module);
      return;
    }
    rne ||= (await WebAssembly.instantiate(await module)).exports;
    const start = performance.now();
    const said = answer(data.text);
    postMessage({ number: data.number, milliseconds: performance.now() - start, ...said });
  } catch (error) {
    // what a stopped module holds is not to be relied on
    rne = null;
    postMessage({ number: data.number, failed: String(error) });
  }
};
